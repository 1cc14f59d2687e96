//! Fluxes through the faces of a row, from their states on both sides and their open fractions.

use crate::flow::face_gas::{FaceGas, MixedFace};
use crate::flow::kernel::rows::{split_mut, state, var};
use crate::flow::riemann::{Slowness, Solver};
use crate::flow::state::{Primitive, each};
use crate::number::real::Real;

/// How porosity enters a face.
#[derive(Clone, Copy)]
pub(crate) enum Openings<'a, R> {
    /// No porosity: nothing is read.
    None,
    /// `beta_f p` on faces and the cell's pressure on the walls inside.
    Geometric(&'a [R]),
    /// The paper's −beta_v grad p: face, `beta_v` on the left, `beta_v` on the right.
    Paper(&'a [R], &'a [R], &'a [R]),
}

impl<'a, R> Openings<'a, R> {
    /// Of one face alone.
    pub(crate) fn one(self, i: usize) -> Self {
        let of = |values: &'a [R]| &values[i..][..1];
        match self {
            Openings::None => Openings::None,
            Openings::Geometric(face) => Openings::Geometric(of(face)),
            Openings::Paper(face, low, high) => Openings::Paper(of(face), of(low), of(high)),
        }
    }

    /// Open fractions of the faces; none without porosity.
    pub(crate) fn face(&self) -> Option<&'a [R]> {
        match self {
            Openings::None => None,
            Openings::Geometric(face) | Openings::Paper(face, _, _) => Some(face),
        }
    }
}

/// Fluxes through a row of faces of axis `d`, from face state blocks in the frame of the axis, as long as `pace`: time step over width, times
/// open area over open volume.
pub(crate) fn fluxes<R: Real, S: Solver, const D: usize, const ENERGY: bool, const MIXED: bool>(
    states: [&[R]; 2],
    openings: Openings<'_, R>,
    gas: &FaceGas<R>,
    pace: &[R],
    out: &mut [R],
) {
    match openings {
        Openings::None => face_loop::<R, S, D, ENERGY, MIXED, 0>(states, [&[]; 3], gas, pace, out),
        Openings::Geometric(b) => face_loop::<R, S, D, ENERGY, MIXED, 1>(states, [b; 3], gas, pace, out),
        Openings::Paper(b, l, r) => face_loop::<R, S, D, ENERGY, MIXED, 2>(states, [b, l, r], gas, pace, out),
    }
}

/// Open fraction up to which a face is closed to the pressure of the paper's form, which would act on all of `beta_v`: the rounding
/// of geometry, with a margin. Larger: pressure is not felt through narrow gaps.
const SHUT: f64 = 1e-9;

/// `FORM`: 0 plain, 1 geometric, 2 paper.
#[inline(always)]
fn face_loop<R: Real, S: Solver, const D: usize, const ENERGY: bool, const MIXED: bool, const FORM: u8>(
    [left, right]: [&[R]; 2],
    openings: [&[R]; 3],
    gas: &FaceGas<R>,
    pace: &[R],
    out: &mut [R],
) {
    let m = pace.len();
    let (l_rho, l_u, l_p) = state::<R, D>(left, m);
    let (r_rho, r_u, r_p) = state::<R, D>(right, m);
    let (l_wall, r_wall) = (var(left, D + 2, m), var(right, D + 2, m));
    let (mass, momentum, energy, rest) = split_mut::<R, D>(out, m);
    let (other, rest) = rest.split_at_mut(m);
    // Of one gas none of these is read or written.
    let (volume, carried) = if MIXED { rest.split_at_mut(m) } else { (&mut [][..], &mut [][..]) };
    // Without closures: this is compiled for 180 kinds of flow, and `map` of an array for each of its closures.
    let [l_capacity, r_capacity] = if MIXED { [var(left, D + 3, m), var(right, D + 3, m)] } else { [l_rho, r_rho] };
    let [b, l, r] = openings;
    let [face, vol_l, vol_r] = if FORM == 0 { [l_rho; 3] } else { [&b[..m], &l[..m], &r[..m]] };
    for i in 0..m {
        let l = Primitive { density: l_rho[i], velocity: each(|c| l_u[c][i]), pressure: l_p[i] };
        let r = Primitive { density: r_rho[i], velocity: each(|c| r_u[c][i]), pressure: r_p[i] };
        let bend = (l.pressure - l_wall[i]) + (r.pressure - r_wall[i]);
        let slowness = Slowness { bend, pace: pace[i] };
        let f = if MIXED {
            let gases = MixedFace::of_capacities([l_capacity[i], r_capacity[i]]);
            S::slow_flux::<R, D, ENERGY>(&l, &r, &gases, slowness)
        } else {
            S::slow_flux::<R, D, ENERGY>(&l, &r, gas, slowness)
        };
        let (mut to_left, mut to_right) = (f.momentum[0] - l_wall[i], f.momentum[0] - r_wall[i]);
        let b = face[i];
        let open = |x: R| if FORM == 0 { x } else { b * x };
        to_left = open(to_left);
        to_right = open(to_right);
        if FORM == 2 {
            // Behind a closed face there is no gas that could push: the pressure there is the cell's own.
            let shut = !(b > R::from_f64(SHUT));
            let beyond = |own: R, volume: R| if shut { R::ZERO } else { (volume - b) * (f.pressure - own) };
            to_left += beyond(l_wall[i], vol_l[i]);
            to_right += beyond(r_wall[i], vol_r[i]);
        }
        mass[i] = open(f.mass);
        momentum[0][i] = to_left;
        other[i] = to_right;
        for c in 1..D {
            momentum[c][i] = open(f.momentum[c]);
        }
        if ENERGY {
            energy[i] = open(f.energy);
        }
        if MIXED {
            [volume[i], carried[i]] = f.carried(open);
        }
    }
}
