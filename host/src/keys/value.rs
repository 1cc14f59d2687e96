//! Values of a file, each with its place if the format tells.

use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A value and the bytes of the text that it stands in.
#[derive(Debug, Clone, PartialEq)]
pub struct PlacedValue {
    /// The value.
    pub value: Value,
    /// Its bytes, if they are known.
    pub span: Option<Range<usize>>,
}

/// What can stand behind a key.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// In quotes.
    Text(String),
    /// Without a fraction.
    Whole(i128),
    /// Any number.
    Number(f64),
    /// true or false.
    Truth(bool),
    /// A day or a time.
    Date(String),
    /// Values in brackets.
    List(Vec<PlacedValue>),
    /// Keys with values, in the order of the file.
    Table(Vec<Entry>),
    /// Nothing, which JSON can say.
    Null,
}

/// A key and its value.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// The key.
    pub key: String,
    /// Its bytes, if they are known.
    pub span: Option<Range<usize>>,
    /// Its value.
    pub node: PlacedValue,
}

/// A part of a text and what is wrong there.
pub type Misfit = (Option<Range<usize>>, String);

impl Value {
    /// What it is, with its article.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Value::Text(_) => "a text",
            Value::Whole(_) => "a whole number",
            Value::Number(_) => "a number",
            Value::Truth(_) => "a truth value",
            Value::Date(_) => "a date",
            Value::List(_) => "a list",
            Value::Table(_) => "a table",
            Value::Null => "nothing",
        }
    }
}

impl PlacedValue {
    /// Of a value of TOML.
    ///
    /// # Errors
    /// A number that is too large.
    pub fn of_toml(value: &Spanned<DeValue>) -> Result<Self, Misfit> {
        let span = Some(value.span());
        let number = |digits: &str| match digits.parse::<f64>() {
            Ok(x) if x.is_finite() || digits.contains("inf") || digits.contains("nan") => Ok(Value::Number(x)),
            _ => Err((span.clone(), format!("{digits} is too large for a number"))),
        };
        let value = match value.get_ref() {
            DeValue::String(text) => Value::Text(text.to_string()),
            DeValue::Integer(i) => match i128::from_str_radix(i.as_str(), i.radix()) {
                Ok(n) => Value::Whole(n),
                Err(_) => number(i.as_str())?,
            },
            DeValue::Float(f) => number(f.as_str())?,
            DeValue::Boolean(truth) => Value::Truth(*truth),
            DeValue::Datetime(date) => Value::Date(date.to_string()),
            DeValue::Array(items) => Value::List(items.iter().map(PlacedValue::of_toml).collect::<Result<_, _>>()?),
            DeValue::Table(table) => return PlacedValue::of_table(table, value.span()),
        };
        Ok(PlacedValue { value, span })
    }

    /// Of a table of TOML.
    ///
    /// # Errors
    /// As [`PlacedValue::of_toml`].
    pub fn of_table(table: &DeTable, span: Range<usize>) -> Result<Self, Misfit> {
        let entry = |(key, value): (&Spanned<std::borrow::Cow<str>>, &Spanned<DeValue>)| {
            Ok(Entry { key: key.get_ref().to_string(), span: Some(key.span()), node: PlacedValue::of_toml(value)? })
        };
        let mut entries: Vec<Entry> = table.iter().map(entry).collect::<Result<_, Misfit>>()?;
        entries.sort_by_key(|e| e.span.as_ref().map(|s| s.start));
        Ok(PlacedValue { value: Value::Table(entries), span: Some(span) })
    }
}
