//! Polygons that lines in a plane cut out, where the lines move as the plane rises.

use crate::number::plane::{P2, dot, on_way};
use heapless::Vec;

/// Sides of the first strip between its ends, of the second one, its ends, and the sides of the box.
pub(super) const MOST_LINES: usize = 14;

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
    let (mut all, mut nearest) = (true, (f64::NEG_INFINITY, 0));
    let mut values = [0.0; MOST_CORNERS];
    for ((n, corner), place) in corners.iter().enumerate().zip(&mut values) {
        let value = dot(normal, corner.at) + offset;
        *place = value;
        all &= value >= 0.0;
        if value > nearest.0 {
            nearest = (value, n);
        }
    }
    if all {
        return Cut::All;
    }
    if !(nearest.0 >= 0.0) {
        let line = |n: usize| corners.get(n).map_or(0, |c| c.line);
        let last = corners.len().saturating_sub(1);
        return Cut::None([line(nearest.1.checked_sub(1).unwrap_or(last)), line(nearest.1)]);
    }
    kept.clear();
    let followers = corners.iter().skip(1).chain(corners.first());
    let mut here = values[0];
    let after = values.iter().take(corners.len()).skip(1).chain(&values[..1]);
    for ((corner, to), &there) in corners.iter().zip(followers).zip(after) {
        if here >= 0.0 {
            let _ = kept.push(*corner);
        }
        if (here >= 0.0) != (there >= 0.0) {
            let line = if here >= 0.0 { number } else { corner.line };
            let _ = kept.push(Corner { at: on_way(corner.at, to.at, here / (here - there)), line });
        }
        here = there;
    }
    Cut::Part
}
