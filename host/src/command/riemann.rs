//! The exact solution of a Riemann problem of an ideal gas, vacuum included.
//!
//! Reference: E. F. Toro, *Riemann Solvers and Numerical Methods for Fluid Dynamics*, 3rd ed., ch. 4. Nothing here is shared with the
//! kernel.

use crate::flow::Scalar;
use voidage_core::flow::Primitive;

/// Gas on one side: density, velocity, pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GasState {
    /// Density.
    pub rho: f64,
    /// Velocity.
    pub u: f64,
    /// Pressure.
    pub p: f64,
}

impl GasState {
    /// As the solver takes it, along an axis.
    #[must_use]
    pub fn along<R: Scalar, const D: usize>(self, axis: usize) -> Primitive<R, D> {
        let velocity = std::array::from_fn(|d| if d == axis { R::from_f64(self.u) } else { R::ZERO });
        Primitive { density: R::from_f64(self.rho), velocity, pressure: R::from_f64(self.p) }
    }

    /// Speed of sound.
    #[must_use]
    pub fn sound(self, gamma: f64) -> f64 {
        (gamma * self.p / self.rho).sqrt()
    }

    fn mirrored(self) -> Self {
        GasState { u: -self.u, ..self }
    }
}

/// Two states that meet at x = 0.
#[derive(Debug, Clone, Copy)]
pub struct ExactRiemann {
    left: GasState,
    right: GasState,
    gamma: f64,
    /// Pressure and velocity between the outer waves; none if they leave vacuum.
    star: Option<(f64, f64)>,
}

/// Velocity change across the wave that brings a state to pressure `p`, Toro eq. (4.6) and (4.7).
fn velocity_change(p: f64, s: GasState, g: f64) -> f64 {
    if p > s.p {
        let (a, b) = (2.0 / ((g + 1.0) * s.rho), (g - 1.0) / (g + 1.0) * s.p);
        (p - s.p) * (a / (p + b)).sqrt()
    } else {
        2.0 * s.sound(g) / (g - 1.0) * ((p / s.p).powf((g - 1.0) / (2.0 * g)) - 1.0)
    }
}

impl ExactRiemann {
    /// Solves for the state between the outer waves by bisection in the logarithm of the pressure, to the last bits.
    #[must_use]
    pub fn new(left: GasState, right: GasState, gamma: f64) -> Self {
        let open = 2.0 / (gamma - 1.0) * (left.sound(gamma) + right.sound(gamma));
        if open <= right.u - left.u {
            return ExactRiemann { left, right, gamma, star: None };
        }
        let excess = |p: f64| velocity_change(p, left, gamma) + velocity_change(p, right, gamma) + (right.u - left.u);
        let (mut low, mut high) = (1e-300f64, left.p.max(right.p));
        while excess(high) < 0.0 {
            high *= 4.0;
        }
        for _ in 0..400 {
            let middle = low.sqrt() * high.sqrt();
            if !(middle > low && middle < high) {
                break;
            }
            if excess(middle) > 0.0 { high = middle } else { low = middle }
        }
        let p = high;
        let u = 0.5 * (left.u + right.u) + 0.5 * (velocity_change(p, right, gamma) - velocity_change(p, left, gamma));
        ExactRiemann { left, right, gamma, star: Some((p, u)) }
    }

    /// Speed of the shock that runs to the right, if there is one.
    #[must_use]
    pub fn right_shock(&self) -> Option<f64> {
        let (p, _) = self.star?;
        (p > self.right.p).then(|| self.kinks()[4])
    }

    /// Speeds of the rays on which the solution is not smooth, ascending: head and tail of the left wave, contact, tail and head of the
    /// right wave. Head and tail of a shock are one; without a contact its place is the left edge of the vacuum.
    #[must_use]
    pub fn kinks(&self) -> [f64; 5] {
        let mirrored = self.star.map(|(p, u)| (p, -u));
        let left = ends_of_wave(self.left, self.star, self.gamma);
        let right = ends_of_wave(self.right.mirrored(), mirrored, self.gamma).map(|speed| -speed);
        [left[0], left[1], self.star.map_or(left[1], |(_, u)| u), right[1], right[0]]
    }

    /// The state on the ray x/t = `ray`.
    #[must_use]
    pub fn at(&self, ray: f64) -> GasState {
        match self.star {
            Some((p, u)) if ray <= u => one_side(self.left, ray, Some((p, u)), self.gamma),
            Some((p, u)) => one_side(self.right.mirrored(), -ray, Some((p, -u)), self.gamma).mirrored(),
            None => match one_side(self.left, ray, None, self.gamma) {
                left if left.rho > 0.0 => left,
                _ => one_side(self.right.mirrored(), -ray, None, self.gamma).mirrored(),
            },
        }
    }

    /// Density over an interval at time `t`: the mean of 16 points.
    #[must_use]
    pub fn mean_density(&self, from: f64, to: f64, t: f64) -> f64 {
        (0..16).map(|i| self.at((from + (to - from) * (f64::from(i) + 0.5) / 16.0) / t).rho).sum::<f64>() / 16.0
    }
}

/// Behind the wave of the side whose wave runs to the left, Toro sec. 4.5.
fn behind(s: GasState, (p, u): (f64, f64), g: f64) -> GasState {
    let (q, m) = (p / s.p, (g - 1.0) / (g + 1.0));
    let rho = s.rho * if p > s.p { (q + m) / (q * m + 1.0) } else { q.powf(1.0 / g) };
    GasState { rho, u, p }
}

/// Speeds of the head and of the tail of a wave that runs to the left.
fn ends_of_wave(s: GasState, star: Option<(f64, f64)>, g: f64) -> [f64; 2] {
    let a = s.sound(g);
    match star {
        None => [s.u - a, s.u + 2.0 * a / (g - 1.0)],
        Some((p, _)) if p > s.p => [s.u - a * ((g + 1.0) / (2.0 * g) * p / s.p + (g - 1.0) / (2.0 * g)).sqrt(); 2],
        Some(star) => [s.u - a, star.1 - behind(s, star, g).sound(g)],
    }
}

/// The state on a ray of the side whose wave runs to the left, Toro sec. 4.5.
fn one_side(s: GasState, ray: f64, star: Option<(f64, f64)>, g: f64) -> GasState {
    let [head, tail] = ends_of_wave(s, star, g);
    if ray < head {
        return s;
    }
    if ray >= tail {
        return star.map_or(GasState { rho: 0.0, u: 0.0, p: 0.0 }, |star| behind(s, star, g));
    }
    let a = s.sound(g);
    let c = 2.0 / (g + 1.0) + (g - 1.0) / ((g + 1.0) * a) * (s.u - ray);
    GasState {
        rho: s.rho * c.powf(2.0 / (g - 1.0)),
        u: 2.0 / (g + 1.0) * (a + (g - 1.0) / 2.0 * s.u + ray),
        p: s.p * c.powf(2.0 * g / (g - 1.0)),
    }
}
