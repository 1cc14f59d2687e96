//! Bodies of which it cannot be told where they are solid.
//!
//! Their cells and faces keep the fractions that their surfaces give as they wind; but such a body may as well be a cavity of another, or
//! count a part twice, so all that is certain within its box is that fractions lie between closed and open.

use super::{FieldSet, Options, Porosity};
use crate::geometry::bodies::Bodies;
use std::ops::Range;
use voidage_core::grid::Grid;

/// Widens the bounds of all cells and faces within the boxes of doubtful bodies to 0…1.
pub fn widen(grid: &Grid<f64>, bodies: &Bodies, options: Options, found: &mut Porosity) {
    for body in bodies.bodies.iter().filter(|b| b.doubtful) {
        let [lo, hi] = body.bounds;
        let cells = [0, 1, 2].map(|a| reached(grid.edges(a), lo[a], hi[a]));
        if cells.iter().any(Range::is_empty) {
            continue;
        }
        found.max_gap = 1.0;
        for (set, value) in found.bounds.iter_mut().flatten().zip([0.0, 1.0]) {
            fill(grid, &cells, set, value, options.areas);
        }
    }
}

/// The cells along an axis that a run of coordinates reaches or touches.
fn reached(edges: &[f64], lo: f64, hi: f64) -> Range<usize> {
    edges.partition_point(|&e| e < lo).saturating_sub(1)..edges.partition_point(|&e| e <= hi).min(edges.len() - 1)
}

/// Sets some cells and all their faces.
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
