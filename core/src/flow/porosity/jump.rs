//! Fluxes through faces where the open area jumps, several side by side.
//!
//! Both states are carried to the throat ([`crate::flow::porosity::throat`]). Strong waves meet there in one Riemann problem; weak ones pass by the
//! laws of sound at a change of area; what lies between takes a share of both. What each cell loses in momentum follows from
//! its own side of the stationary wave, so the two cells lose different normal momentum.

use crate::flow::face_gas::{FaceGas, FaceGases, MixedFace};
use crate::flow::porosity::throat::{AtThroat, ThroatGas};
use crate::flow::riemann::Flux;
use crate::flow::state::{Gas, Primitive, each};
use crate::number::real::Real;

/// The flux between the states in a throat, the gas on each side: a Riemann solver.
pub(in crate::flow) type ThroatCall<R, const D: usize> = fn(&[Primitive<R, D>; 2], &[FaceGas<R>; 2]) -> Flux<R, D>;

/// Open faces at which the porosity jumps, one per lane: what lies on the left and right of them.
pub(in crate::flow) struct JumpFaces<R, const D: usize, const L: usize> {
    /// States, normal velocity first.
    pub states: [Primitive<[R; L], D>; 2],
    /// Duct areas.
    pub ducts: [[R; L]; 2],
    /// Area of the throat.
    pub throat: [R; L],
    /// Pressures that act on the walls inside each cell at this face.
    pub references: [[R; L]; 2],
    /// Weight of the flux of weak waves: 1, or 0 beside a cell where a step went wrong. There the Riemann problem in the throat is solved,
    /// however weak the waves.
    pub acoustic_weight: [R; L],
}

/// What passes a jump face, areas included.
#[derive(Clone, Copy)]
pub(in crate::flow) struct JumpFlux<R, const D: usize> {
    /// Mass and energy per time.
    pub mass: R,
    pub energy: R,
    /// Tangential momentum, in the places from 1 on.
    pub momentum: [R; D],
    /// Normal momentum that each cell loses (left) or gains (right), less its duct area times its reference pressure.
    pub normal: [R; 2],
    /// Of a mixed gas, volume per time at the density of the cell upstream, and the capacity that it carries; else zeros.
    pub carried: [R; 2],
}

/// One lane, whose states have been carried to the throat.
pub(in crate::flow) struct JumpLane<R, const D: usize> {
    pub cell: [Primitive<R, D>; 2],
    pub throat: [Primitive<R, D>; 2],
    /// Areas of the throat, of the ducts, and of the streams that pass.
    pub to: R,
    pub ducts: [R; 2],
    pub passing: [R; 2],
    pub references: [R; 2],
    /// Force on the walls beside a stream that chokes, less that of the reference pressure.
    pub walls: [R; 2],
}

/// Tells the fluxes through the first `count` of several jump faces; `solve` is the Riemann solver in the throats.
pub(in crate::flow) fn jump_fluxes<R: Real, const D: usize, const L: usize>(
    (faces, count): (&JumpFaces<R, D, L>, usize),
    gas: &impl FaceGases<R>,
    throat: [&ThroatGas<R>; 2],
    solve: ThroatCall<R, D>,
    mut tell: impl FnMut(usize, JumpFlux<R, D>),
) {
    let ([left, right], to) = (&faces.ducts, &faces.throat);
    let side = |s: usize| throat[s].carry_all(&faces.states[s], &faces.ducts[s], to);
    let at = [side(0), side(1)];
    let (walls, acoustic_weight) = chokes(faces, &at, throat);
    let gases = [*gas.left(), *gas.right()];
    for i in 0..count.min(L) {
        let mut lane = JumpLane {
            cell: [faces.states[0].lane(i), faces.states[1].lane(i)],
            throat: [at[0].state.lane(i), at[1].state.lane(i)],
            to: to[i],
            ducts: [left[i], right[i]],
            passing: [at[0].passing[i], at[1].passing[i]],
            references: [faces.references[0][i], faces.references[1][i]],
            walls: [walls[0][i], walls[1][i]],
        };
        let weak = acoustic(&lane, gas);
        let share = acoustic_weight[i] * weakness(weak.mass / to[i], &lane.throat, gas);
        if share < R::ONE {
            lane.take_up(throat, gas);
        }
        let strong = strong_waves(&lane, &solve(&lane.throat, &gases), gas);
        tell(i, weak.blend(&strong, share, gas));
    }
}

/// The same where each side has a gas of its own, of these `capacities`: one face after the other.
pub(in crate::flow) fn mixed_jump_fluxes<R: Real, const D: usize, const L: usize>(
    (faces, count): (&JumpFaces<R, D, L>, usize),
    capacities: &[[R; L]; 2],
    solve: ThroatCall<R, D>,
    mut tell: impl FnMut(usize, JumpFlux<R, D>),
) {
    for i in 0..count.min(L) {
        let one = |all: &[R; L]| [all[i]];
        let state = |w: &Primitive<[R; L], D>| {
            let w = w.lane(i);
            Primitive { density: [w.density], velocity: w.velocity.map(|u| [u]), pressure: [w.pressure] }
        };
        let face = JumpFaces {
            states: faces.states.each_ref().map(state),
            ducts: faces.ducts.each_ref().map(one),
            throat: one(&faces.throat),
            references: faces.references.each_ref().map(one),
            acoustic_weight: one(&faces.acoustic_weight),
        };
        let gases = capacities.each_ref().map(|c| Gas::Ideal { gamma: R::ONE + R::ONE / c[i] });
        let throats = gases.map(ThroatGas::new);
        let [left, right] = throats.each_ref();
        let of_face = MixedFace(gases.map(FaceGas::new));
        jump_fluxes::<R, D, 1>((&face, 1), &of_face, [left, right], solve, |_, flux| tell(i, flux));
    }
}

/// A stream so many times as wide as its throat passes it, whatever lies beyond.
const FUNNEL: f64 = 4.0;

/// The areas of the streams of both ducts that pass a throat of area `to`: the whole ducts where these carry one stream. At the mouth of a blind hole they do
/// not: what the gas before a wall does is no stream through the hole, and carried to the throat would press or draw on the gas in it as no gas can. There passes
/// as much as flows in the duct beyond the throat, and the rest of the gas meets the wall. Gas that runs ahead beyond the throat tells less of what
/// it takes up from half the speed of sound on, and nothing from the speed of sound on. `through` are the velocities of both cells, positive to the right.
pub(in crate::flow) fn taken_up<R: Real, const D: usize>(
    cells: &[Primitive<R, D>; 2],
    through: [R; 2],
    (ducts, to): ([R; 2], R),
    gas: &impl FaceGases<R>,
) -> [R; 2] {
    let least = R::from_f64(FUNNEL) * to;
    let mass = [0, 1].map(|s| ducts[s] * (cells[s].density * through[s]));
    let mach = [through[0] / gas.left().sound_speed(&cells[0]), through[1] / gas.right().sound_speed(&cells[1])];
    [0, 1].map(|s| {
        let ahead = |x: R| if mass[s] < R::ZERO { -x } else { x };
        let (own, beyond) = (ahead(mass[s]), R::larger(ahead(mass[1 - s]), R::ZERO));
        if !(ducts[s] > least && beyond < own) {
            return ducts[s];
        }
        let untold = R::smaller(R::larger(R::TWO * ahead(mach[1 - s]) - R::ONE, R::ZERO), R::ONE);
        R::larger(least, ducts[s] * ((beyond + untold * (own - beyond)) / own))
    })
}

impl<R: Real, const D: usize> JumpLane<R, D> {
    /// Leaves no more of each stream than [`taken_up`] says.
    // Called, not inlined: few lanes carry strong waves.
    #[inline(never)]
    fn take_up(&mut self, throat: [&ThroatGas<R>; 2], gas: &impl FaceGases<R>) {
        let u = [self.cell[0].velocity[0], self.cell[1].velocity[0]];
        let from = taken_up(&self.cell, u, (self.ducts, self.to), gas);
        for s in 0..2 {
            if from[s] < self.passing[s] {
                let AtThroat { state, passing } = throat[s].carry(&self.cell[s], from[s], self.to);
                (self.throat[s], self.passing[s]) = (state, passing);
                let into_wall = if s == 0 { u[0] } else { -u[1] };
                let blocked = self.ducts[s] - passing;
                self.walls[s] =
                    blocked * throat[s].relative_wall_pressure(&self.cell[s], into_wall, self.references[s]);
            }
        }
    }
}

/// What weak waves carry of a mixed gas: that of the cell upstream, at the density that it has there. Slow gas of several capacities keeps its pressure with
/// that: the energy that passes is this volume's.
fn carried_by_mass<R: Real>(mass: R, densities: [R; 2], gas: &impl FaceGases<R>) -> [R; 2] {
    if !gas.is_mixed() {
        return [R::ZERO; 2];
    }
    let upstream = usize::from(mass < R::ZERO);
    let volume = mass / densities[upstream];
    [volume, volume * gas.upwind(upstream == 0).capacity()]
}

/// What the flux `f` carries of a mixed gas through a throat of area `to`, from the densities upstream in the cells and in the throat: the volume and the
/// capacity that belong to the energy of this flux.
pub(in crate::flow) fn carried_by_flux<R: Real, const D: usize>(
    f: &Flux<R, D>,
    to: R,
    [in_cells, in_throat]: [[R; 2]; 2],
    gas: &impl FaceGases<R>,
) -> [R; 2] {
    if !gas.is_mixed() {
        return [R::ZERO; 2];
    }
    let upstream = usize::from(f.mass < R::ZERO);
    let area = to * (in_throat[upstream] / in_cells[upstream]);
    f.carried(|x| area * x)
}

/// The forces on the walls beside streams that choke, and `acoustic_weight` set to 0 where a stream chokes.
fn chokes<R: Real, const D: usize, const L: usize>(
    faces: &JumpFaces<R, D, L>,
    at: &[AtThroat<[R; L], D>; 2],
    throat: [&ThroatGas<R>; 2],
) -> ([[R; L]; 2], [R; L]) {
    let (mut walls, mut acoustic_weight) = ([[R::ZERO; L]; 2], faces.acoustic_weight);
    for s in 0..2 {
        for i in 0..L {
            let blocked = faces.ducts[s][i] - at[s].passing[i];
            if blocked > R::ZERO {
                let w = faces.states[s].lane(i);
                let into_wall = if s == 0 { w.velocity[0] } else { -w.velocity[0] };
                walls[s][i] = blocked * throat[s].relative_wall_pressure(&w, into_wall, faces.references[s][i]);
                acoustic_weight[i] = R::ZERO;
            }
        }
    }
    (walls, acoustic_weight)
}

/// The fluxes of strong waves, from the flux of the Riemann problem in the throat.
#[inline(always)]
fn strong_waves<R: Real, const D: usize>(
    face: &JumpLane<R, D>,
    f: &Flux<R, D>,
    gas: &impl FaceGases<R>,
) -> JumpFlux<R, D> {
    let to = face.to;
    let through = to * f.momentum[0];
    // Impulse rho u² + p on the throat side, and in the cell relative to the reference pressure.
    let normal = |s: usize| {
        let (w, t) = (&face.cell[s], &face.throat[s]);
        let at_throat = through - to * (t.density * t.velocity[0] * t.velocity[0] + t.pressure);
        let stream = face.passing[s] * relative_impulse(w, R::ONE, face.references[s]);
        at_throat + (stream + face.walls[s])
    };
    JumpFlux {
        mass: to * f.mass,
        energy: to * f.energy,
        momentum: each(|c| to * f.momentum[c]),
        normal: [normal(0), normal(1)],
        carried: carried_by_flux(f, to, [face.cell.each_ref(), face.throat.each_ref()].map(densities), gas),
    }
}

/// ρu² + p of a stream that has the velocity and pressure of a state and a multiple of its density, less a reference pressure.
#[inline(always)]
fn relative_impulse<R: Real, const D: usize>(w: &Primitive<R, D>, densities: R, reference: R) -> R {
    densities * (w.density * w.velocity[0] * w.velocity[0]) + (w.pressure - reference)
}

/// Up to half this strength (Mach number in the throat, or jump of its pressure as a share) waves count as weak, from all of it
/// on as strong.
const STRONG: f64 = 0.6;

/// Share of the flux of weak waves: 1 up to half of [`STRONG`], 0 from [`STRONG`] on, linear between. The strength is the larger of the jump
/// of the pressure as a share and the Mach number in the throat; the latter also for `mass_flux`, what weak waves would carry per area of
/// the throat.
#[inline(always)]
pub(in crate::flow) fn weakness<R: Real, const D: usize>(
    mass_flux: R,
    [l, r]: &[Primitive<R, D>; 2],
    gas: &impl FaceGases<R>,
) -> R {
    let mach = |w: &Primitive<R, D>, sound: R| {
        R::larger((w.density * w.velocity[0]).abs(), mass_flux.abs()) / (w.density * sound)
    };
    let step = (l.pressure - r.pressure).abs() / R::smaller(l.pressure, r.pressure);
    let strength = R::larger(R::larger(mach(l, gas.left().sound_speed(l)), mach(r, gas.right().sound_speed(r))), step);
    let share = R::TWO - strength * R::from_f64(2.0 / STRONG);
    R::smaller(R::larger(share, R::ZERO), R::ONE)
}

/// The fluxes of weak waves at a change of area: one sound wave into each duct, the stationary wave between them. A Riemann
/// problem in the throat instead, as for strong waves, gives sound at a contraction energy that it does not have, and noise
/// would grow between two of them.
///
/// Both sides have the mass flux Q in common and differ from their cells by the outgoing wave: the pressure by ∓c (Q − Q_K)/a, the
/// momentum flux by (u ∓ c)(Q − Q_K), the total enthalpy by ∓c (Q − Q_K)/(a rho), left and right. Q is such that the total pressures in
/// the throat meet; the waves change them there as they do the pressures in the ducts, which is so in slow flow, and does not matter in a steady one.
///
/// Not the pressures, each at what its own cell carries: where a stream turns, a cell carries the mean of what passes its two faces, and Q passes the throat
/// as seen from both sides. Each face would make energy, Q (Q_R² − Q_L²) over twice the square of density and throat, and a drift among
/// obstacles, which nothing else damps, would feed itself. With the total pressures no face makes any, whatever its areas: sound and shear only
/// take it.
///
/// What passes the throat is the gas upstream, and between it and the gas of the cell downstream moves a contact. So Q_K there is that of the gas
/// upstream at the velocity and pressure downstream, and so is what it takes to reach the throat; the wave beyond the contact runs in the gas downstream,
/// which changes its pressure by as much for a change of velocity as before: c/σ in the place of c, σ the share of densities.
#[inline(always)]
pub(in crate::flow) fn acoustic<R: Real, const D: usize>(
    face: &JumpLane<R, D>,
    gas: &impl FaceGases<R>,
) -> JumpFlux<R, D> {
    let sound = [gas.left().sound_speed(&face.cell[0]), gas.right().sound_speed(&face.cell[1])];
    let mass = [0, 1].map(|s| face.ducts[s] * (face.cell[s].density * face.cell[s].velocity[0]));
    let both = face.ducts[0] * face.ducts[1];
    let drive = |pressures: [R; 2]| both * (pressures[0] - pressures[1]);
    // Stiffnesses c/a of the ducts, times both areas.
    let stiff = [sound[0] * face.ducts[1], sound[1] * face.ducts[0]];
    let pushed = stiff[0] * mass[0] + stiff[1] * mass[1];
    let total = face.throat.each_ref().map(|t| t.pressure + R::HALF * (t.density * (t.velocity[0] * t.velocity[0])));
    let from_left = pushed + drive(total) >= R::ZERO;
    let share = share_of_densities(face, gas, from_left);
    // By side: 1 upstream.
    let share = [if from_left { R::ONE } else { share }, if from_left { share } else { R::ONE }];
    let at_throat = |s: usize| {
        let (cell, throat) = (face.cell[s].pressure, total[s]);
        if share[s] == R::ONE { throat } else { cell + share[s] * (throat - cell) }
    };
    let common = (pushed + drive([at_throat(0), at_throat(1)])) / (stiff[0] / share[0] + stiff[1] / share[1]);
    let own = |s: usize, wave: R| {
        let (w, duct, share) = (&face.cell[s], face.ducts[s], share[s]);
        let (wave, change) = (wave / share, common - share * mass[s]);
        let enthalpy = (duct * gas.upwind(s == 0).enthalpy(w) + wave * change) / (duct * w.density);
        let impulse = relative_impulse(w, share, face.references[s]);
        (duct * impulse + (w.velocity[0] + wave) * change, common * enthalpy)
    };
    let ((left, energy_l), (right, energy_r)) = (own(0, -sound[0]), own(1, sound[1]));
    let pick = |a: R, b: R| core::hint::select_unpredictable(from_left, a, b);
    let [l, r] = &face.cell;
    JumpFlux {
        mass: common,
        energy: pick(energy_l, energy_r),
        momentum: each(|c| common * pick(l.velocity[c], r.velocity[c])),
        normal: [left, right],
        carried: carried_by_mass(common, densities(face.cell.each_ref()), gas),
    }
}

/// Densities on both sides.
pub(in crate::flow) fn densities<R: Real, const D: usize>([l, r]: [&Primitive<R, D>; 2]) -> [R; 2] {
    [l.density, r.density]
}

/// Density of the gas upstream, brought to the pressure downstream, over the density there; both as they are in the throat. 1 where one gas flows steadily.
#[inline(always)]
fn share_of_densities<R: Real, const D: usize>(face: &JumpLane<R, D>, gas: &impl FaceGases<R>, from_left: bool) -> R {
    let [l, r] = &face.throat;
    let (up, down) = if from_left { (l, r) } else { (r, l) };
    // (p / p₀)^(1/γ), within 0.3 % for weak waves: the quotient of two lines that has its first three derivatives at 1.
    let exponent = gas.upwind(from_left).inv_gamma();
    let (near, far) = (R::ONE + exponent, R::ONE - exponent);
    let compressed = (near * down.pressure + far * up.pressure) / (far * down.pressure + near * up.pressure);
    up.density * compressed / down.density
}

impl<R: Real, const D: usize> JumpFlux<R, D> {
    /// A share of this flux and the rest of another; 0 and 1 give one of them alone.
    #[inline(always)]
    fn blend(&self, other: &Self, share: R, gas: &impl FaceGases<R>) -> Self {
        let rest = R::ONE - share;
        let mix = |a: R, b: R| {
            let both = share * a + rest * b;
            let some = if rest > R::ZERO { both } else { a };
            if share > R::ZERO { some } else { b }
        };
        JumpFlux {
            mass: mix(self.mass, other.mass),
            energy: mix(self.energy, other.energy),
            momentum: each(|c| mix(self.momentum[c], other.momentum[c])),
            normal: [mix(self.normal[0], other.normal[0]), mix(self.normal[1], other.normal[1])],
            carried: each(|v| if gas.is_mixed() { mix(self.carried[v], other.carried[v]) } else { R::ZERO }),
        }
    }
}
