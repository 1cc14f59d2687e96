//! One picture of a plane field: cells to scale, ticks with numbers, axis names, a title.

use super::canvas::{Canvas, Colour, GREY, INK, Style, WHITE, text_width};
use super::colour::ColourMap;
use super::ticks::{Ticks, end_ticks, ticks};

/// Height of the numbers at the ticks, in pixels.
pub const SMALL: f64 = 9.5;
/// Height of axis names and panel titles.
pub const NORMAL: f64 = 10.5;
/// Pixels above a panel, for its title.
pub const ABOVE: usize = 34;
/// Pixels below a panel, for numbers and the axis name.
pub const BELOW: usize = 52;

/// Length of a tick, and its distance from the number.
const TICK: usize = 5;
const TICK_GAP: f64 = 5.0;
/// Pixels between numbers side by side, at least.
const NUMBER_GAP: f64 = 16.0;
/// Pixels from one number to the next above it, at least.
const LEAST_APART: f64 = 2.0 * SMALL;
/// Cells at least this many pixels wide and high are outlined.
const OUTLINED: f64 = 11.0;
/// Pixels between lines of hatching.
const HATCH: usize = 6;
/// Solid fraction from which a cell is hatched, and open fraction: what is so little open is no part of the solid drawn without hatching.
const LEAST_HATCHED: f64 = 5e-4;
const LEAST_OPEN: f64 = 1e-9;
/// Share of ink in the outlines.
const OUTLINE: f64 = 0.13;

/// A direction of the picture.
#[derive(Clone, Copy, Debug)]
pub struct EdgeAxis<'a> {
    /// Its name.
    pub name: &'a str,
    /// Unit of its numbers; may be empty.
    pub unit: &'a str,
    /// Cell edges, ascending, at least two.
    pub edges: &'a [f64],
}

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Area {
    /// Left column.
    pub x: usize,
    /// Top row.
    pub y: usize,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

/// A field over two axes.
pub struct Heatmap<'a> {
    /// To the right.
    pub across: EdgeAxis<'a>,
    /// Upwards.
    pub up: EdgeAxis<'a>,
    /// The value of a cell, by its index across and up.
    pub value: &'a dyn Fn(usize, usize) -> f64,
    /// Values of the first and the last colour.
    pub range: [f64; 2],
    /// The colours.
    pub map: &'a ColourMap,
    /// Written above.
    pub title: &'a str,
}

impl EdgeAxis<'_> {
    /// First and last edge; zeros for an empty axis.
    #[must_use]
    pub fn ends(&self) -> [f64; 2] {
        [self.edges.first().copied().unwrap_or(0.0), self.edges.last().copied().unwrap_or(0.0)]
    }

    /// Pixels left of a panel whose vertical axis this is.
    #[must_use]
    pub fn room_left(&self, height: usize) -> usize {
        let widest = upright_ticks(self, height).labels.iter().map(|l| text_width(l, SMALL)).fold(0.0, f64::max);
        (widest + TICK as f64 + TICK_GAP + 30.0).ceil() as usize
    }

    fn label(&self, power: i32) -> String {
        let factor = if power == 0 { String::new() } else { format!("1e{power} ").replace('-', "−") };
        match format!("{factor}{}", self.unit).trim() {
            "" => self.name.to_owned(),
            unit => format!("{} [{unit}]", self.name),
        }
    }

    /// The pixel, counted from the low end, of a coordinate.
    fn pixel(&self, v: f64, pixels: usize) -> f64 {
        let [low, high] = self.ends();
        (v - low) / (high - low) * pixels as f64
    }
}

impl Heatmap<'_> {
    /// Draws the cells into `area` and everything else around it.
    pub fn draw(&self, canvas: &mut Canvas, area: Area) {
        self.cells(canvas, area);
        self.outlines(canvas, area);
        canvas.frame(area.x, area.y, area.width, area.height, INK);
        self.ticks_across(canvas, area);
        self.ticks_up(canvas, area);
        let style = Style { height: NORMAL, up: 0.0, ..Style::default() };
        canvas.text(area.x as f64, area.y as f64 - 14.0, self.title, style);
    }

    /// Each pixel is the mean over its part of the plane, so that cells smaller than a pixel count, too.
    fn cells(&self, canvas: &mut Canvas, area: Area) {
        let columns = shares(self.across.edges, area.width);
        let rows = shares(self.up.edges, area.height);
        let [low, high] = self.range;
        for (y, row) in rows.iter().rev().enumerate() {
            for (x, column) in columns.iter().enumerate() {
                let mean = mean(row, column, self.value);
                canvas.set(area.x + x, area.y + y, self.map.colour((mean - low) / (high - low)));
            }
        }
    }

    /// Draws lines over cells that are partly solid, the stronger, the more of them is; whole solid is left as it is. Each is a line of ink with a white one
    /// beside it: one of both is seen on any colour.
    pub fn hatch(&self, canvas: &mut Canvas, area: Area, blocked: &dyn Fn(usize, usize) -> f64) {
        let columns = shares(self.across.edges, area.width);
        let rows = shares(self.up.edges, area.height);
        for (y, row) in rows.iter().rev().enumerate() {
            for (x, column) in columns.iter().enumerate().filter(|(x, _)| (x + y) % HATCH < 2) {
                let share = mean(row, column, blocked);
                if (LEAST_HATCHED..1.0 - LEAST_OPEN).contains(&share) {
                    let colour = if (x + y).is_multiple_of(HATCH) { INK } else { WHITE };
                    canvas.blend(area.x + x, area.y + y, colour, 0.3 + 0.5 * share);
                }
            }
        }
    }

    fn outlines(&self, canvas: &mut Canvas, area: Area) {
        let wide = |axis: &EdgeAxis, pixels: usize| {
            pixels as f64 / axis.edges.len().saturating_sub(1).max(1) as f64 >= OUTLINED
        };
        if !wide(&self.across, area.width) || !wide(&self.up, area.height) {
            return;
        }
        for v in inner(self.across.edges) {
            let x = area.x + self.across.pixel(*v, area.width) as usize;
            (area.y..area.y + area.height).for_each(|y| canvas.blend(x, y, INK, OUTLINE));
        }
        for v in inner(self.up.edges) {
            let y = area.y + area.height - 1 - (self.up.pixel(*v, area.height) as usize).min(area.height - 1);
            (area.x..area.x + area.width).for_each(|x| canvas.blend(x, y, INK, OUTLINE));
        }
    }

    fn ticks_across(&self, canvas: &mut Canvas, area: Area) {
        let marks = level_ticks(&self.across, area.width);
        let bottom = area.y + area.height;
        let style = Style { height: SMALL, along: 0.5, up: 1.0, ..Style::default() };
        for (v, label) in marks.at.iter().zip(&marks.labels) {
            let x = area.x + nearest(self.across.pixel(*v, area.width), area.width);
            canvas.rect(x, bottom, 1, TICK, INK);
            canvas.text(x as f64 + 0.5, (bottom + TICK) as f64 + TICK_GAP, label, style);
        }
        let middle = area.x as f64 + area.width as f64 / 2.0;
        let style = Style { height: NORMAL, colour: GREY, ..style };
        canvas.text(middle, (bottom + TICK) as f64 + TICK_GAP + SMALL + 9.0, &self.across.label(marks.power), style);
    }

    fn ticks_up(&self, canvas: &mut Canvas, area: Area) {
        let marks = upright_ticks(&self.up, area.height);
        let style = Style { height: SMALL, along: 1.0, up: 0.5, ..Style::default() };
        for (v, label) in marks.at.iter().zip(&marks.labels) {
            let y = area.y + area.height - 1 - nearest(self.up.pixel(*v, area.height), area.height);
            let x = area.x.saturating_sub(TICK + 1);
            canvas.rect(x, y, TICK, 1, INK);
            canvas.text(x as f64 - TICK_GAP, y as f64 + 0.5, label, style);
        }
        let x = area.x.saturating_sub(self.up.room_left(area.height)) as f64 + 4.0 + NORMAL;
        let middle = area.y as f64 + area.height as f64 / 2.0;
        let style = Style { height: NORMAL, colour: GREY, along: 0.5, up: 0.0, turned: true };
        canvas.text(x, middle, &self.up.label(marks.power), style);
    }
}

/// A small triangle that points at a place on the upper (`across`) or right edge of a panel.
pub fn pointer(canvas: &mut Canvas, area: Area, axis: &EdgeAxis, v: f64, across: bool, colour: Colour) {
    if across {
        let x = area.x + nearest(axis.pixel(v, area.width), area.width);
        triangle(canvas, x, area.y.saturating_sub(2), true, colour);
    } else {
        let y = area.y + area.height - 1 - nearest(axis.pixel(v, area.height), area.height);
        triangle(canvas, area.x + area.width + 1, y, false, colour);
    }
}

/// A triangle whose tip, at the given pixel, points down or to the left.
pub fn triangle(canvas: &mut Canvas, x: usize, y: usize, down: bool, colour: Colour) {
    for n in 0..7 {
        let half = n / 2;
        if down {
            canvas.rect(x.saturating_sub(half), y.saturating_sub(n), 2 * half + 1, 1, colour);
        } else {
            canvas.rect(x + n, y.saturating_sub(half), 1, 2 * half + 1, colour);
        }
    }
}

fn inner(edges: &[f64]) -> &[f64] {
    edges.get(1..edges.len().saturating_sub(1)).unwrap_or(&[])
}

fn nearest(pixel: f64, pixels: usize) -> usize {
    (pixel.round() as usize).min(pixels.saturating_sub(1)) // negative and NaN become 0
}

/// As many marks as have room for their numbers.
fn level_ticks(axis: &EdgeAxis, width: usize) -> Ticks {
    let [low, high] = axis.ends();
    for wanted in (1..=(width / 75).max(1)).rev() {
        let marks = ticks(low, high, wanted);
        let widest = marks.labels.iter().map(|l| text_width(l, SMALL)).fold(0.0, f64::max);
        let room = match marks.at[..] {
            [a, b, ..] => axis.pixel(b, width) - axis.pixel(a, width),
            // One number is no scale.
            _ => break,
        };
        if widest + NUMBER_GAP <= room {
            return marks;
        }
    }
    let ends = end_ticks(low, high);
    let widest = ends.labels.iter().map(|l| text_width(l, SMALL)).fold(0.0, f64::max);
    if widest + NUMBER_GAP <= width as f64 { ends } else { ticks(low, high, 1) }
}

fn upright_ticks(axis: &EdgeAxis, height: usize) -> Ticks {
    let [low, high] = axis.ends();
    let round = ticks(low, high, (height / 42).max(1));
    match round.at[..] {
        [_, _, ..] => round,
        _ if height as f64 >= LEAST_APART => end_ticks(low, high),
        _ => round,
    }
}

/// The cells that a pixel covers, each with its share of the pixel.
type Shares = Vec<(usize, f64)>;

/// For each of `pixels` equal parts of the axis.
fn shares(edges: &[f64], pixels: usize) -> Vec<Shares> {
    let [low, .., high] = *edges else { return vec![] };
    let width = (high - low) / pixels as f64;
    let mut cell = 0;
    let mut all = Vec::with_capacity(pixels);
    for pixel in 0..pixels {
        let (start, end) = (low + pixel as f64 * width, low + (pixel + 1) as f64 * width);
        while cell + 2 < edges.len() && edges[cell + 1] <= start {
            cell += 1;
        }
        let mut here = vec![];
        for c in cell..edges.len() - 1 {
            let overlap = edges[c + 1].min(end) - edges[c].max(start);
            // A sliver left by rounding must not tint a pixel.
            if overlap > 1e-6 * width {
                here.push((c, overlap));
            }
            if edges[c + 1] >= end {
                break;
            }
        }
        if here.is_empty() {
            here.push((cell, 1.0)); // coordinates so large that they do not resolve a pixel
        }
        let total: f64 = here.iter().map(|(_, share)| share).sum();
        here.iter_mut().for_each(|(_, share)| *share /= total);
        all.push(here);
    }
    all
}

/// NaN if any part is.
fn mean(row: &Shares, column: &Shares, value: &dyn Fn(usize, usize) -> f64) -> f64 {
    if let ([(b, _)], [(a, _)]) = (&row[..], &column[..]) {
        return value(*a, *b);
    }
    row.iter().map(|(b, v)| v * column.iter().map(|(a, u)| u * value(*a, *b)).sum::<f64>()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_a_pixel_sum_to_one_and_all_cells_appear() {
        for edges in [&[0.0, 1.0][..], &[0.0, 0.1, 0.2, 5.0], &[-2.0, 1.0, 1.5, 1.75, 1.875]] {
            for pixels in [1, 2, 3, 7, 100] {
                let all = shares(edges, pixels);
                assert_eq!(all.len(), pixels);
                assert!(
                    all.iter().all(|p| (p.iter().map(|s| s.1).sum::<f64>() - 1.0).abs() < 1e-12),
                    "{edges:?} {pixels}"
                );
                let cells: std::collections::BTreeSet<_> = all.iter().flatten().map(|s| s.0).collect();
                assert_eq!(cells.len(), edges.len() - 1, "{edges:?} {pixels}");
            }
        }
    }

    /// Hatching shows on dark and on light colours, grows with the solid fraction, and leaves open and solid cells alone.
    #[test]
    fn hatching_shows_on_any_colour() {
        let edges = [0.0, 1.0, 2.0];
        let axis = EdgeAxis { name: "x", unit: "m", edges: &edges };
        let area = Area { x: 0, y: 0, width: 60, height: 60 };
        let map = &ColourMap::sequential();
        for value in [0.0, 0.3, 0.5, 0.7, 1.0] {
            let field = |_: usize, _: usize| value;
            let heatmap = Heatmap { across: axis, up: axis, value: &field, range: [0.0, 1.0], map, title: "" };
            let colour = map.colour(value);
            let changed = |share: f64| {
                let mut canvas = Canvas::new(60, 60);
                canvas.rect(0, 0, 60, 60, colour);
                heatmap.hatch(&mut canvas, area, &|_, _| share);
                let far = |c: Colour| c.iter().zip(colour).map(|(a, b)| u32::from(a.abs_diff(b))).sum::<u32>();
                (0..3600).map(|n| far(canvas.get(n % 60, n / 60))).max().unwrap_or(0)
            };
            assert_eq!([changed(0.0), changed(1.0)], [0, 0]);
            assert!(changed(1.0 - 2e-4) > 60, "a cell that is nearly solid looks open");
            assert!(changed(0.1) > 60 && changed(0.6) > changed(0.1), "{value}: {} {}", changed(0.1), changed(0.6));
        }
    }

    #[test]
    fn a_pixel_over_several_cells_is_their_mean() {
        let all = shares(&[0.0, 1.0, 2.0, 3.0, 4.0], 1);
        assert_eq!(mean(&all[0], &all[0], &|a, b| (a + 10 * b) as f64), 16.5);
        assert!(mean(&all[0], &all[0], &|a, _| if a == 3 { f64::NAN } else { 1.0 }).is_nan());
    }
}
