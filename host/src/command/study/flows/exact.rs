//! Exact solutions and means over cells. Nothing here is shared with the kernel of the flow.

use crate::command::riemann::GasState;

/// Ratio of specific heats of all problems.
pub const GAMMA: f64 = 1.4;

/// Nodes and weights of Gauss and Legendre on −1 to 1.
const GAUSS: [(f64, f64); 4] = [
    (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    (-0.339_981_043_584_856_3, 0.652_145_154_862_546_2),
    (0.339_981_043_584_856_3, 0.652_145_154_862_546_2),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
];

/// Mean of a function over an interval that is split at kinks, which ascend.
pub fn mean<const N: usize>(f: impl Fn(f64) -> [f64; N], a: f64, b: f64, kinks: &[f64]) -> [f64; N] {
    let inner = kinks.iter().copied().filter(|x| *x > a && *x < b);
    let edges: Vec<f64> = std::iter::once(a).chain(inner).chain([b]).collect();
    let mut sum = [0.0; N];
    for e in edges.windows(2) {
        let (middle, half) = (0.5 * (e[0] + e[1]), 0.5 * (e[1] - e[0]));
        for (x, weight) in GAUSS {
            let value = f(middle + half * x);
            (0..N).for_each(|n| sum[n] += 0.5 * weight * value[n] * 2.0 * half / (b - a));
        }
    }
    sum
}

/// Mean of a function over a rectangle of the given centre.
pub fn mean_of_cell<const N: usize>(f: impl Fn([f64; 2]) -> [f64; N], centre: [f64; 2], width: f64) -> [f64; N] {
    let row = |y: f64| mean(|x| f([x, y]), centre[0] - 0.5 * width, centre[0] + 0.5 * width, &[]);
    mean(row, centre[1] - 0.5 * width, centre[1] + 0.5 * width, &[])
}

/// The root of an increasing function between two places, by bisection to the last bits.
pub fn root(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if !(middle > low && middle < high) {
            break;
        }
        if f(middle) > 0.0 { high = middle } else { low = middle }
    }
    0.5 * (low + high)
}

/// Gas from rest at density and pressure 1 that flows without loss: its state at a Mach number.
#[must_use]
pub fn expanded(mach: f64) -> GasState {
    let t = 1.0 / (1.0 + 0.5 * (GAMMA - 1.0) * mach * mach);
    let (rho, p) = (t.powf(1.0 / (GAMMA - 1.0)), t.powf(GAMMA / (GAMMA - 1.0)));
    GasState { rho, u: mach * (GAMMA * p / rho).sqrt(), p }
}

/// The subsonic state in an open area if `flux` of mass flows through it, from rest at density and pressure 1.
#[must_use]
pub fn subsonic(flux: f64, area: f64) -> GasState {
    let through = |mach: f64| {
        let s = expanded(mach);
        s.rho * s.u * area - flux
    };
    expanded(root(through, 0.0, 1.0))
}
