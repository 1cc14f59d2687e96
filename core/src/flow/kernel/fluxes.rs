//! Fluxes through the faces of a row along each axis, and the changes that they make in the cells.

use crate::flow::boundary::Boundary;
use crate::flow::kernel::contractions::Contractions;
use crate::flow::kernel::face_fluxes::Openings;
use crate::flow::kernel::fluxes_at_breaks::{apart, changes_apart, fluxes_at_breaks};
use crate::flow::kernel::mixed::{self, Carried};
use crate::flow::kernel::positive_fluxes::positive_fluxes;
use crate::flow::kernel::rows::{self, Faces, FluxBlock, var};
use crate::flow::kernel::scratch::Work;
use crate::flow::kernel::shocks::{Pressures, fluxes_along_shocks};
use crate::flow::kernel::side_throats::ghost_beyond;
use crate::flow::kernel::slab::{CellsBeside, FaceRow, RowAt, Slab, tightened};
use crate::flow::porosity::flags::{break_high, break_low, is, marked};
use crate::flow::porosity::fractions::Medium;
use crate::flow::problem::PressureForm;
use crate::flow::state::{Conserved, Primitive, rotate_back};
use crate::flow::step_report::Report;
use crate::number::real::Real;
use core::ops::Range;

/// Face states of the present row on the low or high side of its cells along axis `d`.
fn states<R: Real, const D: usize, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    high: bool,
    d: usize,
    (half, slope, weight): (&[R], &[R], &[R]),
    out: Faces<'_, R>,
) {
    let weight = if slab.problem.gravity[d] != R::ZERO { Some(weight) } else { None };
    if MIXED {
        let faces = Faces { block: &mut *out.block, ..out };
        mixed::face_states::<R, D>(high, half, slope, slab.size.n, slab.capacities, faces);
    }
    rows::face_states::<R, D>(high, d, half, slope, slab.size.n, weight, out);
}

/// Fluxes through the faces inside and at both ends of a row, and their differences; `place` is that of the row in its tile.
pub(in crate::flow) fn fluxes_x<R: Real, const D: usize, const ENERGY: bool, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    row: RowAt<D>,
    place: usize,
    work: &mut Work<'_, R, D>,
    report: &mut Report<R, D>,
) {
    let (n, m) = (slab.size.n, slab.size.m);
    let from = (&*work.half, &*work.slope[0], &*work.coefficients.weight[0]);
    states::<R, D, MIXED>(slab, true, 0, from, Faces { block: work.left, stride: m, offset: 1 });
    states::<R, D, MIXED>(slab, false, 0, from, Faces { block: work.right, stride: m, offset: 0 });
    states_at_ends::<R, D, MIXED>(slab, row, work);

    let openings = match &slab.medium {
        None => Openings::None,
        Some(medium) => {
            let face = &medium.porosity.faces[0][medium.mesh.face(0, row.at)..][..m];
            match slab.problem.scheme.pressure {
                PressureForm::Geometric => Openings::Geometric(face),
                PressureForm::Paper => {
                    let volume = &medium.porosity.volume[row.start..][..n];
                    let (left, right) = (&mut *work.coefficients.vol_left, &mut *work.coefficients.vol_right);
                    left[1..].copy_from_slice(volume);
                    right[..n].copy_from_slice(volume);
                    left[0] = if slab.periodic[0] { volume[n - 1] } else { volume[0] };
                    right[n] = if slab.periodic[0] { volume[0] } else { volume[n - 1] };
                    Openings::Paper(face, left, right)
                }
            }
        }
    };
    let pace = &mut work.coefficients.pace[..m];
    if slab.solver.low_mach {
        paces(slab, 0, row.at, openings.face(), pace);
    }
    (slab.solver.row)([work.left, work.right], openings, &slab.face_gas, pace, work.flux);
    let seen = Pressures { window: work.window, ranges: work.ranges };
    let between = ([&*work.left, &*work.right], openings);
    fluxes_along_shocks(slab, (0, row.at), seen, between, work.strength, work.flux);
    if let Some(medium) = &slab.medium {
        let marks = &medium.porosity.marks[row.start..][..n];
        let last = Some(n).filter(|_| marks[n - 1] & break_high(0) != 0);
        let broken = marked(marks, break_low(0)).chain(last);
        let flux = FluxBlock { values: work.flux, n: m };
        let contractions = Contractions::new(slab, work.contractions, work.window);
        fluxes_at_breaks::<R, D, MIXED>(slab, (0, row.at), contractions, broken, [work.left, work.right], flux);
    }
    let flux = FluxBlock { values: work.flux, n: m };
    positive_fluxes::<R, D, ENERGY, MIXED>(slab, 0, row.at, [work.left, work.right], flux);
    changes_x::<R, D, ENERGY, MIXED>(slab, row, place, work, report);
}

/// What the fluxes of a row bring into the domain at both of its ends, and into its cells.
fn changes_x<R: Real, const D: usize, const ENERGY: bool, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    row: RowAt<D>,
    place: usize,
    work: &mut Work<'_, R, D>,
    report: &mut Report<R, D>,
) {
    let (n, m) = (slab.size.n, slab.size.m);
    let flux = &*work.flux;
    count_inflow::<R, D, ENERGY, MIXED>(slab, (0, 0), row, (flux, work.right), 0..1, report);
    count_inflow::<R, D, ENERGY, MIXED>(slab, (0, 1), row, (flux, work.left), n..m, report);
    if slab.walls.is_some() {
        tell_walls(slab, (0, row.at), [work.left, work.right], flux, [true; 2]);
    }
    let inv = &*work.coefficients.inv_width;
    let weight = half_weight(slab, 0, 0, &mut *work.coefficients.spare);
    rows::differences::<R, D, ENERGY>(
        0,
        |v| &var(flux, v, m)[..n],
        |v| &var(flux, v, m)[1..],
        |i| inv[i],
        weight,
        &mut work.change[0][slab.changes(0, place)],
        n,
    );
    let out = &mut work.change[0][slab.changes(0, place)];
    changes_apart(slab, (0, row), [(flux, m); 2], &|i| inv[i], out);
    if MIXED {
        let carried = |v: usize| Carried { volume: &var(flux, D + 3, m)[v..], capacity: &var(flux, D + 4, m)[v..] };
        let own = &slab.old.capacity[row.start..];
        let out = &mut work.change[0][slab.changes(0, place)][(D + 2) * n..];
        mixed::differences(own, carried(0), carried(1), |i| inv[i], out);
    }
}

/// Tells the watched cells below and above a row of faces along axis `d`, as far as they are `own`, what the fluxes do to their walls. `at` is the cell
/// above the first face. Apart, so that a step that watches nothing does not hold it on the stack.
#[cold]
#[inline(never)]
fn tell_walls<R: Real, const D: usize>(
    slab: &Slab<'_, R, D>,
    (d, at): (usize, [usize; D]),
    states: [&[R]; 2],
    flux: &[R],
    own: [bool; 2],
) {
    let Some(walls) = slab.walls else { return };
    let n = if d == 0 { slab.size.m } else { slab.size.n };
    let faces = FaceRow { d, at, states, flux, n };
    for high in [true, false] {
        if !own[usize::from(!high)] {
            continue;
        }
        let mut of_row = at;
        // Along a row both cells beside a face are in it.
        if high && d > 0 {
            of_row[d] = at[d].wrapping_sub(1);
        }
        let face = usize::from(high && d == 0);
        (walls.at_faces)(slab, &faces, CellsBeside { start: slab.problem.mesh.index(of_row), face, high });
    }
}

/// The states beyond both ends of a row: of the other end, or ghosts.
fn states_at_ends<R: Real, const D: usize, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    row: RowAt<D>,
    work: &mut Work<'_, R, D>,
) {
    let (n, m) = (slab.size.n, slab.size.m);
    // Capacities on the low and the high side, inside and outside.
    let (low, high) = ((D + 3) * m, (D + 3) * m + n);
    let gases = [slab.gas_of::<MIXED>(work.right, low), slab.gas_of::<MIXED>(work.left, high)];
    if MIXED {
        let inside = [work.right[low], work.left[high]];
        let beyond = |high: bool| slab.problem.capacity_beyond((0, high), row.at, inside[usize::from(high)]);
        let [a, b] = if slab.periodic[0] { [inside[1], inside[0]] } else { [false, true].map(beyond) };
        (work.left[low], work.right[high]) = (a, b);
    }
    let inner_low = rows::face_state::<R, D>(work.right, m, 0);
    let inner_high = rows::face_state::<R, D>(work.left, m, n);
    let (of_low, of_high) = (work.right[(D + 2) * m], work.left[(D + 2) * m + n]);
    let (low, high) = if slab.periodic[0] {
        ((inner_high, of_high), (inner_low, of_low))
    } else {
        let [a, b] = [false, true].map(|high| slab.problem.side(0, high, row.at));
        let mut last = row.at;
        last[0] = n - 1;
        let low = ghost_beyond((slab, a), (0, false, row.at), &inner_low, gases[0]);
        let high = ghost_beyond((slab, b), (0, true, last), &inner_high, gases[1]);
        ((low, middle(a, of_low, &low)), (high, middle(b, of_high, &high)))
    };
    rows::put_state(work.left, m, 0, &low.0);
    work.left[(D + 2) * m] = low.1;
    rows::put_state(work.right, m, n, &high.0);
    work.right[(D + 2) * m + n] = high.1;
}

/// Pressure in the middle of the cell beyond a side of the domain, from that of the cell inside: a wall mirrors it.
fn middle<R: Real, const D: usize>(side: &Boundary<R, D>, inside: R, ghost: &Primitive<R, D>) -> R {
    if side.is_wall() { inside } else { ghost.pressure }
}

/// Writes the pace of each face normal to axis `d` in a row: the time step over the smaller width beside it, times its open fraction `face` over the
/// smaller open fraction of both cells. Infinite on sides of the domain that are neither walls nor periodic, so that the plain flux acts there. `at`
/// is the cell above the first face.
fn paces<R: Real, const D: usize>(slab: &Slab<'_, R, D>, d: usize, at: [usize; D], face: Option<&[R]>, pace: &mut [R]) {
    let (mesh, n) = (&slab.problem.mesh, slab.size.n);
    let widths = mesh.widths[d];
    let (cells, periodic) = (widths.len(), slab.periodic[d]);
    // Beyond an end lies the other one of a periodic axis, else the cell at this one.
    let beyond = |other: usize, own: usize| if periodic { other } else { own };
    let above = |k: usize| if k < cells { k } else { beyond(0, cells - 1) };
    let below = |k: usize| if k > 0 { k - 1 } else { beyond(cells - 1, 0) };
    if slab.even[d] {
        pace.fill(slab.dt / widths[0]);
    } else if d == 0 {
        for (i, pace) in pace.iter_mut().enumerate() {
            *pace = slab.dt / R::smaller(widths[below(i)], widths[above(i)]);
        }
    } else {
        pace.fill(slab.dt / R::smaller(widths[below(at[d])], widths[above(at[d])]));
    }
    if let (Some(medium), Some(face)) = (&slab.medium, face) {
        let volume = medium.porosity.volume;
        let row = |k: usize| {
            let mut a = at;
            a[d] = k;
            mesh.index(a)
        };
        if d == 0 {
            let volume = &volume[mesh.index(at)..][..n];
            for i in [0, n] {
                pace[i] = tightened(pace[i], face[i], volume[below(i)], volume[above(i)]);
            }
            let beside = volume.iter().zip(&volume[1..]);
            for ((pace, open), (low, high)) in pace[1..n].iter_mut().zip(&face[1..n]).zip(beside) {
                *pace = tightened(*pace, *open, *low, *high);
            }
        } else {
            let [low, high] = [below(at[d]), above(at[d])].map(|k| &volume[row(k)..][..n]);
            for ((pace, open), (low, high)) in pace.iter_mut().zip(face).zip(low.iter().zip(high)) {
                *pace = tightened(*pace, *open, *low, *high);
            }
        }
    }
    if periodic {
        return;
    }
    let given = |high: bool, at: [usize; D]| !slab.problem.side(d, high, at).is_wall();
    if d == 0 {
        for (i, high) in [(0, false), (cells, true)] {
            if given(high, at) {
                pace[i] = R::INFINITY;
            }
        }
    } else if at[d] == 0 || at[d] == cells {
        for (i, pace) in pace.iter_mut().enumerate() {
            let mut beside = at;
            beside[0] = i;
            if given(at[d] > 0, beside) {
                *pace = R::INFINITY;
            }
        }
    }
}

/// ½ g dx of the cells of a row along `d`, where its place is `k`, if gravity acts there.
fn half_weight<'s, R: Real, const D: usize>(
    slab: &Slab<'_, R, D>,
    d: usize,
    k: usize,
    spare: &'s mut [R],
) -> Option<&'s [R]> {
    let half_g = R::HALF * slab.problem.gravity[d];
    if half_g == R::ZERO {
        return None;
    }
    let spare = &mut spare[..slab.size.n];
    let widths = slab.problem.mesh.widths[d];
    for (i, s) in spare.iter_mut().enumerate() {
        *s = half_g * widths[if d == 0 { i } else { k }];
    }
    Some(spare)
}

/// Fluxes of a row of faces across axis `d` > 0 between `left` and `right`, into `flux`. `at` names the row of cells above the faces,
/// with `at[d]` one past the end at the upper boundary.
fn fluxes_of_faces<R: Real, const D: usize, const ENERGY: bool, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    d: usize,
    at: [usize; D],
    [left, right]: [&[R]; 2],
    (seen, contractions): (Pressures<'_, R>, Contractions<'_, R>),
    (flux, pace, strength): (&mut [R], &mut [R], &mut [R]),
) {
    let n = slab.size.n;
    let (k, cells) = (at[d], slab.problem.mesh.cells()[d]);
    let row_of = |k: usize| {
        let mut a = at;
        a[d] = k;
        slab.problem.mesh.index(a)
    };
    // Beyond an end lies the other one of a periodic axis, else the row at this one.
    let beyond = |other: usize, own: usize| if slab.periodic[d] { other } else { own };
    let above = row_of(if k < cells { k } else { beyond(0, cells - 1) });
    let below = row_of(if k > 0 { k - 1 } else { beyond(cells - 1, 0) });
    let openings = match &slab.medium {
        None => Openings::None,
        Some(medium) => {
            let face = &medium.porosity.faces[d][medium.mesh.face(d, at)..][..n];
            match slab.problem.scheme.pressure {
                PressureForm::Geometric => Openings::Geometric(face),
                PressureForm::Paper => {
                    let volume = medium.porosity.volume;
                    Openings::Paper(face, &volume[below..][..n], &volume[above..][..n])
                }
            }
        }
    };
    let pace = &mut pace[..n];
    if slab.solver.low_mach {
        paces(slab, d, at, openings.face(), pace);
    }
    (slab.solver.row)([left, right], openings, &slab.face_gas, pace, flux);
    fluxes_along_shocks(slab, (d, at), seen, ([left, right], openings), &mut strength[..n], flux);
    if let Some(medium) = &slab.medium {
        let (start, bit) = if k < cells { (row_of(k), break_low(d)) } else { (row_of(cells - 1), break_high(d)) };
        let broken = marked(&medium.porosity.marks[start..][..n], bit);
        let flux = FluxBlock { values: flux, n };
        fluxes_at_breaks::<R, D, MIXED>(slab, (d, at), contractions, broken, [left, right], flux);
    }
    positive_fluxes::<R, D, ENERGY, MIXED>(slab, d, at, [left, right], FluxBlock { values: flux, n });
}

/// Ghost states beside the boundary faces of axis `d` > 0 of the row from `at` on, from the inner face states.
fn ghosts<R: Real, const D: usize, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    (d, low): (usize, bool),
    mut at: [usize; D],
    inner: &[R],
    out: &mut [R],
) {
    let n = slab.size.n;
    // From one past the end to the cell inside.
    at[d] -= usize::from(!low);
    for i in 0..n {
        at[0] = i;
        let boundary = slab.problem.side(d, !low, at);
        let gas = slab.gas_of::<MIXED>(inner, (D + 3) * n + i);
        let w = ghost_beyond((slab, boundary), (d, !low, at), &rows::face_state::<R, D>(inner, n, i), gas);
        rows::put_state(out, n, i, &w);
        if MIXED {
            out[(D + 3) * n + i] = slab.problem.capacity_beyond((d, !low), at, inner[(D + 3) * n + i]);
        }
        out[(D + 2) * n + i] = middle(boundary, inner[(D + 2) * n + i], &w);
    }
}

/// Faces between row `j` and the row below it along axis 1 of a 3D mesh; `present` tells whether there is a row `j`.
pub(in crate::flow) fn fluxes_across_rows<R: Real, const D: usize, const ENERGY: bool, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    (layer, j): (usize, isize),
    present: bool,
    work: &mut Work<'_, R, D>,
    report: &mut Report<R, D>,
) {
    let d = 1 % D;
    let mut at = [0; D];
    at[D - 1] = layer;
    at[d] = j as usize;
    let mut below = core::mem::take(&mut work.below_row);
    let changed = (j > slab.rows.start as isize).then(|| slab.place(j - 1));
    let own = present && j < slab.rows.end as isize;
    let faces = FacesUnder { d, at, present, own, changed };
    fluxes_under::<R, D, ENERGY, MIXED>(slab, faces, (below.state, below.flux), work, report);
    core::mem::swap(&mut below, &mut work.below_row);
}

/// Faces between row `j` of layer `l` and of the layer below; `present` tells whether there is a layer `l`.
pub(in crate::flow) fn fluxes_across_layers<R: Real, const D: usize, const ENERGY: bool, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    (l, j): (isize, isize),
    present: bool,
    work: &mut Work<'_, R, D>,
    report: &mut Report<R, D>,
) {
    let f = slab.size.face * slab.size.n;
    let mut at = [0; D];
    if D == 3 {
        at[1] = j as usize;
    }
    at[D - 1] = l as usize;
    let mut below = core::mem::take(&mut work.below_layer);
    let place = slab.place(j);
    let of_row = (&mut below.state[place * f..][..f], &mut below.flux[place * f..][..f]);
    let changed = (l > slab.layers.start as isize).then_some(place);
    let own = present && l < slab.layers.end as isize;
    let faces = FacesUnder { d: D - 1, at, present, own, changed };
    fluxes_under::<R, D, ENERGY, MIXED>(slab, faces, of_row, work, report);
    core::mem::swap(&mut below, &mut work.below_layer);
}

/// The faces under a row along an axis other than its own.
struct FacesUnder<const D: usize> {
    /// Axis, above 0.
    d: usize,
    /// Indices of the row, `at[d]` one past the end at the upper boundary.
    at: [usize; D],
    /// The row exists; else the boundary does.
    present: bool,
    /// The row is advanced.
    own: bool,
    /// Place in the tile of the row below, if that is advanced: it now has the fluxes on both of its sides.
    changed: Option<usize>,
}

/// Fluxes through the faces under a row, from the high face states of the row below; then, if that row is advanced, the changes they make
/// in it. `below_flux` holds the fluxes under that row, and afterwards the new ones.
fn fluxes_under<R: Real, const D: usize, const ENERGY: bool, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    FacesUnder { d, at, present, own, changed }: FacesUnder<D>,
    (below_state, below_flux): (&mut [R], &mut [R]),
    work: &mut Work<'_, R, D>,
    report: &mut Report<R, D>,
) {
    let (n, f) = (slab.size.n, slab.size.face * slab.size.n);
    let mesh = &slab.problem.mesh;
    if present {
        let from = (&*work.half, &*work.slope[d], &*work.coefficients.weight[d]);
        states::<R, D, MIXED>(slab, false, d, from, Faces { block: &mut work.right[..f], stride: n, offset: 0 });
        if at[d] == 0 && !slab.periodic[d] {
            ghosts::<R, D, MIXED>(slab, (d, true), at, &work.right[..f], below_state);
        }
    } else {
        ghosts::<R, D, MIXED>(slab, (d, false), at, below_state, &mut work.right[..f]);
    }
    let seen = Pressures { window: work.window, ranges: work.ranges };
    let contractions = Contractions::new(slab, work.contractions, work.window);
    let to = (&mut work.flux[..f], &mut *work.coefficients.pace, &mut *work.strength);
    fluxes_of_faces::<R, D, ENERGY, MIXED>(slab, d, at, [below_state, &work.right[..f]], (seen, contractions), to);
    let last = mesh.cells()[d];
    for (side, edge, inside) in [(0, 0, 0), (1, last, last - 1)] {
        if at[d] == edge {
            let mut of_row = at;
            of_row[d] = inside;
            let row = RowAt { start: mesh.index(of_row), at: of_row };
            let wall = if side == 0 { &work.right[..f] } else { &*below_state };
            count_inflow::<R, D, ENERGY, MIXED>(slab, (d, side), row, (&work.flux[..f], wall), 0..n, report);
        }
    }
    if slab.walls.is_some() {
        tell_walls(slab, (d, at), [below_state, &work.right[..f]], &work.flux[..f], [changed.is_some(), own]);
    }
    if let Some(place) = changed {
        let below = at[d] - 1;
        let inv = R::ONE / mesh.widths[d][below];
        let weight = half_weight(slab, d, below, &mut *work.coefficients.spare);
        let (low, high) = (&*below_flux, &work.flux[..f]);
        rows::differences::<R, D, ENERGY>(
            d,
            |v| var(low, v, n),
            |v| var(high, v, n),
            |_| inv,
            weight,
            &mut work.change[d][slab.changes(d, place)],
            n,
        );
        let mut of_row = at;
        of_row[d] = below;
        let row = RowAt { start: mesh.index(of_row), at: of_row };
        let out = &mut work.change[d][slab.changes(d, place)];
        changes_apart(slab, (d, row), [(low, n), (high, n)], &|_| inv, out);
        if MIXED {
            let own = &slab.old.capacity[row.start..];
            let carried = |flux| Carried { volume: var(flux, D + 3, n), capacity: var(flux, D + 4, n) };
            let out = &mut work.change[d][slab.changes(d, place)][(D + 2) * n..];
            mixed::differences(own, carried(low), carried(high), |_| inv, out);
        }
    }
    below_flux.copy_from_slice(&work.flux[..f]);
}

/// Leaves the high face states of the present row for the row above it.
pub(in crate::flow) fn keep_for_row_above<R: Real, const D: usize, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    work: &mut Work<'_, R, D>,
) {
    let (n, d) = (slab.size.n, 1 % D);
    let from = (&*work.half, &*work.slope[d], &*work.coefficients.weight[d]);
    let block = &mut work.below_row.state[..slab.size.face * n];
    states::<R, D, MIXED>(slab, true, d, from, Faces { block, stride: n, offset: 0 });
}

/// Leaves the high face states of the present row, at a place of its tile, for the layer above it.
pub(in crate::flow) fn keep_for_layer_above<R: Real, const D: usize, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    place: usize,
    work: &mut Work<'_, R, D>,
) {
    let (n, f) = (slab.size.n, slab.size.face * slab.size.n);
    let from = (&*work.half, &*work.slope[D - 1], &*work.coefficients.weight[D - 1]);
    let block = &mut work.below_layer.state[place * f..][..f];
    states::<R, D, MIXED>(slab, true, D - 1, from, Faces { block, stride: n, offset: 0 });
}

/// Adds what enters through some boundary faces of a flux block, beside cells of `row` on a side (axis, 0 low or 1 high) of the domain;
/// `wall` is the block of face states inside, whose reference pressure the flux is counted from.
fn count_inflow<R: Real, const D: usize, const ENERGY: bool, const MIXED: bool>(
    slab: &Slab<'_, R, D>,
    (d, side): (usize, usize),
    row: RowAt<D>,
    (flux, wall): (&[R], &[R]),
    faces: Range<usize>,
    report: &mut Report<R, D>,
) {
    let m = if d == 0 { slab.size.m } else { slab.size.n };
    let sign = if side == 0 { slab.dt } else { -slab.dt };
    let normal = if side == 0 { D + 2 } else { 1 };
    let mut total = Conserved { density: R::ZERO, momentum: [R::ZERO; D], energy: R::ZERO };
    for face in faces {
        let mut at = row.at;
        if d != 0 {
            at[0] = face;
        } else if side == 1 {
            at[0] = slab.size.n - 1;
        }
        let area = slab.problem.mesh.volume(at) / slab.problem.mesh.widths[d][at[d]];
        let weight = sign * area;
        let open = match &slab.medium {
            None => R::ONE,
            Some(medium) => {
                let (low, high) = medium.ducts(d, at).openings(0);
                if side == 0 { low } else { high }
            }
        };
        // A closed face is a wall, not a side to come in by.
        if open == R::ZERO {
            continue;
        }
        let through = |v: usize| weight * flux[v * m + face];
        total.density += through(0);
        let mut momentum = [R::ZERO; D];
        momentum[0] = weight * (flux[normal * m + face] + open * wall[(D + 2) * m + face]);
        // What the cell above a broken face gains along it is not what the cell below loses.
        let cell = row.start + if d == 0 { 0 } else { face };
        let breaks = |medium: &Medium<'_, R, D>| is(medium.porosity.marks[cell], break_low(d));
        let is_apart = side == 0 && slab.medium.as_ref().is_some_and(breaks);
        for c in 1..D {
            momentum[c] = through(if is_apart { apart(c, D, MIXED) } else { 1 + c });
        }
        let momentum = rotate_back(momentum, d);
        for c in 0..D {
            total.momentum[c] += momentum[c];
        }
        if ENERGY {
            total.energy += through(D + 1);
        }
    }
    report.inflow[d][side].add(&total);
}
