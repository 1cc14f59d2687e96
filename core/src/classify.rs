//! Where a cell, or a face, lies to a convex body: open, cut or closed, with proof.
//!
//! A face is a box without thickness. A point of a face is blocked if it is a limit of solid from either side; of one convex body that
//! is the area of its section with the face's plane, boundary included.

use crate::aabb::Aabb;
use crate::columns::{Bounds, Columns};
use crate::convex::{Convex, rounding};
use crate::exact::Contact;
use crate::gjk::{Intersection, intersect};
use crate::real::{Real, Vector};

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
    fn push(&mut self, facet: u32) {
        match self.items.get_mut(self.count) {
            Some(place) => *place = facet,
            None => self.full = true,
        }
        self.count += 1;
    }

    #[inline(always)]
    fn items(&self) -> &[u32] {
        self.items.get(..self.count).unwrap_or(&[])
    }
}

/// A body as the subdivision sees it.
pub trait Body {
    /// The vectors of the space.
    type Vector: Vector;

    /// A box around it.
    fn bounds(&self) -> Aabb<Self::Vector>;

    /// How many facets it has.
    fn facets(&self) -> usize;

    /// Where a box lies. `near` lists the facets that cut a box around this one; those that cut this one go to `keep`. `axis` is a
    /// direction that separated a neighbour, or zero; a better one replaces it.
    fn place(
        &self,
        cell: &Aabb<Self::Vector>,
        near: &[u32],
        keep: &mut Near,
        axis: &mut Self::Vector,
        tally: &mut Tally,
    ) -> Occupancy;

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
        axis: &mut B::Vector,
        tally: &mut Tally,
    ) -> Occupancy {
        let zero = Real::ZERO;
        let margin = (rounding(self) + rounding(cell)) * Real::HALF;
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
                _ if deepest_corner_is_inside(self, cell, keep.items(), margin) => return Occupancy::Cut,
                _ => {}
            }
        }
        tally.queries += 1;
        match intersect(cell, self, Some(*axis)) {
            Intersection::Apart { axis: found } => {
                *axis = found;
                return Occupancy::Open;
            }
            Intersection::Undecided { .. } => {
                let flat = cell.size().to_array().contains(&zero);
                if !flat && matches!(self.settled(cell), Some(Contact::Disjoint | Contact::Touching)) {
                    return Occupancy::Open;
                }
                tally.undecided += 1;
            }
            Intersection::Overlapping { .. } => {}
        }
        if !self.is_polytope() && edges_are_inside(self, cell) { Occupancy::Closed } else { Occupancy::Cut }
    }

    #[inline]
    fn measure(
        &self,
        cell: &Aabb<B::Vector>,
        near: &[u32],
        columns: &Columns<crate::support::ScalarOf<B>>,
    ) -> Bounds<crate::support::ScalarOf<B>> {
        columns.measure(self, cell, near)
    }
}

/// The corner farthest inward of the facets taken together lies inside all of them: then the interiors meet.
#[inline(always)]
fn deepest_corner_is_inside<B: Convex>(
    body: &B,
    cell: &Aabb<B::Vector>,
    near: &[u32],
    margin: crate::support::ScalarOf<B>,
) -> bool {
    let outward = near.iter().fold(B::Vector::ZERO, |sum, &id| sum + body.facet(id as usize).normal);
    let corner = crate::support::Support::support(cell, -outward, 0).point;
    near.iter().all(|&id| {
        let plane = body.facet(id as usize);
        corner.dot(plane.normal) - plane.offset < -margin
    })
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
