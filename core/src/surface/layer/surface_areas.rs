//! Frontal and wetted area of the union in the cells of a layer.

use super::error::LayerError;
use super::memory::LayerMemory;
use super::parts::{self, SmallGrid};
use super::solid_bounds::solid_bounds;
use super::{Layers, MOST_HALVINGS};
use crate::grid::Grid;
use crate::grid::bounds::Bounds;
use crate::grid::fields::exactly;
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};
use crate::surface::bins::Row;
use crate::surface::cell_unions::{
    Effort, Refined, Room, Shared, Site, bodies_in, divide, rounding, with_effort, with_least_blur,
};
use crate::surface::surface_area::{Bodies, CellSurface, SurfaceArea, gather, gather_weighted};
use crate::surface::union::NoProof;

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
    /// Cells that several bodies share and whose union has no proof, even divided: their areas lie between that of one body and the sum.
    pub unproved: usize,
    /// The largest wetted area that is in doubt in one cell.
    pub max_doubt: R,
}

impl<V: Vector> Layers<'_, V> {
    /// Areas of the union's surface in the cells of layer `k`, and the sums over all bodies whether they overlap or not, both `ny*nx`, x
    /// fastest, in the unit of the grid. `open` holds the layer's open fractions, `cells` is memory, `ny*nx`. Sheets count as they are.
    ///
    /// # Errors
    /// [`LayerError`]: no such layer, slices of wrong length, memory of another grid.
    pub fn surface_areas(
        &self,
        k: usize,
        open: &OpenLayer<V::Scalar>,
        [union, sum]: [&mut [SurfaceArea<V::Scalar>]; 2],
        cells: &mut [CellSurface<V::Scalar>],
        memory: &mut LayerMemory<V>,
    ) -> Result<AreaReport<V::Scalar>, LayerError> {
        let [nx, ny, layers] = self.grid.cells();
        if k >= layers {
            return Err(LayerError::NoLayer { layer: k, layers });
        }
        (memory.cells == [nx, ny]).then_some(()).ok_or(LayerError::OtherGrid)?;
        open.check(&self.grid)?;
        for found in [union.len(), sum.len(), cells.len()] {
            exactly(nx * ny, found)?;
        }
        let LayerMemory { reals, flags, numbers, groups, union: trees, .. } = memory;
        let mut shared = Shared {
            tol: self.options.tol,
            others: &mut (),
            union: trees.reborrow(),
            parts: parts::parts,
            effort: Effort::default(),
        };
        let halvings = 3 * self.options.depth.min(MOST_HALVINGS);
        let site = Site { grid: &self.grid, bins: &self.bins, k, halvings, areas: true };
        gather(&self.bins, &self.grid, k, cells);
        let mut report: AreaReport<V::Scalar> = AreaReport::default();
        for j in 0..ny {
            let mut row = None;
            for i in 0..nx {
                let c = j * nx + i;
                let (Some(surface), Some(&open_share)) = (cells.get(c), open.cell.get(c)) else { continue };
                let (Some(union), Some(sum)) = (union.get_mut(c), sum.get_mut(c)) else { continue };
                *sum = surface.sum();
                *union = SurfaceArea::default();
                if !(open_share > V::Scalar::ZERO) {
                    // Another body holds all that surface.
                    continue;
                }
                *union = *sum;
                if surface.bodies != Bodies::Several {
                    continue;
                }
                let (Some(cell), Some(blocked)) = (site.grid.cell_box([i, j, k]), open.blocked([i, j], nx)) else {
                    continue;
                };
                if row.is_none() {
                    let ends = [cell.min.y(), cell.max.y()];
                    row = Row::new(site.bins, k, ends, (&mut *numbers, &mut *groups));
                }
                let Some(row) = &mut row else { continue };
                let place = SharedCell { cell, surface, blocked };
                let (area, doubt) = of_shared_cell(&mut shared, &site, &place, row, (&mut *reals, &mut *flags));
                *union = area;
                if let Some(doubt) = doubt {
                    report.unproved += 1;
                    report.max_doubt = report.max_doubt.max(doubt);
                }
            }
        }
        Ok(report)
    }
}

impl<V: Vector> Layers<'_, V> {
    /// Sums over all bodies, whether they overlap or not, of the frontal areas along x, y and z in the cells of layer `k`, each multiplied by `N`
    /// weights of its body; `sums` is `ny*nx`, x fastest, and a body without weights does not count.
    ///
    /// # Errors
    /// [`LayerError`]: no such layer, a slice of wrong length.
    pub fn weighted_frontal_areas<const N: usize>(
        &self,
        k: usize,
        weights: &[[V::Scalar; N]],
        sums: &mut [[[V::Scalar; 3]; N]],
    ) -> Result<(), LayerError> {
        let [nx, ny, layers] = self.grid.cells();
        if k >= layers {
            return Err(LayerError::NoLayer { layer: k, layers });
        }
        exactly(nx * ny, sums.len())?;
        sums.fill([[V::Scalar::ZERO; 3]; N]);
        gather_weighted(&self.bins, &self.grid, k, weights, sums);
        Ok(())
    }
}

/// A cell in which several bodies have surface.
struct SharedCell<'a, V: Vector> {
    cell: Aabb<V>,
    surface: &'a CellSurface<V::Scalar>,
    /// Solid fractions of its sides.
    blocked: Sides<V::Scalar>,
}

/// The area of the union in a cell, and what of its wetted area is in doubt, if there is no proof.
fn of_shared_cell<V: Vector>(
    shared: &mut Shared<V, ()>,
    site: &Site<V>,
    SharedCell { cell, surface, blocked }: &SharedCell<V>,
    row: &mut Row<V>,
    (reals, flags): (&mut [V::Scalar], &mut [u8]),
) -> (SurfaceArea<V::Scalar>, Option<V::Scalar>) {
    let (inside, sides, doubt) = match fragments(shared, site, *cell, row) {
        Some(Fragments { area, sides }) => (area, Some(sides), None),
        None => {
            let mut room = Room { reals, flags, numbers: row.rest.0, groups: row.rest.1 };
            let inside =
                with_effort(shared, site, site.k..site.k + 1, |shared| parts_of(shared, site, *cell, room.reborrow()));
            let sides =
                divide(shared, site, *cell, room).map(|Refined { low, high, .. }| [0, 1, 2].map(|a| [low[a], high[a]]));
            let (area, doubt) = inside.unwrap_or((surface.inside, surface.inside.wetted));
            (
                area,
                sides.map(|sides| sides.map(|side| side.map(Bounds::middle))),
                (doubt > V::Scalar::ZERO).then_some(doubt),
            )
        }
    };
    let mut area = inside.plus(surface.sheets);
    if surface.in_plane > V::Scalar::ZERO {
        area.wetted += sides.map_or(surface.in_plane, |sides| in_planes(*cell, blocked, &sides));
    }
    (area, doubt)
}

/// Area of the surface in the planes of a cell's sides that is wetted from the cell: what is blocked, less what is solid on this side of it.
fn in_planes<V: Vector>(cell: Aabb<V>, blocked: &Sides<V::Scalar>, solid: &Sides<V::Scalar>) -> V::Scalar {
    let (across, mut sum) = (side_areas(cell), V::Scalar::ZERO);
    for axis in 0..3 {
        for side in 0..2 {
            let share = blocked[axis][side] - solid[axis][side];
            if share > rounding() {
                sum += share * across[axis];
            }
        }
    }
    sum
}

/// Areas of a cell's sides normal to x, y and z.
fn side_areas<V: Vector>(cell: Aabb<V>) -> [V::Scalar; 3] {
    let [x, y, z] = cell.size().to_array();
    [y * z, z * x, x * y]
}

/// What the union has of surface inside a cell.
struct Fragments<R> {
    area: SurfaceArea<R>,
    sides: Sides<R>,
}

/// What the union of all bodies has of surface inside a cell, and the solid fractions of the cell's sides; none without a proof.
fn fragments<V: Vector>(
    shared: &mut Shared<V, ()>,
    site: &Site<V>,
    cell: Aabb<V>,
    row: &Row<V>,
) -> Option<Fragments<V::Scalar>> {
    let across = side_areas(cell);
    with_least_blur(shared.tol, |blur| {
        let mut union = bodies_in(shared.union.reborrow(), site, cell, row, blur)?;
        let mut area = SurfaceArea::default();
        let found = union.cell_and_surface(|kept| {
            let [x, y, z] = kept.doubled_area();
            area = area.plus(SurfaceArea::of_polygon([x * across[0], y * across[1], z * across[2]]));
        })?;
        let sides = [0, 1, 2].map(|axis| [found.low[axis], found.high[axis]]);
        Ok::<_, NoProof>((Fragments { area, sides }, found.error))
    })
}

/// Where a cell without a proof is divided, as a share of its width: surface of bodies seldom lies there.
const DIVIDED_AT: f64 = 0.472_135_954_999_579_4;

/// What the union has of surface inside a cell, from its parts, and how much of the wetted area is in doubt; none if depth, memory or effort
/// is spent. Calls itself, once a level.
fn parts_of<V: Vector>(
    shared: &mut Shared<V, ()>,
    site: &Site<V>,
    cell: Aabb<V>,
    room: Room<V>,
) -> Option<(SurfaceArea<V::Scalar>, V::Scalar)> {
    let (lo, size) = (cell.min.to_array(), cell.size().to_array());
    let (hi, at) = (cell.max.to_array(), V::Scalar::from_f64(DIVIDED_AT));
    let edges = [0, 1, 2].map(|a| [lo[a], lo[a] + size[a] * at, hi[a]]);
    let grid = Grid::new(&edges[0], &edges[1], &edges[2]).ok()?;
    let SmallGrid { bins, mut layer, mut scratch, mut room } = SmallGrid::new(site, &grid, site.k..site.k + 1, room)?;
    let (mut total, mut doubt) = (SurfaceArea::default(), V::Scalar::ZERO);
    for k in 0..2 {
        let part = Site { grid: &grid, bins: &bins, k, areas: true, halvings: site.halvings.checked_sub(3)? };
        layer.clear();
        solid_bounds(shared, &part, &mut layer, &mut scratch, room.reborrow(), |_, _| ());
        let mut cells = [CellSurface::default(); 4];
        gather(&bins, &grid, k, &mut cells);
        for (n, surface) in cells.iter().enumerate() {
            if layer.lower.cell.get(n).is_none_or(|&lower| lower >= V::Scalar::ONE) {
                continue;
            }
            let mut found = Some((surface.inside, V::Scalar::ZERO));
            if surface.bodies == Bodies::Several {
                let cell = grid.cell_box([n % 2, n / 2, k])?;
                let Room { reals, flags, numbers, groups } = room.reborrow();
                let row = Row::new(&bins, k, [cell.min.y(), cell.max.y()], (numbers, groups))?;
                found = fragments(shared, &part, cell, &row).map(|found| (found.area, V::Scalar::ZERO));
                if found.is_none() {
                    let rest = Room { reals, flags, numbers: row.rest.0, groups: row.rest.1 };
                    found = with_effort(shared, &part, k..k + 1, |shared| parts_of(shared, &part, cell, rest));
                }
            }
            let (area, open) = found.unwrap_or((surface.inside, surface.inside.wetted));
            (total, doubt) = (total.plus(area), doubt + open);
        }
    }
    Some((total, doubt))
}
