//! Triangles to shells: which belong together, which way round, and where the surface is open.
//!
//! Two triangles are neighbours across an edge that only they use; they should run it in opposite directions, and a minority of
//! triangles that do not is turned. Edges used more often are the matter of [`crate::geometry::repair::join`].

use crate::geometry::repair::edges::{EdgeUses, Use, key};
use crate::geometry::repair::join::{Joined, join};
use crate::geometry::repair::sets::Sets;
use crate::geometry::repair::weld::{Indexed, edges_of};

/// A set of triangles connected through edges.
#[derive(Debug, Clone, Default)]
pub struct Shell {
    /// Positions in the mesh's triangle list, in file order.
    pub triangles: Vec<u32>,
    /// Directed edges without a partner.
    pub boundary: Vec<[u32; 2]>,
    /// Triangles that were turned to agree with the others.
    pub turned: usize,
    /// It cannot be oriented (as a Möbius strip).
    pub one_sided: bool,
    /// Shells that share a number overlap where they share edges: which triangles belong to which is a guess.
    pub cluster: usize,
    /// It is one of those, or overlaps itself so.
    pub guessed: bool,
    /// Every triangle was there from both sides.
    pub two_sided: bool,
}

/// Neighbours across edges. `same` tells that both run the edge the same way: one of them is the wrong way round.
struct Link {
    a: u32,
    b: u32,
    same: bool,
}

/// The two triangles of a plain edge, unless they are the same or each other's reverse.
fn plain(mesh: &Indexed, uses: &[(u64, Use)]) -> Option<Link> {
    let [(_, p), (_, q)] = uses else { return None };
    let apart = !mesh.are_same(p.triangle, q.triangle);
    apart.then_some(Link { a: p.triangle, b: q.triangle, same: p.up == q.up })
}

/// Split a mesh into shells and turn their triangles to agree with each other; `mesh` is changed where triangles turn. `edges`: those of the triangles that
/// are `alive`.
/// `solid_of` tells which named solid a triangle came from: at edges of many, a solid's triangles belong together.
pub fn shells(mesh: &mut Indexed, alive: &[bool], mut edges: EdgeUses, solid_of: impl Fn(u32) -> usize) -> Vec<Shell> {
    let count = mesh.triangles.len();
    let (mut links, mut many) = (Vec::with_capacity(3 * count / 2), Vec::new());
    edges.each().for_each(|uses| match plain(mesh, uses) {
        Some(link) => links.push(link),
        None => many.push(uses[0].0),
    });
    let mut sets = Sets::new(count);
    links.iter().for_each(|link| sets.join(link.a as usize, link.b as usize));
    let turned = orientations(count, &links);
    if turned.contains(&true) {
        let all = mesh.triangles.iter_mut().zip(&turned);
        all.filter(|&(_, &turned)| turned).for_each(|(t, _)| t.swap(1, 2));
        edges.turn(|n| turned[n as usize]);
    }
    let many = many.into_iter().map(|edge| edges.of(edge));
    let Joined { lonely, guessed } = join(mesh, many, &mut sets, |n| solid_of(mesh.source(n)));
    // Of the lowest triangle of each shell.
    let mut position = vec![usize::MAX; count];
    let mut shells: Vec<Shell> = Vec::new();
    for n in (0..count).filter(|&n| alive[n]) {
        let lowest = sets.find(n);
        if lowest == n {
            position[n] = shells.len();
            shells.push(Shell::default());
        }
        let at = position[lowest];
        shells[at].triangles.push(n as u32);
        shells[at].turned += usize::from(turned[n]);
    }
    for link in links.iter().filter(|l| (turned[l.a as usize] != turned[l.b as usize]) != l.same) {
        shells[position[sets.find(link.a as usize)]].one_sided = true;
    }
    for (n, edge) in lonely {
        let directed = edges_of(mesh.triangles[n as usize]).into_iter().find(|&[a, b]| key(a, b) == edge);
        shells[position[sets.find(n as usize)]].boundary.extend(directed);
    }
    let mut clusters = Sets::new(shells.len());
    for [a, b] in guessed {
        let [a, b] = [a, b].map(|n| position[sets.find(n as usize)]);
        (shells[a].guessed, shells[b].guessed) = (true, true);
        clusters.join(a, b);
    }
    shells.iter_mut().enumerate().for_each(|(s, shell)| shell.cluster = clusters.find(s));
    shells
}

/// Which triangles must turn: each connected set is flooded from its first triangle, and the minority turns.
fn orientations(count: usize, links: &[Link]) -> Vec<bool> {
    let mut first = vec![0_usize; count + 1];
    links.iter().flat_map(|l| [l.a, l.b]).for_each(|n| first[n as usize + 1] += 1);
    (0..count).for_each(|n| first[n + 1] += first[n]);
    let mut neighbours = vec![(0_u32, false); first[count]];
    let mut next = first.clone();
    for l in links {
        for (n, other) in [(l.a, l.b), (l.b, l.a)] {
            neighbours[next[n as usize]] = (other, l.same);
            next[n as usize] += 1;
        }
    }
    let (mut turned, mut seen) = (vec![false; count], vec![false; count]);
    let mut members = Vec::new();
    for root in 0..count {
        if seen[root] {
            continue;
        }
        seen[root] = true;
        members.clear();
        members.push(root);
        let mut next = 0;
        while let Some(&n) = members.get(next) {
            next += 1;
            for &(m, same) in &neighbours[first[n]..first[n + 1]] {
                let m = m as usize;
                if !seen[m] {
                    (seen[m], turned[m]) = (true, turned[n] != same);
                    members.push(m);
                }
            }
        }
        if 2 * members.iter().filter(|&&n| turned[n]).count() > members.len() {
            members.iter().for_each(|&n| turned[n] ^= true);
        }
    }
    turned
}
