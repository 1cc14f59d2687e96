//! What must hold for any triangles, any file and any scene: no panic, and fractions within 0..1.

use glam::DVec3;
use std::path::Path;
use voidage::error::Error;
use voidage::geometry::bodies::Bodies;
use voidage::geometry::mesh::{Mesh, Solid};
use voidage::geometry::read;
use voidage::geometry::scene::{self, shape::Shape};
use voidage::grid::Edges;
use voidage::porosity::{FieldSet, Leaf, Method, Options, porosity};

/// Any bytes, read as a mesh file, give bodies with fractions within 0..1, or an error.
pub fn any_file_is_measured_or_refused(bytes: &[u8]) {
    for name in ["fuzz.stl", "fuzz.obj"] {
        if let Ok(mesh) = read::from_bytes(Path::new(name), bytes.to_vec()) {
            measure(&mesh, 1);
        }
    }
}

/// Any triangles with corners on a small lattice (so that points, edges and planes coincide often), some slightly off it,
/// are measured within 0..1.
pub fn any_triangles_are_measured(bytes: &[u8]) {
    let corner = |b: &[u8]| {
        let off = if b[1] & 0x80 == 0 { 0.0 } else { f64::from(b[1]) * 1e-9 };
        DVec3::new(f64::from(b[0] & 7), f64::from(b[0] >> 3 & 7) + off, f64::from(b[1] & 7)) * 0.5
    };
    let triangles: Vec<_> =
        bytes.chunks_exact(6).take(64).map(|c| [corner(c), corner(&c[2..]), corner(&c[4..])]).collect();
    let solids = vec![Solid { name: String::new(), triangles: 0..triangles.len() }];
    measure(&Mesh { name: "fuzz.stl".into(), solids, ..Mesh::from(triangles) }, 0);
}

/// Any triangles with corners from 2⁻⁶⁴ to 2⁶³ in size are measured within 0..1. A cut of so long an edge is a rounding error
/// off, and that error can be many cells.
pub fn any_sizes_are_measured(bytes: &[u8]) {
    let number = |b: &[u8]| f64::from(b[0] as i8) * 2.0_f64.powi(i32::from(b[1] as i8) / 2 - 6);
    let corner = |b: &[u8]| DVec3::new(number(b), number(&b[2..]), number(&b[4..]));
    let chunks = bytes.chunks_exact(18).take(64);
    let triangles: Vec<_> = chunks.map(|c| [corner(c), corner(&c[6..]), corner(&c[12..])]).collect();
    let solids = vec![Solid { name: String::new(), triangles: 0..triangles.len() }];
    measure(&Mesh { name: "fuzz.stl".into(), solids, ..Mesh::from(triangles) }, 0);
}

/// Measure a mesh on an aligned and on an odd grid.
fn measure(mesh: &Mesh, depth: u32) {
    let mut bodies = Bodies::default();
    if bodies.add(mesh, 1.0).is_ok() {
        measure_bodies(&bodies, Options { depth, bounds: true, ..Options::default() });
    }
}

fn measure_bodies(bodies: &Bodies, options: Options) {
    let aligned: Vec<f64> = (0..=4).map(f64::from).collect();
    let odd = vec![-0.3, 0.2, 0.25, 1.1, 2.9, 3.6];
    for edges in [Edges([aligned.clone(), aligned.clone(), aligned]), Edges([odd.clone(), odd.clone(), odd])] {
        let p = porosity(&edges.grid(None).expect("a grid"), bodies, options);
        let [lower, upper] = p.bounds.expect("bounds");
        within(&p.beta);
        within(&lower);
        within(&upper);
        assert!(p.solid_volume.is_finite() && p.max_gap >= 0.0);
    }
}

/// More triangles or copies say nothing new and take long.
const ENOUGH: usize = 200;

/// Any text, read as a scene file, gives solids with fractions within 0..1, or an error that names the file. Files that it names are not
/// opened.
pub fn any_scene_is_measured_or_refused(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    measure_scene(text);
}

/// Measure a scene by every method, unless it is too large; its error if it has one.
fn measure_scene(text: &str) -> Option<Error> {
    let path = Path::new("fuzz.toml");
    let scene = match scene::parse(path, text) {
        Ok(scene) => scene,
        Err(e) => {
            assert_eq!(e.path.as_deref(), Some(path), "{e}");
            return Some(e);
        }
    };
    let copies: usize = scene.solids.iter().map(|s| s.placement.copies()).sum();
    if copies > ENOUGH || scene.solids.iter().any(|s| matches!(s.shape, Shape::File { .. })) {
        return None;
    }
    let mut bodies = Bodies::default();
    if let Err(e) = scene::load::add(&scene, &mut bodies) {
        assert!(e.path.is_some() && e.place.is_some(), "{e}");
        return Some(e);
    }
    if bodies.triangles.len() < ENOUGH * 12 {
        for (method, leaf) in [(Method::Auto, Leaf::Plane), (Method::Gjk, Leaf::Solid), (Method::Gjk, Leaf::Plane)] {
            measure_bodies(&bodies, Options { method, leaf, depth: 1, bounds: true, ..Options::default() });
        }
    }
    None
}

/// Shapes and the keys that they need; each takes three numbers but those in [`SINGLE`].
const SHAPES: [(&str, &[&str]); 9] = [
    ("sphere", &["center", "radius"]),
    ("ellipsoid", &["center", "semi_axes"]),
    ("box", &["min", "max"]),
    ("cylinder", &["from", "to", "radius"]),
    ("capsule", &["from", "to", "radius"]),
    ("cone", &["from", "to", "radius"]),
    ("cone", &["from", "to", "radius", "top_radius"]),
    ("torus", &["center", "axis", "radius", "tube"]),
    ("torus", &["center", "axis", "radius", "tube", "start", "angle"]),
];

/// Keys with one number.
const SINGLE: [&str; 5] = ["radius", "top_radius", "tube", "angle", "porosity"];

/// Keys of shapes that may be left out.
const OPTIONAL: [&str; 3] = ["top_radius", "start", "angle"];

/// A scene of solids with numbers of any size is measured or refused; with one key misspelled, missing or of the wrong kind it is refused
/// by an error that names the key and the line.
pub fn scenes_of_solids_are_measured_or_refused(bytes: &[u8]) {
    let [fault, bytes @ ..] = bytes else { return };
    let mut solids = Vec::new();
    for chunk in bytes.chunks_exact(28).take(4) {
        let mut numbers =
            chunk.chunks_exact(2).map(|b| f64::from(b[0] as i8) / 16.0 * 2f64.powi(i32::from(b[1] as i8) / 16));
        let mut number = || numbers.next().unwrap_or(0.5);
        let (name, keys) = SHAPES[usize::from(chunk[26]) % SHAPES.len()];
        let optional = ["translate", "porosity"].into_iter().take(usize::from(chunk[27]) % 3);
        let value = |key: &str, number: &mut dyn FnMut() -> f64| match key {
            "porosity" => format!("{:?}", number().abs().min(1.0)),
            _ if SINGLE.contains(&key) => format!("{:?}", number()),
            _ => format!("[{:?}, {:?}, {:?}]", number(), number(), number()),
        };
        let pairs = keys.iter().copied().chain(optional);
        let pairs: Vec<(String, String)> = pairs.map(|key| (key.to_owned(), value(key, &mut number))).collect();
        solids.push((name, pairs));
    }
    let text = |solids: &[(&str, Vec<(String, String)>)]| {
        let solid = |(name, pairs): &(&str, Vec<(String, String)>)| {
            let pairs: String = pairs.iter().map(|(key, value)| format!("{key} = {value}\n")).collect();
            format!("[[solid]]\nname = \"{name}\"\nshape = \"{name}\"\n{pairs}")
        };
        solids.iter().map(solid).collect::<String>()
    };
    measure_scene(&text(&solids));
    // The first solid has a fault, so that nothing is refused before.
    let Some((_, pairs)) = solids.first_mut() else { return };
    let needed = pairs.iter().filter(|(key, _)| key != "translate" && key != "porosity").count();
    let at = usize::from(fault / 3) % needed;
    let key = pairs[at].0.clone();
    match fault % 3 {
        1 => pairs[at].1 = "\"no\"".to_owned(),
        2 if !OPTIONAL.contains(&&*key) => drop(pairs.remove(at)),
        _ => pairs[at].0.push('x'),
    }
    // Its other numbers must not be refused first.
    for (key, value) in pairs.iter_mut().filter(|(_, value)| value != "\"no\"") {
        let good = match key.trim_end_matches('x') {
            "tube" => "0.25",
            single if SINGLE.contains(&single) => "0.5",
            "to" | "ma" => "[2, 2, 2]",
            "start" => "[1, -1, 0]",
            _ => "[1, 1, 1]",
        };
        *value = good.to_owned();
    }
    let text = text(&solids);
    let error = measure_scene(&text).unwrap_or_else(|| panic!("not refused:\n{text}"));
    assert!(error.to_string().contains(&key) && error.to_string().contains("line"), "{error}\n{text}");
}

fn within(fields: &FieldSet) {
    for field in [&fields.v, &fields.x, &fields.y, &fields.z] {
        for (n, b) in field.iter().enumerate() {
            assert!((0.0..=1.0).contains(b), "entry {n}: {b}");
        }
    }
}
