//! Regions of a case, boxes and balls, and the share of each cell that they take: what a region holds does not depend on the grid.

use super::case::StateKeys;
use super::case_file::CaseFile;
use crate::error::Result;
use crate::geometry::scene::shape::{Round, Shape};
use crate::grid::{AXES, Edges};
use crate::words::written;
use glam::DVec3;
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

    /// All regions of a case, in their order.
    ///
    /// # Errors
    /// As [`Region::new`].
    pub fn all(file: &CaseFile) -> Result<Vec<Region>> {
        let tables = file.case.initial.regions.iter().enumerate();
        tables.map(|(n, keys)| Region::new(file, &format!("initial.regions[{n}]"), keys)).collect()
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

    /// The region as a solid, as far as it reaches into a box and a little beyond it; none where it does not.
    #[must_use]
    pub fn shape(&self, [lo, hi]: [DVec3; 2]) -> Option<Shape> {
        let ends = [0, 1].map(|end| DVec3::from_array([0, 1, 2].map(|a| self.extent(a)[end])));
        if !(ends[0].cmplt(hi).all() && ends[1].cmpgt(lo).all() && ends[0].cmplt(ends[1]).all()) {
            return None;
        }
        let beyond = [lo - (hi - lo), hi + (hi - lo)];
        let whole = Shape::Box { min: ends[0].max(beyond[0]), max: ends[1].min(beyond[1]) };
        let Region::Ball(center, radius) = *self else { return Some(whole) };
        let flat: Vec<usize> = (0..3).filter(|&a| center[a].is_nan()).collect();
        Some(match flat[..] {
            [] => Shape::Sphere { center: DVec3::from_array(center), radius },
            [along] => {
                let [from, to] =
                    beyond.map(|end| DVec3::from_array([0, 1, 2].map(|a| if a == along { end[a] } else { center[a] })));
                Shape::Round { kind: Round::Cylinder, from, to, radius, top_radius: radius }
            }
            _ => whole,
        })
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
}

/// A point of one to three numbers; the others are `missing`.
fn point(file: &CaseFile, key: &str, p: &Option<Vec<f64>>, missing: f64) -> Result<[f64; 3]> {
    match p {
        None => Ok([missing; 3]),
        Some(p) if (1..=3).contains(&p.len()) => Ok([0, 1, 2].map(|a| p.get(a).copied().unwrap_or(missing))),
        Some(p) => Err(file.wrong(key, format!("needs one to three numbers, not {}", p.len()))),
    }
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
