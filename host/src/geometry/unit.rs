//! Units of length.

/// What the coordinates of a file are in; results are in metres.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
#[non_exhaustive]
pub enum Unit {
    /// Metres.
    M,
    /// Millimetres.
    Mm,
    /// Centimetres.
    Cm,
    /// Inches.
    In,
    /// Feet.
    Ft,
}

impl Unit {
    /// All of them.
    pub const ALL: [Unit; 5] = [Unit::M, Unit::Mm, Unit::Cm, Unit::In, Unit::Ft];

    /// As users write it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Unit::M => "m",
            Unit::Mm => "mm",
            Unit::Cm => "cm",
            Unit::In => "in",
            Unit::Ft => "ft",
        }
    }

    /// The unit of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Unit> {
        Unit::ALL.into_iter().find(|unit| unit.name() == name)
    }

    /// Metres in one unit.
    #[must_use]
    pub fn metres(self) -> f64 {
        match self {
            Unit::M => 1.0,
            Unit::Mm => 0.001,
            Unit::Cm => 0.01,
            Unit::In => 0.0254,
            Unit::Ft => 0.3048,
        }
    }
}
