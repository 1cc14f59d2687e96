//! Do two bodies of any kind meet? By GJK.
#![no_std]
#![no_main]

use core::hint::black_box;
use voidage_core::convex::gjk::{Intersection, intersect};
use voidage_core::convex::shape::Sphere;
use voidage_core::convex::{AnyBody, AnyShape};
use voidage_size::{Vector, any, point, program};

fn meet() -> Option<bool> {
    let shape: AnyShape<Vector> = Sphere { center: point(), radius: any() }.into();
    let (a, b) = (AnyBody::new(black_box(shape)).ok()?, AnyBody::new(black_box(shape)).ok()?);
    Some(matches!(intersect(&a, &b, None), Intersection::Apart { .. }))
}

program!(meet);
