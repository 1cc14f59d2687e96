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
    /// Something is made of them.
    const WANTED: bool;
    /// The pieces that follow are of this body, which may be a sheet without volume.
    fn begin_body(&mut self, body: u32, sheet: bool);
    /// A piece that counts for a cell of the layer, by twice its area vector.
    fn add(&mut self, cell: usize, place: Place, doubled_area: [R; 3]);
}

impl<R> PieceSums<R> for () {
    const WANTED: bool = false;
    #[inline(always)]
    fn begin_body(&mut self, _: u32, _: bool) {}
    #[inline(always)]
    fn add(&mut self, _: usize, _: Place, _: [R; 3]) {}
}

/// What one cell holds of single bodies' surfaces. The default serves as memory.
#[derive(Clone, Copy, Debug, Default)]
pub struct CellSurface<R> {
    /// Inside the cell.
    pub(super) inside: SurfaceArea<R>,
    /// Wetted area in the planes of its faces.
    pub(super) in_plane: R,
    /// Of sheets without volume, both sides.
    pub(super) sheets: SurfaceArea<R>,
    pub(super) bodies: Bodies,
    /// Of several bodies, what their union has.
    pub(super) union: Option<UnionSurface<R>>,
}

impl<R: Real> CellSurface<R> {
    /// The sum over all bodies, whether they overlap or not.
    pub(super) fn sum(&self) -> SurfaceArea<R> {
        let SurfaceArea { frontal, wetted } = self.inside.plus(self.sheets);
        SurfaceArea { frontal, wetted: wetted + self.in_plane }
    }

    /// What the union of the bodies with volume has inside the cell, as far as it is known.
    pub(super) fn of_union(&self) -> UnionSurface<R> {
        let alone = UnionSurface { area: self.inside, ..UnionSurface::default() };
        match self.bodies {
            Bodies::Several if self.inside.wetted > R::ZERO => {
                self.union.unwrap_or(UnionSurface { doubt: self.inside.wetted, ..alone })
            }
            // Without surface inside, a cell that is not closed is open up to its sides.
            Bodies::Several => UnionSurface { exact: true, sides: Some([[R::ZERO; 2]; 3]), ..alone },
            _ => UnionSurface { exact: true, ..alone },
        }
    }
}

/// The bodies with volume that have surface in a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Bodies {
    #[default]
    None,
    One(u32),
    Several,
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

/// The surfaces in the cells of a layer, gathered piece by piece.
pub(super) struct LayerSurface<'a, R> {
    /// `ny*nx`, x fastest.
    cells: &'a mut [CellSurface<R>],
    body: u32,
    sheet: bool,
}

impl<'a, R: Real> LayerSurface<'a, R> {
    /// Of nothing yet.
    pub fn new(cells: &'a mut [CellSurface<R>]) -> Self {
        cells.fill(CellSurface::default());
        LayerSurface { cells, body: 0, sheet: false }
    }

    /// What has been gathered.
    pub fn cells(&self) -> &[CellSurface<R>] {
        self.cells
    }

    /// What a cell holds; none if there is no such cell.
    pub fn cell_mut(&mut self, cell: usize) -> Option<&mut CellSurface<R>> {
        self.cells.get_mut(cell)
    }
}

impl<R: Real> PieceSums<R> for LayerSurface<'_, R> {
    const WANTED: bool = true;

    fn begin_body(&mut self, body: u32, sheet: bool) {
        (self.body, self.sheet) = (body, sheet);
    }

    #[inline(always)]
    fn add(&mut self, cell: usize, place: Place, doubled_area: [R; 3]) {
        let Some(cell) = self.cells.get_mut(cell) else { return };
        let area = SurfaceArea::of_polygon(doubled_area);
        match (self.sheet, place) {
            (true, Place::Inside) => cell.sheets = cell.sheets.plus(area),
            (true, Place::InPlane) => cell.sheets.wetted += area.wetted,
            (false, Place::Inside) => cell.inside = cell.inside.plus(area),
            (false, Place::InPlane) => cell.in_plane += area.wetted,
        }
        if !self.sheet {
            cell.bodies = match cell.bodies {
                Bodies::None => Bodies::One(self.body),
                Bodies::One(body) if body == self.body => Bodies::One(body),
                _ => Bodies::Several,
            };
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
                for (sum, &weight) in cell.iter_mut().zip(weights) {
                    for (sum, area) in sum.iter_mut().zip(area) {
                        *sum += weight * area;
                    }
                }
            });
        }
    }
}
