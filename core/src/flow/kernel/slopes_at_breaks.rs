//! Slopes where a row of cells breaks: beside walls (closed faces) and porosity jumps.
//!
//! A wall is treated as a `wall` boundary of the domain is, to the bit: the gas beside it meets its mirror image. Without that the velocity at the wall would
//! be that of the cell's middle, and a slow flow would stagnate at a pressure wrong by rho c u.
//!
//! Beyond a jump of a gentle contraction the slope sees the neighbour as it would be in a duct of this cell's area: a steady stream is flat then, and loses
//! nothing, and waves keep their second order. Where the gas is fast or a shock stands it sees it as it is. Beside a sudden jump both cells are flat.

use crate::flow::kernel::contractions::{AtFaces, Contractions, border_at, contractions_at};
use crate::flow::kernel::mixed;
use crate::flow::kernel::row_slopes::{self, Differences, HalfWeights, RowBeside, Three};
use crate::flow::kernel::slab::{Place, RowAt, Slab};
use crate::flow::limiter::{Slope, wall_slope};
use crate::flow::porosity::areas::{Ducts, share as share_of};
use crate::flow::porosity::flags::{any_marked, break_high, break_low, marked};
use crate::flow::porosity::throat::ThroatGas;
use crate::flow::state::{Gas, Primitive};
use crate::number::real::Real;

/// Variables of a state in three dimensions: density, three velocities, pressure.
const MOST: usize = 5;

/// Differences along an axis for a single cell, without gravity towards its mirror images.
pub(in crate::flow) struct Single<R> {
    scale: (R, R),
    half_weight: Option<HalfWeights<R>>,
}

impl<R: Real> Differences<R> for Single<R> {
    fn is_even(&self) -> bool {
        false
    }

    fn scale(&self, _: usize) -> (R, R) {
        self.scale
    }

    fn half_weight(&self, _: usize) -> Option<HalfWeights<R>> {
        self.half_weight
    }
}

/// Values of all variables in the cells below, here and above.
type CellValues<R> = [[R; 3]; MOST];

/// Slopes of all variables of a cell by a limiter: [`limited`].
type LimitCall<R> = fn(&CellValues<R>, &Single<R>, Option<&[R]>) -> [R; MOST];

/// Slopes along an axis one cell at a time, for any limiter and any widths.
pub(in crate::flow) struct CellSlopes<'a, R> {
    pub axis: &'a dyn Differences<R>,
    /// 1/c² of the cells of the row, as [`row_slopes::slopes`] takes it.
    pub compliance: Option<&'a [R]>,
    pub limit: LimitCall<R>,
}

/// Slopes of all variables of a cell by a limiter.
pub(in crate::flow) fn limited<R: Real, S: Slope, const D: usize>(
    three: &CellValues<R>,
    axis: &Single<R>,
    compliance: Option<&[R]>,
) -> [R; MOST] {
    let mut slope = [R::ZERO; MOST];
    let of = |v: usize| (&three[v][..1], &three[v][1..2], &three[v][2..]);
    row_slopes::slopes::<R, S, D>(of, axis, compliance, &mut slope, 1);
    slope
}

/// Sets the slopes along axis `d` to 0 in the cells of a row that have a closed face on that axis: the slope took its value from
/// beyond the face, where another gas flows, where a side of the domain puts what cannot come in, or where there is none and the state is whatever
/// the caller left in the solid.
///
/// At walls that are aligned with the grid [`slopes_at_breaks`] puts the slope towards the mirror image in its place. At inclined ones the slope along
/// the other axes stays. The difference on the open side alone would be of second order, and let shocks overshoot at the wall by twice as much.
// Called, not inlined: each limiter would hold its own.
#[inline(never)]
pub(in crate::flow) fn flatten_beside_closed_faces<R: Real, const D: usize, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    d: usize,
    row: RowAt<D>,
    out: &mut [R],
) {
    let Some(medium) = &slab.medium else { return };
    let n = slab.size.n;
    let (low, high) = medium.ducts(d, row.at).rows(n);
    // One pass without branches: most rows have none.
    let least = |row: &[R]| row.iter().fold(R::ONE, |least, open| R::smaller(least, *open));
    if R::smaller(least(low), least(high)) > R::ZERO {
        return;
    }
    for i in 0..n {
        if !(R::smaller(low[i], high[i]) > R::ZERO) {
            for v in 0..D + 2 + usize::from(MIXED) {
                out[v * n + i] = R::ZERO;
            }
        }
    }
}

/// Corrects the slopes along axis `d` in the cells of a row that have a wall or a jump of porosity on one side, where the usual slope took a value
/// from beyond it: at a wall that value is mirrored, at a jump brought to this cell's duct. Where gas flows along an inclined wall the correction fades out.
pub(in crate::flow) fn slopes_at_breaks<R: Real, const D: usize, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    (d, row): (usize, RowAt<D>),
    (cells, (contractions, place)): (&RowBeside<'_, R>, (Contractions<'_, R>, Place)),
    slopes: &CellSlopes<'_, R>,
    out: &mut [R],
) {
    let n = cells.n;
    let Some(medium) = &slab.medium else { return };
    let marks = &medium.porosity.marks[row.start..][..n];
    if !any_marked(marks, break_low(d) | break_high(d)) {
        return;
    }
    let (ducts, sides) = (medium.ducts(d, row.at), contractions.at_sides(slab, d, place));
    for i in marked(marks, break_low(d) | break_high(d)) {
        let (low, high) = ducts.openings(i);
        let open = [low > R::ZERO, high > R::ZERO];
        let breaks = [ducts.breaks(i, false), ducts.breaks(i, true)];
        let jumps = [breaks[0] & open[0], breaks[1] & open[1]];
        let walls = [breaks[0] & !open[0], breaks[1] & !open[1]];
        let ([a, b], on_border) = flatness(slab, (d, row.at, i), &sides, breaks);
        let gentle =
            [0, 1].map(|side| if jumps[side] && !on_border[side] { ducts.gentleness(i, side == 1) } else { R::ZERO });
        let acts = [0, 1].map(|side| if jumps[side] { sides[side].jump_share(i, gentle[side]) } else { R::ZERO });
        if walls == [false; 2] && acts == [R::ZERO; 2] {
            continue;
        }
        let share = if breaks == [true; 2] { R::larger(a, b) } else { R::smaller(a, b) };
        // Behind a closed face that is no wall may stand anything.
        let flat =
            [0, 1].map(|side| if jumps[side] { !(gentle[side] > R::ZERO) } else { !(breaks[side] || open[side]) });
        let mut slope = [R::ZERO; MOST];
        let mut of_capacity = R::ZERO;
        if flat == [false; 2] {
            let mut three = [[R::ZERO; 3]; MOST];
            for (v, three) in three[..D + 2].iter_mut().enumerate() {
                let (below, here, above) = cells.values(v);
                *three = [below[i], here[i], above[i]];
            }
            let stays = beyond_jumps::<R, D, MIXED>(slab, cells, &mut three, (&ducts, d, i), [gentle, acts]);
            if stays > R::ZERO {
                let beside_wall =
                    [false, true].map(|high| walls[usize::from(high)] || is_beside_wall(slab, d, (row.at, i), high));
                slope = slope_at_walls::<R, D>(d, beside_wall, three, i, slopes).map(|slope| stays * slope);
                // Of a mixed gas beside a wall, where its capacity meets itself, a limited slope is flat.
                if MIXED && walls == [false; 2] {
                    of_capacity = stays * out[(D + 2) * n + i];
                }
            }
        }
        for v in 0..D + 2 + usize::from(MIXED) {
            let own = &mut out[v * n + i];
            *own = share_of(*own, if v == D + 2 { of_capacity } else { slope[v] }, share);
        }
    }
}

/// Brings what stands beyond the jumps of cell `i`, none of them sudden, to its duct, in `three`, as far as each `acts`. Tells how far the slope there stays: not
/// where a stream chokes.
// Called, not inlined: each limiter would hold its own.
#[inline(never)]
fn beyond_jumps<R: Real, const D: usize, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    cells: &RowBeside<'_, R>,
    three: &mut CellValues<R>,
    (ducts, d, i): (&Ducts<'_, R>, usize, usize),
    [gentle, acts]: [[R; 2]; 2],
) -> R {
    let mut stays = R::ONE;
    for side in (0..2).filter(|&side| acts[side] > R::ZERO) {
        let gas = if MIXED {
            let (below, _, above) = cells.values(D + 2);
            ThroatGas::new(Gas::Ideal { gamma: mixed::gamma_of([below[i], above[i]][side]) })
        } else {
            slab.throat
        };
        let passes = bring_to_duct::<R, D>(three, ducts.beside(i, side == 1), (d, side, acts[side]), &gas);
        stays = R::smaller(stays, share_of(R::ONE, if passes { gentle[side] } else { R::ZERO }, acts[side]));
    }
    stays
}

/// Whether cell `i` of the row from `at` on stands at a side of axis `d` that is a `wall` boundary.
fn is_beside_wall<R: Real, const D: usize>(
    slab: &Slab<'_, R, D>,
    d: usize,
    (mut at, i): ([usize; D], usize),
    high: bool,
) -> bool {
    at[0] += i;
    let last = if high { slab.problem.mesh.cells()[d] - 1 } else { 0 };
    at[d] == last && slab.problem.side(d, high, at).is_wall()
}

/// Puts in the place of the values on one side of a cell those that the same stream has in a duct of this cell's area, as far as the jump there `acts`.
/// `ducts` are the areas on both sides of it. Tells whether the stream passes without choking.
fn bring_to_duct<R: Real, const D: usize>(
    three: &mut CellValues<R>,
    ducts: (R, R),
    (d, side, acts): (usize, usize, R),
    gas: &ThroatGas<R>,
) -> bool {
    let place = 2 * side;
    let (from, to) = if side == 0 { ducts } else { (ducts.1, ducts.0) };
    // Its velocity across stays as it is.
    let mut velocity = [R::ZERO; D];
    velocity[0] = three[1 + d][place];
    let at = gas.carry(&Primitive { density: three[0][place], velocity, pressure: three[D + 1][place] }, from, to);
    for (v, brought) in [(0, at.state.density), (1 + d, at.state.velocity[0]), (D + 1, at.state.pressure)] {
        three[v][place] = share_of(three[v][place], brought, acts);
    }
    !(at.passing < from)
}

/// How far the slopes along axis `d` of cell `i` of the row from `at` on fall to those of a contraction, beside its low and its high face, as far as they
/// break: as the gas passes, at the border of a porous body all the way. 1 beside a face that is no break. And whether there is such a border.
fn flatness<R: Real, const D: usize>(
    slab: &Slab<'_, R, D>,
    (d, at, i): (usize, [usize; D], usize),
    sides: &[AtFaces<'_, R, D>; 2],
    breaks: [bool; 2],
) -> ([R; 2], [bool; 2]) {
    let shares = contractions_at(sides, i, breaks);
    let on_border = [0, 1].map(|side| breaks[side] && border_at(slab, (d, at, i), side));
    let at = |side: usize| if on_border[side] { R::ONE } else { shares[side] };
    ([at(0), at(1)], on_border)
}

/// Slopes along axis `d` of all variables in cell `i` of a row with a wall on its low side, its high side, or both, where it meets
/// its mirror image. `three` are the values below, here and above.
fn slope_at_walls<R: Real, const D: usize>(
    d: usize,
    walls: [bool; 2],
    mut three: CellValues<R>,
    i: usize,
    slopes: &CellSlopes<'_, R>,
) -> [R; MOST] {
    let image = |wall: bool, own: R, mirrored: R| if wall { mirrored } else { own };
    for (v, [below, here, above]) in three[..D + 2].iter_mut().enumerate() {
        let mirrored = if v == 1 + d { -*here } else { *here };
        *below = image(walls[0], *below, mirrored);
        *above = image(walls[1], *above, mirrored);
    }
    let ((a, b), weights) = (slopes.axis.scale(i), slopes.axis.half_weight(i));
    let single = Single {
        scale: (image(walls[0], a, R::ONE), image(walls[1], b, R::ONE)),
        half_weight: weights.map(|[low, high]| {
            let free = [R::ZERO; 2];
            [if walls[0] { free } else { low }, if walls[1] { free } else { high }]
        }),
    };
    let mut slope = (slopes.limit)(&three, &single, slopes.compliance.map(|c| &c[i..=i]));
    slope[1 + d] = match walls {
        [false, false] => slope[1 + d],
        [true, true] => R::ZERO,
        [low, _] => {
            let (velocity, away) = (three[1 + d], if low { single.scale.1 } else { single.scale.0 });
            let [below, here, above] = velocity;
            wall_slope(here, R::smaller(away, R::ONE) * if low { above - here } else { here - below }, !low)
        }
    };
    slope
}

/// Slopes of the velocity along `d` in the cells of a row beside a `wall` boundary of that axis.
pub(in crate::flow) fn slopes_at_boundaries<'a, R: Real, const D: usize>(
    slab: &Slab<'_, R, D>,
    d: usize,
    row: RowAt<D>,
    (below, here, above): Three<'a, R>,
    axis: &impl Differences<R>,
    out: &mut [R],
) {
    let n = slab.size.n;
    let cells = slab.problem.mesh.cells()[d];
    let out = &mut out[(1 + d) * n..][..n];
    let beside = |side: usize| if side == 0 { 0 } else { cells - 1 };
    for side in [0, 1] {
        let range = match d {
            0 => beside(side)..beside(side) + 1,
            _ if row.at[d] == beside(side) => 0..n,
            _ => 0..0,
        };
        for i in range {
            let mut at = row.at;
            at[0] = i;
            let walls = [false, true].map(|high| slab.problem.side(d, high, at).is_wall());
            if !walls[side] {
                continue;
            }
            let (a, b) = axis.scale(i);
            let [a, b] = [a, b].map(|scale| R::smaller(scale, R::ONE));
            let away = if side == 0 { b * (above[i] - here[i]) } else { a * (here[i] - below[i]) };
            let alone = cells == 1 && walls == [true; 2];
            out[i] = if alone { R::ZERO } else { wall_slope(here[i], away, side == 1) };
        }
    }
}
