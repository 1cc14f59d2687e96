//! Solids that are porous themselves: gratings, filters, cable trays.
//!
//! A point's open fraction is the smallest porosity of the solids that cover it, 1 if none does. Let p₀ < p₁ < … < pₘ be the porosities
//! that occur, pₘ₊₁ = 1, and U_k the union of all solids of porosity ≤ p_k. A point that lies in U_j but not in U_{j−1} lies in all U_k
//! with k ≥ j, and p_j = p₀ + Σ_{k < j} (p_{k+1} − p_k). So the open part of a cell is p₀ + Σ_k (p_{k+1} − p_k) (1 − |U_k|): its blocked
//! part is the sum of the unions, each weighted with its step. All weights are positive, so bounds of |U_k| give bounds.
//!
//! A point of a face is as open as the less open of its two sides; it is blocked by U_k where either side is. That is how unions
//! count walls, so the same sum holds for faces.

use super::fields::FieldSet;
use super::{CellCounts, Porosity};
use crate::geometry::bodies::Bodies;

/// The porosities that occur among the bodies, in ascending order; without those of bodies that are open altogether. Never empty.
#[must_use]
pub fn levels(bodies: &Bodies) -> Vec<f64> {
    let mut levels: Vec<f64> = bodies.bodies.iter().map(|b| b.porosity).filter(|&p| p < 1.0).collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    if levels.is_empty() { vec![0.0] } else { levels }
}

/// The porosity of solids of several levels from those of the unions up to each level, in ascending order.
#[must_use]
pub fn join(levels: &[f64], mut unions: impl Iterator<Item = Porosity>) -> Porosity {
    let mut total = unions.next().unwrap_or_default();
    if levels == [0.0] {
        return total;
    }
    let next = |k: usize| levels.get(k + 1).copied().unwrap_or(1.0);
    let innermost = CellCounts { closed: if levels[0] == 0.0 { total.cells.closed } else { 0 }, ..total.cells };
    let weight = next(0) - levels[0];
    for field in fields(&mut total) {
        field.iter_mut().for_each(|open| *open = raise(levels[0], weight, *open, next(0)));
    }
    total.solid_volume *= weight;
    total.max_gap *= weight;
    total.cells = innermost;
    for (k, mut union) in (1..).zip(unions) {
        let weight = next(k) - levels[k];
        for (into, from) in fields(&mut total).into_iter().zip(fields(&mut union)) {
            into.iter_mut().zip(&*from).for_each(|(open, &other)| *open = raise(*open, weight, other, next(k)));
        }
        total.solid_volume += weight * union.solid_volume;
        total.max_gap += weight * union.max_gap;
        total.cells.open = union.cells.open;
        total.cells.ambiguous = total.cells.ambiguous.max(union.cells.ambiguous);
        total.divided += union.divided;
        total.gjk.queries += union.gjk.queries;
        total.gjk.undecided += union.gjk.undecided;
        total.winding = total.winding.max(union.winding);
        // A body leaks alike at every level; the last holds them all.
        total.leaks = union.leaks;
    }
    total.cells.cut = total.beta.v.len() - total.cells.open - total.cells.closed;
    total
}

/// One term of the sum; where nothing is in the union the result is the next level to the bit.
fn raise(so_far: f64, weight: f64, open: f64, next: f64) -> f64 {
    if open == 1.0 { next } else { (so_far + weight * open).min(next) }
}

/// All fields, the bounds included.
fn fields(porosity: &mut Porosity) -> Vec<&mut [f64]> {
    let sets = std::iter::once(&mut porosity.beta).chain(porosity.bounds.iter_mut().flatten());
    sets.flat_map(|FieldSet { v, x, y, z }| [v, x, y, z].map(|field| &mut field[..])).collect()
}
