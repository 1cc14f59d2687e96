//! Inlets: a velocity and a density (or temperature) are given, the pressure follows the flow.
//!
//! Fixing velocity, density and pressure would reflect every wave. Instead the pressure outside rises while the gas just
//! inside is too slow and falls while it is too fast, within a relaxation time; waves leave, and the velocity is met
//! in the end. In a barotropic gas, or where the temperature is given, the density follows the pressure. An inlet faster than its own sound keeps its
//! first pressure: no wave from inside can change it, and none would lead it back.

use super::case::StateKeys;
use super::state::States;
use crate::error::Result;
use crate::flow::Flow;
use crate::grid::Edges;
use voidage_core::flow::{Boundary, Gas, Primitive};

/// An inlet of a flow.
#[derive(Debug, Clone)]
pub struct Inlet<const D: usize> {
    /// Axis among those that flow, and 0 for its low or 1 for its high side.
    pub at: (usize, usize),
    /// The patch on that side, if it is not the rest of it.
    pub patch: Option<usize>,
    /// Time in which the pressure follows, once its side is known; infinite where it does not.
    pub relax: f64,
    /// Density over pressure where the temperature is given.
    pub per_pressure: Option<f64>,
    /// The time that the table gives, and the length of the axis, which sound crosses in that of one that gives none.
    given_relax: Option<f64>,
    length: f64,
    /// It starts from the pressure of the gas beside it.
    starts_as_beside: bool,
    /// +1 if the gas enters along the axis, −1 if against it.
    sign: f64,
    /// What enters.
    gas: Gas<f64>,
    /// Open area beside each cell of the side, as a share of all.
    shares: Vec<(usize, f64)>,
    /// The pressure from which it starts.
    first: f64,
}

/// Gas that enters slower than this share of what is asked for does not meet it.
const MET: f64 = 0.98;

/// A pressure that is so many times the first, after so many relaxation times, has risen far.
const RISEN: f64 = 2.0;
const TRIED: f64 = 10.0;

/// What an inlet does not meet.
#[derive(Debug, Clone, Copy)]
pub struct Shortfall {
    /// The speed asked for.
    pub asked: f64,
    /// That of the gas beside it.
    pub found: f64,
    /// Its pressure at the beginning and now.
    pub pressure: [f64; 2],
}

impl<const D: usize> Inlet<D> {
    /// The inlet of a table, with a state in it; `pressure` is that of any gas of the flow, until its side is known.
    ///
    /// # Errors
    /// The table gives no state, or one that does not enter.
    pub fn new(
        states: &States<'_, D>,
        key: &str,
        keys: &StateKeys,
        at: (usize, usize),
        pressure: f64,
        edges: &Edges,
    ) -> Result<(Self, Primitive<f64, D>)> {
        let starts_as_beside = keys.p.is_none() && (states.gas.has_energy() || keys.rho.is_none());
        let first = if starts_as_beside { Some(pressure) } else { keys.p };
        let mut state = states.state(key, &StateKeys { p: first, ..keys.clone() }, None)?;
        let per_pressure = keys.temperature.zip(states.gas_constant).map(|(t, r)| 1.0 / (r * t));
        let sign = [1.0, -1.0][at.1];
        if !(sign * state.velocity[at.0] > 0.0) {
            let name = super::case::VELOCITIES[states.live[at.0]];
            let reason = format!("must point into the domain, not be {}", state.velocity[at.0]);
            return Err(states.file.wrong(&format!("{key}.{name}"), reason));
        }
        let axis = &edges.0[states.live[at.0]];
        let inlet = Inlet {
            at,
            patch: None,
            relax: f64::INFINITY,
            per_pressure,
            given_relax: keys.relax,
            length: axis[axis.len() - 1] - axis[0],
            starts_as_beside,
            sign,
            gas: states.gas_of(states.gamma(keys, None)),
            shares: Vec::new(),
            first: state.pressure,
        };
        inlet.follow(&mut state);
        Ok((inlet, state))
    }

    /// What stands at its place.
    fn place<'f>(&self, flow: &'f mut Flow<f64, D>) -> &'f mut Boundary<f64, D> {
        match self.patch {
            Some(n) => &mut flow.patches[n].boundary,
            None => &mut flow.boundaries[self.at.0][self.at.1],
        }
    }

    /// Learns the open areas of its side, and starts from the gas there. Has it any?
    pub fn look_at(&mut self, flow: &mut Flow<f64, D>) -> bool {
        self.shares = flow.side(self.at.0, self.at.1, self.patch);
        let whole: f64 = self.shares.iter().map(|(_, area)| area).sum();
        self.shares.retain(|(_, area)| *area > 0.0);
        self.shares.iter_mut().for_each(|(_, area)| *area /= whole);
        if self.starts_as_beside && !self.shares.is_empty() {
            let beside = self.mean(|cell| flow.get(cell).pressure);
            self.set_pressure(flow, beside);
        }
        self.first = self.pressure(flow);
        if let Boundary::Inlet(state) = *self.place(flow) {
            let (speed, sound) = (self.sign * state.velocity[self.at.0], self.gas.sound_speed(&state));
            self.relax = if speed > sound { f64::INFINITY } else { self.given_relax.unwrap_or(self.length / sound) };
        }
        !self.shares.is_empty()
    }

    /// The mean of something along its side, over the open area.
    fn mean(&self, of: impl Fn(usize) -> f64) -> f64 {
        self.shares.iter().map(|&(cell, share)| share * of(cell)).sum()
    }

    /// Lets the pressure follow the flow for one step.
    pub fn relax(&self, flow: &mut Flow<f64, D>, dt: f64) {
        let d = self.at.0;
        let Boundary::Inlet(state) = *self.place(flow) else { return };
        if self.shares.is_empty() {
            return;
        }
        let mean = self.mean(|cell| flow.get(cell).velocity[d]);
        let share = (dt / self.relax).min(1.0);
        let mut next = self.place(flow).relaxed(d, self.sign * mean, self.gas.sound_speed(&state), share);
        if let Boundary::Inlet(w) = &mut next {
            self.follow(w);
        }
        *self.place(flow) = next;
    }

    /// The present state outside.
    fn state(&self, flow: &Flow<f64, D>) -> Option<Primitive<f64, D>> {
        match self.patch.map_or(flow.boundaries[self.at.0][self.at.1], |n| flow.patches[n].boundary) {
            Boundary::Inlet(w) => Some(w),
            _ => None,
        }
    }

    /// The present pressure outside.
    #[must_use]
    pub fn pressure(&self, flow: &Flow<f64, D>) -> f64 {
        self.state(flow).map_or(0.0, |w| w.pressure)
    }

    /// Does gas enter more slowly than is asked for, although the pressure has risen far? Then what lies behind lets no more pass.
    #[must_use]
    pub fn shortfall(&self, flow: &Flow<f64, D>) -> Option<Shortfall> {
        let (d, state) = (self.at.0, self.state(flow)?);
        let [asked, found] = [state.velocity[d], self.mean(|cell| flow.get(cell).velocity[d])].map(|u| self.sign * u);
        let pressure = [self.first, state.pressure];
        let has_tried = flow.time > TRIED * self.relax;
        let is_short = has_tried && found < MET * asked && pressure[1] > RISEN * pressure[0];
        is_short.then_some(Shortfall { asked, found, pressure })
    }

    /// Sets the pressure outside, of a flow that goes on.
    pub fn set_pressure(&self, flow: &mut Flow<f64, D>, pressure: f64) {
        if let Boundary::Inlet(w) = self.place(flow) {
            w.pressure = pressure;
            self.follow(w);
        }
    }

    /// The density that goes with the pressure.
    fn follow(&self, w: &mut Primitive<f64, D>) {
        if let Some(density) = self.gas.density(w.pressure).or(self.per_pressure.map(|k| k * w.pressure)) {
            w.density = density;
        }
    }
}
