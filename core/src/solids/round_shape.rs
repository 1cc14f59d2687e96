//! A shape of a round kind that is known at run time.

use crate::convex::shape::{Capsule, Cone, Cylinder, Ellipsoid, Sphere};
use crate::convex::support::{Support, SupportPoint, Transformed};
use crate::grid::bounds::Bounds;
use crate::number::aabb::Aabb;
use crate::number::real::Vector;
use crate::solids::quadric::{AsQuadric, QuadricSolid};
use crate::subdivide::{ActiveFacets, Columns, LocalPlanes, Occupancy, QueryCount, Subdividable, WarmStart};

/// A convex shape that has a formula.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum RoundShape<V: Vector> {
    /// A ball.
    Sphere(Sphere<V>),
    /// An ellipsoid, turned and moved.
    Ellipsoid(Transformed<Ellipsoid<V>>),
    /// A segment with a radius.
    Capsule(Capsule<V>),
    /// A cylinder with flat ends.
    Cylinder(Cylinder<V>),
    /// A cone with a flat base, whole or truncated.
    Cone(Cone<V>),
}

impl<V: Vector> Default for RoundShape<V> {
    /// A ball of no size, which serves as memory.
    fn default() -> Self {
        RoundShape::Sphere(Sphere { center: V::ZERO, radius: V::ZERO.x() })
    }
}

/// The same expression for the shape of each kind.
macro_rules! of_round_shape {
    ($body:expr, $shape:ident => $value:expr) => {
        match $body {
            RoundShape::Sphere($shape) => $value,
            RoundShape::Ellipsoid($shape) => $value,
            RoundShape::Capsule($shape) => $value,
            RoundShape::Cylinder($shape) => $value,
            RoundShape::Cone($shape) => $value,
        }
    };
}

impl<V: Vector> AsQuadric for RoundShape<V> {
    fn quadric(&self) -> Option<QuadricSolid> {
        of_round_shape!(self, s => s.quadric())
    }
}

impl<V: Vector> Support for RoundShape<V> {
    type Vector = V;
    const ROUNDED: bool = true;
    fn support(&self, direction: V, start: u32) -> SupportPoint<V> {
        of_round_shape!(self, s => s.support(direction, start))
    }
    fn center(&self) -> V {
        of_round_shape!(self, s => Support::center(s))
    }
    fn extent(&self) -> V::Scalar {
        of_round_shape!(self, s => s.extent())
    }
    fn radius(&self) -> V::Scalar {
        of_round_shape!(self, s => Support::radius(s))
    }
    fn slack(&self) -> V::Scalar {
        of_round_shape!(self, s => s.slack())
    }
}

impl<V: Vector> Subdividable for RoundShape<V> {
    type Vector = V;
    fn bounds(&self) -> Aabb<V> {
        of_round_shape!(self, s => Subdividable::bounds(s))
    }
    fn facet_count(&self) -> usize {
        of_round_shape!(self, s => Subdividable::facet_count(s))
    }
    fn occupancy(
        &self,
        cell: &Aabb<V>,
        near: &[u32],
        active: &mut ActiveFacets,
        warm: &mut WarmStart<V>,
        count: &mut QueryCount,
    ) -> Occupancy {
        of_round_shape!(self, s => s.occupancy(cell, near, active, warm, count))
    }
    fn local_planes(&self, cell: &Aabb<V>, near: &[u32]) -> Option<LocalPlanes<V::Scalar>> {
        of_round_shape!(self, s => s.local_planes(cell, near))
    }
    fn share_bounds(&self, cell: &Aabb<V>, near: &[u32], columns: &Columns<V::Scalar>) -> Bounds<V::Scalar> {
        of_round_shape!(self, s => s.share_bounds(cell, near, columns))
    }
}
