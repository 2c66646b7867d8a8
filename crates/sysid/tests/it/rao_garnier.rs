//! The benchmark of Rao and Garnier.
