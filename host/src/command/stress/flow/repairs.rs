//! What repairs add: first order where a state would leave the physical set costs nothing; floors book what they change.

use crate::command::stress::case::{Effort, Numbers, StressCase, at_least, at_most};
use crate::command::stress::kit::books::{Books, unphysical};
use crate::command::stress::kit::doors::fixed_steps;
use crate::command::stress::kit::random::Random;
use crate::command::stress::kit::truth::larger;
use crate::flow::Flow;
use voidage_core::flow::{Boundary, Error as FlowError, Gas, Primitive};

/// The cases.
pub const CASES: &[StressCase] = &[
    StressCase::new(
        "flow/fallback",
        "random gas, densities and pressures 1e3 apart, Mach numbers up to 1e4, stable steps: conservation without floors",
        &[
            at_most(1e-12, "mass and energy lost"),
            at_most(0.0, "floors"),
            at_most(0.0, "cells without a physical state"),
            at_least(100.0, "cells that fell back to first order"),
        ],
        fallback,
    ),
    StressCase::new(
        "flow/floors",
        "the same gas in steps of 1.5 times what is stable: mass and energy grow by what is booked for floors",
        &[
            at_most(1e-11, "mass and energy that are not booked, as shares"),
            at_most(0.0, "cells without a physical state"),
            at_least(1.0, "floors"),
        ],
        floors,
    ),
];

const GAS: Gas<f64> = Gas::Ideal { gamma: 1.4 };

/// Random gas in a periodic box.
fn rough(mach: f64, seed: u64, least: f64) -> Flow<f64, 2> {
    let mut random = Random::new(seed);
    let mut flow: Flow<f64, 2> = Flow::uniform([12, 12], [1.0; 2], GAS, [[Boundary::Periodic; 2]; 2]);
    for cell in 0..flow.len() {
        let (density, pressure) = (random.scale(least, 1.0), random.scale(least, 1.0));
        let speed = mach * f64::sqrt(1.4 * pressure / density);
        let velocity = [0; 2].map(|_| speed * random.between(-1.0, 1.0));
        flow.set(cell, &Primitive { density, velocity, pressure });
    }
    flow
}

fn runs(effort: Effort) -> impl Iterator<Item = (f64, u64)> {
    let seeds = effort.pick(8, 200);
    [3.0, 30.0, 1e3, 1e4].into_iter().flat_map(move |mach| (0..seeds).map(move |seed| (mach, seed)))
}

fn fallback(effort: Effort) -> Numbers {
    let (mut lost, mut floors, mut broken, mut fallen) = (0.0, 0, 0.0, 0);
    for (mach, seed) in runs(effort) {
        let mut flow = rough(mach, seed, 1e-3);
        let books = Books::open(&flow);
        fixed_steps(&mut flow, 60, |flow| flow.stable_dt(0.8))?;
        lost = larger(lost, books.lost(&flow));
        (floors, fallen) = (floors + flow.total.floored, fallen + flow.total.first_order);
        broken += unphysical(&flow);
    }
    Ok(vec![lost, floors as f64, broken, fallen as f64])
}

/// What is not booked of one run, cells without a state, floors.
fn booked(mach: f64, seed: u64) -> Result<[f64; 3], FlowError> {
    let mut flow = rough(mach, seed, 1e-2);
    let before = flow.content();
    fixed_steps(&mut flow, 60, |flow| flow.stable_dt(1.5))?;
    let (after, change) = (flow.content(), flow.total.floor_change);
    let energy = (after.energy - before.energy - change.energy).abs() / before.energy;
    let mass = (after.density - before.density - change.density).abs() / before.density;
    Ok([larger(mass, energy), unphysical(&flow), flow.total.floored as f64])
}

fn floors(effort: Effort) -> Numbers {
    let mut numbers = [0.0; 3];
    for (mach, seed) in runs(effort) {
        let found = booked(mach, seed)?;
        numbers = [larger(numbers[0], found[0]), numbers[1] + found[1], numbers[2] + found[2]];
    }
    Ok(numbers.to_vec())
}
