//! Pictures of frames: speed and overpressure in three planes, and γ of two gases, with one range of colours for all frames of a run.
//!
//! A frame is drawn when it is reached, with the range that the run has had so far, unless the case gives one; its planes are kept in `frames/slices`,
//! and at the end of the run all frames are drawn again with the range of the whole run. That of the overpressure is the one outside the regions that a blast starts
//! from, whose beginning would leave one dark colour to all the rest.

use super::case_file::CaseFile;
use super::charges::Charges;
use super::frames::{self, SLICES, Snapshot, cell_at, point};
use super::output_keys::OutputKeys;
use super::setup::Setup;
use crate::error::{Error, Result};
use crate::files::npy;
use crate::grid::Edges;
use crate::picture::colour::ColourMap;
use crate::picture::figure::Figure;
use crate::picture::png;
use crate::picture::ticks::number;
use serde::Serialize;
use std::fmt;
use std::path::{Path, PathBuf};
use voidage_core::flow::Gas;

/// The keys of pictures make sense: formats, ends of colours, a point within the grid.
///
/// # Errors
/// One does not; of the point with the range of the grid along the axis.
pub fn check(file: &CaseFile, edges: &Edges) -> Result<()> {
    let keys = &file.case.output;
    file.distinct("output.formats", keys.formats())?;
    for (name, ends) in [("speed", keys.range.speed), ("overpressure", keys.range.overpressure)] {
        if ends.is_some_and(|[low, high]| !(low < high && (high - low).is_finite())) {
            return Err(file.wrong(&format!("output.range.{name}"), "needs two numbers, the lower one first"));
        }
    }
    let Some(given) = &keys.slice else { return Ok(()) };
    point(edges, given).map(drop).map_err(|(at, why)| file.wrong(&format!("output.slice{at}"), why))
}

/// Where pictures are cut, what is written over them, and their colours.
#[derive(Debug, Clone)]
pub struct Pictures {
    title: String,
    at: [usize; 3],
    ambient: f64,
    given: [Option<[f64; 2]>; 2],
    /// Range of each field in the frames so far.
    seen: [[f64; 2]; 2],
    /// That of the overpressure outside the regions that a blast starts from.
    outside: [f64; 2],
    /// Which cells of the planes these regions hold.
    held: Vec<bool>,
}

/// Ends of the colours of all frames.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Colours {
    /// In m/s.
    pub speed: [f64; 2],
    /// In kPa.
    pub overpressure: [f64; 2],
    /// The latter is the range outside the regions that a blast starts from.
    #[serde(skip)]
    pub is_outside: bool,
}

/// Names over the colours, of the files, and of the units.
const FIELDS: [(&str, &str, &str); 2] = [("speed [m/s]", "speed", " m/s"), ("overpressure [kPa]", "pressure", " kPa")];

/// A picture of a field.
struct Picture<'a> {
    /// What stands over the colours.
    name: &'a str,
    /// Behind a number, with the space between; empty of what has none.
    unit: &'a str,
    values: &'a [f64],
    /// Ends of the colours.
    range: [f64; 2],
    path: PathBuf,
}

/// Pascals in the unit of the pictures.
const KILO: f64 = 1e3;

/// Words beside the ends of the colours, where values lie beyond them.
const BEYOND: [&str; 2] = ["and below", "and above"];

/// Of the whole range of the overpressure, a smaller share outside is none: nothing has come there.
const NONE_OUTSIDE: f64 = 1e-6;

impl Pictures {
    /// Cuts where the case says, else through the middle of the first of the `charges`, or where the porosity shows most, or in the middle; overpressures are counted
    /// from `ambient`.
    #[must_use]
    pub fn new<const D: usize>(
        setup: &Setup<D>,
        title: &str,
        keys: &OutputKeys,
        ambient: f64,
        charges: &Charges,
    ) -> Self {
        let edges = &setup.edges;
        let middle = edges.cells().map(|n| n / 2);
        let telling = |beta| png::most_telling_space(edges.0.each_ref().map(|e| &e[..]), beta);
        let usual = setup.flow.beta_v().and_then(telling).unwrap_or(middle);
        let [lo, _] = edges.bounds().map(|p| p.to_array());
        let given = keys.slice.as_ref().and_then(|given| point(edges, given).ok());
        let at = match (given, charges.middle()) {
            (Some(point), _) => cell_at(edges, point).unwrap_or(middle),
            (None, places) => {
                let through = cell_at(edges, [0, 1, 2].map(|a| places[a].unwrap_or(lo[a]))).unwrap_or(usual);
                [0, 1, 2].map(|a| if places[a].is_some() { through[a] } else { usual[a] })
            }
        };
        let (title, given) = (title.to_owned(), [keys.range.speed, keys.range.overpressure]);
        let mut pictures =
            Pictures { title, at, ambient, given, seen: [NOTHING; 2], outside: NOTHING, held: Vec::new() };
        if !charges.is_empty() {
            pictures.held = pictures.cells(setup).map(|cell| charges.hold(cell)).collect();
        }
        pictures
    }

    /// The cell through which they are cut.
    #[must_use]
    pub fn at(&self) -> [usize; 3] {
        self.at
    }

    /// Ends of the colours, as far as the run has come.
    #[must_use]
    pub fn colours(&self) -> Colours {
        let width = |[low, high]: [f64; 2]| high - low;
        let [speed, whole] = self.seen;
        let has_come = !self.held.is_empty() && width(self.outside) > NONE_OUTSIDE * width(whole);
        let usual = if has_come { self.outside } else { whole };
        let [given_speed, given] = self.given;
        let (speed, overpressure) = (given_speed.unwrap_or(speed), given.unwrap_or(usual));
        Colours { speed, overpressure, is_outside: has_come && given.is_none() }
    }

    /// Draws the `n`-th frame into `dir`, and keeps its planes if its colours may change.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn frame<const D: usize>(
        &mut self,
        setup: &Setup<D>,
        shot: &Snapshot,
        (n, time): (usize, f64),
        dir: &Path,
    ) -> Result<()> {
        let over = shot.pressure.iter().map(|p| (p - self.ambient) / KILO).collect();
        let fields = [shot.speed(), over].map(|values| without_solids(setup, values));
        let planes = fields.each_ref().map(|values| self.cut(setup, values));
        self.see(&planes);
        if self.given.contains(&None) {
            let both = planes.concat();
            npy::write_all(&dir.join(SLICES), &[(format!("{n:04}"), [both.len() / 2, 2, 1], &both)])?;
        } else {
            frames::forget(&kept(dir, n))?;
        }
        self.draw_both(setup, fields.each_ref().map(|f| &f[..]), time, file_names(dir, n))?;
        // No mixture of gases has a γ beyond those of the case: one range from the beginning.
        if let (Some(gammas), Gas::Mixed { gammas: range }) = (&shot.gamma, setup.flow.gas()) {
            let within = gammas.iter().map(|g| g.clamp(range[0], range[1])).collect(); // but for rounding
            let (values, path) = (&without_solids(setup, within)[..], dir.join(format!("gamma_{n:04}.png")));
            self.draw(setup, &Picture { name: "gamma", unit: "", values, range, path }, time)?;
        }
        Ok(())
    }

    /// Draws all frames again whose planes are kept: with the range of the whole run, or with that which the case gives since it went on.
    ///
    /// # Errors
    /// A file cannot be read or written.
    pub fn again<const D: usize>(&mut self, setup: &Setup<D>, times: &[f64], dir: &Path) -> Result<()> {
        for pass in 0..2 {
            for (n, &time) in times.iter().enumerate().filter(|(n, _)| kept(dir, *n).exists()) {
                let (_, both) = npy::read(&kept(dir, n))?;
                let planes: [Vec<f64>; 2] = [both[..both.len() / 2].to_vec(), both[both.len() / 2..].to_vec()];
                if self.cells(setup).count() != planes[0].len() {
                    return Err(Error::file(&kept(dir, n), "is of another case: remove it"));
                }
                match pass {
                    0 => self.see(&planes),
                    _ => {
                        let fields = planes.each_ref().map(|values| self.spread(setup, values));
                        self.draw_both(setup, fields.each_ref().map(|f| &f[..]), time, file_names(dir, n))?;
                    }
                }
            }
        }
        Ok(())
    }

    /// The values in the three planes that are drawn.
    fn cut<const D: usize>(&self, setup: &Setup<D>, values: &[f64]) -> Vec<f64> {
        self.cells(setup).map(|cell| values[cell]).collect()
    }

    /// A field that holds the values of the three planes and nothing else.
    fn spread<const D: usize>(&self, setup: &Setup<D>, planes: &[f64]) -> Vec<f64> {
        let mut values = vec![f64::NAN; setup.flow.len()];
        self.cells(setup).zip(planes).for_each(|(cell, v)| values[cell] = *v);
        values
    }

    /// The cells of the planes across x, y and z.
    fn cells<const D: usize>(&self, setup: &Setup<D>) -> impl Iterator<Item = usize> {
        let ([nx, ny, nz], [i, j, k]) = (setup.edges.cells(), self.at);
        let cell = move |i: usize, j: usize, k: usize| (k * ny + j) * nx + i;
        let across_x = (0..nz).flat_map(move |k| (0..ny).map(move |j| cell(i, j, k)));
        let across_y = (0..nz).flat_map(move |k| (0..nx).map(move |i| cell(i, j, k)));
        let across_z = (0..ny).flat_map(move |j| (0..nx).map(move |i| cell(i, j, k)));
        across_x.chain(across_y).chain(across_z)
    }

    /// Widens the ranges of the run; all hold 0.
    fn see(&mut self, planes: &[Vec<f64>; 2]) {
        let widened = |range: [f64; 2], v: f64| [range[0].min(v), range[1].max(v)]; // NaN widens nothing
        for (seen, values) in self.seen.iter_mut().zip(planes) {
            *seen = values.iter().fold(*seen, |range, &v| widened(range, v));
        }
        let outside = planes[1].iter().zip(&self.held).filter(|(_, held)| !**held);
        self.outside = outside.fold(self.outside, |range, (&v, _)| widened(range, v));
    }

    /// Speed and overpressure, with the colours of the run so far.
    fn draw_both<const D: usize>(
        &self,
        setup: &Setup<D>,
        fields: [&[f64]; 2],
        time: f64,
        paths: [PathBuf; 2],
    ) -> Result<()> {
        let colours = self.colours();
        let ranges = [colours.speed, colours.overpressure];
        for (n, path) in paths.into_iter().enumerate() {
            let (name, _, unit) = FIELDS[n];
            self.draw(setup, &Picture { name, unit, values: fields[n], range: ranges[n], path }, time)?;
        }
        Ok(())
    }

    fn draw<const D: usize>(&self, setup: &Setup<D>, picture: &Picture, time: f64) -> Result<()> {
        let edges = setup.edges.0.each_ref().map(|e| &e[..]);
        let blocked: Option<Vec<f64>> = setup.flow.beta_v().map(|beta| beta.iter().map(|b| 1.0 - b).collect());
        let (title, moment) = (&self.title[..], &format!(" · t = {} s", number(time))[..]);
        let solid = setup.space.is_some_and(|s| s.closed_cells > 0);
        let note = png::grid_note(edges, "m")
            + if solid { " · solid in mauve" } else { "" }
            + if blocked.is_some() { " · partly solid hatched" } else { "" };
        let (map, unit, ends, at) = (&ColourMap::sequential(), "m", BEYOND, self.at);
        let Picture { name, values, range, ref path, .. } = *picture;
        let [low, high] = self.cut(setup, values).into_iter().fold(range, |[a, b], v| [a.min(v), b.max(v)]);
        let told = [low < range[0], high > range[1]];
        let highest =
            if told[1] { format!(" · highest value {}{}", number(high), picture.unit) } else { String::new() };
        let note = &(note + &highest)[..];
        let figure = Figure { title, moment, note, edges, unit, values, at, name, range, ends, told, map };
        let canvas = match &blocked {
            Some(blocked) => figure.draw_hatched(blocked),
            None => figure.draw(),
        };
        canvas.map_err(|reason| Error::file(path, reason))?.write(path)
    }
}

impl fmt::Display for Colours {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ends = |[low, high]: [f64; 2]| format!("{} to {}", number(low), number(high));
        let of = if self.is_outside { ", that outside the starting regions" } else { "" };
        write!(f, "speed {} m/s, overpressure {} kPa{of}", ends(self.speed), ends(self.overpressure))
    }
}

/// A field with NaN in closed cells.
fn without_solids<const D: usize>(setup: &Setup<D>, mut values: Vec<f64>) -> Vec<f64> {
    let beta = setup.flow.beta_v().unwrap_or_default();
    values.iter_mut().zip(beta).filter(|(_, b)| **b == 0.0).for_each(|(v, _)| *v = f64::NAN);
    values
}

/// A range that holds 0 and nothing else yet.
const NOTHING: [f64; 2] = [0.0, 0.0];

/// Where the planes of the `n`-th frame are kept.
fn kept(dir: &Path, n: usize) -> PathBuf {
    dir.join(SLICES).join(format!("{n:04}.npy"))
}

fn file_names(dir: &Path, n: usize) -> [PathBuf; 2] {
    FIELDS.map(|(_, name, _)| dir.join(format!("{name}_{n:04}.png")))
}
