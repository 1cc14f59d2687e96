//! Chords of solids by formula with twice the digits of a double: those of [`crate::quadrature`] are rounded, which weighs the more
//! the larger a solid is and the flatter its surface cuts a face.

use crate::quadrature::Exact;
use glam::DVec3;

/// A number as the sum of two.
#[derive(Clone, Copy)]
struct Twofold(f64, f64);

impl Twofold {
    fn plus(self, other: Self) -> Self {
        let sum = self.0 + other.0;
        let part = sum - self.0;
        let rest = (self.0 - (sum - part)) + (other.0 - part) + self.1 + other.1;
        let high = sum + rest;
        Twofold(high, rest - (high - sum))
    }

    fn times(self, other: Self) -> Self {
        let product = self.0 * other.0;
        let rest = self.0.mul_add(other.0, -product) + self.0 * other.1 + self.1 * other.0;
        let high = product + rest;
        Twofold(high, rest - (high - product))
    }

    fn over(self, other: Self) -> Self {
        let quotient = Twofold(self.0 / other.0, 0.0);
        let rest = self.plus(quotient.times(other).negated());
        quotient.plus(Twofold(rest.0 / other.0, 0.0))
    }

    fn negated(self) -> Self {
        Twofold(-self.0, -self.1)
    }
}

type Vector = [Twofold; 3];

fn apart(p: DVec3, from: DVec3) -> Vector {
    [0, 1, 2].map(|n| Twofold(p[n], 0.0).plus(Twofold(-from[n], 0.0)))
}

fn dot(a: &Vector, b: &Vector) -> Twofold {
    [1, 2].iter().fold(a[0].times(b[0]), |sum, &n: &usize| sum.plus(a[n].times(b[n])))
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    [0, 1, 2].map(|n: usize| {
        let (u, v) = ((n + 1) % 3, (n + 2) % 3);
        a[u].times(b[v]).plus(a[v].times(b[u]).negated())
    })
}

fn exactly(v: DVec3) -> Vector {
    v.to_array().map(|x| Twofold(x, 0.0))
}

/// What is 0 on a surface, and how it grows along axis `m`, of each surface that bounds a solid, at the point `p + t` along that axis.
fn surfaces(solid: &Exact, p: DVec3, m: usize, t: f64) -> Vec<(Twofold, f64)> {
    let e = exactly(DVec3::AXES[m]);
    let from_here = |origin: DVec3| {
        let mut w = apart(p, origin);
        w[m] = w[m].plus(Twofold(t, 0.0));
        w
    };
    let square = |r: f64| Twofold(r, 0.0).times(Twofold(r, 0.0));
    let ball = |center: DVec3, r: f64| {
        let w = from_here(center);
        (dot(&w, &w).plus(square(r).negated()), 2.0 * dot(&w, &e).0)
    };
    let plane = |at: DVec3, axis: &Vector| (dot(&from_here(at), axis), dot(&e, axis).0);
    let tube = |from: DVec3, axis: &Vector, r: f64| {
        let across = cross(&from_here(from), axis);
        let size = dot(axis, axis);
        (dot(&across, &across).plus(square(r).times(size).negated()), 2.0 * dot(&across, &cross(&e, axis)).0)
    };
    match *solid {
        Exact::Ball(center, r) => vec![ball(center, r)],
        Exact::Ellipsoid(center, axes) => {
            let w = from_here(center);
            let (mut sum, mut growth) = (Twofold(-1.0, 0.0), 0.0);
            for axis in axes.map(exactly) {
                let size = dot(&axis, &axis);
                let part = dot(&w, &axis).over(size);
                sum = sum.plus(part.times(part));
                growth += 2.0 * part.0 * dot(&e, &axis).0 / size.0;
            }
            vec![(sum, growth)]
        }
        Exact::Cylinder(from, to, r) => {
            let axis = apart(to, from);
            vec![tube(from, &axis, r), plane(from, &axis), plane(to, &axis)]
        }
        Exact::Capsule(from, to, r) => {
            let axis = apart(to, from);
            let along = dot(&from_here(from), &axis).over(dot(&axis, &axis)).0;
            vec![match along {
                x if x < 0.0 => ball(from, r),
                x if x > 1.0 => ball(to, r),
                _ => tube(from, &axis, r),
            }]
        }
        Exact::Cone(base, apex, r) => {
            let (axis, w) = (apart(base, apex), from_here(apex));
            let (across, along, size) = (cross(&w, &axis), dot(&w, &axis), dot(&axis, &axis));
            let side = dot(&across, &across).times(size).plus(square(r).times(along.times(along)).negated());
            let growth = dot(&across, &cross(&e, &axis)).0 * size.0 - r * r * along.0 * dot(&e, &axis).0;
            vec![(side, 2.0 * growth), plane(base, &axis)]
        }
        Exact::Frustum(from, to, [one, other]) => {
            let (axis, w) = (apart(to, from), from_here(from));
            let (across, size) = (cross(&w, &axis), dot(&axis, &axis));
            let change = Twofold(other, 0.0).plus(Twofold(-one, 0.0));
            // The radius there, times the square of the axis.
            let radius = Twofold(one, 0.0).times(size).plus(change.times(dot(&w, &axis)));
            let side = dot(&across, &across).times(size).plus(radius.times(radius).negated());
            let growth = dot(&across, &cross(&e, &axis)).0 * size.0 - radius.0 * change.0 * dot(&e, &axis).0;
            vec![(side, 2.0 * growth), plane(from, &axis), plane(to, &axis)]
        }
    }
}

/// What the line through `p` along axis `m` has inside, as coordinates along it.
#[must_use]
pub fn chord(solid: &Exact, p: DVec3, m: usize) -> Option<[f64; 2]> {
    let found = solid.chord(p, m)?;
    Some(found.map(|end| {
        let mut t = end - p[m];
        for _ in 0..2 {
            let steps = surfaces(solid, p, m, t).into_iter().map(|(value, growth)| -value.0 / growth);
            let least = steps.filter(|s| s.is_finite()).min_by(|a, b| a.abs().total_cmp(&b.abs()));
            t += least.filter(|s| s.abs() < 1e-6).unwrap_or(0.0);
        }
        p[m] + t
    }))
}
