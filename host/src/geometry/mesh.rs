//! Triangles with names.

use glam::DVec3;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Triangles of one file, in the file's own units and order.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    /// The file.
    pub path: PathBuf,
    /// Named runs of triangles in file order; together they cover all triangles, each once. A run may be empty.
    pub solids: Vec<Solid>,
    /// Corners in winding order, all finite; counter-clockwise seen from outside, if the file keeps the convention.
    pub triangles: Vec<[DVec3; 3]>,
    /// The coordinates are numbers of `f32`: those of a binary STL, or of a text that was written from such.
    pub single_precision: bool,
    /// What was passed over or guessed: sentences that name the file and the reason.
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

impl Mesh {
    pub(super) fn new(path: &Path) -> Self {
        let (solids, triangles, warnings) = (Vec::new(), Vec::new(), Vec::new());
        Mesh { path: path.to_owned(), solids, triangles, single_precision: false, warnings }
    }

    pub(super) fn warn(&mut self, what: impl std::fmt::Display) {
        self.warnings.push(format!("{}: {what}", self.path.display()));
    }
}
