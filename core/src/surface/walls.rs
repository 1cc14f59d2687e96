//! Faces in whose plane surface lies, shared by several bodies: a point of such a face is open only where both sides see it open.

use crate::grid::Grid;
use crate::grid::bounds::Bounds;
use crate::grid::fields::{Layer, gap};
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};
use crate::surface::bins::{Bins, Group};
use crate::surface::cell_unions::{union_with_others, with_least_blur};
use crate::surface::division::{Shared, Site, SpareMemory, find_parts};
use crate::surface::other_bodies::OtherBodies;
use crate::surface::refined::{WHOLE, known, narrow, rounding};
use crate::surface::union::{CellUnion, Limit, NoProof, UnionMemory, rounds_much};

/// Narrow the bounds of the shared faces of a layer that lie in walls: its x and y faces and the z faces below.
pub(super) fn resolve<V: Vector, O: OtherBodies<V>>(
    shared: &mut Shared<V, O>,
    site: &Site<V>,
    layer: &mut Layer<V::Scalar>,
    mut spare: SpareMemory<V>,
) {
    for axis in 0..3 {
        resolve_axis(shared, site, axis, site.k, layer, spare.reborrow());
    }
}

/// Narrow the bounds of the shared z faces above a layer, held in `layer`, that lie in walls.
pub(super) fn resolve_top<V: Vector, O: OtherBodies<V>>(
    shared: &mut Shared<V, O>,
    site: &Site<V>,
    layer: &mut Layer<V::Scalar>,
    spare: SpareMemory<V>,
) {
    resolve_axis(shared, site, 2, site.k + 1, layer, spare);
}

/// Narrow the bounds of the shared faces normal to one axis; `plane` is their index along z.
fn resolve_axis<V: Vector, O: OtherBodies<V>>(
    shared: &mut Shared<V, O>,
    site: &Site<V>,
    axis: usize,
    plane: usize,
    layer: &mut Layer<V::Scalar>,
    mut spare: SpareMemory<V>,
) {
    let [row, _, _] = site.grid.face_shape(axis);
    if !layer.has_surface.faces(axis).contains(&1) {
        return;
    }
    for f in 0..layer.has_surface.faces(axis).len() {
        let in_wall = layer.has_surface.faces(axis).get(f).is_some_and(|&s| s != 0);
        let (lowers, sums) = layer.faces_mut(axis);
        let (Some(lower), Some(sum)) = (lowers.get_mut(f), sums.get_mut(f)) else { continue };
        if in_wall && gap(*lower, *sum) > known() {
            let face = [f % row.max(1), f / row.max(1), plane];
            narrow(lower, sum, wall(shared, site, axis, face, spare.reborrow()));
        }
    }
}

/// Bounds of the union on a face from what both its cells see.
fn wall<V: Vector, O: OtherBodies<V>>(
    shared: &mut Shared<V, O>,
    site: &Site<V>,
    axis: usize,
    face: [usize; 3],
    spare: SpareMemory<V>,
) -> Bounds<V::Scalar> {
    let top = site.grid.cells()[2] - 1;
    let side = |below: bool| {
        // Beyond the outer planes the nearest layer knows all that touches them.
        let k = if axis == 2 && below { face[2].saturating_sub(1) } else { face[2].min(top) };
        let (cell, outside) = side_cell(site.grid, axis, face, below)?;
        Some(WallSide { cell, k, below, thin: outside.then_some(axis) })
    };
    let (Some(below), Some(above)) = (side(true), side(false)) else { return Bounds::UNKNOWN };
    let sides = [below, above];
    // Of planes so thick the sides of a face may be told wrongly.
    if sides.iter().filter(|side| side.thin.is_none()).any(|side| rounds_much(side.cell)) {
        return Bounds::UNKNOWN;
    }
    let has_others = sides.iter().any(|side| shared.others.reach(side.cell));
    let has_sheets = sides.iter().any(|side| site.bins.groups(side.k).iter().any(|g| g.is_sheet() && side.touches(g)));
    let whole = match (has_others, has_sheets) {
        // What a sheet blocks beyond solids by formula is not known here.
        (true, true) => return Bounds::UNKNOWN,
        (true, false) => wall_with_others(shared, site.bins, axis, &sides),
        (false, _) => whole_wall(shared, site.bins, axis, &sides),
    };
    if has_sheets {
        return whole.unwrap_or(Bounds::UNKNOWN);
    }
    whole.or_else(|| divided_wall(shared, site, axis, &sides, spare)).unwrap_or(Bounds::UNKNOWN)
}

/// The union on a face with walls: exact, or with the least blur that gives a proof.
fn whole_wall<V: Vector, O>(
    shared: &mut Shared<V, O>,
    bins: &Bins<V>,
    axis: usize,
    sides: &[WallSide<V>; 2],
) -> Option<Bounds<V::Scalar>> {
    with_least_blur(shared.tol, |blur| {
        let (closed, error) = wall_union(&mut shared.union, bins, axis, sides, blur)?;
        Ok((closed.widened(error), error))
    })
}

/// What the sheets in the plane of a face cover beside the bodies on both sides, which close a share of it: at least what one of them does, and at most what all
/// do.
fn covered_by_sheets<V: Vector>(
    bodies: &mut CellUnion<V::Scalar>,
    bins: &Bins<V>,
    axis: usize,
    above: &WallSide<V>,
    closed: V::Scalar,
) -> Result<Bounds<V::Scalar>, NoProof> {
    let plane = above.cell.min.to_array().get(axis).copied();
    let mut covered = Bounds::<V::Scalar>::OPEN;
    for group in bins.groups(above.k).iter().filter(|group| group.is_sheet() && above.touches(group)) {
        let triangles = bins.triangles(group);
        let mut own = V::Scalar::ZERO;
        for triangle in bins.ids(group).iter().filter_map(|&id| triangles.get(id as usize)) {
            if triangle.iter().all(|corner| corner.to_array().get(axis).copied() == plane) {
                own += bodies.free_share(axis, triangle)?;
            }
        }
        // Both sides of it are there.
        own = (own * V::Scalar::HALF).min(V::Scalar::ONE - closed);
        (covered.lower, covered.upper) = (covered.lower.max(own), covered.upper + own);
    }
    Ok(covered)
}

/// The union with other bodies on a face with walls, where those of triangles have few planes on both sides.
fn wall_with_others<V: Vector, O: OtherBodies<V>>(
    shared: &mut Shared<V, O>,
    bins: &Bins<V>,
    axis: usize,
    sides: &[WallSide<V>; 2],
) -> Option<Bounds<V::Scalar>> {
    let [_, above] = sides.map(|side| side.cell);
    let mut high = above.max.to_array();
    high[axis] = above.min.to_array()[axis];
    let face = Aabb { min: above.min, max: V::new(high[0], high[1], high[2]) };
    union_with_others(shared, face, WHOLE, |memory, blur, parts| {
        // What ends in the face fills this side up to it.
        let mut error = V::Scalar::ZERO;
        for side in sides {
            error = error.max(gather(memory, bins, &[*side], blur)?.add_planar_parts(parts)?);
        }
        Ok(error)
    })
    .map(|[found, ..]| found)
}

/// Bounds of a face with walls from its quarters, each between halves of the cells on both sides; none if the depth is spent.
fn divided_wall<V: Vector, O: OtherBodies<V>>(
    shared: &mut Shared<V, O>,
    site: &Site<V>,
    axis: usize,
    [below, above]: &[WallSide<V>; 2],
    spare: SpareMemory<V>,
) -> Option<Bounds<V::Scalar>> {
    let (lower, lo, hi) = (below.cell.min.to_array(), above.cell.min.to_array(), above.cell.max.to_array());
    let middle = |lo: V::Scalar, hi: V::Scalar| lo + (hi - lo) * V::Scalar::HALF;
    let edges = [0, 1, 2].map(|a| match a == axis {
        true => [middle(lower[a], below.cell.max.to_array()[a]), lo[a], middle(lo[a], hi[a])],
        false => [lo[a], middle(lo[a], hi[a]), hi[a]],
    });
    let grid = Grid::new(&edges[0], &edges[1], &edges[2]).ok()?;
    let part = Site { halvings: site.halvings.checked_sub(3)?, ..*site };
    let parts = find_parts(shared, &part, &grid, below.k..above.k + 1, spare)?;
    parts.planes.get(axis).map(|planes| planes[1])
}

/// Bounds of the closed fraction of a face with walls, apart where several sheets lie in its plane, and their error. Each side alone must have a proof, and what both close together lies
/// between the larger of their shares and the sum.
fn wall_union<V: Vector>(
    memory: &mut UnionMemory<V::Scalar>,
    bins: &Bins<V>,
    axis: usize,
    sides: &[WallSide<V>; 2],
    blur: V::Scalar,
) -> Result<(Bounds<V::Scalar>, V::Scalar), NoProof> {
    let zero = V::Scalar::ZERO;
    let (mut least, mut most, mut error) = (zero, zero, zero);
    for side in sides {
        let union = gather(memory, bins, &[*side], blur)?.cell()?;
        let shares = if side.below { union.high } else { union.low };
        let closed = shares[axis.min(2)];
        (least, most, error) = (least.max(closed), most + closed, error.max(union.error));
    }
    let mut bodies = gather(memory, bins, sides, blur)?;
    let closed = bodies.face(axis, V::Scalar::ONE, Limit::Both)?;
    let slack = error + rounding();
    if !(closed >= least - slack && closed <= most + slack) {
        return Err(NoProof::Ambiguous);
    }
    let [_, above] = sides;
    let covered = covered_by_sheets(&mut bodies, bins, axis, above, closed)?;
    Ok((Bounds { lower: closed + covered.lower, upper: closed + covered.upper }, error))
}

/// All surface of some boxes beside a face, in the frame of the first.
fn gather<'u, V: Vector>(
    memory: &'u mut UnionMemory<V::Scalar>,
    bins: &Bins<V>,
    sides: &[WallSide<V>],
    blur: V::Scalar,
) -> Result<CellUnion<'u, V::Scalar>, NoProof> {
    let first = sides.first().ok_or(NoProof::Full)?;
    let mut union = match first.thin {
        Some(axis) => CellUnion::of_slab(memory.reborrow(), first.cell, axis, blur),
        None => CellUnion::new(memory.reborrow(), first.cell, blur),
    };
    for side in sides {
        for group in bins.groups(side.k).iter().filter(|g| !g.is_sheet() && side.touches(g)) {
            union.add(side.cell, side.below, bins.triangles(group), bins.ids(group).iter().copied())?;
        }
    }
    Ok(union)
}

/// What one side of a face sees: a box in a layer.
#[derive(Clone, Copy)]
struct WallSide<V> {
    cell: Aabb<V>,
    k: usize,
    below: bool,
    /// The axis along which it is thin, because it lies beyond the grid.
    thin: Option<usize>,
}

impl<V: Vector> WallSide<V> {
    fn touches(&self, group: &Group<V>) -> bool {
        group.bounds.touches(self.cell)
    }
}

/// The cell below or above a face; beyond the grid's outer planes, a thin one, and whether it is that.
fn side_cell<V: Vector>(grid: &Grid<V::Scalar>, axis: usize, face: [usize; 3], below: bool) -> Option<(Aabb<V>, bool)> {
    let (position, at) = (*face.get(axis)?, *grid.edges(axis).get(*face.get(axis)?)?);
    let outside = (below && position == 0) || (!below && position == *grid.cells().get(axis)?);
    // The cell on this side; outside the grid the one on the other.
    let mut cell = face;
    *cell.get_mut(axis)? -= usize::from(below != outside);
    let found = grid.cell_box(cell)?;
    if !outside {
        return Some((found, false));
    }
    let (mut lo, mut hi) = (found.min.to_array(), found.max.to_array());
    let thin = (hi[axis] - lo[axis]) * V::Scalar::from_f64(OUTSIDE);
    (lo[axis], hi[axis]) = if below { (at - thin, at) } else { (at, at + thin) };
    let corner = |p: [V::Scalar; 3]| V::new(p[0], p[1], p[2]);
    Some((Aabb { min: corner(lo), max: corner(hi) }, true))
}

/// How far beyond its outer planes a grid looks for bodies that touch them, in cells.
const OUTSIDE: f64 = 1.0 / 1024.0;
