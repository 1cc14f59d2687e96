//! One layer of cells: solid fractions of its cells and faces, as bounds that several bodies share.
//!
//! With the shares vᵢ of single bodies the union obeys max vᵢ ≤ v ≤ min(1, Σ vᵢ). [`Layer`] keeps the largest share and
//! the sum; where only one body counts they are equal and exact. Elsewhere [`crate::surface::union`] finds the union.

use crate::grid::Grid;
use crate::number::real::Real;

/// One value for every cell and face of a layer, in the caller's slices: cells `ny*nx`, x faces `ny*(nx+1)`, y faces
/// `(ny+1)*nx`, and the z faces below the cells `ny*nx`; x fastest.
#[derive(Debug)]
pub struct Fields<'a, T> {
    /// Of the cells.
    pub cell: &'a mut [T],
    /// Of the x faces.
    pub x: &'a mut [T],
    /// Of the y faces.
    pub y: &'a mut [T],
    /// Of the z faces below the cells.
    pub z: &'a mut [T],
}

/// A slice has another length than the grid asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShapeMismatch {
    /// The length that is needed (at least that, for scratch).
    pub expected: usize,
    /// The length that was given.
    pub found: usize,
}

/// Check a length that must be met exactly.
fn exactly(expected: usize, found: usize) -> Result<(), ShapeMismatch> {
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
        Ok(Fields { cell, x, y, z })
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
        at_least(Self::needed(grid), buffer.len())?;
        let (cell, rest) = buffer.split_at_mut(nx * ny);
        let (x, rest) = rest.split_at_mut((nx + 1) * ny);
        let (y, rest) = rest.split_at_mut(nx * (ny + 1));
        let (z, _) = rest.split_at_mut(nx * ny);
        Ok(Fields { cell, x, y, z })
    }

    /// Set every entry.
    pub fn fill(&mut self, value: T) {
        for field in [&mut self.cell, &mut self.x, &mut self.y, &mut self.z] {
            field.fill(value);
        }
    }
}

/// Bounds of the solid fractions of one layer, from the bodies added so far.
#[derive(Debug)]
pub struct Layer<'a, R> {
    /// The largest share of a single body: a lower bound, and exact where `sum` equals it.
    pub lower: Fields<'a, R>,
    /// The sum of all shares; limited to 1, an upper bound.
    pub sum: Fields<'a, R>,
    /// 1 where surface lies inside the cell or in the plane of the face, else 0.
    pub marks: Fields<'a, u8>,
}

impl<R: Real> Layer<'_, R> {
    /// Forget all bodies: everything open.
    pub fn clear(&mut self) {
        self.lower.fill(R::ZERO);
        self.sum.fill(R::ZERO);
        self.marks.fill(0);
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
pub(crate) fn count<R: Real>(share: R, lower: &mut R, sum: &mut R) {
    if share > R::ZERO {
        let share = if share > R::ONE - noise::<R>() { R::ONE } else { share };
        *lower = lower.max(share);
        *sum += share;
    }
}

/// As [`count`], for a share of a face; noise counts as open. A face is `whole` if it lies in no wall and bounds a cell without
/// surface inside: then it is open or closed altogether.
#[inline(always)]
pub(crate) fn count_face<R: Real>(share: R, whole: bool, lower: &mut R, sum: &mut R) {
    if share > if whole { R::HALF } else { noise::<R>() } {
        count(if whole { R::ONE } else { share }, lower, sum);
    }
}
