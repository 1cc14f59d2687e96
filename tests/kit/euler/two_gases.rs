//! The exact solution of a Riemann problem between two ideal gases of different ratios of specific heats.
//!
//! The gas left of the contact is that of the left side, whatever passed it. Written with the pressure behind each wave as the unknown: mass that a shock
//! takes in per area, and the invariant of a simple wave (R. Courant, K. O. Friedrichs, *Supersonic Flow and Shock Waves*, 1948, sec. 67 and 81).

/// A state with its gas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GasSide {
    /// Density.
    pub rho: f64,
    /// Velocity.
    pub u: f64,
    /// Pressure.
    pub p: f64,
    /// Ratio of specific heats.
    pub gamma: f64,
}

impl GasSide {
    /// From its values.
    pub const fn new(rho: f64, u: f64, p: f64, gamma: f64) -> Self {
        GasSide { rho, u, p, gamma }
    }

    fn mirrored(self) -> Self {
        GasSide { u: -self.u, ..self }
    }

    fn sound(self) -> f64 {
        (self.gamma * self.p / self.rho).sqrt()
    }

    /// Mass that the shock to a pressure takes in per area and time.
    fn intake(self, to: f64) -> f64 {
        (0.5 * self.rho * ((self.gamma + 1.0) * to + (self.gamma - 1.0) * self.p)).sqrt()
    }

    /// The state behind the wave into this gas, which stands on the left, that brings it to a pressure.
    fn behind(self, to: f64) -> Self {
        let g = self.gamma;
        if to > self.p {
            let rho = self.rho * ((g + 1.0) * to + (g - 1.0) * self.p) / ((g - 1.0) * to + (g + 1.0) * self.p);
            return GasSide { rho, p: to, u: self.u - (to - self.p) / self.intake(to), ..self };
        }
        let rho = self.rho * (to / self.p).powf(1.0 / g);
        let after = GasSide { rho, p: to, ..self };
        GasSide { u: self.u + 2.0 / (g - 1.0) * (self.sound() - after.sound()), ..after }
    }

    /// The state on a ray x/t on this gas's side of the contact, behind which the pressure is `star`.
    fn on_ray(self, star: f64, ray: f64) -> Self {
        let behind = self.behind(star);
        if star > self.p {
            let shock = self.u - self.intake(star) / self.rho;
            return if ray < shock { self } else { behind };
        }
        if ray < self.u - self.sound() {
            return self;
        }
        if ray > behind.u - behind.sound() {
            return behind;
        }
        // In the fan u − c is the ray, and u + 2c/(γ − 1) what it was.
        let g = self.gamma;
        let sound = (g - 1.0) / (g + 1.0) * (self.u + 2.0 / (g - 1.0) * self.sound() - ray);
        let share = (sound / self.sound()).powf(2.0 / (g - 1.0));
        GasSide { rho: self.rho * share, u: ray + sound, p: self.p * share.powf(g), gamma: g }
    }
}

/// Two gases that meet at x = 0, with the pressure and the velocity between the waves that part there.
#[derive(Clone, Copy, Debug)]
pub struct TwoGases {
    left: GasSide,
    right: GasSide,
    /// Pressure at the contact.
    pub pressure: f64,
    /// Velocity of the contact.
    pub velocity: f64,
}

impl TwoGases {
    /// By bisection in the logarithm of the pressure; the gases do not part so fast that they leave vacuum.
    pub fn new(left: GasSide, right: GasSide) -> Self {
        let approach = |p: f64| left.behind(p).u + right.mirrored().behind(p).u;
        let (mut low, mut high) = (1e-12 * left.p.min(right.p), 1e6 * left.p.max(right.p));
        for _ in 0..400 {
            let middle = (low * high).sqrt();
            if approach(middle) > 0.0 { low = middle } else { high = middle }
        }
        let pressure = (low * high).sqrt();
        let velocity = 0.5 * (left.behind(pressure).u - right.mirrored().behind(pressure).u);
        TwoGases { left, right, pressure, velocity }
    }

    /// The state on a ray x/t.
    pub fn at(&self, ray: f64) -> GasSide {
        if ray < self.velocity {
            self.left.on_ray(self.pressure, ray)
        } else {
            self.right.mirrored().on_ray(self.pressure, -ray).mirrored()
        }
    }

    /// Mean of a quantity over a cell between two places at a time: by many points, exact where the states are constant.
    pub fn mean(&self, of: impl Fn(GasSide) -> f64, [from, to]: [f64; 2], time: f64) -> f64 {
        const POINTS: usize = 32;
        let point = |k: usize| from + (to - from) * (k as f64 + 0.5) / POINTS as f64;
        (0..POINTS).map(|k| of(self.at(point(k) / time))).sum::<f64>() / POINTS as f64
    }
}
