//! States of a case: from the keys of a table, and of all cells at the beginning.

use super::arrays;
use super::case::{StateKeys, VELOCITIES};
use super::case_file::CaseFile;
use super::mixture;
use super::open_parts::{Hold, OpenParts};
use super::places::STATE;
use super::ranges::{GAMMA, QUANTITY, SIGNED};
use super::regions::Region;
use crate::command::stages;
use crate::error::{Error, Result};
use crate::grid::{AXES, Edges};
use crate::words::written;
use std::collections::BTreeMap;
use std::path::Path;
use voidage_core::flow::{Conserved, Gas, Primitive};

/// What is needed to read a state.
#[derive(Debug, Clone, Copy)]
pub struct States<'a, const D: usize> {
    /// The case, for errors.
    pub file: &'a CaseFile,
    /// The gas.
    pub gas: Gas<f64>,
    /// R in p = rho R T.
    pub gas_constant: Option<f64>,
    /// The axes that flow.
    pub live: [usize; D],
}

/// A barotropic state may be given by density and pressure if both say the same, to this relative error.
const AGREEMENT: f64 = 1e-9;

/// What a run keeps for each cell, at least: a grid too large for any memory is refused before it is filled.
const BYTES_A_CELL: usize = 128;

/// All cells at the beginning, x fastest.
#[derive(Debug, Clone)]
pub struct Beginning<const D: usize> {
    /// Their states.
    pub cells: Vec<Primitive<f64, D>>,
    /// The ratio of specific heats of each cell of a mixed gas; else empty.
    pub gammas: Vec<f64>,
    /// The cells that regions hold in part.
    shared: BTreeMap<usize, SharedCell<D>>,
}

impl<const D: usize> Beginning<D> {
    /// The cells that regions hold in part, each with these regions in their order.
    pub fn holds(&self) -> impl Iterator<Item = (usize, &[Hold])> {
        self.shared.iter().map(|(&cell, shared)| (cell, &shared.holds[..]))
    }
}

/// A cell that regions hold in part.
#[derive(Debug, Clone)]
struct SharedCell<const D: usize> {
    /// What is there before them, if that is known.
    under: Option<Filled<D>>,
    /// They, in their order, with those of them that hold all of it.
    holds: Vec<Hold>,
}

impl<const D: usize> States<'_, D> {
    /// The ratio of specific heats of a table; if it gives none, `base`, or that of the gas of the case.
    #[must_use]
    pub fn gamma(&self, keys: &StateKeys, base: Option<f64>) -> f64 {
        keys.gamma.or(base).or(self.file.case.gas.gamma).unwrap_or(f64::NAN)
    }

    /// The gas of this ratio of specific heats, if the gas of the case is a mixed one.
    #[must_use]
    pub fn gas_of(&self, gamma: f64) -> Gas<f64> {
        if self.gas.is_mixed() { Gas::Ideal { gamma } } else { self.gas }
    }

    /// The state of a table at `key`; what it does not say is taken from `base`.
    ///
    /// # Errors
    /// Something is missing, contradicts, or is no state.
    pub fn state(&self, key: &str, keys: &StateKeys, base: Option<Primitive<f64, D>>) -> Result<Primitive<f64, D>> {
        let missing = |name: &str| self.file.wrong(key, format!("{name} is missing"));
        let velocity = self.velocity(key, keys, base.map(|b| b.velocity))?;
        let (density, pressure) = if self.gas.has_energy() {
            let pressure = keys.p.or(base.map(|b| b.pressure)).ok_or_else(|| missing("p"))?;
            let density = self.given_density(key, keys, pressure)?.or(base.map(|b| b.density));
            (density.ok_or_else(|| missing("rho or T"))?, pressure)
        } else {
            let given = keys.p.and_then(|p| self.gas.density(p));
            let density = self.given_density(key, keys, f64::NAN)?.or(given).or(base.map(|b| b.density));
            let density = density.ok_or_else(|| missing("rho or p"))?;
            (density, self.gas.pressure(density, 0.0))
        };
        for (name, value) in [("rho", density), ("p", pressure)] {
            if let Some(reason) = QUANTITY.refuses(value) {
                return Err(self.file.wrong(key, format!("comes to {name} = {}, which {reason}", written(value))));
            }
        }
        if let Some(p) = keys.p.filter(|p| !((p / pressure - 1.0).abs() <= AGREEMENT)) {
            return Err(self.file.wrong(key, format!("in this gas rho = {density} has p = {pressure}, not {p}")));
        }
        Ok(Primitive { density, velocity, pressure })
    }

    /// By `rho`, or by `T` at a pressure.
    fn given_density(&self, key: &str, keys: &StateKeys, pressure: f64) -> Result<Option<f64>> {
        let Some(temperature) = keys.temperature else { return Ok(keys.rho) };
        match self.gas_constant {
            _ if keys.rho.is_some() => Err(self.file.wrong(key, "takes rho or T, not both")),
            _ if !self.gas.has_energy() => {
                Err(self.file.wrong(key, "a barotropic gas has no T of its own; give rho or p"))
            }
            None => Err(self.file.wrong(key, "T needs gas.gas_constant")),
            Some(r) => Ok(Some(pressure / (r * temperature))),
        }
    }

    fn velocity(&self, key: &str, keys: &StateKeys, base: Option<[f64; D]>) -> Result<[f64; D]> {
        let given = [keys.u, keys.v, keys.w];
        for (axis, u) in given.into_iter().enumerate() {
            let name = VELOCITIES[axis];
            if !self.live.contains(&axis) && u.is_some_and(|u| u != 0.0) {
                return Err(self.file.wrong(
                    &format!("{key}.{name}"),
                    format!("axis {} has one cell: nothing flows along it", AXES[axis]),
                ));
            }
        }
        Ok(std::array::from_fn(|d| given[self.live[d]].unwrap_or(base.map_or(0.0, |b| b[d]))))
    }

    /// All cells at the beginning, x fastest.
    ///
    /// # Errors
    /// As [`States::state`]; an array that cannot be read or holds no states; cells without a state.
    pub fn initial(&self, edges: &Edges) -> Result<Beginning<D>> {
        let keys = &self.file.case.initial;
        let count: usize = edges.cells().iter().product();
        stages::room_for(count.saturating_mul(BYTES_A_CELL)).map_err(|e| self.file.wrong("grid", e.reason))?;
        let whole = |state, gamma| Some(Filled { state, gamma, share: 1.0 });
        let mut cells = match (&keys.uniform, &keys.from) {
            (Some(_), Some(_)) => return Err(self.file.wrong("initial", "takes uniform or from, not both")),
            (Some(state), None) => {
                vec![whole(self.state("initial.uniform", state, None)?, self.gamma(state, None)); count]
            }
            (None, Some(dir)) => {
                let gammas = match mixture::array(self.file).filter(|_| self.gas.is_mixed()) {
                    Some(path) => self.file.array("initial.from", &path, edges.cells(), |g| GAMMA.refuses(g))?,
                    None => vec![self.gamma(&StateKeys::default(), None); count],
                };
                let states = self.read(&self.file.fields("initial.from", dir, edges)?, edges)?.into_iter();
                states.zip(gammas).map(|(state, gamma)| whole(state, gamma)).collect()
            }
            (None, None) => vec![None; count],
        };
        let mut shared = BTreeMap::new();
        (0..keys.regions.len()).try_for_each(|n| self.fill(n, edges, &mut cells, &mut shared))?;
        let parts = OpenParts::default();
        for (&cell, own) in &shared {
            cells[cell] = self.settled(cell, own, &parts)?;
        }
        if let Some(cell) = cells.iter().position(|c| !is_known(c)) {
            return Err(self.in_no_region(cell, edges));
        }
        let cells: Vec<Filled<D>> = cells.into_iter().flatten().collect();
        let gammas = if self.gas.is_mixed() { cells.iter().map(|c| c.gamma).collect() } else { Vec::new() };
        Ok(Beginning { cells: cells.iter().map(|c| c.state).collect(), gammas, shared })
    }

    /// Gives the cells that the `n`-th region holds wholly its state, and lists it in those that it holds in part.
    fn fill(
        &self,
        n: usize,
        edges: &Edges,
        cells: &mut [Option<Filled<D>>],
        shared: &mut BTreeMap<usize, SharedCell<D>>,
    ) -> Result<()> {
        let (key, keys) = (format!("initial.regions[{n}]"), &self.file.case.initial.regions[n]);
        if !keys.given().iter().any(|k| STATE.contains(k)) {
            let all = STATE.join(", ");
            return Err(self.file.wrong(&key, format!("has no state and would change nothing: it needs any of {all}")));
        }
        let region = Region::new(self.file, &key, keys)?;
        for (cell, share) in region.shares(edges).map_err(|reason| self.file.wrong(&key, reason))? {
            if share < 1.0 || shared.contains_key(&cell) {
                let new = || SharedCell { under: cells[cell], holds: Vec::new() };
                shared.entry(cell).or_insert_with(new).holds.push(Hold { region: n, share });
            } else {
                cells[cell] = Some(self.region_over(n, cells[cell])?);
            }
        }
        Ok(())
    }

    /// The state of the `n`-th region over another, all of a cell.
    fn region_over(&self, n: usize, before: Option<Filled<D>>) -> Result<Filled<D>> {
        let (key, keys) = (format!("initial.regions[{n}]"), &self.file.case.initial.regions[n]);
        let state = self.state(&key, keys, before.map(|b| b.state))?;
        Ok(Filled { state, gamma: self.gamma(keys, before.map(|b| b.gamma)), share: 1.0 })
    }

    /// Gives the cells that regions hold in part what is in their open parts.
    ///
    /// # Errors
    /// As [`States::initial`].
    pub fn settle(&self, beginning: &mut Beginning<D>, parts: &OpenParts, edges: &Edges) -> Result<()> {
        let Beginning { cells, gammas, shared } = beginning;
        for (&cell, own) in shared.iter().filter(|_| !parts.is_empty()) {
            let found = self.settled(cell, own, parts)?;
            let Some(found) = found.filter(|c| is_known(&Some(*c))) else {
                return Err(self.in_no_region(cell, edges));
            };
            cells[cell] = found.state;
            if let Some(gamma) = gammas.get_mut(cell) {
                *gamma = found.gamma;
            }
        }
        Ok(())
    }

    /// What is in a cell that regions hold in part: of each what the later ones leave of it. What a region does not say is taken from what was where it
    /// lies.
    fn settled(&self, cell: usize, shared: &SharedCell<D>, parts: &OpenParts) -> Result<Option<Filled<D>>> {
        let SharedCell { under, holds } = shared;
        // What was there at first, and the regions so far, each with the share of the open part that it has.
        let mut layers = vec![*under];
        for (k, hold) in holds.iter().enumerate() {
            let left = |j: usize| parts.left(cell, &holds[j..=k]);
            let (mut replaced, mut before) = (Vec::new(), Vec::new());
            for (j, layer) in layers.iter_mut().enumerate() {
                let Some(layer) = layer else { continue };
                before.push(*layer);
                let share = if j == 0 { left(0) } else { left(j) - left(j - 1) };
                let share = share.clamp(0.0, layer.share);
                replaced.push(Filled { share: layer.share - share, ..*layer });
                layer.share = share;
            }
            let base = self.mixed(&replaced).or_else(|| self.mixed(&before));
            layers.push(Some(Filled { share: parts.held(cell, *hold), ..self.region_over(hold.region, base)? }));
        }
        let layers: Vec<Filled<D>> = layers.into_iter().flatten().collect();
        Ok(self.mixed(&layers))
    }

    /// Gases in one cell: mass, momentum and energy of all. Gases of one pressure keep it: of 1/(γ − 1), the energy per volume and pressure, the cell has
    /// the mean. None where there is no gas.
    fn mixed(&self, layers: &[Filled<D>]) -> Option<Filled<D>> {
        let layers: Vec<&Filled<D>> = layers.iter().filter(|layer| layer.share > 0.0).collect();
        let [first, _, ..] = layers[..] else { return layers.first().copied().copied() };
        let share: f64 = layers.iter().map(|layer| layer.share).sum();
        let mean = |of: &dyn Fn(&Filled<D>) -> f64| layers.iter().map(|c| c.share * of(c)).sum::<f64>() / share;
        let conserved = |c: &Filled<D>| self.gas_of(c.gamma).conserved(&c.state);
        let gamma = match layers.iter().all(|c| c.gamma == first.gamma) || !self.gas.is_mixed() {
            true => layers.last().map_or(first.gamma, |last| last.gamma),
            false => 1.0 + 1.0 / mean(&|c| self.gas_of(c.gamma).capacity()),
        };
        // A mean lies between the least and the largest, whatever the rounding.
        let [least, most] = [f64::min, f64::max].map(|end| layers.iter().map(|c| c.gamma).fold(first.gamma, end));
        let gamma = gamma.max(least).min(most);
        let state = self.gas_of(gamma).primitive(&Conserved {
            density: mean(&|c| conserved(c).density),
            momentum: std::array::from_fn(|d| mean(&|c| conserved(c).momentum[d])),
            energy: mean(&|c| conserved(c).energy),
        });
        Some(Filled { state, gamma, share })
    }

    fn in_no_region(&self, cell: usize, edges: &Edges) -> Error {
        let (at, x) = (arrays::index(cell, edges.cells()), centre(edges, cell));
        let reason = format!("cell {at:?} at {x:?} is in no region, and there is no uniform state");
        self.file.wrong("initial", reason)
    }

    /// `rho.npy`, `u.npy`, … of a directory. Velocities along axes of one cell may be missing, else must be 0; a
    /// barotropic gas does not need `p.npy`.
    fn read(&self, dir: &Path, edges: &Edges) -> Result<Vec<Primitive<f64, D>>> {
        let shape = edges.cells();
        let path = |name: &str| dir.join(format!("{name}.npy"));
        let read =
            |path: &Path, wrong: &dyn Fn(f64) -> Option<String>| self.file.array("initial.from", path, shape, wrong);
        let density = read(&path("rho"), &|x| QUANTITY.refuses(x))?;
        let mut velocity: [Vec<f64>; 3] = Default::default();
        for (axis, values) in velocity.iter_mut().enumerate() {
            let path = path(VELOCITIES[axis]);
            if self.live.contains(&axis) {
                *values = read(&path, &|u| SIGNED.refuses(u))?;
            } else if path.exists() {
                read(&path, &|u| (u != 0.0).then(|| "flows along an axis of one cell".to_owned()))?;
            }
        }
        let pressure = match self.gas.has_energy() {
            true => read(&path("p"), &|x| QUANTITY.refuses(x))?,
            false => density.iter().map(|&rho| self.gas.pressure(rho, 0.0)).collect(),
        };
        let state = |c: usize| Primitive {
            density: density[c],
            velocity: self.live.map(|axis| velocity[axis][c]),
            pressure: pressure[c],
        };
        Ok((0..density.len()).map(state).collect())
    }
}

/// A state, and the share of its cell that is known to be filled.
#[derive(Debug, Clone, Copy)]
struct Filled<const D: usize> {
    state: Primitive<f64, D>,
    /// Ratio of specific heats, which counts in a mixed gas.
    gamma: f64,
    share: f64,
}

/// Is it known what is in a cell? What fills half of it or more speaks for all of it.
fn is_known<const D: usize>(cell: &Option<Filled<D>>) -> bool {
    cell.is_some_and(|c| c.share >= 0.5 - 1e-9)
}

/// Centre of a cell.
#[must_use]
pub fn centre(edges: &Edges, cell: usize) -> [f64; 3] {
    let at = arrays::index(cell, edges.cells());
    [0, 1, 2].map(|a| f64::midpoint(edges.0[a][at[a]], edges.0[a][at[a] + 1]))
}
