//! A long line of cells in pieces, so that the scratch of a one-dimensional problem does not grow with it.
//!
//! A piece is a problem of its own on the slices of its cells and two more on each side: the new state of a cell follows from
//! the four cells beside it. What the two outer cells make of the missing neighbours is thrown away. Where a periodic line
//! closes, the eight cells around the seam are copied together first.

use crate::flow::boundary::Boundary;
use crate::flow::drag::Drag;
use crate::flow::kernel::scratch::PIECE;
use crate::flow::kernel::slab::Part;
use crate::flow::kernel::sweep::{self, Sweep};
use crate::flow::porosity::fractions::{Mesh, Porosity};
use crate::flow::problem::Problem;
use crate::flow::state::{Fields, FieldsMut};
use crate::flow::step_report::Report;
use crate::number::real::Real;
use core::ops::Range;

/// Cells that a piece holds beyond its own on each side.
const BESIDE: usize = 2;
/// Cells around the seam of a periodic line; the middle half is advanced.
const SEAM: usize = 4 * BESIDE;

/// Advances a line piece by piece. `scratch` holds the new state of a piece and then what a piece needs.
pub(in crate::flow) fn advance<R: Real, const D: usize>(
    line: &Problem<'_, R, D>,
    whole: &Part<'_, R, D>,
    new: &mut FieldsMut<'_, R, D>,
    scratch: &mut [R],
    by: Sweep<R, D>,
    report: &mut Report<R, D>,
) {
    let n = line.mesh.len();
    let periodic = line.periodic()[0];
    let (mut begin, end) = if periodic { (BESIDE, n - BESIDE) } else { (0, n) };
    while begin < end {
        let own = begin..end.min(begin + PIECE - 2 * BESIDE);
        let cells = own.start.saturating_sub(BESIDE)..n.min(own.end + BESIDE);
        let reported = own.start - cells.start..own.end - cells.start;
        let old = part_of(whole.old, cells.clone());
        let first_order = whole.first_order.map(|f| &f[cells.clone()]);
        let (walls, first) = (whole.walls, cells.start);
        let part = Part { old: &old, dt: whole.dt, first_order, layers: 0..1, reported, walls, first };
        let mut of_piece = advance_piece(&piece(line, cells.clone()), &part, own.clone(), new, scratch, by);
        for (side, outer) in [(0, cells.start == 0), (1, cells.end == n)] {
            if !outer || periodic {
                of_piece.inflow[0][side] = Report::new().inflow[0][side];
            }
        }
        *report = report.and(&of_piece);
        begin = own.end;
    }
    if periodic {
        *report = report.and(&advance_seam(line, whole, new, scratch, by));
    }
}

/// The problem on a range of the cells of a line.
fn piece<'p, R: Real, const D: usize>(line: &Problem<'p, R, D>, cells: Range<usize>) -> Problem<'p, R, D> {
    let n = line.mesh.len();
    let part = |s: &'p [R]| if s.is_empty() { s } else { &s[cells.clone()] };
    let mut boundaries = line.boundaries;
    for (side, outer) in [(0, cells.start == 0), (1, cells.end == n)] {
        if !outer || boundaries[0][side].is_periodic() {
            boundaries[0][side] = Boundary::ZeroGradient;
        }
    }
    Problem {
        mesh: Mesh { widths: line.mesh.widths.map(|w| &w[cells.clone()]) },
        boundaries,
        porosity: line.porosity.map(|p| Porosity {
            volume: &p.volume[cells.clone()],
            faces: p.faces.map(|f| &f[cells.start..=cells.end]),
            marks: &p.marks[cells.clone()],
        }),
        drag: line.drag.map(|d| Drag { quadratic: d.quadratic.map(part), linear: d.linear.map(part) }),
        ..*line
    }
}

/// Advances a piece that is a problem of its own and keeps the new states of its `own` cells of the line, which are those it
/// reports of.
fn advance_piece<R: Real, const D: usize>(
    piece: &Problem<'_, R, D>,
    part: &Part<'_, R, D>,
    own: Range<usize>,
    new: &mut FieldsMut<'_, R, D>,
    scratch: &mut [R],
    by: Sweep<R, D>,
) -> Report<R, D> {
    let inner = &part.reported;
    let (mut held, scratch) = take_field::<R, D>(scratch, piece.mesh.len(), present_in(part.old));
    let mut report = Report::new();
    sweep::advance(piece, part, &mut held, scratch, by, &mut report);
    new.density[own.clone()].copy_from_slice(&held.density[inner.clone()]);
    for (new, held) in new.momentum.iter_mut().zip(&held.momentum) {
        new[own.clone()].copy_from_slice(&held[inner.clone()]);
    }
    for (new, held) in [(&mut *new.energy, &*held.energy), (&mut *new.capacity, &*held.capacity)] {
        if !(new.is_empty() || held.is_empty()) {
            new[own.clone()].copy_from_slice(&held[inner.clone()]);
        }
    }
    report
}

/// Advances the cells on both sides of the seam of a periodic line.
fn advance_seam<R: Real, const D: usize>(
    line: &Problem<'_, R, D>,
    whole: &Part<'_, R, D>,
    new: &mut FieldsMut<'_, R, D>,
    scratch: &mut [R],
    by: Sweep<R, D>,
) -> Report<R, D> {
    let n = line.mesh.len();
    let half = SEAM / 2;
    let place = |i: usize| (n - half + i) % n;
    let gather =
        |s: &[R]| -> [R; SEAM] { if s.is_empty() { [R::ZERO; SEAM] } else { core::array::from_fn(|i| s[place(i)]) } };
    let bytes = |s: &[u8]| -> [u8; SEAM] { core::array::from_fn(|i| s[place(i)]) };
    let present = |s: &[R]| if s.is_empty() { 0 } else { SEAM };
    let widths = line.mesh.widths.map(gather);
    let old = whole.old;
    let (density, momentum, energy) = (gather(old.density), old.momentum.map(gather), gather(old.energy));
    let capacity = gather(old.capacity);
    let none = (&[][..], [&[][..]; D], &[][..]);
    let (volume, faces, marks) = line.porosity.map_or(none, |p| (p.volume, p.faces, p.marks));
    let (porous, volume) = (!volume.is_empty(), gather(volume));
    let faces: [[R; SEAM + 1]; D] = faces.map(|f| {
        let of = |i: usize| if i < half { n - half + i } else { i - half };
        core::array::from_fn(|i| if porous { f[of(i)] } else { R::ZERO })
    });
    let marks = if porous { bytes(marks) } else { [0; SEAM] };
    let lengths = line.drag.map(|d| (d.quadratic.map(present), d.linear.map(present)));
    let drags = line.drag.map(|d| (d.quadratic.map(gather), d.linear.map(gather)));
    let drag = drags.as_ref().zip(lengths).map(|((q, l), (some_q, some_l))| Drag {
        quadratic: core::array::from_fn(|d| &q[d][..some_q[d]]),
        linear: core::array::from_fn(|d| &l[d][..some_l[d]]),
    });
    let seam = Problem {
        mesh: Mesh { widths: widths.each_ref().map(|w| &w[..]) },
        boundaries: line.boundaries.map(|_| [Boundary::ZeroGradient; 2]),
        porosity: porous.then(|| Porosity { volume: &volume, faces: faces.each_ref().map(|f| &f[..]), marks: &marks }),
        drag,
        ..*line
    };
    let old = Fields {
        density: &density,
        momentum: momentum.each_ref().map(|m| &m[..]),
        energy: &energy[..present(old.energy)],
        capacity: &capacity[..present(old.capacity)],
    };
    let asked = whole.first_order.map(bytes);
    let first_order = asked.as_ref().map(|a| &a[..]);
    let (mut held, scratch) = take_field::<R, D>(scratch, SEAM, present_in(&old));
    let inner = BESIDE..SEAM - BESIDE;
    let (walls, first, reported) = (whole.walls, n - half, inner.clone());
    let part = Part { old: &old, dt: whole.dt, first_order, layers: 0..1, reported, walls, first };
    let mut report = Report::new();
    sweep::advance(&seam, &part, &mut held, scratch, by, &mut report);
    for i in inner {
        new.set(place(i), &held.at(i));
        if let Some((new, held)) = new.capacity.get_mut(place(i)).zip(held.capacity.get(i)) {
            *new = *held;
        }
    }
    report.inflow = Report::new().inflow;
    report
}

/// A range of a field.
fn part_of<'a, R: Real, const D: usize>(field: &Fields<'a, R, D>, cells: Range<usize>) -> Fields<'a, R, D> {
    let part = |s: &'a [R]| if s.is_empty() { s } else { &s[cells.clone()] };
    Fields {
        density: part(field.density),
        momentum: field.momentum.map(part),
        energy: part(field.energy),
        capacity: part(field.capacity),
    }
}

/// Whether a field has an energy, and capacities.
fn present_in<R: Real, const D: usize>(field: &Fields<'_, R, D>) -> [bool; 2] {
    [!field.energy.is_empty(), !field.capacity.is_empty()]
}

/// A field of `n` cells from the front of the scratch, with an `energy` and `capacities` or without, and what remains of the scratch.
fn take_field<R: Real, const D: usize>(
    scratch: &mut [R],
    n: usize,
    [energy, capacities]: [bool; 2],
) -> (FieldsMut<'_, R, D>, &mut [R]) {
    let mut rest = scratch;
    let mut take = |n: usize| {
        let (piece, after) = core::mem::take(&mut rest).split_at_mut(n);
        rest = after;
        piece
    };
    let field = FieldsMut {
        density: take(n),
        momentum: core::array::from_fn(|_| take(n)),
        energy: take(if energy { n } else { 0 }),
        capacity: take(if capacities { n } else { 0 }),
    };
    (field, rest)
}
