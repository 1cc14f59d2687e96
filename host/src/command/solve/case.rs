//! The keys of a case of `voidage solve`, as typed; those of `[output]` in [`super::output_keys`]. Every key that is not known is an error.
//!
//! Lengths in metres, times in seconds, any consistent units. A state is `rho`, `u`, `v`, `w`, `p`: density, velocity
//! along x, y, z, pressure; velocities left out are 0; `gamma` is that of another gas than `[gas]` tells. With `gas.gas_constant` a temperature `T` may stand for `rho`.

use super::output_keys::OutputKeys;
use crate::grid::AXES;
use crate::grid::file::GridTable;
use crate::porosity::throat::Faces;
use clap::ValueEnum;
use serde::Deserialize;
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Deserializer, SeqAccess, Visitor};
use std::path::PathBuf;
use voidage_core::flow::{Limiter, Riemann};

/// Names of the velocities along x, y, z.
pub const VELOCITIES: [&str; 3] = ["u", "v", "w"];

/// A whole case.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Written over pictures and into reports.
    pub title: Option<String>,
    /// Cells; an axis left out, or of one cell, is no part of the flow.
    pub grid: GridTable,
    /// The space; open, if left out.
    #[serde(default)]
    pub porosity: PorosityKeys,
    /// The gas.
    pub gas: GasKeys,
    /// State at the beginning.
    pub initial: InitialKeys,
    /// The sides of the axes that have more than one cell.
    #[serde(default)]
    pub boundary: SideKeys,
    /// Resistance of obstacles smaller than a cell.
    #[serde(default)]
    pub drag: DragKeys,
    /// A constant acceleration.
    #[serde(default)]
    pub gravity: GravityKeys,
    /// Numerics.
    #[serde(default)]
    pub scheme: SchemeKeys,
    /// When to stop.
    pub time: TimeKeys,
    /// What to write beside the last state.
    #[serde(default)]
    pub output: OutputKeys,
}

/// `[porosity]`: `scene` or `from`.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PorosityKeys {
    /// STL or OBJ files, one or a list.
    pub scene: Option<Paths>,
    /// Unit of the scene's coordinates.
    pub unit: Option<crate::geometry::unit::Unit>,
    /// As `voidage porosity --tol`.
    pub tol: Option<f64>,
    /// As `voidage porosity --depth`.
    pub depth: Option<u32>,
    /// Directory with `beta_v.npy` and the face fields of the axes that flow.
    pub from: Option<PathBuf>,
    /// Differences of the open fraction above this share, at one face or over many in a row, are jumps and get the throat map; `inf` for none.
    pub jump: Option<f64>,
    /// As `voidage porosity --faces`; `throat` if left out: a wall that leaks in silence is worse than a narrower face.
    pub faces: Option<Faces>,
    /// Merge cells of little volume behind open faces, which otherwise set the time step.
    pub merge: Option<bool>,
}

/// One path or several.
#[derive(Debug, Clone)]
pub struct Paths(pub Vec<PathBuf>);

impl<'de> Deserialize<'de> for Paths {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        deserializer.deserialize_any(PathsVisitor)
    }
}

/// Tells one path from a list.
struct PathsVisitor;

impl<'de> Visitor<'de> for PathsVisitor {
    type Value = Paths;

    fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str("a path or a list of paths")
    }

    fn visit_str<E: serde::de::Error>(self, path: &str) -> std::result::Result<Paths, E> {
        Ok(Paths(vec![path.into()]))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, items: A) -> std::result::Result<Paths, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(items)).map(Paths)
    }
}

/// Which gas.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Model {
    /// p = (gamma − 1) rho e.
    Ideal,
    /// p = c² rho.
    Isothermal,
    /// p = p0 (rho/rho0)^gamma.
    Isentropic,
}

impl Model {
    /// As a case writes it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Model::Ideal => "ideal",
            Model::Isothermal => "isothermal",
            Model::Isentropic => "isentropic",
        }
    }
}

/// `[gas]`.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GasKeys {
    /// Which gas.
    pub model: Model,
    /// Ratio of specific heats (ideal, isentropic).
    pub gamma: Option<f64>,
    /// Speed of sound (isothermal).
    pub sound_speed: Option<f64>,
    /// rho0 of the reference state (isentropic).
    pub rho: Option<f64>,
    /// p0 of the reference state (isentropic).
    pub p: Option<f64>,
    /// R in p = rho R T, for states given by their temperature.
    pub gas_constant: Option<f64>,
}

/// A state, or a side of the domain, a patch on one, or a region: each uses some of the keys.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StateKeys {
    /// Density.
    pub rho: Option<f64>,
    /// Temperature, in place of the density.
    #[serde(rename = "T")]
    pub temperature: Option<f64>,
    /// Velocity along x.
    pub u: Option<f64>,
    /// Velocity along y.
    pub v: Option<f64>,
    /// Velocity along z.
    pub w: Option<f64>,
    /// Pressure.
    pub p: Option<f64>,
    /// Ratio of specific heats of the gas there, if it is not that of the gas of the case.
    pub gamma: Option<f64>,
    /// Of a side: what stands there.
    #[serde(rename = "type")]
    pub kind: Option<Kind>,
    /// Of an inlet: time in which its pressure follows the flow.
    pub relax: Option<f64>,
    /// Of a region: lowest corner of a box; missing axes reach to infinity.
    pub min: Option<Vec<f64>>,
    /// Highest corner.
    pub max: Option<Vec<f64>>,
    /// Of a region: centre of a ball.
    pub center: Option<Vec<f64>>,
    /// Its radius.
    pub radius: Option<f64>,
    /// Of a patch: the side that it is a part of.
    pub side: Option<SideName>,
}

/// A side of the domain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SideName {
    /// Low side of x.
    XMin,
    /// High side of x.
    XMax,
    /// Low side of y.
    YMin,
    /// High side of y.
    YMax,
    /// Low side of z.
    ZMin,
    /// High side of z.
    ZMax,
}

impl SideName {
    /// The axis, and 0 for its low or 1 for its high side.
    #[must_use]
    pub fn place(self) -> (usize, usize) {
        let n = self as usize;
        (n / 2, n % 2)
    }

    /// As a case writes it.
    #[must_use]
    pub fn word(self) -> String {
        let (axis, side) = self.place();
        side_word(axis, side)
    }
}

/// A side of the domain as a case writes it: of an axis, 0 the low and 1 the high one.
#[must_use]
pub fn side_word(axis: usize, side: usize) -> String {
    format!("{}_{}", AXES[axis], ["min", "max"][side])
}

impl StateKeys {
    /// Names of the keys that are given, the type aside.
    #[must_use]
    pub fn given(&self) -> Vec<&'static str> {
        let all = [
            ("rho", self.rho.is_some()),
            ("T", self.temperature.is_some()),
            ("u", self.u.is_some()),
            ("v", self.v.is_some()),
            ("w", self.w.is_some()),
            ("p", self.p.is_some()),
            ("gamma", self.gamma.is_some()),
            ("relax", self.relax.is_some()),
            ("min", self.min.is_some()),
            ("max", self.max.is_some()),
            ("center", self.center.is_some()),
            ("radius", self.radius.is_some()),
            ("side", self.side.is_some()),
        ];
        all.into_iter().filter_map(|(name, given)| given.then_some(name)).collect()
    }
}

/// `[initial]`: `uniform` or `from`, then `regions` over it, later ones over earlier ones.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InitialKeys {
    /// One state everywhere.
    pub uniform: Option<StateKeys>,
    /// Directory with `rho.npy`, `u.npy`, `v.npy`, `w.npy`, `p.npy`.
    pub from: Option<PathBuf>,
    /// Boxes and balls with states; of a cell, each takes the share that it holds.
    #[serde(default)]
    pub regions: Vec<StateKeys>,
}

/// What stands at a side of the domain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Gas of a given velocity and density (or temperature) enters; its pressure follows the flow.
    Inlet,
    /// A given state outside; waves leave.
    FarField,
    /// Gas leaves against a given pressure.
    Outlet,
    /// Gas enters from rest, from a tank or a calm atmosphere of a given state.
    Reservoir,
    /// No flux, no friction.
    Wall,
    /// Outside as inside.
    ZeroGradient,
    /// The opposite side.
    Periodic,
}

impl Kind {
    /// As a case writes it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Kind::Inlet => "inlet",
            Kind::FarField => "far-field",
            Kind::Outlet => "outlet",
            Kind::Reservoir => "reservoir",
            Kind::Wall => "wall",
            Kind::ZeroGradient => "zero-gradient",
            Kind::Periodic => "periodic",
        }
    }
}

/// `[boundary]`.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SideKeys {
    /// Low side of x.
    pub x_min: Option<StateKeys>,
    /// High side of x.
    pub x_max: Option<StateKeys>,
    /// Low side of y.
    pub y_min: Option<StateKeys>,
    /// High side of y.
    pub y_max: Option<StateKeys>,
    /// Low side of z.
    pub z_min: Option<StateKeys>,
    /// High side of z.
    pub z_max: Option<StateKeys>,
    /// Parts of sides where something else stands; of those that overlap, the last.
    #[serde(default)]
    pub patch: Vec<StateKeys>,
}

impl SideKeys {
    /// Low and high side of each axis.
    #[must_use]
    pub fn by_axis(&self) -> [[Option<&StateKeys>; 2]; 3] {
        let SideKeys { x_min, x_max, y_min, y_max, z_min, z_max, .. } = self;
        [[x_min, x_max], [y_min, y_max], [z_min, z_max]].map(|sides| sides.map(Option::as_ref))
    }
}

/// A law, or the choice of none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LawName {
    /// Obstacles inside cells exert no force.
    None,
    /// As `voidage porosity --drag bluff`.
    Bluff,
    /// As `voidage porosity --drag pdr`.
    Pdr,
}

/// `[drag]`: R_i = −beta_v rho (linear_i + ½ cr_i |u|) u_i, by a law from the scene, the same everywhere, or from files.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DragKeys {
    /// How the frontal area of the scene becomes `cr`.
    pub law: Option<LawName>,
    /// Drag coefficient of the law for all bodies.
    pub cd: Option<f64>,
    /// For round bodies; 1.2 if left out.
    pub cd_round: Option<f64>,
    /// For bodies with edges; 2 if left out.
    pub cd_sharp: Option<f64>,
    /// CR along x, y, z in 1/m.
    pub cr: Option<[f64; 3]>,
    /// Linear coefficients in 1/s.
    pub linear: Option<[f64; 3]>,
    /// Directory with any of `cr_x.npy` … `linear_z.npy`.
    pub from: Option<PathBuf>,
}

/// `[gravity]`.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GravityKeys {
    /// Acceleration along x, y, z in m/s².
    pub g: Option<[f64; 3]>,
}

/// `[scheme]`.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SchemeKeys {
    /// How the pressure acts on walls inside a cell.
    pub pressure: Option<Pressure>,
    /// Limiter of the slopes.
    pub limiter: Option<LimiterName>,
    /// Riemann solver.
    pub riemann: Option<RiemannName>,
    /// 1 or 2.
    pub order: Option<u8>,
    /// Share of the stable time step, above 0 and at most 1.
    pub cfl: Option<f64>,
    /// First steps taken at a fifth of the stable step.
    pub careful_steps: Option<usize>,
}

/// Form of the pressure force.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Pressure {
    /// On open faces and on the walls inside.
    Geometric,
    /// −beta_v grad p.
    Paper,
}

/// Limiter, as a case and a study write it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum LimiterName {
    /// Monotonised central, with contacts kept steep.
    Steep,
    /// Monotonised central.
    Mc,
    /// Sound by its waves, after Arora and Roe; the rest as steep.
    AroraRoe,
    /// Van Leer.
    VanLeer,
    /// Minmod.
    Minmod,
    /// Central slopes as they are, for smooth flow.
    None,
}

impl LimiterName {
    /// The limiter of the solver.
    #[must_use]
    pub fn meaning(self) -> Limiter {
        match self {
            LimiterName::Steep => Limiter::Steep,
            LimiterName::Mc => Limiter::MonotonizedCentral,
            LimiterName::AroraRoe => Limiter::AroraRoe,
            LimiterName::VanLeer => Limiter::VanLeer,
            LimiterName::Minmod => Limiter::Minmod,
            LimiterName::None => Limiter::Unlimited,
        }
    }
}

/// Riemann solver, as a case and a study write it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum RiemannName {
    /// HLLC.
    Hllc,
    /// HLLC, softened where the gas is slow.
    HllcLowMach,
    /// HLLE.
    Hlle,
    /// Rusanov.
    Rusanov,
}

impl RiemannName {
    /// The Riemann solver meant.
    #[must_use]
    pub fn meaning(self) -> Riemann {
        match self {
            RiemannName::Hllc => Riemann::Hllc,
            RiemannName::HllcLowMach => Riemann::HllcLowMach,
            RiemannName::Hlle => Riemann::Hlle,
            RiemannName::Rusanov => Riemann::Rusanov,
        }
    }
}

/// `[time]`: at least one of the two.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TimeKeys {
    /// Time to reach.
    pub end: Option<f64>,
    /// Steps after which to stop.
    pub max_steps: Option<usize>,
}
