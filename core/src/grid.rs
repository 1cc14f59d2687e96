//! Rectilinear grids: cells, faces, index order.
//!
//! A grid is three lists of edges. Cell `(i, j, k)` is `x[i]..x[i+1]` × `y[j]..y[j+1]` × `z[k]..z[k+1]`. Fields are stored
//! with x fastest: cell `(k*ny + j)*nx + i`, as Fortran `a(nx,ny,nz)` and VTK. A face field is one longer along its own
//! axis: x faces `(k*ny + j)*(nx+1) + i`, y faces `(k*(ny+1) + j)*nx + i`, z faces `(k*ny + j)*nx + i`.

pub mod bounds;
pub mod cell_range;
pub mod fields;

use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};
use core::fmt;

/// A coordinate this near to a plane, as a share of the grid's length, lies in it but for rounding: far below the digits of any `f32` file.
const NEAR: f64 = 1.0 / (1_u64 << 44) as f64;

/// So does one within so many units in the last place of the grid's largest coordinate.
const NEAR_ULPS: f64 = 2.0;

/// Edges of a rectilinear grid, borrowed from the caller, checked once.
#[derive(Clone, Copy, Debug)]
pub struct Grid<'a, R> {
    edges: [&'a [R]; 3],
}

/// Why three edge lists are no grid. `axis` is 0, 1, 2 for x, y, z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum GridError {
    /// Fewer than two edges.
    NoCell {
        /// The axis at fault.
        axis: usize,
    },
    /// An edge is NaN or infinite.
    NotFinite {
        /// The axis at fault.
        axis: usize,
        /// Its position in the list.
        index: usize,
    },
    /// An edge does not lie above the one before it.
    NotIncreasing {
        /// The axis at fault.
        axis: usize,
        /// Its position in the list.
        index: usize,
    },
    /// Cell volumes or the whole volume leave the normal range of the scalar, or the cells cannot be counted.
    OutOfRange,
}

impl fmt::Display for GridError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let name = |axis: usize| ["x", "y", "z"].get(axis).copied().unwrap_or("?");
        match *self {
            GridError::NoCell { axis } => write!(f, "fewer than two edges along {}", name(axis)),
            GridError::NotFinite { axis, index } => write!(f, "edge {index} along {} is NaN or infinite", name(axis)),
            GridError::NotIncreasing { axis, index } => {
                write!(f, "edge {index} along {} does not lie above the one before it", name(axis))
            }
            GridError::OutOfRange => f.write_str("cells too small, too large or too many to compute with"),
        }
    }
}

impl core::error::Error for GridError {}

/// Distance within which a coordinate beside a grid between two planes is that of a plane but for rounding.
pub(crate) fn rounding<R: Real>([first, last]: [R; 2]) -> R {
    let largest = first.abs().larger(last.abs());
    (last - first) * R::from_f64(NEAR) + largest * R::EPSILON * R::from_f64(NEAR_ULPS)
}

impl<'a, R: Real> Grid<'a, R> {
    /// A grid on three lists of strictly increasing, finite edges, each with at least two entries.
    ///
    /// # Errors
    /// [`GridError`] names the axis and the edge.
    pub fn new(x: &'a [R], y: &'a [R], z: &'a [R]) -> Result<Self, GridError> {
        let edges = [x, y, z];
        let (mut finest, mut whole, mut faces) = (R::ONE, R::ONE, Some(1_usize));
        for (axis, e) in edges.iter().enumerate() {
            let (Some(&first), Some(&last)) = (e.first(), e.last()) else {
                return Err(GridError::NoCell { axis });
            };
            if e.len() < 2 {
                return Err(GridError::NoCell { axis });
            }
            if let Some(index) = e.iter().position(|v| !v.is_finite()) {
                return Err(GridError::NotFinite { axis, index });
            }
            let mut smallest = R::INFINITY;
            for (index, (&lo, &hi)) in (1..).zip(e.iter().zip(e.iter().skip(1))) {
                if hi <= lo {
                    return Err(GridError::NotIncreasing { axis, index });
                }
                smallest = smallest.min(hi - lo);
            }
            finest *= smallest;
            whole *= last - first;
            if !(finest >= R::MIN_POSITIVE / R::EPSILON) || !(whole <= R::MAX * R::EPSILON) {
                return Err(GridError::OutOfRange);
            }
            faces = faces.and_then(|n| n.checked_mul(e.len()));
        }
        if faces.is_none_or(|n| n > isize::MAX as usize / 64) {
            return Err(GridError::OutOfRange);
        }
        Ok(Grid { edges })
    }

    /// The edges along one axis (0, 1 for x, y, otherwise z).
    #[must_use]
    #[inline(always)]
    pub fn edges(&self, axis: usize) -> &'a [R] {
        match axis {
            0 => self.edges[0],
            1 => self.edges[1],
            _ => self.edges[2],
        }
    }

    /// Number of cells `[nx, ny, nz]`.
    #[must_use]
    #[inline(always)]
    pub fn cells(&self) -> [usize; 3] {
        self.edges.map(|e| e.len() - 1)
    }

    /// The lowest and the highest edge along an axis (0, 1 for x, y, otherwise z).
    #[must_use]
    pub fn ends(&self, axis: usize) -> [R; 2] {
        match self.edges(axis) {
            [first, .., last] => [*first, *last],
            // No grid is made of fewer than two edges.
            _ => [R::ZERO; 2],
        }
    }

    /// Distance along an axis (0, 1 for x, y, otherwise z) within which a coordinate is that of a plane but for rounding.
    #[must_use]
    pub fn rounding(&self, axis: usize) -> R {
        rounding(self.ends(axis))
    }

    /// The plane of the grid that a coordinate lies in, or misses by rounding in `f64`.
    pub(crate) fn plane_at(&self, axis: usize, value: f64) -> Option<f64> {
        let (edges, room) = (self.edges(axis), rounding(self.ends(axis).map(R::to_f64)));
        let above = edges.partition_point(|e| e.to_f64() < value);
        let beside = [edges.get(above), above.checked_sub(1).and_then(|below| edges.get(below))];
        beside.into_iter().flatten().map(|e| e.to_f64()).find(|e| (e - value).abs() <= room)
    }

    /// The box of the whole grid.
    #[must_use]
    pub fn bounds(&self) -> Aabb<R::Vector> {
        let [x, y, z] = [0, 1, 2].map(|axis| self.ends(axis));
        Aabb { min: R::Vector::new(x[0], y[0], z[0]), max: R::Vector::new(x[1], y[1], z[1]) }
    }

    /// Number of cells in all.
    #[must_use]
    pub fn cell_count(&self) -> usize {
        self.cells().iter().product()
    }

    /// Shape of the field of faces normal to `axis` (0, 1, otherwise 2): the cells, one more along the axis.
    #[must_use]
    pub fn face_shape(&self, axis: usize) -> [usize; 3] {
        let [nx, ny, nz] = self.cells();
        match axis {
            0 => [nx + 1, ny, nz],
            1 => [nx, ny + 1, nz],
            _ => [nx, ny, nz + 1],
        }
    }

    /// Position of a cell in a field. Of a cell that the grid does not have, some number.
    #[must_use]
    pub fn cell_index(&self, at: [usize; 3]) -> usize {
        index_in(self.cells(), at)
    }

    /// Position of the face normal to `axis` in its field; `[i, j, k]` counts along the axis from the lowest plane. Of a face that the grid
    /// does not have, some number.
    #[must_use]
    pub fn face_index(&self, axis: usize, at: [usize; 3]) -> usize {
        index_in(self.face_shape(axis), at)
    }

    /// The box of a cell; none if the grid has no such cell.
    #[must_use]
    pub fn cell_box(&self, [i, j, k]: [usize; 3]) -> Option<Aabb<R::Vector>> {
        let side = |axis: usize, n: usize| Some((*self.edges(axis).get(n)?, *self.edges(axis).get(n.checked_add(1)?)?));
        let (x, y, z) = (side(0, i)?, side(1, j)?, side(2, k)?);
        Some(Aabb { min: R::Vector::new(x.0, y.0, z.0), max: R::Vector::new(x.1, y.1, z.1) })
    }

    /// The cell of `axis` that holds a coordinate.
    #[must_use]
    pub fn locate(&self, axis: usize, value: R) -> Located {
        locate(self.edges(axis), value)
    }
}

/// Position in a field of a shape, x fastest. It wraps where the caller's numbers are too large.
fn index_in([nx, ny, _]: [usize; 3], [i, j, k]: [usize; 3]) -> usize {
    k.wrapping_mul(ny).wrapping_add(j).wrapping_mul(nx).wrapping_add(i)
}

/// Where a coordinate lies along one axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Located {
    /// Below the first edge.
    Below,
    /// In cell `i`: at or above edge `i`, below edge `i + 1`.
    Cell(usize),
    /// At or above the last edge, or NaN.
    Above,
}

/// Find the cell of a coordinate in a list of edges: a guess for equal spacing, then bisection.
pub(crate) fn locate<R: Real>(edges: &[R], value: R) -> Located {
    let [first, .., end] = edges else { return Located::Above };
    if value < *first {
        return Located::Below;
    }
    if !(value < *end) {
        return Located::Above;
    }
    let last = edges.len() - 1;
    let share = (value - *first) / (*end - *first);
    let guess = (share * R::from_usize(last)).to_usize().min(last - 1);
    for i in [guess, guess.saturating_sub(1), (guess + 1).min(last - 1)] {
        if edges.get(i).is_some_and(|&lo| lo <= value) && edges.get(i + 1).is_some_and(|&hi| value < hi) {
            return Located::Cell(i);
        }
    }
    Located::Cell(edges.partition_point(|&e| e <= value).saturating_sub(1))
}
