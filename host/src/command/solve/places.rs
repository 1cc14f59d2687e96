//! Which keys may stand in which table with a state: the state everywhere, a region, a side of the domain, a patch on one.
//!
//! All of them are read as one type, [`super::case::StateKeys`]; what a message lists as known is what the place takes.

use crate::keys::PlacedValue;
use crate::keys::reader::not_known;
use crate::keys::value::{Entry, Misfit, Value};

/// Keys of a state.
pub const STATE: [&str; 7] = ["rho", "T", "u", "v", "w", "p", "gamma"];

const REGION: [&str; 11] = ["rho", "T", "u", "v", "w", "p", "gamma", "min", "max", "center", "radius"];

const SIDES: [&str; 6] = ["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"];

const SIDE: [&str; 9] = ["type", "rho", "T", "u", "v", "w", "p", "gamma", "relax"];

const PATCH: [&str; 12] = ["side", "min", "max", "type", "rho", "T", "u", "v", "w", "p", "gamma", "relax"];

/// Looks for keys that are not known where they stand.
///
/// # Errors
/// The first of them; a region or a state everywhere that is no table.
pub fn check(case: &PlacedValue) -> Result<(), Misfit> {
    let initial = member(case, "initial");
    if let Some(entry) = initial.and_then(|t| entries(t).iter().find(|e| STATE.contains(&&e.key[..]))) {
        let reason = format!("key initial.{}: the state everywhere stands in initial.uniform", entry.key);
        return Err((entry.span.clone(), reason));
    }
    if let Some(uniform) = initial.and_then(|t| member(t, "uniform")) {
        known(uniform, "initial.uniform", &STATE, false)?;
    }
    all_known(initial, ("initial", "regions"), &REGION)?;
    let sides = member(case, "boundary");
    for entry in sides.map_or(&[][..], entries).iter().filter(|e| SIDES.contains(&&e.key[..])) {
        known(&entry.node, &format!("boundary.{}", entry.key), &SIDE, true)?;
    }
    all_known(sides, ("boundary", "patch"), &PATCH)
}

/// The same of all tables of a list.
fn all_known(parent: Option<&PlacedValue>, (place, key): (&str, &str), keys: &[&str]) -> Result<(), Misfit> {
    let list = parent.and_then(|t| member(t, key)).map(|list| &list.value);
    let Some(Value::List(items)) = list else { return Ok(()) };
    let item = |(n, item)| known(item, &format!("{place}.{key}[{n}]"), keys, false);
    items.iter().enumerate().try_for_each(item)
}

/// Every key of the table at `place` is one of `keys`; a side may be a word in place of a table.
fn known(node: &PlacedValue, place: &str, keys: &[&str], word: bool) -> Result<(), Misfit> {
    match &node.value {
        Value::Table(_) => {}
        Value::Text(_) if word => return Ok(()),
        other => {
            let word = if word { "a word or " } else { "" };
            let reason =
                format!("key {place}: takes {word}a table with any of {}, not {}", keys.join(", "), other.kind());
            return Err((node.span.clone(), reason));
        }
    }
    match entries(node).iter().find(|e| !keys.contains(&&e.key[..])) {
        None => Ok(()),
        Some(e) => Err((e.span.clone(), format!("key {place}.{}: {}", e.key, not_known(&e.key, keys)))),
    }
}

fn entries(node: &PlacedValue) -> &[Entry] {
    match &node.value {
        Value::Table(entries) => entries,
        _ => &[],
    }
}

fn member<'a>(node: &'a PlacedValue, key: &str) -> Option<&'a PlacedValue> {
    entries(node).iter().find(|e| e.key == key).map(|e| &e.node)
}
