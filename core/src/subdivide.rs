//! Depth-first subdivision of a grid against convex bodies: solid shares of cells or faces, as bounds.
//!
//! A range of cells is asked of every body that may reach it: open, closed or cut ([`crate::subdivide::place`]). Open bodies leave the list, one
//! closed body closes the range, and what is cut is bisected down to single cells; these into eight parts, or four of a face, down to
//! `depth`. So the union is counted once. Each part takes over the bodies that cut its parent, the facets of them that did, and the last
//! separating axis.
//!
//! At the end of the road stands a [`Leaf`] rule: `Solid` is that of the paper, whose shares lie (δ/2)∮(|n_x|+|n_y|+|n_z|)dS too high in
//! all with δ the part's size; `Plane` bounds what is left to second order.

pub mod chord_bounds;
pub mod mesh;
pub mod place;

use crate::grid::Grid;
use crate::grid::bounds::Bounds;
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};
use crate::subdivide::chord_bounds::{Columns, MAX_PARTS};
use crate::subdivide::mesh::slab;
use crate::subdivide::place::{Body, Heights, MAX_PLANES, Near, Occupancy, Planes, Tally, Trace};

/// What becomes of a part that is still cut when the depth is spent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Leaf {
    /// Its bounds are 0 and 1. The paper takes the upper one.
    Solid,
    /// Its bounds are 0 and 1. Their middle is the value.
    Half,
    /// It is measured by support planes from outside and by points from inside.
    Plane,
}

/// How far to go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rule<R> {
    /// What ends the road.
    pub leaf: Leaf,
    /// How often a cell may be halved along each axis; not more than [`MAX_DEPTH`].
    pub depth: u32,
    /// With [`Leaf::Plane`]: stop where the bounds of a cell or face are this close.
    pub tol: R,
}

/// Deepest subdivision of a cell: parts of a hundred-thousandth of its size.
pub const MAX_DEPTH: u32 = 16;

/// What is computed: shares of cells, or of the faces normal to an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Places {
    /// Cells.
    Cells,
    /// Faces normal to axis 0, 1 or 2.
    Faces(usize),
}

/// Some cells or faces: indices `lo..hi` along each axis, counted as in [`Grid`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Range {
    /// First index along each axis.
    pub lo: [u32; 3],
    /// One past the last.
    pub hi: [u32; 3],
}

impl Range {
    /// Holds nothing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        (0..3).any(|axis| self.lo[axis] >= self.hi[axis])
    }

    fn longest(&self) -> (usize, u32) {
        let length = |axis: usize| self.hi[axis] - self.lo[axis];
        let axis =
            if length(0) >= length(1) && length(0) >= length(2) { 0 } else { 1 + usize::from(length(2) > length(1)) };
        (axis, length(axis))
    }

    /// The halves along an axis, the lower one not shorter.
    fn halves(&self, axis: usize) -> [Self; 2] {
        let middle = self.hi[axis] - (self.hi[axis] - self.lo[axis]) / 2;
        let (mut low, mut high) = (*self, *self);
        (low.hi[axis], high.lo[axis]) = (middle, middle);
        [low, high]
    }

    /// Around the cells or faces that a box touches.
    #[must_use]
    pub fn touched<V: Vector>(grid: &Grid<V::Scalar>, places: Places, bounds: &Aabb<V>) -> Self {
        let (min, max) = (bounds.min.to_array(), bounds.max.to_array());
        let mut range = Range::default();
        for axis in 0..3 {
            let edges = grid.edges(axis);
            let first = edges.partition_point(|&e| e < min[axis]);
            let last = edges.partition_point(|&e| e <= max[axis]);
            let (lo, hi) = if places == Places::Faces(axis) {
                (first, last)
            } else {
                (first.saturating_sub(1), last.min(edges.len() - 1))
            };
            (range.lo[axis], range.hi[axis]) = (lo as u32, hi as u32);
        }
        range
    }

    /// What both hold.
    #[must_use]
    pub fn common(self, other: Self) -> Self {
        let both = |f: fn(u32, u32) -> u32, a: [u32; 3], b: [u32; 3]| [f(a[0], b[0]), f(a[1], b[1]), f(a[2], b[2])];
        Range { lo: both(u32::max, self.lo, other.lo), hi: both(u32::min, self.hi, other.hi) }
    }
}

/// A body that cuts a box: which, what is known of it, and where its facets are listed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Candidate<V> {
    body: u32,
    first: u32,
    end: u32,
    trace: Trace<V>,
}

/// Caller's memory for the lists, used as stacks; contents do not matter. Where it is full a part keeps the longer list of its
/// parent, which costs work, not truth; only bodies beyond the length of `candidates` cannot be seen.
#[derive(Debug)]
pub struct Memory<'a, V> {
    /// Bodies: a multiple of their number, say 64 times.
    pub candidates: &'a mut [Candidate<V>],
    /// Facets: all of them, and as much again.
    pub facets: &'a mut [u32],
}

/// The caller's memory does not hold one list of all bodies and their facets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoRoom {
    /// Needed of candidates.
    pub candidates: usize,
    /// Needed of facets.
    pub facets: usize,
}

/// A list of candidates, and where the free memory of both stacks begins behind it.
#[derive(Clone, Copy, Debug, Default)]
struct List {
    first: usize,
    end: usize,
    facets_end: usize,
}

/// Most ranges that wait. Depth first, each bisection takes one out and puts two in; a side of less than 2³² is single after 32 bisections, so
/// that three sides allow 96 of them below each other.
pub const MAX_RANGES: usize = 3 * 32 + 1;

/// Boxes whose parts are being visited: one a level, from the cell itself at level 0 to the parents of the smallest parts.
pub const MAX_BOXES: usize = MAX_DEPTH as usize;

/// Ranges that wait to be visited, each with what its parent knows.
#[derive(Debug)]
pub struct Waiting<T> {
    items: [(Range, T); MAX_RANGES],
    count: usize,
}

impl<T: Copy> Waiting<T> {
    /// One range.
    pub fn new(range: Range, known: T) -> Self {
        Waiting { items: [(range, known); MAX_RANGES], count: 1 }
    }

    /// How many wait.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The next range.
    pub fn take(&mut self) -> Option<(Range, T)> {
        self.count = self.count.checked_sub(1)?;
        self.items.get(self.count).copied()
    }

    /// Lets both halves of a range just taken out wait, along its longest side; false if it is a single cell or face.
    pub fn bisect(&mut self, range: Range, known: T) -> bool {
        let (axis, length) = range.longest();
        if length <= 1 {
            return false;
        }
        let [low, high] = range.halves(axis);
        for half in [high, low] {
            debug_assert!(self.count < MAX_RANGES, "each bisection adds one, and a line of ranges has 96");
            if let Some(place) = self.items.get_mut(self.count) {
                *place = (half, known);
                self.count += 1;
            }
        }
        true
    }
}

/// A box whose parts are being visited.
#[derive(Clone, Copy)]
struct Parent<V> {
    cell: Aabb<V>,
    list: List,
    next: usize,
}

/// Computes the cells or faces of `range`, which must lie in the grid, and hands what is not open to `fill`: ranges all closed, or
/// single cells or faces with bounds.
///
/// # Errors
/// [`NoRoom`] if the memory does not hold a list of all bodies.
pub fn subdivide<B: Body>(
    grid: &Grid<<B::Vector as Vector>::Scalar>,
    places: Places,
    range: Range,
    bodies: &[B],
    rule: Rule<<B::Vector as Vector>::Scalar>,
    memory: &mut Memory<B::Vector>,
    fill: impl FnMut(Range, Bounds<<B::Vector as Vector>::Scalar>),
) -> Result<Tally, NoRoom> {
    let mut walk = Walk::new(bodies, rule, memory, Tally::default());
    let list = walk.all()?;
    if !range.is_empty() {
        walk.ranges(grid, places, range, list, fill);
    }
    Ok(walk.tally)
}

/// The union's share of one box, which may be a face: a box without thickness.
///
/// # Errors
/// [`NoRoom`] if the memory does not hold a list of all bodies.
pub fn share<B: Body>(
    cell: &Aabb<B::Vector>,
    bodies: &[B],
    rule: Rule<<B::Vector as Vector>::Scalar>,
    memory: &mut Memory<B::Vector>,
    tally: &mut Tally,
) -> Result<Bounds<<B::Vector as Vector>::Scalar>, NoRoom> {
    let mut walk = Walk::new(bodies, rule, memory, *tally);
    let list = walk.all()?;
    let bounds = match walk.narrow(cell, list) {
        Narrowed::Open => Bounds::OPEN,
        Narrowed::Closed => Bounds::CLOSED,
        Narrowed::Cut(list) => walk.refine(cell, list),
    };
    *tally = walk.tally;
    Ok(bounds)
}

struct Walk<'a, 'm, B: Body> {
    bodies: &'a [B],
    rule: Rule<<B::Vector as Vector>::Scalar>,
    memory: &'a mut Memory<'m, B::Vector>,
    tally: Tally,
}

/// What a box has of the bodies of its parent.
enum Narrowed {
    Open,
    Cut(List),
    Closed,
}

/// Bounds of a box, good enough or not.
enum Known<R> {
    Enough(Bounds<R>),
    Divide(Bounds<R>),
}

type Scalar<B> = <<B as Body>::Vector as Vector>::Scalar;

impl<'a, 'm, B: Body> Walk<'a, 'm, B> {
    fn new(bodies: &'a [B], rule: Rule<Scalar<B>>, memory: &'a mut Memory<'m, B::Vector>, tally: Tally) -> Self {
        Walk { bodies, rule: Rule { depth: rule.depth.min(MAX_DEPTH), ..rule }, memory, tally }
    }

    /// The list of all bodies and facets.
    fn all(&mut self) -> Result<List, NoRoom> {
        let facets = self.bodies.iter().map(Body::facets).sum();
        let needed = NoRoom { candidates: self.bodies.len(), facets };
        let Memory { candidates, facets } = &mut *self.memory;
        if candidates.len() < needed.candidates || facets.len() < needed.facets {
            return Err(needed);
        }
        let mut end = 0;
        for (n, (body, candidate)) in self.bodies.iter().zip(candidates.iter_mut()).enumerate() {
            let first = end;
            for (facet, place) in facets.iter_mut().skip(first).take(body.facets()).enumerate() {
                *place = facet as u32;
                end += 1;
            }
            *candidate = Candidate { body: n as u32, first: first as u32, end: end as u32, trace: Trace::default() };
        }
        Ok(List { first: 0, end: needed.candidates, facets_end: end })
    }

    /// The candidates of `list` that cut a box inside its own.
    #[inline]
    fn narrow(&mut self, cell: &Aabb<B::Vector>, list: List) -> Narrowed {
        let Memory { candidates, facets } = &mut *self.memory;
        let (known, free) = candidates.split_at_mut(list.end.min(candidates.len()));
        let (mut count, mut facets_end, mut overflow) = (0, list.facets_end, false);
        for candidate in known.get_mut(list.first..).unwrap_or(&mut []) {
            let Some(body) = self.bodies.get(candidate.body as usize) else { continue };
            let (listed, room) = facets.split_at_mut(facets_end.min(facets.len()));
            let near = listed.get(candidate.first as usize..candidate.end as usize).unwrap_or(&[]);
            let mut keep = Near::new(room);
            match body.place(cell, near, &mut keep, &mut candidate.trace, &mut self.tally) {
                Occupancy::Open => {}
                Occupancy::Closed => return Narrowed::Closed,
                Occupancy::Cut => {
                    let mut narrowed = *candidate;
                    if let Some(kept) = keep.kept() {
                        (narrowed.first, narrowed.end) = (facets_end as u32, (facets_end + kept) as u32);
                        facets_end += kept;
                    }
                    match free.get_mut(count) {
                        Some(place) => *place = narrowed,
                        None => overflow = true,
                    }
                    count += 1;
                }
            }
        }
        match count {
            0 => Narrowed::Open,
            _ if overflow => Narrowed::Cut(list),
            _ => Narrowed::Cut(List { first: list.end, end: list.end + count, facets_end }),
        }
    }

    /// Bisects ranges down to single cells or faces.
    fn ranges(
        &mut self,
        grid: &Grid<Scalar<B>>,
        places: Places,
        range: Range,
        list: List,
        mut fill: impl FnMut(Range, Bounds<Scalar<B>>),
    ) {
        let mut waiting = Waiting::new(range, list);
        while let Some((range, list)) = waiting.take() {
            let cell = box_of(grid, places, range);
            match self.narrow(&cell, list) {
                Narrowed::Open => {}
                Narrowed::Closed => fill(range, Bounds::CLOSED),
                Narrowed::Cut(list) => {
                    if !waiting.bisect(range, list) {
                        fill(range, self.refine(&cell, list));
                    }
                }
            }
        }
    }

    /// Bounds of a box that is cut by the bodies of `list`.
    fn refine(&mut self, cell: &Aabb<B::Vector>, list: List) -> Bounds<Scalar<B>> {
        type R<B> = Scalar<B>;
        let size = cell.size().to_array();
        let flat = size.map(|s| s == R::<B>::ZERO);
        let parts = if flat.contains(&true) { 4 } else { 8 };
        let whole = match self.leaf(cell, list, 0, parts) {
            Known::Enough(bounds) => return bounds,
            Known::Divide(bounds) => bounds,
        };
        let root = Parent { cell: *cell, list, next: 0 };
        let mut parents = [root; MAX_BOXES];
        // Shares of parts, each a power of two: their sums are exact but for the measured ones.
        let mut weights = [R::<B>::ONE; MAX_BOXES + 1];
        for level in 0..MAX_BOXES {
            weights[level + 1] = weights[level] / R::<B>::from_usize(parts);
        }
        let (mut level, mut sum) = (0, Bounds::OPEN);
        while let Some(parent) = parents.get_mut(level) {
            if parent.next == parts {
                let Some(above) = level.checked_sub(1) else { break };
                level = above;
                continue;
            }
            let (part, from) = (part_of(&parent.cell, flat, parent.next), parent.list);
            parent.next += 1;
            let inner = match self.narrow(&part, from) {
                Narrowed::Open => continue,
                Narrowed::Closed => Some(Bounds::CLOSED),
                Narrowed::Cut(list) => match self.leaf(&part, list, level as u32 + 1, parts) {
                    Known::Enough(bounds) => Some(bounds),
                    Known::Divide(_) => {
                        level += 1;
                        debug_assert!(level < MAX_BOXES);
                        if let Some(place) = parents.get_mut(level) {
                            *place = Parent { cell: part, list, next: 0 };
                        }
                        None
                    }
                },
            };
            if let Some(inner) = inner {
                let weight = weights[(level + 1).min(MAX_BOXES)];
                sum.lower += inner.lower * weight;
                sum.upper += inner.upper * weight;
            }
        }
        let sum = self.widened(sum, cell);
        Bounds { lower: sum.lower.max(whole.lower), upper: sum.upper.min(whole.upper) }
    }

    /// What is known of a box at a level without dividing it.
    fn leaf(&mut self, cell: &Aabb<B::Vector>, list: List, level: u32, parts: usize) -> Known<Scalar<B>> {
        type R<B> = Scalar<B>;
        let Rule { leaf, depth, tol } = self.rule;
        let last = level >= depth;
        let alone = list.end - list.first == 1;
        if leaf != Leaf::Plane {
            if last {
                return Known::Enough(Bounds::UNKNOWN);
            }
            let found = if alone { self.below_planes(cell, list, depth - level) } else { None };
            return found.map_or(Known::Divide(Bounds::UNKNOWN), Known::Enough);
        }
        if !(alone || last) {
            return Known::Divide(Bounds::UNKNOWN);
        }
        // Of the parts a side has, as many are cut by a surface as there are on it.
        let rows = 1_usize << level;
        let on_surface = if parts == 8 { rows * rows } else { rows };
        let spread = if level == 0 { 1 } else { 4 * on_surface };
        // A part is allowed its share of the tolerance: a share of the cell, though, so the smaller the part the more of itself.
        let enough = tol * R::<B>::from_usize(on_surface * rows) / R::<B>::from_usize(spread);
        let columns = Columns { enough, parts: (1_usize << (depth - level).min(5)).min(MAX_PARTS) };
        let (mut lower, mut upper) = (R::<B>::ZERO, R::<B>::ZERO);
        for candidate in self.memory.candidates.get(list.first..list.end).unwrap_or(&[]) {
            let Some(body) = self.bodies.get(candidate.body as usize) else { continue };
            let near = self.memory.facets.get(candidate.first as usize..candidate.end as usize).unwrap_or(&[]);
            let own = body.measure(cell, near, &columns);
            lower = lower.max(own.lower);
            upper += own.upper;
        }
        let bounds = Bounds { lower, upper: upper.min(R::<B>::ONE) };
        if last || bounds.gap() <= enough { Known::Enough(bounds) } else { Known::Divide(bounds) }
    }

    /// What the parts of a box say, halved so many times, that a single polytope cuts in few planes.
    fn below_planes(&mut self, cell: &Aabb<B::Vector>, list: List, levels: u32) -> Option<Bounds<Scalar<B>>> {
        let Memory { candidates, facets } = &*self.memory;
        let candidate = candidates.get(list.first)?;
        let near = facets.get(candidate.first as usize..candidate.end as usize)?;
        let body = self.bodies.get(candidate.body as usize)?;
        let (planes, heights) = body.planes(cell, near)?;
        let flat = cell.size().to_array().map(|s| s == Real::ZERO);
        let mut parts = Parts { body, near, planes, flat, tally: &mut self.tally };
        Some(parts.share(cell, &heights, levels, Real::HALF))
    }

    /// Room for the rounding of the planes between parts, and of sums.
    fn widened(&self, bounds: Bounds<Scalar<B>>, cell: &Aabb<B::Vector>) -> Bounds<Scalar<B>> {
        type R<B> = Scalar<B>;
        let (zero, one) = (R::<B>::ZERO, R::<B>::ONE);
        if bounds == Bounds::OPEN || bounds == Bounds::CLOSED {
            return bounds;
        }
        let (size, far) = (cell.size().to_array(), cell.min.abs().max(cell.max.abs()).to_array());
        let mut reach = one;
        for axis in 0..3 {
            if size[axis] > zero {
                reach += far[axis] / size[axis];
            }
        }
        let rows = R::<B>::from_usize(1 << self.rule.depth);
        let room = reach * rows * R::<B>::EPSILON * R::<B>::TWO;
        Bounds { lower: (bounds.lower - room).max(zero), upper: (bounds.upper + room).min(one) }
    }
}

/// How far the box of several planes of faces reaches beyond them, as a share of its thickness.
const OVERHANG: f64 = 1.0 / 1024.0;

/// A polytope and its planes near a box whose parts are asked for.
struct Parts<'a, B: Body> {
    body: &'a B,
    near: &'a [u32],
    planes: Planes<Scalar<B>>,
    flat: [bool; 3],
    tally: &'a mut Tally,
}

impl<B: Body> Parts<'_, B> {
    /// The bounds of a part of the box from its own parts, of which `scale` is the size. Nests no deeper than [`MAX_DEPTH`].
    fn share(
        &mut self,
        cell: &Aabb<B::Vector>,
        heights: &Heights<Scalar<B>>,
        levels: u32,
        scale: Scalar<B>,
    ) -> Bounds<Scalar<B>> {
        let count = 1_usize << self.flat.iter().filter(|&&flat| !flat).count();
        let mut sum: Bounds<Scalar<B>> = Bounds::OPEN;
        for number in 0..count {
            let (found, part) = self.planes.part(heights, shift_of(self.flat, number, scale), scale);
            let share = match found {
                Some(Occupancy::Open) => continue,
                Some(Occupancy::Closed) => Bounds::CLOSED,
                _ if levels > 1 => self.share(&part_of(cell, self.flat, number), &part, levels - 1, scale * Real::HALF),
                Some(Occupancy::Cut) => Bounds::UNKNOWN,
                None => self.ask(&part_of(cell, self.flat, number)),
            };
            sum.lower += share.lower;
            sum.upper += share.upper;
        }
        let weight = Scalar::<B>::ONE / Real::from_usize(count);
        Bounds { lower: sum.lower * weight, upper: sum.upper * weight }
    }

    /// Planes cut the part, but perhaps not together.
    #[cold]
    fn ask(&mut self, part: &Aabb<B::Vector>) -> Bounds<Scalar<B>> {
        let mut room = [0; MAX_PLANES];
        let mut trace = Trace::default();
        match self.body.place(part, self.near, &mut Near::new(&mut room), &mut trace, self.tally) {
            Occupancy::Open => Bounds::OPEN,
            Occupancy::Cut => Bounds::UNKNOWN,
            Occupancy::Closed => Bounds::CLOSED,
        }
    }
}

/// From the middle of a box to that of a part, in half sizes of the whole.
#[inline(always)]
fn shift_of<R: Real>(flat: [bool; 3], number: usize, scale: R) -> [R; 3] {
    let mut bits = number;
    flat.map(|flat| {
        if flat {
            return R::ZERO;
        }
        let upper = bits & 1 == 1;
        bits >>= 1;
        if upper { scale } else { -scale }
    })
}

/// The box around a range of cells or faces. Around faces of several planes it is a little thicker: a body that only touches the outermost
/// plane shares no volume with the box, and yet may block faces there.
fn box_of<V: Vector>(grid: &Grid<V::Scalar>, places: Places, range: Range) -> Aabb<V> {
    let edge = |axis: usize, index: u32| grid.edges(axis).get(index as usize).copied().unwrap_or(V::Scalar::INFINITY);
    let (mut min, mut max) = ([V::Scalar::ZERO; 3], [V::Scalar::ZERO; 3]);
    for axis in 0..3 {
        min[axis] = edge(axis, range.lo[axis]);
        max[axis] = edge(axis, range.hi[axis] - u32::from(places == Places::Faces(axis)));
    }
    let exact = Aabb { min: V::from_array(min), max: V::from_array(max) };
    let Places::Faces(axis) = places else { return exact };
    if max[axis] > min[axis] {
        let room = (max[axis] - min[axis]) * V::Scalar::from_f64(OVERHANG) + slab(&exact);
        (min[axis], max[axis]) = (min[axis] - room, max[axis] + room);
    }
    Aabb { min: V::from_array(min), max: V::from_array(max) }
}

/// A part of a box: the bits of its number choose the upper halves along the axes that are not flat.
#[inline(always)]
fn part_of<V: Vector>(cell: &Aabb<V>, flat: [bool; 3], number: usize) -> Aabb<V> {
    let mut bits = number;
    let upper = flat.map(|flat| {
        let upper = !flat && bits & 1 == 1;
        bits >>= u32::from(!flat);
        upper
    });
    // Without arrays in between: written by scalars and read as vectors at once they would stall the processor.
    let (min, max, middle) = (cell.min, cell.max, cell.center());
    let low = |axis: usize, min: V::Scalar, middle: V::Scalar| if upper[axis] { middle } else { min };
    let high = |axis: usize, max: V::Scalar, middle: V::Scalar| if upper[axis] || flat[axis] { max } else { middle };
    Aabb {
        min: V::new(low(0, min.x(), middle.x()), low(1, min.y(), middle.y()), low(2, min.z(), middle.z())),
        max: V::new(high(0, max.x(), middle.x()), high(1, max.y(), middle.y()), high(2, max.z(), middle.z())),
    }
}
