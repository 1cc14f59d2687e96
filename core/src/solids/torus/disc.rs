//! What a disc has of a convex polygon: area and first moments.

use crate::number::plane::{self, P2};
use crate::number::real::Real;
use core::f64::consts::PI;
use heapless::Vec;

/// A square cut by the planes of a cell, or a rectangle by those of two ends.
pub(super) type Polygon = Vec<P2, 12>;

/// The part of a polygon where `constant + slope · p` is not negative.
pub(super) fn cut(polygon: &Polygon, constant: f64, slope: P2) -> Polygon {
    let mut kept = Polygon::new();
    for (n, &p) in polygon.iter().enumerate() {
        let q = polygon.get(n + 1).or(polygon.first()).copied().unwrap_or(p);
        let (here, there) = (constant + plane::dot(slope, p), constant + plane::dot(slope, q));
        if here >= 0.0 {
            let _ = kept.push(p);
        }
        if (here >= 0.0) != (there >= 0.0) {
            let part = here / (here - there);
            let _ = kept.push(plane::on_way(p, q, part));
        }
    }
    kept
}

/// Area, and first moments about the disc's centre, of what a disc about the origin has of a polygon, counter-clockwise.
pub(super) fn moments(radius: f64, polygon: &Polygon) -> (f64, P2) {
    let (mut area, mut first) = (0.0, [0.0; 2]);
    for (n, &p) in polygon.iter().enumerate() {
        let q = polygon.get(n + 1).or(polygon.first()).copied().unwrap_or(p);
        let d = [q[0] - p[0], q[1] - p[1]];
        let square = plane::dot(d, d);
        if !(square > 0.0) {
            continue;
        }
        // The side within the disc, by its share of the way.
        let (along, aside) = (plane::dot(p, d), plane::cross(p, d));
        let left = (radius * Real::sqrt(square) - aside.abs()) * (radius * Real::sqrt(square) + aside.abs());
        let half = Real::sqrt(left.max(0.0));
        let (from, to) = (((-along - half) / square).clamp(0.0, 1.0), ((-along + half) / square).clamp(0.0, 1.0));
        let at = |t: f64| [p[0] + t * d[0], p[1] + t * d[1]];
        let mut add = |(a, f): (f64, P2)| {
            area += a;
            first = [first[0] + f[0], first[1] + f[1]];
        };
        if left > 0.0 && from < to {
            let (a, b) = (if from > 0.0 { at(from) } else { p }, if to < 1.0 { at(to) } else { q });
            add(sector(radius, p, a));
            add(triangle(a, b));
            add(sector(radius, b, q));
        } else {
            add(sector(radius, p, q));
        }
    }
    (area, first)
}

/// The triangle of the origin and two points.
fn triangle(a: P2, b: P2) -> (f64, P2) {
    let area = plane::cross(a, b) * 0.5;
    (area, [area * (a[0] + b[0]) / 3.0, area * (a[1] + b[1]) / 3.0])
}

/// The sector of the disc between the directions of two points.
fn sector(radius: f64, a: P2, b: P2) -> (f64, P2) {
    let turn = plane::cross(a, b);
    if turn == 0.0 {
        return (0.0, [0.0; 2]);
    }
    let angle = libm::atan2(turn, plane::dot(a, b)).clamp(-PI, PI);
    let unit = |p: P2| {
        let length = Real::sqrt(plane::dot(p, p));
        [p[0] / length, p[1] / length]
    };
    let (u, v) = (unit(a), unit(b));
    let cube = radius * radius * radius / 3.0;
    (radius * radius * angle * 0.5, [cube * (v[1] - u[1]), cube * (u[0] - v[0])])
}
