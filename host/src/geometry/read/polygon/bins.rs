//! Points of the plane in square bins, to find those in a box without looking at all.

use glam::DVec2;

/// Indices of points, bin by bin.
#[derive(Default)]
pub struct EarBins {
    low: DVec2,
    /// Bins per length, on both axes.
    density: DVec2,
    /// Bins on a side; 0 if there are none.
    side: usize,
    /// End of each bin in `items`; the next begins there.
    ends: Vec<usize>,
    items: Vec<usize>,
}

/// Fewer points than this are faster looked at one by one.
const FEW: usize = 32;

impl EarBins {
    /// Sorts these points, about one to a bin; makes no bins if they are few.
    pub fn fill(&mut self, points: &[DVec2], members: &[usize]) {
        self.side = if members.len() < FEW { 0 } else { members.len().isqrt() };
        if self.side == 0 {
            return;
        }
        let all = || members.iter().map(|&i| points[i]);
        self.low = all().fold(DVec2::INFINITY, DVec2::min);
        let high = all().fold(DVec2::NEG_INFINITY, DVec2::max);
        self.density = self.side as f64 / (high - self.low);
        self.ends.clear();
        self.ends.resize(self.side * self.side, 0);
        for &i in members {
            let bin = self.bin(points[i]);
            self.ends[bin] += 1;
        }
        // Counts become ends; putting the items in from behind turns them into starts, and a shift back into ends.
        let mut sum = 0;
        for end in &mut self.ends {
            sum += *end;
            *end = sum;
        }
        self.items.clear();
        self.items.resize(members.len(), 0);
        for &i in members {
            let bin = self.bin(points[i]);
            self.ends[bin] -= 1;
            self.items[self.ends[bin]] = i;
        }
        self.ends.rotate_left(1);
        self.ends[self.side * self.side - 1] = members.len();
    }

    /// The runs of points, one for each row of bins, that hold all those in a box; none if that is no shorter way than to look at
    /// `others` points.
    pub fn rows(&self, low: DVec2, high: DVec2, others: usize) -> Option<impl Iterator<Item = &[usize]>> {
        let ((x0, y0), (x1, y1)) = (self.place(low), self.place(high));
        let is_shorter = self.side > 0 && (x1 - x0 + 1) * (y1 - y0 + 1) < others;
        is_shorter
            .then(|| (y0..=y1).map(move |y| &self.items[self.start(y * self.side + x0)..self.ends[y * self.side + x1]]))
    }

    fn start(&self, bin: usize) -> usize {
        if bin == 0 { 0 } else { self.ends[bin - 1] }
    }

    fn bin(&self, point: DVec2) -> usize {
        let (x, y) = self.place(point);
        y * self.side + x
    }

    /// Column and row of a point; one outside belongs to the nearest bin. Never falls as a coordinate grows, so a box of bins
    /// holds all points of the box. Points on one line have infinite density across it: 0 × ∞ is NaN, which goes to bin 0.
    fn place(&self, point: DVec2) -> (usize, usize) {
        let place = (point - self.low) * self.density;
        let last = self.side.saturating_sub(1);
        ((place.x as usize).min(last), (place.y as usize).min(last))
    }
}
