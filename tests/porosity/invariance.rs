//! What must not matter: where the origin is, which axis is called x, the unit, the number of threads.

use glam::DVec3;
use voidage::grid::Edges;
use voidage::porosity::{FieldSet, HugeVec, Options, Porosity, porosity};
use voidage_tests::fields::assert_close;
use voidage_tests::lattice::Lattice;
use voidage_tests::random::Random;
use voidage_tests::solids::{Triangle, scene, sphere, turned_box};

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
