//! Fluxes through the faces of a row along each axis, and the changes that they make in the cells.

use crate::flow::kernel::rows::{self, Openings, var};
use crate::flow::kernel::scratch::Work;
use crate::flow::kernel::sweep::{Row, Sweep};
use crate::flow::porosity::flags::{break_high, break_low, marked};
use crate::flow::riemann::Solver;
use crate::flow::step::PressureForm;
use crate::flow::step_report::Report;
use crate::number::real::Real;

impl<R: Real, const D: usize> Sweep<'_, R, D> {
    /// Face states of the present row on one side of axis `d`, from index `offset` of a block of rows `stride` long.
    fn states(&self, high: bool, d: usize, work: (&[R], &[R], &[R]), out: &mut [R], stride: usize, offset: usize) {
        let (half, slope, weight) = work;
        let weight = if self.problem.gravity[d] != R::ZERO { Some(weight) } else { None };
        rows::face_states::<R, D>(high, d, half, slope, self.size.n, weight, out, stride, offset);
    }

    /// Fluxes through the faces inside and at both ends of a row, and their differences.
    pub(in crate::flow) fn cross_row<S: Solver, const ENERGY: bool>(
        &self,
        row: Row<D>,
        j: isize,
        work: &mut Work<'_, R, D>,
        report: &mut Report<R, D>,
    ) {
        let s = self.size;
        let (n, m) = (s.n, s.m);
        let from = (&*work.half, &*work.slope[0], &*work.metric.weight[0]);
        self.states(true, 0, from, work.left, m, 1);
        self.states(false, 0, from, work.right, m, 0);
        let gas = self.problem.gas;
        let inner_low = rows::face_state::<R, D>(work.right, m, 0);
        let inner_high = rows::face_state::<R, D>(work.left, m, n);
        let (low, high) = if self.periodic[0] {
            (inner_high, inner_low)
        } else {
            let [a, b] = &self.problem.boundaries[0];
            (a.ghost(&inner_low, 0, true, gas), b.ghost(&inner_high, 0, false, gas))
        };
        rows::put_state(work.left, m, 0, &low);
        work.left[(D + 2) * m] = low.pressure;
        rows::put_state(work.right, m, n, &high);
        work.right[(D + 2) * m + n] = high.pressure;

        let openings = match &self.medium {
            None => Openings::None,
            Some(medium) => {
                let face = &medium.porosity.faces[0][medium.mesh.face(0, row.at)..][..m];
                match self.problem.scheme.pressure {
                    PressureForm::Geometric => Openings::Geometric(face),
                    PressureForm::Paper => {
                        let volume = &medium.porosity.volume[row.start..][..n];
                        work.metric.vol_left[1..].copy_from_slice(volume);
                        work.metric.vol_right[..n].copy_from_slice(volume);
                        work.metric.vol_left[0] = if self.periodic[0] { volume[n - 1] } else { volume[0] };
                        work.metric.vol_right[n] = if self.periodic[0] { volume[0] } else { volume[n - 1] };
                        Openings::Paper(face, work.metric.vol_left, work.metric.vol_right)
                    }
                }
            }
        };
        rows::fluxes::<R, S, D, ENERGY>(work.left, work.right, openings, &self.face_gas, work.flux, m);
        if let Some(medium) = &self.medium {
            let marks = &medium.porosity.marks[row.start..][..n];
            let last = Some(n).filter(|_| marks[n - 1] & break_high(0) != 0);
            let broken = marked(marks, break_low(0)).chain(last);
            self.fluxes_at_breaks::<S>(medium, 0, row.at, broken, [work.left, work.right], work.flux, m);
        }
        let flux = &*work.flux;
        for (side, i) in [(0, 0), (1, n)] {
            let wall = if side == 0 { &*work.right } else { &*work.left };
            self.count_inflow::<ENERGY>(0, side, row, (flux, wall), m, i, 1, report);
        }
        let inv = &*work.metric.inv_width;
        let weight = self.half_weight(0, 0, &mut *work.metric.spare);
        rows::differences::<R, D, ENERGY>(
            0,
            |v| &var(flux, v, m)[..n],
            |v| &var(flux, v, m)[1..],
            |i| inv[i],
            weight,
            &mut work.change[0][self.changes(0, self.place(j))],
            n,
        );
    }

    /// ½ g dx of the cells of a row along `d`, where its place is `k`, if gravity acts there.
    fn half_weight<'s>(&self, d: usize, k: usize, spare: &'s mut [R]) -> Option<&'s [R]> {
        let half_g = R::HALF * self.problem.gravity[d];
        if half_g == R::ZERO {
            return None;
        }
        let spare = &mut spare[..self.size.n];
        let widths = self.problem.mesh.widths[d];
        for (i, s) in spare.iter_mut().enumerate() {
            *s = half_g * widths[if d == 0 { i } else { k }];
        }
        Some(spare)
    }

    /// Fluxes of a row of faces across axis `d` > 0 between `left` and `work.right`, into `work.flux`. `at` names the row of
    /// cells above the faces, with `at[d]` one past the end at the upper boundary.
    fn cross_faces<S: Solver, const ENERGY: bool>(
        &self,
        d: usize,
        at: [usize; D],
        left: &[R],
        right: &[R],
        flux: &mut [R],
    ) {
        let n = self.size.n;
        let cells = self.problem.mesh.cells()[d];
        let row_of = |k: usize| {
            let mut a = at;
            a[d] = k;
            self.problem.mesh.index(a)
        };
        let k = at[d];
        let above = row_of(if k < cells {
            k
        } else if self.periodic[d] {
            0
        } else {
            cells - 1
        });
        let below = row_of(if k > 0 {
            k - 1
        } else if self.periodic[d] {
            cells - 1
        } else {
            0
        });
        let openings = match &self.medium {
            None => Openings::None,
            Some(medium) => {
                let face = &medium.porosity.faces[d][medium.mesh.face(d, at)..][..n];
                match self.problem.scheme.pressure {
                    PressureForm::Geometric => Openings::Geometric(face),
                    PressureForm::Paper => {
                        let volume = medium.porosity.volume;
                        Openings::Paper(face, &volume[below..][..n], &volume[above..][..n])
                    }
                }
            }
        };
        rows::fluxes::<R, S, D, ENERGY>(left, right, openings, &self.face_gas, flux, n);
        if let Some(medium) = &self.medium {
            let (start, bit) = if k < cells { (row_of(k), break_low(d)) } else { (row_of(cells - 1), break_high(d)) };
            let broken = marked(&medium.porosity.marks[start..][..n], bit);
            self.fluxes_at_breaks::<S>(medium, d, at, broken, [left, right], flux, n);
        }
    }

    /// Ghost states beside the boundary faces of axis `d`, from the inner face states.
    fn ghosts(&self, d: usize, low: bool, inner: &[R], out: &mut [R]) {
        let n = self.size.n;
        let boundary = &self.problem.boundaries[d][usize::from(!low)];
        for i in 0..n {
            let w = boundary.ghost(&rows::face_state::<R, D>(inner, n, i), d, low, self.problem.gas);
            rows::put_state(out, n, i, &w);
            out[(D + 2) * n + i] = w.pressure;
        }
    }

    /// Faces between row `j` and the row below it along axis 1 of a 3D mesh; `present` tells whether there is a row `j`.
    pub(in crate::flow) fn cross_middle<S: Solver, const ENERGY: bool>(
        &self,
        layer: usize,
        j: isize,
        present: bool,
        work: &mut Work<'_, R, D>,
        report: &mut Report<R, D>,
    ) {
        let d = 1 % D;
        let mut at = [0; D];
        at[D - 1] = layer;
        at[d] = j as usize;
        let mut lag = core::mem::take(&mut work.middle);
        let differ = j > self.rows.start as isize;
        let below_in_tile = if differ { self.place(j - 1) } else { 0 };
        self.cross_below::<S, ENERGY>(d, at, present, differ, below_in_tile, (lag.state, lag.flux), work, report);
        core::mem::swap(&mut lag, &mut work.middle);
    }

    /// Faces between row `j` of layer `l` and of the layer below; `present` tells whether there is a layer `l`.
    pub(in crate::flow) fn cross_last<S: Solver, const ENERGY: bool>(
        &self,
        l: isize,
        j: isize,
        present: bool,
        work: &mut Work<'_, R, D>,
        report: &mut Report<R, D>,
    ) {
        let f = Self::F * self.size.n;
        let mut at = [0; D];
        if D == 3 {
            at[1] = j as usize;
        }
        at[D - 1] = l as usize;
        let mut lag = core::mem::take(&mut work.last);
        let place = self.place(j);
        let own = (&mut lag.state[place * f..][..f], &mut lag.flux[place * f..][..f]);
        let differ = l > self.slab.start as isize;
        self.cross_below::<S, ENERGY>(D - 1, at, present, differ, place, own, work, report);
        core::mem::swap(&mut lag, &mut work.last);
    }

    /// Fluxes through the faces under a row along axis `d` > 0; `at` names the row, `present` tells whether it exists (else the
    /// boundary does). If `differ`, the changes of the row below follow, that row's place in the tile is `below_in_tile`.
    fn cross_below<S: Solver, const ENERGY: bool>(
        &self,
        d: usize,
        at: [usize; D],
        present: bool,
        differ: bool,
        below_in_tile: usize,
        (lag_state, lag_flux): (&mut [R], &mut [R]),
        work: &mut Work<'_, R, D>,
        report: &mut Report<R, D>,
    ) {
        let (n, f) = (self.size.n, Self::F * self.size.n);
        let mesh = &self.problem.mesh;
        if present {
            let from = (&*work.half, &*work.slope[d], &*work.metric.weight[d]);
            self.states(false, d, from, &mut work.right[..f], n, 0);
            if at[d] == 0 && !self.periodic[d] {
                self.ghosts(d, true, &work.right[..f], lag_state);
            }
        } else {
            self.ghosts(d, false, lag_state, &mut work.right[..f]);
        }
        self.cross_faces::<S, ENERGY>(d, at, lag_state, &work.right[..f], &mut work.flux[..f]);
        let last = mesh.cells()[d];
        for (side, edge, inside) in [(0, 0, 0), (1, last, last - 1)] {
            if at[d] == edge {
                let mut of_row = at;
                of_row[d] = inside;
                let row = Row { start: mesh.index(of_row), at: of_row };
                let wall = if side == 0 { &work.right[..f] } else { &*lag_state };
                self.count_inflow::<ENERGY>(d, side, row, (&work.flux[..f], wall), n, 0, n, report);
            }
        }
        if differ {
            let below = at[d] - 1;
            let inv = R::ONE / mesh.widths[d][below];
            let weight = self.half_weight(d, below, &mut *work.metric.spare);
            let (low, high) = (&*lag_flux, &work.flux[..f]);
            rows::differences::<R, D, ENERGY>(
                d,
                |v| var(low, v, n),
                |v| var(high, v, n),
                |_| inv,
                weight,
                &mut work.change[d][self.changes(d, below_in_tile)],
                n,
            );
        }
        lag_flux.copy_from_slice(&work.flux[..f]);
    }

    /// Leaves the high face states of the present row for the row above it.
    pub(in crate::flow) fn keep_middle(&self, work: &mut Work<'_, R, D>) {
        let n = self.size.n;
        let d = 1 % D;
        let from = (&*work.half, &*work.slope[d], &*work.metric.weight[d]);
        self.states(true, d, from, &mut work.middle.state[..Self::F * n], n, 0);
    }

    /// Leaves the high face states of the present row for the layer above it.
    pub(in crate::flow) fn keep_last(&self, j: isize, work: &mut Work<'_, R, D>) {
        let n = self.size.n;
        let from = (&*work.half, &*work.slope[D - 1], &*work.metric.weight[D - 1]);
        self.states(true, D - 1, from, &mut work.last.state[self.place(j) * Self::F * n..][..Self::F * n], n, 0);
    }
}
