//! What a file is, by its first bytes and its length.
//!
//! A binary STL is recognised by its size, 84 + 50 n bytes for the count n at byte 80, before anything else: its 80-byte header
//! is free text and often begins with `solid`. Then come formats that are refused by name, then the words of a text.

use std::path::Path;

use super::stl::binary;
use super::text::{self, Token, Tokens};
use crate::error::{Error, Result};

/// The formats that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum FileKind {
    BinaryStl,
    AsciiStl,
    Obj,
}

/// Beginnings of formats that turn up under the name of an STL, and what to tell the user.
const REFUSED: &[(&[u8], &str)] = &[
    (b"\x1f\x8b", "gzip-compressed; unpack it first (gunzip)"),
    (b"PK\x03\x04", "a zip archive (3MF files are, too); unpack it or export STL"),
    (b"PK\x05\x06", "an empty zip archive"),
    (b"BZh", "bzip2-compressed; unpack it first"),
    (b"\xfd7zXZ\0", "xz-compressed; unpack it first"),
    (b"\x28\xb5\x2f\xfd", "zstd-compressed; unpack it first"),
    (b"7z\xbc\xaf\x27\x1c", "a 7z archive; unpack it first"),
    (b"\x89PNG", "a PNG picture"),
    (b"\xff\xd8\xff", "a JPEG picture"),
    (b"GIF8", "a GIF picture"),
    (b"%PDF", "a PDF document"),
    (b"\x7fELF", "a program"),
    (b"glTF", "a binary glTF model; export STL or OBJ"),
    (b"ply\n", "a PLY model; export STL or OBJ"),
    (b"ply\r", "a PLY model; export STL or OBJ"),
    (b"ISO-10303-21", "a STEP model; export STL or OBJ"),
    (b"# vtk DataFile", "a VTK file; export STL or OBJ"),
    (b"AutoCAD Binary DXF", "a DXF drawing; export STL or OBJ"),
    (b"OFF\n", "an OFF model; export STL or OBJ"),
    (b"OFF\r", "an OFF model; export STL or OBJ"),
    (b"OFF ", "an OFF model; export STL or OBJ"),
    (b"COFF", "an OFF model; export STL or OBJ"),
    (b"NOFF", "an OFF model; export STL or OBJ"),
    (b"version https://git-lfs", "a Git LFS pointer, not the file itself; fetch it with `git lfs pull`"),
    (b"\xff\xfe\0\0", "UTF-32 text; save it as UTF-8"),
    (b"\xff\xfe", "UTF-16 text; save it as UTF-8"),
    (b"\xfe\xff", "UTF-16 text; save it as UTF-8"),
];

/// The kind of a file from its first bytes (all of them, if it is short) and its length; an error says what it is instead.
pub fn of(path: &Path, head: &[u8], len: u64) -> Result<FileKind> {
    if head.is_empty() {
        return Err(Error::file(path, "is empty (0 bytes)"));
    }
    if binary::count(head).is_some_and(|count| binary::size(count) == len) {
        return Ok(FileKind::BinaryStl);
    }
    if let Some(what) = refused(head) {
        return Err(Error::file(path, format!("is {what}")));
    }
    let Some(word) = first_word(text::without_bom(head)) else {
        return by_extension(path, head, len);
    };
    if word.is("solid") || word.is("facet") {
        return Ok(if looks_binary(head) { FileKind::BinaryStl } else { FileKind::AsciiStl });
    }
    if has_vertex(text::without_bom(head)) && !has_many_controls(body(head)) {
        return Ok(FileKind::Obj);
    }
    by_extension(path, head, len)
}

/// The format whose mark the file bears, if it is one that is not read.
fn refused(head: &[u8]) -> Option<&'static str> {
    if let Some((_, what)) = REFUSED.iter().find(|(mark, _)| head.starts_with(mark)) {
        return Some(what);
    }
    if is_utf16_without_bom(head) {
        return Some("UTF-16 text; save it as UTF-8");
    }
    let text = text::without_bom(head).trim_ascii_start();
    if is_dxf(text) {
        return Some("a DXF drawing; export STL or OBJ");
    }
    if is_iges(head) {
        return Some("an IGES model; export STL or OBJ");
    }
    if text.starts_with(b"{") {
        let gltf = contains(text, b"\"asset\"") || contains(text, b"\"meshes\"");
        return Some(if gltf { "a glTF model; export STL or OBJ" } else { "JSON, not STL or OBJ" });
    }
    if text.starts_with(b"<") && contains(text, b"<VTKFile") {
        return Some("a VTK file; export STL or OBJ");
    }
    if text.starts_with(b"<") {
        let html = [&b"<html"[..], b"<!doctype html", b"<head", b"<body"].iter().any(|mark| contains(text, mark));
        return Some(if html { "an HTML page, perhaps the error page of a download" } else { "XML, not STL or OBJ" });
    }
    None
}

/// A DXF begins with group code 0 or 999 and what it groups, a line each.
fn is_dxf(text: &[u8]) -> bool {
    let mut lines = text.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
    match lines.next() {
        Some(b"0") => lines.next().is_some_and(|line| line == b"SECTION"),
        Some(b"999") => lines.nth(1).is_some_and(|line| line == b"0"),
        _ => false,
    }
}

/// An IGES file has lines of 80 characters, of which the 73rd tells the section and the rest count: `S      1` in the first.
fn is_iges(head: &[u8]) -> bool {
    head.get(72..80).is_some_and(|end| end[0] == b'S' && end[1..].trim_ascii() == b"1")
        || head.get(72..80).is_some_and(|end| end == b"S0000001")
}

fn is_utf16_without_bom(head: &[u8]) -> bool {
    let Some(start) = head.get(..8) else { return false };
    let zeros = |odd: usize| start.iter().enumerate().all(|(i, &byte)| (byte == 0) == (i % 2 == odd));
    zeros(1) || zeros(0)
}

/// The first word that is not in a comment.
fn first_word(head: &[u8]) -> Option<Token<'_>> {
    let mut tokens = Tokens::new(head);
    loop {
        let token = tokens.next()?;
        if !token.is_comment() {
            return Some(token);
        }
        tokens.skip_line_from(token.at);
    }
}

/// Whether a line begins as a vertex of an OBJ does: `v`, a number.
fn has_vertex(head: &[u8]) -> bool {
    head.split(|byte| matches!(byte, b'\n' | b'\r')).any(|line| {
        let mut words = Tokens::new(line);
        words.next().is_some_and(|word| word.is("v")) && words.next().is_some_and(|word| word.number().is_ok())
    })
}

/// Whether a text has a line that begins as the solids of a scene do: `[[solid]]`, or `solid = [`.
#[must_use]
pub fn is_scene(text: &[u8]) -> bool {
    let begins = |line: &[u8]| {
        let mut dense = line.iter().filter(|byte| !byte.is_ascii_whitespace());
        let mut start = [0; 7];
        start.iter_mut().zip(&mut dense).for_each(|(place, byte)| *place = *byte);
        [&b"[[solid"[..], b"solid=["].contains(&&start[..])
    };
    let text = text::without_bom(text);
    !has_many_controls(body(text)) && text.split(|byte| matches!(byte, b'\n' | b'\r')).any(begins)
}

/// Last resort for what bears no mark: its extension, or the message that helps most.
fn by_extension(path: &Path, head: &[u8], len: u64) -> Result<FileKind> {
    let text = text::without_bom(head);
    if text.trim_ascii().is_empty() {
        return Err(Error::file(path, format!("is empty: nothing but white space in {} bytes", head.len())));
    }
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("obj")) && !looks_binary(head) {
        return Ok(FileKind::Obj);
    }
    if is_scene(text) {
        return Err(Error::file(path, "is a scene: the name of a scene file ends in .toml"));
    }
    if len < binary::DATA as u64 {
        let reason = format!("is neither ASCII STL nor OBJ, and truncated as a binary STL: {len} of at least 84 bytes");
        return Err(Error::file(path, reason));
    }
    if looks_binary(head) {
        return Ok(FileKind::BinaryStl);
    }
    let start = text::quote(text.trim_ascii_start().split(|byte| matches!(byte, b'\n' | b'\r')).next().unwrap_or(text));
    Err(Error::file(
        path,
        format!("is neither STL nor OBJ but a text that begins with {start}; ASCII STL begins with `solid`"),
    ))
}

/// Count and first triangles, if the file is a binary STL; all, if it is too short for that.
fn body(head: &[u8]) -> &[u8] {
    let window = head.get(80..).filter(|rest| !rest.is_empty()).unwrap_or(head);
    &window[..window.len().min(1000)]
}

/// Whether a file of the wrong size is still a binary STL rather than a text.
/// Foreign letters in names are no sign of that as long as there are facets.
fn looks_binary(head: &[u8]) -> bool {
    let body = body(head);
    let foreign = std::str::from_utf8(body).is_err_and(|error| error.error_len().is_some());
    has_many_controls(body) || (foreign && !contains(head, b"facet"))
}

/// Whether more than one byte in 64 is a control character that no text has. Of 50 bytes per binary triangle at least the two of
/// the attribute are, unless coloured, and most zeros of normals; a stray NUL in a text is not enough.
fn has_many_controls(bytes: &[u8]) -> bool {
    let controls = bytes.iter().filter(|byte| matches!(byte, 0..=8 | 14..=26 | 28..=31)).count();
    controls * 64 > bytes.len()
}

fn contains(text: &[u8], word: &[u8]) -> bool {
    text.windows(word.len()).any(|window| window.eq_ignore_ascii_case(word))
}
