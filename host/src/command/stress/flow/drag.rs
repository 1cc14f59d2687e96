//! Resistance of any strength.

use crate::command::riemann::{ExactRiemann, GasState};
use crate::command::stress::case::{Effort, Numbers, StressCase, at_least, at_most};
use crate::command::stress::kit::books::Books;
use crate::command::stress::kit::doors::{fixed_steps, run};
use crate::command::stress::kit::truth::larger;
use crate::flow::Flow;
use voidage_core::flow::{Boundary, Gas};

/// The cases.
pub const CASES: &[StressCase] = &[
    StressCase::new(
        "flow/drag-decay",
        "uniform gas that slows down by CR of 1e-3 to 1e12 per m in steps of any size: u/(1 + CR u t/2), its heat kept",
        &[
            at_most(1e-12, "relative error of the velocity"),
            at_most(1e-12, "mass and energy lost"),
            at_least(16.0, "resistances"),
        ],
        drag_decay,
    ),
    StressCase::new(
        "flow/rigid-slab",
        "a Mach 2 shock strikes a slab of CR 1e12: the pressure reflected by a wall, exact Riemann solution",
        &[
            at_most(0.03, "relative error of the reflected pressure"),
            at_most(1e-4, "velocity in the slab, in speeds of sound"),
            at_most(1e-12, "mass and energy lost"),
        ],
        rigid_slab,
    ),
];

const GAS: Gas<f64> = Gas::Ideal { gamma: 1.4 };

fn drag_decay(_: Effort) -> Numbers {
    let (mut error, mut lost, mut resistances) = (0.0, 0.0, 0);
    for power in -3..=12 {
        let resistance = 10f64.powi(power);
        let mut flow: Flow<f64, 1> = Flow::uniform([5], [0.2], GAS, [[Boundary::Periodic; 2]]);
        flow.set_drag([vec![resistance; 5]], [Vec::new()])?;
        let start = GasState { rho: 1.2, u: 0.7, p: 1.0 };
        flow.fill(|_| start.along(0));
        let books = Books::open(&flow);
        fixed_steps(&mut flow, 40, |_| Ok(0.05))?;
        let exact = start.u / (1.0 + 0.5 * resistance * start.u * flow.time);
        for cell in 0..5 {
            error = larger(error, (flow.get(cell).velocity[0] / exact - 1.0).abs());
        }
        lost = larger(lost, books.lost(&flow));
        resistances += 1;
    }
    Ok(vec![error, lost, f64::from(resistances)])
}

fn rigid_slab(effort: Effort) -> Numbers {
    let n = effort.pick(200, 2000);
    let right = GasState { rho: 1.0, u: 0.0, p: 1.0 };
    // Behind a shock of Mach 2 into gas at rest.
    let left = GasState { rho: 8.0 / 3.0, u: 1.25 * 1.4f64.sqrt(), p: 4.5 };
    let ends = [Boundary::FarField(left.along(0)), Boundary::ZeroGradient];
    let mut flow: Flow<f64, 1> = Flow::uniform([n], [1.0 / n as f64], GAS, [ends]);
    let slab = n / 2..3 * n / 4;
    flow.set_drag([(0..n).map(|i| if slab.contains(&i) { 1e12 } else { 0.0 }).collect()], [Vec::new()])?;
    flow.fill(|[x]| if x < 0.3 { left } else { right }.along(0));
    let books = Books::open(&flow);
    run(&mut flow, 0.8, 0.25)?;
    // A wall is where the same stream comes from the other side.
    let wall = ExactRiemann::new(left, GasState { u: -left.u, ..left }, 1.4).at(0.0).p;
    let error = (flow.get(n / 2 - n / 20).pressure / wall - 1.0).abs();
    let creep = (n / 2 + 2..slab.end).map(|i| flow.get(i).velocity[0].abs()).fold(0.0, larger) / 1.4f64.sqrt();
    Ok(vec![error, creep, books.lost(&flow)])
}
