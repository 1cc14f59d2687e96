//! Words of a text with their places.
//!
//! A place is a byte offset; it becomes a line number only when a message needs one, so that reading does not count lines.
//! Lines end with LF, CR LF or CR alone.

use crate::error::{Error, excerpt};
use crate::geometry::mesh::LARGEST;
use std::path::Path;

/// A run of bytes without white space.
#[derive(Debug, Clone, Copy)]
pub struct Token<'a> {
    pub bytes: &'a [u8],
    /// Offset of its first byte.
    pub at: usize,
}

impl Token<'_> {
    /// Whether it is this keyword, in any case.
    pub fn is(&self, keyword: &str) -> bool {
        self.bytes.eq_ignore_ascii_case(keyword.as_bytes())
    }

    /// Whether a comment begins here. Only OBJ has them (`#`), but people write both kinds into STL.
    pub fn is_comment(&self) -> bool {
        self.bytes.starts_with(b"#") || self.bytes.starts_with(b"//")
    }

    /// Its value as a coordinate, or what is wrong with it.
    pub fn number(&self) -> Result<f64, String> {
        match std::str::from_utf8(self.bytes).ok().and_then(|text| text.parse::<f64>().ok()) {
            Some(value) if value.abs() <= LARGEST => Ok(value),
            Some(value) if value.is_finite() => {
                Err(format!("{} is no coordinate: it is beyond {LARGEST:e}", quote(self.bytes)))
            }
            Some(_) => Err(format!("{} is not finite", quote(self.bytes))),
            None => Err(format!("{} is not a number{}", quote(self.bytes), self.advice())),
        }
    }

    fn advice(&self) -> &'static str {
        let is_digit_or = |mark: &[u8]| self.bytes.iter().all(|byte| byte.is_ascii_digit() || mark.contains(byte));
        if is_digit_or(b"+-.dD") {
            " (Fortran's exponent D; write E)"
        } else if is_digit_or(b"+-,eE") {
            " (decimal comma; write a point)"
        } else {
            ""
        }
    }
}

/// The words of a text, one after the other.
#[derive(Debug, Clone)]
pub struct Tokens<'a> {
    text: &'a [u8],
    at: usize,
}

impl<'a> Tokens<'a> {
    pub fn new(text: &'a [u8]) -> Self {
        Tokens { text, at: 0 }
    }

    /// The next word on this line. A backslash before the line's end joins the next line (OBJ); `#` ends the line.
    pub fn next_in_line(&mut self) -> Option<Token<'a>> {
        loop {
            self.skip_while(is_blank);
            match self.text.get(self.at)? {
                b'\\' if self.joins_lines() => self.skip_line_end(),
                b'#' => return None,
                byte if is_line_end(*byte) => return None,
                _ => return self.word().map(|word| self.without_join(word)),
            }
        }
    }

    /// The next word before the end of this line, whatever it is.
    pub fn next_to_line_end(&mut self) -> Option<Token<'a>> {
        self.skip_while(is_blank);
        self.word()
    }

    /// A word without the backslash at its end that joins the next line.
    fn without_join(&mut self, word: Token<'a>) -> Token<'a> {
        let Some((b'\\', bytes)) = word.bytes.split_last() else { return word };
        let after = std::mem::replace(&mut self.at, word.at + bytes.len());
        if self.joins_lines() {
            return Token { bytes, ..word };
        }
        self.at = after;
        word
    }

    fn word(&mut self) -> Option<Token<'a>> {
        let at = self.at;
        let rest = &self.text[at..];
        let length = rest.iter().position(|&byte| is_space(byte)).unwrap_or(rest.len());
        self.at = at + length;
        (length > 0).then(|| Token { bytes: &rest[..length], at })
    }

    /// Whether nothing but blanks stands between the backslash here and the end of the line or text.
    fn joins_lines(&self) -> bool {
        let mut rest = self.text[self.at + 1..].iter();
        rest.find(|&&byte| is_line_end(byte) || !is_space(byte)).is_none_or(|&byte| is_line_end(byte))
    }

    /// Goes to the start of the next line.
    fn skip_line_end(&mut self) {
        self.at = self.line_end();
        if self.text[self.at..].starts_with(b"\r\n") {
            self.at += 1;
        }
        self.at = (self.at + 1).min(self.text.len());
    }

    fn skip_while(&mut self, skip: impl Fn(u8) -> bool) {
        let rest = &self.text[self.at..];
        self.at += rest.iter().position(|&byte| !skip(byte)).unwrap_or(rest.len());
    }

    /// Offset of the next word's first byte or of white space before it.
    pub fn at(&self) -> usize {
        self.at
    }

    /// Goes back or forth to an offset.
    pub fn go_to(&mut self, at: usize) {
        self.at = at.min(self.text.len());
    }

    /// Offset of the end of this line, or of the text.
    pub fn line_end(&self) -> usize {
        let rest = &self.text[self.at..];
        self.at + rest.iter().position(|&byte| is_line_end(byte)).unwrap_or(rest.len())
    }

    /// Passes over the rest of the line that holds `at`.
    pub fn skip_line_from(&mut self, at: usize) {
        self.go_to(at);
        self.at = self.line_end();
    }

    /// The bytes from `at` up to `end`, without white space around, as text; what is not UTF-8 is taken for Latin-1, and its control codes become U+FFFD.
    pub fn trimmed(&self, at: usize, end: usize) -> String {
        let bytes = self.text[at..end].trim_ascii();
        let latin = |&byte: &u8| match char::from(byte) {
            c if c.is_control() && c != '\t' => char::REPLACEMENT_CHARACTER,
            c => c,
        };
        std::str::from_utf8(bytes).map_or_else(|_| bytes.iter().map(latin).collect(), str::to_owned)
    }

    /// Length of the text.
    pub fn len(&self) -> usize {
        self.text.len()
    }

    /// Line of an offset, as a place for a message.
    pub fn line(&self, at: usize) -> String {
        format!("line {}", self.line_number(at))
    }

    /// Line of an offset, counted from 1.
    fn line_number(&self, at: usize) -> usize {
        let before = &self.text[..at.min(self.text.len())];
        let ends = |i: usize, byte: u8| byte == b'\n' || (byte == b'\r' && self.text.get(i + 1) != Some(&b'\n'));
        before.iter().enumerate().filter(|&(i, &byte)| ends(i, byte)).count() + 1
    }

    /// An error about the word at an offset: its line and column, and the line with a mark.
    pub fn error(&self, path: &Path, at: usize, reason: impl Into<String>) -> Error {
        let at = at.min(self.text.len());
        let begin = self.text[..at].iter().rposition(|&byte| is_line_end(byte)).map_or(0, |end| end + 1);
        let rest = &self.text[at..];
        let line = &self.text[begin..at + rest.iter().position(|&byte| is_line_end(byte)).unwrap_or(rest.len())];
        let [column, width] =
            [&self.text[begin..at], &rest[..rest.iter().position(|&b| is_space(b)).unwrap_or(rest.len())]]
                .map(|bytes| String::from_utf8_lossy(bytes).chars().count());
        let number = self.line_number(at);
        let excerpt = excerpt(number, &String::from_utf8_lossy(line), column, width);
        Error { excerpt: Some(excerpt), ..Error::at(path, format!("line {number}, column {}", column + 1), reason) }
    }

    /// Where the text ends, as a place for a message: the line of its last word.
    pub fn last_line(&self) -> String {
        self.line(self.text.trim_ascii_end().len())
    }
}

impl<'a> Iterator for Tokens<'a> {
    type Item = Token<'a>;

    /// The next word, on this line or a later one.
    fn next(&mut self) -> Option<Token<'a>> {
        self.skip_while(is_space);
        self.word()
    }
}

/// Whether numbers of a text were written from `f32`, as their digits tell.
///
/// They were if each of them is what some `f32` looks like with as many digits as it has, and one of them could not be told from a
/// number of `f64` by its shortness: it has 8 digits or more, or 13 if it is an `f32` exactly, as 450000.25 may be by chance. Of `f64`
/// with 9 digits or more hardly any pass; with fewer, half a unit in the last place of `f32` is less than the digits leave open.
#[derive(Debug, Clone, Copy, Default)]
pub struct SingleDigits {
    /// A number that no `f32` looks like.
    denied: bool,
    /// A number of many digits that one does.
    shown: bool,
}

impl SingleDigits {
    /// Takes a number into account, as it stands in the text and as it was read.
    pub fn see(&mut self, text: &[u8], value: f64) {
        if self.denied {
            return;
        }
        let single = f64::from(value as f32);
        let (count, last) = digits(text);
        let exact = single == value;
        // A little more than half of the last digit, for the rounding of this very test.
        self.denied = !exact && !((single - value).abs() <= 0.500_001 * 10_f64.powi(last));
        self.shown |= count >= if exact { 13 } else { 8 };
    }

    /// Whether all numbers so far are those of `f32`.
    pub fn are_single(self) -> bool {
        self.shown && !self.denied
    }
}

/// Of a number in a text: how many digits it has, zeros before the first and after the last other digit aside, and the power of ten of
/// the last one written.
fn digits(text: &[u8]) -> (usize, i32) {
    let end = text.iter().position(|byte| matches!(byte, b'e' | b'E')).unwrap_or(text.len());
    let (mantissa, exponent) = (&text[..end], text.get(end + 1..).unwrap_or(&[]));
    let exponent = std::str::from_utf8(exponent).ok().and_then(|e| e.parse::<i32>().ok()).unwrap_or(0);
    let decimals = mantissa.iter().position(|&byte| byte == b'.').map_or(0, |point| mantissa.len() - point - 1);
    let written = mantissa.iter().filter(|byte| byte.is_ascii_digit());
    let leading = written.clone().take_while(|&&byte| byte == b'0').count();
    let trailing = written.clone().rev().take_while(|&&byte| byte == b'0').count();
    let last = exponent.saturating_sub(i32::try_from(decimals).unwrap_or(i32::MAX));
    (written.count().saturating_sub(leading + trailing), last)
}

/// How often something was met, and where first: a million oddities make one warning.
#[derive(Debug, Clone, Copy, Default)]
pub struct OddityCount {
    count: usize,
    first: usize,
}

impl OddityCount {
    /// Met at this offset.
    pub fn add(&mut self, at: usize) {
        if self.count == 0 {
            self.first = at;
        }
        self.count += 1;
    }

    /// The warning, if there is anything to warn of: `12 × facet without normal (first: line 2)`.
    pub fn sentence(&self, what: &str, tokens: &Tokens) -> Option<String> {
        (self.count > 0).then(|| format!("{} × {what} (first: {})", self.count, tokens.line(self.first)))
    }
}

/// A piece of the file for a message: short, on one line, in backquotes.
pub fn quote(bytes: &[u8]) -> String {
    const SHOWN: usize = 40;
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(4 * SHOWN)]);
    let more = if text.chars().nth(SHOWN).is_some() { "…" } else { "" };
    let visible = |c: char| if c.is_control() { c.escape_debug().to_string() } else { c.to_string() };
    let shown: String = text.chars().take(SHOWN).map(visible).collect();
    format!("`{shown}{more}`")
}

/// The text after a UTF-8 byte-order mark, if there is one.
pub fn without_bom(text: &[u8]) -> &[u8] {
    text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text)
}

fn is_space(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t'..=b'\r')
}

/// White space within a line.
fn is_blank(byte: u8) -> bool {
    is_space(byte) && !is_line_end(byte)
}

fn is_line_end(byte: u8) -> bool {
    matches!(byte, b'\n' | b'\r')
}
