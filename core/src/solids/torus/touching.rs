//! Where lines of a plane touch a torus: between these the runs of the lines along it change smoothly.
//!
//! The normals across a direction e_u form a circle, N(t) = a cos t + b sin t, a across the axis. Each is the normal at two points, ± R d(ψ) + r N(t), d the
//! direction of what N has across the axis: tan ψ = w tan t, w what e_u has along the axis. So these points form two closed curves. Where w is small, ψ
//! turns fast where t rests and rests where t turns: the outermost of parallels and meridians. Along s = (t + ψ) / 2 neither turns faster than twice
//! s, for sin (t − ψ) = (1 − w) / (1 + w) sin 2 s. So pieces of the curves that cannot reach a part of the plane are known by their middles; the others are halved.

use super::ring::{Ring, length2};
use super::roots::root;
use crate::number::plane::P2;
use crate::number::real::Real;
use crate::number::space::{P3, dot};
use core::f64::consts::PI;
use heapless::Vec;

/// Coordinates in a plane where something changes.
pub(super) type Events = Vec<f64, 64>;

/// A rectangle of a plane across axis `n` at height `h`, its lines along `u`; the axes in the ring's frame.
pub(super) struct Lines {
    pub n: P3,
    pub u: P3,
    pub v: P3,
    pub h: f64,
    /// Along u and v.
    pub sides: [P2; 2],
}

/// One of the two curves.
struct Curve<'a> {
    ring: &'a Ring,
    lines: &'a Lines,
    /// Of R.
    sign: f64,
    /// Directions across the axis, those of a and of what b has.
    across: [P2; 2],
    /// What e_u has along and across the axis.
    slant: P2,
}

/// A point of it.
#[derive(Clone, Copy)]
struct Spot {
    s: f64,
    at: P3,
    /// Above the plane, and how it grows with s.
    height: f64,
    rate: f64,
    /// How far along the curve it bends sharply, if that is near.
    bend: f64,
}

/// Pieces of a curve at first.
const PIECES: u32 = 16;

/// Pieces that wait; each halving adds one.
const WAITING: usize = 64;

/// Half the longest piece in which the height has no more than one turn, in radians, and half the shortest that is halved.
const LONGEST: f64 = PI / 64.0;
const SHORTEST: f64 = 1e-7;

/// The same beside a bend, as a share of [`Spot::bend`].
const BESIDE_BEND: f64 = 0.05;

/// More pieces than any plane needs but those that nearly touch along a circle.
const MOST_PIECES: u32 = 3000;

/// What rounding makes of a height of zero, as a share of R.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Beside the plane the runs change fast if a curve comes nearer than this share of its height around.
const NEAR: f64 = 0.3;

/// How far beside a rectangle, as a share of its sizes, points are told, too: square roots that begin there are felt inside.
const BESIDE: f64 = 1.0 / 16.0;

impl Lines {
    /// The coordinates along v of the points in the rectangle, or beside it, where lines along u touch the torus.
    pub fn touched(&self, ring: &Ring, events: &mut Events) {
        let [x, y, z] = self.u;
        let size = length2([x, y]);
        let a = if size > 0.0 { [-y / size, x / size] } else { [1.0, 0.0] };
        let turn = if z < 0.0 { -1.0 } else { 1.0 };
        let across = [a, [-a[1] * turn, a[0] * turn]];
        for sign in [1.0, -1.0] {
            Curve { ring, lines: self, sign, across, slant: [z.abs(), size] }.follow(events);
        }
    }
}

impl Curve<'_> {
    fn spot(&self, s: f64) -> Spot {
        let ([w, up], radius, tube) = (self.slant, self.sign * self.ring.radius, self.ring.tube);
        let k = (1.0 - w) / (1.0 + w);
        let (sin, cos) = libm::sincos(s);
        let (sine, cosine) = (2.0 * k * sin * cos, k * (cos - sin) * (cos + sin));
        // Sine and cosine of t − ψ, and of half of it.
        let bend = length2([2.0 * Real::sqrt(w) / (1.0 + w), cosine]);
        let half = Real::sqrt((1.0 + bend) * 0.5);
        let [c, d] = [half, sine / (2.0 * half)];
        let faster = if bend > 0.0 { cosine / bend } else { 0.0 };
        let (of_t, of_psi) = ([cos * c - sin * d, sin * c + cos * d], [cos * c + sin * d, sin * c - cos * d]);
        let place = |[ct, st]: P2, [cp, sp]: P2, [tube, radius]: P2| {
            let (x, y) = (radius * cp + tube * ct, radius * sp + tube * w * st);
            let [a, b] = self.across;
            [x * a[0] + y * b[0], x * a[1] + y * b[1], tube * up * st]
        };
        let at = place(of_t, of_psi, [tube, radius]);
        let turned = |[c, s]: P2| [-s, c];
        let along = place(turned(of_t), turned(of_psi), [tube * (1.0 + faster), radius * (1.0 - faster)]);
        let n = self.lines.n;
        Spot { s, at, height: dot(n, at) - self.lines.h, rate: dot(n, along), bend }
    }

    fn follow(&self, events: &mut Events) {
        let mut waiting: Vec<P2, WAITING> = Vec::new();
        let half = PI / f64::from(PIECES);
        for n in 0..PIECES {
            let _ = waiting.push([(2.0 * f64::from(n) + 1.0) * half, half]);
        }
        let mut pieces = 0;
        while let Some([s, half]) = waiting.pop() {
            let middle = self.spot(s);
            if !self.may_reach(&middle, half) {
                continue;
            }
            pieces += 1;
            let short = half <= LONGEST.min((middle.bend * BESIDE_BEND).max(SHORTEST));
            if short || pieces > MOST_PIECES || waiting.len() + 2 > WAITING {
                self.piece(&[self.spot(s - half), self.spot(s + half)], events);
            } else {
                let quarter = half * 0.5;
                let _ = waiting.push([s - quarter, quarter]);
                let _ = waiting.push([s + quarter, quarter]);
            }
        }
    }

    /// May a piece of the curve reach the rectangle? No point of it is farther from its middle than twice R times half of s.
    fn may_reach(&self, middle: &Spot, half: f64) -> bool {
        let Lines { u, v, sides: [on_u, on_v], .. } = self.lines;
        let reach = 2.0 * self.ring.radius * (half * (1.0 + 1e-9) + 1e-14);
        let near = |axis: &P3, [lo, hi]: &P2| {
            let (x, room) = (dot(*axis, middle.at), reach + (hi - lo) * BESIDE);
            x >= lo - room && x <= hi + room
        };
        middle.height.abs() <= reach && near(u, on_u) && near(v, on_v)
    }

    /// Where the plane meets a piece in which the height turns once at most.
    fn piece(&self, [a, b]: &[Spot; 2], events: &mut Events) {
        if (a.rate > 0.0) == (b.rate > 0.0) {
            self.between(a, b, events);
            return;
        }
        let turn = self.spot(root(|s| self.spot(s).rate, [a.s, b.s], [a.rate, b.rate]));
        if self.between(a, &turn, events) | self.between(&turn, b, events) {
            return;
        }
        let higher = if a.height.abs() > b.height.abs() { a } else { b };
        let share = turn.height / (higher.height - turn.height);
        if share < NEAR {
            // The curve misses the plane; of imaginary s it meets it, and there square roots have their branches.
            let (v, [lo, hi]) = (dot(self.lines.v, turn.at), self.lines.sides[1]);
            let aside = (dot(self.lines.v, higher.at) - v).abs() * Real::sqrt(share);
            self.tell(v, events);
            if aside < (hi - lo) * BESIDE {
                self.tell(v - aside, events);
                self.tell(v + aside, events);
            }
        }
    }

    /// A root between two spots, or at one of them but for rounding; is there one?
    fn between(&self, a: &Spot, b: &Spot, events: &mut Events) -> bool {
        let mut on_end = false;
        for end in [a, b].into_iter().filter(|end| end.height.abs() <= ROUNDING * self.ring.radius) {
            self.tell(dot(self.lines.v, end.at), events);
            on_end = true;
        }
        let differ = (a.height > 0.0) != (b.height > 0.0);
        if differ {
            let s = root(|s| self.spot(s).height, [a.s, b.s], [a.height, b.height]);
            self.tell(dot(self.lines.v, self.spot(s).at), events);
        }
        differ || on_end
    }

    /// Once for all spots at one place.
    fn tell(&self, v: f64, events: &mut Events) {
        let [lo, hi] = self.lines.sides[1];
        let (size, room) = (hi - lo, (hi - lo) * BESIDE);
        if v > lo - room && v < hi + room && events.iter().all(|other| (v - other).abs() > 4.0 * f64::EPSILON * size) {
            let _ = events.push(v);
        }
    }
}

/// Where a chord of a disc about `center` of radius `tube` ends: the line `slope · p = constant`, p from the disc's centre.
pub(super) fn chord(slope: P2, constant: f64, tube: f64) -> Option<[P2; 2]> {
    let length = length2(slope);
    if !(length > 0.0) {
        return None;
    }
    let unit = slope.map(|x| x / length);
    let off = constant / length;
    let square = (tube - off) * (tube + off);
    if !(square > 0.0) {
        return None;
    }
    let half = Real::sqrt(square);
    Some([-half, half].map(|t| [unit[0] * off - unit[1] * t, unit[1] * off + unit[0] * t]))
}
