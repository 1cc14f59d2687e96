//! What the fuzz targets run, as functions of bytes: also on saved findings, without a fuzzer.

use glam::{DVec3, Vec3};
use voidage_core::convex::containment::contains;
use voidage_core::convex::exact::{self, Contact};
use voidage_core::convex::gjk::{self, Distance, Intersection};
use voidage_core::convex::shape::{Capsule, Cone, Cylinder, Ellipsoid, Hull, OrientedBox, Sphere};
use voidage_core::convex::support::Support;
use voidage_core::number::real::{Real, Vector};

use crate::gjk::{
    booleans_are_true, box_and_triangle_agree, changes_do_not_matter, containment_is_true, distances_are_true,
    false_proofs_are_refused,
};
use crate::oracle;
use crate::recipe::Recipe;

/// A name and what it runs.
pub type Target = (&'static str, fn(&[u8]));

/// All targets by name.
pub const TARGETS: [Target; 9] = [
    ("boxes", boxes),
    ("intersect", intersect),
    ("distance", distance),
    ("containment", containment),
    ("certificates", certificates),
    ("raw", raw),
    ("subdivide", subdivide),
    ("layers", layers),
    ("quadric", quadric),
];

/// Files of boxes against coordinate compression.
pub fn boxes(bytes: &[u8]) {
    crate::boxes::bytes_hold(bytes);
}

/// Porosity of layers of any triangles in any memory.
pub fn layers(bytes: &[u8]) {
    let Some((seed, _)) = bytes.split_first_chunk() else { return };
    let seed = u64::from_le_bytes(*seed);
    crate::door::never_panics::<DVec3>(seed);
    crate::door::never_panics::<Vec3>(seed);
}

/// Shares of any solid by formula, the sum of those of a solid of some family, and what two and three have in common by two tolerances.
pub fn quadric(bytes: &[u8]) {
    let Some((seed, _)) = bytes.split_first_chunk() else { return };
    let seed = u64::from_le_bytes(*seed);
    crate::quadric::never_panics::<DVec3>(seed);
    crate::quadric::never_panics::<Vec3>(seed);
    crate::quadric::parts_sum_to_the_whole(seed);
    crate::meeting::bounds_agree(seed);
    crate::meeting::planes_agree(seed);
    crate::meeting::planes_enclose_a_torus(seed);
}

/// Booleans of both stages against the oracle.
pub fn intersect(bytes: &[u8]) {
    let Some(recipe) = Recipe::decode(bytes) else { return };
    let pair = recipe.make();
    let truth = oracle::contact(&pair.0, &pair.1);
    booleans_are_true::<DVec3>(&pair, truth);
    changes_do_not_matter(&pair, truth);
    if pair.0.iter().chain(&pair.1).flatten().all(|&x| f64::from(x as f32) == x) {
        booleans_are_true::<Vec3>(&pair, truth);
    }
}

/// Distances of both stages.
pub fn distance(bytes: &[u8]) {
    let Some(mut recipe) = Recipe::decode(bytes) else { return };
    recipe.a.truncate(4);
    recipe.b.truncate(4);
    distances_are_true(&recipe.make());
}

/// Boxes in hulls and against triangles.
pub fn containment(bytes: &[u8]) {
    let Some((head, rest)) = bytes.split_at_checked(6) else { return };
    let Some(recipe) = Recipe::decode(rest) else { return };
    let (hull, other) = recipe.make();
    let unit = 2f64.powi(i32::from(recipe.exponent.clamp(-900, 900)));
    let corner = |p: &[u8]| std::array::from_fn(|k| f64::from(p[k] as i8) / 16.0 * unit);
    let cell = [corner(&head[..3]), corner(&head[3..])];
    containment_is_true(&hull, cell);
    if let [a, b, c, ..] = other[..] {
        box_and_triangle_agree(cell, [a, b, c]);
    }
}

/// Unions of up to six convex bodies by subdivision.
pub fn subdivide(bytes: &[u8]) {
    let Some((&depth, rest)) = bytes.split_first() else { return };
    crate::convex::bounds_hold_the_union(&crate::convex::decode(rest), u32::from(depth % 4));
}

/// Proofs of what is not so.
pub fn certificates(bytes: &[u8]) {
    let Some((head, rest)) = bytes.split_at_checked(3) else { return };
    let Some(recipe) = Recipe::decode(rest) else { return };
    let pair = recipe.make();
    let truth = oracle::contact(&pair.0, &pair.1);
    false_proofs_are_refused(&pair, std::array::from_fn(|k| f64::from(head[k] as i8)), truth);
}

/// Any bits: vertices of two hulls, and curved bodies from the same numbers.
pub fn raw(bytes: &[u8]) {
    let numbers: Vec<f64> = bytes.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().expect("eight"))).collect();
    let points: Vec<DVec3> = numbers.chunks_exact(3).take(12).map(DVec3::from_slice).collect();
    consistent(&points);
    let single: Vec<Vec3> = points.iter().map(|p| p.as_vec3()).collect();
    consistent(&single);
    let [p, q, r, s, ..] = points[..] else { return };
    let bodies = (
        Ellipsoid { center: p, semi_axes: q },
        Cylinder::new(p, q, r.x),
        Cone::new(q, r, s.x),
        Capsule { from: r, to: s, radius: p.x },
        OrientedBox { center: s, half_axes: [p, q, r] },
        Sphere { center: q, radius: s.y },
    );
    let hull = Hull::new(&points);
    sound(&hull, &bodies.0);
    sound(&bodies.1, &hull);
    sound(&bodies.2, &bodies.3);
    sound(&bodies.3, &hull);
    sound(&bodies.4, &bodies.0);
    sound(&bodies.5, &bodies.1);
    let cell = voidage_core::number::aabb::Aabb::around(&[r, s]);
    let _ = (contains(&bodies.0, &cell), contains(&bodies.5, &cell), contains(&bodies.1, &cell));
}

/// The first stage does not contradict the exact one, and both distances agree.
fn consistent<V: Vector>(points: &[V]) {
    let (a, b) = points.split_at(points.len() / 2);
    let (a, b) = (Hull::new(a), Hull::new(b));
    sound(&a, &b);
    let Ok(relation) = exact::relation(&a, &b, None) else { return };
    match gjk::intersect(&a, &b, None) {
        Intersection::Apart { .. } => assert_eq!(relation.contact(), Contact::Disjoint),
        Intersection::Overlapping { .. } => assert_eq!(relation.contact(), Contact::Overlapping),
        Intersection::Undecided { .. } => {}
    }
    let nearest = exact::distance(&a, &b, None).expect("finite");
    assert_eq!(nearest.distance == 0.0, relation.contact() != Contact::Disjoint || nearest.distance == 0.0);
    if let Distance::Separated { lower, upper, .. } = gjk::distance(&a, &b, None) {
        let d = nearest.distance;
        let room = 1e-14 * d + (V::Scalar::MIN_POSITIVE * V::Scalar::EPSILON).to_f64();
        assert!(lower.to_f64() <= d + room && d - room <= upper.to_f64(), "{lower} {d} {upper}");
    }
}

/// Boolean and distance do not contradict each other, nor the proofs either.
fn sound<A: Support, B: Support<Vector = A::Vector>>(a: &A, b: &B) {
    let (boolean, distance) = (gjk::intersect(a, b, None), gjk::distance(a, b, None));
    if let Intersection::Apart { axis } = boolean {
        assert!(gjk::separates(a, b, axis), "unproved {axis:?}");
        assert!(!matches!(distance, Distance::Overlapping { .. }), "apart and overlapping");
    }
    if let Intersection::Overlapping { .. } = boolean {
        assert!(!matches!(distance, Distance::Separated { .. }), "overlapping and apart");
    }
    if let Distance::Separated { distance, lower, upper, .. } = distance {
        assert!(lower > Real::ZERO && lower <= distance && distance <= upper);
    }
}
