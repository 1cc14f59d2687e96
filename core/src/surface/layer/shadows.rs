//! Shadows of the union in the cells of a layer.

use super::Layers;
use super::error::LayerError;
use super::surface_areas::{CellSides, KnownSurface, OpenLayer};
use crate::grid::fields::exactly;
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};
use crate::surface::bins::CellLists;
use crate::surface::cell_unions::side_areas;
use crate::surface::clip::Polygon;
use crate::surface::refined::known;
use crate::surface::shadow::{CellFaces, Outlines, ShadowMemory, ShadowSlices};
use crate::surface::surface_area::{KeptPieces, SurfaceCell};
use crate::surface::union::Frame;

impl<V: Vector> Layers<'_, V> {
    /// Numbers that are always enough for [`ShadowMemory::lists`] in layer `k`; [`Layers::shadows`] tells if fewer are too few.
    #[must_use]
    pub fn shadow_lists_needed(&self, k: usize) -> usize {
        CellLists::needed(&self.bins, &self.grid, k)
    }

    /// The shadows of the union in the cells of layer `k`, and how many of them are not exact. `open` holds the layer's open fractions; the known surface
    /// is that of [`Layers::layer_and_areas`], its areas finished by [`Layers::finish_areas`]: where these prove that no surface hides behind what a side of
    /// the cell shows, nothing is searched. Pieces that were not kept are cut again. Sheets cast shadows.
    ///
    /// # Errors
    /// [`LayerError`]: no such layer, slices of wrong length, too few lists.
    pub fn shadows(
        &self,
        k: usize,
        open: &OpenLayer<V::Scalar>,
        (kept, sides): KnownSurface<V::Scalar>,
        shadows: ShadowSlices<V::Scalar>,
        memory: ShadowMemory<V::Scalar>,
    ) -> Result<ShadowReport, LayerError> {
        let [nx, ny] = self.cells_of_layer(k, None)?;
        open.check(&self.grid)?;
        let ShadowSlices { mut share, mut place } = shadows;
        for found in share.iter().chain(&place).map(|field| field.len()) {
            exactly(nx * ny, found)?;
        }
        show_sides(open, nx, &mut share);
        let here = LayerWithFaces { layers: self, k, open, sides };
        let ShadowMemory { edges, places, lists, faces } = memory;
        let mut work = Work::new(Outlines::new(edges, places), CellFaces::new(faces));
        let (mut report, mut not_kept) = (ShadowReport::default(), false);
        let mut write = |c: usize, found: &Seen<V::Scalar>| {
            for axis in 0..3 {
                set(share[axis], c, found.share[axis]);
                set(place[axis], c, found.place[axis]);
            }
        };
        for own in kept.cells {
            let Some(mut found) = here.seen(own) else { continue };
            if found.is_doubtful() {
                let Some(cell) = here.cell_box(own.cell as usize).filter(|_| own.kept.is_complete()) else {
                    not_kept = true;
                    continue;
                };
                let loaded = load_kept(cell, kept, own, &mut work);
                report.count(loaded.and_then(|()| here.shadow(&mut work, &mut found)));
            }
            write(own.cell as usize, &found);
        }
        if !not_kept {
            return Ok(report);
        }
        let others = || {
            let not_kept = kept.cells.iter().filter(|own| !own.kept.is_complete());
            not_kept.filter_map(|own| Some((own, here.seen(own).filter(Seen::is_doubtful)?)))
        };
        let lists = CellLists::new(&self.bins, &self.grid, k, others().map(|(own, _)| own.cell as usize), lists)?;
        for (own, mut found) in others() {
            let c = own.cell as usize;
            let (Some(cell), Some(entries)) = (here.cell_box(c), lists.of(c)) else { continue };
            let loaded = here.load(cell, entries, &mut work);
            report.count(loaded.and_then(|()| here.shadow(&mut work, &mut found)));
            write(c, &found);
        }
        Ok(report)
    }
}

/// Cells of a layer whose shadows are not exact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ShadowReport {
    /// Edges cross so often that along some axis the shadow is an estimate, from its widths along 1024 lines: a thousandth of the section has not been
    /// missed by.
    pub estimated: usize,
    /// They hold more than the memory: what is given for them are the blocked shares of their sides.
    pub too_full: usize,
}

impl ShadowReport {
    /// One more cell: whether its shadows are exact, none if memory was spent.
    fn count(&mut self, exact: Option<bool>) {
        match exact {
            Some(exact) => self.estimated += usize::from(!exact),
            None => self.too_full += 1,
        }
    }
}

/// Write what the sides of the cells show, the larger of both solid fractions, and all of closed cells. Rows in which all is open stay as they are.
fn show_sides<R: Real>(open: &OpenLayer<R>, nx: usize, [x, y, z]: &mut [&mut [R]; 3]) {
    let wide = nx.max(1);
    let rows = x.chunks_exact_mut(wide).zip(y.chunks_exact_mut(wide)).zip(z.chunks_exact_mut(wide));
    for (row, ((x, y), z)) in rows.enumerate() {
        let Some(open) = OpenRow::new(open, row, nx).filter(|row| !row.is_open()) else { continue };
        for (share, [low, high]) in [x, y, z].into_iter().zip(open.sides) {
            for (((share, low), high), cell) in share.iter_mut().zip(low).zip(high).zip(open.cells) {
                *share = if *cell > R::ZERO { R::ONE - low.smaller(*high) } else { R::ONE };
            }
        }
    }
}

/// Open fractions of a row of cells.
struct OpenRow<'a, R> {
    cells: &'a [R],
    /// The low and the high sides along each axis.
    sides: [[&'a [R]; 2]; 3],
}

impl<'a, R: Real> OpenRow<'a, R> {
    fn new(open: &OpenLayer<'a, R>, row: usize, nx: usize) -> Option<Self> {
        let first = row * nx;
        let of = |field: &'a [R], from: usize| field.get(from..)?.get(..nx);
        let sides = [
            [of(open.x, first + row)?, of(open.x, first + row + 1)?],
            [of(open.y, first)?, of(open.y, first + nx)?],
            [of(open.z, first)?, of(open.top, first)?],
        ];
        Some(OpenRow { cells: of(open.cell, first)?, sides })
    }

    /// Is all of it open? Compared without a branch for each value.
    fn is_open(&self) -> bool {
        let all_open = |field: &[R]| field.iter().fold(true, |all, open| all & (*open == R::ONE));
        all_open(self.cells) && self.sides.iter().flatten().all(|side| all_open(side))
    }
}

/// Set an entry, if there is one.
fn set<R>(field: &mut [R], at: usize, value: R) {
    if let Some(entry) = field.get_mut(at) {
        *entry = value;
    }
}

/// What the sides of a cell show of the solids in it, along x, y and z.
#[derive(Clone, Copy)]
struct Seen<R> {
    /// Solid fractions of the low and the high side.
    blocked: [[R; 2]; 3],
    /// The larger of them.
    share: [R; 3],
    place: [R; 3],
    /// There may be more than that.
    doubtful: [bool; 3],
    /// Frontal areas over areas of sides, if they are known.
    frontal: Option<[R; 3]>,
}

/// Frontal area and side fit as well as this, in sides of the cell: 10⁻¹², more in `f32`.
fn fit<R: Real>() -> R {
    R::from_f64(1e-12).max(R::EPSILON * R::from_f64(256.0))
}

impl<R: Real> Seen<R> {
    /// May there be more?
    fn is_doubtful(&self) -> bool {
        self.doubtful != [false; 3]
    }

    /// Raise a share to a shadow.
    fn raise(&mut self, axis: usize, shadow: R) {
        let share = self.share[axis].max(shadow);
        self.share[axis] = if R::ONE - share <= known() { R::ONE } else { share };
    }

    /// Doubt where surface may hide. Lines enter solid in the cell on an area e and leave it on an area l. The share of lines that meet solid is at least
    /// the larger of the two blocked sides, and at most that plus the smaller of e and l. The mean of e and l is the frontal area, their difference that
    /// of the sides.
    fn doubt(&mut self) {
        let Some(frontal) = self.frontal else {
            self.doubtful = [true; 3];
            return;
        };
        for axis in 0..3 {
            if frontal[axis] == R::ZERO {
                continue;
            }
            if R::ONE - self.share[axis] <= known() {
                self.share[axis] = R::ONE;
                continue;
            }
            let [low, high] = self.blocked[axis];
            let hidden = frontal[axis] - (high - low).abs() * R::HALF;
            self.doubtful[axis] = !(hidden.abs() <= fit());
        }
    }
}

/// A layer whose open fractions are known.
struct LayerWithFaces<'a, V: Vector> {
    layers: &'a Layers<'a, V>,
    k: usize,
    open: &'a OpenLayer<'a, V::Scalar>,
    sides: &'a [CellSides<V::Scalar>],
}

impl<V: Vector> LayerWithFaces<'_, V> {
    fn at(&self, c: usize) -> [usize; 2] {
        let nx = self.layers.grid.cells()[0];
        [c.checked_rem(nx).unwrap_or(0), c.checked_div(nx).unwrap_or(0)]
    }

    fn cell_box(&self, c: usize) -> Option<Aabb<V>> {
        let [i, j] = self.at(c);
        self.layers.grid.cell_box([i, j, self.k])
    }

    /// What the sides of a cell with surface show; none where that is known to be all there is, or the cell is closed.
    fn seen(&self, own: &SurfaceCell<V::Scalar>) -> Option<Seen<V::Scalar>> {
        let (nx, c, zero) = (self.layers.grid.cells()[0], own.cell as usize, V::Scalar::ZERO);
        if own.area.frontal == [zero; 3] || !self.open.cell.get(c).is_some_and(|&share| share > zero) {
            return None;
        }
        let (blocked, cell) = (self.open.blocked(self.at(c), nx)?, self.cell_box(c)?);
        let listed = self.sides.binary_search_by_key(&c, |side| side.cell as usize).ok();
        let known = listed.and_then(|n| self.sides.get(n)).is_none_or(|side| side.exact);
        let (across, [x, y, z]) = (side_areas(cell), own.area.frontal);
        let frontal = known.then(|| [x / across[0], y / across[1], z / across[2]]);
        let share = blocked.map(|[low, high]| low.larger(high));
        let mut seen = Seen { blocked, share, place: [zero; 3], doubtful: [false; 3], frontal };
        seen.doubt();
        Some(seen)
    }

    /// Raise the doubtful shares of `found` to the shadows of the surface that has been loaded, and tell whether they are exact; none if there is no room.
    fn shadow(&self, work: &mut Work<V::Scalar>, found: &mut Seen<V::Scalar>) -> Option<bool> {
        for axis in 0..3 {
            if !found.doubtful[axis] {
                continue;
            }
            found.place[axis] = work.faces.place(axis) - V::Scalar::HALF;
            let all = match found.frontal {
                // Of a convex body lines meet on the area that they enter, and that on which they begin in it.
                Some(frontal) if work.entered_once => {
                    let [low, high] = found.blocked[axis];
                    Some(frontal[axis] + (low + high) * V::Scalar::HALF)
                }
                _ if work.walls[axis] => None,
                _ => self.passed_once(axis, work, found),
            };
            if V::Scalar::ONE - found.share[axis] <= known() || all.is_some() {
                found.raise(axis, all.unwrap_or_default());
                found.doubtful[axis] = false;
            }
        }
        let doubtful = found.doubtful;
        if doubtful == [false; 3] {
            return Some(true);
        }
        work.outlines.clear();
        work.outlines.add(&work.faces, doubtful)?;
        let mut all_exact = true;
        if !work.outlines.is_empty() {
            for axis in 0..3 {
                if doubtful[axis] {
                    let (shadow, exact) = work.outlines.shadow(axis)?;
                    found.raise(axis, shadow);
                    all_exact &= exact;
                }
            }
        }
        Some(all_exact)
    }

    /// The shadow along an axis where no line enters solid again: the section with the low side and all that is entered, which is the frontal area and the
    /// mean of the sections with both sides.
    fn passed_once(&self, axis: usize, work: &Work<V::Scalar>, found: &Seen<V::Scalar>) -> Option<V::Scalar> {
        let ([low, high], [entered, left]) = (found.blocked[axis], work.faces.passed_once(axis)?);
        // A surface that is not closed proves nothing, nor do sides that are not its own.
        if !(((entered - left) - (high - low)).abs() <= fit()) {
            return None;
        }
        if work.faces.is_one_solid() {
            return Some(low + entered);
        }
        found.frontal.map(|frontal| frontal[axis] + (low + high) * V::Scalar::HALF)
    }

    /// Take in what all bodies have of surface inside a cell; none if there is no room.
    fn load(&self, cell: Aabb<V>, entries: impl Iterator<Item = [u32; 2]>, work: &mut Work<V::Scalar>) -> Option<()> {
        let bins = &self.layers.bins;
        let (groups, frame) = (bins.groups(self.k), Frame::of(cell));
        let sides = [cell.min.to_array(), cell.max.to_array()];
        let mut last = None;
        work.faces.clear();
        (work.walls, work.entered_once) = ([false; 3], false);
        for [n, id] in entries {
            let Some(group) = groups.get(n as usize) else { continue };
            let Some(triangle) = bins.triangles(group).get(id as usize) else { continue };
            if last.replace(n) != Some(n) {
                work.faces.begin_solid(group.is_sheet());
            }
            let triangle = triangle.map(Vector::to_array);
            if let Some(doubled) = frame.inside(&triangle, cell, &mut work.scratch, work.faces.next()?) {
                work.faces.push(doubled);
                continue;
            }
            for axis in 0..3 {
                let [a, b, c] = triangle.map(|p| p[axis]);
                work.walls[axis] |= a == b && b == c && sides.iter().any(|side| side[axis] == a);
            }
        }
        Some(())
    }
}

/// Take in the pieces that have been kept of the surface inside a cell; none if there is no room.
#[inline(never)]
fn load_kept<V: Vector>(
    cell: Aabb<V>,
    kept: KeptPieces<V::Scalar>,
    own: &SurfaceCell<V::Scalar>,
    work: &mut Work<V::Scalar>,
) -> Option<()> {
    let (frame, mut last) = (Frame::of(cell), None);
    work.faces.clear();
    (work.walls, work.entered_once) = (own.kept.walls, own.kept.entered_once);
    for (corners, body, sheet) in kept.pieces(own.kept) {
        if last.replace(body) != Some(body) {
            work.faces.begin_solid(sheet);
        }
        let polygon = work.faces.next()?;
        polygon.clear();
        for corner in corners {
            polygon.push(frame.framed(*corner));
        }
        let doubled = polygon.doubled_area();
        if doubled != [V::Scalar::ZERO; 3] {
            work.faces.push(doubled);
        }
    }
    Some(())
}

/// Memory for one cell at a time.
struct Work<'m, R: Real> {
    outlines: Outlines<'m, R>,
    faces: CellFaces<'m, R>,
    /// Surface lies in the plane of a side, along x, y and z.
    walls: [bool; 3],
    /// No line enters solid twice.
    entered_once: bool,
    scratch: [Polygon<R>; 2],
}

impl<'m, R: Real> Work<'m, R> {
    fn new(outlines: Outlines<'m, R>, faces: CellFaces<'m, R>) -> Self {
        let scratch = [Polygon::default(), Polygon::default()];
        Work { outlines, faces, walls: [false; 3], entered_once: false, scratch }
    }
}
