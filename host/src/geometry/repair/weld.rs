//! Corner lists to indexed triangles: equal points become one vertex.

use super::shells::edges_of;
use glam::DVec3;
use rustc_hash::FxHashMap as HashMap;

/// Triangles as indices into a list of distinct points.
#[derive(Debug, Clone, Default)]
pub struct Indexed {
    /// Distinct points.
    pub points: Vec<DVec3>,
    /// Corners of each triangle.
    pub triangles: Vec<[u32; 3]>,
}

/// Weld points that are equal; −0 equals 0.
#[must_use]
pub fn weld(triangles: &[[DVec3; 3]]) -> Indexed {
    let mut seen: HashMap<[u64; 3], u32> = HashMap::default();
    seen.reserve(triangles.len());
    let mut points = Vec::new();
    let indexed = triangles
        .iter()
        .map(|t| {
            t.map(|p| {
                *seen.entry((p + 0.0).to_array().map(f64::to_bits)).or_insert_with(|| {
                    points.push(p + 0.0);
                    (points.len() - 1) as u32
                })
            })
        })
        .collect();
    Indexed { points, triangles: indexed }
}

/// Of an edge, how wide a crack at its end may be. Below a half: then no edge has both its ends merged into one point.
const OF_AN_EDGE: f64 = 0.25;

/// Merge `loose` points closer than `distance`, and much closer than the edges of `alive` triangles there are long; each group
/// moves to the place of its first point. Other points stay where they are. Returns the largest move.
pub fn merge_close(mesh: &mut Indexed, alive: &[bool], loose: &[bool], distance: f64) -> f64 {
    let reach = reach(mesh, alive, loose, distance);
    let key = |p: DVec3| (p / distance).floor().to_array().map(|c| c as i64);
    let mut buckets: HashMap<[i64; 3], Vec<u32>> = HashMap::default();
    let (mut target, mut largest_move): (Vec<u32>, f64) = ((0..mesh.points.len() as u32).collect(), 0.0);
    for (v, &p) in mesh.points.iter().enumerate().filter(|&(v, _)| loose[v]) {
        let [a, b, c] = key(p);
        let around = (-1..=1).flat_map(|i| (-1..=1).flat_map(move |j| (-1..=1).map(move |k| [a + i, b + j, c + k])));
        let apart = |q: u32| mesh.points[q as usize].distance(p);
        let near = around
            .filter_map(|k| buckets.get(&k))
            .flatten()
            .copied()
            .filter(|&q| apart(q) <= reach[v].min(reach[q as usize]))
            .min();
        match near {
            Some(q) => {
                largest_move = largest_move.max(apart(q));
                target[v] = q;
            }
            None => buckets.entry([a, b, c]).or_default().push(v as u32),
        }
    }
    for t in &mut mesh.triangles {
        *t = t.map(|v| target[v as usize]);
    }
    largest_move
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
