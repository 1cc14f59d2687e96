//! The exact union of several bodies in one cell.
//!
//! The surface of the union consists of those parts of each body's surface that lie outside all others. Every body gets
//! a binary space partition (BSP) of the cell by the planes of its own pieces; the pieces of the other bodies are cut
//! down those trees, and what arrives in no solid leaf is surface of the union. Where faces of two bodies coincide, the side
//! towards which a piece looks decides, and of equal twins the first counts. The same trees, fed with the
//! sides of the cell, give the union on its faces; then the divergence theorem gives the volume.
//! After B. Naylor, J. Amanatides, W. Thibault, *Merging BSP Trees Yields Polyhedral Set Operations*, SIGGRAPH 1990.
//!
//! **Proof.** The volume is computed along x, y and z. A piece wrongly kept or dropped leaves the surface of the union open, and
//! the three then differ. Their spread is reported as [`CellUnion::error`]; beyond [`MAX_SPREAD`] there is no answer.
//!
//! Everything happens in the frame of the cell, 0..1 along each axis, in memory of the caller.

use crate::clip::{Polygon, cross, dot, split, sub};
use crate::real::{Real, Vector};

/// Largest accepted difference of the volumes along x, y and z, in cells.
pub const MAX_SPREAD: f64 = 1e-9;

/// Rounding of corners in the frame of a cell, in ε of the coordinates as seen from there. Planes closer than that are
/// one plane.
const THICKNESS_IN_EPSILONS: f64 = 64.0;

/// Planes of two bodies between one and so many thicknesses apart are neither one nor two for certain.
const DOUBT: f64 = 4.0;

/// Fragments smaller than this, in faces of the cell, cannot do harm.
const SLIVER: f64 = 1e-9;

/// The diagonal of a side of the cell, in its frame: no section of a piece is longer.
const LONGEST_EDGE: f64 = 1.5;

/// Solid fractions of the union in one cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellUnion<R> {
    /// Of the cell.
    pub cell: R,
    /// Of the low x, y and z face, seen from inside the cell.
    pub low: [R; 3],
    /// Of the high x, y and z face, seen from inside the cell.
    pub high: [R; 3],
    /// How far the volumes along the three axes are apart, and what a blur may have changed.
    pub error: R,
}

/// A polygon of surface and its plane `normal·p = offset`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Piece<R: Real> {
    polygon: Polygon<R>,
    normal: [R; 3],
    offset: R,
    area: R,
}

/// Where a branch of a tree leads.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Branch {
    #[default]
    Open,
    Solid,
    Node(u32),
}

/// A plane that divides a part of the cell; the solid lies on its negative side.
#[derive(Clone, Copy, Debug, Default)]
pub struct Node<R: Real> {
    normal: [R; 3],
    offset: R,
    positive: Branch,
    negative: Branch,
}

/// A body in the cell: its pieces, its tree, and the side from which walls of a face see it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Part {
    first: usize,
    end: usize,
    root: Branch,
    below: bool,
}

/// A polygon on its way down the trees.
#[derive(Clone, Copy, Debug, Default)]
pub struct Fragment<R: Real> {
    polygon: Polygon<R>,
    part: usize,
    branch: Branch,
    /// Coincident planes are taken towards the inner side of the polygon, not the outer one.
    inward: bool,
    /// It met a coincident plane of the same orientation.
    twin: bool,
}

/// A list of pieces still to be made a subtree.
#[derive(Clone, Copy, Debug, Default)]
pub struct Task {
    first: usize,
    end: usize,
    parent: Option<(u32, bool)>,
}

/// Caller's memory for the unions of cells; the larger, the more surface a cell may hold. Contents do not matter.
#[derive(Debug)]
pub struct Workspace<'a, R: Real> {
    /// Pieces of all bodies.
    pub pieces: &'a mut [Piece<R>],
    /// Parts of pieces that were cut while a tree grew.
    pub shards: &'a mut [Piece<R>],
    /// Which pieces and shards go where while a tree grows.
    pub order: &'a mut [u32],
    /// Nodes of all trees.
    pub nodes: &'a mut [Node<R>],
    /// Bodies.
    pub parts: &'a mut [Part],
    /// Fragments under way.
    pub fragments: &'a mut [Fragment<R>],
    /// Branches of a tree still to grow.
    pub tasks: &'a mut [Task],
}

/// Why there is no union: divide the cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoProof {
    /// The workspace is too small for what the cell holds.
    Full,
    /// Planes too close to tell apart, or the three volumes disagree; a blur may help.
    Doubt,
}

use NoProof::{Doubt, Full};

/// The union of some bodies in one cell, or on one face between two cells.
#[derive(Debug)]
pub struct Overlap<'a, R: Real> {
    space: Workspace<'a, R>,
    origin: [R; 3],
    scale: [R; 3],
    /// Planes closer than this are one.
    thickness: R,
    /// That is more than rounding asks for.
    blurred: bool,
    part_count: usize,
    /// So many of them have their tree.
    planted: usize,
    piece_count: usize,
    node_count: usize,
}

impl<'a, R: Real> Overlap<'a, R> {
    /// Begin with the cell `lo..hi`; it sets the frame. Planes closer than `blur`, in cells, are taken for one plane: faces that
    /// were meant to coincide and miss by so much then do, and [`CellUnion::error`] says what that may cost.
    pub fn new(space: Workspace<'a, R>, lo: [R; 3], hi: [R; 3], blur: R) -> Self {
        let size = sub(hi, lo);
        let mut reach = R::ONE;
        for axis in 0..3 {
            reach = reach.max(lo[axis].abs().max(hi[axis].abs()) / size[axis]);
        }
        let rounding = R::EPSILON * R::from_f64(THICKNESS_IN_EPSILONS) * reach;
        let thickness = rounding.max(blur);
        Overlap {
            space,
            origin: lo,
            scale: size,
            blurred: blur > rounding,
            thickness,
            part_count: 0,
            planted: 0,
            piece_count: 0,
            node_count: 0,
        }
    }

    /// Add what a body has of surface inside the cell `lo..hi`; nothing happens if it has none. With `below` the cell is the
    /// lower one beside the face that [`Overlap::face`] will ask for.
    ///
    /// # Errors
    /// [`NoProof::Full`] if the workspace cannot hold it.
    pub fn add<V: Vector<Scalar = R>>(
        &mut self,
        lo: [R; 3],
        hi: [R; 3],
        below: bool,
        triangles: &[[V; 3]],
        ids: &[u32],
    ) -> Result<(), NoProof> {
        let first = self.piece_count;
        let mut filling = R::ZERO;
        for triangle in ids.iter().filter_map(|&id| triangles.get(id as usize)) {
            let Some(piece) = self.piece(&triangle.map(Vector::to_array), lo, hi) else { continue };
            if let Some(solid) = self.on_side(&piece, lo, hi) {
                filling += if solid { piece.area } else { -piece.area };
                continue;
            }
            *self.space.pieces.get_mut(self.piece_count).ok_or(Full)? = piece;
            self.piece_count += 1;
        }
        // With no surface but on its sides the cell is all solid or all open.
        let uniform = if filling > R::ZERO { Branch::Solid } else { Branch::Open };
        if self.piece_count == first && uniform == Branch::Open {
            return Ok(());
        }
        let part = Part { first, end: self.piece_count, root: uniform, below };
        *self.space.parts.get_mut(self.part_count).ok_or(Full)? = part;
        self.part_count += 1;
        Ok(())
    }

    /// Build the trees of the bodies added since the last time; not before it is known that all their pieces find room.
    fn plant(&mut self) -> Result<(), NoProof> {
        for n in self.planted..self.part_count {
            let part = self.space.parts[n];
            if part.end > part.first {
                self.space.parts[n].root = self.grow(part)?;
            }
        }
        self.planted = self.part_count;
        Ok(())
    }

    /// Does a piece lie on a side of the cell `lo..hi`, and if so, is the solid on the inner side of it?
    fn on_side(&self, piece: &Piece<R>, lo: [R; 3], hi: [R; 3]) -> Option<bool> {
        let (low, high) = (self.framed(lo), self.framed(hi));
        (0..3).find_map(|axis| {
            let near = |at: R| piece.polygon.corners().iter().all(|c| (c[axis] - at).abs() <= self.thickness);
            if near(low[axis]) {
                Some(piece.normal[axis] < R::ZERO)
            } else {
                near(high[axis]).then_some(piece.normal[axis] > R::ZERO)
            }
        })
    }

    /// The part of a triangle inside a cell, in the frame. Cut along z, y, x as in [`crate::surface`].
    fn piece(&self, corners: &[[R; 3]; 3], lo: [R; 3], hi: [R; 3]) -> Option<Piece<R>> {
        let [a, b, c] = corners;
        for axis in 0..3 {
            let (min, max) = (a[axis].min(b[axis]).min(c[axis]), a[axis].max(b[axis]).max(c[axis]));
            if !(min < hi[axis] && max > lo[axis]) {
                return None;
            }
        }
        let mut polygon = Polygon::new(corners);
        let (mut kept, mut spare) = (Polygon::default(), Polygon::default());
        for axis in [2, 1, 0] {
            let (min, max) = polygon.extent(axis);
            if !(min < hi[axis] && max > lo[axis]) {
                return None;
            }
            if min < lo[axis] {
                split(&polygon, axis, lo[axis], &mut spare, &mut kept);
                polygon = kept;
            }
            if max > hi[axis] {
                split(&polygon, axis, hi[axis], &mut kept, &mut spare);
                polygon = kept;
            }
            if polygon.is_empty() {
                return None;
            }
        }
        let mut framed = Polygon::default();
        for c in polygon.corners() {
            framed.push(self.framed(*c));
        }
        let [a, b, c] = corners.map(|c| self.framed(c));
        let normal = unit(cross(sub(b, a), sub(c, a)))?;
        let offset = dot(normal, framed.corners()[0]);
        let area = dot(framed.doubled_area(), normal);
        (area > R::ZERO).then_some(Piece { polygon: framed, normal, offset, area })
    }

    fn framed(&self, p: [R; 3]) -> [R; 3] {
        let d = sub(p, self.origin);
        [d[0] / self.scale[0], d[1] / self.scale[1], d[2] / self.scale[2]]
    }

    /// Build the tree of a body: the largest piece divides, the others go to its sides.
    fn grow(&mut self, part: Part) -> Result<Branch, NoProof> {
        let count = part.end - part.first;
        let Workspace { pieces, shards, order, nodes, tasks, .. } = &mut self.space;
        let mut growing = Growing { pieces: &pieces[part.first..part.end], shards, used: 0, thickness: self.thickness };
        let all = order.get_mut(..count).ok_or(Full)?;
        all.iter_mut().zip(0..).for_each(|(place, id)| *place = id);
        *tasks.first_mut().ok_or(Full)? = Task { first: 0, end: count, parent: None };
        let (mut open_tasks, root) = (1, self.node_count as u32);
        while open_tasks > 0 {
            open_tasks -= 1;
            let Task { first, end, parent } = tasks[open_tasks];
            let here = Branch::Node(self.node_count as u32);
            let (normal, offset) = growing.largest(&mut order[first..end]);
            *nodes.get_mut(self.node_count).ok_or(Full)? =
                Node { normal, offset, positive: Branch::Open, negative: Branch::Solid };
            self.node_count += 1;
            if let Some((node, positive)) = parent {
                let node = &mut nodes[node as usize];
                *(if positive { &mut node.positive } else { &mut node.negative }) = here;
            }
            let (middle, end) = growing.divide(order, first, end)?;
            let Branch::Node(node) = here else { continue };
            for (first, end, positive) in [(first, middle, false), (middle, end, true)] {
                if end > first {
                    *tasks.get_mut(open_tasks).ok_or(Full)? = Task { first, end, parent: Some((node, positive)) };
                    open_tasks += 1;
                }
            }
        }
        Ok(Branch::Node(root))
    }

    /// The union in the cell, if a proof is found.
    ///
    /// # Errors
    /// [`NoProof`]: divide the cell.
    pub fn cell(&mut self) -> Result<CellUnion<R>, NoProof> {
        self.plant()?;
        let (mut flux, mut moment) = ([R::ZERO; 3], [R::ZERO; 3]);
        for own in 0..self.part_count {
            for p in self.space.parts[own].first..self.space.parts[own].end {
                let Piece { polygon, normal, .. } = self.space.pieces[p];
                self.descend(&polygon, normal, Some(own), false, |kept| integrate(kept, &mut flux, &mut moment))?;
            }
        }
        let (mut low, mut high, mut volume) = ([R::ZERO; 3], [R::ZERO; 3], [R::ZERO; 3]);
        for axis in 0..3 {
            low[axis] = self.face(axis, R::ZERO, Limit::Above)?;
            high[axis] = low[axis] - flux[axis];
            volume[axis] = low[axis] - moment[axis];
        }
        let max = volume[0].max(volume[1]).max(volume[2]);
        let min = volume[0].min(volume[1]).min(volume[2]);
        let mut error = max - min;
        for share in high {
            error = error.max(-share).max(share - R::ONE);
        }
        let shift = self.largest_shift();
        if !(error <= R::from_f64(MAX_SPREAD).max(self.thickness).max(shift)) {
            return Err(Doubt);
        }
        let error = error + shift;
        let within = |v: R| v.max(R::ZERO).min(R::ONE);
        Ok(CellUnion { cell: within((max + min) * R::HALF), low, high: high.map(within), error })
    }

    /// By how much a blur may change volumes and areas: every piece moves by no more than the thickness.
    fn largest_shift(&self) -> R {
        if !self.blurred {
            return R::ZERO;
        }
        let pieces = self.space.pieces[..self.piece_count].iter();
        let reach = pieces.fold(R::ONE, |sum, piece| sum + piece.area.max(R::from_f64(LONGEST_EDGE)));
        reach * self.thickness
    }

    /// Solid fraction on the side of the cell normal to `axis` at coordinate `at` of the frame (0 or 1).
    ///
    /// # Errors
    /// [`NoProof`], of the workspace or of planes.
    pub fn face(&mut self, axis: usize, at: R, limit: Limit) -> Result<R, NoProof> {
        self.plant()?;
        let mut square = Polygon::default();
        for (u, v) in [(R::ZERO, R::ZERO), (R::ONE, R::ZERO), (R::ONE, R::ONE), (R::ZERO, R::ONE)] {
            let mut corner = [at; 3];
            (corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (u, v);
            square.push(corner);
        }
        let mut toward = [R::ZERO; 3];
        toward[axis] = if limit == Limit::Below { -R::ONE } else { R::ONE };
        let mut open = R::ZERO;
        self.descend(&square, toward, None, limit == Limit::Both, |kept| open += kept.doubled_area()[axis])?;
        Ok((R::ONE - open * R::HALF).max(R::ZERO).min(R::ONE))
    }

    /// Send a polygon down all trees but its own; hand what ends in no solid leaf to `keep`. Where it lies in a plane
    /// of a tree it follows `toward`; with `both_sides`, bodies marked `below` take the opposite direction.
    fn descend(
        &mut self,
        polygon: &Polygon<R>,
        toward: [R; 3],
        own: Option<usize>,
        both_sides: bool,
        mut keep: impl FnMut(&Polygon<R>),
    ) -> Result<(), NoProof> {
        let Workspace { nodes, parts, fragments, .. } = &mut self.space;
        let parts = &parts[..self.part_count];
        let enter = |f: &mut Fragment<R>, part: usize| {
            f.part = if Some(part) == own { part + 1 } else { part };
            f.branch = parts.get(f.part).map_or(Branch::Open, |p| p.root);
            (f.inward, f.twin) = (false, false);
        };
        let first = fragments.first_mut().ok_or(Full)?;
        first.polygon = *polygon;
        enter(first, 0);
        let mut waiting = 1;
        while waiting > 0 {
            waiting -= 1;
            let mut f = fragments[waiting];
            loop {
                let Some(part) = parts.get(f.part) else {
                    keep(&f.polygon);
                    break;
                };
                let node = match f.branch {
                    Branch::Solid => break,
                    Branch::Open if f.twin && !f.inward && own.is_some_and(|own| f.part < own) => {
                        (f.inward, f.branch) = (true, part.root);
                        continue;
                    }
                    Branch::Open => {
                        let next = f.part + 1;
                        enter(&mut f, next);
                        continue;
                    }
                    Branch::Node(n) => &nodes[n as usize],
                };
                let span = span(&f.polygon, node.normal, node.offset);
                let place = side(span, self.thickness);
                if place != Place::On
                    && side(span, self.thickness * R::from_f64(DOUBT)) == Place::On
                    && f.polygon.doubled_area().iter().any(|a| a.abs() > R::from_f64(SLIVER))
                {
                    // Not quite one plane, not clearly two: another piece of the same faces may be judged otherwise.
                    return Err(Doubt);
                }
                f.branch = match place {
                    Place::Positive => node.positive,
                    Place::Negative => node.negative,
                    Place::On => {
                        let along = dot(node.normal, toward) > R::ZERO;
                        f.twin |= along;
                        if along != (f.inward || (both_sides && part.below)) { node.positive } else { node.negative }
                    }
                    Place::Across if f.polygon.is_full() => {
                        let [half, other] = f.polygon.halves();
                        *fragments.get_mut(waiting).ok_or(Full)? = Fragment { polygon: other, ..f };
                        waiting += 1;
                        f.polygon = half;
                        continue;
                    }
                    Place::Across => {
                        let (negative, positive) = cut(&f.polygon, node.normal, node.offset);
                        if !positive.is_empty() {
                            *fragments.get_mut(waiting).ok_or(Full)? =
                                Fragment { polygon: positive, branch: node.positive, ..f };
                            waiting += 1;
                        }
                        if negative.is_empty() {
                            break;
                        }
                        f.polygon = negative;
                        node.negative
                    }
                };
            }
        }
        Ok(())
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

/// A polygon against a plane.
#[derive(Clone, Copy, PartialEq)]
enum Place {
    Positive,
    Negative,
    On,
    Across,
}

/// Signed distances of the corners of a polygon from a plane, the smallest and the largest.
#[inline(always)]
fn span<R: Real>(polygon: &Polygon<R>, normal: [R; 3], offset: R) -> (R, R) {
    let (mut min, mut max) = (R::INFINITY, -R::INFINITY);
    for c in polygon.corners() {
        let d = dot(normal, *c) - offset;
        min = d.smaller(min);
        max = d.larger(max);
    }
    (min, max)
}

#[inline(always)]
fn side<R: Real>((min, max): (R, R), thickness: R) -> Place {
    match (min < -thickness, max > thickness) {
        (false, false) => Place::On,
        (false, true) => Place::Positive,
        (true, false) => Place::Negative,
        (true, true) => Place::Across,
    }
}

/// Cut a polygon that is not full by a plane, into its negative and positive part.
fn cut<R: Real>(whole: &Polygon<R>, normal: [R; 3], offset: R) -> (Polygon<R>, Polygon<R>) {
    let (mut negative, mut positive) = (Polygon::default(), Polygon::default());
    let distance = |p: [R; 3]| dot(normal, p) - offset;
    let Some(&(mut a)) = whole.corners().last() else { return (negative, positive) };
    let mut da = distance(a);
    for &b in whole.corners() {
        let db = distance(b);
        if (da < R::ZERO && db > R::ZERO) || (da > R::ZERO && db < R::ZERO) {
            let (lo, hi, t) = if da < db { (a, b, da / (da - db)) } else { (b, a, db / (db - da)) };
            let p = [0, 1, 2].map(|i| lo[i] + (hi[i] - lo[i]) * t);
            negative.push(p);
            positive.push(p);
        }
        if db <= R::ZERO {
            negative.push(b);
        }
        if db >= R::ZERO {
            positive.push(b);
        }
        (a, da) = (b, db);
    }
    (negative, positive)
}

/// The pieces of a body while its tree grows, by number: first those of the cell, then the parts of those that were cut.
struct Growing<'a, R: Real> {
    pieces: &'a [Piece<R>],
    shards: &'a mut [Piece<R>],
    /// So many shards there are.
    used: usize,
    thickness: R,
}

impl<R: Real> Growing<'_, R> {
    fn piece(&self, id: u32) -> &Piece<R> {
        let id = id as usize;
        self.pieces.get(id).unwrap_or_else(|| &self.shards[id - self.pieces.len()])
    }

    fn keep(&mut self, shard: Piece<R>) -> Result<u32, NoProof> {
        *self.shards.get_mut(self.used).ok_or(Full)? = shard;
        self.used += 1;
        Ok((self.pieces.len() + self.used - 1) as u32)
    }

    /// The plane of the piece of largest area, which moves to the front.
    fn largest(&self, order: &mut [u32]) -> ([R; 3], R) {
        let mut best = 0;
        for p in 1..order.len() {
            if self.piece(order[p]).area > self.piece(order[best]).area {
                best = p;
            }
        }
        order.swap(0, best);
        let Piece { normal, offset, .. } = *self.piece(order[0]);
        (normal, offset)
    }

    /// Sort the pieces after `order[first]`, the divider, by the sides of its plane: `first..a` behind, `a..b` before;
    /// returns `(a, b)`. Pieces in the plane are dropped, pieces across are cut.
    fn divide(&mut self, order: &mut [u32], first: usize, end: usize) -> Result<(usize, usize), NoProof> {
        let divider = order[first];
        let Piece { normal, offset, .. } = *self.piece(divider);
        // Pieces before the plane gather above `end` and are moved down at last.
        let (mut behind, mut before) = (first, end);
        for p in first + 1..end {
            let id = order[p];
            let piece = self.piece(id);
            match side(span(&piece.polygon, normal, offset), self.thickness) {
                // Solid thinner than rounding: which side of the plane holds it cannot be told.
                Place::On if backs(piece, self.piece(divider), self.thickness) => return Err(Doubt),
                Place::On => {}
                Place::Negative => {
                    order[behind] = id;
                    behind += 1;
                }
                Place::Positive => {
                    *order.get_mut(before).ok_or(Full)? = id;
                    before += 1;
                }
                Place::Across => {
                    let piece = *piece;
                    let whole = piece.polygon;
                    let halves = if whole.is_full() { whole.halves() } else { [whole, Polygon::default()] };
                    for half in halves {
                        let (negative, positive) = cut(&half, normal, offset);
                        let part = |polygon: Polygon<R>| Piece {
                            area: dot(polygon.doubled_area(), piece.normal),
                            polygon,
                            ..piece
                        };
                        let (negative, positive) = (part(negative), part(positive));
                        if negative.area > R::ZERO {
                            // The second half of a full polygon may need room that is not yet free.
                            if behind > p {
                                return Err(Full);
                            }
                            order[behind] = self.keep(negative)?;
                            behind += 1;
                        }
                        if positive.area > R::ZERO {
                            *order.get_mut(before).ok_or(Full)? = self.keep(positive)?;
                            before += 1;
                        }
                    }
                }
            }
        }
        order.copy_within(end..before, behind);
        Ok((behind, behind + before - end))
    }
}

/// Does a piece in the plane of another look the other way and lie, by their boxes, on the same spot?
fn backs<R: Real>(a: &Piece<R>, b: &Piece<R>, thickness: R) -> bool {
    let shared = [0, 1, 2].map(|axis| {
        let ((a_lo, a_hi), (b_lo, b_hi)) = (a.polygon.extent(axis), b.polygon.extent(axis));
        a_hi.min(b_hi) - a_lo.max(b_lo)
    });
    let wide = shared.iter().filter(|&&s| s > thickness).count();
    dot(a.normal, b.normal) < R::ZERO && wide >= 2 && shared.iter().all(|&s| s >= -thickness)
}

/// Add ∫ n dA and ∫ n_a (1 − x_a) dA of a polygon.
fn integrate<R: Real>(polygon: &Polygon<R>, flux: &mut [R; 3], moment: &mut [R; 3]) {
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

/// A vector of length 1; none for zero, overflow and NaN.
fn unit<R: Real>(v: [R; 3]) -> Option<[R; 3]> {
    let largest = v[0].abs().max(v[1].abs()).max(v[2].abs());
    if !(largest > R::ZERO && largest.is_finite()) {
        return None;
    }
    let scaled = v.map(|c| c / largest);
    let length = dot(scaled, scaled).sqrt();
    Some(scaled.map(|c| c / length))
}
