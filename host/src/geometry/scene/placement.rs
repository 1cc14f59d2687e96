//! Where the copies of a solid are: turned about its own centre, moved, repeated.

use super::table::{self, StrictTable};
use crate::error::Result;
use crate::geometry::facets::sin_cos_of_degrees;
use glam::{DMat3, DVec3};
use toml::de::DeValue;

/// Most copies in a scene: more than any plant has pipes.
pub const MOST_COPIES: usize = 1_000_000;

/// The placement of a solid and its copies.
#[derive(Debug, Clone, PartialEq)]
pub struct Placement {
    /// Rotation about the solid's own centre, if any.
    pub turn: Option<DMat3>,
    /// The angle of that, in degrees.
    pub angle: f64,
    /// Then it is moved by this.
    pub translate: DVec3,
    /// Copies along x, y and z.
    pub count: [usize; 3],
    /// From a copy to the next along x, y and z.
    pub step: DVec3,
}

/// A rigid motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Rotation and the point that it leaves in place.
    pub turn: Option<(DMat3, DVec3)>,
    /// Then moved by this.
    pub offset: DVec3,
}

impl Motion {
    /// The rotation alone.
    #[must_use]
    pub fn matrix(&self) -> DMat3 {
        self.turn.map_or(DMat3::IDENTITY, |(matrix, _)| matrix)
    }

    /// Where a point goes.
    #[must_use]
    pub fn apply(&self, p: DVec3) -> DVec3 {
        match self.turn {
            None => p + self.offset,
            Some((matrix, about)) => matrix * (p - about) + about + self.offset,
        }
    }

    /// A box around what a box becomes.
    #[must_use]
    pub fn box_around(&self, [lo, hi]: [DVec3; 2]) -> [DVec3; 2] {
        let corner = |n: usize| {
            let from = |axis: usize| if n >> axis & 1 == 0 { lo[axis] } else { hi[axis] };
            self.apply(DVec3::new(from(0), from(1), from(2)))
        };
        let all = (0..8).map(corner);
        all.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[a, b], p| [a.min(p), b.max(p)])
    }
}

impl Placement {
    /// Read `rotate`, `translate` and `array`.
    ///
    /// # Errors
    /// A key of the wrong kind, an axis without direction, more copies than can be.
    pub fn read(keys: &mut StrictTable) -> Result<Self> {
        let rotation = keys.table("rotate")?.map(|mut k| rotation(&mut k)).transpose()?;
        let (turn, angle) = (rotation.map(|(turn, _)| turn), rotation.map_or(0.0, |(_, angle)| angle));
        let translate = keys.get("translate", table::point)?.unwrap_or(DVec3::ZERO);
        let (count, step) =
            keys.table("array")?.map(|mut k| array(&mut k)).transpose()?.unwrap_or(([1; 3], DVec3::ZERO));
        Ok(Placement { turn, angle, translate, count, step })
    }

    /// Number of copies, the first included.
    #[must_use]
    pub fn copies(&self) -> usize {
        self.count.iter().product()
    }

    /// The first axis along which copies lie upon each other.
    #[must_use]
    pub fn stands_still(&self) -> Option<usize> {
        (0..3).find(|&axis| self.count[axis] > 1 && self.step[axis] == 0.0)
    }

    /// The motion of every copy, x fastest, and its place in the array. A copy is where the solid would be if its `translate` were
    /// `translate + index · step`.
    pub fn motions(&self, centre: DVec3) -> impl Iterator<Item = ([usize; 3], Motion)> {
        let [nx, ny, nz] = self.count;
        let turn = self.turn.map(|matrix| (matrix, centre));
        (0..nx * ny * nz).map(move |n| {
            let at = [n % nx, n / nx % ny, n / (nx * ny)];
            let index = DVec3::from_array(at.map(|i| i as f64));
            (at, Motion { turn, offset: self.translate + index * self.step })
        })
    }
}

/// A rotation, and its angle in degrees.
fn rotation(keys: &mut StrictTable) -> Result<(DMat3, f64)> {
    let axis = keys.need("axis", axis)?;
    let angle = keys.need("angle", table::number)?;
    keys.finish()?;
    let largest = axis.abs().max_element();
    if !(largest > 0.0) {
        return Err(keys.wrong("axis", "has no direction"));
    }
    Ok((matrix((axis / largest).normalize(), angle), angle))
}

/// Three numbers, or the name of a coordinate axis.
pub(super) fn axis(value: &DeValue) -> std::result::Result<DVec3, String> {
    match value.as_str() {
        Some("x") => Ok(DVec3::X),
        Some("y") => Ok(DVec3::Y),
        Some("z") => Ok(DVec3::Z),
        Some(other) => {
            let turned = match other {
                "-x" => "; that is [-1, 0, 0]",
                "-y" => "; that is [0, -1, 0]",
                "-z" => "; that is [0, 0, -1]",
                _ => "",
            };
            Err(format!("needs three numbers or x, y, z, not \"{other}\"{turned}"))
        }
        None => table::point(value),
    }
}

fn array(keys: &mut StrictTable) -> Result<([usize; 3], DVec3)> {
    keys.takes_only(&["count", "step"])?;
    let count = keys.need("count", table::three(table::count))?;
    let step = keys.need("step", table::point)?;
    keys.finish()?;
    let total = count.iter().try_fold(1_usize, |product, &n| product.checked_mul(n));
    if total.is_none_or(|n| n > MOST_COPIES) {
        let [nx, ny, nz] = count;
        return Err(keys.wrong("count", format!("makes {nx} × {ny} × {nz} copies; the most are {MOST_COPIES}")));
    }
    Ok((count, step))
}

/// The rotation by `degrees` about a unit vector, counter-clockwise seen from its tip. Quarter turns about coordinate axes are exact.
fn matrix(axis: DVec3, degrees: f64) -> DMat3 {
    let (sin, cos) = sin_cos_of_degrees(degrees);
    // Rodrigues: R = cos I + (1 − cos) a aᵀ + sin [a]×
    let outer = |column: f64| axis * column * (1.0 - cos);
    let cross = |unit: DVec3| axis.cross(unit) * sin + unit * cos;
    DMat3::from_cols(outer(axis.x) + cross(DVec3::X), outer(axis.y) + cross(DVec3::Y), outer(axis.z) + cross(DVec3::Z))
}
