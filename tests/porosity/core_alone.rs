//! The core by itself, as another solver would use it, in both precisions.

use glam::{DVec3, Vec3};
use voidage::geometry::bodies::Bodies;
use voidage::grid::Edges;
use voidage::porosity::{FieldSet, Options, Porosity, porosity, snap};
use voidage_core::grid::fields::{Fields, Layer, ShapeMismatch};
use voidage_core::grid::{Grid, GridError};
use voidage_core::number::real::{Real, Vector};
use voidage_core::surface::bins::{BinsError, BinsNeeded, Group, Surface};
use voidage_core::surface::cells::{Scratch, add_body};
use voidage_core::surface::error::SurfaceError;
use voidage_core::surface::layer::{
    LayerError, LayerMemory, LayerOptions, LayerReport, LayerSlices, Layers, MemoryNeeded,
};
use voidage_core::surface::union::{Fragment, Node, Part, PendingNode, Piece, UnionMemory};
use voidage_core::surface::z_faces::{Side, add_section};
use voidage_tests::door::never_panics;
use voidage_tests::random::Random;
use voidage_tests::solids::{cuboid, scene, sphere, turned_box, volume};
use voidage_tests::truth::fixture;

/// Slices of any origin.
fn room<T: Default + Clone>(count: usize) -> Vec<T> {
    vec![T::default(); count]
}

/// Fields of cells, x, y and z faces: values, lower and upper bounds; and what was reported.
struct Found<R> {
    value: [Vec<R>; 4],
    bounds: [[Vec<R>; 4]; 2],
    reports: Vec<LayerReport<R>>,
}

/// A share of the memory for shared cells that is given, and the pieces that a union may have.
#[derive(Clone, Copy)]
struct Given {
    tenths: usize,
    pieces: usize,
    /// Numbers of bodies near octants.
    near: usize,
}

/// As much as the host gives.
const PLENTY: Given = Given { tenths: 10, pieces: usize::MAX, near: usize::MAX };

fn fields<V: Vector>(grid: &Grid<V::Scalar>, bodies: &[Surface<V>], given: Given) -> Found<V::Scalar> {
    let set = || {
        let faces = [0, 1, 2].map(|axis| room(grid.face_shape(axis).iter().product()));
        let [x, y, z] = faces;
        [room(grid.cell_count()), x, y, z]
    };
    let mut found = Found { value: set(), bounds: [set(), set()], reports: Vec::new() };
    let told = Layers::all_needed(grid, bodies.iter().copied(), LayerOptions::default());
    let BinsNeeded { numbers, groups } = Layers::needed(grid, bodies);
    let (mut numbers, mut groups) = (room(numbers), room(groups));
    let layers = Layers::new(grid, bodies, LayerOptions::default(), &mut numbers, &mut groups).expect("sorted");
    let MemoryNeeded { reals, flags, numbers, groups } = layers.memory_needed();
    assert_eq!(told, (Layers::needed(grid, bodies), layers.memory_needed()), "told before anything was sorted");
    let least = LayerMemory::<V>::needed(grid);
    let share = |needed: usize, least: usize| least + (needed - least) * given.tenths / 10;
    let (mut reals, mut flags) = (room(share(reals, least.reals)), room(share(flags, least.flags)));
    let (mut numbers, mut groups) = (room(share(numbers, 0)), room::<Group<V>>(share(groups, 0)));
    let most = given.pieces.min(layers.union_pieces());
    let mut pieces: Vec<Piece<V::Scalar>> = room(most);
    let needed = UnionMemory::<V::Scalar>::needed(most);
    let (mut split_pieces, mut order) = (room(needed.split_pieces), room(needed.order));
    let mut nodes: Vec<Node<V::Scalar>> = room(needed.nodes);
    let mut parts: Vec<Part<V::Scalar>> = room(needed.parts);
    let (mut fragments, mut pending): (Vec<Fragment<V::Scalar>>, Vec<PendingNode>) =
        (room(needed.fragments), room(needed.pending));
    let (mut octants, mut near) = (room(given.near.min(most)), room(given.near.min(64 * most)));
    let union = UnionMemory {
        pieces: &mut pieces,
        split_pieces: &mut split_pieces,
        order: &mut order,
        nodes: &mut nodes,
        parts: &mut parts,
        fragments: &mut fragments,
        pending: &mut pending,
        octants: &mut octants,
        near: &mut near,
    };
    let mut memory = LayerMemory::new(grid, &mut reals, &mut flags, &mut numbers, &mut groups, union).expect("room");
    for k in 0..grid.cells()[2] {
        let [low, high] = found.bounds.each_mut().map(|set| slices(grid, k, set));
        let report = layers.layer(k, slices(grid, k, &mut found.value), Some([low, high]), &mut memory);
        found.reports.push(report.expect("a layer"));
    }
    found
}

fn slices<'a, R: Real>(grid: &Grid<R>, k: usize, [v, x, y, z]: &'a mut [Vec<R>; 4]) -> LayerSlices<'a, R> {
    LayerSlices::of_fields(grid, k, v, [x, y, z]).expect("fields of the grid")
}

/// The surfaces of bodies, as the host hands them over.
fn surfaces<'a>(bodies: &Bodies, triangles: &'a [[DVec3; 3]]) -> Vec<Surface<'a, DVec3>> {
    let surface = |body: &voidage::geometry::bodies::Body| {
        let own = &triangles[body.triangles.clone()];
        if body.sheet { Surface::sheet(own) } else { Surface::new(own) }
    };
    bodies.bodies.iter().map(surface).collect()
}

fn host(grid: &Grid<f64>, bodies: &Bodies) -> Porosity {
    porosity(grid, bodies, Options { bounds: true, ..Options::default() })
}

/// The core gives the bits of the host.
fn same_bits(edges: &Edges, bodies: &Bodies) -> Porosity {
    let grid = edges.grid(None).expect("a grid");
    let expected = host(&grid, bodies);
    let moved = snap::into_planes(&grid, bodies);
    let triangles = moved.as_deref().unwrap_or(&bodies.triangles);
    let found = fields(&grid, &surfaces(bodies, triangles), PLENTY);
    let [lower, upper] = expected.bounds.as_ref().expect("bounds");
    for (set, found) in
        [&expected.beta, lower, upper].into_iter().zip([&found.value, &found.bounds[0], &found.bounds[1]])
    {
        let FieldSet { v, x, y, z } = set;
        for (n, (expected, found)) in [v, x, y, z].into_iter().zip(found).enumerate() {
            let differ = expected.iter().zip(found).position(|(a, b)| a.to_bits() != b.to_bits());
            assert_eq!((expected.len(), differ), (found.len(), None), "field {n}");
        }
    }
    let sum = |of: fn(&LayerReport<f64>) -> usize| found.reports.iter().map(of).sum::<usize>();
    let kinds = expected.cells;
    assert_eq!([kinds.open, kinds.cut], [sum(|r| r.cells.open), sum(|r| r.cells.cut)]);
    assert_eq!([kinds.closed, kinds.ambiguous], [sum(|r| r.cells.closed), sum(|r| r.cells.ambiguous)]);
    assert_eq!(expected.divided, sum(|r| r.divided));
    assert_eq!(expected.max_gap, found.reports.iter().fold(0.0, |m: f64, r| m.max(r.max_gap)));
    assert_eq!(expected.solid_volume, found.reports.iter().map(|r| r.solid_volume).sum::<f64>());
    expected
}

fn read(name: &str) -> Bodies {
    let mut bodies = Bodies::default();
    bodies.add(&voidage::geometry::read::read(&fixture(name)).expect("a mesh"), 1.0).expect("bodies");
    bodies
}

/// A grid of `cells` over the box of some bodies.
fn grid_over(bodies: &Bodies, cells: [usize; 3]) -> Edges {
    let [lo, hi] = bodies.bounds().expect("bodies");
    Edges([0, 1, 2].map(|a| (0..=cells[a]).map(|i| lo[a] + (hi[a] - lo[a]) * i as f64 / cells[a] as f64).collect()))
}

#[test]
fn a_skid_has_the_bits_of_the_host() {
    let skid = read("cad_skid.stl");
    let found = same_bits(&grid_over(&skid, [40, 26, 22]), &skid);
    assert!(found.cells.ambiguous > 500);
    // Cells so large that they are divided, with walls that several bodies share.
    let found = same_bits(&grid_over(&skid, [3, 2, 2]), &skid);
    assert!(found.divided > 2, "{}", found.divided);
}

#[test]
fn boxes_in_grid_planes_have_the_bits_of_the_host() {
    let boxes = read("analytic_boxes_aligned.stl");
    same_bits(&grid_over(&boxes, [12, 10, 8]), &boxes);
    same_bits(&grid_over(&boxes, [5, 3, 1]), &boxes);
}

#[test]
fn overlapping_solids_have_the_bits_of_the_host() {
    let mut random = Random::new(5);
    for _ in 0..4 {
        let bodies = scene(&overlapping(&mut random));
        same_bits(&Edges([edges(6), edges(5), edges(7)]), &bodies);
        same_bits(&Edges([edges(1), edges(2), edges(1)]), &bodies);
    }
}

/// Equal cells of the unit cube.
fn edges(n: usize) -> Vec<f64> {
    (0..=n).map(|i| i as f64 / n as f64).collect()
}

/// A ball, turned boxes and boxes in planes, all of them overlapping.
fn overlapping(random: &mut Random) -> Vec<Vec<[DVec3; 3]>> {
    let mut solids = vec![sphere(DVec3::splat(0.5), 0.3, 6)];
    for _ in 0..6 {
        let center = DVec3::from_array([0; 3].map(|_| random.between(0.2, 0.8)));
        let turn = glam::DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), random.between(0.0, 3.0));
        solids.push(turned_box(center, DVec3::new(0.3, 0.1, 0.2), turn));
        let corner = DVec3::from_array([0; 3].map(|_| random.below(4) as f64 / 7.0));
        solids.push(cuboid(corner, corner + DVec3::new(2.0, 3.0, 1.0) / 7.0));
    }
    solids
}

/// Whatever the memory, bounds hold the truth; with none, shared cells keep the bounds of their bodies.
#[test]
fn too_little_memory_gives_bounds() {
    let bodies = scene(&overlapping(&mut Random::new(9)));
    let all = Edges([edges(4), edges(3), edges(2)]);
    let grid = all.grid(None).expect("a grid");
    let surfaces = surfaces(&bodies, &bodies.triangles);
    let best = fields(&grid, &surfaces, PLENTY);
    let mut gaps = Vec::new();
    for given in [(0, 0), (0, 1024), (1, 4), (2, 40), (5, 16), (10, 8), (10, 64)] {
        let found = fields(&grid, &surfaces, Given { tenths: given.0, pieces: given.1, near: 0 });
        for field in 0..4 {
            for at in 0..best.value[field].len() {
                let [low, high] = [0, 1].map(|n| found.bounds[n][field][at]);
                let truth = best.value[field][at];
                assert!(low <= truth + 1e-4 && truth <= high + 1e-4, "{given:?}: {truth} in {low}..{high}");
            }
        }
        gaps.push(found.reports.iter().fold(0.0, |m: f64, r| m.max(r.max_gap)));
    }
    assert!(gaps[0] > 0.1 && gaps[6] < 0.02, "{gaps:?}");
}

/// Where hundreds of bodies meet, pieces ask only those near them, as far as memory goes: none is missed.
#[test]
fn a_crowd_has_the_same_bits_whichever_bodies_are_asked() {
    let mut random = Random::new(13);
    let mut crowd = |count: usize, spread: f64, half: DVec3| -> Vec<_> {
        let center =
            |random: &mut Random| DVec3::from_array([0; 3].map(|_| random.between(0.5 - spread, 0.5 + spread)));
        (0..count).map(|_| turned_box(center(&mut random), half, random.turn())).collect()
    };
    let mut solids = crowd(40, 0.01, DVec3::new(0.35, 0.3, 0.25));
    solids.extend(crowd(260, 0.45, DVec3::new(0.08, 0.06, 0.02)));
    let bodies = scene(&solids);
    let surfaces = surfaces(&bodies, &bodies.triangles);
    let all = Edges([edges(1), edges(2), edges(1)]);
    let grid = all.grid(None).expect("a grid");
    let expected = fields(&grid, &surfaces, Given { near: 0, ..PLENTY });
    assert!(expected.reports.iter().all(|r| r.divided == 0 && r.max_gap < 1e-12));
    for near in [300, 2000, usize::MAX] {
        let found = fields(&grid, &surfaces, Given { near, ..PLENTY });
        assert!(found.value == expected.value && found.bounds == expected.bounds, "with {near} numbers");
    }
}

type Solids = Vec<Vec<[DVec3; 3]>>;

/// A prism over a triangle, from one height to another.
fn prism(corners: [DVec3; 3], [low, high]: [f64; 2]) -> Vec<[DVec3; 3]> {
    let [a, b, c] = corners.map(|p| p.with_z(low));
    let [u, v, w] = corners.map(|p| p.with_z(high));
    vec![[a, c, b], [u, v, w], [a, b, v], [a, v, u], [b, c, w], [b, w, v], [c, a, u], [c, u, w]]
}

/// Bodies around an axis are near each other in every box about it; planes through the axis tell them apart. None is missed: the bits are those of asking all.
#[test]
fn bodies_around_an_axis_or_a_point_have_the_same_bits_whichever_are_asked() {
    let mut random = Random::new(17);
    let count = 300;
    let rim = |angle: f64| DVec3::new(angle.cos(), angle.sin(), 0.0);
    let turn = |n: f64| std::f64::consts::TAU * n / count as f64;
    let wedge =
        |axis: DVec3, from: f64, to: f64, heights| prism([axis, axis + 0.4 * rim(from), axis + 0.4 * rim(to)], heights);
    let middle = DVec3::new(0.5, 0.5, 0.0);
    let apart = (0..count).map(|n| wedge(middle, turn(f64::from(n)), turn(f64::from(n) + 0.6), [0.1, 0.9])).collect();
    let flush = (0..count).map(|n| wedge(middle, turn(f64::from(n)), turn(f64::from(n + 1)), [0.0, 1.0])).collect();
    let mut any = |shift: f64| -> Solids {
        let mut one = |_| {
            let from = random.between(0.0, 7.0);
            let axis = middle + DVec3::new(random.between(-shift, shift), random.between(-shift, shift), 0.0);
            wedge(axis, from, from + random.between(0.01, 0.2), [random.between(0.0, 0.3), random.between(0.6, 1.0)])
        };
        (0..count).map(&mut one).collect()
    };
    let (overlapping, shifted) = (any(0.0), any(0.02));
    let mut spike = |_| {
        let ahead = DVec3::from_array([0; 3].map(|_| random.between(-1.0, 1.0))).normalize();
        let side = ahead.any_orthonormal_vector();
        let base = [0.0, 2.0, 4.0].map(|n: f64| 0.45 * ahead + 0.02 * (n.cos() * side + n.sin() * ahead.cross(side)));
        let [o, a, b, c] = [DVec3::ZERO, base[0], base[1], base[2]].map(|p| p + 0.5);
        vec![[o, b, a], [o, c, b], [o, a, c], [a, b, c]]
    };
    let star = (0..count).map(&mut spike).collect();
    let families: [(&str, Solids, Option<f64>); 5] = [
        ("apart", apart, Some(0.8 * 0.08 * f64::from(count) * turn(0.6).sin())),
        ("flush", flush, Some(0.08 * f64::from(count) * turn(1.0).sin())),
        ("overlapping", overlapping, None),
        ("shifted", shifted, None),
        ("star", star, None),
    ];
    for (name, solids, volume) in families {
        let bodies = scene(&solids);
        let surfaces = surfaces(&bodies, &bodies.triangles);
        for edges in [[edges(1), edges(1), edges(1)], [edges(3), edges(2), edges(1)]] {
            let all = Edges(edges);
            let grid = all.grid(None).expect("a grid");
            let expected = fields(&grid, &surfaces, Given { near: 0, ..PLENTY });
            assert!(expected.reports.iter().all(|r| r.max_gap < 1e-10), "{name}");
            let found = fields(&grid, &surfaces, PLENTY);
            assert!(found.value == expected.value && found.bounds == expected.bounds, "{name}");
            let solid: f64 = found.reports.iter().map(|r| r.solid_volume).sum();
            assert!(volume.is_none_or(|v| (solid - v).abs() < 1e-12), "{name}: {solid} of {volume:?}");
        }
    }
}

#[test]
fn single_precision_holds_double_precision() {
    let bodies = scene(&overlapping(&mut Random::new(11)));
    let double = Edges([edges(6), edges(5), edges(4)]);
    let expected = fields(&double.grid(None).expect("a grid"), &surfaces(&bodies, &bodies.triangles), PLENTY);
    let single: Vec<[Vec3; 3]> = bodies.triangles.iter().map(|t| t.map(|p| p.as_vec3())).collect();
    let single: Vec<_> = bodies.bodies.iter().map(|b| Surface::new(&single[b.triangles.clone()])).collect();
    let [x, y, z] = [6, 5, 4].map(|n| edges(n).into_iter().map(|e| e as f32).collect::<Vec<_>>());
    let found = fields(&Grid::new(&x, &y, &z).expect("a grid"), &single, PLENTY);
    for at in 0..expected.value[0].len() {
        let [low, high] = [0, 1].map(|n| f64::from(found.bounds[n][0][at]));
        let truth = expected.value[0][at];
        assert!(low - 1e-4 <= truth && truth <= high + 1e-4, "cell {at}: {truth} in {low}..{high}");
    }
    let widest = found.reports.iter().fold(0.0, |m: f32, r| m.max(r.max_gap));
    assert!(widest < 0.02, "{widest}");
}

/// Boxes whose corners are multiples of a step, at some offset, in single precision: bounds hold what double precision makes of the same numbers, above all
/// for faces at the sides of the grid in whose planes several boxes have walls.
#[test]
fn walls_in_single_precision() {
    let random = &mut Random::new(29);
    let (mut shared, mut wide) = (0, 0);
    for scene in 0..600 {
        let (parts, offset) =
            ([8.0_f32, 4.0, 3.0, 10.0][random.below(4)], [0.0_f32, 0.0, 10.0, 100.0, 1000.0][random.below(5)]);
        let mut two = || {
            let (a, b) = (random.below(9), random.below(8));
            let b = if b < a { b } else { b + 1 };
            [a.min(b), a.max(b)]
        };
        let place = |n: usize| n as f32 / parts + offset;
        // Two cells, if there is a plane between.
        let axis = |[from, to]: [usize; 2]| {
            let mut planes = vec![from, (from + to) / 2, to];
            planes.dedup();
            planes.into_iter().map(place).collect::<Vec<f32>>()
        };
        let edges = [axis(two()), axis(two()), axis(two())];
        let corners: Vec<[[f32; 2]; 3]> =
            (0..2 + scene % 3).map(|_| [two(), two(), two()].map(|ends| ends.map(place))).collect();
        let cuboid = |[x, y, z]: &[[f32; 2]; 3]| {
            let corner = |n: usize| DVec3::new(f64::from(x[n]), f64::from(y[n]), f64::from(z[n]));
            cuboid(corner(0), corner(1))
        };
        let double: Vec<Vec<[DVec3; 3]>> = corners.iter().map(cuboid).collect();
        let single: Vec<Vec<[Vec3; 3]>> =
            double.iter().map(|body| body.iter().map(|t| t.map(|p| p.as_vec3())).collect()).collect();
        let wider = edges.each_ref().map(|axis| axis.iter().map(|&e| f64::from(e)).collect::<Vec<_>>());
        let given = Given { pieces: 400, ..PLENTY };
        let truth = {
            let surfaces: Vec<_> = double.iter().map(|body| Surface::new(body)).collect();
            fields(&Grid::new(&wider[0], &wider[1], &wider[2]).expect("a grid"), &surfaces, given)
        };
        let surfaces: Vec<_> = single.iter().map(|body| Surface::new(body)).collect();
        let found = fields(&Grid::new(&edges[0], &edges[1], &edges[2]).expect("a grid"), &surfaces, given);
        let room = 100.0 * f64::from(f32::EPSILON) * f64::from(offset.max(1.0) * parts);
        for kind in 0..4 {
            for (at, &truth) in truth.value[kind].iter().enumerate() {
                let [low, high] = [0, 1].map(|n| f64::from(found.bounds[n][kind][at]));
                assert!(
                    low - room <= truth && truth <= high + room,
                    "scene {scene}, field {kind}, place {at}: {truth} in {low}..{high}, offset {offset}"
                );
                shared += usize::from(truth > 0.0 && truth < 1.0);
                wide += usize::from(offset == 0.0 && high - low > 1e-3);
            }
        }
    }
    assert!(shared > 3000 && wide == 0, "{shared} open in part, {wide} of them near the origin not known");
}

/// The plane that halves a cell far from the origin is rounded: what is on its sides counts by its width.
#[test]
fn parts_of_cells_far_off_count_by_their_width() {
    let from = 700.1_f32;
    let to = (0..1501).fold(from, |x, _| x.next_up());
    let middle = from + 0.5 * (to - from);
    let [below, above] = [f64::from(middle - from), f64::from(to - middle)].map(|w| w / f64::from(to - from));
    assert!((below - above).abs() > 5e-4);
    let cell = [from, to];
    let grid = Grid::new(&cell, &cell, &cell).expect("a grid");
    for axes in [[0, 1], [1, 2], [2, 0]] {
        let half = |axis: usize| {
            let mut corner = Vec3::splat(to).as_dvec3();
            corner[axis] = f64::from(middle);
            let body = cuboid(Vec3::splat(from).as_dvec3(), corner);
            body.iter().map(|t| t.map(|p| p.as_vec3())).collect::<Vec<_>>()
        };
        let halves = axes.map(half);
        let surfaces = halves.each_ref().map(|body| Surface::new(body));
        let found = fields(&grid, &surfaces, Given { pieces: 0, ..PLENTY });
        assert_eq!(found.reports[0].divided, 1);
        let [low, high] = [0, 1].map(|n| f64::from(found.bounds[n][0][0]));
        let truth = above * above;
        assert!(low - 1e-5 <= truth && truth <= high + 1e-5 && high - low < 1e-4, "{truth} in {low}..{high}");
    }
}

#[test]
fn no_input_panics() {
    let double = (0..50_000).filter(|&seed| never_panics::<DVec3>(seed)).count();
    let single = (0..50_000).filter(|&seed| never_panics::<Vec3>(seed)).count();
    assert!(double > 4000 && single > 2000, "{double} and {single} scenes came as far as their layers");
}

/// Solid volume of one closed surface in the unit cube, and the largest leak.
fn solid_volume<V: Vector>(triangles: &[[V; 3]], n: usize) -> (V::Scalar, V::Scalar) {
    let edges: Vec<V::Scalar> = (0..=n).map(|i| V::Scalar::from_usize(i) / V::Scalar::from_usize(n)).collect();
    let grid = Grid::new(&edges, &edges, &edges).expect("a grid");
    let found = fields(&grid, &[Surface::new(triangles)], Given { tenths: 0, pieces: 0, near: 0 });
    found.reports.iter().fold((V::Scalar::ZERO, V::Scalar::ZERO), |(volume, leak), r| {
        (volume + r.solid_volume, leak.max(r.defects.leak))
    })
}

#[test]
fn a_sphere_in_both_precisions() {
    let ball = sphere(DVec3::splat(0.5), 0.4, 5);
    let (v, leak) = solid_volume(&ball, 13);
    assert!((v - volume(&ball)).abs() < 1e-14 && leak < 1e-13, "{v} {leak}");
    let single: Vec<[Vec3; 3]> = ball.iter().map(|t| t.map(|p| p.as_vec3())).collect();
    let (v, leak) = solid_volume(&single, 13);
    assert!((f64::from(v) - volume(&ball)).abs() < 1e-5 && leak < 1e-4, "{v} {leak}");
}

#[test]
fn a_missing_triangle_leaks() {
    let mut ball = sphere(DVec3::splat(0.5), 0.4, 5);
    ball.pop();
    assert!(solid_volume(&ball, 13).1 > 0.01);
}

#[test]
fn wrong_shapes_are_refused() {
    let e = [0.0, 1.0, 2.0];
    let grid = Grid::new(&e, &e, &e).expect("a grid");
    let mut short = [0.0; 3];
    let needed = Scratch::needed(&grid);
    assert_eq!(Scratch::new(&grid, &mut short).err(), Some(ShapeMismatch { expected: needed, found: 3 }));
    let mut short = [0_u8; 3];
    assert!(Fields::within(&grid, &mut short).is_err());
    assert_eq!(grid.cell_box([0, 2, 0]), None);
    assert_eq!(grid.cell_box([usize::MAX; 3]), None);
}

#[test]
fn bodies_that_do_not_fit_the_layer_are_refused() {
    let e = [0.0, 0.25, 0.5, 1.0];
    let (grid, smaller) = (Grid::new(&e, &e, &e).expect("a grid"), Grid::new(&e[1..], &e, &e).expect("a grid"));
    let ball = sphere(DVec3::splat(0.5), 0.4, 3);
    let ids = room::<u32>(1);
    let (mut lower, mut sum, mut flags, mut scratch) = (room(99), room(99), room(99), room(99));
    let mut add = |own: &Grid<f64>, k: usize, ids: &[u32], ball: &[[DVec3; 3]]| {
        let fields = (Fields::within(own, &mut lower).expect("room"), Fields::within(own, &mut sum).expect("room"));
        let mut layer = Layer::new(fields.0, fields.1, Fields::within(own, &mut flags).expect("room")).expect("equal");
        let mut scratch = Scratch::new(own, &mut scratch[..Scratch::needed(own)]).expect("room");
        let cells = add_body(&grid, k, ball, ids, &mut scratch, &mut layer).err();
        (cells, add_section(&grid, k + 1, Side::Above, ball, ids, &mut scratch, &mut layer).err())
    };
    let shape = SurfaceError::Shape(ShapeMismatch { expected: 3, found: 2 });
    assert_eq!(add(&grid, 2, &ids, &ball), (None, None));
    assert_eq!(add(&smaller, 2, &ids, &ball), (Some(shape), Some(shape)));
    let (no_layer, no_plane) =
        (SurfaceError::NoLayer { layer: 3, layers: 3 }, SurfaceError::NoLayer { layer: 4, layers: 4 });
    assert_eq!(add(&grid, 3, &ids, &ball), (Some(no_layer), Some(no_plane)));
    let missing = SurfaceError::NoTriangle { id: 5, triangles: 1 };
    assert_eq!(add(&grid, 1, &[0, 5], &ball[..1]), (Some(missing), Some(missing)));
    let broken = SurfaceError::NotFinite { id: 0 };
    assert_eq!(add(&grid, 1, &ids, &[[DVec3::NAN; 3]]), (Some(broken), Some(broken)));
}

#[test]
fn the_door_refuses_what_does_not_fit() {
    let e = [0.0, 0.5, 1.0];
    let grid = Grid::new(&e, &e, &e).expect("a grid");
    let other = Grid::new(&e[..2], &e, &e).expect("a grid");
    let ball = sphere(DVec3::splat(0.5), 0.4, 3);
    let (mut numbers, mut groups) = (room(5000), room(50));
    let infinite = [[DVec3::splat(f64::INFINITY); 3]];
    let bodies = [Surface::new(&ball), Surface::new(&infinite)];
    let options = LayerOptions::default();
    let found = Layers::new(&grid, &bodies, options, &mut numbers, &mut groups).err();
    assert_eq!(found, Some(BinsError::NotFinite { body: 1, triangle: 0 }));
    let bodies = [Surface::new(&ball)];
    let needed = Layers::needed(&grid, &bodies);
    for (n, g) in [(0, needed.groups), (needed.numbers - 1, needed.groups), (needed.numbers, 0)] {
        let found = Layers::new(&grid, &bodies, options, &mut numbers[..n], &mut groups[..g]).err();
        assert!(matches!(found, Some(BinsError::Memory { .. })), "{found:?}");
    }
    let layers = Layers::new(&grid, &bodies, options, &mut numbers, &mut groups).expect("sorted");
    let needed = LayerMemory::<DVec3>::needed(&grid);
    let (mut reals, mut flags) = (room(needed.reals), room(needed.flags));
    let found = LayerMemory::<DVec3>::new(
        &grid,
        &mut reals[..needed.reals - 1],
        &mut flags,
        &mut [],
        &mut [],
        UnionMemory::default(),
    );
    assert_eq!(found.err(), Some(ShapeMismatch { expected: needed.reals, found: needed.reals - 1 }));
    let mut layer = |own: &Grid<f64>, k: usize, count: usize| {
        let mut memory =
            LayerMemory::new(own, &mut reals, &mut flags, &mut [], &mut [], UnionMemory::default()).expect("room");
        let (mut v, mut x, mut y, mut z, mut top) = (room(count), room(6), room(6), room(4), room(4));
        let top = if k == 1 { &mut top[..] } else { &mut [] };
        layers.layer(k, LayerSlices::new(&mut v, &mut x, &mut y, &mut z, top), None, &mut memory)
    };
    assert_eq!(layer(&grid, 2, 4).err(), Some(LayerError::NoLayer { layer: 2, layers: 2 }));
    assert_eq!(layer(&other, 1, 4).err(), Some(LayerError::OtherGrid));
    assert_eq!(layer(&grid, 1, 5).err(), Some(LayerError::Shape(ShapeMismatch { expected: 4, found: 5 })));
    assert!(layer(&grid, 0, 4).is_ok() && layer(&grid, 1, 4).is_ok());
    let (mut v, mut short) = (room(8), room(3));
    let found = LayerSlices::of_fields(&grid, 0, &mut v, [&mut short, &mut [], &mut []]);
    assert_eq!(found.err(), Some(LayerError::Shape(ShapeMismatch { expected: 12, found: 3 })));
}

#[test]
fn edges_that_are_no_grid_are_refused() {
    let good = [0.0, 1.0];
    let bad = |x: &[f64]| Grid::new(x, &good, &good).err();
    assert_eq!(bad(&[]), Some(GridError::NoCell { axis: 0 }));
    assert_eq!(bad(&[1.0]), Some(GridError::NoCell { axis: 0 }));
    assert_eq!(bad(&[0.0, f64::NAN]), Some(GridError::NotFinite { axis: 0, index: 1 }));
    assert_eq!(bad(&[0.0, 1.0, 1.0]), Some(GridError::NotIncreasing { axis: 0, index: 2 }));
    assert_eq!(bad(&[0.0, 1e-310]), Some(GridError::OutOfRange));
    assert_eq!(bad(&[-1e308, 1e308]), Some(GridError::OutOfRange));
    assert_eq!(bad(&[0.0, 1.0]), None);
}
