//! Bodies of which it cannot be told where they are solid.
//!
//! - [`Doubt::Perhaps`]: all that the body holds is solid, or all is open. It counts as solid; the lower bounds are those with it, the upper ones those
//!   without it.
//! - [`Doubt::Unknown`]: not even that is known. Values are what its surface gives as it winds. The body may as well be a cavity of another, or count
//!   a part twice, so the bounds of all cells and faces in its box are 0 and 1.
//! - Where a body's rows of cells do not return to zero, a piece of its surface is missing or counted twice: bounds are as far apart as that may change
//!   anything in the layer.
//! - Holes whose rims are not plane: all that lies in a box around the rim is solid or open.

use super::windows::Window;
use super::{FieldSet, Options, Porosity, snap};
use crate::geometry::bodies::{Bodies, Body, Doubt};
use glam::DVec3;
use std::collections::BTreeMap;
use std::ops::Range;
use voidage_core::grid::Grid;

/// The bodies without those that may as well be open, if there are such.
#[must_use]
pub fn without_perhaps(bodies: &Bodies) -> Option<Bodies> {
    let perhaps = |b: &Body| b.doubt == Doubt::Perhaps;
    bodies.bodies.iter().any(perhaps).then(|| {
        let mut sure = bodies.clone();
        for body in sure.bodies.iter_mut().filter(|b| perhaps(b)) {
            body.triangles.end = body.triangles.start;
        }
        sure
    })
}

/// Takes the upper bounds from what was found for less solid.
pub fn open_upwards(found: &mut Porosity, less: Porosity) {
    let (Some([lower, upper]), Some([_, most])) = (&mut found.bounds, less.bounds) else { return };
    *upper = most;
    let gap = |lower: &[f64], upper: &[f64]| lower.iter().zip(upper).fold(0.0, |gap, (l, u)| f64::max(gap, u - l));
    let gaps = [(&lower.v, &upper.v), (&lower.x, &upper.x), (&lower.y, &upper.y), (&lower.z, &upper.z)];
    found.max_gap = gaps.into_iter().fold(found.max_gap, |most, (l, u)| most.max(gap(l, u)));
}

/// Widens the bounds of all cells and faces within the boxes of doubtful bodies to 0…1.
pub fn widen(grid: &Grid<f64>, bodies: &Bodies, options: Options, found: &mut Porosity) {
    for body in bodies.bodies.iter().filter(|b| b.doubt == Doubt::Unknown) {
        let Some(Window { cells }) = Window::around(grid, snap::reach(grid, body)) else { continue };
        found.max_gap = 1.0;
        for (set, value) in found.bounds.iter_mut().flatten().zip([0.0, 1.0]) {
            change(grid, &cells, set, options.areas, |_, _| value);
        }
    }
}

/// Widens the bounds of all cells and faces that boxes in which it is not known what is solid reach, by what they have in common.
pub fn widen_unknown(grid: &Grid<f64>, bodies: &Bodies, options: Options, found: &mut Porosity) {
    for [lo, hi] in bodies.bodies.iter().flat_map(|b| b.unknown.iter().copied()) {
        let Some(Window { cells }) = Window::around(grid, [lo, hi]) else { continue };
        let share = |place: Place| place.share_within(grid, [lo, hi]);
        let mut gap = 0.0_f64;
        spread(grid, &cells, options.areas, &mut found.bounds, share);
        each(&cells, |at| gap = gap.max(2.0 * share(Place { axis: None, at })));
        found.max_gap = (found.max_gap + gap).min(1.0);
    }
}

/// Widens bounds in the boxes of bodies that leak: the body, the layer and how far its worst row there ends from zero, as a fraction of a face; infinite if it
/// was not measured in any layer. What a row misses at its end any cell or face of it may miss, and more where what is missing has parts that cancel. Returns by
/// how much more bounds may be apart in one place.
pub fn widen_leaking(
    grid: &Grid<f64>,
    bodies: &Bodies,
    areas: bool,
    leaks: impl Iterator<Item = (usize, usize, f64)>,
    bounds: &mut Option<[FieldSet; 2]>,
) -> f64 {
    let mut by_body: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    for (body, layer, fraction) in leaks {
        let by = by_body.entry(body).or_insert_with(|| vec![0.0; grid.cells()[2]]);
        let layers = if fraction.is_finite() { layer..layer + 1 } else { 0..by.len() };
        by[layers].iter_mut().for_each(|by| *by = (4.0 * fraction).min(1.0).max(*by));
    }
    let mut apart = 0.0;
    for (body, by) in by_body {
        let Some(Window { cells }) = Window::around(grid, snap::reach(grid, &bodies.bodies[body])) else { continue };
        let of_layer = |layer: Option<usize>| layer.and_then(|k| by.get(k)).copied().unwrap_or(0.0);
        spread(grid, &cells, areas, bounds, |place| match (place.axis, place.at[2]) {
            // Beside two layers.
            (Some(2), plane) => of_layer(plane.checked_sub(1)).max(of_layer(Some(plane))),
            (_, layer) => of_layer(Some(layer)),
        });
        apart += 2.0 * by.iter().copied().fold(0.0, f64::max);
    }
    apart
}

/// Widens the bounds of all cells and faces within the boxes of bodies that were cut, by what the rounding of their new corners may change.
pub fn allow_for_rounding(grid: &Grid<f64>, bodies: &Bodies, options: Options, found: &mut Porosity) {
    for body in bodies.bodies.iter().filter(|b| b.rounding > 0.0) {
        let Some(Window { cells }) = Window::around(grid, snap::reach(grid, body)) else { continue };
        // If all surface moved by the rounding on both sides, a cell would change by this share of its width.
        let share = |axis: usize| {
            let widths = grid.edges(axis)[cells[axis].start..=cells[axis].end].windows(2).map(|w| w[1] - w[0]);
            2.0 * body.rounding / widths.fold(f64::INFINITY, f64::min)
        };
        let by = share(0) + share(1) + share(2);
        found.max_gap = (found.max_gap + 2.0 * by).min(1.0);
        spread(grid, &cells, options.areas, &mut found.bounds, |_| by);
    }
}

/// Moves the lower bounds of some cells and all their faces down and the upper ones up, from 0 to 1.
fn spread(
    grid: &Grid<f64>,
    cells: &[Range<usize>; 3],
    areas: bool,
    bounds: &mut Option<[FieldSet; 2]>,
    by: impl Fn(Place) -> f64,
) {
    for (set, sign) in bounds.iter_mut().flatten().zip([-1.0, 1.0]) {
        change(grid, cells, set, areas, |beta, place| (beta + sign * by(place)).clamp(0.0, 1.0));
    }
}

/// A cell of a grid, or the face normal to an axis that begins there.
#[derive(Clone, Copy)]
struct Place {
    axis: Option<usize>,
    at: [usize; 3],
}

impl Place {
    /// Which share of it lies in a box.
    fn share_within(self, grid: &Grid<f64>, [lo, hi]: [DVec3; 2]) -> f64 {
        let along = |a: usize| {
            let edges = grid.edges(a);
            let from = edges[self.at[a]];
            if self.axis == Some(a) {
                return f64::from(u8::from(lo[a] <= from && from <= hi[a]));
            }
            let to = edges[self.at[a] + 1];
            ((to.min(hi[a]) - from.max(lo[a])) / (to - from)).clamp(0.0, 1.0)
        };
        along(0) * along(1) * along(2)
    }
}

/// Changes the values of some cells and of all their faces.
fn change(
    grid: &Grid<f64>,
    cells: &[Range<usize>; 3],
    set: &mut FieldSet,
    areas: bool,
    to: impl Fn(f64, Place) -> f64,
) {
    let to = |value: &mut f64, axis: Option<usize>, at: [usize; 3]| *value = to(*value, Place { axis, at });
    each(cells, |cell| to(&mut set.v[grid.cell_index(cell)], None, cell));
    for axis in 0..if areas { 3 } else { 0 } {
        let mut faces = cells.clone();
        faces[axis].end += 1;
        let field = match axis {
            0 => &mut set.x,
            1 => &mut set.y,
            _ => &mut set.z,
        };
        each(&faces, |face| to(&mut field[grid.face_index(axis, face)], Some(axis), face));
    }
}

fn each([x, y, z]: &[Range<usize>; 3], mut visit: impl FnMut([usize; 3])) {
    for k in z.clone() {
        for j in y.clone() {
            x.clone().for_each(|i| visit([i, j, k]));
        }
    }
}
