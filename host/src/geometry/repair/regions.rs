//! Surfaces that share edges so that nobody can tell whose triangles are whose: the regions between them.
//!
//! A surface divides space into regions. The one that reaches to infinity is open. If no triangle has a back, all others have a winding number.
//! A surface with two sides says where solid and gas meet, but not on which side the solid is: there a region beside the open one, or behind a
//! triangle that has no back, is solid; of any other it is not known: it may be a room between parts that touch, or a part within others.
//!
//! The sides of two triangles belong to one region where a straight line from the one to the other meets nothing between, or where the triangles
//! meet in an edge that is theirs alone. A line that passes closer than rounding to an edge tells nothing and is not used, so a region may fall
//! into several here, of which less is known; it is never joined to another. Regions after Q. Zhou, E. Grinspun, D. Zorin, A. Jacobson,
//! *Mesh Arrangements for Solid Geometry*, ACM Trans. Graph. 35 (2016), sec. 3.
//!
//! **Proof.** The surfaces found must be closed: their areas cancel and their volumes along x, y and z agree, else there is no answer.

mod complex;
mod kinds;
mod source;

use crate::geometry::repair::crossing::{Meetings, edges, tolerance};
use complex::{Complex, sided};
use glam::DVec3;

pub use kinds::{Regions, Unknown};
pub use source::SourceTriangles;

/// The regions of a surface, a part of `source`. `mixed`: some parts look inward, others outward.
///
/// # Errors
/// Why they cannot be told.
pub fn arrangement(
    triangles: &[[DVec3; 3]],
    [lo, hi]: [DVec3; 2],
    source: &SourceTriangles<'_>,
    mixed: bool,
) -> Result<Regions, Unknown> {
    let sided = sided(triangles);
    let corners: Vec<[DVec3; 3]> = sided.iter().map(|t| t.corners).collect();
    let on = tolerance([lo, hi]);
    let edges = edges(&corners);
    if edges.chunk_by(|a, b| a.0 == b.0).any(|uses| uses.len() == 1) {
        return Err(Unknown::Open);
    }
    let meetings = Meetings::new(&corners, on);
    let mut complex = Complex::joined(&sided, &meetings, &edges, on);
    let looks = complex.looks(source);
    let two_sided = looks.contains(&[true, true]);
    let kinds = if two_sided { complex.by_sides(&looks, mixed) } else { complex.by_winding() };
    let backs = if two_sided { triangles.len() - sided.len() } else { 0 };
    let found = kinds.and_then(|(kinds, inverted)| complex.surfaces(&kinds, inverted, [lo, hi]));
    let why = if complex.separates() { Unknown::Unclear } else { Unknown::Open };
    Ok(Regions { backs, ..found.ok_or(why)? })
}

/// The regions of a cluster of triangles that share edges, some of which have backs; all look the same way.
///
/// # Errors
/// Why they cannot be told.
pub fn of_two_sided(triangles: &[[DVec3; 3]], bounds: [DVec3; 2]) -> Result<Regions, Unknown> {
    let sided = sided(triangles);
    let corners: Vec<[DVec3; 3]> = sided.iter().map(|t| t.corners).collect();
    let (on, edges) = (tolerance(bounds), edges(&corners));
    let meetings = Meetings::new(&corners, on);
    let mut complex = Complex::joined(&sided, &meetings, &edges, on);
    let (kinds, inverted) = complex.by_faces(&edges)?;
    let dropped = |two: bool| {
        let of = sided.iter().filter(|t| (t.front > 0 && t.back > 0) == two);
        of.map(|t| (t.front + t.back - 1) as usize).sum()
    };
    let found = complex.surfaces(&kinds, inverted, bounds).ok_or(Unknown::Unclear)?;
    Ok(Regions { backs: dropped(true), repeated: dropped(false), ..found })
}
