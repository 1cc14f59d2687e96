//! The walk itself: which bodies cut a box, when to stop, and the sums over parts.

use heapless::Vec;

use super::chord_bounds::{Columns, MAX_PARTS};
use super::memory::{Candidate, CandidateList, SubdivisionMemory, TooLittleMemory};
use super::mesh::slab_margin;
use super::occupancy::{ActiveFacets, Occupancy, QueryCount, WarmStart};
use super::parts::{PolytopeParts, flat_axes, part_of};
use super::place::{BodyScalar, Subdividable};
use super::range_stack::RangeStack;
use super::rule::{LeafRule, MAX_DEPTH, SubdivisionRule};
use crate::grid::Grid;
use crate::grid::bounds::Bounds;
use crate::grid::cell_range::{CellRange, RangeKind};
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};

/// Most boxes that are being divided at once: one a level, from the cell itself at level 0 to the parents of the smallest parts.
const MAX_BOXES: usize = MAX_DEPTH as usize;

/// A box that is being divided.
struct Parent<V: Vector> {
    cell: Aabb<V>,
    /// The bodies that cut it.
    list: CandidateList,
    /// Number of the part to visit next.
    next: usize,
    /// The share that one part has of the cell: a power of two.
    weight: V::Scalar,
}

/// What remains of the bodies in a part of a box.
pub(super) enum Filtered {
    /// No body reaches the part.
    Open,
    /// These bodies cut it.
    Cut(CandidateList),
    /// A body holds all of it.
    Closed,
}

/// Bounds of a box's solid share, and whether they will do.
enum LeafBounds<R> {
    /// They are close enough, or the depth is spent.
    Accept(Bounds<R>),
    /// The box is to be divided.
    Split(Bounds<R>),
}

/// One call of the subdivision: the bodies, the rule, and the caller's memory.
pub(super) struct Subdivision<'a, 'm, B: Subdividable> {
    bodies: &'a [B],
    rule: SubdivisionRule<BodyScalar<B>>,
    memory: &'a mut SubdivisionMemory<'m, B::Vector>,
    pub count: QueryCount,
}

impl<'a, 'm, B: Subdividable> Subdivision<'a, 'm, B> {
    pub fn new(
        bodies: &'a [B],
        rule: SubdivisionRule<BodyScalar<B>>,
        memory: &'a mut SubdivisionMemory<'m, B::Vector>,
        count: QueryCount,
    ) -> Self {
        let rule = SubdivisionRule { depth: rule.depth.min(MAX_DEPTH), ..rule };
        Subdivision { bodies, rule, memory, count }
    }

    /// The list of all bodies with all their facets.
    pub fn all_candidates(&mut self) -> Result<CandidateList, TooLittleMemory> {
        let facets = self.bodies.iter().map(Subdividable::facet_count).sum();
        let needed = TooLittleMemory { candidates: self.bodies.len(), facets };
        let SubdivisionMemory { candidates, facets } = &mut *self.memory;
        if candidates.len() < needed.candidates || facets.len() < needed.facets {
            return Err(needed);
        }
        let mut end = 0;
        for (n, (body, candidate)) in self.bodies.iter().zip(candidates.iter_mut()).enumerate() {
            let first = end;
            for (facet, place) in facets.iter_mut().skip(first).take(body.facet_count()).enumerate() {
                *place = facet as u32;
                end += 1;
            }
            let (first, end) = (first as u32, end as u32);
            *candidate = Candidate { body: n as u32, first, end, warm: WarmStart::default() };
        }
        Ok(CandidateList { first: 0, end: needed.candidates, facets_end: end })
    }

    /// The candidates of `list` that cut `cell`, a box inside theirs. They are written behind `list`; where the memory is full the part
    /// keeps `list` itself.
    #[inline]
    pub fn filter(&mut self, cell: &Aabb<B::Vector>, list: CandidateList) -> Filtered {
        let SubdivisionMemory { candidates, facets } = &mut *self.memory;
        let (known, free) = candidates.split_at_mut(list.end.min(candidates.len()));
        let (mut count, mut facets_end, mut overflow) = (0, list.facets_end, false);
        for candidate in known.get_mut(list.first..).unwrap_or(&mut []) {
            let Some(body) = self.bodies.get(candidate.body as usize) else { continue };
            let (listed, unused) = facets.split_at_mut(facets_end.min(facets.len()));
            let near = listed.get(candidate.first as usize..candidate.end as usize).unwrap_or(&[]);
            let mut active = ActiveFacets::new(unused);
            match body.occupancy(cell, near, &mut active, &mut candidate.warm, &mut self.count) {
                Occupancy::Open => {}
                Occupancy::Closed => return Filtered::Closed,
                Occupancy::Cut => {
                    let mut narrowed = *candidate;
                    if let Some(listed) = active.listed() {
                        (narrowed.first, narrowed.end) = (facets_end as u32, (facets_end + listed) as u32);
                        facets_end += listed;
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
            0 => Filtered::Open,
            _ if overflow => Filtered::Cut(list),
            _ => Filtered::Cut(CandidateList { first: list.end, end: list.end + count, facets_end }),
        }
    }

    /// Bisects a range down to single cells or faces, and hands what is not open to `fill`.
    pub fn visit(
        &mut self,
        grid: &Grid<BodyScalar<B>>,
        kind: RangeKind,
        range: CellRange,
        list: CandidateList,
        mut fill: impl FnMut(CellRange, Bounds<BodyScalar<B>>),
    ) {
        let mut stack = RangeStack::new(range, list);
        while let Some((range, list)) = stack.pop() {
            let cell = box_of(grid, kind, range);
            match self.filter(&cell, list) {
                Filtered::Open => {}
                Filtered::Closed => fill(range, Bounds::CLOSED),
                Filtered::Cut(list) => {
                    if !stack.push_halves(range, list) {
                        fill(range, self.refine(&cell, list));
                    }
                }
            }
        }
    }

    /// Bounds of the solid share of a box that the bodies of `list` cut.
    pub fn refine(&mut self, cell: &Aabb<B::Vector>, list: CandidateList) -> Bounds<BodyScalar<B>> {
        let flat = flat_axes(cell);
        let parts = if flat.contains(&true) { 4 } else { 8 };
        let whole = match self.leaf(cell, list, 0) {
            LeafBounds::Accept(bounds) => return bounds,
            LeafBounds::Split(bounds) => bounds,
        };
        let sum = self.sum_of_parts(cell, list, flat, parts);
        let sum = self.widened(sum, cell);
        Bounds { lower: sum.lower.max(whole.lower), upper: sum.upper.min(whole.upper) }
    }

    /// Divides a box, depth first, until the rule accepts the bounds of every part; their sum, each weighed by its share of the box. Weights
    /// are powers of two, so that only sums of measured parts are rounded.
    fn sum_of_parts(
        &mut self,
        cell: &Aabb<B::Vector>,
        list: CandidateList,
        flat: [bool; 3],
        parts: usize,
    ) -> Bounds<BodyScalar<B>> {
        let one_part = BodyScalar::<B>::ONE / Real::from_usize(parts);
        let mut parents: Vec<Parent<B::Vector>, MAX_BOXES> = Vec::new();
        let mut sum = Bounds::OPEN;
        let mut divided = Some(Parent { cell: *cell, list, next: 0, weight: one_part });
        loop {
            if let Some(parent) = divided.take() {
                let pushed = parents.push(parent).is_ok();
                debug_assert!(pushed, "a box is divided at most MAX_DEPTH times");
            }
            let level = parents.len() as u32;
            let Some(parent) = parents.last_mut() else { return sum };
            if parent.next == parts {
                parents.pop();
                continue;
            }
            let part = part_of(&parent.cell, flat, parent.next);
            parent.next += 1;
            let (list, weight) = (parent.list, parent.weight);
            let share = match self.filter(&part, list) {
                Filtered::Open => continue,
                Filtered::Closed => Bounds::CLOSED,
                Filtered::Cut(list) => match self.leaf(&part, list, level) {
                    LeafBounds::Accept(bounds) => bounds,
                    LeafBounds::Split(_) => {
                        divided = Some(Parent { cell: part, list, next: 0, weight: weight * one_part });
                        continue;
                    }
                },
            };
            sum.lower += share.lower * weight;
            sum.upper += share.upper * weight;
        }
    }

    /// Bounds of the share of a box at a level without dividing it.
    fn leaf(&mut self, cell: &Aabb<B::Vector>, list: CandidateList, level: u32) -> LeafBounds<BodyScalar<B>> {
        let SubdivisionRule { leaf, depth, tol } = self.rule;
        let last = level >= depth;
        let alone = list.end - list.first == 1;
        if leaf != LeafRule::Plane {
            if last {
                return LeafBounds::Accept(Bounds::UNKNOWN);
            }
            let found = if alone { self.by_planes(cell, list, depth - level) } else { None };
            return found.map_or(LeafBounds::Split(Bounds::UNKNOWN), LeafBounds::Accept);
        }
        if !(alone || last) {
            return LeafBounds::Split(Bounds::UNKNOWN);
        }
        let enough = allowance(tol, level);
        let columns = Columns { enough, parts: (1_usize << depth.saturating_sub(level).min(5)).min(MAX_PARTS) };
        let bounds = self.measured(cell, list, &columns);
        if last || bounds.gap() <= enough { LeafBounds::Accept(bounds) } else { LeafBounds::Split(bounds) }
    }

    /// Bounds of the share that the union of the bodies of `list` has of a box: the largest of their shares, and their sum.
    fn measured(
        &self,
        cell: &Aabb<B::Vector>,
        list: CandidateList,
        columns: &Columns<BodyScalar<B>>,
    ) -> Bounds<BodyScalar<B>> {
        let (mut lower, mut upper) = (BodyScalar::<B>::ZERO, BodyScalar::<B>::ZERO);
        for candidate in self.memory.candidates.get(list.first..list.end).unwrap_or(&[]) {
            let Some(body) = self.bodies.get(candidate.body as usize) else { continue };
            let near = self.memory.facets.get(candidate.first as usize..candidate.end as usize).unwrap_or(&[]);
            let own = body.share_bounds(cell, near, columns);
            lower = lower.max(own.lower);
            upper += own.upper;
        }
        Bounds { lower, upper: upper.min(BodyScalar::<B>::ONE) }
    }

    /// Bounds from the parts of a box halved `levels` times, if a single polytope cuts it with few planes.
    fn by_planes(&mut self, cell: &Aabb<B::Vector>, list: CandidateList, levels: u32) -> Option<Bounds<BodyScalar<B>>> {
        let SubdivisionMemory { candidates, facets } = &*self.memory;
        let candidate = candidates.get(list.first)?;
        let near = facets.get(candidate.first as usize..candidate.end as usize)?;
        let body = self.bodies.get(candidate.body as usize)?;
        let planes = body.local_planes(cell, near)?;
        let distances = planes.distances;
        let mut parts = PolytopeParts { body, near, planes, flat: flat_axes(cell), count: &mut self.count };
        Some(parts.share(cell, &distances, levels, Real::HALF))
    }

    /// Bounds widened by the rounding of the planes between parts (one of the coordinates a level) and of the weighted sum.
    fn widened(&self, bounds: Bounds<BodyScalar<B>>, cell: &Aabb<B::Vector>) -> Bounds<BodyScalar<B>> {
        type R<B> = BodyScalar<B>;
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
        let margin = reach * rows * R::<B>::EPSILON * R::<B>::TWO;
        Bounds { lower: (bounds.lower - margin).max(zero), upper: (bounds.upper + margin).min(one) }
    }
}

/// How far the bounds of a part at some level may be apart, as a share of the part, so that those of the cell are at most `tol` apart: `tol` for
/// the cell itself. Below, a smooth surface cuts only one of the `rows` parts along each line, so a part may be off by `rows` times as much;
/// a quarter of that is allowed, as surfaces are not smooth.
fn allowance<R: Real>(tol: R, level: u32) -> R {
    let rows = R::from_usize(1 << level.min(MAX_DEPTH));
    if level == 0 { tol } else { tol * rows * R::from_f64(0.25) }
}

/// How far the box of several planes of faces reaches beyond them, as a share of its thickness.
const OVERHANG: f64 = 1.0 / 1024.0;

/// The box around a range of cells or faces. Around faces of several planes it is a little thicker: a body that only touches the outermost
/// plane shares no volume with the exact box, and yet may block faces in that plane.
fn box_of<V: Vector>(grid: &Grid<V::Scalar>, kind: RangeKind, range: CellRange) -> Aabb<V> {
    let edge = |axis: usize, index: u32| grid.edges(axis).get(index as usize).copied().unwrap_or(V::Scalar::INFINITY);
    let normal_to = |axis: usize| kind == RangeKind::Faces(axis);
    let (mut min, mut max) = ([V::Scalar::ZERO; 3], [V::Scalar::ZERO; 3]);
    for axis in 0..3 {
        min[axis] = edge(axis, range.lo[axis]);
        max[axis] = edge(axis, range.hi[axis].saturating_sub(u32::from(normal_to(axis))));
    }
    let exact = Aabb { min: V::from_array(min), max: V::from_array(max) };
    let Some(axis) = (0..3).find(|&axis| normal_to(axis) && max[axis] > min[axis]) else { return exact };
    let margin = (max[axis] - min[axis]) * V::Scalar::from_f64(OVERHANG) + slab_margin(&exact);
    (min[axis], max[axis]) = (min[axis] - margin, max[axis] + margin);
    Aabb { min: V::from_array(min), max: V::from_array(max) }
}
