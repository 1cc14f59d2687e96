//! Passages that no face of the grid sees blocked: shadows of the solids in every cell.

use super::solid::{open_layer, solid_alone, with_solid_layers};
use super::{FieldSet, Options, Porosity};
use crate::geometry::bodies::Bodies;
use glam::DVec3;
use rayon::prelude::*;
use std::sync::{Mutex, PoisonError};
use voidage_core::grid::Grid;
use voidage_core::surface::layer::Layers;
use voidage_core::surface::shadow::{Shadow, ShadowEdge, ShadowMemory};

/// Shadows of the union of all solid bodies in the cells of a grid, `nx*ny*nz`, x fastest.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Shadows {
    /// Along x, y and z, which share of the lines through the cell meets solid in it or a blocked side of it.
    pub tau: [Vec<f64>; 3],
    /// Where in the cell that surface stands, 0 at the low side, 1 at the high one; along x, y and z.
    pub place: [Vec<f64>; 3],
    /// Cells that hold more surface than there is room for: in place of their shadow stands what their faces show.
    pub too_full: usize,
    /// Hidden passages along x, y and z.
    pub hidden: [HiddenPassages; 3],
}

/// Cells that are blocked across an axis by more than [`HIDDEN`] of their section beyond what either of their two faces shows, both of which
/// are open.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct HiddenPassages {
    /// How many.
    pub cells: usize,
    /// The first, as i, j, k from 0.
    pub first: Option<[usize; 3]>,
}

/// Blockage of its section that makes a cell between two open faces a hidden passage.
pub const HIDDEN: f64 = 0.95;

/// The shadows of the solid bodies among `bodies` on `grid`; `result` holds their porosities, faces included. Runs in the current rayon
/// pool.
#[must_use]
pub fn shadows(grid: &Grid<f64>, bodies: &Bodies, result: &Porosity, options: Options) -> Shadows {
    let own = solid_alone(grid, bodies, options);
    let beta = &own.as_ref().unwrap_or(result).beta;
    with_solid_layers(grid, bodies, options, |layers| of_layers(grid, layers, beta))
}

/// The shadows of bodies in layers, whose open fractions are known.
pub(super) fn of_layers(grid: &Grid<f64>, layers: &Layers<DVec3>, beta: &FieldSet) -> Shadows {
    let [nx, ny, nz] = grid.cells();
    let mut found = vec![Shadow::default(); nx * ny * nz];
    let buffers = Mutex::new(Vec::new());
    let too_full = found
        .par_chunks_mut(nx * ny)
        .enumerate()
        .map(|(k, found)| {
            let mut own = buffers.lock().unwrap_or_else(PoisonError::into_inner).pop().unwrap_or_else(Buffers::new);
            own.lists.resize(layers.shadow_lists_needed(k), 0);
            let too_full = layers.shadows(k, &open_layer(grid, k, beta), found, own.memory());
            buffers.lock().unwrap_or_else(PoisonError::into_inner).push(own);
            too_full.expect("slices of a layer fit its grid")
        })
        .sum();
    let by_axis = |of: &dyn Fn(&Shadow<f64>) -> [f64; 3]| [0, 1, 2].map(|a| found.iter().map(|s| of(s)[a]).collect());
    let tau: [Vec<f64>; 3] = by_axis(&|s| s.share);
    Shadows {
        too_full,
        hidden: [0, 1, 2].map(|axis| hidden(grid, axis, &tau[axis], beta)),
        place: by_axis(&|s| s.place),
        tau,
    }
}

/// Positions of the low and the high face of a cell along an axis.
pub fn faces_of_cell(grid: &Grid<f64>, axis: usize, [i, j, k]: [usize; 3]) -> [usize; 2] {
    let [nx, ny, _] = grid.face_shape(axis);
    let low = (k * ny + j) * nx + i;
    [low, low + [1, nx, nx * ny][axis]]
}

/// All cells of a grid, x fastest.
pub fn cells(grid: &Grid<f64>) -> impl Iterator<Item = [usize; 3]> {
    let [nx, ny, nz] = grid.cells();
    (0..nz).flat_map(move |k| (0..ny).flat_map(move |j| (0..nx).map(move |i| [i, j, k])))
}

fn hidden(grid: &Grid<f64>, axis: usize, tau: &[f64], beta: &FieldSet) -> HiddenPassages {
    let open = beta.faces(axis);
    let mut found = HiddenPassages::default();
    for (at, tau) in cells(grid).zip(tau) {
        let [low, high] = faces_of_cell(grid, axis, at).map(|face| open[face]);
        if low.min(high) > 0.0 && tau - (1.0 - low.min(high)) > HIDDEN {
            found.cells += 1;
            found.first = found.first.or(Some(at));
        }
    }
    found
}

/// Edges that a cell may hold, seen along one axis.
const MAX_EDGES: usize = 1 << 15;

/// A thread's memory.
struct Buffers {
    edges: Vec<ShadowEdge<f64>>,
    crossed: Vec<u32>,
    lists: Vec<u32>,
}

impl Buffers {
    fn new() -> Self {
        Buffers { edges: vec![ShadowEdge::default(); 3 * MAX_EDGES], crossed: vec![0; MAX_EDGES], lists: Vec::new() }
    }

    fn memory(&mut self) -> ShadowMemory<'_, f64> {
        ShadowMemory { edges: &mut self.edges, crossed: &mut self.crossed, lists: &mut self.lists }
    }
}
