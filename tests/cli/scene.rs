//! Scene files on the command line.

use crate::kit::{Scratch, fixture, stderr, stdout, voidage};
use serde_json::Value;
use std::fs;

const BOX: &str = "[[solid]]\nname = \"b\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n";
const GRID: &str = "[grid]\norigin = [-1, -1, -1]\nspacing = [0.5, 0.5, 0.5]\ncells = [8, 6, 6]\n";

fn report(dir: &Scratch, arguments: &[&dyn AsRef<std::ffi::OsStr>]) -> Value {
    let file = dir.file("report.json");
    let mut all: Vec<&dyn AsRef<std::ffi::OsStr>> = vec![&"porosity", &"-q", &"--report", &file];
    all.extend(arguments);
    let output = voidage(&all);
    assert!(output.status.success(), "{}", stderr(&output));
    serde_json::from_str(&fs::read_to_string(file).expect("a report")).expect("JSON")
}

#[test]
fn meshes_and_scenes_are_one_scene() {
    let dir = Scratch::new();
    let scene = dir.file("scene.toml");
    let more = "array = { count = [2, 1, 1], step = [2, 0, 0] }\nporosity = 0.25\n";
    fs::write(&scene, format!("{BOX}{more}{GRID}")).expect("written");
    let mesh = dir.file("mesh.stl");
    fs::copy(fixture("bad_inputs/ref_ok_binary.stl"), &mesh).expect("a copy");
    let alone = report(&dir, &[&mesh, &"--bounds", &"-1,-1,-1,3,2,2", &"--cells", &"8x6x6"]);
    let both = report(&dir, &[&scene, &mesh]);
    // The scene's own grid, as nothing else was asked for.
    assert_eq!(both["grid"]["cells"], serde_json::json!([8, 6, 6]));
    assert_eq!(both["solids"][0]["name"], "b");
    assert_eq!(both["solids"][0]["copies"], 2);
    assert_eq!(both["bodies"].as_u64(), alone["bodies"].as_u64().map(|n| n + 2));
    let volume = |r: &Value| r["solid_volume"].as_f64().expect("a volume");
    // The mesh, 2 × 1 × 1 from (0.3, 0.2, 0.1) in f32, covers 0.504 and 0.216 of the porous boxes.
    assert!((volume(&alone) - 2.0).abs() < 1e-6, "{alone}");
    assert!((volume(&both) - (2.0 + 0.75 * (2.0 - 0.72))).abs() < 1e-6, "{both}");
    let asked = report(&dir, &[&scene, &"--cells", &"3x3x3"]);
    assert_eq!(asked["grid"]["cells"], serde_json::json!([3, 3, 3]));
}

#[test]
fn a_file_in_a_scene_is_the_file_to_the_bit() {
    let dir = Scratch::new();
    fs::create_dir(dir.file("meshes")).expect("a directory");
    fs::copy(fixture("cad_skid.stl"), dir.file("meshes/skid.stl")).expect("a copy");
    let scene = dir.file("scene.toml");
    fs::write(&scene, "[[solid]]\nname = \"skid\"\nshape = \"file\"\npath = \"meshes/skid.stl\"\nunit = \"mm\"\n")
        .expect("written");
    let fields = |name: &str, arguments: &[&dyn AsRef<std::ffi::OsStr>]| {
        let out = dir.file(name);
        let mut all: Vec<&dyn AsRef<std::ffi::OsStr>> = vec![&"--cells", &"20x13x11", &"--npy", &out];
        all.extend(arguments);
        let report = report(&dir, &all);
        let bytes = ["v", "x", "y", "z"].map(|f| fs::read(out.join(format!("beta_{f}.npy"))).expect("an array"));
        (bytes, report)
    };
    let (direct, _) = fields("direct", &[&dir.file("meshes/skid.stl"), &"--unit", &"mm"]);
    let (through, report) = fields("through", &[&scene]);
    assert!(direct == through);
    assert_eq!(report["bodies"], 123);
    assert_eq!(report["solids"][0]["shape"], "file");
}

#[test]
fn inspect_lists_solids() {
    let dir = Scratch::new();
    let scene = dir.file("scene.toml");
    let ball = "[[solid]]\nname = \"ball\"\nshape = \"sphere\"\ncenter = [4, 4, 4]\nradius = 1\nporosity = 0.5\n";
    fs::write(&scene, format!("{BOX}{ball}")).expect("written");
    let text = stdout(&voidage(&[&"inspect", &scene]));
    for word in ["ball", "sphere", "4.188790205", "(3, 3, 3) to (5, 5, 5)"] {
        assert!(text.contains(word), "{word}: {text}");
    }
    let output = voidage(&[&"inspect", &scene, &"--json", &"-q"]);
    let json: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(json["solids"][1]["porosity"], 0.5);
    assert_eq!(json["bodies"][0]["name"], "b");
}

#[test]
fn warnings_name_the_solid() {
    let dir = Scratch::new();
    fs::copy(fixture("bad_inputs/geo_open_missing_face.stl"), dir.file("open.stl")).expect("a copy");
    let scene = dir.file("scene.toml");
    fs::write(&scene, "[[solid]]\nname = \"lid\"\nshape = \"file\"\npath = \"open.stl\"\n").expect("written");
    let said = stderr(&voidage(&[&"inspect", &scene]));
    assert!(said.contains("scene.toml: solid \"lid\": ") && said.contains("1 hole, closed with a cap"), "{said}");
}

/// What is wrong, and the words of the message besides file and line; `@` marks the line that must be named.
const WRONG: [(&str, &[&str]); 55] = [
    ("[[solid]]\nshape = \"file\"\npath = \"\"@", &["solid 1: path is empty: it names an STL or OBJ file"]),
    (
        "[[solid]]\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nrotate = { axis = \"-y\", angle = 3 }@",
        &["axis needs three numbers or x, y, z, not \"-y\"; that is [0, -1, 0]"],
    ),
    (
        "[[solid]]\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nrotate = { axis = \"z\", angel = 3 }@",
        &["column 24: solid 1: rotate: key angel is not known here; did you mean angle?"],
    ),
    (
        "[[solid]]\nname = \"a\"\nshape = \"cylinder\"\ncenter = [0, 0, 0]@\nradius = 1\nheight = 2",
        &[
            "solid \"a\": cylinder takes from, to, radius; not center, height",
            "   4 | center = [0, 0, 0]\n     | ^^^^^^\n",
        ],
    ),
    ("[[solid]]@\nshape = \"sphere\"\nradius = 1", &["sphere takes center, radius; center is missing"]),
    ("[[solid]]\nshape = \"spere\"@", &["did you mean sphere?"]),
    ("solid = 3@", &["takes tables [[solid]]"]),
    ("", &["without solids"]),
    ("[[solid]]@\nshape = \"box\"", &["solid 1", "box takes min, max; min, max are missing"]),
    ("[[solid]]\nname = 7@", &["name takes a text"]),
    ("[[solid]]@\nname = \"a\"", &["solid \"a\"", "shape is missing"]),
    ("[[solid]]\nname = \"a\"\nshape = \"donut\"@", &["donut", "known: sphere"]),
    (
        "[[solid]]\nname = \"a\"\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = -1@",
        &["solid \"a\"", "radius must be positive", "-1"],
    ),
    ("[[solid]]\nname = \"a\"\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 0@", &["must be positive"]),
    ("[[solid]]\nname = \"a\"\nshape = \"sphere\"\ncenter = [0, 0, nan]@\nradius = 1", &["center[2]", "nan"]),
    ("[[solid]]\nname = \"a\"\nshape = \"sphere\"\ncenter = [0, 0, -inf]@\nradius = 1", &["inf"]),
    ("[[solid]]\nname = \"a\"\nshape = \"sphere\"\ncenter = [0, 0]@\nradius = 1", &["three values, not 2"]),
    ("[[solid]]\nname = \"a\"\nshape = \"sphere\"\ncenter = [0, 0, \"x\"]@\nradius = 1", &["number, not a text"]),
    ("[[solid]]\nname = \"a\"\nshape = \"sphere\"\ncenter = 0@\nradius = 1", &["takes a list"]),
    (
        "[[solid]]\nname = \"a\"\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1e99@",
        &["takes a number within ±1e30, not 1e99"],
    ),
    (
        "[[solid]]\nname = \"a\"\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmin = [0, 0, 0]@",
        &["sphere takes center, radius; not min"],
    ),
    (
        "[[solid]]\nname = \"a\"\nshape = \"ellipsoid\"\ncenter = [0, 0, 0]\nsemi_axes = [1, 0, 1]@",
        &["semi_axes[1]", "positive"],
    ),
    ("[[solid]]\nname = \"a\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 0, 1]@", &["above min"]),
    ("[[solid]]\nname = \"a\"\nshape = \"cylinder\"\nfrom = [1, 1, 1]\nto = [1, 1, 1]@\nradius = 1", &["same point"]),
    ("[[solid]]\nname = \"a\"\nshape = \"cone\"\nfrom = [1, 1, 1]\nto = [1, 1, 1]@\nradius = 1", &["same point"]),
    (
        "[[solid]]\nname = \"a\"\nshape = \"cone\"\nfrom = [1, 1, 1]\nto = [1, 1, 2]\nradius = 1\ntop_radius = -0.5@",
        &["top_radius", "must not be below 0"],
    ),
    (
        "[[solid]]\nname = \"a\"\nshape = \"cylinder\"\nfrom = [1, 1, 1]\nto = [1, 1, 2]\nradius = 1\ntop_radius = 0.5@",
        &["cylinder takes from, to, radius; not top_radius"],
    ),
    (
        "[[solid]]\nname = \"a\"\nshape = \"torus\"\ncenter = [0, 0, 0]\naxis = \"z\"\nradius = 1\ntube = 1.5@",
        &["tube", "must not be above radius (1)", "its own axis"],
    ),
    (
        "[[solid]]\nname = \"a\"\nshape = \"torus\"\ncenter = [0, 0, 0]\naxis = [0, 0, 0]@\nradius = 1\ntube = 0.5",
        &["axis", "has no direction"],
    ),
    (
        "[[solid]]\nname = \"a\"\nshape = \"torus\"\ncenter = [0, 0, 0]\naxis = \"w\"@\nradius = 1\ntube = 0.5",
        &["three numbers or x, y, z, not \"w\""],
    ),
    (
        "[[solid]]\nname = \"a\"\nshape = \"torus\"\ncenter = [0, 0, 0]\naxis = \"z\"\nradius = 1\ntube = 0.5\nangle = 90@",
        &["angle", "needs start"],
    ),
    (
        "[[solid]]\nname = \"a\"\nshape = \"torus\"\ncenter = [0, 0, 0]\naxis = \"z\"\nradius = 1\ntube = 0.5\nstart = \"x\"@",
        &["start", "needs angle"],
    ),
    (
        "[[solid]]\nname = \"a\"\nshape = \"torus\"\ncenter = [0, 0, 0]\naxis = \"z\"\nradius = 1\ntube = 0.5\nstart = \"x\"\nangle = 361@",
        &["angle", "above 360"],
    ),
    (
        "[[solid]]\nname = \"a\"\nshape = \"torus\"\ncenter = [0, 0, 0]\naxis = \"z\"\nradius = 1\ntube = 0.5\nstart = [0, 0, 2]@\nangle = 90",
        &["start", "away from the axis"],
    ),
    (
        "[[solid]]\nname = \"a\"\nshape = \"torus\"\ncenter = [0, 0, 0]\naxis = \"z\"\nradius = 1\ntube = 0@",
        &["tube", "must be positive"],
    ),
    ("[[solid]]\nname = \"a\"\nshape = \"hull\"\npoints = []@", &["at least 4 points, not 0"]),
    (
        "[[solid]]\nname = \"a\"\nshape = \"hull\"\npoints = [[0,0,0],[1,0,0],[0,1,0],[1,1,0],[0.3,0.2,0]]@",
        &["plane", "all 5"],
    ),
    ("[[solid]]\nname = \"a\"\nshape = \"hull\"\npoints = [[0,0,0],[0,0,0],[0,0,0],[0,0,0]]@", &["plane"]),
    (
        "[[solid]]\nname = \"a\"\nshape = \"file\"\npath = \"absent.stl\"@",
        &["solid \"a\"", "absent.stl", "cannot open"],
    ),
    ("[[solid]]\nname = \"a\"\nshape = \"file\"\npath = \".\"@", &["directory"]),
    ("[[solid]]\nname = \"a\"\nshape = \"file\"\npath = \"scene.toml\"@", &["scenes do not hold scenes"]),
    (
        "[[solid]]\nname = \"a\"\nshape = \"file\"\npath = \"cube.stl\"\nunit = \"furlong\"@",
        &["furlong", "m, mm, cm, in, ft"],
    ),
    ("[[solid]]\nname = \"a\"\nshape = \"file\"\npath = \"cube.stl\"\nscale = 0@", &["positive"]),
    (
        "# a box\n[[solid]]\nname = \"a\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\narray = { count = [1000000, 1000000, 1000000], step = [1, 1, 1] }@",
        &["array", "copies; the most are 1000000"],
    ),
    (
        "[[solid]]\nname = \"a\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\narray = { count = [9223372036854775807, 3, 3], step = [1, 1, 1] }@",
        &["copies"],
    ),
    (
        "[[solid]]\nname = \"a\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\narray = { count = [0, 1, 1], step = [1, 1, 1] }@",
        &["at least 1"],
    ),
    (
        "[[solid]]\nname = \"a\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\narray = { count = [1, 1, 1.5], step = [1, 1, 1] }@",
        &["whole number"],
    ),
    (
        "[[solid]]\nname = \"a\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\narray = { count = [1, 1, 1] }@",
        &["step is missing"],
    ),
    (
        "[[solid]]\nname = \"a\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nrotate = { axis = [0, 0, 0], angle = 3 }@",
        &["no direction"],
    ),
    (
        "[[solid]]\nname = \"a\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nrotate = { axis = \"w\", angle = 3 }@",
        &["\"w\""],
    ),
    ("[[solid]]\nname = \"a\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nrotate = 30@", &["takes a table"]),
    ("[[solid]]\nname = \"a\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nporosity = 1.5@", &["from 0 to 1"]),
    ("[[solid]]\nname = \"a\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n\n[gird]@\n", &["gird", "not known"]),
    (
        "[[solid]]\nname = \"a\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n\n[grid]\nx = [0, 1]\ny = [0, 1]\nz = [0, 1]\nw = 3@",
        &["key grid.w"],
    ),
    ("[[solid]]\nname = \"a\nshape@", &["line"]),
];

/// Slips in the spelling of the file itself, the words of the message, and the part of the line that it marks.
const SLIPS: [(&str, &str, &str); 16] = [
    (
        "[[solid]]\nshape = \"sphere\"\n[solid]@",
        "solid stands here as [solid] and before in line 1 as [[solid]]: each of several is a table [[solid]]",
        "^^^^^",
    ),
    ("[solid]\nname = \"a\"\n[[solid]]@", "solid stands here as [[solid]] and before in line 1 as [solid]", "^^^^^"),
    (
        "[grid]\nx = [0, 1]\n[grid]@",
        "the table [grid] is given twice; where several may stand each is a table [[grid]]",
        "^^^^",
    ),
    ("[[solid]]\nname = \"a\"\nname = \"b\"@", "key name is given twice in this table", "^^^^"),
    ("[[solid]]\nradius 1@", "`=` and a value are missing behind this key", "^"),
    ("[[solid]]\nname = tank@", "this is no value: numbers are written as 2.5 or 1e-3, texts stand in quotes", "^^^^"),
    ("[[solid]]\nradius = 1 m@", "this is no value", "^^^"),
    ("[[solid]]\nradius = @", "a value is missing here", "^"),
    (
        "[[solid]]\nradius = 1,2@",
        "nothing may follow a value on its line but a comment; decimals are written with a point",
        "^",
    ),
    ("[[solid]]\nradius = .5@", "a number needs a digit before its point", "^"),
    ("[[solid]]\nfrom = [0 0 0]@", "commas between the values of a list", "^^^^^"),
    ("[[solid]]\nfrom = [0, 0, 0@", "`]` is missing at the end of this list", "^"),
    ("[[solid]@", "`]]` is missing at the end of this head of a table", "^"),
    ("[[solid]]\nname = \"a@", "this text has no closing quote", "^"),
    ("[[solid]]\nrotate = { axis = \"z\" angle = 3 }@", "a comma is missing before this key", "^"),
    (
        "[[solid]]\nname = \"a\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\narray = { count = [1, 1, 2.5], step = [1, 1, 1] }@",
        "solid \"a\": array: count[2] takes a whole number, not 2.5",
        "^^^",
    ),
];

#[test]
fn slips_are_said_in_the_words_of_the_file() {
    let dir = Scratch::new();
    let scene = dir.file("scene.toml");
    for (text, words, mark) in SLIPS {
        let line = text.split('@').next().map_or(0, |before| before.matches('\n').count() + 1);
        fs::write(&scene, text.replace('@', "\n")).expect("written");
        let output = voidage(&[&"porosity", &scene, &"--cells", &"2x2x2"]);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{text}\n{said}");
        assert!(said.contains(&format!("scene.toml: line {line}, column ")), "{text}\n{said}");
        assert!(said.contains(words), "{words}\n{text}\n{said}");
        assert_eq!(said.lines().last().map(|l| l.trim_matches([' ', '|'])), Some(mark), "{text}\n{said}");
    }
    // What others call a shape.
    for (word, ours) in [("pipe", "cylinder"), ("ball", "sphere"), ("elbow", "torus"), ("mesh", "file")] {
        fs::write(&scene, format!("[[solid]]\nshape = \"{word}\"\n")).expect("written");
        let said = stderr(&voidage(&[&"porosity", &scene, &"--cells", &"2x2x2"]));
        assert!(said.contains(&format!("did you mean {ours}?")), "{said}");
    }
}

#[test]
fn what_is_wrong_is_said_with_its_place() {
    let dir = Scratch::new();
    fs::copy(fixture("bad_inputs/ref_ok_binary.stl"), dir.file("cube.stl")).expect("a copy");
    let scene = dir.file("scene.toml");
    for (text, words) in WRONG {
        let line = text.split('@').next().map_or(0, |before| before.matches('\n').count() + 1);
        fs::write(&scene, text.replace('@', "")).expect("written");
        let output = voidage(&[&"porosity", &scene, &"--cells", &"2x2x2"]);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{text}\n{said}");
        assert!(said.contains("scene.toml: "), "{text}\n{said}");
        assert!(
            !text.contains('@')
                || text.contains("name = \"a\nshape")
                || said.contains(&format!("line {line}, column ")),
            "line {line}: {text}\n{said}"
        );
        words.iter().for_each(|w| assert!(said.contains(w), "{w}: {text}\n{said}"));
    }
}

/// A solid that is all open is told, unless it resists.
#[test]
fn solids_that_are_all_open_are_told() {
    let dir = Scratch::new();
    let scene = dir.file("scene.toml");
    let told = |keys: &str| {
        fs::write(&scene, format!("{BOX}porosity = 1\n{keys}")).expect("written");
        stderr(&voidage(&[&"porosity", &scene, &"--cells", &"2x2x2"]))
    };
    let words = "porosity is 1 and there is no cr: all of it is open, it has no effect";
    assert!(told("").contains(words), "{}", told(""));
    assert!(!told("cr = 4\n").contains(words), "{}", told("cr = 4\n"));
}

/// Copies that a step of 0 leaves in one place count once, and are told.
#[test]
fn copies_in_one_place_are_told() {
    let dir = Scratch::new();
    let scene = dir.file("scene.toml");
    let told = |array: &str| {
        let ball = "[[solid]]\nname = \"ball\"\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\n";
        fs::write(&scene, format!("{ball}array = {array}\n")).expect("written");
        let output = voidage(&[&"porosity", &scene, &"--cells", &"2x2x2"]);
        assert!(output.status.success(), "{}", stderr(&output));
        stderr(&output)
    };
    let text = told("{ count = [2, 3, 1], step = [4, 0, 0] }");
    let words = "scene.toml: solid \"ball\": array: its copies along y lie upon each other: step is 0 along y";
    assert!(text.contains(words), "{text}");
    let text = told("{ count = [2, 1, 1], step = [4, 0, 0] }");
    assert!(!text.contains("lie upon each other"), "{text}");
}

/// A fault in a file that a scene names is shown there, with the place in both.
#[test]
fn a_fault_in_a_named_file_is_shown() {
    let dir = Scratch::new();
    fs::write(dir.file("bad.stl"), "solid x\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 zero\n")
        .expect("written");
    let scene = dir.file("scene.toml");
    fs::write(&scene, "[[solid]]\nshape = \"file\"\npath = \"bad.stl\"\n").expect("written");
    let said = stderr(&voidage(&[&"inspect", &scene]));
    assert!(said.contains("scene.toml: line 3, column 8: solid \"solid 1\": "), "{said}");
    assert!(said.contains("bad.stl: line 4, column 15: `zero` is not a number"), "{said}");
    assert!(said.ends_with("   4 |    vertex 0 0 zero\n     |               ^^^^\n"), "{said}");
}

/// Each copy of a large file costs memory: too many are refused before they are made.
#[test]
fn copies_that_fill_memory_are_refused() {
    let dir = Scratch::new();
    fs::copy(fixture("cad_skid.stl"), dir.file("skid.stl")).expect("a copy");
    let scene = dir.file("scene.toml");
    let array = "array = { count = [100, 100, 1], step = [5, 5, 5] }";
    let solid = format!("\n[[solid]]\nname = \"yard\"\nshape = \"file\"\npath = \"skid.stl\"\n{array}\n");
    fs::write(&scene, solid).expect("written");
    let output = voidage(&[&"inspect", &scene]);
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    assert!(said.contains("line 5, column 8: solid \"yard\": 10000 copies of 78736 triangles"), "{said}");
}

/// Whatever bytes a scene file holds, the program ends with 0 or 1 and says why.
#[test]
fn broken_scene_files_never_panic() {
    let dir = Scratch::new();
    let scene = dir.file("scene.toml");
    let whole = format!("{BOX}rotate = {{ axis = [0, 0, 1], angle = 30 }}\n{GRID}");
    let mut rng = 12345_u64;
    for n in 0..150 {
        rng = rng.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let mut bytes = whole.clone().into_bytes();
        let at = (rng >> 33) as usize % bytes.len();
        match n % 3 {
            0 => bytes.truncate(at),
            1 => bytes[at] = (rng >> 20) as u8,
            _ => drop(bytes.drain(at..(at + 1 + (rng >> 60) as usize).min(whole.len()))),
        }
        fs::write(&scene, &bytes).expect("written");
        let output = voidage(&[&"inspect", &scene, &"-q"]);
        let code = output.status.code();
        assert!(code == Some(0) || (code == Some(1) && !output.stderr.is_empty()), "{code:?} {}", stderr(&output));
    }
    fs::write(&scene, "a = ".to_owned() + &"[".repeat(200_000)).expect("written");
    assert_eq!(voidage(&[&"inspect", &scene]).status.code(), Some(1));
}

#[test]
fn two_grids_are_one_too_many() {
    let dir = Scratch::new();
    let (one, two) = (dir.file("one.toml"), dir.file("two.toml"));
    fs::write(&one, format!("{BOX}{GRID}")).expect("written");
    fs::write(&two, format!("{BOX}{GRID}")).expect("written");
    let output = voidage(&[&"porosity", &one, &two]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("two.toml: a second scene with a [grid]"), "{}", stderr(&output));
}

/// A ring and an elbow that is turned, repeated and porous have Pappus' volume; `--method gjk` takes no torus.
#[test]
fn tori_are_measured_and_refused_by_gjk() {
    const RINGS: &str = "
[[solid]]
name = \"ring\"
shape = \"torus\"
center = [1, 1, 1]
axis = [0.2, 0.1, 1]
radius = 0.6
tube = 0.2

[[solid]]
name = \"elbows\"
shape = \"torus\"
center = [2.5, 1, 0.5]
axis = \"y\"
radius = 0.3
tube = 0.1
start = \"x\"
angle = 90
porosity = 0.25
rotate = { axis = [1, 1, 1], angle = 40 }
array = { count = [2, 1, 2], step = [1, 0, 1] }

[[solid]]
name = \"reducer\"
shape = \"cone\"
from = [0.5, 0.3, 1.8]
to = [1.5, 0.4, 1.7]
radius = 0.15
top_radius = 0.05

[grid]
origin = [0, 0, 0]
spacing = [0.25, 0.25, 0.25]
cells = [16, 8, 8]
";
    let dir = Scratch::new();
    let scene = dir.file("rings.toml");
    fs::write(&scene, RINGS).expect("written");
    let found = report(&dir, &[&scene]);
    let pi = std::f64::consts::PI;
    let reducer = pi / 3.0 * (0.0225 + 0.0075 + 0.0025) * 1.02_f64.sqrt();
    let volume = 2.0 * pi * pi * 0.6 * 0.04 + 0.75 * 4.0 * pi * 0.01 * 0.3 * pi / 2.0 + reducer;
    let solid = found["solid_volume"].as_f64().expect("a number");
    assert!((solid - volume).abs() < 1e-9, "{solid}, not {volume}");
    assert!(found["max_gap"].as_f64().expect("a number") < 1e-8, "{}", found["max_gap"]);
    let with = report(&dir, &[&scene, &"--resistance"]);
    assert!(with["solid_volume"] == found["solid_volume"]);
    let output = voidage(&[&"porosity", &scene, &"--method", &"gjk"]);
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    assert!(said.contains("solid \"ring\": a torus is not convex") && said.contains("--method auto"), "{said}");
}

/// A text that an editor saved in another encoding is told with place and cure, whatever it describes; a byte order mark is no part of it.
#[test]
fn texts_are_utf_8() {
    let dir = Scratch::new();
    let scene = format!("{BOX}{GRID}").replace("\"b\"", "\"M\u{fc}ller\"");
    let latin: Vec<u8> = scene.chars().map(|c| c as u8).collect();
    let wide: Vec<u8> = [0xFF, 0xFE].into_iter().chain(scene.encode_utf16().flat_map(u16::to_le_bytes)).collect();
    for command in ["porosity", "solve", "study"] {
        for (bytes, words) in [
            (
                &latin,
                "line 2, column 10: this byte is no UTF-8 (0xFC; in Latin-1 it is \u{fc}): save the file as UTF-8",
            ),
            (&wide, "is UTF-16 (\"Unicode\" in some editors): save it as UTF-8"),
        ] {
            let path = dir.file("text.toml");
            fs::write(&path, bytes).expect("written");
            let output = voidage(&[&command, &path]);
            let said = stderr(&output);
            assert!(output.status.code() == Some(1) && said.contains(words), "{command}: {said}");
        }
    }
    let path = dir.file("marked.toml");
    fs::write(&path, format!("\u{feff}{scene}")).expect("written");
    assert_eq!(report(&dir, &[&path])["solids"][0]["name"], "M\u{fc}ller");
    fs::write(&path, format!("\u{feff}nonsense\n{scene}")).expect("written");
    let said = stderr(&voidage(&[&"porosity", &path]));
    assert!(said.contains("line 1, column 9") && said.contains("   1 | nonsense\n"), "{said}");
}

/// Keys of a grid that do not go together, and values that make no cells, are told by the keys that were written.
#[test]
fn grids_that_contradict_themselves() {
    let dir = Scratch::new();
    let path = dir.file("scene.toml");
    for (from, to, words) in [
        ("[grid]\n", "[grid]\nx = [0, 1]\ny = [0, 1]\nz = [0, 1]\n", "key grid.origin: does not go with edges"),
        ("spacing = [0.5,", "spacing = [0,", "key grid.spacing[0]: takes a finite number above 0, not 0"),
        ("cells = [8, 6, 6]", "cells = [8, 0, 6]", "key grid.cells[1]: must be at least 1, not 0"),
        (
            "origin = [-1, -1, -1]\nspacing = [0.5, 0.5, 0.5]\ncells = [8, 6, 6]\n",
            "x = { points = [0, 1, 2], cells = [1] }\ny = [0, 1]\nz = [0, 1]\n",
            "key grid.x: 3 points make 2 segments, each with a number in cells: 2, not 1",
        ),
    ] {
        assert!(GRID.contains(from));
        fs::write(&path, format!("{BOX}{}", GRID.replacen(from, to, 1))).expect("written");
        let said = stderr(&voidage(&[&"porosity", &path]));
        assert!(said.contains(words) && said.contains("scene.toml: line "), "{to}: {said}");
    }
    fs::write(&path, format!("{BOX}array = {{ count = [2, 1, 1], spacing = [2, 0, 0] }}\n{GRID}")).expect("written");
    let said = stderr(&voidage(&[&"porosity", &path]));
    assert!(said.contains("array takes count, step; not spacing"), "{said}");
}

/// Two grids are one too many only where one of them is asked for.
#[test]
fn of_two_grids_none_counts() {
    let dir = Scratch::new();
    let (one, other) = (dir.file("one.toml"), dir.file("other.toml"));
    fs::write(&one, format!("{BOX}{GRID}")).expect("written");
    fs::write(&other, format!("{}{GRID}", BOX.replace("[1, 1, 1]", "[2, 1, 1]"))).expect("written");
    let refused = voidage(&[&"porosity", &one, &other]);
    assert!(stderr(&refused).contains("other.toml: a second scene with a [grid]"), "{}", stderr(&refused));
    assert_eq!(report(&dir, &[&one, &other, &"--cells", &"4x2x2"])["grid"]["cells"], serde_json::json!([4, 2, 2]));
}

/// Of solids with resistances of their own in one place the largest counts.
#[test]
fn the_largest_resistance_counts() {
    let dir = Scratch::new();
    let grid = "[grid]\norigin = [0, 0, 0]\nspacing = [0.5, 0.5, 0.5]\ncells = [2, 2, 2]\n";
    for ([a, b], truth) in [([4.0, 4.0], 4.0), ([4.0, 4.0001], 4.0001), ([4.0, 6.0], 6.0), ([4.0, 0.0], 4.0)] {
        let own = [a, b].map(|cr| format!("{BOX}porosity = 0.5\ncr = {cr}\n").replace("\"b\"", &format!("\"{cr}\"")));
        let scene = dir.file("scene.toml");
        fs::write(&scene, own[0].clone() + &own[1].replace("\"4\"", "\"other\"") + grid).expect("written");
        let out = dir.file("out");
        let output = voidage(&[&"porosity", &scene, &"--drag", &"bluff", &"--npy", &out, &"-q"]);
        assert!(output.status.success(), "{}", stderr(&output));
        let found = crate::kit::array(&out.join("cr_x.npy"))[0];
        assert!((found - truth).abs() < 1e-12, "{a} and {b}: {found}");
    }
}
