//! Coordinates that were single-precision numbers where they came from.
//!
//! Whoever wrote a file of `f32` rounded each coordinate by up to half a unit in the last place, in the file's own unit and frame. Scaling
//! enlarges that error, rotation mixes those of the three axes, translation leaves it as it is, however small the coordinate becomes.

use glam::{DAffine3, DMat3, DVec3};

/// The way from the coordinates of a single-precision file to those of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SingleSource {
    to_body: DAffine3,
    to_file: DAffine3,
    /// By how much the ways there and back stretch a coordinate at most.
    stretch: [f64; 2],
}

impl SingleSource {
    /// A file whose coordinates are multiplied by `scale`, which is positive.
    #[must_use]
    pub fn scaled(scale: f64) -> Self {
        Self::of(DAffine3::from_scale(DVec3::splat(scale)))
    }

    /// The same, then turned and moved: p becomes `turn` p + `offset`.
    #[must_use]
    pub fn moved(&self, turn: DMat3, offset: DVec3) -> Self {
        Self::of(DAffine3 { matrix3: turn, translation: offset } * self.to_body)
    }

    fn of(to_body: DAffine3) -> Self {
        let (to_file, rows) = (to_body.inverse(), |m: DMat3| (abs(m) * DVec3::ONE).max_element());
        SingleSource { to_body, to_file, stretch: [rows(to_body.matrix3), rows(to_file.matrix3)] }
    }

    /// How far along each axis the point meant may be from `p`, for which the file has the nearest `f32`: half a unit in the last place.
    /// Where the file's digits were rounded once more, as in text, their error is in it.
    #[must_use]
    pub fn error(&self, p: DVec3) -> DVec3 {
        let here = self.to_file.transform_point3(p);
        let written = here.as_vec3();
        let half_ulps = DVec3::from_array(written.to_array().map(|f| 0.5 * ulp(f)));
        abs(self.to_body.matrix3) * (half_ulps + (here - written.as_dvec3()).abs())
    }

    /// At least as large as any component of [`Self::error`], and cheaper.
    #[must_use]
    pub fn reach(&self, p: DVec3) -> f64 {
        let [to_body, to_file] = self.stretch;
        let farthest = to_file * (p - self.to_body.translation).abs().max_element();
        to_body * (farthest * f64::from(f32::EPSILON)).max(f64::from(f32::MIN_POSITIVE))
    }
}

/// Distance from the magnitude of a finite number to the next larger `f32`; of the largest, to the one below.
fn ulp(f: f32) -> f64 {
    let size = f.abs();
    let neighbour = if size < f32::MAX { size.next_up() } else { size.next_down() };
    (f64::from(neighbour) - f64::from(size)).abs()
}

fn abs(m: DMat3) -> DMat3 {
    DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs())
}
