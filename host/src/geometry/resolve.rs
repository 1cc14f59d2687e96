//! Shells that cross themselves, or whose triangles may belong to one another, become the surface of what is solid.

use crate::geometry::diagnosis::{Diagnosis, Reporter, show};
use crate::geometry::repair::crossing::{self, Found};
use crate::geometry::repair::nesting::{Closed, Doubt};
use crate::geometry::repair::regions::{self, Regions};
use glam::DVec3;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// A closed shell on its way to a body.
pub(super) struct Part {
    pub name: String,
    pub shell: Closed,
    /// As those of [`crate::geometry::repair::shells::Shell`].
    pub cluster: usize,
    pub guessed: bool,
    /// So many of its triangles are its own; what follows are caps.
    pub own: usize,
}

impl Part {
    /// Its triangles without caps.
    fn own(&self) -> &[[DVec3; 3]] {
        &self.shell.triangles[..self.own]
    }

    /// It winds once around what it holds, and looks outward.
    fn is_simple(&self, seen: &Seen) -> bool {
        matches!(seen, Seen::As(Found::Simple)) && self.shell.volume > 0.0 && !self.shell.is_sheet()
    }
}

/// What was found of a part, or of several together.
enum Seen {
    /// By how it winds.
    As(Found),
    /// By its regions.
    Divided(Regions),
}

fn look(shell: &Closed) -> Found {
    if shell.is_sheet() { Found::Simple } else { crossing::look(&shell.triangles, shell.bounds) }
}

/// The regions of a surface.
fn divided(own: &[[DVec3; 3]], bounds: [DVec3; 2], file: &[[DVec3; 3]]) -> Option<Seen> {
    regions::look(own, bounds, file).map(Seen::Divided)
}

fn look_at_one(part: &Part, file: &[[DVec3; 3]]) -> Seen {
    match look(&part.shell) {
        // Which of several parts that were joined is turned cannot be told.
        Found::Resolved(made) if made.touches && !part.guessed => {
            divided(part.own(), part.shell.bounds, file).unwrap_or(Seen::As(Found::Doubtful(made.place)))
        }
        Found::Doubtful(place) if !part.guessed => {
            divided(part.own(), part.shell.bounds, file).unwrap_or(Seen::As(Found::Doubtful(place)))
        }
        seen => Seen::As(seen),
    }
}

/// What parts are together that overlap where they share edges; and all their triangles. None if each by itself is simple.
fn look_at_all(members: &[usize], parts: &[Part], seen: &[Seen], file: &[[DVec3; 3]]) -> Option<(Closed, Seen)> {
    let capped = members.iter().any(|&n| parts[n].own < parts[n].shell.triangles.len());
    if !capped && members.iter().all(|&n| parts[n].is_simple(&seen[n])) {
        return None;
    }
    let whole = Closed::new(members.iter().flat_map(|&n| parts[n].shell.triangles.iter().copied()).collect());
    let own: Vec<[DVec3; 3]> = members.iter().flat_map(|&n| parts[n].own().iter().copied()).collect();
    // Winding numbers alone do not tell a cavity from a part that another covers.
    let seen = divided(&own, whole.bounds, file).unwrap_or(Seen::As(Found::Doubtful(whole.bounds[0])));
    Some((whole, seen))
}

/// Make every surface that crosses itself the surface of what it winds around; and parts that overlap where they share edges the
/// surface of their regions, unless each by itself is simple. `file` is all
/// triangles as they were read.
pub(super) fn resolve(parts: Vec<Part>, file: &[[DVec3; 3]], d: &mut Diagnosis, report: &mut Reporter) -> Vec<Part> {
    let mut parts = parts;
    let mut seen: Vec<Seen> = parts.par_iter().map(|part| look_at_one(part, file)).collect();
    let mut clusters: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (n, part) in parts.iter().enumerate().filter(|(_, p)| p.guessed) {
        clusters.entry(part.cluster).or_default().push(n);
    }
    let clusters: Vec<Vec<usize>> = clusters.into_values().collect();
    let together: Vec<_> = clusters.par_iter().map(|members| look_at_all(members, &parts, &seen, file)).collect();
    let mut gone = vec![false; parts.len()];
    for (members, found) in clusters.iter().zip(together) {
        let Some((whole, all)) = found else { continue };
        members[1..].iter().for_each(|&n| gone[n] = true);
        (parts[members[0]].shell, seen[members[0]]) = (whole, all);
    }
    let mut places = Places::default();
    let mut resolved = Vec::new();
    for ((part, seen), _) in parts.into_iter().zip(seen).zip(gone).filter(|(_, gone)| !gone) {
        take(part, seen, &mut resolved, d, &mut places);
    }
    places.say(d, report);
    resolved
}

/// The first place of each kind.
#[derive(Default)]
struct Places {
    resolved: Option<DVec3>,
    perhaps: Option<DVec3>,
    unknown: Option<DVec3>,
}

/// Put what was found in the place of a part.
fn take(mut part: Part, seen: Seen, into: &mut Vec<Part>, d: &mut Diagnosis, places: &mut Places) {
    match seen {
        Seen::As(Found::Simple) => {}
        Seen::As(Found::Resolved(made)) => {
            part.shell = Closed::of_parts(made.surface);
            d.crossing += 1;
            places.resolved.get_or_insert(made.place);
        }
        Seen::As(Found::Doubtful(place)) => {
            part.shell.doubt = Doubt::Unknown;
            d.crossing += 1;
            d.doubtful += 1;
            places.unknown.get_or_insert(place);
        }
        Seen::Divided(Regions { solid, perhaps, backs }) => {
            d.doubled += backs;
            if !perhaps.is_empty() {
                let shell = Closed { doubt: Doubt::Perhaps, ..Closed::of_parts(perhaps) };
                places.perhaps.get_or_insert(shell.bounds[0]);
                d.doubtful += 1;
                d.crossing += 1;
                into.push(Part { name: part.name.clone(), own: shell.triangles.len(), shell, ..part });
            }
            part.shell = Closed::of_parts(solid);
        }
    }
    into.push(part);
}

impl Places {
    fn say(&self, d: &Diagnosis, report: &mut Reporter) {
        if let Some(place) = self.resolved {
            report.warn(format!(
                "{} surfaces cross themselves (the first near {}); what they wind around counts once",
                d.crossing - d.doubtful,
                show(place)
            ));
        }
        if let Some(place) = self.perhaps {
            report.warn(format!(
                "parts touch so that it cannot be told whether what they enclose is solid or open (the first such place near {}); it is taken as solid, and bounds hold both",
                show(place)
            ));
        }
        if let Some(place) = self.unknown {
            report.warn(format!(
                "{} surfaces cross themselves (the first near {}) so that what they hold cannot be told; they are measured as they wind, and the bounds of all cells within their boxes are 0 and 1",
                d.doubtful,
                show(place)
            ));
        }
    }
}
