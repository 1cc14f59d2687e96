//! Reading STL and OBJ files: what is accepted, warned of and refused, and that nothing panics.

mod anything;
mod ascii;
mod bad_inputs;
mod binary;
mod obj;
mod others;

use std::path::Path;

use voidage::error::Result;
use voidage::geometry::mesh::Mesh;
use voidage::geometry::read::from_bytes;

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
    let file = mesh.name.clone();
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
    let (said, place) = message.split_once('\n').unwrap_or((&message, ""));
    for word in words {
        assert!(said.to_lowercase().contains(&word.to_lowercase()), "no `{word}` in: {message}");
    }
    // What is wrong in one line; behind it at most the line of the file and a mark below it.
    assert!(message.len() < 400 && !message.contains('\0'), "{message:?}");
    assert!(matches!(place.lines().count(), 0 | 2) && !said.contains('\r'), "{message:?}");
}

fn names(mesh: &Mesh) -> Vec<&str> {
    mesh.solids.iter().map(|solid| solid.name.as_str()).collect()
}
