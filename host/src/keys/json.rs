//! JSON as values with their places. What the text must be, the reader of JSON tells; this one finds where each value of a right text stands.

use super::value::{Entry, Misfit, PlacedValue, Value};
use serde_json::Value as Json;
use std::collections::BTreeSet;
use std::ops::Range;

/// The value of a text of JSON.
///
/// # Errors
/// It is none, or has a key twice in one table.
pub fn placed(text: &str) -> Result<PlacedValue, Misfit> {
    serde_json::from_str::<Json>(text).map_err(|e| no_json(text, &e))?;
    Scanner { text, at: 0 }.value()
}

/// What the reader of JSON says, and where.
fn no_json(text: &str, error: &serde_json::Error) -> Misfit {
    let said = error.to_string();
    let reason = said.rsplit_once(" at line ").map_or(&said[..], |(reason, _)| reason);
    let line = text.split_inclusive('\n').take(error.line().saturating_sub(1)).map(str::len).sum::<usize>();
    let at = text.floor_char_boundary(line + error.column().saturating_sub(1));
    let end = text[at..].chars().next().map_or(at, |c| at + c.len_utf8());
    let words = WORDS.iter().find(|(beginning, _)| reason.starts_with(beginning)).map_or(reason, |(_, words)| words);
    (Some(at..end), format!("this is no JSON: {words}"))
}

/// What the reader of JSON says, by its beginning, and the same in the words of who wrote the text.
const WORDS: [(&str, &str); 12] = [
    ("EOF while parsing", "the text ends too early: a bracket or a quote is not closed"),
    ("expected `:`", "a colon is missing behind this key"),
    ("expected `,` or `]`", "a comma is missing here, or the `]` of the list before"),
    ("expected `,` or `}`", "a comma is missing here, or the `}` of the table before"),
    ("trailing comma", "no comma may stand before this bracket"),
    ("trailing characters", "something stands behind its end"),
    ("key must be a string", "a key in quotes is missing here"),
    (
        "expected",
        "no value stands here: numbers are written as 2.5 or 1e-3, texts in quotes; NaN and infinity are none",
    ),
    ("invalid number", "this is no number: they are written as 2.5 or 1e-3"),
    ("number out of range", "this number is too large"),
    ("control character", "this text has no closing quote on its line"),
    ("recursion limit", "lists and tables stand too deep in each other"),
];

/// A place in a text that is known to be JSON, so that every character says what follows.
struct Scanner<'a> {
    text: &'a str,
    at: usize,
}

impl Scanner<'_> {
    /// The next character that is no space.
    fn next(&mut self) -> u8 {
        let bytes = self.text.as_bytes();
        while bytes.get(self.at).is_some_and(u8::is_ascii_whitespace) {
            self.at += 1;
        }
        bytes.get(self.at).copied().unwrap_or(0)
    }

    /// Steps over the next character if it is this one.
    fn skip(&mut self, mark: u8) -> bool {
        let here = self.next() == mark;
        self.at += usize::from(here);
        here
    }

    /// Steps over a text in quotes, a number or a word.
    fn word(&mut self) -> Range<usize> {
        let quoted = self.next() == b'"';
        let (start, rest) = (self.at, &self.text.as_bytes()[self.at..]);
        let mut escaped = false;
        let ends = |(n, &c): (usize, &u8)| {
            let end = quoted && n > 0 && c == b'"' && !escaped;
            escaped = c == b'\\' && !escaped;
            end || !quoted && (b",]}".contains(&c) || c.is_ascii_whitespace())
        };
        let length = rest.iter().enumerate().position(ends).map_or(rest.len(), |n| n + usize::from(quoted));
        self.at += length;
        start..self.at
    }

    fn value(&mut self) -> Result<PlacedValue, Misfit> {
        let first = self.next();
        let start = self.at;
        let value = match first {
            b'{' => self.table()?,
            b'[' => self.list()?,
            _ => {
                let word = self.word();
                scalar(serde_json::from_str(&self.text[word]).unwrap_or(Json::Null))
            }
        };
        Ok(PlacedValue { value, span: Some(start..self.at) })
    }

    fn list(&mut self) -> Result<Value, Misfit> {
        let mut items = Vec::new();
        self.skip(b'[');
        while !self.skip(b']') {
            items.push(self.value()?);
            self.skip(b',');
        }
        Ok(Value::List(items))
    }

    fn table(&mut self) -> Result<Value, Misfit> {
        let (mut entries, mut seen) = (Vec::new(), BTreeSet::new());
        self.skip(b'{');
        while !self.skip(b'}') {
            let span = self.word();
            let key: String = serde_json::from_str(&self.text[span.clone()]).unwrap_or_default();
            if !seen.insert(key.clone()) {
                return Err((Some(span), format!("key {key} is given twice in this table")));
            }
            self.skip(b':');
            entries.push(Entry { key, span: Some(span), node: self.value()? });
            self.skip(b',');
        }
        Ok(Value::Table(entries))
    }
}

/// What is neither a list nor a table.
fn scalar(value: Json) -> Value {
    match value {
        Json::Bool(truth) => Value::Truth(truth),
        Json::Number(n) => {
            let whole = n.as_i64().map(i128::from).or(n.as_u64().map(i128::from));
            whole.map_or(Value::Number(n.as_f64().unwrap_or(f64::NAN)), Value::Whole)
        }
        Json::String(text) => Value::Text(text),
        _ => Value::Null,
    }
}
