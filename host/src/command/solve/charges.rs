//! The regions of the beginning with a pressure above the ambient one: what a blast starts from. There the pressure is largest at the beginning, whatever the
//! blast does, so that peaks and colours are those of the cells outside.

use super::arrays::{index, position};
use super::case::StateKeys;
use super::case_file::CaseFile;
use super::regions::Region;
use crate::error::Result;
use crate::flow::Flow;
use crate::grid::Edges;
use voidage_core::flow::Gas;

/// A pressure above the ambient one by no more than this share of it is rounding.
const ROUNDING: f64 = 1e-9;

/// Regions above the ambient pressure.
#[derive(Debug, Clone, Default)]
pub struct Charges {
    /// Of each cell, whether such a region holds some of it and it begins above the ambient pressure, whatever regions after that one left of it; or it
    /// shares its state with such a cell. Empty if no cell does, or no other open cell is left.
    held: Vec<bool>,
    /// Middle of the first such region, in m; none along axes on which it has no ends.
    middle: Option<[Option<f64>; 3]>,
}

impl Charges {
    /// Those of a case, in a flow at its beginning.
    ///
    /// # Errors
    /// As [`Region::new`] and [`Region::shares`].
    pub fn new<const D: usize>(file: &CaseFile, flow: &Flow<f64, D>, edges: &Edges, ambient: f64) -> Result<Self> {
        let is_above = |pressure: f64| pressure > ambient * (1.0 + ROUNDING);
        let mut charges = Charges::default();
        for (n, keys) in file.case.initial.regions.iter().enumerate() {
            // Where gases of two speeds or densities share a cell its pressure is above that of both.
            if !given_pressure(keys, flow.gas()).is_some_and(is_above) {
                continue;
            }
            let key = format!("initial.regions[{n}]");
            let region = Region::new(file, &key, keys)?;
            let shares = region.shares(edges).map_err(|reason| file.wrong(&key, reason))?;
            let cells = shares.into_iter().map(|(cell, _)| cell);
            let mut above = cells.filter(|&cell| is_above(flow.get(cell).pressure)).peekable();
            if above.peek().is_none() {
                continue;
            }
            charges.middle = charges.middle.or_else(|| Some(middle(&region, edges)));
            charges.held.resize(flow.len(), false);
            above.for_each(|cell| charges.held[cell] = true);
        }
        charges.take_whole_clusters(flow);
        charges.leave_some(flow.beta_v());
        Ok(charges)
    }

    /// Small cells that share their state with one of these begin with its pressure, too.
    fn take_whole_clusters<const D: usize>(&mut self, flow: &Flow<f64, D>) {
        for cluster in flow.clusters() {
            if cluster.iter().any(|&cell| self.hold(cell)) {
                cluster.iter().for_each(|&cell| self.held[cell] = true);
            }
        }
    }

    /// Where no open cell is left beside them, none is left out.
    fn leave_some(&mut self, beta_v: Option<&[f64]>) {
        let is_open = |cell: usize| beta_v.is_none_or(|b| b[cell] > 0.0);
        if !(0..self.held.len()).any(|cell| !self.held[cell] && is_open(cell)) {
            self.held.clear();
        }
    }

    /// The cell is one of theirs.
    #[must_use]
    pub fn hold(&self, cell: usize) -> bool {
        self.held.get(cell).is_some_and(|held| *held)
    }

    /// They hold no cell that is left out.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.held.is_empty()
    }

    /// Middle of the first of them, in m; none along axes on which it has no ends.
    #[must_use]
    pub fn middle(&self) -> [Option<f64>; 3] {
        self.middle.unwrap_or_default()
    }

    /// The same space in the cells of a grid of `fine` cells that has two for each of these `coarse` ones along the axes `live`.
    #[must_use]
    pub fn finer(&self, coarse: [usize; 3], fine: [usize; 3], live: &[usize], beta_v: Option<&[f64]>) -> Charges {
        let coarser = |cell: usize| {
            let mut at = index(cell, fine);
            live.iter().for_each(|&axis| at[axis] = (at[axis] / 2).min(coarse[axis] - 1));
            position(at, coarse)
        };
        let count = if self.is_empty() { 0 } else { fine.iter().product() };
        let mut charges = Charges { held: (0..count).map(|cell| self.hold(coarser(cell))).collect(), ..*self };
        charges.leave_some(beta_v);
        charges
    }
}

/// The pressure that the table of a region gives, by the density where the gas has no energy.
fn given_pressure(keys: &StateKeys, gas: Gas<f64>) -> Option<f64> {
    keys.p.or_else(|| keys.rho.filter(|_| !gas.has_energy()).map(|rho| gas.pressure(rho, 0.0)))
}

/// The middle of a region, moved into the grid where it lies outside.
fn middle(region: &Region, edges: &Edges) -> [Option<f64>; 3] {
    let [lo, hi] = edges.bounds().map(|p| p.to_array());
    [0, 1, 2].map(|a| {
        let [from, to] = region.extent(a);
        Some(f64::midpoint(from, to)).filter(|x| x.is_finite()).map(|x| x.clamp(lo[a], hi[a]))
    })
}
