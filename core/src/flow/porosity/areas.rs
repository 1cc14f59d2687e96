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
}

/// How alike two values are that are not below 0: 1 if they differ by up to `full`, a share of the larger one, 0 if by `none` or more.
#[inline(always)]
fn alike<R: Real>([a, b]: [R; 2], [full, none]: [f64; 2]) -> R {
    let most = R::larger(a, b);
    let left = R::from_f64(none) * most - (a - b).abs();
    if !(left > R::ZERO) {
        return R::ZERO;
    }
    R::smaller(left / (R::from_f64(none - full) * most), R::ONE)
}

/// Faces of a cell that are alike by this are those of a duct that narrows gently.
const GENTLE_CELL: [f64; 2] = [0.1, 0.2];

/// Directional duct area of a cell with open fractions `a` and `b` of its two faces: the larger one, as before a wall or an orifice, wherever in the cell that stands.
/// A duct that narrows gently over many cells has in each the area of its middle, which is the open volume if that lies between the two.
#[inline(always)]
fn duct_area<R: Real>(a: R, b: R, volume: R) -> R {
    let (least, most) = (R::smaller(a, b), R::larger(a, b));
    let middle = R::larger(least, R::smaller(most, volume));
    most - alike([a, b], GENTLE_CELL) * (most - middle)
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
fn gentleness<R: Real>([left, right]: [R; 2], face: R) -> R {
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
        let (a, b) = self.openings(i);
        duct_area(a, b, self.volume(i))
    }

    /// The two duct areas at the low (or high) face of a cell. Beyond the domain stands the cell on the other side if the axis is
    /// periodic, else a copy of the inner cell.
    #[inline(always)]
    pub fn beside(&self, i: usize, high: bool) -> (R, R) {
        let (s, n, k) = (self.stride, self.cells, self.place + self.step * i + usize::from(high));
        let face = self.low + i + if high { s } else { 0 };
        let around = if self.periodic { (n - 1) * s } else { 0 };
        // Low faces of both cells.
        let below = if k > 0 { face - s } else { face + around };
        let above = if k < n { face } else { face - s - around };
        let c = self.cell_stride;
        let cell = self.start + i + if high { c } else { 0 };
        let turn = if self.periodic { (n - 1) * c } else { 0 };
        let below_cell = if k > 0 { cell - c } else { cell + turn };
        let above_cell = if k < n { cell } else { cell - c - turn };
        let duct = |f: usize, c: usize| duct_area(self.open[f], self.open[f + s], self.volume_of(c));
        (duct(below, below_cell), duct(above, above_cell))
    }

    /// Open fraction of the low (or high) face of a cell.
    #[inline(always)]
    pub fn opening(&self, i: usize, high: bool) -> R {
        self.face(if high { i + self.stride } else { i })
    }

    /// How far a jump at the low (or high) face of a cell is one of many of a duct that narrows gently: 0 where it is a sudden one.
    #[inline(always)]
    pub fn gentleness(&self, i: usize, high: bool) -> R {
        let (left, right) = self.beside(i, high);
        gentleness([left, right], self.opening(i, high))
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
        let k = if self.periodic { k.checked_rem_euclid(n)? } else { k };
        let k = usize::try_from(k).ok().filter(|&k| k < self.cells)?;
        let at = |first: usize, stride: usize| (first + k * stride).checked_sub(here * stride);
        let low = at(self.low + i, self.stride)?;
        let openings = [*self.open.get(low)?, *self.open.get(low + self.stride)?];
        let [a, b] = openings;
        Some((openings, duct_area(a, b, *self.volume.get(at(self.start + i, self.cell_stride)?)?)))
    }

    /// Whether the low (or high) face of a cell is one of those in a row that all narrow the duct, or all widen it, and are a jump together. Of the two areas
    /// beside a face `changes` tells whether they differ enough to go on, of the two at the ends of such a row `jump` whether they differ as those of a jump do.
    pub fn narrows_through(
        &self,
        i: usize,
        high: bool,
        changes: impl Fn([R; 2]) -> bool,
        jump: impl Fn([R; 2]) -> bool,
    ) -> bool {
        let ends = self.beside(i, high);
        let mut ends = [ends.0, ends.1];
        let widens = ends[1] > ends[0];
        if !changes(ends) {
            return false;
        }
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
    fn area(&self, i: usize, high: bool, at_jump: impl Fn(R) -> R) -> R {
        let open = self.opening(i, high);
        let breaks = self.breaks(i, high);
        if breaks & !(open > R::ZERO) {
            return self.wall(i);
        }
        // Found in any case: a selection costs less than a wrong guess.
        let jump = at_jump(open);
        if breaks { jump } else { open }
    }

    /// Areas with which the duct of a cell meets its low and high face: the open fraction of the face where nothing breaks; at a jump from that
    /// (for a `contraction` of 0) to the duct's own (1); at a wall from 0 to that of the wall.
    #[inline(always)]
    pub fn sections(&self, i: usize, contraction: [R; 2]) -> (R, R) {
        let section = |high: bool| {
            let open = self.opening(i, high);
            share(open, self.area(i, high, |_| self.duct(i)), contraction[usize::from(high)])
        };
        (section(false), section(true))
    }

    /// The largest areas that the flux may act on at the low and high face of a cell: at a jump that of a throat that is not pinched, or the open fraction.
    #[inline(always)]
    pub fn passages(&self, i: usize) -> (R, R) {
        let throat = |high: bool| {
            let (left, right) = self.beside(i, high);
            move |open: R| R::larger(open, throat_area(left, open, right, false))
        };
        (self.area(i, false, throat(false)), self.area(i, true, throat(true)))
    }
}
