//! The solids of a run, one by one: volume and areas of each alone, wherever it is and whatever it overlaps.

use crate::geometry::areas;
use crate::geometry::bodies::{Bodies, Body, Diagnosis, SolidSummary};
use rustc_hash::FxHashMap;
use serde::Serialize;
use voidage_core::surface::surface_area::SurfaceArea;

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
    let of_files = files.flat_map(|file| of_file(bodies, file));
    of_scenes.chain(of_files).collect()
}

/// The bodies of each name in a file, in the order in which the names come first.
fn of_file<'a>(bodies: &'a Bodies, file: &'a Diagnosis) -> impl Iterator<Item = SolidReport> {
    let mut groups: Vec<(&str, Vec<usize>)> = Vec::new();
    let mut known: FxHashMap<&str, usize> = FxHashMap::default();
    for number in file.body_range.clone() {
        let name = &bodies.bodies[number].name[..];
        let group = *known.entry(name).or_insert(groups.len());
        if group == groups.len() {
            groups.push((name, Vec::new()));
        }
        groups[group].1.push(number);
    }
    groups.into_iter().map(|(name, numbers)| {
        let own = || numbers.iter().map(|&n| &bodies.bodies[n]);
        let bounds = own().map(|b| b.bounds).reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]);
        let about = SolidSummary {
            scene: file.file.clone(),
            name: name.to_owned(),
            shape: "file",
            porosity: 0.0,
            copies: 1,
            bodies: numbers[0]..numbers[numbers.len() - 1] + 1,
            volume: own().map(|b| b.volume).sum(),
            bounds: bounds.unwrap_or_default(),
        };
        report(bodies, about, own())
    })
}

fn report<'a>(bodies: &Bodies, about: SolidSummary, own: impl Iterator<Item = &'a Body>) -> SolidReport {
    let area = own.map(|body| areas::of_body(body, &bodies.triangles[body.triangles.clone()]));
    let SurfaceArea { frontal, wetted } = area.fold(SurfaceArea::default(), SurfaceArea::plus);
    SolidReport { about, frontal_area: frontal, wetted_area: wetted }
}
