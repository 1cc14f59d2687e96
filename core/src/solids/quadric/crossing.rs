//! What two or three pipes have in common of a box, by planes along the axes of two.
//!
//! Such a plane cuts a strip out of each pipe, as long as the pipe is between its flat ends. So what both have in common of the box is a polygon there,
//! and its sides move with the plane at speeds that are known. The square root of its area is a concave function of the plane's height (Brunn and
//! Minkowski), of which a polygon tells the value and the slope.
//!
//! Between two heights at which the same lines bound it, the volume is an integral with a proved error ([`super::panels`]). Elsewhere chords bound that root
//! from below and tangents from above, and planes are added where these are apart. So they are where a third pipe leaves only a part of the polygon
//! ([`super::third`]).
//!
//! Rounding moves each side by no more than [`Crossing::noise`], as if the body were that much larger or smaller, which is added to the bounds: a polygon
//! with sides so moved, and its slope, are those of such a body.

use super::moving::{Area, Known, Moving, Range};
use super::panels;
use super::part::Part;
use super::polygon::{Corner, Corners, Cut, Line, MOST_LINES, Strips, cut};
use super::sample::{Beyond, Polygon, Sample};
use super::third::{Apart, AtHeight, Left, Third};
use super::wall::Wall;
use crate::number::axis::Axis;
use crate::number::plane::{P2, cross, dot, sub};
use crate::number::real::Real;
use crate::number::space::{self, P3};
use core::f64::consts::PI;
use heapless::Vec;

/// The lines of both strips, and those of the first one's ends, come first.
const STRIPS: usize = 6;

/// Axes with a smaller sine between them are left to sections.
const LEAST_SINE: f64 = 1e-5;

/// Most planes asked for where the common part lies.
const MOST_TRIES: usize = 48;

/// Most planes, and how many times as many as a smooth body needs; most that wait to be reached, and how often bounds between planes are made closer.
const MOST_PLANES: f64 = 65536.0;
const PLANES: f64 = 16.0;
const MOST_WAITING: usize = 40;
const MOST_TIMES: usize = 4;

/// What three pipes may have in common, for what is enough, if planes alone are to tell.
const MOST_OF_THREE: f64 = 1e7;

/// Bounds between planes may be so far apart, as a share of what is enough, at first.
const LEAST: f64 = 1.0 / 64.0;

/// Bounds that are no more than so many times as far apart as they may be are made closer by planes alone: each halving leaves a quarter of that.
const NEARLY: f64 = 16.0;

/// Integrals may be off by this share of what is enough.
pub(super) const INTEGRALS: f64 = 1.0 / 32.0;

/// Most steps of Newton's method at one of the ends, and how far from it they begin, as a share of the heights.
const MOST_STEPS: usize = 8;
const NEAR_END: f64 = 1.0 / 32.0;

/// Rounding of lengths, as a share of the lengths that they are computed from.
pub(super) const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Sides of polygons are off by so many times as much as the lines that they lie on.
pub(super) const ROUNDED_SIDES: f64 = 64.0;

/// Areas of polygons whose sides are upright to each other are off as if their lines were off by so many times as much as they are.
pub(super) const ROUNDED_AREA: f64 = 8.0;

/// A sample that waits to be reached; and whether the volume between it and the one before is counted.
struct Reached {
    sample: Sample,
    counted: bool,
}

/// The second strip: where its middle crosses the first axis, how far that moves with the place beside that axis, how long it is along that for its
/// width, and its number of the side on which it begins.
#[derive(Clone, Copy, Debug)]
struct SecondStrip {
    middle: f64,
    lean: f64,
    stretch: f64,
    first: u8,
}

/// With a smaller sine between the axes rounding of where the strips meet counts.
const WELL_CROSSED: f64 = 0.25;

/// Two pipes that cross in a box.
#[derive(Debug)]
pub(super) struct Crossing {
    radii: P2,
    /// The heights of both axes.
    axes: P2,
    lines: Vec<Line, MOST_LINES>,
    /// How long the first strip is, at most; and whether it ends there before the second one limits it.
    along: P2,
    limited: [bool; 2],
    /// The second strip, where it is not all but parallel to the first.
    second: Option<SecondStrip>,
    /// A third pipe, the ends of which are lines too.
    third: Option<Third>,
    /// Heights between which both pipes and the box lie.
    heights: P2,
    /// By how much rounding may move a side.
    noise: f64,
    /// From the middle of the box to its corners.
    far: f64,
}

/// Radius, axis, and centre and inward sense of both ends, of a cylinder.
struct Pipe {
    radius: f64,
    axis: P3,
    /// From the middle of the box to the nearest point of the axis.
    foot: P3,
    /// Ends along the axis, from that point.
    ends: P2,
    reach: f64,
}

impl Pipe {
    fn new(part: &Part, extent: &[P2; 3]) -> Option<Self> {
        let Wall::Cylinder { radius } = part.curved.wall else { return None };
        let axis = part.curved.axis;
        let from = Axis::ALL.map(|n| 0.5 * ((extent[n][0] - part.origin[n]) + (extent[n][1] - part.origin[n])));
        let along = space::dot(from, axis);
        let foot = Axis::ALL.map(|n| along * axis[n] - from[n]);
        let mut ends = [f64::NEG_INFINITY, f64::INFINITY];
        for end in part.ends.iter().flatten() {
            let at = space::dot(end.shift, axis) - along;
            if space::dot(end.inward, axis) > 0.0 { ends[0] = ends[0].max(at) } else { ends[1] = ends[1].min(at) }
        }
        let reach = from.iter().map(|x| x.abs()).sum::<f64>() + radius;
        reach.is_finite().then_some(Pipe { radius, axis, foot, ends, reach })
    }
}

impl Crossing {
    /// Of two pipes in a box, and perhaps a third one; none if the two are nearly parallel, or the third runs nearly along both.
    fn new([one, other]: [&Pipe; 2], third: Option<&Pipe>, extent: &[P2; 3]) -> Option<Self> {
        let across = space::cross(one.axis, other.axis);
        let sine = space::length(across);
        if !(sine > LEAST_SINE) {
            return None;
        }
        // Rounding leaves it less upright to the axes than its length allows; upright to the first it is to the second too.
        let (lean, up) = (space::dot(across, one.axis), across);
        let up = space::unit(Axis::ALL.map(|n| up[n] - lean * one.axis[n]))?;
        let aside = space::cross(up, one.axis);
        let across = space::cross(up, other.axis);
        // Points of a plane by their places along the first axis and beside it, from that axis.
        let in_plane = |v: P3| [space::dot(v, one.axis), space::dot(v, aside)];
        let apart = space::sub(other.foot, one.foot);
        let (axes, radii) = ([0.0, space::dot(apart, up)], [one.radius, other.radius]);
        let half = Axis::ALL.map(|n| 0.5 * (extent[n][1] - extent[n][0]));
        let (size, far) = (half[0] + half[1] + half[2], space::length(half));
        let noise = ROUNDING * (one.reach + other.reach + size);
        let middle = -space::dot(one.foot, up);
        // Nothing is to be seen of a box that rounding may close.
        if !half.iter().all(|h| *h > 16.0 * ROUNDED_SIDES * noise) {
            return None;
        }
        let tall = half[0] * up[0].abs() + half[1] * up[1].abs() + half[2] * up[2].abs();
        let heights = [
            (-one.radius).max(axes[1] - other.radius).max(middle - tall),
            one.radius.min(axes[1] + other.radius).min(middle + tall),
        ];
        let mut found = Crossing {
            radii,
            axes,
            lines: Vec::new(),
            along: [0.0; 2],
            limited: [true; 2],
            second: None,
            third: None,
            heights,
            noise,
            far,
        };
        // The second strip, which limits the first one along its axis; so do its ends, and the box.
        let normal = in_plane(across);
        let place = dot(normal, in_plane(apart));
        let within = |middle: f64, half: f64, ends: P2| [ends[0].max(middle - half), ends[1].min(middle + half)];
        let long = (other.radius + normal[1].abs() * one.radius) / normal[0].abs();
        let along = within(-space::dot(one.foot, one.axis), size, one.ends);
        found.along = within(place / normal[0], long + noise / sine, along);
        let [one_over, lean] = [1.0 / normal[0], -normal[1] / normal[0]];
        if normal[0].abs() > WELL_CROSSED {
            let first = if normal[0] > 0.0 { 4 } else { 5 };
            found.second = Some(SecondStrip { middle: place * one_over, lean, stretch: one_over.abs(), first });
            found.limited = [found.along[0] == along[0], found.along[1] == along[1]];
        }
        found.add_first();
        for sign in [1.0, -1.0] {
            found.add(normal.map(|x| x * sign), -place * sign, 0.0, Some(1));
        }
        let (normal, from) = (in_plane(other.axis), space::dot(apart, other.axis));
        found.add(normal, -from - other.ends[0], 0.0, None);
        found.add(normal.map(|x| -x), from + other.ends[1], 0.0, None);
        if let Some(third) = third {
            let apart = space::sub(third.foot, one.foot);
            let in_space = |v: P3| [space::dot(v, one.axis), space::dot(v, aside), space::dot(v, up)];
            found.add_third(third, in_space(third.axis), in_space(apart))?;
        }
        for n in Axis::ALL {
            let normal = [one.axis[n], aside[n]];
            found.add(normal, half[n] + one.foot[n], up[n], None);
            found.add(normal.map(|x| -x), half[n] - one.foot[n], -up[n], None);
        }
        let finite = found.heights.iter().chain(&found.along).all(|x| x.is_finite());
        finite.then_some(found)
    }

    /// Bounds of the volume that two or three parts have in common in a box, about `enough` apart, or more where that takes too many planes or rounding does
    /// not allow it; none if they are no pipes, or lie nearly along each other. Not inlined: what it needs of the stack others need not carry.
    #[inline(never)]
    pub fn volume<'a>(mut parts: impl Iterator<Item = &'a Part>, extent: &[P2; 3], enough: f64) -> Option<P2> {
        let mut pipe = || parts.next().map(|part| Pipe::new(part, extent));
        let (one, other, third) = (pipe()??, pipe()??, pipe());
        let mut crossing = match (third, pipe()) {
            (None, _) => Self::new([&one, &other], None, extent),
            (Some(third), None) => Self::of_three(&[one, other, third?], extent),
            _ => None,
        }?;
        if !crossing.narrow(0.25 * enough)? {
            return Some([0.0, 0.25 * enough]);
        }
        crossing.drop_lines();
        let (long, [most, outline]) = (crossing.heights[1] - crossing.heights[0], crossing.most());
        if crossing.third.is_some() && most * long > MOST_OF_THREE * enough {
            return None;
        }
        let rounded = 4.0 * crossing.noise * (outline * long + 2.0 * most);
        let close = (enough - 2.0 * rounded).max(0.5 * enough);
        let planes = (PLANES * Real::sqrt(most * long / close)).clamp(512.0, MOST_PLANES) as usize;
        let (mut least, mut found) = (LEAST, None);
        for _ in 0..MOST_TIMES {
            let ([low, high], steps) = crossing.between_planes(most, close, least, planes);
            found = Some([(low - rounded).max(0.0), high + rounded]);
            if high - low <= close || steps >= planes {
                break;
            }
            least *= 0.125;
        }
        found
    }

    /// Of three pipes, by planes along the two with which rounding counts least.
    fn of_three(pipes: &[Pipe; 3], extent: &[P2; 3]) -> Option<Self> {
        let [a, b, c] = pipes;
        let across = |p: &Pipe, q: &Pipe| space::cross(p.axis, q.axis);
        let product = space::dot(across(a, b), c.axis).abs();
        let room = |p: &Pipe, q: &Pipe| {
            let sine = space::length(across(p, q));
            sine.min(product / sine)
        };
        let rooms = [room(a, b), room(b, c), room(c, a)];
        let (two, third) = if rooms[0] >= rooms[1] && rooms[0] >= rooms[2] {
            ([a, b], c)
        } else if rooms[1] >= rooms[2] {
            ([b, c], a)
        } else {
            ([c, a], b)
        };
        Self::new(two, Some(third), extent)
    }

    /// What is certain between two heights of a polygon at a third one.
    fn moving(&self, between: P2, height: f64, corners: &Corners, strips: &Strips) -> Option<Moving> {
        let half = between.map(|at| self.strips(at).half);
        let idle = u32::from(!self.limited[1]) << 1 | u32::from(!self.limited[0]) << 3;
        Moving::new(
            &Known { lines: &self.lines, idle, corners, height, strips },
            &Range { between, half, noise: self.noise },
        )
    }

    /// The same by planes such that the bounds between two of them are apart by no more than the share of the heights and the `least` share of
    /// what is enough, where the integral between two heights is not known; and how many planes that took, `planes` at most.
    fn between_planes(&self, most: f64, enough: f64, least: f64, planes: usize) -> (P2, usize) {
        let [first, last] = self.heights;
        let mut waiting: Vec<Reached, MOST_WAITING> = Vec::new();
        let _ = waiting.push(Reached { sample: self.sample(last, most), counted: false });
        let (mut below, mut a): (Option<Sample>, _) = (None, self.sample(first, most));
        let (mut steps, mut found) = (0, [0.0; 2]);
        while let Some(&Reached { sample: b, counted }) = waiting.last() {
            let above = waiting.len().checked_sub(2).and_then(|n| waiting.get(n)).map(|next| &next.sample);
            let [low, high] = if counted { [0.0; 2] } else { a.between(&b, [below.as_ref(), above], most) };
            let width = b.at - a.at;
            let allowed = enough * (0.5 * (width / (last - first)) + least);
            let far = high - low > allowed;
            let middle = a.at + 0.5 * width;
            let more = far && steps < planes && waiting.len() + 3 <= MOST_WAITING && a.at < middle && middle < b.at;
            if !more {
                found = [found[0] + low, found[1] + high];
                (below, a) = (Some(a), b);
                let _ = waiting.pop();
                continue;
            }
            steps += 1;
            if high - low <= NEARLY * allowed {
                let _ = waiting.push(Reached { sample: self.sample(middle, most), counted: false });
                continue;
            }
            let (sample, moving) = self.sample_and_moving(middle, most, [a.at, b.at]);
            let integral = moving.as_ref().and_then(|moving| self.integral(moving, enough));
            let (Some(moving), Some([low, high])) = (moving, integral) else {
                let _ = waiting.push(Reached { sample, counted: false });
                continue;
            };
            found = [found[0] + low, found[1] + high];
            // First what is above: the last one is the next to be reached.
            let [from, to] = moving.between;
            let reached = |at: f64, counted: bool| Reached { sample: self.sample_of(&moving, at, most), counted };
            if to < b.at {
                let _ = waiting.push(reached(to, true));
            } else if let Some(next) = waiting.last_mut() {
                next.counted = true;
            }
            if a.at < from {
                let _ = waiting.push(reached(from, false));
            }
        }
        (found, steps)
    }

    /// Bounds of the volume of a polygon between the heights at which it has the same sides, about `enough` apart if these were all; none where
    /// that takes long.
    fn integral(&self, moving: &Moving, enough: f64) -> Option<P2> {
        let ([first, last], [from, to]) = (self.heights, moving.between);
        let strips = [0, 1].map(|n| [self.axes[n] - self.radii[n], self.axes[n] + self.radii[n]]);
        let [_, outline] = self.most();
        let share = INTEGRALS * enough * ((to - from) / (last - first));
        let [volume, error] =
            if from < to { panels::volume(moving, [from, to], &strips, share)? } else { return None };
        let off = error + ROUNDED_AREA * self.noise / moving.sine * outline * (to - from);
        Some([(volume - off).max(0.0), volume + off])
    }

    fn sample(&self, at: f64, most: f64) -> Sample {
        Sample::new(at, &self.polygon(at, None).0, most)
    }

    /// A sample, and what is certain of its polygon between two heights.
    fn sample_and_moving(&self, at: f64, most: f64, between: P2) -> (Sample, Option<Moving>) {
        let (polygon, moving) = self.polygon(at, Some(between));
        (Sample::new(at, &polygon, most), moving)
    }

    /// A sample at a height where the sides of the polygon are known.
    fn sample_of(&self, moving: &Moving, at: f64, most: f64) -> Sample {
        let area = moving.area(at, &self.strips(at));
        let [_, outline] = self.most();
        Sample::new(at, &self.rooted(&area, outline), most)
    }

    /// The sides of the first strip between its ends, in the order of [`Crossing::first`].
    fn add_first(&mut self) {
        let [from, to] = self.along;
        let side = |normal: P2, offset: f64, strip: Option<usize>| Line { normal, offset, rise: 0.0, size: 1.0, strip };
        let sides = [
            side([0.0, 1.0], 0.0, Some(0)),
            side([-1.0, 0.0], to, None),
            side([0.0, -1.0], 0.0, Some(0)),
            side([1.0, 0.0], -from, None),
        ];
        self.lines.extend(sides);
    }

    /// A third pipe by its axis and a point of it in the coordinates of planes, the last one the height.
    fn add_third(&mut self, pipe: &Pipe, axis: P3, point: P3) -> Option<()> {
        let third = Third::new(pipe.radius, axis, point)?;
        self.noise = (self.noise + ROUNDING * pipe.reach) / third.rise;
        let (normal, from) = ([axis[0], axis[1]], space::dot(axis, point));
        self.add(normal, -from - pipe.ends[0], axis[2], None);
        self.add(normal.map(|x| -x), from + pipe.ends[1], -axis[2], None);
        self.third = Some(third);
        Some(())
    }

    /// Adds a line, unless all that both strips have in common is inside; one that is the same all along a plane limits the heights.
    fn add(&mut self, normal: P2, offset: f64, rise: f64, strip: Option<usize>) {
        let [low, high] = self.heights;
        let far = self.along[0].abs().max(self.along[1].abs());
        let wide = normal[0].abs() * far + normal[1].abs() * self.radii[0];
        let line = Line { normal, offset, rise, size: Real::sqrt(dot(normal, normal)), strip };
        if strip.is_none() {
            if self.is_inside(&line, self.radii) {
                return;
            }
            if wide <= self.noise && rise != 0.0 {
                let at = -offset / rise;
                self.heights = if rise > 0.0 { [low.max(at), high] } else { [low, high.min(at)] };
                return;
            }
        }
        let _ = self.lines.push(line);
    }

    /// Is all that both strips have in common between the heights inside a line, if these are nowhere wider than half a width tells?
    fn is_inside(&self, &Line { normal, offset, rise, .. }: &Line, half: P2) -> bool {
        let [low, high] = self.heights;
        let along = (normal[0] * self.along[0]).min(normal[0] * self.along[1]) - normal[1].abs() * half[0];
        let both = self.second.map_or(along, |second| {
            let beside = normal[1] + normal[0] * second.lean;
            normal[0] * second.middle - normal[0].abs() * half[1] * second.stretch - beside.abs() * half[0]
        });
        offset + (rise * low).min(rise * high) + along.max(both) >= -self.noise
    }

    /// Drops lines inside of which all lies now that the heights are narrower.
    fn drop_lines(&mut self) {
        let [low, high] = self.heights;
        let near = [0, 1].map(|n| self.strips(self.axes[n].limited(low, high)).half[n]);
        let mut number = STRIPS;
        while let Some(line) = self.lines.get(number) {
            if self.is_inside(line, near) {
                let Some(last) = self.lines.pop() else { break };
                if let Some(line) = self.lines.get_mut(number) {
                    *line = last;
                }
            } else {
                number += 1;
            }
        }
    }

    /// Of all heights, the largest area that there can be, and the longest outline: of a rectangle, and of a disc as wide as the box.
    fn most(&self) -> P2 {
        let [long, wide] = [(self.along[1] - self.along[0]).max(0.0), 2.0 * self.radii[0]];
        let (disc, outline) = (PI * self.far * self.far, 2.0 * PI * self.far);
        let ellipse = self.third.map_or(f64::INFINITY, |third| third.area);
        [disc.min(long * wide).min(ellipse), outline.min(2.0 * (long + wide))]
    }

    fn strips(&self, height: f64) -> Strips {
        let (mut half, mut growth) = ([0.0; 2], [0.0; 2]);
        for n in 0..2 {
            let off = height - self.axes[n];
            half[n] = Real::sqrt(((self.radii[n] - off) * (self.radii[n] + off)).max(0.0));
            growth[n] = -off / half[n];
        }
        Strips { half, growth }
    }

    /// What a plane has of both strips, or of the first one between its ends; and which lines may cut that.
    fn first(&self, [half, other]: P2) -> (Corners, impl Iterator<Item = usize>) {
        let mut corners = Corners::new();
        let mut add = |at: P2, line: u8| corners.push(Corner { at, line });
        let ([from, to], [low, high]) = (self.along, self.limited);
        let ends = if let Some(SecondStrip { middle, lean, stretch, first }) = self.second {
            let (shift, long) = (lean * half, stretch * other);
            let (below, above) = (middle - shift, middle + shift);
            let _ = (add([below - long, -half], 0), add([below + long, -half], 9 - first));
            let _ = (add([above + long, half], 2), add([above - long, half], first));
            [low.then_some(3), high.then_some(1)]
        } else {
            let _ = (add([from, -half], 0), add([to, -half], 1));
            let _ = (add([to, half], 2), add([from, half], 3));
            [Some(4), Some(5)]
        };
        (corners, ends.into_iter().flatten().chain(STRIPS..self.lines.len()))
    }

    /// What both have in common in the plane at a height; and, if asked, what is certain of that between two others.
    fn polygon(&self, height: f64, between: Option<P2>) -> (Polygon, Option<Moving>) {
        let strips = self.strips(height);
        if !(strips.half[0] > 0.0 && strips.half[1] > 0.0 && self.along[0] < self.along[1]) {
            return (Polygon::Nothing(None), None);
        }
        let (mut first, numbers) = self.first(strips.half);
        let (mut corners, mut kept) = (&mut first, &mut Corners::new());
        for number in numbers {
            let Some(line) = self.lines.get(number) else { break };
            match cut(corners, line.normal, line.place(height, &strips), number as u8, kept) {
                Cut::All => {}
                Cut::Part => core::mem::swap(&mut corners, &mut kept),
                Cut::None(nearest) => return (Polygon::Nothing(self.beyond(height, &strips, number, nearest)), None),
            }
        }
        if let Some(third) = &self.third {
            return (self.left_by(third, &AtHeight { corners, lines: &self.lines, height, strips: &strips }), None);
        }
        let moving = between.and_then(|between| self.moving(between, height, corners, &strips));
        (self.measured(corners, &strips), moving)
    }

    /// Area, and by how much it grows: the length of each side, as often as that moves outward.
    fn measured(&self, corners: &Corners, strips: &Strips) -> Polygon {
        let (mut area, mut rise) = (0.0, 0.0);
        let (mut outline, mut speed) = (0.0, 0.0);
        let Some(base) = corners.first() else { return Polygon::Nothing(None) };
        for (n, corner) in corners.iter().enumerate() {
            let Some(next) = corners.get(n + 1).or(corners.first()) else { break };
            let side = sub(next.at, corner.at);
            area += 0.5 * cross(sub(corner.at, base.at), side);
            let Some(line) = self.lines.get(usize::from(corner.line)) else { break };
            let growth = line.growth(strips);
            let length = Real::sqrt(dot(side, side));
            outline += length;
            if growth != 0.0 {
                let growth = growth / line.size;
                rise += growth * length;
                speed += growth.abs();
            }
        }
        self.rooted(&Area { value: area, rise, speed }, outline)
    }

    /// What a third pipe leaves of a polygon.
    fn left_by(&self, third: &Third, polygon: &AtHeight) -> Polygon {
        match third.of(polygon) {
            None => Polygon::Nothing(None),
            Some(Left::Area([value, rise, speed])) => self.rooted(&Area { value, rise, speed }, self.most()[1]),
            Some(Left::Nothing(Apart { missing, growth, weight })) => {
                Polygon::Nothing(Beyond::new(polygon.height, missing - self.noise * weight, growth))
            }
        }
    }

    /// The square root of an area of at most such an outline.
    fn rooted(&self, &Area { value: area, rise, speed }: &Area, outline: f64) -> Polygon {
        if !(area > 0.0) {
            return Polygon::Nothing(None);
        }
        // Of small polygons rounding turns the sides.
        let rounded = ROUNDED_SIDES * self.noise;
        let room = rounded * outline;
        let off = rounded * (speed + rise.abs() * (outline / area));
        let root = [(area - room).max(0.0), area + room].map(Real::sqrt);
        let rise = if area > 16.0 * room { [rise, off].map(|r| 0.5 * r / root[0]) } else { [f64::NAN; 2] };
        Polygon::Some { root, rise: [rise[0], rise[1] + rise[0].abs() * (room / area)] }
    }

    /// Heights at which there is nothing because a line leaves nothing of a polygon of which a corner, between two other lines, is the nearest to
    /// it: if the line's normal is a sum of theirs, turned and not negative, then so is what the line leaves at any height, at most.
    fn beyond(&self, height: f64, strips: &Strips, number: usize, [before, after]: [u8; 2]) -> Option<Beyond> {
        let line = self.lines.get(number)?;
        let [one, other] = [self.lines.get(usize::from(before))?, self.lines.get(usize::from(after))?];
        let turned = cross(one.normal, other.normal);
        let shares = [cross(other.normal, line.normal) / turned, cross(line.normal, one.normal) / turned];
        if !shares.iter().all(|s| s.is_finite() && *s >= -1e-12) {
            return None;
        }
        let sum = |of: &dyn Fn(&Line) -> f64| of(line) + shares[0] * of(one) + shares[1] * of(other);
        let missing = -sum(&|l| l.place(height, strips)) - self.noise * (1.0 + shares[0].abs() + shares[1].abs());
        let growth = sum(&|l| l.growth(strips));
        Beyond::new(height, missing, growth)
    }

    /// Narrows the heights to where there may be something, until there is; false if there is nothing but for a volume that does not count.
    /// None if that takes too long.
    fn narrow(&mut self, enough: f64) -> Option<bool> {
        let [most, _] = self.most();
        for _ in 0..MOST_TRIES {
            let [low, high] = self.heights;
            if !((high - low) * most > enough) {
                return Some(false);
            }
            let middle = 0.5 * (low + high);
            match self.polygon(middle, None).0 {
                Polygon::Some { .. } => {
                    self.narrow_ends();
                    return Some(true);
                }
                Polygon::Nothing(None) => return None,
                Polygon::Nothing(Some(Beyond::All)) => self.heights = [low, low],
                Polygon::Nothing(Some(Beyond::Below(at))) => self.heights = [at.max(middle), high],
                Polygon::Nothing(Some(Beyond::Above(at))) => self.heights = [low, at.min(middle)],
            }
        }
        None
    }

    /// Narrows the heights from both ends to where there is something not far from there: as Newton's method does, by tangents of what is missing.
    fn narrow_ends(&mut self) {
        for end in 0..2 {
            for _ in 0..MOST_STEPS {
                let [low, high] = self.heights;
                let near = self.heights[end] + (self.heights[1 - end] - self.heights[end]) * NEAR_END;
                let at = match (end, self.polygon(near, None).0) {
                    (0, Polygon::Nothing(Some(Beyond::Below(at)))) => at.limited(near, high),
                    (1, Polygon::Nothing(Some(Beyond::Above(at)))) => at.limited(low, near),
                    _ => break,
                };
                self.heights[end] = at;
            }
        }
    }
}
