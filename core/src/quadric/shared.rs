//! What solids share of a cell or face, each pair of them, each three: by how much the sum of their shares exceeds their union.
//!
//! Of faces it is the area that their sections have in common ([`super::slice`]), exact but for rounding. Of cells it is the integral of such
//! areas. The square root of the area in which planes cut a convex body is a concave function of the height (Brunn and Minkowski); so chords
//! between slices are lower bounds and the chords' extensions upper ones, and slices are added where these are apart.

use super::part::Part;
use super::slice::{Common, MOST_PARTS, Slice, Window};
use super::solid::QuadricSolid;
use crate::number::plane::{P2, others};
use crate::number::real::Real;
use heapless::Vec;

/// Most slices of what some parts have in common; and of them, most at hand at once.
const MOST_SLICES: usize = 1 << 16;
const MOST_AT_ONCE: usize = 64;

/// Most ranges of heights that wait to be looked at.
const MOST_RANGES: usize = 24;

/// Most parts of solids in one cell.
const MOST_AT_HAND: usize = 16;

/// Most sets of parts that are looked at.
const MOST_SETS: usize = 400;

/// A part of one of the solids, and where it may be in the cell.
#[derive(Clone, Copy)]
struct OnePart<'a> {
    solid: usize,
    part: &'a Part,
    extent: [P2; 3],
}

/// What both boxes hold.
fn meet(a: &[P2; 3], b: &[P2; 3]) -> [P2; 3] {
    [0, 1, 2].map(|n: usize| [a[n][0].max(b[n][0]), a[n][1].min(b[n][1])])
}

/// Bounds of the sum of the volumes of some solids in a cell, given by its low and high coordinates, less the volume of their union there; of
/// areas, if the cell is flat along one axis. The bounds are about `enough` apart, or more where that takes too long. None if there is
/// more in the cell than this is made for, or they are so large that rounding leaves nothing to rely on.
#[must_use]
pub fn excess<'a>(solids: impl IntoIterator<Item = &'a QuadricSolid>, cell: [P2; 3], enough: f64) -> Option<P2> {
    let flat = cell.iter().position(|[lo, hi]| lo == hi);
    let mut parts: Vec<OnePart, MOST_AT_HAND> = Vec::new();
    for (solid, body) in solids.into_iter().enumerate() {
        for part in body.parts() {
            let extent = meet(&cell, &[0, 1, 2].map(|n| part.extent(n)));
            if reaches(&extent, flat) {
                parts.push(OnePart { solid, part, extent }).ok()?;
            }
        }
    }
    let pairs = (0..parts.len())
        .flat_map(|b| (0..b).map(move |a| (a, b)))
        .filter(|&(a, b)| match (parts.get(a), parts.get(b)) {
            (Some(a), Some(b)) => a.solid != b.solid && reaches(&meet(&a.extent, &b.extent), flat),
            _ => false,
        })
        .count();
    let mut found = [0.0, 0.0];
    let mut pairs_left = pairs;
    // Sets of parts of different solids, each set after those that it holds.
    let mut set: Vec<usize, MOST_PARTS> = Vec::new();
    let (mut next, mut sets) = (0, 0);
    loop {
        if next >= parts.len() {
            match set.pop() {
                Some(last) => next = last + 1,
                None => return Some(found),
            }
            continue;
        }
        let one = parts.get(next)?;
        let of_set = || set.iter().filter_map(|&n| parts.get(n));
        let extent = of_set().fold(one.extent, |extent, other| meet(&extent, &other.extent));
        if of_set().any(|other| other.solid == one.solid) || !reaches(&extent, flat) {
            next += 1;
            continue;
        }
        if !set.is_empty() {
            sets += 1;
            // What is left of the tolerance, half of it for the pairs to come, each in turn.
            let left = (enough - (found[1] - found[0])).max(0.1 * enough);
            let share = if set.len() == 1 {
                pairs_left = pairs_left.saturating_sub(1);
                0.75 * left / (pairs_left + 1) as f64
            } else {
                0.125 * left
            };
            let all = || of_set().chain([one]).map(|p| p.part);
            let plane = flat.map(|n| (n, cell[n][0]));
            let [low, high] = if set.len() == 1 {
                common::<2>(all(), &extent, plane, share)
            } else {
                common::<MOST_PARTS>(all(), &extent, plane, share)
            };
            // Of huge solids rounding may leave nothing to rely on.
            if sets > MOST_SETS || !(low - high <= enough) {
                return None;
            }
            let [low, high] = [low.min(high), high.max(low)];
            // Pairs count, threes are taken back, and so on.
            let [more, less] = if set.len() % 2 == 1 { [low, high] } else { [-high, -low] };
            (found[0], found[1]) = (found[0] + more, found[1] + less);
            if !(high > 0.0) {
                next += 1;
                continue;
            }
        }
        set.push(next).ok()?;
        next += 1;
    }
}

/// Has a box an inside, or if it is flat along an axis, an area?
fn reaches(extent: &[P2; 3], flat: Option<usize>) -> bool {
    extent.iter().enumerate().all(|(n, [lo, hi])| lo < hi || (flat == Some(n) && lo == hi))
}

/// Bounds of the volume that up to `N` parts have in common in a box, or of the area in a plane across an axis at a coordinate.
fn common<'a, const N: usize>(
    parts: impl Iterator<Item = &'a Part> + Clone,
    extent: &[P2; 3],
    plane: Option<(usize, f64)>,
    enough: f64,
) -> P2 {
    let Some((n, coordinate)) = plane else { return volume::<N>(parts, extent, enough) };
    let window = window(extent, n, enough);
    match Slice::<N>::new(parts, window, coordinate).common() {
        Common::Area(bounds) => bounds,
        Common::NoRow(_) => [0.0; 2],
        Common::Apart([_, most]) => [0.0, most.max(0.0) * (window.v[1] - window.v[0])],
    }
}

fn window(extent: &[P2; 3], n: usize, enough: f64) -> Window {
    let [u, v] = others(n);
    Window { n, u: extent[u], v: extent[v], enough }
}

/// What a slice tells.
#[derive(Clone, Copy)]
enum Sample {
    NoRow(f64),
    Apart(P2),
    /// Bounds of the square root of the area, the lower one positive.
    Root(P2),
}

/// Bounds of the volume that up to `N` parts have in common in a box.
fn volume<'a, const N: usize>(parts: impl Iterator<Item = &'a Part> + Clone, extent: &[P2; 3], enough: f64) -> P2 {
    let n = across(parts.clone(), extent);
    let [first, last] = extent[n];
    let [u, v] = others(n);
    let all = (extent[u][1] - extent[u][0]) * (extent[v][1] - extent[v][0]);
    if all * (last - first) <= enough {
        return [0.0, all * (last - first)];
    }
    let within = window(extent, n, (0.125 * enough / (last - first)).min(1e-3 * all));
    let slice = |at: f64| match Slice::<N>::new(parts.clone(), within, at).common() {
        Common::NoRow(width) => Sample::NoRow(width),
        Common::Apart(bounds) => Sample::Apart(bounds),
        Common::Area([lower, upper]) if lower > 0.0 => Sample::Root([Real::sqrt(lower), Real::sqrt(upper)]),
        Common::Area([_, upper]) => Sample::Apart([0.0, upper / (within.v[1] - within.v[0])]),
    };
    let mut found = [0.0; 2];
    let mut waiting: Vec<(P2, f64), MOST_RANGES> = Vec::new();
    let _ = waiting.push(([first, last], enough));
    let mut spent = 0;
    while let Some((range, enough)) = waiting.pop() {
        let (bounds, slices) = in_range(&slice, range, [all, within.v[1] - within.v[0]], enough);
        spent += slices;
        let more = bounds[1] - bounds[0] > enough && spent < MOST_SLICES && waiting.len() + 2 <= MOST_RANGES;
        if more {
            let middle = 0.5 * (range[0] + range[1]);
            let _ = waiting.push(([middle, range[1]], 0.5 * enough));
            let _ = waiting.push(([range[0], middle], 0.5 * enough));
        } else {
            found = [found[0] + bounds[0], found[1] + bounds[1]];
        }
    }
    found
}

/// The same between two heights, of windows of an area `all` and a height `rows`, with slices at hand; and how many there were.
fn in_range(slice: &impl Fn(f64) -> Sample, [first, last]: P2, [all, rows]: P2, enough: f64) -> (P2, usize) {
    let mut samples: Vec<(f64, Sample), MOST_AT_ONCE> = Vec::new();
    for part in 0..=4 {
        let at = if part == 4 { last } else { first + (last - first) * (f64::from(part) / 4.0) };
        let _ = samples.push((at, slice(at)));
    }
    loop {
        let (mut total, mut wide) = ([0.0, 0.0], Vec::<bool, MOST_AT_ONCE>::new());
        let steps = samples.len() - 1;
        for at in 0..steps {
            let [low, high] = between(&samples, at, [all, rows]);
            total = [total[0] + low, total[1] + high];
            let _ = wide.push((high - low) * steps as f64 > 0.5 * enough);
        }
        let more = wide.iter().filter(|w| **w).count();
        if total[1] - total[0] <= enough || more == 0 || samples.len() + more > MOST_AT_ONCE {
            return (total, samples.len());
        }
        // From the last to the first, so that those before keep their places.
        for at in (0..steps).rev().filter(|at| wide.get(*at) == Some(&true)) {
            if let (Some(low), Some(high)) = (samples.get(at), samples.get(at + 1)) {
                let middle = 0.5 * (low.0 + high.0);
                let _ = samples.insert(at + 1, (middle, slice(middle)));
            }
        }
    }
}

/// The axis across which sections change least suddenly: that along which the parts' axes are shortest.
fn across<'a>(parts: impl Iterator<Item = &'a Part>, extent: &[P2; 3]) -> usize {
    let mut along = [0.0; 3];
    for part in parts {
        for (sum, a) in along.iter_mut().zip(part.curved.axis) {
            *sum += a.abs();
        }
    }
    let size = |n: usize| extent[n][1] - extent[n][0];
    let better = |a: usize, b: usize| (along[b], -size(b)) < (along[a], -size(a));
    (1..3).fold(0, |best, n| if better(best, n) { n } else { best })
}

/// Bounds of the volume between two slices, from them and those beside; `all` is the area of the window, `rows` its height.
fn between(samples: &[(f64, Sample)], at: usize, [all, rows]: P2) -> P2 {
    let one = |n: usize| samples.get(n).copied();
    let before = at.checked_sub(1).and_then(one);
    let (Some(from), Some(to), after) = (one(at), one(at + 1), one(at + 2)) else { return [0.0; 2] };
    let width = to.0 - from.0;
    let root = |s: (f64, Sample)| match s.1 {
        Sample::Root(bounds) => Some((s.0, bounds)),
        _ => None,
    };
    // A line through an upper bound at `near`, and beyond it a lower one: its values at both ends.
    let extended = |beyond: (f64, P2), near: (f64, P2)| {
        let slope = (near.1[1] - beyond.1[0]) / (near.0 - beyond.0);
        [from.0, to.0].map(|z| near.1[1] + slope * (z - near.0))
    };
    let line = |beyond: Option<(f64, Sample)>, near: (f64, Sample)| Some(extended(root(beyond?)?, root(near)?));
    let above = [line(before, from), line(after, to)];
    match (root(from), root(to)) {
        (None, None) => {
            // What is common lies between two planes: nothing beyond a plane in which there is nothing.
            let elsewhere = samples.iter().any(|s| root(*s).is_some());
            let nothing = |s: Sample| match s {
                Sample::NoRow(width) => width < 0.0,
                Sample::Apart([_, most]) => most < 0.0,
                Sample::Root(_) => false,
            };
            if elsewhere && (nothing(from.1) || nothing(to.1)) {
                return [0.0; 2];
            }
            let length = longest(before, from, to, after, |s| match s {
                Sample::Apart(bounds) => Some(bounds),
                _ => None,
            });
            let height = longest(before, from, to, after, |s| match s {
                Sample::NoRow(height) => Some([height; 2]),
                _ => None,
            });
            [0.0, all.min(length.max(0.0) * rows).min(height.max(0.0) * (all / rows)) * width]
        }
        (p, q) => {
            let low = |s: Option<(f64, P2)>| s.map_or(0.0, |s| s.1[0]);
            let lower = if p.is_some() && q.is_some() { squares(low(p), low(q)) * width } else { 0.0 };
            [lower, lowest(above, Real::sqrt(all)) * width]
        }
    }
}

/// An upper bound between two slices of what is concave over heights, from bounds in them and in those beside; infinite if nothing is known.
fn longest(
    before: Option<(f64, Sample)>,
    from: (f64, Sample),
    to: (f64, Sample),
    after: Option<(f64, Sample)>,
    value: impl Fn(Sample) -> Option<P2>,
) -> f64 {
    let line = |beyond: Option<(f64, Sample)>, near: (f64, Sample)| {
        let ((z, beyond), (y, near)) = ((beyond?.0, value(beyond?.1)?), (near.0, value(near.1)?));
        let slope = (near[1] - beyond[0]) / (y - z);
        Some([from.0, to.0].map(|z| near[1] + slope * (z - y)))
    };
    match [line(before, from), line(after, to)] {
        [None, None] => f64::INFINITY,
        [Some(l), None] | [None, Some(l)] => l[0].max(l[1]),
        [Some(l), Some(r)] => {
            let ends = l[0].min(r[0]).max(l[1].min(r[1]));
            crossing(l, r).map_or(ends, |at| ends.max(l[0] + (l[1] - l[0]) * at))
        }
    }
}

/// The share of the way at which two lines cross, if they do on it; lines by their values at both ends.
fn crossing(l: P2, r: P2) -> Option<f64> {
    let (p, q) = (l[0] - r[0], l[1] - r[1]);
    (p * q < 0.0).then(|| p / (p - q))
}

/// The mean of the squares of a linear function where it is positive, by its ends.
fn squares(p: f64, q: f64) -> f64 {
    let (low, high) = (p.min(q), p.max(q));
    if low >= 0.0 {
        (low * low + low * high + high * high) / 3.0
    } else if high <= 0.0 {
        0.0
    } else {
        high * high * (high / (high - low)) / 3.0
    }
}

/// The mean of the squares of the lowest of some lines, none higher than `most`.
fn lowest(lines: [Option<P2>; 2], most: f64) -> f64 {
    let flat = [most; 2];
    // Of one line only: where it is above the other it counts no more.
    let under = |l: P2, r: P2| match crossing(l, r) {
        Some(at) => {
            let middle = l[0] + (l[1] - l[0]) * at;
            squares(l[0].min(r[0]), middle) * at + squares(middle, l[1].min(r[1])) * (1.0 - at)
        }
        None if l[0] + l[1] < r[0] + r[1] => squares(l[0], l[1]),
        None => squares(r[0], r[1]),
    };
    match lines {
        [None, None] => most * most,
        [Some(l), None] | [None, Some(l)] => under(l, flat),
        [Some(l), Some(r)] => under(l, r).min(under(l, flat)).min(under(r, flat)),
    }
}
