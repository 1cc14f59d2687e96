//! Where a cell, or a face, lies to a convex body: open, cut or closed, with proof.
//!
//! A face is a box without thickness. A point of a face is blocked if it is a limit of solid from either side; of one convex body that
//! is the area of its section with the face's plane, boundary included.

use crate::convex::chord::{Convex, rounded, rounding};
use crate::convex::exact::Contact;
use crate::convex::gjk::{Intersection, intersect};
use crate::grid::bounds::Bounds;
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};
use crate::subdivide::chord_bounds::Columns;

/// How a box lies to a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Occupancy {
    /// What they share has no volume, or of a face no area.
    Open,
    /// Neither of the others, or not known.
    Cut,
    /// Every point of the box belongs to the body.
    Closed,
}

/// How often GJK was asked, and how often it could not tell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Queries.
    pub queries: u64,
    /// Of these, undecided: counted as cut.
    pub undecided: u64,
}

/// The facets that cut a box, written into the caller's memory.
#[derive(Debug)]
pub struct Near<'a> {
    items: &'a mut [u32],
    count: usize,
    full: bool,
}

impl<'a> Near<'a> {
    /// Nothing yet.
    pub fn new(items: &'a mut [u32]) -> Self {
        Near { items, count: 0, full: false }
    }

    /// How many facets were kept; none if there was no room for all.
    pub fn kept(&self) -> Option<usize> {
        (!self.full).then_some(self.count)
    }

    #[inline(always)]
    pub(crate) fn push(&mut self, facet: u32) {
        match self.items.get_mut(self.count) {
            Some(place) => *place = facet,
            None => self.full = true,
        }
        self.count += 1;
    }

    /// Drops facets; not if there was no room for all.
    #[inline(always)]
    fn retain(&mut self, wanted: impl Fn(u32) -> bool) {
        let mut kept = 0;
        let Some(items) = self.items.get_mut(..self.count) else { return };
        for n in 0..items.len() {
            if wanted(items[n]) {
                items[kept] = items[n];
                kept += 1;
            }
        }
        self.count = kept;
    }

    #[inline(always)]
    fn items(&self) -> &[u32] {
        self.items.get(..self.count).unwrap_or(&[])
    }
}

/// Most planes that [`Planes`] holds.
pub const MAX_PLANES: usize = 8;

/// A polytope as its planes near a box, each seen from the middle of it. Where a part of the box lies is then a few additions.
#[derive(Clone, Copy, Debug)]
pub struct Planes<R> {
    /// How far the box reaches along each plane's normal, by axis and with the normal's signs.
    reach: [[R; 3]; MAX_PLANES],
    /// The sum of these without signs.
    whole: [R; MAX_PLANES],
    /// Rounding of heights.
    margin: R,
}

/// Heights of a box's middle above planes, and a bit for each plane that cuts the box.
#[derive(Clone, Copy, Debug)]
pub struct Heights<R> {
    middle: [R; MAX_PLANES],
    cut: u8,
}

impl<R: Real> Planes<R> {
    /// Where a part of the box lies, `scale` times as large and its middle `shift` times the box's half size away from that of its parent,
    /// by axis. None if planes cut it, but perhaps not together.
    #[inline(always)]
    pub fn part(&self, parent: &Heights<R>, shift: [R; 3], scale: R) -> (Option<Occupancy>, Heights<R>) {
        let mut part = Heights { middle: parent.middle, cut: 0 };
        for n in (0..MAX_PLANES).filter(|n| parent.cut >> n & 1 == 1) {
            let [x, y, z] = self.reach[n];
            let middle = parent.middle[n] + (x * shift[0] + y * shift[1] + z * shift[2]);
            let reach = self.whole[n] * scale;
            if middle - reach >= self.margin {
                return (Some(Occupancy::Open), part);
            }
            if !(middle + reach <= -self.margin) {
                part.cut |= 1 << n;
                part.middle[n] = middle;
            }
        }
        let found = match part.cut.count_ones() {
            0 => Some(Occupancy::Closed),
            1 => Some(Occupancy::Cut),
            _ => self.meets(&part, scale).then_some(Occupancy::Cut),
        };
        (found, part)
    }

    /// The corner farthest inward of the cutting planes taken together lies inside all of them: then interiors meet.
    #[inline(always)]
    fn meets(&self, part: &Heights<R>, scale: R) -> bool {
        let cutting = || (0..MAX_PLANES).filter(|n| part.cut >> n & 1 == 1);
        let sum = cutting().fold([R::ZERO; 3], |s, n| [0, 1, 2].map(|axis| s[axis] + self.reach[n][axis]));
        let inward = sum.map(|s| -scale.copysign(s));
        cutting().all(|n| {
            let [x, y, z] = self.reach[n];
            part.middle[n] + (x * inward[0] + y * inward[1] + z * inward[2]) < -self.margin
        })
    }
}

/// What a box knows of a body and hands to its parts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Trace<V> {
    /// Of a convex body a direction that separated a neighbour, or zero; of a surface a point in the box.
    pub vector: V,
    /// The surface's winding number at that point, if it is known.
    pub winding: Option<i32>,
}

/// Planes and the heights of a box above them.
pub type Seen<R> = (Planes<R>, Heights<R>);

/// A body as the subdivision sees it.
pub trait Body {
    /// The vectors of the space.
    type Vector: Vector;

    /// A box around it.
    fn bounds(&self) -> Aabb<Self::Vector>;

    /// How many facets it has.
    fn facets(&self) -> usize;

    /// Where a box lies. `near` lists the facets that cut a box around this one; those that cut this one go to `keep`. `trace` is what is
    /// known from the box around or from a neighbour in it; what is found here replaces it.
    fn place(
        &self,
        cell: &Aabb<Self::Vector>,
        near: &[u32],
        keep: &mut Near,
        trace: &mut Trace<Self::Vector>,
        tally: &mut Tally,
    ) -> Occupancy;

    /// The planes near a box, if the body is a polytope and they are not too many; and the box's heights above them.
    fn planes(&self, cell: &Aabb<Self::Vector>, near: &[u32]) -> Option<Seen<<Self::Vector as Vector>::Scalar>>;

    /// Bounds of the share of a box that is solid; `near` as [`Body::place`] kept it.
    fn measure(
        &self,
        cell: &Aabb<Self::Vector>,
        near: &[u32],
        columns: &Columns<<Self::Vector as Vector>::Scalar>,
    ) -> Bounds<<Self::Vector as Vector>::Scalar>;
}

impl<B: Convex> Body for B {
    type Vector = B::Vector;

    fn bounds(&self) -> Aabb<B::Vector> {
        Convex::bounds(self)
    }

    fn facets(&self) -> usize {
        Convex::facets(self)
    }

    #[inline]
    fn place(
        &self,
        cell: &Aabb<B::Vector>,
        near: &[u32],
        keep: &mut Near,
        trace: &mut Trace<B::Vector>,
        tally: &mut Tally,
    ) -> Occupancy {
        if self.misses(cell) {
            return Occupancy::Open;
        }
        let zero = Real::ZERO;
        let far = cell.min.abs().max(cell.max.abs()).norm_max();
        let margin = (rounding(self) + rounded(far)) * Real::HALF;
        for &id in near {
            let plane = self.facet(id as usize);
            let [low, high] = plane.range(cell);
            let margin = if plane.exact { zero } else { margin };
            // A face in the plane of a facet lies beyond nothing.
            if low >= margin && high > margin {
                return Occupancy::Open;
            }
            if !(high <= -margin) {
                keep.push(id);
            }
        }
        if self.is_polytope() {
            match keep.count {
                0 => return Occupancy::Closed,
                1 => return Occupancy::Cut,
                _ if holds_inner_point(self, cell, keep.items(), margin) => {
                    let room = B::Vector::splat(margin + margin);
                    let around = Aabb { min: cell.min - room, max: cell.max + room };
                    keep.retain(|id| self.facet_bounds(id as usize).is_none_or(|b| b.touches(around)));
                    return if keep.count == 0 { Occupancy::Closed } else { Occupancy::Cut };
                }
                _ => {}
            }
        } else if let Some(found) = by_height(self, cell, margin, &mut trace.vector) {
            return found;
        }
        ask(self, cell, &mut trace.vector, tally)
    }

    fn planes(&self, cell: &Aabb<B::Vector>, near: &[u32]) -> Option<Seen<crate::convex::support::ScalarOf<B>>> {
        if !self.is_polytope() || near.len() > MAX_PLANES {
            return None;
        }
        let zero: crate::convex::support::ScalarOf<B> = Real::ZERO;
        let far = cell.min.abs().max(cell.max.abs()).norm_max();
        let margin = (rounding(self) + rounded(far)) * Real::HALF;
        let mut planes = Planes { reach: [[zero; 3]; MAX_PLANES], whole: [zero; MAX_PLANES], margin };
        let mut heights = Heights { middle: [zero; MAX_PLANES], cut: 0 };
        for (n, &id) in near.iter().enumerate() {
            let plane = self.facet(id as usize);
            // Whether a face lies in an exact plane must be seen exactly.
            if plane.exact {
                return None;
            }
            let (normal, size) = (plane.normal.to_array(), cell.size().to_array());
            planes.reach[n] = [0, 1, 2].map(|axis| normal[axis] * size[axis] * Real::HALF);
            planes.whole[n] = plane.normal.abs().dot(cell.size()) * Real::HALF;
            heights.middle[n] = cell.center().dot(plane.normal) - plane.offset;
            heights.cut |= 1 << n;
        }
        Some((planes, heights))
    }

    #[inline]
    fn measure(
        &self,
        cell: &Aabb<B::Vector>,
        near: &[u32],
        columns: &Columns<crate::convex::support::ScalarOf<B>>,
    ) -> Bounds<crate::convex::support::ScalarOf<B>> {
        columns.measure(self, cell, near)
    }
}

/// What GJK says, and for bodies that are no polytopes, chords.
#[inline(never)]
fn ask<B: Convex>(body: &B, cell: &Aabb<B::Vector>, axis: &mut B::Vector, tally: &mut Tally) -> Occupancy {
    tally.queries += 1;
    match intersect(cell, body, Some(*axis)) {
        Intersection::Apart { axis: found } => {
            *axis = found;
            return Occupancy::Open;
        }
        Intersection::Undecided { .. } => {
            let flat = cell.size().to_array().contains(&Real::ZERO);
            if !flat && matches!(body.settled(cell), Some(Contact::Disjoint | Contact::Touching)) {
                return Occupancy::Open;
            }
            tally.undecided += 1;
        }
        Intersection::Overlapping { .. } => {}
    }
    if !body.is_polytope() && edges_are_inside(body, cell) { Occupancy::Closed } else { Occupancy::Cut }
}

/// Some point of the box lies inside all of the facets, and not in their rounding: the nearest to the body's centre, or the corner farthest
/// inward of the facets taken together. Then the interiors meet.
#[inline(always)]
fn holds_inner_point<B: Convex>(
    body: &B,
    cell: &Aabb<B::Vector>,
    near: &[u32],
    margin: crate::convex::support::ScalarOf<B>,
) -> bool {
    let is_inside = |point: B::Vector| {
        near.iter().all(|&id| {
            let plane = body.facet(id as usize);
            point.dot(plane.normal) - plane.offset < -margin
        })
    };
    if near.is_empty() {
        return false;
    }
    is_inside(body.center().max(cell.min).min(cell.max)) || {
        let outward = near.iter().fold(B::Vector::ZERO, |sum, &id| sum + body.facet(id as usize).normal);
        is_inside(crate::convex::support::Support::support(cell, -outward, 0).point)
    }
}

/// What the height of a box's middle tells: the box is smaller, or surface must cut it. If nothing, `axis` becomes a direction that may
/// separate.
#[inline(always)]
fn by_height<B: Convex>(
    body: &B,
    cell: &Aabb<B::Vector>,
    margin: crate::convex::support::ScalarOf<B>,
    axis: &mut B::Vector,
) -> Option<Occupancy> {
    let (half, middle) = (cell.size() * Real::HALF, cell.center());
    let [low, high] = body.height(middle);
    let reach = half.dot(half).sqrt() + margin;
    if low >= reach {
        return Some(Occupancy::Open);
    }
    if high < -margin {
        // The middle is an inner point.
        let closed = high <= -reach || edges_are_inside(body, cell);
        return Some(if closed { Occupancy::Closed } else { Occupancy::Cut });
    }
    let to = body.nearest(middle).filter(|_| low > margin)? - middle;
    let inner = half - B::Vector::splat(margin + margin);
    if to.abs().max(inner) == inner {
        return Some(Occupancy::Cut);
    }
    *axis = to;
    None
}

/// The edges of a box along one axis, and so all of it, are inside the body.
#[inline(always)]
fn edges_are_inside<B: Convex>(body: &B, cell: &Aabb<B::Vector>) -> bool {
    let zero = Real::ZERO;
    let (size, lo, hi) = (cell.size().to_array(), cell.min.to_array(), cell.max.to_array());
    let along = usize::from(size[0] == zero);
    let (u, v) = ((along + 1) % 3, (along + 2) % 3);
    let mut direction = [zero; 3];
    direction[along] = Real::ONE;
    let shrink = -rounding(body);
    let center = body.center().to_array();
    // The far corner is the likeliest to be outside.
    let far = |axis: usize, other: bool| {
        if (hi[axis] + lo[axis] > center[axis] + center[axis]) != other { hi[axis] } else { lo[axis] }
    };
    [(false, false), (false, true), (true, false), (true, true)].into_iter().all(|(other_u, other_v)| {
        let mut origin = [zero; 3];
        (origin[u], origin[v]) = (far(u, other_u), far(v, other_v));
        body.chord(Vector::from_array(origin), Vector::from_array(direction), shrink, &[])
            .is_some_and(|[t0, t1]| t0 <= lo[along] && t1 >= hi[along])
    })
}
