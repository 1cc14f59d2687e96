//! Plane flow: the Gresho vortex and the double Mach reflection.

use super::line::*;
use super::{Case, Outcome, Trouble, Verdict};
use crate::euler::expression::{evaluate, number_after, number_before};
use serde_json::Value;
use voidage::flow::Flow;
use voidage_core::flow::{Boundary, Gas, Limiter, Primitive, Scheme};

pub(super) fn gresho(case: &Case) -> Outcome {
    let mut v = Verdict::default();
    let gamma = case.gamma()?;
    let t = case.number("/t_end")?;
    let (radii, speed, dp) = (case.column("r")?, case.column("u_phi")?, case.column("dp")?);
    let lookup = |column: &[f64], r: f64| {
        let k = radii.partition_point(|x| *x <= r).clamp(1, radii.len() - 1);
        let share = ((r - radii[k - 1]) / (radii[k] - radii[k - 1])).min(1.0);
        column[k - 1] + share * (column[k] - column[k - 1])
    };
    let sides = [case.pair("/domain/0")?, case.pair("/domain/1")?];
    let n = number_before(case.pass(), "x").unwrap_or(40.0) as usize;
    let width = sides.map(|s| (s[1] - s[0]) / n as f64);
    // The measurement to compare with names its limiter.
    let limiter =
        if case.text("/measured/scheme").contains("van Leer") { Limiter::VanLeer } else { Scheme::default().limiter };
    let machs = case.data["mach"].as_array().cloned().unwrap_or_default();
    for mach in machs.iter().filter_map(Value::as_f64) {
        let mut flow = Flow::uniform([n, n], width, Gas::Ideal { gamma }, [[Boundary::Periodic; 2]; 2]);
        flow.scheme.limiter = limiter;
        flow.fill(|x| {
            let (dx, dy) = (x[0] - 0.5 * (sides[0][1] - sides[0][0]), x[1] - 0.5 * (sides[1][1] - sides[1][0]));
            let r = dx.hypot(dy);
            let u = if r > radii[radii.len() - 1] { 0.0 } else { lookup(speed, r) };
            let pressure = 1.0 / (gamma * mach * mach) - 0.5 + lookup(dp, r);
            let (s, c) = if r > 0.0 { (dy / r, dx / r) } else { (0.0, 0.0) };
            Primitive { density: 1.0, velocity: [-u * s, u * c], pressure }
        });
        let kinetic = |f: &Flow<f64, 2>| {
            (0..f.len())
                .map(|c| f.get(c))
                .map(|w| w.density * (w.velocity[0].powi(2) + w.velocity[1].powi(2)))
                .sum::<f64>()
        };
        let before = kinetic(&flow);
        flow.run(0.8, t)?;
        let kept = kinetic(&flow) / before;
        let yardstick = case.data["measured"]["HLLC"].as_object().and_then(|o| {
            o.iter().find(|(k, _)| k.parse::<f64>().is_ok_and(|k| (k / mach - 1.0).abs() < 1e-6))?.1.as_f64()
        });
        v.holds(&format!("finite,positive M{mach}"), finite_positive(&flow));
        // No low-Mach correction is claimed; the plain solver must keep what the measured one keeps.
        match yardstick {
            Some(y) => v.at_least(&format!("KE kept M{mach}"), kept, (0.97 * y * 1e3).floor() / 1e3),
            None => v.note(&format!("KE kept M{mach}"), kept),
        }
    }
    Ok(v)
}

pub(super) fn double_mach(case: &Case) -> Outcome {
    let mut v = Verdict::default();
    let gamma = case.gamma()?;
    let t = case.number("/t_end")?;
    let sides = [case.pair("/domain/0")?, case.pair("/domain/1")?];
    let value = |k: &str| case.number(&format!("/init/{k}"));
    let post = Primitive {
        density: value("post/rho")?,
        velocity: [value("post/u")?, value("post/v")?],
        pressure: value("post/p")?,
    };
    let pre = Primitive {
        density: value("pre/rho")?,
        velocity: [value("pre/u")?, value("pre/v")?],
        pressure: value("pre/p")?,
    };
    let sentence = case.text("/init/shock");
    let mach = number_after(sentence, "Mach").ok_or_else(|| Trouble::Field("/init/shock".into()))?;
    let angle = sentence
        .split(", ")
        .find_map(|s| s.trim().split(' ').next()?.parse::<f64>().ok().filter(|_| s.contains("degrees")));
    let angle = angle.unwrap_or(60.0).to_radians();
    let foot = sentence.split("x=").nth(1).and_then(|s| evaluate(s.split(' ').next()?, &[])).unwrap_or(1.0 / 6.0);
    let speed = mach * (gamma * pre.pressure / pre.density).sqrt();
    let stem = number_after(case.pass(), "+ 0.02 of").unwrap_or(2.8);
    let inner = 160;
    let dx = (sides[1][1] - sides[1][0]) / inner as f64;
    let nx = ((sides[0][1] - sides[0][0]) / dx).round() as usize;
    // Two rows below the wall and above the top belong to the domain and are set after every step.
    let ny = inner + 4;
    let front = |y: f64, time: f64| foot + (y + speed * time / angle.cos()) / angle.tan();
    let mut flow = Flow::uniform(
        [nx, ny],
        [dx, dx],
        Gas::Ideal { gamma },
        [[Boundary::FarField(post), Boundary::ZeroGradient], [Boundary::ZeroGradient; 2]],
    );
    let x = |i: usize| sides[0][0] + (i as f64 + 0.5) * dx;
    let y = |j: usize| sides[1][0] + (j as f64 - 1.5) * dx;
    // The front is slanted: cell averages by subdivision.
    let gas = flow.gas();
    let smooth = |i: usize, j: usize, time: f64| {
        let m = 8;
        let mut share = 0.0;
        for a in 0..m {
            for b in 0..m {
                let o = |k: usize| ((k as f64 + 0.5) / m as f64 - 0.5) * dx;
                share += f64::from(u8::from(x(i) + o(a) < front(y(j) + o(b), time)));
            }
        }
        share /= (m * m) as f64;
        let (p, q) = (gas.conserved(&post), gas.conserved(&pre));
        let mut u = p;
        u.density = share * p.density + (1.0 - share) * q.density;
        u.energy = share * p.energy + (1.0 - share) * q.energy;
        for c in 0..2 {
            u.momentum[c] = share * p.momentum[c] + (1.0 - share) * q.momentum[c];
        }
        gas.primitive(&u)
    };
    for j in 0..ny {
        for i in 0..nx {
            flow.set(j * nx + i, &smooth(i, j, 0.0));
        }
    }
    let edges = |flow: &mut Flow<f64, 2>| {
        let time = flow.time;
        let rate = flow.rate();
        for i in 0..nx {
            for g in 0..2 {
                let w = if x(i) < foot {
                    post
                } else {
                    let mut w = flow.get((3 - g) * nx + i);
                    w.velocity[1] = -w.velocity[1];
                    w
                };
                flow.set(g * nx + i, &w);
                let j = ny - 1 - g;
                flow.set(j * nx + i, &smooth(i, j, time));
            }
        }
        rate
    };
    edges(&mut flow)?;
    while flow.time < t {
        flow.advance(0.8, t)?;
        edges(&mut flow)?;
    }
    v.holds("finite,positive", finite_positive(&flow));
    report_events(&mut v, &flow);
    let wall = |i: usize| flow.get(2 * nx + i);
    let level = 0.5 * (post.pressure + pre.pressure);
    let i = (0..nx - 1).rev().find(|&i| wall(i).pressure > level).unwrap_or(0);
    let (a, b) = (wall(i).pressure, wall(i + 1).pressure);
    let found = x(i) + dx * (a - level) / (a - b);
    v.note("stem", found);
    v.at_most("stem error", (found - stem).abs(), 2.0 * dx + 0.02);
    // The triple point: the highest place where the front stands ahead of the undisturbed shock.
    let front_at = |j: usize| {
        let i = (0..nx - 1).rev().find(|&i| flow.get(j * nx + i).pressure > level).unwrap_or(0);
        let (a, b) = (flow.get(j * nx + i).pressure, flow.get(j * nx + i + 1).pressure);
        x(i) + dx * (a - level) / (a - b)
    };
    let triple = (2..ny - 2).rev().find(|&j| front_at(j) > front(y(j), t) + 2.0 * dx);
    if let Some(j) = triple {
        // The Mach stem meets the incident shock there.
        let at = (front_at(j), y(j));
        let place = case.pass().split_once("triple point within").map_or("", |(_, rest)| rest);
        let target = [number_after(place, "of (").unwrap_or(2.736), number_after(place, ",").unwrap_or(0.43)];
        let away = (at.0 - target[0]).hypot(at.1 - target[1]);
        v.say(format!("triple=({:.3},{:.3})", at.0, at.1));
        v.at_most("triple error", away, number_after(case.pass(), "triple point within").unwrap_or(0.03));
    } else {
        v.holds("triple point found", false);
    }
    // A kink: the stem leads at the wall by more than two cells.
    let lead = front_at(2) - front_at(2 + inner / 20);
    v.at_most("stem kink/dx", lead / dx, 4.0);
    let most = (2 * nx..(ny - 2) * nx).map(|c| flow.get(c).density).fold(0.0, f64::max);
    let between = case.pass().split_once("rho_max between").map_or("", |(_, rest)| rest);
    v.at_least("rho max", most, number_after(between, "").unwrap_or(18.0));
    v.at_most("rho max", most, number_after(between, "and").unwrap_or(24.0));
    Ok(v)
}
