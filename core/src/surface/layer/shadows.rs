//! Shadows of the union in the cells of a layer.

use super::Layers;
use super::error::LayerError;
use super::surface_areas::OpenLayer;
use crate::grid::fields::exactly;
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};
use crate::surface::bins::{Bins, CellLists};
use crate::surface::cell_unions::{known, side_areas};
use crate::surface::clip::Polygon;
use crate::surface::shadow::{CellFaces, Outlines, ShadowMemory, ShadowSlices};
use crate::surface::surface_area::SurfaceArea;
use crate::surface::union::Frame;

impl<V: Vector> Layers<'_, V> {
    /// Numbers that are always enough for [`ShadowMemory::lists`] in layer `k`; [`Layers::shadows`] tells if fewer are too few.
    #[must_use]
    pub fn shadow_lists_needed(&self, k: usize) -> usize {
        CellLists::needed(&self.bins, &self.grid, k)
    }

    /// The shadows of the union in the cells of layer `k`, and how many cells hold more than the memory: what is given for them are the blocked
    /// shares of their sides. `open` holds the layer's open fractions, `areas` those of [`Layers::finish_areas`], if they are known: where they
    /// prove that no surface hides what a side of the cell shows, nothing is searched. Sheets cast shadows.
    ///
    /// # Errors
    /// [`LayerError`]: no such layer, slices of wrong length, too few lists.
    pub fn shadows(
        &self,
        k: usize,
        open: &OpenLayer<V::Scalar>,
        areas: Option<&[SurfaceArea<V::Scalar>]>,
        shadows: ShadowSlices<V::Scalar>,
        memory: ShadowMemory<V::Scalar>,
    ) -> Result<usize, LayerError> {
        let [nx, ny, layers] = self.grid.cells();
        if k >= layers {
            return Err(LayerError::NoLayer { layer: k, layers });
        }
        open.check(&self.grid)?;
        let ShadowSlices { mut share, mut place } = shadows;
        for found in share.iter().chain(&place).map(|field| field.len()).chain(areas.map(<[_]>::len)) {
            exactly(nx * ny, found)?;
        }
        let at = |c: usize| [c.checked_rem(nx).unwrap_or(0), c.checked_div(nx).unwrap_or(0)];
        let seen = |c: usize| {
            let [i, j] = at(c);
            let surface = || Some((areas?.get(c)?.frontal, side_areas(self.grid.cell_box([i, j, k])?)));
            Seen::new(open, [i, j], nx, surface)
        };
        let is_doubtful = |c: usize| {
            let seen = seen(c);
            for axis in 0..3 {
                set(&mut share[axis], c, seen.share[axis]);
                set(&mut place[axis], c, V::Scalar::HALF);
            }
            seen.doubtful != [false; 3]
        };
        let ShadowMemory { edges, crossed, lists, faces } = memory;
        let lists = CellLists::new(&self.bins, &self.grid, k, is_doubtful, lists)?;
        let mut work = Work::new(Outlines::new(edges, crossed), CellFaces::new(faces));
        let mut too_full = 0;
        for c in 0..nx * ny {
            let (Some(entries), [i, j]) = (lists.of(c), at(c)) else { continue };
            let Some(cell) = self.grid.cell_box([i, j, k]) else { continue };
            let here = CellOfLayer { bins: &self.bins, k, cell, entries };
            let mut found = seen(c);
            too_full += usize::from(here.shadow(&mut work, &mut found).is_none());
            for axis in 0..3 {
                set(&mut share[axis], c, found.share[axis]);
                set(&mut place[axis], c, found.place[axis]);
            }
        }
        Ok(too_full)
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
}

/// Frontal area and side fit as well as this, in sides of the cell: 10⁻¹², more in `f32`.
fn fit<R: Real>() -> R {
    R::from_f64(1e-12).max(R::EPSILON * R::from_f64(256.0))
}

impl<R: Real> Seen<R> {
    /// Raise a share to a shadow.
    fn raise(&mut self, axis: usize, shadow: R) {
        let share = self.share[axis].max(shadow);
        self.share[axis] = if R::ONE - share <= known() { R::ONE } else { share };
    }

    /// Of a cell; `surface` gives the frontal areas of the union in it and the areas of its sides, if they are known.
    ///
    /// Lines enter solid in the cell on an area e and leave it on an area l. The share of lines that meet solid is at least the larger of the two blocked
    /// sides, and at most that plus the smaller of e and l. Their mean is the frontal area, their difference that of the sides.
    #[inline(always)]
    fn new(open: &OpenLayer<R>, at: [usize; 2], nx: usize, surface: impl FnOnce() -> Option<([R; 3], [R; 3])>) -> Self {
        let nothing = Seen { blocked: [[R::ZERO; 2]; 3], share: [R::ZERO; 3], place: [R::HALF; 3], doubtful: [false; 3] };
        let Some(blocked) = open.blocked(at, nx) else { return nothing };
        if !open.cell.get(at[1] * nx + at[0]).is_some_and(|&share| share > R::ZERO) {
            return Seen { share: [R::ONE; 3], ..nothing };
        }
        let mut seen = Seen { blocked, share: blocked.map(|[low, high]| low.larger(high)), ..nothing };
        let Some((frontal, sides)) = surface() else { return Seen { doubtful: [true; 3], ..seen } };
        if frontal == [R::ZERO; 3] {
            return seen;
        }
        for axis in 0..3 {
            let [low, high] = blocked[axis];
            let hidden = frontal[axis] / sides[axis] - (high - low).abs() * R::HALF;
            if frontal[axis] == R::ZERO {
                continue;
            }
            if R::ONE - seen.share[axis] <= known() {
                seen.share[axis] = R::ONE;
            } else {
                seen.doubtful[axis] = !(hidden.abs() <= fit());
            }
        }
        seen
    }
}

/// A cell, and which triangles reach it.
struct CellOfLayer<'a, V: Vector> {
    bins: &'a Bins<'a, V>,
    k: usize,
    cell: Aabb<V>,
    /// Position of a group in the layer and number of a triangle.
    entries: &'a [[u32; 2]],
}

/// Memory for one cell at a time.
struct Work<'m, R: Real> {
    outlines: Outlines<'m, R>,
    faces: CellFaces<'m, R>,
    /// Surface lies in the plane of a side, along x, y and z.
    walls: [bool; 3],
    scratch: [Polygon<R>; 2],
}

impl<'m, R: Real> Work<'m, R> {
    fn new(outlines: Outlines<'m, R>, faces: CellFaces<'m, R>) -> Self {
        Work { outlines, faces, walls: [false; 3], scratch: [Polygon::default(), Polygon::default()] }
    }
}

impl<V: Vector> CellOfLayer<'_, V> {
    /// Raise the doubtful shares of `found` to the shadows; none if there is no room.
    fn shadow(&self, work: &mut Work<V::Scalar>, found: &mut Seen<V::Scalar>) -> Option<()> {
        self.load(work)?;
        for axis in (0..3).filter(|&axis| found.doubtful[axis]) {
            found.place[axis] = work.faces.place(axis);
        }
        for axis in 0..3 {
            let [low, high] = found.blocked[axis];
            let once = (found.doubtful[axis] && !work.walls[axis]).then(|| work.faces.passed_once(axis));
            let Some([entered, left]) = once.flatten() else { continue };
            // A surface that is not closed proves nothing.
            if ((entered - left) - (high - low)).abs() <= fit() {
                found.raise(axis, low + entered);
                found.doubtful[axis] = false;
            }
        }
        let doubtful = found.doubtful;
        if doubtful == [false; 3] {
            return Some(());
        }
        work.outlines.clear();
        work.outlines.add(&work.faces, doubtful)?;
        if !work.outlines.is_empty() {
            for axis in (0..3).filter(|&axis| doubtful[axis]) {
                found.raise(axis, work.outlines.shadow(axis)?);
            }
        }
        Some(())
    }

    /// Take in what all bodies have of surface inside the cell; none if there is no room.
    fn load(&self, work: &mut Work<V::Scalar>) -> Option<()> {
        let (groups, frame) = (self.bins.groups(self.k), Frame::of(self.cell));
        let sides = [self.cell.min.to_array(), self.cell.max.to_array()];
        let mut last = None;
        work.faces.clear();
        work.walls = [false; 3];
        for &[n, id] in self.entries {
            let Some(group) = groups.get(n as usize) else { continue };
            let Some(triangle) = self.bins.triangles(group).get(id as usize) else { continue };
            if last.replace(n) != Some(n) {
                work.faces.begin_solid(group.is_sheet());
            }
            let triangle = triangle.map(Vector::to_array);
            if frame.inside(&triangle, self.cell, &mut work.scratch, work.faces.next()?) {
                work.faces.push();
                continue;
            }
            for (axis, wall) in work.walls.iter_mut().enumerate() {
                let [a, b, c] = triangle.map(|p| p[axis]);
                *wall |= a == b && b == c && sides.iter().any(|side| side[axis] == a);
            }
        }
        Some(())
    }
}
