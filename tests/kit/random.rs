//! Seeded random numbers: the same on every machine.

use glam::{DMat3, DVec3};
use voidage_core::number::real::{Real, Vector};

/// SplitMix64. Reference: G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom number generators", *OOPSLA* 2014.
#[derive(Clone, Debug)]
pub struct Random {
    state: u64,
    /// Bytes that decide before the seed does, in reverse order: the next one stands last.
    given: Vec<u8>,
}

impl Random {
    /// From a seed.
    pub fn new(seed: u64) -> Self {
        Random { state: seed, given: Vec::new() }
    }

    /// Each byte decides one integer, so that a fuzzer can change one choice and leave the others; what follows the last byte is from seed 0.
    pub fn from_bytes(bytes: &[u8]) -> Self {
        Random { state: 0, given: bytes.iter().rev().copied().collect() }
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.state ^ (self.state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// An integer below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        let bits = self.given.pop().map_or_else(|| self.bits(), u64::from);
        (bits % n as u64) as usize
    }

    /// Uniform in `[0, 1)`.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// Uniform in `[lo, hi)`.
    pub fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }

    /// Uniform on the unit sphere.
    pub fn on_sphere(&mut self) -> [f64; 3] {
        loop {
            let p = [self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0)];
            let sq: f64 = p.iter().map(|x| x * x).sum();
            if sq > 1e-3 && sq <= 1.0 {
                return p.map(|x| x / sq.sqrt());
            }
        }
    }

    /// A unit quaternion `[x, y, z, w]`, uniform over rotations.
    pub fn rotation(&mut self) -> [f64; 4] {
        let [x, y, z] = self.on_sphere();
        let half = 0.5 * self.between(0.0, std::f64::consts::TAU);
        let (s, c) = half.sin_cos();
        [x * s, y * s, z * s, c]
    }

    /// A vector, uniform in a cube about the origin.
    pub fn vector<V: Vector>(&mut self, half: f64) -> V {
        V::from_array(std::array::from_fn(|_| V::Scalar::from_f64(self.between(-half, half))))
    }

    /// A point of a box.
    pub fn point(&mut self, lo: DVec3, hi: DVec3) -> DVec3 {
        DVec3::new(self.between(lo.x, hi.x), self.between(lo.y, hi.y), self.between(lo.z, hi.z))
    }

    /// A rotation, uniform in axis and angle.
    pub fn turn(&mut self) -> DMat3 {
        let axis = DVec3::from_array(self.on_sphere());
        DMat3::from_axis_angle(axis, self.between(0.0, std::f64::consts::TAU))
    }
}
