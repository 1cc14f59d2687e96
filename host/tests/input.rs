//! Reading STL and OBJ files: what is accepted, warned of and refused, and that nothing panics.

use std::path::{Path, PathBuf};

use glam::DVec3;
use proptest::prelude::*;
use proptest::sample::Index;
use voidage::error::Result;
use voidage::input::{Mesh, from_bytes, read};

/// Corners of the box that the fixtures hold: 2 × 1 × 1, volume 2.
const CORNERS: [[&str; 3]; 8] = [
    ["0.3", "0.2", "0.1"],
    ["2.3", "0.2", "0.1"],
    ["2.3", "1.2", "0.1"],
    ["0.3", "1.2", "0.1"],
    ["0.3", "0.2", "1.1"],
    ["2.3", "0.2", "1.1"],
    ["2.3", "1.2", "1.1"],
    ["0.3", "1.2", "1.1"],
];
/// Its sides, seen from outside.
const SIDES: [[usize; 4]; 6] = [[3, 2, 1, 0], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

fn triangles() -> Vec<[[&'static str; 3]; 3]> {
    SIDES.iter().flat_map(|s| [[s[0], s[1], s[2]], [s[0], s[2], s[3]]]).map(|t| t.map(|i| CORNERS[i])).collect()
}

fn facets() -> String {
    let vertex = |v: [&str; 3]| format!("      vertex {} {} {}\n", v[0], v[1], v[2]);
    let facet = |t: [[&str; 3]; 3]| {
        let vertices: String = t.into_iter().map(vertex).collect();
        format!("  facet normal 0 0 1\n    outer loop\n{vertices}    endloop\n  endfacet\n")
    };
    triangles().into_iter().map(facet).collect()
}

fn ascii() -> String {
    format!("solid cube\n{}endsolid cube\n", facets())
}

/// Binary STL of the box with this header, count and tail.
fn binary(header: &[u8], count: u32, tail: &[u8]) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, b' ');
    bytes.extend(count.to_le_bytes());
    for triangle in triangles() {
        bytes.extend([0; 12]);
        bytes.extend(triangle.iter().flatten().flat_map(|x| x.parse::<f32>().unwrap().to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes.extend(tail);
    bytes
}

fn obj() -> String {
    let vertices: String = CORNERS.iter().map(|v| format!("v {} {} {}\n", v[0], v[1], v[2])).collect();
    let face = |s: &[usize; 4]| format!("f {} {} {} {}\n", s[0] + 1, s[1] + 1, s[2] + 1, s[3] + 1);
    vertices + &SIDES.iter().map(face).collect::<String>()
}

fn stl(bytes: impl Into<Vec<u8>>) -> Result<Mesh> {
    from_bytes(Path::new("case.stl"), bytes.into())
}

fn wavefront(bytes: impl Into<Vec<u8>>) -> Result<Mesh> {
    from_bytes(Path::new("case.obj"), bytes.into())
}

/// Signed volume by the divergence theorem.
fn volume(mesh: &Mesh) -> f64 {
    mesh.triangles.iter().map(|[a, b, c]| a.dot(b.cross(*c)) / 6.0).sum()
}

/// Properties of every mesh that was read: finite corners, solids that cover all triangles in order.
fn is_sound(mesh: &Mesh) {
    assert!(mesh.triangles.iter().flatten().all(|corner| corner.is_finite()));
    let mut next = 0;
    for solid in &mesh.solids {
        assert_eq!(solid.triangles.start, next);
        assert!(solid.triangles.start <= solid.triangles.end);
        next = solid.triangles.end;
    }
    assert_eq!(next, mesh.triangles.len());
    assert!(!mesh.triangles.is_empty());
    let file = mesh.path.display().to_string();
    assert!(mesh.warnings.iter().all(|warning| warning.starts_with(&file) && !warning.contains('\n')));
}

/// The box, with so many warnings.
#[track_caller]
fn is_box(mesh: Result<Mesh>, warnings: usize) -> Mesh {
    let mesh = mesh.unwrap();
    is_sound(&mesh);
    assert_eq!(mesh.triangles.len(), 12);
    assert!((volume(&mesh) - 2.0).abs() < 1e-6, "volume {}", volume(&mesh));
    assert_eq!(mesh.warnings.len(), warnings, "{:?}", mesh.warnings);
    mesh
}

/// A refusal whose message has all these words.
#[track_caller]
fn is_refused(mesh: Result<Mesh>, words: &[&str]) {
    let message = mesh.expect_err("a refusal").to_string();
    assert!(message.starts_with("case."), "{message}");
    for word in words {
        assert!(message.to_lowercase().contains(&word.to_lowercase()), "no `{word}` in: {message}");
    }
    assert!(message.len() < 300 && !message.contains(['\n', '\0']), "{message:?}");
}

fn names(mesh: &Mesh) -> Vec<&str> {
    mesh.solids.iter().map(|solid| solid.name.as_str()).collect()
}

// ASCII STL

#[test]
fn ascii_coordinates_are_doubles() {
    let mesh = is_box(stl(ascii()), 0);
    assert_eq!(mesh.triangles[0], [DVec3::new(0.3, 1.2, 0.1), DVec3::new(2.3, 1.2, 0.1), DVec3::new(2.3, 0.2, 0.1)]);
    assert_eq!(names(&mesh), ["cube"]);
}

#[test]
fn ascii_in_other_hands() {
    let text = ascii();
    is_box(stl(text.replace('\n', "\r\n")), 0);
    is_box(stl(text.replace('\n', "\r")), 0);
    is_box(stl(text.replace(' ', "\t")), 0);
    is_box(stl(text.to_uppercase()), 0);
    is_box(stl(format!("\u{feff}{text}")), 0);
    is_box(stl(format!("\n \n  {text}")), 0);
    is_box(stl(text.trim_end()), 0);
    is_box(stl(text.replace("0.3", "+3.0E-1").replace("1.1", "11.e-1").replace("0.1", ".1")), 0);
    is_box(stl(text.replace("normal 0 0 1", "normal nan -nan(ind) 1.#QNAN")), 0);
    // Content decides, whatever the name.
    is_box(from_bytes(Path::new("case.obj"), text.clone().into()), 0);
    is_box(from_bytes(Path::new("case"), text.into()), 0);
}

#[test]
fn names_of_solids() {
    let named = |name: &[u8]| [b"solid ", name, b"\n", facets().as_bytes(), b"endsolid ", name, b"\n"].concat();
    let name = |bytes: Vec<u8>| is_box(stl(bytes), 0).solids[0].name.clone();
    assert_eq!(name(named(b"")), "");
    assert_eq!(name(ascii().replace(" cube", "").into()), "");
    assert_eq!(name(named("Träger 7".as_bytes())), "Träger 7");
    assert_eq!(name(named(b"Tr\xe4ger\t")), "Tr\u{fffd}ger");
    assert_eq!(name(named(b"facet normal 0 0 1 outer solid endsolid")), "facet normal 0 0 1 outer solid endsolid");
    assert_eq!(name(named(&[b'n'; 100_000])).len(), 100_000);
    assert_eq!(name(named(&[0xe4; 10_000])).chars().count(), 10_000);
}

#[test]
fn several_solids_keep_their_names() {
    let other = ascii().replace("cube", "b c");
    let mesh = stl(format!("{}{other}solid void\nendsolid void\n", ascii())).unwrap();
    is_sound(&mesh);
    assert_eq!(names(&mesh), ["cube", "b c", "void"]);
    assert_eq!([&mesh.solids[0].triangles, &mesh.solids[1].triangles], [&(0..12), &(12..24)]);
    assert_eq!(mesh.solids[2].triangles, 24..24);
    assert!(
        mesh.warnings.len() == 1 && mesh.warnings[0].contains("without triangles (first: line 17"),
        "{:?}",
        mesh.warnings
    );
}

#[test]
fn all_on_one_line() {
    let line = |text: String| text.replace('\n', " ");
    assert_eq!(names(&is_box(stl(line(ascii())), 0)), ["cube"]);
    let two = line(ascii() + &ascii().replace("cube", "ball"));
    assert_eq!(names(&stl(two).unwrap()), ["cube", "ball"]);
    // The facets may begin on the line of the name, too.
    assert_eq!(names(&is_box(stl(ascii().replacen("cube\n", "cube", 1)), 0)), ["cube"]);
}

#[test]
fn ascii_with_warnings() {
    let text = ascii();
    is_box(stl(text.replace("endsolid cube\n", "")), 1);
    is_box(stl(text.replace(" normal 0 0 1", "")), 1);
    is_box(stl(text.replacen("normal 0 0 1", "normal 0 0", 1)), 1);
    is_box(stl(text.replace("  facet", "# a comment, facet normal\n  facet")), 1);
    is_box(stl(format!("// made by hand\n# on a Monday\n{text}")), 1);
    is_box(stl(format!("{text}this is no STL\n")), 1);
    is_box(stl([text.as_bytes(), &binary(b"", 12, b"")].concat()), 1);
    is_box(stl(facets()), 2);
    let joined = format!("solid a\n{}solid b\n{}endsolid b", facets(), facets());
    let mesh = stl(joined).unwrap();
    assert_eq!((names(&mesh), mesh.warnings.len()), (vec!["a", "b"], 1));
}

#[test]
fn ascii_errors_name_line_and_token() {
    let edit = |from: &str, to: &str| stl(ascii().replacen(from, to, 1));
    is_refused(edit("vertex 2.3 1.2", "vertex 2.3abc 1.2"), &["line 5", "`2.3abc`", "not a number"]);
    is_refused(edit("vertex 2.3", "vertex 2,3"), &["line 5", "`2,3`", "comma"]);
    is_refused(edit("vertex 2.3", "vertex 2.3D0"), &["line 5", "`2.3D0`", "exponent"]);
    is_refused(edit("vertex 2.3", "vertex nan"), &["line 5", "`nan`", "not finite"]);
    is_refused(edit("vertex 2.3", "vertex 1e999"), &["line 5", "`1e999`", "not finite"]);
    is_refused(edit("vertex 2.3", "vertex"), &["line 6", "`vertex`", "not a number"]);
    is_refused(edit("vertex 2.3", "vertex \0"), &["line 5", r"`\0`"]);
    is_refused(edit("      vertex 0.3 1.2 0.1\n", ""), &["line 6", "`vertex`", "`endloop`"]);
    is_refused(edit("    endloop\n", "      vertex 1 2 3\n    endloop\n"), &["line 7", "expected `endloop`"]);
    is_refused(edit("    endloop\n", ""), &["line 7", "expected `endloop`", "`endfacet`"]);
    is_refused(edit("  endfacet\n", ""), &["line 8", "expected `endfacet`"]);
    is_refused(edit("outer", "inner"), &["line 3", "expected `outer`", "`inner`"]);
    is_refused(edit("facet normal", "triangle"), &["line 2", "expected `facet` or `endsolid`", "`triangle`"]);
    is_refused(edit("0.3", &"9".repeat(1000)), &["line 4", "…"]);
    let crlf = ascii().replace('\n', "\r\n").replacen("vertex 2.3", "vertex x", 1);
    is_refused(stl(crlf), &["line 5"]);
    let cr = ascii().replace('\n', "\r").replacen("vertex 2.3", "vertex x", 1);
    is_refused(stl(cr), &["line 5"]);
    // Words between solids would hide the solid behind them.
    is_refused(stl(format!("{}and then\n{}", ascii(), ascii())), &["line 87", "`and`"]);
}

#[test]
fn ascii_cut_short() {
    let text = ascii();
    // Anywhere within facets; behind the last one only `endsolid` is missing.
    for end in (30..text.rfind("endfacet").unwrap()).step_by(7) {
        let cut = &text[..end];
        match stl(cut) {
            Err(error) => assert!(error.to_string().contains("line "), "{error}"),
            Ok(mesh) => assert!(cut.trim_end().ends_with("endfacet") && mesh.warnings.len() == 1, "{cut}"),
        }
    }
    is_refused(stl("solid\n"), &["no triangles", "84"]);
    is_refused(stl("solid"), &["no triangles"]);
    is_refused(stl("solid a\nendsolid a\n"), &["no triangles", "line 2"]);
    is_refused(stl("solid advice: do not mesh by hand.\n".repeat(10)), &["line 2", "`solid`"]);
}

// Binary STL

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

// OBJ

#[test]
fn obj_in_other_hands() {
    let text = obj();
    let mesh = is_box(wavefront(text.clone()), 0);
    assert_eq!((names(&mesh), mesh.triangles[0][0]), (vec![""], DVec3::new(0.3, 1.2, 0.1)));
    is_box(from_bytes(Path::new("case.stl"), text.clone().into()), 0);
    is_box(from_bytes(Path::new("case"), format!("# notes\n\n{text}").into()), 0);
    is_box(wavefront(format!("\u{feff}{text}")), 0);
    is_box(wavefront(text.replace('\n', "\r\n")), 0);
    is_box(wavefront(text.replace('\n', "\r")), 0);
    is_box(wavefront(text.replace('\n', " # why\n")), 0);
    is_box(wavefront(text.replace("v ", "V\t")), 0);
    is_box(wavefront(text.replace(".1\n", ".1 0.5 0.5 0.5\n")), 0);
    for reference in ["/1", "//1", "/1/1", "/"] {
        let lines = text.lines().map(|line| match line.strip_prefix("f ") {
            Some(indices) => format!("f {}{reference}", indices.replace(' ', &format!("{reference} "))),
            None => line.to_string(),
        });
        let head = "mtllib none.mtl\nvn 0 0 1\nvt 0 0\nusemtl x\ns off\nl 1 2\n".to_string();
        is_box(wavefront(lines.fold(head, |text, line| text + &line + "\n")), 0);
    }
}

#[test]
fn obj_continuation_and_order() {
    let text = obj();
    is_box(wavefront(text.replace("f 4 3", "f 4 \\\n3")), 0);
    is_box(wavefront(text.replace("f 4 3", "f 4\\\r\n 3")), 0);
    is_box(wavefront(text.replace("f 4 3", "f \\ \n 4 \\\n\\\n 3")), 0);
    let (vertices, faces) = text.split_at(text.find('f').unwrap());
    is_box(wavefront(format!("{faces}{vertices}")), 0);
    let negative = SIDES
        .iter()
        .map(|s| format!("f {} {} {} {}\n", s[0] as i64 - 8, s[1] as i64 - 8, s[2] as i64 - 8, s[3] as i64 - 8));
    is_box(wavefront(negative.fold(vertices.to_string(), |text, face| text + &face)), 0);
}

#[test]
fn obj_names_begin_solids() {
    let text = obj().replacen("f ", "o top\ng lid left\nf ", 1).replacen("f 1 ", "o ribs\nf 1 ", 1) + "g nothing\n";
    let mesh = is_box(wavefront(text.clone()), 0);
    assert_eq!(names(&mesh), ["lid left", "ribs"]);
    assert_eq!(mesh.solids[0].triangles, 0..4);
    let mesh = is_box(wavefront(text.replacen("f 5", "g\nf 5", 1)), 0);
    assert_eq!(names(&mesh), ["lid left", "", "ribs"]);
}

#[test]
fn obj_polygons_need_not_be_convex() {
    // An L from each of its corners: a fan would cover too much from some.
    let outline = [[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]];
    for turn in 0..6 {
        let vertices = (0..12).map(|i| format!("v {} {} {}\n", outline[i % 6][0], outline[i % 6][1], i / 6));
        let ring = |i: usize| (i + turn) % 6 + 1;
        let caps = [
            (0..6).rev().map(ring).fold("f".to_string(), |f, i| format!("{f} {i}")),
            (0..6).map(ring).fold("f".to_string(), |f, i| format!("{f} {}", i + 6)),
        ];
        let sides = (0..6).map(|i| (i + 1, (i + 1) % 6 + 1)).map(|(i, j)| format!("f {i} {j} {} {}\n", j + 6, i + 6));
        let mesh = wavefront(vertices.chain(sides).collect::<String>() + &caps.join("\n")).unwrap();
        is_sound(&mesh);
        assert_eq!((mesh.triangles.len(), mesh.warnings.len()), (20, 0));
        assert!((volume(&mesh) - 3.0).abs() < 1e-12);
        let area: f64 = mesh.triangles.iter().map(|[a, b, c]| (b - a).cross(c - a).length() / 2.0).sum();
        assert!((area - 14.0).abs() < 1e-12, "{area}");
    }
}

#[test]
fn obj_with_warnings() {
    is_box(wavefront(obj() + "f 1 2\n"), 1);
    is_box(wavefront(obj().replacen("f ", "f 1 2\nf ", 1)), 1);
    is_box(wavefront(obj() + "f\n"), 1);
    is_box(wavefront(obj() + "frobnicate 1 2\n"), 1);
    is_box(wavefront(obj() + "cstype bezier\ncurv 0 1 1 2 3\nend\n"), 1);
    let mesh = wavefront(obj() + "f 1 1 1 1\n").unwrap();
    assert_eq!((mesh.triangles.len(), mesh.warnings.len()), (14, 1));
}

#[test]
fn obj_errors_name_line_and_token() {
    let edit = |from: &str, to: &str| wavefront(obj().replacen(from, to, 1));
    is_refused(edit("f 4 3", "f 0 3"), &["line 9", "index 0"]);
    is_refused(edit("f 4 3", "f 99 3"), &["line 9", "99", "8 vertices"]);
    is_refused(edit("f 4 3", "f -9 3"), &["line 9", "-9", "8 vertices"]);
    is_refused(edit("f 4 3", "f 99999999999999999999 3"), &["line 9", "`99999999999999999999`"]);
    is_refused(edit("f 4 3", "f 9223372036854775807 3"), &["line 9", "9223372036854775807"]);
    is_refused(edit("f 4 3", "f -9223372036854775808 3"), &["line 9", "-9223372036854775808"]);
    is_refused(edit("f 4 3", "f 4.0 3"), &["line 9", "`4.0`"]);
    is_refused(edit("f 4 3", "f /4 3"), &["line 9", "`/4`"]);
    is_refused(edit("v 0.3 1.2 0.1", "v nan 1.2 0.1"), &["line 4", "`nan`", "not finite"]);
    is_refused(edit("v 0.3 1.2 0.1", "v 0.3 1.2"), &["line 4", "three coordinates", "2"]);
    is_refused(edit("v 0.3 1.2 0.1", "v 0.3 1,2 0.1"), &["line 4", "`1,2`"]);
    is_refused(wavefront(obj().split('f').next().unwrap()), &["no faces", "8 vertices"]);
    is_refused(wavefront("Dear colleague,\nplease find attached the geometry.\n".repeat(9)), &["no faces", "line 1"]);
}

#[test]
fn a_face_of_many_corners_ends() {
    use std::fmt::Write;
    let (mut vertices, mut face) = (String::new(), "f".to_string());
    for i in 0..200_000 {
        let angle = f64::from(i) * 0.001;
        writeln!(vertices, "v {} {} 0", angle * angle.cos(), angle * angle.sin()).unwrap();
        write!(face, " {}", i + 1).unwrap();
    }
    let start = std::time::Instant::now();
    let _ = wavefront(vertices + &face);
    assert!(start.elapsed().as_secs() < 20);
}

// Other things

#[test]
fn other_formats_are_refused_by_name() {
    is_refused(stl(""), &["empty"]);
    is_refused(stl("  \n\n\t\n"), &["empty", "white space"]);
    is_refused(stl("\u{feff}"), &["empty"]);
    is_refused(stl("s"), &["84"]);
    is_refused(stl(b"\x1f\x8b\x08\0rest of it".to_vec()), &["gzip"]);
    is_refused(stl(b"PK\x03\x04rest of it".to_vec()), &["zip"]);
    is_refused(stl(b"\x89PNG\r\n\x1a\nrest of it".to_vec()), &["PNG"]);
    is_refused(stl("<!DOCTYPE html><html>404</html>"), &["HTML"]);
    is_refused(stl("\n <HTML>404</HTML>"), &["HTML"]);
    is_refused(stl("<?xml version=\"1.0\"?><model/>"), &["XML"]);
    is_refused(stl("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n"), &["Git LFS"]);
    is_refused(stl("ply\nformat ascii 1.0\n"), &["PLY"]);
    is_refused(stl("Dear colleague, please find attached.\n".repeat(9)), &["`Dear colleague", "solid"]);
    let wide = |bytes: fn(u16) -> [u8; 2]| ascii().encode_utf16().flat_map(bytes).collect::<Vec<u8>>();
    is_refused(stl([b"\xff\xfe".to_vec(), wide(u16::to_le_bytes)].concat()), &["UTF-16"]);
    is_refused(stl(wide(u16::to_le_bytes)), &["UTF-16"]);
    is_refused(stl(wide(u16::to_be_bytes)), &["UTF-16"]);
    let scrambled = (0..5000u64).map(|i| (i.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40) as u8);
    is_refused(stl(scrambled.collect::<Vec<u8>>()), &["not an STL", "5000"]);
    is_refused(stl(vec![0; 5000]), &["no triangles"]);
    is_refused(stl(vec![0xff; 5000]), &["4294967295"]);
}

#[cfg(unix)]
#[test]
fn what_is_no_file_is_refused_at_once() {
    let dir = scratch("no_file");
    let fifo = dir.join("fifo.stl");
    assert!(std::process::Command::new("mkfifo").arg(&fifo).status().unwrap().success());
    std::os::unix::fs::symlink("nowhere.stl", dir.join("dangling.stl")).unwrap();
    let refused = |path: &Path, word: &str| {
        let message = read(path).unwrap_err().to_string();
        assert!(message.starts_with(path.to_str().unwrap()) && message.contains(word), "{message}");
    };
    refused(&fifo, "not a regular file");
    refused(Path::new("/dev/null"), "not a regular file");
    refused(Path::new("/dev/zero"), "not a regular file");
    refused(&dir, "directory");
    refused(&dir.join("dangling.stl"), "symbolic link");
    refused(&dir.join("missing.stl"), "cannot open");
}

#[test]
fn a_huge_file_of_the_wrong_kind_is_not_read() {
    // 1 TB of nothing, on a file system with sparse files; reading it would take minutes.
    let path = scratch("sparse").join("huge.stl");
    let file = std::fs::File::create(&path).unwrap();
    if file.set_len(1 << 40).is_ok() {
        assert!(read(&path).unwrap_err().to_string().contains("no triangles"));
        std::fs::write(&path, binary(b"", 12, b"")).unwrap();
        std::fs::OpenOptions::new().write(true).open(&path).unwrap().set_len(1 << 40).unwrap();
        is_box(read(&path), 1);
    }
    std::fs::remove_file(&path).unwrap();
}

/// An empty directory of this test.
fn scratch(name: &str) -> PathBuf {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("input_{name}"));
    let _ = std::fs::remove_dir_all(&dir);
    std::fs::create_dir_all(&dir).unwrap();
    dir
}

// The collection of bad inputs

/// Cases whose volume is not the signed volume of the triangles as they stand: it is meant within a domain, or of a union.
const OTHER_VOLUME: [&str; 2] = ["bin_outside_domain.stl", "asc_multi_solid_overlap.stl"];
/// Cases that the fixtures leave out for their size; tests above generate the like.
const GENERATED: [&str; 4] =
    ["asc_name_10kB.stl", "asc_utf16.stl", "asc_multi_solid_same_name.stl", "random_bytes_5000.stl"];
/// Cases whose volume is known although the manifest leaves open whether they are read.
const WARNED: [&str; 5] = [
    "asc_missing_normal.stl",
    "asc_comment_lines.stl",
    "asc_binary_appended.stl",
    "obj_two_vertex_face.obj",
    "asc_garbage_after_end.stl",
];

#[test]
fn bad_inputs_behave_as_their_manifest_says() {
    let dir = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/fixtures/bad_inputs");
    let manifest: serde_json::Value =
        serde_json::from_slice(&std::fs::read(dir.join("manifest.json")).unwrap()).unwrap();
    let mut counts = std::collections::BTreeMap::new();
    for case in manifest["files"].as_array().unwrap() {
        let file = case["file"].as_str().unwrap();
        // Special files have tests of their own.
        if case["bytes"].is_null() || GENERATED.contains(&file) {
            continue;
        }
        let words: Vec<&str> =
            case["message_should_mention"].as_array().unwrap().iter().map(|word| word.as_str().unwrap()).collect();
        let expect = case["expect"].as_str().unwrap();
        let outcome = outcome(&dir.join(file), expect, case["solid_volume"].as_f64(), &words);
        *counts.entry((expect.to_string(), outcome)).or_insert(0) += 1;
    }
    assert_eq!(counts.values().sum::<i32>(), 129);
    let count = |expect: &str, outcome| counts.get(&(expect.to_string(), outcome)).copied().unwrap_or(0);
    assert_eq!(count("ok", "refused") + count("ok", "warned"), 0, "{counts:?}");
    assert_eq!(count("error", "read") + count("error", "warned"), 0, "{counts:?}");
}

fn outcome(path: &Path, expect: &str, solid_volume: Option<f64>, words: &[&str]) -> &'static str {
    let file = path.file_name().unwrap().to_str().unwrap();
    let is_geometry = file.starts_with("geo_");
    match read(path) {
        Err(error) => {
            let message = error.to_string();
            assert!(matches!(expect, "error" | "warn_or_error"), "{message}");
            assert!(!is_geometry, "{message}");
            for word in words.iter().chain([&file]) {
                assert!(message.to_lowercase().contains(&word.to_lowercase()), "no `{word}` in: {message}");
            }
            "refused"
        }
        Ok(mesh) => {
            is_sound(&mesh);
            assert_ne!(expect, "error", "{file} was read");
            let expected = solid_volume.or(WARNED.contains(&file).then_some(2.0));
            if let Some(expected) = expected.filter(|_| !is_geometry && !OTHER_VOLUME.contains(&file)) {
                let volume = volume(&mesh) * if file == "bin_units_mm.stl" { 1e-9 } else { 1.0 };
                assert!((volume - expected).abs() <= 1e-5 * expected.abs() + 1e-30, "{file}: {volume}");
            }
            // Silence is right only where reading found nothing odd.
            let must_warn = expect == "warn_or_error" && !is_geometry && file != "bin_huge_3e38.stl";
            assert!(!must_warn || !mesh.warnings.is_empty(), "{file} was read without a warning");
            if mesh.warnings.is_empty() { "read" } else { "warned" }
        }
    }
}

// Anything at all

/// Neither panics nor gives an unsound mesh, whatever the name.
fn is_harmless(bytes: &[u8]) {
    for name in ["any.stl", "any.obj", "any"] {
        match from_bytes(Path::new(name), bytes.to_vec()) {
            Ok(mesh) => is_sound(&mesh),
            Err(error) => assert!(error.to_string().starts_with(name)),
        }
    }
}

/// Changes of a valid file: bytes overwritten, cut out, or repeated elsewhere.
fn mutated(valid: Vec<u8>) -> impl Strategy<Value = Vec<u8>> {
    let change = (
        any::<Index>(),
        any::<Index>(),
        prop_oneof![any::<u8>(), prop::sample::select(b"\0\n\r\\#/-.9 eEdnfos".to_vec())],
        0..4,
    );
    prop::collection::vec(change, 1..6).prop_map(move |changes| {
        let mut bytes = valid.clone();
        for (a, b, byte, kind) in changes {
            if bytes.is_empty() {
                break;
            }
            let (a, b) = (a.index(bytes.len()), b.index(bytes.len()));
            let (low, high) = (a.min(b), a.max(b));
            match kind {
                0 => bytes[a] = byte,
                1 => drop(bytes.drain(low..high.min(low + 60))),
                2 => bytes.truncate(high),
                _ => {
                    let piece = bytes[low..high.min(low + 300)].to_vec();
                    bytes.splice(a..a, piece);
                }
            }
        }
        bytes
    })
}

/// Words of the formats in any order.
fn words() -> impl Strategy<Value = String> {
    let words = [
        "solid",
        "endsolid",
        "facet",
        "normal",
        "outer",
        "loop",
        "vertex",
        "endloop",
        "endfacet",
        "0",
        "1",
        "-1",
        "2",
        "1e9",
        "nan",
        "v",
        "f",
        "o",
        "g",
        "#",
        "//",
        "\\",
        "\n",
        "\r",
        "1/2/3",
        "x",
        "\nf 1 2 3",
        "\nv 1 2 3",
        "facet normal 0 0 1 outer loop",
        "vertex 0 1 2",
    ];
    prop::collection::vec(prop::sample::select(words.to_vec()), 0..80).prop_map(|words| words.join(" "))
}

/// Cases of each property; this many take a second.
const CASES: u32 = 2000;

proptest! {
    #![proptest_config(ProptestConfig { cases: CASES, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_bytes_are_harmless(bytes in prop::collection::vec(any::<u8>(), 0..700)) {
        is_harmless(&bytes);
    }

    #[test]
    fn any_binary_is_harmless(body in prop::collection::vec(any::<u8>(), 0..400), count in 0u32..9) {
        is_harmless(&[&[b' '; 80][..], &count.to_le_bytes(), &body].concat());
    }

    #[test]
    fn mutated_files_are_harmless(bytes in prop_oneof![
        mutated(ascii().into_bytes()),
        mutated(binary(b"solid", 12, b"")),
        mutated(obj().into_bytes()),
    ]) {
        is_harmless(&bytes);
    }

    #[test]
    fn shuffled_words_are_harmless(text in words()) {
        is_harmless(text.as_bytes());
        is_harmless(format!("solid {text}").as_bytes());
        is_harmless(format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{text}").as_bytes());
    }

    #[test]
    fn any_polygon_closes(points in prop::collection::vec(prop::array::uniform3(-2i8..3), 3..12)) {
        // The area vectors of the triangles add up to that of the polygon, whatever it is.
        let text: String = points.iter().map(|p| format!("v {} {} {}\n", p[0], p[1], p[2])).collect();
        let face: String = (1..=points.len()).map(|i| format!(" {i}")).collect();
        let mesh = wavefront(format!("{text}f{face}")).unwrap();
        prop_assert_eq!(mesh.triangles.len(), points.len() - 2);
        let area = |a: DVec3, b: DVec3, c: DVec3| (b - a).cross(c - a);
        let sum: DVec3 = mesh.triangles.iter().map(|[a, b, c]| area(*a, *b, *c)).sum();
        let corner = |i: usize| DVec3::from_array(points[i % points.len()].map(f64::from));
        let whole: DVec3 = (0..points.len()).map(|i| area(corner(0), corner(i), corner(i + 1))).sum();
        prop_assert_eq!(sum, whole);
    }
}
