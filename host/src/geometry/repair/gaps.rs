//! Open parts that nearly meet along their edges: perhaps a body whose corners were written too coarsely to be merged.

use crate::geometry::repair::closed::Closed;
use crate::geometry::repair::sets::Sets;
use crate::geometry::repair::weld::{Buckets, Indexed};
use glam::DVec3;

/// Two edges nearly meet if their ends are no farther apart than this share of the shorter one.
const NEAR: f64 = 0.03;

/// So much volume, in units of the area to the power 3/2, is more than that between two leaves that nearly meet along all their edges.
const MORE_THAN_LEAVES: f64 = 4e-3;

/// More edges than that beside one are no crack; they are not looked at, so that the time grows with the number of edges.
const CROWD: usize = 256;

/// An edge without a partner, and the part that it belongs to.
#[derive(Debug, Clone, Copy)]
pub struct Loose {
    /// The part's number.
    pub part: usize,
    /// From one vertex to the other.
    pub edge: [u32; 2],
}

/// Parts that may be one body.
#[derive(Debug, Clone)]
pub struct Gaping {
    /// Their numbers.
    pub parts: Vec<usize>,
    /// How far apart ends of edges are that nearly meet, at most.
    pub width: f64,
}

/// Groups of parts of whose loose edges at least half nearly meet another one.
#[must_use]
pub fn gaping(mesh: &Indexed, loose: &[Loose], parts: usize) -> Vec<Gaping> {
    let ends = |n: usize| loose[n].edge.map(|v| mesh.points[v as usize]);
    let length = |[a, b]: [DVec3; 2]| a.distance(b);
    let reach = |n: usize| NEAR * length(ends(n));
    let origin = mesh.points.iter().fold(DVec3::INFINITY, |a, p| a.min(*p));
    let mut buckets = Buckets::new(origin, (0..loose.len()).map(reach));
    let middle = |[a, b]: [DVec3; 2]| (a + b) * 0.5;
    (0..loose.len()).for_each(|n| buckets.add(n as u32, middle(ends(n)), reach(n)));
    let mut sets = Sets::new(parts);
    let mut meets = vec![None; loose.len()];
    for n in 0..loose.len() {
        let partner = |m: usize| {
            let touching = loose[m].edge.iter().any(|v| loose[n].edge.contains(v));
            if m == n || (touching && loose[m].part == loose[n].part) {
                return None;
            }
            let ([a, b], [c, d]) = (ends(n), ends(m));
            let apart = a.distance(d).max(b.distance(c)).min(a.distance(c).max(b.distance(d)));
            (apart <= reach(n).min(reach(m))).then_some((m, apart))
        };
        let found = buckets.near(middle(ends(n)), reach(n)).take(CROWD).filter_map(|m| partner(m as usize));
        let nearest = found.min_by(|(m, a), (n, b)| a.total_cmp(b).then(m.cmp(n)));
        if let Some((m, apart)) = nearest {
            sets.join(loose[n].part, loose[m].part);
            meets[n] = Some(apart);
        }
    }
    let mut counts = vec![(0_usize, 0_usize, 0.0_f64); parts];
    for (n, found) in meets.iter().enumerate() {
        let (all, met, width) = &mut counts[sets.find(loose[n].part)];
        *all += 1;
        *met += usize::from(found.is_some());
        *width = found.map_or(*width, |apart: f64| width.max(apart));
    }
    let of_set = |parts: Vec<usize>| {
        let (all, met, width) = counts[parts[0]];
        (met > 0 && 2 * met >= all).then_some(Gaping { parts, width })
    };
    sets.groups().into_iter().filter_map(of_set).collect()
}

/// Do some triangles hold more than leaves do that lie upon each other?
#[must_use]
pub fn holds_volume(whole: &Closed) -> bool {
    whole.volume.abs() > MORE_THAN_LEAVES * whole.area().powf(1.5)
}
