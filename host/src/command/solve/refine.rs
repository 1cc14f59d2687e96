//! `--refine-check`: the same case on half the cells along each axis that flows, and the largest values of both runs side by side.

use super::arrays::position;
use super::case_file::CaseFile;
use super::charges::Charges;
use super::frames::{cell_at, point};
use super::maxima::{Maxima, Peaks};
use super::output_keys::MaximaKeys;
use super::setup::setup;
use super::stepping::step;
use crate::command::cli::TalkArgs;
use crate::command::interrupt;
use crate::command::progress::{Meter, Progress};
use crate::error::{Error, Result};
use crate::grid::{AXES, Edges};
use crate::picture::ticks::measure;
use crate::words::written;
use serde::Serialize;
use std::fmt::Display;

/// Fewest cells along an axis that can be halved.
const FEWEST: usize = 4;

/// Names under which the largest values of all open cells are told, and of those outside the regions that a blast starts from.
const ANYWHERE: [&str; 2] = ["anywhere", "outside the starting regions"];

/// What both runs found.
#[derive(Debug, Clone, Serialize)]
pub struct RefineCheck {
    /// Cells of the coarse run.
    pub cells: [usize; 3],
    /// Its steps.
    pub steps: usize,
    /// Of all open cells outside the regions that a blast starts from, then of each probe.
    pub peaks: Vec<ComparedPeaks>,
    /// Open areas of the patches, in m².
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub patches: Vec<Compared>,
}

/// Patches whose areas differ by more than this share make another case.
const SAME_AREA: f64 = 0.02;

impl RefineCheck {
    /// Says which patches are not the same on half the cells: what the runs differ by is then not the cells alone.
    pub fn warn_of_patches(&self, file: &CaseFile, progress: &mut Progress) {
        let differs = |area: &Compared| (area.fine - area.coarse).abs() > SAME_AREA * area.fine.max(area.coarse);
        for (n, area) in self.patches.iter().enumerate().filter(|(_, area)| differs(area)) {
            let reason = format!(
                "has {} m² on the cells of the case and {} m² on half of them: the runs of --refine-check differ by that, too; with its sides in \
                 planes of both grids they would not",
                measure(area.fine),
                measure(area.coarse)
            );
            progress.warn(file.remark(&format!("boundary.patch[{n}]"), reason));
        }
    }
}

/// Largest values in one place.
#[derive(Debug, Clone, Serialize)]
pub struct ComparedPeaks {
    /// Name of the probe, or what tells that these are the largest of all cells.
    pub name: String,
    /// Of p − p₀.
    pub overpressure: Compared,
    /// Of its integral over time.
    pub impulse: Compared,
    /// Of ½ ρ |u|².
    pub dynamic_pressure: Compared,
}

/// A value on the cells of the case and on half of them.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Compared {
    /// On the cells of the case; NaN at a point that lies in a solid there, which is null in a file.
    pub fine: f64,
    /// On half of them, likewise.
    pub coarse: f64,
    /// (fine − coarse) / fine; none if that is no number.
    pub change: Option<f64>,
}

impl Compared {
    fn new(fine: f64, coarse: f64) -> Self {
        Compared { fine, coarse, change: Some((fine - coarse) / fine).filter(|c| c.is_finite()) }
    }
}

/// Can the case be run on half the cells?
///
/// # Errors
/// It takes fields from files, or has too few cells; told before the first run begins.
pub fn check(file: &CaseFile, edges: &Edges, live: &[usize]) -> Result<()> {
    let case = &file.case;
    let from_files = [
        ("porosity.from", case.porosity.from.is_some()),
        ("initial.from", case.initial.from.is_some()),
        ("drag.from", case.drag.from.is_some()),
    ];
    if let Some((key, _)) = from_files.iter().find(|(_, given)| *given) {
        return Err(file.wrong(key, "has arrays for the cells of the case; --refine-check needs half of them"));
    }
    let cells = edges.cells();
    match live.iter().find(|&&axis| cells[axis] < FEWEST) {
        Some(&axis) => {
            let axis = AXES[axis];
            Err(file.wrong("grid", format!("has fewer than {FEWEST} cells along {axis}; --refine-check halves them")))
        }
        None => Ok(()),
    }
}

/// Every second edge of the axes that flow, and the last.
fn coarser(edges: &Edges, live: &[usize]) -> Edges {
    let mut coarse = edges.clone();
    for &axis in live {
        let fine = &edges.0[axis];
        coarse.0[axis] = fine[..fine.len() - 1].iter().step_by(2).chain(fine.last()).copied().collect();
    }
    coarse
}

/// What the run on all cells found.
#[derive(Debug)]
pub struct Fine<'a> {
    /// Its cells.
    pub edges: &'a Edges,
    /// Their open fractions.
    pub beta_v: Option<&'a [f64]>,
    /// Its largest values.
    pub maxima: &'a Maxima,
    /// The same at each probe.
    pub probes: Vec<Peaks>,
    /// Open areas of its patches.
    pub patches: Vec<f64>,
}

/// Runs the case on half the cells to the time `end`, and compares with the largest values of the run on all. Where a blast starts, in whichever cells of the
/// coarse grid, both leave them out: the pressure of the beginning is the same on any grid.
///
/// # Errors
/// The coarse run fails, or is interrupted.
pub fn run<const D: usize>(
    file: &CaseFile,
    live: [usize; D],
    fine: Fine<'_>,
    end: f64,
    line: &Meter,
) -> Result<RefineCheck> {
    let edges = coarser(fine.edges, &live);
    // What there is to warn of has been said of the cells of the case.
    let mut silent = Progress::new(&TalkArgs { quiet: true, verbose: false });
    let mut setup = setup(file, &edges, live, &mut silent)?;
    let (usual, ambient) = (MaximaKeys::default(), fine.maxima.ambient);
    let charges = Charges::new(file, &setup.flow, &edges, ambient)?;
    let mut maxima = Maxima::new(file.case.output.maxima.as_ref().unwrap_or(&usual), ambient, &setup.flow);
    while setup.flow.time < end {
        let ended = |reason: &dyn Display| {
            let kept = "the run on all cells is finished, and its results are written";
            Error::new(format!("--refine-check, on half the cells: {reason}; {kept}"))
        };
        if interrupt::asked() {
            let (steps, time) = (setup.flow.steps, written(setup.flow.time));
            return Err(ended(&format!("interrupted at step {steps}, t = {time}")));
        }
        step(&mut setup, Some(&mut maxima), end).map_err(|trouble| ended(&trouble))?;
        if line.is_due() {
            line.tell(&format!("half the cells: step {}  t = {:.4e} s", setup.flow.steps, setup.flow.time));
        }
    }
    let probes = file.case.output.probes.iter().enumerate().filter_map(|(n, probe)| {
        let at = cell_at(&edges, point(&edges, &probe.at).ok()?)?;
        Some(maxima.peaks(probe.name(n), position(at, edges.cells()), setup.flow.beta_v()))
    });
    let of_fine = charges.finer(edges.cells(), fine.edges.cells(), &live, fine.beta_v);
    let coarse = std::iter::once(anywhere(&maxima, setup.flow.beta_v(), &charges)).chain(probes);
    let areas = fine.patches.iter().zip(&setup.patches).map(|(&fine, coarse)| Compared::new(fine, coarse.area));
    let patches = areas.collect();
    let fine = std::iter::once(anywhere(fine.maxima, fine.beta_v, &of_fine)).chain(fine.probes);
    let peaks = fine.zip(coarse).map(|(fine, coarse)| ComparedPeaks {
        overpressure: Compared::new(fine.overpressure, coarse.overpressure),
        impulse: Compared::new(fine.impulse, coarse.impulse),
        dynamic_pressure: Compared::new(fine.dynamic_pressure, coarse.dynamic_pressure),
        name: fine.name,
    });
    Ok(RefineCheck { cells: edges.cells(), steps: setup.flow.steps, peaks: peaks.collect(), patches })
}

/// The largest values of all open cells outside these charges.
fn anywhere(maxima: &Maxima, beta_v: Option<&[f64]>, charges: &Charges) -> Peaks {
    maxima.greatest(ANYWHERE[usize::from(!charges.is_empty())].to_owned(), beta_v, charges)
}
