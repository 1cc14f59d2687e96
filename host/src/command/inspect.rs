//! `voidage inspect`: what is in a file, before anything is computed.

use crate::command::cli::InspectArgs;
use crate::command::progress::{Progress, print};
use crate::command::stages::load;
use crate::command::streams::{check_place, check_suffix, is_stream, replaces, write_json};
use crate::error::{Error, Result};
use crate::geometry::bodies::{Bodies, Body, Diagnosis, SolidSummary};
use crate::geometry::repair::tree::Tree;
use crate::picture::ticks::{measure, plain_to};
use crate::words::counted;
use glam::DVec3;
use serde::Serialize;

#[derive(Serialize)]
struct Inspection<'a> {
    files: &'a [Diagnosis],
    solids: &'a [SolidSummary],
    overlapping_boxes: usize,
    thin: Vec<Thin>,
    bodies: &'a [Body],
    warnings: &'a [String],
}

/// A body much thinner than long.
#[derive(Debug, Clone, Serialize)]
struct Thin {
    body: usize,
    name: String,
    /// Twice its volume by its surface area: the thickness of a plate, half the thickness of a bar [m].
    thickness: f64,
    size: f64,
}

/// Run it.
///
/// # Errors
/// A file that cannot be read, or a report that cannot be written.
pub fn inspect(args: &InspectArgs) -> Result<()> {
    let mut progress = Progress::new(&args.talk);
    args.report.iter().try_for_each(|path| check_suffix("--report", path, "json").and_then(|()| check_place(path)))?;
    let replaced = args.report.iter().find(|report| args.scene.scene.iter().any(|input| replaces(report, input)));
    if let Some(report) = replaced {
        return Err(Error::usage(format!("{}: the report would replace a file of the scene", report.display())));
    }
    if args.json && args.report.as_deref().is_some_and(is_stream) {
        return Err(Error::usage("--json and --report - both write to the standard output: one of them is enough"));
    }
    progress.stdout_is_taken(args.report.as_deref().is_some_and(is_stream));
    let (bodies, _) = load(&args.scene, &mut progress)?;
    let inspection = Inspection {
        files: &bodies.diagnoses,
        solids: &bodies.solids,
        overlapping_boxes: overlapping_boxes(&bodies.bodies),
        thin: thin(&bodies),
        bodies: &bodies.bodies,
        warnings: &progress.warnings,
    };
    if let Some(path) = &args.report {
        write_json(path, &inspection)?;
    }
    if args.json {
        let text =
            serde_json::to_string_pretty(&inspection).map_err(|e| Error::new(format!("cannot write JSON: {e}")))?;
        print(format!("{text}\n").as_bytes())?;
    } else {
        inspection.table(&progress);
    }
    Ok(())
}

/// Pairs of bodies whose boxes overlap: an upper bound on overlapping pairs.
fn overlapping_boxes(bodies: &[Body]) -> usize {
    let mut pairs = 0;
    Tree::of_boxes(bodies.iter().map(|body| body.bounds), None).touching_pairs(|a, b| {
        let [[a_low, a_high], [b_low, b_high]] = [a, b].map(|n| bodies[n as usize].bounds);
        pairs += usize::from(b_low.cmplt(a_high).all() && a_low.cmplt(b_high).all());
    });
    pairs
}

fn thin(bodies: &Bodies) -> Vec<Thin> {
    let mut thin: Vec<Thin> = bodies
        .bodies
        .iter()
        .enumerate()
        .filter(|(_, b)| !b.sheet && !b.triangles.is_empty())
        .filter_map(|(n, b)| {
            let area: f64 =
                bodies.triangles[b.triangles.clone()].iter().map(|[p, q, r]| (q - p).cross(r - p).length() * 0.5).sum();
            let (thickness, size) = (2.0 * b.volume / area, (b.bounds[1] - b.bounds[0]).max_element());
            (thickness < 0.01 * size).then(|| Thin { body: n, name: b.name.clone(), thickness, size })
        })
        .collect();
    thin.sort_by(|a, b| a.thickness.total_cmp(&b.thickness));
    thin
}

impl Inspection<'_> {
    fn table(&self, progress: &Progress) {
        for d in self.files {
            progress.say(&d.file);
            let size = d.bounds[1] - d.bounds[0];
            let rows: [(&str, String); 18] = [
                ("triangles", d.triangles.to_string()),
                ("named solids", d.solids.to_string()),
                ("distinct points", d.points.to_string()),
                ("box", extent(&d.bounds)),
                ("size", format!("{} m", size.to_array().map(|v| plain_to(v, 1e-6 * v)).join(" × "))),
                ("shells", d.shells.to_string()),
                ("bodies", d.bodies.to_string()),
                ("cavities", d.cavities.to_string()),
                ("inside out", d.inside_out.to_string()),
                ("sheets", d.sheets.to_string()),
                ("turned triangles", d.turned.to_string()),
                ("degenerate", d.degenerate.to_string()),
                ("repeated", d.repeated.to_string()),
                ("backs dropped", d.doubled.to_string()),
                ("boundary edges", format!("{} ({} of T-junctions)", d.boundary_edges, d.t_junction_edges)),
                ("rims closed", d.holes.to_string()),
                ("area", format!("{} m²", measure(d.area))),
                (
                    "volume",
                    format!(
                        "{} m³ signed as read, {} m³ sum of bodies",
                        measure(d.signed_volume),
                        measure(d.body_volume)
                    ),
                ),
            ];
            for (name, value) in rows {
                progress.say(format!("  {name:<18}{value}"));
            }
        }
        if !self.solids.is_empty() {
            progress.say("solids of scenes");
            let row = ["name", "shape", "porosity", "copies", "volume [m³]", "box"].map(str::to_owned);
            let longest = self.solids.iter().map(|s| s.name.chars().count() + 1).fold(18, usize::max);
            progress.say(line(longest, row));
            self.solids.iter().for_each(|s| progress.say(line(longest, s.row())));
        }
        progress.say(format!("body boxes that overlap: {}", counted(self.overlapping_boxes, "pair", "pairs")));
        if let Some(t) = self.thin.first() {
            progress.say(format!(
                "thin bodies: {}; the thinnest is body {} \"{}\" (counted from 0), about {} m over {} m",
                self.thin.len(),
                t.body,
                t.name,
                plain_to(t.thickness, 1e-3 * t.thickness),
                plain_to(t.size, 1e-3 * t.size)
            ));
        }
    }
}

impl SolidSummary {
    fn row(&self) -> [String; 6] {
        let (name, shape, porosity) = (self.name.clone(), self.shape.to_owned(), self.porosity.to_string());
        [name, shape, porosity, self.copies.to_string(), measure(self.volume), extent(&self.bounds)]
    }
}

/// A row of the table of solids, with so much room for their names.
fn line(room: usize, [name, shape, porosity, copies, volume, extent]: [String; 6]) -> String {
    format!("  {name:<room$}{shape:<10} {porosity:>8} {copies:>7} {volume:>16}  {extent}")
}

/// A box for people.
fn extent([lo, hi]: &[DVec3; 2]) -> String {
    let size = (*hi - *lo).max_element();
    format!("({}) to ({})", point(*lo, size), point(*hi, size))
}

/// Coordinates, each to a millionth of `size`.
fn point(p: DVec3, size: f64) -> String {
    p.to_array().map(|v| plain_to(if v.abs() < 1e-6 * size { 0.0 } else { v }, 1e-6 * size)).join(", ")
}
