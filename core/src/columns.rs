//! Certified bounds of the volume that a convex body has of a box, or the area of a face, from chords.
//!
//! Over the base of a box stand columns; `g` is the height to which a chord fills the box. Since body and box are convex, `g` is
//! concave where the line meets the body, and by the inequality of Hermite and Hadamard its mean over a rectangle lies between the mean of
//! its values at the corners and its value in the middle. The value in the middle is what lies under the body's support plane there; the
//! mean of the corners is what lies under the inner points. Both are of second order. Where `g` falls below zero at a corner, it
//! still obeys `g(p) + g(p') <= 2 g(middle)` for opposite points, so that the mean of its positive part is at most
//! `g(middle) - min g / 2`.
//!
//! A face is the same with one dimension less.

use crate::aabb::Aabb;
use crate::convex::{Convex, rounding};
use crate::real::{Real, Vector};
use crate::support::ScalarOf;

/// Bounds of a fraction: `0 <= lower <= truth <= upper <= 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds<R> {
    /// Not above the truth.
    pub lower: R,
    /// Not below it.
    pub upper: R,
}

impl<R: Real> Bounds<R> {
    /// Nothing solid.
    pub const OPEN: Self = Bounds { lower: R::ZERO, upper: R::ZERO };
    /// All solid.
    pub const CLOSED: Self = Bounds { lower: R::ONE, upper: R::ONE };
    /// Nothing known.
    pub const UNKNOWN: Self = Bounds { lower: R::ZERO, upper: R::ONE };

    /// How far the bounds are apart.
    #[must_use]
    pub fn gap(self) -> R {
        self.upper - self.lower
    }
}

/// How finely to measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Columns<R> {
    /// Stop when the bounds are this close.
    pub enough: R,
    /// Divide each side of the base into this many parts at most; not more than [`MAX_PARTS`].
    pub parts: usize,
}

/// Most parts of a side: beyond, dividing the box is better, as only part of it is hard.
pub const MAX_PARTS: usize = 32;

/// A finer division must bring the bounds at least so much closer; four times is the rule where a surface is smooth.
const PROGRESS: f64 = 0.6;

/// Rounding of the sums over columns, in units of ε: two rows of [`MAX_PARTS`] additions and some products.
const SUM_ROUNDINGS: f64 = 256.0;

impl<R: Real> Columns<R> {
    /// Bounds of the share of `cell` that `body` fills; `near` lists the facets that matter in it.
    pub fn measure<B>(&self, body: &B, cell: &Aabb<B::Vector>, near: &[u32]) -> Bounds<R>
    where
        B: Convex,
        B::Vector: Vector<Scalar = R>,
    {
        let view = View::new(body, cell, near);
        let first = (0..3).filter(|&axis| view.hi[axis] > view.lo[axis]).map(|axis| (axis, view.along(axis, 1)));
        let closest = first.reduce(|a, b| if b.1.gap() < a.1.gap() { b } else { a });
        let Some((axis, mut best)) = closest else { return Bounds::UNKNOWN };
        let mut parts = 1;
        while best.gap() > self.enough && 2 * parts <= self.parts.min(MAX_PARTS) {
            parts *= 2;
            let finer = view.along(axis, parts);
            let enough_progress = finer.gap() <= best.gap() * R::from_f64(PROGRESS);
            best = Bounds { lower: best.lower.max(finer.lower), upper: best.upper.min(finer.upper) };
            if !enough_progress {
                break;
            }
        }
        best
    }
}

/// A body in a box.
struct View<'a, B: Convex> {
    body: &'a B,
    near: &'a [u32],
    lo: [ScalarOf<B>; 3],
    hi: [ScalarOf<B>; 3],
    /// A box around the body.
    min: [ScalarOf<B>; 3],
    max: [ScalarOf<B>; 3],
    grow: ScalarOf<B>,
}

/// A value at a corner of a rectangle; none where the line may miss the body.
type Height<R> = Option<R>;

impl<'a, B: Convex> View<'a, B> {
    fn new(body: &'a B, cell: &Aabb<B::Vector>, near: &'a [u32]) -> Self {
        let bounds = body.bounds();
        let [lo, hi] = [cell.min.to_array(), cell.max.to_array()];
        View { body, near, lo, hi, min: bounds.min.to_array(), max: bounds.max.to_array(), grow: rounding(body) }
    }

    /// The height of the column over a point of the base, of the body grown or shrunk.
    #[inline(always)]
    fn height(&self, axis: usize, base: [ScalarOf<B>; 2], grow: ScalarOf<B>) -> Height<ScalarOf<B>> {
        let (mut origin, mut direction) = ([Real::ZERO; 3], [Real::ZERO; 3]);
        (origin[(axis + 1) % 3], origin[(axis + 2) % 3]) = (base[0], base[1]);
        direction[axis] = Real::ONE;
        let chord = self.body.chord(Vector::from_array(origin), Vector::from_array(direction), grow, self.near)?;
        let height = chord[1].min(self.hi[axis]) - chord[0].max(self.lo[axis]);
        (chord[0] == chord[0] && chord[1] == chord[1]).then_some(height)
    }

    /// The bounds from columns along `axis`, the base divided into `parts` by `parts`.
    fn along(&self, axis: usize, parts: usize) -> Bounds<ScalarOf<B>> {
        type R<B> = ScalarOf<B>;
        let (zero, one) = (R::<B>::ZERO, R::<B>::ONE);
        let (u, v) = (Side::new(self, (axis + 1) % 3, parts), Side::new(self, (axis + 2) % 3, parts));
        let (Some(u), Some(v)) = (u, v) else { return Bounds::OPEN };
        let full = self.hi[axis] - self.lo[axis];
        let inner = |i: usize, j: usize| self.height(axis, [u.at(i), v.at(j)], -self.grow);
        let mut rows = [[None; MAX_PARTS + 1]; 2];
        let (mut lower, mut upper, mut all, mut none) = (zero, zero, true, true);
        for i in 0..=u.parts {
            rows[0][i.min(MAX_PARTS)] = inner(i, 0);
        }
        for j in 0..v.parts {
            let (mut row_lower, mut row_upper) = (zero, zero);
            let [below, above] = &mut rows;
            if v.flat {
                *above = *below;
            } else {
                for i in 0..=u.parts {
                    above[i.min(MAX_PARTS)] = inner(i, j + 1);
                }
            }
            for i in 0..u.parts.min(MAX_PARTS) {
                let corners = [below[i], below[i + 1], above[i], above[i + 1]];
                let middle = self.height(axis, [u.middle(i), v.middle(j)], self.grow);
                let [low, high] = means(corners, middle, full);
                row_lower += low;
                row_upper += high;
                all = all && low == full;
                none = none && high == zero;
            }
            lower += row_lower;
            upper += row_upper;
            rows.swap(0, 1);
        }
        let share = u.share * v.share / (full * R::<B>::from_usize(u.parts * v.parts));
        let relative = R::<B>::EPSILON * R::<B>::from_f64(SUM_ROUNDINGS);
        if none {
            return Bounds::OPEN;
        }
        let whole = all && u.share == one && v.share == one;
        let lower = if whole { one } else { (lower * share * (one - relative) - relative).max(zero) };
        Bounds { lower, upper: (upper * share * (one + relative) + relative).min(one) }
    }
}

/// Bounds of the mean height over a rectangle.
#[inline(always)]
fn means<R: Real>(corners: [Height<R>; 4], middle: Height<R>, full: R) -> [R; 2] {
    let [Some(a), Some(b), Some(c), Some(d)] = corners else { return partly(corners, full) };
    let quarter = R::from_f64(0.25);
    let low = if a == full && b == full && c == full && d == full { full } else { (a + b + (c + d)) * quarter };
    let least = a.min(b).min(c.min(d)).min(R::ZERO);
    let high = middle.map_or(full, |m| m - least * R::HALF);
    [low.max(R::ZERO), high.max(R::ZERO).min(full)]
}

/// Where a column may miss the body: three corners make half the rectangle.
#[cold]
fn partly<R: Real>(corners: [Height<R>; 4], full: R) -> [R; 2] {
    let [a, b, c, d] = corners.map(|h| h.filter(|&h| h >= R::ZERO));
    let third = |x: Height<R>, y: Height<R>, z: Height<R>| Some((x? + y? + z?) * R::from_f64(1.0 / 6.0));
    let half = third(a, b, c).or(third(b, d, a)).or(third(c, a, d)).or(third(d, b, c));
    [half.unwrap_or(R::ZERO), full]
}

/// A side of the base, as far as the body reaches it.
struct Side<R> {
    lo: R,
    hi: R,
    /// Length as a share of the cell's.
    share: R,
    parts: usize,
    flat: bool,
}

impl<R: Real> Side<R> {
    /// None if the body does not reach it.
    #[inline(always)]
    fn new<B>(view: &View<B>, axis: usize, parts: usize) -> Option<Self>
    where
        B: Convex,
        B::Vector: Vector<Scalar = R>,
    {
        let (lo, hi) = (view.lo[axis].max(view.min[axis]), view.hi[axis].min(view.max[axis]));
        if !(lo <= hi) {
            return None;
        }
        if view.lo[axis] == view.hi[axis] {
            return Some(Side { lo, hi, share: R::ONE, parts: 1, flat: true });
        }
        let share = (hi - lo) / (view.hi[axis] - view.lo[axis]);
        (share > R::ZERO).then_some(Side { lo, hi, share, parts, flat: false })
    }

    #[inline(always)]
    fn at(&self, i: usize) -> R {
        if i == self.parts {
            self.hi
        } else {
            self.lo + (self.hi - self.lo) * (R::from_usize(i) / R::from_usize(self.parts))
        }
    }

    #[inline(always)]
    fn middle(&self, i: usize) -> R {
        (self.at(i) + self.at(i + 1)) * R::HALF
    }
}
