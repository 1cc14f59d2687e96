//! Volume and area porosity of real geometry on structured grids.
//!
//! The crate is `no_std`, allocates nothing, holds no `unsafe` code and works in `f32` and `f64` from one text.
//! A module uses only those above it in this list:
//!
//! 1. [`real`]: the two scalars and their vectors
//! 2. [`aabb`]: axis-aligned boxes
//!
//! Beside the geometry, and using none of it, stands the flow:
//!
//! - [`pdr`]: the Euler equations in a porous space; it sees porosity only as slices
#![cfg_attr(not(feature = "std"), no_std)]
#![forbid(unsafe_code)]

pub mod aabb;
pub mod pdr;
pub mod real;
