//! Gas of a region that a wall parts from the rest of it: where the wall stands within a cell, the cell belongs to one side of it, and holds what the region has
//! on the other.

use super::state::centre;
use crate::flow::Flow;
use crate::grid::Edges;
use crate::words::counted;

/// How much of a region with these `shares` of cells is so, in words; none if nothing is: cells that it holds in part and from which no open face leads, from one
/// cell of it to the next, to one that it fills. `held` tells how much of the open part of a cell is the region's.
pub fn told<const D: usize>(
    flow: &Flow<f64, D>,
    shares: &[(usize, f64)],
    edges: &Edges,
    held: impl Fn(usize, f64) -> f64,
) -> Option<String> {
    let faces: Vec<&[f64]> = flow.faces().collect();
    if faces.is_empty() {
        return None;
    }
    let mut waits = vec![false; flow.len()];
    shares.iter().for_each(|&(cell, _)| waits[cell] = flow.open_volume(cell) > 0.0);
    let filled = shares.iter().filter(|(_, share)| *share == 1.0);
    let mut stack: Vec<usize> =
        filled.map(|(cell, _)| *cell).filter(|&cell| std::mem::take(&mut waits[cell])).collect();
    if stack.is_empty() {
        return None;
    }
    let cells = flow.cells();
    while let Some(cell) = stack.pop() {
        let (at, mut step) = (flow.coordinates(cell), 1);
        for d in 0..D {
            let is_open = |side: usize| faces[d][flow.face(d, at, side)] > 0.0;
            let below = (at[d] > 0 && is_open(0)).then(|| cell - step);
            let above = (at[d] + 1 < cells[d] && is_open(1)).then(|| cell + step);
            stack.extend([below, above].into_iter().flatten().filter(|&next| std::mem::take(&mut waits[next])));
            step *= cells[d];
        }
    }
    let volume = |cells: &[(usize, f64)]| -> f64 {
        cells.iter().map(|&(cell, share)| held(cell, share) * flow.open_volume(cell)).sum()
    };
    let is_cut_off = |&(cell, share): &(usize, f64)| waits[cell] && held(cell, share) > 0.0;
    let cut_off: Vec<(usize, f64)> = shares.iter().copied().filter(is_cut_off).collect();
    let (first, _) = *cut_off.first()?;
    let percent = 100.0 * volume(&cut_off) / volume(shares);
    let ([x, y, z], cells) = (centre(edges, first).map(|x| x as f32), counted(cut_off.len(), "cell", "cells"));
    Some(format!(
        "is parted by walls thinner than a cell: in {cells}, the first at ({x}, {y}, {z}) m, {percent:.2} % of its gas is on the other side from the beginning, \
         as such a cell belongs to the side beyond the wall; let it end where the cells before the wall end, or take cells no wider than the wall"
    ))
}
