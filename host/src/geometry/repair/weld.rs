//! Corner lists to indexed triangles: equal points become one vertex.

use glam::DVec3;
use rustc_hash::FxHashMap as HashMap;

/// Triangles as indices into a list of distinct points.
#[derive(Debug, Clone, Default)]
pub struct Indexed {
    /// Distinct points.
    pub points: Vec<DVec3>,
    /// Corners of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Triangles that were cut into parts have them at the end of the list: for each of these parts, the number of the triangle that it
    /// was cut from.
    pub sources: Vec<u32>,
}

impl Indexed {
    /// The number in the file of a triangle, or of the triangle that it was cut from.
    #[must_use]
    pub fn source(&self, n: u32) -> u32 {
        let whole = self.triangles.len() - self.sources.len();
        (n as usize).checked_sub(whole).and_then(|part| self.sources.get(part)).map_or(n, |&source| source)
    }

    /// The corners of a triangle in ascending order: equal for a triangle and its back.
    #[must_use]
    pub fn sorted(&self, n: u32) -> [u32; 3] {
        let mut corners = self.triangles[n as usize];
        corners.sort_unstable();
        corners
    }

    /// Have two triangles with an edge in common all corners in common?
    #[must_use]
    pub fn are_same(&self, a: u32, b: u32) -> bool {
        // The third ones are equal if the sums are.
        self.sum_of_corners(a) == self.sum_of_corners(b)
    }

    /// The sum of the numbers of a triangle's corners: of those with an edge in common it is the same if all corners are.
    #[must_use]
    pub fn sum_of_corners(&self, n: u32) -> u64 {
        self.triangles[n as usize].map(u64::from).iter().sum()
    }

    /// Where the corners of some triangles are.
    #[must_use]
    pub fn corners(&self, triangles: &[u32]) -> Vec<[DVec3; 3]> {
        triangles.iter().map(|&n| self.triangles[n as usize].map(|v| self.points[v as usize])).collect()
    }
}

/// The directed edges of a triangle.
pub fn edges_of(t: [u32; 3]) -> [[u32; 2]; 3] {
    [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]
}

/// The bits of a point's coordinates: the same for equal points; −0 equals 0.
#[must_use]
pub fn bits(p: DVec3) -> [u64; 3] {
    (p + 0.0).to_array().map(f64::to_bits)
}

/// Weld points that are equal; −0 equals 0.
#[must_use]
pub fn weld(triangles: &[[DVec3; 3]]) -> Indexed {
    // Numbers hash faster than a list of them.
    let mut seen: HashMap<(u64, u64, u64), u32> = HashMap::default();
    seen.reserve(triangles.len());
    let mut points = Vec::new();
    let indexed = triangles
        .iter()
        .map(|t| {
            t.map(|p| {
                *seen.entry(bits(p).into()).or_insert_with(|| {
                    points.push(p + 0.0);
                    (points.len() - 1) as u32
                })
            })
        })
        .collect();
    Indexed { points, triangles: indexed, sources: Vec::new() }
}

/// A crack is closed if it is narrower than this share of the edges that end at it. Below a half, no edge can lose both its ends to one point.
const OF_AN_EDGE: f64 = 0.25;

/// Points in cubic buckets, for searches within distances ("reaches") of very different sizes: one set of buckets for each binary order of
/// the reach, as wide as the reach or wider.
#[derive(Debug)]
pub struct Buckets {
    origin: DVec3,
    points: HashMap<(i32, [i64; 3]), Vec<u32>>,
    /// Binary orders of the smallest and the largest reach.
    orders: [i32; 2],
}

impl Buckets {
    /// None yet, for points of these reaches above and beside `origin`.
    #[must_use]
    pub fn new(origin: DVec3, reach: impl Iterator<Item = f64>) -> Self {
        let (least, most) = reach.filter(|&r| r > 0.0).fold((f64::INFINITY, 0.0_f64), |(a, b), r| (a.min(r), b.max(r)));
        let highest = Self::order(most);
        // Points that reach less than the lowest order are looked for farther than they reach, which only takes longer.
        let lowest = Self::order(least).clamp(highest - Self::ORDERS, highest);
        Buckets { origin, points: HashMap::default(), orders: [lowest, highest] }
    }

    /// So many binary orders of reaches are told apart.
    const ORDERS: i32 = 40;

    fn order(reach: f64) -> i32 {
        if reach > 0.0 && reach.is_finite() { reach.log2().ceil() as i32 } else { 0 }
    }

    /// The orders at which a point of this reach is found.
    fn orders(&self, reach: f64) -> std::ops::RangeInclusive<i32> {
        self.orders[0]..=Self::order(reach).clamp(self.orders[0], self.orders[1])
    }

    fn bucket(&self, p: DVec3, order: i32) -> [i64; 3] {
        ((p - self.origin) / 2_f64.powi(order)).floor().to_array().map(|c| c as i64)
    }

    /// Add a point.
    pub fn add(&mut self, v: u32, p: DVec3, reach: f64) {
        for order in self.orders(reach) {
            let bucket = self.bucket(p, order);
            self.points.entry((order, bucket)).or_default().push(v);
        }
    }

    /// Points that may lie as close as both they and a point of this reach do reach; some more than once.
    pub fn near(&self, p: DVec3, reach: f64) -> impl Iterator<Item = u32> {
        self.orders(reach).flat_map(move |order| {
            let [a, b, c] = self.bucket(p, order);
            let side = |n: i64| n.saturating_sub(1)..=n.saturating_add(1);
            let around = side(a).flat_map(move |i| side(b).flat_map(move |j| side(c).map(move |k| [i, j, k])));
            around.filter_map(move |at| self.points.get(&(order, at))).flatten().copied()
        })
    }
}

/// For each point, the point that it may be one with: of `loose` points closer than `distance`, and much closer than the edges of `alive` triangles there are
/// long, the first of each group. Other points stand for themselves.
pub fn close_points(mesh: &Indexed, alive: &[bool], loose: &[bool], distance: f64) -> Vec<u32> {
    let reach = reach(mesh, alive, loose, distance);
    let origin = mesh.points.iter().fold(DVec3::INFINITY, |a, p| a.min(*p));
    let mut buckets = Buckets::new(origin, reach.iter().copied());
    let mut target: Vec<u32> = (0..mesh.points.len() as u32).collect();
    for (v, &p) in mesh.points.iter().enumerate().filter(|&(v, _)| loose[v] && reach[v] > 0.0) {
        let is_close = |q: u32| mesh.points[q as usize].distance(p) <= reach[v].min(reach[q as usize]);
        match buckets.near(p, reach[v]).filter(|&q| is_close(q)).min() {
            Some(q) => target[v] = q,
            None => buckets.add(v as u32, p, reach[v]),
        }
    }
    target
}

/// How far from each loose point others are still the same.
fn reach(mesh: &Indexed, alive: &[bool], loose: &[bool], distance: f64) -> Vec<f64> {
    let mut reach: Vec<f64> = loose.iter().map(|&l| if l { distance } else { 0.0 }).collect();
    for (t, _) in mesh.triangles.iter().zip(alive).filter(|&(_, &alive)| alive) {
        for [a, b] in edges_of(*t).map(|e| e.map(|v| v as usize)) {
            let most = OF_AN_EDGE * mesh.points[a].distance(mesh.points[b]);
            reach[a] = reach[a].min(most);
            reach[b] = reach[b].min(most);
        }
    }
    reach
}
