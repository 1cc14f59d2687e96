//! The two scalars, their vectors, and boxes.
//!
//! - [`real`]: `f32` and `f64`, and the vectors of glam over them, from one text
//! - [`aabb`]: axis-aligned boxes
//! - [`kronrod`]: integrals with an estimate of their error
//! - [`words`]: words for exact integers of their values
//! - `axis`: the coordinate axes, as indices that need no check
//! - `plane`: points of planes across an axis, as arrays
//! - `space`: points of space, as arrays
//! - `root`: the square root where there is no std

pub mod aabb;
pub(crate) mod axis;
pub mod kronrod;
pub(crate) mod plane;
pub mod real;
#[cfg(not(feature = "std"))]
mod root;
pub(crate) mod space;
pub mod words;
