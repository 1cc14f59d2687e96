//! Which triangles belong together at an edge that more than two of them use.
//!
//! There parts of an assembly touch, or a surface touches itself. Around the edge the triangles lie like the spokes of a wheel: each
//! opens a wedge of solid or closes one. A triangle that opens belongs to the one that closes *its* wedge, as brackets do. Where spokes
//! coincide (flush parts) or wedges overlap, many pairings are possible; then what is known to be one part comes first: triangles of
//! one named solid, then those already connected by other edges. So no shell depends on the order of a file where each triangle stands there once; of repeated
//! and turned ones the values do not, but their bounds may. A triangle and its exact reverse, between which there is nothing, are never joined.

use crate::geometry::repair::edges::{Use, ends};
use crate::geometry::repair::sets::Sets;
use crate::geometry::repair::weld::Indexed;
use glam::DVec3;
use rustc_hash::FxHashMap as HashMap;
use std::collections::VecDeque;

/// Spokes closer than this are one direction [rad]: below, single-precision files say nothing.
const SAME_DIRECTION: f64 = 1e-6;

/// How often the edges without a choice are visited before one with a choice is decided: connections found at one may leave another
/// without a choice. More visits would only decide fewer edges by their wedges.
const VISITS: usize = 8;

/// A triangle at an edge.
#[derive(Clone, Copy, Debug)]
struct Spoke {
    triangle: u32,
    /// Its third corner.
    apex: u32,
    /// Seen along the edge it begins a wedge of solid; else it ends one.
    opens: bool,
    /// Number of its direction around the edge; spokes in one direction share it.
    direction: u32,
}

/// All triangles at one edge: around it, and of one direction those first that end a wedge.
#[derive(Debug)]
struct Fan {
    edge: u64,
    spokes: Vec<Spoke>,
    joined: bool,
}

/// Which spokes of a fan belong together.
#[derive(Debug)]
struct Pairing {
    pairs: Vec<[usize; 2]>,
    /// Spokes that no other belongs to.
    alone: Vec<bool>,
    /// There was no choice.
    forced: bool,
    /// Wedges lay in each other: which belong together was a guess.
    guessed: bool,
}

impl Fan {
    fn new(mesh: &Indexed, edge: u64, uses: &[(u64, Use)]) -> Self {
        let [a, b] = ends(edge);
        let point = |v: u32| mesh.points[v as usize];
        let axis = (point(b) - point(a)).normalize_or_zero();
        let apex = |u: &Use| {
            let corners = mesh.triangles[u.triangle as usize];
            corners.into_iter().find(|&v| v != a && v != b).unwrap_or(corners[0])
        };
        // From the edge to the third corner.
        let across = |v: u32| {
            let d = point(v) - point(a);
            d - axis * d.dot(axis)
        };
        let first = uses.iter().map(|(_, u)| across(apex(u)).normalize_or_zero()).find(|&d| d != DVec3::ZERO);
        let (x, y) = (first.unwrap_or(DVec3::ZERO), axis.cross(first.unwrap_or(DVec3::ZERO)));
        let angle = |v: u32| {
            let d = across(v);
            let angle = d.dot(y).atan2(d.dot(x));
            if angle < -SAME_DIRECTION { angle + std::f64::consts::TAU } else { angle }
        };
        let spoke = |(_, u): &(u64, Use)| {
            let apex = apex(u);
            (angle(apex), Spoke { triangle: u.triangle, apex, opens: !u.up, direction: 0 })
        };
        let mut spokes: Vec<(f64, Spoke)> = uses.iter().map(spoke).collect();
        spokes.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut direction, mut begins) = (0, f64::NEG_INFINITY);
        for (angle, spoke) in &mut spokes {
            if *angle - begins > SAME_DIRECTION {
                (direction, begins) = (direction + 1, *angle);
            }
            spoke.direction = direction;
        }
        let mut spokes: Vec<Spoke> = spokes.into_iter().map(|(_, spoke)| spoke).collect();
        spokes.sort_by_key(|s| (s.direction, s.opens));
        Fan { edge, spokes, joined: false }
    }

    /// Pair the spokes still `alone` that bound a wedge of solid, by brackets, those of one class among themselves.
    fn brackets<C: Ord>(&self, class: impl Fn(usize) -> C, pairing: &mut Pairing) {
        let Pairing { pairs, alone, .. } = pairing;
        let mut members: Vec<(C, usize)> = (0..alone.len()).filter(|&n| alone[n]).map(|n| (class(n), n)).collect();
        members.sort();
        let mut open: Vec<usize> = Vec::new();
        for members in members.chunk_by(|a, b| a.0 == b.0) {
            open.clear();
            // Once around finds the wedges within, once more that which holds the beginning.
            for turn in 0..2 {
                for &(_, n) in members {
                    if !alone[n] {
                        continue;
                    }
                    if self.spokes[n].opens {
                        if turn == 0 {
                            open.push(n);
                        }
                    } else if let Some(&m) = open.last()
                        && self.spokes[m].direction != self.spokes[n].direction
                    {
                        open.pop();
                        (alone[m], alone[n]) = (false, false);
                        pairs.push([m, n]);
                    }
                }
            }
        }
    }

    /// Pair what lies folded in one direction and has no better partner, but no triangle with its exact reverse.
    fn folds(&self, pairing: &mut Pairing) {
        let Pairing { pairs, alone, .. } = pairing;
        let ends: Vec<usize> = (0..alone.len()).filter(|&n| alone[n] && !self.spokes[n].opens).collect();
        for n in ends {
            let a = &self.spokes[n];
            let fits = |m: &usize| alone[*m] && self.spokes[*m].opens && a.apex != self.spokes[*m].apex;
            // Spokes are in the order of directions.
            let first = self.spokes.partition_point(|b| b.direction < a.direction);
            let count = self.spokes[first..].partition_point(|b| b.direction == a.direction);
            if let Some(m) = (first..first + count).find(fits) {
                (alone[m], alone[n]) = (false, false);
                pairs.push([m, n]);
            }
        }
    }

    /// How many wedges of those spokes lie in each other, at most.
    fn depth(&self, spokes: &[bool]) -> i32 {
        let (mut depth, mut least, mut most) = (0, 0, 0);
        for (spoke, _) in self.spokes.iter().zip(spokes).filter(|(_, wanted)| **wanted) {
            depth += if spoke.opens { 1 } else { -1 };
            (least, most) = (depth.min(least), depth.max(most));
        }
        most - least
    }

    fn pairing(&self, sets: &mut Sets, solid_of: &impl Fn(u32) -> usize) -> Pairing {
        let known = |s: &Spoke| (solid_of(s.triangle), sets.find(s.triangle as usize));
        let known: Vec<(usize, usize)> = self.spokes.iter().map(known).collect();
        let mut pairing = Pairing { pairs: Vec::new(), alone: vec![true; known.len()], forced: false, guessed: false };
        self.brackets(|n| known[n], &mut pairing);
        let left = |opens: bool| {
            let alone = self.spokes.iter().zip(&pairing.alone).filter(|(s, alone)| **alone && s.opens == opens);
            alone.count()
        };
        pairing.forced = left(true) <= 1 && left(false) <= 1;
        pairing.guessed = self.depth(&pairing.alone) > 1;
        self.brackets(|n| known[n].0, &mut pairing);
        self.brackets(|n| known[n].1, &mut pairing);
        self.brackets(|_| (), &mut pairing);
        self.folds(&mut pairing);
        pairing
    }

    /// Join what belongs together, and note the rest.
    fn join(&mut self, pairing: &Pairing, sets: &mut Sets, joined: &mut Joined) {
        self.joined = true;
        if pairing.guessed {
            joined.guessed.extend(self.spokes.windows(2).map(|w| [w[0].triangle, w[1].triangle]));
        }
        for &[m, n] in &pairing.pairs {
            sets.join(self.spokes[m].triangle as usize, self.spokes[n].triangle as usize);
        }
        let alone = self.spokes.iter().zip(&pairing.alone).filter(|(_, alone)| **alone);
        joined.lonely.extend(alone.map(|(s, _)| (s.triangle, self.edge)));
    }
}

/// What is left to know after triangles have been joined.
#[derive(Debug, Default)]
pub struct Joined {
    /// Uses of edges without a partner, as triangle and edge.
    pub lonely: Vec<(u32, u64)>,
    /// Triangles that may as well belong to each other's shells.
    pub guessed: Vec<[u32; 2]>,
}

/// Join the triangles at some edges into `sets`, which hold those connected already.
pub fn join<'a>(
    mesh: &Indexed,
    edges: impl Iterator<Item = &'a [(u64, Use)]>,
    sets: &mut Sets,
    solid_of: impl Fn(u32) -> usize,
) -> Joined {
    let mut joined = Joined::default();
    let mut fans: Vec<Fan> = edges.map(|uses| Fan::new(mesh, uses[0].0, uses)).collect();
    for _ in 0..VISITS {
        let mut found = false;
        for fan in fans.iter_mut().filter(|f| !f.joined) {
            let pairing = fan.pairing(sets, &solid_of);
            if pairing.forced {
                fan.join(&pairing, sets, &mut joined);
                found = true;
            }
        }
        if !found {
            break;
        }
    }
    let mut around: HashMap<u32, Vec<usize>> = HashMap::default();
    for (f, fan) in fans.iter().enumerate().filter(|(_, f)| !f.joined) {
        fan.spokes.iter().for_each(|s| around.entry(s.triangle).or_default().push(f));
    }
    // Neighbours in turn, so that of several equal ways the one taken goes on; guesses last.
    for may_guess in [false, true] {
        let mut queue = VecDeque::new();
        for first in 0..fans.len() {
            queue.push_back(first);
            while let Some(f) = queue.pop_front() {
                if fans[f].joined {
                    continue;
                }
                let pairing = fans[f].pairing(sets, &solid_of);
                if pairing.guessed && !may_guess {
                    continue;
                }
                fans[f].join(&pairing, sets, &mut joined);
                let next = fans[f].spokes.iter().filter_map(|s| around.get(&s.triangle)).flatten();
                queue.extend(next.filter(|&&g| !fans[g].joined));
            }
        }
    }
    joined
}
