//! A body bounded by a closed surface of triangles, convex or not, as the subdivision sees it.
//!
//! A box is cut if a triangle meets it ([`box_triangle`]). A box that no triangle meets is inside or outside as a whole, and the winding number
//! of the surface around any of its points tells which. A box hands its parts such a point and number as warm start; the segment from there to
//! a point of a part stays in the box, so only triangles that cut the box can cross it, and each crossing changes the number by one. The signs
//! of every crossing are certified. Where one is in doubt another point is tried, and if all are, the part counts as cut. So on a surface
//! that closes edge by edge no number is wrong.
//!
//! Reference: D. Sunday, "Inclusion of a point in a polygon", 2001, for winding numbers; here along segments in space.

use super::chord_bounds::Columns;
use super::local_planes::LocalPlanes;
use super::occupancy::{ActiveFacets, Occupancy, QueryCount, WarmStart};
use super::place::Subdividable;
use crate::convex::chord::rounding_at;
use crate::convex::sat::{BoxTriangle, box_triangle};
use crate::convex::shape::Triangle;
use crate::grid::bounds::Bounds;
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};

/// A closed surface in the caller's memory. Triangles are counter-clockwise seen from outside, and every edge has its reverse. If all boxes
/// lie between two planes normal to y or z, the triangles between these planes, moved apart by [`slab_margin`] each, are enough: windings are
/// counted along x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosedSurface<'a, V: Vector> {
    triangles: &'a [[V; 3]],
    bounds: Aabb<V>,
}

impl<'a, V: Vector> ClosedSurface<'a, V> {
    /// The surface made of these triangles, whose corners are finite.
    pub fn new(triangles: &'a [[V; 3]]) -> Self {
        ClosedSurface { triangles, bounds: Aabb::around(triangles.as_flattened()) }
    }

    /// The triangles it was made of.
    pub fn triangles(&self) -> &'a [[V; 3]] {
        self.triangles
    }

    /// A point of a box and the winding number of the surface there. `near` lists the triangles that cut the box around, in which the point
    /// of `warm` lies. None if every point tried is in doubt.
    fn winding(&self, cell: &Aabb<V>, near: &[u32], warm: &WarmStart<V>) -> Option<(V, i32)> {
        let size = cell.size();
        let inside = |[x, y, z]: [f64; 3]| {
            let [x, y, z] = [x, y, z].map(V::Scalar::from_f64);
            cell.min + V::new(size.x() * x, size.y() * y, size.z() * z)
        };
        for fractions in POINTS {
            let to = inside(fractions);
            let added = match warm.winding {
                Some(winding) => self.crossings(warm.vector, to, near.iter().copied()).map(|n| winding + n),
                None => {
                    // Nothing is wound around a point beyond the surface; such a line stays in the slab of the box.
                    let mut from = to.to_array();
                    from[0] = self.bounds.max.x() + (self.bounds.size().x() + size.x());
                    self.crossings(V::from_array(from), to, 0..self.triangles.len() as u32)
                }
            };
            if let Some(winding) = added {
                return Some((to, winding));
            }
        }
        None
    }

    /// How often the segment `from`–`to` enters the body through some triangles, less how often it leaves; none in doubt.
    fn crossings(&self, from: V, to: V, mut ids: impl Iterator<Item = u32>) -> Option<i32> {
        ids.try_fold(0, |sum, id| {
            Some(sum + self.triangles.get(id as usize).map_or(Some(0), |t| crossing(from, to, t))?)
        })
    }
}

/// Points of a box for its winding number, as fractions of its size: odd ones, so that no edge of a usual mesh passes through them.
const POINTS: [[f64; 3]; 4] =
    [[0.4813, 0.5437, 0.4591], [0.3127, 0.6211, 0.5739], [0.6893, 0.4119, 0.3347], [0.5527, 0.2753, 0.7129]];

/// Half the thickness of the slab that stands for a flat box, a length: far above rounding and far below the size of any cell, so that surface
/// in the plane of a face lies inside the slab and surface beside it does not.
pub fn slab_margin<V: Vector>(cell: &Aabb<V>) -> V::Scalar {
    rounding_at(cell.min.abs().max(cell.max.abs()).norm_max()) * V::Scalar::from_f64(16.0)
}

/// The axis along which a box has no thickness, if any, and the box made as thick as a [`slab_margin`] along it.
fn thick<V: Vector>(cell: &Aabb<V>) -> (Option<usize>, Aabb<V>) {
    let Some(axis) = cell.size().to_array().iter().position(|&s| s == V::Scalar::ZERO) else { return (None, *cell) };
    let (mut min, mut max, half) = (cell.min.to_array(), cell.max.to_array(), slab_margin(cell));
    (min[axis], max[axis]) = (min[axis] - half, max[axis] + half);
    (Some(axis), Aabb { min: V::from_array(min), max: V::from_array(max) })
}

/// Roundings of a product of three lengths, in units of ε and of the sum of its absolute terms.
const VOLUME_ROUNDINGS: f64 = 12.0;

/// Whether `d·(p × q)` is positive, for vectors that are rounded differences. None if rounding may have changed the sign, or if it is zero.
#[inline(always)]
fn side<V: Vector>(d: V, p: V, q: V) -> Option<bool> {
    let volume = d.dot(p.cross(q));
    let ([px, py, pz], [qx, qy, qz]) = (p.abs().to_array(), q.abs().to_array());
    let terms = V::new(py * qz + pz * qy, pz * qx + px * qz, px * qy + py * qx).dot(d.abs());
    let error = terms * V::Scalar::EPSILON * V::Scalar::from_f64(VOLUME_ROUNDINGS) + V::Scalar::UNDERFLOW;
    if volume > error {
        Some(true)
    } else if volume < -error {
        Some(false)
    } else {
        None
    }
}

/// 1 if a segment enters through a triangle, -1 if it leaves, 0 if it does not meet it; none if that is in doubt.
#[inline(always)]
fn crossing<V: Vector>(from: V, to: V, &[a, b, c]: &[V; 3]) -> Option<i32> {
    let (low, high) = (from.min(to).to_array(), from.max(to).to_array());
    let (min, max) = (a.min(b).min(c).to_array(), a.max(b).max(c).to_array());
    if (0..3).any(|axis| max[axis] < low[axis] || min[axis] > high[axis]) {
        return Some(0);
    }
    let (p, q, r, d) = (a - from, b - from, c - from, to - from);
    // To which side the line passes each edge.
    let sides = [side(d, p, q), side(d, q, r), side(d, r, p)];
    if sides.contains(&Some(true)) && sides.contains(&Some(false)) {
        return Some(0);
    }
    let (e, f) = (b - a, c - a);
    let (before, after) = (side(-p, e, f), side(to - a, e, f));
    if before.is_some() && before == after {
        return Some(0);
    }
    match (sides, before?, after?) {
        ([Some(_), Some(_), Some(_)], outside, _) => Some(if outside { 1 } else { -1 }),
        _ => None,
    }
}

impl<V: Vector> Subdividable for ClosedSurface<'_, V> {
    type Vector = V;

    fn bounds(&self) -> Aabb<V> {
        self.bounds
    }

    fn facet_count(&self) -> usize {
        self.triangles.len()
    }

    fn occupancy(
        &self,
        cell: &Aabb<V>,
        near: &[u32],
        active: &mut ActiveFacets,
        warm: &mut WarmStart<V>,
        count: &mut QueryCount,
    ) -> Occupancy {
        let (flat, space) = thick(cell);
        let (mut wall, mut others, mut kept) = (false, false, false);
        for &id in near {
            let Some(&[a, b, c]) = self.triangles.get(id as usize) else { continue };
            count.queries += 1;
            let found = box_triangle(&space, &Triangle { a, b, c });
            if let BoxTriangle::Apart { .. } = found {
                continue;
            }
            active.push(id);
            kept = true;
            count.undecided += u64::from(found == BoxTriangle::Undecided);
            let in_plane =
                flat.is_some_and(|axis| [a, b, c].iter().all(|p| p.to_array()[axis] == cell.min.to_array()[axis]));
            others = others || !in_plane;
            wall = wall || (in_plane && found == BoxTriangle::Overlapping);
        }
        // Triangles in the face's plane overlap it and no other one meets it: their surface has no edge within the face, and covers it.
        if wall && !others {
            return Occupancy::Closed;
        }
        let wound = self.winding(&space, near, warm);
        *warm =
            wound.map_or(WarmStart::default(), |(point, winding)| WarmStart { vector: point, winding: Some(winding) });
        match wound {
            Some((_, winding)) if !kept && winding > 0 => Occupancy::Closed,
            Some(_) if !kept => Occupancy::Open,
            _ => Occupancy::Cut,
        }
    }

    fn local_planes(&self, _: &Aabb<V>, _: &[u32]) -> Option<LocalPlanes<V::Scalar>> {
        None
    }

    fn share_bounds(&self, _: &Aabb<V>, _: &[u32], _: &Columns<V::Scalar>) -> Bounds<V::Scalar> {
        Bounds::UNKNOWN
    }
}
