//! Frontal area of the bodies in the cells of a layer, weighted by body: of all their surface, or of what no other body hides.

use super::Layers;
use super::error::LayerError;
use super::memory::LayerMemory;
use crate::grid::fields::exactly;
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};
use crate::surface::bins::{Bins, Group, Row};
use crate::surface::cell_unions::{side_areas, with_least_blur};
use crate::surface::clip::Polygon;
use crate::surface::surface_area::{SurfaceArea, add_weighted, gather_weighted};
use crate::surface::union::{CellUnion, Frame, NoProof, UnionMemory};
use heapless::Vec;

/// Frontal areas along x, y and z, by weight.
type Weighted<R, const N: usize> = [[R; 3]; N];

/// A cell is cut at this share of its size into parts: a place in which no face is likely to lie.
const CUT: f64 = 0.487_3;

/// As often at most.
const MOST_LEVELS: u32 = 6;

/// So many triangles may be looked at for one cell.
const MOST_EFFORT: usize = 1 << 23;

/// Most bodies with surface in one cell whose own parts of it are told.
const MOST_BODIES: usize = 64;

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
        let [nx, ny] = self.cells_of_layer(k, None)?;
        exactly(nx * ny, sums.len())?;
        sums.fill([[V::Scalar::ZERO; 3]; N]);
        gather_weighted(&self.bins, &self.grid, k, weights, sums);
        Ok(())
    }

    /// Replaces such sums in those cells that are `wanted` by the same over the surface of the union, each part with the weights of the body that it is of; where
    /// all bodies in a cell have the same weights, or their union has no proof, the sums stay.
    ///
    /// # Errors
    /// [`LayerError`]: no such layer, a slice of wrong length, memory of another grid.
    pub fn visible_frontal_areas<const N: usize>(
        &self,
        k: usize,
        (weights, wanted): (&[[V::Scalar; N]], &[bool]),
        sums: &mut [Weighted<V::Scalar, N>],
        memory: &mut LayerMemory<V>,
    ) -> Result<(), LayerError> {
        let [nx, ny] = self.cells_of_layer(k, Some(memory))?;
        exactly(nx * ny, wanted.len())?;
        exactly(nx * ny, sums.len())?;
        let LayerMemory { numbers, groups, union, .. } = memory;
        let mut cells = wanted.iter().zip(sums);
        for j in 0..ny {
            let mut row = None;
            for (i, (_, sum)) in cells.by_ref().take(nx).enumerate().filter(|(_, (wanted, _))| **wanted) {
                let Some(cell) = self.grid.cell_box([i, j, k]) else { continue };
                if row.is_none() {
                    row = Row::new(&self.bins, k, [cell.min.y(), cell.max.y()], (&mut *numbers, &mut *groups));
                }
                let Some(row) = &row else { continue };
                let around = Around { bins: &self.bins, k, row };
                if around.weights_differ(cell, weights) {
                    let place = (around, cell);
                    let (limits, mut left) = ((self.options.tol, MOST_LEVELS), MOST_EFFORT);
                    *sum = in_parts(union.reborrow(), place, weights, limits, &mut left).unwrap_or(*sum);
                }
            }
        }
        Ok(())
    }
}

/// Does the box of a body share space with a cell?
fn reaches<V: Vector>(group: &Group<V>, cell: Aabb<V>) -> bool {
    let of = |a: fn(V) -> V::Scalar| a(group.bounds.max) > a(cell.min) && a(group.bounds.min) < a(cell.max);
    of(V::x) && of(V::y) && of(V::z)
}

/// The bodies with volume in a row of cells of a layer, and the sheets of the layer.
#[derive(Clone, Copy)]
struct Around<'a, V> {
    bins: &'a Bins<'a, V>,
    k: usize,
    row: &'a Row<'a, V>,
}

impl<'a, V: Vector> Around<'a, V> {
    /// Bodies with volume whose boxes reach a cell.
    fn bodies(self, cell: Aabb<V>) -> impl Iterator<Item = &'a Group<V>> {
        self.row.groups.iter().filter(move |group| reaches(group, cell))
    }

    /// Sheets whose boxes reach a cell.
    fn sheets(self, cell: Aabb<V>) -> impl Iterator<Item = &'a Group<V>> {
        self.bins.groups(self.k).iter().filter(move |group| group.is_sheet() && reaches(group, cell))
    }

    /// The triangles that may reach a cell.
    fn triangle_count(self, cell: Aabb<V>) -> usize {
        let of_bodies: usize = self.bodies(cell).map(|group| self.row.ids(group).len()).sum();
        of_bodies + self.sheets(cell).map(|group| self.bins.ids(group).len()).sum::<usize>()
    }

    /// Have two bodies that may reach a cell different weights?
    fn weights_differ<const N: usize>(self, cell: Aabb<V>, weights: &[[V::Scalar; N]]) -> bool {
        let mut here = self.bodies(cell).chain(self.sheets(cell)).map(|group| weights.get(group.body as usize));
        let first = here.next();
        here.any(|other| Some(other) != first)
    }
}

/// The weighted areas of the surface of the union in a cell; where that has no proof, in its parts, so many levels of them, while triangles are `left` to be
/// looked at. Calls itself, once a level.
fn in_parts<V: Vector, const N: usize>(
    mut memory: UnionMemory<V::Scalar>,
    (around, cell): (Around<V>, Aabb<V>),
    weights: &[[V::Scalar; N]],
    (tol, levels): (V::Scalar, u32),
    left: &mut usize,
) -> Option<Weighted<V::Scalar, N>> {
    *left = left.checked_sub(around.triangle_count(cell))?;
    let whole = with_least_blur(tol, |blur| of_union(memory.reborrow(), (around, cell), blur, weights));
    if whole.is_some() {
        return whole;
    }
    let levels = levels.checked_sub(1)?;
    let (lo, hi) = (cell.min.to_array(), cell.max.to_array());
    let cut = [0, 1, 2].map(|n| lo[n] + (hi[n] - lo[n]) * V::Scalar::from_f64(CUT));
    let mut sums = [[V::Scalar::ZERO; 3]; N];
    for part in 0..8 {
        let corner = |low: [V::Scalar; 3], high: [V::Scalar; 3]| {
            let [x, y, z] = [0, 1, 2].map(|n| if part >> n & 1 == 1 { high[n] } else { low[n] });
            V::new(x, y, z)
        };
        let part = Aabb { min: corner(lo, cut), max: corner(cut, hi) };
        let found = in_parts(memory.reborrow(), (around, part), weights, (tol, levels), left)?;
        for (sum, found) in sums.iter_mut().zip(found) {
            *sum = [0, 1, 2].map(|n| sum[n] + found[n]);
        }
    }
    Some(sums)
}

/// Does a body that has no surface inside a part of a cell of the row fill it? Then all beams from its middle to higher x leave the body once more than they enter it.
fn fills<V: Vector>(bins: &Bins<V>, row: &Row<V>, group: &Group<V>, cell: Aabb<V>) -> bool {
    let (lo, hi) = (cell.min.to_array(), cell.max.to_array());
    let far = group.bounds.max.x().max(hi[0]) + (hi[0] - lo[0]);
    let beyond = Aabb { min: V::new((lo[0] + hi[0]) * V::Scalar::HALF, lo[1], lo[2]), max: V::new(far, hi[1], hi[2]) };
    let (frame, triangles) = (Frame::of(beyond), bins.triangles(group));
    let (mut scratch, mut part) = ([Polygon::default(), Polygon::default()], Polygon::default());
    let mut leaving = V::Scalar::ZERO;
    for corners in row.ids(group).iter().filter_map(|&id| triangles.get(id as usize)) {
        let corners = corners.map(Vector::to_array);
        if let Some(doubled) = frame.inside(&corners, beyond, &mut scratch, &mut part) {
            leaving += doubled[0];
        }
    }
    // Twice the side of the frame is 2.
    leaving > V::Scalar::ONE
}

/// The weighted areas of the surface of the union in a cell, and of the sheets outside it, and the error of that.
fn of_union<V: Vector, const N: usize>(
    memory: UnionMemory<V::Scalar>,
    (around, cell): (Around<V>, Aabb<V>),
    blur: V::Scalar,
    weights: &[[V::Scalar; N]],
) -> Result<(Weighted<V::Scalar, N>, V::Scalar), NoProof> {
    let Around { bins, row, .. } = around;
    let mut union = CellUnion::new(memory, cell, blur);
    let mut bodies: Vec<u32, MOST_BODIES> = Vec::new();
    for group in around.bodies(cell) {
        let before = union.part_count();
        union.add(cell, false, bins.triangles(group), row.ids(group).iter().copied())?;
        if union.part_count() > before {
            bodies.push(group.body).map_err(|_| NoProof::Full)?;
        } else if fills(bins, row, group, cell) {
            return Ok(([[V::Scalar::ZERO; 3]; N], V::Scalar::ZERO));
        }
    }
    let (across, mut sums) = (side_areas(cell), [[V::Scalar::ZERO; 3]; N]);
    let found = union.cell_and_surface(&mut |own, kept| {
        let area = SurfaceArea::of_framed(kept, across).frontal;
        if let Some(weights) = bodies.get(own).and_then(|&body| weights.get(body as usize)) {
            add_weighted(&mut sums, weights, area);
        }
    })?;
    let (frame, mut scratch, mut piece) = (Frame::of(cell), Default::default(), Polygon::default());
    for group in around.sheets(cell) {
        let (triangles, Some(weights)) = (bins.triangles(group), weights.get(group.body as usize)) else { continue };
        for corners in bins.ids(group).iter().filter_map(|&id| triangles.get(id as usize)) {
            if frame.inside(&corners.map(Vector::to_array), cell, &mut scratch, &mut piece).is_some() {
                union.free_parts(&piece, |part| {
                    add_weighted(&mut sums, weights, SurfaceArea::of_framed(part, across).frontal);
                })?;
            }
        }
    }
    Ok((sums, found.error))
}
