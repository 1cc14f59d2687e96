//! Solid fractions of cells and faces from triangulated surfaces, layer by layer, exact to rounding.
//!
//! ```
//! use glam::DVec3;
//! use voidage_core::grid::Grid;
//! use voidage_core::surface::bins::Surface;
//! use voidage_core::surface::layer::{LayerMemory, LayerOptions, LayerSlices, Layers};
//! use voidage_core::surface::union::UnionBuffers;
//!
//! let tetrahedron = |at: DVec3| {
//!     let corner = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| p + at);
//!     [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(|t| t.map(|n: usize| corner[n]))
//! };
//! let (one, other) = (tetrahedron(DVec3::splat(0.1)), tetrahedron(DVec3::splat(0.2)));
//! let bodies = [Surface::new(&one), Surface::new(&other)];
//! let edges = [0.0, 1.0, 2.0];
//! let grid = Grid::new(&edges, &edges, &edges)?;
//!
//! // Triangles sorted by layer, in memory of yours; then memory for one layer at a time.
//! let needed = Layers::needed(&grid, &bodies);
//! let (mut ids, mut groups) = (vec![0; needed.numbers], vec![Default::default(); needed.groups]);
//! let layers = Layers::new(&grid, &bodies, LayerOptions::default(), &mut ids, &mut groups)?;
//! let needed = layers.memory_needed();
//! let (mut reals, mut flags) = (vec![0.0; needed.reals], vec![0; needed.flags]);
//! let (mut numbers, mut parts) = (vec![0; needed.numbers], vec![Default::default(); needed.groups]);
//! let mut union = UnionBuffers::<f64, 64>::default();
//! let mut memory = LayerMemory::new(&grid, &mut reals, &mut flags, &mut numbers, &mut parts, union.memory())?;
//!
//! let (mut beta_v, mut beta_x, mut beta_y, mut beta_z) = ([0.0; 8], [0.0; 12], [0.0; 12], [0.0; 12]);
//! let mut solid = 0.0;
//! for k in 0..2 {
//!     let slices = LayerSlices::of_fields(&grid, k, &mut beta_v, [&mut beta_x, &mut beta_y, &mut beta_z])?;
//!     solid += layers.layer(k, slices, None, &mut memory)?.solid_volume;
//! }
//! assert!((solid - (2.0 - 0.7_f64.powi(3)) / 6.0).abs() < 1e-12); // two of 1/6; what they share counts once
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A file uses only those above it in this list:
//!
//! 1. [`clip`]: convex polygons cut by planes
//! 2. [`bins`]: which triangles of which bodies reach which layer
//! 3. [`surface_area`]: frontal and wetted area of what others cut; [`shadow`]: what surface in a cell covers, seen along an axis
//! 4. [`error`]; [`cells`]: cells, x and y faces of a layer, from sums along rows; `window`: which of them a body reaches
//! 5. [`z_faces`]: its z faces, from the section with their plane
//! 6. [`union`]: the exact union of bodies in a cell, from BSP trees of their surfaces
//! 7. `other_bodies`; `refined`: bounds of a cell; `division`: cells divided; `cell_unions`: cells that several bodies share; `walls`: faces in whose plane
//!    surface lies
//! 8. [`layer`]: what callers use: porosity of the layers of a grid, and the surface in them

pub mod bins;
mod cell_unions;
pub mod cells;
pub mod clip;
mod division;
pub mod error;
pub mod layer;
mod other_bodies;
mod refined;
pub mod shadow;
pub mod surface_area;
pub mod union;
mod walls;
mod window;
pub mod z_faces;

pub use other_bodies::OtherBodies;
pub use union::{MOST_PLANES, PlanarPart};
