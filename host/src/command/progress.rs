//! What the user sees while and after it runs.

use crate::command::cli::TalkArgs;
use crate::error::{Error, Result, said};
use crate::picture::not_drawn;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::collections::BTreeMap;
use std::io::{ErrorKind, IsTerminal, Write};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Whether the standard output was closed when the program began.
static OUTPUT_CLOSED: AtomicBool = AtomicBool::new(false);

/// Remember that the standard output was closed when the program began.
pub fn output_is_closed() {
    OUTPUT_CLOSED.store(true, Ordering::Relaxed);
}

/// Print a result to standard output, however quiet the run. A reader that closes early is no failure.
///
/// # Errors
/// Standard output is closed, cannot be written or takes no more.
pub fn print(bytes: &[u8]) -> Result<()> {
    let refused = |reason: String| Err(Error::new(format!("cannot write to standard output: {reason}")));
    if OUTPUT_CLOSED.load(Ordering::Relaxed) {
        return refused("it is closed".to_owned());
    }
    match write_out(bytes) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => refused(said(&e)),
        _ => Ok(()),
    }
}

/// Write to the standard output as to a file: [`std::io::Stdout`] takes bytes for written that go to a stream which can only be read.
#[cfg(unix)]
fn write_out(bytes: &[u8]) -> std::io::Result<()> {
    use std::os::fd::AsFd;
    std::fs::File::from(std::io::stdout().as_fd().try_clone_to_owned()?).write_all(bytes)
}

#[cfg(not(unix))]
fn write_out(bytes: &[u8]) -> std::io::Result<()> {
    let mut out = std::io::stdout();
    out.write_all(bytes).and_then(|()| out.flush())
}

/// Print a line beside the results, to standard error. Where that takes no more, nobody reads it: no failure of the work.
pub fn print_aside(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// A sentence as a terminal may see it: control characters, which names in files may hold, are spelled out.
#[must_use]
pub fn visible(sentence: &str) -> String {
    let shown = |c: char| if c.is_control() && c != '\n' { c.escape_default().to_string() } else { c.to_string() };
    sentence.chars().map(shown).collect()
}

/// The first sentence that the standard output did not take.
static UNSAID: Mutex<Option<Error>> = Mutex::new(None);

/// Fails if the standard output did not take all that was printed to it.
///
/// # Errors
/// The standard output is full, or the like.
pub fn all_said() -> Result<()> {
    UNSAID.lock().unwrap_or_else(PoisonError::into_inner).take().map_or(Ok(()), Err)
}

/// Time between lines about how far a run has come, where there is no terminal.
const PAUSE: Duration = Duration::from_secs(10);

/// A stage that prints nothing by itself is looked at as often.
const TICK: Duration = Duration::from_millis(500);

/// When the last line about how far a run has come was printed.
#[derive(Clone, Debug)]
struct LastLine(Arc<Mutex<Instant>>);

impl LastLine {
    /// Whether so much time has passed since; then another line is due, and counts as printed.
    fn is_older(&self, pause: Duration) -> bool {
        let mut last = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let due = last.elapsed() >= pause;
        if due {
            *last = Instant::now();
        }
        due
    }
}

/// How many steps of the work at hand there are, none if nobody counts them, and how many are done.
#[derive(Debug, Default)]
struct Count {
    steps: AtomicUsize,
    done: AtomicUsize,
}

impl Count {
    fn begin(&self, steps: usize) {
        self.done.store(0, Ordering::Relaxed);
        self.steps.store(steps, Ordering::Relaxed);
    }

    /// The work by its name, with what is done of it.
    fn told(&self, name: &str) -> String {
        let (steps, done) = (self.steps.load(Ordering::Relaxed), self.done.load(Ordering::Relaxed));
        let percent = (100 * done.min(steps)).checked_div(steps);
        percent.map_or_else(|| name.to_owned(), |percent| format!("{name} {percent} %"))
    }
}

/// How far something has come.
#[derive(Debug)]
pub struct Meter {
    name: &'static str,
    count: Arc<Count>,
    bar: ProgressBar,
    /// Lines are printed: there is no terminal, and the run is not quiet.
    plain: Option<LastLine>,
}

impl Meter {
    /// Whether a line may be printed now: on a terminal always, else when ten seconds have passed since the last one.
    pub fn is_due(&self) -> bool {
        self.plain.as_ref().map_or(!self.bar.is_hidden(), |last| last.is_older(PAUSE))
    }

    /// Shows how far it is: beside the bar on a terminal, else as a line.
    pub fn tell(&self, sentence: &str) {
        match self.plain {
            Some(_) => print_aside(sentence),
            None => self.bar.set_message(sentence.to_owned()),
        }
    }

    /// Counts a step that is done.
    pub fn step(&self) {
        self.count.done.fetch_add(1, Ordering::Relaxed);
        self.bar.inc(1);
        if self.plain.is_some() && self.is_due() {
            self.tell(&self.count.told(self.name));
        }
    }
}

impl Drop for Meter {
    /// What comes next is not counted by it.
    fn drop(&mut self) {
        self.count.begin(0);
    }
}

/// That work goes on, and for how long already.
fn lasting(work: &str, time: Duration) -> String {
    format!("{}: {:.0} s so far", visible(work), time.as_secs_f64())
}

/// Tells from time to time, while it lives, that a long piece of work goes on.
#[derive(Debug)]
pub struct Heartbeat {
    /// Dropped to end the thread.
    alive: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Heartbeat {
    /// Calls `tell` after each `pause` with the time since the beginning.
    pub fn new(pause: Duration, tell: impl Fn(Duration) + Send + 'static) -> Self {
        let ((alive, ended), begun) = (channel(), Instant::now());
        let beat = move || {
            while ended.recv_timeout(pause) == Err(RecvTimeoutError::Timeout) {
                tell(begun.elapsed());
            }
        };
        Heartbeat { alive: Some(alive), thread: Some(std::thread::spawn(beat)) }
    }
}

impl Drop for Heartbeat {
    fn drop(&mut self) {
        self.alive = None;
        let _ = self.thread.take().map(JoinHandle::join); // that it could not tell is no failure of the work
    }
}

/// Messages to the terminal, warnings collected, stages timed.
#[derive(Debug)]
pub struct Progress {
    quiet: bool,
    taken: bool,
    verbose: bool,
    /// Sentences said so far.
    pub warnings: Vec<String>,
    /// Seconds by stage.
    pub seconds: BTreeMap<&'static str, f64>,
    begun: Instant,
    last_line: LastLine,
    count: Arc<Count>,
    /// How many stages there are within each other at the moment.
    depth: Arc<AtomicUsize>,
}

impl Progress {
    /// As loud as the user asked for.
    #[must_use]
    pub fn new(talk: &TalkArgs) -> Self {
        Progress {
            quiet: talk.quiet,
            taken: false,
            verbose: talk.verbose,
            warnings: Vec::new(),
            seconds: BTreeMap::new(),
            begun: Instant::now(),
            last_line: LastLine(Arc::new(Mutex::new(Instant::now()))),
            count: Arc::default(),
            depth: Arc::default(),
        }
    }

    /// Say and keep a warning.
    pub fn warn(&mut self, sentence: impl Into<String>) {
        let sentence = sentence.into();
        if !self.quiet {
            print_aside(&format!("warning: {}", visible(&sentence)));
        }
        self.warnings.push(sentence);
    }

    /// Say which letters of a picture's title are boxes in it.
    pub fn warn_of_title(&mut self, title: &str) {
        let letters = not_drawn(title);
        if !letters.is_empty() {
            self.warn(format!("the letters {letters} of the title \"{title}\" are boxes in pictures"));
        }
    }

    /// A file of the run goes to the standard output: what else is said goes beside it.
    pub fn stdout_is_taken(&mut self, taken: bool) {
        self.taken = taken;
    }

    /// Say something that is no warning.
    pub fn say(&self, sentence: impl AsRef<str>) {
        let sentence = visible(sentence.as_ref());
        match (self.quiet, self.taken) {
            (true, _) => {}
            (false, true) => print_aside(&sentence),
            (false, false) => {
                if let Err(error) = print(format!("{sentence}\n").as_bytes()) {
                    UNSAID.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
                }
            }
        }
    }

    /// Tells that `work` goes on, unless the run is quiet, when no other line has been printed for a while, as long as what is returned lives.
    #[must_use]
    pub fn goes_on(&self, work: String) -> Option<Heartbeat> {
        self.heartbeat(move |time| Some(lasting(&work, time)))
    }

    /// Prints what there is to say of work that goes on, unless the run is quiet, when no other line has been printed for a while.
    fn heartbeat(&self, say: impl Fn(Duration) -> Option<String> + Send + 'static) -> Option<Heartbeat> {
        let last = self.last_line.clone();
        let tell = move |time: Duration| {
            if let Some(line) = say(time).filter(|_| last.is_older(PAUSE + TICK)) {
                print_aside(&line);
            }
        };
        (!self.quiet).then(|| Heartbeat::new(TICK, tell))
    }

    /// What there is to say of the innermost stage after some time, with what is done of it if that is counted; of another stage there is nothing to say.
    pub fn so_far(&self, name: &'static str) -> impl Fn(Duration) -> Option<String> + Send + use<> {
        let (count, depth, own) = (self.count.clone(), self.depth.clone(), self.depth.load(Ordering::Relaxed));
        move |time| (depth.load(Ordering::Relaxed) == own).then(|| lasting(&count.told(name), time))
    }

    /// A bar of `steps` steps on a terminal, else a line from time to time.
    #[must_use]
    pub fn bar(&self, name: &'static str, steps: usize) -> Meter {
        let style = "{prefix:>10} {bar:40} {percent:>3} %  {eta} left";
        let meter = self.meter(name, steps, style);
        meter.bar.set_prefix(name);
        meter
    }

    /// A line that tells how far something has come, on a terminal always the same, else a new one from time to time.
    #[must_use]
    pub fn line(&self) -> Meter {
        self.meter("", 0, "{msg}")
    }

    fn meter(&self, name: &'static str, steps: usize, style: &str) -> Meter {
        let terminal = std::io::stderr().is_terminal();
        let bar = match !self.quiet && terminal {
            true => ProgressBar::with_draw_target(Some(steps as u64), ProgressDrawTarget::stderr_with_hz(10)),
            false => ProgressBar::hidden(),
        };
        bar.set_style(ProgressStyle::with_template(style).unwrap_or_else(|_| ProgressStyle::default_bar()));
        let bar = bar.with_finish(indicatif::ProgressFinish::AndClear);
        let plain = (!self.quiet && !terminal).then(|| self.last_line.clone());
        self.count.begin(steps);
        Meter { name, count: self.count.clone(), bar, plain }
    }

    /// Run a stage and keep its time.
    pub fn stage<T>(&mut self, name: &'static str, work: impl FnOnce(&mut Self) -> T) -> T {
        let begin = Instant::now();
        self.depth.fetch_add(1, Ordering::Relaxed);
        // On a terminal bars tell how far it is.
        let watched = if std::io::stderr().is_terminal() { None } else { self.heartbeat(self.so_far(name)) };
        let result = work(self);
        drop(watched);
        self.depth.fetch_sub(1, Ordering::Relaxed);
        let seconds = begin.elapsed().as_secs_f64();
        *self.seconds.entry(name).or_default() += seconds;
        if self.verbose {
            print_aside(&format!("{name:>10} {seconds:9.4} s"));
        }
        result
    }

    /// Seconds since the start.
    #[must_use]
    pub fn elapsed(&self) -> f64 {
        self.begun.elapsed().as_secs_f64()
    }
}
