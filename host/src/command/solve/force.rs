//! The force of the gas on all that stands in it.
//!
//! A step tells what acts on the walls of each cell and what its drag takes ([`CellPush`]): what the gas loses in momentum, the solids feel, but for what leans
//! through them on a wall of the domain ([`FreeSides`]). Pressures are counted from that of the surroundings, so that what leans on a wall of the domain feels the
//! difference alone. Under gravity solids lose the weight of the gas that they displace. Walls of the domain do not count.

use crate::flow::{CellPush, Flow};
use crate::porosity::throat::LoweredSide;
use rayon::prelude::*;
use std::collections::BTreeMap;
use voidage_core::flow::PressureForm;

/// Cells are summed in portions of this many, so that the bits of the sum do not depend on the number of threads.
const PORTION: usize = 4096;

/// The cells that gas can enter and in which there is something to push; a flow keeps its space, so they are found once. A cell of no volume behind open
/// faces counts: gas passes it.
#[must_use]
pub fn pushed_cells<const D: usize>(flow: &Flow<f64, D>) -> Vec<usize> {
    let faces: Vec<&[f64]> = flow.faces().collect();
    // What solids displace counts under gravity, and for the paper's form of the pressure.
    let in_no_face = flow.gravity.iter().any(|g| *g != 0.0) || flow.scheme.pressure == PressureForm::Paper;
    let pushed = |cell: usize| {
        let at = flow.coordinates(cell);
        let open = |d: usize| [0, 1].map(|side| faces[d][flow.face(d, at, side)]);
        let walled = |d: usize| open(d).iter().any(|b| *b < 1.0);
        let entered = |d: usize| open(d).iter().any(|b| *b > 0.0);
        let holds_gas = || flow.open_volume(cell) > 0.0 || (0..faces.len()).any(entered);
        let displaces = || in_no_face && taken_volume(flow, cell) > 0.0;
        ((0..faces.len()).any(walled) || drags(flow, cell) || displaces()) && holds_gas()
    };
    (0..flow.len()).into_par_iter().filter(|&cell| pushed(cell)).collect()
}

/// Whether a cell has a resistance.
pub(super) fn drags<const D: usize>(flow: &Flow<f64, D>, cell: usize) -> bool {
    flow.drag().any(|c| c.get(cell).is_some_and(|c| *c > 0.0))
}

/// Volume of the solids in a cell.
pub(super) fn taken_volume<const D: usize>(flow: &Flow<f64, D>, cell: usize) -> f64 {
    flow.volume(flow.coordinates(cell)) - flow.open_volume(cell)
}

/// What the pressures and drags of a cell are multiplied by, to make forces of them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Weights<const D: usize> {
    /// For each axis the area, in m², on which the pressure on the walls at the low and at the high side acts.
    pub sides: [[f64; 2]; D],
    /// Share of what acts along the borders of porous bodies askew to the grid.
    pub along: f64,
    /// For each axis the volume, in m³, on which the drag acts.
    pub drag: [f64; D],
    /// Volume of gas displaced, in m³.
    pub displaced: f64,
}

impl<const D: usize> Weights<D> {
    /// Those of all solids in a cell together.
    fn of(flow: &Flow<f64, D>, cell: usize) -> Self {
        let at = flow.coordinates(cell);
        Weights {
            sides: std::array::from_fn(|d| [flow.area(d, at); 2]),
            along: 1.0,
            drag: [flow.volume(at); D],
            displaced: taken_volume(flow, cell),
        }
    }

    /// The force in a cell, in N along each axis.
    pub(super) fn force(&self, flow: &Flow<f64, D>, cell: usize, push: &CellPush<f64, D>) -> [f64; D] {
        let at = flow.coordinates(cell);
        std::array::from_fn(|d| {
            let [low, high] = [0, 1].map(|side| push.sides[d][side] * self.sides[d][side]);
            let along = (0..D).fold(0.0, |sum, axis| {
                let [low, high] = push.along[axis];
                if high[d] == low[d] { sum } else { sum + (high[d] - low[d]) * flow.area(axis, at) * self.along }
            });
            let g = flow.gravity[d];
            let weight = if g == 0.0 { 0.0 } else { g * flow.get(cell).density * self.displaced };
            high - low + along + push.drag[d] * self.drag[d] - weight
        })
    }
}

/// Faces in walls of the domain that are lowered for obstacles with gas all around. What acts on the closed part there acts on both sides of the obstacle: it leans on
/// the wall of the domain alone.
///
/// By cell, axis of the flow and side (0 low, 1 high), the share of what is closed.
#[derive(Debug, Clone, Default)]
pub struct FreeSides(BTreeMap<(usize, usize, usize), f64>);

impl FreeSides {
    /// Of a flow with these axes.
    #[must_use]
    pub fn new<const D: usize>(flow: &Flow<f64, D>, live: [usize; D], surrounded: &[LoweredSide]) -> Self {
        let faces: Vec<&[f64]> = flow.faces().collect();
        let free = |&LoweredSide { cell, axis, side, shown, passes }: &LoweredSide| {
            let (d, at) = (live.iter().position(|live| *live == axis)?, flow.coordinates(cell));
            // The paper's form pushes what no face shows.
            let counts = flow.stands(d, side, at).is_wall() && flow.scheme.pressure == PressureForm::Geometric;
            let closed = 1.0 - faces.get(d)?[flow.face(d, at, side)];
            let share = ((shown - passes) / closed).min(1.0);
            (counts && closed > 0.0).then_some(((cell, d, side), share))
        };
        FreeSides(surrounded.iter().filter_map(free).collect())
    }

    /// Which share of what is closed at a side of a cell counts.
    pub(super) fn counts(&self, cell: usize, d: usize, side: usize) -> f64 {
        self.0.get(&(cell, d, side)).map_or(1.0, |share| 1.0 - share)
    }
}

/// Force on all solids along x, y and z, from the walls that the flow watches; per metre of the axes that do not flow. The same bits for any number of
/// threads.
#[must_use]
pub fn force_on_all<const D: usize>(flow: &Flow<f64, D>, live: [usize; D], free_sides: &FreeSides) -> [f64; 3] {
    let (cells, pushes) = flow.watched_walls();
    let of_portion = |(cells, pushes): (&[usize], &[CellPush<f64, D>])| {
        let mut sum = [0.0; D];
        for (&cell, push) in cells.iter().zip(pushes) {
            let force = Weights::of(flow, cell).force(flow, cell, push);
            sum.iter_mut().zip(force).for_each(|(sum, f)| *sum += f);
        }
        sum
    };
    let portions: Vec<[f64; D]> = cells.par_chunks(PORTION).zip(pushes.par_chunks(PORTION)).map(of_portion).collect();
    let mut force = [0.0; 3];
    for (d, axis) in live.into_iter().enumerate() {
        force[axis] = portions.iter().fold(0.0, |sum, portion| sum + portion[d]);
    }
    for (&(cell, d, side), share) in &free_sides.0 {
        let Ok(place) = cells.binary_search(&cell) else { continue };
        let push = share * pushes[place].sides[d][side] * flow.area(d, flow.coordinates(cell));
        force[live[d]] += if side == 0 { push } else { -push };
    }
    force
}
