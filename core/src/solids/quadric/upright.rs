//! What pipes along axes of the grid have in common of a box, or of a rectangle across one of these.
//!
//! In a plane across an axis, pipes along it have discs, others rectangles: what one disc and any number of rectangles have in common is a rectangle's share
//! of a disc. What two pipes along different axes have of a box are such areas, added up: a plane along both has a rectangle of them. Along each axis it is
//! as long as the pipe there and the box are, or as the other pipe's strip is wide. Between heights at which a strip is as wide as that reaches beside
//! its middle, such a length is a constant and a multiple of half the strip's width; so the
//! volume is an integral with a proved error ([`super::panels`]).
//!
//! Rounding moves each side by no more than the noise, as if the body were that much larger or smaller, which is added to the bounds.

use super::aligned::AlignedPipe;
use super::crossing::{INTEGRALS, ROUNDED_AREA, ROUNDED_SIDES, ROUNDING};
use super::moving::{Moving, Side};
use super::panels;
use super::part::Part;
use super::twofold::{difference, difference_of_squares};
use super::wall::Wall;
use crate::number::axis::Axis;
use crate::number::plane::P2;
use crate::number::real::Real;

/// A pipe along an axis of the grid: what it has of the box along that; how far rounding of lengths that it is made of goes.
struct Pipe<'a> {
    part: &'a Part,
    along: Axis,
    radius: f64,
    within: P2,
    reach: f64,
}

impl<'a> Pipe<'a> {
    fn new(part: &'a Part, extent: &[P2; 3]) -> Option<Self> {
        let (Wall::Cylinder { radius }, along) = (part.curved.wall, part.xi) else { return None };
        let mut within = extent[along];
        for end in part.ends.iter().flatten() {
            let at = end.center[along];
            within =
                if end.inward[along] > 0.0 { [within[0].max(at), within[1]] } else { [within[0], within[1].min(at)] };
        }
        let far = |n: Axis| (extent[n][0] - part.origin[n]).abs().max((extent[n][1] - part.origin[n]).abs());
        let reach = far(Axis::X) + far(Axis::Y) + far(Axis::Z) + radius;
        (part.curved.across[along] == 0.0 && reach.is_finite()).then_some(Pipe { part, along, radius, within, reach })
    }
}

/// The strip that a pipe has of planes, across which the other pipe runs: its middle's height, and the limits of the other from there.
struct Strip {
    radius: f64,
    height: f64,
    limits: P2,
}

impl Strip {
    /// Half its width at a height.
    fn half(&self, height: f64) -> f64 {
        let off = height - self.height;
        Real::sqrt(((self.radius - off) * (self.radius + off)).max(0.0))
    }

    /// Heights at which half its width is as far as a limit; its middle where it never is.
    fn breaks(&self) -> [f64; 4] {
        let off = self.limits.map(|limit| Real::sqrt(((self.radius - limit) * (self.radius + limit)).max(0.0)));
        [self.height - off[0], self.height - off[1], self.height + off[0], self.height + off[1]]
    }

    /// What the other pipe's limits leave of its width, as a sum that holds wherever half the width lies on the same sides of these.
    fn side(&self, half: f64) -> Side {
        let [low, high] = self.limits;
        let (from, to) = (-half > low, half < high);
        let constant = if to { 0.0 } else { high } - if from { 0.0 } else { low };
        Side { constant, multiple: f64::from(u8::from(from)) + f64::from(u8::from(to)) }
    }

    /// The most that [`Strip::side`] tells.
    fn longest(&self) -> f64 {
        let [low, high] = self.limits;
        (high.min(self.radius) - low.max(-self.radius)).max(0.0)
    }
}

/// Bounds of the area that some parts have in common of a rectangle across axis `n` at a coordinate; none if one of them is no pipe along an axis, or two have
/// discs.
pub(super) fn area<'a>(
    parts: impl Iterator<Item = &'a Part>,
    extent: &[P2; 3],
    (n, coordinate): (Axis, f64),
) -> Option<P2> {
    let plane = n.others();
    let mut sides = plane.map(|axis| [0.0, extent[axis][1] - extent[axis][0]]);
    let (mut disc, mut reach, mut nothing) = (None, sides[0][1] + sides[1][1], false);
    for part in parts {
        let pipe = Pipe::new(part, extent)?;
        reach += pipe.reach;
        if pipe.along == n {
            let ends = part.ends.iter().flatten();
            nothing |= ends.filter(|end| !end.closed).any(|end| end.center[n] == coordinate);
            nothing |= pipe.within[0] > pipe.within[1];
            if disc.replace(part).is_some() {
                return None;
            }
            continue;
        }
        let square = difference_of_squares(pipe.radius, difference(coordinate, part.origin[n]));
        nothing |= !(square > 0.0);
        let half = Real::sqrt(square.max(0.0));
        for (side, axis) in sides.iter_mut().zip(plane) {
            let from = extent[axis][0];
            let [low, high] = if axis == pipe.along {
                pipe.within.map(|end| end - from)
            } else {
                [part.origin[axis] - from - half, part.origin[axis] - from + half]
            };
            *side = [side[0].max(low), side[1].min(high)];
        }
    }
    let [long, wide] = sides.map(|[low, high]| (high - low).max(0.0));
    let noise = ROUNDED_AREA * f64::EPSILON * reach * (long + wide);
    let area = match disc {
        _ if nothing || !(long > 0.0 && wide > 0.0) => return Some([0.0; 2]),
        None => long * wide,
        Some(part) => {
            let shift = plane.map(|axis| extent[axis][0] - part.origin[axis]);
            AlignedPipe::new(part)?.area([0, 1].map(|at| sides[at].map(|x| x + shift[at])))
        }
    };
    Some([(area - noise).max(0.0), area + noise])
}

/// Bounds of the volume that two have in common, about `enough` apart; none if there are other than two parts, or no such pipes, or it takes too many panels. Not inlined: what it
/// needs of the stack others need not carry.
#[inline(never)]
pub(super) fn volume<'a>(mut parts: impl Iterator<Item = &'a Part>, extent: &[P2; 3], enough: f64) -> Option<P2> {
    let (one, other) = (Pipe::new(parts.next()?, extent)?, Pipe::new(parts.next()?, extent)?);
    let up = Axis::ALL.into_iter().find(|&n| n != one.along && n != other.along)?;
    if parts.next().is_some() || one.along == other.along {
        return None;
    }
    let [bottom, top] = extent[up];
    let strip = |pipe: &Pipe, across: &Pipe| Strip {
        radius: pipe.radius,
        height: pipe.part.origin[up] - bottom,
        limits: across.within.map(|limit| limit - pipe.part.origin[across.along]),
    };
    let strips = [strip(&one, &other), strip(&other, &one)];
    let size = Axis::ALL.into_iter().fold(0.0, |size, n| size + (extent[n][1] - extent[n][0]));
    let noise = ROUNDING * (one.reach + other.reach + size);
    if !extent.iter().all(|[low, high]| high - low > 32.0 * ROUNDED_SIDES * noise) {
        return None;
    }
    let heights = strips
        .iter()
        .fold([0.0, top - bottom], |[low, high], s| [low.max(s.height - s.radius), high.min(s.height + s.radius)]);
    let [first, last] = heights;
    let sides = [strips[0].longest(), strips[1].longest()];
    let (most, outline) = (sides[0] * sides[1], 2.0 * (sides[0] + sides[1]));
    let mut found = [0.0; 2];
    let breaks = strips.each_ref().map(Strip::breaks);
    let mut from = first;
    while from < last {
        let to = breaks.as_flattened().iter().filter(|&&at| from < at).fold(last, |to, &at| to.min(at));
        let share = INTEGRALS * enough * ((to - from) / (last - first));
        let [volume, error] = piece(&strips, [from, to], share)?;
        found = [found[0] + volume, found[1] + error];
        from = to;
    }
    let [volume, error] = found;
    let rounded = noise * ((ROUNDED_AREA + 4.0) * outline * (last - first).max(0.0) + 8.0 * most);
    Some([(volume - error - rounded).max(0.0), volume + error + rounded])
}

/// The volume between two such heights, and by how much it may be off but for rounding.
fn piece(strips: &[Strip; 2], [from, to]: P2, enough: f64) -> Option<P2> {
    let middle = 0.5 * (from + to);
    let half = [strips[0].half(middle), strips[1].half(middle)];
    let sides = [strips[0].side(half[0]), strips[1].side(half[1])];
    let [a, b] = [0, 1].map(|n| sides[n].constant + sides[n].multiple * half[n]);
    if !(a > 0.0 && b > 0.0) {
        return Some([0.0; 2]);
    }
    let within = |n: usize| [strips[n].height - strips[n].radius, strips[n].height + strips[n].radius];
    // A strip that does not count stands for the other.
    let ends = match sides.each_ref().map(|side| side.multiple > 0.0) {
        [true, true] => [within(0), within(1)],
        [true, false] => [within(0), within(0)],
        [false, true] => [within(1), within(1)],
        [false, false] => return Some([a * b * (to - from), 0.0]),
    };
    panels::volume(&Moving::rectangle([from, to], &sides), [from, to], &ends, enough)
}
