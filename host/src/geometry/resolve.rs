//! Shells that cross themselves, or whose triangles may belong to one another, become the surface of what is solid.

use crate::geometry::diagnosis::{Diagnosis, Reporter, show};
use crate::geometry::repair::closed::{Closed, Doubt, signed_volume};
use crate::geometry::repair::crossing::{self, Found};
use crate::geometry::repair::regions::{self, Regions, SourceTriangles, Unknown};
use crate::geometry::repair::sets::Sets;
use crate::geometry::repair::tree::Tree;
use crate::geometry::repair::weld::bits;
use crate::words::{counted, either};
use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashSet as HashSet;
use std::collections::BTreeMap;

/// A closed shell on its way to a body.
pub(super) struct Part {
    pub name: String,
    pub shell: Closed,
    /// As those of [`crate::geometry::repair::shells::Shell`].
    pub cluster: usize,
    pub guessed: bool,
    /// It was capped where other triangles end, in a surface some of which has two sides: they may close it.
    pub contested: bool,
    /// So many of its triangles are its own; what follows are caps.
    pub own: usize,
}

impl Part {
    /// Its triangles without caps.
    pub fn own(&self) -> &[[DVec3; 3]] {
        &self.shell.triangles[..self.own]
    }

    fn is_capped(&self) -> bool {
        self.own < self.shell.triangles.len()
    }

    /// It winds once around what it holds, forward or backward.
    fn is_simple(&self, seen: &Seen) -> bool {
        matches!(seen, Seen::As(Found::Simple { .. })) && self.shell.volume != 0.0 && !self.shell.is_sheet()
    }
}

/// What was found of a part, or of several together.
enum Seen {
    /// By how it winds.
    As(Found),
    /// By its regions.
    Divided(Regions),
}

/// For each triangle: is its exact reverse there, too?
fn have_backs(triangles: &[[DVec3; 3]]) -> impl Iterator<Item = bool> {
    let key = |t: &[DVec3; 3]| {
        let t = t.map(bits);
        let lowest = (0..3).min_by_key(|&i| t[i]).unwrap_or(0);
        [t[lowest], t[(lowest + 1) % 3], t[(lowest + 2) % 3]]
    };
    let all: HashSet<_> = triangles.iter().map(key).collect();
    // A triangle with two equal corners is its own reverse.
    let distinct = |[a, b, c]: [DVec3; 3]| a != b && b != c && c != a;
    triangles.iter().map(move |&[a, b, c]| distinct([a, b, c]) && all.contains(&key(&[a, c, b])))
}

/// Do triangles lie in the plane of the largest of them?
fn is_flat(triangles: &[[DVec3; 3]], on: f64) -> bool {
    let doubled = |[a, b, c]: &[DVec3; 3]| (b - a).cross(c - a);
    let largest = triangles.iter().max_by(|s, t| doubled(s).length().total_cmp(&doubled(t).length()));
    let Some((origin, normal)) = largest.map(|t| (t[0], doubled(t).normalize_or_zero())) else { return false };
    normal != DVec3::ZERO && triangles.iter().flatten().all(|p| (p - origin).dot(normal).abs() <= on)
}

fn untangle(shell: &Closed) -> Found {
    if !shell.is_sheet() {
        return crossing::untangle(&shell.triangles, shell.bounds);
    }
    if is_flat(&shell.triangles, crossing::tolerance(shell.bounds)) {
        return Found::Simple { walls: true };
    }
    // What winds forward in one place and backward in another may have no volume, either.
    match have_backs(&shell.triangles).all(|back| back) {
        true => Found::Simple { walls: true },
        false => match crossing::untangle(&shell.triangles, shell.bounds) {
            Found::Resolved(made) if made.both_ways => Found::Resolved(made),
            _ => Found::Simple { walls: true },
        },
    }
}

/// The regions of a surface. `mixed`: some of its parts look inward, others outward.
fn divided(own: &[[DVec3; 3]], bounds: [DVec3; 2], source: &SourceTriangles<'_>, mixed: bool) -> Option<Seen> {
    regions::arrangement(own, bounds, source, mixed).ok().map(Seen::Divided)
}

/// The volume of regions is larger than that of a shell if it is so by more than rounding.
const MORE: f64 = 1.0 + 1e-9;

/// What lies between the walls of a part that holds nothing elsewhere than what it winds around, as far as that tells. Two walls may have more between them than
/// the part winds around: then fronts and backs of parts that touch were joined to one shell.
fn between_walls(part: &Part, source: &SourceTriangles<'_>) -> Seen {
    let Closed { bounds: [lo, hi], volume, .. } = part.shell;
    let more = |r: &Regions| signed_volume(&r.solid, (lo + hi) * 0.5).abs() > MORE * volume.abs();
    match regions::arrangement(part.own(), [lo, hi], source, false) {
        Ok(regions) if more(&regions) => Seen::Divided(regions),
        Err(Unknown::Unclear) if have_backs(part.own()).any(|back| back) => Seen::As(Found::Doubtful(lo)),
        _ => Seen::As(Found::Simple { walls: true }),
    }
}

fn resolve_alone(part: &Part, source: &SourceTriangles<'_>) -> Seen {
    match untangle(&part.shell) {
        Found::Simple { walls: true } if !part.guessed => between_walls(part, source),
        // Which of several parts that were joined is turned cannot be told.
        Found::Resolved(made) if made.touches && !part.guessed => {
            divided(part.own(), part.shell.bounds, source, made.both_ways)
                .unwrap_or(Seen::As(Found::Doubtful(made.place)))
        }
        Found::Doubtful(place) if !part.guessed => {
            divided(part.own(), part.shell.bounds, source, false).unwrap_or(Seen::As(Found::Doubtful(place)))
        }
        seen => Seen::As(seen),
    }
}

/// Parts to be looked at together.
#[derive(Default)]
struct Group {
    members: Vec<usize>,
    /// Those members whose triangles may belong to other members.
    doubtful: Vec<usize>,
}

/// Signs that triangles were joined to the wrong shells. They say which other shells a shell is looked at together with.
#[derive(Clone, Copy, Default)]
struct Signs {
    /// Its cluster holds shells of both orientations: with all that overlap it.
    mixed: bool,
    /// It is folded, or was resolved, or is of a cluster with such a shell: with those in its box that look the other way.
    odd: bool,
    /// It winds forward and backward: if it is odd, with all in its box.
    both_ways: bool,
    /// It was capped in a mesh that has backs: with all whose boxes touch its own.
    capped: bool,
}

impl Signs {
    fn new(part: &Part, seen: &Seen, has_backs: bool) -> Self {
        let (odd, both_ways) = match seen {
            Seen::As(Found::Simple { walls }) => (*walls && !part.shell.is_sheet(), false),
            Seen::As(Found::Resolved(made)) => (true, made.both_ways),
            Seen::As(Found::Doubtful(_)) => (false, false),
            Seen::Divided(regions) => (true, !regions.perhaps.is_empty()),
        };
        Signs { mixed: false, odd, both_ways, capped: has_backs && part.is_capped() }
    }

    fn any(&self) -> bool {
        self.mixed || self.odd || self.capped
    }
}

/// Parts that must be looked at together.
struct Grouping<'a> {
    parts: &'a [Part],
    sets: Sets,
    grouped: Vec<bool>,
    doubtful: Vec<bool>,
}

impl<'a> Grouping<'a> {
    fn new(parts: &'a [Part]) -> Self {
        let none = vec![false; parts.len()];
        Grouping { parts, sets: Sets::new(parts.len()), grouped: none.clone(), doubtful: none }
    }

    fn volume(&self, n: usize) -> f64 {
        self.parts[n].shell.volume
    }

    fn join(&mut self, a: usize, b: usize) {
        (self.grouped[a], self.grouped[b]) = (true, true);
        self.sets.join(a, b);
    }

    fn by_edges(&mut self, signs: &mut [Signs]) {
        let mut clusters: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (n, part) in self.parts.iter().enumerate().filter(|(_, part)| part.guessed) {
            clusters.entry(part.cluster).or_default().push(n);
        }
        for n in (0..self.parts.len()).filter(|&n| self.parts[n].contested) {
            (self.doubtful[n], self.grouped[n]) = (true, true);
        }
        for members in clusters.values() {
            let forward = members.iter().filter(|&&n| self.volume(n) > 0.0).count();
            let odd = members.iter().any(|&n| signs[n].odd);
            for &n in members {
                self.doubtful[n] = true;
                self.join(members[0], n);
                signs[n].mixed = forward > 0 && forward < members.len();
                signs[n].odd = odd;
            }
        }
    }

    /// Joins a part that has signs of a doubt with another beside it.
    fn by_signs(&mut self, n: usize, of: Signs, other: usize) {
        let (own, beside) = (&self.parts[n].shell, &self.parts[other].shell);
        let within = own.is_around(beside) && own.overlaps(beside) && !beside.is_sheet();
        let against = of.both_ways || own.volume * beside.volume < 0.0;
        let holds = of.odd && within && against;
        if holds {
            (self.doubtful[n], self.doubtful[other]) = (true, true);
        }
        if holds || of.capped || (of.mixed && own.overlaps(beside)) {
            self.join(n, other);
        }
    }

    fn groups(mut self) -> Vec<Group> {
        let mut at: BTreeMap<usize, Group> = BTreeMap::new();
        for n in (0..self.parts.len()).filter(|&n| self.grouped[n]) {
            let group = at.entry(self.sets.find(n)).or_default();
            group.members.push(n);
            if self.doubtful[n] {
                group.doubtful.push(n);
            }
        }
        at.into_values().collect()
    }
}

fn groups(parts: &[Part], seen: &[Seen], source: &SourceTriangles<'_>) -> Vec<Group> {
    let has_backs = parts.iter().any(Part::is_capped) && have_backs(source.triangles()).any(|back| back);
    let mut signs: Vec<Signs> = parts.iter().zip(seen).map(|(part, seen)| Signs::new(part, seen, has_backs)).collect();
    let mut all = Grouping::new(parts);
    all.by_edges(&mut signs);
    if signs.iter().any(Signs::any) {
        let boxes: Vec<[DVec3; 3]> =
            parts.iter().map(|p| [p.shell.bounds[0], p.shell.bounds[1], p.shell.bounds[1]]).collect();
        Tree::new(&boxes).touching_pairs(|m, n| {
            for (m, n) in [(m as usize, n as usize), (n as usize, m as usize)] {
                if signs[m].any() {
                    all.by_signs(m, signs[m], n);
                }
            }
        });
    }
    all.groups()
}

/// What parts are together.
enum Together {
    /// Which they are, all their triangles, and what these hold.
    One(Vec<usize>, Closed, Seen),
    /// Which they are of whose triangles it cannot be told to whom they belong, and a box around all of them.
    Doubtful(Vec<usize>, [DVec3; 2]),
}

/// What parts are together. None if each by itself is simple and all look the same way, or nothing better can be told and none is doubtful.
fn resolve_together(group: &Group, parts: &[Part], seen: &[Seen], source: &SourceTriangles<'_>) -> Option<Together> {
    let positive = |&n: &usize| parts[n].shell.volume > 0.0;
    let simple = |members: &[usize]| {
        let alike = members.iter().all(positive) || !members.iter().any(positive);
        alike && members.iter().all(|&n| !parts[n].is_capped() && parts[n].is_simple(&seen[n]))
    };
    let whole = |members: &[usize]| Closed::together(members.iter().map(|&n| &parts[n].shell));
    // Winding numbers alone do not tell a cavity from a part that another covers.
    let by_regions = |members: &[usize]| {
        let own: Vec<[DVec3; 3]> = members.iter().flat_map(|&n| parts[n].own().iter().copied()).collect();
        let (whole, mixed) = (whole(members), !members.iter().all(positive));
        let seen = divided(&own, whole.bounds, source, mixed && members.iter().any(positive))?;
        Some(Together::One(members.to_vec(), whole, seen))
    };
    if simple(&group.members) {
        return None;
    }
    by_regions(&group.members).or_else(|| {
        if group.doubtful.is_empty() || simple(&group.doubtful) {
            return None;
        }
        let doubtful = || Together::Doubtful(group.doubtful.clone(), whole(&group.doubtful).bounds);
        let fewer = group.doubtful.len() < group.members.len();
        Some(fewer.then(|| by_regions(&group.doubtful)).flatten().unwrap_or_else(doubtful))
    })
}

/// Makes every surface that crosses itself the surface of what it winds around, and parts that overlap where they share edges the surface of
/// their regions, unless each by itself is simple. `known`: parts whose regions were told already, or cannot be told. `file`: all triangles as they were
/// read.
pub(super) fn resolve(
    parts: Vec<Part>,
    known: Vec<(Part, Option<Regions>)>,
    file: &[[DVec3; 3]],
    d: &mut Diagnosis,
    report: &mut Reporter,
) -> Vec<Part> {
    let (mut parts, source) = (parts, &SourceTriangles::new(file));
    let mut seen: Vec<Seen> = parts.par_iter().map(|part| resolve_alone(part, source)).collect();
    let groups = groups(&parts, &seen, source);
    let together: Vec<_> = groups.par_iter().map(|group| resolve_together(group, &parts, &seen, source)).collect();
    let mut gone = vec![false; parts.len()];
    for found in together.into_iter().flatten() {
        match found {
            Together::One(members, whole, all) => {
                members[1..].iter().for_each(|&n| gone[n] = true);
                (parts[members[0]].shell, seen[members[0]]) = (whole, all);
            }
            // Each is measured as it winds; together they would wind around each other, which costs much and tells nothing.
            Together::Doubtful(members, around) => {
                for n in members {
                    parts[n].shell.unknown.push(around);
                    seen[n] = Seen::As(Found::Doubtful(around[0]));
                }
            }
        }
    }
    let mut places = Places::default();
    let mut resolved = Vec::new();
    for ((part, seen), _) in parts.into_iter().zip(seen).zip(gone).filter(|(_, gone)| !gone) {
        take(part, seen, &mut resolved, d, &mut places);
    }
    for (part, regions) in known {
        let seen = regions.map_or(Seen::As(Found::Doubtful(part.shell.bounds[0])), Seen::Divided);
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
        Seen::As(Found::Simple { .. }) => {}
        Seen::As(Found::Resolved(made)) => {
            let Closed { unknown, two_sided, .. } = part.shell;
            part.shell = Closed { unknown, two_sided, ..Closed::of_parts(made.surface) };
            d.crossing += 1;
            places.resolved.get_or_insert(made.place);
        }
        Seen::As(Found::Doubtful(place)) => {
            part.shell.doubt = Doubt::Unknown;
            d.crossing += 1;
            d.doubtful += 1;
            places.unknown.get_or_insert(place);
        }
        Seen::Divided(Regions { solid, perhaps, backs, repeated, cut }) => {
            let closed = if cut { Closed::of_parts } else { Closed::new };
            d.doubled += backs;
            d.repeated += repeated;
            if !perhaps.is_empty() {
                let shell = Closed { doubt: Doubt::Perhaps, ..closed(perhaps) };
                places.perhaps.get_or_insert(shell.bounds[0]);
                d.doubtful += 1;
                d.crossing += 1;
                into.push(Part { name: part.name.clone(), own: shell.triangles.len(), shell, ..part });
            }
            let Closed { unknown, two_sided, .. } = part.shell;
            part.shell = Closed { unknown, two_sided, ..closed(solid) };
        }
    }
    into.push(part);
}

impl Places {
    fn say(&self, d: &Diagnosis, report: &mut Reporter) {
        if let Some(place) = self.resolved {
            report.warn(format!(
                "{} (the first near {}); what {} around counts once",
                counted(d.crossing - d.doubtful, "surface crosses itself", "surfaces cross themselves"),
                show(place),
                either(d.crossing - d.doubtful, "it winds", "they wind")
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
                "{} (the first near {}) so that what is inside cannot be told; such a surface is measured as it winds, and the bounds of all cells within its box are 0 and 1",
                counted(d.doubtful, "surface crosses itself", "surfaces cross themselves"),
                show(place)
            ));
        }
    }
}
