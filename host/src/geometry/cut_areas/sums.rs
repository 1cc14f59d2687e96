//! Sums of areas over panels, and what else surfaces swept by circles and by lines share.

use glam::DVec3;
use std::f64::consts::TAU;
use voidage_core::number::kronrod::{panel, plus};

/// A panel is accepted where both rules differ by less than this share of the largest side of the box. That is the error of the coarser one.
pub(super) const ERROR: f64 = 1e-12;

/// A panel is not halved more often.
pub(super) const MOST_HALVINGS: u32 = 40;

/// Areas along x, y and z, not yet halved, and the wetted area.
pub(super) type Sums = [f64; 4];

/// Does a box from `lo` to `hi` touch that from the origin to `size`?
pub(super) fn touch([lo, hi]: [DVec3; 2], size: DVec3) -> bool {
    let slack = size * 1e-9;
    hi.cmpge(-slack).all() && lo.cmple(size + slack).all()
}

/// Real roots of `c₀ + c₁ t + c₂ t²`.
pub(super) fn roots([c0, c1, c2]: [f64; 3]) -> [Option<f64>; 2] {
    let under = c1 * c1 - 4.0 * c2 * c0;
    if !(under >= 0.0) {
        return [None; 2];
    }
    let q = -0.5 * (c1 + under.sqrt().copysign(c1));
    [(c2 != 0.0).then(|| q / c2), (q != 0.0).then(|| c0 / q)]
}

/// The arcs between some angles, which make up the circle; without any the whole from 0.
pub(super) fn arcs(angles: &mut [f64]) -> impl Iterator<Item = [f64; 2]> {
    angles.sort_unstable_by(f64::total_cmp);
    let first = angles.first().copied().unwrap_or(0.0);
    let ends = angles.iter().copied().skip(1).chain([first + TAU]);
    std::iter::once(first).chain(angles.iter().copied().skip(1)).zip(ends).map(|(from, to)| [from, to])
}

/// The integral of `at` from one place to another. Calls itself for halves, at most so many levels deep.
pub(super) fn summed(at: &mut dyn FnMut(f64) -> Sums, [from, to]: [f64; 2], tolerance: f64, halvings: u32) -> Sums {
    let error = |d: Sums| d.into_iter().map(f64::abs).fold(0.0, f64::max);
    let [fine, coarse] = panel([from, to], &mut *at, |d| error(d) <= tolerance);
    let middle = (from + to) * 0.5;
    if !(error(plus(fine, coarse, -1.0)) > tolerance) || halvings == 0 {
        return fine;
    }
    let halves = [[from, middle], [middle, to]].map(|half| summed(at, half, tolerance, halvings - 1));
    plus(halves[0], halves[1], 1.0)
}
