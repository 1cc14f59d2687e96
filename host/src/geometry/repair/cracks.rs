//! Cracks: edges without partners whose ends lie so close to those of others that they are meant to be one.

use crate::geometry::repair::edges::{EdgeUses, balance, ends, key};
use crate::geometry::repair::weld::{Indexed, bits, close_points};
use glam::DVec3;
use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};

/// How wide cracks may be, in units of the rounding of corners: by rounding alone, and then wider in steps up to 0.03 mm to a metre.
const WIDTHS: [f64; 3] = [1.0, 8.0, 64.0];

/// What closing cracks has moved.
#[derive(Debug, Default)]
pub struct Cracks {
    /// By how much at most; 0 if nothing was moved.
    pub moved: f64,
    /// Where points are now that were moved by more than the rounding of corners, or that others were moved to by as much: bits of coordinates.
    wide: HashSet<[u64; 3]>,
}

impl Cracks {
    /// By how much corners of these triangles may be off because cracks wider than rounding were closed; 0 if there were none.
    pub fn rounding(&self, triangles: &[[DVec3; 3]]) -> f64 {
        let is_moved = |p: &DVec3| self.wide.contains(&bits(*p));
        let any = !self.wide.is_empty() && triangles.iter().flatten().any(is_moved);
        if any { self.moved } else { 0.0 }
    }
}

/// Merges points close to each other where edges of `alive` triangles find their partners by it, and no others; narrow cracks before wider ones.
/// `uses` are those of the edges, before and after. Corners may be off by `rounding`.
pub fn close(mesh: &mut Indexed, alive: &[bool], uses: &mut EdgeUses, rounding: f64) -> Cracks {
    let mut cracks = Cracks::default();
    for width in WIDTHS.map(|width| width * rounding) {
        if uses.unmatched() == 0 {
            break;
        }
        let loose = uses.unmatched_points(mesh.points.len());
        let close = close_points(mesh, alive, &loose, width);
        if moves(&close).next().is_none() {
            continue;
        }
        let target = only_where_edges_meet(mesh, alive, uses, close);
        let mut most = 0.0_f64;
        for (v, to) in moves(&target) {
            let by = mesh.points[v].distance(mesh.points[to]);
            most = most.max(by);
            if by > rounding {
                cracks.wide.insert(bits(mesh.points[to]));
            }
        }
        // A point may move again with the next width.
        cracks.moved += most;
        renumber(mesh, &target);
        *uses = EdgeUses::new(mesh, alive);
    }
    cracks
}

/// Points that move, with the points that they move to.
fn moves(target: &[u32]) -> impl Iterator<Item = (usize, usize)> {
    target.iter().enumerate().map(|(v, &to)| (v, to as usize)).filter(|(v, to)| v != to)
}

fn renumber(mesh: &mut Indexed, target: &[u32]) {
    for t in &mut mesh.triangles {
        *t = t.map(|v| target[v as usize]);
    }
}

/// Of points that each would move to their `target`, leave those where they are that end no edge that finds a partner by it.
fn only_where_edges_meet(mesh: &Indexed, alive: &[bool], uses: &EdgeUses, target: Vec<u32>) -> Vec<u32> {
    let mut merged = mesh.clone();
    renumber(&mut merged, &target);
    let mut loose: HashMap<u64, u64> = HashMap::default();
    for edge in uses.each().filter(|edge| balance(edge) != 0) {
        let [a, b] = ends(edge[0].0).map(|v| target[v as usize]);
        *loose.entry(key(a, b)).or_default() += balance(edge).unsigned_abs();
    }
    let mut meets = vec![false; mesh.points.len()];
    for edge in EdgeUses::new(&merged, alive).each() {
        let before = loose.get(&edge[0].0).copied().unwrap_or(0);
        if balance(edge).unsigned_abs() < before {
            ends(edge[0].0).into_iter().for_each(|v| meets[v as usize] = true);
        }
    }
    target.into_iter().enumerate().map(|(v, to)| if meets[to as usize] { to } else { v as u32 }).collect()
}
