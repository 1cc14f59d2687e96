//! The convex hull of points: Quickhull with exact predicates.
//!
//! A face is replaced only if a point lies strictly outside it, decided without rounding (Shewchuk's adaptive determinants). Then the faces
//! that a point sees are whole facets, connected, and no new face is flat; coplanar points need no special care.
//!
//! Ref: Barber, Dobkin, Huhdanpaa, *The Quickhull Algorithm for Convex Hulls*, 1996.

use glam::DVec3;
use robust::{Coord, Coord3D, orient2d, orient3d};
use rustc_hash::FxHashMap as HashMap;

/// A convex polytope: corners and outward triangles.
#[derive(Debug, Clone, PartialEq)]
pub struct HullSolid {
    /// The points on the hull, in the order given; some may lie inside faces or edges.
    pub corners: Vec<DVec3>,
    /// Indices into `corners`, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// Coordinates are scaled to 1; what is smaller than this would underflow in the predicates, which then would no longer be exact.
const SMALLEST: f64 = 1.0 / (1_u128 << 120) as f64 / (1_u128 << 120) as f64;

impl HullSolid {
    /// The hull of some points.
    ///
    /// # Errors
    /// Why they have none: fewer than four, or all in a plane.
    pub fn new(points: &[DVec3]) -> Result<Self, String> {
        if points.len() < 4 {
            return Err(format!("needs at least 4 points, not {}", points.len()));
        }
        let largest = points.iter().fold(0.0_f64, |m, p| m.max(p.abs().max_element()));
        if !largest.is_finite() || (largest > 0.0 && largest < SMALLEST) {
            return Err(format!("has coordinates of a size, {largest:e}, that one cannot compute with"));
        }
        // By a power of two, so that nothing rounds.
        let unit = if largest > 0.0 { 2.0_f64.powi(-(largest.log2().floor() as i32)) } else { 1.0 };
        let scaled: Vec<DVec3> = points.iter().map(|&p| p * unit).collect();
        if scaled.iter().flat_map(|p| p.to_array()).any(|x| x != 0.0 && x.abs() < SMALLEST) {
            return Err("has coordinates too unlike in size to compute with".to_owned());
        }
        let first = simplex(&scaled).ok_or_else(|| format!("lie in a plane, all {} of them", points.len()))?;
        let triangles = Builder::new(&scaled, first).run();
        Ok(Self::with_corners_in_use(points, &triangles))
    }

    fn with_corners_in_use(points: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let mut used = vec![false; points.len()];
        triangles.iter().flatten().for_each(|&v| used[v as usize] = true);
        let mut renamed = vec![0; points.len()];
        let mut corners = Vec::new();
        for v in (0..points.len()).filter(|&v| used[v]) {
            renamed[v] = corners.len() as u32;
            corners.push(points[v]);
        }
        HullSolid { corners, triangles: triangles.iter().map(|t| t.map(|v| renamed[v as usize])).collect() }
    }

    /// Its triangles by corners.
    #[must_use]
    pub fn surface(&self) -> Vec<[DVec3; 3]> {
        self.triangles.iter().map(|t| t.map(|v| self.corners[v as usize])).collect()
    }

    /// Its volume.
    #[must_use]
    pub fn volume(&self) -> f64 {
        let o = self.corners[0];
        self.surface().iter().map(|&[a, b, c]| (a - o).dot((b - o).cross(c - o))).sum::<f64>() / 6.0
    }
}

/// The corners of a box, x fastest.
#[must_use]
pub fn corners_of_box(min: DVec3, max: DVec3) -> [DVec3; 8] {
    [0, 1, 2, 3, 4, 5, 6, 7].map(|n| DVec3::select(glam::BVec3::new(n & 1 != 0, n & 2 != 0, n & 4 != 0), max, min))
}

/// The twelve triangles of a box, outward.
#[must_use]
pub fn surface_of_box(min: DVec3, max: DVec3) -> Vec<[DVec3; 3]> {
    let corner = corners_of_box(min, max);
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).map(|t| t.map(|v: usize| corner[v])).collect()
}

/// Above zero if `p` lies strictly outside the plane of a triangle that is counter-clockwise from outside.
fn outside([a, b, c]: [DVec3; 3], p: DVec3) -> f64 {
    let coord = |p: DVec3| Coord3D { x: p.x, y: p.y, z: p.z };
    // Positive where a, b, c look clockwise from p.
    -orient3d(coord(a), coord(b), coord(c), coord(p))
}

fn collinear(a: DVec3, b: DVec3, c: DVec3) -> bool {
    let flat = |u: usize, v: usize| {
        let [a, b, c] = [a, b, c].map(|p| Coord { x: p[u], y: p[v] });
        orient2d(a, b, c) == 0.0
    };
    flat(0, 1) && flat(1, 2) && flat(2, 0)
}

/// Four points that span a volume, positively oriented; none if all lie in a plane.
fn simplex(points: &[DVec3]) -> Option<[usize; 4]> {
    let all = || 0..points.len();
    let lowest = |&a: &usize, &b: &usize| points[a].x.total_cmp(&points[b].x);
    let a = all().min_by(lowest)?;
    let by = |measure: &dyn Fn(usize) -> f64| all().max_by(|&p, &q| measure(p).total_cmp(&measure(q)));
    let b = by(&|p| (points[p] - points[a]).length_squared())?;
    let area = |p: usize| (points[b] - points[a]).cross(points[p] - points[a]).length_squared();
    // The largest in floating point, unless that is flat in truth.
    let spans_area = |&p: &usize| !collinear(points[a], points[b], points[p]);
    let c = by(&area).filter(spans_area).or_else(|| all().find(spans_area))?;
    let volume = |p: usize| outside([points[a], points[b], points[c]], points[p]);
    let d = by(&|p| volume(p).abs()).filter(|&p| volume(p) != 0.0)?;
    Some(if volume(d) < 0.0 { [a, b, c, d] } else { [a, c, b, d] })
}

struct Face {
    corners: [u32; 3],
    /// Across the edges from corner n to corner n + 1.
    neighbours: [u32; 3],
    /// Points outside this face, not yet on the hull; each is kept by one face.
    above: Vec<u32>,
    alive: bool,
}

struct Builder<'a> {
    points: &'a [DVec3],
    faces: Vec<Face>,
}

impl<'a> Builder<'a> {
    /// Start from a simplex whose fourth corner lies inside of its first three.
    fn new(points: &'a [DVec3], [a, b, c, d]: [usize; 4]) -> Self {
        let [a, b, c, d] = [a, b, c, d].map(|v| v as u32);
        let faces = [([a, b, c], [1, 2, 3]), ([b, a, d], [0, 3, 2]), ([c, b, d], [0, 1, 3]), ([a, c, d], [0, 2, 1])];
        let face = |(corners, neighbours)| Face { corners, neighbours, above: Vec::new(), alive: true };
        let mut builder = Builder { points, faces: faces.map(face).into() };
        let rest = (0..points.len() as u32).filter(|v| ![a, b, c, d].contains(v)).collect();
        builder.hand_out(rest, 0);
        builder
    }

    fn outside(&self, face: u32, v: u32) -> f64 {
        outside(self.faces[face as usize].corners.map(|v| self.points[v as usize]), self.points[v as usize])
    }

    /// Give points to the first face, from `first` on, that they lie outside of. The others are inside.
    fn hand_out(&mut self, orphans: Vec<u32>, first: usize) {
        for v in orphans {
            if let Some(face) = (first..self.faces.len()).find(|&f| self.outside(f as u32, v) > 0.0) {
                self.faces[face].above.push(v);
            }
        }
    }

    fn run(mut self) -> Vec<[u32; 3]> {
        let mut next = 0;
        while next < self.faces.len() {
            let face = &self.faces[next];
            let apex = face
                .above
                .iter()
                .copied()
                .max_by(|&p, &q| self.outside(next as u32, p).total_cmp(&self.outside(next as u32, q)));
            match apex {
                Some(apex) if face.alive => self.add(apex, next as u32),
                _ => next += 1,
            }
        }
        self.faces.iter().filter(|f| f.alive).map(|f| f.corners).collect()
    }

    /// Replace the faces that a point sees by those between it and their rim.
    fn add(&mut self, apex: u32, seen: u32) {
        let (mut orphans, mut rim) = (Vec::new(), Vec::new());
        let mut stack = vec![seen];
        self.faces[seen as usize].alive = false;
        while let Some(f) = stack.pop() {
            let Face { corners, neighbours, .. } = self.faces[f as usize];
            orphans.append(&mut self.faces[f as usize].above);
            for n in 0..3 {
                let other = neighbours[n];
                if !self.faces[other as usize].alive {
                    continue;
                }
                if self.outside(other, apex) > 0.0 {
                    self.faces[other as usize].alive = false;
                    stack.push(other);
                } else {
                    rim.push(([corners[n], corners[(n + 1) % 3]], other));
                }
            }
        }
        let first = self.faces.len();
        // The rim is one closed loop: each of its corners begins one edge.
        let begins: HashMap<u32, u32> =
            rim.iter().enumerate().map(|(n, ([from, _], _))| (*from, (first + n) as u32)).collect();
        let ends: HashMap<u32, u32> =
            rim.iter().enumerate().map(|(n, ([_, to], _))| (*to, (first + n) as u32)).collect();
        for (n, &([from, to], other)) in rim.iter().enumerate() {
            let at = (first + n) as u32;
            let across = &mut self.faces[other as usize];
            for edge in 0..3 {
                if across.corners[edge] == to && across.corners[(edge + 1) % 3] == from {
                    across.neighbours[edge] = at;
                }
            }
            let neighbours = [other, begins.get(&to).copied().unwrap_or(at), ends.get(&from).copied().unwrap_or(at)];
            self.faces.push(Face { corners: [from, to, apex], neighbours, above: Vec::new(), alive: true });
        }
        orphans.retain(|&v| v != apex);
        self.hand_out(orphans, first);
    }
}
