//! How a cell, or a face, lies to a convex body: open, cut or closed, with proof.
//!
//! A face is a box without thickness. A point of a face is blocked if it is a limit of solid from either side; of one convex body that
//! is the area of its section with the face's plane, boundary included.

use super::chord_bounds::Columns;
use super::local_planes::{LocalPlanes, MAX_PLANES, PlaneDistances};
use super::occupancy::{ActiveFacets, Occupancy, QueryCount, WarmStart};
use crate::convex::chord::{Chords, chord_rounding, length, rounding_at};
use crate::convex::exact::Contact;
use crate::convex::gjk::{Intersection, intersect};
use crate::convex::support::{ScalarOf, Support};
use crate::grid::bounds::Bounds;
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};

/// The scalar of a body.
pub type BodyScalar<B> = <<B as Subdividable>::Vector as Vector>::Scalar;

/// A body whose share of a box can be found by dividing the box.
pub trait Subdividable {
    /// The vectors of the space.
    type Vector: Vector;

    /// A box around the body.
    fn bounds(&self) -> Aabb<Self::Vector>;

    /// How many facets the body has; they are numbered from 0.
    fn facet_count(&self) -> usize;

    /// How the box `cell` lies to the body. `near` lists the facets that cut some box around `cell`; those of them that cut `cell` are pushed
    /// onto `active`, which comes empty. `warm` is what the query for the box around, or for a neighbour in it, has left there; what this
    /// query finds replaces it. Queries of GJK are added to `count`.
    fn occupancy(
        &self,
        cell: &Aabb<Self::Vector>,
        near: &[u32],
        active: &mut ActiveFacets,
        warm: &mut WarmStart<Self::Vector>,
        count: &mut QueryCount,
    ) -> Occupancy;

    /// The planes of the facets `near`, relative to `cell`. None unless the body is a polytope, the
    /// facets are at most [`MAX_PLANES`] and none of their planes is exact.
    fn local_planes(&self, cell: &Aabb<Self::Vector>, near: &[u32]) -> Option<LocalPlanes<BodyScalar<Self>>>;

    /// Bounds of the share of `cell` that is solid. `near` lists the facets that cut it, as [`Subdividable::occupancy`] found them.
    fn share_bounds(
        &self,
        cell: &Aabb<Self::Vector>,
        near: &[u32],
        columns: &Columns<BodyScalar<Self>>,
    ) -> Bounds<BodyScalar<Self>>;
}

/// Bound of the rounding of a distance between a point of `cell` and a plane of `body`.
#[inline(always)]
fn margin_of<B: Chords>(body: &B, cell: &Aabb<B::Vector>) -> ScalarOf<B> {
    let far = cell.min.abs().max(cell.max.abs()).norm_max();
    (chord_rounding(body) + rounding_at(far)) * Real::HALF
}

impl<B: Chords> Subdividable for B {
    type Vector = B::Vector;

    fn bounds(&self) -> Aabb<B::Vector> {
        Chords::bounds(self)
    }

    fn facet_count(&self) -> usize {
        Chords::facet_count(self)
    }

    #[inline]
    fn occupancy(
        &self,
        cell: &Aabb<B::Vector>,
        near: &[u32],
        active: &mut ActiveFacets,
        warm: &mut WarmStart<B::Vector>,
        count: &mut QueryCount,
    ) -> Occupancy {
        if self.misses(cell) {
            return Occupancy::Open;
        }
        let margin = margin_of(self, cell);
        for &id in near {
            let plane = self.facet(id as usize);
            let [low, high] = plane.range(cell);
            let margin = if plane.exact { Real::ZERO } else { margin };
            // A face that lies in the facet's plane has low = high = 0 and is blocked: `low >= margin` alone must not open it.
            if low >= margin && high > margin {
                return Occupancy::Open;
            }
            if !(high <= -margin) {
                active.push(id);
            }
        }
        if self.is_polytope() {
            match active.count() {
                0 => return Occupancy::Closed,
                1 => return Occupancy::Cut,
                _ if holds_inner_point(self, cell, active.items(), margin) => {
                    let twice = B::Vector::splat(margin + margin);
                    let around = Aabb { min: cell.min - twice, max: cell.max + twice };
                    active.retain(|id| self.facet_bounds(id as usize).is_none_or(|b| b.touches(around)));
                    return if active.count() == 0 { Occupancy::Closed } else { Occupancy::Cut };
                }
                _ => {}
            }
        } else if let Some(found) = by_signed_distance(self, cell, margin, &mut warm.vector) {
            return found;
        }
        ask(self, cell, &mut warm.vector, count)
    }

    fn local_planes(&self, cell: &Aabb<B::Vector>, near: &[u32]) -> Option<LocalPlanes<ScalarOf<B>>> {
        if !self.is_polytope() || near.len() > MAX_PLANES {
            return None;
        }
        let zero: ScalarOf<B> = Real::ZERO;
        let margin = margin_of(self, cell);
        let distances = PlaneDistances { middle: [zero; MAX_PLANES], cut: 0 };
        let mut planes = LocalPlanes { reach: [[zero; 3]; MAX_PLANES], whole: [zero; MAX_PLANES], margin, distances };
        for (n, &id) in near.iter().enumerate().take(MAX_PLANES) {
            let plane = self.facet(id as usize);
            // Whether a face lies in an exact plane must be seen exactly.
            if plane.exact {
                return None;
            }
            let ([nx, ny, nz], [sx, sy, sz]) = (plane.normal.to_array(), cell.size().to_array());
            planes.reach[n] = [nx * sx * Real::HALF, ny * sy * Real::HALF, nz * sz * Real::HALF];
            planes.whole[n] = plane.normal.abs().dot(cell.size()) * Real::HALF;
            planes.distances.middle[n] = cell.center().dot(plane.normal) - plane.offset;
            planes.distances.cut |= 1 << n;
        }
        Some(planes)
    }

    #[inline]
    fn share_bounds(
        &self,
        cell: &Aabb<B::Vector>,
        near: &[u32],
        columns: &Columns<ScalarOf<B>>,
    ) -> Bounds<ScalarOf<B>> {
        columns.share_bounds(self, cell, near)
    }
}

/// How a box lies to a body by GJK, from `axis` as warm start; a separating direction is left there. Whether a body that is no polytope holds
/// the whole box is told by its chords.
#[inline(never)]
fn ask<B: Chords>(body: &B, cell: &Aabb<B::Vector>, axis: &mut B::Vector, count: &mut QueryCount) -> Occupancy {
    count.queries += 1;
    match intersect(cell, body, Some(*axis)) {
        Intersection::Apart { axis: found } => {
            *axis = found;
            return Occupancy::Open;
        }
        Intersection::Undecided { .. } => {
            let flat = cell.size().to_array().contains(&Real::ZERO);
            if !flat && matches!(body.exact_contact(cell), Some(Contact::Disjoint | Contact::Touching)) {
                return Occupancy::Open;
            }
            count.undecided += 1;
        }
        Intersection::Overlapping { .. } => {}
    }
    if !body.is_polytope() && edges_are_inside(body, cell) { Occupancy::Closed } else { Occupancy::Cut }
}

/// Box and body share an inner point: a point of the box lies inward of all facets in `near` by more than `margin`. Two points are tried: that
/// nearest to the body's centre, and the corner farthest against the sum of the facets' normals. False tells nothing.
#[inline(always)]
fn holds_inner_point<B: Chords>(body: &B, cell: &Aabb<B::Vector>, near: &[u32], margin: ScalarOf<B>) -> bool {
    let is_inside = |point: B::Vector| {
        near.iter().all(|&id| {
            let plane = body.facet(id as usize);
            point.dot(plane.normal) - plane.offset < -margin
        })
    };
    if near.is_empty() {
        return false;
    }
    is_inside(body.center().max(cell.min).min(cell.max)) || {
        let outward = near.iter().fold(B::Vector::ZERO, |sum, &id| sum + body.facet(id as usize).normal);
        is_inside(Support::support(cell, -outward, 0).point)
    }
}

/// Occupancy of a box by the distance of its middle from the surface: open or closed if half its diagonal is shorter; cut if the middle is
/// inside and the box not closed, or if it holds the body's point nearest to its middle. Else none; `axis` then points from the middle to
/// that point, if the body knows it.
#[inline(always)]
fn by_signed_distance<B: Chords>(
    body: &B,
    cell: &Aabb<B::Vector>,
    margin: ScalarOf<B>,
    axis: &mut B::Vector,
) -> Option<Occupancy> {
    let (half, middle) = (cell.size() * Real::HALF, cell.center());
    let [low, high] = body.signed_distance(middle);
    let reach = length(half) + margin;
    if low >= reach {
        return Some(Occupancy::Open);
    }
    if high < -margin {
        // The middle is an inner point.
        let closed = high <= -reach || edges_are_inside(body, cell);
        return Some(if closed { Occupancy::Closed } else { Occupancy::Cut });
    }
    let to = body.nearest(middle).filter(|_| low > margin)? - middle;
    let inner = half - B::Vector::splat(margin + margin);
    if to.abs().max(inner) == inner {
        return Some(Occupancy::Cut);
    }
    *axis = to;
    None
}

/// The four edges of a box along one axis, and so all of it, are inside the body. The axis is x, or y for a face normal to x.
#[inline(always)]
fn edges_are_inside<B: Chords>(body: &B, cell: &Aabb<B::Vector>) -> bool {
    let (zero, one) = (ScalarOf::<B>::ZERO, ScalarOf::<B>::ONE);
    let along_y = cell.size().x() == zero;
    // Components along the edges first, then across them; and back.
    let turned = |v: B::Vector| {
        let [x, y, z] = v.to_array();
        if along_y { [y, z, x] } else { [x, y, z] }
    };
    let back = |[along, u, v]: [ScalarOf<B>; 3]| {
        if along_y { B::Vector::new(v, along, u) } else { B::Vector::new(along, u, v) }
    };
    let ([first, u_lo, v_lo], [last, u_hi, v_hi]) = (turned(cell.min), turned(cell.max));
    let [_, u_center, v_center] = turned(body.center());
    let shrink = -chord_rounding(body);
    // The far corner is the likeliest to be outside.
    let far = |lo: ScalarOf<B>, hi: ScalarOf<B>, center: ScalarOf<B>| {
        if hi + lo > center + center { [hi, lo] } else { [lo, hi] }
    };
    let ([u_far, u_near], [v_far, v_near]) = (far(u_lo, u_hi, u_center), far(v_lo, v_hi, v_center));
    [(u_far, v_far), (u_far, v_near), (u_near, v_far), (u_near, v_near)].into_iter().all(|(u, v)| {
        body.chord(back([zero, u, v]), back([one, zero, zero]), shrink, &[])
            .is_some_and(|[t0, t1]| t0 <= first && t1 >= last)
    })
}
