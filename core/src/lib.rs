//! Volume and area porosity of real geometry on structured grids.
//!
//! The crate is `no_std`, allocates nothing, holds no `unsafe` code and works in `f32` and `f64` from one text.
//! A module uses only those above it in this list:
//!
//! 1. [`real`]: the two scalars and their vectors
//! 2. [`aabb`]: axis-aligned boxes
//! 3. [`support`]: support mappings, and bodies made of bodies
//! 4. [`shape`]: convex bodies
//! 5. [`sat`]: triangle against box
//! 6. [`simplex`]: where the origin lies in a simplex, with proof
//! 7. [`gjk`]: do two bodies meet, and how far apart are they
//! 8. [`exact`]: the same without rounding, for bodies given by vertices
//! 9. [`contain`]: is a box inside a body
#![cfg_attr(not(feature = "std"), no_std)]
#![forbid(unsafe_code)]
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "`!(x > 0)` says where NaN goes")]

pub mod aabb;
pub mod contain;
pub mod exact;
pub mod gjk;
pub mod real;
pub mod sat;
pub mod shape;
pub mod simplex;
pub mod support;
