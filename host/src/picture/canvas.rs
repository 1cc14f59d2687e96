//! A picture in memory: rectangles, lines, text. Pixels count from the upper left corner, y down.

use std::io::{self, Write};
use std::path::Path;

use super::font;
use crate::error::Result;
use crate::files::atomically;

/// Red, green, blue.
pub type Colour = [u8; 3];

/// Text and frames.
pub const INK: Colour = [34, 38, 46];
/// Secondary text.
pub const GREY: Colour = [108, 114, 124];
/// Paper.
pub const WHITE: Colour = [255, 255, 255];

/// Width of a pen stroke in units of the font (capitals are 10 high).
const PEN: f64 = 1.25;

/// How a text is set: where the given point lies in it, how large, and which way.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    /// Height of a capital in pixels.
    pub height: f64,
    /// Its colour.
    pub colour: Colour,
    /// 0 the point is at the text's left end, 0.5 in the middle, 1 at its right end.
    pub along: f64,
    /// 0 the point is on the baseline, 0.5 at half the height of a capital, 1 at its top.
    pub up: f64,
    /// Reads upwards instead of to the right.
    pub turned: bool,
}

impl Default for Style {
    fn default() -> Self {
        Style { height: 11.0, colour: INK, along: 0.0, up: 0.0, turned: false }
    }
}

/// Width of a text in pixels.
#[must_use]
pub fn text_width(text: &str, height: f64) -> f64 {
    (font::width(text) + PEN) * height / 10.0
}

/// The picture.
#[derive(Clone, Debug)]
pub struct Canvas {
    width: usize,
    height: usize,
    pixels: Vec<Colour>,
}

impl Canvas {
    /// A white sheet; at least one pixel.
    #[must_use]
    pub fn new(width: usize, height: usize) -> Self {
        let (width, height) = (width.max(1), height.max(1));
        Canvas { width, height, pixels: vec![WHITE; width * height] }
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> (usize, usize) {
        (self.width, self.height)
    }

    /// The colour of a pixel; white outside.
    #[must_use]
    pub fn get(&self, x: usize, y: usize) -> Colour {
        if x < self.width && y < self.height { self.pixels[y * self.width + x] } else { WHITE }
    }

    /// Paints a pixel; nothing outside.
    pub fn set(&mut self, x: usize, y: usize, colour: Colour) {
        if x < self.width && y < self.height {
            self.pixels[y * self.width + x] = colour;
        }
    }

    /// Mixes a colour into a pixel: 0 leaves it, 1 replaces it.
    pub fn blend(&mut self, x: usize, y: usize, colour: Colour, share: f64) {
        let old = self.get(x, y);
        let mix = |c: usize| (f64::from(old[c]) + (f64::from(colour[c]) - f64::from(old[c])) * share).round() as u8;
        self.set(x, y, [mix(0), mix(1), mix(2)]);
    }

    /// Fills the pixels `x..x+width`, `y..y+height`.
    pub fn rect(&mut self, x: usize, y: usize, width: usize, height: usize, colour: Colour) {
        for row in y..y + height {
            for column in x..x + width {
                self.set(column, row, colour);
            }
        }
    }

    /// The one-pixel outline just around `x..x+width`, `y..y+height`.
    pub fn frame(&mut self, x: usize, y: usize, width: usize, height: usize, colour: Colour) {
        let (left, top) = (x.saturating_sub(1), y.saturating_sub(1));
        self.rect(left, top, width + 2, 1, colour);
        self.rect(left, y + height, width + 2, 1, colour);
        self.rect(left, top, 1, height + 2, colour);
        self.rect(x + width, top, 1, height + 2, colour);
    }

    /// A smooth line with round ends.
    pub fn line(&mut self, from: [f64; 2], to: [f64; 2], width: f64, colour: Colour) {
        self.strokes(&[[from, to]], width, colour);
    }

    /// Writes a text.
    pub fn text(&mut self, x: f64, y: f64, text: &str, style: Style) {
        let scale = style.height / 10.0;
        let back = font::width(text) * style.along;
        let place = |p: [f64; 2]| {
            let (along, up) = ((p[0] - back) * scale, (p[1] - 10.0 * style.up) * scale);
            if style.turned { [x - up, y - along] } else { [x + along, y - up] }
        };
        let strokes: Vec<_> = font::strokes(text).iter().map(|s| s.map(place)).collect();
        self.strokes(&strokes, PEN * scale, style.colour);
    }

    /// Strokes of one colour. Each pixel takes the share of the nearest one, so that crossings are not darker.
    fn strokes(&mut self, strokes: &[font::Stroke], width: f64, colour: Colour) {
        let reach = width / 2.0 + 0.5;
        let mut covered: Vec<(usize, usize, f64)> = vec![];
        for stroke in strokes {
            let range = |axis: usize, size: usize| {
                let (a, b) = (stroke[0][axis], stroke[1][axis]);
                let inside = |v: f64| v.clamp(0.0, size as f64) as usize; // NaN becomes 0
                inside((a.min(b) - reach).floor())..inside((a.max(b) + reach).ceil())
            };
            for y in range(1, self.height) {
                for x in range(0, self.width) {
                    let share = reach - distance([x as f64 + 0.5, y as f64 + 0.5], *stroke);
                    if share > 0.0 {
                        covered.push((y, x, share.min(1.0)));
                    }
                }
            }
        }
        covered.sort_by(|a, b| (a.0, a.1).cmp(&(b.0, b.1)).then(b.2.total_cmp(&a.2)));
        covered.dedup_by_key(|c| (c.0, c.1)); // keeps the first, the largest share
        for (y, x, share) in covered {
            self.blend(x, y, colour, share);
        }
    }

    /// Writes a PNG file.
    ///
    /// # Errors
    /// As [`atomically`].
    pub fn write(&self, path: &Path) -> Result<()> {
        atomically(path, |out| self.encode(out))
    }

    /// The bytes of [`Canvas::write`], to any writer.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn encode(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut encoder = ::png::Encoder::new(out, self.width as u32, self.height as u32);
        encoder.set_color(::png::ColorType::Rgb);
        encoder.set_depth(::png::BitDepth::Eight);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(self.pixels.as_flattened())?;
        writer.finish()?;
        Ok(())
    }
}

/// From a point to a stroke.
fn distance(p: [f64; 2], [a, b]: font::Stroke) -> f64 {
    let (ab, ap) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let length_sq = ab[0] * ab[0] + ab[1] * ab[1];
    let along = ap[0] * ab[0] + ap[1] * ab[1];
    let t = if length_sq > 0.0 { (along / length_sq).clamp(0.0, 1.0) } else { 0.0 };
    (ap[0] - t * ab[0]).hypot(ap[1] - t * ab[1])
}
