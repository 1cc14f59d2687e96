//! Riemann problems, plain, isothermal and over porosity jumps, and blast waves against fine-grid references.

use super::line::*;
use super::{Case, Outcome, Trouble, Verdict};
use crate::euler::expression::number_after;
use crate::euler::{IsothermalRiemann, PorousRiemann, Riemann, State, average_density};
use serde_json::Value;
use std::collections::BTreeMap;
use voidage::flow::{Flow, Treatment};
use voidage_core::flow::Gas;

/// Exact solution of a case's Riemann problem as density averages on `n` cells.
fn shock_tube(case: &Case, n: usize) -> Result<(Flow<f64, 1>, Balance<1>, Vec<f64>), Trouble> {
    let gamma = case.gamma()?;
    let (left, right) = (case.state("/init/left")?, case.state("/init/right")?);
    let line = Line { n, domain: case.pair("/domain")? };
    let (x0, t) = (case.number("/x0")?, case.number("/t_end")?);
    let mut flow = line.flow(Gas::Ideal { gamma }, [case.boundary("/bc/0", left)?, case.boundary("/bc/1", right)?]);
    line.fill_jump(&mut flow, x0, left, right);
    let balance = Balance::start(&flow);
    flow.run(CFL, t)?;
    let exact = Riemann::new(left, right, gamma);
    let reference = average_density(|xi| exact.at(xi), &exact.breaks(), line.domain, x0, t, n);
    Ok((flow, balance, reference))
}

pub(super) fn riemann(case: &Case) -> Outcome {
    let mut v = Verdict::default();
    let pass = case.pass();
    let mut error = BTreeMap::new();
    let sizes: &[usize] = &[100, 200, 400, 800];
    for &n in sizes {
        let (flow, balance, reference) = shock_tube(case, n)?;
        error.insert(n, l1(&flow, &reference));
        v.holds(&format!("finite,positive@{n}"), finite_positive(&flow));
        report_events(&mut v, &flow);
        if n == 200 {
            let gap = balance.gap(&flow);
            if pass.contains("balance") {
                let limit = number_after(pass, "boundary fluxes to").unwrap_or(1e-12);
                v.at_most("balance", gap.into_iter().fold(0.0, f64::max), limit);
            }
            if pass.contains("overshoot") {
                let behind = case.state("/init/left")?.rho.max(case.state("/init/right")?.rho);
                let peak = (0..n).map(|i| flow.get(i).density).fold(0.0, f64::max);
                let limit = number_after(pass, "<=").unwrap_or(5.0) / 100.0;
                v.at_most("overshoot", peak / behind - 1.0, limit);
            }
        }
    }
    let yardstick = case.yardstick(200);
    if let Some(y) = yardstick {
        v.note("L1/yardstick", error[&200] / y);
    }
    if pass.contains("yardstick") {
        let factor = number_after(pass, "L1(rho) <=").unwrap_or(1.25);
        v.at_most("L1@200", error[&200], factor * yardstick.ok_or_else(|| Trouble::Field("yardstick".into()))?);
    } else {
        v.note("L1@200", error[&200]);
    }
    if pass.contains("rate between") {
        let limit = number_after(pass, "N=200 and 800 >=").unwrap_or(0.7);
        v.at_least("rate", rate(error[&200], error[&800], 4.0), limit);
        if let (Some(a), Some(b)) = (case.yardstick(200), case.yardstick(800)) {
            v.note("yardstick's own rate", rate(a, b, 4.0));
        }
    }
    if pass.contains("round-off") {
        let limit = number_after(pass, "round-off (<=").unwrap_or(1e-13);
        // Round-off goes with the density, which is about 1 where the limit was set.
        let density = case.state("/init/left")?.rho.max(case.state("/init/right")?.rho);
        v.at_most("L1", error[&200], limit * density.max(1.0));
    }
    if pass.contains("decreasing under refinement") {
        let falling = sizes.windows(2).all(|w| error[&w[1]] < error[&w[0]]);
        v.holds("L1 falls", falling);
    }
    if pass.contains("shock position") {
        let gamma = case.gamma()?;
        let exact = Riemann::new(case.state("/init/left")?, case.state("/init/right")?, gamma);
        let (x0, t) = (case.number("/x0")?, case.number("/t_end")?);
        let shock = x0 + t * exact.right_shock().ok_or_else(|| Trouble::Field("no right shock".into()))?;
        let half = 0.5 * exact.at(exact.right_shock().unwrap_or(0.0) * (1.0 - 1e-9)).u;
        let list = &pass[pass.find("N=").map_or(0, |i| i + 2)..];
        let sizes: Vec<usize> = list.split([',', ':', ';', ' ']).map_while(|w| w.parse().ok()).collect();
        let mut last = f64::INFINITY;
        for n in sizes {
            let (flow, ..) = shock_tube(case, n)?;
            let line = Line { n, domain: case.pair("/domain")? };
            let i = (0..n - 1).rev().find(|&i| flow.get(i).velocity[0] > half).unwrap_or(0);
            let (a, b) = (flow.get(i).velocity[0], flow.get(i + 1).velocity[0]);
            let error = (line.centre(i) + line.dx() * (a - half) / (a - b) - shock).abs();
            v.note(&format!("shock@{n}"), error);
            v.holds(&format!("shock error falls@{n}"), error < last);
            v.holds(&format!("finite,positive@{n}"), finite_positive(&flow));
            last = error;
        }
    }
    Ok(v)
}

pub(super) fn riemann_barotropic(case: &Case) -> Outcome {
    let mut v = Verdict::default();
    let c = case.number("/sound_speed")?;
    let (left, right) = (case.state("/init/left")?, case.state("/init/right")?);
    let (x0, t, domain) = (case.number("/x0")?, case.number("/t_end")?, case.pair("/domain")?);
    let exact = IsothermalRiemann::new(left, right, c);
    let mut error = BTreeMap::new();
    for n in [200, 800] {
        let line = Line { n, domain };
        let mut flow = line
            .flow(Gas::Isothermal { sound_speed: c }, [case.boundary("/bc/0", left)?, case.boundary("/bc/1", right)?]);
        line.fill_jump(&mut flow, x0, left, right);
        let balance = Balance::start(&flow);
        flow.run(CFL, t)?;
        let reference = average_density(|xi| exact.at(xi), &exact.breaks(), domain, x0, t, n);
        error.insert(n, l1(&flow, &reference));
        v.holds(&format!("finite,positive@{n}"), finite_positive(&flow));
        report_events(&mut v, &flow);
        if n == 200 {
            let gap = balance.gap(&flow);
            v.at_most("mass balance", gap[0], 1e-12);
        }
    }
    v.note("L1@200", error[&200]);
    if let Some(y) = case.yardstick(200) {
        v.at_most("L1/yardstick", error[&200] / y, 1.25);
    }
    v.at_least("rate", rate(error[&200], error[&800], 4.0), 0.7);
    Ok(v)
}

pub(super) fn porous_riemann(case: &Case) -> Outcome {
    let mut v = Verdict::default();
    let gamma = case.gamma()?;
    let (left, right) = (case.state("/init/left")?, case.state("/init/right")?);
    let (x0, t, domain) = (case.number("/x0")?, case.number("/t_end")?, case.pair("/domain")?);
    let (bl, br) = (case.number("/beta/left")?, case.number("/beta/right")?);
    let exact = PorousRiemann::new(
        left,
        right,
        case.state("/exact/state_left_of_jump")?,
        case.state("/exact/state_right_of_jump")?,
        gamma,
    );
    let mut error = BTreeMap::new();
    for n in [100, 200, 400, 800] {
        let line = Line { n, domain };
        let mut flow = line.flow(Gas::Ideal { gamma }, [case.boundary("/bc/0", left)?, case.boundary("/bc/1", right)?]);
        let (volume, faces) = jump_porosity(&line, x0, bl, br);
        flow.set_porosity(volume, faces, Treatment::default())?;
        line.fill_jump(&mut flow, x0, left, right);
        let balance = Balance::start(&flow);
        flow.run(CFL, t)?;
        let reference = average_density(|xi| exact.at(xi), &exact.breaks(), domain, x0, t, n);
        error.insert(n, l1(&flow, &reference));
        v.holds(&format!("finite,positive@{n}"), finite_positive(&flow));
        report_events(&mut v, &flow);
        if n == 200 {
            v.at_most(
                "mass balance",
                balance.gap(&flow)[0],
                number_after(case.pass(), "boundary fluxes").unwrap_or(1e-12),
            );
        }
    }
    let factor = number_after(case.pass(), "L1(rho) <=").unwrap_or(1.5);
    let yardstick = case.yardstick(200).ok_or_else(|| Trouble::Field("yardstick".into()))?;
    v.note("L1/yardstick", error[&200] / yardstick);
    v.at_most("L1@200", error[&200], factor * yardstick);
    let limit = number_after(case.pass(), "error(N=100) <=").unwrap_or(0.25);
    v.at_most("E800/E100", error[&800] / error[&100], limit);
    Ok(v)
}

pub(super) fn fine_grid(case: &Case) -> Outcome {
    let mut v = Verdict::default();
    let gamma = case.gamma()?;
    let (domain, t) = (case.pair("/domain")?, case.number("/t_end")?);
    let init = &case.data["init"];
    let at = |x: f64| -> Result<State, Trouble> {
        if let Some(regions) = init["p_by_region"].as_array() {
            let edges = init["interfaces"].as_array().ok_or_else(|| Trouble::Field("/init/interfaces".into()))?;
            let k = edges.iter().filter(|e| e.as_f64().is_some_and(|e| x > e)).count();
            let p = regions.get(k).and_then(Value::as_f64).ok_or_else(|| Trouble::Field("/init/p_by_region".into()))?;
            return Ok(State::new(case.number("/init/rho")?, case.number("/init/u")?, p));
        }
        let side = if x < case.number("/x0")? { "/init/left" } else { "/init/right" };
        match case.data.pointer(side) {
            Some(Value::String(text)) => formula_state(text, x, &[]).ok_or_else(|| Trouble::Field(text.clone())),
            _ => case.state(side),
        }
    };
    let reference = case.column("rho_avg")?;
    for n in [200, 400, 800] {
        let line = Line { n, domain };
        let ends = [at(line.centre(0))?, at(line.centre(n - 1))?];
        let mut flow =
            line.flow(Gas::Ideal { gamma }, [case.boundary("/bc/0", ends[0])?, case.boundary("/bc/1", ends[1])?]);
        for i in 0..n {
            // Averages of the conserved variables; the states differ in density alone or jump at an edge.
            let mut w = at(line.centre(i))?;
            let points: Result<Vec<State>, Trouble> =
                (0..8).map(|k| at(line.edge(i) + (k as f64 + 0.5) / 8.0 * line.dx())).collect();
            w.rho = points?.iter().map(|s| s.rho).sum::<f64>() / 8.0;
            flow.set(i, &w.primitive());
        }
        let balance = Balance::start(&flow);
        flow.run(CFL, t)?;
        let error = l1(&flow, &resample(reference, n));
        v.note(&format!("L1@{n}"), error);
        if let Some(y) = case.yardstick(n) {
            v.note("of yardstick", error / y);
        }
        v.holds(&format!("finite,positive@{n}"), finite_positive(&flow));
        report_events(&mut v, &flow);
        let gap = balance.gap(&flow);
        if case.pass().contains("conserved") {
            v.at_most("mass,energy", gap[0].max(gap[2]), number_after(case.pass(), "conserved to").unwrap_or(1e-12));
        }
    }
    Ok(v)
}
