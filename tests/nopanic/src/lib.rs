//! Every query in both precisions behind a C symbol, without std: what is left after linking is what they need.
#![no_std]

mod layers;

use glam::{DVec3, Vec3};
use voidage_core::number::aabb::Aabb;
use voidage_core::convex::containment::{Containment, Contains, contains};
use voidage_core::convex::exact;
use voidage_core::convex::gjk::{Distance, Intersection, distance, intersect, separates};
use voidage_core::number::real::{Real, Vector};
use voidage_core::convex::sat::{BoxTriangle, box_triangle};
use voidage_core::convex::shape::{
    Adjacency, Capsule, Cone, Cylinder, Ellipsoid, Hull, OrientedBox, Point, Segment, Sphere, Triangle, Vertices,
};
use voidage_core::convex::support::{MinkowskiDifference, Rounded, Support, Transformed};

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}

fn asked<A: Support, B: Support<Vector = A::Vector>>(a: &A, b: &B, hint: A::Vector) -> u32 {
    let boolean = match intersect(a, b, Some(hint)) {
        Intersection::Apart { axis } => u32::from(separates(a, b, axis)),
        Intersection::Overlapping { .. } => 2,
        Intersection::Undecided { .. } => 3,
    };
    let far = match distance(a, b, None) {
        Distance::Separated { distance, .. } => distance.to_f64() as u32,
        Distance::Overlapping { .. } => 5,
        Distance::Undecided { upper, .. } => upper.to_f64() as u32,
    };
    boolean ^ far << 8
}

fn exactly<A: Vertices, B: Vertices<Vector = A::Vector>>(a: &A, b: &B, hint: A::Vector) -> u32 {
    let proof = match exact::relation(a, b, Some(hint)) {
        Ok(exact::Relation::Disjoint(axis) | exact::Relation::Touching(axis)) => u32::from(axis.gap(a, b).is_ok()),
        Ok(exact::Relation::Overlapping(points)) => u32::from(points.holds(a, b) == Ok(true)),
        Err(exact::NotFinite) => 4,
    };
    let far = exact::distance(a, b, Some(hint)).map_or(0, |nearest| nearest.distance as u32);
    proof ^ far << 4 ^ u32::from(exact::settle(a, b, None).is_ok())
}

fn inside<S: Contains>(body: &S, cell: &Aabb<S::Vector>) -> u32 {
    match contains(body, cell) {
        Containment::Inside => 0,
        Containment::Outside { .. } => 1,
        Containment::Undecided => 2,
    }
}

fn all<V: Vector>(p: &[V], q: &[V], offsets: &[u32], neighbours: &[u32], r: V::Scalar) -> u32 {
    let (Some(&a), Some(&b), Some(&c)) = (p.first(), p.last(), q.first()) else { return 0 };
    let (cell, triangle) = (Aabb { min: a, max: b }, Triangle { a, b, c });
    let edges = Adjacency::new(p, offsets, neighbours);
    let hull = Hull::new(p).with_adjacency(&edges);
    let other = Hull::new(q);
    let boxed = OrientedBox { center: a, half_axes: [a, b, c] };
    let (sphere, capsule) = (Sphere { center: a, radius: r }, Capsule { from: a, to: b, radius: r });
    let (ellipsoid, cylinder, cone) =
        (Ellipsoid { center: a, semi_axes: b }, Cylinder::new(a, b, r), Cone::new(b, c, r));
    let moved = Transformed::new(cylinder, [a, b, c], c, a);
    let round = Rounded { core: cone, radius: r };
    let sat = matches!(box_triangle(&cell, &triangle), BoxTriangle::Overlapping);
    asked(&hull, &other, c)
        ^ asked(&cell, &triangle, c)
        ^ asked(&boxed, &hull, c)
        ^ asked(&sphere, &capsule, c)
        ^ asked(&ellipsoid, &cylinder, c)
        ^ asked(&moved, &round, c)
        ^ asked(&Segment { from: a, to: b }, &Point(c), c)
        ^ asked(&MinkowskiDifference { a: cone, b: other }, &cell, c)
        ^ exactly(&hull, &other, c)
        ^ exactly(&cell, &triangle, c)
        ^ inside(&hull, &cell)
        ^ inside(&sphere, &cell)
        ^ inside(&ellipsoid, &cell)
        ^ inside(&boxed, &cell)
        ^ inside(&cell, &cell)
        ^ u32::from(sat)
}

/// All queries in double precision.
#[unsafe(no_mangle)]
pub extern "C" fn nopanic_f64(p: &[DVec3; 40], n: usize, edges: &[u32; 64], r: f64) -> u32 {
    let (a, b) = p.split_at(20);
    let (a, b) = (a.get(..n).unwrap_or(a), b.get(..n).unwrap_or(b));
    let (offsets, neighbours) = edges.split_at(20);
    all(a, b, offsets, neighbours, r)
}

/// All queries in single precision.
#[unsafe(no_mangle)]
pub extern "C" fn nopanic_f32(p: &[Vec3; 40], n: usize, edges: &[u32; 64], r: f32) -> u32 {
    let (a, b) = p.split_at(20);
    let (a, b) = (a.get(..n).unwrap_or(a), b.get(..n).unwrap_or(b));
    let (offsets, neighbours) = edges.split_at(20);
    all(a, b, offsets, neighbours, r)
}
