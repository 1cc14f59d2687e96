//! Numbers that are none, and numbers too large to compute with.

use crate::command::stress::case::{Effort, Numbers, StressCase, at_least, at_most};
use crate::command::stress::kit::doors::contact;
use glam::DVec3;
use voidage_core::convex::exact::{self, Contact};
use voidage_core::convex::gjk::{Intersection, intersect};
use voidage_core::convex::shape::{
    Capsule, Cone, Cylinder, Ellipsoid, Hull, OrientedBox, Point, Segment, Sphere, Triangle,
};
use voidage_core::convex::{AnyBody, AnyShape, BodyError};
use voidage_core::number::aabb::Aabb;

/// The cases.
pub const CASES: &[StressCase] = &[
    StressCase::new(
        "gjk/non-finite",
        "NaN and infinities in each number of eleven shapes, and in the points of hulls: none is a body, none has an answer",
        &[
            at_most(0.0, "bodies accepted"),
            at_most(0.0, "answers of the core"),
            at_most(0.0, "wrong answers about the same bodies before"),
            at_least(200.0, "bodies tried"),
        ],
        non_finite,
    ),
    StressCase::new(
        "gjk/huge",
        "eleven shapes of sizes up to 1e308: refused as too large, or apart from and meeting bodies as they are",
        &[at_most(0.0, "wrong answers"), at_least(100.0, "bodies accepted")],
        huge,
    ),
];

/// So many numbers the largest of the shapes takes.
const MOST: usize = 12;

/// How many numbers a kind of shape takes.
const KINDS: [usize; 12] = [3, 6, 9, 6, 12, 4, 7, 6, 7, 7, 8, 12];

/// A body of a kind from its numbers.
fn body<'a>(kind: usize, n: &[f64; MOST], corners: &'a mut [DVec3; 4]) -> Result<AnyBody<'a, DVec3>, BodyError> {
    let v = |at: usize| DVec3::new(n[at], n[at + 1], n[at + 2]);
    *corners = [v(0), v(3), v(6), v(9)];
    let shape: AnyShape<'a, DVec3> = match kind {
        0 => Point(v(0)).into(),
        1 => Segment { from: v(0), to: v(3) }.into(),
        2 => Triangle { a: v(0), b: v(3), c: v(6) }.into(),
        3 => Aabb { min: v(0), max: v(3) }.into(),
        4 => OrientedBox { center: v(0), half_axes: [v(3), v(6), v(9)] }.into(),
        5 => Sphere { center: v(0), radius: n[3] }.into(),
        6 => Capsule { from: v(0), to: v(3), radius: n[6] }.into(),
        7 => Ellipsoid { center: v(0), semi_axes: v(3) }.into(),
        8 => Cylinder::new(v(0), v(3), n[6]).into(),
        9 => Cone::new(v(0), v(3), n[6]).into(),
        10 => Cone::truncated(v(0), v(3), n[6], n[7]).into(),
        _ => Hull::new(&corners[..]).into(),
    };
    AnyBody::new(shape)
}

/// Numbers that make a body of every kind, within about 12 of the origin.
const GOOD: [f64; MOST] = [0.5, 1.0, 2.0, 3.5, 4.0, 5.0, 6.0, 7.5, 9.0, 1.0, 2.5, 4.0];

fn non_finite(_: Effort) -> Numbers {
    let (mut accepted, mut answers, mut wrong, mut tried) = (0, 0, 0, 0);
    let mut corners = [DVec3::ZERO; 4];
    let around = AnyBody::new(Aabb { min: DVec3::splat(-33.0), max: DVec3::splat(33.0) })?;
    let cell = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
    for (kind, count) in KINDS.into_iter().enumerate() {
        for at in 0..count {
            for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let mut numbers = GOOD;
                numbers[at] = bad;
                tried += 1;
                wrong += usize::from(contact(&body(kind, &GOOD, &mut corners)?, &around) != Some(Contact::Overlapping));
                accepted += usize::from(body(kind, &numbers, &mut corners).is_ok());
            }
        }
    }
    for at in 0..MOST {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut numbers = GOOD;
            numbers[at] = bad;
            let points: Vec<DVec3> = numbers.chunks_exact(3).map(DVec3::from_slice).collect();
            let hull = Hull::new(&points);
            let told = !matches!(intersect(&hull, &cell, None), Intersection::Undecided { .. });
            answers += usize::from(told) + usize::from(exact::contact(&hull, &cell, None).is_ok());
        }
    }
    Ok([accepted, answers, wrong, tried].map(|n| n as f64).to_vec())
}

fn huge(_: Effort) -> Numbers {
    let (mut wrong, mut accepted) = (0, 0);
    let mut corners = [DVec3::ZERO; 4];
    for kind in 0..KINDS.len() {
        for exponent in (0..=308).step_by(14) {
            let size = 10f64.powi(exponent);
            let numbers = GOOD.map(|x| x * size);
            let Ok(body) = body(kind, &numbers, &mut corners) else { continue };
            accepted += 1;
            // All of them lie within 32 sizes of the origin, and none reaches below 32 sizes along any axis.
            let far = AnyBody::new(Point(DVec3::splat(-32.0 * size)));
            wrong += usize::from(far.is_ok_and(|far| contact(&body, &far) != Some(Contact::Disjoint)));
            let around = AnyBody::new(Aabb { min: DVec3::splat(-33.0 * size), max: DVec3::splat(33.0 * size) });
            let meets = |around| !matches!(contact(&body, &around), Some(Contact::Overlapping) | None);
            wrong += usize::from(around.is_ok_and(meets));
        }
    }
    Ok([wrong, accepted].map(|n| n as f64).to_vec())
}
