//! Solids known by formula in the layers of a grid: closed forms and quadrature, and sections where two of them share a cell.
//!
//! They enter [`crate::surface::layer::Layers`] beside bodies of triangles, as [`OtherBodies`](crate::surface::OtherBodies), or alone.
//!
//! ```
//! use glam::DVec3;
//! use voidage_core::convex::shape::Sphere;
//! use voidage_core::grid::Grid;
//! use voidage_core::solids::{RoundMemory, RoundShape, RoundSolid, RoundSolids};
//! use voidage_core::subdivide::{LeafRule, SubdivisionMemory, SubdivisionRule};
//! use voidage_core::surface::layer::{LayerMemory, LayerOptions, LayerSlices, Layers};
//! use voidage_core::surface::union::UnionMemory;
//!
//! // Two balls of one radius whose centres are one radius apart.
//! let ball = |x| RoundSolid::new(RoundShape::Sphere(Sphere { center: DVec3::new(x, 1.0, 1.0), radius: 0.5 }));
//! let solids = [ball(0.75).ok_or("no ball")?, ball(1.25).ok_or("no ball")?];
//! let edges = [0.0, 0.5, 1.0, 1.5, 2.0];
//! let grid = Grid::new(&edges, &edges, &edges)?;
//!
//! let needed = RoundSolids::<DVec3>::needed(&grid, solids.len());
//! let (mut sums, mut owners) = (vec![0.0; needed.places], vec![0; needed.places]);
//! let (mut near, mut facets) = (vec![Default::default(); needed.near], vec![0; needed.facets]);
//! let mut candidates = vec![Default::default(); needed.candidates];
//! let lists = SubdivisionMemory { candidates: &mut candidates, facets: &mut facets };
//! let memory = RoundMemory { sums: &mut sums, owners: &mut owners, near: &mut near, lists };
//! let rule = SubdivisionRule { leaf: LeafRule::Plane, depth: 6, tol: 1e-4 };
//! let mut others = RoundSolids::new(&grid, &solids, rule, memory)?;
//!
//! let (mut numbers, mut groups) = (vec![0; Layers::<DVec3>::needed(&grid, &[]).numbers], []);
//! let layers = Layers::new(&grid, &[], LayerOptions::default(), &mut numbers, &mut groups)?;
//! let needed = layers.memory_needed();
//! let (mut reals, mut flags, mut numbers) = (vec![0.0; needed.reals], vec![0; needed.flags], vec![0; needed.numbers]);
//! let mut memory = LayerMemory::new(&grid, &mut reals, &mut flags, &mut numbers, &mut [], UnionMemory::default())?;
//! let (mut beta_v, mut solid) = ([0.0; 64], 0.0);
//! let (mut x, mut y, mut z) = ([0.0; 80], [0.0; 80], [0.0; 80]);
//! for k in 0..4 {
//!     let slices = LayerSlices::of_fields(&grid, k, &mut beta_v, [&mut x, &mut y, &mut z])?;
//!     solid += layers.zeroed_layer(k, slices, None, &mut memory, &mut others, |_, _| ())?.solid_volume;
//! }
//! // Both, less the lens that they share.
//! let pi = core::f64::consts::PI;
//! assert!((solid - (2.0 * pi / 6.0 - 5.0 * pi / 96.0)).abs() < 1e-4);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! What stands here uses only what is above it in this list:
//!
//! 1. [`enclosure`]: solids between polytopes in a box, and bounds of what a union of them has of it
//! 2. [`quadric`]: fractions of cylinder, cone, ball, capsule, ellipsoid by closed forms; [`torus`]: fractions of tori and pipe bends by
//!    quadrature
//! 3. `round_shape`: a shape of a round kind, for GJK and for subdivision
//! 4. `round_solids`: solids in the caller's memory, as bodies of a layer

pub mod enclosure;
pub mod quadric;
mod round_shape;
mod round_solids;
pub mod torus;

pub use round_shape::RoundShape;
pub use round_solids::{RoundMemory, RoundNeeded, RoundSolid, RoundSolids};
