//! Scenes of convex bodies, the exact shares of their unions, and what must hold of computed ones.
//!
//! The oracle knows nothing of the subdivision: it cuts the box of a cell by half-spaces, one after the other, and counts overlaps by
//! inclusion and exclusion.

use glam::DVec3;
use voidage::geometry::bodies::Bodies;
use voidage::grid::Edges;
use voidage::porosity::{FieldSet, Leaf, Method, Options, Porosity, porosity};

use crate::random::Random;
use crate::solids::{Triangle, cuboid, scene, sphere, turned_box};

/// A point is inside if `normal·p <= offset`.
pub type HalfSpace = (DVec3, f64);

/// The half-spaces of a convex body's triangles.
#[must_use]
pub fn half_spaces(triangles: &[Triangle]) -> Vec<HalfSpace> {
    let plane = |[a, b, c]: &Triangle| {
        let normal = (b - a).cross(c - a).normalize();
        (normal, normal.dot((*a + *b + *c) / 3.0))
    };
    triangles.iter().map(plane).collect()
}

/// The part of a convex polygon inside a half-space.
fn cut(polygon: &[DVec3], &(normal, offset): &HalfSpace) -> Vec<DVec3> {
    let height = |p: DVec3| p.dot(normal) - offset;
    let mut kept = Vec::new();
    for (n, &p) in polygon.iter().enumerate() {
        let q = polygon[(n + 1) % polygon.len()];
        let (hp, hq) = (height(p), height(q));
        if hp <= 0.0 {
            kept.push(p);
        }
        if (hp < 0.0 && hq > 0.0) || (hp > 0.0 && hq < 0.0) {
            kept.push(p + (q - p) * (hp / (hp - hq)));
        }
    }
    kept
}

fn area(polygon: &[DVec3]) -> DVec3 {
    let fan = |w: &[DVec3]| (w[0] - polygon[0]).cross(w[1] - polygon[0]) * 0.5;
    if polygon.len() < 3 { DVec3::ZERO } else { polygon[1..].windows(2).map(fan).sum() }
}

/// The area of a rectangle inside some half-spaces.
fn area_inside(rectangle: &[DVec3], planes: &[HalfSpace]) -> f64 {
    let inside = |p: Vec<DVec3>, h: &HalfSpace| if p.len() < 3 { Vec::new() } else { cut(&p, h) };
    area(&planes.iter().fold(rectangle.to_vec(), inside)).length()
}

/// The volume of a box inside some half-spaces: the box's sides cut by all, and every plane's own part of the surface.
fn volume_inside(lo: DVec3, hi: DVec3, planes: &[HalfSpace]) -> f64 {
    let sides = [
        (DVec3::X, hi.x),
        (DVec3::NEG_X, -lo.x),
        (DVec3::Y, hi.y),
        (DVec3::NEG_Y, -lo.y),
        (DVec3::Z, hi.z),
        (DVec3::NEG_Z, -lo.z),
    ];
    let all = distinct(&sides.into_iter().chain(planes.iter().copied()).collect::<Vec<_>>());
    // Two planes back to back leave no volume, whatever rounding makes of their facets.
    let closed = |&(n, o): &HalfSpace| all.iter().any(|&(m, p)| (n + m).length() < 1e-11 && o + p < 1e-11);
    if all.iter().any(closed) {
        return 0.0;
    }
    let (middle, size) = ((lo + hi) * 0.5, (hi - lo).length());
    let facet = |n: usize| {
        let (normal, offset) = all[n];
        let u = normal.any_orthonormal_vector();
        let v = normal.cross(u);
        let foot = middle + normal * (offset - normal.dot(middle));
        let corner = |s: f64, t: f64| foot + (u * s + v * t) * (2.0 * size);
        let whole = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        let others = all.iter().enumerate().filter(|(m, _)| *m != n).map(|(_, h)| h);
        let rest = others.fold(whole, |p, h| if p.len() < 3 { Vec::new() } else { cut(&p, h) });
        area(&rest).dot(normal) * (offset - normal.dot(middle)) / 3.0
    };
    (0..all.len()).map(facet).sum::<f64>().max(0.0)
}

/// Planes that are not the same as an earlier one.
fn distinct(planes: &[HalfSpace]) -> Vec<HalfSpace> {
    let mut kept: Vec<HalfSpace> = Vec::new();
    for &(n, o) in planes {
        if !kept.iter().any(|&(m, p)| (n - m).length() < 1e-11 && (o - p).abs() < 1e-11) {
            kept.push((n, o));
        }
    }
    kept
}

/// Inclusion and exclusion: the measure of a union from those of all intersections.
fn union_of(bodies: &[Vec<HalfSpace>], measure: impl Fn(&[HalfSpace]) -> f64) -> f64 {
    let reaching: Vec<&Vec<HalfSpace>> = bodies.iter().filter(|b| measure(b) > 0.0).collect();
    let subset = |bits: usize| {
        let planes: Vec<_> =
            (0..reaching.len()).filter(|b| bits >> b & 1 == 1).flat_map(|b| reaching[b].clone()).collect();
        measure(&planes) * if bits.count_ones() % 2 == 1 { 1.0 } else { -1.0 }
    };
    (1..1 << reaching.len()).map(subset).sum()
}

/// Solid shares of all cells and faces of a union of convex bodies.
#[must_use]
pub fn exact_shares(edges: &Edges, bodies: &[Vec<HalfSpace>]) -> FieldSet {
    let grid = edges.grid(None).expect("a grid");
    let mut shares = FieldSet::new(&grid, true);
    let [nx, ny, nz] = grid.cells();
    let point = |i: usize, j: usize, k: usize| DVec3::new(edges.0[0][i], edges.0[1][j], edges.0[2][k]);
    for (k, j, i) in (0..nz).flat_map(|k| (0..ny).flat_map(move |j| (0..nx).map(move |i| (k, j, i)))) {
        let (lo, hi) = (point(i, j, k), point(i + 1, j + 1, k + 1));
        let solid = union_of(bodies, |planes| volume_inside(lo, hi, planes));
        shares.v[grid.cell_index([i, j, k])] = solid / (hi - lo).element_product();
    }
    for axis in 0..3 {
        let [mx, my, mz] = grid.face_shape(axis);
        for (k, j, i) in (0..mz).flat_map(|k| (0..my).flat_map(move |j| (0..mx).map(move |i| (k, j, i)))) {
            let lo = point(i, j, k);
            let (mut u, mut v) = (DVec3::ZERO, DVec3::ZERO);
            let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
            let index = [i, j, k];
            u[a] = edges.0[a][index[a] + 1] - lo[a];
            v[b] = edges.0[b][index[b] + 1] - lo[b];
            let rectangle = [lo, lo + u, lo + u + v, lo + v];
            let solid = union_of(bodies, |planes| area_inside(&rectangle, planes));
            let field = [&mut shares.x, &mut shares.y, &mut shares.z];
            field.into_iter().nth(axis).expect("three")[grid.face_index(axis, index)] = solid / (u[a] * v[b]);
        }
    }
    shares
}

/// Room for the oracle's own rounding.
const ORACLE: f64 = 1e-9;

/// The truth lies within the bounds of every cell and face.
///
/// # Panics
/// If it does not.
pub fn assert_within(result: &Porosity, solid: &FieldSet, what: &str) {
    let [lower, upper] = result.bounds.as_ref().expect("bounds were asked for");
    let fields = [
        ("v", &lower.v, &upper.v, &solid.v),
        ("x", &lower.x, &upper.x, &solid.x),
        ("y", &lower.y, &upper.y, &solid.y),
        ("z", &lower.z, &upper.z, &solid.z),
    ];
    for (name, lower, upper, solid) in fields {
        assert_eq!(lower.len(), solid.len());
        for n in 0..solid.len() {
            let open = 1.0 - solid[n];
            let held = lower[n] <= open + ORACLE && open - ORACLE <= upper[n];
            assert!(held, "{what}: {name}[{n}]: {open} is not within {} and {}", lower[n], upper[n]);
        }
    }
}

/// A body of a random scene, from small integers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// 0 box along the axes, 1 turned box, 2 icosahedron, 3 tetrahedron.
    pub kind: u8,
    /// Centre in sixteenths.
    pub center: [i8; 3],
    /// Half sizes in sixteenths.
    pub half: [u8; 3],
    /// Of the rotation.
    pub seed: u8,
}

impl Part {
    /// Its triangles; the scene fills about -1..1.
    #[must_use]
    pub fn triangles(&self) -> Vec<Triangle> {
        let center = DVec3::from_array(self.center.map(|c| f64::from(c.clamp(-20, 20)) / 16.0));
        let half = DVec3::from_array(self.half.map(|h| f64::from(h % 16 + 1) / 16.0));
        match self.kind % 4 {
            0 => cuboid(center - half, center + half),
            1 => turned_box(center, half, Random::new(u64::from(self.seed)).turn()),
            2 => sphere(center, half.x, 1),
            _ => {
                let turn = Random::new(u64::from(self.seed)).turn();
                let corners = [[0, 0, 0], [1, 1, 0], [1, 0, 1], [0, 1, 1]]
                    .map(|c: [i32; 3]| center + turn * (half * DVec3::from_array(c.map(|x| f64::from(2 * x - 1)))));
                [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]].map(|t| t.map(|n: usize| corners[n])).to_vec()
            }
        }
    }
}

/// Up to six parts from bytes.
#[must_use]
pub fn decode(bytes: &[u8]) -> Vec<Part> {
    let part = |b: &[u8]| Part {
        kind: b[0],
        center: [b[1] as i8 / 8, b[2] as i8 / 8, b[3] as i8 / 8],
        half: [b[4], b[5], b[6]],
        seed: b[7],
    };
    bytes.chunks_exact(8).take(6).map(part).collect()
}

/// Three uneven cells along each axis, with planes where bodies' sides may lie.
#[must_use]
pub fn small_grid() -> Edges {
    Edges([vec![-1.0, -0.25, 0.3125, 1.0], vec![-1.0, -0.1, 0.5, 1.0], vec![-0.75, 0.0, 0.4, 1.25]])
}

/// Subdivision of a scene by every rule of the leaf holds the exact shares of the union, for any number of threads.
///
/// # Panics
/// If it does not.
pub fn bounds_hold_the_union(parts: &[Part], depth: u32) {
    if parts.is_empty() {
        return;
    }
    let solids: Vec<_> = parts.iter().map(Part::triangles).collect();
    let (bodies, edges) = (scene(&solids), small_grid());
    let truth = exact_shares(&edges, &solids.iter().map(|s| half_spaces(s)).collect::<Vec<_>>());
    for leaf in [Leaf::Solid, Leaf::Half, Leaf::Plane] {
        let options = Options { method: Method::Gjk, leaf, depth, tol: 1e-3, bounds: true, ..Options::default() };
        let result = run(&edges, &bodies, options, 1);
        assert_eq!(result.subdivided, solids.len(), "all bodies are certified to be convex");
        assert_within(&result, &truth, &format!("{leaf:?} {parts:?}"));
    }
}

/// A run in a pool of its own.
///
/// # Panics
/// If the grid or the threads cannot be had.
#[must_use]
pub fn run(edges: &Edges, bodies: &Bodies, options: Options, threads: usize) -> Porosity {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| porosity(&edges.grid(None).expect("a grid"), bodies, options))
}
