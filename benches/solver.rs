//! Cell updates per second of the PDR Euler kernel, one thread: medians over runs.

use std::time::Instant;
use voidage::flow::{Flow, Treatment};
use voidage_core::flow::{Boundary, Gas, Primitive};

fn median(mut t: Vec<f64>) -> f64 {
    t.sort_by(f64::total_cmp);
    t[t.len() / 2]
}

fn wave<const D: usize>(n: [usize; D], porous: Option<f64>) -> Flow<f64, D> {
    let width = std::array::from_fn(|d| 1.0 / n[d] as f64);
    let mut flow = Flow::uniform(n, width, Gas::Ideal { gamma: 1.4 }, [[Boundary::Periodic; 2]; D]);
    if let Some(share) = porous {
        let cells: usize = n.iter().product();
        // Mild betas everywhere, and jumps on about a share of the faces: blocks of lower porosity.
        let mut seed = 12345u64;
        let mut random = move || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 11) as f64 / (1u64 << 53) as f64
        };
        let faces: [Vec<f64>; D] = std::array::from_fn(|d| {
            let count: usize = (0..D).map(|a| n[a] + usize::from(a == d)).product();
            (0..count).map(|_| if random() < share { 0.6 } else { 0.97 + 0.03 * random() }).collect()
        });
        let volume = (0..cells).map(|_| 0.95 + 0.05 * random()).collect();
        flow.set_porosity(volume, faces, Treatment::default()).unwrap();
    }
    flow.fill(|x| Primitive {
        density: 1.0 + 0.2 * (std::f64::consts::TAU * x.iter().sum::<f64>()).sin(),
        velocity: std::array::from_fn(|d| 0.3 + 0.1 * (std::f64::consts::TAU * x[(d + 1) % D]).cos()),
        pressure: 1.0,
    });
    flow
}

fn measure<const D: usize>(name: &str, n: [usize; D], porous: Option<f64>) {
    let mut flow = wave(n, porous);
    flow.run(0.4, 1e-6).unwrap();
    let cells = flow.len() as f64;
    let steps = ((4e6 / cells) as usize).max(2);
    let times: Vec<f64> = (0..7)
        .map(|_| {
            let start = Instant::now();
            for _ in 0..steps {
                flow.advance(0.4, 1e9).unwrap();
            }
            cells * steps as f64 / start.elapsed().as_secs_f64() / 1e6
        })
        .collect();
    println!(
        "{name:32} {:8.2} M cell updates/s   memory {:.2} x conserved   fallen {}",
        median(times),
        flow.memory_ratio(),
        flow.total.first_order
    );
}

fn main() {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().unwrap();
    measure("1D 100000", [100_000], None);
    measure("2D 512x512", [512, 512], None);
    measure("3D 96x96x96", [96, 96, 96], None);
    measure("3D 96x96x96 betas", [96, 96, 96], Some(0.0));
    measure("3D 96x96x96 betas 5% jumps", [96, 96, 96], Some(0.05));
    measure("2D 512x512 betas 5% jumps", [512, 512], Some(0.05));
}
