//! What stands in the way of the gas: frontal area, wetted area and lengths of the obstacles in every cell.

use super::shadows::{HIDDEN, Shadows, faces_of_nth_cell, place_of_cell};
use super::solid::{up_to, with_solid_surface};
use super::surface_fields::SurfaceFields;
use super::throat::Faces;
use super::{FieldSet, Options, Porosity, levels};
use crate::geometry::bodies::Bodies;
use std::sync::Arc;
use voidage_core::grid::Grid;
use voidage_core::surface::surface_area::SurfaceArea;

/// Obstacles in the cells of a grid, `nx*ny*nz`, x fastest, and their totals. Of solids that are porous themselves nothing is counted.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Resistance {
    /// Frontal area density along x, y and z in 1/m: ½ ∫ |n_i| dA / V over the surface of the union inside the cell.
    pub a: [Vec<f64>; 3],
    /// Wetted area density in 1/m: ∫ dA / V.
    pub s: Vec<f64>,
    /// Hydraulic diameter 4 β_v / s in m; 0 in cells without surface.
    pub d_h: Vec<f64>,
    /// Mean size of the obstacles 4 (1 − β_v) / s in m: of a pipe its diameter; 0 in cells without surface.
    pub l_obs: Vec<f64>,
    /// Shadows along x, y and z.
    pub shadows: Arc<Shadows>,
    /// Totals.
    pub totals: Totals,
}

/// Areas within the grid, in m².
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Totals {
    /// Frontal area of the union along x, y and z, without surface in the planes of the grid.
    pub frontal_area: [f64; 3],
    /// Wetted area of the union.
    pub wetted_area: f64,
    /// Frontal areas of all bodies added up, whether they overlap or not.
    pub frontal_area_of_bodies: [f64; 3],
    /// Likewise wetted areas.
    pub wetted_area_of_bodies: f64,
    /// Cells shared by bodies whose union has no proof.
    pub unproved: usize,
    /// The largest wetted area in doubt in one of them.
    pub max_doubt: f64,
    /// The largest share by which facets miss one of the areas of a whole curved body: they stand for it in cells that it shares with others.
    pub facet_error: f64,
}

/// The obstacles among `bodies` on `grid`; `result` holds their porosities, faces included. Runs in the current rayon pool.
#[must_use]
pub fn resistance(grid: &Grid<f64>, bodies: &Bodies, result: &Porosity, options: Options) -> Resistance {
    with_solid_surface(grid, bodies, result, options, |surface, beta| Resistance {
        totals: totals(surface),
        shadows: surface.shadows.clone(),
        ..densities(grid, &beta.v, &surface.areas)
    })
}

/// The shadows of the solid bodies among `bodies` on `grid`, as [`resistance`] finds them.
fn solid_shadows(grid: &Grid<f64>, bodies: &Bodies, result: &Porosity, options: Options) -> Arc<Shadows> {
    with_solid_surface(grid, bodies, result, options, |surface, _| surface.shadows.clone())
}

/// The shadows of all `bodies` on `grid`, those of porous ones weighted as their blockage is: see [`levels`](super::levels()). `result` holds their
/// porosities, faces included. Runs in the current rayon pool.
#[must_use]
pub fn shadows(grid: &Grid<f64>, bodies: &Bodies, result: &Porosity, options: Options) -> Arc<Shadows> {
    let levels = thinned(levels(bodies));
    if levels == [0.0] {
        return solid_shadows(grid, bodies, result, options);
    }
    let mut all = Shadows::none(grid.cell_count());
    for (k, &level) in levels.iter().enumerate() {
        let (union, measured) = up_to(grid, bodies, level, options);
        let weight = levels.get(k + 1).unwrap_or(&1.0) - level;
        all.add(weight, &solid_shadows(grid, &union, &measured, options));
    }
    all.find_hidden(grid, &result.beta);
    Arc::new(all)
}

/// Different porosities that shadows are told apart for.
const MOST_LEVELS: usize = 16;

/// At most so many levels, the lowest and the highest among them: of others, neighbours count as one, with the higher porosity.
fn thinned(mut levels: Vec<f64>) -> Vec<f64> {
    let (last, mut n) = (levels.len() - 1, 0);
    levels.retain(|_| {
        let place = |n: usize| n * (MOST_LEVELS - 1) / last.max(1);
        let kept = n == last || last < MOST_LEVELS || n == 0 || place(n) != place(n + 1);
        n += 1;
        kept
    });
    levels
}

/// Totals in the order of cells, so that their bits do not depend on the number of threads.
fn totals(SurfaceFields { areas, sum, unproved, max_doubt, facet_error, .. }: &SurfaceFields) -> Totals {
    let union = areas.iter().fold(SurfaceArea::default(), |total, (_, area)| total.plus(*area));
    Totals {
        frontal_area: union.frontal,
        wetted_area: union.wetted,
        frontal_area_of_bodies: sum.frontal,
        wetted_area_of_bodies: sum.wetted,
        unproved: *unproved,
        max_doubt: *max_doubt,
        facet_error: *facet_error,
    }
}

/// Frontal area along x, y and z in m² that no face shows: where lines enter solid and leave it again in one cell. With `beta`, the open fractions in the
/// planes of faces, the pressure of a cell pushes on what its two faces differ by; walls that [`Faces::Throat`] makes tight are pushed from both sides.
#[must_use]
pub fn unseen_frontal_area(grid: &Grid<f64>, beta: &FieldSet, found: &Resistance, faces: Faces) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for &n in &found.shadows.standing {
        let Some(cell) = grid.cell_box(place_of_cell(grid, n)) else { continue };
        let (size, volume) = (cell.size(), cell.size().element_product());
        for axis in 0..3 {
            let [low, high] = faces_of_nth_cell(grid, axis, n).map(|face| beta.faces(axis)[face]);
            let is_tight = faces == Faces::Throat && found.shadows.tau[axis][n] > HIDDEN;
            let seen = 0.5 * (high - low).abs() * (volume / size[axis]);
            sum[axis] += if is_tight { 0.0 } else { (found.a[axis][n] * volume - seen).max(0.0) };
        }
    }
    sum
}

/// Less solid than this, as a share of a cell, is rounding.
const ROUNDING: f64 = 2e-13;

/// Less surface than this, in the largest side of a cell, is rounding.
const DUST: f64 = 1e-13;

/// Areas over volumes, and the lengths that follow.
fn densities(grid: &Grid<f64>, open: &[f64], union: &[(usize, SurfaceArea<f64>)]) -> Resistance {
    let zeros = || vec![0.0; open.len()];
    let mut found = Resistance { a: [zeros(), zeros(), zeros()], s: zeros(), d_h: zeros(), ..Resistance::default() };
    found.l_obs = zeros();
    for &(n, area) in union.iter().filter(|(_, area)| area.wetted > 0.0) {
        let Some(cell) = grid.cell_box(place_of_cell(grid, n)) else { continue };
        let (size, volume) = (cell.size(), cell.size().element_product());
        if area.wetted < DUST * volume / size.min_element() {
            continue;
        }
        let area = area.times(volume.recip());
        found.a.iter_mut().zip(area.frontal).for_each(|(a, f)| a[n] = f);
        found.s[n] = area.wetted;
        found.d_h[n] = 4.0 * open[n] / area.wetted;
        // What rounding leaves of a solid has no size.
        let solid = 1.0 - open[n];
        found.l_obs[n] = if solid > ROUNDING { 4.0 * solid / area.wetted } else { 0.0 };
    }
    found
}
