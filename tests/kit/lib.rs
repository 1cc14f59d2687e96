//! Generators, oracles and properties shared by tests, fuzz targets and benches.

pub mod fields;
pub mod lattice;
pub mod rng;
pub mod solids;
pub mod truth;
