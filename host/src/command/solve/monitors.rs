//! Planes across the flow: how much passes them, and the overpressure there.
//!
//! A plane consists of faces of the grid. The mass that passes them is that of the step, so that its sum over time is what the content on both sides of the
//! plane gains and loses, to rounding; the volume is that of the gas where it comes from. Pressures are means of both cells beside a face.

use super::arrays::{index, position};
use super::case_file::CaseFile;
use super::output_keys::MonitorKeys;
use super::regions::Region;
use super::setup::Setup;
use crate::command::progress::Progress;
use crate::error::Result;
use crate::files::csv;
use crate::flow::Flow;
use crate::grid::{AXES, Edges};
use crate::words::counted;
use serde::Serialize;
use std::collections::HashSet;
use std::fmt::Write as _;

/// A plane whose flow is kept.
#[derive(Debug)]
pub struct Monitor<const D: usize> {
    report: MonitorReport,
    /// Axis among those that flow.
    d: usize,
    /// It lies on a side of the domain that is a wall, some patches perhaps aside.
    is_wall: bool,
    /// Open faces.
    faces: Vec<Face>,
}

/// An open face of a plane.
#[derive(Debug)]
struct Face {
    /// The cells below and above, the same twice at a side of the domain that is not periodic.
    cells: [usize; 2],
    /// The face is on the low (0) or high (1) side of the second of them.
    side: usize,
    /// Its open area, in m².
    area: f64,
    /// Its whole area.
    section: f64,
}

/// What a plane came to.
#[derive(Debug, Clone, Serialize)]
pub struct MonitorReport {
    /// Its name.
    pub name: String,
    /// The axis across it.
    pub axis: &'static str,
    /// Its place along that axis, in m.
    pub at: f64,
    /// Open faces.
    pub faces: usize,
    /// Their open area, in m².
    pub area: f64,
}

/// Quantities of a plane: names of columns after its own.
const QUANTITIES: [&str; 4] = ["mass_flow", "volume_flow", "overpressure", "largest_overpressure"];

/// Names of the columns of `monitors.csv`.
#[must_use]
pub fn head<const D: usize>(monitors: &[Monitor<D>]) -> String {
    let of = |m: &Monitor<D>| QUANTITIES.map(|q| format!(",{}", csv::cell(&format!("{} {q}", m.report.name)))).concat();
    format!("step,time{}", monitors.iter().map(of).collect::<String>())
}

/// The planes of a case in a flow; one through solids alone is told.
///
/// # Errors
/// A plane that is none, lies outside the grid or across an axis of one cell, or has the name of another.
pub fn monitors<const D: usize>(file: &CaseFile, setup: &Setup<D>, progress: &mut Progress) -> Result<Vec<Monitor<D>>> {
    let all = planes(file, &setup.edges, &setup.live)?.into_iter().map(|plane| Monitor::new(plane, setup));
    let all: Vec<Monitor<D>> = all.collect();
    // The cluster of each cell, from 1.
    let mut clusters = vec![0_usize; if all.is_empty() { 0 } else { setup.flow.len() }];
    for (n, cells) in setup.flow.clusters().iter().enumerate().filter(|_| !all.is_empty()) {
        cells.iter().for_each(|&cell| clusters[cell] = n + 1);
    }
    for (n, monitor) in all.iter().enumerate() {
        let cut = monitor.faces_within(&clusters);
        if cut > 0 {
            let reason = format!(
                "\"{}\" passes between merged cells (at {}): what these even out among themselves is not counted, and the flow \
                 through it can be off by some per cent; a plane beside them or porosity.merge = false tells it",
                monitor.report.name,
                counted(cut, "face", "faces")
            );
            progress.warn(file.remark(&format!("output.monitors[{n}]"), reason));
        }
    }
    for (n, monitor) in all.iter().enumerate().filter(|(_, monitor)| monitor.faces.is_empty()) {
        let why = if monitor.is_wall { ", it lies on a wall of the domain" } else { "" };
        let reason = format!("\"{}\" has no open face{why}: nothing passes it", monitor.report.name);
        progress.warn(file.remark(&format!("output.monitors[{n}]"), reason));
    }
    Ok(all)
}

/// Where a plane of a case lies.
#[derive(Debug)]
pub struct Plane {
    name: String,
    axis: usize,
    /// Axis among those that flow.
    d: usize,
    /// The plane of the grid that is next to it.
    index: usize,
    /// Faces count whose middles it holds.
    window: Region,
}

/// The planes of a case on a grid of which the axes `live` flow.
///
/// # Errors
/// As [`monitors`].
pub fn planes(file: &CaseFile, edges: &Edges, live: &[usize]) -> Result<Vec<Plane>> {
    let (mut all, mut names) = (Vec::new(), HashSet::new());
    for (n, keys) in file.case.output.monitors.iter().enumerate() {
        let key = format!("output.monitors[{n}]");
        let name = keys.name.clone().unwrap_or_else(|| format!("monitor {}", n + 1));
        file.column_name(&format!("{key}.name"), &name, &mut names)?;
        all.push(Plane::new(file, &key, name, keys, (edges, live))?);
    }
    Ok(all)
}

impl Plane {
    fn new(
        file: &CaseFile,
        key: &str,
        name: String,
        keys: &MonitorKeys,
        (edges, live): (&Edges, &[usize]),
    ) -> Result<Self> {
        let given: Vec<(usize, f64)> =
            [keys.x, keys.y, keys.z].into_iter().enumerate().filter_map(|(a, at)| Some((a, at?))).collect();
        let [(axis, at)] = given[..] else {
            let takes = if given.is_empty() { "needs one of" } else { "takes only one of" };
            return Err(file.wrong(key, format!("{takes} x, y and z: the place of the plane along that axis")));
        };
        let wrong = |reason: String| Err(file.wrong(&format!("{key}.{}", AXES[axis]), reason));
        let Some(d) = live.iter().position(|&a| a == axis) else {
            return wrong("the axis has one cell: nothing flows along it".into());
        };
        if let Some(reason) = edges.misses(axis, at) {
            return wrong(reason);
        }
        let window = Region::of_box(file, key, &keys.min, &keys.max)?;
        Ok(Plane { name, axis, d, index: nearest(&edges.0[axis], at), window })
    }
}

impl<const D: usize> Monitor<D> {
    fn new(Plane { name, axis, d, index: plane, window }: Plane, setup: &Setup<D>) -> Self {
        let Setup { flow, edges, live, .. } = setup;
        let faces = faces(flow, edges, (axis, d, plane), *live, &window);
        let area = faces.iter().map(|face| face.area).sum::<f64>() + 0.0; // of none not −0
        let side = [0, edges.cells()[axis]].iter().position(|end| *end == plane);
        let is_wall = side.is_some_and(|side| flow.boundaries[d][side].is_wall());
        let report = MonitorReport { name, axis: AXES[axis], at: edges.0[axis][plane], faces: faces.len(), area };
        Monitor { report, d, is_wall, faces }
    }

    /// At how many faces it passes between cells of one cluster, by the number of each cell's, 0 for none.
    fn faces_within(&self, clusters: &[usize]) -> usize {
        let within = |[low, high]: [usize; 2]| low != high && clusters[low] != 0 && clusters[low] == clusters[high];
        self.faces.iter().filter(|face| within(face.cells)).count()
    }

    /// Numbers that tell its faces from those of any other plane.
    pub fn places(&self) -> impl Iterator<Item = usize> {
        let of_face = |face: &Face| [face.cells[0], face.cells[1], face.side];
        std::iter::once(self.d).chain(self.faces.iter().flat_map(of_face))
    }

    /// What it came to.
    #[must_use]
    pub fn report(&self) -> MonitorReport {
        self.report.clone()
    }

    /// The cells above its faces; below them, where the plane is the high side of the domain.
    pub fn cells(&self) -> impl Iterator<Item = usize> {
        self.faces.iter().map(|face| face.cells[1])
    }

    /// The columns of a moment, each after a comma: mass and volume that pass upwards along the axis in a second, mean overpressure over the
    /// open area, largest overpressure.
    pub fn line(&self, flow: &Flow<f64, D>, ambient: f64, line: &mut String) {
        let (mut mass, mut volume, mut force, mut largest) = (0.0, 0.0, 0.0, f64::NEG_INFINITY);
        let (watched, pushes) = flow.watched_walls();
        for Face { cells, side, area, section } in &self.faces {
            let states = cells.map(|cell| flow.get(cell));
            let place = watched.binary_search(&cells[1]);
            let passing = place.map_or(0.0, |place| pushes[place].mass[self.d][*side] * section);
            mass += passing;
            let comes_in = cells[0] == cells[1] && (passing > 0.0) == (*side == 0);
            let density = if comes_in {
                let beside = flow.stands(self.d, *side, flow.coordinates(cells[1]));
                beside.ghost_cell(&states[1], self.d, *side == 0, flow.gas_at(cells[1])).density
            } else {
                states[usize::from(passing < 0.0)].density
            };
            volume += if passing == 0.0 { 0.0 } else { passing / density };
            let over = 0.5 * (states[0].pressure + states[1].pressure) - ambient;
            force += area * over;
            largest = over.max(largest);
        }
        if self.faces.is_empty() {
            line.push_str(",0,0,,");
        } else {
            let _ = write!(line, ",{mass},{volume},{},{largest}", force / self.report.area); // a String takes anything
        }
    }
}

/// The plane of the grid next to a place.
fn nearest(edges: &[f64], at: f64) -> usize {
    let above = edges.partition_point(|e| *e < at).min(edges.len() - 1);
    if above > 0 && at - edges[above - 1] <= edges[above] - at { above - 1 } else { above }
}

/// The open faces of a plane of the grid whose middles lie in a window: cells beside them, and open areas. A wall at a side of the domain closes its faces.
fn faces<const D: usize>(
    flow: &Flow<f64, D>,
    edges: &Edges,
    (axis, d, plane): (usize, usize, usize),
    live: [usize; D],
    window: &Region,
) -> Vec<Face> {
    let shape = edges.cells();
    let across = edges.across(&live);
    let open = flow.faces().nth(d);
    let last = shape[axis] - 1;
    let is_periodic = flow.boundaries[d][0].is_periodic();
    // The last plane of a periodic axis is the first.
    let plane = if is_periodic && plane > last { 0 } else { plane };
    let (low, high) = if is_periodic && plane == 0 { (last, 0) } else { (plane.saturating_sub(1), plane.min(last)) };
    let mut all = Vec::new();
    let within = |a: usize, i: usize| {
        let middle = f64::midpoint(edges.0[a][i], edges.0[a][i + 1]);
        a == axis || (window.extent(a)[0] <= middle && middle <= window.extent(a)[1])
    };
    for cell in (0..flow.len()).filter(|&cell| index(cell, shape)[axis] == high) {
        let at = index(cell, shape);
        if !(0..3).all(|a| within(a, at[a])) {
            continue;
        }
        let (here, mut below) = (live.map(|a| at[a]), at);
        below[axis] = low;
        let (side, section) = (usize::from(plane > high), flow.area(d, here) * across);
        let share = open.map_or(1.0, |open| open[flow.face(d, here, side)]);
        let is_wall = (plane == 0 || plane > high) && flow.stands(d, side, here).is_wall();
        if share > 0.0 && !is_wall {
            all.push(Face { cells: [position(below, shape), cell], side, area: share * section, section });
        }
    }
    all
}
