//! Bodies with flat sides and few vertices: point, segment, triangle, boxes.

use crate::convex::support::{Support, SupportPoint, magnitude, only};
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};

/// A body that is the hull of finitely many points, each exactly representable.
pub trait Vertices: Support {
    /// How many points; some may be repeated or lie inside.
    fn count(&self) -> usize;
    /// The point of an index below [`Vertices::count`]; the last one above it.
    fn vertex(&self, index: usize) -> Self::Vector;
}

impl<S: Vertices> Vertices for &S {
    fn count(&self) -> usize {
        (**self).count()
    }
    fn vertex(&self, index: usize) -> S::Vector {
        (**self).vertex(index)
    }
}

/// A single point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point<V>(pub V);

impl<V: Vector> Support for Point<V> {
    type Vector = V;
    #[inline(always)]
    fn support(&self, _: V, _: u32) -> SupportPoint<V> {
        only(self.0)
    }
    #[inline(always)]
    fn center(&self) -> V {
        self.0
    }
    #[inline(always)]
    fn extent(&self) -> V::Scalar {
        magnitude(self.0)
    }
}

impl<V: Vector> Vertices for Point<V> {
    fn count(&self) -> usize {
        1
    }
    fn vertex(&self, _: usize) -> V {
        self.0
    }
}

/// A line segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment<V> {
    /// One end.
    pub from: V,
    /// The other end.
    pub to: V,
}

impl<V: Vector> Support for Segment<V> {
    type Vector = V;
    #[inline(always)]
    fn support(&self, direction: V, _: u32) -> SupportPoint<V> {
        if self.to.dot(direction) > self.from.dot(direction) {
            SupportPoint { point: self.to, index: 1 }
        } else {
            only(self.from)
        }
    }
    #[inline(always)]
    fn center(&self) -> V {
        self.from * V::Scalar::HALF + self.to * V::Scalar::HALF
    }
    #[inline(always)]
    fn extent(&self) -> V::Scalar {
        magnitude(self.from).max(magnitude(self.to)) + magnitude(self.from + self.to) * V::Scalar::ZERO
    }
}

impl<V: Vector> Vertices for Segment<V> {
    fn count(&self) -> usize {
        2
    }
    fn vertex(&self, index: usize) -> V {
        if index == 0 { self.from } else { self.to }
    }
}

/// A triangle; it may be degenerate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle<V> {
    /// First corner.
    pub a: V,
    /// Second corner.
    pub b: V,
    /// Third corner.
    pub c: V,
}

impl<V: Vector> Support for Triangle<V> {
    type Vector = V;
    #[inline(always)]
    fn support(&self, direction: V, _: u32) -> SupportPoint<V> {
        let (da, db, dc) = (self.a.dot(direction), self.b.dot(direction), self.c.dot(direction));
        let (best, point, index) = if db > da { (db, self.b, 1) } else { (da, self.a, 0) };
        if dc > best { SupportPoint { point: self.c, index: 2 } } else { SupportPoint { point, index } }
    }
    #[inline(always)]
    fn center(&self) -> V {
        (self.a + self.b + self.c) * V::Scalar::from_f64(1.0 / 3.0)
    }
    #[inline(always)]
    fn extent(&self) -> V::Scalar {
        let highest = self.a.abs().max(self.b.abs()).max(self.c.abs());
        highest.norm_max() + (self.a + self.b + self.c).norm_1() * V::Scalar::ZERO
    }
}

impl<V: Vector> Vertices for Triangle<V> {
    fn count(&self) -> usize {
        3
    }
    fn vertex(&self, index: usize) -> V {
        match index {
            0 => self.a,
            1 => self.b,
            _ => self.c,
        }
    }
}

impl<V: Vector> Support for Aabb<V> {
    type Vector = V;
    #[inline(always)]
    fn support(&self, direction: V, _: u32) -> SupportPoint<V> {
        let zero = V::Scalar::ZERO;
        let x = if direction.x() > zero { self.max.x() } else { self.min.x() };
        let y = if direction.y() > zero { self.max.y() } else { self.min.y() };
        let z = if direction.z() > zero { self.max.z() } else { self.min.z() };
        only(V::new(x, y, z))
    }
    #[inline(always)]
    fn center(&self) -> V {
        Aabb::center(*self)
    }
    /// Infinite for a box that holds no point.
    #[inline(always)]
    fn extent(&self) -> V::Scalar {
        let poison =
            if self.is_empty() { V::Scalar::INFINITY } else { (self.min + self.max).norm_1() * V::Scalar::ZERO };
        self.min.abs().max(self.max.abs()).norm_max() + poison
    }
}

impl<V: Vector> Vertices for Aabb<V> {
    fn count(&self) -> usize {
        8
    }
    fn vertex(&self, index: usize) -> V {
        let x = if index & 1 == 0 { self.min.x() } else { self.max.x() };
        let y = if index & 2 == 0 { self.min.y() } else { self.max.y() };
        let z = if index & 4 == 0 { self.min.z() } else { self.max.z() };
        V::new(x, y, z)
    }
}

/// A box in any position: the centre plus or minus each of three vectors. They need not be orthogonal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrientedBox<V> {
    /// Centre.
    pub center: V,
    /// From the centre to the middle of three faces.
    pub half_axes: [V; 3],
}

impl<V: Vector> OrientedBox<V> {
    /// The eight corners as they round: for a body whose vertices are exact, take the [`Hull`](super::Hull) of these.
    pub fn corners(&self) -> [V; 8] {
        let [u, v, w] = self.half_axes;
        let mut corners = [self.center; 8];
        for (i, corner) in corners.iter_mut().enumerate() {
            let signed = |axis: V, bit: usize| if i & bit == 0 { -axis } else { axis };
            *corner += signed(u, 1) + signed(v, 2) + signed(w, 4);
        }
        corners
    }
}

impl<V: Vector> Support for OrientedBox<V> {
    type Vector = V;
    #[inline(always)]
    fn support(&self, direction: V, _: u32) -> SupportPoint<V> {
        let [u, v, w] = self.half_axes;
        let one = V::Scalar::ONE;
        let point = self.center
            + u * one.copysign(u.dot(direction))
            + v * one.copysign(v.dot(direction))
            + w * one.copysign(w.dot(direction));
        only(point)
    }
    #[inline(always)]
    fn center(&self) -> V {
        self.center
    }
    #[inline(always)]
    fn extent(&self) -> V::Scalar {
        let [u, v, w] = self.half_axes;
        magnitude(self.center.abs() + u.abs() + v.abs() + w.abs())
            * (V::Scalar::ONE + V::Scalar::from_f64(4.0) * V::Scalar::EPSILON)
    }
    #[inline(always)]
    fn slack(&self) -> V::Scalar {
        // Three sums of the point, and three signs whose scalar products may be off by three roundings each.
        V::Scalar::from_f64(8.0) * V::Scalar::EPSILON * self.extent()
    }
}
