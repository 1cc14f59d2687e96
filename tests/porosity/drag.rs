//! Resistance from geometry: closed forms, what is round, what a solid gives itself, congestion.

use glam::DVec3;
use voidage::geometry::bodies::{Bodies, OwnDrag};
use voidage::geometry::form::Form;
use voidage::grid::Edges;
use voidage::porosity::congestion::{Zone, congestion};
use voidage::porosity::drag::{DragCoefficients, DragLaw, ObstacleDrag, drag};
use voidage::porosity::resistance::{Resistance, resistance};
use voidage::porosity::{Options, Porosity, porosity};
use voidage_core::convex::shape::Cylinder;
use voidage_tests::solids::{cuboid, formulas, scene, sphere};

fn edges(cells: usize, size: f64) -> Edges {
    let axis: Vec<f64> = (0..=cells).map(|n| size * n as f64).collect();
    Edges([axis.clone(), axis.clone(), axis])
}

fn found(edges: &Edges, bodies: &Bodies) -> (Porosity, Resistance) {
    let grid = edges.grid(None).expect("a grid");
    let result = porosity(&grid, bodies, Options::default());
    let obstacles = resistance(&grid, bodies, &result, Options::default());
    (result, obstacles)
}

fn drag_of(edges: &Edges, bodies: &Bodies, law: DragLaw, coefficients: DragCoefficients) -> ObstacleDrag {
    let (result, obstacles) = found(edges, bodies);
    let grid = edges.grid(None).expect("a grid");
    drag(&grid, bodies, (&result, &obstacles), Options::default(), (law, coefficients))
}

fn pipe(radius: f64) -> Bodies {
    formulas(&[Form::Cylinder(Cylinder::new(DVec3::new(1.25, 1.25, -1.0), DVec3::new(1.25, 1.25, 4.0), radius))])
}

/// The cell in the middle of 5 × 5 × 5.
const MIDDLE: usize = 62;

/// A pipe of 0.2 m through cells of 0.5 m: CR = 1.4310835 in PDRsetFields of OpenFOAM v1912; as cr of the velocity in the pores, with open faces, over β_v.
#[test]
fn a_pipe_as_in_pdrsetfields() {
    let (edges, bodies) = (edges(5, 0.5), pipe(0.1));
    let (result, _) = found(&edges, &bodies);
    let open = result.beta.v[MIDDLE];
    assert!((open - (1.0 - std::f64::consts::PI * 0.01 / 0.25)).abs() < 1e-12);
    let pdr = drag_of(&edges, &bodies, DragLaw::Pdr, DragCoefficients::default());
    for axis in 0..2 {
        // The facets have the pipe's volume, and so a width that is 3·10⁻⁴ off.
        let superficial = pdr.cr[axis][MIDDLE] * open;
        assert!((superficial / 1.431_083_5 - 1.0).abs() < 1e-3, "{superficial}");
        assert!((pdr.ct[axis][MIDDLE] / superficial - 0.035).abs() < 1e-12);
    }
    assert!(pdr.cr[2][MIDDLE] < 1e-15, "nothing stands across z");
    let bluff = drag_of(&edges, &bodies, DragLaw::Bluff, DragCoefficients { round: 1.0, sharp: 7.0 });
    assert!((bluff.cr[0][MIDDLE] * open / 0.8 - 1.0).abs() < 1e-3);
}

/// A bar: its faces along z are partly closed, along x open.
#[test]
fn a_bar_between_planes() {
    let (edges, bodies) = (edges(5, 0.5), scene(&[cuboid(DVec3::new(1.1, 1.1, -1.0), DVec3::new(1.4, 1.3, 4.0))]));
    let drag = drag_of(&edges, &bodies, DragLaw::Bluff, DragCoefficients::default());
    let open = 1.0 - 0.3 * 0.2 / 0.25;
    assert!((drag.cr[0][MIDDLE] - 2.0 * (0.2 / 0.25) / open).abs() < 1e-12);
    assert!((drag.cr[1][MIDDLE] - 2.0 * (0.3 / 0.25) / open).abs() < 1e-12);
    assert_eq!(drag.bodies, [0, 1]);
}

/// Solid cells and open ones resist nothing, and no value is infinite.
#[test]
fn resistance_is_finite() {
    let parts: Vec<_> = (0..30)
        .map(|n| {
            let lo = DVec3::new(0.07 * f64::from(n), 0.11 * f64::from(n % 7), 0.13 * f64::from(n % 5));
            cuboid(lo, lo + DVec3::new(0.31, 0.9, 0.45))
        })
        .collect();
    for cells in [3, 8, 17] {
        let edges = edges(cells, 3.0 / cells as f64);
        let bodies = scene(&parts);
        let (result, _) = found(&edges, &bodies);
        let drag = drag_of(&edges, &bodies, DragLaw::Pdr, DragCoefficients::default());
        for (n, &open) in result.beta.v.iter().enumerate() {
            let cr = drag.cr.each_ref().map(|cr| cr[n]);
            assert!(cr.iter().all(|c| c.is_finite() && *c >= 0.0), "{n}: {cr:?}");
            assert!(open > 0.0 || cr == [0.0; 3], "{n}: {cr:?}");
        }
    }
}

/// Tessellated balls are round, boxes are not, whatever they are made of.
#[test]
fn round_and_sharp() {
    let bodies = scene(&[sphere(DVec3::splat(0.7), 0.3, 8), cuboid(DVec3::splat(1.2), DVec3::splat(1.9))]);
    assert_eq!(drag_of(&edges(5, 0.5), &bodies, DragLaw::Bluff, DragCoefficients::default()).bodies, [1, 1]);
}

/// A coefficient of its own stands for the law's; a resistance of its own for all of it, by the share of the cell that is filled.
#[test]
fn what_a_solid_gives_itself() {
    let (edges, mut bodies) = (edges(5, 0.5), pipe(0.1));
    let usual = drag_of(&edges, &bodies, DragLaw::Bluff, DragCoefficients::default()).cr[0][MIDDLE];
    bodies.bodies[0].drag = OwnDrag { cd: Some(0.6), cr: None };
    let own = drag_of(&edges, &bodies, DragLaw::Bluff, DragCoefficients::default()).cr[0][MIDDLE];
    assert!((own / usual - 0.5).abs() < 1e-12);
    let mut grating = formulas(&[Form::Box(voidage_core::number::aabb::Aabb {
        min: DVec3::new(1.0, -1.0, -1.0),
        max: DVec3::new(1.25, 4.0, 4.0),
    })]);
    grating.bodies[0].triangles = 0..12;
    grating.triangles = cuboid(DVec3::new(1.0, -1.0, -1.0), DVec3::new(1.25, 4.0, 4.0));
    grating.bodies[0].porosity = 0.5;
    grating.bodies[0].drag = OwnDrag { cd: None, cr: Some(4.0) };
    let drag = drag_of(&edges, &grating, DragLaw::Pdr, DragCoefficients::default());
    assert!((drag.cr[0][MIDDLE] - 2.0).abs() < 1e-12, "half of the cell is grating");
}

/// A pipe's diameter, length and frontal area come back.
#[test]
fn congestion_of_a_pipe() {
    let (edges, bodies) = (edges(5, 0.5), pipe(0.1));
    let (result, obstacles) = found(&edges, &bodies);
    let grid = edges.grid(None).expect("a grid");
    let zone = |name: &str, hi: f64| Zone { name: name.into(), bounds: [DVec3::ZERO, DVec3::new(2.5, 2.5, hi)] };
    let found = congestion(&grid, &[zone("all", 2.5), zone("lower", 1.0)], &result, &obstacles);
    for (zone, height) in found.iter().zip([2.5, 1.0]) {
        let [size] = &zone.sizes[..] else { panic!("{zone:?}") };
        assert_eq!([size.above, size.to.unwrap_or_default()], [0.1, 0.2]);
        assert!((size.length / height - 1.0).abs() < 1e-3, "{size:?}");
        assert!((size.frontal_area[0] / (0.2 * height) - 1.0).abs() < 1e-3);
        assert!((size.blockage[0] / (0.2 / 2.5) - 1.0).abs() < 1e-3);
        assert!((zone.solid_volume / (std::f64::consts::PI * 0.01 * height) - 1.0).abs() < 1e-9);
    }
    assert_eq!([found[0].cells, found[1].cells], [125, 50]);
}
