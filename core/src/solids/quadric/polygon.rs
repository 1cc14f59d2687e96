//! Polygons that lines in a plane cut out, where the lines move as the plane rises.

use crate::number::plane::{P2, dot, on_way};
use heapless::Vec;

/// Sides of the first strip between its ends, of the second one, its ends, those of a third pipe, and the sides of the box.
pub(super) const MOST_LINES: usize = 16;

/// Each line cuts off a corner and adds two, at most.
pub(super) const MOST_CORNERS: usize = MOST_LINES;

/// Inside is where `normal · x + offset + rise · height`, plus half the width of a strip, is not negative.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub normal: P2,
    pub offset: f64,
    pub rise: f64,
    /// The length of the normal.
    pub size: f64,
    /// The strip that it is a side of, if of any.
    pub strip: Option<usize>,
}

impl Line {
    /// What is added to `normal · x` at a height.
    #[inline(always)]
    pub fn place(&self, height: f64, strips: &Strips) -> f64 {
        self.offset + self.rise * height + self.strip.map_or(0.0, |n| strips.half[n & 1])
    }

    /// By how much it moves outward as the height grows, in units of its normal.
    #[inline(always)]
    pub fn growth(&self, strips: &Strips) -> f64 {
        self.rise + self.strip.map_or(0.0, |n| strips.growth[n & 1])
    }
}

/// A corner of a polygon, and the line of the side after it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub at: P2,
    pub line: u8,
}

pub(super) type Corners = Vec<Corner, MOST_CORNERS>;

/// Half the widths of both strips at a height, and by how much these grow with it.
pub(super) struct Strips {
    pub half: P2,
    pub growth: P2,
}

/// What a line leaves of a polygon.
pub(super) enum Cut {
    All,
    Part,
    /// Nothing: the lines before and after the corner that is nearest to it.
    None([u8; 2]),
}

/// The part of a polygon where `normal · x + offset` is not negative, where that is neither all nor nothing; its side along that line gets a number.
pub(super) fn cut(corners: &Corners, normal: P2, offset: f64, number: u8, kept: &mut Corners) -> Cut {
    let value = |corner: &Corner| dot(normal, corner.at) + offset;
    let (mut all, mut none) = (true, true);
    for corner in corners {
        let inside = value(corner) >= 0.0;
        (all, none) = (all & inside, none & !inside);
    }
    if all {
        return Cut::All;
    }
    if none {
        return Cut::None(nearest(corners, value));
    }
    kept.clear();
    let Some(mut before) = corners.last() else { return Cut::All };
    let mut there = value(before);
    for corner in corners {
        let here = value(corner);
        if (here >= 0.0) != (there >= 0.0) {
            let line = if there >= 0.0 { number } else { before.line };
            let _ = kept.push(Corner { at: on_way(before.at, corner.at, there / (there - here)), line });
        }
        if here >= 0.0 {
            let _ = kept.push(*corner);
        }
        (before, there) = (corner, here);
    }
    Cut::Part
}

/// The lines before and after the corner of which a value is greatest.
#[inline(never)]
fn nearest(corners: &Corners, value: impl Fn(&Corner) -> f64) -> [u8; 2] {
    let (mut lines, mut greatest) = ([0; 2], f64::NEG_INFINITY);
    let mut before = corners.last().map_or(0, |c| c.line);
    for corner in corners {
        let value = value(corner);
        if value > greatest {
            (lines, greatest) = ([before, corner.line], value);
        }
        before = corner.line;
    }
    lines
}
