//! Scene files: placed solids against meshes, copies against repeats, porous solids against counting.

use glam::{DMat3, DVec3};
use std::fmt::Write;
use std::path::Path;
use voidage::geometry::bodies::Bodies;
use voidage::geometry::scene;
use voidage::grid::Edges;
use voidage::porosity::{FieldSet, Method, Options, Porosity, porosity};
use voidage_tests::fields::assert_close;
use voidage_tests::random::Random;
use voidage_tests::solids;

fn bodies(text: &str) -> Bodies {
    let scene = scene::parse(Path::new("scene.toml"), text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let mut bodies = Bodies::default();
    scene::load::add(&scene, &mut bodies).unwrap_or_else(|e| panic!("{e}\n{text}"));
    bodies
}

fn edges(cells: [usize; 3], size: f64) -> Edges {
    Edges(cells.map(|n| (0..=n).map(|i| size * i as f64 / n as f64).collect()))
}

fn run(edges: &Edges, bodies: &Bodies) -> Porosity {
    let options = Options { bounds: true, ..Options::default() };
    porosity(&edges.grid(None).expect("a grid"), bodies, options)
}

fn solid(shape: &str, more: &str) -> String {
    format!("[[solid]]\nname = \"s\"\nshape = \"{shape}\"\n{more}\n")
}

/// Every digit.
fn list(p: DVec3) -> String {
    format!("[{:?}, {:?}, {:?}]", p.x, p.y, p.z)
}

#[test]
fn a_box_is_its_mesh_to_the_bit() {
    let edges = edges([7, 9, 11], 1.0);
    let (min, max) = (DVec3::new(0.11, 0.2, 0.33), DVec3::new(0.75, 5.0 / 9.0, 0.9));
    let text = solid("box", &format!("min = {}\nmax = {}", list(min), list(max)));
    let mesh = solids::scene(&[solids::cuboid(min, max)]);
    assert!(run(&edges, &bodies(&text)) == run(&edges, &mesh));
}

#[test]
fn a_turned_box_is_its_turned_mesh() {
    let edges = edges([7, 9, 11], 1.0);
    let mut rng = Random::new(11);
    for _ in 0..50 {
        let center = rng.point(DVec3::splat(0.35), DVec3::splat(0.65));
        let half = rng.point(DVec3::splat(0.02), DVec3::splat(0.3));
        let axis = rng.vector::<DVec3>(3.0);
        let degrees = rng.between(-720.0, 720.0);
        let turn = DMat3::from_axis_angle(axis.normalize(), degrees.to_radians());
        let (min, max) = (center - half, center + half);
        let place = format!("rotate = {{ axis = {}, angle = {degrees:?} }}", list(axis));
        let text = solid("box", &format!("min = {}\nmax = {}\n{place}", list(min), list(max)));
        let (found, mesh) = (bodies(&text), solids::scene(&[solids::turned_box(center, half, turn)]));
        assert_close(&run(&edges, &found).beta, &run(&edges, &mesh).beta, 1e-11, &text);
        let corners: Vec<String> = solids::cuboid(min, max).iter().flatten().map(|&p| list(p)).collect();
        let hull = bodies(&solid("hull", &format!("points = [{}]\n{place}", corners.join(", "))));
        assert_close(&run(&edges, &hull).beta, &run(&edges, &found).beta, 1e-11, &text);
    }
}

/// A brick turned by quarters about each axis stays a brick with walls in the planes of the grid.
#[test]
fn quarter_turns_are_exact() {
    let edges = edges([8, 8, 8], 8.0);
    for (axis, size) in [("x", [2.0, 6.0, 4.0]), ("y", [6.0, 4.0, 2.0]), ("z", [4.0, 2.0, 6.0])] {
        for angle in ["90", "-90", "270", "-630"] {
            let place = format!("rotate = {{ axis = \"{axis}\", angle = {angle} }}");
            let turned = solid("box", &format!("min = [3, 2, 1]\nmax = [5, 6, 7]\n{place}"));
            let half = DVec3::from_array(size) * 0.5;
            let (min, max) = (DVec3::splat(4.0) - half, DVec3::splat(4.0) + half);
            let plain = solid("box", &format!("min = {}\nmax = {}", list(min), list(max)));
            assert!(run(&edges, &bodies(&turned)).beta == run(&edges, &bodies(&plain)).beta, "{axis} {angle}");
        }
    }
}

#[test]
fn an_array_is_its_copies_to_the_bit() {
    let edges = edges([13, 12, 11], 4.0);
    let (translate, step) = (DVec3::new(0.1, 0.2, 0.3), DVec3::new(0.7, 1.1, 1.3));
    let shapes = [
        ("box", "min = [0, 0, 0]\nmax = [0.9, 0.6, 0.5]"),
        ("hull", "points = [[0, 0, 0], [0.9, 0, 0], [0, 0.9, 0.1], [0.2, 0, 0.8], [0.5, 0.5, 0.9]]"),
    ];
    for (shape, keys) in shapes {
        let turned = format!("{keys}\nporosity = 0.125\nrotate = {{ axis = [1, 2, 3], angle = 33 }}");
        let array = format!("array = {{ count = [3, 2, 2], step = {} }}", list(step));
        let array = solid(shape, &format!("{turned}\n{array}\ntranslate = {}", list(translate)));
        let mut copies = String::new();
        for n in 0..12 {
            let at = DVec3::new((n % 3) as f64, (n / 3 % 2) as f64, (n / 6) as f64);
            copies += &solid(shape, &format!("{turned}\ntranslate = {}", list(translate + at * step)));
        }
        let (array, copies) = (bodies(&array), bodies(&copies));
        assert_eq!(array.triangles, copies.triangles);
        assert!(run(&edges, &array) == run(&edges, &copies));
        assert_eq!(array.bodies[7].name, "s[1,0,1]");
    }
}

#[test]
fn moved_by_whole_numbers_with_the_grid_changes_nothing() {
    let shift = DVec3::new(16.0, -32.0, 64.0);
    let here = edges([6, 5, 4], 4.0);
    let there = Edges([0, 1, 2].map(|a| here.0[a].iter().map(|c| c + shift[a]).collect()));
    let keys = "min = [0.25, 0.5, 1]\nmax = [3.25, 2.5, 2.125]";
    let moved = solid("box", &format!("{keys}\ntranslate = {}", list(shift)));
    assert_close(&run(&there, &bodies(&moved)).beta, &run(&here, &bodies(&solid("box", keys))).beta, 1e-14, "moved");
}

/// A box on whole numbers.
struct Brick {
    min: [usize; 3],
    max: [usize; 3],
    porosity: f64,
}

impl Brick {
    fn random(rng: &mut Random, size: usize, porosities: &[f64]) -> Self {
        let mut brick = Brick { min: [0; 3], max: [0; 3], porosity: porosities[rng.below(porosities.len())] };
        for axis in 0..3 {
            brick.min[axis] = rng.below(size);
            brick.max[axis] = brick.min[axis] + 1 + rng.below(size - brick.min[axis]);
        }
        brick
    }

    fn holds(&self, cube: [usize; 3]) -> bool {
        (0..3).all(|a| self.min[a] <= cube[a] && cube[a] < self.max[a])
    }
}

/// Open fraction of unit cube `cube`; 1 outside of the bricks.
fn open(bricks: &[Brick], cube: [usize; 3]) -> f64 {
    bricks.iter().filter(|b| b.holds(cube)).fold(1.0, |least, b| least.min(b.porosity))
}

/// Fields on cells of `coarse` unit cubes along each axis, by counting.
fn counted(bricks: &[Brick], cells: usize, coarse: usize) -> FieldSet {
    let inside = |n: usize| 0..n;
    let grid = edges([cells; 3], (cells * coarse) as f64);
    let mut set = FieldSet::new(&grid.grid(None).expect("a grid"), true);
    let volume = (coarse * coarse * coarse) as f64;
    let at = |cell: [usize; 3], part: [usize; 3]| [0, 1, 2].map(|a| cell[a] * coarse + part[a]);
    let parts: Vec<[usize; 3]> =
        (0..coarse.pow(3)).map(|n| [n % coarse, n / coarse % coarse, n / (coarse * coarse)]).collect();
    for n in inside(cells.pow(3)) {
        let cell = [n % cells, n / cells % cells, n / (cells * cells)];
        set.v[n] = parts.iter().map(|&p| open(bricks, at(cell, p))).sum::<f64>() / volume;
    }
    for (axis, field) in [&mut set.x, &mut set.y, &mut set.z].into_iter().enumerate() {
        let shape = [0, 1, 2].map(|a| cells + usize::from(a == axis));
        for n in inside(shape.iter().product()) {
            let face = [n % shape[0], n / shape[0] % shape[1], n / (shape[0] * shape[1])];
            let facets = parts.iter().filter(|p| p[axis] == 0);
            let both = |p: &[usize; 3]| {
                let above = at(face, *p);
                let below = (above[axis] > 0).then(|| [0, 1, 2].map(|a| above[a] - usize::from(a == axis)));
                open(bricks, above).min(below.map_or(1.0, |b| open(bricks, b)))
            };
            field[n] = facets.map(both).sum::<f64>() / (coarse * coarse) as f64;
        }
    }
    set
}

/// Porous and solid bricks that overlap at random, in cells that cut them or not: every value is the mean of the least porosities. Of many porosities,
/// most change a small part of the grid.
#[test]
fn porous_solids_are_counted_by_their_least_porosity() {
    let mut rng = Random::new(5);
    let (mut shared, mut several) = (0, 0);
    let many: Vec<f64> = (1..40).map(|n| f64::from(n) / 41.0).collect();
    for round in 0..120 {
        let porosities: &[f64] = [&[0.0, 0.6][..], &[0.0, 0.25, 0.6, 1.0], &[0.3, 0.7], &[0.5], &many][round % 5];
        let is_small = porosities == many && rng.below(3) > 0;
        let count = if is_small { 3 + rng.below(12) } else { 1 + rng.below(6) };
        let mut bricks: Vec<Brick> = (0..count).map(|_| Brick::random(&mut rng, 6, porosities)).collect();
        if is_small {
            bricks.iter_mut().for_each(|b| (0..3).for_each(|a| b.max[a] = b.max[a].min(b.min[a] + 2)));
            several += 1;
        }
        let text = bricks.iter().fold(String::new(), |mut text, b| {
            let keys = format!("min = {:?}\nmax = {:?}\nporosity = {:?}", b.min, b.max, b.porosity);
            let _ = write!(text, "{}", solid("box", &keys));
            text
        });
        let bodies = bodies(&text);
        for (cells, coarse) in [(6, 1), (3, 2), (2, 3)] {
            let found = run(&edges([cells; 3], 6.0), &bodies);
            let expected = counted(&bricks, cells, coarse);
            assert_close(&found.beta, &expected, 1e-13, &text);
            let [lower, upper] = found.bounds.as_ref().expect("bounds");
            assert!(lower.v.iter().zip(&expected.v).all(|(l, v)| *l <= v + 1e-13), "{text}");
            assert!(upper.v.iter().zip(&expected.v).all(|(u, v)| *u >= v - 1e-13), "{text}");
            let blocked: f64 = expected.v.iter().map(|open| 1.0 - open).sum::<f64>() * (coarse as f64).powi(3);
            assert!((found.solid_volume - blocked).abs() < 1e-11, "{text}");
            let closed = expected.v.iter().filter(|&&open| open == 0.0).count();
            let all_open = expected.v.iter().filter(|&&open| open == 1.0).count();
            assert_eq!((found.cells.closed, found.cells.open), (closed, all_open), "{text}");
            assert_eq!(found.cells.cut, cells.pow(3) - closed - all_open);
            shared += found.cells.ambiguous;
        }
    }
    assert!(shared > 400 && several > 10, "{shared}, {several}");
}

/// Balls, pipes and turned boxes of up to ten porosities: the sum over the levels of the unions of all solids up to each, which are computed as solid.
#[test]
fn many_porosities_are_the_sum_of_their_unions() {
    let mut rng = Random::new(8);
    for round in 0..8 {
        let grid = edges([9, 8, 10], 4.0);
        let mut solids: Vec<(f64, String)> = Vec::new();
        for _ in 0..6 + rng.below(20) {
            let porosity = (rng.below(10) as f64 + if round % 2 == 0 { 0.0 } else { 0.5 }) / 10.0;
            let at = |rng: &mut Random| DVec3::from_array([0.0; 3].map(|_: f64| 4.0 * rng.unit()));
            let (a, r) = (at(&mut rng), 0.1 + 0.4 * rng.unit());
            let text = match rng.below(3) {
                0 => solid("sphere", &format!("center = {}\nradius = {r}", list(a))),
                1 => {
                    let to = a + (at(&mut rng) - 2.0) * 0.4;
                    solid("cylinder", &format!("from = {}\nto = {}\nradius = {}", list(a), list(to), 0.5 * r))
                }
                _ => {
                    let turn = "rotate = { axis = [1, 2, 3], angle = 30 }";
                    solid("box", &format!("min = {}\nmax = {}\n{turn}", list(a), list(a + 0.5 * r)))
                }
            };
            solids.push((porosity, text));
        }
        let porous = |(p, text): &(f64, String)| format!("{text}\nporosity = {p:?}\n");
        let all = bodies(&solids.iter().map(porous).collect::<String>());
        let found = run(&grid, &all);
        let levels = voidage::porosity::levels(&all);
        let mut sum = vec![levels[0]; found.beta.v.len()];
        let mut x = vec![levels[0]; found.beta.x.len()];
        for (n, &level) in levels.iter().enumerate() {
            let weight = levels.get(n + 1).copied().unwrap_or(1.0) - level;
            let text: String = solids.iter().filter(|(p, _)| *p <= level).map(|(_, text)| text.as_str()).collect();
            let union = run(&grid, &bodies(&text)).beta;
            sum.iter_mut().zip(&*union.v).for_each(|(sum, open)| *sum += weight * open);
            x.iter_mut().zip(&*union.x).for_each(|(sum, open)| *sum += weight * open);
        }
        let [lower, upper] = found.bounds.as_ref().expect("bounds");
        for (field, expected) in [(0, &sum), (1, &x)] {
            for (n, expected) in expected.iter().enumerate() {
                let [low, value, high] = [lower, &found.beta, upper].map(|set| set.field(field)[n]);
                let near = 1e-4 * levels.len() as f64;
                assert!(low - near <= *expected && *expected <= high + near, "round {round}: {low} {expected} {high}");
                assert!(
                    (value - expected).abs() <= near.min(found.max_gap + 1e-12),
                    "round {round}: {value} {expected}"
                );
            }
        }
    }
}

/// Two boxes that overlap, in coordinates of UTM (446 and 5412 km): along the axes they are to the bit what they are at the origin; turned, as near as
/// their rounded coordinates allow, 9e-10 of 0.25 m, and the union has its proof.
#[test]
fn boxes_far_from_the_origin_are_measured_as_nearby() {
    let boxes = [
        (DVec3::new(0.3125, 0.46875, 0.28125), DVec3::new(2.125, 1.71875, 2.671875)),
        (DVec3::new(1.3125, 0.96875, 0.78125), DVec3::new(2.625, 2.21875, 2.171875)),
    ];
    let at = |corner: DVec3, more: &str| {
        let edges = Edges([0, 1, 2].map(|a| (0..=12).map(|i| corner[a] + 0.25 * f64::from(i)).collect()));
        let ends = |(low, high)| format!("min = {}\nmax = {}\n{more}", list(corner + low), list(corner + high));
        let text: String = boxes.map(|b| solid("box", &ends(b))).concat();
        run(&edges, &bodies(&text))
    };
    let survey = DVec3::new(446_250.0, 5_411_930.0, 114.0);
    assert!(at(survey, "").beta == at(DVec3::ZERO, "").beta);
    let turn = "rotate = { axis = [1, 2, 3], angle = 30 }";
    let (near, far) = (at(DVec3::ZERO, turn), at(survey, turn));
    assert!(far.cells.ambiguous > 10 && far.max_gap < 1e-13, "{:?}, {}", far.cells, far.max_gap);
    for (near, far) in [(&near.beta.v, &far.beta.v), (&near.beta.x, &far.beta.x), (&near.beta.z, &far.beta.z)] {
        let worst = near.iter().zip(far.iter()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst < 2e-8, "{worst}");
    }
}

/// Where nothing else is, a porous solid has its porosity to the bit, and a solid one blocks all.
#[test]
fn whole_cells_carry_the_porosity_itself() {
    let grid = edges([3, 1, 1], 3.0);
    for porosity in [0.1, 0.3, 0.6, 0.7] {
        let grating = format!("min = [0, -1, -1]\nmax = [2, 4, 4]\nporosity = {porosity}");
        let text = solid("box", &grating) + &solid("box", "min = [0, -1, -1]\nmax = [1, 4, 4]");
        let found = run(&grid, &bodies(&text)).beta;
        assert_eq!(found.v[..], [0.0, porosity, 1.0]);
        assert_eq!(found.x[..], [0.0, 0.0, porosity, 1.0]);
    }
}

#[test]
fn layers_without_porous_solids_are_those_of_the_solid_ones() {
    // The second scene has a porous needle beside the others through all layers, so that every layer is computed at both levels.
    let edges = edges([10, 6, 12], 1.0);
    let parts = solid("sphere", "center = [0.3, 0.4, 0.5]\nradius = 0.25")
        + &solid("sphere", "center = [0.35, 0.4, 0.55]\nradius = 0.2")
        + &solid("box", "min = [0.1, 0.2, 0.52]\nmax = [0.6, 0.7, 0.57]\nporosity = 0.6");
    let needle = solid("box", "min = [0.91, 0.9, -1]\nmax = [0.99, 0.99, 2]\nporosity = 0.6");
    // By subdivision, whose queries tell how much was computed.
    let run = |text: &str| {
        let options = Options { method: Method::Gjk, ..Options::default() };
        porosity(&edges.grid(None).expect("a grid"), &bodies(text), options)
    };
    let (few, all) = (run(&parts), run(&(parts.clone() + &needle)));
    assert!(
        few.gjk.queries < all.gjk.queries * 3 / 4,
        "{} queries, {} in all layers",
        few.gjk.queries,
        all.gjk.queries
    );
    let [nx, ny, nz] = edges.cells();
    let fields = [few.beta, all.beta];
    for n in 0..nx * ny * nz {
        let (i, j, k) = (n % nx, n / nx % ny, n / nx / ny);
        if i + 2 < nx {
            let x = (k * ny + j) * (nx + 1) + i;
            let y = (k * (ny + 1) + j) * nx + i;
            let of = |f: &FieldSet| [f.v[n], f.x[x], f.y[y], f.z[n], f.z[n + nx * ny]];
            assert_eq!(of(&fields[0]), of(&fields[1]), "cell {i} {j} {k}");
        }
    }
}

/// A louvre just outside a side of the grid closes its faces there, however far it misses the side by rounding, and whatever else stands in the grid.
#[test]
fn what_misses_a_side_by_rounding_closes_it_beside_any_solid() {
    for (axis, high, far) in (0..3).flat_map(|a| [(a, false, 0.0), (a, true, 0.0), (a, true, 4e5), (a, false, 4e5)]) {
        let ulp = f64::EPSILON * (1.0 + far);
        for (off, other) in [0.0, 0.25, 1.0].into_iter().flat_map(|off| [None, Some(0.0), Some(0.6)].map(|o| (off, o)))
        {
            let at = DVec3::splat(far);
            let (mut lo, mut hi) = (at, at + 1.0);
            let gap = off * ulp;
            if high {
                (lo[axis], hi[axis]) = (far + 1.0 + gap, far + 1.25);
            } else {
                (lo[axis], hi[axis]) = (far - 0.25, far - gap);
            }
            let crate_of = other.map(|_| solids::cuboid(at + 0.4, at + 0.6));
            let mut bodies = solids::scene(&[vec![solids::cuboid(lo, hi)], crate_of.into_iter().collect()].concat());
            bodies.bodies[0].porosity = 0.3;
            if let Some(porosity) = other {
                bodies.bodies[1].porosity = porosity;
            }
            let edges = Edges([0; 3].map(|_| (0..=4).map(|i| far + f64::from(i) * 0.25).collect()));
            let found = porosity(&edges.grid(None).expect("a grid"), &bodies, Options::default());
            let faces = found.beta.faces(axis);
            let closed = faces.iter().filter(|open| (**open - 0.3).abs() < 1e-9).count();
            assert_eq!(closed, 16, "axis {axis}, high {high}, {off} units off, {far} far, beside {other:?}");
        }
    }
}
