//! How congested a plant is: blockage and length of obstacles by diameter, zone by zone.
//!
//! Obstacles are whole bodies, each with one diameter and one length ([`super::rod`]); the cells of the grid do not matter. Of a body that a zone cuts the zone
//! has what lies in it, and of its length the share that it has of its volume.

use super::rod::Rod;
use super::shadows::place_of_cell;
use super::{Options, Porosity, porosity};
use crate::geometry::areas;
use crate::geometry::bodies::{Bodies, Body, Doubt};
use crate::geometry::facets;
use crate::grid::Edges;
use glam::DVec3;
use rayon::prelude::*;
use voidage_core::grid::Grid;
use voidage_core::number::aabb::Aabb;
use voidage_core::surface::clip::{Polygon, keep};
use voidage_core::surface::surface_area::SurfaceArea;

/// A box of the plant.
#[derive(Debug, Clone, PartialEq)]
pub struct Zone {
    /// Its name.
    pub name: String,
    /// The box, in m.
    pub bounds: Aabb<DVec3>,
}

/// What stands in a zone, as far as it lies in the grid.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Congestion {
    /// The zone.
    pub zone: String,
    /// Lowest and highest corner in m.
    pub bounds: [DVec3; 2],
    /// What of it lies in the grid, in m³.
    pub volume: f64,
    /// Solid volume in that, of the union, in m³.
    pub solid_volume: f64,
    /// By diameter of the obstacles; classes without any are left out.
    pub sizes: Vec<SizeClass>,
}

/// Obstacles of some sizes, each counted by itself.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SizeClass {
    /// Diameter above this, in m.
    pub above: f64,
    /// Up to this, in m; none for the last class.
    pub to: Option<f64>,
    /// How many bodies, whole or in part.
    pub bodies: usize,
    /// Their volume in m³.
    pub solid_volume: f64,
    /// Their frontal area along x, y and z in m².
    pub frontal_area: [f64; 3],
    /// Frontal area over the section of the zone across x, y and z: how many of these obstacles a line through the zone meets.
    pub blockage: [f64; 3],
    /// Their length in m.
    pub length: f64,
}

/// A diameter that is beyond the end of its class by no more than this share is of that class: coordinates are rounded, pipes made of facets.
const SLACK: f64 = 1e-3;

/// Of which less than this share lies in a zone, a body touches it but for rounding.
const TRACE: f64 = 1e-9;

/// Ends of the classes in m.
const SIZES: [f64; 7] = [0.025, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0];

/// What stands in each zone; `result` holds the porosities on the grid. Of solids that are porous themselves nothing is counted by size.
#[must_use]
pub fn congestion(
    grid: &Grid<f64>,
    bodies: &Bodies,
    zones: &[Zone],
    result: &Porosity,
    options: Options,
) -> Vec<Congestion> {
    let obstacles: Vec<Obstacle> =
        bodies.bodies.par_iter().enumerate().filter_map(|(n, body)| Obstacle::new(bodies, n, body)).collect();
    zones.iter().map(|zone| of_zone(grid, bodies, (zone, &obstacles), result, options)).collect()
}

fn of_zone(
    grid: &Grid<f64>,
    bodies: &Bodies,
    (zone, obstacles): (&Zone, &[Obstacle]),
    result: &Porosity,
    options: Options,
) -> Congestion {
    let whole = grid.bounds();
    let within = Aabb { min: zone.bounds.min.max(whole.min), max: zone.bounds.max.min(whole.max) };
    let extent = within.size().max(DVec3::ZERO);
    let mut classes: [SizeClass; SIZES.len() + 1] = std::array::from_fn(|n| SizeClass {
        above: n.checked_sub(1).map_or(0.0, |n| SIZES[n]),
        to: SIZES.get(n).copied(),
        ..SizeClass::default()
    });
    let parts: Vec<_> = obstacles.par_iter().map(|obstacle| obstacle.within(bodies, within, options)).collect();
    // In the order of bodies, so that the bits do not depend on the number of threads.
    for (obstacle, part) in obstacles.iter().zip(parts) {
        let Some(Part { share, frontal }) = part else { continue };
        let class = &mut classes[SIZES.partition_point(|&end| end * (1.0 + SLACK) < obstacle.rod.diameter)];
        class.bodies += 1;
        class.solid_volume += share * obstacle.volume;
        class.length += share * obstacle.rod.length;
        class.frontal_area.iter_mut().zip(frontal).for_each(|(sum, area)| *sum += area);
    }
    for class in &mut classes {
        let across = |axis: usize| extent[(axis + 1) % 3] * extent[(axis + 2) % 3];
        class.blockage = [0, 1, 2].map(|a| if across(a) > 0.0 { class.frontal_area[a] / across(a) } else { 0.0 });
    }
    let solid_volume = if within == whole { solid(grid, result) } else { solid_within(grid, bodies, within, options) };
    Congestion {
        zone: zone.name.clone(),
        bounds: [zone.bounds.min, zone.bounds.max],
        volume: extent.element_product(),
        solid_volume: solid_volume + 0.0, // a sum of nothing is −0
        sizes: classes.into_iter().filter(|class| class.bodies > 0).collect(),
    }
}

/// Solid volume on a grid.
fn solid(grid: &Grid<f64>, result: &Porosity) -> f64 {
    let cell = |n: usize| grid.cell_box(place_of_cell(grid, n)).map_or(0.0, |c| c.size().element_product());
    result.beta.v.iter().enumerate().filter(|(_, open)| **open < 1.0).map(|(n, open)| (1.0 - open) * cell(n)).sum()
}

/// Solid volume in a box, on the cells of the grid that it cuts.
fn solid_within(grid: &Grid<f64>, bodies: &Bodies, within: Aabb<DVec3>, options: Options) -> f64 {
    let edges = Edges([0, 1, 2].map(|axis| {
        let [lo, hi] = [within.min[axis], within.max[axis]];
        // A plane that is one with a side but for rounding would leave cells of no width.
        let apart = (hi - lo) * TRACE;
        let between = grid.edges(axis).iter().copied().filter(|&e| e > lo + apart && e < hi - apart);
        std::iter::once(lo).chain(between).chain([hi]).collect()
    }));
    solid_between(&edges, bodies, options)
}

/// Solid volume in the cells between edges; 0 if these make no grid.
fn solid_between(edges: &Edges, bodies: &Bodies, options: Options) -> f64 {
    let options = Options { bounds: false, areas: false, resistance: false, ..options };
    edges.grid(None).map_or(0.0, |own| solid(&own, &porosity(&own, bodies, options)))
}

/// A body as it stands alone.
struct Obstacle {
    number: usize,
    rod: Rod,
    volume: f64,
    area: SurfaceArea<f64>,
    bounds: Aabb<DVec3>,
}

/// What a box holds of a body: a share of its volume, and frontal areas along x, y, z in m².
struct Part {
    share: f64,
    frontal: [f64; 3],
}

impl Obstacle {
    /// Of a body that is solid and of which something is known.
    fn new(bodies: &Bodies, number: usize, body: &Body) -> Option<Self> {
        if body.porosity > 0.0 || body.doubt == Doubt::Unknown {
            return None;
        }
        let own = &bodies.triangles[body.triangles.clone()];
        let area = areas::of_body(body, own);
        let rod = Rod::of_body(body, own, &area);
        let [min, max] = body.bounds;
        Some(Obstacle { number, rod, volume: body.volume, area, bounds: Aabb { min, max } })
    }

    /// What a box holds of it; none if that is nothing.
    fn within(&self, bodies: &Bodies, within: Aabb<DVec3>, options: Options) -> Option<Part> {
        // What is known of the ends of a curved body is rounded away from it: where it touches a side it ends there.
        let trace = self.bounds.size() * TRACE;
        let Aabb { min, max } = Aabb { min: self.bounds.min + trace, max: self.bounds.max - trace };
        if min.cmpge(within.min).all() && max.cmple(within.max).all() {
            return Some(Part { share: 1.0, frontal: self.area.frontal });
        }
        if !(min.cmplt(within.max).all() && max.cmpgt(within.min).all()) {
            return None;
        }
        let body = &bodies.bodies[self.number];
        let curved = facets::of_body(body);
        let own = curved.as_deref().unwrap_or(&bodies.triangles[body.triangles.clone()]);
        let (all, cut) = (areas::of_triangles(own), areas_within(own, within));
        let share = if self.volume > 0.0 {
            self.volume_within(bodies, within, options) / self.volume
        } else {
            cut.wetted / all.wetted
        };
        // Facets miss the areas of a curved body by the same share everywhere, about.
        let frontal = [0, 1, 2].map(|axis| {
            let [cut, all, whole] = [cut, all, self.area].map(|area| area.frontal[axis]);
            if all > 0.0 { cut * (whole / all) } else { 0.0 }
        });
        (share > TRACE || frontal.iter().zip(self.area.frontal).any(|(part, all)| *part > TRACE * all))
            .then_some(Part { share: share.clamp(0.0, 1.0), frontal })
    }

    fn volume_within(&self, bodies: &Bodies, within: Aabb<DVec3>, options: Options) -> f64 {
        let body = &bodies.bodies[self.number];
        let triangles = bodies.triangles[body.triangles.clone()].to_vec();
        let alone = Body { triangles: 0..triangles.len(), ..body.clone() };
        let alone = Bodies { triangles, bodies: vec![alone], ..Bodies::default() };
        let edges = Edges([0, 1, 2].map(|axis| vec![within.min[axis], within.max[axis]]));
        solid_between(&edges, &alone, options)
    }
}

/// Areas of the surface in a box. What lies in the plane of a side counts if the solid is within.
fn areas_within(triangles: &[[DVec3; 3]], within: Aabb<DVec3>) -> SurfaceArea<f64> {
    let mut sum = SurfaceArea::default();
    let (mut part, mut kept) = (Polygon::default(), Polygon::default());
    for corners in triangles {
        part.set(&corners.map(|p| p.to_array()));
        for (axis, (at, above)) in
            (0..3).flat_map(|axis| [(axis, (within.min[axis], true)), (axis, (within.max[axis], false))])
        {
            keep(&part, axis, at, above, &mut kept);
            std::mem::swap(&mut part, &mut kept);
        }
        let doubled = DVec3::from_array(part.doubled_area());
        let looks_in = (0..3).any(|axis| {
            let (lo, hi) = part.extent(axis);
            lo == hi
                && ((lo == within.min[axis] && doubled[axis] > 0.0) || (lo == within.max[axis] && doubled[axis] < 0.0))
        });
        if !looks_in {
            sum = sum.plus(SurfaceArea { frontal: (doubled.abs() * 0.25).to_array(), wetted: doubled.length() * 0.5 });
        }
    }
    sum
}
