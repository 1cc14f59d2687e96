//! Fluxes through the faces that lie along a strong shock.
//!
//! A solver that keeps shear and contacts lets a strong shock wander where it lies along the grid: what differs from cell to cell along the shock is
//! not damped there, and grows (the carbuncle: J. J. Quirk, Int. J. Numer. Methods Fluids 18 (1994) 555). So a face beside which the pressure jumps along
//! another axis has a share of the flux of HLLE, which damps it. The share grows with that jump, less what jumps at the face itself. Across the shock, and
//! where there is none, the solver asked for stands as it is. The jumps looked at are those of the H-correction (R. Sanders, E. Morano, M.-C. Druguet,
//! J. Comput. Phys. 145 (1998) 511): of the cells on both sides of a face.
//!
//! Beside a cell that an inclined wall cuts, weaker shocks have the same: what differs there along the shock is made anew in every cell, as each is cut in its own way.

use crate::flow::kernel::face_fluxes::Openings;
use crate::flow::kernel::rows::var;
use crate::flow::kernel::slab::{Place, Slab, beside, place_of};
use crate::flow::kernel::solver_calls::RowCall;
use crate::flow::porosity::flags::{INCLINED, any_inclined, is};
use crate::number::real::Real;

/// Jump of pressure from cell to cell, in units of the smaller one, from which on HLLE has a share. Smaller: weaker shocks, which need no damping, and
/// the shear beside them are damped (with half of it, a shock of ratio 3 overshoots by a fifth more at inclined walls). With twice as much, shocks of
/// Mach 3 and more are steady still.
const ONSET: f64 = 1.0;
/// Jump at which HLLE has all of the flux.
const FULL: f64 = 2.0;

/// Jump of pressure from cell to cell, in units of the smaller one, from which on a cell that an inclined wall cuts counts as passed by a shock, and from
/// which on it does so wholly.
pub(in crate::flow) const PASSED: [f64; 2] = [0.03, 0.1];

/// How far a jump of pressure beside an inclined wall is that of a shock: from 0 to 1.
pub(in crate::flow) fn passed<R: Real>(jump: R) -> R {
    let [onset, full] = PASSED.map(R::from_f64);
    R::larger(R::smaller((jump - onset) / (full - onset), R::ONE), R::ZERO)
}

/// Pressures of the rows in the window, and the least and the largest of each row.
#[derive(Clone, Copy)]
pub(in crate::flow) struct Pressures<'w, R> {
    pub window: &'w [R],
    pub ranges: &'w [R],
}

/// Variables of a face state or a flux block at most.
const MOST: usize = 10;

/// A row of cells: its place, and the indices of its first cell in the mesh.
pub(in crate::flow) type CellRow<const D: usize> = (Place, [usize; D]);

/// Gives the faces of a row along or across axis `d` that lie along a strong shock their share of the flux of HLLE; those on sides of the domain, as
/// closed ones, keep theirs. `at` names the cell above the first face, `states` are those on the left and on the right; `strength` is as long as the row of
/// faces.
pub(in crate::flow) fn fluxes_along_shocks<R: Real, const D: usize>(
    slab: &Slab<'_, R, D>,
    (d, at): (usize, [usize; D]),
    seen: Pressures<'_, R>,
    (states, openings): ([&[R]; 2], Openings<'_, R>),
    strength: &mut [R],
    flux: &mut [R],
) {
    let Some(hlle) = slab.solver.along_shocks.filter(|_| D > 1) else { return };
    let here = place_of(at);
    let rows = if d == 0 {
        [None, Some((here, at))]
    } else {
        let [Some(below), Some(above)] = slab.problem.mesh.beside(d, at, slab.periodic[d]) else { return };
        [Some((beside::<D>(here, d, -1), below)), Some((here, above))]
    };
    let walls = Beside::new(slab, rows);
    let onset = if walls.is_some() { PASSED[0] } else { ONSET };
    if !any_jump(slab, d, rows, seen.ranges, R::from_f64(onset)) {
        return;
    }
    let n = slab.size.n;
    strength.fill(R::ZERO);
    for (place, cells) in rows.into_iter().flatten() {
        for e in (0..D).filter(|e| *e != d) {
            jumps_along(slab, e, (place, cells), seen.window, &mut strength[..n]);
        }
    }
    if d == 0 {
        from_cells_to_faces(strength, slab.periodic[0]);
    }
    let m = strength.len();
    let [left, right] = states.map(|s| var(s, D + 1, m));
    for (i, strength) in strength.iter().enumerate().filter(|(_, s)| **s > R::from_f64(onset)) {
        let share = if walls.is_some_and(|w| w.inclined(i, d == 0)) {
            passed(*strength)
        } else if !(*strength > R::from_f64(ONSET)) {
            continue;
        } else {
            // What jumps at the face itself lies across it: beside steps of a ball of gas under pressure HLLE would smear its contact.
            let above = *strength - jump(left[i], right[i]) - R::from_f64(ONSET);
            R::smaller(above / R::from_f64(FULL - ONSET), R::ONE)
        };
        if share > R::ZERO {
            blend_at(slab, (states, openings), (i, m), (hlle, share), flux);
        }
    }
}

/// Marks of the cells below and above the faces of a row, some of which an inclined wall may cut.
#[derive(Clone, Copy)]
struct Beside<'m> {
    below: &'m [u8],
    above: &'m [u8],
}

impl<'m> Beside<'m> {
    /// `None` if no inclined wall cuts any of the cells.
    fn new<R: Real, const D: usize>(slab: &Slab<'m, R, D>, rows: [Option<CellRow<D>>; 2]) -> Option<Self> {
        let medium = slab.medium.as_ref()?;
        let n = slab.size.n;
        let of = |row: CellRow<D>| &medium.porosity.marks[slab.problem.mesh.index(row.1)..][..n];
        let above = of(rows[1]?);
        let below = rows[0].map_or(above, of);
        (any_inclined(below) || any_inclined(above)).then_some(Beside { below, above })
    }

    /// Whether such a wall cuts a cell beside face `i`; the faces stand one behind the other where they are those `along` the row.
    fn inclined(self, i: usize, along: bool) -> bool {
        let marked = |marks: &[u8], i: usize| marks.get(i).is_some_and(|&m| is(m, INCLINED));
        let n = self.below.len();
        // A row closes where its axis is periodic; else the faces at its ends are none of those asked for.
        let (below, above) = match along {
            false => (i, i),
            true => (if i > 0 { i - 1 } else { n - 1 }, if i < n { i } else { 0 }),
        };
        marked(self.below, below) || marked(self.above, above)
    }
}

/// Jump of pressure between two states, in units of the smaller one.
#[inline(always)]
fn jump<R: Real>(a: R, b: R) -> R {
    (a - b).abs() / R::smaller(a, b)
}

/// Turns the values of the cells of a row, followed by one place more, into those of its faces: the larger of both sides, 0 on sides of the domain.
fn from_cells_to_faces<R: Real>(values: &mut [R], periodic: bool) {
    let n = values.len() - 1;
    let seam = if periodic { R::larger(values[0], values[n - 1]) } else { R::ZERO };
    for i in (1..n).rev() {
        values[i] = R::larger(values[i - 1], values[i]);
    }
    (values[0], values[n]) = (seam, seam);
}

/// Whether some rows of cells and those beside them along other axes than `d` hold a jump of pressure that may be above `onset`.
pub(in crate::flow) fn any_jump<R: Real, const D: usize>(
    slab: &Slab<'_, R, D>,
    d: usize,
    rows: [Option<CellRow<D>>; 2],
    ranges: &[R],
    onset: R,
) -> bool {
    let (mut least, mut most) = (R::MAX, R::ZERO);
    let mut widen = |(l, j): Place| {
        let k = 2 * slab.slot(l, j);
        (least, most) = (R::smaller(ranges[k], least), R::larger(ranges[k + 1], most));
    };
    for (place, _) in rows.into_iter().flatten() {
        widen(place);
        for e in (1..D).filter(|e| *e != d) {
            widen(beside::<D>(place, e, -1));
            widen(beside::<D>(place, e, 1));
        }
    }
    // A little less, since the jumps are rounded.
    most - least > R::from_f64(0.99) * onset * least
}

/// Raises `strength` of each cell of a row to its larger jump of pressure along axis `e`, to a cell that it has an open face with.
pub(in crate::flow) fn jumps_along<R: Real, const D: usize>(
    slab: &Slab<'_, R, D>,
    e: usize,
    (place, cells): CellRow<D>,
    window: &[R],
    strength: &mut [R],
) {
    let (n, padded) = (slab.size.n, slab.size.padded);
    let pressures = |(l, j): Place| var(&window[slab.block(l, j)], D + 1, padded);
    let here = pressures(place);
    let (below, above) = if e == 0 {
        (&here[..n], &here[2..])
    } else {
        (&pressures(beside::<D>(place, e, -1))[1..][..n], &pressures(beside::<D>(place, e, 1))[1..][..n])
    };
    let (here, below, above) = (&here[1..][..n], &below[..n], &above[..n]);
    let strength = &mut strength[..n];
    let Some(medium) = &slab.medium else {
        for i in 0..n {
            strength[i] = R::larger(strength[i], R::larger(jump(here[i], below[i]), jump(here[i], above[i])));
        }
        return;
    };
    let faces = medium.porosity.faces[e];
    let [low, high] = medium.mesh.faces_of(e, cells).map(|f| &faces[f..][..n]);
    for i in 0..n {
        // Found in any case, without a branch.
        let through = |open: R, beyond: R| {
            let jump = jump(here[i], beyond);
            if open > R::ZERO { jump } else { R::ZERO }
        };
        strength[i] = R::larger(strength[i], R::larger(through(low[i], below[i]), through(high[i], above[i])));
    }
}

/// Moves the flux at face `i` of a row `m` long to that of another solver by a share.
fn blend_at<R: Real, const D: usize>(
    slab: &Slab<'_, R, D>,
    (states, openings): ([&[R]; 2], Openings<'_, R>),
    (i, m): (usize, usize),
    (solver, share): (RowCall<R>, R),
    flux: &mut [R],
) {
    let variables = slab.size.face;
    let one = |block: &[R]| {
        let mut of = [R::ZERO; MOST];
        (0..variables).for_each(|v| of[v] = block[v * m + i]);
        of
    };
    let [l, r] = states.map(one);
    let mut out = [R::ZERO; MOST];
    solver([&l[..variables], &r[..variables]], openings.one(i), &slab.face_gas, &[R::ZERO], &mut out[..variables]);
    for v in 0..variables {
        let own = &mut flux[v * m + i];
        *own = if share >= R::ONE { out[v] } else { *own + share * (out[v] - *own) };
    }
}
