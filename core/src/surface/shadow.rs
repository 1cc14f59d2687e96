//! The shadow of solids in a cell: which share of the lines along an axis meets them.
//!
//! A line meets solid if it begins inside a solid or meets a face. So the faces are projected along the axis, and so are the boundaries of the solids'
//! sections with the low side of the cell, which are those edges of faces that lie in it. A sweep over the edges counts both: between two
//! neighbouring ends and crossings nothing changes places, so areas are sums of trapezoids, exact to rounding, whatever the solids have in
//! common. Edges between two faces that look the same way cancel before: what is left are outlines. The sweep is that of J. L. Bentley and
//! T. A. Ottmann, *Algorithms for Reporting and Counting Geometric Intersections*, IEEE Transactions on Computers C-28, 1979.
//!
//! No sweep is needed where a line enters solid at most once: the shadow is then the section with the low side and the area of all faces that are
//! entered, as they are seen along the axis (`CellFaces::passed_once`).
//!
//! Everything happens in the frame of the cell, 0..1 along each axis, in memory of the caller.

use crate::number::real::Real;
use crate::number::space::{cross, dot, sub};
use crate::surface::clip::Polygon;

/// Places closer than this, in ε, are one place.
const THICKNESS_IN_EPSILONS: f64 = 64.0;

/// A section of which this share is solid at most, or open at most, has no boundary but rounding.
const NO_SECTION: f64 = 1e-12;

/// A sweep that takes more steps than this, each once an edge that it passes, is given up.
const MOST_STEPS: usize = 1 << 24;

/// An edge seen along the axis of a sweep. The default serves as memory.
#[derive(Clone, Copy, Debug, Default)]
pub struct ShadowEdge<R> {
    /// The end met first by the sweep: place along the sweeping line, and of the line.
    low: [R; 2],
    high: [R; 2],
    /// How many more faces cover the places beyond the edge.
    covering: i32,
    /// In how many more solids lines begin there.
    starting: i32,
    /// Its places along the line at the beginning and at the end of a step.
    step: [R; 2],
}

impl<R: Real> ShadowEdge<R> {
    /// From `a` to `b`, with counts that hold if it leads upwards; none along the sweeping line.
    fn new(a: [R; 2], b: [R; 2], [covering, starting]: [i32; 2]) -> Option<Self> {
        let step = [R::ZERO; 2];
        if a[1] < b[1] {
            Some(ShadowEdge { low: a, high: b, covering, starting, step })
        } else {
            (a[1] > b[1]).then_some(ShadowEdge { low: b, high: a, covering: -covering, starting: -starting, step })
        }
    }

    /// Place along the line that has come to `v`.
    fn at(&self, v: R) -> R {
        if v >= self.high[1] {
            return self.high[0];
        }
        let along = ((v - self.low[1]) / (self.high[1] - self.low[1])).max(R::ZERO);
        self.low[0] + (self.high[0] - self.low[0]) * along
    }

    /// What lies beyond it, counted once for each solid in which lines begin there.
    fn starting_area(&self) -> R {
        let beyond = R::ONE - (self.low[0] + self.high[0]) * R::HALF;
        let area = beyond * (self.high[1] - self.low[1]);
        if self.starting < 0 { -area } else { area }
    }

    /// Is it to be sorted after another?
    #[inline(always)]
    fn follows(&self, other: &Self) -> bool {
        if self.low[1] != other.low[1] {
            return self.low[1] > other.low[1];
        }
        if self.low[0] != other.low[0] {
            return self.low[0] > other.low[0];
        }
        if self.high[1] != other.high[1] {
            return self.high[1] > other.high[1];
        }
        self.high[0] > other.high[0]
    }
}

/// Memory for the shadows of one cell at a time; the larger, the more surface a cell may hold. What the slices hold does not matter.
#[derive(Debug, Default)]
pub struct ShadowMemory<'a, R: Real> {
    /// Edges of faces, a third for each axis: 3 to 5 times as many as faces, and as many again in sides of the cell.
    pub edges: &'a mut [ShadowEdge<R>],
    /// Places of a table that finds the inner edges of surfaces: half as many. With fewer, shadows take longer.
    pub places: &'a mut [u32],
    /// Which triangles reach which cell of a layer; `Layers::shadow_lists_needed` tells how many are always enough.
    pub lists: &'a mut [u32],
    /// Faces in the cell.
    pub faces: &'a mut [ShadowFace<R>],
}

/// The shadows of the solids in the cells of a layer along x, y and z, `ny*nx` each, x fastest.
#[derive(Debug)]
pub struct ShadowSlices<'a, R> {
    /// Which share of the lines along the axis through the cell meets solid, in the cell or on a blocked side of it.
    pub share: [&'a mut [R]; 3],
    /// Where, from 0 at the low side of the cell to 1: the mean place of the surface inside, each part counted by its area as seen along the axis. One
    /// half where lines that meet solid do so on a side of the cell.
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
            let [x, y, z] = &mut self.axes;
            if wanted[0] {
                x.add::<0>(face)?;
            }
            if wanted[1] {
                y.add::<1>(face)?;
            }
            if wanted[2] {
                z.add::<2>(face)?;
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

    /// The share of the lines along `axis` (0, 1, otherwise 2) that meet solid; none if patience is spent.
    #[inline(never)]
    pub fn shadow(&mut self, axis: usize) -> Option<R> {
        let outline = self.axes.get_mut(axis.min(2))?;
        let count = cancelled(outline.edges.get_mut(..outline.count)?, self.places);
        let count = joined(outline.edges.get_mut(..count)?);
        let edges = outline.edges.get_mut(..count)?;
        Sweep { edges, count: 0, next: 0, starting: outline.starting }.shadow()
    }
}

impl<R: Real> Outline<'_, R> {
    fn push(&mut self, edge: Option<ShadowEdge<R>>) -> Option<()> {
        if let Some(edge) = edge {
            *self.edges.get_mut(self.count)? = edge;
            self.count += 1;
        }
        Some(())
    }

    /// Add the edges of a face as seen along `AXIS`, which is 0, 1 or 2.
    fn add<const AXIS: usize>(&mut self, face: &ShadowFace<R>) -> Option<()> {
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
                self.push(ShadowEdge::new(a, b, [covering, 0]))?;
            }
            if in_side {
                self.add_to_section(a, b)?;
            }
        }
        Some(())
    }

    /// Add an edge of the section with the low side, the solid to its left. Where a boundary comes in from `u = 0` or goes out there, the section goes
    /// on along it.
    fn add_to_section(&mut self, a: [R; 2], b: [R; 2]) -> Option<()> {
        if a[0] == R::ZERO && b[0] == R::ZERO {
            return Some(());
        }
        let own = ShadowEdge::new(a, b, [0, -1]);
        let along_side = |from: [R; 2], count| {
            (from[0] == R::ZERO).then(|| ShadowEdge::new(from, [R::ZERO, R::ONE], [0, count])).flatten()
        };
        for edge in [own, along_side(a, 1), along_side(b, -1)] {
            self.section += edge.as_ref().map_or(R::ZERO, ShadowEdge::starting_area);
            self.push(edge)?;
        }
        Some(())
    }
}

/// A face of a solid in a cell. The default serves as memory.
#[derive(Clone, Debug, Default)]
pub struct ShadowFace<R: Real> {
    polygon: Polygon<R>,
    /// Twice its area vector.
    doubled: [R; 3],
    /// From where to where it extends along x, y and z.
    around: [(R, R); 3],
    solid: usize,
    sheet: bool,
}

/// The faces in a cell, those of one solid after those of another, in the frame of the cell.
pub(super) struct CellFaces<'m, R: Real> {
    faces: &'m mut [ShadowFace<R>],
    count: usize,
    /// The number of the solid whose faces are added, from 1.
    solid: usize,
    sheet: bool,
    /// A sheet is among them.
    has_sheet: bool,
}

/// Faces whose planes make an angle with a smaller sine may be the sides of a slit.
const LEAST_SINE: f64 = 0.05;

/// Of more pairs of faces, one entered and one left, a sweep costs less.
const MOST_PAIRS: usize = 1 << 15;

/// Rounding gives shorter edges, as shares of the cell, any direction.
const LEAST_EDGE: f64 = 0.01;

impl<'m, R: Real> CellFaces<'m, R> {
    /// Of nothing yet.
    pub fn new(faces: &'m mut [ShadowFace<R>]) -> Self {
        CellFaces { faces, count: 0, solid: 0, sheet: false, has_sheet: false }
    }

    /// Of nothing again.
    pub fn clear(&mut self) {
        (self.count, self.solid, self.has_sheet) = (0, 0, false);
    }

    /// The faces that follow are of another solid, or of a sheet.
    pub fn begin_solid(&mut self, sheet: bool) {
        (self.solid, self.sheet) = (self.solid + 1, sheet);
    }

    /// Where to write the next face; none if there is no room.
    pub fn next(&mut self) -> Option<&mut Polygon<R>> {
        self.faces.get_mut(self.count).map(|face| &mut face.polygon)
    }

    /// Add the face that has been written, by twice its area vector.
    pub fn push(&mut self, doubled: [R; 3]) {
        if let Some(face) = self.faces.get_mut(self.count) {
            (face.doubled, face.solid, face.sheet) = (doubled, self.solid, self.sheet);
            face.around = [0, 1, 2].map(|axis| face.polygon.extent(axis));
            self.has_sheet |= self.sheet;
            self.count += 1;
        }
    }

    fn all(&self) -> &[ShadowFace<R>] {
        self.faces.get(..self.count).unwrap_or_default()
    }

    /// The mean place of all faces along an axis (0, 1, otherwise 2), each part counted by its area as seen along it; one half if nothing is seen.
    pub fn place(&self, axis: usize) -> R {
        let (axis, mut seen, mut moment) = (axis.min(2), R::ZERO, R::ZERO);
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for face in self.all() {
            let [first, second, others @ ..] = face.polygon.corners() else { continue };
            let mut last = second;
            for corner in others {
                let (a, b) = ([last[u] - first[u], last[v] - first[v]], [corner[u] - first[u], corner[v] - first[v]]);
                let area = (a[0] * b[1] - a[1] * b[0]).abs();
                seen += area;
                moment += area * (first[axis] + last[axis] + corner[axis]);
                last = corner;
            }
        }
        if seen > R::ZERO { moment / (R::from_f64(3.0) * seen) } else { R::HALF }
    }

    /// Are all faces those of one solid?
    pub fn is_one_solid(&self) -> bool {
        self.all().first().map(|face| face.solid) == self.all().last().map(|face| face.solid)
    }

    /// The area on which lines along an axis (0, 1, otherwise 2) enter solid, and that on which they leave it, if no line enters after it has left:
    /// as seen along the axis, no face that is entered lies beyond one that is left.
    #[inline(never)]
    pub fn passed_once(&self, axis: usize) -> Option<[R; 2]> {
        let (axis, faces) = (axis.min(2), self.all());
        if self.has_sheet {
            return None;
        }
        let (mut areas, mut entered_to, mut left_from) = ([R::ZERO; 2], -R::INFINITY, R::INFINITY);
        for face in faces {
            let (area, (low, high)) = (face.doubled[axis], face.around[axis]);
            if area < R::ZERO {
                areas[0] -= area * R::HALF;
                entered_to = entered_to.larger(high);
            } else if area > R::ZERO {
                areas[1] += area * R::HALF;
                left_from = left_from.smaller(low);
            }
        }
        let seen = |sign: R| faces.iter().filter(move |face| face.doubled[axis] * sign > thickness());
        let never_again = |left: &ShadowFace<R>| {
            // No line comes from it to what ends before it begins.
            left.around[axis].0 >= entered_to || seen(-R::ONE).all(|entered| left.hides_from(entered, axis))
        };
        let few = || seen(-R::ONE).count().saturating_mul(seen(R::ONE).count()) <= MOST_PAIRS;
        (entered_to <= left_from || (few() && seen(R::ONE).all(never_again))).then_some(areas)
    }
}

impl<R: Real> ShadowFace<R> {
    /// Does no line along an axis that leaves solid by this face come to another?
    fn hides_from(&self, other: &Self, axis: usize) -> bool {
        let axis = axis.min(2);
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let beside = |a: usize| {
            let (own, (low, high)) = (self.around[a], other.around[a]);
            high <= own.0 || low >= own.1
        };
        // Where a line comes from one to the other, each lies above the plane of the other somewhere.
        other.around[axis].1 <= self.around[axis].0
            || beside(u)
            || beside(v)
            || self.is_beyond(other)
            || other.is_beyond(self)
            || self.is_beside(other, axis)
            || other.is_beside(self, axis)
    }

    /// Does one of its edges, as seen along an axis, have another face on its outer side?
    fn is_beside(&self, other: &Self, axis: usize) -> bool {
        let axis = axis.min(2);
        let (u, v, corners) = ((axis + 1) % 3, (axis + 2) % 3, self.polygon.corners());
        let Some(mut last) = corners.last() else { return true };
        for corner in corners {
            let along = [corner[u] - last[u], corner[v] - last[v]];
            // Seen from behind, edges lead the other way around.
            let along = if self.doubled[axis] < R::ZERO { [-along[0], -along[1]] } else { along };
            let is_outside = |c: &[R; 3]| along[0] * (c[v] - last[v]) <= along[1] * (c[u] - last[u]);
            let has_direction = along[0] * along[0] + along[1] * along[1] > R::from_f64(LEAST_EDGE * LEAST_EDGE);
            if has_direction && other.polygon.corners().iter().all(is_outside) {
                return true;
            }
            last = corner;
        }
        false
    }

    /// Does another face lie behind the plane of this one? They may meet at an edge.
    fn is_beyond(&self, other: &Self) -> bool {
        let Some(&corner) = self.polygon.corners().first() else { return true };
        let height = |c: &[R; 3]| dot(self.doubled, sub(*c, corner));
        let highest = other.polygon.corners().iter().map(height).fold(-R::INFINITY, R::larger);
        // Squares spare the roots: heights are multiples of twice the area of this face.
        let area = dot(self.doubled, self.doubled);
        let clear = highest * highest > area * (thickness::<R>() * thickness());
        if clear {
            return highest < R::ZERO;
        }
        let turn = cross(self.doubled, other.doubled);
        let least = R::from_f64(LEAST_SINE * LEAST_SINE);
        dot(turn, turn) > area * dot(other.doubled, other.doubled) * least
    }
}

/// A place of a hash table that holds no edge.
const NO_EDGE: u32 = u32::MAX;

/// What the four coordinates of an edge are multiplied with, and their sum, to scatter it over a hash table.
const SCATTER: [f64; 5] =
    [0.754_877_666_246_693, 0.569_840_290_998_053, 0.426_040_474_321_852, 0.322_185_354_626_086, 1e9];

/// Drop the edges between two faces that look the same way, which are most of those of fine surfaces; how many others are left, before them. A table of
/// at least as many `places` finds edges with the same ends; without it nothing is dropped. Those left need not be all different.
fn cancelled<R: Real>(edges: &mut [ShadowEdge<R>], places: &mut [u32]) -> usize {
    let size = (edges.len().saturating_mul(4) / 3).next_power_of_two();
    let Some(table) = places.get_mut(..size) else { return edges.len() };
    table.fill(NO_EDGE);
    let [a, b, c, d, all] = SCATTER.map(R::from_f64);
    let mut kept = 0_usize;
    for n in 0..edges.len() {
        let Some(&edge) = edges.get(n) else { break };
        let ShadowEdge { low, high, .. } = edge;
        let mut at = ((low[0] * a + low[1] * b + high[0] * c + high[1] * d) * all).to_usize() & (size - 1);
        // A quarter of the table is empty.
        while let Some(place) = table.get_mut(at) {
            match edges.get_mut(*place as usize) {
                Some(other) if other.low == low && other.high == high => {
                    other.covering = other.covering.saturating_add(edge.covering);
                    other.starting = other.starting.saturating_add(edge.starting);
                    break;
                }
                Some(_) => at = (at + 1) & (size - 1),
                None => {
                    *place = kept as u32;
                    if let Some(place) = edges.get_mut(kept) {
                        *place = edge;
                    }
                    kept += 1;
                    break;
                }
            }
        }
    }
    let mut left = 0;
    for n in 0..kept {
        let Some(&edge) = edges.get(n) else { break };
        if (edge.covering, edge.starting) != (0, 0) {
            if let Some(place) = edges.get_mut(left) {
                *place = edge;
            }
            left += 1;
        }
    }
    left
}

/// Sort edges by their low ends and make one of those with the same ends; how many are left that count.
fn joined<R: Real>(edges: &mut [ShadowEdge<R>]) -> usize {
    sort(edges);
    let (mut kept, mut open): (usize, Option<ShadowEdge<R>>) = (0, None);
    for n in 0..=edges.len() {
        let next = edges.get(n).copied();
        match (&mut open, next) {
            (Some(last), Some(edge)) if last.low == edge.low && last.high == edge.high => {
                last.covering = last.covering.saturating_add(edge.covering);
                last.starting = last.starting.saturating_add(edge.starting);
            }
            (last, _) => {
                if let Some(edge) = last.filter(|e| (e.covering, e.starting) != (0, 0)) {
                    if let Some(place) = edges.get_mut(kept) {
                        *place = edge;
                    }
                    kept += 1;
                }
                *last = next;
            }
        }
    }
    kept
}

/// Shell's sort, which needs no memory.
fn sort<R: Real>(edges: &mut [ShadowEdge<R>]) {
    let mut gap = edges.len() / 2;
    while gap > 0 {
        for start in gap..edges.len() {
            let Some(&edge) = edges.get(start) else { continue };
            let mut at = start;
            while let Some(&before) = at.checked_sub(gap).and_then(|n| edges.get(n)).filter(|e| e.follows(&edge)) {
                if let Some(place) = edges.get_mut(at) {
                    *place = before;
                }
                at -= gap;
            }
            if let Some(place) = edges.get_mut(at).filter(|_| at < start) {
                *place = edge;
            }
        }
        gap = if gap == 2 { 1 } else { gap * 5 / 11 };
    }
}

/// A line that sweeps over edges.
struct Sweep<'m, R> {
    /// First those that are crossed, in their order; from `next` on those not met yet, by their low ends.
    edges: &'m mut [ShadowEdge<R>],
    /// So many edges are crossed.
    count: usize,
    next: usize,
    /// In how many solids lines begin before the first edge.
    starting: i32,
}

impl<R: Real> Sweep<'_, R> {
    /// The area that is covered or solid; none if patience is spent.
    fn shadow(&mut self) -> Option<R> {
        let (mut steps, mut v, mut area) = (0_usize, R::ZERO, R::ZERO);
        // The places of the edges crossed so far are known at `v`.
        let mut known = true;
        while v < R::ONE {
            let nearest_end = self.drop_passed(v);
            let before = if known { self.count } else { 0 };
            let top = self.take_met(v, nearest_end);
            self.arrange(v, top, before);
            let stop = self.first_crossing(v, top);
            area += self.strips(v, stop, top);
            (v, known) = (stop, stop >= top);
            steps += self.count + 1;
            if steps > MOST_STEPS {
                return None;
            }
        }
        Some(area)
    }

    /// The crossed edges, in their order.
    #[inline(always)]
    fn crossed(&self) -> &[ShadowEdge<R>] {
        self.edges.get(..self.count).unwrap_or_default()
    }

    /// Forget the edges that end at or before `v`; where the first of the others ends.
    fn drop_passed(&mut self, v: R) -> R {
        let (mut kept, mut nearest) = (0, R::INFINITY);
        for nth in 0..self.count {
            let Some(end) = self.edges.get(nth).map(|edge| edge.high[1]) else { continue };
            if end > v {
                nearest = nearest.smaller(end);
                if kept < nth {
                    self.copy(nth, kept);
                }
                kept += 1;
            }
        }
        self.count = kept;
        nearest
    }

    /// Cross the edges that begin at or before `v` and go on; where the first of all that are crossed ends or another one begins.
    fn take_met(&mut self, v: R, nearest_end: R) -> R {
        let mut top = nearest_end;
        while let Some(edge) = self.edges.get(self.next) {
            if !(edge.low[1] <= v) {
                return top.smaller(edge.low[1]);
            }
            if edge.high[1] > v {
                top = top.smaller(edge.high[1]);
                // There is room: no more are crossed than have been met.
                self.copy(self.next, self.count);
                self.count += 1;
            }
            self.next += 1;
        }
        top.smaller(R::ONE)
    }

    /// Copy an edge to the place of another.
    #[inline(always)]
    fn copy(&mut self, from: usize, to: usize) {
        let Some(&edge) = self.edges.get(from) else { return };
        if let Some(place) = self.edges.get_mut(to) {
            *place = edge;
        }
    }

    /// Find the places of the crossed edges at `v` and at `top`, and put them in order, as the line meets them just beyond `v`. Of the first ones, so many,
    /// the step before has ended at `v`.
    fn arrange(&mut self, v: R, top: R, known: usize) {
        let mut last = [-R::INFINITY; 2];
        for start in 0..self.count {
            let Some(edge) = self.edges.get_mut(start) else { continue };
            let low = if start < known { edge.step[1] } else { edge.at(v) };
            let step = [low, edge.at(top)];
            edge.step = step;
            if start > 0 && is_before(step, last) {
                self.move_down(start);
            } else {
                last = step;
            }
        }
    }

    /// Move a crossed edge before those among the ones before it that it is before.
    fn move_down(&mut self, start: usize) {
        let Some(&edge) = self.edges.get(start) else { return };
        let mut at = start;
        while let Some(before) = at.checked_sub(1) {
            if !self.edges.get(before).is_some_and(|other| is_before(edge.step, other.step)) {
                break;
            }
            self.copy(before, at);
            at = before;
        }
        if let Some(place) = self.edges.get_mut(at) {
            *place = edge;
        }
    }

    /// Where two neighbours first change places between `v` and `top`, or `top`.
    fn first_crossing(&self, v: R, top: R) -> R {
        let (mut stop, mut last) = (top, None);
        for &ShadowEdge { step: [b_low, b_top], .. } in self.crossed() {
            if let Some([a_low, a_top]) = last.replace([b_low, b_top]) {
                let (before, after) = (b_low - a_low, b_top - a_top);
                if before > thickness() && after < R::ZERO {
                    // Of edges nearly along the line the places differ by more than rounding where they cross but for rounding.
                    let crossing = (v + (top - v) * (before / (before - after))).max(v + R::EPSILON);
                    stop = stop.smaller(crossing);
                }
            }
        }
        stop
    }

    /// What is covered or solid between `v` and `stop`, where no edges change places.
    fn strips(&self, v: R, stop: R, top: R) -> R {
        let (mut covering, mut starting, mut width) = (0_i32, self.starting, R::ZERO);
        let mut last = [R::ZERO; 2];
        let mut add = |here: [R; 2], more: [i32; 2]| {
            if covering > 0 || starting > 0 {
                width += ((here[0] - last[0]) + (here[1] - last[1])).max(R::ZERO) * R::HALF;
            }
            // There are fewer edges than would make them overflow.
            covering = covering.wrapping_add(more[0]);
            starting = starting.wrapping_add(more[1]);
            last = here;
        };
        for edge in self.crossed() {
            let end = if stop < top { edge.at(stop) } else { edge.step[1] };
            add([edge.step[0], end], [edge.covering, edge.starting]);
        }
        add([R::ONE; 2], [0; 2]);
        width * (stop - v)
    }
}

/// Places closer than this are one place.
fn thickness<R: Real>() -> R {
    R::EPSILON * R::from_f64(THICKNESS_IN_EPSILONS)
}

/// Is one edge before another, by their places on two lines?
fn is_before<R: Real>(one: [R; 2], other: [R; 2]) -> bool {
    let apart = one[0] - other[0];
    if apart.abs() > thickness() { apart < R::ZERO } else { one[1] < other[1] }
}
