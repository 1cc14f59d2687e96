//! Porosity has the bits of the host, whole and by layer, in memory that is just enough.

use crate::kit::api::{Api, Found, body, grid, named, no_fault, zeroed};
use glam::DVec3;
use voidage::geometry::bodies::Bodies;
use voidage::porosity::{FieldSet, Options as HostOptions, porosity};
use voidage_capi::status::Status;
use voidage_capi::types::{Beta, Grid, Options, PorosityReport, Scene, Surface};
use voidage_core::grid::Grid as CoreGrid;
use voidage_tests::random::Random;
use voidage_tests::solids::{cuboid, scene, sphere, turned_box};

/// Triangles as numbers, and where bodies begin.
struct Triangles<R> {
    corners: Vec<R>,
    first: Vec<usize>,
}

impl<R: Api> Triangles<R> {
    fn of(bodies: &Bodies) -> Self {
        let points = bodies.triangles.iter().flatten().flat_map(|p| p.to_array());
        let mut first: Vec<usize> = bodies.bodies.iter().map(|b| b.triangles.start).collect();
        first.push(bodies.triangles.len());
        Triangles { corners: points.map(R::from_f64).collect(), first }
    }

    fn surface(&self) -> Surface<R> {
        Surface {
            corners: self.corners.as_ptr(),
            triangles: self.corners.len() / 9,
            first: self.first.as_ptr(),
            bodies: self.first.len() - 1,
            sheets: core::ptr::null(),
        }
    }
}

/// Balls and boxes that overlap, some of them in grid planes.
fn overlapping(seed: u64) -> Bodies {
    let random = &mut Random::new(seed);
    let mut solids = vec![sphere(DVec3::splat(0.5), 0.3, 5)];
    for _ in 0..4 {
        let center = DVec3::from_array([0; 3].map(|_| random.between(0.2, 0.8)));
        let turn = glam::DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), random.between(0.0, 3.0));
        solids.push(turned_box(center, DVec3::new(0.3, 0.1, 0.2), turn));
        let corner = DVec3::from_array([0; 3].map(|_| random.below(4) as f64 / 7.0));
        solids.push(cuboid(corner, corner + DVec3::new(2.0, 3.0, 1.0) / 7.0));
    }
    scene(&solids)
}

fn edges<R: Api>(cells: [usize; 3]) -> [Vec<R>; 3] {
    cells.map(|n| (0..=n).map(|i| R::from_f64(i as f64 / n as f64)).collect())
}

/// Bytes around the work that must stay as they are.
const GUARD: usize = 64;

/// Porosity of some layers of a surface, its work of just as many bytes as are asked for, `shift` bytes off any alignment.
fn measure<R: Api>(
    grid: &Grid<R>,
    surface: &Surface<R>,
    options: Options<R>,
    shift: usize,
) -> (Found<R>, PorosityReport<R>) {
    let layers = if options.layers == 0 { grid.nz } else { options.layers };
    let mut found = Found::new(grid, layers, options.first_layer + layers == grid.nz);
    let (fractions, mut report, mut fault) = (found.fractions(), PorosityReport::default(), no_fault());
    let bytes = unsafe { R::surface_work(grid, surface, &options) };
    let mut work = vec![0xa5_u8; bytes + 2 * GUARD + shift];
    let start = work[GUARD + shift..].as_mut_ptr().cast();
    let status =
        unsafe { R::surface_porosity(grid, surface, &options, &fractions, start, bytes, &mut report, &mut fault) };
    assert_eq!((status, named(&fault)), (Status::Ok, ""));
    assert!(work[..GUARD + shift].iter().chain(&work[GUARD + shift + bytes..]).all(|&b| b == 0xa5), "guards");
    let less =
        unsafe { R::surface_porosity(grid, surface, &options, &fractions, start, bytes - 1, &mut report, &mut fault) };
    assert_eq!((less, fault.needed), (Status::Memory, bytes));
    (found, report)
}

#[test]
fn whole_grids_have_the_bits_of_the_host() {
    for (seed, cells) in [(1, [6, 5, 7]), (2, [1, 2, 1]), (3, [3, 1, 4]), (4, [9, 8, 1])] {
        let bodies = overlapping(seed);
        let (lists, triangles) = (edges::<f64>(cells), Triangles::<f64>::of(&bodies));
        let core = CoreGrid::new(&lists[0], &lists[1], &lists[2]).expect("a grid");
        let expected = porosity(&core, &bodies, HostOptions { bounds: true, ..HostOptions::default() });
        let (found, report) = measure(&grid(&lists), &triangles.surface(), zeroed(), seed as usize);
        let [lower, upper] = expected.bounds.as_ref().expect("bounds");
        for (set, found) in [&expected.beta, lower, upper].into_iter().zip(&found.sets) {
            let FieldSet { v, x, y, z } = set;
            for (expected, found) in [v, x, y, z].into_iter().zip(found) {
                assert!(expected.iter().map(|b| b.to_bits()).eq(found.iter().map(|b| b.to_bits())));
            }
        }
        assert_eq!(report.solid_volume, expected.solid_volume);
        assert_eq!(
            [report.open, report.cut, report.closed],
            [expected.cells.open, expected.cells.cut, expected.cells.closed]
        );
        assert_eq!([report.shared, report.divided], [expected.cells.ambiguous, expected.divided]);
        assert!(report.leak < 1e-9 && report.max_gap == expected.max_gap);
    }
}

/// Layers of a surface one by one and in pairs, against all at once.
fn layers_agree<R: Api>(seed: u64) {
    let (lists, triangles) = (edges::<R>([4, 3, 6]), Triangles::<R>::of(&overlapping(seed)));
    let (grid, surface) = (grid(&lists), triangles.surface());
    let (whole, report) = measure(&grid, &surface, zeroed(), 0);
    for step in [1, 2, 3] {
        let (mut joined, mut volume) = (Found { sets: Default::default() }, R::ZERO);
        for first in (0..6).step_by(step) {
            let options = Options { first_layer: first, layers: step, ..zeroed() };
            let (part, report) = measure(&grid, &surface, options, 1);
            volume += report.solid_volume;
            for (joined, part) in joined.sets.iter_mut().flatten().zip(part.sets.into_iter().flatten()) {
                joined.extend(part);
            }
        }
        assert!(joined == whole, "{step} layers at a time");
        assert!((volume - report.solid_volume).abs() < R::from_f64(8.0) * R::EPSILON);
    }
}

#[test]
fn layers_one_by_one_have_the_bits_of_all_at_once() {
    for seed in 0..4 {
        layers_agree::<f64>(seed);
        layers_agree::<f32>(seed);
    }
}

#[test]
fn faces_and_bounds_may_be_left_out() {
    let (lists, triangles) = (edges::<f64>([4, 3, 5]), Triangles::of(&overlapping(7)));
    let (grid, surface) = (grid(&lists), triangles.surface());
    let (whole, _) = measure(&grid, &surface, zeroed(), 0);
    let mut v = vec![0.0; 60];
    let mut fractions = zeroed::<voidage_capi::types::Fractions<f64>>();
    fractions.value = Beta { v: v.as_mut_ptr(), ..fractions.value };
    let bytes = unsafe { f64::surface_work(&grid, &surface, core::ptr::null()) };
    let mut work = vec![0_u8; bytes];
    let (none, nowhere) = (core::ptr::null(), core::ptr::null_mut());
    let status = unsafe {
        f64::surface_porosity(
            &grid,
            &surface,
            none,
            &fractions,
            work.as_mut_ptr().cast(),
            bytes,
            nowhere,
            core::ptr::null_mut(),
        )
    };
    assert_eq!(status, Status::Ok);
    assert!(v.iter().zip(&whole.sets[0][0]).all(|(a, b)| (a - b).abs() < 1e-4));
}

/// Porosity of a scene.
fn measure_scene<R: Api>(grid: &Grid<R>, scene: &Scene<R>, options: Options<R>) -> (Found<R>, PorosityReport<R>) {
    let layers = if options.layers == 0 { grid.nz } else { options.layers };
    let mut found = Found::new(grid, layers, options.first_layer + layers == grid.nz);
    let (fractions, mut report, mut fault) = (found.fractions(), PorosityReport::default(), no_fault());
    let bytes = unsafe { R::scene_work(grid, scene, &options) };
    let mut work = vec![0xa5_u8; bytes + 2 * GUARD];
    let start = work[GUARD..].as_mut_ptr().cast();
    let status = unsafe { R::scene_porosity(grid, scene, &options, &fractions, start, bytes, &mut report, &mut fault) };
    assert_eq!((status, named(&fault)), (Status::Ok, ""));
    assert!(work[..GUARD].iter().chain(&work[GUARD + bytes..]).all(|&b| b == 0xa5), "guards");
    (found, report)
}

const SPHERE: i32 = 5;
const CAPSULE: i32 = 6;
const CYLINDER: i32 = 7;
const CONE: i32 = 8;
const ELLIPSOID: i32 = 9;

#[test]
fn solids_by_formula_have_the_volume_of_their_formula() {
    let pi = core::f64::consts::PI;
    let solids = [
        (body(SPHERE, &[0.5, 0.45, 0.55, 0.3]), 4.0 / 3.0 * pi * 0.027),
        (body(CYLINDER, &[0.2, 0.5, 0.5, 0.8, 0.6, 0.4, 0.1]), pi * 0.01 * (0.36_f64 + 0.01 + 0.01).sqrt()),
        (body(CAPSULE, &[0.5, 0.3, 0.5, 0.5, 0.7, 0.5, 0.15]), pi * 0.0225 * 0.4 + 4.0 / 3.0 * pi * 0.15_f64.powi(3)),
        (body(CONE, &[0.5, 0.5, 0.2, 0.5, 0.5, 0.8, 0.3]), pi / 3.0 * 0.09 * 0.6),
        (
            body(ELLIPSOID, &[0.5, 0.5, 0.5, 0.0, 0.24, 0.18, 0.2, 0.0, 0.0, 0.0, -0.06, 0.08]),
            4.0 / 3.0 * pi * 0.3 * 0.2 * 0.1,
        ),
    ];
    let lists = edges::<f64>([7, 5, 6]);
    let mut apart = 0.0;
    for (solid, expected) in &solids {
        let scene = Scene { surface: core::ptr::null(), solids: solid, solid_count: 1 };
        let (_, report) = measure_scene(&grid(&lists), &scene, zeroed());
        assert!((report.solid_volume - expected).abs() < 1e-13, "{solid:?}: {} {expected}", report.solid_volume);
        assert!(report.max_gap < 1e-13);
        apart += expected;
    }
    // All five at once share cells: bounds hold the union, which is not more than their sum.
    let all: Vec<_> = solids.iter().map(|s| s.0).collect();
    let scene = Scene { surface: core::ptr::null(), solids: all.as_ptr(), solid_count: all.len() };
    let (_, report) = measure_scene(&grid(&lists), &scene, zeroed());
    assert!(report.max_gap <= 1e-3 && report.solid_volume < apart - 0.01, "{report:?}");
}

/// The lens that two balls of radius 0.25 share, their centres 0.25 apart, and a box that cuts off half of one.
#[test]
fn what_solids_and_surfaces_share_counts_once() {
    let pi = core::f64::consts::PI;
    let balls = [body(SPHERE, &[0.375, 0.5, 0.5, 0.25]), body(SPHERE, &[0.625, 0.5, 0.5, 0.25])];
    let lists = edges::<f64>([5, 6, 7]);
    let mut scene = Scene { surface: core::ptr::null(), solids: balls.as_ptr(), solid_count: 2 };
    let ball = 4.0 / 3.0 * pi * 0.25_f64.powi(3);
    let lens = 5.0 / 12.0 * pi * 0.25_f64.powi(3);
    let (_, report) = measure_scene(&grid(&lists), &scene, zeroed());
    assert!((report.solid_volume - (2.0 * ball - lens)).abs() < 1e-5, "{}", report.solid_volume);
    let half = Triangles::<f64>::of(&voidage_tests::solids::scene(&[cuboid(DVec3::ZERO, DVec3::new(0.375, 1.0, 1.0))]));
    let surface = half.surface();
    scene = Scene { surface: &surface, solid_count: 1, ..scene };
    let (whole, report) = measure_scene(&grid(&lists), &scene, zeroed());
    assert!((report.solid_volume - (0.375 + ball / 2.0)).abs() < 1e-4, "{}", report.solid_volume);
    let mut joined = Found { sets: Default::default() };
    for first_layer in 0..7 {
        let (part, _) = measure_scene(&grid(&lists), &scene, Options { first_layer, layers: 1, ..zeroed() });
        for (joined, part) in joined.sets.iter_mut().flatten().zip(part.sets.into_iter().flatten()) {
            joined.extend(part);
        }
    }
    assert!(joined == whole);
}

#[test]
fn solids_in_single_precision_agree_with_double() {
    let numbers = [[0.3, 0.3, 0.3, 0.25], [0.5, 0.5, 0.5, 0.25], [0.7, 0.2, 0.6, 0.2]];
    let double = numbers.map(|n| body::<f64>(SPHERE, &n));
    let single = numbers.map(|n| body::<f32>(SPHERE, &n.map(|x| x as f32)));
    let one = Scene { surface: core::ptr::null(), solids: double.as_ptr(), solid_count: 3 };
    let other = Scene { surface: core::ptr::null(), solids: single.as_ptr(), solid_count: 3 };
    let (double, _) = measure_scene(&grid(&edges([6, 6, 6])), &one, zeroed());
    let (single, _) = measure_scene(&grid(&edges([6, 6, 6])), &other, zeroed());
    for (double, single) in double.sets[0].iter().flatten().zip(single.sets[0].iter().flatten()) {
        assert!((double - f64::from(*single)).abs() < 3e-4, "{double} {single}");
    }
}
