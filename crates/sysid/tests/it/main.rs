//! Tests of the estimation as a whole.

mod order20;
mod rao_garnier;
mod real_data;
mod systems;
