//! Largest values over time, cell by cell: overpressure, impulse, dynamic pressure, and when a threshold is first met.
//!
//! The overpressure is p − p₀, p₀ being the ambient pressure. Its integral over time is taken by the trapezoidal rule from step to step;
//! the impulse is the largest value that this integral reaches. The moment of arrival is interpolated within a step.

use super::charges::Charges;
use super::frames::{create, forget};
use super::output_keys::MaximaKeys;
use crate::error::Result;
use crate::files::npy;
use crate::files::vtr::{CellField, NamedField, Vtr};
use crate::flow::Flow;
use crate::grid::Edges;
use crate::huge::HugeVec;
use rayon::prelude::*;
use serde::Serialize;
use std::path::Path;

/// Overpressure in Pa whose arrival is told unless a case gives another.
const USUAL_THRESHOLD: f64 = 1000.0;

/// Largest values so far, and what the next step needs to go on.
#[derive(Debug)]
pub struct Maxima {
    /// The ambient pressure p₀.
    pub ambient: f64,
    /// The overpressure whose arrival is told.
    pub threshold: f64,
    overpressure: HugeVec,
    impulse: HugeVec,
    /// NaN where the threshold was not met.
    arrival: HugeVec,
    dynamic: HugeVec,
    /// Integral of the overpressure so far, and its last value.
    running: HugeVec,
    last: HugeVec,
}

/// Largest values in a cell.
#[derive(Debug, Clone, Serialize)]
pub struct Peaks {
    /// Name of the probe.
    pub name: String,
    /// Of p − p₀; NaN in a solid, as the others are.
    pub overpressure: f64,
    /// Of its integral over time.
    pub impulse: f64,
    /// When the threshold was first met, if it was.
    pub arrival: Option<f64>,
    /// Of ½ ρ |u|².
    pub dynamic_pressure: f64,
}

/// Names of the fields, in the order of [`Maxima::fields`].
const NAMES: [&str; 4] = ["overpressure", "impulse", "arrival", "dynamic_pressure"];

impl Maxima {
    /// Of a flow at its beginning.
    #[must_use]
    pub fn new<const D: usize>(keys: &MaximaKeys, ambient: f64, flow: &Flow<f64, D>) -> Self {
        let zeros = || HugeVec::zeros(flow.len());
        let threshold = keys.threshold.unwrap_or(USUAL_THRESHOLD);
        let mut maxima = Maxima {
            ambient,
            threshold,
            overpressure: zeros(),
            impulse: zeros(),
            arrival: zeros(),
            dynamic: zeros(),
            running: zeros(),
            last: zeros(),
        };
        for cell in 0..flow.len() {
            let (over, dynamic) = pressures(flow, cell, ambient);
            (maxima.overpressure[cell], maxima.last[cell], maxima.dynamic[cell]) = (over, over, dynamic);
            maxima.arrival[cell] = if over >= threshold { flow.time } else { f64::NAN };
        }
        maxima
    }

    /// After a step of `dt`.
    pub fn step<const D: usize>(&mut self, flow: &Flow<f64, D>, dt: f64) {
        let (begin, ambient, threshold) = (flow.time - dt, self.ambient, self.threshold);
        let Maxima { overpressure, impulse, arrival, dynamic, running, last, .. } = self;
        let peaks = overpressure.par_iter_mut().zip(&mut dynamic[..]).zip(&mut impulse[..]);
        let state = running.par_iter_mut().zip(&mut last[..]).zip(&mut arrival[..]);
        peaks.zip(state).enumerate().for_each(|(cell, (((most, dynamic), impulse), ((running, last), arrival)))| {
            let (over, now) = pressures(flow, cell, ambient);
            *most = most.max(over);
            *dynamic = dynamic.max(now);
            *running += 0.5 * dt * (*last + over);
            *impulse = impulse.max(*running);
            if arrival.is_nan() && over >= threshold {
                *arrival = begin + dt * (threshold - *last) / (over - *last);
            }
            *last = over;
        });
    }

    /// The numbers that decide what is kept.
    #[must_use]
    pub fn numbers(&self) -> [f64; 2] {
        [self.ambient, self.threshold]
    }

    /// All that a run needs to go on to the bit.
    pub fn arrays(&self) -> impl Iterator<Item = &[f64]> {
        [&self.overpressure, &self.impulse, &self.arrival, &self.dynamic, &self.running, &self.last]
            .map(|a| &a[..])
            .into_iter()
    }

    /// The same, to be written.
    pub fn arrays_mut(&mut self) -> impl Iterator<Item = &mut [f64]> {
        let Maxima { overpressure, impulse, arrival, dynamic, running, last, .. } = self;
        [overpressure, impulse, arrival, dynamic, running, last].map(|a| &mut a[..]).into_iter()
    }

    /// The fields by [`NAMES`]; NaN in solid cells.
    fn fields(&self, beta_v: Option<&[f64]>) -> [Vec<f64>; 4] {
        [&self.overpressure, &self.impulse, &self.arrival, &self.dynamic].map(|values| {
            let open = |cell: usize| beta_v.is_none_or(|b| b[cell] > 0.0);
            values.iter().enumerate().map(|(cell, &x)| if open(cell) { x } else { f64::NAN }).collect()
        })
    }

    /// Has any cell met the threshold?
    pub fn has_arrived(&self) -> bool {
        self.arrival.iter().any(|time| !time.is_nan())
    }

    /// Writes `overpressure.npy`, `impulse.npy`, `arrival.npy`, `dynamic_pressure.npy` and, for ParaView, `maxima.vtr`.
    ///
    /// # Errors
    /// The files cannot be written.
    pub fn write(&self, dir: &Path, edges: &Edges, beta_v: Option<&[f64]>) -> Result<()> {
        create(dir)?;
        let fields = self.fields(beta_v);
        let named = NAMES.iter().zip(&fields);
        let arrays: Vec<_> = named.clone().map(|(name, v)| ((*name).to_owned(), edges.cells(), &v[..])).collect();
        npy::write_fields(dir, edges, &arrays)?;
        let [x, y, z] = &edges.0;
        let cell = named.map(|(name, data)| CellField::Values(NamedField { name, components: 1, data }));
        Vtr { x, y, z, cell: cell.collect(), ..Vtr::default() }.write(&dir.join("maxima.vtr"))
    }

    /// Removes what [`Maxima::write`] has written, and the directory if it holds nothing else.
    ///
    /// # Errors
    /// A file cannot be removed.
    pub fn forget(dir: &Path) -> Result<()> {
        NAMES.iter().try_for_each(|name| forget(&dir.join(format!("{name}.npy"))))?;
        [npy::EDGES, "maxima.vtr"].into_iter().try_for_each(|name| forget(&dir.join(name)))?;
        // Whatever else it holds is not ours.
        let _ = std::fs::remove_dir(dir);
        Ok(())
    }

    /// The largest values of all open cells outside these charges, and the first arrival, under a name.
    #[must_use]
    pub fn greatest(&self, name: String, beta_v: Option<&[f64]>, charges: &Charges) -> Peaks {
        let open = |cell: &usize| beta_v.is_none_or(|b| b[*cell] > 0.0) && !charges.hold(*cell);
        let most =
            |values: &[f64]| (0..values.len()).filter(open).map(|cell| values[cell]).fold(f64::NEG_INFINITY, f64::max);
        let first = (0..self.arrival.len()).filter(open).map(|cell| self.arrival[cell]).fold(f64::NAN, f64::min);
        Peaks {
            name,
            overpressure: most(&self.overpressure),
            impulse: most(&self.impulse),
            arrival: Some(first).filter(|t| !t.is_nan()),
            dynamic_pressure: most(&self.dynamic),
        }
    }

    /// The largest values in a cell, for a probe of that name.
    #[must_use]
    pub fn peaks(&self, name: String, cell: usize, beta_v: Option<&[f64]>) -> Peaks {
        let is_open = beta_v.is_none_or(|b| b[cell] > 0.0);
        let value = |field: &HugeVec| if is_open { field[cell] } else { f64::NAN };
        Peaks {
            name,
            overpressure: value(&self.overpressure),
            impulse: value(&self.impulse),
            arrival: Some(value(&self.arrival)).filter(|t| !t.is_nan()),
            dynamic_pressure: value(&self.dynamic),
        }
    }
}

/// Overpressure and dynamic pressure of a cell.
fn pressures<const D: usize>(flow: &Flow<f64, D>, cell: usize, ambient: f64) -> (f64, f64) {
    let w = flow.get(cell);
    (w.pressure - ambient, 0.5 * w.density * w.velocity.iter().fold(0.0, |sum, u| sum + u * u))
}

/// The lowest pressure of an open cell: what a case without another word takes for that of the surroundings.
#[must_use]
pub fn lowest_pressure<const D: usize>(flow: &Flow<f64, D>) -> f64 {
    let open = (0..flow.len()).filter(|&c| flow.beta_v().is_none_or(|b| b[c] > 0.0));
    open.map(|c| flow.get(c).pressure).fold(f64::INFINITY, f64::min)
}
