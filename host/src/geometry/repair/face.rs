//! Triangles with their planes: how they meet, and convex polygons cut by planes.

use glam::DVec3;

/// A triangle with its plane.
#[derive(Clone, Copy, Debug)]
pub struct Face {
    /// Its corners.
    pub corners: [DVec3; 3],
    /// Unit normal; zero if it has no area.
    pub normal: DVec3,
}

impl Face {
    /// Of three corners.
    #[must_use]
    pub fn new(corners: [DVec3; 3]) -> Self {
        let [a, b, c] = corners;
        // The longest two sides give the most digits.
        let normals = [(b - a).cross(c - a), (c - b).cross(a - b), (a - c).cross(b - c)];
        let largest =
            normals.into_iter().fold(DVec3::ZERO, |l, n| if n.length_squared() > l.length_squared() { n } else { l });
        Face { corners, normal: largest.normalize_or_zero() }
    }

    /// Signed distance of a point from the plane.
    #[must_use]
    pub fn height(&self, p: DVec3) -> f64 {
        self.normal.dot(p - self.corners[0])
    }

    /// Distances of a point inward from the lines of the sides, in the plane.
    #[must_use]
    pub fn inward(&self, p: DVec3) -> [f64; 3] {
        [0, 1, 2].map(|i| {
            let (a, b) = (self.corners[i], self.corners[(i + 1) % 3]);
            self.normal.cross(b - a).normalize_or_zero().dot(p - a)
        })
    }
}

/// How a triangle meets the inner part of another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Crossing {
    /// It does not.
    None,
    /// Across, along this segment.
    Cut([DVec3; 2]),
    /// It lies in the same plane, on the same spot.
    Cover,
}

/// How `other` meets the inner part of `face`.
#[must_use]
pub fn meeting(face: &Face, other: &Face, on: f64) -> Crossing {
    let shared = other.corners.map(|p| face.corners.contains(&p));
    let heights = [0, 1, 2].map(|i| if shared[i] { 0.0 } else { face.height(other.corners[i]) });
    let (above, below) = (heights.iter().any(|&h| h > on), heights.iter().any(|&h| h < -on));
    if !above && !below {
        return if covers(face, other, on) { Crossing::Cover } else { Crossing::None };
    }
    let mut ends = [DVec3::ZERO; 2];
    let mut count = 0;
    let mut end = |p: DVec3| {
        if count < 2 {
            ends[count] = p;
        }
        count += 1;
    };
    for i in 0..3 {
        let j = (i + 1) % 3;
        let (p, q, hp, hq) = (other.corners[i], other.corners[j], heights[i], heights[j]);
        if hp.abs() <= on {
            end(p);
        } else if hp.abs() > on && hq.abs() > on && (hp > 0.0) != (hq > 0.0) {
            end(p + (q - p) * (hp / (hp - hq)));
        }
    }
    if count != 2 {
        return Crossing::None;
    }
    // The part of the segment that lies within the triangle, off its sides.
    let (from, to) = (face.inward(ends[0]), face.inward(ends[1]));
    let (mut lo, mut hi) = (0.0_f64, 1.0_f64);
    for i in 0..3 {
        let (a, b) = (from[i] - on, to[i] - on);
        if a <= 0.0 && b <= 0.0 {
            return Crossing::None;
        }
        if a <= 0.0 {
            lo = lo.max(a / (a - b));
        } else if b <= 0.0 {
            hi = hi.min(a / (a - b));
        }
    }
    if (hi - lo) * ends[0].distance(ends[1]) > on { Crossing::Cut(ends) } else { Crossing::None }
}

/// A side that lies on another triangle for no more than so many tolerances touches it in a point.
const TOUCH: f64 = 16.0;

/// The sides of `other`, from each of its corners to the next, that lie on `face` for some length and are not sides of it.
#[must_use]
pub fn sides_on(face: &Face, other: &Face, on: f64) -> [bool; 3] {
    if face.normal == DVec3::ZERO || other.normal == DVec3::ZERO {
        return [false; 3];
    }
    let shared = other.corners.map(|p| face.corners.contains(&p));
    let in_plane = [0, 1, 2].map(|i| shared[i] || face.height(other.corners[i]).abs() <= on);
    [0, 1, 2].map(|i| {
        let j = (i + 1) % 3;
        if !in_plane[i] || !in_plane[j] || (shared[i] && shared[j]) {
            return false;
        }
        let (p, q) = (other.corners[i], other.corners[j]);
        let (from, to) = (face.inward(p), face.inward(q));
        let (mut lo, mut hi) = (0.0_f64, 1.0_f64);
        for side in 0..3 {
            let (a, b) = (from[side] + on, to[side] + on);
            if a < 0.0 && b < 0.0 {
                return false;
            }
            if a < 0.0 {
                lo = lo.max(a / (a - b));
            } else if b < 0.0 {
                hi = hi.min(a / (a - b));
            }
        }
        (hi - lo) * p.distance(q) > TOUCH * on
    })
}

/// Do two triangles in one plane share more than their sides?
fn covers(a: &Face, b: &Face, on: f64) -> bool {
    let apart = |a: &Face, b: &Face| {
        let inward = b.corners.map(|p| a.inward(p));
        (0..3).any(|side| inward.iter().all(|d| d[side] <= on))
    };
    a.normal != DVec3::ZERO && b.normal != DVec3::ZERO && !apart(a, b) && !apart(b, a)
}

/// Cut convex polygons by the plane through `at` normal to `normal`, those near the box `lo..hi`.
pub fn cut(parts: &mut Vec<Vec<DVec3>>, at: DVec3, normal: DVec3, [lo, hi]: [DVec3; 2], on: f64) {
    let mut more = Vec::new();
    for part in parts.iter_mut() {
        let (min, max) = part.iter().fold((part[0], part[0]), |(a, b), p| (a.min(*p), b.max(*p)));
        if min.cmpgt(hi).any() || max.cmplt(lo).any() {
            continue;
        }
        let heights: Vec<f64> = part.iter().map(|p| normal.dot(*p - at)).collect();
        if !(heights.iter().any(|&h| h > on) && heights.iter().any(|&h| h < -on)) {
            continue;
        }
        let (mut above, mut below) = (Vec::new(), Vec::new());
        for i in 0..part.len() {
            let j = (i + 1) % part.len();
            let (p, q, hp, hq) = (part[i], part[j], heights[i], heights[j]);
            if hp >= -on {
                above.push(p);
            }
            if hp <= on {
                below.push(p);
            }
            if (hp > on && hq < -on) || (hp < -on && hq > on) {
                // From the lower end, so that neighbours get the same point.
                let (p, q, hp, hq) = if hp < hq { (p, q, hp, hq) } else { (q, p, hq, hp) };
                let mut crossing = p + (q - p) * (hp / (hp - hq));
                // In a plane along the axes to the last digit.
                if let Some(axis) = (0..3).find(|&a| normal[a].abs() == 1.0) {
                    crossing[axis] = at[axis];
                }
                above.push(crossing);
                below.push(crossing);
            }
        }
        *part = above;
        more.push(below);
    }
    parts.append(&mut more);
}

/// Does `b` lie off the plane of `a`, all on one side, but for corners that they share? Most neighbours do.
#[must_use]
pub fn beside(a: &Face, b: &Face, on: f64) -> bool {
    let mut sides = [false; 2];
    for p in b.corners.iter().filter(|p| !a.corners.contains(p)) {
        let height = a.height(*p);
        if height.abs() <= on {
            return false;
        }
        sides[usize::from(height > 0.0)] = true;
    }
    sides[0] != sides[1]
}

/// Add those of the convex parts of a triangle that are wanted, as they are (`true`) or turned; the triangle itself if all are wanted alike,
/// for the corners of parts are rounded.
pub fn push_parts<'a>(
    surface: &mut Vec<[DVec3; 3]>,
    whole: [DVec3; 3],
    parts: impl Iterator<Item = (&'a [DVec3], Option<bool>)> + Clone,
) {
    let mut push = |[a, b, c]: [DVec3; 3], as_it_is: bool| surface.push(if as_it_is { [a, b, c] } else { [a, c, b] });
    let first = parts.clone().next().and_then(|(_, wanted)| wanted);
    match first {
        Some(way) if parts.clone().all(|(_, wanted)| wanted == first) => push(whole, way),
        _ => {
            for (part, way) in parts.filter_map(|(part, wanted)| Some((part, wanted?))) {
                (1..part.len() - 1).for_each(|i| push([part[0], part[i], part[i + 1]], way));
            }
        }
    }
}
