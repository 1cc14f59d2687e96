//! Bounds of a fraction that is not known exactly.

use crate::number::real::Real;

/// Bounds of a fraction: `0 <= lower <= truth <= upper <= 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds<R> {
    /// Not above the truth.
    pub lower: R,
    /// Not below it.
    pub upper: R,
}

impl<R: Real> Bounds<R> {
    /// Nothing solid.
    pub const OPEN: Self = Bounds { lower: R::ZERO, upper: R::ZERO };
    /// All solid.
    pub const CLOSED: Self = Bounds { lower: R::ONE, upper: R::ONE };
    /// Nothing known.
    pub const UNKNOWN: Self = Bounds { lower: R::ZERO, upper: R::ONE };

    /// Bounds of a value that is known up to an error, cut to 0..1.
    #[must_use]
    pub fn around(value: R, error: R) -> Self {
        Bounds { lower: value, upper: value }.widened(error)
    }

    /// Bounds that may be wrong by an error, further apart by that on both sides, cut to 0..1.
    #[must_use]
    pub fn widened(self, error: R) -> Self {
        Bounds { lower: (self.lower - error).max(R::ZERO), upper: (self.upper + error).min(R::ONE) }
    }

    /// Bounds of the open fraction from those of the solid one, and the reverse.
    #[must_use]
    pub fn complement(self) -> Self {
        Bounds { lower: R::ONE - self.upper, upper: R::ONE - self.lower }
    }

    /// Halfway between them.
    #[must_use]
    pub fn middle(self) -> R {
        self.lower + (self.upper - self.lower) * R::HALF
    }

    /// How far the bounds are apart.
    #[must_use]
    pub fn gap(self) -> R {
        self.upper - self.lower
    }
}
