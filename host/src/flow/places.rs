//! Cells, faces and sides of the mesh of a flow: where they are, how large, and how much of them is open.

use super::{Flow, Scalar};
use voidage_core::flow::Boundary;

impl<R: Scalar, const D: usize> Flow<R, D> {
    /// Indices of a cell along each axis.
    pub fn coordinates(&self, mut cell: usize) -> [usize; D] {
        self.cells().map(|n| {
            let i = cell % n;
            cell /= n;
            i
        })
    }

    /// Volume of a cell, its obstacles included.
    pub fn volume(&self, at: [usize; D]) -> R {
        (0..D).fold(R::ONE, |v, d| v * self.widths[d][at[d]])
    }

    /// Area of the faces of a cell normal to axis `d`, open or not.
    pub fn area(&self, d: usize, at: [usize; D]) -> R {
        self.volume(at) / self.widths[d][at[d]]
    }

    /// Position of the low (`side` 0) or high (1) face of a cell among the faces normal to axis `d`.
    pub fn face(&self, d: usize, mut at: [usize; D], side: usize) -> usize {
        let n = self.cells();
        at[d] += side;
        (0..D).rev().fold(0, |i, a| i * (n[a] + usize::from(a == d)) + at[a])
    }

    /// The cells behind the faces of a cell, the other end of a periodic axis left out.
    pub fn beside(&self, cell: usize) -> Vec<usize> {
        let (at, n) = (self.coordinates(cell), self.cells());
        let mut stride = 1;
        let mut beside = Vec::with_capacity(2 * D);
        for d in 0..D {
            if at[d] > 0 {
                beside.push(cell - stride);
            }
            if at[d] + 1 < n[d] {
                beside.push(cell + stride);
            }
            stride *= n[d];
        }
        beside
    }

    /// The cell behind the low (`side` 0) or high (1) face of a cell; none at a side of the domain that is not periodic.
    pub fn behind(&self, d: usize, mut at: [usize; D], side: usize) -> Option<usize> {
        let n = self.cells();
        let periodic = self.boundaries[d][0].is_periodic();
        at[d] = match (side, at[d]) {
            (0, 0) => periodic.then_some(n[d] - 1)?,
            (0, i) => i - 1,
            (_, i) if i + 1 == n[d] => periodic.then_some(0)?,
            (_, i) => i + 1,
        };
        Some((0..D).rev().fold(0, |i, a| i * n[a] + at[a]))
    }

    /// Open volume of a cell.
    pub fn open_volume(&self, cell: usize) -> R {
        let volume = self.volume(self.coordinates(cell));
        self.beta_v().map_or(volume, |open| volume * open[cell])
    }

    /// The cells along the low (`side` 0) or high (1) side of axis `d`, with the open area of their face there: those of a patch, or those
    /// of none.
    pub fn side(&self, d: usize, side: usize, patch: Option<usize>) -> Vec<(usize, R)> {
        let last = self.widths[d].len().saturating_sub(1);
        let space = self.porosity();
        let of_patch = |at: [usize; D]| self.patches.iter().rposition(|p| p.covers(d, side == 1, at)) == patch;
        let on_side = |at: [usize; D]| at[d] == side * last && of_patch(at);
        let cells = (0..self.len()).filter(|&c| on_side(self.coordinates(c)));
        cells
            .map(|cell| {
                let at = self.coordinates(cell);
                let open = space.map_or(R::ONE, |s| s.faces()[d][self.face(d, at, side)]);
                (cell, open * self.area(d, at))
            })
            .collect()
    }

    /// What stands on the low (`side` 0) or high (1) side of axis `d` beside a cell.
    pub fn stands(&self, d: usize, side: usize, at: [usize; D]) -> &Boundary<R, D> {
        let patch = self.patches.iter().rev().find(|p| p.covers(d, side == 1, at));
        patch.map_or(&self.boundaries[d][side], |p| &p.boundary)
    }
}
