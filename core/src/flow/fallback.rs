//! What happens where a new state leaves the physical set: first order around it, at last a floor.

use crate::flow::problem::Problem;
use crate::flow::state::{Conserved, Fields, FieldsMut, Gas, sum};
use crate::flow::step_report::Report;
use crate::number::real::Real;

/// Rounds of the first-order fallback: the marked region grows by one cell each.
pub const FALLBACKS: usize = 4;

impl<R: Real, const D: usize> Problem<'_, R, D> {
    /// Marks every unphysical cell of a new field and its neighbours for a first-order step; returns how many marks are new.
    pub fn mark_troubled(&self, new: &Fields<'_, R, D>, first_order: &mut [u8]) -> usize {
        let cells = self.mesh.cells();
        let periodic = self.periodic();
        let mut added = 0;
        for cell in 0..self.mesh.len() {
            if self.is_physical(&new.get(cell)) {
                continue;
            }
            let at = self.mesh.coordinates(cell);
            let mut set = |i: usize| {
                if let Some(mark) = first_order.get_mut(i) {
                    added += usize::from(*mark == 0);
                    *mark = 1;
                }
            };
            set(cell);
            for d in 0..D {
                let mut next = at;
                if at[d] > 0 || periodic[d] {
                    next[d] = (at[d] + cells[d] - 1) % cells[d];
                    set(self.mesh.index(next));
                }
                if at[d] + 1 < cells[d] || periodic[d] {
                    next[d] = (at[d] + 1) % cells[d];
                    set(self.mesh.index(next));
                }
            }
        }
        added
    }

    /// The last resort: gives every unphysical cell a positive state scaled to its old one. Returns how many.
    pub fn apply_floors(&self, old: &Fields<'_, R, D>, new: &mut FieldsMut<'_, R, D>, report: &mut Report<R, D>) {
        // Share of the old density or pressure that a floor keeps. Smaller: hotter or emptier cells, shorter steps.
        let share = R::from_f64(1e-3);
        for cell in 0..self.mesh.len() {
            let u = new.get(cell);
            if self.is_physical(&u) {
                continue;
            }
            let before = self.gas.primitive(&old.get(cell));
            // The kinetic energy must fit the scalar with room for what a step multiplies it by.
            let kinetic = u.density * sum::<R, D>(u.momentum.map(|m| (m / u.density) * (m / u.density)));
            let sound = u.density > R::ZERO && u.density.is_finite() && kinetic < R::MAX * R::EPSILON;
            let mut w = if sound { self.gas.primitive(&u) } else { before };
            if !sound {
                w.density = R::larger(before.density * share, R::MIN_POSITIVE);
            }
            w.pressure = match self.gas {
                // Above the rounding of the kinetic energy it is stored with.
                Gas::Ideal { gamma } => {
                    let kinetic = w.density * sum::<R, D>(w.velocity.map(|u| u * u));
                    let least = R::from_f64(64.0) * R::EPSILON * (gamma - R::ONE) * kinetic;
                    R::larger(R::larger(before.pressure * share, least), R::MIN_POSITIVE)
                }
                gas => gas.pressure(w.density, R::ZERO),
            };
            let floored = self.gas.conserved(&w);
            new.set(cell, &floored);
            report.floored += 1;
            report.rate = R::larger(self.cell_rate(&floored, cell), report.rate);
        }
        report.unphysical = 0;
    }
}
