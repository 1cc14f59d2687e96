//! What was found.

use super::fields::FieldSet;
use super::snap::OffPlanes;
use super::surface_fields::SurfaceFields;
use std::sync::Arc;
use voidage_core::grid::Grid;

/// Cells by kind.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct CellCounts {
    /// No solid.
    pub open: usize,
    /// Partly solid, or with surface inside.
    pub cut: usize,
    /// All solid.
    pub closed: usize,
    /// Of the cut cells: shared by several bodies, so that their union had to be found.
    pub ambiguous: usize,
}

/// How often GJK was asked.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Gjk {
    /// Queries.
    pub queries: u64,
    /// Of these, without an answer: work, not error.
    pub undecided: u64,
}

/// Where a body's surface fails to close.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Leak {
    /// The body.
    pub body: usize,
    /// How far the worst row ends from zero, as a fraction of a face.
    pub fraction: f64,
    /// Its layer of cells.
    pub layer: usize,
}

/// Porosities of a grid.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Porosity {
    /// Open fractions: 1 open, 0 blocked.
    pub beta: FieldSet,
    /// Lower and upper bounds of the same, if asked for.
    pub bounds: Option<[FieldSet; 2]>,
    /// Cells by kind.
    pub cells: CellCounts,
    /// Solid volume within the grid.
    pub solid_volume: f64,
    /// No bounds of a cell or face are further apart; with porous solids, lowered faces or holes the furthest may be closer.
    pub max_gap: f64,
    /// Cells divided because their union had no proof at once.
    pub divided: usize,
    /// By how much a body's own share of a cell left 0..1: surface that crosses itself.
    pub winding: f64,
    /// Sheets that block nothing, for they lie in no plane of the grid.
    pub sheets_off_planes: OffPlanes,
    /// Bodies that went by subdivision, of all.
    pub subdivided: usize,
    /// Bodies that went by closed forms, of all.
    pub by_formula: usize,
    /// Queries of GJK.
    pub gjk: Gjk,
    /// Bodies whose rows did not return to zero, worst first, one entry a body.
    pub leaks: Vec<Leak>,
    /// Areas and shadows of the surface, if they were asked for and come with the porosity: of solid bodies that go by their surface.
    pub surface: Option<Arc<SurfaceFields>>,
}

impl Porosity {
    /// Bounds of the solid volume within the grid, the sums of those of its cells, if they were asked for.
    #[must_use]
    pub fn solid_volume_bounds(&self, grid: &Grid<f64>) -> Option<[f64; 2]> {
        let [most_solid, least_solid] = self.bounds.as_ref()?;
        let [low, high] = [least_solid, most_solid].map(|set| set.blocked_volume(grid));
        // Sums of equal terms in another order may differ by rounding.
        Some([low.min(self.solid_volume), high.max(self.solid_volume)])
    }

    /// Adds what another union of the same bodies has cost, and takes over where its bodies fail to close.
    pub(super) fn add_work(&mut self, other: &Porosity) {
        self.divided += other.divided;
        self.gjk.queries += other.gjk.queries;
        self.gjk.undecided += other.gjk.undecided;
        self.winding = self.winding.max(other.winding);
        (self.subdivided, self.by_formula) = (other.subdivided, other.by_formula);
        self.leaks.clone_from(&other.leaks);
    }
}
