//! `voidage porosity`: the stages in order, scene → bodies → grid → porosity → files.

mod files;
mod report;
mod solids;
mod zones;

use super::cli::PorosityArgs;
use super::obstacles::{Wanted, obstacles};
use super::progress::{Progress, print};
use super::stages::{load, measure, need_convex, need_surfaces, threads};
use super::streams::{self, INPUT, is_stream, text_of};
use super::template;
use crate::error::Result;
use crate::geometry::bodies::{Bodies, OwnDrag, SolidSummary};
use crate::grid::{self, Edges, GridSpec, usual_spacing};
use crate::porosity::congestion::congestion;
use crate::porosity::throat::Faces;
use crate::porosity::{Leaf, Method, Options};
use crate::words::counted;
use report::Report;
use std::path::Path;

/// `voidage porosity`.
///
/// # Errors
/// Anything that keeps it from writing all that was asked for.
pub fn porosity(args: &PorosityArgs) -> Result<()> {
    if args.template_scene {
        return print(template::SCENE.as_bytes());
    }
    let args = &files::by_suffix(args)?;
    let mut progress = Progress::new(&args.talk);
    files::check(args)?;
    progress.stdout_is_taken([&args.output, &args.png, &args.report].into_iter().flatten().any(|p| is_stream(p)));
    threads(args.threads)?.install(|| {
        let (bodies, own_grid) = load(&args.scene, &mut progress)?;
        if args.method == Method::Surface {
            need_surfaces(&bodies)?;
        }
        if args.method == Method::Gjk {
            need_convex(&bodies)?;
        }
        let mut remarks = Vec::new();
        let edges = match &args.grid {
            Some(path) => match text_of(path)? {
                Some(text) => grid::file::parse(Path::new(INPUT), &text, &mut remarks)?,
                None => grid::file::read(path, &mut remarks)?,
            },
            None => grid::edges(&spec(args, &bodies, own_grid)?, bodies.bounds(), &mut remarks)?,
        };
        remarks.into_iter().for_each(|r| progress.warn(r));
        let through = files::slices(args, &edges)?;
        let zones = zones::read(args.zones.as_deref(), &edges)?;
        warn_of_own_drag(args, &bodies, &mut progress);
        let leaf = leaf_of(args, &mut progress);
        let args = &PorosityArgs { leaf, ..args.clone() };
        let depth = args.depth.unwrap_or(leaf.depth());
        let (bounds, areas, method) = (args.bounds_fields, !args.no_areas, args.method);
        let resistance = args.resistance || args.zones.is_some() || args.drag.is_some();
        let options = Options { tol: args.tol, depth, bounds, areas, method, leaf, resistance };
        // Throats need the surface in each cell, which porosity cuts anyway.
        let with_surface = Options { resistance: resistance || args.faces == Faces::Throat, ..options };
        let mut result = measure(&bodies, &edges, [false; 3], with_surface, &mut progress)?;
        let (grid, coefficients) = (edges.grid(None)?, args.cd.unwrap_or_default());
        let drag = args.drag.map(|law| (law, coefficients));
        let wanted = Wanted { resistance, drag, faces: args.faces, warning: false };
        let without_throats = result.max_gap;
        let found = obstacles(&grid, &bodies, &mut result, options, wanted, &mut progress);
        if result.max_gap > args.tol.max(without_throats) {
            progress.warn(format!(
                "--faces throat: the bounds of some lowered faces are {:.1e} apart, more than tol, {:.1e}: shadows of round solids are those of \
                 facets; all others are within {without_throats:.1e}",
                result.max_gap, args.tol
            ));
        }
        // The report alone has it.
        let congestion = match (&found.resistance, &args.report) {
            (Some(_), Some(_)) => {
                progress.stage("congestion", |_| congestion(&grid, &bodies, &zones, &result, options))
            }
            _ => Vec::new(),
        };
        let report = Report::new(args, (&grid, &edges), &bodies, &result, (&found, congestion));
        files::write(args, (&edges, through), (&result, &found), &report, &mut progress)?;
        report.summary(&progress);
        if let Some(path) = &args.report {
            streams::write_json(path, &report.finished(&bodies, &progress))?;
        }
        Ok(())
    })
}

/// What ends a subdivision; without one, where a cell that has no proof is divided, the default.
fn leaf_of(args: &PorosityArgs, progress: &mut Progress) -> Leaf {
    if args.method == Method::Gjk || args.leaf == Leaf::Plane {
        return args.leaf;
    }
    progress.warn("--leaf has no effect: it is of --method gjk, which subdivides bodies");
    Leaf::Plane
}

/// Fields without a drag have nothing of what solids of the scene resist by themselves.
fn warn_of_own_drag(args: &PorosityArgs, bodies: &Bodies, progress: &mut Progress) {
    let fields = args.npy.is_some() || args.output.is_some();
    if args.drag.is_some() || args.no_areas || !fields {
        return;
    }
    let drags = |s: &SolidSummary| bodies.bodies[s.bodies.clone()].first().map(|body| body.drag).unwrap_or_default();
    let has = |cr: bool, cd: bool| match (cr, cd) {
        (true, true) => "cr and cd",
        (true, false) => "cr",
        _ => "cd",
    };
    let own: Vec<OwnDrag> = bodies.solids.iter().map(drags).filter(|drag| *drag != OwnDrag::default()).collect();
    if !own.is_empty() {
        let keys = has(own.iter().any(|drag| drag.cr.is_some()), own.iter().any(|drag| drag.cd.is_some()));
        progress.warn(format!(
            "{}: {keys} of {} written only with --drag LAW (of these solids alone: --drag bluff --cd 0); the fields of this run have nothing of \
             them, and a case that takes them by [porosity] from is without that drag",
            bodies.files(),
            counted(own.len(), "solid is", "solids are")
        ));
    }
}

/// What was asked for; else the scene's own grid; else cubes that resolve the scene.
fn spec(args: &PorosityArgs, bodies: &Bodies, own: Result<Option<Edges>>) -> Result<GridSpec> {
    let asked = args.cells.is_some() || args.spacing.is_some() || args.bounds.is_some();
    let own = if asked { None } else { own? };
    Ok(match (args.cells, args.spacing, own) {
        (Some(cells), ..) => GridSpec::Cells(cells, args.bounds),
        (_, Some(spacing), _) => GridSpec::Spacing(spacing, args.bounds),
        (.., Some(edges)) => GridSpec::Edges(edges),
        _ => GridSpec::Spacing(usual_spacing(args.bounds, bodies.bounds()), args.bounds),
    })
}
