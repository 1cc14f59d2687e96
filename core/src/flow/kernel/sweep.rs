//! The sweep of a slab of layers.
//!
//! Rows come in storage order. A window of three layers of primitive variables moves along the last axis; the fluxes across
//! the other axes are differenced when the row above arrives. Layers of a 3D mesh are cut into tiles of rows, each swept by
//! itself, so that what a sweep keeps stays in a cache. A cell's new state depends on the old field alone, by the same
//! operations wherever the slab is cut, so slabs advanced by any number of threads give the same bits.

use crate::flow::kernel::contractions::load_contractions;
use crate::flow::kernel::fluxes::{
    fluxes_across_layers, fluxes_across_rows, fluxes_x, keep_for_layer_above, keep_for_row_above,
};
use crate::flow::kernel::mixed;
use crate::flow::kernel::reconstruct::reconstruct;
use crate::flow::kernel::rows;
use crate::flow::kernel::scratch::{Sizes, Work};
use crate::flow::kernel::slab::{Part, RowAt, Slab};
use crate::flow::kernel::solver_calls::SolverCalls;
use crate::flow::kernel::update::{update, update_below};
use crate::flow::problem::Problem;
use crate::flow::riemann::Solver;
use crate::flow::state::FieldsMut;
use crate::flow::step_report::Report;
use crate::number::real::Real;
use core::ops::Range;

type SweepFn<R, const D: usize> = fn(&Slab<'_, R, D>, &mut FieldsMut<'_, R, D>, &mut [R], &mut Report<R, D>);

/// How a tile of a slab is advanced: [`sweep`], compiled for one kind of gas, with the calls of one solver.
#[derive(Clone, Copy)]
pub struct Sweep<R, const D: usize> {
    run: SweepFn<R, D>,
    solver: SolverCalls<R, D>,
}

impl<R: Real, const D: usize> Sweep<R, D> {
    /// Of a solver, for a gas with or without energy, of one or of several ratios of specific heats.
    pub(in crate::flow) fn by<S: Solver, const ENERGY: bool, const MIXED: bool>() -> Self {
        Sweep { run: sweep::<R, D, ENERGY, MIXED>, solver: SolverCalls::of::<S, ENERGY, MIXED>() }
    }
}

/// Advances a part of a problem into `new`, tile by tile, each by `by`. Slices and scratch must fit. Adds to `report` what that did.
pub(in crate::flow) fn advance<R: Real, const D: usize>(
    problem: &Problem<'_, R, D>,
    part: &Part<'_, R, D>,
    new: &mut FieldsMut<'_, R, D>,
    scratch: &mut [R],
    by: Sweep<R, D>,
    report: &mut Report<R, D>,
) {
    let mut slab = Slab::new(problem, part, by.solver);
    for rows in Sizes::tiles(&problem.mesh) {
        slab.rows = rows;
        (by.run)(&slab, new, scratch, report);
    }
}

/// Advances a tile of a slab into `new`, and adds to `report` what that did.
fn sweep<R: Real, const D: usize, const ENERGY: bool, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    new: &mut FieldsMut<'_, R, D>,
    scratch: &mut [R],
    report: &mut Report<R, D>,
) {
    let mut work = Work::new(slab.size, scratch);
    for (i, &width) in slab.problem.mesh.widths[0].iter().enumerate() {
        work.coefficients.inv_width[i] = R::ONE / width;
        // In a porous medium each row has its own.
        work.coefficients.rate[0][i] = R::HALF * slab.dt / width;
    }
    if D == 1 {
        let row = RowAt { start: 0, at: [0; D] };
        load_row::<R, D, MIXED>(slab, 0, 0, &mut work);
        reconstruct::<R, D, MIXED>(slab, row, (0, 0), &mut work, &mut report.first_order);
        fluxes_x::<R, D, ENERGY, MIXED>(slab, row, 0, &mut work, report);
        update::<R, D, ENERGY, MIXED>(slab, row, 0, &mut work, new, report);
        return;
    }
    let n_last = slab.cells(D - 1);
    let (low, high) = (slab.layers.start as isize, slab.layers.end as isize);
    let held = slab.held_rows();
    for l in low - 1..=high {
        if (l < 0 || l >= n_last) && !slab.periodic[D - 1] {
            // The ghost of a boundary: no cells, only the face beside the domain.
            if l == high {
                for j in slab.rows() {
                    fluxes_across_layers::<R, D, ENERGY, MIXED>(slab, (l, j), false, &mut work, report);
                    update_below::<R, D, ENERGY, MIXED>(slab, (l, j), &mut work, new, report);
                }
            }
            continue;
        }
        if l == low - 1 || (l == low && !slab.periodic[D - 1] && low == 0) {
            load_rows::<R, D, MIXED>(slab, l - 1, held.clone(), &mut work);
            load_rows::<R, D, MIXED>(slab, l, held.clone(), &mut work);
        }
        sweep_layer::<R, D, ENERGY, MIXED>(slab, l, &mut work, new, report);
    }
}

/// The rows of a layer of the domain, and in 3D one more on each side for the faces between them. Loads the layer above.
fn sweep_layer<R: Real, const D: usize, const ENERGY: bool, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    l: isize,
    work: &mut Work<'_, R, D>,
    new: &mut FieldsMut<'_, R, D>,
    report: &mut Report<R, D>,
) {
    let (rows, held) = (slab.rows(), slab.held_rows());
    let advanced = slab.layers.contains(&(l as usize));
    let beside = isize::from(D == 3 && advanced);
    let layer = l.rem_euclid(slab.cells(D - 1)) as usize;
    let mut to_load = held.start;
    for j in rows.start - beside..rows.end + beside {
        if (j < 0 || j >= slab.all_rows()) && !slab.periodic[1 % D] {
            if j == rows.end {
                fluxes_across_rows::<R, D, ENERGY, MIXED>(slab, (layer, j), false, work, report);
            }
            continue;
        }
        // Row by row, so that memory delivers while the processor computes.
        load_rows::<R, D, MIXED>(slab, l + 1, to_load..j + 1, work);
        to_load = j + 1;
        let mut at = [0; D];
        at[D - 1] = layer;
        if D == 3 {
            at[1] = j.rem_euclid(slab.all_rows()) as usize;
        }
        let row = RowAt { start: slab.problem.mesh.index(at), at };
        sweep_row::<R, D, ENERGY, MIXED>(slab, row, (l, j), work, new, report);
    }
    load_rows::<R, D, MIXED>(slab, l + 1, to_load..held.end, work);
}

/// Row `j` of layer `l`: its cells, the faces under it, and what the faces above it need of it.
fn sweep_row<R: Real, const D: usize, const ENERGY: bool, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    row: RowAt<D>,
    (l, j): (isize, isize),
    work: &mut Work<'_, R, D>,
    new: &mut FieldsMut<'_, R, D>,
    report: &mut Report<R, D>,
) {
    let own_row = slab.rows().contains(&j);
    let own_layer = slab.layers.contains(&(l as usize));
    let mut beside = 0;
    let first_order = if own_row && own_layer { &mut report.first_order } else { &mut beside };
    reconstruct::<R, D, MIXED>(slab, row, (l, j), work, first_order);
    if own_row {
        if l >= slab.layers.start as isize {
            fluxes_across_layers::<R, D, ENERGY, MIXED>(slab, (l, j), true, work, report);
            if l > slab.layers.start as isize {
                update_below::<R, D, ENERGY, MIXED>(slab, (l, j), work, new, report);
            }
        }
        if l < slab.layers.end as isize {
            keep_for_layer_above::<R, D, MIXED>(slab, slab.place(j), work);
        }
    }
    if D == 3 && own_layer {
        if j >= slab.rows.start as isize {
            fluxes_across_rows::<R, D, ENERGY, MIXED>(slab, (row.at[D - 1], j), true, work, report);
        }
        keep_for_row_above::<R, D, MIXED>(slab, work);
    }
    if own_row && own_layer {
        fluxes_x::<R, D, ENERGY, MIXED>(slab, row, slab.place(j), work, report);
    }
}

/// Primitive variables of rows of a layer with their ghosts.
fn load_rows<R: Real, const D: usize, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    l: isize,
    rows: Range<isize>,
    work: &mut Work<'_, R, D>,
) {
    for j in rows {
        load_row::<R, D, MIXED>(slab, l, j, work);
    }
}

/// Primitive variables of a row with its ghosts. A layer or row beyond a boundary is made from that inside it.
fn load_row<R: Real, const D: usize, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    l: isize,
    j: isize,
    work: &mut Work<'_, R, D>,
) {
    let s = slab.size;
    let inside = |k: isize, cells: isize, d: usize| {
        if slab.periodic[d] { k.rem_euclid(cells) } else { k.clamp(0, cells - 1) }
    };
    let mut at = [0; D];
    if D > 1 {
        at[D - 1] = inside(l, slab.problem.mesh.cells()[D - 1] as isize, D - 1) as usize;
    }
    if D == 3 {
        at[1] = inside(j, slab.all_rows(), 1) as usize;
    }
    let block = &mut work.window[slab.block(l, j)];
    let from = slab.problem.mesh.index(at);
    if MIXED {
        mixed::primitives(slab.old, from, block, s.padded);
    } else {
        rows::primitives(slab.problem.gas, slab.old, from, block, s.padded);
    }
    if slab.periodic[0] {
        copy_ends::<R, D, MIXED>(block, s.padded);
    } else {
        for (side, i) in [(0, 0), (1, s.padded - 1)] {
            let beside = slab.problem.side(0, side == 1, at);
            let inside = if side == 0 { 1 } else { s.n };
            let gas = slab.gas_of::<MIXED>(block, (D + 2) * s.padded + inside);
            let ghost = beside.ghost_cell(&rows::face_state(block, s.padded, inside), 0, side == 0, gas);
            if MIXED {
                let own = block[(D + 2) * s.padded + inside];
                block[(D + 2) * s.padded + i] = slab.problem.capacity_beyond((0, side == 1), at, own);
            }
            rows::put_state(block, s.padded, i, &ghost);
        }
    }
    let mut outside = false;
    for (d, k) in [(D - 1, l), (1, j)] {
        let across = d > 0 && (d == D - 1 || D == 3);
        if across && !slab.periodic[d] && (k < 0 || k >= slab.problem.mesh.cells()[d] as isize) {
            mirror::<R, D, MIXED>(slab, block, d, k < 0, at);
            outside = true;
        }
    }
    if D > 1 {
        let range = rows::range(rows::var(block, D + 1, s.padded));
        work.ranges[2 * slab.slot(l, j)..][..2].copy_from_slice(&range);
        load_contractions(slab, at, outside, &mut work.contractions[slab.slot(l, j) * s.padded..][..s.padded]);
    }
}

/// The cells beyond both ends of a periodic row: those of the other end.
fn copy_ends<R: Real, const D: usize, const MIXED: bool>(block: &mut [R], padded: usize) {
    for v in 0..D + 2 + usize::from(MIXED) {
        let values = &mut block[v * padded..][..padded];
        (values[0], values[padded - 1]) = (values[padded - 2], values[1]);
    }
}

/// Turns a row of inner states, of the cells from `at` on, into the ghosts beyond a boundary of axis `d`.
fn mirror<R: Real, const D: usize, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    block: &mut [R],
    d: usize,
    low: bool,
    at: [usize; D],
) {
    let padded = slab.size.padded;
    for i in 0..padded {
        let mut beside = at;
        beside[0] = i.saturating_sub(1).min(padded - 3);
        let boundary = slab.problem.side(d, !low, beside);
        let w = rows::face_state::<R, D>(block, padded, i);
        let capacity = (D + 2) * padded + i;
        let gas = slab.gas_of::<MIXED>(block, capacity);
        rows::put_state(block, padded, i, &boundary.ghost_cell(&w, d, low, gas));
        if MIXED {
            block[capacity] = slab.problem.capacity_beyond((d, !low), beside, block[capacity]);
        }
    }
}
