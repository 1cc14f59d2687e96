//! What to compute, and how far to go.

use voidage_core::subdivide;
use voidage_core::surface::layer::LayerOptions;

/// How volumes are found.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Method {
    /// The cheapest for every body: sums over its surface, if it has triangles, else closed forms, and subdivision where those meet.
    #[default]
    Auto,
    /// Sums over the surface: exact for any closed surface of triangles.
    Surface,
    /// Subdivision by GJK, as in the paper: bounds; by leaf plane for convex bodies, by the others for any that close.
    Gjk,
}

/// What becomes of the smallest parts of a cell that a body still cuts.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
#[non_exhaustive]
pub enum Leaf {
    /// A part that a body touches counts as solid: the paper's rule, which finds too much.
    Solid,
    /// A part that a body touches counts half.
    Half,
    /// A part is bounded by planes and points: certified, of second order.
    #[default]
    Plane,
}

impl Leaf {
    /// How deep a subdivision goes unless another depth is asked for: the paper's, or far enough for the default tolerance.
    #[must_use]
    pub fn depth(self) -> u32 {
        if self == Leaf::Plane { 6 } else { 3 }
    }
}

impl From<Leaf> for subdivide::LeafRule {
    fn from(leaf: Leaf) -> Self {
        match leaf {
            Leaf::Solid => subdivide::LeafRule::Solid,
            Leaf::Half => subdivide::LeafRule::Half,
            Leaf::Plane => subdivide::LeafRule::Plane,
        }
    }
}

/// What to compute and how far to refine.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// Unions are found exactly; where one has no proof, divide the cell until its bounds are this close. By default 1e-4.
    pub tol: f64,
    /// How often a cell whose union has no proof may be divided by 2 along each axis. By default 6.
    pub depth: u32,
    /// Keep lower and upper bounds of all fields. Not by default.
    pub bounds: bool,
    /// Compute the faces, as by default; without, their fields stay empty.
    pub areas: bool,
    /// How volumes are found.
    pub method: Method,
    /// What ends a subdivision by GJK.
    pub leaf: Leaf,
    /// Find areas and shadows of the surface in cells on the way, where [`super::resistance`] will ask for them.
    pub resistance: bool,
}

impl Options {
    /// Where between its bounds a value lies: in the middle; by the paper's rule at the solid end.
    pub(super) fn solid_end(&self) -> f64 {
        if self.leaf == Leaf::Solid { 1.0 } else { 0.5 }
    }
}

impl From<Options> for LayerOptions<f64> {
    fn from(options: Options) -> Self {
        let Options { tol, depth, areas, .. } = options;
        LayerOptions { tol, depth, areas, solid_end: options.solid_end() }
    }
}

impl Default for Options {
    fn default() -> Self {
        Options {
            tol: 1e-4,
            depth: 6,
            bounds: false,
            areas: true,
            method: Method::Auto,
            leaf: Leaf::Plane,
            resistance: false,
        }
    }
}
