//! Generators, oracles and properties shared by tests, fuzz targets and benches.
#![forbid(unsafe_code)]

pub mod euler;
