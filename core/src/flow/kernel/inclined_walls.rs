//! Gas in the cells that an inclined wall cuts, at the half step.
//!
//! The gas slips along the wall, and meets its mirror image there: as at a wall that is aligned with the grid, but for a wall inside the cell. Between
//! walls that push with the pressure of the cell alone, a shock that passes drives the gas into the wall and out again, and single cells behind it are too fast.
//!
//! In smooth flow the velocity of a cell's middle is none at its wall: what rises away from the wall is left as it is, and where the pressure hardly changes from
//! cell to cell nothing is done. Slow gas that runs round a body would lose its momentum across the wall by the speed of sound.
//!
//! Gas that leaves the wall fast goes on as it went. Held at the wall while the momentum of its cell leads away from it, its fluxes would not carry that out of the cell, and
//! the pressure there would be spent on it: behind the shoulder of a round body in a burst of 100 bar cells had a hundredth of the least p/ρ^γ that there can be.
//!
//! A wall that cuts off no more than a corner of a cell meets little of its gas, and the border of a porous layer lets most of it pass: slipping as a whole, it would be turned
//! without a wall that takes its momentum, and cells beside the corner of a body would become jets.

use crate::flow::boundary::Boundary;
use crate::flow::face_gas::FaceGas;
use crate::flow::kernel::rows;
use crate::flow::kernel::shocks::{PASSED, Pressures, any_jump, jumps_along, passed};
use crate::flow::kernel::slab::{Place, RowAt, Slab, beside};
use crate::flow::porosity::flags::{INCLINED, any_inclined, is};
use crate::flow::porosity::fractions::Medium;
use crate::flow::problem::PressureForm;
use crate::flow::riemann::Slowness;
use crate::flow::state::{Gas, Primitive, dot, sum};
use crate::number::real::Real;

/// Corrects the half-step states `half` of the cells of a row that an inclined wall cuts and a shock passes. `strength` is scratch of a row.
// Called, not inlined: few rows have any.
#[inline(never)]
pub(in crate::flow) fn slip_along_walls<R: Real, const D: usize, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    row: RowAt<D>,
    place: Place,
    seen: Pressures<'_, R>,
    strength: &mut [R],
    half: &mut [R],
) {
    // A line has no inclined walls: nothing is compiled for it.
    let Some(medium) = slab.medium.as_ref().filter(|_| D > 1) else { return };
    let n = slab.size.n;
    let marks = &medium.porosity.marks[row.start..][..n];
    let cells = (place, row.at);
    // The paper's form has no pressure on walls inside a cell, which would turn the gas.
    let geometric = slab.problem.scheme.pressure == PressureForm::Geometric;
    let jumps = || any_jump(slab, 0, [None, Some(cells)], seen.ranges, R::from_f64(PASSED[0]));
    if !geometric || !any_inclined(marks) || !jumps() {
        return;
    }
    let last = half.len() - n;
    strength.fill(R::ZERO);
    (0..D).for_each(|e| jumps_along(slab, e, cells, seen.window, strength));
    // Where the caller asks for first order, nothing but that keeps the state physical.
    let asked = |i: usize| slab.first_order.is_some_and(|f| f[row.start + i] != 0);
    for i in (0..n).filter(|&i| is(marks[i], INCLINED) && !asked(i)) {
        let passed = passed(strength[i]);
        if !(passed > R::ZERO) {
            continue;
        }
        let mut at = row.at;
        at[0] += i;
        let (normal, reached) = normal_to_wall(medium, at);
        let share = passed * reached * left_at_wall(slab, normal, (place, i), seen.window);
        if !(share > R::ZERO) {
            continue;
        }
        let mut w = rows::face_state(half, n, i);
        let into = -dot(normal, w.velocity);
        let gas = slab.gas_of::<MIXED>(half, (D + 2) * n + i);
        let share = if into < R::ZERO { share * held(-into / gas.sound_speed(&w)) } else { share };
        for d in 0..D {
            half[(1 + d) * n + i] += share * into * normal[d];
        }
        w.velocity = core::array::from_fn(|d| if d == 0 { into } else { R::ZERO });
        half[last + i] += share * (pressure_at_wall::<R, D, MIXED>(slab, gas, &w) - w.pressure);
    }
}

/// Mach numbers across a wall up to which gas that leaves it is held there, and from which on it is not.
const HELD: [f64; 2] = [0.25, 0.5];

/// Share of the velocity away from a wall that is held there.
fn held<R: Real>(mach: R) -> R {
    let [all, none] = HELD.map(R::from_f64);
    R::smaller(R::larger((none - mach) / (none - all), R::ZERO), R::ONE)
}

/// Pressure at a wall that gas flows into with the first component of its velocity, by the Riemann problem with its mirror image.
fn pressure_at_wall<R: Real, const D: usize, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    gas: Gas<R>,
    w: &Primitive<R, D>,
) -> R {
    let image = Boundary::Wall.ghost_face(w, 0, false, gas);
    let plain = Slowness { bend: R::ZERO, pace: R::INFINITY };
    (slab.solver.wall)([w, &image], &if MIXED { FaceGas::new(gas) } else { slab.face_gas }, plain)
}

/// A wall of the width of the gas of its cell over this number meets all of it. With 1, shocks along walls overshoot by 3.01 % in `turned_tube`, with this number by less than 3.
const MET: f64 = 1.25;

/// Unit vector normal to the wall in a cell, into the gas, and how much of the gas the wall meets: its width over that of the gas, times
/// [`MET`], at most 1.
fn normal_to_wall<R: Real, const D: usize>(medium: &Medium<'_, R, D>, at: [usize; D]) -> ([R; D], R) {
    let widths: [R; D] = core::array::from_fn(|d| medium.mesh.widths[d][at[d]]);
    let area: [R; D] = core::array::from_fn(|d| {
        let [low, high] = medium.mesh.faces_of(d, at).map(|f| medium.porosity.faces[d][f]);
        (high - low) / widths[d]
    });
    let length = dot(area, area).sqrt();
    let normal = area.map(|a| a / length);
    // Of a section of the whole cell across the normal.
    let section: [R; D] = core::array::from_fn(|d| normal[d] / widths[d]);
    let open = medium.porosity.volume[medium.mesh.index(at)];
    let width = length / (dot(section, section).sqrt() * open);
    (normal, R::smaller(R::from_f64(MET) * width, R::ONE))
}

/// Which share of the velocity into a wall, in the middle of cell `i` of the row at a place, is left at the wall: what rises to the neighbours away from the wall
/// falls as fast towards it, as [`wall_slope`](crate::flow::limiter::wall_slope) has it.
fn left_at_wall<R: Real, const D: usize>(
    slab: &Slab<'_, R, D>,
    normal: [R; D],
    (place, i): (Place, usize),
    window: &[R],
) -> R {
    let padded = slab.size.padded;
    let into = |place: Place, i: usize| {
        -dot(normal, rows::face_state(&window[slab.block(place.0, place.1)], padded, i).velocity)
    };
    let here = into(place, i + 1);
    let rises = sum::<R, D>(core::array::from_fn(|e| {
        let up = normal[e] > R::ZERO;
        let beyond = match e {
            0 => into(place, if up { i + 2 } else { i }),
            _ => into(beside::<D>(place, e, if up { 1 } else { -1 }), i + 1),
        };
        normal[e] * normal[e] * (beyond - here)
    }));
    if !(here.abs() > R::ZERO) {
        return R::ZERO;
    }
    let rises = if here > R::ZERO { rises } else { -rises };
    R::ONE - R::smaller(R::larger(rises, R::ZERO) / here.abs(), R::ONE)
}
