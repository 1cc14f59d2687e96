//! Porosity in single precision, by the public interface of the core: what a solver gets that links it in `f32`.

use super::spread::{Spread, timed};
use crate::error::{Error, Result};
use crate::geometry::bodies::{Bodies, Body};
use crate::geometry::form::Form;
use crate::grid::Edges;
use crate::porosity::Options;
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use voidage_core::convex::shape::{Capsule, Cone, Cylinder, Sphere};
use voidage_core::grid::Grid;
use voidage_core::solids::{RoundMemory, RoundShape, RoundSolid, RoundSolids};
use voidage_core::subdivide::{LeafRule, SubdivisionMemory, SubdivisionRule};
use voidage_core::surface::bins::Surface;
use voidage_core::surface::layer::{LayerMemory, LayerOptions, LayerSlices, Layers};
use voidage_core::surface::union::UnionBuffers;

/// Fields of a grid: cells, x, y and z faces (the top plane last), the solid volume and the largest distance of bounds.
#[derive(Debug, Default)]
pub struct SingleFields {
    /// Open fractions of cells, x, y and z faces.
    pub beta: [Vec<f32>; 4],
    /// In m³, summed over layers in double precision.
    pub volume: f64,
    /// Largest distance of the bounds of a value.
    pub gap: f64,
}

/// Pieces that the union in one cell may have.
const PIECES: usize = 256;

/// One layer's share of the fields.
type LayerOf<'a> = (usize, LayerSlices<'a, f32>);

/// A scene as the core takes it in `f32`.
struct SingleScene {
    edges: [Vec<f32>; 3],
    triangles: Vec<[Vec3; 3]>,
    /// For each body of triangles its run, and whether it is a sheet.
    runs: Vec<(std::ops::Range<usize>, bool)>,
    round: Vec<RoundSolid<Vec3>>,
}

/// The fields of a scene and the times that they take in the current pool of threads; reading and rounding to `f32` do not count.
///
/// # Errors
/// A body that the core does not take by itself, or a grid whose edges fall together in `f32`.
pub fn fields(bodies: &Bodies, edges: &Edges, options: Options, repeats: usize) -> Result<(SingleFields, Spread)> {
    let scene = scene(bodies, edges)?;
    timed(repeats, || scene.fields(options))
}

/// All bodies can be measured so.
///
/// # Errors
/// The first that cannot.
pub fn possible(bodies: &Bodies) -> Result<()> {
    let fails =
        |body: &&Body| body.porosity > 0.0 || body.triangles.is_empty() && body.form.as_ref().and_then(round).is_none();
    match bodies.bodies.iter().find(fails) {
        Some(body) => Err(Error::new(format!("body \"{}\" is porous or has no formula in f32", body.name))),
        None => Ok(()),
    }
}

fn scene(bodies: &Bodies, edges: &Edges) -> Result<SingleScene> {
    let point = |p: &DVec3| p.as_vec3();
    let mut scene = SingleScene {
        edges: edges.0.each_ref().map(|e| e.iter().map(|&x| x as f32).collect()),
        triangles: bodies.triangles.iter().map(|t| t.each_ref().map(point)).collect(),
        runs: Vec::new(),
        round: Vec::new(),
    };
    for body in &bodies.bodies {
        if body.triangles.is_empty() {
            let solid = body.form.as_ref().and_then(round).and_then(RoundSolid::new);
            let none = || Error::new(format!("body \"{}\" has no formula in f32", body.name));
            scene.round.push(solid.ok_or_else(none)?);
        } else {
            let Body { triangles, sheet, .. } = body;
            scene.runs.push((triangles.clone(), *sheet));
        }
    }
    Ok(scene)
}

/// A round shape in `f32`.
fn round(form: &Form) -> Option<RoundShape<Vec3>> {
    Some(match form {
        Form::Sphere(s) => RoundShape::Sphere(Sphere { center: s.center.as_vec3(), radius: s.radius as f32 }),
        Form::Cylinder(c) => {
            let [from, to] = c.ends().map(|p| p.as_vec3());
            RoundShape::Cylinder(Cylinder::new(from, to, c.base_radius() as f32))
        }
        Form::Capsule(c) => {
            RoundShape::Capsule(Capsule { from: c.from.as_vec3(), to: c.to.as_vec3(), radius: c.radius as f32 })
        }
        Form::Cone(c) => {
            let [base, top] = c.ends().map(|p| p.as_vec3());
            RoundShape::Cone(Cone::truncated(base, top, c.base_radius() as f32, c.top_radius() as f32))
        }
        _ => return None,
    })
}

impl SingleScene {
    fn fields(&self, options: Options) -> Result<SingleFields> {
        let [x, y, z] = &self.edges;
        let grid = Grid::new(x, y, z).map_err(|e| Error::new(format!("the grid in f32: {e}")))?;
        let surface = |(run, sheet): &(std::ops::Range<usize>, bool)| {
            let own = self.triangles.get(run.clone()).unwrap_or_default();
            if *sheet { Surface::sheet(own) } else { Surface::new(own) }
        };
        let surfaces: Vec<Surface<Vec3>> = self.runs.iter().map(surface).collect();
        let rule = LayerOptions { tol: options.tol as f32, depth: options.depth, areas: options.areas, solid_end: 0.5 };
        let needed = Layers::needed(&grid, &surfaces);
        let (mut numbers, mut groups) = (vec![0; needed.numbers], vec![Default::default(); needed.groups]);
        let layers = Layers::new(&grid, &surfaces, rule, &mut numbers, &mut groups)
            .map_err(|e| Error::new(format!("bodies in f32: {e}")))?;
        let faces = |axis| vec![0.0; if options.areas { grid.face_shape(axis).iter().product() } else { 0 }];
        let mut found = SingleFields {
            beta: [vec![0.0; grid.cell_count()], faces(0), faces(1), faces(2)],
            ..SingleFields::default()
        };
        let own = self.slices(&grid, &mut found.beta);
        let threads = rayon::current_num_threads().max(1);
        let count = own.len().div_ceil(threads).max(1);
        let mut shares: Vec<Vec<LayerOf>> = (0..own.len().div_ceil(count)).map(|_| Vec::new()).collect();
        let workers = shares.len().max(1);
        // Neighbouring layers cost alike: deal them out in turn.
        for (n, layer) in own.into_iter().enumerate() {
            if let Some(share) = shares.get_mut(n % workers) {
                share.push(layer);
            }
        }
        let sums: Vec<Result<(f64, f64)>> =
            shares.into_par_iter().map(|share| self.share(&grid, &layers, share, options)).collect();
        for sum in sums {
            let (volume, gap) = sum?;
            (found.volume, found.gap) = (found.volume + volume, found.gap.max(gap));
        }
        Ok(found)
    }

    /// The fields cut into layers.
    fn slices<'a>(&self, grid: &Grid<f32>, [v, x, y, z]: &'a mut [Vec<f32>; 4]) -> Vec<LayerOf<'a>> {
        let [nx, ny, nz] = grid.cells();
        let (mut v, mut x, mut y, mut z) = (&mut v[..], &mut x[..], &mut y[..], &mut z[..]);
        let mut layers = Vec::with_capacity(nz);
        for k in 0..nz {
            let cell = v.split_off_mut(..nx * ny).unwrap_or_default();
            let x = x.split_off_mut(..(nx + 1) * ny).unwrap_or_default();
            let y = y.split_off_mut(..nx * (ny + 1)).unwrap_or_default();
            let low = z.split_off_mut(..nx * ny).unwrap_or_default();
            let top = if k + 1 == nz { std::mem::take(&mut z) } else { &mut [] };
            layers.push((k, LayerSlices::new(cell, x, y, low, top)));
        }
        layers
    }

    /// Some layers on one thread: solid volume and largest distance of bounds.
    fn share(
        &self,
        grid: &Grid<f32>,
        layers: &Layers<Vec3>,
        share: Vec<LayerOf>,
        options: Options,
    ) -> Result<(f64, f64)> {
        let wrong = |e: &dyn std::fmt::Display| Error::new(format!("in f32: {e}"));
        let needed = RoundSolids::<Vec3>::needed(grid, self.round.len());
        let (mut sums, mut owners) = (vec![0.0; needed.places], vec![0; needed.places]);
        let (mut near, mut facets) = (vec![Default::default(); needed.near], vec![0; needed.facets]);
        let mut candidates = vec![Default::default(); needed.candidates];
        let lists = SubdivisionMemory { candidates: &mut candidates, facets: &mut facets };
        let memory = RoundMemory { sums: &mut sums, owners: &mut owners, near: &mut near, lists };
        let rule = SubdivisionRule { leaf: LeafRule::Plane, depth: options.depth, tol: options.tol as f32 };
        let mut others = RoundSolids::new(grid, &self.round, rule, memory).map_err(|e| wrong(&e))?;
        let needed = layers.memory_needed();
        let (mut reals, mut flags, mut numbers) =
            (vec![0.0; needed.reals], vec![0; needed.flags], vec![0; needed.numbers]);
        let mut groups = vec![Default::default(); needed.groups];
        let mut union: Box<UnionBuffers<f32, PIECES>> = Box::default();
        let mut memory = LayerMemory::new(grid, &mut reals, &mut flags, &mut numbers, &mut groups, union.memory())
            .map_err(|e| wrong(&e))?;
        let (mut volume, mut gap) = (0.0, 0.0_f64);
        for (k, slices) in share {
            let report =
                layers.zeroed_layer(k, slices, None, &mut memory, &mut others, |_, _| ()).map_err(|e| wrong(&e))?;
            (volume, gap) = (volume + f64::from(report.solid_volume), gap.max(f64::from(report.max_gap)));
        }
        Ok((volume, gap))
    }
}
