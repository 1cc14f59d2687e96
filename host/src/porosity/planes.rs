//! Corners that miss a grid plane by rounding are put into it.
//!
//! CAD writes 2.8e-17 where it means 0. A wall that misses the plane of a face by so little would block the face or not by
//! chance; in the plane it blocks it.

use glam::DVec3;
use rayon::prelude::*;
use voidage_core::grid::{Grid, Located};

/// Corners within this share of the grid's largest coordinate are in the plane: far below the digits of any `f32` file.
const NEAR: f64 = 1.0 / (1_u64 << 44) as f64;

/// A copy of the triangles with such corners moved; none if there are no such corners.
#[must_use]
pub fn into_planes(grid: &Grid<f64>, triangles: &[[DVec3; 3]]) -> Option<Vec<[DVec3; 3]>> {
    let near = [0, 1, 2].map(|axis| {
        let e = grid.edges(axis);
        e[0].abs().max(e[e.len() - 1].abs()) * NEAR
    });
    let moved = |p: DVec3| DVec3::from_array([0, 1, 2].map(|axis| nearest(grid, axis, p[axis], near[axis])));
    let any = triangles.par_iter().any(|t| t.iter().any(|&p| moved(p) != p));
    any.then(|| triangles.par_iter().map(|t| t.map(moved)).collect())
}

/// The plane within `near` of a coordinate, or the coordinate.
fn nearest(grid: &Grid<f64>, axis: usize, value: f64, near: f64) -> f64 {
    let edges = grid.edges(axis);
    let last = edges.len() - 1;
    let (below, above) = match grid.locate(axis, value) {
        Located::Below => (0, 0),
        Located::Cell(i) => (i, i + 1),
        Located::Above => (last, last),
    };
    if (value - edges[below]).abs() <= near {
        edges[below]
    } else if (edges[above] - value).abs() <= near {
        edges[above]
    } else {
        value
    }
}
