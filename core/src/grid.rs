//! Rectilinear grids: cells, faces, index order.
//!
//! A grid is three lists of edges. Cell `(i, j, k)` is `x[i]..x[i+1]` × `y[j]..y[j+1]` × `z[k]..z[k+1]`. Fields are stored
//! with x fastest: cell `(k*ny + j)*nx + i`, as Fortran `a(nx,ny,nz)` and VTK. A face field is one longer along its own
//! axis: x faces `(k*ny + j)*(nx+1) + i`, y faces `(k*(ny+1) + j)*nx + i`, z faces `(k*ny + j)*nx + i`.

pub mod cell_range;
pub mod fields;

use crate::number::real::Real;

/// Edges of a rectilinear grid, borrowed from the caller, checked once.
#[derive(Clone, Copy, Debug)]
pub struct Grid<'a, R> {
    edges: [&'a [R]; 3],
}

/// Why three edge lists are no grid. `axis` is 0, 1, 2 for x, y, z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
            for (index, pair) in e.windows(2).enumerate() {
                if pair[1] <= pair[0] {
                    return Err(GridError::NotIncreasing { axis, index: index + 1 });
                }
                smallest = smallest.min(pair[1] - pair[0]);
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

    /// The edges along one axis (0, 1, 2 for x, y, z).
    #[must_use]
    pub fn edges(&self, axis: usize) -> &'a [R] {
        self.edges[axis]
    }

    /// Number of cells `[nx, ny, nz]`.
    #[must_use]
    pub fn cells(&self) -> [usize; 3] {
        self.edges.map(|e| e.len() - 1)
    }

    /// Number of cells in all.
    #[must_use]
    pub fn cell_count(&self) -> usize {
        self.cells().iter().product()
    }

    /// Shape of the field of faces normal to `axis`: the cells, one more along the axis.
    #[must_use]
    pub fn face_shape(&self, axis: usize) -> [usize; 3] {
        let mut n = self.cells();
        n[axis] += 1;
        n
    }

    /// Position of a cell in a field.
    #[must_use]
    pub fn cell_index(&self, [i, j, k]: [usize; 3]) -> usize {
        let [nx, ny, _] = self.cells();
        (k * ny + j) * nx + i
    }

    /// Position of the face normal to `axis` in its field; `[i, j, k]` counts along the axis from the lowest plane.
    #[must_use]
    pub fn face_index(&self, axis: usize, [i, j, k]: [usize; 3]) -> usize {
        let [nx, ny, _] = self.face_shape(axis);
        (k * ny + j) * nx + i
    }

    /// Lowest and highest corner of a cell.
    #[must_use]
    pub fn cell_box(&self, cell: [usize; 3]) -> ([R; 3], [R; 3]) {
        let [x, y, z] = self.edges;
        let [i, j, k] = cell;
        ([x[i], y[j], z[k]], [x[i + 1], y[j + 1], z[k + 1]])
    }

    /// The cell of `axis` that holds a coordinate.
    #[must_use]
    pub fn locate(&self, axis: usize, value: R) -> Located {
        locate(self.edges[axis], value)
    }
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
    let last = edges.len() - 1;
    if value < edges[0] {
        return Located::Below;
    }
    if !(value < edges[last]) {
        return Located::Above;
    }
    let share = (value - edges[0]) / (edges[last] - edges[0]);
    let guess = ((share * R::from_usize(last)).to_f64() as usize).min(last - 1);
    for i in [guess, guess.saturating_sub(1), (guess + 1).min(last - 1)] {
        if edges[i] <= value && value < edges[i + 1] {
            return Located::Cell(i);
        }
    }
    Located::Cell(edges.partition_point(|&e| e <= value) - 1)
}
