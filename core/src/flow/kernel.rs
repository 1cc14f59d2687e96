//! One slab of one step, row by row.
//!
//! - `scratch`: the buffers, cut from the caller's memory
//! - `rows`: loops over the cells of a row
//! - `sweep`: the rows of a slab in order, in tiles that stay in a core's cache
//! - `reconstruct`: slopes and half step; `fluxes`: fluxes through faces; `walls_and_jumps`: both beside walls and porosity jumps;
//!   `update`: new states
//! - `long_line`: a long line of cells in pieces

pub(crate) mod fluxes;
pub(crate) mod long_line;
pub(crate) mod reconstruct;
pub(crate) mod rows;
pub(crate) mod scratch;
pub(crate) mod slab;
pub(crate) mod sweep;
pub(crate) mod update;
pub(crate) mod walls_and_jumps;
