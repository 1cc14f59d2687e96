//! Cell updates per second of the PDR Euler kernel, one thread: medians over runs. Words choose cases by words of their names; `once` takes two steps of
//! each, for counting instructions.

use std::time::Instant;
use voidage::flow::{Flow, Treatment};
use voidage_benches::{is_asked, median, once};
use voidage_core::flow::{Boundary, Gas, Primitive};
use voidage_tests::euler::space::{layer, open_fractions};

#[derive(Clone, Copy)]
enum Space {
    Open,
    /// Mild betas everywhere, and jumps on about a share of the faces.
    Random(f64),
    /// A layer of porosity 0.5, a tenth of the box thick, askew to the grid.
    Layer,
}

/// A stream with waves in it.
fn wave<const D: usize>(n: [usize; D], space: Space) -> Flow<f64, D> {
    let width = std::array::from_fn(|d| 1.0 / n[d] as f64);
    let mut flow = Flow::uniform(n, width, Gas::Ideal { gamma: 1.4 }, [[Boundary::Periodic; 2]; D]);
    if let Space::Layer = space {
        let normal: [f64; D] = std::array::from_fn(|d| [0.8, 0.5, 0.33][d]);
        let offset = 0.45 * normal.iter().sum::<f64>();
        let open = open_fractions(n, [0.0; D], 1.0 / n[0] as f64, |low, high| {
            0.5 * layer(normal, [offset, offset + 0.1], low, high)
        });
        flow.set_porosity(open.volume, open.faces, Treatment::default()).unwrap();
    }
    if let Space::Random(share) = space {
        let cells: usize = n.iter().product();
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

fn measure<const D: usize>(name: &str, n: [usize; D], space: Space) {
    if !is_asked(name) {
        return;
    }
    let mut flow = wave(n, space);
    flow.run(0.4, 1e-6).unwrap();
    let cells = flow.len() as f64;
    let (steps, runs) = if once() { (2, 1) } else { (((4e6 / cells) as usize).max(2), 7) };
    let times: Vec<f64> = (0..runs)
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
    measure("1D 100000 open", [100_000], Space::Open);
    measure("2D 512x512 open", [512, 512], Space::Open);
    measure("3D 96x96x96 open", [96, 96, 96], Space::Open);
    measure("3D 96x96x96 betas", [96, 96, 96], Space::Random(0.0));
    measure("3D 96x96x96 betas 5% jumps", [96, 96, 96], Space::Random(0.05));
    measure("2D 512x512 betas 5% jumps", [512, 512], Space::Random(0.05));
    measure("3D 96x96x96 layer askew", [96, 96, 96], Space::Layer);
    measure("2D 512x512 layer askew", [512, 512], Space::Layer);
}
