//! Volume and area porosity of real geometry on structured grids.
//!
//! The crate is `no_std`, allocates nothing, holds no `unsafe` code but one instruction on ARM (`number/root.rs`) and works in `f32` and `f64` from one text.
//! Seven modules; each uses only those above it:
//!
//! 1. [`number`]: the two scalars, their vectors, boxes
//! 2. [`convex`]: convex bodies: do two meet (GJK), how far apart are they, with proof
//! 3. [`grid`]: cells, faces, index order; solid fractions of a layer, as bounds that bodies share
//! 4. [`surface`]: fractions from triangulated surfaces, overlaps counted once; callers use [`surface::layer`], with an example
//!    in [`surface`]
//! 5. [`subdivide`]: fractions of bodies by subdivision, GJK deciding
//! 6. [`solids`]: fractions of solids by formula, by closed forms and quadrature, alone and beside bodies of triangles
//! 7. [`flow`]: the Euler equations in a porous space; it uses [`number`] alone and sees porosity only as slices
//!
//! | to … | use |
//! |---|---|
//! | tell whether two convex bodies meet, how far apart they are | [`convex::meets`], [`convex::distance`] |
//! | measure triangulated bodies, overlaps counted once | [`surface::layer::Layers`] |
//! | measure cylinders, cones, balls, capsules, ellipsoids by closed forms | [`solids::quadric::QuadricSolid`] |
//! | measure tori and pipe bends | [`solids::torus::TorusSolid`] |
//! | bound the fractions of any convex body | [`subdivide`] |
//! | make open fractions ready for a flow, step it | [`flow::prepare`], [`flow::Problem`] |
//! | put `f32` or `f64` into one text | [`number`] |
//!
//! A whole program with its `Cargo.toml` stands on the page of the package, `README.md`: triangles to fields, two bodies, ten steps of
//! flow, with all constructors; it runs as a test.
//!
//! # Triangles to fields
//!
//! ```
//! use glam::DVec3;
//! use voidage_core::{grid::Grid, surface::bins::Surface, surface::layer::*, surface::union::UnionBuffers};
//!
//! let corner = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]; // a tetrahedron of volume 1/6
//! let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(|t| t.map(|v: usize| corner[v]));
//! let (bodies, edges) = ([Surface::new(&triangles)], [0.0, 0.5, 1.0]);
//! let grid = Grid::new(&edges, &edges, &edges)?;
//! // All memory is yours: for the triangles by layer, then for one layer at a time.
//! let needed = Layers::needed(&grid, &bodies);
//! let (mut ids, mut groups) = (vec![0; needed.numbers], vec![Default::default(); needed.groups]);
//! let layers = Layers::new(&grid, &bodies, LayerOptions::default(), &mut ids, &mut groups)?;
//! let needed = layers.memory_needed();
//! let (mut reals, mut flags) = (vec![0.0; needed.reals], vec![0; needed.flags]);
//! let (mut numbers, mut parts) = (vec![0; needed.numbers], vec![Default::default(); needed.groups]);
//! let mut union = UnionBuffers::<f64, 64>::default();
//! let mut memory = LayerMemory::new(&grid, &mut reals, &mut flags, &mut numbers, &mut parts, union.memory())?;
//! let (mut beta_v, mut beta_x, mut beta_y, mut beta_z) = ([0.0; 8], [0.0; 12], [0.0; 12], [0.0; 12]);
//! for k in 0..2 {
//!     let slices = LayerSlices::of_fields(&grid, k, &mut beta_v, [&mut beta_x, &mut beta_y, &mut beta_z])?;
//!     layers.layer(k, slices, None, &mut memory)?;
//! }
//! assert!((beta_v.iter().map(|b| (1.0 - b) / 8.0).sum::<f64>() - 1.0 / 6.0).abs() < 1e-15);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Two convex bodies
//!
//! ```
//! use glam::DVec3;
//! use voidage_core::convex::{self, AnyBody, Clearance, exact::Contact, shape::Cylinder};
//! use voidage_core::number::aabb::Aabb;
//!
//! let cell = AnyBody::new(Aabb { min: DVec3::ZERO, max: DVec3::ONE })?;
//! let pipe = AnyBody::new(Cylinder::new(DVec3::new(0.5, 0.5, -1.0), DVec3::new(0.5, 0.5, 2.0), 0.25))?;
//! assert_eq!(convex::meets(&cell, &pipe).contact(), Some(Contact::Overlapping));
//! let far = pipe.posed([DVec3::X, DVec3::Y, DVec3::Z], DVec3::new(2.0, 0.0, 0.0))?;
//! let Clearance::Apart { lower, upper, .. } = convex::distance(&cell, &far) else { panic!("they are apart") };
//! assert!(lower <= 1.25 && 1.25 <= upper && upper - lower < 1e-9);
//! # Ok::<(), convex::BodyError>(())
//! ```
//!
//! # One step of flow
//!
//! ```
//! use voidage_core::flow::{
//!     Boundary, Error, Fields, FieldsMut, Fractions, Gas, Merging, Mesh, Problem, Treatment, cluster_scratch, prepare,
//!     scratch_needed,
//! };
//!
//! // A shock tube of eight cells, its right half half open.
//! let widths = [0.125; 8];
//! let mesh = Mesh::new([&widths])?;
//! let mut beta_v = [1.0, 1.0, 1.0, 1.0, 0.5, 0.5, 0.5, 0.5];
//! let mut beta_x = [1.0, 1.0, 1.0, 1.0, 0.5, 0.5, 0.5, 0.5, 0.5];
//! let (mut flags, mut list, mut parent, mut work) = ([0; 8], [0; 8], [0; 8], [0.0; cluster_scratch(8)]);
//! let fractions = Fractions { volume: &mut beta_v[..], faces: [&mut beta_x[..]], flags: &mut flags[..] };
//! let space = prepare(&mesh, [false], fractions, Treatment::default(), |_cells| Merging {
//!     list: &mut list[..],
//!     parent: &mut parent[..],
//!     scratch: &mut work[..],
//! })?;
//! let gas = Gas::Ideal { gamma: 1.4 };
//! let tube = Problem::new(mesh, gas, [[Boundary::Wall; 2]])?.with_porosity(space.view())?;
//!
//! let (mut density, mut momentum, mut energy) = ([1.0, 1.0, 1.0, 1.0, 0.1, 0.1, 0.1, 0.1], [0.0; 8], [2.5; 8]);
//! let (mut new_density, mut new_momentum, mut new_energy) = ([0.0; 8], [0.0; 8], [0.0; 8]);
//! energy[4..].fill(0.25);
//! let mut scratch = [0.0; scratch_needed([8])];
//! let mut rate =
//!     tube.start(&mut FieldsMut { density: &mut density, momentum: [&mut momentum], energy: &mut energy, capacity: &mut [] })?;
//! for _ in 0..5 {
//!     let old = Fields { density: &density, momentum: [&momentum], energy: &energy, capacity: &[] };
//!     let mut new =
//!         FieldsMut { density: &mut new_density, momentum: [&mut new_momentum], energy: &mut new_energy, capacity: &mut [] };
//!     rate = tube.step(&old, &mut new, 0.8 / rate, &mut [0; 8], &mut scratch)?.rate;
//!     (density, momentum, energy) = (new_density, new_momentum, new_energy);
//! }
//! let mass: f64 = (0..8).map(|i| space.view().volume()[i] * widths[i] * density[i]).sum();
//! assert!((mass - 0.525).abs() < 1e-15 && momentum.iter().all(|m| *m >= 0.0));
//! # Ok::<(), Error>(())
//! ```
#![cfg_attr(not(feature = "std"), no_std)]
#![cfg_attr(any(feature = "std", not(target_arch = "arm")), forbid(unsafe_code))]
#![deny(unsafe_code)]

/// The examples of the page of the package are tests, too.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct PackagePage;

pub mod convex;
pub mod flow;
pub mod grid;
pub mod number;
pub mod solids;
pub mod subdivide;
pub mod surface;
