//! What a flow holds as a whole.

use super::field::Compensated;
use super::{Flow, Scalar};
use rayon::prelude::*;
use voidage_core::flow::Conserved;

impl<R: Scalar, const D: usize> Flow<R, D> {
    /// The largest Mach number of any cell.
    pub fn max_mach(&self) -> R {
        let rows = self.len() / self.widths[0].len().max(1);
        let larger = |a: R, b: R| if b > a { b } else { a };
        let view = self.state.view();
        let of_row = |row: usize| {
            let cells = row * self.widths[0].len()..(row + 1) * self.widths[0].len();
            cells.fold(R::ZERO, |most, cell| {
                let gas = view.gas_at(self.gas, cell);
                let w = gas.primitive(&view.get(cell).expect("a cell of the mesh"));
                let speed_sq = w.velocity.iter().fold(R::ZERO, |s, &u| s + u * u);
                larger(most, speed_sq * w.density / (gas.gamma() * w.pressure))
            })
        };
        (0..rows).into_par_iter().map(of_row).reduce(|| R::ZERO, larger).sqrt()
    }

    /// Contents of the domain, summed with the cells' open volumes; the same bits for any number of threads.
    pub fn content(&self) -> Conserved<R, D> {
        let n = self.widths[0].len().max(1);
        let rows: Vec<Compensated<R, D>> =
            (0..self.len() / n).into_par_iter().map(|row| self.row_content(row * n, n)).collect();
        let mut sum = Compensated::default();
        rows.iter().for_each(|row| sum.add(&row.sum));
        sum.sum
    }

    fn row_content(&self, start: usize, n: usize) -> Compensated<R, D> {
        let (view, space) = (self.state.view(), self.porosity());
        let mut at = self.coordinates(start);
        let mut sum = Compensated::default();
        for i in 0..n {
            at[0] = i;
            let open = space.map_or(R::ONE, |s| s.volume()[start + i]);
            let (v, u) = (self.volume(at) * open, view.get(start + i).expect("a cell of the mesh"));
            sum.add(&Conserved { density: v * u.density, momentum: u.momentum.map(|m| v * m), energy: v * u.energy });
        }
        sum
    }
}
