//! Frontal area of the bodies in the cells of a layer, weighted by body: of all their surface, or of what no other body hides.

use super::Layers;
use super::error::LayerError;
use super::memory::LayerMemory;
use crate::grid::fields::exactly;
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};
use crate::surface::bins::{Bins, Group, Rest, Row, RowTriangles};
use crate::surface::cell_unions::{side_areas, with_least_blur};
use crate::surface::clip::Polygon;
use crate::surface::surface_area::{SurfaceArea, add_weighted, gather_weighted};
use crate::surface::union::{CellUnion, Frame, NoProof, UnionMemory};
use heapless::Vec;

/// Frontal areas along x, y and z, by weight.
type Weighted<R, const N: usize> = [[R; 3]; N];

/// Those, and the sum over the axes of frontal areas without weights.
type WithSum<R, const N: usize> = (Weighted<R, N>, R);

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
    /// all bodies in a cell have the same weights, the sums stay. Tells in how many cells more than the tolerance of the frontal area is in parts where the union
    /// has no proof: there all of it counts.
    ///
    /// # Errors
    /// [`LayerError`]: no such layer, a slice of wrong length, memory of another grid.
    pub fn visible_frontal_areas<const N: usize>(
        &self,
        k: usize,
        (weights, wanted): (&[[V::Scalar; N]], &[bool]),
        sums: &mut [Weighted<V::Scalar, N>],
        memory: &mut LayerMemory<V>,
    ) -> Result<usize, LayerError> {
        let [nx, ny] = self.cells_of_layer(k, Some(memory))?;
        exactly(nx * ny, wanted.len())?;
        exactly(nx * ny, sums.len())?;
        let LayerMemory { numbers, groups, union, .. } = memory;
        let (mut cells, mut unproved, zero) = (wanted.iter().zip(sums), 0, V::Scalar::ZERO);
        for j in 0..ny {
            let mut row = None;
            for (i, (_, sum)) in cells.by_ref().take(nx).enumerate().filter(|(_, (wanted, _))| **wanted) {
                let Some(cell) = self.grid.cell_box([i, j, k]) else { continue };
                if row.is_none() {
                    row = Row::new(&self.bins, k, [cell.min.y(), cell.max.y()], (&mut *numbers, &mut *groups));
                }
                let Some(row) = &mut row else {
                    unproved += 1;
                    continue;
                };
                let around = Around { bins: &self.bins, k, row: row.triangles };
                if around.weights_differ(cell, weights) {
                    let memory = (union.reborrow(), (&mut *row.rest.0, &mut *row.rest.1));
                    let mut found = InParts { tol: self.options.tol, left: MOST_EFFORT, proved: zero, doubtful: zero };
                    *sum = found.sums(memory, (around, cell), weights, MOST_LEVELS);
                    unproved += usize::from(found.doubtful > found.tol * (found.proved + found.doubtful));
                }
            }
        }
        Ok(unproved)
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
    row: RowTriangles<'a, V>,
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

/// The search for weighted areas of a cell in its parts.
struct InParts<R> {
    tol: R,
    /// So many triangles may still be looked at.
    left: usize,
    /// Frontal areas of the surface of the union, summed over the axes: where it has a proof, and of all surface where it has none.
    proved: R,
    doubtful: R,
}

impl<R: Real> InParts<R> {
    /// The weighted areas of the surface of the union in a cell; where that has no proof, in its parts, so many `levels` of them; where these have none, of all
    /// surface. The triangles of each part are listed in the second memory, as far as it goes. Calls itself, once a level.
    fn sums<V: Vector<Scalar = R>, const N: usize>(
        &mut self,
        (mut memory, (numbers, groups)): (UnionMemory<R>, Rest<V>),
        (around, cell): (Around<V>, Aabb<V>),
        weights: &[[R; N]],
        levels: u32,
    ) -> Weighted<R, N> {
        let narrowed = around.row.narrowed(around.bins, cell, (&mut *numbers, &mut *groups));
        let (row, rest) = narrowed.unwrap_or((around.row, Default::default()));
        let around = Around { row, ..around };
        let affordable = self.left.checked_sub(around.triangle_count(cell));
        self.left = affordable.unwrap_or(0);
        let mut whole = || with_least_blur(self.tol, |blur| of_union(memory.reborrow(), (around, cell), blur, weights));
        if let Some((sums, area)) = affordable.and_then(|_| whole()) {
            self.proved += area;
            return sums;
        }
        let Some(levels) = affordable.and(levels.checked_sub(1)) else {
            let (sums, area) = of_all(around, cell, weights);
            self.doubtful += area;
            return sums;
        };
        let (lo, hi) = (cell.min.to_array(), cell.max.to_array());
        let cut = [0, 1, 2].map(|n| lo[n] + (hi[n] - lo[n]) * R::from_f64(CUT));
        let mut sums = [[R::ZERO; 3]; N];
        for part in 0..8 {
            let corner = |low: [R; 3], high: [R; 3]| {
                let [x, y, z] = [0, 1, 2].map(|n| if part >> n & 1 == 1 { high[n] } else { low[n] });
                V::new(x, y, z)
            };
            let part = Aabb { min: corner(lo, cut), max: corner(cut, hi) };
            let memory = (memory.reborrow(), (&mut *rest.0, &mut *rest.1));
            let found = self.sums(memory, (around, part), weights, levels);
            for (sum, found) in sums.iter_mut().zip(found) {
                *sum = [0, 1, 2].map(|n| sum[n] + found[n]);
            }
        }
        sums
    }
}

/// Adds the frontal areas of a piece of surface, multiplied by some weights, to such sums, and the sum over the axes to another.
fn add<R: Real, const N: usize>(
    (sums, all): (&mut Weighted<R, N>, &mut R),
    weights: &[R; N],
    piece: &Polygon<R>,
    across: [R; 3],
) {
    let area = SurfaceArea::of_framed(piece, across).frontal;
    add_weighted(sums, weights, area);
    let [x, y, z] = area;
    *all += x + y + z;
}

/// The weighted areas of all surface in a cell, and its frontal areas summed over the axes.
fn of_all<V: Vector, const N: usize>(
    around: Around<V>,
    cell: Aabb<V>,
    weights: &[[V::Scalar; N]],
) -> WithSum<V::Scalar, N> {
    let (across, mut sums, mut all) = (side_areas(cell), [[V::Scalar::ZERO; 3]; N], V::Scalar::ZERO);
    let bodies = around.bodies(cell).map(|group| (group, around.row.ids(group)));
    let sheets = around.sheets(cell).map(|group| (group, around.bins.ids(group)));
    for (group, ids) in bodies.chain(sheets) {
        let Some(weights) = weights.get(group.body as usize) else { continue };
        // Nothing fails here.
        _ = pieces(around.bins, (group, ids), cell, |piece| {
            add((&mut sums, &mut all), weights, piece, across);
            Ok(())
        });
    }
    (sums, all)
}

/// What each of some triangles of a body has inside a cell, in the frame of the cell.
fn pieces<V: Vector>(
    bins: &Bins<V>,
    (group, ids): (&Group<V>, &[u32]),
    cell: Aabb<V>,
    mut tell: impl FnMut(&Polygon<V::Scalar>) -> Result<(), NoProof>,
) -> Result<(), NoProof> {
    let (frame, triangles) = (Frame::of(cell), bins.triangles(group));
    let (mut scratch, mut piece) = (Default::default(), Polygon::default());
    for corners in ids.iter().filter_map(|&id| triangles.get(id as usize)) {
        if frame.inside(&corners.map(Vector::to_array), cell, &mut scratch, &mut piece).is_some() {
            tell(&piece)?;
        }
    }
    Ok(())
}

/// Does a body that has no surface inside a part of a cell of the row fill it? Then all beams from its middle to higher x leave the body once more than they enter it.
fn fills<V: Vector>(bins: &Bins<V>, row: RowTriangles<V>, group: &Group<V>, cell: Aabb<V>) -> bool {
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

/// The weighted areas of the surface of the union in a cell, and of the sheets outside it; the frontal areas summed over the axes; and the error of the union.
fn of_union<V: Vector, const N: usize>(
    memory: UnionMemory<V::Scalar>,
    (around, cell): (Around<V>, Aabb<V>),
    blur: V::Scalar,
    weights: &[[V::Scalar; N]],
) -> Result<(WithSum<V::Scalar, N>, V::Scalar), NoProof> {
    let Around { bins, row, .. } = around;
    let (across, mut sums, mut all) = (side_areas(cell), [[V::Scalar::ZERO; 3]; N], V::Scalar::ZERO);
    let mut union = CellUnion::new(memory, cell, blur);
    let mut bodies: Vec<u32, MOST_BODIES> = Vec::new();
    for group in around.bodies(cell) {
        let before = union.part_count();
        union.add(cell, false, bins.triangles(group), row.ids(group).iter().copied())?;
        if union.part_count() > before {
            bodies.push(group.body).map_err(|_| NoProof::Full)?;
        } else if fills(bins, row, group, cell) {
            return Ok(((sums, all), V::Scalar::ZERO));
        }
    }
    let found = union.cell_and_surface(&mut |own, kept| {
        if let Some(weights) = bodies.get(own).and_then(|&body| weights.get(body as usize)) {
            add((&mut sums, &mut all), weights, kept, across);
        }
    })?;
    for group in around.sheets(cell) {
        let Some(weights) = weights.get(group.body as usize) else { continue };
        pieces(bins, (group, bins.ids(group)), cell, |piece| {
            union.free_parts(piece, |part| add((&mut sums, &mut all), weights, part, across)).map(|_| ())
        })?;
    }
    Ok(((sums, all), found.error))
}
