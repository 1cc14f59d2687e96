//! What must hold for every pair of hulls, boxes and directions.

use std::cmp::Ordering;

use glam::DVec3;
use voidage_core::convex::containment::{Containment, contains};
use voidage_core::convex::exact::{self, Contact, Relation};
use voidage_core::convex::gjk::{self, Distance, Intersection, OverlapProof};
use voidage_core::convex::sat::{BoxTriangle, box_triangle};
use voidage_core::convex::shape::{Hull, Triangle, Vertices};
use voidage_core::number::aabb::Aabb;
use voidage_core::number::real::{Real, Vector};

use crate::corpus::vectors;
use crate::oracle;
use crate::recipe::Pair;

/// Both stages against the truth, with their proofs; returns what the first stage said.
pub fn booleans_are_true<V: Vector>((a, b): &Pair, truth: Contact) -> &'static str {
    let (a, b) = (vectors::<V>(a), vectors::<V>(b));
    let (a, b) = (Hull::new(&a), Hull::new(&b));
    let said = match gjk::intersect(&a, &b, None) {
        Intersection::Apart { axis } => {
            assert_eq!(truth, Contact::Disjoint, "said apart along {axis:?}");
            assert!(gjk::separates(&a, &b, axis), "unproved axis {axis:?}");
            "apart"
        }
        Intersection::Overlapping { proof: OverlapProof::Inside(simplex) } => {
            assert_eq!(truth, Contact::Overlapping, "said overlapping by {simplex:?}");
            assert!(simplex.holds_origin(Real::ZERO), "unproved {simplex:?}");
            assert!(simplex.a.iter().all(|p| a.vertices().contains(p)), "not of the first body: {simplex:?}");
            assert!(simplex.b.iter().all(|p| b.vertices().contains(p)), "not of the second body: {simplex:?}");
            "overlapping"
        }
        Intersection::Overlapping { proof } => panic!("a proof for rounded bodies: {proof:?}"),
        Intersection::Undecided { .. } => "undecided",
    };
    assert_eq!(exact::contact(&a, &b, None), Ok(truth));
    let relation = exact::relation(&a, &b, None).expect("finite");
    assert_eq!(relation.contact(), truth);
    match relation {
        Relation::Disjoint(axis) => assert_eq!(axis.gap(&a, &b), Ok(Ordering::Greater)),
        Relation::Touching(axis) => assert_eq!(axis.gap(&a, &b), Ok(Ordering::Equal)),
        Relation::Overlapping(points) => assert_eq!(points.holds(&a, &b), Ok(true)),
    }
    said
}

/// The same answer for swapped, reversed and repeated vertices, other hints, and all coordinates times a power of two.
pub fn changes_do_not_matter((a, b): &Pair, truth: Contact) {
    let settle = |a: &[[f64; 3]], b: &[[f64; 3]], hint: Option<DVec3>| {
        let (a, b) = (vectors::<DVec3>(a), vectors::<DVec3>(b));
        exact::contact(&Hull::new(&a), &Hull::new(&b), hint)
    };
    assert_eq!(settle(b, a, None), Ok(truth), "swapped");
    let backwards = |p: &[[f64; 3]]| p.iter().rev().copied().collect::<Vec<_>>();
    assert_eq!(settle(&backwards(a), &backwards(b), None), Ok(truth), "reversed");
    let twice = |p: &[[f64; 3]]| [p, p].concat();
    assert_eq!(settle(&twice(a), b, None), Ok(truth), "repeated");
    let turned = |p: &[[f64; 3]]| p.iter().map(|&[x, y, z]| [y, z, x]).collect::<Vec<_>>();
    assert_eq!(settle(&turned(a), &turned(b), None), Ok(truth), "axes permuted");
    let mirrored = |p: &[[f64; 3]]| p.iter().map(|&[x, y, z]| [-x, y, z]).collect::<Vec<_>>();
    assert_eq!(settle(&mirrored(a), &mirrored(b), None), Ok(truth), "mirrored");
    for hint in [DVec3::X, DVec3::new(-1.0, 0.5, 1e-9), DVec3::ZERO, DVec3::splat(f64::NAN), DVec3::splat(1e-320)] {
        assert_eq!(settle(a, b, Some(hint)), Ok(truth), "hint {hint:?}");
    }
    for factor in [0.5, 1024.0, 2f64.powi(90), 2f64.powi(-90)] {
        let scaled = |p: &[[f64; 3]]| p.iter().map(|p| p.map(|x| x * factor)).collect::<Vec<_>>();
        let (sa, sb) = (scaled(a), scaled(b));
        let exact =
            |p: &[[f64; 3]], q: &[[f64; 3]]| p.iter().flatten().zip(q.iter().flatten()).all(|(x, y)| y / factor == *x);
        let fine = exact(a, &sa) && exact(b, &sb);
        if fine {
            assert_eq!(settle(&sa, &sb, None), Ok(truth), "times {factor}");
        }
    }
    let step = a.iter().chain(b).flatten().fold(0.0, |m: f64, x| m.max(x.abs())) * 4.0;
    let moved = |p: &[[f64; 3]]| p.iter().map(|p| p.map(|x| x + step)).collect::<Vec<_>>();
    let (ma, mb) = (moved(a), moved(b));
    let exact = a.iter().zip(&ma).chain(b.iter().zip(&mb)).all(|(p, q)| (0..3).all(|k| q[k] - step == p[k]));
    if exact {
        assert_eq!(settle(&ma, &mb, None), Ok(truth), "moved by {step}");
    }
}

/// Both distances against an exact one; the first stage's also against its own bounds.
pub fn distances_are_true((a, b): &Pair) {
    let truth = oracle::distance_sq(a, b);
    let (a, b) = (vectors::<DVec3>(a), vectors::<DVec3>(b));
    let (a, b) = (Hull::new(&a), Hull::new(&b));
    let nearest = exact::distance(&a, &b, None).expect("finite");
    let apart = num_traits::Signed::is_positive(&truth.0);
    let at_least = |x: f64| !apart && x == 0.0 || apart && oracle::relative_error_sq(x, &truth) <= 1e-15;
    let at_most = |x: f64| !x.is_finite() || oracle::relative_error_sq(x, &truth) >= if apart { -1e-15 } else { 0.0 };
    assert_eq!(nearest.distance > 0.0, apart, "exact distance {nearest:?}");
    let error = oracle::relative_error_sq(nearest.distance, &truth);
    // A subnormal result is rounded to whole steps.
    let (below, above) = ((nearest.distance - 5e-324).max(0.0), nearest.distance + 5e-324);
    let within_a_step = (below == 0.0 || at_least(below)) && at_most(above);
    assert!(error.abs() < 1e-14 || within_a_step, "exact distance {nearest:?} off by {error:e}");
    match gjk::distance(&a, &b, None) {
        Distance::Separated { distance, lower, upper, a: p, b: q, axis } => {
            assert!(apart, "said {distance} apart");
            assert!(lower > 0.0 && lower <= distance && distance <= upper);
            assert!(at_least(lower), "lower bound {lower:e}");
            assert!(at_most(upper), "upper bound {upper:e}");
            assert!(p.is_finite() && q.is_finite() && (axis.length() - 1.0).abs() < 1e-14);
        }
        Distance::Overlapping { .. } => assert!(!apart, "said overlapping"),
        Distance::Undecided { lower, upper, .. } => assert!(at_least(lower) && at_most(upper), "{lower:e} {upper:e}"),
    }
}

/// A proof is refused for what is not so: the verifiers against exact sums, for any direction.
pub fn false_proofs_are_refused((a, b): &Pair, axis: [f64; 3], truth: Contact) {
    let (va, vb) = (vectors::<DVec3>(a), vectors::<DVec3>(b));
    let (ha, hb) = (Hull::new(&va), Hull::new(&vb));
    let axis = DVec3::from_array(axis);
    if gjk::separates(&ha, &hb, axis) {
        assert_ne!(truth, Contact::Overlapping, "axis {axis:?} accepted");
        let at = |points: &[[f64; 3]]| points.to_vec();
        assert_ne!(oracle::contact(&at(a), &at(b)), Contact::Overlapping);
    }
    // Any four pairs of vertices.
    let pick = |h: &Hull<DVec3>| std::array::from_fn(|i| h.vertex((i * 7 + 3) % h.count()));
    let simplex = voidage_core::convex::simplex::Simplex { a: pick(&ha), b: pick(&hb) };
    if simplex.holds_origin(0.0) {
        assert_eq!(truth, Contact::Overlapping, "{simplex:?} accepted");
    }
}

/// A box in a hull: as the corners say.
pub fn containment_is_true(hull: &[[f64; 3]], cell: [[f64; 3]; 2]) {
    let vertices = vectors::<DVec3>(hull);
    let cell = Aabb::around(&cell.map(DVec3::from_array));
    let corners: Vec<_> = (0..8).map(|i| cell.vertex(i).to_array()).collect();
    // Every answer is about closed bodies, so a touching corner is inside.
    let inside = corners.iter().all(|&c| oracle::contact(&[c], hull) != Contact::Disjoint);
    match contains(&Hull::new(&vertices), &cell) {
        Containment::Inside => assert!(inside, "{cell:?} said inside"),
        Containment::Outside { corner } => {
            assert!(!inside, "{cell:?} said outside");
            assert_eq!(oracle::contact(&[corner.to_array()], hull), Contact::Disjoint);
        }
        Containment::Undecided => {}
    }
}

/// The thirteen directions say what the exact stage says.
pub fn box_and_triangle_agree(cell: [[f64; 3]; 2], triangle: [[f64; 3]; 3]) -> BoxTriangle<DVec3> {
    let cell = Aabb::around(&cell.map(DVec3::from_array));
    let [a, b, c] = triangle.map(DVec3::from_array);
    let triangle = Triangle { a, b, c };
    let truth = exact::contact(&cell, &triangle, None);
    let said = box_triangle(&cell, &triangle);
    match said {
        BoxTriangle::Apart { axis } => {
            assert_ne!(truth, Ok(Contact::Overlapping), "{cell:?} {triangle:?} said apart along {axis:?}");
        }
        BoxTriangle::Overlapping => {
            assert_eq!(truth, Ok(Contact::Overlapping), "{cell:?} {triangle:?} said overlapping")
        }
        BoxTriangle::Undecided => {}
    }
    said
}
