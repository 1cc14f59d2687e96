//! What must not matter: where the origin is, which axis is called x, the unit, the number of threads.

use glam::DVec3;
use voidage::geometry::form::Form;
use voidage::grid::Edges;
use voidage::porosity::{FieldSet, HugeVec, Options, Porosity, porosity};
use voidage_core::convex::shape::{Capsule, Cylinder, Sphere};
use voidage_tests::effort::cases;
use voidage_tests::fields::assert_close;
use voidage_tests::lattice::Lattice;
use voidage_tests::random::Random;
use voidage_tests::solids::{Triangle, formulas, scene, sphere, turned_box};

fn solids() -> Vec<Vec<Triangle>> {
    let mut rng = Random::new(7);
    let turned = |rng: &mut Random| {
        turned_box(rng.point(DVec3::splat(0.3), DVec3::splat(0.7)), DVec3::new(0.3, 0.1, 0.05), rng.turn())
    };
    vec![turned(&mut rng), turned(&mut rng), turned(&mut rng), sphere(DVec3::splat(0.5), 0.2, 5)]
}

fn edges() -> Edges {
    let axis = |n: usize| (0..=n).map(|i| i as f64 / n as f64).collect();
    Edges([axis(7), axis(9), axis(11)])
}

fn run(edges: &Edges, solids: &[Vec<Triangle>]) -> Porosity {
    porosity(&edges.grid(None).expect("a grid"), &scene(solids), Options::default())
}

fn map(solids: &[Vec<Triangle>], f: impl Fn(DVec3) -> DVec3) -> Vec<Vec<Triangle>> {
    solids.iter().map(|s| s.iter().map(|t| t.map(&f)).collect()).collect()
}

#[test]
fn powers_of_two_change_no_bit() {
    let (edges, solids) = (edges(), solids());
    let plain = run(&edges, &solids);
    for exponent in [-40, -3, 1, 60] {
        let s = 2.0_f64.powi(exponent);
        let scaled = Edges(edges.0.clone().map(|e| e.into_iter().map(|c| c * s).collect()));
        let p = run(&scaled, &map(&solids, |p| p * s));
        assert!(p.beta == plain.beta, "2^{exponent}");
        assert_eq!(p.solid_volume, plain.solid_volume * s * s * s);
    }
}

#[test]
fn translation_by_whole_numbers_changes_only_rounding() {
    let (edges, solids) = (edges(), solids());
    let plain = run(&edges, &solids);
    for shift in [DVec3::new(1.0, -2.0, 3.0), DVec3::splat(64.0)] {
        let moved = Edges([0, 1, 2].map(|a| edges.0[a].iter().map(|c| c + shift[a]).collect()));
        let p = run(&moved, &map(&solids, |p| p + shift));
        assert_close(&p.beta, &plain.beta, 1e-11, &format!("{shift}"));
    }
}

/// Meshes and solids by formula at the coordinates of a survey, all numbers multiples of the last place there: seen from the corner of the grid nothing is lost.
#[test]
fn far_from_the_origin_meshes_beside_formulas_lose_nothing() {
    let mut random = Random::new(23);
    let (far, place) = (DVec3::new(524_285.0, 4_194_311.0, -3.0), 2.0_f64.powi(30));
    let held = |p: DVec3| (p * place).round() / place;
    for n in 0..cases(24) {
        let size = [1.0, 1.0 / 64.0][random.below(2)];
        let mut point = |reach: f64| held(random.point(DVec3::splat(-reach), DVec3::splat(reach)) * size);
        let [a, b, c, d] = [0; 4].map(|_| point(0.7));
        let turned = turned_box(a, DVec3::new(0.3, 0.2, 0.1) * size, random.turn());
        let meshes: Vec<_> = [turned, sphere(b, 0.4 * size, 2)].map(|m| map(&[m], held).remove(0)).into();
        let forms = |o: DVec3| {
            let radius = held(DVec3::splat((0.15 + 0.02 * (n % 7) as f64) * size)).x;
            vec![
                Form::Sphere(Sphere { center: c + o, radius }),
                Form::Cylinder(Cylinder::new(d + o, b + o, 0.5 * radius)),
                Form::Capsule(Capsule { from: a + o, to: c + o, radius: 0.25 * radius }),
            ]
        };
        let [near, seen] = [DVec3::ZERO, far].map(|o| {
            let plane = |i: i32| held(DVec3::splat((f64::from(i) / 3.0 - 1.0) * size)).x;
            let edges = Edges([0, 1, 2].map(|axis| (0..=6).map(|i| plane(i) + o[axis]).collect()));
            let mut bodies = scene(&map(&meshes, |p| p + o));
            bodies.bodies.extend(formulas(&forms(o)[..=n % 3]).bodies);
            let options = Options { bounds: true, ..Options::default() };
            porosity(&edges.grid(None).expect("a grid"), &bodies, options)
        });
        let [one, two] = [&near, &seen].map(|p| p.bounds.as_ref().expect("bounds"));
        let all = |f: &FieldSet| -> Vec<f64> {
            [&f.v, &f.x, &f.y, &f.z].into_iter().flat_map(|f| f.iter().copied()).collect()
        };
        let [low, high] = [0, 1].map(|end| all(&one[end]).into_iter().zip(all(&two[end])).collect::<Vec<_>>());
        for (at, (low, high)) in low.into_iter().zip(high).enumerate() {
            assert!(low.0.max(low.1) <= high.0.min(high.1) + 2e-12, "{n}, {at}: {low:?} to {high:?}");
        }
        assert!(seen.max_gap <= 1e-4 && near.max_gap <= 1e-4, "{n}: {} {}", near.max_gap, seen.max_gap);
    }
}

/// Boxes with integer corners: translation and naming of axes change at most the last place of a third.
#[test]
fn simple_solids_are_exact_anywhere_and_along_any_axis() {
    for seed in 0..20 {
        let solids = Lattice::random(&mut Random::new(seed), 4).solids();
        let edges = Edges([vec![0.0, 4.0, 8.0, 16.0], vec![0.0, 2.0, 8.0, 12.0, 16.0], vec![0.0, 8.0, 16.0]]);
        let plain = run(&edges, &solids);
        let shift = DVec3::new(1024.0, -512.0, 64.0);
        let moved = Edges([0, 1, 2].map(|a| edges.0[a].iter().map(|c| c + shift[a]).collect()));
        assert_close(
            &run(&moved, &map(&solids, |p| p + shift)).beta,
            &plain.beta,
            4e-16,
            &format!("moved, seed {seed}"),
        );
        let turned = Edges([edges.0[1].clone(), edges.0[2].clone(), edges.0[0].clone()]);
        let p = run(&turned, &map(&solids, |p| DVec3::new(p.y, p.z, p.x)));
        assert_close(&back(&p.beta, [4, 2, 3]), &plain.beta, 4e-16, &format!("turned, seed {seed}"));
    }
}

#[test]
fn axes_are_alike() {
    let (edges, solids) = (edges(), solids());
    let plain = run(&edges, &solids);
    let turned = Edges([edges.0[1].clone(), edges.0[2].clone(), edges.0[0].clone()]);
    let p = run(&turned, &map(&solids, |p| DVec3::new(p.y, p.z, p.x)));
    assert_close(&back(&p.beta, [9, 11, 7]), &plain.beta, 1e-12, "turned");
}

/// From axes (y, z, x), with `n` cells along each, back to (x, y, z).
fn back(f: &FieldSet, n: [usize; 3]) -> FieldSet {
    let turn = |field: &[f64], [a, b, c]: [usize; 3]| {
        // Here the new x is the third index, the new y the first, the new z the second.
        let mut out = Vec::with_capacity(field.len());
        for z in 0..b {
            for y in 0..a {
                out.extend((0..c).map(|x| field[(x * b + z) * a + y]));
            }
        }
        HugeVec::from(out)
    };
    let [a, b, c] = n;
    FieldSet {
        v: turn(&f.v, n),
        x: turn(&f.z, [a, b, c + 1]),
        y: turn(&f.x, [a + 1, b, c]),
        z: turn(&f.y, [a, b + 1, c]),
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let (edges, solids) = (edges(), solids());
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| run(&edges, &solids))
    };
    let one = with(1);
    for threads in [2, 7] {
        assert!(with(threads) == one, "{threads} threads");
    }
}

#[test]
fn the_order_of_bodies_changes_only_rounding() {
    let (edges, mut solids) = (edges(), solids());
    let plain = run(&edges, &solids);
    solids.reverse();
    assert_close(&run(&edges, &solids).beta, &plain.beta, 1e-11, "reversed");
}
