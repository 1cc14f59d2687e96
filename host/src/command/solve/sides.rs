//! The sides of the domain, and patches on them: from the keys of a case to what stands there.

use super::case::{Kind, SideName, StateKeys, side_word};
use super::case_file::CaseFile;
use super::inlet::Inlet;
use super::places::STATE;
use super::regions::Region;
use super::state::States;
use crate::command::progress::Progress;
use crate::error::Result;
use crate::flow::Flow;
use crate::grid::{AXES, Edges};
use crate::picture::ticks::number as short;
use serde::Serialize;
use voidage_core::flow::{Boundary, Patch, Primitive};

/// What stands at the sides of the axes that flow.
#[derive(Debug)]
pub struct Sides<const D: usize> {
    /// Low and high side of each axis.
    pub boundaries: [[Boundary<f64, D>; 2]; D],
    /// Parts of them where something else stands.
    pub patches: Vec<Patch<f64, D>>,
    /// Of a mixed gas the ratios of specific heats of what sides and patches feed.
    pub feed: ([[f64; 2]; D], Vec<f64>),
    /// The inlets among both.
    pub inlets: Vec<Inlet<D>>,
}

/// What a patch came to.
#[derive(Debug, Clone, Serialize)]
pub struct PatchReport {
    /// Its side, as in the case.
    pub side: String,
    /// What stands there, as in the case.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Faces of cells that it covers.
    pub faces: usize,
    /// Their open area, in m².
    pub area: f64,
}

/// One side or patch of a case: its table, and where it stands.
struct Place<'a> {
    key: String,
    keys: &'a StateKeys,
    /// Axis among those that flow, and 0 for its low or 1 for its high side.
    at: (usize, usize),
    patch: Option<usize>,
}

/// The sides of the live axes, and the inlets among them; `cells` are the states at the beginning.
///
/// # Errors
/// A side is missing, or its keys are not those of its type; a patch stands on no side that could have one.
pub fn sides<const D: usize>(
    file: &CaseFile,
    states: &States<'_, D>,
    edges: &Edges,
    cells: &[Primitive<f64, D>],
) -> Result<Sides<D>> {
    let given = file.case.boundary.by_axis();
    let feed = ([[states.gas.gamma(); 2]; D], Vec::new());
    let mut sides = Sides { boundaries: [[Boundary::Wall; 2]; D], patches: Vec::new(), feed, inlets: Vec::new() };
    for axis in 0..3 {
        for side in 0..2 {
            let key = format!("boundary.{}", side_word(axis, side));
            let Some(d) = states.live.iter().position(|&a| a == axis) else {
                given[axis][side].map_or(Ok(()), |keys| no_flow_through(file, key, keys))?;
                continue;
            };
            let keys = given[axis][side]
                .ok_or_else(|| file.wrong(&key, "is missing: a table with type, or a word such as \"wall\""))?;
            let place = Place { key, keys, at: (d, side), patch: None };
            sides.boundaries[d][side] = boundary(states, edges, cells, &place, &mut sides.inlets)?;
            sides.feed.0[d][side] = states.gamma(keys, None);
        }
        let periodic = [0, 1].map(|s| given[axis][s].and_then(|k| k.kind) == Some(Kind::Periodic));
        if periodic[0] != periodic[1] {
            let key = format!("boundary.{}", side_word(axis, usize::from(periodic[1])));
            return Err(file.wrong(&key, "an axis is periodic on both sides or on none"));
        }
    }
    for (n, keys) in file.case.boundary.patch.iter().enumerate() {
        let place = patch_place(states, n, keys)?;
        let (d, side) = place.at;
        if sides.boundaries[d][side].is_periodic() {
            return Err(file.wrong(&format!("{}.side", place.key), "is periodic: it has no parts"));
        }
        let boundary = boundary(states, edges, cells, &place, &mut sides.inlets)?;
        let (first, end) = covered(&Region::new(file, &place.key, keys)?, edges, states.live);
        sides.feed.1.push(states.gamma(keys, None));
        sides.patches.push(Patch { axis: d, high: side == 1, first, end, boundary });
    }
    Ok(sides)
}

/// Where the `n`-th patch stands.
fn patch_place<'a, const D: usize>(states: &States<'_, D>, n: usize, keys: &'a StateKeys) -> Result<Place<'a>> {
    let key = format!("boundary.patch[{n}]");
    let wrong = |name: &str, reason: String| Err(states.file.wrong(&format!("{key}{name}"), reason));
    let Some(side) = keys.side else {
        return wrong("", "needs a side: x_min, x_max, y_min, y_max, z_min or z_max".into());
    };
    let (axis, high) = side.place();
    match states.live.iter().position(|&a| a == axis) {
        _ if D < 2 => wrong("", "a flow along one axis has no parts of sides".into()),
        None => wrong(".side", format!("the axis {} has one cell: nothing flows through its sides", AXES[axis])),
        Some(_) if keys.kind == Some(Kind::Periodic) => wrong(".type", "a part of a side cannot be periodic".into()),
        Some(d) => Ok(Place { key, keys, at: (d, high), patch: Some(n) }),
    }
}

/// The cells whose middles a box holds along each live axis: the first, and one past the last.
fn covered<const D: usize>(region: &Region, edges: &Edges, live: [usize; D]) -> ([usize; D], [usize; D]) {
    let middles = |a: usize| edges.0[a].windows(2).map(|e| f64::midpoint(e[0], e[1]));
    let below = |a: usize, x: f64| middles(a).take_while(|m| *m < x).count();
    let up_to = |a: usize, x: f64| middles(a).take_while(|m| *m <= x).count();
    // A box that the axes of one cell lie outside of covers nothing.
    let apart = (0..3).any(|a| !live.contains(&a) && below(a, region.extent(a)[0]) >= up_to(a, region.extent(a)[1]));
    let end = |a: usize| if apart { 0 } else { up_to(a, region.extent(a)[1]) };
    (live.map(|a| below(a, region.extent(a)[0])), live.map(end))
}

/// What stands at a place.
fn boundary<const D: usize>(
    states: &States<'_, D>,
    edges: &Edges,
    cells: &[Primitive<f64, D>],
    place: &Place<'_>,
    inlets: &mut Vec<Inlet<D>>,
) -> Result<Boundary<f64, D>> {
    let (file, Place { key, keys, at: (d, side), patch }) = (states.file, place);
    let kind = keys.kind.ok_or_else(|| file.wrong(key, "needs a type"))?;
    only_its_keys(file, (key, keys), kind, if patch.is_some() { &["side", "min", "max"] } else { &[] })?;
    Ok(match kind {
        Kind::Wall => Boundary::Wall,
        Kind::ZeroGradient => Boundary::ZeroGradient,
        Kind::Periodic => Boundary::Periodic,
        Kind::FarField => Boundary::FarField(states.state(key, keys, None)?),
        Kind::Outlet => Boundary::Outlet { pressure: keys.p.ok_or_else(|| file.wrong(key, "an outlet needs p"))? },
        Kind::Reservoir if states.gas.is_mixed() => {
            let reason = "a reservoir is of one gas: with a gamma in any state take an inlet or a far-field";
            return Err(file.wrong(key, reason));
        }
        Kind::Reservoir => {
            let Primitive { density, pressure, .. } = states.state(key, keys, None)?;
            Boundary::Reservoir { density, pressure }
        }
        Kind::Inlet => {
            let some = cells.first().map_or(f64::NAN, |w| w.pressure);
            let (mut inlet, state) = Inlet::new(states, key, keys, (*d, *side), some, edges)?;
            inlet.patch = *patch;
            inlets.push(inlet);
            Boundary::Inlet(state)
        }
    })
}

/// An axis of one cell is no part of the flow, so nothing may come through its sides.
fn no_flow_through(file: &CaseFile, key: String, keys: &StateKeys) -> Result<()> {
    let kind = keys.kind.ok_or_else(|| file.wrong(&key, "needs a type"))?;
    if let Kind::Inlet | Kind::FarField | Kind::Outlet | Kind::Reservoir = kind {
        return Err(file.wrong(&key, "the axis has one cell: only wall, zero-gradient or periodic make sense there"));
    }
    only_its_keys(file, (&key, keys), kind, &[])
}

/// Keys that a type of boundary has no use for are errors.
fn only_its_keys(file: &CaseFile, (key, keys): (&str, &StateKeys), kind: Kind, of_place: &[&str]) -> Result<()> {
    let of_kind: &[&str] = match kind {
        Kind::Inlet => &["rho", "T", "u", "v", "w", "p", "gamma", "relax"],
        Kind::FarField => &STATE,
        Kind::Outlet => &["p"],
        Kind::Reservoir => &["rho", "T", "p"],
        Kind::Wall | Kind::ZeroGradient | Kind::Periodic => &[],
    };
    match keys.given().into_iter().find(|k| !of_kind.contains(k) && !of_place.contains(k)) {
        Some(other) => {
            let reason = format!("is not a key of this type ({})", kind.word());
            Err(file.wrong(&format!("{key}.{other}"), reason))
        }
        None => Ok(()),
    }
}

/// A patch whose faces miss its box by more than this share of it is told.
const MISSED_AREA: f64 = 0.02;

/// The area of the side that the box of a patch holds, and that of the faces that it covers, solids and other patches aside.
fn areas_of<const D: usize>(patch: &Patch<f64, D>, region: &Region, edges: &Edges, live: [usize; D]) -> [f64; 2] {
    let mut areas = [edges.across(&live); 2];
    for (d, &a) in live.iter().enumerate().filter(|(d, _)| *d != patch.axis) {
        let planes = &edges.0[a];
        let [low, high] = region.extent(a).map(|at| at.clamp(planes[0], planes[planes.len() - 1]));
        areas[0] *= high - low;
        areas[1] *= planes[patch.end[d]] - planes[patch.first[d]];
    }
    areas
}

/// Tells of sides that gas could pass, all of whose faces solids close; inlets are told apart.
pub fn warn_of_closed<const D: usize>(file: &CaseFile, flow: &Flow<f64, D>, live: [usize; D], progress: &mut Progress) {
    for (d, side) in (0..D).flat_map(|d| [(d, 0), (d, 1)]) {
        let stands = &flow.boundaries[d][side];
        if matches!(stands, Boundary::Wall | Boundary::Periodic | Boundary::Inlet(_)) {
            continue;
        }
        let faces = flow.side(d, side, None);
        if !faces.is_empty() && faces.iter().all(|(_, area)| *area == 0.0) {
            let key = format!("boundary.{}", side_word(live[d], side));
            progress.warn(file.remark(&key, "solids close all faces of this side: no gas passes it"));
        }
    }
}

/// What the patches of a flow came to; those that cover nothing are told.
pub fn report<const D: usize>(
    file: &CaseFile,
    flow: &Flow<f64, D>,
    edges: &Edges,
    live: [usize; D],
    progress: &mut Progress,
) -> Result<Vec<PatchReport>> {
    let across = edges.across(&live);
    let mut all = Vec::new();
    for (n, (patch, keys)) in flow.patches.iter().zip(&file.case.boundary.patch).enumerate() {
        let faces = flow.side(patch.axis, usize::from(patch.high), Some(n));
        // A sum of nothing would be −0.
        let area = across * faces.iter().fold(0.0, |sum, (_, area)| sum + area);
        let trouble = match (faces.is_empty(), area > 0.0) {
            (true, _) if n + 1 == flow.patches.len() => "covers the middle of no face of its side: it has no effect",
            (true, _) => "covers the middle of no face of its side, or later patches cover the same: it has no effect",
            (false, false) => "covers faces that solids close: it has no effect",
            (false, true) => "",
        };
        if !trouble.is_empty() {
            progress.warn(file.remark(&format!("boundary.patch[{n}]"), trouble));
        }
        let region = Region::new(file, &format!("boundary.patch[{n}]"), keys)?;
        let [asked, covered] = areas_of(patch, &region, edges, live);
        if area > 0.0 && (covered - asked).abs() > MISSED_AREA * asked {
            let reason = format!(
                "the faces whose middles its box holds have {} m² of the side, the box itself {} m²: its sides belong into planes of the grid",
                short(covered),
                short(asked)
            );
            progress.warn(file.remark(&format!("boundary.patch[{n}]"), reason));
        }
        // Numbers of a box stand for x, y and z, also where one of them is along the axis of the side.
        let numbers = [&keys.min, &keys.max].into_iter().flatten().map(Vec::len).max().unwrap_or(AXES.len());
        if let Some(&open) = live.iter().find(|&&a| a != live[patch.axis] && numbers <= a) {
            let reason = format!(
                "its box has numbers along {} alone: along {} it reaches from end to end of the side",
                AXES[..numbers].join(" and "),
                AXES[open]
            );
            progress.warn(file.remark(&format!("boundary.patch[{n}]"), reason));
        }
        all.push(PatchReport {
            side: keys.side.map_or_else(String::new, SideName::word),
            kind: keys.kind.map_or("", Kind::word),
            faces: faces.len(),
            area,
        });
    }
    Ok(all)
}
