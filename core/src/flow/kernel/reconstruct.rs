//! From the cells of a row to its half-step states: slopes, the half step with drag, and first order where it must be.

use crate::flow::boundary::Boundary;
use crate::flow::kernel::rows::{self, Differences, Rate, Three, var};
use crate::flow::kernel::scratch::{Metric, Work};
use crate::flow::kernel::sweep::{Row, Sweep};
use crate::flow::limiter::{Limiter, Minmod, MonotonizedCentral, Slope, Steep, Unlimited, VanLeer};
use crate::flow::porosity::clusters::least_volume;
use crate::flow::porosity::flags::{KIND, any_marked, break_high, break_low, marked};
use crate::flow::state::{Gas, sum};
use crate::number::real::Real;

impl<R: Real, const D: usize> Sweep<'_, R, D> {
    /// Slopes and half-step states of a row of real cells; `l` and `j` say where it stands in the window.
    pub(in crate::flow) fn reconstruct(
        &self,
        row: Row<D>,
        l: isize,
        j: isize,
        work: &mut Work<'_, R, D>,
        fallen: &mut usize,
    ) {
        match self.problem.scheme.limiter {
            Limiter::Steep => self.reconstruct_with::<Steep>(row, l, j, work, fallen, true),
            Limiter::MonotonizedCentral => self.reconstruct_with::<MonotonizedCentral>(row, l, j, work, fallen, true),
            Limiter::VanLeer => self.reconstruct_with::<VanLeer>(row, l, j, work, fallen, true),
            Limiter::Minmod => self.reconstruct_with::<Minmod>(row, l, j, work, fallen, true),
            Limiter::Unlimited => self.reconstruct_with::<Unlimited>(row, l, j, work, fallen, true),
            Limiter::FirstOrder => self.reconstruct_with::<Minmod>(row, l, j, work, fallen, false),
        }
    }

    fn reconstruct_with<S: Slope>(
        &self,
        row: Row<D>,
        l: isize,
        j: isize,
        work: &mut Work<'_, R, D>,
        fallen: &mut usize,
        sloped: bool,
    ) {
        let n = self.size.n;
        self.metric(row, &mut work.metric);
        if sloped {
            self.slopes::<S>(row, l, j, work);
        } else {
            work.slope.iter_mut().for_each(|s| s.fill(R::ZERO));
        }
        let marks = self.medium.as_ref().map(|m| &m.porosity.marks[row.start..][..n]);
        let here = &work.window[self.block(l, j)];
        self.half_step(row, here, &work.slope, &work.metric, work.half);
        if self.problem.drag.is_some() {
            self.drag_half(row, here, work.half);
        }
        self.fall_back(row, here, &mut work.slope, work.half, marks, fallen);
    }

    /// Slopes of a row along all axes.
    fn slopes<S: Slope>(&self, row: Row<D>, l: isize, j: isize, work: &mut Work<'_, R, D>) {
        let (n, padded) = (self.size.n, self.size.padded);
        let here = &work.window[self.block(l, j)];
        let split = S::SPLIT && self.problem.gas.has_energy();
        if split {
            let inner = |v: usize| &var(here, v, padded)[1..][..n];
            let gamma = self.problem.gas.gamma();
            rows::compliances(inner(0), inner(D + 1), gamma, &mut work.metric.compliance[..n]);
        }
        let compliance = if split { Some(&*work.metric.compliance) } else { None };
        for d in 0..D {
            // The three values along axis d: shifted in the row, the rows beside it, or the layers beside it.
            let (below, above, shift) = if d == 0 {
                (here, here, 1)
            } else if d == D - 1 {
                (&work.window[self.block(l - 1, j)], &work.window[self.block(l + 1, j)], 0)
            } else {
                (&work.window[self.block(l, j - 1)], &work.window[self.block(l, j + 1)], 0)
            };
            let three = |v: usize| {
                let (low, high) = (var(below, v, padded), var(above, v, padded));
                (&low[1 - shift..][..n], &var(here, v, padded)[1..][..n], &high[1 + shift..][..n])
            };
            let widths = self.problem.mesh.widths[d];
            let gravity = self.problem.gravity[d];
            let out = &mut *work.slope[d];
            if gravity == R::ZERO && self.even[d] {
                self.slopes_along::<S>(d, row, three, &Even, compliance, out);
            } else {
                let place = if d == 0 { None } else { Some(row.at[d]) };
                let sides = self.problem.boundaries[d];
                let copied = sides.map(|b| matches!(b, Boundary::Wall | Boundary::ZeroGradient));
                let half_gravity = R::HALF * gravity;
                let axis = Uneven { widths, place, half_gravity, periodic: self.periodic[d], copied };
                self.slopes_along::<S>(d, row, three, &axis, compliance, out);
            }
        }
    }

    /// Slopes of a row along one axis, breaks included.
    fn slopes_along<'a, S: Slope>(
        &self,
        d: usize,
        row: Row<D>,
        values: impl Fn(usize) -> Three<'a, R>,
        axis: &impl Differences<R>,
        compliance: Option<&[R]>,
        out: &mut [R],
    ) {
        rows::slopes::<R, S, D>(&values, axis, compliance, out, self.size.n);
        self.slopes_at_boundaries(d, row, values(1 + d), axis, out);
        if let Some(medium) = &self.medium {
            self.slopes_at_breaks::<S>(medium, d, row, values, axis, compliance, out);
        }
    }

    /// The states at the half step from the cells `here` and their slopes.
    fn half_step(&self, row: Row<D>, here: &[R], slope: &[&mut [R]; D], metric: &Metric<'_, R, D>, half: &mut [R]) {
        let slope = slope.each_ref().map(|b| &**b);
        let rate = core::array::from_fn(|d| {
            if d == 0 || self.medium.is_some() {
                Rate::Row(&*metric.rate[d])
            } else {
                Rate::One(R::HALF * self.dt / self.problem.mesh.widths[d][row.at[d]])
            }
        });
        let widening = metric.widening.each_ref().map(|b| &**b);
        let weights = metric.weight.each_ref().map(|b| &**b);
        let weight = if self.weighted { Some(&weights) } else { None };
        let gamma = self.problem.gas.gamma();
        let padded = self.size.padded;
        if self.medium.is_some() {
            rows::half_step::<R, D, true>(here, padded, &slope, &rate, &widening, weight, gamma, half);
        } else {
            rows::half_step::<R, D, false>(here, padded, &slope, &rate, &widening, weight, gamma, half);
        }
    }

    /// First order where the face states would leave the physical set, where the caller asks, and in small cells.
    fn fall_back(
        &self,
        row: Row<D>,
        here: &[R],
        slope: &mut [&mut [R]; D],
        half: &mut [R],
        marks: Option<&[u8]>,
        fallen: &mut usize,
    ) {
        let (n, padded) = (self.size.n, self.size.padded);
        let any_leaves = rows::leaves_physical_set::<R, D>(half, &slope.each_ref().map(|b| &**b), n);
        let asked = self.first_order.map(|f| &f[row.start..][..n]).filter(|f| f.iter().any(|&b| b != 0));
        let small = marks.filter(|m| any_marked(m, KIND));
        if !any_leaves && asked.is_none() && small.is_none() {
            return;
        }
        for i in 0..n {
            let stays = |v: usize| (0..D).all(|d| half[v * n + i] - R::HALF * slope[d][v * n + i].abs() > R::ZERO);
            let leaves = !(stays(0) && stays(D + 1));
            let asked = asked.is_some_and(|f| f[i] != 0);
            let small = small.is_some_and(|m| m[i] & KIND != 0);
            if leaves || asked || small {
                *fallen += usize::from((leaves || asked) && self.counted.contains(&i));
                for v in 0..Self::V {
                    half[v * n + i] = here[v * padded + 1 + i];
                    for d in 0..D {
                        slope[d][v * n + i] = R::ZERO;
                    }
                }
            }
        }
    }

    /// Per-cell scales of the half step for one row.
    fn metric(&self, row: Row<D>, metric: &mut Metric<'_, R, D>) {
        let n = self.size.n;
        let mesh = &self.problem.mesh;
        let half_dt = R::HALF * self.dt;
        if self.weighted {
            for d in 0..D {
                for i in 0..n {
                    let k = if d == 0 { i } else { row.at[d] };
                    metric.weight[d][i] = self.problem.gravity[d] * mesh.widths[d][k];
                }
            }
        }
        let Some(medium) = &self.medium else { return };
        let volume = &medium.porosity.volume[row.start..][..n];
        let inv = &mut metric.spare[..n];
        for i in 0..n {
            inv[i] = R::ONE / R::larger(volume[i], least_volume());
        }
        for d in 0..D {
            let (low, high) = medium.ducts(d, row.at, self.periodic[d]).rows(n);
            let (rate, widening) = (&mut metric.rate[d][..n], &mut metric.widening[d][..n]);
            let across = if d == 0 { R::ZERO } else { half_dt / mesh.widths[d][row.at[d]] };
            let widths = &mesh.widths[0][..n];
            if d == 0 {
                for i in 0..n {
                    let scale = half_dt / widths[i];
                    rate[i] = R::HALF * (low[i] + high[i]) * inv[i] * scale;
                    widening[i] = (high[i] - low[i]) * inv[i] * scale;
                }
            } else {
                for i in 0..n {
                    rate[i] = R::HALF * (low[i] + high[i]) * inv[i] * across;
                    widening[i] = (high[i] - low[i]) * inv[i] * across;
                }
            }
        }
        let marks = &medium.porosity.marks[row.start..][..n];
        for d in 0..D {
            let ducts = medium.ducts(d, row.at, self.periodic[d]);
            for i in marked(marks, break_low(d) | break_high(d)) {
                let (low, high) = ducts.sections(i);
                let scale = half_dt / mesh.widths[d][row.at[d] + if d == 0 { i } else { 0 }];
                metric.rate[d][i] = R::HALF * (low + high) * metric.spare[i] * scale;
                metric.widening[d][i] = (high - low) * metric.spare[i] * scale;
            }
        }
    }

    /// Drag over the half step: slows the half state and heats it.
    fn drag_half(&self, row: Row<D>, here: &[R], half: &mut [R]) {
        let (n, padded) = (self.size.n, self.size.padded);
        let Some(drag) = &self.problem.drag else { return };
        for i in 0..n {
            let coefficients = drag.at(row.start + i);
            if coefficients.is_free() {
                continue;
            }
            let u: [R; D] = core::array::from_fn(|c| here[(1 + c) * padded + 1 + i]);
            let pushed: [R; D] = core::array::from_fn(|c| half[(1 + c) * n + i]);
            let v = coefficients.step(u, pushed, R::HALF * self.dt);
            let lost = sum::<R, D>(core::array::from_fn(|c| pushed[c] * pushed[c] - v[c] * v[c]));
            for c in 0..D {
                half[(1 + c) * n + i] = v[c];
            }
            if let Gas::Ideal { gamma } = self.problem.gas {
                half[(D + 1) * n + i] += (gamma - R::ONE) * R::HALF * half[i] * lost;
            }
        }
    }
}

/// An axis of equal cells without gravity.
struct Even;

impl<R: Real> Differences<R> for Even {
    #[inline(always)]
    fn scale(&self, _: usize) -> (R, R) {
        (R::ONE, R::ONE)
    }

    #[inline(always)]
    fn half_weight(&self, _: usize) -> Option<(R, R)> {
        None
    }
}

/// An axis with unequal cells or gravity. Beyond a boundary stands a cell of the same width, beyond a
/// periodic end the cell of the other end.
struct Uneven<'w, R> {
    widths: &'w [R],
    /// Index of the row along the axis; `None` if the axis is that of the row.
    place: Option<usize>,
    half_gravity: R,
    periodic: bool,
    /// The pressure beyond the low and high side is that inside, so gravity has no weight to subtract.
    copied: [bool; 2],
}

impl<R: Real> Uneven<'_, R> {
    /// Width of cell `i`, and the distances of its centre to those below and above.
    #[inline(always)]
    fn spacing(&self, i: usize) -> (R, R, R) {
        let i = self.place.unwrap_or(i);
        let own = self.widths[i];
        let last = self.widths.len() - 1;
        let beyond = |across: usize| if self.periodic { self.widths[across] } else { own };
        let low = if i > 0 { self.widths[i - 1] } else { beyond(last) };
        let high = if i < last { self.widths[i + 1] } else { beyond(0) };
        (own, R::HALF * (low + own), R::HALF * (own + high))
    }
}

impl<R: Real> Differences<R> for Uneven<'_, R> {
    #[inline(always)]
    fn scale(&self, i: usize) -> (R, R) {
        let (own, below, above) = self.spacing(i);
        (own / below, own / above)
    }

    #[inline(always)]
    fn half_weight(&self, i: usize) -> Option<(R, R)> {
        let (_, below, above) = self.spacing(i);
        let place = self.place.unwrap_or(i);
        let low = if self.copied[0] && place == 0 { R::ZERO } else { self.half_gravity * below };
        let high = if self.copied[1] && place + 1 == self.widths.len() { R::ZERO } else { self.half_gravity * above };
        Some((low, high))
    }
}
