//! The capacity Γ = 1/(γ − 1) of a mixed gas in the steps of a row: slopes, half step, faces, changes.
//!
//! Γ goes with the gas, ∂Γ/∂t + u·∇Γ = 0, and is no density that could be conserved: what a face carries is Γ at the face times the very velocity of
//! the energy's flux there, and each cell takes off its own Γ times what volume it gains. So where pressure and velocity are uniform the
//! energy pΓ + ½ρu² and Γ change by the same sums, and the pressure stays uniform whatever gases meet there; and gas of one Γ keeps it to the bit.
//! (R. Abgrall, J. Comput. Phys. 125 (1996) 150; K.-M. Shyue, J. Comput. Phys. 142 (1998) 208; E. Johnsen, T. Colonius, J. Comput. Phys. 219 (2006) 715.)
//!
//! Γ stays between the lowest and the highest of the gas. With c_d = |u_d| dt/dx_d the states at the faces of a cell lie within ½ Σ |s_d| of Γ;
//! [`bound_slopes`] keeps that within the distance of Γ from either bound, and the half step takes h = ½ Σ c_d s_d off: what leaves the cell changes it
//! by h (1 − Σ c_d), what enters by at most Σ c_d times the distance to the bound. Both together do not pass the bound as long as Σ c_d ≤ 1 and the
//! velocity is the same at all faces. Where it is not and a bound is passed nevertheless, the cell counts as unphysical, and first order helps.
//!
//! Γ stands behind the last variable of state and change blocks; in face state blocks behind the reference pressure; in flux blocks two variables stand
//! there: the volume that passes, and the Γ that it carries.

use crate::flow::kernel::row_slopes::{Differences, Steps, Three, fit};
use crate::flow::kernel::rows::{Faces, Rate, split_mut, var};
use crate::flow::limiter::Slope;
use crate::flow::state::{Fields, each, sum};
use crate::number::real::Real;

/// γ of a capacity.
#[inline(always)]
pub(crate) fn gamma_of<R: Real>(capacity: R) -> R {
    R::ONE + R::ONE / capacity
}

/// Primitive variables and capacities of the cells from `start` on, into a padded state block (`n` = cells + 2).
pub(crate) fn primitives<R: Real, const D: usize>(old: &Fields<'_, R, D>, start: usize, block: &mut [R], n: usize) {
    let cells = n - 2;
    let (rho, u, p, rest) = split_mut::<R, D>(block, n);
    let (rho, p, own) = (&mut rho[1..][..cells], &mut p[1..][..cells], &mut rest[1..][..cells]);
    let u = u.map(|s| &mut s[1..][..cells]);
    let (density, energy) = (&old.density[start..][..cells], &old.energy[start..][..cells]);
    let momentum = old.momentum.map(|m| &m[start..][..cells]);
    let capacity = &old.capacity[start..][..cells];
    for i in 0..cells {
        let inv = R::ONE / density[i];
        let kinetic = R::HALF * sum::<R, D>(each(|c| momentum[c][i] * (momentum[c][i] * inv)));
        rho[i] = density[i];
        for c in 0..D {
            u[c][i] = momentum[c][i] * inv;
        }
        p[i] = (energy[i] - kinetic) / capacity[i];
        own[i] = capacity[i];
    }
}

/// Slopes of the capacity of a row along one axis: those of an entropy wave, with which it goes.
pub(crate) fn slopes<R: Real, S: Slope>(capacity: Three<'_, R>, axis: &impl Differences<R>, out: &mut [R]) {
    let capacity = fit(capacity, out.len());
    for (i, out) in out.iter_mut().enumerate() {
        *out = Steps::of(capacity, i).slope(i, axis, S::LIMITED, S::entropy_slope);
    }
}

/// Lowers the slopes of the capacities of a row, `here` in the cells, where their sum could pass one of the bounds.
pub(crate) fn bound_slopes<R: Real, const D: usize>(here: &[R], slope: &mut [&mut [R]; D], [least, most]: [R; 2]) {
    for (i, &own) in here.iter().enumerate() {
        let margin = R::larger(R::smaller(own - least, most - own), R::ZERO);
        let reach = R::HALF * sum::<R, D>(each(|d| slope[d][i].abs()));
        if reach > margin {
            let share = margin / reach;
            slope.iter_mut().for_each(|s| s[i] = share * s[i]);
        }
    }
}

/// Capacities at the half step: Γ − ½ dt Σ u_d ∂Γ/∂x_d. `here` holds the state of the cells, a padded block.
pub(crate) fn half_step<R: Real, const D: usize>(
    (here, padded): (&[R], usize),
    slope: &[&[R]; D],
    rate: &[Rate<'_, R>; D],
    out: &mut [R],
) {
    let n = padded - 2;
    let inner = |v: usize| &var(here, v, padded)[1..][..n];
    let (own, u): (&[R], [&[R]; D]) = (inner(D + 2), each_slice(|c| inner(1 + c)));
    let slope: [&[R]; D] = each_slice(|d| var(slope[d], D + 2, n));
    let out = &mut out[(D + 2) * n..][..n];
    for i in 0..n {
        let lost: [R; D] = each(|d| {
            let scale = match rate[d] {
                Rate::One(r) => r,
                Rate::Row(r) => r[i],
            };
            scale * (u[d][i] * slope[d][i])
        });
        out[i] = own[i] - sum::<R, D>(lost);
    }
}

/// A slice for each axis.
fn each_slice<'a, R, const D: usize>(f: impl Fn(usize) -> &'a [R]) -> [&'a [R]; D] {
    core::array::from_fn(f)
}

/// Capacities on the high or low face of each cell, within the bounds.
pub(crate) fn face_states<R: Real, const D: usize>(
    high: bool,
    half: &[R],
    slope: &[R],
    n: usize,
    [least, most]: [R; 2],
    Faces { block, stride, offset }: Faces<'_, R>,
) {
    let sign = if high { R::HALF } else { -R::HALF };
    let (h, s) = (var(half, D + 2, n), var(slope, D + 2, n));
    let out = &mut block[(D + 3) * stride + offset..][..n];
    for i in 0..n {
        out[i] = (h[i] + sign * s[i]).limited(least, most);
    }
}

/// What passes a row of faces: volume, and the capacity that it carries.
#[derive(Clone, Copy)]
pub(crate) struct Carried<'b, R> {
    pub volume: &'b [R],
    pub capacity: &'b [R],
}

/// What the capacity of each cell of a row, `own`, loses through its two faces along an axis, divided by its width there.
pub(crate) fn differences<R: Real>(
    own: &[R],
    low: Carried<'_, R>,
    high: Carried<'_, R>,
    inv_width: impl Fn(usize) -> R,
    out: &mut [R],
) {
    let n = out.len();
    let own = &own[..n];
    let [low, high] = [low, high].map(|c| Carried { volume: &c.volume[..n], capacity: &c.capacity[..n] });
    for i in 0..n {
        let gained = low.capacity[i] - own[i] * low.volume[i];
        let lost = high.capacity[i] - own[i] * high.volume[i];
        out[i] = (lost - gained) * inv_width(i);
    }
}

/// Signal rate Σ_d open_d (|u_d| + c)/dx_d of each cell of a row of new states into `rate`; tells whether any state is unphysical or has a capacity out
/// of the bounds. As [`crate::flow::kernel::rows::signal_rates`], without porosity `open` is not read.
pub(crate) fn signal_rates<R: Real, const D: usize, const POROUS: bool>(
    new: &Fields<'_, R, D>,
    from: usize,
    inv_width: impl Fn(usize, usize) -> R,
    open: &[&[R]; D],
    [least, most]: [R; 2],
    rate: &mut [R],
) -> bool {
    let n = rate.len();
    let (density, energy) = (&new.density[from..][..n], &new.energy[from..][..n]);
    let (momentum, capacity) = (new.momentum.map(|m| &m[from..][..n]), &new.capacity[from..][..n]);
    let open: [&[R]; D] = if POROUS { open.map(|o| &o[..n]) } else { [density; D] };
    let mut bad = false;
    for i in 0..n {
        let inv = R::ONE / density[i];
        let kinetic = R::HALF * sum::<R, D>(each(|c| momentum[c][i] * (momentum[c][i] * inv)));
        let p = (energy[i] - kinetic) / capacity[i];
        let c = (gamma_of(capacity[i]) * p * inv).sqrt();
        let r = sum::<R, D>(each(|d| {
            let t = ((momentum[d][i] * inv).abs() + c) * inv_width(d, i);
            if POROUS { t * open[d][i] } else { t }
        }));
        let within = (capacity[i] >= least) & (capacity[i] <= most);
        bad |= !((density[i] > R::ZERO) & (p > R::ZERO) & (r < R::INFINITY) & within);
        rate[i] = r;
    }
    bad
}
