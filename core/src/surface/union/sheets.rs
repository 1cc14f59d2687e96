//! What the bodies in a cell leave of sheets without volume: what lies inside a body is no surface, and what lies on a wall is that wall.

use super::descent::DescentRule;
use super::piece::Ball;
use super::{CellUnion, NoProof};
use crate::number::real::{Real, Vector};
use crate::number::space::unit;
use crate::surface::clip::{Polygon, keep};

impl<R: Real> CellUnion<'_, R> {
    /// Hands over those parts of a piece of sheet inside the cell that lie outside all bodies and not on their surface; all of them in the frame of the cell.
    ///
    /// # Errors
    /// [`NoProof`], of the workspace or of planes.
    pub(in crate::surface) fn free_parts(
        &mut self,
        piece: &Polygon<R>,
        each: impl FnMut(&Polygon<R>),
    ) -> Result<(), NoProof> {
        let Some(toward) = unit(piece.doubled_area()) else { return Ok(()) };
        self.build_trees()?;
        // It comes after all bodies: of what coincides, theirs counts.
        let rule = DescentRule { toward, own: Some(self.part_count), both_sides: false };
        self.descent(0..self.part_count).0.send(piece, Ball::around(piece), rule, each)
    }

    /// Share of the side of the cell normal to `axis` (0, 1, otherwise 2) at higher coordinates that a triangle in its plane covers and that is open as seen from
    /// both sides.
    ///
    /// # Errors
    /// [`NoProof`], of the workspace or of planes.
    pub(in crate::surface) fn free_share<V: Vector<Scalar = R>>(
        &mut self,
        axis: usize,
        triangle: &[V; 3],
    ) -> Result<R, NoProof> {
        let axis = axis.min(2);
        let [mut polygon, mut kept] = [Polygon::default(), Polygon::default()];
        for corner in triangle {
            let mut corner = self.frame.framed(corner.to_array());
            corner[axis] = R::ONE;
            polygon.push(corner);
        }
        for across in (0..3).filter(|&across| across != axis) {
            let (min, max) = polygon.extent(across);
            if !(min < R::ONE && max > R::ZERO) {
                return Ok(R::ZERO);
            }
            for (at, above) in [(R::ZERO, true), (R::ONE, false)] {
                keep(&polygon, across, at, above, &mut kept);
                core::mem::swap(&mut polygon, &mut kept);
            }
        }
        if polygon.is_empty() {
            return Ok(R::ZERO);
        }
        self.build_trees()?;
        let mut toward = [R::ZERO; 3];
        toward[axis] = R::ONE;
        let rule = DescentRule { toward, own: None, both_sides: true };
        let free = self.doubled_open(0..self.part_count, &polygon, rule, axis)?;
        Ok(free.abs() * R::HALF)
    }
}
