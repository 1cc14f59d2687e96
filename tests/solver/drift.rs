//! Obstacles at rest do no work, however a stream turns among them from cell to cell. Where nothing drives the gas, its kinetic energy never exceeds that
//! of the start, and its entropy does not fall; what stands in a duct takes total pressure and is pushed downstream.

use voidage::flow::{Flow, Treatment};
use voidage_core::flow::{Boundary, Gas, Primitive};
use voidage_tests::random::Random;

const GAMMA: f64 = 1.4;
const IDEAL: Gas<f64> = Gas::Ideal { gamma: GAMMA };

/// Open fractions of cells and faces of a box that is periodic.
struct Open<const D: usize> {
    n: [usize; D],
    volume: Vec<f64>,
    faces: [Vec<f64>; D],
}

/// Random ones; those of a face at one end are those at the other.
fn random_open<const D: usize>(n: [usize; D], random: &mut Random) -> Open<D> {
    let volume = (0..n.iter().product()).map(|_| random.between(0.3, 1.0)).collect();
    let faces = std::array::from_fn(|d| {
        let before: usize = n[..d].iter().product();
        let rows: usize = n[d + 1..].iter().product();
        let mut faces = Vec::new();
        for _ in 0..rows {
            let first = faces.len();
            faces.extend((0..n[d] * before).map(|_| random.between(0.05, 1.0)));
            faces.extend_from_within(first..first + before);
        }
        faces
    });
    Open { n, volume, faces }
}

/// Four boxes in nine cells.
fn four_boxes() -> Open<2> {
    Open {
        n: [3, 3],
        volume: vec![0.9597, 0.9662, 0.5516, 0.9101, 0.9246, 0.615, 1.0, 0.9468, 0.6048],
        faces: [
            vec![0.41, 0.87, 1.0, 0.41, 1.0, 0.71, 0.23, 1.0, 1.0, 1.0, 0.24, 1.0],
            vec![1.0, 0.93, 0.48, 0.69, 0.74, 0.24, 1.0, 1.0, 1.0, 1.0, 0.93, 0.48],
        ],
    }
}

/// Gas of one temperature and pressure 1 drifts at a Mach number in a direction. The most kinetic energy after any step over that of the start, and the
/// least entropy less that of the start, over what all the kinetic energy would add.
fn drift<const D: usize>(open: &Open<D>, mach: f64, direction: [f64; D], widths: f64) -> [f64; 2] {
    let mut flow: Flow<f64, D> = Flow::uniform(open.n, [1.0; D], IDEAL, [[Boundary::Periodic; 2]; D]);
    flow.set_porosity(open.volume.clone(), open.faces.clone(), Treatment::default()).unwrap();
    assert!(flow.jump_faces() > 0);
    let speed = mach * GAMMA.sqrt();
    flow.fill(|_| Primitive { density: 1.0, velocity: direction.map(|x| speed * x), pressure: 1.0 });
    let sums = |flow: &Flow<f64, D>| {
        (0..flow.len()).fold([0.0; 2], |[kinetic, entropy], cell| {
            let w = flow.get(cell);
            let mass = open.volume[cell] * w.density;
            let squares: f64 = w.velocity.iter().map(|u| u * u).sum();
            let own = (w.pressure.ln() - GAMMA * w.density.ln()) / (GAMMA - 1.0);
            [kinetic + 0.5 * mass * squares, entropy + mass * own]
        })
    };
    let start = sums(&flow);
    let mut most = [0.0f64; 2];
    while flow.time < widths / speed {
        flow.advance(0.8, widths / speed).unwrap();
        let now = sums(&flow);
        most = [most[0].max(now[0] / start[0]), most[1].min((now[1] - start[1]) / start[0])];
    }
    most
}

#[test]
fn nothing_drives_a_drift_among_obstacles() {
    let check = |[kinetic, entropy]: [f64; 2], of: &str| {
        assert!(kinetic < 1.0 + 1e-6, "{of}: {kinetic} of the kinetic energy at the start");
        assert!(entropy > -1e-6, "{of}: entropy fell by what {entropy} of the kinetic energy would add");
    };
    check(drift(&four_boxes(), 0.03, [1.0, 0.0], 20.0), "four boxes");
    let mut random = Random::new(5);
    for seed in 0..12 {
        let mach = [0.003, 0.03, 0.05][seed % 3];
        let angle: f64 = random.between(0.0, std::f64::consts::TAU);
        let open = random_open([[3, 3], [4, 2], [2, 2], [5, 4]][seed % 4], &mut random);
        check(drift(&open, mach, [angle.cos(), angle.sin()], 150.0 * mach), &format!("plane {seed}, Mach {mach}"));
        let open = random_open([[2, 2, 2], [3, 3, 2]][seed % 2], &mut random);
        check(drift(&open, mach, random.on_sphere(), 80.0 * mach), &format!("space {seed}, Mach {mach}"));
    }
}

/// Force on what stands in a duct between walls, 20 cells long and some wide, over dynamic pressure and width of the stream that comes, and the gain of
/// total pressure over the dynamic one, as means over the second half of a run. Open fractions of cells and faces are told by row and place; all others are 1.
fn in_duct(rows: usize, open: [&[(usize, usize, f64)]; 3]) -> [f64; 2] {
    const LONG: usize = 20;
    let mut fractions = [vec![1.0; LONG * rows], vec![1.0; (LONG + 1) * rows], vec![1.0; LONG * (rows + 1)]];
    for (k, list) in open.into_iter().enumerate() {
        for &(row, place, fraction) in list {
            fractions[k][row * if k == 1 { LONG + 1 } else { LONG } + place] = fraction;
        }
    }
    let [volume, x, y] = fractions;
    let speed = 0.06 * GAMMA.sqrt();
    let w = Primitive { density: 1.0, velocity: [speed, 0.0], pressure: 1.0 };
    let sides = [[Boundary::FarField(w), Boundary::Outlet { pressure: 1.0 }], [Boundary::Wall; 2]];
    let mut flow: Flow<f64, 2> = Flow::uniform([LONG, rows], [1.0; 2], IDEAL, sides);
    flow.set_porosity(volume, [x, y], Treatment::default()).unwrap();
    flow.fill(|_| w);
    // Mass flux, momentum flux, and mass flux times total pressure through a column.
    let through = |flow: &Flow<f64, 2>, place: usize| {
        (0..rows).fold([0.0; 3], |[mass, momentum, total], row| {
            let w = flow.get(row * LONG + place);
            let squares = w.velocity[0] * w.velocity[0] + w.velocity[1] * w.velocity[1];
            let rest = w.pressure * (1.0 + 0.2 * squares * w.density / (GAMMA * w.pressure)).powf(3.5);
            let flux = w.density * w.velocity[0];
            [mass + flux, momentum + w.pressure + flux * w.velocity[0], total + flux * rest]
        })
    };
    let end = 60.0 / speed;
    let mut sums = [0.0; 4];
    while flow.time < end {
        let dt = flow.advance(0.8, end).unwrap();
        if flow.time > 0.5 * end {
            let ([mass, a, total_a], [other, b, total_b]) = (through(&flow, 2), through(&flow, 16));
            let now = [mass / rows as f64, (a - b) / rows as f64, total_b / other - total_a / mass, 1.0];
            sums = std::array::from_fn(|k| sums[k] + dt * now[k]);
        }
    }
    let [mass, force, gain, _] = sums.map(|s| s / sums[3]);
    let q = 0.5 * mass * mass;
    [force / q, gain / q]
}

#[test]
fn what_stands_in_a_duct_is_pushed_downstream_and_takes_total_pressure() {
    let two_rows: [&[(usize, usize, f64)]; 3] = [
        &[(0, 8, 0.9), (0, 9, 0.7), (1, 6, 0.82), (1, 7, 0.94), (1, 8, 0.6), (1, 9, 0.88)],
        &[(0, 9, 0.5), (1, 7, 0.7), (1, 8, 0.4), (1, 9, 0.2)],
        &[(1, 6, 0.4), (1, 8, 0.2), (1, 9, 0.4), (2, 7, 0.9), (2, 8, 0.4)],
    ];
    let three_rows: [&[(usize, usize, f64)]; 3] = [
        &[
            (0, 6, 0.9512),
            (0, 7, 0.7804),
            (0, 8, 0.8173),
            (1, 6, 0.9912),
            (1, 7, 0.9604),
            (1, 8, 0.9594),
            (2, 8, 0.8434),
            (2, 9, 0.6721),
        ],
        &[(0, 7, 0.39), (0, 9, 0.37), (1, 7, 0.89), (1, 9, 0.86), (2, 9, 0.4)],
        &[(1, 6, 0.92), (1, 7, 0.64), (1, 8, 0.71), (3, 8, 0.42), (3, 9, 0.23)],
    ];
    for (rows, open) in [(2, two_rows), (3, three_rows)] {
        let [force, gain] = in_duct(rows, open);
        assert!(
            force > 0.0 && gain < 0.0,
            "{rows} rows: force {force}, total pressure gained {gain} dynamic pressures"
        );
    }
}
