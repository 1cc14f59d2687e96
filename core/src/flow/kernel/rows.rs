//! The steps of the scheme for one row of cells along axis 0.
//!
//! Every function is one loop without branches over contiguous slices, so that compilers turn it into vector code.
//! A *block* holds several variables of one row one after the other, each `n` long:
//!
//! - state block: density, velocity (D), pressure; D + 2 variables
//! - face state block: the same and the reference pressure of the cell at that face; D + 3
//! - flux block: mass, momentum (normal as the left cell sees it, then tangential in cyclic order), energy, normal momentum as
//!   the right cell sees it; D + 3
//! - change block: density, momentum, energy; D + 2
//!
//! Of a mixed gas more follows: see `mixed`.
//!
//! Reference: E. F. Toro, *Riemann Solvers and Numerical Methods for Fluid Dynamics*, 3rd ed., sec. 14.4 (MUSCL-Hancock) and 16.5.

use crate::flow::state::{Fields, FieldsMut, Gas, Primitive, each, sum};
use crate::number::real::Real;

/// Variable `v` of a block of variables `n` long.
#[inline(always)]
pub(crate) fn var<R>(block: &[R], v: usize, n: usize) -> &[R] {
    &block[v * n..][..n]
}

/// A state block, its variables `n` long.
#[derive(Clone, Copy)]
pub(crate) struct StateBlock<'b, R> {
    pub values: &'b [R],
    pub n: usize,
}

/// A flux block to be written, its variables `n` long.
pub(crate) struct FluxBlock<'b, R> {
    pub values: &'b mut [R],
    pub n: usize,
}

/// Where a row of face states goes: a face state block, its variables `stride` long, from the place `offset` of each on.
pub(crate) struct Faces<'b, R> {
    pub block: &'b mut [R],
    pub stride: usize,
    pub offset: usize,
}

/// A row of `n` cells that begins at index `from` of the old field and at `to` of the new one.
#[derive(Clone, Copy)]
pub(crate) struct Span {
    pub from: usize,
    pub to: usize,
    pub n: usize,
}

/// The variables of a state block.
#[inline(always)]
pub(super) fn state<R, const D: usize>(block: &[R], n: usize) -> (&[R], [&[R]; D], &[R]) {
    (var(block, 0, n), core::array::from_fn(|c| var(block, 1 + c, n)), var(block, D + 1, n))
}

/// The first D + 2 variables of a block, and what follows.
pub(super) type Variables<'b, R, const D: usize> = (&'b mut [R], [&'b mut [R]; D], &'b mut [R], &'b mut [R]);

/// The variables of a block to be written, D + 2 of them in the order of a state block, and what follows.
#[inline(always)]
pub(super) fn split_mut<R, const D: usize>(block: &mut [R], n: usize) -> Variables<'_, R, D> {
    let (first, mut rest) = block.split_at_mut(n);
    let middle = core::array::from_fn(|_| {
        let (a, b) = core::mem::take(&mut rest).split_at_mut(n);
        rest = b;
        a
    });
    let (last, rest) = rest.split_at_mut(n);
    (first, middle, last, rest)
}

/// Primitive variables of the cells from `start` on, into a padded state block (`n` = cells + 2).
pub(crate) fn primitives<R: Real, const D: usize>(
    gas: Gas<R>,
    old: &Fields<'_, R, D>,
    start: usize,
    block: &mut [R],
    n: usize,
) {
    let cells = n - 2;
    let (rho, u, p, _) = split_mut::<R, D>(block, n);
    let (rho, p) = (&mut rho[1..][..cells], &mut p[1..][..cells]);
    let u = u.map(|s| &mut s[1..][..cells]);
    let density = &old.density[start..][..cells];
    let momentum = old.momentum.map(|m| &m[start..][..cells]);
    match gas {
        Gas::Ideal { gamma } => {
            let energy = &old.energy[start..][..cells];
            for i in 0..cells {
                let inv = R::ONE / density[i];
                let kinetic = R::HALF * sum::<R, D>(each(|c| momentum[c][i] * (momentum[c][i] * inv)));
                rho[i] = density[i];
                for c in 0..D {
                    u[c][i] = momentum[c][i] * inv;
                }
                p[i] = (gamma - R::ONE) * (energy[i] - kinetic);
            }
        }
        _ => {
            for i in 0..cells {
                let inv = R::ONE / density[i];
                rho[i] = density[i];
                for c in 0..D {
                    u[c][i] = momentum[c][i] * inv;
                }
                p[i] = gas.pressure(density[i], R::ZERO);
            }
        }
    }
}

/// Scale of the differences along one axis in the half step.
#[derive(Clone, Copy)]
pub(crate) enum Rate<'a, R> {
    /// ½ dt / dx, the same for all cells of the row.
    One(R),
    /// One value per cell.
    Row(&'a [R]),
}

/// The state at the half step: W − ½ dt Σ A_d ∂W/∂x_d, and, in a porous medium, the change of the open area along each axis,
/// `widening[d]` = ½ dt Δbeta_d / (beta_v dx_d). `weight[d]` = g_d dx_d acts on the deviation from hydrostatic balance.
///
/// `here` is a padded state block, `gamma` that of each cell.
// A call for the same reason as that of `slopes`.
#[inline(never)]
pub(crate) fn half_step<R: Real, const D: usize, const POROUS: bool>(
    here: StateBlock<'_, R>,
    slope: &[&[R]; D],
    rate: &[Rate<'_, R>; D],
    widening: &[&[R]; D],
    weight: Option<&[&[R]; D]>,
    gamma: impl Fn(usize) -> R,
    out: &mut [R],
) {
    let n = here.n - 2;
    let (rho, u, p) = state::<R, D>(here.values, here.n);
    let (rho, p, u) = (&rho[1..][..n], &p[1..][..n], u.map(|s| &s[1..][..n]));
    let (out_rho, out_u, out_p, _) = split_mut::<R, D>(out, n);
    let s_rho: [&[R]; D] = core::array::from_fn(|d| var(slope[d], 0, n));
    let s_u: [[&[R]; D]; D] = core::array::from_fn(|d| core::array::from_fn(|c| var(slope[d], 1 + c, n)));
    let s_p: [&[R]; D] = core::array::from_fn(|d| var(slope[d], D + 1, n));
    let rows: [&[R]; D] = rate.map(|r| match r {
        Rate::One(_) => &rho[..n],
        Rate::Row(r) => &r[..n],
    });
    let ones: [R; D] = rate.map(|r| match r {
        Rate::One(r) => r,
        Rate::Row(_) => R::ZERO,
    });
    let is_row: [bool; D] = rate.map(|r| matches!(r, Rate::Row(_)));
    let widening = if POROUS { widening.map(|w| &w[..n]) } else { rows };
    let no_weight = rows;
    let weighted = weight.is_some();
    let weight = weight.map_or(no_weight, |w| w.map(|s| &s[..n]));
    // Axis 0 always comes as a row; the others only in a porous medium.
    debug_assert!(is_row[0] && (0..D).all(|d| is_row[d] == (POROUS || d == 0)));
    for i in 0..n {
        let velocity: [R; D] = each(|c| u[c][i]);
        let inv_rho = R::ONE / rho[i];
        let stiff = gamma(i) * p[i];
        let scale: [R; D] = each(|d| if POROUS || d == 0 { rows[d][i] } else { ones[d] });
        let wide: [R; D] = each(|d| if POROUS { widening[d][i] * velocity[d] } else { R::ZERO });
        let d_rho: [R; D] = each(|d| {
            let t = scale[d] * (velocity[d] * s_rho[d][i] + rho[i] * s_u[d][d][i]);
            if POROUS { t + wide[d] * rho[i] } else { t }
        });
        out_rho[i] = rho[i] - sum::<R, D>(d_rho);
        for c in 0..D {
            let d_u: [R; D] = each(|d| {
                let advection = velocity[d] * s_u[d][c][i];
                scale[d] * if d == c { advection + s_p[d][i] * inv_rho } else { advection }
            });
            out_u[c][i] = velocity[c] - sum::<R, D>(d_u);
        }
        let d_p: [R; D] = each(|d| {
            let t = scale[d] * (velocity[d] * s_p[d][i] + stiff * s_u[d][d][i]);
            if POROUS { t + wide[d] * stiff } else { t }
        });
        out_p[i] = p[i] - sum::<R, D>(d_p);
    }
    if weighted {
        let scale = |d: usize, i: usize| if POROUS || d == 0 { rows[d][i] } else { ones[d] };
        add_weight::<R, D>(scale, u, rho, weight, out_p);
    }
}

/// What the weight of the gas, `weight[d]` = g_d dx_d times its density, takes from its pressure over the half step.
fn add_weight<R: Real, const D: usize>(
    scale: impl Fn(usize, usize) -> R,
    u: [&[R]; D],
    rho: &[R],
    weight: [&[R]; D],
    pressure: &mut [R],
) {
    for (i, p) in pressure.iter_mut().enumerate() {
        let d_p: [R; D] = each(|d| scale(d, i) * (u[d][i] * (rho[i] * weight[d][i])));
        *p -= sum::<R, D>(d_p);
    }
}

/// Whether any face state of the row lies outside the physical set.
pub(crate) fn leaves_physical_set<R: Real, const D: usize>(half: &[R], slope: &[&[R]; D], n: usize) -> bool {
    let (rho, p) = (var(half, 0, n), var(half, D + 1, n));
    let s_rho: [&[R]; D] = core::array::from_fn(|d| var(slope[d], 0, n));
    let s_p: [&[R]; D] = core::array::from_fn(|d| var(slope[d], D + 1, n));
    let mut bad = 0u64;
    for i in 0..n {
        for d in 0..D {
            let least_rho = rho[i] - R::HALF * s_rho[d][i].abs();
            let least_p = p[i] - R::HALF * s_p[d][i].abs();
            bad |= u64::from(!((least_rho > R::ZERO) & (least_p > R::ZERO)));
        }
    }
    bad != 0
}

/// States on the high (`SIDE` = 1) or low (−1) face of each cell, and the pressure on the walls inside the cell, which stands at the end of `half`.
/// `weight` = g dx tilts both along the hydrostatic gradient. The velocity is turned into the frame of axis `d`.
pub(crate) fn face_states<R: Real, const D: usize>(
    high: bool,
    d: usize,
    half: &[R],
    slope: &[R],
    n: usize,
    weight: Option<&[R]>,
    Faces { block: out, stride, offset }: Faces<'_, R>,
) {
    let sign = if high { R::HALF } else { -R::HALF };
    let turned = |v: usize| if v == 0 || v == D + 1 { v } else { 1 + (v - 1 + D - d) % D };
    for v in 0..D + 2 {
        let (h, s) = (var(half, v, n), var(slope, v, n));
        let o = &mut out[turned(v) * stride + offset..][..n];
        for i in 0..n {
            o[i] = h[i] + sign * s[i];
        }
    }
    out[(D + 2) * stride + offset..][..n].copy_from_slice(&half[half.len() - n..]);
    if let Some(weight) = weight {
        let rho = var(half, 0, n);
        let tilted = |p: R, i: usize| {
            let tilt = R::HALF * weight[i] * rho[i];
            if high { p + tilt } else { p - tilt }
        };
        // The reference carries the weight of the cell; the state has a pressure, in however high a cell.
        let state = &mut out[(D + 1) * stride + offset..][..n];
        for i in 0..n {
            state[i] = R::larger(tilted(state[i], i), R::from_f64(LEAST_PRESSURE) * state[i]);
        }
        let reference = &mut out[(D + 2) * stride + offset..][..n];
        for i in 0..n {
            reference[i] = tilted(reference[i], i);
        }
    }
}

/// Share of the pressure of a cell that the weight of its half leaves at its face at least.
const LEAST_PRESSURE: f64 = 0.1;

/// What each cell of a row loses through its two faces of axis `d`, divided by its width there.
///
/// `low` and `high` give a variable of the flux block at the cells' two faces; `inv_width` and `half_weight` = ½ g dx per cell.
pub(crate) fn differences<'a, R: Real, const D: usize, const ENERGY: bool>(
    d: usize,
    low: impl Fn(usize) -> &'a [R],
    high: impl Fn(usize) -> &'a [R],
    inv_width: impl Fn(usize) -> R,
    half_weight: Option<&[R]>,
    out: &mut [R],
    n: usize,
) {
    let difference = |a: &[R], b: &[R], o: &mut [R]| {
        let (a, b, o) = (&a[..n], &b[..n], &mut o[..n]);
        for i in 0..n {
            o[i] = (b[i] - a[i]) * inv_width(i);
        }
    };
    difference(low(0), high(0), &mut out[..n]);
    for c in 0..D {
        let v = 1 + (c + d) % D;
        let from = if c == 0 { low(D + 2) } else { low(1 + c) };
        difference(from, high(1 + c), &mut out[v * n..]);
    }
    if ENERGY {
        difference(low(D + 1), high(D + 1), &mut out[(D + 1) * n..]);
        if let Some(weight) = half_weight {
            // Work of gravity on the mass that passes: the sum over cells telescopes to the potential energy.
            let (a, b, o) = (low(0), high(0), &mut out[(D + 1) * n..][..n]);
            for i in 0..n {
                o[i] -= weight[i] * (a[i] + b[i]) * inv_width(i);
            }
        }
    }
}

/// The cells after the step: U − dt/beta_v Σ_d changes_d. `scale` holds dt/beta_v per cell in a porous medium.
pub(crate) fn update<R: Real, const D: usize, const ENERGY: bool, const MIXED: bool>(
    old: &Fields<'_, R, D>,
    new: &mut FieldsMut<'_, R, D>,
    Span { from, to, n }: Span,
    change: &[&[R]; D],
    scale: Option<&[R]>,
    dt: R,
) {
    let one = |old: &[R], v: usize, new: &mut [R]| {
        let (old, new) = (&old[from..][..n], &mut new[to..][..n]);
        let parts: [&[R]; D] = change.map(|b| var(b, v, n));
        match scale {
            None => {
                for i in 0..n {
                    new[i] = old[i] - dt * sum::<R, D>(each(|d| parts[d][i]));
                }
            }
            Some(scale) => {
                let scale = &scale[..n];
                for i in 0..n {
                    new[i] = old[i] - scale[i] * sum::<R, D>(each(|d| parts[d][i]));
                }
            }
        }
    };
    one(old.density, 0, new.density);
    for c in 0..D {
        one(old.momentum[c], 1 + c, new.momentum[c]);
    }
    if ENERGY {
        one(old.energy, D + 1, new.energy);
    }
    if MIXED {
        one(old.capacity, D + 2, new.capacity);
    }
}

/// Signal rate Σ_d open_d (|u_d| + c)/dx_d of each cell of a row of new states into `rate`; tells whether any state is
/// unphysical. `open[d]` is what `Problem::openness` gives for the cells of the row along axis `d`.
pub(crate) fn signal_rates<R: Real, const D: usize, const POROUS: bool>(
    gas: Gas<R>,
    new: &Fields<'_, R, D>,
    from: usize,
    inv_width: impl Fn(usize, usize) -> R,
    open: &[&[R]; D],
    rate: &mut [R],
) -> bool {
    let n = rate.len();
    let density = &new.density[from..][..n];
    let momentum = new.momentum.map(|m| &m[from..][..n]);
    let gamma = gas.gamma();
    let open: [&[R]; D] = if POROUS { open.map(|o| &o[..n]) } else { [density; D] };
    let speeds = |i: usize, inv: R, c: R| {
        sum::<R, D>(each(|d| {
            let t = ((momentum[d][i] * inv).abs() + c) * inv_width(d, i);
            if POROUS { t * open[d][i] } else { t }
        }))
    };
    let mut bad = 0u64;
    if let Gas::Ideal { .. } = gas {
        let energy = &new.energy[from..][..n];
        for i in 0..n {
            let inv = R::ONE / density[i];
            let kinetic = R::HALF * sum::<R, D>(each(|c| momentum[c][i] * (momentum[c][i] * inv)));
            let p = (gamma - R::ONE) * (energy[i] - kinetic);
            let r = speeds(i, inv, (gamma * p * inv).sqrt());
            bad |= u64::from(!((density[i] > R::ZERO) & (p > R::ZERO) & (r < R::INFINITY)));
            rate[i] = r;
        }
    } else {
        for i in 0..n {
            let inv = R::ONE / density[i];
            let p = gas.pressure(density[i], R::ZERO);
            let r = speeds(i, inv, (gamma * p * inv).sqrt());
            bad |= u64::from(!((density[i] > R::ZERO) & (p > R::ZERO) & (r < R::INFINITY)));
            rate[i] = r;
        }
    }
    bad != 0
}

/// The largest value of a row; NaN is passed over.
pub(crate) fn largest<R: Real>(row: &[R]) -> R {
    const LANES: usize = 16;
    let mut lanes = [R::ZERO; LANES];
    let mut chunks = row.chunks_exact(LANES);
    for chunk in &mut chunks {
        for i in 0..LANES {
            lanes[i] = R::larger(chunk[i], lanes[i]);
        }
    }
    let tail = chunks.remainder().iter().fold(R::ZERO, |m, &x| R::larger(x, m));
    lanes.iter().fold(tail, |m, &x| R::larger(x, m))
}

/// The least and the largest value of a row of positive ones; NaN is passed over.
pub(crate) fn range<R: Real>(row: &[R]) -> [R; 2] {
    const LANES: usize = 16;
    let (mut least, mut most) = ([R::MAX; LANES], [R::ZERO; LANES]);
    let mut chunks = row.chunks_exact(LANES);
    for chunk in &mut chunks {
        for i in 0..LANES {
            least[i] = R::smaller(chunk[i], least[i]);
            most[i] = R::larger(chunk[i], most[i]);
        }
    }
    let all = least.iter().zip(&most).fold([R::MAX, R::ZERO], |m, (a, b)| [R::smaller(*a, m[0]), R::larger(*b, m[1])]);
    chunks.remainder().iter().fold(all, |m, &x| [R::smaller(x, m[0]), R::larger(x, m[1])])
}

/// The face state at index `i` of a block `m` long, in the frame of its axis.
pub(crate) fn face_state<R: Real, const D: usize>(block: &[R], m: usize, i: usize) -> Primitive<R, D> {
    Primitive { density: block[i], velocity: each(|c| block[(1 + c) * m + i]), pressure: block[(D + 1) * m + i] }
}

/// Writes a state into a state or face state block.
pub(crate) fn put_state<R: Real, const D: usize>(block: &mut [R], m: usize, i: usize, w: &Primitive<R, D>) {
    block[i] = w.density;
    for c in 0..D {
        block[(1 + c) * m + i] = w.velocity[c];
    }
    block[(D + 1) * m + i] = w.pressure;
}
