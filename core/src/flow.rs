//! The Euler equations of a gas in a porous space (porosity / distributed resistance).
//!
//! Unknowns are pore averages: mass, momentum, and for an ideal gas energy, per open volume. With the open fraction `beta_v`
//! of each cell and `beta_x`, `beta_y`, `beta_z` of each face,
//!
//! ```text
//! d(beta_v rho)/dt   + div(beta_f rho u)   = 0
//! d(beta_v rho u)/dt + div(beta_f rho u u) = -beta_v grad p + beta_v rho g + R       R_i/beta_v = -rho (a_i + ½ CR_i |u|) u_i
//! d(beta_v rho E)/dt + div(beta_f rho H u) = beta_v rho g·u
//! ```
//!
//! The scheme is MUSCL-Hancock, unsplit, in primitive variables, with one Riemann problem per face and step. Axes that hold a
//! single cell are not part of a problem: the same text is compiled for one, two and three axes.
//!
//! Read in this order:
//!
//! 1. [`state`]: the gas, one cell, a field
//! 2. [`limiter`]: slopes; [`riemann`]: the flux through a face; [`drag`]: resistance of the obstacles, at any stiffness;
//!    [`boundary`]: the sides of the domain
//! 3. [`porosity`]: open fractions made ready: jumps, walls, small cells
//! 4. [`error`]: what a caller may get wrong
//! 5. [`problem`]: what stays the same during a step, and its contracts; [`step_report`]: what a step did; [`fallback`]: what happens
//!    to unphysical states
//! 6. `kernel`: one slab of one step, row by row
//! 7. [`step`]: one slab of one step, and the whole step
//!
//! The core holds no state and allocates nothing: the caller owns the old field, the new field and some scratch, and may cut the
//! new field into slabs and advance them side by side.
//!
//! A step in order: the flags from the open fractions, the clusters if cells are small, the problem, the first rate, steps.
//!
//! ```
//! use voidage_core::flow::{
//!     Boundary, Clusters, Error, Fields, FieldsMut, Gas, Mesh, Porosity, Problem, Scheme, mark,
//! };
//!
//! // A shock tube of eight cells, its right half half open.
//! let widths = [0.125; 8];
//! let mesh = Mesh { widths: [&widths] };
//! let beta_v = [1.0, 1.0, 1.0, 1.0, 0.5, 0.5, 0.5, 0.5];
//! let beta_x = [1.0, 1.0, 1.0, 1.0, 0.5, 0.5, 0.5, 0.5, 0.5];
//! let mut marks = [0; 8];
//! mark(&mesh, &beta_v, &[&beta_x], [false], 0.1, &mut marks)?;
//! let tube = Problem {
//!     mesh,
//!     gas: Gas::Ideal { gamma: 1.4 },
//!     boundaries: [[Boundary::Wall; 2]],
//!     scheme: Scheme::default(),
//!     porosity: Some(Porosity { volume: &beta_v, faces: [&beta_x], marks: &marks }),
//!     clusters: Clusters(&[]),
//!     drag: None,
//!     gravity: [0.0],
//! };
//!
//! let (mut density, mut momentum, mut energy) = ([1.0, 1.0, 1.0, 1.0, 0.1, 0.1, 0.1, 0.1], [0.0; 8], [2.5; 8]);
//! let (mut new_density, mut new_momentum, mut new_energy) = ([0.0; 8], [0.0; 8], [0.0; 8]);
//! energy[4..].fill(0.25);
//! let mut scratch = vec![0.0; tube.scratch_len()];
//! let mut rate = tube.rate(&Fields { density: &density, momentum: [&momentum], energy: &energy })?;
//! for _ in 0..5 {
//!     let old = Fields { density: &density, momentum: [&momentum], energy: &energy };
//!     let mut new =
//!         FieldsMut { density: &mut new_density, momentum: [&mut new_momentum], energy: &mut new_energy };
//!     rate = tube.step(&old, &mut new, 0.8 / rate, &mut [0; 8], &mut scratch)?.rate;
//!     (density, momentum, energy) = (new_density, new_momentum, new_energy);
//! }
//! let mass: f64 = (0..8).map(|i| beta_v[i] * widths[i] * density[i]).sum();
//! assert!((mass - 0.525).abs() < 1e-15 && momentum.iter().all(|m| *m >= 0.0));
//! # Ok::<(), Error>(())
//! ```
//!
//! Reference: E. F. Toro, *Riemann Solvers and Numerical Methods for Fluid Dynamics*, 3rd ed., ch. 14 and 16.

pub mod boundary;
pub mod drag;
pub mod error;
pub mod fallback;
mod kernel;
pub mod limiter;
pub mod porosity;
pub mod problem;
pub mod riemann;
pub mod state;
pub mod step;
pub mod step_report;

pub use boundary::Boundary;
pub use drag::Drag;
pub use error::Error;
pub use limiter::Limiter;
pub use porosity::clusters::Clusters;
pub use porosity::fractions::{Mesh, Porosity};
pub use porosity::mark::mark;
pub use problem::{PressureForm, Problem, Scheme};
pub use riemann::Riemann;
pub use state::{Conserved, Fields, FieldsMut, Gas, Primitive};
pub use step_report::Report;
