//! The paper's road on surfaces that are not convex, against the sums over the same surfaces, which are exact.

use glam::{DMat3, DVec3, Vec3};
use proptest::prelude::*;
use std::f64::consts::TAU;
use voidage::geometry::bodies::Bodies;
use voidage::geometry::form::Form;
use voidage::geometry::read;
use voidage::geometry::scene::hull::HullSolid;
use voidage::grid::Edges;
use voidage::porosity::{Leaf, Method, Options, Porosity};
use voidage_core::number::aabb::Aabb;
use voidage_core::number::real::{Real, Vector};
use voidage_core::subdivide::{
    Candidate, ClosedSurface, LeafRule, QueryCount, SubdivisionMemory, SubdivisionRule, share,
};
use voidage_tests::convex::{run, small_grid};
use voidage_tests::random::Random;
use voidage_tests::solids::{Triangle, cuboid, scene, sphere, turned_box, volume};
use voidage_tests::truth::fixture;

fn paper(leaf: Leaf, depth: u32) -> Options {
    Options { method: Method::Gjk, leaf, depth, bounds: true, ..Options::default() }
}

/// Room for the rounding of the sums over surfaces.
const ROUNDING: f64 = 1e-9;

/// Bounds hold the sums over the surface in every cell and face, or where unions of those have bounds of their own, something of these.
fn assert_holds(result: &Porosity, exact: &Porosity, what: &str) {
    let [lower, upper] = result.bounds.as_ref().expect("bounds");
    let [least, most] = exact.bounds.as_ref().expect("bounds");
    for (name, lower, upper, least, most) in [
        ("v", &lower.v, &upper.v, &least.v, &most.v),
        ("x", &lower.x, &upper.x, &least.x, &most.x),
        ("y", &lower.y, &upper.y, &least.y, &most.y),
        ("z", &lower.z, &upper.z, &least.z, &most.z),
    ] {
        for n in 0..lower.len() {
            let held = lower[n] <= most[n] + ROUNDING && least[n] <= upper[n] + ROUNDING;
            assert!(held, "{what}: {name}[{n}]: {}..{} in {}..{}", least[n], most[n], lower[n], upper[n]);
        }
    }
}

fn exact(edges: &Edges, bodies: &Bodies) -> Porosity {
    let exact = run(edges, bodies, Options { tol: 0.0, bounds: true, ..Options::default() }, 1);
    assert!(exact.winding < ROUNDING && exact.max_gap < 1e-4, "winding {}, gap {}", exact.winding, exact.max_gap);
    exact
}

/// The bounds of both leaves hold the sums over the surface in every cell and face.
fn bounds_hold_the_surface(edges: &Edges, bodies: &Bodies, depth: u32, what: &str) {
    let exact = exact(edges, bodies);
    for leaf in [Leaf::Solid, Leaf::Half] {
        let result = run(edges, bodies, paper(leaf, depth), 1);
        assert_eq!(result.subdivided, bodies.bodies.len(), "{what}: no body goes by its surface");
        assert_holds(&result, &exact, &format!("{what}, {leaf:?}, depth {depth}"));
    }
}

/// The surface of some cubes of a lattice, as one: quads between those that are there and those that are not.
fn cubes(there: impl Fn([i32; 3]) -> bool, count: i32) -> Vec<Triangle> {
    let mut surface = Vec::new();
    for n in 0..count * count * count {
        let at = [n % count, n / count % count, n / count / count];
        if !there(at) {
            continue;
        }
        let min = DVec3::from_array(at.map(f64::from));
        for (side, quad) in cuboid(min, min + DVec3::ONE).chunks(2).enumerate() {
            let (axis, step) = (2 - side / 2, if side % 2 == 0 { -1 } else { 1 });
            let mut beside = at;
            beside[axis] += step;
            if !there(beside) {
                surface.extend_from_slice(quad);
            }
        }
    }
    surface
}

/// Moved, turned and scaled.
fn placed(triangles: &[Triangle], turn: DMat3, scale: f64, to: DVec3) -> Vec<Triangle> {
    triangles.iter().map(|t| t.map(|p| to + turn * (p * scale))).collect()
}

fn ring(center: DVec3, radius: f64, thickness: f64, turn: DMat3, parts: usize) -> Vec<Triangle> {
    let at = |i: usize, j: usize| {
        let [u, v] = [i, j].map(|n| TAU * (n % parts) as f64 / parts as f64);
        let out = radius + thickness * v.cos();
        center + turn * DVec3::new(out * u.cos(), out * u.sin(), thickness * v.sin())
    };
    let quads = (0..parts * parts).map(|n| (n / parts, n % parts));
    quads
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

fn hollow() -> Vec<Triangle> {
    let mut shell = turned_box(DVec3::splat(-0.02), DVec3::new(0.6, 0.5, 0.65), Random::new(4).turn());
    shell.extend(sphere(DVec3::new(-0.1, 0.05, 0.0), 0.35, 3).into_iter().map(|[a, b, c]| [a, c, b]));
    shell
}

fn shapes() -> [(&'static str, Vec<Triangle>); 4] {
    let turn = Random::new(11).turn();
    let stairs = cubes(|[x, y, z]| (0..3).contains(&x) && (0..3).contains(&y) && (0..3 - x).contains(&z), 3);
    [
        ("ring", ring(DVec3::new(0.03, -0.02, 0.01), 0.6, 0.25, turn, 24)),
        ("hollow box", hollow()),
        ("stairs", placed(&stairs, DMat3::IDENTITY, 0.5, DVec3::splat(-0.75))),
        ("turned stairs", placed(&stairs, turn, 0.4, turn * DVec3::splat(-0.6))),
    ]
}

fn even_grid(n: usize) -> Edges {
    let axis: Vec<f64> = (0..=n).map(|i| 2.0 * i as f64 / n as f64 - 1.0).collect();
    Edges([axis.clone(), axis.clone(), axis])
}

#[test]
fn bounds_hold_every_cell_and_face() {
    for (name, shape) in shapes() {
        for depth in 0..4 {
            bounds_hold_the_surface(&small_grid(), &scene(std::slice::from_ref(&shape)), depth, name);
        }
        bounds_hold_the_surface(&even_grid(16), &scene(&[shape]), 2, name);
    }
}

#[test]
fn stairs_on_grid_planes_are_exact() {
    // No part is cut: cells and walls are what the surface says they are, whatever the leaf.
    let (_, stairs) = &shapes()[2];
    let bodies = scene(std::slice::from_ref(stairs));
    for cells in [8, 16] {
        let exact = run(&even_grid(cells), &bodies, Options::default(), 1);
        for leaf in [Leaf::Solid, Leaf::Half] {
            let found = run(&even_grid(cells), &bodies, paper(leaf, 2), 1);
            assert_eq!((found.beta, found.max_gap), (exact.beta.clone(), 0.0), "{cells} cells, {leaf:?}");
        }
    }
}

#[test]
fn the_leaves_err_as_theory_says() {
    for (name, shape) in shapes().into_iter().filter(|(name, _)| *name != "stairs") {
        let truth = run(&even_grid(1), &scene(std::slice::from_ref(&shape)), Options::default(), 1).solid_volume;
        let found = |leaf| {
            let options = Options { areas: false, bounds: false, ..paper(leaf, 3) };
            run(&even_grid(20), &scene(std::slice::from_ref(&shape)), options, 1).solid_volume
        };
        // (δ/2)∮(|n_x| + |n_y| + |n_z|)dS
        let reach = |t: &Triangle| (t[1] - t[0]).cross(t[2] - t[0]).abs().element_sum() * 0.5;
        let bias = shape.iter().map(reach).sum::<f64>() * (0.1 / 8.0) / 2.0;
        let (solid, half) = (found(Leaf::Solid) - truth, found(Leaf::Half) - truth);
        println!("{name}: solid {solid:.6}, theory {bias:.6}, half {:.1e} of {truth:.6}", half / truth);
        assert!((solid / bias - 1.0).abs() < 0.05, "{name}: {solid} against {bias}");
        assert!(half.abs() < 0.02 * bias, "{name}: {half} against {bias}");
    }
}

#[test]
fn the_skid_is_held_and_approached() {
    let mut bodies = Bodies::default();
    bodies.add(&read::read(&fixture("cad_skid.stl")).expect("a mesh"), 1.0).expect("bodies");
    let axis = |n: usize, length: f64| (0..=n).map(|i| i as f64 * length / n as f64).collect::<Vec<_>>();
    let edges = Edges([axis(30, 8.4), axis(17, 4.7), axis(13, 3.7)]);
    let exact = exact(&edges, &bodies);
    let errors = [1, 2].map(|depth| {
        let result = run(&edges, &bodies, paper(Leaf::Solid, depth), 2);
        assert_eq!(result.subdivided, bodies.bodies.len());
        assert_holds(&result, &exact, "skid");
        result.solid_volume - exact.solid_volume
    });
    println!("skid: {:.4} m³, too much by {errors:.4?}", exact.solid_volume);
    assert!(errors[0] > errors[1] && errors[1] > 0.0);
}

#[test]
fn bits_do_not_depend_on_threads() {
    let solids = shapes().map(|(_, shape)| shape);
    let one = run(&even_grid(9), &scene(&solids), paper(Leaf::Half, 2), 1);
    assert_eq!(one, run(&even_grid(9), &scene(&solids), paper(Leaf::Half, 2), 3));
}

/// Bounds of the share of a cube, which may be a face of it.
fn measured<V: Vector>(triangles: &[[V; 3]], cell: &Aabb<V>) -> [f64; 2] {
    let (mut candidates, mut facets) = (vec![Candidate::default(); 64], vec![0; 8 * triangles.len()]);
    let mut memory = SubdivisionMemory { candidates: &mut candidates, facets: &mut facets };
    let rule = SubdivisionRule { leaf: LeafRule::Half, depth: 3, tol: V::Scalar::ZERO };
    let found =
        share(cell, &[ClosedSurface::new(triangles)], rule, &mut memory, &mut QueryCount::default()).expect("room");
    [found.lower.to_f64(), found.upper.to_f64()]
}

#[test]
fn single_and_double_precision_do_not_contradict_each_other() {
    let mut random = Random::new(23);
    for (name, shape) in shapes() {
        let single: Vec<[Vec3; 3]> = shape.iter().map(|t| t.map(|p| p.as_vec3())).collect();
        let double: Vec<Triangle> = single.iter().map(|t| t.map(|p| p.as_dvec3())).collect();
        for n in 0..60 {
            // Every other on the planes of the stairs.
            let unit = if n % 2 == 0 { 4.0 } else { 1000.0 };
            let min = ((random.vector::<DVec3>(0.8) * unit).round() / unit).as_vec3();
            let mut size = Vec3::splat(0.25);
            if n % 3 > 0 {
                size[n % 3] = 0.0;
            }
            let small = measured(&single, &Aabb { min, max: min + size });
            let large = measured(&double, &Aabb { min: min.as_dvec3(), max: (min + size).as_dvec3() });
            assert!(small[0] <= large[1] && large[0] <= small[1], "{name} at {min}: {small:?} and {large:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    /// Cubes that meet in faces, edges and corners, with cavities, on the planes of the grid, between them, or askew.
    #[test]
    fn bounds_hold_heaps_of_cubes(bits in 1u32..1 << 27, place in 0usize..4, depth in 0u32..3) {
        let there = |at: [i32; 3]| {
            at.iter().all(|c| (0..3).contains(c)) && bits >> (at[0] + 3 * at[1] + 9 * at[2]) & 1 == 1
        };
        let heap = cubes(there, 3);
        prop_assert!((volume(&heap) - f64::from(bits.count_ones())).abs() < 1e-9);
        let (turn, scale, to) = [
            (DMat3::IDENTITY, 0.5, DVec3::splat(-0.75)),
            (DMat3::IDENTITY, 0.55, DVec3::new(-0.8, -0.77, -0.9)),
            (DMat3::IDENTITY, 0.25, DVec3::new(-0.25, 0.0, 0.25)),
            (Random::new(u64::from(bits)).turn(), 0.35, DVec3::new(-0.2, 0.1, -0.5)),
        ][place];
        let bodies = scene(&[placed(&heap, turn, scale, to)]);
        bounds_hold_the_surface(&even_grid(8), &bodies, depth, "heap");
    }
}

/// Regular prisms along an axis of the grid, their corners by sine and cosine: sides that are along an axis but for rounding reach heights of 1e16 cells
/// over the columns of a part, and those that stand beside each other must not leave their rounding in its share.
#[test]
fn prisms_along_axes_but_for_rounding() {
    let edges = Edges([vec![0.0, 0.3, 0.7, 1.0], vec![0.0, 0.3, 0.7, 1.0], vec![0.0, 0.3, 0.7, 1.0]]);
    let random = &mut Random::new(31);
    for n in 0..200 {
        let sides = [6, 8, 12][n % 3];
        let (axis, turned) = (n / 3 % 3, [0.0, 0.5, 0.25][n / 9 % 3]);
        let radius = [0.25, 0.1, 0.31][n % 3];
        let middle = [0, 1, 2].map(|_| [0.25, 0.5, 0.75, 0.3, 0.62][random.below(5)]);
        let corner = |i: usize, high: bool| {
            let angle = TAU * (i as f64 + turned) / sides as f64;
            let mut at = middle;
            at[(axis + 1) % 3] += radius * angle.sin();
            at[(axis + 2) % 3] += radius * angle.cos();
            at[axis] += if high { 0.0625 } else { -0.0625 };
            DVec3::from_array(at)
        };
        let corners: Vec<DVec3> = (0..2 * sides).map(|i| corner(i / 2, i % 2 == 1)).collect();
        let hull = HullSolid::new(&corners).expect("a hull");
        let mut bodies = scene(&[hull.surface()]);
        bodies.bodies[0].form = Some(Form::Hull(hull.corners.into()));
        let exact = exact(&edges, &bodies);
        for depth in [3, 6] {
            let result = run(&edges, &bodies, paper(Leaf::Plane, depth), 1);
            assert_eq!(result.subdivided, 1);
            let what = format!("prism {n}: {sides} sides, axis {axis}, at {middle:?}, depth {depth}");
            assert_holds(&result, &exact, &what);
            let [lower, upper] = result.bounds.as_ref().expect("bounds");
            for (lower, upper) in
                [(&lower.v, &upper.v), (&lower.x, &upper.x), (&lower.y, &upper.y), (&lower.z, &upper.z)]
            {
                assert!(lower.iter().zip(upper.iter()).all(|(lower, upper)| lower <= upper), "{what}: bounds cross");
            }
        }
    }
}
