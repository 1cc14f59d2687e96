//! What a step did: its stable rate, its repairs, and what came in through the sides.

use crate::flow::state::Conserved;
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
    /// What entered the domain during the step through the low and high side of each axis (area times time included).
    pub inflow: [[Conserved<R, D>; 2]; D],
}

impl<R: Real, const D: usize> Report<R, D> {
    /// Nothing done.
    pub fn new() -> Self {
        let zero = Conserved { density: R::ZERO, momentum: [R::ZERO; D], energy: R::ZERO };
        Report { rate: R::ZERO, unphysical: 0, first_order: 0, floored: 0, inflow: [[zero; 2]; D] }
    }

    /// Joins the report of the next slab.
    #[must_use]
    pub fn and(mut self, other: &Self) -> Self {
        self.rate = R::larger(other.rate, self.rate);
        self.unphysical += other.unphysical;
        self.first_order += other.first_order;
        self.floored += other.floored;
        for d in 0..D {
            for s in 0..2 {
                let (a, b) = (&mut self.inflow[d][s], &other.inflow[d][s]);
                a.density += b.density;
                a.energy += b.energy;
                for c in 0..D {
                    a.momentum[c] += b.momentum[c];
                }
            }
        }
        self
    }
}

impl<R: Real, const D: usize> Default for Report<R, D> {
    fn default() -> Self {
        Self::new()
    }
}
