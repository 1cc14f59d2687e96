//! The last fluxes before any floor: between states that stay physical whatever they are.
//!
//! The flux of Rusanov between the averages of two cells takes from a cell no more than a share of its content: the new state is a
//! mean of physical states as long as the step keeps dt (|u| + c)/dx, summed over the axes, below 1. It replaces the fluxes through all
//! faces of a cell that first order and the Riemann solver asked for did not save; both cells beside a face get the same flux, so mass
//! and energy are kept as everywhere.
//!
//! Reference: X. Y. Hu, N. A. Adams, C.-W. Shu, J. Comput. Phys. 242 (2013) 169, sec. 2 (which flux is positive, and that it may replace
//! another face by face).

use crate::flow::face_gas::MixedFace;
use crate::flow::fallback::POSITIVE;
use crate::flow::kernel::fluxes_at_breaks::apart;
use crate::flow::kernel::rows::{self, FluxBlock};
use crate::flow::kernel::slab::Slab;
use crate::flow::riemann::{Rusanov, Solver};
use crate::number::real::Real;

/// Replaces the fluxes beside marked cells in a row of faces of axis `d`; `at` names the cell above the first of them. `states` are those on
/// the left and on the right, with the pressures that act on the walls inside the cells.
pub(in crate::flow) fn positive_fluxes<R: Real, const D: usize, const ENERGY: bool, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    d: usize,
    at: [usize; D],
    states: [&[R]; 2],
    flux: FluxBlock<'_, R>,
) {
    let Some(marks) = slab.first_order else { return };
    let (n, mesh) = (flux.n, &slab.problem.mesh);
    for i in 0..n {
        let mut face = at;
        face[0] += i;
        let beside = mesh.beside(d, face, slab.periodic[d]);
        if !beside.into_iter().flatten().any(|cell| marks[mesh.index(cell)] >= POSITIVE) {
            continue;
        }
        let [l, r] = states.map(|s| rows::face_state::<R, D>(s, n, i));
        let f = if MIXED {
            Rusanov::flux::<R, D, ENERGY>(&l, &r, &MixedFace::of_capacities(states.map(|s| s[(D + 3) * n + i])))
        } else {
            Rusanov::flux::<R, D, ENERGY>(&l, &r, &slab.face_gas)
        };
        // Through a closed face nothing passes; the wall there answers with the pressure of the cell.
        let open = slab.medium.as_ref().map_or(R::ONE, |m| m.porosity.faces[d][mesh.face(d, face)]);
        let through = |x: R| if open > R::ZERO { open * x } else { R::ZERO };
        let reference = states.map(|s| s[(D + 2) * n + i]);
        flux.values[i] = through(f.mass);
        flux.values[n + i] = through(f.momentum[0] - reference[0]);
        for c in 1..D {
            flux.values[(1 + c) * n + i] = through(f.momentum[c]);
            flux.values[apart(c, D, MIXED) * n + i] = through(f.momentum[c]);
        }
        if ENERGY {
            flux.values[(D + 1) * n + i] = through(f.energy);
        }
        flux.values[(D + 2) * n + i] = through(f.momentum[0] - reference[1]);
        if MIXED {
            [flux.values[(D + 3) * n + i], flux.values[(D + 4) * n + i]] = f.carried(through);
        }
    }
}
