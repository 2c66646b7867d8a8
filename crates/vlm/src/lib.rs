//! Vortex lattice of an AVL geometry.
