//! Triangles with their planes: how they meet, and convex polygons cut by planes.

use glam::DVec3;

/// A triangle with its plane.
#[derive(Clone, Copy, Debug)]
pub struct Face {
    /// Its corners.
    pub corners: [DVec3; 3],
    /// Unit normal; zero if it has no area.
    pub normal: DVec3,
    /// Unit vectors in its plane, inward from the sides, which go from each corner to the next.
    inward: [DVec3; 3],
}

/// The lowest and highest coordinates of a triangle.
#[must_use]
pub fn bounds([a, b, c]: &[DVec3; 3]) -> [DVec3; 2] {
    [a.min(*b).min(*c), a.max(*b).max(*c)]
}

/// A triangle as another one sees it.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// Which of its corners are corners of the other, too.
    shared: [bool; 3],
    /// Signed distances of its corners from the plane of the other; 0 where they share it.
    pub heights: [f64; 3],
}

impl Face {
    /// Of three corners.
    #[must_use]
    pub fn new(corners: [DVec3; 3]) -> Self {
        let [a, b, c] = corners;
        // The longest two sides give the most digits.
        let normals = [(b - a).cross(c - a), (c - b).cross(a - b), (a - c).cross(b - c)];
        let (mut largest, mut most) = (DVec3::ZERO, 0.0);
        for (normal, size) in normals.map(|n| (n, n.length_squared())) {
            if size > most {
                (largest, most) = (normal, size);
            }
        }
        let normal = largest.normalize_or_zero();
        let inward = [b - a, c - b, a - c].map(|side| normal.cross(side).normalize_or_zero());
        Face { corners, normal, inward }
    }

    /// How it sees another one.
    #[must_use]
    pub fn sees(&self, other: &Face) -> Seen {
        let mut seen = Seen { shared: [false; 3], heights: [0.0; 3] };
        for (i, &p) in other.corners.iter().enumerate() {
            seen.shared[i] = self.has(p);
            seen.heights[i] = if seen.shared[i] { 0.0 } else { self.height(p) };
        }
        seen
    }

    /// Is a point one of its corners?
    #[must_use]
    pub fn has(&self, p: DVec3) -> bool {
        self.corners[0] == p || self.corners[1] == p || self.corners[2] == p
    }

    /// Has it an area, as far as that was not rounded away?
    #[must_use]
    pub fn has_area(&self) -> bool {
        self.normal != DVec3::ZERO
    }

    /// Has it three corners, all on its plane as that was rounded? Then a corner that another shares is on its plane, too.
    #[must_use]
    pub fn holds_itself(&self, on: f64) -> bool {
        let [a, b, c] = self.corners;
        a != b && b != c && c != a && self.height(b).abs() <= on && self.height(c).abs() <= on
    }

    /// The number of sides that it shares with another one.
    #[must_use]
    pub fn shared_sides(&self, other: &Face) -> usize {
        let [a, b, c] = other.corners.map(|p| usize::from(self.has(p)));
        a * b + b * c + c * a
    }

    /// Signed distance of a point from the plane.
    #[must_use]
    pub fn height(&self, p: DVec3) -> f64 {
        self.normal.dot(p - self.corners[0])
    }

    /// Does another one, which it sees so, lie beyond one of its sides, clearly but for corners that both share? Then neither has a part of the other within its
    /// sides, if they share no corner; if they do, the other has none within the sides of this one, nor a side along them.
    fn is_passed_by(&self, other: &Face, seen: &Seen, on: f64) -> bool {
        let depth = |side: usize, i: usize| self.inward[side].dot(other.corners[i] - self.corners[side]);
        let is_clear = |side| (0..3).all(|i| seen.shared[i] || depth(side, i) < -CLEAR * on);
        // At a corner that both share, the angle counts: a side that leaves it at a small one lies on the other for some length.
        let is_steep = |side: usize, i: usize, j: usize| {
            let length = other.corners[i].distance_squared(other.corners[j]);
            seen.shared[i] || length <= (depth(side, i) / STEEP).powi(2)
        };
        let may_touch = |side, j| depth(side, j).abs() <= on && (0..3).all(|i| is_steep(side, i, j));
        let is_beyond = |side| is_clear(side) && (0..3).all(|j| !seen.shared[j] || may_touch(side, j));
        self.normal != DVec3::ZERO && (0..3).any(is_beyond)
    }

    /// Distance of a point inward from the line of a side, in the plane.
    #[must_use]
    pub fn depth(&self, side: usize, p: DVec3) -> f64 {
        self.inward[side].dot(p - self.corners[side])
    }

    /// Distances of a point inward from the lines of the sides, in the plane.
    #[must_use]
    pub fn inward(&self, p: DVec3) -> [f64; 3] {
        [0, 1, 2].map(|i| self.inward[i].dot(p - self.corners[i]))
    }
}

impl Seen {
    /// No corner of it is a corner of the other.
    fn shares_none(&self) -> bool {
        self.shared == [false; 3]
    }

    /// Number of its sides that are sides of the other.
    #[must_use]
    pub fn shared_sides(&self) -> usize {
        let [a, b, c] = self.shared.map(usize::from);
        a * b + b * c + c * a
    }

    /// Does it lie off the plane, all on one side, but for corners that both share? Most neighbours do.
    fn is_beside(&self, on: f64) -> bool {
        let [mut above, mut below] = [false; 2];
        for (height, shared) in self.heights.iter().zip(self.shared) {
            above |= *height > on;
            below |= *height < -on;
            if !shared && height.abs() <= on {
                return false;
            }
        }
        above != below
    }
}

/// Beyond a side by so many tolerances a triangle is clear of another one.
pub const CLEAR: f64 = 1e6;

/// Sine of the angle from which on sides that begin in one corner share no more than [`TOUCH`] tolerances.
const STEEP: f64 = 1.0 / TOUCH;

/// How `b` sees `a`, which sees it so, if they are near enough to meet.
#[must_use]
pub fn near(a: &Face, b: &Face, seen: &Seen, on: f64) -> Option<Seen> {
    if seen.is_beside(on) {
        return None;
    }
    let passed = a.is_passed_by(b, seen, on);
    if passed && seen.shares_none() {
        return None;
    }
    let back = b.sees(a);
    let apart = back.is_beside(on) || ((passed || back.shares_none()) && b.is_passed_by(a, &back, on));
    (!apart).then_some(back)
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

/// How `other`, whose corners have these heights over the plane of `face`, meets the inner part of it. `covers`: do they share more than their sides, if they
/// lie in one plane?
#[must_use]
pub fn meeting(face: &Face, other: &Face, heights: &[f64; 3], on: f64, covers: impl FnOnce() -> bool) -> Crossing {
    let (above, below) = (heights.iter().any(|&h| h > on), heights.iter().any(|&h| h < -on));
    if !above && !below {
        return if covers() { Crossing::Cover } else { Crossing::None };
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
    let share = share_within(&face.inward(ends[0]), &face.inward(ends[1]), on).unwrap_or(0.0);
    if share * ends[0].distance(ends[1]) > on { Crossing::Cut(ends) } else { Crossing::None }
}

/// A side that lies on another triangle for no more than so many tolerances touches it in a point.
const TOUCH: f64 = 16.0;

/// The sides of `other`, from each of its corners to the next, that lie on `face` for some length, more than `least` as a share of the side, and are not sides
/// of it; `face` sees it so. `inward`: the distances of its corners [inward](Face::inward) from the sides of `face`.
#[must_use]
pub fn sides_on(
    face: &Face,
    other: &Face,
    seen: &Seen,
    [on, least]: [f64; 2],
    inward: impl FnOnce() -> [[f64; 3]; 3],
) -> [bool; 3] {
    let in_plane = |i: usize| seen.heights[i].abs() <= on;
    let may = |i: usize, j: usize| in_plane(i) && in_plane(j) && !(seen.shared[i] && seen.shared[j]);
    let may = [may(0, 1), may(1, 2), may(2, 0)];
    if may == [false; 3] || face.normal == DVec3::ZERO || other.normal == DVec3::ZERO {
        return [false; 3];
    }
    let inward = inward();
    let mut found = [false; 3];
    for i in (0..3).filter(|&i| may[i]) {
        let j = (i + 1) % 3;
        let share = share_within(&inward[i], &inward[j], -on);
        let is_long = |share: f64| share > least && share * other.corners[i].distance(other.corners[j]) > TOUCH * on;
        found[i] = share.is_some_and(is_long);
    }
    found
}

/// The share of a segment that lies within a triangle, farther than `by` from its sides; none if it lies beyond one of them. For its ends, the distances inward
/// from the sides.
fn share_within(from: &[f64; 3], to: &[f64; 3], by: f64) -> Option<f64> {
    let (mut lo, mut hi) = (0.0_f64, 1.0_f64);
    for (from, to) in from.iter().zip(to) {
        let (a, b) = (from - by, to - by);
        if a <= 0.0 && b <= 0.0 {
            return None;
        }
        if a <= 0.0 {
            lo = lo.max(a / (a - b));
        } else if b <= 0.0 {
            hi = hi.min(a / (a - b));
        }
    }
    Some(hi - lo)
}

/// Does a triangle in one plane with another lie beyond one of its sides? `inward`: distances of its corners inward from these sides.
#[must_use]
pub fn is_apart(inward: &[[f64; 3]; 3], on: f64) -> bool {
    (0..3).any(|side| inward.iter().all(|d| d[side] <= on))
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
