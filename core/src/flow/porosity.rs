//! The porous space of the flow: open fractions of cells and faces, and what follows from them before the first step.
//!
//! - [`fractions`]: mesh and open fractions as the caller's slices
//! - [`flags`]: one byte per cell: jumps, walls, small and sealed cells
//! - `cell_walls`: what kind of wall a cell holds, and how far the gas flows along it
//! - `areas`: open areas along one axis at the cells of a row
//! - `mark`: the flags from the open fractions
//! - [`throat`], `jump`: fluxes where the porosity jumps; `oblique_jump`: across a border askew to the grid
//! - [`clusters`]: small cells that share one state with a neighbour; `cluster_averages`: that state
//! - [`mod@prepare`]: all of that in one call

pub(crate) mod areas;
pub(crate) mod cell_walls;
pub(crate) mod cluster_averages;
pub mod clusters;
pub mod flags;
pub mod fractions;
pub(crate) mod jump;
pub(crate) mod mark;
pub(crate) mod oblique_jump;
pub mod prepare;
pub mod throat;
