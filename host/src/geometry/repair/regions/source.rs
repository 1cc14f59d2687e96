//! All triangles of a source, beside the surface in question.

use crate::geometry::repair::face::{Face, bounds};
use crate::geometry::repair::lines::FLAT;
use crate::geometry::repair::tree::Tree;
use glam::DVec3;
use std::sync::OnceLock;

/// All triangles of a source as they were read: those that lie on a surface tell where it has a back.
pub struct SourceTriangles<'a> {
    triangles: &'a [[DVec3; 3]],
    tree: OnceLock<Tree>,
}

impl<'a> SourceTriangles<'a> {
    /// Of these triangles.
    #[must_use]
    pub fn new(triangles: &'a [[DVec3; 3]]) -> Self {
        SourceTriangles { triangles, tree: OnceLock::new() }
    }

    /// All of them.
    #[must_use]
    pub fn triangles(&self) -> &'a [[DVec3; 3]] {
        self.triangles
    }

    /// Those that may have points in the plane of a triangle, and there as near to it as `on`. Most files never ask.
    pub(super) fn in_plane_of(&self, face: &Face, on: f64) -> Vec<Face> {
        let tree = self.tree.get_or_init(|| Tree::turned(self.triangles, on));
        let (mut found, [lo, hi]) = (Vec::new(), bounds(&face.corners));
        tree.touching([lo - on, hi + on], |n| {
            let other = Face::new(self.triangles[n as usize]);
            if other.normal.dot(face.normal).abs() > 1.0 - FLAT {
                found.push(other);
            }
        });
        found
    }
}
