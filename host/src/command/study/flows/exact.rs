//! Exact solutions and means over cells. Nothing here is shared with the kernel of the flow.

/// Density, velocity, pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineState {
    /// Density.
    pub rho: f64,
    /// Velocity.
    pub u: f64,
    /// Pressure.
    pub p: f64,
}

/// Ratio of specific heats of all problems.
pub const GAMMA: f64 = 1.4;

impl LineState {
    /// Speed of sound.
    #[must_use]
    pub fn sound(self) -> f64 {
        (GAMMA * self.p / self.rho).sqrt()
    }
}

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

/// A shock tube whose left wave is a fan and whose right wave a shock, as Sod's.
///
/// E. F. Toro, *Riemann Solvers and Numerical Methods for Fluid Dynamics*, 3rd ed., sec. 4.2 to 4.5.
#[derive(Debug, Clone, Copy)]
pub struct ShockTube {
    left: LineState,
    right: LineState,
    /// Between the waves.
    p: f64,
    u: f64,
}

impl ShockTube {
    /// Finds the pressure between the waves.
    #[must_use]
    pub fn new(left: LineState, right: LineState) -> Self {
        let g = GAMMA;
        let fan = |p: f64| 2.0 * left.sound() / (g - 1.0) * ((p / left.p).powf((g - 1.0) / (2.0 * g)) - 1.0);
        let shock =
            |p: f64| (p - right.p) * (2.0 / ((g + 1.0) * right.rho) / (p + (g - 1.0) / (g + 1.0) * right.p)).sqrt();
        let p = root(|p| fan(p) + shock(p) + right.u - left.u, right.p, left.p);
        ShockTube { left, right, p, u: left.u - fan(p) }
    }

    /// Speeds of the head and the tail of the fan, of the contact, of the shock.
    #[must_use]
    pub fn speeds(&self) -> [f64; 4] {
        let g = GAMMA;
        let shock = ((g + 1.0) / (2.0 * g) * self.p / self.right.p + (g - 1.0) / (2.0 * g)).sqrt();
        let tail = LineState { rho: self.behind_fan(), u: self.u, p: self.p };
        [self.left.u - self.left.sound(), self.u - tail.sound(), self.u, self.right.u + self.right.sound() * shock]
    }

    fn behind_fan(&self) -> f64 {
        self.left.rho * (self.p / self.left.p).powf(1.0 / GAMMA)
    }

    /// The density on the ray x/t = `ray`.
    #[must_use]
    pub fn density(&self, ray: f64) -> f64 {
        let (g, [head, tail, contact, shock]) = (GAMMA, self.speeds());
        let (ratio, m) = (self.p / self.right.p, (g - 1.0) / (g + 1.0));
        match ray {
            x if x < head => self.left.rho,
            x if x < tail => {
                let c = 2.0 / (g + 1.0) + (g - 1.0) / ((g + 1.0) * self.left.sound()) * (self.left.u - x);
                self.left.rho * c.powf(2.0 / (g - 1.0))
            }
            x if x < contact => self.behind_fan(),
            x if x < shock => self.right.rho * (ratio + m) / (ratio * m + 1.0),
            _ => self.right.rho,
        }
    }
}

/// Gas from rest at density and pressure 1 that flows without loss: its state at a Mach number.
#[must_use]
pub fn expanded(mach: f64) -> LineState {
    let t = 1.0 / (1.0 + 0.5 * (GAMMA - 1.0) * mach * mach);
    let (rho, p) = (t.powf(1.0 / (GAMMA - 1.0)), t.powf(GAMMA / (GAMMA - 1.0)));
    LineState { rho, u: mach * (GAMMA * p / rho).sqrt(), p }
}

/// The subsonic state in an open area if `flux` of mass flows through it, from rest at density and pressure 1.
#[must_use]
pub fn subsonic(flux: f64, area: f64) -> LineState {
    let through = |mach: f64| {
        let s = expanded(mach);
        s.rho * s.u * area - flux
    };
    expanded(root(through, 0.0, 1.0))
}
