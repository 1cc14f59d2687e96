//! The surface in the cells of a grid: its areas and shadows, by-products of the sums that give porosity.

use super::shadows::Shadows;
use std::sync::Arc;
use voidage_core::surface::surface_area::SurfaceArea;

/// Areas and shadows of the surface of a union in the cells of a grid.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SurfaceFields {
    /// The cells that have surface, by their numbers in the grid, x fastest, in ascending order; with the areas of the union in m².
    pub areas: Vec<(usize, SurfaceArea<f64>)>,
    /// Areas of all bodies added up, whether they overlap or not.
    pub sum: SurfaceArea<f64>,
    /// Cells shared by bodies whose union has no proof.
    pub unproved: usize,
    /// The largest wetted area in doubt in one of them.
    pub max_doubt: f64,
    /// The largest share by which the facets that stand for curved bodies in cells that they share miss one of the areas of a whole body.
    pub facet_error: f64,
    /// Its shadows.
    pub shadows: Arc<Shadows>,
}
