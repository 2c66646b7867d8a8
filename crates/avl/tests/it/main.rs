//! Integration tests: real files, damaged files, round trips.

#[cfg(test)]
mod support;

#[cfg(test)]
mod damage;
#[cfg(test)]
mod geometry;
#[cfg(test)]
mod inputs;
#[cfg(test)]
mod legacy;
#[cfg(test)]
mod results;
#[cfg(test)]
mod round_trip;
