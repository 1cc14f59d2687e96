//! A drawing as SVG: lines, discs, texts. Lengths are those of the pixels of [`super::canvas`], y down.

use super::canvas::{Canvas, Colour, Style};
use std::fmt::Write;

/// What a drawing is put on: pixels, or the text of an SVG.
pub trait Sheet {
    /// A line with round ends.
    fn line(&mut self, from: [f64; 2], to: [f64; 2], width: f64, colour: Colour);
    /// A filled rectangle: its upper left corner, its width and height.
    fn fill(&mut self, corner: [f64; 2], size: [f64; 2], colour: Colour);
    /// A filled circle.
    fn disc(&mut self, centre: [f64; 2], diameter: f64, colour: Colour);
    /// A circle.
    fn ring(&mut self, centre: [f64; 2], diameter: f64, width: f64, colour: Colour);
    /// A text.
    fn write(&mut self, at: [f64; 2], text: &str, style: Style);
}

/// Sides of the polygon that stands for a circle of pixels.
const SIDES: usize = 20;

impl Sheet for Canvas {
    fn line(&mut self, from: [f64; 2], to: [f64; 2], width: f64, colour: Colour) {
        Canvas::line(self, from, to, width, colour);
    }

    fn fill(&mut self, corner: [f64; 2], size: [f64; 2], colour: Colour) {
        let [x, y] = corner.map(|v| v.round().max(0.0) as usize);
        let [width, height] = size.map(|v| v.round().max(0.0) as usize);
        self.rect(x, y, width, height, colour);
    }

    fn disc(&mut self, centre: [f64; 2], diameter: f64, colour: Colour) {
        Canvas::line(self, centre, centre, diameter, colour);
    }

    fn ring(&mut self, centre: [f64; 2], diameter: f64, width: f64, colour: Colour) {
        let corner = |n: usize| {
            let (sin, cos) = (std::f64::consts::TAU * n as f64 / SIDES as f64).sin_cos();
            [centre[0] + 0.5 * diameter * cos, centre[1] + 0.5 * diameter * sin]
        };
        (0..SIDES).for_each(|n| Canvas::line(self, corner(n), corner(n + 1), width, colour));
    }

    fn write(&mut self, at: [f64; 2], text: &str, style: Style) {
        self.text(at[0], at[1], text, style);
    }
}

/// An SVG in the making.
#[derive(Debug, Clone)]
pub struct Svg {
    size: [usize; 2],
    body: String,
}

/// Height of a capital in units of the size of the font: that of Helvetica and the like.
const CAPITAL: f64 = 0.717;

impl Svg {
    /// A white sheet.
    #[must_use]
    pub fn new(width: usize, height: usize) -> Self {
        Svg { size: [width, height], body: String::new() }
    }

    /// The text of the file, which may stand in a page of HTML as well.
    #[must_use]
    pub fn text(&self) -> String {
        let [w, h] = self.size;
        let head =
            format!("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {w} {h}\" width=\"{w}\" height=\"{h}\"");
        let font = "font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\"";
        format!("{head} {font}>\n<rect width=\"{w}\" height=\"{h}\" fill=\"#fff\"/>\n{}</svg>\n", self.body)
    }
}

/// `#rrggbb`.
fn hex([r, g, b]: Colour) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// A length to a tenth of a pixel.
fn short(x: f64) -> String {
    let text = format!("{x:.1}");
    text.strip_suffix(".0").map_or_else(|| text.clone(), str::to_owned)
}

/// A text as XML takes it.
#[must_use]
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

impl Sheet for Svg {
    fn line(&mut self, from: [f64; 2], to: [f64; 2], width: f64, colour: Colour) {
        let [x1, y1, x2, y2] = [from[0], from[1], to[0], to[1]].map(short);
        let (stroke, width) = (hex(colour), short(width));
        let _ = writeln!(
            self.body,
            "<line x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\" stroke=\"{stroke}\" stroke-width=\"{width}\" stroke-linecap=\"round\"/>"
        );
    }

    fn fill(&mut self, corner: [f64; 2], size: [f64; 2], colour: Colour) {
        let ([x, y], [w, h]) = (corner.map(short), size.map(short));
        let fill = hex(colour);
        let _ = writeln!(self.body, "<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" fill=\"{fill}\"/>");
    }

    fn disc(&mut self, centre: [f64; 2], diameter: f64, colour: Colour) {
        let ([x, y], r, fill) = (centre.map(short), short(0.5 * diameter), hex(colour));
        let _ = writeln!(self.body, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\" fill=\"{fill}\"/>");
    }

    fn ring(&mut self, centre: [f64; 2], diameter: f64, width: f64, colour: Colour) {
        let ([x, y], r, stroke) = (centre.map(short), short(0.5 * diameter), hex(colour));
        let width = short(width);
        let _ = writeln!(
            self.body,
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\" fill=\"none\" stroke=\"{stroke}\" stroke-width=\"{width}\"/>"
        );
    }

    fn write(&mut self, at: [f64; 2], text: &str, style: Style) {
        let anchor = match style.along {
            a if a < 0.25 => "start",
            a if a < 0.75 => "middle",
            _ => "end",
        };
        let down = style.up * style.height;
        let place = match style.turned {
            true => format!("transform=\"translate({} {}) rotate(-90)\"", short(at[0] + down), short(at[1])),
            false => format!("x=\"{}\" y=\"{}\"", short(at[0]), short(at[1] + down)),
        };
        let (size, fill) = (short(style.height / CAPITAL), hex(style.colour));
        let _ = writeln!(
            self.body,
            "<text {place} font-size=\"{size}\" text-anchor=\"{anchor}\" fill=\"{fill}\">{}</text>",
            escape(text)
        );
    }
}
