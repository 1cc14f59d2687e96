//! Simplices of exact differences: the point nearest to the origin, and the part of a cone nearest to a target.

use core::cmp::Ordering;

use heapless::Vec;

use super::integer::{Degree2, Degree3, Degree4, Int, Int2, Int3, V1, V2, V3, cross, dot, minus, negated, resized};
use super::lattice::ExactDifference;
use crate::number::real::Real;

/// Up to four points of the difference: a simplex, or the edges of a cone.
pub(super) type Points<R> = Vec<ExactDifference<R>, 4>;

/// Whether `q` follows `p` by less than a half turn about `e` (`Greater`), by more (`Less`), or neither.
pub(super) fn turn<R: Real>(e: &V1<R>, p: &V1<R>, q: &V1<R>) -> Ordering {
    dot::<_, _, Degree3<R>>(e, &cross::<_, _, Degree2<R>>(p, q)).sign()
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
pub(super) fn nearest<R: Real>(simplex: &Points<R>) -> (Points<R>, V3<R>) {
    for subset in SUBSETS {
        let Some(part) = chosen(simplex, subset) else { continue };
        let (Some(direction), Some(start)) = (towards(&part), part.first()) else { continue };
        let beyond = |p: &ExactDifference<R>| dot::<_, _, Degree4<R>>(&direction, &minus(&p.w, &start.w)).is_negative();
        if !simplex.iter().any(beyond) {
            return (part, direction);
        }
    }
    // Exact arithmetic always finds one.
    debug_assert!(false, "a simplex without a nearest point");
    (simplex.clone(), [Int::ZERO; 3])
}

/// The points at the positions of a subset; none if there are fewer points.
fn chosen<R: Real>(from: &Points<R>, subset: &[usize]) -> Option<Points<R>> {
    let mut part = Points::new();
    for &i in subset {
        part.push(*from.get(i)?).ok()?;
    }
    Some(part)
}

/// The direction from the origin to its foot on the plane, line or point that some points span, zero in a tetrahedron; none unless the foot
/// lies strictly inside their hull.
fn towards<R: Real>(points: &[ExactDifference<R>]) -> Option<V3<R>> {
    match points {
        [p] => Some(resized(&p.w)),
        [p, q] => {
            let e = minus(&q.w, &p.w);
            let before: Int2<R> = dot(&p.w, &e);
            let after: Int2<R> = dot(&q.w, &e);
            let area: V2<R> = cross(&p.w, &e);
            (before.is_negative() && after.is_positive()).then(|| cross(&e, &area))
        }
        [p, q, r] => {
            let normal: V2<R> = cross(&minus(&q.w, &p.w), &minus(&r.w, &p.w));
            let weight =
                |x: &V1<R>, y: &V1<R>| dot::<_, _, Degree4<R>>(&normal, &cross::<_, _, Degree2<R>>(x, y)).is_positive();
            if !(weight(&p.w, &q.w) && weight(&q.w, &r.w) && weight(&r.w, &p.w)) {
                return None;
            }
            let height: Int3<R> = dot(&normal, &p.w);
            Some(match height.sign() {
                Ordering::Greater => resized(&normal),
                Ordering::Less => negated(&resized(&normal)),
                Ordering::Equal => [Int::ZERO; 3],
            })
        }
        [p, q, r, s] => {
            let volume = |x: &V1<R>, y: &V1<R>, z: &V1<R>| turn::<R>(x, y, z);
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

/// The part of a cone that holds its point nearest to `target`, and the direction from that point to the target.
pub(super) fn nearest_in_cone<R: Real>(target: &V1<R>, cone: &Points<R>) -> (Points<R>, V3<R>) {
    let fits = |residual: &V3<R>| !cone.iter().any(|p| dot::<_, _, Degree4<R>>(residual, &p.w).is_positive());
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

/// The direction of the part of `target` that is perpendicular to the span of some points; none unless the rest lies strictly inside
/// their cone.
fn beside<R: Real>(target: &V1<R>, points: &[ExactDifference<R>]) -> Option<V3<R>> {
    match points {
        [p] => {
            let along: Int2<R> = dot(target, &p.w);
            along.is_positive().then(|| cross(&p.w, &cross::<_, _, Degree2<R>>(target, &p.w)))
        }
        [p, q] => {
            let normal: V2<R> = cross(&p.w, &q.w);
            let weight =
                |x: &V1<R>, y: &V1<R>| dot::<_, _, Degree4<R>>(&normal, &cross::<_, _, Degree2<R>>(x, y)).is_positive();
            if !(weight(target, &q.w) && weight(&p.w, target)) {
                return None;
            }
            let height: Int3<R> = dot(&normal, target);
            Some(match height.sign() {
                Ordering::Greater => resized(&normal),
                Ordering::Less => negated(&resized(&normal)),
                Ordering::Equal => [Int::ZERO; 3],
            })
        }
        [p, q, r] => {
            let volume = turn::<R>(&p.w, &q.w, &r.w);
            let signs = [turn::<R>(target, &q.w, &r.w), turn::<R>(&p.w, target, &r.w), turn::<R>(&p.w, &q.w, target)];
            (volume != Ordering::Equal && signs.iter().all(|&s| s == volume)).then_some([Int::ZERO; 3])
        }
        _ => None,
    }
}
