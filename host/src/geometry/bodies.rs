//! From the triangles of files to bodies that can be measured: closed, outward, cavities attached.
//!
//! Never requires a manifold. What is wrong with a surface is counted, said in a warning with its place, and given a
//! defined meaning; see [`Diagnosis`].

use crate::error::{Error, Result};
use crate::geometry::close::{Unclosed, close};
use crate::geometry::diagnosis::{Reporter, show};
use crate::geometry::form::Form;
use crate::geometry::mesh::{LARGEST, Mesh};
use crate::geometry::repair::closed::Closed;
pub use crate::geometry::repair::closed::Doubt;
use crate::geometry::repair::copies::{self, Twins};
use crate::geometry::repair::cracks::{self, Cracks};
use crate::geometry::repair::crossing::{self, Found};
use crate::geometry::repair::edges::EdgeUses;
use crate::geometry::repair::junctions;
use crate::geometry::repair::nesting::{self, Nesting};
use crate::geometry::repair::regions::{self, Regions, Unknown};
use crate::geometry::repair::rooms::Role;
use crate::geometry::repair::sets::Sets;
use crate::geometry::repair::shells::{self, Shell};
use crate::geometry::repair::tree::Tree;
use crate::geometry::repair::two_sided;
use crate::geometry::repair::weld::{self, Indexed};
use crate::geometry::resolve::{Part, resolve};
use crate::geometry::single::SingleSource;
use crate::words::{counted, either};
use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap as HashMap;

use std::ops::Range;

pub use crate::geometry::diagnosis::Diagnosis;

/// Points closer than this many units in the last place may be one point that an exporter wrote twice.
const WELD_ULPS: f64 = 4.0;

/// How far coordinates may be off: a few units in the last place of what the source was written in. Digits of `f32` count from the origin;
/// where more were written, six to seven of a part's size, wherever the part is.
fn rounding([lo, hi]: [DVec3; 2], single_precision: bool) -> f64 {
    let (farthest, size) = (lo.abs().max(hi.abs()).max_element(), (hi - lo).max_element());
    let single = if single_precision { farthest } else { size };
    WELD_ULPS * (f64::from(f32::EPSILON) * single + f64::EPSILON * farthest)
}

/// A closed surface around solid, possibly with cavities; or a convex body known by formula.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Body {
    /// Name of the solid that its first triangle came from.
    pub name: String,
    /// Its run in [`Bodies::triangles`]; empty if only its form is known.
    pub triangles: Range<usize>,
    /// What it is by formula, if that is known.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub form: Option<Form>,
    /// Where its corners were rounded to `f32`, if they were.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub single: Option<SingleSource>,
    /// Its own open fraction: 0 is solid.
    pub porosity: f64,
    /// Solid volume of this body alone.
    pub volume: f64,
    /// Lowest and highest corner.
    pub bounds: [DVec3; 2],
    /// Cavities attached.
    pub cavities: usize,
    /// What is not known of it.
    pub doubt: Doubt,
    /// How far corners may be off where surfaces crossed and were cut, or cracks wider than rounding were closed; 0 if none were.
    pub rounding: f64,
    /// Boxes in which it is not known what is solid: around rims of holes that are not plane, and around parts that may have each other's triangles.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub unknown: Vec<[DVec3; 2]>,
    /// No volume: a sheet, which blocks faces where it lies in their plane.
    pub sheet: bool,
    /// Drag given for it, in place of what a law says of its shape.
    pub drag: OwnDrag,
}

impl Body {
    /// Its form, if it is known by that alone: it has no triangles.
    #[must_use]
    pub fn form_alone(&self) -> Option<&Form> {
        self.form.as_ref().filter(|_| self.triangles.is_empty())
    }

    /// How far along each axis its corners may be from those meant, as its file holds them in single precision; 0 if it does not.
    #[must_use]
    pub fn single_error(&self) -> DVec3 {
        let [lo, hi] = self.bounds;
        self.single.map_or(DVec3::ZERO, |single| single.error(lo).max(single.error(hi)))
    }
}

/// Drag that a scene gives for a solid.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct OwnDrag {
    /// Drag coefficient C_D of its frontal area.
    pub cd: Option<f64>,
    /// Resistance CR in 1/m, the same along all axes, of a cell that it fills.
    pub cr: Option<f64>,
}

/// A solid of a scene file, in numbers.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SolidSummary {
    /// The scene file.
    pub scene: String,
    /// Its name there.
    pub name: String,
    /// What it is there: `sphere`, …, `file`.
    pub shape: &'static str,
    /// Its own open fraction.
    pub porosity: f64,
    /// How many of it there are.
    pub copies: usize,
    /// Their run in [`Bodies::bodies`].
    pub bodies: Range<usize>,
    /// Sum of their volumes.
    pub volume: f64,
    /// Lowest and highest corner.
    pub bounds: [DVec3; 2],
}

/// The bodies of a scene.
#[derive(Debug, Clone, Default)]
pub struct Bodies {
    /// Triangles of all bodies, counter-clockwise from outside.
    pub triangles: Vec<[DVec3; 3]>,
    /// The bodies.
    pub bodies: Vec<Body>,
    /// One a file.
    pub diagnoses: Vec<Diagnosis>,
    /// Solids of scene files.
    pub solids: Vec<SolidSummary>,
    /// Sentences for the user; each names its file.
    pub warnings: Vec<String>,
}

impl Bodies {
    /// Lowest and highest corner of all bodies; none if there are none.
    #[must_use]
    pub fn bounds(&self) -> Option<[DVec3; 2]> {
        let all = self.bodies.iter().map(|b| b.bounds);
        all.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])
    }

    /// Some of the bodies, chosen by their numbers, with their triangles.
    #[must_use]
    pub fn some(&self, wanted: impl Fn(usize) -> bool) -> Bodies {
        let mut some = Bodies::default();
        for (_, body) in self.bodies.iter().enumerate().filter(|(n, _)| wanted(*n)) {
            let first = some.triangles.len();
            some.triangles.extend_from_slice(&self.triangles[body.triangles.clone()]);
            some.bodies.push(Body { triangles: first..some.triangles.len(), ..body.clone() });
        }
        some
    }

    /// The files that they came from, for messages.
    #[must_use]
    pub fn files(&self) -> String {
        // Files that a scene names are told by it.
        let of_scene = |d: &&Diagnosis| {
            self.solids.iter().any(|s| s.bodies.start <= d.body_range.start && d.body_range.end <= s.bodies.end)
        };
        let given = self.diagnoses.iter().filter(|d| !of_scene(d));
        let mut files: Vec<&str> = given.map(|d| d.file.as_str()).collect();
        files.extend(self.solids.iter().map(|s| s.scene.as_str()));
        files.dedup();
        files.join(", ")
    }

    /// Add the bodies of a mesh; its coordinates are multiplied by `scale`.
    ///
    /// # Errors
    /// If nothing in it has an area, a coordinate is beyond all measure, or `scale` is not above 0 and finite.
    pub fn add(&mut self, mesh: &Mesh, scale: f64) -> Result<()> {
        if mesh.triangles.is_empty() {
            return Err(mesh.error("no triangles: nothing solid"));
        }
        if !(scale > 0.0 && scale.is_finite()) {
            return Err(
                mesh.error(format!("coordinates cannot be multiplied by {scale}: a scale is above 0 and finite"))
            );
        }
        let scaled: Vec<_> = mesh.triangles.iter().map(|t| t.map(|p| p * scale)).collect();
        // Each coordinate by itself: the largest of several passes over NaN.
        let measurable = |p: &DVec3| p.abs().cmple(DVec3::splat(LARGEST)).all();
        if let Some(n) = scaled.iter().position(|t| !t.iter().all(measurable)) {
            let corner = scaled[n].into_iter().find(|p| !measurable(p)).unwrap_or_default();
            let what = if corner.is_nan() { "that is no number".into() } else { format!("beyond {LARGEST:e} m") };
            let reason = format!("a coordinate {what} is no geometry: {}", show(corner));
            return Err(Error { place: Some(format!("triangle {n} (counted from 0)")), ..mesh.error(reason) });
        }
        let mut report = Reporter { file: mesh.name.clone(), warnings: Vec::new() };
        let mut d = Diagnosis {
            file: report.file.clone(),
            triangles: scaled.len(),
            solids: mesh.solids.len(),
            ..measure(&scaled)
        };
        let solid_of = |n: u32| mesh.solids.partition_point(|s| s.triangles.end <= n as usize);
        let rounding = rounding(d.bounds, mesh.single_precision);
        let cleaned = clean(&scaled, solid_of, rounding, &mut d, &mut report);
        let Some(Cleaned { mesh: indexed, shells, clusters, with_backs, cracks }) = cleaned else {
            let reason = format!("all triangles ({}) are degenerate (no area): nothing solid", d.triangles);
            return Err(mesh.error(reason));
        };
        let name_of =
            |n: u32| mesh.solids.get(solid_of(indexed.source(n))).map_or_else(String::new, |s| s.name.clone());
        let surface = Unclosed { mesh: &indexed, shells: &shells, with_backs: with_backs.as_deref(), rounding };
        let closed = close(&surface, name_of, &mut d, &mut report);
        let known = clusters.into_iter().map(|c| c.into_part(&indexed, name_of)).collect();
        let closed = resolve(closed, known, &scaled, &mut d, &mut report);
        say_copies(&d, &mut report);
        let first = self.bodies.len();
        self.assemble(closed, &mut d, &mut report);
        for body in &mut self.bodies[first..] {
            body.rounding = body.rounding.max(cracks.rounding(&self.triangles[body.triangles.clone()]));
        }
        if mesh.single_precision {
            self.bodies[first..].iter_mut().for_each(|b| b.single = Some(SingleSource::scaled(scale)));
        }
        self.warnings.append(&mut report.warnings);
        d.body_range = first..self.bodies.len();
        self.diagnoses.push(d);
        Ok(())
    }

    /// Give the shells their roles and orientation, and store them.
    fn assemble(&mut self, parts: Vec<Part>, d: &mut Diagnosis, report: &mut Reporter) {
        let (names, shells): (Vec<String>, Vec<Closed>) = parts.into_iter().map(|p| (p.name, p.shell)).unzip();
        let nesting = nesting::nest(&shells, &names);
        let Nesting { roles, either, either_in, unclear, breaking } = &nesting;
        let is_in = |some: &[usize], s: usize| some.binary_search(&s).is_ok();
        let first = self.bodies.len();
        let mut cavities_of: HashMap<usize, Vec<&Closed>> = HashMap::default();
        for (role, shell) in roles.iter().zip(&shells) {
            if let Role::CavityOf(s) = role {
                cavities_of.entry(*s).or_default().push(shell);
                d.cavities += 1;
            }
        }
        // What is a room or a part is a body of its own.
        either_in.iter().for_each(|&(s, inner)| cavities_of.entry(s).or_default().push(&shells[inner]));
        for (s, shell) in shells.iter().enumerate().filter(|&(s, _)| roles[s] == Role::Body) {
            let begin = self.triangles.len();
            let mut volume = self.push(shell, true);
            let cavities: Vec<&Closed> = cavities_of.remove(&s).unwrap_or_default();
            let count = cavities.len();
            let (joined, clear) = joined(&cavities);
            volume -= joined.iter().map(|cavity| self.push(cavity, false)).sum::<f64>();
            d.inside_out += usize::from(shell.volume < 0.0 && !shell.is_sheet());
            d.sheets += usize::from(shell.is_sheet());
            let (triangles, bounds, sheet) = (begin..self.triangles.len(), shell.bounds, shell.is_sheet());
            let rounding = joined.iter().fold(shell.rounding, |most, cavity| most.max(cavity.rounding));
            let doubt = match shell.doubt {
                _ if !clear || is_in(breaking, s) => Doubt::Unknown,
                Doubt::None if is_in(either, s) => Doubt::Perhaps,
                doubt => doubt,
            };
            let of_body = unclear.iter().filter(|(body, _)| *body == s).map(|(_, around)| *around);
            let unknown = joined.iter().chain([shell]).flat_map(|s| s.unknown.iter().copied()).chain(of_body).collect();
            let (name, form, single, porosity) = (names[s].clone(), None, None, 0.0);
            let cavities = count;
            self.bodies.push(Body {
                name,
                triangles,
                form,
                single,
                porosity,
                volume,
                bounds,
                cavities,
                doubt,
                rounding,
                unknown,
                sheet,
                drag: OwnDrag::default(),
            });
        }
        d.bodies = self.bodies.len() - first;
        d.body_volume = self.bodies[first..].iter().map(|b| b.volume).sum();
        let is_inverted = |s: usize| shells[s].volume < 0.0;
        let of_bodies = (0..shells.len()).filter(|&s| roles[s] == Role::Body).map(is_inverted);
        say_roles(&self.bodies[first..], of_bodies, d, report);
        nesting.say_doubts(&shells, report);
    }

    /// Store a shell's triangles, outward or inward; returns its volume without sign.
    fn push(&mut self, shell: &Closed, outward: bool) -> f64 {
        let turn = (shell.volume < 0.0) == outward && !shell.is_sheet();
        self.triangles.extend(shell.triangles.iter().map(|&[a, b, c]| if turn { [a, c, b] } else { [a, b, c] }));
        shell.volume.abs()
    }
}

/// Tell which bodies were inside out (`inverted`, one entry a body), and which have no thickness.
fn say_roles(bodies: &[Body], inverted: impl Iterator<Item = bool>, d: &Diagnosis, report: &mut Reporter) {
    if d.inside_out > 0 {
        report.warn(format!(
            "{} of {} inside out (normals point inward); taken as solid",
            d.inside_out,
            counted(d.bodies, "body is", "bodies are")
        ));
    }
    if let Some((body, _)) = bodies.iter().zip(inverted).find(|(b, inverted)| b.cavities > 0 && *inverted) {
        report.warn(format!(
            "{} of a body that is inside out (from {} to {}); if it is a room with parts in it, \
             give it a wall or leave it out",
            counted(
                body.cavities,
                "shell that looks outward became a cavity",
                "shells that look outward became cavities"
            ),
            show(body.bounds[0]),
            show(body.bounds[1])
        ));
    }
    if d.sheets > 0 {
        let place = bodies.iter().find(|b| b.sheet).map_or(DVec3::ZERO, |b| b.bounds[0]);
        report.warn(format!(
            "{} no thickness (the first at {}); what is open on both sides holds no volume and blocks a face only where it lies in its plane",
            counted(d.sheets, "sheet has", "sheets have"),
            show(place)
        ));
    }
}

/// The cavities of a body, overlapping ones made one; and whether that was possible.
fn joined(cavities: &[&Closed]) -> (Vec<Closed>, bool) {
    let mut sets = Sets::new(cavities.len());
    Tree::of_boxes(cavities.iter().map(|cavity| cavity.bounds), None).touching_pairs(|m, n| {
        let (m, n) = (m.min(n) as usize, m.max(n) as usize);
        if cavities[m].overlaps(cavities[n]) {
            sets.join(m, n);
        }
    });
    let mut clear = true;
    let mut one = |group: Vec<usize>| {
        let whole = Closed::together(group.iter().map(|&n| cavities[n]));
        match group.len() {
            1 => whole,
            _ => match crossing::untangle(&whole.triangles, whole.bounds) {
                Found::Simple { .. } => whole,
                Found::Resolved(made) => Closed { unknown: whole.unknown, ..Closed::of_parts(made.surface) },
                Found::Doubtful(_) => {
                    clear = false;
                    whole
                }
            },
        }
    };
    let joined = sets.groups().into_iter().map(&mut one).collect();
    (joined, clear)
}

fn measure(triangles: &[[DVec3; 3]]) -> Diagnosis {
    let whole = Closed::new(triangles.to_vec());
    Diagnosis { signed_volume: whole.volume, area: whole.area(), bounds: whole.bounds, ..Diagnosis::default() }
}

/// A mesh ready to be closed.
struct Cleaned {
    mesh: Indexed,
    shells: Vec<Shell>,
    clusters: Vec<Cluster>,
    /// Which triangles have three corners, those too that were dropped, if some are the backs of others.
    with_backs: Option<Vec<bool>>,
    cracks: Cracks,
}

/// Double-sided triangles that are no shells, for their edges do not tell what belongs together.
struct Cluster {
    triangles: Vec<u32>,
    /// None if they cannot be told.
    regions: Option<Regions>,
}

impl Cluster {
    /// Of some triangles; none if they are open, which is the matter of caps, or some parts look inward, whose shells tell which are cavities.
    fn new(mesh: &Indexed, triangles: Vec<u32>) -> Option<Self> {
        let all = mesh.corners(&triangles);
        match regions::of_two_sided(&all, Closed::new(all.clone()).bounds) {
            Err(Unknown::Open | Unknown::Mixed) => None,
            found => Some(Cluster { triangles, regions: found.ok() }),
        }
    }

    fn into_part(self, mesh: &Indexed, name_of: impl Fn(u32) -> String) -> (Part, Option<Regions>) {
        let first = self.triangles.iter().min_by_key(|&&n| mesh.source(n));
        let shell = Closed { two_sided: true, ..Closed::new(mesh.corners(&self.triangles)) };
        let name = first.map_or_else(String::new, |&n| name_of(n));
        (Part { name, own: shell.triangles.len(), shell, cluster: 0, guessed: false, contested: false }, self.regions)
    }
}

/// Of all `count` triangles, those of shells of which edges do not tell enough: that are open or hold their own backs, or of which it is a guess which
/// triangles belong to them. Shells that say nothing that others do not are left out.
fn unclear(mesh: &Indexed, shells: &[Shell], twins: &Twins, count: usize, rounding: f64) -> Vec<bool> {
    let mut unclear = vec![false; count];
    let redundant = copies::redundant(mesh, shells, twins, rounding).shells;
    let hold_backs = copies::hold_own_backs(twins, shells.len());
    let is_unclear = |s: usize| !redundant[s] && (hold_backs[s] || shells[s].guessed || !shells[s].boundary.is_empty());
    let of_shells = (0..shells.len()).filter(|&s| is_unclear(s)).flat_map(|s| &shells[s].triangles);
    of_shells.for_each(|&n| unclear[n as usize] = true);
    unclear
}

/// Takes the clusters of double-sided triangles that their regions tell of from those `alive`; only those with a triangle that is `asked` for.
fn take_clusters(
    mesh: &Indexed,
    alive: &mut [bool],
    solid_of: impl Fn(u32) -> usize,
    asked: impl Fn(u32) -> bool,
) -> Vec<Cluster> {
    let mut found = two_sided::clusters(mesh, alive, solid_of);
    found.retain(|triangles| triangles.iter().any(|&n| asked(n)));
    let clusters: Vec<Cluster> = found.into_par_iter().filter_map(|triangles| Cluster::new(mesh, triangles)).collect();
    clusters.iter().flat_map(|c| &c.triangles).for_each(|&n| alive[n as usize] = false);
    clusters
}

/// Weld, drop what is no surface, split into shells. None if nothing has an area.
fn clean(
    triangles: &[[DVec3; 3]],
    solid_of: impl Fn(u32) -> usize,
    rounding: f64,
    d: &mut Diagnosis,
    report: &mut Reporter,
) -> Option<Cleaned> {
    let mut mesh = weld::weld(triangles);
    d.points = mesh.points.len();
    let flat = |t: &[DVec3; 3]| (t[1] - t[0]).cross(t[2] - t[0]) == DVec3::ZERO;
    d.degenerate = triangles.iter().filter(|t| flat(t)).count();
    if d.degenerate == triangles.len() {
        return None;
    }
    if d.degenerate > 0 {
        report.warn(format!(
            "{} (no area) {} ignored",
            counted(d.degenerate, "degenerate triangle", "degenerate triangles"),
            either(d.degenerate, "is", "are")
        ));
    }
    let mut all = distinct(&mesh);
    let mut alive = all.clone();
    let mut uses = EdgeUses::new(&mesh, &alive);
    [d.repeated, d.doubled] = copies::drop_repeats(&mesh, &mut alive, &uses);
    if alive != all {
        uses = EdgeUses::new(&mesh, &alive);
    }
    let cracks = cracks::close(&mut mesh, &alive, &mut uses, rounding);
    d.welded_by = cracks.moved;
    if cracks.moved > 0.0 {
        report.warn(format!("points up to {:.1e} apart were merged to close cracks", cracks.moved));
    }
    let of_all = (alive != all).then(|| EdgeUses::new(&mesh, &all));
    let of_all = of_all.as_ref().unwrap_or(&uses);
    let mut has_backs = of_all.any_same(&mesh, false);
    d.t_junction_edges = junctions::cut(&mut mesh, &mut all, of_all, has_backs, rounding);
    d.boundary_edges = d.t_junction_edges;
    if d.t_junction_edges > 0 {
        has_backs = copies::hold_backs(&mesh, (0..all.len() as u32).filter(|&n| all[n as usize]));
    }
    let with_backs = has_backs.then(|| all.clone());
    let (shells, clusters) = split(&mut mesh, [all, alive], (uses, has_backs), &solid_of, rounding, d);
    d.shells = shells.len() + clusters.len();
    say_turned(&shells, d, report);
    Some(Cleaned { mesh, shells, clusters, with_backs, cracks })
}

/// Tell of triangles that were the wrong way round.
fn say_turned(shells: &[Shell], d: &mut Diagnosis, report: &mut Reporter) {
    d.turned = shells.iter().map(|s| s.turned).sum();
    if d.turned > 0 {
        report.warn(format!(
            "{} had the wrong orientation (winding) and {} turned",
            counted(d.turned, "triangle", "triangles"),
            either(d.turned, "was", "were")
        ));
    }
    d.one_sided = shells.iter().filter(|s| s.one_sided).count();
    if d.one_sided > 0 {
        report.warn(format!(
            "{} one-sided (no consistent orientation); results near {} are unreliable",
            counted(d.one_sided, "shell is", "shells are"),
            either(d.one_sided, "it", "them")
        ));
    }
}

/// Split a mesh into shells, and clusters of which edges do not tell enough. Of its triangles, two lists: which have three corners, and which of these
/// are left without repeats. The edges of these as they were before triangles were cut, and whether some are backs of others.
fn split(
    mesh: &mut Indexed,
    [mut all, mut alive]: [Vec<bool>; 2],
    (uses, has_backs): (EdgeUses, bool),
    solid_of: impl Fn(u32) -> usize,
    rounding: f64,
    d: &mut Diagnosis,
) -> (Vec<Shell>, Vec<Cluster>) {
    let mut clusters = Vec::new();
    let cut = d.t_junction_edges > 0;
    let (mut shells, mut twins, mut asked) = (Vec::new(), Twins::default(), Vec::new());
    if !cut {
        let before = has_backs.then(|| mesh.clone());
        shells = shells::shells(mesh, &alive, uses, &solid_of);
        twins = copies::twins(mesh, &shells);
        if let Some(before) = before {
            // Where edges tell what belongs together, they tell more than regions: which parts touch, and what is open between them.
            asked = unclear(mesh, &shells, &twins, alive.len(), rounding);
            if asked.contains(&true) {
                *mesh = before;
            }
        }
    }
    if cut || asked.contains(&true) {
        clusters = take_clusters(mesh, &mut all, &solid_of, |n| cut || asked[n as usize]);
        // Only now can it be seen which triangles repeat others, and what is open without them.
        alive = all;
        let uses = EdgeUses::new(mesh, &alive);
        [d.repeated, d.doubled] = copies::drop_repeats(mesh, &mut alive, &uses);
        let dropped = d.repeated + d.doubled > 0;
        let uses = if dropped { EdgeUses::new(mesh, &alive) } else { uses };
        shells = shells::shells(mesh, &alive, uses, &solid_of);
        twins = copies::twins(mesh, &shells);
    }
    if cut || has_backs {
        copies::doubt_backs(mesh, &mut shells, &twins, cut);
    }
    drop_copies(mesh, &mut shells, &twins, rounding, d);
    (shells, clusters)
}

/// Drop the shells that repeat others or are their backs.
fn drop_copies(mesh: &Indexed, shells: &mut Vec<Shell>, twins: &Twins, rounding: f64, d: &mut Diagnosis) {
    let found = copies::redundant(mesh, shells, twins, rounding);
    let two_sided = copies::have_two_sides(mesh, shells, twins, &found.shells);
    shells.iter_mut().zip(two_sided).for_each(|(shell, two_sided)| shell.two_sided = two_sided);
    let mut redundant = found.shells.into_iter();
    shells.retain(|_| redundant.next() != Some(true));
    d.repeated += found.repeated;
    d.doubled += found.doubled;
}

/// Tell of surface that was there more than once.
fn say_copies(d: &Diagnosis, report: &mut Reporter) {
    if d.repeated > 0 {
        report.warn(format!(
            "{} others (duplicate surface) and {} dropped",
            counted(d.repeated, "triangle repeats", "triangles repeat"),
            either(d.repeated, "was", "were")
        ));
    }
    if d.doubled > 0 {
        report.warn(format!(
            "{} of others (double-sided surface) and {} dropped",
            counted(d.doubled, "triangle is the back", "triangles are the backs"),
            either(d.doubled, "was", "were")
        ));
    }
}

/// Triangles with three different corners.
fn distinct(mesh: &Indexed) -> Vec<bool> {
    mesh.triangles.iter().map(|[a, b, c]| a != b && b != c && c != a).collect()
}
