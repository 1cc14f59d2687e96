//! What a step did: its stable rate, its repairs, and what came in through the sides.

use crate::flow::kernel::sweep::{Row, Sweep};
use crate::flow::state::{Conserved, rotate_back};
use crate::number::real::Real;

/// What a slab, or a whole step, did.
#[derive(Clone, Copy, Debug)]
pub struct Report<R, const D: usize> {
    /// Largest signal rate Σ_d open_d (|u_d| + c)/dx_d of the new state; the next stable step is cfl over it.
    pub rate: R,
    /// New states outside the physical set.
    pub unphysical: usize,
    /// Cells whose reconstruction fell back to first order.
    pub first_order: usize,
    /// Cells that had to be set to a floor.
    pub floored: usize,
    /// The last of them.
    pub floored_cell: Option<usize>,
    /// What floors changed in the content of the domain (open volumes included): the sums of the sizes of all changes.
    pub floor_change: Conserved<R, D>,
    /// What entered the domain during the step through the low and high side of each axis (area times time included).
    pub inflow: [[Conserved<R, D>; 2]; D],
}

impl<R: Real, const D: usize> Report<R, D> {
    /// Nothing done.
    pub fn new() -> Self {
        let zero = Conserved { density: R::ZERO, momentum: [R::ZERO; D], energy: R::ZERO };
        Report {
            rate: R::ZERO,
            unphysical: 0,
            first_order: 0,
            floored: 0,
            floored_cell: None,
            floor_change: zero,
            inflow: [[zero; 2]; D],
        }
    }

    /// Joins the report of the next slab.
    #[must_use]
    pub fn and(mut self, other: &Self) -> Self {
        self.rate = R::larger(other.rate, self.rate);
        self.unphysical += other.unphysical;
        self.first_order += other.first_order;
        self.floored += other.floored;
        self.floored_cell = other.floored_cell.or(self.floored_cell);
        self.floor_change.add(&other.floor_change);
        for (own, other) in self.inflow.iter_mut().flatten().zip(other.inflow.iter().flatten()) {
            own.add(other);
        }
        self
    }
}

impl<R: Real, const D: usize> Default for Report<R, D> {
    fn default() -> Self {
        Self::new()
    }
}

impl<R: Real, const D: usize> Sweep<'_, R, D> {
    /// Adds what enters through `count` boundary faces from index `i` of a flux block; `wall` is the block of face states
    /// inside, whose reference pressure the flux is counted from.
    pub(in crate::flow) fn count_inflow<const ENERGY: bool>(
        &self,
        d: usize,
        side: usize,
        row: Row<D>,
        (flux, wall): (&[R], &[R]),
        m: usize,
        i: usize,
        count: usize,
        report: &mut Report<R, D>,
    ) {
        let sign = if side == 0 { self.dt } else { -self.dt };
        let mut total = Conserved { density: R::ZERO, momentum: [R::ZERO; D], energy: R::ZERO };
        for f in 0..count {
            let mut at = row.at;
            if d != 0 {
                at[0] = f;
            } else if side == 1 {
                at[0] = self.size.n - 1;
            }
            let area = self.problem.mesh.volume(at) / self.problem.mesh.widths[d][at[d]];
            let weight = sign * area;
            let normal = if side == 0 { D + 2 } else { 1 };
            let open = match &self.medium {
                None => R::ONE,
                Some(medium) => {
                    let (low, high) = medium.ducts(d, at, self.periodic[d]).openings(0);
                    if side == 0 { low } else { high }
                }
            };
            // A closed face is a wall, not a side to come in by.
            if open == R::ZERO {
                continue;
            }
            total.density += weight * flux[i + f];
            let mut momentum = [R::ZERO; D];
            momentum[0] = weight * (flux[normal * m + i + f] + open * wall[(D + 2) * m + i + f]);
            for c in 1..D {
                momentum[c] = weight * flux[(1 + c) * m + i + f];
            }
            let momentum = rotate_back(momentum, d);
            for c in 0..D {
                total.momentum[c] += momentum[c];
            }
            if ENERGY {
                total.energy += weight * flux[(D + 1) * m + i + f];
            }
        }
        report.inflow[d][side].add(&total);
    }
}
