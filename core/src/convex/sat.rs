//! A triangle against an axis-aligned box, by the thirteen directions that could separate them.
//!
//! Those are the three axes of the box, the normal of the triangle, and the nine products of a box edge with a triangle edge: each
//! facet of the Minkowski difference is normal to one of them. If the projections overlap on all of them, so do the interiors.
//! The box may be flat, as a cell face is.
//!
//! Reference: T. Akenine-Möller, "Fast 3D triangle-box overlap testing", *J. Graphics Tools* 6 (2001); with a bound on every rounding.

use crate::convex::shape::Triangle;
use crate::convex::support::Support;
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};

/// What [`box_triangle`] found. There will be no fourth variant, so callers may match without a wildcard arm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BoxTriangle<V> {
    /// No interior point is shared: `axis` separates them and points from the box to the triangle. No point of the box projects farther
    /// along it than any point of the triangle.
    Apart {
        /// Of any length.
        axis: V,
    },
    /// An interior point is shared.
    Overlapping,
    /// They touch or nearly so, or the triangle is degenerate, or numbers are not finite, too large or too small.
    Undecided,
}

/// Roundings of a projection, in units of ε and of the sum of its absolute products: 1 for the two differences that make an edge;
/// 2 for those and the product that make a normal; 2 for the last product and its sums: 5. Doubled to cover the box and the bound itself,
/// and rounded up.
const PROJECTION_ROUNDINGS: f64 = 12.0;

/// The order of two projections.
enum Order {
    /// The triangle lies above the box.
    Above,
    /// The triangle lies below the box.
    Below,
    /// Their interiors overlap.
    Overlap,
    /// Closer to touching than rounding can tell.
    Unsure,
}

/// The projection `low..=high` of the triangle on `axis` against that of a box from the origin to `size`. `reach` bounds the products.
#[inline(always)]
fn order<V: Vector>(axis: V, size: V, low: V::Scalar, high: V::Scalar, reach: V::Scalar) -> Order {
    let zero = V::Scalar::ZERO;
    let [x, y, z] = [axis.x() * size.x(), axis.y() * size.y(), axis.z() * size.z()];
    let top = x.larger(zero) + y.larger(zero) + z.larger(zero);
    let bottom = x.smaller(zero) + y.smaller(zero) + z.smaller(zero);
    let error = V::Scalar::from_f64(PROJECTION_ROUNDINGS) * V::Scalar::EPSILON * reach + V::Scalar::UNDERFLOW;
    if low >= top + error {
        Order::Above
    } else if high <= bottom - error {
        Order::Below
    } else if low < top - error && high > bottom + error {
        Order::Overlap
    } else {
        Order::Unsure
    }
}

/// The axis of the box, towards the triangle, along which they share no more than a face of the box; none if there is no such axis.
#[inline(always)]
fn separating_box_axis<V: Vector>(cell: &Aabb<V>, Triangle { a, b, c }: &Triangle<V>) -> Option<V> {
    let (low, high) = (a.min(*b).min(*c).to_array(), a.max(*b).max(*c).to_array());
    let (min, max) = (cell.min.to_array(), cell.max.to_array());
    (0..3).find_map(|k| {
        let along = |s: V::Scalar| {
            let mut axis = [V::Scalar::ZERO; 3];
            axis[k] = s;
            Some(V::from_array(axis))
        };
        if low[k] >= max[k] {
            along(V::Scalar::ONE)
        } else if high[k] <= min[k] {
            along(-V::Scalar::ONE)
        } else {
            None
        }
    })
}

/// Do the interiors of a box and a triangle meet? Exact on the three axes of the box: what only touches a face of the box is apart.
///
/// ```
/// use glam::Vec3;
/// use voidage_core::{number::aabb::Aabb, convex::sat::{BoxTriangle, box_triangle}, convex::shape::Triangle};
///
/// let cell = Aabb { min: Vec3::ZERO, max: Vec3::ONE };
/// let triangle = Triangle { a: Vec3::new(0.5, 0.5, -1.0), b: Vec3::new(0.6, 0.5, 2.0), c: Vec3::new(0.5, 0.7, 2.0) };
/// assert_eq!(box_triangle(&cell, &triangle), BoxTriangle::Overlapping);
/// ```
pub fn box_triangle<V: Vector>(cell: &Aabb<V>, triangle: &Triangle<V>) -> BoxTriangle<V> {
    let extent = cell.extent() + triangle.extent();
    if !(extent >= V::Scalar::SCALE_MIN && extent <= V::Scalar::SCALE_MAX) {
        return BoxTriangle::Undecided;
    }
    if let Some(axis) = separating_box_axis(cell, triangle) {
        return BoxTriangle::Apart { axis };
    }
    let (zero, Triangle { a, b, c }) = (V::Scalar::ZERO, *triangle);
    let size = cell.size();
    let p = [a - cell.min, b - cell.min, c - cell.min];
    let edges = [p[1] - p[0], p[2] - p[1], p[0] - p[2]];
    let far = p[0].abs().max(p[1].abs()).max(p[2].abs()) + size;
    let mut sure = true;

    let normal = edges[0].cross(edges[1]);
    // An edge is a difference of differences: its rounding is one of the points, however short it is.
    let rough = far + far;
    let (e, f) = (rough.to_array(), edges[0].abs().max(edges[1].abs()).to_array());
    let area = V::new(e[1] * f[2] + e[2] * f[1], e[2] * f[0] + e[0] * f[2], e[0] * f[1] + e[1] * f[0]);
    let height = normal.dot(p[0]);
    match order(normal, size, height, height, area.dot(far)) {
        Order::Above => return BoxTriangle::Apart { axis: normal },
        Order::Below => return BoxTriangle::Apart { axis: -normal },
        Order::Overlap => {}
        Order::Unsure => sure = false,
    }

    let [fx, fy, fz] = far.to_array();
    let reach = [fy * fz, fz * fx, fx * fy].map(|r| r + r + r + r);
    for edge in edges {
        let [x, y, z] = edge.to_array();
        let axes = [V::new(zero, -z, y), V::new(z, zero, -x), V::new(-y, x, zero)];
        for (axis, reach) in axes.into_iter().zip(reach) {
            if axis == V::ZERO {
                continue;
            }
            let along = p.map(|p| axis.dot(p));
            let low = along[0].smaller(along[1]).smaller(along[2]);
            let high = along[0].larger(along[1]).larger(along[2]);
            match order(axis, size, low, high, reach) {
                Order::Above => return BoxTriangle::Apart { axis },
                Order::Below => return BoxTriangle::Apart { axis: -axis },
                Order::Overlap => {}
                Order::Unsure => sure = false,
            }
        }
    }
    if sure { BoxTriangle::Overlapping } else { BoxTriangle::Undecided }
}
