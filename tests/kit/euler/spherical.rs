//! The equations along a radius, with the source terms of a sphere: an independent truth for blasts in three dimensions.
//!
//! Conserved variables in cells of one width, slopes by van Leer, HLL fluxes, Heun's method. Nothing is shared with the kernel, which knows no source terms: there
//! a sphere would be a duct that opens. Reference: E. F. Toro, *Riemann Solvers and Numerical Methods for Fluid Dynamics*, 3rd ed., ch. 10 and sec. 1.6.2.

const GAMMA: f64 = 1.4;

/// Density, velocity, pressure.
type State = [f64; 3];

fn conserved([rho, u, p]: State) -> State {
    [rho, rho * u, p / (GAMMA - 1.0) + 0.5 * rho * u * u]
}

fn primitive([rho, m, e]: State) -> State {
    let u = m / rho;
    [rho, u, (GAMMA - 1.0) * (e - 0.5 * m * u)]
}

fn sound([rho, _, p]: State) -> f64 {
    (GAMMA * p / rho).sqrt()
}

fn combine(a: State, b: State, f: impl Fn(f64, f64) -> f64) -> State {
    std::array::from_fn(|v| f(a[v], b[v]))
}

fn flux(left: State, right: State) -> State {
    let through = |w: State| {
        let c = conserved(w);
        [c[1], c[1] * w[1] + w[2], w[1] * (c[2] + w[2])]
    };
    let low = (left[1] - sound(left)).min(right[1] - sound(right)).min(0.0);
    let high = (left[1] + sound(left)).max(right[1] + sound(right)).max(0.0);
    let carried = combine(through(left), through(right), |a, b| high * a - low * b);
    let spread = combine(conserved(left), conserved(right), |a, b| low * high * (b - a));
    combine(carried, spread, |a, b| (a + b) / (high - low))
}

/// Rates of change of the cells, and the fastest signal.
fn rates(cells: &[State], width: f64) -> (Vec<State>, f64) {
    let w: Vec<State> = cells.iter().map(|&c| primitive(c)).collect();
    let n = w.len();
    let mirrored = |[rho, u, p]: State| [rho, -u, p];
    let at = |i: isize| match i {
        -2 => mirrored(w[1]),
        -1 => mirrored(w[0]),
        _ => w[(i as usize).min(n - 1)],
    };
    let half_slope = |i: isize| -> State {
        let (below, here, above) = (at(i - 1), at(i), at(i + 1));
        let (a, b) = (combine(here, below, |x, y| x - y), combine(above, here, |x, y| x - y));
        combine(a, b, |a, b| if a * b > 0.0 { a * b / (a + b) } else { 0.0 })
    };
    let face = |i: usize| {
        let i = i as isize;
        let left = if i == 0 {
            mirrored(combine(at(0), half_slope(0), |x, s| x - s))
        } else {
            combine(at(i - 1), half_slope(i - 1), |x, s| x + s)
        };
        flux(left, combine(at(i), if i as usize == n { [0.0; 3] } else { half_slope(i) }, |x, s| x - s))
    };
    let fluxes: Vec<State> = (0..=n).map(face).collect();
    let change = |i: usize| {
        let spread = 2.0 / (width * (i as f64 + 0.5));
        let [_, u, p] = w[i];
        let source = [cells[i][1], cells[i][1] * u, u * (cells[i][2] + p)].map(|x| -spread * x);
        let passed = combine(fluxes[i], fluxes[i + 1], |low, high| (low - high) / width);
        combine(passed, source, |a, b| a + b)
    };
    let fastest = w.iter().map(|&w| w[1].abs() + sound(w)).fold(0.0, f64::max);
    ((0..n).map(change).collect(), fastest)
}

/// Largest overpressure over time at some radii, until the time `end`: gas of density 1 at rest, at a pressure of `inside` within the radius 1 and of 1
/// beyond, on so many cells up to the radius `reach`.
pub fn blast_peaks(inside: f64, (cells, reach): (usize, f64), end: f64, radii: &[f64]) -> Vec<f64> {
    let width = reach / cells as f64;
    let begin = |i: usize| conserved([1.0, 0.0, if width * (i as f64 + 0.5) < 1.0 { inside } else { 1.0 }]);
    let mut now: Vec<State> = (0..cells).map(begin).collect();
    let (mut peaks, mut time) = (vec![0.0_f64; radii.len()], 0.0);
    while time < end {
        let (first, fastest) = rates(&now, width);
        let dt = (0.4 * width / fastest).min(end - time);
        let ahead: Vec<State> = now.iter().zip(&first).map(|(&c, &r)| combine(c, r, |c, r| c + dt * r)).collect();
        let (second, _) = rates(&ahead, width);
        for (i, cell) in now.iter_mut().enumerate() {
            let both = combine(first[i], second[i], |a, b| 0.5 * dt * (a + b));
            *cell = combine(*cell, both, |c, r| c + r);
        }
        time += dt;
        for (peak, r) in peaks.iter_mut().zip(radii) {
            // Between the middles of two cells.
            let place = r / width - 0.5;
            let (i, share) = (place as usize, place.fract());
            let [below, above] = [i, i + 1].map(|i| primitive(now[i])[2] - 1.0);
            *peak = peak.max(below + share * (above - below));
        }
    }
    peaks
}
