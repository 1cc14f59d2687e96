//! The new states of a row: fluxes summed, drag applied, the next stable rate found.

use crate::flow::kernel::rows;
use crate::flow::kernel::scratch::Work;
use crate::flow::kernel::sweep::{Row, Sweep};
use crate::flow::porosity::clusters::least_volume;
use crate::flow::porosity::flags::{SMALL, break_high, break_low, is, marked};
use crate::flow::state::FieldsMut;
use crate::flow::step_report::Report;
use crate::number::real::Real;

impl<R: Real, const D: usize> Sweep<'_, R, D> {
    /// New states of row `j` of the layer below `l`.
    pub(in crate::flow) fn finish_below<const ENERGY: bool>(
        &self,
        l: isize,
        j: isize,
        work: &mut Work<'_, R, D>,
        new: &mut FieldsMut<'_, R, D>,
        report: &mut Report<R, D>,
    ) {
        let mut at = [0; D];
        if D == 3 {
            at[1] = j as usize;
        }
        at[D - 1] = l as usize - 1;
        let row = Row { start: self.problem.mesh.index(at), at };
        let to = row.start - self.slab.start * self.problem.mesh.layer();
        self.finish::<ENERGY>(row, self.place(j), work, new, to, report);
    }

    /// New states of the row at a place of the tile, drag included; their signal rate and whether they are physical.
    pub(in crate::flow) fn finish<const ENERGY: bool>(
        &self,
        row: Row<D>,
        place: usize,
        work: &mut Work<'_, R, D>,
        new: &mut FieldsMut<'_, R, D>,
        to: usize,
        report: &mut Report<R, D>,
    ) {
        let n = self.size.n;
        let mesh = &self.problem.mesh;
        let metric = &mut work.metric;
        let change = core::array::from_fn(|d| &work.change[d][self.changes(d, place)]);
        let scale = if let Some(medium) = &self.medium {
            let volume = &medium.porosity.volume[row.start..][..n];
            let (inv, scale) = (&mut metric.spare[..n], &mut metric.scale[..n]);
            for i in 0..n {
                inv[i] = R::ONE / R::larger(volume[i], least_volume());
                scale[i] = self.dt * inv[i];
            }
            let marks = &medium.porosity.marks[row.start..][..n];
            for d in 0..D {
                let ducts = medium.ducts(d, row.at, self.periodic[d]);
                let (low, high) = ducts.rows(n);
                let open = &mut metric.open[d][..n];
                for i in 0..n {
                    open[i] = R::larger(low[i], high[i]) * inv[i];
                }
                for i in marked(marks, break_low(d) | break_high(d) | SMALL) {
                    open[i] = self.problem.openness(&ducts, i);
                }
            }
            Some(&metric.scale[..n])
        } else {
            None
        };
        rows::update::<R, D, ENERGY>(self.old, row.start, &change, scale, self.dt, new, to, n);
        if let Some(drag) = &self.problem.drag {
            for i in 0..n {
                let coefficients = drag.at(row.start + i);
                if !coefficients.is_free() {
                    let (before, mut after) = (self.old.get(row.start + i), new.get(to + i));
                    let u = before.momentum.map(|m| m / before.density);
                    let pushed = after.momentum.map(|m| m / after.density);
                    let v = coefficients.step(u, pushed, self.dt);
                    after.momentum = v.map(|v| after.density * v);
                    new.set(to + i, &after);
                }
            }
        }
        let inv_width = &*metric.inv_width;
        let across: [R; D] = core::array::from_fn(|d| R::ONE / mesh.widths[d][row.at[d]]);
        let inverse = |d: usize, i: usize| if d == 0 { inv_width[i] } else { across[d] };
        let open = metric.open.each_ref().map(|o| &**o);
        let signal = &mut metric.signal[..n];
        let view = new.as_fields();
        let bad = if self.medium.is_some() {
            rows::signal_rates::<R, D, true>(self.problem.gas, &view, to, inverse, &open, signal)
        } else {
            rows::signal_rates::<R, D, false>(self.problem.gas, &view, to, inverse, &open, signal)
        };
        // Cells of clusters are judged after merging.
        let small = match &self.medium {
            Some(medium) if !self.problem.clusters.0.is_empty() => {
                Some(&medium.porosity.marks[row.start..][..n]).filter(|m| m.iter().any(|&b| is(b, SMALL)))
            }
            _ => None,
        };
        if let Some(marks) = small {
            for i in 0..n {
                if is(marks[i], SMALL) {
                    signal[i] = R::ZERO;
                }
            }
        }
        let counted = self.counted.clone();
        report.rate = R::larger(rows::largest(&signal[counted.clone()]), report.rate);
        if bad {
            for i in counted {
                let merged = small.is_some_and(|m| is(m[i], SMALL));
                report.unphysical += usize::from(!merged && !self.problem.is_physical(&view.get(to + i)));
            }
        }
    }
}
