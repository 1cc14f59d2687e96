//! Generators, oracles and properties shared by tests, fuzz targets and benches.
#![forbid(unsafe_code)]

pub mod boxes;
pub mod convex;
pub mod corpus;
pub mod dirty;
pub mod door;
pub mod effort;
pub mod euler;
pub mod fields;
pub mod fuzzed;
pub mod gjk;
pub mod lattice;
pub mod meeting;
pub mod oracle;
pub mod pairs;
pub mod precise;
pub mod quadrature;
pub mod quadric;
pub mod random;
pub mod recipe;
pub mod solids;
pub mod truth;
pub mod turned;
pub mod unzip;
