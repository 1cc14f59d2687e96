//! The layers of the bodies that are solid, for what is measured beside their porosity.

use super::{FieldSet, Options, Porosity, levels, porosity, snap, surfaces};
use crate::geometry::bodies::{Bodies, Body, Doubt};
use crate::geometry::facets;
use glam::DVec3;
use rayon::prelude::*;
use voidage_core::grid::Grid;
use voidage_core::surface::bins::Group;
use voidage_core::surface::layer::{Layers, OpenLayer};

/// Porosities of the solid bodies alone, if there are others: the unions of several levels are mixed into the porosities.
pub(super) fn solid_alone(grid: &Grid<f64>, bodies: &Bodies, options: Options) -> Option<Porosity> {
    (levels(bodies) != [0.0]).then(|| {
        let mut bodies = bodies.clone();
        bodies.bodies.retain(|b| b.porosity == 0.0);
        porosity(grid, &bodies, Options { bounds: false, areas: true, ..options })
    })
}

/// Work with the layers of the bodies that are solid, those without triangles as facets.
pub(super) fn with_solid_layers<T>(
    grid: &Grid<f64>,
    bodies: &Bodies,
    options: Options,
    work: impl FnOnce(&Layers<DVec3>) -> T,
) -> T {
    let solid = |b: &Body| b.porosity == 0.0 && b.doubt != Doubt::Unknown;
    let moved = snap::into_planes(grid, bodies);
    let triangles = moved.as_deref().unwrap_or(&bodies.triangles);
    let curved: Vec<Vec<[DVec3; 3]>> =
        bodies.bodies.par_iter().map(|body| facets::of_body(body).unwrap_or_default()).collect();
    let own_triangles = |n: usize, body: &Body| match &curved[n][..] {
        _ if !solid(body) => &[],
        [] => &triangles[body.triangles.clone()],
        curved => curved,
    };
    let (surfaces, _) = surfaces(bodies, own_triangles);
    let needed = Layers::needed(grid, &surfaces);
    let (mut numbers, mut groups) = (vec![0; needed.numbers], vec![Group::default(); needed.groups]);
    let layers = Layers::new(grid, &surfaces, options.into(), &mut numbers, &mut groups).expect("memory as needed");
    work(&layers)
}

/// The open fractions of layer `k`.
pub(super) fn open_layer<'a>(grid: &Grid<f64>, k: usize, beta: &'a FieldSet) -> OpenLayer<'a, f64> {
    let [nx, ny, _] = grid.cells();
    let nth = |k: usize, length: usize| k * length..(k + 1) * length;
    OpenLayer {
        cell: &beta.v[nth(k, nx * ny)],
        x: &beta.x[nth(k, (nx + 1) * ny)],
        y: &beta.y[nth(k, nx * (ny + 1))],
        z: &beta.z[nth(k, nx * ny)],
        top: &beta.z[nth(k + 1, nx * ny)],
    }
}
