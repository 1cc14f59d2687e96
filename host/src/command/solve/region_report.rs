//! What the regions of a case came to: how well the grid resolves each, and how much of it is gas.

use super::arrays::index;
use super::case::side_word;
use super::case_file::CaseFile;
use super::cut_off;
use super::open_parts::{Hold, OpenParts};
use super::regions::Region;
use crate::command::progress::Progress;
use crate::error::Result;
use crate::flow::Flow;
use crate::grid::Edges;
use serde::Serialize;

/// How well the grid resolves a region.
#[derive(Debug, Clone, Serialize)]
pub struct RegionReport {
    /// Half the extent along an axis, in the widest cells that it meets there; the smallest of these. Axes along which it reaches from side to side of the grid
    /// have no part in it: none if all do, or it holds nothing of any cell.
    pub cells_per_radius: Option<f64>,
    /// Sides of the grid that cut it, if it is a ball: what lies beyond them is left out.
    pub cut_by: Vec<String>,
    /// Volume of the region within the grid, in m³.
    pub volume: f64,
    /// What of it is no solid, in m³.
    pub open_volume: f64,
    /// May a blast start from it? Not where it has the pressure of what is around it.
    #[serde(skip)]
    pub may_blast: bool,
}

/// Of a region that is less open than this, it is said how much is.
const MOSTLY_SOLID: f64 = 0.5;

/// What the regions of a case came to in a flow; those that change nothing, or less than they say, are told.
///
/// # Errors
/// As [`Region::shares`].
pub fn report<const D: usize>(
    file: &CaseFile,
    (flow, parts): (&Flow<f64, D>, &OpenParts),
    edges: &Edges,
    live: [usize; D],
    progress: &mut Progress,
) -> Result<Vec<RegionReport>> {
    let mut all = Vec::new();
    for (n, region) in Region::all(file)?.into_iter().enumerate() {
        let key = format!("initial.regions[{n}]");
        let shares = region.shares(edges).map_err(|reason| file.wrong(&key, reason))?;
        let holds = shares.iter().map(|&(cell, share)| (cell, Hold { region: n, share }));
        let [volume, open_volume] = volumes(edges, flow.beta_v(), parts, holds);
        let cells_per_radius = cells_per_radius(&region, edges, &live).filter(|_| !shares.is_empty());
        let initial = &file.case.initial;
        let around = initial.uniform.as_ref().and_then(|uniform| uniform.p);
        let may_blast = around.is_none() || initial.regions[n].p != around;
        let cut_by = cut_by(&region, edges, &live);
        let report = RegionReport { cells_per_radius, cut_by, volume, open_volume, may_blast };
        let open = open_volume / volume;
        let trouble = match report.cells_per_radius {
            _ if region.is_outside(edges) => "lies outside the grid: it has no effect".to_owned(),
            _ if shares.is_empty() => "holds nothing of any cell: it has no effect".to_owned(),
            _ if open_volume == 0.0 => "lies wholly in solid: it has no effect".to_owned(),
            _ if open < MOSTLY_SOLID => {
                let percent = 100.0 * open;
                format!("is {percent:.2} % open, the rest is solid: its mass and energy are those of the open part")
            }
            _ if initial.uniform.is_some() && covers_all(&shares, edges) => {
                "covers the whole grid: nothing remains of initial.uniform, and overpressures count from the pressure of the region unless \
                 output.ambient says another"
                    .to_owned()
            }
            Some(cells) if cells < 0.5 => {
                "is smaller than a cell: its mass and energy are spread over the cells that hold it".to_owned()
            }
            _ => String::new(),
        };
        let held = |cell, share| parts.held(cell, Hold { region: n, share });
        let cut_off = if may_blast { cut_off::told(flow, &shares, edges, held) } else { None };
        for trouble in cut_off.into_iter().chain((!trouble.is_empty()).then_some(trouble)) {
            progress.warn(file.remark(&key, trouble));
        }
        all.push(report);
    }
    Ok(all)
}

/// Do shares of cells make the whole grid?
fn covers_all(shares: &[(usize, f64)], edges: &Edges) -> bool {
    shares.len() == edges.cells().iter().product::<usize>() && shares.iter().all(|&(_, share)| share == 1.0)
}

/// A ball reaches to a side of the grid but for this share of its radius: it touches it.
const TOUCH: f64 = 1e-9;

/// As [`RegionReport::cut_by`], of the axes `live`.
fn cut_by(region: &Region, edges: &Edges, live: &[usize]) -> Vec<String> {
    let Region::Ball(center, radius) = region else { return Vec::new() };
    let bounds = edges.bounds();
    let cuts = |&(axis, side): &(usize, usize)| {
        let room = if side == 0 { center[axis] - bounds[0][axis] } else { bounds[1][axis] - center[axis] };
        room < radius * (1.0 - TOUCH)
    };
    let sides = live.iter().flat_map(|&axis| [(axis, 0), (axis, 1)]);
    sides.filter(cuts).map(|(axis, side)| side_word(axis, side)).collect()
}

/// As [`RegionReport::cells_per_radius`], of the axes `live`.
fn cells_per_radius(region: &Region, edges: &Edges, live: &[usize]) -> Option<f64> {
    let mut per_radius = f64::INFINITY;
    for &a in live {
        let ([from, to], [lo, hi]) = (region.extent(a), edges.bounds());
        if from <= lo[a] && hi[a] <= to {
            continue;
        }
        let met = edges.0[a].windows(2).filter(|e| e[1] > from && e[0] < to);
        let widest = met.map(|e| e[1] - e[0]).fold(0.0, f64::max);
        per_radius = per_radius.min(0.5 * (to - from) / widest);
    }
    per_radius.is_finite().then_some(per_radius)
}

/// Volume of what a region holds of cells as open as `beta_v`, and the open part of it.
fn volumes(
    edges: &Edges,
    beta_v: Option<&[f64]>,
    parts: &OpenParts,
    holds: impl Iterator<Item = (usize, Hold)>,
) -> [f64; 2] {
    let widths = [0, 1, 2].map(|a| edges.widths(a));
    let mut sums = [0.0; 2];
    for (cell, hold) in holds {
        let [i, j, k] = index(cell, edges.cells());
        let volume = widths[0][i] * widths[1][j] * widths[2][k];
        sums[0] += hold.share * volume;
        sums[1] += parts.held(cell, hold) * beta_v.map_or(1.0, |beta| beta[cell]) * volume;
    }
    sums
}
