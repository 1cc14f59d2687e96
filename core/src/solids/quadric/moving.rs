//! The area of a polygon while a plane rises, as long as the same lines bound it.
//!
//! Its lines keep their directions. So its corners, the lengths of its sides, and how far other lines are from its corners, are sums of multiples of the
//! height and of half the widths of both strips; the area is a quadratic function of these three. What is such a sum is positive
//! between the known height and another if it is so at both with chords between them in place of half widths that it grows with, and tangents in place of others:
//! half widths are concave.

use super::polygon::{Corner, Corners, Line, MOST_CORNERS, Strips};
use crate::number::plane::{P2, cross};
use heapless::Vec;

/// Sides that meet at a smaller sine tell no corner well.
const LEAST_SINE: f64 = 1.0 / 16.0;

/// A sum: its value at a known height, and the multiples of what the height and both half widths exceed their values there by.
type Sum = [f64; 4];

/// Both coordinates of a corner.
type MovingCorner = [Sum; 2];

/// A polygon that moves.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moving {
    /// Heights between which it has the same sides.
    pub between: P2,
    /// The height at which it was known, and half the widths of both strips there.
    height: f64,
    half: P2,
    /// The smallest sine between two sides that meet.
    pub sine: f64,
    /// The area as a quadratic form of 1 and what those three exceed their values by; what is below the diagonal is added to what is above.
    area: [Sum; 4],
    /// Sums of how fast all its sides move outward: of those that do so with the height alone, and for each strip as often as it grows.
    speed: [f64; 3],
}

/// The area at a height, by how much that grows, and how fast its sides move in all.
pub(super) struct Area {
    pub value: f64,
    pub rise: f64,
    pub speed: f64,
}

/// The length of a side of a rectangle: a constant, and a multiple of half the width of a strip.
pub(super) struct Side {
    pub constant: f64,
    pub multiple: f64,
}

fn difference(a: &Sum, b: &Sum) -> Sum {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]]
}

/// A sum of both coordinates' multiples.
fn weighed(weights: P2, corner: &MovingCorner) -> Sum {
    let [x, y] = corner;
    let one = |n: usize| weights[0] * x[n] + weights[1] * y[n];
    [one(0), one(1), one(2), one(3)]
}

/// Where a line is: its offset as a sum.
fn offset(line: &Line, height: f64, half: P2) -> Sum {
    let strip = |n: usize| f64::from(u8::from(line.strip == Some(n)));
    let moved = strip(0) * half[0] + strip(1) * half[1];
    [line.offset + line.rise * height + moved, line.rise, strip(0), strip(1)]
}

/// Where two lines meet, and the sine between them; none if that is small.
fn meet([p, q]: [&Line; 2], [o, r]: [Sum; 2]) -> Option<(MovingCorner, f64)> {
    let turned = cross(p.normal, q.normal);
    let sine = turned / (p.size * q.size);
    if !(sine > LEAST_SINE) {
        return None;
    }
    let scale = 1.0 / turned;
    let of = |a: f64, b: f64| {
        let (a, b) = (a * scale, b * scale);
        [a * o[0] + b * r[0], a * o[1] + b * r[1], a * o[2] + b * r[2], a * o[3] + b * r[3]]
    };
    Some(([of(-q.normal[1], p.normal[1]), of(q.normal[0], -p.normal[0])], sine))
}

/// A plane at which a polygon is known: its height, and what the strips have there.
pub(super) struct Known<'a> {
    pub lines: &'a [Line],
    /// The lines, as bits of their numbers, inside of which all is at any height.
    pub idle: u32,
    pub corners: &'a Corners,
    pub height: f64,
    pub strips: &'a Strips,
}

impl Known<'_> {
    /// The line of the side after a corner.
    fn line(&self, corner: &Corner) -> Option<&Line> {
        self.lines.get(usize::from(corner.line))
    }

    /// The corner that is nearest to a line outside, at any height: that between the sides between whose normals the line's own points.
    fn nearest_corner(&self, line: &Line) -> Option<usize> {
        let mut before = self.line(self.corners.last()?)?;
        for (n, corner) in self.corners.iter().enumerate() {
            let after = self.line(corner)?;
            if cross(before.normal, line.normal) >= 0.0 && cross(line.normal, after.normal) >= 0.0 {
                return Some(n);
            }
            before = after;
        }
        None
    }
}

/// Two heights, half the widths of both strips there, and the lengths that count as nothing.
pub(super) struct Range {
    pub between: P2,
    pub half: [P2; 2],
    pub noise: f64,
}

/// Narrows the heights about a known plane to where sums are certain to be positive.
struct Proof {
    /// The heights, less that of the plane; and what is left of them.
    ends: P2,
    left: P2,
    /// At both ends, what the height and both half widths exceed their values at the plane by: by chords, and by tangents.
    by_chords: [[f64; 3]; 2],
    by_tangents: [[f64; 3]; 2],
    noise: f64,
}

impl Proof {
    fn new(known: &Known, range: &Range) -> Self {
        let [half, growth] = [known.strips.half, known.strips.growth];
        let ends = range.between.map(|end| end - known.height);
        let chord = |step: f64, there: P2| [step, there[0] - half[0], there[1] - half[1]];
        let by_chords = [chord(ends[0], range.half[0]), chord(ends[1], range.half[1])];
        let by_tangents = ends.map(|step| [step, growth[0] * step, growth[1] * step]);
        Proof { ends, left: ends, by_chords, by_tangents, noise: range.noise }
    }

    /// Takes away where a sum is not certain to be positive; false if nothing is left.
    fn narrow(&mut self, sum: &Sum) -> bool {
        let least = |chords: &[f64; 3], tangents: &[f64; 3]| {
            let [value, multiples @ ..] = sum;
            let exceeds = multiples.iter().zip(chords.iter().zip(tangents));
            exceeds
                .fold(value + self.noise, |sum, (m, (chord, tangent))| sum + m * if *m > 0.0 { chord } else { tangent })
        };
        let [low, high] =
            [least(&self.by_chords[0], &self.by_tangents[0]), least(&self.by_chords[1], &self.by_tangents[1])];
        if low >= 0.0 && high >= 0.0 {
            return true;
        }
        // From the plane's own value a line to each end.
        let ([from, to], middle) = (self.ends, sum[0] + self.noise);
        if low < 0.0 {
            self.left[0] = self.left[0].max(from * (middle / (middle - low)));
        }
        if high < 0.0 {
            self.left[1] = self.left[1].min(to * (middle / (middle - high)));
        }
        middle > 0.0
    }
}

impl Moving {
    /// A rectangle between two heights, its sides by both strips.
    pub fn rectangle(between: P2, [a, b]: &[Side; 2]) -> Self {
        let mut area = [[0.0; 4]; 4];
        area[0] = [a.constant * b.constant, 0.0, a.multiple * b.constant, a.constant * b.multiple];
        area[2][3] = a.multiple * b.multiple;
        Moving { between, height: 0.0, half: [0.0; 2], sine: 1.0, area, speed: [0.0; 3] }
    }

    /// The polygon at a plane within a range, as far as it is certain to have the same sides; none if sides meet at a small sine, or nothing is
    /// certain.
    pub fn new(known: &Known, range: &Range) -> Option<Self> {
        let half = known.strips.half;
        let place = |line: &Line| offset(line, known.height, half);
        let mut corners: Vec<MovingCorner, MOST_CORNERS> = Vec::new();
        let mut before = known.line(known.corners.last()?)?;
        let mut place_before = place(before);
        let (mut used, mut least) = (known.idle, 1.0);
        for corner in known.corners {
            let after = known.line(corner)?;
            let own = place(after);
            used |= 1 << u32::from(corner.line);
            let (met, sine) = meet([before, after], [place_before, own])?;
            corners.push(met).ok()?;
            least = if sine < least { sine } else { least };
            (before, place_before) = (after, own);
        }
        let mut proof = Proof::new(known, range);
        let mut moving = Moving {
            between: range.between,
            height: known.height,
            half,
            sine: least,
            area: [[0.0; 4]; 4],
            speed: [0.0; 3],
        };
        let followers = corners.iter().skip(1).chain(corners.first());
        for ((corner, to), side) in corners.iter().zip(followers).zip(known.corners) {
            let line = known.line(side)?;
            let (one, way) = (1.0 / line.size, [line.normal[1], -line.normal[0]]);
            let lengths = [difference(&to[0], &corner[0]), difference(&to[1], &corner[1])];
            if !proof.narrow(&weighed(way.map(|x| x * one), &lengths)) {
                return None;
            }
            let [_, fixed, grown @ ..] = offset(line, 0.0, [0.0; 2]);
            let speeds = [fixed.abs(), grown[0], grown[1]];
            moving.speed.iter_mut().zip(speeds).for_each(|(sum, speed)| *sum += speed * one);
        }
        for (number, line) in known.lines.iter().enumerate() {
            if used & (1 << number as u32) == 0 {
                let nearest = weighed(line.normal, corners.get(known.nearest_corner(line)?)?);
                let own = place(line);
                let room = [0, 1, 2, 3].map(|n| (nearest[n] + own[n]) / line.size);
                if !proof.narrow(&room) {
                    return None;
                }
            }
        }
        moving.between = proof.left.map(|end| known.height + end);
        for (at, end) in moving.between.iter_mut().enumerate() {
            // What nothing was taken away from is the range's own.
            if proof.left[at & 1] == proof.ends[at & 1] {
                *end = range.between[at & 1];
            }
        }
        moving.add_area(&corners);
        Some(moving)
    }

    /// By triangles about the first corner.
    fn add_area(&mut self, corners: &[MovingCorner]) {
        let Some((base, others)) = corners.split_first() else { return };
        let from_base = |c: &MovingCorner| [difference(&c[0], &base[0]), difference(&c[1], &base[1])];
        let mut before: Option<MovingCorner> = None;
        for corner in others {
            let [x, y] = from_base(corner);
            if let Some([p, q]) = before {
                for (m, row) in self.area.iter_mut().enumerate() {
                    for (n, sum) in row.iter_mut().enumerate().skip(m) {
                        let twice = if m == n {
                            p[m & 3] * y[m & 3] - x[m & 3] * q[m & 3]
                        } else {
                            (p[m & 3] * y[n & 3] - x[m & 3] * q[n & 3]) + (p[n & 3] * y[m & 3] - x[n & 3] * q[m & 3])
                        };
                        *sum += 0.5 * twice;
                    }
                }
            }
            before = Some([x, y]);
        }
    }

    /// Its area at a height in between, from half the widths of the strips there.
    #[inline(always)]
    pub fn area_of(&self, height: f64, half: P2) -> f64 {
        let at = [1.0, height - self.height, half[0] - self.half[0], half[1] - self.half[1]];
        let sum = |m: usize| (m..4).fold(0.0, |sum, n| sum + self.area[m & 3][n & 3] * at[n & 3]);
        (sum(0) + at[1] * sum(1)) + (at[2] * sum(2) + at[3] * sum(3))
    }

    /// No less than its area, as a function of complex heights, where these are within `reach` of a height and half the widths of the strips
    /// within given values.
    pub fn most_area(&self, height: f64, reach: f64, half: P2) -> f64 {
        let at = [1.0, (height - self.height).abs() + reach, half[0] + self.half[0], half[1] + self.half[1]];
        let sum = |m: usize| (m..4).fold(0.0, |sum, n| sum + self.area[m & 3][n & 3].abs() * at[n & 3]);
        (sum(0) + at[1] * sum(1)) + (at[2] * sum(2) + at[3] * sum(3))
    }

    /// Its area at a height in between.
    pub fn area(&self, height: f64, strips: &Strips) -> Area {
        let at = [1.0, height - self.height, strips.half[0] - self.half[0], strips.half[1] - self.half[1]];
        let growth = [0.0, 1.0, strips.growth[0], strips.growth[1]];
        let (mut value, mut rise) = (0.0, 0.0);
        for (m, row) in self.area.iter().enumerate() {
            let (mut sum, mut grown) = (0.0, 0.0);
            for (n, x) in row.iter().enumerate().skip(m) {
                sum += x * at[n & 3];
                grown += x * growth[n & 3];
            }
            value += at[m & 3] * sum;
            rise += growth[m & 3] * sum + at[m & 3] * grown;
        }
        let speed = self.speed[0] + self.speed[1] * growth[2].abs() + self.speed[2] * growth[3].abs();
        Area { value, rise, speed }
    }
}
