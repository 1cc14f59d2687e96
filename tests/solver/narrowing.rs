//! Ducts that narrow over many cells: a steady stream loses nothing there on any grid, and waves run there as they do where no face counts as a jump.

use voidage::flow::{Flow, Scalar, Treatment};
use voidage_core::flow::{Boundary, Gas, Primitive};

const GAMMA: f64 = 1.4;
const IDEAL: Gas<f64> = Gas::Ideal { gamma: GAMMA };

/// 3t² − 2t³ from 0 to 1, and its integral from 0 on.
fn smooth(t: f64) -> [f64; 2] {
    let s = t.clamp(0.0, 1.0);
    [s * s * (3.0 - 2.0 * s), s * s * s * (1.0 - 0.5 * s) + (t - s).max(0.0)]
}

/// A duct of a length, 1 wide but for a smooth part that is `narrow`.
struct Duct {
    length: f64,
    narrow: f64,
    /// Where it widens from that to 1.
    widens: [f64; 2],
    /// Where it has narrowed to it before; none if it begins narrow.
    narrows: Option<[f64; 2]>,
}

impl Duct {
    /// Area at a place, and the integral of it up to there.
    fn area(&self, x: f64) -> [f64; 2] {
        let step = |[a, b]: [f64; 2]| {
            let [value, integral] = smooth((x - a) / (b - a));
            [value, integral * (b - a)]
        };
        let [up, up_to] = step(self.widens);
        let [down, down_to] = self.narrows.map_or([1.0, x], step);
        let depth = 1.0 - self.narrow;
        [1.0 - depth * (down - up), x - depth * (down_to - up_to)]
    }

    /// Open fractions of so many cells, and of their faces.
    fn fractions(&self, cells: usize) -> [Vec<f64>; 2] {
        let width = self.length / cells as f64;
        let at = |i: usize| self.area(i as f64 * width);
        [(0..cells).map(|i| (at(i + 1)[1] - at(i)[1]) / width).collect(), (0..=cells).map(|i| at(i)[0]).collect()]
    }

    /// A gas in it on so many cells, nothing set.
    fn flow_of(
        &self,
        gas: Gas<f64>,
        cells: usize,
        sides: [Boundary<f64, 1>; 2],
        treatment: Treatment<f64>,
    ) -> (Flow<f64, 1>, Vec<f64>) {
        let [volume, faces] = self.fractions(cells);
        let mut flow = Flow::uniform([cells], [self.length / cells as f64], gas, [sides]);
        flow.set_porosity(volume.clone(), [faces], treatment).unwrap();
        (flow, volume)
    }

    /// Gas in it on so many cells, nothing set.
    fn flow(&self, cells: usize, sides: [Boundary<f64, 1>; 2], treatment: Treatment<f64>) -> (Flow<f64, 1>, Vec<f64>) {
        self.flow_of(IDEAL, cells, sides, treatment)
    }
}

/// Slow gas from a reservoir through a nozzle: what passes is told by the pressure at its end alone.
#[test]
fn slow_gas_loses_nothing_in_a_smooth_nozzle() {
    let duct = Duct { length: 1.0, narrow: 0.3, widens: [0.6, 0.9], narrows: Some([0.1, 0.4]) };
    for (pressure, cells) in [(1.002, 20), (1.002, 40), (1.002, 80), (1.005, 20), (1.005, 40)] {
        let sides = [Boundary::Reservoir { density: 1.0, pressure }, Boundary::Outlet { pressure: 1.0 }];
        let (mut flow, volume) = duct.flow(cells, sides, Treatment::default());
        flow.fill(|_| Primitive { density: 1.0, velocity: [0.0], pressure: 1.0 });
        flow.run(0.8, 400.0).unwrap();
        let ratio = (1.0 / pressure).powf(1.0 / GAMMA);
        let square = 2.0 * GAMMA / (GAMMA - 1.0) * pressure * (1.0 - (1.0 / pressure).powf(1.0 - 1.0 / GAMMA));
        let last = flow.get(cells - 1);
        let passes = volume[cells - 1] * last.density * last.velocity[0];
        let share = passes / (ratio * square.sqrt());
        assert!((share - 1.0).abs() < 2e-3, "{cells} cells from {pressure}: {share} of what passes without loss");
    }
}

/// A stream that chokes in a narrowing duct becomes steady, though how far a face acts as a jump depends on it.
#[test]
fn a_choked_stream_settles() {
    let duct = Duct { length: 1.0, narrow: 0.6, widens: [0.5, 1.0], narrows: Some([0.0, 0.5]) };
    for cells in [20, 40] {
        let sides = [Boundary::Reservoir { density: 1.0, pressure: 1.0 }, Boundary::Outlet { pressure: 0.2 }];
        let (mut flow, volume) = duct.flow(cells, sides, Treatment::default());
        flow.fill(|_| Primitive { density: 0.5, velocity: [0.0], pressure: 0.5 });
        flow.run(0.8, 30.0).unwrap();
        let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
        for later in 1..=100 {
            flow.run(0.8, 30.0 + 0.02 * f64::from(later)).unwrap();
            let mass = (0..cells).map(|i| volume[i] * flow.get(i).density).sum::<f64>();
            (least, most) = (least.min(mass), most.max(mass));
        }
        let mach = (0..cells).map(|i| flow.get(i)).map(|w| w.velocity[0] / (GAMMA * w.pressure / w.density).sqrt());
        assert!(mach.fold(0.0, f64::max) > 1.2, "{cells} cells: does not choke");
        println!("{cells} cells: mass {least} to {most}");
        assert!(most - least < 5e-4 * most, "{cells} cells: the mass goes on to change from {least} to {most}");
    }
}

const PLAIN: Treatment<f64> = Treatment { jump: f64::INFINITY, merge: true };

/// For numbers of cells, the mean differences of the pressure in a duct from a solution on many cells that counts no face as a jump: by default, and without jumps.
/// `solve` gives pressures and volumes.
fn errors(grids: &[usize], solve: impl Fn(usize, Treatment<f64>) -> [Vec<f64>; 2]) -> Vec<[f64; 2]> {
    const FINE: usize = 1600;
    let [fine, volume] = solve(FINE, PLAIN);
    let error = |cells: usize, treatment: Treatment<f64>| {
        let ([own, _], each) = (solve(cells, treatment), FINE / cells);
        let of_cell = |i: usize| {
            let part = i * each..(i + 1) * each;
            let (sum, all) = part.fold((0.0, 0.0), |(s, v), k| (s + volume[k] * fine[k], v + volume[k]));
            (own[i] - sum / all).abs()
        };
        (0..cells).map(of_cell).sum::<f64>() / cells as f64
    };
    grids.iter().map(|&cells| [Treatment::default(), PLAIN].map(|treatment| error(cells, treatment))).collect()
}

/// Pressures of a flow, and the volumes of its cells.
fn pressures(flow: &Flow<f64, 1>, volume: Vec<f64>) -> [Vec<f64>; 2] {
    [(0..volume.len()).map(|i| flow.get(i).pressure).collect(), volume]
}

/// Mean pressure errors, by default and without jumps, of a pulse that has run through a horn, over its height.
fn in_a_horn(grids: &[usize], height: f64) -> Vec<[f64; 2]> {
    let duct = Duct { length: 10.0, narrow: 0.3, widens: [2.0, 6.0], narrows: None };
    let solve = |cells: usize, treatment| {
        let (mut flow, volume) = duct.flow(cells, [Boundary::Wall; 2], treatment);
        assert_eq!(flow.jump_faces() > 0, treatment != PLAIN);
        flow.fill(|[x]| {
            let pressure = 1.0 + height * (-((x - 1.5) / 0.5_f64).powi(2)).exp();
            Primitive { density: pressure.powf(1.0 / GAMMA), velocity: [0.0], pressure }
        });
        flow.run(0.8, 5.2).unwrap();
        pressures(&flow, volume)
    };
    errors(grids, solve).into_iter().map(|both| both.map(|error| error / height)).collect()
}

#[test]
fn waves_in_a_horn_keep_their_order() {
    const CELLS: [usize; 3] = [50, 100, 200];
    for (height, most) in [(0.01, 1.25), (1.0, 1.5)] {
        let found = in_a_horn(&CELLS, height);
        for (cells, [own, without]) in CELLS.into_iter().zip(&found) {
            println!("height {height}, {cells} cells: {own:.2e}, without jumps {without:.2e}");
            assert!(*own < most * without, "height {height}, {cells} cells: {own:e}, without jumps {without:e}");
        }
        let [[coarse, _], _, [fine, _]] = found[..] else { unreachable!() };
        assert!(height > 0.01 || coarse > 12.0 * fine, "{coarse:e} on 50 cells, {fine:e} on 200");
    }
}

/// Mean pressure errors, by default and without jumps, of a shock of a Mach number that enters a duct, meets its narrow part and then the wall at its end.
fn of_a_shock(grids: &[usize], mach: f64) -> Vec<[f64; 2]> {
    let duct = Duct { length: 1.0, narrow: 0.2, widens: [2.0, 3.0], narrows: Some([0.25, 0.75]) };
    let square = mach * mach;
    let behind = Primitive {
        density: (GAMMA + 1.0) * square / ((GAMMA - 1.0) * square + 2.0),
        velocity: [2.0 / (GAMMA + 1.0) * (mach - 1.0 / mach) * GAMMA.sqrt()],
        pressure: 1.0 + 2.0 * GAMMA / (GAMMA + 1.0) * (square - 1.0),
    };
    let solve = |cells: usize, treatment| {
        let (mut flow, volume) = duct.flow(cells, [Boundary::FarField(behind), Boundary::Wall], treatment);
        assert_eq!(flow.jump_faces() > 0, treatment != PLAIN);
        let ahead = Primitive { density: 1.0, velocity: [0.0], pressure: 1.0 };
        flow.fill(|[x]| if x < 0.1 { behind } else { ahead });
        flow.run(0.8, 1.1 / (mach * GAMMA.sqrt())).unwrap();
        pressures(&flow, volume)
    };
    errors(grids, solve)
}

/// Where the gas nearly chokes, and at shocks, no face of such a duct acts as a jump. By the mean of three grids: where within a cell the shock from the wall stands
/// makes the error of each.
#[test]
fn shocks_run_in_a_duct_that_narrows_gently_as_without_jumps() {
    const CELLS: [usize; 3] = [50, 100, 200];
    for mach in [1.2, 2.0, 5.0] {
        let share = |(cells, [own, without]): (usize, [f64; 2])| {
            println!("Mach {mach}, {cells} cells: {own:.2e}, without jumps {without:.2e}");
            own / without
        };
        let shares: Vec<f64> = CELLS.into_iter().zip(of_a_shock(&CELLS, mach)).map(share).collect();
        let mean = shares.iter().product::<f64>().cbrt();
        assert!(mean < 1.4, "Mach {mach}: {shares:?} of the errors without jumps");
    }
}

/// Mean pressure errors, by default and without jumps, of a pulse that has run through a horn, over its height: two gases meet where the horn widens.
fn of_two_gases(grids: &[usize], gammas: [f64; 2]) -> Vec<[f64; 2]> {
    const HEIGHT: f64 = 0.01;
    let duct = Duct { length: 10.0, narrow: 0.3, widens: [2.0, 6.0], narrows: None };
    let solve = |cells: usize, treatment| {
        let (mut flow, volume) = duct.flow_of(Gas::Mixed { gammas: [1.1, 1.4] }, cells, [Boundary::Wall; 2], treatment);
        flow.fill_mixed(|[x]| {
            let pressure = 1.0 + HEIGHT * (-((x - 1.5) / 0.5_f64).powi(2)).exp();
            (Primitive { density: 1.0, velocity: [0.0], pressure }, gammas[usize::from(x > 4.0)])
        });
        flow.run(0.8, 5.2).unwrap();
        pressures(&flow, volume)
    };
    errors(grids, solve).into_iter().map(|both| both.map(|error| error / HEIGHT)).collect()
}

#[test]
fn two_gases_meet_in_a_horn_as_without_jumps() {
    for gammas in [[1.1, 1.4], [1.4, 1.1], [1.1, 1.1]] {
        for (cells, [own, without]) in [50, 100].into_iter().zip(of_two_gases(&[50, 100], gammas)) {
            println!("{gammas:?}, {cells} cells: {own:.2e}, without jumps {without:.2e}");
            assert!(own < 1.6 * without, "{gammas:?}, {cells} cells: {own:e}, without jumps {without:e}");
        }
    }
}

/// A pulse, and a shock for a height of 1, in a horn: velocities and pressures of the cells of a line along an axis of a mesh, three cells wide along the other.
fn along<R: Scalar>(axis: usize, height: f64) -> Vec<[f64; 2]> {
    const CELLS: usize = 50;
    let duct = Duct { length: 10.0, narrow: 0.3, widens: [2.0, 6.0], narrows: None };
    let [of_cells, of_faces] = duct.fractions(CELLS);
    let (mut n, mut sides) = ([3; 2], [[Boundary::Periodic; 2]; 2]);
    (n[axis], sides[axis]) = (CELLS, [Boundary::Wall; 2]);
    let mut flow: Flow<R, 2> = Flow::uniform(n, [R::from_f64(0.2); 2], Gas::Ideal { gamma: R::from_f64(GAMMA) }, sides);
    let place = |k: usize, n: [usize; 2]| if axis == 0 { k % n[0] } else { k / n[0] };
    let spread = |values: &[f64], n: [usize; 2]| -> Vec<R> {
        (0..n[0] * n[1]).map(|k| R::from_f64(values[place(k, n)])).collect()
    };
    let faces = [0, 1].map(|d| {
        let mut n = n;
        n[d] += 1;
        spread(if d == axis { &of_faces } else { &of_cells }, n)
    });
    flow.set_porosity(spread(&of_cells, n), faces, Treatment { jump: R::from_f64(0.1), merge: true }).unwrap();
    flow.fill(|x| {
        let pressure = 1.0 + height * (-((x[axis].to_f64() - 1.5) / 0.5).powi(2)).exp();
        let density = R::from_f64(pressure.powf(1.0 / GAMMA));
        Primitive { density, velocity: [R::ZERO; 2], pressure: R::from_f64(pressure) }
    });
    flow.run(R::from_f64(0.4), R::from_f64(5.2)).unwrap();
    let line: Vec<_> = (0..3 * CELLS).map(|k| (place(k, n), flow.get(k))).collect();
    let of = |i: usize| line.iter().filter(move |(at, _)| *at == i).map(|(_, w)| *w);
    for (i, first) in (0..CELLS).filter_map(|i| Some((i, of(i).next()?))) {
        let same = |w: Primitive<R, 2>| w.pressure == first.pressure && w.velocity == first.velocity;
        assert!(of(i).all(same) && first.velocity[1 - axis] == R::ZERO, "cell {i} of axis {axis}");
    }
    (0..CELLS).filter_map(|i| of(i).next()).map(|w| [w.velocity[axis].to_f64(), w.pressure.to_f64()]).collect()
}

#[test]
fn a_horn_along_any_axis_in_either_precision() {
    for height in [0.01, 1.0] {
        let [x, y] = [0, 1].map(|axis| along::<f64>(axis, height));
        assert_eq!(x, y, "{height}");
        for axis in [0, 1] {
            let single = along::<f32>(axis, height);
            let far = x.iter().flatten().zip(single.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            println!("height {height}, axis {axis}: {far:e} from double precision");
            assert!(far < 2e-5, "height {height}, axis {axis}: {far:e} from double precision");
        }
    }
}

/// Jump faces of a line of ducts that have these areas, by default.
fn jumps(areas: &[f64], periodic: bool) -> usize {
    let side = if periodic { Boundary::Periodic } else { Boundary::Wall };
    let mut flow = Flow::uniform([areas.len()], [1.0], IDEAL, [[side; 2]]);
    // Each face as wide as the narrower of its two cells: then the wider face of a cell in a line that narrows is as wide as the cell.
    let around = |i: usize| areas[i % areas.len()];
    let between = |i: usize| around(i).min(around(i + areas.len() - 1));
    let mut faces: Vec<f64> = (0..=areas.len()).map(between).collect();
    if !periodic {
        (faces[0], faces[areas.len()]) = (areas[0], areas[areas.len() - 1]);
    }
    flow.set_porosity(areas.to_vec(), [faces], Treatment::default()).unwrap();
    flow.jump_faces()
}

/// 10 % in all make all faces jumps that narrow a duct one after the other; ups and downs of 9 % are none.
#[test]
fn faces_that_go_on_narrowing_are_jumps_together() {
    let line = |list: &[f64]| {
        let turned: Vec<f64> = list.iter().rev().copied().collect();
        let found = jumps(list, false);
        assert_eq!(found, jumps(&turned, false), "{list:?} the other way");
        found
    };
    assert_eq!(line(&[1.0, 0.97, 0.94, 0.91, 0.91]), 0, "9 % in all");
    assert_eq!(line(&[1.0, 0.97, 0.94, 0.91, 0.88, 0.88]), 4);
    assert_eq!(line(&[1.0, 1.0, 0.97, 0.94, 0.938, 0.88]), 4, "each by more than a thousandth");
    assert_eq!(line(&[1.0, 0.96, 0.9599, 0.92, 0.88]), 0, "4 % and 8 %, a level between");
    assert_eq!(line(&[0.91, 1.0, 1.0, 0.92, 0.92, 0.99, 0.99, 0.92, 0.92]), 0, "ups and downs");
    assert_eq!(line(&[0.91, 1.0, 1.0, 0.89, 0.89]), 1, "up, and suddenly down");
    assert_eq!(line(&[0.91, 1.0, 0.6, 0.59, 0.6]), 2, "goes on narrowing beyond a sudden one, widens back by less");
    // Around the end of a periodic line: 0.96 | 0.92, 0.88, 0.84, and a sudden way back.
    assert_eq!(jumps(&[0.92, 0.88, 0.84, 1.0, 0.96], true), 4);
    assert_eq!(jumps(&[0.97, 0.94, 0.91, 0.97], true), 0);
}

/// What stands beyond a closed face that is too narrow for a wall changes nothing in a duct that goes on to widen from there.
#[test]
fn nothing_comes_from_behind_the_point_of_a_duct() {
    let run = |behind: f64| {
        let faces: Vec<f64> = (0..=30).map(|i| 0.015 * f64::max(i as f64 - 10.0, 0.0)).collect();
        let volume: Vec<f64> = faces.windows(2).map(|f| 0.5 * (f[0] + f[1])).collect();
        let mut flow = Flow::uniform([30], [1.0 / 30.0], IDEAL, [[Boundary::Wall; 2]]);
        flow.set_porosity(volume, [faces], Treatment::default()).unwrap();
        let point = 1.0 / 3.0;
        flow.fill(|[x]| Primitive {
            density: 1.0,
            velocity: [0.0],
            pressure: if x < point { behind } else { 1.0 + 0.1 * x },
        });
        flow.run(0.8, 0.2).unwrap();
        (10..30)
            .map(|i| flow.get(i))
            .map(|w| [w.density, w.velocity[0], w.pressure].map(f64::to_bits))
            .collect::<Vec<_>>()
    };
    assert_eq!(run(1.0), run(100.0));
}
