//! Hulls of which a corner lies on a side of the other, or an edge on an edge, but for rounding. Nothing but rounding decides what they do:
//! the sign of one determinant, which `robust` finds exactly (J. R. Shewchuk, *Discrete Comput. Geom.* 18, 1997).

use crate::command::stress::case::{Effort, Numbers, StressCase, at_least, at_most};
use crate::command::stress::kit::doors::{clearance, contact};
use crate::command::stress::kit::random::Random;
use glam::DVec3;
use robust::{Coord3D, orient3d};
use voidage_core::convex::AnyBody;
use voidage_core::convex::exact::Contact;
use voidage_core::convex::gjk;
use voidage_core::convex::shape::Hull;

/// The case.
pub const CASES: &[StressCase] = &[StressCase::new(
    "gjk/rounding",
    "a corner on a side, an edge on an edge, askew, anywhere, but for rounding: exact determinants",
    &[
        at_most(0.0, "wrong answers"),
        at_most(0.0, "undecided"),
        at_most(0.0, "distances outside of their bounds"),
        at_most(0.0, "overlapping pairs said to be separated by a direction"),
        at_least(1000.0, "pairs apart"),
        at_least(50.0, "touching"),
        at_least(1000.0, "overlapping"),
    ],
    judge,
)];

/// Six times the volume of a tetrahedron, its sign exact: positive if `d` lies on the side of `a b c` from which these turn
/// counter-clockwise.
fn volume(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    let [a, b, c, d] = [a, b, c, d].map(|p| Coord3D { x: p.x, y: p.y, z: p.z });
    -orient3d(a, b, c, d)
}

/// Two tetrahedra, the direction between them, and how far the second is from the first, its sign exact; not positive if they touch or overlap.
struct Pair {
    first: [DVec3; 4],
    second: [DVec3; 4],
    across: DVec3,
    gap: f64,
}

/// From the coordinates of a turned frame, anywhere and of any size: what comes out has all its digits.
fn frame(random: &mut Random) -> impl Fn(f64, f64, f64) -> DVec3 + use<> {
    let (turn, size) = (random.turn(), random.scale(1e-3, 1e3));
    let reach = DVec3::splat(random.scale(1e-3, 1e3));
    let place = random.point(-reach, reach);
    move |x, y, z| place + turn * (DVec3::new(x, y, z) * size)
}

/// A corner of the second on a side of the first, away from its edges. All other corners are far from the plane of that side.
fn corner_on_side(random: &mut Random) -> Pair {
    let at = frame(random);
    let angle = random.between(0.0, 2.0);
    let rim = |n: f64| at((angle + n * 2.1).cos(), (angle + n * 2.1).sin(), 0.0);
    let [a, b, c] = [rim(0.0), rim(1.0), rim(2.0)];
    let below = at(random.between(-2.0, 2.0), random.between(-2.0, 2.0), -random.between(0.1, 2.0));
    let mut shares = [0; 3].map(|_| random.between(0.2, 1.0));
    let sum: f64 = shares.iter().sum();
    shares.iter_mut().for_each(|s| *s /= sum);
    let corner = match random.below(4) {
        // Halfway between two corners and once more: often in the plane to the bit.
        0 => (a + b) * 0.25 + c * 0.5,
        _ => a * shares[0] + b * shares[1] + c * shares[2],
    };
    let mut above = || at(random.between(-2.0, 2.0), random.between(-2.0, 2.0), random.between(0.1, 2.0));
    let second = [corner, above(), above(), above()];
    let across = (b - a).cross(c - a);
    Pair { first: [a, b, c, below], second, across, gap: volume(a, b, c, corner) / across.length() }
}

/// An edge of the second across an edge of the first, away from the ends of both. Their other corners are far on the other sides.
fn edge_on_edge(random: &mut Random) -> Pair {
    let at = frame(random);
    let angle = random.between(0.3, 2.8);
    let (along, across) = ([1.0, 0.0], [angle.cos(), angle.sin()]);
    let mut on = |way: [f64; 2], sign: f64| {
        let reach = sign * random.between(0.3, 1.0);
        at(reach * way[0], reach * way[1], 0.0)
    };
    let (a, b) = (on(along, -1.0), on(along, 1.0));
    let (c, d) = (on(across, -1.0), on(across, 1.0));
    let mut aside =
        |side: f64| at(random.between(-1.0, 1.0), random.between(-1.0, 1.0), side * random.between(0.1, 2.0));
    let (first, second) = ([a, b, aside(-1.0), aside(-1.0)], [c, d, aside(1.0), aside(1.0)]);
    // (b − a) × (d − c) points from the first to the second; `c` above it turns the tetrahedron over.
    let across = (b - a).cross(d - c);
    Pair { first, second, across, gap: -volume(a, b, c, d) / across.length() }
}

fn judge(effort: Effort) -> Numbers {
    let mut random = Random::new(31);
    let (mut wrong, mut undecided, mut outside, mut separated, mut met) = (0, 0, 0, 0, [0; 3]);
    for n in 0..effort.pick(12_000, 400_000) {
        let Pair { first, second, across, gap } =
            if n % 2 == 0 { corner_on_side(&mut random) } else { edge_on_edge(&mut random) };
        let truth = match gap {
            g if g > 0.0 => Contact::Disjoint,
            g if g < 0.0 => Contact::Overlapping,
            _ => Contact::Touching,
        };
        met[truth as usize] += 1;
        let (a, b) = (AnyBody::new(Hull::new(&first))?, AnyBody::new(Hull::new(&second))?);
        match contact(&a, &b) {
            None => undecided += 1,
            Some(said) => wrong += usize::from(said != truth),
        }
        // Any direction may be proposed: here the right one, and others that rounding cannot tell from it.
        let mut nearly = across;
        for _ in 0..4 {
            separated += usize::from(gap < 0.0 && gjk::separates(&Hull::new(&first), &Hull::new(&second), nearly));
            nearly = across * (1.0 + 1e-15 * random.direction());
        }
        let [lower, found, upper] = clearance(&a, &b);
        // Of the size of the gap the determinant tells no more than what rounding of the coordinates leaves; its sign is exact.
        let room = 1e-13 * first.iter().chain(&second).map(|p| p.abs().max_element()).fold(0.0, f64::max);
        let holds = lower <= found && found <= upper && lower <= gap.max(0.0) + room && gap <= upper + room;
        outside += usize::from(!(holds && if gap > 0.0 { upper > 0.0 } else { lower <= 0.0 }));
    }
    Ok([wrong, undecided, outside, separated, met[0], met[1], met[2]].map(|n| n as f64).to_vec())
}
