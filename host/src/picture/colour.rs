//! Colour maps that the eye reads evenly: equal steps of the value are equal steps of lightness.
//!
//! The colours are computed, not copied: a few anchors in Oklab (lightness, green–red, blue–yellow), lightness linear
//! in the value, hue by a smooth curve through the anchors, then Oklab to sRGB with the matrices of
//! B. Ottosson, *A perceptual color space for image processing*, 2020, <https://bottosson.github.io/posts/oklab/>.
//! Lightness alone carries the value, so the maps also work in grey and for colour-blind readers.

use super::canvas::Colour;

/// No number: missing or not finite.
pub const NO_VALUE: Colour = [186, 160, 172];

/// A colour map over 0..=1, as a table.
#[derive(Clone, Debug)]
pub struct ColourMap {
    table: Vec<Colour>,
    /// The lowest and the highest value have a colour of their own, set off from those between.
    own_ends: [bool; 2],
}

const STEPS: usize = 256;

/// The step of the even map that just under 1 has where 1 itself has the last.
const LIGHTEST: usize = 222;

/// Means over a pixel miss 1 by no more, and what rounding of coordinates leaves of a solid in a cell that it should only touch takes no more.
const ROUNDING: f64 = 1e-6;

/// Less than this share of the largest is none: what the rounding of coordinates leaves of a surface that touches a plane of the grid.
const NONE: f64 = 3e-7;

impl ColourMap {
    /// Dark blue over teal and green to a light paper: blocked (0) to open (1). For any quantity that grows from zero.
    #[must_use]
    pub fn sequential() -> Self {
        Self::through(&[
            [0.235, 0.012, -0.080],
            [0.42, -0.035, -0.100],
            [0.605, -0.085, -0.025],
            [0.79, -0.070, 0.085],
            [0.975, -0.006, 0.020],
        ])
    }

    /// As [`ColourMap::sequential`], for open fractions: what is open to the last has the lightest colour, and what is not is told from it,
    /// be it open to 0.999.
    #[must_use]
    pub fn open_fraction() -> Self {
        let ColourMap { table: even, .. } = Self::sequential();
        // The colours just below the lightest are left out.
        let mut table: Vec<Colour> = (0..STEPS).map(|step| even[step * LIGHTEST / (STEPS - 1)]).collect();
        table.push(even[STEPS - 1]);
        ColourMap { table, own_ends: [false, true] }
    }

    /// From light paper, for none, to dark blue, with a step between none and the least: for quantities that are zero in most cells.
    #[must_use]
    pub fn density() -> Self {
        let ColourMap { table: even, .. } = Self::sequential();
        let falling = (0..STEPS - 1).rev().map(|step| even[step * LIGHTEST / (STEPS - 2)]);
        ColourMap { table: [even[STEPS - 1]].into_iter().chain(falling).collect(), own_ends: [true, false] }
    }

    /// Blue over white to red-brown: for quantities with a sign, and a range symmetric about zero.
    #[must_use]
    pub fn diverging() -> Self {
        Self::through(&[
            [0.36, -0.020, -0.125],
            [0.66, -0.040, -0.085],
            [0.96, 0.0, 0.005],
            [0.66, 0.100, 0.060],
            [0.36, 0.110, 0.055],
        ])
    }

    /// The colour of a value in 0..=1; the end colours beyond, [`NO_VALUE`] for NaN.
    #[must_use]
    pub fn colour(&self, value: f64) -> Colour {
        if value.is_nan() {
            return NO_VALUE;
        }
        if value >= 1.0 - ROUNDING {
            return self.table[self.table.len() - 1];
        }
        let step = (value * (STEPS - 1) as f64).round().clamp(0.0, (STEPS - 1) as f64);
        // What is not none is told from it, be it little.
        self.table[(step as usize).max(usize::from(self.own_ends[0] && value > NONE))]
    }

    /// Whether the lowest and the highest value have a colour of their own, set off from those between.
    #[must_use]
    pub fn own_ends(&self) -> [bool; 2] {
        self.own_ends
    }

    /// The colours between the ends that have one of their own: from just above the lowest value, at a share of 0, to just below the highest, at 1.
    #[must_use]
    pub fn between(&self, share: f64) -> Colour {
        let [first, past] = [usize::from(self.own_ends[0]), self.table.len() - usize::from(self.own_ends[1])];
        let step = (share.clamp(0.0, 1.0) * (past - 1 - first) as f64).round() as usize; // NaN becomes 0
        self.table[first + step]
    }

    fn through(anchors: &[[f64; 3]]) -> Self {
        let table = (0..STEPS).map(|step| srgb(on_curve(anchors, step as f64 / (STEPS - 1) as f64))).collect();
        ColourMap { table, own_ends: [false; 2] }
    }
}

/// A point of the Catmull-Rom curve through evenly spaced anchors; lightness stays linear between them.
fn on_curve(anchors: &[[f64; 3]], t: f64) -> [f64; 3] {
    let last = anchors.len() - 1;
    let s = t * last as f64;
    let i = (s as usize).min(last - 1);
    let u = s - i as f64;
    let (p0, p1, p2, p3) = (anchors[i.saturating_sub(1)], anchors[i], anchors[i + 1], anchors[(i + 2).min(last)]);
    std::array::from_fn(|c| match c {
        0 => p1[0] + u * (p2[0] - p1[0]),
        _ => {
            let (m1, m2) = ((p2[c] - p0[c]) / 2.0, (p3[c] - p1[c]) / 2.0);
            let d = p2[c] - p1[c];
            p1[c] + u * (m1 + u * (3.0 * d - 2.0 * m1 - m2 + u * (m1 + m2 - 2.0 * d)))
        }
    })
}

/// Oklab to sRGB; what the screen cannot show is clipped.
fn srgb([l, a, b]: [f64; 3]) -> Colour {
    let cube = |v: f64| v * v * v;
    let l_ = cube(l + 0.396_337_777_4 * a + 0.215_803_757_3 * b);
    let m_ = cube(l - 0.105_561_345_8 * a - 0.063_854_172_8 * b);
    let s_ = cube(l - 0.089_484_177_5 * a - 1.291_485_548_0 * b);
    [
        4.076_741_662_1 * l_ - 3.307_711_591_3 * m_ + 0.230_969_929_2 * s_,
        -1.268_438_004_6 * l_ + 2.609_757_401_1 * m_ - 0.341_319_396_5 * s_,
        -0.004_196_086_3 * l_ - 0.703_418_614_7 * m_ + 1.707_614_701_0 * s_,
    ]
    .map(|linear| {
        let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
        (encoded * 255.0).round() as u8 // saturates
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// CIE lightness of an sRGB colour, 0..=100.
    fn lightness(colour: Colour) -> f64 {
        let linear = colour
            .map(|c| f64::from(c) / 255.0)
            .map(|c| if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) });
        let y = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
        116.0 * y.cbrt() - 16.0
    }

    #[test]
    fn white_black_and_red_convert() {
        assert_eq!(srgb([1.0, 0.0, 0.0]), [255, 255, 255]);
        assert_eq!(srgb([0.0, 0.0, 0.0]), [0, 0, 0]);
        assert_eq!(srgb([0.627_955, 0.224_863, 0.125_846]), [255, 0, 0]); // values of the cited page
    }

    #[test]
    fn lightness_grows_evenly() {
        let map = ColourMap::sequential();
        let at: Vec<f64> = (0..=16).map(|i| lightness(map.colour(f64::from(i) / 16.0))).collect();
        let mean = (at[16] - at[0]) / 16.0;
        assert!(mean > 5.0, "from {} to {}", at[0], at[16]);
        for step in at.windows(2) {
            assert!((step[1] - step[0] - mean).abs() < 0.3 * mean, "{at:?}");
        }
    }

    /// A cell that is open but for a pipe or a cable does not look like an open one.
    #[test]
    fn nearly_open_is_told_from_open() {
        let map = ColourMap::open_fraction();
        assert_eq!(map.colour(1.0), ColourMap::sequential().colour(1.0));
        for value in [0.95, 0.99, 0.999, 0.999_99] {
            assert!(
                lightness(map.colour(1.0)) - lightness(map.colour(value)) > 8.0,
                "{value}: {:?}",
                map.colour(value)
            );
        }
        let at: Vec<f64> = (0..16).map(|i| lightness(map.colour(f64::from(i) / 16.0))).collect();
        assert!(at.windows(2).all(|w| w[1] - w[0] > 3.0), "{at:?}");
    }

    #[test]
    fn little_is_told_from_none_but_for_rounding() {
        let map = ColourMap::density();
        assert_eq!(map.colour(1e-7), map.colour(0.0));
        assert!(lightness(map.colour(0.0)) - lightness(map.colour(1e-5)) > 8.0);
    }

    #[test]
    fn diverging_is_lightest_in_the_middle_and_even_at_the_ends() {
        let map = ColourMap::diverging();
        let [low, middle, high] = [0.0, 0.5, 1.0].map(|v| lightness(map.colour(v)));
        assert!(middle > 90.0 && (low - high).abs() < 6.0, "{low} {middle} {high}");
    }

    #[test]
    fn beyond_the_ends_and_nan() {
        let map = ColourMap::sequential();
        assert_eq!(map.colour(-3.0), map.colour(0.0));
        assert_eq!(map.colour(f64::INFINITY), map.colour(1.0));
        assert_eq!(map.colour(f64::NAN), NO_VALUE);
    }
}
