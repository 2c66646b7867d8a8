//! AVL geometry, mass, run-case and output files as plain structs.
