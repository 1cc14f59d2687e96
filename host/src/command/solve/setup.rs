//! From a case to a flow that is ready to step: every value checked, nothing made that the case does not need.

use super::case::{GasKeys, LimiterName, Model, Pressure, RiemannName, side_word};
use super::case_file::CaseFile;
use super::force::{FreeSides, pushed_cells};
use super::inlet::Inlet;
use super::mixture::mixture;
use super::open_parts::{OpenParts, Standing};
use super::output_keys::{Format, RangeKeys};
use super::ranges::NOT_NEGATIVE;
use super::region_report::{self, RegionReport};
use super::regions::Region;
use super::sides::{self, PatchReport, Sides};
use super::solids::SolidShares;
use super::space::{self, Space, close_dust};
use super::state::{Beginning, States};
use super::strong_drag;
use super::units;
use crate::command::progress::Progress;
use crate::error::{Error, Result};
use crate::flow::{Flow, Tidied, Treatment};
use crate::grid::{AXES, Edges};
use crate::picture::ticks::number as short;
use serde::Serialize;
use voidage_core::flow::{Boundary, Gas, Limiter, PressureForm, Primitive, Scheme};

/// A flow with what the run needs to know about it.
#[derive(Debug)]
pub struct Setup<const D: usize> {
    /// The flow at its beginning.
    pub flow: Flow<f64, D>,
    /// The axes it has.
    pub live: [usize; D],
    /// Cell edges along x, y, z.
    pub edges: Edges,
    /// Share of the stable step.
    pub cfl: f64,
    /// Inlets whose pressure follows the flow.
    pub inlets: Vec<Inlet<D>>,
    /// How the porosity enters.
    pub treatment: Treatment<f64>,
    /// What the porosity came to, if there is any.
    pub space: Option<SpaceReport>,
    /// How well the grid resolves each region of the beginning.
    pub regions: Vec<RegionReport>,
    /// What patches on the sides came to.
    pub patches: Vec<PatchReport>,
    /// The cells in which the gas pushes something.
    pub pushed: Vec<usize>,
    /// What counts for no solid at the sides of the domain.
    pub free_sides: FreeSides,
    /// Shares of the solids whose forces are kept.
    pub solids: Option<SolidShares<D>>,
    /// What was left out because nothing needs it.
    pub skipped: Vec<String>,
}

/// What the solver made of the porosity.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct SpaceReport {
    /// Cells with no open volume.
    pub closed_cells: usize,
    /// Faces where the porosity jumps and the throat map acts.
    pub jump_faces: usize,
    /// Cells that share their state with neighbours because of their little volume.
    pub merged_cells: usize,
    /// Cells whose fraction was within a few rounding errors of 0 and became 0.
    pub dust_cells: usize,
    /// Faces likewise.
    pub dust_faces: usize,
    /// Open faces on the sides of the domain that were closed: too little volume behind them for any step.
    pub closed_faces: usize,
    /// Faces on periodic sides that were lowered to what the opposite side leaves open.
    pub matched_faces: usize,
    /// The stable step at the beginning over that of open space: what the porosity costs.
    pub step_share: f64,
}

/// The axes with more than one cell; x, if there is none.
#[must_use]
pub fn live_axes(edges: &Edges) -> Vec<usize> {
    let cells = edges.cells();
    let live: Vec<usize> = (0..3).filter(|&a| cells[a] > 1).collect();
    if live.is_empty() { vec![0] } else { live }
}

/// Makes the flow of a case.
///
/// # Errors
/// Whatever in the case is missing, contradicts or is out of range; arrays that cannot be read or do not fit.
pub fn setup<const D: usize>(
    file: &CaseFile,
    edges: &Edges,
    live: [usize; D],
    progress: &mut Progress,
) -> Result<Setup<D>> {
    let case = &file.case;
    let gas = mixture(file, gas(file, &case.gas)?, edges)?;
    let mut skipped: Vec<String> =
        (0..3).filter(|a| !live.contains(a)).map(|a| format!("axis {}: it has one cell", AXES[a])).collect();
    let states = States { file, gas, gas_constant: case.gas.gas_constant, live };
    let mut beginning = progress.stage("initial", |_| states.initial(edges))?;

    let pressures = beginning.cells.iter().map(|w| w.pressure);
    let ends = pressures.fold([f64::INFINITY, 0.0], |[low, high], p| [low.min(p), high.max(p)]);
    let widths = live.map(|d| edges.widths(d));
    let Sides { boundaries, patches, feed, mut inlets } = sides::sides(file, &states, edges, &beginning.cells)?;
    // After keys that are refused: of these nothing else is said.
    units::doubts(file, ends).into_iter().chain(without_pictures(file)).for_each(|doubt| progress.warn(doubt));
    let mut flow = Flow::new(widths, gas, boundaries);
    flow.patches = patches;
    (flow.feed_sides, flow.feed_patches) = feed;
    (flow.scheme, flow.careful_steps) = scheme(file)?;
    flow.gravity = gravity(file, live)?;
    warn_of_level_pressures(file, &flow, live, progress);

    let (keys, usual) = (&case.porosity, Treatment::default());
    let treatment = Treatment { jump: keys.jump.unwrap_or(usual.jump), merge: keys.merge.unwrap_or(usual.merge) };
    let (mut report, mut by_law, mut bodies, mut surrounded) = (None, None, None, Vec::new());
    let (space, measured) = space::load(file, edges, live, progress)?;
    let parts = open_parts(file, edges, &beginning, space.as_ref(), progress)?;
    states.settle(&mut beginning, &parts, edges)?;
    match space {
        None => skipped.push("porosity: every cell and face is open".into()),
        Some(space) => {
            let Space { volume, faces, drag, scene, .. } = space;
            surrounded = space.surrounded;
            bodies = scene.map(|scene| scene.bodies).filter(|_| space::has_law(file));
            by_law = drag;
            report = Some(fill(file, &mut flow, (volume, faces), (edges, live, treatment), progress)?);
        }
    }
    match drag(file, edges, live, by_law)? {
        Some([quadratic, linear]) => flow.set_drag(quadratic, linear).map_err(|error| refused(file, error))?,
        None => skipped.push("drag: none".into()),
    }
    if flow.gravity.iter().all(|&g| g == 0.0) {
        skipped.push("gravity: none".into());
    }
    warn_of_level_start(file, &flow.gravity, (edges, live), progress);
    if !gas.has_energy() {
        skipped.push("energy equation: the gas is barotropic".into());
    }

    set_states(&mut flow, &beginning);
    strong_drag::warn(&flow, live, edges, bodies.as_ref(), progress);
    if let Some(report) = &mut report {
        report.step_share = step_share(&mut flow);
    }
    let (edges, cfl) = (edges.clone(), case.scheme.cfl.unwrap_or(USUAL_CFL));
    for inlet in &mut inlets {
        // A patch without an open face is told with the other patches.
        if !inlet.look_at(&mut flow) && inlet.patch.is_none() {
            let key = format!("boundary.{}", side_word(live[inlet.at.0], inlet.at.1));
            progress.warn(file.remark(&key, "solids or patches cover all of this inlet: nothing enters"));
        }
    }
    let pushed = pushed_cells(&flow);
    let free_sides = FreeSides::new(&flow, live, &surrounded);
    let solids = (!measured.is_empty())
        .then(|| SolidShares::new(&measured, &flow, (&pushed, &free_sides), !space::given_otherwise(file)));
    let regions = region_report::report(file, (&flow, &parts), &edges, live, progress)?;
    sides::warn_of_closed(file, &flow, live, progress);
    let patches = sides::report(file, &flow, &edges, live, progress)?;
    Ok(Setup {
        flow,
        live,
        edges,
        cfl,
        inlets,
        treatment,
        space: report,
        regions,
        patches,
        pushed,
        free_sides,
        solids,
        skipped,
    })
}

/// What the regions of the beginning keep of the cells that they hold in part.
fn open_parts<const D: usize>(
    file: &CaseFile,
    edges: &Edges,
    beginning: &Beginning<D>,
    space: Option<&Space<D>>,
    progress: &mut Progress,
) -> Result<OpenParts> {
    let regions = Region::all(file)?;
    let (scene, beta_v) = (space.and_then(|s| s.scene.as_ref()), space.map(|s| &s.volume[..]));
    let standing = Standing { edges, regions: &regions, scene, beta_v };
    OpenParts::measure(&standing, beginning.holds(), progress)
}

/// Gives a flow its porosity, and tells what the solver makes of it.
fn fill<const D: usize>(
    file: &CaseFile,
    flow: &mut Flow<f64, D>,
    (mut volume, mut faces): (Vec<f64>, [Vec<f64>; D]),
    (edges, live, treatment): (&Edges, [usize; D], Treatment<f64>),
    progress: &mut Progress,
) -> Result<SpaceReport> {
    let [dusty, faces_of_dust] = close_dust((&mut volume, &mut faces), edges.cells(), live);
    let tidied = flow.set_porosity(volume, faces, treatment).map_err(|e| refused(file, e))?;
    let Tidied { dust_cells, dust_faces, closed_faces, matched_faces } = tidied;
    if matched_faces > 0 {
        progress.warn(format!(
            "{}: {matched_faces} faces of periodic sides are more open than the side opposite: both let pass what the less open one does",
            file.path.display()
        ));
    }
    Ok(SpaceReport {
        closed_cells: flow.beta_v().map_or(0, |b| b.iter().filter(|&&b| b == 0.0).count()),
        jump_faces: flow.jump_faces(),
        merged_cells: flow.merged_cells(),
        dust_cells: dust_cells + dusty,
        dust_faces: dust_faces + faces_of_dust,
        closed_faces,
        matched_faces,
        step_share: 1.0,
    })
}

/// Gives all cells their states, and those of a mixed gas their ratios of specific heats; nothing flows in solid.
fn set_states<const D: usize>(flow: &mut Flow<f64, D>, Beginning { cells, gammas, .. }: &Beginning<D>) {
    for (cell, w) in cells.iter().enumerate() {
        let closed = flow.beta_v().is_some_and(|b| b[cell] == 0.0);
        let velocity = if closed { [0.0; D] } else { w.velocity };
        let gamma = gammas.get(cell).copied().unwrap_or(flow.gas().gamma());
        flow.set_mixed(cell, &Primitive { velocity, ..*w }, gamma);
    }
}

/// The stable step over that of the same gas in open space; 1 where there is none.
fn step_share<const D: usize>(flow: &mut Flow<f64, D>) -> f64 {
    let Ok(rate) = flow.rate() else { return 1.0 };
    let open = |cell: usize| {
        let (w, at) = (flow.get(cell), flow.coordinates(cell));
        let c = flow.gas_at(cell).sound_speed(&w);
        (0..D).map(|d| (w.velocity[d].abs() + c) * flow.area(d, at) / flow.volume(at)).sum::<f64>()
    };
    let gaseous = (0..flow.len()).filter(|&cell| flow.open_volume(cell) > 0.0);
    let share = gaseous.map(open).fold(0.0, f64::max) / rate;
    if share.is_finite() { share } else { 1.0 }
}

/// An error of the core as one of the case.
fn refused(file: &CaseFile, error: voidage_core::flow::Error) -> Error {
    Error::file(&file.path, format!("the flow cannot be set up: {error}"))
}

fn gas(file: &CaseFile, keys: &GasKeys) -> Result<Gas<f64>> {
    let GasKeys { model, gamma, sound_speed, rho, p, .. } = *keys;
    let given = [("gamma", gamma), ("sound_speed", sound_speed), ("rho", rho), ("p", p)];
    let needed: &[&str] = match model {
        Model::Ideal => &["gamma"],
        Model::Isothermal => &["sound_speed"],
        Model::Isentropic => &["gamma", "rho", "p"],
    };
    for (key, value) in given {
        match (needed.contains(&key), value) {
            (true, None) => return Err(file.wrong(&format!("gas.{key}"), "is missing")),
            (false, Some(_)) => {
                return Err(file.wrong(&format!("gas.{key}"), format!("is not a key of this model ({})", model.word())));
            }
            _ => {}
        }
    }
    let value = |v: Option<f64>| v.unwrap_or(f64::NAN); // asked for above
    Ok(match model {
        Model::Ideal => Gas::Ideal { gamma: value(gamma) },
        Model::Isothermal => Gas::Isothermal { sound_speed: value(sound_speed) },
        Model::Isentropic => Gas::Isentropic { gamma: value(gamma), density: value(rho), pressure: value(p) },
    })
}

fn scheme(file: &CaseFile) -> Result<(Scheme, usize)> {
    let keys = &file.case.scheme;
    let limiter = match (keys.order, keys.limiter) {
        (Some(1), None) => Limiter::FirstOrder,
        (Some(1), Some(_)) => return Err(file.wrong("scheme.limiter", "order 1 has no slopes to limit")),
        (None | Some(2), name) => name.unwrap_or(LimiterName::Mc).meaning(),
        (Some(order), _) => return Err(file.wrong("scheme.order", format!("is 1 or 2, not {order}"))),
    };
    let riemann = keys.riemann.unwrap_or(RiemannName::Hllc).meaning();
    let pressure = match keys.pressure.unwrap_or(Pressure::Geometric) {
        Pressure::Geometric => PressureForm::Geometric,
        Pressure::Paper => PressureForm::Paper,
    };
    Ok((Scheme { riemann, limiter, pressure }, keys.careful_steps.unwrap_or(CAREFUL_STEPS)))
}

/// First steps of a case that does not say, taken at a fifth of the stable step: full steps across a jump would leave a
/// trace at its place (L1 of the density of Sod's tube at 200 cells: 2.24e-3 without, 1.88e-3 with).
const CAREFUL_STEPS: usize = 5;

/// Share of the stable step of a case that does not say.
const USUAL_CFL: f64 = 0.8;

/// Tells that one state everywhere is no rest under gravity.
fn warn_of_level_start<const D: usize>(
    file: &CaseFile,
    gravity: &[f64; D],
    (edges, live): (&Edges, [usize; D]),
    progress: &mut Progress,
) {
    let is_level = file.case.initial.uniform.is_some() && file.case.initial.from.is_none();
    let [lo, hi] = edges.bounds();
    let drop = gravity.iter().zip(live).map(|(g, axis)| g.abs() * (hi - lo)[axis]).sum::<f64>();
    if is_level && drop > 0.0 {
        let reason = format!(
            "the state is the same at all heights, which is no rest under gravity: the gas begins to swing, as from one end to the other of the \
             domain its weight makes {} Pa for each kg/m³; an atmosphere in layers is read by initial.from",
            short(drop)
        );
        progress.warn(file.remark("initial.uniform", reason));
    }
}

/// Tells of upright sides and patches with one pressure at all heights, through which an atmosphere under gravity flows.
fn warn_of_level_pressures<const D: usize>(
    file: &CaseFile,
    flow: &Flow<f64, D>,
    live: [usize; D],
    progress: &mut Progress,
) {
    let mut tell = |stands: &Boundary<f64, D>, key: String| {
        if let Boundary::Outlet { .. } | Boundary::Reservoir { .. } | Boundary::FarField(_) = stands {
            let reason = "has one pressure at all heights: under gravity an atmosphere at rest flows in and out there; \
                          with \"wall\" or \"zero-gradient\" it stays at rest";
            progress.warn(file.remark(&key, reason));
        }
    };
    for d in (0..D).filter(|&d| (0..D).any(|e| e != d && flow.gravity[e] != 0.0)) {
        for side in 0..2 {
            tell(&flow.boundaries[d][side], format!("boundary.{}", side_word(live[d], side)));
        }
        for (n, patch) in flow.patches.iter().enumerate().filter(|(_, patch)| patch.axis == d) {
            tell(&patch.boundary, format!("boundary.patch[{n}]"));
        }
    }
}

fn gravity<const D: usize>(file: &CaseFile, live: [usize; D]) -> Result<[f64; D]> {
    let g = file.case.gravity.g.unwrap_or_default();
    for (axis, g) in g.into_iter().enumerate() {
        if g != 0.0 && !live.contains(&axis) {
            return Err(file.wrong("gravity.g", format!("acts along {}, which has one cell", AXES[axis])));
        }
    }
    Ok(live.map(|d| g[d]))
}

/// Keys of pictures and frames in a case that asks for none.
fn without_pictures(file: &CaseFile) -> Vec<String> {
    let output = &file.case.output;
    if output.formats().contains(&Format::Png) {
        return Vec::new();
    }
    let RangeKeys { speed, overpressure } = &output.range;
    let keys = [("slice", output.slice.is_some()), ("range", speed.is_some() || overpressure.is_some())];
    let given = keys.into_iter().filter(|(_, given)| *given);
    let mut said: Vec<String> =
        given.map(|(key, _)| file.remark(&format!("output.{key}"), "is of pictures: formats has no png")).collect();
    if output.every.is_some() && output.formats().is_empty() {
        said.push(file.remark("output.every", "is of frames: formats is empty, and none is written"));
    }
    said
}

type Coefficients<const D: usize> = [[Vec<f64>; D]; 2];

/// Quadratic and linear coefficients of the live axes; empty where zero. None if all are.
fn drag<const D: usize>(
    file: &CaseFile,
    edges: &Edges,
    live: [usize; D],
    by_law: Option<[Vec<f64>; D]>,
) -> Result<Option<Coefficients<D>>> {
    let keys = &file.case.drag;
    let count: usize = edges.cells().iter().product();
    let from = keys.from.as_ref().map(|dir| file.fields("drag.from", dir, edges)).transpose()?;
    let mut all: Coefficients<D> = std::array::from_fn(|_| std::array::from_fn(|_| Vec::new()));
    for (n, (name, constants)) in [("cr", keys.cr), ("linear", keys.linear)].into_iter().enumerate() {
        // The same along all axes may stand in a case of fewer.
        let acts = constants.filter(|all| live.iter().all(|&axis| all[axis] == 0.0)).unwrap_or_default();
        if let Some(axis) = (0..3).find(|&axis| acts[axis] != 0.0) {
            let reason = format!("acts only along {}, which has one cell", AXES[axis]);
            return Err(file.wrong(&format!("drag.{name}"), reason));
        }
        for (d, &axis) in live.iter().enumerate() {
            let array = from.as_ref().map(|dir| dir.join(format!("{name}_{}.npy", AXES[axis])));
            all[n][d] = match (array.filter(|path| path.exists()), constants) {
                (Some(_), Some(_)) => {
                    return Err(file.wrong(&format!("drag.{name}"), "is given here and in drag.from"));
                }
                (Some(path), None) => file.array("drag.from", &path, edges.cells(), |c| NOT_NEGATIVE.refuses(c))?,
                (None, Some(constants)) => {
                    vec![constants[axis]; if constants[axis] == 0.0 { 0 } else { count }]
                }
                (None, None) => Vec::new(),
            };
        }
    }
    if let Some(by_law) = by_law {
        all[0] = by_law;
    }
    if let Some(dir) = from.filter(|_| all.iter().flatten().all(Vec::is_empty)) {
        let of_others = (0..3).filter(|a| !live.contains(a)).map(|a| (a, format!("cr_{}.npy", AXES[a])));
        let reason = match of_others.into_iter().find(|(_, name)| dir.join(name).exists()) {
            Some((axis, name)) => {
                format!("{name} is of the axis {}, which has one cell; of the others there is none", AXES[axis])
            }
            None => NOTHING.to_owned(),
        };
        return Err(file.wrong("drag.from", format!("{}: {reason}", dir.display())));
    }
    all.iter_mut().flatten().filter(|c| c.iter().all(|&x| x == 0.0)).for_each(Vec::clear);
    Ok(if all.iter().flatten().all(Vec::is_empty) { None } else { Some(all) })
}

/// Of a directory without coefficients.
const NOTHING: &str = "there is none of cr_x.npy, cr_y.npy, cr_z.npy, linear_x.npy, linear_y.npy, linear_z.npy";
