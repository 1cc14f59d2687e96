//! Oracles of the solver: exact solutions of Riemann problems, plain and over a porosity jump, and their cell averages.
//!
//! Nothing here is shared with the kernel. References: E. F. Toro, *Riemann Solvers and Numerical Methods for Fluid Dynamics*,
//! 3rd ed., ch. 4; stationary waves as in M. D. Thanh, D. Kröner, J. Sci. Comput. 51 (2012) 1.

pub mod cases;
pub mod expression;
pub mod hostile;
pub mod property;
pub mod space;
pub mod spherical;
pub mod two_gases;

use voidage_core::flow::Primitive;

/// One state: density, velocity, pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Density.
    pub rho: f64,
    /// Velocity.
    pub u: f64,
    /// Pressure.
    pub p: f64,
}

impl State {
    /// From its three values.
    pub fn new(rho: f64, u: f64, p: f64) -> Self {
        State { rho, u, p }
    }

    /// As the solver takes it, along axis 0.
    pub fn primitive<const D: usize>(self) -> Primitive<f64, D> {
        let mut velocity = [0.0; D];
        velocity[0] = self.u;
        Primitive { density: self.rho, velocity, pressure: self.p }
    }

    fn sound(self, gamma: f64) -> f64 {
        (gamma * self.p / self.rho).sqrt()
    }
}

/// Velocity change across the wave that brings `s` to pressure `p`, Toro eq. (4.6–4.7).
fn velocity_change(p: f64, s: State, g: f64) -> f64 {
    if p > s.p {
        let (a, b) = (2.0 / ((g + 1.0) * s.rho), (g - 1.0) / (g + 1.0) * s.p);
        (p - s.p) * (a / (p + b)).sqrt()
    } else if s.p == 0.0 {
        0.0
    } else {
        2.0 * s.sound(g) / (g - 1.0) * ((p / s.p).powf((g - 1.0) / (2.0 * g)) - 1.0)
    }
}

fn density_behind(p: f64, s: State, g: f64) -> f64 {
    let q = p / s.p;
    let m = (g - 1.0) / (g + 1.0);
    if p > s.p { s.rho * (q + m) / (q * m + 1.0) } else { s.rho * q.powf(1.0 / g) }
}

/// The exact solution of a Riemann problem of an ideal gas, vacuum included.
#[derive(Clone, Copy, Debug)]
pub struct Riemann {
    left: State,
    right: State,
    gamma: f64,
    /// Pressure and velocity between the outer waves; none if they leave vacuum.
    star: Option<(f64, f64)>,
}

impl Riemann {
    /// Solves for the star state by bisection in log p, to the last bits.
    pub fn new(left: State, right: State, gamma: f64) -> Self {
        let open = 2.0 / (gamma - 1.0) * (left.sound(gamma) + right.sound(gamma));
        if !(left.rho > 0.0 && right.rho > 0.0) || open <= right.u - left.u {
            return Riemann { left, right, gamma, star: None };
        }
        let f = |p: f64| velocity_change(p, left, gamma) + velocity_change(p, right, gamma) + (right.u - left.u);
        let (mut low, mut high) = (left.p.min(right.p), left.p.max(right.p));
        while f(low) > 0.0 {
            low *= 1e-2;
        }
        while f(high) < 0.0 {
            high *= 4.0;
        }
        for _ in 0..300 {
            let middle = (low * high).sqrt();
            if !(middle > low && middle < high) {
                break;
            }
            if f(middle) > 0.0 { high = middle } else { low = middle }
        }
        let p = (low * high).sqrt();
        let u = 0.5 * (left.u + right.u) + 0.5 * (velocity_change(p, right, gamma) - velocity_change(p, left, gamma));
        Riemann { left, right, gamma, star: Some((p, u)) }
    }

    /// Speeds of all wave edges, ascending; the contact once.
    pub fn breaks(&self) -> Vec<f64> {
        let g = self.gamma;
        let (l, r) = (self.left, self.right);
        let Some((p, u)) = self.star else {
            let mut b = Vec::new();
            if l.rho > 0.0 {
                b.extend([l.u - l.sound(g), l.u + 2.0 / (g - 1.0) * l.sound(g)]);
            }
            if r.rho > 0.0 {
                b.extend([r.u - 2.0 / (g - 1.0) * r.sound(g), r.u + r.sound(g)]);
            }
            return b;
        };
        let edges = |s: State, sign: f64| {
            let a = s.sound(g);
            if p > s.p {
                vec![s.u + sign * a * ((g + 1.0) / (2.0 * g) * p / s.p + (g - 1.0) / (2.0 * g)).sqrt()]
            } else {
                vec![s.u + sign * a, u + sign * (g * p / density_behind(p, s, g)).sqrt()]
            }
        };
        let mut b = edges(l, -1.0);
        b.push(u);
        b.extend(edges(r, 1.0));
        b.sort_by(f64::total_cmp);
        b
    }

    /// Speed of the right-going shock, if there is one.
    pub fn right_shock(&self) -> Option<f64> {
        let (p, _) = self.star?;
        let (g, r) = (self.gamma, self.right);
        (p > r.p).then(|| r.u + r.sound(g) * ((g + 1.0) / (2.0 * g) * p / r.p + (g - 1.0) / (2.0 * g)).sqrt())
    }

    /// The state at x/t = `xi`.
    pub fn at(&self, xi: f64) -> State {
        let g = self.gamma;
        // The side that a ray belongs to, mirrored so that its wave runs to the left.
        let one_side = |s: State, xi: f64, star: Option<(f64, f64)>| -> State {
            let a = s.sound(g);
            let fan = || {
                let c = 2.0 / (g + 1.0) + (g - 1.0) / ((g + 1.0) * a) * (s.u - xi);
                State {
                    rho: s.rho * c.powf(2.0 / (g - 1.0)),
                    u: 2.0 / (g + 1.0) * (a + (g - 1.0) / 2.0 * s.u + xi),
                    p: s.p * c.powf(2.0 * g / (g - 1.0)),
                }
            };
            match star {
                None if xi <= s.u - a => s,
                None if xi < s.u + 2.0 * a / (g - 1.0) => fan(),
                None => State::new(0.0, 0.0, 0.0),
                Some((p, u)) => {
                    let behind = State { rho: density_behind(p, s, g), u, p };
                    if p > s.p {
                        let speed = s.u - a * ((g + 1.0) / (2.0 * g) * p / s.p + (g - 1.0) / (2.0 * g)).sqrt();
                        if xi < speed { s } else { behind }
                    } else if xi < s.u - a {
                        s
                    } else if xi > u - behind.sound(g) {
                        behind
                    } else {
                        fan()
                    }
                }
            }
        };
        let mirror = |s: State| State { u: -s.u, ..s };
        match self.star {
            Some((_, u)) if xi <= u => one_side(self.left, xi, self.star),
            Some((p, u)) => mirror(one_side(mirror(self.right), -xi, Some((p, -u)))),
            None => {
                let l = if self.left.rho > 0.0 { one_side(self.left, xi, None) } else { self.left };
                if l.rho > 0.0 || !(self.right.rho > 0.0) { l } else { mirror(one_side(mirror(self.right), -xi, None)) }
            }
        }
    }
}

/// The exact solution of an isothermal Riemann problem, p = c² rho.
#[derive(Clone, Copy, Debug)]
pub struct IsothermalRiemann {
    left: State,
    right: State,
    c: f64,
    rho: f64,
    u: f64,
}

impl IsothermalRiemann {
    /// Solves for the star state.
    pub fn new(left: State, right: State, c: f64) -> Self {
        let change = |r: f64, k: f64| if r > k { c * (r - k) / (r * k).sqrt() } else { c * (r / k).ln() };
        let f = |r: f64| change(r, left.rho) + change(r, right.rho) + right.u - left.u;
        let (mut low, mut high) = (left.rho.min(right.rho), left.rho.max(right.rho));
        while f(low) > 0.0 {
            low *= 0.1;
        }
        while f(high) < 0.0 {
            high *= 4.0;
        }
        for _ in 0..300 {
            let middle = (low * high).sqrt();
            if !(middle > low && middle < high) {
                break;
            }
            if f(middle) > 0.0 { high = middle } else { low = middle }
        }
        let rho = (low * high).sqrt();
        let u = 0.5 * (left.u + right.u) + 0.5 * (change(rho, right.rho) - change(rho, left.rho));
        IsothermalRiemann { left, right, c, rho, u }
    }

    /// Speeds of all wave edges.
    pub fn breaks(&self) -> Vec<f64> {
        let c = self.c;
        let mut b = Vec::new();
        if self.rho > self.left.rho {
            b.push(self.left.u - c * (self.rho / self.left.rho).sqrt());
        } else {
            b.extend([self.left.u - c, self.u - c]);
        }
        if self.rho > self.right.rho {
            b.push(self.right.u + c * (self.rho / self.right.rho).sqrt());
        } else {
            b.extend([self.u + c, self.right.u + c]);
        }
        b
    }

    /// The state at x/t = `xi`.
    pub fn at(&self, xi: f64) -> State {
        let (c, star) = (self.c, (self.rho, self.u));
        let side = |s: State, xi: f64, star: (f64, f64)| {
            let behind = (star.0, star.1);
            if star.0 > s.rho {
                if xi < s.u - c * (star.0 / s.rho).sqrt() { (s.rho, s.u) } else { behind }
            } else if xi < s.u - c {
                (s.rho, s.u)
            } else if xi < star.1 - c {
                (s.rho * (-(xi + c - s.u) / c).exp(), xi + c)
            } else {
                behind
            }
        };
        let (rho, u) = if xi <= self.u {
            side(self.left, xi, star)
        } else {
            let (rho, u) = side(State { u: -self.right.u, ..self.right }, -xi, (self.rho, -self.u));
            (rho, -u)
        };
        State { rho, u, p: c * c * rho }
    }
}

/// A Riemann problem over a porosity jump whose states on both sides of the jump are known: a 1-wave on the left, then the
/// stationary wave, then an ordinary Riemann problem.
#[derive(Clone, Copy, Debug)]
pub struct PorousRiemann {
    jump_right: State,
    left: Riemann,
    right: Riemann,
    resonant_right: bool,
}

impl PorousRiemann {
    /// From the outer states and those beside the jump.
    pub fn new(left: State, right: State, beside_left: State, beside_right: State, gamma: f64) -> Self {
        let mach = beside_right.u / beside_right.sound(gamma);
        PorousRiemann {
            jump_right: beside_right,
            left: Riemann::new(left, beside_left, gamma),
            right: Riemann::new(beside_right, right, gamma),
            resonant_right: mach > 1.0 - 1e-9,
        }
    }

    /// Speeds of all wave edges, the jump included.
    pub fn breaks(&self) -> Vec<f64> {
        let mut b = vec![0.0];
        b.extend(self.left.breaks().into_iter().filter(|x| *x < 0.0));
        b.extend(self.right.breaks().into_iter().filter(|x| *x > 0.0));
        b.sort_by(f64::total_cmp);
        b
    }

    /// The state at x/t = `xi`, the jump at 0.
    pub fn at(&self, xi: f64) -> State {
        if xi < 0.0 {
            // Only the 1-wave: rays beyond the (weak) contact belong to the state beside the jump.
            let end = self.left.star.map_or(xi, |(_, u)| xi.min(u));
            return self.left.at(end);
        }
        if !self.resonant_right {
            let u = self.right.star.map_or(0.0, |(_, u)| u);
            return if xi <= u { self.jump_right } else { self.right.at(xi) };
        }
        self.right.at(xi)
    }
}

/// Eight-point Gauss-Legendre nodes and weights on [−1, 1].
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_47),
    (0.960_289_856_497_536_2, 0.101_228_536_290_376_26),
];

/// Mean of a function over an interval that is split at the kinks given (ascending).
pub fn mean(f: impl Fn(f64) -> f64, a: f64, b: f64, kinks: &[f64]) -> f64 {
    let mut edges = vec![a];
    edges.extend(kinks.iter().copied().filter(|x| *x > a && *x < b));
    edges.push(b);
    let mut sum = 0.0;
    for e in edges.windows(2) {
        let (m, h) = (0.5 * (e[0] + e[1]), 0.5 * (e[1] - e[0]));
        for (x, w) in GAUSS {
            sum += w * h * (f(m - h * x) + f(m + h * x));
        }
    }
    sum / (b - a)
}

/// Exact averages of the density over `n` cells of `domain`, from a self-similar solution centred on `x0` at time `t`.
pub fn average_density(
    at: impl Fn(f64) -> State,
    breaks: &[f64],
    domain: [f64; 2],
    x0: f64,
    t: f64,
    n: usize,
) -> Vec<f64> {
    let mut kinks: Vec<f64> = breaks.iter().map(|s| x0 + s * t).collect();
    kinks.sort_by(f64::total_cmp);
    let dx = (domain[1] - domain[0]) / n as f64;
    (0..n)
        .map(|i| {
            let a = domain[0] + i as f64 * dx;
            mean(|x| at((x - x0) / t).rho, a, a + dx, &kinks)
        })
        .collect()
}
