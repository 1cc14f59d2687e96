//! Gas in the open: shock tubes that trouble solvers.

use crate::command::stress::case::{Criterion, Effort, Numbers, StressCase, at_most};
use crate::command::stress::kit::doors::run;
use crate::command::stress::kit::riemann::{ExactRiemann, GasState};
use crate::flow::Flow;
use voidage_core::flow::{Boundary, Gas};

const TUBE: &[Criterion] = &[
    at_most(0.02, "mean error of the density, as a share of the largest"),
    at_most(1e-12, "mass and energy lost"),
    at_most(0.0, "floors"),
];

/// The cases.
pub const CASES: &[StressCase] = &[StressCase::new(
    "flow/near-vacuum",
    "streams that part at 0.999 of what leaves vacuum: exact Riemann solution",
    TUBE,
    near_vacuum,
)];

/// A tube of unit length with its diaphragm in the middle; `n` cells.
struct Tube {
    left: GasState,
    right: GasState,
    gamma: f64,
    end: f64,
}

impl Tube {
    /// Mean error of the density as a share of the largest, what mass and energy went astray, and how many floors there were.
    fn judge(&self, n: usize) -> Numbers {
        let ends = [Boundary::FarField(self.left.along(0)), Boundary::FarField(self.right.along(0))];
        let mut flow: Flow<f64, 1> = Flow::uniform([n], [1.0 / n as f64], Gas::Ideal { gamma: self.gamma }, [ends]);
        flow.fill(|[x]| if x < 0.5 { self.left } else { self.right }.along(0));
        let before = flow.content();
        run(&mut flow, 0.8, self.end)?;
        let (after, [[low, high]]) = (flow.content(), flow.total.inflow);
        let mass = (after.density - before.density - low.density - high.density) / before.density;
        let energy = (after.energy - before.energy - low.energy - high.energy) / before.energy;
        let exact = ExactRiemann::new(self.left, self.right, self.gamma);
        let edge = |i: usize| i as f64 / n as f64 - 0.5;
        let off = |i: usize| (flow.get(i).density - exact.mean_density(edge(i), edge(i + 1), self.end)).abs();
        let error = (0..n).map(off).sum::<f64>() / n as f64 / self.left.rho.max(self.right.rho);
        Ok(vec![error, mass.abs().max(energy.abs()), flow.total.floored as f64])
    }
}

fn near_vacuum(effort: Effort) -> Numbers {
    let u = 0.999 * 2.0 / 0.4 * 1.4f64.sqrt();
    let state = |u: f64| GasState { rho: 1.0, u, p: 1.0 };
    Tube { left: state(-u), right: state(u), gamma: 1.4, end: 0.05 }.judge(effort.pick(400, 4000))
}
