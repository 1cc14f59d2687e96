//! Frontal and wetted area of the union in the cells of a layer.

use super::Layers;
use super::error::LayerError;
use super::memory::LayerMemory;
use super::parts::SmallGrid;
use super::report::LayerReport;
use super::slices::LayerSlices;
use super::solid_bounds::solid_bounds;
use crate::grid::Grid;
use crate::grid::bounds::Bounds;
use crate::grid::fields::{Fields, exactly};
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};
use crate::surface::cell_unions::{UnionSums, side_areas};
use crate::surface::division::{Shared, Site, SpareMemory, divide, with_effort};
use crate::surface::error::Defects;
use crate::surface::other_bodies::OtherBodies;
use crate::surface::refined::{Refined, known};
use crate::surface::surface_area::{
    Beside, Bodies, CellPieces, CellSurface, KeptCell, KeptPieces, LayerSurface, PieceMemory, PiecesUsed, SurfaceArea,
    SurfaceCell, UnionSurface,
};
use crate::surface::union::{Frame, integrate};

/// Open fractions of a layer that are known already: cells `ny*nx`, x faces `ny*(nx+1)`, y faces `(ny+1)*nx`, z faces below and above
/// `ny*nx` each; x fastest.
#[derive(Clone, Copy, Debug)]
pub struct OpenLayer<'a, R> {
    /// Cells.
    pub cell: &'a [R],
    /// x faces.
    pub x: &'a [R],
    /// y faces.
    pub y: &'a [R],
    /// z faces below.
    pub z: &'a [R],
    /// z faces above.
    pub top: &'a [R],
}

impl<R: Real> OpenLayer<'_, R> {
    pub(super) fn check(&self, grid: &Grid<R>) -> Result<(), LayerError> {
        let [nx, ny, _] = grid.cells();
        exactly(nx * ny, self.cell.len())?;
        exactly((nx + 1) * ny, self.x.len())?;
        exactly(nx * (ny + 1), self.y.len())?;
        exactly(nx * ny, self.z.len())?;
        Ok(exactly(nx * ny, self.top.len())?)
    }

    /// Solid fractions of the sides of a cell, low and high along each axis.
    pub(super) fn blocked(&self, [i, j]: [usize; 2], nx: usize) -> Option<Sides<R>> {
        let (c, x) = (j * nx + i, j * (nx + 1) + i);
        let open = [
            [self.x.get(x)?, self.x.get(x + 1)?],
            [self.y.get(c)?, self.y.get(c + nx)?],
            [self.z.get(c)?, self.top.get(c)?],
        ];
        Some(open.map(|side| side.map(|&open| R::ONE - open)))
    }
}

/// Solid fractions of the sides of a cell, low and high along each axis.
type Sides<R> = [[R; 2]; 3];

/// How well the areas of a layer are known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AreaReport<R> {
    /// The areas of all bodies added up, whether they overlap or not.
    pub sum: SurfaceArea<R>,
    /// Entries of [`AreaSlices::union`] that are used.
    pub cells: usize,
    /// Entries of [`AreaSlices::sides`] that are used.
    pub sides: usize,
    /// Cells that several bodies share and whose union has no proof, even divided: their areas lie between that of one body and the sum.
    pub unproved: usize,
    /// The largest wetted area that is in doubt in one cell.
    pub max_doubt: R,
    /// How much of [`AreaSlices::pieces`] is used.
    pub kept: PiecesUsed,
}

/// Where the areas of a layer go, and memory for them.
#[derive(Debug)]
pub struct AreaSlices<'a, R> {
    /// The cells with surface in ascending order, without what [`Layers::finish_areas`] adds; room for `ny*nx`.
    pub union: &'a mut [SurfaceCell<R>],
    /// Cells whose areas are not all that there is to know, in ascending order; room for `ny*nx`.
    pub sides: &'a mut [CellSides<R>],
    /// Memory, `ny*nx`.
    pub cells: &'a mut [CellSurface<R>],
    /// Memory, `ny*nx`.
    pub numbers: &'a mut [u32],
    /// Memory for the pieces of surface, which [`Layers::shadows`] need not cut again; as much as one likes, none will do.
    pub pieces: PieceMemory<'a, R>,
    /// The open fractions are known otherwise: what is found of them may be farther from the truth than the options allow, which spares time.
    pub fractions_known: bool,
}

/// What is told of the porosity of a layer, and of its areas.
pub type LayerReports<R> = (LayerReport<R>, AreaReport<R>);

/// What is known of the surface in a layer: the cells that have some with the pieces that have been kept, and what is told beside of some cells.
pub type KnownSurface<'a, R> = (KeptPieces<'a, R>, &'a [CellSides<R>]);

/// A cell that several bodies share. The default serves as memory.
#[derive(Clone, Copy, Debug, Default)]
pub struct CellSides<R> {
    pub(super) cell: u32,
    /// The areas in it are known to rounding.
    pub(super) exact: bool,
    /// The solid fractions of its sides as seen from inside, if surface lies in their planes.
    solid: Option<Sides<R>>,
}

impl<V: Vector> Layers<'_, V> {
    /// As [`Layers::zeroed_layer`], and with it areas of the surface in the cells.
    ///
    /// # Errors
    /// [`LayerError`]: no such layer, slices of wrong length, memory of another grid.
    pub fn layer_and_areas(
        &self,
        k: usize,
        beta: LayerSlices<V::Scalar>,
        bounds: Option<[LayerSlices<V::Scalar>; 2]>,
        areas: AreaSlices<V::Scalar>,
        memory: &mut LayerMemory<V>,
        each_body: impl FnMut(usize, Defects<V::Scalar>),
    ) -> Result<LayerReports<V::Scalar>, LayerError> {
        let [nx, ny, _] = self.grid.cells();
        let AreaSlices { union, sides, cells, numbers, pieces, fractions_known } = areas;
        for found in [union.len(), sides.len(), cells.len(), numbers.len()] {
            exactly(nx * ny, found)?;
        }
        // Flags of the plane below have then been replaced by those of the plane above.
        let has_top = !beta.top.is_empty();
        let beside = if fractions_known { Beside::Sides } else { Beside::Fractions };
        let mut surface = LayerSurface::new(numbers, cells, pieces, beside);
        let report = self.measure(k, (beta, bounds), memory, (&mut (), &mut surface), each_body)?;
        let walls = Walls { flags: Fields::within(&self.grid, &mut *memory.has_surface)?, has_top, nx };
        Ok((report, noted(&surface, &walls, union, sides)))
    }

    /// Add to the areas of the union what is wetted in the planes of grid, for which the faces of neighbouring layers must be known, and drop the surface of
    /// cells that are closed. `open` holds the open fractions of layer `k`, `sides` and `union` as many entries as [`AreaReport`] tells.
    ///
    /// # Errors
    /// [`LayerError`]: no such layer, slices of wrong length.
    pub fn finish_areas(
        &self,
        k: usize,
        open: &OpenLayer<V::Scalar>,
        sides: &[CellSides<V::Scalar>],
        union: &mut [SurfaceCell<V::Scalar>],
    ) -> Result<(), LayerError> {
        let [nx, _] = self.cells_of_layer(k, None)?;
        open.check(&self.grid)?;
        for CellSides { cell, solid, .. } in sides {
            let (c, Some(solid)) = (*cell as usize, solid) else { continue };
            let at = [c.checked_rem(nx).unwrap_or(0), c.checked_div(nx).unwrap_or(0)];
            let (Some(blocked), Some(cell)) = (open.blocked(at, nx), self.grid.cell_box([at[0], at[1], k])) else {
                continue;
            };
            let own = union.binary_search_by_key(&c, |own| own.cell as usize).ok();
            if let Some(own) = own.and_then(|at| union.get_mut(at)) {
                own.area.wetted += in_planes(cell, &blocked, solid);
            }
        }
        for SurfaceCell { cell, area, .. } in union {
            if !open.cell.get(*cell as usize).is_some_and(|&open| open > V::Scalar::ZERO) {
                // Another body holds all that surface.
                *area = SurfaceArea::default();
            }
        }
        Ok(())
    }
}

/// In the planes of which faces of a layer surface lies.
struct Walls<'a> {
    flags: Fields<'a, u8>,
    /// In that above, for all that is known.
    has_top: bool,
    nx: usize,
}

impl Walls<'_> {
    /// What has been kept of a cell.
    fn kept<R: Real>(&self, c: usize, cell: &CellSurface<R>) -> KeptCell {
        if cell.kept == CellPieces::None && cell.bodies == Bodies::None {
            // Without pieces nobody asks for the sides.
            return KeptCell::default();
        }
        let is_wall = |faces: &[u8], at: usize| faces.get(at).is_none_or(|&flag| flag != 0);
        let (flags, x) = (&self.flags, c + c.checked_div(self.nx).unwrap_or(0));
        let walls = [
            is_wall(flags.x, x) || is_wall(flags.x, x + 1),
            is_wall(flags.y, c) || is_wall(flags.y, c + self.nx),
            self.has_top || cell.wall_on_top || is_wall(flags.z, c),
        ];
        let bodies = if cell.has_sheets() { Bodies::Several } else { cell.bodies };
        KeptCell { pieces: cell.kept, walls, bodies, entered_once: false }
    }
}

/// Write the areas of the union with what has been kept, and the sides of those cells whose wetted area asks for their faces.
fn noted<R: Real>(
    surface: &LayerSurface<R>,
    walls: &Walls,
    union: &mut [SurfaceCell<R>],
    sides: &mut [CellSides<R>],
) -> AreaReport<R> {
    let mut report = AreaReport { kept: surface.used(), ..AreaReport::default() };
    for (c, own) in surface.cells() {
        let (area, kept) = (area_of(own, c, &mut report, sides), walls.kept(c, own));
        if !(area.wetted > R::ZERO) && kept == KeptCell::default() {
            continue;
        }
        if let Some(place) = union.get_mut(report.cells) {
            *place = SurfaceCell { cell: c as u32, area, kept };
            report.cells += 1;
        }
    }
    report
}

/// The areas of the union in a cell, which is added to the report.
fn area_of<R: Real>(
    surface: &CellSurface<R>,
    c: usize,
    report: &mut AreaReport<R>,
    sides: &mut [CellSides<R>],
) -> SurfaceArea<R> {
    let sum = surface.sum();
    if !(sum.wetted > R::ZERO) {
        return sum;
    }
    report.sum = report.sum.plus(sum);
    let is_of_one = surface.bodies == Bodies::None || (surface.bodies != Bodies::Several && !surface.has_sheets());
    if is_of_one {
        return sum;
    }
    let (found, (sheets, in_sheets)) = (surface.of_union(), surface.seen_sheets());
    let (mut area, doubt) = (found.area.plus(sheets), found.doubt + in_sheets);
    if doubt > R::ZERO {
        report.unproved += 1;
        report.max_doubt = report.max_doubt.max(doubt);
    }
    let solid = found.sides.filter(|_| surface.in_planes() > R::ZERO);
    if solid.is_none() {
        area.wetted += surface.in_planes();
    }
    if let Some(place) = sides.get_mut(report.sides).filter(|_| solid.is_some() || !found.exact) {
        *place = CellSides { cell: c as u32, exact: found.exact, solid };
        report.sides += 1;
    }
    area
}

impl<V: Vector> UnionSums<V> for LayerSurface<'_, V::Scalar> {
    type Found = UnionSurface<V::Scalar>;

    fn wants_fractions(&self) -> bool {
        self.beside == Beside::Fractions
    }

    fn wants_union(&self, cell: usize) -> bool {
        self.cell(cell).is_some_and(CellSurface::wants_union)
    }

    fn sheets(&self, cell: usize) -> Option<impl Iterator<Item = &[[V::Scalar; 3]]> + Clone> {
        self.cell(cell).filter(|surface| surface.may_hide_sheets())?;
        self.sheets_in(cell)
    }

    fn set_free_sheets(&mut self, cell: usize, free: SurfaceArea<V::Scalar>) {
        if let Some(surface) = self.cell_mut(cell) {
            surface.free_sheets = Some(free);
        }
    }

    fn settle(&mut self, (number, cell): (usize, Aabb<V>), solid: V::Scalar) -> bool {
        let Some((surface, pieces)) = self.of_one(number) else { return false };
        let sides = (surface.in_planes() > V::Scalar::ZERO).then(|| sides_of_one(cell, pieces, solid));
        let found = UnionSurface { area: surface.inside, exact: true, sides, ..UnionSurface::default() };
        UnionSums::<V>::set_union(self, number, found);
        true
    }

    fn set_union(&mut self, cell: usize, found: UnionSurface<V::Scalar>) {
        if let Some(surface) = self.cell_mut(cell) {
            surface.union = Some(found);
        }
    }

    fn divide_union<O: OtherBodies<V>>(
        &mut self,
        shared: &mut Shared<V, O>,
        site: &Site<V>,
        (number, cell): (usize, Aabb<V>),
        mut spare: SpareMemory<V>,
    ) {
        let wants_sides = self.beside != Beside::Nothing;
        let Some(surface) = self.cell_mut(number) else { return };
        let layers = site.k..site.k + 1;
        let inside = with_effort(shared, site, layers, |shared| parts_of(shared, site, cell, spare.reborrow()));
        let (area, mut doubt) = inside.unwrap_or((surface.inside, surface.inside.wetted));
        let mut sides = None;
        if wants_sides && surface.in_planes() > V::Scalar::ZERO {
            let middles = |r: Refined<V::Scalar>| [0, 1, 2].map(|a| [r.low[a], r.high[a]].map(Bounds::middle));
            sides = divide(shared, site, within_sides(cell), spare).map(middles);
            if sides.is_none() {
                doubt += surface.in_planes();
            }
        }
        surface.union = Some(UnionSurface { area, doubt, sides, exact: false });
    }
}

/// Solid fractions of the sides of a cell, low and high along each axis, as seen from inside, where one body has these pieces of surface and `solid` is
/// its share of the cell. Along an axis i, over its pieces in the frame of the cell, the share is that of the low side − ∫ n_i (1 − x_i) dA, and the high side has that of the
/// low one − ∫ n_i dA.
fn sides_of_one<'p, V: Vector>(
    cell: Aabb<V>,
    pieces: impl Iterator<Item = &'p [[V::Scalar; 3]]>,
    solid: V::Scalar,
) -> Sides<V::Scalar>
where
    V::Scalar: 'p,
{
    let frame = Frame::of(cell);
    let (mut flux, mut moment) = ([V::Scalar::ZERO; 3], [V::Scalar::ZERO; 3]);
    for corners in pieces {
        integrate(&frame.framed_polygon(corners), &mut flux, &mut moment);
    }
    [0, 1, 2].map(|axis| {
        let low = solid + moment[axis];
        [low, low - flux[axis]].map(|side| side.max(V::Scalar::ZERO).min(V::Scalar::ONE))
    })
}

/// Area of the surface in the planes of a cell's sides that is wetted from the cell: what is blocked, less what is solid on this side of it.
fn in_planes<V: Vector>(cell: Aabb<V>, blocked: &Sides<V::Scalar>, solid: &Sides<V::Scalar>) -> V::Scalar {
    let (across, mut sum) = (side_areas(cell), V::Scalar::ZERO);
    for axis in 0..3 {
        for side in 0..2 {
            let share = blocked[axis][side] - solid[axis][side];
            if share > known() {
                sum += share * across[axis];
            }
        }
    }
    sum
}

/// By how much a cell is made smaller at each side so that what lies in the planes of its sides, or beyond, is not seen: in cells, and in ε of the coordinates.
const WITHIN: (f64, f64) = (1e-7, 4.0);

/// A cell but for a margin at its sides: what a cell that is divided finds of its sides is what all bodies close of them, also those that only touch it.
fn within_sides<V: Vector>(cell: Aabb<V>) -> Aabb<V> {
    let (lo, hi) = (cell.min.to_array(), cell.max.to_array());
    let margin = |a: usize| {
        let (share, coordinates) = (V::Scalar::from_f64(WITHIN.0), lo[a].abs().max(hi[a].abs()));
        let in_cells = share.max(V::Scalar::EPSILON * V::Scalar::from_f64(64.0)) * (hi[a] - lo[a]);
        in_cells.max(V::Scalar::EPSILON * V::Scalar::from_f64(WITHIN.1) * coordinates)
    };
    let [x, y, z] = [0, 1, 2].map(margin);
    Aabb { min: V::new(lo[0] + x, lo[1] + y, lo[2] + z), max: V::new(hi[0] - x, hi[1] - y, hi[2] - z) }
}

/// Where a cell without a proof is divided, as a share of its width: surface of bodies seldom lies there.
const DIVIDED_AT: f64 = 0.472_135_954_999_579_4;

/// What the union has of surface inside a cell, from its parts, and how much of the wetted area is in doubt; none if depth, memory or effort
/// is spent. Calls itself, once a level.
fn parts_of<V: Vector, O: OtherBodies<V>>(
    shared: &mut Shared<V, O>,
    site: &Site<V>,
    cell: Aabb<V>,
    spare: SpareMemory<V>,
) -> Option<(SurfaceArea<V::Scalar>, V::Scalar)> {
    let (lo, size) = (cell.min.to_array(), cell.size().to_array());
    let (hi, at) = (cell.max.to_array(), V::Scalar::from_f64(DIVIDED_AT));
    let edges = [0, 1, 2].map(|a| [lo[a], lo[a] + size[a] * at, hi[a]]);
    let grid = Grid::new(&edges[0], &edges[1], &edges[2]).ok()?;
    let SmallGrid { bins, mut layer, mut scratch, mut spare } = SmallGrid::new(site, &grid, site.k..site.k + 1, spare)?;
    let (mut total, mut doubt) = (SurfaceArea::default(), V::Scalar::ZERO);
    for k in 0..2 {
        let part = Site { grid: &grid, bins: &bins, k, areas: true, halvings: site.halvings.checked_sub(3)? };
        layer.clear();
        let (mut numbers, mut cells) = ([0; 4], [CellSurface::default(); 4]);
        let mut pieces = LayerSurface::new(&mut numbers, &mut cells, PieceMemory::default(), Beside::Nothing);
        solid_bounds(shared, &part, &mut layer, &mut scratch, spare.reborrow(), &mut pieces, |_, _| ());
        for (n, surface) in pieces.cells() {
            if layer.lower.cell.get(n).is_none_or(|&lower| lower >= V::Scalar::ONE) {
                continue;
            }
            let found = surface.of_union();
            (total, doubt) = (total.plus(found.area), doubt + found.doubt);
        }
    }
    Some((total, doubt))
}
