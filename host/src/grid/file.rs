//! Grid files.
//!
//! They are TOML or JSON with one of
//! - `x`, `y`, `z`: lists of edges;
//! - `x`, `y`, `z`: segments `{ points = [0, 2, 10], cells = [4, 8], ratios = [1, 2] }`, as in PDRblockMesh: between two
//!   points that many cells, the last `ratio` times as long as the first (−r means 1/r);
//! - `origin`, `spacing`, `cells`: three numbers each; one number as `spacing` is that of all axes.

use super::{Edges, MAX_AXIS, decimal, few_enough, rounding};
use crate::error::{Error, Result};
use crate::keys::reader::{meant, misfit, nearest, not_known};
use crate::keys::value::{Entry, Value};
use crate::keys::{self, PlacedValue, Source, json};
use crate::words::{counted, written};
use glam::DVec3;
use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};
use std::path::{Path, PathBuf};

/// A grid as written in a file, in one of the forms above.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GridTable {
    x: Option<AxisSpec>,
    y: Option<AxisSpec>,
    z: Option<AxisSpec>,
    origin: Option<Vec<f64>>,
    spacing: Option<Spacing>,
    /// Whatever whole numbers were written: what they may be is said here, not by their type.
    cells: Option<Vec<i64>>,
    /// In place of the grid itself: the file that holds it.
    file: Option<PathBuf>,
}

/// Keys of a grid where it stands in a file of its own.
const KEYS: [&str; 6] = ["x", "y", "z", "origin", "spacing", "cells"];

#[derive(Debug, Clone, PartialEq)]
enum AxisSpec {
    Edges(Vec<f64>),
    Segments(Segments),
}

/// Sizes of cells as written: one number for all axes, or one for each.
#[derive(Debug, Clone, PartialEq)]
enum Spacing {
    OfAll(f64),
    OfEach(Vec<f64>),
}

impl Spacing {
    /// A number for each of so many axes, with its name in messages.
    fn of_axes(&self, axes: usize) -> Vec<(String, f64)> {
        match self {
            Spacing::OfAll(h) => vec![("spacing".to_owned(), *h); axes],
            Spacing::OfEach(all) => all.iter().enumerate().map(|(a, h)| (format!("spacing[{a}]"), *h)).collect(),
        }
    }
}

impl<'de> Deserialize<'de> for Spacing {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        deserializer.deserialize_any(SpacingVisitor)
    }
}

/// Tells the two forms of a spacing apart.
struct SpacingVisitor;

impl<'de> Visitor<'de> for SpacingVisitor {
    type Value = Spacing;

    fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str("a number, or a list of one for each axis")
    }

    fn visit_f64<E>(self, h: f64) -> std::result::Result<Spacing, E> {
        Ok(Spacing::OfAll(h))
    }

    fn visit_i64<E>(self, h: i64) -> std::result::Result<Spacing, E> {
        Ok(Spacing::OfAll(h as f64))
    }

    fn visit_u64<E>(self, h: u64) -> std::result::Result<Spacing, E> {
        Ok(Spacing::OfAll(h as f64))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, items: A) -> std::result::Result<Spacing, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(items)).map(Spacing::OfEach)
    }
}

/// An axis in parts, each with cells that grow evenly.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Segments {
    points: Vec<f64>,
    cells: Vec<i64>,
    ratios: Option<Vec<f64>>,
}

impl<'de> Deserialize<'de> for AxisSpec {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        deserializer.deserialize_any(AxisVisitor)
    }
}

/// Tells the two forms of an axis apart.
struct AxisVisitor;

impl<'de> Visitor<'de> for AxisVisitor {
    type Value = AxisSpec;

    fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str("a list of edges, or { points = […], cells = […], ratios = […] }")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, items: A) -> std::result::Result<AxisSpec, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(items)).map(AxisSpec::Edges)
    }

    fn visit_map<A: MapAccess<'de>>(self, members: A) -> std::result::Result<AxisSpec, A::Error> {
        Segments::deserialize(MapAccessDeserializer::new(members)).map(AxisSpec::Segments)
    }
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

    /// The axes that a case leaves out, which then hold one cell of unit width.
    #[must_use]
    pub fn left_out(&self) -> [bool; 3] {
        match (&self.cells, [self.x.is_some(), self.y.is_some(), self.z.is_some()]) {
            _ if self.file.is_some() => [false; 3],
            (Some(cells), [false, false, false]) => [0, 1, 2].map(|a| a >= cells.len()),
            (_, given) => given.map(|given| !given),
        }
    }

    /// The edges. With `fewer_axes`, as `voidage solve` allows, later axes may be left out and hold one cell of unit width; `place`
    /// goes before the key in errors.
    ///
    /// # Errors
    /// Keys missing or at odds, or edges that make no grid; they name the place in `source`.
    pub fn edges(self, source: &Source, place: &str, fewer_axes: bool) -> Result<Edges> {
        let wrong = |key: &str, reason: String| source.at_key(&format!("{place}{key}"), reason);
        let whole = |reason: &str| match place.trim_end_matches('.') {
            "" => Error::file(source.path, reason),
            table => source.at_key(table, reason),
        };
        if self.file.is_some() {
            let reason = if fewer_axes { "a grid is either here or in another file" } else { FILE_ELSEWHERE };
            return Err(wrong("file", reason.into()));
        }
        let edges = match (&self.x, &self.y, &self.z) {
            (None, None, None) => self.uniform(fewer_axes, &whole, &wrong)?,
            (x, y, z) => {
                let given = [x.is_some(), y.is_some(), z.is_some()];
                // Beside all edges a grid file may hold other keys.
                let mixed = !place.is_empty() || given != [true; 3];
                if let Some((key, _)) = [("origin", self.origin.is_some()), ("spacing", self.spacing.is_some())]
                    .into_iter()
                    .chain([("cells", self.cells.is_some())])
                    .find(|(_, given)| *given && mixed)
                {
                    let reason = "does not go with edges: a grid is x, y, z or origin, spacing, cells";
                    return Err(wrong(key, reason.into()));
                }
                if !fewer_axes && given != [true; 3] {
                    return Err(whole(
                        "a grid needs all of x, y, z: only that of a case of voidage solve may lack some",
                    ));
                }
                let read = |name, spec: &Option<AxisSpec>| {
                    let edges = |s: &AxisSpec| axis(s).map_err(|reason| wrong(name, reason));
                    spec.as_ref().map_or_else(|| Ok(UNIT_CELL.to_vec()), edges)
                };
                Edges([read("x", x)?, read("y", y)?, read("z", z)?])
            }
        };
        match edges.explained() {
            Ok(_) => Ok(edges),
            Err((place, reason)) if place.contains(' ') => Err(whole(&format!("{place}: {reason}"))),
            Err((place, reason)) => Err(wrong(&place, reason)),
        }
    }

    /// From `origin`, `spacing` and `cells`.
    fn uniform(
        &self,
        fewer_axes: bool,
        whole: &dyn Fn(&str) -> Error,
        wrong: &dyn Fn(&str, String) -> Error,
    ) -> Result<Edges> {
        let (Some(origin), Some(spacing), Some(cells)) = (&self.origin, &self.spacing, &self.cells) else {
            let all = [self.origin.is_some(), self.spacing.is_some(), self.cells.is_some()];
            let absent: Vec<&str> =
                KEYS[3..].iter().zip(all).filter(|(_, given)| !given).map(|(key, _)| *key).collect();
            let absent = if absent.len() < 3 { format!("; {} missing", and_are(&absent)) } else { String::new() };
            return Err(whole(&format!("a grid needs x, y, z or origin, spacing, cells{absent}")));
        };
        let (axes, least) = (cells.len(), if fewer_axes { 1 } else { 3 });
        let spacing = spacing.of_axes(axes);
        for (key, n) in [("cells", axes), ("origin", origin.len()), ("spacing", spacing.len())] {
            if !(least..=3).contains(&n) {
                let all = if fewer_axes { "1 to 3 numbers" } else { "3 numbers" };
                return Err(wrong(key, format!("takes {all}, one for each axis, not {n}")));
            }
            if n != axes {
                return Err(wrong(key, format!("has {n} numbers, but cells has {axes}: one for each axis")));
            }
        }
        if let Some((key, h)) = spacing.iter().find(|(_, h)| !(*h > 0.0 && h.is_finite())) {
            return Err(wrong(key, format!("takes a finite number above 0, not {h}")));
        }
        if let Some(a) = cells.iter().position(|&n| n < 1) {
            return Err(wrong(&format!("cells[{a}]"), format!("must be at least 1, not {}", cells[a])));
        }
        few_enough(DVec3::from_array([0, 1, 2].map(|a| cells.get(a).map_or(1.0, |&n| n as f64))))
            .map_err(|reason| wrong("cells", reason))?;
        let edges = [0, 1, 2].map(|a| match cells.get(a) {
            Some(&n) => {
                let h = spacing[a].1;
                let decimal = decimal(rounding(origin[a], origin[a] + h * n as f64));
                let edge = |i: i64| if i == 0 { origin[a] } else { decimal(origin[a] + h * i as f64) };
                (0..=n).map(edge).collect()
            }
            None => UNIT_CELL.to_vec(),
        });
        // Beyond the range of numbers it is not the step that is too small.
        let lost = |e: &Vec<f64>| e.iter().all(|x| x.is_finite()) && first_lost(e).is_some();
        if let Some(a) = edges.iter().position(lost) {
            let ((key, step), origin) = (&spacing[a], written(origin[a]));
            let reason = format!(
                "a step of {} is lost in rounding at coordinates around origin[{a}] = {origin}",
                written(*step)
            );
            return Err(wrong(key, format!("{reason}: move the origin nearer to 0")));
        }
        Ok(Edges(edges))
    }
}

/// The first edge that does not lie above the one before it.
fn first_lost(edges: &[f64]) -> Option<usize> {
    edges.windows(2).position(|pair| !(pair[0] < pair[1])).map(|n| n + 1)
}

/// Names, and whether one of them is or several are.
fn and_are(names: &[&str]) -> String {
    format!("{} {}", names.join(", "), if names.len() == 1 { "is" } else { "are" })
}

/// Why a grid does not name another file where it may not.
const FILE_ELSEWHERE: &str = "only the grid of a case of voidage solve may stand in another file: give --grid";

/// Keys that other programs write beside the edges, in JSON, and that say nothing new.
const HARMLESS: [&str; 6] = ["nx", "ny", "nz", "uniform", "name", "comment"];

/// A key that is not known, and the key of a grid that lacks it for which it may be a slip of the pen.
fn slip<'a>(strange: &'a [Entry], known: &[Entry]) -> Option<(&'a Entry, &'static str)> {
    let has = |key: &str| known.iter().any(|e| e.key == key);
    let whole = |keys: &[&str]| keys.iter().all(|key| has(key));
    let absent: Vec<&'static str> = match whole(&KEYS[..3]) || whole(&KEYS[3..]) {
        true => Vec::new(),
        false => KEYS.into_iter().filter(|key| !has(key)).collect(),
    };
    strange.iter().find_map(|e| nearest(&e.key, &absent).map(|key| (e, key)))
}

/// Read a grid file.
///
/// # Errors
/// A file that cannot be read or understood, or a grid without cells.
pub fn read(path: &Path, warnings: &mut Vec<String>) -> Result<Edges> {
    Source::no_geometry(path, "a grid")?;
    crate::text::is_file(path)?;
    parse(path, &crate::text::read(path)?, warnings)
}

/// Read the text of a grid file; `path` names it in messages.
///
/// # Errors
/// As [`read`].
pub fn parse(path: &Path, text: &str, warnings: &mut Vec<String>) -> Result<Edges> {
    let text = text.trim_start_matches('\u{feff}');
    let source = Source::new(path, text);
    let node = if source.is_json() {
        json::placed(text).map_err(|e| misfit(&source, e))?
    } else {
        let table = source.toml()?;
        PlacedValue::of_table(table.get_ref(), table.span()).map_err(|e| misfit(&source, e))?
    };
    let Value::Table(mut entries) = node.value else {
        return Err(Error::file(path, "a grid is a table: x, y, z; or origin, spacing, cells"));
    };
    if let Some(entry) = entries.iter().find(|e| e.key == "grid") {
        let reason = if entries.len() == 1 {
            "this file holds its grid as grid: a grid file is what stands in it, without that name"
        } else {
            "this file holds a [grid] among others: a grid file is the grid alone"
        };
        return Err(misfit(&source, (entry.span.clone(), reason.into())));
    }
    let is_harmless = |key: &str| source.is_json() && HARMLESS.contains(&key);
    let strange: Vec<Entry> =
        entries.extract_if(.., |e| !KEYS.contains(&&e.key[..])).filter(|e| !is_harmless(&e.key)).collect();
    if let Some((entry, key)) = slip(&strange, &entries) {
        let reason = format!("key {} is not known here; did you mean {key}?", entry.key);
        return Err(misfit(&source, (entry.span.clone(), reason)));
    }
    if let Some(entry) = strange.iter().find(|e| ["unit", "units"].contains(&&e.key[..])) {
        let reason = format!("key {} is not known here: a grid is in metres", entry.key);
        return Err(misfit(&source, (entry.span.clone(), reason)));
    }
    for entry in strange {
        let meant =
            if entry.key == "comment" { "; a comment begins with #".to_owned() } else { meant(&entry.key, &KEYS) };
        let reason = format!("key {}: not known, ignored{meant}", entry.key);
        warnings.push(misfit(&source, (entry.span, reason)).to_string());
    }
    let table = PlacedValue { value: Value::Table(entries), span: node.span };
    let spec: GridTable = keys::read(&source, &table, "")?;
    if spec.left_out() == [false; 3]
        && spec.x.is_some()
        && (spec.origin.is_some() || spec.spacing.is_some() || spec.cells.is_some())
    {
        warnings.push(format!("{}: x, y, z are given; origin, spacing, cells beside them are ignored", path.display()));
    }
    spec.edges(&source, "", false)
}

/// The grid that a value of another TOML file describes; `key` is its key there. Unlike a grid file it holds nothing else.
///
/// # Errors
/// If it is none; with the place in `source`.
pub fn from_value(source: &Source, key: &str, value: &toml::Spanned<toml::de::DeValue>) -> Result<Edges> {
    let node = PlacedValue::of_toml(value).map_err(|e| misfit(source, e))?;
    if let Value::Table(entries) = &node.value
        && let Some(entry) = entries.iter().find(|e| !KEYS.contains(&&e.key[..]) && e.key != "file")
    {
        let reason = format!("key {key}.{} {}", entry.key, not_known(&entry.key, &KEYS));
        return Err(misfit(source, (entry.span.clone(), reason)));
    }
    keys::read::<GridTable>(source, &node, key)?.edges(source, &format!("{key}."), false)
}

/// The edges of an axis, or what is wrong with it.
fn axis(spec: &AxisSpec) -> std::result::Result<Vec<f64>, String> {
    let Segments { points, cells, ratios } = match spec {
        AxisSpec::Edges(edges) => return Ok(edges.clone()),
        AxisSpec::Segments(segments) => segments,
    };
    let (given, needed) = (points.len(), points.len().saturating_sub(1));
    let counts = [("cells", Some(cells.len())), ("ratios", ratios.as_ref().map(Vec::len))];
    if given < 2 {
        return Err(format!("needs at least two points, not {given}"));
    }
    if let Some(pair) = points.windows(2).find(|pair| !(pair[0] < pair[1])) {
        return Err(format!("points must ascend: {} does not lie above {}", written(pair[1]), written(pair[0])));
    }
    for (what, n) in counts.into_iter().filter_map(|(what, n)| Some((what, n?))) {
        if n != needed {
            let segments = counted(needed, "segment", "segments");
            return Err(format!("{given} points make {segments}, each with a number in {what}: {needed}, not {n}"));
        }
    }
    let ratios = ratios.clone().unwrap_or_else(|| vec![1.0; cells.len()]);
    if cells.iter().map(|&n| n as f64).sum::<f64>() > MAX_AXIS {
        return Err(format!("more than {MAX_AXIS:e} cells along an axis"));
    }
    let mut edges = vec![points.first().copied().unwrap_or(0.0)];
    for (ends, (&n, &ratio)) in points.windows(2).zip(cells.iter().zip(&ratios)) {
        if n < 1 {
            return Err(format!("a segment needs at least one cell, not {n}"));
        }
        if ratio == 0.0 || !ratio.is_finite() {
            return Err(format!("a segment needs a ratio other than 0, not {ratio}"));
        }
        let ratio = if ratio < 0.0 { -1.0 / ratio } else { ratio };
        edges.extend((1..=n).map(|i| ends[0] + (ends[1] - ends[0]) * share(i, n, ratio)));
        if let Some(last) = edges.last_mut() {
            *last = ends[1];
        }
        let segment = &edges[edges.len() - 1 - n as usize..];
        if ends.iter().all(|end| end.is_finite()) && first_lost(segment).is_some() {
            let [low, high] = [ends[0], ends[1]].map(written);
            return Err(format!(
                "of the {n} cells between the points {low} and {high} some have a width that is lost in rounding: take fewer, a ratio nearer to 1, or points \
                 nearer to 0"
            ));
        }
    }
    Ok(edges)
}

/// Where the `i`-th of `n` cells ends, if lengths grow geometrically and the last is `ratio` times the first.
fn share(i: i64, n: i64, ratio: f64) -> f64 {
    if n == 1 || ratio == 1.0 {
        return i as f64 / n as f64;
    }
    // growth = exp(rate); growth^i − 1 would cancel where the ratio is close to 1.
    let rate = ratio.ln() / (n - 1) as f64;
    (rate * i as f64).exp_m1() / (rate * n as f64).exp_m1()
}
