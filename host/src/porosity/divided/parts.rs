//! The open parts of a cell, by points between which no surface passes.

use glam::DVec3;
use voidage_core::number::aabb::Aabb;

/// Points along an axis: six within the cell, and one just within each face.
const ALONG: usize = 8;

/// How far within, as a share of the cell.
const WITHIN: f64 = 1e-7;

/// The points stand in the middle of six equal parts, moved by this share of one along x, y, z: surfaces through the middle or along a diagonal then pass
/// beside them.
const MOVED: [f64; 3] = [0.0413, -0.0727, 0.1093];

/// Lines that pass a triangle's edge by less, in cells, cross it; hits that are nearer to each other are at one place.
const NEAR: f64 = 1e-9;

/// Points of the 36 that a part needs in a side to be open there: 5 % of it.
const LEAST_POINTS: u32 = 2;

/// Points of a cell as bits: eight layers along z, in each x fastest.
type Points = [u64; ALONG];

/// For x, y and z, the points from which the next along that axis cannot be reached.
type Blocked = [Points; 3];

/// The open parts of a cell that are open to a side.
#[derive(Debug, Clone)]
pub struct Parts {
    /// For each part, the points that it has in the low and the high side along x, y and z.
    sides: Vec<[[u64; 2]; 3]>,
}

/// Where a line through points along `axis` crosses surface.
#[derive(Clone, Copy)]
struct Hit {
    body: u32,
    axis: usize,
    /// The point before.
    point: [usize; 3],
    /// Along the axis, in cells.
    at: f64,
    /// Whether the line enters the solid there.
    enters: bool,
}

impl Parts {
    /// Of a cell with these triangles of bodies; none if nothing crosses a line between points.
    pub fn of_cell(cell: Aabb<DVec3>, triangles: impl Iterator<Item = (u32, [DVec3; 3])>) -> Option<Self> {
        let places = [0, 1, 2].map(places);
        let mut hits = Vec::new();
        for (body, triangle) in triangles {
            let corners = triangle.map(|p| (p - cell.min) / cell.size());
            (0..3).for_each(|axis| cross(&places, axis, (body, &corners), &mut hits));
        }
        if hits.is_empty() {
            return None;
        }
        hits.sort_unstable_by(|a, b| {
            let key = |hit: &Hit| (hit.body, hit.axis, hit.point);
            key(a).cmp(&key(b)).then(a.at.total_cmp(&b.at))
        });
        let mut open = [u64::MAX; ALONG];
        for of_body in hits.chunk_by(|a, b| a.body == b.body) {
            open = each(open, solid_points(of_body), |open, solid| open & !solid);
        }
        let (blocked, mut sides) = (blocked(&hits), Vec::new());
        while let Some(part) = take_region(&mut open, &blocked) {
            let part = sides_of(&part);
            if part.iter().flatten().any(|side| side.count_ones() >= LEAST_POINTS) {
                sides.push(part);
            }
        }
        Some(Parts { sides })
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.sides.len()
    }

    /// Is a part open to a side?
    pub fn touches(&self, part: usize, axis: usize, side: usize) -> bool {
        self.sides[part][axis][side].count_ones() >= LEAST_POINTS
    }

    /// Is a side open to this part alone?
    pub fn owns(&self, part: usize, axis: usize, side: usize) -> bool {
        self.touches(part, axis, side) && (0..self.count()).all(|p| p == part || !self.touches(p, axis, side))
    }

    /// The parts of this cell and of its neighbour beyond a side that meet there.
    pub fn meeting(&self, next: &Self, axis: usize, side: usize) -> Vec<(usize, usize)> {
        let pairs = (0..self.count()).flat_map(|a| (0..next.count()).map(move |b| (a, b)));
        let common = |&(a, b): &(usize, usize)| {
            (self.sides[a][axis][side] & next.sides[b][axis][1 - side]).count_ones() >= LEAST_POINTS
        };
        pairs.filter(common).collect()
    }
}

/// Where the points stand along an axis, in cells.
fn places(axis: usize) -> [f64; ALONG] {
    std::array::from_fn(|n| match n {
        0 => WITHIN,
        7 => 1.0 - WITHIN,
        _ => (n as f64 - 0.5 + MOVED[axis]) / 6.0,
    })
}

/// Where the lines along an axis cross a triangle.
fn cross(places: &[[f64; ALONG]; 3], axis: usize, (body, corners): (u32, &[DVec3; 3]), hits: &mut Vec<Hit>) {
    let [a, b, c] = corners;
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let doubled = (b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]);
    if !(doubled.abs() > 1e-14) {
        return;
    }
    let within = |w: usize| {
        let (lo, hi) = (a[w].min(b[w]).min(c[w]) - NEAR, a[w].max(b[w]).max(c[w]) + NEAR);
        places[w].partition_point(|&p| p < lo)..places[w].partition_point(|&p| p <= hi)
    };
    let (along_u, along_v) = (within(u), within(v));
    if along_u.is_empty() || along_v.is_empty() {
        return;
    }
    // Of each edge its beginning, its way, and how far beside it, times its length, a line still crosses.
    let edges = [(b, c), (c, a), (a, b)].map(|(from, to)| {
        let way = [to[u] - from[u], to[v] - from[v]];
        ([from[u], from[v]], way, NEAR * way[0].hypot(way[1]))
    });
    for (m, n) in along_u.flat_map(|m| along_v.clone().map(move |n| (m, n))) {
        let [p, q] = [places[u][m], places[v][n]];
        // The distance of the line times the edge's length.
        let beside = edges.map(|(from, way, _)| (way[0] * (q - from[1]) - way[1] * (p - from[0])) * doubled.signum());
        if beside.iter().zip(&edges).any(|(area, (.., slack))| *area < -slack) {
            continue;
        }
        let [of_a, of_b, of_c] = beside.map(|area| area / doubled.abs());
        let at = a[axis] * of_a + b[axis] * of_b + c[axis] * of_c;
        let before = places[axis].partition_point(|&place| place <= at);
        if before > 0 && before < ALONG {
            let mut point = [0; 3];
            (point[axis], point[u], point[v]) = (before - 1, m, n);
            hits.push(Hit { body, axis, point, at, enters: doubled < 0.0 });
        }
    }
}

fn set(points: &mut Points, [i, j, k]: [usize; 3]) {
    points[k] |= 1 << (ALONG * j + i);
}

fn each(mut a: Points, b: Points, join: impl Fn(u64, u64) -> u64) -> Points {
    a.iter_mut().zip(b).for_each(|(a, b)| *a = join(*a, b));
    a
}

fn blocked(hits: &[Hit]) -> Blocked {
    let mut blocked = Blocked::default();
    hits.iter().for_each(|hit| set(&mut blocked[hit.axis], hit.point));
    blocked
}

/// The points that lie in a body, whose hits stand in the order of lines and along them. Beside each hit it is seen from where the line enters or leaves:
/// what most of the points of a region say holds for all of it.
fn solid_points(hits: &[Hit]) -> Points {
    let [mut outside, mut inside] = [Points::default(); 2];
    for hits in hits.chunk_by(|a, b| (a.axis, a.point) == (b.axis, b.point)) {
        let (first, last) = (hits[0], hits[hits.len() - 1]);
        // A sheet has two surfaces at one place, and is seen from outside on both sides.
        let enters = hits.iter().any(|hit| hit.at - first.at <= NEAR && hit.enters);
        let leaves = hits.iter().any(|hit| last.at - hit.at <= NEAR && !hit.enters);
        let mut behind = first.point;
        behind[first.axis] += 1;
        set(if enters { &mut outside } else { &mut inside }, first.point);
        set(if leaves { &mut outside } else { &mut inside }, behind);
    }
    let (blocked, mut rest, mut solid) = (blocked(hits), [u64::MAX; ALONG], Points::default());
    let count = |points: Points| points.iter().map(|layer| layer.count_ones()).sum::<u32>();
    while let Some(region) = take_region(&mut rest, &blocked) {
        let [out, within] = [outside, inside].map(|seen| count(each(region, seen, |a, b| a & b)));
        if within > out {
            solid = each(solid, region, |a, b| a | b);
        }
    }
    solid
}

/// Takes from `points` the region of the first of them; none if there are none.
fn take_region(points: &mut Points, blocked: &Blocked) -> Option<Points> {
    /// Points with another one behind them along x.
    const BEFORE_LAST: u64 = 0x7f7f_7f7f_7f7f_7f7f;
    let layer = points.iter().position(|&layer| layer != 0)?;
    let mut region = Points::default();
    region[layer] = points[layer] & points[layer].wrapping_neg();
    loop {
        let before = region;
        for k in 0..ALONG {
            let free = [!blocked[0][k] & BEFORE_LAST, !blocked[1][k]];
            let mut layer = region[k];
            for (free, step) in free.into_iter().zip([1, ALONG]) {
                layer |= ((layer & free) << step) | ((layer >> step) & free);
            }
            if k > 0 {
                layer |= region[k - 1] & !blocked[2][k - 1];
            }
            region[k] = layer & points[k];
        }
        for k in (1..ALONG).rev() {
            region[k - 1] |= region[k] & !blocked[2][k - 1] & points[k - 1];
        }
        if region == before {
            break;
        }
    }
    *points = each(*points, region, |points, region| points & !region);
    Some(region)
}

/// The points of a part in the sides of the cell, without those on their edges.
fn sides_of(part: &Points) -> [[u64; 2]; 3] {
    let mut sides = [[0; 2]; 3];
    for (n, m) in (1..ALONG - 1).flat_map(|n| (1..ALONG - 1).map(move |m| (n, m))) {
        for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]) {
            let mut point = [0; 3];
            (point[axis], point[(axis + 1) % 3], point[(axis + 2) % 3]) = (side * (ALONG - 1), n, m);
            let bit = part[point[2]] >> (ALONG * point[1] + point[0]) & 1;
            sides[axis][side] |= bit << (ALONG * m + n);
        }
    }
    sides
}
