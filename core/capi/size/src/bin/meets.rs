//! The same, told exactly where rounding hides it.
#![no_std]
#![no_main]

use core::hint::black_box;
use voidage_core::convex::shape::Sphere;
use voidage_core::convex::{AnyBody, AnyShape, BodyQuery, exact::Contact};
use voidage_size::{Vector, any, point, program};

fn meet() -> Option<Contact> {
    let shape: AnyShape<Vector> = Sphere { center: point(), radius: any() }.into();
    let (a, b) = (AnyBody::new(black_box(shape)).ok()?, AnyBody::new(black_box(shape)).ok()?);
    BodyQuery::new(&a, &b).contact()
}

program!(meet);
