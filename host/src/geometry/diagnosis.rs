//! What is wrong with a surface, in numbers and sentences.

use glam::DVec3;
use std::ops::Range;

/// What was found in a file's surface, in numbers.
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Diagnosis {
    /// The file.
    pub file: String,
    /// Triangles read.
    pub triangles: usize,
    /// Named solids read.
    pub solids: usize,
    /// Distinct points.
    pub points: usize,
    /// Triangles with two equal corners or no area.
    pub degenerate: usize,
    /// Triangles that repeat another and were dropped.
    pub repeated: usize,
    /// Triangles that are the back of another (double-sided surface) and were dropped.
    pub doubled: usize,
    /// Largest distance by which points were moved to close cracks; 0 if none.
    pub welded_by: f64,
    /// Triangles whose orientation disagreed with their neighbours and were turned.
    pub turned: usize,
    /// Shells (connected surfaces).
    pub shells: usize,
    /// Shells with negative volume that are bodies: turned inside out.
    pub inside_out: usize,
    /// Shells that are cavities.
    pub cavities: usize,
    /// Shells that cannot be oriented.
    pub one_sided: usize,
    /// Shells without volume.
    pub sheets: usize,
    /// Edges without a partner.
    pub boundary_edges: usize,
    /// Of these, edges of T-junctions, which close in space.
    pub t_junction_edges: usize,
    /// Shells that wind more than once around a part of what they hold, or cross themselves.
    pub crossing: usize,
    /// Of these, those that stayed as they are: what they hold is in doubt.
    pub doubtful: usize,
    /// Holes that were capped.
    pub holes: usize,
    /// Bodies in the end.
    pub bodies: usize,
    /// Their run among the bodies of the scene.
    pub body_range: Range<usize>,
    /// Signed volume of the triangles as read.
    pub signed_volume: f64,
    /// Sum of the bodies' volumes (overlaps counted as often as they occur).
    pub body_volume: f64,
    /// Area of the surface; what is there twice counts once.
    pub area: f64,
    /// Lowest and highest corner.
    pub bounds: [DVec3; 2],
}

/// No plant is larger than this in metres, and few parts are smaller than this in millimetres.
const LARGEST_PLANT: f64 = 1000.0;

impl Diagnosis {
    /// That the file may be in millimetres, as the beginning of a sentence that ends with what to give; nothing if its size is that of a plant in
    /// metres.
    #[must_use]
    pub fn too_large_for_metres(&self) -> Option<String> {
        let size = self.bounds[1] - self.bounds[0];
        (LARGEST_PLANT..LARGEST_PLANT * 1e4).contains(&size.max_element()).then(|| {
            let DVec3 { x, y, z } = size;
            format!("its size, {x:.6} × {y:.6} × {z:.6}, would be in metres; if these are millimetres")
        })
    }
}

/// Collects warnings of one file.
#[derive(Debug)]
pub(super) struct Reporter {
    pub file: String,
    pub warnings: Vec<String>,
}

impl Reporter {
    pub fn warn(&mut self, reason: String) {
        let separator = if self.file.is_empty() { "" } else { ": " };
        self.warnings.push(format!("{}{separator}{reason}", self.file));
    }
}

/// A point for people.
pub(super) fn show(p: DVec3) -> String {
    match p.abs().max_element() {
        size if size == 0.0 || (1e-3..1e9).contains(&size) => format!("({:.6}, {:.6}, {:.6})", p.x, p.y, p.z),
        _ => format!("({:.6e}, {:.6e}, {:.6e})", p.x, p.y, p.z),
    }
}
