//! Forces on single solids: the force on all that stands in the gas (`force`), shared out by what each solid has in a cell.
//!
//! Each solid is measured alone, on the cells that it reaches, as all of them are measured together: with faces lowered to a throat, if theirs are. What
//! it closes of a face is its wall on both sides of the face. What the walls of all together have besides (where solids share a cell or hide each
//! other) goes, face by face, by how much of the two cells and their faces each takes, and the drag by how much of the cell, but for that of a
//! resistance given for a solid, which is its own. So the forces on all solids add up to
//! the force on all, and gas of one pressure all around pushes none of them that it surrounds.
//!
//! What acts on the walls of a cell comes from the step, side by side (`CellPush`); a solid feels of each side the share of what is closed there that is its own.

use super::arrays::position;
use super::force::{FreeSides, Weights, drags, taken_volume};
use crate::error::Result;
use crate::files::csv;
use crate::flow::Flow;
use crate::geometry::bodies::Bodies;
use crate::grid::Edges;
use crate::porosity::drag::own_resistance;
use crate::porosity::resistance::shadows;
use crate::porosity::shadows::{cells, faces_of_cell};
use crate::porosity::throat::{self, Faces};
use crate::porosity::{Options, porosity};
use serde::Serialize;
use std::collections::BTreeMap;

/// Name under which the force on all other solids is told.
pub const OTHERS: &str = "others";

/// What solids of one name have in the cells that they reach.
#[derive(Debug, Clone)]
pub struct Measured<const D: usize> {
    /// Their name.
    pub name: String,
    cells: Vec<Part<D>>,
}

impl<const D: usize> Measured<D> {
    /// The name in a sentence, if none of these solids has a part in the grid; none for the others, which need not be there.
    #[must_use]
    pub fn absent(&self) -> Option<String> {
        (self.cells.is_empty() && self.name != OTHERS).then(|| format!("solid \"{}\"", self.name))
    }
}

/// What solids have in a cell.
#[derive(Debug, Clone, Copy)]
struct Part<const D: usize> {
    cell: usize,
    /// Open fractions of the low and high faces of the live axes.
    faces: [[f64; 2]; D],
    /// What is taken of the cell.
    volume: f64,
    /// What is taken of the cell and of its faces.
    taken: f64,
    /// Resistance in 1/m that is given for the solids themselves, along all axes.
    own_cr: f64,
}

/// Force on the solids of a name.
#[derive(Debug, Clone, Serialize)]
pub struct SolidForce {
    /// Their name.
    pub name: String,
    /// Along x, y and z, in N.
    pub force: [f64; 3],
}

/// The names that each body answers to: its own, and that of the solid of a scene that it is a copy or a part of (its own again, if there is none).
#[must_use]
pub fn names(bodies: &Bodies) -> Vec<[&str; 2]> {
    let mut names: Vec<[&str; 2]> = bodies.bodies.iter().map(|b| [&b.name[..]; 2]).collect();
    for solid in &bodies.solids {
        names[solid.bodies.clone()].iter_mut().for_each(|of_body| of_body[1] = &solid.name);
    }
    names
}

/// Measures the solids of each name alone, and at last all others. A body counts to its own name before that of its solid.
///
/// # Errors
/// The edges are no grid.
pub fn measure<const D: usize>(
    bodies: &Bodies,
    wanted: &[String],
    edges: &Edges,
    live: [usize; D],
    (options, faces): (Options, Faces),
) -> Result<Vec<Measured<D>>> {
    let at = |name: &str| wanted.iter().position(|w| w == name);
    let group = |[own, solid]: &[&str; 2]| at(own).or_else(|| at(solid)).unwrap_or(wanted.len());
    let groups: Vec<usize> = names(bodies).iter().map(group).collect();
    let all = wanted.iter().map(String::as_str).chain([OTHERS]).enumerate();
    all.map(|(n, name)| {
        let some = bodies.some(|body| groups[body] == n);
        Ok(Measured { name: name.to_owned(), cells: alone(&some, edges, live, (options, faces))? })
    })
    .collect()
}

/// What bodies alone have in the cells that they reach.
fn alone<const D: usize>(
    bodies: &Bodies,
    edges: &Edges,
    live: [usize; D],
    (options, faces): (Options, Faces),
) -> Result<Vec<Part<D>>> {
    let Some([low, high]) = bodies.bounds() else { return Ok(Vec::new()) };
    let shape = edges.cells();
    // The cells between the corners, and one more on each side.
    let ranges: [std::ops::Range<usize>; 3] = std::array::from_fn(|a| {
        let edges = &edges.0[a];
        let first = edges.partition_point(|x| *x < low[a]).saturating_sub(2);
        let end = (edges.partition_point(|x| *x <= high[a]) + 1).min(shape[a]);
        first.min(shape[a] - 1)..end.max(1)
    });
    let block = Edges(std::array::from_fn(|a| edges.0[a][ranges[a].start..=ranges[a].end].to_vec()));
    let grid = block.grid(None)?;
    let mut found = porosity(&grid, bodies, Options { resistance: faces == Faces::Throat, ..options });
    if faces == Faces::Throat {
        let shadows = shadows(&grid, bodies, &found, options);
        let first = ranges.each_ref().map(|range| range.start);
        throat::lower_within(&grid, &mut found, &shadows, (first, shape));
    }
    let (found, own_cr) = (found.beta, own_resistance(&grid, bodies, options));
    let mut parts = Vec::new();
    for ((at, open), own_cr) in cells(&grid).zip(&found.v).zip(own_cr) {
        let faces = live.map(|axis| faces_of_cell(&grid, axis, at).map(|face| found.faces(axis)[face]));
        let volume = 1.0 - open;
        let taken = volume + faces.iter().flatten().map(|b| 1.0 - b).sum::<f64>();
        if taken > 0.0 || own_cr > 0.0 {
            let [i, j, k]: [usize; 3] = std::array::from_fn(|a| ranges[a].start + at[a]);
            parts.push(Part { cell: position([i, j, k], shape), faces, volume, taken, own_cr });
        }
    }
    Ok(parts)
}

/// What all solids have in the cells of a flow.
struct Parts<'a, const D: usize> {
    flow: &'a Flow<f64, D>,
    by_cell: BTreeMap<usize, Vec<(usize, Part<D>)>>,
    /// The group of what belongs to nobody.
    others: usize,
    /// Whether resistances given for solids act.
    own_counts: bool,
    /// What counts for no solid.
    free_sides: &'a FreeSides,
}

/// Weights of what acts in a cell on each group.
#[derive(Default)]
struct Shares<const D: usize>(BTreeMap<usize, Weights<D>>);

impl<const D: usize> Shares<D> {
    fn of(&mut self, group: usize) -> &mut Weights<D> {
        self.0.entry(group).or_insert(Weights { sides: [[0.0; 2]; D], along: 0.0, drag: [0.0; D], displaced: 0.0 })
    }
}

impl<const D: usize> Parts<'_, D> {
    fn of(&self, cell: usize) -> &[(usize, Part<D>)] {
        self.by_cell.get(&cell).map_or(&[], |parts| &parts[..])
    }

    /// Shares by what solids take of some cells and of their faces; where there is none, of the cells beside them.
    fn shares(&self, cells: &[usize]) -> Vec<(usize, f64)> {
        let beside = || cells.iter().flat_map(|&cell| self.flow.beside(cell)).collect::<Vec<_>>();
        let found = self.shares_of(cells, |part| part.taken).or_else(|| self.shares_of(&beside(), |part| part.taken));
        found.unwrap_or_else(|| vec![(self.others, 1.0)])
    }

    /// Shares of the drag of a cell along an axis: that of the resistances given for solids goes to them, the rest by the volumes of all.
    fn drag_shares(&self, cell: usize, d: usize, by_volume: &[(usize, f64)]) -> Vec<(usize, f64)> {
        let given: f64 = self.of(cell).iter().map(|(_, part)| part.own_cr).sum();
        let all: f64 = self.flow.drag().nth(d).and_then(|cr| cr.get(cell).copied()).unwrap_or(0.0);
        // Where the case gives another resistance those of solids do not count.
        if !self.own_counts || !(given > 0.0) || !(all > 0.0) {
            return by_volume.to_vec();
        }
        let all = all.max(given);
        let own = self.of(cell).iter().map(|(group, part)| (*group, part.own_cr / all));
        own.chain(by_volume.iter().map(|(group, share)| (*group, share * (1.0 - given / all)))).collect()
    }

    /// Shares by the volumes of the solids in a cell: of the weight of the gas displaced there, of what is not given for solids of its drag, and of walls in no face.
    fn volume_shares(&self, cell: usize) -> Vec<(usize, f64)> {
        self.shares_of(&[cell], |part| part.volume).unwrap_or_else(|| self.shares(&[cell]))
    }

    /// Shares by something that solids have in some cells; none where no solid has any.
    fn shares_of(&self, cells: &[usize], of: impl Fn(&Part<D>) -> f64) -> Option<Vec<(usize, f64)>> {
        let mut sums: BTreeMap<usize, f64> = BTreeMap::new();
        let parts = cells.iter().flat_map(|&cell| self.of(cell));
        parts.for_each(|(group, part)| *sums.entry(*group).or_default() += of(part));
        let all: f64 = sums.values().sum();
        (all > 0.0).then(|| sums.into_iter().map(|(group, sum)| (group, sum / all)).collect())
    }

    /// At both ends of a periodic axis the flow has the less open face of the two: what a solid closes of one it closes of both.
    fn match_ends(&mut self) {
        for d in (0..D).filter(|&d| self.flow.boundaries[d][0].is_periodic()) {
            for low in (0..self.flow.len()).filter(|&cell| self.flow.coordinates(cell)[d] == 0) {
                let Some(high) = self.flow.behind(d, self.flow.coordinates(low), 0) else { continue };
                let ends = [(low, 0), (high, 1)];
                let mut open: BTreeMap<usize, f64> = BTreeMap::new();
                for (cell, side) in ends {
                    for (group, part) in self.of(cell) {
                        let least = open.entry(*group).or_insert(1.0);
                        *least = least.min(part.faces[d][side]);
                    }
                }
                for (group, least) in open.into_iter().filter(|(_, least)| *least < 1.0) {
                    for (cell, side) in ends {
                        let parts = self.by_cell.entry(cell).or_default();
                        let at = parts.iter().position(|(other, _)| *other == group).unwrap_or_else(|| {
                            let open = Part { cell, faces: [[1.0; 2]; D], volume: 0.0, taken: 0.0, own_cr: 0.0 };
                            parts.push((group, open));
                            parts.len() - 1
                        });
                        let part = &mut parts[at].1;
                        part.taken += part.faces[d][side] - least;
                        part.faces[d][side] = least;
                    }
                }
            }
        }
    }

    /// What of all that acts in a cell is for each group.
    fn in_cell(&self, faces: &[&[f64]], cell: usize) -> Shares<D> {
        let (at, here) = (self.flow.coordinates(cell), self.of(cell));
        let weighs = drags(self.flow, cell) || self.flow.gravity.iter().any(|g| *g != 0.0);
        let by_volume = self.volume_shares(cell);
        let mut found = Shares::default();
        for (d, side) in (0..faces.len()).flat_map(|d| [(d, 0), (d, 1)]) {
            let closed = 1.0 - faces[d][self.flow.face(d, at, side)];
            if closed == 0.0 {
                continue;
            }
            let area = self.flow.area(d, at) / closed;
            let mut rest = closed;
            for (group, part) in here {
                let own = 1.0 - part.faces[d][side];
                rest -= own;
                found.of(*group).sides[d][side] += own * area;
            }
            if rest != 0.0 {
                // The same two cells from both sides, so that a wall in a face belongs to one and the same solid on both.
                let both: Vec<usize> = self.flow.behind(d, at, side).into_iter().chain([cell]).collect();
                for (group, share) in self.shares(&both) {
                    found.of(group).sides[d][side] += share * rest * area;
                }
            }
        }
        // What acts along borders is for those who close the faces of the cell.
        let of = |weights: &Weights<D>| weights.sides.as_flattened().iter().sum::<f64>();
        let all: f64 = found.0.values().map(of).sum();
        if all > 0.0 {
            found.0.values_mut().for_each(|weights| weights.along = of(weights) / all);
        }
        // Walls that are in no face: in the paper's form, and in a cell whose duct is narrower than its wider face.
        for (d, side) in (0..faces.len()).flat_map(|d| [(d, 0), (d, 1)]) {
            if faces[d][self.flow.face(d, at, side)] == 1.0 {
                by_volume
                    .iter()
                    .for_each(|(group, share)| found.of(*group).sides[d][side] = share * self.flow.area(d, at));
            }
        }
        for weights in found.0.values_mut() {
            for (d, side) in (0..D).flat_map(|d| [(d, 0), (d, 1)]) {
                weights.sides[d][side] *= self.free_sides.counts(cell, d, side);
            }
        }
        if weighs {
            let (volume, displaced) = (self.flow.volume(at), taken_volume(self.flow, cell));
            for d in 0..D {
                for (group, share) in self.drag_shares(cell, d, &by_volume) {
                    found.of(group).drag[d] += share * volume;
                }
            }
            by_volume.iter().for_each(|(group, share)| found.of(*group).displaced = share * displaced);
        }
        found
    }
}

/// Shares of each solid in the cells where the gas pushes.
#[derive(Debug, Clone)]
pub struct SolidShares<const D: usize> {
    /// Names, the others last.
    names: Vec<String>,
    /// For each name: watched cells, and what of all that acts there is for its solids.
    shares: Vec<Vec<(usize, Weights<D>)>>,
}

impl<const D: usize> SolidShares<D> {
    /// From what solids have alone, in a flow around all of them that pushes something in some cells; resistances given for them may count or not.
    #[must_use]
    pub fn new(
        measured: &[Measured<D>],
        flow: &Flow<f64, D>,
        (pushed, free_sides): (&[usize], &FreeSides),
        own_counts: bool,
    ) -> Self {
        let names: Vec<String> = measured.iter().map(|m| m.name.clone()).collect();
        let mut shares = vec![Vec::new(); names.len()];
        let mut by_cell: BTreeMap<usize, Vec<(usize, Part<D>)>> = BTreeMap::new();
        for (group, m) in measured.iter().enumerate() {
            m.cells.iter().for_each(|part| by_cell.entry(part.cell).or_default().push((group, *part)));
        }
        let Some(others) = names.len().checked_sub(1) else { return SolidShares { names, shares } };
        let mut parts = Parts { flow, by_cell, others, own_counts, free_sides };
        parts.match_ends();
        let faces: Vec<&[f64]> = flow.faces().collect();
        for &cell in pushed {
            for (group, weights) in parts.in_cell(&faces, cell).0 {
                shares[group].push((cell, weights));
            }
        }
        SolidShares { names, shares }
    }

    /// Names of the columns of the log.
    #[must_use]
    pub fn head(&self) -> String {
        let columns =
            |name: &String| ["x", "y", "z"].map(|axis| format!(",{}", csv::cell(&format!("{name} force_{axis}"))));
        self.names.iter().flat_map(columns).collect()
    }

    /// The present forces.
    #[must_use]
    pub fn forces(&self, flow: &Flow<f64, D>, live: [usize; D]) -> Vec<SolidForce> {
        let (cells, pushes) = flow.watched_walls();
        let of_name = |(name, shares): (&String, &Vec<(usize, Weights<D>)>)| {
            let mut force = [0.0; 3];
            for (cell, weights) in shares {
                let Ok(place) = cells.binary_search(cell) else { continue };
                let in_cell = weights.force(flow, *cell, &pushes[place]);
                live.into_iter().zip(in_cell).for_each(|(axis, f)| force[axis] += f);
            }
            SolidForce { name: name.clone(), force }
        };
        self.names.iter().zip(&self.shares).map(of_name).collect()
    }
}
