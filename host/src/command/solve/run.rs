//! `voidage solve`: case → setup → steps → files.

use super::case::side_word;
use super::case_file::CaseFile;
use super::charges::Charges;
use super::checkpoint::{self, Fingerprint, Journal};
use super::force_peaks;
use super::frames::{self, Snapshot, create};
use super::inlet::Shortfall;
use super::limits::Limits;
use super::lock::Lock;
use super::maxima::{Maxima, Peaks, lowest_pressure};
use super::output_keys::{Format, OutputKeys};
use super::pictures::{self, Pictures};
use super::refine::{self, Fine};
use super::report::{Done, Report};
use super::series::{Series, Watched, check_watched};
use super::setup::{Setup, live_axes, setup};
use super::solids::SolidForce;
use super::stepping::{Trouble, step, unphysical};
use crate::command::cli::SolveArgs;
use crate::command::interrupt;
use crate::command::progress::{Meter, Progress, print};
use crate::command::stages::threads;
use crate::command::streams::{check_directory, is_stream};
use crate::command::template;
use crate::error::{Error, Result};
use crate::files::json;
use crate::grid::Edges;
use crate::picture::ticks::number as short;
use crate::words::{counted, written};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// `voidage solve`.
///
/// # Errors
/// Anything that keeps it from writing all that the case asks for; an interrupt.
pub fn solve(args: &SolveArgs) -> Result<()> {
    let Some(path) = args.case.as_deref().filter(|_| !args.template) else {
        return print(template::CASE.as_bytes());
    };
    let mut progress = Progress::new(&args.talk);
    let mut file = CaseFile::read(path)?;
    if args.refine_check {
        file.case.output.maxima.get_or_insert_default();
    }
    let mut remarks = Vec::new();
    let edges = file.edges(&mut remarks)?;
    remarks.into_iter().for_each(|r| progress.warn(r));
    let dir = match (&args.output, path.file_stem().filter(|_| !is_stream(path))) {
        (Some(dir), _) => dir.clone(),
        (None, Some(stem)) => PathBuf::from(stem),
        (None, None) => return Err(Error::usage("give an output directory with -o")),
    };
    if args.output.is_none() && dir.as_path() == path {
        return Err(Error::file(path, "results would go into a directory of the name of the case itself: give -o DIR"));
    }
    check_directory(
        if args.output.is_some() { "-o" } else { "the results, named like the case (-o gives another)" },
        &dir,
    )?;
    pictures::check(&file, &edges)?;
    keep_inputs(&file, &dir)?;
    keep_places(&dir)?;
    let live = live_axes(&edges);
    check_watched(&file, &edges, &live)?;
    if args.refine_check {
        refine::check(&file, &edges, &live)?;
    }
    // Held while the case is set up, so that of two runs the later one is told at once.
    let lock = Lock::take(&dir)?;
    keep_results(&dir, args)?;
    threads(args.threads)?.install(|| match live[..] {
        [a] => run(&file, &edges, [a], (dir, lock), args, progress),
        [a, b] => run(&file, &edges, [a, b], (dir, lock), args, progress),
        [a, b, c] => run(&file, &edges, [a, b, c], (dir, lock), args, progress),
        _ => Ok(()), // there are one to three
    })
}

/// Name of the report, which a run writes last: where it is, the run is finished.
const REPORT: &str = "report.json";

/// A finished run is not replaced unless that is asked for, and what goes on has begun.
fn keep_results(dir: &Path, args: &SolveArgs) -> Result<()> {
    if args.resume {
        return checkpoint::expect(dir);
    }
    if args.force || !dir.join(REPORT).exists() {
        return Ok(());
    }
    let reason = "holds a finished run: --force replaces it, --resume goes on from its end, -o DIR takes another place";
    Err(Error::file(dir, reason))
}

/// Makes way for a run whose case is right: what a finished one left is removed, of an unfinished one the last state is kept, and tables of neither, too.
fn make_way(dir: &Path, progress: &mut Progress) -> Result<()> {
    let report = dir.join(REPORT);
    if report.exists() {
        frames::remove_old(dir)?;
        Maxima::forget(&dir.join("maxima"))?;
        for name in ["probes.csv", "monitors.csv", frames::SERIES] {
            frames::forget(&dir.join(name))?;
        }
        return frames::forget(&report);
    }
    // Those of a finished run that had gone on.
    Maxima::forget(&dir.join("maxima"))?;
    frames::forget(&dir.join(frames::SERIES))?;
    let kept = checkpoint::put_aside(dir)?;
    let dir = dir.display();
    match &kept[..] {
        [] => {}
        [checkpoint::BEFORE, ..] => progress.warn(format!(
            "{dir}: held a run that had not ended; its last state is kept in {}, its frames and tables beside it as *_before",
            checkpoint::BEFORE
        )),
        tables => progress.warn(format!("{dir}: held tables of no run; they are kept as {}", tables.join(", "))),
    }
    Ok(())
}

/// States that a run writes must not replace the one that it begins from.
fn keep_inputs(file: &CaseFile, dir: &Path) -> Result<()> {
    let from = file.case.initial.from.as_ref().and_then(|from| file.resolve(from).canonicalize().ok());
    let is_ours = |name: &str| dir.join(name).canonicalize().is_ok_and(|own| from.iter().any(|p| p.starts_with(&own)));
    match DIRECTORIES.into_iter().any(is_ours) {
        true => Err(file.wrong("initial.from", format!("would be replaced by the results in {}", dir.display()))),
        false => Ok(()),
    }
}

/// Names of the directories that a run writes into.
const DIRECTORIES: [&str; 3] = ["final", "frames", "maxima"];

/// No file stands where a directory is to be.
fn keep_places(dir: &Path) -> Result<()> {
    let mut places = DIRECTORIES.into_iter().map(|name| dir.join(name));
    match places.find(|place| place.exists() && !place.is_dir()) {
        Some(file) => Err(Error::file(&file, "is a file, and results would go into a directory of this name")),
        None => Ok(()),
    }
}

fn run<const D: usize>(
    file: &CaseFile,
    edges: &Edges,
    live: [usize; D],
    (dir, lock): (PathBuf, Option<Lock>),
    args: &SolveArgs,
    mut progress: Progress,
) -> Result<()> {
    let limits = Limits::new(file)?;
    let setup = progress.stage("setup", |p| setup(file, edges, live, p))?;
    let mut run = Run::begin(file, setup, limits, (dir, lock), args, &mut progress)?;
    let stepped = {
        let _watch = interrupt::Watch::new();
        progress.stage("steps", |p| run.steps(&p.line()))
    };
    stepped?;
    run.warn_of_inlets(file, &mut progress);
    run.warn_of_an_end_not_reached(file, &mut progress);
    run.warn_of_a_threshold_not_met(file, &mut progress);
    progress.stage("output", |_| run.last())?;
    let report = |run: &Run<D>, progress: &Progress| {
        let report = Report::new(file, &run.setup, &run.journal, run.done, progress).with_end(&run.limits);
        let report = report.with_maxima(run.maxima.as_ref(), run.peaks(file)).with_monitors(run.series.monitors());
        let report = report.with_forces(run.forces(), &run.journal.peaks);
        report.with_colours(run.pictures.as_ref().map(Pictures::colours))
    };
    let mut summary = report(&run, &progress);
    json::write(&run.dir.join(REPORT), &summary)?;
    if let Some(maxima) = run.maxima.as_ref().filter(|_| args.refine_check) {
        let (beta_v, probes, end) = (run.setup.flow.beta_v(), run.peaks(file), run.setup.flow.time);
        let patches = run.setup.patches.iter().map(|patch| patch.area).collect();
        let fine = Fine { edges, beta_v, maxima, probes, patches };
        let _watch = interrupt::Watch::new();
        let checked = progress.stage("refine-check", |p| refine::run(file, live, fine, end, &p.line()))?;
        checked.warn_of_patches(file, &mut progress);
        summary = report(&run, &progress).with_refine_check(checked);
        json::write(&run.dir.join(REPORT), &summary)?;
    }
    summary.say(&progress);
    Ok(())
}

/// A run in progress.
struct Run<'a, const D: usize> {
    setup: Setup<D>,
    limits: Limits,
    dir: PathBuf,
    output: &'a OutputKeys,
    fingerprint: Fingerprint,
    journal: Journal,
    /// Its tables.
    series: Series<D>,
    pictures: Option<Pictures>,
    maxima: Option<Maxima>,
    done: Done,
    /// The checkpoint on disk is from before the first floor.
    untouched: bool,
    _lock: Option<Lock>,
}

impl<'a, const D: usize> Run<'a, D> {
    fn begin(
        file: &'a CaseFile,
        mut setup: Setup<D>,
        limits: Limits,
        (dir, lock): (PathBuf, Option<Lock>),
        args: &SolveArgs,
        progress: &mut Progress,
    ) -> Result<Self> {
        let output = &file.case.output;
        let ambient = ambient(file, &setup);
        warn_of_low_ambient(file, ambient, progress);
        let mut maxima = maxima(file, &setup, ambient);
        let fingerprint = fingerprint(&setup, maxima.as_ref(), ambient);
        let watched = Watched::new(file, &setup, progress)?;
        let cells = setup.pushed.iter().copied().chain(watched.cells()).collect();
        setup.flow.watch_walls(cells, ambient);
        let pictures = pictures(file, &setup, ambient, progress)?;
        let lock = match lock {
            Some(lock) => Some(lock),
            // There was no directory when the run began; since then another may have come.
            None => {
                let lock = Lock::take(&dir)?;
                keep_results(&dir, args)?;
                lock
            }
        };
        let journal = if args.resume {
            checkpoint::resume(&dir.join(checkpoint::NAME), &fingerprint, &mut setup, maxima.as_mut())?
        } else {
            let journal = first_journal(file, &mut setup)?;
            make_way(&dir, progress)?;
            journal
        };
        create(&dir)?;
        let lock = lock.map_or_else(|| Lock::take(&dir), |lock| Ok(Some(lock)))?;
        if !output.formats().is_empty() {
            create(&dir.join("frames"))?;
        }
        let series = Series::begin(&dir, file, &setup, watched, &journal, (limits.log_every, ambient))?;
        let (begun, done, untouched) = (journal.log > 0, Done::default(), setup.flow.total.floored == 0);
        let mut run = Run {
            setup,
            limits,
            dir,
            output,
            fingerprint,
            journal,
            series,
            pictures,
            maxima,
            done,
            untouched,
            _lock: lock,
        };
        run.own_planes(progress)?;
        if args.resume {
            run.warn_of_an_end_before(file, progress);
            if run.goes_on() {
                // A report tells that a run is finished.
                frames::forget(&run.dir.join(REPORT))?;
            }
        }
        if !begun {
            frames::forget(&run.dir.join(checkpoint::UNTOUCHED))?;
            run.record(0.0)?;
            run.frame()?;
            run.checkpoint()?;
        }
        Ok(run)
    }

    /// Planes that are kept of frames before are drawn again: they are this run's, cut where it cuts, or they go.
    fn own_planes(&mut self, progress: &mut Progress) -> Result<()> {
        let Some(at) = self.pictures.as_ref().map(Pictures::at) else { return Ok(()) };
        let before = self.journal.cut.replace(at);
        if before == Some(at) {
            return Ok(());
        }
        if let (Some(_), Some(last)) = (before, self.journal.frames.last()) {
            let last = written(*last);
            progress.warn(format!(
                "pictures are cut elsewhere than before --resume: those up to t = {last} keep their planes and colours"
            ));
        }
        frames::forget_planes(&self.dir)
    }

    /// A run that is resumed may have gone beyond the end that its case has now.
    fn warn_of_an_end_before(&self, file: &CaseFile, progress: &mut Progress) {
        if self.setup.flow.time > self.limits.end {
            let (time, end) = (written(self.setup.flow.time), written(self.limits.end));
            let reason = "the run that --resume goes on with is at t";
            progress.warn(file.remark("time.end", format!("is {end}, and {reason} = {time}: nothing is left to do")));
        }
    }

    /// A run that its steps ended is not at the end that its case asks for.
    fn warn_of_an_end_not_reached(&self, file: &CaseFile, progress: &mut Progress) {
        let (flow, end) = (&self.setup.flow, self.limits.end);
        if self.limits.falls_short(flow.time) {
            let (steps, time, end) = (counted(flow.steps, "step", "steps"), short(flow.time), written(end));
            let reason = format!("the run stopped after {steps} at t = {time} s: time.end, {end} s, was not reached");
            progress.warn(file.remark("time.max_steps", reason));
        }
    }

    /// Inlets that did not meet their velocity, however far their pressure rose.
    fn warn_of_inlets(&self, file: &CaseFile, progress: &mut Progress) {
        let Setup { flow, inlets, live, .. } = &self.setup;
        for inlet in inlets {
            let Some(Shortfall { asked, found, pressure: [first, now] }) = inlet.shortfall(flow) else { continue };
            let key = match inlet.patch {
                Some(n) => format!("boundary.patch[{n}]"),
                None => format!("boundary.{}", side_word(live[inlet.at.0], inlet.at.1)),
            };
            let [found, asked, first, now] = [found, asked, first, now].map(short);
            progress.warn(file.remark(
                &key,
                format!(
                    "the gas enters at {found} m/s, not at {asked} as asked for, although the pressure of the inlet has risen from {first} to {now} Pa: what lies \
                     behind it is choked or has no way out"
                ),
            ));
        }
    }

    /// Has it steps to do?
    fn goes_on(&self) -> bool {
        self.setup.flow.time < self.limits.end && self.setup.flow.steps < self.limits.max_steps
    }

    /// Steps until the end, or an interrupt.
    fn steps(&mut self, line: &Meter) -> Result<()> {
        let (begun, start) = (Instant::now(), (self.setup.flow.time, self.setup.flow.steps));
        let mut saved = begun;
        while self.goes_on() {
            let stop = self.limits.next_stop(self.setup.flow.time);
            let clock = Instant::now();
            let dt = match step(&mut self.setup, self.maxima.as_mut(), stop) {
                Ok(dt) => dt,
                Err(trouble) => return Err(self.stopped(trouble)),
            };
            self.done.seconds += clock.elapsed().as_secs_f64();
            self.done.steps += 1;
            self.record(dt)?;
            if self.setup.flow.time >= stop && self.limits.is_frame(stop) {
                self.frame()?;
            }
            if saved.elapsed() >= self.limits.checkpoint_every {
                self.checkpoint()?;
                saved = Instant::now();
            }
            if line.is_due() {
                line.tell(&self.progress(dt, start, begun.elapsed()));
            }
            if interrupt::asked() {
                self.checkpoint()?;
                let (step, time) = (self.setup.flow.steps, written(self.setup.flow.time));
                return Err(Error::new(format!("interrupted at step {step}, t = {time}; go on with --resume")));
            }
        }
        // A last state between two frames is shown, but no frame of a run that goes on.
        self.checkpoint()?;
        self.series.end(&self.setup, self.journal.dt, &self.forces())?;
        if self.journal.frames.last() != Some(&self.setup.flow.time) {
            self.frame()?;
        }
        Ok(())
    }

    /// A run that must not go on, and where its last good state is.
    fn stopped(&mut self, trouble: Trouble) -> Error {
        // The lines until then show what went wrong; the checkpoint knows which of them a run that goes on keeps. If they cannot be written, the trouble is told all the same.
        let _ = self.series.flush(&mut self.journal.clone());
        let floored = matches!(trouble, Trouble::Floors(_)) && !self.untouched;
        let last = self.dir.join(if floored { checkpoint::UNTOUCHED } else { checkpoint::NAME });
        Error::new(format!("{trouble}; the last good state is in {}", last.display()))
    }

    /// Lines of this moment in the tables.
    fn record(&mut self, dt: f64) -> Result<()> {
        self.journal.dt = dt;
        let forces = self.forces();
        force_peaks::take(&mut self.journal.peaks, &forces, self.setup.flow.time);
        self.series.record(&self.setup, dt, &forces)
    }

    /// The present forces on the solids that are asked for.
    fn forces(&self) -> Vec<SolidForce> {
        let Setup { flow, solids, live, edges, .. } = &self.setup;
        let mut forces = solids.as_ref().map_or_else(Vec::new, |solids| solids.forces(flow, *live));
        let across = edges.across(live);
        forces.iter_mut().flat_map(|solid| &mut solid.force).for_each(|force| *force *= across);
        forces
    }

    /// A threshold that the case names and no cell has met: the moments of arrival are all NaN.
    fn warn_of_a_threshold_not_met(&self, file: &CaseFile, progress: &mut Progress) {
        let given = file.case.output.maxima.as_ref().and_then(|keys| keys.threshold);
        if let (Some(threshold), Some(maxima)) = (given, &self.maxima)
            && !maxima.has_arrived()
        {
            let reason = format!("an overpressure of {threshold} Pa was met in no cell: arrival.npy holds NaN alone");
            progress.warn(file.remark("output.maxima.threshold", reason));
        }
    }

    /// The last state, the largest values over time, and the pictures with the colours of the whole run.
    fn last(&mut self) -> Result<()> {
        let beta_v = self.setup.flow.beta_v();
        self.snapshot().arrays(&self.dir.join("final"), &self.setup.edges, beta_v)?;
        if let Some(pictures) = &mut self.pictures {
            pictures.again(&self.setup, &self.journal.frames, &self.dir.join("frames"))?;
        }
        self.maxima.iter().try_for_each(|m| m.write(&self.dir.join("maxima"), &self.setup.edges, beta_v))
    }

    /// The largest values over time at the probes.
    fn peaks(&self, file: &CaseFile) -> Vec<Peaks> {
        let cells = self.series.probes();
        let named = file.case.output.probes.iter().enumerate().map(|(n, probe)| probe.name(n)).zip(cells);
        let of =
            |maxima: &Maxima| named.map(|(name, &cell)| maxima.peaks(name, cell, self.setup.flow.beta_v())).collect();
        self.maxima.as_ref().map_or_else(Vec::new, of)
    }

    fn snapshot(&self) -> Snapshot {
        Snapshot::of(&self.setup.flow, self.setup.live)
    }

    /// The present state in all formats asked for.
    fn frame(&mut self) -> Result<()> {
        let (n, time, dir) = (self.journal.frames.len(), self.setup.flow.time, self.dir.join("frames"));
        self.journal.frames.push(time);
        if self.output.formats().is_empty() {
            return Ok(());
        }
        let shot = self.snapshot();
        for format in self.output.formats() {
            match format {
                Format::Vtr => {
                    let path = dir.join(frames::frame_name(n, "vtr"));
                    shot.paraview(&path, &self.setup.edges, self.setup.flow.beta_v(), time)?;
                    frames::series(&self.dir.join(frames::SERIES), &self.journal.frames)?;
                }
                Format::Npy => {
                    shot.arrays(&dir.join(format!("{n:04}")), &self.setup.edges, self.setup.flow.beta_v())?;
                }
                Format::Png => {
                    if let Some(pictures) = &mut self.pictures {
                        pictures.frame(&self.setup, &shot, (n, time), &dir)?;
                    }
                }
            }
        }
        Ok(())
    }

    fn checkpoint(&mut self) -> Result<()> {
        self.series.flush(&mut self.journal)?;
        let journal = Journal { seconds: self.journal.seconds + self.done.seconds, ..self.journal.clone() };
        let clock = match self.setup.flow.clock() {
            Ok(clock) => clock,
            Err(error) => return Err(Error::new(unphysical(&self.setup, Some(error)))),
        };
        if self.untouched && clock.total.floored > 0 {
            checkpoint::keep_untouched(&self.dir)?;
            self.untouched = false;
        }
        let path = self.dir.join(checkpoint::NAME);
        checkpoint::write(&path, &self.fingerprint, &self.setup, &clock, &journal, self.maxima.as_ref())
    }

    /// What the terminal shows while it runs.
    fn progress(&self, dt: f64, (time, steps): (f64, usize), elapsed: Duration) -> String {
        let flow = &self.setup.flow;
        let by_time = (flow.time - time) / (self.limits.end - time);
        let by_steps = (flow.steps - steps) as f64 / (self.limits.max_steps - steps) as f64;
        let left = elapsed.as_secs_f64() * (1.0 / by_time.max(by_steps).min(1.0) - 1.0);
        format!("step {}  t = {:.4e} s  dt = {dt:.2e} s  {} left", flow.steps, flow.time, duration(left))
    }
}

/// Hours, minutes and seconds.
fn duration(seconds: f64) -> String {
    let s = seconds.min(1e9) as u64;
    match s {
        0..60 => format!("{s} s"),
        60..3600 => format!("{} min {:02} s", s / 60, s % 60),
        _ => format!("{} h {:02} min", s / 3600, s / 60 % 60),
    }
}

/// The pressure that overpressures are counted from.
fn ambient<const D: usize>(file: &CaseFile, setup: &Setup<D>) -> f64 {
    file.case.output.ambient.unwrap_or_else(|| lowest_pressure(&setup.flow))
}

/// Say that overpressures are counted from less than the pressure around, or from whatever a field holds, if no other one was asked for and there are any.
fn warn_of_low_ambient(file: &CaseFile, ambient: f64, progress: &mut Progress) {
    let (initial, output) = (&file.case.initial, &file.case.output);
    let is_shown = output.maxima.is_some() || output.formats().contains(&Format::Png);
    if initial.from.is_some() && output.ambient.is_none() && is_shown {
        let reason =
            format!("not given: overpressures are counted from {ambient} Pa, the lowest pressure of initial.from");
        progress.warn(file.remark("output.ambient", reason));
    }
    let around = initial.uniform.as_ref().and_then(|state| state.p).filter(|p| ambient < *p * (1.0 - 1e-9));
    if let Some(around) = around.filter(|_| output.ambient.is_none() && output.maxima.is_some()) {
        let reason = format!(
            "not given: overpressures are counted from {ambient} Pa, the lowest pressure at the beginning, not from the {around} Pa of initial.uniform"
        );
        progress.warn(file.remark("output.ambient", reason));
    }
}

/// What the checkpoint of a run must share with it: what decides its flow, and what its largest values are counted from.
fn fingerprint<const D: usize>(setup: &Setup<D>, maxima: Option<&Maxima>, ambient: f64) -> Fingerprint {
    let of_flow = Fingerprint::new(setup).with_ambient(ambient);
    match maxima {
        Some(maxima) => of_flow.with_maxima(maxima),
        None => of_flow,
    }
}

/// The journal of a run that has not stepped yet; refuses a state that no gas has.
fn first_journal<const D: usize>(file: &CaseFile, setup: &mut Setup<D>) -> Result<Journal> {
    if let Err(error) = setup.flow.rate() {
        return Err(file.wrong("initial", unphysical(setup, Some(error))));
    }
    let content = setup.flow.content();
    if content.density == 0.0 {
        return Err(file.wrong("porosity", "the solids fill the whole grid: there is no gas to flow"));
    }
    Ok(Journal { begin: [content.density, content.energy], ..Journal::default() })
}

/// How frames are drawn, if they are.
fn pictures<const D: usize>(
    file: &CaseFile,
    setup: &Setup<D>,
    ambient: f64,
    progress: &mut Progress,
) -> Result<Option<Pictures>> {
    let of_file = || file.path.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    let title = file.case.title.clone().unwrap_or_else(of_file);
    if !file.case.output.formats().contains(&Format::Png) {
        return Ok(None);
    }
    progress.warn_of_title(&title);
    let charges = Charges::new(file, &setup.flow, &setup.edges, ambient)?;
    Ok(Some(Pictures::new(setup, &title, &file.case.output, ambient, &charges)))
}

/// Largest values over time of a flow at its beginning, if the case asks for them.
fn maxima<const D: usize>(file: &CaseFile, setup: &Setup<D>, ambient: f64) -> Option<Maxima> {
    let keys = file.case.output.maxima.as_ref()?;
    Some(Maxima::new(keys, ambient, &setup.flow))
}
