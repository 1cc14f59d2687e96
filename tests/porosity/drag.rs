//! Resistance from geometry: closed forms, what is round, what a solid gives itself, congestion.

use glam::{DMat3, DVec3, EulerRot};
use voidage::geometry::bodies::{Bodies, OwnDrag};
use voidage::geometry::form::Form;
use voidage::geometry::{areas, facets};
use voidage::grid::Edges;
use voidage::porosity::congestion::{Congestion, Zone, congestion};
use voidage::porosity::drag::{DragCoefficients, DragLaw, ObstacleDrag, drag};
use voidage::porosity::resistance::{Resistance, resistance};
use voidage::porosity::rod::Rod;
use voidage::porosity::{Options, Porosity, porosity};
use voidage_core::convex::shape::{Capsule, Cylinder, Sphere};
use voidage_core::number::aabb::Aabb;
use voidage_core::solids::torus::TorusShape;
use voidage_tests::solids::{cuboid, formulas, scene, sphere, turned_box};

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

/// What a body has of surface within another one exerts no force: neither its own coefficient nor its kind counts there.
#[test]
fn surface_that_others_hide_does_not_count() {
    let block = scene(&[cuboid(DVec3::splat(0.3), DVec3::splat(0.7))]);
    let with = |forms: &[Form], cd: Option<f64>| {
        let mut bodies = block.clone();
        bodies.bodies.extend(formulas(forms).bodies);
        bodies.bodies[1..].iter_mut().for_each(|body| body.drag.cd = cd);
        bodies
    };
    let middle = DVec3::splat(0.5);
    let check = |bodies: &Bodies, expected: [f64; 3]| {
        let edges = edges(1, 1.0);
        let drag = drag_of(&edges, bodies, DragLaw::Bluff, DragCoefficients::default());
        let open = found(&edges, bodies).0.beta.v[0];
        for axis in 0..3 {
            let superficial = drag.cr[axis][0] * open;
            assert!((superficial / expected[axis] - 1.0).abs() < 6e-4, "{axis}: {superficial} {expected:?}");
        }
    };
    check(&with(&[Form::Sphere(Sphere { center: middle, radius: 0.1 })], Some(7.0)), [2.0 * 0.16; 3]);
    // A pipe through the block: along it its ends count in place of what it covers.
    let ends = [0.1, 0.9].map(|x| middle.with_x(x));
    let (aside, disc) = (1.2 * 0.2 * 0.4 + 2.0 * 0.16, std::f64::consts::PI * 0.01);
    let pipe = Form::Cylinder(Cylinder::new(ends[0], ends[1], 0.1));
    check(&with(&[pipe], None), [1.2 * disc + 2.0 * (0.16 - disc), aside, aside]);
    // Nine pipes cast into the block, and one outside.
    let mut cast: Vec<Form> = (0..9)
        .map(|n| {
            let place = DVec3::new(0.32, 0.4 + 0.1 * f64::from(n % 3), 0.4 + 0.1 * f64::from(n / 3));
            Form::Cylinder(Cylinder::new(place, place.with_x(0.68), 0.03))
        })
        .collect();
    cast.push(Form::Cylinder(Cylinder::new(DVec3::new(0.1, 0.1, 0.15), DVec3::new(0.1, 0.1, 0.85), 0.05)));
    let outside = 2.0 * 0.16 + 1.2 * 0.1 * 0.7;
    check(&with(&cast, None), [outside, outside, 2.0 * 0.16 + 1.2 * std::f64::consts::PI * 0.0025]);
    let mut boxes = scene(&[
        cuboid(DVec3::splat(0.2), DVec3::splat(0.6)),
        cuboid(DVec3::new(0.4, 0.3, 0.3), DVec3::new(0.8, 0.5, 0.5)),
    ]);
    boxes.bodies[0].drag.cd = Some(3.0);
    let aside = 3.0 * 0.16 + 2.0 * 0.04;
    check(&boxes, [0.5 * (3.0 * (0.16 + 0.12) + 2.0 * 0.04), aside, aside]);
    boxes.bodies.reverse();
    check(&boxes, [0.5 * (3.0 * (0.16 + 0.12) + 2.0 * 0.04), aside, aside]);
    // A panel without thickness through the block, which shows a fifth of a metre on both sides.
    let corner = |x: f64, y: f64| DVec3::new(x, y, 0.5);
    let [a, b, c, d] = [corner(0.1, 0.4), corner(0.9, 0.4), corner(0.9, 0.6), corner(0.1, 0.6)];
    let mut with_panel = scene(&[cuboid(DVec3::splat(0.3), DVec3::splat(0.7)), vec![[a, b, c], [a, c, d]]]);
    with_panel.bodies[1].drag.cd = Some(5.0);
    check(&with_panel, [2.0 * 0.16, 2.0 * 0.16, 2.0 * 0.16 + 5.0 * 2.0 * 0.04]);
}

/// Frontal area of the union of some balls in a box along an axis, each ball's share of it multiplied by its weight: by lines.
fn seen_of_balls(balls: &[(Sphere<DVec3>, f64)], cell: Aabb<DVec3>, axis: usize) -> f64 {
    const LINES: usize = 400;
    let [across, up] = [1, 2].map(|n| (axis + n) % 3);
    let size = cell.size();
    let ends = |ball: &Sphere<DVec3>, line: DVec3| {
        let beside = [across, up].map(|n| (line[n] - ball.center[n]).powi(2)).iter().sum::<f64>();
        let square = ball.radius * ball.radius - beside;
        (square > 0.0).then(|| [-1.0, 1.0].map(|side| ball.center[axis] + side * square.sqrt()))
    };
    let mut sum = 0.0;
    for (i, j) in (0..LINES * LINES).map(|n| (n % LINES, n / LINES)) {
        let mut line = cell.min;
        line[across] += size[across] * (i as f64 + 0.5) / LINES as f64;
        line[up] += size[up] * (j as f64 + 0.5) / LINES as f64;
        let all: Vec<_> = balls.iter().map(|(ball, _)| ends(ball, line)).collect();
        for (own, ((_, weight), of_ball)) in balls.iter().zip(&all).enumerate() {
            for &at in of_ball.iter().flatten().filter(|&&at| at > cell.min[axis] && at < cell.max[axis]) {
                let hides =
                    |(n, other): (usize, &Option<[f64; 2]>)| n != own && other.is_some_and(|[a, b]| a < at && at < b);
                sum += if all.iter().enumerate().any(hides) { 0.0 } else { 0.5 * weight };
            }
        }
    }
    sum * size[across] * size[up] / (LINES * LINES) as f64
}

/// Thin cells beside a wide one make its facets small, and many of them.
#[test]
fn surface_is_hidden_in_wide_cells_beside_thin_ones() {
    let line = vec![0.0, 0.1, 1.0];
    let edges = Edges([line.clone(), line.clone(), line]);
    let cell = Aabb { min: DVec3::splat(0.1), max: DVec3::ONE };
    let ball = |x: f64, y: f64, radius: f64, cd: f64| (Sphere { center: DVec3::new(x, y, 0.4), radius }, cd);
    let balls = [ball(0.4, 0.4, 0.3, 1.0), ball(0.6, 0.4, 0.3, 1.0), ball(0.5, 0.5, 0.25, 10.0)];
    let mut bodies = formulas(&balls.map(|(ball, _)| Form::Sphere(ball)));
    bodies.bodies.iter_mut().zip(balls).for_each(|(body, (_, cd))| body.drag.cd = Some(cd));
    let usual = DragCoefficients::default();
    let found = drag_of(&edges, &bodies, DragLaw::Bluff, usual);
    assert_eq!(found.unproved, 0);
    // With one coefficient for all the area counts that the union shows.
    bodies.bodies.iter_mut().for_each(|body| body.drag.cd = Some(1.0));
    let of_one = drag_of(&edges, &bodies, DragLaw::Bluff, usual);
    let ones = balls.map(|(ball, _)| (ball, 1.0));
    for axis in 0..3 {
        let ratio = found.cr[axis][7] / of_one.cr[axis][7];
        let truth = seen_of_balls(&balls, cell, axis) / seen_of_balls(&ones, cell, axis);
        assert!((ratio / truth - 1.0).abs() < 2e-3, "axis {axis}: {ratio}, by lines {truth}");
    }
}

/// Of two rods one is wholly inside the other within a cell, and so near its surface that no proof tells it in some parts of the cell.
#[test]
fn surface_is_hidden_but_for_parts_without_a_proof() {
    let edges = Edges([vec![0.0, 0.24, 0.34, 1.0], vec![0.0, 0.5, 1.0], vec![0.0, 0.25, 0.5, 0.75, 1.0]]);
    let inner = Cylinder::new(DVec3::new(0.28, 1.0, 0.02), DVec3::new(0.44, 1.35, 0.47), 0.21);
    let outer = Capsule { from: DVec3::new(0.265, 0.94, 0.08), to: DVec3::new(0.61, 0.96, 0.12), radius: 0.26 };
    let mut bodies = formulas(&[Form::Cylinder(inner), Form::Capsule(outer)]);
    let of = |bodies: &Bodies| drag_of(&edges, bodies, DragLaw::Bluff, DragCoefficients::default());
    bodies.bodies[1].drag.cd = Some(2.0);
    let [mixed, one] = [0.0, 2.0].map(|cd| {
        bodies.bodies[0].drag.cd = Some(cd);
        of(&bodies)
    });
    for axis in 0..3 {
        let [found, truth] = [&mixed, &one].map(|drag| drag.cr[axis][5]);
        assert!((found / truth - 1.0).abs() < 1e-3, "axis {axis}: {found} instead of {truth}");
    }
}

/// The table of congestion of some zones.
fn table(edges: &Edges, bodies: &Bodies, zones: &[[DVec3; 2]]) -> Vec<Congestion> {
    let grid = edges.grid(None).expect("a grid");
    let result = porosity(&grid, bodies, Options::default());
    let zone = |&[min, max]: &[DVec3; 2]| Zone { name: "some".into(), bounds: Aabb { min, max } };
    let zones: Vec<Zone> = zones.iter().map(zone).collect();
    congestion(&grid, bodies, &zones, &result, Options::default())
}

/// A pipe is one row with its diameter, length, volume and frontal area, however large the cells are and wherever zones cut it, beside the grid and
/// beyond it.
#[test]
fn congestion_of_a_pipe() {
    let pi = std::f64::consts::PI;
    for (cells, width) in [(5, 0.5), (2, 1.25), (25, 0.1), (7, 2.5 / 7.0)] {
        let (edges, zone) = (edges(cells, width), |lo, hi| [DVec3::new(-9.0, 0.0, lo), DVec3::new(9.0, 2.5, hi)]);
        for (found, height) in
            table(&edges, &pipe(0.1), &[zone(-3.0, 7.0), zone(0.0, 2.5), zone(0.33, 1.0)]).iter().zip([2.5, 2.5, 0.67])
        {
            let [size] = &found.sizes[..] else { panic!("{found:?}") };
            assert_eq!(([size.above, size.to.unwrap_or_default()], size.bodies), ([0.1, 0.2], 1));
            assert!((size.length - height).abs() < 1e-12, "{size:?}");
            assert!((size.solid_volume - pi * 0.01 * height).abs() < 1e-12, "{size:?}");
            assert!((found.solid_volume - pi * 0.01 * height).abs() < 1e-12, "{found:?}");
            // By formula the sides of a pipe that a zone cuts are known as its whole frontal area is.
            assert!((size.frontal_area[0] - 0.2 * height).abs() < 1e-9, "{size:?}");
            assert!((size.blockage[0] - 0.2 / 2.5).abs() < 1e-9, "{size:?}");
            assert!((found.volume - 6.25 * height).abs() < 1e-12);
        }
    }
}

/// Diameters and lengths of whole bodies: prisms are 4 A / P thick, bends as long as their middle line, turned anyhow.
#[test]
fn rods() {
    let turn = DMat3::from_euler(EulerRot::XYZ, 0.3, 0.9, -0.4);
    let turned = |half: DVec3| turned_box(DVec3::splat(1.2), half, turn);
    let edges = edges(3, 1.0);
    let whole = [DVec3::ZERO, DVec3::splat(3.0)];
    let only = |bodies: &Bodies| {
        let found = table(&edges, bodies, &[whole]);
        let [size] = found[0].sizes[..] else { panic!("{found:?}") };
        size
    };
    for (half, diameter) in [
        (DVec3::new(0.04, 0.9, 0.04), 0.08),
        (DVec3::new(0.9, 0.02, 0.06), 4.0 * 0.02 * 0.06 / 0.08),
        (DVec3::new(0.3, 0.3, 0.3), 0.6),
        (DVec3::new(0.5, 0.005, 0.5), 4.0 * 0.5 * 0.005 / 0.505),
    ] {
        let body = scene(&[turned(half)]);
        let area = areas::of_triangles(&body.triangles);
        let rod = Rod::of_body(&body.bodies[0], &body.triangles, &area);
        assert!((rod.diameter - diameter).abs() < 1e-12, "{half}: {rod:?}");
        assert!((rod.length - 2.0 * half.max_element()).abs() < 1e-12, "{half}: {rod:?}");
        let size = only(&body);
        assert!(size.above < diameter && diameter <= size.to.expect("an end"), "{half}: {size:?}");
        assert!((size.frontal_area[2] - area.frontal[2]).abs() < 1e-15);
    }
    // Parts of a ring, by formula and as triangles without their form, which tell no length that is less than 5 % more than they reach.
    for (angle, tolerance) in [(90.0, 5e-2), (200.0, 2e-3)] {
        let (radius, tube) = (0.8, 0.05);
        let ring = TorusShape { center: DVec3::splat(1.0), axis: DVec3::ONE, start: DVec3::X, radius, tube, angle };
        let middle = radius * angle.to_radians();
        let by_formula = only(&formulas(&[Form::Torus(ring)]));
        assert!((by_formula.length - middle).abs() < 1e-12 && by_formula.to == Some(0.1), "{by_formula:?}");
        let as_triangles = only(&scene(&[facets::triangles(&Form::Torus(ring))]));
        assert!((as_triangles.length / middle - 1.0).abs() < tolerance, "{as_triangles:?}");
        assert_eq!(as_triangles.to, Some(0.1), "{as_triangles:?}");
    }
    // A ball is as long as it is thick, tessellated too.
    for body in
        [formulas(&[Form::Sphere(Sphere { center: DVec3::ONE, radius: 0.3 })]), scene(&[sphere(DVec3::ONE, 0.3, 24)])]
    {
        let size = only(&body);
        assert!((size.length / 0.6 - 1.0).abs() < 1e-2 && size.above == 0.5, "{size:?}");
    }
}

/// A pipe as thick as a class's end is of that class, also as facets; two zones share a body without loss.
#[test]
fn ends_of_classes_and_zones() {
    let (edges, middle) = (edges(4, 0.75), 1.3);
    for end in [0.025, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0] {
        let cylinder = Form::Cylinder(Cylinder::new(DVec3::new(0.1, 1.4, 1.5), DVec3::new(2.9, 1.5, 1.6), end / 2.0));
        for bodies in [formulas(std::slice::from_ref(&cylinder)), scene(&[facets::triangles(&cylinder)])] {
            let lower = [DVec3::ZERO, DVec3::new(middle, 3.0, 3.0)];
            let upper = [DVec3::new(middle, 0.0, 0.0), DVec3::splat(3.0)];
            let found = table(&edges, &bodies, &[[DVec3::ZERO, DVec3::splat(3.0)], lower, upper]);
            let [all, a, b] = found.iter().map(|f| f.sizes[0]).collect::<Vec<_>>()[..] else { panic!("{found:?}") };
            assert_eq!([all.to, a.to, b.to], [Some(end); 3], "{found:?}");
            assert!((all.length - a.length - b.length).abs() < 1e-10, "{found:?}");
            assert!((all.length / 2.8 - 1.0).abs() < 2e-3, "{found:?}");
            for axis in 0..3 {
                let apart = all.frontal_area[axis] - a.frontal_area[axis] - b.frontal_area[axis];
                assert!(apart.abs() < 1e-10, "{found:?}");
            }
        }
    }
}

/// What only touches a side of a zone, in rounded coordinates, is whole in the zone on one side of it, and not in the other.
#[test]
fn curved_bodies_on_a_side_of_a_zone() {
    let radius = 0.1;
    let [from, to] = [0.5, 3.5].map(|x| DVec3::new(x, 2.0, 2.0 + radius));
    let ring = TorusShape {
        center: DVec3::new(2.0, 2.0, 2.0 + radius),
        axis: DVec3::Z,
        start: DVec3::X,
        radius: 1.0,
        tube: radius,
        angle: 360.0,
    };
    for form in [
        Form::Cylinder(Cylinder::new(from, to, radius)),
        Form::Capsule(Capsule { from, to, radius }),
        Form::Sphere(Sphere { center: from, radius }),
        Form::Torus(ring),
    ] {
        let bodies = formulas(std::slice::from_ref(&form));
        let [low, high] = [DVec3::ZERO, DVec3::splat(4.0)];
        let found = table(&edges(8, 0.5), &bodies, &[[low, high], [low, high.with_z(2.0)], [low.with_z(2.0), high]]);
        assert!(found[1].sizes.is_empty(), "{form:?}: {:?}", found[1]);
        let [whole, above] = [0, 2].map(|n| found[n].sizes[0]);
        assert_eq!(above.frontal_area, whole.frontal_area, "{form:?}");
        assert_eq!([above.length, above.solid_volume], [whole.length, whole.solid_volume], "{form:?}");
    }
}

/// Bodies beside a zone, or that touch it, are not in it; what is porous itself has no size.
#[test]
fn what_a_zone_does_not_hold() {
    let mut bodies =
        scene(&[cuboid(DVec3::splat(0.0), DVec3::splat(1.0)), cuboid(DVec3::splat(1.5), DVec3::splat(2.0))]);
    bodies.bodies[1].porosity = 0.5;
    let found =
        table(&edges(3, 1.0), &bodies, &[[DVec3::new(1.0, 0.0, 0.0), DVec3::splat(3.0)], [DVec3::ZERO, DVec3::ONE]]);
    assert!(found[0].sizes.is_empty(), "{found:?}");
    assert!((found[0].solid_volume - 0.0625).abs() < 1e-12, "{found:?}");
    assert_eq!((found[1].sizes[0].bodies, found[1].sizes[0].frontal_area), (1, [1.0; 3]));
}
