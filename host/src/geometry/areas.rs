//! Areas of whole bodies: of solids by formula in closed form, of others from their triangles.
//!
//! Of a convex solid the frontal area is that of its outline. Of ellipsoids the surface, and of tori the frontal area, are elliptic integrals, by the
//! duplication of B. C. Carlson, *Numerical computation of real or complex elliptic integrals*, Numerical Algorithms 10, 1995.

use super::bodies::Body;
use super::form::Form;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use voidage_core::convex::shape::Ellipsoid;
use voidage_core::convex::support::Transformed;
use voidage_core::solids::torus::TorusShape;
use voidage_core::surface::surface_area::SurfaceArea;

/// Frontal areas along x, y, z and wetted area of a body alone, in m²; `triangles` are its own.
#[must_use]
pub fn of_body(body: &Body, triangles: &[[DVec3; 3]]) -> SurfaceArea<f64> {
    match body.form.as_ref().filter(|_| triangles.is_empty()).and_then(of_form) {
        Some(area) => area,
        None => of_triangles(triangles),
    }
}

/// The same of triangles, each from one side.
#[must_use]
pub fn of_triangles(triangles: &[[DVec3; 3]]) -> SurfaceArea<f64> {
    let mut sum = SurfaceArea::default();
    for [a, b, c] in triangles {
        let area = (*b - *a).cross(*c - *a) * 0.5;
        sum = sum.plus(SurfaceArea { frontal: (area.abs() * 0.5).to_array(), wetted: area.length() });
    }
    sum
}

/// The same of a curved solid; none for those bounded by planes, whose triangles are the body itself.
#[must_use]
pub fn of_form(form: &Form) -> Option<SurfaceArea<f64>> {
    let along_axes = |seen: &dyn Fn(DVec3) -> f64| [DVec3::X, DVec3::Y, DVec3::Z].map(seen);
    let area = match form {
        Form::Sphere(s) => {
            let disc = PI * s.radius * s.radius;
            SurfaceArea { frontal: [disc; 3], wetted: 4.0 * disc }
        }
        Form::Capsule(s) => {
            let (axis, r) = (s.to - s.from, s.radius);
            let frontal = along_axes(&|d| PI * r * r + 2.0 * r * d.cross(axis).length());
            SurfaceArea { frontal, wetted: 4.0 * PI * r * r + TAU * r * axis.length() }
        }
        Form::Cylinder(s) => of_cone(s.ends(), [s.base_radius(); 2]),
        Form::Cone(s) => of_cone(s.ends(), [s.base_radius(), s.top_radius()]),
        Form::Ellipsoid(s) => of_ellipsoid(s),
        Form::Torus(s) => of_torus(s),
        Form::Box(_) | Form::Hull(_) => return None,
    };
    Some(area)
}

/// The largest share by which the facets that stand for a curved body miss one of the areas of the whole body; 0 without such bodies. Each body comes with its
/// facets, which those that have triangles of their own lack.
#[must_use]
pub fn facet_error<'a>(bodies: impl Iterator<Item = (&'a Body, &'a Vec<[DVec3; 3]>)>) -> f64 {
    let error = |(body, facets): (&Body, &Vec<[DVec3; 3]>)| {
        if facets.is_empty() {
            return None;
        }
        let (facets, true_area) = (of_triangles(facets), body.form.as_ref().and_then(of_form)?);
        let miss = |facets: f64, truth: f64| if truth > 0.0 { (facets / truth - 1.0).abs() } else { 0.0 };
        let frontal = facets.frontal.into_iter().zip(true_area.frontal).map(|(facets, truth)| miss(facets, truth));
        Some(frontal.fold(miss(facets.wetted, true_area.wetted), f64::max))
    };
    bodies.filter_map(error).fold(0.0, f64::max)
}

/// A cone between two discs across its axis.
fn of_cone([from, to]: [DVec3; 2], radii: [f64; 2]) -> SurfaceArea<f64> {
    let (axis, [a, b]) = (to - from, [radii[0].max(radii[1]), radii[0].min(radii[1])]);
    let height = axis.length();
    let frontal = [DVec3::X, DVec3::Y, DVec3::Z].map(|d| {
        let across = d.cross(axis).length();
        let lean = if height > 0.0 { (d.dot(axis) / height).abs() } else { 0.0 };
        outline_of_ellipses([a, b], lean, across)
    });
    let slant = height.hypot(a - b);
    SurfaceArea { frontal, wetted: PI * ((a + b) * slant + a * a + b * b) }
}

/// The area of the hull of two ellipses, with half axes a ≥ b across the line between their centres and `lean` times as long along it; `apart` is
/// the distance of the centres.
fn outline_of_ellipses([a, b]: [f64; 2], lean: f64, apart: f64) -> f64 {
    let narrower = (a - b) * lean;
    if apart <= narrower {
        return PI * a * a * lean;
    }
    // Both ellipses are touched where the normal of the circles that they are when stretched makes this angle with the line.
    let angle = (narrower / apart).acos();
    (a + b) * ((apart - narrower) * (apart + narrower)).sqrt() + lean * (a * a * (PI - angle) + b * b * angle)
}

/// An ellipsoid is a ball of radius 1 mapped by three half axes; so are its areas.
fn of_ellipsoid(solid: &Transformed<Ellipsoid<DVec3>>) -> SurfaceArea<f64> {
    let (shape, origin) = (solid.shape(), solid.apply(DVec3::ZERO));
    let [a, b, c] = [DVec3::X, DVec3::Y, DVec3::Z].map(|d| solid.apply(d * shape.semi_axes) - origin);
    let faces = [b.cross(c), c.cross(a), a.cross(b)];
    let frontal = [0, 1, 2].map(|axis| PI * DVec3::from_array(faces.map(|face| face[axis])).length());
    // DLMF 19.33.1.
    let [x, y, z] = faces.map(DVec3::length);
    SurfaceArea { frontal, wetted: 4.0 * PI * symmetric_second_kind([x, y, z]) }
}

/// A torus, or a part of one between flat ends. At each place along it a circle of normals is seen with a mean that has no closed form but is the square
/// root of what the normals' plane shows of the line of sight.
fn of_torus(shape: &TorusShape<DVec3>) -> SurfaceArea<f64> {
    let axis = (shape.axis / shape.axis.abs().max_element()).normalize();
    let start = shape.start / shape.start.abs().max_element();
    let start = (start - axis * axis.dot(start)).normalize();
    let beside = axis.cross(start);
    let (angle, whole) = (shape.angle.min(360.0).to_radians(), shape.angle >= 360.0);
    let disc = PI * shape.tube * shape.tube;
    let frontal = [DVec3::X, DVec3::Y, DVec3::Z].map(|d| {
        let (along, across) = (d.dot(start), d.dot(beside));
        let (seen, toward) = (along.hypot(across).min(1.0), across.atan2(along));
        let way = second_kind(angle - toward, seen) - second_kind(-toward, seen);
        let end = |turn: f64| disc * (beside * turn.cos() - start * turn.sin()).dot(d).abs() * 0.5;
        2.0 * shape.radius * shape.tube * way + if whole { 0.0 } else { end(0.0) + end(angle) }
    });
    let ends = if whole { 0.0 } else { 2.0 * disc };
    SurfaceArea { frontal, wetted: TAU * shape.tube * shape.radius * angle + ends }
}

/// E(φ, k) = ∫ √(1 − k² sin²t) dt from 0 to φ, for any φ.
fn second_kind(angle: f64, k: f64) -> f64 {
    let halves = (angle / PI).round();
    let (sin, cos) = (angle - halves * PI).sin_cos();
    let within = |sin: f64, cos: f64| {
        let arguments = [cos * cos, (1.0 - k * sin) * (1.0 + k * sin), 1.0];
        let (first, third) = carlson(arguments);
        sin * first - k * k * sin.powi(3) * third / 3.0
    };
    let whole = within(1.0, FRAC_PI_2.cos());
    within(sin, cos) + if halves == 0.0 { 0.0 } else { 2.0 * halves * whole }
}

/// Carlson's R_G of the squares of three lengths.
fn symmetric_second_kind(lengths: [f64; 3]) -> f64 {
    let mut l = lengths;
    l.sort_by(f64::total_cmp);
    let [small, middle, large] = l;
    if !(middle > 0.0) {
        return large * 0.5;
    }
    // Of any size: the largest counts as one.
    let [x, y, z] = [small / large, middle / large, 1.0].map(|v| v * v);
    let (first, third) = carlson([x, y, z]);
    large * 0.5 * (z * first - (x - z) * (y - z) * third / 3.0 + (x * y / z).sqrt())
}

/// Carlson's R_F and R_D of three numbers, at most one of which is 0, and not the last.
fn carlson([mut x, mut y, mut z]: [f64; 3]) -> (f64, f64) {
    let (mut sum, mut scale) = (0.0, 1.0);
    // Each step brings the numbers four times nearer to each other.
    for _ in 0..64 {
        let mean = (x + y + 3.0 * z) / 5.0;
        let farthest = (mean - x).abs().max((mean - y).abs()).max((mean - z).abs());
        if farthest < 1e-3 * mean {
            break;
        }
        let (u, v, w) = (x.sqrt(), y.sqrt(), z.sqrt());
        let step = u * v + v * w + w * u;
        sum += scale / (w * (z + step));
        scale *= 0.25;
        (x, y, z) = ((x + step) * 0.25, (y + step) * 0.25, (z + step) * 0.25);
    }
    let mean = (x + y + z) / 3.0;
    let [p, q] = [x, y].map(|n| 1.0 - n / mean);
    let r = -p - q;
    let (e2, e3) = (p * q - r * r, p * q * r);
    let first = (1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0) / mean.sqrt();
    let mean = (x + y + 3.0 * z) / 5.0;
    let [p, q] = [x, y].map(|n| 1.0 - n / mean);
    let r = -(p + q) / 3.0;
    let (e2, e3) = (p * q - 6.0 * r * r, (3.0 * p * q - 8.0 * r * r) * r);
    let (e4, e5) = (3.0 * (p * q - r * r) * r * r, p * q * r.powi(3));
    let series = 1.0 - 3.0 * e2 / 14.0 + e3 / 6.0 + 9.0 * e2 * e2 / 88.0 - 3.0 * e4 / 22.0 - 9.0 * e2 * e3 / 52.0
        + 3.0 * e5 / 26.0;
    (first, 3.0 * sum + scale * series / (mean * mean.sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::facets;
    use voidage_core::convex::shape::{Capsule, Cone, Cylinder, Sphere};

    /// E and R_G against the midpoint rule, whose sum over a period of a smooth function is exact to rounding.
    #[test]
    fn elliptic_integrals_as_sums() {
        for k in [0.0, 0.3, 0.9, 0.99] {
            let sum = |from: f64, to: f64| {
                let steps = 400_000;
                let step = (to - from) / f64::from(steps);
                let at = |n: i32| from + (f64::from(n) + 0.5) * step;
                (0..steps).map(|n| (1.0 - (k * at(n).sin()).powi(2)).sqrt()).sum::<f64>() * step
            };
            for angle in [-7.0, -1.0, 0.2, 1.5, 3.0, 20.0] {
                let (found, truth) = (second_kind(angle, k), sum(0.0, angle));
                assert!((found - truth).abs() < 1e-9, "{k}, {angle}: {found}, {truth}");
            }
        }
        assert!((second_kind(FRAC_PI_2, 1.0) - 1.0).abs() < 1e-14);
        assert!((second_kind(2.0, 1.0) - (2.0 - 2.0_f64.sin())).abs() < 1e-14);
        // Balls, a spheroid by its logarithm, a disc.
        assert!((symmetric_second_kind([3.0; 3]) - 3.0).abs() < 1e-14);
        assert!((symmetric_second_kind([0.0, 0.0, 2.0]) - 1.0).abs() < 1e-15);
    }

    /// Spheroids: 2πa² + π c²/e · ln((1 + e)/(1 − e)) if flat, 2πa²(1 + c/(a e) asin e) if long.
    #[test]
    fn spheroids_by_elementary_functions() {
        for (a, c) in [(1.0_f64, 0.2_f64), (1.0, 0.01), (0.5, 2.0), (1e-3, 1.0)] {
            let truth = if c < a {
                let e = (1.0 - (c / a).powi(2)).sqrt();
                TAU * a * a + PI * c * c / e * ((1.0 + e) * (a / c)).powi(2).ln()
            } else {
                let e = (1.0 - (a / c).powi(2)).sqrt();
                TAU * a * a * (1.0 + c / (a * e) * e.asin())
            };
            let found = 4.0 * PI * symmetric_second_kind([a * c, a * c, a * a]);
            assert!((found / truth - 1.0).abs() < 1e-12, "{a}, {c}: {found}, {truth}");
        }
    }

    /// All forms, turned, against their facets, which are within 5e-4.
    #[test]
    fn forms_as_their_facets() {
        let (from, to) = (DVec3::new(0.4, 0.5, 0.6), DVec3::new(2.3, 1.9, 2.2));
        let turn = glam::DMat3::from_euler(glam::EulerRot::XYZ, 0.4, 1.1, -0.7);
        let ellipsoid = |semi_axes| {
            let shape = Ellipsoid { center: DVec3::ZERO, semi_axes };
            Form::Ellipsoid(Transformed::new(shape, [turn.x_axis, turn.y_axis, turn.z_axis], DVec3::ONE, from))
        };
        let torus = |angle| {
            let (center, axis, start) = (from, to - from, DVec3::X);
            Form::Torus(TorusShape { center, axis, start, radius: 0.7, tube: 0.2, angle })
        };
        let forms = [
            Form::Sphere(Sphere { center: from, radius: 0.3 }),
            Form::Capsule(Capsule { from, to, radius: 0.3 }),
            Form::Cylinder(Cylinder::new(from, to, 0.3)),
            Form::Cone(Cone::new(from, to, 0.9)),
            Form::Cone(Cone::truncated(from, to, 0.4, 0.9)),
            Form::Cone(Cone::truncated(from, from + DVec3::new(0.01, 0.02, 0.2), 1.4, 0.1)),
            ellipsoid(DVec3::new(0.5, 0.3, 0.9)),
            torus(360.0),
            torus(75.0),
            torus(200.0),
        ];
        for form in forms {
            let (found, facets) = (of_form(&form).expect("curved"), of_triangles(&facets::triangles(&form)));
            let near = |found: f64, facets: f64| (found / facets - 1.0).abs() < 1e-3;
            assert!(near(found.wetted, facets.wetted), "{form:?}: {found:?}, {facets:?}");
            for axis in 0..3 {
                assert!(near(found.frontal[axis], facets.frontal[axis]), "{form:?}: {found:?}, {facets:?}");
            }
        }
    }
}
