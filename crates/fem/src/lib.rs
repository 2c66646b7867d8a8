//! Finite elements of a Nastran deck: stiffness and mass, constraints, normal modes.
