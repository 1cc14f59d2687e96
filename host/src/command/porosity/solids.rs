//! The solids of a run, one by one: volume and areas of each alone, wherever it is and whatever it overlaps.

use crate::geometry::bodies::{Bodies, Body, SolidSummary};
use crate::geometry::facets;
use glam::DVec3;
use serde::Serialize;

/// A solid of a scene file, or the bodies of one name in an STL or OBJ file.
#[derive(Debug, Clone, Serialize)]
pub(super) struct SolidReport {
    #[serde(flatten)]
    about: SolidSummary,
    /// ½ ∫ |n_i| dA along x, y, z in m².
    frontal_area: [f64; 3],
    /// ∫ dA in m².
    wetted_area: f64,
}

/// All solids, those of scene files first.
pub(super) fn solids(bodies: &Bodies) -> Vec<SolidReport> {
    let of_scenes = bodies.solids.iter().cloned().map(|solid| {
        let own = &bodies.bodies[solid.bodies.clone()];
        report(bodies, solid, own.iter())
    });
    let in_scene = |n: usize| bodies.solids.iter().any(|s| s.bodies.contains(&n));
    let files = bodies.diagnoses.iter().filter(|d| !d.body_range.is_empty() && !in_scene(d.body_range.start));
    let of_files = files.flat_map(|file| {
        let own = &bodies.bodies[file.body_range.clone()];
        let mut names: Vec<&str> = Vec::new();
        for body in own {
            if !names.contains(&&body.name[..]) {
                names.push(&body.name);
            }
        }
        names
            .into_iter()
            .map(|name| {
                let named = || own.iter().filter(|b| b.name == name);
                let bounds = named().map(|b| b.bounds).reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]);
                let place = |n: Option<usize>| n.map_or(0, |n| n + file.body_range.start);
                let first = place(own.iter().position(|b| b.name == name));
                let last = place(own.iter().rposition(|b| b.name == name));
                let about = SolidSummary {
                    scene: file.file.clone(),
                    name: name.to_owned(),
                    shape: "file",
                    porosity: 0.0,
                    copies: 1,
                    bodies: first..last + 1,
                    volume: named().map(|b| b.volume).sum(),
                    bounds: bounds.unwrap_or_default(),
                };
                report(bodies, about, named())
            })
            .collect::<Vec<_>>()
    });
    of_scenes.chain(of_files).collect()
}

fn report<'a>(bodies: &Bodies, about: SolidSummary, own: impl Iterator<Item = &'a Body>) -> SolidReport {
    let (mut frontal, mut wetted) = (DVec3::ZERO, 0.0);
    for body in own {
        let curved = body.form.as_ref().filter(|_| body.triangles.is_empty()).map(facets::triangles);
        let surface = curved.as_deref().unwrap_or(&bodies.triangles[body.triangles.clone()]);
        for [a, b, c] in surface {
            let area = (b - a).cross(c - a) * 0.5;
            frontal += area.abs() * 0.5;
            wetted += area.length();
        }
    }
    SolidReport { about, frontal_area: frontal.to_array(), wetted_area: wetted }
}
