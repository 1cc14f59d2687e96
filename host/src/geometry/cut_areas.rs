//! Areas of a curved solid's surface inside a box: frontal areas along x, y, z and wetted area.
//!
//! Cylinders and cones are made of straight lines, see `ruled`. Every other surface here is swept by circles, or ellipses: balls, mapped or not, by those
//! across an axis, flat ends by those about their middle, tori by those of the tube. On each the sides of the box cut arcs, between whose ends all integrals but one have closed forms (the wetted area of an
//! ellipsoid is a sum of its own). Over the circles they are summed by the rules of Gauss and Kronrod between all places where something changes: where an
//! arc appears, where an edge of the box pierces the surface, where its outline crosses a side. For quadrics these are roots of quadratics: of the
//! planes of the sides and those of the outlines, which touch the circles or meet each other on the surface.

mod ruled;
mod sums;

use super::form::Form;
use glam::DVec3;
use ruled::Ruled;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use sums::{ERROR, MOST_HALVINGS, Sums, arcs, roots, summed, touch};
use voidage_core::number::aabb::Aabb;
use voidage_core::number::kronrod::plus;
use voidage_core::solids::torus::TorusShape;
use voidage_core::surface::surface_area::SurfaceArea;

/// Planes are parallel if the square of the sine of their angle is less.
const PARALLEL: f64 = 1e-28;

/// An end all of which is this near to a plane, as a share of the box, lies in it.
const IN_PLANE: f64 = 1e-12;

/// What the surface of a curved solid has inside a box, in m²; none of solids that are bounded by planes. Surface in the plane of a side has no frontal
/// area, and is wetted if its normal points into the box. Within 1e-10 of the largest side of the box.
#[must_use]
pub fn in_box(form: &Form, within: Aabb<DVec3>) -> Option<SurfaceArea<f64>> {
    let mut sum = [0.0; 4];
    let mut add = |swept: Swept| sum = plus(sum, swept.inside(within), 1.0);
    match form {
        Form::Sphere(s) => {
            add(Swept::ball(s.center, [DVec3::X, DVec3::Y, DVec3::Z].map(|e| e * s.radius), [-1.0, 1.0]))
        }
        Form::Ellipsoid(s) => {
            let center = s.apply(s.shape().center);
            let half =
                [DVec3::X, DVec3::Y, DVec3::Z].map(|e| s.apply(s.shape().center + e * s.shape().semi_axes) - center);
            add(Swept::ball(center, half, [-1.0, 1.0]));
        }
        Form::Cylinder(s) => sum = cone(s.ends(), [s.base_radius(); 2], within),
        Form::Cone(s) => sum = cone(s.ends(), [s.base_radius(), s.top_radius()], within),
        Form::Capsule(s) => {
            let along = (s.to - s.from).try_normalize().unwrap_or(DVec3::Z);
            let (u, v) = along.any_orthonormal_pair();
            let axes = [u, v, along].map(|e| e * s.radius);
            add(Swept::ball(s.from, axes, [-1.0, 0.0]));
            add(Swept::ball(s.to, axes, [0.0, 1.0]));
            sum = plus(sum, Ruled::between([s.from, s.to], [s.radius; 2]).inside(within), 1.0);
        }
        Form::Torus(s) => torus(s).into_iter().flatten().for_each(add),
        Form::Box(_) | Form::Hull(_) => return None,
    }
    let [x, y, z, wetted] = sum;
    Some(SurfaceArea { frontal: [x * 0.5, y * 0.5, z * 0.5], wetted })
}

/// A cone between two discs, and these.
fn cone(ends: [DVec3; 2], radii: [f64; 2], within: Aabb<DVec3>) -> Sums {
    let along = (ends[1] - ends[0]).normalize_or_zero();
    let discs = [Swept::disc(ends[0], -along, radii[0]), Swept::disc(ends[1], along, radii[1])];
    let round = Ruled::between(ends, radii).inside(within);
    discs.into_iter().fold(round, |sum, disc| plus(sum, disc.inside(within), 1.0))
}

/// A torus, or a part of one and its ends.
fn torus(shape: &TorusShape<DVec3>) -> [Option<Swept>; 3] {
    let axis = (shape.axis / shape.axis.abs().max_element()).normalize();
    let start = shape.start / shape.start.abs().max_element();
    let start = (start - axis * axis.dot(start)).normalize();
    let (beside, angle) = (axis.cross(start), shape.angle.min(360.0).to_radians());
    let ring = Swept::Ring(Ring {
        center: shape.center,
        frame: [start, beside, axis],
        radii: [shape.radius, shape.tube],
        angle,
    });
    let end = |turn: f64, sign: f64| {
        let (out, way) = (start * turn.cos() + beside * turn.sin(), beside * turn.cos() - start * turn.sin());
        (shape.angle < 360.0).then(|| Swept::disc(shape.center + out * shape.radius, way * sign, shape.tube))
    };
    [Some(ring), end(0.0, -1.0), end(angle, 1.0)]
}

/// A surface swept by circles.
enum Swept {
    Quadric(Quadric),
    Ring(Ring),
}

/// The points `origin + X e₁ + Y e₂ + t e₃` with X² + Y² = ρ²(t), a polynomial, for a range of t. For a flat end e₃ is zero and t the distance from its middle.
struct Quadric {
    origin: DVec3,
    axes: [DVec3; 3],
    square: [f64; 3],
    range: [f64; 2],
    /// Of a flat end.
    normal: Option<DVec3>,
}

/// A torus: its radius and that of its tube; it begins along the first axis of the frame and turns about the third by an angle.
struct Ring {
    center: DVec3,
    frame: [DVec3; 3],
    radii: [f64; 2],
    angle: f64,
}

/// One of the circles, `center + u cos ψ + v sin ψ`, and the surface beside it: dA = (w₀ + w₁ cos ψ) (a cos ψ + b sin ψ + c) dψ dt.
struct Circle {
    center: DVec3,
    u: DVec3,
    v: DVec3,
    weight: [f64; 2],
    normal: [DVec3; 3],
    /// The length of the second factor is the same all around.
    even: bool,
}

impl Swept {
    /// A ball, mapped, between two heights along the third of its half axes.
    fn ball(origin: DVec3, axes: [DVec3; 3], range: [f64; 2]) -> Self {
        Swept::Quadric(Quadric { origin, axes, square: [1.0, 0.0, -1.0], range, normal: None })
    }

    fn disc(origin: DVec3, normal: DVec3, radius: f64) -> Self {
        let (u, v) = normal.try_normalize().unwrap_or(DVec3::Z).any_orthonormal_pair();
        let axes = [u * radius, v * radius, DVec3::ZERO];
        Swept::Quadric(Quadric { origin, axes, square: [0.0, 0.0, 1.0], range: [0.0, 1.0], normal: Some(normal) })
    }

    /// Does a box around it touch that from the origin to `size`?
    fn may_reach(&self, size: DVec3) -> bool {
        let [lo, hi] = match self {
            Swept::Quadric(Quadric { origin, axes: [e1, e2, e3], square: [c0, c1, c2], range, .. }) => {
                let inner = if *c2 < 0.0 { -c1 / (2.0 * c2) } else { range[0] };
                let squares = [range[0], range[1], inner.clamp(range[0], range[1])].map(|t| (c2 * t + c1) * t + c0);
                let radius = squares.into_iter().fold(0.0, f64::max).sqrt() * (1.0 + 1e-9);
                let beside = (*e1 * *e1 + *e2 * *e2).map(f64::sqrt) * radius;
                let ends = range.map(|t| *origin + *e3 * t);
                [ends[0].min(ends[1]) - beside, ends[0].max(ends[1]) + beside]
            }
            Swept::Ring(Ring { center, radii: [radius, tube], .. }) => {
                [-1.0, 1.0].map(|side| *center + side * (radius + tube) * (1.0 + 1e-9))
            }
        };
        touch([lo, hi], size)
    }

    /// What it has inside a box.
    fn inside(mut self, within: Aabb<DVec3>) -> Sums {
        let size = within.size();
        match &mut self {
            Swept::Quadric(quadric) => quadric.origin -= within.min,
            Swept::Ring(ring) => ring.center -= within.min,
        }
        if !self.may_reach(size) {
            return [0.0; 4];
        }
        let in_plane = match &mut self {
            Swept::Quadric(quadric) => match quadric.side(size) {
                Some((_, false)) => return [0.0; 4],
                Some((axis, true)) => {
                    quadric.origin[axis] = size[axis] * 0.5;
                    true
                }
                None => false,
            },
            Swept::Ring(_) => false,
        };
        let (mut places, range) = match &self {
            Swept::Quadric(quadric) => (quadric.changes(size), quadric.range),
            Swept::Ring(ring) => (ring.changes(size), [0.0, ring.angle]),
        };
        places.extend(range);
        places.sort_by(f64::total_cmp);
        let largest = (size.x * size.y).max(size.y * size.z).max(size.z * size.x);
        let mut sum = [0.0; 4];
        for ends in places.windows(2).filter(|ends| ends[0] < ends[1]) {
            let (middle, half) = ((ends[0] + ends[1]) * 0.5, (ends[1] - ends[0]) * 0.5);
            // Where an arc appears the sums grow as the root of the way beyond: of an angle they are smooth.
            let mut at = |turn: f64| {
                let (sin, cos) = (turn * FRAC_PI_2).sin_cos();
                let t = middle + half * sin;
                let circle = match &self {
                    Swept::Quadric(quadric) => quadric.circle(t),
                    Swept::Ring(ring) => ring.circle(t),
                };
                circle.inside(size).map(|sum| sum * (half * cos * FRAC_PI_2))
            };
            sum = plus(sum, summed(&mut at, [-1.0, 1.0], ERROR * largest, MOST_HALVINGS), 1.0);
        }
        if in_plane { [0.0, 0.0, 0.0, sum[3]] } else { sum }
    }
}

impl Quadric {
    /// Of a flat end in the plane of a side of the box, the axis across it, and whether its normal points into the box.
    fn side(&self, size: DVec3) -> Option<(usize, bool)> {
        let normal = self.normal?;
        let axis = (0..3).find(|&axis| {
            // Its height over the plane across the axis; a unit vector along that may miss 1 by rounding.
            let tilt = normal[(axis + 1) % 3].hypot(normal[(axis + 2) % 3]);
            tilt * self.axes[0].length() <= IN_PLANE * size[axis]
        })?;
        let near = |at: f64| (self.origin[axis] - at).abs() <= IN_PLANE * size[axis];
        if near(0.0) {
            Some((axis, normal[axis] > 0.0))
        } else {
            near(size[axis]).then_some((axis, normal[axis] < 0.0))
        }
    }

    fn circle(&self, t: f64) -> Circle {
        let ([e1, e2, e3], [c0, c1, c2]) = (self.axes, self.square);
        let radius = ((c2 * t + c1) * t + c0).max(0.0).sqrt();
        let steepness = -(c1 * 0.5 + c2 * t);
        let normal = [e2.cross(e3) * radius, e3.cross(e1) * radius, e1.cross(e2) * steepness];
        let [a, b, c] = normal;
        let even = {
            let [aa, bb] = [a, b].map(DVec3::length_squared);
            let slack = 1e-14 * (aa + bb + c.length_squared());
            (aa - bb).abs() <= slack && a.dot(b).abs() <= slack && a.dot(c).abs() <= slack && b.dot(c).abs() <= slack
        };
        Circle { center: self.origin + e3 * t, u: e1 * radius, v: e2 * radius, weight: [1.0, 0.0], normal, even }
    }

    /// The planes `x X + y Y + z t = limit` of the sides of the box, the low and the high one of each axis, and of the outlines seen along the axes.
    fn planes(&self, size: DVec3) -> [[f64; 4]; 9] {
        let [e1, e2, e3] = self.axes;
        let normals = [e2.cross(e3), e3.cross(e1), e1.cross(e2)];
        let mut planes = [[0.0; 4]; 9];
        for axis in 0..3 {
            let along = [e1, e2, e3].map(|e| e[axis]);
            for (n, at) in [0.0, size[axis]].into_iter().enumerate() {
                planes[2 * axis + n] = [along[0], along[1], along[2], at - self.origin[axis]];
            }
            let [x, y, z] = normals.map(|normal| normal[axis]);
            planes[6 + axis] = [x, y, -z * self.square[2], z * self.square[1] * 0.5];
        }
        planes
    }

    /// Where, within the range, arcs appear, end or are met by an outline.
    fn changes(&self, size: DVec3) -> Vec<f64> {
        let planes = self.planes(size);
        let (margin, mut places) = (size * 1e-6, Vec::new());
        let within = |[x, y, t]: [f64; 3]| {
            let p = self.origin + self.axes[0] * x + self.axes[1] * y + self.axes[2] * t;
            (p.cmpge(-margin).all() && p.cmple(size + margin).all()).then_some(t)
        };
        for (n, plane) in planes.iter().enumerate() {
            places.extend(self.touching(plane).into_iter().flatten());
            for other in &planes[n + 1..] {
                places.extend(self.pierced(plane, other).into_iter().flatten().filter_map(within));
            }
        }
        places.retain(|t| *t > self.range[0] && *t < self.range[1]);
        places
    }

    /// The circles that touch a plane, (x² + y²) ρ² = (limit − z t)². Of a plane that is nearly across these are near to each other: what they
    /// differ by is not found as a difference.
    fn touching(&self, &[x, y, z, limit]: &[f64; 4]) -> [Option<f64>; 2] {
        let ([c0, c1, c2], across) = (self.square, x * x + y * y);
        let (square, half, constant) =
            (z * z - across * c2, limit * z + across * c1 * 0.5, limit * limit - across * c0);
        let apart = z * z * c0 + limit * (z * c1 + limit * c2) + across * (c1 * c1 * 0.25 - c0 * c2);
        if !(apart >= 0.0) {
            return [None; 2];
        }
        let q = half + (across * apart).sqrt().copysign(half);
        [(square != 0.0).then(|| q / square), (q != 0.0).then(|| constant / q)]
    }

    /// The points, as X, Y and t, where the line that two planes have in common pierces the surface.
    fn pierced(&self, &[x, y, z, limit]: &[f64; 4], &[u, v, w, other]: &[f64; 4]) -> [Option<[f64; 3]>; 2] {
        let ([c0, c1, c2], a, b) = (self.square, DVec3::new(x, y, z), DVec3::new(u, v, w));
        let along = a.cross(b);
        let length = along.length_squared();
        if !(length > PARALLEL * a.length_squared() * b.length_squared()) {
            return [None; 2];
        }
        let along = along / length.sqrt();
        let from = (b.cross(along) * limit + along.cross(a) * other) / length.sqrt();
        // Zero at the points: X² + Y² − ρ²(t) along the line.
        let square = [
            from.x * from.x + from.y * from.y - (c0 + from.z * (c1 + from.z * c2)),
            2.0 * (from.x * along.x + from.y * along.y - from.z * along.z * c2) - along.z * c1,
            along.x * along.x + along.y * along.y - along.z * along.z * c2,
        ];
        roots(square).map(|s| s.map(|s| (from + along * s).to_array()))
    }
}

impl Ring {
    fn circle(&self, turn: f64) -> Circle {
        let ([start, beside, axis], [radius, tube]) = (self.frame, self.radii);
        let out = start * turn.cos() + beside * turn.sin();
        Circle {
            center: self.center + out * radius,
            u: out * tube,
            v: axis * tube,
            weight: [radius * tube, tube * tube],
            normal: [out, axis, DVec3::ZERO],
            even: true,
        }
    }

    /// Where, within its angle, planes of the sides touch it, circles touch them, and edges of the box pierce it.
    fn changes(&self, size: DVec3) -> Vec<f64> {
        let ([start, beside, axis], [radius, tube]) = (self.frame, self.radii);
        let mut places = Vec::new();
        for n in 0..3 {
            let (toward, reach) = (beside[n].atan2(start[n]), start[n].hypot(beside[n]));
            places.extend([toward, toward + PI]);
            for at in [0.0, size[n]] {
                // With c the cosine of the way around: tube² (reach² c² + axis²) = (limit − radius reach c)².
                let (limit, a) = (at - self.center[n], reach * reach);
                let square = [
                    tube * tube * axis[n] * axis[n] - limit * limit,
                    2.0 * limit * radius * reach,
                    a * (tube * tube - radius * radius),
                ];
                let cosines = roots(square).into_iter().flatten().filter(|c| c.abs() <= 1.0);
                places.extend(cosines.flat_map(|c| [toward - c.acos(), toward + c.acos()]));
            }
        }
        for (n, edge) in (0..3).flat_map(|n| (0..4).map(move |edge| (n, edge))) {
            let mut from = DVec3::ZERO;
            for (bit, across) in [(n + 1) % 3, (n + 2) % 3].into_iter().enumerate() {
                from[across] = if edge >> bit & 1 == 1 { size[across] } else { 0.0 };
            }
            let along = DVec3::AXES[n] * size[n];
            let angle = |s: f64| {
                let p = from + along * s - self.center;
                p.dot(beside).atan2(p.dot(start))
            };
            let mut pierced = [0.0; 4];
            let count = roots_within(&self.along_line(from, along), &mut pierced);
            places.extend(pierced[..count].iter().map(|s| angle(*s)));
        }
        let whole = places.into_iter().map(|turn| turn.rem_euclid(TAU));
        whole.filter(|turn| *turn > 0.0 && *turn < self.angle).collect()
    }

    /// The polynomial that is zero where a line pierces the torus: (|p|² + R² − r²)² − 4 R² (|p|² − (axis · p)²).
    fn along_line(&self, from: DVec3, along: DVec3) -> [f64; 5] {
        let ([.., axis], [radius, tube], p) = (self.frame, self.radii, from - self.center);
        let square = [p.length_squared(), 2.0 * p.dot(along), along.length_squared()];
        let (h0, h1) = (axis.dot(p), axis.dot(along));
        let k = square[0] + radius * radius - tube * tube;
        let four = 4.0 * radius * radius;
        [
            k * k - four * (square[0] - h0 * h0),
            2.0 * k * square[1] - four * (square[1] - 2.0 * h0 * h1),
            2.0 * k * square[2] + square[1] * square[1] - four * (square[2] - h1 * h1),
            2.0 * square[1] * square[2],
            square[2] * square[2],
        ]
    }
}

/// Roots of a polynomial between 0 and 1, of at most fourth degree, the lowest coefficient first: between those of its derivative. Calls itself for these.
fn roots_within(polynomial: &[f64], roots: &mut [f64; 4]) -> usize {
    let value = |c: &[f64], s: f64| c.iter().rev().fold(0.0, |sum, c| sum * s + c);
    let [_, rest @ ..] = polynomial else { return 0 };
    if rest.is_empty() {
        return 0;
    }
    let derivative: Vec<f64> = rest.iter().zip(1..).map(|(c, n)| c * f64::from(n)).collect();
    let mut turns = [0.0; 4];
    let turning = roots_within(&derivative, &mut turns);
    let (mut count, mut lo) = (0, 0.0);
    for &hi in turns[..turning].iter().chain(&[1.0]) {
        let (mut a, mut b) = (lo, hi);
        let rises = value(polynomial, b) > 0.0;
        if (value(polynomial, a) > 0.0) != rises && count < 4 {
            while (a + b) * 0.5 > a && (a + b) * 0.5 < b {
                let middle = (a + b) * 0.5;
                if (value(polynomial, middle) > 0.0) == rises { b = middle } else { a = middle }
            }
            roots[count] = b;
            count += 1;
        }
        lo = hi;
    }
    count
}

impl Circle {
    /// The sums over what lies in a box from the origin to `size`.
    fn inside(&self, size: DVec3) -> Sums {
        let Circle { center, u, v, weight, normal: [a, b, c], even } = self;
        let mut cuts = Cuts::default();
        for axis in 0..3 {
            let (reach, toward) = (u[axis].hypot(v[axis]), v[axis].atan2(u[axis]));
            for (limit, toward) in [(size[axis] - center[axis], toward), (center[axis], toward + PI)] {
                if reach > limit.abs() {
                    cuts.add(toward, limit / reach);
                } else if limit < 0.0 {
                    return [0.0; 4];
                }
            }
        }
        for axis in 0..3 {
            let reach = a[axis].hypot(b[axis]);
            if reach > c[axis].abs() {
                cuts.add(b[axis].atan2(a[axis]), -c[axis] / reach);
            }
        }
        let mut sum = [0.0; 4];
        for [from, to] in cuts.arcs() {
            let (y, x) = ((from + to) * 0.5).sin_cos();
            let middle = *center + *u * x + *v * y;
            if !(middle.cmpge(DVec3::ZERO).all() && middle.cmple(size).all()) {
                continue;
            }
            let ((s0, c0), (s1, c1), turn) = (from.sin_cos(), to.sin_cos(), to - from);
            let (cos, sin) = (s1 - s0, c0 - c1);
            let (cos_cos, cos_sin) = ((turn + s1 * c1 - s0 * c0) * 0.5, (s1 * s1 - s0 * s0) * 0.5);
            let area =
                (*a * cos + *b * sin + *c * turn) * weight[0] + (*a * cos_cos + *b * cos_sin + *c * cos) * weight[1];
            let around = if *even {
                (*a * x + *b * y + *c).length() * (weight[0] * turn + weight[1] * cos)
            } else {
                self.length(from, to)
            };
            sum = plus(sum, [area.x.abs(), area.y.abs(), area.z.abs(), around], 1.0);
        }
        sum
    }

    /// The sum of the length of the normal over an arc.
    fn length(&self, from: f64, to: f64) -> f64 {
        let [a, b, c] = self.normal;
        let (middle, half) = ((from + to) * 0.5, (to - from) * 0.5);
        let mut at = |turn: f64| {
            let (sin, cos) = (middle + half * turn).sin_cos();
            [(a * cos + b * sin + c).length() * half, 0.0, 0.0, 0.0]
        };
        let most = a.length() + b.length() + c.length();
        summed(&mut at, [-1.0, 1.0], ERROR * most, MOST_HALVINGS)[0]
    }
}

/// Angles at which arcs of a circle begin or end: two for each side of a box and each of three outlines.
#[derive(Default)]
struct Cuts {
    angles: [f64; 18],
    count: usize,
}

impl Cuts {
    /// Where the cosine of the angle from `toward` has a value.
    fn add(&mut self, toward: f64, cos: f64) {
        let half = cos.clamp(-1.0, 1.0).acos();
        for angle in [toward - half, toward + half] {
            self.angles[self.count] = angle.rem_euclid(TAU);
            self.count += 1;
        }
    }

    /// The arcs between them.
    fn arcs(&mut self) -> impl Iterator<Item = [f64; 2]> {
        arcs(&mut self.angles[..self.count])
    }
}
