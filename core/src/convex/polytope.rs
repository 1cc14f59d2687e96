//! A convex polytope: a hull that knows its facets.
//!
//! The facets are certified when it is made: no vertex lies beyond a facet's plane, and every triangle of the surface lies in its facet's
//! plane, both within [`chord_rounding`]. So the body is the intersection of the facets' inner sides, within the same.
//!
//! In a box that holds an inner point of the body, only facets whose surface reaches the box matter: from that point a segment to a point
//! beyond another facet's plane, which stays in the box, leaves the body through one of them.

use crate::convex::chord::{Chord, Chords, FacetPlane, chord_rounding, through_facets};
use crate::convex::exact::{Contact, contact};
use crate::convex::shape::Hull;
use crate::convex::support::{Support, delegate_support};
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};

/// A plane, and a box around the triangles that lie in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet<V: Vector> {
    /// Its plane.
    pub plane: FacetPlane<V>,
    /// Around the surface in it.
    pub bounds: Aabb<V>,
}

impl<V: Vector> Facet<V> {
    /// A plane that nothing lies beyond, and an empty box: to fill memory.
    pub fn none() -> Self {
        let plane = FacetPlane { normal: V::ZERO, offset: V::Scalar::INFINITY, exact: false };
        Facet { plane, bounds: Aabb::empty() }
    }

    fn join(&mut self, corners: &[V; 3]) {
        self.bounds = self.bounds.union(Aabb::around(corners));
    }
}

/// A convex body by vertices and facets, both in the caller's memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polytope<'a, V: Vector> {
    hull: Hull<'a, V>,
    facets: &'a [Facet<V>],
    bounds: Aabb<V>,
}

/// Why some triangles are not the surface of a convex body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum NotConvex {
    /// No triangles, no volume, or a coordinate is not finite.
    NoBody,
    /// The slice for the facets is too short.
    Full,
    /// A vertex lies beyond the plane of a triangle.
    Beyond {
        /// The triangle.
        triangle: usize,
    },
    /// A triangle is too thin for its corners to give its plane, and lies in none of the other planes.
    Unknown {
        /// The triangle.
        triangle: usize,
    },
}

impl core::fmt::Display for NotConvex {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            NotConvex::NoBody => f.write_str("no body: no triangles, no volume, or a coordinate that is not finite"),
            NotConvex::Full => f.write_str("the slice for the facets is too short"),
            NotConvex::Beyond { triangle } => write!(f, "a vertex lies beyond the plane of triangle {triangle}"),
            NotConvex::Unknown { triangle } => {
                write!(f, "triangle {triangle} is too thin for a plane of its own, and lies in no plane of the others")
            }
        }
    }
}

impl core::error::Error for NotConvex {}

/// Finds the planes of a closed surface's triangles, outward, and certifies that the body is convex. Writes the facets into the slice and
/// returns their number, not more than that of the triangles. `vertices` holds all corners, each at least once. Takes time in proportion to
/// vertices times facets.
///
/// # Errors
/// [`NotConvex`] tells the first triangle that contradicts.
pub fn facets<V: Vector>(vertices: &[V], triangles: &[[V; 3]], into: &mut [Facet<V>]) -> Result<usize, NotConvex> {
    let hull = Hull::new(vertices);
    // A quarter of `chord_rounding`: the subdivision needs the other three when it tests points against these planes.
    let tolerance = chord_rounding(&hull) * V::Scalar::from_f64(0.25);
    if triangles.is_empty() || !tolerance.is_finite() {
        return Err(NotConvex::NoBody);
    }
    let lies_in = |plane: &FacetPlane<V>, corners: &[V; 3]| {
        let limit = if plane.exact { V::Scalar::ZERO } else { tolerance };
        corners.iter().all(|c| (c.dot(plane.normal) - plane.offset).abs() <= limit)
    };
    let mut count = 0_usize;
    // First the triangles whose own corners give their plane accurately; then the thin ones, which must lie in one of these planes.
    for (triangle, corners) in triangles.iter().enumerate() {
        let [a, b, c] = *corners;
        let normal = (b - a).cross(c - a);
        if normal == V::ZERO {
            continue;
        }
        let recent = into.get_mut(count.saturating_sub(4)..count).unwrap_or(&mut []);
        if let Some(facet) = recent.iter_mut().find(|f| lies_in(&f.plane, corners)) {
            facet.join(corners);
            continue;
        }
        let plane = FacetPlane::new(normal, a);
        let highest = hull.support(plane.normal, 0).point.dot(plane.normal);
        let plane = FacetPlane { offset: highest, ..plane };
        if lies_in(&plane, corners) {
            *into.get_mut(count).ok_or(NotConvex::Full)? = Facet { plane, bounds: Aabb::around(corners) };
            count += 1;
        } else if lies_in(&FacetPlane::new(normal, a), corners) {
            return Err(NotConvex::Beyond { triangle });
        }
    }
    let known = into.get_mut(..count).unwrap_or(&mut []);
    for (triangle, corners) in triangles.iter().enumerate() {
        let [a, b, c] = *corners;
        let normal = (b - a).cross(c - a);
        if normal == V::ZERO || !lies_in(&FacetPlane::new(normal, a), corners) {
            let facet = known.iter_mut().find(|f| lies_in(&f.plane, corners));
            facet.ok_or(NotConvex::Unknown { triangle })?.join(corners);
        }
    }
    if deep_inside(&hull, known, tolerance) { Ok(count) } else { Err(NotConvex::NoBody) }
}

/// Whether the mean of the vertices lies inside all facets by 16 times the tolerance. Then whatever lies inside all facets by more than the
/// tolerance is inside the surface.
fn deep_inside<V: Vector>(hull: &Hull<V>, facets: &[Facet<V>], tolerance: V::Scalar) -> bool {
    let count = V::Scalar::from_usize(hull.vertices().len());
    let mean = hull.vertices().iter().fold(V::ZERO, |sum, &v| sum + v) * (V::Scalar::ONE / count);
    facets.iter().all(|f| mean.dot(f.plane.normal) - f.plane.offset < -(tolerance * V::Scalar::from_f64(16.0)))
}

impl<'a, V: Vector> Polytope<'a, V> {
    /// A hull and its facets, as [`facets`] found them.
    pub fn new(hull: Hull<'a, V>, facets: &'a [Facet<V>]) -> Self {
        Polytope { hull, facets, bounds: Aabb::around(hull.vertices()) }
    }
}

impl<V: Vector> Support for Polytope<'_, V> {
    delegate_support!(self, V => self.hull);
}

impl<V: Vector> Chords for Polytope<'_, V> {
    fn facet_count(&self) -> usize {
        self.facets.len()
    }
    #[inline(always)]
    fn facet(&self, index: usize) -> FacetPlane<V> {
        self.facets.get(index).map_or(Facet::none().plane, |f| f.plane)
    }
    #[inline(always)]
    fn facet_bounds(&self, index: usize) -> Option<Aabb<V>> {
        self.facets.get(index).map(|f| f.bounds)
    }
    fn is_polytope(&self) -> bool {
        true
    }
    #[inline(always)]
    fn chord(&self, origin: V, direction: V, grow: V::Scalar, near: &[u32]) -> Option<Chord<V>> {
        through_facets(self, origin, direction, grow, near)
    }
    #[inline(always)]
    fn misses(&self, cell: &Aabb<V>) -> bool {
        !self.bounds.touches(*cell)
    }
    fn bounds(&self) -> Aabb<V> {
        self.bounds
    }
    fn exact_contact(&self, cell: &Aabb<V>) -> Option<Contact> {
        contact(cell, &self.hull, None).ok()
    }
}
