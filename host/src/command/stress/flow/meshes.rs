//! What must not matter: units, axes, threads; and hardly any cells.

use crate::command::stress::case::{Effort, Numbers, StressCase, at_least, at_most};
use crate::command::stress::kit::books::{bits, differ, face_count, set_random_porosity};
use crate::command::stress::kit::doors::{fixed_steps, steps};
use crate::command::stress::kit::random::Random;
use crate::command::stress::kit::truth::larger;
use crate::flow::{Flow, Treatment};
use voidage_core::flow::{Boundary, Error as FlowError, Gas, Primitive};

/// The cases.
pub const CASES: &[StressCase] = &[
    StressCase::new(
        "flow/units",
        "a blast through random porosity and drag, in units times powers of two, in SI and with lengths of 1e-9 m",
        &[
            at_most(0.0, "bits that differ for powers of two"),
            at_most(1e-9, "relative change for SI and 1e-9 m"),
            at_least(4.0, "systems of units"),
        ],
        units,
    ),
    StressCase::new(
        "flow/one-cell",
        "uniform gas in domains of 1 to 3 cells between sides of six kinds: stays",
        &[at_most(1e-13, "relative change"), at_least(100.0, "domains")],
        one_cell,
    ),
    StressCase::new(
        "flow/threads",
        "a blast through random porosity on 1, 2, 3 and 5 threads",
        &[at_most(0.0, "bits that differ")],
        threads,
    ),
    StressCase::new(
        "flow/axes",
        "a blast through random porosity with its axes exchanged in a circle",
        &[at_most(0.0, "bits that differ"), at_least(1.0, "faces where porosity jumps")],
        axes,
    ),
];

const GAS: Gas<f64> = Gas::Ideal { gamma: 1.4 };

/// A blast in units of density, velocity and length; its state in these units.
fn blast(density: f64, velocity: f64, length: f64) -> Result<Vec<f64>, FlowError> {
    let n = [24, 6];
    let mut random = Random::new(5);
    let mut flow: Flow<f64, 2> = Flow::uniform(n, [length / 8.0; 2], GAS, [[Boundary::Wall; 2]; 2]);
    set_random_porosity(&mut flow, n, &mut random)?;
    let drag: Vec<f64> = (0..flow.len()).map(|_| random.scale(1e-2, 1e2) / length).collect();
    flow.set_drag([drag.clone(), drag], [Vec::new(), Vec::new()])?;
    for cell in 0..flow.len() {
        let pressure = density * velocity * velocity * random.scale(1e-2, 10.0);
        let moving = [0; 2].map(|_| velocity * random.between(-0.5, 0.5));
        flow.set(cell, &Primitive { density: density * random.scale(0.1, 1.0), velocity: moving, pressure });
    }
    fixed_steps(&mut flow, 40, |_| Ok(length / velocity / 512.0))?;
    let state = (0..flow.len()).map(|cell| flow.get(cell));
    let own = |w: Primitive<f64, 2>| {
        [
            w.density / density,
            w.velocity[0] / velocity,
            w.velocity[1] / velocity,
            w.pressure / (density * velocity * velocity),
        ]
    };
    Ok(state.flat_map(own).collect())
}

fn units(_: Effort) -> Numbers {
    let one = blast(1.0, 1.0, 1.0)?;
    let to_bits = |state: &[f64]| state.iter().map(|x| (x + 0.0).to_bits()).collect::<Vec<_>>();
    let (mut changed, mut change) = (0.0, 0.0);
    for (density, velocity, length) in [(-30, -20, -30), (20, 9, 30)] {
        let scaled = blast(2f64.powi(density), 2f64.powi(velocity), 2f64.powi(length))?;
        changed += differ(&to_bits(&one), &to_bits(&scaled));
    }
    // Of air: density 1.2 kg/m³, pressure 101325 Pa.
    let speed = f64::sqrt(101_325.0 / 1.2);
    for length in [1.0, 1e-9] {
        for (a, b) in one.iter().zip(blast(1.2, speed, length)?) {
            change = larger(change, (a - b).abs() / a.abs().max(1.0));
        }
    }
    Ok(vec![changed, change, 4.0])
}

fn one_cell(_: Effort) -> Numbers {
    let (mut change, mut domains) = (0.0, 0);
    let air = Primitive { density: 1.2, velocity: [30.0, -20.0, 10.0], pressure: 101_325.0 };
    let still = Primitive { velocity: [0.0; 3], ..air };
    for n in [[1, 1, 1], [2, 1, 1], [1, 3, 1], [1, 1, 2], [2, 1, 3], [3, 2, 1]] {
        for (side, gas) in [
            (Boundary::Periodic, air),
            (Boundary::ZeroGradient, air),
            (Boundary::FarField(air), air),
            (Boundary::Wall, still),
            (Boundary::Outlet { pressure: still.pressure }, still),
            (Boundary::Reservoir { density: still.density, pressure: still.pressure }, still),
        ] {
            for widths in [[0.1, 0.1, 0.1], [1.0, 1e-4, 1e-2], [1e-9; 3]] {
                let mut flow: Flow<f64, 3> = Flow::uniform(n, widths, GAS, [[side; 2]; 3]);
                flow.fill(|_| gas);
                steps(&mut flow, 0.8, 100)?;
                for cell in 0..flow.len() {
                    let w = flow.get(cell);
                    change = larger(change, (w.density / gas.density - 1.0).abs());
                    change = larger(change, (w.pressure / gas.pressure - 1.0).abs());
                    // In speeds of sound.
                    (0..3).for_each(|d| change = larger(change, (w.velocity[d] - gas.velocity[d]).abs() / 340.0));
                }
                domains += 1;
            }
        }
    }
    Ok(vec![change, f64::from(domains)])
}

/// A blast through random porosity whose first axis is called `first`, as seen from there.
fn seen_from(first: usize, pool: Option<&rayon::ThreadPool>) -> Result<(Vec<u64>, usize), FlowError> {
    let n = [9, 8, 7];
    // Axis d of the flow is axis (d + first) % 3 of the space.
    let own: [usize; 3] = std::array::from_fn(|d| n[(d + first) % 3]);
    let in_space = |at: [usize; 3]| -> [usize; 3] { std::array::from_fn(|a| at[(a + 3 - first) % 3]) };
    let place = |mut i: usize, size: [usize; 3]| {
        size.map(|n| {
            let k = i % n;
            i /= n;
            k
        })
    };
    let value = |kind: usize, at: [usize; 3]| Random::new((((kind * 32 + at[2]) * 32 + at[1]) * 32 + at[0]) as u64);
    let fraction = |kind, at| 0.3 + 0.7 * value(kind, at).between(0.0, 1.0);
    let mut flow: Flow<f64, 3> = Flow::uniform(own, [0.1; 3], GAS, [[Boundary::Wall; 2]; 3]);
    let cells = flow.len();
    let volume = (0..cells).map(|c| fraction(0, in_space(place(c, own)))).collect();
    let faces = std::array::from_fn(|d| {
        let size = std::array::from_fn(|a| own[a] + usize::from(a == d));
        (0..face_count(own, d)).map(|f| fraction(1 + (d + first) % 3, in_space(place(f, size)))).collect()
    });
    flow.set_porosity(volume, faces, Treatment::default())?;
    for cell in 0..cells {
        let at = in_space(place(cell, own));
        let velocity = std::array::from_fn(|d| value(4 + (d + first) % 3, at).between(-0.5, 0.5));
        let (density, pressure) = (value(7, at).scale(0.1, 1.0), value(8, at).scale(0.1, 10.0));
        flow.set(cell, &Primitive { density, velocity, pressure });
    }
    let mut go = || fixed_steps(&mut flow, 40, |_| Ok(2e-3));
    match pool {
        Some(pool) => pool.install(go)?,
        None => go()?,
    }
    let mut seen = vec![0; 5 * cells];
    let found = bits(&flow);
    for cell in 0..cells {
        let at = in_space(place(cell, own));
        let target = (at[2] * n[1] + at[1]) * n[0] + at[0];
        // Density, three momenta, energy.
        let kinds = [0, 1 + first % 3, 1 + (1 + first) % 3, 1 + (2 + first) % 3, 4];
        kinds.into_iter().enumerate().for_each(|(from, to)| seen[to * cells + target] = found[from * cells + cell]);
    }
    Ok((seen, flow.jump_faces()))
}

fn threads(_: Effort) -> Numbers {
    let mut found = Vec::new();
    for count in [1, 2, 3, 5] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build()?;
        found.push(seen_from(0, Some(&pool))?.0);
    }
    Ok(vec![found.windows(2).map(|pair| differ(&pair[0], &pair[1])).sum()])
}

fn axes(_: Effort) -> Numbers {
    let (plain, jumps) = seen_from(0, None)?;
    let changed = differ(&plain, &seen_from(1, None)?.0) + differ(&plain, &seen_from(2, None)?.0);
    Ok(vec![changed, jumps as f64])
}
