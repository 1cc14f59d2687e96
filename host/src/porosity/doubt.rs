//! Bodies of which it cannot be told where they are solid: within their boxes cells and faces are anything from open to closed.
//!
//! Such a body may as well be a cavity of another, so nothing that is known of its box holds.

use super::{FieldSet, Options, Porosity};
use crate::geometry::bodies::Bodies;
use std::ops::Range;
use voidage_core::grid::Grid;

/// Forget what was found within the boxes of doubtful bodies.
pub fn forget(grid: &Grid<f64>, bodies: &Bodies, options: Options, found: &mut Porosity) {
    for body in bodies.bodies.iter().filter(|b| b.doubtful) {
        let [lo, hi] = body.bounds;
        let cells = [0, 1, 2].map(|a| reached(grid.edges(a), lo[a], hi[a]));
        if cells.iter().any(Range::is_empty) {
            continue;
        }
        found.max_gap = 1.0;
        let middle = 1.0 - options.solid_end();
        forget_cells(grid, &cells, middle, found);
        let (low, high) = found.bounds.as_mut().map_or((None, None), |[low, high]| (Some(low), Some(high)));
        for (set, value) in [(Some(&mut found.beta), middle), (low, 0.0), (high, 1.0)] {
            if let Some(set) = set {
                fill(grid, &cells, set, value, options.areas);
            }
        }
    }
}

/// The cells along an axis that a run of coordinates reaches or touches.
fn reached(edges: &[f64], lo: f64, hi: f64) -> Range<usize> {
    edges.partition_point(|&e| e < lo).saturating_sub(1)..edges.partition_point(|&e| e <= hi).min(edges.len() - 1)
}

/// Correct the totals for cells that will have the porosity `middle`.
fn forget_cells(grid: &Grid<f64>, cells: &[Range<usize>; 3], middle: f64, found: &mut Porosity) {
    each(cells, |cell| {
        let open = found.beta.v[grid.cell_index(cell)];
        let size = [0, 1, 2].map(|a| grid.edges(a)[cell[a] + 1] - grid.edges(a)[cell[a]]);
        found.solid_volume += (open - middle) * size.iter().product::<f64>();
        if open == 0.0 || open == 1.0 {
            let kind = if open == 0.0 { &mut found.cells.closed } else { &mut found.cells.open };
            *kind = kind.saturating_sub(1);
            found.cells.cut += 1;
        }
    });
}

/// Set some cells and all their faces.
fn fill(grid: &Grid<f64>, cells: &[Range<usize>; 3], set: &mut FieldSet, value: f64, areas: bool) {
    each(cells, |cell| set.v[grid.cell_index(cell)] = value);
    for axis in 0..if areas { 3 } else { 0 } {
        let mut faces = cells.clone();
        faces[axis].end += 1;
        let field = match axis {
            0 => &mut set.x,
            1 => &mut set.y,
            _ => &mut set.z,
        };
        each(&faces, |face| field[grid.face_index(axis, face)] = value);
    }
}

fn each([x, y, z]: &[Range<usize>; 3], mut visit: impl FnMut([usize; 3])) {
    for k in z.clone() {
        for j in y.clone() {
            x.clone().for_each(|i| visit([i, j, k]));
        }
    }
}
