//! Which closed shells are bodies and which are cavities.
//!
//! A shell inside another and of opposite orientation is a cavity of it (or, inside a cavity, an island). A shell of the same
//! orientation as its container is a body of its own, as is a shell inside nothing, whichever way round it is.
//!
//! **Whose cavity.** Bodies may cross, and then a cavity lies in several of them. Where each cavity lies in its body and no two of one body overlap, a body
//! winds 0 or 1 times around every point, and all bodies together as often as there are bodies there: so often as all shells do, whichever are matched.
//! Any such matching gives one solid, and only such a matching is taken, if there is one ([`crate::geometry::repair::rooms`]). Where there is none, or one
//! that goes against the names in the file, several readings differ, and what overlaps is in doubt.

use crate::geometry::diagnosis::{Reporter, show};
use crate::geometry::repair::closed::{Closed, Doubt, beside};
use crate::geometry::repair::overlap::contains;
use crate::geometry::repair::rooms::{Role, Rooms};
use crate::geometry::repair::tree::Tree;
use crate::words::{counted, either};
use glam::DVec3;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// What shells are to each other.
#[derive(Debug)]
pub struct Nesting {
    /// The role of every shell. Sheets are bodies, and so is what is doubtful.
    pub roles: Vec<Role>,
    /// Shells with two sides in others with two sides, each a room of one of these or a part.
    pub either: Vec<usize>,
    /// For bodies that are not among them, the largest of them that lie in it.
    pub either_in: Vec<(usize, usize)>,
    /// Bodies, and boxes in which it is not known which of several bodies has a cavity.
    pub unclear: Vec<(usize, [DVec3; 2])>,
    /// Bodies that lie for the most part, not wholly, in larger ones of the opposite orientation, in ascending order: perhaps rooms whose walls they break through.
    pub breaking: Vec<usize>,
}

/// What shells with these names are to each other.
#[must_use]
pub fn nest(shells: &[Closed], names: &[String]) -> Nesting {
    let sign = |s: usize| shells[s].volume > 0.0;
    let mut order: Vec<usize> =
        (0..shells.len()).filter(|&s| !shells[s].is_sheet() && shells[s].doubt == Doubt::None).collect();
    let is_mixed = order.iter().any(|&s| sign(s)) && !order.iter().all(|&s| sign(s));
    order.sort_by(|&a, &b| shells[b].volume.abs().total_cmp(&shells[a].volume.abs()));
    let mut rooms = Rooms::new(shells, names, &order);
    for &s in order.iter().filter(|_| is_mixed) {
        // The smallest container is the nearest.
        let Some(nearest) = rooms.around(s).find(|&p| contains(&shells[p], &shells[s])) else { continue };
        match (sign(nearest) == sign(s), rooms.is_cavity(nearest)) {
            (false, false) => rooms.give(s, nearest),
            // In a room of one body it may be a room of another that crosses the first.
            (true, true) => {
                rooms.give_if_free(s);
            }
            (true, false) | (false, true) => {}
        }
    }
    let around = around_two_sided(shells, &order, &rooms);
    let either: Vec<usize> = around.keys().copied().collect();
    let is_largest = |inner: usize, outer: usize| {
        let is_between = |other: &usize| around.get(other).is_some_and(|around| around.contains(&outer));
        !around.contains_key(&outer) && !around[&inner].iter().any(is_between)
    };
    let pairs = either.iter().flat_map(|&inner| around[&inner].iter().map(move |&outer| (outer, inner)));
    let either_in = pairs.filter(|&(outer, inner)| is_largest(inner, outer)).collect();
    let (roles, unclear) = rooms.told();
    let breaking = if is_mixed { breaking(shells, &order, &roles) } else { Vec::new() };
    Nesting { roles, either, either_in, unclear, breaking }
}

/// A room may break through its walls with less than the rest of its surface.
const MOSTLY: f64 = 2.0 / 3.0;

/// So many triangles of a shell, the largest, tell how much of it lies in others.
const LARGEST: usize = 64;

/// Bodies of which more than two thirds of the surface lie in larger bodies of the opposite orientation: were it all, they would be cavities.
fn breaking(shells: &[Closed], order: &[usize], roles: &[Role]) -> Vec<usize> {
    let mut bodies: Vec<usize> = order.iter().copied().filter(|&s| roles[s] == Role::Body).collect();
    bodies.sort_unstable();
    let tree = Tree::of_boxes(bodies.iter().map(|&s| shells[s].bounds), None);
    let is_breaking = |s: &usize| {
        let shell = &shells[*s];
        let mut around = Vec::new();
        tree.touching(shell.bounds, |n| {
            let other = &shells[bodies[n as usize]];
            let is_opposite = (other.volume > 0.0) != (shell.volume > 0.0);
            if is_opposite && other.volume.abs() > shell.volume.abs() && other.overlaps(shell) {
                around.push(other);
            }
        });
        if around.is_empty() {
            return false;
        }
        let area = |[a, b, c]: &[DVec3; 3]| (b - a).cross(c - a).length();
        let mut largest: Vec<(f64, &[DVec3; 3])> = shell.triangles.iter().map(|t| (area(t), t)).collect();
        largest.sort_by(|a, b| b.0.total_cmp(&a.0));
        let (mut within, mut all) = (0.0, 0.0);
        for (area, triangle) in largest.into_iter().take(LARGEST) {
            let middle = (triangle[0] + triangle[1] + triangle[2]) / 3.0;
            // Of the triangle's quarters.
            for at in [middle, triangle[0], triangle[1], triangle[2]].map(|p| middle.midpoint(p)) {
                let Some(point) = beside(triangle, at, shell.volume) else { continue };
                all += area;
                within += if around.iter().any(|other| other.winds_around(point)) { area } else { 0.0 };
            }
        }
        MOSTLY * all < within
    };
    bodies.par_iter().copied().filter(is_breaking).collect()
}

impl Nesting {
    /// Tell of what may be a room or a part, and of rooms that may be of one body or another.
    pub(in crate::geometry) fn say_doubts(&self, shells: &[Closed], report: &mut Reporter) {
        let volume = |s: &usize| shells[*s].volume.abs();
        let largest = |some: &[usize]| {
            let largest = some.iter().max_by(|a, b| volume(a).total_cmp(&volume(b)))?;
            let [lo, hi] = shells[*largest].bounds.map(show);
            Some(format!("the largest from {lo} to {hi}, {:.6e} m³", volume(largest)))
        };
        let taken = |count| (either(count, "it is", "each is"), either(count, "it is", "they are"));
        if let Some(largest) = largest(&self.breaking) {
            let count = self.breaking.len();
            let (it, they) = taken(count);
            report.warn(format!(
                "{} for the most part in others that look the other way, and {} through their surface ({largest}): \
                 nothing tells whether {it} a room or a part; {they} taken as solid, and the bounds of all cells in the box are 0 and 1. A room must lie wholly in its body, or be one shell with it",
                counted(count, "body lies", "bodies lie"),
                either(count, "breaks", "break"),
            ));
        }
        if let Some(largest) = largest(&self.either) {
            let count = self.either.len();
            let (it, they) = taken(count);
            report.warn(format!(
                "{} ({largest}): nothing tells whether {it} a room or a part; {they} taken as solid, and bounds hold both. \
                 For a room, write one side of each surface: outer ones looking outward, rooms inward",
                counted(
                    count,
                    "closed surface with two sides lies within another with two sides",
                    "closed surfaces with two sides lie within others with two sides"
                ),
            ));
        }
        if let Some((_, [lo, hi])) = self.unclear.first() {
            report.warn(format!(
                "cavities overlap within several bodies (the first from {} to {}), and nothing tells which of them is whose: what is solid there cannot be told, and the bounds there are wide",
                show(*lo),
                show(*hi)
            ));
        }
    }
}

/// For shells with two sides those with two sides that hold them, unless a cavity of these does.
fn around_two_sided(shells: &[Closed], order: &[usize], rooms: &Rooms<'_>) -> BTreeMap<usize, Vec<usize>> {
    let two_sided: Vec<usize> = order.iter().copied().filter(|&s| shells[s].two_sided && !rooms.is_cavity(s)).collect();
    let around = |s: usize| -> Vec<usize> {
        let inner = &shells[s];
        let is_in_room_of = |outer: usize| rooms.of(outer).iter().any(|&room| contains(&shells[room], inner));
        let is_one = |outer: &usize| shells[*outer].two_sided && !rooms.is_cavity(*outer);
        let holds = |outer: &usize| is_one(outer) && contains(&shells[*outer], inner) && !is_in_room_of(*outer);
        let mut found: Vec<usize> = rooms.around(s).filter(holds).collect();
        // The largest first.
        found.reverse();
        found
    };
    let all = two_sided.par_iter().map(|&s| (s, around(s)));
    all.filter(|(_, around)| !around.is_empty()).collect()
}
