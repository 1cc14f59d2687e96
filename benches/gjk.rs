//! The boolean and the distance against parry3d-f64 and parry3d, in one run: `cargo bench -p voidage-benches --bench gjk [-- NAME]`.
//!
//! Instructions per query: `valgrind --tool=callgrind` on the bench's binary with `--rounds=1 NAME`, then the inclusive cost of `ours_boolean`
//! and the like divided by the 4096 pairs (each is run twice: once timed, once for the counts).
//!
//! `parry` is its GJK for these two shapes, called without dynamic dispatch; `special` its own test for the pair, where it has one.

use std::cell::Cell;
use std::hint::black_box;

use glam::DVec3;
use parry3d_f64::math::{Pose as ParryPose, Rotation};
use parry3d_f64::query::details as parry;
use parry3d_f64::shape::{ConvexPolyhedron, Cuboid, SupportMap};
use voidage_benches::compare;
use voidage_core::convex::gjk::{Distance, Intersection, distance, intersect};
use voidage_core::convex::sat::{BoxTriangle, box_triangle};
use voidage_core::convex::shape::{Hull, OrientedBox, Triangle};
use voidage_core::convex::support::{Support, SupportPoint};
use voidage_core::number::aabb::Aabb;
use voidage_tests::pairs::{Geodesic, Nearness, Pose, approach, boxes, triangles};
use voidage_tests::random::Random;

const PAIRS: usize = 4096;

/// How often each way is timed: `--rounds=N`, or 21 times.
fn rounds() -> usize {
    std::env::args().find_map(|arg| arg.strip_prefix("--rounds=")?.parse().ok()).unwrap_or(21)
}

/// Whether a row is asked for.
fn wanted(name: &str) -> bool {
    let mut only = std::env::args().skip(1).filter(|arg| !arg.starts_with('-')).peekable();
    only.peek().is_none() || only.any(|only| name.contains(&only))
}

/// A body that counts what is asked of it.
struct Counted<'a, S>(&'a S, &'a Cell<usize>);

impl<S: Support> Support for Counted<'_, S> {
    type Vector = S::Vector;
    const ROUNDED: bool = S::ROUNDED;
    fn support(&self, direction: S::Vector, start: u32) -> SupportPoint<S::Vector> {
        self.1.set(self.1.get() + 1);
        self.0.support(direction, start)
    }
    fn farther(&self, direction: S::Vector, found: u32) -> Option<SupportPoint<S::Vector>> {
        self.0.farther(direction, found)
    }
    fn center(&self) -> S::Vector {
        self.0.center()
    }
    fn extent(&self) -> <S::Vector as voidage_core::number::real::Vector>::Scalar {
        self.0.extent()
    }
    fn radius(&self) -> <S::Vector as voidage_core::number::real::Vector>::Scalar {
        self.0.radius()
    }
    fn slack(&self) -> <S::Vector as voidage_core::number::real::Vector>::Scalar {
        self.0.slack()
    }
}

/// The peer's vector; it comes from another version of glam.
fn peer(v: DVec3) -> parry3d_f64::math::Vector {
    parry3d_f64::math::Vector::from_array(v.to_array())
}

fn meets<A: Support<Vector = DVec3>, B: Support<Vector = DVec3>>(a: &A, b: &B) -> usize {
    usize::from(matches!(intersect(a, b, None), Intersection::Overlapping { .. }))
}

#[inline(never)]
fn ours_boolean<A: Support<Vector = DVec3>, B: Support<Vector = DVec3>>(pairs: &[(A, B)]) -> usize {
    pairs.iter().map(|(a, b)| meets(black_box(a), black_box(b))).sum()
}

#[inline(never)]
fn parry_boolean<P: SupportMap, Q: SupportMap>(pairs: &[(ParryPose, P, Q)]) -> usize {
    let meet = |(p, a, b): &(ParryPose, P, Q)| parry::intersection_test_support_map_support_map(black_box(p), a, b);
    pairs.iter().map(|pair| usize::from(meet(pair))).sum()
}

/// One line of the table: our pairs, and the same ones for parry, each relative to the first body.
fn row<A, B, P, Q>(
    name: &str,
    pairs: &[(A, B)],
    theirs: &[(ParryPose, P, Q)],
    special: Option<fn(&ParryPose, &P, &Q) -> bool>,
) where
    A: Support<Vector = DVec3>,
    B: Support<Vector = DVec3>,
    P: SupportMap,
    Q: SupportMap,
{
    if !wanted(name) {
        return;
    }
    let sum = |each: &dyn Fn(usize) -> usize| (0..pairs.len()).map(each).sum::<usize>();
    let mut ours = || ours_boolean(pairs);
    let mut gjk = || parry_boolean(theirs);
    let mut own = || {
        let Some(test) = special else { return 0 };
        theirs.iter().map(|(p, a, b)| usize::from(test(black_box(p), a, b))).sum()
    };
    let mut ours_distance = || {
        let far = |(a, b): &(A, B)| matches!(distance(black_box(a), black_box(b), None), Distance::Separated { .. });
        pairs.iter().map(|p| usize::from(far(p))).sum()
    };
    let mut gjk_distance = || {
        let far = |(p, a, b): &(ParryPose, P, Q)| parry::distance_support_map_support_map(black_box(p), a, b) > 0.0;
        theirs.iter().map(|p| usize::from(far(p))).sum()
    };
    let times =
        compare(pairs.len(), rounds(), &mut [&mut ours, &mut gjk, &mut own, &mut ours_distance, &mut gjk_distance]);
    let asked = Cell::new(0);
    let undecided = sum(&|i| {
        let (a, b) = &pairs[i];
        let found = intersect(&Counted(a, &asked), &Counted(b, &asked), None);
        usize::from(matches!(found, Intersection::Undecided { .. }))
    });
    let supports = asked.get() as f64 / 2.0 / pairs.len() as f64;
    let special = if special.is_some() { format!("{:7.1}", times[2]) } else { "      -".to_string() };
    println!(
        "{name:22} {:7.1} {:7.1} {:5.2}x {special} {supports:6.2} {:8.1} {:8.1} {:5.2}x   {:5} of {:5} meet, parry {:5}, undecided {undecided}",
        times[0],
        times[1],
        times[1] / times[0],
        times[3],
        times[4],
        times[4] / times[3],
        ours(),
        pairs.len(),
        gjk(),
    );
}

fn parry_pose(a: &Pose, b: &Pose) -> ParryPose {
    let place = |p: &Pose| {
        let [x, y, z, w] = p.rotation.to_array();
        ParryPose::from_parts(peer(p.center), Rotation::from_xyzw(x, y, z, w))
    };
    place(a).inv_mul(&place(b))
}

fn main() {
    println!("ns per query (f64)      ours   parry  ratio  special  steps distance    parry  ratio");
    for (name, nearness) in [
        ("box-box separated", Nearness::Separated),
        ("box-box near", Nearness::Near),
        ("box-box overlapping", Nearness::Overlapping),
    ] {
        let poses = boxes(7, PAIRS, nearness);
        let ours: Vec<_> = poses.iter().map(|(a, b)| (a.body(), b.body())).collect();
        let theirs: Vec<_> = poses
            .iter()
            .map(|(a, b)| (parry_pose(a, b), Cuboid::new(peer(a.half)), Cuboid::new(peer(b.half))))
            .collect();
        row(name, &ours, &theirs, Some(parry::intersection_test_cuboid_cuboid));

        let corners: Vec<_> = poses.iter().map(|(a, b)| (a.body().corners(), b.body().corners())).collect();
        let ours: Vec<_> = corners.iter().map(|(a, b)| (Hull::new(a), Hull::new(b))).collect();
        let hull =
            |corners: &[DVec3; 8]| ConvexPolyhedron::from_convex_hull(&corners.map(peer)).expect("eight corners");
        // Corners are where the box is: parry needs no pose.
        let theirs: Vec<_> = corners.iter().map(|(a, b)| (ParryPose::IDENTITY, hull(a), hull(b))).collect();
        row(&format!("{name} hulls"), &ours, &theirs, None);
    }

    let cell = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
    let corners = triangles(11, PAIRS);
    let ours: Vec<_> = corners.iter().map(|&[a, b, c]| (cell, Triangle { a, b, c })).collect();
    let theirs: Vec<_> = corners
        .iter()
        .map(|&[a, b, c]| {
            let triangle = parry3d_f64::shape::Triangle::new(peer(a), peer(b), peer(c));
            (ParryPose::from_translation(peer(DVec3::splat(-0.5))), Cuboid::new(peer(DVec3::splat(0.5))), triangle)
        })
        .collect();
    row("cell-triangle", &ours, &theirs, Some(parry::intersection_test_cuboid_triangle));
    thirteen_directions(&ours, &theirs);

    for (n, count) in [(2, 42), (4, 162), (6, 362)] {
        let sphere = Geodesic::new(n);
        assert_eq!(sphere.vertices.len(), count);
        let polyhedron =
            ConvexPolyhedron::from_convex_hull(&sphere.vertices.iter().copied().map(peer).collect::<Vec<_>>())
                .expect("a hull");
        for (name, nearness) in [("near", Nearness::Near), ("separated", Nearness::Separated)] {
            let mut random = Random::new(5);
            let edges = sphere.adjacency();
            let hull = Hull::new(&sphere.vertices).with_adjacency(&edges);
            let poses = boxes(13, PAIRS, nearness).into_iter().map(|(_, mut b)| {
                b.center = DVec3::from_array(random.on_sphere()) * 5.0;
                if nearness == Nearness::Near {
                    let gap = if random.below(2) == 0 { 1e-3 } else { -1e-3 };
                    b.center += approach(&hull, &b.body(), gap);
                }
                b
            });
            let poses: Vec<_> = poses.collect();
            let ours: Vec<_> = poses.iter().map(|b| (b.body(), hull)).collect();
            let origin = Pose { half: DVec3::ONE, rotation: glam::DQuat::IDENTITY, center: DVec3::ZERO };
            let theirs: Vec<_> =
                poses.iter().map(|b| (parry_pose(b, &origin), Cuboid::new(peer(b.half)), polyhedron.clone())).collect();
            row(&format!("box-hull{count} {name}"), &ours, &theirs, None);
        }
    }

    octree();
    single_precision();
}

/// The fast path for a cell and a triangle against parry's own test for that pair.
fn thirteen_directions(
    ours: &[(Aabb<DVec3>, Triangle<DVec3>)],
    theirs: &[(ParryPose, Cuboid, parry3d_f64::shape::Triangle)],
) {
    if !wanted("box_triangle") {
        return;
    }
    let (cell, mut undecided) = (ours[0].0, 0);
    let mut fast = || {
        let meet = |t| matches!(box_triangle(black_box(&cell), black_box(t)), BoxTriangle::Overlapping);
        ours.iter().map(|(_, t)| usize::from(meet(t))).sum()
    };
    let mut special = || {
        theirs.iter().map(|(p, a, b)| usize::from(parry::intersection_test_cuboid_triangle(black_box(p), a, b))).sum()
    };
    let times = compare(ours.len(), rounds(), &mut [&mut fast, &mut special]);
    for (_, triangle) in ours {
        undecided += usize::from(box_triangle(&cell, triangle) == BoxTriangle::Undecided);
    }
    println!(
        "{:22} {:7.1} {:7.1} {:5.2}x   {} of {} meet, parry {}, undecided {undecided}",
        "box_triangle",
        times[0],
        times[1],
        times[1] / times[0],
        fast(),
        ours.len(),
        special()
    );
}

/// Cells of 32³ in Morton order against a ball of 362 vertices that fills most of them, with and without the last axis as a hint.
fn octree() {
    if !wanted("octree Morton") {
        return;
    }
    let sphere = Geodesic::new(6);
    let edges = sphere.adjacency();
    let hull = Hull::new(&sphere.vertices).with_adjacency(&edges);
    let polyhedron = ConvexPolyhedron::from_convex_hull(&sphere.vertices.iter().copied().map(peer).collect::<Vec<_>>())
        .expect("a hull");
    let cells: Vec<Aabb<DVec3>> = (0..1u32 << 15)
        .map(|code| {
            let bits = |shift: u32| (0..5).map(|i| (code >> (3 * i + shift) & 1) << i).sum::<u32>();
            let min = DVec3::new(bits(0).into(), bits(1).into(), bits(2).into()) / 16.0 * 1.2 - DVec3::splat(1.2);
            Aabb { min, max: min + DVec3::splat(1.2 / 16.0) }
        })
        .collect();
    let mut plain = || cells.iter().map(|cell| meets(cell, &hull)).sum();
    let mut hinted = || {
        let mut hint = None;
        let meets = |cell| match intersect(cell, &hull, hint) {
            Intersection::Apart { axis } => {
                hint = Some(axis);
                0
            }
            Intersection::Overlapping { .. } => 1,
            Intersection::Undecided { .. } => 0,
        };
        cells.iter().map(meets).sum()
    };
    let half = Cuboid::new(peer(DVec3::splat(0.6 / 16.0)));
    let mut gjk = || {
        cells
            .iter()
            .map(|cell| {
                let pose = ParryPose::from_translation(peer(-cell.center()));
                usize::from(parry::intersection_test_support_map_support_map(&pose, &half, &polyhedron))
            })
            .sum()
    };
    let counts = [plain(), hinted(), gjk()];
    let times = compare(cells.len(), 5, &mut [&mut plain, &mut hinted, &mut gjk]);
    println!(
        "octree Morton          {:7.1} with hint {:7.1} parry {:7.1} ({:.2}x)   meet {counts:?}",
        times[0],
        times[1],
        times[2],
        times[2] / times[1].min(times[0])
    );
}

/// The same boxes in single precision, against parry3d.
fn single_precision() {
    use glam::Vec3;
    use parry3d::math::{Pose, Rotation, Vector};
    let peer = |v: DVec3| Vector::from_array(v.as_vec3().to_array());
    for (name, nearness) in [
        ("box-box separated f32", Nearness::Separated),
        ("box-box near f32", Nearness::Near),
        ("box-box overlapping f32", Nearness::Overlapping),
    ] {
        if !wanted(name) {
            continue;
        }
        let poses = boxes(7, PAIRS, nearness);
        let body = |p: &voidage_tests::pairs::Pose| {
            let b = p.body();
            OrientedBox { center: b.center.as_vec3(), half_axes: b.half_axes.map(|u| u.as_vec3()) }
        };
        let ours: Vec<(OrientedBox<Vec3>, OrientedBox<Vec3>)> = poses.iter().map(|(a, b)| (body(a), body(b))).collect();
        let place = |p: &voidage_tests::pairs::Pose| {
            let [x, y, z, w] = p.rotation.as_quat().to_array();
            Pose::from_parts(peer(p.center), Rotation::from_xyzw(x, y, z, w))
        };
        let cuboid = |half: DVec3| parry3d::shape::Cuboid::new(peer(half));
        let theirs: Vec<_> =
            poses.iter().map(|(a, b)| (place(a).inv_mul(&place(b)), cuboid(a.half), cuboid(b.half))).collect();
        let mut boolean = || {
            let meet = |(a, b): &(_, _)| {
                matches!(intersect(black_box(a), black_box(b), None), Intersection::Overlapping { .. })
            };
            ours.iter().map(|pair| usize::from(meet(pair))).sum()
        };
        let mut gjk = || {
            use parry3d::query::details::intersection_test_support_map_support_map as test;
            theirs.iter().map(|(p, a, b)| usize::from(test(black_box(p), a, b))).sum()
        };
        let times = compare(PAIRS, rounds(), &mut [&mut boolean, &mut gjk]);
        println!(
            "{name:22} {:7.1} {:7.1} {:5.2}x   meet {} {}",
            times[0],
            times[1],
            times[1] / times[0],
            boolean(),
            gjk()
        );
    }
}
