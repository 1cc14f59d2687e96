//! Problems along a line: Sod, Shu and Osher, a porous slab, a nozzle.

use super::exact::{GAMMA, expanded, mean, subsonic};
use super::problems::{FlowChoice, FlowOutcome, advance, refused};
use crate::command::riemann::{ExactRiemann, GasState};
use crate::error::Result;
use crate::flow::{Flow, Scalar, Treatment};
use voidage_core::flow::{Boundary, Conserved, Gas, Scheme};

/// A flow along a line of a length, and the edges of its cells.
fn line<R: Scalar>(choice: FlowChoice, length: f64, sides: [Boundary<R, 1>; 2]) -> (Flow<R, 1>, impl Fn(usize) -> f64) {
    let (n, dx) = (choice.cells, length / choice.cells as f64);
    let gas = Gas::Ideal { gamma: R::from_f64(GAMMA) };
    let mut flow = Flow::uniform([n], [R::from_f64(dx)], gas, [sides]);
    flow.scheme = choice.scheme;
    (flow, move |i: usize| length * (i as f64 / n as f64))
}

/// Sets each cell to the mean of what is conserved.
fn fill<R: Scalar>(
    flow: &mut Flow<R, 1>,
    edge: &impl Fn(usize) -> f64,
    kinks: &[f64],
    state: impl Fn(f64) -> GasState,
) {
    let conserved = |x: f64| {
        let s = state(x);
        [s.rho, s.rho * s.u, s.p / (GAMMA - 1.0) + 0.5 * s.rho * s.u * s.u]
    };
    let gas = flow.gas();
    for cell in 0..flow.len() {
        let [rho, m, e] = mean(conserved, edge(cell), edge(cell + 1), kinks).map(R::from_f64);
        flow.set(cell, &gas.primitive(&Conserved { density: rho, momentum: [m], energy: e }));
    }
}

/// Mean of |found − expected| over the cells.
fn l1<R: Scalar>(
    flow: &Flow<R, 1>,
    of: impl Fn(&voidage_core::flow::Primitive<R, 1>) -> R,
    expected: impl Fn(usize) -> f64,
) -> f64 {
    let off = |cell: usize| (of(&flow.get(cell)).to_f64() - expected(cell)).abs();
    (0..flow.len()).map(off).sum::<f64>() / flow.len() as f64
}

/// Sod's shock tube: 0 to 1, at time 0.2.
///
/// # Errors
/// The solver refuses.
pub fn sod<R: Scalar>(choice: FlowChoice) -> Result<FlowOutcome> {
    let (left, right) = (GasState { rho: 1.0, u: 0.0, p: 1.0 }, GasState { rho: 0.125, u: 0.0, p: 0.1 });
    let (mut flow, edge) = line::<R>(choice, 1.0, [Boundary::ZeroGradient; 2]);
    fill(&mut flow, &edge, &[0.5], |x| if x < 0.5 { left } else { right });
    let (tube, end) = (ExactRiemann::new(left, right, GAMMA), 0.2);
    let done = advance(&mut flow, end, false)?;
    let kinks = tube.kinks().map(|s| 0.5 + s * end);
    let exact = |i: usize| mean(|x| [tube.at((x - 0.5) / end).rho], edge(i), edge(i + 1), &kinks)[0];
    Ok(FlowOutcome { error: l1(&flow, |w| w.density, exact), ..done })
}

/// Cells of the finer reference of Shu and Osher.
const FINE: usize = 12800;

/// Densities of a finer grid, and how far they may be off.
#[derive(Debug, Clone)]
pub struct FineDensity {
    density: Vec<f64>,
    uncertainty: f64,
}

/// Mean of values in equal cells over a part `a..b` of 0 to 1.
fn mean_of_cells(values: &[f64], a: f64, b: f64) -> f64 {
    let n = values.len() as f64;
    let (first, last) = ((a * n).floor() as usize, (b * n).ceil() as usize);
    let share = |(i, v): (usize, &f64)| {
        let (low, high) = ((i as f64 / n).max(a), ((i + 1) as f64 / n).min(b));
        v * (high - low).max(0.0)
    };
    let cells = values.iter().enumerate().take(last).skip(first);
    cells.map(share).sum::<f64>() / (b - a)
}

/// The state of Shu and Osher at their time 1.8, with x from 0 to 10.
fn shu_osher_flow<R: Scalar>(choice: FlowChoice) -> Result<(Flow<R, 1>, FlowOutcome)> {
    let left = GasState { rho: 27.0 / 7.0, u: 4.0 * 35_f64.sqrt() / 9.0, p: 31.0 / 3.0 };
    let state = |x: f64| {
        if x < 1.0 { left } else { GasState { rho: 1.0 + 0.2 * (5.0 * (x - 5.0)).sin(), u: 0.0, p: 1.0 } }
    };
    let sides = [Boundary::FarField(left.along(0)), Boundary::ZeroGradient];
    let (mut flow, edge) = line::<R>(choice, 10.0, sides);
    fill(&mut flow, &edge, &[1.0], state);
    let done = advance(&mut flow, 1.8, false)?;
    Ok((flow, done))
}

/// The finer reference of Shu and Osher; its uncertainty is its distance from the same on half as many cells.
///
/// # Errors
/// The solver refuses.
pub fn fine_density() -> Result<FineDensity> {
    let run = |cells: usize| -> Result<Vec<f64>> {
        let (flow, _) = shu_osher_flow::<f64>(FlowChoice { scheme: Scheme::default(), cells })?;
        Ok((0..cells).map(|i| flow.get(i).density).collect())
    };
    let (density, half) = (run(FINE)?, run(FINE / 2)?);
    let pairs = density.iter().enumerate().map(|(i, d)| (d - half.get(i / 2).copied().unwrap_or(f64::NAN)).abs());
    let uncertainty = pairs.sum::<f64>() / FINE as f64;
    Ok(FineDensity { density, uncertainty })
}

/// Shu and Osher: a shock of Mach 3 runs into waves of density.
///
/// # Errors
/// The solver refuses.
pub fn shu_osher<R: Scalar>(choice: FlowChoice, fine: &FineDensity) -> Result<FlowOutcome> {
    let (flow, done) = shu_osher_flow::<R>(choice)?;
    let n = choice.cells as f64;
    let exact = |i: usize| mean_of_cells(&fine.density, i as f64 / n, (i + 1) as f64 / n);
    Ok(FlowOutcome { error: l1(&flow, |w| w.density, exact), uncertainty: fine.uncertainty, ..done })
}

/// Open area of the slab.
const SLAB: f64 = 0.5;

/// A stream of Mach 0.3 through a slab of porosity 0.5 in the third fifth of the line, begun as if the slab were not there, at time 100.
///
/// # Errors
/// The solver refuses.
pub fn slab<R: Scalar>(choice: FlowChoice) -> Result<FlowOutcome> {
    let up = expanded(0.3);
    let inside = subsonic(up.rho * up.u, SLAB);
    let (mut flow, edge) = line::<R>(choice, 1.0, [Boundary::FarField(up.along(0)); 2]);
    let n = choice.cells;
    let middle = |i: usize| 0.5 * (edge(i) + edge(i + 1));
    let in_slab = |i: usize| (0.4..0.6).contains(&middle(i));
    let open = |i: usize| R::from_f64(if in_slab(i) { SLAB } else { 1.0 });
    let volume: Vec<R> = (0..n).map(open).collect();
    let narrower = |i: usize| {
        let (a, b) = (open(i.max(1) - 1), open(i.min(n - 1)));
        if a < b { a } else { b }
    };
    flow.set_porosity(volume, [(0..=n).map(narrower).collect()], Treatment::default()).map_err(refused)?;
    (0..n).for_each(|cell| flow.set(cell, &up.along(0)));
    let done = advance(&mut flow, 100.0, true)?;
    let exact = |i: usize| if in_slab(i) { inside.p } else { up.p };
    let error = l1(&flow, |w| w.pressure, exact) / (0.5 * up.rho * up.u * up.u);
    Ok(FlowOutcome { error, ..done })
}

/// Open area of the nozzle.
fn nozzle_area(x: f64) -> f64 {
    1.0 - 0.2 * (1.0 - (std::f64::consts::TAU * x).cos())
}

/// Gas from rest at density and pressure 1 through a nozzle whose throat has 0.6 of its area, against a pressure of 0.95; begun with the
/// exact states, at time 60.
///
/// # Errors
/// The solver refuses.
pub fn nozzle<R: Scalar>(choice: FlowChoice) -> Result<FlowOutcome> {
    let mach = (2.0 / (GAMMA - 1.0) * (0.95_f64.powf((1.0 - GAMMA) / GAMMA) - 1.0)).sqrt();
    let exit = expanded(mach);
    let flux = exit.rho * exit.u;
    let sides =
        [Boundary::Reservoir { density: R::ONE, pressure: R::ONE }, Boundary::Outlet { pressure: R::from_f64(exit.p) }];
    let (mut flow, edge) = line::<R>(choice, 1.0, sides);
    let n = choice.cells;
    let volume = (0..n).map(|i| R::from_f64(mean(|x| [nozzle_area(x)], edge(i), edge(i + 1), &[])[0])).collect();
    let faces = (0..=n).map(|i| R::from_f64(nozzle_area(edge(i)))).collect();
    // Solved without jumps, however coarse the grid.
    let smooth = Treatment { jump: R::INFINITY, merge: true };
    flow.set_porosity(volume, [faces], smooth).map_err(refused)?;
    fill(&mut flow, &edge, &[], |x| subsonic(flux, nozzle_area(x)));
    let done = advance(&mut flow, 60.0, true)?;
    let exact = |i: usize| mean(|x| [subsonic(flux, nozzle_area(x)).p], edge(i), edge(i + 1), &[])[0];
    Ok(FlowOutcome { error: l1(&flow, |w| w.pressure, exact), ..done })
}
