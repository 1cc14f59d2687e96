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
