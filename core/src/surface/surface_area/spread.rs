//! A triangle spread over the cells of a layer.

use crate::grid::Grid;
use crate::number::real::Real;
use crate::surface::clip::{Polygon, keep, split};

/// Where a piece of surface lies.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Place {
    /// Inside a cell.
    Inside,
    /// In the plane of a face; it counts for the cell into which its normal points.
    InPlane,
    /// In the plane above a layer, whichever way its normal points; told beside the others, and counts for nothing.
    Top,
}

/// Hand over the part of a triangle in each cell of layer `k`: the cell's numbers along x and y, the place and the polygon.
pub(super) fn spread<R: Real>(
    grid: &Grid<R>,
    k: usize,
    corners: &[[R; 3]; 3],
    each: &mut impl FnMut([usize; 2], Place, &Polygon<R>),
) {
    let whole = Polygon::new(corners);
    let normal = whole.doubled_area();
    let [x, y, z] = [0, 1, 2].map(|axis| grid.edges(axis));
    let mut columns = |j: usize, place: Place, row: &Polygon<R>| match beside_plane(row, 0, x, normal[0]) {
        Some(None) => {}
        Some(Some(i)) => each([i, j], Place::InPlane, row),
        None => strips(row, 0, x, &mut |i, piece| each([i, j], place, piece)),
    };
    let mut rows = |place: Place, slab: &Polygon<R>| match beside_plane(slab, 1, y, normal[1]) {
        Some(None) => {}
        Some(Some(j)) => columns(j, Place::InPlane, slab),
        None => strips(slab, 1, y, &mut |j, row| columns(j, place, row)),
    };
    match beside_plane(&whole, 2, z, normal[2]) {
        Some(Some(layer)) if layer == k => rows(Place::InPlane, &whole),
        Some(_) => {}
        None => {
            if let Some(&[lo, hi]) = z.get(k..).and_then(|z| z.first_chunk()) {
                between(&whole, 2, [lo, hi], &mut |slab| rows(Place::Inside, slab));
            }
        }
    }
}

/// Of a polygon in a plane of the grid normal to an axis, the cell into which its normal points, if there is one; none if it lies in no
/// such plane.
fn beside_plane<R: Real>(polygon: &Polygon<R>, axis: usize, edges: &[R], normal: R) -> Option<Option<usize>> {
    let (min, max) = polygon.extent(axis);
    if min != max {
        return None;
    }
    let plane = edges.partition_point(|&e| e < min);
    if edges.get(plane) != Some(&min) {
        return None;
    }
    let cell = if normal > R::ZERO { Some(plane) } else { plane.checked_sub(1) };
    Some(cell.filter(|cell| cell + 1 < edges.len()))
}

/// The part of a polygon between two planes, if there is any.
fn between<R: Real>(whole: &Polygon<R>, axis: usize, [lo, hi]: [R; 2], each: &mut impl FnMut(&Polygon<R>)) {
    let (min, max) = whole.extent(axis);
    if min >= lo && max <= hi {
        return each(whole);
    }
    if !(min < hi && max > lo) {
        return;
    }
    let (mut above, mut part) = (Polygon::default(), Polygon::default());
    keep(whole, axis, lo, true, &mut above);
    keep(&above, axis, hi, false, &mut part);
    if !part.is_empty() {
        each(&part);
    }
}

/// The parts of a polygon between neighbouring edges, with the number of the cell between them.
fn strips<R: Real>(whole: &Polygon<R>, axis: usize, edges: &[R], each: &mut impl FnMut(usize, &Polygon<R>)) {
    let (min, max) = whole.extent(axis);
    let (Some(&lowest), Some(&highest)) = (edges.first(), edges.last()) else { return };
    if !(min < highest && max > lowest) {
        return;
    }
    let first = edges.partition_point(|&e| e <= min).saturating_sub(1);
    if min >= lowest && edges.get(first + 1).is_some_and(|&upper| max <= upper) {
        return each(first, whole);
    }
    let (mut rest, mut part, mut spare) = (Polygon::default(), Polygon::default(), Polygon::default());
    keep(whole, axis, lowest, true, &mut rest);
    for (cell, &upper) in edges.iter().enumerate().skip(first + 1).map(|(n, e)| (n - 1, e)) {
        split(&rest, axis, upper, &mut part, &mut spare);
        core::mem::swap(&mut rest, &mut spare);
        if !part.is_empty() {
            each(cell, &part);
        }
        if max <= upper {
            return;
        }
    }
}
