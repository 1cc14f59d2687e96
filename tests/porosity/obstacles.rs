//! Frontal and wetted area: boxes by coordinate compression, curved solids by closed forms, and what must not count.

use glam::{DMat3, DVec3};
use proptest::prelude::*;
use voidage::geometry::bodies::Bodies;
use voidage::geometry::form::Form;
use voidage::grid::Edges;
use voidage::porosity::resistance::{Resistance, resistance};
use voidage::porosity::{Options, porosity};
use voidage_core::convex::shape::{Capsule, Cone, Cylinder, Sphere};
use voidage_core::solids::torus::TorusShape;
use voidage_core::surface::layer::ShadowReport;
use voidage_tests::random::Random;
use voidage_tests::solids::{Triangle, cuboid, formulas, scene, sphere, turned_box};

/// `cells` cells along each axis from `lo` to `hi`.
pub(super) fn edges(cells: usize, lo: f64, hi: f64) -> Edges {
    let axis: Vec<f64> = (0..=cells).map(|n| lo + (hi - lo) * n as f64 / cells as f64).collect();
    Edges([axis.clone(), axis.clone(), axis])
}

/// The obstacles, found on the way to porosity and after it: both are the same to the bit, and so is the porosity.
pub(super) fn obstacles(edges: &Edges, bodies: &Bodies) -> Resistance {
    let grid = edges.grid(None).expect("a grid");
    let (after, asked) = (Options::default(), Options { resistance: true, ..Options::default() });
    let [without, with] = [after, asked].map(|options| porosity(&grid, bodies, options));
    assert!(without.surface.is_none());
    assert!(without.beta == with.beta && without.cells == with.cells);
    let found = resistance(&grid, bodies, &with, asked);
    assert!(found == resistance(&grid, bodies, &without, after));
    found
}

pub(super) type Cuboid = [[u8; 3]; 2];

/// Does a box hold a cell of the lattice?
pub(super) fn is_solid(boxes: &[Cuboid], at: [i32; 3]) -> bool {
    boxes.iter().any(|[lo, hi]| (0..3).all(|a| i32::from(lo[a]) <= at[a] && at[a] < i32::from(hi[a])))
}

/// Area of the union of boxes on a lattice normal to each axis, both sides counted, from which of the lattice's cells are solid.
pub(super) fn lattice_area(boxes: &[Cuboid]) -> [f64; 3] {
    let solid = |at: [i32; 3]| is_solid(boxes, at);
    let mut area = [0.0; 3];
    for cell in 0..16 * 16 * 16 {
        let at = [cell % 16 - 1, cell / 16 % 16 - 1, cell / 256 - 1];
        for axis in 0..3 {
            let mut next = at;
            next[axis] += 1;
            area[axis] += f64::from(u8::from(solid(at) != solid(next)));
        }
    }
    area
}

pub(super) fn triangles([lo, hi]: &Cuboid) -> Vec<Triangle> {
    let corner = |p: &[u8; 3]| DVec3::from_array(p.map(f64::from));
    cuboid(corner(lo), corner(hi))
}

fn close(found: f64, truth: f64) -> bool {
    (found - truth).abs() <= 1e-12 * truth.abs().max(1.0)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Overlapping, touching, nested and equal boxes; grids beside their planes and on them.
    #[test]
    fn boxes_have_the_area_of_their_union(
        boxes in prop::collection::vec((prop::array::uniform3(0_u8..5), prop::array::uniform3(1_u8..4)), 1..7),
        cells in 1_usize..8,
    ) {
        let boxes: Vec<Cuboid> = boxes.iter().map(|(lo, size)| [*lo, [0, 1, 2].map(|a| lo[a] + size[a])]).collect();
        let bodies = scene(&boxes.iter().map(triangles).collect::<Vec<_>>());
        let truth = lattice_area(&boxes);
        let beside = obstacles(&edges(cells, -0.637, 8.811), &bodies).totals;
        let on = obstacles(&edges(10, -1.0, 9.0), &bodies).totals;
        for axis in 0..3 {
            prop_assert!(close(beside.frontal_area[axis], truth[axis] / 2.0), "{beside:?} {truth:?}");
            prop_assert_eq!(on.frontal_area[axis], 0.0, "all surface lies in planes of the grid");
        }
        let wetted: f64 = truth.iter().sum();
        prop_assert!(close(beside.wetted_area, wetted) && close(on.wetted_area, wetted), "{beside:?} {on:?} {wetted}");
        let alone: f64 = boxes.iter().map(|b| lattice_area(&[*b]).iter().sum::<f64>()).sum();
        prop_assert!(close(beside.wetted_area_of_bodies, alone), "{beside:?} {alone}");
        prop_assert_eq!(beside.unproved + on.unproved, 0);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// The same boxes turned anyhow, thin along one axis, in many cells and far off: a turn leaves areas as they are, and a face of area A is seen along
    /// axis i as A |n_i|.
    #[test]
    fn turned_boxes_have_the_area_of_their_union(
        boxes in prop::collection::vec((prop::array::uniform3(0_u8..5), prop::array::uniform3(1_u8..4)), 1..6),
        seed in any::<u64>(),
        cells in 1_usize..14,
        thin in 0_usize..4,
        far in any::<bool>(),
    ) {
        let boxes: Vec<Cuboid> = boxes.iter().map(|(lo, size)| [*lo, [0, 1, 2].map(|a| lo[a] + size[a])]).collect();
        let turn = Random::new(seed).turn();
        let mut scale = DVec3::ONE;
        if thin < 3 {
            scale[thin] = 1.0 / 64.0;
        }
        let offset = DVec3::splat(if far { 512.0 } else { 0.0 });
        let place = |p: DVec3| offset + turn * ((p - DVec3::splat(4.0)) * scale);
        let solids: Vec<Vec<Triangle>> = boxes.iter().map(|b| triangles(b).iter().map(|t| t.map(place)).collect()).collect();
        let found = obstacles(&edges(cells, offset.x - 8.3, offset.x + 8.1), &scene(&solids)).totals;
        let across = [scale.y * scale.z, scale.z * scale.x, scale.x * scale.y];
        let area: Vec<f64> = lattice_area(&boxes).iter().zip(across).map(|(area, across)| area * across).collect();
        let near = |found: f64, truth: f64| (found - truth).abs() <= if far { 1e-9 } else { 1e-11 };
        prop_assert!(near(found.wetted_area, area.iter().sum()), "{found:?} {area:?} {boxes:?}");
        for axis in 0..3 {
            let seen: f64 = (0..3).map(|normal| area[normal] * turn.col(normal)[axis].abs()).sum();
            prop_assert!(near(found.frontal_area[axis], seen / 2.0), "{axis}: {found:?} {seen} {boxes:?}");
        }
        prop_assert_eq!(found.unproved, 0);
    }
}

/// A wall of half a cell's width: its densities and lengths.
#[test]
fn a_plate_within_cells() {
    let plate = cuboid(DVec3::new(0.25, -1.0, -1.0), DVec3::new(0.75, 4.0, 4.0));
    let found = obstacles(&edges(3, 0.0, 3.0), &scene(&[plate]));
    for cell in 0..27 {
        let inside = cell % 3 == 0;
        let expected = if inside { [1.0, 0.0, 0.0, 2.0, 1.0, 1.0] } else { [0.0; 6] };
        let values = [&found.a[0], &found.a[1], &found.a[2], &found.s, &found.d_h, &found.l_obs].map(|f| f[cell]);
        assert_eq!(values, expected, "cell {cell}");
    }
    assert_eq!(found.totals.frontal_area, [9.0, 0.0, 0.0]);
}

/// Totals do not depend on the grid, and a body within another adds nothing.
#[test]
fn a_body_within_another_adds_nothing() {
    let outer = cuboid(DVec3::splat(0.3), DVec3::splat(2.7));
    let inner = cuboid(DVec3::splat(1.1), DVec3::splat(1.9));
    for cells in [1, 2, 5, 9] {
        let found = obstacles(&edges(cells, 0.0, 3.0), &scene(&[outer.clone(), inner.clone()])).totals;
        assert!(close(found.wetted_area, 6.0 * 2.4 * 2.4), "{cells}: {found:?}");
    }
}

/// A column below a lid whose lower side lies in a plane of the grid: in the cell of the column it alone has surface inside, and what it covers of the lid
/// is not wetted.
#[test]
fn a_column_below_a_lid() {
    let lid = cuboid(DVec3::new(0.1, 0.1, 1.0), DVec3::new(1.9, 1.9, 1.5));
    let of_lid = 2.0 * 1.8 * 1.8 + 4.0 * 1.8 * 0.5;
    for (width, angle, top) in [(0.5, 0.0, 1.0), (0.4, 0.3, 1.0), (0.3, 0.8, 1.0), (0.4, 0.3, 0.9), (1e-3, 0.5, 1.0)] {
        let half = DVec3::new(width, width, top - 0.3) / 2.0;
        let column = turned_box(DVec3::new(0.45, 0.55, (0.3 + top) / 2.0), half, DMat3::from_rotation_z(angle));
        let ends = if top < 1.0 { 2.0 * width * width } else { 0.0 };
        let truth = of_lid + 4.0 * width * (top - 0.3) + ends;
        for cells in [2, 4, 6] {
            let found = obstacles(&edges(cells, 0.0, 2.0), &scene(&[lid.clone(), column.clone()])).totals;
            assert!(close(found.wetted_area, truth), "{width} {angle} {top} {cells}: {found:?} {truth}");
        }
    }
}

/// The end of a needle in a plane of the grid, below a cell in which bodies overlap: however small, all of it is wetted.
#[test]
fn the_end_of_a_needle_in_a_plane() {
    let boxes =
        [(0.2, 0.7), (0.3, 0.8)].map(|(lo, hi)| cuboid(DVec3::new(lo, lo, 1.0 + lo), DVec3::new(hi, hi, 1.0 + hi)));
    let corner = DVec3::new(0.9, 0.9, 0.5);
    let [width, depth] = [1e-4, 4e-6];
    let needle = cuboid(corner, corner + DVec3::new(width, depth, 0.5));
    let found = obstacles(&edges(2, 0.0, 2.0), &scene(&[boxes[0].clone(), boxes[1].clone(), needle])).totals;
    let union = 2.0 * 6.0 * 0.25 - 6.0 * 0.16;
    let truth = union + 2.0 * width * depth + (width + depth);
    assert!((found.wetted_area - truth).abs() < 1e-13, "{found:?} {truth}");
}

/// Curved solids of so many facets that a cell once held too many for their shadow, which lies between that of one and the sum.
#[test]
fn a_torus_and_a_capsule_in_one_cell() {
    let (center, axis) = (DVec3::splat(0.5), DVec3::new(1.0, 2.0, 3.0));
    let torus = Form::Torus(TorusShape { center, axis, start: DVec3::X, radius: 0.3, tube: 0.08, angle: 360.0 });
    let capsule = Form::Capsule(Capsule { from: DVec3::splat(0.2), to: DVec3::splat(0.8), radius: 0.1 });
    let one = Edges([0; 3].map(|_| vec![0.0, 1.0]));
    let both = obstacles(&one, &formulas(&[torus.clone(), capsule.clone()]));
    assert_eq!((both.shadows.inexact, both.totals.unproved), (ShadowReport::default(), 0));
    let [torus, capsule] =
        [torus, capsule].map(|form| obstacles(&one, &formulas(&[form])).shadows.tau.each_ref().map(|tau| tau[0]));
    for axis in 0..3 {
        let tau = both.shadows.tau[axis][0];
        assert!(tau > torus[axis].max(capsule[axis]) + 1e-3 && tau < torus[axis] + capsule[axis] - 1e-3, "{tau}");
    }
}

/// Curved solids have the areas of their closed forms.
#[test]
fn solids_by_formula() {
    let (from, to) = (DVec3::new(0.4, 0.5, 0.6), DVec3::new(2.3, 1.9, 2.2));
    let (length, radius) = ((to - from).length(), 0.3);
    let slant = f64::hypot(length, radius);
    let disc = std::f64::consts::PI * radius * radius;
    // Seen along x: a cylinder is its middle section and an end, turned.
    let lean = (to.x - from.x) / length;
    let side = 2.0 * radius * length * (1.0 - lean * lean).sqrt();
    let pi = std::f64::consts::PI;
    let cases = [
        (Form::Sphere(Sphere { center: from.midpoint(to), radius }), 4.0 * disc, disc),
        (Form::Cylinder(Cylinder::new(from, to, radius)), 2.0 * pi * radius * length + 2.0 * disc, side + disc * lean),
        (Form::Capsule(Capsule { from, to, radius }), 2.0 * pi * radius * length + 4.0 * disc, side + disc),
        (Form::Cone(Cone::new(from, to, radius)), pi * radius * slant + disc, f64::NAN),
    ];
    for (form, wetted, frontal) in cases {
        let name = format!("{form:?}");
        let found = obstacles(&edges(6, 0.0, 3.0), &formulas(&[form])).totals;
        assert!((found.wetted_area / wetted - 1.0).abs() < 1e-11, "{name}: {found:?}, {wetted}");
        let seen = found.frontal_area[0];
        assert!(frontal.is_nan() || (seen / frontal - 1.0).abs() < 1e-11, "{name}: {seen}, {frontal}");
    }
}

/// The same bits for any number of threads.
#[test]
fn bits_do_not_depend_on_threads() {
    let bodies = scene(&[cuboid(DVec3::splat(0.3), DVec3::splat(2.2)), cuboid(DVec3::splat(1.1), DVec3::splat(2.9))]);
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| obstacles(&edges(7, 0.0, 3.1), &bodies))
    };
    assert_eq!(run(1), run(4));
}

/// A ball and a cylinder that begins in its middle fill a cell together, which neither does alone: nothing in it is seen. The wetted area of a vessel with
/// two heads is that of its outside.
#[test]
fn what_two_solids_fill_together_has_no_surface() {
    let list = |all: &[f64]| all.to_vec();
    let ball = Form::Sphere(Sphere { center: DVec3::ZERO, radius: 1.0 });
    let cylinder = |from: DVec3, to: DVec3, radius: f64| Form::Cylinder(Cylinder::new(from, to, radius));
    let edges_of_two = Edges([list(&[-0.3, 0.3]), list(&[-0.3, 0.3]), list(&[-1.6, -0.2, 1.2])]);
    let found = obstacles(&edges_of_two, &formulas(&[ball, cylinder(DVec3::ZERO, DVec3::Z * 3.0, 1.0)]));
    assert!(found.s[0] > 0.1 && found.s[1] == 0.0, "{:?}", found.s);

    let (radius, foot, top) = (0.13, DVec3::new(0.46, 0.51, 0.33), DVec3::new(0.46, 0.51, 0.63));
    let head = |center: DVec3| Form::Sphere(Sphere { center, radius });
    let vessel = formulas(&[cylinder(foot, top, radius), head(foot), head(top)]);
    let found = obstacles(&edges(10, 0.0, 1.0), &vessel).totals;
    let pi = std::f64::consts::PI;
    let (wetted, along) = (2.0 * pi * radius * 0.3 + 4.0 * pi * radius * radius, pi * radius * radius);
    assert!((found.wetted_area / wetted - 1.0).abs() < 1e-3, "{} {wetted}", found.wetted_area);
    assert!((found.frontal_area[2] / along - 1.0).abs() < 1e-3, "{:?} {along}", found.frontal_area);
}

/// The wall of a tank and a thin pipe in one cell: the larger the tank, the more facets stand for it, so that its shadow is right.
#[test]
fn the_shadow_of_a_large_tank() {
    let list = |n: usize| (0..=n).map(|n| 0.1 * n as f64).collect::<Vec<f64>>();
    for radius in [1.0, 5.0, 20.0] {
        let angle = 1.078_f64;
        let center = DVec3::new(0.15 - radius * angle.cos(), 0.0, 0.15 - radius * angle.sin());
        let rod = |at: DVec3, radius: f64| Form::Cylinder(Cylinder::new(at - DVec3::Y, at + DVec3::Y * 2.0, radius));
        let found = obstacles(
            &Edges([list(3), list(1), list(3)]),
            &formulas(&[rod(center, radius), rod(DVec3::new(0.19, 0.0, 0.19), 0.005)]),
        );
        // Along x, what is below the tank's wall where it enters the cell, and of the pipe what stands higher.
        let height = center.z + (radius * radius - (0.1 - center.x).powi(2)).sqrt();
        let truth = (height - 0.1 + (0.195 - height.max(0.185)).max(0.0)) / 0.1;
        let (tau, doubt) = (found.shadows.tau[0][4], found.shadows.doubt);
        assert!(doubt <= 5.1e-4 && (tau - truth).abs() <= doubt, "{radius}: {tau} {truth}, {doubt}");
    }
}

/// One thin layer of cells made all solids of thousands of facets: of three pipes through one place 7.33 m² were wetted, and a pipe in two pieces that overlap
/// had a cell with 2.92 m² a m³ in place of 2.275. The areas are those of 700² lines.
#[test]
fn a_thin_layer_of_cells_changes_no_areas() {
    let pipe = |from: [f64; 3], to: [f64; 3], radius: f64| {
        let [from, to] = [from, to].map(DVec3::from_array);
        Form::Cylinder(Cylinder::new(from, to, radius))
    };
    let ends =
        [([0.3, 1.0, 0.9], [1.7, 1.1, 1.0]), ([0.3, 1.0, 1.1], [1.7, 1.1, 0.8]), ([0.3, 1.1, 1.1], [1.7, 0.9, 0.8])];
    let three = formulas(&ends.map(|(from, to)| pipe(from, to, 0.3)));
    for thin in [1e-4, 1e-3, 0.1] {
        let even = vec![0.0, 1.0, 2.0];
        let found = obstacles(&Edges([vec![0.0, thin, 1.0, 2.0], even.clone(), even]), &three).totals;
        assert_eq!(found.unproved, 0);
        assert!((found.wetted_area - 4.110).abs() < 2e-3, "{thin}: {found:?}");
        for (area, truth) in found.frontal_area.into_iter().zip([0.653, 1.052, 1.055]) {
            assert!((area - truth).abs() < 1e-3, "{thin}: {found:?}");
        }
    }
    let (from, to) = (
        [0.578_624_793_944_569_7, 0.251_911_274_542_990_9, 0.587_597_896_538_467_2],
        [1.031_693_693_743_615, 1.573_977_595_187_894_3, 0.670_478_629_229_059_2],
    );
    let on_the_way = [0.837_521_308_115_452_7, 1.007_377_743_482_935_9, 0.634_958_315_218_805_5];
    let whole_and_piece = formulas(&[pipe(from, to, 0.35), pipe(from, on_the_way, 0.35)]);
    let fine = vec![0.0, 0.001, 0.5, 1.0, 2.0];
    let grid = Edges([fine.clone(), fine, vec![0.0, 2.0 / 3.0, 4.0 / 3.0, 2.0]]);
    let [found, alone] = [&whole_and_piece, &formulas(&[pipe(from, to, 0.35)])].map(|bodies| obstacles(&grid, bodies));
    assert_eq!(found.totals.unproved, 0);
    for (s, truth) in found.s.iter().zip(&alone.s) {
        assert!((s - truth).abs() < 1e-3 * truth.max(0.1), "{s} in place of {truth}");
    }
}

/// Many solids in one cell, as the tubes of a heat exchanger in a coarse one: apart from each other they have so many times the areas of one. They held too
/// many facets for a shadow, and their union was sought for ten seconds.
#[test]
fn a_bundle_of_tubes_in_one_cell() {
    const ALONG: usize = 16;
    let tube = |i: usize, j: usize| {
        let foot = DVec3::new(0.02 + 0.059 * i as f64, 0.03 + 0.059 * j as f64, 0.05);
        Form::Cylinder(Cylinder::new(foot, foot + DVec3::new(0.01, 0.004, 0.9), 0.012))
    };
    let cell = Edges([0; 3].map(|_| vec![0.0, 1.0]));
    let one = obstacles(&cell, &formulas(&[tube(0, 0)]));
    let bundle: Vec<Form> = (0..ALONG * ALONG).map(|n| tube(n % ALONG, n / ALONG)).collect();
    let all = obstacles(&cell, &formulas(&bundle));
    assert_eq!((all.shadows.inexact, all.totals.unproved), (ShadowReport::default(), 0));
    let count = (ALONG * ALONG) as f64;
    let close = |found: f64, of_one: f64| (found / (count * of_one) - 1.0).abs() < 1e-3;
    assert!(close(all.s[0], one.s[0]), "{} {}", all.s[0], one.s[0]);
    for axis in 0..3 {
        assert!(close(all.a[axis][0], one.a[axis][0]), "{axis}: {} {}", all.a[axis][0], one.a[axis][0]);
    }
    let shadows = |of: &Resistance| of.shadows.tau.each_ref().map(|tau| tau[0]);
    let (all, one) = (shadows(&all), shadows(&one));
    assert!(close(all[2], one[2]), "{all:?} {one:?}");
    // Along y the tubes of a row stand behind each other, a little to the side of one another.
    let row = obstacles(&cell, &formulas(&bundle[..ALONG]));
    assert!(all[1] >= shadows(&row)[1] - 1e-9 && all[1] < 1.2 * shadows(&row)[1], "{all:?} {row:?}");
}

/// Balls of so many facets that no cell holds their union at once, on a floor whose top lies in a plane of the grid, or a wall or ceiling so: what they leave of
/// it is wetted. It counted nothing where the floor was closed and its cell was divided.
#[test]
fn a_floor_in_a_plane_below_a_divided_cell() {
    let radii = [0.1, 0.08];
    let footprints = std::f64::consts::PI * radii.iter().map(|r| r * r).sum::<f64>();
    // The floor and, in place of the footprints, half of each ball.
    let truth = 4.0 + footprints;
    for (axis, side) in (0..3).flat_map(|axis| [(axis, -1.0), (axis, 1.0)]) {
        let turned = |p: [f64; 3]| {
            let mut p = DVec3::from_array([p[(3 - axis) % 3], p[(4 - axis) % 3], p[(5 - axis) % 3]]);
            p[axis] *= side;
            p
        };
        let corners = [[-1.0; 3], [3.0, 3.0, 3.0]].map(|mut p| {
            p.rotate_right(axis);
            DVec3::from_array(p)
        });
        let floor = |top: f64| {
            let [mut lo, mut hi] = corners;
            (lo[axis], hi[axis]) = if side > 0.0 { (-1.0, top) } else { (-top, 1.0) };
            cuboid(lo, hi)
        };
        let centers = [[0.0, 0.65, 0.65], [0.0, 0.88, 0.88]].map(turned);
        let meshes: Vec<Vec<Triangle>> =
            centers.iter().zip(radii).map(|(&center, radius)| sphere(center, radius, 16)).collect();
        let balls = centers.iter().zip(radii).map(|(&center, radius)| Form::Sphere(Sphere { center, radius }));
        let by_formula = formulas(&balls.collect::<Vec<_>>());
        for below in [0.0, 0.5] {
            let across: Vec<f64> = (0..=4).map(|n| 0.5 * f64::from(n)).collect();
            let mut grid = Edges([across.clone(), across.clone(), across]);
            let along = if below > 0.0 { vec![-0.5, 0.0, 0.5, 1.0] } else { vec![0.0, 0.5, 1.0] };
            grid.0[axis] = if side > 0.0 { along } else { along.iter().rev().map(|x| -x).collect() };
            for top in [0.0, -1e-16] {
                let with_mesh = scene(&[&meshes[..], &[floor(top)]].concat());
                let mut with_formulas = scene(&[floor(top)]);
                with_formulas.bodies.extend(by_formula.bodies.clone());
                for (what, bodies) in [("mesh", with_mesh), ("formula", with_formulas)] {
                    let found = obstacles(&grid, &bodies).totals;
                    let case = format!("{what}, axis {axis}, side {side}, {below}, {top}");
                    assert!((found.wetted_area - truth).abs() < 2e-3, "{case}: {} {truth}", found.wetted_area);
                }
            }
        }
    }
}
