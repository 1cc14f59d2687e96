//! From the cells of a row to its half-step states: slopes, the half step with drag, and first order where it must be.

use crate::flow::kernel::contractions::{Contractions, sections_at};
use crate::flow::kernel::inclined_walls::slip_along_walls;
use crate::flow::kernel::mixed;
use crate::flow::kernel::row_slopes::{self, Differences, HalfWeights, RowBeside};
use crate::flow::kernel::rows::{self, Rate, StateBlock, var};
use crate::flow::kernel::scratch::{RowCoefficients, Work};
use crate::flow::kernel::shocks::Pressures;
use crate::flow::kernel::slab::{Place, RowAt, Slab};
use crate::flow::kernel::slopes_at_breaks::{
    CellSlopes, flatten_beside_closed_faces, limited, slopes_at_boundaries, slopes_at_breaks,
};
use crate::flow::limiter::{Limiter, Minmod, MonotonizedCentral, Slope, Steep, Unlimited, VanLeer};
use crate::flow::porosity::flags::{BORDER, SMALL, any_marked, any_small_or_border, break_high, break_low, is, marked};
use crate::flow::porosity::fractions::least_volume;
use crate::flow::problem::Problem;
use crate::flow::state::{Gas, sum};
use crate::number::real::Real;

/// Slopes and half-step states of a row of real cells, which stands in the window at a layer and row. Counts the cells that had to fall
/// back to first order.
pub(in crate::flow) fn reconstruct<R: Real, const D: usize, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    row: RowAt<D>,
    place: Place,
    work: &mut Work<'_, R, D>,
    first_order_cells: &mut usize,
) {
    let contractions = Contractions::new(slab, work.contractions, work.window);
    coefficients(slab, (row, place), contractions, &mut work.coefficients);
    match slab.problem.scheme.limiter {
        Limiter::AroraRoe => slopes::<R, D, Steep, MIXED, true>(slab, row, place, work),
        Limiter::Steep => slopes::<R, D, Steep, MIXED, false>(slab, row, place, work),
        Limiter::MonotonizedCentral => slopes::<R, D, MonotonizedCentral, MIXED, false>(slab, row, place, work),
        Limiter::VanLeer => slopes::<R, D, VanLeer, MIXED, false>(slab, row, place, work),
        Limiter::Minmod => slopes::<R, D, Minmod, MIXED, false>(slab, row, place, work),
        Limiter::Unlimited => slopes::<R, D, Unlimited, MIXED, false>(slab, row, place, work),
        Limiter::FirstOrder => work.slope.iter_mut().for_each(|s| s.fill(R::ZERO)),
    }
    let n = slab.size.n;
    let marks = slab.medium.as_ref().map(|m| &m.porosity.marks[row.start..][..n]);
    let here = &work.window[slab.block(place.0, place.1)];
    if MIXED {
        let n_slope = (D + 2) * n;
        let mut slope = work.slope.each_mut().map(|s| &mut s[n_slope..][..n]);
        let own = &var(here, D + 2, slab.size.padded)[1..][..n];
        mixed::bound_slopes(own, &mut slope, slab.capacities);
    }
    half_step::<R, D, MIXED>(slab, row, here, &work.slope, &work.coefficients, work.half);
    if slab.problem.drag.is_some() {
        drag_half::<R, D, MIXED>(slab, row, here, work.half);
    }
    fall_back::<R, D, MIXED>(slab, row, here, &mut work.slope, work.half, marks, first_order_cells);
    let end = work.half.len();
    work.half.copy_within((D + 1) * n..(D + 2) * n, end - n);
    if slab.medium.is_some() {
        let seen = Pressures { window: work.window, ranges: work.ranges };
        slip_along_walls::<R, D, MIXED>(slab, row, place, seen, &mut work.strength[..n], work.half);
    }
}

/// Slopes of a row along all axes; those of sound `BY_WAVES`, or each variable by itself.
fn slopes<R: Real, const D: usize, S: Slope, const MIXED: bool, const BY_WAVES: bool>(
    slab: &Slab<'_, R, D>,
    row: RowAt<D>,
    (l, j): Place,
    work: &mut Work<'_, R, D>,
) {
    let (n, padded) = (slab.size.n, slab.size.padded);
    let here = &work.window[slab.block(l, j)];
    let split = BY_WAVES || (S::SPLIT && slab.problem.gas.has_energy());
    if split {
        let inner = |v: usize| &var(here, v, padded)[1..][..n];
        let (rho, p, out) = (inner(0), inner(D + 1), &mut work.coefficients.compliance[..n]);
        if MIXED {
            let capacity = inner(D + 2);
            row_slopes::compliances(rho, p, |i| mixed::gamma_of(capacity[i]), out);
        } else {
            let gamma = slab.problem.gas.gamma();
            row_slopes::compliances(rho, p, |_| gamma, out);
        }
    }
    let of_row = (&work.coefficients, split.then_some(&*work.coefficients.compliance));
    for d in 0..D {
        // The three values along axis d: shifted in the row, the rows beside it, or the layers beside it.
        let (below, above, shift) = if d == 0 {
            (here, here, 1)
        } else if d == D - 1 {
            (&work.window[slab.block(l - 1, j)], &work.window[slab.block(l + 1, j)], 0)
        } else {
            (&work.window[slab.block(l, j - 1)], &work.window[slab.block(l, j + 1)], 0)
        };
        let at_breaks = (Contractions::new(slab, work.contractions, work.window), (l, j));
        let cells = (&RowBeside { below, here, above, shift, n, padded }, at_breaks);
        let widths = slab.problem.mesh.widths[d];
        let gravity = slab.problem.gravity[d];
        let out = &mut *work.slope[d];
        if gravity == R::ZERO && slab.even[d] {
            slopes_along::<R, D, S, MIXED, BY_WAVES>(slab, (d, row), cells, &Even, of_row, out);
        } else {
            let place = if d == 0 { None } else { Some(row.at[d]) };
            let sides = slab.problem.boundaries[d].map(|b| b.copies_inside());
            let sides = Sides { sides, problem: slab.problem, d, at: row.at };
            let half_gravity = R::HALF * gravity;
            let (is_even, periodic) = (slab.even[d], slab.periodic[d]);
            let axis = Uneven { widths, is_even, place, half_gravity, periodic, sides };
            slopes_along::<R, D, S, MIXED, BY_WAVES>(slab, (d, row), cells, &axis, of_row, out);
        }
    }
}

/// Slopes of a row along one axis, breaks included.
fn slopes_along<R: Real, const D: usize, S: Slope, const MIXED: bool, const BY_WAVES: bool>(
    slab: &Slab<'_, R, D>,
    (d, row): (usize, RowAt<D>),
    (cells, at_breaks): (&RowBeside<'_, R>, (Contractions<'_, R>, Place)),
    axis: &impl Differences<R>,
    (of_row, compliance): (&RowCoefficients<'_, R, D>, Option<&[R]>),
    out: &mut [R],
) {
    let values = |v| cells.values(v);
    if BY_WAVES {
        let coefficients = (&*of_row.compliance, &*of_row.rate[d]);
        row_slopes::slopes_by_waves::<R, S, D>(d, values, axis, coefficients, out, cells.n);
    } else {
        row_slopes::slopes::<R, S, D>(values, axis, compliance, out, cells.n);
    }
    if MIXED {
        mixed::slopes::<R, S>(cells.values(D + 2), axis, &mut out[(D + 2) * cells.n..][..cells.n]);
    }
    slopes_at_boundaries(slab, d, row, cells.values(1 + d), axis, out);
    if slab.medium.is_some() {
        flatten_beside_closed_faces::<R, D, MIXED>(slab, d, row, out);
        let one = CellSlopes { axis, compliance, limit: limited::<R, S, D> };
        slopes_at_breaks::<R, D, MIXED>(slab, (d, row), (cells, at_breaks), &one, out);
    }
}

/// The states at the half step from the cells `here` and their slopes.
fn half_step<R: Real, const D: usize, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    row: RowAt<D>,
    here: &[R],
    slope: &[&mut [R]; D],
    of_row: &RowCoefficients<'_, R, D>,
    half: &mut [R],
) {
    let slope = slope.each_ref().map(|b| &**b);
    let rate = core::array::from_fn(|d| {
        if d == 0 || slab.medium.is_some() {
            Rate::Row(&*of_row.rate[d])
        } else {
            Rate::One(R::HALF * slab.dt / slab.problem.mesh.widths[d][row.at[d]])
        }
    });
    let widening = of_row.widening.each_ref().map(|b| &**b);
    let weights = of_row.weight.each_ref().map(|b| &**b);
    let weight = if slab.weighted { Some(&weights) } else { None };
    let gamma = slab.problem.gas.gamma();
    let (values, padded) = (here, slab.size.padded);
    let here = StateBlock { values, n: padded };
    if MIXED {
        let capacity = &var(values, D + 2, padded)[1..][..slab.size.n];
        let gamma = |i: usize| mixed::gamma_of(capacity[i]);
        if slab.medium.is_some() {
            rows::half_step::<R, D, true>(here, &slope, &rate, &widening, weight, gamma, half);
        } else {
            rows::half_step::<R, D, false>(here, &slope, &rate, &widening, weight, gamma, half);
        }
        mixed::half_step::<R, D>((values, padded), &slope, &rate, half);
    } else if slab.medium.is_some() {
        rows::half_step::<R, D, true>(here, &slope, &rate, &widening, weight, |_| gamma, half);
    } else {
        rows::half_step::<R, D, false>(here, &slope, &rate, &widening, weight, |_| gamma, half);
    }
}

/// First order where the face states would leave the physical set, where the caller asks, and in small cells.
fn fall_back<R: Real, const D: usize, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    row: RowAt<D>,
    here: &[R],
    slope: &mut [&mut [R]; D],
    half: &mut [R],
    marks: Option<&[u8]>,
    first_order_cells: &mut usize,
) {
    let (n, padded) = (slab.size.n, slab.size.padded);
    let any_leaves = rows::leaves_physical_set::<R, D>(half, &slope.each_ref().map(|b| &**b), n);
    let asked = slab.first_order.map(|f| &f[row.start..][..n]).filter(|f| f.iter().any(|&b| b != 0));
    let small = marks.filter(|m| any_small_or_border(m));
    if !any_leaves && asked.is_none() && small.is_none() {
        return;
    }
    for i in 0..n {
        let stays = |v: usize| (0..D).all(|d| half[v * n + i] - R::HALF * slope[d][v * n + i].abs() > R::ZERO);
        let leaves = any_leaves && !(stays(0) && stays(D + 1));
        let asked = asked.is_some_and(|f| f[i] != 0);
        let small = small.is_some_and(|m| is(m[i], SMALL) || is(m[i], BORDER));
        if leaves || asked || small {
            *first_order_cells += usize::from((leaves || asked) && slab.reported.contains(&i));
            for v in 0..D + 2 + usize::from(MIXED) {
                half[v * n + i] = here[v * padded + 1 + i];
                for d in 0..D {
                    slope[d][v * n + i] = R::ZERO;
                }
            }
        }
    }
}

/// Coefficients of the half step for one row.
fn coefficients<R: Real, const D: usize>(
    slab: &Slab<'_, R, D>,
    (row, place): (RowAt<D>, Place),
    contractions: Contractions<'_, R>,
    of_row: &mut RowCoefficients<'_, R, D>,
) {
    let n = slab.size.n;
    let mesh = &slab.problem.mesh;
    let half_dt = R::HALF * slab.dt;
    if slab.weighted {
        for d in 0..D {
            for i in 0..n {
                let k = if d == 0 { i } else { row.at[d] };
                of_row.weight[d][i] = slab.problem.gravity[d] * mesh.widths[d][k];
            }
        }
    }
    let Some(medium) = &slab.medium else {
        if slab.problem.scheme.limiter == Limiter::AroraRoe {
            for d in 1..D {
                of_row.rate[d][..n].fill(half_dt / mesh.widths[d][row.at[d]]);
            }
        }
        return;
    };
    let volume = &medium.porosity.volume[row.start..][..n];
    let inv = &mut of_row.spare[..n];
    for i in 0..n {
        inv[i] = R::ONE / R::larger(volume[i], least_volume());
    }
    for d in 0..D {
        let (low, high) = medium.ducts(d, row.at).rows(n);
        let (rate, widening) = (&mut of_row.rate[d][..n], &mut of_row.widening[d][..n]);
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
    for d in (0..D).filter(|&d| any_marked(marks, break_low(d) | break_high(d))) {
        let (ducts, sides) = (medium.ducts(d, row.at), contractions.at_sides(slab, d, place));
        for i in marked(marks, break_low(d) | break_high(d)) {
            let breaks = [ducts.breaks(i, false), ducts.breaks(i, true)];
            let (low, high) = ducts.sections(i, sections_at(slab, (d, row.at, i), (&ducts, &sides), breaks));
            let scale = half_dt / mesh.widths[d][row.at[d] + if d == 0 { i } else { 0 }];
            of_row.rate[d][i] = R::HALF * (low + high) * of_row.spare[i] * scale;
            of_row.widening[d][i] = (high - low) * of_row.spare[i] * scale;
        }
    }
}

/// Drag over the half step: slows the half state and heats it.
fn drag_half<R: Real, const D: usize, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    row: RowAt<D>,
    here: &[R],
    half: &mut [R],
) {
    let (n, padded) = (slab.size.n, slab.size.padded);
    let Some(drag) = &slab.problem.drag else { return };
    for i in 0..n {
        let coefficients = drag.at(row.start + i);
        if coefficients.is_free() {
            continue;
        }
        let u: [R; D] = core::array::from_fn(|c| here[(1 + c) * padded + 1 + i]);
        let pushed: [R; D] = core::array::from_fn(|c| half[(1 + c) * n + i]);
        let v = coefficients.step(u, pushed, R::HALF * slab.dt);
        let lost = sum::<R, D>(core::array::from_fn(|c| pushed[c] * pushed[c] - v[c] * v[c]));
        for c in 0..D {
            half[(1 + c) * n + i] = v[c];
        }
        if let Gas::Ideal { gamma } = slab.gas_of::<MIXED>(here, (D + 2) * padded + 1 + i) {
            half[(D + 1) * n + i] += (gamma - R::ONE) * R::HALF * half[i] * lost;
        }
    }
}
/// An axis of equal cells without gravity.
struct Even;

impl<R: Real> Differences<R> for Even {
    #[inline(always)]
    fn is_even(&self) -> bool {
        true
    }

    #[inline(always)]
    fn scale(&self, _: usize) -> (R, R) {
        (R::ONE, R::ONE)
    }

    #[inline(always)]
    fn half_weight(&self, _: usize) -> Option<HalfWeights<R>> {
        None
    }
}

/// What stands on the sides of an axis beside the cells of a row.
struct Sides<'p, R, const D: usize> {
    /// The pressure beyond the low and the high side, patches aside, is that inside.
    sides: [bool; 2],
    problem: &'p Problem<'p, R, D>,
    d: usize,
    /// Index of the first cell of the row along each axis.
    at: [usize; D],
}

impl<R: Real, const D: usize> Sides<'_, R, D> {
    /// The pressure beyond the low or the high side is that inside, so gravity has no weight to subtract.
    #[inline(always)]
    fn copy_inside(&self, high: bool, i: usize) -> bool {
        if D < 2 || self.problem.patches.is_empty() { self.sides[usize::from(high)] } else { self.copies(high, i) }
    }

    /// The same where patches are.
    #[inline(never)]
    fn copies(&self, high: bool, i: usize) -> bool {
        let mut at = self.at;
        at[0] += i;
        self.problem.side(self.d, high, at).copies_inside()
    }
}

/// An axis with unequal cells or gravity. Beyond a boundary stands a cell of the same width, beyond a
/// periodic end the cell of the other end.
struct Uneven<'w, R, const D: usize> {
    widths: &'w [R],
    is_even: bool,
    /// Index of the row along the axis; `None` if the axis is that of the row.
    place: Option<usize>,
    half_gravity: R,
    periodic: bool,
    sides: Sides<'w, R, D>,
}

impl<R: Real, const D: usize> Uneven<'_, R, D> {
    /// Widths of the cells below `i`, here and above.
    #[inline(always)]
    fn three(&self, i: usize) -> [R; 3] {
        let i = self.place.unwrap_or(i);
        let own = self.widths[i];
        let last = self.widths.len() - 1;
        let beyond = |across: usize| if self.periodic { self.widths[across] } else { own };
        let low = if i > 0 { self.widths[i - 1] } else { beyond(last) };
        let high = if i < last { self.widths[i + 1] } else { beyond(0) };
        [low, own, high]
    }
}

impl<R: Real, const D: usize> Differences<R> for Uneven<'_, R, D> {
    #[inline(always)]
    fn is_even(&self) -> bool {
        self.is_even
    }

    #[inline(always)]
    fn scale(&self, i: usize) -> (R, R) {
        let [low, own, high] = self.three(i);
        (own / (R::HALF * (low + own)), own / (R::HALF * (own + high)))
    }

    #[inline(always)]
    fn half_weight(&self, i: usize) -> Option<HalfWeights<R>> {
        let [low, own, high] = self.three(i).map(|width| self.half_gravity * width);
        let place = self.place.unwrap_or(i);
        let copies = |high: bool, end: usize| place == end && self.sides.copy_inside(high, i);
        let (no_low, no_high) = (copies(false, 0), copies(true, self.widths.len() - 1));
        let between = |is_copied: bool, both: [R; 2]| if is_copied { [R::ZERO; 2] } else { both };
        Some([between(no_low, [low, own]), between(no_high, [own, high])])
    }
}
