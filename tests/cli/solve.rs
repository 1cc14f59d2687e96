//! `voidage solve`: flows that are known, from every kind of input, to every kind of output.

use crate::kit::{Scratch, array, fixture, json, solved, stderr, stdout, voidage};
use std::fs;
use std::path::Path;
use voidage::files::npy;

/// Sod's shock tube along one axis.
fn sod(axis: &str) -> String {
    let grid: String = ["x", "y", "z"]
        .map(|a| format!("{a} = {{ points = [0, 1], cells = [{}] }}\n", if a == axis { 200 } else { 1 }))
        .concat();
    let low = if axis == "x" { "0.5" } else { "-inf, 0.5" };
    let low = if axis == "z" { "-inf, -inf, 0.5" } else { low };
    format!(
        r#"
[grid]
{grid}
[gas]
model = "ideal"
gamma = 1.4

[initial]
uniform = {{ rho = 1, p = 1 }}
regions = [{{ min = [{low}], rho = 0.125, p = 0.1 }}]

[boundary]
{axis}_min = {{ type = "zero-gradient" }}
{axis}_max = {{ type = "zero-gradient" }}

[time]
end = 0.2
"#
    )
}

#[test]
fn sod_from_regions() {
    let at = Scratch::new();
    let output = solved(&at, &sod("x"), "out", &[]);
    assert!(stdout(&output).contains("200 × 1 × 1 = 200 cells, flow along x"), "{}", stdout(&output));
    let [rho, u, p] = ["rho", "u", "p"].map(|f| array(&at.file(&format!("out/final/{f}.npy"))));
    // The exact solution is constant left and right of the contact, which is at x = 0.6855, up to the shock at 0.8504.
    for (cell, state) in [(20, [1.0, 0.0, 1.0]), (120, [0.42632, 0.92745, 0.30313]), (155, [0.26557, 0.92745, 0.30313])]
    {
        for (found, exact) in [rho[cell], u[cell], p[cell]].into_iter().zip(state) {
            assert!((found - exact).abs() < 2e-3, "cell {cell}: {found}, not {exact}");
        }
    }
    let report = json(&at.file("out/report.json"));
    for (key, most) in [("mass_drift", 1e-14), ("energy_drift", 1e-14), ("floors", 0.0), ("fallbacks", 0.0)] {
        assert!(report[key].as_f64().expect(key).abs() <= most, "{key}: {}", report[key]);
    }
    assert_eq!(report["time"], 0.2);
    assert_eq!(report["axes"], serde_json::json!(["x"]));
    assert!(report["cell_updates_per_second"].as_f64().expect("a speed") > 0.0);
}

#[test]
fn an_axis_is_as_good_as_another() {
    let density = |axis: &str| {
        let at = Scratch::new();
        solved(&at, &sod(axis), "out", &["-q"]);
        let (shape, values) = npy::read(&at.file("out/final/rho.npy")).expect("an array");
        assert_eq!(shape.iter().max(), Some(&200), "{axis}");
        values
    };
    let along_x = density("x");
    assert!(along_x == density("y") && along_x == density("z"));
}

/// An array as other programs write it: f4, last index fastest.
fn write_c_order(path: &Path, shape: [usize; 3], value: impl Fn(usize, usize, usize) -> f32) {
    let [nx, ny, nz] = shape;
    let text = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({nx}, {ny}, {nz}), }}");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((text.len() as u16).to_le_bytes());
    bytes.extend(text.as_bytes());
    for i in 0..nx {
        for j in 0..ny {
            bytes.extend((0..nz).flat_map(|k| value(i, j, k).to_le_bytes()));
        }
    }
    fs::write(path, bytes).expect("an array");
}

/// Writes an initial state: density by cell, velocities constant along live axes, pressure 1.
fn write_state(dir: &Path, shape: [usize; 3], velocities: &[(&str, f64)], rho: impl Fn(usize, usize, usize) -> f32) {
    fs::create_dir_all(dir).expect("a directory");
    let count = shape.iter().product();
    write_c_order(&dir.join("rho.npy"), shape, rho);
    npy::write(&dir.join("p.npy"), shape, &vec![1.0; count]).expect("an array");
    for (name, value) in velocities {
        npy::write(&dir.join(format!("{name}.npy")), shape, &vec![*value; count]).expect("an array");
    }
}

#[test]
fn a_blob_is_carried_once_around_a_periodic_square() {
    let at = Scratch::new();
    let blob = |i: usize, j: usize, _| {
        let [x, y] = [i, j].map(|n| (n as f32 + 0.5) / 32.0 - 0.5);
        1.0 + (-20.0 * (x * x + y * y)).exp()
    };
    write_state(&at.file("start"), [32, 32, 1], &[("u", 1.0), ("v", 0.5)], blob);
    let case = r#"
[grid]
origin = [0, 0]
spacing = [0.03125, 0.03125]
cells = [32, 32]
[gas]
model = "ideal"
gamma = 1.4
[initial]
from = "start"
[boundary]
x_min = { type = "periodic" }
x_max = { type = "periodic" }
y_min = { type = "periodic" }
y_max = { type = "periodic" }
[time]
end = 2
"#;
    solved(&at, case, "out", &["-q"]);
    let rho = array(&at.file("out/final/rho.npy"));
    let error: f64 = (0..32 * 32).map(|c| (rho[c] - f64::from(blob(c % 32, c / 32, 0))).abs()).sum::<f64>() / 1024.0;
    assert!(error < 0.01, "mean error of the density {error}");
    let [u, v, p] = ["u", "v", "p"].map(|f| array(&at.file(&format!("out/final/{f}.npy"))));
    let far = |values: &[f64], wanted: f64| values.iter().fold(0.0f64, |m, x| m.max((x - wanted).abs()));
    assert!(far(&u, 1.0) < 1e-6 && far(&v, 0.5) < 1e-6 && far(&p, 1.0) < 1e-6); // the density came as f4
    assert!(json(&at.file("out/report.json"))["mass_drift"].as_f64().expect("a number").abs() < 1e-13);
}

/// A closed box with the process skid in it, and a region of high pressure.
fn skid(porosity: &str, output: &str) -> String {
    format!(
        r#"
[grid]
x = {{ points = [-1, 9], cells = [20] }}
y = {{ points = [-1, 5], cells = [12] }}
z = {{ points = [-1, 4], cells = [10] }}
[porosity]
{porosity}
[gas]
model = "ideal"
gamma = 1.4
[initial]
uniform = {{ rho = 1.2, p = 1e5 }}
regions = [{{ center = [4, 2, 1.5], radius = 1.6, p = 4e5 }}]
[boundary]
x_min = {{ type = "wall" }}
x_max = {{ type = "wall" }}
y_min = {{ type = "wall" }}
y_max = {{ type = "wall" }}
z_min = {{ type = "wall" }}
z_max = {{ type = "wall" }}
[time]
end = 0.01
[output]
{output}
"#
    )
}

#[test]
fn a_scene_and_its_arrays_give_the_same_flow() {
    let at = Scratch::new();
    let scene = fixture("cad_skid.stl");
    // A region of whole cells: of a part of a cell arrays do not tell how much is solid.
    let skid = |porosity: &str| {
        let case = skid(porosity, "");
        let of_cells = case.replace("center = [4, 2, 1.5], radius = 1.6", "min = [2.5, 0.5, 0], max = [5.5, 3.5, 3]");
        assert!(of_cells != case);
        of_cells
    };
    let from_scene = skid(&format!("scene = '{}'", scene.display()));
    solved(&at, &from_scene, "scene", &["-q"]);
    let grid = at.file("grid.toml");
    fs::write(&grid, from_scene.lines().skip(2).take(3).collect::<Vec<_>>().join("\n")).expect("a grid file");
    let output =
        voidage(&[&"porosity", &scene, &"--grid", &grid, &"--faces", &"throat", &"--npy", &at.file("beta"), &"-q"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let arrays = skid("from = 'beta'");
    let (_, after) = arrays.split_once("[porosity]").expect("a table");
    solved(&at, &format!("grid.file = 'grid.toml'\n[porosity]{after}"), "arrays", &["-q"]);
    for field in ["rho", "u", "v", "w", "p"] {
        let [a, b] = ["scene", "arrays"].map(|d| array(&at.file(&format!("{d}/final/{field}.npy"))));
        assert!(a == b, "{field}");
    }
    let report = json(&at.file("scene/report.json"));
    // Most of its walls are round, and cells cut by them have no jumps.
    assert!(report["porosity"]["jump_faces"].as_u64().expect("a count") > 20, "{report}");
    for drift in ["mass_drift", "energy_drift"] {
        assert!(report[drift].as_f64().expect("a number").abs() < 1e-12, "{drift}: {}", report[drift]);
    }
}

#[test]
fn frames_probes_log_and_pictures() {
    let at = Scratch::new();
    let output = r#"
every = 0.002
formats = ["vtr", "npy", "png"]
probes = [{ name = "corner", at = [8.9, 4.9, 3.9] }, { name = "middle", at = [4, 2, 3] }]
"#;
    let scene = fixture("cad_skid.stl");
    solved(&at, &skid(&format!("scene = '{}'", scene.display()), output), "out", &["-q"]);
    let report = json(&at.file("out/report.json"));
    assert_eq!(report["frames"], serde_json::json!([0.0, 0.002, 0.004, 0.006, 0.008, 0.01]));
    let series = fs::read_to_string(at.file("out/flow.pvd")).expect("a series");
    assert_eq!(series.matches("<DataSet").count(), 6);
    assert!(series.contains(r#"<DataSet timestep="0.01" part="0" file="frames/flow_0005.vtr"/>"#), "{series}");
    for n in 0..6 {
        for name in [format!("flow_{n:04}.vtr"), format!("speed_{n:04}.png"), format!("pressure_{n:04}.png")] {
            assert!(at.file(&format!("out/frames/{name}")).is_file(), "{name}");
        }
    }
    assert!(array(&at.file("out/frames/0005/p.npy")) == array(&at.file("out/final/p.npy")));

    let table = |name: &str| -> (String, Vec<Vec<f64>>) {
        let text = fs::read_to_string(at.file(&format!("out/{name}"))).expect("a table");
        let (head, lines) = text.split_once('\n').expect("a head");
        (head.to_owned(), lines.lines().map(|l| l.split(',').map(|x| x.parse().expect("a number")).collect()).collect())
    };
    let steps = report["steps"].as_u64().expect("a count") as usize;
    let (head, log) = table("log.csv");
    assert_eq!(
        head,
        "step,time,dt,mass,energy,max_mach,floors,floor_mass,floor_momentum,floor_energy,force_x,force_y,force_z"
    );
    assert_eq!(log.len(), steps + 1);
    assert!(log.iter().enumerate().all(|(n, row)| row[0] == n as f64));
    let mass = log[0][3];
    assert!(log.iter().all(|row| (row[3] / mass - 1.0).abs() < 1e-12));
    let (head, probes) = table("probes.csv");
    assert!(head.starts_with("step,time,corner rho,corner u,corner v,corner w,corner p,middle rho"), "{head}");
    assert_eq!(probes.len(), steps + 1);
    assert_eq!(probes[0][6], 1e5);
    assert!(probes.iter().any(|row| row[11] > 1.2e5), "the blast reaches the probe in the middle");
}

#[test]
fn a_scene_that_needs_little_gets_little() {
    let at = Scratch::new();
    let case = r#"
[grid]
x = { points = [0, 1], cells = [50] }
[porosity]
from = "beta"
[gas]
model = "isothermal"
sound_speed = 2
[drag]
cr = [0, 0, 0]
[initial]
uniform = { rho = 1 }
regions = [{ max = [0.5], p = 8 }]
[boundary]
x_min = { type = "wall" }
x_max = { type = "outlet", p = 4 }
[time]
max_steps = 20
[output]
formats = []
"#;
    fs::create_dir(at.file("beta")).expect("a directory");
    npy::write(&at.file("beta/beta_v.npy"), [50, 1, 1], &[1.0; 50]).expect("an array");
    npy::write(&at.file("beta/beta_x.npy"), [51, 1, 1], &[1.0; 51]).expect("an array");
    solved(&at, case, "out", &["-q"]);
    let report = json(&at.file("out/report.json"));
    assert_eq!(report["energy_drift"], serde_json::Value::Null);
    assert_eq!(report["porosity"], serde_json::Value::Null);
    assert_eq!(report["steps"], 20);
    let skipped = report["skipped"].to_string();
    for part in ["axis y", "axis z", "porosity", "drag", "gravity", "energy equation"] {
        assert!(skipped.contains(part), "{part}: {skipped}");
    }
    let mut names: Vec<_> =
        fs::read_dir(at.file("out")).expect("results").map(|e| e.expect("an entry").file_name()).collect();
    names.sort();
    assert_eq!(names, ["checkpoint.bin", "final", "log.csv", "report.json"]);
}

/// Gas of 300 K blown into gas of 400 K: the density behind the front is that of 300 K at the pressure found there.
#[test]
fn an_inlet_of_given_velocity_and_temperature() {
    let at = Scratch::new();
    let case = r#"
[grid]
x = { points = [0, 1], cells = [50] }
[gas]
model = "ideal"
gamma = 1.4
gas_constant = 287
[initial]
uniform = { T = 400, p = 1e5 }
[boundary]
x_min = { type = "inlet", u = 30, T = 300 }
x_max = { type = "outlet", p = 1e5 }
[time]
end = 0.05
[output]
formats = []
"#;
    solved(&at, case, "out", &["-q"]);
    let [rho, u, p] = ["rho", "u", "p"].map(|f| array(&at.file(&format!("out/final/{f}.npy"))));
    for cell in [0, 25, 49] {
        let temperature = p[cell] / (287.0 * rho[cell]);
        assert!((u[cell] / 30.0 - 1.0).abs() < 0.01, "cell {cell}: u = {}", u[cell]);
        assert!((temperature / 300.0 - 1.0).abs() < 0.01, "cell {cell}: T = {temperature}");
        assert!((p[cell] / 1e5 - 1.0).abs() < 0.01, "cell {cell}: p = {}", p[cell]);
    }
}

/// An inlet faster than sound keeps its pressure, also where it has to set gas at rest in motion.
#[test]
fn a_supersonic_inlet_keeps_its_pressure() {
    let at = Scratch::new();
    for (speed, relax, end) in [(400, "", 0.2), (700, ", relax = 1e-3", 0.04)] {
        let case = format!(
            "[grid]\nx = {{ points = [0, 1], cells = [25] }}\n[gas]\nmodel = \"ideal\"\ngamma = 1.4\ngas_constant = 287\n[initial]\n\
             uniform = {{ T = 288, p = 101325 }}\n[boundary]\nx_min = {{ type = \"inlet\", T = 288, u = {speed}, p = 101325{relax} }}\n\
             x_max = {{ type = \"outlet\", p = 101325 }}\n[time]\nend = {end}\n[output]\nformats = []\n"
        );
        let dir = format!("out{speed}");
        solved(&at, &case, &dir, &["-q"]);
        let [u, p] = ["u", "p"].map(|f| array(&at.file(&format!("{dir}/final/{f}.npy"))));
        for cell in [0, 12, 24] {
            let off = [u[cell] / f64::from(speed) - 1.0, p[cell] / 101_325.0 - 1.0];
            assert!(off.iter().all(|x| x.abs() < 1e-3), "{speed} m/s, cell {cell}: {} m/s, {} Pa", u[cell], p[cell]);
        }
    }
}

#[test]
fn small_cells_and_dust_are_counted() {
    let at = Scratch::new();
    let case = r#"
[grid]
x = { points = [0, 1], cells = [20] }
[porosity]
from = "beta"
[gas]
model = "ideal"
gamma = 1.4
[initial]
uniform = { rho = 1, p = 1 }
[boundary]
x_min = { type = "wall" }
x_max = { type = "wall" }
[time]
max_steps = 3
"#;
    let mut volume = [1.0; 20];
    (volume[4], volume[7], volume[8]) = (1e-3, 1e-16, 0.0);
    let mut faces = [1.0; 21];
    faces[7..=9].copy_from_slice(&[0.0, 1e-16, 0.0]);
    fs::create_dir(at.file("beta")).expect("a directory");
    npy::write(&at.file("beta/beta_v.npy"), [20, 1, 1], &volume).expect("an array");
    npy::write(&at.file("beta/beta_x.npy"), [21, 1, 1], &faces).expect("an array");
    solved(&at, case, "out", &["-q"]);
    let porosity = &json(&at.file("out/report.json"))["porosity"];
    let expected =
        [("closed_cells", 2), ("dust_cells", 1), ("dust_faces", 1), ("closed_faces", 0), ("matched_faces", 0)];
    for (key, count) in expected {
        assert_eq!(porosity[key], count, "{key}: {porosity}");
    }
    assert!(porosity["merged_cells"].as_u64().expect("a count") >= 2, "{porosity}");
}

/// The paper's flow on a coarse grid: its example as it ships, the cube on the grid's lines and across them.
#[test]
fn a_cube_in_a_channel() {
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/channel");
    let text = fs::read_to_string(example.join("channel.toml")).expect("the example");
    // The finest grid for its symmetry alone.
    for (cells, closed, end) in [([33, 10, 10], 12, 0.3), ([40, 12, 12], 64, 0.3), ([60, 18, 18], 216, 0.01)] {
        let at = Scratch::new();
        fs::copy(example.join("cube.stl"), at.file("cube.stl")).expect("the cube");
        let grid = |axis: usize, size: &str, was: usize| {
            (
                format!("points = [0, {size}], cells = [{was}]"),
                format!("points = [0, {size}], cells = [{}]", cells[axis]),
            )
        };
        let mut case = text.replace("end = 1.5", &format!("end = {end}"));
        for (from, to) in [grid(0, "10", 60), grid(1, "3", 18)] {
            assert!(case.contains(&from), "{from}");
            case = case.replace(&from, &to);
        }
        solved(&at, &case, "out", &["-q"]);
        let [u, v, w, rho] = ["u", "v", "w", "rho"].map(|f| array(&at.file(&format!("out/final/{f}.npy"))));
        let [nx, ny, nz] = cells;
        let cell = |i: usize, j: usize, k: usize| (k * ny + j) * nx + i;
        let report = json(&at.file("out/report.json"));
        assert!(report["mass_drift"].as_f64().expect("a number").abs() < 1e-12, "{report}");
        assert_eq!(report["floors"], 0);
        let size = 10.0 / nx as f64;
        let at_x = |x: f64| (x / size) as usize;
        assert_eq!(report["porosity"]["closed_cells"], closed);
        let inside = cell(at_x(5.0), ny / 2, nz / 2);
        assert!(u[inside] == 0.0 && v[inside] == 0.0 && w[inside] == 0.0, "the gas flows through the cube");
        let (wake, beside) = (u[cell(at_x(6.2), ny / 2, nz / 2)], u[cell(at_x(5.0), ny - 1, nz / 2)]);
        assert!(end < 0.3 || (wake < 5.0 && beside > 10.5), "wake {wake} m/s, beside the cube {beside} m/s");
        let mut worst = 0.0f64;
        for k in 0..nz {
            for j in 0..ny {
                for i in 0..nx {
                    let (a, b, c) = (cell(i, j, k), cell(i, ny - 1 - j, k), cell(i, j, nz - 1 - k));
                    for (x, y) in [(u[a], u[b]), (v[a], -v[b]), (u[a], u[c]), (w[a], -w[c]), (v[a], w[cell(i, k, j)])] {
                        worst = worst.max((x - y).abs() / 10.0);
                    }
                    worst = worst.max((rho[a] / rho[b] - 1.0).abs());
                }
            }
        }
        assert!(worst <= 1e-12, "mirrored cells differ by {worst} ({cells:?})");
    }
}

/// What rounding of unions leaves open in a cell that is wholly solid is no pocket of gas.
#[test]
fn what_rounding_leaves_open_is_solid() {
    let at = Scratch::new();
    let case = "[grid]\nx = { points = [0, 1], cells = [4] }\ny = { points = [0, 1], cells = [2] }\n[porosity]\nfrom = \"fields\"\n\
                [gas]\nmodel = \"ideal\"\ngamma = 1.4\n[initial]\nuniform = { rho = 1, p = 1 }\nregions = [{ max = [0.4], p = 3 }]\n\
                [boundary]\nx_min = \"wall\"\nx_max = \"wall\"\ny_min = \"wall\"\ny_max = \"wall\"\n[time]\nend = 0.1\n\
                [output]\nformats = []\nmaxima = {}\n";
    for (dust, closed) in [(7e-13, 1), (1e-6, 0)] {
        let volume = [1.0, 1.0, dust, 1.0, 1.0, 1.0, 1.0, 1.0];
        let x = [1.0, 1.0, dust, dust, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0];
        let y = [1.0, 1.0, dust, 1.0, 1.0, 1.0, dust, 1.0, 1.0, 1.0, 1.0, 1.0];
        let fields: [npy::Named; 3] =
            [("beta_v".into(), [4, 2, 1], &volume), ("beta_x".into(), [5, 2, 1], &x), ("beta_y".into(), [4, 3, 1], &y)];
        npy::write_all(&at.file("fields"), &fields).expect("written");
        solved(&at, case, "out", &["--force"]);
        let told = &json(&at.file("out/report.json"))["porosity"];
        assert!(told["closed_cells"] == closed && told["dust_cells"] == closed, "{dust}: {told}");
        let over = array(&at.file("out/maxima/overpressure.npy"));
        let none: Vec<bool> = over.iter().map(|p| p.is_nan()).collect();
        assert_eq!(none, (0..8).map(|n| n == 2 && closed == 1).collect::<Vec<_>>(), "{dust}: {over:?}");
    }
}
