//! Is a box inside a convex body? It is if all its corners are.
//!
//! Bodies are closed here: a cell that fits a box exactly is inside it.

use crate::convex::gjk::{Intersection, intersect};
use crate::convex::shape::{
    Capsule, Cone, Cylinder, Ellipsoid, Hull, OrientedBox, Point, Segment, Sphere, Triangle, Vertices,
};
use crate::convex::support::{MinkowskiDifference, Rounded, Support, Transformed};
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};

/// What [`contains`] found. There is no fourth answer: it may be matched without a rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Containment<V> {
    /// Every point of the box belongs to the body.
    Inside,
    /// Some point does not.
    Outside {
        /// A corner that is not in the body.
        corner: V,
    },
    /// Every corner is in the body, or too close to its surface to tell.
    Undecided,
}

/// A body that can tell whether it holds a point.
pub trait Contains: Support + Sized {
    /// Whether the closed body holds a point; nothing if that is too close to tell, or a number is not finite.
    fn holds(&self, point: Self::Vector) -> Option<bool> {
        match intersect(&Point(point), self, None) {
            Intersection::Apart { .. } => Some(false),
            Intersection::Overlapping { .. } => Some(true),
            Intersection::Undecided { .. } => None,
        }
    }
}

/// Is every point of a box in a convex body?
///
/// ```
/// use glam::DVec3;
/// use voidage_core::{number::aabb::Aabb, convex::containment::{Containment, contains}, convex::shape::Sphere};
///
/// let cell = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
/// assert_eq!(contains(&Sphere { center: DVec3::ZERO, radius: 2.0 }, &cell), Containment::Inside);
/// assert_eq!(contains(&cell, &cell), Containment::Inside);
/// ```
pub fn contains<S: Contains>(body: &S, cell: &Aabb<S::Vector>) -> Containment<S::Vector> {
    if cell.is_empty() || !cell.min.is_finite() || !cell.max.is_finite() {
        return Containment::Undecided;
    }
    // The corner farthest from the body's centre settles most boxes that are not inside.
    let first = cell.support(Aabb::center(*cell) - body.center(), 0).point;
    let others = (0..8).map(|i| cell.vertex(i)).filter(|&corner| corner != first);
    let mut sure = true;
    for corner in core::iter::once(first).chain(others) {
        match body.holds(corner) {
            Some(true) => {}
            Some(false) => return Containment::Outside { corner },
            None => sure = false,
        }
    }
    if sure { Containment::Inside } else { Containment::Undecided }
}

/// Compares two numbers that rounding may have moved by `error` each way.
fn at_most<R: Real>(x: R, limit: R, error: R) -> Option<bool> {
    if x + error <= limit {
        Some(true)
    } else if x - error > limit {
        Some(false)
    } else {
        None
    }
}

/// The power of two that brings a size near one; nothing for sizes with which one cannot compute.
fn unit<R: Real>(size: R) -> Option<R> {
    let unit = size.binade();
    let least = R::MIN_POSITIVE / R::EPSILON;
    (size.is_finite() && unit >= least).then(|| R::ONE / unit)
}

impl<V: Vector> Contains for Aabb<V> {
    fn holds(&self, point: V) -> Option<bool> {
        if !(self.min.is_finite() && self.max.is_finite() && point.is_finite()) {
            return None;
        }
        Some(self.min.max(point) == point && self.max.min(point) == point)
    }
}

impl<V: Vector> Contains for Sphere<V> {
    fn holds(&self, point: V) -> Option<bool> {
        let size = self.center.norm_max() + self.radius + point.norm_max();
        if !(self.radius >= V::Scalar::ZERO) || !self.center.is_finite() || !point.is_finite() {
            return None;
        }
        let factor = unit(size)?;
        let d = point * factor - self.center * factor;
        let radius = self.radius * factor;
        // Squares of numbers below four; a dozen roundings.
        let error = V::Scalar::from_f64(8.0) * V::Scalar::EPSILON * (d.dot(d) + radius * radius) + V::Scalar::UNDERFLOW;
        at_most(d.dot(d), radius * radius, error)
    }
}

impl<V: Vector> Contains for Ellipsoid<V> {}
impl<V: Vector> Contains for OrientedBox<V> {}
impl<V: Vector> Contains for Capsule<V> {}
impl<V: Vector> Contains for Cylinder<V> {}
impl<V: Vector> Contains for Cone<V> {}
impl<V: Vector> Contains for Point<V> {}
impl<V: Vector> Contains for Segment<V> {}
impl<V: Vector> Contains for Triangle<V> {}
impl<V: Vector> Contains for Hull<'_, V> {}
impl<S: Support> Contains for Rounded<S> {}
impl<S: Support> Contains for Transformed<S> {}
impl<A: Support, B: Support<Vector = A::Vector>> Contains for MinkowskiDifference<A, B> {}
