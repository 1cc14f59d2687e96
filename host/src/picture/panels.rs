//! Small multiples: panels of points and lines on logarithmic axes that all share, with one legend below.

use super::axis::LogAxis;
use super::canvas::{Canvas, Colour, GREY, INK, Style, text_width};
use super::svg::{Sheet, Svg};

/// A picture of some panels.
#[derive(Debug, Clone, Default)]
pub struct Panels {
    /// Over the picture.
    pub title: String,
    /// Name and unit of the horizontal axes.
    pub x: String,
    /// Name and unit of the vertical axes.
    pub y: String,
    /// Names of the colours, in their order.
    pub series: Vec<String>,
    /// The panels.
    pub panels: Vec<Panel>,
    /// What is not larger than this lies on the floor: what the legend calls the floor.
    pub floor: Option<(f64, String)>,
    /// Names of the tints that tell marks of one colour apart, and the share of white within them, 0 to 1.
    pub tints: Vec<(String, f64)>,
    /// Meaning of squares, rings and bars.
    pub square: String,
    /// Of rings; empty if there are none.
    pub ring: String,
    /// Of bars; empty if there are none.
    pub bar: String,
    /// Before the slopes of a panel.
    pub slopes: String,
    /// Each panel has a horizontal axis of its own.
    pub own_x: bool,
}

/// A part of a picture.
#[derive(Debug, Clone, Default)]
pub struct Panel {
    /// Over it.
    pub title: String,
    /// Name and unit of its horizontal axis, if it is not that of all.
    pub x: Option<String>,
    /// Its lines.
    pub lines: Vec<Line>,
    /// What is fitted to its points: the series, and the text.
    pub slopes: Vec<(usize, String)>,
}

/// Points that are joined.
#[derive(Debug, Clone, Default)]
pub struct Line {
    /// Its colour.
    pub series: usize,
    /// Its points in order.
    pub marks: Vec<Mark>,
}

/// A point.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Mark {
    /// Its place. What lies on or below the floor is drawn there.
    pub at: [f64; 2],
    /// Ends of its bar along x, if it has one.
    pub x_ends: Option<[f64; 2]>,
    /// Ends of its bar along y.
    pub y_ends: Option<[f64; 2]>,
    /// Drawn as a square.
    pub square: bool,
    /// With a ring around it.
    pub ring: bool,
    /// Its tint by its number, if it has one.
    pub tint: Option<usize>,
}

impl Panel {
    /// All places along x.
    fn across(&self) -> impl Iterator<Item = f64> {
        let marks = self.lines.iter().flat_map(|l| &l.marks);
        marks.flat_map(|m| [m.at[0]].into_iter().chain(m.x_ends.into_iter().flatten()))
    }
}

/// Colours that also differ in lightness; used in turn.
const COLOURS: [Colour; 14] = [
    [32, 84, 147],
    [214, 84, 32],
    [46, 139, 87],
    [128, 62, 140],
    [190, 150, 20],
    [90, 90, 90],
    [60, 160, 190],
    [200, 60, 110],
    [110, 66, 28],
    [150, 190, 60],
    [20, 20, 20],
    [235, 150, 165],
    [0, 90, 84],
    [165, 160, 225],
];
const GRID: Colour = [226, 229, 233];
const BAND: Colour = [238, 240, 243];
/// Free left, above, right and below the axes of a panel.
const MARGIN: [f64; 4] = [86.0, 34.0, 18.0, 50.0];
/// Height of the head of the picture.
const HEAD: f64 = 40.0;
/// Height of a line of the legend, and of a line of slopes.
const ROW: f64 = 20.0;
/// Height of the floor.
const FLOOR: f64 = 20.0;
const MARKER: f64 = 6.5;
/// Side of a square mark.
const SQUARE: f64 = 8.0;
/// What the rim of a tinted mark takes of its width.
const RIM: f64 = 2.4;
const SMALL: Style = Style { height: 8.5, colour: GREY, along: 0.0, up: 0.5, turned: false };
const PLAIN: Style = Style { height: 9.5, colour: INK, along: 0.0, up: 0.5, turned: false };

fn colour(series: usize) -> Colour {
    COLOURS[series % COLOURS.len()]
}

/// Where things stand.
struct Layout {
    /// Horizontal axes of the panels.
    across: Vec<LogAxis>,
    upward: LogAxis,
    /// Width and height within the axes.
    inner: [f64; 2],
    /// Width and height of a panel with its margins.
    outer: [f64; 2],
    columns: usize,
    /// Lines of slopes over the axes of each panel.
    slopes: usize,
    /// Height of the floor, if there is one.
    floor: f64,
    /// Where each entry of the legend stands.
    legend: Vec<[f64; 2]>,
    size: [usize; 2],
}

impl Panels {
    /// The picture as pixels; nothing if there is no point to draw.
    #[must_use]
    pub fn canvas(&self) -> Option<Canvas> {
        let layout = self.layout()?;
        let mut canvas = Canvas::new(layout.size[0], layout.size[1]);
        self.draw(&layout, &mut canvas);
        Some(canvas)
    }

    /// The picture as the text of an SVG.
    #[must_use]
    pub fn svg(&self) -> Option<String> {
        let layout = self.layout()?;
        let mut svg = Svg::new(layout.size[0], layout.size[1]);
        self.draw(&layout, &mut svg);
        Some(svg.text())
    }

    fn marks(&self) -> impl Iterator<Item = &Mark> {
        self.panels.iter().flat_map(|p| p.lines.iter().flat_map(|l| &l.marks))
    }

    /// A point lies on the floor: its value is not positive, or not above it.
    fn on_floor(&self, y: f64) -> bool {
        self.floor.as_ref().is_some_and(|(level, _)| y <= *level)
    }

    fn layout(&self) -> Option<Layout> {
        let count = self.panels.len();
        let columns = count.min(if count == 4 { 2 } else { 3 }).max(1);
        let inner = if count == 1 {
            [620.0, 380.0]
        } else if columns == 2 {
            [430.0, 270.0]
        } else {
            [290.0, 220.0]
        };
        let most = if columns == 3 { 7 } else { 9 };
        let shared = LogAxis::around(self.panels.iter().flat_map(Panel::across), most)?;
        let own =
            |p: &Panel| LogAxis::around(p.across(), most).filter(|_| self.own_x).unwrap_or_else(|| shared.clone());
        let across = self.panels.iter().map(own).collect();
        let ends = self.marks().flat_map(|m| [m.at[1]].into_iter().chain(m.y_ends.into_iter().flatten()));
        let level = self.floor.as_ref().map(|f| f.0);
        let upward = LogAxis::around(ends.filter(|y| !self.on_floor(*y)), 8);
        let upward = upward.or_else(|| LogAxis::around(level.into_iter(), 8))?;
        let floor = if self.marks().any(|m| self.on_floor(m.at[1])) { FLOOR } else { 0.0 };
        let widest = self.panels.iter().map(|p| self.slope_rows(p, inner[0]).len()).max().unwrap_or(0);
        let [left, top, right, below] = MARGIN;
        let outer = [inner[0] + left + right, inner[1] + top + below + ROW * widest as f64];
        let width = outer[0] * columns as f64;
        let top = HEAD + outer[1] * count.div_ceil(columns) as f64 + 12.0;
        let (legend, below, right) = self.legend_places([24.0, top], width);
        let size = [right.max(width), below + 16.0].map(|v| v.ceil() as usize);
        Some(Layout { across, upward, inner, outer, columns, slopes: widest, floor, legend, size })
    }

    /// Entries of the legend: what stands before each, and its text.
    fn legend(&self) -> Vec<(Symbol, String)> {
        let mut all: Vec<(Symbol, String)> =
            self.series.iter().enumerate().map(|(n, name)| (Symbol::Disc(n), name.clone())).collect();
        all.extend(self.tints.iter().map(|(name, white)| (Symbol::Tint(*white), name.clone())));
        let any = |of: fn(&Mark) -> bool| self.marks().any(of);
        if any(|m| m.square) {
            all.push((Symbol::Square, self.square.clone()));
        }
        if any(|m| m.ring) {
            all.push((Symbol::Ring, self.ring.clone()));
        }
        if any(|m| m.x_ends.is_some() || m.y_ends.is_some()) {
            all.push((Symbol::Bar, self.bar.clone()));
        }
        if let Some((_, text)) = self.floor.as_ref().filter(|_| self.marks().any(|m| self.on_floor(m.at[1]))) {
            all.push((Symbol::Floor, text.clone()));
        }
        all
    }

    /// Where the entries of the legend stand: side by side as far as there is room, the colours in rows of their own. Then how far down and how
    /// far right they reach.
    fn legend_places(&self, corner: [f64; 2], width: f64) -> (Vec<[f64; 2]>, f64, f64) {
        let (mut places, mut at, mut right): (Vec<[f64; 2]>, _, _) = (Vec::new(), corner, 0.0_f64);
        for (n, (_, text)) in self.legend().iter().enumerate() {
            let own = text_width(text, PLAIN.height) + 46.0;
            let first = n == self.series.len() || n == self.series.len() + self.tints.len();
            if at[0] > corner[0] && (at[0] + own > width || first) {
                at = [corner[0], at[1] + ROW];
            }
            places.push(at);
            at[0] += own;
            right = right.max(at[0]);
        }
        (places, at[1] + ROW, right)
    }

    /// The slopes of a panel in rows that fit.
    fn slope_rows<'a>(&self, panel: &'a Panel, width: f64) -> Vec<Vec<&'a (usize, String)>> {
        let mut rows: Vec<Vec<&(usize, String)>> = Vec::new();
        let mut used = f64::INFINITY;
        for slope in &panel.slopes {
            let own = slope_width(&slope.1);
            if used + own > width {
                rows.push(Vec::new());
                used = if rows.len() == 1 { text_width(&self.slopes, SMALL.height) + 8.0 } else { 0.0 };
            }
            used += own;
            if let Some(row) = rows.last_mut() {
                row.push(slope);
            }
        }
        rows
    }

    fn draw(&self, layout: &Layout, sheet: &mut dyn Sheet) {
        sheet.write([20.0, 24.0], &self.title, Style { height: 13.0, up: 0.5, ..Style::default() });
        for (n, panel) in self.panels.iter().enumerate() {
            let corner = [
                (n % layout.columns) as f64 * layout.outer[0] + MARGIN[0],
                HEAD + (n / layout.columns) as f64 * layout.outer[1] + MARGIN[1] + ROW * layout.slopes as f64,
            ];
            let Some(axis) = layout.across.get(n) else { continue };
            self.draw_axes(layout, (panel, axis), corner, sheet);
            panel.lines.iter().for_each(|line| self.draw_line(layout, (line, axis), corner, sheet));
        }
        for ((symbol, text), &at) in self.legend().into_iter().zip(&layout.legend) {
            symbol.draw(at, sheet);
            sheet.write([at[0] + 18.0, at[1]], &text, PLAIN);
        }
    }

    /// Frame, numbers, names and slopes of a panel whose axes begin at `corner`.
    fn draw_axes(&self, layout: &Layout, (panel, across): (&Panel, &LogAxis), corner: [f64; 2], sheet: &mut dyn Sheet) {
        let ([x, y], [width, height]) = (corner, layout.inner);
        let ground = y + height - layout.floor;
        if layout.floor > 0.0 {
            sheet.fill([x, ground], [width, layout.floor], BAND);
            let level = self.floor.as_ref().map_or_else(String::new, |f| format!("≤ {:.0e}", f.0).replace('-', "−"));
            sheet.write([x - 6.0, ground + 0.5 * layout.floor], &level, Style { along: 1.0, ..SMALL });
        }
        for (value, text) in &across.ticks {
            let at = x + across.share(*value) * width;
            sheet.line([at, y], [at, y + height], 1.0, GRID);
            sheet.write([at, y + height + 7.0], text, Style { along: 0.5, up: 1.0, ..SMALL });
        }
        for (value, text) in &layout.upward.ticks {
            let at = ground - layout.upward.share(*value) * (height - layout.floor);
            sheet.line([x, at], [x + width, at], 1.0, GRID);
            // The lowest number gives way to that of the floor.
            if layout.floor == 0.0 || ground - at > 12.0 {
                sheet.write([x - 6.0, at], text, Style { along: 1.0, ..SMALL });
            }
        }
        for (from, to) in
            [([0.0, 0.0], [1.0, 0.0]), ([0.0, 1.0], [1.0, 1.0]), ([0.0, 0.0], [0.0, 1.0]), ([1.0, 0.0], [1.0, 1.0])]
        {
            let place = |p: [f64; 2]| [x + p[0] * width, y + p[1] * height];
            sheet.line(place(from), place(to), 1.0, INK);
        }
        sheet.write(
            [x + 0.5 * width, y + height + 32.0],
            panel.x.as_ref().unwrap_or(&self.x),
            Style { along: 0.5, ..PLAIN },
        );
        sheet.write([x - 68.0, y + 0.5 * height], &self.y, Style { along: 0.5, turned: true, ..PLAIN });
        let rows = self.slope_rows(panel, width);
        let mut line = y - 12.0 - ROW * (rows.len().saturating_sub(1)) as f64;
        let over = y - 14.0 - ROW * layout.slopes as f64;
        sheet.write([x, over], &panel.title, Style { height: 10.5, up: 0.0, ..PLAIN });
        for (n, row) in rows.iter().enumerate() {
            let mut at = x;
            if n == 0 {
                sheet.write([at, line], &self.slopes, SMALL);
                at += text_width(&self.slopes, SMALL.height) + 8.0;
            }
            for (series, text) in row {
                sheet.disc([at + 3.0, line], 5.0, colour(*series));
                sheet.write([at + 9.0, line], text, Style { colour: colour(*series), ..SMALL });
                at += slope_width(text);
            }
            line += ROW;
        }
    }

    fn draw_line(&self, layout: &Layout, (line, across): (&Line, &LogAxis), corner: [f64; 2], sheet: &mut dyn Sheet) {
        let ([left, top], [width, height]) = (corner, layout.inner);
        let along = |x: f64| left + across.share(x).clamp(0.0, 1.0) * width;
        let ground = top + height - layout.floor;
        let up = |y: f64| match self.on_floor(y) {
            true => ground + 0.5 * layout.floor,
            false => ground - layout.upward.share(y).clamp(0.0, 1.0) * (height - layout.floor),
        };
        let place = |m: &Mark| [along(m.at[0]), up(m.at[1])];
        let drawn = |m: &&Mark| {
            m.at[0] > 0.0 && m.at.iter().all(|v| v.is_finite()) && (m.at[1] > 0.0 || self.on_floor(m.at[1]))
        };
        let marks: Vec<&Mark> = line.marks.iter().filter(drawn).collect();
        let ink = colour(line.series);
        // Nothing leads from the floor to what stands above it.
        let joined = |w: &&[&Mark]| self.on_floor(w[0].at[1]) == self.on_floor(w[1].at[1]);
        marks.windows(2).filter(joined).for_each(|w| sheet.line(place(w[0]), place(w[1]), 1.1, ink));
        for mark in marks {
            let at = place(mark);
            if let Some(ends) = mark.x_ends {
                let [a, b] = ends.map(along);
                sheet.line([a, at[1]], [b, at[1]], 1.0, ink);
                [a, b].iter().for_each(|&x| sheet.line([x, at[1] - 3.0], [x, at[1] + 3.0], 1.0, ink));
            }
            if let Some(ends) = mark.y_ends {
                let [a, b] = ends.map(up);
                sheet.line([at[0], a], [at[0], b], 1.0, ink);
                [a, b].iter().for_each(|&y| sheet.line([at[0] - 3.0, y], [at[0] + 3.0, y], 1.0, ink));
            }
            let white = mark.tint.and_then(|n| self.tints.get(n)).map_or(0.0, |(_, white)| *white);
            draw_mark(at, mark.square, [ink, tinted(ink, white)], sheet);
            if mark.ring {
                sheet.ring(at, 2.0 * MARKER, 1.2, INK);
            }
        }
    }
}

/// A colour with a share of white.
fn tinted(colour: Colour, white: f64) -> Colour {
    colour.map(|c| (f64::from(c) + white * (255.0 - f64::from(c))).round() as u8)
}

/// A square or a disc: its rim, and within it its tint.
fn draw_mark(at: [f64; 2], square: bool, [rim, within]: [Colour; 2], sheet: &mut dyn Sheet) {
    let mut centred = |size: f64, ink: Colour| match square {
        true => sheet.fill(at.map(|x| x - 0.5 * size), [size; 2], ink),
        false => sheet.disc(at, size, ink),
    };
    let size = if square { SQUARE } else { MARKER };
    centred(size, rim);
    if within != rim {
        centred(size - RIM, within);
    }
}

/// Room that a slope takes.
fn slope_width(text: &str) -> f64 {
    text_width(text, SMALL.height) + 20.0
}

/// What stands before an entry of the legend.
enum Symbol {
    Disc(usize),
    Tint(f64),
    Square,
    Ring,
    Bar,
    Floor,
}

impl Symbol {
    fn draw(&self, at: [f64; 2], sheet: &mut dyn Sheet) {
        match self {
            Symbol::Disc(series) => sheet.disc(at, MARKER, colour(*series)),
            Symbol::Tint(white) => draw_mark(at, false, [GREY, tinted(GREY, *white)], sheet),
            Symbol::Square => draw_mark(at, true, [GREY; 2], sheet),
            Symbol::Ring => sheet.ring(at, 2.0 * MARKER, 1.2, INK),
            Symbol::Bar => {
                sheet.line([at[0] - 6.0, at[1]], [at[0] + 6.0, at[1]], 1.0, GREY);
                [-6.0, 6.0]
                    .iter()
                    .for_each(|x| sheet.line([at[0] + x, at[1] - 3.0], [at[0] + x, at[1] + 3.0], 1.0, GREY));
            }
            Symbol::Floor => sheet.fill([at[0] - 7.0, at[1] - 5.0], [14.0, 10.0], [214, 218, 224]),
        }
    }
}
