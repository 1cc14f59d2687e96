//! A closed surface of triangles, convex or not, as the subdivision sees it: the paper's road triangle by triangle.
//!
//! A box is cut if a triangle meets it ([`box_triangle`]); what no triangle meets is inside or outside as a whole. Which of the two is
//! found by counting: a box hands its parts a point in it with the winding number of the surface there, and along a segment to a point of a
//! part, which stays in the box, only the triangles that cut the box can cross. Every crossing has certified signs; where one is in doubt
//! another point is tried, and without any the part counts as cut. So on a surface that closes edge by edge no count is wrong.
//!
//! Reference: D. Sunday, "Inclusion of a point in a polygon", 2001, for winding numbers; here along segments in space.

use crate::convex::chord::rounded;
use crate::convex::sat::{BoxTriangle, box_triangle};
use crate::convex::shape::Triangle;
use crate::grid::bounds::Bounds;
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};
use crate::subdivide::chord_bounds::Columns;
use crate::subdivide::place::{Body, Near, Occupancy, Seen, Tally, Trace};

/// A surface in the caller's memory, counter-clockwise from outside; every edge must have its reverse. Of a larger one it may hold those
/// triangles only that some slab of space across the y or z axis meets, [`slab`] included, for boxes in that slab.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mesh<'a, V: Vector> {
    triangles: &'a [[V; 3]],
    bounds: Aabb<V>,
}

impl<'a, V: Vector> Mesh<'a, V> {
    /// A surface; finite.
    pub fn new(triangles: &'a [[V; 3]]) -> Self {
        Mesh { triangles, bounds: Aabb::around(triangles.as_flattened()) }
    }

    /// What it was made of.
    pub fn triangles(&self) -> &'a [[V; 3]] {
        self.triangles
    }

    /// The winding number at some point of a box, with that point; none if every segment to the box meets the surface in a way that
    /// cannot be told.
    fn count(&self, cell: &Aabb<V>, near: &[u32], trace: &Trace<V>) -> Option<(V, i32)> {
        let size = cell.size();
        let inside = |[x, y, z]: [f64; 3]| {
            let [x, y, z] = [x, y, z].map(V::Scalar::from_f64);
            cell.min + V::new(size.x() * x, size.y() * y, size.z() * z)
        };
        for fractions in POINTS {
            let to = inside(fractions);
            let added = match trace.winding {
                Some(winding) => self.crossings(trace.vector, to, near.iter().copied()).map(|n| winding + n),
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

    /// How often a segment enters through some triangles, less how often it leaves; none in doubt.
    fn crossings(&self, from: V, to: V, mut ids: impl Iterator<Item = u32>) -> Option<i32> {
        ids.try_fold(0, |sum, id| {
            Some(sum + self.triangles.get(id as usize).map_or(Some(0), |t| crossing(from, to, t))?)
        })
    }
}

/// Where in a box the winding is asked: no fractions that a mesh would be made of.
const POINTS: [[f64; 3]; 4] =
    [[0.4813, 0.5437, 0.4591], [0.3127, 0.6211, 0.5739], [0.6893, 0.4119, 0.3347], [0.5527, 0.2753, 0.7129]];

/// Half the thickness of the slab that stands for a flat box, far above rounding and far below any size: points beside the face are told
/// apart from surface in its plane.
pub fn slab<V: Vector>(cell: &Aabb<V>) -> V::Scalar {
    rounded(cell.min.abs().max(cell.max.abs()).norm_max()) * V::Scalar::from_f64(16.0)
}

/// The axis along which a box has no thickness, and the box with some.
fn thick<V: Vector>(cell: &Aabb<V>) -> (Option<usize>, Aabb<V>) {
    let Some(axis) = cell.size().to_array().iter().position(|&s| s == V::Scalar::ZERO) else { return (None, *cell) };
    let (mut min, mut max, half) = (cell.min.to_array(), cell.max.to_array(), slab(cell));
    (min[axis], max[axis]) = (min[axis] - half, max[axis] + half);
    (Some(axis), Aabb { min: V::from_array(min), max: V::from_array(max) })
}

/// Roundings of a product of three lengths, in units of ε and of the sum of its absolute terms.
const VOLUME_ROUNDINGS: f64 = 12.0;

/// The sign of `d·(p × q)`: of numbers that are differences, rounded. None if it may be another.
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

impl<V: Vector> Body for Mesh<'_, V> {
    type Vector = V;

    fn bounds(&self) -> Aabb<V> {
        self.bounds
    }

    fn facets(&self) -> usize {
        self.triangles.len()
    }

    fn place(
        &self,
        cell: &Aabb<V>,
        near: &[u32],
        keep: &mut Near,
        trace: &mut Trace<V>,
        tally: &mut Tally,
    ) -> Occupancy {
        let (flat, space) = thick(cell);
        let (mut wall, mut others, mut kept) = (false, false, false);
        for &id in near {
            let Some(&[a, b, c]) = self.triangles.get(id as usize) else { continue };
            tally.queries += 1;
            let found = box_triangle(&space, &Triangle { a, b, c });
            if let BoxTriangle::Apart { .. } = found {
                continue;
            }
            keep.push(id);
            kept = true;
            tally.undecided += u64::from(found == BoxTriangle::Undecided);
            let in_plane =
                flat.is_some_and(|axis| [a, b, c].iter().all(|p| p.to_array()[axis] == cell.min.to_array()[axis]));
            others = others || !in_plane;
            wall = wall || (in_plane && found == BoxTriangle::Overlapping);
        }
        // Surface in the plane of a face that ends nowhere within it covers all of it.
        if wall && !others {
            return Occupancy::Closed;
        }
        let counted = self.count(&space, near, trace);
        *trace = counted.map_or(Trace::default(), |(point, winding)| Trace { vector: point, winding: Some(winding) });
        match counted {
            Some((_, winding)) if !kept => {
                if winding > 0 {
                    Occupancy::Closed
                } else {
                    Occupancy::Open
                }
            }
            _ => Occupancy::Cut,
        }
    }

    fn planes(&self, _: &Aabb<V>, _: &[u32]) -> Option<Seen<V::Scalar>> {
        None
    }

    fn measure(&self, _: &Aabb<V>, _: &[u32], _: &Columns<V::Scalar>) -> Bounds<V::Scalar> {
        Bounds::UNKNOWN
    }
}
