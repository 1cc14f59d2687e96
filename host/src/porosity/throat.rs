//! Faces that see what stands between them: walls are tight wherever they lie.

use super::fields::FieldSet;
use super::shadows::{Shadows, faces_of_nth_cell, place_of_cell};
use super::{Options, Porosity, porosity};
use crate::geometry::bodies::Bodies;
use crate::grid::Edges;
use voidage_core::grid::Grid;

/// What the open fraction of a face means.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Faces {
    /// What is open in the plane of the face: exact, but a wall between two planes is not seen.
    #[default]
    Plane,
    /// What can pass: where a cell blocks more than its two faces show, one of them is lowered to that.
    Throat,
}

/// A face is lowered only by more than this, and one of two is preferred only by more: less is rounding.
const LEAST: f64 = 1e-9;

/// Lowers, in each cell and along each axis, one face to the share of lines that pass: the nearer one to what stands in the cell, or the one that shows more
/// of it already if the other shows less by more than what is hidden. So what is hardly hidden hardly changes anything. Of two that are alike in this
/// it is the one towards the middle of the grid, and both in the middle cell: mirrored scenes have mirrored faces. Returns how many faces were lowered.
pub fn lower(grid: &Grid<f64>, result: &mut Porosity, shadows: &Shadows) -> usize {
    lower_within(grid, result, shadows, ([0; 3], grid.cells()))
}

/// The same for a grid that is a part of a larger one, whose middle counts: `first` is its first cell there, and the larger one has so many `cells`.
pub fn lower_within(
    grid: &Grid<f64>,
    result: &mut Porosity,
    shadows: &Shadows,
    (first, count): ([usize; 3], [usize; 3]),
) -> usize {
    let mut lowered = 0;
    let Porosity { beta, bounds, max_gap, .. } = result;
    for axis in 0..3 {
        let (faces, count) = (|n: usize| faces_of_nth_cell(grid, axis, n), count[axis]);
        let before: Vec<[f64; 2]> = {
            let open = beta.faces(axis);
            shadows.standing.iter().map(|&n| faces(n).map(|face| open[face])).collect()
        };
        for (&n, open) in shadows.standing.iter().zip(before) {
            let place = first[axis] + place_of_cell(grid, n)[axis];
            let Some((passes, wanted)) = face_to_lower(shadows, (axis, n), open, (place, count)) else { continue };
            for (face, _) in faces(n).into_iter().zip(wanted).filter(|(_, wanted)| *wanted) {
                let lower_to = |set: &mut FieldSet, most: f64| {
                    let open = &mut set.faces_mut(axis)[face];
                    *open = open.min(most.clamp(0.0, 1.0));
                };
                lower_to(beta, passes);
                if let Some([lowest, highest]) = bounds {
                    lower_to(lowest, passes - shadows.doubt);
                    lower_to(highest, passes + shadows.doubt);
                }
                *max_gap = max_gap.max(2.0 * shadows.doubt);
                lowered += 1;
            }
        }
    }
    lowered
}

/// A face in a side of the grid that is lowered to what an obstacle in its cell leaves open.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoweredSide {
    /// The cell, x fastest.
    pub cell: usize,
    /// Axis of the face.
    pub axis: usize,
    /// 0 for the low side of the grid, 1 for the high one.
    pub side: usize,
    /// Open fraction in the plane of the face, or as the gas within sees it.
    pub shown: f64,
    /// Open fraction once it is lowered.
    pub passes: f64,
}

/// The faces in sides of the grid that [`lower`] will lower; `beta` holds the open fractions in the planes of faces.
#[must_use]
pub fn lowered_sides(grid: &Grid<f64>, beta: &FieldSet, shadows: &Shadows) -> Vec<LoweredSide> {
    let mut found = Vec::new();
    for (axis, &cell) in (0..3).flat_map(|axis| shadows.standing.iter().map(move |cell| (axis, cell))) {
        let (place, count) = (place_of_cell(grid, cell)[axis], grid.cells()[axis]);
        let ends = [place == 0, place + 1 == count];
        if ends == [false; 2] {
            continue;
        }
        let open = faces_of_nth_cell(grid, axis, cell).map(|face| beta.faces(axis)[face]);
        let Some((passes, wanted)) = face_to_lower(shadows, (axis, cell), open, (place, count)) else { continue };
        for side in (0..2).filter(|&side| wanted[side] && ends[side]) {
            found.push(LoweredSide { cell, axis, side, shown: open[side], passes: passes.clamp(0.0, open[side]) });
        }
    }
    found
}

/// What is nearer to a side than this share of a cell, or than so many times the rounding of its plane, stands on the side.
const ON_SIDE: f64 = 1e-6;
const ON_SIDE_ROUNDED: f64 = 64.0;

/// A share of a face, in which less than this may be what reaches into the side by the slope of its surface.
const STANDS: f64 = 1e-4;

/// The same faces as the gas within sees them, where that is less open: what stands on a side but for rounding shows nothing in its plane. Those of which
/// nothing is lowered then are left out. Runs in the current rayon pool.
#[must_use]
pub fn seen_from_within(
    grid: &Grid<f64>,
    bodies: &Bodies,
    options: Options,
    mut sides: Vec<LoweredSide>,
) -> Vec<LoweredSide> {
    let options = Options { bounds: false, areas: true, resistance: false, ..options };
    for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]) {
        if !sides.iter().any(|s| (s.axis, s.side) == (axis, side)) {
            continue;
        }
        let mut edges = [0, 1, 2].map(|axis| grid.edges(axis).to_vec());
        let along = &mut edges[axis];
        if side == 1 {
            along.drain(..along.len() - 2);
        }
        along.truncate(2);
        let width = along[1] - along[0];
        let off = f64::max(ON_SIDE * width, ON_SIDE_ROUNDED * grid.rounding(axis)).min(0.5 * width);
        along[1 - side] = along[side] + if side == 0 { off } else { -off };
        let edges = Edges(edges);
        let Ok(slab) = edges.grid(None) else { continue };
        let within = porosity(&slab, bodies, options).beta;
        for found in sides.iter_mut().filter(|s| (s.axis, s.side) == (axis, side)) {
            let mut place = place_of_cell(grid, found.cell);
            place[axis] = 0;
            let [nx, ny, _] = slab.cells();
            let cell = place[0] + nx * (place[1] + ny * place[2]);
            let open = within.faces(axis)[faces_of_nth_cell(&slab, axis, cell)[1 - side]];
            if found.shown - open > STANDS {
                found.shown = open.max(found.passes);
            }
        }
    }
    sides.retain(|found| found.shown - found.passes > LEAST);
    sides
}

/// What passes a cell along an axis, if its faces, `open` in their planes, show more, and which of them is lowered to that. The cell is one of `count` along the
/// axis, at a place.
fn face_to_lower(
    shadows: &Shadows,
    (axis, n): (usize, usize),
    open: [f64; 2],
    (place, count): (usize, usize),
) -> Option<(f64, [bool; 2])> {
    let passes = 1.0 - shadows.tau[axis][n];
    let hidden = open[0].min(open[1]) - passes;
    if !(hidden > LEAST) {
        return None;
    }
    // Positive for the high face.
    let aside = open[0] - open[1] + hidden * (2.0 * shadows.place[axis][n]);
    let (before_middle, behind_middle) = (2 * place + 1 < count, 2 * place + 1 > count);
    Some((passes, if aside.abs() > LEAST { [aside < 0.0, aside > 0.0] } else { [!before_middle, !behind_middle] }))
}
