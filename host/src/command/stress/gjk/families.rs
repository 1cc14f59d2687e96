//! Degenerate pairs of hulls, family by family, and all of them at any size.

use crate::command::stress::case::{Criterion, Effort, Numbers, StressCase, at_least, at_most};
use crate::command::stress::gjk::oracle::{self, WholePoint};
use crate::command::stress::kit::doors::{clearance, contact};
use crate::command::stress::kit::random::Random;
use glam::DVec3;
use voidage_core::convex::AnyBody;
use voidage_core::convex::exact::Contact;
use voidage_core::convex::shape::Hull;
use voidage_core::convex::support::Support;

const RIGHT: [Criterion; 4] = [
    at_most(0.0, "wrong answers"),
    at_most(0.0, "undecided"),
    at_most(0.0, "distances outside of their bounds"),
    at_most(1e-9, "relative error of a distance above 1e-6 of the size"),
];
const APART: Criterion = at_least(300.0, "pairs apart");
const TOUCHING: Criterion = at_least(100.0, "touching");
const SOLID: &[Criterion] = &[RIGHT[0], RIGHT[1], RIGHT[2], RIGHT[3], APART, TOUCHING, at_least(100.0, "overlapping")];
/// Hulls without an inner point cannot overlap.
const FLAT: &[Criterion] = &[RIGHT[0], RIGHT[1], RIGHT[2], RIGHT[3], APART, TOUCHING];

/// The cases.
pub const CASES: &[StressCase] = &[
    StressCase::new("gjk/lattice", "hulls of 1 to 6 points of a lattice: integers", SOLID, |e| judge(e, 1, lattice)),
    StressCase::new("gjk/coplanar", "hulls in one plane askew: integers", FLAT, |e| judge(e, 2, coplanar)),
    StressCase::new("gjk/collinear", "hulls on one line askew: integers", FLAT, |e| judge(e, 3, collinear)),
    StressCase::new("gjk/needles", "hulls of 1e-6 of their length beside common ones: integers", SOLID, |e| {
        judge(e, 4, needle)
    }),
    StressCase::new("gjk/slabs", "hulls of 1e-6 of their width on each other: integers", SOLID, |e| judge(e, 5, slab)),
    StressCase::new("gjk/duplicates", "points given up to three times: integers", SOLID, |e| judge(e, 6, duplicates)),
    StressCase::new("gjk/containment", "small hulls in large ones and beside them: integers", SOLID, |e| {
        judge(e, 7, containment)
    }),
    StressCase::new("gjk/tilted", "lattice hulls turned, in steps of 2^-20: integers", SOLID, |e| judge(e, 8, tilted)),
    StressCase::new("gjk/far", "lattice hulls 7.7e5 from the origin: integers", SOLID, |e| judge(e, 9, far)),
    StressCase::new(
        "gjk/ulps",
        "hulls with facing sides up to 3 units in the last place apart or into each other",
        SOLID,
        ulps,
    ),
    StressCase::new("gjk/powers", "lattice hulls times 2^-1000, 2^-975, … 2^1000: integers", SOLID, powers),
];

/// Two hulls with whole coordinates, and the power of two by which they are multiplied.
struct WholePair {
    a: Vec<WholePoint>,
    b: Vec<WholePoint>,
    power: i32,
}

fn points(random: &mut Random) -> Vec<WholePoint> {
    let count = 1 + random.below(6);
    (0..count).map(|_| [0; 3].map(|_| random.whole(-4, 4))).collect()
}

/// Hulls of lattice points changed by a map, the first told by `true`, the second moved: in half of the pairs so that they share a point.
fn changed(random: &mut Random, power: i32, change: impl Fn(bool, WholePoint) -> WholePoint) -> WholePair {
    let of_one = |random: &mut Random, first: bool| points(random).into_iter().map(|p| change(first, p)).collect();
    let (a, mut b): (Vec<WholePoint>, Vec<WholePoint>) = (of_one(random, true), of_one(random, false));
    let (from, to) = match random.below(2) {
        0 => (b[random.below(b.len())], a[random.below(a.len())]),
        _ => (change(true, [0; 3]), change(true, [0; 3].map(|_| random.whole(-6, 6)))),
    };
    b.iter_mut().for_each(|p| *p = [0, 1, 2].map(|k| p[k] + to[k] - from[k]));
    WholePair { a, b, power }
}

fn lattice(random: &mut Random) -> WholePair {
    changed(random, 0, |_, p| p)
}

fn coplanar(random: &mut Random) -> WholePair {
    changed(random, 0, |_, [x, y, _]| [x, y, x + 2 * y])
}

fn collinear(random: &mut Random) -> WholePair {
    changed(random, 0, |_, [t, ..]| [t, 2 * t, -t])
}

fn needle(random: &mut Random) -> WholePair {
    let thin = |[x, y, z]: WholePoint| [x << 20, y, z << 4];
    changed(random, -20, |first, p| if first { thin(p) } else { p.map(|x| x << 20) })
}

fn slab(random: &mut Random) -> WholePair {
    changed(random, -20, |_, [x, y, z]| [x << 20, y << 20, z])
}

fn duplicates(random: &mut Random) -> WholePair {
    let pair = lattice(random);
    WholePair { a: [&pair.a[..], &pair.a[..], &pair.a[..1]].concat(), b: [&pair.b[..1], &pair.b[..]].concat(), ..pair }
}

fn containment(random: &mut Random) -> WholePair {
    changed(random, -3, |first, p| if first { p.map(|x| 8 * x) } else { p })
}

fn tilted(random: &mut Random) -> WholePair {
    // A rotation whose entries are no dyadic fractions: every coordinate rounds.
    const TURN: [[f64; 3]; 3] = [[0.8, -0.36, 0.48], [0.6, 0.48, -0.64], [0.0, 0.8, 0.6]];
    let turn = |p: WholePoint| {
        TURN.map(|row| (2f64.powi(20) * (0..3).map(|k| row[k] * p[k] as f64).sum::<f64>()).round() as i64)
    };
    changed(random, -20, |_, p| turn(p))
}

fn far(random: &mut Random) -> WholePair {
    changed(random, -4, |_, p| p.map(|x| 16 * x + 12_345_678))
}

/// What was counted.
#[derive(Default)]
struct Tally {
    wrong: usize,
    undecided: usize,
    outside: usize,
    error: f64,
    /// Apart, touching, overlapping.
    met: [usize; 3],
}

impl Tally {
    /// Asks about a pair of which the truth is known.
    fn ask(&mut self, [a, b]: [&[DVec3]; 2], truth: Contact, distance: f64) -> Result<(), Box<dyn std::error::Error>> {
        let (a, b) = (AnyBody::new(Hull::new(a))?, AnyBody::new(Hull::new(b))?);
        match contact(&a, &b) {
            None => self.undecided += 1,
            Some(said) => self.wrong += usize::from(said != truth),
        }
        self.met[truth as usize] += 1;
        let [lower, found, upper] = clearance(&a, &b);
        // The truth itself is rounded.
        let room = 8.0 * f64::EPSILON * distance;
        self.outside +=
            usize::from(!(lower - room <= distance && distance <= upper + room && lower <= found && found <= upper));
        let size = (a.extent() + b.extent()).max(distance);
        if distance > 1e-6 * size {
            self.error = self.error.max((found / distance - 1.0).abs());
        }
        Ok(())
    }

    /// For hulls that may overlap, and for those that cannot.
    fn numbers(&self) -> Vec<f64> {
        let [apart, touching, overlapping] = self.met;
        let mut numbers = vec![self.wrong as f64, self.undecided as f64, self.outside as f64, self.error, apart as f64];
        numbers.push(touching as f64);
        if overlapping > 0 {
            numbers.push(overlapping as f64);
        }
        numbers
    }
}

fn floats(points: &[WholePoint], power: i32) -> Vec<DVec3> {
    // In two steps, so that no power overflows.
    let (half, rest) = (2f64.powi(power / 2), 2f64.powi(power - power / 2));
    points.iter().map(|p| DVec3::from_array(p.map(|x| x as f64 * half * rest))).collect()
}

fn truth_of(pair: &WholePair) -> (Contact, f64) {
    let truth = oracle::contact(&pair.a, &pair.b);
    (truth, if truth == Contact::Disjoint { oracle::distance(&pair.a, &pair.b) } else { 0.0 })
}

fn judge(effort: Effort, seed: u64, make: fn(&mut Random) -> WholePair) -> Numbers {
    let (mut random, mut tally) = (Random::new(seed), Tally::default());
    for _ in 0..effort.pick(8000, 100_000) {
        let pair = make(&mut random);
        let (truth, distance) = truth_of(&pair);
        let (a, b) = (floats(&pair.a, pair.power), floats(&pair.b, pair.power));
        tally.ask([&a, &b], truth, distance * 2f64.powi(pair.power))?;
    }
    Ok(tally.numbers())
}

fn powers(effort: Effort) -> Numbers {
    let (mut random, mut tally) = (Random::new(10), Tally::default());
    for _ in 0..effort.pick(600, 6000) {
        let pair = lattice(&mut random);
        let (truth, distance) = truth_of(&pair);
        for power in (-1000..=1000).step_by(25) {
            let (a, b) = (floats(&pair.a, power), floats(&pair.b, power));
            tally.ask([&a, &b], truth, distance * 2f64.powi(power / 2) * 2f64.powi(power - power / 2))?;
        }
    }
    Ok(tally.numbers())
}

fn ulps(effort: Effort) -> Numbers {
    let (mut random, mut tally) = (Random::new(11), Tally::default());
    for _ in 0..effort.pick(8000, 100_000) {
        let axis = random.below(3);
        let place = random.whole(-9, 9) as f64 / 3.0 + 0.1;
        let steps = random.whole(-3, 3);
        let other = (0..steps.abs()).fold(place, |x, _| if steps > 0 { x.next_up() } else { x.next_down() });
        // A square in the plane, and points behind it: `side` is -1 for the body below.
        let mut body = |plane: f64, side: f64| {
            let mut points: Vec<DVec3> =
                [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[u, v]| DVec3::new(plane, u, v)).to_vec();
            for _ in 0..1 + random.below(3) {
                let depth = plane + side * random.between(0.1, 2.0);
                points.push(DVec3::new(depth, random.between(-2.0, 2.0), random.between(-2.0, 2.0)));
            }
            points.iter_mut().for_each(|p| *p = DVec3::from_array([0, 1, 2].map(|k| p[(k + 3 - axis) % 3])));
            points
        };
        let (a, b) = (body(place, -1.0), body(other, 1.0));
        let truth = match steps {
            1.. => Contact::Disjoint,
            0 => Contact::Touching,
            _ => Contact::Overlapping,
        };
        // The difference of neighbours is exact.
        tally.ask([&a, &b], truth, (other - place).max(0.0))?;
    }
    Ok(tally.numbers())
}
