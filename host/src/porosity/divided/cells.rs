//! The parts of cells that surface may divide, and the ways between them.

use super::parts::Parts;
use crate::geometry::repair::sets::Sets;
use crate::porosity::fields::FieldSet;
use crate::porosity::shadows::{around, faces_of_nth_cell, place_of_cell};
use voidage_core::grid::Grid;

/// A face is open from this open fraction on.
const OPEN: f64 = 0.05;

/// The parts of cells that surface may divide.
pub struct CellParts {
    parts: Vec<Parts>,
    /// Where each cell's parts stand; none for those that are not known: they have one, which is open to all sides.
    slots: Vec<Option<u32>>,
}

impl CellParts {
    /// Of no cell of a grid.
    pub fn none(grid: &Grid<f64>) -> Self {
        CellParts { parts: Vec::new(), slots: vec![None; grid.cell_count()] }
    }

    /// Adds those of a cell.
    pub fn add(&mut self, n: usize, parts: Parts) {
        self.slots[n] = Some(self.parts.len() as u32);
        self.parts.push(parts);
    }

    /// The parts of a cell, if they are known.
    pub fn of(&self, n: usize) -> Option<&Parts> {
        self.parts.get(self.slots[n]? as usize)
    }

    /// Has a cell several parts?
    pub fn is_divided(&self, n: usize) -> bool {
        self.of(n).is_some_and(|parts| parts.count() > 1)
    }

    /// Do two parts of a cell reach beyond it that have no way to each other around it?
    pub fn lets_pass(&self, grid: &Grid<f64>, beta: &FieldSet, n: usize) -> bool {
        let reaching = self.reaching(grid, beta, n);
        if reaching.len() < 2 {
            return false;
        }
        let ways = self.ways_around(grid, beta, n);
        reaching.iter().any(|&part| ways[part] != ways[reaching[0]])
    }

    /// The parts of a cell that reach beyond it.
    pub fn reaching(&self, grid: &Grid<f64>, beta: &FieldSet, n: usize) -> Vec<usize> {
        let count = self.of(n).map_or(0, Parts::count);
        (0..count).filter(|&part| self.reaches(grid, beta, n, part)).collect()
    }

    /// Does a part of a cell reach beyond it, by a face of its own or through a divided neighbour?
    fn reaches(&self, grid: &Grid<f64>, beta: &FieldSet, n: usize, part: usize) -> bool {
        let own = |n: usize, part: usize| {
            let owns = |&&(axis, side): &&(usize, usize)| self.of(n).is_some_and(|parts| parts.owns(part, axis, side));
            SIDES.iter().filter(owns).any(|side| open_side(grid, beta, n, *side))
        };
        let through = |&(axis, side): &(usize, usize)| {
            let next = neighbour(grid, n, axis, side).filter(|&next| self.is_divided(next));
            let Some(next) = next.filter(|_| open_side(grid, beta, n, (axis, side))) else { return false };
            let mut shared = shared(self.of(n), self.of(next), (axis, side));
            shared.any(|(own_part, beyond)| own_part == part && own(next, beyond))
        };
        own(n, part) || SIDES.iter().any(through)
    }

    /// For each part of a cell a number, the same for parts that are one in the block of cells around it.
    pub fn ways_around(&self, grid: &Grid<f64>, beta: &FieldSet, n: usize) -> Vec<usize> {
        let block = around(grid, n);
        let parts = block.map(|cell| self.of(cell?));
        let is_divided = block.map(|cell| cell.is_some_and(|cell| self.is_divided(cell)));
        let is_open = |place: usize| block[place].is_some() && parts[place].is_none_or(|parts| parts.count() > 0);
        let (mut numbers, mut count) = ([0; 27], 0);
        for place in 0..27 {
            numbers[place] = count;
            count += block[place].map_or(0, |_| parts[place].map_or(1, Parts::count));
        }
        let mut sets = Sets::new(count);
        for (axis, step) in [1, 3, 9].into_iter().enumerate() {
            let before_last = (0..27).filter(|place| place / step % 3 < 2);
            for (here, there) in before_last.map(|place| (place, place + step)) {
                let Some(cell) = block[here].filter(|_| is_open(here) && is_open(there)) else { continue };
                if !is_divided[here] && !is_divided[there] {
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
pub const SIDES: [(usize, usize); 6] = [(0, 0), (0, 1), (1, 0), (1, 1), (2, 0), (2, 1)];

/// The cell beyond a side; none at the end of the grid.
pub fn neighbour(grid: &Grid<f64>, n: usize, axis: usize, side: usize) -> Option<usize> {
    let mut at = place_of_cell(grid, n);
    at[axis] = if side == 0 { at[axis].checked_sub(1)? } else { at[axis] + 1 };
    (at[axis] < grid.cells()[axis]).then(|| grid.cell_index(at))
}

/// Where a cell stands among those around it.
const MIDDLE: usize = 13;

fn open_side(grid: &Grid<f64>, beta: &FieldSet, n: usize, (axis, side): (usize, usize)) -> bool {
    beta.faces(axis)[faces_of_nth_cell(grid, axis, n)[side]] >= OPEN
}
