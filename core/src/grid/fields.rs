//! One layer of cells: solid fractions of its cells and faces, as bounds that several bodies share.
//!
//! With the shares vᵢ of single bodies the union obeys max vᵢ ≤ v ≤ min(1, Σ vᵢ). [`Layer`] keeps the largest share and
//! the sum; where only one body counts they are equal and exact. Elsewhere [`crate::surface::union`] finds the union.

use crate::grid::Grid;
use crate::number::real::Real;
use core::fmt;

/// One value for every cell and face of a layer, in the caller's slices: cells `ny*nx`, x faces `ny*(nx+1)`, y faces
/// `(ny+1)*nx`, and the z faces below the cells `ny*nx`; x fastest.
#[derive(Debug)]
pub struct Fields<'a, T> {
    /// Cells along x and y.
    pub(crate) cells: [usize; 2],
    pub(crate) cell: &'a mut [T],
    pub(crate) x: &'a mut [T],
    pub(crate) y: &'a mut [T],
    pub(crate) z: &'a mut [T],
}

/// A slice has another length than the grid asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShapeMismatch {
    /// The length that is needed (at least that, for scratch).
    pub expected: usize,
    /// The length that was given.
    pub found: usize,
}

impl fmt::Display for ShapeMismatch {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "a slice of {} entries where the grid asks for {}", self.found, self.expected)
    }
}

impl core::error::Error for ShapeMismatch {}

/// Check a length that must be met exactly.
pub(crate) fn exactly(expected: usize, found: usize) -> Result<(), ShapeMismatch> {
    if expected == found { Ok(()) } else { Err(ShapeMismatch { expected, found }) }
}

/// Check a length that must be reached.
pub(crate) fn at_least(expected: usize, found: usize) -> Result<(), ShapeMismatch> {
    if found >= expected { Ok(()) } else { Err(ShapeMismatch { expected, found }) }
}

impl<'a, T: Copy> Fields<'a, T> {
    /// Four slices as the fields of a layer of `grid`.
    ///
    /// # Errors
    /// [`ShapeMismatch`] for the first slice of wrong length.
    pub fn new<R: Real>(
        grid: &Grid<R>,
        cell: &'a mut [T],
        x: &'a mut [T],
        y: &'a mut [T],
        z: &'a mut [T],
    ) -> Result<Self, ShapeMismatch> {
        let [nx, ny, _] = grid.cells();
        exactly(nx * ny, cell.len())?;
        exactly((nx + 1) * ny, x.len())?;
        exactly(nx * (ny + 1), y.len())?;
        exactly(nx * ny, z.len())?;
        Ok(Fields { cells: [nx, ny], cell, x, y, z })
    }

    /// Length of one buffer that holds the four fields.
    #[must_use]
    pub fn needed<R: Real>(grid: &Grid<R>) -> usize {
        let [nx, ny, _] = grid.cells();
        4 * nx * ny + nx + ny
    }

    /// The four fields in one buffer of at least [`Fields::needed`] entries.
    ///
    /// # Errors
    /// [`ShapeMismatch`] if the buffer is too short.
    pub fn within<R: Real>(grid: &Grid<R>, buffer: &'a mut [T]) -> Result<Self, ShapeMismatch> {
        let [nx, ny, _] = grid.cells();
        let short = ShapeMismatch { expected: Self::needed(grid), found: buffer.len() };
        let (cell, rest) = buffer.split_at_mut_checked(nx * ny).ok_or(short)?;
        let (x, rest) = rest.split_at_mut_checked((nx + 1) * ny).ok_or(short)?;
        let (y, rest) = rest.split_at_mut_checked(nx * (ny + 1)).ok_or(short)?;
        let (z, _) = rest.split_at_mut_checked(nx * ny).ok_or(short)?;
        Ok(Fields { cells: [nx, ny], cell, x, y, z })
    }

    /// Of the cells.
    #[must_use]
    pub fn cells(&self) -> &[T] {
        self.cell
    }

    /// Of the faces normal to an axis (0, 1, otherwise 2).
    #[must_use]
    pub fn faces(&self, axis: usize) -> &[T] {
        match axis {
            0 => self.x,
            1 => self.y,
            _ => self.z,
        }
    }

    pub(crate) fn faces_mut(&mut self, axis: usize) -> &mut [T] {
        match axis {
            0 => self.x,
            1 => self.y,
            _ => self.z,
        }
    }

    /// Set every entry.
    pub fn fill(&mut self, value: T) {
        for field in [&mut self.cell, &mut self.x, &mut self.y, &mut self.z] {
            field.fill(value);
        }
    }

    /// The same fields, for a shorter time.
    pub(crate) fn reborrow(&mut self) -> Fields<'_, T> {
        Fields { cells: self.cells, cell: self.cell, x: self.x, y: self.y, z: self.z }
    }
}

/// Bounds of the solid fractions of one layer, from the bodies added so far.
#[derive(Debug)]
pub struct Layer<'a, R> {
    /// The largest share of a single body: a lower bound, and exact where `sum` equals it.
    pub(crate) lower: Fields<'a, R>,
    /// The sum of all shares; limited to 1, an upper bound.
    pub(crate) sum: Fields<'a, R>,
    /// 1 where surface lies inside the cell or in the plane of the face, else 0.
    pub(crate) has_surface: Fields<'a, u8>,
}

impl<'a, R: Real> Layer<'a, R> {
    /// A layer in three sets of fields, all open.
    ///
    /// # Errors
    /// [`ShapeMismatch`] if they are not of the same grid.
    pub fn new(lower: Fields<'a, R>, sum: Fields<'a, R>, has_surface: Fields<'a, u8>) -> Result<Self, ShapeMismatch> {
        for cells in [sum.cells, has_surface.cells] {
            exactly(lower.cells[0], cells[0])?;
            exactly(lower.cells[1], cells[1])?;
        }
        let mut layer = Layer { lower, sum, has_surface };
        layer.clear();
        Ok(layer)
    }

    /// Forget all bodies: everything open.
    pub fn clear(&mut self) {
        self.lower.fill(R::ZERO);
        self.sum.fill(R::ZERO);
        self.has_surface.fill(0);
    }

    /// The largest share of a single body: a lower bound, and exact where [`Layer::sum`] equals it.
    #[must_use]
    pub fn lower(&self) -> &Fields<'a, R> {
        &self.lower
    }

    /// The sum of all shares; limited to 1, an upper bound.
    #[must_use]
    pub fn sum(&self) -> &Fields<'a, R> {
        &self.sum
    }

    /// 1 where surface lies inside the cell or in the plane of the face, else 0.
    #[must_use]
    pub fn has_surface(&self) -> &Fields<'a, u8> {
        &self.has_surface
    }

    /// Lower bounds and sums of the cells, to add what other bodies have of them.
    pub fn cells_mut(&mut self) -> (&mut [R], &mut [R]) {
        (self.lower.cell, self.sum.cell)
    }

    /// Lower bounds and sums of the faces normal to an axis (0, 1, otherwise 2), likewise.
    pub fn faces_mut(&mut self, axis: usize) -> (&mut [R], &mut [R]) {
        (self.lower.faces_mut(axis), self.sum.faces_mut(axis))
    }

    /// The same layer, for a shorter time.
    pub(crate) fn reborrow(&mut self) -> Layer<'_, R> {
        Layer { lower: self.lower.reborrow(), sum: self.sum.reborrow(), has_surface: self.has_surface.reborrow() }
    }

    /// The slices are those of a layer of this grid.
    pub(crate) fn fits(&self, grid: &Grid<R>) -> Result<(), ShapeMismatch> {
        let [nx, ny, _] = grid.cells();
        exactly(nx, self.lower.cells[0])?;
        exactly(ny, self.lower.cells[1])
    }
}

/// How far the union may lie above its lower bound: min(1, Σ vᵢ) − max vᵢ. Zero where it is known.
#[must_use]
#[inline(always)]
pub fn gap<R: Real>(lower: R, sum: R) -> R {
    sum.min(R::ONE) - lower
}

/// Fractions closer to 0 or 1 than this are the rounding noise of row sums. In units of ε: 6·10⁻¹⁴ in `f64`.
const NOISE_IN_EPSILONS: f64 = 256.0;

/// The noise threshold of a precision.
#[inline(always)]
pub(crate) fn noise<R: Real>() -> R {
    R::EPSILON * R::from_f64(NOISE_IN_EPSILONS)
}

/// Let a body's share count in the bounds of a cell or face.
#[inline(always)]
pub(crate) fn accumulate<R: Real>(share: R, lower: &mut R, sum: &mut R) {
    if share > R::ZERO {
        let share = if share > R::ONE - noise::<R>() { R::ONE } else { share };
        *lower = lower.max(share);
        *sum += share;
    }
}

/// As [`accumulate`], for a share of a face; noise counts as open. A face is `whole` if it lies in no wall and bounds a cell without
/// surface inside: then it is open or closed altogether.
#[inline(always)]
pub(crate) fn accumulate_face<R: Real>(share: R, whole: bool, lower: &mut R, sum: &mut R) {
    if share > if whole { R::HALF } else { noise::<R>() } {
        accumulate(if whole { R::ONE } else { share }, lower, sum);
    }
}
