//! Round bodies, whose distances are known in closed form.

use crate::command::stress::case::{Criterion, Effort, Numbers, StressCase, at_least, at_most};
use crate::command::stress::kit::doors::{clearance, contact};
use crate::command::stress::kit::random::Random;
use glam::DVec3;
use voidage_core::convex::AnyBody;
use voidage_core::convex::exact::Contact;
use voidage_core::convex::shape::{Capsule, Cylinder, Sphere};
use voidage_core::number::aabb::Aabb;

const ROUND: &[Criterion] = &[
    at_most(0.0, "wrong answers"),
    at_most(0.0, "undecided with a gap above 1e-12 of the size"),
    at_most(0.0, "distances outside of their bounds"),
    at_least(1000.0, "pairs apart"),
    at_least(1000.0, "overlapping"),
];

/// The cases.
pub const CASES: &[StressCase] = &[
    StressCase::new(
        "gjk/balls",
        "balls at whole distances, gaps from 1 down to 1e-15: difference of distance and radii",
        ROUND,
        |e| judge(e, 21, balls),
    ),
    StressCase::new(
        "gjk/capsules",
        "capsules that cross at right angles, gaps from 1 down to 1e-15: height less radii",
        ROUND,
        |e| judge(e, 22, capsules),
    ),
    StressCase::new(
        "gjk/cylinders",
        "cylinders beside boxes, gaps from 1 down to 1e-15: height less radius",
        ROUND,
        |e| judge(e, 23, cylinders),
    ),
];

/// Two bodies and the gap between them, exact; negative if they overlap.
type RoundPair = (AnyBody<'static, DVec3>, AnyBody<'static, DVec3>, f64);
type Made = Result<RoundPair, Box<dyn std::error::Error>>;

/// Whole vectors of whole length.
const QUADRUPLES: [([f64; 3], f64); 7] = [
    ([1.0, 2.0, 2.0], 3.0),
    ([2.0, 3.0, 6.0], 7.0),
    ([1.0, 4.0, 8.0], 9.0),
    ([4.0, 4.0, 7.0], 9.0),
    ([2.0, 6.0, 9.0], 11.0),
    ([6.0, 6.0, 7.0], 11.0),
    ([0.0, 3.0, 4.0], 5.0),
];

/// Between 1e-15 and 1, of either sign.
fn gap(random: &mut Random) -> f64 {
    let size = random.scale(1e-15, 1.0);
    if random.below(2) == 0 { size } else { -size }
}

/// Two lengths, and what is left of `whole` between them: about a gap, and exact, as lengths of this size differ by few digits.
fn split(random: &mut Random, whole: f64) -> [f64; 3] {
    let first = 1.0 + (random.below(8) as f64) / 8.0;
    let second = whole - first - gap(random);
    [first, second, (whole - first) - second]
}

fn balls(random: &mut Random) -> Made {
    let (mut between, whole) = QUADRUPLES[random.below(QUADRUPLES.len())];
    between.rotate_left(random.below(3));
    between.iter_mut().for_each(|x| *x *= [1.0, -1.0][random.below(2)]);
    let center = DVec3::from_array([0; 3].map(|_| random.whole(-50, 50) as f64));
    let [first, second, gap] = split(random, whole);
    let a = AnyBody::new(Sphere { center, radius: first })?;
    Ok((a, AnyBody::new(Sphere { center: center + DVec3::from_array(between), radius: second })?, gap))
}

fn capsules(random: &mut Random) -> Made {
    let at = DVec3::from_array([0; 3].map(|_| random.whole(-50, 50) as f64));
    let [first, second, gap] = split(random, 4.0);
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let n = random.below(3);
    let [u, v, w] = [axes[n], axes[(n + 1) % 3], axes[(n + 2) % 3]];
    let reach = |random: &mut Random| random.whole(1, 20) as f64;
    let a = Capsule { from: at - u * reach(random), to: at + u * reach(random), radius: first };
    let at = at + w * 4.0;
    let b = Capsule { from: at - v * reach(random), to: at + v * reach(random), radius: second };
    Ok((AnyBody::new(a)?, AnyBody::new(b)?, gap))
}

fn cylinders(random: &mut Random) -> Made {
    let at = DVec3::from_array([0; 3].map(|_| random.whole(-50, 50) as f64));
    let [first, second, gap] = split(random, 4.0);
    let reach = |random: &mut Random| random.whole(1, 20) as f64;
    // Along x; the box lies above it, a side at the height at which the gap begins.
    let pipe = Cylinder::new(at - DVec3::X * reach(random), at + DVec3::X * reach(random), second);
    let min = at + DVec3::new(-reach(random), -reach(random), 4.0 - first);
    let brick = Aabb { min, max: at + DVec3::new(reach(random), reach(random), 9.0) };
    Ok((AnyBody::new(pipe)?, AnyBody::new(brick)?, gap))
}

fn judge(effort: Effort, seed: u64, make: fn(&mut Random) -> Made) -> Numbers {
    let mut random = Random::new(seed);
    let (mut wrong, mut undecided, mut outside, mut apart, mut overlapping) = (0, 0, 0, 0, 0);
    for _ in 0..effort.pick(20_000, 400_000) {
        let (a, b, gap) = make(&mut random)?;
        match contact(&a, &b) {
            Some(Contact::Disjoint) => wrong += usize::from(gap <= 0.0),
            Some(_) => wrong += usize::from(gap >= 0.0),
            // Coordinates are up to 100.
            None => undecided += usize::from(gap.abs() > 1e-12 * 100.0),
        }
        let truth = gap.max(0.0);
        let [lower, _, upper] = clearance(&a, &b);
        outside += usize::from(!(lower <= truth && truth <= upper));
        apart += usize::from(gap > 0.0);
        overlapping += usize::from(gap < 0.0);
    }
    Ok([wrong, undecided, outside, apart, overlapping].map(|n| n as f64).to_vec())
}
