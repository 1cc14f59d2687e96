//! Pressures that look as if they were meant in another unit than Pa.
//!
//! Units need only be consistent, and shock tubes without units have pressures from 0.01 to 1000. So a pressure is doubted only where the case
//! itself says that it is in SI units, by a temperature in kelvin and a gas constant in J/(kg K); and the ambient pressure where it is at
//! odds with every pressure of the beginning, in whatever unit.

use super::case::{CaseFile, StateKeys, side_word};

/// Gas constants in J/(kg K): from heavy refrigerants to hydrogen, with room on both sides.
const SI_GASES: [f64; 2] = [40.0, 6000.0];

/// Temperatures in K that gases flow at.
const SI_TEMPERATURES: [f64; 2] = [50.0, 6000.0];

/// A pressure below this many Pa, a hundredth of the atmosphere, is doubted.
const LEAST: f64 = 1000.0;

/// An ambient pressure below the lowest pressure of the beginning by this factor is doubted.
const FAR_BELOW: f64 = 100.0;

/// What is to be said about the pressures of a case, of whose states at the beginning `lowest` has the least.
#[must_use]
pub fn doubts(file: &CaseFile, lowest: f64) -> Vec<String> {
    let states = states(file);
    let within = |x: Option<f64>, [low, high]: [f64; 2]| x.is_some_and(|x| low <= x && x <= high);
    let si = within(file.case.gas.gas_constant, SI_GASES)
        && states.iter().any(|(_, keys)| within(keys.temperature, SI_TEMPERATURES));
    let mut said = Vec::new();
    if let Some((key, p)) = states.iter().find_map(|(key, keys)| Some((key, keys.p.filter(|p| si && *p < LEAST)?))) {
        said.push(format!(
            "{}: key {key}.p: {p} Pa is less than a hundredth of the atmosphere's 101325 Pa; pressures are in Pa, not in kPa or bar",
            file.path.display()
        ));
    }
    if let Some(p) = file.case.output.ambient.filter(|p| *p > 0.0 && FAR_BELOW * p < lowest) {
        said.push(format!(
            "{}: key output.ambient: {p} is less than a hundredth of the lowest pressure at the beginning, {lowest}; it is in the unit of the states, Pa",
            file.path.display()
        ));
    }
    said
}

/// All tables of a case that may give a pressure, by their keys.
fn states(file: &CaseFile) -> Vec<(String, &StateKeys)> {
    let (initial, boundary) = (&file.case.initial, &file.case.boundary);
    let mut all: Vec<(String, &StateKeys)> = Vec::new();
    all.extend(initial.uniform.iter().map(|keys| ("initial.uniform".to_owned(), keys)));
    all.extend(initial.regions.iter().enumerate().map(|(n, keys)| (format!("initial.regions[{n}]"), keys)));
    for (axis, sides) in boundary.by_axis().into_iter().enumerate() {
        let sides = sides.into_iter().enumerate();
        all.extend(sides.filter_map(|(side, keys)| Some((format!("boundary.{}", side_word(axis, side)), keys?))));
    }
    all.extend(boundary.patch.iter().enumerate().map(|(n, keys)| (format!("boundary.patch[{n}]"), keys)));
    all
}
