//! The faces of what is in a cell, and whether lines along an axis enter it once at most.

use super::edge::thickness;
use crate::number::real::Real;
use crate::number::space::{cross, dot, sub};
use crate::surface::clip::Polygon;

/// A face of a solid in a cell. The default serves as memory.
#[derive(Clone, Debug, Default)]
pub struct ShadowFace<R: Real> {
    pub(super) polygon: Polygon<R>,
    /// Twice its area vector.
    pub(super) doubled: [R; 3],
    /// From where to where it extends along x, y and z.
    around: [(R, R); 3],
    pub(super) solid: usize,
    pub(super) sheet: bool,
}

/// The faces in a cell, those of one solid after those of another, in the frame of the cell.
pub(in crate::surface) struct CellFaces<'m, R: Real> {
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

    pub(super) fn all(&self) -> &[ShadowFace<R>] {
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
