//! The lens between an arc of a conic and its chord: area and centroid.
//!
//! One formula for ellipse, parabola and hyperbola. Between two points an arc is a rational quadratic Bézier curve; its weight `w` tells
//! how it bends: below 1 an ellipse, above 1 a hyperbola. Lines come out as zero, and flat arcs lose no digits.
//!
//! Reference: E. Lee, "The rational Bézier representation for conics", in: Geometric Modeling, SIAM 1987.

use crate::number::plane::{P2, dot, on_way, sub};
use crate::number::real::Real;

/// A conic `size (across·p)² + factor (along·p)² + 2 linear·(across·p, along·p) + c <= 0`, `across` and `along` spanning an area of one. As a sum of two
/// squares the form keeps its digits where it all but vanishes, as along a line in which a plane touches a wall; by the entries of its matrix
/// it would not.
#[derive(Clone, Copy, Debug)]
pub(super) struct Conic {
    pub size: f64,
    pub across: P2,
    /// Positive if the conic is an ellipse.
    pub factor: f64,
    pub along: P2,
    pub linear: P2,
    /// What the form makes of a tangent as long as half the gradient, in each point of the conic: 0 for two lines.
    pub tau: f64,
}

impl Conic {
    /// A circle about the origin, by the square of its radius.
    pub fn circle(square: f64) -> Self {
        Conic { size: 1.0, across: [1.0, 0.0], factor: 1.0, along: [0.0, 1.0], linear: [0.0; 2], tau: square }
    }

    /// An ellipse by its matrix `[uu, uv, vv]`, the determinant of that, its centre, and `tau`.
    pub fn ellipse([uu, uv, vv]: [f64; 3], determinant: f64, center: P2, tau: f64) -> Self {
        let (size, across, along) =
            if uu >= vv { (uu, [1.0, uv / uu], [0.0, 1.0]) } else { (vv, [uv / vv, 1.0], [-1.0, 0.0]) };
        let factor = determinant / size;
        let linear = [-size * dot(across, center), -factor * dot(along, center)];
        Conic { size, across, factor, along, linear, tau }
    }

    /// Half the gradient at a point, by its parts along `across` and `along`.
    #[inline(always)]
    fn parts_of_gradient(&self, p: P2) -> P2 {
        let along = self.factor * dot(self.along, p) + self.linear[1];
        [self.size * dot(self.across, p) + self.linear[0], along]
    }

    /// Half the gradient at a point.
    #[inline(always)]
    pub fn gradient(&self, p: P2) -> P2 {
        let [s, t] = self.parts_of_gradient(p);
        [s * self.across[0] + t * self.along[0], s * self.across[1] + t * self.along[1]]
    }

    /// The form of a vector.
    #[inline(always)]
    pub fn form(&self, d: P2) -> f64 {
        let (s, t) = (dot(self.across, d), dot(self.along, d));
        self.size * (s * s) + self.factor * (t * t)
    }

    /// Does an ellipse reach at most so far from its centre along both axes of the plane?
    pub fn is_within(&self, reach: P2) -> bool {
        let determinant = self.size * self.factor;
        [(0, 1), (1, 0)].iter().all(|&(own, other)| {
            let entry = self.size * (self.across[other] * self.across[other])
                + self.factor * (self.along[other] * self.along[other]);
            entry * self.tau <= determinant * determinant * (reach[own] * reach[own])
        })
    }

    /// The vector product of half the gradient in the middle of a chord and of the form's image of the chord: positive for an arc of less than half
    /// an ellipse.
    #[inline(always)]
    pub fn turn(&self, p: P2, q: P2) -> f64 {
        let (g, d) = (self.parts_of_gradient(on_way(p, q, 0.5)), sub(q, p));
        g[0] * (self.factor * dot(self.along, d)) - g[1] * (self.size * dot(self.across, d))
    }
}

/// Area and first moments about a given point.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Moments {
    pub area: f64,
    pub first: P2,
}

/// An arc as a rational quadratic curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bow {
    /// From its first to its last point.
    pub chord: P2,
    /// Along the tangent in the first point, as long as half the gradient there.
    pub tangent: P2,
    /// Three halves of the area if the arc were one of a parabola with this size.
    pub size: f64,
    /// `ratio · tangent / 2 w` leads from the first point to where the tangents meet.
    pub ratio: f64,
    pub w: f64,
}

/// What lies between an arc and its chord.
#[derive(Clone, Copy, Debug)]
pub(super) enum Lens {
    Nothing,
    /// All but the triangle to a corner, given from the first point, is nothing; and its area, which the corner tells only to rounding.
    Triangle(P2, f64),
    Bow(Bow),
}

/// The arc of a conic from `p` to `q`, at most half an ellipse, counter-clockwise about the inside, that reaches no farther than `reach`
/// from its chord: where it would, as in a plane along a line of a cone, it is made by rounding. `turn` is what [`Conic::turn`] tells of them.
#[inline(always)]
pub(super) fn lens_of([p, q]: [P2; 2], turn: f64, conic: &Conic, reach: f64) -> Lens {
    let (chord, gradient) = (sub(q, p), conic.gradient(p));
    let tangent = [-gradient[1], gradient[0]];
    let (kappa, tau, turn) = (conic.form(chord), conic.tau, turn.abs());
    let (determinant, most) = (conic.size * conic.factor, 4.0 * tau);
    // No chord of an ellipse is longer than the one through its centre; where a plane touches a solid rounding may tell of longer ones.
    let kappa = if kappa * determinant > most { most / determinant } else { kappa };
    if !(kappa > 0.0) {
        return Lens::Nothing;
    }
    if turn * turn >= kappa * tau * SHARP {
        // Two lines: what is left is the triangle of the points and the lines' crossing.
        let along = kappa / (2.0 * turn);
        let (area, corner) = (kappa * along * 0.25, tangent.map(|t| t * along));
        // No triangle has more than half the product of two sides; in a plane that touches a cone rounding makes others.
        let (side, sides) = (dot(corner, corner), dot(chord, chord) * dot(corner, corner));
        let is_one = side <= reach * reach && area * area <= sides * 0.26;
        return if is_one { Lens::Triangle(corner, area) } else { Lens::Nothing };
    }
    let ratio = Real::sqrt(kappa / tau);
    let w = turn * ratio / kappa;
    // With the determinant D, 4 τ (1 − w²) is κ D. What is no ellipse bends no more than that, whatever rounding says: of an arc along a line of a cone
    // `turn` is nothing else.
    let w = if conic.factor > 0.0 { w } else { w.max(Real::sqrt(1.0 - kappa * determinant / most)) };
    let (size, most) = (kappa * ratio * 0.125, 3.0 * reach * w.max(1.0));
    if !(size * size <= dot(chord, chord) * (most * most)) {
        return Lens::Nothing;
    }
    Lens::Bow(Bow { chord, tangent, size, ratio, w })
}

/// Area of the lens of an arc, and its first moments about the arc's first point; arguments as those of [`lens_of`].
#[inline]
pub(super) fn lens([p, q]: [P2; 2], turn: f64, conic: &Conic, reach: f64) -> Moments {
    match lens_of([p, q], turn, conic, reach) {
        Lens::Nothing => Moments::default(),
        Lens::Triangle(corner, area) => {
            let d = sub(q, p);
            Moments { area, first: [(d[0] + corner[0]) / 3.0 * area, (d[1] + corner[1]) / 3.0 * area] }
        }
        Lens::Bow(Bow { chord: d, tangent: t, size, ratio, w }) => {
            let bend = bend(w);
            let area = size * bend;
            let g = centroid(w, bend);
            let along = |n: usize| d[n] * 0.5 + g * 0.5 * (ratio * t[n] - w * d[n]);
            Moments { area, first: [along(0) * area, along(1) * area] }
        }
    }
}

/// The area of that lens alone.
#[inline]
pub(super) fn area_of_lens(ends: [P2; 2], turn: f64, conic: &Conic, reach: f64) -> f64 {
    match lens_of(ends, turn, conic, reach) {
        Lens::Nothing => 0.0,
        Lens::Triangle(_, area) => area,
        Lens::Bow(bow) => bow.size * bend(bow.w),
    }
}

/// Beyond this w² a hyperbola is two lines.
const SHARP: f64 = 1e18;

/// Below this 1 − w² the closed form of [`bend`] loses digits and a series takes its place.
const FLAT: f64 = 0.09;

/// Below this six terms of the series are enough: the seventh is `2 C₆ / 15 y⁶`, less than 0.031 · 2.6·10⁻¹⁶.
const FLATTER: f64 = 0.0025;

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
    if y.abs() < FLATTER {
        // What these terms leave out is below 10⁻¹⁷.
        return SERIES[..6].iter().rev().fold(0.0, |sum, term| sum * y + term);
    }
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

/// The derivative of [`bend`].
fn slope(w: f64) -> f64 {
    let y = (1.0 - w) * (1.0 + w);
    if y.abs() < FLAT {
        let (mut sum, mut n) = (0.0, SERIES.len());
        for term in SERIES.iter().skip(1).rev() {
            n -= 1;
            sum = sum * y + term * n as f64;
        }
        return -2.0 * w * sum;
    }
    (3.0 * w * bend(w) - 2.0) / y
}

/// `(bend(w + d) − bend(w)) / d`, for `w` not negative, and its value at `w + d`.
#[inline]
pub(super) fn bends(w: f64, d: f64) -> [f64; 2] {
    let there = bend(w + d);
    if d.abs() > 0.02 {
        return [(there - bend(w)) / d, there];
    }
    // Gauss, four points.
    let mean = |near: f64, far: f64, weight: f64| weight * (slope(w + d * near) + slope(w + d * far));
    let outer = mean(0.069_431_844_202_973_71, 0.930_568_155_797_026_3, 0.173_927_422_568_726_93);
    [outer + mean(0.330_009_478_207_571_87, 0.669_990_521_792_428_1, 0.326_072_577_431_273_07), there]
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
