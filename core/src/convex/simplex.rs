//! Simplices of points `w = b - a` of the Minkowski difference: where the origin lies, and proofs of it.
//!
//! The boolean search uses cross products only: no division, no square root, nothing to normalise. A simplex may lead it astray, but the
//! proof of an answer looks at nothing but the final points ([`Simplex::holds_origin`]).

use crate::number::real::{Real, Vector};

/// Four pairs of support points whose differences `b - a` hold the origin strictly inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Simplex<V> {
    /// Points of the first body.
    pub a: [V; 4],
    /// Points of the second body, each paired with one of the first.
    pub b: [V; 4],
}

/// Where the origin lies with respect to a tetrahedron.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum OriginSide {
    /// Strictly inside, proved.
    Inside,
    /// Beyond the face opposite to this vertex, or too close to it to tell.
    Beyond(u8),
}

/// Rounding of one 3×3 determinant of differences, in units of ε and of its sum of absolute products: a difference in each factor (½ each),
/// two products, one difference and two sums come to 4; doubled to cover second-order terms and the rounding of the bound.
const DETERMINANT_ROUNDINGS: f64 = 8.0;

#[inline(always)]
fn cross_abs<V: Vector>(a: V, b: V) -> V {
    let ([ax, ay, az], [bx, by, bz]) = (a.abs().to_array(), b.abs().to_array());
    V::new(ay * bz + az * by, az * bx + ax * bz, ax * by + ay * bx)
}

/// The origin against a tetrahedron of differences, each component off by at most `slack` (besides one rounding).
#[inline(always)]
pub(crate) fn side<V: Vector>(w: [V; 4], slack: V::Scalar) -> OriginSide {
    let [a, b, c, d] = w;
    let real = V::Scalar::from_f64;
    let zero = V::Scalar::ZERO;
    let (bc, cd, db) = (b.cross(c), c.cross(d), d.cross(b));
    // Barycentric weights of the origin, times six volumes, by Cramer's rule.
    let weight = [-b.dot(cd), a.dot(cd), a.dot(db), a.dot(bc)];
    let volume = weight[0] + weight[1] + weight[2] + weight[3];
    let weight = if volume < zero { weight.map(|x| -x) } else { weight };
    let least = weight[1].smaller(weight[2]).smaller(weight[3]);
    if least > zero && weight[0] > zero {
        let least = least.smaller(weight[0]);
        let rounding = real(DETERMINANT_ROUNDINGS) * V::Scalar::EPSILON;
        // At most six products of three components; a displacement of the points enters each of the three factors.
        let size = a.abs().max(b.abs()).max(c.abs()).max(d.abs()).norm_max() + slack;
        let coarse = real(6.0) * (rounding * size + real(4.0) * slack) * size * size;
        if least > coarse + V::Scalar::UNDERFLOW {
            return OriginSide::Inside;
        }
        if surely_inside(w, weight, slack) {
            return OriginSide::Inside;
        }
    }
    if weight[1] <= weight[2] && weight[1] <= weight[3] {
        OriginSide::Beyond(1)
    } else if weight[2] <= weight[3] {
        OriginSide::Beyond(2)
    } else {
        OriginSide::Beyond(3)
    }
}

/// Whether the four weights are positive for sure: by their actual products and areas, not by a bound on their sizes.
#[cold]
#[inline(never)]
fn surely_inside<V: Vector>(w: [V; 4], weight: [V::Scalar; 4], slack: V::Scalar) -> bool {
    let [a, b, c, d] = w;
    let real = V::Scalar::from_f64;
    let rounding = real(DETERMINANT_ROUNDINGS) * V::Scalar::EPSILON;
    let size = a.abs().max(b.abs()).max(c.abs()).max(d.abs()).norm_max() + slack;
    let [bc, cd, db] = [cross_abs(b, c), cross_abs(c, d), cross_abs(d, b)];
    let products = [b.abs().dot(cd), a.abs().dot(cd), a.abs().dot(db), a.abs().dot(bc)];
    let area = |p: V, q: V| p.cross(q).norm_1();
    let [ab, ac, ad, bc, cd, db] = [area(a, b), area(a, c), area(a, d), area(b, c), area(c, d), area(d, b)];
    // A corner that moves by `slack` changes a determinant by no more than `slack` times the area that the other two span; what goes with
    // the square and the cube of `slack` is in `higher`.
    let areas = [bc + cd + db, cd + ac + ad, db + ab + ad, bc + ab + ac];
    let higher = real(24.0) * slack * slack * size;
    (0..4).all(|i| {
        let moved = slack * (areas[i] + real(8.0) * rounding * size * size) + higher;
        weight[i] > rounding * products[i] + real(1.0 + 1e-6) * moved + V::Scalar::UNDERFLOW
    })
}

impl<V: Vector> Simplex<V> {
    /// Proves that the origin is strictly inside: all four weights have one sign, whatever the rounding. `slack` bounds how far each of
    /// the eight points may be from its body, in each component. Points too large or too small to compute with prove nothing.
    pub fn holds_origin(&self, slack: V::Scalar) -> bool {
        let mut w = [V::ZERO; 4];
        let mut reach = V::Scalar::ZERO;
        for (w, (&a, &b)) in w.iter_mut().zip(self.a.iter().zip(&self.b)) {
            *w = b - a;
            if !w.is_finite() {
                return false;
            }
            reach = reach.max(w.norm_max());
        }
        // Subnormal differences are exact; this makes them normal.
        let lift = if reach < V::Scalar::MIN_POSITIVE { V::Scalar::ONE / V::Scalar::EPSILON } else { V::Scalar::ONE };
        let unit = (reach * lift).binade();
        if !(unit > V::Scalar::ZERO) {
            return false;
        }
        let factor = V::Scalar::ONE / unit;
        let lifted = |x: V::Scalar| x * lift * factor;
        let two = V::Scalar::TWO;
        side(w.map(|w| w * lift * factor), lifted(two * slack)) == OriginSide::Inside
    }
}

/// The point of a simplex nearest to the origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NearestPoint<V: Vector> {
    /// The point.
    pub point: V,
    /// Its barycentric weights, not negative, of the first `count` vertices in the new order.
    pub weights: [V::Scalar; 4],
    /// How many vertices carry it: 1 to 3.
    pub count: usize,
    /// Old indices in their new order: those that carry the point first.
    pub order: [usize; 4],
}

impl<V: Vector> NearestPoint<V> {
    fn closer(self, other: Self) -> Self {
        if other.point.dot(other.point) < self.point.dot(self.point) { other } else { self }
    }
}

fn nearest_of_segment<V: Vector>(w: [V; 4], i: usize, j: usize) -> NearestPoint<V> {
    let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
    let (a, b) = (w[i & 3], w[j & 3]);
    let e = b - a;
    let (from_a, from_b, sq) = (-a.dot(e), b.dot(e), e.dot(e));
    let rest = |i: usize, j: usize| {
        let mut others = (0..4).filter(|&k| k != i && k != j);
        [others.next().unwrap_or(0), others.next().unwrap_or(0)]
    };
    let [k, l] = rest(i, j);
    if !(from_a > zero) || !(sq > V::Scalar::UNDERFLOW) {
        return NearestPoint { point: a, weights: [one, zero, zero, zero], count: 1, order: [i, j, k, l] };
    }
    if !(from_b > zero) {
        return NearestPoint { point: b, weights: [one, zero, zero, zero], count: 1, order: [j, i, k, l] };
    }
    let total = from_a + from_b;
    // Through the cross product: the part across the line keeps its digits when the line is long and passes close by.
    let point = e.cross(a.cross(e)) * (one / sq);
    NearestPoint { point, weights: [from_b / total, from_a / total, zero, zero], count: 2, order: [i, j, k, l] }
}

fn nearest_of_triangle<V: Vector>(w: [V; 4], i: usize, j: usize, k: usize) -> NearestPoint<V> {
    let zero = V::Scalar::ZERO;
    let (a, b, c) = (w[i & 3], w[j & 3], w[k & 3]);
    let normal = (b - a).cross(c - a);
    let sq = normal.dot(normal);
    let weights = [normal.dot(b.cross(c)), normal.dot(c.cross(a)), normal.dot(a.cross(b))];
    let beyond = weights.map(|weight| !(weight > zero));
    if sq > V::Scalar::UNDERFLOW && !(beyond[0] || beyond[1] || beyond[2]) {
        let inv = V::Scalar::ONE / (weights[0] + weights[1] + weights[2]);
        let weights = weights.map(|weight| weight * inv);
        let height = normal.dot(a) * weights[0] + normal.dot(b) * weights[1] + normal.dot(c) * weights[2];
        let [weight_a, weight_b, weight_c] = weights;
        return NearestPoint {
            point: normal * (height / sq),
            weights: [weight_a, weight_b, weight_c, zero],
            count: 3,
            order: [i, j, k, (6 - i - j - k) & 3],
        };
    }
    // The nearest edge is one that the origin lies beyond. With a degenerate triangle it may be any.
    let sides = [(1, 2), (0, 2), (0, 1)].map(|(p, q)| ([i, j, k][p], [i, j, k][q]));
    let any = !(sq > V::Scalar::UNDERFLOW) || beyond == [false; 3];
    let mut nearest: Option<NearestPoint<V>> = None;
    for ((p, q), beyond) in sides.into_iter().zip(beyond) {
        if beyond || any {
            let found = nearest_of_segment(w, p, q);
            nearest = Some(nearest.map_or(found, |n| n.closer(found)));
        }
    }
    nearest.unwrap_or_else(|| nearest_of_segment(w, i, j))
}

/// The point nearest to the origin among the first `count` vertices, the newest first. Of four, the origin is taken to be outside.
#[inline(always)]
pub(crate) fn nearest<V: Vector>(w: [V; 4], count: usize) -> NearestPoint<V> {
    match count {
        0 | 1 => {
            let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
            NearestPoint { point: w[0], weights: [one, zero, zero, zero], count: 1, order: [0, 1, 2, 3] }
        }
        2 => nearest_of_segment(w, 0, 1),
        3 => nearest_of_triangle(w, 0, 1, 2),
        _ => {
            let zero = V::Scalar::ZERO;
            let (ab, ac, ad) = (w[1] - w[0], w[2] - w[0], w[3] - w[0]);
            // Faces at the newest vertex; each is seen if the origin and the vertex it lacks are on different sides.
            let faces = [(ab.cross(ac), ad, [0, 1, 2]), (ab.cross(ad), ac, [0, 1, 3]), (ac.cross(ad), ab, [0, 2, 3])];
            let mut nearest: Option<NearestPoint<V>> = None;
            for (normal, other, [i, j, k]) in faces {
                let (origin, other) = (-normal.dot(w[0]), normal.dot(other));
                if origin * other <= zero {
                    let found = nearest_of_triangle(w, i, j, k);
                    nearest = Some(nearest.map_or(found, |n| n.closer(found)));
                }
            }
            // None is seen: the origin is too close to a face to tell.
            nearest.unwrap_or_else(|| {
                nearest_of_triangle(w, 0, 1, 2)
                    .closer(nearest_of_triangle(w, 0, 1, 3))
                    .closer(nearest_of_triangle(w, 0, 2, 3))
                    .closer(nearest_of_triangle(w, 1, 2, 3))
            })
        }
    }
}
