//! Walls in grid planes from files of single precision, wherever they were placed; what lies in no plane is said.

use crate::kit::{Scratch, array, json, stderr, voidage};
use serde_json::Value;
use std::fs;
use std::path::Path;

type Triangle = [[f32; 3]; 3];

/// A binary STL.
fn write(path: &Path, triangles: &[Triangle]) {
    let mut bytes = vec![0; 80];
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        bytes.extend(triangle.iter().flatten().flat_map(|x| x.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    fs::write(path, bytes).expect("written");
}

fn quad([a, b, c, d]: [[f32; 3]; 4]) -> [Triangle; 2] {
    [[a, b, c], [a, c, d]]
}

/// A square sheet over the unit square at height `z`, all lengths times `unit`.
fn panel(z: f32, unit: f32) -> [Triangle; 2] {
    quad([[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]].map(|p| [p[0] * unit, p[1] * unit, p[2]]))
}

fn cuboid(lo: f32, hi: f32) -> Vec<Triangle> {
    let corner = |n: usize| [4, 2, 1].map(|bit| if n & bit == 0 { lo } else { hi });
    let sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    sides.iter().flat_map(|side| quad(side.map(corner))).collect()
}

/// Unit cube in ten cells along each axis: the run's report, what it said, and its fields by name.
fn run(dir: &Scratch, arguments: &[&dyn AsRef<std::ffi::OsStr>]) -> (Value, String, impl Fn(&str) -> Vec<f64> + use<>) {
    let (report, npy) = (dir.file("report.json"), dir.file("npy"));
    let mut all: Vec<&dyn AsRef<std::ffi::OsStr>> =
        vec![&"porosity", &"--cells", &"10x10x10", &"--bounds", &"0,0,0,1,1,1", &"--report", &report, &"--npy", &npy];
    all.extend(arguments);
    let output = voidage(&all);
    assert!(output.status.success(), "{}", stderr(&output));
    (json(&report), stderr(&output), move |name: &str| array(&npy.join(format!("beta_{name}.npy"))))
}

/// How many faces a field has that are blocked, and how many that are open; the others are partly.
fn blocked_and_open(field: &[f64]) -> (usize, usize) {
    let count = |wanted: f64| field.iter().filter(|&&b| b == wanted).count();
    (count(0.0), count(1.0))
}

#[test]
fn a_panel_of_single_precision_blocks_the_plane_it_means() {
    let dir = Scratch::new();
    let mesh = dir.file("panel.stl");
    for (z, unit, name) in [(0.3, 1.0, "m"), (300.0, 1000.0, "mm"), (11.811_024, 39.370_08, "in")] {
        write(&mesh, &panel(z, unit));
        let (report, said, field) = run(&dir, &[&mesh, &"--unit", &name]);
        assert_eq!(blocked_and_open(&field("z")), (100, 1000), "{name}");
        assert_eq!(report["sheets_off_planes"]["sheets"], 0, "{name}");
        assert!(!said.contains("in no plane"), "{said}");
    }
}

#[test]
fn a_box_of_single_precision_has_faces_open_or_closed() {
    let dir = Scratch::new();
    let mesh = dir.file("box.stl");
    write(&mesh, &cuboid(0.2, 0.7));
    let (report, _, field) = run(&dir, &[&mesh]);
    assert_eq!(blocked_and_open(&field("v")), (125, 875));
    for axis in ["x", "y", "z"] {
        assert_eq!(blocked_and_open(&field(axis)), (150, 950), "{axis}");
    }
    assert!((report["solid_volume"].as_f64().expect("a volume") - 0.125).abs() < 1e-15);
}

#[test]
fn what_is_farther_than_half_a_unit_in_the_last_place_stays_and_is_said() {
    let dir = Scratch::new();
    let mesh = dir.file("panel.stl");
    let nearest = 0.3_f32;
    for z in [nearest.next_up(), nearest.next_down()] {
        let two = [panel(z, 1.0), panel(0.6, 1.0)].concat();
        write(&mesh, &two);
        let (report, said, field) = run(&dir, &[&mesh]);
        assert_eq!(blocked_and_open(&field("z")), (100, 1000), "only the panel at 0.6");
        assert_eq!(report["sheets_off_planes"]["sheets"], 1);
        assert!((report["sheets_off_planes"]["area"].as_f64().expect("an area") - 1.0).abs() < 1e-12);
        assert!(said.contains("of 2 sheets without thickness, 1 blocks nothing with 1 m²"), "{said}");
    }
}

/// Errors of a placed file are those of its own coordinates, however small they become, and rotation mixes them.
#[test]
fn a_placed_file_keeps_the_errors_of_its_own_coordinates() {
    let dir = Scratch::new();
    let (mesh, scene) = (dir.file("panel.stl"), dir.file("scene.toml"));
    let solid = |placed: &str| format!("[[solid]]\nname = \"p\"\nshape = \"file\"\npath = \"panel.stl\"\n{placed}\n");
    let aligned = panel(700.3, 1.0);
    // In the plane x = z; a turn about y takes it into the plane z = 0.4.
    let askew = quad([[0.1, 0.1, 0.1], [0.7, 0.1, 0.7], [0.7, 0.9, 0.7], [0.1, 0.9, 0.1]]);
    let cases = [
        (aligned, "translate = [0, 0, -700]", "z", 100),
        (aligned, "rotate = { axis = \"x\", angle = 90 }\ntranslate = [0, 0.2, -700.3]", "y", 40),
        (askew, "rotate = { axis = \"y\", angle = 45 }", "z", 64),
    ];
    for (triangles, placed, axis, blocked) in cases {
        write(&mesh, &triangles);
        fs::write(&scene, solid(placed)).expect("written");
        let (report, _, field) = run(&dir, &[&scene]);
        assert_eq!(report["sheets_off_planes"]["sheets"], 0, "{placed}");
        assert_eq!(blocked_and_open(&field(axis)).0, blocked, "{placed}");
    }
}

/// A text written from `f32` is known by its digits; one number that no `f32` looks like, and it means what it says.
#[test]
fn texts_mean_the_numbers_they_were_written_from() {
    let dir = Scratch::new();
    let mesh = dir.file("panel.stl");
    let text = |x: &str, z: &str| {
        let vertex = |p: [&str; 3]| format!("vertex {} {} {}\n", p[0], p[1], p[2]);
        let facet = |t: [[&str; 3]; 3]| {
            format!("facet normal 0 0 1\nouter loop\n{}endloop\nendfacet\n", t.map(vertex).concat())
        };
        let [a, b, c, d] = [["0", "0", z], [x, "0", z], [x, "1", z], ["0", "1", z]];
        format!("solid p\n{}{}endsolid p\n", facet([a, b, c]), facet([a, c, d]))
    };
    for (x, z, blocked) in [
        ("1", "0.3", 100),
        ("1.0", "0.30000001192", 100),
        ("1e0", "3.0000001e-1", 100),
        ("1", "0.30000001192092896", 100),
        ("1.000000000001", "0.30000001192", 0),
        ("1", "0.3000000119", 100),
        ("1", "0.3000000123", 0),
    ] {
        fs::write(&mesh, text(x, z)).expect("written");
        let (_, _, field) = run(&dir, &[&mesh]);
        assert_eq!(blocked_and_open(&field("z")).0, blocked, "{x} {z}");
    }
}

/// The grid around a pipe is told in round numbers, and its edges are those that are meant: what ends at 0 and 0.6 ends in planes and blocks them.
#[test]
fn edges_of_grids_are_round_numbers() {
    let at = Scratch::new();
    let (scene, given) = (at.file("pipe.toml"), at.file("grid.json"));
    fs::write(&scene, "[[solid]]\nshape = \"cylinder\"\nfrom = [0, 0.5, 0.5]\nto = [0.6, 0.5, 0.5]\nradius = 0.1\n")
        .expect("written");
    fs::write(&given, "{\"origin\": [-0.1, 0.3, 0.3], \"spacing\": [0.1, 0.1, 0.1], \"cells\": [8, 4, 4]}")
        .expect("written");
    let report = at.file("r.json");
    let output = voidage(&[&"porosity", &scene, &"--spacing", &"0.1", &"--report", &report, &"-q"]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(json(&report)["grid"]["bounds"], serde_json::json!([[-0.1, 0.3, 0.3], [0.7, 0.7, 0.7]]));
    for how in [&["--spacing", "0.1"], &["--grid", given.to_str().expect("a name")]] {
        let output = voidage(&[&"porosity", &scene, &how[0], &how[1], &"--npy", &at.file("n"), &"-q"]);
        assert!(output.status.success(), "{}", stderr(&output));
        let beta = array(&at.file("n/beta_x.npy"));
        let middle = |i: usize| 1.0 - beta[i + 9 * (1 + 4)];
        let quarter = std::f64::consts::PI / 4.0;
        let expected = [0.0, quarter, quarter, quarter, quarter, quarter, quarter, quarter, 0.0];
        for (i, solid) in expected.into_iter().enumerate() {
            assert!((middle(i) - solid).abs() < 1e-12, "{how:?}: face {i} is {} solid", middle(i));
        }
    }
}
