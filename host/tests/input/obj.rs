//! OBJ.

use std::path::Path;

use super::{SIDES, is_box, is_refused, is_sound, names, obj, volume, wavefront};
use glam::DVec3;
use voidage::geometry::read::from_bytes;

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
