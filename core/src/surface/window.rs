//! The cells of a layer that a body reaches, and its axes.

use crate::grid::{Grid, Located};
use crate::number::real::{Real, Vector};
use crate::surface::error::{SurfaceError, is_computable};

/// The cells `i0..i0+ni` × `j0..j0+nj` of a layer that a body reaches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window {
    pub i0: usize,
    pub ni: usize,
    pub j0: usize,
    pub nj: usize,
}

impl Window {
    /// Around some triangles; none if they do not reach the grid. Touching its outer planes is reaching.
    pub fn around<R: Real, V: Vector<Scalar = R>>(
        grid: &Grid<R>,
        triangles: &[[V; 3]],
        ids: &[u32],
    ) -> Result<Option<Self>, SurfaceError> {
        let (mut lo, mut hi) = (V::splat(R::INFINITY), V::splat(-R::INFINITY));
        for &id in ids {
            let missing = SurfaceError::NoTriangle { id, triangles: triangles.len() };
            for corner in triangles.get(id as usize).ok_or(missing)? {
                if !is_computable(*corner) {
                    return Err(SurfaceError::NotFinite { id });
                }
                (lo, hi) = (lo.min(*corner), hi.max(*corner));
            }
        }
        let (i, j) = (Self::span(grid, 0, lo.x(), hi.x()), Self::span(grid, 1, lo.y(), hi.y()));
        Ok(i.zip(j).map(|((i0, ni), (j0, nj))| Window { i0, ni, j0, nj }))
    }

    fn span<R: Real>(grid: &Grid<R>, axis: usize, lo: R, hi: R) -> Option<(usize, usize)> {
        let [first, between @ .., last] = grid.edges(axis) else { return None };
        let reaches = lo <= *last && hi >= *first;
        let cell = |v| match grid.locate(axis, v) {
            Located::Below => 0,
            Located::Cell(i) => i,
            Located::Above => between.len(),
        };
        reaches.then(|| (cell(lo), cell(hi) - cell(lo) + 1))
    }
}

/// One axis of a window: its cells are numbered from 0; −1 is the outside below the grid, `count` the outside above.
///
/// Coordinates are relative to `origin`. Of a triangle that hardly extends along the axis, corners cut at other planes would
/// lose the digits that tell where it crosses this axis' planes; seen from its own corner it keeps them.
#[derive(Clone, Copy)]
pub(crate) struct Axis<'a, R> {
    edges: &'a [R],
    first: usize,
    pub count: isize,
    pub origin: R,
}

impl<'a, R: Real> Axis<'a, R> {
    pub fn new(edges: &'a [R], first: usize, count: usize) -> Self {
        Axis { edges, first, count: count as isize, origin: R::ZERO }
    }

    /// The cell that holds a coordinate; a coordinate on an edge belongs to the cell above.
    #[inline(always)]
    pub fn cell(&self, value: R) -> isize {
        let mut cell = match crate::grid::locate(self.edges, value + self.origin) {
            Located::Below => -1,
            // A cut may place a corner a rounding error outside the window.
            Located::Cell(i) => (i as isize - self.first as isize).max(0).min(self.count),
            Located::Above => self.count,
        };
        if self.origin != R::ZERO {
            // The sum above may have been rounded across an edge.
            cell += isize::from(value >= self.upper(cell));
            cell -= isize::from(cell >= 0 && value < self.upper(cell - 1));
        }
        cell
    }

    /// The upper edge of a cell; infinite for the outside above.
    #[inline(always)]
    pub fn upper(&self, cell: isize) -> R {
        let index = self.first as isize + cell + 1;
        self.edges.get(index as usize).map_or(R::INFINITY, |&e| e - self.origin)
    }

    /// The sides of a cell in the coordinates of the grid; infinite beyond it.
    #[inline(always)]
    pub fn sides(&self, cell: isize) -> [R; 2] {
        let at = self.first as isize + cell;
        let edge = |at: isize| usize::try_from(at).ok().and_then(|at| self.edges.get(at).copied());
        [edge(at).unwrap_or(-R::INFINITY), edge(at + 1).unwrap_or(R::INFINITY)]
    }

    /// A coordinate of a point between these sides, or on one, as the grid has it.
    #[inline(always)]
    pub fn in_grid(&self, [lo, hi]: [R; 2], value: R) -> R {
        if value <= lo - self.origin {
            lo
        } else if value >= hi - self.origin {
            hi
        } else {
            value + self.origin
        }
    }

    /// Is `value` the lower edge of a cell?
    #[inline(always)]
    pub fn opens(&self, cell: isize, value: R) -> bool {
        cell >= 0 && self.edges.get((self.first as isize + cell) as usize).is_some_and(|&e| e - self.origin == value)
    }

    /// Is this a cell of the window?
    #[inline(always)]
    pub fn holds(&self, cell: isize) -> bool {
        cell >= 0 && cell < self.count
    }
}

/// `count` entries from `first`; none if there are fewer.
#[inline(always)]
pub(crate) fn part<T>(all: &[T], first: usize, count: usize) -> Option<&[T]> {
    all.get(first..)?.get(..count)
}

/// As [`part`].
#[inline(always)]
pub(crate) fn part_mut<T>(all: &mut [T], first: usize, count: usize) -> Option<&mut [T]> {
    all.get_mut(first..)?.get_mut(..count)
}

/// The width of a cell between edges; none if there is no such cell.
#[inline(always)]
pub(crate) fn width<R: Real>(edges: &[R], cell: usize) -> Option<R> {
    let &[lo, hi] = edges.get(cell..)?.first_chunk()?;
    Some(hi - lo)
}

/// The widths of neighbouring cells.
#[derive(Clone, Copy)]
pub(crate) struct Widths<'a, R> {
    lower: &'a [R],
    upper: &'a [R],
}

/// The widths of `count` cells from `first` on; none if there are fewer.
#[inline(always)]
pub(crate) fn widths<R>(edges: &[R], first: usize, count: usize) -> Option<Widths<'_, R>> {
    let lower = part(edges, first, count)?;
    Some(Widths { lower, upper: part(edges, first + 1, count)? })
}

impl<R: Real> Widths<'_, R> {
    #[inline(always)]
    pub fn of(&self, cell: usize) -> R {
        self.upper[cell] - self.lower[cell]
    }
}

/// Set a flag, if there is one.
#[inline(always)]
pub(crate) fn mark(flags: &mut [u8], at: usize) {
    if let Some(flag) = flags.get_mut(at) {
        *flag = 1;
    }
}

/// Add to a sum, if there is one.
#[inline(always)]
pub(crate) fn add_at<R: Real>(sums: &mut [R], at: usize, value: R) {
    if let Some(sum) = sums.get_mut(at) {
        *sum += value;
    }
}
