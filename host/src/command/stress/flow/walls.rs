//! Streams through slabs and along walls that are not aligned with the grid: what is stationary must stay.

use crate::command::stress::case::{Effort, Numbers, StressCase, at_least, at_most};
use crate::command::stress::kit::books::{Books, plane_porosity};
use crate::command::stress::kit::doors::{measure, run, steps};
use crate::command::stress::kit::random::Random;
use crate::command::stress::kit::truth::{half_space, larger, open_fractions};
use crate::command::triangulated::{scene, turned_box};
use crate::flow::{Flow, Treatment};
use crate::grid::Edges;
use crate::porosity::Options;
use glam::DVec3;
use voidage_core::flow::{Boundary, Gas, Primitive};

/// The cases.
pub const CASES: &[StressCase] = &[
    StressCase::new(
        "flow/slabs",
        "streams of Mach 1e-3 to 1e4 through slabs of porosity 0.5 and 0.8: isentropic duct flow stays, 2000 steps",
        &[
            at_most(
                10.0,
                "relative change of mass flux and total enthalpy, in rounding errors times the Mach number squared, or over it",
            ),
            at_most(0.0, "floors"),
            at_least(9.0, "streams"),
        ],
        slabs,
    ),
    StressCase::new(
        "flow/slabs-struck",
        "streams of Mach 0.1 to 1e4 that strike slabs of porosity 0.5 and 0.05",
        &[at_most(1e-12, "mass and energy lost"), at_most(0.0, "floors"), at_least(12.0, "streams")],
        slabs_struck,
    ),
    StressCase::new(
        "flow/walls",
        "streams of Mach 1e-3 to 1e3 along walls at 14 angles: uniform flow stays",
        &[
            at_most(1e-9, "change of pressure over dynamic pressure, or of velocity, times Mach number below 1"),
            at_most(0.0, "floors"),
            at_least(70.0, "streams"),
        ],
        walls,
    ),
    StressCase::new(
        "flow/from-geometry",
        "streams along the side of a box askew, its porosity measured from triangles: uniform flow stays",
        &[at_most(1e-7, "change of pressure over dynamic pressure, or of velocity"), at_least(6.0, "streams")],
        from_geometry,
    ),
];

const GAMMA: f64 = 1.4;
const GAS: Gas<f64> = Gas::Ideal { gamma: GAMMA };

/// Area over that of the throat in which an isentropic stream would be sonic. Reference: J. D. Anderson, *Modern Compressible Flow*,
/// 3rd ed., eq. (5.20).
fn area_ratio(mach: f64) -> f64 {
    (2.0 / (GAMMA + 1.0) * (1.0 + 0.5 * (GAMMA - 1.0) * mach * mach)).powf(0.5 * (GAMMA + 1.0) / (GAMMA - 1.0)) / mach
}

/// The same stream where the duct is `open` times as wide as where its Mach number is `mach`, density 1, pressure 1/gamma.
fn duct_state(mach: f64, open: f64) -> Primitive<f64, 1> {
    let wanted = area_ratio(mach) * open;
    // On the same branch: subsonic ratios fall with the Mach number, supersonic ones rise.
    let (mut low, mut high) = if mach < 1.0 { (mach, 1.0) } else { (1.0, mach) };
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if (area_ratio(middle) > wanted) == (mach < 1.0) { low = middle } else { high = middle }
    }
    let inside = if mach < 1.0 { high } else { low };
    let inside = if open == 1.0 { mach } else { inside };
    let warmth = |m: f64| 1.0 + 0.5 * (GAMMA - 1.0) * m * m;
    let t = warmth(mach) / warmth(inside);
    let density = t.powf(1.0 / (GAMMA - 1.0));
    // From the mass flux, so that it has no rounding of the search.
    Primitive { density, velocity: [mach / (open * density)], pressure: density * t / GAMMA }
}

fn enthalpy(w: &Primitive<f64, 1>) -> f64 {
    0.5 * w.velocity[0] * w.velocity[0] + GAMMA / (GAMMA - 1.0) * w.pressure / w.density
}

fn slab_faces(volume: &[f64]) -> Vec<f64> {
    let n = volume.len();
    (0..=n).map(|i| volume[i.saturating_sub(1)].min(volume[i.min(n - 1)])).collect()
}

fn slabs(effort: Effort) -> Numbers {
    let (mut change, mut floors, mut streams) = (0.0, 0, 0);
    for mach in [1e-3, 1e-2, 0.1, 0.25, 3.0, 10.0, 100.0, 1e3, 1e4] {
        let n = 60;
        let volume: Vec<f64> = (0..n).map(|i| [1.0, 0.5, 1.0, 0.8, 1.0, 1.0][i / 10]).collect();
        let outside = Boundary::FarField(duct_state(mach, 1.0));
        let mut flow: Flow<f64, 1> = Flow::uniform([n], [0.1], GAS, [[outside; 2]]);
        flow.set_porosity(volume.clone(), [slab_faces(&volume)], Treatment::default())?;
        (0..n).for_each(|i| flow.set(i, &duct_state(mach, volume[i])));
        steps(&mut flow, 0.8, effort.pick(2000, 50_000))?;
        let total = enthalpy(&duct_state(mach, 1.0));
        // The pressure is the small difference of energies, the velocity small beside the speed of sound.
        let rounding = f64::EPSILON * (mach * mach).max(1.0 / mach);
        for (i, open) in volume.iter().enumerate() {
            let w = flow.get(i);
            change = larger(change, (open * w.density * w.velocity[0] / mach - 1.0).abs() / rounding);
            change = larger(change, (enthalpy(&w) / total - 1.0).abs() / rounding);
        }
        (floors, streams) = (floors + flow.total.floored, streams + 1);
    }
    Ok(vec![change, floors as f64, f64::from(streams)])
}

fn slabs_struck(effort: Effort) -> Numbers {
    let (mut lost, mut floors, mut streams) = (0.0, 0, 0);
    for open in [0.5, 0.05] {
        for mach in [0.1, 0.9, 3.0, 10.0, 100.0, 1e4] {
            let n = effort.pick(60, 600);
            let stream = duct_state(mach, 1.0);
            let ends = [Boundary::FarField(stream), Boundary::ZeroGradient];
            let mut flow: Flow<f64, 1> = Flow::uniform([n], [1.0 / n as f64], GAS, [ends]);
            let volume: Vec<f64> = (0..n).map(|i| if (n / 3..2 * n / 3).contains(&i) { open } else { 1.0 }).collect();
            let faces = slab_faces(&volume);
            flow.set_porosity(volume, [faces], Treatment::default())?;
            flow.fill(|_| stream);
            let books = Books::open(&flow);
            run(&mut flow, 0.8, 4.0 / mach.max(1.0))?;
            lost = larger(lost, books.lost(&flow));
            (floors, streams) = (floors + flow.total.floored, streams + 1);
        }
    }
    Ok(vec![lost, floors as f64, f64::from(streams)])
}

/// Change of a uniform stream of density and pressure 1: of the pressure over the dynamic pressure, or of the velocity over the speed; in
/// cells of more open volume than `least`.
fn deviation<const D: usize>(flow: &Flow<f64, D>, velocity: [f64; D], open: &[f64], least: f64) -> f64 {
    let speed_sq: f64 = velocity.iter().map(|u| u * u).sum();
    let of_cell = |cell: usize| {
        let w = flow.get(cell);
        let turned = (0..D).map(|d| (w.velocity[d] - velocity[d]).abs() / speed_sq.sqrt()).fold(0.0, larger);
        larger(turned, (w.pressure - 1.0).abs() / (0.5 * speed_sq))
    };
    (0..flow.len()).filter(|&cell| open[cell] > least).map(of_cell).fold(0.0, larger)
}

fn walls(effort: Effort) -> Numbers {
    let (mut most, mut floors, mut streams) = (0.0, 0, 0);
    let edges = Edges::uniform(DVec3::ZERO, DVec3::new(2.4, 2.4, 0.1), [24, 24, 1]);
    for degrees in [0.1, 0.5, 2.0, 5.0, 20.0, 30.0, 45.0, 60.0, 80.0, 85.0, 89.0, 135.0, 200.0, 315.0] {
        let (sin, cos) = f64::to_radians(degrees).sin_cos();
        let normal = DVec3::new(-sin, cos, 0.0);
        let offset = normal.dot(DVec3::new(1.23, 1.17, 0.0));
        let open = open_fractions(&edges, |corners| half_space(normal, offset, corners));
        for mach in [1e-3, 0.03, 0.3, 2.5, 10.0, 1e3] {
            let velocity = [cos, sin].map(|a| mach * GAMMA.sqrt() * a);
            let stream = Primitive { density: 1.0, velocity, pressure: 1.0 };
            let mut flow: Flow<f64, 2> = Flow::uniform([24, 24], [0.1; 2], GAS, [[Boundary::FarField(stream); 2]; 2]);
            plane_porosity(&mut flow, &edges, &open)?;
            flow.fill(|_| stream);
            steps(&mut flow, 0.8, effort.pick(30, 1000))?;
            most = larger(most, deviation(&flow, velocity, &open.v, 0.0) * mach.min(1.0));
            (floors, streams) = (floors + flow.total.floored, streams + 1);
        }
    }
    Ok(vec![most, floors as f64, f64::from(streams)])
}

fn from_geometry(effort: Effort) -> Numbers {
    let (mut most, mut streams) = (0.0, 0);
    let n = [12, 11, 10];
    let edges = Edges(n.map(|n| (0..=n).map(|i| 0.1 * i as f64).collect()));
    for seed in 0..effort.pick(6, 60) {
        let turn = Random::new(40 + seed).turn();
        // Only one side of the box passes through the grid; the stream runs along it.
        let (normal, half) = (turn.x_axis, 20.0);
        let center = DVec3::new(0.61, 0.57, 0.5) - normal * half;
        let bodies = scene(&[turned_box(center, DVec3::splat(half), turn)])?;
        let beta = measure(&edges, &bodies, Options::default())?.beta;
        let velocity = (turn.y_axis * 0.5).to_array();
        let stream = Primitive { density: 1.0, velocity, pressure: 1.0 };
        let mut flow: Flow<f64, 3> = Flow::uniform(n, [0.1; 3], GAS, [[Boundary::FarField(stream); 2]; 3]);
        flow.set_porosity(beta.v.to_vec(), [beta.x.to_vec(), beta.y.to_vec(), beta.z.to_vec()], Treatment::default())?;
        flow.fill(|_| stream);
        steps(&mut flow, 0.8, 30)?;
        // Cells that are closed but for rounding go their own ways.
        most = larger(most, deviation(&flow, velocity, &beta.v, 1e-4));
        streams += 1;
    }
    Ok(vec![most, f64::from(streams)])
}
