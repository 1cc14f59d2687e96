//! What a torus has of a rectangle in a grid plane: area, and the flux of a field that is tangent to it.
//!
//! The field ρ ψ e_φ, ψ the azimuth from a reference, has divergence 1 and no component across the torus or any surface of revolution. Through a
//! plane with normal n it carries ψ p·(n × a). Over a line of the plane that is integrated in closed form, piece by piece; over the lines by
//! Gauss and Kronrod's fifteen points between all places where something changes: where the sides of the rectangle pierce the solid,
//! where lines touch it, where flat ends meet it. Square roots at both ends of such a panel are removed by v = m − w cos t. A panel is
//! halved until both rules agree.
//!
//! In planes across the axis the section is a ring between two circles, and exact.

use super::disc::{self, Polygon};
use super::ring::{Ring, ahead, length2};
use super::touching::{Events, Lines, chord};
use crate::number::axis::Axis;
use crate::number::kronrod::{panel, plus};
use crate::number::plane::{self, P2};
use crate::number::real::Real;
use crate::number::space::P3;
use core::f64::consts::PI;
use heapless::Vec;

/// A rectangle in a plane across axis `n`, from the centre, in the order of [`Axis::others`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Rectangle {
    pub n: Axis,
    pub h: f64,
    pub u: P2,
    pub v: P2,
}

impl Rectangle {
    pub fn place(&self, u: f64, v: f64) -> P3 {
        let mut p = [0.0; 3];
        let [iu, iv] = self.n.others();
        (p[self.n], p[iu], p[iv]) = (self.h, u, v);
        p
    }

    pub fn middle(&self) -> P3 {
        self.place((self.u[0] + self.u[1]) * 0.5, (self.v[0] + self.v[1]) * 0.5)
    }

    fn sides(&self) -> [P2; 3] {
        let mut sides = [[self.h; 2]; 3];
        let [iu, iv] = self.n.others();
        (sides[iu], sides[iv]) = (self.u, self.v);
        sides
    }

    fn sizes(&self) -> P2 {
        [self.u[1] - self.u[0], self.v[1] - self.v[0]]
    }

    fn corners(&self) -> [P3; 4] {
        let ([u0, u1], [v0, v1]) = (self.u, self.v);
        [self.place(u0, v0), self.place(u1, v0), self.place(u1, v1), self.place(u0, v1)]
    }
}

/// What a solid has of a rectangle.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Section {
    pub area: f64,
    /// ∫ p·(n × a) dA: by how much the flux grows with the angle from the reference.
    pub moment: f64,
    pub flux: f64,
    /// Of the area, as a share of the rectangle; of the flux, as one of the rectangle times its mean size.
    pub error: f64,
    pub whole: bool,
}

/// From where the azimuth counts: a direction in the ring's plane. With `cut` the azimuth leaps at its opposite.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reference {
    pub toward: P2,
    pub cut: bool,
}

/// Panels of one rectangle that wait.
const WAITING: usize = 48;

/// A panel is halved so often at most.
const MOST_HALVINGS: u8 = 36;

/// Where rounding is all that the rules differ by, halving ends nowhere; faces of random tori need 450 panels at most.
const MOST_PANELS: u32 = 2000;

/// Error of the quadrature that is added to the difference of both rules, as a share of a face. Measured: over thousands of faces of random
/// tori the true error never exceeded that difference by more than a tenth of this.
const MEASURED: f64 = 1e-10;

/// A panel is accepted where Gauss' and Kronrod's rules differ by less than this share. The difference is the error of Gauss' rule; that of
/// Kronrod's, which is used, is far smaller.
const ERROR: f64 = 1e-12;

/// An event this near beside a panel, as a share of its width, splits it; one nearer than the second takes less than rounding.
const BESIDE: f64 = 2e-3;
const NEAREST: f64 = 1e-9;

/// By how much panels beside such an event grow, and up to which distance from it, as a share of all.
const GROWTH: f64 = 4.0;
const SEEN: f64 = 0.05;

/// What the terms of the logarithm's series, of z to k = 1, 3, 5 … and of z to k + 1, have of 1 and of u over −1 to 1: 2 / (k (k + 2)) and
/// 2 / ((k + 1) (k + 2)).
const LOGARITHM: [[f64; 2]; 20] = {
    let (mut terms, mut n) = ([[0.0; 2]; 20], 0);
    while n < terms.len() {
        let k = 2.0 * n as f64 + 1.0;
        terms[n] = [2.0 / (k * (k + 2.0)), 2.0 / ((k + 1.0) * (k + 2.0))];
        n += 1;
    }
    terms
};

/// Length of the runs of a line, their moment and their flux.
type Sums = [f64; 3];

impl Ring {
    /// What the solid has of a rectangle; the azimuth of the flux counts from the rectangle's middle, or from a reference.
    /// Without a reference there is no flux through a rectangle that the axis meets. `Careful` sections are measured in shorter panels.
    pub fn section(&self, face: &Rectangle, reference: Option<Reference>, careful: bool) -> Section {
        let [du, dv] = face.sizes();
        let half = length2([du, dv]) * 0.5;
        let outside = self.outside(face.middle());
        if outside > half * (1.0 + 1e-9) {
            return Section::default();
        }
        let (held, missed) = self.beside_ends(face.corners().into_iter());
        if is_along(&self.frame[2], face.n) {
            return self.ring_between_circles(face);
        }
        let flush = self.ends.is_some() && self.lies_in_end(face);
        if missed && !flush {
            return Section::default();
        }
        let middle = self.local(face.middle());
        // Where the axis meets a rectangle, azimuths from its middle leap in it.
        let flux = reference.is_some() || !self.axis_meets(&face.sides());
        let reference = reference.unwrap_or(Reference { toward: [middle[0], middle[1]], cut: false });
        let lines = LinesOfFace { ring: self, face, reference, axis: self.axis_across(face.n), flux };
        let whole = held && outside < -half * (1.0 + 1e-9);
        let mut section =
            lines.integral(&if whole && !reference.cut { Events::new() } else { lines.events() }, careful);
        if whole {
            section.area = du * dv;
        }
        Section { whole, ..section }
    }

    /// Components of the axis along u and v.
    fn axis_across(&self, n: Axis) -> P2 {
        n.others().map(|m| self.frame[2][m])
    }

    /// The plane of a rectangle is that of an end, and the solid lies on one side.
    fn lies_in_end(&self, face: &Rectangle) -> bool {
        face.h == 0.0 && self.ends.is_some_and(|ends| ends.inward.iter().any(|inward| is_along(inward, face.n)))
    }

    /// In a plane across the axis.
    fn ring_between_circles(&self, face: &Rectangle) -> Section {
        let square = (self.tube - face.h) * (self.tube + face.h);
        if !(square > 0.0) {
            return Section::default();
        }
        let half = Real::sqrt(square);
        let mut rectangle = Polygon::new();
        for corner in face.corners() {
            let [u, v] = face.n.others();
            let _ = rectangle.push([corner[u], corner[v]]);
        }
        let ring = |polygon: &Polygon| {
            disc::moments(self.radius + half, polygon).0 - disc::moments(self.radius - half, polygon).0
        };
        let area = match &self.ends {
            None => ring(&rectangle),
            Some(ends) => {
                let [u, v] = face.n.others();
                let sign = if ends.wide { -1.0 } else { 1.0 };
                let mut polygon = rectangle.clone();
                for inward in &ends.inward {
                    polygon = disc::cut(&polygon, 0.0, [inward[u] * sign, inward[v] * sign]);
                }
                if ends.wide { ring(&rectangle) - ring(&polygon) } else { ring(&polygon) }
            }
        };
        let [du, dv] = face.sizes();
        let whole = area >= du * dv * (1.0 - 64.0 * f64::EPSILON);
        Section { area: area.max(0.0), error: ROUNDING * (1.0 + self.radius / du.min(dv)), whole, ..Section::default() }
    }

    /// ∫ ρ dA over what a cell has of the disc of an end, or of a cut through a whole torus, towards a direction.
    pub fn moment_of_disc(&self, toward: P2, sides: &[P2; 3]) -> f64 {
        let [e, f, a] = self.frame;
        let r = self.tube;
        let mut polygon = Polygon::new();
        for corner in [[-r, -r], [r, -r], [r, r], [-r, r]] {
            let _ = polygon.push(corner);
        }
        for (n, [lo, hi]) in sides.iter().enumerate() {
            let (out, up) = (toward[0] * e[n] + toward[1] * f[n], a[n]);
            let center = self.radius * out;
            polygon = disc::cut(&polygon, center - lo, [out, up]);
            polygon = disc::cut(&polygon, hi - center, [-out, -up]);
        }
        let (area, first) = disc::moments(r, &polygon);
        self.radius * area + first[0]
    }
}

/// A vector has no component but one.
fn is_along(v: &P3, n: Axis) -> bool {
    n.others().into_iter().all(|m| v[m] == 0.0)
}

/// Sorted by insertion, for there are few.
fn ascending(values: impl Iterator<Item = f64>) -> Events {
    let mut sorted = Events::new();
    for mut moved in values {
        for other in &mut sorted {
            if moved.total_cmp(other).is_lt() {
                core::mem::swap(&mut moved, other);
            }
        }
        let _ = sorted.push(moved);
    }
    sorted
}

/// What rounding takes of a closed form, as a share.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The lines along u of a rectangle.
struct LinesOfFace<'a> {
    ring: &'a Ring,
    face: &'a Rectangle,
    reference: Reference,
    axis: P2,
    /// Is the flux wanted?
    flux: bool,
}

impl LinesOfFace<'_> {
    /// Where along v the runs of the lines change their kind, some of them beside the rectangle.
    fn events(&self) -> Events {
        let Rectangle { n, h, u: [u0, u1], v: [v0, v1] } = *self.face;
        let (ring, [iu, iv]) = (self.ring, n.others());
        let mut found = Events::new();
        for u in [u0, u1] {
            let line = ring.line(iv, self.face.place(u, 0.0));
            for run in &ring.runs(&line, v0, v1) {
                let _ = found.push(run[0]);
                let _ = found.push(run[1]);
            }
        }
        let sides = [self.face.u, self.face.v];
        Lines { n: ring.axis(n), u: ring.axis(iu), v: ring.axis(iv), h, sides }.touched(ring, &mut found);
        let axis = ring.frame[2];
        if ring.tube > ring.radius * 0.5 && axis[n].abs() > 1e-6 {
            // The azimuth turns fast beside the axis.
            let _ = found.push(h * axis[iv] / axis[n]);
        }
        if let Some(ends) = &ring.ends {
            ends.toward.iter().for_each(|toward| self.events_of_disc(*toward, &mut found));
        } else if self.reference.cut {
            self.events_of_disc(self.reference.toward.map(|x| -x), &mut found);
        }
        ascending(found.iter().copied())
    }

    /// Where the disc of an end meets the plane: the ends of the chord, and where it crosses the rectangle's sides.
    fn events_of_disc(&self, toward: P2, found: &mut Events) {
        let Rectangle { n, h, u, .. } = *self.face;
        let (ring, [iu, iv]) = (self.ring, n.others());
        let along = |m: Axis| {
            let axis = ring.axis(m);
            [plane::dot([axis[0], axis[1]], toward), axis[2]]
        };
        let (normal, to_u, to_v) = (along(n), along(iu), along(iv));
        let place = |form: P2, p: P2| form[0] * (ring.radius + p[0]) + form[1] * p[1];
        let Some([from, to]) = chord(normal, h - ring.radius * normal[0], ring.tube) else { return };
        let [a, b] = [from, to].map(|p| [place(to_u, p), place(to_v, p)]);
        let _ = found.push(a[1]);
        let _ = found.push(b[1]);
        for side in u {
            let part = (side - a[0]) / (b[0] - a[0]);
            if part > 0.0 && part < 1.0 {
                let _ = found.push(a[1] + part * (b[1] - a[1]));
            }
        }
    }

    /// Over the panels between events; `careful` ones are short.
    fn integral(&self, events: &[f64], careful: bool) -> Section {
        let [v0, v1] = self.face.v;
        let [du, dv] = self.face.sizes();
        let (mut total, mut error) = ([0.0; 3], 0.0);
        let mut before = v0;
        for next in events.iter().copied().filter(|v| *v > v0 && *v < v1).chain([v1]) {
            // Slivers that rounding makes of one event have no area.
            if next - before > 4.0 * f64::EPSILON * (v1 - v0) {
                let mut from = before;
                for to in self.splits(events, [before, next], careful).iter().copied().chain([next]) {
                    if to > from {
                        let (sums, worst) = self.panel(from, to);
                        total = plus(total, sums, 1.0);
                        error += worst;
                        from = to;
                    }
                }
                before = next;
            }
        }
        let reach = 1.0 + length2([v0.abs().max(v1.abs()), self.face.h]) / du.min(dv);
        let error = error / (du * dv) + ROUNDING * reach + MEASURED;
        Section { area: total[0], moment: total[1], flux: total[2], error, whole: false }
    }

    /// Where a panel between events is split. An event beside its end is the branch of a square root there, which the rules do not see if it is much
    /// nearer than their nodes: panels grow with their distance from it.
    fn splits(&self, events: &[f64], [from, to]: [f64; 2], careful: bool) -> Events {
        let width = to - from;
        let mut places = Events::new();
        self.overlooked(from, to).iter().for_each(|place| _ = places.push(*place));
        let distant = |way: &f64| *way > width * NEAREST;
        let below = events.iter().map(|event| from - event).filter(distant).fold(width, f64::min);
        let above = events.iter().map(|event| event - to).filter(distant).fold(width, f64::min);
        for (end, sign, beside) in [(from, 1.0, below), (to, -1.0, above)] {
            let mut way = if beside < width * BESIDE { beside * GROWTH } else { width };
            while way < width * SEEN {
                let _ = places.push(end + sign * way);
                way *= GROWTH;
            }
        }
        if careful {
            (1..8).for_each(|n| _ = places.push(from + width * f64::from(n) / 8.0));
        }
        ascending(places.iter().copied())
    }

    /// What changes so near the ends of a panel that no node of the rules sees it: found by halving.
    fn overlooked(&self, from: f64, to: f64) -> Vec<f64, 2> {
        let width = to - from;
        let mut found = Vec::new();
        for (end, sign) in [(from, 1.0), (to, -1.0)] {
            let (mut near, mut far) = (end + sign * width * 1e-13, end + sign * width * 2e-5);
            let kind = self.kind(far);
            if self.kind(near) == kind {
                continue;
            }
            for _ in 0..40 {
                let middle = (near + far) * 0.5;
                if self.kind(middle) == kind { far = middle } else { near = middle }
            }
            let _ = found.push(far);
        }
        found
    }

    /// How many runs a line has, and which of them begin or end at the rectangle's sides.
    fn kind(&self, v: f64) -> (usize, u32) {
        let Rectangle { n, u: [u0, u1], .. } = *self.face;
        let line = self.ring.line(n.others()[0], self.face.place(0.0, v));
        let runs = self.ring.runs(&line, u0, u1);
        let ends = runs.iter().map(|[a, b]| u32::from(*a == u0) + 2 * u32::from(*b == u1));
        (runs.len(), ends.fold(0, |all, end| all * 4 + end))
    }

    /// Over one panel, and by how much both rules differ.
    fn panel(&self, from: f64, to: f64) -> (Sums, f64) {
        let half = (to - from) * 0.5;
        let at = |t: f64| {
            // Near the ends, from the ends: v = m − w cos t.
            let (sin, cos) = libm::sincos(t * 0.5);
            let v = if t < PI * 0.5 { from + 2.0 * half * sin * sin } else { to - 2.0 * half * cos * cos };
            self.over_line(v).map(|x| x * 2.0 * sin * cos * half)
        };
        let [du, dv] = self.face.sizes();
        let size = (du + dv) * 0.5;
        let scale = |d: Sums| (d[0].abs() + d[2].abs() / size) / (du * dv);
        let enough = |d: Sums| scale(d) <= ERROR;
        let mut waiting: Vec<(f64, f64, u8), WAITING> = Vec::new();
        let _ = waiting.push((0.0, PI, 0));
        let (mut total, mut worst, mut panels) = ([0.0; 3], 0.0, 0);
        while let Some((lo, hi, depth)) = waiting.pop() {
            panels += 1;
            let (m, [fine, coarse]) = ((lo + hi) * 0.5, panel([lo, hi], at, enough));
            let apart = scale(plus(fine, coarse, -1.0));
            let enough =
                !(apart > ERROR) || panels >= MOST_PANELS || depth >= MOST_HALVINGS || waiting.len() + 2 > WAITING;
            if enough {
                total = plus(total, fine, 1.0);
                worst += apart * (du * dv);
            } else {
                let _ = waiting.push((lo, m, depth + 1));
                let _ = waiting.push((m, hi, depth + 1));
            }
        }
        (total, worst)
    }

    /// Over the runs of the line at a coordinate.
    fn over_line(&self, v: f64) -> Sums {
        let Rectangle { n, u: [u0, u1], .. } = *self.face;
        let line = self.ring.line(n.others()[0], self.face.place(0.0, v));
        let (constant, slope) = (self.axis[0] * v, -self.axis[1]);
        let mut sums = [0.0; 3];
        let (alpha, beta) = ([line.at[0], line.at[1]], [line.along[0], line.along[1]]);
        for &[from, to] in &self.ring.runs(&line, u0, u1) {
            for [from, to] in self.pieces(alpha, beta, from, to).into_iter().flatten() {
                let (m, w) = ((from + to) * 0.5, (to - from) * 0.5);
                sums[0] += 2.0 * w;
                sums[1] += 2.0 * w * (constant + slope * m);
                sums[2] += self.flux(alpha, beta, [constant, slope], [m, w]);
            }
        }
        sums
    }

    /// A run, in two if the azimuth leaps in it.
    fn pieces(&self, alpha: P2, beta: P2, from: f64, to: f64) -> [Option<[f64; 2]>; 2] {
        if self.reference.cut {
            let toward = self.reference.toward;
            let at = -plane::cross(alpha, toward) / plane::cross(beta, toward);
            let behind = plane::dot(alpha, toward) + at * plane::dot(beta, toward) < 0.0;
            if behind && at > from && at < to {
                return [Some([from, at]), Some([at, to])];
            }
        }
        [Some([from, to]), None]
    }

    /// ∫ ψ (constant + slope u) du over m ± w: by the series where the run is short beside its distance from the axis, else in closed form.
    fn flux(&self, alpha: P2, beta: P2, [constant, slope]: P2, [m, w]: P2) -> f64 {
        if !self.flux || self.axis == [0.0, 0.0] {
            return 0.0;
        }
        let near = |t: f64| length2([alpha[0] + t * beta[0], alpha[1] + t * beta[1]]);
        let size = length2(beta) * w;
        let foot = -plane::dot(alpha, beta) / plane::dot(beta, beta);
        let least = if size > 0.0 { near(foot.limited(m - w, m + w)) } else { 1.0 };
        if size > 2.0 * least {
            return self.past_axis(alpha, beta, foot, [constant, slope], [m, w]);
        }
        let count = libm::ceil(size * 4.0 / least).max(1.0);
        let short = w / count;
        let mut sum = 0.0;
        let mut n = 0.0;
        while n < count {
            let place = m - w + (2.0 * n + 1.0) * short;
            sum += self.short(alpha, beta, [constant + slope * place, slope * short], place, short);
            n += 1.0;
        }
        sum
    }

    /// The same of a run that passes near the axis: from the foot of the line, d away, ψ grows by the arc tangent of y / d, y the way in the
    /// ring's plane, and the integrals of atan(y / d) and of y atan(y / d) are known.
    fn past_axis(&self, alpha: P2, beta: P2, foot: f64, [constant, slope]: P2, [m, w]: P2) -> f64 {
        let at = |t: f64| [alpha[0] + t * beta[0], alpha[1] + t * beta[1]];
        let rate = length2(beta);
        let turn = plane::cross(at(foot), beta);
        let (d, sign) = ((turn / rate).abs(), 1.0_f64.copysign(turn));
        let angle = |y: f64| libm::atan2(y, d);
        let [from, to] = [m - w - foot, m + w - foot].map(|x| x * rate);
        let [a, b] = [from, to].map(angle);
        let logarithm = if d > 0.0 { d * libm::log(length2([to, d]) / length2([from, d])) } else { 0.0 };
        let zeroth = (to * b - from * a - logarithm) / rate;
        let first = ((to * to + d * d) * b - (from * from + d * d) * a - d * (to - from)) / (2.0 * rate * rate);
        let start = ahead(at(m), self.reference.toward) - sign * angle((m - foot) * rate);
        let (constant, middle) = (constant + slope * foot, m - foot);
        start * 2.0 * w * (constant + slope * middle) + sign * (constant * zeroth + slope * first)
    }

    /// The same over a short piece, ψ by the series of the logarithm about its middle.
    fn short(&self, alpha: P2, beta: P2, [constant, slope]: P2, m: f64, w: f64) -> f64 {
        let q = [alpha[0] + m * beta[0], alpha[1] + m * beta[1]];
        let square = plane::dot(q, q);
        let psi = ahead(q, self.reference.toward);
        let (mut odd, mut even) = (0.0, 2.0 * psi);
        if square > 0.0 {
            // The imaginary parts of powers of z = β w / q, each from the two before it.
            let z = [plane::dot(beta, q) * w / square, plane::cross(q, beta) * w / square];
            let (double, norm) = (2.0 * z[0], plane::dot(z, z));
            let (mut before, mut power) = (0.0, z[1]);
            for [of_odd, of_even] in &LOGARITHM {
                odd += of_odd * power;
                (before, power) = (power, double * power - norm * before);
                even -= of_even * power;
                (before, power) = (power, double * power - norm * before);
                if power.abs() + before.abs() < 1e-17 {
                    break;
                }
            }
        }
        (constant * even + slope * odd) * w
    }
}
