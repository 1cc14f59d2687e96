//! Cells whose open space is divided by solid: gas passes through them that has no way.
//!
//! A cell has one state, so a wall thinner than a cell is passed wherever both of its sides belong to one cell, unless a face is closed. The parts of a
//! cell are found by points: six along each axis, and two more just within the faces. Neighbouring points are of one part if no surface crosses
//! between them, so a passage narrower than a sixth of a cell may be taken for closed. A divided cell is told if
//! - two of its parts reach beyond it, each by a face that is open to that part alone, or that a divided neighbour goes on from by such a face, and
//! - there is no way from one part to the other through the 26 cells around it: gas that goes around a pipe or the end of a wall does no harm.

mod parts;

use super::doubt;
use super::fields::FieldSet;
use super::shadows::{HIDDEN, Shadows, cells, faces_of_cell, hidden_share, place_of_cell};
use super::snap;
use crate::geometry::bodies::{Bodies, Body, Doubt};
use crate::geometry::facets;
use crate::geometry::repair::sets::Sets;
use glam::DVec3;
use parts::Parts;
use rayon::prelude::*;
use rustc_hash::FxHashMap as HashMap;
use voidage_core::grid::Grid;
use voidage_core::surface::clip::{Polygon, keep};

/// Cells that are divided.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct DividedCells {
    /// How many.
    pub cells: usize,
    /// The first, as i, j, k from 0.
    pub first: Option<[usize; 3]>,
}

/// A cell is looked at if along one axis it blocks this share of its section beyond what its faces show: a wall that divides it does.
const LEAST_HIDDEN: f64 = 0.25;

/// A neighbour of a divided cell is looked at from here: the corner of a cell that the wall cuts off.
const LEAST_BESIDE: f64 = 0.02;

/// A face is open from this open fraction on.
const OPEN: f64 = 0.05;

/// The cells of a grid that surface divides, and their parts.
#[derive(Debug, Clone, Default)]
pub struct Division {
    parts: HashMap<usize, Parts>,
    /// Cells that may be told: neighbours are known by their parts only.
    candidates: Vec<usize>,
}

impl Division {
    /// Of solid bodies with known shadows; `beta` holds open fractions in the planes of faces. Porous bodies divide nothing. Runs in the current
    /// rayon pool.
    #[must_use]
    pub fn find(grid: &Grid<f64>, bodies: &Bodies, beta: &FieldSet, shadows: &Shadows) -> Self {
        let hidden = |at: [usize; 3]| hidden(grid, beta, shadows, at);
        let all: Vec<(usize, f64)> = cells(grid)
            .enumerate()
            .filter(|(n, _)| beta.v[*n] > 0.0)
            .map(|(n, at)| (n, hidden(at)))
            .filter(|(_, hidden)| *hidden >= LEAST_BESIDE)
            .collect();
        let first: Vec<usize> = all.iter().filter(|(_, h)| *h >= LEAST_HIDDEN).map(|(n, _)| *n).collect();
        if first.is_empty() {
            return Division::default();
        }
        let surfaces = surfaces(grid, bodies);
        let mut parts = divided_among(grid, &surfaces, &first);
        let mut candidates: Vec<usize> = parts.keys().copied().collect();
        candidates.sort_unstable();
        let mut beside = vec![false; grid.cell_count()];
        for &n in &candidates {
            around(grid, n).for_each(|at| beside[grid.cell_index(at)] = true);
        }
        let more: Vec<usize> = all.iter().filter(|(n, h)| *h < LEAST_HIDDEN && beside[*n]).map(|(n, _)| *n).collect();
        parts.extend(divided_among(grid, &surfaces, &more));
        Division { parts, candidates }
    }

    /// The cells that let gas pass with the open fractions `beta` of faces, which may have been lowered since; without those that are hidden passages
    /// by the `shadows`, if these are given.
    #[must_use]
    pub fn told(&self, grid: &Grid<f64>, beta: &FieldSet, shadows: Option<&Shadows>) -> DividedCells {
        let is_told = |n: &&usize| {
            let known = shadows.is_some_and(|shadows| hidden(grid, beta, shadows, place_of_cell(grid, **n)) > HIDDEN);
            !known && self.lets_pass(grid, beta, **n)
        };
        let found: Vec<usize> = self.candidates.par_iter().filter(is_told).copied().collect();
        DividedCells { cells: found.len(), first: found.first().map(|&n| place_of_cell(grid, n)) }
    }

    /// Do two parts of a cell reach beyond it that have no way to each other around it?
    fn lets_pass(&self, grid: &Grid<f64>, beta: &FieldSet, n: usize) -> bool {
        let Some(parts) = self.parts.get(&n) else { return false };
        let reaching: Vec<usize> = (0..parts.count()).filter(|&part| self.reaches(grid, beta, n, part)).collect();
        if reaching.len() < 2 {
            return false;
        }
        let ways = self.ways_around(grid, n);
        reaching.iter().any(|&part| ways[part] != ways[reaching[0]])
    }

    /// Does a part of a cell reach beyond it, by a face of its own or through a divided neighbour?
    fn reaches(&self, grid: &Grid<f64>, beta: &FieldSet, n: usize, part: usize) -> bool {
        let own = |n: usize, part: usize| {
            let is_own = |&(axis, side): &(usize, usize)| self.parts[&n].owns(part, axis, side);
            SIDES.iter().filter(|side| open_side(grid, beta, n, **side)).any(is_own)
        };
        let through = |&(axis, side): &(usize, usize)| {
            let Some(next) = neighbour(grid, n, axis, side) else { return false };
            let shared = self.shared(n, next, (axis, side));
            self.parts.contains_key(&next)
                && open_side(grid, beta, n, (axis, side))
                && shared.into_iter().any(|(own_part, beyond)| own_part == part && own(next, beyond))
        };
        own(n, part) || SIDES.iter().any(through)
    }

    /// The pairs of parts of two neighbours that meet in their common side. A cell that is not divided has one part.
    fn shared(&self, n: usize, next: usize, (axis, side): (usize, usize)) -> Vec<(usize, usize)> {
        match (self.parts.get(&n), self.parts.get(&next)) {
            (Some(a), Some(b)) => a.meeting(b, axis, side),
            (Some(a), None) => (0..a.count()).filter(|&p| a.touches(p, axis, side)).map(|p| (p, 0)).collect(),
            (None, Some(b)) => (0..b.count()).filter(|&p| b.touches(p, axis, 1 - side)).map(|p| (0, p)).collect(),
            (None, None) => vec![(0, 0)],
        }
    }

    /// For each part of a cell a number, the same for parts that are one in the block of cells around it.
    fn ways_around(&self, grid: &Grid<f64>, n: usize) -> Vec<usize> {
        let (mut numbers, mut count) = (HashMap::default(), 0);
        for at in around(grid, n) {
            let cell = grid.cell_index(at);
            numbers.insert(cell, count);
            count += self.parts.get(&cell).map_or(1, Parts::count);
        }
        let mut sets = Sets::new(count);
        for at in around(grid, n) {
            let cell = grid.cell_index(at);
            for axis in 0..3 {
                let Some(next) = neighbour(grid, cell, axis, 1) else { continue };
                let Some(second) = numbers.get(&next) else { continue };
                for (a, b) in self.shared(cell, next, (axis, 1)) {
                    sets.join(numbers[&cell] + a, second + b);
                }
            }
        }
        (0..self.parts[&n].count()).map(|part| sets.find(numbers[&n] + part)).collect()
    }
}

/// The sides of a cell: axis, and 0 for the low side or 1 for the high one.
const SIDES: [(usize, usize); 6] = [(0, 0), (0, 1), (1, 0), (1, 1), (2, 0), (2, 1)];

fn neighbour(grid: &Grid<f64>, n: usize, axis: usize, side: usize) -> Option<usize> {
    let mut at = place_of_cell(grid, n);
    at[axis] = if side == 0 { at[axis].checked_sub(1)? } else { at[axis] + 1 };
    (at[axis] < grid.cells()[axis]).then(|| grid.cell_index(at))
}

/// A cell and those around it.
fn around(grid: &Grid<f64>, n: usize) -> impl Iterator<Item = [usize; 3]> {
    let (at, cells) = (place_of_cell(grid, n), grid.cells());
    let [x, y, z] = [0, 1, 2].map(|a| at[a].saturating_sub(1)..(at[a] + 2).min(cells[a]));
    z.flat_map(move |k| {
        y.clone().flat_map({
            let x = x.clone();
            move |j| x.clone().map(move |i| [i, j, k])
        })
    })
}

fn open_side(grid: &Grid<f64>, beta: &FieldSet, n: usize, (axis, side): (usize, usize)) -> bool {
    beta.faces(axis)[faces_of_cell(grid, axis, place_of_cell(grid, n))[side]] >= OPEN
}

/// The largest share of its section that a cell blocks along an axis beyond what its faces show.
fn hidden(grid: &Grid<f64>, beta: &FieldSet, shadows: &Shadows, at: [usize; 3]) -> f64 {
    let n = grid.cell_index(at);
    let along = |axis: usize| hidden_share(grid, axis, shadows.tau[axis][n], beta, at);
    along(0).max(along(1)).max(along(2))
}

/// The triangles of the bodies that are solid, with the body's number; curved ones as facets.
fn surfaces(grid: &Grid<f64>, bodies: &Bodies) -> Vec<(u32, [DVec3; 3])> {
    let moved = snap::into_planes(grid, bodies);
    let triangles = moved.as_deref().unwrap_or(&bodies.triangles);
    let solid = |(_, body): &(usize, &Body)| body.porosity == 0.0 && body.doubt != Doubt::Unknown;
    let of_body = |(n, body): (usize, &Body)| {
        let own = facets::of_body(body).unwrap_or_else(|| triangles[body.triangles.clone()].to_vec());
        own.into_iter().map(move |triangle| (n as u32, triangle))
    };
    bodies.bodies.iter().enumerate().filter(solid).flat_map(of_body).collect()
}

/// Those of some cells, in ascending order, that have several parts.
fn divided_among(grid: &Grid<f64>, surfaces: &[(u32, [DVec3; 3])], cells: &[usize]) -> HashMap<usize, Parts> {
    let lists = lists(grid, surfaces, cells);
    let found = cells.par_iter().zip(&lists).filter_map(|(&n, list)| {
        let cell = grid.cell_box(place_of_cell(grid, n))?;
        let triangles = list.iter().map(|&t| surfaces[t as usize]);
        Parts::of_cell(cell, triangles).filter(|parts| parts.count() > 1).map(|parts| (n, parts))
    });
    found.collect::<Vec<_>>().into_iter().collect()
}

/// A triangle whose box reaches so many cells is not cut to tell which of them it reaches itself.
const FEW_CELLS: usize = 27;

/// The triangles that reach each of some cells, or nearly so.
fn lists(grid: &Grid<f64>, surfaces: &[(u32, [DVec3; 3])], cells: &[usize]) -> Vec<Vec<u32>> {
    let mut slots = vec![u32::MAX; grid.cell_count()];
    cells.iter().zip(0..).for_each(|(&n, slot)| slots[n] = slot);
    let mut lists = vec![Vec::new(); cells.len()];
    let mut list = |number: u32, at: [usize; 3]| {
        if let Some(list) = lists.get_mut(slots[grid.cell_index(at)] as usize) {
            list.push(number);
        }
    };
    for ((_, triangle), number) in surfaces.iter().zip(0..) {
        let whole = Polygon::new(&triangle.map(|p| p.to_array()));
        let [x, y, z] = [0, 1, 2].map(|axis| reached(grid, axis, &whole));
        if x.len() * y.len() * z.len() <= FEW_CELLS {
            for (k, j) in z.flat_map(|k| y.clone().map(move |j| (k, j))) {
                x.clone().for_each(|i| list(number, [i, j, k]));
            }
            continue;
        }
        for k in z {
            let slab = between(grid, 2, k, &whole);
            for j in reached(grid, 1, &slab) {
                let row = between(grid, 1, j, &slab);
                reached(grid, 0, &row).for_each(|i| list(number, [i, j, k]));
            }
        }
    }
    lists
}

/// The cells along an axis that a polygon reaches or touches.
fn reached(grid: &Grid<f64>, axis: usize, polygon: &Polygon<f64>) -> std::ops::Range<usize> {
    if polygon.is_empty() {
        return 0..0;
    }
    let (lo, hi) = polygon.extent(axis);
    doubt::reached(grid.edges(axis), lo, hi)
}

/// What of a polygon lies between the planes of a layer.
fn between(grid: &Grid<f64>, axis: usize, layer: usize, polygon: &Polygon<f64>) -> Polygon<f64> {
    let (mut above, mut both) = (Polygon::new(&[]), Polygon::new(&[]));
    keep(polygon, axis, grid.edges(axis)[layer], true, &mut above);
    keep(&above, axis, grid.edges(axis)[layer + 1], false, &mut both);
    both
}
