//! Of a cell that a wall divides one side is kept: its faces are closed where that does not meet what is kept of the cells beside it.

use super::cells::{CellParts, SIDES, neighbour};
use super::parts::{OpenPart, PointLines, is_opening};
use crate::porosity::Porosity;
use crate::porosity::fields::FieldSet;
use crate::porosity::shadows::{Shadows, faces_of_nth_cell, place_of_cell};
use rayon::prelude::*;
use voidage_core::grid::Grid;

/// Lines that pass a cell by its shadow, and not by points, are a way that the points do not see if they are more than this share of its section.
const UNSEEN: f64 = 0.3;

/// The same where no line of points passes.
const UNSEEN_IF_ALL_BLOCKED: f64 = 0.03;

/// A face that is open by less may be so where no point is, and belong to either side.
const UNSEEN_OPENING: f64 = 0.1;

/// Two sides of a wall are alike in size if they differ by no more of the 216 points of a cell.
const ALIKE: u32 = 12;

/// The parts of a cell that are kept, as bits; none where all are.
type Kept = Option<u64>;

/// Cells that walls divide, and what of each is kept.
pub struct Closing<'a> {
    parts: &'a CellParts,
    /// The cells in ascending order, and what is kept of each.
    cells: &'a [usize],
    kept: Vec<Kept>,
}

impl<'a> Closing<'a> {
    /// Of divided cells in ascending order; `beta` holds the open fractions of faces.
    pub fn new(
        grid: &Grid<f64>,
        (parts, cells): (&'a CellParts, &'a [usize]),
        (beta, shadows): (&FieldSet, &Shadows),
    ) -> Self {
        let keep = |&n: &usize| side_to_keep(grid, parts, (beta, shadows), n);
        Closing { parts, cells, kept: cells.par_iter().map(keep).collect() }
    }

    /// Is one side of a cell kept?
    pub fn keeps_one_side(&self, n: usize) -> bool {
        self.kept_of(n).is_some()
    }

    /// Closes the faces by which hardly anything but what is not kept of two cells meets; how many were open.
    pub fn close(&self, grid: &Grid<f64>, result: &mut Porosity) -> usize {
        let mut closed = 0;
        for (&n, (axis, side)) in self.cells.iter().flat_map(|n| SIDES.map(|side| (n, side))) {
            let next = neighbour(grid, n, axis, side);
            if ![Some(n), next].into_iter().flatten().any(|n| self.keeps_one_side(n)) {
                continue;
            }
            let here = self.in_side(n, (axis, side));
            let there = next.map_or([u64::MAX; 2], |next| self.in_side(next, (axis, 1 - side)));
            let [kept, open] = [0, 1].map(|which| here[which] & there[which]);
            let face = faces_of_nth_cell(grid, axis, n)[side];
            let Porosity { beta, bounds, .. } = result;
            let before = beta.faces(axis)[face];
            let is_seen = (open & !kept).count_ones() > kept.count_ones();
            if !is_opening(kept) && (is_seen || (kept == 0 && before < UNSEEN_OPENING)) {
                closed += usize::from(before > 0.0);
                let bounds = bounds.iter_mut().flatten();
                bounds.chain([beta]).for_each(|set| set.faces_mut(axis)[face] = 0.0);
            }
        }
        closed
    }

    fn kept_of(&self, n: usize) -> Kept {
        self.kept[self.cells.binary_search(&n).ok()?]
    }

    /// The points in a side of what is kept of a cell, and of all that is open of it.
    fn in_side(&self, n: usize, (axis, side): (usize, usize)) -> [u64; 2] {
        let Some(parts) = self.parts.of(n) else { return [u64::MAX; 2] };
        let all = parts.in_side(axis, side, |_| true);
        [self.kept_of(n).map_or(all, |kept| parts.in_side(axis, side, |part| kept & 1 << part != 0)), all]
    }
}

/// Of the parts of a cell that reach beyond it the largest, with those that have a way to it; if none does, the largest of all. Of two that are alike it is the
/// one towards the middle of the grid. All are kept if a way through the cell may be narrower than the points see, or if there are more parts than bits.
fn side_to_keep(grid: &Grid<f64>, all: &CellParts, (beta, shadows): (&FieldSet, &Shadows), n: usize) -> Kept {
    let parts = all.of(n)?;
    let has_unseen_way = |(PointLines { blocked, all_blocked }, tau): (PointLines, &Vec<f64>)| {
        let unseen = blocked - tau[n];
        unseen > UNSEEN || (all_blocked && unseen > UNSEEN_IF_ALL_BLOCKED)
    };
    if parts.count() > u64::BITS as usize || parts.lines.into_iter().zip(&shadows.tau).any(has_unseen_way) {
        return None;
    }
    let ways = all.ways_around(grid, beta, n);
    let mut reaching = all.reaching(grid, beta, n);
    if reaching.is_empty() {
        reaching = (0..parts.count()).collect();
    }
    let (at, count) = (place_of_cell(grid, n), grid.cells());
    // Towards the middle of the grid.
    let inwards = [0, 1, 2].map(|axis| (count[axis] as i32 - 1 - 2 * at[axis] as i32).signum());
    let side_of = |part: usize| {
        let (mut kept, mut inner, mut inward) = (0_u64, 0, 0);
        for (other, OpenPart { inner: points, balance, .. }) in parts.all().iter().enumerate() {
            if ways[other] == ways[part] {
                kept |= 1 << other;
                inner += points;
                inward += balance.iter().zip(inwards).map(|(more, inwards)| more * inwards).sum::<i32>();
            }
        }
        (kept, inner, inward)
    };
    let better = |a: (u64, u32, i32), b: (u64, u32, i32)| {
        let is_better = if a.1.abs_diff(b.1) > ALIKE { b.1 > a.1 } else { b.2 > a.2 };
        if is_better { b } else { a }
    };
    let (kept, ..) = reaching.into_iter().map(side_of).reduce(better)?;
    ((kept.count_ones() as usize) < parts.count()).then_some(kept)
}
