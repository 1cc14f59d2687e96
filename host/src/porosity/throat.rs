//! Faces that see what stands between them: walls are tight wherever they lie.

use super::Porosity;
use super::shadows::{Shadows, cells, faces_of_cell};
use voidage_core::grid::Grid;

/// What the open fraction of a face means.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Faces {
    /// What is open in the plane of the face: exact, but a wall between two planes is not seen.
    #[default]
    Plane,
    /// What can pass: where a cell blocks more than its two faces show, the nearer one is lowered to that.
    Throat,
}

/// A face is lowered only by more than this, and one of two only if nearer by more: less is rounding.
const LEAST: f64 = 1e-9;

/// Lowers, in each cell and along each axis, the face nearer to what stands in the cell to the share of lines that pass. Of two that are equally near
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
    let Porosity { beta, bounds, .. } = result;
    for axis in 0..3 {
        let (before, count) = (beta.faces(axis).to_vec(), count[axis]);
        for (n, at) in cells(grid).enumerate() {
            let place_in_row = 2 * (first[axis] + at[axis]) + 1;
            let passes = 1.0 - shadows.tau[axis][n];
            let faces = faces_of_cell(grid, axis, at);
            if !(passes < before[faces[0]].min(before[faces[1]]) - LEAST) {
                continue;
            }
            let place = shadows.place[axis][n];
            let (before_middle, behind_middle) = (place_in_row < count, place_in_row > count);
            let nearer = match place - 0.5 {
                aside if aside.abs() > LEAST => [aside < 0.0, aside > 0.0],
                _ => [!before_middle, !behind_middle],
            };
            for (face, _) in faces.into_iter().zip(nearer).filter(|(_, nearer)| *nearer) {
                for field in bounds.iter_mut().flatten().chain([&mut *beta]).map(|set| set.faces_mut(axis)) {
                    field[face] = field[face].min(passes);
                }
                lowered += 1;
            }
        }
    }
    lowered
}
