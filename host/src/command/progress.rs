//! What the user sees while and after it runs.

use crate::command::cli::TalkArgs;
use crate::error::{Error, Result};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::collections::BTreeMap;
use std::io::{ErrorKind, IsTerminal, Write};
use std::time::Instant;

/// Print a result to standard output, however quiet the run. A reader that closes early is no failure.
///
/// # Errors
/// Standard output takes no more.
pub fn print(bytes: &[u8]) -> Result<()> {
    let mut out = std::io::stdout();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(Error::new(format!("cannot write to standard output: {e}"))),
        _ => Ok(()),
    }
}

/// A sentence as a terminal may see it: control characters, which names in files may hold, are spelled out.
#[must_use]
pub fn visible(sentence: &str) -> String {
    let shown = |c: char| if c.is_control() && c != '\n' { c.escape_default().to_string() } else { c.to_string() };
    sentence.chars().map(shown).collect()
}

/// Messages to the terminal, warnings collected, stages timed.
#[derive(Debug)]
pub struct Progress {
    quiet: bool,
    verbose: bool,
    /// Sentences said so far.
    pub warnings: Vec<String>,
    /// Seconds by stage.
    pub seconds: BTreeMap<&'static str, f64>,
    begun: Instant,
}

impl Progress {
    /// As loud as the user asked for.
    #[must_use]
    pub fn new(talk: &TalkArgs) -> Self {
        Progress {
            quiet: talk.quiet,
            verbose: talk.verbose,
            warnings: Vec::new(),
            seconds: BTreeMap::new(),
            begun: Instant::now(),
        }
    }

    /// Say and keep a warning.
    pub fn warn(&mut self, sentence: impl Into<String>) {
        let sentence = sentence.into();
        if !self.quiet {
            eprintln!("warning: {}", visible(&sentence));
        }
        self.warnings.push(sentence);
    }

    /// Say something that is no warning.
    pub fn say(&self, sentence: impl AsRef<str>) {
        if !self.quiet {
            // A reader that closes early (head) is no failure.
            let _ = writeln!(std::io::stdout(), "{}", visible(sentence.as_ref()));
        }
    }

    /// A bar of `steps` steps, on a terminal only.
    #[must_use]
    pub fn bar(&self, name: &'static str, steps: usize) -> ProgressBar {
        if self.quiet || !std::io::stderr().is_terminal() {
            return ProgressBar::hidden();
        }
        let bar = ProgressBar::with_draw_target(Some(steps as u64), ProgressDrawTarget::stderr_with_hz(10));
        let style = ProgressStyle::with_template("{prefix:>10} {bar:40} {percent:>3} %  {eta} left");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar.with_prefix(name).with_finish(indicatif::ProgressFinish::AndClear)
    }

    /// A line that tells how far something has come, on a terminal only.
    #[must_use]
    pub fn line(&self) -> ProgressBar {
        if self.quiet || !std::io::stderr().is_terminal() {
            return ProgressBar::hidden();
        }
        let line = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr_with_hz(10));
        line.set_style(ProgressStyle::with_template("{msg}").unwrap_or_else(|_| ProgressStyle::default_spinner()));
        line.with_finish(indicatif::ProgressFinish::AndClear)
    }

    /// Run a stage and keep its time.
    pub fn stage<T>(&mut self, name: &'static str, work: impl FnOnce(&mut Self) -> T) -> T {
        let begin = Instant::now();
        let result = work(self);
        let seconds = begin.elapsed().as_secs_f64();
        *self.seconds.entry(name).or_default() += seconds;
        if self.verbose {
            eprintln!("{name:>10} {seconds:9.4} s");
        }
        result
    }

    /// Seconds since the start.
    #[must_use]
    pub fn elapsed(&self) -> f64 {
        self.begun.elapsed().as_secs_f64()
    }
}
