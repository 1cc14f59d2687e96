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
    volume: &'a [R],
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
            volume: self.porosity.volume.get(start..).unwrap_or_default(),
            marks: self.porosity.marks.get(start..).unwrap_or_default(),
        }
    }
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

    /// Directional duct area of a cell: the larger of its two faces. Not `beta_v`: a cell of tiny volume behind open faces
    /// is a thin slice, not a narrow duct.
    #[inline(always)]
    pub fn duct(&self, i: usize) -> R {
        let (a, b) = self.openings(i);
        R::larger(a, b)
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
        let duct = |f: usize| R::larger(self.open[f], self.open[f + s]);
        (duct(below), duct(above))
    }

    /// Whether the narrower of the two cells at the low face of a cell is narrower, by more than rounding, than the cells on both sides of it. Beyond the
    /// domain stand cells as for [`Ducts::beside`].
    pub fn pinched(&self, i: usize) -> bool {
        let (left, right) = self.beside(i, false);
        let (narrow, wide, steps) = if left < right { (left, right, -2) } else { (right, left, 1) };
        let (k, n) = ((self.place + self.step * i) as isize + steps, self.cells as isize);
        let cell = if self.periodic { k.checked_rem_euclid(n).unwrap_or(0) } else { k.max(0).min(n - 1) };
        let first = (self.low + i).saturating_sub((self.place + self.step * i) * self.stride);
        let open = |face: usize| self.open.get(face).copied().unwrap_or(R::ZERO);
        let low = first + cell as usize * self.stride;
        let beyond = R::larger(open(low), open(low + self.stride));
        R::smaller(wide, beyond) > narrow + rounding::<R>() * narrow
    }

    /// Width of the gas in a cell: its duct area, or its open volume if that is larger, as in a cell between two closed faces. A closed face
    /// is a wall of this area.
    pub fn width(&self, i: usize) -> R {
        R::larger(self.duct(i), self.volume[i])
    }

    /// Area that a closed face has as a wall of the cell beside it: [`Ducts::width`]; 0 in a sealed cell, where nothing moves.
    pub fn wall(&self, i: usize) -> R {
        // A cell of this kind with both faces closed is sealed, or gas moves along other axes alone.
        if is(self.marks[i], BORDER) && !(self.duct(i) > R::ZERO) { R::ZERO } else { self.width(i) }
    }

    /// `beta_v` of a cell.
    #[inline(always)]
    pub fn volume(&self, i: usize) -> R {
        self.volume[i]
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
        let open = self.face(if high { i + self.stride } else { i });
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
            let open = self.face(if high { i + self.stride } else { i });
            share(open, self.area(i, high, |_| self.duct(i)), contraction[usize::from(high)])
        };
        (section(false), section(true))
    }

    /// The largest areas that the flux may act on at the low and high face of a cell: at a jump that of a throat that is not pinched.
    #[inline(always)]
    pub fn passages(&self, i: usize) -> (R, R) {
        let throat = |high: bool| {
            let (left, right) = self.beside(i, high);
            move |open: R| throat_area(left, open, right, false)
        };
        (self.area(i, false, throat(false)), self.area(i, true, throat(true)))
    }
}
