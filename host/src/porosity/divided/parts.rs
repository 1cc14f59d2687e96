//! The open parts of a cell, by points between which no surface passes.

use super::near::OfBody;
use glam::DVec3;
use std::ops::Range;
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

/// How many there are.
const POINTS: usize = ALONG * ALONG * ALONG;

/// How far a step along x, y and z leads in the numbers of points.
const STEP: [usize; 3] = [1, ALONG, ALONG * ALONG];

/// The points of a layer that lie on none of its edges, and those that lie on one edge only.
const WITHIN_EDGES: u64 = 0x007e_7e7e_7e7e_7e00;
const ON_ONE_EDGE: u64 = 0x7e81_8181_8181_817e;

/// The points in the sides of the cell, without those on their edges.
const IN_SIDES: Points =
    [WITHIN_EDGES, ON_ONE_EDGE, ON_ONE_EDGE, ON_ONE_EDGE, ON_ONE_EDGE, ON_ONE_EDGE, ON_ONE_EDGE, WITHIN_EDGES];

/// For x, y and z, the points from which the next along that axis cannot be reached.
type Blocked = [Points; 3];

/// The open parts of a cell that are open to a side.
#[derive(Debug, Clone)]
pub struct Parts {
    parts: Vec<OpenPart>,
    /// Of the lines along x, y and z.
    pub lines: [PointLines; 3],
}

/// A part of a cell.
#[derive(Debug, Clone, Copy)]
pub struct OpenPart {
    /// The points that it has in the low and the high side along x, y and z, those on the edges of the side, too.
    sides: [[u64; 2]; 3],
    /// How many of the 216 points that lie in no side it has.
    pub inner: u32,
    /// How many more of them lie in the high half than in the low one, along x, y and z.
    pub balance: [i32; 3],
}

/// The lines of points along an axis.
#[derive(Debug, Clone, Copy)]
pub struct PointLines {
    /// Which share of those within the section meets solid.
    pub blocked: f64,
    /// Do all meet solid, those at the rim of the section, too?
    pub all_blocked: bool,
}

/// Where a line between two neighbouring points crosses surface.
#[derive(Clone, Copy)]
struct Hit {
    body: u32,
    /// The number of the point before, more by [`POINTS`] along y and by twice that along z.
    line: u16,
    /// Whether the line enters the solid there.
    enters: bool,
    /// Along the axis, in cells.
    at: f64,
}

/// Memory for one cell at a time.
#[derive(Default)]
pub struct Hits {
    hits: Vec<Hit>,
    /// Where the line from each point along x, y, z crosses a body first and last.
    ends: Vec<[f64; 2]>,
}

impl Parts {
    /// Of a cell that these triangles may reach, those of a body one after the other; none if no surface is between the points.
    pub fn of_cell(cell: Aabb<DVec3>, triangles: impl Iterator<Item = OfBody>, memory: &mut Hits) -> Option<Self> {
        let (places, size) = ([0, 1, 2].map(places), cell.size());
        let Hits { hits, ends } = memory;
        ends.resize(3 * POINTS, [0.0; 2]);
        hits.clear();
        for (body, triangle) in triangles {
            cross(&places, &triangle.map(|p| (p - cell.min) / size), body, hits);
        }
        if hits.is_empty() {
            return None;
        }
        let (mut blocked, mut open) = (Blocked::default(), [u64::MAX; ALONG]);
        for of_body in hits.chunk_by(|a, b| a.body == b.body) {
            let (of_body, solid) = solid_points(of_body, ends);
            for (all, own) in blocked.iter_mut().zip(of_body) {
                *all = each(*all, own, |all, own| all | own);
            }
            open = each(open, solid, |open, solid| open & !solid);
        }
        let all_open = open;
        let mut parts = Vec::new();
        while let Some(points) = take_region(&mut open, &IN_SIDES, &blocked) {
            let part = OpenPart::of_points(&points);
            if part.sides.iter().flatten().any(|side| is_opening(*side)) {
                parts.push(part);
            }
        }
        Some(Parts { parts, lines: lines(&blocked, &all_open) })
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.parts.len()
    }

    /// All of them.
    pub fn all(&self) -> &[OpenPart] {
        &self.parts
    }

    /// Is a part open to a side?
    pub fn touches(&self, part: usize, axis: usize, side: usize) -> bool {
        is_opening(self.parts[part].sides[axis][side])
    }

    /// Is a side open to this part alone?
    pub fn owns(&self, part: usize, axis: usize, side: usize) -> bool {
        self.touches(part, axis, side) && (0..self.count()).all(|p| p == part || !self.touches(p, axis, side))
    }

    /// Does a part meet one of the neighbour beyond a side there?
    pub fn meet(&self, part: usize, (next, other): (&Self, usize), axis: usize, side: usize) -> bool {
        is_opening(self.parts[part].sides[axis][side] & next.parts[other].sides[axis][1 - side])
    }

    /// The points that some of the parts have in a side, those on its edges, too.
    pub fn in_side(&self, axis: usize, side: usize, is_wanted: impl Fn(usize) -> bool) -> u64 {
        let wanted = self.parts.iter().enumerate().filter(|(part, _)| is_wanted(*part));
        wanted.fold(0, |all, (_, part)| all | part.sides[axis][side])
    }
}

impl OpenPart {
    fn of_points(points: &Points) -> Self {
        /// The points of a layer in the low half along x and y.
        const LOW: [u64; 2] = [0x0f0f_0f0f_0f0f_0f0f, 0xffff_ffff];
        let (mut inner, mut low) = (0, [0; 3]);
        for (k, layer) in points.iter().enumerate().filter(|(k, _)| (1..ALONG - 1).contains(k)) {
            let layer = layer & WITHIN_EDGES;
            inner += layer.count_ones();
            low[0] += (layer & LOW[0]).count_ones();
            low[1] += (layer & LOW[1]).count_ones();
            low[2] += if k < ALONG / 2 { layer.count_ones() } else { 0 };
        }
        let balance = low.map(|low| inner as i32 - 2 * low as i32);
        OpenPart { sides: sides_of(points), inner, balance }
    }
}

/// Are so many of these points in a side within its edges that it is open there?
pub fn is_opening(points: u64) -> bool {
    (points & WITHIN_EDGES).count_ones() >= LEAST_POINTS
}

/// Where the points stand along an axis, in cells.
fn places(axis: usize) -> [f64; ALONG] {
    std::array::from_fn(|n| match n {
        0 => WITHIN,
        7 => 1.0 - WITHIN,
        _ => (n as f64 - 0.5 + MOVED[axis]) / 6.0,
    })
}

/// Which places lie from `lo` to `hi`.
#[inline(always)]
fn within(places: &[f64; ALONG], lo: f64, hi: f64) -> Range<usize> {
    let first = up_to(places, lo);
    first - usize::from(first > 0 && places[first - 1] == lo)..up_to(places, hi)
}

/// How many places lie below a value or at it.
#[inline(always)]
fn up_to(places: &[f64; ALONG], value: f64) -> usize {
    // Beside the place that would be the last if the inner ones were not moved.
    let near = ((value * 6.0 + 0.5) as u32 as usize).min(ALONG - 2);
    match near + usize::from(places[near] <= value) {
        0 => 0,
        n if n > near => n + usize::from(places[n] <= value),
        n => n - usize::from(places[n - 1] > value),
    }
}

/// Where the lines between points cross a triangle.
fn cross(places: &[[f64; ALONG]; 3], triangle: &[DVec3; 3], body: u32, hits: &mut Vec<Hit>) {
    let [a, b, c] = triangle;
    let (lo, hi) = (a.min(*b).min(*c) - NEAR, a.max(*b).max(*c) + NEAR);
    let x = within(&places[0], lo.x, hi.x);
    let y = within(&places[1], lo.y, hi.y);
    let z = within(&places[2], lo.z, hi.z);
    let triangle = triangle.map(|p| p.to_array());
    cross_along::<0>(places, &triangle, [y.clone(), z.clone()], body, hits);
    cross_along::<1>(places, &triangle, [z, x.clone()], body, hits);
    cross_along::<2>(places, &triangle, [x, y], body, hits);
}

/// Triangles that are seen smaller along an axis, as twice their area in sides of the cell, are not crossed along it.
const LEAST_DOUBLED: f64 = 1e-14;

/// Those of the lines along `AXIS`; only lines in these ranges can meet the triangle.
#[inline(always)]
fn cross_along<const AXIS: usize>(
    places: &[[f64; ALONG]; 3],
    triangle: &[[f64; 3]; 3],
    [along_u, along_v]: [Range<usize>; 2],
    body: u32,
    hits: &mut Vec<Hit>,
) {
    if along_u.is_empty() || along_v.is_empty() {
        return;
    }
    let (u, v) = ((AXIS + 1) % 3, (AXIS + 2) % 3);
    let projected = ProjectedTriangle::new::<AXIS>(triangle);
    if !(projected.doubled.abs() > LEAST_DOUBLED) {
        return;
    }
    for m in along_u {
        let row = projected.row(places[u][m]);
        for n in projected.reached(row, &places[v], along_v.clone()) {
            let Some(at) = projected.at(row, places[v][n]) else { continue };
            let before = up_to(&places[AXIS], at);
            if before > 0 && before < ALONG {
                let line = (AXIS * POINTS + (before - 1) * STEP[AXIS] + m * STEP[u] + n * STEP[v]) as u16;
                hits.push(Hit { body, line, enters: projected.doubled < 0.0, at });
            }
        }
    }
}

/// A triangle as it is seen along an axis.
struct ProjectedTriangle {
    /// Its corners along the axis.
    height: [f64; 3],
    /// Twice its area, negative if it is seen clockwise.
    doubled: f64,
    /// The edge opposite each corner.
    edges: [ProjectedEdge; 3],
}

/// An edge of a triangle that is seen along an axis, from its beginning, and its way, turned back if the triangle is seen clockwise.
struct ProjectedEdge {
    from: [f64; 2],
    way: [f64; 2],
}

impl ProjectedTriangle {
    #[inline(always)]
    fn new<const AXIS: usize>([a, b, c]: &[[f64; 3]; 3]) -> Self {
        let (u, v) = ((AXIS + 1) % 3, (AXIS + 2) % 3);
        let doubled = (b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]);
        let turn = doubled.signum();
        let edge = |from: &[f64; 3], to: &[f64; 3]| ProjectedEdge {
            from: [from[u], from[v]],
            way: [(to[u] - from[u]) * turn, (to[v] - from[v]) * turn],
        };
        ProjectedTriangle { height: [a[AXIS], b[AXIS], c[AXIS]], doubled, edges: [edge(b, c), edge(c, a), edge(a, b)] }
    }

    /// Of the area between each edge and the lines at `p` in the first direction, the part that is the same for all these lines.
    #[inline(always)]
    fn row(&self, p: f64) -> [f64; 3] {
        self.edges.each_ref().map(|edge| edge.way[1] * (p - edge.from[0]))
    }

    /// Those lines of a row that may cross the triangle: the others surely pass beside it.
    #[inline(always)]
    fn reached(&self, row: [f64; 3], places: &[f64; ALONG], lines: Range<usize>) -> Range<usize> {
        let Range { start: mut first, mut end } = lines;
        if end - first < 2 {
            return first..end;
        }
        for (ProjectedEdge { from, way }, part) in self.edges.iter().zip(row) {
            // An edge is no longer than the sum of its ways. From line to line the area beside it grows all the way or falls all the way, rounding included.
            let far = -2.0 * NEAR * (way[0].abs() + way[1].abs());
            let is_beside = |n: usize| way[0] * (places[n] - from[1]) - part < far;
            if way[0] >= 0.0 {
                while first < end && is_beside(first) {
                    first += 1;
                }
            } else {
                while first < end && is_beside(end - 1) {
                    end -= 1;
                }
            }
        }
        first..end
    }

    /// Where along the axis a line of a row crosses the triangle, if it does.
    #[inline(always)]
    fn at(&self, row: [f64; 3], q: f64) -> Option<f64> {
        let mut shares = [0.0; 3];
        for ((share, ProjectedEdge { from, way }), part) in shares.iter_mut().zip(&self.edges).zip(row) {
            // The distance of the line times the edge's length.
            let area = way[0] * (q - from[1]) - part;
            if area < 0.0 && area < -NEAR * way[0].hypot(way[1]) {
                return None;
            }
            *share = area / self.doubled.abs();
        }
        let [a, b, c] = self.height;
        Some(a * shares[0] + b * shares[1] + c * shares[2])
    }
}

/// Adds a line to those from some points along x, y and z; was it there?
fn add(lines: &mut Blocked, line: usize) -> bool {
    let (layer, bit) = (&mut lines.as_flattened_mut()[line / STEP[2]], 1 << (line % STEP[2]));
    let was_there = *layer & bit != 0;
    *layer |= bit;
    was_there
}

fn each(mut a: Points, b: Points, join: impl Fn(u64, u64) -> u64) -> Points {
    a.iter_mut().zip(b).for_each(|(a, b)| *a = join(*a, b));
    a
}

/// The points behind these along an axis, none of which is the last along it.
fn behind(axis: usize, mut points: Points) -> Points {
    if axis == 2 {
        points.rotate_right(1);
        return points;
    }
    points.map(|layer| layer << STEP[axis])
}

/// The points from which a body bars the way to the next, and those that lie in it. Beside each hit the point is seen from where the line enters or leaves:
/// what most of the points of a region say holds for all of it.
fn solid_points(hits: &[Hit], ends: &mut [[f64; 2]]) -> (Blocked, Points) {
    let [mut blocked, mut enters, mut leaves] = [Blocked::default(); 3];
    for hit in hits {
        let [first, last] = &mut ends[usize::from(hit.line)];
        let known = add(&mut blocked, hit.line.into());
        (*first, *last) = if known { (first.min(hit.at), last.max(hit.at)) } else { (hit.at, hit.at) };
    }
    for hit in hits {
        // A sheet has two surfaces at one place, and is seen from outside on both sides.
        let [first, last] = ends[usize::from(hit.line)];
        if hit.enters && hit.at - first <= NEAR {
            add(&mut enters, hit.line.into());
        }
        if !hit.enters && last - hit.at <= NEAR {
            add(&mut leaves, hit.line.into());
        }
    }
    let [mut outside, mut inside] = [Points::default(); 2];
    for axis in 0..3 {
        let others = |some: Points| each(blocked[axis], some, |all, some| all & !some);
        let [enters, leaves] = [enters[axis], leaves[axis]];
        outside = each(outside, each(enters, behind(axis, leaves), |a, b| a | b), |a, b| a | b);
        inside = each(inside, each(others(enters), behind(axis, others(leaves)), |a, b| a | b), |a, b| a | b);
    }
    let (mut rest, mut solid) = ([u64::MAX; ALONG], Points::default());
    let count = |points: Points| points.iter().map(|layer| layer.count_ones()).sum::<u32>();
    // A region that is nowhere seen from inside is not solid.
    while let Some(region) = take_region(&mut rest, &inside, &blocked) {
        let [out, within] = [outside, inside].map(|seen| count(each(region, seen, |a, b| a & b)));
        if within > out {
            solid = each(solid, region, |a, b| a | b);
        }
    }
    (blocked, solid)
}

/// What of the lines along x, y and z meets solid: what surface crosses, or what lies in solid altogether.
fn lines(blocked: &Blocked, open: &Points) -> [PointLines; 3] {
    [0, 1, 2].map(|axis| {
        let all = each(blocked[axis], *open, |blocked, open| blocked | !open);
        // All that stands in a row, a column or a stack is gathered in its first point.
        let gather = |steps: [u32; 3]| all.map(|layer| steps.iter().fold(layer, |layer, step| layer | (layer >> step)));
        let low = match axis {
            0 => sides_of(&gather([4, 2, 1]))[0][0],
            1 => sides_of(&gather([32, 16, 8]))[1][0],
            _ => all.iter().fold(0, |all, layer| all | layer),
        };
        let share = |lines: u64| f64::from((lines & WITHIN_EDGES).count_ones()) / f64::from(WITHIN_EDGES.count_ones());
        PointLines { blocked: share(low), all_blocked: low == u64::MAX }
    })
}

/// Takes from `points` the region of the first of them that is among `seeds`; none if there are none.
fn take_region(points: &mut Points, seeds: &Points, blocked: &Blocked) -> Option<Points> {
    /// Points with another one behind them along x.
    const BEFORE_LAST: u64 = 0x7f7f_7f7f_7f7f_7f7f;
    let seed = points.iter().zip(seeds).position(|(points, seeds)| points & seeds != 0)?;
    let mut region = Points::default();
    let seeds = points[seed] & seeds[seed];
    region[seed] = seeds & seeds.wrapping_neg();
    // All of a layer that can be reached within it.
    let spread = |k: usize, mut layer: u64| loop {
        let before = layer;
        for (free, step) in [(!blocked[0][k] & BEFORE_LAST, STEP[0]), (!blocked[1][k], STEP[1])] {
            layer |= (((layer & free) << step) | ((layer >> step) & free)) & points[k];
        }
        if layer == before {
            return layer;
        }
    };
    loop {
        let before = region;
        for k in seed..ALONG {
            let below = if k > 0 { region[k - 1] & !blocked[2][k - 1] } else { 0 };
            region[k] = spread(k, region[k] | (below & points[k]));
        }
        for k in (0..ALONG - 1).rev() {
            region[k] = spread(k, region[k] | (region[k + 1] & !blocked[2][k] & points[k]));
        }
        if region == before {
            break;
        }
    }
    *points = each(*points, region, |points, region| points & !region);
    Some(region)
}

/// The points of a part in the sides of the cell; in the sides normal to x as y fastest, else x fastest.
fn sides_of(part: &Points) -> [[u64; 2]; 3] {
    /// One point of each row of a layer, and what brings these together in the highest row.
    const ROWS: u64 = 0x0101_0101_0101_0101;
    const TOGETHER: u64 = 0x0102_0408_1020_4080;
    let last = ALONG - 1;
    let side = |row: &dyn Fn(u64) -> u64| {
        let rows = part.iter().enumerate().map(|(k, &layer)| (row(layer) & 0xff) << (ALONG * k));
        rows.sum::<u64>()
    };
    let x = [0, last].map(|i| side(&|layer| ((layer >> i) & ROWS).wrapping_mul(TOGETHER) >> (ALONG * last)));
    let y = [0, last].map(|j| side(&|layer| layer >> (ALONG * j)));
    [x, y, [0, last].map(|k| part[k])]
}
