//! The round surface of a cylinder or cone inside a box, line by line.
//!
//! Each of its straight lines is cut by the sides of the box to one piece, over which the areas have closed forms. Around the axis they are summed between
//! all lines where something changes: those on which an edge of the box pierces the surface, or a side cuts one of its two end circles, and those of its
//! outlines seen along x, y and z. Between these the sums are trigonometric polynomials for a cylinder, smooth for a cone.

use super::sums::{ERROR, MOST_HALVINGS, Sums, arcs, roots, summed, touch};
use glam::DVec3;
use std::f64::consts::TAU;
use voidage_core::number::aabb::Aabb;
use voidage_core::number::kronrod::plus;

/// The lines `from + w(ψ) a + t (along + w(ψ) (b − a))`, t from 0 to 1, where w = u cos ψ + v sin ψ; u and v as long as the larger radius, of which a and b are
/// the shares that the radii at both ends have.
pub(super) struct Ruled {
    from: DVec3,
    along: DVec3,
    across: [DVec3; 2],
    shares: [f64; 2],
}

/// What is this near to the box, as a share of it, may bound a piece.
const MARGIN: f64 = 1e-6;

/// Lines at which pieces change: at most two for each of 12 edges, for each of 6 sides on two circles, and for each of three outlines.
#[derive(Default)]
struct Turns {
    angles: [[f64; 18]; 3],
    count: usize,
}

impl Turns {
    fn add(&mut self, angle: f64) {
        if let Some(place) = self.angles.as_flattened_mut().get_mut(self.count) {
            *place = angle.rem_euclid(TAU);
            self.count += 1;
        }
    }

    /// Where `x cos ψ + y sin ψ` has a value.
    fn add_where(&mut self, [x, y]: [f64; 2], value: f64, wanted: impl Fn(f64) -> bool) {
        let reach = x.hypot(y);
        if reach > value.abs() {
            let (toward, half) = (y.atan2(x), (value / reach).acos());
            [toward - half, toward + half].into_iter().filter(|angle| wanted(*angle)).for_each(|angle| self.add(angle));
        }
    }

    /// The arcs between them.
    fn arcs(&mut self) -> impl Iterator<Item = [f64; 2]> {
        arcs(&mut self.angles.as_flattened_mut()[..self.count])
    }
}

impl Ruled {
    /// Between two discs, without these.
    pub fn between([from, to]: [DVec3; 2], radii: [f64; 2]) -> Self {
        let (u, v) = (to - from).try_normalize().unwrap_or(DVec3::Z).any_orthonormal_pair();
        let large = radii[0].max(radii[1]);
        let shares = radii.map(|radius| if large > 0.0 { radius / large } else { 0.0 });
        Ruled { from, along: to - from, across: [u * large, v * large], shares }
    }

    /// What it has inside a box.
    pub fn inside(mut self, within: Aabb<DVec3>) -> Sums {
        let size = within.size();
        self.from -= within.min;
        if touch(self.bounds(), size) { self.inside_box(size) } else { [0.0; 4] }
    }

    /// Lowest and highest coordinates.
    fn bounds(&self) -> [DVec3; 2] {
        let ([u, v], [a, b]) = (self.across, self.shares);
        let beside = (u * u + v * v).map(f64::sqrt) * (1.0 + 1e-9);
        let to = self.from + self.along;
        [(self.from - beside * a).min(to - beside * b), (self.from + beside * a).max(to + beside * b)]
    }

    /// What it has in a box from the origin to `size`.
    fn inside_box(&self, size: DVec3) -> Sums {
        let largest = (size.x * size.y).max(size.y * size.z).max(size.z * size.x);
        let normals = self.normals();
        let mut turns = self.changes(size, &normals);
        let mut sum = [0.0; 4];
        for [from, to] in turns.arcs() {
            let mut at = |turn: f64| self.line(turn, &normals, size);
            // Between two such lines either all have a piece in the box or none.
            if from < to && at((from + to) * 0.5) != [0.0; 4] {
                sum = plus(sum, summed(&mut at, [from, to], ERROR * largest, MOST_HALVINGS), 1.0);
            }
        }
        sum
    }

    /// The normal at angle ψ is the first times cos ψ, the second times sin ψ and the third, together as long as dA / (ρ dψ dt), ρ the share of the radius.
    fn normals(&self) -> [DVec3; 3] {
        let ([u, v], [a, b]) = (self.across, self.shares);
        [v.cross(self.along), self.along.cross(u), u.cross(v) * (a - b)]
    }

    /// The areas of one line's piece in the box, for each radian.
    fn line(&self, turn: f64, [across, aside, along]: &[DVec3; 3], size: DVec3) -> Sums {
        let ([u, v], [a, b], (sin, cos)) = (self.across, self.shares, turn.sin_cos());
        let out = u * cos + v * sin;
        let (start, way) = (self.from + out * a, self.along + out * (b - a));
        let (mut lo, mut hi) = (0.0f64, 1.0f64);
        for axis in 0..3 {
            let (at, step) = (start[axis], way[axis]);
            if step == 0.0 {
                if !(at >= 0.0 && at <= size[axis]) {
                    return [0.0; 4];
                }
            } else {
                let (low, high) = (-at / step, (size[axis] - at) / step);
                (lo, hi) = (lo.max(low.min(high)), hi.min(low.max(high)));
            }
        }
        if !(lo < hi) {
            return [0.0; 4];
        }
        let share = (hi - lo) * (a + (b - a) * (hi + lo) * 0.5);
        let normal = *across * cos + *aside * sin + *along;
        let DVec3 { x, y, z } = normal.abs() * share;
        [x, y, z, normal.length() * share]
    }

    fn changes(&self, size: DVec3, normals: &[DVec3; 3]) -> Turns {
        let mut turns = Turns::default();
        let margin = size * MARGIN;
        let [a, b] = self.shares;
        let is_near = |p: DVec3| p.cmpge(-margin).all() && p.cmple(size + margin).all();
        for axis in 0..3 {
            let of_axis = self.across.map(|e| e[axis]);
            for (share, center) in [(a, self.from), (b, self.from + self.along)] {
                let [u, v] = self.across.map(|e| e * share);
                let in_box = |angle: f64| is_near(center + u * angle.cos() + v * angle.sin());
                for limit in [0.0, size[axis]] {
                    turns.add_where(of_axis.map(|e| e * share), limit - center[axis], in_box);
                }
            }
            let [x, y, z] = normals.map(|normal| normal[axis]);
            turns.add_where([x, y], -z, |_| true);
        }
        self.pierced(size, &mut turns);
        turns
    }

    /// The lines on which an edge of the box pierces the surface.
    fn pierced(&self, size: DVec3, turns: &mut Turns) {
        let ([u, v], [a, b]) = (self.across, self.shares);
        // From a point to how far it is along each axis of the surface, of which these are at right angles.
        let [u, v, along] = [u, v, self.along].map(|e| e / e.length_squared());
        let place = |p: DVec3| [u.dot(p), v.dot(p), along.dot(p)];
        for axis in 0..3 {
            let [i, j] = [(axis + 1) % 3, (axis + 2) % 3];
            let [x1, y1, t1] = [u[axis], v[axis], along[axis]];
            for corner in 0..4 {
                let mut from = -self.from;
                from[i] += if corner & 1 == 1 { size[i] } else { 0.0 };
                from[j] += if corner & 2 == 2 { size[j] } else { 0.0 };
                let [x0, y0, t0] = place(from);
                // Zero on the surface: X² + Y² − ρ²(t) along the edge.
                let (share, slope) = (a + (b - a) * t0, (b - a) * t1);
                let square = [
                    x0 * x0 + y0 * y0 - share * share,
                    2.0 * (x0 * x1 + y0 * y1 - share * slope),
                    x1 * x1 + y1 * y1 - slope * slope,
                ];
                for s in roots(square).into_iter().flatten() {
                    let (within, t) = (size[axis] * MARGIN, t0 + t1 * s);
                    if s >= -within && s <= size[axis] + within && (-MARGIN..=1.0 + MARGIN).contains(&t) {
                        turns.add((y0 + y1 * s).atan2(x0 + x1 * s));
                    }
                }
            }
        }
    }
}
