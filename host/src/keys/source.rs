//! The text of a file, for messages that show the place: line, column, the line itself with a mark.

use super::json;
use super::slips::in_words;
use super::value::{PlacedValue, Value};
use crate::error::{Error, Result, excerpt};
use std::ops::Range;
use std::path::Path;
use toml::de::DeTable;

/// Bytes on either side of a place within which an excerpt lies: more than it shows.
const NEAR: usize = 1000;

/// A text and the file it is from.
#[derive(Debug, Clone)]
pub struct Source<'a> {
    /// The file.
    pub path: &'a Path,
    /// Its text.
    pub text: &'a str,
    /// Where its line breaks are.
    breaks: Vec<usize>,
}

impl<'a> Source<'a> {
    /// A file's path and text.
    #[must_use]
    pub fn new(path: &'a Path, text: &'a str) -> Self {
        Source { path, text, breaks: text.match_indices('\n').map(|(at, _)| at).collect() }
    }

    /// The text as a table of TOML.
    ///
    /// # Errors
    /// It is none.
    pub fn toml(&self) -> Result<toml::Spanned<DeTable<'a>>> {
        if let Some(json) = self.as_json_would_begin() {
            return Err(self.error(json, "this is JSON; scenes, cases and studies are TOML, grids may be either"));
        }
        let (table, slips) = DeTable::parse_recoverable(self.text);
        let place = |e: &toml::de::Error| e.span().unwrap_or(0..0);
        // One slip leads to others further down, which are found before it.
        match slips.iter().min_by_key(|e| place(e).start) {
            None => Ok(table),
            Some(e) => Err(self.error(place(e), in_words(self.text, &place(e), e.message()))),
        }
    }

    /// The brace that JSON begins with, if the text begins so.
    fn as_json_would_begin(&self) -> Option<Range<usize>> {
        let at = self.text.len() - self.text.trim_start().len();
        self.text[at..].starts_with('{').then_some(at..at + 1)
    }

    /// The text is JSON rather than TOML: the file is called so, or begins as no TOML does.
    #[must_use]
    pub fn is_json(&self) -> bool {
        let named = self.path.extension().is_some_and(|e| e.eq_ignore_ascii_case("json"));
        named || self.text.trim_start().starts_with('{')
    }

    /// The line that a byte of the text is in, from 1.
    #[must_use]
    pub fn line(&self, at: usize) -> usize {
        self.breaks.partition_point(|&end| end < at) + 1
    }

    /// An error at a part of the text.
    #[must_use]
    pub fn error(&self, span: Range<usize>, reason: impl Into<String>) -> Error {
        let (line, begin) = (self.line(span.start), self.begin(span.start));
        let column = self.text.get(begin..span.start).map_or(1, |before| before.chars().count() + 1);
        let error = Error::at(self.path, format!("line {line}, column {column}"), reason);
        Error { excerpt: Some(self.excerpt(span)), ..error }
    }

    /// An error at a key such as `initial.regions[0].rho`, or at the deepest table above it that is there.
    #[must_use]
    pub fn at_key(&self, key: &str, reason: impl Into<String>) -> Error {
        let reason = format!("key {key}: {}", reason.into());
        let toml = || self.toml().ok().and_then(|table| PlacedValue::of_table(table.get_ref(), table.span()).ok());
        let table = if self.is_json() { json::placed(self.text).ok() } else { toml() };
        match table.and_then(|table| deepest(&table, key)) {
            Some(span) => self.error(span, reason),
            None => self.at_end(reason),
        }
    }

    /// An error about what the whole text does not have: at its end.
    #[must_use]
    pub fn at_end(&self, reason: impl Into<String>) -> Error {
        let end = self.text.trim_end().len();
        self.error(end..end, format!("{}; the file ends here", reason.into()))
    }

    /// The file is none of geometry, as its suffix would tell, but `a case`, `a study`.
    ///
    /// # Errors
    /// It is one, and there.
    pub fn no_geometry(path: &Path, kind: &str) -> Result<()> {
        let geometry = path.extension().is_some_and(|e| ["stl", "obj"].iter().any(|s| e.eq_ignore_ascii_case(s)));
        match geometry && path.is_file() {
            true => Err(Error::file(
                path,
                format!(
                    "this is a geometry, not {kind}; voidage porosity and inspect read it, [porosity] scene = \"FILE\" of a case names it"
                ),
            )),
            false => Ok(()),
        }
    }

    /// Where the line begins that a byte of the text is in.
    fn begin(&self, at: usize) -> usize {
        self.line(at).checked_sub(2).map_or(0, |before| self.breaks[before] + 1)
    }

    /// The line of a part of the text, and a mark under that part.
    fn excerpt(&self, span: Range<usize>) -> String {
        let (number, begin) = (self.line(span.start), self.begin(span.start));
        let end = self.breaks.get(number - 1).copied().unwrap_or(self.text.len());
        let text = |range: Range<usize>| self.text.get(range).unwrap_or("");
        let start = span.start.min(end);
        // A line may be the whole file: what is far from the place is not shown.
        let (begin, end) = (self.boundary(begin.max(start.saturating_sub(NEAR))), self.boundary(end.min(start + NEAR)));
        let width = text(start..span.end.clamp(start, end)).trim_end().chars().count();
        excerpt(number, text(begin..end), text(begin..start).chars().count(), width)
    }

    /// The first place from `at` on that is not within a character.
    fn boundary(&self, at: usize) -> usize {
        (at..self.text.len()).find(|&at| self.text.is_char_boundary(at)).unwrap_or(self.text.len())
    }
}

/// Where a key stands; where it does not, the deepest of the tables and lists that lead to it, unless that is the whole file.
fn deepest(table: &PlacedValue, key: &str) -> Option<Range<usize>> {
    let (mut node, mut found) = (table, None);
    for part in key.split(['.', '[']).map(|part| part.trim_end_matches(']')) {
        let next = match &node.value {
            Value::Table(entries) => entries.iter().find(|e| e.key == part).map(|e| &e.node),
            Value::List(items) => part.parse::<usize>().ok().and_then(|n| items.get(n)),
            _ => None,
        };
        let Some(next) = next else { break };
        (node, found) = (next, next.span.clone());
    }
    found
}

/// Kinds of files, a key that only they have, and what reads them.
const KINDS: [(&str, &str, &str); 4] = [
    ("a case", "gas", "voidage solve reads it"),
    ("a case", "initial", "voidage solve reads it"),
    ("a study", "method", "voidage study reads it"),
    (
        "a scene",
        "solid",
        "voidage porosity reads it, [porosity] scene = \"FILE\" of a case names it, files = [\"FILE\"] of a [[scene]] of a study",
    ),
];

/// A key that tells a file to be of another kind than `kind`, and a sentence about it.
pub fn another(kind: &str, has: impl Fn(&str) -> bool) -> Option<(&'static str, String)> {
    let own = KINDS.iter().any(|(k, key, _)| *k == kind && has(key));
    let (other, key, reader) = KINDS.iter().find(|(k, key, _)| *k != kind && has(key)).filter(|_| !own)?;
    Some((key, format!("this is {other}, not {kind}: it has the key {key}; {reader}")))
}
