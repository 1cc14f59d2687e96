//! Triangles of STL and OBJ files.
//!
//! What a file is follows from its content; the extension only breaks ties. A file is either read whole, with a warning for
//! everything that was passed over, or refused with the place and the reason. Nothing here judges the geometry: holes,
//! orientation and overlaps are a later stage's business. Memory grows with the bytes present, never with a count they claim.

mod kind;
mod obj;
mod polygon;
mod stl;
mod text;

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::mesh::Mesh;
use crate::error::{Error, Result};
use kind::FileKind;
pub use kind::is_scene;

/// Bytes looked at before a file is read whole, so that a huge file of the wrong kind costs nothing.
const HEAD: u64 = 64 * 1024;

/// Reads an STL (binary or ASCII) or OBJ file; decides by content first, extension second.
pub fn read(path: &Path) -> Result<Mesh> {
    let (mut file, len) = open(path)?;
    let mut bytes = Vec::new();
    append(path, &mut file, HEAD.min(len), &mut bytes)?;
    let kind = kind::of(path, &bytes, len)?;
    let wanted = match kind {
        FileKind::BinaryStl => stl::binary::extent(path, &bytes, len)?,
        FileKind::AsciiStl | FileKind::Obj => len,
    };
    append(path, &mut file, wanted.saturating_sub(bytes.len() as u64), &mut bytes)?;
    parse(path, kind, bytes, len)
}

/// Reads `bytes` as the content of a file; `path` gives the extension and names the file in messages.
pub fn from_bytes(path: &Path, bytes: Vec<u8>) -> Result<Mesh> {
    let len = bytes.len() as u64;
    let kind = kind::of(path, &bytes[..bytes.len().min(HEAD as usize)], len)?;
    parse(path, kind, bytes, len)
}

fn parse(path: &Path, kind: FileKind, bytes: Vec<u8>, len: u64) -> Result<Mesh> {
    match kind {
        FileKind::BinaryStl => stl::binary::read(path, bytes, len),
        FileKind::AsciiStl => stl::ascii::read(path, text::without_bom(&bytes)),
        FileKind::Obj => obj::read(path, text::without_bom(&bytes)),
    }
}

/// Opens a regular file and tells its length. Looks before it opens: opening a pipe waits for a writer, for ever if none comes.
fn open(path: &Path) -> Result<(File, u64)> {
    let about = match std::fs::metadata(path) {
        Ok(about) => about,
        Err(_) if path.is_symlink() => return Err(Error::file(path, "a symbolic link that leads to no readable file")),
        Err(cause) => return Err(Error::io(path, "open", &cause)),
    };
    if about.is_dir() {
        return Err(Error::file(path, "is a directory, not a file"));
    }
    if !about.is_file() {
        return Err(Error::file(path, "is not a regular file but a device, pipe or socket, which are not read"));
    }
    let file = File::open(path).map_err(|cause| Error::io(path, "open", &cause))?;
    Ok((file, about.len()))
}

/// Appends up to `count` bytes of the file. Memory that is not there is an error, not an abort.
fn append(path: &Path, file: &mut File, count: u64, bytes: &mut Vec<u8>) -> Result<()> {
    let enough = usize::try_from(count).is_ok_and(|count| bytes.try_reserve_exact(count).is_ok());
    if !enough {
        return Err(Error::file(path, format!("too large: {count} bytes do not fit into memory")));
    }
    file.take(count).read_to_end(bytes).map_err(|cause| Error::io(path, "read", &cause))?;
    Ok(())
}
