//! Seeded random numbers: the same on every machine.

use glam::{DMat3, DVec3};

/// SplitMix64. Reference: G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom number generators", *OOPSLA* 2014.
#[derive(Debug, Clone)]
pub struct Random(u64);

impl Random {
    /// From a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Random(seed)
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// An integer below `n`, which is not 0.
    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    /// A whole number between two, both included.
    pub fn whole(&mut self, lo: i64, hi: i64) -> i64 {
        lo + self.below((hi - lo + 1) as usize) as i64
    }

    /// Uniform between two.
    pub fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * ((self.bits() >> 11) as f64 / (1u64 << 53) as f64)
    }

    /// Between two positive numbers, evenly in the logarithm.
    pub fn scale(&mut self, lo: f64, hi: f64) -> f64 {
        lo * (hi / lo).powf(self.between(0.0, 1.0))
    }

    /// A point of a box.
    pub fn point(&mut self, lo: DVec3, hi: DVec3) -> DVec3 {
        DVec3::new(self.between(lo.x, hi.x), self.between(lo.y, hi.y), self.between(lo.z, hi.z))
    }

    /// A direction, uniform on the sphere.
    pub fn direction(&mut self) -> DVec3 {
        loop {
            let p = self.point(DVec3::NEG_ONE, DVec3::ONE);
            if (1e-3..=1.0).contains(&p.length_squared()) {
                return p.normalize();
            }
        }
    }

    /// A rotation, uniform in axis and angle.
    pub fn turn(&mut self) -> DMat3 {
        let axis = self.direction();
        DMat3::from_axis_angle(axis, self.between(0.0, std::f64::consts::TAU))
    }

    /// An open fraction: often 0, 1 or tiny.
    pub fn fraction(&mut self) -> f64 {
        match self.below(8) {
            0 => 0.0,
            1 | 2 => 1.0,
            3 => self.scale(1e-12, 1.0),
            _ => self.between(0.0, 1.0),
        }
    }
}
