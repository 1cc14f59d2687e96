//! Solids whose porosity is known.

use glam::DVec3;
use voidage::geometry::bodies::Bodies;
use voidage::geometry::mesh::Mesh;
use voidage::grid::Edges;
use voidage::porosity::{FieldSet, Options, Porosity, porosity};
use voidage_tests::solids::{Triangle, cuboid, scene, sixteen_spheres, sphere, volume};

fn unit_edges(n: usize) -> Edges {
    let axis: Vec<f64> = (0..=n).map(|i| i as f64).collect();
    Edges([axis.clone(), axis.clone(), axis])
}

fn run(edges: &Edges, solids: &[Vec<Triangle>]) -> Porosity {
    porosity(&edges.grid(None).expect("a grid"), &scene(solids), Options::default())
}

fn cube(center: DVec3) -> Vec<Triangle> {
    cuboid(center - 0.5, center + 0.5)
}

#[test]
fn a_cube_that_fits_a_cell_closes_it_and_its_faces_and_nothing_else() {
    let edges = unit_edges(3);
    let p = run(&edges, &[cube(DVec3::splat(1.5))]);
    let grid = edges.grid(None).expect("a grid");
    for k in 0..3 {
        for j in 0..3 {
            for i in 0..3 {
                let inside = [i, j, k] == [1, 1, 1];
                assert_eq!(p.beta.v[grid.cell_index([i, j, k])], if inside { 0.0 } else { 1.0 }, "{i} {j} {k}");
            }
        }
    }
    for (axis, field) in [&p.beta.x, &p.beta.y, &p.beta.z].into_iter().enumerate() {
        let [nx, ny, nz] = grid.face_shape(axis);
        for n in 0..nx * ny * nz {
            let at = [n % nx, n / nx % ny, n / nx / ny];
            let closed = (0..3).all(|a| if a == axis { at[a] == 1 || at[a] == 2 } else { at[a] == 1 });
            assert_eq!(field[n], if closed { 0.0 } else { 1.0 }, "axis {axis} face {at:?}");
        }
    }
    assert_eq!((p.cells.open, p.cells.cut, p.cells.closed), (26, 0, 1));
    assert_eq!(p.solid_volume, 1.0);
}

/// The paper's Fig. 4: on the line shared by four cells the cube takes a quarter of each; half way, half of two.
#[test]
fn the_papers_shifted_cubes() {
    let edges = unit_edges(4);
    let grid = edges.grid(None).expect("a grid");
    let p = run(&edges, &[cube(DVec3::new(2.0, 2.0, 1.5))]);
    for (i, j) in [(1, 1), (2, 1), (1, 2), (2, 2)] {
        assert_eq!(p.beta.v[grid.cell_index([i, j, 1])], 0.75);
    }
    let p = run(&edges, &[cube(DVec3::new(2.0, 1.5, 1.5))]);
    for i in [1, 2] {
        assert_eq!(p.beta.v[grid.cell_index([i, 1, 1])], 0.5);
    }
    assert_eq!(p.beta.x[grid.face_index(0, [2, 1, 1])], 0.0);
    assert_eq!(p.beta.y[grid.face_index(1, [1, 1, 1])], 0.5);
}

#[test]
fn a_plate_of_a_hundredth_of_a_cell_counts_in_full() {
    let edges = unit_edges(4);
    let grid = edges.grid(None).expect("a grid");
    let plate = cuboid(DVec3::new(0.5, 0.5, 1.37), DVec3::new(3.5, 3.5, 1.38));
    let p = run(&edges, &[plate]);
    let inner = p.beta.v[grid.cell_index([1, 1, 1])];
    assert!((inner - 0.99).abs() < 1e-14, "{inner}");
    let across = p.beta.z[grid.face_index(2, [1, 1, 1])];
    assert_eq!(across, 1.0, "the plate lies in no face");
    let side = p.beta.x[grid.face_index(0, [2, 2, 1])];
    assert!((side - 0.99).abs() < 1e-14, "{side}");
}

#[test]
fn a_sheet_blocks_the_faces_in_whose_plane_it_lies() {
    let edges = unit_edges(4);
    let grid = edges.grid(None).expect("a grid");
    for axis in 0..3 {
        let mut lo = DVec3::ONE;
        let mut hi = DVec3::splat(3.0);
        (lo[axis], hi[axis]) = (2.0, 2.0);
        let quad = cuboid(lo, hi).into_iter().filter(|[a, b, c]| (b - a).cross(c - a) != DVec3::ZERO).take(2).collect();
        let p = run(&edges, &[quad]);
        let mut face = [1, 1, 1];
        face[axis] = 2;
        let field = [&p.beta.x, &p.beta.y, &p.beta.z][axis];
        assert_eq!(field[grid.face_index(axis, face)], 0.0, "axis {axis}");
        assert_eq!(field.iter().filter(|&&b| b < 1.0).count(), 4, "axis {axis}");
        assert!(p.beta.v.iter().all(|&b| b == 1.0));
    }
}

#[test]
fn totals_are_the_volumes_of_the_meshes() {
    let spheres = sixteen_spheres();
    assert_eq!(spheres[0].len(), 720);
    let axis: Vec<f64> = (0..=37).map(|i| f64::from(i) / 37.0).collect();
    let p = run(&Edges([axis.clone(), axis.clone(), axis]), &spheres);
    let sum: f64 = spheres.iter().map(|s| volume(s)).sum();
    assert!((p.solid_volume - sum).abs() < 1e-14, "{} and {sum}", p.solid_volume);
    assert_eq!(p.cells.ambiguous, 0);
    assert!(p.leaks.is_empty());
}

/// A sliver is missing from one triangle of a ball: the rows say so, and bounds hold the ball as it was.
#[test]
fn bounds_hold_what_a_missing_sliver_changes() {
    let edges = unit_edges(6);
    let grid = edges.grid(None).expect("a grid");
    let whole = scene(&[sphere(DVec3::new(3.02, 2.97, 3.01), 2.3, 6)]);
    let bounded = Options { bounds: true, ..Options::default() };
    let truth = porosity(&grid, &whole, bounded);
    assert!(truth.leaks.is_empty() && truth.max_gap < 1e-12, "{:?} {}", truth.leaks, truth.max_gap);
    let fields = |set: &FieldSet| [&set.v, &set.x, &set.y, &set.z].map(|field| field.to_vec()).concat();
    let mut moved = 0;
    for n in 0..whole.triangles.len() {
        let width = [1e-2, 1e-4, 1e-6, 1e-8][n % 4];
        let mut cracked = whole.clone();
        let [a, b, _] = cracked.triangles[n];
        cracked.triangles[n][0] = a.lerp(b, width);
        let found = porosity(&grid, &cracked, bounded);
        let worst = found.leaks.first().expect("a leak").fraction;
        assert!(worst <= 2.0 * width && found.max_gap <= 10.0 * worst, "{n}: {worst:e} {:e}", found.max_gap);
        let [lower, upper] = found.bounds.as_ref().expect("asked for");
        let places = fields(&truth.beta).into_iter().zip(fields(lower)).zip(fields(upper));
        for ((beta, lower), upper) in places {
            assert!(lower <= beta + 1e-12 && beta <= upper + 1e-12, "{n}: {beta} not in {lower} to {upper}");
        }
        let off = fields(&truth.beta).into_iter().zip(fields(&found.beta)).map(|(a, b)| (a - b).abs());
        moved += usize::from(off.fold(0.0, f64::max) > 1e-11);
    }
    assert!(moved > whole.triangles.len() / 2, "values changed in {moved} cases");
}

#[test]
fn a_cavity_is_open() {
    let edges = unit_edges(4);
    let outer = cuboid(DVec3::splat(0.5), DVec3::splat(3.5));
    let hollow = cuboid(DVec3::ONE, DVec3::splat(3.0)).into_iter().map(|[a, b, c]| [a, c, b]);
    let p = run(&edges, &[outer.into_iter().chain(hollow).collect()]);
    assert!((p.solid_volume - 19.0).abs() < 1e-13);
    let grid = edges.grid(None).expect("a grid");
    assert_eq!(p.beta.v[grid.cell_index([1, 1, 1])], 1.0);
}

#[test]
fn without_areas_the_cells_are_the_same() {
    let edges = unit_edges(4);
    let solids = [sphere(DVec3::splat(2.0), 1.3, 4), sphere(DVec3::splat(2.5), 1.1, 3)];
    let (grid, bodies) = (edges.grid(None).expect("a grid"), scene(&solids));
    let all = porosity(&grid, &bodies, Options::default());
    let cells = porosity(&grid, &bodies, Options { areas: false, ..Options::default() });
    assert_eq!(all.beta.v, cells.beta.v);
    assert!(cells.beta.x.is_empty() && cells.beta.y.is_empty() && cells.beta.z.is_empty());
}

#[test]
fn bounds_hold_the_value() {
    let edges = unit_edges(4);
    let solids = [sphere(DVec3::splat(2.0), 1.3, 4), sphere(DVec3::splat(2.5), 1.1, 3)];
    let options = Options { bounds: true, ..Options::default() };
    let p = porosity(&edges.grid(None).expect("a grid"), &scene(&solids), options);
    let [lower, upper] = p.bounds.expect("bounds");
    for (b, (l, u)) in p.beta.v.iter().zip(lower.v.iter().zip(&upper.v)) {
        assert!(l <= b && b <= u && u - l <= p.max_gap + 1e-15);
    }
    assert!(p.cells.ambiguous > 0 && p.max_gap < 1e-12);
}

/// A coordinate that is no number was passed over where another of its corner is one.
#[test]
fn corners_that_are_no_numbers_are_refused() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300] {
        for n in 0..108 {
            let mut triangles = cube(DVec3::ZERO);
            triangles[n / 9][n / 3 % 3][n % 3] = bad;
            let refused = Bodies::default().add(&Mesh::from(triangles), 1.0).expect_err("no geometry");
            assert!(refused.to_string().contains(&format!("triangle {}", n / 9)), "{bad} as number {n}: {refused}");
        }
    }
}
