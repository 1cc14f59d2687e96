//! What no plane wall leaves in a cell: gaps narrower than a cell, porous bodies askew to the grid, bundles of thin obstacles.

use voidage::flow::{Flow, Scalar, Treatment};
use voidage_core::flow::{Boundary, Gas, Primitive};
use voidage_tests::effort::some;
use voidage_tests::euler::property::{Source, bits};
use voidage_tests::euler::space::{OpenFractions, between_edges, disc, half_space, layer, open_fractions};

const GAMMA: f64 = 1.4;

fn flow<R: Scalar>(
    n: [usize; 2],
    width: f64,
    boundaries: [[Boundary<R, 2>; 2]; 2],
    open: &OpenFractions<2>,
    jump: f64,
) -> Flow<R, 2> {
    let gas = Gas::Ideal { gamma: R::from_f64(GAMMA) };
    let mut flow = Flow::uniform(n, [R::from_f64(width); 2], gas, boundaries);
    let to = |s: &Vec<f64>| s.iter().map(|&x| R::from_f64(x)).collect::<Vec<R>>();
    let treatment = Treatment { jump: R::from_f64(jump), ..Treatment::default() };
    flow.set_porosity(to(&open.volume), open.faces.each_ref().map(to), treatment).unwrap();
    flow
}

#[test]
fn a_stream_in_an_inclined_gap_narrower_than_a_cell_stays_as_it_is() {
    let (n, width) = ([24, 24], 0.1);
    let mut jumps = 0;
    // A gap so narrow that it enters and leaves a cell by two opposite faces alone does not tell its angle.
    for degrees in [20.0, 35.0, 45.0, 55.0, 70.0, 140.0] {
        for gap in [0.7, 1.2, 1.9] {
            let (sin, cos) = f64::to_radians(degrees).sin_cos();
            let middle = -sin * 1.2013 + cos * 1.217;
            let half = 0.5 * gap * width;
            let solid = |low: [f64; 2], high: [f64; 2]| {
                half_space([-sin, cos], middle - half, low, high) + half_space([sin, -cos], -middle - half, low, high)
            };
            let open = open_fractions(n, [0.0; 2], width, solid);
            for mach in [0.001, 0.1, 2.0, 10.0] {
                let speed = mach * GAMMA.sqrt();
                let w = Primitive { density: 1.0, velocity: [speed * cos, speed * sin], pressure: 1.0 };
                let mut flow: Flow<f64, 2> = flow(n, width, [[Boundary::FarField(w); 2]; 2], &open, 0.1);
                flow.fill(|_| w);
                for _ in 0..30 {
                    flow.advance(0.8, f64::MAX).unwrap();
                }
                jumps += flow.jump_faces();
                let q = 0.5 * speed * speed;
                for cell in (0..flow.len()).filter(|&c| open.volume[c] > 1e-4) {
                    let error = (flow.get(cell).pressure - 1.0).abs() / q;
                    // Walls that change an open face by less than a millionth count as aligned with the grid.
                    assert!(error < 1e-6 / mach, "{degrees}°, {gap} cells, Mach {mach}, cell {cell}: {error:e}");
                }
            }
        }
    }
    assert!(jumps > 0, "no gap was given to the flow to judge");
}

/// Edges of `n` cells over a length of 1, each wider than the one before by a factor.
fn edges(n: usize, growth: f64) -> Vec<f64> {
    let widths: Vec<f64> = (0..n).map(|i| growth.powi(i as i32)).collect();
    let all: f64 = widths.iter().sum();
    (0..=n).map(|i| widths[..i].iter().sum::<f64>() / all).collect()
}

/// Largest deviation from a stream of a Mach number along a porous layer, in its dynamic pressure or its speed, after 30 steps. The layer has a normal, a
/// thickness and a solid share; with `wall` all that lies behind it is solid. It begins in the middle of the box, where some of the gas is denser.
fn deviation_along_layer<const D: usize>(
    edges: &[Vec<f64>; D],
    (normal, along): ([f64; D], [f64; D]),
    (thickness, share, wall): (f64, f64, bool),
    mach: f64,
) -> f64 {
    let offset = normal.iter().sum::<f64>() * 0.4987;
    let open = between_edges(edges, |low, high| {
        let behind = if wall { half_space(normal, offset, low, high) } else { 0.0 };
        share * layer(normal, [offset, offset + thickness], low, high) + behind
    });
    let speed = mach * GAMMA.sqrt();
    let w = Primitive { density: 1.0, velocity: along.map(|a| speed * a), pressure: 1.0 };
    let widths = edges.each_ref().map(|e| e.windows(2).map(|pair| pair[1] - pair[0]).collect());
    let mut flow = Flow::new(widths, Gas::Ideal { gamma: GAMMA }, [[Boundary::FarField(w); 2]; D]);
    flow.set_porosity(open.volume.clone(), open.faces, Treatment::default()).unwrap();
    let dense = |x: [f64; D]| x.iter().map(|x| (x - 0.5).powi(2)).sum::<f64>() < 0.04;
    flow.fill(|x| Primitive { density: if dense(x) { 3.0 } else { 1.0 }, ..w });
    for _ in 0..30 {
        flow.advance(0.8, f64::MAX).unwrap();
    }
    (0..flow.len()).filter(|&c| open.volume[c] > 0.0).fold(0.0, |most: f64, c| {
        let now = flow.get(c);
        let pressure = (now.pressure - 1.0).abs() / (0.5 * speed * speed);
        let change = |d: usize| (now.velocity[d] - w.velocity[d]).abs() / speed;
        assert!(pressure.is_finite());
        (0..D).fold(most.max(pressure), |most, d| most.max(change(d)))
    })
}

/// The border of a layer that cuts corners off cells leaves the fractions of the corner of a body aligned with the grid if half of the layer is solid, in
/// space if two ninths are: the stream was taken for one against such a body.
#[test]
fn a_stream_along_a_porous_layer_stays_as_it_is() {
    let grids = [[edges(24, 1.0), edges(24, 1.0)], [edges(24, 1.05), edges(20, 0.9)]];
    for degrees in [0.0, 1.0, 20.0, 45.0, 60.0, 135.0, 200.0] {
        let (sin, cos) = f64::to_radians(degrees).sin_cos();
        for (grid, wall) in grids.iter().flat_map(|grid| [(grid, false), (grid, true)]) {
            for (thickness, share) in [(0.015, 0.5), (0.15, 0.5), (0.3, 0.2), (0.15, 0.7), (0.3, 0.95)] {
                for mach in [0.01, 0.3, 2.5] {
                    let error = deviation_along_layer(grid, ([-sin, cos], [cos, sin]), (thickness, share, wall), mach);
                    let of = format!("{degrees}°, {thickness} of {share}, wall {wall}, Mach {mach}");
                    assert!(error < 1e-11 / mach, "{of}: {error:e}");
                }
            }
        }
    }
    let grid = [edges(12, 1.0), edges(11, 1.1), edges(10, 0.95)];
    for (normal, along) in [([1.0, 2.0, 3.0], [3.0, 0.0, -1.0]), ([-1.0, 1.0, 0.5], [1.0, 2.0, -2.0])] {
        let [one, other] =
            [normal, along].map(|v: [f64; 3]| v.map(|x| x / v.iter().map(|x| x * x).sum::<f64>().sqrt()));
        for (share, wall) in [(2.0 / 9.0, false), (0.5, false), (0.5, true), (2.0 / 9.0, true)] {
            let error = deviation_along_layer(&grid, (one, other), (0.2, share, wall), 0.3);
            assert!(error < 1e-11, "{normal:?}, {share}, wall {wall}: {error:e}");
        }
    }
}

/// Density, velocity along the normal and pressure within a layer of a porosity, of gas that comes with a density and a pressure of 1 and a velocity along the
/// normal, slower than sound: the same entropy, mass and total enthalpy.
fn within_layer(porosity: f64, normal_velocity: f64) -> (f64, f64, f64) {
    let enthalpy = GAMMA / (GAMMA - 1.0);
    let mut density: f64 = 1.0;
    for _ in 0..200 {
        let inside = normal_velocity / (porosity * density);
        let share = 1.0 + 0.5 * (normal_velocity.powi(2) - inside.powi(2)) / enthalpy;
        density = share.powf(1.0 / (GAMMA - 1.0));
    }
    (density, normal_velocity / (porosity * density), density.powf(GAMMA))
}

/// A periodic box of a width of 1 with porous layers, and a stream that crosses them.
struct Layers<const D: usize> {
    /// Whole numbers, which the layers are normal to.
    normal: [i32; D],
    porosity: f64,
    /// Velocity between the layers.
    velocity: [f64; D],
}

impl<const D: usize> Layers<D> {
    /// What the stream loses of its total pressure in each layer that it crosses, in units of its dynamic pressure, as its entropy tells that rises
    /// (the sum over the box loses nothing else); and how far the mean velocity between the layers has turned, in units of the speed.
    fn loss(&self, n: usize, crossings: f64) -> (f64, f64) {
        let normal = self.normal.map(f64::from);
        let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
        let solid = |low: [f64; D], high: [f64; D]| {
            let lowest = self.normal.iter().map(|k| (*k).min(0)).sum::<i32>() - 1;
            let highest = self.normal.iter().map(|k| (*k).max(0)).sum::<i32>();
            let layers = (lowest..highest).map(|m| f64::from(m) + 0.3517);
            let one = |o: f64| layer(normal, [o, o + 0.3], low, high);
            (1.0 - self.porosity) * layers.map(one).sum::<f64>()
        };
        let open = open_fractions([n; D], [0.0; D], 1.0 / n as f64, solid);
        let boundaries = [[Boundary::Periodic; 2]; D];
        let mut flow: Flow<f64, D> =
            Flow::uniform([n; D], [1.0 / n as f64; D], Gas::Ideal { gamma: GAMMA }, boundaries);
        flow.set_porosity(open.volume.clone(), open.faces, Treatment::default()).unwrap();
        let unit = normal.map(|x| x / length);
        let through: f64 = (0..D).map(|d| unit[d] * self.velocity[d]).sum();
        let (density, inside, pressure) = within_layer(self.porosity, through);
        for (cell, volume) in open.volume.iter().enumerate() {
            // Share of the gas of the cell that is in a layer.
            let share = (1.0 - volume) / (1.0 - self.porosity) * self.porosity / volume;
            let mix = |a: f64, b: f64| a + share * (b - a);
            let velocity = std::array::from_fn(|d| self.velocity[d] + share * (inside - through) * unit[d]);
            flow.set(cell, &Primitive { density: mix(1.0, density), velocity, pressure: mix(1.0, pressure) });
        }
        let mass =
            |flow: &Flow<f64, D>| open.volume.iter().enumerate().map(|(c, v)| v * flow.get(c).density).sum::<f64>();
        let entropy = |flow: &Flow<f64, D>| {
            let of = |(c, v): (usize, &f64)| {
                let w = flow.get(c);
                v * w.density * (w.pressure / w.density.powf(GAMMA)).ln()
            };
            open.volume.iter().enumerate().map(of).sum::<f64>() / mass(flow)
        };
        let (at_first, time) = (entropy(&flow), mass(&flow) / (n as f64).powi(D as i32) / length / through.abs());
        while flow.time < crossings * time {
            flow.advance(0.8, crossings * time).unwrap();
        }
        let clear = |c: &usize| open.volume[*c] > 0.9999;
        let mean = |d: usize| {
            let all = (0..flow.len()).filter(clear);
            all.clone().map(|c| flow.get(c).velocity[d]).sum::<f64>() / all.count() as f64
        };
        let speed_sq = self.velocity.iter().map(|u| u * u).sum::<f64>();
        let turned = (0..D).fold(0.0, |most: f64, d| most.max((mean(d) - self.velocity[d]).abs() / speed_sq.sqrt()));
        // p0 falls as exp(−s/R): rho T ds over q.
        let loss = (entropy(&flow) - at_first) / (GAMMA - 1.0) / (0.5 * speed_sq) / crossings;
        (loss, turned)
    }
}

/// The exact flow is steady and loses nothing.
#[test]
fn a_stream_through_porous_layers_askew_to_the_grid_keeps_its_total_pressure() {
    let check = |of: String, most: f64, (loss, turned): (f64, f64)| {
        println!("{of}: {loss:.5} q lost in a layer, turned by {turned:.5}");
        assert!(loss.abs() < most && turned < 10.0 * most, "{of}: {loss:.5} q, turned by {turned:.5}");
    };
    for (normal, degrees) in [([5, 1], 200.0), ([2, 1], 0.0), ([1, 1], 20.0), ([-1, 2], 0.0), ([1, -5], 160.0)] {
        // In a layer of 0.2 the stream has 25 times the dynamic pressure.
        for (porosity, mach, most) in [(0.8, 0.1, 1e-3), (0.5, 0.1, 1e-3), (0.5, 0.03, 1e-3), (0.2, 0.03, 5e-3)] {
            let (sin, cos) = f64::to_radians(degrees).sin_cos();
            let velocity = [cos, sin].map(|u| u * mach * GAMMA.sqrt());
            let of = format!("{normal:?}, porosity {porosity}, Mach {mach}, stream at {degrees}°");
            check(of, most, Layers { normal, porosity, velocity }.loss(20, 0.5));
        }
    }
    for normal in [[1, 2, 3], [1, 1, 1], [0, -1, 2]] {
        let velocity = [0.6, 0.8, 0.2].map(|u: f64| u * 0.1 * GAMMA.sqrt());
        check(format!("{normal:?}"), 1e-3, Layers { normal, porosity: 0.5, velocity }.loss(12, 0.25));
    }
}

/// A body of porosity `inside` (each cell and face by itself shaken by a share `noise`) that covers a share of a box.
fn porous(
    n: [usize; 2],
    width: f64,
    inside: f64,
    noise: f64,
    covers: impl Fn([f64; 2], [f64; 2]) -> f64,
) -> OpenFractions<2> {
    let mut open = open_fractions(n, [0.0; 2], width, covers);
    let mut s = Source::seeded(7);
    let mut fill = |x: &mut f64| *x = 1.0 - (1.0 - inside * (1.0 + noise * (2.0 * s.unit() - 1.0))) * (1.0 - *x);
    open.volume.iter_mut().chain(open.faces.iter_mut().flatten()).for_each(&mut fill);
    open
}

const CHANNEL: ([usize; 2], f64) = ([64, 32], 1.0 / 32.0);

/// What a stream at Mach 0.1 through a channel loses of its total pressure between both ends, in units of its dynamic pressure:
/// means over the mass that passes, and over the last third of two and a half passes.
fn total_pressure_loss(open: &OpenFractions<2>, jump: f64) -> f64 {
    let (n, width) = CHANNEL;
    let speed = 0.1 * GAMMA.sqrt();
    let wind = Primitive { density: 1.0, velocity: [speed, 0.0], pressure: 1.0 };
    let boundaries = [[Boundary::FarField(wind); 2], [Boundary::Wall; 2]];
    let mut flow: Flow<f64, 2> = flow(n, width, boundaries, open, jump);
    flow.fill(|_| wind);
    let total_pressure = |flow: &Flow<f64, 2>, column: usize| {
        let (mut mass, mut sum) = (0.0, 0.0);
        for row in 0..n[1] {
            let w = flow.get(row * n[0] + column);
            let mach_sq = w.velocity.iter().map(|u| u * u).sum::<f64>() * w.density / (GAMMA * w.pressure);
            mass += w.density * w.velocity[0];
            sum += w.density * w.velocity[0] * w.pressure * (1.0 + 0.2 * mach_sq).powf(3.5);
        }
        sum / mass
    };
    let end = 2.5 * 2.0 / speed;
    let (mut sum, mut time) = (0.0, 0.0);
    while flow.time < end {
        let dt = flow.advance(0.8, end).unwrap();
        if flow.time > end * 2.0 / 3.0 {
            sum += dt * (total_pressure(&flow, 2) - total_pressure(&flow, n[0] - 3)) / (0.5 * speed * speed);
            time += dt;
        }
    }
    assert_eq!(flow.total.floored, 0);
    sum / time
}

/// A share of a box (or of its face) that lies in a square turned by some degrees, by samples.
fn in_square(half: f64, degrees: f64, low: [f64; 2], high: [f64; 2]) -> f64 {
    const SAMPLES: usize = 32;
    let (sin, cos) = degrees.to_radians().sin_cos();
    let points = [0, 1].map(|d| if low[d] == high[d] { 1 } else { SAMPLES });
    let place = |d: usize, i: usize| low[d] + (high[d] - low[d]) * (i as f64 + 0.5) / points[d] as f64;
    let inside = |x: f64, y: f64| (cos * x + sin * y).abs() < half && (cos * y - sin * x).abs() < half;
    let all = (0..points[0]).flat_map(|i| (0..points[1]).map(move |j| (i, j)));
    let count = all.filter(|&(i, j)| inside(place(0, i) - 1.01, place(1, j) - 0.51)).count();
    count as f64 / (points[0] * points[1]) as f64
}

#[test]
fn a_porous_body_askew_to_the_grid_costs_little_total_pressure() {
    let (n, width) = CHANNEL;
    let about = |x: [f64; 2]| [x[0] - 1.0, x[1] - 0.5];
    let square = porous(n, width, 0.8, 0.0, |low, high| in_square(0.2, 30.0, low, high));
    let round = porous(n, width, 0.8, 0.0, |low, high| disc(0.25, about(low), about(high)));
    for (name, open, most) in [("square at 30°", square, 0.03), ("disc", round, 0.03)] {
        let (found, without_map) = (total_pressure_loss(&open, 0.1), total_pressure_loss(&open, f64::INFINITY));
        println!("{name}: {found:.4} q lost, {without_map:.4} q in the geometric form alone");
        assert!(found.abs() < most && found < 0.4 * without_map, "{name}: {found} q, without the map {without_map} q");
    }
}

/// Between walls a layer askew turns the stream, which the walls turn back.
#[test]
fn a_porous_layer_askew_across_a_channel_costs_little_total_pressure() {
    let (n, width) = CHANNEL;
    let all = [(0.8, 42.0, 0.015), (0.8, 60.0, 0.01), (0.8, 75.0, 0.01), (0.5, 42.0, 0.08), (0.5, 75.0, 0.03)];
    for (porosity, degrees, most) in some(&all) {
        let (sin, cos) = f64::to_radians(degrees).sin_cos();
        let middle = sin * 1.013 - cos * 0.507;
        let across = [middle - 0.15, middle + 0.15];
        let open = porous(n, width, porosity, 0.0, |low, high| layer([sin, -cos], across, low, high));
        let (found, without_map) = (total_pressure_loss(&open, 0.1), total_pressure_loss(&open, f64::INFINITY));
        println!(
            "layer of {porosity} at {degrees}°: {found:.4} q lost, {without_map:.4} q in the geometric form alone"
        );
        assert!(
            found.abs() < most && found < 0.1 * without_map,
            "{degrees}°: {found} q, without the map {without_map} q"
        );
    }
}

#[test]
fn a_layer_of_random_obstacles_smaller_than_a_cell_keeps_the_throat_map() {
    let (n, width) = CHANNEL;
    let layer = |low: [f64; 2], high: [f64; 2]| if low[0] > 0.79 && high[0] < 1.21 { 1.0 } else { 0.0 };
    let open = porous(n, width, 0.5, 0.05, layer);
    let (found, without_map) = (total_pressure_loss(&open, 0.1), total_pressure_loss(&open, f64::INFINITY));
    println!("{found:.4} q lost, {without_map:.4} q in the geometric form alone");
    assert!(found < 0.4 && found < 0.35 * without_map, "{found} q, without the map {without_map} q");
}

/// A rough start in a box of random fractions, seen from the first axis or with both exchanged.
fn random_box(exchanged: bool) -> Vec<u64> {
    let n = [9, 8];
    let size = if exchanged { [n[1], n[0]] } else { n };
    let gas = Gas::Ideal { gamma: GAMMA };
    let mut flow: Flow<f64, 2> = Flow::uniform(size, [0.1; 2], gas, [[Boundary::Wall; 2]; 2]);
    let value = |kind: u64, i: usize, j: usize| Source::seeded(1000 * kind + 31 * i as u64 + j as u64).unit();
    // What lies at (i, j) as the first axis sees it.
    let seen = |c: usize, width: usize| {
        let (i, j) = (c % width, c / width);
        if exchanged { (j, i) } else { (i, j) }
    };
    let field = |kind: u64, width: usize, cells: usize| -> Vec<f64> {
        (0..cells).map(|c| seen(c, width)).map(|(i, j)| 0.3 + 0.7 * value(kind, i, j)).collect()
    };
    let volume = field(1, size[0], 72);
    let faces = [0, 1].map(|d| {
        let kind = if (d == 0) == exchanged { 3 } else { 2 };
        let width = size[0] + usize::from(d == 0);
        field(kind, width, width * (size[1] + usize::from(d == 1)))
    });
    flow.set_porosity(volume, faces, Treatment::default()).unwrap();
    assert!(flow.jump_faces() > 40);
    for c in 0..72 {
        let (i, j) = seen(c, size[0]);
        let mut velocity = [4, 5].map(|kind| value(kind, i, j) - 0.5);
        if exchanged {
            velocity.swap(0, 1);
        }
        let (density, pressure) = (0.5 + value(6, i, j), 0.5 + value(7, i, j));
        flow.set(c, &Primitive { density, velocity, pressure });
    }
    for _ in 0..40 {
        flow.step(0.01).unwrap();
    }
    assert_eq!(flow.total.floored, 0);
    if !exchanged {
        return bits(&flow.state);
    }
    let back = |s: &[f64]| -> Vec<f64> { (0..72).map(|c| s[(c % n[0]) * n[1] + c / n[0]]).collect() };
    let [u, v] = flow.state.momentum.each_ref().map(|m| back(m));
    let all = [back(&flow.state.density), v, u, back(&flow.state.energy)].concat();
    all.iter().map(|x| (x + 0.0).to_bits()).collect()
}

#[test]
fn exchanged_axes_of_a_random_field_give_the_same_bits() {
    assert!(random_box(false) == random_box(true));
}

/// A porous layer that is all but aligned, in a stream around periodic ends: where the ends are does not matter.
#[test]
fn a_layer_across_periodic_ends_is_like_any_other() {
    let (n, width) = ([16, 12], 0.1);
    for degrees in [0.3_f64, 20.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        // Between walls its ends are beyond them; its front and back lie within cells.
        let solid = |low: [f64; 2], high: [f64; 2]| 0.5 * layer([cos, sin], [0.43, 0.78], low, high);
        let open = open_fractions(n, [0.0; 2], width, solid);
        let moved = |by: usize| {
            let turned = |row: &[f64]| -> Vec<f64> { (0..row.len()).map(|i| row[(i + n[0] - by) % n[0]]).collect() };
            let rows = |field: &[f64], length: usize| field.chunks(length).flat_map(turned).collect::<Vec<f64>>();
            let volume = rows(&open.volume, n[0]);
            let faces = [rows(&open.faces[0], n[0] + 1), rows(&open.faces[1], n[0])];
            let open = OpenFractions { volume, faces };
            let w = Primitive { density: 1.2, velocity: [60.0, 0.0], pressure: 1e5 };
            let sides = [[Boundary::Periodic; 2], [Boundary::Wall; 2]];
            let mut flow: Flow<f64, 2> = flow(n, width, sides, &open, 0.1);
            flow.fill(|_| w);
            for _ in 0..40 {
                flow.advance(0.8, f64::MAX).unwrap();
            }
            let back = |cell: usize| cell / n[0] * n[0] + (cell % n[0] + by) % n[0];
            let pressures: Vec<f64> = (0..flow.len()).map(|cell| flow.get(back(cell)).pressure).collect();
            (flow.jump_faces(), pressures)
        };
        let (jumps, first) = moved(0);
        assert!(jumps > 0);
        for by in 1..n[0] {
            let (found, pressures) = moved(by);
            let worst = first.iter().zip(&pressures).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
            assert!(
                found == jumps && worst < 1e-12,
                "{degrees}°, {by} cells: {found} of {jumps} jump faces, {worst:e}"
            );
        }
    }
}
