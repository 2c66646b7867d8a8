//! Incremental unsteady strip aerodynamics and flutter.
