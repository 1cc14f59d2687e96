//! Points and lines on two logarithmic axes.

use super::canvas::{Canvas, Colour, GREY, INK, Style};

/// A picture of some series.
#[derive(Debug, Clone)]
pub struct Chart<'a> {
    /// Over the picture.
    pub title: &'a str,
    /// Name and unit of the horizontal axis.
    pub x: &'a str,
    /// Name and unit of the vertical axis.
    pub y: &'a str,
    /// What is drawn.
    pub series: Vec<Series<'a>>,
}

/// Lines of one colour.
#[derive(Debug, Clone)]
pub struct Series<'a> {
    /// In the legend.
    pub name: &'a str,
    /// Points; consecutive ones of a line are joined. Only those with positive, finite coordinates are drawn.
    pub lines: Vec<Vec<[f64; 2]>>,
}

/// Colours that also differ in lightness; used in turn.
const COLOURS: [Colour; 6] =
    [[32, 84, 147], [214, 84, 32], [46, 139, 87], [128, 62, 140], [190, 150, 20], [90, 90, 90]];
const GRID: Colour = [226, 229, 233];
const SIZE: [usize; 2] = [900, 620];
/// Free left, above, right and below the axes.
const MARGIN: [usize; 4] = [92, 56, 230, 64];
const MARKER: f64 = 7.0;
/// Most labels along an axis.
const LABELS: i32 = 12;

impl Chart<'_> {
    /// Draws; nothing if there is no point to draw.
    #[must_use]
    pub fn draw(&self) -> Option<Canvas> {
        let points = || self.series.iter().flat_map(|s| s.lines.iter().flatten().filter(|p| drawable(p)));
        let axes = [decades(points().map(|p| p[0]))?, decades(points().map(|p| p[1]))?];
        let mut canvas = Canvas::new(SIZE[0], SIZE[1]);
        let [left, top, right, below] = MARGIN;
        let (width, height) = (SIZE[0] - left - right, SIZE[1] - top - below);
        let share = |axis: usize, value: f64| {
            let [low, high] = axes[axis];
            (value.log10() - f64::from(low)) / f64::from(high - low)
        };
        let place = |p: &[f64; 2]| {
            [left as f64 + share(0, p[0]) * width as f64, top as f64 + (1.0 - share(1, p[1])) * height as f64]
        };
        for (axis, [low, high]) in axes.into_iter().enumerate() {
            let every = (high - low - 1) / LABELS + 1;
            for power in (low..=high).filter(|p| (p - low) % every == 0) {
                let at = place(&[0, 1].map(|a| 10_f64.powi(if a == axis { power } else { axes[a][0] })));
                let small = Style { height: 9.5, colour: GREY, ..Style::default() };
                let label = format!("1e{power}").replace('-', "−");
                if axis == 0 {
                    canvas.rect(at[0] as usize, top, 1, height, GRID);
                    canvas.text(at[0], at[1] + 8.0, &label, Style { along: 0.5, up: 1.0, ..small });
                } else {
                    canvas.rect(left, at[1] as usize, width, 1, GRID);
                    canvas.text(at[0] - 8.0, at[1], &label, Style { along: 1.0, up: 0.5, ..small });
                }
            }
        }
        canvas.frame(left, top, width, height, INK);
        let middle = [left as f64 + width as f64 / 2.0, top as f64 + height as f64 / 2.0];
        let centred = Style { along: 0.5, ..Style::default() };
        canvas.text(left as f64, 32.0, self.title, Style { height: 14.0, ..Style::default() });
        canvas.text(middle[0], SIZE[1] as f64 - 16.0, self.x, centred);
        canvas.text(24.0, middle[1], self.y, Style { turned: true, ..centred });
        for (series, colour) in self.series.iter().zip(COLOURS.into_iter().cycle()) {
            for line in &series.lines {
                let places: Vec<[f64; 2]> = line.iter().filter(|p| drawable(p)).map(place).collect();
                places.windows(2).for_each(|ends| canvas.line(ends[0], ends[1], 1.2, colour));
                places.iter().for_each(|&at| canvas.line(at, at, MARKER, colour));
            }
        }
        for (n, (series, colour)) in self.series.iter().zip(COLOURS.into_iter().cycle()).enumerate() {
            let at = [(SIZE[0] - right + 24) as f64, (top + 12 + 22 * n) as f64];
            canvas.line(at, at, MARKER, colour);
            canvas.text(at[0] + 14.0, at[1], series.name, Style { up: 0.5, ..Style::default() });
        }
        Some(canvas)
    }
}

fn drawable(p: &[f64; 2]) -> bool {
    p.iter().all(|v| v.is_normal() && *v > 0.0)
}

/// The powers of ten around some values.
fn decades(values: impl Iterator<Item = f64> + Clone) -> Option<[i32; 2]> {
    let low = values.clone().reduce(f64::min)?.log10().floor() as i32;
    let high = values.reduce(f64::max)?.log10().ceil() as i32;
    Some([low, high.max(low + 1)])
}
