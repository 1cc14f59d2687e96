//! Every query in both precisions behind a C symbol, without std: what is left after linking is what they need.
#![no_std]

mod layers;
mod round;

use glam::{DVec3, Vec3};
use voidage_core::convex::containment::{Containment, Contains, contains};
use voidage_core::convex::gjk::{Distance, Intersection, distance, intersect, separates};
use voidage_core::convex::sat::{BoxTriangle, box_triangle};
use voidage_core::convex::shape::{
    Adjacency, Capsule, Cone, Cylinder, Ellipsoid, Hull, OrientedBox, Point, Segment, Sphere, Triangle, Vertices,
};
use voidage_core::convex::support::{MinkowskiDifference, Rounded, Support, Transformed};
use voidage_core::convex::{self, exact};
use voidage_core::convex::{AnyBody, AnyShape, Clearance, chord::Chords, polytope};
use voidage_core::grid::{
    Grid,
    cell_range::{CellRange, RangeKind},
};
use voidage_core::number::aabb::Aabb;
use voidage_core::number::real::{Real, Vector};
use voidage_core::subdivide::{
    self, Candidate, ClosedSurface, LeafRule, Subdividable, SubdivisionMemory, SubdivisionRule,
};

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
    proof ^ far << 4 ^ u32::from(exact::contact(a, b, None).is_ok())
}

fn inside<S: Contains>(body: &S, cell: &Aabb<S::Vector>) -> u32 {
    match contains(body, cell) {
        Containment::Inside => 0,
        Containment::Outside { .. } => 1,
        Containment::Undecided => 2,
    }
}

/// The door to two bodies of any kind.
fn any<V: Vector>(a: AnyShape<V>, b: AnyShape<V>, axes: [V; 3], radius: V::Scalar) -> u32 {
    let Ok(a) = AnyBody::new(a) else { return 1 };
    let Ok(b) = AnyBody::new(b).and_then(|b| b.posed(axes, axes[0])?.posed(axes, axes[1])?.rounded(radius)) else {
        return 2;
    };
    let near = match convex::distance(&a, &b) {
        Clearance::Apart { distance, .. } => distance.to_f64() as u32,
        Clearance::Touching => 1,
        _ => 3,
    };
    let cell = Aabb { min: axes[0], max: axes[1] };
    let meeting = convex::meets(&a, &b);
    let axis = if let convex::Meeting::Touching(axis) = &meeting { axis.to_array()[0] as u32 } else { 0 };
    near ^ axis ^ u32::from(meeting.contact().is_some()) << 8 ^ inside(&a, &cell) << 9
}

/// The shares of a grid's cells and faces.
fn divided<B: Subdividable>(
    bodies: &[B],
    edges: &[<B::Vector as Vector>::Scalar],
    range: CellRange,
    kind: RangeKind,
    numbers: &[u32],
    memory: &mut SubdivisionMemory<B::Vector>,
) -> u32 {
    let Ok(grid) = Grid::new(edges, edges, edges) else { return 0 };
    let (leaf, depth) = match numbers {
        [0, depth, ..] => (LeafRule::Solid, *depth),
        [1, depth, ..] => (LeafRule::Half, *depth),
        _ => (LeafRule::Plane, 3),
    };
    let rule = SubdivisionRule { leaf, depth, tol: Real::HALF };
    let mut sum = 0;
    let found = subdivide::subdivide(&grid, kind, range, bodies, rule, memory, |range, share| {
        sum ^= range.lo[0] ^ share.upper.to_f64() as u32;
    });
    found.map_or(1, |count| count.queries as u32) ^ sum
}

/// Subdivision of a surface, a polytope of it, and a curved body.
fn shares<V: Vector>(p: &[V], triangles: &[[V; 3]], edges: &[V::Scalar], numbers: &[u32], r: V::Scalar) -> u32 {
    let (&[i, j, k, l, m, n, axis, ..], &[a, b, ..]) = (numbers, p) else { return 0 };
    let range = CellRange { lo: [i, j, k], hi: [l, m, n] };
    let kind = if axis > 7 { RangeKind::Cells } else { RangeKind::Faces(axis as usize) };
    let (mut candidates, mut lists) = ([Candidate::default(); 40], [0; 64]);
    let mut memory = SubdivisionMemory { candidates: &mut candidates, facets: &mut lists };
    let mut facets = [polytope::Facet::none(); 16];
    let count = polytope::facets(p, triangles, &mut facets).unwrap_or(16);
    let body = polytope::Polytope::new(Hull::new(p), facets.get(..count).unwrap_or(&[]));
    divided(&[ClosedSurface::new(triangles)], edges, range, kind, numbers, &mut memory)
        ^ divided(&[body], edges, range, kind, numbers, &mut memory)
        ^ divided(&[Cone::new(a, b, r)], edges, range, kind, numbers, &mut memory)
        ^ divided(&[Cylinder::new(a, b, r)], edges, range, kind, numbers, &mut memory)
        ^ divided(&[Capsule { from: a, to: b, radius: r }], edges, range, kind, numbers, &mut memory)
        ^ divided(
            &[Transformed::new(Ellipsoid { center: a, semi_axes: b }, [a, b, a], b, a)],
            edges,
            range,
            kind,
            numbers,
            &mut memory,
        )
        ^ Chords::facet_count(&body) as u32
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
        ^ any(hull.into(), cell.into(), [a, b, c], r)
        ^ any(triangle.into(), cylinder.into(), [a, b, c], r)
}

/// All queries in double precision.
#[unsafe(no_mangle)]
pub extern "C" fn nopanic_f64(
    p: &[DVec3; 40],
    n: usize,
    edges: &[u32; 64],
    triangles: &[[DVec3; 3]; 20],
    widths: &[f64; 9],
    r: f64,
) -> u32 {
    let (a, b) = p.split_at(20);
    let (a, b) = (a.get(..n).unwrap_or(a), b.get(..n).unwrap_or(b));
    let (offsets, neighbours) = edges.split_at(20);
    all(a, b, offsets, neighbours, r) ^ shares(a, triangles, widths, offsets, r)
}

/// All queries in single precision.
#[unsafe(no_mangle)]
pub extern "C" fn nopanic_f32(
    p: &[Vec3; 40],
    n: usize,
    edges: &[u32; 64],
    triangles: &[[Vec3; 3]; 20],
    widths: &[f32; 9],
    r: f32,
) -> u32 {
    let (a, b) = p.split_at(20);
    let (a, b) = (a.get(..n).unwrap_or(a), b.get(..n).unwrap_or(b));
    let (offsets, neighbours) = edges.split_at(20);
    all(a, b, offsets, neighbours, r) ^ shares(a, triangles, widths, offsets, r)
}
