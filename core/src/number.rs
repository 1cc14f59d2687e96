//! The two scalars, their vectors, and boxes.
//!
//! - [`real`]: `f32` and `f64`, and the vectors of glam over them, from one text
//! - [`aabb`]: axis-aligned boxes
//! - `plane`: points of planes across an axis

pub mod aabb;
pub(crate) mod plane;
pub mod real;
