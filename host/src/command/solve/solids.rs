//! Forces on single solids: the force on all that stands in the gas (`force`), shared out by what each solid has in a cell.
//!
//! Each solid is measured alone, on the cells that it reaches. The vector area of its own walls in a cell is A⁻β⁻ − A⁺β⁺ with its own fractions;
//! what the walls of all together have besides (where solids share a cell or hide each other, and at faces lowered to a throat) goes by
//! how much of the cell and of its faces each takes, and so does the drag. So the forces on all solids add up to the force on all.

use super::arrays::position;
use super::force::Solids;
use crate::error::Result;
use crate::flow::Flow;
use crate::geometry::bodies::Bodies;
use crate::grid::Edges;
use crate::porosity::shadows::{cells, faces_of_cell};
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
    /// What is taken of the cell and of its faces.
    taken: f64,
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
    options: Options,
) -> Result<Vec<Measured<D>>> {
    let at = |name: &str| wanted.iter().position(|w| w == name);
    let group = |[own, solid]: &[&str; 2]| at(own).or_else(|| at(solid)).unwrap_or(wanted.len());
    let groups: Vec<usize> = names(bodies).iter().map(group).collect();
    let all = wanted.iter().map(String::as_str).chain([OTHERS]).enumerate();
    all.map(|(n, name)| {
        let some = part_of(bodies, &groups, n);
        Ok(Measured { name: name.to_owned(), cells: alone(&some, edges, live, options)? })
    })
    .collect()
}

/// The bodies of the `n`-th group.
fn part_of(bodies: &Bodies, groups: &[usize], n: usize) -> Bodies {
    let mut part = Bodies::default();
    for (body, _) in bodies.bodies.iter().zip(groups).filter(|(_, group)| **group == n) {
        let first = part.triangles.len();
        part.triangles.extend_from_slice(&bodies.triangles[body.triangles.clone()]);
        let mut body = body.clone();
        body.triangles = first..part.triangles.len();
        part.bodies.push(body);
    }
    part
}

/// What bodies alone have in the cells that they reach.
fn alone<const D: usize>(bodies: &Bodies, edges: &Edges, live: [usize; D], options: Options) -> Result<Vec<Part<D>>> {
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
    let found = porosity(&grid, bodies, options).beta;
    let mut parts = Vec::new();
    for (at, open) in cells(&grid).zip(&found.v) {
        let faces = live.map(|axis| faces_of_cell(&grid, axis, at).map(|face| found.faces(axis)[face]));
        let taken = (1.0 - open) + faces.iter().flatten().map(|b| 1.0 - b).sum::<f64>();
        if taken > 0.0 {
            let [i, j, k]: [usize; 3] = std::array::from_fn(|a| ranges[a].start + at[a]);
            parts.push(Part { cell: position([i, j, k], shape), faces, taken });
        }
    }
    Ok(parts)
}

/// Shares of each solid in the cells where the gas pushes.
#[derive(Debug, Clone)]
pub struct SolidShares<const D: usize> {
    /// Names, the others last.
    names: Vec<String>,
    /// For each name: the cell, the vector area of its walls, its share of the drag.
    shares: Vec<Vec<(usize, [f64; D], f64)>>,
}

impl<const D: usize> SolidShares<D> {
    /// From what solids have alone, in a flow around all of them.
    #[must_use]
    pub fn new(measured: &[Measured<D>], flow: &Flow<f64, D>) -> Self {
        let names: Vec<String> = measured.iter().map(|m| m.name.clone()).collect();
        let mut shares = vec![Vec::new(); names.len()];
        let mut by_cell: BTreeMap<usize, Vec<(usize, Part<D>)>> = BTreeMap::new();
        for (group, m) in measured.iter().enumerate() {
            m.cells.iter().for_each(|part| by_cell.entry(part.cell).or_default().push((group, *part)));
        }
        let (Some(solids), Some(others)) = (Solids::of(flow), names.len().checked_sub(1)) else {
            return SolidShares { names, shares };
        };
        for cell in (0..flow.len()).filter(|&cell| flow.open_volume(cell) > 0.0) {
            let at = flow.coordinates(cell);
            let walls: [f64; D] = std::array::from_fn(|d| solids.wall(flow, d, at));
            let here = by_cell.get(&cell).map_or(&[][..], |parts| &parts[..]);
            if here.is_empty() && walls == [0.0; D] && !solids.drags(cell) {
                continue;
            }
            // The part of a solid in the cell; where there is none, that in the cells beside it.
            let taken: Vec<f64> = {
                let mut taken = vec![0.0; names.len()];
                here.iter().for_each(|(group, part)| taken[*group] += part.taken);
                if here.is_empty() {
                    let beside = flow.beside(cell).into_iter().filter_map(|c| by_cell.get(&c)).flatten();
                    beside.for_each(|(group, part)| taken[*group] += part.taken);
                }
                taken
            };
            let all: f64 = taken.iter().sum();
            let own = |part: &Part<D>| -> [f64; D] {
                std::array::from_fn(|d| (part.faces[d][0] - part.faces[d][1]) * flow.area(d, at))
            };
            let mut rest = walls;
            here.iter().for_each(|(_, part)| (0..D).for_each(|d| rest[d] -= own(part)[d]));
            for (group, list) in shares.iter_mut().enumerate() {
                let share = if all > 0.0 { taken[group] / all } else { f64::from(u8::from(group == others)) };
                let mut area = rest.map(|r| share * r);
                for (_, part) in here.iter().filter(|(g, _)| *g == group) {
                    (0..D).for_each(|d| area[d] += own(part)[d]);
                }
                if share > 0.0 || area != [0.0; D] {
                    list.push((cell, area, share));
                }
            }
        }
        SolidShares { names, shares }
    }

    /// Names of the columns of the log.
    #[must_use]
    pub fn head(&self) -> String {
        self.names.iter().map(|n| format!(",{n} force_x,{n} force_y,{n} force_z")).collect()
    }

    /// The present forces.
    #[must_use]
    pub fn forces(&self, flow: &Flow<f64, D>, live: [usize; D], ambient: f64) -> Vec<SolidForce> {
        let named = self.names.iter().zip(&self.shares);
        let Some(solids) = Solids::of(flow) else {
            // All of the space is open: there is nothing to push.
            return named.map(|(name, _)| SolidForce { name: name.clone(), force: [0.0; 3] }).collect();
        };
        named
            .map(|(name, cells)| {
                let mut force = [0.0; 3];
                for &(cell, area, share) in cells {
                    let over = flow.get(cell).pressure - ambient;
                    let drag = if share > 0.0 { solids.drag(flow, cell) } else { [0.0; D] };
                    for (d, axis) in live.into_iter().enumerate() {
                        force[axis] += over * area[d] + share * drag[d];
                    }
                }
                SolidForce { name: name.clone(), force }
            })
            .collect()
    }
}
