//! Slopes of the variables of a row along one axis: the differences to the cells below and above, limited.

use crate::flow::kernel::rows::{split_mut, var};
use crate::flow::limiter::{Slope, SoundWave};
use crate::number::real::Real;

/// Values of one variable in the cells below, here and above along an axis.
pub(crate) type Three<'a, R> = (&'a [R], &'a [R], &'a [R]);

/// State blocks of a row and of what lies beside it along an axis: shifted by one cell in the row itself, or the blocks of other rows.
#[derive(Clone, Copy)]
pub(in crate::flow) struct RowBeside<'a, R> {
    pub below: &'a [R],
    pub here: &'a [R],
    pub above: &'a [R],
    /// 1 along the row, else 0.
    pub shift: usize,
    /// Cells of the row, and of its block with the ghosts.
    pub n: usize,
    pub padded: usize,
}

impl<'a, R> RowBeside<'a, R> {
    /// A variable in the cells below, here and above.
    #[inline(always)]
    pub fn values(&self, v: usize) -> Three<'a, R> {
        let of = |block: &'a [R], from: usize| &var(block, v, self.padded)[from..][..self.n];
        (of(self.below, 1 - self.shift), of(self.here, 1), of(self.above, 1 + self.shift))
    }
}

/// Half the weights of two cells of density 1, the lower one first: those below and here, those here and above.
pub(crate) type HalfWeights<R> = [[R; 2]; 2];

/// How differences along an axis become slopes.
pub(crate) trait Differences<R> {
    /// Are all cells alike, so that a slope that is limited leaves no face beyond the neighbour's value?
    fn is_even(&self) -> bool;
    /// Own width over the distance of the centres, below and above.
    fn scale(&self, i: usize) -> (R, R);
    /// What lies between the centres of the cells, below and above; `None` without gravity along the axis.
    fn half_weight(&self, i: usize) -> Option<HalfWeights<R>>;
}

/// Differences of a variable to the cell below and to the cell above.
#[derive(Clone, Copy)]
pub(super) struct Steps<R>(pub R, pub R);

impl<R: Real> Steps<R> {
    /// Of a variable in cell `i`.
    #[inline(always)]
    pub fn of((low, here, high): Three<'_, R>, i: usize) -> Self {
        Steps(here[i] - low[i], high[i] - here[i])
    }

    /// Of the pressure, less what hydrostatic balance asks for.
    #[inline(always)]
    fn of_pressure(p: Three<'_, R>, rho: Three<'_, R>, i: usize, axis: &impl Differences<R>) -> Self {
        let Steps(below, above) = Steps::of(p, i);
        match axis.half_weight(i) {
            None => Steps(below, above),
            Some([low, high]) => Steps(
                below - (rho.0[i] * low[0] + rho.1[i] * low[1]),
                above - (rho.1[i] * high[0] + rho.2[i] * high[1]),
            ),
        }
    }

    /// What of these does not go with those of the pressure.
    #[inline(always)]
    fn without(self, Steps(below, above): Self, compliance: R) -> Self {
        Steps(self.0 - below * compliance, self.1 - above * compliance)
    }

    /// The slope over cell `i` by a limiter of differences that are scaled to its width. Where the cell is wider than its neighbour, a limiter by itself
    /// lets the value at the face between them go beyond the neighbour's: half the slope is at most the smaller difference.
    #[inline(always)]
    pub fn slope(self, i: usize, axis: &impl Differences<R>, limited: bool, by: impl Fn(R, R) -> R) -> R {
        let (a, b) = axis.scale(i);
        let slope = by(a * self.0, b * self.1);
        if axis.is_even() || !limited {
            return slope;
        }
        let most = R::TWO * R::smaller(self.0.abs(), self.1.abs());
        match slope.abs() > most {
            true if slope < R::ZERO => -most,
            true => most,
            false => slope,
        }
    }
}

/// Slopes of all variables of a row along one axis. `values` gives a variable of the state block.
///
/// With the `compliance` 1/c² of each cell, the density's slope is that of a sound wave, dp/c², and a slope of the rest, which is
/// the entropy wave; without it each variable is limited by itself.
// A call keeps what the compiler knows: `out` is apart from all that is read.
#[inline(never)]
pub(crate) fn slopes<'a, R: Real, S: Slope, const D: usize>(
    values: impl Fn(usize) -> Three<'a, R>,
    axis: &impl Differences<R>,
    compliance: Option<&[R]>,
    out: &mut [R],
    n: usize,
) {
    for v in 1..=D {
        one_slope::<R, S>(values(v), axis, &mut out[v * n..][..n]);
    }
    let (p, rho) = (fit(values(D + 1), n), fit(values(0), n));
    let (out_rho, rest) = out.split_at_mut(n);
    let out_p = &mut rest[D * n..][..n];
    let Some(compliance) = compliance else {
        for i in 0..n {
            out_p[i] = Steps::of_pressure(p, rho, i, axis).slope(i, axis, S::LIMITED, S::slope);
        }
        return one_slope::<R, S>(rho, axis, out_rho);
    };
    let compliance = &compliance[..n];
    for i in 0..n {
        let of_pressure = Steps::of_pressure(p, rho, i, axis);
        let of_entropy = Steps::of(rho, i).without(of_pressure, compliance[i]);
        let pressure = of_pressure.slope(i, axis, S::LIMITED, S::slope);
        let entropy = of_entropy.slope(i, axis, S::LIMITED, S::entropy_slope);
        out_p[i] = pressure;
        out_rho[i] = pressure * compliance[i] + entropy;
    }
}

/// Slopes of one variable.
fn one_slope<R: Real, S: Slope>(values: Three<'_, R>, axis: &impl Differences<R>, out: &mut [R]) {
    let n = out.len();
    let values = fit(values, n);
    for i in 0..n {
        out[i] = Steps::of(values, i).slope(i, axis, S::LIMITED, S::slope);
    }
}

/// Slopes of all variables of a row along axis `d`, those of sound by its waves: one goes upward, one downward, and they change the pressure by ± ρ c times the
/// velocity. `rate` of each cell as in [`half_step`](crate::flow::kernel::rows::half_step), the `compliance` 1/c² of each; what goes with the gas is as in [`slopes`].
#[inline(never)]
pub(crate) fn slopes_by_waves<'a, R: Real, S: Slope, const D: usize>(
    d: usize,
    values: impl Fn(usize) -> Three<'a, R>,
    axis: &impl Differences<R>,
    (compliance, rate): (&[R], &[R]),
    out: &mut [R],
    n: usize,
) {
    let (rho, u, p) = (fit(values(0), n), fit(values(1 + d), n), fit(values(D + 1), n));
    let (compliance, rate) = (&compliance[..n], &rate[..n]);
    let (out_rho, out_u, out_p, _) = split_mut::<R, D>(out, n);
    for (c, out_u) in out_u.into_iter().enumerate() {
        if c != d {
            one_slope::<R, S>(values(1 + c), axis, out_u);
            continue;
        }
        for i in 0..n {
            let (speed, sound) = (u.1[i], R::ONE / compliance[i].sqrt());
            let impedance = rho.1[i] * sound;
            let of_pressure = Steps::of_pressure(p, rho, i, axis);
            let of_velocity = Steps::of(u, i);
            let upward = SoundWave::new(R::TWO * rate[i] * (speed + sound));
            let downward = SoundWave::new(R::TWO * rate[i] * (speed - sound));
            let up = of_pressure.without(of_velocity, -impedance).slope(i, axis, true, |a, b| upward.slope(a, b));
            let down = of_pressure.without(of_velocity, impedance).slope(i, axis, true, |a, b| downward.slope(a, b));
            out_p[i] = R::HALF * (up + down);
            out_u[i] = R::HALF * (up - down) / impedance;
        }
    }
    for i in 0..n {
        let of_entropy = Steps::of(rho, i).without(Steps::of_pressure(p, rho, i, axis), compliance[i]);
        out_rho[i] = out_p[i] * compliance[i] + of_entropy.slope(i, axis, S::LIMITED, S::entropy_slope);
    }
}

/// One length for all, so that the loops need no checks.
#[inline(always)]
pub(super) fn fit<R>((a, b, c): Three<'_, R>, n: usize) -> Three<'_, R> {
    (&a[..n], &b[..n], &c[..n])
}

/// 1/c² of each cell of a row.
pub(crate) fn compliances<R: Real>(rho: &[R], p: &[R], gamma: impl Fn(usize) -> R, out: &mut [R]) {
    let n = out.len();
    let (rho, p) = (&rho[..n], &p[..n]);
    for i in 0..n {
        out[i] = rho[i] / (gamma(i) * p[i]);
    }
}
