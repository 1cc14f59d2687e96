//! A torus, or a part of a turn of one between two flat ends: what lines have of it.
//!
//! Points are told from the centre, lines by their points along a coordinate axis. In the ring's own frame, z along the axis, the torus is where
//! (ρ − R)² + z² <= r², ρ the distance from the axis. Along a line that is a quartic; between the roots of its derivative, a cubic without
//! square term, it has one root at most, and between those of the cubic's derivative so has the cubic.

use super::roots::newton_root;
use crate::number::axis::Axis;
use crate::number::plane::{self, P2};
use crate::number::real::Real;
use crate::number::space::{P3, dot};
use heapless::Vec;

/// What rounding leaves of a component that is zero, of vectors of length 1.
pub(super) const NOISE: f64 = 4.0 * f64::EPSILON;

/// Length of a vector; exact if one component is zero.
#[inline(always)]
pub(super) fn length2(a: P2) -> f64 {
    if a[0] == 0.0 || a[1] == 0.0 { a[0].abs() + a[1].abs() } else { Real::sqrt(plane::dot(a, a)) }
}

/// The angle by which one direction lies before another, −π to π.
#[inline(always)]
pub(super) fn ahead(q: P2, of: P2) -> f64 {
    libm::atan2(plane::cross(of, q), plane::dot(of, q))
}

/// Flat ends, in planes through the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ends {
    /// Unit normals into the solid, of its start and its end.
    pub inward: [P3; 2],
    /// Directions of both from the axis, in the ring's plane.
    pub toward: [P2; 2],
    /// More than half a turn lies between them.
    pub wide: bool,
    /// Direction of the middle between them.
    pub middle: P2,
}

/// A torus or a part of one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ring {
    pub center: P3,
    /// Unit vectors: towards the start, a quarter of a turn on, and the axis.
    pub frame: [P3; 3],
    /// Of the circle in the middle of the tube.
    pub radius: f64,
    pub tube: f64,
    /// None of a whole torus.
    pub ends: Option<Ends>,
}

/// A line along a coordinate axis, in the ring's frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub at: P3,
    pub along: P3,
}

impl Line {
    #[inline(always)]
    pub fn point(&self, t: f64) -> P3 {
        Axis::ALL.map(|n| self.at[n] + t * self.along[n])
    }
}

/// Pieces of a line, ascending.
pub(super) type Runs = Vec<[f64; 2], 6>;

impl Ring {
    #[inline(always)]
    pub fn local(&self, p: P3) -> P3 {
        self.frame.map(|axis| dot(axis, p))
    }

    /// A coordinate axis in the ring's frame.
    #[inline(always)]
    pub fn axis(&self, m: Axis) -> P3 {
        self.frame.map(|axis| axis[m])
    }

    /// The line along axis `m` through a point, whose coordinate along it does not matter.
    #[inline(always)]
    pub fn line(&self, m: Axis, mut p: P3) -> Line {
        p[m] = 0.0;
        Line { at: self.local(p), along: self.axis(m) }
    }

    /// How far a point is outside the whole torus, negative inside.
    pub fn outside(&self, p: P3) -> f64 {
        let [x, y, z] = self.local(p);
        length2([length2([x, y]) - self.radius, z]) - self.tube
    }

    /// Negative inside the whole torus: (ρ − R)² + z² − r², and how that grows along the line.
    #[inline(always)]
    fn square(&self, line: &Line, t: f64) -> P2 {
        let ([x, y, z], along) = (line.point(t), line.along);
        let rho = Real::sqrt(x * x + y * y);
        let off = rho - self.radius;
        let rate = 2.0 * (off * ((x * along[0] + y * along[1]) / rho) + z * along[2]);
        if rho < self.radius * 0.5 {
            // The hole of a horn is as narrow as ρ is there.
            return [rho * (rho - 2.0 * self.radius) + z * z + self.hole(), rate];
        }
        [off * off + (z - self.tube) * (z + self.tube), rate]
    }

    /// R² − r².
    #[inline(always)]
    fn hole(&self) -> f64 {
        (self.radius - self.tube) * (self.radius + self.tube)
    }

    /// What a line has inside between two of its points.
    pub fn runs(&self, line: &Line, lo: f64, hi: f64) -> Runs {
        let whole = self.of_torus(line, lo, hi);
        match &self.ends {
            Some(ends) => self.between_ends(ends, line, &whole),
            None => whole,
        }
    }

    /// The same of the whole torus.
    fn of_torus(&self, line: &Line, lo: f64, hi: f64) -> Runs {
        match line.along {
            [_, _, 0.0] => self.of_line_across(line, lo, hi),
            [0.0, 0.0, _] => self.of_line_along(line, lo, hi),
            _ => self.of_oblique_line(line, lo, hi),
        }
    }

    /// Across the axis: between two circles.
    fn of_line_across(&self, line: &Line, lo: f64, hi: f64) -> Runs {
        let (mut runs, z) = (Runs::new(), line.at[2]);
        let square = (self.tube - z) * (self.tube + z);
        if !(square > 0.0) {
            return runs;
        }
        let outer = self.radius + Real::sqrt(square);
        let inner = (self.hole() + z * z) / outer;
        let shift = -dot(line.at, line.along);
        let foot = line.point(shift);
        let nearest = length2([foot[0], foot[1]]);
        let half = |radius: f64| Real::sqrt(((radius - nearest) * (radius + nearest)).max(0.0));
        let (far, near) = (half(outer), half(inner));
        let ends = if near > 0.0 { [[-far, -near], [near, far]] } else { [[-far, far], [0.0; 2]] };
        for [from, to] in ends {
            let (from, to) = ((from + shift).max(lo), (to + shift).min(hi));
            if from < to {
                let _ = runs.push([from, to]);
            }
        }
        runs
    }

    /// Along the axis: through one disc.
    fn of_line_along(&self, line: &Line, lo: f64, hi: f64) -> Runs {
        let (mut runs, [x, y, z]) = (Runs::new(), line.at);
        let rho = length2([x, y]);
        let off = rho - self.radius;
        let square = if rho < self.radius * 0.5 {
            rho * (2.0 * self.radius - rho) - self.hole()
        } else {
            (self.tube - off) * (self.tube + off)
        };
        let (half, middle) = (Real::sqrt(square.max(0.0)), -z * line.along[2]);
        let (from, to) = ((middle - half).max(lo), (middle + half).min(hi));
        if from < to {
            let _ = runs.push([from, to]);
        }
        runs
    }

    /// Any other line.
    fn of_oblique_line(&self, line: &Line, lo: f64, hi: f64) -> Runs {
        let f = |t: f64| self.square(line, t)[0];
        let mut runs = Runs::new();
        let (mut at, mut value) = (lo, f(lo));
        let mut start = (value <= 0.0).then_some(lo);
        let turns = self.turns(line, lo, hi);
        for next in turns.iter().copied().chain([hi]) {
            let there = f(next);
            if (there <= 0.0) != start.is_some() {
                let found = newton_root(|t| self.square(line, t), [at, next], [value, there]);
                match start.take() {
                    Some(from) => {
                        let _ = runs.push([from, found]);
                    }
                    None => start = Some(found),
                }
            }
            (at, value) = (next, there);
        }
        if let Some(from) = start {
            let _ = runs.push([from, hi]);
        }
        runs
    }

    /// Where the quartic along a line turns, between two of its points.
    fn turns(&self, line: &Line, lo: f64, hi: f64) -> Vec<f64, 3> {
        let Line { at, along } = line;
        let shift = -dot(*at, *along);
        let foot = line.point(shift);
        let double = 2.0 * self.radius * self.radius;
        let k = dot(foot, foot) + self.hole();
        let (a, b) = (along[0] * along[0] + along[1] * along[1], foot[0] * along[0] + foot[1] * along[1]);
        let (linear, constant) = (k - double * a, -double * b);
        let cubic = |s: f64| (s * s + linear) * s + constant;
        let with_rate = |s: f64| [cubic(s), 3.0 * s * s + linear];
        let half = Real::sqrt((-linear / 3.0).max(0.0));
        let mut turns = Vec::new();
        let (mut before, last) = (lo - shift, hi - shift);
        let mut value = cubic(before);
        for next in [-half, half, last] {
            if !(next > before && next <= last) {
                continue;
            }
            let there = cubic(next);
            if (value > 0.0) != (there > 0.0) {
                let _ = turns.push((newton_root(with_rate, [before, next], [value, there]) + shift).limited(lo, hi));
            }
            (before, value) = (next, there);
        }
        turns
    }

    /// What of some pieces lies between the ends. Points in the planes of the ends belong to the solid.
    fn between_ends(&self, ends: &Ends, line: &Line, runs: &Runs) -> Runs {
        // Signed distances from the planes of both ends, along the line.
        let [start, end] = ends.toward;
        let [of_start, of_end] = ends.inward;
        let forms = [([-start[1], start[0]], of_start), ([end[1], -end[0]], of_end)].map(|(normal, inward)| {
            let of = |p: P3| normal[0] * p[0] + normal[1] * p[1];
            let (at, along) = (of(line.at), of(line.along));
            // A line in the plane of an end across an axis is in it, whatever rounding says.
            let flat = inward.iter().filter(|x| **x == 0.0).count() == 2;
            let far = !flat || at.abs() > NOISE * (self.radius + self.tube);
            [if far { at } else { 0.0 }, if flat && along.abs() <= NOISE { 0.0 } else { along }]
        });
        let mut kept = Runs::new();
        let mut keep = |lo: f64, hi: f64| {
            if lo < hi {
                let _ = kept.push([lo, hi]);
            }
        };
        for &[lo, hi] in runs {
            if ends.wide {
                // Outside is where both are negative.
                let [from, to] = forms.iter().fold([lo, hi], |run, form| before(form, run, -1.0));
                if from < to {
                    keep(lo, from);
                    keep(to, hi);
                } else {
                    keep(lo, hi);
                }
            } else {
                let [from, to] = forms.iter().fold([lo, hi], |run, form| before(form, run, 1.0));
                keep(from, to);
            }
        }
        kept
    }

    /// Does the solid, as far as its ends go, hold all of a box or rectangle, by its corners? And does it hold none of it?
    pub fn beside_ends(&self, corners: impl Iterator<Item = P3> + Clone) -> (bool, bool) {
        let Some(ends) = &self.ends else { return (true, false) };
        let [one, other] = ends.inward.map(|inward| {
            let heights = corners.clone().map(|p| dot(inward, p));
            heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], x| [lo.min(x), hi.max(x)])
        });
        if ends.wide {
            (one[0] >= 0.0 || other[0] >= 0.0, one[1] <= 0.0 && other[1] <= 0.0)
        } else {
            (one[0] >= 0.0 && other[0] >= 0.0, one[1] <= 0.0 || other[1] <= 0.0)
        }
    }

    /// The outermost point along a direction: of the convex hull, which is the same.
    pub fn outermost(&self, direction: P3) -> P3 {
        let [x, y, z] = self.local(direction);
        let mut toward = [x, y];
        if let Some(ends) = &self.ends {
            let [start, end] = ends.toward;
            let (past, left) = (plane::cross(start, toward), plane::cross(toward, end));
            let within = if ends.wide { past >= 0.0 || left >= 0.0 } else { past >= 0.0 && left >= 0.0 };
            if !within || (past == 0.0 && left == 0.0 && !(plane::dot(toward, ends.middle) >= 0.0)) {
                toward = if plane::dot(toward, start) > plane::dot(toward, end) { start } else { end };
            }
        }
        let across = length2(toward);
        let toward =
            if across > 0.0 { toward.map(|x| x / across) } else { self.ends.as_ref().map_or([1.0, 0.0], |e| e.middle) };
        // In the disc across the ring there: the direction less what it has along the tangent.
        let (out, up) = (plane::dot([x, y], toward), z);
        let size = length2([out, up]);
        let scale = if size > 0.0 { self.tube / size } else { 0.0 };
        let (rho, height) = (self.radius + out * scale, up * scale);
        let [e, f, a] = self.frame;
        Axis::ALL.map(|n| rho * (toward[0] * e[n] + toward[1] * f[n]) + height * a[n])
    }
}

/// The part of a run where a linear form is not negative, or with `sign` −1 where it is negative.
fn before(form: &[f64; 2], [lo, hi]: [f64; 2], sign: f64) -> [f64; 2] {
    let [at, along] = form.map(|x| x * sign);
    if along == 0.0 {
        let inside = if sign > 0.0 { at >= 0.0 } else { at > 0.0 };
        return if inside { [lo, hi] } else { [f64::INFINITY, f64::NEG_INFINITY] };
    }
    let t = -at / along;
    if along > 0.0 { [lo.max(t), hi] } else { [lo, hi.min(t)] }
}
