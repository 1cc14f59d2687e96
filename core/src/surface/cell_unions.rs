//! Cells that several bodies share: their exact union, or division until bounds are close.

use crate::grid::bounds::Bounds;
use crate::grid::fields::{Layer, gap};
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};
use crate::surface::bins::{Bins, Group, Row, cells_touched};
use crate::surface::division::{Shared, Site, SpareMemory, divide};
use crate::surface::other_bodies::OtherBodies;
use crate::surface::refined::{At, PLACES, Refined, TOP, known, narrow};
use crate::surface::surface_area::{KeptSurface, PieceSums, SurfaceArea};
use crate::surface::union::{CellUnion, Frame, NoProof, PlanarParts, UnionMemory};
use core::ops::Range;
use heapless::Vec;

/// What else is made of the surface of unions. The unit type makes nothing of it.
pub(super) trait UnionSums<V: Vector>: PieceSums<V::Scalar> {
    /// What is kept of the surface of a union for it.
    type Found: KeptSurface<V::Scalar>;
    /// Are the solid fractions of the cells asked for, too?
    fn wants_fractions(&self) -> bool;
    /// Is the surface of the union in a cell of the layer asked for?
    fn wants_union(&self, cell: usize) -> bool;
    /// Told from what is known already: where one body alone has surface inside a cell, of which this share is solid. Was that so?
    fn settle(&mut self, at: (usize, Aabb<V>), solid: V::Scalar) -> bool;
    /// What the union has of surface in a cell.
    fn set_union(&mut self, cell: usize, found: Self::Found);
    /// The same where there is no proof for the cell as a whole.
    fn divide_union<O: OtherBodies<V>>(
        &mut self,
        shared: &mut Shared<V, O>,
        site: &Site<V>,
        at: (usize, Aabb<V>),
        spare: SpareMemory<V>,
    );
    /// The pieces of sheets inside a cell of which bodies may hide some; none where it is not asked what they leave of them.
    fn sheets(&self, cell: usize) -> Option<impl Iterator<Item = &[[V::Scalar; 3]]> + Clone>;
    /// What the bodies leave of the sheets inside a cell.
    fn set_free_sheets(&mut self, cell: usize, free: SurfaceArea<V::Scalar>);
}

impl<V: Vector> UnionSums<V> for () {
    type Found = ();
    #[inline(always)]
    fn wants_fractions(&self) -> bool {
        true
    }
    #[inline(always)]
    fn wants_union(&self, _: usize) -> bool {
        false
    }
    #[inline(always)]
    fn settle(&mut self, _: (usize, Aabb<V>), _: V::Scalar) -> bool {
        false
    }
    #[inline(always)]
    fn set_union(&mut self, _: usize, (): ()) {}
    #[inline(always)]
    fn divide_union<O: OtherBodies<V>>(
        &mut self,
        _: &mut Shared<V, O>,
        _: &Site<V>,
        _: (usize, Aabb<V>),
        _: SpareMemory<V>,
    ) {
    }
    #[inline(always)]
    fn sheets(&self, _: usize) -> Option<impl Iterator<Item = &[[V::Scalar; 3]]> + Clone> {
        None::<core::iter::Empty<_>>
    }
    #[inline(always)]
    fn set_free_sheets(&mut self, _: usize, _: SurfaceArea<V::Scalar>) {}
}

/// A try for a union that gives no proof costs as much as sorting so many times its triangles. Where bodies miss each other by rounding, or wind around
/// nothing, each part along their surface is tried with every blur.
const TRY: usize = 2;

/// Planes of different bodies may miss each other by so much, in cells, and be taken for one where that gives a proof:
/// parts that were meant to touch, in coordinates that were rounded.
const BLURS: [f64; 5] = [0.0, 1e-12, 1e-10, 1e-8, 1e-6];

/// What an attempt finds with the least blur that gives a proof and an error within the tolerance. An attempt returns its error as well.
pub(super) fn with_least_blur<T, R: Real>(tol: R, mut attempt: impl FnMut(R) -> Result<(T, R), NoProof>) -> Option<T> {
    for blur in BLURS.map(R::from_f64).into_iter().filter(|&blur| blur == R::ZERO || blur < tol) {
        match attempt(blur) {
            Ok((found, error)) if blur == R::ZERO || R::TWO * error <= tol => return Some(found),
            Err(NoProof::Full) => return None,
            Ok(_) | Err(NoProof::Ambiguous) => {}
        }
    }
    None
}

/// What became of the shared cells of a layer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Resolved {
    /// Cells whose union had to be found.
    pub ambiguous: usize,
    /// Cells divided.
    pub divided: usize,
}

/// Narrow the bounds of the cells that bodies share in a layer, of their x and y faces and of the z faces below. `pieces` is told of the
/// surface of unions.
pub(super) fn resolve<V: Vector, O: OtherBodies<V>, P: UnionSums<V>>(
    shared: &mut Shared<V, O>,
    site: &Site<V>,
    layer: &mut Layer<V::Scalar>,
    spare: SpareMemory<V>,
    pieces: &mut P,
) -> Resolved {
    let [nx, ny, _] = site.grid.cells();
    let mut resolved = Resolved::default();
    let SpareMemory { reals, flags, numbers, groups } = spare;
    let Some((rows, numbers)) = numbers.split_at_mut_checked(2 * (ny + 1)) else { return resolved };
    let Some((columns, numbers)) = numbers.split_at_mut_checked(2 * (nx + 1)) else { return resolved };
    count_reaching(site.grid.edges(1), boxes(shared, site).map(|(b, s)| ([b.min.y(), b.max.y()], s)), rows);
    let mut rows = SharedCells::new(rows);
    for j in 0..ny {
        if !rows.next_is_shared() {
            continue;
        }
        let Some(cell) = site.grid.cell_box([0, j, site.k]) else { continue };
        let [lo, hi] = [cell.min.y(), cell.max.y()];
        let here = boxes(shared, site).filter(|(b, _)| b.min.y() <= hi && b.max.y() >= lo);
        count_reaching(site.grid.edges(0), here.map(|(b, s)| ([b.min.x(), b.max.x()], s)), columns);
        let mut columns = SharedCells::new(columns);
        let mut row = None;
        for i in 0..nx {
            if !columns.next_is_shared() {
                continue;
            }
            let at = At { i, j, cells: [nx, ny] };
            resolved.ambiguous += usize::from(at.cell_gap(layer) > V::Scalar::ZERO);
            let open = at.largest_gap(layer);
            let wanted = P::WANTED && wants_union(at, site, layer, pieces);
            let narrows = open > known() && pieces.wants_fractions();
            let has_sheets = P::WANTED && pieces.sheets(at.cell()).is_some();
            if !(narrows || wanted || has_sheets) {
                continue;
            }
            if row.is_none() {
                row = Row::new(site.bins, site.k, [lo, hi], (&mut *numbers, &mut *groups));
            }
            let (Some(row), Some(cell)) = (&mut row, site.grid.cell_box([i, j, site.k])) else { continue };
            if has_sheets && let Some(free) = free_sheets(shared, site, (at.cell(), cell), row, pieces) {
                pieces.set_free_sheets(at.cell(), free);
            }
            if !(narrows || wanted) {
                continue;
            }
            let believed = |u: &Refined<_>| at.agrees(layer, u, site.areas);
            let places = if wanted { [true; PLACES] } else { at.open_places(layer) };
            let (mut refined, surface) = union::<_, _, P>(shared, site, cell, row, places, believed);
            let mut rest = SpareMemory { reals, flags, numbers: row.rest.0, groups: row.rest.1 };
            if refined.is_none() && narrows && open > shared.tol {
                resolved.divided += 1;
                refined = divide(shared, site, cell, rest.reborrow());
            }
            match surface {
                Some(surface) if wanted => pieces.set_union(at.cell(), surface),
                None if wanted => pieces.divide_union(shared, site, (at.cell(), cell), rest),
                _ => {}
            }
            if let Some(refined) = refined.filter(|_| open > known()) {
                at.store(layer, &refined);
            }
        }
    }
    resolved
}

/// What the bodies in a cell leave of the sheets there, if that has a proof.
fn free_sheets<V: Vector, O, P: UnionSums<V>>(
    shared: &mut Shared<V, O>,
    site: &Site<V>,
    (number, cell): (usize, Aabb<V>),
    row: &Row<V>,
    pieces: &P,
) -> Option<SurfaceArea<V::Scalar>> {
    let (frame, across) = (Frame::of(cell), side_areas(cell));
    let sheets = pieces.sheets(number)?.map(|corners| frame.framed_polygon(corners));
    with_least_blur(shared.tol, |blur| {
        let mut bodies = bodies_in(shared.union.reborrow(), site, cell, row, blur)?;
        let (error, mut sum) = (bodies.cell()?.error, SurfaceArea::default());
        for sheet in sheets.clone() {
            bodies.free_parts(&sheet, |part| sum = sum.plus(SurfaceArea::of_framed(part, across)))?;
        }
        Ok((sum, error))
    })
}

/// Is the surface of the union in a cell asked for? If one body fills it, or has all surface in it, that is told at once.
fn wants_union<V: Vector, P: UnionSums<V>>(at: At, site: &Site<V>, layer: &Layer<V::Scalar>, pieces: &mut P) -> bool {
    if !pieces.wants_union(at.cell()) {
        return false;
    }
    let solid = layer.lower.cell.get(at.cell()).copied().unwrap_or_default();
    if solid >= V::Scalar::ONE {
        pieces.set_union(at.cell(), P::Found::closed());
        return false;
    }
    // Then the others have no share of it, nor has one of them all of it but for rounding.
    let is_of_one = layer.sum.cell.get(at.cell()).is_some_and(|&sum| sum - solid <= known());
    let cell = site.grid.cell_box([at.i, at.j, site.k]).filter(|_| is_of_one);
    !cell.is_some_and(|cell| pieces.settle((at.cell(), cell), solid))
}

/// Narrow the bounds of the z faces above a layer, held in `layer`, in whose plane no surface lies.
pub(super) fn resolve_top<V: Vector, O: OtherBodies<V>>(
    shared: &mut Shared<V, O>,
    site: &Site<V>,
    layer: &mut Layer<V::Scalar>,
    spare: SpareMemory<V>,
) {
    let [nx, ny, _] = site.grid.cells();
    let SpareMemory { reals, flags, numbers, groups } = spare;
    for j in 0..ny {
        let mut row = None;
        for i in 0..nx {
            let c = j * nx + i;
            let (Some(lower), Some(sum)) = (layer.lower.z.get_mut(c), layer.sum.z.get_mut(c)) else { continue };
            let open = gap(*lower, *sum);
            if !(open > known()) || layer.has_surface.z.get(c) != Some(&0) {
                continue;
            }
            let Some(cell) = site.grid.cell_box([i, j, site.k]) else { continue };
            if row.is_none() {
                row = Row::new(site.bins, site.k, [cell.min.y(), cell.max.y()], (&mut *numbers, &mut *groups));
            }
            let Some(row) = &mut row else { continue };
            let (mut refined, _) = union::<_, _, ()>(shared, site, cell, row, TOP, |_| true);
            if refined.is_none() && open > shared.tol {
                let spare = SpareMemory { reals, flags, numbers: row.rest.0, groups: row.rest.1 };
                refined = divide(shared, site, cell, spare);
            }
            if let Some(refined) = refined {
                narrow(lower, sum, refined.high[2]);
            }
        }
    }
}

/// Boxes around what each body has in a layer; true for bodies of triangles.
fn boxes<'i, V: Vector, O: OtherBodies<V>>(
    shared: &'i Shared<V, O>,
    site: &Site<'i, V>,
) -> impl Iterator<Item = (Aabb<V>, bool)> + 'i {
    let [below, above] = [site.k, site.k + 1].map(|n| site.grid.edges(2).get(n).copied().unwrap_or_default());
    let surfaces = site.bins.groups(site.k).iter().map(|g| (g.bounds, true));
    let others = shared.others.boxes().filter(move |b| b.min.z() <= above && b.max.z() >= below);
    surfaces.chain(others.map(|b| (b, false)))
}

/// The union in a cell, if it agrees with what is known of the bodies, and what it has of surface; where others than bodies of triangles reach it, only
/// bounds of the union in the places wanted, as close as the others tell them, and if there are few planes.
fn union<V: Vector, O: OtherBodies<V>, P: UnionSums<V>>(
    shared: &mut Shared<V, O>,
    site: &Site<V>,
    cell: Aabb<V>,
    row: &Row<V>,
    wanted: [bool; PLACES],
    believed: impl Fn(&Refined<V::Scalar>) -> bool,
) -> (Option<Refined<V::Scalar>>, Option<P::Found>) {
    if !shared.others.reach(cell) {
        return union_of_triangles::<_, _, P>(shared, site, cell, row, believed).unzip();
    }
    let found = union_with_others(shared, cell, wanted, |memory, blur, parts| {
        bodies_in(memory.reborrow(), site, cell, row, blur)?.add_planar_parts(parts)
    });
    (found.map(Refined::from_places).filter(believed), None)
}

/// The union of other bodies in a cell or on a face with bodies of triangles, whose parts there are found with a blur and their error returned: in the cell, or
/// on the face, and in those of the cell's low and high faces that are wanted.
pub(super) fn union_with_others<V: Vector, O: OtherBodies<V>>(
    shared: &mut Shared<V, O>,
    place: Aabb<V>,
    wanted: [bool; PLACES],
    mut parts: impl FnMut(&mut UnionMemory<V::Scalar>, V::Scalar, &mut PlanarParts<V::Scalar>) -> Result<V::Scalar, NoProof>,
) -> Option<[Bounds<V::Scalar>; PLACES]> {
    if !O::UNITES {
        return None;
    }
    let (bodies, error) = with_least_blur(shared.tol, |blur| {
        let mut found = PlanarParts::new();
        let error = parts(&mut shared.union, blur, &mut found)?;
        Ok(((found, error), error))
    })?;
    let found = shared.others.union_with(place, &bodies, wanted)?;
    Some(found.map(|bounds| bounds.widened(error)))
}

/// The union of bodies of triangles in a cell: exact, or with the least blur that gives a proof. What it has of surface is found if `P` wants it.
fn union_of_triangles<V: Vector, O: OtherBodies<V>, P: UnionSums<V>>(
    shared: &mut Shared<V, O>,
    site: &Site<V>,
    cell: Aabb<V>,
    row: &Row<V>,
    believed: impl Fn(&Refined<V::Scalar>) -> bool,
) -> Option<(Refined<V::Scalar>, P::Found)> {
    let mut tried = 0_usize;
    let found = with_least_blur(shared.tol, |blur| {
        let room = shared.union.pieces.len();
        let bodies = bodies_in(shared.union.reborrow(), site, cell, row, blur);
        tried = tried.saturating_add(bodies.as_ref().map_or(room, CellUnion::piece_count));
        let mut bodies = bodies?;
        let mut surface = P::Found::default();
        let found = bodies.cell_and_surface(&mut |_, kept| {
            if P::WANTED {
                surface.keep(SurfaceArea::of_framed(kept, side_areas(cell)));
            }
        })?;
        if P::WANTED {
            surface.set_sides([0, 1, 2].map(|axis| [found.low[axis], found.high[axis]]), found.error <= known());
        }
        let error = found.error;
        let refined = Refined::from_union(found);
        if believed(&refined) { Ok(((refined, surface), error)) } else { Err(NoProof::Ambiguous) }
    });
    if found.is_none() {
        shared.effort.triangles = shared.effort.triangles.saturating_add(tried.saturating_mul(TRY));
    }
    found
}

/// Areas of a cell's sides normal to x, y and z.
pub(super) fn side_areas<V: Vector>(cell: Aabb<V>) -> [V::Scalar; 3] {
    let [x, y, z] = cell.size().to_array();
    [y * z, z * x, x * y]
}

/// Most bodies of a cell with which the others are compared.
const MOST_COMPARED: usize = 32;

/// The bodies of a row that reach a cell, ready to be united; of those that are the same there, one.
pub(super) fn bodies_in<'u, V: Vector>(
    memory: UnionMemory<'u, V::Scalar>,
    site: &Site<V>,
    cell: Aabb<V>,
    row: &Row<V>,
    blur: V::Scalar,
) -> Result<CellUnion<'u, V::Scalar>, NoProof> {
    let mut union = CellUnion::new(memory, cell, blur);
    let mut different: Vec<&Group<V>, MOST_COMPARED> = Vec::new();
    for group in row.triangles.groups.iter() {
        if group.bounds.max.x() <= cell.min.x() || group.bounds.min.x() >= cell.max.x() {
            continue;
        }
        if different.iter().any(|other| are_same(site.bins, row, [other, group])) {
            continue;
        }
        union.add(cell, false, site.bins.triangles(group), row.triangles.ids(group).iter().copied())?;
        let _ = different.push(group);
    }
    Ok(union)
}

/// Have two bodies the same triangles in a row, in the same order?
fn are_same<V: Vector>(bins: &Bins<V>, row: &Row<V>, [a, b]: [&Group<V>; 2]) -> bool {
    let triangles = |group: &Group<V>| {
        let all = bins.triangles(group);
        row.triangles.ids(group).iter().map(move |&id| all.get(id as usize))
    };
    let corners = |group: &Group<V>| [group.bounds.min, group.bounds.max].map(Vector::to_array);
    corners(a) == corners(b) && triangles(a).eq(triangles(b))
}

/// Along one axis, by how many the bodies and the surfaces among them that reach or touch a cell are more than in the cell before:
/// two entries a cell and two beyond, in two's complement.
fn count_reaching<R: Real>(edges: &[R], extents: impl Iterator<Item = ([R; 2], bool)>, steps: &mut [u32]) {
    steps.fill(0);
    for (extent, surface) in extents {
        let Range { start, end } = cells_touched(edges, extent);
        if start >= end {
            continue;
        }
        for (at, sign) in [(start, 1), (end, u32::MAX)] {
            if let Some([bodies, surfaces]) = steps.get_mut(2 * at..).and_then(|s| s.first_chunk_mut()) {
                *bodies = bodies.wrapping_add(sign);
                *surfaces = surfaces.wrapping_add(if surface { sign } else { 0 });
            }
        }
    }
}

/// The cells along one axis that two bodies or more reach or touch, one of them by its surface: among themselves, bodies that are
/// subdivided have been joined already.
struct SharedCells<'a> {
    steps: &'a [u32],
    bodies: u32,
    surfaces: u32,
}

impl<'a> SharedCells<'a> {
    /// From the steps of [`count_reaching`].
    fn new(steps: &'a [u32]) -> Self {
        SharedCells { steps, bodies: 0, surfaces: 0 }
    }

    /// Go on to the next cell.
    fn next_is_shared(&mut self) -> bool {
        let [bodies, surfaces, rest @ ..] = self.steps else { return false };
        self.steps = rest;
        self.bodies = self.bodies.wrapping_add(*bodies);
        self.surfaces = self.surfaces.wrapping_add(*surfaces);
        self.bodies > 1 && self.surfaces > 0
    }
}
