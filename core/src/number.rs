//! The two scalars, their vectors, and boxes.
//!
//! - [`real`]: `f32` and `f64`, and the vectors of glam over them, from one text
//! - [`aabb`]: axis-aligned boxes

pub mod aabb;
pub mod real;
