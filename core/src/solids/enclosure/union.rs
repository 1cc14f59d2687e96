//! Bounds of the share of a box that a union of solids has.
//!
//! What is looked for is the excess: by how much the shares of the solids, which are known, sum to more than that of the union. Where one solid is alone there is
//! none, and where one holds a part of the box it is what the others have of it.

use super::constraint::{BoxAround, Constraint, Enclosure, MOST_CONSTRAINTS};
use super::filled::filled;
use crate::grid::bounds::Bounds;
use crate::number::plane::P2;
use crate::surface::MOST_PLANES;
use core::ops::Range;
use heapless::Vec;

/// How close bounds are wanted, and what that may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnionEffort {
    /// Bounds this far apart will do, as a share of the box.
    pub tol: f64,
    /// How many solids may be looked at in all parts of the box together; then the bounds are further apart.
    pub most: usize,
    /// So many times as many where that brings the bounds to `tol`, by how fast they have come closer.
    pub more: usize,
}

/// A solid that tells, for any box, polytopes within it and around it.
pub trait Enclosed {
    /// Tells what is known of each of its convex parts in a box.
    fn enclosures(&self, place: &BoxAround, tell: &mut impl FnMut(Enclosure));

    /// Is it known that inside a box it shares nothing with another one?
    fn is_apart(&self, other: &Self, place: &BoxAround) -> bool {
        let _ = (other, place);
        false
    }

    /// Its share of a box, as near as it is known.
    fn share(&self, place: &BoxAround) -> Bounds<f64>;

    /// How many boxes can be looked at in the time that this share takes.
    fn price(&self) -> f64;
}

/// Parts of solids whose union is measured at once.
const MOST_PARTS: usize = 3;

/// Parts of solids of which each two are looked at.
const MOST_PAIRED: usize = 12;

/// Constraints that they have together.
const MOST_AT_ONCE: usize = MOST_PARTS * MOST_CONSTRAINTS;

/// How often a box is halved at most.
const MOST_LEVELS: usize = 20;

/// Solids that the lists of all levels hold; where they are full, a part of a box looks at those of the box once more.
const MOST_LISTED: usize = 2048;

/// The first division is for no smaller tolerance; each further one for one at most so many times smaller.
const FIRST_TOLERANCE: f64 = 1e-2;
const FIRST_STEP: f64 = 1.0 / 8.0;
const FINER: f64 = 1.0 / 128.0;

/// So many times as many may be looked at until it is known how the cost grows.
const PROBED: usize = 4;

/// A division that costs this share of what may be spent, and brings the bounds no closer, is the last.
const VAIN: f64 = 1.0 / 16.0;

/// The power of the tolerance by which the cost grows is expected to become no more than this.
const FINER_GROWTH: f64 = 2.0 / 3.0;

/// Bounds of parts along a curve are as close as this share of the tolerance asks.
const ALONG_CURVE: f64 = 1.0 / 3.0;

/// Shares of solids beside one that holds a part are as close as this share of what parts along a curve are.
const BESIDE: f64 = 1.0 / 4.0;

/// What volumes of polytopes are rounded by.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Bounds that are this close are no more divided for.
const CLOSEST: f64 = 1e-12;

/// Bounds of the share of a box that the union of some solids has, from bounds of the sum of their shares. A box that is flat along an axis is a face.
pub fn union_bounds<E: Enclosed>(
    solids: &[E],
    sides: [[f64; 2]; 3],
    sum: Bounds<f64>,
    effort: UnionEffort,
) -> Bounds<f64> {
    let [lower, upper] = excess(solids, sides, effort);
    Bounds { lower: (sum.lower - upper).max(0.0), upper: (sum.upper - lower).min(1.0) }
}

/// Bounds of the sum of the shares that some solids have of a box, less that of their union.
pub fn excess<E: Enclosed>(solids: &[E], sides: [[f64; 2]; 3], effort: UnionEffort) -> [f64; 2] {
    let place = &BoxAround::new(sides);
    let tol = effort.tol;
    // How many until it is known how the cost grows, and how many where that brings the bounds to `tol`.
    let [at_first, all] = [PROBED, usize::MAX].map(|times| effort.most.saturating_mul(effort.more.min(times)));
    let mut most = effort.most;
    let mut found = [0.0, solids.len() as f64];
    let (mut looked_at, mut last) = (0, None);
    let mut enough = tol.max(FIRST_TOLERANCE);
    loop {
        let (bounds, cost) = divided(solids, place, enough * ALONG_CURVE, most.saturating_sub(looked_at));
        let before = found[1] - found[0];
        found = [found[0].max(bounds[0]), found[1].min(bounds[1])];
        let gap = found[1] - found[0];
        looked_at += cost;
        // By which power of the tolerance the cost grows: a third where surfaces meet along curves, one where they coincide. At first a small step tells.
        let growth = last.map(|(other, tol): (f64, f64)| libm::log(cost as f64 / other) / libm::log(tol / enough));
        let wanted = 0.7 * tol / gap;
        let payable = |most: usize, growth: f64| {
            let left = cost as f64 / most.saturating_sub(looked_at) as f64;
            libm::pow(left, 1.0 / growth.clamp(0.3, 1.5))
        };
        let (step, payable) = match growth {
            None => {
                most = if cost < most { at_first } else { most };
                (FIRST_STEP, payable(most, 1.0))
            }
            Some(growth) => {
                // In coarse parts a curve seems to cost more than it will.
                let pays = most == all || payable(all, growth.min(FINER_GROWTH)) <= wanted;
                most = if pays { all } else { effort.most };
                (FINER, payable(most, growth))
            }
        };
        let finer = f64::max(wanted.clamp(step, 0.5) * enough.min(gap), payable * enough);
        // Of solids much smaller than the box nothing is found out before its parts are as small as they are.
        let is_vain = |(other, _)| cost as f64 > f64::max(1.5 * other, most as f64 * VAIN);
        let in_vain = gap > 0.9 * before && last.is_some_and(is_vain);
        if gap <= tol || gap <= CLOSEST || !(finer <= 0.5 * enough) || in_vain || !(enough > CLOSEST) {
            // Bounds that contradict each other do so by rounding.
            return if gap >= 0.0 { found } else { bounds };
        }
        last = Some((cost as f64, enough));
        enough = finer;
    }
}

/// The excess in a part of a box.
enum Looked {
    Known(P2),
    /// Solids cut it, of which more than these bounds is not known.
    Cut(P2),
}

/// A part of a box, and the solids that may reach it.
struct Level {
    place: BoxAround,
    /// Where the solids are listed; none if all are meant.
    listed: Option<[usize; 2]>,
    /// Where the list ends that was there before its own.
    end: usize,
    /// Its own part to be looked at next.
    next: usize,
}

/// The walk through the parts of a box.
struct Walk<'a, E> {
    solids: &'a [E],
    lists: Vec<u32, MOST_LISTED>,
    looked_at: usize,
    sum: P2,
}

/// One division of a box into parts, those of each level with half the `room` between their bounds that those above it have; and how many solids were
/// looked at. After `most` of these nothing is divided any more.
fn divided<E: Enclosed>(solids: &[E], place: &BoxAround, room: f64, most: usize) -> (P2, usize) {
    let mut walk = Walk { solids, lists: Vec::new(), looked_at: 0, sum: [0.0; 2] };
    let axes = place.half.iter().filter(|h| **h > 0.0).count();
    let mut levels: Vec<Level, MOST_LEVELS> = Vec::new();
    let mut next = Some(Level { place: *place, listed: None, end: 0, next: 0 });
    while let Some(mut level) = next.take() {
        let depth = levels.len();
        let parts = (1_u64 << (depth * axes)) as f64;
        let close = room / (1_u64 << depth) as f64;
        let bounds = match walk.look(&mut level, close * parts) {
            Looked::Known(bounds) => Some(bounds),
            Looked::Cut(bounds) => {
                let gap = bounds[1] - bounds[0];
                // What is no number is not divided.
                (!(gap / parts > close && gap > CLOSEST) || walk.looked_at >= most || depth == MOST_LEVELS)
                    .then_some(bounds)
            }
        };
        match bounds {
            Some(bounds) => walk.add(bounds, parts, level.end),
            // There is room for it: see above.
            None => drop(levels.push(level)),
        }
        while let Some(level) = levels.last_mut() {
            if level.next < 1 << axes {
                next = Some(Level {
                    place: level.place.part(level.next),
                    listed: level.listed,
                    end: walk.lists.len(),
                    next: 0,
                });
                level.next += 1;
                break;
            }
            walk.lists.truncate(level.end);
            levels.pop();
        }
    }
    let [lower, upper] = walk.sum;
    let bounds = [lower * (1.0 - ROUNDING), upper * (1.0 + ROUNDING)];
    (if bounds[0] <= bounds[1] { bounds } else { [0.0, solids.len() as f64] }, walk.looked_at)
}

impl<'a, E: Enclosed> Walk<'a, E> {
    /// Where the solids of a part stand in its list, or in that of all.
    fn places(&self, level: &Level) -> Range<usize> {
        let [first, end] = level.listed.unwrap_or([0, self.solids.len()]);
        first..end
    }

    /// The solid in a place, with its number.
    fn solid(&self, level: &Level, at: usize) -> Option<(u32, &'a E)> {
        let number = if level.listed.is_some() { *self.lists.get(at)? } else { at as u32 };
        Some((number, self.solids.get(number as usize)?))
    }

    /// Adds the share of one of so many parts, and forgets its list.
    fn add(&mut self, bounds: P2, parts: f64, end: usize) {
        self.sum = [self.sum[0] + bounds[0] / parts, self.sum[1] + bounds[1] / parts];
        self.lists.truncate(end);
    }

    /// Looks at a part, and lists the solids that reach it. What is `close` need not be closer.
    fn look(&mut self, level: &mut Level, close: f64) -> Looked {
        let place = level.place;
        let (mut holding, mut cutting) = (0, 0);
        let mut parts = Parts::default();
        let (mut few, mut fits) = (true, true);
        for at in self.places(level) {
            let Some((number, solid)) = self.solid(level, at) else { continue };
            self.looked_at += 1;
            let (mut holds, mut reaches) = (false, false);
            solid.enclosures(&place, &mut |enclosure| {
                if let Enclosure::Within(constraints) = enclosure {
                    (holds, reaches) = (holds || constraints.is_empty(), true);
                    few = few && parts.push(number, constraints);
                }
            });
            if reaches {
                (holding, cutting) = (holding + usize::from(holds), cutting + usize::from(!holds));
                fits = self.lists.push(number).is_ok() && fits;
            }
        }
        if fits {
            level.listed = Some([level.end, self.lists.len()]);
        } else {
            self.lists.truncate(level.end);
        }
        match (holding, cutting) {
            (0, 0 | 1) => Looked::Known([0.0; 2]),
            (1.., 0) => Looked::Known([(holding - 1) as f64; 2]),
            (1.., _) => Looked::Known(self.beside_holder(level, holding, close)),
            _ if few => {
                let is_apart = |a: u32, b: u32| {
                    let [a, b] = [a, b].map(|n| self.solids.get(n as usize));
                    a.zip(b).is_some_and(|(a, b)| a.is_apart(b, &place))
                };
                let pairs = parts.find_meeting(is_apart);
                if parts.all.len() > MOST_PARTS {
                    // What two have in common counts as a look at a solid.
                    self.looked_at += pairs;
                }
                Looked::Cut(parts.excess(&place))
            }
            _ => Looked::Cut(self.beside_hub(level)),
        }
    }

    /// The excess in a part that many solids cut: not less than what one of them has in common with each of the others, and not more than
    /// all but the largest have.
    fn beside_hub(&mut self, level: &Level) -> P2 {
        let place = level.place;
        let mut hub: Option<(usize, Constraints)> = None;
        let (mut lower, mut sum, mut largest) = (0.0, 0.0, 0.0_f64);
        for at in self.places(level) {
            let Some((_, solid)) = self.solid(level, at) else { continue };
            self.looked_at += 1;
            solid.enclosures(&place, &mut |enclosure| {
                let Enclosure::Within(constraints) = enclosure else { return };
                let outer = share_of_polytope(constraints.iter(), false);
                (sum, largest) = (sum + outer, largest.max(outer));
                match &hub {
                    None => hub = Some((at, constraints)),
                    Some((other, _)) if *other == at => {}
                    Some((_, of_hub)) => lower += share_of_polytope(of_hub.iter().chain(&constraints), true),
                }
            });
        }
        let rounding = rounding_in(&place) * self.places(level).len() as f64;
        [f64::max(lower - rounding, 0.0), sum - largest + rounding]
    }

    /// The excess in a part that some solids hold: all but one of them, and the shares of the others.
    fn beside_holder(&mut self, level: &Level, holding: usize, close: f64) -> P2 {
        let mut sum = [(holding - 1) as f64; 2];
        for at in self.places(level) {
            let Some((_, solid)) = self.solid(level, at) else { continue };
            if let Some([lower, upper]) = share_of(solid, &level.place, BESIDE * close, &mut self.looked_at) {
                sum = [sum[0] + lower, sum[1] + upper];
            }
        }
        sum
    }
}

/// Bounds of the share of a part that a solid has which does not hold all of it; none if it does. By planes, in parts as many as are worth
/// it, until they are close; else as the solid knows it. Calls itself, once a level.
pub(super) fn share_of<E: Enclosed>(solid: &E, place: &BoxAround, close: f64, looked_at: &mut usize) -> Option<P2> {
    *looked_at += 1;
    let (mut parts, mut holds, mut few) = (Vec::<Constraints, MOST_PARTS>::new(), false, true);
    solid.enclosures(place, &mut |enclosure| {
        if let Enclosure::Within(constraints) = enclosure {
            holds = holds || constraints.is_empty();
            few = parts.push(constraints).is_ok() && few;
        }
    });
    if holds {
        return None;
    }
    let found = shares_of_polytopes(parts.iter().map(|part| part.iter()), place);
    let gap = found[1] - found[0];
    if few && gap <= close {
        return Some(found);
    }
    if !(gap <= close * solid.price()) || !few {
        let Bounds { lower, upper } = solid.share(place);
        return Some([lower, upper]);
    }
    let count = 1_usize << place.half.iter().filter(|h| **h > 0.0).count();
    let mut sum = [0.0; 2];
    for n in 0..count {
        // A surface reaches half of the parts.
        let [lower, upper] = share_of(solid, &place.part(n), 2.0 * close, looked_at).unwrap_or([1.0; 2]);
        sum = [sum[0] + lower, sum[1] + upper];
    }
    Some(sum.map(|s| s / count as f64))
}

/// Bounds of the sum of the shares of parts that have no volume in common, from polytopes within them and around them; of as many constraints each as a part has planes.
pub(super) fn shares_of_polytopes<'c, P: Iterator<Item = &'c Constraint> + Clone>(
    parts: impl Iterator<Item = P> + Clone,
    place: &BoxAround,
) -> P2 {
    let rounding = rounding_in(place);
    let [upper, lower]: P2 = [false, true].map(|rest| parts.clone().map(|part| share_of_polytope(part, rest)).sum());
    [f64::max(lower - rounding, 0.0), f64::min(upper + rounding, 1.0)]
}

/// Of a part of a solid.
type Constraints = Vec<Constraint, MOST_CONSTRAINTS>;

/// What shares of a box are rounded by.
fn rounding_in(place: &BoxAround) -> f64 {
    let shift = place.rounding();
    place.half.iter().filter(|half| **half > 0.0).fold(ROUNDING, |sum, half| sum + shift / half)
}

/// The share of a box in a polytope, from `rest` the one within or around the solid.
fn share_of_polytope<'c>(constraints: impl Iterator<Item = &'c Constraint> + Clone, rest: bool) -> f64 {
    match constraints.clone().count() {
        0 | 1 => filled::<1>(constraints, rest),
        2 => filled::<2>(constraints, rest),
        3 => filled::<3>(constraints, rest),
        4..=MOST_AT_ONCE => filled::<MOST_AT_ONCE>(constraints, rest),
        _ => filled::<MOST_PLANES>(constraints, rest),
    }
}

/// Parts of solids in a box.
#[derive(Default)]
struct Parts {
    all: Vec<Part, MOST_PAIRED>,
}

struct Part {
    /// The number of its solid.
    of: u32,
    constraints: Constraints,
    /// Which of the parts before it may have something in common with it, as bits.
    meeting: u32,
}

impl Parts {
    /// Adds a part, if there is room.
    fn push(&mut self, of: u32, constraints: Constraints) -> bool {
        self.all.push(Part { of, constraints, meeting: 0 }).is_ok()
    }

    /// Finds the parts that may have something in common: not those of one solid, nor of solids that are apart. Returns how many pairs.
    fn find_meeting(&mut self, is_apart: impl Fn(u32, u32) -> bool) -> usize {
        let mut pairs = 0;
        for n in 1..self.all.len() {
            let Some((part, before)) = self.all.get_mut(..=n).and_then(|parts| parts.split_last_mut()) else { break };
            let meets = |other: &Part| other.of != part.of && !is_apart(other.of, part.of);
            part.meeting = before.iter().enumerate().filter(|(_, other)| meets(other)).map(|(n, _)| 1 << n).sum();
            pairs += part.meeting.count_ones() as usize;
        }
        pairs
    }

    /// Bounds of the excess, from polytopes within the parts and around them: it grows with each of them.
    fn excess(&self, place: &BoxAround) -> P2 {
        let rounding = rounding_in(place) * self.all.len() as f64;
        let [upper, lower] = [false, true].map(|rest| self.excess_of_polytopes(rest));
        [f64::max(lower[0] - rounding, 0.0), upper[1] + rounding]
    }

    /// What two have in common counts; what three have has been counted three times. If they are too many for that, bounds.
    fn excess_of_polytopes(&self, rest: bool) -> P2 {
        let common = |of_set: &[&Part]| share_of_polytope(of_set.iter().flat_map(|p| &p.constraints), rest);
        let mut pairs = 0.0;
        // What each has in common with all others together.
        let mut of_each = [0.0_f64; MOST_PAIRED];
        let mut triples = 0.0;
        let mut meet_by_three = false;
        for (n, part) in self.all.iter().enumerate() {
            for (m, other) in self.all.iter().enumerate().take(n).filter(|(m, _)| part.meeting >> m & 1 == 1) {
                let share = common(&[part, other]);
                pairs += share;
                for one in [n, m] {
                    of_each.get_mut(one).into_iter().for_each(|sum| *sum += share);
                }
                let third = part.meeting & other.meeting;
                meet_by_three = meet_by_three || third != 0;
                if self.all.len() <= MOST_PARTS && share > 0.0 {
                    let first = self.all.first().filter(|_| third & 1 == 1);
                    triples += first.map_or(0.0, |first| common(&[part, other, first]));
                }
            }
        }
        if self.all.len() <= MOST_PARTS || !meet_by_three {
            return [pairs - triples; 2];
        }
        let shares = self.all.iter().map(|part| common(&[part]));
        let (sum, largest) = shares.fold((0.0, 0.0), |(sum, most), s| (sum + s, f64::max(most, s)));
        [of_each.into_iter().fold(0.0, f64::max), f64::min(pairs, sum - largest)]
    }
}
