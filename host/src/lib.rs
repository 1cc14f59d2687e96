//! Volume and area porosity of triangles on structured grids, and gas flow through it: files, memory and threads around the
//! mathematics of [`voidage_core`].
//!
//! **Porosity of triangles in memory.** [`geometry::bodies`] makes closed bodies of them, [`porosity`] measures these on a grid.
//!
//! ```
//! use voidage::geometry::{bodies::Bodies, mesh::Mesh};
//! use voidage::porosity::{Options, porosity};
//! use voidage::{DVec3, grid::Edges};
//!
//! let corner = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];                  // a tetrahedron of volume 1/6
//! let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(|t| t.map(|v: usize| corner[v]));
//! let mut bodies = Bodies::default();
//! bodies.add(&Mesh::from(triangles.to_vec()), 1.0)?;                         // coordinates are metres
//! let edges = Edges([vec![0.0, 1.0, 2.0], vec![0.0, 1.0], vec![0.0, 1.0]]);
//! let found = porosity(&edges.grid(None)?, &bodies, Options::default());
//! assert!((found.beta.v[0] - 5.0 / 6.0).abs() < 1e-15);                      // open fraction of the first cell, x fastest
//! assert!((found.beta.x[0] - 0.5).abs() < 1e-15);                            // and of the face below it along x
//! # Ok::<(), voidage::error::Error>(())
//! ```
//!
//! A whole program with its `Cargo.toml`, from an STL file and a scene of pipes to fields, files and a flow, stands on the page of the
//! package, `README.md`; it runs as a test.
//!
//! | to … | use |
//! |---|---|
//! | read STL and OBJ files | [`geometry::read`] |
//! | make closed bodies of triangles, and hear what is wrong with them | [`geometry::bodies`] |
//! | read scene files, grids from files (feature `scene`) | `geometry::scene`, `grid::file` |
//! | make a grid | [`mod@grid`] |
//! | compute open fractions, and the resistance of obstacles | [`mod@porosity`], [`porosity::resistance`] |
//! | flow gas through them | [`mod@flow`] |
//! | write NumPy and ParaView files, whole or not at all | [`files`] |
//! | draw fields and curves (feature `pictures`) | `picture` |
//! | do what the command does (feature `cli`) | `command` |
//!
//! **Read → bodies → grid → porosity → files.** [`geometry::read`] takes STL and OBJ; what is wrong with the surface is said in
//! `bodies.warnings`.
//!
//! ```
//! use std::path::Path;
//! use voidage::files::npy;
//! use voidage::files::vtr::{CellField, NamedField, Vtr};
//! use voidage::geometry::{bodies::Bodies, read};
//! use voidage::grid::{GridSpec, edges};
//! use voidage::porosity::{Options, porosity};
//!
//! let mut bodies = Bodies::default();
//! bodies.add(&read::read(Path::new("../tests/fixtures/analytic_boxes_aligned.stl"))?, 1.0)?;
//! let edges = edges(&GridSpec::Cells([20, 20, 20], None), bodies.bounds(), &mut Vec::new())?;
//! let found = porosity(&edges.grid(None)?, &bodies, Options::default());
//! assert!(found.cells.cut > 0 && found.max_gap < 1e-9);
//!
//! let [x, y, z] = &edges.0;
//! let beta_v = NamedField { name: "beta_v", components: 1, data: &found.beta.v };
//! let directory = std::env::temp_dir().join(format!("voidage-example-{}", std::process::id()));
//! npy::write_all(&directory, &[("beta_v".into(), edges.cells(), &found.beta.v[..])])?;
//! Vtr { x, y, z, cell: vec![CellField::Values(beta_v)], ..Vtr::default() }.write(&directory.join("fields.vtr"))?;
//! # std::fs::remove_dir_all(&directory).expect("removed");
//! # Ok::<(), voidage::error::Error>(())
//! ```
//!
//! **Flow.** [`flow::Flow`] owns its fields and steps on all threads of the present pool; it takes open fractions, wherever they come from.
//!
//! ```
//! use voidage::flow::{Flow, Treatment};
//! use voidage::geometry::{bodies::Bodies, mesh::Mesh};
//! use voidage::porosity::{Options, porosity};
//! use voidage::voidage_core::flow::{Boundary, Gas, Primitive};
//! use voidage::{DVec3, grid::Edges};
//!
//! let corner = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
//! let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(|t| t.map(|v: usize| corner[v] * 0.5));
//! let mut bodies = Bodies::default();
//! bodies.add(&Mesh::from(triangles.to_vec()), 1.0)?;
//! let edges = Edges([0, 1, 2].map(|_| (0..=8).map(|i| f64::from(i) / 8.0).collect()));
//! let beta = porosity(&edges.grid(None)?, &bodies, Options::default()).beta;
//!
//! // A box of walls with that corner cut off, and a blast from the other side.
//! let widths = [0, 1, 2].map(|axis| edges.widths(axis));
//! let mut flow: Flow<f64, 3> = Flow::new(widths, Gas::Ideal { gamma: 1.4 }, [[Boundary::Wall; 2]; 3]);
//! let faces = [beta.x.to_vec(), beta.y.to_vec(), beta.z.to_vec()];
//! flow.set_porosity(beta.v.to_vec(), faces, Treatment::default()).expect("fractions of this grid");
//! let pressure = |x: f64| if x > 0.8 { 2.0 } else { 1.0 };
//! flow.fill(|[x, _, _]| Primitive { density: 1.0, velocity: [0.0; 3], pressure: pressure(x) });
//! let mass = flow.content().density;
//! flow.run(0.8, 0.2).expect("a physical state");
//! assert!((flow.content().density / mass - 1.0).abs() < 1e-13);
//! # Ok::<(), voidage::error::Error>(())
//! ```
//!
//! Data flows one way: [`grid`], [`geometry`] → [`porosity`] → [`flow`] → [`files`], `picture`; `command`, which nothing else uses, shows the
//! stages in order. Without the features `cli`, `pictures` and `scene` nothing here needs a terminal, a picture or a TOML file.
#![forbid(unsafe_code)]

/// The program on the page of the package is a test, too.
#[cfg(all(doctest, feature = "scene"))]
#[doc = include_str!("../README.md")]
struct PackagePage;

// Its tests run the program (`tests/cli`); tests in this package are of what stands below, and build in a sixth of the time without it.
#[cfg(all(feature = "cli", not(test)))]
pub mod command;
pub mod error;
pub mod files;
pub mod flow;
pub mod geometry;
pub mod grid;
pub mod huge;
#[cfg(feature = "scene")]
pub mod keys;
#[cfg(feature = "pictures")]
pub mod picture;
pub mod porosity;
pub mod text;
mod words;

pub use glam::DVec3;
pub use voidage_core;
