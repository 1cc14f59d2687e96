//! Smooth flow: advected waves and the isentropic vortex.

use super::line::*;
use super::{Case, Outcome, Trouble, Verdict};
use crate::euler::expression::{evaluate, number_after};
use voidage::flow::Flow;
use voidage_core::flow::{Boundary, Gas, Limiter, Primitive, Scheme};

pub(super) fn order(case: &Case) -> Outcome {
    if case.data.get("mean_velocity").is_some() { vortex(case) } else { advected_wave(case) }
}

/// L1 error of the density of a wave advected along the diagonal of the live axes, and the spread of velocity and pressure.
fn wave_error<const D: usize>(
    case: &Case,
    n: [usize; D],
    along: [bool; D],
    limiter: Limiter,
) -> Result<(f64, f64), Trouble> {
    let domain = case.pair("/domain")?;
    let length = domain[1] - domain[0];
    let t = case.number("/t_end")?;
    let (u, p) = (case.number("/u")?, case.number("/p")?);
    let gas = Gas::Ideal { gamma: case.gamma()? };
    let text = case.text("/formula");
    let formula = text.strip_prefix("rho=").and_then(|f| f.split(", ").next()).unwrap_or(text);
    let live = along.iter().filter(|a| **a).count() as f64;
    // Averages over the cells: along each live axis the wave is a sine in the sum of the coordinates.
    let width: [f64; D] = std::array::from_fn(|d| if along[d] { length / n[d] as f64 } else { length });
    let exact = |x: [f64; D], time: f64| -> f64 {
        let points: &[f64] = &[-0.774_596_669_241_483_4, 0.0, 0.774_596_669_241_483_4];
        let weights = [5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0];
        let mut sum = 0.0;
        let count = 3usize.pow(live as u32);
        for mut k in 0..count {
            let (mut s, mut w) = (0.0, 1.0);
            for d in 0..D {
                if along[d] {
                    s += x[d] + 0.5 * width[d] * points[k % 3];
                    w *= weights[k % 3];
                    k /= 3;
                }
            }
            sum += w * evaluate(formula, &[("x", s), ("u", u), ("t", time)]).unwrap_or(f64::NAN);
        }
        sum
    };
    let mut flow = Flow::uniform(n, width, gas, [[Boundary::Periodic; 2]; D]);
    flow.scheme.limiter = limiter;
    let velocity = std::array::from_fn(|d| if along[d] { u / live } else { 0.0 });
    flow.fill(|x| {
        let shifted = std::array::from_fn(|d| x[d] + domain[0]);
        Primitive { density: exact(shifted, 0.0), velocity, pressure: p }
    });
    flow.run(if D == 1 { CFL } else { 0.8 }, t)?;
    let mut error = 0.0;
    let mut spread = 0.0f64;
    for cell in 0..flow.len() {
        let mut rest = cell;
        let x = std::array::from_fn(|d| {
            let i = rest % n[d];
            rest /= n[d];
            domain[0] + (i as f64 + 0.5) * width[d]
        });
        let w = flow.get(cell);
        error += (w.density - exact(x, t)).abs();
        spread = spread.max((w.pressure / p - 1.0).abs());
        for d in 0..D {
            spread = spread.max((w.velocity[d] - velocity[d]).abs() / u.abs());
        }
    }
    Ok((error / flow.len() as f64, spread))
}

fn advected_wave(case: &Case) -> Outcome {
    let mut v = Verdict::default();
    let pass = case.pass();
    let free = number_after(pass, "order >=").unwrap_or(1.9);
    let limited = number_after(pass, "256 with limiter off; >=").unwrap_or(1.7);
    let uniform = number_after(pass, "stay uniform to").unwrap_or(1e-12);
    let mut spread = 0.0f64;
    let mut one = |along: usize, limiter: Limiter| -> Result<(f64, f64), Trouble> {
        let mut e = Vec::new();
        for m in [128, 256] {
            let mut n = [2; 3];
            n[along] = m;
            let mut live = [false; 3];
            live[along] = true;
            let (error, s) = wave_error(case, n, live, limiter)?;
            spread = spread.max(s);
            e.push(error);
        }
        Ok((rate(e[0], e[1], 2.0), e[1]))
    };
    let x = one(0, Limiter::Unlimited)?;
    v.at_least("order, free", x.0, free);
    for (name, axis) in [("y", 1), ("z", 2)] {
        let other = one(axis, Limiter::Unlimited)?;
        v.holds(&format!("{name} as x to the bit"), other.1.to_bits() == x.1.to_bits());
    }
    for (name, limiter) in
        [("default", Scheme::default().limiter), ("MC", Limiter::MonotonizedCentral), ("van Leer", Limiter::VanLeer)]
    {
        v.at_least(&format!("order, {name}"), one(0, limiter)?.0, limited);
    }
    v.at_most("u, p spread", spread, uniform);
    let mut two = Vec::new();
    for m in [64, 128] {
        two.push(wave_error(case, [m, m], [true; 2], Limiter::Unlimited)?.0);
    }
    v.at_least("order (1,1)", rate(two[0], two[1], 2.0), free);
    let mut three = Vec::new();
    for m in [24, 48] {
        three.push(wave_error(case, [m, m, m], [true; 3], Limiter::Unlimited)?.0);
    }
    v.at_least("order (1,1,1)", rate(three[0], three[1], 2.0), free);
    Ok(v)
}

fn vortex(case: &Case) -> Outcome {
    let mut v = Verdict::default();
    let gamma = case.gamma()?;
    let sides = [case.pair("/domain/0")?, case.pair("/domain/1")?];
    let drift = case.pair("/mean_velocity")?;
    let centre = case.pair("/centre0")?;
    let (t, strength) = (case.number("/t_end")?, case.number("/strength")?);
    let length = sides.map(|s| s[1] - s[0]);
    let at = |x: [f64; 2], time: f64, swapped: bool| -> Primitive<f64, 2> {
        let (dx, dy) = {
            let off = |d: usize| {
                let s = x[d] - centre[d] - drift[d] * time;
                s - length[d] * (s / length[d]).round()
            };
            (off(0), off(1))
        };
        let e = strength / std::f64::consts::TAU * (0.5 * (1.0 - dx * dx - dy * dy)).exp();
        let temperature = 1.0 - (gamma - 1.0) / (2.0 * gamma) * e * e;
        let density = temperature.powf(1.0 / (gamma - 1.0));
        let (u, w) = (drift[0] - e * dy, drift[1] + e * dx);
        // The mirror image about the diagonal turns the other way.
        let velocity = if swapped { [w, u] } else { [u, w] };
        Primitive { density, velocity, pressure: density * temperature }
    };
    let gas = Gas::Ideal { gamma };
    let run = |n: usize, swapped: bool| -> Result<Flow<f64, 2>, Trouble> {
        let width = [length[0] / n as f64, length[1] / n as f64];
        let mut flow = Flow::uniform([n, n], width, gas, [[Boundary::Periodic; 2]; 2]);
        for cell in 0..n * n {
            let (i, j) = (cell % n, cell / n);
            let (i, j) = if swapped { (j, i) } else { (i, j) };
            flow.set(cell, &gas.primitive(&average([i, j], width, 0.0, swapped, &at, gas, sides)));
        }
        flow.run(0.8, t)?;
        Ok(flow)
    };
    let mut errors = Vec::new();
    for n in [64, 128] {
        let flow = run(n, false)?;
        let width = [length[0] / n as f64, length[1] / n as f64];
        let error: f64 = (0..n * n)
            .map(|c| (flow.get(c).density - average([c % n, c / n], width, t, false, &at, gas, sides).density).abs())
            .sum();
        errors.push(error / (n * n) as f64);
        v.note(&format!("L1@{n}"), errors[errors.len() - 1]);
        if n == 64 {
            let other = run(n, true)?;
            let same = (0..n * n).all(|c| {
                let (a, b) = (flow.get(c), other.get((c % n) * n + c / n));
                a.density.to_bits() == b.density.to_bits() && a.velocity[0].to_bits() == b.velocity[1].to_bits()
            });
            v.holds("swapped axes to the bit", same);
        }
    }
    v.at_least("order", rate(errors[0], errors[1], 2.0), number_after(case.pass(), "order >=").unwrap_or(1.8));
    Ok(v)
}

/// Cell average of the conserved variables by 4 × 4 midpoints of Gauss pairs.
fn average(
    [i, j]: [usize; 2],
    width: [f64; 2],
    time: f64,
    swapped: bool,
    at: &impl Fn([f64; 2], f64, bool) -> Primitive<f64, 2>,
    gas: Gas<f64>,
    sides: [[f64; 2]; 2],
) -> voidage_core::flow::Conserved<f64, 2> {
    const X: [f64; 4] =
        [-0.861_136_311_594_052_6, -0.339_981_043_584_856_3, 0.339_981_043_584_856_3, 0.861_136_311_594_052_6];
    const W: [f64; 4] =
        [0.173_927_422_568_726_9, 0.326_072_577_431_273_1, 0.326_072_577_431_273_1, 0.173_927_422_568_726_9];
    let mut sum = voidage_core::flow::Conserved { density: 0.0, momentum: [0.0; 2], energy: 0.0 };
    for a in 0..4 {
        for b in 0..4 {
            let x = [
                sides[0][0] + (i as f64 + 0.5 + 0.5 * X[a]) * width[0],
                sides[1][0] + (j as f64 + 0.5 + 0.5 * X[b]) * width[1],
            ];
            let u = gas.conserved(&at(x, time, swapped));
            let w = W[a] * W[b];
            sum.density += w * u.density;
            sum.momentum[0] += w * u.momentum[0];
            sum.momentum[1] += w * u.momentum[1];
            sum.energy += w * u.energy;
        }
    }
    sum
}
