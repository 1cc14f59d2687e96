//! From the solids of a scene to bodies in their places.

use super::placement::Motion;
use super::shape::Shape;
use super::{Scene, SceneSolid};
use crate::error::{Error, Result};
use crate::geometry::bodies::{Bodies, Body, Diagnosis, Doubt, SolidSummary};
use crate::geometry::read;
use crate::grid::AXES;
use crate::words::counted;
use glam::DVec3;
use std::path::Path;

/// Most triangles that a scene's copies may come to: 2 GB of them.
const MOST_TRIANGLES: usize = 30_000_000;

/// Add a scene's solids to `bodies`, opening the files that they name.
///
/// # Errors
/// A file that cannot be read or holds nothing solid, or copies without end; with the scene's line and the solid's name.
pub fn add(scene: &Scene, bodies: &mut Bodies) -> Result<()> {
    for solid in &scene.solids {
        // Of two places the one in the solid's own file is shown.
        let place = |e: &Error| {
            let reason = format!("solid \"{}\": {e}", solid.name);
            let excerpt = solid.place.excerpt.clone().filter(|_| e.excerpt.is_none());
            Error { reason, excerpt, ..solid.place.clone() }
        };
        if let Some(axis) = solid.placement.stands_still() {
            let (scene, name, axis) = (scene.path.display(), &solid.name, AXES[axis]);
            bodies.warnings.push(format!(
                "{scene}: solid \"{name}\": array: its copies along {axis} lie upon each other: step is 0 along {axis}"
            ));
        }
        for (key, angle) in [("rotate.angle", solid.placement.angle), ("angle", solid.shape.angle())] {
            if let Some(degrees) = radians_of(angle) {
                let (scene, name) = (scene.path.display(), &solid.name);
                bodies.warnings.push(format!(
                    "{scene}: solid \"{name}\": {key}: {angle} is {degrees}° in radians; angles are in degrees"
                ));
            }
        }
        if solid.porosity == 1.0 && solid.drag.cr.is_none_or(|cr| cr == 0.0) {
            let (scene, name) = (scene.path.display(), &solid.name);
            bodies.warnings.push(format!(
                "{scene}: solid \"{name}\": porosity is 1 and there is no cr: all of it is open, it has no effect"
            ));
        }
        let first = bodies.bodies.len();
        add_solid(scene, solid, bodies).map_err(|e| place(&e))?;
        let added = &bodies.bodies[first..];
        let bounds = added.iter().map(|b| b.bounds).reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]);
        bodies.solids.push(SolidSummary {
            scene: scene.path.display().to_string(),
            name: solid.name.clone(),
            shape: solid.shape.name(),
            porosity: solid.porosity,
            copies: solid.placement.copies(),
            bodies: first..bodies.bodies.len(),
            volume: added.iter().map(|b| b.volume).sum(),
            bounds: bounds.unwrap_or_default(),
        });
    }
    Ok(())
}

/// The degrees of an angle that looks like radians: a multiple of 30° or 45° to a thousandth.
fn radians_of(angle: f64) -> Option<f64> {
    let degrees = angle.to_degrees();
    let round = [30.0, 45.0].map(|step| (degrees / step).round() * step);
    round
        .into_iter()
        .find(|round| *round != 0.0 && round.abs() <= 360.0 && (degrees - round).abs() <= 1e-3 * round.abs())
}

fn add_solid(scene: &Scene, solid: &SceneSolid, bodies: &mut Bodies) -> Result<()> {
    let Shape::File { path, scale } = &solid.shape else {
        let surface = solid.shape.surface();
        check_size(bodies, surface.len(), solid)?;
        for (at, motion) in solid.placement.motions(solid.shape.centre()) {
            let form = solid.shape.placed(&motion);
            let triangles = push_surface(bodies, &surface, &motion);
            let bounds = form.as_ref().map_or_else(Default::default, |f| f.bounds());
            let (volume, porosity) = (solid.shape.volume(), solid.porosity);
            let (name, single) = (name(solid, at, ""), None);
            let (cavities, doubt, rounding, sheet) = (0, Doubt::None, 0.0, false);
            let drag = solid.drag;
            bodies.bodies.push(Body {
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
                unknown: Vec::new(),
                sheet,
                drag,
            });
        }
        return Ok(());
    };
    let file = scene.path.parent().unwrap_or(Path::new("")).join(path);
    let mesh = read::read(&file)?;
    let mut original = Bodies::default();
    original.add(&mesh, *scale)?;
    let prefix = |warning: &String| format!("{}: solid \"{}\": {warning}", scene.path.display(), solid.name);
    bodies.warnings.extend(mesh.warnings.iter().chain(&original.warnings).map(prefix));
    let size = original.diagnoses.last().filter(|_| *scale == 1.0).and_then(Diagnosis::too_large_for_metres);
    bodies.warnings.extend(size.map(|size| prefix(&format!("{}: {size}, give unit = \"mm\"", file.display()))));
    check_size(bodies, original.triangles.len(), solid)?;
    let centre = original.bounds().map_or(DVec3::ZERO, |[lo, hi]| lo * 0.5 + hi * 0.5);
    let first = bodies.bodies.len();
    for (at, motion) in solid.placement.motions(centre) {
        for body in &original.bodies {
            let triangles = push_surface(bodies, &original.triangles[body.triangles.clone()], &motion);
            let corners = bodies.triangles[triangles.clone()].iter().flatten();
            let bounds = corners.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[a, b], &p| [a.min(p), b.max(p)]);
            let (name, porosity) = (name(solid, at, &body.name), solid.porosity);
            let unknown = body.unknown.iter().map(|&around| motion.box_around(around)).collect();
            let single = body.single.map(|s| s.moved(motion.matrix(), motion.apply(DVec3::ZERO)));
            bodies.bodies.push(Body {
                name,
                triangles,
                single,
                porosity,
                bounds,
                unknown,
                drag: solid.drag,
                ..body.clone()
            });
        }
    }
    let range = first..bodies.bodies.len();
    bodies.diagnoses.extend(original.diagnoses.into_iter().map(|d| Diagnosis { body_range: range.clone(), ..d }));
    Ok(())
}

/// Refuse copies that would not fit into memory.
fn check_size(bodies: &mut Bodies, triangles: usize, solid: &SceneSolid) -> Result<()> {
    let copies = solid.placement.copies();
    let total = triangles.checked_mul(copies).and_then(|n| n.checked_add(bodies.triangles.len()));
    // A single copy is as large as its file; that is the user's own measure.
    if copies > 1 && total.is_none_or(|n| n > MOST_TRIANGLES) {
        let triangles = counted(triangles, "triangle", "triangles");
        let reason = format!("{copies} copies of {triangles} are more than {MOST_TRIANGLES} in all");
        return Err(Error::new(reason));
    }
    if bodies.triangles.try_reserve(triangles * copies).is_err() {
        let (copies, triangles) = (counted(copies, "copy", "copies"), counted(triangles, "triangle", "triangles"));
        return Err(Error::new(format!("{copies} of {triangles}: more than fits into memory")));
    }
    Ok(())
}

fn push_surface(bodies: &mut Bodies, surface: &[[DVec3; 3]], motion: &Motion) -> std::ops::Range<usize> {
    let begin = bodies.triangles.len();
    bodies.triangles.extend(surface.iter().map(|t| t.map(|p| motion.apply(p))));
    begin..bodies.triangles.len()
}

/// A copy by its place in the array, a part of a file by its name there.
fn name(solid: &SceneSolid, [i, j, k]: [usize; 3], part: &str) -> String {
    let copy = if solid.placement.copies() > 1 { format!("[{i},{j},{k}]") } else { String::new() };
    let separator = if part.is_empty() { "" } else { "/" };
    format!("{}{copy}{separator}{part}", solid.name)
}
