//! The union of solids by formula in one cell or face in which some of them meet.

use super::pairs::TOUCHING;
use super::solid::{FormulaSolid, Kind};
use glam::DVec3;
use voidage_core::grid::Grid;
use voidage_core::grid::bounds::Bounds;
use voidage_core::grid::cell_range::{CellRange, RangeKind};
use voidage_core::number::aabb::Aabb;
use voidage_core::solids::enclosure::{UnionEffort, union_bounds};
use voidage_core::solids::quadric::{QuadricSolid, share_of_union};

/// How many solids are looked at in a cell before sections are tried; and at most.
pub(super) const FIRST: usize = 1 << 15;
const MOST: usize = 1 << 21;

/// So many times each of many solids may be looked at likewise.
const FIRST_OF_EACH: usize = 1 << 6;
const MOST_OF_EACH: usize = 1 << 12;

/// Where bounds come close enough by that, so many times as many.
const MORE: usize = 4;

/// So many parts of solids, a capsule having three, have few enough sets that sections tell what each of these has in common sooner than planes do.
const FEW: usize = 6;

/// How many slices sections may take before planes are tried.
const FIRST_SLICES: usize = 1 << 14;

/// Bounds of the union of some solids in one cell or face, from what is known of it and the sum of their shares; about `tol` apart. Sections of
/// faces are exact, and best for what few solids have in common; planes for more solids, and for tori. The union of balls has a closed form.
pub(super) fn union_of(
    solids: &[&FormulaSolid],
    cell: Aabb<DVec3>,
    (known, sum): (Bounds<f64>, Bounds<f64>),
    tol: f64,
) -> Bounds<f64> {
    let sides = [0, 1, 2].map(|n| [cell.min[n], cell.max[n]]);
    let by_planes = |most: usize, more: usize| Some(union_bounds(solids, sides, sum, UnionEffort { tol, most, more }));
    let by_sections = |most: usize| by_sections(solids, (sum, cell), tol, most);
    let (few_slices, all_slices) = (|| by_sections(FIRST_SLICES), || by_sections(usize::MAX));
    let count = solids.len();
    let (first, most) = (FIRST.max(FIRST_OF_EACH * count), MOST.max(MOST_OF_EACH * count));
    let (few_planes, all_planes) = (|| by_planes(first, 1), || by_planes(most, MORE));
    let parts = || solids.iter().map(|solid| solid.part_count()).sum::<usize>();
    let are_balls = || solids.iter().all(|solid| matches!(&solid.kind, Kind::Quadric(ball, _) if ball.is_ball()));
    let sections_first = cell.size().min_element() == 0.0 || parts() <= FEW || are_balls();
    let ways: [&dyn Fn() -> Option<Bounds<f64>>; 4] = if sections_first {
        [&few_slices, &few_planes, &all_slices, &all_planes]
    } else {
        [&few_planes, &few_slices, &all_planes, &all_slices]
    };
    let mut found = known;
    for way in ways {
        found = way().map_or(found, |more| narrowed(found, more));
        if found.gap() <= tol {
            break;
        }
    }
    found
}

/// The union of solids of which all have closed forms, by what they have in common; `sum` is that of their shares. None if there are too many of
/// them, or it takes more slices than `most`.
fn by_sections(
    solids: &[&FormulaSolid],
    (sum, cell): (Bounds<f64>, Aabb<DVec3>),
    tol: f64,
    most: usize,
) -> Option<Bounds<f64>> {
    fn quadric<'s>(s: &&'s FormulaSolid) -> Option<&'s QuadricSolid> {
        match &s.kind {
            Kind::Quadric(solid, _) => Some(solid),
            Kind::Torus(..) => None,
        }
    }
    let quadrics: Vec<&QuadricSolid> = solids.iter().map(quadric).collect::<Option<_>>()?;
    let sides = [0, 1, 2].map(|n| [cell.min[n], cell.max[n]]);
    share_of_union(quadrics, sides, sum, tol, most)
}

/// Does a solid end in the plane of a face? Where two touch without that, their sections share no area.
pub(super) fn ends_at(bounds: &Aabb<DVec3>, grid: &Grid<f64>, kind: RangeKind, range: CellRange) -> bool {
    let RangeKind::Faces(axis) = kind else { return false };
    let Some(&plane) = grid.edges(axis).get(range.lo[axis.min(2)] as usize) else { return true };
    ends_in(bounds, axis.min(2), plane)
}

/// Does a solid end in a plane across an axis?
pub(super) fn ends_in(bounds: &Aabb<DVec3>, axis: usize, plane: f64) -> bool {
    let (low, high) = (bounds.min[axis], bounds.max[axis]);
    let near = TOUCHING * (high - low + plane.abs());
    (low - plane).abs() <= near || (high - plane).abs() <= near
}

/// Are all that the solids have of a face discs about one centre but for rounding, flat ends in its plane? Then the largest holds the others, but
/// for the share of the face that is told.
pub(super) fn concentric(solids: &[&FormulaSolid], grid: &Grid<f64>, kind: RangeKind, range: CellRange) -> Option<f64> {
    let RangeKind::Faces(axis) = kind else { return None };
    let &plane = grid.edges(axis).get(range.lo[axis.min(2)] as usize)?;
    let mut first: Option<DVec3> = None;
    let mut beside = 0.0;
    for solid in solids {
        let &(center, radius) = solid.ends_in_plane(axis, plane).first()?;
        let off = first.get_or_insert(center).distance(center);
        if off > TOUCHING * radius {
            return None;
        }
        beside += 4.0 * off * radius;
    }
    let size = box_of(grid, kind, range)?.size();
    let area: f64 = (0..3).filter(|&n| n != axis).map(|n| size[n]).product();
    first.map(|_| beside / area)
}

/// A single cell or face.
pub(super) fn box_of(grid: &Grid<f64>, kind: RangeKind, range: CellRange) -> Option<Aabb<DVec3>> {
    let mut cell = Aabb { min: DVec3::ZERO, max: DVec3::ZERO };
    for axis in 0..3 {
        let at = range.lo[axis] as usize;
        cell.min[axis] = *grid.edges(axis).get(at)?;
        cell.max[axis] = if kind == RangeKind::Faces(axis) { cell.min[axis] } else { *grid.edges(axis).get(at + 1)? };
    }
    Some(cell)
}

/// What both pairs of bounds say. Where they contradict each other by rounding, what lies between them: neither is nearer the truth.
pub(super) fn narrowed(a: Bounds<f64>, b: Bounds<f64>) -> Bounds<f64> {
    let (lower, upper) = (a.lower.max(b.lower), a.upper.min(b.upper));
    Bounds { lower: lower.min(upper), upper: lower.max(upper) }
}

#[cfg(test)]
mod tests {
    use super::{Bounds, narrowed};

    #[test]
    fn bounds_that_contradict_each_other_leave_what_lies_between_them() {
        let bounds = |lower, upper| Bounds { lower, upper };
        assert_eq!(narrowed(bounds(0.0, 0.5), bounds(0.25, 1.0)), bounds(0.25, 0.5));
        let (below, above) = (bounds(0.125, 0.25), bounds(0.5, 0.625));
        assert_eq!(narrowed(below, above), bounds(0.25, 0.5));
        assert_eq!(narrowed(above, below), bounds(0.25, 0.5));
    }
}
