//! Certified bounds of the volume that a convex body has of a box, or the area of a face, from chords.
//!
//! Over the base of a box stand columns; lines through them leave the body at a height `h`, a concave function wherever they meet it, and
//! enter it at a convex one. What fills the box is `h` kept within it. Over a rectangle of the base, with values `h_i` at the corners
//! and `m` in the middle:
//!
//! - the triangles through the corners lie below `h`: they are spanned by inner points;
//! - `h(p) <= 2 m - h(p')` for the opposite point `p'`, so the triangles turned over about `m` lie above it;
//! - where neither leaves the box, the mean of `h` lies between the mean of the `h_i` and `m`, which is the mean of the body's support
//!   plane there (the inequality of Hermite and Hadamard).
//!
//! All are of second order, and piecewise linear functions kept within limits are integrated exactly.
//!
//! A face is the same with one dimension less.

use crate::convex::chord::{Convex, rounding};
use crate::convex::support::ScalarOf;
use crate::grid::bounds::Bounds;
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};

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

/// More parts than theory asks for, as a factor: the next division should be the last.
const MARGIN: f64 = 1.08;

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
        while best.gap() > self.enough && parts < self.parts.min(MAX_PARTS) {
            let finer_parts = if parts == 1 { 2 } else { self.wanted(best.gap(), parts) };
            let finer = view.along(axis, finer_parts);
            // What a smooth surface would gain, with room for its rim.
            let gain = R::from_usize(parts * parts) / R::from_usize(finer_parts * finer_parts);
            let smooth = finer.gap() <= best.gap() * gain.sqrt().max(gain * R::TWO);
            best = Bounds { lower: best.lower.max(finer.lower), upper: best.upper.min(finer.upper) };
            if !smooth {
                break;
            }
            parts = finer_parts;
        }
        best
    }

    /// So many parts will do if the surface is smooth, judging by the gap of some.
    fn wanted(&self, gap: R, parts: usize) -> usize {
        let wanted = (gap / self.enough).sqrt() * R::from_usize(parts) * R::from_f64(MARGIN);
        (wanted.to_f64() as usize).saturating_add(1).max(parts + 1 + parts / 8).min(self.parts.min(MAX_PARTS))
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

/// How far a line fills a box, from either end: from the lower side up to where it leaves the body, and from the upper side down to
/// where it enters it. Beyond the box both go on.
#[derive(Clone, Copy)]
struct Heights<R> {
    up: R,
    down: R,
}

impl<'a, B: Convex> View<'a, B> {
    fn new(body: &'a B, cell: &Aabb<B::Vector>, near: &'a [u32]) -> Self {
        let bounds = body.bounds();
        let [lo, hi] = [cell.min.to_array(), cell.max.to_array()];
        View { body, near, lo, hi, min: bounds.min.to_array(), max: bounds.max.to_array(), grow: rounding(body) }
    }

    /// The heights over a point of the base, of the body grown or shrunk; none where the line may miss it.
    #[inline(always)]
    fn heights<const AXIS: usize>(&self, [u, v]: [ScalarOf<B>; 2], grow: ScalarOf<B>) -> Option<Heights<ScalarOf<B>>> {
        let (zero, one) = (Real::ZERO, Real::ONE);
        let (origin, direction) = match AXIS {
            0 => ([zero, u, v], [one, zero, zero]),
            1 => ([v, zero, u], [zero, one, zero]),
            _ => ([u, v, zero], [zero, zero, one]),
        };
        let chord = self.body.chord(Vector::from_array(origin), Vector::from_array(direction), grow, self.near)?;
        // NaN tells nothing.
        let known = chord[0] <= chord[1];
        known.then(|| Heights { up: chord[1] - self.lo[AXIS], down: self.hi[AXIS] - chord[0] })
    }

    /// The bounds from columns along `axis`, the base divided into `parts` by `parts`.
    fn along(&self, axis: usize, parts: usize) -> Bounds<ScalarOf<B>> {
        match axis {
            0 => self.columns::<0>(parts),
            1 => self.columns::<1>(parts),
            _ => self.columns::<2>(parts),
        }
    }

    fn columns<const AXIS: usize>(&self, parts: usize) -> Bounds<ScalarOf<B>> {
        type R<B> = ScalarOf<B>;
        let (zero, one) = (R::<B>::ZERO, R::<B>::ONE);
        let (u, v) = (Side::new(self, (AXIS + 1) % 3, parts), Side::new(self, (AXIS + 2) % 3, parts));
        let (Some(u), Some(v)) = (u, v) else { return Bounds::OPEN };
        let full = self.hi[AXIS] - self.lo[AXIS];
        let inner = |i: usize, j: usize| self.heights::<AXIS>([u.at[i], v.at[j]], -self.grow);
        let mut rows = [[None; MAX_PARTS + 1]; 2];
        let (mut lower, mut upper, mut all, mut none) = (zero, zero, true, true);
        for i in 0..=u.parts {
            rows[0][i] = inner(i, 0);
        }
        for j in 0..v.parts {
            let (mut row_lower, mut row_upper, middle) = (zero, zero, v.middle(j));
            let [below, above] = &mut rows;
            if v.flat {
                *above = *below;
            } else {
                for i in 0..=u.parts {
                    above[i] = inner(i, j + 1);
                }
            }
            for i in 0..u.parts {
                let corners = [below[i], below[i + 1], above[i], above[i + 1]];
                let middle = || self.heights::<AXIS>([u.middle(i), middle], self.grow);
                let [low, high] = filled(corners, middle, full);
                row_lower += low;
                row_upper += high;
                all = all && low == full;
                none = none && high == zero;
            }
            lower += row_lower;
            upper += row_upper;
            rows.swap(0, 1);
        }
        if none {
            return Bounds::OPEN;
        }
        let share = u.share * v.share / (full * R::<B>::from_usize(u.parts * v.parts));
        let relative = R::<B>::EPSILON * R::<B>::from_f64(SUM_ROUNDINGS);
        // Heights are differences of coordinates.
        let room = relative + self.grow / full;
        let lower = if all { u.share * v.share } else { lower * share * (one - relative) - room };
        let whole = all && u.share == one && v.share == one;
        let lower = if whole { one } else { (lower - relative).max(zero) };
        Bounds { lower, upper: (upper * share * (one + relative) + room).min(one) }
    }
}

/// Bounds of the mean filling over a rectangle, from its corners and, if need be, its middle.
#[inline(always)]
fn filled<R: Real>(corners: [Option<Heights<R>>; 4], middle: impl FnOnce() -> Option<Heights<R>>, full: R) -> [R; 2] {
    let [Some(a), Some(b), Some(c), Some(d)] = corners else { return partly(corners, full) };
    let (up, down) = ([a.up, b.up, c.up, d.up], [a.down, b.down, c.down, d.down]);
    let (up_full, down_full) = (all_above(up, full), all_above(down, full));
    if up_full && down_full {
        return [full, full];
    }
    let Some(m) = middle() else { return [R::ZERO, full] };
    let up = if up_full { [full, full] } else { kept(up, m.up, full) };
    let down = if down_full { [full, full] } else { kept(down, m.down, full) };
    [(up[0] + (down[0] - full)).max(R::ZERO), (up[1] + (down[1] - full)).max(R::ZERO)]
}

#[inline(always)]
fn all_above<R: Real>(h: [R; 4], limit: R) -> bool {
    h[0] >= limit && h[1] >= limit && h[2] >= limit && h[3] >= limit
}

/// Bounds of the mean of a concave function kept within `0..=full`, from its values at the corners and in the middle.
#[inline(always)]
fn kept<R: Real>(h: [R; 4], middle: R, full: R) -> [R; 2] {
    let least = h[0].min(h[1]).min(h[2].min(h[3]));
    let most = middle + middle - least;
    if most <= R::ZERO {
        [R::ZERO, R::ZERO]
    } else if least >= R::ZERO && most <= full {
        [(h[0] + h[1] + (h[2] + h[3])) * R::from_f64(0.25), middle]
    } else {
        let over = h.map(|h| middle + middle - h);
        [over_triangles(h, full), over_triangles(over, full)]
    }
}

/// The mean over a square of the two triangles through its corners, kept within `0..=full`.
fn over_triangles<R: Real>([a, b, c, d]: [R; 4], full: R) -> R {
    let triangle = |x: R, y: R, z: R| positive(x, y, z) - positive(x - full, y - full, z - full);
    ((triangle(a, b, c) + triangle(d, b, c)) * R::HALF).max(R::ZERO).min(full)
}

/// The mean over a triangle of the positive part of a linear function with these values at the corners.
fn positive<R: Real>(x: R, y: R, z: R) -> R {
    let (low, high) = (x.min(y).min(z), x.max(y).max(z));
    let middle = x.min(y).max(x.max(y).min(z));
    let third = R::from_f64(1.0 / 3.0);
    // The part beyond the line where the function vanishes is a triangle of its own.
    let tip = |top: R, p: R, q: R| top * (top / (top - p)) * (top / (top - q)) * third;
    if low >= R::ZERO {
        (low + middle + high) * third
    } else if high <= R::ZERO {
        R::ZERO
    } else if middle <= R::ZERO {
        tip(high, middle, low)
    } else {
        (low + middle + high) * third + tip(-low, -middle, -high)
    }
}

/// Where a column may miss the body: three corners make half the rectangle.
#[cold]
fn partly<R: Real>(corners: [Option<Heights<R>>; 4], full: R) -> [R; 2] {
    // Within the box and the body both are concave; below zero there is nothing inside.
    let depth = |h: Heights<R>| h.up.min(full) + h.down.min(full) - full;
    let [a, b, c, d] = corners.map(|h| h.map(depth).filter(|&h| h >= R::ZERO));
    let third = |x: Option<R>, y: Option<R>, z: Option<R>| Some((x? + y? + z?) * R::from_f64(1.0 / 6.0));
    let half = third(a, b, c).or(third(b, d, a)).or(third(c, a, d)).or(third(d, b, c));
    [half.unwrap_or(R::ZERO), full]
}

/// A side of the base, as far as the body reaches it.
struct Side<R> {
    /// Where its parts begin and end.
    at: [R; MAX_PARTS + 1],
    /// Length as a share of the cell's.
    share: R,
    /// Not more than [`MAX_PARTS`].
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
            return Some(Side { at: [lo; MAX_PARTS + 1], share: R::ONE, parts: 1, flat: true });
        }
        let (share, parts) = ((hi - lo) / (view.hi[axis] - view.lo[axis]), parts.min(MAX_PARTS));
        let mut at = [hi; MAX_PARTS + 1];
        for i in 0..parts {
            at[i] = lo + (hi - lo) * (R::from_usize(i) / R::from_usize(parts));
        }
        (share > R::ZERO).then_some(Side { at, share, parts, flat: false })
    }

    #[inline(always)]
    fn middle(&self, i: usize) -> R {
        (self.at[i] + self.at[i + 1]) * R::HALF
    }
}
