//! Ranges of cells, or of the faces normal to one axis.

use crate::grid::Grid;
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};

/// What a range counts: cells, or the faces normal to an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RangeKind {
    /// Cells.
    Cells,
    /// Faces normal to axis 0, 1 or 2, for x, y, z. No face is normal to another number: such a range counts cells.
    Faces(usize),
}

/// A block of cells or faces: the indices `lo..hi` along each axis, counted as in [`Grid`]. Empty if any `lo` reaches its `hi`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CellRange {
    /// First index along each axis.
    pub lo: [u32; 3],
    /// One past the last index along each axis.
    pub hi: [u32; 3],
}

/// A function of two numbers, axis by axis.
fn by_axis(f: fn(u32, u32) -> u32, [ax, ay, az]: [u32; 3], [bx, by, bz]: [u32; 3]) -> [u32; 3] {
    [f(ax, bx), f(ay, by), f(az, bz)]
}

impl CellRange {
    /// All cells or faces of a grid.
    #[must_use]
    pub fn all<R: Real>(grid: &Grid<R>, kind: RangeKind) -> Self {
        let mut hi = grid.cells().map(|cells| u32::try_from(cells).unwrap_or(u32::MAX));
        for (axis, hi) in hi.iter_mut().enumerate() {
            *hi = hi.saturating_add(u32::from(kind == RangeKind::Faces(axis)));
        }
        CellRange { lo: [0; 3], hi }
    }

    /// The cells or faces of a grid that a closed box touches: none if a coordinate of the box is NaN.
    #[must_use]
    pub fn touching<V: Vector>(grid: &Grid<V::Scalar>, kind: RangeKind, bounds: &Aabb<V>) -> Self {
        let (min, max) = (bounds.min.to_array(), bounds.max.to_array());
        let mut range = CellRange::default();
        for axis in 0..3 {
            let edges = grid.edges(axis);
            let first = edges.partition_point(|&e| e < min[axis]);
            let last = edges.partition_point(|&e| e <= max[axis]);
            let (lo, hi) = if kind == RangeKind::Faces(axis) {
                (first, last)
            } else {
                (first.saturating_sub(1), last.min(edges.len().saturating_sub(1)))
            };
            (range.lo[axis], range.hi[axis]) = (lo as u32, hi as u32);
        }
        range
    }

    /// Holds no cell.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        (0..3).any(|axis| self.lo[axis] >= self.hi[axis])
    }

    /// The cells that both ranges hold.
    #[must_use]
    pub fn intersection(self, other: Self) -> Self {
        CellRange { lo: by_axis(u32::max, self.lo, other.lo), hi: by_axis(u32::min, self.hi, other.hi) }
    }

    /// The smallest range around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        CellRange { lo: by_axis(u32::min, self.lo, other.lo), hi: by_axis(u32::max, self.hi, other.hi) }
    }

    /// The axis of the longest side, the first of equals, and its length. Of a range that is not empty.
    pub(crate) fn longest_side(&self) -> (usize, u32) {
        let [x, y, z] = by_axis(u32::wrapping_sub, self.hi, self.lo);
        if x >= y && x >= z {
            (0, x)
        } else if z > y {
            (2, z)
        } else {
            (1, y)
        }
    }

    /// The halves of a range cut across an axis; the upper half is not longer than the lower one.
    pub(crate) fn halves(&self, axis: usize) -> [Self; 2] {
        let middle = self.hi[axis] - (self.hi[axis] - self.lo[axis]) / 2;
        let (mut low, mut high) = (*self, *self);
        (low.hi[axis], high.lo[axis]) = (middle, middle);
        [low, high]
    }
}
