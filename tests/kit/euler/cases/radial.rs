//! Implosions and explosions, as ducts that widen with the radius and on square cells.

use super::line::*;
use super::{Case, Outcome, Trouble, Verdict};
use crate::euler::State;
use crate::euler::expression::number_after;
use voidage::flow::Flow;
use voidage_core::flow::{Boundary, Gas, Limiter, Primitive, Riemann, Scheme};

/// Exponent of the radius in the porous variant of a radial case: dimensions less one.
fn radial_exponent(case: &Case) -> Result<i32, Trouble> {
    number_after(case.text("/porous_variant"), "r^")
        .map(|e| e as i32)
        .ok_or_else(|| Trouble::Field("/porous_variant".into()))
}

/// Porosity r^e over [0, R], divided by R^e.
fn radial_porosity(line: &Line, e: i32) -> (Vec<f64>, [Vec<f64>; 1]) {
    let r = line.domain[1];
    let volume = (0..line.n)
        .map(|i| (line.edge(i + 1).powi(e + 1) - line.edge(i).powi(e + 1)) / ((e + 1) as f64 * line.dx() * r.powi(e)))
        .collect();
    let faces = (0..=line.n).map(|i| (line.edge(i) / r).powi(e)).collect();
    (volume, [faces])
}

pub(super) fn noh(case: &Case) -> Outcome {
    let mut v = Verdict::default();
    let gamma = case.gamma()?;
    let e = radial_exponent(case)?;
    let t = case.number("/t_end")?;
    let (rho0, u0) = (case.number("/init/rho")?, case.number("/init/u_r")?.abs());
    let p0 = case.number("/init/p")?.max(case.number("/init/p_floor_allowed")?);
    let (shock, plateau) = (case.number("/exact/shock_radius")?, case.number("/exact/rho_post")?);
    let radius = 5.0 * shock;
    let n = 200;
    let line = Line { n, domain: [0.0, radius] };
    let outside = |r: f64, time: f64| rho0 * (1.0 + u0 * time / r).powi(e);
    let ghost = |time: f64| Boundary::FarField(State::new(outside(radius, time), -u0, p0).primitive());
    let mut flow = line.flow(Gas::Ideal { gamma }, [Boundary::Wall, ghost(0.0)]);
    let (volume, faces) = radial_porosity(&line, e);
    flow.set_porosity(volume, faces, smooth_duct())?;
    flow.scheme = strong_shock_scheme(u0 / (gamma * p0 / rho0).sqrt());
    flow.fill(|_| State::new(rho0, -u0, p0).primitive());
    while flow.time < t {
        flow.boundaries[0][1] = ghost(flow.time);
        flow.advance(CFL, t)?;
    }
    v.holds("finite,positive", finite_positive(&flow));
    report_events(&mut v, &flow);
    let half = 0.5 * (plateau + outside(shock, t));
    let i = (1..n).rev().find(|&i| flow.get(i - 1).density > half).unwrap_or(0);
    let (a, b) = (flow.get(i - 1).density, flow.get(i).density);
    let found = line.centre(i - 1) + line.dx() * (a - half) / (a - b);
    v.at_most(
        "radial shock/dx",
        (found - shock).abs() / line.dx(),
        number_after(case.pass(), "shock radius within").unwrap_or(2.0),
    );
    let inner = (shock / line.dx()) as usize;
    let worst = (5..inner.saturating_sub(5)).map(|i| (flow.get(i).density / plateau - 1.0).abs()).fold(0.0, f64::max);
    v.at_most("plateau", worst, number_after(case.pass(), "rho plateau within").unwrap_or(5.0) / 100.0);

    v.note("at origin", flow.get(0).density / plateau);
    match e {
        1 => noh_cartesian::<2>(case, 200, &mut v)?,
        2 => noh_cartesian::<3>(case, 64, &mut v)?,
        _ => {}
    }
    Ok(v)
}

/// The scheme for a shock of a Mach number. Where the gas ahead has all but no pressure, the two-wave solver with a mild limiter
/// heats the place where the shock starts least, and keeps it round where it runs along the lines of the mesh (the three-wave
/// solver lets it run ahead there: the carbuncle).
fn strong_shock_scheme(mach: f64) -> Scheme {
    const COLD: f64 = 100.0;
    let default = Scheme::default();
    if mach > COLD { Scheme { riemann: Riemann::Hlle, limiter: Limiter::VanLeer, ..default } } else { default }
}

/// The same implosion on square cells of one quadrant or octant, wide enough that the outer boundary stays away.
fn noh_cartesian<const D: usize>(case: &Case, n: usize, v: &mut Verdict) -> Result<(), Trouble> {
    let gamma = case.gamma()?;
    let t = case.number("/t_end")?;
    let (rho0, u0) = (case.number("/init/rho")?, case.number("/init/u_r")?.abs());
    let p0 = case.number("/init/p")?.max(case.number("/init/p_floor_allowed")?);
    let (shock, plateau) = (case.number("/exact/shock_radius")?, case.number("/exact/rho_post")?);
    // Gas from outside arrives too early at the outer faces only within u0 t of them.
    let size = 1.15 * (shock + u0 * t);
    let dx = size / n as f64;
    let mut flow = Flow::uniform([n; D], [dx; D], Gas::Ideal { gamma }, [[Boundary::Wall, Boundary::ZeroGradient]; D]);
    flow.scheme = strong_shock_scheme(u0 / (gamma * p0 / rho0).sqrt());
    flow.fill(|x| {
        let r = x.iter().map(|x| x * x).sum::<f64>().sqrt();
        Primitive { density: rho0, velocity: x.map(|x| -u0 * x / r), pressure: p0 }
    });
    flow.run(0.4, t)?;
    v.holds(&format!("{D}D finite,positive"), finite_positive(&flow));
    report_events(v, &flow);
    let (axis, diagonal) = radii(&flow, n, dx, |w, r| {
        w.density - 0.5 * (plateau + rho0 * (1.0 + u0 * t / r.max(shock)).powi(D as i32 - 1))
    });
    v.at_most(&format!("{D}D axis/dx"), (axis - shock).abs() / dx, 2.0);
    v.at_most(&format!("{D}D diagonal/dx"), (diagonal - shock).abs() / dx, 2.0);
    Ok(())
}

/// Where a measure of the state falls through zero, coming from outside, along an axis and along the main diagonal.
fn radii<const D: usize>(
    flow: &Flow<f64, D>,
    n: usize,
    dx: f64,
    measure: impl Fn(Primitive<f64, D>, f64) -> f64,
) -> (f64, f64) {
    let stride: usize = (0..D).map(|d| n.pow(d as u32)).sum();
    let along = |step: usize, spacing: f64, offset: f64| {
        let value = |i: usize| measure(flow.get(i * step), offset + i as f64 * spacing);
        let i = (1..n).rev().find(|&i| value(i - 1) > 0.0).unwrap_or(1);
        let (a, b) = (value(i - 1), value(i));
        offset + (i as f64 - 1.0 + a / (a - b)) * spacing
    };
    let root = (D as f64).sqrt();
    (along(1, dx, 0.5 * dx), along(stride, dx * root, 0.5 * dx * root))
}

pub(super) fn sedov(case: &Case) -> Outcome {
    let mut v = Verdict::default();
    let gamma = case.gamma()?;
    let e = radial_exponent(case)?;
    let t = case.number("/t_end")?;
    let rho0 = case.number("/rho0")?;
    let (shock, peak) = (case.number("/exact/shock_radius")?, case.number("/exact/rho_post")?);
    let p0 = 1e-6 * case.number("/exact/p_post")?;
    let share = number_after(case.text("/porous_variant"), "deposit E*")
        .ok_or_else(|| Trouble::Field("/porous_variant".into()))?;
    let energy = case.number("/E_total")? * share;
    let n = 120;
    let line = Line { n, domain: [0.0, 1.2 * shock] };
    let mut flow = line.flow(Gas::Ideal { gamma }, [Boundary::Wall, Boundary::Wall]);
    let (volume, faces) = radial_porosity(&line, e);
    flow.set_porosity(volume, faces, smooth_duct())?;
    flow.fill(|_| State::new(rho0, 0.0, p0).primitive());
    // The duct's areas were divided by R^e, so its volumes and its energy too.
    let per_volume = energy / line.domain[1].powi(e) / flow.open_volume(0);
    flow.set(0, &State::new(rho0, 0.0, (gamma - 1.0) * per_volume).primitive());
    let balance = Balance::start(&flow);
    flow.run(0.4, t)?;
    let gap = balance.gap(&flow);
    v.at_most("energy", gap[2], number_after(case.pass(), "conserved to").unwrap_or(1e-12));
    v.holds("finite,positive", finite_positive(&flow));
    report_events(&mut v, &flow);
    let top = (0..n).max_by(|&a, &b| flow.get(a).density.total_cmp(&flow.get(b).density)).unwrap_or(0);
    let highest = flow.get(top).density;
    let level = 0.5 * (highest + rho0);
    let i = (top + 1..n).find(|&i| flow.get(i).density < level).unwrap_or(n - 1);
    let (a, b) = (flow.get(i - 1).density, flow.get(i).density);
    let found = line.centre(i - 1) + line.dx() * (a - level) / (a - b);
    v.at_most(
        "radial shock/dx",
        (found - shock).abs() / line.dx(),
        number_after(case.pass(), "shock radius within").unwrap_or(1.5),
    );
    v.at_least("peak share", highest / peak, number_after(case.pass(), "peak rho >=").unwrap_or(60.0) / 100.0);
    match e {
        1 => sedov_cartesian::<2>(case, 120, &mut v)?,
        2 => sedov_cartesian::<3>(case, 60, &mut v)?,
        _ => {}
    }
    Ok(v)
}

fn sedov_cartesian<const D: usize>(case: &Case, n: usize, v: &mut Verdict) -> Result<(), Trouble> {
    let gamma = case.gamma()?;
    let t = case.number("/t_end")?;
    let rho0 = case.number("/rho0")?;
    let shock = case.number("/exact/shock_radius")?;
    let p0 = 1e-6 * case.number("/exact/p_post")?;
    let dx = 1.2 * shock / n as f64;
    let mut flow = Flow::uniform([n; D], [dx; D], Gas::Ideal { gamma }, [[Boundary::Wall; 2]; D]);
    // A ball of a few cells, by the shares of the cells inside it; one cell alone would print its shape.
    let ball = 3.5 * dx;
    let part = |x: [f64; D]| {
        let m = 4usize;
        let inside = (0..m.pow(D as u32))
            .filter(|&k| {
                let mut k = k;
                let r_sq: f64 = x
                    .iter()
                    .map(|x| {
                        let o = ((k % m) as f64 + 0.5) / m as f64 - 0.5;
                        k /= m;
                        (x + o * dx).powi(2)
                    })
                    .sum();
                r_sq < ball * ball
            })
            .count();
        inside as f64 / m.pow(D as u32) as f64
    };
    flow.fill(|x| Primitive { density: rho0, velocity: [0.0; D], pressure: part(x) });
    let parts: Vec<f64> = (0..flow.len()).map(|c| flow.get(c).pressure).collect();
    let total: f64 = parts.iter().sum::<f64>() * dx.powi(D as i32);
    let energy = case.number("/E_total")? / 2f64.powi(D as i32);
    for (c, part) in parts.iter().enumerate() {
        flow.set(
            c,
            &Primitive { density: rho0, velocity: [0.0; D], pressure: p0 + (gamma - 1.0) * energy * part / total },
        );
    }
    flow.scheme = strong_shock_scheme(case.number("/exact/shock_speed")? / (gamma * p0 / rho0).sqrt());
    let balance = Balance::start(&flow);
    flow.run(0.4, t)?;
    v.at_most(&format!("{D}D energy"), balance.gap(&flow)[2], 1e-12);
    v.holds(&format!("{D}D finite,positive"), finite_positive(&flow));
    report_events(v, &flow);
    let level = 0.5 * (0.6 * case.number("/exact/rho_post")? + rho0);
    let (axis, diagonal) = radii(&flow, n, dx, |w, _| w.density - level);
    v.at_most(&format!("{D}D axis/dx"), (axis - shock).abs() / dx, 1.5);
    v.at_most(
        &format!("{D}D spread/dx"),
        (axis - diagonal).abs() / dx,
        number_after(case.pass(), "diagonal <=").unwrap_or(1.0),
    );
    Ok(())
}
