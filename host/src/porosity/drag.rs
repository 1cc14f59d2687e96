//! Resistance of obstacles smaller than a cell, from their frontal area, by laws of the PDR method.
//!
//! A law gives the superficial CR_i: the force on a cell is ½ CR_i ρ |U| U_i V, with U the superficial velocity, which is what flows through a face over
//! its whole area. The flow of this crate has the velocity u in the pores, U_i = β̄_i u_i with β̄_i the mean open fraction of the cell's
//! two faces along i, and its resistance acts on the open volume β_v V. The same force is therefore
//!
//! cr_i = CR_i β̄_i² / β_v,
//!
//! which is what [`ObstacleDrag::cr`] holds.

use super::resistance::Resistance;
use super::shadows::{cells, faces_of_cell};
use super::solid::with_solid_layers;
use super::solid_layers::SolidLayers;
use super::windows::Window;
use super::worker::Workers;
use super::{FieldSet, Options, Porosity, porosity};
use crate::geometry::bodies::{Bodies, Body};
use crate::geometry::form::Form;
use crate::geometry::repair::weld::bits;
use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use std::ops::Range;
use voidage_core::grid::Grid;

/// How frontal area becomes resistance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum DragLaw {
    /// CR_i = C_D a_i: bodies that do not disturb each other.
    Bluff,
    /// CR_i = C_D a_i α^p, as PDRsetFields of OpenFOAM v1912: rows of bodies speed the gas up between them.
    Pdr,
}

/// Drag coefficients.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct DragCoefficients {
    /// Of round bodies.
    pub round: f64,
    /// Of bodies with edges.
    pub sharp: f64,
}

impl Default for DragCoefficients {
    /// 1.2 and 2.0, as in PDRsetFields.
    fn default() -> Self {
        DragCoefficients { round: 1.2, sharp: 2.0 }
    }
}

/// Resistance in the cells of a grid, `nx*ny*nz`, x fastest.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ObstacleDrag {
    /// Along x, y and z in 1/m, for the velocity in the pores: cr_i of `solve`.
    pub cr: [Vec<f64>; 3],
    /// Sources of turbulence CT_i = 0.035 CR_i of round and 0.08 CR_i of sharp bodies, superficial, in 1/m.
    pub ct: [Vec<f64>; 3],
    /// Cells and axes where the blockage of a row was limited to 0.95.
    pub capped: usize,
    /// Bodies taken for round, and for sharp.
    pub bodies: [usize; 2],
    /// Cells that bodies of different C_D share in which more than the tolerance of the frontal area is where no proof tells what one hides of another; all of it
    /// counts there.
    pub unproved: usize,
}

/// Largest blockage of a row that enters the law: α is 210 there.
const MOST_BLOCKAGE: f64 = 0.95;

/// Sources of turbulence as shares of CR: of round and of sharp bodies.
const TURBULENCE: [f64; 2] = [0.035, 0.08];

/// The slices were cut for the grid they are used with.
const FITS: &str = "slices of a layer fit its grid";

/// Where bodies have more frontal area than their union by this share, one hides some of another's.
const HIDDEN: f64 = 1e-6;

/// The resistance of the obstacles in `resistance`, whose porosities are `result`.
#[must_use]
pub fn drag(
    grid: &Grid<f64>,
    bodies: &Bodies,
    (result, resistance): (&Porosity, &Resistance),
    options: Options,
    (law, coefficients): (DragLaw, DragCoefficients),
) -> ObstacleDrag {
    let round: Vec<bool> =
        bodies.bodies.par_iter().map(|b| is_round(b, &bodies.triangles[b.triangles.clone()])).collect();
    let weight = |(body, &round): (&Body, &bool)| match body.drag {
        // Its own resistance stands for all of it.
        _ if body.porosity > 0.0 || body.drag.cr.is_some() => [1.0, 0.0, 0.0],
        own if round => [1.0, own.cd.unwrap_or(coefficients.round), 0.0],
        own => [1.0, 0.0, own.cd.unwrap_or(coefficients.sharp)],
    };
    let weights: Vec<[f64; 3]> = bodies.bodies.iter().zip(&round).map(weight).collect();
    let (sums, unproved) = with_solid_layers(grid, bodies, options, |grid, SolidLayers { layers, .. }| {
        let [nx, ny, nz] = grid.cells();
        let mut sums = vec![[[0.0; 3]; 3]; nx * ny * nz];
        let workers = Workers::new();
        let unproved = sums.par_chunks_mut(nx * ny).enumerate().map(|(k, sums)| {
            layers.weighted_frontal_areas(k, &weights, sums).expect(FITS);
            let is_hidden = |(c, [all, ..]): (usize, &[[f64; 3]; 3])| {
                let volume = grid.cell_box([c % nx, c / nx, k]).map_or(0.0, |cell| cell.size().element_product());
                let seen = |axis: usize| resistance.a[axis][k * nx * ny + c] * volume;
                (0..3).any(|axis| all[axis] > seen(axis) * (1.0 + HIDDEN))
            };
            let hidden: Vec<bool> = sums.iter().enumerate().map(is_hidden).collect();
            if !hidden.contains(&true) {
                return 0;
            }
            workers.beside(grid, layers, |memory| {
                layers.visible_frontal_areas(k, (&weights, &hidden), sums, memory).expect(FITS)
            })
        });
        let unproved = unproved.sum();
        (sums, unproved)
    });
    let mut found = ObstacleDrag {
        unproved,
        bodies: [true, false].map(|kind| round.iter().filter(|&&r| r == kind).count()),
        ..ObstacleDrag::default()
    };
    for axis in 0..3 {
        let rows = match law {
            DragLaw::Bluff => None,
            DragLaw::Pdr => Some(Rows::new(grid, axis, &resistance.shadows.tau[axis])),
        };
        found.capped += rows.as_ref().map_or(0, |rows| rows.capped);
        for (n, at) in cells(grid).enumerate() {
            let [all, round, sharp] = sums[n].map(|sum| sum[axis]);
            let area = if all > 0.0 { resistance.a[axis][n] / all } else { 0.0 };
            let [of_round, of_sharp] = rows.as_ref().map_or([1.0; 2], |rows| rows.factors(at));
            let parts = [round * area * of_round, sharp * area * of_sharp];
            found.cr[axis].push((parts[0] + parts[1]) * to_pore_velocity(grid, &result.beta, axis, n, at));
            found.ct[axis].push(parts[0] * TURBULENCE[0] + parts[1] * TURBULENCE[1]);
        }
    }
    let own = own_resistance(grid, bodies, options);
    for axis in &mut found.cr {
        axis.iter_mut().zip(&own).for_each(|(sum, own)| *sum += own);
    }
    found
}

/// β̄² / β_v of a cell: from CR by the superficial velocity to that by the velocity in the pores; 0 where nothing can flow.
fn to_pore_velocity(grid: &Grid<f64>, beta: &FieldSet, axis: usize, cell: usize, at: [usize; 3]) -> f64 {
    let [low, high] = faces_of_cell(grid, axis, at).map(|face| beta.faces(axis)[face]);
    let mean = (low + high) * 0.5;
    if beta.v[cell] > 0.0 { mean * mean / beta.v[cell] } else { 0.0 }
}

/// Blockages of rows across an axis.
struct Rows<'a> {
    cells: [usize; 3],
    axis: usize,
    blockage: &'a [f64],
    capped: usize,
}

impl<'a> Rows<'a> {
    fn new(grid: &Grid<f64>, axis: usize, blockage: &'a [f64]) -> Self {
        // Where nothing passes nothing is resisted.
        let capped = blockage.iter().filter(|&&b| b > MOST_BLOCKAGE && b < 1.0).count();
        Rows { cells: grid.cells(), axis, blockage, capped }
    }

    fn at(&self, [i, j, k]: [usize; 3]) -> f64 {
        self.blockage[(k * self.cells[1] + j) * self.cells[0] + i].min(MOST_BLOCKAGE)
    }

    /// α^p of round and of sharp bodies, with α = (1 − br/2)/(1 − br)², p = ½ + ½ e of round and 1.09 e of sharp ones, and e from 0 to 1 as the
    /// mean blockage of the eight neighbours in the plane across grows from a quarter of br to br: `calc_drag_etc` of PDRsetFields, OpenFOAM v1912. A
    /// neighbour beyond the grid is like the cell beside it.
    fn factors(&self, at: [usize; 3]) -> [f64; 2] {
        let own = self.at(at);
        if !(own > 0.0) {
            return [1.0; 2];
        }
        let (u, v) = ((self.axis + 1) % 3, (self.axis + 2) % 3);
        let step = |n: usize, by: i32, count: usize| n.saturating_add_signed(by as isize).min(count - 1);
        let mut sum = -own;
        for (du, dv) in (-1..=1).flat_map(|du| (-1..=1).map(move |dv| (du, dv))) {
            let mut beside = at;
            beside[u] = step(at[u], du, self.cells[u]);
            beside[v] = step(at[v], dv, self.cells[v]);
            sum += self.at(beside);
        }
        let spread = ((sum / 8.0 / own - 0.25) * 4.0 / 3.0).clamp(0.0, 1.0);
        let alpha = (1.0 - own / 2.0) / (1.0 - own).powi(2);
        [alpha.powf(0.5 + 0.5 * spread), alpha.powf(1.09 * spread)]
    }
}

/// The resistance in 1/m that solids are given as a whole, along all axes, by the share of each cell that they fill and no solid without one does; all 0
/// where none is given one.
#[must_use]
pub fn own_resistance(grid: &Grid<f64>, bodies: &Bodies, options: Options) -> Vec<f64> {
    let resisting = |body: &Body| body.drag.cr.filter(|cr| *cr > 0.0);
    let most = bodies.bodies.iter().filter_map(resisting).fold(0.0, f64::max);
    if most == 0.0 {
        return vec![0.0; grid.cell_count()];
    }
    // Where several lie, the one that resists most counts, as of porous bodies the least open does.
    let resistance = |which: &dyn Fn(usize) -> bool| -> Vec<f64> {
        let mut some = bodies.some(which);
        for body in &mut some.bodies {
            // What is only in the way counts as if nothing resisted more.
            body.porosity = resisting(body).map_or(0.0, |cr| 1.0 - cr / most);
        }
        let filled = porosity(grid, &some, Options { bounds: false, areas: false, resistance: false, ..options });
        filled.beta.v.iter().map(|open| most * (1.0 - open)).collect()
    };
    let resists: Vec<bool> = bodies.bodies.iter().map(|body| resisting(body).is_some()).collect();
    let own = resistance(&|n| resists[n]);
    let places: Vec<_> =
        bodies.bodies.iter().filter(|body| resisting(body).is_some()).map(|body| body.bounds).collect();
    let covers = |(body, resists): (&Body, &bool)| {
        let [lo, hi] = body.bounds;
        let touches = |place: &[DVec3; 2]| lo.cmple(place[1]).all() && place[0].cmple(hi).all();
        !resists && body.porosity == 0.0 && places.iter().any(touches)
    };
    let covers: Vec<bool> = bodies.bodies.iter().zip(&resists).map(covers).collect();
    if !covers.contains(&true) {
        return own;
    }
    // What a solid covers no gas meets.
    let (solid, together) = (resistance(&|n| covers[n]), resistance(&|n| covers[n] || resists[n]));
    let uncovered = together.iter().zip(solid).map(|(all, solid)| (all - solid).max(0.0));
    own.into_iter().zip(uncovered).map(|(own, uncovered)| own.min(uncovered)).collect()
}

/// A cell that is less open than this is full, but for rounding.
const FULL: f64 = 1e-9;

/// Do some of the bodies, a run of them, fill a whole cell together?
#[must_use]
pub fn fill_a_cell(grid: &Grid<f64>, bodies: &Bodies, run: Range<usize>, options: Options) -> bool {
    let own = bodies.some(|body| run.contains(&body));
    let Some(window) = own.bounds().and_then(|bounds| Window::around(grid, bounds)) else { return false };
    let options = Options { bounds: false, areas: false, resistance: false, ..options };
    porosity(&window.grid(grid), &own, options).beta.v.iter().any(|open| *open < FULL)
}

/// Edges that turn by less than this belong to a curved surface.
const CURVED: f64 = 40.0 / 180.0 * std::f64::consts::PI;

/// Is a body with these triangles round? By its shape, if that is known; else if edges that turn by less than 40° make up half of all turning, each by its
/// length and angle.
#[must_use]
pub fn is_round(body: &Body, triangles: &[[DVec3; 3]]) -> bool {
    match &body.form {
        Some(Form::Box(_)) => false,
        Some(Form::Hull(_)) | None => {
            let [curved, all] = turning(triangles);
            curved > 0.5 * all
        }
        Some(_) => true,
    }
}

/// Σ length × angle over the edges of a surface that turn by less than [`CURVED`], and over all.
fn turning(triangles: &[[DVec3; 3]]) -> [f64; 2] {
    let mut normals: FxHashMap<[[u64; 3]; 2], DVec3> = FxHashMap::default();
    let mut sums = [0.0; 2];
    for corners in triangles {
        let [a, b, c] = *corners;
        let normal = (b - a).cross(c - a).normalize_or_zero();
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let key = if bits(from) < bits(to) { [bits(from), bits(to)] } else { [bits(to), bits(from)] };
            let Some(other) = normals.remove(&key) else {
                normals.insert(key, normal);
                continue;
            };
            let turn = other.angle_between(normal);
            if turn.is_finite() {
                sums[0] += if turn < CURVED { from.distance(to) * turn } else { 0.0 };
                sums[1] += from.distance(to) * turn;
            }
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A single pipe of 0.2 m in cells of 0.5 m: 1.4310835 in PDRsetFields.
    #[test]
    fn a_pipe_as_in_pdrsetfields() {
        let edges: Vec<f64> = (0..=3).map(|n| 0.5 * f64::from(n)).collect();
        let grid = Grid::new(&edges, &edges, &edges).expect("a grid");
        let mut blockage = vec![0.0; 27];
        (0..3).for_each(|k| blockage[k * 9 + 4] = 0.4);
        let [round, _] = Rows::new(&grid, 0, &blockage).factors([1, 1, 1]);
        assert!((1.2 * 0.8 * round - 1.431_083_5).abs() < 5e-8, "{round}");
    }
}
