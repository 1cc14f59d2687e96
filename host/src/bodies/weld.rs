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

/// Merge points closer than `distance`; each group moves to the place of its first point. Returns the largest move.
pub fn merge_close(mesh: &mut Indexed, distance: f64) -> f64 {
    let key = |p: DVec3| (p / distance).floor().to_array().map(|c| c as i64);
    let mut buckets: HashMap<[i64; 3], Vec<u32>> = HashMap::default();
    let (mut target, mut largest_move) = (Vec::with_capacity(mesh.points.len()), 0.0_f64);
    for (v, &p) in mesh.points.iter().enumerate() {
        let [a, b, c] = key(p);
        let around = (-1..=1).flat_map(|i| (-1..=1).flat_map(move |j| (-1..=1).map(move |k| [a + i, b + j, c + k])));
        let near = around
            .filter_map(|k| buckets.get(&k))
            .flatten()
            .copied()
            .filter(|&q| mesh.points[q as usize].distance(p) <= distance)
            .min();
        match near {
            Some(q) => {
                largest_move = largest_move.max(mesh.points[q as usize].distance(p));
                target.push(q);
            }
            None => {
                buckets.entry([a, b, c]).or_default().push(v as u32);
                target.push(v as u32);
            }
        }
    }
    for t in &mut mesh.triangles {
        *t = t.map(|v| target[v as usize]);
    }
    largest_move
}
