//! What differs from one Riemann solver to another, held by pointers: all else of a sweep is compiled once for all of them.

use crate::flow::face_gas::{FaceGas, MixedFace};
use crate::flow::kernel::face_fluxes::{Openings, fluxes};
use crate::flow::porosity::jump::ThroatCall;
use crate::flow::riemann::{Flux, Hlle, Slowness, Solver};
use crate::flow::state::Primitive;
use crate::number::real::Real;

/// Fluxes of a row of faces: [`fluxes`].
pub(in crate::flow) type RowCall<R> = fn([&[R]; 2], Openings<'_, R>, &FaceGas<R>, &[R], &mut [R]);
/// The normal momentum that passes a wall, between the gas and its image.
type WallCall<R, const D: usize> = fn([&Primitive<R, D>; 2], &FaceGas<R>, Slowness<R>) -> R;

/// The calls of one solver, for one kind of gas.
#[derive(Clone, Copy)]
pub(in crate::flow) struct SolverCalls<R, const D: usize> {
    /// It looks at the pace of faces.
    pub low_mach: bool,
    /// Of the faces of a row.
    pub row: RowCall<R>,
    /// Of faces along a strong shock, if another solver has a share there.
    pub along_shocks: Option<RowCall<R>>,
    /// In the throat of a face where the porosity jumps.
    pub throat: ThroatCall<R, D>,
    /// At a closed face.
    pub wall: WallCall<R, D>,
}

impl<R: Real, const D: usize> SolverCalls<R, D> {
    /// Of a solver, for a gas with or without energy, of one or of several ratios of specific heats.
    pub(in crate::flow) fn of<S: Solver, const ENERGY: bool, const MIXED: bool>() -> Self {
        SolverCalls {
            low_mach: S::LOW_MACH,
            row: fluxes::<R, S, D, ENERGY, MIXED>,
            along_shocks: if S::KEEPS_SHEAR && D > 1 { Some(fluxes::<R, Hlle, D, ENERGY, MIXED>) } else { None },
            throat: throat::<R, S, D, MIXED>,
            wall: wall::<R, S, D>,
        }
    }
}

fn throat<R: Real, S: Solver, const D: usize, const MIXED: bool>(
    [l, r]: &[Primitive<R, D>; 2],
    gases: &[FaceGas<R>; 2],
) -> Flux<R, D> {
    if MIXED { S::flux::<R, D, true>(l, r, &MixedFace(*gases)) } else { S::flux::<R, D, true>(l, r, &gases[0]) }
}

fn wall<R: Real, S: Solver, const D: usize>(
    [l, r]: [&Primitive<R, D>; 2],
    gas: &FaceGas<R>,
    slowness: Slowness<R>,
) -> R {
    S::slow_flux::<R, D, false>(l, r, gas, slowness).momentum[0]
}
