//! Triangles of a polygon, by clipping ears in its plane.
//!
//! The plane is that of Newell's normal; the projection along its largest axis only drops a coordinate. The triangles use each
//! edge of the polygon once and each diagonal twice, in opposite directions, whatever the polygon is: a surface closed before
//! stays closed. A convex polygon becomes the fan of its first corner.
//! References: G. H. Meisters, *Polygons have ears*, 1975; J. O'Rourke, *Computational Geometry in C*, ch. 1 (after a clip only
//! the two neighbours can have become ears); F. Tampieri, *Newell's method*, Graphics Gems III, 1992.

mod bins;

use std::collections::VecDeque;

use glam::{DVec2, DVec3};

use bins::EarBins;

/// Splits polygons, one after the other; keeps its memory and its count of steps.
pub struct EarClipper {
    /// Corners in the plane, counter-clockwise.
    flat: Vec<DVec2>,
    /// The ring of corners that are left.
    previous: Vec<usize>,
    next: Vec<usize>,
    clipped: Vec<bool>,
    /// Corners that are not convex: only these can lie in an ear, and a convex corner stays convex.
    blockers: Vec<usize>,
    /// The same by their places.
    bins: EarBins,
    is_blocker: Vec<bool>,
    /// Entries of `blockers` and `bins` that are none any more.
    stale: usize,
    /// Corners that may be ears. First in, first out: small ears all around go before large ones, which cost more to check.
    candidates: VecDeque<usize>,
    /// Steps left; see [`STEPS`].
    steps: u64,
}

/// Steps granted at the start and for each corner. Clipping takes n² steps and more for the worst polygons, which for a face of a
/// million corners would be for ever; so the time of a file is bounded by its size. A step takes a few nanoseconds.
const STEPS: u64 = 100_000_000;
const STEPS_PER_CORNER: u64 = 300;

/// How a polygon was split.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Split {
    /// Into ears; they do not overlap, unless the polygon crosses itself.
    Clean,
    /// Into some triangles that fit its edges, for want of an ear: the polygon has no area, or crosses itself.
    Forced,
    /// Not at all: it takes too many steps. Some triangles may have been given out.
    TooComplex,
}

/// What counts as an ear. When there is none, the next rule applies until one is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd)]
enum Rule {
    /// A convex corner whose triangle touches no other.
    Free,
    /// A convex corner whose triangle has no other inside.
    Touching,
    /// A corner of 180°.
    Straight,
    /// Any.
    Any,
}

impl EarClipper {
    pub fn new() -> Self {
        EarClipper {
            flat: Vec::new(),
            previous: Vec::new(),
            next: Vec::new(),
            clipped: Vec::new(),
            blockers: Vec::new(),
            bins: EarBins::default(),
            is_blocker: Vec::new(),
            stale: 0,
            candidates: VecDeque::new(),
            steps: STEPS,
        }
    }

    /// Splits a polygon of n ≥ 3 finite corners into n − 2 triangles of its winding, given out as indices of corners.
    pub fn split(&mut self, corners: &[DVec3], mut emit: impl FnMut([usize; 3])) -> Split {
        if corners.len() <= 3 {
            if corners.len() == 3 {
                emit([0, 1, 2]);
            }
            return Split::Clean;
        }
        if !self.flatten(corners) {
            (2..corners.len()).for_each(|i| emit([0, i - 1, i]));
            return Split::Forced;
        }
        self.steps = self.steps.saturating_add(STEPS_PER_CORNER * corners.len() as u64);
        self.start();
        self.clip(&mut emit)
    }

    /// Projects the corners; false if they have no area.
    fn flatten(&mut self, corners: &[DVec3]) -> bool {
        let largest = corners.iter().fold(0.0, |largest: f64, corner| largest.max(corner.abs().max_element()));
        let scale = inverse_power_of_two(largest);
        let origin = corners[0] * scale;
        let scaled = |i: usize| corners[i % corners.len()] * scale - origin;
        let normal = (0..corners.len()).fold(DVec3::ZERO, |sum, i| sum + newell(scaled(i), scaled(i + 1)));
        let size = normal.abs();
        if size.max_element() <= 0.0 {
            return false;
        }
        // The two axes that, seen along the third, turn as the normal does.
        let (u, v, along) = match size {
            _ if size.x >= size.y && size.x >= size.z => (1, 2, normal.x),
            _ if size.y >= size.z => (2, 0, normal.y),
            _ => (0, 1, normal.z),
        };
        let (u, v) = if along > 0.0 { (u, v) } else { (v, u) };
        self.flat.clear();
        self.flat.extend((0..corners.len()).map(|i| DVec2::new(scaled(i)[u], scaled(i)[v])));
        true
    }

    /// All corners in one ring and all of them candidates, the second first, so that a convex polygon becomes a fan.
    fn start(&mut self) {
        let n = self.flat.len();
        self.previous.clear();
        self.previous.extend((0..n).map(|i| (i + n - 1) % n));
        self.next.clear();
        self.next.extend((0..n).map(|i| (i + 1) % n));
        self.clipped.clear();
        self.clipped.resize(n, false);
        let is_blocker = (0..n).map(|i| self.turn(i) <= 0.0).collect();
        self.is_blocker = is_blocker;
        self.blockers.clear();
        self.blockers.extend((0..n).filter(|&i| self.is_blocker[i]));
        self.bins.fill(&self.flat, &self.blockers);
        self.stale = 0;
        self.candidates.clear();
        self.candidates.extend((1..n).chain([0]));
    }

    fn clip(&mut self, emit: &mut impl FnMut([usize; 3])) -> Split {
        let (mut left, mut rule, mut split) = (self.flat.len(), Rule::Free, Split::Clean);
        while left > 2 {
            let Some(corner) = self.candidates.pop_front() else {
                rule = rule.looser();
                self.candidates.extend((0..self.flat.len()).filter(|&i| !self.clipped[i]));
                continue;
            };
            if self.clipped[corner] {
                continue;
            }
            // The last triangle is what is left, ear or not.
            let is_ear = left == 3 || self.is_ear(corner, rule);
            if self.steps == 0 {
                return Split::TooComplex;
            }
            if !is_ear {
                continue;
            }
            if rule == Rule::Any || (left == 3 && self.turn(corner) < 0.0) {
                split = Split::Forced;
            }
            let [before, after] = [self.previous[corner], self.next[corner]];
            emit([before, corner, after]);
            self.clipped[corner] = true;
            (self.next[before], self.previous[after]) = (after, before);
            self.release([corner, before, after]);
            (left, rule) = (left - 1, Rule::Free);
            self.candidates.extend([before, after]);
        }
        split
    }

    /// Strikes corners off the blockers that were clipped or have become convex.
    fn release(&mut self, corners: [usize; 3]) {
        for corner in corners {
            if self.is_blocker[corner] && (self.clipped[corner] || self.turn(corner) > 0.0) {
                self.is_blocker[corner] = false;
                self.stale += 1;
            }
        }
        if self.stale * 2 > self.blockers.len() {
            self.blockers.retain(|&i| self.is_blocker[i]);
            self.bins.fill(&self.flat, &self.blockers);
            self.stale = 0;
        }
    }

    /// Twice the area of the triangle at a corner; positive if the corner is convex.
    fn turn(&self, corner: usize) -> f64 {
        let [a, b, c] = [self.previous[corner], corner, self.next[corner]].map(|i| self.flat[i]);
        (b - a).perp_dot(c - b)
    }

    fn is_ear(&mut self, corner: usize, rule: Rule) -> bool {
        self.spend(1);
        let turn = self.turn(corner);
        match rule {
            Rule::Any => true,
            Rule::Straight => turn == 0.0,
            Rule::Touching | Rule::Free => turn > 0.0 && !self.is_blocked(corner, rule == Rule::Free),
        }
    }

    /// Whether another corner lies in the triangle at this one, or, if `closed`, on its edge. Corners at the same place as one
    /// of the triangle do not count: they are the two ends of a cut that joins a hole to the outline.
    fn is_blocked(&mut self, corner: usize, closed: bool) -> bool {
        let [a, b, c] = [self.previous[corner], corner, self.next[corner]].map(|i| self.flat[i]);
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let mut steps = 0;
        let mut lies_within = |&i: &usize| {
            steps += 1;
            let p = self.flat[i];
            if !self.is_blocker[i] || p.cmplt(low).any() || p.cmpgt(high).any() || p == a || p == b || p == c {
                return false;
            }
            let sides = [(b - a).perp_dot(p - a), (c - b).perp_dot(p - b), (a - c).perp_dot(p - c)];
            sides.iter().all(|&side| if closed { side >= 0.0 } else { side > 0.0 })
        };
        let is_blocked = match self.bins.rows(low, high, self.blockers.len()) {
            Some(mut rows) => rows.any(|row| row.iter().any(&mut lies_within)),
            None => self.blockers.iter().any(lies_within),
        };
        self.spend(steps);
        is_blocked
    }

    fn spend(&mut self, steps: u64) {
        self.steps = self.steps.saturating_sub(steps);
    }
}

impl Rule {
    fn looser(self) -> Self {
        match self {
            Rule::Free => Rule::Touching,
            Rule::Touching => Rule::Straight,
            Rule::Straight | Rule::Any => Rule::Any,
        }
    }
}

/// Term of Newell's sum for an edge: twice the areas that it sweeps on the coordinate planes.
fn newell(a: DVec3, b: DVec3) -> DVec3 {
    DVec3::new((a.y - b.y) * (a.z + b.z), (a.z - b.z) * (a.x + b.x), (a.x - b.x) * (a.y + b.y))
}

/// The power of two that brings a number to [1, 2), exactly. Coordinates near the ends of the range would overflow in products.
fn inverse_power_of_two(value: f64) -> f64 {
    let exponent = (value.to_bits() >> 52) as i32 & 0x7ff;
    2f64.powi((1023 - exponent).min(1023))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Area of the triangles as a set, and of the polygon, both seen from +z. Equal if and only if no triangle is turned.
    fn areas(corners: &[DVec3], split: &[[usize; 3]]) -> (f64, f64) {
        let of = |t: &[usize; 3]| (corners[t[1]] - corners[t[0]]).cross(corners[t[2]] - corners[t[0]]).length() / 2.0;
        let newell = (0..corners.len())
            .fold(DVec3::ZERO, |sum, i| sum + newell(corners[i], corners[(i + 1) % corners.len()]))
            .length()
            / 2.0;
        (split.iter().map(of).sum(), newell)
    }

    fn split(corners: &[DVec3]) -> (Split, Vec<[usize; 3]>) {
        let mut triangles = Vec::new();
        let how = EarClipper::new().split(corners, |t| triangles.push(t));
        (how, triangles)
    }

    /// From any first corner, in any of the three planes, in both windings and far from the origin.
    fn check(outline: &[[f64; 2]]) {
        let n = outline.len();
        for turn in 0..n {
            for axis in 0..3 {
                for mirrored in [false, true] {
                    let corner = |i: usize| {
                        let i = if mirrored { n - 1 - i } else { i };
                        let [x, y] = outline[(i + turn) % n];
                        let mut p = [0.25, 0.25, 0.25];
                        p[axis] = x;
                        p[(axis + 1) % 3] = y + 1000.0;
                        DVec3::from_array(p)
                    };
                    let corners: Vec<DVec3> = (0..n).map(corner).collect();
                    let (how, triangles) = split(&corners);
                    assert_eq!(how, Split::Clean, "{outline:?} from {turn}");
                    assert_eq!(triangles.len(), n - 2);
                    let (sum, whole) = areas(&corners, &triangles);
                    assert!((sum - whole).abs() < 1e-9 * whole, "{outline:?} from {turn}: {sum} is not {whole}");
                }
            }
        }
    }

    #[test]
    fn a_convex_polygon_is_a_fan() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::new(2.0, 1.0, 0.0), DVec3::new(1.0, 2.0, 0.0), DVec3::Y];
        assert_eq!(split(&corners), (Split::Clean, vec![[0, 1, 2], [0, 2, 3], [0, 3, 4]]));
    }

    #[test]
    fn concave_outlines_are_covered_once() {
        check(&[[0., 0.], [2., 0.], [2., 1.], [1., 1.], [1., 2.], [0., 2.]]);
        check(&[[0., 0.], [4., 0.], [4., 3.], [3., 3.], [3., 1.], [1., 1.], [1., 3.], [0., 3.]]);
        // An arrow, a star, a spiral.
        check(&[[0., 0.], [2., 1.], [0., 2.], [0.9, 1.]]);
        let star: Vec<_> = (0..14)
            .map(|i| (0.3 + 0.7 * (i % 2) as f64, i as f64 * std::f64::consts::TAU / 14.0))
            .map(|(r, angle)| [r * angle.cos(), r * angle.sin()])
            .collect();
        check(&star);
        let arm = |r0: f64, i: usize| (r0 + i as f64 * 0.05, i as f64 * 0.3);
        let spiral: Vec<_> = (0..60)
            .map(|i| arm(1.0, i))
            .chain((0..60).rev().map(|i| arm(0.6, i)))
            .map(|(r, angle)| [r * angle.cos(), r * angle.sin()])
            .collect();
        check(&spiral);
    }

    #[test]
    fn straight_corners_and_a_hole_joined_by_a_cut() {
        check(&[[0., 0.], [1., 0.], [2., 0.], [2., 1.], [2., 2.], [1., 2.], [0., 2.], [0., 1.]]);
        check(&[[0., 0.], [3., 0.], [3., 3.], [0., 3.], [0., 0.], [1., 1.], [1., 2.], [2., 2.], [2., 1.], [1., 1.]]);
    }

    #[test]
    fn no_area_and_crossing_edges_still_close() {
        let line: Vec<_> = (0..5).map(|i| DVec3::splat(i as f64)).collect();
        assert_eq!(split(&line).0, Split::Forced);
        assert_eq!(split(&[DVec3::ONE; 4]).1.len(), 2);
        let bow_tie = [[0., 0.], [3., 3.], [3., 0.], [0., 1.]].map(|[x, y]| DVec3::new(x, y, 0.0));
        let (how, triangles) = split(&bow_tie);
        assert_eq!((how, triangles.len()), (Split::Forced, 2));
        let pentagram: Vec<_> =
            (0..5).map(|i| DVec2::from_angle(i as f64 * 0.8 * std::f64::consts::PI).extend(0.0)).collect();
        assert_eq!(split(&pentagram).1.len(), 3);
    }

    #[test]
    fn extreme_coordinates_do_not_overflow() {
        for size in [f64::MAX, 1e300, 1e-300, f64::MIN_POSITIVE, 5e-324] {
            let corners =
                [[-1., -1.], [1., -1.], [0., 0.], [1., 1.], [-1., 1.]].map(|[x, y]| DVec3::new(x, y, 0.5) * size);
            let (how, triangles) = split(&corners);
            assert_eq!((how, triangles.len()), (Split::Clean, 3), "{size}");
        }
    }

    #[test]
    fn many_corners_are_no_matter() {
        let n = 100_000;
        let radius = |i: usize| 1.0 + 0.1 * (i % 2) as f64;
        let gear: Vec<_> = (0..n)
            .map(|i| (DVec2::from_angle(i as f64 * std::f64::consts::TAU / n as f64) * radius(i)).extend(0.0))
            .collect();
        let (how, triangles) = split(&gear);
        assert_eq!((how, triangles.len()), (Split::Clean, n - 2));
        let (sum, whole) = areas(&gear, &triangles);
        assert!((sum - whole).abs() < 1e-9);
    }

    #[test]
    fn a_plate_with_many_holes() {
        // Rows of round holes, each joined to the next by a cut, and the first to the plate's left edge.
        let (rows, holes, sides) = (40, 40, 24);
        let mut plate = vec![DVec2::ZERO, DVec2::new(holes as f64, 0.0), DVec2::new(holes as f64, rows as f64)];
        let on_hole = |row: usize, hole: usize, side: usize| {
            let angle = (side as f64 / sides as f64 - 0.5) * std::f64::consts::TAU;
            DVec2::new(hole as f64 + 0.5, row as f64 + 0.5) + DVec2::from_angle(angle) * 0.4
        };
        plate.push(DVec2::new(0.0, rows as f64));
        for row in (0..rows).rev() {
            let edge = DVec2::new(0.0, row as f64 + 0.5);
            plate.push(edge);
            // Clockwise around the holes: out along their upper halves, back along the lower.
            (0..holes).for_each(|hole| plate.extend((sides / 2..=sides).rev().map(|side| on_hole(row, hole, side))));
            (0..holes).rev().for_each(|hole| plate.extend((0..=sides / 2).rev().map(|side| on_hole(row, hole, side))));
            plate.push(edge);
        }
        let corners: Vec<_> = plate.iter().map(|p| p.extend(1.0)).collect();
        let (how, triangles) = split(&corners);
        assert_eq!((how, triangles.len()), (Split::Clean, corners.len() - 2));
        let (sum, whole) = areas(&corners, &triangles);
        assert!((sum - whole).abs() < 1e-9 * whole, "{sum} is not {whole}");
    }

    #[test]
    fn what_takes_for_ever_is_given_up() {
        // A scribble: thousands of crossings, and no order in x helps.
        let scribble: Vec<_> =
            (0..30_000).map(|i| DVec2::from_angle((i * i % 30_011) as f64) * (i % 1009) as f64).collect();
        let corners: Vec<_> = scribble.iter().map(|p| p.extend(0.0)).collect();
        let mut ears = EarClipper::new();
        ears.steps = 1_000_000;
        assert_eq!(ears.split(&corners, |_| {}), Split::TooComplex);
        assert_eq!(ears.split(&corners, |_| {}), Split::TooComplex);
    }
}
