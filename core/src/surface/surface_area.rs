//! How much surface stands in the cells of a layer: frontal area along each axis, and wetted area.
//!
//! With K the union of all bodies and n its normal, a cell's frontal area along axis i is ½ ∫ |n_i| dA over the part of ∂K inside the open cell,
//! and its wetted area ∫ dA. Divided by the cell's volume they are what resistance laws of the PDR method ask for: a line along i meets on
//! average frontal area × length / volume bodies. Both are additive over cells, so totals do not depend on the grid.
//!
//! Surface that lies in a plane of the grid is resolved by the faces that it blocks: it has no frontal area. It is wetted from the cell
//! into which its normal points.
//!
//! Surface of one body inside another does not count: where bodies share a cell, the fragments of [`crate::surface::union`] are summed.

mod spread;

use crate::grid::Grid;
use crate::number::real::{Real, Vector};
use crate::surface::bins::Bins;
use crate::surface::clip::Polygon;
pub(super) use spread::Place;
use spread::spread;

/// Area of surface in a cell, in the unit of the grid.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfaceArea<R> {
    /// ½ ∫ |n_i| dA along x, y and z.
    pub frontal: [R; 3],
    /// ∫ dA.
    pub wetted: R,
}

impl<R: Real> SurfaceArea<R> {
    /// Of a plane polygon, from twice its area vector.
    #[inline(always)]
    pub(super) fn of_polygon(doubled: [R; 3]) -> Self {
        let [x, y, z] = doubled;
        let quarter = R::HALF * R::HALF;
        SurfaceArea { frontal: doubled.map(|d| d.abs() * quarter), wetted: (x * x + y * y + z * z).sqrt() * R::HALF }
    }

    /// Of a plane polygon in the frame of a cell with sides of these areas.
    #[inline(always)]
    pub(super) fn of_framed(polygon: &Polygon<R>, sides: [R; 3]) -> Self {
        let [x, y, z] = polygon.doubled_area();
        Self::of_polygon([x * sides[0], y * sides[1], z * sides[2]])
    }

    /// The sum of both.
    #[must_use]
    #[inline(always)]
    pub fn plus(self, other: Self) -> Self {
        let [a, b] = [self.frontal, other.frontal];
        SurfaceArea { frontal: [a[0] + b[0], a[1] + b[1], a[2] + b[2]], wetted: self.wetted + other.wetted }
    }

    /// Each part multiplied.
    #[must_use]
    pub fn times(self, factor: R) -> Self {
        SurfaceArea { frontal: self.frontal.map(|f| f * factor), wetted: self.wetted * factor }
    }
}

/// What else the sums of a layer make of the pieces of surface that they add up. The unit type makes nothing, at no cost.
pub(super) trait PieceSums<R> {
    /// Whether anything is made of the pieces; if not, none is told.
    const WANTED: bool;
    /// The pieces that follow are of this body, which may be a sheet without volume.
    fn begin_body(&mut self, body: u32, sheet: bool);
    /// The pieces that follow are of this triangle of the body.
    fn begin_triangle(&mut self, triangle: u32);
    /// A piece that counts for a cell of the layer, by twice its area vector, and itself, in the coordinates of the grid if it lies inside the cell.
    fn add(&mut self, cell: usize, place: Place, doubled_area: [R; 3], piece: &Polygon<R>);
}

impl<R> PieceSums<R> for () {
    const WANTED: bool = false;
    #[inline(always)]
    fn begin_body(&mut self, _: u32, _: bool) {}
    #[inline(always)]
    fn begin_triangle(&mut self, _: u32) {}
    #[inline(always)]
    fn add(&mut self, _: usize, _: Place, _: [R; 3], _: &Polygon<R>) {}
}

/// What one cell holds of single bodies' surfaces. The default serves as memory.
#[derive(Clone, Copy, Debug, Default)]
pub struct CellSurface<R> {
    /// Inside the cell.
    pub(super) inside: SurfaceArea<R>,
    /// Wetted area in the planes of its faces.
    pub(super) in_plane: R,
    /// Of sheets without volume, both sides, inside the cell.
    pub(super) sheets: SurfaceArea<R>,
    /// Wetted area of sheets in the planes of its faces.
    pub(super) sheets_in_plane: R,
    /// What the bodies with volume leave of the sheets inside the cell, if that is known.
    pub(super) free_sheets: Option<SurfaceArea<R>>,
    /// Those with surface inside or in the planes of its faces.
    pub(super) bodies: Bodies,
    /// Those with surface inside.
    inner: Bodies,
    /// Of several bodies, what their union has.
    pub(super) union: Option<UnionSurface<R>>,
    /// The pieces inside that have been kept.
    pub(super) kept: CellPieces,
    /// Surface lies in the plane of its upper side.
    pub(super) wall_on_top: bool,
}

impl<R: Real> CellSurface<R> {
    /// The sum over all bodies, whether they overlap or not.
    pub(super) fn sum(&self) -> SurfaceArea<R> {
        let SurfaceArea { frontal, wetted } = self.inside.plus(self.sheets);
        SurfaceArea { frontal, wetted: wetted + self.in_planes() }
    }

    /// Wetted area in the planes of the cell's faces, of all bodies and sheets added up.
    pub(super) fn in_planes(&self) -> R {
        self.in_plane + self.sheets_in_plane
    }

    /// Are there sheets?
    pub(super) fn has_sheets(&self) -> bool {
        self.sheets.wetted > R::ZERO || self.sheets_in_plane > R::ZERO
    }

    /// May bodies with volume hide a part of the sheets inside the cell? Without surface in it they fill it or leave it open.
    pub(super) fn may_hide_sheets(&self) -> bool {
        self.sheets.wetted > R::ZERO && self.inside.wetted > R::ZERO
    }

    /// What the bodies leave of the sheets inside the cell, and how much of its wetted area is in doubt.
    pub(super) fn seen_sheets(&self) -> (SurfaceArea<R>, R) {
        match self.free_sheets {
            Some(free) => (free, R::ZERO),
            None if self.may_hide_sheets() => (self.sheets, self.sheets.wetted),
            None => (self.sheets, R::ZERO),
        }
    }

    /// Is the surface of the union of the bodies asked for, or what is solid on the cell's sides?
    pub(super) fn wants_union(&self) -> bool {
        self.inside.wetted > R::ZERO && (self.bodies == Bodies::Several || self.sheets_in_plane > R::ZERO)
    }

    /// What the union of the bodies with volume has inside the cell, as far as it is known.
    pub(super) fn of_union(&self) -> UnionSurface<R> {
        let alone = UnionSurface { area: self.inside, ..UnionSurface::default() };
        match (self.union, self.bodies) {
            (Some(found), _) => found,
            // Without surface inside, a cell that is not closed is open up to its sides.
            _ if !(self.inside.wetted > R::ZERO) => {
                UnionSurface { exact: true, sides: Some([[R::ZERO; 2]; 3]), ..alone }
            }
            (_, Bodies::Several) => UnionSurface { doubt: self.inside.wetted, ..alone },
            _ => UnionSurface { exact: true, ..alone },
        }
    }
}

/// The pieces that have been kept of the surface inside one cell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CellPieces {
    /// There are none.
    #[default]
    None,
    /// The last of them, by its number in the layer.
    Last(u32),
    /// Not all of them were kept: memory was spent.
    Incomplete,
}

/// A piece of surface in a cell that has been kept. The default serves as memory.
#[derive(Clone, Copy, Debug, Default)]
pub struct KeptPiece {
    /// The piece of the same cell before it.
    before: CellPieces,
    first_corner: u32,
    owner: Owner,
    /// How many corners it has.
    corners: u8,
}

/// What a piece of surface is cut from. The default serves as memory.
#[derive(Clone, Copy, Debug, Default)]
struct Owner {
    body: u32,
    /// The number of the triangle among those of the body.
    triangle: u32,
    /// The body has no volume.
    sheet: bool,
}

/// Memory for the pieces of surface in a layer, which spare cutting them again; cells for which it does not suffice are cut again.
#[derive(Debug, Default)]
pub struct PieceMemory<'a, R> {
    /// Pieces.
    pub pieces: &'a mut [KeptPiece],
    /// Their corners: four to five times as many.
    pub corners: &'a mut [[R; 3]],
}

/// How much of a [`PieceMemory`] is used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PiecesUsed {
    /// Pieces.
    pub pieces: usize,
    /// Corners.
    pub corners: usize,
}

impl<R: Real> PieceMemory<'_, R> {
    /// Keep one more piece of a cell, those of which before it are given.
    #[inline(always)]
    fn keep(&mut self, used: &mut PiecesUsed, before: CellPieces, owner: Owner, piece: &Polygon<R>) -> CellPieces {
        if before == CellPieces::Incomplete {
            return before;
        }
        let corners = piece.corners();
        let (first, number) = (used.corners, used.pieces);
        let places = self.corners.get_mut(first..).and_then(|free| free.get_mut(..corners.len()));
        let (Some(places), Some(kept)) = (places, self.pieces.get_mut(number)) else { return CellPieces::Incomplete };
        places.iter_mut().zip(corners).for_each(|(place, corner)| *place = *corner);
        *kept = KeptPiece { before, first_corner: first as u32, owner, corners: corners.len() as u8 };
        *used = PiecesUsed { pieces: number + 1, corners: first + corners.len() };
        CellPieces::Last(number as u32)
    }
}

/// A cell of a layer that has surface. The default serves as memory.
#[derive(Clone, Copy, Debug, Default)]
pub struct SurfaceCell<R> {
    /// Its number in the layer, x fastest.
    pub cell: u32,
    /// Areas of the union in it, in the unit of the grid. Of sheets counts what lies outside all bodies, whatever other sheets cover.
    pub area: SurfaceArea<R>,
    /// What has been kept of it.
    pub kept: KeptCell,
}

/// The cells of a layer that have surface, and the pieces that have been kept of it.
#[derive(Clone, Copy, Debug)]
pub struct KeptPieces<'a, R> {
    /// The cells, in ascending order.
    pub cells: &'a [SurfaceCell<R>],
    /// All pieces.
    pub pieces: &'a [KeptPiece],
    /// Their corners.
    pub corners: &'a [[R; 3]],
}

/// What has been kept of a cell. The default serves as memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KeptCell {
    /// Its pieces.
    pub(super) pieces: CellPieces,
    /// Surface may lie in the plane of a side normal to x, y, z.
    pub(super) walls: [bool; 3],
    /// The bodies with surface in the cell or in the planes of its sides, seen from it; several also where one is a sheet.
    pub(super) bodies: Bodies,
    /// No line along x, y or z enters solid twice in the cell.
    pub(super) entered_once: bool,
}

impl KeptCell {
    /// The number of the body that alone has surface in the cell, or in the planes of its sides as seen from the cell.
    #[must_use]
    pub fn alone(&self) -> Option<u32> {
        match self.bodies {
            Bodies::One(body) => Some(body),
            _ => None,
        }
    }

    /// Have all pieces been kept?
    pub(super) fn is_complete(&self) -> bool {
        self.pieces != CellPieces::Incomplete
    }

    /// Has no body surface in the cell, nor in the planes of its sides as seen from the cell?
    #[must_use]
    pub fn is_bare(&self) -> bool {
        self.bodies == Bodies::None
    }

    /// Nobody has surface there but one convex body, whose frontal areas are those that are known: then these tell the shadows.
    pub fn set_convex(&mut self) {
        self.entered_once = true;
    }
}

impl<'a, R> KeptPieces<'a, R> {
    /// What has been kept of a cell, if that is all; of cells without surface there is nothing to keep.
    fn of(&self, cell: usize) -> Option<KeptCell> {
        let at = self.cells.binary_search_by_key(&cell, |own| own.cell as usize).ok();
        let kept = at.and_then(|at| self.cells.get(at)).map_or_else(KeptCell::default, |own| own.kept);
        kept.is_complete().then_some(kept)
    }

    /// The triangles that have a piece inside a cell, if all of these have been kept: the number of the body, and that of the triangle among those of the
    /// body. Those of a body come one after the other.
    pub fn triangles(&self, cell: usize) -> Option<impl Iterator<Item = [u32; 2]> + use<'a, R>> {
        Some(list(self.pieces, self.of(cell)?.pieces).map(|KeptPiece { owner, .. }| [owner.body, owner.triangle]))
    }

    /// The corners of all pieces inside a cell, if one body alone has surface there or in the planes of its sides, as seen from the cell.
    pub fn of_one(&self, cell: usize) -> Option<impl Iterator<Item = &'a [[R; 3]]> + use<'a, R>> {
        let own = self.of(cell).filter(|own| own.alone().is_some())?;
        Some(self.pieces(own).map(|(corners, ..)| corners))
    }

    /// The pieces of a cell, the last first: corners, the body and whether it is a sheet.
    pub(super) fn pieces(&self, cell: KeptCell) -> impl Iterator<Item = (&'a [[R; 3]], u32, bool)> + use<'a, R> {
        let corners = self.corners;
        list(self.pieces, cell.pieces)
            .map_while(|piece| Some((piece.corners_in(corners)?, piece.owner.body, piece.owner.sheet)))
    }
}

/// The last piece of a cell, and those before it.
fn list(pieces: &[KeptPiece], last: CellPieces) -> impl Iterator<Item = &KeptPiece> + Clone {
    let mut at = last;
    core::iter::from_fn(move || {
        let CellPieces::Last(number) = at else { return None };
        let piece = pieces.get(number as usize)?;
        // Lists lead downwards, so that they end.
        at = if matches!(piece.before, CellPieces::Last(n) if n < number) { piece.before } else { CellPieces::None };
        Some(piece)
    })
}

impl KeptPiece {
    /// Its corners, among those of all pieces.
    fn corners_in<'a, R>(&self, corners: &'a [[R; 3]]) -> Option<&'a [[R; 3]]> {
        corners.get(self.first_corner as usize..)?.get(..self.corners.into())
    }
}

/// The bodies with volume that have surface in a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Bodies {
    #[default]
    None,
    One(u32),
    Several,
}

impl Bodies {
    /// One more, which may be among them.
    #[inline(always)]
    fn add(&mut self, body: u32) {
        *self = match *self {
            Bodies::None => Bodies::One(body),
            Bodies::One(other) if other == body => Bodies::One(body),
            _ => Bodies::Several,
        };
    }
}

/// What the union of several bodies has of surface inside a cell.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct UnionSurface<R> {
    pub area: SurfaceArea<R>,
    /// How much of its wetted area is in doubt.
    pub doubt: R,
    /// It is known to rounding.
    pub exact: bool,
    /// Solid fractions of the cell's sides as seen from inside, low and high along each axis, if they are known.
    pub sides: Option<[[R; 2]; 3]>,
}

/// What is kept of the surface of a union while it is made: all of it in a [`UnionSurface`], nothing in a unit.
pub(super) trait KeptSurface<R>: Default {
    /// Of a cell that one body fills.
    fn closed() -> Self;
    /// A fragment counts.
    fn keep(&mut self, fragment: SurfaceArea<R>);
    /// Solid fractions of the sides, and whether they are known to rounding.
    fn set_sides(&mut self, sides: [[R; 2]; 3], exact: bool);
}

impl<R> KeptSurface<R> for () {
    #[inline(always)]
    fn closed() {}
    #[inline(always)]
    fn keep(&mut self, _: SurfaceArea<R>) {}
    #[inline(always)]
    fn set_sides(&mut self, _: [[R; 2]; 3], _: bool) {}
}

impl<R: Real> KeptSurface<R> for UnionSurface<R> {
    fn closed() -> Self {
        UnionSurface { exact: true, ..UnionSurface::default() }
    }
    fn keep(&mut self, fragment: SurfaceArea<R>) {
        self.area = self.area.plus(fragment);
    }
    fn set_sides(&mut self, sides: [[R; 2]; 3], exact: bool) {
        (self.sides, self.exact) = (Some(sides), exact);
    }
}

/// The cells of a layer that have surface, and what they hold.
struct CellsWithSurface<'a, R> {
    /// Of each cell, `ny*nx`, x fastest, which of `cells` is its own, counted from 1; 0 without surface.
    numbers: &'a mut [u32],
    /// In the order in which surface was found in them.
    cells: &'a mut [CellSurface<R>],
    count: usize,
}

impl<'a, R: Real> CellsWithSurface<'a, R> {
    fn new(numbers: &'a mut [u32], cells: &'a mut [CellSurface<R>]) -> Self {
        numbers.fill(0);
        CellsWithSurface { numbers, cells, count: 0 }
    }

    fn place(&self, cell: usize) -> Option<usize> {
        (*self.numbers.get(cell)? as usize).checked_sub(1)
    }

    /// What a cell holds, nothing at first.
    #[inline(always)]
    fn get_or_add(&mut self, cell: usize) -> Option<&mut CellSurface<R>> {
        let number = self.numbers.get_mut(cell)?;
        if *number == 0 {
            *self.cells.get_mut(self.count)? = CellSurface::default();
            self.count += 1;
            *number = self.count as u32;
        }
        self.cells.get_mut((*number as usize).wrapping_sub(1))
    }
}

/// The surfaces in the cells of a layer, gathered piece by piece.
pub(super) struct LayerSurface<'a, R> {
    cells: CellsWithSurface<'a, R>,
    /// What the pieces are cut from.
    owner: Owner,
    pieces: PieceMemory<'a, R>,
    used: PiecesUsed,
    /// What else is wanted of the layer.
    pub beside: Beside,
}

/// What else than areas is wanted of the cells of a layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Beside {
    /// Their solid fractions, and those of their sides.
    Fractions,
    /// Of cells in the planes of whose sides surface lies, solid fractions of the sides as seen from inside.
    Sides,
    /// Nothing.
    Nothing,
}

impl<'a, R: Real> LayerSurface<'a, R> {
    /// Of no surface yet; pieces are kept as far as the memory goes. `numbers` and `cells` have room for all cells.
    pub fn new(
        numbers: &'a mut [u32],
        cells: &'a mut [CellSurface<R>],
        pieces: PieceMemory<'a, R>,
        beside: Beside,
    ) -> Self {
        let cells = CellsWithSurface::new(numbers, cells);
        LayerSurface { cells, owner: Owner::default(), pieces, used: PiecesUsed::default(), beside }
    }

    /// How many pieces and corners have been kept.
    pub fn used(&self) -> PiecesUsed {
        self.used
    }

    /// The cells with surface in ascending order, and what they hold.
    pub fn cells(&self) -> impl Iterator<Item = (usize, &CellSurface<R>)> {
        let CellsWithSurface { numbers, cells, .. } = &self.cells;
        let own = |number: u32| cells.get((number as usize).checked_sub(1)?);
        numbers.iter().enumerate().filter(|(_, number)| **number != 0).filter_map(move |(c, &n)| Some((c, own(n)?)))
    }

    /// What a cell holds; none without surface.
    pub fn cell(&self, cell: usize) -> Option<&CellSurface<R>> {
        self.cells.cells.get(self.cells.place(cell)?)
    }

    /// The same, to be changed.
    pub fn cell_mut(&mut self, cell: usize) -> Option<&mut CellSurface<R>> {
        let place = self.cells.place(cell)?;
        self.cells.cells.get_mut(place)
    }

    /// What a cell holds inside which one body with volume has all surface, and the pieces of that surface; none if several have some, or pieces are not
    /// known.
    pub fn of_one(&self, cell: usize) -> Option<(&CellSurface<R>, impl Iterator<Item = &[[R; 3]]>)> {
        let known = |s: &&CellSurface<R>| matches!(s.inner, Bodies::One(_)) && s.kept != CellPieces::Incomplete;
        let surface = self.cell(cell).filter(known)?;
        let pieces = list(self.pieces.pieces, surface.kept).filter(|piece| !piece.owner.sheet);
        Some((surface, pieces.map_while(|piece| piece.corners_in(self.pieces.corners))))
    }

    /// The pieces of sheets inside a cell; none if they are not all known.
    pub fn sheets_in(&self, cell: usize) -> Option<impl Iterator<Item = &[[R; 3]]> + Clone> {
        let surface = self.cell(cell).filter(|surface| surface.kept != CellPieces::Incomplete)?;
        let pieces = list(self.pieces.pieces, surface.kept).filter(|piece| piece.owner.sheet);
        Some(pieces.map_while(|piece| piece.corners_in(self.pieces.corners)))
    }
}

impl<R: Real> PieceSums<R> for LayerSurface<'_, R> {
    const WANTED: bool = true;

    fn begin_body(&mut self, body: u32, sheet: bool) {
        self.owner = Owner { body, sheet, triangle: 0 };
    }

    #[inline(always)]
    fn begin_triangle(&mut self, triangle: u32) {
        self.owner.triangle = triangle;
    }

    #[inline(always)]
    fn add(&mut self, cell: usize, place: Place, doubled_area: [R; 3], piece: &Polygon<R>) {
        let Some(cell) = self.cells.get_or_add(cell) else { return };
        let Owner { body, sheet, .. } = self.owner;
        if place == Place::Inside {
            cell.kept = self.pieces.keep(&mut self.used, cell.kept, self.owner, piece);
        }
        let area = SurfaceArea::of_polygon(doubled_area);
        match (sheet, place) {
            (true, Place::Inside) => cell.sheets = cell.sheets.plus(area),
            (true, Place::InPlane) => cell.sheets_in_plane += area.wetted,
            (false, Place::Inside) => cell.inside = cell.inside.plus(area),
            (false, Place::InPlane) => cell.in_plane += area.wetted,
            (_, Place::Top) => cell.wall_on_top = true,
        }
        if !sheet && place != Place::Top {
            cell.bodies.add(body);
            if place == Place::Inside {
                cell.inner.add(body);
            }
        }
    }
}

/// Add an area times each weight.
pub(super) fn add_weighted<R: Real, const N: usize>(sums: &mut [[R; 3]; N], weights: &[R; N], area: [R; 3]) {
    for (sum, &weight) in sums.iter_mut().zip(weights) {
        for (sum, area) in sum.iter_mut().zip(area) {
            *sum += weight * area;
        }
    }
}

/// Add the frontal areas of single bodies in each cell of layer `k`, multiplied by weights of the body; `cells` is `ny*nx`, x fastest.
pub(super) fn gather_weighted<V: Vector, const N: usize>(
    bins: &Bins<V>,
    grid: &Grid<V::Scalar>,
    k: usize,
    weights: &[[V::Scalar; N]],
    cells: &mut [[[V::Scalar; 3]; N]],
) {
    let nx = grid.cells()[0];
    for group in bins.groups(k) {
        let (triangles, Some(weights)) = (bins.triangles(group), weights.get(group.body as usize)) else { continue };
        for corners in bins.ids(group).iter().filter_map(|&id| triangles.get(id as usize)) {
            spread(grid, k, &corners.map(Vector::to_array), &mut |[i, j], place, polygon| {
                let Some(cell) = cells.get_mut(j * nx + i).filter(|_| place == Place::Inside) else { return };
                let area = SurfaceArea::of_polygon(polygon.doubled_area()).frontal;
                add_weighted(cell, weights, area);
            });
        }
    }
}
