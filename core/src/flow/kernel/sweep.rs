//! The sweep of a slab of layers.
//!
//! Rows come in storage order. A window of three layers of primitive variables moves along the last axis; the fluxes across
//! the other axes are differenced when the row above arrives. Layers of a 3D mesh are cut into tiles of rows, each swept by
//! itself, so that what a sweep keeps stays in a cache. A cell's new state depends on the old field alone, by the same
//! operations wherever the slab is cut, so slabs advanced by any number of threads give the same bits.

use crate::flow::kernel::rows;
use crate::flow::kernel::scratch::{ROWS_BESIDE, Sizes, Work};
use crate::flow::porosity::fractions::Medium;
use crate::flow::porosity::throat::ThroatGas;
use crate::flow::riemann::{FaceGas, Solver};
use crate::flow::state::{Fields, FieldsMut};
use crate::flow::step::Problem;
use crate::flow::step_report::Report;
use crate::number::real::Real;
use core::ops::Range;

/// A row of cells: its index along axis 1 (3D) and along the last axis, inside the domain.
#[derive(Clone, Copy)]
pub(in crate::flow) struct Row<const D: usize> {
    /// Flat index of its first cell.
    pub start: usize,
    /// Indices of its first cell.
    pub at: [usize; D],
}

/// One slab of one step, and what it reads.
pub(in crate::flow) struct Sweep<'p, R, const D: usize> {
    pub problem: &'p Problem<'p, R, D>,
    pub medium: Option<Medium<'p, R, D>>,
    pub size: Sizes,
    pub periodic: [bool; D],
    pub weighted: bool,
    /// All cells along an axis have one width.
    pub even: [bool; D],
    pub first_order: Option<&'p [u8]>,
    pub face_gas: FaceGas<R>,
    pub throat: ThroatGas<R>,
    pub old: &'p Fields<'p, R, D>,
    pub dt: R,
    pub slab: Range<usize>,
    /// Rows of a layer that are advanced: a tile of a 3D mesh, else the one row.
    pub rows: Range<usize>,
    /// Cells of a row that enter the report: all but the outer ones of a piece of a line.
    pub counted: Range<usize>,
}

impl<R: Real, const D: usize> Sweep<'_, R, D> {
    /// Variables of a state block, and of a face state or flux block.
    pub(in crate::flow) const V: usize = D + 2;
    pub(in crate::flow) const F: usize = D + 3;

    /// Advances the slab into `new`.
    pub(in crate::flow) fn run<S: Solver, const ENERGY: bool>(
        &self,
        new: &mut FieldsMut<'_, R, D>,
        scratch: &mut [R],
    ) -> Report<R, D> {
        let s = self.size;
        let mut work = Work::new(s, scratch);
        for i in 0..s.n {
            let width = self.problem.mesh.widths[0][i];
            work.metric.inv_width[i] = R::ONE / width;
            // In a porous medium each row has its own.
            work.metric.rate[0][i] = R::HALF * self.dt / width;
        }
        let mut report = Report::new();
        if D == 1 {
            self.load_row(0, 0, &mut work);
            let row = Row { start: 0, at: [0; D] };
            self.reconstruct(row, 0, 0, &mut work, &mut report.first_order);
            self.cross_row::<S, ENERGY>(row, 0, &mut work, &mut report);
            self.finish::<ENERGY>(row, 0, &mut work, new, 0, &mut report);
            return report;
        }
        let n_last = self.problem.mesh.cells()[D - 1] as isize;
        let (lo, hi) = (self.slab.start as isize, self.slab.end as isize);
        let (first, last) = (self.rows.start as isize, self.rows.end as isize);
        let held = self.held_rows();
        for l in lo - 1..=hi {
            let outside = l < 0 || l >= n_last;
            let inside = l >= lo && l < hi;
            if outside && !self.periodic[D - 1] {
                // The ghost of a boundary: no cells, only the face beside the domain.
                if l == hi {
                    for j in first..last {
                        self.cross_last::<S, ENERGY>(l, j, false, &mut work, &mut report);
                        self.finish_below::<ENERGY>(l, j, &mut work, new, &mut report);
                    }
                }
                continue;
            }
            if l == lo - 1 || (l == lo && !self.periodic[D - 1] && lo == 0) {
                self.load_rows(l - 1, held.clone(), &mut work);
                self.load_rows(l, held.clone(), &mut work);
            }
            let mut to_load = held.start;
            let wrapped = l.rem_euclid(n_last) as usize;
            let ghost_rows = isize::from(D == 3 && inside);
            for j in first - ghost_rows..last + ghost_rows {
                let ghost = j < first || j >= last;
                let beyond = j < 0 || j >= self.all_rows();
                if beyond && !self.periodic[1 % D] {
                    if j == last {
                        self.cross_middle::<S, ENERGY>(wrapped, j, false, &mut work, &mut report);
                    }
                    continue;
                }
                // Row by row, so that memory delivers while the processor computes.
                self.load_rows(l + 1, to_load..j + 1, &mut work);
                to_load = j + 1;
                let mut at = [0; D];
                at[D - 1] = wrapped;
                if D == 3 {
                    at[1] = j.rem_euclid(self.all_rows()) as usize;
                }
                let row = Row { start: self.problem.mesh.index(at), at };
                let counted = inside && !ghost;
                let mut ignored = 0;
                self.reconstruct(row, l, j, &mut work, if counted { &mut report.first_order } else { &mut ignored });
                if !ghost {
                    if l == lo - 1 {
                        self.keep_last(j, &mut work);
                    } else {
                        self.cross_last::<S, ENERGY>(l, j, true, &mut work, &mut report);
                        if l > lo {
                            self.finish_below::<ENERGY>(l, j, &mut work, new, &mut report);
                        }
                        if inside {
                            self.keep_last(j, &mut work);
                        }
                    }
                }
                if D == 3 && inside {
                    if j >= first {
                        self.cross_middle::<S, ENERGY>(wrapped, j, true, &mut work, &mut report);
                    }
                    self.keep_middle(&mut work);
                }
                if inside && !ghost {
                    self.cross_row::<S, ENERGY>(row, j, &mut work, &mut report);
                }
            }
            self.load_rows(l + 1, to_load..held.end, &mut work);
        }
        report
    }

    /// Rows of a layer of the whole mesh.
    fn all_rows(&self) -> isize {
        if D == 3 { self.problem.mesh.cells()[1] as isize } else { 1 }
    }

    /// Rows of a layer that the window holds: those of the tile and, in 3D, two more on each side; one beyond a side of the domain.
    fn held_rows(&self) -> Range<isize> {
        let (first, last) = (self.rows.start as isize, self.rows.end as isize);
        if D < 3 {
            return first..last;
        }
        let beside = |at_side: bool| if at_side && !self.periodic[1] { 1 } else { ROWS_BESIDE as isize };
        first - beside(first == 0)..last + beside(last == self.all_rows())
    }

    /// Where row `j` of layer `l` stands in the window.
    pub(in crate::flow) fn block(&self, l: isize, j: isize) -> Range<usize> {
        let s = self.size;
        let slot = if D == 1 { 0 } else { l.rem_euclid(3) as usize };
        let row = if D == 3 { (j - self.rows.start as isize + ROWS_BESIDE as isize) as usize } else { 0 };
        let len = Self::V * s.padded;
        let start = (slot * s.rows_padded + row) * len;
        start..start + len
    }

    /// Place of row `j` among those of the tile.
    pub(in crate::flow) fn place(&self, j: isize) -> usize {
        j as usize - self.rows.start
    }

    /// Where the changes of the row at a place of the tile stand along axis `d`.
    pub(in crate::flow) fn changes(&self, d: usize, place: usize) -> Range<usize> {
        let len = Self::V * self.size.n;
        let row = if d == D - 1 { 0 } else { place };
        row * len..(row + 1) * len
    }

    /// Primitive variables of rows of a layer with their ghosts.
    fn load_rows(&self, l: isize, rows: Range<isize>, work: &mut Work<'_, R, D>) {
        for j in rows {
            self.load_row(l, j, work);
        }
    }

    /// Primitive variables of a row with its ghosts. A layer or row beyond a boundary is made from that inside it.
    fn load_row(&self, l: isize, j: isize, work: &mut Work<'_, R, D>) {
        let s = self.size;
        let inside = |k: isize, cells: isize, d: usize| {
            if self.periodic[d] { k.rem_euclid(cells) } else { k.clamp(0, cells - 1) }
        };
        let mut at = [0; D];
        if D > 1 {
            at[D - 1] = inside(l, self.problem.mesh.cells()[D - 1] as isize, D - 1) as usize;
        }
        if D == 3 {
            at[1] = inside(j, self.all_rows(), 1) as usize;
        }
        let block = &mut work.window[self.block(l, j)];
        rows::primitives(self.problem.gas, self.old, self.problem.mesh.index(at), block, s.padded);
        let state = |block: &[R], i: usize| rows::face_state::<R, D>(block, s.padded, i);
        let gas = self.problem.gas;
        let [low, high] = &self.problem.boundaries[0];
        let (a, b) = if self.periodic[0] {
            (state(block, s.n), state(block, 1))
        } else {
            (low.ghost_cell(&state(block, 1), 0, true, gas), high.ghost_cell(&state(block, s.n), 0, false, gas))
        };
        rows::put_state(block, s.padded, 0, &a);
        rows::put_state(block, s.padded, s.padded - 1, &b);
        for (d, k) in [(D - 1, l), (1, j)] {
            let across = d > 0 && (d == D - 1 || D == 3);
            if across && !self.periodic[d] && (k < 0 || k >= self.problem.mesh.cells()[d] as isize) {
                self.mirror(block, d, k < 0);
            }
        }
    }

    /// Turns a row of inner states into the ghosts beyond a boundary of axis `d`.
    fn mirror(&self, block: &mut [R], d: usize, low: bool) {
        let padded = self.size.padded;
        let boundary = &self.problem.boundaries[d][usize::from(!low)];
        for i in 0..padded {
            let w = rows::face_state::<R, D>(block, padded, i);
            rows::put_state(block, padded, i, &boundary.ghost_cell(&w, d, low, self.problem.gas));
        }
    }
}
