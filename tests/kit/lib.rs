//! Generators, oracles and properties shared by tests, fuzz targets and benches.

pub mod fields;
pub mod lattice;
pub mod rng;
pub mod solids;
pub mod truth;

/// The README's example compiles and holds.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;
