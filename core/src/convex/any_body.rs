//! Convex bodies of a kind known at run time, checked when they are made.

use crate::convex::containment::Contains;
use crate::convex::gjk::{Intersection, intersect};
use crate::convex::shape::{
    Capsule, Cone, Cylinder, Ellipsoid, Hull, OrientedBox, Point, Segment, Sphere, Triangle, Vertices,
};
use crate::convex::support::{ScalarOf, Support, SupportPoint, Transformed, delegate_support};
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};

/// A shape of any kind. Every kind converts into it: `AnyShape::from(sphere)`, or `sphere.into()`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum AnyShape<'a, V: Vector> {
    /// A single point.
    Point(Point<V>),
    /// A line segment.
    Segment(Segment<V>),
    /// A triangle.
    Triangle(Triangle<V>),
    /// A box along the coordinate axes.
    Aabb(Aabb<V>),
    /// A box in any position.
    OrientedBox(OrientedBox<V>),
    /// A ball.
    Sphere(Sphere<V>),
    /// A segment with a radius.
    Capsule(Capsule<V>),
    /// An ellipsoid.
    Ellipsoid(Ellipsoid<V>),
    /// A cylinder with flat ends.
    Cylinder(Cylinder<V>),
    /// A cone with a flat base, whole or truncated.
    Cone(Cone<V>),
    /// The hull of points in the caller's memory.
    Hull(Hull<'a, V>),
}

/// The same expression for the shape of any kind.
macro_rules! of_any_shape {
    ($body:expr, $shape:ident => $value:expr) => {
        match $body {
            AnyShape::Point($shape) => $value,
            AnyShape::Segment($shape) => $value,
            AnyShape::Triangle($shape) => $value,
            AnyShape::Aabb($shape) => $value,
            AnyShape::OrientedBox($shape) => $value,
            AnyShape::Sphere($shape) => $value,
            AnyShape::Capsule($shape) => $value,
            AnyShape::Ellipsoid($shape) => $value,
            AnyShape::Cylinder($shape) => $value,
            AnyShape::Cone($shape) => $value,
            AnyShape::Hull($shape) => $value,
        }
    };
}

macro_rules! any_shape_from {
    ($($kind:ident),*) => {$(
        impl<V: Vector> From<$kind<V>> for AnyShape<'_, V> {
            fn from(shape: $kind<V>) -> Self {
                AnyShape::$kind(shape)
            }
        }
    )*};
}
any_shape_from!(Point, Segment, Triangle, Aabb, OrientedBox, Sphere, Capsule, Ellipsoid, Cylinder, Cone);

impl<'a, V: Vector> From<Hull<'a, V>> for AnyShape<'a, V> {
    fn from(shape: Hull<'a, V>) -> Self {
        AnyShape::Hull(shape)
    }
}

impl<V: Vector> Support for AnyShape<'_, V> {
    type Vector = V;
    const ROUNDED: bool = true;
    fn support(&self, direction: V, start: u32) -> SupportPoint<V> {
        of_any_shape!(self, s => s.support(direction, start))
    }
    fn farther(&self, direction: V, found: u32) -> Option<SupportPoint<V>> {
        of_any_shape!(self, s => s.farther(direction, found))
    }
    fn center(&self) -> V {
        of_any_shape!(self, s => Support::center(s))
    }
    fn extent(&self) -> V::Scalar {
        of_any_shape!(self, s => s.extent())
    }
    fn radius(&self) -> V::Scalar {
        of_any_shape!(self, s => s.radius())
    }
    fn slack(&self) -> V::Scalar {
        of_any_shape!(self, s => s.slack())
    }
}

impl<'a, V: Vector> AnyShape<'a, V> {
    /// Why it is no body, if it is none.
    fn check(&self) -> Result<(), BodyError> {
        let zero = V::Scalar::ZERO;
        let least = match self {
            AnyShape::Sphere(Sphere { radius, .. }) | AnyShape::Capsule(Capsule { radius, .. }) => *radius,
            AnyShape::Cylinder(Cylinder(frame)) => frame.radius,
            AnyShape::Cone(cone) => cone.base_radius().min(cone.top_radius()),
            AnyShape::Ellipsoid(Ellipsoid { semi_axes, .. }) => semi_axes.x().min(semi_axes.y()).min(semi_axes.z()),
            _ => zero,
        };
        match self {
            AnyShape::Hull(hull) if hull.vertices().is_empty() => Err(BodyError::NoPoint),
            AnyShape::Aabb(cell) if cell.is_empty() => Err(BodyError::NoPoint),
            _ if least < zero => Err(BodyError::NegativeRadius),
            _ if !self.extent().is_finite() => Err(BodyError::NotFinite),
            _ => Ok(()),
        }
    }
}

/// Why something is no convex body that can be asked about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum BodyError {
    /// A number is NaN or infinite, or the body reaches beyond the largest number.
    NotFinite,
    /// A radius or a semi-axis is below zero.
    NegativeRadius,
    /// A hull of no points, or a box whose `min` exceeds its `max`.
    NoPoint,
    /// Three vectors whose scalar products with themselves are not 1, or with each other not 0, within 256 ε.
    NotARotation,
}

impl core::fmt::Display for BodyError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            BodyError::NotFinite => "a number is not finite, or too large to compute with",
            BodyError::NegativeRadius => "a radius or a semi-axis is negative",
            BodyError::NoPoint => "the body holds no point",
            BodyError::NotARotation => "the axes of a rotation are not orthonormal",
        })
    }
}

impl core::error::Error for BodyError {}

/// How far a rotation's scalar products may be from 0 and 1, in units of ε.
const ROTATION_ROUNDINGS: f64 = 256.0;

/// A convex body of a kind known at run time: a shape, perhaps turned and moved, perhaps thickened. What it is made of has been checked.
///
/// ```
/// use glam::DVec3;
/// use voidage_core::convex::{AnyBody, BodyError, shape::{Hull, Sphere}};
///
/// let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let quarter_turn = [DVec3::Y, -DVec3::X, DVec3::Z];
/// let body = AnyBody::new(Hull::new(&corners))?.posed(quarter_turn, DVec3::new(0.0, 0.0, 2.0))?.rounded(0.1)?;
/// # let _ = body;
/// assert_eq!(AnyBody::new(Sphere { center: DVec3::ZERO, radius: -1.0 }), Err(BodyError::NegativeRadius));
/// # Ok::<(), BodyError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnyBody<'a, V: Vector> {
    placed: Placed<'a, V>,
    /// By how much the shape is thickened.
    radius: V::Scalar,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Placed<'a, V: Vector> {
    AsGiven(AnyShape<'a, V>),
    Posed(Transformed<AnyShape<'a, V>>),
}

impl<'a, V: Vector> AnyBody<'a, V> {
    /// A shape as a body.
    ///
    /// # Errors
    /// [`BodyError`] if it is none.
    pub fn new(shape: impl Into<AnyShape<'a, V>>) -> Result<Self, BodyError> {
        let shape = shape.into();
        shape.check()?;
        Ok(AnyBody { placed: Placed::AsGiven(shape), radius: V::Scalar::ZERO })
    }

    /// The body turned about the origin, then moved. `rotation` holds the images of the three axes, orthonormal. A body that has been posed
    /// before is posed once more; its pose is then the product of both, rounded.
    ///
    /// # Errors
    /// [`BodyError::NotARotation`], and [`BodyError::NotFinite`] if the body would reach too far.
    pub fn posed(self, rotation: [V; 3], translation: V) -> Result<Self, BodyError> {
        let [x, y, z] = rotation;
        let near = V::Scalar::from_f64(ROTATION_ROUNDINGS) * V::Scalar::EPSILON;
        let products = [x.dot(x), y.dot(y), z.dot(z)].map(|sq| sq - V::Scalar::ONE);
        let off = products.into_iter().chain([x.dot(y), y.dot(z), z.dot(x)]);
        if !off.into_iter().all(|off| off.abs() <= near) {
            return Err(BodyError::NotARotation);
        }
        let one = V::splat(V::Scalar::ONE);
        let turned = |v: V| x * v.x() + y * v.y() + z * v.z();
        let posed = match self.placed {
            Placed::AsGiven(shape) => Transformed::new(shape, rotation, one, translation),
            Placed::Posed(before) => {
                let moved = turned(before.translation) + translation;
                Transformed::new(before.shape, before.columns.map(turned), one, moved)
            }
        };
        AnyBody { placed: Placed::Posed(posed), ..self }.checked()
    }

    /// All points within `radius` of the body.
    ///
    /// # Errors
    /// [`BodyError::NegativeRadius`], and [`BodyError::NotFinite`] if the body would reach too far.
    pub fn rounded(self, radius: V::Scalar) -> Result<Self, BodyError> {
        if radius < V::Scalar::ZERO {
            return Err(BodyError::NegativeRadius);
        }
        AnyBody { radius: self.radius + radius, ..self }.checked()
    }

    fn checked(self) -> Result<Self, BodyError> {
        if self.extent().is_finite() { Ok(self) } else { Err(BodyError::NotFinite) }
    }

    /// The body has no radius of its own: points of the core are all there is.
    pub(crate) fn is_sharp(&self) -> bool {
        self.radius() == V::Scalar::ZERO
    }

    /// The body by its vertices, if it is given by them exactly: neither posed nor thickened, and of a kind that has vertices.
    pub fn as_vertices(&self) -> Option<impl Vertices<Vector = V> + use<'_, 'a, V>> {
        let sharp = SharpBody(self);
        (sharp.count() > 0).then_some(sharp)
    }
}

impl<V: Vector> Support for AnyBody<'_, V> {
    type Vector = V;
    const ROUNDED: bool = true;
    fn support(&self, direction: V, start: u32) -> SupportPoint<V> {
        match &self.placed {
            Placed::AsGiven(shape) => shape.support(direction, start),
            Placed::Posed(shape) => shape.support(direction, start),
        }
    }
    fn farther(&self, direction: V, found: u32) -> Option<SupportPoint<V>> {
        match &self.placed {
            Placed::AsGiven(shape) => shape.farther(direction, found),
            Placed::Posed(shape) => shape.farther(direction, found),
        }
    }
    fn center(&self) -> V {
        match &self.placed {
            Placed::AsGiven(shape) => shape.center(),
            Placed::Posed(shape) => shape.center(),
        }
    }
    fn extent(&self) -> ScalarOf<Self> {
        let extent = match &self.placed {
            Placed::AsGiven(shape) => shape.extent(),
            Placed::Posed(shape) => shape.extent(),
        };
        (extent + self.radius) * (V::Scalar::ONE + V::Scalar::EPSILON)
    }
    fn radius(&self) -> ScalarOf<Self> {
        self.radius
            + match &self.placed {
                Placed::AsGiven(shape) => shape.radius(),
                Placed::Posed(shape) => shape.radius(),
            }
    }
    fn slack(&self) -> ScalarOf<Self> {
        match &self.placed {
            Placed::AsGiven(shape) => shape.slack(),
            Placed::Posed(shape) => shape.slack(),
        }
    }
}

/// Whether a point, the first body of a query, is in the second.
fn told<V: Vector>(found: Intersection<V>) -> Option<bool> {
    match found {
        Intersection::Apart { .. } => Some(false),
        Intersection::Overlapping { .. } => Some(true),
        Intersection::Undecided { .. } => None,
    }
}

impl<V: Vector> Contains for AnyBody<'_, V> {
    fn holds(&self, point: V) -> Option<bool> {
        match &self.placed {
            Placed::AsGiven(AnyShape::Aabb(cell)) if self.is_sharp() => cell.holds(point),
            Placed::AsGiven(AnyShape::Sphere(ball)) if self.radius == V::Scalar::ZERO => ball.holds(point),
            _ if self.is_sharp() => told(intersect(&Point(point), &SharpBody(self), None)),
            _ => told(intersect(&Point(point), self, None)),
        }
    }
}

/// A body without a radius, so that the search for sharp bodies applies; and by its vertices, of which there are none if it is not given by
/// them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SharpBody<'b, 'a, V: Vector>(pub &'b AnyBody<'a, V>);

impl<V: Vector> Support for SharpBody<'_, '_, V> {
    delegate_support!(self, V => self.0);
}

impl<V: Vector> Vertices for SharpBody<'_, '_, V> {
    fn count(&self) -> usize {
        let Placed::AsGiven(shape) = &self.0.placed else { return 0 };
        match shape {
            _ if !self.0.is_sharp() => 0,
            AnyShape::Point(s) => s.count(),
            AnyShape::Segment(s) => s.count(),
            AnyShape::Triangle(s) => s.count(),
            AnyShape::Aabb(s) => s.count(),
            AnyShape::Hull(s) => s.count(),
            _ => 0,
        }
    }
    fn vertex(&self, index: usize) -> V {
        match &self.0.placed {
            Placed::AsGiven(AnyShape::Point(s)) => s.vertex(index),
            Placed::AsGiven(AnyShape::Segment(s)) => s.vertex(index),
            Placed::AsGiven(AnyShape::Triangle(s)) => s.vertex(index),
            Placed::AsGiven(AnyShape::Aabb(s)) => s.vertex(index),
            Placed::AsGiven(AnyShape::Hull(s)) => s.vertex(index),
            _ => V::ZERO,
        }
    }
}
