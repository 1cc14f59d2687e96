//! `[output]` of a case of `voidage solve`, as typed: what is written beside the last state.

use serde::Deserialize;

/// `[output]`.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OutputKeys {
    /// Time between frames; the first and the last state are always frames.
    pub every: Option<f64>,
    /// Files of a frame; `["vtr"]` if left out.
    pub formats: Option<Vec<Format>>,
    /// Points whose state is kept at every step.
    #[serde(default)]
    pub probes: Vec<Probe>,
    /// Planes whose flow is kept at every step.
    #[serde(default)]
    pub monitors: Vec<MonitorKeys>,
    /// Solids whose forces are kept, by name; `*` stands for all.
    #[serde(default)]
    pub forces: Vec<String>,
    /// Point through which pictures are cut.
    pub slice: Option<Vec<f64>>,
    /// Ends of the colours of pictures.
    #[serde(default)]
    pub range: RangeKeys,
    /// Largest values over time, if they are wanted.
    pub maxima: Option<MaximaKeys>,
    /// Pressure that overpressures are counted from.
    pub ambient: Option<f64>,
    /// Steps between lines of the log.
    pub log_every: Option<usize>,
    /// Seconds of work between checkpoints.
    pub checkpoint_every: Option<f64>,
}

impl OutputKeys {
    /// Files of a frame.
    #[must_use]
    pub fn formats(&self) -> &[Format] {
        self.formats.as_deref().unwrap_or(&[Format::Vtr])
    }
}

/// `range` of `[output]`; what is left out is the range of the whole run.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RangeKeys {
    /// In m/s.
    pub speed: Option<[f64; 2]>,
    /// In kPa.
    pub overpressure: Option<[f64; 2]>,
}

/// `maxima` of `[output]`.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaximaKeys {
    /// Overpressure whose arrival is told.
    pub threshold: Option<f64>,
}

/// Files of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Format {
    /// ParaView, with a `flow.pvd` over all frames.
    Vtr,
    /// NumPy arrays.
    Npy,
    /// Pictures of velocity and pressure.
    Png,
}

/// A point whose state is kept.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// Name in the file; its number, if left out.
    pub name: Option<String>,
    /// The point; axes of one cell may be left out.
    pub at: Vec<f64>,
}

/// A plane of the grid whose flow is kept: one of `x`, `y`, `z` tells its place.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MonitorKeys {
    /// Name in the file; its number, if left out.
    pub name: Option<String>,
    /// Place along x of a plane across x.
    pub x: Option<f64>,
    /// Place along y of a plane across y.
    pub y: Option<f64>,
    /// Place along z of a plane across z.
    pub z: Option<f64>,
    /// Lowest corner of a box that the plane ends at; missing axes reach to infinity.
    pub min: Option<Vec<f64>>,
    /// Highest corner.
    pub max: Option<Vec<f64>>,
}

impl Probe {
    /// The name, or that of the `n`-th probe without one.
    #[must_use]
    pub fn name(&self, n: usize) -> String {
        self.name.clone().unwrap_or_else(|| format!("probe {}", n + 1))
    }
}
