//! Grid files.
//!
//! They are TOML or JSON with one of
//! - `x`, `y`, `z`: lists of edges;
//! - `x`, `y`, `z`: segments `{ points = [0, 2, 10], cells = [4, 8], ratios = [1, 2] }`, as in PDRblockMesh: between two
//!   points that many cells, the last `ratio` times as long as the first (−r means 1/r);
//! - `origin`, `spacing`, `cells`: three numbers each.

use super::{Edges, MAX_AXIS, few_enough};
use crate::error::{Error, Result};
use glam::DVec3;
use serde::Deserialize;
use std::path::{Path, PathBuf};

#[derive(Deserialize)]
#[serde(expecting = "a grid is a table: x, y, z; or origin, spacing, cells")]
struct Document {
    #[serde(flatten)]
    spec: GridTable,
    #[serde(flatten)]
    other: std::collections::BTreeMap<String, serde::de::IgnoredAny>,
}

/// A grid as written in a file, in one of the forms above.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GridTable {
    x: Option<AxisSpec>,
    y: Option<AxisSpec>,
    z: Option<AxisSpec>,
    origin: Option<Vec<f64>>,
    spacing: Option<Vec<f64>>,
    cells: Option<Vec<usize>>,
    /// In place of the grid itself: the file that holds it.
    file: Option<PathBuf>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(
    untagged,
    deny_unknown_fields,
    expecting = "an axis is a list of edges, or { points = […], cells = […], ratios = […] }"
)]
enum AxisSpec {
    Edges(Vec<f64>),
    Segments { points: Vec<f64>, cells: Vec<usize>, ratios: Option<Vec<f64>> },
}

/// Edges of an axis that is left out: a flow that does not vary along it has one cell there, of unit width.
const UNIT_CELL: [f64; 2] = [0.0, 1.0];

impl GridTable {
    /// The file that holds the grid, if nothing but its name is given.
    #[must_use]
    pub fn elsewhere(&self) -> Option<&Path> {
        let only = GridTable { file: self.file.clone(), ..GridTable::default() };
        self.file.as_deref().filter(|_| *self == only)
    }

    /// The edges. With `fewer_axes`, later axes may be left out and hold one cell of unit width; `place` goes before
    /// the key in errors.
    ///
    /// # Errors
    /// Keys missing or at odds, or edges that make no grid; they name `path`.
    pub fn edges(self, path: &Path, place: &str, fewer_axes: bool) -> Result<Edges> {
        let wrong = |key: &str, reason: String| Error::at(path, format!("key {place}{key}"), reason);
        if self.file.is_some() {
            return Err(wrong("file", "a grid is either here or in another file".into()));
        }
        let least = if fewer_axes { 1 } else { 3 };
        let edges = match (self.x, self.y, self.z) {
            (None, None, None) => {
                let (Some(origin), Some(spacing), Some(cells)) = (self.origin, self.spacing, self.cells) else {
                    return Err(Error::file(path, "a grid needs x, y, z or origin, spacing, cells"));
                };
                let axes = cells.len();
                for (key, n) in [("cells", axes), ("origin", origin.len()), ("spacing", spacing.len())] {
                    if n != axes || !(least..=3).contains(&n) {
                        return Err(wrong(key, format!("needs one number for each axis, not {n}")));
                    }
                }
                few_enough(DVec3::from_array([0, 1, 2].map(|a| cells.get(a).map_or(1.0, |&n| n as f64))))
                    .map_err(|reason| wrong("cells", reason))?;
                Edges([0, 1, 2].map(|a| match cells.get(a) {
                    Some(&n) => (0..=n).map(|i| origin[a] + spacing[a] * i as f64).collect(),
                    None => UNIT_CELL.to_vec(),
                }))
            }
            (x, y, z) => {
                let given = [x.is_some(), y.is_some(), z.is_some()];
                if !fewer_axes && given != [true; 3] {
                    return Err(Error::file(path, "a grid needs all of x, y, z"));
                }
                if let Some((key, _)) = [("origin", self.origin.is_some()), ("spacing", self.spacing.is_some())]
                    .into_iter()
                    .chain([("cells", self.cells.is_some())])
                    .find(|(_, given)| *given && fewer_axes)
                {
                    return Err(wrong(key, "does not go with edges".into()));
                }
                let read = |name, spec: Option<AxisSpec>| {
                    spec.map_or_else(|| Ok(UNIT_CELL.to_vec()), |s| axis(path, &format!("{place}{name}"), s))
                };
                Edges([read("x", x)?, read("y", y)?, read("z", z)?])
            }
        };
        edges.grid(Some(path))?;
        Ok(edges)
    }
}

/// Keys that other programs write beside the edges and that say nothing new.
const HARMLESS: [&str; 6] = ["nx", "ny", "nz", "uniform", "name", "comment"];

/// Read a grid file.
///
/// # Errors
/// A file that cannot be read or understood, or a grid without cells.
pub fn read(path: &Path, warnings: &mut Vec<String>) -> Result<Edges> {
    if std::fs::metadata(path).is_ok_and(|m| !m.is_file()) {
        return Err(Error::file(path, "not a regular file"));
    }
    let text = std::fs::read_to_string(path).map_err(|e| Error::io(path, "read", &e))?;
    let text = text.trim_start_matches('\u{feff}');
    let json = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("json")) || text.trim_start().starts_with('{');
    let document: Document = if json {
        serde_json::from_str(text)
            .map_err(|e| Error::at(path, format!("line {}", e.line()), format!("no grid: {e}")))?
    } else {
        toml::from_str(text).map_err(|e| toml_error(path, text, &e))?
    };
    for key in document.other.keys().filter(|k| !HARMLESS.contains(&k.as_str())) {
        warnings.push(format!("{}: key {key}: not known, ignored", path.display()));
    }
    let spec = &document.spec;
    if spec.x.is_some() && (spec.origin.is_some() || spec.spacing.is_some() || spec.cells.is_some()) {
        warnings.push(format!("{}: x, y, z are given; origin, spacing, cells beside them are ignored", path.display()));
    }
    document.spec.edges(path, "", false)
}

/// The grid that a value of another TOML file describes. Unlike a grid file it holds nothing else.
///
/// # Errors
/// If it is none; with the line in `text`.
pub fn from_value(path: &Path, text: &str, value: toml::Spanned<toml::de::DeValue>) -> Result<Edges> {
    let line = text.get(..value.span().start).unwrap_or("").matches('\n').count() + 1;
    let document =
        Document::deserialize(toml::de::ValueDeserializer::from(value)).map_err(|e| toml_error(path, text, &e))?;
    if let Some(key) = document.other.keys().next() {
        return Err(Error::at(path, format!("line {line}"), format!("grid: key {key} is not known here")));
    }
    document.spec.edges(path, "", false)
}

/// A TOML error with its line.
pub fn toml_error(path: &Path, text: &str, error: &toml::de::Error) -> Error {
    let place = error.span().map_or_else(
        || "document".to_owned(),
        |s| format!("line {}", text.get(..s.start).unwrap_or("").matches('\n').count() + 1),
    );
    Error::at(path, place, error.message())
}

fn axis(path: &Path, name: &str, spec: AxisSpec) -> Result<Vec<f64>> {
    let (points, cells, ratios) = match spec {
        AxisSpec::Edges(edges) => return Ok(edges),
        AxisSpec::Segments { points, cells, ratios } => (points, cells, ratios),
    };
    let wrong = |reason: String| Error::at(path, format!("key {name}"), reason);
    let ratios = ratios.unwrap_or_else(|| vec![1.0; cells.len()]);
    if points.len() != cells.len() + 1 || ratios.len() != cells.len() {
        let (p, c, r) = (points.len(), cells.len(), ratios.len());
        return Err(wrong(format!("{p} points need {} cells and ratios, not {c} and {r}", p.saturating_sub(1))));
    }
    if cells.iter().map(|&n| n as f64).sum::<f64>() > MAX_AXIS {
        return Err(wrong(format!("more than {MAX_AXIS:e} cells along an axis")));
    }
    let mut edges = vec![points.first().copied().unwrap_or(0.0)];
    for (ends, (&n, &ratio)) in points.windows(2).zip(cells.iter().zip(&ratios)) {
        if n == 0 || ratio == 0.0 || !ratio.is_finite() {
            return Err(wrong(format!(
                "a segment needs at least one cell and a ratio other than 0, not {n} and {ratio}"
            )));
        }
        let ratio = if ratio < 0.0 { -1.0 / ratio } else { ratio };
        edges.extend((1..=n).map(|i| ends[0] + (ends[1] - ends[0]) * share(i, n, ratio)));
        if let Some(last) = edges.last_mut() {
            *last = ends[1];
        }
    }
    Ok(edges)
}

/// Where the `i`-th of `n` cells ends, if lengths grow geometrically and the last is `ratio` times the first.
fn share(i: usize, n: usize, ratio: f64) -> f64 {
    if n == 1 || ratio == 1.0 {
        return i as f64 / n as f64;
    }
    // growth = exp(rate); growth^i − 1 would cancel where the ratio is close to 1.
    let rate = ratio.ln() / (n - 1) as f64;
    (rate * i as f64).exp_m1() / (rate * n as f64).exp_m1()
}
