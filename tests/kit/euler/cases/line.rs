//! What the runs along a line share: meshes, porosity, balances, errors.

use super::{Case, Trouble, Verdict};
use crate::euler::expression::evaluate;
use crate::euler::{State, mean};
use voidage::flow::{Flow, Treatment};
use voidage_core::flow::{Boundary, Gas};

/// CFL number of all one-dimensional runs.
pub(super) const CFL: f64 = 0.75;

/// Mean of |rho − reference| over the cells.
pub(super) fn l1<const D: usize>(flow: &Flow<f64, D>, reference: &[f64]) -> f64 {
    let n = reference.len();
    (0..n).map(|i| (flow.get(i).density - reference[i]).abs()).sum::<f64>() / n as f64
}

pub(super) struct Line {
    pub n: usize,
    pub domain: [f64; 2],
}

impl Line {
    pub(super) fn dx(&self) -> f64 {
        (self.domain[1] - self.domain[0]) / self.n as f64
    }

    pub(super) fn flow(&self, gas: Gas<f64>, boundaries: [Boundary<f64, 1>; 2]) -> Flow<f64, 1> {
        Flow::uniform([self.n], [self.dx()], gas, [boundaries])
    }

    pub(super) fn edge(&self, i: usize) -> f64 {
        self.domain[0] + i as f64 * self.dx()
    }

    pub(super) fn centre(&self, i: usize) -> f64 {
        self.domain[0] + (i as f64 + 0.5) * self.dx()
    }

    /// Left of `x0` one state, right the other; a cell across gets the averages of the conserved variables.
    pub(super) fn fill_jump(&self, flow: &mut Flow<f64, 1>, x0: f64, left: State, right: State) {
        let gas = flow.gas();
        for i in 0..self.n {
            let share = ((x0 - self.edge(i)) / self.dx()).clamp(0.0, 1.0);
            let share = if share < 1e-9 {
                0.0
            } else if share > 1.0 - 1e-9 {
                1.0
            } else {
                share
            };
            let w = if share == 1.0 {
                left.primitive()
            } else if share == 0.0 {
                right.primitive()
            } else {
                let (a, b) = (gas.conserved(&left.primitive::<1>()), gas.conserved(&right.primitive::<1>()));
                let mut u = a;
                u.density = share * a.density + (1.0 - share) * b.density;
                u.momentum[0] = share * a.momentum[0] + (1.0 - share) * b.momentum[0];
                u.energy = share * a.energy + (1.0 - share) * b.energy;
                gas.primitive(&u)
            };
            flow.set(i, &w);
        }
    }
}

/// Largest relative gap between what the domain holds and what it held plus what came in.
pub(super) struct Balance<const D: usize> {
    before: voidage_core::flow::Conserved<f64, D>,
}

impl<const D: usize> Balance<D> {
    pub(super) fn start(flow: &Flow<f64, D>) -> Self {
        Balance { before: flow.content() }
    }

    /// Mass, momentum and energy. Momentum is measured against sqrt(mass × energy).
    pub(super) fn gap(&self, flow: &Flow<f64, D>) -> [f64; 3] {
        let after = flow.content();
        let mut entered = [0.0; 3];
        let mut momentum = [0.0; D];
        let mut through = [0.0f64; 3];
        for sides in &flow.total.inflow {
            for s in sides {
                entered[0] += s.density;
                entered[2] += s.energy;
                through[0] += s.density.abs();
                through[2] += s.energy.abs();
                for c in 0..D {
                    momentum[c] += s.momentum[c];
                    through[1] += s.momentum[c].abs();
                }
            }
        }
        let scale = |a: f64, t: f64| a.abs().max(t).max(f64::MIN_POSITIVE);
        let mass = (after.density - self.before.density - entered[0]).abs() / scale(self.before.density, through[0]);
        let energy = (after.energy - self.before.energy - entered[2]).abs() / scale(self.before.energy, through[2]);
        let speed = (self.before.density * self.before.energy.abs()).sqrt();
        let gap = (0..D).map(|c| (after.momentum[c] - self.before.momentum[c] - momentum[c]).abs()).fold(0.0, f64::max);
        [mass, gap / scale(speed, through[1]), energy]
    }
}

pub(super) fn finite_positive<const D: usize>(flow: &Flow<f64, D>) -> bool {
    (0..flow.len()).all(|i| {
        let w = flow.get(i);
        w.density > 0.0 && w.pressure > 0.0 && w.density.is_finite() && w.pressure.is_finite()
    })
}

/// A table on fewer or more cells: means of groups, or interpolation between centres.
pub(super) fn resample(column: &[f64], n: usize) -> Vec<f64> {
    let m = column.len();
    if m.is_multiple_of(n) {
        return column.chunks(m / n).map(|c| c.iter().sum::<f64>() / c.len() as f64).collect();
    }
    (0..n)
        .map(|i| {
            let x = ((i as f64 + 0.5) * m as f64 / n as f64 - 0.5).clamp(0.0, (m - 1) as f64);
            let k = (x as usize).min(m - 2);
            column[k] + (x - k as f64) * (column[k + 1] - column[k])
        })
        .collect()
}

pub(super) fn rate(coarse: f64, fine: f64, factor: f64) -> f64 {
    (coarse / fine).ln() / factor.ln()
}

pub(super) fn report_events<const D: usize>(v: &mut Verdict, flow: &Flow<f64, D>) {
    if flow.total.floored > 0 {
        v.say(format!("floors={}", flow.total.floored));
    }
    if flow.repeated > 0 {
        v.say(format!("repeated={}", flow.repeated));
    }
}

/// Porosity of a line with one jump: cells carry their side's, faces that of their cells, the jump the smaller.
pub(super) fn jump_porosity(line: &Line, x0: f64, left: f64, right: f64) -> (Vec<f64>, [Vec<f64>; 1]) {
    let volume: Vec<f64> = (0..line.n).map(|i| if line.centre(i) < x0 { left } else { right }).collect();
    (volume.clone(), [faces_between(&volume)])
}

/// Faces as open as the narrower of their two cells.
pub(super) fn faces_between(volume: &[f64]) -> Vec<f64> {
    let n = volume.len();
    (0..=n)
        .map(|i| match i {
            0 => volume[0],
            i if i == n => volume[n - 1],
            i => volume[i - 1].min(volume[i]),
        })
        .collect()
}

/// Initial density, velocity, pressure from a text like `rho=1+0.2 sin(5 x), u=0, p=1`.
pub(super) fn formula_state(text: &str, x: f64, more: &[(&str, f64)]) -> Option<State> {
    let mut names = vec![("x", x)];
    names.extend_from_slice(more);
    let mut s = State::new(0.0, 0.0, 0.0);
    for part in text.split(", ") {
        let (name, formula) = part.split_once('=')?;
        let value = evaluate(formula.trim(), &names)?;
        match name.trim() {
            "rho" => s.rho = value,
            "u" => s.u = value,
            "p" => s.p = value,
            _ => return None,
        }
    }
    Some(s)
}

/// Mean of a formula over a cell.
pub(super) fn formula_mean(formula: &str, a: f64, b: f64) -> Result<f64, Trouble> {
    let f = |x: f64| evaluate(formula, &[("x", x)]).unwrap_or(f64::NAN);
    let parts = 16;
    let h = (b - a) / parts as f64;
    let m = (0..parts).map(|k| mean(f, a + k as f64 * h, a + (k + 1) as f64 * h, &[])).sum::<f64>() / parts as f64;
    if m.is_finite() { Ok(m) } else { Err(Trouble::Field(formula.into())) }
}

/// The formula of a porosity, cut at the first remark (`, S(z)=…`).
pub(super) fn beta_formula(case: &Case) -> String {
    let text = case.text("/beta/formula");
    let text = text.trim_start_matches("beta(x)=");
    text.split(", ").next().unwrap_or(text).to_string()
}

/// Smooth porosity from a formula: cell averages, point values on the faces.
pub(super) fn formula_porosity(line: &Line, formula: &str) -> Result<(Vec<f64>, [Vec<f64>; 1]), Trouble> {
    let volume: Result<Vec<f64>, Trouble> =
        (0..line.n).map(|i| formula_mean(formula, line.edge(i), line.edge(i + 1))).collect();
    let faces: Option<Vec<f64>> = (0..=line.n).map(|i| evaluate(formula, &[("x", line.edge(i))])).collect();
    Ok((volume?, [faces.ok_or_else(|| Trouble::Field(formula.into()))?]))
}

/// A duct that narrows smoothly to a point, solved without jumps; nothing to merge, its cells are as wide as their faces.
pub(super) fn smooth_duct() -> Treatment<f64> {
    Treatment { jump: f64::INFINITY, merge: true }
}
