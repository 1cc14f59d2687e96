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
}

impl<R: Real> CellSurface<R> {
    /// The sum over all bodies, whether they overlap or not.
    pub(super) fn sum(&self) -> SurfaceArea<R> {
        let SurfaceArea { frontal, wetted } = self.inside.plus(self.sheets);
        SurfaceArea { frontal, wetted: wetted + self.in_plane }
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

/// Gather what single bodies have of surface in each cell of layer `k`; `cells` is `ny*nx`, x fastest.
pub(super) fn gather<V: Vector>(
    bins: &Bins<V>,
    grid: &Grid<V::Scalar>,
    k: usize,
    cells: &mut [CellSurface<V::Scalar>],
) {
    cells.fill(CellSurface::default());
    let nx = grid.cells()[0];
    for group in bins.groups(k) {
        let triangles = bins.triangles(group);
        for corners in bins.ids(group).iter().filter_map(|&id| triangles.get(id as usize)) {
            spread(grid, k, &corners.map(Vector::to_array), &mut |[i, j], place, polygon| {
                let Some(cell) = cells.get_mut(j * nx + i) else { return };
                let area = SurfaceArea::of_polygon(polygon.doubled_area());
                match (group.sheet, place) {
                    (true, Place::Inside) => cell.sheets = cell.sheets.plus(area),
                    (true, Place::InPlane) => cell.sheets.wetted += area.wetted,
                    (false, Place::Inside) => cell.inside = cell.inside.plus(area),
                    (false, Place::InPlane) => cell.in_plane += area.wetted,
                }
                if !group.sheet {
                    cell.bodies = match cell.bodies {
                        Bodies::None => Bodies::One(group.body),
                        Bodies::One(body) if body == group.body => Bodies::One(body),
                        _ => Bodies::Several,
                    };
                }
            });
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
