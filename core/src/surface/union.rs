//! The exact union of several bodies in one cell.
//!
//! The surface of the union consists of those parts of each body's surface that lie outside all others. Every body gets
//! a binary space partition (BSP) of the cell by the planes of its own pieces; the pieces of the other bodies are cut
//! down those trees, and what arrives in no solid leaf is surface of the union. Where faces of two bodies coincide, the side
//! towards which a piece looks decides, and of equal twins the first counts. The same trees, fed with the
//! sides of the cell, give the union on its faces; then the divergence theorem gives the volume.
//! After B. Naylor, J. Amanatides, W. Thibault, *Merging BSP Trees Yields Polyhedral Set Operations*, SIGGRAPH 1990.
//!
//! Bodies that some plane tells apart have nothing in common: they are put in groups (`apart`), each group is united alone, and the fractions of all groups
//! are summed.
//!
//! **Proof.** The volume is computed along x, y and z. A piece wrongly kept or dropped leaves the surface of the union open, and
//! the three then differ, in each group. Their spread, summed over the groups, is reported as [`CellFractions::error`]; beyond [`MAX_SPREAD`] there is no answer.
//!
//! Everything happens in the frame of the cell, 0..1 along each axis, in memory of the caller.

mod apart;
mod bsp;
mod descent;
mod extent;
mod frame;
mod memory;
mod octree;
mod piece;
mod planar;
mod separate;
mod sheets;

use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};
use crate::number::space::{cross, sub};
use crate::surface::clip::Polygon;
use apart::gather;
use bsp::{Branch, BspMemory, build_bsp};
use core::ops::Range;
use descent::{Descent, DescentRule};
use frame::{MOST_ROUNDING, reaches};
use octree::{Octree, OctreeSize};
use piece::Ball;
use piece::NoProof::{Ambiguous, Full};
use separate::Bodies;

pub use bsp::{Node, Part, PendingNode};
pub use descent::Fragment;
pub(super) use frame::{Frame, rounds_much};
pub use memory::{UnionBuffers, UnionMemory, UnionNeeded};
pub use octree::Octant;
pub use piece::{NoProof, Piece};
pub use planar::{MOST_PLANES, PlanarPart, PlanarParts};

/// Largest accepted difference of the volumes along x, y and z, in cells.
pub const MAX_SPREAD: f64 = 1e-9;

/// Where the volumes differ by no more than this, they are rounded. Else some piece of surface is wrongly kept or dropped, as where planes all but coincide.
const ROUNDED: f64 = 1e-12;

/// Where rounding asks for planes thicker than this, in cells, there is no proof.
const TOO_THICK: f64 = 1.0 / 64.0;

/// The diagonal of a side of the cell, in its frame: no section of a piece is longer.
const LONGEST_EDGE: f64 = 1.5;

/// Solid fractions of the union in one cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellFractions<R> {
    /// Of the cell.
    pub cell: R,
    /// Of the low x, y and z face, seen from inside the cell.
    pub low: [R; 3],
    /// Of the high x, y and z face, seen from inside the cell.
    pub high: [R; 3],
    /// How far the volumes along the three axes are apart, and what a blur may have changed.
    pub error: R,
}

/// The union of some bodies in one cell, or on one face between two cells.
#[derive(Debug)]
pub struct CellUnion<'a, R: Real> {
    space: UnionMemory<'a, R>,
    frame: Frame<R>,
    /// Its planes are so thick that what this may cost counts.
    blurred: bool,
    /// Lowest and highest corner of the cells of bodies that are not marked `below`, and of those that are, in the frame.
    cells: [[[R; 3]; 2]; 2],
    part_count: usize,
    /// So many of them have their tree.
    built: usize,
    piece_count: usize,
    node_count: usize,
    octree: OctreeSize,
    /// The bodies in the octree.
    in_octree: Range<usize>,
}

impl<'a, R: Real> CellUnion<'a, R> {
    /// Begin with the cell `lo..hi`; it sets the frame. Planes closer than `blur`, in cells, are taken for one plane: faces that
    /// were meant to coincide and miss by so much then do, and [`CellFractions::error`] says what that may cost.
    pub fn new<V: Vector<Scalar = R>>(space: UnionMemory<'a, R>, cell: Aabb<V>, blur: R) -> Self {
        Self::in_frame(space, Frame::of(cell), blur)
    }

    /// The same for a cell that is thin along an axis only to see what touches one of its sides: rounding along that axis moves nothing that is asked for.
    pub(super) fn of_slab<V: Vector<Scalar = R>>(
        space: UnionMemory<'a, R>,
        cell: Aabb<V>,
        thin: usize,
        blur: R,
    ) -> Self {
        Self::in_frame(space, Frame::beside(cell, Some(thin)), blur)
    }

    fn in_frame(space: UnionMemory<'a, R>, frame: Frame<R>, blur: R) -> Self {
        CellUnion {
            space,
            blurred: blur > frame.thickness || frame.thickness > R::from_f64(MOST_ROUNDING),
            frame: Frame { thickness: frame.thickness.max(blur), ..frame },
            cells: [[[R::ZERO; 3], [R::ONE; 3]]; 2],
            part_count: 0,
            built: 0,
            piece_count: 0,
            node_count: 0,
            octree: OctreeSize::default(),
            in_octree: 0..0,
        }
    }

    /// Add what a body has of surface inside the cell `lo..hi`; nothing happens if it has none. With `below` the cell is the
    /// lower one beside the face that [`CellUnion::face`] will ask for.
    ///
    /// # Errors
    /// [`NoProof::Full`] if the workspace cannot hold it.
    pub fn add<V: Vector<Scalar = R>>(
        &mut self,
        cell: Aabb<V>,
        below: bool,
        triangles: &[[V; 3]],
        ids: impl Iterator<Item = u32>,
    ) -> Result<(), NoProof> {
        let (lo, hi) = (cell.min.to_array(), cell.max.to_array());
        self.cells[usize::from(below)] = [self.frame.framed(lo), self.frame.framed(hi)];
        let first = self.piece_count;
        let (mut filling, mut on_sides) = (R::ZERO, R::ZERO);
        let mut scratch = [Polygon::default(), Polygon::default()];
        for triangle in ids.filter_map(|id| triangles.get(id as usize)) {
            let triangle = triangle.map(Vector::to_array);
            if !reaches(&triangle, lo, hi) {
                continue;
            }
            let piece = self.space.pieces.get_mut(self.piece_count).ok_or(Full)?;
            if !self.frame.piece(&triangle, lo, hi, &mut scratch, piece) {
                continue;
            }
            match self.frame.on_side(piece, lo, hi) {
                Some(solid) => {
                    filling += if solid { piece.area } else { -piece.area };
                    on_sides += piece.area;
                }
                None => self.piece_count += 1,
            }
        }
        // With no surface but on its sides the cell is all solid or all open. The two walls of what reaches into it by rounding cancel.
        let uniform = if filling > on_sides * R::HALF { Branch::Solid } else { Branch::Open };
        if self.piece_count == first && uniform == Branch::Open {
            return Ok(());
        }
        let part =
            Part { first, end: self.piece_count, root: uniform, below, number: self.part_count, ..Part::default() };
        *self.space.parts.get_mut(self.part_count).ok_or(Full)? = part;
        self.part_count += 1;
        Ok(())
    }

    /// So many bodies have been added that have a share of the cell.
    pub fn part_count(&self) -> usize {
        self.part_count
    }

    /// So many pieces of surface have been added.
    pub fn piece_count(&self) -> usize {
        self.piece_count
    }

    /// Build the trees of the bodies added since the last time; not before it is known that all their pieces find room.
    fn build_trees(&mut self) -> Result<(), NoProof> {
        if self.frame.thickness > R::from_f64(TOO_THICK) {
            return Err(Ambiguous);
        }
        for n in self.built..self.part_count {
            let UnionMemory { pieces, split_pieces, order, nodes, pending, parts, .. } = &mut self.space;
            let part = parts.get_mut(n).ok_or(Full)?;
            if part.end > part.first {
                let memory = BspMemory { split_pieces, order, pending, nodes, node_count: &mut self.node_count };
                let pieces = pieces.get(part.first..part.end).ok_or(Full)?;
                part.root = build_bsp(pieces, memory, self.frame.thickness)?;
            }
        }
        if self.built < self.part_count {
            (self.built, self.in_octree) = (self.part_count, 0..0);
        }
        Ok(())
    }

    /// The union in the cell, if a proof is found.
    ///
    /// # Errors
    /// [`NoProof`]: divide the cell.
    pub fn cell(&mut self) -> Result<CellFractions<R>, NoProof> {
        self.cell_and_surface(&mut |_, _| ())
    }

    /// As [`CellUnion::cell`]; hands over the surface of the union inside the cell, in its frame, with the number of the body that it is of among those
    /// of [`CellUnion::part_count`]. Without a proof what was handed over may be wrong.
    ///
    /// # Errors
    /// [`NoProof`]: divide the cell.
    pub fn cell_and_surface(&mut self, each: &mut dyn FnMut(usize, &Polygon<R>)) -> Result<CellFractions<R>, NoProof> {
        self.build_trees()?;
        self.tell_apart();
        let mut sum = CellFractions { cell: R::ZERO, low: [R::ZERO; 3], high: [R::ZERO; 3], error: R::ZERO };
        let (shift, mut first) = (self.largest_shift(), 0);
        while let Some(bodies) = self.group_from(first) {
            first = bodies.end;
            let CellFractions { cell, low, high, error } = self.group_and_surface(bodies, shift, each)?;
            sum.cell += cell;
            sum.low = [0, 1, 2].map(|axis| sum.low[axis] + low[axis]);
            sum.high = [0, 1, 2].map(|axis| sum.high[axis] + high[axis]);
            sum.error += error;
        }
        let within = |v: R| v.min(R::ONE);
        let [low, high] = [sum.low, sum.high].map(|sides| sides.map(within));
        Ok(CellFractions { cell: within(sum.cell), low, high, error: sum.error + shift })
    }

    /// Put bodies that are not apart one after the other.
    fn tell_apart(&mut self) {
        let UnionMemory { pieces, nodes, parts, .. } = &mut self.space;
        let (parts, thickness) = (parts.get_mut(..self.part_count).unwrap_or_default(), self.frame.thickness);
        if parts.len() < 2 {
            return;
        }
        for n in 0..parts.len() {
            let extent = Bodies { parts, pieces, nodes, cells: &self.cells, thickness }.extent(n as u32);
            if let Some(part) = parts.get_mut(n) {
                part.extent = extent;
            }
        }
        gather(parts, thickness);
    }

    /// The bodies of the group that begins with one.
    fn group_from(&self, first: usize) -> Option<Range<usize>> {
        let bodies = self.space.parts.get(first..self.part_count)?;
        let group = bodies.first()?.group;
        Some(first..first + bodies.iter().take_while(|part| part.group == group).count())
    }

    /// As [`CellUnion::cell_and_surface`] of some bodies, without what a blur may have changed, `shift`.
    fn group_and_surface(
        &mut self,
        bodies: Range<usize>,
        shift: R,
        each: &mut dyn FnMut(usize, &Polygon<R>),
    ) -> Result<CellFractions<R>, NoProof> {
        let (mut flux, mut moment) = ([R::ZERO; 3], [R::ZERO; 3]);
        let (mut descent, pieces) = self.descent(bodies.clone());
        for (own, part) in descent.parts.iter().enumerate() {
            for Piece { polygon, ball, plane, .. } in pieces.get(part.first..part.end).ok_or(Full)? {
                let rule = DescentRule { toward: plane.normal, own: Some(own), both_sides: false };
                descent.send(polygon, *ball, rule, |kept| {
                    integrate(kept, &mut flux, &mut moment);
                    each(part.number, kept);
                })?;
            }
        }
        let (mut low, mut high, mut volume) = ([R::ZERO; 3], [R::ZERO; 3], [R::ZERO; 3]);
        for axis in 0..3 {
            low[axis] = self.face_of(bodies.clone(), axis, R::ZERO, Limit::Above)?;
            high[axis] = low[axis] - flux[axis];
            volume[axis] = low[axis] - moment[axis];
        }
        let max = volume[0].max(volume[1]).max(volume[2]);
        let min = volume[0].min(volume[1]).min(volume[2]);
        let mut error = max - min;
        for share in high {
            error = error.max(-share).max(share - R::ONE);
        }
        if !(error <= R::from_f64(MAX_SPREAD).max(self.frame.thickness).max(shift)) {
            return Err(Ambiguous);
        }
        let error = if error > R::from_f64(ROUNDED) { error + self.open_area(bodies, high)? } else { error };
        let within = |v: R| v.max(R::ZERO).min(R::ONE);
        Ok(CellFractions { cell: within((max + min) * R::HALF), low, high: high.map(within), error })
    }

    /// How much of the surface of a union of bodies is missing or too much, as its high sides tell: in cells, twice the sum of what they differ by from what
    /// the surface leads to. A volume is wrong by no more than the area that is, unless pieces of it cancel.
    fn open_area(&mut self, bodies: Range<usize>, high: [R; 3]) -> Result<R, NoProof> {
        let mut sum = R::ZERO;
        for (axis, share) in high.into_iter().enumerate() {
            sum += (self.face_of(bodies.clone(), axis, R::ONE, Limit::Below)? - share).abs();
        }
        Ok(R::TWO * sum)
    }

    /// By how much a blur may change volumes and areas: every piece moves by no more than the thickness.
    fn largest_shift(&self) -> R {
        if !self.blurred {
            return R::ZERO;
        }
        let pieces = self.space.pieces.iter().take(self.piece_count);
        let reach = pieces.fold(R::ONE, |sum, piece| sum + piece.area.max(R::from_f64(LONGEST_EDGE)));
        reach * self.frame.thickness
    }

    /// Solid fraction on the side of the cell normal to `axis` (0, 1, otherwise 2) at coordinate `at` of the frame (0 or 1).
    ///
    /// # Errors
    /// [`NoProof`], of the workspace or of planes.
    pub fn face(&mut self, axis: usize, at: R, limit: Limit) -> Result<R, NoProof> {
        self.build_trees()?;
        self.face_of(0..self.part_count, axis, at, limit)
    }

    /// The same of some bodies, whose trees there are.
    fn face_of(&mut self, bodies: Range<usize>, axis: usize, at: R, limit: Limit) -> Result<R, NoProof> {
        let axis = axis.min(2);
        let mut square = Polygon::default();
        for (u, v) in [(R::ZERO, R::ZERO), (R::ONE, R::ZERO), (R::ONE, R::ONE), (R::ZERO, R::ONE)] {
            let mut corner = [at; 3];
            (corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (u, v);
            square.push(corner);
        }
        let mut toward = [R::ZERO; 3];
        toward[axis] = if limit == Limit::Below { -R::ONE } else { R::ONE };
        let rule = DescentRule { toward, own: None, both_sides: limit == Limit::Both };
        let open = self.doubled_open(bodies, &square, rule, axis)?;
        Ok((R::ONE - open * R::HALF).max(R::ZERO).min(R::ONE))
    }

    /// Twice the open area of a polygon on a side of the cell normal to `axis`, where some bodies have their trees.
    #[inline(never)]
    fn doubled_open(
        &mut self,
        bodies: Range<usize>,
        polygon: &Polygon<R>,
        rule: DescentRule<R>,
        axis: usize,
    ) -> Result<R, NoProof> {
        let (mut open, axis) = (R::ZERO, axis.min(2));
        self.descent(bodies).0.send(polygon, Ball::around(polygon), rule, |kept| open += kept.doubled_area()[axis])?;
        Ok(open)
    }

    /// What goes down the trees of some bodies, and all pieces.
    fn descent(&mut self, bodies: Range<usize>) -> (Descent<'_, R>, &[Piece<R>]) {
        if self.in_octree != bodies {
            (self.octree, self.in_octree) = (OctreeSize::default(), bodies.clone());
        }
        let UnionMemory { pieces, nodes, parts, fragments, octants, near, .. } = &mut self.space;
        let (parts, thickness) = (parts.get(bodies).unwrap_or_default(), self.frame.thickness);
        let bodies = Bodies { parts, pieces, nodes, cells: &self.cells, thickness };
        let mut octree = Octree { octants, near, size: &mut self.octree, bodies };
        octree.begin(!self.blurred);
        (Descent { nodes, parts, fragments, octree, spare: Polygon::default(), thickness }, pieces)
    }
}

/// From which side a face is seen where solid lies in its plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limit {
    /// From lower coordinates.
    Below,
    /// From higher coordinates.
    Above,
    /// Bodies added with `below` from lower coordinates, the others from higher ones: open is what both see open.
    Both,
}

/// Add ∫ n dA and ∫ n_a (1 − x_a) dA of a polygon.
pub(super) fn integrate<R: Real>(polygon: &Polygon<R>, flux: &mut [R; 3], moment: &mut [R; 3]) {
    let [o, first, others @ ..] = polygon.corners() else { return };
    let third = R::ONE / R::from_f64(3.0);
    let mut a = sub(*first, *o);
    for p in others {
        let b = sub(*p, *o);
        let n = cross(a, b);
        for axis in 0..3 {
            let area = n[axis] * R::HALF;
            flux[axis] += area;
            moment[axis] += area * ((R::ONE - o[axis]) - (a[axis] + b[axis]) * third);
        }
        a = b;
    }
}
