//! What solids share of a cell or face, each pair of them, each three: by how much the sum of their shares exceeds their union.
//!
//! Of faces it is the area that their sections have in common ([`super::slice`]), exact but for rounding. Of cells it is the integral of such
//! areas. The square root of the area in which planes cut a convex body is a concave function of the height (Brunn and Minkowski); so chords
//! between slices are lower bounds and the chords' extensions upper ones, and slices are added where these are apart.
//!
//! Pipes along one axis of the grid have the same slice everywhere; two others are looked at by planes along both of them ([`super::crossing`]; along
//! two axes of the grid, [`super::upright`]).

use super::balls;
use super::concave::{crossing, lowest, squares};
use super::crossing::Crossing;
use super::part::Part;
use super::slice::{MOST_PARTS, Slice, Window};
use super::solid::QuadricSolid;
use super::upright;
use super::wall::Wall;
use crate::grid::bounds::Bounds;
use crate::number::axis::Axis;
use crate::number::plane::P2;
use crate::number::real::Real;
use heapless::Vec;

/// Most slices of what some parts have in common, and how many times as many as a smooth surface needs; and of them, most at hand at once.
const MOST_SLICES: f64 = 65536.0;
const SLICES: f64 = 16.0;
const MOST_AT_ONCE: usize = 40;

/// Most ranges of heights that wait to be looked at.
const MOST_RANGES: usize = 24;

/// Most parts of solids in one cell.
const MOST_AT_HAND: usize = 16;

/// Most sets of parts that are looked at.
const MOST_SETS: usize = 400;

/// Areas that solids have in common are wanted this close, as a share of a face.
const CLOSE_AREAS: f64 = 1e-13;

/// Discs of balls are measured at once where that is so close, as a share of a face.
const CLOSE_DISCS: f64 = 1e-12;

/// A part of one of the solids, and where it may be in the cell.
#[derive(Clone, Copy)]
struct OnePart<'a> {
    solid: usize,
    part: &'a Part,
    extent: [P2; 3],
}

/// What both boxes hold.
fn meet(a: &[P2; 3], b: &[P2; 3]) -> [P2; 3] {
    Axis::ALL.map(|n| [a[n][0].max(b[n][0]), a[n][1].min(b[n][1])])
}

/// Bounds of the share of a cell or face that the union of some solids has, from bounds of the sum of their shares; of cells about `tol` apart, of
/// faces, and of cells that balls alone reach, as close as rounding allows. `cell` and none as in [`excess`]; none, too, if that takes more slices of cells than `most`.
#[must_use]
pub fn share_of_union<'a>(
    solids: impl IntoIterator<Item = &'a QuadricSolid, IntoIter: Clone>,
    cell: [P2; 3],
    sum: Bounds<f64>,
    tol: f64,
    most: usize,
) -> Option<Bounds<f64>> {
    let (mut size, mut close) = (1.0, tol);
    for [lo, hi] in cell {
        if lo < hi { size *= hi - lo } else { close = CLOSE_AREAS }
    }
    let solids = solids.into_iter();
    let of_balls = balls::union(solids.clone().flat_map(QuadricSolid::parts), cell)
        .filter(|[low, high]| low <= high)
        .map(|of| of.map(|x| (x / size).clamp(0.0, 1.0)))
        .map(|[lower, upper]| Bounds { lower, upper });
    // Sections of faces are exact, too, and keep more digits of balls that are large against them.
    let room = if close < tol { CLOSE_DISCS } else { tol };
    if let Some(found) = of_balls.filter(|found| found.gap() <= room) {
        return Some(found);
    }
    let Some([low, high]) = excess_within(solids, cell, close * size, most).map(|common| common.map(|x| x / size))
    else {
        return of_balls;
    };
    let (lower, upper) = ((sum.lower - high).max(0.0), (sum.upper - low).min(1.0));
    // Where rounding makes them contradict each other, what lies between them.
    let found = Bounds { lower: lower.min(upper), upper: lower.max(upper) };
    Some(of_balls.filter(|of| of.gap() < found.gap()).unwrap_or(found))
}

/// Bounds of the sum of the volumes of some solids in a cell, given by its low and high coordinates, less the volume of their union there; of
/// areas, if the cell is flat along one axis. The bounds are about `enough` apart, or more where that takes too long. None if there is
/// more in the cell than this is made for, or they are so large that rounding leaves nothing to rely on.
#[must_use]
pub fn excess<'a>(solids: impl IntoIterator<Item = &'a QuadricSolid>, cell: [P2; 3], enough: f64) -> Option<P2> {
    excess_within(solids, cell, enough, usize::MAX)
}

/// The same; none if it takes more than so many slices.
fn excess_within<'a>(
    solids: impl IntoIterator<Item = &'a QuadricSolid>,
    cell: [P2; 3],
    enough: f64,
    mut slices: usize,
) -> Option<P2> {
    let flat = Axis::ALL.into_iter().find(|&n| cell[n][0] == cell[n][1]);
    let mut parts: Vec<OnePart, MOST_AT_HAND> = Vec::new();
    for (solid, body) in solids.into_iter().enumerate() {
        for part in body.parts() {
            let extent = meet(&cell, &part.extents());
            if reaches(&extent, flat) {
                parts.push(OnePart { solid, part, extent }).ok()?;
            }
        }
    }
    let plane = flat.map(|n| (n, cell[n][0]));
    let mut found = [0.0, 0.0];
    let mut left = SetsLeft::new(&parts, flat);
    // Sets of parts of different solids, each set after those that it holds.
    let mut set: Vec<usize, MOST_PARTS> = Vec::new();
    // No more than the first two of these have in common, the first three, and so on.
    let mut holding: Vec<f64, MOST_PARTS> = Vec::new();
    let (mut next, mut sets) = (0, 0);
    loop {
        if next >= parts.len() {
            let Some(last) = set.pop() else { return Some(found) };
            holding.truncate(set.len().saturating_sub(1));
            next = last + 1;
            continue;
        }
        let one = parts.get(next)?;
        let of_set = || set.iter().filter_map(|&n| parts.get(n));
        let extent = of_set().fold(one.extent, |extent, other| meet(&extent, &other.extent));
        if of_set().any(|other| other.solid == one.solid) {
            next += 1;
            continue;
        }
        let extent = if set.is_empty() { extent } else { narrowed(of_set().chain([one]), extent) };
        if !reaches(&extent, flat) {
            next += 1;
            continue;
        }
        if !set.is_empty() {
            sets += 1;
            let share = left.share((enough - (found[1] - found[0])).max(0.1 * enough), set.len());
            let most = holding.last().copied().unwrap_or(f64::INFINITY);
            let [low, high] = match plane {
                None if most <= share => [0.0, most],
                _ => common_of(of_set().chain([one]), &extent, plane, share, &mut slices),
            };
            if slices == 0 && high - low > share {
                return None;
            }
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
            holding.push(high).ok()?;
        }
        set.push(next).ok()?;
        next += 1;
    }
}

/// The box in which some parts may have something in common: each of them in the box that those before it leave.
fn narrowed<'a>(parts: impl Iterator<Item = &'a OnePart<'a>> + Clone, extent: [P2; 3]) -> [P2; 3] {
    let once = |extent| parts.clone().fold(extent, |extent, one| one.part.extent_within(extent));
    once(once(extent))
}

/// How many pairs and threes of parts of different solids may still have something in common.
struct SetsLeft {
    pairs: usize,
    threes: usize,
}

/// A set of three parts is bounded less easily than pairs, by so many of them.
const HARDER: usize = 4;

impl SetsLeft {
    fn new(parts: &[OnePart], flat: Option<Axis>) -> Self {
        let meets = |a: &OnePart, b: &OnePart| a.solid != b.solid && reaches(&meet(&a.extent, &b.extent), flat);
        let mut left = SetsLeft { pairs: 0, threes: 0 };
        for (n, c) in parts.iter().enumerate() {
            for (m, b) in parts.iter().take(n).enumerate().filter(|(_, b)| meets(b, c)) {
                left.pairs += 1;
                left.threes += parts.iter().take(m).filter(|a| meets(a, b) && meets(a, c)).count();
            }
        }
        left
    }

    /// How far apart the bounds of a set may be, out of the tolerance that is `left`; `others` counts its parts but the last. More than three parts get an
    /// eighth; the others share three quarters, each three as much as some pairs, with all that are still to come.
    fn share(&mut self, left: f64, others: usize) -> f64 {
        let weight = match others {
            1 => 1,
            2 => HARDER,
            _ => return 0.125 * left,
        };
        let all = (self.pairs + HARDER * self.threes).max(weight);
        let count = if others == 1 { &mut self.pairs } else { &mut self.threes };
        *count = count.saturating_sub(1);
        0.75 * left * (weight as f64 / all as f64)
    }
}

/// Bounds of what some parts have in common in a box, or in a plane.
fn common_of<'a>(
    parts: impl Iterator<Item = &'a OnePart<'a>> + Clone,
    extent: &[P2; 3],
    plane: Option<(Axis, f64)>,
    share: f64,
    slices: &mut usize,
) -> P2 {
    let all = parts.clone().map(|p| p.part);
    if parts.count() == 2 {
        common::<2>(all, extent, plane, share, slices)
    } else {
        common::<MOST_PARTS>(all, extent, plane, share, slices)
    }
}

/// Has a box an inside, or if it is flat along an axis, an area?
fn reaches(extent: &[P2; 3], flat: Option<Axis>) -> bool {
    Axis::ALL.into_iter().zip(extent).all(|(n, [lo, hi])| lo < hi || (flat == Some(n) && lo == hi))
}

/// Bounds of the volume that up to `N` parts have in common in a box, or of the area in a plane across an axis at a coordinate; `slices` as in [`volume`].
fn common<'a, const N: usize>(
    parts: impl Iterator<Item = &'a Part> + Clone,
    extent: &[P2; 3],
    plane: Option<(Axis, f64)>,
    enough: f64,
    slices: &mut usize,
) -> P2 {
    let Some((n, coordinate)) = plane else {
        let all = extent.iter().fold(1.0, |all, [lo, hi]| all * (hi - lo));
        if all <= 0.25 * enough {
            return [0.0, all];
        }
        let of_upright = || upright::volume(parts.clone(), extent, enough);
        let of_pipes = || Crossing::volume(parts.clone(), extent, enough);
        let found = prism::<N>(parts.clone(), extent, enough).or_else(of_upright).or_else(of_pipes);
        return match found {
            Some([low, high]) if high - low <= enough => [low, high],
            Some(found) => narrower(found, volume::<N>(parts, extent, enough, slices)),
            None => volume::<N>(parts, extent, enough, slices),
        };
    };
    upright::area(parts.clone(), extent, (n, coordinate))
        .unwrap_or_else(|| Slice::<N>::new(parts, window(extent, n, enough), coordinate).common().area)
}

/// What two bounds of a number leave of it; the closer ones where they contradict each other by rounding.
fn narrower(a: P2, b: P2) -> P2 {
    let both = [a[0].max(b[0]), a[1].min(b[1])];
    match both {
        [low, high] if low <= high => both,
        _ if a[1] - a[0] <= b[1] - b[0] => a,
        _ => b,
    }
}

fn window(extent: &[P2; 3], n: Axis, enough: f64) -> Window {
    let [u, v] = n.others();
    Window { n, u: extent[u], v: extent[v], enough }
}

/// What a slice tells: bounds of the square root of its area, and the rest of [`Common`](super::slice::Common).
#[derive(Clone, Copy)]
struct Sample {
    at: f64,
    root: P2,
    height: P2,
    length: P2,
}

impl Sample {
    /// The bounds of the square root of the area, if it is certain that there is one.
    fn root(&self) -> Option<P2> {
        (self.root[0] > 0.0).then_some(self.root)
    }

    /// Bounds of the square root of the area, the lower one only if it is certain that something is in it: concave over those heights.
    fn root_within(&self) -> P2 {
        let [low, high] = self.root;
        [if low > 0.0 || self.length[0] > 0.0 { low } else { f64::NEG_INFINITY }, high]
    }

    /// Is it certain that there is nothing in it?
    fn is_empty(&self) -> bool {
        self.height[1] < 0.0 || self.length[1] < 0.0
    }
}

/// Bounds of the volume that up to `N` parts have in common in a box; `left` is how many slices there may still be.
fn volume<'a, const N: usize>(
    parts: impl Iterator<Item = &'a Part> + Clone,
    extent: &[P2; 3],
    enough: f64,
    left: &mut usize,
) -> P2 {
    let n = across(parts.clone(), extent);
    let [first, last] = extent[n];
    let [u, v] = n.others();
    let all = (extent[u][1] - extent[u][0]) * (extent[v][1] - extent[v][0]);
    if all * (last - first) <= enough {
        return [0.0, all * (last - first)];
    }
    let within = window(extent, n, (0.125 * enough / (last - first)).min(1e-3 * all));
    let slice = |at: f64| {
        let found = Slice::<N>::new(parts.clone(), within, at).common();
        Sample { at, root: found.area.map(Real::sqrt), height: found.height, length: found.length }
    };
    let most = (SLICES * Real::sqrt(all * (last - first) / enough)).clamp(512.0, MOST_SLICES) as usize;
    let most = most.min(*left);
    let mut found = [0.0; 2];
    let mut waiting: Vec<(P2, f64), MOST_RANGES> = Vec::new();
    let _ = waiting.push(([first, last], enough));
    let mut spent = 0;
    while let Some((range, enough)) = waiting.pop() {
        let (bounds, slices) = in_range(&slice, range, [all, within.v[1] - within.v[0]], enough);
        spent += slices;
        let more = bounds[1] - bounds[0] > enough && spent < most && waiting.len() + 2 <= MOST_RANGES;
        if more {
            let middle = 0.5 * (range[0] + range[1]);
            let _ = waiting.push(([middle, range[1]], 0.5 * enough));
            let _ = waiting.push(([range[0], middle], 0.5 * enough));
        } else {
            found = [found[0] + bounds[0], found[1] + bounds[1]];
        }
    }
    *left = left.saturating_sub(spent);
    found
}

/// Bounds of the volume that pipes along one axis of the grid have in common in a box: all sections across it are the same. None of other parts.
#[inline(never)]
fn prism<'a, const N: usize>(
    parts: impl Iterator<Item = &'a Part> + Clone,
    extent: &[P2; 3],
    enough: f64,
) -> Option<P2> {
    let n = parts.clone().next()?.xi;
    let [mut low, mut high] = extent[n];
    for part in parts.clone() {
        if !matches!(part.curved.wall, Wall::Cylinder { .. }) || part.curved.across[n] != 0.0 {
            return None;
        }
        for end in part.ends.iter().flatten() {
            if end.inward[n] > 0.0 { low = low.max(end.center[n]) } else { high = high.min(end.center[n]) }
        }
    }
    if !(low < high) {
        return Some([0.0; 2]);
    }
    let long = high - low;
    let within = window(extent, n, 0.5 * enough / long);
    Some(Slice::<N>::new(parts, within, 0.5 * (low + high)).common().area.map(|area| area * long))
}

/// The same between two heights, of windows of an area `all` and a height `rows`, with slices at hand; and how many there were.
fn in_range(slice: &impl Fn(f64) -> Sample, [first, last]: P2, [all, rows]: P2, enough: f64) -> (P2, usize) {
    let mut samples: Vec<Sample, MOST_AT_ONCE> = Vec::new();
    for part in 0..=4 {
        let at = if part == 4 { last } else { first + (last - first) * (f64::from(part) / 4.0) };
        let _ = samples.push(slice(at));
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
                let mut moved = slice(0.5 * (low.at + high.at));
                samples.iter_mut().skip(at + 1).for_each(|later| core::mem::swap(later, &mut moved));
                let _ = samples.push(moved);
            }
        }
    }
}

/// The axis across which sections change least suddenly: that along which the parts' axes are shortest.
fn across<'a>(parts: impl Iterator<Item = &'a Part>, extent: &[P2; 3]) -> Axis {
    let mut along = [0.0; 3];
    for part in parts {
        for (sum, a) in along.iter_mut().zip(part.curved.axis) {
            *sum += a.abs();
        }
    }
    let size = |n: Axis| extent[n][1] - extent[n][0];
    let better = |a: Axis, b: Axis| (along[b], -size(b)) < (along[a], -size(a));
    [Axis::Y, Axis::Z].into_iter().fold(Axis::X, |best, n| if better(best, n) { n } else { best })
}

/// Bounds of the volume between two slices, from them and those beside; `all` is the area of the window, `rows` its height.
fn between(samples: &[Sample], at: usize, [all, rows]: P2) -> P2 {
    let one = |n: usize| samples.get(n).copied();
    let (Some(from), Some(to)) = (one(at), one(at + 1)) else { return [0.0; 2] };
    let beside = [at.checked_sub(1).and_then(one), Some(from), Some(to), one(at + 2)];
    let width = to.at - from.at;
    let mean = lowest(lines(beside, |s| s.root_within()), Real::sqrt(all));
    match (from.root(), to.root()) {
        (None, None) => {
            // What is common lies between two planes: nothing beyond a plane in which there is nothing.
            let some = |mut samples: core::slice::Iter<'_, Sample>| samples.any(|s| s.root().is_some());
            let [before, after] = [samples.get(..=at), samples.get(at + 1..)].map(Option::unwrap_or_default);
            if (from.is_empty() && some(before.iter())) || (to.is_empty() && some(after.iter())) {
                return [0.0; 2];
            }
            let length = greatest(lines(beside, |s| s.length));
            let height = greatest(lines(beside, |s| s.height));
            [0.0, mean.min(length.max(0.0) * rows).min(height.max(0.0) * (all / rows)) * width]
        }
        (p, q) => {
            let lower = if let (Some(p), Some(q)) = (p, q) { squares(p[0], q[0]) * width } else { 0.0 };
            [lower, mean * width]
        }
    }
}

/// Upper bounds of what is concave over heights between the middle two of four slices, by their values there: lines through a lower bound in
/// an outer one and an upper bound in the one next to it; none where these are infinite.
fn lines(beside: [Option<Sample>; 4], value: impl Fn(Sample) -> P2) -> [Option<P2>; 2] {
    let line = |beyond: Option<Sample>, near: Option<Sample>, far: Option<Sample>| {
        let (beyond, near, far) = (beyond?, near?, far?);
        let ([lower, _], [_, upper]) = (value(beyond), value(near));
        let there = upper + (upper - lower) / (near.at - beyond.at) * (far.at - near.at);
        there.is_finite().then_some([upper, there])
    };
    let [before, from, to, after] = beside;
    [line(before, from, to), line(after, to, from).map(|[near, far]| [far, near])]
}

/// The greatest value of the lower of two lines; infinite if there is none.
fn greatest(lines: [Option<P2>; 2]) -> f64 {
    match lines {
        [None, None] => f64::INFINITY,
        [Some(l), None] | [None, Some(l)] => l[0].max(l[1]),
        [Some(l), Some(r)] => {
            let ends = l[0].min(r[0]).max(l[1].min(r[1]));
            crossing(l, r).map_or(ends, |at| ends.max(l[0] + (l[1] - l[0]) * at))
        }
    }
}
