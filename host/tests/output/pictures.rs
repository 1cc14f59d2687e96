//! Pictures: where cells, slices and text stand.

use std::fs;
use std::path::Path;

use super::{Dir, indices, porosity, uniform};
use voidage::picture::canvas::{Canvas, INK, WHITE};
use voidage::picture::colour::{ColourMap, NO_VALUE};
use voidage::picture::figure::Figure;
use voidage::picture::heatmap::{Area, EdgeAxis, Heatmap};
use voidage::picture::png;

fn decoded(path: &Path) -> (usize, usize, Vec<[u8; 3]>) {
    let mut reader = ::png::Decoder::new(std::io::BufReader::new(fs::File::open(path).unwrap())).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!((info.color_type, info.bit_depth), (::png::ColorType::Rgb, ::png::BitDepth::Eight));
    let pixels = bytes.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
    (info.width as usize, info.height as usize, pixels)
}

#[test]
fn a_heatmap_puts_each_cell_where_its_edges_are() {
    let (across, up) = ([10.0, 11.0, 14.0], [0.0, 2.0, 3.0]); // 1 : 3 and 2 : 1
    let map = ColourMap::sequential();
    let value = |a: usize, b: usize| if (a, b) == (1, 1) { f64::NAN } else { 0.25 + 0.25 * (a + 2 * b) as f64 };
    let axis = |edges| EdgeAxis { name: "x", unit: "m", edges };
    let area = Area { x: 100, y: 50, width: 400, height: 300 };
    let mut canvas = Canvas::new(600, 500);
    let range = [0.0, 1.0];
    Heatmap { across: axis(&across), up: axis(&up), value: &value, range, map: &map, title: "t" }
        .draw(&mut canvas, area);
    // Left column 100 pixels wide, lower row 200 pixels high.
    for (x, y, colour) in [
        (150, 250, map.colour(0.25)),
        (198, 348, map.colour(0.25)),
        (202, 348, map.colour(0.5)),
        (198, 147, map.colour(0.75)),
        (300, 100, NO_VALUE),
        (99, 200, INK),
        (500, 200, INK),
        (300, 49, INK),
        (300, 350, INK),
        (590, 490, WHITE),
    ] {
        assert_eq!(canvas.get(x, y), colour, "pixel {x}, {y}");
    }
    assert!((100..500).any(|x| (362..380).any(|y| canvas.get(x, y) != WHITE)), "numbers below");
    assert!((40..90).any(|x| (60..340).any(|y| canvas.get(x, y) != WHITE)), "numbers to the left");
}

#[test]
fn slices_show_the_blocked_cell_in_its_corner() {
    let dir = Dir::new("png");
    let path = dir.file("beta.png");
    png::slices(&path, "one of four", &uniform(2), &uniform(2), &uniform(1), "m", &[0.0, 1.0, 1.0, 1.0]).unwrap();
    let (width, height, pixels) = decoded(&path);
    assert!((800..2000).contains(&width) && (600..1400).contains(&height), "{width} x {height}");
    let map = ColourMap::sequential();
    let places = |value: f64| {
        let found = pixels.iter().enumerate().filter(|(_, p)| **p == map.colour(value)).map(|(n, _)| n);
        found.map(|n| (n % width, n / width)).collect::<Vec<_>>()
    };
    let (blocked, open) = (places(0.0), places(1.0));
    assert!(blocked.len() > 100_000, "{} pixels", blocked.len());
    let ratio = open.len() as f64 / blocked.len() as f64;
    assert!((ratio - 3.0).abs() < 0.03, "three cells are open: {ratio}");
    let centre = |all: &[(usize, usize)]| {
        let n = all.len();
        (all.iter().map(|p| p.0).sum::<usize>() / n, all.iter().map(|p| p.1).sum::<usize>() / n)
    };
    let ((bx, by), (ox, oy)) = (centre(&blocked), centre(&open));
    assert!(bx + 200 < ox && by > oy + 200, "low x is left, low y is down");
}

/// Cells that are wholly open, or hold nothing, have a colour of their own, which has a field in the bar beside the number that it stands for.
#[test]
fn colours_of_their_own_have_a_field_in_the_bar() {
    let edges = [&uniform(4)[..], &uniform(4), &uniform(4)];
    let lightest = ColourMap::sequential().colour(1.0);
    let half = [0.5; 64];
    for canvas in [
        png::picture("", edges, "m", &half, [None; 3]),
        png::picture_of(("a_x, 1/m", &half), "", edges, "m", [None; 3]),
    ] {
        let canvas = canvas.unwrap();
        let (width, height) = canvas.size();
        let pixels =
            || (0..width * height).map(|n| (n % width, n / width)).filter(|&(x, y)| canvas.get(x, y) == lightest);
        let rows: std::collections::BTreeSet<usize> = pixels().map(|(_, y)| y).collect();
        let columns: std::collections::BTreeSet<usize> = pixels().map(|(x, _)| x).collect();
        assert!(rows.len() >= 15 && columns.len() >= 15, "{} x {} pixels", columns.len(), rows.len());
    }
    // Between the ends the colours of the bar are those of the cells.
    for map in [ColourMap::open_fraction(), ColourMap::density(), ColourMap::sequential()] {
        for share in [0.01, 0.2, 0.5, 0.8, 0.99] {
            let far = map.between(share).iter().zip(map.colour(share)).map(|(a, b)| a.abs_diff(b)).max();
            assert!(far <= Some(3), "{share}: {far:?}");
        }
    }
    let map = ColourMap::density();
    assert!(map.colour(1e-6) == map.between(0.0) && map.colour(0.0) == lightest && map.colour(1e-6) != lightest);
}

#[test]
fn pictures_of_any_shape_stay_on_a_readable_sheet() {
    let dir = Dir::new("png-shapes");
    let far = |n: usize, low: f64, size: f64| (0..=n).map(|i| low + size * i as f64).collect::<Vec<f64>>();
    let grids = [
        [uniform(6), uniform(6), uniform(6)],
        [far(200, -3.0, 0.5), uniform(9), uniform(8)],
        [uniform(2), uniform(3), far(500, 0.0, 4.0)],
        [uniform(1), uniform(1), uniform(1)],
        [far(50, 0.0, 1e-9), far(4, 1e7, 1.0), far(5, -1e12, 1e10)],
        [far(3, 1e15, 0.125), uniform(2), uniform(2)],
    ];
    for (n, [x, y, z]) in grids.iter().enumerate() {
        let path = dir.file(&format!("{n}.png"));
        let beta = porosity((x.len() - 1) * (y.len() - 1) * (z.len() - 1), 9);
        let title = "a title that is long, ".repeat(if n == 3 { 40 } else { 1 });
        png::slices(&path, &title, x, y, z, "", &beta).unwrap();
        let (width, height, pixels) = decoded(&path);
        assert!((500..=2000).contains(&width) && (250..=1500).contains(&height), "{n}: {width} x {height}");
        let paper = pixels.iter().filter(|p| **p == WHITE).count();
        assert!(paper * 20 > pixels.len(), "{n}: there is a margin");
    }
}

#[test]
fn pictures_refuse_what_does_not_fit() {
    let dir = Dir::new("png-bad");
    let path = dir.file("out.png");
    let edges = uniform(2);
    let draw = |x: &[f64], beta: &[f64]| png::slices(&path, "", x, &edges, &edges, "m", beta).expect_err("bad").reason;
    assert!(draw(&edges, &[1.0; 7]).contains("length"));
    assert!(draw(&[0.0, 2.0, 1.0], &[1.0; 8]).contains("do not ascend"));
    assert!(draw(&[0.0, f64::NAN, 1.0], &[1.0; 8]).contains("do not ascend"));
    assert!(draw(&[], &[]).contains("length"));
    assert_eq!(dir.names(), Vec::<String>::new());
}

#[test]
fn figures_of_other_fields_and_of_uniform_or_missing_values() {
    let edges = [&uniform(3)[..], &uniform(3), &uniform(3)];
    let map = &ColourMap::diverging();
    let figure = |values, range| {
        let (title, note, unit, at, name) = ("u", "step 12", "m", [1, 1, 1], "u [m/s]");
        Figure { title, moment: "", note, edges, unit, values, at, name, range, ends: ["", ""], told: [true; 2], map }
            .draw()
    };
    let has = |canvas: &Canvas, colour| {
        let (width, height) = canvas.size();
        (0..width * height).filter(|n| canvas.get(n % width, n / width) == colour).count() > 10_000
    };
    let uniform = figure(&[300.0; 27], [300.0, 300.0]).unwrap();
    assert!(has(&uniform, map.colour(0.5)));
    let missing = figure(&[f64::NAN; 27], [f64::NAN, f64::NAN]).unwrap();
    assert!(has(&missing, NO_VALUE));
    let low = figure(&[-7.5; 27], [-7.5, 7.5]).unwrap();
    assert!(has(&low, map.colour(0.0)));
    let whole = Figure {
        title: "",
        moment: "",
        note: "",
        edges,
        unit: "",
        values: &[0.0; 27],
        at: [2; 3],
        name: "",
        range: [0.0, 1.0],
        ends: ["", ""],
        told: [true; 2],
        map,
    };
    assert!(whole.draw().is_ok());
    assert!(Figure { at: [0, 3, 0], ..whole }.draw().is_err(), "a slice outside");
    assert!(Figure { values: &[0.0; 26], ..whole }.draw().is_err(), "a value too few");
}

#[test]
fn each_panel_shows_its_own_slice() {
    let (two, three, four) = (uniform(2), uniform(3), uniform(4));
    let map = &ColourMap::sequential();
    for axis in 0..3 {
        for at in 0..2 {
            // Open are the cells of one slice: that whole panel, and a strip of the two others.
            let open = |(i, j, k, _): (usize, usize, usize, usize)| f64::from([i, j, k][axis] == at);
            let values: Vec<f64> = indices(2, 3, 4, 1).map(open).collect();
            let [areas_of_panels, strips] =
                [[12.0, 8.0, 6.0], [[0.0, 4.0, 3.0], [4.0, 0.0, 2.0], [3.0, 2.0, 0.0]][axis]];
            let mut where_cut = [1, 2, 3];
            where_cut[axis] = at;
            let figure = Figure {
                title: "",
                moment: "",
                note: "",
                edges: [&two, &three, &four],
                unit: "m",
                values: &values,
                at: where_cut,
                name: "",
                range: [0.0, 1.0],
                ends: ["", ""],
                told: [true; 2],
                map,
            };
            let canvas = figure.draw().unwrap();
            let (width, height) = canvas.size();
            let count =
                |colour| (0..width * height).filter(|n| canvas.get(n % width, n / width) == colour).count() as f64;
            let share = count(map.colour(1.0)) / (count(map.colour(0.0)) + count(map.colour(1.0)));
            let expected = (areas_of_panels[axis] + strips.iter().sum::<f64>()) / areas_of_panels.iter().sum::<f64>();
            assert!((share - expected).abs() < 0.01, "axis {axis} at {at}: {share}, not {expected}");
        }
    }
}

#[test]
fn turned_text_reads_upwards() {
    use voidage::picture::canvas::Style;
    let mut canvas = Canvas::new(100, 100);
    canvas.text(50.5, 50.5, "L", Style { height: 20.0, turned: true, ..Style::default() });
    let [stem, foot, right, below] = [(34, 50), (50, 43), (58, 50), (50, 58)].map(|(x, y)| canvas.get(x, y) != WHITE);
    assert_eq!([stem, foot, right, below], [true, true, false, false]);
}

#[test]
fn text_stays_inside_its_measure() {
    use voidage::picture::canvas::{Style, text_width};
    for text in ["beta_v = 0.25", "x [m]", "WMwm|#@", "é→漢"] {
        let mut canvas = Canvas::new(400, 60);
        let (left, base) = (50.0, 40.0);
        canvas.text(left, base, text, Style { height: 20.0, ..Style::default() });
        let inked = |x: usize| (0..60).any(|y| canvas.get(x, y) != WHITE);
        let first = (0..400).find(|x| inked(*x)).expect("visible");
        let last = (0..400).rfind(|x| inked(*x)).expect("visible");
        assert!(first >= 46 && last as f64 <= left + text_width(text, 20.0) + 2.0, "{text}: {first}..={last}");
        assert!((0..400).all(|x| canvas.get(x, 59) == WHITE && canvas.get(x, 5) == WHITE), "{text}");
    }
}
