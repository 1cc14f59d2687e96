//! Problems in a plane: the vortex of Shu, a stream along an inclined wall.

use super::exact::{GAMMA, expanded, mean_of_cell};
use super::problems::{FlowChoice, FlowOutcome, advance, refused};
use crate::command::triangulated::{scene, turned_box};
use crate::error::Result;
use crate::flow::{Flow, Scalar, Treatment};
use crate::grid::Edges;
use crate::porosity::{FieldSet, Options, porosity};
use glam::{DMat3, DVec3};
use voidage_core::flow::{Boundary, Conserved, Gas, Primitive};

/// Side of the square of the vortex, and its strength.
const SIDE: f64 = 10.0;
const STRENGTH: f64 = 5.0;

/// What is conserved in the vortex that begins in the middle of a periodic square and drifts along its diagonal.
fn vortex_state(x: [f64; 2], time: f64) -> [f64; 4] {
    let off = x.map(|x| {
        let s = x - 0.5 * SIDE - time;
        s - SIDE * (s / SIDE).round()
    });
    let e = STRENGTH / std::f64::consts::TAU * (0.5 * (1.0 - off[0] * off[0] - off[1] * off[1])).exp();
    let t = 1.0 - (GAMMA - 1.0) / (2.0 * GAMMA) * e * e;
    let rho = t.powf(1.0 / (GAMMA - 1.0));
    let (u, v) = (1.0 - e * off[1], 1.0 + e * off[0]);
    [rho, rho * u, rho * v, rho * t / (GAMMA - 1.0) + 0.5 * rho * (u * u + v * v)]
}

/// The isentropic vortex of Shu after one crossing of its square.
///
/// # Errors
/// The solver refuses.
pub fn vortex<R: Scalar>(choice: FlowChoice) -> Result<FlowOutcome> {
    let (n, width) = (choice.cells, SIDE / choice.cells as f64);
    let gas = Gas::Ideal { gamma: R::from_f64(GAMMA) };
    let mut flow: Flow<R, 2> = Flow::uniform([n; 2], [R::from_f64(width); 2], gas, [[Boundary::Periodic; 2]; 2]);
    flow.scheme = choice.scheme;
    let centre = |cell: usize| [cell % n, cell / n].map(|i| (i as f64 + 0.5) * width);
    for cell in 0..n * n {
        let [rho, mx, my, energy] = mean_of_cell(|x| vortex_state(x, 0.0), centre(cell), width).map(R::from_f64);
        flow.set(cell, &gas.primitive(&Conserved { density: rho, momentum: [mx, my], energy }));
    }
    let done = advance(&mut flow, SIDE, false)?;
    let exact = |cell: usize| mean_of_cell(|x| [vortex_state(x, SIDE)[0]], centre(cell), width)[0];
    let error = (0..n * n).map(|c| (flow.get(c).density.to_f64() - exact(c)).abs()).sum::<f64>() / (n * n) as f64;
    // The images of the vortex in the neighbouring squares, which the formula leaves out.
    Ok(FlowOutcome { error, uncertainty: (-0.125 * SIDE * SIDE).exp(), ..done })
}

/// Angle of the wall to the x axis, in degrees.
const ANGLE: f64 = 20.0;

/// Open fractions of cells, x and y faces of a square of side 1 above a wall through its middle, by this program's own porosity.
fn above_wall(n: usize) -> Result<[Vec<f64>; 3]> {
    let (sin, cos) = ANGLE.to_radians().sin_cos();
    let [along, normal] = [DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0)];
    // The box reaches four sides of the square along the wall and four below it.
    let center = DVec3::new(0.5, 0.5, 0.5) - normal * 2.0;
    let wall = turned_box(center, DVec3::new(4.0, 2.0, 2.0), DMat3::from_cols(along, normal, DVec3::Z));
    let bodies = scene(&[wall])?;
    let edges = Edges::uniform(DVec3::ZERO, DVec3::ONE, [n, n, 1]);
    let FieldSet { v, x, y, .. } = porosity(&edges.grid(None)?, &bodies, Options::default()).beta;
    Ok([v.to_vec(), x.to_vec(), y.to_vec()])
}

/// A stream of Mach 0.3 along a wall at 20° to the grid, at time 1.
///
/// # Errors
/// The solver refuses.
pub fn inclined_wall<R: Scalar>(choice: FlowChoice) -> Result<FlowOutcome> {
    let n = choice.cells;
    let s = expanded(0.3);
    let (sin, cos) = ANGLE.to_radians().sin_cos();
    let velocity = [s.u * cos, s.u * sin].map(R::from_f64);
    let stream = Primitive { density: R::from_f64(s.rho), velocity, pressure: R::from_f64(s.p) };
    let gas = Gas::Ideal { gamma: R::from_f64(GAMMA) };
    let sides = [[Boundary::FarField(stream); 2]; 2];
    let mut flow: Flow<R, 2> = Flow::uniform([n; 2], [R::from_f64(1.0 / n as f64); 2], gas, sides);
    flow.scheme = choice.scheme;
    let [volume, x, y] = above_wall(n)?;
    let to = |f: &[f64]| f.iter().map(|&b| R::from_f64(b)).collect::<Vec<R>>();
    flow.set_porosity(to(&volume), [to(&x), to(&y)], Treatment::default()).map_err(refused)?;
    flow.fill(|_| stream);
    let done = advance(&mut flow, 1.0, false)?;
    let open: f64 = volume.iter().sum();
    let off = |(cell, open): (usize, &f64)| open * (flow.get(cell).pressure.to_f64() - s.p).abs();
    let error = volume.iter().enumerate().filter(|(_, open)| **open > 0.0).map(off).sum::<f64>() / open;
    Ok(FlowOutcome { error: error / (0.5 * s.rho * s.u * s.u), ..done })
}
