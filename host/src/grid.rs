//! Grids as the user gives them: edges, a number of cells, or a spacing; or a file, see `file`.

#[cfg(feature = "scene")]
pub mod file;

use crate::error::{Error, Result};
use crate::words::written;
use glam::DVec3;
use std::path::Path;
use voidage_core::grid::{Grid, GridError};

/// Names of the axes.
pub const AXES: [&str; 3] = ["x", "y", "z"];

/// Where the grid comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum GridSpec {
    /// Given, as by a file or a scene.
    Edges(Edges),
    /// A number of cells along each axis in a box; without one, in the scene's box and a margin of one cell.
    Cells([usize; 3], Option<[DVec3; 2]>),
    /// Cubes of this size that cover a box; without one, the scene's box and a margin of one cell.
    Spacing(f64, Option<[DVec3; 2]>),
}

/// Share of a cell by which edges that are written in two ways may differ.
const SAME_PLACE: f64 = 1e-6;

/// Cell edges along x, y and z.
#[derive(Debug, Clone, PartialEq)]
pub struct Edges(pub [Vec<f64>; 3]);

impl Edges {
    /// Equal cells, `cells` of them along each axis, from one corner of a box to the other.
    #[must_use]
    pub fn uniform(lo: DVec3, hi: DVec3, cells: [usize; 3]) -> Self {
        let axis = |a: usize| {
            let (lo, hi, n) = (lo[a], hi[a], cells[a]);
            let decimal = decimal(rounding(lo, hi));
            let edge = |i: usize| match i {
                0 => lo,
                i if i == n => hi,
                i => decimal(lo + (hi - lo) * (i as f64 / n as f64)),
            };
            (0..=n).map(edge).collect()
        };
        Edges([axis(0), axis(1), axis(2)])
    }

    /// The same for a cube along the axes, from `lo` to `hi` on each.
    #[must_use]
    pub fn cube(lo: f64, hi: f64, cells: usize) -> Self {
        Edges::uniform(DVec3::splat(lo), DVec3::splat(hi), [cells; 3])
    }

    /// The edges as a grid.
    ///
    /// # Errors
    /// If they are none; `path` is the file to blame, if there is one.
    pub fn grid(&self, path: Option<&Path>) -> Result<Grid<'_, f64>> {
        self.explained().map_err(|(place, reason)| match path {
            Some(path) => Error::at(path, place, reason),
            None => Error::usage(format!("grid: {place}: {reason}")),
        })
    }

    /// The edges as a grid; or where they make none, and why.
    pub(crate) fn explained(&self) -> std::result::Result<Grid<'_, f64>, (String, String)> {
        Grid::new(&self.0[0], &self.0[1], &self.0[2]).map_err(|error| explain(error, &self.0))
    }

    /// The text of a grid file with these edges, each with all its digits.
    #[must_use]
    pub fn to_json(&self) -> String {
        let [x, y, z] = &self.0;
        format!("{{\"x\": {x:?},\n\"y\": {y:?},\n\"z\": {z:?}}}\n")
    }

    /// What tells these cells from `theirs`, in words; nothing if none of them lies elsewhere by more than rounding. Axes of one cell on both
    /// sides do not count: flow does not vary along them.
    #[must_use]
    pub fn differ_from(&self, theirs: &Edges) -> Option<String> {
        AXES.iter().zip(self.0.iter().zip(&theirs.0)).find_map(|(axis, (ours, theirs))| {
            let [here, there] = [ours, theirs].map(|edges| edges.len().saturating_sub(1));
            if here != there {
                return Some(format!("{there} cells along {axis}, and here {here}"));
            }
            let moved = |n: &usize| {
                let width = ours[n + 1] - ours[*n];
                [0, 1].iter().any(|end| !((ours[n + end] - theirs[n + end]).abs() <= SAME_PLACE * width))
            };
            let cell = (0..here).find(moved).filter(|_| here > 1)?;
            let range = |edges: &[f64]| format!("from {} to {}", written(edges[cell]), written(edges[cell + 1]));
            Some(format!("cell {cell} along {axis} reaches {}, and here {}", range(theirs), range(ours)))
        })
    }

    /// Number of cells along each axis.
    #[must_use]
    pub fn cells(&self) -> [usize; 3] {
        [0, 1, 2].map(|axis| self.0[axis].len().saturating_sub(1))
    }

    /// The same space with every cell cut into `parts` along each axis.
    #[must_use]
    pub fn refined(&self, parts: usize) -> Edges {
        let cut = |edges: &Vec<f64>| {
            let inner = |w: &[f64]| {
                let (low, high) = (w[0], w[1]);
                (0..parts).map(move |n| low + (high - low) * (n as f64 / parts as f64)).collect::<Vec<_>>()
            };
            edges.windows(2).flat_map(inner).chain(edges.last().copied()).collect()
        };
        Edges(self.0.each_ref().map(cut))
    }

    /// How much space the axes span that are not `live`, in m to the power of their number; 1 if all are.
    #[must_use]
    pub fn across(&self, live: &[usize]) -> f64 {
        (0..3).filter(|a| !live.contains(a)).map(|a| self.widths(a).iter().sum::<f64>()).product()
    }

    /// Widths of the cells along an axis. Where they differ by no more than edges are rounded, all are one: a flow that is mirrored
    /// stays so.
    #[must_use]
    pub fn widths(&self, axis: usize) -> Vec<f64> {
        let edges = &self.0[axis];
        let mut widths: Vec<f64> = edges.windows(2).map(|w| w[1] - w[0]).collect();
        if let [lo, .., hi] = edges[..] {
            let mean = (hi - lo) / widths.len() as f64;
            let rounding = 2.0 * f64::EPSILON * lo.abs().max(hi.abs());
            if widths.iter().all(|w| (w - mean).abs() <= rounding) {
                widths.fill(mean);
            }
        }
        widths
    }

    /// Lowest and highest corner.
    #[must_use]
    pub fn bounds(&self) -> [DVec3; 2] {
        let end = |pick: fn(&Vec<f64>) -> Option<&f64>| {
            DVec3::from_array([0, 1, 2].map(|axis| pick(&self.0[axis]).copied().unwrap_or(0.0)))
        };
        [end(|e| e.first()), end(|e| e.last())]
    }

    /// What there is to say of a coordinate that lies outside the grid along an axis, or is none; nothing of others.
    #[must_use]
    pub fn misses(&self, axis: usize, at: f64) -> Option<String> {
        if at.is_nan() {
            return Some("is not a number".to_owned());
        }
        let ([lo, hi], name) = (self.bounds().map(|p| p[axis]), AXES[axis]);
        let outside = !(lo..=hi).contains(&at);
        outside.then(|| format!("the grid reaches from {} to {} along {name}", written(lo), written(hi)))
    }
}

fn explain(error: GridError, edges: &[Vec<f64>; 3]) -> (String, String) {
    let name = |axis: usize| AXES[axis];
    match error {
        GridError::NoCell { axis } => (name(axis).to_owned(), "needs at least two edges".into()),
        GridError::NotFinite { axis, index } => {
            (format!("{}[{index}]", name(axis)), format!("edge {} is not finite", written(edges[axis][index])))
        }
        GridError::NotIncreasing { axis, index } => {
            let (before, here) = (written(edges[axis][index - 1]), written(edges[axis][index]));
            (format!("{}[{index}]", name(axis)), format!("edge {here} does not lie above the one before it, {before}"))
        }
        GridError::OutOfRange => out_of_range(edges),
        other => ("all axes".into(), other.to_string()),
    }
}

/// The axis to blame for cells that are too small, too large or too many, and why. Axes beyond the first that go too far may be anything.
fn out_of_range(edges: &[Vec<f64>; 3]) -> (String, String) {
    let smallest = |e: &Vec<f64>| e.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
    let size = |e: &Vec<f64>| e.last().zip(e.first()).map_or(0.0, |(last, first)| last - first);
    let (finest, sizes) = (edges.each_ref().map(smallest), edges.each_ref().map(size));
    // The volumes that the core computes with, axis by axis.
    for n in 1..=3 {
        let [least, whole] = [finest, sizes].map(|of| of[..n].iter().product::<f64>());
        if !(least >= f64::MIN_POSITIVE / f64::EPSILON) {
            let axis = (1..n).fold(0, |found, a| if finest[a] < finest[found] { a } else { found });
            let reason =
                format!("cells are too small to be computed with: the smallest is {:.0e} m wide", finest[axis]);
            return (AXES[axis].to_owned(), reason);
        }
        if !(whole <= f64::MAX * f64::EPSILON) {
            let axis = (1..n).fold(0, |found, a| if sizes[a] > sizes[found] { a } else { found });
            return (AXES[axis].to_owned(), format!("is too large: it reaches over {:.0e} m", sizes[axis]));
        }
    }
    ("all axes".to_owned(), "cells are too many to be counted".to_owned())
}

/// What a sum or a product of coordinates between two others is rounded by.
fn rounding(lo: f64, hi: f64) -> f64 {
    4.0 * f64::EPSILON * lo.abs().max(hi.abs())
}

/// Coordinates as people would write them: a decimal that lies within `room` of one takes its place, if its last digit counts ten times `room` or
/// more. So 3 × 0.1 is 0.3, and what ends at 0.3 ends in a plane of the grid.
fn decimal(room: f64) -> impl Fn(f64) -> f64 {
    let digits = -(room.log10().ceil() + 1.0);
    // Powers of ten up to this are exact.
    let power = if digits.abs() <= 22.0 { Some(10_f64.powi(digits.abs() as i32)) } else { None };
    move |at| {
        let Some(power) = power else { return at };
        let written = if digits < 0.0 { (at / power).round() * power } else { (at * power).round() / power };
        if (written - at).abs() <= room { written } else { at }
    }
}

/// A box in round numbers where its corners are such but for the rounding of sums.
fn round_box(lo: DVec3, hi: DVec3) -> [DVec3; 2] {
    let [x, y, z] = [0, 1, 2].map(|a| [lo[a], hi[a]].map(decimal(rounding(lo[a], hi[a]))));
    [0, 1].map(|end| DVec3::new(x[end], y[end], z[end]))
}

/// Most cells of a grid: beyond, the fields would not fit into any memory this program will meet.
const MAX_CELLS: f64 = 4e9;

/// Numbers of cells from here on are told by a power of ten.
const MANY: f64 = 1e12;

/// Most cells along one axis.
const MAX_AXIS: f64 = 1e8;

/// Make the edges. `scene` is the box of all bodies; what is odd but harmless goes to `warnings`.
///
/// # Errors
/// A file that cannot be read or understood, or a grid without cells.
pub fn edges(source: &GridSpec, scene: Option<[DVec3; 2]>, warnings: &mut Vec<String>) -> Result<Edges> {
    let edges = match source {
        GridSpec::Edges(edges) => edges.clone(),
        GridSpec::Cells(cells, bounds) => {
            // With n cells in all, n − 2 span the scene and one each side is the margin.
            let [lo, hi] = bounds.map_or_else(|| around(scene), Ok)?;
            let count = DVec3::from_array(cells.map(|n| n as f64));
            let margin = match bounds {
                Some(_) => DVec3::ZERO,
                None => (hi - lo) / (count - 2.0).max(DVec3::ONE),
            };
            few_enough(count).map_err(|reason| Error::usage(format!("grid: {reason}")))?;
            let [lo, hi] = if bounds.is_some() { [lo, hi] } else { round_box(lo - margin, hi + margin) };
            Edges::uniform(lo, hi, *cells)
        }
        GridSpec::Spacing(d, bounds) => {
            let margin = if bounds.is_some() { 0.0 } else { *d };
            let [lo, hi] = bounds.map_or_else(|| around(scene), Ok)?;
            let (lo, hi) = (lo - margin, hi + margin);
            // A length that is a whole number of cells but for rounding must not gain one.
            let count = ((hi - lo) / *d - 1e-9).ceil().max(DVec3::ONE);
            few_enough(count).map_err(|reason| Error::usage(format!("grid: {reason}")))?;
            let cells = count.to_array().map(|n| n as usize);
            let [lo, end] = round_box(lo, lo + count * *d);
            if bounds.is_some() && (end - hi).cmpgt(DVec3::splat(*d * 1e-6)).any() {
                warnings.push(format!(
                    "grid: the box is not a whole number of cells of {} m; it now ends at {}",
                    written(*d),
                    corner(end)
                ));
            }
            Edges::uniform(lo, end, cells)
        }
    };
    let rising = || edges.0.iter().all(|along| along.windows(2).all(|w| w[0] < w[1]));
    match (source, scene) {
        (GridSpec::Cells(_, None) | GridSpec::Spacing(_, None), Some(scene)) if edges.explained().is_err() => {
            Err(Error::new(format!("the scene {}, for a grid around it", too_small(scene))))
        }
        (GridSpec::Cells(_, Some(bounds)) | GridSpec::Spacing(_, Some(bounds)), _) if !rising() => {
            let cells = edges.cells().map(|n| n.to_string()).join(" × ");
            Err(Error::usage(format!("grid: the box {}, for {cells} cells", too_small(*bounds))))
        }
        _ => Ok(edges),
    }
}

/// What there is to say of a box that has not numbers enough for all edges within it or around it.
fn too_small([lo, hi]: [DVec3; 2]) -> String {
    format!("reaches from {} to {}: it is too small, or too far from the origin for its size", corner(lo), corner(hi))
}

fn corner(p: DVec3) -> String {
    format!("({})", p.to_array().map(written).join(", "))
}

/// Whether so many cells can be thought of; else why not.
fn few_enough(count: DVec3) -> std::result::Result<(), String> {
    let [x, y, z] = count.to_array();
    if x * y * z <= MAX_CELLS && count.max_element() <= MAX_AXIS {
        return Ok(());
    }
    let [x, y, z] = [x, y, z].map(|n| if n < MANY { n.to_string() } else { written(n) });
    Err(format!("{x} × {y} × {z} cells are too many: at most {MAX_CELLS:e}, and {MAX_AXIS:e} along an axis"))
}

/// Boxes around solids are wider than these by less than this share of their size.
const BOX_ROOM: f64 = 1e-11;

/// Cells that span the longest side of a scene or a box, unless the user says how many.
const USUAL_CELLS: f64 = 64.0;

/// The usual size of cubic cells in a box, else around a scene.
#[must_use]
pub fn usual_spacing(bounds: Option<[DVec3; 2]>, scene: Option<[DVec3; 2]>) -> f64 {
    let size = bounds.map_or_else(|| around(scene), Ok).map_or(0.0, |[lo, hi]| (hi - lo).max_element());
    if size > 0.0 { size / USUAL_CELLS } else { 1.0 }
}

fn around(scene: Option<[DVec3; 2]>) -> Result<[DVec3; 2]> {
    let [lo, hi] = scene.ok_or_else(|| Error::new("the scene is empty: give --bounds"))?;
    let size = (hi - lo).max_element();
    // The box around a round solid has room for rounding.
    let room = |a: usize| rounding(lo[a], hi[a]).max(size * BOX_ROOM);
    let [lo, hi] = [lo, hi].map(|p| DVec3::from_array([0, 1, 2].map(|a| decimal(room(a))(p[a]))));
    // A flat scene still needs a box with a volume.
    let thin = DVec3::select((hi - lo).cmpgt(DVec3::ZERO), DVec3::ZERO, DVec3::splat(size * 0.5));
    Ok([lo - thin, hi + thin])
}
