//! Which body a cavity belongs to where several hold it.
//!
//! A cavity goes to the smallest body that holds it, of its own named solid if there is one, and in which it overlaps no other cavity. If all are taken,
//! others move on to bodies that hold them, too, until every one has its place; if there is no such order, it stays with the first, and all of them are in
//! doubt.

use crate::geometry::repair::closed::Closed;
use crate::geometry::repair::overlap::{contains, overlap};
use crate::geometry::repair::tree::Tree;
use glam::DVec3;
use rustc_hash::FxHashMap as HashMap;

/// Part of a shell's triangles in the final bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// A body of its own.
    Body,
    /// A cavity in the body that is shell `.0`.
    CavityOf(usize),
}

/// So many places are tried for a cavity and those that it moves.
const TRIES: usize = 2000;

/// Shells, and the bodies that they are cavities of.
pub struct Rooms<'a> {
    shells: &'a [Closed],
    names: &'a [String],
    /// All that may be bodies or cavities, by size, and where a shell stands among them.
    order: &'a [usize],
    rank: Vec<usize>,
    owner: Vec<Option<usize>>,
    /// The cavities of each body.
    of: Vec<Vec<usize>>,
    /// The bodies that hold a cavity, where that was asked.
    hosts: HashMap<usize, Vec<usize>>,
    overlaps: HashMap<[usize; 2], bool>,
    unclear: Vec<(usize, [DVec3; 2])>,
    /// Of boxes in the order of size.
    tree: Tree,
}

impl<'a> Rooms<'a> {
    /// Shells with names, in the order of their size; none is a cavity.
    #[must_use]
    pub fn new(shells: &'a [Closed], names: &'a [String], order: &'a [usize]) -> Self {
        let mut rank = vec![0; shells.len()];
        order.iter().enumerate().for_each(|(n, &s)| rank[s] = n);
        Rooms {
            order,
            rank,
            shells,
            names,
            owner: vec![None; shells.len()],
            of: vec![Vec::new(); shells.len()],
            hosts: HashMap::default(),
            overlaps: HashMap::default(),
            unclear: Vec::new(),
            tree: Tree::of_boxes(order.iter().map(|&s| shells[s].bounds), None),
        }
    }

    /// The shells not smaller than one whose boxes touch its own, the smallest first.
    pub fn around(&self, s: usize) -> impl Iterator<Item = usize> {
        let mut found = Vec::new();
        self.tree.touching(self.shells[s].bounds, |rank| {
            if (rank as usize) < self.rank[s] {
                found.push(rank as usize);
            }
        });
        found.sort_unstable();
        found.into_iter().rev().map(|rank| self.order[rank])
    }

    /// Is a shell a cavity?
    #[must_use]
    pub fn is_cavity(&self, s: usize) -> bool {
        self.owner[s].is_some()
    }

    /// The cavities of a body.
    #[must_use]
    pub fn of(&self, body: usize) -> &[usize] {
        &self.of[body]
    }

    /// Make a shell a cavity of the body `nearest`, the smallest that holds it, or of another. All larger shells have their roles.
    pub fn give(&mut self, s: usize, nearest: usize) {
        // All cavities so far are larger.
        let may_overlap =
            |other: usize| self.owner[other] == Some(nearest) && self.shells[other].overlaps(&self.shells[s]);
        if self.names[nearest] == self.names[s] && !self.around(s).any(may_overlap) {
            return self.put(s, nearest);
        }
        let hosts = self.hosts(s);
        if self.has_choice(s) && self.give_if_free(s) {
            return;
        }
        let first = hosts.first().copied().unwrap_or(nearest);
        let beside = self.beside(s, &hosts);
        if hosts.len() > 1 || beside.iter().any(|&k| self.hosts(k).len() > 1) {
            let all = beside.iter().map(|&k| self.shells[k].bounds);
            let around = all.fold(self.shells[s].bounds, |[a, b], [c, d]| [a.min(c), b.max(d)]);
            self.unclear.push((first, around));
        }
        self.put(s, first);
    }

    /// Make a shell a cavity of a body in which it overlaps no other cavity, be it that others move. Returns whether there is one.
    pub fn give_if_free(&mut self, s: usize) -> bool {
        let mut tries = TRIES;
        self.settle(vec![s], &mut Vec::new(), &mut tries)
    }

    /// The role of every shell; and boxes in which bodies are in doubt.
    #[must_use]
    pub fn told(mut self) -> (Vec<Role>, Vec<(usize, [DVec3; 2])>) {
        let mut asked: Vec<usize> = self.hosts.keys().copied().collect();
        asked.sort_unstable();
        for s in asked {
            let Some(owner) = self.owner[s] else { continue };
            let is_of_own_solid = |&host: &usize| self.names[host] == self.names[s];
            if !is_of_own_solid(&owner) && self.hosts[&s].iter().any(is_of_own_solid) {
                self.unclear.push((owner, self.shells[s].bounds));
            }
        }
        let roles = self.owner.iter().map(|owner| owner.map_or(Role::Body, Role::CavityOf)).collect();
        (roles, self.unclear)
    }

    fn put(&mut self, s: usize, body: usize) {
        self.owner[s] = Some(body);
        self.of[body].push(s);
    }

    fn take(&mut self, s: usize) {
        if let Some(body) = self.owner[s].take() {
            self.of[body].retain(|&other| other != s);
        }
    }

    /// Gives places to some shells that have none, moving others but those `settled`. Changes nothing if that is not possible.
    fn settle(&mut self, mut shells: Vec<usize>, settled: &mut Vec<usize>, tries: &mut usize) -> bool {
        let Some(s) = shells.pop() else { return true };
        let hosts = self.hosts(s);
        let mut places: Vec<(usize, Vec<usize>)> = hosts.iter().map(|&host| (host, self.beside(s, &[host]))).collect();
        // What is free comes first.
        places.sort_by_key(|(_, moved)| !moved.is_empty());
        for (host, moved) in places {
            if *tries == 0 {
                return false;
            }
            *tries -= 1;
            if moved.iter().any(|k| settled.contains(k)) {
                continue;
            }
            moved.iter().for_each(|&k| self.take(k));
            self.put(s, host);
            settled.push(s);
            if self.settle([&shells[..], &moved].concat(), settled, tries) {
                return true;
            }
            settled.pop();
            self.take(s);
            moved.iter().for_each(|&k| self.put(k, host));
        }
        false
    }

    /// The bodies of the other orientation that hold a shell: first those of its own solid, then the smaller ones.
    fn hosts(&mut self, s: usize) -> Vec<usize> {
        if let Some(hosts) = self.hosts.get(&s) {
            return hosts.clone();
        }
        let shells = self.shells;
        let looks_the_other_way = |p: usize| (shells[p].volume > 0.0) != (shells[s].volume > 0.0);
        let is_host = |&p: &usize| looks_the_other_way(p) && !self.is_cavity(p) && contains(&shells[p], &shells[s]);
        let mut hosts: Vec<usize> = self.around(s).filter(is_host).collect();
        hosts.sort_by_key(|&p| self.names[p] != self.names[s]);
        self.hosts.insert(s, hosts.clone());
        hosts
    }

    /// Is there more than one body for a shell, or for a cavity that it may overlap?
    fn has_choice(&mut self, s: usize) -> bool {
        let hosts = self.hosts(s);
        let shells = self.shells;
        let near = |&k: &usize| k != s && shells[k].overlaps(&shells[s]);
        let beside: Vec<usize> = hosts.iter().flat_map(|&host| self.of[host].iter().copied()).filter(near).collect();
        hosts.len() > 1 || beside.into_iter().any(|k| self.hosts(k).len() > 1)
    }

    fn overlap(&mut self, a: usize, b: usize) -> bool {
        let shells = self.shells;
        let mut told = || *self.overlaps.entry([a.min(b), a.max(b)]).or_insert_with(|| overlap(&shells[a], &shells[b]));
        shells[a].overlaps(&shells[b]) && told()
    }

    /// The cavities of some bodies that a shell overlaps.
    fn beside(&mut self, s: usize, hosts: &[usize]) -> Vec<usize> {
        let all: Vec<usize> = hosts.iter().flat_map(|&host| self.of[host].iter().copied()).collect();
        all.into_iter().filter(|&other| other != s && self.overlap(s, other)).collect()
    }
}
