//! The blast of a free ball of gas, in an eighth of a cube, beside the equations along a radius.

use voidage::flow::Flow;
use voidage_core::flow::{Boundary, Gas, Limiter, Primitive};
use voidage_tests::euler::spherical::blast_peaks;

/// Pressure in the ball; around it 1.
const INSIDE: f64 = 10.0;

/// Radii of the middles of the cells on a ray nearest to some radii, and the largest overpressure there until the time `end`, with so many cells per radius of
/// the ball: along an axis and along the diagonal.
fn peaks(per_radius: usize, limiter: Limiter, end: f64, near: &[f64]) -> [Vec<(f64, f64)>; 2] {
    let width = 1.0 / per_radius as f64;
    let n = per_radius * 7 / 4;
    let mut flow: Flow<f64, 3> =
        Flow::uniform([n; 3], [width; 3], Gas::Ideal { gamma: 1.4 }, [[Boundary::Wall, Boundary::ZeroGradient]; 3]);
    flow.scheme.limiter = limiter;
    // The share of the ball in a cell, from 6³ points.
    let points = 6;
    let inside = |x: [f64; 3]| {
        let at = |k: usize| width * ((k as f64 + 0.5) / points as f64 - 0.5);
        let all = (0..points * points * points).map(|k| [k % points, k / points % points, k / (points * points)]);
        let held = all.filter(|k| (0..3).map(|d| (x[d] + at(k[d])).powi(2)).sum::<f64>() < 1.0).count();
        held as f64 / (points * points * points) as f64
    };
    flow.fill(|x| Primitive { density: 1.0, velocity: [0.0; 3], pressure: 1.0 + (INSIDE - 1.0) * inside(x) });
    flow.careful_steps = 5;
    let rays = [[1.0, 0.0, 0.0], [1.0 / 3f64.sqrt(); 3]];
    let mut found = rays.map(|ray| {
        let cell = |r: &f64| ray.map(|x| (r * x * per_radius as f64) as usize);
        let middle = |at: [usize; 3]| at.iter().map(|&i| (width * (i as f64 + 0.5)).powi(2)).sum::<f64>().sqrt();
        near.iter().map(cell).map(|at| (at[0] + n * (at[1] + n * at[2]), middle(at), 0.0)).collect::<Vec<_>>()
    });
    while flow.time < end {
        flow.advance(0.8, end).unwrap();
        for (cell, _, peak) in found.iter_mut().flatten() {
            *peak = flow.get(*cell).pressure.max(*peak + 1.0) - 1.0;
        }
    }
    found.map(|ray| ray.into_iter().map(|(_, r, peak)| (r, peak)).collect())
}

#[test]
fn a_free_ball_blasts_alike_along_every_ray() {
    let (end, near) = (0.4, [1.2, 1.4]);
    let loss = |per_radius: usize, limiter: Limiter| {
        peaks(per_radius, limiter, end, &near).map(|ray| {
            let radii: Vec<f64> = ray.iter().map(|p| p.0).collect();
            let exact = blast_peaks(INSIDE, (1000, 2.0), end, &radii);
            let losses: Vec<f64> = ray.iter().zip(&exact).map(|(p, exact)| 1.0 - p.1 / exact).collect();
            println!("{per_radius} cells per radius, at {radii:.3?}: {exact:.3?}, less {losses:.3?}");
            losses
        })
    };
    let mean = |losses: &[Vec<f64>; 2]| losses.iter().flatten().sum::<f64>() / losses.iter().flatten().count() as f64;
    let (coarse, fine) = (loss(8, Limiter::Steep), loss(16, Limiter::Steep));
    assert!(fine.iter().flatten().all(|loss| (0.0..0.15).contains(loss)), "{fine:?} of the peaks lost");
    assert!(mean(&fine) < 0.75 * mean(&coarse), "{coarse:?} of the peaks lost, with half the width {fine:?}");
    let third = loss(16, Limiter::AroraRoe);
    assert!(third.iter().flatten().all(|loss| (-0.01..0.11).contains(loss)), "{third:?} of the peaks lost");
    assert!(mean(&third) < 0.7 * mean(&fine), "{third:?} of the peaks lost by waves of third order, else {fine:?}");
}
