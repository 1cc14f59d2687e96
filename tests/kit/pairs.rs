//! Pairs of bodies for benchmarks and tests: boxes, cells and triangles, geodesic hulls.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DMat3, DQuat, DVec3};
use voidage_core::convex::gjk::{Distance, distance};
use voidage_core::convex::shape::{Adjacency, OrientedBox};
use voidage_core::convex::support::Support;

use crate::random::Random;

/// A box of given half lengths, rotated, then moved.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    /// Half lengths along its own axes.
    pub half: DVec3,
    /// Rotation.
    pub rotation: DQuat,
    /// Centre.
    pub center: DVec3,
}

impl Pose {
    /// As a body.
    pub fn body(&self) -> OrientedBox<DVec3> {
        let m = DMat3::from_quat(self.rotation);
        let half_axes = [m.x_axis * self.half.x, m.y_axis * self.half.y, m.z_axis * self.half.z];
        OrientedBox { center: self.center, half_axes }
    }
}

/// How close a pair lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Nearness {
    /// At least a size apart.
    Separated,
    /// A thousandth of a size apart, or as deep into each other.
    Near,
    /// Centres less than half a size apart.
    Overlapping,
}

fn pose(random: &mut Random) -> Pose {
    let half = DVec3::from_array(std::array::from_fn(|_| random.between(0.3, 1.0)));
    Pose { half, rotation: DQuat::from_array(random.rotation()), center: random.vector(1.0) }
}

/// How far to move `b` so that the gap to `a` becomes `gap`, negative for overlap; they must be apart.
pub fn approach(a: &impl Support<Vector = DVec3>, b: &impl Support<Vector = DVec3>, gap: f64) -> DVec3 {
    match distance(a, b, None) {
        Distance::Separated { distance, axis, .. } => axis * (gap - distance),
        _ => DVec3::ZERO,
    }
}

/// Pairs of boxes in any position.
pub fn boxes(seed: u64, count: usize, nearness: Nearness) -> Vec<(Pose, Pose)> {
    let mut random = Random::new(seed);
    let pair = |_| {
        let (a, mut b) = (pose(&mut random), pose(&mut random));
        let away = DVec3::from_array(random.on_sphere());
        match nearness {
            Nearness::Overlapping => b.center = a.center + away * random.between(0.0, 0.5),
            Nearness::Separated => b.center = a.center + away * random.between(5.0, 9.0),
            Nearness::Near => {
                b.center = a.center + away * 5.0;
                let gap = if random.below(2) == 0 { 1e-3 } else { -1e-3 };
                b.center += approach(&a.body(), &b.body(), gap);
            }
        }
        (a, b)
    };
    (0..count).map(pair).collect()
}

/// Triangles about a unit cell at the origin, of about its size and smaller; some half of them meet it.
pub fn triangles(seed: u64, count: usize) -> Vec<[DVec3; 3]> {
    let mut random = Random::new(seed);
    let triangle = |_| {
        let size = random.between(0.2, 1.5);
        let center = DVec3::splat(0.5) + random.vector::<DVec3>(0.9);
        std::array::from_fn(|_| center + random.vector::<DVec3>(size))
    };
    (0..count).map(triangle).collect()
}

/// A geodesic sphere: vertices, and edges as [`Adjacency`] wants them.
#[derive(Clone, Debug)]
pub struct Geodesic {
    /// On the unit sphere.
    pub vertices: Vec<DVec3>,
    /// Three indices a face, counter-clockwise from outside.
    pub faces: Vec<[u32; 3]>,
    offsets: Vec<u32>,
    neighbours: Vec<u32>,
}

impl Geodesic {
    /// Each edge of an icosahedron cut into `n` parts: `10 n² + 2` vertices.
    pub fn new(n: usize) -> Self {
        let g = (1.0 + 5f64.sqrt()) / 2.0;
        let mut corners = Vec::new();
        for (s, t) in [(-1.0, g), (1.0, g), (-1.0, -g), (1.0, -g)] {
            corners.extend([DVec3::new(s, t, 0.0), DVec3::new(0.0, s, t), DVec3::new(t, 0.0, s)]);
        }
        let near = |i: usize, j: usize| (corners[i] - corners[j]).length() < 2.1;
        let mut index = BTreeMap::new();
        let (mut vertices, mut faces) = (Vec::new(), Vec::new());
        let mut add = |p: DVec3| {
            let p = p.normalize();
            let key = p.to_array().map(|x| (x * 1e9).round() as i64);
            *index.entry(key).or_insert_with(|| {
                vertices.push(p);
                vertices.len() as u32 - 1
            })
        };
        for i in 0..12 {
            for j in i + 1..12 {
                for k in j + 1..12 {
                    if !(near(i, j) && near(j, k) && near(i, k)) {
                        continue;
                    }
                    let (a, b, c) = (corners[i], corners[j], corners[k]);
                    let (b, c) = if a.cross(b).dot(c) > 0.0 { (b, c) } else { (c, b) };
                    let mut at = |u: usize, v: usize| {
                        let (u, v) = (u as f64 / n as f64, v as f64 / n as f64);
                        add(a * (1.0 - u - v) + b * u + c * v)
                    };
                    for u in 0..n {
                        for v in 0..n - u {
                            faces.push([at(u, v), at(u + 1, v), at(u, v + 1)]);
                            if u + v + 2 <= n {
                                faces.push([at(u + 1, v), at(u + 1, v + 1), at(u, v + 1)]);
                            }
                        }
                    }
                }
            }
        }
        let mut edges = vec![BTreeSet::new(); vertices.len()];
        for [i, j, k] in &faces {
            for (p, q) in [(i, j), (j, k), (k, i)] {
                edges[*p as usize].insert(*q);
                edges[*q as usize].insert(*p);
            }
        }
        let (mut offsets, mut neighbours) = (vec![0], Vec::new());
        for set in edges {
            neighbours.extend(set);
            offsets.push(neighbours.len() as u32);
        }
        Geodesic { vertices, faces, offsets, neighbours }
    }

    /// Its edges.
    pub fn adjacency(&self) -> Adjacency<'_> {
        Adjacency::new(&self.vertices, &self.offsets, &self.neighbours)
    }
}
