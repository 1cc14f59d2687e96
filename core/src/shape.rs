//! Convex bodies: point, segment, triangle, boxes, sphere, ellipsoid, capsule, cylinder, cone, hull.
//!
//! Each is a [`Support`] mapping. Bodies given by vertices ([`Vertices`]) are exact: their support points are the vertices themselves.
//! The others say by [`Support::slack`] how far rounding may have moved a point.

use crate::aabb::Aabb;
use crate::real::{Real, Vector};
use crate::support::{Rounded, ScalarOf, Support, SupportPoint, magnitude};

/// A body that is the hull of finitely many points, each exactly representable.
pub trait Vertices: Support {
    /// How many points; some may be repeated or lie inside.
    fn count(&self) -> usize;
    /// The point of an index below [`Vertices::count`]; the last one above it.
    fn vertex(&self, index: usize) -> Self::Vector;
}

impl<S: Vertices> Vertices for &S {
    fn count(&self) -> usize {
        (**self).count()
    }
    fn vertex(&self, index: usize) -> S::Vector {
        (**self).vertex(index)
    }
}

#[inline(always)]
fn only<V>(point: V) -> SupportPoint<V> {
    SupportPoint { point, index: 0 }
}

/// A single point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point<V>(pub V);

impl<V: Vector> Support for Point<V> {
    type Vector = V;
    #[inline(always)]
    fn support(&self, _: V, _: u32) -> SupportPoint<V> {
        only(self.0)
    }
    #[inline(always)]
    fn center(&self) -> V {
        self.0
    }
    #[inline(always)]
    fn extent(&self) -> V::Scalar {
        magnitude(self.0)
    }
}

impl<V: Vector> Vertices for Point<V> {
    fn count(&self) -> usize {
        1
    }
    fn vertex(&self, _: usize) -> V {
        self.0
    }
}

/// A line segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment<V> {
    /// One end.
    pub from: V,
    /// The other end.
    pub to: V,
}

impl<V: Vector> Support for Segment<V> {
    type Vector = V;
    #[inline(always)]
    fn support(&self, direction: V, _: u32) -> SupportPoint<V> {
        if self.to.dot(direction) > self.from.dot(direction) {
            SupportPoint { point: self.to, index: 1 }
        } else {
            only(self.from)
        }
    }
    #[inline(always)]
    fn center(&self) -> V {
        self.from * V::Scalar::HALF + self.to * V::Scalar::HALF
    }
    #[inline(always)]
    fn extent(&self) -> V::Scalar {
        magnitude(self.from).max(magnitude(self.to)) + magnitude(self.from + self.to) * V::Scalar::ZERO
    }
}

impl<V: Vector> Vertices for Segment<V> {
    fn count(&self) -> usize {
        2
    }
    fn vertex(&self, index: usize) -> V {
        if index == 0 { self.from } else { self.to }
    }
}

/// A triangle; it may be degenerate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle<V> {
    /// First corner.
    pub a: V,
    /// Second corner.
    pub b: V,
    /// Third corner.
    pub c: V,
}

impl<V: Vector> Support for Triangle<V> {
    type Vector = V;
    #[inline(always)]
    fn support(&self, direction: V, _: u32) -> SupportPoint<V> {
        let (da, db, dc) = (self.a.dot(direction), self.b.dot(direction), self.c.dot(direction));
        let (best, point, index) = if db > da { (db, self.b, 1) } else { (da, self.a, 0) };
        if dc > best { SupportPoint { point: self.c, index: 2 } } else { SupportPoint { point, index } }
    }
    #[inline(always)]
    fn center(&self) -> V {
        (self.a + self.b + self.c) * V::Scalar::from_f64(1.0 / 3.0)
    }
    #[inline(always)]
    fn extent(&self) -> V::Scalar {
        let highest = self.a.abs().max(self.b.abs()).max(self.c.abs());
        highest.norm_max() + (self.a + self.b + self.c).norm_1() * V::Scalar::ZERO
    }
}

impl<V: Vector> Vertices for Triangle<V> {
    fn count(&self) -> usize {
        3
    }
    fn vertex(&self, index: usize) -> V {
        match index {
            0 => self.a,
            1 => self.b,
            _ => self.c,
        }
    }
}

impl<V: Vector> Support for Aabb<V> {
    type Vector = V;
    #[inline(always)]
    fn support(&self, direction: V, _: u32) -> SupportPoint<V> {
        let zero = V::Scalar::ZERO;
        let x = if direction.x() > zero { self.max.x() } else { self.min.x() };
        let y = if direction.y() > zero { self.max.y() } else { self.min.y() };
        let z = if direction.z() > zero { self.max.z() } else { self.min.z() };
        only(V::new(x, y, z))
    }
    #[inline(always)]
    fn center(&self) -> V {
        Aabb::center(*self)
    }
    /// Infinite for a box that holds no point.
    #[inline(always)]
    fn extent(&self) -> V::Scalar {
        let poison =
            if self.is_empty() { V::Scalar::INFINITY } else { (self.min + self.max).norm_1() * V::Scalar::ZERO };
        self.min.abs().max(self.max.abs()).norm_max() + poison
    }
}

impl<V: Vector> Vertices for Aabb<V> {
    fn count(&self) -> usize {
        8
    }
    fn vertex(&self, index: usize) -> V {
        let x = if index & 1 == 0 { self.min.x() } else { self.max.x() };
        let y = if index & 2 == 0 { self.min.y() } else { self.max.y() };
        let z = if index & 4 == 0 { self.min.z() } else { self.max.z() };
        V::new(x, y, z)
    }
}

/// A box in any position: the centre plus or minus each of three vectors. They need not be orthogonal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrientedBox<V> {
    /// Centre.
    pub center: V,
    /// From the centre to the middle of three faces.
    pub half_axes: [V; 3],
}

impl<V: Vector> OrientedBox<V> {
    /// The eight corners as they round: for a body whose vertices are exact, take the [`Hull`] of these.
    pub fn corners(&self) -> [V; 8] {
        let [u, v, w] = self.half_axes;
        let mut corners = [self.center; 8];
        for (i, corner) in corners.iter_mut().enumerate() {
            let signed = |axis: V, bit: usize| if i & bit == 0 { -axis } else { axis };
            *corner += signed(u, 1) + signed(v, 2) + signed(w, 4);
        }
        corners
    }
}

impl<V: Vector> Support for OrientedBox<V> {
    type Vector = V;
    #[inline(always)]
    fn support(&self, direction: V, _: u32) -> SupportPoint<V> {
        let [u, v, w] = self.half_axes;
        let one = V::Scalar::ONE;
        let point = self.center
            + u * one.copysign(u.dot(direction))
            + v * one.copysign(v.dot(direction))
            + w * one.copysign(w.dot(direction));
        only(point)
    }
    #[inline(always)]
    fn center(&self) -> V {
        self.center
    }
    #[inline(always)]
    fn extent(&self) -> V::Scalar {
        let [u, v, w] = self.half_axes;
        magnitude(self.center.abs() + u.abs() + v.abs() + w.abs())
            * (V::Scalar::ONE + V::Scalar::from_f64(4.0) * V::Scalar::EPSILON)
    }
    #[inline(always)]
    fn slack(&self) -> V::Scalar {
        // Three sums of the point, and three signs whose scalar products may be off by three roundings each.
        V::Scalar::from_f64(8.0) * V::Scalar::EPSILON * self.extent()
    }
}

/// A ball: a point with a radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere<V: Vector> {
    /// Centre.
    pub center: V,
    /// Radius, not negative.
    pub radius: V::Scalar,
}

/// A segment with a radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule<V: Vector> {
    /// One end of the core.
    pub from: V,
    /// The other end.
    pub to: V,
    /// Radius, not negative.
    pub radius: V::Scalar,
}

impl<V: Vector> Sphere<V> {
    #[inline(always)]
    fn rounded(&self) -> Rounded<Point<V>> {
        Rounded { core: Point(self.center), radius: self.radius }
    }
}

impl<V: Vector> Capsule<V> {
    #[inline(always)]
    fn rounded(&self) -> Rounded<Segment<V>> {
        Rounded { core: Segment { from: self.from, to: self.to }, radius: self.radius }
    }
}

macro_rules! support_of_rounded {
    ($shape:ident) => {
        impl<V: Vector> Support for $shape<V> {
            type Vector = V;
            const ROUNDED: bool = true;
            #[inline(always)]
            fn support(&self, direction: V, start: u32) -> SupportPoint<V> {
                self.rounded().support(direction, start)
            }
            #[inline(always)]
            fn center(&self) -> V {
                self.rounded().center()
            }
            #[inline(always)]
            fn extent(&self) -> V::Scalar {
                self.rounded().extent()
            }
            #[inline(always)]
            fn radius(&self) -> V::Scalar {
                self.radius
            }
        }
    };
}
support_of_rounded!(Sphere);
support_of_rounded!(Capsule);

/// `v` by its length; zero for zero. Components of any size.
pub(crate) fn normalized<V: Vector>(v: V) -> V {
    let unit = v.norm_max().binade();
    if !(unit > V::Scalar::ZERO) || !unit.is_finite() {
        return V::ZERO;
    }
    let v = v * (V::Scalar::ONE / unit);
    v * (V::Scalar::ONE / v.dot(v).sqrt())
}

/// An ellipsoid with axes along x, y and z; see [`crate::support::Transformed`] for others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid<V> {
    /// Centre.
    pub center: V,
    /// Half the length along each axis, not negative.
    pub semi_axes: V,
}

#[inline(always)]
fn times<V: Vector>(a: V, b: V) -> V {
    V::new(a.x() * b.x(), a.y() * b.y(), a.z() * b.z())
}

impl<V: Vector> Support for Ellipsoid<V> {
    type Vector = V;
    #[inline(always)]
    fn support(&self, direction: V, _: u32) -> SupportPoint<V> {
        let on_unit_ball = normalized(times(self.semi_axes, normalized(direction)));
        only(self.center + times(self.semi_axes, on_unit_ball))
    }
    #[inline(always)]
    fn center(&self) -> V {
        self.center
    }
    #[inline(always)]
    fn extent(&self) -> V::Scalar {
        magnitude(self.center.abs() + self.semi_axes.abs())
            * (V::Scalar::ONE + V::Scalar::from_f64(4.0) * V::Scalar::EPSILON)
    }
    #[inline(always)]
    fn slack(&self) -> V::Scalar {
        V::Scalar::from_f64(24.0) * V::Scalar::EPSILON * self.extent()
    }
}

/// A centre, an axis and two vectors across it: what cylinder and cone have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame<V: Vector> {
    pub base: V,
    pub top: V,
    axis: V,
    pub across: [V; 2],
    pub radius: V::Scalar,
}

impl<V: Vector> Frame<V> {
    pub fn new(base: V, top: V, radius: V::Scalar) -> Self {
        let axis = top - base;
        let unit = normalized(axis);
        let [x, y, z] = unit.abs().to_array();
        let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
        // The coordinate axis least along ours.
        let other = if x <= y && x <= z {
            V::new(one, zero, zero)
        } else if y <= z {
            V::new(zero, one, zero)
        } else {
            V::new(zero, zero, one)
        };
        let u = normalized(unit.cross(other));
        Frame { base, top, axis, across: [u, unit.cross(u)], radius }
    }

    /// From the axis to the point of the circle farthest along a direction.
    #[inline(always)]
    fn rim(&self, direction: V) -> V {
        let [u, v] = self.across;
        let zero = V::Scalar::ZERO;
        let local = normalized(V::new(u.dot(direction), v.dot(direction), zero));
        (u * local.x() + v * local.y()) * self.radius
    }

    fn extent(&self) -> V::Scalar {
        let bad = if self.radius >= V::Scalar::ZERO { V::Scalar::ZERO } else { V::Scalar::INFINITY };
        let highest = self.base.abs() + self.axis.abs() + V::splat(self.radius);
        magnitude(highest) * (V::Scalar::ONE + V::Scalar::from_f64(16.0) * V::Scalar::EPSILON) + bad
    }

    fn slack(&self) -> V::Scalar {
        // A handful of roundings in the frame, in the direction across it, in its unit vector and in the sums.
        V::Scalar::from_f64(48.0) * V::Scalar::EPSILON * self.extent()
    }
}

/// A cylinder with flat ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder<V: Vector>(pub(crate) Frame<V>);

impl<V: Vector> Cylinder<V> {
    /// Between the centres of its ends. With both in one place it is that point.
    pub fn new(from: V, to: V, radius: V::Scalar) -> Self {
        Cylinder(Frame::new(from, to, radius))
    }
}

impl<V: Vector> Support for Cylinder<V> {
    type Vector = V;
    #[inline(always)]
    fn support(&self, direction: V, _: u32) -> SupportPoint<V> {
        let rim = self.0.rim(direction);
        let end = if self.0.axis.dot(direction) > V::Scalar::ZERO { self.0.axis } else { V::ZERO };
        only(self.0.base + end + rim)
    }
    #[inline(always)]
    fn center(&self) -> V {
        self.0.base + self.0.axis * V::Scalar::HALF
    }
    #[inline(always)]
    fn extent(&self) -> V::Scalar {
        self.0.extent()
    }
    #[inline(always)]
    fn slack(&self) -> V::Scalar {
        self.0.slack()
    }
}

/// A cone with a flat base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone<V: Vector>(pub(crate) Frame<V>);

impl<V: Vector> Cone<V> {
    /// From the centre and radius of its base to its apex. With both in one place it is that point.
    pub fn new(base: V, apex: V, radius: V::Scalar) -> Self {
        Cone(Frame::new(base, apex, radius))
    }
}

impl<V: Vector> Support for Cone<V> {
    type Vector = V;
    #[inline(always)]
    fn support(&self, direction: V, _: u32) -> SupportPoint<V> {
        let rim = self.0.rim(direction);
        let across = if self.0.axis.dot(direction) > rim.dot(direction) { self.0.axis } else { rim };
        only(self.0.base + across)
    }
    #[inline(always)]
    fn center(&self) -> V {
        self.0.base + self.0.axis * V::Scalar::from_f64(0.25)
    }
    #[inline(always)]
    fn extent(&self) -> V::Scalar {
        self.0.extent()
    }
    #[inline(always)]
    fn slack(&self) -> V::Scalar {
        self.0.slack()
    }
}

/// Which vertices of a hull share an edge, and where to start climbing along them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adjacency<'a> {
    offsets: &'a [u32],
    neighbours: &'a [u32],
    /// The farthest vertex along the middle of each sector.
    starts: [u32; SECTORS],
}

impl<'a> Adjacency<'a> {
    /// The neighbours of vertex `i` are `neighbours[offsets[i]..offsets[i + 1]]`; so `offsets` is one longer than `vertices`. Looks at each
    /// vertex 96 times. Wrong or missing edges cost time, not truth.
    pub fn new<V: Vector>(vertices: &[V], offsets: &'a [u32], neighbours: &'a [u32]) -> Self {
        let mut starts = [0; SECTORS];
        for (sector, start) in starts.iter_mut().enumerate() {
            *start = scan(vertices, middle(sector));
        }
        Adjacency { offsets, neighbours, starts }
    }

    #[inline(always)]
    fn of(&self, vertex: u32) -> &'a [u32] {
        let i = vertex as usize;
        match (self.offsets.get(i), self.offsets.get(i.wrapping_add(1))) {
            (Some(&lo), Some(&hi)) => self.neighbours.get(lo as usize..hi as usize).unwrap_or(&[]),
            _ => &[],
        }
    }
}

/// Up to this many vertices a scan is as fast as a climb, and needs no second look.
const CLIMBED: usize = 64;

/// Directions by where they leave a cube, each face of which is cut four by four.
const SECTORS: usize = 6 * 16;

#[inline(always)]
fn sector<V: Vector>(direction: V) -> usize {
    let zero = V::Scalar::ZERO;
    let [x, y, z] = direction.to_array();
    let [ax, ay, az] = [x.abs(), y.abs(), z.abs()];
    let (face, out, u, v) = if ax >= ay && ax >= az {
        (0, x, y, z)
    } else if ay >= az {
        (1, y, z, x)
    } else {
        (2, z, x, y)
    };
    let half = out.abs() * V::Scalar::HALF;
    let quarter = |t: V::Scalar| usize::from(t > -half) + usize::from(t > zero) + usize::from(t > half);
    (2 * face + usize::from(out > zero)) << 4 | quarter(u) << 2 | quarter(v)
}

/// The middle of a sector.
fn middle<V: Vector>(sector: usize) -> V {
    let one = V::Scalar::ONE;
    let out = if sector >> 4 & 1 == 1 { one } else { -one };
    let quarter =
        |bits: usize| V::Scalar::from_usize(2 * (bits & 3)) * V::Scalar::from_f64(0.25) - V::Scalar::from_f64(0.75);
    let (u, v) = (quarter(sector >> 2), quarter(sector));
    match sector >> 5 {
        0 => V::new(out, u, v),
        1 => V::new(v, out, u),
        _ => V::new(u, v, out),
    }
}

/// The farthest vertex. Selections instead of branches, and one comparison in a chain for every four vertices.
#[inline(always)]
fn scan<V: Vector>(vertices: &[V], direction: V) -> u32 {
    let (mut best, mut index) = (-V::Scalar::INFINITY, 0);
    let mut fours = vertices.chunks_exact(4);
    let mut first = 0;
    for four in &mut fours {
        if let [p, q, r, s] = *four {
            let along = [p.dot(direction), q.dot(direction), r.dot(direction), s.dot(direction)];
            let (pq, rs) = (along[1] > along[0], along[3] > along[2]);
            let low = if pq { along[1] } else { along[0] };
            let high = if rs { along[3] } else { along[2] };
            let top = if high > low { high } else { low };
            let at = first + if high > low { 2 + u32::from(rs) } else { u32::from(pq) };
            index = if top > best { at } else { index };
            best = if top > best { top } else { best };
        }
        first += 4;
    }
    for v in fours.remainder() {
        let along = v.dot(direction);
        index = if along > best { first } else { index };
        best = if along > best { along } else { best };
        first += 1;
    }
    index
}

/// The convex hull of some points; they may repeat, lie inside, in a plane or on a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hull<'a, V: Vector> {
    vertices: &'a [V],
    adjacency: Option<&'a Adjacency<'a>>,
    center: V,
    extent: V::Scalar,
}

impl<'a, V: Vector> Hull<'a, V> {
    /// Looks at each point once. Of no points, or of points that are not finite, queries are left undecided.
    pub fn new(vertices: &'a [V]) -> Self {
        let mut bounds = Aabb::empty();
        let mut poison = if vertices.is_empty() { V::Scalar::INFINITY } else { V::Scalar::ZERO };
        for &v in vertices {
            bounds = bounds.union(Aabb { min: v, max: v });
            poison += magnitude(v) * V::Scalar::ZERO;
        }
        let center = bounds.min * V::Scalar::HALF + bounds.max * V::Scalar::HALF;
        let extent = bounds.min.abs().max(bounds.max.abs()).norm_max() + poison;
        Hull { vertices, adjacency: None, center, extent }
    }

    /// Climbs along edges instead of scanning all vertices, if there are more than 64.
    #[must_use]
    pub fn with_adjacency(self, adjacency: &'a Adjacency<'a>) -> Self {
        Hull { adjacency: Some(adjacency), ..self }
    }

    /// The points.
    pub fn vertices(&self) -> &'a [V] {
        self.vertices
    }

    #[inline(always)]
    fn scan(&self, direction: V) -> SupportPoint<V> {
        let index = scan(self.vertices, direction);
        SupportPoint { point: self.vertices.get(index as usize).copied().unwrap_or(self.center), index }
    }

    /// The greatest coordinate along a direction; four chains, so that it runs as fast as the additions allow.
    #[inline(always)]
    fn reach(&self, direction: V) -> V::Scalar {
        let mut best = [-V::Scalar::INFINITY; 4];
        let mut chunks = self.vertices.chunks_exact(4);
        for four in &mut chunks {
            if let [p, q, r, s] = *four {
                let along = [p.dot(direction), q.dot(direction), r.dot(direction), s.dot(direction)];
                for (best, along) in best.iter_mut().zip(along) {
                    *best = if along > *best { along } else { *best };
                }
            }
        }
        let rest = chunks.remainder().iter().fold(-V::Scalar::INFINITY, |m, v| m.max(v.dot(direction)));
        best.into_iter().fold(rest, Real::max)
    }

    #[inline(always)]
    fn climb(&self, adjacency: &Adjacency<'a>, direction: V, start: u32) -> SupportPoint<V> {
        let along = |index: u32| self.vertices.get(index as usize).map_or(-V::Scalar::INFINITY, |v| v.dot(direction));
        let mut index = adjacency.starts.get(sector(direction)).copied().unwrap_or(0);
        let mut best = along(index);
        let earlier = along(start);
        index = if earlier > best { start } else { index };
        best = if earlier > best { earlier } else { best };
        loop {
            // Selections, as in `scan`.
            let from = index;
            for &n in adjacency.of(from) {
                let there = along(n);
                index = if there > best { n } else { index };
                best = if there > best { there } else { best };
            }
            if index == from {
                return SupportPoint {
                    point: self.vertices.get(index as usize).copied().unwrap_or(self.center),
                    index,
                };
            }
        }
    }
}

impl<V: Vector> Support for Hull<'_, V> {
    type Vector = V;
    #[inline(always)]
    fn support(&self, direction: V, start: u32) -> SupportPoint<V> {
        match self.adjacency {
            Some(adjacency) if self.vertices.len() > CLIMBED => self.climb(adjacency, direction, start),
            _ => self.scan(direction),
        }
    }
    #[inline(always)]
    fn farther(&self, direction: V, found: u32) -> Option<SupportPoint<V>> {
        let climbed = self.adjacency.is_some() && self.vertices.len() > CLIMBED;
        let found = self.vertices.get(found as usize)?;
        (climbed && self.reach(direction) > found.dot(direction)).then(|| self.scan(direction))
    }
    #[inline(always)]
    fn center(&self) -> V {
        self.center
    }
    #[inline(always)]
    fn extent(&self) -> ScalarOf<Self> {
        self.extent
    }
}

impl<V: Vector> Vertices for Hull<'_, V> {
    fn count(&self) -> usize {
        self.vertices.len()
    }
    fn vertex(&self, index: usize) -> V {
        self.vertices.get(index).or(self.vertices.last()).copied().unwrap_or(V::ZERO)
    }
}
