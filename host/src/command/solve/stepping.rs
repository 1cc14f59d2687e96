//! One step of a run, and why a run must not go on.

use super::arrays;
use super::case::VELOCITIES;
use super::maxima::Maxima;
use super::setup::Setup;
use super::state;
use crate::flow::Flow;
use crate::words::written;
use std::fmt::{self, Write as _};
use voidage_core::flow::{Error, Primitive};

/// Share of the mass, momentum or energy in the domain that floors may change before a run stops.
const MOST_FLOORED: f64 = 1e-6;

/// Why a run must not go on, with step, time, cell and values.
#[derive(Debug, Clone)]
pub enum Trouble {
    /// A state that no gas has, or a time step of nothing.
    State(String),
    /// Floors have changed too much of what the domain holds.
    Floors(String),
}

impl fmt::Display for Trouble {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Trouble::State(text) | Trouble::Floors(text)) = self;
        f.write_str(text)
    }
}

/// One step that does not pass the time `stop`: its length.
///
/// # Errors
/// The run must not go on.
pub fn step<const D: usize>(setup: &mut Setup<D>, maxima: Option<&mut Maxima>, stop: f64) -> Result<f64, Trouble> {
    let (before, floors) = (setup.flow.time, setup.flow.total.floored);
    let stepped = setup.flow.advance(setup.cfl, stop);
    let flow = &setup.flow;
    let (steps, time) = (flow.steps, written(flow.time));
    let at = |reason: &str| format!("step {steps}, t = {time}: {reason}");
    let dt = match stepped {
        Ok(dt) if flow.total.rate.is_finite() && flow.time > before && flow.time.is_finite() => dt,
        other => return Err(Trouble::State(at(&unphysical(setup, other.err())))),
    };
    if let Some(maxima) = maxima {
        maxima.step(flow, dt);
    }
    for inlet in &setup.inlets {
        inlet.relax(&mut setup.flow, dt);
    }
    match floored(setup, floors) {
        Some(reason) => Err(Trouble::Floors(at(&reason))),
        None => Ok(dt),
    }
}

/// Why a run whose last step added to so many `floors` must not go on: floors have changed too much of what the domain holds.
fn floored<const D: usize>(setup: &Setup<D>, floors: usize) -> Option<String> {
    let flow = &setup.flow;
    let cell = flow.total.floored_cell.filter(|_| flow.total.floored > floors)?;
    let (change, content) = (flow.total.floor_change, flow.content());
    let momentum = content.density * typical_speed(flow, content.density, content.energy);
    let mut shares = vec![("mass", change.density / content.density)];
    shares.push(("momentum", change.momentum.iter().fold(0.0, |sum, m| sum + m) / momentum));
    if flow.gas().has_energy() {
        shares.push(("energy", change.energy / content.energy));
    }
    if shares.iter().all(|(_, share)| *share <= MOST_FLOORED) {
        return None;
    }
    let shares: Vec<String> =
        shares.iter().map(|(name, share)| format!("{} of its {name}", two_digits(*share))).collect();
    let (shares, last) = (shares.join(", "), state_of(setup, cell));
    Some(format!("floors have changed what the domain holds by {shares}, the last in {last}"))
}

/// A share, or a change, in two digits.
pub fn two_digits(of: f64) -> String {
    if of == 0.0 { "0".to_owned() } else { format!("{of:.1e}") }
}

/// The speed by which mass becomes the momentum that changes of momentum are measured against: sqrt(E/rho), and in a barotropic gas
/// that of sound at the mean density.
fn typical_speed<const D: usize>(flow: &Flow<f64, D>, mass: f64, energy: f64) -> f64 {
    let gas = flow.gas();
    if gas.has_energy() {
        return (energy / mass).sqrt();
    }
    let density = mass / (0..flow.len()).map(|cell| flow.open_volume(cell)).sum::<f64>();
    gas.sound_speed(&Primitive { density, velocity: [0.0; D], pressure: gas.pressure(density, 0.0) })
}

/// What is the matter with a flow that cannot go on: the cell, and its values.
#[must_use]
pub fn unphysical<const D: usize>(setup: &Setup<D>, error: Option<Error>) -> String {
    let flow = &setup.flow;
    let physical = |cell: usize| {
        let w = flow.get(cell);
        let finite = w.velocity.iter().all(|u| u.is_finite()) && w.density.is_finite() && w.pressure.is_finite();
        finite && w.density > 0.0 && w.pressure > 0.0
    };
    let fastest = || {
        let speed = |c: usize| {
            let w = flow.get(c);
            w.velocity.iter().fold(flow.gas_at(c).sound_speed(&w), |s, u| s + u.abs())
        };
        (0..flow.len()).max_by(|&a, &b| speed(a).total_cmp(&speed(b))).unwrap_or(0)
    };
    let no_state = |cell: usize| {
        let w = flow.get(cell);
        let kinetic = 0.5 * w.density * w.velocity.iter().map(|u| u * u).sum::<f64>();
        match w.pressure == 0.0 && kinetic > 0.0 {
            true => format!("rounding leaves no pressure beside a kinetic energy of {kinetic:.1e} J/m³"),
            false => "no gas has this state".to_owned(),
        }
    };
    let (cell, what) = match error {
        Some(Error::Unphysical { cell }) => (cell, no_state(cell)),
        Some(other) => return other.to_string(),
        None => match (0..flow.len()).find(|&c| !physical(c)) {
            Some(cell) => (cell, no_state(cell)),
            None => (fastest(), "the time step has shrunk to nothing, here is the fastest signal".to_owned()),
        },
    };
    format!("{}: {what}", state_of(setup, cell))
}

/// A cell, where it is, and its state.
fn state_of<const D: usize>(setup: &Setup<D>, cell: usize) -> String {
    let w = setup.flow.get(cell);
    let at = arrays::index(cell, setup.edges.cells());
    let x = state::centre(&setup.edges, cell);
    let mut text = format!("cell {at:?} at {x:?}: rho = {:?}, ", w.density);
    for (axis, u) in setup.live.iter().zip(w.velocity) {
        let _ = write!(text, "{} = {u:?}, ", VELOCITIES[*axis]); // a String takes anything
    }
    let _ = write!(text, "p = {:?}", w.pressure);
    if setup.flow.gas().is_mixed() {
        let _ = write!(text, ", gamma = {:?}", setup.flow.gas_at(cell).gamma());
    }
    text
}
