//! Where a grid plane meets a flat end.

use super::wall::hypotenuse;
use crate::number::plane::P2;

/// The line in which the plane of a flat end meets a plane of the grid, as f = 0 of `f(p) = constant + slope·(p − shift)`, which is not negative on the
/// inner side of the end.
#[derive(Clone, Copy, Debug)]
pub(super) struct EndLine {
    /// The value in the plane's own foot of the end's centre.
    pub constant: f64,
    /// Slope along both axes.
    pub slope: P2,
    /// The end's centre in the plane, from the part's origin.
    pub shift: P2,
}

impl EndLine {
    /// In a point given from the part's origin.
    #[inline(always)]
    pub fn at(&self, p: P2) -> f64 {
        let value = self.constant + (self.slope[0] * (p[0] - self.shift[0]) + self.slope[1] * (p[1] - self.shift[1]));
        // Not a number is outside.
        if value.is_nan() { -1.0 } else { value }
    }

    /// How far the line passes from the part's origin, positive if that is inside.
    pub fn aside(&self) -> f64 {
        let across = hypotenuse(self.slope[0], self.slope[1]);
        if across > 0.0 { self.at([0.0; 2]) / across } else { 0.0 }
    }

    /// The complement.
    pub fn reversed(&self) -> Self {
        EndLine { constant: -self.constant, slope: self.slope.map(|s| -s), ..*self }
    }
}
