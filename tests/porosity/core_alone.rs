//! The core by itself, as another solver would use it, in both precisions.

use voidage_core::grid::fields::{Fields, Layer, ShapeMismatch};
use voidage_core::grid::{Grid, GridError};
use voidage_core::number::real::{Real, Vector};
use voidage_core::surface::cells::{Scratch, add_body};
use voidage_core::surface::z_faces::{Side, add_section};
use voidage_tests::solids::{sphere, volume};

/// Solid volume of one closed surface in the unit cube, and the largest leak.
fn solid_volume<V: Vector>(triangles: &[[V; 3]], n: usize) -> (V::Scalar, V::Scalar) {
    let edges: Vec<V::Scalar> = (0..=n).map(|i| V::Scalar::from_usize(i) / V::Scalar::from_usize(n)).collect();
    let grid = Grid::new(&edges, &edges, &edges).expect("a grid");
    let zero = V::Scalar::ZERO;
    let needed = Fields::<u8>::needed(&grid);
    let (mut lower, mut sum) = (vec![zero; needed], vec![zero; needed]);
    let (mut marks, mut scratch) = (vec![0; needed], vec![zero; Scratch::needed(&grid)]);
    let ids: Vec<u32> = (0..triangles.len() as u32).collect();
    let (mut total, mut leak) = (zero, zero);
    for k in 0..n {
        let mut layer = Layer {
            lower: Fields::within(&grid, &mut lower).expect("room"),
            sum: Fields::within(&grid, &mut sum).expect("room"),
            marks: Fields::within(&grid, &mut marks).expect("room"),
        };
        layer.clear();
        let mut scratch = Scratch::new(&grid, &mut scratch).expect("room");
        leak = leak.max(add_body(&grid, k, triangles, &ids, &mut scratch, &mut layer).leak);
        leak = leak.max(add_section(&grid, k, Side::Above, triangles, &ids, &mut scratch, &mut layer));
        layer.lower.cell.iter().for_each(|&v| total += v);
    }
    (total / V::Scalar::from_usize(n * n * n), leak)
}

#[test]
fn a_sphere_in_both_precisions() {
    let ball = sphere(glam::DVec3::splat(0.5), 0.4, 5);
    let (v, leak) = solid_volume(&ball, 13);
    assert!((v - volume(&ball)).abs() < 1e-14 && leak < 1e-13, "{v} {leak}");
    let single: Vec<[glam::Vec3; 3]> = ball.iter().map(|t| t.map(|p| p.as_vec3())).collect();
    let (v, leak) = solid_volume(&single, 13);
    assert!((f64::from(v) - volume(&ball)).abs() < 1e-5 && leak < 1e-4, "{v} {leak}");
}

#[test]
fn a_missing_triangle_leaks() {
    let mut ball = sphere(glam::DVec3::splat(0.5), 0.4, 5);
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
