//! Inlets: velocity and density are given, the pressure follows the flow, so that waves leave and the velocity is met in the end.

use super::state::Setup;
use voidage_core::flow::{Boundary, Error, Fields, Gas};
use voidage_core::number::real::Real;

/// Lets the pressure of all inlets follow for one step.
pub(super) fn relax<R: Real, const D: usize>(
    setup: &mut Setup<R, D>,
    field: &Fields<'_, R, D>,
    dt: R,
) -> Result<(), Error> {
    for d in 0..D {
        for side in 0..2 {
            let Boundary::Inlet(state) = setup.boundaries[d][side] else { continue };
            let Some(mean) = mean_velocity(setup, field, d, side)? else { continue };
            let c = setup.gas.sound_speed(&state);
            let length = setup.mesh()?.widths()[d].iter().fold(R::ZERO, |sum, &w| sum + w);
            let time = if setup.relax[d][side] > R::ZERO { setup.relax[d][side] } else { length / c };
            let share = (dt / time).smaller(R::ONE);
            let inward = if side == 0 { mean } else { -mean };
            let mut next = setup.boundaries[d][side].relaxed(d, inward, c, share);
            if let Boundary::Inlet(w) = &mut next {
                follow(setup.gas, w);
            }
            setup.boundaries[d][side] = next;
        }
    }
    Ok(())
}

/// The density of a gas without energy equation follows its pressure.
fn follow<R: Real, const D: usize>(gas: Gas<R>, w: &mut voidage_core::flow::Primitive<R, D>) {
    if let Some(density) = gas.density(w.pressure) {
        w.density = density;
    }
}

/// The velocity normal to a side, a mean over the open area of the cells along it; none if all of it is closed.
fn mean_velocity<R: Real, const D: usize>(
    setup: &Setup<R, D>,
    field: &Fields<'_, R, D>,
    d: usize,
    side: usize,
) -> Result<Option<R>, Error> {
    let mesh = setup.mesh()?;
    let (cells, stride, openings) = (mesh.cells()[d], mesh.face_stride(d), setup.openings());
    let edge = if side == 0 { 0 } else { cells - 1 };
    let (mut area, mut flow) = (R::ZERO, R::ZERO);
    for n in 0..mesh.len() / cells {
        let cell = n % stride + (n / stride * cells + edge) * stride;
        let at = mesh.coordinates(cell);
        let face = mesh.faces_of(d, at)[side];
        let open = openings.map_or(Some(R::ONE), |(_, faces)| faces[d].get(face).copied());
        let (Some(u), Some(open)) = (field.get(cell), open) else { continue };
        let share = open * mesh.volume(at) / mesh.widths()[d][edge];
        area += share;
        flow += share * setup.gas.primitive(&u).velocity[d];
    }
    Ok((area > R::ZERO).then(|| flow / area))
}
