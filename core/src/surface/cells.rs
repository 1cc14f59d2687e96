//! From the closed triangulated surface of a body to solid fractions of cells, x faces and y faces, a layer at a time.
//!
//! Along a line in +x the indicator χ of a solid jumps by −sign(n_x) wherever the line meets the surface (n points out
//! of the solid). Hence, summing over the pieces of surface in a row of cells,
//!
//! ```text
//! solid area of an x face   A = −Σ ∫ n_x dA                              over the pieces left of the face
//! solid volume of a cell    V = A(low face) dx − ∫ n_x (x_hi − x) dA     over the pieces in the cell
//! ```
//!
//! and likewise along y for y faces; z faces are the matter of [`crate::surface::z_faces`]. There are no inside tests; non-convex
//! bodies, cavities and plates far thinner than a cell need nothing special, and every row must return to zero at its
//! end, which tells holes in the surface. After J. Manson and S. Schaefer, *Wavelet Rasterization*, Computer Graphics
//! Forum 30 (2011), who integrate the same way.
//!
//! **Walls.** A point of a face is open only if both one-sided limits are open. So a piece of surface lying in the plane
//! of a face counts before the face where the solid begins and after it where the solid ends: the face is blocked in both
//! cases.

use crate::grid::Grid;
use crate::grid::fields::{Layer, ShapeMismatch, accumulate, accumulate_face, at_least, noise};
use crate::number::real::{Real, Vector};
use crate::number::space::sub;
use crate::surface::clip::{Polygon, split};
use crate::surface::error::{Defects, SurfaceError};
use crate::surface::surface_area::{PieceSums, Place};
use crate::surface::window::{Axis, Window, add_at, mark, part, part_mut, width, widths};

/// Caller's memory for the sums of one body in one layer.
#[derive(Debug)]
pub struct Scratch<'a, R> {
    pub(crate) reals: &'a mut [R],
}

impl<'a, R: Real> Scratch<'a, R> {
    /// Number of scalars that serve any body on a grid.
    #[must_use]
    pub fn needed(grid: &Grid<R>) -> usize {
        let [nx, ny, _] = grid.cells();
        (nx + 2) * ny + nx * ny + nx * (ny + 2)
    }

    /// Use a buffer of at least [`Scratch::needed`] scalars; what it holds does not matter.
    ///
    /// # Errors
    /// [`ShapeMismatch`] if it is too short.
    pub fn new(grid: &Grid<R>, reals: &'a mut [R]) -> Result<Self, ShapeMismatch> {
        at_least(Self::needed(grid), reals.len())?;
        Ok(Scratch { reals })
    }

    /// It serves any body on this grid.
    pub(crate) fn fits(&self, grid: &Grid<R>) -> Result<(), ShapeMismatch> {
        at_least(Self::needed(grid), self.reals.len())
    }
}

/// Buffers of the polygons that are being cut.
#[derive(Default)]
struct Buffers<R: Real> {
    /// What is still to be spread over rows.
    slab: Polygon<R>,
    /// What is still to be spread over the cells of a row.
    row: Polygon<R>,
    /// The share of one cell.
    cell: Polygon<R>,
    spare: Polygon<R>,
}

/// Add one body to layer `k`: its cells, x faces and y faces (z faces: [`crate::surface::z_faces::add_section`]).
///
/// `ids` lists at least those of the body's triangles that reach into the slab `z[k]..z[k+1]`. Corners are in the grid's
/// frame and unit, counter-clockwise seen from outside. Returns what the sums say about the surface.
///
/// # Errors
/// [`SurfaceError`]: no such layer or triangle, a coordinate that is no number, memory of another grid.
pub fn add_body<R: Real, V: Vector<Scalar = R>>(
    grid: &Grid<R>,
    k: usize,
    triangles: &[[V; 3]],
    ids: &[u32],
    scratch: &mut Scratch<R>,
    layer: &mut Layer<R>,
) -> Result<Defects<R>, SurfaceError> {
    add_body_and(grid, k, (triangles, ids), scratch, layer, &mut ())
}

/// As [`add_body`]; `pieces` makes something else of the pieces.
pub(super) fn add_body_and<R: Real, V: Vector<Scalar = R>, P: PieceSums<R>>(
    grid: &Grid<R>,
    k: usize,
    (triangles, ids): (&[[V; 3]], &[u32]),
    scratch: &mut Scratch<R>,
    layer: &mut Layer<R>,
    pieces: &mut P,
) -> Result<Defects<R>, SurfaceError> {
    let none = Defects { leak: R::ZERO, winding: R::ZERO };
    let Some(&[lo, hi]) = grid.edges(2).get(k..).and_then(|edges| edges.first_chunk()) else {
        return Err(SurfaceError::NoLayer { layer: k, layers: grid.cells()[2] });
    };
    layer.fits(grid)?;
    scratch.fits(grid)?;
    let Some(window) = Window::around(grid, triangles, ids)? else { return Ok(none) };
    let mut sums = Sums::new(grid, window, scratch, layer, pieces);
    let mut b = Buffers::default();
    for (id, triangle) in ids.iter().filter_map(|&id| Some((id, triangles.get(id as usize)?))) {
        sums.pieces.begin_triangle(id);
        let mut corners = triangle.map(Vector::to_array);
        sums.x.origin = take_origin(&mut corners, 0);
        sums.y.origin = take_origin(&mut corners, 1);
        if slab_part(&corners, lo, hi, &mut b) {
            sums.scatter(Place::Inside, &mut b);
        } else if P::WANTED {
            sums.scatter_level(&corners, [lo, hi], &mut b);
        }
    }
    let defects = sums.x_faces_and_cells(hi - lo);
    Ok(defects.worst(Defects { leak: sums.y_faces(hi - lo), ..none }))
}

/// If a triangle's extent along `axis` is below this share of its coordinates, it gets an origin of its own.
const FLAT: f64 = 1.0 / 1024.0;

/// The origin that a triangle is best seen from along an axis, subtracted from its corners (exactly, by Sterbenz' lemma).
#[inline(always)]
fn take_origin<R: Real>(corners: &mut [[R; 3]; 3], axis: usize) -> R {
    let [a, b, c] = corners.map(|p| p[axis]);
    let (min, max) = (a.min(b).min(c), a.max(b).max(c));
    if max == min || max - min > R::from_f64(FLAT) * min.abs() {
        return R::ZERO;
    }
    corners.iter_mut().for_each(|p| p[axis] -= min);
    min
}

/// The part of a triangle in the open slab `lo..hi`, as `b.slab`; false if there is none. Level triangles on `lo` or `hi` are outside.
#[inline(always)]
fn slab_part<R: Real>(corners: &[[R; 3]; 3], lo: R, hi: R, b: &mut Buffers<R>) -> bool {
    let [p, q, r] = corners.map(|p| p[2]);
    let (min, max) = (p.min(q).min(r), p.max(q).max(r));
    if !(min < hi && max > lo) {
        return false;
    }
    b.slab.set(corners);
    if min < lo {
        b.row.set(corners);
        split(&b.row, 2, lo, &mut b.spare, &mut b.slab);
    }
    if max > hi {
        b.row.assign(&b.slab);
        split(&b.row, 2, hi, &mut b.slab, &mut b.spare);
    }
    true
}

/// Does a triangle lie in the plane below a layer or above it, and its normal point into the layer?
fn is_seen_level<R: Real>(corners: &[[R; 3]; 3], lo: R, hi: R) -> bool {
    let [a, b, c] = *corners;
    let up = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let plane = if up > R::ZERO { lo } else { hi };
    up != R::ZERO && corners.iter().all(|p| p[2] == plane)
}

/// Running sums of one body over its window of one layer.
struct Sums<'s, 'g, 'l, R, P> {
    window: Window,
    grid: &'s Grid<'g, R>,
    x: Axis<'g, R>,
    y: Axis<'g, R>,
    /// ∫ n_x dA by row and slot: slot 0 is left of the grid, slot c + 1 is cell c, slot ni + 1 is right of the grid.
    flux_x: &'s mut [R],
    /// 6 ∫ n_x (x_hi − x) dA by row and cell.
    moment: &'s mut [R],
    /// ∫ n_y dA by slot along y and by column.
    flux_y: &'s mut [R],
    layer: &'s mut Layer<'l, R>,
    pieces: &'s mut P,
}

impl<'s, 'g, 'l, R: Real, P: PieceSums<R>> Sums<'s, 'g, 'l, R, P> {
    fn new(
        grid: &'s Grid<'g, R>,
        window: Window,
        scratch: &'s mut Scratch<R>,
        layer: &'s mut Layer<'l, R>,
        pieces: &'s mut P,
    ) -> Self {
        let Window { i0, ni, j0, nj } = window;
        let (flux_x, rest) = scratch.reals.split_at_mut_checked((ni + 2) * nj).unwrap_or_default();
        let (moment, rest) = rest.split_at_mut_checked(ni * nj).unwrap_or_default();
        let (flux_y, _) = rest.split_at_mut_checked(ni * (nj + 2)).unwrap_or_default();
        for sums in [&mut *flux_x, &mut *moment, &mut *flux_y] {
            sums.fill(R::ZERO);
        }
        let (x, y) = (Axis::new(grid.edges(0), i0, ni), Axis::new(grid.edges(1), j0, nj));
        Sums { window, grid, x, y, flux_x, moment, flux_y, layer, pieces }
    }

    /// Spread what a level triangle has in the planes below and above the layer, which only `pieces` sees.
    fn scatter_level(&mut self, corners: &[[R; 3]; 3], [lo, hi]: [R; 2], b: &mut Buffers<R>) {
        let is_seen = is_seen_level(corners, lo, hi);
        for (place, told) in [(Place::InPlane, is_seen), (Place::Top, corners.iter().all(|p| p[2] == hi))] {
            if told {
                b.slab.set(corners);
                self.scatter(place, b);
            }
        }
    }

    /// Spread `b.slab` over rows. In a plane of the grid only `pieces` sees it.
    #[inline]
    fn scatter(&mut self, place: Place, b: &mut Buffers<R>) {
        let Buffers { slab, row: part, cell, spare } = b;
        let (mut rest, mut above) = (slab, spare);
        let (min, max) = rest.extent(1);
        let mut row = self.y.cell(min);
        if min == max && self.y.opens(row, min) {
            let begins = rest.doubled_area()[1] < R::ZERO;
            return self.scatter_row(if begins { row - 1 } else { row }, (Some(row), place), [rest, cell, above]);
        }
        while row < self.y.count && max > self.y.upper(row) {
            split(rest, 1, self.y.upper(row), part, above);
            core::mem::swap(&mut rest, &mut above);
            self.scatter_row(row, (None, place), [part, cell, above]);
            row += 1;
        }
        self.scatter_row(row, (None, place), [rest, cell, above]);
    }

    /// Spread a part of a row over its cells. `wall` is the y face in whose plane it lies, if it does.
    #[inline]
    fn scatter_row(
        &mut self,
        row: isize,
        (wall, place): (Option<isize>, Place),
        [mut rest, cell, mut beyond]: [&mut Polygon<R>; 3],
    ) {
        if rest.is_empty() {
            return;
        }
        let (min, max) = rest.extent(0);
        let mut c = self.x.cell(min);
        if min == max && self.x.opens(c, min) {
            if !P::WANTED || place == Place::Inside {
                self.wall_x(row, c, rest);
            }
            return;
        }
        while c < self.x.count && max > self.x.upper(c) {
            split(rest, 0, self.x.upper(c), cell, beyond);
            core::mem::swap(&mut rest, &mut beyond);
            self.add(row, c, (wall, place), cell);
            c += 1;
        }
        self.add(row, c, (wall, place), rest);
    }

    /// Add a piece in the plane of the x face below cell `c`.
    fn wall_x(&mut self, row: isize, c: isize, piece: &Polygon<R>) {
        let Window { i0, j0, .. } = self.window;
        if self.y.holds(row) {
            let nx = self.grid.cells()[0];
            mark(self.layer.has_surface.x, (j0 + row as usize) * (nx + 1) + i0 + c as usize);
        }
        let begins = piece.doubled_area()[0] < R::ZERO;
        self.integrate(row, if begins { c - 1 } else { c }, Place::InPlane, piece);
    }

    /// Add a piece that lies in one cell, or in the y face `wall`.
    #[inline(always)]
    fn add(&mut self, row: isize, c: isize, (wall, place): (Option<isize>, Place), piece: &Polygon<R>) {
        if piece.is_empty() {
            return;
        }
        if P::WANTED && place != Place::Inside {
            return self.note(row, c, place, piece, piece.doubled_area());
        }
        let Window { i0, j0, .. } = self.window;
        if self.x.holds(c) {
            let nx = self.grid.cells()[0];
            let at = |j: isize| (j0 as isize + j) as usize * nx + i0 + c as usize;
            match wall {
                Some(face) => mark(self.layer.has_surface.y, at(face)),
                None if self.y.holds(row) => mark(self.layer.has_surface.cell, at(row)),
                None => {}
            }
        }
        self.integrate(row, c, if wall.is_some() { Place::InPlane } else { Place::Inside }, piece);
    }

    /// Tell `pieces` of a piece, with twice its area vector. It may lie beyond the window, but not beyond the grid.
    #[inline(always)]
    fn note(&mut self, row: isize, c: isize, place: Place, piece: &Polygon<R>, doubled_area: [R; 3]) {
        let [nx, ny, _] = self.grid.cells();
        let Window { i0, j0, .. } = self.window;
        let (i, j) = (i0.wrapping_add_signed(c), j0.wrapping_add_signed(row));
        if i < nx && j < ny {
            let at = j * nx + i;
            if place == Place::Inside && (self.x.origin != R::ZERO || self.y.origin != R::ZERO) {
                self.pieces.add(at, place, doubled_area, &self.in_grid(row, c, piece));
            } else {
                self.pieces.add(at, place, doubled_area, piece);
            }
        }
    }

    /// A piece inside a cell, in the coordinates of the grid: what lies in the plane of a side lies exactly there, and nothing beyond.
    fn in_grid(&self, row: isize, c: isize, piece: &Polygon<R>) -> Polygon<R> {
        let (along_x, along_y) = (self.x.sides(c), self.y.sides(row));
        let mut moved = Polygon::default();
        for &[x, y, z] in piece.corners() {
            moved.push([self.x.in_grid(along_x, x), self.y.in_grid(along_y, y), z]);
        }
        moved
    }

    /// Add the integrals over a piece, fanned from its first corner so that only differences enter.
    #[inline(always)]
    fn integrate(&mut self, row: isize, c: isize, place: Place, piece: &Polygon<R>) {
        let [o, first, others @ ..] = piece.corners() else { return };
        let (ni, inside) = (self.window.ni, self.x.holds(c));
        let reach = if inside { (self.x.upper(c) - o[0]) * R::from_f64(3.0) } else { R::ZERO };
        let (mut nx, mut ny, mut nz, mut moment) = (R::ZERO, R::ZERO, R::ZERO, R::ZERO);
        let mut a = sub(*first, *o);
        for p in others {
            let b = sub(*p, *o);
            let ax = a[1] * b[2] - a[2] * b[1];
            nx += ax;
            ny += a[2] * b[0] - a[0] * b[2];
            if P::WANTED {
                nz += a[0] * b[1] - a[1] * b[0];
            }
            moment += ax * (reach - (a[0] + b[0]));
            a = b;
        }
        if P::WANTED {
            self.note(row, c, place, piece, [nx, ny, nz]);
        }
        if self.y.holds(row) {
            add_at(self.flux_x, row as usize * (ni + 2) + (c + 1) as usize, nx * R::HALF);
            if inside {
                add_at(self.moment, row as usize * ni + c as usize, moment);
            }
        }
        if inside {
            add_at(self.flux_y, (row + 1) as usize * ni + c as usize, ny * R::HALF);
        }
    }

    /// Fractions of x faces and cells from the sums along x. `dz` is the layer's height.
    fn x_faces_and_cells(&mut self, dz: R) -> Defects<R> {
        (0..self.window.nj).filter_map(|row| self.x_row(row, dz)).fold(Defects::default(), Defects::worst)
    }

    /// Those of one row. None is for a row that the layer does not hold.
    #[inline(always)]
    fn x_row(&mut self, row: usize, dz: R) -> Option<Defects<R>> {
        let Window { i0, ni, j0, .. } = self.window;
        let nx = self.grid.cells()[0];
        let j = j0 + row;
        let sixth = R::ONE / R::from_f64(6.0);
        let x = widths(self.grid.edges(0), i0, ni)?;
        let (&left, flux) = part(self.flux_x, row * (ni + 2), ni + 2)?.split_first()?;
        let (&right, flux) = flux.split_last()?;
        let moment = part(self.moment, row * ni, ni)?;
        let to_fraction = R::ONE / (width(self.grid.edges(1), j)? * dz);
        let (faces, cells) = (j * (nx + 1) + i0, j * nx + i0);
        let Layer { lower, sum, has_surface } = &mut *self.layer;
        let (walls, cut) = (part(has_surface.x, faces, ni + 1)?, part(has_surface.cell, cells, ni)?);
        let (last_wall, walls) = walls.split_last()?;
        let (last_lower, face_lower) = part_mut(lower.x, faces, ni + 1)?.split_last_mut()?;
        let (last_sum, face_sum) = part_mut(sum.x, faces, ni + 1)?.split_last_mut()?;
        let (cell_lower, cell_sum) = (part_mut(lower.cell, cells, ni)?, part_mut(sum.cell, cells, ni)?);
        let mut winding = R::ZERO;
        let (mut area, mut uncut_before) = (-left, false);
        for c in 0..ni {
            let face = area * to_fraction;
            let whole = walls[c] == 0 && (cut[c] == 0 || uncut_before);
            uncut_before = cut[c] == 0;
            accumulate_face(face, whole, &mut face_lower[c], &mut face_sum[c]);
            area -= flux[c];
            let share = face - moment[c] * (sixth * to_fraction) / x.of(c);
            let surface = flux[c] != R::ZERO || moment[c] != R::ZERO;
            if cut[c] == 0 {
                // Nothing but walls: after them the cell is open or closed as a whole.
                if share > R::HALF {
                    accumulate(R::ONE, &mut cell_lower[c], &mut cell_sum[c]);
                }
            } else if surface || share > noise::<R>() {
                winding = winding.max(share - R::ONE).max(-share);
                accumulate(share, &mut cell_lower[c], &mut cell_sum[c]);
            }
        }
        accumulate_face(area * to_fraction, *last_wall == 0 && uncut_before, last_lower, last_sum);
        Some(Defects { leak: ((area - right) * to_fraction).abs(), winding })
    }

    /// Fractions of y faces from the sums along y; returns what is left above the last.
    fn y_faces(&mut self, dz: R) -> R {
        (0..=self.window.nj).filter_map(|row| self.y_row(row, dz)).fold(R::ZERO, R::max)
    }

    /// Those below one row, or above the last. None if nothing reaches them.
    #[inline(always)]
    fn y_row(&mut self, row: usize, dz: R) -> Option<R> {
        let Window { i0, ni, j0, nj } = self.window;
        let nx = self.grid.cells()[0];
        let x = widths(self.grid.edges(0), i0, ni)?;
        let (flux, above) = part_mut(self.flux_y, row * ni, 2 * ni)?.split_at_mut_checked(ni)?;
        let above = above.get_mut(..ni)?;
        if flux.iter().all(|&f| f == R::ZERO) {
            return None;
        }
        let faces = (j0 + row) * nx + i0;
        let Layer { lower, sum, has_surface } = &mut *self.layer;
        let walls = part(has_surface.y, faces, ni)?;
        let (lower, sum) = (part_mut(lower.y, faces, ni)?, part_mut(sum.y, faces, ni)?);
        let cut = |row: usize| part(has_surface.cell, (j0 + row) * nx + i0, ni);
        // Beside a row that is not there nothing is whole.
        let below = if row > 0 { Some(cut(row - 1)?) } else { None };
        let beyond = if row < nj { Some(cut(row)?) } else { None };
        let mut leak = R::ZERO;
        for c in 0..ni {
            let to_fraction = R::ONE / (x.of(c) * dz);
            let uncut = |cut: Option<&[u8]>| cut.is_some_and(|cut| cut.get(c) == Some(&0));
            let whole = walls[c] == 0 && (uncut(beyond) || uncut(below));
            accumulate_face(-flux[c] * to_fraction, whole, &mut lower[c], &mut sum[c]);
            above[c] += flux[c];
            if row == nj {
                leak = leak.max((above[c] * to_fraction).abs());
            }
        }
        Some(leak)
    }
}
