//! Bodies with curved surfaces: sphere, capsule, ellipsoid, cylinder, cone.
//!
//! Sphere and capsule are a point and a segment with a radius, which is taken off exactly; the others round, and say by how much.

use super::flat::{Point, Segment};
use super::plane::FacetPlane;
use crate::convex::support::{Rounded, Support, SupportPoint, delegate_support, magnitude, normalized, only};
use crate::number::real::{Real, Vector};

/// A ball: a point with a radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere<V: Vector> {
    /// Centre.
    pub center: V,
    /// Radius, not negative.
    pub radius: V::Scalar,
}

/// A segment with a radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule<V: Vector> {
    /// One end of the core.
    pub from: V,
    /// The other end.
    pub to: V,
    /// Radius, not negative.
    pub radius: V::Scalar,
}

impl<V: Vector> Sphere<V> {
    #[inline(always)]
    fn rounded(&self) -> Rounded<Point<V>> {
        Rounded { core: Point(self.center), radius: self.radius }
    }
}

impl<V: Vector> Capsule<V> {
    #[inline(always)]
    fn rounded(&self) -> Rounded<Segment<V>> {
        Rounded { core: Segment { from: self.from, to: self.to }, radius: self.radius }
    }
}

impl<V: Vector> Support for Sphere<V> {
    const ROUNDED: bool = true;
    delegate_support!(self, V => self.rounded());
}

impl<V: Vector> Support for Capsule<V> {
    const ROUNDED: bool = true;
    delegate_support!(self, V => self.rounded());
}

/// An ellipsoid with axes along x, y and z; see [`crate::convex::support::Transformed`] for others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid<V> {
    /// Centre.
    pub center: V,
    /// Half the length along each axis, not negative.
    pub semi_axes: V,
}

#[inline(always)]
fn times<V: Vector>(a: V, b: V) -> V {
    V::new(a.x() * b.x(), a.y() * b.y(), a.z() * b.z())
}

impl<V: Vector> Support for Ellipsoid<V> {
    type Vector = V;
    #[inline(always)]
    fn support(&self, direction: V, _: u32) -> SupportPoint<V> {
        let on_unit_ball = normalized(times(self.semi_axes, normalized(direction)));
        only(self.center + times(self.semi_axes, on_unit_ball))
    }
    #[inline(always)]
    fn center(&self) -> V {
        self.center
    }
    #[inline(always)]
    fn extent(&self) -> V::Scalar {
        magnitude(self.center.abs() + self.semi_axes.abs())
            * (V::Scalar::ONE + V::Scalar::from_f64(4.0) * V::Scalar::EPSILON)
    }
    #[inline(always)]
    fn slack(&self) -> V::Scalar {
        V::Scalar::from_f64(24.0) * V::Scalar::EPSILON * self.extent()
    }
}

/// A centre, an axis and two vectors across it: what cylinder and cone have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AxisFrame<V: Vector> {
    pub base: V,
    pub top: V,
    axis: V,
    pub across: [V; 2],
    pub radius: V::Scalar,
    pub height: V::Scalar,
    /// Across the axis through base and top.
    pub ends: [FacetPlane<V>; 2],
}

impl<V: Vector> AxisFrame<V> {
    pub fn new(base: V, top: V, radius: V::Scalar) -> Self {
        let axis = top - base;
        let unit = normalized(axis);
        let u = normalized(unit.cross(unit.least_axis()));
        let ends = [FacetPlane::new(base - top, base), FacetPlane::new(axis, top)];
        AxisFrame { base, top, axis, across: [u, unit.cross(u)], radius, height: axis.length(), ends }
    }

    /// From the axis to the point of the unit circle farthest along a direction.
    #[inline(always)]
    fn rim(&self, direction: V) -> V {
        let [u, v] = self.across;
        let zero = V::Scalar::ZERO;
        let local = normalized(V::new(u.dot(direction), v.dot(direction), zero));
        u * local.x() + v * local.y()
    }

    /// `other` is a second radius.
    fn extent(&self, other: V::Scalar) -> V::Scalar {
        let zero = V::Scalar::ZERO;
        let bad = if self.radius >= zero && other >= zero { zero } else { V::Scalar::INFINITY };
        let highest = self.base.abs() + self.axis.abs() + V::splat(self.radius.max(other));
        magnitude(highest) * (V::Scalar::ONE + V::Scalar::from_f64(16.0) * V::Scalar::EPSILON) + bad
    }

    fn slack(&self, other: V::Scalar) -> V::Scalar {
        // A handful of roundings in the frame, in the direction across it, in its unit vector and in the sums.
        V::Scalar::from_f64(48.0) * V::Scalar::EPSILON * self.extent(other)
    }
}

/// A cylinder with flat ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder<V: Vector>(pub(crate) AxisFrame<V>);

impl<V: Vector> Cylinder<V> {
    /// Between the centres of its ends. With both in one place it is that point.
    pub fn new(from: V, to: V, radius: V::Scalar) -> Self {
        Cylinder(AxisFrame::new(from, to, radius))
    }

    /// The centres of its ends.
    pub fn ends(&self) -> [V; 2] {
        [self.0.base, self.0.top]
    }

    /// The radius of its ends. ([`Support::radius`] is that of rounding, zero.)
    pub fn base_radius(&self) -> V::Scalar {
        self.0.radius
    }
}

impl<V: Vector> Support for Cylinder<V> {
    type Vector = V;
    #[inline(always)]
    fn support(&self, direction: V, _: u32) -> SupportPoint<V> {
        let rim = self.0.rim(direction) * self.0.radius;
        let end = if self.0.axis.dot(direction) > V::Scalar::ZERO { self.0.axis } else { V::ZERO };
        only(self.0.base + end + rim)
    }
    #[inline(always)]
    fn center(&self) -> V {
        self.0.base + self.0.axis * V::Scalar::HALF
    }
    #[inline(always)]
    fn extent(&self) -> V::Scalar {
        self.0.extent(V::Scalar::ZERO)
    }
    #[inline(always)]
    fn slack(&self) -> V::Scalar {
        self.0.slack(V::Scalar::ZERO)
    }
}

/// A cone with a flat base, whole or truncated: between two discs across one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone<V: Vector> {
    pub(crate) frame: AxisFrame<V>,
    top_radius: V::Scalar,
}

impl<V: Vector> Cone<V> {
    /// From the centre and radius of its base to its apex. With both in one place it is that point.
    pub fn new(base: V, apex: V, radius: V::Scalar) -> Self {
        Self::truncated(base, apex, radius, V::Scalar::ZERO)
    }

    /// Between the centres of its base and top, by the radii of both. With both in one place it is that point.
    pub fn truncated(base: V, top: V, radius: V::Scalar, top_radius: V::Scalar) -> Self {
        Cone { frame: AxisFrame::new(base, top, radius), top_radius }
    }

    /// The centres of its base and of its top, or its apex.
    pub fn ends(&self) -> [V; 2] {
        [self.frame.base, self.frame.top]
    }

    /// The radius of its base. ([`Support::radius`] is that of rounding, zero.)
    pub fn base_radius(&self) -> V::Scalar {
        self.frame.radius
    }

    /// The radius of its top, zero if that is an apex.
    pub fn top_radius(&self) -> V::Scalar {
        self.top_radius
    }
}

impl<V: Vector> Support for Cone<V> {
    type Vector = V;
    #[inline(always)]
    fn support(&self, direction: V, _: u32) -> SupportPoint<V> {
        let AxisFrame { base, axis, radius, .. } = self.frame;
        let rim = self.frame.rim(direction);
        let (low, high) = (rim * radius, axis + rim * self.top_radius);
        only(base + if high.dot(direction) > low.dot(direction) { high } else { low })
    }
    #[inline(always)]
    fn center(&self) -> V {
        let quarter = V::Scalar::from_f64(0.25);
        let share = if self.top_radius > self.frame.radius * quarter { V::Scalar::HALF } else { quarter };
        self.frame.base + self.frame.axis * share
    }
    #[inline(always)]
    fn extent(&self) -> V::Scalar {
        self.frame.extent(self.top_radius)
    }
    #[inline(always)]
    fn slack(&self) -> V::Scalar {
        self.frame.slack(self.top_radius)
    }
}
