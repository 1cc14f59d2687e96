//! Solids by formula that meet, touch, hold each other or are one, and what must hold for what they have in common.

use crate::quadrature::Exact;
use crate::random::Random;
use glam::DVec3;
use voidage_core::solids::enclosure::{self, BoxAround, Enclosed, Enclosure, UnionEffort};
use voidage_core::solids::quadric::{QuadricSolid, excess};
use voidage_core::solids::torus::{TorusShape, TorusSolid};

/// How two or three solids lie to each other in the unit cube.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Anyhow.
    Anyhow,
    /// Along axes, ends and centres often in planes of the cube.
    Aligned,
    /// Along axes but for 1e-15 to 1e-3.
    NearlyAligned,
    /// On one axis: nested, end to end, of one radius or two.
    OnOneAxis,
    /// The same solid twice, or all but for rounding.
    Twice,
    /// Touching from outside or from inside, but for rounding.
    Touching,
    /// Pipes of one radius that cross.
    Crossing,
    /// Some thousandths thick.
    Thin,
    /// A thousand times as large as the cube.
    Huge,
}

/// All of them.
pub const FAMILIES: [Family; 9] = [
    Family::Anyhow,
    Family::Aligned,
    Family::NearlyAligned,
    Family::OnOneAxis,
    Family::Twice,
    Family::Touching,
    Family::Crossing,
    Family::Thin,
    Family::Huge,
];

/// The same for closed forms.
///
/// # Panics
/// If it is no solid.
#[must_use]
pub fn quadric(exact: &Exact) -> QuadricSolid {
    match *exact {
        Exact::Ball(center, radius) => QuadricSolid::ball(center, radius),
        Exact::Ellipsoid(center, axes) => QuadricSolid::ellipsoid(center, axes),
        Exact::Cylinder(from, to, radius) => QuadricSolid::cylinder(from, to, radius),
        Exact::Capsule(from, to, radius) => QuadricSolid::capsule(from, to, radius),
        Exact::Cone(base, apex, radius) => QuadricSolid::cone(base, apex, radius),
        Exact::Frustum(from, to, radii) => QuadricSolid::truncated_cone(from, to, radii),
    }
    .expect("a solid of ordinary size")
}

/// A solid of any kind on a segment.
fn on_segment(random: &mut Random, from: DVec3, to: DVec3, radius: f64) -> Exact {
    match random.below(7) {
        0 => Exact::Ball(from, radius),
        1 => {
            let turn = random.turn();
            Exact::Ellipsoid(from, [0, 1, 2].map(|n| turn.col(n) * radius * random.between(0.4, 1.6)))
        }
        2 | 3 => Exact::Cylinder(from, to, radius),
        4 => Exact::Capsule(from, to, radius),
        5 => Exact::Cone(from, to, radius),
        _ => Exact::Frustum(from, to, [radius, radius * random.between(0.2, 1.8)]),
    }
}

fn point(random: &mut Random) -> DVec3 {
    random.point(DVec3::splat(-0.3), DVec3::splat(1.3))
}

fn any_direction(random: &mut Random) -> DVec3 {
    random.vector::<DVec3>(1.0).normalize()
}

/// A point with coordinates that are often those of planes of the cube.
fn point_on_planes(random: &mut Random) -> DVec3 {
    let mut p = point(random);
    for n in 0..3 {
        if random.below(2) == 0 {
            p[n] = [0.0, 0.25, 0.5, 1.0][random.below(4)];
        }
    }
    p
}

/// A solid that touches a pipe.
fn touching(random: &mut Random, [from, to]: [DVec3; 2], radius: f64) -> Exact {
    let axis = (to - from).normalize();
    let side = axis.cross(any_direction(random)).normalize();
    let other = radius * random.between(0.3, 1.5);
    let apart = if random.below(2) == 0 { radius + other } else { radius - other };
    let place = from + (to - from) * random.between(0.2, 0.8) + side * apart;
    let along = if random.below(2) == 0 { axis } else { side.cross(any_direction(random)).normalize() };
    match random.below(3) {
        0 => Exact::Ball(place, other),
        _ => Exact::Cylinder(place - along, place + along, other),
    }
}

/// Two or three solids.
pub fn solids(random: &mut Random, family: Family) -> Vec<Exact> {
    let size = |random: &mut Random| random.between(0.1, 0.7);
    let anyhow = |random: &mut Random| {
        let (from, to, radius) = (point(random), point(random), size(random));
        on_segment(random, from, to, radius)
    };
    let along_axis = |random: &mut Random, tilt: f64| {
        let from = point_on_planes(random);
        let axis = DVec3::AXES[random.below(3)] * [1.0, -1.0][random.below(2)];
        let length = [0.25, 0.5, 1.0, 2.0][random.below(4)];
        let radius = [0.125, 0.25, 0.5, random.between(0.1, 0.7)][random.below(4)];
        let lean = random.vector::<DVec3>(tilt);
        on_segment(random, from, from + axis * length + lean, radius)
    };
    let (from, to, radius) = (point(random), point(random), size(random));
    match family {
        Family::Anyhow => (0..2 + random.below(2)).map(|_| anyhow(random)).collect(),
        Family::Aligned => (0..2 + random.below(2)).map(|_| along_axis(random, 0.0)).collect(),
        Family::NearlyAligned => {
            let tilt = 10_f64.powf(random.between(-15.0, -3.0));
            (0..2 + random.below(2)).map(|_| along_axis(random, tilt)).collect()
        }
        Family::OnOneAxis => (0..2 + random.below(2))
            .map(|_| {
                let place = |random: &mut Random| from + (to - from) * [-0.3, 0.0, 0.5, 1.0, 1.4][random.below(5)];
                let (a, mut b) = (place(random), place(random));
                if a == b {
                    b = a + (to - from) * 0.7;
                }
                let radius = radius * [0.5, 1.0, 1.0, 1.0 + 1e-13][random.below(4)];
                on_segment(random, a, b, radius)
            })
            .collect(),
        Family::Twice => {
            let one = on_segment(random, from, to, radius);
            let moved = match one {
                Exact::Ball(c, r) => Exact::Ball(c, r * (1.0 + f64::EPSILON)),
                Exact::Cylinder(a, b, r) => Exact::Cylinder(b, a, r),
                Exact::Capsule(a, b, r) => Exact::Capsule(b, a, r),
                other => other,
            };
            vec![one, if random.below(2) == 0 { one } else { moved }]
        }
        Family::Touching => vec![Exact::Cylinder(from, to, radius), touching(random, [from, to], radius)],
        Family::Crossing => {
            let (one, other) = (any_direction(random), any_direction(random));
            let axis = |n: usize| DVec3::AXES[n];
            let n = random.below(3);
            let [one, other] = if random.below(2) == 0 { [axis(n), axis((n + 1) % 3)] } else { [one, other] };
            let center = random.point(DVec3::splat(0.2), DVec3::splat(0.8));
            let other_radius = radius * [1.0, 1.0, 0.5][random.below(3)];
            vec![
                Exact::Cylinder(center - one * 2.0, center + one * 2.0, radius),
                Exact::Cylinder(center - other * 2.0, center + other * 2.0, other_radius),
            ]
        }
        Family::Thin => {
            let thin = 10_f64.powf(random.between(-4.0, -2.0));
            let one = Exact::Cylinder(from, to, thin);
            let other = anyhow(random);
            vec![one, other]
        }
        Family::Huge => {
            let radius = 10_f64.powf(random.between(2.0, 3.0));
            let (place, side) = (random.point(DVec3::splat(0.2), DVec3::splat(0.8)), any_direction(random));
            let along = side.any_orthonormal_vector() * radius;
            let center = place + side * radius;
            let large = if random.below(2) == 0 {
                Exact::Ball(center, radius)
            } else {
                Exact::Cylinder(center - along, center + along, radius)
            };
            vec![large, anyhow(random)]
        }
    }
}

/// The same solid at another scale, then moved.
fn elsewhere(exact: &Exact, scale: f64, shift: DVec3) -> Exact {
    let at = |p: DVec3| p * scale + shift;
    match *exact {
        Exact::Ball(center, radius) => Exact::Ball(at(center), radius * scale),
        Exact::Ellipsoid(center, axes) => Exact::Ellipsoid(at(center), axes.map(|a| a * scale)),
        Exact::Cylinder(from, to, radius) => Exact::Cylinder(at(from), at(to), radius * scale),
        Exact::Capsule(from, to, radius) => Exact::Capsule(at(from), at(to), radius * scale),
        Exact::Cone(base, apex, radius) => Exact::Cone(at(base), at(apex), radius * scale),
        Exact::Frustum(from, to, radii) => Exact::Frustum(at(from), at(to), radii.map(|r| r * scale)),
    }
}

/// The unit cube, a part of it that may be thin along some axes, or a face across an axis.
fn cell(random: &mut Random) -> [[f64; 2]; 3] {
    let mut cell = [[0.0, 1.0]; 3];
    if random.below(2) == 0 {
        for side in &mut cell {
            if random.below(2) == 0 {
                let width = 10_f64.powf(random.between(-4.0, 0.0));
                let low = random.between(0.0, 1.0 - width);
                *side = [low, low + width];
            }
        }
    }
    if random.below(2) == 0 {
        let at = random.below(3);
        cell[at] = [random.between(cell[at][0], cell[at][1]); 2];
    }
    cell
}

/// Solids of some family, and a cell or face.
struct Meeting {
    family: Family,
    exact: Vec<Exact>,
    all: Vec<QuadricSolid>,
    cell: [[f64; 2]; 3],
    /// Volume of the cell, area of the face.
    size: f64,
}

impl Meeting {
    fn new(random: &mut Random) -> Self {
        let family = FAMILIES[random.below(FAMILIES.len())];
        let exact = solids(random, family);
        let all = exact.iter().map(quadric).collect();
        let cell = cell(random);
        let size = cell.iter().map(|[lo, hi]| if lo == hi { 1.0 } else { hi - lo }).product();
        Meeting { family, exact, all, cell, size }
    }
}

/// A coarse and a fine tolerance, the parts of a cell, and the same at another scale and place, bound the same number; extreme numbers do no
/// harm.
///
/// # Panics
/// If not.
pub fn bounds_agree(seed: u64) {
    let random = &mut Random::new(seed);
    let Meeting { family, exact, all, cell, size } = Meeting::new(random);
    let rough = if family == Family::Huge { 1e-9 } else { 1e-11 };
    let bounds = |cell: [[f64; 2]; 3], enough: f64| excess(&all, cell, enough).expect("few solids");
    let fine = bounds(cell, 1e-5 * size);
    let rough = rough * size.max(1e-4);
    let same = |other: [f64; 2], rough: f64, what: &str| {
        let apart = (other[0] - fine[1]).max(fine[0] - other[1]);
        assert!(apart <= rough, "{family:?} {seed}: {what} {other:?}, else {fine:?} in {cell:?} of {exact:?}");
    };
    for enough in [1e-2, 1e-3] {
        let coarse = bounds(cell, enough * size);
        same(coarse, rough, "coarsely");
        assert!(coarse[1] - coarse[0] <= 1.01 * enough * size + rough, "{family:?} {seed}: {coarse:?} of {exact:?}");
    }
    let cut: [f64; 3] = [0, 1, 2].map(|n| cell[n][0] + (cell[n][1] - cell[n][0]) * random.between(0.2, 0.8));
    let mut parts = [0.0; 2];
    for n in 0..8 {
        let side = |a: usize| if n >> a & 1 == 0 { [cell[a][0], cut[a]] } else { [cut[a], cell[a][1]] };
        if (0..3).all(|a| cell[a][0] < cell[a][1] || n >> a & 1 == 0) {
            let found = bounds([0, 1, 2].map(side), 1e-4 * size);
            parts = [parts[0] + found[0], parts[1] + found[1]];
        }
    }
    same(parts, rough, "in parts");
    // Far off, coordinates are rounded: by their last bit, each surface moves.
    let (scale, far) = (10_f64.powf(random.between(-7.0, 7.0)), [0.0, 1e2, 1e5][random.below(3)]);
    let shift = random.vector::<DVec3>(far * scale);
    let there: Vec<QuadricSolid> = exact.iter().map(|e| quadric(&elsewhere(e, scale, shift))).collect();
    let moved = [0, 1, 2].map(|n| cell[n].map(|x| x * scale + shift[n]));
    if (0..3).all(|n| (moved[n][0] < moved[n][1]) == (cell[n][0] < cell[n][1])) {
        let unit = if cell.iter().any(|[lo, hi]| lo == hi) { scale * scale } else { scale.powi(3) };
        let found = excess(&there, moved, 1e-4 * size * unit).expect("few solids").map(|x| x / unit);
        // Where curves touch, a shift of e moves where they do by its root.
        let rounded = far * f64::EPSILON;
        same(found, rough + 30.0 * rounded.sqrt() * size.max(rounded.sqrt()), "elsewhere");
    }
    extremes(random);
}

/// What no caller should write.
fn extremes(random: &mut Random) {
    const EXTREME: [f64; 10] = [0.0, -0.0, 1e-300, 1e-59, 1e59, -1e30, 1e300, f64::MAX, f64::NAN, f64::NEG_INFINITY];
    let mut number = || match random.below(6) {
        0 => EXTREME[random.below(EXTREME.len())],
        1 => 10_f64.powf(random.between(-20.0, 20.0)),
        2 => random.below(9) as f64 * 0.25,
        _ => random.between(-1.0, 2.0),
    };
    let mut point = || DVec3::new(number(), number(), number());
    let points = [0; 6].map(|_| point());
    let [r, s, t] = [point(), point(), point()].map(|p| p.x);
    let solids = [
        QuadricSolid::ball(points[0], r),
        QuadricSolid::cylinder(points[1], points[2], s),
        QuadricSolid::capsule(points[2], points[3], t),
        QuadricSolid::truncated_cone(points[3], points[4], [r, t]),
        QuadricSolid::ellipsoid(points[5], [points[0], points[1], points[2]]),
    ];
    let sides = [[points[0].x, points[0].y], [0.0, 1.0], [points[1].x, points[1].x]];
    let enough = points[2].z.abs();
    for cell in [[[0.0, 1.0]; 3], sides] {
        if let Some([low, high]) = excess(solids.iter().flatten(), cell, enough) {
            assert!(low <= high, "{low} to {high}");
        }
        let solids: Vec<QuadricSolid> = solids.iter().flatten().cloned().collect();
        let [low, high] =
            enclosure::excess(&solids, cell, UnionEffort { tol: enough.max(1e-3), most: 1 << 16, more: 1 });
        assert!(low <= high, "{low} to {high} by planes");
    }
}

/// What solids share by planes between which they lie is what they share by sections, at any tolerance, and as close as was asked for unless surfaces coincide.
///
/// # Panics
/// If not.
pub fn planes_agree(seed: u64) {
    let random = &mut Random::new(seed);
    let Meeting { family, exact, all, cell, size } = Meeting::new(random);
    let sections = excess(&all, cell, 1e-5 * size).expect("few solids").map(|x| x / size);
    // Coordinates are rounded as a share of the cell's sizes, and of a huge solid.
    let least = cell.iter().filter(|[lo, hi]| lo < hi).fold(1.0, |least, [lo, hi]| f64::min(least, hi - lo));
    let rough = if family == Family::Huge { 1e-8 } else { 1e-10 } / least;
    // Where surfaces coincide, planes are slow, and sections are there for it.
    let coincide = matches!(family, Family::Twice | Family::OnOneAxis | Family::Touching | Family::Aligned);
    for tol in [1e-1, 1e-3, 1e-5] {
        let [low, high] = enclosure::excess(&all, cell, UnionEffort { tol, most: 1 << 20, more: 1 });
        let apart = (low - sections[1]).max(sections[0] - high);
        assert!(
            apart <= rough,
            "{family:?} {seed}: {low} to {high} by planes, {sections:?} by sections in {cell:?} of {exact:?}"
        );
        assert!(
            coincide || high - low <= tol + rough,
            "{family:?} {seed}: {low} to {high}, wanted {tol:e}, in {cell:?} of {exact:?}"
        );
    }
}

/// Points of a box are where the planes around a torus say: inside of those within it they are in the torus, and no point of it is outside of those
/// around it. Returns how many points decided something.
///
/// # Panics
/// If not.
pub fn planes_enclose_a_torus(seed: u64) -> usize {
    let random = &mut Random::new(seed);
    let (axis, start) = (random.vector::<DVec3>(1.0).normalize(), random.vector::<DVec3>(1.0));
    let radius = random.between(0.2, 2.0);
    let tube = radius * [0.05, 0.3, 0.9, 1.0][random.below(4)];
    let angle = [30.0, 90.0, 180.0, 217.0, 270.0, 359.0, 360.0][random.below(7)];
    let far = [0.0, 1.0, 1e3][random.below(3)];
    let center = random.vector::<DVec3>(far);
    let across = (start - axis * start.dot(axis)).normalize();
    let Some(solid) = TorusSolid::new(&TorusShape { center, axis, start, radius, tube, angle }) else { return 0 };
    // How deep a point is: positive inside.
    let depth = |p: DVec3| {
        let d = p - center;
        let (z, x, y) = (d.dot(axis), d.dot(across), d.dot(axis.cross(across)));
        let rho = x.hypot(y);
        let turned = y.atan2(x).to_degrees().rem_euclid(360.0);
        let beside = (360.0 - turned).min((turned - angle).abs()).min(turned).to_radians() * rho;
        let end = if angle == 360.0 { f64::INFINITY } else { beside * if turned <= angle { 1.0 } else { -1.0 } };
        (tube - (rho - radius).hypot(z)).min(end)
    };
    let turn = random.between(0.0, angle).to_radians();
    let on_ring =
        center + (across * turn.cos() + axis.cross(across) * turn.sin()) * radius + random.vector::<DVec3>(tube);
    let half =
        DVec3::splat(radius * 10_f64.powf(random.between(-4.0, 0.3))) * random.point(DVec3::splat(0.1), DVec3::ONE);
    let place = BoxAround { middle: on_ring.to_array(), half: half.to_array() };
    let mut parts: Vec<Enclosure> = Vec::new();
    solid.enclosures(&place, &mut |part| parts.push(part));
    let mut decided = 0;
    for _ in 0..200 {
        let at = random.vector::<DVec3>(1.0).clamp(DVec3::NEG_ONE, DVec3::ONE);
        let depth = depth(on_ring + half * at);
        let within = |upper: usize| {
            parts.iter().any(|part| match part {
                Enclosure::Open => false,
                Enclosure::Within(all) => {
                    all.iter().all(|c| c.middle + DVec3::from_array(c.slope).dot(at) + c.rest[upper] <= 0.0)
                }
            })
        };
        let room = 1e-9 * (1.0 + radius);
        assert!(!within(1) || depth > -room, "{seed}: held, but {depth} from the surface");
        assert!(within(0) || depth < room, "{seed}: {depth} inside, but left out");
        decided += usize::from(within(1) || !within(0));
    }
    decided
}
