//! A small seeded generator, so that a failing case can be repeated from the number it prints.

/// SplitMix64: G. Steele, D. Lea, C. Flood, *Fast splittable pseudorandom number generators*, OOPSLA 2014.
#[derive(Debug, Clone)]
pub struct Rng(pub u64);

impl Rng {
    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// A number from `lo` to below `hi`.
    pub fn range(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * ((self.bits() >> 11) as f64 / (1_u64 << 53) as f64)
    }

    /// An integer from 0 to below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    /// A point of the box.
    pub fn point(&mut self, lo: glam::DVec3, hi: glam::DVec3) -> glam::DVec3 {
        glam::DVec3::new(self.range(lo.x, hi.x), self.range(lo.y, hi.y), self.range(lo.z, hi.z))
    }

    /// A rotation: about a random axis by a random angle.
    pub fn turn(&mut self) -> glam::DMat3 {
        let axis = loop {
            let p = self.point(glam::DVec3::NEG_ONE, glam::DVec3::ONE);
            if p.length_squared() > 0.01 && p.length_squared() <= 1.0 {
                break p.normalize();
            }
        };
        glam::DMat3::from_axis_angle(axis, self.range(0.0, std::f64::consts::TAU))
    }
}
