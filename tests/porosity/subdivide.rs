//! Subdivision by GJK against exact unions, closed forms, its own theory, and itself.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec3, Vec3};
use proptest::prelude::*;
use voidage::geometry::bodies::Bodies;
use voidage::geometry::form::Form;
use voidage::grid::Edges;
use voidage::porosity::{Leaf, Method, Options, Porosity};
use voidage_core::convex::chord::Chords;
use voidage_core::convex::shape::{Capsule, Cone, Cylinder, Ellipsoid, OrientedBox, Sphere};
use voidage_core::convex::support::Transformed;
use voidage_core::grid::Grid;
use voidage_core::grid::cell_range::RangeKind;
use voidage_core::number::aabb::Aabb;
use voidage_core::number::real::{Real, Vector};
use voidage_core::subdivide::{
    Bounds, Candidate, LeafRule, MAX_DEPTH, QueryCount, Subdividable, SubdivisionMemory, SubdivisionRule, share,
};
use voidage_tests::convex::{Part, bounds_hold_the_union, run};
use voidage_tests::effort::cases;
use voidage_tests::quadrature::Exact;
use voidage_tests::quadric::{Family, Kind, solid_of};
use voidage_tests::random::Random;
use voidage_tests::solids::{Triangle, cuboid, formulas, scene, sphere, turned_box, volume};

fn part() -> impl Strategy<Value = Part> {
    let center = prop::array::uniform3(-14i8..=14);
    (0u8..4, center, prop::array::uniform3(0u8..16), any::<u8>()).prop_map(|(kind, center, half, seed)| Part {
        kind,
        center,
        half,
        seed,
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    #[test]
    fn bounds_hold_unions_of_up_to_six_bodies(parts in prop::collection::vec(part(), 1..=6), depth in 0u32..4) {
        bounds_hold_the_union(&parts, depth);
    }

    #[test]
    fn single_and_double_precision_do_not_contradict_each_other(seed in any::<u64>()) {
        precisions_agree(seed);
    }
}

/// A corner of the cell is outside the capsule by 8e-4, which is 7e-9 of the cell: in single precision the mean of its columns rounded to their
/// full height, and the cell was called closed.
#[test]
fn a_missing_corner_smaller_than_an_ulp_of_single_precision() {
    precisions_agree(14_676_119_446_957_003_780);
}

/// A ball that holds all of a box but one corner, or nothing but one corner, in single precision. What is cut off there may be less than an ulp of
/// the share, but its corner is some thousand roundings from the ball: the box is neither closed nor open.
#[test]
fn a_corner_beyond_a_ball_keeps_a_box_from_being_closed_and_one_inside_from_being_open() {
    let mut random = Random::new(11);
    let cell = Aabb { min: Vec3::ZERO, max: Vec3::ONE };
    for n in 0..400 {
        let out = DVec3::from_array(random.on_sphere().map(|x| x.abs() + 0.4)).normalize();
        let (radius, depth) = (random.between(3.0, 6.0), 10_f64.powf(random.between(-3.3, -2.0)));
        let ball = |center: DVec3| Sphere { center: center.as_vec3(), radius: radius as f32 };
        let beyond = measured(ball(DVec3::ONE - out * (radius + depth)), &cell, 3)[0];
        let inside = measured(ball(-out * (radius - depth)), &cell, 3)[0];
        assert!(beyond.lower < 1.0, "{n}: radius {radius}, depth {depth}: {beyond:?}");
        assert!(inside.upper > 0.0, "{n}: radius {radius}, depth {depth}: {inside:?}");
    }
}

/// A box with a side in a plane of the grid.
#[test]
fn a_box_that_touches_a_plane() {
    bounds_hold_the_union(&[Part { kind: 0, center: [0, 10, 0], half: [6, 1, 6], seed: 0 }], 0);
}

fn unit_grid(n: usize) -> Edges {
    let axis: Vec<f64> = (0..=n).map(|i| i as f64 / n as f64).collect();
    Edges([axis.clone(), axis.clone(), axis])
}

fn plane(depth: u32, tol: f64) -> Options {
    Options { method: Method::Gjk, leaf: Leaf::Plane, depth, tol, bounds: true, ..Options::default() }
}

/// Lower and upper bound of the solid volume in a grid of equal cells that fill the unit cube.
fn totals(result: &Porosity) -> [f64; 2] {
    let [lower, upper] = result.bounds.as_ref().expect("bounds");
    let solid = |open: &[f64]| open.iter().map(|o| 1.0 - o).sum::<f64>() / open.len() as f64;
    [solid(&upper.v), solid(&lower.v)]
}

/// Of cylinder, cone and capsule.
const AXIS: [DVec3; 2] = [DVec3::new(0.22, 0.31, 0.28), DVec3::new(0.71, 0.62, 0.83)];

/// Bodies in the unit cube and their volumes.
fn round_bodies() -> [(&'static str, Form, f64); 5] {
    let p = |x, y, z| DVec3::new(x, y, z);
    let [from, to] = AXIS;
    let height = (to - from).length();
    let [turn, _] = [Random::new(7).turn(), Random::new(8).turn()];
    let axes = p(0.31, 0.12, 0.2);
    let about_origin = Ellipsoid { center: DVec3::ZERO, semi_axes: axes };
    let ellipsoid =
        Transformed::new(about_origin, [turn.x_axis, turn.y_axis, turn.z_axis], DVec3::ONE, p(0.5, 0.49, 0.52));
    [
        (
            "sphere",
            Form::Sphere(Sphere { center: p(0.48, 0.53, 0.51), radius: 0.37 }),
            4.0 / 3.0 * PI * 0.37f64.powi(3),
        ),
        ("cylinder", Form::Cylinder(Cylinder::new(from, to, 0.15)), PI * 0.15 * 0.15 * height),
        ("cone", Form::Cone(Cone::new(from, to, 0.2)), PI * 0.04 * height / 3.0),
        (
            "capsule",
            Form::Capsule(Capsule { from, to, radius: 0.13 }),
            PI * 0.13 * 0.13 * height + 4.0 / 3.0 * PI * 0.13f64.powi(3),
        ),
        ("ellipsoid", Form::Ellipsoid(ellipsoid), 4.0 / 3.0 * PI * axes.element_product()),
    ]
}

#[test]
fn totals_hold_the_closed_forms_and_converge_at_second_order() {
    let edges = unit_grid(20);
    for (name, form, truth) in round_bodies() {
        let bodies = formulas(&[form]);
        let gaps: Vec<f64> = (0..5)
            .map(|depth| {
                let [lower, upper] = totals(&run(&edges, &bodies, plane(depth, 1e-9), 1));
                assert!(lower <= truth && truth <= upper, "{name}, depth {depth}: {truth} in {lower}..{upper}");
                upper - lower
            })
            .collect();
        let order = (gaps[2] / gaps[4]).log2() / 2.0;
        println!("{name}: gaps {gaps:?}, order {order:.2}");
        assert!(order > 1.8, "{name}: order {order} of {gaps:?}");
    }
}

/// How far a point is outside a body, negative inside: another formula than the library's for each. Of the cone only a lower bound outside.
fn outside(form: &Form, p: DVec3) -> f64 {
    let beside = |from: DVec3, to: DVec3| {
        let along = (p - from).dot((to - from).normalize());
        (along, (p - from - (to - from).normalize() * along).length(), (to - from).length())
    };
    let [from, to] = AXIS;
    match form {
        Form::Sphere(s) => p.distance(s.center) - s.radius,
        Form::Cylinder(_) => {
            let (along, out, length) = beside(from, to);
            (-along).max(along - length).max(out - 0.15)
        }
        Form::Capsule(c) => {
            let share = ((p - c.from).dot(c.to - c.from) / (c.to - c.from).length_squared()).clamp(0.0, 1.0);
            p.distance(c.from.lerp(c.to, share)) - c.radius
        }
        Form::Cone(_) => {
            let (along, out, length) = beside(from, to);
            (-along).max((out * length - (length - along) * 0.2) / length.hypot(0.2))
        }
        _ => unreachable!("no other body is asked for"),
    }
}

/// Bounds of the share of a box by counting parts as far as they lie from the surface.
fn counted(form: &Form, lo: DVec3, hi: DVec3) -> [f64; 2] {
    const PARTS: usize = 12;
    let part = (hi - lo) / PARTS as f64;
    let (mut inside, mut unknown) = (0, 0);
    for n in 0..PARTS.pow(3) {
        let at = DVec3::new((n % PARTS) as f64, (n / PARTS % PARTS) as f64, (n / PARTS / PARTS) as f64);
        let height = outside(form, lo + (at + 0.5) * part);
        inside += usize::from(height < -part.length() * 0.5);
        unknown += usize::from(height.abs() <= part.length() * 0.5);
    }
    [inside, inside + unknown].map(|n| n as f64 / PARTS.pow(3) as f64)
}

/// Cells of each body that are looked at again, of some tens of thousands that are cut.
const SAMPLES: u32 = 250;

#[test]
fn a_million_cells_hold_closed_forms_and_finer_cells() {
    let edges = unit_grid(100);
    let grid = edges.grid(None).expect("a grid");
    let mut random = Random::new(17);
    for (name, form, truth) in round_bodies().into_iter().filter(|(name, ..)| *name != "ellipsoid") {
        let result = run(&edges, &formulas(std::slice::from_ref(&form)), Options { areas: false, ..plane(4, 1e-3) }, 2);
        let [low, high] = totals(&result);
        assert!(low <= truth && truth <= high, "{name}: {truth} in {low}..{high}");
        let [lower, upper] = result.bounds.as_ref().expect("bounds");
        let cut: Vec<usize> =
            (0..lower.v.len()).filter(|&n| result.beta.v[n] > 0.0 && result.beta.v[n] < 1.0).collect();
        assert!(cut.len() > 5000);
        let mut gaps = 0.0;
        for _ in 0..SAMPLES {
            let n = cut[random.below(cut.len())];
            let cell = grid.cell_box([n % 100, n / 100 % 100, n / 10_000]).expect("a cell");
            let own = [1.0 - upper.v[n], 1.0 - lower.v[n]];
            let finer = match &form {
                Form::Sphere(s) => finer(*s, &cell),
                Form::Cylinder(s) => finer(*s, &cell),
                Form::Cone(s) => finer(*s, &cell),
                Form::Capsule(s) => finer(*s, &cell),
                _ => unreachable!(),
            };
            gaps += finer.gap();
            assert!(own[0] <= finer.upper && finer.lower <= own[1], "{name}, cell {n}: {own:?} and {finer:?}");
            let [least, most] = counted(&form, cell.min, cell.max);
            assert!(own[0] <= most && least <= own[1], "{name}, cell {n}: {own:?} and {least}..{most}");
        }
        // Cells at a rim or an apex keep a wider gap; the others make the reference sharp.
        let mean = gaps / f64::from(SAMPLES);
        assert!(mean < 1e-4, "{name}: the finer cells are {mean} apart on average");
        println!(
            "{name}: {truth:.9} in {low:.9}..{high:.9}, {} cut cells, largest gap {:.1e}",
            cut.len(),
            result.max_gap
        );
    }
}

/// The share of a cell to many digits.
fn finer<B: Subdividable<Vector = DVec3>>(body: B, cell: &Aabb<DVec3>) -> Bounds<f64> {
    let rule = SubdivisionRule { leaf: LeafRule::Plane, depth: 6, tol: 1e-5 };
    share(cell, &[body], rule, &mut Lists::new().memory(), &mut QueryCount::default()).expect("room")
}

/// No gap at all is wanted, so any number of columns: it is counted without wrapping round.
#[test]
fn without_a_tolerance_bounds_hold() {
    let ball = Sphere { center: DVec3::ZERO, radius: 1.0 };
    let octant = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
    let rule = SubdivisionRule { leaf: LeafRule::Plane, depth: 4, tol: 0.0 };
    let found = share(&octant, &[ball], rule, &mut Lists::new().memory(), &mut QueryCount::default()).expect("room");
    assert!(found.lower <= PI / 6.0 && PI / 6.0 <= found.upper && found.gap() < 5e-3, "{found:?}");
}

#[test]
fn most_boxes_are_placed_without_asking_gjk() {
    // A height or an inner point tells; before, every box beside a curved body was asked.
    let edges = unit_grid(40);
    let per_cut_cell = |bodies: &Bodies| {
        let options = Options { leaf: Leaf::Solid, areas: false, ..plane(3, 1e-3) };
        let result = run(&edges, bodies, options, 1);
        result.gjk.queries as f64 / result.cells.cut as f64
    };
    for (name, form, _) in round_bodies().into_iter().filter(|(name, ..)| !matches!(*name, "ellipsoid" | "cone")) {
        let asked = per_cut_cell(&formulas(&[form]));
        println!("{name}: {asked:.1} queries a cut cell");
        assert!(asked < 20.0, "{name}: {asked}");
    }
    let asked = per_cut_cell(&scene(&[sphere(DVec3::splat(0.5), 0.3, 6)]));
    println!("362 points: {asked:.2} queries a cut cell");
    assert!(asked < 0.05, "{asked}");
}

#[test]
fn coarse_cells_and_faces_hold_fine_ones() {
    let edges = unit_grid(7);
    for (name, form, _) in round_bodies() {
        let bodies = formulas(&[form]);
        let fine = run(&edges, &bodies, plane(6, 1e-5), 1);
        for (leaf, depth) in [(Leaf::Solid, 2), (Leaf::Half, 1), (Leaf::Plane, 0), (Leaf::Plane, 2)] {
            let coarse = run(&edges, &bodies, Options { leaf, ..plane(depth, 1e-3) }, 1);
            assert_meet(&coarse, &fine, name);
        }
    }
}

/// Two certified intervals of one truth share a point.
fn assert_meet(a: &Porosity, b: &Porosity, name: &str) {
    let ([a_low, a_high], [b_low, b_high]) = (a.bounds.as_ref().expect("bounds"), b.bounds.as_ref().expect("bounds"));
    for (al, ah, bl, bh) in [
        (&a_low.v, &a_high.v, &b_low.v, &b_high.v),
        (&a_low.x, &a_high.x, &b_low.x, &b_high.x),
        (&a_low.y, &a_high.y, &b_low.y, &b_high.y),
        (&a_low.z, &a_high.z, &b_low.z, &b_high.z),
    ] {
        for n in 0..al.len() {
            assert!(al[n] <= bh[n] && bl[n] <= ah[n], "{name} {n}: {}..{} and {}..{}", al[n], ah[n], bl[n], bh[n]);
        }
    }
}

/// What the paper's leaf finds too much, and what theory says: (δ/2)∮(|n_x| + |n_y| + |n_z|)dS.
fn bias(triangles: &[Triangle], n: usize, depth: u32) -> [f64; 2] {
    let options = Options { method: Method::Gjk, leaf: Leaf::Solid, depth, areas: false, ..Options::default() };
    let found = run(&unit_grid(n), &scene(&[triangles.to_vec()]), options, 1).solid_volume - volume(triangles);
    let flux = |[a, b, c]: &Triangle| {
        let doubled = (b - a).cross(c - a).abs();
        (doubled.x + doubled.y + doubled.z) * 0.5
    };
    [found, triangles.iter().map(flux).sum::<f64>() / (2.0 * (n << depth) as f64)]
}

#[test]
fn the_paper_s_leaf_finds_too_much_as_theory_says() {
    let ball = sphere(DVec3::new(0.49, 0.52, 0.5), 0.3, 6);
    let slab = turned_box(DVec3::new(0.5, 0.48, 0.51), DVec3::new(0.3, 0.05, 0.2), Random::new(3).turn());
    for (name, body) in [("ball", &ball), ("slab", &slab)] {
        for (n, depth) in [(20, 3), (40, 2)] {
            let [found, expected] = bias(body, n, depth);
            println!("{name}, {n} cells, depth {depth}: {found:.6}, theory {expected:.6}");
            assert!((found / expected - 1.0).abs() < 0.05, "{name}: {found} against {expected}");
        }
    }
}

#[test]
fn half_counts_are_near_the_truth() {
    let ball = sphere(DVec3::new(0.49, 0.52, 0.5), 0.3, 6);
    let options = Options { method: Method::Gjk, leaf: Leaf::Half, depth: 3, areas: false, ..Options::default() };
    let result = run(&unit_grid(40), &scene(std::slice::from_ref(&ball)), options, 1);
    let error = result.solid_volume / volume(&ball) - 1.0;
    assert!(error.abs() < 5e-4, "{error:e}");
}

#[test]
fn cubes_of_the_paper() {
    // Fits a cell; centred on a line of four cells; half way.
    let edges = unit_grid(4);
    for leaf in [Leaf::Solid, Leaf::Half, Leaf::Plane] {
        for (shift, cell, face) in [([0.0, 0.0], 0.0, 0.0), ([0.125, 0.125], 0.75, 0.75), ([0.125, 0.0], 0.5, 0.5)] {
            let lo = DVec3::new(0.25 + shift[0], 0.25 + shift[1], 0.25);
            let cube = cuboid(lo, lo + DVec3::splat(0.25));
            let options = Options { leaf, ..plane(3, 1e-4) };
            let result = run(&edges, &scene(&[cube]), options, 1);
            let at = 4 * 4 + 4 + 1;
            assert!((result.beta.v[at] - cell).abs() < 1e-12, "{leaf:?} {shift:?}: {}", result.beta.v[at]);
            assert!((result.beta.z[at] - face).abs() < 1e-12, "{leaf:?} {shift:?}: {}", result.beta.z[at]);
            assert_eq!(result.beta.v[at - 1], 1.0, "{leaf:?} {shift:?}");
            assert!(result.max_gap < 1e-11);
        }
    }
}

#[test]
fn a_cylinder_that_stands_on_a_plane_closes_it() {
    let standing = Cylinder::new(DVec3::new(0.5, 0.5, 0.25), DVec3::new(0.5, 0.5, 0.75), 0.2);
    let result = run(&unit_grid(8), &formulas(&[Form::Cylinder(standing)]), plane(5, 1e-4), 1);
    let level = |k: usize| result.beta.z[64 * k..64 * (k + 1)].iter().map(|open| 1.0 - open).sum::<f64>() / 64.0;
    for k in [2, 3, 6] {
        assert!((level(k) - PI * 0.04).abs() < 1e-4, "plane {k}: {}", level(k));
    }
    let below: f64 = result.beta.v[64..128].iter().map(|open| 1.0 - open).sum();
    assert!(below < 1e-9, "nothing stands below: {below}");
    assert!(result.max_gap < 1e-3, "{}", result.max_gap);
}

#[test]
fn a_wall_in_the_outermost_plane_of_several_counts() {
    // Planes are asked in ranges; the second box only touches the last plane of one.
    let part = |center, half| Part { kind: 0, center: [center, 0, 0], half: [half, 0, 0], seed: 0 };
    bounds_hold_the_union(&[part(0, 3), part(10, 4)], 0);
}

#[test]
fn bits_do_not_depend_on_threads() {
    let solids: Vec<_> = (0..5).map(|n| sphere(DVec3::new(0.3 + 0.1 * f64::from(n), 0.5, 0.45), 0.2, 2)).collect();
    for leaf in [Leaf::Half, Leaf::Plane] {
        let options = Options { leaf, ..plane(2, 1e-2) };
        let one = run(&unit_grid(10), &scene(&solids), options, 1);
        assert_eq!(one, run(&unit_grid(10), &scene(&solids), options, 3));
        assert!(one.gjk.queries > 0);
    }
}

#[test]
fn bodies_of_all_roads_mix() {
    // A cube of triangles within a ball: the ball alone counts. Overlapping, the union lies between its parts and their sum.
    let ball = Form::Sphere(Sphere { center: DVec3::splat(0.5), radius: 0.3 });
    let truth = 4.0 / 3.0 * PI * 0.027;
    let edges = unit_grid(10);
    let mixed = |half: f64, center: f64| {
        let mut bodies = scene(&[cuboid(DVec3::splat(center - half), DVec3::splat(center + half))]);
        bodies.bodies.append(&mut formulas(std::slice::from_ref(&ball)).bodies);
        bodies
    };
    let options = Options { bounds: true, tol: 1e-3, ..Options::default() };
    let inside = run(&edges, &mixed(0.12, 0.5), options, 1);
    let [lower, upper] = totals(&inside);
    assert_eq!((inside.subdivided, inside.by_formula), (0, 1));
    assert!(lower <= truth + 1e-14 && truth <= upper + 1e-14 && upper - lower < 1e-3, "{truth} in {lower}..{upper}");
    let beside = run(&edges, &mixed(0.13, 0.72), options, 1);
    let all = run(&edges, &mixed(0.13, 0.72), plane(5, 1e-3), 1);
    assert_eq!(all.subdivided, 2);
    assert_meet(&beside, &all, "a cube in a ball's side");
    assert!(beside.max_gap < 2e-3, "{}", beside.max_gap);
}

#[test]
fn the_stack_of_boxes_holds_the_deepest_subdivision() {
    // A ball smaller than the smallest part, at a corner of parts of every size.
    let ball = Sphere { center: DVec3::splat(0.5), radius: 1e-7 };
    let cell = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
    let mut lists = Lists::new();
    let rule = |depth, leaf| SubdivisionRule { leaf, depth, tol: 0.0 };
    let bounds =
        share(&cell, &[ball], rule(MAX_DEPTH, LeafRule::Half), &mut lists.memory(), &mut QueryCount::default());
    let smallest = 0.125f64.powi(MAX_DEPTH as i32);
    let Bounds { lower, upper } = bounds.expect("room");
    assert!(lower == 0.0 && upper >= smallest && upper < 1e-9, "{upper:e} against {smallest:e}");
    let deeper = share(&cell, &[ball], rule(u32::MAX, LeafRule::Half), &mut lists.memory(), &mut QueryCount::default());
    assert_eq!(deeper, bounds, "depth is limited");
    let mut small = SubdivisionMemory { candidates: &mut [], facets: &mut [] };
    assert!(share(&cell, &[ball], rule(1, LeafRule::Half), &mut small, &mut QueryCount::default()).is_err());
}

#[test]
fn full_lists_cost_work_not_truth() {
    let balls: Vec<_> =
        (0..6).map(|n| Sphere { center: DVec3::splat(0.3 + 0.08 * f64::from(n)), radius: 0.2 }).collect();
    let cell = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
    let rule = SubdivisionRule { leaf: LeafRule::Plane, depth: 4, tol: 1e-9 };
    let measure = |room: usize| {
        let mut candidates = vec![Candidate::default(); room];
        let mut memory = SubdivisionMemory { candidates: &mut candidates, facets: &mut [] };
        share(&cell, &balls, rule, &mut memory, &mut QueryCount::default()).expect("room for one list")
    };
    let (ample, scarce) = (measure(1000), measure(6));
    assert!(scarce.lower <= ample.upper && ample.lower <= scarce.upper);
    assert!(scarce.gap() < 0.05 && ample.gap() < 0.05, "{scarce:?} {ample:?}");
}

struct Lists<V> {
    candidates: Vec<Candidate<V>>,
    facets: Vec<u32>,
}

impl<V: Vector> Lists<V> {
    fn new() -> Self {
        Lists { candidates: vec![Candidate::default(); 256], facets: vec![0; 256] }
    }

    fn memory(&mut self) -> SubdivisionMemory<'_, V> {
        SubdivisionMemory { candidates: &mut self.candidates, facets: &mut self.facets }
    }
}

/// The bounds of a body in a box and on its faces, in one precision.
fn measured<B: Subdividable<Vector = V>, V: Vector>(body: B, cell: &Aabb<V>, depth: u32) -> [Bounds<f64>; 4] {
    let mut lists = Lists::new();
    let rule = SubdivisionRule { leaf: LeafRule::Plane, depth, tol: V::Scalar::ZERO };
    let mut of = |cell: &Aabb<V>| {
        let found = share(cell, std::slice::from_ref(&body), rule, &mut lists.memory(), &mut QueryCount::default());
        let Bounds { lower, upper } = found.expect("room");
        assert!(V::Scalar::ZERO <= lower && lower <= upper && upper <= V::Scalar::ONE);
        Bounds { lower: lower.to_f64(), upper: upper.to_f64() }
    };
    let face = |axis: usize| {
        let mut max = cell.max.to_array();
        max[axis] = cell.min.to_array()[axis];
        Aabb { min: cell.min, max: V::from_array(max) }
    };
    [of(cell), of(&face(0)), of(&face(1)), of(&face(2))]
}

/// Numbers that are the same in both precisions.
fn single(v: DVec3) -> DVec3 {
    v.as_vec3().as_dvec3()
}

/// A random body of every kind, far from the origin or not, in single and in double precision: rounding of 10⁻⁷ must not show.
fn precisions_agree(seed: u64) {
    let mut random = Random::new(seed);
    let far = [0.0, 3.0, 100.0][random.below(3)];
    let at = single(random.vector::<DVec3>(1.0) * far);
    let p = single(at + random.vector::<DVec3>(0.6));
    let q = if random.below(3) == 0 {
        single(p + DVec3::Z * random.between(0.2, 1.0))
    } else {
        single(at + random.vector::<DVec3>(0.9))
    };
    let thin = if random.below(4) == 0 { 0.01 } else { 1.0 };
    let s = single(DVec3::new(random.between(0.1, 0.8), random.between(0.1, 0.8), random.between(0.1, 0.8) * thin));
    let cell = Aabb {
        min: single(at - random.point(DVec3::splat(0.1), DVec3::splat(0.5))),
        max: single(at + random.point(DVec3::splat(0.1), DVec3::splat(0.5))),
    };
    let cell32 = Aabb { min: cell.min.as_vec3(), max: cell.max.as_vec3() };
    let (p32, q32, s32) = (p.as_vec3(), q.as_vec3(), s.as_vec3());
    fn check(name: &str, seed: u64, a: [Bounds<f64>; 4], b: [Bounds<f64>; 4]) {
        for (n, (a, b)) in a.into_iter().zip(b).enumerate() {
            assert!(a.lower <= b.upper && b.lower <= a.upper, "{name}, seed {seed}, {n}: {a:?} and {b:?}");
        }
    }
    fn both<A: Chords<Vector = Vec3>, B: Chords<Vector = DVec3>>(
        a: A,
        b: B,
        cells: (&Aabb<Vec3>, &Aabb<DVec3>),
    ) -> [[Bounds<f64>; 4]; 2] {
        [measured(a, cells.0, 3), measured(b, cells.1, 3)]
    }
    let cells = (&cell32, &cell);
    let found = [
        ("sphere", both(Sphere { center: p32, radius: s32.x }, Sphere { center: p, radius: s.x }, cells)),
        ("ellipsoid", both(Ellipsoid { center: p32, semi_axes: s32 }, Ellipsoid { center: p, semi_axes: s }, cells)),
        (
            "capsule",
            both(Capsule { from: p32, to: q32, radius: s32.z }, Capsule { from: p, to: q, radius: s.z }, cells),
        ),
        ("cylinder", both(Cylinder::new(p32, q32, s32.z), Cylinder::new(p, q, s.z), cells)),
        ("cone", both(Cone::new(p32, q32, s32.y), Cone::new(p, q, s.y), cells)),
        (
            "box",
            both(
                Aabb { min: p32 - s32 * 0.0, max: p32 + Vec3::ONE },
                Aabb { min: p, max: (p32 + Vec3::ONE).as_dvec3() },
                cells,
            ),
        ),
        (
            "oriented box",
            both(
                OrientedBox {
                    center: p32,
                    half_axes: [Vec3::new(0.5, 0.25, 0.0), Vec3::new(-0.25, 0.5, 0.0), Vec3::new(0.0, 0.0, s32.z)],
                },
                OrientedBox {
                    center: p,
                    half_axes: [DVec3::new(0.5, 0.25, 0.0), DVec3::new(-0.25, 0.5, 0.0), DVec3::new(0.0, 0.0, s.z)],
                },
                cells,
            ),
        ),
        (
            "transformed",
            both(
                Transformed::new(Cone::new(Vec3::ZERO, Vec3::Z, 0.5), [Vec3::Y, Vec3::Z, Vec3::X], s32, p32),
                Transformed::new(Cone::new(DVec3::ZERO, DVec3::Z, 0.5), [DVec3::Y, DVec3::Z, DVec3::X], s, p),
                cells,
            ),
        ),
    ];
    for (name, [a, b]) in found {
        check(name, seed, a, b);
    }
}

/// Lines of the grid along lines of a cone, and but for rounding: chords end in the cone that is meant, and bounds hold the closed form.
#[test]
fn cones_with_a_line_along_an_axis_hold_their_closed_forms() {
    let mut cut = 0;
    for seed in 0..cases(4000) as u64 {
        let mut random = Random::new(seed);
        let (solid, exact) = solid_of(&mut random, Family::Oblique, Kind::Leaning);
        let (body, apex) = match exact {
            Exact::Cone(base, top, radius) => (Cone::truncated(base, top, radius, 0.0), top),
            Exact::Frustum(base, top, [r, s]) => {
                (Cone::truncated(base, top, r, s), base + (top - base) * (r / (r - s)))
            }
            _ => continue,
        };
        // Every other cell has an edge on lines through the apex.
        let corner = if seed % 2 == 0 { apex } else { apex + random.vector::<DVec3>(0.1) };
        let min = corner + random.vector::<DVec3>(4.0).round() * 0.05;
        let cell = Aabb { min, max: min + DVec3::splat(0.1) };
        let found = finer(body, &cell);
        let sides = [0, 1, 2].map(|axis: usize| [cell.min[axis], cell.max[axis]]);
        let grid = Grid::new(&sides[0], &sides[1], &sides[2]).unwrap();
        let mut share = 0.0;
        let worst = solid.layer(&grid, 0, false, &mut |kind, _, own| {
            if kind == RangeKind::Cells {
                share += own;
            }
        });
        assert!(worst < 1e-9, "{seed}: {exact:?}: {worst}");
        cut += usize::from(share > 0.0 && share < 1.0);
        assert!(
            found.lower <= share + 1e-9 && share <= found.upper + 1e-9,
            "{seed}: {exact:?} {cell:?}: {share} {found:?}"
        );
    }
    assert!(cut * 8 > cases(4000), "{cut}");
}

/// Lines through the apex of a cone have its end there, or miss it, whatever rounding says of the apex.
#[test]
fn lines_through_an_apex_are_inside_or_outside() {
    let mut random = Random::new(3);
    for n in 0..100_000 {
        let (apex, axis) = (random.vector::<Vec3>(1.0), random.vector::<Vec3>(1.0).normalize());
        let (height, half) = (0.5_f32, random.between(0.2, 1.2) as f32);
        let cone = Cone::new(apex - axis * height, apex, height * half.tan());
        let side = axis.any_orthonormal_vector();
        let angle = if n % 2 == 0 { half * 0.8 } else { half + 0.2 * (FRAC_PI_2 as f32 - half) };
        let direction = -axis * angle.cos() + side * angle.sin();
        let origin = apex - direction * random.between(0.1, 2.0) as f32;
        let length = cone.chord(origin, direction, 0.0, &[]).map_or(0.0, |[from, to]| to - from);
        let wanted = if n % 2 == 0 { height / angle.cos() } else { 0.0 };
        assert!((length - wanted).abs() < 2e-3, "{n}: {cone:?} {origin} {direction}: {length}, not {wanted}");
    }
}
