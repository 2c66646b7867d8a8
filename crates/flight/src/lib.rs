//! Non-linear flight dynamics of the flexible aircraft: trim, linearisation, simulation.
