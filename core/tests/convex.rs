//! Two convex bodies: the door for any kind, its errors, and the signs at the bottom of it.

use core::error::Error;

use glam::{DVec3, Vec3};
use voidage_core::convex::exact::{self, Contact, Relation};
use voidage_core::convex::gjk::{self, Distance, Intersection};
use voidage_core::convex::polytope::{Facet, NotConvex, facets};
use voidage_core::convex::shape::{
    Capsule, Cone, Cylinder, Ellipsoid, Hull, OrientedBox, Point, Segment, Sphere, Triangle,
};
use voidage_core::convex::simplex::Simplex;
use voidage_core::convex::support::{Rounded, Support};
use voidage_core::convex::{self, AnyBody, AnyShape, BodyError, BodyQuery, Clearance, Meeting, SeparationProof};
use voidage_core::number::aabb::Aabb;
use voidage_core::number::real::Vector;

const AXES: [DVec3; 3] = [DVec3::X, DVec3::Y, DVec3::Z];
const TETRAHEDRON: [DVec3; 4] =
    [DVec3::new(1.0, 1.0, 1.0), DVec3::new(1.0, -1.0, -1.0), DVec3::new(-1.0, 1.0, -1.0), DVec3::new(-1.0, -1.0, 1.0)];

/// One shape of each kind, all around the same place, none larger than 4.
fn one_of_each(corners: &[DVec3]) -> [AnyShape<'_, DVec3>; 11] {
    let (a, b, c) = (DVec3::new(0.2, -0.4, 0.1), DVec3::new(0.5, 1.0, -0.3), DVec3::new(-0.7, 0.2, 0.6));
    [
        Point(a).into(),
        Segment { from: a, to: b }.into(),
        Triangle { a, b, c }.into(),
        Aabb { min: a.min(b), max: a.max(b) }.into(),
        OrientedBox { center: a, half_axes: [DVec3::X * 0.5, DVec3::Y, DVec3::Z * 0.25] }.into(),
        Sphere { center: a, radius: 0.5 }.into(),
        Capsule { from: a, to: b, radius: 0.25 }.into(),
        Ellipsoid { center: c, semi_axes: DVec3::new(0.5, 1.0, 0.75) }.into(),
        Cylinder::new(a, b, 0.5).into(),
        Cone::new(a, c, 0.5).into(),
        Hull::new(corners).into(),
    ]
}

#[test]
fn bodies_of_all_kinds_are_as_far_apart_as_they_were_moved() {
    for (n, shape) in one_of_each(&TETRAHEDRON).into_iter().enumerate() {
        for (m, other) in one_of_each(&TETRAHEDRON).into_iter().enumerate() {
            let a = AnyBody::new(shape).expect("a body");
            let step = 16.0;
            let b = AnyBody::new(other).expect("a body").posed(AXES, DVec3::X * step).expect("a pose");
            let Clearance::Apart { distance, a: p, b: q, lower, upper } = convex::distance(&a, &b) else {
                panic!("{n} {m}: apart by far")
            };
            assert!(lower <= distance && distance <= upper && upper - lower < 1e-6, "{n} {m}: {lower}..{upper}");
            assert!((p.distance(q) - distance).abs() < 1e-9, "{n} {m}: the points are {distance} apart");
            let end = |s: &AnyBody<DVec3>, d: DVec3| s.farthest(d).point.x + d.x * s.radius();
            let along_x = end(&b, -DVec3::X) - end(&a, DVec3::X);
            assert!(along_x <= upper, "{n} {m}: {along_x} beyond {upper}");
            // A body and its image are not farther apart than a point and its image.
            assert!(n != m || lower <= step, "{n}: {lower} beyond {step}");
            let Meeting::Apart(SeparationProof::Axis(axis)) = convex::meets(&a, &b) else { panic!("{n} {m}") };
            assert!(gjk::separates(&a, &b, axis), "{n} {m}: the axis proves it");
            // Swapped and with a hint, the same.
            assert_eq!(BodyQuery::new(&b, &a).hint(-axis).meets().contact(), Some(Contact::Disjoint), "{n} {m}");
        }
    }
}

#[test]
fn a_body_of_any_kind_answers_as_its_shape_does() {
    let ball = Sphere { center: DVec3::new(2.0, 0.5, 0.5), radius: 0.75 };
    let cell = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
    let (a, b) = (AnyBody::new(cell).expect("a box"), AnyBody::new(ball).expect("a ball"));
    let (Clearance::Apart { distance, .. }, Distance::Separated { distance: known, .. }) =
        (convex::distance(&a, &b), gjk::distance(&cell, &ball, None))
    else {
        panic!("apart")
    };
    assert!((distance - known).abs() <= 4.0 * f64::EPSILON);
    // A radius moves the surface, and a turn by 90 degrees about the middle of a cube changes nothing.
    let thick = a.rounded(0.125).expect("a radius");
    let Clearance::Apart { distance: less, .. } = convex::distance(&thick, &b) else { panic!("apart") };
    assert!((distance - less - 0.125).abs() < 1e-14);
    let turned = a.posed([DVec3::Y, -DVec3::X, DVec3::Z], DVec3::X).expect("a pose");
    let Clearance::Apart { distance: same, .. } = convex::distance(&turned, &b) else { panic!("apart") };
    assert!((distance - same).abs() < 1e-14);
    // Twice posed is posed by the product.
    let twice = turned.posed([-DVec3::Y, DVec3::X, DVec3::Z], DVec3::Y).expect("a pose");
    let Clearance::Apart { distance: back, .. } = convex::distance(&twice, &b) else { panic!("apart") };
    assert!((distance - back).abs() < 1e-14);
}

#[test]
fn what_only_touches_is_told_of_vertices_and_left_open_of_others() {
    let cube = AnyBody::new(Aabb { min: DVec3::ZERO, max: DVec3::ONE }).expect("a box");
    let beside = AnyBody::new(Aabb { min: DVec3::X, max: DVec3::new(2.0, 1.0, 1.0) }).expect("a box");
    let Meeting::Touching(axis) = convex::meets(&cube, &beside) else { panic!("they share a face") };
    let (a, b) = (cube.as_vertices().expect("a box has corners"), beside.as_vertices().expect("a box has corners"));
    assert_eq!(axis.gap(&a, &b), Ok(core::cmp::Ordering::Equal), "the proof holds");
    assert!(matches!(convex::distance(&cube, &beside), Clearance::Touching));
    let ball = AnyBody::new(Sphere { center: DVec3::new(1.5, 0.5, 0.5), radius: 0.5 }).expect("a ball");
    assert!(matches!(convex::meets(&cube, &ball), Meeting::Undecided(_)));
    let Clearance::Undecided { lower, upper, .. } = convex::distance(&cube, &ball) else { panic!("a touch") };
    assert!(lower == 0.0 && upper < 1e-14);
    assert!(ball.as_vertices().is_none() && cube.rounded(0.5).expect("a radius").as_vertices().is_none());
    assert!(cube.posed(AXES, DVec3::ZERO).expect("a pose").as_vertices().is_none());
}

#[test]
fn the_exact_stage_finds_gaps_that_rounding_hides() {
    let next = f64::from_bits(1.0_f64.to_bits() + 1);
    let cube = AnyBody::new(Aabb { min: DVec3::ZERO, max: DVec3::ONE }).expect("a box");
    let corners = [DVec3::X * next, DVec3::new(2.0, 1.0, 0.0), DVec3::new(2.0, 0.0, 1.0), DVec3::new(3.0, 0.0, 0.0)];
    let near = AnyBody::new(Hull::new(&corners)).expect("a hull");
    assert_eq!(convex::meets(&cube, &near).contact(), Some(Contact::Disjoint));
    let Clearance::Apart { distance, lower, upper, .. } = convex::distance(&cube, &near) else { panic!("apart") };
    assert!(lower <= f64::EPSILON && f64::EPSILON <= upper && (distance / f64::EPSILON - 1.0).abs() < 1e-14);
}

#[test]
fn what_is_no_body_is_refused() {
    let (zero, nan) = (DVec3::ZERO, f64::NAN);
    assert_eq!(AnyBody::new(Hull::<DVec3>::new(&[])), Err(BodyError::NoPoint));
    assert_eq!(AnyBody::new(Aabb { min: DVec3::ONE, max: zero }), Err(BodyError::NoPoint));
    assert_eq!(AnyBody::new(Sphere { center: zero, radius: -1.0 }), Err(BodyError::NegativeRadius));
    assert_eq!(AnyBody::new(Cylinder::new(zero, DVec3::Z, -1.0)), Err(BodyError::NegativeRadius));
    assert_eq!(AnyBody::new(Ellipsoid { center: zero, semi_axes: -DVec3::X }), Err(BodyError::NegativeRadius));
    for radius in [nan, f64::INFINITY] {
        assert_eq!(AnyBody::new(Capsule { from: zero, to: DVec3::X, radius }), Err(BodyError::NotFinite));
        assert_eq!(AnyBody::new(Cone::new(zero, DVec3::X, radius)), Err(BodyError::NotFinite));
    }
    assert_eq!(AnyBody::new(Point(Vec3::new(0.0, f32::NAN, 0.0))), Err(BodyError::NotFinite));
    let ball = AnyBody::new(Sphere { center: zero, radius: 1.0 }).expect("a ball");
    assert_eq!(ball.rounded(-0.5), Err(BodyError::NegativeRadius));
    assert_eq!(ball.rounded(nan), Err(BodyError::NotFinite));
    assert_eq!(ball.posed([DVec3::X * 2.0, DVec3::Y, DVec3::Z], zero), Err(BodyError::NotARotation));
    assert_eq!(ball.posed([DVec3::X * nan, DVec3::Y, DVec3::Z], zero), Err(BodyError::NotARotation));
    assert_eq!(ball.posed(AXES, DVec3::splat(f64::INFINITY)), Err(BodyError::NotFinite));
}

#[test]
fn errors_say_what_is_wrong() {
    let said: [(&dyn Error, &str); 4] = [
        (&BodyError::NoPoint, "no point"),
        (&exact::NotFinite, "not finite"),
        (&NotConvex::Beyond { triangle: 3 }, "triangle 3"),
        (&NotConvex::Full, "short"),
    ];
    for (error, words) in said {
        assert!(error.to_string().contains(words), "{error}");
    }
    let mut memory = [Facet::none(); 1];
    assert_eq!(facets::<DVec3>(&[], &[], &mut memory), Err(NotConvex::NoBody));
}

#[test]
fn a_simplex_proves_only_what_is_strictly_inside() {
    let origin = [DVec3::ZERO; 4];
    let around = |shift: DVec3| Simplex { a: origin, b: TETRAHEDRON.map(|p| p + shift) };
    assert!(around(DVec3::ZERO).holds_origin(0.0));
    // The faces of this tetrahedron are 1/√3 away from its middle.
    let out = DVec3::splat(1.0 / 3.0);
    assert!(around(out * 0.999_999).holds_origin(0.0) && !around(out * 0.999_999).holds_origin(1e-5), "slack counts");
    assert!(!around(out).holds_origin(0.0) && !around(out * 1.001).holds_origin(0.0), "a face, and beyond it");
    assert!(!around(TETRAHEDRON[0]).holds_origin(0.0), "a vertex");
    // Sizes do not matter, NaN and infinity prove nothing.
    for scale in [f64::MIN_POSITIVE, 1e-150, 1e150] {
        assert!(Simplex { a: origin, b: TETRAHEDRON.map(|p| p * scale) }.holds_origin(0.0), "{scale:e}");
    }
    for bad in [f64::NAN, f64::INFINITY] {
        assert!(!Simplex { a: origin, b: TETRAHEDRON.map(|p| p * bad) }.holds_origin(0.0));
    }
}

#[test]
fn six_points_surround_the_origin_where_fewer_cannot() {
    let octahedron = [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z];
    let (hull, middle) = (Hull::new(&octahedron), Point(DVec3::ZERO));
    for hint in [None, Some(DVec3::X), Some(DVec3::ONE)] {
        let Ok(Relation::Overlapping(points)) = exact::relation(&hull, &middle, hint) else { panic!("it is inside") };
        assert_eq!(points.holds(&hull, &middle), Ok(true), "{points:?}");
        assert!((4..=6).contains(&points.pairs().len()));
    }
    // In the plane of a face of the octahedron no points surround it.
    let on = Point(DVec3::new(0.5, 0.25, 0.25));
    assert_eq!(exact::contact(&hull, &on, None), Ok(Contact::Touching));
}

#[test]
fn exact_integers_hold_the_whole_range_of_numbers() {
    let tiny = f64::from_bits(1);
    let (huge, least) = (f64::MAX, DVec3::splat(tiny));
    let triangle = Triangle { a: DVec3::X * huge, b: DVec3::Y * huge, c: DVec3::Z * -huge };
    assert_eq!(exact::contact(&triangle, &Point(least), None), Ok(Contact::Disjoint));
    let through = Segment { from: DVec3::splat(-huge), to: least };
    let flat =
        Triangle { a: DVec3::new(-huge, -huge, tiny), b: DVec3::new(huge, 0.0, tiny), c: DVec3::new(0.0, huge, tiny) };
    assert_eq!(exact::contact(&through, &flat, None), Ok(Contact::Touching), "one step higher it would miss");
}

#[test]
fn exact_integers_of_single_precision_hold_its_whole_range() {
    // Double precision has far more words than these numbers need.
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut number = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        let size =
            [f32::MAX, f32::MAX, f32::from_bits(1), f32::from_bits(0x7f7f_fffe), 0.0, 1.0][(state >> 40) as usize % 6];
        if state & 1 == 0 { size } else { -size }
    };
    let mut seen = [0; 3];
    for case in 0..3000 {
        let points: [Vec3; 6] = core::array::from_fn(|_| Vec3::from_array(core::array::from_fn(|_| number())));
        let wide = points.map(|p| p.as_dvec3());
        let ([a, b], [c, d]) = ([&points[..3], &points[3..]].map(Hull::new), [&wide[..3], &wide[3..]].map(Hull::new));
        let (single, double) = (exact::relation(&a, &b, None), exact::relation(&c, &d, None));
        let (single, double) = (single.expect("finite"), double.expect("finite"));
        assert_eq!(single.contact(), double.contact(), "case {case}: {points:?}");
        assert_eq!(exact::distance(&a, &b, None), exact::distance(&c, &d, None), "case {case}: {points:?}");
        if let (Relation::Disjoint(x), Relation::Disjoint(y)) = (&single, &double) {
            assert_eq!(x.to_array(), y.to_array(), "case {case}: {points:?}");
            assert_eq!(x.gap(&a, &b), Ok(core::cmp::Ordering::Greater), "case {case}: {points:?}");
        }
        seen[single.contact() as usize] += 1;
    }
    assert!(seen.iter().all(|&n| n > 50), "cases of each kind: {seen:?}");
}

#[test]
fn a_thickened_body_meets_what_its_core_does_not() {
    let bar = Segment { from: Vec3::ZERO, to: Vec3::X };
    let point = Point(Vec3::new(0.5, 1.0, 0.0));
    assert!(matches!(gjk::intersect(&bar, &point, None), Intersection::Apart { .. }));
    let thick = Rounded { core: bar, radius: 1.25 };
    assert!(matches!(gjk::intersect(&thick, &point, None), Intersection::Overlapping { .. }));
}

#[test]
fn the_least_axis_is_never_along_a_vector() {
    for v in [DVec3::X, DVec3::ONE, DVec3::new(0.1, -3.0, 2.0), DVec3::new(2.0, 0.0, 0.0), DVec3::new(5.0, 4.0, -0.5)] {
        let axis = Vector::least_axis(v);
        assert_eq!(axis.dot(DVec3::ONE), 1.0);
        assert!(v.cross(axis) != DVec3::ZERO && v.dot(axis).abs() <= v.abs().min_element(), "{v} and {axis}");
    }
}
