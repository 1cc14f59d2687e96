//! Closed, nearly closed and random space.

use crate::command::riemann::{ExactRiemann, GasState};
use crate::command::stress::case::{Effort, Numbers, StressCase, at_least, at_most};
use crate::command::stress::kit::books::{Books, bits, differ, face_count, set_random_porosity, unphysical};
use crate::command::stress::kit::doors::{run, steps};
use crate::command::stress::kit::random::Random;
use crate::command::stress::kit::truth::larger;
use crate::flow::{Flow, Treatment};
use voidage_core::flow::{Boundary, Error as FlowError, Gas, Primitive};

/// The cases.
pub const CASES: &[StressCase] = &[
    StressCase::new(
        "flow/tiny-cells",
        "shock tubes in 1, 2 and 3 dimensions with cells of open volume 1e-12 behind open faces",
        &[
            at_most(1e-12, "mass and energy lost"),
            at_most(4.0, "steps, times those without such cells"),
            at_most(0.0, "floors"),
        ],
        tiny_cells,
    ),
    StressCase::new(
        "flow/slices",
        "Sod's tube through 50 slices of open volume 1e-12 to 1 among 200 cells: exact solution in the length that they leave",
        &[at_most(0.02, "mean error of the density"), at_most(1e-12, "mass and energy lost")],
        slices,
    ),
    StressCase::new(
        "flow/sealed",
        "blasts beside a sealed pocket and a blocked row, and in a space all blocked: what is closed keeps its bits",
        &[
            at_most(0.0, "bits of closed cells that change"),
            at_most(1e-12, "mass and energy lost"),
            at_least(2.0, "cells hit"),
        ],
        sealed,
    ),
    StressCase::new(
        "flow/random-porosity",
        "pressures up to 1e6 apart in random porosity (0, 1e-12 to 1), 8 boxes of 1 to 3 dimensions, 10000 steps",
        &[
            at_most(1.0, "mass and energy lost, in rounding errors a step"),
            at_most(0.0, "cells without a physical state"),
            at_most(0.0, "floors"),
            at_least(80_000.0, "steps"),
        ],
        random_porosity,
    ),
];

const GAS: Gas<f64> = Gas::Ideal { gamma: 1.4 };
const LEFT: GasState = GasState { rho: 1.0, u: 0.0, p: 1.0 };
const RIGHT: GasState = GasState { rho: 0.125, u: 0.0, p: 0.1 };

/// A blast in a box of walls around `n` cells across the unit length, before which some cells were made tiny.
fn tube_of<const D: usize>(n: [usize; D], tiny: Option<f64>) -> Result<[f64; 3], FlowError> {
    let mut flow: Flow<f64, D> = Flow::uniform(n, [1.0 / n[0] as f64; D], GAS, [[Boundary::Wall; 2]; D]);
    if let Some(tiny) = tiny {
        let volume = (0..flow.len()).map(|c| if c % 7 == 3 || c % 11 == 4 { tiny } else { 1.0 }).collect();
        let faces = std::array::from_fn(|d| vec![1.0; face_count(n, d)]);
        flow.set_porosity(volume, faces, Treatment::default())?;
    }
    flow.fill(|x| if x[0] < 0.5 { LEFT } else { RIGHT }.along(0));
    let books = Books::open(&flow);
    run(&mut flow, 0.8, 0.2)?;
    Ok([books.lost(&flow), flow.steps as f64, flow.total.floored as f64])
}

fn tiny_cells(_: Effort) -> Numbers {
    let (mut lost, mut steps, mut floors) = (0.0, 0.0, 0.0);
    for (with, without) in [
        (tube_of([200], Some(1e-12))?, tube_of([200], None)?),
        (tube_of([48, 9], Some(1e-12))?, tube_of([48, 9], None)?),
        (tube_of([24, 6, 5], Some(1e-12))?, tube_of([24, 6, 5], None)?),
    ] {
        lost = larger(lost, with[0]);
        steps = larger(steps, with[1] / without[1]);
        floors += with[2];
    }
    Ok(vec![lost, steps, floors])
}

fn slices(effort: Effort) -> Numbers {
    const N: usize = 200;
    let (mut most, mut lost) = (0.0, 0.0);
    for seed in 0..effort.pick(6, 60) {
        let mut random = Random::new(seed);
        let open: Vec<f64> =
            (0..N).map(|_| if random.below(4) == 0 { random.scale(1e-12, 1.0) } else { 1.0 }).collect();
        let width = 1.0 / open.iter().sum::<f64>();
        let mut flow: Flow<f64, 1> = Flow::uniform([N], [width], GAS, [[Boundary::ZeroGradient; 2]]);
        flow.set_porosity(open.clone(), [vec![1.0; N + 1]], Treatment::default())?;
        (0..N).for_each(|i| flow.set(i, &if i < N / 2 { LEFT } else { RIGHT }.along(0)));
        let books = Books::open(&flow);
        run(&mut flow, 0.8, 0.2)?;
        lost = larger(lost, books.lost(&flow));
        let exact = ExactRiemann::new(LEFT, RIGHT, 1.4);
        let (mut x, mut error) = (-width * open[..N / 2].iter().sum::<f64>(), 0.0);
        for (i, open) in open.iter().enumerate() {
            let own = open * width;
            error += own * (flow.get(i).density - exact.mean_density(x, x + own, 0.2)).abs();
            x += own;
        }
        most = larger(most, error);
    }
    Ok(vec![most, lost])
}

fn sealed(effort: Effort) -> Numbers {
    let n = [8, 6];
    let (mut changed, mut lost, mut hit) = (0.0, 0.0, 0);
    for kind in 0..3 {
        let (volume, faces, closed) = closed_space(kind);
        let mut flow: Flow<f64, 2> = Flow::uniform(n, [0.125; 2], GAS, [[Boundary::Wall; 2]; 2]);
        flow.set_porosity(volume, faces, Treatment::default())?;
        flow.fill(|x| if x[0] < 0.5 { LEFT } else { RIGHT }.along(0));
        let (books, before) = (Books::open(&flow), bits(&flow));
        steps(&mut flow, 0.8, effort.pick(200, 10_000))?;
        let (after, cells) = (bits(&flow), flow.len());
        let kept = |bits: &[u64]| {
            closed.iter().flat_map(|&c| [bits[c], bits[cells + c], bits[3 * cells + c]]).collect::<Vec<_>>()
        };
        changed += differ(&kept(&before), &kept(&after));
        if kind > 0 {
            lost = larger(lost, books.lost(&flow));
            hit += usize::from(differ(&before, &after) > 0.0);
        }
    }
    Ok(vec![changed, lost, hit as f64])
}

type Space = (Vec<f64>, [Vec<f64>; 2], Vec<usize>);

/// Open fractions of 8 × 6 cells, and which cells are closed: all, one that is closed all round but open inside, a row.
fn closed_space(kind: usize) -> Space {
    let mut volume = vec![1.0; 48];
    let mut faces = [vec![1.0; 9 * 6], vec![1.0; 8 * 7]];
    match kind {
        0 => {
            volume.fill(0.0);
            faces.iter_mut().for_each(|f| f.fill(0.0));
            (volume, faces, (0..48).collect())
        }
        1 => {
            [3 * 9 + 4, 3 * 9 + 5].into_iter().for_each(|f| faces[0][f] = 0.0);
            [3 * 8 + 4, 4 * 8 + 4].into_iter().for_each(|f| faces[1][f] = 0.0);
            (volume, faces, vec![3 * 8 + 4])
        }
        _ => {
            volume[16..24].fill(0.0);
            faces[0][18..27].fill(0.0);
            faces[1][16..32].fill(0.0);
            (volume, faces, (16..24).collect())
        }
    }
}

/// A box of random porosity and gas; what went astray, cells without a state, floors, steps.
fn random_box<const D: usize>(seed: u64, n: [usize; D], count: usize) -> Result<[f64; 4], FlowError> {
    let mut random = Random::new(seed);
    let mut flow: Flow<f64, D> = Flow::uniform(n, [0.1; D], GAS, [[Boundary::Wall; 2]; D]);
    set_random_porosity(&mut flow, n, &mut random)?;
    for cell in 0..flow.len() {
        let (density, pressure) = (random.scale(1e-2, 1.0), random.scale(1e-3, 1e3));
        flow.set(cell, &Primitive { density, velocity: [0.0; D], pressure });
    }
    let books = Books::open(&flow);
    steps(&mut flow, 0.8, count)?;
    let lost = books.lost(&flow) / (f64::EPSILON * flow.steps as f64);
    Ok([lost, unphysical(&flow), flow.total.floored as f64, flow.steps as f64])
}

fn random_porosity(effort: Effort) -> Numbers {
    let count = effort.pick(10_000, 100_000);
    let mut numbers = [0.0; 4];
    for seed in 0..8 {
        let found = match seed % 3 {
            0 => random_box(seed, [40], count)?,
            1 => random_box(seed, [7, 6], count)?,
            _ => random_box(seed, [4, 3, 3], count)?,
        };
        numbers = [larger(numbers[0], found[0]), numbers[1] + found[1], numbers[2] + found[2], numbers[3] + found[3]];
    }
    Ok(numbers.to_vec())
}
