//! Drag, shocks on porous slabs, and cells of tiny volume.

use super::line::*;
use super::{Case, Outcome, Trouble, Verdict};
use crate::euler::Riemann;
use crate::euler::expression::number_after;
use std::collections::BTreeMap;
use voidage::flow::{Flow, Treatment};
use voidage_core::flow::{Boundary, Gas, Limiter, Primitive, Scheme};

pub(super) fn drag(case: &Case) -> Outcome {
    let mut v = Verdict::default();
    let gas = Gas::Ideal { gamma: case.gamma()? };
    let (a, u0) = (case.number("/a")?, case.number("/u0")?);
    let (rho, p0) = (case.number("/rho")?, case.number("/p0")?);
    let (ks, ts, us) = (case.column("k")?, case.column("t")?, case.column("u")?);
    let limit = number_after(case.pass(), "relative error <=").unwrap_or(1e-12);
    let (mut error, mut energy, mut heat, mut kept, mut coupling) = (0.0f64, 0.0f64, 0.0f64, true, 0.0f64);
    let mut table = 0.0f64;
    for ((&k, &t), &tabulated) in ks.iter().zip(ts).zip(us) {
        // The formula of the case with expm1: at k u0 t >> 1 and a t << 1 the tabulated 1 − e^(−a t) has lost digits.
        let phi = if a > 0.0 { -(-a * t).exp_m1() / a } else { t };
        let exact = u0 * (-a * t).exp() / (1.0 + k * u0.abs() * phi);
        table = table.max((tabulated / exact - 1.0).abs());
        let n = [4, 3, 2];
        let cells = 24;
        let start = Primitive { density: rho, velocity: [u0, 0.0, 0.0], pressure: p0 };
        let mut flow = Flow::uniform(n, [1.0; 3], gas, [[Boundary::Periodic; 2]; 3]);
        let all = |c: f64| std::array::from_fn(|_| vec![c; cells]);
        flow.set_drag(all(2.0 * k), all(a)).expect("drag");
        for i in 0..cells {
            flow.set(i, &start);
        }
        let before = flow.content().energy;
        flow.step(t)?;
        for i in 0..cells {
            let w = flow.get(i);
            error = error.max((w.velocity[0] / exact - 1.0).abs());

            kept &= w.velocity[0] * u0 >= 0.0 && w.velocity[1] == 0.0 && w.velocity[2] == 0.0;
            let hot = p0 + (case.gamma()? - 1.0) * rho * 0.5 * (u0 * u0 - exact * exact);
            heat = heat.max((w.pressure / hot - 1.0).abs());
        }
        energy = energy.max((flow.content().energy / before - 1.0).abs());
        // Drag along one axis alone: the others keep their velocity; the coupling through |u| vanishes with the step.
        let slanted = Primitive { density: rho, velocity: [u0, 0.5 * u0, -0.25 * u0], pressure: p0 };
        let mut ends = Vec::new();
        let soft = k.min(1.0) / u0.abs().max(1.0);
        let span = 1.0;
        for steps in [20, 40, 80] {
            let mut flow = Flow::uniform(n, [1.0; 3], gas, [[Boundary::Periodic; 2]; 3]);
            flow.set_drag(
                [vec![2.0 * soft; cells], vec![], vec![]],
                [vec![a / u0.abs().max(1.0); cells], vec![], vec![]],
            )
            .expect("drag");
            for i in 0..cells {
                flow.set(i, &slanted);
            }
            for _ in 0..steps {
                flow.step(span / steps as f64)?;
            }
            let w = flow.get(0);
            kept &=
                (w.velocity[1] / (0.5 * u0) - 1.0).abs() < 1e-13 && (w.velocity[2] / (-0.25 * u0) - 1.0).abs() < 1e-13;
            ends.push(w.velocity[0]);
        }
        let (d1, d2) = ((ends[0] - ends[1]).abs(), (ends[1] - ends[2]).abs());
        if d1 > 1e-10 * u0.abs() {
            coupling = coupling.max(d2 / d1);
        }
    }
    v.at_most("error", error, limit);
    v.at_most("energy", energy, number_after(case.pass(), "total energy constant to").unwrap_or(1e-14));
    v.note("table", table);
    v.holds("table agrees to 1e-10", table < 1e-10);
    v.note("pressure", heat);
    v.holds("sign and other components kept", kept);
    v.at_most("coupling d(dt/2)/d(dt)", coupling, 0.6);
    Ok(v)
}

pub(super) fn shock_slab(case: &Case) -> Outcome {
    let mut v = Verdict::default();
    let gamma = case.gamma()?;
    let domain = case.pair("/domain")?;
    let t = case.number("/t_end")?;
    let (left, right) = (case.state("/init/left")?, case.state("/init/right")?);
    let formula = beta_formula(case);
    let inside = case.pair("/drag/where")?;
    let reference = case.column("rho_avg")?;
    let run = |n: usize, cr: f64, limiter: Limiter| -> Result<Flow<f64, 1>, Trouble> {
        let line = Line { n, domain };
        let mut flow = line.flow(Gas::Ideal { gamma }, [case.boundary("/bc/0", left)?, case.boundary("/bc/1", right)?]);
        let (volume, faces) = formula_porosity(&line, &formula)?;
        flow.set_porosity(volume, faces, smooth_duct())?;
        if cr > 0.0 {
            let inside = |i: usize| line.centre(i) > inside[0] && line.centre(i) < inside[1];
            flow.set_drag([(0..n).map(|i| if inside(i) { cr } else { 0.0 }).collect()], [vec![]]).expect("drag");
        }
        flow.scheme.limiter = limiter;
        line.fill_jump(&mut flow, case.number("/shock_x0")?, left, right);
        flow.run(CFL, t)?;
        Ok(flow)
    };
    let cr = case.number("/drag/CR")?;
    let default = Scheme::default().limiter;
    let mut error = BTreeMap::new();
    let mut steps = 0;
    for n in [100, 200, 400] {
        let flow = run(n, cr, default)?;
        error.insert(n, l1(&flow, &resample(reference, n)));
        v.holds(&format!("finite,positive@{n}"), finite_positive(&flow));
        report_events(&mut v, &flow);
        if n == 200 {
            steps = flow.steps;
        }
    }
    v.note("L1@100", error[&100]);
    v.note("L1@200", error[&200]);
    v.note("L1@400", error[&400]);
    // No yardstick number is given. The error of a MUSCL scheme is taken from a run with the plain limiter, and its fall with N
    // must be that of a shock-capturing scheme.
    let plain = l1(&run(200, cr, Limiter::MonotonizedCentral)?, &resample(reference, 200));
    v.at_most("of plain MUSCL", error[&200] / plain, number_after(case.pass(), "N=200 <=").unwrap_or(2.0));
    v.at_least("rate", rate(error[&100], error[&400], 4.0), 0.7);
    let stiff = run(200, 1e12, default)?;
    v.holds("finite,positive with CR=1e12", finite_positive(&stiff));
    v.at_most("steps, CR=1e12 / own", stiff.steps as f64 / steps as f64, 1.25);
    Ok(v)
}

pub(super) fn small_cell(case: &Case) -> Outcome {
    let mut v = Verdict::default();
    let gamma = case.gamma()?;
    let (n, dx, t) = (case.number("/cells")? as usize, case.number("/dx")?, case.number("/t_end")?);
    let (left, right) = (case.state("/init/left")?, case.state("/init/right")?);
    let beta = case.column("beta_v")?.to_vec();
    let line = Line { n, domain: [0.0, n as f64 * dx] };
    let ends = [case.boundary("/bc/0", left)?, case.boundary("/bc/1", right)?];
    let run = |beta: Option<&[f64]>| -> Result<(Flow<f64, 1>, Balance<1>), Trouble> {
        let mut flow = line.flow(Gas::Ideal { gamma }, ends);
        if let Some(beta) = beta {
            flow.set_porosity(beta.to_vec(), [vec![1.0; n + 1]], Treatment::default())?;
        }
        for i in 0..n {
            flow.set(i, &if i < n / 2 { left } else { right }.primitive());
        }
        let balance = Balance::start(&flow);
        flow.run(CFL, t)?;
        Ok((flow, balance))
    };
    let (flow, balance) = run(Some(&beta))?;
    let (plain, _) = run(None)?;
    let exact = Riemann::new(left, right, gamma);
    let (x0, xs) = (case.number("/x0_physical")?, case.column("x_physical")?);
    let error: f64 = (0..n).map(|i| beta[i] * dx * (flow.get(i).density - exact.at((xs[i] - x0) / t).rho).abs()).sum();
    v.holds("finite,positive", finite_positive(&flow));
    report_events(&mut v, &flow);
    let ratio = flow.steps as f64 / plain.steps as f64;
    v.at_most("steps/plain", ratio, number_after(case.pass(), "steps <=").unwrap_or(4.0));
    let yardstick = case.number("/yardstick/L1_rho_weighted")?;
    v.note("L1/yardstick", error / yardstick);
    v.at_most("L1", error, number_after(case.pass(), "weighted L1(rho) <=").unwrap_or(2.0) * yardstick);
    let gap = balance.gap(&flow);
    v.at_most("mass,energy", gap[0].max(gap[2]), number_after(case.pass(), "conserved to").unwrap_or(1e-12));
    Ok(v)
}
