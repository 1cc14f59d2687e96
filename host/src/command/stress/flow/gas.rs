//! Gas in the open: shock tubes that trouble solvers, against exact solutions.

use crate::command::riemann::{ExactRiemann, GasState};
use crate::command::stress::case::{Criterion, Effort, Numbers, StressCase, at_most};
use crate::command::stress::kit::books::Books;
use crate::command::stress::kit::doors::run;
use crate::flow::Flow;
use voidage_core::flow::{Boundary, Gas};

const TUBE: &[Criterion] = &[
    at_most(0.02, "mean error of the density, as a share of the largest"),
    at_most(1e-12, "mass and energy lost"),
    at_most(0.0, "floors"),
];
const SHOCK: &[Criterion] =
    &[TUBE[0], TUBE[1], TUBE[2], at_most(0.02, "error of the place of the shock, as a share of its way")];

const ROWS: &[Criterion] = &[TUBE[0], TUBE[1], TUBE[2], at_most(0.0, "largest velocity across")];

/// The cases.
pub const CASES: &[StressCase] = &[
    StressCase::new(
        "flow/near-vacuum",
        "streams that part at 0.999 of what leaves vacuum, 400 cells: exact Riemann solution",
        TUBE,
        near_vacuum,
    ),
    StressCase::new(
        "flow/leblanc",
        "LeBlanc's tube, pressures 1e9 apart, 1000 cells: exact Riemann solution",
        SHOCK,
        leblanc,
    ),
    StressCase::new(
        "flow/burst",
        "pressures 1e6 apart, equal densities, 1000 cells: exact Riemann solution",
        SHOCK,
        burst,
    ),
    StressCase::new(
        "flow/collision",
        "streams of Mach 1e4 that collide, 400 cells: exact Riemann solution",
        SHOCK,
        collision,
    ),
    StressCase::new("flow/gamma", "Sod's tube with gamma 1.01, 400 cells: exact Riemann solution", SHOCK, gamma),
    StressCase::new(
        "flow/thin-cells",
        "Sod's tube in cells of aspect 1e4, 50 along it and 3 across: exact Riemann solution, rows alike",
        ROWS,
        thin_cells,
    ),
];

/// A tube of unit length whose diaphragm lies at `middle`.
struct Tube {
    left: GasState,
    right: GasState,
    gamma: f64,
    middle: f64,
    end: f64,
}

impl Tube {
    /// Mean error of the density as a share of the largest, what mass and energy went astray, how many floors there were, and how far the
    /// shock to the right is off its place, as a share of its way.
    fn judge(&self, n: usize) -> Numbers {
        let ends = [Boundary::FarField(self.left.along(0)), Boundary::FarField(self.right.along(0))];
        let mut flow: Flow<f64, 1> = Flow::uniform([n], [1.0 / n as f64], Gas::Ideal { gamma: self.gamma }, [ends]);
        flow.fill(|[x]| if x < self.middle { self.left } else { self.right }.along(0));
        let books = Books::open(&flow);
        run(&mut flow, 0.8, self.end)?;
        let density: Vec<f64> = (0..n).map(|i| flow.get(i).density).collect();
        let numbers = vec![self.error(&density), books.lost(&flow), flow.total.floored as f64];
        Ok(numbers.into_iter().chain(self.shock_error(&density)).collect())
    }

    fn exact(&self) -> ExactRiemann {
        ExactRiemann::new(self.left, self.right, self.gamma)
    }

    fn error(&self, density: &[f64]) -> f64 {
        let (exact, n) = (self.exact(), density.len());
        let edge = |i: usize| i as f64 / n as f64 - self.middle;
        let off = |i: usize| (density[i] - exact.mean_density(edge(i), edge(i + 1), self.end)).abs();
        let largest = (0..n).map(|i| exact.mean_density(edge(i), edge(i + 1), self.end)).fold(0.0, f64::max);
        (0..n).map(off).sum::<f64>() / n as f64 / largest
    }

    /// The shock stands where the density comes, from the right, half way to that behind it.
    fn shock_error(&self, density: &[f64]) -> Option<f64> {
        let (exact, n) = (self.exact(), density.len());
        let speed = exact.right_shock()?;
        let behind = exact.at(speed - 1e-9 * speed.abs().max(1e-9)).rho;
        let half = 0.5 * (behind + self.right.rho);
        let place = (0..n).rev().find(|&i| density[i] > half).map_or(0.0, |i| (i as f64 + 1.0) / n as f64);
        let way = speed * self.end;
        Some(((place - self.middle - way) / way).abs())
    }
}

fn near_vacuum(effort: Effort) -> Numbers {
    let u = 0.999 * 2.0 / 0.4 * 1.4f64.sqrt();
    let state = |u: f64| GasState { rho: 1.0, u, p: 1.0 };
    Tube { left: state(-u), right: state(u), gamma: 1.4, middle: 0.5, end: 0.05 }.judge(effort.pick(400, 4000))
}

fn leblanc(effort: Effort) -> Numbers {
    // On a length of 9 until 6 in the usual units.
    let (left, right) = (GasState { rho: 1.0, u: 0.0, p: 0.2 / 3.0 }, GasState { rho: 1e-3, u: 0.0, p: 2e-10 / 3.0 });
    Tube { left, right, gamma: 5.0 / 3.0, middle: 1.0 / 3.0, end: 6.0 / 9.0 }.judge(effort.pick(1000, 8000))
}

fn burst(effort: Effort) -> Numbers {
    let (left, right) = (GasState { rho: 1.0, u: 0.0, p: 1e6 }, GasState { rho: 1.0, u: 0.0, p: 1.0 });
    Tube { left, right, gamma: 1.4, middle: 0.5, end: 2.5e-4 }.judge(effort.pick(1000, 8000))
}

fn collision(effort: Effort) -> Numbers {
    let state = |u: f64| GasState { rho: 1.0, u, p: 1e-8 / 1.4 };
    Tube { left: state(1.0), right: state(-1.0), gamma: 1.4, middle: 0.5, end: 1.5 }.judge(effort.pick(400, 4000))
}

fn gamma(effort: Effort) -> Numbers {
    let (left, right) = (GasState { rho: 1.0, u: 0.0, p: 1.0 }, GasState { rho: 0.125, u: 0.0, p: 0.1 });
    Tube { left, right, gamma: 1.01, middle: 0.5, end: 0.2 }.judge(effort.pick(400, 4000))
}

fn thin_cells(_: Effort) -> Numbers {
    const N: usize = 50;
    let (left, right) = (GasState { rho: 1.0, u: 0.0, p: 1.0 }, GasState { rho: 0.125, u: 0.0, p: 0.1 });
    let tube = Tube { left, right, gamma: 1.4, middle: 0.5, end: 0.1 };
    let sides = [[Boundary::ZeroGradient; 2], [Boundary::Wall; 2]];
    let mut flow: Flow<f64, 2> = Flow::uniform([N, 3], [0.02, 2e-6], Gas::Ideal { gamma: 1.4 }, sides);
    flow.fill(|[x, _]| if x < tube.middle { left } else { right }.along(0));
    let books = Books::open(&flow);
    run(&mut flow, 0.8, tube.end)?;
    let density: Vec<f64> = (0..N).map(|i| flow.get(N + i).density).collect();
    let across = (0..3 * N).map(|cell| flow.get(cell).velocity[1].abs()).fold(0.0, f64::max);
    Ok(vec![tube.error(&density), books.lost(&flow), flow.total.floored as f64, across])
}
