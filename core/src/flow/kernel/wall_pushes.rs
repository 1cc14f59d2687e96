//! What the fluxes of a step do to the walls of watched cells.
//!
//! Both cells beside a face know a flux of momentum through it, each counted from the pressure on the walls inside it. For a face without a break
//! they agree on what passes the open part. At a closed face nothing passes. At a jump of porosity the stationary wave between them leaves momentum to the
//! walls of both cells; what passes the throat is then taken from the cell that has less wall there.

use crate::flow::kernel::fluxes_at_breaks::apart;
use crate::flow::kernel::rows::var;
use crate::flow::kernel::slab::{CellsBeside, FaceRow, Slab};
use crate::flow::porosity::areas::Ducts;
use crate::flow::porosity::cell_walls::Border;
use crate::flow::porosity::fractions::least_volume;
use crate::flow::problem::PressureForm;
use crate::flow::state::rotate_back;
use crate::number::real::Real;

/// Writes what acts at the faces of a row on the walls of watched cells on one side of them, and the mass that passes.
pub(in crate::flow) fn push_walls<R: Real, const D: usize>(
    slab: &Slab<'_, R, D>,
    faces: &FaceRow<'_, R, D>,
    cells: CellsBeside,
) {
    let Some(walls) = slab.walls else { return };
    let medium = slab.medium.as_ref().map(|medium| (medium, medium.ducts(faces.d, faces.at)));
    for (i, push) in walls.of_row(slab.first + cells.start, slab.reported.clone()) {
        let (mut now, face, side) = (push.get(), cells.face + i, usize::from(cells.high));
        now.mass[faces.d][side] = faces.flux.get(face).copied().unwrap_or(R::ZERO);
        if let Some((medium, ducts)) = &medium {
            let cell = cells.start + i;
            let border = medium.breaks(cell, faces.d, cells.high).then(|| {
                let mut at = medium.mesh.coordinates(cell);
                at[faces.d] += usize::from(cells.high);
                slab.border(faces.d, at)
            });
            let (closed, along) = at_face(slab, faces, (ducts, &border.flatten()), face, cells.high);
            (now.sides[faces.d][side], now.along[faces.d][side]) = (closed, along);
        }
        push.set(now);
    }
}

/// Pressure times closed fraction at face `i` of a row, on the left (`high`) or right of it, and the force along x, y, z that walls there get from a border beside:
/// it may act where the face is open.
fn at_face<R: Real, const D: usize>(
    slab: &Slab<'_, R, D>,
    faces: &FaceRow<'_, R, D>,
    (ducts, border): (&Ducts<'_, R>, &Option<Border<R, D>>),
    i: usize,
    high: bool,
) -> (R, [R; D]) {
    let (n, own, mixed) = (faces.n, usize::from(!high), slab.problem.gas.is_mixed());
    let value = |block: &[R], v: usize| var(block, v, n).get(i).copied().unwrap_or(R::ZERO);
    let open = ducts.face(i);
    let ambient = slab.walls.map_or(R::ZERO, |walls| walls.reference);
    let above = faces.states.map(|block| value(block, D + 2) - ambient);
    // Momentum through the open part of the face and into the walls beside it, as each of the two cells sees it, less what passes.
    let to_walls = |c: usize| {
        let seen = match c {
            0 => [value(faces.flux, 1) + open * above[0], value(faces.flux, D + 2) + open * above[1]],
            _ => [1 + c, apart(c, D, mixed)].map(|v| value(faces.flux, v)),
        };
        seen[own] - passing(slab, faces, (ducts, border), i, seen, own)
    };
    let closed = (R::ONE - open) * above[own];
    match border {
        Some(_) => (closed, rotate_back(core::array::from_fn(to_walls), faces.d)),
        None => (closed + to_walls(0), [R::ZERO; D]),
    }
}

/// What passes the open part of a face, of what each of both cells sees.
fn passing<R: Real, const D: usize>(
    slab: &Slab<'_, R, D>,
    faces: &FaceRow<'_, R, D>,
    (ducts, border): (&Ducts<'_, R>, &Option<Border<R, D>>),
    i: usize,
    seen: [R; 2],
    own: usize,
) -> R {
    if !(ducts.face(i) > R::ZERO) {
        R::ZERO
    } else if !slab.is_in_side(faces.d, faces.at, i) {
        let [left, right] = match border {
            // What lies in the cells beside a border meets no wall of it.
            Some(border) => border.ducts.map(|duct| if duct.is_some() { R::ONE } else { R::ZERO }),
            None => walls_beside(slab, faces, ducts, i),
        };
        let sum = left + right;
        // Without any wall the two differ by rounding.
        if sum > R::ZERO { (right * seen[0] + left * seen[1]) / sum } else { seen[own] }
    } else {
        seen[own]
    }
}

/// How much wall the cells on the left and on the right of a face have beside what is open of it: of their ducts; in the paper's form of their volumes.
fn walls_beside<R: Real, const D: usize>(
    slab: &Slab<'_, R, D>,
    faces: &FaceRow<'_, R, D>,
    ducts: &Ducts<'_, R>,
    i: usize,
) -> [R; 2] {
    let (problem, open) = (slab.problem, ducts.face(i));
    let areas = match (problem.scheme.pressure, &slab.medium) {
        (PressureForm::Paper, Some(medium)) => {
            let mut face = faces.at;
            face[0] += i;
            let volume = |cell: [usize; D]| medium.porosity.volume.get(problem.mesh.index(cell)).copied();
            problem.mesh.beside(faces.d, face, slab.periodic[faces.d]).map(|c| c.and_then(volume).unwrap_or(open))
        }
        _ => ducts.beside(i, false).into(),
    };
    areas.map(|area| (area - open).abs())
}

/// Writes what drag takes from the gas of a cell: `lost` per open volume.
pub(in crate::flow) fn push_obstacles<R: Real, const D: usize>(slab: &Slab<'_, R, D>, cell: usize, lost: [R; D]) {
    let Some(walls) = slab.walls else { return };
    let volume = slab.medium.as_ref().map(|m| m.porosity.volume.get(cell).copied().unwrap_or(R::ZERO));
    // A cell of no volume counts as its cluster counts it.
    let open = volume.map_or(R::ONE, |volume| R::larger(volume, least_volume()));
    for (_, push) in walls.of_row(slab.first + cell, 0..1) {
        let mut now = push.get();
        now.drag = lost.map(|m| open * m / slab.dt);
        push.set(now);
    }
}
