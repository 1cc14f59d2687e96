//! One slab of one step, row by row.
//!
//! - `scratch`: the buffers, cut from the caller's memory
//! - `rows`: loops over the cells of a row, `row_slopes` those for their slopes; `mixed`: what comes to them for a mixed gas
//! - `slab`: what a step reads, and where each row stands in the window
//! - `contractions`: how far the gas of the cells in the window passes their walls as contractions, and how far jumps act
//! - `slopes_at_breaks`, `fluxes_at_breaks`: slopes and fluxes beside walls and porosity jumps
//! - `inclined_walls`: the half step beside walls askew to the grid
//! - `positive_fluxes`: fluxes beside cells that nothing else keeps physical
//! - `reconstruct`: slopes and half step; `fluxes`: fluxes through faces, by the loop over them in `face_fluxes`; `update`: new states
//! - `side_throats`: ghosts beyond openings in the sides of the domain
//! - `shocks`: fluxes through faces that lie along a strong shock
//! - `wall_pushes`: what the walls of watched cells feel of the fluxes
//! - `solver_calls`: what differs from one Riemann solver to another
//! - `sweep`: the rows of a slab in order, in tiles that stay in a core's cache
//! - `flux_choice`: which solvers and gases of the sweep a program links
//! - `long_line`: a long line of cells in pieces

pub(crate) mod contractions;
pub(crate) mod face_fluxes;
pub(crate) mod flux_choice;
pub(crate) mod fluxes;
pub(crate) mod fluxes_at_breaks;
pub(crate) mod inclined_walls;
pub(crate) mod long_line;
pub(crate) mod mixed;
pub(crate) mod positive_fluxes;
pub(crate) mod reconstruct;
pub(crate) mod row_slopes;
pub(crate) mod rows;
pub(crate) mod scratch;
pub(crate) mod shocks;
pub(crate) mod side_throats;
pub(crate) mod slab;
pub(crate) mod slopes_at_breaks;
pub(crate) mod solver_calls;
pub(crate) mod sweep;
pub(crate) mod update;
pub(crate) mod wall_pushes;
