//! Binary STL.

use super::{binary, is_box, is_refused, names, stl};
use glam::DVec3;

#[test]
fn binary_headers_are_free_text() {
    for header in [
        &b""[..],
        b"solid",
        b"solid facet normal 0 0 1\n outer loop",
        &[0; 80],
        "Träger".as_bytes(),
        b"\x1f\x8b",
        b"v 1 2 3",
    ] {
        let mesh = is_box(stl(binary(header, 12, b"")), 0);
        assert_eq!(mesh.triangles[0][1], DVec3::new(f64::from(2.3_f32), f64::from(1.2_f32), f64::from(0.1_f32)));
        assert_eq!(names(&mesh), [""]);
    }
}

#[test]
fn stored_normals_and_attributes_are_ignored() {
    let mut bytes = binary(b"", 12, b"");
    for record in bytes[84..].chunks_mut(50) {
        record[..12].copy_from_slice(&[0xff; 12]);
        record[48..].copy_from_slice(&[0xff; 2]);
    }
    is_box(stl(bytes), 0);
}

#[test]
fn binary_counts_are_checked() {
    is_refused(stl(binary(b"", 13, b"")), &["13", "12", "truncated"]);
    is_refused(stl(binary(b"solid", 13, b"")), &["13", "12"]);
    is_refused(stl(&binary(b"", 12, b"")[..657]), &["12", "truncated", "11"]);
    is_refused(stl(binary(b"", 11, b"")), &["11", "12"]);
    is_refused(stl(binary(b"", 0, b"")), &["no triangles", "600"]);
    is_refused(stl(&binary(b"", 0, b"")[..84]), &["no triangles"]);
    is_refused(stl(binary(b"", u32::MAX, b"")), &["4294967295"]);
    is_refused(stl(&binary(b"", u32::MAX, b"")[..84]), &["4294967295"]);
    is_refused(stl(&binary(b"solid", u32::MAX, b"")[..84]), &["4294967295"]);
    is_refused(stl(binary(b"", 0x0555_5556, b"")), &["89478486"]);
    is_refused(stl(binary(b"", 12u32.swap_bytes(), b"")), &["big-endian"]);
    for length in [1, 40, 80, 83] {
        is_refused(stl(&binary(b"", 12, b"")[..length]), &[]);
    }
    is_refused(stl(&binary(b"made by hand", 12, b"")[..80]), &["truncated", "84"]);
    is_refused(stl(&binary(b"\0\0\0", 12, b"")[..40]), &["truncated", "84"]);
}

#[test]
fn bytes_behind_the_last_triangle() {
    let mesh = is_box(stl(binary(b"", 12, &[7; 37])), 1);
    assert_eq!(mesh.warnings[0], "case.stl: 37 bytes follow the last of 12 triangles; ignored");
    is_box(stl(binary(b"", 12, b"\n")), 1);
    is_box(stl(binary(b"solid", 12, b"some notes")), 1);
    is_box(stl(binary(b"", 12, &[0; 500])), 1);
    is_box(stl(binary(b"", 12, &[7; 1024])), 1);
}

#[test]
fn binary_values_must_be_finite() {
    for (value, name) in [(f32::NAN, "NaN"), (f32::INFINITY, "inf"), (f32::NEG_INFINITY, "-inf")] {
        let mut bytes = binary(b"", 12, b"");
        bytes[84 + 3 * 50 + 28..][..4].copy_from_slice(&value.to_le_bytes());
        is_refused(stl(bytes), &["triangle 3", "not finite", name]);
    }
    let mut bytes = binary(b"", 12, b"");
    bytes[84 + 12..][..4].copy_from_slice(&1e-40_f32.to_le_bytes());
    assert_eq!(stl(bytes).unwrap().triangles[0][0].x, f64::from(1e-40_f32));
}
