//! Solid fractions of z faces: the section of a surface with a horizontal plane.
//!
//! The section is a set of segments. Along a line in +x within the plane χ jumps by −sign(n_x) at each, and a segment with
//! the solid's surface rising from it has Δy of the sign of n_x if it runs the way of its triangle's boundary. So
//!
//! ```text
//! solid area of a z face    A = −dx Σ Δy − ∫ (x_hi − x) dy     Σ over the row's segments left of the cell, ∫ over the cell's
//! ```
//!
//! which is [`crate::surface::cells`] with one dimension less. The section is taken on one side of the plane; level triangles
//! in the plane itself are the walls that the other side adds.

use crate::grid::Grid;
use crate::grid::fields::{Layer, accumulate_face};
use crate::number::real::{Real, Vector};
use crate::surface::cells::Scratch;
use crate::surface::clip::{Polygon, crossing, split};
use crate::surface::error::SurfaceError;
use crate::surface::window::{Axis, Window, add_at, mark, part, part_mut, width, widths};

/// The side of a plane on which its section is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Just below: for the topmost plane of a grid.
    Below,
    /// Just above: for all other planes.
    Above,
}

/// Add one body to the z faces of a layer: those in plane `z[plane]` of the grid, seen from `side`. From above, the body's
/// cells must have been added before ([`crate::surface::cells::add_body`]): where they hold no surface, the face is whole.
///
/// `ids` lists at least those of the body's triangles that touch the plane, level ones in it included. Returns the
/// largest amount by which a row failed to return to zero, as a fraction of a face.
///
/// # Errors
/// [`SurfaceError`]: no such plane or triangle, a coordinate that is no number, memory of another grid.
pub fn add_section<R: Real, V: Vector<Scalar = R>>(
    grid: &Grid<R>,
    plane: usize,
    side: Side,
    triangles: &[[V; 3]],
    ids: &[u32],
    scratch: &mut Scratch<R>,
    layer: &mut Layer<R>,
) -> Result<R, SurfaceError> {
    let edges = grid.edges(2);
    let z = *edges.get(plane).ok_or(SurfaceError::NoLayer { layer: plane, layers: edges.len() })?;
    layer.fits(grid)?;
    scratch.fits(grid)?;
    let Some(window) = Window::around(grid, triangles, ids)? else { return Ok(R::ZERO) };
    let mut sums = Sums::new(grid, window, scratch);
    for triangle in ids.iter().filter_map(|&id| triangles.get(id as usize)) {
        let corners = triangle.map(Vector::to_array);
        if corners.iter().all(|c| c[2] == z) {
            sums.wall(side, &corners, layer.has_surface.z);
        } else if let Some([from, to]) = segment(&corners, z, side) {
            sums.scatter(from, to);
        }
    }
    Ok(sums.faces(side, layer))
}

/// Where the boundary of a triangle leaves `side` of the plane and where it comes back; none if it does neither.
#[inline(always)]
fn segment<R: Real>(corners: &[[R; 3]; 3], z: R, side: Side) -> Option<[[R; 3]; 2]> {
    let above = corners.map(|c| if side == Side::Above { c[2] > z } else { c[2] >= z });
    if above[0] == above[1] && above[1] == above[2] {
        return None;
    }
    let mut ends = [[R::ZERO; 3]; 2];
    for (a, b) in [(0, 1), (1, 2), (2, 0)] {
        if above[a] != above[b] {
            let (p, q) = (corners[a], corners[b]);
            let point = if p[2] == z {
                p
            } else if q[2] == z {
                q
            } else {
                crossing(p, q, 2, z)
            };
            ends[usize::from(above[b])] = point;
        }
    }
    Some(ends)
}

/// Running sums of one section over its window.
struct Sums<'s, 'g, R> {
    window: Window,
    grid: &'s Grid<'g, R>,
    x: Axis<'g, R>,
    y: Axis<'g, R>,
    /// Σ Δy by row and slot, as in [`crate::surface::cells`].
    flux: &'s mut [R],
    /// 2 ∫ (x_hi − x) dy by row and cell.
    moment: &'s mut [R],
    /// Area of walls by row and cell.
    walls: &'s mut [R],
}

impl<'s, 'g, R: Real> Sums<'s, 'g, R> {
    fn new(grid: &'s Grid<'g, R>, window: Window, scratch: &'s mut Scratch<R>) -> Self {
        let Window { i0, ni, j0, nj } = window;
        let (flux, rest) = scratch.reals.split_at_mut_checked((ni + 2) * nj).unwrap_or_default();
        let (moment, rest) = rest.split_at_mut_checked(ni * nj).unwrap_or_default();
        let (walls, _) = rest.split_at_mut_checked(ni * nj).unwrap_or_default();
        for sums in [&mut *flux, &mut *moment, &mut *walls] {
            sums.fill(R::ZERO);
        }
        let (x, y) = (Axis::new(grid.edges(0), i0, ni), Axis::new(grid.edges(1), j0, nj));
        Sums { window, grid, x, y, flux, moment, walls }
    }

    /// Spread a segment over rows, from its lower end.
    fn scatter(&mut self, from: [R; 3], to: [R; 3]) {
        if from[1] == to[1] {
            return;
        }
        let up = from[1] < to[1];
        let (mut lo, hi) = if up { (from, to) } else { (to, from) };
        let mut row = self.y.cell(lo[1]);
        while row < self.y.count && hi[1] > self.y.upper(row) {
            let p = crossing(lo, hi, 1, self.y.upper(row));
            self.scatter_row(row, up, lo, p);
            lo = p;
            row += 1;
        }
        self.scatter_row(row, up, lo, hi);
    }

    /// Spread a segment that rises within one row over the row's cells; `up` tells whether it runs that way.
    fn scatter_row(&mut self, row: isize, up: bool, lo: [R; 3], hi: [R; 3]) {
        if !self.y.holds(row) {
            return;
        }
        let (mut left, right) = if lo[0] <= hi[0] { (lo, hi) } else { (hi, lo) };
        let positive = up == (lo[0] <= hi[0]);
        let mut c = self.x.cell(left[0]);
        while c < self.x.count && right[0] > self.x.upper(c) {
            let p = crossing(left, right, 0, self.x.upper(c));
            self.add(row, c, positive, left, p);
            left = p;
            c += 1;
        }
        self.add(row, c, positive, left, right);
    }

    #[inline(always)]
    fn add(&mut self, row: isize, c: isize, positive: bool, left: [R; 3], right: [R; 3]) {
        let dy = if positive { right[1] - left[1] } else { left[1] - right[1] };
        let (row, ni) = (row as usize, self.window.ni);
        add_at(self.flux, row * (ni + 2) + (c + 1) as usize, dy);
        if self.x.holds(c) {
            let hi = self.x.upper(c);
            add_at(self.moment, row * ni + c as usize, dy * ((hi - left[0]) + (hi - right[0])));
        }
    }

    /// Add a level triangle in the plane, where it is the wall that `side` does not see.
    fn wall(&mut self, side: Side, corners: &[[R; 3]; 3], has_surface: &mut [u8]) {
        let mut rest = Polygon::new(corners);
        let faces_up = rest.doubled_area()[2] > R::ZERO;
        let weight = if faces_up == (side == Side::Above) { R::HALF } else { R::ZERO };
        let (mut strip, mut cell, mut spare) = (Polygon::default(), Polygon::default(), Polygon::default());
        let (min, max) = rest.extent(1);
        for row in self.y.cell(min)..=self.y.cell(max).min(self.y.count - 1) {
            split(&rest, 1, self.y.upper(row), &mut strip, &mut spare);
            core::mem::swap(&mut rest, &mut spare);
            if strip.is_empty() || row < 0 {
                continue;
            }
            let (min, max) = strip.extent(0);
            for c in self.x.cell(min)..=self.x.cell(max).min(self.x.count - 1) {
                split(&strip, 0, self.x.upper(c), &mut cell, &mut spare);
                core::mem::swap(&mut strip, &mut spare);
                if c >= 0 && !cell.is_empty() {
                    self.add_wall(row as usize, c as usize, cell.doubled_area()[2].abs() * weight, has_surface);
                }
            }
        }
    }

    fn add_wall(&mut self, row: usize, c: usize, area: R, has_surface: &mut [u8]) {
        let Window { i0, ni, j0, .. } = self.window;
        add_at(self.walls, row * ni + c, area);
        mark(has_surface, (j0 + row) * self.grid.cells()[0] + i0 + c);
    }

    /// Fractions of the faces from the sums along x.
    fn faces(&self, side: Side, layer: &mut Layer<R>) -> R {
        (0..self.window.nj).filter_map(|row| self.row(row, side, layer)).fold(R::ZERO, R::max)
    }

    /// Those of one row. None is for a row that the layer does not hold.
    #[inline(always)]
    fn row(&self, row: usize, side: Side, layer: &mut Layer<R>) -> Option<R> {
        let Window { i0, ni, j0, .. } = self.window;
        let j = j0 + row;
        let faces = j * self.grid.cells()[0] + i0;
        let (x, height) = (widths(self.grid.edges(0), i0, ni)?, width(self.grid.edges(1), j)?);
        let (&left, flux) = part(self.flux, row * (ni + 2), ni + 2)?.split_first()?;
        let (&right, flux) = flux.split_last()?;
        let (moment, walls) = (part(self.moment, row * ni, ni)?, part(self.walls, row * ni, ni)?);
        let (lower, sum) = (part_mut(layer.lower.z, faces, ni)?, part_mut(layer.sum.z, faces, ni)?);
        let (walls_seen, cut) = (part(layer.has_surface.z, faces, ni)?, part(layer.has_surface.cell, faces, ni)?);
        let mut length = -left;
        for c in 0..ni {
            let width = x.of(c);
            let share = (length * width - moment[c] * R::HALF + walls[c]) / (width * height);
            // The layer's cells are those above the plane.
            let whole = side == Side::Above && walls_seen[c] == 0 && cut[c] == 0;
            accumulate_face(share, whole, &mut lower[c], &mut sum[c]);
            length -= flux[c];
        }
        Some(((length - right) / height).abs())
    }
}
