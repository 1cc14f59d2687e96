//! What is wrong with the spelling of a TOML file, in the words of whoever wrote it instead of those of the reader of TOML.

use std::ops::Range;

/// How a message of the reader of TOML begins, and what it comes to; the first that fits counts.
const SLIPS: [(&str, &str); 48] = [
    ("key with no value", "`=` and a value are missing behind this key"),
    ("string values must be quoted", NO_VALUE),
    ("invalid boolean", NO_VALUE),
    ("invalid float", NO_VALUE),
    ("invalid date", NO_VALUE),
    ("invalid time", NO_VALUE),
    ("invalid integer", NO_NUMBER),
    ("invalid hexadecimal", NO_NUMBER),
    ("invalid octal", NO_NUMBER),
    ("invalid binary", NO_NUMBER),
    ("radix must be lowercase", NO_NUMBER),
    ("redundant integer number prefix", NO_NUMBER),
    ("integers with a radix cannot be signed", NO_NUMBER),
    ("unexpected sign", NO_NUMBER),
    ("redundant numeric sign", "a number has one sign at most"),
    ("`_` may only go between digits", "`_` may only stand between digits"),
    ("unclosed array table", "`]]` is missing at the end of this head of a table"),
    ("unclosed array", "`]` is missing at the end of this list"),
    ("unclosed table", "`]` is missing at the end of this head of a table"),
    ("unclosed inline table", "`}` is missing at the end of this table"),
    ("invalid mantissa", "a number needs a digit before its point"),
    ("invalid fraction", "a number needs a digit behind its point"),
    ("invalid exponent", "a number needs digits behind its e"),
    ("unexpected leading zero", "a number begins with one zero too many"),
    ("invalid basic string", NO_TEXT),
    ("invalid literal string", NO_TEXT),
    (
        "invalid multi-line",
        "the text that begins with three quotes has no three at its end, or a character that cannot stand in it",
    ),
    ("missing escaped value", BACKSLASH),
    ("too few unicode value digits", BACKSLASH),
    ("invalid value", BACKSLASH),
    ("extra `=`", "one `=` is too many"),
    ("extra assignment", "one `=` is too many"),
    ("missing value", "a value is missing here"),
    ("missing comma between array elements", "a comma is missing here, or the `]` of the list before"),
    ("missing comma between key-value pairs", "a comma is missing before this key"),
    ("missing assignment between key-value pairs", "`=` is missing between this key and its value"),
    ("extra comma in array", "one comma is too many in this list"),
    (
        "extra comma in inline table",
        "in braces stand keys with values, `{ angle = 30 }`; lists stand in brackets, `[1, 2, 3]`",
    ),
    ("missing key for inline table element", "a key is missing before this `=`"),
    ("unexpected `=` in array", "a list holds values, without keys"),
    ("unquoted keys cannot be empty", "a key or a name is missing here"),
    ("keys cannot be multi-line", "a key stands in one line"),
    ("missing table open", "this bracket has no partner"),
    (
        "carriage return must be followed",
        "lines end in a carriage return alone: save the file with the line ends of Unix or Windows",
    ),
    ("invalid comment character", "this character cannot stand in a comment"),
    ("cannot recurse further", DEEP),
    ("recursion limit", DEEP),
    ("cannot extend value", "this key is given before as a whole, and cannot take further keys"),
];

/// Of what is neither a number nor anything else.
const NO_VALUE: &str =
    "this is no value: numbers are written as 2.5 or 1e-3, texts stand in quotes, commas between the values of a list";

/// Of a number in another base than ten.
const NO_NUMBER: &str = "this is no number: numbers are written as 2.5 or 1e-3";

/// Of a text in quotes.
const NO_TEXT: &str = "this text has no closing quote, or a character that cannot stand in it";

/// Of the path of a file, as a rule.
const BACKSLASH: &str =
    "a backslash means something else in double quotes: write \\\\, or / in paths, or put the text in single quotes";

/// Of brackets without end.
const DEEP: &str = "tables and lists stand too deep in each other";

/// Of a list.
const NO_PARENTHESES: &str = "lists stand in brackets: `[1, 2, 3]`";

/// Of a comment in the way of other languages.
const NO_COMMENT: &str = "a comment begins with #";

/// Of anything else.
const NO_LINE: &str =
    "this cannot be read: a line is a key with a value, `key = 2.5`, or the head of a table, `[grid]` or `[[solid]]`";

/// What `message` about the bytes `span` of a text comes to.
#[must_use]
pub fn in_words(text: &str, span: &Range<usize>, message: &str) -> String {
    let known = SLIPS.iter().find(|(begin, _)| message.starts_with(begin));
    match known.map(|(_, words)| *words) {
        Some(NO_VALUE) if text.get(span.clone()).is_some_and(|t| t.trim().is_empty()) => {
            "a value is missing here".to_owned()
        }
        Some(NO_VALUE) if text.get(span.start..).is_some_and(|t| t.starts_with('(')) => NO_PARENTHESES.to_owned(),
        Some(NO_TEXT) if is_comma_in_number(text, span.start) => "decimals are written with a point".to_owned(),
        Some(words) => words.to_owned(),
        None if message.starts_with("duplicate key") => twice(text, span),
        None if message.starts_with("invalid unquoted key") => no_key(text, span).to_owned(),
        None if message.starts_with("unexpected key or value") => behind_a_value(text, span).to_owned(),
        None => NO_LINE.to_owned(),
    }
}

/// The line that a byte of a text is in, up to that byte and from it on.
fn line_at(text: &str, at: usize) -> (&str, &str) {
    let (before, after) = text.split_at_checked(at).unwrap_or((text, ""));
    (before.rsplit('\n').next().unwrap_or(""), after.lines().next().unwrap_or(""))
}

/// Is the last thing before a byte of a text a number with a comma in it, `101325,0`?
fn is_comma_in_number(text: &str, at: usize) -> bool {
    let number = line_at(text, at).0.trim_end();
    let (Some((before, after)), is_digit) = (number.rsplit_once(','), |c: char| c.is_ascii_digit()) else {
        return false;
    };
    before.ends_with(is_digit) && !after.is_empty() && after.chars().all(is_digit)
}

/// What a character is that cannot stand in a key.
fn no_key(text: &str, span: &Range<usize>) -> &'static str {
    let (before, after) = line_at(text, span.start);
    match after.chars().next() {
        Some('/' | ';' | '%' | '!' | '-') if before.trim().is_empty() => NO_COMMENT,
        Some('<' | '>') => NO_LINE,
        Some(':') => "between a key and its value stands `=`, not `:`",
        _ => {
            "this cannot stand in a key: keys are of letters without accents, digits, - and _, with common spaces around them"
        }
    }
}

/// What stands behind a value or a head of a table, and should not.
fn behind_a_value(text: &str, span: &Range<usize>) -> &'static str {
    let (before, after) = line_at(text, span.start);
    let value = before.split_once('=').map(|(_, value)| value.trim_start());
    match value {
        _ if after.starts_with("//") => NO_COMMENT,
        Some(value) if value.starts_with('(') => NO_PARENTHESES,
        Some(_) => "nothing may follow a value on its line but a comment; decimals are written with a point",
        None => "nothing may follow the head of a table on its line but a comment",
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
        Some(_) => format!(
            "the table {} is given twice; where several may stand each is a table [[{name}]]",
            brackets(name, one)
        ),
    }
}

/// The name in the head of a table, and whether it has one pair of brackets.
fn head(line: &str) -> Option<(&str, bool)> {
    let line = line.split('#').next().unwrap_or("").trim();
    let name = line.starts_with('[').then(|| line.trim_matches(['[', ']']).trim())?;
    Some((name, !line.starts_with("[[")))
}

fn brackets(name: &str, one: bool) -> String {
    if one { format!("[{name}]") } else { format!("[[{name}]]") }
}
