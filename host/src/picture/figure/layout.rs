//! Where the panels and the colour bar go.

use crate::picture::heatmap::{ABOVE, Area, BELOW};

/// Pixels of the colour bar across.
pub(super) const BAR: usize = 18;
/// Widest and highest arrangement.
pub(super) const WIDTH: usize = 1560;
const HEIGHT: usize = 1040;
/// Between a panel and what is right of it: half of the last number of its axis, the pointers.
const RIGHT: usize = 34;
/// A panel's longer side is at least this, its shorter side at least that.
const LONG: f64 = 180.0;
const SHORT: f64 = 44.0;
/// Heights of the bar.
const BAR_HEIGHT: [usize; 2] = [110, 520];
/// An earlier arrangement is kept unless a later one is this much larger.
const BETTER: f64 = 1.2;

/// One slice on the sheet.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Panel {
    /// The axis that the slice is across.
    pub normal: usize,
    pub area: Area,
    /// An axis that is drawn larger than the other by a factor.
    pub stretched: Option<(usize, f64)>,
}

impl Panel {
    /// The axes to the right and upwards.
    pub fn axes(&self) -> [usize; 2] {
        axes(self.normal)
    }
}

fn axes(normal: usize) -> [usize; 2] {
    [[1, 2], [0, 2], [0, 1]][normal]
}

/// The whole sheet without its head.
pub(super) struct Layout {
    pub panels: Vec<Panel>,
    pub bar: Area,
    pub size: (usize, usize),
}

/// Column and row of each slice, and of the bar.
struct Arrangement {
    places: &'static [(usize, usize)],
    bar: (usize, usize),
}

const ONE: Arrangement = Arrangement { places: &[(0, 0)], bar: (1, 0) };
const ROW: Arrangement = Arrangement { places: &[(0, 0), (1, 0), (2, 0)], bar: (3, 0) };
const CORNER: Arrangement = Arrangement { places: &[(0, 0), (0, 1), (1, 1)], bar: (1, 0) };
const COLUMN: Arrangement = Arrangement { places: &[(0, 0), (0, 1), (0, 2)], bar: (1, 0) };

/// Pixels that texts need.
pub(super) struct TextSizes<'a> {
    /// Left of a panel, by its upright axis and height.
    pub left: &'a dyn Fn(usize, usize) -> usize,
    /// Above a panel.
    pub title: &'a dyn Fn(&Panel) -> usize,
    /// Right of the bar.
    pub bar: usize,
}

impl Layout {
    pub fn best(lengths: [f64; 3], cells: [usize; 3], sizes: &TextSizes) -> Layout {
        let normals = slices(cells);
        let candidates = if normals.len() == 1 { &[ONE][..] } else { &[ROW, CORNER, COLUMN][..] };
        let left = [1, 2].map(|axis| (sizes.left)(axis, HEIGHT / 3)).into_iter().fold(0, usize::max);
        let mut best: Option<(f64, Layout)> = None;
        for arrangement in candidates {
            let scale = arrangement.scale(normals, lengths, left, sizes.bar);
            if best.as_ref().is_none_or(|(old, _)| scale > BETTER * old) {
                best = Some((scale, arrangement.place(normals, lengths, scale, left, sizes)));
            }
        }
        best.map_or_else(|| ONE.place(normals, lengths, 1.0, left, sizes), |(_, layout)| layout)
    }
}

/// The slices worth drawing, by their normals: not those in which an axis has a single cell, as far as any remain.
fn slices(cells: [usize; 3]) -> &'static [usize] {
    match cells.map(|n| n > 1) {
        [true, true, true] => &[2, 1, 0],
        [_, true, false] if cells[0] == 1 => &[0],
        [false, true, true] => &[0],
        [_, false, true] => &[1],
        _ => &[2],
    }
}

impl Arrangement {
    fn cells(&self) -> (usize, usize) {
        let all = || self.places.iter().chain([&self.bar]);
        (all().map(|p| p.0).fold(0, usize::max) + 1, all().map(|p| p.1).fold(0, usize::max) + 1)
    }

    /// A panel stands in the bar's column, so that the bar needs no width of its own.
    fn bar_shares_column(&self) -> bool {
        self.places.iter().any(|p| p.0 == self.bar.0)
    }

    /// Pixels per unit of length that fit the sheet.
    fn scale(&self, normals: &[usize], lengths: [f64; 3], left: usize, bar_room: usize) -> f64 {
        let (columns, rows) = self.cells();
        let (mut wide, mut high) = (vec![0f64; columns], vec![0f64; rows]);
        for (place, normal) in self.places.iter().zip(normals) {
            let [a, b] = axes(*normal).map(|axis| lengths[axis]);
            wide[place.0] = wide[place.0].max(a);
            high[place.1] = high[place.1].max(b);
        }
        let bar = if self.bar_shares_column() { 0 } else { BAR + bar_room };
        let panels = wide.iter().filter(|w| **w > 0.0).count();
        let free_width = WIDTH.saturating_sub(panels * (left + RIGHT) + bar) as f64;
        let free_height = HEIGHT.saturating_sub(rows * (ABOVE + BELOW)) as f64;
        (free_width / wide.iter().sum::<f64>()).min(free_height / high.iter().sum::<f64>())
    }

    fn place(&self, normals: &[usize], lengths: [f64; 3], scale: f64, left: usize, sizes: &TextSizes) -> Layout {
        let (columns, rows) = self.cells();
        let (mut wide, mut high) = (vec![0; columns], vec![0; rows]);
        let mut panels = vec![];
        for (place, normal) in self.places.iter().zip(normals) {
            let panel = sized(*normal, lengths, scale);
            wide[place.0] = wide[place.0].max(left + panel.area.width.max((sizes.title)(&panel)) + RIGHT);
            high[place.1] = high[place.1].max(ABOVE + panel.area.height + BELOW);
            panels.push(panel);
        }
        let offset = if self.bar_shares_column() { left } else { 0 };
        wide[self.bar.0] = wide[self.bar.0].max(offset + BAR + sizes.bar);
        high[self.bar.1] = high[self.bar.1].max(ABOVE + BAR_HEIGHT[0] + BELOW);
        let start = |sizes: &[usize], n: usize| sizes[..n].iter().sum::<usize>();
        for (panel, (column, row)) in panels.iter_mut().zip(self.places) {
            panel.area.x = start(&wide, *column) + left;
            // On the row's common ground line.
            panel.area.y = start(&high, *row) + high[*row] - BELOW - panel.area.height;
        }
        let bar_height = (high[self.bar.1] - ABOVE - BELOW).min(BAR_HEIGHT[1]);
        let bar = Area {
            x: start(&wide, self.bar.0) + offset,
            y: start(&high, self.bar.1) + high[self.bar.1] - BELOW - bar_height,
            width: BAR,
            height: bar_height,
        };
        Layout { panels, bar, size: (wide.iter().sum(), high.iter().sum()) }
    }
}

/// A panel of a readable size: to scale if that is large enough, else enlarged, else with its short axis stretched.
fn sized(normal: usize, lengths: [f64; 3], scale: f64) -> Panel {
    let shown = axes(normal);
    let [mut width, mut height] = shown.map(|axis| lengths[axis] * scale);
    let enlarge = (LONG / width.max(height)).max(1.0);
    (width, height) = (width * enlarge, height * enlarge);
    let stretched = match (width < SHORT, height < SHORT) {
        (true, _) => Some((shown[0], SHORT / width)),
        (_, true) => Some((shown[1], SHORT / height)),
        _ => None,
    };
    let area = Area { x: 0, y: 0, width: pixels(width), height: pixels(height) };
    Panel { normal, area, stretched }
}

fn pixels(length: f64) -> usize {
    (length.max(SHORT).round() as usize).min(WIDTH)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layout(lengths: [f64; 3], cells: [usize; 3]) -> Layout {
        Layout::best(lengths, cells, &TextSizes { left: &|_, _| 60, title: &|_| 220, bar: 90 })
    }

    fn overlap(a: Area, b: Area) -> bool {
        a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height
    }

    #[test]
    fn nothing_overlaps_and_all_is_on_a_sheet_of_bounded_size() {
        let sizes = [1e-6, 0.1, 1.0, 3.0, 10.0, 1e7];
        for x in sizes {
            for y in sizes {
                for z in sizes {
                    let layout = layout([x, y, z], [5, 5, 5]);
                    let areas: Vec<Area> = layout.panels.iter().map(|p| p.area).chain([layout.bar]).collect();
                    for (n, a) in areas.iter().enumerate() {
                        assert!(a.x + a.width <= layout.size.0 && a.y + a.height <= layout.size.1);
                        assert!(areas[..n].iter().all(|b| !overlap(*a, *b)), "{x} {y} {z}: {areas:?}");
                    }
                    assert!(layout.size.0 <= 2000 && layout.size.1 <= 1400, "{x} {y} {z}: {:?}", layout.size);
                }
            }
        }
    }

    #[test]
    fn panels_are_to_scale() {
        let layout = layout([4.0, 2.0, 1.0], [40, 20, 10]);
        for panel in &layout.panels {
            let [a, b] = panel.axes().map(|axis| [4.0, 2.0, 1.0][axis]);
            let ratio = panel.area.width as f64 / panel.area.height as f64;
            assert!((ratio / (a / b) - 1.0).abs() < 0.01 && panel.stretched.is_none(), "{panel:?}");
        }
    }

    #[test]
    fn cubes_in_a_row_channels_above_each_other() {
        let rows = |lengths| {
            let layout = layout(lengths, [9, 9, 9]);
            (layout.panels[0].area.y + layout.panels[0].area.height) < layout.panels[1].area.y
        };
        assert!(!rows([1.0, 1.0, 1.0]));
        assert!(rows([10.0, 1.0, 1.0]));
        assert!(!rows([1.0, 1.0, 10.0]));
    }

    #[test]
    fn dead_axes_leave_one_panel() {
        let normals = |cells| slices(cells).to_vec();
        assert_eq!(normals([9, 9, 9]), [2, 1, 0]);
        assert_eq!(normals([1, 9, 9]), [0]);
        assert_eq!(normals([9, 1, 9]), [1]);
        assert_eq!(normals([9, 9, 1]), [2]);
        assert_eq!(normals([9, 1, 1]), [2]);
        assert_eq!(normals([1, 9, 1]), [0]);
        assert_eq!(normals([1, 1, 9]), [1]);
        assert_eq!(normals([1, 1, 1]), [2]);
    }
}
