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
//! A mixed gas, burnt beside fresh, has a ratio of specific heats gamma in each cell, which goes with the gas: 1/(gamma − 1) is advected by the flux of
//! volume that moves the energy (`kernel::mixed`), so that pressure and velocity stay uniform where they are, whatever gases meet.
//!
//! The scheme is MUSCL-Hancock, unsplit, in primitive variables, with one Riemann problem per face and step. Axes that hold a
//! single cell are not part of a problem: the same text is compiled for one, two and three axes.
//!
//! Read in this order:
//!
//! 1. [`state`]: the gas, one cell, a field
//! 2. [`limiter`]: slopes; [`face_gas`], [`riemann`]: the flux through a face; [`drag`]: resistance of the obstacles, at any stiffness;
//!    [`boundary`]: the sides of the domain
//! 3. [`error`]: what a caller may get wrong
//! 4. [`mod@porosity`]: open fractions made ready: jumps, walls, small cells
//! 5. [`problem`]: what stays the same during a step, and its contracts; [`step_report`]: what a step did; [`fallback`]: what happens
//!    to unphysical states; [`wall_forces`]: what the walls of watched cells felt
//! 6. `kernel`: one slab of one step, row by row
//! 7. [`step`]: the calls: a slab, merging, the whole step with its fallbacks; [`mod@stable_step`]: how long a step may be
//!
//! The core holds no state and allocates nothing: the caller owns the old field, the new field and some scratch, and may cut the
//! new field into slabs and advance them side by side.
//!
//! The calls of a caller in the order that the types enforce: [`prepare`] makes open fractions ready, [`Problem`] takes them, [`Problem::start`] a
//! starting field, [`Problem::step`] steps. The crate page has an example. Lengths are checked where slices come in, so nothing
//! panics on a caller's data.
//!
//! Reference: E. F. Toro, *Riemann Solvers and Numerical Methods for Fluid Dynamics*, 3rd ed., ch. 14 and 16.

pub mod boundary;
pub mod drag;
pub mod error;
pub mod face_gas;
pub mod fallback;
mod kernel;
pub mod limiter;
pub mod porosity;
pub mod problem;
pub mod riemann;
pub mod stable_step;
pub mod state;
pub mod step;
pub mod step_report;
pub mod wall_forces;

pub use boundary::{Boundary, Feed, Patch};
pub use drag::Drag;
pub use error::Error;
pub use kernel::flux_choice::{AnyFlux, AnyGas, Barotropic, FluxChoice, MixedGas, OneFlux, WithEnergy};
pub use limiter::Limiter;
pub use porosity::clusters::cluster_scratch;
pub use porosity::fractions::Mesh;
pub use porosity::prepare::{Fractions, Merging, Prepared, PreparedView, Tidied, Treatment, prepare};
pub use problem::{PressureForm, Problem, Scheme};
pub use riemann::Riemann;
pub use stable_step::{StableStep, stable_step};
pub use state::{Conserved, Fields, FieldsMut, Gas, Primitive};
pub use step::scratch_needed;
pub use step_report::Report;
pub use wall_forces::{CellPush, WatchedWalls};
