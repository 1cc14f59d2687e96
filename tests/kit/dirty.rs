//! What must hold for any triangles and any file: no panic, and fractions within 0..1.

use glam::DVec3;
use std::path::Path;
use voidage::bodies::Bodies;
use voidage::grid::Edges;
use voidage::input::{self, Mesh, Solid};
use voidage::porosity::{FieldSet, Options, porosity};

/// Any bytes, read as a mesh file, give bodies with fractions within 0..1, or an error.
pub fn any_file_is_measured_or_refused(bytes: &[u8]) {
    for name in ["fuzz.stl", "fuzz.obj"] {
        if let Ok(mesh) = input::from_bytes(Path::new(name), bytes.to_vec()) {
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
    measure(&Mesh { path: "fuzz.stl".into(), solids, triangles, warnings: Vec::new() }, 0);
}

/// Any triangles with corners from 2⁻⁶⁴ to 2⁶³ in size are measured within 0..1. A cut of so long an edge is a rounding error
/// off, and that error can be many cells.
pub fn any_sizes_are_measured(bytes: &[u8]) {
    let number = |b: &[u8]| f64::from(b[0] as i8) * 2.0_f64.powi(i32::from(b[1] as i8) / 2 - 6);
    let corner = |b: &[u8]| DVec3::new(number(b), number(&b[2..]), number(&b[4..]));
    let chunks = bytes.chunks_exact(18).take(64);
    let triangles: Vec<_> = chunks.map(|c| [corner(c), corner(&c[6..]), corner(&c[12..])]).collect();
    let solids = vec![Solid { name: String::new(), triangles: 0..triangles.len() }];
    measure(&Mesh { path: "fuzz.stl".into(), solids, triangles, warnings: Vec::new() }, 0);
}

/// Measure a mesh on an aligned and on an odd grid.
fn measure(mesh: &Mesh, depth: u32) {
    let mut bodies = Bodies::default();
    if bodies.add(mesh, 1.0).is_err() {
        return;
    }
    let aligned: Vec<f64> = (0..=4).map(f64::from).collect();
    let odd = vec![-0.3, 0.2, 0.25, 1.1, 2.9, 3.6];
    for edges in [Edges([aligned.clone(), aligned.clone(), aligned]), Edges([odd.clone(), odd.clone(), odd])] {
        let grid = edges.grid(None).expect("a grid");
        let options = Options { depth, bounds: true, ..Options::default() };
        let p = porosity(&grid, &bodies, options);
        let [lower, upper] = p.bounds.expect("bounds");
        within(&p.beta);
        within(&lower);
        within(&upper);
        assert!(p.solid_volume.is_finite() && p.max_gap >= 0.0);
    }
}

fn within(fields: &FieldSet) {
    for field in [&fields.v, &fields.x, &fields.y, &fields.z] {
        for (n, b) in field.iter().enumerate() {
            assert!((0.0..=1.0).contains(b), "entry {n}: {b}");
        }
    }
}
