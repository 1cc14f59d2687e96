//! The lens between an arc of a conic and its chord: area and centroid.
//!
//! One formula for ellipse, parabola and hyperbola. Between two points an arc is a rational quadratic Bézier curve; its weight `w` tells
//! how it bends: below 1 an ellipse, above 1 a hyperbola. Lines come out as zero, and flat arcs lose no digits.
//!
//! Reference: E. Lee, "The rational Bézier representation for conics", in: Geometric Modeling, SIAM 1987.

use crate::number::real::Real;

/// A point or vector in a plane.
pub(super) type P2 = [f64; 2];

/// `a - b`.
#[inline(always)]
pub(super) fn sub(a: P2, b: P2) -> P2 {
    [a[0] - b[0], a[1] - b[1]]
}

/// The vector product, positive if `b` lies to the left of `a`.
#[inline(always)]
pub(super) fn cross(a: P2, b: P2) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// A symmetric matrix `[uu, uv, vv]` times a vector.
#[inline(always)]
pub(super) fn times(s: [f64; 3], d: P2) -> P2 {
    [s[0] * d[0] + s[1] * d[1], s[1] * d[0] + s[2] * d[1]]
}

#[inline(always)]
fn dot(a: P2, b: P2) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Area and first moments about a given point.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Moments {
    pub area: f64,
    pub first: P2,
}

/// Lens of the arc from `p` to `q`, at most half an ellipse, counter-clockwise about the inside; moments about `p`. `s` is the conic's
/// quadratic part and `gradients` half its gradients in `p` and `q`, outward, all to one scale.
#[inline]
pub(super) fn lens(p: P2, q: P2, s: [f64; 3], gradients: [P2; 2]) -> Moments {
    let d = sub(q, p);
    let sd = times(s, d);
    let t = [-gradients[0][1], gradients[0][0]];
    let (kappa, tau) = (dot(d, sd), dot(t, times(s, t)));
    let middle = [gradients[0][0] + gradients[1][0], gradients[0][1] + gradients[1][1]];
    let turn = (cross(middle, sd) * 0.5).abs();
    if !(kappa > 0.0) {
        return Moments::default();
    }
    if turn * turn >= kappa * tau * SHARP {
        // Two lines: what is left is the triangle of the points and the lines' crossing.
        let area = kappa * kappa / (8.0 * turn);
        let along = |n: usize| d[n] / 3.0 + t[n] * kappa / (6.0 * turn);
        return if area < f64::INFINITY {
            Moments { area, first: [along(0) * area, along(1) * area] }
        } else {
            Moments::default()
        };
    }
    let ratio = Real::sqrt(kappa / tau);
    let w = turn * ratio / kappa;
    let bend = bend(w);
    let area = kappa * ratio * bend * 0.125;
    let g = centroid(w, bend);
    let along = |n: usize| d[n] * 0.5 + g * 0.5 * (ratio * t[n] - w * d[n]);
    Moments { area, first: [along(0) * area, along(1) * area] }
}

/// Beyond this w² a hyperbola is two lines.
const SHARP: f64 = 1e18;

/// Below this 1 − w² the closed form of [`bend`] loses digits and a series takes its place.
const FLAT: f64 = 0.09;

/// `2 Cₙ / (2n + 3)`, Cₙ the coefficients of (1 − y)^(−1/2).
const SERIES: [f64; 16] = series();

const fn series() -> [f64; 16] {
    let mut terms = [0.0; 16];
    let (mut c, mut n) = (1.0, 0);
    while n < 16 {
        terms[n] = 2.0 * c / (2 * n + 3) as f64;
        c *= (2 * n + 1) as f64 / (2 * n + 2) as f64;
        n += 1;
    }
    terms
}

/// Area of the lens in units of κ √(κ/τ) / 8.
#[inline]
pub(super) fn bend(w: f64) -> f64 {
    let y = (1.0 - w) * (1.0 + w);
    if y.abs() < FLAT {
        return SERIES.iter().rev().fold(0.0, |sum, term| sum * y + term);
    }
    if y > 0.0 {
        let root = Real::sqrt(y);
        (libm::acos(w.min(1.0)) - w * root) / (y * root)
    } else {
        let root = Real::sqrt(-y);
        (w * root - libm::acosh(w)) / (-y * root)
    }
}

/// How far the centroid lies from the chord's middle towards the corner of the tangents.
#[inline]
fn centroid(w: f64, bend: f64) -> f64 {
    let y = (1.0 - w) * (1.0 + w);
    if y.abs() < 1e-3 {
        return 0.2 + y * (19.0 / 350.0 + y * 0.027_761_904_761_904_76);
    }
    if bend > 0.0 { (2.0 / (3.0 * bend) - w) / y } else { 0.0 }
}
