//! Where lines of a plane touch a torus: between these the runs of the lines along it change smoothly.
//!
//! On a torus the points whose normal is across a direction e_u form two curves: for each azimuth φ two opposite angles θ around the tube. Along
//! them the height over the plane is followed in small steps, and its roots are what is wanted. Where θ turns at one azimuth, as it
//! does if e_u is across the axis, θ is followed instead.

use super::ring::{Ring, ahead, length2};
use super::roots::root;
use crate::number::plane::P2;
use crate::number::real::Real;
use crate::number::space::{P3, dot};
use core::f64::consts::{FRAC_PI_2, PI};
use heapless::Vec;

/// Coordinates in a plane where something changes.
pub(super) type Events = Vec<f64, 64>;

/// A plane across axis `n` at height `h`, its lines along `u`.
pub(super) struct Lines {
    pub n: P3,
    pub u: P3,
    pub v: P3,
    pub h: f64,
}

/// A point of the torus on one of the two curves.
#[derive(Clone, Copy)]
struct Spot {
    /// Azimuth.
    phi: f64,
    /// Cosine and sine of θ.
    turn: P2,
    height: f64,
}

/// The longest step, in radians.
const STEP: f64 = PI / 24.0;

/// Where a step along φ would have to be shorter than this, in radians, θ is followed.
const STEEP: f64 = 1e-3;

/// More steps than any plane needs.
const MOST_STEPS: usize = 600;

/// Largest square of the way that (cos θ, sin θ) may go in one step along φ; a longer step is shortened.
const TURN: f64 = 0.09;

impl Lines {
    fn at(&self, ring: &Ring, phi: f64, turn: P2) -> P3 {
        let rho = ring.radius + ring.tube * turn[0];
        [rho * libm::cos(phi), rho * libm::sin(phi), ring.tube * turn[1]]
    }

    /// On the curve of a sign.
    fn spot(&self, ring: &Ring, sign: f64, phi: f64) -> Spot {
        let c = self.u[0] * libm::cos(phi) + self.u[1] * libm::sin(phi);
        let length = length2([self.u[2], c]);
        let scale = if length > 0.0 { sign / length } else { 0.0 };
        let turn = if length > 0.0 { [self.u[2] * scale, -c * scale] } else { [1.0, 0.0] };
        Spot { phi, turn, height: dot(self.n, self.at(ring, phi, turn)) - self.h }
    }

    /// The coordinates along v of the points where lines along u touch the torus, in a range of azimuths.
    pub fn touched(&self, ring: &Ring, range: [f64; 2], events: &mut Events) {
        for sign in [1.0, -1.0] {
            self.follow(ring, sign, range, events);
        }
    }

    fn follow(&self, ring: &Ring, sign: f64, [from, to]: [f64; 2], events: &mut Events) {
        let longest = STEP.min((to - from) / 6.0);
        let (mut last, mut step) = (self.spot(ring, sign, from), longest);
        let mut before: Option<Spot> = None;
        for _ in 0..MOST_STEPS {
            if last.phi >= to {
                break;
            }
            let next = self.spot(ring, sign, (last.phi + step).min(to));
            let chord = [next.turn[0] - last.turn[0], next.turn[1] - last.turn[1]];
            if chord[0] * chord[0] + chord[1] * chord[1] > TURN {
                if step > STEEP {
                    step *= 0.25;
                    continue;
                }
                self.around(ring, sign, &last, &next, events);
                before = None;
            } else {
                let f = |phi: f64| self.spot(ring, sign, phi).height;
                self.between(ring, &f, &last, &next, |phi| self.spot(ring, sign, phi), events);
                if let Some(before) = before {
                    self.lowest(ring, sign, [&before, &last, &next], events);
                }
                before = Some(last);
            }
            last = next;
            step = (step * 2.0).min(longest);
        }
    }

    fn tell(&self, ring: &Ring, spot: &Spot, events: &mut Events) {
        let _ = events.push(dot(self.v, self.at(ring, spot.phi, spot.turn)));
    }

    /// A root between two spots.
    fn between(
        &self,
        ring: &Ring,
        f: &impl Fn(f64) -> f64,
        a: &Spot,
        b: &Spot,
        spot: impl Fn(f64) -> Spot,
        events: &mut Events,
    ) {
        if (a.height > 0.0) != (b.height > 0.0) {
            let found = root(f, [a.phi, b.phi], [a.height, b.height]);
            self.tell(ring, &spot(found), events);
        }
    }

    /// The least height between three spots of one sign, if it may reach the plane.
    fn lowest(&self, ring: &Ring, sign: f64, [a, b, c]: [&Spot; 3], events: &mut Events) {
        let side = if b.height > 0.0 { 1.0 } else { -1.0 };
        let [x, y, z] = [a, b, c].map(|s| s.height * side);
        if !(x > 0.0 && y > 0.0 && z > 0.0 && y <= x && y <= z) || y > 0.5 * (x - y).max(z - y) {
            return;
        }
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let f = |phi: f64| self.spot(ring, sign, phi).height * side;
        let (mut lo, mut hi) = (a.phi, c.phi);
        let (mut s, mut t) = (hi - (hi - lo) * GOLDEN, lo + (hi - lo) * GOLDEN);
        let (mut fs, mut ft) = (f(s), f(t));
        for _ in 0..48 {
            if fs < ft {
                (hi, t, ft) = (t, s, fs);
                s = hi - (hi - lo) * GOLDEN;
                fs = f(s);
            } else {
                (lo, s, fs) = (s, t, ft);
                t = lo + (hi - lo) * GOLDEN;
                ft = f(t);
            }
        }
        let lowest = self.spot(ring, sign, if fs < ft { s } else { t });
        if lowest.height * side > 0.0 {
            // Beside the plane: the runs change fast here, if it is close.
            self.tell(ring, &lowest, events);
        } else {
            let f = |phi: f64| self.spot(ring, sign, phi).height;
            self.between(ring, &f, a, &lowest, |phi| self.spot(ring, sign, phi), events);
            self.between(ring, &f, &lowest, c, |phi| self.spot(ring, sign, phi), events);
        }
    }

    /// The same from spot to spot, by steps of θ: its cosine has one sign on all of a curve.
    fn around(&self, ring: &Ring, sign: f64, from: &Spot, to: &Spot, events: &mut Events) {
        let [ux, uy, uz] = self.u;
        let outer = sign * if uz < 0.0 { -1.0 } else { 1.0 };
        let (first, last) = (ahead(from.turn, [outer, 0.0]), ahead(to.turn, [outer, 0.0]));
        let (across, toward) = (length2([ux, uy]), libm::atan2(uy, ux));
        let side = if libm::sin(from.phi - toward) < 0.0 { -1.0 } else { 1.0 };
        let spot = |theta: f64| {
            let (sine, cosine) = (libm::sin(theta), libm::cos(theta));
            let slant = if uz == 0.0 { 0.0 } else { (-uz * (sine / cosine) / across).clamp(-1.0, 1.0) };
            let (phi, turn) = (toward + side * (FRAC_PI_2 - libm::asin(slant)), [cosine * outer, sine * outer]);
            (theta, Spot { phi, turn, height: dot(self.n, self.at(ring, phi, turn)) - self.h })
        };
        let f = |theta: f64| spot(theta).1.height;
        let count = 24;
        let mut before = spot(first);
        for n in 1..=count {
            let next = spot(first + (last - first) * f64::from(n) / f64::from(count));
            if (before.1.height > 0.0) != (next.1.height > 0.0) {
                let found = root(f, [before.0, next.0], [before.1.height, next.1.height]);
                self.tell(ring, &spot(found).1, events);
            }
            before = next;
        }
    }
}

/// The azimuths that a rectangle may have of a torus: about its middle, or all.
pub(super) fn azimuths(middle: P2, half: f64) -> [f64; 2] {
    let distance = length2(middle);
    if half >= distance * 0.95 {
        return [0.0, 2.0 * PI];
    }
    let phi = libm::atan2(middle[1], middle[0]);
    let margin = libm::asin(half / distance).min(FRAC_PI_2) * 1.05 + 1e-9;
    [phi - margin, phi + margin]
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
