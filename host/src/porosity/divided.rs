//! Cells whose open space is divided by solid: gas passes through them that has no way.
//!
//! A cell has one state, so a wall thinner than a cell is passed wherever both of its sides belong to one cell, unless a face is closed. The parts of a
//! cell are found by points: six along each axis, and two more just within the faces. Neighbouring points are of one part if no surface crosses
//! between them, so a passage narrower than a sixth of a cell may be taken for closed. A divided cell is told if
//! - two of its parts reach beyond it, each by a face that is open to that part alone, or that a divided neighbour goes on from by such a face, and
//! - there is no way from one part to the other through the 26 cells around it: gas that goes around a pipe or the end of a wall does no harm.

mod near;
mod parts;

use super::fields::FieldSet;
use super::shadows::{HIDDEN, Shadows, faces_of_nth_cell, place_of_cell};
use crate::geometry::bodies::Bodies;
use crate::geometry::repair::sets::Sets;
use near::Near;
use parts::{Hits, Parts};
use rayon::prelude::*;
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

/// A cell is looked at if along one axis it blocks this share of its section beyond what its faces show: a wall that divides it does. A neighbour of a
/// divided cell is looked at if it hides anything: the corner of a cell that the wall cuts off.
const LEAST_HIDDEN: f64 = 0.25;

/// A face is open from this open fraction on.
const OPEN: f64 = 0.05;

/// The cells of a grid that surface may divide.
#[derive(Debug)]
pub struct Division {
    near: Near,
    /// Cells that hide something in ascending order, and how much.
    hiding: Vec<(usize, f64)>,
}

impl Division {
    /// Of solid bodies with known shadows; `beta` holds open fractions in the planes of faces. Porous bodies divide nothing.
    #[must_use]
    pub fn find(grid: &Grid<f64>, bodies: &Bodies, beta: &FieldSet, shadows: &Shadows) -> Self {
        let mut hiding = shadows.hiding(grid, beta);
        if hiding.iter().all(|(_, hidden)| *hidden < LEAST_HIDDEN) {
            hiding.clear();
        }
        let cells = hiding.iter().map(|(n, _)| *n).collect();
        Division { near: Near::new(grid, bodies, cells, &shadows.triangles), hiding }
    }

    /// The cells that let gas pass with the open fractions `beta` of faces, which may have been lowered since; without those that are hidden passages
    /// by the `shadows`, if these are given. Runs in the current rayon pool.
    #[must_use]
    pub fn told(&self, grid: &Grid<f64>, beta: &FieldSet, shadows: Option<&Shadows>) -> DividedCells {
        let is_passage = |n| shadows.is_some_and(|shadows| shadows.largest_hidden(grid, beta, n) > HIDDEN);
        let first = self.hiding.iter().filter(|(n, hidden)| *hidden >= LEAST_HIDDEN && !is_passage(*n));
        let first: Vec<usize> = first.map(|(n, _)| *n).collect();
        let mut parts = AllParts { parts: Vec::new(), slots: vec![None; grid.cell_count()] };
        let candidates = parts.add(grid, &self.near, &first);
        // Of their neighbours only the parts count.
        let is_beside = |n: usize| around(grid, n).into_iter().flatten().any(|cell| parts.of(cell).is_some());
        let others = self.hiding.iter().map(|(n, _)| *n).filter(|n| first.binary_search(n).is_err());
        let beside: Vec<usize> = others.filter(|&n| is_beside(n)).collect();
        parts.add(grid, &self.near, &beside);
        let found: Vec<usize> = candidates.into_par_iter().filter(|&n| parts.lets_pass(grid, beta, n)).collect();
        DividedCells { cells: found.len(), first: found.first().map(|&n| place_of_cell(grid, n)) }
    }
}

/// The parts of cells that are divided.
struct AllParts {
    parts: Vec<Parts>,
    /// Where each cell's parts stand; none for those that are not known to be divided.
    slots: Vec<Option<u32>>,
}

impl AllParts {
    /// Adds those of some cells that have several parts, and tells them.
    fn add(&mut self, grid: &Grid<f64>, near: &Near, cells: &[usize]) -> Vec<usize> {
        let parts = |hits: &mut Hits, &n: &usize| {
            let cell = grid.cell_box(place_of_cell(grid, n))?;
            Some((n, Parts::of_cell(cell, near.of(n), hits)?))
        };
        let found: Vec<_> = cells.par_iter().map_init(Hits::default, parts).collect();
        let add = |(n, parts): (usize, Parts)| {
            self.slots[n] = Some(self.parts.len() as u32);
            self.parts.push(parts);
            n
        };
        found.into_iter().flatten().map(add).collect()
    }

    /// The parts of a cell that is divided.
    fn of(&self, n: usize) -> Option<&Parts> {
        self.parts.get(self.slots[n]? as usize)
    }

    /// Do two parts of a cell reach beyond it that have no way to each other around it?
    fn lets_pass(&self, grid: &Grid<f64>, beta: &FieldSet, n: usize) -> bool {
        let Some(parts) = self.of(n) else { return false };
        let reaching: Vec<usize> = (0..parts.count()).filter(|&part| self.reaches(grid, beta, n, part)).collect();
        if reaching.len() < 2 {
            return false;
        }
        let ways = self.ways_around(grid, beta, n);
        reaching.iter().any(|&part| ways[part] != ways[reaching[0]])
    }

    /// Does a part of a cell reach beyond it, by a face of its own or through a divided neighbour?
    fn reaches(&self, grid: &Grid<f64>, beta: &FieldSet, n: usize, part: usize) -> bool {
        let own = |n: usize, part: usize| {
            let owns = |&&(axis, side): &&(usize, usize)| self.of(n).is_some_and(|parts| parts.owns(part, axis, side));
            SIDES.iter().filter(owns).any(|side| open_side(grid, beta, n, *side))
        };
        let through = |&(axis, side): &(usize, usize)| {
            let next = neighbour(grid, n, axis, side).filter(|&next| self.of(next).is_some());
            let Some(next) = next.filter(|_| open_side(grid, beta, n, (axis, side))) else { return false };
            let mut shared = shared(self.of(n), self.of(next), (axis, side));
            shared.any(|(own_part, beyond)| own_part == part && own(next, beyond))
        };
        own(n, part) || SIDES.iter().any(through)
    }

    /// For each part of a cell a number, the same for parts that are one in the block of cells around it.
    fn ways_around(&self, grid: &Grid<f64>, beta: &FieldSet, n: usize) -> Vec<usize> {
        let block = around(grid, n);
        let parts = block.map(|cell| self.of(cell?));
        let (mut numbers, mut count) = ([0; 27], 0);
        for place in 0..27 {
            numbers[place] = count;
            count += block[place].map_or(0, |_| parts[place].map_or(1, Parts::count));
        }
        let mut sets = Sets::new(count);
        for (axis, step) in [1, 3, 9].into_iter().enumerate() {
            let before_last = (0..27).filter(|place| place / step % 3 < 2);
            for (here, there) in before_last.map(|place| (place, place + step)) {
                let (Some(cell), Some(_)) = (block[here], block[there]) else { continue };
                if parts[here].is_none() && parts[there].is_none() {
                    // A wall that crosses the plane between two cells divides neither of them.
                    if open_side(grid, beta, cell, (axis, 1)) {
                        sets.join(numbers[here], numbers[there]);
                    }
                    continue;
                }
                for (a, b) in shared(parts[here], parts[there], (axis, 1)) {
                    sets.join(numbers[here] + a, numbers[there] + b);
                }
            }
        }
        (0..parts[MIDDLE].map_or(1, Parts::count)).map(|part| sets.find(numbers[MIDDLE] + part)).collect()
    }
}

/// The pairs of parts of two neighbours that meet in their common side, which is given as the first one has it. A cell that is not divided has one part.
fn shared(
    here: Option<&Parts>,
    there: Option<&Parts>,
    (axis, side): (usize, usize),
) -> impl Iterator<Item = (usize, usize)> {
    let counts = [here, there].map(|parts| parts.map_or(1, Parts::count));
    let pairs = (0..counts[0]).flat_map(move |a| (0..counts[1]).map(move |b| (a, b)));
    pairs.filter(move |&(a, b)| match (here, there) {
        (Some(here), Some(there)) => here.meet(a, (there, b), axis, side),
        (Some(here), None) => here.touches(a, axis, side),
        (None, Some(there)) => there.touches(b, axis, 1 - side),
        (None, None) => true,
    })
}

/// The sides of a cell: axis, and 0 for the low side or 1 for the high one.
const SIDES: [(usize, usize); 6] = [(0, 0), (0, 1), (1, 0), (1, 1), (2, 0), (2, 1)];

fn neighbour(grid: &Grid<f64>, n: usize, axis: usize, side: usize) -> Option<usize> {
    let mut at = place_of_cell(grid, n);
    at[axis] = if side == 0 { at[axis].checked_sub(1)? } else { at[axis] + 1 };
    (at[axis] < grid.cells()[axis]).then(|| grid.cell_index(at))
}

/// Where a cell stands among those around it.
const MIDDLE: usize = 13;

/// A cell and those around it, x fastest; none beyond the grid.
fn around(grid: &Grid<f64>, n: usize) -> [Option<usize>; 27] {
    let ([i, j, k], [nx, ny, nz]) = (place_of_cell(grid, n), grid.cells());
    std::array::from_fn(|place| {
        let (i, j, k) = (i + place % 3, j + place / 3 % 3, k + place / 9);
        let is_inside = (1..=nx).contains(&i) && (1..=ny).contains(&j) && (1..=nz).contains(&k);
        is_inside.then(|| ((k - 1) * ny + (j - 1)) * nx + (i - 1))
    })
}

fn open_side(grid: &Grid<f64>, beta: &FieldSet, n: usize, (axis, side): (usize, usize)) -> bool {
    beta.faces(axis)[faces_of_nth_cell(grid, axis, n)[side]] >= OPEN
}
