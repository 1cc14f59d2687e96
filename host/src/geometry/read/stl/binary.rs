//! Binary STL: 80 bytes of header, a count, and 50 bytes for each triangle, all little-endian.
//!
//! `stl_io` reads the triangles. This layer stands in front of it for what it leaves to chance: the count against the size of the
//! file, headers that begin with `solid`, values that are not finite.

use std::io::Cursor;
use std::path::Path;

use glam::{DVec3, Vec3};

use crate::error::{Error, Result};
use crate::geometry::mesh::{Mesh, Solid};
use crate::words::counted;

/// Bytes of the header, free text.
const HEADER: usize = 80;
/// Offset of the first triangle.
pub const DATA: usize = 84;
/// Bytes of a triangle: normal, three corners, attribute.
const RECORD: usize = 50;

/// Count of triangles that the file claims, if it is long enough to claim any.
pub fn count(head: &[u8]) -> Option<u32> {
    let bytes = head.get(HEADER..DATA)?;
    Some(u32::from_le_bytes(bytes.try_into().ok()?))
}

/// Bytes of a file with so many triangles.
pub fn size(count: u32) -> u64 {
    DATA as u64 + RECORD as u64 * u64::from(count)
}

/// How many bytes of a file of `len` bytes to read: its triangles, and one record more to judge what follows them.
/// The error tells a file that does not hold what its count claims.
pub fn extent(path: &Path, head: &[u8], len: u64) -> Result<u64> {
    let Some(count) = count(head) else {
        return Err(Error::file(path, format!("truncated: {len} bytes, a binary STL has at least 84")));
    };
    if count == 0 {
        let rest =
            if len > DATA as u64 { format!(", though {} bytes follow", len - DATA as u64) } else { String::new() };
        return Err(Error::file(path, format!("no triangles: the binary STL's count is 0{rest}")));
    }
    if size(count) > len {
        return Err(too_short(path, count, len));
    }
    Ok(len.min(size(count) + RECORD as u64))
}

fn too_short(path: &Path, count: u32, len: u64) -> Error {
    if size(count.swap_bytes()) == len {
        return Error::file(
            path,
            format!("is big-endian (count {count} read as little-endian); export it little-endian"),
        );
    }
    let held = (len - DATA as u64) / RECORD as u64;
    let reason = format!(
        "truncated, or not an STL: its count says {count} triangles, which take {} bytes, but the file has {len}, enough for {held}",
        size(count)
    );
    Error::file(path, reason)
}

/// Reads the triangles. `bytes` begins as the file does and holds its [`extent`]; `len` is the length of the file.
pub fn read(path: &Path, mut bytes: Vec<u8>, len: u64) -> Result<Mesh> {
    let end = extent(path, &bytes, len)?;
    let mut mesh = Mesh::of_file(path);
    if let Some(count) = count(&bytes).filter(|&count| size(count) < len) {
        let follows = bytes.get(size(count) as usize..end as usize).unwrap_or(&[]);
        check_rest(path, &mut mesh, count, follows, len)?;
    }
    // Blank lines for a header: stl_io would take one that begins with `solid` for ASCII, and look for its end far into the file.
    bytes.iter_mut().take(HEADER).for_each(|byte| *byte = b'\n');
    mesh.triangles = triangles(path, bytes)?;
    mesh.single_precision = true;
    mesh.solids.push(Solid { name: String::new(), triangles: 0..mesh.triangles.len() });
    Ok(mesh)
}

/// Bytes beyond the last triangle: exporters append notes and padding, so that is a warning.
/// Whole records, unless they are padding, mean that the count is wrong and triangles would be lost.
fn check_rest(path: &Path, mesh: &mut Mesh, count: u32, follows: &[u8], len: u64) -> Result<()> {
    let rest = len - size(count);
    let is_padding = follows.iter().all(|byte| Some(byte) == follows.first());
    if rest.is_multiple_of(RECORD as u64) && !is_padding {
        let held = u64::from(count) + rest / RECORD as u64;
        return Err(Error::file(path, format!("its count of triangles is {count}, but the file holds {held}")));
    }
    let triangles = counted(count as usize, "triangle", "triangles");
    let bytes = if rest == 1 { "byte follows" } else { "bytes follow" };
    mesh.warn(format_args!("{rest} {bytes} the last of {triangles}; ignored"));
    Ok(())
}

fn triangles(path: &Path, bytes: Vec<u8>) -> Result<Vec<[DVec3; 3]>> {
    // The size was checked, so this reserves less than twice what has been read.
    let mut triangles = Vec::with_capacity(bytes.len().saturating_sub(DATA) / RECORD);
    let mut cursor = Cursor::new(bytes);
    let records = stl_io::create_stl_reader(&mut cursor).map_err(|cause| Error::io(path, "read", &cause))?;
    for (i, record) in records.enumerate() {
        let record = record.map_err(|cause| Error::at(path, place(i), format!("cannot read: {cause}")))?;
        let corners = record.vertices.map(|vertex| Vec3::from_array(vertex.0));
        if !corners.iter().all(|corner| corner.is_finite()) {
            return Err(not_finite(path, i, corners));
        }
        triangles.push(corners.map(|corner| corner.as_dvec3()));
    }
    Ok(triangles)
}

fn place(triangle: usize) -> String {
    format!("triangle {triangle} (counted from 0)")
}

fn not_finite(path: &Path, triangle: usize, corners: [Vec3; 3]) -> Error {
    let bad = corners.iter().find(|corner| !corner.is_finite()).unwrap_or(&corners[0]);
    Error::at(path, place(triangle), format!("vertex ({}, {}, {}) is not finite", bad.x, bad.y, bad.z))
}
