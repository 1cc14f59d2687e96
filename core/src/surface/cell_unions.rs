//! Cells that several bodies share: their exact union, or division until bounds are close.

use crate::grid::Grid;
use crate::grid::bounds::Bounds;
use crate::grid::fields::{Layer, gap};
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};
use crate::surface::bins::{Bins, Group, Row, cells_touched};
use crate::surface::surface_area::{KeptSurface, PieceSums, SurfaceArea};
use crate::surface::union::{CellFractions, CellUnion, NoProof, UnionMemory};
use core::ops::Range;
use heapless::Vec;

/// Bodies that enter a layer by another road than their triangles: known by formula, or subdivided. Their shares of a cell or face are
/// given as bounds of their union, and they take no part in exact unions: a cell that they share with a surface is divided.
///
/// The unit type stands for none.
pub trait OtherBodies<V: Vector> {
    /// There are none.
    fn is_empty(&self) -> bool;
    /// A box around each.
    fn boxes(&self) -> impl Iterator<Item = Aabb<V>>;
    /// Add them to the cells of layer `k` of a grid, and with `areas` to its x and y faces and to the z faces below.
    fn add(&mut self, grid: &Grid<V::Scalar>, k: usize, areas: bool, layer: &mut Layer<V::Scalar>);
    /// Add them to the z faces in plane `plane` of a grid, which are the z faces of `layer`.
    fn add_plane(&mut self, grid: &Grid<V::Scalar>, plane: usize, layer: &mut Layer<V::Scalar>);
    /// May one of them reach a cell or its sides?
    fn reach(&mut self, cell: Aabb<V>) -> bool;
}

impl<V: Vector> OtherBodies<V> for () {
    fn is_empty(&self) -> bool {
        true
    }
    fn boxes(&self) -> impl Iterator<Item = Aabb<V>> {
        core::iter::empty()
    }
    fn add(&mut self, _: &Grid<V::Scalar>, _: usize, _: bool, _: &mut Layer<V::Scalar>) {}
    fn add_plane(&mut self, _: &Grid<V::Scalar>, _: usize, _: &mut Layer<V::Scalar>) {}
    fn reach(&mut self, _: Aabb<V>) -> bool {
        false
    }
}

/// What else is made of the surface of unions. The unit type makes nothing of it.
pub(super) trait UnionSums<V: Vector>: PieceSums<V::Scalar> {
    /// What is kept of the surface of a union for it.
    type Found: KeptSurface<V::Scalar>;
    /// Is the surface of the union in a cell of the layer asked for?
    fn wants_union(&self, cell: usize) -> bool;
    /// Told from what is known already: where one body alone has surface inside a cell, of which this share is solid. Was that so?
    fn settle(&mut self, at: (usize, Aabb<V>), solid: V::Scalar) -> bool;
    /// What the union has of surface in a cell.
    fn set_union(&mut self, cell: usize, found: Self::Found);
    /// The same where there is no proof for the cell as a whole, whose bounds may have been `refined`.
    fn divide_union<O: OtherBodies<V>>(
        &mut self,
        shared: &mut Shared<V, O>,
        site: &Site<V>,
        at: (usize, Aabb<V>),
        refined: Option<&Refined<V::Scalar>>,
        spare: SpareMemory<V>,
    );
}

impl<V: Vector> UnionSums<V> for () {
    type Found = ();
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
        _: Option<&Refined<V::Scalar>>,
        _: SpareMemory<V>,
    ) {
    }
}

/// What all levels of division share.
pub(super) struct Shared<'s, V: Vector, O> {
    /// Bounds this close need no division.
    pub tol: V::Scalar,
    /// Bodies beside those of triangles.
    pub others: &'s mut O,
    /// Memory for one exact union at a time.
    pub union: UnionMemory<'s, V::Scalar>,
    /// How the parts of a cell are found: a function of [`crate::surface::layer`], passed because `layer` imports this file.
    pub parts: FindParts<V, O>,
    /// What the division of one cell has cost so far.
    pub effort: Effort,
}

/// Most triangles sorted while one cell is divided; or [`MOST_TIMES`] those of its first part, if these are more. Where surface meets so densely that
/// halving does not thin it, division stops here and the cell keeps the bounds that it has.
const MOST_EFFORT: usize = 1 << 17;

/// Where halving thins a cell, six levels sort each triangle some thirty times, which is some sixty times those of its first part.
const MOST_TIMES: usize = 64;

/// A try for a union that gives no proof costs as much as sorting so many times its triangles. Where bodies miss each other by rounding, or wind around
/// nothing, each part along their surface is tried with every blur.
const TRY: usize = 2;

/// What the division of a cell has cost.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Effort {
    /// Depth of the part at hand; 0 for a whole cell.
    level: u32,
    /// Triangles sorted for parts of this cell, and those of tries that gave no proof.
    triangles: usize,
    /// So many may be.
    most: usize,
}

/// Finds the bounds of a small grid of at most 2 × 2 × 2 cells from the triangles of some layers of a site; none if depth or memory
/// is spent.
pub(super) type FindParts<V, O> = fn(
    &mut Shared<V, O>,
    &Site<V>,
    &Grid<<V as Vector>::Scalar>,
    Range<usize>,
    SpareMemory<V>,
) -> Option<Parts<<V as Vector>::Scalar>>;

/// A layer of a grid, the triangles sorted into it, and how often its cells may still be halved along some axis.
#[derive(Clone, Copy)]
pub(super) struct Site<'a, V: Vector> {
    pub grid: &'a Grid<'a, V::Scalar>,
    pub bins: &'a Bins<'a, V>,
    pub k: usize,
    pub halvings: u32,
    /// Faces are wanted.
    pub areas: bool,
}

/// Memory of one level of division; what it leaves serves the levels below.
pub(super) struct SpareMemory<'m, V: Vector> {
    pub reals: &'m mut [V::Scalar],
    pub flags: &'m mut [u8],
    pub numbers: &'m mut [u32],
    pub groups: &'m mut [Group<V>],
}

impl<V: Vector> SpareMemory<'_, V> {
    /// The same memory for a shorter time.
    pub fn reborrow(&mut self) -> SpareMemory<'_, V> {
        SpareMemory { reals: self.reals, flags: self.flags, numbers: self.numbers, groups: self.groups }
    }
}

/// Bounds of the solid fractions of a small grid: of the whole, and means over all faces in each of its planes, `[axis][plane]`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parts<R> {
    pub cell: Bounds<R>,
    pub planes: [[Bounds<R>; 3]; 3],
}

/// Bounds of the solid fractions of a cell and of its sides, low and high along each axis.
pub(super) struct Refined<R> {
    pub cell: Bounds<R>,
    pub low: [Bounds<R>; 3],
    pub high: [Bounds<R>; 3],
}

impl<R: Real> Refined<R> {
    fn from_union(u: CellFractions<R>) -> Self {
        let known = |v: R| Bounds::around(v, u.error);
        Refined { cell: known(u.cell), low: u.low.map(known), high: u.high.map(known) }
    }

    /// From the parts of a cell, in number `cells` along each axis.
    fn from_parts(parts: &Parts<R>, cells: [usize; 3]) -> Self {
        let high = |axis: usize| if cells[axis] > 1 { parts.planes[axis][2] } else { parts.planes[axis][1] };
        Refined { cell: parts.cell, low: parts.planes.map(|planes| planes[0]), high: [high(0), high(1), high(2)] }
    }
}

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

/// By how much a union may leave the bounds given by the bodies' own shares and still be rounding: 10⁻⁹, more in `f32`.
pub(super) fn rounding<R: Real>() -> R {
    R::from_f64(1e-9).max(R::EPSILON * R::from_f64(64.0))
}

/// Bounds this close are one value, what remains is rounding: 10⁻¹³, more in `f32`.
pub(super) fn known<R: Real>() -> R {
    R::from_f64(1e-13).max(R::EPSILON * R::from_f64(256.0))
}

/// Narrow the bounds of a cell or face. Both pairs hold, so does their intersection, unless rounding has crossed it; a pair that
/// contradicts the bodies' own shares is not believed.
pub(super) fn narrow<R: Real>(lower: &mut R, sum: &mut R, found: Bounds<R>) {
    let (l, u) = (lower.max(found.lower), sum.min(R::ONE).min(found.upper));
    if l <= u {
        (*lower, *sum) = (l, u);
    } else if l - u <= rounding() {
        (*lower, *sum) = (u, l);
    }
}

/// Does a union lie within the bounds given by the bodies' own shares?
fn fits<R: Real>(lower: R, sum: R, found: Bounds<R>) -> bool {
    found.upper >= lower - rounding() && found.lower <= sum.min(R::ONE) + rounding()
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
            let wanted = P::WANTED && at.wants_union(site, layer, pieces);
            if !(open > known() || wanted) {
                continue;
            }
            if row.is_none() {
                row = Row::new(site.bins, site.k, [lo, hi], (&mut *numbers, &mut *groups));
            }
            let (Some(row), Some(cell)) = (&mut row, site.grid.cell_box([i, j, site.k])) else { continue };
            let believed = |u: &Refined<V::Scalar>| at.agrees(layer, u, site.areas);
            let (mut refined, surface) = union::<_, _, P>(shared, site, cell, row, believed).unzip();
            let mut rest = SpareMemory { reals, flags, numbers: row.rest.0, groups: row.rest.1 };
            if refined.is_none() && open > shared.tol {
                resolved.divided += 1;
                refined = divide(shared, site, cell, rest.reborrow());
            }
            match surface {
                Some(surface) if wanted => pieces.set_union(at.cell(), surface),
                None if wanted => pieces.divide_union(shared, site, (at.cell(), cell), refined.as_ref(), rest),
                _ => {}
            }
            if let Some(refined) = refined.filter(|_| open > known()) {
                at.store(layer, &refined);
            }
        }
    }
    resolved
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
            let refined = match union::<_, _, ()>(shared, site, cell, row, |_| true) {
                None if open > shared.tol => {
                    divide(shared, site, cell, SpareMemory { reals, flags, numbers: row.rest.0, groups: row.rest.1 })
                }
                found => found.map(|(refined, _)| refined),
            };
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

/// The union in a cell: exact, or with the least blur that gives a proof; of triangles only. What it has of surface is found if `P` wants it.
fn union<V: Vector, O: OtherBodies<V>, P: UnionSums<V>>(
    shared: &mut Shared<V, O>,
    site: &Site<V>,
    cell: Aabb<V>,
    row: &Row<V>,
    believed: impl Fn(&Refined<V::Scalar>) -> bool,
) -> Option<(Refined<V::Scalar>, P::Found)> {
    if shared.others.reach(cell) {
        return None;
    }
    let mut tried = 0_usize;
    let found = with_least_blur(shared.tol, |blur| {
        let room = shared.union.pieces.len();
        let bodies = bodies_in(shared.union.reborrow(), site, cell, row, blur);
        tried = tried.saturating_add(bodies.as_ref().map_or(room, CellUnion::piece_count));
        let mut bodies = bodies?;
        let mut surface = P::Found::default();
        let found = bodies.cell_and_surface(&mut |kept| {
            if P::WANTED {
                let ([x, y, z], across) = (kept.doubled_area(), side_areas(cell));
                surface.keep(SurfaceArea::of_polygon([x * across[0], y * across[1], z * across[2]]));
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
    for group in row.groups.iter() {
        if group.bounds.max.x() <= cell.min.x() || group.bounds.min.x() >= cell.max.x() {
            continue;
        }
        if different.iter().any(|other| are_same(site.bins, row, [other, group])) {
            continue;
        }
        union.add(cell, false, site.bins.triangles(group), row.ids(group).iter().copied())?;
        let _ = different.push(group);
    }
    Ok(union)
}

/// Have two bodies the same triangles in a row, in the same order?
fn are_same<V: Vector>(bins: &Bins<V>, row: &Row<V>, [a, b]: [&Group<V>; 2]) -> bool {
    let triangles = |group: &Group<V>| {
        let all = bins.triangles(group);
        row.ids(group).iter().map(move |&id| all.get(id as usize))
    };
    let corners = |group: &Group<V>| [group.bounds.min, group.bounds.max].map(Vector::to_array);
    corners(a) == corners(b) && triangles(a).eq(triangles(b))
}

/// Finds the parts of a cell or of a part of one; none if depth, memory or effort is spent.
pub(super) fn find_parts<V: Vector, O: OtherBodies<V>>(
    shared: &mut Shared<V, O>,
    site: &Site<V>,
    grid: &Grid<V::Scalar>,
    layers: Range<usize>,
    spare: SpareMemory<V>,
) -> Option<Parts<V::Scalar>> {
    with_effort(shared, site, layers.clone(), |shared| (shared.parts)(shared, site, grid, layers, spare))
}

/// Divides a cell, or a part of one that holds the triangles of some layers of a site; none if the effort is spent.
pub(super) fn with_effort<V: Vector, O, T>(
    shared: &mut Shared<V, O>,
    site: &Site<V>,
    layers: Range<usize>,
    division: impl FnOnce(&mut Shared<V, O>) -> Option<T>,
) -> Option<T> {
    // The layer of a whole grid holds more than one of its cells: what is sorted for that is not counted.
    if shared.effort.level == 0 {
        shared.effort = Effort { most: MOST_EFFORT, ..Effort::default() };
    } else {
        let here: usize = layers.map(|k| site.bins.count(k).numbers).sum();
        shared.effort.triangles = shared.effort.triangles.saturating_add(here);
        if shared.effort.level == 1 {
            shared.effort.most = shared.effort.most.max(here.saturating_mul(MOST_TIMES));
        }
    }
    if shared.effort.triangles > shared.effort.most {
        return None;
    }
    shared.effort.level += 1;
    let found = division(shared);
    shared.effort.level -= 1;
    found
}

/// Bounds of a cell from its parts, halves along the axes in which it is longest; none if the depth is spent.
pub(super) fn divide<V: Vector, O: OtherBodies<V>>(
    shared: &mut Shared<V, O>,
    site: &Site<V>,
    cell: Aabb<V>,
    spare: SpareMemory<V>,
) -> Option<Refined<V::Scalar>> {
    let size = cell.size().to_array();
    let longest = size.into_iter().fold(V::Scalar::ZERO, Real::max);
    let halved = size.map(|s| s > longest * V::Scalar::HALF);
    let (lo, hi) = (cell.min.to_array(), cell.max.to_array());
    let edges = [0, 1, 2].map(|a| [lo[a], if halved[a] { lo[a] + size[a] * V::Scalar::HALF } else { hi[a] }, hi[a]]);
    let list = |a: usize| if halved[a] { &edges[a][..] } else { &edges[a][..2] };
    let grid = Grid::new(list(0), list(1), list(2)).ok()?;
    let halvings = halved.iter().map(|&h| u32::from(h)).sum();
    let part = Site { halvings: site.halvings.checked_sub(halvings)?, ..*site };
    let parts = find_parts(shared, &part, &grid, site.k..site.k + 1, spare)?;
    Some(Refined::from_parts(&parts, grid.cells()))
}

/// A cell of a layer.
#[derive(Clone, Copy)]
struct At {
    i: usize,
    j: usize,
    cells: [usize; 2],
}

impl At {
    fn cell(self) -> usize {
        self.j * self.cells[0] + self.i
    }

    /// Is the surface of the union in the cell asked for? If one body fills it, or has all surface in it, that is told at once.
    fn wants_union<V: Vector, P: UnionSums<V>>(self, site: &Site<V>, layer: &Layer<V::Scalar>, pieces: &mut P) -> bool {
        if !pieces.wants_union(self.cell()) {
            return false;
        }
        let solid = layer.lower.cell.get(self.cell()).copied().unwrap_or_default();
        if solid >= V::Scalar::ONE {
            pieces.set_union(self.cell(), P::Found::closed());
            return false;
        }
        // Then the others have no share of it, nor has one of them all of it but for rounding.
        let is_of_one = layer.sum.cell.get(self.cell()).is_some_and(|&sum| sum - solid <= known());
        let cell = site.grid.cell_box([self.i, self.j, site.k]).filter(|_| is_of_one);
        !cell.is_some_and(|cell| pieces.settle((self.cell(), cell), solid))
    }

    /// The faces that the cell decides: its low ones, and at the upper ends of the grid the high ones; axis, position, and whether high.
    fn faces(self) -> impl Iterator<Item = (usize, usize, bool)> {
        let At { i, j, cells: [nx, ny] } = self;
        let (c, x) = (self.cell(), j * (nx + 1) + i);
        let low = [(0, x, false), (1, c, false), (2, c, false)].into_iter();
        let right = (i + 1 == nx).then_some((0, x + 1, true));
        low.chain(right).chain((j + 1 == ny).then_some((1, c + nx, true)))
    }

    fn cell_gap<R: Real>(self, layer: &Layer<R>) -> R {
        let (lower, sum) = (layer.lower.cell.get(self.cell()), layer.sum.cell.get(self.cell()));
        gap(lower.copied().unwrap_or_default(), sum.copied().unwrap_or_default())
    }

    /// The largest gap of the cell and of the faces that it decides, but for those in whose plane surface lies.
    fn largest_gap<R: Real>(self, layer: &Layer<R>) -> R {
        self.faces()
            .filter_map(|(axis, at, _)| free_face(layer, axis, at))
            .fold(self.cell_gap(layer), |most, (l, s)| most.max(gap(l, s)))
    }

    /// Does a union agree with the bodies' own shares of the cell and of those low faces that lie in no wall?
    /// Without `areas` nothing is known of z faces.
    fn agrees<R: Real>(self, layer: &Layer<R>, u: &Refined<R>, areas: bool) -> bool {
        let (Some(&lower), Some(&sum)) = (layer.lower.cell.get(self.cell()), layer.sum.cell.get(self.cell())) else {
            return false;
        };
        let low = self.faces().take(if areas { 3 } else { 2 });
        fits(lower, sum, u.cell)
            && low.zip(u.low).all(|((axis, at, _), found)| {
                free_face(layer, axis, at).is_none_or(|(lower, sum)| fits(lower, sum, found))
            })
    }

    /// Store what is known of the cell and of those of its faces that it decides.
    fn store<R: Real>(self, layer: &mut Layer<R>, refined: &Refined<R>) {
        let c = self.cell();
        if let (Some(lower), Some(sum)) = (layer.lower.cell.get_mut(c), layer.sum.cell.get_mut(c)) {
            narrow(lower, sum, refined.cell);
        }
        for (axis, at, high) in self.faces() {
            let side = if high { &refined.high } else { &refined.low };
            let (Some((lower, sum)), Some(&found)) = (free_face(layer, axis, at), side.get(axis)) else { continue };
            if !(gap(lower, sum) > R::ZERO) {
                continue;
            }
            let (lowers, sums) = layer.faces_mut(axis);
            if let (Some(lower), Some(sum)) = (lowers.get_mut(at), sums.get_mut(at)) {
                narrow(lower, sum, found);
            }
        }
    }
}

/// Lower bound and sum of a face in whose plane no surface lies.
fn free_face<R: Real>(layer: &Layer<R>, axis: usize, at: usize) -> Option<(R, R)> {
    let free = layer.has_surface.faces(axis).get(at) == Some(&0);
    free.then_some((*layer.lower.faces(axis).get(at)?, *layer.sum.faces(axis).get(at)?))
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
