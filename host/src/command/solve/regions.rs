//! Regions of a case, boxes and balls, and the share of each cell that they take: what a region holds does not depend on the grid.

use super::arrays::index;
use super::case::StateKeys;
use super::case_file::CaseFile;
use crate::command::progress::Progress;
use crate::error::Result;
use crate::flow::Flow;
use crate::grid::{AXES, Edges};
use crate::words::written;
use glam::DVec3;
use serde::Serialize;
use voidage_core::grid::Grid;
use voidage_core::grid::cell_range::RangeKind;
use voidage_core::solids::quadric::QuadricSolid;

/// A region of space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Region {
    /// Lowest and highest corner, in m; may be infinite.
    Box([f64; 3], [f64; 3]),
    /// Centre and radius, in m. Axes whose centre is NaN do not count: a cylinder, or a layer.
    Ball([f64; 3], f64),
}

/// How well the grid resolves a region.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct RegionReport {
    /// Radius, or half the smallest extent of a box, in the widest cells that it meets; none if it is not bounded.
    pub cells_per_radius: Option<f64>,
    /// Volume of the region within the grid, in m³.
    pub volume: f64,
    /// What of it is no solid, in m³.
    pub open_volume: f64,
}

/// Of a region that is less open than this, it is said how much is.
const MOSTLY_SOLID: f64 = 0.5;

/// A share this close to none or all is rounding.
const ROUNDING: f64 = 1e-12;

impl Region {
    /// The region of a table at `key`.
    ///
    /// # Errors
    /// Its keys are those of neither a box nor a ball.
    pub fn new(file: &CaseFile, key: &str, keys: &StateKeys) -> Result<Self> {
        let of_box = ["min", "max"].into_iter().find(|k| keys.given().contains(k));
        match (&keys.center, keys.radius, of_box) {
            (None, None, _) => Region::of_box(file, key, &keys.min, &keys.max),
            (_, _, Some(of_box)) => {
                let reason = "is of a box; a ball has center and radius: a region is one of them";
                Err(file.wrong(&format!("{key}.{of_box}"), reason))
            }
            (Some(_), Some(radius), None) => {
                // A ball in the plane of a flow, or an interval: axes that are left out do not count.
                Ok(Region::Ball(point(file, &format!("{key}.center"), &keys.center, f64::NAN)?, radius))
            }
            (None, Some(_), None) => Err(file.wrong(key, "a ball needs a center beside its radius")),
            (Some(_), None, None) => Err(file.wrong(key, "a ball needs a radius beside its center")),
        }
    }

    /// A box between two corners; axes that these leave out reach to infinity.
    ///
    /// # Errors
    /// Corners of no numbers or too many, or in the wrong order.
    pub fn of_box(file: &CaseFile, key: &str, min: &Option<Vec<f64>>, max: &Option<Vec<f64>>) -> Result<Self> {
        let (lower, upper) = (format!("{key}.min"), format!("{key}.max"));
        let min = point(file, &lower, min, f64::NEG_INFINITY)?;
        let max = point(file, &upper, max, f64::INFINITY)?;
        match (0..3).find(|&a| min[a] > max[a]) {
            None => Ok(Region::Box(min, max)),
            Some(a) => {
                let (axis, [min, max]) = (AXES[a], [min[a], max[a]].map(written));
                Err(file.wrong(&upper, format!("must not lie below min: along {axis} it is {max}, and min is {min}")))
            }
        }
    }

    /// Lowest and highest place along an axis.
    #[must_use]
    pub fn extent(&self, axis: usize) -> [f64; 2] {
        match self {
            Region::Box(min, max) => [min[axis], max[axis]],
            Region::Ball(center, _) if center[axis].is_nan() => [f64::NEG_INFINITY, f64::INFINITY],
            Region::Ball(center, radius) => [center[axis] - radius, center[axis] + radius],
        }
    }

    /// Wholly beyond the grid.
    #[must_use]
    pub fn is_outside(&self, edges: &Edges) -> bool {
        let [lo, hi] = edges.bounds().map(|p| p.to_array());
        (0..3).any(|a| self.extent(a)[1] < lo[a] || self.extent(a)[0] > hi[a])
    }

    /// The cells that hold some of the region, and the share of each one's volume that it takes, x fastest.
    ///
    /// # Errors
    /// It is round, and so far away that rounding has left no cells; as a reason.
    pub fn shares(&self, edges: &Edges) -> std::result::Result<Vec<(usize, f64)>, String> {
        if self.is_outside(edges) {
            return Ok(Vec::new());
        }
        let all = match self.solid(edges) {
            Some(solid) => round(&solid.0, &solid.1)?,
            None => self.box_shares(edges),
        };
        let all = all.into_iter().filter(|(_, share)| *share > ROUNDING);
        Ok(all.map(|(cell, share)| (cell, if share > 1.0 - ROUNDING { 1.0 } else { share })).collect())
    }

    /// A ball, or a cylinder that reaches beyond the grid, with the grid seen from its centre. None for what has plane sides alone.
    fn solid(&self, edges: &Edges) -> Option<(QuadricSolid, Edges)> {
        let Region::Ball(center, radius) = self else { return None };
        let round: Vec<usize> = (0..3).filter(|&a| !center[a].is_nan()).collect();
        let origin = center.map(|x| if x.is_nan() { 0.0 } else { x });
        let seen = Edges([0, 1, 2].map(|a| edges.0[a].iter().map(|x| x - origin[a]).collect()));
        let solid = match round[..] {
            [_, _, _] => QuadricSolid::ball(DVec3::ZERO, *radius)?,
            [a, b] => {
                let along = 3 - a - b;
                let [lo, hi] = seen.bounds().map(|p| p.to_array()[along]);
                let end = |x: f64| DVec3::from_array([0, 1, 2].map(|axis| if axis == along { x } else { 0.0 }));
                QuadricSolid::cylinder(end(lo - (hi - lo)), end(hi + (hi - lo)), *radius)?
            }
            _ => return None,
        };
        Some((solid, seen))
    }

    /// Shares of what has plane sides along the axes.
    fn box_shares(&self, edges: &Edges) -> Vec<(usize, f64)> {
        let along = [0, 1, 2].map(|a| {
            let [from, to] = self.extent(a);
            let share = move |e: &[f64]| ((to.min(e[1]) - from.max(e[0])) / (e[1] - e[0])).clamp(0.0, 1.0);
            edges.0[a].windows(2).map(share).collect::<Vec<f64>>()
        });
        let [nx, ny, _] = edges.cells();
        let [x, y, z] =
            along.each_ref().map(|shares| shares.iter().copied().enumerate().filter(|(_, share)| *share > 0.0));
        let mut all = Vec::new();
        for (k, in_z) in z {
            for (j, in_y) in y.clone() {
                all.extend(x.clone().map(|(i, in_x)| ((k * ny + j) * nx + i, in_x * in_y * in_z)));
            }
        }
        all
    }

    /// How well a grid, of which the axes `live` flow and the cells are as `open` as this, resolves the region that takes these `shares` of
    /// its cells.
    fn report(&self, edges: &Edges, live: &[usize], open: Option<&[f64]>, shares: &[(usize, f64)]) -> RegionReport {
        let mut per_radius = f64::INFINITY;
        for &a in live {
            let [from, to] = self.extent(a);
            let met = edges.0[a].windows(2).filter(|e| e[1] > from && e[0] < to);
            let widest = met.map(|e| e[1] - e[0]).fold(0.0, f64::max);
            per_radius = per_radius.min(0.5 * (to - from) / widest);
        }
        let widths = [0, 1, 2].map(|a| edges.widths(a));
        let volume = |cell: usize| {
            let [i, j, k] = index(cell, edges.cells());
            widths[0][i] * widths[1][j] * widths[2][k]
        };
        RegionReport {
            cells_per_radius: per_radius.is_finite().then_some(per_radius),
            volume: shares.iter().map(|&(cell, share)| share * volume(cell)).sum(),
            open_volume: shares.iter().map(|&(cell, share)| share * volume(cell) * open.map_or(1.0, |b| b[cell])).sum(),
        }
    }
}

/// A point of one to three numbers; the others are `missing`.
fn point(file: &CaseFile, key: &str, p: &Option<Vec<f64>>, missing: f64) -> Result<[f64; 3]> {
    match p {
        None => Ok([missing; 3]),
        Some(p) if (1..=3).contains(&p.len()) => Ok([0, 1, 2].map(|a| p.get(a).copied().unwrap_or(missing))),
        Some(p) => Err(file.wrong(key, format!("needs one to three numbers, not {}", p.len()))),
    }
}

/// What the regions of a case came to in a flow; those that change nothing, or less than they say, are told.
///
/// # Errors
/// As [`Region::shares`].
pub fn report<const D: usize>(
    file: &CaseFile,
    flow: &Flow<f64, D>,
    edges: &Edges,
    live: [usize; D],
    progress: &mut Progress,
) -> Result<Vec<RegionReport>> {
    let mut all = Vec::new();
    for (n, keys) in file.case.initial.regions.iter().enumerate() {
        let key = format!("initial.regions[{n}]");
        let region = Region::new(file, &key, keys)?;
        let shares = region.shares(edges).map_err(|reason| file.wrong(&key, reason))?;
        let report = region.report(edges, &live, flow.beta_v(), &shares);
        let open = report.open_volume / report.volume;
        let trouble = match report.cells_per_radius {
            _ if region.is_outside(edges) => "lies outside the grid: it has no effect".to_owned(),
            _ if shares.is_empty() => "holds nothing of any cell: it has no effect".to_owned(),
            _ if report.open_volume == 0.0 => "lies wholly in solid: it has no effect".to_owned(),
            _ if open < MOSTLY_SOLID => {
                let percent = 100.0 * open;
                format!("is {percent:.2} % open, the rest is solid: its mass and energy are those of the open part")
            }
            Some(cells) if cells < 0.5 => {
                "is smaller than a cell: its mass and energy are spread over the cells that hold it".to_owned()
            }
            _ => String::new(),
        };
        if !trouble.is_empty() {
            progress.warn(file.remark(&key, trouble));
        }
        all.push(report);
    }
    Ok(all)
}

/// Shares of a round solid.
fn round(solid: &QuadricSolid, edges: &Edges) -> std::result::Result<Vec<(usize, f64)>, String> {
    let far = |_| "its center lies so far from the grid that cells cannot be told apart from there".to_owned();
    let grid: Grid<f64> = edges.explained().map_err(far)?;
    let [nx, ny, nz] = grid.cells();
    let mut all = Vec::new();
    for k in 0..nz {
        let mut visit = |kind: RangeKind, at: usize, share: f64| {
            if kind == RangeKind::Cells {
                all.push((k * nx * ny + at, share));
            }
        };
        let _ = solid.layer(&grid, k, false, &mut visit);
    }
    Ok(all)
}
