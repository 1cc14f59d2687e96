//! Shells to closed parts: those that close each other are joined, holes are capped.

use crate::geometry::diagnosis::{Diagnosis, Reporter, show};
use crate::geometry::repair::apart::Pieces;
use crate::geometry::repair::closed::Closed;
use crate::geometry::repair::edges::{EdgeUses, key, without_opposites};
use crate::geometry::repair::gaps::{self, Gaping, Loose};
use crate::geometry::repair::rims::{Rim, rims};
use crate::geometry::repair::sets::Sets;
use crate::geometry::repair::shells::Shell;
use crate::geometry::repair::weld::Indexed;
use crate::geometry::resolve::Part;
use crate::words::{counted, either};
use glam::DVec3;
use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};
use std::cell::OnceCell;
use std::collections::BTreeSet;

/// What is to be closed.
pub(super) struct Unclosed<'a> {
    pub mesh: &'a Indexed,
    pub shells: &'a [Shell],
    /// Which triangles have three corners, those too that were dropped, if some are the backs of others.
    pub with_backs: Option<&'a [bool]>,
    /// How far corners may be off.
    pub rounding: f64,
}

/// Make every shell closed: join those that close each other, cap holes.
pub(super) fn close(
    surface: &Unclosed<'_>,
    name_of: impl Fn(u32) -> String,
    d: &mut Diagnosis,
    report: &mut Reporter,
) -> Vec<Part> {
    let &Unclosed { mesh, shells, with_backs, rounding, .. } = surface;
    let uses = OnceCell::new();
    let contested = |edge: &[u32; 2]| {
        let uses = with_backs.map(|all| uses.get_or_init(|| EdgeUses::new(mesh, all)));
        uses.is_some_and(|uses| is_contested(mesh, uses, *edge))
    };
    let (mut closed, mut open) = (Vec::new(), Open::default());
    let (mut without_caps, mut loose) = (Vec::new(), Vec::new());
    d.area = 0.0;
    for group in groups(mesh, shells, rounding) {
        let members: Vec<u32> = group.iter().flat_map(|&s| shells[s].triangles.iter().copied()).collect();
        let mut triangles = mesh.corners(&members);
        let own = triangles.len();
        d.area += triangles.iter().map(area).sum::<f64>();
        let boundary = without_opposites(group.iter().flat_map(|&s| shells[s].boundary.iter().copied()));
        let caps = Caps::new(mesh, &members, &boundary, rounding);
        d.boundary_edges += boundary.len();
        d.t_junction_edges += caps.t_junction_edges;
        d.holes += caps.open.holes;
        let is_capped = !caps.triangles.is_empty();
        triangles.extend(caps.triangles);
        let name = members.iter().min().map_or_else(String::new, |&n| name_of(n));
        let cluster = group.iter().map(|&s| shells[s].cluster).min().unwrap_or(0);
        let guessed = group.iter().any(|&s| shells[s].guessed);
        let mut shell = Closed::new(triangles);
        // That of a sheet is told as such.
        if !shell.is_sheet() {
            open.join(&caps.open);
            open.uneven.extend(&caps.open.uneven);
            shell.unknown = caps.open.uneven;
        }
        shell.two_sided = group.iter().all(|&s| shells[s].two_sided);
        loose.extend(boundary.iter().map(|&edge| Loose { part: closed.len(), edge }));
        let contested = is_capped && boundary.iter().any(contested);
        if !is_capped {
            without_caps.push((closed.len(), members));
        }
        closed.push(Part { name, shell, cluster, guessed, contested, own });
    }
    doubt_gaping(mesh, &mut closed, &loose, report);
    // Parts joined at T-junctions may look opposite ways, whatever the volumes of the whole say.
    if d.t_junction_edges > 0 || !look_alike(&closed) {
        separate(surface, &mut closed, without_caps, name_of);
    }
    if d.t_junction_edges > 0 {
        report.warn(format!(
            "{} no partner (T-junctions), but the surface closes",
            counted(d.t_junction_edges, "edge has", "edges have")
        ));
    }
    open.say(report);
    closed
}

/// Sheets, or leaves thin enough for that, that nearly meet may be a body whose corners were written too coarsely: all in the box around them is in doubt.
fn doubt_gaping(mesh: &Indexed, parts: &mut [Part], loose: &[Loose], report: &mut Reporter) {
    // A plane part and its cap hold what its corners are rounded by, once it is turned.
    let mut leaves: BTreeSet<usize> = loose.iter().map(|l| l.part).collect();
    leaves.retain(|&n| !gaps::holds_volume(&parts[n].shell));
    if leaves.is_empty() {
        return;
    }
    let mut doubtful: Vec<(Gaping, [DVec3; 2])> = Vec::new();
    for gaping in gaps::gaping(mesh, loose, parts.len()) {
        let own = gaping.parts.iter().flat_map(|&n| parts[n].own().iter().copied());
        let whole = Closed::new(own.collect());
        let leaf = gaping.parts.iter().find(|n| leaves.contains(n));
        let Some(&leaf) = leaf.filter(|_| gaps::holds_volume(&whole)) else { continue };
        parts[leaf].shell.unknown.push(whole.bounds);
        doubtful.push((gaping, whole.bounds));
    }
    say_gaping(&doubtful, report);
}

fn say_gaping(doubtful: &[(Gaping, [DVec3; 2])], report: &mut Reporter) {
    let Some((first, bounds)) = doubtful.first() else { return };
    let [lo, hi] = bounds.map(show);
    let count = first.parts.len();
    let parts = format!("{} from {lo} to {hi}", counted(count, "open part", "open parts"));
    let width = doubtful.iter().fold(0.0, |most, (gaping, _)| f64::max(most, gaping.width));
    let gaps = format!("along edges, with gaps of up to {width:.1e}");
    report.warn(if doubtful.len() == 1 {
        let meet = either(count, "meets itself", "meet");
        format!("{parts} nearly {meet} {gaps}: whether they close a body cannot be told, and the bounds of all cells within their box are 0 and 1")
    } else {
        format!(
            "{} groups of open parts nearly meet {gaps} (the first: {parts}): whether they close bodies cannot be told, and the bounds of all cells within their boxes are 0 and 1",
            doubtful.len()
        )
    });
}

/// Takes those parts apart that were joined although each closes by itself, if some of them look the other way, or a part that looks the other way holds one
/// and not the other: that one may be its cavity. Sheets may be what they have between them. `joined`: which parts, and their triangles.
fn separate(
    surface: &Unclosed<'_>,
    parts: &mut Vec<Part>,
    mut joined: Vec<(usize, Vec<u32>)>,
    name_of: impl Fn(u32) -> String,
) {
    let mesh = surface.mesh;
    let sheets = joined.iter().filter(|(s, _)| parts[*s].shell.is_sheet());
    let between: Vec<(u32, Closed)> =
        sheets.flat_map(|(_, members)| members).map(|&n| (n, Closed::new(mesh.corners(&[n])))).collect();
    let (mut used, mut sheets) = (HashSet::default(), Vec::new());
    while let Some((s, members)) = joined.pop() {
        let (shell, is_sheet) = (&parts[s].shell, parts[s].shell.is_sheet());
        let is_free = |(n, wall): &&(u32, Closed)| !is_sheet && !used.contains(n) && shell.is_around(wall);
        let free = || between.iter().filter(is_free).map(|&(n, _)| n).collect();
        let Some(apart) = apart(surface, parts, s, &members, free) else {
            if is_sheet {
                sheets.push((s, members));
            }
            continue;
        };
        used.extend(apart.iter().flatten().copied());
        for (n, members) in apart.into_iter().enumerate() {
            let name = members.iter().min().map_or_else(String::new, |&n| name_of(n));
            let (cluster, guessed) = (parts[s].cluster, parts[s].guessed);
            let two_sided = parts[s].shell.two_sided;
            let (shell, own) = (Closed { two_sided, ..Closed::new(mesh.corners(&members)) }, members.len());
            let part = Part { name, shell, own, cluster, guessed, contested: false };
            if n == 0 {
                parts[s] = part;
                joined.push((s, members));
            } else {
                parts.push(part);
                joined.push((parts.len() - 1, members));
            }
        }
    }
    sheets.retain(|(_, members)| members.iter().all(|n| used.contains(n)));
    sheets.sort_unstable();
    sheets.iter().rev().for_each(|&(s, _)| drop(parts.remove(s)));
}

/// Do all parts look outward, or all inward, as wholes?
fn look_alike(parts: &[Part]) -> bool {
    let all = |sign: f64| parts.iter().all(|p| p.shell.volume * sign > 0.0 && !p.shell.is_sheet());
    all(1.0) || all(-1.0)
}

/// The triangles of the parts that one falls into, with those of the walls `free` that are theirs; none if it stays whole.
fn apart(
    surface: &Unclosed<'_>,
    parts: &[Part],
    s: usize,
    members: &[u32],
    free: impl Fn() -> Vec<u32>,
) -> Option<Vec<Vec<u32>>> {
    let shell = &parts[s].shell;
    let across = |other: &&Closed| {
        let looks_the_other_way = other.volume * shell.volume < 0.0 && !other.is_sheet() && !shell.is_sheet();
        looks_the_other_way && other.overlaps(shell) && !other.is_around(shell)
    };
    let with = |walls: &[u32]| {
        let pieces = Pieces::new(surface.mesh, [members, walls], shell.volume, surface.rounding)?;
        let by_others = || parts.iter().map(|p| &p.shell).filter(across).find_map(|other| pieces.held_by(other));
        pieces.opposite().or_else(by_others)
    };
    with(&[]).or_else(|| Some(free()).filter(|free| !free.is_empty()).and_then(|free| with(&free)))
}

/// Do different triangles end at a loose edge, some of which others may have been joined to that belong to it?
fn is_contested(mesh: &Indexed, uses: &EdgeUses, [a, b]: [u32; 2]) -> bool {
    let mut of_edge = uses.of(key(a, b)).iter().map(|(_, u)| mesh.sorted(u.triangle));
    of_edge.next().is_some_and(|first| of_edge.any(|other| other != first))
}

/// What closes the holes of a surface.
#[derive(Default)]
struct Caps {
    triangles: Vec<[DVec3; 3]>,
    open: Open,
    /// Loose edges that close by themselves.
    t_junction_edges: usize,
}

impl Caps {
    /// For some triangles of a mesh and the loose edges around them.
    fn new(mesh: &Indexed, members: &[u32], boundary: &[[u32; 2]], rounding: f64) -> Self {
        let mut caps = Caps::default();
        for rim in rims(boundary) {
            if rim.cancels(&mesh.points, rounding) {
                caps.t_junction_edges += rim.edges.len();
                continue;
            }
            let surface = members.iter().map(|&n| mesh.triangles[n as usize]);
            rim.apart(surface, &mesh.points).iter().for_each(|rim| caps.close(mesh, rim, rounding));
        }
        caps
    }

    fn close(&mut self, mesh: &Indexed, rim: &Rim, rounding: f64) {
        if rim.cancels(&mesh.points, rounding) {
            self.t_junction_edges += rim.edges.len();
            return;
        }
        let cap = rim.cap(&mesh.points);
        let even = rim.is_plane(&mesh.points, rounding);
        self.open.join(&Open {
            edges: rim.edges.len(),
            holes: 1,
            largest: Some((cap.iter().map(area).sum(), rim.middle(&mesh.points))),
            uneven: Vec::new(),
        });
        self.open.uneven.extend((!even).then(|| rim.bounds(&mesh.points)));
        self.triangles.extend(cap);
    }
}

/// Where bodies are open.
#[derive(Default)]
struct Open {
    edges: usize,
    holes: usize,
    /// Area and middle of the largest cap.
    largest: Option<(f64, DVec3)>,
    /// Boxes around rims that are not plane.
    uneven: Vec<[DVec3; 2]>,
}

impl Open {
    fn join(&mut self, other: &Open) {
        self.edges += other.edges;
        self.holes += other.holes;
        let area = |largest: Option<(f64, DVec3)>| largest.map(|(area, _)| area);
        if area(other.largest) > area(self.largest) {
            self.largest = other.largest;
        }
    }

    fn say(&self, report: &mut Reporter) {
        if let Some((area, place)) = self.largest {
            report.warn(format!(
                "the surface is open: {} around {}, closed with {} (the largest, area {area:.6}, at {})",
                counted(self.edges, "boundary edge", "boundary edges"),
                counted(self.holes, "hole", "holes"),
                either(self.holes, "a cap", "caps"),
                show(place)
            ));
        }
        if let Some(&[lo, _]) = self.uneven.first() {
            let volume: f64 = self.uneven.iter().map(|[lo, hi]| (*hi - *lo).element_product()).sum();
            report.warn(format!(
                "{} not plane (the first near {}): what lies between its edge and the cap may be solid or open; the bounds of cells hold both in a box around it, {volume:.3e} m³ in all",
                counted(self.uneven.len(), "hole is", "holes are"),
                show(lo)
            ));
        }
    }
}

/// Area of a triangle.
fn area([a, b, c]: &[DVec3; 3]) -> f64 {
    (b - a).cross(c - a).length() * 0.5
}

/// Shells that belong together: closed ones alone, also those that close but for T-junctions; open ones with those that share a corner of their
/// boundary.
fn groups(mesh: &Indexed, shells: &[Shell], rounding: f64) -> Vec<Vec<usize>> {
    let mut sets = Sets::new(shells.len());
    let mut owner = HashMap::default();
    for (s, shell) in shells.iter().enumerate() {
        let rims = rims(&without_opposites(shell.boundary.iter().copied()));
        let open = rims.iter().filter(|rim| !rim.cancels(&mesh.points, rounding));
        for v in open.flat_map(|rim| rim.edges.iter().flatten()) {
            let other = *owner.entry(*v).or_insert(s);
            sets.join(s, other);
        }
    }
    sets.groups()
}
