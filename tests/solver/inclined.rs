//! Walls that are not aligned with the grid: streams along them, blasts beside them. A wedge and turned tubes are reference cases (`fixtures/walls`).

use glam::DVec3;
use voidage::flow::{Flow, Scalar, Treatment};
use voidage_core::flow::{Boundary, Gas, PressureForm, Primitive, Riemann as FluxName};
use voidage_core::number::real::Real;
use voidage_tests::euler::property::Source;
use voidage_tests::euler::space::{OpenFractions, half_space, open_fractions};
use voidage_tests::random::Random;

/// Ratio of specific heats of all gas here.
pub const GAMMA: f64 = 1.4;

/// A flow in cells of a width, with default settings but for the form of the pressure.
pub fn flow<R: Scalar, const D: usize>(
    n: [usize; D],
    width: f64,
    boundaries: [[Boundary<R, D>; 2]; D],
    open: &OpenFractions<D>,
    form: PressureForm,
) -> Flow<R, D> {
    let gas = Gas::Ideal { gamma: R::from_f64(GAMMA) };
    let mut flow = Flow::uniform(n, [R::from_f64(width); D], gas, boundaries);
    let to = |s: &Vec<f64>| s.iter().map(|&x| R::from_f64(x)).collect::<Vec<R>>();
    flow.set_porosity(to(&open.volume), open.faces.each_ref().map(to), Treatment::default()).unwrap();
    flow.scheme.pressure = form;
    flow
}

/// A stream of density 1 and pressure 1.
pub fn stream<R: Real, const D: usize>(velocity: [f64; D]) -> Primitive<R, D> {
    Primitive { density: R::ONE, velocity: velocity.map(R::from_f64), pressure: R::ONE }
}

/// Largest deviation from a stream in its dynamic pressure or its speed after some steps, over cells of more open volume than
/// `least`.
fn deviation<R: Scalar, const D: usize>(
    n: [usize; D],
    (open, least): (&OpenFractions<D>, f64),
    velocity: [f64; D],
    form: PressureForm,
    periodic: bool,
) -> f64 {
    let w = stream::<R, D>(velocity);
    let side = if periodic { Boundary::Periodic } else { Boundary::FarField(w) };
    let mut flow = flow(n, 0.1, [[side; 2]; D], open, form);
    flow.fill(|_| w);
    for _ in 0..30 {
        flow.advance(R::from_f64(0.8), R::MAX).unwrap();
    }
    assert_eq!(flow.total.floored, 0);
    let speed_sq: f64 = velocity.iter().map(|u| u * u).sum();
    (0..flow.len()).filter(|&c| open.volume[c] > least).fold(0.0, |most: f64, c| {
        let now = flow.get(c);
        let pressure = (now.pressure - w.pressure).to_f64().abs() / (0.5 * speed_sq);
        let change = |d: usize| (now.velocity[d] - w.velocity[d]).to_f64().abs() / speed_sq.sqrt();
        assert!(pressure.is_finite());
        (0..D).fold(most.max(pressure), |most, d| most.max(change(d)))
    })
}

const FORMS: [PressureForm; 2] = [PressureForm::Geometric, PressureForm::Paper];

/// The space above a wall at an angle through a point, in cells of 0.1.
fn above_wall(n: [usize; 2], degrees: f64, through: [f64; 2]) -> (OpenFractions<2>, [f64; 2]) {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let normal = [-sin, cos];
    let offset = normal[0] * through[0] + normal[1] * through[1];
    (open_fractions(n, [0.0; 2], 0.1, |low, high| half_space(normal, offset, low, high)), [cos, sin])
}

#[test]
fn a_stream_along_an_inclined_wall_stays_as_it_is() {
    let n = [24, 24];
    // Through the middle of a cell, and through a corner of the grid, where cells are cut in exact halves or not at all.
    for through in [[1.23, 1.17], [1.2, 1.2]] {
        for degrees in [0.1, 0.5, 1.0, 2.0, 5.0, 20.0, 30.0, 45.0, 60.0, 80.0, 85.0, 89.0, 135.0, 200.0, 315.0] {
            for mach in [0.001, 0.03, 0.3, 2.5, 10.0] {
                let (open, along) = above_wall(n, degrees, through);
                let velocity = along.map(|a| mach * GAMMA.sqrt() * a);
                for form in FORMS {
                    let error = deviation::<f64, 2>(n, (&open, 0.0), velocity, form, false);
                    assert!(error < 1e-9 / mach, "{degrees}° through {through:?}, Mach {mach}, {form:?}: {error:e}");
                }
            }
        }
    }
}

#[test]
fn rounding_of_the_fractions_does_not_count() {
    // Cells closed but for rounding go their own ways, and count for nothing.
    let n = [24, 24];
    let mut s = Source::seeded(3);
    for degrees in [0.5, 20.0, 45.0, 80.0] {
        let (exact, along) = above_wall(n, degrees, [1.2, 1.2]);
        for dust in [1e-16, 1e-14, 1e-12] {
            let mut open = exact.clone();
            let mut shake = |x: &mut f64| *x = (*x + dust * (2.0 * s.unit() - 1.0)).clamp(0.0, 1.0);
            open.volume.iter_mut().chain(open.faces.iter_mut().flatten()).for_each(&mut shake);
            for form in FORMS {
                let velocity = along.map(|a| 0.3 * GAMMA.sqrt() * a);
                let error = deviation::<f64, 2>(n, (&open, 1e-4), velocity, form, false);
                assert!(error < 1e-7, "{degrees}°, dust {dust:e}, {form:?}: {error:e}");
            }
        }
        let single = deviation::<f32, 2>(n, (&exact, 1e-4), along.map(|a| 0.3 * GAMMA.sqrt() * a), FORMS[0], false);
        assert!(single < 2e-3, "{degrees}° in single precision: {single:e}");
    }
}

#[test]
fn a_stream_along_a_skew_plane_stays_as_it_is() {
    let n = [12, 11, 10];
    for normal in [[1.0, 2.0, 3.0], [-3.0, 1.0, 0.02], [1.0, 1.0, 1.0], [0.0, -1.0, 2.0], [5.0, -0.1, 0.1]] {
        // A vector along the plane that no axis is.
        let [a, b, c] = normal;
        let along = [b - 2.0 * c, c - a, 2.0 * a - b];
        let length = along.iter().map(|x| x * x).sum::<f64>().sqrt();
        let offset = 0.61 * a + 0.57 * b + 0.5 * c;
        let open = open_fractions(n, [0.0; 3], 0.1, |low, high| half_space(normal, offset, low, high));
        for form in FORMS {
            let error = deviation::<f64, 3>(n, (&open, 0.0), along.map(|x| 0.5 * x / length), form, false);
            assert!(error < 1e-9, "{normal:?} {form:?}: {error:e}");
        }
    }
}

/// The squares of small volumes are alike whatever cuts them off: a cell of which a plane leaves 2e-4 was taken for a corner of the grid.
#[test]
fn a_sliver_that_a_plane_leaves_is_no_corner() {
    let n = [12, 11, 10];
    for seed in 40..60 {
        let turn = Random::new(seed).turn();
        let (normal, velocity) = (turn.x_axis.to_array(), (turn.y_axis * 0.5).to_array());
        let offset = turn.x_axis.dot(DVec3::new(0.61, 0.57, 0.5));
        let open = open_fractions(n, [0.0; 3], 0.1, |low, high| half_space(normal, offset, low, high));
        let error = deviation::<f64, 3>(n, (&open, 0.0), velocity, PressureForm::Geometric, false);
        assert!(error < 1e-9, "seed {seed}: {error:e}");
    }
}

#[test]
fn a_periodic_stream_between_inclined_walls_stays_as_it_is() {
    // Lines of slope ½ on a box of 2 × 1 close upon themselves, and so does the solid band between two of them.
    let n = [20, 10];
    let below = |c: f64, low: [f64; 2], high: [f64; 2]| half_space([-0.5, 1.0], c, low, high);
    let band = |low: [f64; 2], high: [f64; 2]| {
        (-2..3).map(|m| below(0.43 + f64::from(m), low, high) - below(0.18 + f64::from(m), low, high)).sum()
    };
    let open = open_fractions(n, [0.0; 2], 0.1, band);
    for form in FORMS {
        let error = deviation::<f64, 2>(n, (&open, 0.0), [0.4, 0.2], form, true);
        assert!(error < 1e-9, "{form:?}: {error:e}");
    }
}

/// A blast beside a skew wall, or before a skew layer of a porosity, in a mesh whose axes are those of another in an order, some turned around; told in the frame of that other mesh.
fn blast_beside_a_plane(
    order: [usize; 3],
    turned: [bool; 3],
    riemann: FluxName,
    porosity: Option<f64>,
) -> Vec<[u64; 5]> {
    let n = [9, 8, 10];
    let open = open_fractions(n, [0.0; 3], 0.1, |low, high| {
        let behind = |offset: f64| half_space([1.0, -2.0, 1.7], offset, low, high);
        porosity.map_or_else(|| behind(0.55), |porosity| (1.0 - porosity) * (behind(0.95) - behind(0.35)))
    });
    let m = order.map(|a| n[a]);
    // Where a cell, or a face of a new axis, stands in the other mesh.
    let from = |i: usize, axis: Option<usize>| {
        let size: [usize; 3] = std::array::from_fn(|a| m[a] + usize::from(axis == Some(a)));
        let at = [i % size[0], i / size[0] % size[1], i / size[0] / size[1]];
        let (mut old, mut of) = ([0; 3], [0; 3]);
        for a in 0..3 {
            old[order[a]] = if turned[a] { size[a] - 1 - at[a] } else { at[a] };
            of[order[a]] = size[a];
        }
        (old[2] * of[1] + old[1]) * of[0] + old[0]
    };
    let cells = open.volume.len();
    let here = OpenFractions {
        volume: (0..cells).map(|c| open.volume[from(c, None)]).collect(),
        faces: std::array::from_fn(|a| {
            let old = &open.faces[order[a]];
            (0..old.len()).map(|f| old[from(f, Some(a))]).collect()
        }),
    };
    let mut flow: Flow<f64, 3> = flow(m, 0.1, [[Boundary::ZeroGradient; 2]; 3], &here, PressureForm::Geometric);
    flow.scheme.riemann = riemann;
    let sign = |a: usize| if turned[a] { -1.0 } else { 1.0 };
    for c in 0..cells {
        let old = from(c, None);
        let pressure = if old % n[0] < 4 { 8.0 } else { 1.0 };
        let velocity: [f64; 3] = [0.3, -0.2, 0.1];
        flow.set(c, &Primitive { pressure, ..stream(std::array::from_fn(|a| sign(a) * velocity[order[a]])) });
    }
    for _ in 0..12 {
        flow.step(0.008).unwrap();
    }
    let mut out = vec![[0; 5]; cells];
    for c in 0..cells {
        let w = flow.get(c);
        let mut velocity = [0.0; 3];
        (0..3).for_each(|a| velocity[order[a]] = sign(a) * w.velocity[a]);
        let [x, y, z] = velocity;
        out[from(c, None)] = [w.density, x, y, z, w.pressure].map(|x| (x + 0.0).to_bits());
    }
    out
}

#[test]
fn a_blast_beside_a_plane_has_the_same_bits_along_every_axis() {
    for riemann in [FluxName::Hllc, FluxName::HllcLowMach, FluxName::Hlle] {
        for porosity in [None, Some(0.5), Some(0.15)] {
            let plain = blast_beside_a_plane([0, 1, 2], [false; 3], riemann, porosity);
            for (order, turned) in [
                ([1, 0, 2], [false; 3]),
                ([2, 0, 1], [false; 3]),
                ([0, 2, 1], [true, false, false]),
                ([1, 2, 0], [false, true, true]),
                ([0, 1, 2], [true; 3]),
            ] {
                let seen = blast_beside_a_plane(order, turned, riemann, porosity);
                assert!(seen == plain, "{riemann:?} {order:?} {turned:?} {porosity:?}");
            }
        }
    }
}

/// Slopes beside an inclined wall took the difference to the state in the solid, which is whatever a flow began with.
#[test]
fn what_stands_in_a_solid_does_not_matter() {
    let n = [24, 24];
    for degrees in [20.0, 45.0, 63.0] {
        let (open, _) = above_wall(n, degrees, [1.23, 1.17]);
        let run = |inside: Primitive<f64, 2>| {
            let sides = [[Boundary::ZeroGradient; 2]; 2];
            let mut flow: Flow<f64, 2> = flow(n, 0.1, sides, &open, PressureForm::Geometric);
            flow.fill(|x| Primitive { pressure: if x[0] < 1.0 { 8.0 } else { 1.0 }, ..stream([0.0; 2]) });
            (0..flow.len()).filter(|&c| open.volume[c] == 0.0).for_each(|c| flow.set(c, &inside));
            flow.run(0.8, 0.5).unwrap();
            let seen = (0..flow.len()).filter(|&c| open.volume[c] > 0.0);
            seen.map(|c| flow.get(c))
                .map(|w| [w.density, w.velocity[0], w.velocity[1], w.pressure].map(f64::to_bits))
                .collect::<Vec<_>>()
        };
        let other = Primitive { density: 3.0, velocity: [0.2, -0.1], pressure: 5.0 };
        assert!(run(stream([0.0; 2])) == run(other), "{degrees}°");
    }
}

/// A cell whose face at the side of the domain a solid closes took its slope to what the side would let in.
#[test]
fn what_a_side_would_let_in_does_not_matter_behind_a_solid() {
    let n = [24, 24];
    // The wall goes through cells of the first column, all of whose faces at the side are closed.
    let open = open_fractions(n, [0.0; 2], 0.1, |low, high| half_space([1.0, 0.3], 0.75, low, high));
    assert!((0..n[1]).all(|j| open.faces[0][j * (n[0] + 1)] == 0.0));
    assert!((0..n[1]).any(|j| open.volume[j * n[0]] > 0.0));
    let run = |side: Boundary<f64, 2>| {
        let sides = [[side, Boundary::Wall], [Boundary::Wall; 2]];
        let mut flow: Flow<f64, 2> = flow(n, 0.1, sides, &open, PressureForm::Geometric);
        let near = |x: [f64; 2]| (x[0] - 0.6).hypot(x[1] - 1.8) < 0.5;
        flow.fill(|x| Primitive { pressure: if near(x) { 4.0 } else { 1.0 }, ..stream([0.0; 2]) });
        flow.run(0.8, 0.5).unwrap();
        let seen = (0..flow.len()).filter(|&c| open.volume[c] > 0.0).map(|c| flow.get(c));
        seen.map(|w| [w.density, w.velocity[0], w.velocity[1], w.pressure].map(f64::to_bits)).collect::<Vec<_>>()
    };
    let wall = run(Boundary::Wall);
    let far = Primitive { density: 3.0, velocity: [0.5, -0.1], pressure: 2.0 };
    for side in [Boundary::ZeroGradient, Boundary::FarField(stream([0.0; 2])), Boundary::FarField(far)] {
        assert!(run(side) == wall, "{side:?}");
    }
}
