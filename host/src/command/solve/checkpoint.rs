//! Checkpoints: all that a run needs to go on to the bit, in one file that appears whole or not at all.
//!
//! Layout: eight bytes of magic and version, the length of a JSON header (u64), the header, the conserved fields as f64 (density, momentum along
//! each axis of the flow, energy if there is any), the largest values over time if they are kept, CRC-32 of all before; everything little endian. The header names the
//! case by checksums of its parts, so that a checkpoint of another case is refused with the part that differs.

use super::force_peaks::ForcePeak;
use super::inlet::Inlet;
use super::maxima::Maxima;
use super::setup::Setup;
use crate::error::{Error, Result};
use crate::files::atomically;
use crate::files::bytes::write_f64;
use crate::flow::{Clock, Field};
use crate::huge::HugeVec;
use serde::{Deserialize, Serialize};
use std::io::{self, Write};
use std::path::Path;
use voidage_core::flow::{Boundary, Conserved, Gas, Limiter, PressureForm, Primitive, Report, Riemann, Scheme};

/// First bytes of the file; the last is the version of the layout.
const MAGIC: &[u8; 8] = b"VOIDAGE\x06";

/// Values of a watched cell: its number, two sides, two masses and a drag for each axis, and all parts of what acts along two sides.
const fn watched(dimensions: usize) -> usize {
    1 + (5 + 2 * dimensions) * dimensions
}

/// Name of the file in the output directory.
pub const NAME: &str = "checkpoint.bin";

/// Name of the copy of the last checkpoint from before the first floor.
pub const UNTOUCHED: &str = "checkpoint_before_floors.bin";

/// Keeps the present checkpoint in `dir`, the last one before a floor: later ones take its place, not that of the copy.
///
/// # Errors
/// The file cannot be copied.
pub fn keep_untouched(dir: &Path) -> Result<()> {
    let (from, to) = (dir.join(NAME), dir.join(UNTOUCHED));
    let bytes = std::fs::read(&from).map_err(|e| Error::io(&from, "read", &e))?;
    atomically(&to, |out| out.write_all(&bytes))
}

/// Name of the last checkpoint of an unfinished run in whose place another begins.
pub const BEFORE: &str = "checkpoint_before.bin";

/// The tables that a checkpoint goes on with, and their names beside [`BEFORE`].
const TABLES: [(&str, &str); 3] =
    [("log.csv", "log_before.csv"), ("probes.csv", "probes_before.csv"), ("monitors.csv", "monitors_before.csv")];

/// The frames of a run, and their name beside [`BEFORE`].
const FRAMES: [&str; 2] = ["frames", "frames_before"];

/// Renames the checkpoint in `dir`, its frames and the tables that go with it, as far as they are there; returns the new names of the checkpoint and the tables, the
/// checkpoint's first.
///
/// # Errors
/// A file cannot be renamed.
pub fn put_aside(dir: &Path) -> Result<Vec<&'static str>> {
    let [frames, before] = FRAMES.map(|name| dir.join(name));
    if dir.join(NAME).exists() && frames.is_dir() {
        let renamed = match std::fs::remove_dir_all(&before) {
            Err(e) if e.kind() != io::ErrorKind::NotFound => Err(e),
            _ => std::fs::rename(&frames, &before),
        };
        renamed.map_err(|e| Error::io(&frames, "rename", &e))?;
    }
    let all = std::iter::once((NAME, BEFORE)).chain(TABLES);
    let renamed = all.map(|(from, to)| match std::fs::rename(dir.join(from), dir.join(to)) {
        Ok(()) => Ok(Some(to)),
        Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(e) => Err(Error::io(&dir.join(from), "rename", &e)),
    });
    renamed.filter_map(Result::transpose).collect()
}

/// What the run has written and counted so far.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Journal {
    /// Times of the frames.
    pub frames: Vec<f64>,
    /// Bytes of `log.csv`.
    pub log: u64,
    /// Bytes of `probes.csv`.
    pub probes: u64,
    /// Bytes of `monitors.csv`.
    pub monitors: u64,
    /// Checksums of the places of probes and monitors.
    #[serde(default)]
    pub places: [u32; 2],
    /// Mass and energy at the beginning.
    pub begin: [f64; 2],
    /// Seconds of stepping.
    pub seconds: f64,
    /// Largest forces on solids so far.
    pub peaks: Vec<ForcePeak>,
    /// The last step, in s.
    #[serde(default)]
    pub dt: f64,
    /// The cell through which pictures are cut, if there are any.
    #[serde(default)]
    pub cut: Option<[usize; 3]>,
}

#[derive(Debug, Serialize, Deserialize)]
struct Header {
    case: Fingerprint,
    journal: Journal,
    values: usize,
    /// Values of the largest values over time, after those of the state.
    maxima: usize,
    /// Values of what acted on walls in the last step, after those.
    walls: usize,
    time: f64,
    steps: usize,
    repeated: usize,
    rate: f64,
    first_order: usize,
    floored: usize,
    /// Changed by floors: density, momentum, energy.
    floor_change: Vec<f64>,
    /// Through both sides of each axis: density, momentum, energy.
    inflow: Vec<f64>,
    inlet_pressures: Vec<f64>,
}

/// Checksums of the parts of a case that decide its flow. How long it runs and what it writes may change.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fingerprint(Vec<(String, u32)>);

impl Fingerprint {
    /// Of a flow at its beginning.
    pub fn new<const D: usize>(setup: &Setup<D>) -> Self {
        let Setup { flow, edges, .. } = setup;
        let of_arrays = |arrays: &mut dyn Iterator<Item = &[f64]>| {
            let mut out = Checksum { inner: io::sink(), hasher: crc32fast::Hasher::new() };
            for a in arrays {
                let _ = write_f64(&mut out, &[a.len() as f64]).and_then(|()| write_f64(&mut out, a)); // to a sink
            }
            out.hasher.finalize()
        };
        let of_numbers = |numbers: &[f64]| of_arrays(&mut std::iter::once(numbers));
        let inlets = setup.inlets.iter().flat_map(|i| {
            [i.at.0 as f64, i.at.1 as f64, i.relax, i.per_pressure.unwrap_or(0.0)] // 0: the density is given
        });
        let mut sides: Vec<f64> = flow.boundaries.iter().flatten().flat_map(side_numbers).chain(inlets).collect();
        for patch in &flow.patches {
            let place = [patch.axis, usize::from(patch.high)].into_iter().chain(patch.first).chain(patch.end);
            sides.extend(place.map(|n| n as f64).chain(side_numbers(&patch.boundary)));
        }
        if flow.gas().is_mixed() {
            sides.extend(flow.feed_sides.iter().flatten().chain(&flow.feed_patches));
        }
        let treatment = [setup.treatment.jump, f64::from(u8::from(setup.treatment.merge))];
        let scheme = [&scheme_numbers(&flow.scheme)[..], &[setup.cfl, flow.careful_steps as f64]].concat();
        let parts = [
            ("grid", of_arrays(&mut edges.0.iter().map(|e| &e[..]))),
            ("porosity", of_arrays(&mut flow.beta_v().into_iter().chain(flow.faces()))),
            ("treatment of the porosity", of_numbers(&treatment)),
            ("gas", of_numbers(&gas_numbers(&flow.gas()))),
            ("initial state", of_arrays(&mut columns(&flow.state))),
            ("boundary", of_numbers(&sides)),
            ("drag", of_arrays(&mut flow.drag())),
            ("gravity", of_numbers(&flow.gravity)),
            ("scheme", of_numbers(&scheme)),
        ];
        Fingerprint(parts.map(|(name, sum)| (name.to_owned(), sum)).to_vec())
    }

    /// With the pressure that forces are counted from.
    #[must_use]
    pub fn with_ambient(mut self, ambient: f64) -> Self {
        self.0.push(("output.ambient".to_owned(), crc32fast::hash(&ambient.to_le_bytes())));
        self
    }

    /// With the numbers that decide which largest values are kept.
    #[must_use]
    pub fn with_maxima(mut self, maxima: &Maxima) -> Self {
        let mut hasher = crc32fast::Hasher::new();
        maxima.numbers().iter().for_each(|x| hasher.update(&x.to_le_bytes()));
        self.0.push(("output.maxima".to_owned(), hasher.finalize()));
        self
    }
}

// Kinds as numbers, each with its values: they mean the same in every version, whatever the kinds are called in the code.

/// Number of a kind that this program does not name; a kind that a case file can name has one of its own.
const UNNAMED: f64 = -1.0;

/// A gas in a checkpoint: the number of its kind, and what it takes.
pub fn gas_numbers(gas: &Gas<f64>) -> Vec<f64> {
    match *gas {
        Gas::Ideal { gamma } => vec![0.0, gamma],
        Gas::Isothermal { sound_speed } => vec![1.0, sound_speed],
        Gas::Isentropic { gamma, density, pressure } => vec![2.0, gamma, density, pressure],
        Gas::Mixed { gammas } => [&[3.0], &gammas[..]].concat(),
        _ => vec![UNNAMED],
    }
}

/// A side in a checkpoint: the number of its kind, and the state behind it.
pub fn side_numbers<const D: usize>(side: &Boundary<f64, D>) -> Vec<f64> {
    let state = |kind: f64, w: &Primitive<f64, D>| [&[kind, w.density][..], &w.velocity[..], &[w.pressure]].concat();
    match side {
        Boundary::Periodic => vec![0.0],
        Boundary::Wall => vec![1.0],
        Boundary::ZeroGradient => vec![2.0],
        Boundary::FarField(w) => state(3.0, w),
        Boundary::Inlet(w) => state(4.0, w),
        Boundary::Outlet { pressure } => vec![5.0, *pressure],
        Boundary::Reservoir { density, pressure } => vec![6.0, *density, *pressure],
        _ => vec![UNNAMED],
    }
}

/// A scheme in a checkpoint: the numbers of the Riemann solver, the limiter and the form of the pressure.
pub fn scheme_numbers(scheme: &Scheme) -> [f64; 3] {
    let riemann = match scheme.riemann {
        Riemann::Hllc => 0.0,
        Riemann::Hlle => 1.0,
        Riemann::Rusanov => 2.0,
        Riemann::HllcLowMach => 3.0,
        _ => UNNAMED,
    };
    let limiter = match scheme.limiter {
        Limiter::FirstOrder => 0.0,
        Limiter::MonotonizedCentral => 1.0,
        Limiter::Steep => 2.0,
        Limiter::VanLeer => 3.0,
        Limiter::Minmod => 4.0,
        Limiter::Unlimited => 5.0,
        Limiter::AroraRoe => 6.0,
        _ => UNNAMED,
    };
    let pressure = match scheme.pressure {
        PressureForm::Geometric => 0.0,
        PressureForm::Paper => 1.0,
        _ => UNNAMED,
    };
    [riemann, limiter, pressure]
}

/// The fields of a state in the order of the file.
fn columns<const D: usize>(state: &Field<f64, D>) -> impl Iterator<Item = &[f64]> {
    let momentum = state.momentum.iter().map(|m| &m[..]);
    // Of a gas that is not mixed the file knows nothing of capacities.
    let capacity = Some(&state.capacity[..]).filter(|c| !c.is_empty());
    std::iter::once(&state.density[..]).chain(momentum).chain(std::iter::once(&state.energy[..])).chain(capacity)
}

/// Writes a checkpoint.
///
/// # Errors
/// The file cannot be written; an older one is then untouched.
pub fn write<const D: usize>(
    path: &Path,
    case: &Fingerprint,
    setup: &Setup<D>,
    clock: &Clock<f64, D>,
    journal: &Journal,
    maxima: Option<&Maxima>,
) -> Result<()> {
    let flow = &setup.flow;
    let Clock { time, steps, repeated, total } = *clock;
    let through = |c: &Conserved<f64, D>| [&[c.density][..], &c.momentum[..], &[c.energy][..]].concat();
    let header = Header {
        case: case.clone(),
        journal: journal.clone(),
        values: columns(&flow.state).map(<[f64]>::len).sum(),
        maxima: maxima.iter().flat_map(|m| m.arrays()).map(<[f64]>::len).sum(),
        walls: flow.watched_walls().1.len() * watched(D),
        time,
        steps,
        repeated,
        rate: total.rate,
        first_order: total.first_order,
        floored: total.floored,
        floor_change: through(&total.floor_change),
        inflow: total.inflow.iter().flatten().flat_map(through).collect(),
        inlet_pressures: setup.inlets.iter().map(|i| i.pressure(flow)).collect(),
    };
    atomically(path, |out| {
        let mut out = Checksum { inner: out, hasher: crc32fast::Hasher::new() };
        let text = serde_json::to_vec(&header)?;
        out.write_all(MAGIC)?;
        out.write_all(&(text.len() as u64).to_le_bytes())?;
        out.write_all(&text)?;
        columns(&flow.state).try_for_each(|values| write_f64(&mut out, values))?;
        maxima.iter().flat_map(|m| m.arrays()).try_for_each(|values| write_f64(&mut out, values))?;
        let (cells, pushes) = flow.watched_walls();
        cells.iter().zip(pushes).try_for_each(|(&cell, push)| {
            write_f64(&mut out, &[cell as f64])?;
            write_f64(&mut out, push.sides.as_flattened())?;
            write_f64(&mut out, push.mass.as_flattened())?;
            write_f64(&mut out, &push.drag)?;
            write_f64(&mut out, push.along.as_flattened().as_flattened())
        })?;
        let sum = out.hasher.finalize();
        out.inner.write_all(&sum.to_le_bytes())
    })
}

/// There is a checkpoint in a directory: asked before the case is set up, which may take long.
///
/// # Errors
/// There is none.
pub fn expect(dir: &Path) -> Result<()> {
    let path = dir.join(NAME);
    std::fs::metadata(&path).map(drop).map_err(|e| unread(&path, &e))
}

fn unread(path: &Path, e: &io::Error) -> Error {
    match e.kind() {
        io::ErrorKind::NotFound => Error::file(path, "there is no checkpoint to resume from; run without --resume"),
        _ => Error::io(path, "read", e),
    }
}

/// Puts the flow of `setup` where the checkpoint left it. Returns what that run had written and counted.
///
/// # Errors
/// The file cannot be read, is damaged, or belongs to another case.
pub fn resume<const D: usize>(
    path: &Path,
    case: &Fingerprint,
    setup: &mut Setup<D>,
    maxima: Option<&mut Maxima>,
) -> Result<Journal> {
    let bytes = std::fs::read(path).map_err(|e| unread(path, &e))?;
    if bytes.is_empty() {
        return Err(Error::file(path, "is empty (0 bytes): there is nothing to resume from; run without --resume"));
    }
    let (header, values) = parse(&bytes).map_err(|reason| Error::file(path, reason))?;
    let differ = |(a, b): &(&(String, u32), &(String, u32))| a != b;
    if let Some((part, _)) = case.0.iter().zip(&header.case.0).find(differ) {
        return Err(Error::file(path, format!("is of another case: its {} differs; run without --resume", part.0)));
    }
    let wrong = || Error::file(path, "is damaged: its parts do not fit the case");
    let mut values = values.chunks_exact(8).map(|b| f64::from_le_bytes(std::array::from_fn(|i| b[i])));
    let mut take = |like: &HugeVec| HugeVec::from(values.by_ref().take(like.len()).collect::<Vec<_>>());
    let old = &setup.flow.state;
    let density = take(&old.density);
    let momentum = old.momentum.each_ref().map(&mut take);
    let (energy, capacity) = (take(&old.energy), take(&old.capacity));
    let state = Field { density, momentum, energy, capacity };
    let wanted: usize = maxima.iter().flat_map(|m| m.arrays()).map(<[f64]>::len).sum();
    if wanted != header.maxima {
        let reason =
            "knows other largest values over time than output.maxima or --refine-check asks for; run without --resume";
        return Err(Error::file(path, reason));
    }
    for array in maxima.into_iter().flat_map(|m| m.arrays_mut()) {
        array.iter_mut().zip(values.by_ref()).for_each(|(into, from)| *into = from);
    }
    let walls: Vec<f64> = values.collect();
    let Header { time, steps, repeated, rate, first_order, floored, .. } = header;
    let mut total = Report { rate, first_order, floored, ..Report::new() };
    let lengths = header.inflow.len() == 2 * D * (D + 2) && header.floor_change.len() == D + 2;
    if !lengths || header.inlet_pressures.len() != setup.inlets.len() {
        return Err(wrong());
    }
    let amount = |from: &[f64]| {
        let momentum = std::array::from_fn(|c| from[1 + c]);
        Conserved { density: from[0], momentum, energy: from[D + 1] }
    };
    total.floor_change = amount(&header.floor_change);
    for (into, from) in total.inflow.iter_mut().flatten().zip(header.inflow.chunks_exact(D + 2)) {
        *into = amount(from);
    }
    setup.flow.resume(state, Clock { time, steps, repeated, total }).map_err(|_| wrong())?;
    restore_walls(setup, &walls);
    let restore = |(inlet, p): (&Inlet<D>, f64)| inlet.set_pressure(&mut setup.flow, p);
    setup.inlets.iter().zip(header.inlet_pressures).for_each(restore);
    Ok(header.journal)
}

/// Puts back what acted on the walls of the watched cells in the last step. Of cells that the case watches now and did not watch then the state alone tells,
/// until the next step.
fn restore_walls<const D: usize>(setup: &mut Setup<D>, walls: &[f64]) {
    setup.flow.watch_walls_anew();
    let (cells, pushes) = setup.flow.watched_walls();
    let mut pushes = pushes.to_vec();
    for kept in walls.chunks_exact(watched(D)) {
        let Ok(place) = cells.binary_search(&(kept[0] as usize)) else { continue };
        let push = &mut pushes[place];
        let sides = push.sides.as_flattened_mut().iter_mut();
        let along = push.along.as_flattened_mut().as_flattened_mut();
        let into = sides.chain(push.mass.as_flattened_mut()).chain(&mut push.drag).chain(along);
        into.zip(&kept[1..]).for_each(|(into, from)| *into = *from);
    }
    setup.flow.restore_walls(&pushes);
}

/// Header and values, or the reason why there are none.
fn parse(bytes: &[u8]) -> std::result::Result<(Header, &[u8]), String> {
    let damaged = |what: &str| format!("is damaged: {what}; without --resume the run begins anew");
    let rest = bytes.strip_prefix(MAGIC).ok_or("is no checkpoint of this version")?;
    let (body, sum) = bytes.split_last_chunk::<4>().ok_or_else(|| damaged("it ends too early"))?;
    if crc32fast::hash(body) != u32::from_le_bytes(*sum) {
        return Err(damaged("its checksum is wrong"));
    }
    let (length, rest) = rest.split_first_chunk::<8>().ok_or_else(|| damaged("it ends too early"))?;
    let length = usize::try_from(u64::from_le_bytes(*length)).unwrap_or(usize::MAX);
    let text = rest.get(..length).ok_or_else(|| damaged("it ends too early"))?;
    let header: Header = serde_json::from_slice(text).map_err(|e| damaged(&e.to_string()))?;
    let values = &rest[length..rest.len().saturating_sub(4).max(length)];
    let count = header.values.checked_add(header.maxima).and_then(|n| n.checked_add(header.walls));
    if count.and_then(|n| n.checked_mul(8)) != Some(values.len()) {
        return Err(damaged("it ends too early"));
    }
    Ok((header, values))
}

/// Passes bytes on and sums them up.
struct Checksum<W> {
    inner: W,
    hasher: crc32fast::Hasher,
}

impl<W: Write> Write for Checksum<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let n = self.inner.write(bytes)?;
        self.hasher.update(&bytes[..n]);
        Ok(n)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}
