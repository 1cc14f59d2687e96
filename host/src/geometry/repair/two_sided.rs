//! Double-sided surface with T-junctions: which triangles are looked at together.
//!
//! Where parts touch, the edges of such a surface do not tell whose they are: a front may as well belong to the back of another part. So all
//! triangles that share edges are one cluster, whose regions tell what is solid (`regions::of_two_sided`).

use crate::geometry::repair::edges::{EdgeUses, Use};
use crate::geometry::repair::sets::Sets;
use crate::geometry::repair::weld::Indexed;
use rustc_hash::FxHashMap as HashMap;

/// The clusters of triangles that share edges, of those `alive` and of one named solid each, in which every triangle has a back and the edges do not
/// tell what belongs together. Where only some triangles have backs, they may be parts of both orientations that touch, whose fronts tell more than regions.
/// A lone double-sided surface is not among the clusters: its edges tell.
#[must_use]
pub fn clusters(mesh: &Indexed, alive: &[bool], solid_of: impl Fn(u32) -> usize) -> Vec<Vec<u32>> {
    let uses = EdgeUses::new(mesh, alive);
    let mut sets = Sets::new(mesh.triangles.len());
    let mut seen: Vec<(u32, AtEdge)> = Vec::new();
    for uses in uses.each() {
        let solid = |u: &Use| solid_of(mesh.source(u.triangle));
        let mut of_solids: Vec<(usize, Use)> = uses.iter().map(|(_, u)| (solid(u), *u)).collect();
        of_solids.sort_by_key(|&(solid, u)| (solid, u.triangle));
        for uses in of_solids.chunk_by(|a, b| a.0 == b.0) {
            let first = uses[0].1.triangle;
            uses.iter().for_each(|(_, u)| sets.join(first as usize, u.triangle as usize));
            seen.push((first, AtEdge::new(mesh, uses)));
        }
    }
    let mut clusters: HashMap<usize, AtEdge> = HashMap::default();
    for (triangle, found) in seen {
        let all = clusters.entry(sets.find(triangle as usize)).or_insert(AtEdge { has_backs: true, tells: true });
        (all.has_backs, all.tells) = (all.has_backs && found.has_backs, all.tells && found.tells);
    }
    let mut members: HashMap<usize, Vec<u32>> = HashMap::default();
    for n in (0..alive.len()).filter(|&n| alive[n]) {
        let cluster = sets.find(n);
        if clusters.get(&cluster).is_some_and(|all| all.has_backs && !all.tells) {
            members.entry(cluster).or_default().push(n as u32);
        }
    }
    let mut found: Vec<Vec<u32>> = members.into_values().collect();
    found.sort_unstable();
    found
}

/// What the triangles of one solid at an edge say, or those at all edges of a cluster.
struct AtEdge {
    /// Every triangle is there from both sides.
    has_backs: bool,
    /// Two triangles meet there, each once from either side.
    tells: bool,
}

impl AtEdge {
    fn new(mesh: &Indexed, uses: &[(usize, Use)]) -> Self {
        let mut ways: Vec<([u32; 3], bool)> = uses.iter().map(|(_, u)| (mesh.sorted(u.triangle), u.up)).collect();
        ways.sort_unstable();
        let back = |w: &[([u32; 3], bool)]| w[0].0 == w[1].0 && w[0].1 != w[1].1;
        let tells = matches!(ways[..], [a, b, c, d] if back(&[a, b]) && back(&[c, d]) && a.0 != c.0);
        let from_both = |ways: &[([u32; 3], bool)]| ways.iter().any(|w| w.1) && ways.iter().any(|w| !w.1);
        AtEdge { has_backs: ways.chunk_by(|a, b| a.0 == b.0).all(from_both), tells }
    }
}
