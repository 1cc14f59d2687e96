//! Three slices of a cell field in one picture: the plan (x, y) and two elevations (x, z) and (y, z).
//!
//! All panels have the same scale, chosen with the arrangement that uses the sheet best: in a row, in an L (the lower
//! left elevation under the plan, as on an engineering drawing), or in a column for long domains. Only what would be
//! too small to see is enlarged, and an axis drawn out of proportion says so. An axis of one cell has nothing to show:
//! then the one panel across it fills the sheet.

mod layout;

use std::path::Path;

use super::canvas::{Canvas, Colour, GREY, INK, Style, text_width};
use super::colour::ColourMap;
use super::heatmap::{Area, EdgeAxis, Heatmap, NORMAL, SMALL, pointer, triangle};
use super::ticks::{Ticks, number, number_to, ticks};
use crate::error::{Error, Result};
use crate::grid::AXES;
use layout::{BAR, Layout, Panel, TextSizes};

/// Marks where the other slices lie.
const MARK: Colour = [214, 84, 32];
/// Height of the figure's title.
const TITLE: f64 = 14.0;
/// Free border of the sheet.
const BORDER: usize = 18;
/// Pixels for the title and the note.
const HEAD: usize = 64;

/// Pixels of the bar for an end with a colour of its own.
const OWN_END: usize = 18;

/// An end of the bar has a number of its own where no mark is so near, in pixels.
const END_GAP: f64 = 12.0;

/// Explains the pointers.
const LEGEND: &str = "where the other slices are";

/// What the figure shows.
#[derive(Clone, Copy, Debug)]
pub struct Figure<'a> {
    /// First line; cut where it is too long.
    pub title: &'a str,
    /// What follows it on that line, however long it is; may be empty.
    pub moment: &'a str,
    /// Second line, smaller.
    pub note: &'a str,
    /// Cell edges along x, y, z.
    pub edges: [&'a [f64]; 3],
    /// Unit of the edges; may be empty.
    pub unit: &'a str,
    /// One value for each cell, x fastest.
    pub values: &'a [f64],
    /// Index of the cells shown by the slice across x, y and z.
    pub at: [usize; 3],
    /// Written over the colour bar: name and unit of the values.
    pub name: &'a str,
    /// Values at the ends of the colour bar.
    pub range: [f64; 2],
    /// Words beside the ends of the bar; may be empty.
    pub ends: [&'a str; 2],
    /// Which of these are written; there is room for both, so that pictures of one kind have one size.
    pub told: [bool; 2],
    /// The colours.
    pub map: &'a ColourMap,
}

impl Figure<'_> {
    /// Draws and writes a PNG file.
    ///
    /// # Errors
    /// A length that does not fit the grid, a slice outside, edges that do not ascend, or as [`crate::files::atomically`].
    pub fn write(&self, path: &Path) -> Result<()> {
        self.draw().map_err(|reason| Error::file(path, reason))?.write(path)
    }

    /// Draws.
    ///
    /// # Errors
    /// The reason, if a length does not fit the grid, a slice is outside, or edges do not ascend.
    pub fn draw(&self) -> std::result::Result<Canvas, String> {
        Figure { range: usable(self.range), ..*self }.draw_usable(None)
    }

    /// Draws, with hatching where a cell is partly solid: the darker, the more of it; `blocked` is its solid fraction.
    ///
    /// # Errors
    /// As [`Figure::draw`]; or `blocked` does not fit the grid.
    pub fn draw_hatched(&self, blocked: &[f64]) -> std::result::Result<Canvas, String> {
        if blocked.len() != self.values.len() {
            return Err(format!("{} solid fractions do not fit {} values", blocked.len(), self.values.len()));
        }
        Figure { range: usable(self.range), ..*self }.draw_usable(Some(blocked))
    }

    fn draw_usable(&self, blocked: Option<&[f64]>) -> std::result::Result<Canvas, String> {
        let cells = self.check()?;
        let lengths = self.edges.map(|e| e[e.len() - 1] - e[0]);
        let sizes = TextSizes {
            left: &|axis, height| self.axis(axis).room_left(height),
            title: &|panel| text_width(&self.panel_title(panel), NORMAL).ceil() as usize,
            bar: self.bar_room(),
        };
        let layout = Layout::best(lengths, cells, &sizes);
        let note = text_width(self.note, SMALL) + legend_width();
        let title = text_width(&format!("{}{}", self.title, self.moment), TITLE);
        let head = title.max(note).min(layout::WIDTH as f64);
        let (width, height) = layout.size;
        let mut canvas = Canvas::new(width.max(head.ceil() as usize) + 2 * BORDER, HEAD + height + BORDER);
        let pointers = layout.panels.len() > 1;
        self.head(&mut canvas, pointers);
        for panel in &layout.panels {
            self.panel(&mut canvas, panel, pointers, blocked);
        }
        self.bar(&mut canvas, shifted(layout.bar));
        Ok(canvas)
    }

    fn check(&self) -> std::result::Result<[usize; 3], String> {
        for (edges, name) in self.edges.iter().zip(AXES) {
            let ascending = edges.windows(2).all(|w| w[0] < w[1]);
            let finite = edges.len() > 1 && (edges[edges.len() - 1] - edges[0]).is_finite();
            if !(ascending && finite) {
                return Err(format!("the edges along {name} do not ascend"));
            }
        }
        let cells = self.edges.map(|e| e.len() - 1);
        let [nx, ny, nz] = cells;
        if self.values.len() != nx * ny * nz {
            return Err(format!("{} values do not fill {nx} x {ny} x {nz} cells", self.values.len()));
        }
        if self.at.iter().zip(cells).any(|(at, n)| *at >= n) {
            return Err(format!("the slices {:?} are not all within {nx} x {ny} x {nz} cells", self.at));
        }
        Ok(cells)
    }

    fn axis(&self, axis: usize) -> EdgeAxis<'_> {
        EdgeAxis { name: AXES[axis], unit: self.unit, edges: self.edges[axis] }
    }

    /// Centre of the cells that the slice across an axis shows.
    fn position(&self, axis: usize) -> f64 {
        let (edges, at) = (self.edges[axis], self.at[axis]);
        f64::midpoint(edges[at], edges[at + 1])
    }

    /// Width of those cells.
    fn cell_size(&self, axis: usize) -> f64 {
        let (edges, at) = (self.edges[axis], self.at[axis]);
        edges[at + 1] - edges[at]
    }

    fn head(&self, canvas: &mut Canvas, pointers: bool) {
        let room = (canvas.size().0 - 2 * BORDER) as f64;
        let x = BORDER as f64;
        let style = Style { height: TITLE, up: 1.0, ..Style::default() };
        let title = shortened(self.title, TITLE, room - text_width(self.moment, TITLE)) + self.moment;
        canvas.text(x, 16.0, &title, style);
        let style = Style { height: SMALL, up: 1.0, colour: GREY, ..style };
        let legend = if pointers { legend_width() } else { 0.0 };
        let note = shortened(self.note, SMALL, room - legend);
        canvas.text(x, 42.0, &note, style);
        if pointers {
            let x = x + text_width(&note, SMALL) + legend - text_width(LEGEND, SMALL);
            triangle(canvas, x as usize - 10, 50, true, MARK);
            canvas.text(x, 42.0, LEGEND, style);
        }
    }

    fn panel(&self, canvas: &mut Canvas, panel: &Panel, pointers: bool, blocked: Option<&[f64]>) {
        let [nx, ny] = [self.edges[0].len() - 1, self.edges[1].len() - 1];
        let [a, b] = panel.axes();
        let strides = [1, nx, nx * ny];
        let start = self.at[panel.normal] * strides[panel.normal];
        let of = |values: &[f64], i: usize, j: usize| values[start + i * strides[a] + j * strides[b]];
        let value = |i: usize, j: usize| of(self.values, i, j);
        let title = self.panel_title(panel);
        let (across, up) = (self.axis(a), self.axis(b));
        let area = shifted(panel.area);
        let heatmap = Heatmap { across, up, value: &value, range: self.range, map: self.map, title: &title };
        heatmap.draw(canvas, area);
        if let Some(blocked) = blocked {
            heatmap.hatch(canvas, area, &|i, j| of(blocked, i, j));
        }
        if pointers {
            pointer(canvas, area, &across, self.position(a), true, MARK);
            pointer(canvas, area, &up, self.position(b), false, MARK);
        }
    }

    fn panel_title(&self, panel: &Panel) -> String {
        let axis = panel.normal;
        let mut index = [":", ":", ":"].map(str::to_owned);
        index[axis] = self.at[axis].to_string();
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        let place = format!(
            "{} = {}{unit}   [{}]",
            AXES[axis],
            number_to(self.position(axis), self.cell_size(axis) / 100.0),
            index.join(", ")
        );
        match panel.stretched {
            Some((axis, factor)) => format!("{place}   {} drawn × {}", AXES[axis], number(rounded(factor))),
            None => place,
        }
    }

    /// Pixels right of the bar, for its numbers, words and name.
    fn bar_room(&self) -> usize {
        let marks = ticks(self.range[0], self.range[1], 5);
        let widest = self.widest_number(&marks);
        let words = self.end_words(&marks).iter().map(|w| text_width(w, SMALL)).fold(0.0, f64::max);
        let beside = 10.0 + widest + if words > 0.0 { words + 8.0 } else { 0.0 };
        beside.max(text_width(&self.bar_name(marks.power), NORMAL) - BAR as f64).ceil() as usize + 8
    }

    /// The words beside the ends of the bar, with the number where no mark tells it.
    fn end_words(&self, marks: &Ticks) -> [String; 2] {
        [0, 1].map(|n| {
            let (end, word) = (self.range[n], self.ends[n]);
            let near = 1e-9 * (self.range[1] - self.range[0]);
            match word.is_empty() || marks.at.iter().any(|at| (at - end).abs() <= near) {
                true => word.to_owned(),
                false => format!("{} {word}", end_number(end, marks)),
            }
        })
    }

    /// Width of the numbers beside the bar, of those at its ends too.
    fn widest_number(&self, marks: &Ticks) -> f64 {
        let ends = self.range.map(|end| text_width(&end_number(end, marks), SMALL));
        marks.labels.iter().map(|l| text_width(l, SMALL)).chain(ends).fold(0.0, f64::max)
    }

    /// The name of the field over its bar, with the unit of numbers from which a power of ten is taken out.
    fn bar_name(&self, power: i32) -> String {
        let split = self.name.split_once(" [").and_then(|(name, unit)| Some((name, unit.strip_suffix(']')?)));
        match (split, power) {
            (_, 0) => self.name.to_owned(),
            (Some((name, "kPa")), -6) => format!("{name} [mPa]"),
            (Some((name, "kPa")), -3) => format!("{name} [Pa]"),
            (Some((name, "kPa")), 3) => format!("{name} [MPa]"),
            (Some((name, unit)), _) => format!("{name} [1e{power} {unit}]"),
            (None, _) => format!("{} [1e{power}]", self.name),
        }
    }

    /// The colours of the bar, and where those between its ends stand: an end with a colour of its own has a field beyond them.
    fn bar_colours(&self, canvas: &mut Canvas, area: Area) -> Area {
        let [below, above] = self.map.own_ends().map(|own| if own { OWN_END.min(area.height / 4) } else { 0 });
        let inner = Area { y: area.y + above, height: area.height - below - above, ..area };
        canvas.rect(area.x, area.y, area.width, above, self.map.colour(1.0));
        canvas.rect(area.x, inner.y + inner.height, area.width, below, self.map.colour(0.0));
        for y in 0..inner.height {
            let share = (inner.height - 1 - y) as f64 / (inner.height - 1).max(1) as f64;
            canvas.rect(area.x, inner.y + y, area.width, 1, self.map.between(share));
        }
        if above > 0 {
            canvas.rect(area.x, inner.y, area.width, 1, INK);
        }
        if below > 0 {
            canvas.rect(area.x, inner.y + inner.height - 1, area.width, 1, INK);
        }
        inner
    }

    fn bar(&self, canvas: &mut Canvas, area: Area) {
        let inner = self.bar_colours(canvas, area);
        canvas.frame(area.x, area.y, area.width, area.height, INK);
        let [low, high] = self.range;
        let marks = ticks(low, high, (area.height / 45).clamp(1, 5));
        let right = (area.x + area.width) as f64;
        let style = Style { height: SMALL, up: 0.5, ..Style::default() };
        // An end with a colour of its own is told in the middle of that.
        let row = |v: f64| match self.map.own_ends() {
            [true, _] if v <= low => f64::midpoint((inner.y + inner.height) as f64, (area.y + area.height) as f64),
            [_, true] if v >= high => f64::midpoint(area.y as f64, inner.y as f64),
            _ => (inner.y + inner.height - 1) as f64 - (v - low) / (high - low) * (inner.height - 1) as f64,
        };
        for (v, label) in marks.at.iter().zip(&marks.labels) {
            canvas.rect(area.x + area.width, row(*v).round() as usize, 5, 1, INK);
            canvas.text(right + 10.0, row(*v).round() + 0.5, label, style);
        }
        for (n, end) in [low, high].into_iter().enumerate() {
            let free = marks.at.iter().all(|v| (row(*v) - row(end)).abs() > END_GAP);
            if free && !self.told[n] {
                canvas.text(right + 10.0, row(end) + 0.5, &end_number(end, &marks), Style { colour: GREY, ..style });
            }
        }
        let widest = self.widest_number(&marks);
        let words = self.end_words(&marks);
        for ((v, word), _) in [low, high].into_iter().zip(&words).zip(self.told).filter(|(_, told)| *told) {
            canvas.text(right + 18.0 + widest, row(v) + 0.5, word, Style { colour: GREY, ..style });
        }
        canvas.text(
            area.x as f64,
            area.y as f64 - 14.0,
            &self.bar_name(marks.power),
            Style { height: NORMAL, ..Style::default() },
        );
    }
}

/// The number of an end of the bar, in the power of ten of its marks.
fn end_number(end: f64, marks: &Ticks) -> String {
    number(end / 10_f64.powi(marks.power))
}

/// The pointers' explanation with its own pointer.
fn legend_width() -> f64 {
    28.0 + text_width(LEGEND, SMALL)
}

/// A range that has a width: a uniform field lies in the middle of its colours, one of zeros at their lower end.
fn usable([low, high]: [f64; 2]) -> [f64; 2] {
    match () {
        () if (high - low).is_finite() && low < high => [low, high],
        () if low == 0.0 && high == 0.0 => [0.0, 1.0],
        () if low.is_finite() && low == high => [low - low.abs().max(1.0) / 2.0, low + low.abs().max(1.0) / 2.0],
        () => [0.0, 1.0],
    }
}

/// From the layout's corner to the sheet's.
fn shifted(area: Area) -> Area {
    Area { x: area.x + BORDER, y: area.y + HEAD, ..area }
}

/// To two digits.
fn rounded(factor: f64) -> f64 {
    let unit = 10f64.powf(factor.log10().floor() - 1.0);
    (factor / unit).round() * unit
}

/// Keeps what fits, and says that something is missing.
fn shortened(text: &str, height: f64, room: f64) -> String {
    if text_width(text, height) <= room {
        return text.to_owned();
    }
    let mut short: Vec<char> = text.chars().collect();
    while !short.is_empty() && text_width(&(short.iter().collect::<String>() + "…"), height) > room {
        short.truncate(short.len() * 19 / 20);
    }
    short.into_iter().collect::<String>() + "…"
}
