//! A study on its way: which points are kept from before, what is done, how long the rest will take.

use crate::command::progress::Progress;
use crate::command::version::BUILD;
use crate::error::{Error, Result};
use crate::geometry::bodies::Bodies;
use crate::words::counted;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The file of points that are done, in the directory of results.
pub const POINTS: &str = "points.jsonl";

/// The report, which a study writes last: where it is, the study is finished.
pub const REPORT: &str = "study.json";

/// From this share of the cost on, the time that was measured tells that of the rest.
const ENOUGH: f64 = 0.2;

/// A study on its way.
#[derive(Debug)]
pub struct Session<'a> {
    /// What the user sees.
    pub progress: &'a mut Progress,
    kept: BTreeMap<String, Value>,
    /// Where points are kept, and the first line of that file; opened with the first point.
    path: Option<PathBuf>,
    head: Head,
    file: Option<File>,
    /// The number of points, and their cost in a unit of which only ratios matter.
    planned: (usize, f64),
    /// Points done or left out, whether kept or measured, and their cost.
    done: (usize, f64),
    /// Cost and seconds of what was measured by this run.
    measured: (f64, f64),
}

/// The first line of the file.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Head {
    /// Of the case, its bodies, and the program.
    study: String,
}

/// Another line.
#[derive(Debug, Serialize, Deserialize)]
struct Line {
    key: String,
    value: Value,
}

/// What a study is made of: its text, the bodies of its scenes, whether it is quick, and this program. A study that differs in any of it
/// is another one.
#[must_use]
pub fn fingerprint(text: &str, scenes: &[Bodies], quick: bool) -> String {
    let mut hash = crc32fast::Hasher::new();
    hash.update(text.as_bytes());
    for scene in scenes {
        let numbers = scene.triangles.as_flattened().iter().flat_map(|corner| corner.to_array());
        numbers.for_each(|number| hash.update(&number.to_le_bytes()));
        hash.update(format!("{:?}", scene.bodies).as_bytes());
    }
    let program = serde_json::to_string(&BUILD).unwrap_or_default();
    hash.update(program.as_bytes());
    format!("{:08x}-{}{}", hash.finalize(), text.len(), if quick { "-quick" } else { "" })
}

/// A finished study is not replaced by another one unless that is asked for. `study` is the fingerprint of the one that begins.
///
/// # Errors
/// A directory with a finished study of another fingerprint.
pub fn keep_results(dir: &Path, study: &str, force: bool) -> Result<()> {
    if force || !dir.join(REPORT).exists() {
        return Ok(());
    }
    let points = std::fs::read_to_string(dir.join(POINTS)).unwrap_or_default();
    if head_of(&points).is_some_and(|head| head.study == study) {
        return Ok(());
    }
    let reason = "holds a finished study of another case, another geometry, another build of the program, or of --quick where this is not (or the \
                  other way round): --force replaces it, -o DIR takes another place";
    Err(Error::file(dir, reason))
}

/// The first line of a file of points, if it is one.
fn head_of(points: &str) -> Option<Head> {
    serde_json::from_str(points.lines().next()?).ok()
}

impl<'a> Session<'a> {
    /// Begins, or goes on with what a directory keeps of the same study. `planned` counts points and their cost.
    pub fn new(
        progress: &'a mut Progress,
        dir: Option<&Path>,
        study: String,
        planned: (usize, f64),
        force: bool,
    ) -> Self {
        let path = dir.map(|dir| dir.join(POINTS));
        let (kept, file, head) = (BTreeMap::new(), None, Head { study });
        let mut session = Session { progress, kept, path, head, file, planned, done: (0, 0.0), measured: (0.0, 0.0) };
        if let Some(path) = session.path.clone().filter(|_| !force)
            && let Ok(text) = std::fs::read_to_string(&path)
        {
            session.take(&text, &path);
        }
        session
    }

    /// The file of points, begun anew with what is kept.
    fn begin(&self, path: &Path) -> Result<File> {
        let dir = path.parent().unwrap_or(Path::new(""));
        std::fs::create_dir_all(dir).map_err(|e| Error::io(dir, "create the directory", &e))?;
        let mut lines = vec![serde_json::to_string(&self.head).unwrap_or_default()];
        for (key, value) in &self.kept {
            let line = Line { key: key.clone(), value: value.clone() };
            lines.push(serde_json::to_string(&line).unwrap_or_default());
        }
        crate::files::atomically(path, |out| writeln!(out, "{}", lines.join("\n")))?;
        let report = dir.join(REPORT);
        if report.exists() {
            // What is measured now is not finished.
            std::fs::remove_file(&report).map_err(|e| Error::io(&report, "remove", &e))?;
        }
        File::options().append(true).open(path).map_err(|e| Error::io(path, "write", &e))
    }

    /// Keeps a point.
    fn keep<T: Serialize>(&mut self, key: &str, point: &T) -> Result<()> {
        let Some(path) = self.path.clone() else { return Ok(()) };
        let mut file = self.file.take().map_or_else(|| self.begin(&path), Ok)?;
        let value = serde_json::to_value(point).map_err(|e| Error::new(format!("a point: {e}")))?;
        let line = serde_json::to_string(&Line { key: key.to_owned(), value }).unwrap_or_default();
        let kept = file.write_all(format!("{line}\n").as_bytes()).and_then(|()| file.flush());
        self.file = Some(file);
        kept.map_err(|e| Error::io(&path, "write", &e))
    }

    /// A finished study has its own points beside its tables, be it their first line alone: by that it is known again.
    ///
    /// # Errors
    /// The file of points cannot be written.
    pub fn finish(&mut self) -> Result<()> {
        let Some(path) = self.path.clone().filter(|_| self.file.is_none()) else { return Ok(()) };
        let there = std::fs::read_to_string(&path).unwrap_or_default();
        if head_of(&there).is_none_or(|head| head != self.head) {
            self.file = Some(self.begin(&path)?);
        }
        Ok(())
    }

    /// Keeps the points of a file, if they are of the same study. A line that was cut off counts for nothing.
    fn take(&mut self, text: &str, path: &Path) {
        if head_of(text).is_none_or(|head| head != self.head) {
            let other =
                "holds points of another case, another build of the program, or of --quick: all is measured anew";
            self.progress.warn(format!("{}: {other}", path.display()));
            return;
        }
        let points = text.lines().skip(1).filter_map(|l| serde_json::from_str::<Line>(l).ok());
        self.kept = points.map(|line| (line.key, line.value)).collect();
        if !self.kept.is_empty() {
            let count = self.kept.len();
            let points = counted(count, "point is", "points are");
            self.progress.say(format!("{points} kept from before (--force measures all anew)"));
        }
    }

    /// A point: kept from an earlier run, or measured now and kept. `cost` is in the unit of `planned`; `told` makes a line for the terminal of it.
    ///
    /// # Errors
    /// Those of `measure`; it cannot be kept.
    pub fn point<T: Serialize + DeserializeOwned>(
        &mut self,
        key: &str,
        cost: f64,
        measure: impl FnOnce(&mut Progress) -> Result<T>,
        told: impl FnOnce(&T) -> String,
    ) -> Result<T> {
        if let Some(point) = self.before(key) {
            self.done = (self.done.0 + 1, self.done.1 + cost);
            return Ok(point);
        }
        let begin = Instant::now();
        let heartbeat = self.progress.goes_on(format!("[{}/{}] {key}", self.done.0 + 1, self.planned.0));
        let point = measure(self.progress)?;
        drop(heartbeat);
        self.measured = (self.measured.0 + cost, self.measured.1 + begin.elapsed().as_secs_f64());
        self.done = (self.done.0 + 1, self.done.1 + cost);
        self.keep(key, &point)?;
        self.progress.say(format!("[{}/{}{}] {}", self.done.0, self.planned.0, self.left(), told(&point)));
        Ok(point)
    }

    /// Work that points need and that is no point itself; the user is told that it goes on.
    ///
    /// # Errors
    /// Those of `work`.
    pub fn prepare<T>(&mut self, what: &str, work: impl FnOnce() -> Result<T>) -> Result<T> {
        let begin = Instant::now();
        let _heartbeat = self.progress.goes_on(format!("[{}/{}] {what}", self.done.0 + 1, self.planned.0));
        let result = work()?;
        self.measured.1 += begin.elapsed().as_secs_f64();
        Ok(result)
    }

    /// A point of a run before.
    #[must_use]
    pub fn before<T: DeserializeOwned>(&self, key: &str) -> Option<T> {
        serde_json::from_value(self.kept.get(key)?.clone()).ok()
    }

    /// Some points cannot be measured.
    pub fn leave_out(&mut self, points: usize, cost: f64) {
        self.done = (self.done.0 + points, self.done.1 + cost);
    }

    /// How long what is left will take, if it costs as much as what was measured. None as long as little was measured: small grids
    /// tell next to nothing about the time of large ones.
    fn left(&self) -> String {
        let ((cost, seconds), rest) = (self.measured, (self.planned.1 - self.done.1).max(0.0));
        let known = cost >= ENOUGH * (cost + rest);
        let rest = rest * seconds / cost;
        match rest.round() {
            _ if !(known && rest > 0.5) => String::new(),
            s if s < 90.0 => format!(", about {s} s left"),
            s if s < 5400.0 => format!(", about {} min left", (s / 60.0).round()),
            s => format!(", about {:.1} h left", s / 3600.0),
        }
    }
}
