//! Simplices of exact differences: the point nearest to the origin, and the part of a cone nearest to a target.

use core::cmp::Ordering;

use heapless::Vec;

use super::integer::{DEGREE_2, DEGREE_3, DEGREE_4, Int, V1, V2, V3, cross, dot, minus, negated, resized};
use super::lattice::ExactDifference;

/// Up to four points of the difference: a simplex, or the edges of a cone.
pub(super) type Points = Vec<ExactDifference, 4>;

/// Whether `q` follows `p` by less than a half turn about `e` (`Greater`), by more (`Less`), or neither.
pub(super) fn turn(e: &V1, p: &V1, q: &V1) -> Ordering {
    dot::<_, _, DEGREE_3>(e, &cross::<_, _, DEGREE_2>(p, q)).sign()
}

/// All subsets of four, small ones first.
const SUBSETS: [&[usize]; 15] = [
    &[0],
    &[1],
    &[2],
    &[3],
    &[0, 1],
    &[0, 2],
    &[0, 3],
    &[1, 2],
    &[1, 3],
    &[2, 3],
    &[0, 1, 2],
    &[0, 1, 3],
    &[0, 2, 3],
    &[1, 2, 3],
    &[0, 1, 2, 3],
];

/// The smallest part of a simplex that holds its point nearest to the origin, and the direction of that point: the one part with positive
/// weights whose support plane has all other vertices on the far side.
pub(super) fn nearest(simplex: &Points) -> (Points, V3) {
    for subset in SUBSETS {
        let Some(part) = chosen(simplex, subset) else { continue };
        let (Some(direction), Some(start)) = (towards(&part), part.first()) else { continue };
        let beyond = |p: &ExactDifference| dot::<_, _, DEGREE_4>(&direction, &minus(&p.w, &start.w)).is_negative();
        if !simplex.iter().any(beyond) {
            return (part, direction);
        }
    }
    // Exact arithmetic always finds one.
    debug_assert!(false, "a simplex without a nearest point");
    (simplex.clone(), [Int::ZERO; 3])
}

/// The points of a subset, given by their positions; none if there are not so many.
fn chosen(from: &Points, subset: &[usize]) -> Option<Points> {
    let mut part = Points::new();
    for &i in subset {
        part.push(*from.get(i)?).ok()?;
    }
    Some(part)
}

/// From the origin to the nearest point of the hull of some points, if that lies strictly inside it.
fn towards(points: &[ExactDifference]) -> Option<V3> {
    match points {
        [p] => Some(resized(&p.w)),
        [p, q] => {
            let e = minus(&q.w, &p.w);
            let before: Int<DEGREE_2> = dot(&p.w, &e);
            let after: Int<DEGREE_2> = dot(&q.w, &e);
            let area: V2 = cross(&p.w, &e);
            (before.is_negative() && after.is_positive()).then(|| cross(&e, &area))
        }
        [p, q, r] => {
            let normal: V2 = cross(&minus(&q.w, &p.w), &minus(&r.w, &p.w));
            let weight = |x: &V1, y: &V1| dot::<_, _, DEGREE_4>(&normal, &cross::<_, _, DEGREE_2>(x, y)).is_positive();
            if !(weight(&p.w, &q.w) && weight(&q.w, &r.w) && weight(&r.w, &p.w)) {
                return None;
            }
            let height: Int<DEGREE_3> = dot(&normal, &p.w);
            Some(match height.sign() {
                Ordering::Greater => resized(&normal),
                Ordering::Less => negated(&resized(&normal)),
                Ordering::Equal => [Int::ZERO; 3],
            })
        }
        [p, q, r, s] => {
            let volume = |x: &V1, y: &V1, z: &V1| turn(x, y, z);
            let signs = [
                volume(&q.w, &r.w, &s.w),
                volume(&p.w, &r.w, &s.w).reverse(),
                volume(&p.w, &q.w, &s.w),
                volume(&p.w, &q.w, &r.w).reverse(),
            ];
            let inside = signs[0] != Ordering::Equal && signs.iter().all(|&s| s == signs[0]);
            inside.then_some([Int::ZERO; 3])
        }
        _ => None,
    }
}

/// The part of a cone nearest to `target`, and what remains from there to the target.
pub(super) fn nearest_in_cone(target: &V1, cone: &Points) -> (Points, V3) {
    let fits = |residual: &V3| !cone.iter().any(|p| dot::<_, _, DEGREE_4>(residual, &p.w).is_positive());
    let whole = resized(target);
    if fits(&whole) {
        return (Points::new(), whole);
    }
    for subset in SUBSETS {
        let Some(part) = chosen(cone, subset) else { continue };
        let Some(residual) = beside(target, &part) else { continue };
        if fits(&residual) {
            return (part, residual);
        }
    }
    debug_assert!(false, "a cone without a nearest point");
    (Points::new(), [Int::ZERO; 3])
}

/// What remains of `target` across the cone of some points, if its foot lies strictly inside that cone.
fn beside(target: &V1, points: &[ExactDifference]) -> Option<V3> {
    match points {
        [p] => {
            let along: Int<DEGREE_2> = dot(target, &p.w);
            along.is_positive().then(|| cross(&p.w, &cross::<_, _, DEGREE_2>(target, &p.w)))
        }
        [p, q] => {
            let normal: V2 = cross(&p.w, &q.w);
            let weight = |x: &V1, y: &V1| dot::<_, _, DEGREE_4>(&normal, &cross::<_, _, DEGREE_2>(x, y)).is_positive();
            if !(weight(target, &q.w) && weight(&p.w, target)) {
                return None;
            }
            let height: Int<DEGREE_3> = dot(&normal, target);
            Some(match height.sign() {
                Ordering::Greater => resized(&normal),
                Ordering::Less => negated(&resized(&normal)),
                Ordering::Equal => [Int::ZERO; 3],
            })
        }
        [p, q, r] => {
            let volume = turn(&p.w, &q.w, &r.w);
            let signs = [turn(target, &q.w, &r.w), turn(&p.w, target, &r.w), turn(&p.w, &q.w, target)];
            (volume != Ordering::Equal && signs.iter().all(|&s| s == volume)).then_some([Int::ZERO; 3])
        }
        _ => None,
    }
}
