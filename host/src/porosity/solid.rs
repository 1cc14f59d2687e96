//! The layers of the bodies that are solid, for what is measured beside their porosity.

use super::shadows;
use super::solid_layers::SolidLayers;
use super::surface_fields::SurfaceFields;
use super::surface_layers::of_layers;
use super::{FieldSet, Options, Porosity, levels, local, porosity, snap, surfaces};
use crate::geometry::bodies::{Bodies, Body, Doubt};
use crate::geometry::{areas, facets};
use glam::DVec3;
use rayon::prelude::*;
use std::sync::Arc;
use voidage_core::grid::Grid;
use voidage_core::surface::bins::Group;
use voidage_core::surface::layer::Layers;

/// Work with the surface of the bodies that are solid and with their open fractions; `result` holds the porosities of all bodies.
pub(super) fn with_solid_surface<T>(
    grid: &Grid<f64>,
    bodies: &Bodies,
    result: &Porosity,
    options: Options,
    work: impl FnOnce(&SurfaceFields, &FieldSet) -> T,
) -> T {
    let alone = solid_alone(grid, bodies, options);
    let Porosity { beta, surface, .. } = alone.as_ref().unwrap_or(result);
    let found = surface.clone().unwrap_or_else(|| {
        with_solid_layers(grid, bodies, options, |grid, solids| Arc::new(of_layers(grid, solids, options, beta)))
    });
    work(&found, beta)
}

/// Porosities of the solid bodies alone, if there are others: the unions of several levels are mixed into the porosities.
fn solid_alone(grid: &Grid<f64>, bodies: &Bodies, options: Options) -> Option<Porosity> {
    (levels(bodies) != [0.0]).then(|| up_to(grid, bodies, 0.0, options).1)
}

/// The bodies up to a level, as if they were solid, and their porosities and surface.
pub(super) fn up_to(grid: &Grid<f64>, bodies: &Bodies, level: f64, options: Options) -> (Bodies, Porosity) {
    let mut union = bodies.clone();
    union.bodies.retain(|body| body.porosity <= level);
    union.bodies.iter_mut().for_each(|body| body.porosity = 0.0);
    let found = porosity(grid, &union, Options { bounds: false, areas: true, resistance: true, ..options });
    (union, found)
}

/// Work with the layers of the bodies that are solid, those without triangles as facets; both as seen from the grid's corner, if that is far.
pub(super) fn with_solid_layers<T>(
    grid: &Grid<f64>,
    bodies: &Bodies,
    options: Options,
    work: impl FnOnce(&Grid<f64>, &SolidLayers) -> T,
) -> T {
    let moved = snap::into_planes(grid, bodies);
    let triangles = moved.as_deref().unwrap_or(&bodies.triangles);
    match local::from_corner(grid, bodies, triangles) {
        Some((edges, seen)) => {
            let near = edges.grid(None).expect("edges apart stay apart");
            with_layers_of(&near, &seen, &seen.triangles, options, |solids| work(&near, solids))
        }
        None => with_layers_of(grid, bodies, triangles, options, |solids| work(grid, solids)),
    }
}

/// Work with the layers of the solid bodies, whose corners are in the planes of the grid.
fn with_layers_of<T>(
    grid: &Grid<f64>,
    bodies: &Bodies,
    triangles: &[[DVec3; 3]],
    options: Options,
    work: impl FnOnce(&SolidLayers) -> T,
) -> T {
    let solid = |b: &Body| b.porosity == 0.0 && b.doubt != Doubt::Unknown;
    // Ends of pipes and bends, too, lie in the planes that they miss by rounding.
    let planes = snap::ToPlanes::new(grid);
    let miss = shadows::facets_miss(grid);
    let in_planes = |body: &Body| {
        let facets = facets::close_to_body(body, miss).unwrap_or_default();
        facets.into_iter().map(|triangle| planes.moved(triangle, body)).collect()
    };
    let curved: Vec<Vec<[DVec3; 3]>> = bodies.bodies.par_iter().map(in_planes).collect();
    let own_triangles = |n: usize, body: &Body| match &curved[n][..] {
        _ if !solid(body) => &[],
        [] => &triangles[body.triangles.clone()],
        curved => curved,
    };
    let (surfaces, _) = surfaces(bodies, own_triangles);
    let needed = Layers::needed(grid, &surfaces);
    let (mut numbers, mut groups) = (vec![0; needed.numbers], vec![Group::default(); needed.groups]);
    let layers = Layers::new(grid, &surfaces, options.into(), &mut numbers, &mut groups).expect("memory as needed");
    let facet_error = areas::facet_error(bodies.bodies.iter().zip(&curved));
    work(&SolidLayers { bodies, layers: &layers, facet_error })
}
