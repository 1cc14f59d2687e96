//! How time grows with what a scene has more of: `growth [FAMILY]`. Prints, for sizes that double, seconds of processor time on one thread, the
//! exponent of each step and of the whole row, and the largest gap of the bounds.

use glam::DVec3;
use voidage::geometry::bodies::Bodies;
use voidage::geometry::mesh::Mesh;
use voidage::grid::Edges;
use voidage::porosity::{Options, Porosity, porosity};
use voidage_tests::random::Random;
use voidage_tests::solids::{Triangle, cuboid, scene, sphere, turned_box};

/// What is measured, from a size: a scene and a grid.
type Make = fn(usize) -> (Bodies, Edges);

/// A family: its name, its sizes, and what it makes.
type Family = (&'static str, &'static [usize], Make);

const FAMILIES: [Family; 11] = [
    ("wedges", &[100, 200, 400, 800, 1600, 3200, 10_000], wedges),
    ("boxes-shifted", &[100, 200, 400, 800, 1600], boxes_shifted),
    ("boxes-turned", &[100, 200, 400, 800], boxes_turned),
    ("spheres", &[50, 100, 200, 400], spheres),
    ("bodies", &[1000, 8000, 64_000], bodies),
    ("triangles", &[8, 16, 32, 64, 128, 256], triangles),
    ("layers", &[250, 500, 1000, 2000, 4000], layers),
    ("porosities", &[125, 250, 500, 1000], porosities),
    ("offset", &[1, 1 << 8, 1 << 16, 1 << 23], offset),
    ("tube", &[25, 50, 100, 200], tube),
    ("one-layer", &[1000, 4000, 16_000], one_layer),
];

fn even(lo: f64, hi: f64, cells: [usize; 3]) -> Edges {
    let axis = |n: usize| (0..=n).map(|i| lo + (hi - lo) * i as f64 / n as f64).collect();
    Edges(cells.map(axis))
}

/// Thin wedges around the z axis that share it.
fn wedges(count: usize) -> (Bodies, Edges) {
    let wedge = |n: usize| {
        let at = |n: f64| {
            let angle = std::f64::consts::TAU * n / count as f64;
            DVec3::new(angle.cos(), angle.sin(), 0.0)
        };
        let (a, b) = (at(n as f64), at(n as f64 + 0.9));
        let (o, up) = (DVec3::new(0.0, 0.0, -0.5), DVec3::Z);
        let (a, b) = (a + o, b + o);
        vec![
            [o, b, a],
            [o + up, a + up, b + up],
            [o, a, a + up],
            [o, a + up, o + up],
            [a, b, b + up],
            [a, b + up, a + up],
            [b, o, o + up],
            [b, o + up, b + up],
        ]
    };
    (scene(&(0..count).map(wedge).collect::<Vec<_>>()), even(-1.05, 1.05, [3, 3, 2]))
}

/// Boxes of one size in nearly one place.
fn boxes_shifted(count: usize) -> (Bodies, Edges) {
    let mut rng = Random::new(3);
    let one = |_| {
        let lo = rng.point(DVec3::ZERO, DVec3::splat(0.1));
        cuboid(lo, lo + 0.8)
    };
    (scene(&(0..count).map(one).collect::<Vec<_>>()), even(-0.05, 0.95, [2, 2, 2]))
}

/// Boxes of one centre, turned anyhow.
fn boxes_turned(count: usize) -> (Bodies, Edges) {
    let mut rng = Random::new(4);
    let one = |_| turned_box(DVec3::splat(0.01), DVec3::new(0.5, 0.4, 0.3), rng.turn());
    (scene(&(0..count).map(one).collect::<Vec<_>>()), even(-0.75, 0.75, [2, 2, 2]))
}

/// Balls 1e-7 apart.
fn spheres(count: usize) -> (Bodies, Edges) {
    let mut rng = Random::new(5);
    let one = |_| sphere(rng.point(DVec3::ZERO, DVec3::splat(1e-7)), 0.5, 4);
    (scene(&(0..count).map(one).collect::<Vec<_>>()), even(-0.55, 0.55, [8, 8, 8]))
}

/// Small boxes apart from each other.
fn bodies(count: usize) -> (Bodies, Edges) {
    let side = (count as f64).cbrt().round() as usize;
    let at = |n: usize| DVec3::new((n % side) as f64, (n / side % side) as f64, (n / side / side) as f64);
    let solids: Vec<_> = (0..count).map(|n| cuboid(at(n) + 0.2, at(n) + 0.7)).collect();
    (scene(&solids), even(0.0, side as f64, [32, 32, 32]))
}

/// One ball of ever more triangles.
fn triangles(frequency: usize) -> (Bodies, Edges) {
    (scene(&[sphere(DVec3::splat(0.01), 0.9, frequency)]), even(-1.0, 1.0, [20, 20, 20]))
}

/// Tall boxes through ever more layers.
fn layers(count: usize) -> (Bodies, Edges) {
    let tall = |n| cuboid(DVec3::new(f64::from(n) * 0.01, 0.1, 0.0), DVec3::new(f64::from(n) * 0.01 + 0.006, 0.9, 1.0));
    (scene(&(0..100).map(tall).collect::<Vec<_>>()), even(0.0, 1.0, [8, 8, count]))
}

/// Boxes each of its own porosity.
fn porosities(count: usize) -> (Bodies, Edges) {
    let mut rng = Random::new(6);
    let one = |_| {
        let lo = rng.point(DVec3::ZERO, DVec3::splat(0.9));
        cuboid(lo, lo + 0.1)
    };
    let mut made = scene(&(0..count).map(one).collect::<Vec<_>>());
    for (n, body) in made.bodies.iter_mut().enumerate() {
        body.porosity = n as f64 / count as f64;
    }
    (made, even(0.0, 1.0, [32, 32, 32]))
}

/// A ball ever farther from the origin.
fn offset(far: usize) -> (Bodies, Edges) {
    let at = DVec3::splat(far as f64);
    let Edges(edges) = even(-1.0, 1.0, [20, 20, 20]);
    let edges = edges.map(|axis| axis.into_iter().map(|e| e + far as f64).collect());
    (scene(&[sphere(at, 0.9, 64)]), Edges(edges))
}

/// A tube bent to a figure of eight, which crosses itself; one file, whose shells are looked for.
fn tube(along: usize) -> (Bodies, Edges) {
    let around = 16;
    let point = |i: usize, j: usize| {
        let (s, t) = (i as f64 / along as f64, j as f64 / around as f64);
        let [s, t] = [s, t].map(|x| x * std::f64::consts::TAU);
        let middle = DVec3::new(s.sin(), s.sin() * s.cos(), 0.02 * s.cos());
        let ahead = DVec3::new(s.cos(), (2.0 * s).cos(), -0.02 * s.sin()).normalize();
        let side = ahead.cross(DVec3::Z).normalize();
        middle + (side * t.cos() + side.cross(ahead) * t.sin()) * 0.1
    };
    let mut surface: Vec<Triangle> = Vec::new();
    for i in 0..along {
        for j in 0..around {
            let (k, l) = ((i + 1) % along, (j + 1) % around);
            surface.push([point(i, j), point(i, l), point(k, l)]);
            surface.push([point(i, j), point(k, l), point(k, j)]);
        }
    }
    let mut made = Bodies::default();
    made.add(&Mesh { name: "tube".into(), ..Mesh::from(surface) }, 1.0).expect("a tube has an area");
    (made, even(-1.2, 1.2, [20, 20, 8]))
}

/// A grid of one layer.
fn one_layer(count: usize) -> (Bodies, Edges) {
    let mut rng = Random::new(7);
    let one = |_| {
        let lo = rng.point(DVec3::ZERO, DVec3::splat(0.95));
        cuboid(lo, lo + 0.02)
    };
    (scene(&(0..count).map(one).collect::<Vec<_>>()), even(0.0, 1.0, [200, 200, 1]))
}

/// Seconds of processor time that this process has taken, in steps of 0.01 s.
fn processor_time() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").expect("Linux");
    let after_name = stat.rsplit_once(')').map_or("", |(_, rest)| rest);
    let ticks: Vec<f64> = after_name.split_whitespace().skip(11).take(2).filter_map(|t| t.parse().ok()).collect();
    ticks.iter().sum::<f64>() / 100.0
}

fn measured(make: Make, size: usize) -> (f64, Porosity) {
    // What reading and repair cost counts as well as the fields.
    let begin = processor_time();
    let (bodies, edges) = make(size);
    let grid = edges.grid(None).expect("a grid");
    let found = porosity(&grid, &bodies, Options { bounds: true, ..Options::default() });
    (processor_time() - begin, found)
}

fn main() {
    let wanted = std::env::args().nth(1);
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
    for (name, sizes, make) in FAMILIES.into_iter().filter(|f| wanted.as_deref().is_none_or(|name| name == f.0)) {
        println!("{name}");
        let mut before: Vec<(f64, f64)> = Vec::new();
        for &size in sizes {
            let (seconds, found) = one_thread.install(|| measured(make, size));
            let exponent = |&(n, t): &(f64, f64)| (seconds / t).ln() / (size as f64 / n).ln();
            // Below a few steps of the clock an exponent says nothing.
            let text = |from: Option<&(f64, f64)>| {
                from.filter(|(_, t)| *t >= 0.05).map_or("      ".into(), |from| format!("n^{:.2}", exponent(from)))
            };
            println!(
                "{size:>9}: {seconds:>8.2} s  step {}  whole {}  gap {:.1e}",
                text(before.last()),
                text(before.iter().find(|(_, t)| *t >= 0.05)),
                found.max_gap
            );
            before.push((size as f64, seconds));
        }
    }
}
