//! Solids by formula inside each other, and beside, on and through bodies of triangles, against quadrature of what they have in common.

use glam::{DMat3, DVec3};
use std::f64::consts::PI;
use voidage::geometry::bodies::Bodies;
use voidage::geometry::form::Form;
use voidage::grid::Edges;
use voidage::porosity::{FieldSet, Method, Options, Porosity, porosity};
use voidage_core::convex::shape::{Capsule, Cone, Cylinder, Sphere};
use voidage_core::solids::torus::TorusShape;
use voidage_tests::effort::cases;
use voidage_tests::quadrature::{Exact, common_volume};
use voidage_tests::quadric::volume;
use voidage_tests::random::Random;
use voidage_tests::solids::{self, formulas};

/// Cells of half a unit in a cube of 4, the first plane at `first`.
fn lists(first: f64) -> Edges {
    Edges([0, 1, 2].map(|axis| (0..=10).map(|i| first * f64::from(axis + 1) + 0.5 * f64::from(i)).collect()))
}

fn run(edges: &Edges, bodies: &Bodies, method: Method) -> Porosity {
    let options = Options { bounds: true, method, ..Options::default() };
    porosity(&edges.grid(None).expect("a grid"), bodies, options)
}

fn form(exact: &Exact) -> Form {
    match *exact {
        Exact::Ball(center, radius) => Form::Sphere(Sphere { center, radius }),
        Exact::Capsule(from, to, radius) => Form::Capsule(Capsule { from, to, radius }),
        Exact::Cylinder(from, to, radius) => Form::Cylinder(Cylinder::new(from, to, radius)),
        Exact::Frustum(from, to, [r, s]) => Form::Cone(Cone::truncated(from, to, r, s)),
        _ => panic!("no such solid here: {exact:?}"),
    }
}

fn pick<T: Copy>(random: &mut Random, some: &[T]) -> T {
    some[random.below(some.len())]
}

/// A rod, and one along it: as long or not, from the same end or not, as thick or not, beside its axis, a little turned; or a ball or capsule in it.
fn along_each_other(random: &mut Random) -> [Exact; 2] {
    let turned = DVec3::from_array(random.on_sphere());
    let along = pick(random, &[DVec3::X, DVec3::Y, DVec3::Z, turned, turned, turned]);
    let from = DVec3::splat(2.5) - along * 0.9 + DVec3::from_array(random.on_sphere()) * 0.4;
    let (length, radius) = (random.between(0.7, 1.9), random.between(0.2, 0.6));
    let to = from + along * length;
    let across = along.any_orthonormal_vector();
    let thick = radius * pick(random, &[1.0, 0.999, 0.6, 0.6, 1.1]);
    let tilt = across * pick(random, &[0.0, 0.0, 0.0, 1e-12, 1e-6, 1e-2]);
    let beside = across * (radius * pick(random, &[0.0, 0.0, 0.3, 0.4]));
    let place = |at: f64| {
        if at == 0.0 {
            from
        } else if at == 1.0 {
            to
        } else {
            from + along * (length * at)
        }
    };
    let (a, b) = (pick(random, &[0.0, 0.0, -0.3, 0.2]), pick(random, &[1.0, 1.0, 1.3, 0.6]));
    let ends = [place(a) + beside, place(b) + beside + tilt];
    let [a, b] = if random.below(3) == 0 { [ends[1], ends[0]] } else { ends };
    let outer = match random.below(3) {
        0 => Exact::Frustum(from, to, [radius, radius * random.between(0.4, 1.0)]),
        _ => Exact::Cylinder(from, to, radius),
    };
    let inner = match random.below(8) {
        0 => Exact::Frustum(a, b, [thick, thick * random.between(0.3, 1.2)]),
        1 => Exact::Capsule(a, b, thick * 0.5),
        2 => Exact::Ball(a, thick * 0.5),
        _ => Exact::Cylinder(a, b, thick),
    };
    if random.below(2) == 0 { [outer, inner] } else { [inner, outer] }
}

/// Lower and upper bounds of the solid share of a cell or face: field 0 for cells, 1 to 3 for faces.
fn bounds(p: &Porosity, field: usize, at: usize) -> [f64; 2] {
    let of = |set: &FieldSet| if field == 0 { set.v[at] } else { set.faces(field - 1)[at] };
    let [low, high] = p.bounds.as_ref().expect("bounds");
    [1.0 - of(high), 1.0 - of(low)]
}

/// Cell by cell and face by face the bounds of two ways hold one value.
fn agree(found: &Porosity, divided: &Porosity, what: &str) {
    for field in 0..4 {
        let count = if field == 0 { found.beta.v.len() } else { found.beta.faces(field - 1).len() };
        for at in 0..count {
            let ([low, high], [least, most]) = (bounds(found, field, at), bounds(divided, field, at));
            assert!(low.max(least) <= high.min(most) + 1e-9, "{low} {high}, {least} {most}: {what}");
        }
    }
}

/// Bounds of the solid volume in all cells.
fn volumes(found: &Porosity) -> [f64; 2] {
    let [low, high] = found.bounds.as_ref().expect("bounds");
    [high, low].map(|set| set.v.iter().map(|open| 0.125 * (1.0 - open)).sum())
}

/// Ends and radii of a rod.
fn rod(solid: &Exact) -> Option<([DVec3; 2], [f64; 2])> {
    match *solid {
        Exact::Cylinder(a, b, r) => Some(([a, b], [r; 2])),
        Exact::Frustum(a, b, radii) => Some(([a, b], radii)),
        _ => None,
    }
}

/// Area that two discs have in common.
fn lens(r: f64, s: f64, apart: f64) -> f64 {
    let least = r.min(s).max(0.0);
    if apart <= (r - s).abs() {
        return std::f64::consts::PI * least * least;
    }
    if apart >= r + s {
        return 0.0;
    }
    let part = |r: f64, s: f64| {
        let x = (apart * apart + r * r - s * s) / (2.0 * apart);
        r * r * (x / r).clamp(-1.0, 1.0).acos() - x * (r * r - x * x).max(0.0).sqrt()
    };
    part(r, s) + part(s, r)
}

/// The volume that two rods have in common whose axes are along each other: discs in common, summed along the axis. None of others.
fn common_along([one, other]: &[Exact; 2]) -> Option<f64> {
    let (([a, b], own), ([c, d], its)) = (rod(one)?, rod(other)?);
    let axis = (b - a).normalize();
    if axis.cross((d - c).normalize()).length() > 1e-9 {
        return None;
    }
    let place = |p: DVec3| (p - a).dot(axis);
    let apart = (c - a - axis * place(c)).length();
    let radius = |s: f64, [from, to]: [f64; 2], [r, t]: [f64; 2]| r + (t - r) * (s - from) / (to - from);
    let spans = [[0.0, place(b)], [place(c), place(d)]];
    let (lo, hi) = (spans[1][0].min(spans[1][1]).max(0.0), spans[1][0].max(spans[1][1]).min(spans[0][1]));
    const STEPS: usize = 20_000;
    let step = (hi - lo).max(0.0) / STEPS as f64;
    let area = |n: usize| {
        let s = lo + (n as f64 + 0.5) * step;
        lens(radius(s, spans[0], own), radius(s, spans[1], its), apart)
    };
    Some((0..STEPS).map(area).sum::<f64>() * step)
}

#[test]
fn what_one_solid_holds_of_another_counts_once() {
    let mut random = Random::new(31);
    let mut known = 0;
    for n in 0..cases(60) {
        let solids = along_each_other(&mut random);
        let edges = lists(pick(&mut random, &[0.0, 0.0313]));
        let bodies = formulas(&solids.each_ref().map(form));
        let found = run(&edges, &bodies, Method::Auto);
        let what = format!("{n}: {solids:?}");
        assert!(found.max_gap <= 1.01e-4, "{}: {what}", found.max_gap);
        agree(&found, &run(&edges, &bodies, Method::Gjk), &what);
        let Some(common) = common_along(&solids) else { continue };
        known += 1;
        let truth = volume(&solids[0]) + volume(&solids[1]) - common;
        let [least, most] = volumes(&found);
        assert!(least - 1e-7 <= truth && truth <= most + 1e-7, "{least} {truth} {most}: {what}");
    }
    assert!(known * 5 >= cases(60), "{known}");
}

/// A pipe in a coat that is the more solid of both, or the more open; through flanges; what is left is measured as if nothing had been there.
#[test]
fn parts_of_a_run() {
    let edges = lists(0.0);
    let turn = DMat3::from_axis_angle(DVec3::new(1.0, -2.0, 0.5).normalize(), 0.8);
    let place = |x: f64| DVec3::new(2.2, 2.4, 2.6) + turn * (DVec3::X * x);
    let cylinder = |a: f64, b: f64, r: f64| Form::Cylinder(Cylinder::new(place(a), place(b), r));
    let run_of = |forms: &[Form]| run(&edges, &formulas(forms), Method::Auto);
    let pipe = cylinder(-1.5, 1.5, 0.2);
    let flanges = [-1.0, 0.0, 0.75].map(|x| cylinder(x, x + 0.1, 0.35));
    let found = run_of(&[vec![pipe], flanges.to_vec()].concat());
    let pi = std::f64::consts::PI;
    let truth = pi * (0.04 * 3.0 + 3.0 * 0.1 * (0.35_f64.powi(2) - 0.04));
    assert!((found.solid_volume - truth).abs() < 1e-12, "{} {truth}", found.solid_volume);
    assert!(found.max_gap < 1e-11 && found.cells.ambiguous == 0, "{}", found.max_gap);
    assert_eq!(found.by_formula, 4);

    let porous = |inner: f64, outer: f64| {
        let mut bodies = formulas(&[cylinder(-1.5, 1.5, 0.2), cylinder(-1.0, 1.0, 0.35)]);
        (bodies.bodies[0].porosity, bodies.bodies[1].porosity) = (inner, outer);
        run(&edges, &bodies, Method::Auto).solid_volume
    };
    let (core, coat, ends) = (pi * 0.04 * 2.0, pi * (0.35_f64.powi(2) - 0.04) * 2.0, pi * 0.04);
    for (inner, outer) in [(0.0, 0.5), (0.5, 0.0), (0.25, 0.25)] {
        let truth = core * (1.0 - f64::min(inner, outer)) + coat * (1.0 - outer) + ends * (1.0 - inner);
        let found = porous(inner, outer);
        assert!((found - truth).abs() < 2e-4, "{inner} in {outer}: {found} instead of {truth}");
    }
}

/// A solid that lies on a box, stands on it, passes through it, is in it, or reaches into it by next to nothing; in the frame of the box.
fn on_a_box(random: &mut Random, half: DVec3) -> Exact {
    let top = half.z + pick(random, &[0.0, 0.0, -1e-13, -1e-9, -1e-6, 1e-9]);
    let radius = random.between(0.1, 0.4);
    let flat = |random: &mut Random, z: f64| DVec3::new(random.between(-0.5, 0.5), random.between(-0.5, 0.5), z);
    let (a, b) = (flat(random, top + radius), flat(random, top + radius));
    let up = DVec3::Z * random.between(0.3, 1.0);
    let solid = match random.below(8) {
        0 => Exact::Cylinder(a, a + (b - a).normalize() * 1.2, radius),
        1 => Exact::Cylinder(flat(random, top), DVec3::ZERO, radius),
        2 => Exact::Ball(a, radius),
        3 => Exact::Capsule(a, b, radius),
        4 => Exact::Frustum(a, a + up, [radius, radius * 0.3]),
        5 => Exact::Cylinder(flat(random, -1.0), flat(random, 1.0), radius),
        6 => Exact::Cylinder(flat(random, -0.1), flat(random, 0.1), 0.05),
        _ => Exact::Ball(flat(random, half.z), radius),
    };
    // Those that stand.
    match solid {
        Exact::Cylinder(foot, to, r) if to == DVec3::ZERO => Exact::Cylinder(foot, foot + up, r),
        Exact::Frustum(a, to, r) => Exact::Frustum(a - DVec3::Z * radius, to - DVec3::Z * radius, r),
        other => other,
    }
}

fn moved(solid: &Exact, place: impl Fn(DVec3) -> DVec3) -> Exact {
    match *solid {
        Exact::Ball(c, r) => Exact::Ball(place(c), r),
        Exact::Capsule(a, b, r) => Exact::Capsule(place(a), place(b), r),
        Exact::Cylinder(a, b, r) => Exact::Cylinder(place(a), place(b), r),
        Exact::Frustum(a, b, r) => Exact::Frustum(place(a), place(b), r),
        other => other,
    }
}

#[test]
fn solids_on_and_through_boxes() {
    let mut random = Random::new(32);
    for n in 0..cases(48) {
        let half = DVec3::new(random.between(0.6, 1.2), random.between(0.6, 1.2), random.between(0.2, 0.5));
        let solid = on_a_box(&mut random, half);
        let turn = if n % 2 == 0 { DMat3::IDENTITY } else { random.turn() };
        let center = DVec3::splat(2.5) + DVec3::from_array(random.on_sphere()) * 0.2;
        let mut bodies = solids::scene(&[solids::turned_box(center, half, turn)]);
        let placed = moved(&solid, |p| center + turn * p);
        bodies.bodies.extend(formulas(&[form(&placed)]).bodies);
        let edges = lists(pick(&mut random, &[0.0, 0.0313]));
        let found = run(&edges, &bodies, Method::Auto);
        assert!(found.max_gap <= 1.01e-4, "{n}: {} of {solid:?} on {half}", found.max_gap);
        // What both have in common, by quadrature in the frame of the box.
        let common = common_volume(&[solid], [-half, half], 1e-7);
        let truth = 8.0 * half.element_product() + volume(&solid) - common;
        let [least, most] = volumes(&found);
        let what = format!("{n}: {solid:?} on {half}, {turn}");
        assert!(least - 1e-5 <= truth && truth <= most + 1e-5, "{least} {truth} {most}: {what}");
        agree(&found, &run(&edges, &bodies, Method::Gjk), &what);
    }
}

/// The sides of the box lie in planes of the grid: so do the bottoms of what stands on it, and faces in those planes are shared with what does not.
#[test]
fn solids_on_and_through_boxes_in_planes_of_the_grid() {
    let mut random = Random::new(33);
    let edges = lists(0.0);
    for n in 0..cases(36) {
        let mut some = || pick(&mut random, &[0.5, 0.75, 1.0]);
        let half = DVec3::new(some(), some(), pick(&mut random, &[0.25, 0.5]));
        // Which side is the top of the box.
        let cycle = |p: DVec3| [p, DVec3::new(p.z, p.x, p.y), DVec3::new(p.y, p.z, p.x)][n % 3];
        let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
        let center = DVec3::splat(1.5) + cycle(half);
        let solid = on_a_box(&mut random, half);
        let mut bodies = solids::scene(&[solids::turned_box(center, cycle(half), DMat3::IDENTITY)]);
        let placed = moved(&solid, |p| center + cycle(p) * sign);
        bodies.bodies.extend(formulas(&[form(&placed)]).bodies);
        let found = run(&edges, &bodies, Method::Auto);
        let what = format!("{n}: {placed:?} at {center}, {half}");
        assert!(found.max_gap <= 1.01e-4, "{}: {what}", found.max_gap);
        agree(&found, &run(&edges, &bodies, Method::Gjk), &what);
        walls_agree(&found, &edges, (center, cycle(half)), &placed, &what);
    }
}

/// What is closed of faces in the planes of a box's sides, where its section or that of a solid is, by counting points.
fn walls_agree(found: &Porosity, edges: &Edges, (center, half): (DVec3, DVec3), solid: &Exact, what: &str) {
    const POINTS: usize = 50;
    let holds = |p: DVec3| ((p - center).abs() - half).max_element() <= 0.0 || holds(solid, p);
    for axis in 0..3 {
        let planes = [center[axis] - half[axis], center[axis] + half[axis]];
        let cells = [0, 1, 2].map(|n| edges.0[n].len() - 1);
        let mut shape = cells;
        shape[axis] += 1;
        for at in 0..shape.iter().product() {
            let place = [at % shape[0], at / shape[0] % shape[1], at / (shape[0] * shape[1])];
            let low = DVec3::from_array([0, 1, 2].map(|n| edges.0[n][place[n]]));
            if !planes.contains(&low[axis]) {
                continue;
            }
            let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
            let closed = (0..POINTS * POINTS).filter(|n| {
                let mut p = low;
                p[u] += 0.5 * ((n % POINTS) as f64 + 0.5) / POINTS as f64;
                p[v] += 0.5 * ((n / POINTS) as f64 + 0.5) / POINTS as f64;
                holds(p)
            });
            let counted = closed.count() as f64 / (POINTS * POINTS) as f64;
            let [least, most] = bounds(found, axis + 1, at);
            assert!(
                least - 0.02 <= counted && counted <= most + 0.02,
                "{least} {counted} {most}, {axis} {low}: {what}"
            );
        }
    }
}

fn holds(solid: &Exact, p: DVec3) -> bool {
    let rounding = 1e-12;
    let along = |a: DVec3, b: DVec3| (p - a).dot(b - a) / (b - a).length_squared();
    match *solid {
        Exact::Ball(c, r) => p.distance(c) <= r + rounding,
        Exact::Capsule(a, b, r) => p.distance(a + (b - a) * along(a, b).clamp(0.0, 1.0)) <= r + rounding,
        _ => {
            let ([a, b], [r, s]) = rod(solid).expect("a rod");
            let t = along(a, b);
            (-rounding..=1.0 + rounding).contains(&t) && p.distance(a + (b - a) * t) <= r + (s - r) * t + rounding
        }
    }
}

/// A beam of two flanges and a web along x, in its frame, as three boxes.
struct Beam {
    length: f64,
    width: f64,
    height: f64,
    web: f64,
    flange: f64,
}

impl Beam {
    fn boxes(&self) -> [[DVec3; 2]; 3] {
        let [x, y, z] = [self.length, self.width, self.height].map(|size| 0.5 * size);
        let inner = z - self.flange;
        [(y, -z, -inner), (0.5 * self.web, -inner, inner), (y, inner, z)]
            .map(|(y, low, high)| [DVec3::new(-x, -y, low), DVec3::new(x, y, high)])
    }

    /// One shell.
    fn triangles(&self, place: impl Fn(DVec3) -> DVec3) -> Vec<[DVec3; 3]> {
        let [x, y, z] = [self.length, self.width, self.height].map(|size| 0.5 * size);
        let (web, inner) = (0.5 * self.web, z - self.flange);
        // Halves of the profile from below to above; the web's corners are corners of the flanges' ends.
        let right = [(y, -z), (y, -inner), (web, -inner), (web, inner), (y, inner), (y, z)];
        let left = right.map(|(y, z)| (-y, z));
        let outline: Vec<_> = right.into_iter().chain(left.into_iter().rev()).collect();
        let at = |x: f64, (y, z): (f64, f64)| place(DVec3::new(x, y, z));
        let mut found = Vec::new();
        for (n, &from) in outline.iter().enumerate() {
            let to = outline[(n + 1) % outline.len()];
            let [a, b, c, d] = [at(-x, from), at(-x, to), at(x, to), at(x, from)];
            found.extend([[a, c, b], [a, d, c]]);
        }
        let ends = [vec![0, 1, 2, 9, 10, 11], vec![2, 3, 8, 9], vec![5, 6, 7, 8, 3, 4]];
        for end in ends {
            for pair in end[1..].windows(2) {
                let corners = [end[0], pair[0], pair[1]].map(|n: usize| outline[n]);
                let [a, b, c] = corners.map(|corner| at(x, corner));
                let [d, e, f] = corners.map(|corner| at(-x, corner));
                found.extend([[a, b, c], [d, f, e]]);
            }
        }
        found
    }
}

/// A solid on a beam, under a flange, in the corner of web and flange, through the web, or across all of it.
fn at_a_beam(random: &mut Random, beam: &Beam) -> Exact {
    let radius = random.between(0.05, 0.2);
    let off = pick(random, &[0.0, 0.0, 0.0, 1e-13, 1e-7, -1e-7, 0.02]);
    let (top, inner) = (0.5 * beam.height, 0.5 * beam.height - beam.flange);
    let x = random.between(-0.5, 0.5);
    let corner = DVec3::new(x, 0.5 * beam.web + radius + off, inner - radius);
    match random.below(6) {
        0 => Exact::Cylinder(DVec3::new(x, -0.8, top + radius + off), DVec3::new(x, 0.8, top + radius + off), radius),
        1 => Exact::Ball(corner, radius),
        2 => Exact::Cylinder(corner, corner + DVec3::X * 0.7, radius),
        3 => Exact::Cylinder(DVec3::new(x, -0.7, 0.1), DVec3::new(x + 0.1, 0.7, 0.1 + off), radius),
        4 => Exact::Cylinder(DVec3::new(x, 0.1, top + off), DVec3::new(x, 0.1, top + off + 0.5), radius),
        _ => Exact::Capsule(DVec3::new(x, -0.4, -0.6), DVec3::new(-x, 0.3, 0.7), radius),
    }
}

#[test]
fn solids_at_beams_of_triangles() {
    let mut random = Random::new(34);
    for n in 0..cases(24) {
        let beam = Beam {
            length: pick(&mut random, &[2.0, 2.4]),
            width: pick(&mut random, &[0.5, 0.6]),
            height: pick(&mut random, &[0.8, 1.0]),
            web: random.between(0.01, 0.1),
            flange: random.between(0.01, 0.15),
        };
        let solid = at_a_beam(&mut random, &beam);
        let turn = if n % 2 == 0 { DMat3::IDENTITY } else { random.turn() };
        let place = |p: DVec3| DVec3::splat(2.5) + turn * p;
        let mut bodies = solids::scene(&[beam.triangles(place)]);
        bodies.bodies.extend(formulas(&[form(&moved(&solid, place))]).bodies);
        let edges = lists(pick(&mut random, &[0.0, 0.0313]));
        let found = run(&edges, &bodies, Method::Auto);
        let what = format!("{n}: {solid:?} at {:?}, {turn}", beam.boxes());
        assert!(found.max_gap <= 1.01e-4, "{}: {what}", found.max_gap);
        let boxes = beam.boxes();
        let truth = volume(&solid) + boxes.iter().map(|[lo, hi]| (*hi - *lo).element_product()).sum::<f64>()
            - boxes.iter().map(|part| common_volume(&[solid], *part, 1e-8)).sum::<f64>();
        let [least, most] = volumes(&found);
        assert!(least - 1e-6 <= truth && truth <= most + 1e-6, "{least} {truth} {most}: {what}");
        agree(&found, &run(&edges, &bodies, Method::Gjk), &what);
    }
}

/// A cup, upright in its frame: a prism with a hollow, by the number of its sides and their distances from the axis, inside and outside.
struct Cup {
    sides: usize,
    inside: f64,
    outside: f64,
    floor: f64,
    height: f64,
}

impl Cup {
    fn volume(&self) -> f64 {
        let of_sides = |distance: f64| self.sides as f64 * (PI / self.sides as f64).tan() * distance * distance;
        of_sides(self.outside) * self.height - of_sides(self.inside) * (self.height - self.floor)
    }

    fn triangles(&self, place: impl Fn(DVec3) -> DVec3) -> Vec<[DVec3; 3]> {
        let angle = 2.0 * PI / self.sides as f64;
        let at = |distance: f64, n: usize, z: f64| {
            let (sin, cos) = (angle * (n as f64 - 0.5)).sin_cos();
            place(DVec3::new(cos, sin, 0.0) * (distance / (0.5 * angle).cos()) + DVec3::Z * z)
        };
        let mut found = Vec::new();
        for n in 0..self.sides {
            let next = (n + 1) % self.sides;
            let mut quad = |[a, b, c, d]: [DVec3; 4]| found.extend([[a, b, c], [a, c, d]]);
            let (out, inn, floor, top) = (self.outside, self.inside, self.floor, self.height);
            quad([at(out, n, 0.0), at(out, next, 0.0), at(out, next, top), at(out, n, top)]);
            quad([at(inn, n, floor), at(inn, n, top), at(inn, next, top), at(inn, next, floor)]);
            quad([at(out, n, top), at(out, next, top), at(inn, next, top), at(inn, n, top)]);
            let [below, above] = [0.0, floor].map(|z| place(DVec3::Z * z));
            found.push([below, at(out, next, 0.0), at(out, n, 0.0)]);
            found.push([above, at(inn, n, floor), at(inn, next, floor)]);
        }
        found
    }
}

#[test]
fn rods_in_cups_of_many_facets() {
    let mut random = Random::new(35);
    for n in 0..cases(12) {
        let outside = random.between(0.3, 0.7);
        let cup = Cup {
            sides: pick(&mut random, &[8, 12, 16, 20]),
            inside: outside * random.between(0.8, 0.95),
            outside,
            floor: random.between(0.02, 0.2),
            height: random.between(0.4, 0.9),
        };
        // Some stand on the floor around the axis, one goes through the middle of a side.
        let mut solids: Vec<Exact> = Vec::new();
        let count = 2 + random.below(5);
        for rod in 0..count {
            let (sin, cos) = (2.0 * PI * (rod as f64 + random.between(0.0, 0.4)) / count as f64).sin_cos();
            let foot = DVec3::new(cos, sin, 0.0) * (0.5 * cup.inside) + DVec3::Z * cup.floor;
            let radius = cup.inside * random.between(0.03, 0.1);
            solids.push(Exact::Cylinder(foot, foot + DVec3::Z * random.between(0.2, 0.8), radius));
        }
        let (sin, cos) = (2.0 * PI * random.below(cup.sides) as f64 / cup.sides as f64).sin_cos();
        let (out, up) = (DVec3::new(cos, sin, 0.0), DVec3::Z * (0.5 * (cup.floor + cup.height)));
        let radius = 0.07 * cup.inside;
        solids.push(Exact::Cylinder(up + out * (0.7 * cup.inside), up + out * (1.4 * outside), radius));
        let turn = if n % 2 == 0 { DMat3::IDENTITY } else { random.turn() };
        let place = |p: DVec3| DVec3::splat(2.45) + turn * p;
        let mut bodies = solids::scene(&[cup.triangles(place)]);
        let forms: Vec<Form> = solids.iter().map(|solid| form(&moved(solid, place))).collect();
        bodies.bodies.extend(formulas(&forms).bodies);
        let edges = lists(pick(&mut random, &[0.0, 0.0313]));
        let found = run(&edges, &bodies, Method::Auto);
        let what = format!("{n}: {solids:?} in {} sides, {} {outside}, {turn}", cup.sides, cup.inside);
        assert!(found.max_gap <= 1.01e-4, "{}: {what}", found.max_gap);
        let through = PI * radius * radius * (outside - cup.inside);
        let truth = cup.volume() + solids.iter().map(volume).sum::<f64>() - through;
        let [least, most] = volumes(&found);
        assert!(least - 1e-9 <= truth && truth <= most + 1e-9, "{least} {truth} {most}: {what}");
        if n < cases(2) {
            agree(&found, &run(&edges, &bodies, Method::Gjk), &what);
        }
    }
}

/// Each has three parts: where four overlap, there are too many sets of these for sections, and planes take no time; where two or three meet in a node, sections
/// serve better, to any tolerance.
#[test]
fn capsules_in_one_cell() {
    let capsule = |from: [f64; 3], to: [f64; 3], radius: f64| {
        Form::Capsule(Capsule { from: DVec3::from_array(from), to: DVec3::from_array(to), radius })
    };
    let four = |n: usize| {
        let low = DVec3::new(0.25 * (n % 2) as f64, 0.0, 0.1 * (n / 2) as f64);
        let (from, to) = (low + DVec3::new(0.0, 0.001, 0.0), low + DVec3::new(0.1, 1.0 / 3.0, 0.001));
        capsule(from.to_array(), to.to_array(), 0.5)
    };
    let (corner, node) = ([0.096, 0.121, 0.108], [0.07, 0.134, 0.098]);
    let ends = [[0.153, 0.235, -0.25], [-0.319, 0.404, -0.095], [-0.143, 0.531, 0.074]];
    let quarter = || vec![0.0, 0.25];
    let cells = [
        (
            Edges([vec![-0.69, 0.077], vec![-0.82, -0.091], vec![-0.059, 0.53]]),
            (0..4).map(four).collect::<Vec<_>>(),
            1e-5,
        ),
        (
            Edges([quarter(), quarter(), quarter()]),
            vec![capsule(corner, [0.053, 0.049, 0.234], 0.12), capsule(corner, [-0.097, 0.229, -0.284], 0.12)],
            1e-6,
        ),
        (Edges([quarter(), quarter(), quarter()]), ends.map(|end| capsule(node, end, 0.1)).to_vec(), 1e-5),
    ];
    for (edges, forms, finest) in cells {
        let solid = |tol: f64| {
            let options = Options { tol, ..Options::default() };
            let found = porosity(&edges.grid(None).expect("a grid"), &formulas(&forms), options);
            assert!(found.max_gap <= tol, "{tol}: {} in {forms:?}", found.max_gap);
            found.solid_volume / edges.0.iter().map(|e| e[1] - e[0]).product::<f64>()
        };
        let [rough, fine] = [1e-4, finest].map(solid);
        assert!((rough - fine).abs() < 1e-4, "{rough} {fine} in {forms:?}");
    }
}

/// Pipes and tori that touch a plane of the grid from below, whose axes miss another plane by rounding: nothing puts them there.
#[test]
fn what_touches_a_plane_goes_on_to_touch_it() {
    let tenths: Vec<f64> = (0..11).map(|i| -0.5 + f64::from(i) * 0.1).collect();
    let edges = Edges([tenths.clone(), tenths.clone(), tenths]);
    let axis = edges.0[2][4];
    assert!(axis != -0.1 && (axis + 0.1).abs() < 1e-15 && -0.1 + 0.1 == 0.0);
    let pipe = Form::Cylinder(Cylinder::new(DVec3::new(-0.5, -0.05, -0.1), DVec3::new(0.5, -0.05, -0.1), 0.1));
    let ring = |angle: f64| TorusShape {
        center: DVec3::new(0.0, 0.3, -0.1),
        axis: DVec3::Z,
        start: DVec3::X,
        angle,
        radius: 0.15,
        tube: 0.1,
    };
    for form in [pipe, Form::Torus(ring(360.0)), Form::Torus(ring(90.0))] {
        let found = run(&edges, &formulas(std::slice::from_ref(&form)), Method::Auto);
        let above = &found.beta.z[500..600];
        let least = above.iter().fold(1.0, |least: f64, open| least.min(*open));
        assert!(least > 1.0 - 1e-12, "{form:?}: {:e}", 1.0 - least);
    }
}
