//! Solids that are porous themselves: gratings, filters, cable trays.
//!
//! A point's open fraction is the smallest porosity of the solids that cover it, 1 if none does. Let p₀ < p₁ < … < pₘ be the porosities
//! that occur, pₘ₊₁ = 1, and U_k the union of all solids of porosity ≤ p_k. A point that lies in U_j but not in U_{j−1} lies in all U_k
//! with k ≥ j, and p_j = p₀ + Σ_{k < j} (p_{k+1} − p_k). So the open part of a cell is p₀ + Σ_k (p_{k+1} − p_k) (1 − |U_k|): its blocked
//! part is the sum of the unions, each weighted with its step. All weights are positive, so bounds of |U_k| give bounds.
//!
//! A point of a face is as open as the less open of its two sides; it is blocked by U_k where either side is. That is how unions
//! count walls, so the same sum holds for faces.
//!
//! From U_{k−1} to U_k only the cells change that bodies of the porosity p_k reach. So each place keeps the level since which its union stands, and
//! the terms of the levels from then on are added at once when that union changes.

use super::fields::FieldSet;
use super::windows::Window;
use super::{CellCounts, Porosity};
use crate::geometry::bodies::Bodies;
use rayon::prelude::*;
use std::ops::Range;
use voidage_core::grid::Grid;

/// The porosities that occur among the bodies, in ascending order; without those of bodies that are open altogether. Never empty.
#[must_use]
pub fn levels(bodies: &Bodies) -> Vec<f64> {
    let mut levels: Vec<f64> = bodies.bodies.iter().map(|b| b.porosity).filter(|&p| p < 1.0).collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    if levels.is_empty() { vec![0.0] } else { levels }
}

/// The sum over the levels, for each place up to the level since which its union stands.
pub struct RunningSum<'a> {
    grid: Grid<'a, f64>,
    levels: &'a [f64],
    /// Values, and with them lower and upper bounds if there are any.
    sets: Vec<FieldSet>,
    /// Since which level the union of a place stands: cells, then x, y, z faces.
    since: [Vec<u32>; 4],
    /// The sum of the largest gaps, up to the level since which the one at hand is the largest.
    gap: f64,
    gap_since: usize,
}

impl<'a> RunningSum<'a> {
    /// Begins with the union up to the first level.
    #[must_use]
    pub fn new(grid: &Grid<'a, f64>, levels: &'a [f64], first: &Porosity) -> Self {
        let filled = |set: &FieldSet| {
            let mut sum = set.clone();
            (0..4).for_each(|field| sum.field_mut(field).fill(levels[0]));
            sum
        };
        RunningSum {
            grid: *grid,
            levels,
            sets: sets(first).map(filled).collect(),
            since: [0, 1, 2, 3].map(|field| vec![0; first.beta.field(field).len()]),
            gap: 0.0,
            gap_since: 0,
        }
    }

    /// The union `now` becomes, within the first of two windows, that up to level `k`, which was `found` in the second, larger one.
    pub fn replace(&mut self, now: &mut Porosity, k: usize, windows: [&Window; 2], found: &Porosity) {
        self.add_gap(now, k);
        now.max_gap = now.max_gap.max(found.max_gap);
        let (grid, part) = (self.grid, windows[1].grid(&self.grid));
        for (set, (now, found)) in self.sets.iter_mut().zip(sets_mut(now).zip(sets(found))) {
            for (field, since) in self.since.iter().enumerate() {
                let (sum, now, found) = (set.field_mut(field), now.field_mut(field), found.field(field));
                if now.is_empty() {
                    continue;
                }
                for [row, its] in rows([&grid, &part], field, windows) {
                    let standing = sum[row.clone()].iter_mut().zip(&mut now[row.clone()]).zip(&since[row]);
                    for (((sum, now), &since), &found) in standing.zip(&found[its]) {
                        *sum = raise(*sum, self.levels[k] - self.levels[since as usize], *now, self.levels[k]);
                        *now = found;
                    }
                }
            }
        }
        for (field, since) in self.since.iter_mut().enumerate().filter(|(_, since)| !since.is_empty()) {
            rows([&grid, &part], field, windows).for_each(|[row, _]| since[row].fill(k as u32));
        }
    }

    /// The sum of all levels, from the union that stands `now` and that of `all` bodies, which stands from the last level on. What either cost is not told.
    #[must_use]
    pub fn finish(mut self, now: &Porosity, all: &Porosity) -> Porosity {
        let (levels, last) = (self.levels, self.levels.len() - 1);
        self.add_gap(now, last);
        for (set, (now, all)) in self.sets.iter_mut().zip(sets(now).zip(sets(all))) {
            for (field, since) in self.since.iter().enumerate() {
                let unions = now.field(field).par_iter().zip(all.field(field));
                set.field_mut(field).par_iter_mut().zip(since).zip(unions).for_each(|((sum, &since), (&now, &all))| {
                    let before = raise(*sum, levels[last] - levels[since as usize], now, levels[last]);
                    *sum = raise(before, 1.0 - levels[last], all, 1.0);
                });
            }
        }
        let mut sets = self.sets.into_iter();
        let beta = sets.next().unwrap_or_default();
        let closed = if levels[0] == 0.0 { now.cells.closed } else { 0 };
        let cells = CellCounts {
            open: all.cells.open,
            cut: beta.v.len() - all.cells.open - closed,
            closed,
            ambiguous: now.cells.ambiguous.max(all.cells.ambiguous),
        };
        Porosity {
            solid_volume: beta.blocked_volume(&self.grid),
            beta,
            bounds: sets.next().zip(sets.next()).map(<[FieldSet; 2]>::from),
            cells,
            max_gap: self.gap + (1.0 - levels[last]) * all.max_gap,
            ..Porosity::default()
        }
    }

    fn add_gap(&mut self, now: &Porosity, k: usize) {
        self.gap += (self.levels[k] - self.levels[self.gap_since]) * now.max_gap;
        self.gap_since = k;
    }
}

/// Terms of the sum, of weights that add up to one; where nothing is in the union the result is the next level to the bit.
fn raise(so_far: f64, weight: f64, open: f64, next: f64) -> f64 {
    if open == 1.0 { next } else { (so_far + weight * open).min(next) }
}

/// The values, and the bounds if there are any.
fn sets(porosity: &Porosity) -> impl Iterator<Item = &FieldSet> {
    std::iter::once(&porosity.beta).chain(porosity.bounds.iter().flatten())
}

fn sets_mut(porosity: &mut Porosity) -> impl Iterator<Item = &mut FieldSet> {
    std::iter::once(&mut porosity.beta).chain(porosity.bounds.iter_mut().flatten())
}

/// The rows of a window: where each lies in a field of the whole grid, and where in that of a larger window, which is the grid `part`.
fn rows(
    [whole, part]: [&Grid<f64>; 2],
    field: usize,
    [window, larger]: [&Window; 2],
) -> impl Iterator<Item = [Range<usize>; 2]> {
    let mut runs = window.cells.clone();
    if field > 0 {
        runs[field - 1].end += 1;
    }
    let first = larger.cells.each_ref().map(|run| run.start);
    let [x, y, z] = runs;
    let row = move |grid: &Grid<f64>, at: [usize; 3]| {
        let start = if field == 0 { grid.cell_index(at) } else { grid.face_index(field - 1, at) };
        start..start + x.len()
    };
    z.flat_map(move |k| y.clone().map(move |j| [window.cells[0].start, j, k]))
        .map(move |at| [row(whole, at), row(part, [0, 1, 2].map(|a| at[a] - first[a]))])
}
