//! `report.json` of a flow, and its few lines for the terminal.

use super::case::GasKeys;
use super::case_file::CaseFile;
use super::checkpoint::Journal;
use super::force_peaks::{self, ForcePeak};
use super::limits::Limits;
use super::maxima::{Maxima, Peaks};
use super::monitors::MonitorReport;
use super::pictures::Colours;
use super::refine::{Compared, RefineCheck};
use super::region_report::RegionReport;
use super::setup::{Setup, SpaceReport};
use super::sides::PatchReport;
use super::solids::{OTHERS, SolidForce};
use super::stepping::two_digits;
use crate::command::progress::Progress;
use crate::command::version::{BUILD, Build};
use crate::grid::AXES;
use crate::words::{counted, written};
use serde::Serialize;
use std::collections::BTreeMap;
use voidage_core::flow::Gas;

/// Work of this session.
#[derive(Debug, Clone, Copy, Default)]
pub struct Done {
    /// Steps.
    pub steps: usize,
    /// Seconds of stepping, output aside.
    pub seconds: f64,
}

/// What a run came to.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    version: &'static str,
    build: Build,
    command: String,
    title: Option<String>,
    gas: GasReport,
    cells: [usize; 3],
    /// The axes that flow.
    axes: Vec<&'static str>,
    steps: usize,
    time: f64,
    /// The end that the case asks for, if it was not reached.
    #[serde(skip_serializing_if = "Option::is_none")]
    end_not_reached: Option<f64>,
    /// Of stepping, over all sessions.
    seconds: f64,
    /// Of this session from its start to this report: reading, setup, stepping, output.
    seconds_in_all: f64,
    /// Of this session.
    cell_updates_per_second: f64,
    /// Steps and seconds of stepping of this session.
    #[serde(skip)]
    session: Done,
    threads: usize,
    /// Mass in the domain at the end.
    mass: f64,
    /// (Mass at the end − at the beginning − what entered) / mass at the beginning.
    mass_drift: f64,
    /// The same of the energy; gravity does work besides. None for a barotropic gas.
    energy_drift: Option<f64>,
    /// Cells set to a floor, over all steps, and what that changed.
    floors: usize,
    floor_change: FloorChange,
    /// Cells whose reconstruction fell back to first order, over all steps.
    fallbacks: usize,
    /// Steps repeated with a smaller dt.
    repeated_steps: usize,
    /// Times of the frames.
    frames: Vec<f64>,
    /// Ends of the colours of pictures, if there are any.
    #[serde(skip_serializing_if = "Option::is_none")]
    colours: Option<Colours>,
    porosity: Option<SpaceReport>,
    /// How well the grid resolves the regions of the beginning.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    regions: Vec<RegionReport>,
    /// What patches on the sides came to.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    patches: Vec<PatchReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    maxima: Option<MaximaReport>,
    /// Planes whose flow was kept.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    monitors: Vec<MonitorReport>,
    /// Forces on solids at the end, and the largest over the run.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    forces: Vec<ForceReport>,
    /// The same case on half the cells.
    #[serde(skip_serializing_if = "Option::is_none")]
    refine_check: Option<RefineCheck>,
    skipped: Vec<String>,
    warnings: Vec<String>,
    /// Seconds of this session by stage.
    stages: BTreeMap<&'static str, f64>,
}

/// The gas by its model and the numbers of that model.
#[derive(Debug, Clone, Serialize)]
struct GasReport {
    model: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    gamma: Option<f64>,
    /// Lowest and highest of a mixed gas.
    #[serde(skip_serializing_if = "Option::is_none")]
    gammas: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    sound_speed: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rho: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    p: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    gas_constant: Option<f64>,
}

impl GasReport {
    fn new(file: &CaseFile, gas: Gas<f64>) -> Self {
        let gammas = if let Gas::Mixed { gammas } = gas { Some(gammas) } else { None };
        let GasKeys { model, gamma, sound_speed, rho, p, gas_constant } = file.case.gas;
        GasReport { model: model.word(), gamma, gammas, sound_speed, rho, p, gas_constant }
    }
}

/// Forces on the solids of a name.
#[derive(Debug, Clone, Serialize)]
struct ForceReport {
    /// At the end, along x, y and z, in N.
    force: [f64; 3],
    #[serde(flatten)]
    largest: ForcePeak,
}

/// Largest values over time.
#[derive(Debug, Clone, Serialize)]
struct MaximaReport {
    /// Pressure that overpressures are counted from.
    ambient: f64,
    /// Overpressure whose arrival is told.
    threshold: f64,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    probes: Vec<Peaks>,
}

/// What floors changed in the content of the domain: sums of the sizes of all changes.
#[derive(Debug, Clone, Serialize)]
struct FloorChange {
    mass: f64,
    /// Along x, y and z.
    momentum: [f64; 3],
    /// None for a barotropic gas.
    energy: Option<f64>,
}

impl Report {
    /// Of a run that has reached its end.
    #[must_use]
    pub fn new<const D: usize>(
        file: &CaseFile,
        setup: &Setup<D>,
        journal: &Journal,
        done: Done,
        progress: &Progress,
    ) -> Self {
        let (flow, across) = (&setup.flow, setup.edges.across(&setup.live));
        let content = flow.content();
        let entered = |of: fn(&voidage_core::flow::Conserved<f64, D>) -> f64| {
            flow.total.inflow.iter().flatten().map(of).sum::<f64>()
        };
        let drift = |now: f64, begin: f64, entered: f64| (now - begin - entered) / begin;
        let [mass, energy] = journal.begin;
        Report {
            version: env!("CARGO_PKG_VERSION"),
            build: BUILD,
            command: crate::command::stages::command_line(),
            title: file.case.title.clone(),
            gas: GasReport::new(file, flow.gas()),
            cells: setup.edges.cells(),
            axes: setup.live.iter().map(|&a| AXES[a]).collect(),
            steps: flow.steps,
            time: flow.time,
            end_not_reached: None,
            seconds: journal.seconds + done.seconds,
            seconds_in_all: progress.elapsed(),
            cell_updates_per_second: (flow.len() * done.steps) as f64 / done.seconds.max(1e-9),
            session: done,
            threads: rayon::current_num_threads(),
            mass: content.density * across,
            mass_drift: drift(content.density, mass, entered(|c| c.density)),
            energy_drift: flow.gas().has_energy().then(|| drift(content.energy, energy, entered(|c| c.energy))),
            floors: flow.total.floored,
            floor_change: FloorChange {
                mass: flow.total.floor_change.density * across,
                momentum: std::array::from_fn(|axis| {
                    setup
                        .live
                        .iter()
                        .position(|&a| a == axis)
                        .map_or(0.0, |d| flow.total.floor_change.momentum[d] * across)
                }),
                energy: flow.gas().has_energy().then_some(flow.total.floor_change.energy * across),
            },
            fallbacks: flow.total.first_order,
            repeated_steps: flow.repeated,
            frames: journal.frames.clone(),
            colours: None,
            porosity: setup.space,
            regions: setup.regions.clone(),
            patches: setup.patches.clone(),
            maxima: None,
            monitors: Vec::new(),
            forces: Vec::new(),
            refine_check: None,
            skipped: setup.skipped.clone(),
            warnings: progress.warnings.clone(),
            stages: progress.seconds.clone(),
        }
    }

    /// With the largest values over time, if they were kept, and those at the probes.
    #[must_use]
    pub fn with_maxima(self, maxima: Option<&Maxima>, probes: Vec<Peaks>) -> Self {
        let report = |m: &Maxima| MaximaReport { ambient: m.ambient, threshold: m.threshold, probes };
        Report { maxima: maxima.map(report), ..self }
    }

    /// With the end that the case asks for, if it was not reached.
    #[must_use]
    pub fn with_end(self, limits: &Limits) -> Self {
        Report { end_not_reached: limits.falls_short(self.time).then_some(limits.end), ..self }
    }

    /// With the ends of the colours of pictures, if there are any.
    #[must_use]
    pub fn with_colours(self, colours: Option<Colours>) -> Self {
        Report { colours, ..self }
    }

    /// With the planes whose flow was kept.
    #[must_use]
    pub fn with_monitors(self, monitors: Vec<MonitorReport>) -> Self {
        Report { monitors, ..self }
    }

    /// With the forces on solids at the end and the largest over the run, if they were asked for.
    #[must_use]
    pub fn with_forces(self, forces: Vec<SolidForce>, peaks: &[ForcePeak]) -> Self {
        let mut peaks = peaks.to_vec();
        force_peaks::take(&mut peaks, &forces, self.time);
        let of = |SolidForce { name, force }| {
            let largest = peaks.iter().find(|p| p.name == name)?.clone();
            Some(ForceReport { force, largest })
        };
        Report { forces: forces.into_iter().filter_map(of).collect(), ..self }
    }

    /// With what the case came to on half the cells.
    #[must_use]
    pub fn with_refine_check(self, check: RefineCheck) -> Self {
        Report { refine_check: Some(check), ..self }
    }

    /// A few lines for the terminal.
    pub fn say(&self, progress: &Progress) {
        let [nx, ny, nz] = self.cells;
        progress.say(format!(
            "grid          {nx} × {ny} × {nz} = {}, flow along {}",
            counted(nx * ny * nz, "cell", "cells"),
            self.axes.join(", ")
        ));
        if let Some(p) = &self.porosity {
            progress.say(format!(
                "porosity      {} closed, {} merged, {} with a jump; first step {:.2} of that in open space",
                counted(p.closed_cells, "cell", "cells"),
                p.merged_cells,
                counted(p.jump_faces, "face", "faces"),
                p.step_share
            ));
        }
        for (n, region) in self.regions.iter().enumerate() {
            if let Some(cells) = region.cells_per_radius {
                let key = format!("regions[{n}]");
                // As many as are printed count.
                let is_few = region.may_blast && (10.0 * cells).round() < 10.0 * ENOUGH_CELLS;
                let few = if is_few { FEW_CELLS } else { "" };
                let cut = if region.cut_by.is_empty() {
                    String::new()
                } else {
                    format!("; cut by {}", region.cut_by.join(", "))
                };
                progress.say(format!("{key:<14}{cells:.1} cells from its middle to its side{few}{cut}"));
            }
        }
        let short_of = |end| format!(", stopped by max_steps before the end at {} s", to_six_digits(end));
        let short = self.end_not_reached.map_or_else(String::new, short_of);
        progress.say(format!("steps         {} to t = {} s{short}", self.steps, to_six_digits(self.time)));
        let energy = self.energy_drift.map_or_else(String::new, |e| format!(", energy {}", two_digits(e)));
        progress.say(format!("drift         mass {}{energy}", two_digits(self.mass_drift)));
        progress.say(format!(
            "repairs       {} to first order, {}, {} repeated",
            counted(self.fallbacks, "fallback", "fallbacks"),
            counted(self.floors, "floor", "floors"),
            counted(self.repeated_steps, "step", "steps")
        ));
        if self.floors > 0 {
            let FloorChange { mass, momentum: [x, y, z], energy } = &self.floor_change;
            let energy = energy.map_or_else(String::new, |e| format!(", energy by {}", two_digits(e)));
            let [mass, x, y, z] = [*mass, *x, *y, *z].map(two_digits);
            let momentum = format!("({x}, {y}, {z})");
            progress.say(format!("floors        changed the mass by {mass}, the momentum by {momentum}{energy}"));
        }
        // Where all solids are asked for nothing acts on the others.
        let acts = |f: &&ForceReport| f.largest.name != OTHERS || f.largest.largest > 0.0;
        for ForceReport { force: [x, y, z], largest } in self.forces.iter().filter(acts) {
            let ForcePeak { name, largest, largest_time, .. } = largest;
            let [x, y, z, largest, at] = [*x, *y, *z, *largest, *largest_time].map(to_four_digits);
            progress.say(format!("force         ({x}, {y}, {z}) N on {name}; largest {largest} N at t = {at} s"));
        }
        if let Some(colours) = &self.colours {
            progress.say(format!("colours       {colours}"));
        }
        self.refine_check.iter().for_each(|check| say_refine_check(check, progress));
        progress.say(format!("time          {}", self.times()));
    }

    /// What the run took; of one that went on, what this session took and what all did.
    fn times(&self) -> String {
        let (Done { steps, seconds }, all) = (self.session, self.seconds_in_all);
        let speed = format!("{:.2} million cell updates/s", self.cell_updates_per_second / 1e6);
        match steps == self.steps {
            true => format!("{seconds:.3} s of stepping, {speed}; {all:.3} s in all"),
            false if steps == 0 => {
                format!("{all:.3} s, no step was left to do; {:.3} s of stepping in the sessions before", self.seconds)
            }
            false => format!(
                "{seconds:.3} s of stepping in this session ({}), {speed}; {all:.3} s in all; {:.3} s of stepping with the sessions before",
                counted(steps, "step", "steps"),
                self.seconds
            ),
        }
    }
}

/// Fewer cells per radius than this are few for a blast: at 10 it loses 14 to 25 % of its largest overpressure (`docs/case.md`), with fewer more.
const ENOUGH_CELLS: f64 = 8.0;

/// What is said of a region of fewer.
const FEW_CELLS: &str = ": few for a blast, whose peaks come out too low; --refine-check tells by how much";

/// The largest values of both runs, a line a place.
fn say_refine_check(RefineCheck { cells: [nx, ny, nz], peaks, .. }: &RefineCheck, progress: &Progress) {
    progress.say(format!("refine check  peaks here, on {nx} × {ny} × {nz} cells, and the change between both"));
    let widest = peaks.iter().map(|peak| peak.name.chars().count()).fold(10, usize::max) + 2;
    for peak in peaks {
        if peak.overpressure.fine.is_nan() && peak.overpressure.coarse.is_nan() {
            progress.say(format!("  {:<widest$}in a solid, on both grids", peak.name));
            continue;
        }
        let value = |x: f64| if x.is_nan() { "in a solid".to_owned() } else { format!("{x:.4e}") };
        let of = |name: &str, unit: &str, Compared { fine, coarse, change }: Compared| {
            let change = match change {
                None => "–".to_owned(),
                Some(c) if c.abs() > 1.0 => "not alike: too coarse, or the wave has not come".to_owned(),
                Some(c) => format!("{:+.1} %", (1000.0 * c).round() / 10.0 + 0.0),
            };
            format!("{name} {}, {} {unit} ({change})", value(fine), value(coarse))
        };
        let pressure = of("overpressure", "Pa", peak.overpressure);
        progress.say(format!("  {:<widest$}{pressure}; {}", peak.name, of("impulse", "Pa s", peak.impulse)));
    }
}

fn to_six_digits(x: f64) -> String {
    written(format!("{x:.5e}").parse().unwrap_or(x))
}

fn to_four_digits(x: f64) -> String {
    written(format!("{x:.3e}").parse().unwrap_or(x) + 0.0) // no −0
}
