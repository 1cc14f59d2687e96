//! Closed surfaces that were joined to one because they touch, and of which another body holds only some.

use crate::geometry::repair::edges::{ends, key, without_opposites};
use crate::geometry::repair::junctions::{corners_on, parts_of};
use crate::geometry::repair::nesting::{Closed, just_within, signed_volume};
use crate::geometry::repair::rims::rims;
use crate::geometry::repair::sets::Sets;
use crate::geometry::repair::weld::{Indexed, edges_of};
use rustc_hash::FxHashMap as HashMap;

/// So many times at most a triangle is looked at from a point: beyond, a surface stays as it was joined.
const LOOKS: usize = 20_000_000;

/// The triangles `own` of a closed surface in two, with those of the `walls` in it: what `other` holds, and what it does not. None unless there are some of
/// its own on both sides, and each closes by itself.
#[must_use]
pub fn apart(mesh: &Indexed, own: &[u32], walls: &[u32], other: &Closed, rounding: f64) -> Option<[Vec<u32>; 2]> {
    let members = [own, walls].concat();
    let corners = mesh.corners(&members);
    let volume = signed_volume(&corners[..own.len()], corners.first()?[0]);
    let pieces = pieces(mesh, &members, rounding);
    if pieces.len() < 2 || pieces.len().saturating_mul(other.triangles.len()) > LOOKS {
        return None;
    }
    let (mut two, mut has_own) = ([Vec::new(), Vec::new()], [false; 2]);
    for piece in pieces {
        let is_held =
            piece.iter().find_map(|&m| just_within(&corners[m], volume)).is_some_and(|p| other.winds_around(p));
        let side = usize::from(!is_held);
        has_own[side] |= piece.iter().any(|&m| m < own.len());
        two[side].extend(piece.into_iter().map(|m| members[m]));
    }
    two.iter_mut().for_each(|members| members.sort_unstable());
    (has_own == [true; 2] && two.iter().all(|members| closes(mesh, members, rounding))).then_some(two)
}

/// Does a surface close, be it with T-junctions?
fn closes(mesh: &Indexed, members: &[u32], rounding: f64) -> bool {
    let edges = members.iter().flat_map(|&n| edges_of(mesh.triangles[n as usize]));
    rims(&without_opposites(edges)).iter().all(|rim| rim.cancels(&mesh.points, rounding))
}

/// What of a surface is connected by edges that leave no choice, cut at the corners that lie on them: those of two triangles. Positions in `members`.
fn pieces(mesh: &Indexed, members: &[u32], rounding: f64) -> Vec<Vec<usize>> {
    let mut edges: Vec<u64> =
        members.iter().flat_map(|&n| edges_of(mesh.triangles[n as usize])).map(|[a, b]| key(a, b)).collect();
    edges.sort_unstable();
    edges.dedup();
    let mut corners: Vec<u32> = edges.iter().flat_map(|&edge| ends(edge)).collect();
    corners.sort_unstable();
    corners.dedup();
    let on_edges = corners_on(mesh, &edges, &corners, rounding);
    let mut uses: Vec<(u64, usize)> = Vec::new();
    for (m, &n) in members.iter().enumerate() {
        for edge in edges_of(mesh.triangles[n as usize]).map(|[a, b]| key(a, b)) {
            uses.extend(parts_of(&on_edges, edge).map(|part| (part, m)));
        }
    }
    uses.sort_unstable();
    let mut sets = Sets::new(members.len());
    for uses in uses.chunk_by(|a, b| a.0 == b.0) {
        if let [(_, m), (_, n)] = uses {
            sets.join(*m, *n);
        }
    }
    let mut at: HashMap<usize, usize> = HashMap::default();
    let mut pieces: Vec<Vec<usize>> = Vec::new();
    for m in 0..members.len() {
        let piece = *at.entry(sets.find(m)).or_insert_with(|| {
            pieces.push(Vec::new());
            pieces.len() - 1
        });
        pieces[piece].push(m);
    }
    pieces
}
