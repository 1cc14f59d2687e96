//! The union of balls in a cell, and of their discs in a face, by closed forms.
//!
//! The planes in which each two spheres meet divide the union: each ball has the points that are deeper in it than in any other, which is what it has of a
//! convex polyhedron (F. Aurenhammer, "Power diagrams", SIAM J. Comput. 16, 1987). That volume is a sum over the faces of the polyhedron, of the cones over them
//! with the apex in the ball's centre, and of each face over its sides, of triangles with a corner in the foot of the centre. In a face of the grid discs
//! and lines take the place of balls and planes.

use super::part::Part;
use crate::number::axis::Axis;
use crate::number::plane::{self, P2, on_way};
use crate::number::real::Real;
use crate::number::space::{P3, cross, dot, length, sub};
use core::f64::consts::PI;
use heapless::Vec;

/// Balls that share a cell; and most planes around what is left of one of them.
const MOST_BALLS: usize = 128;
const MOST_PLANES: usize = 48;

/// Each plane cuts off a corner of a face and adds two.
const MOST_CORNERS: usize = MOST_PLANES + 4;

/// A polygon in a plane, its corners counter-clockwise.
type Polygon = Vec<P2, MOST_CORNERS>;

/// What is computed is rounded by so many ε of its terms, and two planes at a small angle by so much more as that is smaller.
const ROUNDING: f64 = 2.0 * f64::EPSILON;

/// Planes whose angle has a smaller sine must not cross within reach.
const LEAST_ANGLE: f64 = 1e-8;

/// Planes that are one but for rounding: the sine of their angle, and how far they are apart in units of what lies between them.
const ONE_PLANE: f64 = 1e-13;

#[derive(Clone, Copy)]
struct Ball {
    center: P3,
    radius: f64,
}

/// A plane by its outward normal and its height over the centre of a ball.
#[derive(Clone, Copy)]
struct Plane {
    normal: P3,
    height: f64,
}

/// Bounds of the volume that the union of some balls has in a cell, or of its area in a face, flat along one axis. None if one of them is no ball, or they are so many or
/// lie so that rounding leaves nothing to rely on.
pub(super) fn union<'a>(parts: impl Iterator<Item = &'a Part>, cell: [P2; 3]) -> Option<P2> {
    let mut balls: Vec<Ball, MOST_BALLS> = Vec::new();
    for part in parts {
        let (center, radius) = part.ball()?;
        let ball = Ball { center, radius };
        if distance_to(&cell, ball.center) < ball.radius {
            balls.push(ball).ok()?;
        }
    }
    let flat = Axis::ALL.into_iter().find(|&n| cell[n][0] == cell[n][1]);
    let (mut sum, mut doubt) = (0.0, 0.0);
    for (number, ball) in balls.iter().enumerate() {
        let [share, off] = match flat {
            None => volume_of_one(&balls, (number, ball), &cell)?,
            Some(n) => area_of_one(&balls, (number, ball), &cell, n)?,
        };
        (sum, doubt) = (sum + share, doubt + off);
    }
    Some([sum - doubt, sum + doubt])
}

fn distance_to(cell: &[P2; 3], p: P3) -> f64 {
    length(Axis::ALL.map(|n| (cell[n][0] - p[n]).max(p[n] - cell[n][1]).max(0.0)))
}

/// What another ball of radius `other` leaves of one of radius `own`, at a distance.
enum Beside {
    /// All of it.
    All,
    /// Nothing: it is held, or is the same and comes later.
    Nothing,
    /// What lies below this height over its centre, towards the other.
    Below(f64),
}

fn beside(own: f64, other: f64, distance: f64, comes_later: bool) -> Beside {
    let more = own - other;
    if distance >= own + other {
        Beside::All
    } else if distance <= more.abs() {
        if more > 0.0 || (more == 0.0 && !comes_later) { Beside::All } else { Beside::Nothing }
    } else {
        Beside::Below(0.5 * (distance + more * ((own + other) / distance)))
    }
}

/// Volume of what is deeper in one of the balls than in any other, and by how much it may be off.
fn volume_of_one(balls: &[Ball], (number, ball): (usize, &Ball), cell: &[P2; 3]) -> Option<P2> {
    let reach = reach(cell, ball.center);
    let mut around = Around { planes: Vec::new(), reach, least_angle: 1.0, taken_as_one: 0.0 };
    for n in Axis::ALL {
        for (end, sign) in [(cell[n][0], -1.0), (cell[n][1], 1.0)] {
            let mut normal = [0.0; 3];
            normal[n] = sign;
            around.planes.push(Plane { normal, height: sign * (end - ball.center[n]) }).ok()?;
        }
    }
    let square = ball.radius * ball.radius;
    for (at, other) in balls.iter().enumerate().filter(|(at, _)| *at != number) {
        let way = sub(other.center, ball.center);
        let distance = length(way);
        let height = match beside(ball.radius, other.radius, distance, number > at) {
            Beside::All => continue,
            Beside::Nothing => return Some([0.0; 2]),
            Beside::Below(height) => height,
        };
        match around.add(Plane { normal: way.map(|x| x / distance), height }) {
            Added::Cut => {}
            Added::Closed => return Some([0.0, ONE_PLANE * reach * square * PI]),
            Added::Unsure => return None,
        }
    }
    let Around { planes, least_angle, taken_as_one, .. } = around;
    let mut sum = 0.0;
    for (at, plane) in planes.iter().enumerate() {
        let cones = Cones { height: plane.height.abs(), radius: ball.radius };
        let over = of_sides(&face(&planes, (at, plane), reach)?, |from, to| cones.over(from, to));
        sum += if plane.height < 0.0 { -over } else { over };
    }
    let rounding = ROUNDING / least_angle * (ball.radius + reach) * planes.len() as f64;
    Some([sum, square * (rounding + PI * taken_as_one)])
}

/// From a point to the farthest corner of a cell.
fn reach(cell: &[P2; 3], p: P3) -> f64 {
    length(Axis::ALL.map(|n| (cell[n][0] - p[n]).abs().max((cell[n][1] - p[n]).abs())))
}

/// The planes around what is left of a ball, all of which lies within `reach` of its centre.
struct Around {
    planes: Vec<Plane, MOST_PLANES>,
    reach: f64,
    /// Sine of the least angle at which two of them cross.
    least_angle: f64,
    /// How far planes lie apart that are taken for one.
    taken_as_one: f64,
}

enum Added {
    Cut,
    /// Nothing is left.
    Closed,
    /// It crosses another one at so small an angle that rounding decides where.
    Unsure,
}

impl Around {
    fn add(&mut self, new: Plane) -> Added {
        let near = ONE_PLANE * self.reach;
        for plane in &self.planes {
            let (sine, alike) = (length(cross(plane.normal, new.normal)), dot(plane.normal, new.normal) > 0.0);
            if sine >= LEAST_ANGLE {
                self.least_angle = self.least_angle.min(sine);
                continue;
            }
            // What lies between the two, and by how much that changes within reach.
            let between = if alike { (plane.height - new.height).abs() } else { plane.height + new.height };
            let change = 2.0 * sine * self.reach;
            if between > change + near {
                continue;
            }
            if !alike && between < -change {
                return Added::Closed;
            }
            if !(sine <= ONE_PLANE && between.abs() <= 4.0 * near) {
                return Added::Unsure;
            }
            self.taken_as_one += 4.0 * near;
            return if alike { Added::Cut } else { Added::Closed };
        }
        if self.planes.push(new).is_ok() { Added::Cut } else { Added::Unsure }
    }
}

/// What the other planes leave of one, from the foot of the centre on; none if it has too many corners.
fn face(planes: &[Plane], (number, plane): (usize, &Plane), reach: f64) -> Option<Polygon> {
    let [x, y, z] = plane.normal.map(f64::abs);
    let axis = if x <= y && x <= z {
        [1.0, 0.0, 0.0]
    } else if y <= z {
        [0.0, 1.0, 0.0]
    } else {
        [0.0, 0.0, 1.0]
    };
    let u = cross(axis, plane.normal);
    let size = length(u);
    let u = u.map(|x| x / size);
    let v = cross(plane.normal, u);
    let wide = 1.5 * reach;
    let mut polygon = Polygon::from_slice(&[[-wide, -wide], [wide, -wide], [wide, wide], [-wide, wide]]).ok()?;
    for (_, other) in planes.iter().enumerate().filter(|(at, _)| *at != number) {
        let normal = [dot(other.normal, u), dot(other.normal, v)];
        cut(&mut polygon, normal, other.height - plane.height * dot(other.normal, plane.normal))?;
    }
    Some(polygon)
}

/// Leaves of a polygon what lies below a height along a normal; none if that has too many corners.
fn cut(polygon: &mut Polygon, normal: P2, height: f64) -> Option<()> {
    let below = |p: &P2| height - plane::dot(normal, *p);
    if polygon.iter().all(|p| below(p) >= 0.0) {
        return Some(());
    }
    let mut kept = Polygon::new();
    let Some(mut before) = polygon.last().copied() else { return Some(()) };
    let mut there = below(&before);
    for &corner in polygon.iter() {
        let here = below(&corner);
        if (here >= 0.0) != (there >= 0.0) {
            kept.push(on_way(before, corner, there / (there - here))).ok()?;
        }
        if here >= 0.0 {
            kept.push(corner).ok()?;
        }
        (before, there) = (corner, here);
    }
    *polygon = kept;
    Some(())
}

/// The sum over the sides of a polygon.
fn of_sides(polygon: &Polygon, of_side: impl Fn(P2, P2) -> f64) -> f64 {
    let Some(mut from) = polygon.last().copied() else { return 0.0 };
    let mut sum = 0.0;
    for &to in polygon {
        sum += of_side(from, to);
        from = to;
    }
    sum
}

/// A side as the foot of a centre sees it: how far its line passes, with the sign of the turn, and where along it its ends lie. None of no length.
fn seen(from: P2, to: P2) -> Option<(f64, P2)> {
    let way = plane::sub(to, from);
    let long = Real::sqrt(plane::dot(way, way));
    let along = |p: P2| plane::dot(p, way) / long;
    (long > 0.0).then(|| (plane::cross(from, way) / long, [along(from), along(to)]))
}

/// The parts of a side beyond those that are nearer than `half` to the foot of the foot.
fn outside([from, to]: P2, half: f64) -> impl Iterator<Item = P2> {
    [[from, to.min(-half)], [from.max(half), to]].into_iter().filter(|[from, to]| from < to)
}

/// Length of the part of a side that is nearer.
fn inside([from, to]: P2, half: f64) -> f64 {
    let within = |x: f64| x.max(-half).min(half);
    within(to) - within(from)
}

/// What a ball has of the cones from its centre to faces in a plane at this height.
struct Cones {
    height: f64,
    radius: f64,
}

impl Cones {
    /// Over the triangle of the foot and a side. Within the disc it is a pyramid; beyond, all of the ball, by the solid angle.
    fn over(&self, from: P2, to: P2) -> f64 {
        let Some((aside, ends)) = seen(from, to) else { return 0.0 };
        let (h, r, m) = (self.height, self.radius, aside.abs());
        let half = Real::sqrt(((r - h) * (r + h) - m * m).max(0.0));
        let low = h.min(r);
        let of_turn = low * (3.0 * (r * r) - low * low) / 6.0;
        let mut sum = h * m * inside(ends, half) / 6.0;
        for [s, t] in outside(ends, half) {
            let turn = |t: f64| libm::atan2(t, m);
            // The angle whose sine is h/√(h² + m²) times that of the turn.
            let tilt = |t: f64| libm::atan2(h * t, m * Real::sqrt(h * h + m * m + t * t));
            sum += of_turn * (turn(t) - turn(s)) - r * r * r / 3.0 * (tilt(t) - tilt(s));
        }
        if aside < 0.0 { -sum } else { sum }
    }
}

/// Area of what is deeper in the disc of one of the balls than in that of any other, in a face across an axis, and by how much it may be off.
fn area_of_one(balls: &[Ball], (number, ball): (usize, &Ball), cell: &[P2; 3], n: Axis) -> Option<P2> {
    let [u, v] = n.others();
    let disc = |ball: &Ball| {
        let height = cell[n][0] - ball.center[n];
        Real::sqrt(((ball.radius - height) * (ball.radius + height)).max(0.0))
    };
    let (center, radius) = ([ball.center[u], ball.center[v]], disc(ball));
    let side = |a: Axis, end: usize, center: f64| cell[a][end] - center;
    let [x, y] = [[0, 1].map(|end| side(u, end, center[0])), [0, 1].map(|end| side(v, end, center[1]))];
    let mut polygon = Polygon::from_slice(&[[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]]).ok()?;
    let mut lines = 4;
    for (at, other) in balls.iter().enumerate().filter(|(at, _)| *at != number) {
        let way = plane::sub([other.center[u], other.center[v]], center);
        let distance = Real::sqrt(plane::dot(way, way));
        match beside(radius, disc(other), distance, number > at) {
            Beside::All => {}
            Beside::Nothing => return Some([0.0; 2]),
            Beside::Below(height) => {
                cut(&mut polygon, way.map(|x| x / distance), height)?;
                lines += 1;
            }
        }
    }
    let area = of_sides(&polygon, |from, to| {
        let Some((aside, ends)) = seen(from, to) else { return 0.0 };
        let m = aside.abs();
        let half = Real::sqrt((radius * radius - m * m).max(0.0));
        let turns = outside(ends, half).map(|[s, t]| libm::atan2(t, m) - libm::atan2(s, m)).sum::<f64>();
        let twice = m * inside(ends, half) + radius * radius * turns;
        if aside < 0.0 { -0.5 * twice } else { 0.5 * twice }
    });
    let reach = reach(cell, ball.center);
    Some([area, ROUNDING * ball.radius * (ball.radius + reach) * f64::from(lines)])
}
