//! The new states of a row: fluxes summed, drag applied, the next stable rate found.

use crate::flow::kernel::mixed;
use crate::flow::kernel::rows::{self, Span};
use crate::flow::kernel::scratch::{RowCoefficients, Work};
use crate::flow::kernel::slab::{RowAt, Slab};
use crate::flow::porosity::flags::{SMALL, break_high, break_low, is, marked};
use crate::flow::porosity::fractions::least_volume;
use crate::flow::state::{Fields, FieldsMut};
use crate::flow::step_report::Report;
use crate::number::real::Real;

/// New states of row `j` of the layer below `l`.
pub(in crate::flow) fn update_below<R: Real, const D: usize, const ENERGY: bool, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    (l, j): (isize, isize),
    work: &mut Work<'_, R, D>,
    new: &mut FieldsMut<'_, R, D>,
    report: &mut Report<R, D>,
) {
    let mut at = [0; D];
    if D == 3 {
        at[1] = j as usize;
    }
    at[D - 1] = l as usize - 1;
    let row = RowAt { start: slab.problem.mesh.index(at), at };
    update::<R, D, ENERGY, MIXED>(slab, row, slab.place(j), work, new, report);
}

/// New states of the row at a place of the tile, drag included; their signal rate and whether they are physical.
pub(in crate::flow) fn update<R: Real, const D: usize, const ENERGY: bool, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    row: RowAt<D>,
    place: usize,
    work: &mut Work<'_, R, D>,
    new: &mut FieldsMut<'_, R, D>,
    report: &mut Report<R, D>,
) {
    // A line is its own only layer.
    let below = if D == 1 { 0 } else { slab.layers.start * slab.problem.mesh.layer() };
    let span = Span { from: row.start, to: row.start - below, n: slab.size.n };
    let change = core::array::from_fn(|d| &work.change[d][slab.changes(d, place)]);
    let coefficients = &mut work.coefficients;
    let scale = open_areas(slab, row, coefficients).then_some(&coefficients.scale[..span.n]);
    rows::update::<R, D, ENERGY, MIXED>(slab.old, new, span, &change, scale, slab.dt);
    if MIXED {
        for own in &mut new.capacity[span.to..][..span.n] {
            *own = slab.problem.gas.within_bounds(*own);
        }
    }
    drag(slab, span, new);
    report_row::<R, D, MIXED>(slab, row, span, coefficients, &new.as_fields(), report);
}

/// dt/beta_v of the cells of a row, and open area over open volume along each axis; false where there is no porosity.
fn open_areas<R: Real, const D: usize>(
    slab: &Slab<'_, R, D>,
    row: RowAt<D>,
    coefficients: &mut RowCoefficients<'_, R, D>,
) -> bool {
    let n = slab.size.n;
    let Some(medium) = &slab.medium else { return false };
    let volume = &medium.porosity.volume[row.start..][..n];
    let (inv, scale) = (&mut coefficients.spare[..n], &mut coefficients.scale[..n]);
    for i in 0..n {
        inv[i] = R::ONE / R::larger(volume[i], least_volume());
        scale[i] = slab.dt * inv[i];
    }
    let marks = &medium.porosity.marks[row.start..][..n];
    let clustered = !slab.problem.clusters.0.is_empty();
    for d in 0..D {
        let ducts = medium.ducts(d, row.at);
        let (low, high) = ducts.rows(n);
        let open = &mut coefficients.open[d][..n];
        for i in 0..n {
            open[i] = R::larger(low[i], high[i]) * inv[i];
        }
        let breaks = break_low(d) | break_high(d);
        let wanted = |&i: &usize| marks[i] & breaks != 0 || is(marks[i], SMALL);
        for i in marked(marks, if clustered { breaks | SMALL } else { breaks }).filter(wanted) {
            open[i] = slab.problem.openness(&ducts, i);
        }
    }
    true
}

/// Drag over the step on new states.
fn drag<R: Real, const D: usize>(slab: &Slab<'_, R, D>, span: Span, new: &mut FieldsMut<'_, R, D>) {
    let Some(drag) = &slab.problem.drag else { return };
    for i in 0..span.n {
        let coefficients = drag.at(span.from + i);
        if !coefficients.is_free() {
            let (before, mut after) = (slab.old.at(span.from + i), new.at(span.to + i));
            let u = before.momentum.map(|m| m / before.density);
            let pushed = after.momentum.map(|m| m / after.density);
            let v = coefficients.step(u, pushed, slab.dt);
            let pushed = after.momentum;
            after.momentum = v.map(|v| after.density * v);
            if let Some(walls) = slab.walls.filter(|_| slab.reported.contains(&i)) {
                let lost = core::array::from_fn(|c| pushed[c] - after.momentum[c]);
                (walls.in_cell)(slab, span.from + i, lost);
            }
            new.set(span.to + i, &after);
        }
    }
}

/// Adds a row of new states to the report: the largest signal rate, and how many are unphysical.
fn report_row<R: Real, const D: usize, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    row: RowAt<D>,
    span: Span,
    coefficients: &mut RowCoefficients<'_, R, D>,
    new: &Fields<'_, R, D>,
    report: &mut Report<R, D>,
) {
    let n = span.n;
    let inv_width = &*coefficients.inv_width;
    let across: [R; D] = core::array::from_fn(|d| R::ONE / slab.problem.mesh.widths[d][row.at[d]]);
    let inverse = |d: usize, i: usize| if d == 0 { inv_width[i] } else { across[d] };
    let open = coefficients.open.each_ref().map(|o| &**o);
    let signal = &mut coefficients.signal[..n];
    let bad = if MIXED && slab.medium.is_some() {
        mixed::signal_rates::<R, D, true>(new, span.to, inverse, &open, slab.capacities, signal)
    } else if MIXED {
        mixed::signal_rates::<R, D, false>(new, span.to, inverse, &open, slab.capacities, signal)
    } else if slab.medium.is_some() {
        rows::signal_rates::<R, D, true>(slab.problem.gas, new, span.to, inverse, &open, signal)
    } else {
        rows::signal_rates::<R, D, false>(slab.problem.gas, new, span.to, inverse, &open, signal)
    };
    // Cells of clusters are judged after merging.
    let small = match &slab.medium {
        Some(medium) if !slab.problem.clusters.0.is_empty() => {
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
    let reported = slab.reported.clone();
    report.rate = R::larger(rows::largest(&signal[reported.clone()]), report.rate);
    if bad {
        for i in reported {
            let merged = small.is_some_and(|m| is(m[i], SMALL));
            report.unphysical += usize::from(!merged && !slab.problem.holds(new, span.to + i));
        }
    }
}
