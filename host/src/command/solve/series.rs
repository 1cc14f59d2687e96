//! What a run keeps of its steps: lines of `log.csv`, `probes.csv` and `monitors.csv`.

use super::arrays::position;
use super::case_file::CaseFile;
use super::checkpoint::{self, Journal};
use super::force::force_on_all;
use super::frames::{cell_at, point};
use super::monitors::{Monitor, MonitorReport, head, monitors, planes};
use super::output_keys::OutputKeys;
use super::setup::Setup;
use super::solids::{SolidForce, SolidShares};
use super::table::Table;
use crate::command::progress::Progress;
use crate::error::{Error, Result};
use crate::files::csv;
use crate::grid::Edges;
use std::collections::HashSet;
use std::fmt::Write as _;
use std::path::Path;

/// Columns of `log.csv`. Of floors: what they have changed so far, as sums of sizes; the momentum over all axes. Of forces: on all solids, now.
const LOG_HEAD: &str =
    "step,time,dt,mass,energy,max_mach,floors,floor_mass,floor_momentum,floor_energy,force_x,force_y,force_z";

/// Where a run looks at every step: known before anything is written.
#[derive(Debug)]
pub struct Watched<const D: usize> {
    /// The cells of the probes.
    probes: Vec<usize>,
    planes: Vec<Monitor<D>>,
}

impl<const D: usize> Watched<D> {
    /// The cells that the flow must watch for it.
    pub fn cells(&self) -> impl Iterator<Item = usize> {
        self.planes.iter().flat_map(Monitor::cells)
    }

    /// Checksums of where the probes and the planes are; 0 if there are none.
    fn places(&self) -> [u32; 2] {
        let sum = |cells: &mut dyn Iterator<Item = usize>| {
            let mut hasher = crc32fast::Hasher::new();
            cells.for_each(|cell| hasher.update(&(cell as u64).to_le_bytes()));
            hasher.finalize()
        };
        [sum(&mut self.probes.iter().copied()), sum(&mut self.planes.iter().flat_map(Monitor::places))]
    }

    /// Of a case; what lies in solids is told.
    ///
    /// # Errors
    /// A probe or a plane outside the grid, a name that is no name.
    pub fn new(file: &CaseFile, setup: &Setup<D>, progress: &mut Progress) -> Result<Self> {
        Ok(Watched { probes: probe_cells(file, setup, progress)?, planes: monitors(file, setup, progress)? })
    }
}

/// The tables of a run.
#[derive(Debug)]
pub struct Series<const D: usize> {
    log: Table,
    /// With the cells of the probes.
    probes: Option<(Table, Vec<usize>)>,
    monitors: Option<(Table, Vec<Monitor<D>>)>,
    /// What [`Watched::places`] tells; where there is nothing now, what it told when there was.
    places: [u32; 2],
    /// Steps between lines of the log.
    log_every: usize,
    /// Pressure that overpressures are counted from.
    ambient: f64,
}

impl<const D: usize> Series<D> {
    /// Of a run into a directory, new, or cut back to where a journal left them.
    ///
    /// # Errors
    /// A table cannot be written, or is shorter than the journal says.
    pub fn begin(
        dir: &Path,
        file: &CaseFile,
        setup: &Setup<D>,
        watched: Watched<D>,
        journal: &Journal,
        (log_every, ambient): (usize, f64),
    ) -> Result<Self> {
        let places = watched.places();
        for ((of, now), then) in ["output.probes", "output.monitors"].into_iter().zip(places).zip(journal.places) {
            if now != 0 && then != 0 && now != then {
                let reason = format!(
                    "is of a run with other {of}: leave all of them as they were, or take all of them out, or run without --resume"
                );
                return Err(Error::file(&dir.join(checkpoint::NAME), reason));
            }
        }
        let table = |name: &str, head: &str, of: &str, bytes: u64| match bytes {
            0 => Table::new(&dir.join(name), head),
            bytes => Table::resume(&dir.join(name), head, of, bytes),
        };
        let of_solids = setup.solids.as_ref().map_or_else(String::new, SolidShares::head);
        let log = table("log.csv", &format!("{LOG_HEAD}{of_solids}"), "output.forces", journal.log)?;
        let Watched { probes, planes } = watched;
        let probes = match probes.is_empty() {
            true => None,
            false => {
                let head = probe_head(&file.case.output, setup.flow.gas().is_mixed());
                Some((table("probes.csv", &head, "output.probes", journal.probes)?, probes))
            }
        };
        let monitors = match planes.is_empty() {
            true => None,
            false => Some((table("monitors.csv", &head(&planes), "output.monitors", journal.monitors)?, planes)),
        };
        // Tables that rest for a while go on at their places or not at all.
        let places = [0, 1].map(|n| if places[n] == 0 { journal.places[n] } else { places[n] });
        Ok(Series { log, probes, monitors, places, log_every, ambient })
    }

    /// Lines of a moment, reached by a step of `dt`; `forces` are those on the solids that are asked for.
    ///
    /// # Errors
    /// A table cannot be written.
    pub fn record(&mut self, setup: &Setup<D>, dt: f64, forces: &[SolidForce]) -> Result<()> {
        let flow = &setup.flow;
        if flow.steps.is_multiple_of(self.log_every) {
            let line = self.log_line(setup, dt, forces);
            self.log.line(&line)?;
        }
        let begin = || format!("{},{}", flow.steps, flow.time);
        if let Some((table, cells)) = &mut self.probes {
            let mut line = begin();
            cells.iter().for_each(|&cell| probe_columns(setup, cell, &mut line));
            table.line(&line)?;
        }
        if let Some((table, planes)) = &mut self.monitors {
            let mut line = begin();
            planes.iter().for_each(|plane| plane.line(flow, self.ambient, &mut line));
            table.line(&line)?;
        }
        Ok(())
    }

    /// The line of the last step, if the log would leave it out; a run that goes on goes on without it.
    ///
    /// # Errors
    /// The log cannot be written.
    pub fn end(&mut self, setup: &Setup<D>, dt: f64, forces: &[SolidForce]) -> Result<()> {
        if setup.flow.steps.is_multiple_of(self.log_every) {
            return Ok(());
        }
        let line = self.log_line(setup, dt, forces);
        self.log.line(&line)?;
        self.log.flush()
    }

    fn log_line(&self, setup: &Setup<D>, dt: f64, forces: &[SolidForce]) -> String {
        let (flow, across) = (&setup.flow, setup.edges.across(&setup.live));
        let content = flow.content();
        let of_energy =
            |energy: f64| if flow.gas().has_energy() { (energy * across).to_string() } else { String::new() };
        let (mass, energy, mach) = (content.density * across, of_energy(content.energy), flow.max_mach());
        let (steps, time) = (flow.steps, flow.time);
        let (floors, change) = (flow.total.floored, flow.total.floor_change);
        let momentum = change.momentum.iter().fold(0.0, |sum, m| sum + m) * across;
        let floor_energy = of_energy(change.energy);
        let [x, y, z] = force_on_all(flow, setup.live, &setup.free_sides).map(|force| force * across);
        let mut line = format!(
            "{steps},{time},{dt},{mass},{energy},{mach},{floors},{},{momentum},{floor_energy},{x},{y},{z}",
            change.density * across
        );
        for SolidForce { force: [x, y, z], .. } in forces {
            let _ = write!(line, ",{x},{y},{z}"); // a String takes anything
        }
        line
    }

    /// Puts all lines into the files, and their lengths into a journal.
    ///
    /// # Errors
    /// A table cannot be written.
    pub fn flush(&mut self, journal: &mut Journal) -> Result<()> {
        self.log.flush()?;
        (journal.log, journal.places) = (self.log.bytes(), self.places);
        if let Some((table, _)) = &mut self.probes {
            table.flush()?;
            journal.probes = table.bytes();
        }
        if let Some((table, _)) = &mut self.monitors {
            table.flush()?;
            journal.monitors = table.bytes();
        }
        Ok(())
    }

    /// The cells of the probes.
    pub fn probes(&self) -> impl Iterator<Item = &usize> {
        self.probes.iter().flat_map(|(_, cells)| cells)
    }

    /// What the planes came to.
    #[must_use]
    pub fn monitors(&self) -> Vec<MonitorReport> {
        self.monitors.iter().flat_map(|(_, planes)| planes).map(Monitor::report).collect()
    }
}

/// The columns of a probe, each after a comma; empty in a solid.
fn probe_columns<const D: usize>(setup: &Setup<D>, cell: usize, line: &mut String) {
    if setup.flow.open_volume(cell) == 0.0 {
        line.push_str(if setup.flow.gas().is_mixed() { ",,,,,," } else { ",,,,," });
        return;
    }
    let w = setup.flow.get(cell);
    let _ = write!(line, ",{}", w.density); // a String takes anything
    for axis in 0..3 {
        let u = setup.live.iter().position(|&a| a == axis).map_or(0.0, |d| w.velocity[d]);
        let _ = write!(line, ",{u}");
    }
    let _ = write!(line, ",{}", w.pressure);
    if setup.flow.gas().is_mixed() {
        let _ = write!(line, ",{}", setup.flow.gas_at(cell).gamma());
    }
}

/// Probes and planes have names, and places in the grid: told before a scene is measured, which may take long.
///
/// # Errors
/// One that has none.
pub fn check_watched(file: &CaseFile, edges: &Edges, live: &[usize]) -> Result<()> {
    probe_places(file, edges)?;
    planes(file, edges, live).map(drop)
}

/// The cells of the probes; those that are solid are told.
fn probe_cells<const D: usize>(file: &CaseFile, setup: &Setup<D>, progress: &mut Progress) -> Result<Vec<usize>> {
    let cells = probe_places(file, &setup.edges)?;
    for (n, (probe, cell)) in file.case.output.probes.iter().zip(&cells).enumerate() {
        if setup.flow.beta_v().is_some_and(|b| b[*cell] == 0.0) {
            let (at, name) = (&probe.at, probe.name(n));
            let reason = format!("the cell of the point {at:?} of \"{name}\" is solid: it has no values");
            progress.warn(file.remark(&format!("output.probes[{n}].at"), reason));
        }
    }
    Ok(cells)
}

/// The cells of the probes, solid or not.
fn probe_places(file: &CaseFile, edges: &Edges) -> Result<Vec<usize>> {
    let probes = &file.case.output.probes;
    let (mut cells, mut names) = (Vec::with_capacity(probes.len()), HashSet::new());
    for (n, probe) in probes.iter().enumerate() {
        let key = format!("output.probes[{n}]");
        let name = probe.name(n);
        file.column_name(&format!("{key}.name"), &name, &mut names)?;
        let at = point(edges, &probe.at)
            .map_err(|(at, why)| file.wrong(&format!("{key}.at{at}"), format!("\"{name}\": {why}")))?;
        cells.extend(cell_at(edges, at).map(|at| position(at, edges.cells())));
    }
    Ok(cells)
}

fn probe_head(output: &OutputKeys, mixed: bool) -> String {
    let gamma = mixed.then_some("gamma");
    let of_probe = |name: &str| {
        let columns = ["rho", "u", "v", "w", "p"].into_iter().chain(gamma);
        columns.map(|q| csv::cell(&format!("{name} {q}")).into_owned()).collect::<Vec<_>>().join(",")
    };
    let all = output.probes.iter().enumerate().map(|(n, p)| of_probe(&p.name(n)));
    ["step".to_owned(), "time".to_owned()].into_iter().chain(all).collect::<Vec<_>>().join(",")
}
