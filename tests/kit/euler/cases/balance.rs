//! Gas that must not move: hydrostatic columns, and rest over random porosity.

use super::line::*;
use super::{Case, Outcome, Trouble, Verdict};
use crate::euler::State;
use crate::euler::expression::number_after;
use voidage::flow::{Flow, Treatment};
use voidage_core::flow::{Boundary, Gas, Primitive};

pub(super) fn hydrostatic(case: &Case) -> Outcome {
    let mut v = Verdict::default();
    let gamma = case.gamma()?;
    let (g, height, rt) = (case.number("/g")?, case.number("/height")?, case.number("/RT0")?);
    let (z, beta) = (case.column("z")?, case.column("beta_v")?);
    let (rho, p) = (case.column("rho")?, case.column("p")?);
    let gas = Gas::Ideal { gamma };
    let sound = (gamma * rt).sqrt();
    let t = 100.0 * height / sound;
    // Isothermal if p/rho is the same at both ends, else isentropic.
    let m = z.len();
    let isothermal = (p[0] / rho[0] / (p[m - 1] / rho[m - 1]) - 1.0).abs() < 1e-6;
    let kappa = (gamma - 1.0) / gamma;
    let at = |zz: f64| -> State {
        if isothermal {
            let p = p[0] * (-g * (zz - z[0]) / rt).exp();
            State::new(p / rt, 0.0, p)
        } else {
            // T falls by g (gamma − 1)/gamma per height; constants from the first row.
            let t0 = p[0] / rho[0];
            let ratio = 1.0 - kappa * g * (zz - z[0]) / t0;
            State::new(rho[0] * ratio.powf(1.0 / (gamma - 1.0)), 0.0, p[0] * ratio.powf(1.0 / kappa))
        }
    };
    let build = |n: usize, treatment: Treatment<f64>| -> Result<Flow<f64, 1>, Trouble> {
        let line = Line { n, domain: [0.0, height] };
        let mut flow = line.flow(gas, [Boundary::Wall; 2]);
        flow.gravity = [-g];
        let volume: Vec<f64> = (0..n).map(|i| beta[i * beta.len() / n]).collect();
        flow.set_porosity(volume.clone(), [faces_between(&volume)], treatment)?;
        Ok(flow)
    };
    let fastest = |flow: &Flow<f64, 1>| {
        (0..flow.len())
            .map(|i| {
                let w = flow.get(i);
                w.velocity[0].abs() / (gamma * w.pressure / w.density).sqrt()
            })
            .fold(0.0, f64::max)
    };
    // Discrete balance.
    let dz = height / m as f64;
    let balanced = |flow: &mut Flow<f64, 1>, bump: f64| {
        let mut pressure = p[0];
        for i in 0..m {
            if i > 0 {
                pressure -= 0.5 * g * dz * (rho[i - 1] + rho[i]);
            }
            let shape = (-((z[i] - 0.5 * height) / (0.05 * height)).powi(2)).exp();
            flow.set(i, &State::new(rho[i], 0.0, pressure * (1.0 + bump * shape)).primitive());
        }
    };
    let mut flow = build(m, Treatment::default())?;
    balanced(&mut flow, 0.0);
    flow.run(CFL, t)?;
    let limit = number_after(case.pass(), "max|u|/c <=").unwrap_or(1e-12);
    v.at_most("balanced u/c", fastest(&flow), limit);
    // Analytic data, in the same porous space: each row of the table is divided. The order shows from two cells a row on; a
    // row of one cell is nothing but its two jumps.
    let mut errors = Vec::new();
    for n in [m, 2 * m, 4 * m] {
        let mut flow = build(n, Treatment::default())?;
        flow.fill(|x| at(x[0]).primitive());
        let (mut early, mut late) = (0.0f64, 0.0f64);
        while flow.time < t {
            flow.advance(CFL, t)?;
            let u = fastest(&flow);
            if flow.time < 0.5 * t { early = early.max(u) } else { late = late.max(u) }
        }
        errors.push(early.max(late));
        v.holds(&format!("no growth@{n}"), late <= 1.05 * early);
    }
    v.note("u/c", errors[0]);
    v.note("rows in two", errors[1]);
    v.note("rows in four", errors[2]);
    // Where the analytic data are in discrete balance to rounding there is nothing left to fall.
    if errors[2] > limit {
        v.at_least("order", rate(errors[1], errors[2], 2.0), number_after(case.pass(), "order >=").unwrap_or(1.8));
    }
    // A small bump travels as a bump ten times larger does.
    let response = |bump: f64| -> Result<Vec<f64>, Trouble> {
        let mut out = Vec::new();
        let mut flow = build(m, Treatment::default())?;
        balanced(&mut flow, bump);
        flow.run(CFL, 0.3 * height / sound)?;
        for i in 0..m {
            out.push(flow.get(i).velocity[0] / (bump * sound));
        }
        Ok(out)
    };
    let (a, b) = (response(1e-6)?, response(1e-5)?);
    let size = a.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let apart = a.iter().zip(&b).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
    v.at_most("bump distortion", apart / size, 1e-2);
    Ok(v)
}

pub(super) fn rest(case: &Case) -> Outcome {
    let mut v = Verdict::default();
    let gas = Gas::Ideal { gamma: case.gamma()? };
    let p = case.number("/p")?;
    let steps = case.number("/steps")? as usize;
    let (i, j, k) = (case.column("i")?, case.column("j")?, case.column("k")?);
    let size = |c: &[f64]| c.iter().fold(0.0f64, |m, &x| m.max(x)) as usize + 1;
    let n = [size(i), size(j), size(k)];
    let cells = n[0] * n[1] * n[2];
    let mut volume = vec![0.0; cells];
    let mut random = vec![1.0; cells];
    let mut faces: [Vec<f64>; 3] =
        [vec![0.0; (n[0] + 1) * n[1] * n[2]], vec![0.0; n[0] * (n[1] + 1) * n[2]], vec![0.0; n[0] * n[1] * (n[2] + 1)]];
    for row in 0..i.len() {
        let (a, b, c) = (i[row] as usize, j[row] as usize, k[row] as usize);
        let cell = (c * n[1] + b) * n[0] + a;
        volume[cell] = case.column("beta_v")?[row];
        random[cell] = case.column("rho")?[row];
        if a + 1 < n[0] {
            faces[0][(c * n[1] + b) * (n[0] + 1) + a + 1] = case.column("beta_x_hi")?[row];
        }
        if b + 1 < n[1] {
            faces[1][(c * (n[1] + 1) + b + 1) * n[0] + a] = case.column("beta_y_hi")?[row];
        }
        if c + 1 < n[2] {
            faces[2][((c + 1) * n[1] + b) * n[0] + a] = case.column("beta_z_hi")?[row];
        }
    }
    for (name, uniform) in [("uniform", true), ("random", false)] {
        let mut flow = Flow::uniform(n, [1.0; 3], gas, [[Boundary::Wall; 2]; 3]);
        flow.set_porosity(volume.clone(), faces.clone(), Treatment::default())?;
        let rho = |c: usize| if uniform { 1.2 } else { random[c] };
        for c in 0..cells {
            flow.set(c, &Primitive { density: rho(c), velocity: [0.0; 3], pressure: p });
        }
        for _ in 0..steps {
            flow.advance(0.8, f64::MAX)?;
        }
        let (mut u, mut dp, mut dr) = (0.0f64, 0.0f64, 0.0f64);
        for c in 0..cells {
            let w = flow.get(c);
            let sound = (case.gamma()? * p / rho(c)).sqrt();
            u = u.max(w.velocity.iter().fold(0.0f64, |m, x| m.max(x.abs())) / sound);
            dp = dp.max((w.pressure / p - 1.0).abs());
            dr = dr.max((w.density / rho(c) - 1.0).abs());
        }
        v.at_most(&format!("{name}: u/c"), u, 1e-12);
        v.at_most("dp/p", dp, 1e-12);
        v.at_most("drho/rho", dr, if uniform { 1e-12 } else { 1e-10 });
    }
    Ok(v)
}
