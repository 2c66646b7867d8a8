//! Linear time-invariant systems: state space, modes, frequency response, simulation.
