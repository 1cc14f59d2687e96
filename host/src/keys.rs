//! Files of keys and values (TOML, JSON) as the types of the program, with messages in the words of whoever wrote the file.
//!
//! In reading order: [`slips`], what is wrong with its spelling; [`value`], what stands there; [`json`], values of JSON; [`source`], a file's text and places in it; [`reader`], from values to types.

pub mod json;
pub mod reader;
pub mod slips;
pub mod source;
pub mod value;

pub use reader::read;
pub use source::Source;
pub use value::PlacedValue;

/// The first value of a list that stands in it before.
#[must_use]
pub fn first_repeated<T: PartialEq>(values: &[T]) -> Option<usize> {
    (0..values.len()).find(|&n| values[..n].contains(&values[n]))
}
