//! Cutting convex polygons by planes.
//!
//! A crossing is always computed from the lower end of the edge, so two polygons that share an edge get bitwise the same
//! point: a closed surface stays closed whatever it is cut by.

use heapless::Vec;

use crate::number::real::Real;
use crate::number::space::{cross, sub};

/// Most corners of a polygon. A triangle cut by the six planes of a box has at most 9; the rest is for the cuts by
/// other bodies' planes in one cell. A full polygon is halved before the next cut.
pub const MAX_CORNERS: usize = 16;

/// A convex polygon in space, by its corners in order; fewer than three corners mean that it is empty.
#[derive(Clone, Debug, Default)]
pub struct Polygon<R> {
    corners: Vec<[R; 3], MAX_CORNERS>,
}

impl<R: Real> Polygon<R> {
    /// A polygon with the given corners (at most [`MAX_CORNERS`]; the rest is dropped).
    #[must_use]
    pub fn new(corners: &[[R; 3]]) -> Self {
        let mut p = Self::default();
        p.set(corners);
        p
    }

    /// Take the given corners instead (at most [`MAX_CORNERS`]; the rest is dropped).
    #[inline(always)]
    pub fn set(&mut self, corners: &[[R; 3]]) {
        self.clear();
        for &c in corners {
            self.push(c);
        }
    }

    /// Take the corners of another polygon, and only those.
    #[inline(always)]
    pub fn assign(&mut self, other: &Self) {
        self.set(other.corners());
    }

    /// The corners in order.
    #[must_use]
    #[inline(always)]
    pub fn corners(&self) -> &[[R; 3]] {
        &self.corners
    }

    /// No area: fewer than three corners.
    #[must_use]
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.corners.len() < 3
    }

    /// Add a corner; false if there is no room.
    #[inline(always)]
    pub fn push(&mut self, corner: [R; 3]) -> bool {
        self.corners.push(corner).is_ok()
    }

    /// Removes all corners.
    #[inline(always)]
    pub fn clear(&mut self) {
        self.corners.clear();
    }

    /// Lowest and highest coordinate along an axis (0, 1, otherwise 2).
    #[must_use]
    #[inline(always)]
    pub fn extent(&self, axis: usize) -> (R, R) {
        let axis = axis.min(2);
        let (mut lo, mut hi) = (R::INFINITY, -R::INFINITY);
        for c in self.corners() {
            lo = c[axis].smaller(lo);
            hi = c[axis].larger(hi);
        }
        (lo, hi)
    }

    /// Two polygons that make up this one, each with fewer corners if it has more than four.
    #[must_use]
    pub fn halves(&self) -> [Self; 2] {
        let c = self.corners();
        let middle = c.len() / 2;
        let mut halves = [Self::default(), Self::default()];
        for (n, &corner) in c.iter().enumerate() {
            if n <= middle {
                halves[0].push(corner);
            }
            if n >= middle || n == 0 {
                halves[1].push(corner);
            }
        }
        halves
    }

    /// Whether it holds as many corners as it can.
    #[must_use]
    #[inline(always)]
    pub fn is_full(&self) -> bool {
        self.corners.is_full()
    }

    /// Twice the area vector (its direction by the right-hand rule).
    #[must_use]
    pub fn doubled_area(&self) -> [R; 3] {
        let mut sum = [R::ZERO; 3];
        let [first, second, others @ ..] = self.corners() else { return sum };
        let mut a = sub(*second, *first);
        for corner in others {
            let b = sub(*corner, *first);
            let n = cross(a, b);
            sum = [sum[0] + n[0], sum[1] + n[1], sum[2] + n[2]];
            a = b;
        }
        sum
    }
}

/// The point of the edge `a`–`b` at coordinate `at` of `axis` (0, 1, otherwise 2), which lies strictly between both ends.
#[inline(always)]
pub fn crossing<R: Real>(a: [R; 3], b: [R; 3], axis: usize, at: R) -> [R; 3] {
    let axis = axis.min(2);
    let (lo, hi) = if a[axis] < b[axis] { (a, b) } else { (b, a) };
    let t = (at - lo[axis]) / (hi[axis] - lo[axis]);
    let mut p = [lo[0] + (hi[0] - lo[0]) * t, lo[1] + (hi[1] - lo[1]) * t, lo[2] + (hi[2] - lo[2]) * t];
    p[axis] = at;
    p
}

/// Split a polygon at coordinate `at` of `axis` (0, 1, otherwise 2) into the parts below and above. Corners on the plane go to both.
#[inline]
pub fn split<R: Real>(whole: &Polygon<R>, axis: usize, at: R, below: &mut Polygon<R>, above: &mut Polygon<R>) {
    let axis = axis.min(2);
    below.clear();
    above.clear();
    let corners = whole.corners();
    let Some(&(mut a)) = corners.last() else { return };
    for &b in corners {
        if (a[axis] < at && b[axis] > at) || (a[axis] > at && b[axis] < at) {
            let p = crossing(a, b, axis, at);
            below.push(p);
            above.push(p);
        }
        if b[axis] <= at {
            below.push(b);
        }
        if b[axis] >= at {
            above.push(b);
        }
        a = b;
    }
}

/// The part of a polygon above coordinate `at` of `axis` (0, 1, otherwise 2), or below; corners on the plane belong to it. The same points as [`split`] finds.
#[inline]
pub fn keep<R: Real>(whole: &Polygon<R>, axis: usize, at: R, above: bool, kept: &mut Polygon<R>) {
    let axis = axis.min(2);
    kept.clear();
    let corners = whole.corners();
    let Some(&(mut a)) = corners.last() else { return };
    for &b in corners {
        if (a[axis] < at && b[axis] > at) || (a[axis] > at && b[axis] < at) {
            kept.push(crossing(a, b, axis, at));
        }
        if b[axis] == at || (b[axis] > at) == above {
            kept.push(b);
        }
        a = b;
    }
}
