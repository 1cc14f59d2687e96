//! Values of a study file: counts with an upper limit, words of the command line, lists that may be one value.

use crate::geometry::scene::table;
use crate::keys::first_repeated;
use crate::keys::reader::meant;
use clap::ValueEnum;
use toml::de::DeValue;

/// What a reader of values returns: the value, or what it wanted instead.
type Wanted<T> = Result<T, String>;

/// Most times a run is repeated, and most threads it gets.
const MOST: usize = 1024;

/// A number of repeats or threads.
///
/// # Errors
/// What it should be.
pub fn few(value: &DeValue) -> Wanted<usize> {
    at_most(table::count(value)?, MOST)
}

/// How often a cell is divided, as on the command line.
///
/// # Errors
/// What it should be.
pub fn depth(value: &DeValue) -> Wanted<u32> {
    at_most(table::index(value)?, 10).map(|n| n as u32)
}

/// A number of cells along an axis, of bodies, of triangles.
///
/// # Errors
/// What it should be.
pub fn many(value: &DeValue) -> Wanted<usize> {
    at_most(table::count(value)?, 100_000_000)
}

fn at_most(n: usize, most: usize) -> Wanted<usize> {
    if n <= most { Ok(n) } else { Err(format!("must be at most {most}, not {n}")) }
}

/// One of the words of the command line.
///
/// # Errors
/// All of them.
pub fn choice<T: ValueEnum>(value: &DeValue) -> Wanted<T> {
    let text = table::text(value)?;
    T::from_str(&text, false).map_err(|_| {
        let all: Vec<String> = T::value_variants().iter().map(|v| word(v.clone())).collect();
        let known: Vec<&str> = all.iter().map(String::as_str).collect();
        format!("\"{text}\" is not known: {}{}", all.join(", "), meant(&text, &known))
    })
}

/// The word of a value on the command line.
#[must_use]
pub fn word<T: ValueEnum>(value: T) -> String {
    value.to_possible_value().map_or_else(String::new, |v| v.get_name().to_owned())
}

/// One value, or a list of some.
pub fn some<T: PartialEq>(read: impl Fn(&DeValue) -> Wanted<T>) -> impl FnOnce(&DeValue) -> Wanted<Vec<T>> {
    move |value| {
        if !value.is_array() {
            return read(value).map(|one| vec![one]);
        }
        distinct(table::list(read))(value)
    }
}

/// A list that holds something, and nothing twice.
///
/// # Errors
/// What `list` should be; the second of two equal values.
fn distinct<T: PartialEq>(list: impl FnOnce(&DeValue) -> Wanted<Vec<T>>) -> impl FnOnce(&DeValue) -> Wanted<Vec<T>> {
    move |value| {
        let all = list(value)?;
        match first_repeated(&all) {
            Some(n) => Err(format!("[{n}] stands in this list before")),
            None if all.is_empty() => Err("is an empty list".to_owned()),
            None => Ok(all),
        }
    }
}

/// All combinations, the last list fastest.
pub fn product<'a, A, B, C>(a: &'a [A], b: &'a [B], c: &'a [C]) -> impl Iterator<Item = (&'a A, &'a B, &'a C)> {
    a.iter().flat_map(move |a| b.iter().flat_map(move |b| c.iter().map(move |c| (a, b, c))))
}

/// A name, and those of its parts that have more than one value.
#[must_use]
pub fn varied(name: &str, parts: &[(usize, String)]) -> String {
    let varied = parts.iter().filter(|(count, _)| *count > 1).map(|(_, word)| word.as_str());
    std::iter::once(name).chain(varied).collect::<Vec<_>>().join(", ")
}

/// Values in the order of their first appearance, each once.
pub fn unique<T: PartialEq>(values: impl Iterator<Item = T>) -> Vec<T> {
    values.fold(Vec::new(), |mut all, value| {
        if !all.contains(&value) {
            all.push(value);
        }
        all
    })
}
