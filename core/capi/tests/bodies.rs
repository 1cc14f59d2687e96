//! Meeting and distance of bodies of every kind.

use crate::kit::api::{Api, body, named, no_fault};
use voidage_capi::status::{Fault, Status};
use voidage_capi::types::{Body, Distance};

fn meets<R: Api>(a: &Body<R>, b: &Body<R>) -> (Status, i32, Fault) {
    let (mut contact, mut fault) = (-1, no_fault());
    let status = unsafe { R::meets(a, b, core::ptr::null(), &mut contact, &mut fault) };
    (status, contact, fault)
}

fn distance<R: Api>(a: &Body<R>, b: &Body<R>) -> Distance<R> {
    let (mut found, mut fault) = (Distance::default(), no_fault());
    let hint = [R::ONE, R::ZERO, R::ZERO];
    let status = unsafe { R::distance(a, b, hint.as_ptr(), &mut found, &mut fault) };
    assert_eq!((status, named(&fault)), (Status::Ok, ""));
    found
}

/// One body of each kind, which reaches to x = 1 and no further.
fn kinds<R: Api>(points: &[R]) -> Vec<Body<R>> {
    let body = |kind, numbers: &[f64]| body(kind, &numbers.iter().map(|&x| R::from_f64(x)).collect::<Vec<R>>());
    vec![
        body(0, &[1.0, 0.0, 0.0]),
        body(1, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0]),
        body(2, &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -1.0, 0.0]),
        body(3, &[0.0, -1.0, -1.0, 1.0, 1.0, 1.0]),
        Body { points: points.as_ptr(), count: points.len() / 3, ..body(4, &[]) },
        body(5, &[0.5, 0.0, 0.0, 0.5]),
        body(6, &[0.5, 0.0, -1.0, 0.5, 0.0, 1.0, 0.5]),
        body(7, &[0.5, 0.0, -1.0, 0.5, 0.0, 1.0, 0.5]),
        body(8, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.5]),
        body(11, &[0.5, 0.0, -1.0, 0.5, 0.0, 1.0, 0.5, 0.25]),
        body(9, &[0.5, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.25, 0.0, 0.0, 0.0, 0.125]),
        body(10, &[0.5, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.25, 0.0, 0.0, 0.0, 0.125]),
    ]
}

fn all_kinds<R: Api>() {
    let points = [0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0].map(R::from_f64);
    let wall = [3.0, -9.0, -9.0, 4.0, 9.0, 9.0].map(R::from_f64);
    let touching = [1.0, -9.0, -9.0, 4.0, 9.0, 9.0].map(R::from_f64);
    let within = [-9.0, -9.0, -9.0, 9.0, 9.0, 9.0].map(R::from_f64);
    for given in kinds(&points) {
        let by_points = given.kind < 5;
        let found = distance(&given, &body(3, &wall));
        let two = R::TWO;
        assert!((found.distance - two).abs() < R::from_f64(16.0) * R::EPSILON, "{given:?}: {found:?}");
        assert!(found.lower <= two && two <= found.upper && found.contact == 0);
        assert!((found.a[0] - R::ONE).abs() < R::from_f64(1e-6) && found.b[0] == R::from_f64(3.0), "{found:?}");
        assert_eq!(meets(&given, &body(3, &wall)).1, 0);
        let expected = if by_points { 3 } else { 2 };
        assert_eq!(meets(&given, &body(3, &touching)).1, expected, "{given:?}");
        assert_eq!(meets(&body(3, &within), &given).1, 1, "{given:?}");
        // Thickened by 1 it comes as much nearer.
        let thick = Body { round: R::ONE, ..given };
        assert!((distance(&thick, &body(3, &wall)).distance - R::ONE).abs() < R::from_f64(32.0) * R::EPSILON);
    }
}

#[test]
fn bodies_of_every_kind_are_as_far_apart_as_they_are() {
    all_kinds::<f64>();
    all_kinds::<f32>();
}

#[test]
fn what_is_no_body_is_named() {
    let good = body(5, &[0.0, 0.0, 0.0, 1.0]);
    let refused = |bad: Body<f64>| {
        let (status, contact, fault) = meets(&good, &bad);
        assert_eq!((contact, fault.index), (-1, 1));
        (status, named(&fault))
    };
    assert_eq!(refused(body(12, &[])), (Status::Kind, "body.kind"));
    assert_eq!(refused(body(-1, &[])), (Status::Kind, "body.kind"));
    assert_eq!(refused(body(5, &[0.0, f64::NAN, 0.0, 1.0])), (Status::Value, "body.p"));
    assert_eq!(refused(body(5, &[0.0, 0.0, 0.0, -1.0])), (Status::Body, "body"));
    assert_eq!(refused(body(3, &[1.0, 0.0, 0.0, 0.0, 1.0, 1.0])), (Status::Body, "body"));
    assert_eq!(refused(body(9, &[0.0; 12])), (Status::Body, "body.p"));
    assert_eq!(
        refused(body(9, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0])),
        (Status::Body, "body.p")
    );
    assert_eq!(refused(Body { round: f64::NAN, ..good }), (Status::Value, "body.round"));
    assert_eq!(refused(Body { round: 1.7e308, ..body(5, &[0.0, 0.0, 0.0, 1.7e308]) }), (Status::Value, "body"));
    assert_eq!(refused(body(4, &[])), (Status::Body, "body"));
    let points = [0.0, 1.0, 2.0, 3.0, f64::INFINITY, 5.0];
    let hull = Body { points: points.as_ptr(), count: 2, ..body(4, &[]) };
    assert_eq!(refused(hull), (Status::Value, "body.points"));
    assert_eq!(refused(Body { count: usize::MAX, ..hull }), (Status::Length, "body.count"));
    assert_eq!(refused(Body { points: core::ptr::null(), ..hull }), (Status::Null, "body.points"));
    let odd = points.as_ptr().wrapping_byte_add(1);
    assert_eq!(refused(Body { points: odd, ..hull }), (Status::Misaligned, "body.points"));
}
