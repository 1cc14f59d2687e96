//! Bodies known by formula, in their place: all convex but tori.

use glam::DVec3;
use std::sync::Arc;
use voidage_core::convex::shape::{Capsule, Cone, Cylinder, Ellipsoid, Hull, Sphere};
use voidage_core::convex::support::{Support, Transformed};
use voidage_core::number::aabb::Aabb;
use voidage_core::solids::torus::{TorusShape, TorusSolid};

/// A body in its place, in metres.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum Form {
    /// A ball.
    Sphere(Sphere<DVec3>),
    /// An ellipsoid about the origin, turned and moved.
    Ellipsoid(Transformed<Ellipsoid<DVec3>>),
    /// A box along the axes.
    Box(Aabb<DVec3>),
    /// A cylinder with flat ends.
    Cylinder(Cylinder<DVec3>),
    /// A segment with a radius.
    Capsule(Capsule<DVec3>),
    /// A cone with a flat base, whole or truncated.
    Cone(Cone<DVec3>),
    /// A torus or a part of one, a pipe bend: not convex.
    Torus(TorusShape<DVec3>),
    /// The convex hull of its corners; boxes that are turned, too.
    Hull(Arc<[DVec3]>),
}

impl Form {
    /// Lowest and highest corner of a box around it; rounding has been added.
    #[must_use]
    pub fn bounds(&self) -> [DVec3; 2] {
        match self {
            Form::Sphere(s) => seen_from(s.center, &Sphere { center: DVec3::ZERO, ..*s }),
            Form::Ellipsoid(s) => around(s),
            Form::Box(s) => [s.min, s.max],
            Form::Cylinder(s) => {
                let (middle, [from, to]) = from_middle(s.ends());
                seen_from(middle, &Cylinder::new(from, to, s.base_radius()))
            }
            Form::Capsule(s) => {
                let (middle, [from, to]) = from_middle([s.from, s.to]);
                seen_from(middle, &Capsule { from, to, ..*s })
            }
            Form::Cone(s) => {
                let (middle, [from, to]) = from_middle(s.ends());
                seen_from(middle, &Cone::truncated(from, to, s.base_radius(), s.top_radius()))
            }
            Form::Torus(s) => {
                let room = DVec3::splat((s.radius + s.tube) * (1.0 + SUPPORT_ROUNDING));
                TorusSolid::new(s).map_or([s.center - room, s.center + room], |solid| {
                    [0, 1].map(|end| DVec3::from_array([0, 1, 2].map(|axis| solid.extent(axis)[end])))
                })
            }
            Form::Hull(corners) => around(&Hull::new(corners)),
        }
    }

    /// The same elsewhere.
    #[must_use]
    pub fn moved(&self, by: DVec3) -> Form {
        match self {
            Form::Sphere(s) => Form::Sphere(Sphere { center: s.center + by, ..*s }),
            Form::Ellipsoid(s) => Form::Ellipsoid(s.moved(by)),
            Form::Box(s) => Form::Box(Aabb { min: s.min + by, max: s.max + by }),
            Form::Cylinder(s) => {
                let [from, to] = s.ends().map(|end| end + by);
                Form::Cylinder(Cylinder::new(from, to, s.base_radius()))
            }
            Form::Capsule(s) => Form::Capsule(Capsule { from: s.from + by, to: s.to + by, ..*s }),
            Form::Cone(s) => {
                let [from, to] = s.ends().map(|end| end + by);
                Form::Cone(Cone::truncated(from, to, s.base_radius(), s.top_radius()))
            }
            Form::Torus(s) => Form::Torus(TorusShape { center: s.center + by, ..*s }),
            Form::Hull(corners) => Form::Hull(corners.iter().map(|p| *p + by).collect()),
        }
    }

    /// Bounded by planes: its triangles are the body itself, and the sums over its surface are exact.
    #[must_use]
    pub fn is_polytope(&self) -> bool {
        matches!(self, Form::Box(_) | Form::Hull(_))
    }
}

/// Roundings of [`Support::support`] that slack does not count, in ε of the extent.
const SUPPORT_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// The middle between two points, and the points as seen from there.
fn from_middle([from, to]: [DVec3; 2]) -> (DVec3, [DVec3; 2]) {
    let middle = from.midpoint(to);
    (middle, [from - middle, to - middle])
}

/// The box around a body that is given as seen from a place: far off, only the sums round by the size of coordinates.
fn seen_from(place: DVec3, body: &impl Support<Vector = DVec3>) -> [DVec3; 2] {
    let ([lo, hi], room) = (around(body), f64::EPSILON * place.abs());
    [place + lo - room, place + hi + room]
}

/// The box around a body, from its six outermost points.
fn around(body: &impl Support<Vector = DVec3>) -> [DVec3; 2] {
    let margin = if body.slack() > 0.0 || body.radius() > 0.0 {
        body.radius() + body.slack() + SUPPORT_ROUNDING * body.extent()
    } else {
        0.0
    };
    let reach = |sign: f64| {
        DVec3::from_array([DVec3::X, DVec3::Y, DVec3::Z].map(|axis| body.farthest(axis * sign).point.dot(axis)))
    };
    [reach(-1.0) - margin, reach(1.0) + margin]
}
