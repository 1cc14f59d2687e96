//! A TOML table read strictly: every key has a reader, every reader says what it wants.

use crate::error::{Error, Result};
use crate::geometry::unit::Unit;
use crate::grid::{Edges, file};
use crate::keys::Source;
use crate::keys::reader::{nearest, not_known};
use crate::keys::source::another;
use crate::words::written;
use glam::DVec3;
use std::ops::Range;
use std::path::Path;
use toml::de::{DeTable, DeValue};

/// The text of a regular file of at most `most` bytes.
///
/// # Errors
/// If there is no such file, or it is larger.
pub fn read_text(path: &Path, most: u64) -> Result<String> {
    let about = std::fs::metadata(path).map_err(|e| Error::io(path, "open", &e))?;
    crate::text::is_file(path)?;
    if about.len() > most {
        return Err(Error::file(path, format!("too large: {} bytes, at most {most} are read", about.len())));
    }
    crate::text::read(path)
}

/// What a reader of values returns: the value, or what it wanted instead.
type Wanted<T> = std::result::Result<T, String>;

/// A table of which each key is asked for once.
#[derive(Debug)]
pub struct StrictTable<'a> {
    source: &'a Source<'a>,
    /// What the table describes, such as `solid "beam"`.
    pub subject: String,
    /// Where it stands in the text.
    pub span: Range<usize>,
    table: &'a DeTable<'a>,
    known: Vec<&'static str>,
}

impl<'a> StrictTable<'a> {
    /// Read `table`, which stands at the bytes `span`.
    #[must_use]
    pub fn new(source: &'a Source<'a>, subject: impl Into<String>, span: Range<usize>, table: &'a DeTable<'a>) -> Self {
        StrictTable { source, subject: subject.into(), span, table, known: Vec::new() }
    }

    /// The keys that the table holds, each with its place in the text, in the order of the file.
    #[must_use]
    pub fn given(&self) -> Vec<(&str, Range<usize>)> {
        let mut keys: Vec<_> = self.table.keys().map(|key| (key.get_ref().as_ref(), key.span())).collect();
        keys.sort_by_key(|(_, span)| span.start);
        keys
    }

    /// The file is what it should be: `a scene`, `a study`.
    ///
    /// # Errors
    /// It has the tables of another kind of file.
    pub fn is_a(&self, kind: &str) -> Result<()> {
        match another(kind, |key| self.has(key)) {
            Some((_, reason)) => Err(Error::file(self.source.path, reason)),
            None => Ok(()),
        }
    }

    /// A key is there.
    #[must_use]
    pub fn has(&self, key: &str) -> bool {
        self.table.contains_key(key)
    }

    /// The value of a key, if it is there.
    ///
    /// # Errors
    /// If it is not what `read` wants.
    pub fn get<T>(&mut self, key: &'static str, read: impl FnOnce(&DeValue) -> Wanted<T>) -> Result<Option<T>> {
        self.known.push(key);
        let Some(value) = self.table.get(key) else { return Ok(None) };
        read(value.get_ref()).map(Some).map_err(|reason| match item(value.get_ref(), &reason) {
            Some(span) => self.error_at(span, format!("{key}{reason}")),
            None => self.wrong(key, reason),
        })
    }

    /// The value of a key that must be there.
    ///
    /// # Errors
    /// If it is missing or not what `read` wants.
    pub fn need<T>(&mut self, key: &'static str, read: impl FnOnce(&DeValue) -> Wanted<T>) -> Result<T> {
        self.get(key, read)?.ok_or_else(|| {
            match self.given().into_iter().find(|(typed, _)| self.may_mean(typed, key)) {
                Some((typed, span)) => {
                    self.error_at(span, format!("key {typed} is not known here; did you mean {key}?"))
                }
                None => self.fail(format!("key {key} is missing")),
            }
        })
    }

    /// Refuses a table that lacks some of the keys it takes and holds others.
    ///
    /// # Errors
    /// Names both.
    pub fn takes_only(&self, keys: &[&str]) -> Result<()> {
        let strange: Vec<_> = self.given().into_iter().filter(|(key, _)| !keys.contains(key)).collect();
        match &strange[..] {
            [(_, first), ..] if keys.iter().any(|key| !self.has(key)) => {
                let names: Vec<&str> =
                    strange.iter().map(|(key, _)| if key.is_empty() { "\"\"" } else { *key }).collect();
                let subject = self.subject.rsplit(' ').next().unwrap_or_default();
                Err(self
                    .error_at(first.clone(), format!("{subject} takes {}; not {}", keys.join(", "), names.join(", "))))
            }
            _ => Ok(()),
        }
    }

    /// A key that nobody has asked for may be a slip of the pen for `key`.
    fn may_mean(&self, typed: &str, key: &str) -> bool {
        !self.known.contains(&typed) && nearest(typed, &[key]).is_some()
    }

    /// The key `name`, and from here on what messages call the table; without one it is called by its kind and number, `solid 3`.
    ///
    /// # Errors
    /// If it is no text, or an empty one.
    pub fn named(&mut self) -> Result<String> {
        let some = |value: &DeValue| match text(value)? {
            name if name.is_empty() => Err("is empty: give one, or leave the key out".to_owned()),
            name if name.contains(['\n', '\r']) => Err("needs a name in one line".to_owned()),
            name => Ok(name),
        };
        let Some(name) = self.get("name", some)? else { return Ok(self.subject.clone()) };
        let kind = self.subject.split(' ').next().unwrap_or_default();
        self.subject = format!("{kind} \"{name}\"");
        Ok(name)
    }

    /// Some tables of which no two have one name.
    ///
    /// # Errors
    /// The second of two that do.
    pub fn with_names_of_their_own(tables: Vec<Self>) -> Result<Vec<Self>> {
        let given = |table: &Self| table.table.get("name").and_then(|value| text(value.get_ref()).ok());
        // What has none is called by its number.
        let names: Vec<String> = tables.iter().map(|t| given(t).unwrap_or_else(|| t.subject.clone())).collect();
        for (n, table) in tables.iter().enumerate() {
            if let Some(before) = names[..n].iter().position(|name| *name == names[n]) {
                return Err(match given(table) {
                    Some(_) => table.wrong("name", "is that of another table before; results are told apart by it"),
                    None => tables[before]
                        .wrong("name", "is what a later table without a name is called; results are told apart by it"),
                });
            }
        }
        Ok(tables)
    }

    /// The table that a key holds, if it is there.
    ///
    /// # Errors
    /// If it holds something else.
    pub fn table(&mut self, key: &'static str) -> Result<Option<StrictTable<'a>>> {
        self.known.push(key);
        let Some(value) = self.table.get(key) else { return Ok(None) };
        match value.get_ref() {
            DeValue::Table(table) => {
                let subject = format!("{}{key}", self.prefix());
                Ok(Some(StrictTable::new(self.source, subject, value.span(), table)))
            }
            other => Err(self.wrong(key, format!("takes a table, not {}", kind(other)))),
        }
    }

    /// The tables of a `[[key]]`; none if it is not there.
    ///
    /// # Errors
    /// If it holds something else.
    pub fn tables(&mut self, key: &'static str) -> Result<Vec<StrictTable<'a>>> {
        self.known.push(key);
        let Some(value) = self.table.get(key) else { return Ok(Vec::new()) };
        let wrong = |other: &DeValue| self.wrong(key, format!("takes tables [[{key}]], not {}", kind(other)));
        let DeValue::Array(items) = value.get_ref() else { return Err(wrong(value.get_ref())) };
        let tables = items.iter().enumerate().map(|(n, item)| match item.get_ref() {
            DeValue::Table(table) => Ok(StrictTable::new(self.source, format!("{key} {}", n + 1), item.span(), table)),
            other => Err(wrong(other)),
        });
        tables.collect()
    }

    /// The grid that a key holds, if it is there; see [`crate::grid`].
    ///
    /// # Errors
    /// If it holds none.
    pub fn grid(&mut self, key: &'static str) -> Result<Option<Edges>> {
        self.known.push(key);
        let Some(value) = self.table.get(key) else { return Ok(None) };
        if value.get_ref().is_array() {
            return Err(self.wrong(key, format!("takes one table [{key}]; tables [[{key}]] belong to a study")));
        }
        file::from_value(self.source, key, value).map(Some)
    }

    /// The grids of a `[[key]]`; none if it is not there.
    ///
    /// # Errors
    /// If one is none.
    pub fn grids(&mut self, key: &'static str) -> Result<Vec<Edges>> {
        self.known.push(key);
        let Some(value) = self.table.get(key) else { return Ok(Vec::new()) };
        let one = || self.wrong(key, format!("takes tables [[{key}]]; one table [{key}] belongs to a scene or a case"));
        let items = value.get_ref().as_array().ok_or_else(one)?;
        let read = |(n, item)| file::from_value(self.source, &format!("{key}[{n}]"), item);
        items.iter().enumerate().map(read).collect()
    }

    /// An error without a reason yet, at a key or, where that is not there, at the table.
    #[must_use]
    pub fn place(&self, key: &str) -> Error {
        let span = self.table.get(key).map_or(self.span.clone(), |value| value.span());
        self.source.error(span, "")
    }

    /// Every key must have been asked for.
    ///
    /// # Errors
    /// The first that was not.
    pub fn finish(&self) -> Result<()> {
        match self.given().into_iter().find(|(key, _)| !self.known.contains(key)) {
            None => Ok(()),
            Some((key, span)) => {
                let reason = format!("{}key {key} {}", self.prefix(), not_known(key, &self.known));
                Err(self.source.error(span, reason))
            }
        }
    }

    /// An error about a key, at its line.
    #[must_use]
    pub fn wrong(&self, key: &str, reason: impl std::fmt::Display) -> Error {
        Error { reason: format!("{}{key} {reason}", self.prefix()), ..self.place(key) }
    }

    /// An error about the table, at its line.
    #[must_use]
    pub fn fail(&self, reason: impl std::fmt::Display) -> Error {
        self.source.error(self.span.clone(), format!("{}{reason}", self.prefix()))
    }

    /// An error at a part of the text.
    #[must_use]
    pub fn error_at(&self, span: Range<usize>, reason: impl std::fmt::Display) -> Error {
        self.source.error(span, format!("{}{reason}", self.prefix()))
    }

    fn prefix(&self) -> String {
        if self.subject.is_empty() { String::new() } else { format!("{}: ", self.subject) }
    }
}

/// A value's type, with its article.
fn kind(value: &DeValue) -> &'static str {
    match value {
        DeValue::String(_) => "a text",
        DeValue::Integer(_) => "a whole number",
        DeValue::Float(_) => "a number",
        DeValue::Boolean(_) => "a truth value",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    }
}

/// Where the item of a list stands whose place a reason begins with: `[2] takes a number`.
fn item(value: &DeValue, reason: &str) -> Option<Range<usize>> {
    let (n, _) = reason.strip_prefix('[')?.split_once(']')?;
    value.as_array()?.get(n.parse::<usize>().ok()?).map(toml::Spanned::span)
}

/// Larger numbers are a slip of the pen, in any units.
pub const LARGEST: f64 = 1e30;

/// What must be above zero is at least this.
pub const SMALLEST: f64 = 1e-30;

/// A number.
///
/// # Errors
/// What it should be.
pub fn number(value: &DeValue) -> Wanted<f64> {
    let digits = match value {
        DeValue::Float(f) => f.as_str(),
        DeValue::Integer(i) if i.radix() == 10 => i.as_str(),
        DeValue::Integer(_) => return Err("takes a number in decimal digits".to_owned()),
        other => return Err(format!("takes a number, not {}", kind(other))),
    };
    match digits.parse::<f64>() {
        Ok(x) if x.abs() <= LARGEST => Ok(x),
        _ => Err(format!("takes a number within ±{LARGEST:e}, not {digits}")),
    }
}

/// A number above zero.
///
/// # Errors
/// What it should be.
pub fn positive(value: &DeValue) -> Wanted<f64> {
    let x = number(value)?;
    match x {
        _ if x >= SMALLEST => Ok(x),
        _ if x > 0.0 => Err(format!("must be at least {SMALLEST:e}, not {}", written(x))),
        _ => Err(format!("must be positive, not {}", written(x))),
    }
}

/// A number that is not below zero.
///
/// # Errors
/// What it should be.
pub fn not_negative(value: &DeValue) -> Wanted<f64> {
    let x = number(value)?;
    if x >= 0.0 { Ok(x) } else { Err(format!("must not be below 0, not {}", written(x))) }
}

/// A number that is neither below zero nor above another.
///
/// # Errors
/// What it should be.
pub fn up_to(most: f64) -> impl Fn(&DeValue) -> Wanted<f64> {
    move |value| {
        let x = not_negative(value)?;
        if x <= most { Ok(x) } else { Err(format!("must be at most {}, not {}", written(most), written(x))) }
    }
}

/// A number from 0 to 1.
///
/// # Errors
/// What it should be.
pub fn fraction(value: &DeValue) -> Wanted<f64> {
    let x = number(value)?;
    if (0.0..=1.0).contains(&x) { Ok(x) } else { Err(format!("must be from 0 to 1, not {}", written(x))) }
}

/// A whole number of at least zero.
///
/// # Errors
/// What it should be.
pub fn index(value: &DeValue) -> Wanted<usize> {
    let i = match value {
        DeValue::Integer(i) => i,
        DeValue::Float(x) => return Err(format!("takes a whole number, not {x}")),
        other => return Err(format!("takes a whole number, not {}", kind(other))),
    };
    usize::from_str_radix(i.as_str(), i.radix()).map_err(|_| match i.as_str().starts_with('-') {
        true => format!("takes a whole number from 0 on, not {i}"),
        false => format!("takes a whole number, not one as large as {i}"),
    })
}

/// A whole number of at least one.
///
/// # Errors
/// What it should be.
pub fn count(value: &DeValue) -> Wanted<usize> {
    let n = index(value)?;
    if n > 0 { Ok(n) } else { Err("must be at least 1, not 0".to_owned()) }
}

/// True or false.
///
/// # Errors
/// What it should be.
pub fn truth(value: &DeValue) -> Wanted<bool> {
    value.as_bool().ok_or_else(|| format!("takes true or false, not {}", kind(value)))
}

/// A text.
///
/// # Errors
/// What it should be.
pub fn text(value: &DeValue) -> Wanted<String> {
    value.as_str().map(str::to_owned).ok_or_else(|| format!("takes a text, not {}", kind(value)))
}

/// A unit of length, by its name.
///
/// # Errors
/// What it should be.
pub fn unit(value: &DeValue) -> Wanted<Unit> {
    let name = text(value)?;
    Unit::named(&name).ok_or_else(|| format!("\"{name}\" is not known: {}", Unit::ALL.map(Unit::name).join(", ")))
}

/// A list of values of one kind.
///
/// # Errors
/// What the first wrong one should be.
pub fn list<T>(read: impl Fn(&DeValue) -> Wanted<T>) -> impl FnOnce(&DeValue) -> Wanted<Vec<T>> {
    move |value| {
        let items = value.as_array().ok_or_else(|| format!("takes a list, not {}", kind(value)))?;
        let read = |(n, item): (usize, &toml::Spanned<DeValue>)| {
            let deeper = |reason: &str| if reason.starts_with('[') { "" } else { " " };
            read(item.get_ref()).map_err(|reason| format!("[{n}]{}{reason}", deeper(&reason)))
        };
        items.iter().enumerate().map(read).collect()
    }
}

/// A list of three values of one kind.
///
/// # Errors
/// What it should be.
pub fn three<T>(read: impl Fn(&DeValue) -> Wanted<T>) -> impl FnOnce(&DeValue) -> Wanted<[T; 3]> {
    move |value| {
        if !value.is_array() {
            return Err(format!("takes a list of three values, not {}", kind(value)));
        }
        let found = list(read)(value)?;
        <[T; 3]>::try_from(found).map_err(|all| format!("takes three values, not {}", all.len()))
    }
}

/// Three numbers.
///
/// # Errors
/// What it should be.
pub fn point(value: &DeValue) -> Wanted<DVec3> {
    three(number)(value).map(DVec3::from_array)
}
