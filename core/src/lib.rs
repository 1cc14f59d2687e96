//! Volume and area porosity of real geometry on structured grids.
//!
//! The crate is `no_std`, allocates nothing, holds no `unsafe` code and works in `f32` and `f64` from one text.
//! A module uses only those above it in this list:
//!
//! 1. [`real`]: the two scalars and their vectors
//! 2. [`aabb`]: axis-aligned boxes
//! 3. [`support`]: support mappings, and bodies made of bodies
//! 4. [`shape`]: convex bodies
//! 5. [`simplex`]: where the origin lies in a simplex, with proof
//! 6. [`gjk`]: do two bodies meet, and how far apart are they
//! 7. [`exact`]: the same without rounding, for bodies given by vertices
#![cfg_attr(not(feature = "std"), no_std)]
#![forbid(unsafe_code)]

pub mod aabb;
pub mod exact;
pub mod gjk;
pub mod real;
pub mod shape;
pub mod simplex;
pub mod support;
