//! When a subdivision stops.

/// What becomes of a part that is still cut when the depth is spent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LeafRule {
    /// Its bounds are 0 and 1. The paper takes the upper one.
    Solid,
    /// Its bounds are 0 and 1. Their mean is the value.
    Half,
    /// Its bounds are measured, by chords and support planes.
    Plane,
}

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SubdivisionRule<R> {
    /// What becomes of the smallest parts.
    pub leaf: LeafRule,
    /// How often a cell may be halved along each axis; above [`MAX_DEPTH`] it counts as that.
    pub depth: u32,
    /// With [`LeafRule::Plane`]: a cell or face whose bounds are this close is not divided further. A share, 0 to 1; NaN and numbers below 0
    /// divide down to `depth`.
    pub tol: R,
}

/// Deepest subdivision of a cell: 2¹⁶ parts along each side.
pub const MAX_DEPTH: u32 = 16;
