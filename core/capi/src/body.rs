//! Convex bodies, whether two meet, and how far apart they are.

use crate::input::{Arrays, all, give, given, same_layout};
use crate::status::{Answer, Status};
use crate::types::{Body, Contact, Distance, Kind};
use core::ffi::CStr;
use core::slice;
use voidage_core::convex::exact;
use voidage_core::convex::shape::{
    Capsule, Cone, Cylinder, Ellipsoid, Hull, OrientedBox, Point, Segment, Sphere, Triangle,
};
use voidage_core::convex::support::Transformed;
use voidage_core::convex::{AnyBody, AnyShape, BodyQuery, Clearance};
use voidage_core::number::aabb::Aabb;
use voidage_core::number::real::{Real, Vector};
use voidage_core::solids::{RoundShape, RoundSolid};

/// How many of its twelve numbers a kind uses.
fn used(kind: i32) -> Answer<(Kind, usize)> {
    let kinds = [
        (Kind::Point, 3),
        (Kind::Segment, 6),
        (Kind::Triangle, 9),
        (Kind::Box, 6),
        (Kind::Hull, 0),
        (Kind::Sphere, 4),
        (Kind::Capsule, 7),
        (Kind::Cylinder, 7),
        (Kind::Cone, 7),
        (Kind::Ellipsoid, 12),
        (Kind::OrientedBox, 12),
        (Kind::TruncatedCone, 8),
    ];
    let known = usize::try_from(kind).ok().and_then(|kind| kinds.get(kind).copied());
    known.ok_or(Status::Kind.of(c"body.kind"))
}

/// The point that begins at a number.
fn point<V: Vector>(p: &[V::Scalar; 12], at: usize) -> V {
    let number = |n: usize| p.get(n).copied().unwrap_or(V::Scalar::ZERO);
    V::new(number(at), number(at + 1), number(at + 2))
}

/// Kind and numbers of a body, all of them finite.
fn numbers<R: Real>(body: &Body<R>) -> Answer<Kind> {
    let (kind, used) = used(body.kind)?;
    all(body.p.get(..used).unwrap_or_default(), Real::is_finite, c"body.p")?;
    all(&[body.round], |round| round >= R::ZERO && round.is_finite(), c"body.round")?;
    Ok(kind)
}

/// How far the half axes of an ellipsoid may be from right angles, in units of epsilon times their lengths.
const ANGLE_IN_EPSILONS: f64 = 64.0;

/// An ellipsoid from its half axes.
fn ellipsoid<V: Vector>(center: V, half_axes: [V; 3]) -> Answer<Transformed<Ellipsoid<V>>> {
    let mut units = [V::ZERO; 3];
    let lengths = half_axes.map(Vector::length);
    for (unit, (axis, length)) in units.iter_mut().zip(half_axes.into_iter().zip(lengths)) {
        if !(length > V::Scalar::ZERO) {
            return Err(Status::Body.of(c"body.p"));
        }
        let [x, y, z] = axis.to_array();
        *unit = V::new(x / length, y / length, z / length);
    }
    let [u, v, w] = units;
    let near = V::Scalar::from_f64(ANGLE_IN_EPSILONS) * V::Scalar::EPSILON;
    if ![u.dot(v), v.dot(w), w.dot(u)].into_iter().all(|cosine| cosine.abs() <= near) {
        return Err(Status::Body.of(c"body.p"));
    }
    let semi_axes = V::new(lengths[0], lengths[1], lengths[2]);
    let shape = Ellipsoid { center: V::ZERO, semi_axes };
    Ok(Transformed::new(shape, units, V::splat(V::Scalar::ONE), center))
}

/// A body as GJK takes it.
unsafe fn any_body<'a, R: Real>(body: &Body<R>) -> Answer<AnyBody<'a, R::Vector>> {
    const { assert!(same_layout::<R::Vector, R, 3>()) }
    let (kind, p) = (numbers(body)?, &body.p);
    let a = |at| point::<R::Vector>(p, at);
    let shape: AnyShape<'a, R::Vector> = match kind {
        Kind::Point => Point(a(0)).into(),
        Kind::Segment => Segment { from: a(0), to: a(3) }.into(),
        Kind::Triangle => Triangle { a: a(0), b: a(3), c: a(6) }.into(),
        Kind::Box => Aabb { min: a(0), max: a(3) }.into(),
        Kind::Sphere => Sphere { center: a(0), radius: p[3] }.into(),
        Kind::Capsule => Capsule { from: a(0), to: a(3), radius: p[6] }.into(),
        Kind::Cylinder => Cylinder::new(a(0), a(3), p[6]).into(),
        Kind::Cone => Cone::new(a(0), a(3), p[6]).into(),
        Kind::TruncatedCone => Cone::truncated(a(0), a(3), p[6], p[7]).into(),
        Kind::OrientedBox => OrientedBox { center: a(0), half_axes: [a(3), a(6), a(9)] }.into(),
        Kind::Ellipsoid => {
            let turned = ellipsoid(a(0), [a(3), a(6), a(9)])?;
            let axis = |at: usize| {
                let ([x, y, z], length) = (a(at).to_array(), a(at).length());
                R::Vector::new(x / length, y / length, z / length)
            };
            return Ok(AnyBody::new(*turned.shape())?.posed([axis(3), axis(6), axis(9)], a(0))?.rounded(body.round)?);
        }
        Kind::Hull => {
            let Some(count) = body.count.checked_mul(3) else { return Err(Status::Length.of(c"body.count")) };
            let numbers = unsafe { Arrays::new().read(body.points, count, c"body.points")? };
            all(numbers, Real::is_finite, c"body.points")?;
            // Vectors have the layout of three numbers.
            let points = unsafe { slice::from_raw_parts(numbers.as_ptr().cast::<R::Vector>(), body.count) };
            Hull::new(points).into()
        }
    };
    Ok(AnyBody::new(shape)?.rounded(body.round)?)
}

/// A body as closed forms take it.
pub fn solid<R: Real>(body: &Body<R>) -> Answer<RoundSolid<R::Vector>> {
    let (kind, p) = (numbers(body)?, &body.p);
    let a = |at| point::<R::Vector>(p, at);
    let shape = match kind {
        Kind::Sphere => RoundShape::Sphere(Sphere { center: a(0), radius: p[3] }),
        Kind::Capsule => RoundShape::Capsule(Capsule { from: a(0), to: a(3), radius: p[6] }),
        Kind::Cylinder => RoundShape::Cylinder(Cylinder::new(a(0), a(3), p[6])),
        Kind::Cone => RoundShape::Cone(Cone::new(a(0), a(3), p[6])),
        Kind::TruncatedCone => RoundShape::Cone(Cone::truncated(a(0), a(3), p[6], p[7])),
        Kind::Ellipsoid => RoundShape::Ellipsoid(ellipsoid(a(0), [a(3), a(6), a(9)])?),
        _ => return Err(Status::Kind.of(c"solids.kind")),
    };
    if body.round != R::ZERO {
        return Err(Status::Value.of(c"solids.round"));
    }
    RoundSolid::new(shape).ok_or(Status::Body.of(c"solids.p"))
}

/// Two bodies and, perhaps, a direction to start with.
#[derive(Clone, Copy)]
pub struct Pair<R> {
    pub a: *const Body<R>,
    pub b: *const Body<R>,
    pub hint: *const R,
}

impl<R: Real> Pair<R> {
    unsafe fn ask<T>(&self, question: impl FnOnce(BodyQuery<R::Vector>) -> T) -> Answer<T> {
        let (a, b) = unsafe { (body(self.a, c"a", 0)?, body(self.b, c"b", 1)?) };
        let mut query = BodyQuery::new(&a, &b);
        if !self.hint.is_null() {
            let hint = unsafe { self.hint.cast::<[R; 3]>().read_unaligned() };
            all(&hint, Real::is_finite, c"hint")?;
            if hint != [R::ZERO; 3] {
                query = query.hint(R::Vector::from_array(hint));
            }
        }
        Ok(question(query))
    }
}

/// A body of a pair.
unsafe fn body<'a, R: Real>(at: *const Body<R>, name: &'static CStr, index: usize) -> Answer<AnyBody<'a, R::Vector>> {
    unsafe { any_body(&given(at, name)?).map_err(|refusal| refusal.index(index)) }
}

/// Whether two bodies meet.
///
/// # Safety
/// Pointers are null or of what they say; those of hulls are as [`Arrays::read`] asks.
pub unsafe fn meets<R: Real>(pair: &Pair<R>, contact: *mut i32) -> Answer {
    if contact.is_null() {
        return Err(Status::Null.of(c"contact"));
    }
    let found = unsafe { pair.ask(|query| query.contact())? };
    let found = match found {
        Some(exact::Contact::Disjoint) => Contact::Apart,
        Some(exact::Contact::Touching) => Contact::Touching,
        Some(exact::Contact::Overlapping) => Contact::Overlapping,
        None => Contact::Undecided,
    };
    unsafe { give(contact, found as i32) };
    Ok(())
}

/// How far apart two bodies are.
///
/// # Safety
/// As of [`meets`].
pub unsafe fn distance<R: Real>(pair: &Pair<R>, distance: *mut Distance<R>) -> Answer {
    if distance.is_null() {
        return Err(Status::Null.of(c"distance"));
    }
    unsafe { pair.ask(|query| give(distance, told(query.distance()))) }
}

fn told<R: Real>(found: Clearance<R::Vector>) -> Distance<R> {
    let none = Distance::default();
    match found {
        Clearance::Apart { distance, a, b, lower, upper } => {
            Distance { contact: Contact::Apart as i32, distance, lower, upper, a: a.to_array(), b: b.to_array() }
        }
        Clearance::Touching => Distance { contact: Contact::Touching as i32, ..none },
        Clearance::Overlapping => Distance { contact: Contact::Overlapping as i32, ..none },
        Clearance::Undecided { lower, upper, .. } => {
            Distance { contact: Contact::Undecided as i32, lower, upper, ..none }
        }
        _ => Distance { contact: Contact::Undecided as i32, upper: R::INFINITY, ..none },
    }
}
