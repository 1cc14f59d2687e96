//! Open areas along one axis, at the cells of a row: face by face, of the duct that a cell is, and of the throat between two.
//!
//! The row runs along axis 0; the faces may belong to any axis.

use crate::flow::porosity::flags::{BORDER, SMALL, break_high, break_low, is};
use crate::flow::porosity::fractions::{Medium, rounding};
use crate::flow::porosity::throat::throat_area;
use crate::number::real::Real;

/// The faces of one axis beside the cells of a row; cells count from the first of the row.
pub(crate) struct Ducts<'a, R> {
    axis: usize,
    /// Open fractions of all faces of the axis.
    open: &'a [R],
    /// Index of the first cell's low face.
    low: usize,
    /// From a cell's low face to its high face.
    stride: usize,
    /// Index of the first cell along the axis.
    place: usize,
    /// What the next cell adds to it: 1 if the row runs along the axis, else 0.
    step: usize,
    /// Cells along the axis.
    cells: usize,
    periodic: bool,
    /// Open volume fractions of all cells.
    volume: &'a [R],
    /// Index of the first cell of the row.
    start: usize,
    /// From a cell to the next one along the axis.
    cell_stride: usize,
    marks: &'a [u8],
}

impl<'a, R: Real, const D: usize> Medium<'a, R, D> {
    /// The faces of axis `d` beside the row of cells from `at` on. `at[d]` may be one past the end: then only the low faces count.
    pub fn ducts(&self, d: usize, at: [usize; D]) -> Ducts<'a, R> {
        let start = self.mesh.index(at);
        Ducts {
            axis: d,
            open: self.porosity.faces[d],
            low: self.mesh.face(d, at),
            stride: self.mesh.face_stride(d),
            place: at[d],
            step: usize::from(d == 0),
            cells: self.mesh.cells()[d],
            periodic: self.periodic[d],
            volume: self.porosity.volume,
            start,
            cell_stride: self.mesh.cells()[..d].iter().product(),
            marks: self.porosity.marks.get(start..).unwrap_or_default(),
        }
    }

    /// The low or high face of a cell, by its flat index, along axis `d` is a jump or a wall.
    pub fn breaks(&self, cell: usize, d: usize, high: bool) -> bool {
        let flag = if high { break_high(d) } else { break_low(d) };
        self.porosity.marks.get(cell).is_some_and(|marks| marks & flag != 0)
    }
}

/// Faces of a cell that differ by less than the first share of the wider one are those of a duct that narrows gently, by more than the second those of a duct
/// that ends.
const GENTLE_CELL: [f64; 2] = [0.1, 0.2];

/// Directional duct area of a cell with open fractions `a` and `b` of its two faces: the larger one, as before a wall or an orifice, wherever in the cell that stands.
/// A duct that narrows gently over many cells has in each the area of its middle, which is the open volume if that lies between the two.
#[inline(always)]
fn duct_area<R: Real>(a: R, b: R, volume: R) -> R {
    let (least, most) = (R::smaller(a, b), R::larger(a, b));
    let [full, none] = GENTLE_CELL;
    let left = R::from_f64(none) * most - (most - least);
    if !(left > R::ZERO) {
        return most;
    }
    let middle = R::larger(least, R::smaller(most, volume));
    let range = R::from_f64(none - full) * most;
    if left >= range { middle } else { most - left / range * (most - middle) }
}

/// Difference of areas that makes a sudden jump, by default.
pub(in crate::flow) const SUDDEN: f64 = 0.1;

/// In narrow ducts, where no such difference can occur, this many times that share of the wider duct makes one.
pub(in crate::flow) const IN_NARROW: f64 = 3.0;

/// But not below this part of it.
pub(in crate::flow) const LEAST: f64 = 0.2;

/// How far a face between two ducts is one of many in a duct that narrows gently, not a sudden jump: 1 up to the difference that makes one, 0 from half as much
/// again on.
#[inline(always)]
pub(super) fn gentleness<R: Real>([left, right]: [R; 2], face: R) -> R {
    let (least, most) = (R::smaller(left, right), R::larger(left, right));
    let difference = most - R::smaller(least, face);
    if difference >= R::from_f64(1.5 * SUDDEN) {
        return R::ZERO;
    }
    let in_narrow = R::smaller(
        difference / (R::from_f64(IN_NARROW * SUDDEN) * most),
        difference * R::from_f64(1.0 / (LEAST * SUDDEN)),
    );
    let jumps = R::larger(difference * R::from_f64(1.0 / SUDDEN), in_narrow);
    R::smaller(R::larger(R::from_f64(3.0) - R::TWO * jumps, R::ZERO), R::ONE)
}

/// An area between `open` (for a share of 0) and `area` (exactly that for a share of 1 or more).
#[inline(always)]
pub(crate) fn share<R: Real>(open: R, area: R, share: R) -> R {
    if share >= R::ONE { area } else { open + share * (area - open) }
}

impl<'a, R: Real> Ducts<'a, R> {
    /// Open fractions of the low and of the high faces of the first `n` cells.
    pub fn rows(&self, n: usize) -> (&'a [R], &'a [R]) {
        (&self.open[self.low..][..n], &self.open[self.low + self.stride..][..n])
    }

    /// Open fraction of the low face of a cell.
    #[inline(always)]
    pub fn face(&self, i: usize) -> R {
        self.open[self.low + i]
    }

    /// Open fractions of the low and high face of a cell.
    #[inline(always)]
    pub fn openings(&self, i: usize) -> (R, R) {
        let f = self.low + i;
        (self.open[f], self.open[f + self.stride])
    }

    /// Directional duct area of a cell.
    #[inline(always)]
    pub fn duct(&self, i: usize) -> R {
        self.duct_of((self.low + i, self.start + i))
    }

    /// Indices of the low face and of the cell itself, for the two cells at the low (or high) face of a cell. Beyond the domain stands the cell on the
    /// other side if the axis is periodic, else a copy of the inner cell.
    #[inline(always)]
    fn cells_beside(&self, i: usize, high: bool) -> [(usize, usize); 2] {
        let (s, n, k) = (self.stride, self.cells, self.place + self.step * i + usize::from(high));
        let face = self.low + i + if high { s } else { 0 };
        let around = if self.periodic { (n - 1) * s } else { 0 };
        let c = self.cell_stride;
        let cell = self.start + i + if high { c } else { 0 };
        let turn = if self.periodic { (n - 1) * c } else { 0 };
        let below = if k > 0 { (face - s, cell - c) } else { (face + around, cell + turn) };
        let above = if k < n { (face, cell) } else { (face - s - around, cell - c - turn) };
        [below, above]
    }

    /// Open fraction of a face of the axis, by its index; 0 of one that does not exist.
    #[inline(always)]
    fn at(&self, face: usize) -> R {
        self.open.get(face).copied().unwrap_or(R::ZERO)
    }

    /// Directional duct area of a cell by the indices of its low face and of itself.
    #[inline(always)]
    fn duct_of(&self, (face, cell): (usize, usize)) -> R {
        duct_area(self.at(face), self.at(face + self.stride), self.volume_of(cell))
    }

    /// The two duct areas at the low (or high) face of a cell. Beyond the domain stand cells as told by [`Ducts::cells_beside`].
    #[inline(always)]
    pub fn beside(&self, i: usize, high: bool) -> (R, R) {
        let [below, above] = self.cells_beside(i, high);
        (self.duct_of(below), self.duct_of(above))
    }

    /// Open fraction of the low (or high) face of a cell.
    #[inline(always)]
    pub fn opening(&self, i: usize, high: bool) -> R {
        self.face(if high { i + self.stride } else { i })
    }

    /// How far a jump at the low (or high) face of a cell is one of many of a duct that narrows gently: 0 where it is a sudden one.
    #[inline(always)]
    pub fn gentleness(&self, i: usize, high: bool) -> R {
        let ([below, above], face) = (self.cells_beside(i, high), self.opening(i, high));
        // Most jumps are far from gentle, which costs less to see: a duct has at least nine tenths of its wider face.
        let widest = R::larger(self.at(below.0), self.at(above.0 + self.stride));
        if R::from_f64(0.9) * widest - face >= R::from_f64(1.6 * SUDDEN) {
            return R::ZERO;
        }
        gentleness([self.duct_of(below), self.duct_of(above)], face)
    }

    /// Whether the narrower of the two cells at the low face of a cell is narrower, by more than rounding, than the cells on both sides of it. Beyond the
    /// domain stand cells as for [`Ducts::beside`].
    pub fn pinched(&self, i: usize) -> bool {
        let (left, right) = self.beside(i, false);
        let (narrow, wide, steps) = if left < right { (left, right, -2) } else { (right, left, 1) };
        let k = (self.place + self.step * i) as isize + steps;
        let k = if self.periodic { k } else { k.max(0).min(self.cells as isize - 1) };
        let beyond = self.on_line(i, k).map_or(R::ZERO, |(_, duct)| duct);
        R::smaller(wide, beyond) > narrow + rounding::<R>() * narrow
    }

    /// Open fractions of the two faces, and duct area, of the cell at place `k` along the axis on the line of cell `i`; none beyond a domain that is not periodic.
    fn on_line(&self, i: usize, k: isize) -> Option<([R; 2], R)> {
        let (here, n) = (self.place + self.step * i, self.cells as isize);
        let k = if self.periodic && !(0..n).contains(&k) { k.checked_rem_euclid(n)? } else { k };
        let k = usize::try_from(k).ok().filter(|&k| k < self.cells)?;
        let at = |first: usize, stride: usize| (first + k * stride).checked_sub(here * stride);
        let low = at(self.low + i, self.stride)?;
        let openings = [*self.open.get(low)?, *self.open.get(low + self.stride)?];
        let [a, b] = openings;
        Some((openings, duct_area(a, b, *self.volume.get(at(self.start + i, self.cell_stride)?)?)))
    }

    /// Whether the low (or high) face of a cell, with ducts of the areas `ends` beside it, is one of those in a row that all narrow the duct, or all widen it, and
    /// are a jump together. Of the two areas beside a face `changes` tells whether they differ enough to go on, of the two at the ends of such a row `jump` whether
    /// they differ as those of a jump do.
    pub fn narrows_through(
        &self,
        (i, high): (usize, bool),
        mut ends: [R; 2],
        changes: impl Fn([R; 2]) -> bool,
        jump: impl Fn([R; 2]) -> bool,
    ) -> bool {
        let widens = ends[1] > ends[0];
        let above = (self.place + self.step * i + usize::from(high)) as isize;
        for side in [0, 1] {
            for steps in 0..self.cells as isize {
                if jump(ends) {
                    return true;
                }
                let beyond = self.on_line(i, if side == 0 { above - 2 - steps } else { above + 1 + steps });
                let Some((openings, duct)) = beyond else { break };
                let pair = if side == 0 { [duct, ends[0]] } else { [ends[1], duct] };
                let face = openings[1 - side];
                if !(face > R::ZERO && (pair[1] > pair[0]) == widens && changes(pair)) {
                    break;
                }
                ends[side] = duct;
            }
        }
        jump(ends)
    }

    /// Width of the gas in a cell: its duct area, or its open volume if that is larger, as in a cell between two closed faces. A closed face
    /// is a wall of this area.
    pub fn width(&self, i: usize) -> R {
        R::larger(self.duct(i), self.volume(i))
    }

    /// Area that a closed face has as a wall of the cell beside it: [`Ducts::width`]; 0 in a sealed cell, where nothing moves.
    pub fn wall(&self, i: usize) -> R {
        // A cell of this kind with both faces closed is sealed, or gas moves along other axes alone.
        if is(self.marks[i], BORDER) && !(self.duct(i) > R::ZERO) { R::ZERO } else { self.width(i) }
    }

    /// `beta_v` of a cell.
    #[inline(always)]
    pub fn volume(&self, i: usize) -> R {
        self.volume_of(self.start + i)
    }

    /// That of a cell of the mesh, by its flat index.
    #[inline(always)]
    fn volume_of(&self, cell: usize) -> R {
        self.volume.get(cell).copied().unwrap_or(R::ZERO)
    }

    /// A cell is marked small.
    #[inline(always)]
    pub fn is_small(&self, i: usize) -> bool {
        is(self.marks[i], SMALL)
    }

    /// The low or high face of a cell is a jump or a wall.
    #[inline(always)]
    pub fn breaks(&self, i: usize, high: bool) -> bool {
        self.marks[i] & if high { break_high(self.axis) } else { break_low(self.axis) } != 0
    }

    /// An area for the low or high face of a cell: its open fraction, at a jump as told, at a wall that of the wall.
    #[inline(always)]
    fn area(&self, i: usize, high: bool, at_jump: impl FnOnce(R) -> R) -> R {
        let open = self.opening(i, high);
        if !self.breaks(i, high) {
            open
        } else if open > R::ZERO {
            at_jump(open)
        } else {
            self.wall(i)
        }
    }

    /// Areas with which the duct of a cell meets its low and high face: the open fraction of the face where nothing breaks; at a jump from that
    /// (for a `contraction` of 0) to the duct's own (1); at a wall from 0 to that of the wall.
    #[inline(always)]
    pub fn sections(&self, i: usize, contraction: [R; 2]) -> (R, R) {
        let duct = |_| self.duct(i);
        let (low, high) = (self.area(i, false, duct), self.area(i, true, duct));
        (share(self.opening(i, false), low, contraction[0]), share(self.opening(i, true), high, contraction[1]))
    }

    /// The largest areas that the flux may act on at the low and high face of a cell: at a jump that of a throat that is not pinched, or the open fraction.
    #[inline(always)]
    pub fn passages(&self, i: usize) -> (R, R) {
        (self.area(i, false, |open| self.throat(i, false, open)), self.area(i, true, |open| self.throat(i, true, open)))
    }

    /// The largest area that the flux may act on at an open jump.
    #[inline(always)]
    fn throat(&self, i: usize, high: bool, open: R) -> R {
        let (left, right) = self.beside(i, high);
        R::larger(open, throat_area(left, open, right, false))
    }
}
