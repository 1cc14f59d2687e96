//! Convergence: smooth flow, and the flow through porosity jumps that classical forms get wrong.

use voidage::flow::{Flow, Treatment};
use voidage_core::flow::{Boundary, Gas, Limiter, Primitive};
use voidage_tests::effort::some;
use voidage_tests::euler::property::Source;

const IDEAL: Gas<f64> = Gas::Ideal { gamma: 1.4 };

#[test]
fn smooth_flow_converges_at_second_order() {
    // An advected density wave along the diagonal of a square, and through a porosity that is the same everywhere.
    let error = |n: usize, limiter: Limiter, beta: Option<f64>| {
        let tau = std::f64::consts::TAU;
        let mut flow: Flow<f64, 2> = Flow::uniform([n, n], [1.0 / n as f64; 2], IDEAL, [[Boundary::Periodic; 2]; 2]);
        flow.scheme.limiter = limiter;
        if let Some(b) = beta {
            flow.set_porosity(vec![b; n * n], [vec![b; n * (n + 1)], vec![b; n * (n + 1)]], Treatment::default())
                .unwrap();
        }
        // Averages of sin over a square cell in both directions.
        let sinc = ((tau * 0.5 / n as f64).sin() / (tau * 0.5 / n as f64)).powi(2);
        let exact = |x: [f64; 2]| 1.0 + 0.2 * sinc * (tau * (x[0] + x[1])).sin();
        flow.fill(|x| Primitive { density: exact(x), velocity: [0.5, 0.5], pressure: 1.0 });
        flow.run(0.8, 1.0).unwrap();
        let h = 1.0 / n as f64;
        (0..n * n)
            .map(|c| {
                (flow.get(c).density - exact([((c % n) as f64 + 0.5) * h, ((c / n) as f64 + 0.5) * h])).abs() * h * h
            })
            .sum::<f64>()
    };
    for limiter in [Limiter::MonotonizedCentral, Limiter::VanLeer, Limiter::Unlimited] {
        for beta in [None, Some(0.4)] {
            let order = (error(32, limiter, beta) / error(64, limiter, beta)).log2();
            assert!(order > 1.8, "{limiter:?} {beta:?}: {order}");
        }
    }
}

/// The state of a stream after an isentropic change of area on the subsonic branch, by bisection.
fn after_area_change(w: Primitive<f64, 1>, ratio: f64) -> Primitive<f64, 1> {
    let g = 1.4;
    let (rho, u, p) = (w.density, w.velocity[0], w.pressure);
    let h = g / (g - 1.0) * p / rho + 0.5 * u * u;
    let state = |r: f64| {
        let pressure = p * (r / rho).powf(g);
        Primitive { density: r, velocity: [rho * u / (r * ratio)], pressure }
    };
    let excess = |r: f64| {
        let s = state(r);
        g / (g - 1.0) * s.pressure / r + 0.5 * s.velocity[0].powi(2) - h
    };
    // Subsonic: densities above the sonic one, where the total enthalpy rises with density.
    let (mut low, mut high) = (rho * 0.64, rho * 1.6);
    for _ in 0..200 {
        let m = 0.5 * (low + high);
        if excess(m) > 0.0 { high = m } else { low = m }
    }
    state(0.5 * (low + high))
}

/// Steady flow through a porous slab standing across axis `axis`: the exact states must stay, and a uniform start must reach
/// them without loss of total pressure.
fn slab<const D: usize>(axis: usize, mach: f64) {
    let m = 40;
    let mut n = [2; D];
    n[axis] = m;
    let up = Primitive { density: 1.0, velocity: [mach * 1.4f64.sqrt()], pressure: 1.0 };
    let inside = after_area_change(up, 0.5);
    let wide = |w: Primitive<f64, 1>| {
        let mut velocity = [0.0; D];
        velocity[axis] = w.velocity[0];
        Primitive { density: w.density, velocity, pressure: w.pressure }
    };
    let mut boundaries = [[Boundary::Wall; 2]; D];
    boundaries[axis] = [Boundary::FarField(wide(up)); 2];
    let mut flow: Flow<f64, D> = Flow::uniform(n, [1.0 / m as f64; D], IDEAL, boundaries);
    let stride: usize = n[..axis].iter().product();
    let in_slab = |i: usize| (m * 2 / 5..m * 3 / 5).contains(&i);
    let beta = |i: usize| if in_slab(i) { 0.5 } else { 1.0 };
    let volume: Vec<f64> = (0..flow.len()).map(|c| beta(c / stride % m)).collect();
    let faces = std::array::from_fn(|d| {
        let size: [usize; D] = std::array::from_fn(|a| n[a] + usize::from(a == d));
        (0..size.iter().product::<usize>())
            .map(|f| {
                let k = f / size[..axis].iter().product::<usize>() % size[axis];
                if d == axis { beta(k.min(m - 1)).min(beta(k.max(1) - 1)) } else { beta(k) }
            })
            .collect()
    });
    flow.set_porosity(volume, faces, Treatment::default()).unwrap();
    let exact = |c: usize| wide(if in_slab(c / stride % m) { inside } else { up });
    for c in 0..flow.len() {
        flow.set(c, &exact(c));
    }
    for _ in 0..1000 {
        flow.advance(0.8, f64::MAX).unwrap();
    }
    for c in 0..flow.len() {
        let (w, e) = (flow.get(c), exact(c));
        assert!((w.pressure / e.pressure - 1.0).abs() < 1e-11, "{D}D Mach {mach}");
        assert!((w.velocity[axis] / e.velocity[axis] - 1.0).abs() < 1e-11 / mach.min(0.1), "{D}D Mach {mach}");
    }
    for c in 0..flow.len() {
        flow.set(c, &wide(up));
    }
    flow.run(0.8, 60.0).unwrap();
    let q = 0.5 * up.velocity[0].powi(2);
    let middle = flow.get(m / 2 * stride);
    assert!((middle.pressure - inside.pressure).abs() < 1e-3 * q, "{D}D Mach {mach}: {middle:?} {inside:?}");
}

#[test]
fn slabs_lose_no_total_pressure_at_any_mach_number() {
    for mach in some(&[0.3, 0.1, 0.03, 0.003]) {
        slab::<1>(0, mach);
    }
    slab::<2>(1, 0.03);
    slab::<3>(2, 0.3);
    slab::<3>(0, 0.1);
}

#[test]
fn stretched_cells_converge_too() {
    let error = |n: usize| {
        let tau = std::f64::consts::TAU;
        let edge = |i: usize| {
            let s = i as f64 / n as f64;
            s + 0.08 * (tau * s).sin()
        };
        let widths: Vec<f64> = (0..n).map(|i| edge(i + 1) - edge(i)).collect();
        let mut flow: Flow<f64, 1> = Flow::new(
            [widths],
            IDEAL,
            [[Boundary::FarField(Primitive { density: 1.0, velocity: [1.0], pressure: 1.0 }); 2]],
        );
        let pulse = |x: f64| 1.0 + 0.3 * (-((x - 0.3) / 0.08).powi(2)).exp();
        for i in 0..n {
            let x = 0.5 * (edge(i) + edge(i + 1));
            flow.set(i, &Primitive { density: pulse(x), velocity: [1.0], pressure: 1.0 });
        }
        flow.run(0.8, 0.4).unwrap();
        (0..n)
            .map(|i| {
                let x = 0.5 * (edge(i) + edge(i + 1));
                (flow.get(i).density - pulse(x - 0.4)).abs() * (edge(i + 1) - edge(i))
            })
            .sum::<f64>()
    };
    let order = (error(100) / error(400)).log2() / 2.0;
    assert!(order > 1.8, "{order}");
}

/// Faint sound once around a periodic line, upward or downward: of third order by its waves but for the crests, which any limiter clips.
#[test]
fn sound_is_sharper_by_its_waves() {
    let error = |n: usize, limiter: Limiter, cfl: f64, way: f64| {
        let mut flow: Flow<f64, 1> = Flow::uniform([n], [1.0 / n as f64], IDEAL, [[Boundary::Periodic; 2]]);
        flow.scheme.limiter = limiter;
        let (faint, c, half) = (1e-6, 1.4f64.sqrt(), std::f64::consts::PI / n as f64);
        // The average over a cell.
        let wave = |x: f64| half.sin() / half * (std::f64::consts::TAU * x).sin();
        flow.fill(|[x]| Primitive {
            density: 1.0 + faint * wave(x),
            velocity: [way * faint * c * wave(x)],
            pressure: 1.0 + 1.4 * faint * wave(x),
        });
        flow.run(cfl, 1.0 / c).unwrap();
        let off = |i: usize| (flow.get(i).pressure - 1.0) / (1.4 * faint) - wave((i as f64 + 0.5) / n as f64);
        (0..n).map(|i| off(i).abs()).sum::<f64>() / n as f64
    };
    for (way, cfl) in [(1.0, 0.8), (-1.0, 0.8), (1.0, 0.3)] {
        let [by_waves, central] = [Limiter::AroraRoe, Limiter::MonotonizedCentral]
            .map(|limiter| [32, 64].map(|n| error(n, limiter, cfl, way)));
        println!("way {way}, CFL {cfl}: {by_waves:?}, monotonised central {central:?}");
        assert!(by_waves[1] < 0.4 * central[1] && by_waves[1] < 0.23 * by_waves[0], "way {way}, CFL {cfl}");
    }
}

/// Noise of a millionth in a closed duct whose area jumps by a factor of 30 every four cells: sound must not gain energy there.
#[test]
fn noise_dies_between_porosity_jumps() {
    for limiter in [Limiter::Steep, Limiter::AroraRoe, Limiter::VanLeer] {
        let (rows, block) = (32, 4);
        let n = rows * block;
        let volume: Vec<f64> = (0..n).map(|i| if i / block % 2 == 0 { 1.0 } else { 0.03 }).collect();
        let faces = (0..=n).map(|i| volume[i.min(n - 1)].min(volume[i.max(1) - 1])).collect();
        let mut flow: Flow<f64, 1> = Flow::uniform([n], [1.0 / n as f64], IDEAL, [[Boundary::Wall; 2]]);
        flow.scheme.limiter = limiter;
        flow.set_porosity(volume, [faces], Treatment::default()).unwrap();
        let mut s = Source::seeded(3);
        flow.fill(|_| Primitive { density: 1.0, velocity: [0.0], pressure: 1.0 });
        for i in 0..n {
            let pressure = 1.0 + 1e-6 * (s.unit() - 0.5);
            flow.set(i, &Primitive { density: 1.0, velocity: [0.0], pressure });
        }
        flow.run(0.75, 20.0).unwrap();
        let fastest = (0..n).map(|i| flow.get(i).velocity[0].abs()).fold(0.0, f64::max);
        assert!(fastest < 3e-6, "{limiter:?}: {fastest}");
    }
}
