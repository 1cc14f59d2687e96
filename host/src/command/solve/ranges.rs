//! The numbers that keys of a case take. Each has a range, wide enough for any system of units; what lies beyond is a slip of the pen, and
//! would overflow in products, or never end.

use crate::geometry::scene::MOST_CD;
use crate::geometry::scene::table::{LARGEST, SMALLEST};
use crate::keys::PlacedValue;
use crate::keys::value::{Misfit, Value};
use crate::words::written;
use std::fmt;

/// Numbers that a key takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    low: Low,
    high: f64,
    /// Infinity counts, too, with either sign where the range has both.
    or_infinite: bool,
}

/// The lower end of a range.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Low {
    /// A number of the range.
    From(f64),
    /// The largest below it.
    Above(f64),
    /// The upper end with a minus sign.
    Mirrored,
}

/// A quantity that is never zero: a density, a pressure, a length, a time.
pub const QUANTITY: Range = Range { low: Low::From(SMALLEST), high: LARGEST, or_infinite: false };

/// A quantity that may be zero: a resistance.
pub const NOT_NEGATIVE: Range = Range { low: Low::From(0.0), high: LARGEST, or_infinite: false };

/// A quantity of either sign: a velocity, a coordinate.
pub const SIGNED: Range = Range { low: Low::Mirrored, high: LARGEST, or_infinite: false };

/// A ratio of specific heats.
pub const GAMMA: Range = Range { low: Low::Above(1.0), high: 100.0, or_infinite: false };

const CORNER: Range = Range { or_infinite: true, ..SIGNED };

/// A drag coefficient.
pub const DRAG_COEFFICIENT: Range = Range { high: MOST_CD, ..NOT_NEGATIVE };

const SHARE: Range = Range { high: 1.0, ..NOT_NEGATIVE };

/// Tables of a case, the names that `docs/case.md` has for them, each with keys that take numbers; `state` stands for all tables of states.
pub const RANGES: [(&str, &str, Range); 36] = [
    ("porosity", "tol", SHARE),
    ("porosity", "depth", Range { high: 10.0, ..NOT_NEGATIVE }),
    ("porosity", "jump", Range { low: Low::Above(0.0), high: f64::INFINITY, or_infinite: true }),
    ("gas", "gamma", GAMMA),
    ("gas", "sound_speed", QUANTITY),
    ("gas", "rho", QUANTITY),
    ("gas", "p", QUANTITY),
    ("gas", "gas_constant", QUANTITY),
    ("state", "rho", QUANTITY),
    ("state", "T", QUANTITY),
    ("state", "u", SIGNED),
    ("state", "v", SIGNED),
    ("state", "w", SIGNED),
    ("state", "p", QUANTITY),
    ("state", "gamma", GAMMA),
    ("state", "relax", QUANTITY),
    ("state", "min", CORNER),
    ("state", "max", CORNER),
    ("state", "center", SIGNED),
    ("state", "radius", QUANTITY),
    ("drag", "cd", DRAG_COEFFICIENT),
    ("drag", "cd_round", DRAG_COEFFICIENT),
    ("drag", "cd_sharp", DRAG_COEFFICIENT),
    ("drag", "cr", NOT_NEGATIVE),
    ("drag", "linear", NOT_NEGATIVE),
    ("gravity", "g", SIGNED),
    ("scheme", "cfl", Range { low: Low::From(1e-6), high: 1.0, or_infinite: false }),
    ("time", "end", QUANTITY),
    ("output", "every", QUANTITY),
    ("output", "ambient", QUANTITY),
    ("output", "checkpoint_every", Range { high: 1e9, ..NOT_NEGATIVE }),
    ("output.monitors[]", "min", CORNER),
    ("output.monitors[]", "max", CORNER),
    ("output.range", "speed", SIGNED),
    ("output.range", "overpressure", SIGNED),
    ("output.maxima", "threshold", QUANTITY),
];

impl Range {
    /// A number is one of the range; NaN is none of any.
    #[must_use]
    pub fn holds(&self, x: f64) -> bool {
        let above = match self.low {
            Low::From(low) => x >= low,
            Low::Above(low) => x > low,
            Low::Mirrored => x >= -self.high || self.or_infinite && x == f64::NEG_INFINITY,
        };
        above && (x <= self.high || self.or_infinite && x == f64::INFINITY)
    }

    /// What is wrong with a number that is not of the range.
    #[must_use]
    pub fn refuses(&self, x: f64) -> Option<String> {
        (!self.holds(x)).then(|| format!("is not {self}"))
    }
}

/// As in `from 0 to 1`, as messages and the pages of keys have it.
impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let high = written(self.high);
        match self.low {
            Low::From(low) => write!(f, "from {} to {high}", written(low))?,
            Low::Above(low) if self.high.is_finite() => write!(f, "above {} and up to {high}", written(low))?,
            Low::Above(low) => write!(f, "above {}", written(low))?,
            Low::Mirrored => write!(f, "within ±{high}")?,
        }
        if self.or_infinite { f.write_str(", or infinite") } else { Ok(()) }
    }
}

/// Looks for numbers out of the ranges of their keys; `place` is the key of `node`, empty for a whole case.
///
/// # Errors
/// The first of them.
pub fn check(node: &PlacedValue, place: &str) -> Result<(), Misfit> {
    match &node.value {
        Value::Table(entries) => entries.iter().try_for_each(|e| {
            let inner = if place.is_empty() { e.key.clone() } else { format!("{place}.{}", e.key) };
            check(&e.node, &inner)
        }),
        Value::List(items) => items.iter().enumerate().try_for_each(|(n, item)| check(item, &format!("{place}[{n}]"))),
        Value::Number(x) => number(node, place, *x),
        Value::Whole(n) => number(node, place, *n as f64),
        _ => Ok(()),
    }
}

/// The number at a key is one of its range, if it has one.
fn number(node: &PlacedValue, place: &str, x: f64) -> Result<(), Misfit> {
    // Numbers of items do not count: they name one range.
    let mut key = place.trim_end_matches(|c: char| c == ']' || c.is_ascii_digit()).trim_end_matches('[').to_owned();
    key.retain(|c| !c.is_ascii_digit());
    let (table, key) = key.rsplit_once('.').unwrap_or(("", &key));
    let is_state = ["initial.", "boundary."].iter().any(|above| table.starts_with(above));
    let table = if is_state { "state" } else { table };
    match RANGES.iter().find(|(of, name, _)| (*of, *name) == (table, key)) {
        Some((.., range)) if !range.holds(x) => {
            Err((node.span.clone(), format!("key {place}: needs a number {range}, not {}", written(x))))
        }
        _ => Ok(()),
    }
}
