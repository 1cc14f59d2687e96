//! Tori in planes through their centre and planes that hold their axis, where sections begin, end and split at once: against closed forms,
//! quadrature in other coordinates, and the same solids with their axes exchanged, whose sections are cut by lines the other way.

use super::torus::{Shares, shares};
use super::torus_points::inside;
use glam::{DMat3, DVec3};
use std::f64::consts::PI;
use voidage::geometry::form::Form;
use voidage::grid::Edges;
use voidage::porosity::{Options, porosity};
use voidage_core::convex::shape::{Cone, Cylinder};
use voidage_core::grid::cell_range::RangeKind;
use voidage_core::solids::torus::{TorusShape, TorusSolid};
use voidage_tests::effort::cases;
use voidage_tests::random::Random;
use voidage_tests::solids::{formulas, scene, turned_box};

fn ring(center: DVec3, axis: DVec3, radius: f64, tube: f64) -> TorusShape<DVec3> {
    TorusShape { center, axis, start: axis.any_orthogonal_vector(), radius, tube, angle: 360.0 }
}

fn of(shape: &TorusShape<DVec3>, edges: &[Vec<f64>; 3]) -> Shares {
    shares(&TorusSolid::new(shape).expect("a torus of ordinary size"), edges)
}

/// Thin and thick rings cut by planes through their centre have Pappus' volume.
#[test]
fn rings_cut_through_their_centre_keep_their_volume() {
    for axis in 0..3 {
        for tube in [0.002, 0.01, 0.03, 0.05, 0.1] {
            for cuts in [vec![-1.5, 1.5], vec![-1.5, 0.0, 1.5], vec![-1.5, -1.0, 0.0, 1.0, 1.5]] {
                for thickness in [vec![-0.1, 0.1], vec![-0.1, 0.0, 0.2]] {
                    let mut edges = [cuts.clone(), cuts.clone(), vec![-1.5, 0.0, 1.5]];
                    edges[axis] = thickness;
                    let found = of(&ring(DVec3::ZERO, DVec3::AXES[axis], 1.0, tube), &edges);
                    let counts = [0, 1, 2].map(|n| edges[n].len() - 1);
                    let mut total = 0.0;
                    for (n, share) in found[0].iter().enumerate() {
                        let at = [n % counts[0], n / counts[0] % counts[1], n / counts[0] / counts[1]];
                        total += share[0] * (0..3).map(|m| edges[m][at[m] + 1] - edges[m][at[m]]).product::<f64>();
                    }
                    let pappus = 2.0 * PI * PI * tube * tube;
                    assert!((total / pappus - 1.0).abs() < 1e-11, "axis {axis}, tube {tube}: {total}, not {pappus}");
                }
            }
        }
    }
}

/// A side of a box goes through the centre of a ring, which is half within the box, however both lie; few cells or many.
#[test]
fn half_of_a_ring_in_a_box() {
    let random = &mut Random::new(17);
    for n in 0..cases(16) {
        let turn = random.turn();
        let half = DVec3::new(random.between(0.5, 0.53), random.between(0.5, 0.53), 0.25);
        let (center, radius) =
            (DVec3::splat(1.0) + DVec3::from_array(random.on_sphere()) * 0.05, random.between(0.2, 0.35));
        let shape = ring(center, DVec3::from_array(random.on_sphere()), radius, radius * random.between(0.1, 0.6));
        let block = turned_box(center - turn * DVec3::Z * half.z, half, turn);
        // The ring does not leave the box by its other sides.
        if shape.radius + shape.tube > 0.5 {
            continue;
        }
        let mut bodies = scene(&[block]);
        bodies.bodies.extend(formulas(&[Form::Torus(shape)]).bodies);
        let cells = [3, 5, 8, 13][random.below(4)];
        let size = 2.0 / cells as f64;
        let edges = Edges([0, 1, 2].map(|_| (0..=cells).map(|i| size * i as f64).collect()));
        let found =
            porosity(&edges.grid(None).expect("a grid"), &bodies, Options { bounds: true, ..Options::default() });
        let what = format!("{n}: {cells} cells, {shape:?}");
        assert!(found.max_gap <= 1e-4, "{}: {what}", found.max_gap);
        let [low, high] = found.bounds.as_ref().expect("bounds");
        let solid = |f: &[f64]| f.iter().map(|b| 1.0 - b).sum::<f64>() * size.powi(3);
        let volume = 8.0 * half.element_product() + PI * PI * shape.radius * shape.tube * shape.tube;
        assert!(solid(&high.v) - 1e-9 <= volume && volume <= solid(&low.v) + 1e-9, "{volume}: {what}");
    }
}

/// Thick rings through slabs across their axis, in coarse cells of uneven size that their surface crosses more than once: bounds are within the
/// tolerance, and hold what has a closed form.
#[test]
fn thick_rings_through_slabs_in_coarse_cells() {
    let ends = 2.1;
    for (tube, slab, inner) in [
        (0.8, [0.4, 1.4], [vec![-0.72, -0.28, -0.13], vec![-1.21, -1.0, -0.16], vec![-0.95, 0.34]]),
        (0.95, [0.01, 1.01], [vec![-1.7, 0.98, 1.56], vec![0.53, 1.08, 1.16], vec![0.02, 0.35, 1.48]]),
    ] {
        let edges = Edges(inner.map(|planes| [vec![-ends], planes, vec![ends]].concat()));
        let turn = DMat3::from_axis_angle(DVec3::new(0.0, 0.6, 0.8), 1e-6);
        let center = DVec3::X * 0.5 * (slab[0] + slab[1]);
        let half = DVec3::new(0.5 * (slab[1] - slab[0]), 2.0, 2.0);
        let mut bodies = scene(&[turned_box(center, half, turn)]);
        bodies.bodies.extend(formulas(&[Form::Torus(ring(DVec3::ZERO, DVec3::X, 1.0, tube))]).bodies);
        let options = Options { bounds: true, ..Options::default() };
        let found = porosity(&edges.grid(None).expect("a grid"), &bodies, options);
        assert!(found.max_gap <= 1e-4, "{}: tube {tube}", found.max_gap);
        // An annulus of area 4 pi sqrt(tube^2 - x^2) in each plane across the axis.
        let below = |x: f64| {
            let x = x.clamp(-tube, tube);
            2.0 * PI * (x * (tube * tube - x * x).sqrt() + tube * tube * (x / tube).asin())
        };
        let volume = 8.0 * half.element_product() + 2.0 * PI * PI * tube * tube - (below(slab[1]) - below(slab[0]));
        let [low, high] = found.bounds.as_ref().expect("bounds");
        let [nx, ny, _] = edges.0.each_ref().map(|planes| planes.len() - 1);
        let size = |axis: usize, n: usize| edges.0[axis][n + 1] - edges.0[axis][n];
        let solid = |field: &[f64]| {
            let share =
                |(n, open): (usize, &f64)| (1.0 - open) * size(0, n % nx) * size(1, n / nx % ny) * size(2, n / nx / ny);
            field.iter().enumerate().map(share).sum::<f64>()
        };
        assert!(solid(&high.v) - 1e-9 <= volume && volume <= solid(&low.v) + 1e-9, "{volume}: tube {tube}");
    }
}

/// A bend, and a pipe, a cone or another bend that it takes up, whose ends overlap by next to nothing about a plane of the grid: all is known within the
/// tolerance, and the joint is a disc.
#[test]
fn ends_that_overlap_by_next_to_nothing_in_a_plane() {
    let tube = 0.05;
    let bend = |center: DVec3, start: DVec3| {
        Form::Torus(TorusShape { center, axis: DVec3::Z, start, radius: 0.5, tube, angle: 90.0 })
    };
    let axis = |i: i32| 0.05 * f64::from(i);
    let edges =
        Edges([(8..=12).map(axis).collect(), (-2..=2).map(axis).collect(), [-0.075, -0.025, 0.025, 0.075].to_vec()]);
    let from = DVec3::new(0.5, -1.0, 0.0);
    for overlap in [0.0, 1e-15, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-6] {
        let to = DVec3::new(0.5, overlap, 0.0);
        for (n, other) in [
            Form::Cylinder(Cylinder::new(from, to, tube)),
            Form::Cone(Cone::truncated(from, to, 0.03, tube)),
            bend(DVec3::new(1.0, overlap, 0.0), DVec3::NEG_X),
            Form::Cylinder(Cylinder::new(from + DVec3::X * 0.01, to + DVec3::X * 0.01, 0.6 * tube)),
        ]
        .into_iter()
        .enumerate()
        {
            let bodies = formulas(&[bend(DVec3::ZERO, DVec3::X), other]);
            let options = Options { bounds: true, ..Options::default() };
            let found = porosity(&edges.grid(None).expect("a grid"), &bodies, options);
            assert!(found.max_gap <= 1e-4, "{overlap} of {n}: {}", found.max_gap);
            // The tube about (½, 0) fills the middle of four faces and touches their far sides.
            let joint: f64 =
                (0..12).map(|at| 1.0 - found.beta.y[at % 4 + 4 * (2 + 5 * (at / 4))]).sum::<f64>() * 0.0025;
            assert!((joint - PI * tube * tube).abs() < 1e-6, "{overlap} of {n}: {joint}");
        }
    }
}

/// A plane that holds the axis cuts out two discs, however the axis lies in it.
#[test]
fn planes_that_hold_the_axis_show_discs() {
    let random = &mut Random::new(3);
    for round in 0..200 {
        let n = random.below(3);
        let (u, v) = ((n + 1) % 3, (n + 2) % 3);
        let [p, q] = [[1.0, 1.0], [1.0, -1.0], [0.0, 1.0], [1.0, 0.0], [3.0, 4.0], [0.3, -0.8]][random.below(6)];
        let (mut axis, mut across) = (DVec3::ZERO, DVec3::ZERO);
        (axis[u], axis[v], across[u], across[v]) = (p, q, -q, p);
        let radius = [0.25, 0.5, 0.75][random.below(3)];
        let tube = radius * [0.01, 0.04, 0.25, 0.5][random.below(4)];
        let center = DVec3::new(1.25, 0.75, 1.0);
        // One disc lies in the face, the other outside of it.
        let disc = center + across.normalize() * radius;
        let mut sides = [0, 1, 2].map(|m| {
            let [below, above] = [0, 1].map(|_| random.between(1.0, 1.4) * tube);
            vec![disc[m] - below, disc[m] + above]
        });
        sides[n] = vec![center[n], center[n] + [1e-3, 0.5][random.below(2)]];
        let found = of(&ring(center, axis, radius, tube), &sides);
        let area = (sides[u][1] - sides[u][0]) * (sides[v][1] - sides[v][0]);
        let ([share, error], truth) = (found[n + 1][0], PI * tube * tube / area);
        assert!((share - truth).abs() <= error && error < 1e-9, "{round}: {share} ± {error:e}, not {truth}");
    }
}

/// The torus of 25 digits: a quarter of it in a thin cell whose side holds the axis. By chords of circles about the axis.
#[test]
fn a_thin_cell_beside_a_plane_through_the_centre() {
    let shape = ring(DVec3::new(0.5, 1.75, 0.5), DVec3::new(0.0, 1.0, -1.0), 0.5, 0.125);
    let found = of(&shape, &[vec![0.5, 0.501], vec![1.1, 3.0], vec![0.0, 0.5]]);
    for (x, open) in found[1].iter().zip([0.948_329_068_197_536_3, 0.948_328_959_744_238_1]) {
        assert!((1.0 - x[0] - open).abs() < 1e-13, "{} not {open}", 1.0 - x[0]);
    }
    let [share, error] = found[0][0];
    assert!((1.0 - share - 0.948_329_032_046_5).abs() <= error.min(1e-11), "{} ± {error:e}", 1.0 - share);
}

/// An end of a horn in the side of a thin cell at its hole, and its other end's plane through the axis there.
#[test]
fn a_bend_of_a_horn_in_a_thin_cell() {
    let (axis, start) = (DVec3::new(0.0, 1.0, 1.0), DVec3::ONE);
    let shape = TorusShape { start, angle: 270.0, ..ring(DVec3::new(1.25, 1.75, 1.5), axis, 0.25, 0.25) };
    let found = of(&shape, &[vec![0.95, 1.25], vec![1.05, 1.75], vec![1.5, 1.501]]);
    let mut count = 0;
    for n in 0..300 * 300 {
        let part = DVec3::new((n % 300) as f64 + 0.5, (n / 300) as f64 + 0.5, 150.0) / 300.0;
        count += i32::from(inside(&shape, DVec3::new(0.95, 1.05, 1.5) + part * DVec3::new(0.3, 0.7, 0.001)));
    }
    let (truth, [share, error]) = (f64::from(count) / 90_000.0, found[0][0]);
    assert!((share - truth).abs() < 3e-3 && error < 1e-6, "{share} ± {error:e}, by points {truth}");
}

/// Some torus or bend with its centre and its ends in planes of the grid.
fn some(random: &mut Random) -> TorusShape<DVec3> {
    const DIRECTIONS: [[f64; 3]; 9] = [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 1.0, 1.0],
        [1.0, 0.0, -1.0],
        [1.0, 1.0, 0.0],
        [3.0, 4.0, 0.0],
        [1.0, 1.0, 1.0],
        [0.3, -0.7, 0.4],
    ];
    let axis = DVec3::from_array(DIRECTIONS[random.below(9)]);
    let mut start = DVec3::from_array(DIRECTIONS[random.below(9)]);
    if axis.cross(start).length() < 0.1 {
        start = axis.any_orthogonal_vector();
    }
    let radius = [0.25, 0.5, 1.0][random.below(3)];
    let tube = radius * [0.01, 0.03, 0.1, 0.25, 0.5, 0.8][random.below(6)];
    let angle = [360.0, 360.0, 360.0, 90.0, 180.0, 270.0, 45.0][random.below(7)];
    TorusShape { center: DVec3::new(0.5, 0.75, 1.25), axis, start, radius, tube, angle }
}

/// Planes through the centre, beside it, through multiples of a quarter, and others.
fn planes(random: &mut Random, center: f64) -> Vec<f64> {
    let mut edges = vec![center - 2.0 * random.unit() - 0.1];
    for _ in 0..=random.below(3) {
        edges.push(match random.below(4) {
            0 => center,
            1 => center + 0.001,
            2 => center + (random.below(9) as f64 - 4.0) * 0.25,
            _ => center + random.between(-1.5, 1.5),
        });
    }
    edges.sort_by(f64::total_cmp);
    edges.dedup_by(|a, b| *a - *b < 1e-4);
    if edges.len() < 2 {
        edges.push(center + 2.1);
    }
    edges
}

/// With x and y exchanged, or all three axes turned, lines cut every section the other way, and bounds agree.
#[test]
fn axes_exchanged_say_the_same() {
    let random = &mut Random::new(11);
    for round in 0..250 {
        let shape = some(random);
        let edges = [0, 1, 2].map(|n| planes(random, shape.center[n]));
        let own = of(&shape, &edges);
        for (order, mirrored) in [([1, 0, 2], true), ([2, 1, 0], true), ([0, 2, 1], true), ([1, 2, 0], false)] {
            let to = |v: DVec3| DVec3::new(v[order[0]], v[order[1]], v[order[2]]);
            // A reflection turns the sense about the axis.
            let axis = to(shape.axis) * if mirrored { -1.0 } else { 1.0 };
            let other = TorusShape { center: to(shape.center), axis, start: to(shape.start), ..shape };
            let found = of(&other, &order.map(|n| edges[n].clone()));
            for kind in [RangeKind::Cells, RangeKind::Faces(0), RangeKind::Faces(1), RangeKind::Faces(2)] {
                let mut counts = [0, 1, 2].map(|n| edges[n].len() - 1);
                let (mut field, mut there) = (0, 0);
                if let RangeKind::Faces(n) = kind {
                    counts[n] += 1;
                    (field, there) = (n + 1, 1 + order.iter().position(|m| *m == n).expect("a permutation"));
                }
                for n in 0..own[field].len() {
                    let at = [n % counts[0], n / counts[0] % counts[1], n / counts[0] / counts[1]];
                    let [i, j, k] = order.map(|m| at[m]);
                    let m = i + counts[order[0]] * (j + counts[order[1]] * k);
                    let ([one, a], [two, b]) = (own[field][n], found[there][m]);
                    assert!(a < 1e-6 && b < 1e-6, "{round} {shape:?} {edges:?}: {kind:?} {at:?} may be off by {a:e}");
                    assert!(
                        (one - two).abs() <= a + b + 1e-13,
                        "{round} {shape:?} {edges:?}: {kind:?} {at:?}: {one}, {two}"
                    );
                }
            }
        }
    }
}
