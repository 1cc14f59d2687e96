//! The convex hull of points against exact arithmetic.

use glam::DVec3;
use proptest::prelude::*;
use std::collections::BTreeMap;
use voidage::geometry::scene::hull::HullSolid;

/// Six times the signed volume of a tetrahedron with whole coordinates.
fn volume6([a, b, c]: [DVec3; 3], p: DVec3) -> i64 {
    let [u, v, w] = [b - a, c - a, p - a].map(|d| d.to_array().map(|x| x as i64));
    u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) + u[2] * (v[0] * w[1] - v[1] * w[0])
}

/// Closed, no face flat, and no point outside of any face: then it is the hull.
fn check(points: &[DVec3]) {
    let flat = {
        let mut spans = false;
        for a in points {
            for b in points {
                for c in points {
                    spans |= points.iter().any(|&d| volume6([*a, *b, *c], d) != 0);
                }
                if spans {
                    break;
                }
            }
        }
        !spans
    };
    let Ok(hull) = HullSolid::new(points) else {
        assert!(flat, "refused though it has a volume: {points:?}");
        return;
    };
    assert!(!flat, "accepted though flat: {points:?}");
    let mut edges = BTreeMap::new();
    for t in &hull.triangles {
        for n in 0..3 {
            assert!(edges.insert((t[n], t[(n + 1) % 3]), ()).is_none(), "an edge twice: {points:?}");
        }
    }
    assert!(edges.keys().all(|&(a, b)| edges.contains_key(&(b, a))), "not closed: {points:?}");
    assert_eq!(hull.corners.len() + hull.triangles.len(), edges.len() / 2 + 2, "not a sphere: {points:?}");
    for triangle in hull.surface() {
        let [a, b, c] = triangle;
        assert!((b - a).cross(c - a) != DVec3::ZERO, "a flat face: {points:?}");
        assert!(points.iter().all(|&p| volume6(triangle, p) <= 0), "a point outside: {points:?}");
    }
}

fn lattice_points(most: i32, count: usize) -> impl Strategy<Value = Vec<DVec3>> {
    let coordinate = -most..=most;
    let point = (coordinate.clone(), coordinate.clone(), coordinate);
    let point = point.prop_map(|(x, y, z)| DVec3::new(x.into(), y.into(), z.into()));
    prop::collection::vec(point, 4..count)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) })]

    /// Few different coordinates: points repeat, lie on lines and in planes.
    #[test]
    fn degenerate_points(points in lattice_points(2, 16)) {
        check(&points);
    }

    /// Away from the origin the determinants need every bit.
    #[test]
    fn points_far_away(points in lattice_points(1, 9), far in 0..3) {
        let offset = [1e3, 1e5, 1e6][far as usize];
        check(&points.iter().map(|&p| p + offset).collect::<Vec<_>>());
    }

    #[test]
    fn general_points(points in lattice_points(500, 24)) {
        check(&points);
    }
}

/// Corners that rounding has moved out of the planes of a turned cube: the hull still closes and holds the volume.
#[test]
fn cubes_turned_by_rounding_angles() {
    let mut rng = voidage_tests::random::Random::new(3);
    for _ in 0..500 {
        let turn = rng.turn();
        let mut points = Vec::new();
        for n in 0..125 {
            points.push(turn * DVec3::new((n % 5) as f64, (n / 5 % 5) as f64, (n / 25) as f64) + DVec3::splat(17.0));
        }
        let hull = HullSolid::new(&points).expect("a volume");
        assert!((hull.volume() - 64.0).abs() < 1e-11, "{}", hull.volume());
        assert_eq!(hull.triangles.len(), 2 * hull.corners.len() - 4);
    }
}

#[test]
fn many_points_on_a_sphere_are_quick() {
    let mut rng = voidage_tests::random::Random::new(4);
    let points: Vec<DVec3> = (0..20_000).map(|_| DVec3::from_array(rng.on_sphere())).collect();
    let begin = std::time::Instant::now();
    let hull = HullSolid::new(&points).expect("a volume");
    assert!((hull.volume() / (4.0 / 3.0 * std::f64::consts::PI) - 1.0).abs() < 1e-3);
    assert!(begin.elapsed().as_secs() < 20, "{:?}", begin.elapsed());
}

#[test]
fn sizes_beyond_arithmetic_are_refused() {
    let unit = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    for scale in [1e-60, 1e-20, 1e20, 1e60] {
        let hull = HullSolid::new(&unit.map(|p| p * scale)).expect("a volume");
        assert!((hull.volume() / scale.powi(3) * 6.0 - 1.0).abs() < 1e-12, "{scale}");
    }
    assert!(HullSolid::new(&unit.map(|p| p * 1e-310)).is_err());
    assert!(HullSolid::new(&[DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z * 1e-200]).is_err());
    assert!(HullSolid::new(&unit.map(|p| p * f64::INFINITY)).is_err());
}
