//! Fluxes where a row of cells breaks: at walls (closed faces) and porosity jumps.
//!
//! A wall is treated as a `wall` boundary of the domain is, to the bit: the gas beside it meets its mirror image. At a jump the throat map acts.

use crate::flow::boundary::Boundary;
use crate::flow::face_gas::{FaceGas, MixedFace};
use crate::flow::kernel::contractions::{AtFaces, Contractions};
use crate::flow::kernel::rows::{self, FluxBlock, var};
use crate::flow::kernel::side_throats::jet_from;
use crate::flow::kernel::slab::{RowAt, Slab, place_of, tightened};
use crate::flow::porosity::areas::{Ducts, share};
use crate::flow::porosity::cell_walls::Border;
use crate::flow::porosity::flags::{break_low, marked};
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
    let (mut group, mut shares) = ([0; LANES], [R::ONE; LANES]);
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
        let acts = row.contractions.jump_share(i, row.ducts.gentleness(i, false));
        if acts == R::ZERO {
            (1..D).for_each(|c| flux.values[apart(c, D, MIXED) * flux.n + i] = flux.values[(1 + c) * flux.n + i]);
            continue;
        }
        (group[count], shares[count]) = (i, acts);
        count += 1;
        if count == LANES {
            jump_group::<R, D, MIXED>(&row, (&group, &shares), count, &mut flux);
            count = 0;
        }
    }
    if count > 0 {
        // A last group of fewer faces repeats its first one.
        let first = group[0];
        group[count..].fill(first);
        jump_group::<R, D, MIXED>(&row, (&group, &shares), count, &mut flux);
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

/// Fluxes at the first `count` jump faces of a group, each as far as it acts as one; the rest is the flux that is there.
fn jump_group<R: Real, const D: usize, const MIXED: bool>(
    row: &BrokenRow<'_, R, D>,
    (group, shares): (&[usize; LANES], &[R; LANES]),
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
        if slab.is_in_side(row.d, row.at, group[l])
            && let Some(inner) = jet_from(slab, (row.d, row.beside(group[l])), machs)
        {
            let duct = areas[inner][l];
            (throat[l], areas[0][l], areas[1][l]) = (duct, duct, duct);
        }
    }
    let acoustic_weight = group.map(|i| row.acoustic_weight(i));
    let faces =
        JumpFaces { states, ducts: areas, throat, references: [gather(0, D + 2), gather(1, D + 2)], acoustic_weight };
    let tell = |l: usize, f: JumpFlux<R, D>| {
        let mut put = |v: usize, value: R| {
            let own = &mut flux.values[v * flux.n + group[l]];
            *own = share(*own, value, shares[l]);
            *own
        };
        put(0, f.mass);
        put(1, f.normal[0]);
        let across: [R; D] = core::array::from_fn(|c| if c == 0 { R::ZERO } else { put(1 + c, f.momentum[c]) });
        put(D + 1, f.energy);
        put(D + 2, f.normal[1]);
        if MIXED {
            (0..2).for_each(|v| _ = put(D + 3 + v, f.carried[v]));
        }
        for c in 1..D {
            flux.values[apart(c, D, MIXED) * flux.n + group[l]] = across[c];
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
