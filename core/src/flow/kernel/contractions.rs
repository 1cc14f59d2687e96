//! How far the gas of each cell in the window passes the contraction that the cell is, 1, or flows along its walls, 0
//! ([`Medium::contraction`](crate::flow::porosity::fractions::Medium::contraction)).
//!
//! It follows from the old state, and all faces of a cell ask for it: it is found once, when the row comes into the window.

use crate::flow::kernel::slab::{Place, Slab, beside};
use crate::flow::porosity::flags::{BREAKS, marked};
use crate::number::real::Real;

/// Those of the rows in the window, each with one place more at both ends.
#[derive(Clone, Copy)]
pub(in crate::flow) struct Contractions<'w, R> {
    window: &'w [R],
    padded: usize,
}

impl<'w, R: Real> Contractions<'w, R> {
    /// Of a window; in one dimension of an empty one.
    pub fn new<const D: usize>(slab: &Slab<'_, R, D>, window: &'w [R]) -> Self {
        Contractions { window, padded: slab.size.padded }
    }

    /// Of a row, from the cell before its first one on, or from a later place; empty where none are kept.
    fn of_row<const D: usize>(&self, slab: &Slab<'_, R, D>, (l, j): Place, from: usize) -> &'w [R] {
        // A line has no walls askew: nothing is compiled for it.
        if D == 1 { &[] } else { self.window.get(slab.slot(l, j) * self.padded + from..).unwrap_or_default() }
    }

    /// Beside the low faces, along axis `d`, of the cells of a row, and of the cell after them if the row runs along `d`.
    pub fn at_faces<const D: usize>(&self, slab: &Slab<'_, R, D>, d: usize, place: Place) -> AtFaces<'w, R, D> {
        let (before, from) = if d == 0 { (place, 0) } else { (beside::<D>(place, d, -1), 1) };
        AtFaces { below: self.of_row(slab, before, from), above: self.of_row(slab, place, 1) }
    }

    /// The same for the low and for the high faces of the cells of a row.
    pub fn at_sides<const D: usize>(&self, slab: &Slab<'_, R, D>, d: usize, place: Place) -> [AtFaces<'w, R, D>; 2] {
        let (after, from) = if d == 0 { (place, 2) } else { (beside::<D>(place, d, 1), 1) };
        let high = AtFaces { below: self.of_row(slab, place, 1), above: self.of_row(slab, after, from) };
        [self.at_faces(slab, d, place), high]
    }
}

/// Those of the cells below and above each face of a row.
#[derive(Clone, Copy)]
pub(in crate::flow) struct AtFaces<'w, R, const D: usize> {
    below: &'w [R],
    above: &'w [R],
}

impl<R: Real, const D: usize> AtFaces<'_, R, D> {
    /// How far the gas passes a face as a contraction, 1, or flows along the walls of a cell beside it, 0.
    #[inline(always)]
    pub fn of(&self, face: usize) -> R {
        if D == 1 {
            return R::ONE;
        }
        let beside = |row: &[R]| row.get(face).copied().unwrap_or(R::ONE);
        R::smaller(beside(self.below), beside(self.above))
    }
}

/// Of the low and of the high face of cell `i` of a row, as far as they break; else 1.
#[inline(always)]
pub(in crate::flow) fn contractions_at<R: Real, const D: usize>(
    sides: &[AtFaces<'_, R, D>; 2],
    i: usize,
    breaks: [bool; 2],
) -> [R; 2] {
    core::array::from_fn(|side| if breaks[side] { sides[side].of(i) } else { R::ONE })
}

/// Finds them for the row of cells from `at` on, which comes into the window at a place; `outside` the domain stands no wall.
// Called, not inlined: each kind of step would hold its own.
#[inline(never)]
pub(in crate::flow) fn load_contractions<R: Real, const D: usize>(
    slab: &Slab<'_, R, D>,
    at: [usize; D],
    outside: bool,
    row: &mut [R],
) {
    let Some(medium) = slab.medium.as_ref().filter(|_| D > 1) else { return };
    row.fill(R::ONE);
    if outside {
        return;
    }
    let (n, start) = (slab.size.n, slab.problem.mesh.index(at));
    for i in marked(&medium.porosity.marks[start..][..n], BREAKS) {
        let mut cell = at;
        cell[0] += i;
        row[1 + i] = medium.contraction(cell, slab.old.momentum.map(|m| m[start + i]));
    }
    if slab.periodic[0] {
        (row[0], row[n + 1]) = (row[n], row[1]);
    }
}
