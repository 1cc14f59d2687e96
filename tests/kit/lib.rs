//! Generators, oracles and properties shared by tests, fuzz targets and benches.

pub mod corpus;
pub mod pairs;
pub mod random;
