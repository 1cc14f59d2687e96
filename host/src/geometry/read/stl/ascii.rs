//! ASCII STL: solids of facets, as words.
//!
//! ```text
//! solid NAME
//!   facet normal NX NY NZ
//!     outer loop
//!       vertex X Y Z        (three times)
//!     endloop
//!   endfacet                (any number of facets)
//! endsolid NAME             (any number of solids)
//! ```
//!
//! Some exporters write `color R G B` after the name or before a facet, and `end loop`, `end facet`, `end solid` in two words.
//!
//! Coordinates are read as `f64`: the text has the digits, and rounding them to `f32` would move surfaces. Whether they were written from
//! `f32`, the digits tell too ([`SingleDigits`]). Our own reader, because
//! `stl_io` rounds, stops after the first solid and drops the names. Keywords in any case; line ends only end names and comments.

use std::path::Path;

use glam::DVec3;

use crate::error::{Error, Result};
use crate::geometry::mesh::{Mesh, Solid};
use crate::geometry::read::text::{OddityCount, SingleDigits, Token, Tokens, quote};
use crate::words::{counted, either};

/// Reads all solids of a text.
pub fn read(path: &Path, text: &[u8]) -> Result<Mesh> {
    let (mesh, digits, oddities) = (Mesh::of_file(path), SingleDigits::default(), Oddities::default());
    let mut reader = Reader { path, tokens: Tokens::new(text), mesh, digits, oddities };
    while let Some(token) = reader.keyword() {
        if token.is("solid") {
            reader.solid()?;
        } else if token.is("facet") {
            reader.oddities.homeless.add(token.at);
            reader.tokens.go_to(token.at);
            reader.facets(String::new())?;
        } else {
            reader.rest(token)?;
            break;
        }
    }
    reader.finish()
}

struct Reader<'a> {
    path: &'a Path,
    tokens: Tokens<'a>,
    mesh: Mesh,
    digits: SingleDigits,
    oddities: Oddities,
}

/// What is read in spite of the format, and warned of.
#[derive(Default)]
struct Oddities {
    comments: OddityCount,
    empty: OddityCount,
    endless: OddityCount,
    homeless: OddityCount,
    normals: OddityCount,
}

impl<'a> Reader<'a> {
    /// The next word that is not in a comment.
    fn keyword(&mut self) -> Option<Token<'a>> {
        loop {
            let token = self.tokens.next()?;
            if !token.is_comment() {
                return Some(token);
            }
            self.oddities.comments.add(token.at);
            self.tokens.skip_line_from(token.at);
        }
    }

    /// A solid from its name on.
    fn solid(&mut self) -> Result<()> {
        let start = self.tokens.at();
        let end = self.facet_in_line().unwrap_or_else(|| self.tokens.line_end());
        self.tokens.go_to(end);
        let name = self.tokens.trimmed(start, end);
        self.facets(without_colour(&name).to_owned())
    }

    /// Facets up to the end of their solid.
    fn facets(&mut self, name: String) -> Result<()> {
        let start = self.tokens.at();
        let first = self.mesh.triangles.len();
        loop {
            let is_empty = self.mesh.triangles.len() == first;
            match self.keyword() {
                Some(token) if token.is("facet") => self.facet(token)?,
                Some(token) if token.is("color") => self.skip_colour()?,
                Some(token) if self.is_end(token, "solid") => {
                    self.skip_end_name();
                    break;
                }
                // A solid that begins where the last was not ended. Not twice in a row: that is prose.
                Some(token) if token.is("solid") && !is_empty => {
                    self.oddities.endless.add(token.at);
                    self.tokens.go_to(token.at);
                    break;
                }
                Some(token) => return Err(self.unexpected("`facet` or `endsolid`", Some(token))),
                None => {
                    self.oddities.endless.add(start);
                    break;
                }
            }
        }
        if self.mesh.triangles.len() == first {
            self.oddities.empty.add(start);
        }
        self.mesh.solids.push(Solid { name, triangles: first..self.mesh.triangles.len() });
        Ok(())
    }

    /// A facet after its keyword.
    fn facet(&mut self, facet: Token) -> Result<()> {
        if !self.skip_normal()? {
            self.oddities.normals.add(facet.at);
        }
        self.expect("loop")?;
        let corners = [self.vertex()?, self.vertex()?, self.vertex()?];
        self.expect_end("loop")?;
        self.expect_end("facet")?;
        self.mesh.triangles.push(corners);
        Ok(())
    }

    /// Passes over the normal and `outer`; false if the normal is missing or incomplete.
    /// Its numbers are not read, for tools write `nan` and `-1.#IND` there.
    fn skip_normal(&mut self) -> Result<bool> {
        let mut token = self.keyword();
        if token.is_some_and(|token| token.is("outer")) {
            return Ok(false);
        }
        if !token.is_some_and(|token| token.is("normal")) {
            return Err(self.unexpected("`normal`", token));
        }
        for components in 0..=3 {
            token = self.keyword();
            if token.is_some_and(|token| token.is("outer")) {
                return Ok(components == 3);
            }
        }
        Err(self.unexpected("`outer`", token))
    }

    fn vertex(&mut self) -> Result<DVec3> {
        self.expect("vertex")?;
        Ok(DVec3::new(self.number()?, self.number()?, self.number()?))
    }

    fn number(&mut self) -> Result<f64> {
        let (token, value) = self.number_at()?;
        self.digits.see(token.bytes, value);
        Ok(value)
    }

    fn number_at(&mut self) -> Result<(Token<'a>, f64)> {
        let Some(token) = self.tokens.next() else { return Err(self.unexpected("a number", None)) };
        token.number().map(|value| (token, value)).map_err(|reason| self.error(token.at, reason))
    }

    fn expect(&mut self, keyword: &str) -> Result<()> {
        match self.keyword() {
            Some(token) if token.is(keyword) => Ok(()),
            token => Err(self.unexpected(&format!("`{keyword}`"), token)),
        }
    }

    fn expect_end(&mut self, what: &str) -> Result<()> {
        match self.keyword() {
            Some(token) if self.is_end(token, what) => Ok(()),
            token => Err(self.unexpected(&format!("`end{what}`"), token)),
        }
    }

    /// Whether something ends with this word, or with `end` and the next, which is passed over then.
    fn is_end(&mut self, token: Token, what: &str) -> bool {
        if token.bytes.len() == 3 && token.is("end") {
            let mut ahead = self.tokens.clone();
            let found = ahead.next().is_some_and(|word| word.is(what));
            if found {
                self.tokens = ahead;
            }
            return found;
        }
        token
            .bytes
            .split_at_checked(3)
            .is_some_and(|(end, rest)| end.eq_ignore_ascii_case(b"end") && rest.eq_ignore_ascii_case(what.as_bytes()))
    }

    /// The three shares of red, green and blue, which say nothing about the surface.
    fn skip_colour(&mut self) -> Result<()> {
        (0..3).try_for_each(|_| self.number_at().map(drop))
    }

    /// Passes over the name after `endsolid`, which ends with its line, or before the next solid when all is on one line.
    fn skip_end_name(&mut self) {
        let Some(facet) = self.facet_in_line() else { return self.tokens.go_to(self.tokens.line_end()) };
        let mut ahead = self.tokens.clone();
        let next = ahead.find(|token| token.at >= facet || token.is("solid"));
        self.tokens.go_to(next.map_or(facet, |token| token.at));
    }

    /// Offset of the first facet that begins in the rest of this line.
    fn facet_in_line(&self) -> Option<usize> {
        let mut ahead = self.tokens.clone();
        while let Some(token) = ahead.next_to_line_end() {
            if opens_facet(token, ahead.clone()) {
                return Some(token.at);
            }
        }
        None
    }

    /// What follows the last solid: ignored with a warning, unless there are facets in it that would be lost.
    fn rest(&mut self, token: Token) -> Result<()> {
        let mut ahead = self.tokens.clone();
        if std::iter::from_fn(|| ahead.next().map(|token| opens_facet(token, ahead.clone()))).any(|opens| opens) {
            return Err(self.unexpected("`solid`", Some(token)));
        }
        let (bytes, line) = (self.tokens.len() - token.at, self.tokens.line(token.at));
        self.mesh.warn(format_args!(
            "{} after the last `endsolid`, from {line} on, {} not STL; ignored",
            counted(bytes, "byte", "bytes"),
            either(bytes, "is", "are")
        ));
        Ok(())
    }

    fn finish(mut self) -> Result<Mesh> {
        if self.mesh.triangles.is_empty() {
            let hint = if self.tokens.len() < 84 { "; a binary STL would have at least 84 bytes" } else { "" };
            let reason = format!("no triangles: the text ends without a `facet`{hint}");
            return Err(Error::at(self.path, self.tokens.last_line(), reason));
        }
        let Oddities { comments, empty, endless, homeless, normals } = self.oddities;
        let sentences = [
            (comments, "comment, which STL does not have; ignored"),
            (empty, "solid without triangles"),
            (endless, "solid without `endsolid`; the file may be cut short"),
            (homeless, "facet outside of a solid; read as a solid without name"),
            (normals, "facet without a complete normal; the winding decides"),
        ];
        for (tally, what) in sentences {
            if let Some(sentence) = tally.sentence(what, &self.tokens) {
                self.mesh.warn(sentence);
            }
        }
        self.mesh.single_precision = self.digits.are_single();
        Ok(self.mesh)
    }

    fn unexpected(&self, expected: &str, found: Option<Token>) -> Error {
        match found {
            Some(token) => {
                let is_last = token.at + token.bytes.len() == self.tokens.len();
                let end = if is_last { "; the text ends here, perhaps truncated" } else { "" };
                self.error(token.at, format!("expected {expected}, found {}{end}", quote(token.bytes)))
            }
            None => {
                let reason = format!("truncated: the text ends where {expected} was expected");
                Error::at(self.path, self.tokens.last_line(), reason)
            }
        }
    }

    fn error(&self, at: usize, reason: String) -> Error {
        self.tokens.error(self.path, at, reason)
    }
}

/// A name without `color R G B` at its end.
fn without_colour(name: &str) -> &str {
    let mut rest = name;
    for _ in 0..3 {
        let Some((before, word)) = rest.rsplit_once(char::is_whitespace) else { return name };
        if word.parse::<f64>().is_err() {
            return name;
        }
        rest = before.trim_end();
    }
    let (before, word) = rest.rsplit_once(char::is_whitespace).unwrap_or(("", rest));
    if word.eq_ignore_ascii_case("color") { before.trim_end() } else { name }
}

/// Whether a facet begins with this word and those ahead: `facet [normal NX NY NZ] outer loop`. A name may hold the first, even
/// the second; so many words hardly.
fn opens_facet(token: Token, mut ahead: Tokens) -> bool {
    if !token.is("facet") {
        return false;
    }
    let mut word = ahead.next();
    if word.is_some_and(|word| word.is("normal")) {
        word = ahead.nth(3);
    }
    word.is_some_and(|word| word.is("outer")) && ahead.next().is_some_and(|word| word.is("loop"))
}
