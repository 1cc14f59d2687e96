//! Volume and area porosity of real geometry on structured grids.
//!
//! The crate is `no_std`, allocates nothing, holds no `unsafe` code and works in `f32` and `f64` from one text.
//! A module uses only those above it in this list:
//!
//! 1. [`real`]: the two scalars and their vectors
//! 2. [`aabb`]: axis-aligned boxes
//! 3. [`clip`]: convex polygons cut by planes
//! 4. [`grid`]: cells, faces, index order
//! 5. [`layer`]: solid fractions of one layer of cells, as bounds that bodies share
//! 6. [`surface`]: cells, x and y faces of a layer from a triangulated surface
//! 7. [`section`]: its z faces
//! 8. [`overlap`]: the exact union of bodies in a cell
#![cfg_attr(not(feature = "std"), no_std)]
#![forbid(unsafe_code)]

pub mod aabb;
pub mod clip;
pub mod grid;
pub mod layer;
pub mod overlap;
pub mod real;
pub mod section;
pub mod surface;
