//! Bodies in one cell as convex parts, each of them what lies behind a few planes: walls, edges and corners of boxes and plates, flanges and webs of beams
//! however they are turned, some facets of a pipe.

use super::bsp::{Branch, Node};
use super::piece::Plane;
use super::{CellUnion, Frame, NoProof};
use crate::number::real::Real;
use crate::number::space::dot;
use heapless::Vec;

/// Planes of a part, at most.
pub const MOST_PLANES: usize = 16;

/// Parts of all bodies in a cell, at most.
const MOST_PARTS: usize = 32;

/// What lies behind all of some planes; without any, all of the cell. A body in a cell is one such part or several, which share walls at most.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlanarPart<R> {
    /// The body that it is of. Parts of one body stand together.
    pub body: usize,
    /// The outward unit normal of each plane, and a point in it.
    pub planes: Vec<[[R; 3]; 2], MOST_PLANES>,
}

/// The parts of all bodies in a cell, or on both sides of a face.
pub type PlanarParts<R> = Vec<PlanarPart<R>, MOST_PARTS>;

impl<R: Real> CellUnion<'_, R> {
    /// Add the convex parts of the bodies, if they are few and simple, and their union has a proof: the solid leaves of their trees. Returns the
    /// error of the union.
    ///
    /// # Errors
    /// [`NoProof::Full`] if there are more parts or planes than there is room for, or as of the union in the cell.
    pub(in crate::surface) fn add_planar_parts(&mut self, found: &mut PlanarParts<R>) -> Result<R, NoProof> {
        let error = self.cell()?.error;
        let first = found.last().map_or(0, |part| part.body + 1);
        for (n, part) in self.space.parts.iter().take(self.part_count).enumerate() {
            self.add_solid_leaves(part.root, first + n, found)?;
        }
        Ok(error)
    }

    /// Each leaf lies behind or before the planes on the way to it.
    fn add_solid_leaves(&self, root: Branch, body: usize, found: &mut PlanarParts<R>) -> Result<(), NoProof> {
        let mut way: Vec<(u32, bool), MOST_PLANES> = Vec::new();
        let mut branch = root;
        loop {
            if let Branch::Node(number) = branch {
                way.push((number, false)).map_err(no_room)?;
                branch = self.node(number)?.negative;
                continue;
            }
            if branch == Branch::Solid {
                let mut planes = Vec::new();
                for &(number, before) in &way {
                    planes.push(self.frame.in_space(&self.node(number)?.plane, before)).map_err(no_room)?;
                }
                found.push(PlanarPart { body, planes }).map_err(no_room)?;
            }
            // On to the other side of the last plane of which only one has been seen.
            loop {
                match way.pop() {
                    None => return Ok(()),
                    Some((_, true)) => {}
                    Some((number, false)) => {
                        way.push((number, true)).map_err(no_room)?;
                        branch = self.node(number)?.positive;
                        break;
                    }
                }
            }
        }
    }

    fn node(&self, number: u32) -> Result<&Node<R>, NoProof> {
        self.space.nodes.get(number as usize).ok_or(NoProof::Full)
    }
}

/// What did not fit.
fn no_room<T>(_: T) -> NoProof {
    NoProof::Full
}

impl<R: Real> Frame<R> {
    /// The unit normal out of what lies behind a plane, or before it, and a point in it, in the coordinates of the cell's corners.
    fn in_space(&self, plane: &Plane<R>, before: bool) -> [[R; 3]; 2] {
        let normal = [0, 1, 2].map(|n| plane.normal[n] / self.scale[n]);
        let length = dot(normal, normal).sqrt();
        let unit = normal.map(|n| n / length);
        let point = [0, 1, 2].map(|n| self.origin[n] + unit[n] * (plane.offset / length));
        [if before { unit.map(|n| -n) } else { unit }, point]
    }
}
