//! Cells whose open space is divided by solid: gas passes through them that has no way.
//!
//! A cell has one state, so a wall thinner than a cell is passed wherever both of its sides belong to one cell, unless a face is closed. The parts of a
//! cell are found by points: six along each axis, and two more just within the faces. Neighbouring points are of one part if no surface crosses
//! between them, so a passage narrower than a sixth of a cell may be taken for closed. A divided cell is told if
//! - two of its parts reach beyond it, each by a face that is open to that part alone, or that a divided neighbour goes on from by such a face, and
//! - there is no way from one part to the other through the 26 cells around it: gas that goes around a pipe or the end of a wall does no harm.

mod cells;
mod closing;
mod near;
mod parts;

use super::Porosity;
use super::fields::FieldSet;
use super::shadows::{HIDDEN, LEAST_HIDDEN, Shadows, around, place_of_cell};
use super::throat::LoweredSide;
use crate::geometry::bodies::Bodies;
use cells::CellParts;
use closing::Closing;
use near::Near;
use parts::{Hits, Parts};
use rayon::prelude::*;
use std::collections::BTreeSet;
use voidage_core::grid::Grid;

/// Cells that are divided.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct DividedCells {
    /// How many.
    pub cells: usize,
    /// The first, as i, j, k from 0.
    pub first: Option<[usize; 3]>,
}

impl DividedCells {
    /// Cells in ascending order.
    fn of(grid: &Grid<f64>, cells: &[usize]) -> Self {
        DividedCells { cells: cells.len(), first: cells.first().map(|&n| place_of_cell(grid, n)) }
    }
}

/// What was done so that thin walls are tight.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ClosedCells {
    /// Faces that were closed.
    pub faces: usize,
    /// Cells that still let gas pass: a way through them may be narrower than the points see.
    pub left: DividedCells,
}

/// The cells of a grid that surface may divide.
#[derive(Debug)]
pub struct Division {
    near: Near,
    /// Cells that hide enough to be divided, in ascending order.
    first: Vec<usize>,
    /// Those around them in which something stands: the corner of a cell that a wall cuts off, the end of one wall at another.
    beside: Vec<usize>,
}

impl Division {
    /// Of solid bodies with known shadows; `beta` holds open fractions in the planes of faces. Porous bodies divide nothing.
    #[must_use]
    pub fn find(grid: &Grid<f64>, bodies: &Bodies, beta: &FieldSet, shadows: &Shadows) -> Self {
        let hiding = shadows.hiding(grid, beta);
        let cells = hiding.iter().map(|(n, _)| *n).collect();
        let (first, beside): (Vec<_>, Vec<_>) = hiding.into_iter().partition(|(_, hidden)| *hidden >= LEAST_HIDDEN);
        let [first, beside] = [first, beside].map(|cells| cells.into_iter().map(|(n, _)| n).collect());
        Division { near: Near::new(grid, bodies, cells, &shadows.triangles), first, beside }
    }

    /// The cells that let gas pass with the open fractions `beta` of faces, which may have been lowered since; without those that are hidden passages
    /// by the `shadows`, if these are given. Runs in the current rayon pool.
    #[must_use]
    pub fn told(&self, grid: &Grid<f64>, beta: &FieldSet, shadows: Option<&Shadows>) -> DividedCells {
        let is_passage = |n| shadows.is_some_and(|shadows| shadows.largest_hidden(grid, beta, n) > HIDDEN);
        let (_, leaking) = self.leaking(grid, beta, is_passage);
        DividedCells::of(grid, &leaking)
    }

    /// Closes what walls thinner than a cell leave open, once the faces of `result` are lowered to the throat. Of each cell that such a wall divides the
    /// largest part is kept, with those that have a way to it: a face by which only other parts of two cells meet is closed. Cells where lines pass
    /// by the exact shadow that the points do not see are kept whole. Only walls are closed that let gas pass somewhere. Runs in the current rayon pool.
    pub fn close(&self, grid: &Grid<f64>, result: &mut Porosity, shadows: &Shadows) -> ClosedCells {
        let (parts, mut leaking) = self.leaking(grid, &result.beta, |_| false);
        let cells = along_walls(grid, &parts, &leaking);
        let closing = Closing::new(grid, (&parts, &cells), (&result.beta, shadows));
        leaking.retain(|&n| !closing.keeps_one_side(n));
        ClosedCells { faces: closing.close(grid, result), left: DividedCells::of(grid, &leaking) }
    }

    /// Of faces in sides of the grid that are to be lowered, those of obstacles that have gas all around: not of walls that keep gas apart, one side of
    /// which the flow leaves out. `beta` holds the open fractions in the planes of faces. Runs in the current rayon pool.
    #[must_use]
    pub fn surrounded(&self, grid: &Grid<f64>, beta: &FieldSet, mut sides: Vec<LoweredSide>) -> Vec<LoweredSide> {
        let mut cells: Vec<usize> = sides.iter().map(|side| side.cell).collect();
        cells.sort_unstable();
        cells.dedup();
        if cells.is_empty() {
            return sides;
        }
        let mut parts = CellParts::none(grid);
        let walls = if self.add(grid, &mut parts, &cells).is_empty() {
            Vec::new()
        } else {
            let (all, leaking) = self.leaking(grid, beta, |_| false);
            along_walls(grid, &all, &leaking)
        };
        sides.retain(|side| walls.binary_search(&side.cell).is_err());
        sides
    }

    /// The parts of all cells that may let gas pass but for some that are told already, and of those beside them; and which of the former let it pass.
    fn leaking(&self, grid: &Grid<f64>, beta: &FieldSet, is_told: impl Fn(usize) -> bool) -> (CellParts, Vec<usize>) {
        let [first, beside] = [&self.first, &self.beside].map(|cells| cells.iter().copied());
        let may_be_divided = |n: &usize| !self.near.is_whole(*n);
        let (told, first): (Vec<usize>, Vec<usize>) = first.filter(may_be_divided).partition(|n| is_told(*n));
        let others: Vec<usize> = beside.filter(may_be_divided).collect();
        let mut parts = CellParts::none(grid);
        let mut candidates = self.add(grid, &mut parts, &first);
        let near = |parts: &CellParts, cells: &[usize]| {
            let is_beside = |n: &usize| around(grid, *n).into_iter().flatten().any(|cell| parts.is_divided(cell));
            cells.iter().copied().filter(is_beside).collect::<Vec<usize>>()
        };
        let (told, beside) = (near(&parts, &told), near(&parts, &others));
        // Of those that are told only the parts count.
        self.add(grid, &mut parts, &told);
        candidates.extend(self.add(grid, &mut parts, &beside));
        candidates.sort_unstable();
        // What one patch cuts is not divided, but where it is open counts for what divides the cells beside it.
        let whole = |cells: &[usize]| cells.iter().copied().filter(|n| self.near.is_whole(*n)).collect::<Vec<usize>>();
        for cells in [whole(&self.first), whole(&self.beside)] {
            let cells = near(&parts, &cells);
            self.add(grid, &mut parts, &cells);
        }
        let leaking = candidates.into_par_iter().filter(|&n| parts.lets_pass(grid, beta, n)).collect();
        (parts, leaking)
    }

    /// Adds those of some cells, and tells the cells that are divided.
    fn add(&self, grid: &Grid<f64>, all: &mut CellParts, cells: &[usize]) -> Vec<usize> {
        let parts = |hits: &mut Hits, &n: &usize| {
            let cell = grid.cell_box(place_of_cell(grid, n))?;
            Some((n, Parts::of_cell(cell, self.near.of(n), hits)?))
        };
        let found: Vec<_> = cells.par_iter().map_init(Hits::default, parts).collect();
        found.into_iter().flatten().for_each(|(n, parts)| all.add(n, parts));
        cells.iter().copied().filter(|&n| all.is_divided(n)).collect()
    }
}

/// Some divided cells, those that are divided among the 26 around them, and so on, in ascending order.
fn along_walls(grid: &Grid<f64>, parts: &CellParts, cells: &[usize]) -> Vec<usize> {
    let (mut found, mut stack) = (BTreeSet::new(), cells.to_vec());
    while let Some(n) = stack.pop() {
        if found.insert(n) {
            stack.extend(around(grid, n).into_iter().flatten().filter(|&next| parts.is_divided(next)));
        }
    }
    found.into_iter().collect()
}
