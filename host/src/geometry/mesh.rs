//! Triangles with names.

use crate::error::Error;
use glam::DVec3;
use std::ops::Range;
use std::path::Path;

/// Larger coordinates would overflow when multiplied.
pub const LARGEST: f64 = 1e60;

/// Triangles of one source, in its own units and order.
///
/// ```
/// use voidage::{DVec3, geometry::mesh::Mesh};
///
/// let corner = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let tetrahedron = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(|t| t.map(|v: usize| corner[v]));
/// assert_eq!(Mesh::from(tetrahedron.to_vec()).solids.len(), 1);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    /// What messages call it, such as its file; may be empty.
    pub name: String,
    /// Named runs of triangles in file order; together they cover all triangles, each once. A run may be empty.
    pub solids: Vec<Solid>,
    /// Corners in winding order, all finite; counter-clockwise seen from outside, if the source keeps the convention.
    pub triangles: Vec<[DVec3; 3]>,
    /// The coordinates are numbers of `f32`: those of a binary STL, or of a text that was written from such.
    pub single_precision: bool,
    /// What was passed over or guessed: sentences that name the source and the reason.
    pub warnings: Vec<String>,
}

/// A named run of triangles.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Solid {
    /// As the file has it, trimmed; empty if the file gives none. Bytes that are not UTF-8 became U+FFFD.
    pub name: String,
    /// Half-open range of indices into [`Mesh::triangles`].
    pub triangles: Range<usize>,
}

impl From<Vec<[DVec3; 3]>> for Mesh {
    /// One solid without a name, of double precision.
    fn from(triangles: Vec<[DVec3; 3]>) -> Self {
        let solids = vec![Solid { name: String::new(), triangles: 0..triangles.len() }];
        Mesh { name: String::new(), solids, triangles, single_precision: false, warnings: Vec::new() }
    }
}

impl Mesh {
    /// Of a file that is yet to be read.
    pub(super) fn of_file(path: &Path) -> Self {
        Mesh { name: path.display().to_string(), solids: Vec::new(), ..Mesh::from(Vec::new()) }
    }

    pub(super) fn warn(&mut self, what: impl std::fmt::Display) {
        self.warnings.push(format!("{}: {what}", self.name));
    }

    /// A failure of the mesh as a whole.
    pub(super) fn error(&self, reason: impl Into<String>) -> Error {
        let path = (!self.name.is_empty()).then(|| self.name.clone().into());
        Error { path, ..Error::new(reason) }
    }
}
