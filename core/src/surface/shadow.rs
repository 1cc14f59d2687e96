//! The shadow of solids in a cell: which share of the lines along an axis meets them.
//!
//! A line meets solid if it begins inside a solid or meets a face. So the faces are projected along the axis, and so are the boundaries of the solids'
//! sections with the low side of the cell, which are those edges of faces that lie in it. A sweep over the edges counts both: between two
//! neighbouring ends and crossings nothing changes places, so areas are sums of trapezoids, exact to rounding, whatever the solids have in
//! common; where edges cross too often, the widths along many lines give the rest of the area. Edges between two faces that look the same way
//! cancel before: what is left are outlines. The sweep is that of J. L. Bentley and T. A. Ottmann, *Algorithms for Reporting and Counting Geometric Intersections*, IEEE Transactions on Computers C-28, 1979.
//!
//! No sweep is needed where a line enters solid at most once: the shadow is then the section with the low side and the area of all faces that are
//! entered, as they are seen along the axis (`CellFaces::passed_once`).
//!
//! Everything happens in the frame of the cell, 0..1 along each axis, in memory of the caller.

mod edge;
mod faces;
mod sweep;

use crate::number::real::Real;
use edge::{cancelled, joined, thickness};
use sweep::Sweep;

pub use edge::ShadowEdge;
pub(super) use faces::CellFaces;
pub use faces::ShadowFace;

/// A section of which this share is solid at most, or open at most, has no boundary but rounding.
const NO_SECTION: f64 = 1e-12;

/// Memory for the shadows of one cell at a time; the larger, the more surface a cell may hold. What the slices hold does not matter.
#[derive(Debug, Default)]
pub struct ShadowMemory<'a, R: Real> {
    /// Edges of faces, a third for each axis: 3 to 5 times as many as faces, and as many again in sides of the cell.
    pub edges: &'a mut [ShadowEdge<R>],
    /// Places of a table that finds the inner edges of surfaces: as many. With fewer, shadows take longer, and a cell may hold less.
    pub places: &'a mut [u32],
    /// Which triangles reach which cell of a layer; `Layers::shadow_lists_needed` tells how many are always enough.
    pub lists: &'a mut [u32],
    /// Faces in the cell.
    pub faces: &'a mut [ShadowFace<R>],
}

/// The shadows of the solids in the cells of a layer along x, y and z, `ny*nx` each, x fastest.
#[derive(Debug)]
pub struct ShadowSlices<'a, R> {
    /// Which share of the lines along the axis through the cell meets solid in it, or what the more blocked of its two sides shows, if that is more. Zeros before, or
    /// what an earlier call has written for the same layer.
    pub share: [&'a mut [R]; 3],
    /// Where, in widths of the cell from its middle, −½ to ½: the mean place of the surface inside, each part counted by its area as seen along the
    /// axis. Zero where lines that meet solid do so on a side of the cell. Zeros before, likewise.
    pub place: [&'a mut [R]; 3],
}

impl<R> ShadowSlices<'_, R> {
    /// The same slices, for a shorter time.
    pub fn reborrow(&mut self) -> ShadowSlices<'_, R> {
        let ShadowSlices { share: [x, y, z], place: [u, v, w] } = self;
        ShadowSlices { share: [x, y, z], place: [u, v, w] }
    }
}

/// The outlines of what is in a cell, seen along x, y and z.
pub(super) struct Outlines<'m, R> {
    axes: [Outline<'m, R>; 3],
    places: &'m mut [u32],
}

/// The edges of what is in a cell, seen along an axis.
struct Outline<'m, R> {
    edges: &'m mut [ShadowEdge<R>],
    count: usize,
    /// The area of the present solid's section with the low side, but for a whole number.
    section: R,
    /// In how many solids the line at (0, 0) begins.
    starting: i32,
}

impl<'m, R: Real> Outlines<'m, R> {
    /// Of nothing yet.
    pub fn new(edges: &'m mut [ShadowEdge<R>], places: &'m mut [u32]) -> Self {
        let third = edges.len() / 3;
        let (x, rest) = edges.split_at_mut_checked(third).unwrap_or_default();
        let (y, z) = rest.split_at_mut_checked(third).unwrap_or_default();
        let outline = |edges| Outline { edges, count: 0, section: R::ZERO, starting: 0 };
        Outlines { axes: [outline(x), outline(y), outline(z)], places }
    }

    /// Of nothing again.
    pub fn clear(&mut self) {
        for outline in &mut self.axes {
            (outline.count, outline.section, outline.starting) = (0, R::ZERO, 0);
        }
    }

    /// Is nothing seen?
    pub fn is_empty(&self) -> bool {
        self.axes.iter().all(|outline| outline.count == 0)
    }

    /// Add all faces of a cell, as seen along some axes; none if there is no room.
    #[inline(never)]
    pub fn add(&mut self, faces: &CellFaces<R>, wanted: [bool; 3]) -> Option<()> {
        let mut last = 0;
        for face in faces.all() {
            if face.solid != last {
                self.finish_solid();
                last = face.solid;
            }
            let Outlines { axes: [x, y, z], places } = self;
            if wanted[0] {
                x.add::<0>(face, places)?;
            }
            if wanted[1] {
                y.add::<1>(face, places)?;
            }
            if wanted[2] {
                z.add::<2>(face, places)?;
            }
        }
        self.finish_solid();
        Some(())
    }

    /// All faces of one solid have been added.
    fn finish_solid(&mut self) {
        for outline in &mut self.axes {
            if outline.section < -R::from_f64(NO_SECTION).max(thickness()) {
                outline.starting = outline.starting.saturating_add(1);
            }
            outline.section = R::ZERO;
        }
    }

    /// The share of the lines along `axis` (0, 1, otherwise 2) that meet solid, and whether that is exact.
    #[inline(never)]
    pub fn shadow(&mut self, axis: usize) -> Option<(R, bool)> {
        let outline = self.axes.get_mut(axis.min(2))?;
        let count = cancelled(outline.edges.get_mut(..outline.count)?, self.places);
        let count = joined(outline.edges.get_mut(..count)?);
        let edges = outline.edges.get_mut(..count)?;
        Some(Sweep { edges, count: 0, next: 0, starting: outline.starting }.shadow())
    }
}

impl<R: Real> Outline<'_, R> {
    /// Keep an edge. Where memory is spent, those that cancel give way, unless they are few.
    fn push(&mut self, edge: Option<ShadowEdge<R>>, places: &mut [u32]) -> Option<()> {
        let Some(edge) = edge else { return Some(()) };
        if self.count >= self.edges.len() {
            self.count = cancelled(self.edges, places);
            if self.count > self.edges.len() / 2 {
                return None;
            }
        }
        *self.edges.get_mut(self.count)? = edge;
        self.count += 1;
        Some(())
    }

    /// Add the edges of a face as seen along `AXIS`, which is 0, 1 or 2.
    fn add<const AXIS: usize>(&mut self, face: &ShadowFace<R>, places: &mut [u32]) -> Option<()> {
        let (u, v) = ((AXIS + 1) % 3, (AXIS + 2) % 3);
        let normal = face.doubled[AXIS];
        // A face that is entered is seen from behind: beyond an edge that leads upwards it begins.
        let covering = if normal < R::ZERO { 1 } else { -1 };
        let corners = face.polygon.corners();
        let mut last = corners.last()?;
        for corner in corners {
            let (a, b) = ([last[u], last[v]], [corner[u], corner[v]]);
            let in_side = !face.sheet && last[AXIS] == R::ZERO && corner[AXIS] == R::ZERO;
            last = corner;
            if normal != R::ZERO {
                self.push(ShadowEdge::new(a, b, [covering, 0]), places)?;
            }
            if in_side {
                self.add_to_section(a, b, places)?;
            }
        }
        Some(())
    }

    /// Add an edge of the section with the low side, the solid to its left. Where a boundary comes in from `u = 0` or goes out there, the section goes
    /// on along it.
    fn add_to_section(&mut self, a: [R; 2], b: [R; 2], places: &mut [u32]) -> Option<()> {
        if a[0] == R::ZERO && b[0] == R::ZERO {
            return Some(());
        }
        let own = ShadowEdge::new(a, b, [0, -1]);
        let along_side = |from: [R; 2], count| {
            (from[0] == R::ZERO).then(|| ShadowEdge::new(from, [R::ZERO, R::ONE], [0, count])).flatten()
        };
        for edge in [own, along_side(a, 1), along_side(b, -1)] {
            self.section += edge.as_ref().map_or(R::ZERO, ShadowEdge::starting_area);
            self.push(edge, places)?;
        }
        Some(())
    }
}
