//! The volume between two heights between which the same lines bound a polygon that moves.
//!
//! Its area is a quadratic function of the height and of half the widths of both strips ([`super::moving`]), which are square roots of how far the
//! height is from where each strip begins, times how far from where it ends. Of the root of the distance from where the later one begins, or the earlier one
//! ends, it is an analytic function; so is it in an ellipse of the complex plane about a panel, its foci the panel's ends, up to where one of the other
//! three distances vanishes.
//!
//! Gauss' rule of n points is off by no more than 64/15 M ρ⁻²ⁿ / (1 − ρ⁻²) times half the panel's width: ρ is the sum of the ellipse's half axes where the panel's
//! half width is 1, M an upper bound of the integrand in it.
//!
//! Reference: L. N. Trefethen, *Approximation Theory and Approximation Practice*, SIAM 2013, theorem 19.3.

use super::moving::Moving;
use crate::number::kronrod::gauss;
use crate::number::plane::P2;
use crate::number::real::Real;

/// Most panels; one that is wider than it may be is halved, the next one is tried at twice the width.
const MOST_PANELS: usize = 96;

/// Ellipses larger than this gain less than the bound of the integrand loses.
const LARGEST_ELLIPSE: f64 = 32.0;

/// The heights `base + sense · t²`.
struct Variable {
    base: f64,
    sense: f64,
    /// How far from the base each strip begins, before it; and how far behind it each ends.
    before: P2,
    behind: P2,
}

impl Variable {
    /// From where the later strip begins upward, or from where the earlier one ends downward.
    fn new(strips: &[P2; 2], upward: bool) -> Self {
        let [[a, b], [c, d]] = *strips;
        if upward {
            let base = a.max(c);
            Variable { base, sense: 1.0, before: [base - a, base - c], behind: [b - base, d - base] }
        } else {
            let base = b.min(d);
            Variable { base, sense: -1.0, before: [b - base, d - base], behind: [base - a, base - c] }
        }
    }

    fn of(&self, height: f64) -> f64 {
        Real::sqrt(((height - self.base) * self.sense).max(0.0))
    }

    /// Half the widths of the strips.
    fn half(&self, square: f64) -> P2 {
        [0, 1].map(|n| Real::sqrt(((square + self.before[n]) * (self.behind[n] - square)).max(0.0)))
    }

    /// The area that a polygon has, times by how much the height grows.
    fn integrand(&self, moving: &Moving, t: f64) -> f64 {
        let square = t * t;
        moving.area_of(self.base + self.sense * square, self.half(square)) * (2.0 * t)
    }

    /// By how much Gauss' rule of seven points is off between two values; infinite where that is not known.
    fn error(&self, moving: &Moving, [from, to]: P2) -> f64 {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let mut ellipse = LARGEST_ELLIPSE;
        let mut limit = |distances: f64| {
            let axis = 0.5 * distances / half;
            let sum = axis + Real::sqrt(((axis - 1.0) * (axis + 1.0)).max(0.0));
            ellipse = if sum < ellipse { sum } else { ellipse };
        };
        for n in 0..2 {
            let end = Real::sqrt(self.behind[n].max(0.0));
            limit((end - from).abs() + (end - to).abs());
            let beside = self.before[n];
            if beside > 0.0 {
                limit(Real::sqrt(from * from + beside) + Real::sqrt(to * to + beside));
            }
        }
        let reach = 0.5 * half * (ellipse + 1.0 / ellipse);
        let most = middle + reach;
        let wide = [0, 1].map(|n| Real::sqrt((most * most + self.before[n]) * (self.behind[n] + most * most)));
        let tall = reach * (2.0 * middle + reach);
        let bound = moving.most_area(self.base + self.sense * (middle * middle), tall, wide) * (2.0 * most);
        let square = 1.0 / (ellipse * ellipse);
        let sixth = square * square * square;
        let error = half * bound * (64.0 / 15.0) * (sixth * sixth * square) / (1.0 - square);
        if error >= 0.0 { error } else { f64::INFINITY }
    }

    /// The integral from one height up to another, and by how much it may be off, not more than `enough` if there is no error.
    fn integral(&self, moving: &Moving, [low, high]: P2, enough: f64) -> Option<P2> {
        let (p, q) = (self.of(low), self.of(high));
        let [first, last] = [p.min(q), p.max(q)];
        let (mut at, mut width, mut found) = (first, last - first, [0.0; 2]);
        for _ in 0..MOST_PANELS {
            if !(at < last) {
                return Some(found);
            }
            let to = if at + width < last { at + width } else { last };
            let error = self.error(moving, [at, to]);
            if error <= enough * ((to - at) / (last - first)) {
                found = [found[0] + gauss([at, to], |t| self.integrand(moving, t)), found[1] + error];
                (at, width) = (to, 2.0 * width);
            } else {
                width = 0.5 * (to - at);
            }
        }
        None
    }
}

/// The volume of a polygon that moves between two heights at which it has the same sides, and by how much it may be off but for rounding; none if that
/// takes too many panels. Strips by the heights at which they begin and end.
pub(super) fn volume(moving: &Moving, [from, to]: P2, strips: &[P2; 2], enough: f64) -> Option<P2> {
    let [upward, downward] = [Variable::new(strips, true), Variable::new(strips, false)];
    let middle = (0.5 * (upward.base + downward.base)).limited(from, to);
    let share = |low: f64, high: f64| enough * ((high - low) / (to - from));
    let lower = upward.integral(moving, [from, middle], share(from, middle))?;
    let upper = downward.integral(moving, [middle, to], share(middle, to))?;
    Some([lower[0] + upper[0], lower[1] + upper[1]])
}
