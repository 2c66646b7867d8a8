//! Modal basis on the load reference axis: mean axes, interpolation, mode classes.
