//! Convex bodies as lines see them: where a line enters and leaves, which of their sides are flat, how far they reach.
//!
//! A chord is computed for the body grown by a length, or shrunk if that is negative. Rounding moves the ends of a chord as if the body
//! had been moved or bent by less than [`chord_rounding`]; so the chord of the body grown by that holds the true chord, and the chord of the body
//! shrunk by it lies inside the true one. The quadratic forms below are arranged for that: each term is rounded relative to a
//! length of the body, none by cancellation of squares.

use crate::convex::exact::{Contact, contact};
pub use crate::convex::shape::FacetPlane;
use crate::convex::shape::{AxisFrame, Capsule, Cone, Cylinder, Ellipsoid, OrientedBox, Sphere};
use crate::convex::support::{ScalarOf, Support, Transformed, normalized};
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};

/// A piece of a line, by its parameters; infinite where it has no end.
pub type Chord<V> = [<V as Vector>::Scalar; 2];

/// A convex body that knows its chords.
pub trait Chords: Support {
    /// How many flat sides it has.
    fn facet_count(&self) -> usize {
        0
    }

    /// A flat side, by an index below [`Chords::facet_count`].
    fn facet(&self, index: usize) -> FacetPlane<Self::Vector>;

    /// A box around the part of the surface that lies in a facet, if it is known.
    fn facet_bounds(&self, index: usize) -> Option<Aabb<Self::Vector>> {
        let _ = index;
        None
    }

    /// The body is what all its facets leave.
    fn is_polytope(&self) -> bool {
        false
    }

    /// Lower and upper bound of the signed distance of a point from the surface, negative inside the body. Rounding is not in them: the caller
    /// adds a margin. By default nothing is known.
    fn signed_distance(&self, point: Self::Vector) -> [ScalarOf<Self>; 2] {
        let _ = point;
        endless()
    }

    /// The point of the body nearest to one outside, but for rounding, if that is easily had.
    fn nearest(&self, point: Self::Vector) -> Option<Self::Vector> {
        let _ = point;
        None
    }

    /// Surely shares no point with a box. False tells nothing.
    fn misses(&self, cell: &Aabb<Self::Vector>) -> bool {
        let _ = cell;
        false
    }

    /// The parameters `t` for which `origin + t direction` lies in the body grown by `grow`, none if it misses. `near` lists the facets
    /// that matter where the caller looks; of a body that [is no polytope](Chords::is_polytope) all matter.
    fn chord(
        &self,
        origin: Self::Vector,
        direction: Self::Vector,
        grow: ScalarOf<Self>,
        near: &[u32],
    ) -> Option<Chord<Self::Vector>>;

    /// How it lies to a box with volume, decided exactly; nothing if it cannot be.
    fn exact_contact(&self, cell: &Aabb<Self::Vector>) -> Option<Contact> {
        let _ = cell;
        None
    }

    /// A box around the body, exact where it ends in exact planes.
    fn bounds(&self) -> Aabb<Self::Vector> {
        let (zero, one) = (ScalarOf::<Self>::ZERO, ScalarOf::<Self>::ONE);
        let margin = self.radius() + self.slack() + if Self::ROUNDED { chord_rounding(self) } else { zero };
        let [mut min, mut max] = [[zero; 3]; 2];
        for axis in 0..3 {
            let mut along = [zero; 3];
            along[axis] = one;
            let along = Self::Vector::from_array(along);
            min[axis] = self.farthest(-along).point.to_array()[axis] - margin;
            max[axis] = self.farthest(along).point.to_array()[axis] + margin;
        }
        for plane in (0..self.facet_count()).map(|i| self.facet(i)).filter(|p| p.exact) {
            for (axis, n) in plane.normal.to_array().into_iter().enumerate() {
                if n > zero {
                    max[axis] = plane.offset;
                } else if n < zero {
                    min[axis] = -plane.offset;
                }
            }
        }
        Aabb { min: Self::Vector::from_array(min), max: Self::Vector::from_array(max) }
    }
}

/// How far rounding may move a point of a body or of a line near it, in units of ε times the largest coordinate.
const MOVED_IN_EPSILONS: f64 = 64.0;

/// The length by which to grow or shrink a body so that rounding cannot make its chords too short or too long.
#[inline(always)]
pub fn chord_rounding<S: Support + ?Sized>(body: &S) -> ScalarOf<S> {
    rounding_at(body.extent())
}

/// The same for coordinates up to `extent`.
#[inline(always)]
pub(crate) fn rounding_at<R: Real>(extent: R) -> R {
    extent * R::EPSILON * R::from_f64(MOVED_IN_EPSILONS)
}

/// The whole line.
#[inline(always)]
fn endless<R: Real>() -> [R; 2] {
    [-R::INFINITY, R::INFINITY]
}

/// A sum of squares from which nothing to speak of was lost by overflow or underflow.
#[inline(always)]
fn is_usual<R: Real>(squares: R) -> bool {
    squares >= R::MIN_POSITIVE / R::EPSILON && squares < R::INFINITY
}

/// One over the power of two of a size; none where one cannot compute with it.
fn inverse_binade<R: Real>(size: R) -> Option<R> {
    let unit = size.binade();
    (unit > R::ZERO && unit.is_finite() && R::ONE / unit >= R::MIN_POSITIVE).then(|| R::ONE / unit)
}

/// Powers of two that bring `w` and `q`, and `e` and `dq`, near one; none if there are no such powers.
fn factors<V: Vector>((w, q): (V, V::Scalar), (e, dq): (V, V::Scalar)) -> Option<[V::Scalar; 2]> {
    let along = e.norm_max().larger(dq.abs());
    let step = if along > V::Scalar::ZERO { inverse_binade(along)? } else { V::Scalar::ONE };
    Some([inverse_binade(w.norm_max().larger(q.abs()))?, step])
}

/// Where `|w + t e| <= q`.
#[inline(always)]
fn within<V: Vector>(w: V, e: V, q: V::Scalar) -> Option<[V::Scalar; 2]> {
    // With a smaller product something is lost, or the line is parallel to the axis; with a larger `w` it misses.
    if is_usual(e.dot(e) * (q * q)) {
        return within_usual(w, e, q);
    }
    within_cone_of_any_size(w, e, q, V::Scalar::ZERO)
}

/// Where `|w + t e| <= q + t dq`, lengths brought near one; a chord that tells nothing where that cannot be done. Out of the way of what is usual.
#[cold]
#[inline(never)]
fn within_cone_of_any_size<V: Vector>(w: V, e: V, q: V::Scalar, dq: V::Scalar) -> Option<[V::Scalar; 2]> {
    let Some([length, step]) = factors((w, q), (e, dq)) else {
        return Some([V::Scalar::INFINITY * V::Scalar::ZERO; 2]);
    };
    let (w, e, q, dq) = (w * length, e * step, q * length, dq * step);
    let found = if dq == V::Scalar::ZERO { within_usual(w, e, q) } else { within_usual_cone(w, e, q, dq) };
    found.map(|t| t.map(|t| t / length * step))
}

/// The same of lengths whose squares can be had.
#[inline(always)]
fn within_usual<V: Vector>(w: V, e: V, q: V::Scalar) -> Option<[V::Scalar; 2]> {
    let zero = V::Scalar::ZERO;
    let (a, area) = (e.dot(e), w.cross(e));
    let discriminant = a * (q * q) - area.dot(area);
    if q < zero || discriminant < zero {
        return None;
    }
    if !(a > zero) {
        // Along the axis.
        return (w.dot(w) <= q * q).then(endless);
    }
    let (b, root, inv) = (w.dot(e), discriminant.sqrt(), reciprocal(a));
    Some([(-b - root) * inv, (root - b) * inv])
}

/// Where `|w + t e| <= q + t dq`, for `q + t dq` not negative.
#[inline(always)]
fn within_cone<V: Vector>(w: V, e: V, q: V::Scalar, dq: V::Scalar) -> Option<[V::Scalar; 2]> {
    if dq == V::Scalar::ZERO {
        return within(w, e, q);
    }
    if is_usual(w.dot(w) + q * q) && is_usual(e.dot(e) + dq * dq) {
        return within_usual_cone(w, e, q, dq);
    }
    within_cone_of_any_size(w, e, q, dq)
}

/// The same of lengths whose squares can be had.
#[inline(always)]
fn within_usual_cone<V: Vector>(w: V, e: V, q: V::Scalar, dq: V::Scalar) -> Option<[V::Scalar; 2]> {
    let (zero, infinity) = (V::Scalar::ZERO, V::Scalar::INFINITY);
    let (reach, area) = (e * q - w * dq, w.cross(e));
    let discriminant = reach.dot(reach) - area.dot(area);
    let (a, b) = (e.dot(e) - dq * dq, w.dot(e) - q * dq);
    let beyond = |t: V::Scalar| if dq > zero { [t, infinity] } else { [-infinity, t] };
    // The line is parallel to one of the cone but for rounding.
    let is_parallel = a.abs() <= e.dot(e) * V::Scalar::EPSILON * V::Scalar::from_f64(MOVED_IN_EPSILONS);
    if discriminant < zero {
        // Steeper than the cone, and through its apex but for rounding.
        return (a < zero && !is_parallel).then(|| beyond(-q / dq));
    }
    let root = discriminant.sqrt();
    let sum = if b > zero { -b - root } else { root - b };
    let one = sum / a;
    let flat = a > V::Scalar::HALF * e.dot(e);
    let other = if flat { (-b - b - sum) / a } else { (w.dot(w) - q * q) / sum };
    let (low, high) = (one.min(other), one.max(other));
    if is_parallel {
        // It has one end in the cone that is meant, or in the other cone that it meets at the apex; the second end is anywhere.
        return match [one, other].map(|t| q + t * dq >= zero && t.is_finite()) {
            [true, true] => Some(beyond(if dq > zero { low } else { high })),
            [true, false] => Some(beyond(one)),
            [false, true] => Some(beyond(other)),
            [false, false] => None,
        };
    }
    if a < zero {
        return Some(beyond(if dq > zero { high } else { low }));
    }
    // Of the two cones that meet at the apex only one is meant.
    (q + other * dq >= zero).then_some([low, high])
}

/// One over a number that often is one.
#[inline(always)]
fn reciprocal<R: Real>(a: R) -> R {
    if a == R::ONE { a } else { R::ONE / a }
}

/// The parameter nearest to a body's centre, and the line's point there.
#[inline(always)]
fn beside<V: Vector>(origin: V, direction: V, center: V) -> (V::Scalar, V) {
    let at = (center - origin).dot(direction) * reciprocal(direction.dot(direction));
    (at, origin + direction * at)
}

#[inline(always)]
fn moved<R: Real>(t: [R; 2], by: R) -> [R; 2] {
    [t[0] + by, t[1] + by]
}

/// No flat side.
fn no_facet<V: Vector>() -> FacetPlane<V> {
    FacetPlane { normal: V::ZERO, offset: V::Scalar::INFINITY, exact: false }
}

#[inline(always)]
fn ball<V: Vector>(center: V, radius: V::Scalar, origin: V, direction: V) -> Option<[V::Scalar; 2]> {
    let to_center = center - origin;
    let direction_sq = direction.dot(direction);
    let inv = reciprocal(direction_sq);
    let nearest = to_center.dot(direction) * inv;
    let across = to_center - direction * nearest;
    let (whole_sq, across_sq) = (radius * radius, across.dot(across));
    if !(is_usual(whole_sq) && is_usual(direction_sq)) {
        return within_cone_of_any_size(origin - center, direction, radius, V::Scalar::ZERO);
    }
    let half_sq = (whole_sq - across_sq) * inv;
    if radius < V::Scalar::ZERO || half_sq < V::Scalar::ZERO {
        return None;
    }
    let half = half_sq.sqrt();
    Some([nearest - half, nearest + half])
}

impl<V: Vector> Chords for Sphere<V> {
    fn facet(&self, _: usize) -> FacetPlane<V> {
        no_facet()
    }
    #[inline(always)]
    fn chord(&self, origin: V, direction: V, grow: V::Scalar, _: &[u32]) -> Option<Chord<V>> {
        ball(self.center, self.radius + grow, origin, direction)
    }
    #[inline(always)]
    fn signed_distance(&self, point: V) -> [V::Scalar; 2] {
        [length(point - self.center) - self.radius; 2]
    }
    #[inline(always)]
    fn nearest(&self, point: V) -> Option<V> {
        Some(self.center + out_to(point - self.center, self.radius))
    }
}

/// A vector shortened to a length.
#[inline(always)]
fn out_to<V: Vector>(v: V, radius: V::Scalar) -> V {
    v * (radius / length(v)).min(V::Scalar::ONE)
}

/// The length of a vector of any size.
#[inline(always)]
pub(crate) fn length<V: Vector>(v: V) -> V::Scalar {
    let sq = v.dot(v);
    if is_usual(sq) { sq.sqrt() } else { length_of_any_size(v) }
}

#[cold]
#[inline(never)]
fn length_of_any_size<V: Vector>(v: V) -> V::Scalar {
    v.length()
}

/// How far along an axis of any size a vector reaches, as a share of it.
#[cold]
#[inline(never)]
fn share_along<V: Vector>(axis: V, to: V) -> V::Scalar {
    let factor = V::Scalar::ONE / axis.norm_max().larger(to.norm_max()).binade();
    (to * factor).dot(axis * factor) / (axis * factor).dot(axis * factor)
}

#[inline(always)]
fn divided<V: Vector>(a: V, b: V) -> V {
    V::new(a.x() / b.x(), a.y() / b.y(), a.z() / b.z())
}

impl<V: Vector> Chords for Ellipsoid<V> {
    fn facet(&self, _: usize) -> FacetPlane<V> {
        no_facet()
    }
    #[inline(always)]
    fn chord(&self, origin: V, direction: V, grow: V::Scalar, _: &[u32]) -> Option<Chord<V>> {
        let s = self.semi_axes;
        let shortest = s.x().min(s.y()).min(s.z());
        let (at, p) = beside(origin, direction, self.center);
        let (w, e) = (divided(p - self.center, s), divided(direction, s));
        Some(moved(within(w, e, V::Scalar::ONE + grow / shortest)?, at))
    }
}

impl<V: Vector> AxisFrame<V> {
    /// The components of a vector across the axis.
    #[inline(always)]
    fn lateral(&self, v: V) -> V {
        let [u1, u2] = self.across;
        V::new(u1.dot(v), u2.dot(v), V::Scalar::ZERO)
    }

    /// The chord of the endless cylinder.
    #[inline(always)]
    fn tube(&self, origin: V, direction: V, grow: V::Scalar) -> Option<Chord<V>> {
        let (at, p) = beside(origin, direction, (self.base + self.top) * V::Scalar::HALF);
        let (w, e) = (self.lateral(p - self.base), self.lateral(direction));
        Some(moved(within(w, e, self.radius + grow)?, at))
    }
}

impl<V: Vector> Chords for Cylinder<V> {
    fn facet_count(&self) -> usize {
        2
    }
    #[inline(always)]
    fn facet(&self, index: usize) -> FacetPlane<V> {
        self.0.ends[index & 1]
    }
    #[inline(always)]
    fn chord(&self, origin: V, direction: V, grow: V::Scalar, _: &[u32]) -> Option<Chord<V>> {
        let mut t = self.0.tube(origin, direction, grow)?;
        self.0.ends.iter().all(|end| end.clip(origin, direction, grow, &mut t)).then_some(t)
    }
    #[inline(always)]
    fn signed_distance(&self, point: V) -> [V::Scalar; 2] {
        let zero = V::Scalar::ZERO;
        let [down, up] = self.0.ends.map(|end| end.normal.dot(point) - end.offset);
        let (along, across) = (down.max(up), length(self.0.lateral(point - self.0.base)) - self.0.radius);
        if along > zero && across > zero { [length(V::new(along, across, zero)); 2] } else { [along.max(across); 2] }
    }
    #[inline(always)]
    fn nearest(&self, point: V) -> Option<V> {
        let AxisFrame { base, across: [u1, u2], height, radius, ends: [_, top], .. } = self.0;
        let flat = out_to(self.0.lateral(point - base), radius);
        let along = top.normal.dot(point - base).max(V::Scalar::ZERO).min(height);
        Some(base + top.normal * along + (u1 * flat.x() + u2 * flat.y()))
    }
}

impl<V: Vector> Capsule<V> {
    /// From the nearest point of the core to a point.
    #[inline(always)]
    fn off_core(&self, point: V) -> V {
        let (axis, to) = (self.to - self.from, point - self.from);
        let axis_sq = axis.dot(axis);
        let share =
            if is_usual(axis_sq) && is_usual(to.dot(to)) { to.dot(axis) / axis_sq } else { share_along(axis, to) };
        let share = if share > V::Scalar::ZERO { share.min(V::Scalar::ONE) } else { V::Scalar::ZERO };
        to - axis * share
    }

    /// The chord of what lies between the planes through the ends.
    #[inline(always)]
    fn middle(&self, origin: V, direction: V, grow: V::Scalar) -> Option<Chord<V>> {
        let unit = normalized(self.to - self.from);
        if unit == V::ZERO {
            return None;
        }
        let across = |v: V| v - unit * unit.dot(v);
        let (at, p) = beside(origin, direction, self.center());
        let mut t = moved(within(across(p - self.from), across(direction), self.radius + grow)?, at);
        let ends = [(-unit, self.from), (unit, self.to)];
        let plane = |(normal, end): (V, V)| FacetPlane { normal, offset: normal.dot(end), exact: false };
        ends.into_iter().all(|end| plane(end).clip(origin, direction, grow, &mut t)).then_some(t)
    }
}

impl<V: Vector> Chords for Capsule<V> {
    fn facet(&self, _: usize) -> FacetPlane<V> {
        no_facet()
    }
    #[inline(always)]
    fn chord(&self, origin: V, direction: V, grow: V::Scalar, _: &[u32]) -> Option<Chord<V>> {
        let balls = [self.from, self.to].map(|center| ball(center, self.radius + grow, origin, direction));
        let join = |a: Chord<V>, b: Chord<V>| [a[0].min(b[0]), a[1].max(b[1])];
        balls.into_iter().chain([self.middle(origin, direction, grow)]).flatten().reduce(join)
    }
    #[inline(always)]
    fn signed_distance(&self, point: V) -> [V::Scalar; 2] {
        [length(self.off_core(point)) - self.radius; 2]
    }
    #[inline(always)]
    fn nearest(&self, point: V) -> Option<V> {
        let out = self.off_core(point);
        Some(point - out + out_to(out, self.radius))
    }
}

impl<V: Vector> Chords for Cone<V> {
    fn facet_count(&self) -> usize {
        if self.top_radius() > V::Scalar::ZERO { 2 } else { 1 }
    }
    #[inline(always)]
    fn facet(&self, index: usize) -> FacetPlane<V> {
        self.frame.ends[index & 1]
    }
    #[inline(always)]
    fn chord(&self, origin: V, direction: V, grow: V::Scalar, _: &[u32]) -> Option<Chord<V>> {
        let AxisFrame { base, top, across: [u1, u2], radius, .. } = self.frame;
        let (at, p) = beside(origin, direction, (base + top) * V::Scalar::HALF);
        let axis = u1.cross(u2);
        let slope = (radius - self.top_radius()) / (top - base).length();
        let out = grow * (V::Scalar::ONE + slope * slope).sqrt();
        let (q, dq) = ((top - p).dot(axis) * slope + self.top_radius() + out, -(direction.dot(axis) * slope));
        let w = self.frame.lateral(p - base);
        let mut t = moved(within_cone(w, self.frame.lateral(direction), q, dq)?, at);
        let ends = self.frame.ends.iter().take(self.facet_count());
        let mut ends = ends.map(|end| end.clip(origin, direction, grow, &mut t));
        ends.all(|left| left).then_some(t)
    }
    #[inline(always)]
    fn signed_distance(&self, point: V) -> [V::Scalar; 2] {
        let AxisFrame { ends: [base, top], radius, height, .. } = self.frame;
        let below = base.normal.dot(point) - base.offset;
        // Of the side, in the plane through the axis and the point.
        let (left, out) = (top.offset - top.normal.dot(point), length(self.frame.lateral(point - self.frame.base)));
        let less = radius - self.top_radius();
        let beside = ((out - self.top_radius()) * height - left * less) / length(V::new(height, less, V::Scalar::ZERO));
        // Products of lengths that are too large tell nothing.
        if !beside.is_finite() {
            return endless();
        }
        let low = below.max(beside).max(if self.facet_count() > 1 { -left } else { below });
        [low, if low < V::Scalar::ZERO { low } else { V::Scalar::INFINITY }]
    }
}

impl<V: Vector> Chords for Aabb<V> {
    fn facet_count(&self) -> usize {
        6
    }
    #[inline(always)]
    fn facet(&self, index: usize) -> FacetPlane<V> {
        let (high, mut normal) = (index & 1 == 1, [V::Scalar::ZERO; 3]);
        normal[(index >> 1) % 3] = if high { V::Scalar::ONE } else { -V::Scalar::ONE };
        FacetPlane::new(V::from_array(normal), if high { self.max } else { self.min })
    }
    fn is_polytope(&self) -> bool {
        true
    }
    #[inline(always)]
    fn chord(&self, origin: V, direction: V, grow: V::Scalar, near: &[u32]) -> Option<Chord<V>> {
        through_facets(self, origin, direction, grow, near)
    }
    fn exact_contact(&self, cell: &Aabb<V>) -> Option<Contact> {
        contact(cell, self, None).ok()
    }
}

impl<V: Vector> Chords for OrientedBox<V> {
    fn facet_count(&self) -> usize {
        6
    }
    #[inline(always)]
    fn facet(&self, index: usize) -> FacetPlane<V> {
        let axis = (index >> 1) % 3;
        let [out, u, v] = [0, 1, 2].map(|i| self.half_axes[(axis + i) % 3]);
        let normal = u.cross(v);
        let outward = if (normal.dot(out) > V::Scalar::ZERO) == (index & 1 == 1) { normal } else { -normal };
        let plane = FacetPlane::new(outward, self.support(outward, 0).point);
        // Its corners are rounded, even if its axes are not.
        FacetPlane { exact: false, ..plane }
    }
    fn is_polytope(&self) -> bool {
        true
    }
    #[inline(always)]
    fn chord(&self, origin: V, direction: V, grow: V::Scalar, near: &[u32]) -> Option<Chord<V>> {
        through_facets(self, origin, direction, grow, near)
    }
}

/// The chord of a polytope.
#[inline(always)]
pub(crate) fn through_facets<B: Chords>(
    body: &B,
    origin: B::Vector,
    direction: B::Vector,
    grow: ScalarOf<B>,
    near: &[u32],
) -> Option<Chord<B::Vector>> {
    let mut t = endless();
    for &i in near {
        if !body.facet(i as usize).clip(origin, direction, grow, &mut t) {
            return None;
        }
    }
    Some(t)
}

impl<S: Chords> Chords for Transformed<S> {
    fn facet_count(&self) -> usize {
        self.shape.facet_count()
    }
    fn facet(&self, index: usize) -> FacetPlane<S::Vector> {
        let plane = self.shape.facet(index);
        let [n1, n2, n3] = plane.normal.to_array();
        let [x, y, z] = self.inverse();
        let normal = x * n1 + y * n2 + z * n3;
        let inner = normalized(normal);
        FacetPlane { normal: inner, offset: inner.dot(self.farthest(inner).point) + self.radius(), exact: false }
    }
    fn is_polytope(&self) -> bool {
        self.shape.is_polytope()
    }
    #[inline(always)]
    fn chord(
        &self,
        origin: S::Vector,
        direction: S::Vector,
        grow: ScalarOf<S>,
        near: &[u32],
    ) -> Option<Chord<S::Vector>> {
        let rows = self.inverse();
        let local = |v: S::Vector| Vector::new(rows[0].dot(v), rows[1].dot(v), rows[2].dot(v));
        // One over the shortest column, but for a rounding.
        let stretch = rows[0].dot(rows[0]).max(rows[1].dot(rows[1])).max(rows[2].dot(rows[2])).sqrt();
        self.shape.chord(local(origin - self.translation), local(direction), grow * stretch, near)
    }
}

impl<S: Support> Transformed<S> {
    /// The rows of the inverse map: rotation and scale leave the columns at right angles.
    #[inline(always)]
    fn inverse(&self) -> [S::Vector; 3] {
        self.columns.map(|c| c * (ScalarOf::<S>::ONE / c.dot(c)))
    }
}
