//! Bodies as GJK and subdivision see them.
//!
//! Bodies known by formula, those of triangles that are certified to be convex, and, by the paper's leaves, other closed surfaces triangle
//! by triangle.

use crate::geometry::bodies::Body;
use crate::geometry::form::Form;
use crate::geometry::repair::weld::bits;
use glam::DVec3;
use rustc_hash::FxHashMap as HashMap;
use std::ops;
use voidage_core::convex::polytope::{Facet, Polytope, facets};
use voidage_core::convex::shape::{Capsule, Cone, Cylinder, Ellipsoid, Hull, Sphere};
use voidage_core::convex::support::Transformed;
use voidage_core::number::aabb::Aabb;
use voidage_core::subdivide::{
    ActiveFacets, Bounds, ClosedSurface, Columns, LocalPlanes, Occupancy, QueryCount, Subdividable, WarmStart,
};

/// A body in its place, convex but for the last kind.
#[derive(Debug, Clone, Copy)]
pub enum Convex<'a> {
    /// A ball.
    Sphere(Sphere<DVec3>),
    /// An ellipsoid, turned and moved.
    Ellipsoid(Transformed<Ellipsoid<DVec3>>),
    /// A cylinder with flat ends.
    Cylinder(Cylinder<DVec3>),
    /// A segment with a radius.
    Capsule(Capsule<DVec3>),
    /// A cone with a flat base, whole or truncated.
    Cone(Cone<DVec3>),
    /// A hull and its facets.
    Polytope(Polytope<'a, DVec3>),
    /// A closed surface.
    Mesh(ClosedSurface<'a, DVec3>),
}

/// The same expression for the shape of any kind.
macro_rules! of_shape {
    ($body:expr, $shape:ident => $value:expr) => {
        match $body {
            Convex::Sphere($shape) => $value,
            Convex::Ellipsoid($shape) => $value,
            Convex::Cylinder($shape) => $value,
            Convex::Capsule($shape) => $value,
            Convex::Cone($shape) => $value,
            Convex::Polytope($shape) => $value,
            Convex::Mesh($shape) => $value,
        }
    };
}

impl Subdividable for Convex<'_> {
    type Vector = DVec3;
    fn bounds(&self) -> Aabb<DVec3> {
        of_shape!(self, s => Subdividable::bounds(s))
    }
    fn facet_count(&self) -> usize {
        of_shape!(self, s => Subdividable::facet_count(s))
    }
    fn occupancy(
        &self,
        cell: &Aabb<DVec3>,
        near: &[u32],
        active: &mut ActiveFacets,
        warm: &mut WarmStart<DVec3>,
        count: &mut QueryCount,
    ) -> Occupancy {
        of_shape!(self, s => s.occupancy(cell, near, active, warm, count))
    }
    fn local_planes(&self, cell: &Aabb<DVec3>, near: &[u32]) -> Option<LocalPlanes<f64>> {
        of_shape!(self, s => s.local_planes(cell, near))
    }
    fn share_bounds(&self, cell: &Aabb<DVec3>, near: &[u32], columns: &Columns<f64>) -> Bounds<f64> {
        of_shape!(self, s => s.share_bounds(cell, near, columns))
    }
}

/// Vertices and facets of bodies made of triangles.
#[derive(Debug, Default)]
pub struct Faceted {
    vertices: Vec<DVec3>,
    facets: Vec<Facet<DVec3>>,
}

/// What a body is known as, with the memory that it takes.
#[derive(Debug)]
pub enum Known {
    /// By formula.
    Round(Convex<'static>),
    /// By facets.
    Faceted(Faceted),
    /// A run of triangles.
    Closed(ops::Range<usize>),
}

/// Bodies with more triangles than this stay with their surface: the certificate takes time in proportion to the square.
const MOST_FACETS: usize = 20_000;

impl Known {
    /// The body; `triangles` are those of all bodies.
    #[must_use]
    pub fn body<'a>(&'a self, triangles: &'a [[DVec3; 3]]) -> Convex<'a> {
        match self {
            Known::Round(body) => *body,
            Known::Closed(run) => Convex::Mesh(ClosedSurface::new(&triangles[run.clone()])),
            Known::Faceted(f) => Convex::Polytope(Polytope::new(Hull::new(&f.vertices), &f.facets)),
        }
    }
}

/// A convex body without triangles; none if it is not convex, or should have some.
#[must_use]
pub fn round(form: &Form) -> Option<Convex<'static>> {
    Some(match form {
        Form::Sphere(s) => Convex::Sphere(*s),
        Form::Ellipsoid(s) => Convex::Ellipsoid(*s),
        Form::Cylinder(s) => Convex::Cylinder(*s),
        Form::Capsule(s) => Convex::Capsule(*s),
        Form::Cone(s) => Convex::Cone(*s),
        Form::Torus(_) | Form::Box(_) | Form::Hull(_) => return None,
    })
}

/// The body as a polytope, if it is certified to be one.
#[must_use]
pub fn faceted(body: &Body, triangles: &[[DVec3; 3]]) -> Option<Faceted> {
    if body.sheet || body.cavities > 0 || triangles.len() > MOST_FACETS {
        return None;
    }
    let mut seen = HashMap::default();
    let mut vertices = Vec::new();
    for &p in triangles.iter().flatten() {
        seen.entry(bits(p)).or_insert_with(|| vertices.push(p));
    }
    let mut planes = vec![Facet::none(); triangles.len()];
    let count = facets(&vertices, triangles, &mut planes).ok()?;
    planes.truncate(count);
    Some(Faceted { vertices, facets: planes })
}

/// Has every edge its reverse?
#[must_use]
pub fn is_closed(triangles: &[[DVec3; 3]]) -> bool {
    let mut open = HashMap::default();
    for [a, b, c] in triangles.iter().map(|t| t.map(bits)) {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *open.entry((from.min(to), from.max(to))).or_insert(0_i64) += if from < to { 1 } else { -1 };
        }
    }
    open.values().all(|&count| count == 0)
}
