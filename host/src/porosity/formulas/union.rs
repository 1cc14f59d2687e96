//! The union of solids by formula in one cell or face in which some of them meet.

use super::pairs::TOUCHING;
use super::solid::{BELIEVED, FormulaSolid, Kind};
use glam::DVec3;
use voidage_core::grid::Grid;
use voidage_core::grid::bounds::Bounds;
use voidage_core::grid::cell_range::{CellRange, RangeKind};
use voidage_core::number::aabb::Aabb;
use voidage_core::quadric::{QuadricSolid, share_of_union};
use voidage_core::subdivide::SubdivisionRule;

/// The union of solids of which all have closed forms, by what they have in common; `sum` is that of their shares. None if there are too many of
/// them.
pub(super) fn by_sections(
    solids: &[&FormulaSolid],
    sum: Bounds<f64>,
    cell: Aabb<DVec3>,
    tol: f64,
) -> Option<Bounds<f64>> {
    fn quadric<'s>(s: &&'s FormulaSolid) -> Option<&'s QuadricSolid> {
        match &s.kind {
            Kind::Quadric(solid, _) => Some(solid),
            Kind::Torus(..) => None,
        }
    }
    let quadrics: Vec<&QuadricSolid> = solids.iter().map(quadric).collect::<Option<_>>()?;
    let sides = [0, 1, 2].map(|n| [cell.min[n], cell.max[n]]);
    share_of_union(quadrics, sides, sum, tol)
}

/// Does a solid end in the plane of a face? Where two touch without that, their sections share no area.
pub(super) fn ends_at(bounds: &Aabb<DVec3>, grid: &Grid<f64>, kind: RangeKind, range: CellRange) -> bool {
    let RangeKind::Faces(axis) = kind else { return false };
    let Some(&plane) = grid.edges(axis).get(range.lo[axis.min(2)] as usize) else { return true };
    let (low, high) = (bounds.min[axis.min(2)], bounds.max[axis.min(2)]);
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

/// Bounds of the union of some solids in one cell or face: shares of single ones are known, so only parts in which several have one are divided.
pub(super) fn divided(
    solids: &[&FormulaSolid],
    kind: RangeKind,
    cell: Aabb<DVec3>,
    rule: SubdivisionRule<f64>,
) -> Bounds<f64> {
    let mut found = Bounds { lower: 0.0, upper: 0.0 };
    let axes: Vec<usize> = (0..3).filter(|&n| kind != RangeKind::Faces(n)).collect();
    let mut waiting = vec![(cell, 0_u32)];
    let most = rule.depth.saturating_add(DEEPER);
    while let Some((part, depth)) = waiting.pop() {
        let weight = 0.5_f64.powi(depth as i32 * axes.len() as i32);
        let shares = solids.iter().map(|s| s.share(kind, part));
        let (lower, sum, several) = shares.fold((0.0_f64, 0.0, 0), |(lower, sum, several), share| {
            (lower.max(share.lower), sum + share.upper, several + usize::from(share.upper > 0.0))
        });
        let upper = f64::min(sum, 1.0);
        // Parts along a curve, two of each before: their gaps sum to about the tolerance.
        let room = rule.tol * 0.5_f64.powi(depth as i32) / 8.0;
        if several < 2 || lower >= 1.0 - BELIEVED || depth >= most || (upper - lower) * weight <= room {
            (found.lower, found.upper) = (found.lower + lower * weight, found.upper + upper * weight);
            continue;
        }
        let middle = (part.min + part.max) * 0.5;
        for n in 0..1_usize << axes.len() {
            let mut half = part;
            for (bit, &axis) in axes.iter().enumerate() {
                if n >> bit & 1 == 0 { half.max[axis] = middle[axis] } else { half.min[axis] = middle[axis] }
            }
            waiting.push((half, depth + 1));
        }
    }
    Bounds { lower: found.lower, upper: found.upper.min(1.0) }
}

/// How much deeper than others the unions with tori are divided: only along the curve in which two surfaces meet.
const DEEPER: u32 = 3;

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

/// What both pairs of bounds say; the first where they contradict each other by rounding.
pub(super) fn narrowed(a: Bounds<f64>, b: Bounds<f64>) -> Bounds<f64> {
    let both = Bounds { lower: a.lower.max(b.lower), upper: a.upper.min(b.upper) };
    if both.lower <= both.upper { both } else { Bounds { lower: a.lower, upper: a.lower } }
}
