//! Pieces of surface, their places relative to planes, and why a union of them may not be found.

use crate::number::real::Real;
use crate::number::space::{dot, sub};
use crate::surface::clip::Polygon;
use core::fmt;

/// Why there is no union: divide the cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum NoProof {
    /// The caller's memory is too small for what the cell holds.
    Full,
    /// Planes too close to tell apart, or the three volumes disagree; a blur may help.
    Ambiguous,
}

impl fmt::Display for NoProof {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            NoProof::Full => "the memory for unions is too small for the surface in the cell",
            NoProof::Ambiguous => {
                "planes in the cell are too close to tell apart, or the volumes along x, y and z differ"
            }
        })
    }
}

impl core::error::Error for NoProof {}

/// Planes of two bodies between one and so many thicknesses apart are neither one nor two for certain.
pub(super) const AMBIGUITY_BAND: f64 = 4.0;

/// The plane `normal·p = offset`; the solid lies on its negative side.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Plane<R> {
    pub normal: [R; 3],
    pub offset: R,
}

impl<R: Real> Plane<R> {
    #[inline(always)]
    pub fn distance(&self, p: [R; 3]) -> R {
        dot(self.normal, p) - self.offset
    }
}

/// A ball around a polygon: one product tells most polygons from a plane.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Ball<R> {
    pub center: [R; 3],
    pub radius: R,
}

impl<R: Real> Ball<R> {
    pub fn around(polygon: &Polygon<R>) -> Self {
        let center = [0, 1, 2].map(|axis| {
            let (lo, hi) = polygon.extent(axis);
            (lo + hi) * R::HALF
        });
        let farthest = polygon.corners().iter().fold(R::ZERO, |most, c| {
            let d = sub(*c, center);
            dot(d, d).larger(most)
        });
        Ball { center, radius: farthest.sqrt() }
    }

    /// The side of a plane on which the ball lies, if it is farther from it than `clear`.
    #[inline(always)]
    pub fn place(&self, plane: &Plane<R>, clear: R) -> Option<Place> {
        let (distance, reach) = (plane.distance(self.center), self.radius + clear);
        if distance < -reach { Some(Place::Negative) } else { (distance > reach).then_some(Place::Positive) }
    }
}

/// A polygon of surface in its plane.
#[derive(Clone, Debug, Default)]
pub struct Piece<R: Real> {
    pub(super) ball: Ball<R>,
    pub(super) plane: Plane<R>,
    /// Twice its area.
    pub(super) area: R,
    pub(super) polygon: Polygon<R>,
}

impl<R: Real> Piece<R> {
    /// Its place relative to a plane.
    #[inline(always)]
    pub(super) fn place(&self, plane: &Plane<R>, thickness: R) -> Place {
        let clear = thickness * R::from_f64(AMBIGUITY_BAND);
        self.ball.place(plane, clear).unwrap_or_else(|| place(span(&self.polygon, plane), thickness))
    }

    /// Make this a part of another piece, whose polygon is here already.
    pub(super) fn become_part_of(&mut self, whole: &Self) {
        (self.ball, self.plane) = (whole.ball, whole.plane);
        self.area = dot(self.polygon.doubled_area(), whole.plane.normal);
    }

    /// Does it, in the plane of another, look the other way and lie, by their boxes, on the same spot?
    pub(super) fn backs(&self, other: &Self, thickness: R) -> bool {
        let shared = [0, 1, 2].map(|axis| {
            let ((a_lo, a_hi), (b_lo, b_hi)) = (self.polygon.extent(axis), other.polygon.extent(axis));
            a_hi.min(b_hi) - a_lo.max(b_lo)
        });
        let wide = shared.iter().filter(|&&s| s > thickness).count();
        dot(self.plane.normal, other.plane.normal) < R::ZERO && wide >= 2 && shared.iter().all(|&s| s >= -thickness)
    }
}

/// A polygon against a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Place {
    Positive,
    Negative,
    On,
    Across,
}

/// Signed distances of the corners of a polygon from a plane, the smallest and the largest.
#[inline(always)]
pub(super) fn span<R: Real>(polygon: &Polygon<R>, plane: &Plane<R>) -> (R, R) {
    let (mut min, mut max) = (R::INFINITY, -R::INFINITY);
    for c in polygon.corners() {
        let d = plane.distance(*c);
        min = d.smaller(min);
        max = d.larger(max);
    }
    (min, max)
}

/// The place of a polygon by its [`span`], where planes have a thickness.
#[inline(always)]
pub(super) fn place<R: Real>((min, max): (R, R), thickness: R) -> Place {
    match (min < -thickness, max > thickness) {
        (false, false) => Place::On,
        (false, true) => Place::Positive,
        (true, false) => Place::Negative,
        (true, true) => Place::Across,
    }
}

/// Cut a polygon that is not full by a plane, into its negative and positive part.
pub(super) fn cut<R: Real>(whole: &Polygon<R>, plane: &Plane<R>, negative: &mut Polygon<R>, positive: &mut Polygon<R>) {
    negative.clear();
    positive.clear();
    let Some(&(mut a)) = whole.corners().last() else { return };
    let mut da = plane.distance(a);
    for &b in whole.corners() {
        let db = plane.distance(b);
        if (da < R::ZERO && db > R::ZERO) || (da > R::ZERO && db < R::ZERO) {
            let (lo, hi, t) = if da < db { (a, b, da / (da - db)) } else { (b, a, db / (db - da)) };
            let p = [0, 1, 2].map(|i| lo[i] + (hi[i] - lo[i]) * t);
            negative.push(p);
            positive.push(p);
        }
        if db <= R::ZERO {
            negative.push(b);
        }
        if db >= R::ZERO {
            positive.push(b);
        }
        (a, da) = (b, db);
    }
}
