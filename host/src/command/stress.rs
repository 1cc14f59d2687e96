//! `voidage stress`: the program against cases that trouble such programs, each with a truth that does not come from it.
//!
//! In reading order: [`case`], [`kit`], [`geometry`], [`gjk`], [`flow`], [`runner`], [`report`].

pub mod case;
pub mod flow;
pub mod geometry;
pub mod gjk;
pub mod kit;
pub mod report;
pub mod runner;

use crate::command::cli::StressArgs;
use crate::command::progress::{Progress, print};
use crate::command::streams::{check_place, check_suffix, is_stream, write_json};
use crate::error::{Error, Result};
use crate::words::counted;
use case::{Effort, StressCase};
use report::StressSummary;
use std::time::Instant;

/// All cases, family by family.
#[must_use]
pub fn cases() -> Vec<&'static StressCase> {
    geometry::families().chain(gjk::families()).chain(flow::families()).flatten().collect()
}

/// Run it.
///
/// # Errors
/// A case that fails, a name that is not known, or a report that cannot be written.
pub fn stress(args: &StressArgs) -> Result<()> {
    let chosen = chosen(args)?;
    if args.list {
        return print(report::list(&chosen).as_bytes());
    }
    let mut progress = Progress::new(&args.talk);
    args.json.iter().try_for_each(|path| check_suffix("--json", path, "json").and_then(|()| check_place(path)))?;
    progress.stdout_is_taken(args.json.as_deref().is_some_and(is_stream));
    let threads = args.threads.map_or_else(available, usize::from);
    if args.spoil {
        kit::doors::spoil_results();
    }
    let begun = Instant::now();
    let width = chosen.iter().map(|case| case.name.len()).max().unwrap_or(0);
    let outcomes = runner::run(&chosen, Effort { long: args.long }, threads, |outcome| {
        progress.say(report::line(outcome, width));
    })?;
    let summary = StressSummary::new(&outcomes, args.long, threads, begun.elapsed().as_secs_f64());
    progress.say(summary.sentence());
    args.json.iter().try_for_each(|path| write_json(path, &summary))?;
    match summary.failed_names() {
        failed if failed.is_empty() => Ok(()),
        failed => Err(Error::new(format!(
            "{} of {} failed: {}",
            failed.len(),
            counted(outcomes.len(), "case", "cases"),
            failed.join(", ")
        ))),
    }
}

/// As many threads as there are cores.
fn available() -> usize {
    std::thread::available_parallelism().map_or(1, std::num::NonZero::get)
}

/// The cases that `--only` names, by whole name or by how it begins, or all; those that take long where asked for.
fn chosen(args: &StressArgs) -> Result<Vec<&'static StressCase>> {
    let all = cases();
    let known: Vec<&str> = all.iter().map(|case| case.name).collect();
    let is_known = |only: &str| !only.is_empty() && known.iter().any(|name| name.starts_with(only));
    if let Some(unknown) = args.only.iter().find(|only| !is_known(only)) {
        return Err(Error::usage(format!("no case is called {unknown:?}; known are {}", known.join(", "))));
    }
    let named = |case: &StressCase| args.only.iter().any(|only| case.name == only);
    let begins = |case: &StressCase| args.only.is_empty() || args.only.iter().any(|o| case.name.starts_with(&o[..]));
    let wanted = |case: &&StressCase| named(case) || (begins(case) && (!case.long || args.long || args.list));
    let chosen: Vec<_> = all.into_iter().filter(wanted).collect();
    match chosen.is_empty() {
        true => Err(Error::usage("all cases of these names take long: they run with --long, or by their whole names")),
        false => Ok(chosen),
    }
}
