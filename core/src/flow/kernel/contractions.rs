//! How far the gas of each cell in the window passes the contraction that the cell is, 1, or flows along its walls, 0
//! ([`Medium::contraction`](crate::flow::porosity::fractions::Medium::contraction)).
//!
//! It follows from the old state, and all faces of a cell ask for it: it is found once, when the row comes into the window.
//!
//! And how far a jump face acts as one: the throat map is for slow gas, which any other flux would take for sound. Gas that is about to choke, shocks, and the
//! border of two gases need no map in a duct that narrows gently, and are hurt by it: a throat chokes at once, where a duct lets waves run upstream. There such a face acts as any other.

use crate::flow::kernel::mixed;
use crate::flow::kernel::slab::{Place, Slab, beside};
use crate::flow::porosity::areas::Ducts;
use crate::flow::porosity::flags::{BREAKS, marked};
use crate::number::real::Real;

/// What the window holds of them and of the states of the cells, each row with one place more at both ends.
#[derive(Clone, Copy)]
pub(in crate::flow) struct Contractions<'w, R> {
    shares: &'w [R],
    states: &'w [R],
    padded: usize,
    /// Ratio of specific heats; none where each cell has its own.
    gamma: Option<R>,
}

impl<'w, R: Real> Contractions<'w, R> {
    /// Of a window of shares, in one dimension an empty one, and of one of states.
    pub fn new<const D: usize>(slab: &Slab<'_, R, D>, shares: &'w [R], states: &'w [R]) -> Self {
        let gas = slab.problem.gas;
        Contractions { shares, states, padded: slab.size.padded, gamma: (!gas.is_mixed()).then(|| gas.gamma()) }
    }

    /// Of a row, from the cell before its first one on, or from a later place.
    fn of_row<const D: usize>(&self, slab: &Slab<'_, R, D>, (l, j): Place, from: usize) -> OfRow<'w, R> {
        // A line has no walls askew: nothing is compiled for it.
        let shares =
            if D == 1 { &[] } else { self.shares.get(slab.slot(l, j) * self.padded + from..).unwrap_or_default() };
        OfRow { shares, states: self.states.get(slab.block(l, j).start + from..).unwrap_or_default() }
    }

    /// Beside the low faces, along axis `d`, of the cells of a row, and of the cell after them if the row runs along `d`.
    pub fn at_faces<const D: usize>(&self, slab: &Slab<'_, R, D>, d: usize, place: Place) -> AtFaces<'w, R, D> {
        let (before, from) = if d == 0 { (place, 0) } else { (beside::<D>(place, d, -1), 1) };
        let beside = [self.of_row(slab, before, from), self.of_row(slab, place, 1)];
        AtFaces { beside, d, padded: self.padded, gamma: self.gamma }
    }

    /// The same for the low and for the high faces of the cells of a row.
    pub fn at_sides<const D: usize>(&self, slab: &Slab<'_, R, D>, d: usize, place: Place) -> [AtFaces<'w, R, D>; 2] {
        let (after, from) = if d == 0 { (place, 2) } else { (beside::<D>(place, d, 1), 1) };
        let high = [self.of_row(slab, place, 1), self.of_row(slab, after, from)];
        let low = self.at_faces(slab, d, place);
        [low, AtFaces { beside: high, ..low }]
    }
}

/// Those of a row of cells, from some place on.
#[derive(Clone, Copy)]
struct OfRow<'w, R> {
    shares: &'w [R],
    states: &'w [R],
}

/// Those of the cells below and above each face of a row along axis `d`.
#[derive(Clone, Copy)]
pub(in crate::flow) struct AtFaces<'w, R, const D: usize> {
    beside: [OfRow<'w, R>; 2],
    d: usize,
    padded: usize,
    gamma: Option<R>,
}

impl<R: Real, const D: usize> AtFaces<'_, R, D> {
    /// How far the gas passes a face as a contraction, 1, or flows along the walls of a cell beside it, 0.
    #[inline(always)]
    pub fn of(&self, face: usize) -> R {
        if D == 1 {
            return R::ONE;
        }
        let [below, above] = self.beside.map(|row| row.shares.get(face).copied().unwrap_or(R::ONE));
        R::smaller(below, above)
    }

    /// How far a jump face acts as one: 1, or 0 where it acts as any other face. As far as it is `gentle` it falls to 0 where gas is fast, a shock stands, or two gases meet.
    #[inline(always)]
    pub fn jump_share(&self, face: usize, gentle: R) -> R {
        if gentle > R::ZERO { R::ONE - gentle * self.needs_no_throat(face) } else { R::ONE }
    }

    /// How far the gas beside a face is fast, has a shock in it, or is two gases: there a duct without jumps loses nothing, and a throat may choke.
    // Called, not inlined: all that asks for it would hold its own.
    #[inline(never)]
    fn needs_no_throat(&self, face: usize) -> R {
        let [below, above] = self.beside.map(|row| {
            let value = |v: usize| row.states.get(v * self.padded + face).copied().unwrap_or(R::ONE);
            let (velocity, pressure) = (value(1 + self.d), value(D + 1));
            let gamma = self.gamma.unwrap_or_else(|| mixed::gamma_of(value(D + 2)));
            let speed = value(0) * (velocity * velocity) / pressure;
            let square = speed / gamma;
            // To the fourth order of the Mach number.
            let total = pressure * (R::ONE + R::HALF * speed * (R::ONE + R::from_f64(0.25) * square));
            BesideFace { square, pressure, total, gamma }
        });
        let fast = rise(R::larger(below.square, above.square), FAST);
        // A steady stream has one total pressure.
        let shock = rise((below.total - above.total).abs() / R::smaller(below.pressure, above.pressure), SHOCK);
        let gases = rise((below.gamma - above.gamma).abs(), TWO_GASES);
        R::larger(fast, R::larger(shock, gases))
    }
}

/// The gas on one side of a face.
struct BesideFace<R> {
    /// Square of the Mach number through the face.
    square: R,
    pressure: R,
    /// Total pressure.
    total: R,
    gamma: R,
}

/// Squares of Mach numbers between which gas becomes fast: 0.55 and 0.84. Over half of that range, a stream that chokes never settles.
const FAST: [f64; 2] = [0.3, 0.7];

/// Differences of the total pressures of two cells with a shock between them, in units of the lower static one.
const SHOCK: [f64; 2] = [0.02, 0.05];

/// Differences of the ratios of specific heats of two cells that hold two gases.
const TWO_GASES: [f64; 2] = [0.0005, 0.002];

/// From 0 to 1 as a value goes from `none` to `full`.
#[inline(always)]
fn rise<R: Real>(value: R, [none, full]: [f64; 2]) -> R {
    let share = (value - R::from_f64(none)) * R::from_f64(1.0 / (full - none));
    R::smaller(R::larger(share, R::ZERO), R::ONE)
}

/// Of the low and of the high face of cell `i` of a row, as far as they break; else 1.
#[inline(always)]
pub(in crate::flow) fn contractions_at<R: Real, const D: usize>(
    sides: &[AtFaces<'_, R, D>; 2],
    i: usize,
    breaks: [bool; 2],
) -> [R; 2] {
    // Not by a function of arrays, which would be called.
    let at = |side: usize| if breaks[side] { sides[side].of(i) } else { R::ONE };
    [at(0), at(1)]
}

/// Whether the low (0) or high (1) face of cell `i` of the row from `at` on is at the border of a porous body askew to the grid.
pub(in crate::flow) fn border_at<R: Real, const D: usize>(
    slab: &Slab<'_, R, D>,
    (d, at, i): (usize, [usize; D], usize),
    side: usize,
) -> bool {
    let mut face = at;
    face[0] += i;
    face[d] += side;
    slab.has_border(d, face)
}

/// How far the low and the high face of cell `i` of the row from `at` on, as far as they break, have the duct's own area over the half step: at a wall as
/// [`contractions_at`] tells, at a jump as far as it also acts as one, as those at a border always do.
#[inline(always)]
pub(in crate::flow) fn sections_at<R: Real, const D: usize>(
    slab: &Slab<'_, R, D>,
    (d, at, i): (usize, [usize; D], usize),
    (ducts, sides): (&Ducts<'_, R>, &[AtFaces<'_, R, D>; 2]),
    breaks: [bool; 2],
) -> [R; 2] {
    let contractions = contractions_at(sides, i, breaks);
    let section = |side: usize| {
        let high = side == 1;
        if !(breaks[side] & (ducts.opening(i, high) > R::ZERO)) {
            return contractions[side];
        }
        let gentle = ducts.gentleness(i, high);
        let fades = gentle > R::ZERO && !border_at(slab, (d, at, i), side);
        contractions[side] * if fades { sides[side].jump_share(i, gentle) } else { R::ONE }
    };
    [section(0), section(1)]
}

/// Finds them for the row of cells from `at` on, which comes into the window at a place; `outside` the domain stands no wall.
// Called, not inlined: each kind of step would hold its own.
#[inline(never)]
pub(in crate::flow) fn load_contractions<R: Real, const D: usize>(
    slab: &Slab<'_, R, D>,
    at: [usize; D],
    outside: bool,
    row: &mut [R],
) {
    let Some(medium) = slab.medium.as_ref().filter(|_| D > 1) else { return };
    row.fill(R::ONE);
    if outside {
        return;
    }
    let (n, start) = (slab.size.n, slab.problem.mesh.index(at));
    for i in marked(&medium.porosity.marks[start..][..n], BREAKS) {
        let mut cell = at;
        cell[0] += i;
        row[1 + i] = medium.contraction(cell, slab.old.momentum.map(|m| m[start + i]));
    }
    if slab.periodic[0] {
        (row[0], row[n + 1]) = (row[n], row[1]);
    }
}
