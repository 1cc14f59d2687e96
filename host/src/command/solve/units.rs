//! Numbers that look as if they were meant in another unit: pressures in kPa or bar, temperatures in °C, a gas constant in kJ; and pressures that no gas explosion has.
//!
//! Units need only be consistent, and shock tubes without units have pressures from 0.01 to 1000. So a pressure or a temperature is doubted
//! only where the case itself says that it is in SI units, by a gas constant in J/(kg K) beside a temperature; and the ambient pressure
//! where it is at odds with every pressure of the beginning, in whatever unit.

use super::case::{StateKeys, VELOCITIES, side_word};
use super::case_file::CaseFile;
use crate::picture::ticks::number_to;
use crate::words::written;

/// Gas constants in J/(kg K): from heavy refrigerants to hydrogen, with room on both sides.
const SI_GASES: [f64; 2] = [40.0, 6000.0];

/// Gas constants in J/(kg K) are a thousand times those in kJ/(kg K).
const KILO: f64 = 1000.0;

/// The gas constant of a mole, in J/(mol K); nobody writes it more roughly than within the share [`NEAR`].
const UNIVERSAL: f64 = 8.314_462_618;

/// See [`UNIVERSAL`]: 8.31 is meant.
const NEAR: f64 = 1e-3;

/// Temperatures below this many K are doubted: the air of a hot day has 50 °C.
const COLD: f64 = 60.0;

/// A pressure above this is none without a unit.
const HIGH: f64 = 1e4;

/// A pressure below this many Pa, a hundredth of the atmosphere, is doubted.
const LEAST: f64 = 1000.0;

/// A pressure above this many Pa, a thousand atmospheres, is doubted: gas burnt in a closed room has about eight.
const MOST: f64 = 1e8;

/// A temperature above this many K is doubted: that of detonations is a few thousand.
const HOTTEST: f64 = 1e5;

/// A velocity above this many m/s is doubted: gas that bursts into a vacuum reaches a few thousand.
const FASTEST: f64 = 1e4;

/// A ratio of specific heats above this is doubted: that of gases of one atom is 5/3.
const STIFFEST: f64 = 3.0;

/// Lowest pressures of gas that is meant to be in Pa, whatever else the case says.
const ATMOSPHERES: [f64; 2] = [1e4, 1e6];

/// An ambient pressure below the lowest pressure of the beginning by this factor is doubted.
const FAR_BELOW: f64 = 100.0;

/// An end of the colours above the highest pressure of the case by this factor is doubted.
const FAR_ABOVE: f64 = 100.0;

/// An ambient pressure above the highest pressure of the beginning by this factor is doubted.
const ABOVE: f64 = 1.2;

/// What is to be said about the pressures of a case, whose states at the beginning have pressures from `lowest` to `highest`.
#[must_use]
pub fn doubts(file: &CaseFile, [lowest, highest]: [f64; 2]) -> Vec<String> {
    let states = states(file);
    let within = |x: f64, [low, high]: [f64; 2]| low <= x && x <= high;
    let mut said = Vec::new();
    let first = |of: &dyn Fn(&StateKeys) -> Option<f64>| states.iter().find_map(|(key, keys)| Some((key, of(keys)?)));
    let is_high = || first(&|keys| keys.p.filter(|p| *p > HIGH)).is_some();
    if let (Some(r), Some((key, _))) = (file.case.gas.gas_constant, first(&|keys| keys.temperature)) {
        let si = within(r, SI_GASES);
        if let Some((key, t)) = first(&|keys| keys.temperature.filter(|t| si && *t < COLD)) {
            let celsius = t - 273.15;
            let reason = format!("{t} K is {celsius:.2} °C; temperatures are in K, not in °C");
            said.push(file.remark(&format!("{key}.T"), reason));
        }
        if let Some((key, p)) = first(&|keys| keys.p.filter(|p| si && *p < LEAST)) {
            let reason = format!(
                "{p} Pa is less than a hundredth of the atmosphere's 101325 Pa; pressures are in Pa, not in kPa or bar"
            );
            said.push(file.remark(&format!("{key}.p"), reason));
        }
        if let Some(reason) = gas_constant(r, key).filter(|_| is_high()) {
            said.push(file.remark("gas.gas_constant", reason));
        }
    }
    let is_si = file.case.gas.gas_constant.is_some_and(|r| within(r, SI_GASES));
    let is_pascal = is_si || within(lowest, ATMOSPHERES);
    if let Some((key, p)) = first(&|keys| keys.p.filter(|p| is_pascal && *p > MOST)) {
        let (p, atmospheres) = (written(p), number_to(p / 101_325.0, p / 1e7));
        let reason = format!(
            "{p} Pa is {atmospheres} times the atmosphere's 101325 Pa; gas that burns in a closed room comes to about 8e5 Pa: check the exponent"
        );
        said.push(file.remark(&format!("{key}.p"), reason));
    }
    said.extend(beyond_sense(file, &states, is_si, is_pascal));
    let of_regions = states.iter().map(|(key, keys)| (format!("{key}.gamma"), keys.gamma));
    let mut all = std::iter::once(("gas.gamma".to_owned(), file.case.gas.gamma)).chain(of_regions);
    if let Some((key, gamma)) = all.find_map(|(key, gamma)| Some((key, gamma.filter(|g| *g > STIFFEST)?))) {
        let reason =
            format!("{} is the ratio of specific heats of no gas: they have 1.05 to 1.67, air 1.4", written(gamma));
        said.push(file.remark(&key, reason));
    }
    if let (Some(every), Some(end)) = (file.case.output.every, file.case.time.end)
        && every > end
    {
        let reason =
            format!("{} s is after the end, {} s: no frame is written before that", written(every), written(end));
        said.push(file.remark("output.every", reason));
    }
    if let Some(p) = file.case.output.ambient.filter(|p| *p > 0.0 && FAR_BELOW * p < lowest) {
        let reason = format!(
            "{p} is less than a hundredth of the lowest pressure at the beginning, {lowest}; it is in the unit of the states, Pa"
        );
        said.push(file.remark("output.ambient", reason));
    }
    let most = states.iter().filter_map(|(_, keys)| keys.p).fold(highest, f64::max);
    let ends = file.case.output.range.overpressure.unwrap_or_default();
    if let Some(end) = ends.into_iter().find(|end| KILO * end.abs() > FAR_ABOVE * most) {
        let (end, most) = (written(end), written(most));
        let reason = format!(
            "{end} kPa is a hundred times the highest pressure of the case, {most} Pa, or more; these ends are in kPa"
        );
        said.push(file.remark("output.range.overpressure", reason));
    }
    if let Some(p) = file.case.output.ambient.filter(|p| *p > ABOVE * highest) {
        let reason = format!("{p} is more than the highest pressure at the beginning, {highest}: all gas is below it");
        said.push(file.remark("output.ambient", reason));
    }
    said
}

/// Temperatures of a case in K and densities in kg/m³, if it `is_si`, and velocities in m/s, if it has pressures in Pa, that no gas has: the first of each.
fn beyond_sense(file: &CaseFile, states: &[(String, &StateKeys)], is_si: bool, is_pascal: bool) -> Vec<String> {
    let hot = states.iter().find_map(|(key, keys)| Some((key, keys.temperature.filter(|t| is_si && *t > HOTTEST)?)));
    let hot = hot.map(|(key, t)| {
        let reason = format!("{} K is hotter than the gas of any explosion: check the exponent", written(t));
        file.remark(&format!("{key}.T"), reason)
    });
    let dense = states.iter().find_map(|(key, keys)| {
        let (rho, p) = (keys.rho?, keys.p.filter(|p| is_si && *p >= LEAST)?);
        let t = p / (rho * file.case.gas.gas_constant?);
        (!(COLD..=HOTTEST).contains(&t)).then(|| {
            let reason = format!(
                "at {} Pa a density of {} is that of gas of {} K; densities are in kg/m³",
                written(p),
                written(rho),
                number_to(t, t / 1e3)
            );
            file.remark(&format!("{key}.rho"), reason)
        })
    });
    let fast = states.iter().find_map(|(key, keys)| {
        let mut all = VELOCITIES.into_iter().zip([keys.u, keys.v, keys.w]);
        all.find_map(|(name, u)| Some((key, name, u.filter(|u| is_pascal && u.abs() > FASTEST)?)))
    });
    let fast = fast.map(|(key, name, u)| {
        let reason = format!("{} m/s is faster than the gas of any explosion: check the exponent", written(u));
        file.remark(&format!("{key}.{name}"), reason)
    });
    hot.into_iter().chain(dense).chain(fast).collect()
}

/// What a gas constant may be instead of one in J/(kg K), beside a temperature in the table `key` and pressures in Pa.
fn gas_constant(r: f64, key: &str) -> Option<String> {
    let molar = |of: f64| (r / of - 1.0).abs() < NEAR;
    if molar(UNIVERSAL) || molar(KILO * UNIVERSAL) {
        return Some(format!(
            "{r} is that of a mole of any gas; here it is in J/(kg K): divided by the molar mass, 287 for air"
        ));
    }
    (SI_GASES[0]..=SI_GASES[1]).contains(&(KILO * r)).then(|| {
        format!(
            "{r} beside {key}.T makes a gas a thousand times too dense, if pressures are in Pa; \
             it is in J/(kg K), not in kJ/(kg K)"
        )
    })
}

/// All tables of a case that may give a state, by their keys.
#[must_use]
pub fn states(file: &CaseFile) -> Vec<(String, &StateKeys)> {
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
