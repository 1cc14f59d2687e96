//! What is wrong with the spelling of a TOML file, in the words of whoever wrote it instead of those of the reader of TOML.

use std::ops::Range;

/// How a message of the reader of TOML begins, and what it comes to.
const SLIPS: [(&str, &str); 17] = [
    ("key with no value", "`=` and a value are missing behind this key"),
    ("string values must be quoted", NO_VALUE),
    ("invalid boolean", NO_VALUE),
    ("unclosed array table", "`]]` is missing at the end of this head of a table"),
    ("unclosed array", "`]` is missing at the end of this list"),
    ("unclosed table", "`]` is missing at the end of this head of a table"),
    ("unclosed inline table", "`}` is missing at the end of this table"),
    (
        "unexpected key or value",
        "nothing may follow a value on its line but a comment; decimals are written with a point",
    ),
    ("invalid mantissa", "a number needs a digit before its point"),
    ("invalid fraction", "a number needs a digit behind its point"),
    ("invalid exponent", "a number needs digits behind its e"),
    ("unexpected leading zero", "a number begins with one zero too many"),
    ("invalid basic string", "this text has no closing quote, or a character that cannot stand in it"),
    ("invalid literal string", "this text has no closing quote, or a character that cannot stand in it"),
    ("extra `=`", "one `=` is too many"),
    ("missing comma between key-value pairs", "a comma is missing before this key"),
    ("missing assignment between key-value pairs", "`=` is missing between this key and its value"),
];

/// Of what is neither a number nor anything else.
const NO_VALUE: &str =
    "this is no value: numbers are written as 2.5 or 1e-3, texts stand in quotes, commas between the values of a list";

/// What `message` about the bytes `span` of a text comes to.
#[must_use]
pub fn in_words(text: &str, span: &Range<usize>, message: &str) -> String {
    if message.starts_with("duplicate key") {
        return twice(text, span);
    }
    let known = SLIPS.iter().find(|(begin, _)| message.starts_with(begin));
    match known.map(|(_, words)| *words) {
        Some(NO_VALUE) if text.get(span.clone()).is_some_and(|t| t.trim().is_empty()) => {
            "a value is missing here".to_owned()
        }
        Some(words) => words.to_owned(),
        None => message.lines().collect::<Vec<_>>().join(", "),
    }
}

/// That the key or the table at `span` is given twice.
fn twice(text: &str, span: &Range<usize>) -> String {
    let begin = text.get(..span.start).and_then(|before| before.rfind('\n')).map_or(0, |at| at + 1);
    let line = text.get(begin..).and_then(|rest| rest.lines().next()).unwrap_or("").trim();
    let Some((name, one)) = head(line) else {
        let key = text.get(span.clone()).unwrap_or("").trim();
        return format!("key {key} is given twice in this table");
    };
    let before = text.get(..begin).unwrap_or("").lines().enumerate();
    let first = before.filter_map(|(n, other)| Some((n, head(other.trim())?))).find(|(_, (other, _))| *other == name);
    match first {
        None => format!("{name} is given before, as a key with a value"),
        Some((n, (_, other))) if other != one => format!(
            "{name} stands here as {} and before in line {} as {}: each of several is a table [[{name}]]",
            brackets(name, one),
            n + 1,
            brackets(name, other)
        ),
        Some(_) => format!("the table {} is given twice", brackets(name, one)),
    }
}

/// The name in the head of a table, and whether it has one pair of brackets.
fn head(line: &str) -> Option<(&str, bool)> {
    let line = line.split('#').next().unwrap_or("").trim();
    let several = line.strip_prefix("[[").and_then(|l| l.strip_suffix("]]"));
    let one = || line.strip_prefix('[').and_then(|l| l.strip_suffix(']'));
    several.map(|name| (name.trim(), false)).or_else(|| one().map(|name| (name.trim(), true)))
}

fn brackets(name: &str, one: bool) -> String {
    if one { format!("[{name}]") } else { format!("[[{name}]]") }
}
