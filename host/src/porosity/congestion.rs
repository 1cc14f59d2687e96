//! How congested a plant is: blockage and length of obstacles by diameter, zone by zone.

use super::Porosity;
use super::resistance::Resistance;
use super::shadows::cells;
use glam::DVec3;
use voidage_core::grid::Grid;

/// A box of the plant.
#[derive(Debug, Clone, PartialEq)]
pub struct Zone {
    /// Its name.
    pub name: String,
    /// Lowest and highest corner in m.
    pub bounds: [DVec3; 2],
}

/// What stands in a zone.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Congestion {
    /// The zone.
    pub zone: String,
    /// Lowest and highest corner in m.
    pub bounds: [DVec3; 2],
    /// Cells with their centre in the zone.
    pub cells: usize,
    /// Volume of those cells in m³.
    pub volume: f64,
    /// Solid volume in them in m³.
    pub solid_volume: f64,
    /// By mean obstacle size of the cells; sizes that do not occur are left out.
    pub sizes: Vec<SizeClass>,
}

/// Obstacles of some sizes.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SizeClass {
    /// Mean obstacle size above this, in m.
    pub above: f64,
    /// Up to this, in m; none for the last class.
    pub to: Option<f64>,
    /// Solid volume in m³.
    pub solid_volume: f64,
    /// Frontal area along x, y and z in m².
    pub frontal_area: [f64; 3],
    /// Frontal area over the section of the zone across x, y and z: how many of these obstacles a line through the zone meets.
    pub blockage: [f64; 3],
    /// Wetted area over π times the size, in m: of pipes their length.
    pub length: f64,
}

/// A size that is beyond the end of its class by no more than this share is of that class: pipes are often made of facets.
const SLACK: f64 = 1e-3;

/// Cells with less solid than this share have none but for rounding: what touches them has no size there.
const TRACE: f64 = 1e-9;

/// Ends of the classes in m.
const SIZES: [f64; 7] = [0.025, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0];

/// What stands in each zone. A cell counts for every zone that its centre lies in.
#[must_use]
pub fn congestion(grid: &Grid<f64>, zones: &[Zone], result: &Porosity, obstacles: &Resistance) -> Vec<Congestion> {
    zones.iter().map(|zone| of_zone(grid, zone, result, obstacles)).collect()
}

fn of_zone(grid: &Grid<f64>, zone: &Zone, result: &Porosity, obstacles: &Resistance) -> Congestion {
    let [lo, hi] = zone.bounds;
    let mut classes = [SizeClass::default(); SIZES.len() + 1];
    let (mut count, mut volume, mut solid_volume) = (0, 0.0, 0.0);
    for (n, at) in cells(grid).enumerate() {
        let Some(cell) = grid.cell_box(at) else { continue };
        let centre = (cell.min + cell.max) * 0.5;
        if !(centre.cmpge(lo).all() && centre.cmple(hi).all()) {
            continue;
        }
        let size = cell.size().element_product();
        let solid = (1.0 - result.beta.v[n]) * size;
        (count, volume, solid_volume) = (count + 1, volume + size, solid_volume + solid);
        let length = obstacles.l_obs[n];
        if length > 0.0 && 1.0 - result.beta.v[n] > TRACE {
            let class = &mut classes[SIZES.partition_point(|&end| end * (1.0 + SLACK) < length)];
            class.solid_volume += solid;
            class.length += obstacles.s[n] * size / (std::f64::consts::PI * length);
            class.frontal_area.iter_mut().zip(&obstacles.a).for_each(|(sum, a)| *sum += a[n] * size);
        }
    }
    // A zone beyond the grid holds no more than the grid.
    let whole = grid.bounds();
    let extent = (hi.min(whole.max) - lo.max(whole.min)).max(DVec3::ZERO);
    for (n, class) in classes.iter_mut().enumerate() {
        (class.above, class.to) = (n.checked_sub(1).map_or(0.0, |n| SIZES[n]), SIZES.get(n).copied());
        let across = |axis: usize| extent[(axis + 1) % 3] * extent[(axis + 2) % 3];
        class.blockage = [0, 1, 2].map(|a| if across(a) > 0.0 { class.frontal_area[a] / across(a) } else { 0.0 });
    }
    let sizes = classes.into_iter().filter(|c| c.length > 0.0).collect();
    Congestion { zone: zone.name.clone(), bounds: zone.bounds, cells: count, volume, solid_volume, sizes }
}
