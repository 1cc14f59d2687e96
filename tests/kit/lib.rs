//! Generators, oracles and properties shared by tests, fuzz targets and benches.

pub mod corpus;
pub mod fuzzed;
pub mod gjk;
pub mod oracle;
pub mod pairs;
pub mod random;
pub mod recipe;
