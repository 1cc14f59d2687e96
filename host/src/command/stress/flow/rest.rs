//! Gas that rests must rest.

use crate::command::stress::case::{Criterion, Effort, Numbers, StressCase, at_least, at_most};
use crate::command::stress::kit::books::{Books, bits, differ, face_count, set_random_porosity};
use crate::command::stress::kit::doors::steps;
use crate::command::stress::kit::random::Random;
use crate::command::stress::kit::truth::larger;
use crate::flow::{Flow, Treatment};
use voidage_core::flow::{Boundary, Gas, Primitive};

const STILL: &[Criterion] = &[
    at_most(1e-11, "velocity, in speeds of sound"),
    at_most(1.0, "mass and energy lost, in rounding errors a step"),
    at_least(100_000.0, "steps"),
];

/// The cases.
pub const CASES: &[StressCase] = &[
    StressCase::new(
        "flow/rest",
        "gas at rest of one pressure, densities 1e3 apart, over random porosity in 1 to 3 dimensions, 1000 steps",
        &[at_most(0.0, "bits that change"), at_least(9.0, "boxes")],
        rest,
    ),
    StressCase::new(
        "flow/gravity",
        "a column of 64 porous layers in hydrostatic balance, 1 dimension, 100000 steps",
        STILL,
        |_| column::<1>(0, 100_000),
    ),
    StressCase::new("flow/gravity-3d", "the same column of 3 × 3 × 64 cells, 100000 steps", STILL, |_| {
        column::<3>(2, 100_000)
    })
    .only_long(),
];

const GAS: Gas<f64> = Gas::Ideal { gamma: 1.4 };

/// How many bits change in a box of random porosity.
fn box_at_rest<const D: usize>(seed: u64, n: [usize; D], count: usize) -> Result<f64, voidage_core::flow::Error> {
    let mut random = Random::new(seed);
    let mut flow: Flow<f64, D> = Flow::uniform(n, [0.1; D], GAS, [[Boundary::Wall; 2]; D]);
    set_random_porosity(&mut flow, n, &mut random)?;
    for cell in 0..flow.len() {
        flow.set(cell, &Primitive { density: random.scale(1e-3, 1.0), velocity: [0.0; D], pressure: 1.0 });
    }
    // Small cells share a state with a neighbour from the first step on.
    flow.rate()?;
    let before = bits(&flow);
    steps(&mut flow, 0.8, count)?;
    Ok(differ(&before, &bits(&flow)))
}

fn rest(effort: Effort) -> Numbers {
    let (mut changed, mut boxes) = (0.0, 0);
    let count = effort.pick(1000, 20_000);
    for seed in 0..3 {
        changed +=
            box_at_rest(seed, [40], count)? + box_at_rest(seed, [7, 6], count)? + box_at_rest(seed, [4, 3, 3], count)?;
        boxes += 3;
    }
    Ok(vec![changed, f64::from(boxes)])
}

/// Layers of random porosity with gas whose pressure falls by what the gas weighs: the largest velocity, what went astray, steps.
fn column<const D: usize>(axis: usize, count: usize) -> Numbers {
    let (layers_high, gravity, height) = (64, -9.81, 10.0);
    let n: [usize; D] = std::array::from_fn(|d| if d == axis { layers_high } else { 3 });
    let boundaries = std::array::from_fn(|d| [if d == axis { Boundary::Wall } else { Boundary::Periodic }; 2]);
    let mut flow: Flow<f64, D> = Flow::uniform(n, [height; D], GAS, boundaries);
    flow.gravity[axis] = gravity;
    let mut random = Random::new(9);
    let layers: Vec<f64> = (0..layers_high).map(|_| random.between(0.05, 1.0)).collect();
    let volume = (0..flow.len()).map(|cell| layers[flow.coordinates(cell)[axis]]).collect();
    let faces = std::array::from_fn(|d| {
        let size: [usize; D] = std::array::from_fn(|a| n[a] + usize::from(a == d));
        let stride: usize = size[..axis].iter().product();
        let open = |f: usize| {
            let k = f / stride % size[axis];
            if d == axis { layers[k.min(layers_high - 1)].min(layers[k.max(1) - 1]) } else { layers[k] }
        };
        (0..face_count(n, d)).map(open).collect()
    });
    flow.set_porosity(volume, faces, Treatment::default())?;
    let density: Vec<f64> = (0..layers_high).map(|k| 1.2 * (-(k as f64) * height / 8000.0).exp()).collect();
    let mut pressure = vec![1e5; layers_high];
    for k in 1..layers_high {
        pressure[k] = pressure[k - 1] + 0.5 * gravity * height * (density[k - 1] + density[k]);
    }
    for cell in 0..flow.len() {
        let k = flow.coordinates(cell)[axis];
        flow.set(cell, &Primitive { density: density[k], velocity: [0.0; D], pressure: pressure[k] });
    }
    let books = Books::open(&flow);
    steps(&mut flow, 0.8, count)?;
    let fastest = (0..flow.len()).flat_map(|cell| flow.get(cell).velocity).fold(0.0, |most, u| larger(most, u.abs()));
    let lost = books.lost(&flow) / (f64::EPSILON * flow.steps as f64);
    Ok(vec![fastest / 340.0, lost, flow.steps as f64])
}
