//! Pictures of `solve`: their colours and where they are cut, unless the case says so.

use crate::kit::{Scratch, array, json, solved, stderr, stdout};
use std::fs;

/// A blast beside the middle of a box, away from the middle of the grid.
const BLAST: &str = r#"
[grid]
x = { points = [0, 1], cells = [10] }
y = { points = [0, 1], cells = [10] }
z = { points = [0, 1], cells = [10] }
[gas]
model = "ideal"
gamma = 1.4
[initial]
uniform = { rho = 1.2, p = 1e5 }
regions = [{ center = [0.35, 0.75, 0.25], radius = 0.15, p = 8e5 }]
[boundary]
x_min = "wall"
x_max = "wall"
y_min = "wall"
y_max = "wall"
z_min = "wall"
z_max = "wall"
[time]
end = 6e-4
[output]
every = 2e-4
ambient = 1e5
formats = ["npy", "png"]
"#;

/// Overpressures in kPa of the three planes through a cell, as a run keeps them: across x, y and z.
fn planes(at: &Scratch, frame: usize, [i, j, k]: [usize; 3]) -> Vec<(usize, f64)> {
    let p = array(&at.file(&format!("out/frames/{frame:04}/p.npy")));
    let cell = |i: usize, j: usize, k: usize| (k * 10 + j) * 10 + i;
    let pairs = || (0..10).flat_map(|b| (0..10).map(move |a| (a, b)));
    let (x, y) = (pairs().map(|(a, b)| cell(i, a, b)), pairs().map(|(a, b)| cell(a, j, b)));
    let all = x.chain(y).chain(pairs().map(|(a, b)| cell(a, b, k)));
    all.map(|cell| (cell, (p[cell] - 1e5) / 1e3)).collect()
}

/// What the run kept of a frame.
fn kept(at: &Scratch, frame: usize) -> Vec<f64> {
    let both = array(&at.file(&format!("out/frames/slices/{frame:04}.npy")));
    both[both.len() / 2..].to_vec()
}

/// Width and height of a PNG.
fn size(at: &Scratch, frame: usize) -> Vec<u8> {
    fs::read(at.file(&format!("out/frames/pressure_{frame:04}.png"))).expect("a picture")[16..24].to_vec()
}

#[test]
fn they_show_the_blast_through_its_middle() {
    let at = Scratch::new();
    let said = stdout(&solved(&at, BLAST, "out", &[]));
    // A cell of the region begins above the ambient pressure.
    let start = array(&at.file("out/frames/0000/p.npy"));
    let mut outside = [0.0, 0.0];
    for frame in 0..4 {
        let drawn = planes(&at, frame, [3, 7, 2]);
        assert!(drawn.iter().map(|(_, p)| *p).eq(kept(&at, frame)), "frame {frame} is cut elsewhere");
        let beside = drawn.iter().filter(|(cell, _)| start[*cell] < 1e5 + 1e-3);
        outside = beside.fold(outside, |[low, high]: [f64; 2], (_, p)| [low.min(*p), high.max(*p)]);
        assert_eq!(size(&at, 0), size(&at, frame));
    }
    let colours = &json(&at.file("out/report.json"))["colours"];
    assert_eq!(colours["overpressure"], serde_json::json!(outside));
    assert!(outside[1] > 20.0 && outside[1] < 500.0, "{outside:?}");
    assert!(
        said.contains("\ncolours       speed 0 to ") && said.contains("kPa, that outside the starting regions\n"),
        "{said}"
    );
}

#[test]
fn a_case_may_say_otherwise() {
    let at = Scratch::new();
    let case = BLAST.replace("every", "slice = [0.55, 0.55, 0.55]\nrange = { overpressure = [-10, 90] }\nevery");
    let said = stdout(&solved(&at, &case, "out", &[]));
    assert!(planes(&at, 1, [5, 5, 5]).iter().map(|(_, p)| *p).eq(kept(&at, 1)));
    assert_eq!(json(&at.file("out/report.json"))["colours"]["overpressure"], serde_json::json!([-10.0, 90.0]));
    assert!(said.contains("overpressure −10 to 90 kPa\n"), "{said}");
}

/// Along axes on which the region has no ends, and without a region above the ambient pressure, the cut stays in the middle; what lies outside is moved into the grid.
#[test]
fn regions_without_a_middle() {
    for (region, at_cell) in [
        ("min = [0.2, -inf], max = [0.3, inf], p = 8e5", [2, 5, 5]),
        ("center = [0.35, 0.75, 0.25], radius = 0.15, u = 9", [5, 5, 5]),
        ("center = [0.5, 0.5, -0.05], radius = 0.2, p = 8e5", [5, 5, 0]),
    ] {
        let at = Scratch::new();
        let case = BLAST.replace("center = [0.35, 0.75, 0.25], radius = 0.15, p = 8e5", region);
        solved(&at, &case.replace("end = 6e-4", "max_steps = 1"), "out", &["-q"]);
        assert!(planes(&at, 1, at_cell).iter().map(|(_, p)| *p).eq(kept(&at, 1)), "{region}");
    }
}

/// A small cell merged with one of the region begins with its pressure: a bar beside the ball, thinner than a cell, does not set the colours.
#[test]
fn merged_cells_of_the_region_do_not_set_the_colours() {
    let at = Scratch::new();
    let bar = "[[solid]]\nshape = \"box\"\nmin = [0, 0.605, 0]\nmax = [1, 0.79, 1]\n";
    fs::write(at.file("bar.toml"), bar).expect("a scene");
    let region = "center = [0.35, 0.45, 0.25], radius = 0.15, p = 8e5";
    let case = BLAST.replace("center = [0.35, 0.75, 0.25], radius = 0.15, p = 8e5", region);
    let case =
        case.replace("end = 6e-4", "max_steps = 1").replace("[output]", "[porosity]\nscene = \"bar.toml\"\n[output]");
    let said = stdout(&solved(&at, &case, "out", &[]));
    assert!(!said.contains(" 0 merged"), "{said}");
    let colours = &json(&at.file("out/report.json"))["colours"]["overpressure"];
    // The first step carries less than a tenth of 700 kPa into the cells beside the region.
    assert!(colours[1].as_f64().is_some_and(|high| high > 0.0 && high < 70.0), "{colours}");
}

/// Two gases have pictures of γ; where there is one gas, none are left of a run before.
#[test]
fn gamma_of_two_gases_is_drawn() {
    let at = Scratch::new();
    let names = |at: &Scratch| -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(at.file("out/frames"))
            .expect("frames")
            .map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned())
            .filter(|name| name.starts_with("gamma_"))
            .collect();
        names.sort();
        names
    };
    let case = BLAST.replace("end = 6e-4", "max_steps = 1");
    solved(&at, &case.replace("p = 8e5", "p = 8e5, gamma = 1.25"), "out", &["-q"]);
    assert_eq!(names(&at), ["gamma_0000.png", "gamma_0001.png"]);
    let drawn = fs::read(at.file("out/frames/gamma_0000.png")).expect("a picture");
    assert_ne!(drawn, fs::read(at.file("out/frames/pressure_0000.png")).expect("a picture"));
    solved(&at, &case, "out", &["-q", "--force"]);
    assert!(names(&at).is_empty());
}

/// A run that goes on with pictures cut elsewhere: those of before stay what they are, and are not drawn again as if they were cut there.
#[test]
fn pictures_of_before_keep_their_planes() {
    let at = Scratch::new();
    let case = BLAST.replace("end = 6e-4", "max_steps = 2");
    let picture = |frame: &str| fs::read(at.file(&format!("out/frames/pressure_{frame}.png"))).expect("a picture");
    solved(&at, &case, "out", &["-q"]);
    let before = picture("0000");
    let moved = BLAST.replace("every", "slice = [0.85, 0.15, 0.85]\nevery");
    let told = stderr(&solved(&at, &moved, "out", &["--resume"]));
    assert!(told.contains("pictures are cut elsewhere than before --resume: those up to t = "), "{told}");
    assert_eq!(before, picture("0000"));
    let frames = json(&at.file("out/report.json"))["frames"].as_array().expect("frames").len();
    assert!(planes(&at, frames - 1, [8, 1, 8]).iter().map(|(_, p)| *p).eq(kept(&at, frames - 1)));
    assert!(!at.file("out/frames/slices/0000.npy").exists());
    // Cut where they were, all are drawn with one range.
    solved(&at, &case, "out", &["-q", "--force"]);
    let told = stderr(&solved(&at, BLAST, "out", &["--resume"]));
    assert!(!told.contains("cut elsewhere") && before != picture("0000"), "{told}");
}

/// Colours that the case gives since it went on are those of all frames.
#[test]
fn ranges_given_later_hold_for_all_frames() {
    let at = Scratch::new();
    let given = BLAST.replace("every", "range = { speed = [0, 300], overpressure = [-10, 90] }\nevery");
    let first = |dir: &str| fs::read(at.file(dir).join("frames/pressure_0000.png")).expect("a picture");
    solved(&at, &given, "given", &["-q"]);
    solved(&at, &BLAST.replace("end = 6e-4", "max_steps = 2"), "later", &["-q"]);
    assert_ne!(first("given"), first("later"));
    solved(&at, &given, "later", &["-q", "--resume"]);
    assert_eq!(first("given"), first("later"));
}
