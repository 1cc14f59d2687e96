//! Where a row of cells breaks: walls (closed faces) and porosity jumps. Slopes beside them, and the fluxes there.
//!
//! A wall is treated as a `wall` boundary of the domain is, to the bit: the gas beside it meets its mirror image, in the slopes
//! and in the Riemann problem. Without the mirror the velocity at the wall would be that of the cell's middle, and a slow flow
//! would stagnate at a pressure wrong by rho c u. At a jump both cells are flat along the axis and the throat map acts.

use crate::flow::boundary::Boundary;
use crate::flow::face_gas::{FaceGas, MixedFace};
use crate::flow::kernel::contractions::{AtFaces, Contractions, contractions_at};
use crate::flow::kernel::row_slopes::{self, Differences, HalfWeights, RowBeside, Three};
use crate::flow::kernel::rows::{self, FluxBlock, var};
use crate::flow::kernel::slab::{Place, RowAt, Slab, place_of, tightened};
use crate::flow::limiter::{Slope, wall_slope};
use crate::flow::porosity::areas::{Ducts, share};
use crate::flow::porosity::cell_walls::Border;
use crate::flow::porosity::flags::{any_marked, break_high, break_low, marked};
use crate::flow::porosity::fractions::Medium;
use crate::flow::porosity::jump::{JumpFaces, JumpFlux, jump_fluxes, mixed_jump_fluxes};
use crate::flow::porosity::oblique_jump::ObliqueJump;
use crate::flow::porosity::throat::{ThroatGas, throat_area};
use crate::flow::problem::PressureForm;
use crate::flow::riemann::Slowness;
use crate::flow::state::{Primitive, dot};
use crate::number::real::Real;

/// Jump faces of one group, whose fluxes are found side by side. The number changes no result.
const LANES: usize = 4;

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
/// from beyond it: at a wall that value is mirrored, at a jump the slope is 0. Where gas flows along an inclined wall the correction fades out.
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
        let breaks = [ducts.breaks(i, false), ducts.breaks(i, true)];
        let [a, b] = flatness(slab, (d, row.at, i), &sides, breaks);
        let share = if breaks == [true; 2] { R::larger(a, b) } else { R::smaller(a, b) };
        let mut blend = |v: usize, slope: R| {
            let own = &mut out[v * n + i];
            *own = if share >= R::ONE { slope } else { *own + share * (slope - *own) };
        };
        if MIXED {
            // Flat at a jump; beside a wall, where a capacity meets itself, a limited slope is.
            blend(D + 2, R::ZERO);
        }
        if (breaks[0] & (low > R::ZERO)) | (breaks[1] & (high > R::ZERO)) {
            (0..D + 2).for_each(|v| blend(v, R::ZERO));
            continue;
        }
        let mut three = [[R::ZERO; 3]; MOST];
        for (v, three) in three[..D + 2].iter_mut().enumerate() {
            let (below, here, above) = cells.values(v);
            *three = [below[i], here[i], above[i]];
        }
        let slope = slope_at_walls::<R, D>(d, breaks, three, i, slopes);
        (0..D + 2).for_each(|v| blend(v, slope[v]));
    }
}

/// How far the slopes along axis `d` of cell `i` of the row from `at` on fall to those of a contraction, beside its low and its high face, as far as they
/// break: as the gas passes, at the border of a porous body all the way. 1 beside a face that is no break.
fn flatness<R: Real, const D: usize>(
    slab: &Slab<'_, R, D>,
    (d, at, i): (usize, [usize; D], usize),
    sides: &[AtFaces<'_, R, D>; 2],
    breaks: [bool; 2],
) -> [R; 2] {
    let shares = contractions_at(sides, i, breaks);
    core::array::from_fn(|side| {
        let mut face = at;
        face[0] += i;
        face[d] += side;
        let on_border = shares[side] < R::ONE && slab.has_border(d, face);
        if on_border { R::ONE } else { shares[side] }
    })
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

/// Replaces the fluxes at the broken faces of a row along or across axis `d`, by their places; `at` names the first of them. `states`
/// are those on the left and on the right.
pub(in crate::flow) fn fluxes_at_breaks<R: Real, const D: usize, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    (d, at): (usize, [usize; D]),
    contractions: Contractions<'_, R>,
    broken: impl Iterator<Item = usize>,
    states: [&[R]; 2],
    mut flux: FluxBlock<'_, R>,
) {
    let Some(medium) = &slab.medium else { return };
    let ducts = medium.ducts(d, at);
    let contractions = contractions.at_faces(slab, d, place_of(at));
    let row = BrokenRow { slab, medium, ducts, contractions, d, at, states };
    let mut group = [0; LANES];
    let mut count = 0;
    for i in broken {
        let border = row.border(i);
        if !(row.ducts.face(i) > R::ZERO) {
            wall_flux::<R, D, MIXED>(&row, i, border, &mut flux);
            continue;
        }
        if let Some(border) = border {
            oblique_jump::<R, D>(&row, i, &border, &mut flux);
            continue;
        }
        group[count] = i;
        count += 1;
        if count == LANES {
            jump_group::<R, D, MIXED>(&row, &group, count, &mut flux);
            count = 0;
        }
    }
    if count > 0 {
        // A last group of fewer faces repeats its first one.
        let first = group[0];
        group[count..].fill(first);
        jump_group::<R, D, MIXED>(&row, &group, count, &mut flux);
    }
}

/// A row of faces of axis `d`, some of them broken.
struct BrokenRow<'s, R, const D: usize> {
    slab: &'s Slab<'s, R, D>,
    medium: &'s Medium<'s, R, D>,
    ducts: Ducts<'s, R>,
    contractions: AtFaces<'s, R, D>,
    d: usize,
    /// Of the cell above the first face.
    at: [usize; D],
    /// Face states on the left and on the right.
    states: [&'s [R]; 2],
}

impl<R: Real, const D: usize> BrokenRow<'_, R, D> {
    /// The cells below and above a face.
    fn beside(&self, i: usize) -> [Option<[usize; D]>; 2] {
        let mut face = self.at;
        face[0] = i;
        self.medium.mesh.beside(self.d, face, self.slab.periodic[self.d])
    }

    /// The pace of the gas of a cell beside a face that is closed over an area.
    fn pace(&self, side: usize, i: usize, area: R) -> R {
        let Some(cell) = self.beside(i)[side] else { return R::ZERO };
        let volume = self.medium.porosity.volume[self.medium.mesh.index(cell)];
        tightened(self.slab.dt / self.medium.mesh.widths[self.d][cell[self.d]], area, volume, volume)
    }

    /// The border askew to the grid beside a face.
    fn border(&self, i: usize) -> Option<Border<R, D>> {
        let mut face = self.at;
        face[0] = i;
        self.slab.border(self.d, face)
    }

    /// Weight of weak waves at a face: 0 beside a cell where a step went wrong.
    fn acoustic_weight(&self, i: usize) -> R {
        let Some(asked) = self.slab.first_order else { return R::ONE };
        let troubled = self.beside(i).iter().flatten().any(|&c| asked[self.slab.problem.mesh.index(c)] != 0);
        if troubled { R::ZERO } else { R::ONE }
    }
}

/// Fluxes at the first `count` jump faces of a group.
fn jump_group<R: Real, const D: usize, const MIXED: bool>(
    row: &BrokenRow<'_, R, D>,
    group: &[usize; LANES],
    count: usize,
    flux: &mut FluxBlock<'_, R>,
) {
    let slab = row.slab;
    let gather = |s: usize, v: usize| {
        let values = var(row.states[s], v, flux.n);
        core::array::from_fn(|l| values[group[l]])
    };
    let side = |s: usize| Primitive {
        density: gather(s, 0),
        velocity: core::array::from_fn(|c| gather(s, 1 + c)),
        pressure: gather(s, D + 1),
    };
    let states = [side(0), side(1)];
    let capacities = [0, 1].map(|s| if MIXED { gather(s, D + 3) } else { [R::ZERO; LANES] });
    let (mut throat, mut areas) = ([R::ZERO; LANES], [[R::ZERO; LANES]; 2]);
    for l in 0..LANES {
        let (face, contraction) = (row.ducts.face(group[l]), row.contractions.of(group[l]));
        let (left, right) = row.ducts.beside(group[l], false);
        areas[0][l] = share(face, left, contraction);
        areas[1][l] = share(face, right, contraction);
        let machs = [0, 1].map(|s| {
            let gas = if MIXED { FaceGas::of_capacity(capacities[s][l]) } else { slab.face_gas };
            let w = states[s].lane(l);
            w.velocity[0] / gas.sound_speed(&w)
        });
        let pinched = nearly_chokes(machs, [areas[0][l], areas[1][l]]) && row.ducts.pinched(group[l]);
        throat[l] = throat_area(areas[0][l], face, areas[1][l], pinched);
    }
    let acoustic_weight = group.map(|i| row.acoustic_weight(i));
    let faces =
        JumpFaces { states, ducts: areas, throat, references: [gather(0, D + 2), gather(1, D + 2)], acoustic_weight };
    let tell = |l: usize, f: JumpFlux<R, D>| {
        let mut put = |v: usize, value: R| flux.values[v * flux.n + group[l]] = value;
        put(0, f.mass);
        put(1, f.normal[0]);
        for c in 1..D {
            put(1 + c, f.momentum[c]);
            put(apart(c, D, MIXED), f.momentum[c]);
        }
        put(D + 1, f.energy);
        put(D + 2, f.normal[1]);
        if MIXED {
            (0..2).for_each(|v| put(D + 3 + v, f.carried[v]));
        }
    };
    if MIXED {
        mixed_jump_fluxes((&faces, count), &capacities, slab.solver.throat, tell);
    } else {
        jump_fluxes((&faces, count), &slab.face_gas, [&slab.throat; 2], slab.solver.throat, tell);
    }
}

/// Place in a flux block, at a broken face, of the tangential momentum `c`, from 1 on, that the cell on the right gains.
pub(in crate::flow) const fn apart(c: usize, dimensions: usize, mixed: bool) -> usize {
    dimensions + 2 + c + if mixed { 2 } else { 0 }
}

/// The changes `out` of the tangential momentum of the cells of a row whose low faces along axis `d` break: what they gain there is not what those below lose.
/// `low` and `high` give a variable of the flux block at the cells' faces.
// Called, not inlined: each kind of step would hold its own.
#[inline(never)]
pub(in crate::flow) fn changes_apart<R: Real, const D: usize>(
    slab: &Slab<'_, R, D>,
    (d, row): (usize, RowAt<D>),
    [low, high]: [(&[R], usize); 2],
    inv_width: &dyn Fn(usize) -> R,
    out: &mut [R],
) {
    let Some(medium) = slab.medium.as_ref().filter(|_| D > 1) else { return };
    let (n, mixed) = (slab.size.n, slab.problem.gas.is_mixed());
    for i in marked(&medium.porosity.marks[row.start..][..n], break_low(d)) {
        for c in 1..D {
            let v = 1 + (c + d) % D;
            let gained = var(low.0, apart(c, D, mixed), low.1)[i];
            let lost = var(high.0, 1 + c, high.1)[i + usize::from(d == 0)];
            out[v * n + i] = (lost - gained) * inv_width(i);
        }
    }
}

/// Flux at the jump face `i` of a row, across a border askew to the grid.
// Called, not inlined, and the same for one gas and for two: there are few such faces.
#[inline(never)]
fn oblique_jump<R: Real, const D: usize>(
    row: &BrokenRow<'_, R, D>,
    i: usize,
    border: &Border<R, D>,
    flux: &mut FluxBlock<'_, R>,
) {
    let (slab, n, mixed) = (row.slab, flux.n, row.slab.problem.gas.is_mixed());
    let [left, right] = row.states;
    let states = [rows::face_state::<R, D>(left, n, i), rows::face_state::<R, D>(right, n, i)];
    let gas = |s: &[R]| if mixed { slab.gas_of::<true>(s, (D + 3) * n + i) } else { slab.problem.gas };
    let gases = [gas(left), gas(right)];
    let (low, high) = row.ducts.beside(i, false);
    let ducts = [border.ducts[0].unwrap_or(low), border.ducts[1].unwrap_or(high)];
    let mach = |s: usize| dot(border.normal, states[s].velocity) / FaceGas::new(gases[s]).sound_speed(&states[s]);
    let open = row.ducts.face(i);
    let pinched = nearly_chokes([mach(0), mach(1)], ducts) && row.ducts.pinched(i);
    let face = ObliqueJump {
        states,
        ducts,
        open,
        throat: throat_area(ducts[0], open, ducts[1], pinched),
        references: [left[(D + 2) * n + i], right[(D + 2) * n + i]],
        acoustic_weight: row.acoustic_weight(i),
        normal: border.normal,
    };
    let throats = [ThroatGas::new(gases[0]), ThroatGas::new(gases[1])];
    let of_face = MixedFace([FaceGas::new(gases[0]), FaceGas::new(gases[1])]);
    let f = face.flux(&of_face, throats.each_ref(), slab.solver.throat);
    let [to_left, to_right] = f.momentum;
    let mut put = |v: usize, value: R| flux.values[v * n + i] = value;
    put(0, f.mass);
    put(D + 1, f.energy);
    put(D + 2, to_right[0]);
    put(1, to_left[0]);
    for c in 1..D {
        put(1 + c, to_left[c]);
        put(apart(c, D, mixed), to_right[c]);
    }
    if mixed {
        (0..2).for_each(|v| put(D + 3 + v, f.carried[v]));
    }
}

/// Of what chokes in a duct, the share from which on a stream is led through its true area: below that a wider throat passes as much.
const NEARLY: f64 = 0.8;

/// Does a stream that enters the narrower of two ducts carry nearly what chokes there? By the Mach numbers beside the face, positive to the right. A stream
/// that leaves it has been choked where it entered, and may go on faster than sound.
fn nearly_chokes<R: Real>(machs: [R; 2], ducts: [R; 2]) -> bool {
    let upstream = usize::from(machs[0] + machs[1] < R::ZERO);
    let mach = machs[upstream].abs();
    // What passes a duct at a Mach number over what chokes in it, for any gas within a few per cent.
    let share = mach * (R::from_f64(1.65) - R::from_f64(0.65) * mach * mach);
    let [wide, narrow] = [ducts[upstream], ducts[1 - upstream]];
    wide > narrow && (mach >= R::ONE || wide * share > R::from_f64(NEARLY) * narrow)
}

/// Flux at the closed face `i` of a row: nothing passes, and each side is pushed by its mirror image; where what is closed is askew to the grid, along its
/// `border`'s normal.
fn wall_flux<R: Real, const D: usize, const MIXED: bool>(
    row: &BrokenRow<'_, R, D>,
    i: usize,
    border: Option<Border<R, D>>,
    flux: &mut FluxBlock<'_, R>,
) {
    let (problem, medium, d, m) = (row.slab.problem, row.medium, row.d, flux.n);
    let beside = row.beside(i);
    let push = |side: usize| {
        let area = beside[side].map_or(R::ZERO, |cell| match problem.scheme.pressure {
            PressureForm::Geometric => medium.ducts(d, cell).wall(0),
            PressureForm::Paper => medium.porosity.volume[medium.mesh.index(cell)],
        });
        if !(area > R::ZERO) {
            return R::ZERO;
        }
        let mut w = rows::face_state(row.states[side], m, i);
        if let Some(Border { normal, .. }) = border {
            let through = dot(normal, w.velocity);
            w.velocity = core::array::from_fn(|c| if c == 0 { through } else { R::ZERO });
        }
        let gas = row.slab.gas_of::<MIXED>(row.states[side], (D + 3) * m + i);
        let image = Boundary::Wall.ghost_face(&w, d, side == 1, gas);
        let pair: [&Primitive<R, D>; 2] = if side == 0 { [&w, &image] } else { [&image, &w] };
        let reference = row.states[side][(D + 2) * m + i];
        let above = w.pressure - reference;
        let slowness = Slowness { bend: above + above, pace: row.pace(side, i, area) };
        let face_gas = if MIXED { FaceGas::new(gas) } else { row.slab.face_gas };
        let momentum = (row.slab.solver.wall)(pair, &face_gas, slowness);
        let share = if border.is_some() { R::ONE } else { row.contractions.of(i) };
        share * area * (momentum - reference)
    };
    let (to_left, to_right) = (push(0), push(1));
    let all = (0..D + 2).chain(D + 3..D + 3 + 2 * usize::from(MIXED));
    for v in all.chain((1..D).map(|c| apart(c, D, MIXED))) {
        flux.values[v * m + i] = R::ZERO;
    }
    let mut along = [R::ZERO; D];
    along[0] = R::ONE;
    let along = border.map_or(along, |Border { normal, .. }| normal.map(|n| normal[0] * n));
    for c in 0..D {
        flux.values[(1 + c) * m + i] = to_left * along[c];
    }
    flux.values[(D + 2) * m + i] = to_right * along[0];
    for c in 1..D {
        flux.values[apart(c, D, MIXED) * m + i] = to_right * along[c];
    }
}
