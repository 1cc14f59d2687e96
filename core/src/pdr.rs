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
//! 1. [`state`] — the gas, one cell, a field
//! 2. [`limiter`] — slopes
//! 3. [`flux`] — the Riemann problem at a face
//! 4. [`throat`] — the same where the porosity jumps
//! 5. [`drag`] — resistance of the obstacles, at any stiffness
//! 6. [`boundary`] — the sides of the domain
//! 7. [`medium`] — porosity as slices, and marks
//! 8. [`merge`] — small cells
//! 9. [`step`] — the problem, one slab of one step
//! 10. [`report`] — what a step did; [`repair`] — the whole step, and what happens to unphysical states
//! 11. `line` — a long line of cells in pieces
//! 12. `sweep` — a slab row by row: `reconstruct` (slopes, half step), `faces` (fluxes), `breaks` (both beside walls and jumps),
//!     `finish` (new states), on the buffers of `work` with the loops of `row`
//!
//! The core holds no state and allocates nothing: the caller owns the old field, the new field and some scratch, and may cut the
//! new field into slabs and advance them side by side.
//!
//! Reference: E. F. Toro, *Riemann Solvers and Numerical Methods for Fluid Dynamics*, 3rd ed., ch. 14 and 16.

pub mod boundary;
mod breaks;
pub mod drag;
mod ducts;
mod faces;
mod finish;
pub mod flux;
mod jump;
pub mod limiter;
mod line;
pub mod marks;
pub mod medium;
pub mod merge;
mod reconstruct;
pub mod repair;
pub mod report;
mod row;
pub mod state;
pub mod step;
mod sweep;
pub mod throat;
mod work;

pub use boundary::Boundary;
pub use drag::Drag;
pub use flux::Riemann;
pub use limiter::Limiter;
pub use medium::{Mesh, Porosity, mark};
pub use merge::Clusters;
pub use report::Report;
pub use state::{Conserved, Fields, FieldsMut, Gas, Primitive};
pub use step::{Error, PressureForm, Problem, Scheme};
