//! Unions of bodies against an oracle, and against themselves.

use glam::{DMat3, DVec3};
use voidage::grid::Edges;
use voidage::porosity::{FieldSet, Options, porosity};
use voidage_tests::fields::assert_close;
use voidage_tests::lattice::{Lattice, SIDE};
use voidage_tests::random::Random;
use voidage_tests::solids::{Triangle, scene, sphere, turned_box};

fn oracle(lattice: &Lattice, edges: &[Vec<usize>; 3]) -> FieldSet {
    let [nx, ny, nz] = [0, 1, 2].map(|a: usize| edges[a].len() - 1);
    let [mut v, mut x, mut y, mut z] = [const { Vec::new() }; 4];
    let corner = |[i, j, k]: [usize; 3]| [edges[0][i], edges[1][j], edges[2][k]];
    for k in 0..nz {
        for j in 0..ny {
            v.extend((0..nx).map(|i| 1.0 - lattice.cell(corner([i, j, k]), corner([i + 1, j + 1, k + 1]))));
            x.extend((0..=nx).map(|i| 1.0 - lattice.face(0, corner([i, j, k]), corner([i, j + 1, k + 1]))));
        }
        for j in 0..=ny {
            y.extend((0..nx).map(|i| 1.0 - lattice.face(1, corner([i, j, k]), corner([i + 1, j, k + 1]))));
        }
    }
    for k in 0..=nz {
        for j in 0..ny {
            z.extend((0..nx).map(|i| 1.0 - lattice.face(2, corner([i, j, k]), corner([i + 1, j + 1, k]))));
        }
    }
    FieldSet { v: v.into(), x: x.into(), y: y.into(), z: z.into() }
}

/// Overlapping, touching and coincident boxes on grids whose planes hold their faces: every cell and face, walls included.
#[test]
fn boxes_on_a_lattice() {
    let whole: Vec<usize> = (0..=SIDE).collect();
    let grids = [
        [4, 4, 4].map(|step| whole.iter().copied().step_by(step).collect::<Vec<_>>()),
        [2, 8, 4].map(|step| whole.iter().copied().step_by(step).collect()),
        [vec![0, 1, 3, 7, 12, 16], vec![0, 2, 6, 16], vec![0, 5, 10, 16]],
        [vec![2, 6, 10, 14], vec![3, 7, 8, 13], vec![1, 9, 12]],
    ];
    let (mut shared, mut walls) = (0, 0);
    for seed in 0..200 {
        let mut rng = Random::new(seed);
        let count = 1 + rng.below(6);
        let lattice = Lattice::random(&mut rng, count);
        let bodies = scene(&lattice.solids());
        for (n, steps) in grids.iter().enumerate() {
            let edges = Edges(steps.clone().map(|e| e.into_iter().map(|c| c as f64).collect()));
            let p = porosity(&edges.grid(None).expect("a grid"), &bodies, Options::default());
            let expected = oracle(&lattice, steps);
            assert_close(&p.beta, &expected, 1e-12, &format!("seed {seed} grid {n} boxes {:?}", lattice.boxes));
            assert!(p.max_gap <= 1e-12, "seed {seed} grid {n}: gap {}", p.max_gap);
            shared += p.cells.ambiguous;
            walls += expected.x.iter().filter(|&&b| b > 0.0 && b < 1.0).count();
        }
    }
    assert!(
        shared > 1000 && walls > 1000,
        "the regimes were visited: {shared} shared cells, {walls} part-open x faces"
    );
}

fn random_solids(rng: &mut Random) -> Vec<Vec<Triangle>> {
    let (lo, hi) = (DVec3::splat(0.2), DVec3::splat(0.8));
    let count = 2 + rng.below(5);
    let one = |rng: &mut Random| {
        let center = rng.point(lo, hi);
        if rng.below(3) == 0 {
            sphere(center, rng.between(0.05, 0.25), 1 + rng.below(4))
        } else {
            turned_box(center, rng.point(DVec3::splat(0.02), DVec3::splat(0.3)), rng.turn())
        }
    };
    (0..count).map(|_| one(rng)).collect()
}

/// What eight small cells hold is what the large one holds, and so for faces.
#[test]
fn parts_sum_to_the_whole() {
    let mut shared = 0;
    for seed in 1000..1040 {
        let bodies = scene(&random_solids(&mut Random::new(seed)));
        let axis = |n: usize| -> Vec<f64> { (0..=n).map(|i| i as f64 / n as f64).collect() };
        let run = |n: usize| {
            let edges = Edges([axis(n), axis(n), axis(n)]);
            porosity(&edges.grid(None).expect("a grid"), &bodies, Options::default())
        };
        let (coarse, fine) = (run(4), run(8));
        shared += coarse.cells.ambiguous;
        assert_close(
            &coarse.beta,
            &merge(&fine.beta, 4),
            coarse.max_gap + fine.max_gap + 1e-12,
            &format!("seed {seed}"),
        );
        assert!(coarse.max_gap <= 1e-4 && fine.max_gap <= 1e-4, "seed {seed}: {} {}", coarse.max_gap, fine.max_gap);
    }
    assert!(shared > 200, "{shared}");
}

/// Merge 2×2×2 cells of a cubic grid; `n` is the number of coarse cells along an axis.
fn merge(fine: &FieldSet, n: usize) -> FieldSet {
    let [mut v, mut x, mut y, mut z] = [const { Vec::new() }; 4];
    let mean = |field: &[f64], shape: [usize; 2], at: [usize; 3], thick: [usize; 3]| {
        let mut sum = 0.0;
        for c in 0..thick[2] {
            for b in 0..thick[1] {
                for a in 0..thick[0] {
                    sum += field[((2 * at[2] + c) * shape[1] + 2 * at[1] + b) * shape[0] + 2 * at[0] + a];
                }
            }
        }
        sum / thick.iter().product::<usize>() as f64
    };
    for k in 0..=n {
        for j in 0..=n {
            for i in 0..=n {
                let at = [i, j, k];
                let m = 2 * n;
                if i < n && j < n && k < n {
                    v.push(mean(&fine.v, [m, m], at, [2, 2, 2]));
                }
                if j < n && k < n {
                    x.push(mean(&fine.x, [m + 1, m], at, [1, 2, 2]));
                }
                if i < n && k < n {
                    y.push(mean(&fine.y, [m, m + 1], at, [2, 1, 2]));
                }
                if i < n && j < n {
                    z.push(mean(&fine.z, [m, m], at, [2, 2, 1]));
                }
            }
        }
    }
    FieldSet { v: v.into(), x: x.into(), y: y.into(), z: z.into() }
}

/// Parts of one file that share corners are bodies of their own: a slab flush inside a box, in named solids.
#[test]
fn named_solids_that_share_corners_stay_apart() {
    use voidage::geometry::mesh::{Mesh, Solid};
    use voidage_tests::solids::cuboid;
    let low = DVec3::new(1.25, 0.75, 0.25);
    let mut triangles = cuboid(low, DVec3::new(2.0, 1.25, 1.0));
    triangles.extend(cuboid(low, DVec3::new(2.0, 1.25, 0.5)));
    let solids = [0..12, 12..24].map(|triangles| Solid { name: String::new(), triangles }).to_vec();
    let mut bodies = voidage::geometry::bodies::Bodies::default();
    let mesh = Mesh { name: "two.stl".into(), solids, ..Mesh::from(triangles) };
    bodies.add(&mesh, 1.0).expect("bodies");
    assert_eq!(bodies.bodies.len(), 2);
    let edges = Edges([vec![0.0, 3.0], vec![0.0, 3.0], vec![0.0, 3.0]]);
    let p = porosity(&edges.grid(None).expect("a grid"), &bodies, Options::default());
    assert!((p.solid_volume - 0.28125).abs() < 1e-14, "{}", p.solid_volume);
}

/// Bodies that differ by rounding have no provable union: the bounds must say so and hold the truth.
#[test]
fn nearly_coincident_bodies_are_bounded() {
    for seed in 0..10 {
        let mut rng = Random::new(seed);
        let (turn, half) = (rng.turn(), rng.point(DVec3::splat(0.1), DVec3::splat(0.4)));
        let solids: Vec<_> = (0..3)
            .map(|_| turned_box(DVec3::splat(0.5) + rng.point(DVec3::splat(-2e-14), DVec3::splat(2e-14)), half, turn))
            .collect();
        let bodies = scene(&solids);
        let axis: Vec<f64> = (0..=6).map(|i| -0.7 + 0.4 * f64::from(i)).collect();
        let edges = Edges([axis.clone(), axis.clone(), axis]);
        let grid = edges.grid(None).expect("a grid");
        let run = |bodies| porosity(&grid, bodies, Options { bounds: true, ..Options::default() });
        let (union, single) = (run(&bodies), run(&scene(&solids[..1])));
        let [lower, upper] = union.bounds.expect("bounds");
        for (n, b) in single.beta.v.iter().enumerate() {
            assert!(lower.v[n] <= b + 1e-9 && upper.v[n] >= b - 1e-9, "seed {seed} cell {n}");
        }
    }
}

/// The skid's caps miss the plane x = 0 by up to 3e-17: its faces are the same on every grid through that plane.
#[test]
fn walls_that_miss_a_plane_by_rounding_lie_in_it() {
    let mesh = voidage::geometry::read::read(&voidage_tests::truth::fixture("cad_skid.stl")).expect("a mesh");
    let mut bodies = voidage::geometry::bodies::Bodies::default();
    bodies.add(&mesh, 1.0).expect("bodies");
    let run = |n: usize| {
        let axis = |length: f64| (0..=n).map(|i| length * i as f64 / n as f64).collect();
        let edges = Edges([axis(8.36885), axis(4.6), axis(3.6)]);
        porosity(&edges.grid(None).expect("a grid"), &bodies, Options::default()).beta
    };
    assert_close(&run(8), &merge(&run(16), 8), 1e-9, "8 and 16 cells");
}

/// A prism of `sides` sides around an axis along x, closed at both ends by fans.
fn rod(from: DVec3, length: f64, radius: f64, sides: usize) -> Vec<Triangle> {
    let rim = |n: usize, x: f64| {
        let angle = (n % sides) as f64 * std::f64::consts::TAU / sides as f64;
        from + DVec3::new(x, radius * angle.cos(), radius * angle.sin())
    };
    let side = |n: usize| {
        let [a, b, c, d] = [rim(n, 0.0), rim(n + 1, 0.0), rim(n + 1, length), rim(n, length)];
        let [low, high] = [from, from + DVec3::X * length];
        [[a, b, c], [a, c, d], [low, b, a], [high, d, c]].map(|t| [t[0], t[2], t[1]])
    };
    (0..sides).flat_map(side).collect()
}

/// A wall with too much surface for one tree is divided; a body that holds a part of it without surface there still counts.
#[test]
fn divided_walls_keep_the_bodies_around_them() {
    let sides = 700;
    let center = DVec3::new(1.0, 0.75, 0.75);
    let solids = [
        rod(center, 0.5, 0.125, sides),
        voidage_tests::solids::cuboid(DVec3::new(0.5, -0.1, -0.1), DVec3::new(1.5, 0.6, 0.6)),
    ];
    let edges = Edges([vec![0.0, 1.0, 2.0], vec![0.0, 1.0], vec![0.0, 1.0]]);
    let p = porosity(&edges.grid(None).expect("a grid"), &scene(&solids), Options::default());
    let end = 0.5 * 0.125 * 0.125 * sides as f64 * (std::f64::consts::TAU / sides as f64).sin();
    let [gap, open] = [p.max_gap, p.beta.x[1]];
    assert!(gap <= 1e-4, "{gap}");
    assert!((open - (1.0 - 0.36 - end)).abs() <= 0.5 * gap + 1e-12, "{open}, exactly {}", 1.0 - 0.36 - end);
}

/// Copies of a box that miss each other by 1e-5 to 1e-15 of its size are one box but for as much.
#[test]
fn copies_that_nearly_coincide_have_narrow_bounds() {
    for seed in 0..24 {
        let mut rng = Random::new(9000 + seed);
        let (center, turn) = (rng.point(DVec3::splat(0.4), DVec3::splat(0.6)), rng.turn());
        let miss = 10.0_f64.powi(-6 - (seed % 10) as i32);
        let half = DVec3::new(0.31, 0.17, 0.23);
        let copies: Vec<_> =
            (0..3).map(|_| turned_box(center + rng.point(DVec3::ZERO, DVec3::splat(miss)), half, turn)).collect();
        let edges = [0, 1, 2].map(|_| vec![0.0, 0.5, 1.0]);
        let run = |solids: &[Vec<Triangle>]| {
            let options = Options { bounds: true, ..Options::default() };
            porosity(&Edges(edges.clone()).grid(None).expect("a grid"), &scene(solids), options)
        };
        let (one, all) = (run(&copies[..1]), run(&copies));
        assert!(all.max_gap <= 1e-4, "seed {seed}, apart by {miss:e}: gap {}", all.max_gap);
        assert_close(&all.beta, &one.beta, all.max_gap + 20.0 * miss, &format!("seed {seed}"));
    }
}

/// A body that stands a thousand times in one place, each from a file of its own, is one body; of two that differ in porosity the less open one.
#[test]
fn a_body_a_thousand_times_is_one() {
    let turned = turned_box(DVec3::new(0.5, 0.45, 0.55), DVec3::new(0.31, 0.17, 0.23), Random::new(3).turn());
    let edges = [0, 1, 2].map(|_| (0..=8).map(|n| f64::from(n) / 8.0).collect());
    let grid = Edges(edges);
    let run = |bodies: &_| porosity(&grid.grid(None).expect("a grid"), bodies, Options::default());
    let (one, mut all) = (scene(std::slice::from_ref(&turned)), scene(&vec![turned; 1000]));
    let (of_one, of_all) = (run(&one), run(&all));
    assert_close(&of_all.beta, &of_one.beta, 1e-13, "a thousand");
    assert!(of_all.max_gap < 1e-13, "{}", of_all.max_gap);
    for porosity in [0.0, 0.25] {
        for (n, body) in all.bodies.iter_mut().enumerate() {
            body.porosity = if n == 700 { porosity } else { 0.5 };
        }
        let mut one = one.clone();
        one.bodies[0].porosity = porosity;
        assert_close(&run(&all).beta, &run(&one).beta, 1e-14, &format!("porosity {porosity}"));
    }
}

/// Where division thins the bodies of a cell it goes on for as long as their number asks for, not for a time that is the same for all.
#[test]
fn ten_thousand_pieces_in_one_cell_are_summed() {
    const SIDE: usize = 22;
    let mut random = Random::new(9);
    let slot = 1.0 / SIDE as f64;
    let mut piece = |n: usize| {
        let at = DVec3::new((n % SIDE) as f64, (n / SIDE % SIDE) as f64, (n / SIDE / SIDE) as f64);
        let half = random.point(DVec3::splat(0.05), DVec3::splat(0.28)) * slot;
        turned_box((at + 0.5) * slot, half, random.turn())
    };
    let pieces: Vec<Vec<Triangle>> = (0..SIDE.pow(3)).map(&mut piece).collect();
    let edges = Edges([vec![0.0, 1.0], vec![0.0, 1.0], vec![0.0, 1.0]]);
    let found = porosity(&edges.grid(None).expect("a grid"), &scene(&pieces), Options::default());
    let truth = 1.0 - pieces.iter().map(|piece| voidage_tests::solids::volume(piece)).sum::<f64>();
    assert!((found.beta.v[0] - truth).abs() < 1e-12 && found.max_gap < 1e-9, "{} {truth}", found.beta.v[0]);
}

/// A turned box far from the origin, each triangle of its surface in `parts` parts along each side, corners in single precision.
fn tessellated(center: DVec3, half: DVec3, turn: DMat3, parts: u32) -> Vec<Triangle> {
    let whole = turned_box(center, half, turn);
    let steps = f64::from(parts);
    let mut found = Vec::new();
    for [a, b, c] in whole {
        let at = |i: u32, j: u32| (a + (b - a) * (f64::from(i) / steps) + (c - a) * (f64::from(j) / steps)).as_vec3();
        for i in 0..parts {
            for j in 0..parts - i {
                found.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
                if i + j + 1 < parts {
                    found.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
    }
    found.into_iter().map(|t| t.map(glam::Vec3::as_dvec3)).collect()
}

/// Planes that all but coincide: one body two or three times, each otherwise tessellated. Bounds of a cell and of its parts must agree.
#[test]
fn other_tessellations_of_one_body_have_true_bounds() {
    for seed in 0..300 {
        let mut rng = Random::new(seed);
        let (turn, half) = (rng.turn(), DVec3::new(0.7, 0.2, 0.1));
        let center = DVec3::splat(if seed % 2 == 0 { 0.0 } else { 7.0 });
        let count = 2 + rng.below(2);
        let solids: Vec<_> = (0..count).map(|_| tessellated(center, half, turn, 1 + rng.below(5) as u32)).collect();
        let bodies = scene(&solids);
        let cell = [0, 1, 2].map(|axis| center[axis] + rng.between(-0.3, 0.0));
        let size = [0, 1, 2].map(|_| rng.between(0.1, 0.4));
        let bounds = |parts: usize| {
            let edges =
                Edges([0, 1, 2].map(|a| (0..=parts).map(|n| cell[a] + size[a] * (n as f64 / parts as f64)).collect()));
            let options = Options { bounds: true, ..Options::default() };
            let p = porosity(&edges.grid(None).expect("a grid"), &bodies, options);
            let mean = |set: &FieldSet| set.v.iter().sum::<f64>() / set.v.len() as f64;
            let [lower, upper] = p.bounds.as_ref().expect("bounds");
            [mean(lower), mean(upper)]
        };
        let ([low, high], [least, most]) = (bounds(1), bounds(2));
        assert!(low <= most + 1e-12 && least <= high + 1e-12, "seed {seed}: {low} {high}, {least} {most}");
    }
}

/// By how much a scene in one coarse cell, which is not divided, and in small ones holds not the same.
fn is_divided_alike(solids: &[Vec<Triangle>], edges: &[Vec<f64>; 3], parts: usize) -> f64 {
    let bodies = scene(solids);
    let found = |edges: &[Vec<f64>; 3]| {
        let grid = Edges(edges.clone());
        porosity(&grid.grid(None).unwrap(), &bodies, Options::default())
    };
    let whole = found(edges);
    assert_eq!(whole.divided, 0);
    let finer = edges.each_ref().map(|e| {
        let (lo, hi) = (e[0], e[e.len() - 1]);
        (0..=parts).map(|n| lo + (hi - lo) * n as f64 / parts as f64).collect()
    });
    (whole.solid_volume - found(&finer).solid_volume).abs()
}

/// The planes of long thin triangles must be known as well as those of others: else one is taken to cut off what it does not.
#[test]
fn a_needle_hides_nothing() {
    let bipyramid = |[tip, end]: [DVec3; 2], ring: [DVec3; 3]| -> Vec<Triangle> {
        let [a, b, c] = ring;
        vec![[tip, b, a], [tip, c, b], [tip, a, c], [end, a, b], [end, b, c], [end, c, a]]
    };
    let needle = bipyramid(
        [
            DVec3::new(-0.100_535_021_157_171_62, 2.908_352_568_836_066, 1.365_912_736_801_805_1),
            DVec3::new(1.600_752_554_249_997_2, -0.593_062_564_254_297_9, 0.446_286_371_623_542_7),
        ],
        [
            DVec3::new(0.750_108_392_981_565_2, 1.157_644_820_781_063_2, 0.906_099_554_212_674),
            DVec3::new(0.750_108_724_816_108_6, 1.157_645_088_175_904_8, 0.906_099_150_011_170_6),
            DVec3::new(0.750_109_181_841_564_5, 1.157_645_097_915_684_5, 0.906_099_958_414_177_3),
        ],
    );
    let turn = DMat3::from_cols(
        DVec3::new(0.5750, -0.9099, 0.4685).normalize(),
        DVec3::new(-0.9574, -0.4254, 0.3487).normalize(),
        DVec3::new(-0.0889, -0.4891, -0.8407).normalize(),
    );
    let thick = turned_box(DVec3::new(1.27, 0.88, 1.65), DVec3::new(0.59, 0.55, 0.49), turn);
    let mut random = Random::new(7);
    let cell = [vec![-9.0, 1.75], vec![-9.0, 0.0], vec![0.25, 1.75]];
    for n in 0..200 {
        let (axis, angle) = (random.vector::<DVec3>(1.0).normalize(), random.between(0.0, 6.2));
        let half =
            DVec3::new(random.between(0.2, 0.8), random.between(0.2, 0.8), 10_f64.powf(random.between(-5.0, -1.0)));
        let plate = turned_box(
            DVec3::new(1.07, 1.15, 0.86) + random.vector::<DVec3>(0.4),
            half,
            DMat3::from_axis_angle(axis, angle),
        );
        let off = is_divided_alike(&[thick.clone(), plate, needle.clone()], &cell, 5);
        assert!(off < 1e-12 * 145.0, "{n}: {off:e}");
    }
}

/// Hundreds of triangles of one body in a cell: their tree is not a list, and holds the same.
#[test]
fn crowds_of_triangles_are_divided_alike() {
    let turn = DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.7);
    let solids = [
        sphere(DVec3::new(0.41, 0.5, 0.52), 0.3, 5),
        sphere(DVec3::new(0.57, 0.45, 0.5), 0.25, 4),
        turned_box(DVec3::new(0.5, 0.6, 0.4), DVec3::new(0.4, 0.1, 0.1), turn),
    ];
    let unit = || vec![0.0, 1.0];
    let off = is_divided_alike(&solids, &[unit(), unit(), unit()], 5);
    assert!(off < 1e-12, "{off:e}");
}
