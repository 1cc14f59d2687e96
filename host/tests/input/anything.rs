//! Anything at all: no panic, no unsound mesh.

use std::path::Path;

use super::{ascii, binary, is_sound, obj, wavefront};
use glam::DVec3;
use proptest::prelude::*;
use proptest::sample::Index;
use voidage::geometry::read::from_bytes;

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
