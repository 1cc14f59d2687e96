//! Solid fractions of cells and faces from triangulated surfaces, layer by layer, exact to rounding.
//!
//! A file uses only those above it in this list:
//!
//! 1. [`clip`]: convex polygons cut by planes
//! 2. [`cells`]: cells, x and y faces of a layer, from sums along rows
//! 3. [`z_faces`]: its z faces, from the section with their plane
//! 4. [`union`]: the exact union of bodies in a cell, from BSP trees of their surfaces
//! 5. [`bins`]: which triangles of which bodies reach which layer
//! 6. `cell_unions`: cells that several bodies share; `walls`: faces in whose plane surface lies
//! 7. [`layer`]: the door: porosity of the layers of a grid

pub mod bins;
mod cell_unions;
pub mod cells;
pub mod clip;
pub mod layer;
pub mod union;
mod walls;
pub mod z_faces;

pub use cell_unions::OtherBodies;
