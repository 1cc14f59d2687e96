//! The solids of a run, one by one: volume and areas of each alone, wherever it is and whatever it overlaps.

use crate::geometry::areas;
use crate::geometry::bodies::{Bodies, Body, Diagnosis, SolidSummary};
use glam::DVec3;
use rustc_hash::FxHashMap;
use serde::Serialize;
use std::ops::Range;
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
    /// Of a file in a scene, the bodies of each name in it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    parts: Vec<PartReport>,
}

/// The bodies of one name in a file of a scene.
#[derive(Debug, Clone, Serialize)]
struct PartReport {
    /// That of the solid, of its copy if there are several, and that in the file.
    name: String,
    /// Sum of their volumes in m³.
    volume: f64,
    /// ½ ∫ |n_i| dA along x, y, z in m².
    frontal_area: [f64; 3],
    /// ∫ dA in m².
    wetted_area: f64,
    /// Lowest and highest corner.
    bounds: [DVec3; 2],
}

/// All solids, those of scene files first.
pub(super) fn solids(bodies: &Bodies) -> Vec<SolidReport> {
    let of_scenes = bodies.solids.iter().map(|solid| {
        let SurfaceArea { frontal, wetted } = areas_of(bodies, bodies.bodies[solid.bodies.clone()].iter());
        SolidReport { about: solid.clone(), frontal_area: frontal, wetted_area: wetted, parts: parts(bodies, solid) }
    });
    let in_scene = |n: usize| bodies.solids.iter().any(|s| s.bodies.contains(&n));
    let files = bodies.diagnoses.iter().filter(|d| !d.body_range.is_empty() && !in_scene(d.body_range.start));
    let of_files = files.flat_map(|file| of_file(bodies, file));
    of_scenes.chain(of_files).collect()
}

/// The numbers of the bodies of each name among some, in the order in which the names come first.
fn by_name(bodies: &Bodies, numbers: Range<usize>) -> Vec<(&str, Vec<usize>)> {
    let mut groups: Vec<(&str, Vec<usize>)> = Vec::new();
    let mut known: FxHashMap<&str, usize> = FxHashMap::default();
    for number in numbers {
        let name = &bodies.bodies[number].name[..];
        let group = *known.entry(name).or_insert(groups.len());
        if group == groups.len() {
            groups.push((name, Vec::new()));
        }
        groups[group].1.push(number);
    }
    groups
}

/// The bodies of each name that the file of a solid has, copy by copy; none of a solid that is no file.
fn parts(bodies: &Bodies, solid: &SolidSummary) -> Vec<PartReport> {
    // Behind the name of the solid stands the place of the copy, if there are several, and then that of the part.
    let is_part = |name: &str| name.strip_prefix(&solid.name[..]).is_some_and(|rest| rest.contains('/'));
    let named = if solid.shape == "file" { by_name(bodies, solid.bodies.clone()) } else { Vec::new() };
    let named = named.into_iter().filter(|(name, _)| is_part(name));
    named.map(|(name, numbers)| part(bodies, name, &numbers)).collect()
}

/// Some bodies of one name, taken together.
fn part(bodies: &Bodies, name: &str, numbers: &[usize]) -> PartReport {
    let own = || numbers.iter().map(|&n| &bodies.bodies[n]);
    let SurfaceArea { frontal, wetted } = areas_of(bodies, own());
    PartReport {
        name: name.to_owned(),
        volume: own().map(|b| b.volume).sum(),
        frontal_area: frontal,
        wetted_area: wetted,
        bounds: own().map(|b| b.bounds).reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]).unwrap_or_default(),
    }
}

/// The bodies of each name in a file, in the order in which the names come first.
fn of_file<'a>(bodies: &'a Bodies, file: &'a Diagnosis) -> impl Iterator<Item = SolidReport> {
    by_name(bodies, file.body_range.clone()).into_iter().map(|(name, numbers)| {
        let PartReport { name, volume, frontal_area, wetted_area, bounds } = part(bodies, name, &numbers);
        let about = SolidSummary {
            scene: file.file.clone(),
            name,
            shape: "file",
            porosity: 0.0,
            copies: 1,
            bodies: numbers[0]..numbers[numbers.len() - 1] + 1,
            volume,
            bounds,
        };
        SolidReport { about, frontal_area, wetted_area, parts: Vec::new() }
    })
}

/// The areas of some bodies, each alone.
fn areas_of<'a>(bodies: &Bodies, own: impl Iterator<Item = &'a Body>) -> SurfaceArea<f64> {
    let area = own.map(|body| areas::of_body(body, &bodies.triangles[body.triangles.clone()]));
    area.fold(SurfaceArea::default(), SurfaceArea::plus)
}
