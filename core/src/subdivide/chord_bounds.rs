//! Certified bounds of a convex body's share of a box's volume, or of a face's area, from chords.
//!
//! The base of the box, one of its sides, is divided into rectangles, and a column stands on each. The line up from a point `p` of the base
//! leaves the body at a height `h(p)`, which is a concave function of `p` wherever the line meets the body, and enters it at a convex one. The
//! body fills a column up to the mean of `h`, clamped to the box. Over a rectangle with values `h_i` at its corners and `m` in its middle:
//!
//! - `h` is not below the two triangles through its values at the corners, as they are spanned by points of the body;
//! - `h(p) <= 2 m - h(p')`, where `p'` is opposite to `p` about the middle; so it is not above the same triangles with the values
//!   `2 m - h_i` at the opposite corners;
//! - where both bounds stay within the height of the box, the mean of `h` lies between the mean of the `h_i` and `m` (the inequality of Hermite and Hadamard).
//!
//! The gap between these bounds is of second order in the size of the rectangle. Means of piecewise linear functions, clamped, are exact.
//! A face is measured the same way with one dimension less.

use crate::convex::chord::{Chords, chord_rounding};
use crate::convex::support::ScalarOf;
use crate::grid::bounds::Bounds;
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};

/// How finely to measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Columns<R> {
    /// Bounds this close will do, as a share.
    pub enough: R,
    /// Divide each side of the base into this many parts at most; not more than [`MAX_PARTS`].
    pub parts: usize,
}

/// Most parts of a side: beyond, dividing the box is better, as only part of it is hard.
pub const MAX_PARTS: usize = 32;

/// How many more parts are made than the gap so far asks for, as a factor, so that the next division is the last.
const MARGIN: f64 = 1.08;

/// Rounding of the sums over columns, in units of ε: two rows of [`MAX_PARTS`] additions and some products.
const SUM_ROUNDINGS: f64 = 256.0;

impl<R: Real> Columns<R> {
    /// Bounds of the share of `cell` that `body` fills; `near` lists the facets that matter in it.
    pub fn share_bounds<B>(&self, body: &B, cell: &Aabb<B::Vector>, near: &[u32]) -> Bounds<R>
    where
        B: Chords,
        B::Vector: Vector<Scalar = R>,
    {
        let place = BoxInBody::new(body, cell, near);
        let first = (0..3).filter(|&axis| place.hi[axis] > place.lo[axis]).map(|axis| (axis, place.along(axis, 1)));
        let closest = first.reduce(|a, b| if b.1.gap() < a.1.gap() { b } else { a });
        let Some((axis, mut best)) = closest else { return Bounds::UNKNOWN };
        let mut parts = 1;
        while best.gap() > self.enough && parts < self.parts.min(MAX_PARTS) {
            let finer_parts = if parts == 1 { 2 } else { self.wanted(best.gap(), parts) };
            let finer = place.along(axis, finer_parts);
            // What a smooth surface would gain, with a margin for its rim.
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

    /// How many parts a side needs for bounds that are close enough, if the gap shrinks with their square as for a smooth surface; `gap` is that of
    /// `parts`.
    fn wanted(&self, gap: R, parts: usize) -> usize {
        let wanted = (gap / self.enough).sqrt() * R::from_usize(parts) * R::from_f64(MARGIN);
        wanted.to_usize().saturating_add(1).max(parts + 1 + parts / 8).min(self.parts.min(MAX_PARTS))
    }
}

/// A box `lo..hi` whose filled share is wanted, and the body that fills it.
struct BoxInBody<'a, B: Chords> {
    body: &'a B,
    /// Facets of the body that matter in the box.
    near: &'a [u32],
    lo: [ScalarOf<B>; 3],
    hi: [ScalarOf<B>; 3],
    /// The box `min..max` around the body.
    min: [ScalarOf<B>; 3],
    max: [ScalarOf<B>; 3],
    /// By this length the body is shrunk for lower and grown for upper bounds, against the rounding of chords.
    grow: ScalarOf<B>,
}

/// Where a line along an axis of the box `lo..hi` passes the body: `up` = exit − lo, `down` = hi − entry, not clamped. With L = hi − lo the length
/// inside both is min(up, L) + min(down, L) − L, at least 0.
#[derive(Clone, Copy)]
struct ChordHeights<R> {
    up: R,
    down: R,
}

impl<'a, B: Chords> BoxInBody<'a, B> {
    fn new(body: &'a B, cell: &Aabb<B::Vector>, near: &'a [u32]) -> Self {
        let bounds = body.bounds();
        let [lo, hi] = [cell.min.to_array(), cell.max.to_array()];
        BoxInBody {
            body,
            near,
            lo,
            hi,
            min: bounds.min.to_array(),
            max: bounds.max.to_array(),
            grow: chord_rounding(body),
        }
    }

    /// The heights of the line over a point of the base, for the body grown by `grow`; none where the line may miss it.
    #[inline(always)]
    fn heights<const AXIS: usize>(
        &self,
        [u, v]: [ScalarOf<B>; 2],
        grow: ScalarOf<B>,
    ) -> Option<ChordHeights<ScalarOf<B>>> {
        let (zero, one) = (Real::ZERO, Real::ONE);
        let (origin, direction) = match AXIS {
            0 => ([zero, u, v], [one, zero, zero]),
            1 => ([v, zero, u], [zero, one, zero]),
            _ => ([u, v, zero], [zero, zero, one]),
        };
        let chord = self.body.chord(Vector::from_array(origin), Vector::from_array(direction), grow, self.near)?;
        // NaN tells nothing.
        let known = chord[0] <= chord[1];
        known.then(|| ChordHeights { up: chord[1] - self.lo[AXIS], down: self.hi[AXIS] - chord[0] })
    }

    /// The bounds from columns along `axis`, the base divided into `parts` by `parts`.
    fn along(&self, axis: usize, parts: usize) -> Bounds<ScalarOf<B>> {
        match axis {
            0 => self.columns::<0>(parts),
            1 => self.columns::<1>(parts),
            _ => self.columns::<2>(parts),
        }
    }

    /// The heights over a row of points: those of `u` at the same `v`, of the body shrunk.
    #[inline(always)]
    fn fill_row<const AXIS: usize>(&self, u: &BaseAxis<ScalarOf<B>>, v: ScalarOf<B>, row: &mut HeightRow<ScalarOf<B>>) {
        for (to, &at) in row.iter_mut().zip(&u.at).take(u.parts + 1) {
            *to = self.heights::<AXIS>([at, v], -self.grow);
        }
    }

    /// [`BoxInBody::along`] for an axis known when the program is built.
    fn columns<const AXIS: usize>(&self, parts: usize) -> Bounds<ScalarOf<B>> {
        let (zero, half) = (ScalarOf::<B>::ZERO, ScalarOf::<B>::HALF);
        let (u, v) = (BaseAxis::new(self, (AXIS + 1) % 3, parts), BaseAxis::new(self, (AXIS + 2) % 3, parts));
        let (Some(u), Some(v)) = (u, v) else { return Bounds::OPEN };
        let full = self.hi[AXIS] - self.lo[AXIS];
        let mut rows = [[None; MAX_PARTS + 1]; 2];
        let [below, above] = &mut rows;
        let (mut below, mut above) = (below, above);
        self.fill_row::<AXIS>(&u, v.at[0], below);
        let mut sum = ColumnSum { lower: zero, upper: zero, all: true, none: true };
        for ends in v.at.windows(2).take(v.parts) {
            let &[v_low, v_high] = ends else { continue };
            if v.flat {
                *above = *below;
            } else {
                self.fill_row::<AXIS>(&u, v_high, above);
            }
            let (mut row_lower, mut row_upper, v_middle) = (zero, zero, (v_low + v_high) * half);
            let squares = below.windows(2).zip(above.windows(2)).zip(u.at.windows(2)).take(u.parts);
            for square in squares {
                let ((&[a, b], &[c, d]), &[u_low, u_high]) = square else { continue };
                let middle = || self.heights::<AXIS>([(u_low + u_high) * half, v_middle], self.grow);
                let column = mean_fill([a, b, c, d], middle, full);
                row_lower += column.lower;
                row_upper += column.upper;
                sum.all = sum.all && column.full;
                sum.none = sum.none && column.empty;
            }
            sum.lower += row_lower;
            sum.upper += row_upper;
            core::mem::swap(&mut below, &mut above);
        }
        self.share_of(&sum, [&u, &v], full)
    }

    /// The sum over all columns, of height `full`, as a share of the box; wider by its rounding.
    #[inline(always)]
    fn share_of(
        &self,
        sum: &ColumnSum<ScalarOf<B>>,
        [u, v]: [&BaseAxis<ScalarOf<B>>; 2],
        full: ScalarOf<B>,
    ) -> Bounds<ScalarOf<B>> {
        type R<B> = ScalarOf<B>;
        let (zero, one) = (R::<B>::ZERO, R::<B>::ONE);
        if sum.none {
            return Bounds::OPEN;
        }
        let share = u.share * v.share / (full * R::<B>::from_usize(u.parts * v.parts));
        let relative = R::<B>::EPSILON * R::<B>::from_f64(SUM_ROUNDINGS);
        // Heights are differences of coordinates.
        let margin = relative + self.grow / full;
        let lower = if sum.all { u.share * v.share } else { sum.lower * share * (one - relative) - margin };
        let whole = sum.all && u.share == one && v.share == one;
        let lower = if whole { one } else { (lower - relative).max(zero) };
        Bounds { lower, upper: (sum.upper * share * (one + relative) + margin).min(one) }
    }
}

/// Heights over the points of a row; none where a line may miss the body.
type HeightRow<R> = [Option<ChordHeights<R>>; MAX_PARTS + 1];

/// Sums over columns, each a mean height.
struct ColumnSum<R> {
    lower: R,
    upper: R,
    /// All columns are full.
    all: bool,
    /// No column has anything.
    none: bool,
}

/// Bounds of the mean height to which a body fills the columns on a rectangle. A mean that rounding brings to the height of the box or to
/// zero proves neither that they are full nor that they are empty: what is missing may be less than half an ulp of it.
struct ColumnFill<R> {
    lower: R,
    upper: R,
    /// The lines at all corners are inside the body at full height, and so are all between them.
    full: bool,
    /// No line reaches the part of the box that the body fills.
    empty: bool,
}

impl<R: Real> ColumnFill<R> {
    /// Not known to be full or empty.
    #[inline(always)]
    fn between(lower: R, upper: R) -> Self {
        ColumnFill { lower, upper, full: false, empty: false }
    }
}

/// The fill of the columns on a rectangle, from the lines at its corners and, if need be, in its middle. `full` is the height of the box.
#[inline(always)]
fn mean_fill<R: Real>(
    corners: [Option<ChordHeights<R>>; 4],
    middle: impl FnOnce() -> Option<ChordHeights<R>>,
    full: R,
) -> ColumnFill<R> {
    let [Some(a), Some(b), Some(c), Some(d)] = corners else {
        return ColumnFill::between(partial_fill(corners, full), full);
    };
    let (up, down) = ([a.up, b.up, c.up, d.up], [a.down, b.down, c.down, d.down]);
    let (up_full, down_full) = (all_above(up, full), all_above(down, full));
    if up_full && down_full {
        return ColumnFill { lower: full, upper: full, full: true, empty: false };
    }
    let Some(m) = middle() else { return ColumnFill::between(R::ZERO, full) };
    let up = if up_full { [full, full] } else { clamped_mean(up, m.up, full) };
    let down = if down_full { [full, full] } else { clamped_mean(down, m.down, full) };
    let [lower, upper] = [0, 1].map(|n: usize| (up[n] + (down[n] - full)).max(R::ZERO));
    ColumnFill { lower, upper, full: false, empty: up[1] == R::ZERO || down[1] == R::ZERO }
}

#[inline(always)]
fn all_above<R: Real>(h: [R; 4], limit: R) -> bool {
    h[0] >= limit && h[1] >= limit && h[2] >= limit && h[3] >= limit
}

/// Bounds of the mean of a concave function clamped to `0..=full`, from its values at the corners and in the middle.
#[inline(always)]
fn clamped_mean<R: Real>(h: [R; 4], middle: R, full: R) -> [R; 2] {
    let least = h[0].min(h[1]).min(h[2].min(h[3]));
    let most = middle + middle - least;
    if most <= R::ZERO {
        [R::ZERO, R::ZERO]
    } else if least >= R::ZERO && most <= full {
        [(h[0] + h[1] + (h[2] + h[3])) * R::from_f64(0.25), middle]
    } else {
        let over = h.map(|h| middle + middle - h);
        let [(lower, below), (upper, above)] = [h, over].map(|h| mean_over_triangles(h, full));
        [(lower - below).max(R::ZERO), (upper + above).min(full)]
    }
}

/// The mean over a square of the two triangles through its corners, clamped to `0..=full`; and what rounding may change of it beyond what the sums over
/// columns allow for.
///
/// Of a side that all but stands along the columns heights are as large as one likes. Those far above the box and those far below it do no harm if the means
/// are taken from the other end; both together leave what rounding makes of the smaller of them.
fn mean_over_triangles<R: Real>([a, b, c, d]: [R; 4], full: R) -> (R, R) {
    let (highest, lowest) = (a.max(b).max(c.max(d)), a.min(b).min(c.min(d)));
    let (over, under) = (highest - full, -lowest);
    let from_below = over <= under;
    let clamped = |x: R, y: R, z: R| {
        if from_below {
            mean_positive_part(x, y, z) - mean_positive_part(x - full, y - full, z - full)
        } else {
            full - (mean_positive_part(full - x, full - y, full - z) - mean_positive_part(-x, -y, -z))
        }
    };
    let mean = (clamped(a, b, c) + clamped(d, b, c)) * R::HALF;
    if !mean.is_finite() {
        return (R::ZERO, full);
    }
    let (mean, far) = (mean.max(R::ZERO).min(full), over.min(under));
    (mean, if far > full { far * (R::EPSILON * R::from_f64(MEAN_ROUNDINGS)) } else { R::ZERO })
}

/// Rounding of a mean over triangles, in units of ε times its largest term.
const MEAN_ROUNDINGS: f64 = 16.0;

/// The mean over a triangle of the positive part of a linear function with these values at the corners: sums of positive terms, which lose no digits.
fn mean_positive_part<R: Real>(x: R, y: R, z: R) -> R {
    let (low, high) = (x.min(y).min(z), x.max(y).max(z));
    let middle = x.min(y).max(x.max(y).min(z));
    let third = R::from_f64(1.0 / 3.0);
    if low >= R::ZERO {
        (low + middle + high) * third
    } else if high <= R::ZERO {
        R::ZERO
    } else if middle <= R::ZERO {
        // The part beyond the line where the function vanishes is a triangle of its own.
        high * (high / (high - middle)) * (high / (high - low)) * third
    } else {
        // All of it and the triangle beyond the line, whose terms cancel: (d (m² + m h + h²) + (m + h) m h) / (3 (d + m) (d + h)) with the depth d.
        let depth = -low;
        let (to_middle, to_high) = (depth + middle, depth + high);
        let squares = (middle / to_middle) * (middle + high) + high * (high / to_middle);
        third * (depth / to_high * squares + (middle + high) * (middle / to_middle) * (high / to_high))
    }
}

/// [`mean_fill`] where the line at a corner may miss the body. If the lines at three corners meet it, so do all lines over their triangle,
/// since the body is convex: half the rectangle gives a lower bound. Nothing is known from above.
#[cold]
fn partial_fill<R: Real>(corners: [Option<ChordHeights<R>>; 4], full: R) -> R {
    // Within the box and the body both are concave; below zero there is nothing inside.
    let depth = |h: ChordHeights<R>| h.up.min(full) + h.down.min(full) - full;
    let [a, b, c, d] = corners.map(|h| h.map(depth).filter(|&h| h >= R::ZERO));
    let third = |x: Option<R>, y: Option<R>, z: Option<R>| Some((x? + y? + z?) * R::from_f64(1.0 / 6.0));
    let half = third(a, b, c).or(third(b, d, a)).or(third(c, a, d)).or(third(d, b, c));
    half.unwrap_or(R::ZERO)
}

/// A side of the base, as far as the body reaches along it, divided into parts.
struct BaseAxis<R> {
    /// Where its parts begin and end; as many as there are parts, and one.
    at: [R; MAX_PARTS + 1],
    /// Length as a share of the cell's.
    share: R,
    /// Not more than [`MAX_PARTS`].
    parts: usize,
    flat: bool,
}

impl<R: Real> BaseAxis<R> {
    /// None if the body does not reach it.
    #[inline(always)]
    fn new<B>(place: &BoxInBody<B>, axis: usize, parts: usize) -> Option<Self>
    where
        B: Chords,
        B::Vector: Vector<Scalar = R>,
    {
        let (lo, hi) = (place.lo[axis].max(place.min[axis]), place.hi[axis].min(place.max[axis]));
        if !(lo <= hi) {
            return None;
        }
        if place.lo[axis] == place.hi[axis] {
            return Some(BaseAxis { at: [lo; MAX_PARTS + 1], share: R::ONE, parts: 1, flat: true });
        }
        let (share, parts) = ((hi - lo) / (place.hi[axis] - place.lo[axis]), parts.min(MAX_PARTS));
        let mut at = [hi; MAX_PARTS + 1];
        for i in 0..parts {
            at[i] = lo + (hi - lo) * (R::from_usize(i) / R::from_usize(parts));
        }
        (share > R::ZERO).then_some(BaseAxis { at, share, parts, flat: false })
    }
}
