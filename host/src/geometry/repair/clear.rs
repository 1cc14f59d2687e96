//! Shells that meet themselves nowhere, which are most: told at a fraction of what it costs to tell where a shell meets itself.
//!
//! Every pair of triangles whose boxes touch is looked at (where too many do, those that no plane tells apart), with the numbers and the rules of
//! [`near`](crate::geometry::repair::face::near) and [`meeting`], bit for bit, but in another order: the cheapest that is enough comes first. So nothing is clear
//! here that meets there. Only which corners two triangles share is told later, of corners on the planes of both alone, as all are that they share if each
//! triangle lies in its own plane. What is not clear here may be clear there.

use crate::geometry::repair::boxes::Boxes;
use crate::geometry::repair::face::{CLEAR, Crossing, Face, meeting};
use crate::geometry::repair::separation::all_not_apart;
use glam::DVec3;
use std::cell::Cell;

/// Is it clear that no triangle of a closed surface cuts or covers another, and none has an edge with more than one other? Points closer than `on` to a plane
/// or line are on it.
#[must_use]
pub fn is_clear(triangles: &[[DVec3; 3]], on: f64) -> bool {
    let boxes = Boxes::new(triangles);
    let faces: Vec<Face> = boxes.order().map(|n| Face::new(triangles[n])).collect();
    if !(on.is_finite() && faces.iter().all(|face| face.holds_itself(on))) {
        return false;
    }
    let shared_sides = Cell::new(0);
    let mut is_clear = |m: usize, n: usize| {
        let found = sides_of_clear(&faces[m], &faces[n], on);
        shared_sides.set(shared_sides.get() + found.unwrap_or(0));
        found.is_some()
    };
    let clear = boxes.all_touching(&mut is_clear).unwrap_or_else(|| {
        shared_sides.set(0);
        all_not_apart(&faces, on, &mut is_clear)
    });
    // An edge of two is shared by one pair, an edge of four by six.
    clear && 2 * shared_sides.get() == 3 * faces.len()
}

/// The number of sides that two triangles share, if neither cuts or covers the other.
fn sides_of_clear(a: &Face, b: &Face, on: f64) -> Option<usize> {
    let over_a = Heights::new(a, b);
    let sides = over_a.sides_of_beside([a, b], on);
    if sides.is_some() {
        return sides;
    }
    let over_b = Heights::new(b, a);
    let sides = over_b.sides_of_beside([b, a], on);
    if sides.is_some() { sides } else { sides_unless_meeting([a, b], [&over_a, &over_b], on) }
}

/// The same of two triangles neither of which lies on one side of the other. Apart from it, so that the loops over pairs stay small.
#[inline(never)]
fn sides_unless_meeting([a, b]: [&Face; 2], [over_a, over_b]: [&Heights; 2], on: f64) -> Option<usize> {
    // As `is_apart` asks of triangles in one plane.
    let is_no_part = |depth: f64| depth <= on;
    if over_a.are_on(on) && over_b.are_on(on) {
        let is_clear = !a.has_area() || !b.has_area() || is_outside(a, b, is_no_part) || is_outside(b, a, is_no_part);
        return is_clear.then(|| a.shared_sides(b));
    }
    if over_a.have_no_segment(on) && over_b.have_no_segment(on) {
        return Some(0);
    }
    // As `near` asks of triangles that share no corner.
    let is_far = |depth: f64| depth < -CLEAR * on;
    let is_beyond = || is_outside(a, b, is_far) || is_outside(b, a, is_far);
    if !over_a.share_a_corner([a, b], on) && is_beyond() {
        return Some(0);
    }
    (over_a.cut_nothing([a, b], on) && over_b.cut_nothing([b, a], on)).then(|| a.shared_sides(b))
}

/// Is there a side of a triangle beyond which all corners of another lie, by their depth behind its line?
fn is_outside(face: &Face, other: &Face, is_beyond: impl Fn(f64) -> bool) -> bool {
    (0..3).any(|side| other.corners.iter().all(|&p| is_beyond(face.depth(side, p))))
}

/// Heights of the corners of a triangle over the plane of another.
struct Heights {
    each: [f64; 3],
    lowest: f64,
    highest: f64,
}

impl Heights {
    fn new(face: &Face, other: &Face) -> Self {
        let [a, b, c] = other.corners;
        let (a, b, c) = (face.height(a), face.height(b), face.height(c));
        let (lesser, larger) = (|a, b| if a < b { a } else { b }, |a, b| if a > b { a } else { b });
        Heights { each: [a, b, c], lowest: lesser(lesser(a, b), c), highest: larger(larger(a, b), c) }
    }

    /// Are all on the plane?
    fn are_on(&self, on: f64) -> bool {
        self.lowest >= -on && self.highest <= on
    }

    /// Are some above or below the plane, and not both?
    fn are_on_one_side(&self, on: f64) -> bool {
        (self.lowest < -on) != (self.highest > on)
    }

    /// The number of sides that two triangles share, if the second one lies on one side of the plane of the first, but for corners that both share.
    #[inline]
    fn sides_of_beside(&self, [face, other]: [&Face; 2], on: f64) -> Option<usize> {
        if self.lowest > on || self.highest < -on {
            return Some(0);
        }
        if !self.are_on_one_side(on) {
            return None;
        }
        let mut shared = 0;
        for (height, &p) in self.each.iter().zip(&other.corners) {
            if height.abs() <= on {
                if !face.has(p) {
                    return None;
                }
                shared += 1;
            }
        }
        Some(shared / 2)
    }

    /// Do they lie on one side of the plane, but for one at most? Then they have no segment in it.
    fn have_no_segment(&self, on: f64) -> bool {
        self.are_on_one_side(on) && self.each.iter().filter(|h| h.abs() <= on).count() <= 1
    }

    /// Have two triangles a corner in common?
    fn share_a_corner(&self, [face, other]: [&Face; 2], on: f64) -> bool {
        self.each.iter().zip(&other.corners).any(|(height, &p)| height.abs() <= on && face.has(p))
    }

    /// Does the second triangle have no segment in the plane of the first, or none within it?
    fn cut_nothing(&self, [face, other]: [&Face; 2], on: f64) -> bool {
        self.have_no_segment(on) || meeting(face, other, &self.each, on, || false) == Crossing::None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::repair::crossing::{Meetings, tolerance};
    use crate::geometry::repair::face::{bounds, is_apart, near};

    /// Numbers below `n`, by chance.
    struct Chance(u64);

    impl Chance {
        fn below(&mut self, n: usize) -> usize {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 33) as usize % n
        }

        fn shift(&mut self, most: i64) -> [i64; 3] {
            [(); 3].map(|()| self.below(2 * most.unsigned_abs() as usize + 1) as i64 - most)
        }
    }

    type Point = [i64; 3];

    /// Around a ball: rings of whole coordinates, and two poles.
    fn ball(rings: usize, around: usize) -> (Vec<Point>, Vec<[usize; 3]>) {
        let at = |ring: usize, n: usize| {
            let (polar, turn) = (ring as f64 / (rings + 1) as f64, n as f64 / around as f64);
            let ((s, z), (y, x)) = ((polar * std::f64::consts::PI).sin_cos(), (turn * std::f64::consts::TAU).sin_cos());
            [s * x, s * y, z].map(|c| (1000.0 * c).round() as i64)
        };
        let mut points = vec![[0, 0, 1000], [0, 0, -1000]];
        points.extend((0..rings).flat_map(|ring| (0..around).map(move |n| at(ring + 1, n))));
        let v = |ring: usize, n: usize| 2 + ring * around + n % around;
        let mut triangles = Vec::new();
        for n in 0..around {
            triangles.push([0, v(0, n), v(0, n + 1)]);
            triangles.push([1, v(rings - 1, n + 1), v(rings - 1, n)]);
            for ring in 1..rings {
                triangles.push([v(ring - 1, n), v(ring, n), v(ring, n + 1)]);
                triangles.push([v(ring - 1, n), v(ring, n + 1), v(ring - 1, n + 1)]);
            }
        }
        (points, triangles)
    }

    /// Around a block: so many squares along each edge.
    fn block(squares: usize) -> (Vec<Point>, Vec<[usize; 3]>) {
        let mut points = Vec::new();
        let mut number = |p: Point| {
            points.iter().position(|&q| q == p).unwrap_or_else(|| {
                points.push(p);
                points.len() - 1
            })
        };
        let mut triangles = Vec::new();
        for (axis, high, i, j) in
            (0..6 * squares * squares).map(|n| (n % 3, n / 3 % 2, n / 6 % squares, n / 6 / squares))
        {
            let mut at = |i: usize, j: usize| {
                let mut p = [0; 3];
                (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (high * squares, i, j);
                number(p.map(|c| 60 * c as i64))
            };
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            let quad = if high == 1 { [a, b, c, d] } else { [a, d, c, b] };
            triangles.extend([[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]);
        }
        (points, triangles)
    }

    /// On which side of a plane through three points another one lies, exactly.
    fn side([a, b, c]: [Point; 3], p: Point) -> i128 {
        let [u, v, w] = [b, c, p].map(|q| [0, 1, 2].map(|i| i128::from(q[i] - a[i])));
        let cross = |i: usize, j: usize| u[i] * v[j] - u[j] * v[i];
        (cross(1, 2) * w[0] + cross(2, 0) * w[1] + cross(0, 1) * w[2]).signum()
    }

    /// Does a line from a point to another pass through the inner part of a triangle, exactly?
    fn pierces([from, to]: [Point; 2], [a, b, c]: [Point; 3]) -> bool {
        let around = [[a, b], [b, c], [c, a]].map(|[p, q]| side([from, to, p], q));
        side([a, b, c], from) * side([a, b, c], to) < 0 && around[0] != 0 && around.iter().all(|&s| s == around[0])
    }

    fn any_pierces(points: &[Point], triangles: &[[usize; 3]]) -> bool {
        let corners = |t: &[usize; 3]| t.map(|v| points[v]);
        let through = |t: &[usize; 3], other: &[usize; 3]| {
            (0..3).any(|i| pierces([points[t[i]], points[t[(i + 1) % 3]]], corners(other)))
        };
        triangles.iter().enumerate().any(|(n, t)| triangles[..n].iter().any(|o| through(t, o) || through(o, t)))
    }

    /// As they are found one by one, slowly.
    fn meets(triangles: &[[DVec3; 3]], on: f64) -> bool {
        let meetings = Meetings::new(triangles, on);
        (0..triangles.len() as u32).any(|n| meetings.meets(n))
    }

    /// A ball or a block with some corners moved: over the edge or the triangle opposite to them, onto a neighbour, in a plane, or anywhere near.
    fn bent(chance: &mut Chance) -> (Vec<Point>, Vec<[usize; 3]>) {
        let is_ball = chance.below(2) == 0;
        let (mut points, triangles) =
            if is_ball { ball(1 + chance.below(4), 3 + chance.below(6)) } else { block(1 + chance.below(3)) };
        for _ in 0..1 + chance.below(3) {
            let t = triangles[chance.below(triangles.len())];
            let [a, b, c] = t.map(|v| points[v]);
            let most = if is_ball { [0, 1, 3, 60][chance.below(4)] } else { 0 };
            let slightly = chance.shift(most);
            let by_squares = chance.shift(2).map(|c| 30 * c);
            let to = match chance.below(6) {
                0 => [0, 1, 2].map(|i| b[i] + c[i] - a[i]),
                1 => [0, 1, 2].map(|i| (b[i] + c[i]) / 2),
                2 => [0, 1, 2].map(|i| (9 * (b[i] + c[i]) - 2 * a[i]) / 16),
                3 => b,
                4 => [0, 1, 2].map(|i| a[i] * 7 / 8),
                _ => [0, 1, 2].map(|i| a[i] + by_squares[i]),
            };
            points[t[0]] = [0, 1, 2].map(|i| to[i] + slightly[i]);
        }
        (points, triangles)
    }

    #[test]
    fn no_crossing_is_missed() {
        let mut chance = Chance(7);
        let mut found = [0; 2];
        for n in 0..3000 {
            let (points, triangles) = bent(&mut chance);
            let (scale, shift) = [(1.0, 0.0), (2_f64.powi(-90), 0.0), (2_f64.powi(90), 0.0), (1.0, 1e6)][n % 4];
            let place = |p: Point| DVec3::from_array(p.map(|c| (c as f64 + shift) * scale));
            let all: Vec<[DVec3; 3]> = triangles.iter().map(|t| t.map(|v| place(points[v]))).collect();
            let corners = || all.iter().flatten().copied();
            let bounds = [corners().reduce(DVec3::min), corners().reduce(DVec3::max)].map(|p| p.expect("corners"));
            let clear = is_clear(&all, tolerance(bounds));
            assert!(!clear || !any_pierces(&points, &triangles), "{n}: {points:?} {triangles:?}");
            assert!(!clear || !meets(&all, tolerance(bounds)), "{n}: {points:?} {triangles:?}");
            found[usize::from(clear)] += 1;
        }
        assert!(found.iter().all(|&count| count > 500), "{found:?}");
    }

    /// As pairs are looked at where a shell meets itself.
    fn meet(a: &Face, b: &Face, on: f64) -> bool {
        let seen = a.sees(b);
        let Some(back) = near(a, b, &seen, on) else { return false };
        let apart = |face: &Face, other: &Face| is_apart(&other.corners.map(|p| face.inward(p)), on);
        let covers = || a.has_area() && b.has_area() && !apart(a, b) && !apart(b, a);
        meeting(a, b, &seen.heights, on, covers) != Crossing::None
            || meeting(b, a, &back.heights, on, covers) != Crossing::None
    }

    #[test]
    fn a_pair_is_clear_if_it_does_not_meet() {
        let mut chance = Chance(11);
        let mut found = [0; 2];
        for _ in 0..300_000 {
            // Close together, and some far off: needles among them.
            let mut point = || {
                let most = if chance.below(8) == 0 { 1_000_000 } else { 2 };
                DVec3::from_array(chance.shift(most).map(|c| c as f64))
            };
            let mut corners = [[point(), point(), point()], [point(), point(), point()]];
            let shared = chance.below(4).min(2);
            for corner in 0..shared {
                corners[1][(corner + chance.below(3)) % 3] = corners[0][corner];
            }
            let on = 1e-13 * corners.as_flattened().iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
            let [a, b] = corners.map(Face::new);
            if !a.holds_itself(on) || !b.holds_itself(on) {
                continue;
            }
            let clear = sides_of_clear(&a, &b, on);
            assert!(clear.is_none_or(|sides| sides == a.shared_sides(&b)), "{corners:?}");
            assert_eq!(clear.is_none(), meet(&a, &b, on), "{corners:?}");
            found[usize::from(clear.is_some())] += 1;
        }
        assert!(found.iter().all(|&count| count > 20_000), "{found:?}");
    }

    #[test]
    fn an_edge_of_four_is_not_clear() {
        let (points, triangles) = ball(1, 4);
        let place = |p: Point, shift: f64| DVec3::from_array(p.map(|c| c as f64)) + DVec3::X * shift;
        let one =
            |shift: f64| -> Vec<[DVec3; 3]> { triangles.iter().map(|t| t.map(|v| place(points[v], shift))).collect() };
        assert!(is_clear(&one(0.0), 1e-10));
        // In a corner they touch.
        assert!(is_clear(&[one(0.0), one(2000.0)].concat(), 1e-10));
        let box_of = |x: f64| -> Vec<[DVec3; 3]> {
            let at = |i: usize| DVec3::new(x + (i & 1) as f64, (i >> 1 & 1) as f64 - x, (i >> 2) as f64);
            let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
            quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]].map(|t| t.map(at))).collect()
        };
        assert!(is_clear(&box_of(0.0), 1e-13));
        assert!(!is_clear(&[box_of(0.0), box_of(1.0)].concat(), 1e-13));
    }

    /// Turned around an axis that leans: a profile of radii and heights, in whole numbers; the ends may be poles. With a `spike` one
    /// corner is drawn through the other side.
    fn turned(profile: &[[f64; 2]], around: usize, spike: bool) -> (Vec<Point>, Vec<[usize; 3]>) {
        let axes = [[0.48, 0.6, 0.64], [-0.64, 0.768, -0.024], [-0.6, -0.224, 0.768]].map(DVec3::from_array);
        let at = |[radius, height]: [f64; 2], turn: f64, to: f64| {
            let (y, x) = (turn / around as f64 * std::f64::consts::TAU).sin_cos();
            let p = axes[0] * (x * radius * to) + axes[1] * (y * radius * to) + axes[2] * height;
            (p * 1e6).to_array().map(|c| c.round() as i64)
        };
        let (mut points, mut rows) = (Vec::new(), Vec::new());
        for &ring in profile {
            let count = if ring[0] == 0.0 { 1 } else { around };
            rows.push((points.len(), count));
            points.extend((0..count).map(|n| at(ring, n as f64, 1.0)));
        }
        if spike {
            let row = rows.iter().position(|&(_, count)| count > 1).expect("a ring");
            points[rows[row].0] = at(profile[row], 0.5 * around as f64 + 0.37, 1.05);
        }
        if profile[0][0] > 0.0 {
            rows.push(rows[0]);
        }
        let mut triangles = Vec::new();
        for pair in rows.windows(2) {
            let v = |row: usize, n: usize| pair[row].0 + n % pair[row].1;
            for n in 0..around {
                let both = [[v(0, n), v(0, n + 1), v(1, n + 1)], [v(0, n), v(1, n + 1), v(1, n)]];
                triangles.extend(both.iter().filter(|[a, b, c]| a != b && b != c && c != a));
            }
        }
        (points, triangles)
    }

    /// Of `around` needles each, or twice as many: cone, two cones, cylinder, tube, disc with a hole, flange.
    const PROFILES: [&[[f64; 2]]; 6] = [
        &[[0.0, 0.0], [0.7, 0.0], [0.0, 2.0]],
        &[[0.0, -1.7], [0.5, 0.0], [0.0, 2.0]],
        &[[0.0, -1.0], [0.4, -1.0], [0.4, 1.0], [0.0, 1.0]],
        &[[0.4, -1.0], [0.4, 1.0], [0.33, 1.0], [0.33, -1.0]],
        &[[1.0, 0.0], [1.0, 0.02], [0.05, 0.02], [0.05, 0.0]],
        &[[0.3, 0.0], [0.9, 0.0], [0.9, 0.1], [0.5, 0.1], [0.4, 0.3], [0.4, 1.4], [0.3, 1.4]],
    ];

    /// Triangles without order, large and small, some of which share corners.
    fn soup(chance: &mut Chance, count: usize) -> (Vec<Point>, Vec<[usize; 3]>) {
        let mut points: Vec<Point> = (0..count).map(|_| chance.shift(1_000_000)).collect();
        let most = [300_000, 3000, 30][chance.below(3)];
        let mut triangles = Vec::new();
        for _ in 0..count {
            let first = chance.below(count);
            let mut beside = |by: i64| {
                points.push([0, 1, 2].map(|i| points[first][i] + chance.shift(by)[i]));
                points.len() - 1
            };
            triangles.push([first, beside(300_000), beside(most)]);
        }
        (points, triangles)
    }

    /// Which pairs planes do not tell apart; each is asked for once.
    fn not_apart(faces: &[Face], on: f64) -> std::collections::BTreeSet<[usize; 2]> {
        let mut seen = std::collections::BTreeSet::new();
        all_not_apart(faces, on, |m, n| {
            assert!(m != n && seen.insert([m.min(n), m.max(n)]));
            true
        });
        seen
    }

    #[test]
    fn triangles_that_a_plane_tells_apart_do_not_meet() {
        let mut chance = Chance(5);
        let (mut apart, mut meeting) = (0, 0);
        for n in 0..24 {
            let profile = PROFILES[n % PROFILES.len()];
            let (points, triangles) =
                if n % 4 == 3 { soup(&mut chance, 200) } else { turned(profile, 20 + chance.below(80), n % 4 > 0) };
            let all: Vec<[DVec3; 3]> =
                triangles.iter().map(|t| t.map(|v| DVec3::from_array(points[v].map(|c| c as f64)))).collect();
            let on = tolerance([DVec3::splat(-2e6), DVec3::splat(2e6)]);
            let faces: Vec<Face> = all.iter().map(|&t| Face::new(t)).collect();
            let seen = not_apart(&faces, on);
            let corners = |n: usize| triangles[n].map(|v| points[v]);
            let through = |m: usize, n: usize| {
                let t = corners(m);
                (0..3).any(|i| pierces([t[i], t[(i + 1) % 3]], corners(n)))
            };
            for (b, a) in (0..all.len()).flat_map(|b| (0..b).map(move |a| (b, a))) {
                if boxes_touch(&all[a], &all[b]) {
                    let cross = through(a, b) || through(b, a) || meet(&faces[a], &faces[b], on);
                    let told = !seen.contains(&[a, b]);
                    let clear = !cross && faces[a].shared_sides(&faces[b]) == 0;
                    assert!(!told || clear, "{n}: {:?} {:?}", corners(a), corners(b));
                    meeting += usize::from(cross);
                    apart += usize::from(told);
                }
            }
        }
        assert!(apart > 50_000 && meeting > 500, "{apart} {meeting}");
    }

    fn boxes_touch(a: &[DVec3; 3], b: &[DVec3; 3]) -> bool {
        let ([a, b], [c, d]) = (bounds(a), bounds(b));
        a.cmple(d).all() && c.cmple(b).all()
    }

    #[test]
    fn few_pairs_of_many_needles_are_looked_at() {
        for (n, profile) in PROFILES.iter().enumerate() {
            for spike in [false, true] {
                let (points, triangles) = turned(profile, 1000, spike);
                let all: Vec<[DVec3; 3]> =
                    triangles.iter().map(|t| t.map(|v| DVec3::from_array(points[v].map(|c| c as f64)))).collect();
                let faces: Vec<Face> = all.iter().map(|&t| Face::new(t)).collect();
                let on = tolerance([DVec3::splat(-2e6), DVec3::splat(2e6)]);
                let looked_at = not_apart(&faces, on).len();
                assert!(looked_at < 40 * all.len(), "{n} {spike}: {looked_at} pairs of {} triangles", all.len());
                assert_eq!(is_clear(&all, on), !spike, "{n}");
                assert_eq!(meets(&all, on), spike, "{n}");
            }
        }
    }

    #[test]
    fn what_no_plane_divides_is_looked_at_as_a_whole() {
        let needle = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1e-3, 0.0)];
        for t in [needle, [DVec3::ZERO; 3], [DVec3::ZERO, DVec3::X, DVec3::splat(f64::NAN)], needle.map(|p| p * 1e200)]
        {
            let seen = not_apart(&vec![Face::new(t); 100], 1e-13);
            assert!(seen.len() == 100 * 99 / 2 || t[2].is_nan());
        }
        assert!(not_apart(&[], 1e-13).is_empty());
    }

    #[test]
    fn every_pair_whose_boxes_touch_is_seen_once() {
        let mut chance = Chance(3);
        for n in 0..200 {
            let size = [1.0, 0.0, 5e-324, 1e-300, 1e300, 1e60][n % 6];
            let most = [2, 9, 400][n % 3];
            let place = |p: Point| DVec3::from_array(p.map(|c| c as f64 * size / most as f64));
            let triangles: Vec<[DVec3; 3]> = (0..n).map(|_| [(); 3].map(|()| place(chance.shift(most)))).collect();
            let boxes = Boxes::new(&triangles);
            let order: Vec<usize> = boxes.order().collect();
            let mut seen = std::collections::BTreeSet::new();
            let all = boxes.all_touching(|a, b| {
                let (a, b) = (order[a], order[b]);
                assert!(a != b && seen.insert([a.min(b), a.max(b)]));
                true
            });
            assert_eq!(all, Some(true));
            for (b, [low, high]) in triangles.iter().map(bounds).enumerate() {
                for (a, [min, max]) in triangles[..b].iter().map(bounds).enumerate() {
                    assert!(low.cmpgt(max).any() || high.cmplt(min).any() || seen.contains(&[a, b]));
                }
            }
        }
    }
}
