//! Closed surfaces that cross each other: where one lies in the other, and whether both hold something in common.

use crate::geometry::repair::closed::{Closed, beside, just_within};
use crate::geometry::repair::crossing::{Meetings, tolerance};
use crate::geometry::repair::face::bounds;
use glam::DVec3;

/// So many points times triangles are looked at, at most, for one surface: beyond, some points are left out.
const LOOKS: usize = 20_000_000;

/// Points just within a surface, one beside each part into which another divides those of its triangles that it meets. None where they do not meet.
#[must_use]
pub fn dividing(own: &Closed, other: &Closed) -> Vec<DVec3> {
    let near = |of: &Closed, [lo, hi]: [DVec3; 2]| -> Vec<[DVec3; 3]> {
        let touches = |t: &&[DVec3; 3]| {
            let [min, max] = bounds(t);
            min.cmple(hi).all() && max.cmpge(lo).all()
        };
        of.triangles.iter().filter(touches).copied().collect()
    };
    let cutting = near(other, own.bounds);
    let around =
        cutting.iter().flatten().fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[a, b], p| [a.min(*p), b.max(*p)]);
    let mut triangles = near(own, around);
    let count = triangles.len() as u32;
    if count == 0 {
        return Vec::new();
    }
    triangles.extend(cutting);
    let whole = [own.bounds[0].min(other.bounds[0]), own.bounds[1].max(other.bounds[1])];
    let meetings = Meetings::new(&triangles, tolerance(whole));
    let mut points = Vec::new();
    for n in (0..count).filter(|&n| meetings.meets(n)) {
        for part in meetings.parts(n) {
            let middle = part.iter().sum::<DVec3>() / part.len() as f64;
            points.extend(beside(&triangles[n as usize], middle, own.volume));
        }
    }
    let step = points.len().saturating_mul(other.triangles.len()) / LOOKS + 1;
    points.into_iter().step_by(step).collect()
}

/// Two closed shells whose volumes differ by less than this share are one surface twice.
const SAME: f64 = 1e-6;

/// Is `inner` inside `outer`, perhaps touching it? Told by its box and points just within its own surface: a spread of them, and where both surfaces meet one
/// for each part into which the other divides a triangle. Where two sides of that surface lie in one place and cancel, a point beside one is not within.
#[must_use]
pub fn contains(outer: &Closed, inner: &Closed) -> bool {
    let smaller = inner.volume.abs() < (1.0 - SAME) * outer.volume.abs();
    let step = (inner.triangles.len() / 16).max(1);
    let is_in = |p| outer.winds_around(p) || !inner.winds_around(p);
    let within = |t: &[DVec3; 3]| just_within(t, inner.volume).is_none_or(is_in);
    let all_within = || inner.triangles.iter().step_by(step).all(within);
    outer.is_around(inner) && smaller && all_within() && dividing(inner, outer).into_iter().all(is_in)
}

/// Do two closed surfaces hold something in common? Those that only touch do not.
#[must_use]
pub fn overlap(a: &Closed, b: &Closed) -> bool {
    let in_both = |p: DVec3| a.winds_around(p) && b.winds_around(p);
    let crosses = |a: &Closed, b: &Closed| dividing(a, b).into_iter().any(in_both);
    a.overlaps(b) && (contains(a, b) || contains(b, a) || crosses(a, b) || crosses(b, a))
}
