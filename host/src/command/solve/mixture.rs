//! The gas of a case whose states give ratios of specific heats of their own: burnt gas beside fresh gas.

use super::case::Model;
use super::case_file::CaseFile;
use super::ranges::GAMMA;
use super::units::states;
use crate::error::Result;
use crate::grid::Edges;
use std::path::PathBuf;
use voidage_core::flow::Gas;

/// `gas`, or the mixed one that reaches over all ratios of specific heats of the case, if a state or an array gives any.
///
/// # Errors
/// A ratio that is none, or one beside a gas that is not of the model `ideal`; an array that cannot be read.
pub fn mixture(file: &CaseFile, gas: Gas<f64>, edges: &Edges) -> Result<Gas<f64>> {
    let mut found = Vec::new();
    for (place, keys) in states(file) {
        let key = format!("{place}.gamma");
        if keys.gamma.is_some() && !matches!(gas, Gas::Ideal { .. }) {
            let model = file.case.gas.model.word();
            let reason = format!("goes with the gas model {}, not with {model}", Model::Ideal.word());
            return Err(file.wrong(&key, reason));
        }
        found.extend(keys.gamma);
    }
    if let Some(path) = array(file) {
        if !matches!(gas, Gas::Ideal { .. }) {
            return Err(file
                .wrong("initial.from", "holds gamma.npy: only an ideal gas may have a gamma of its own in each cell"));
        }
        found.extend(file.array("initial.from", &path, edges.cells(), |g| GAMMA.refuses(g))?);
    }
    if found.is_empty() {
        return Ok(gas);
    }
    let [low, high] = found.iter().fold([gas.gamma(); 2], |[low, high], &g| [low.min(g), high.max(g)]);
    Ok(Gas::Mixed { gammas: [low, high] })
}

/// `gamma.npy` of the directory that a case begins from, if there is one.
#[must_use]
pub fn array(file: &CaseFile) -> Option<PathBuf> {
    let dir = file.case.initial.from.as_ref()?;
    Some(file.resolve(dir).join("gamma.npy")).filter(|path| path.exists())
}
