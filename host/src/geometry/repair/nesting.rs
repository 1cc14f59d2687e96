//! Which closed shells are bodies and which are cavities.
//!
//! A shell inside another and of opposite orientation is a cavity of it (or, inside a cavity, an island). A shell of the same
//! orientation as its container is a body of its own, as is a shell inside nothing, whichever way round it is.

use glam::DVec3;

/// A closed shell as the nesting sees it.
#[derive(Debug, Clone)]
pub struct Closed {
    /// Its triangles.
    pub triangles: Vec<[DVec3; 3]>,
    /// Signed volume; negative if inside out.
    pub volume: f64,
    /// Bounding box.
    pub bounds: [DVec3; 2],
}

impl Closed {
    /// Measure some triangles.
    #[must_use]
    pub fn new(triangles: Vec<[DVec3; 3]>) -> Self {
        let corners = || triangles.iter().flatten().copied();
        let bounds = corners().fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[a, b], p| [a.min(p), b.max(p)]);
        Closed { volume: signed_volume(&triangles, (bounds[0] + bounds[1]) * 0.5), bounds, triangles }
    }

    /// Area of the surface.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.triangles.iter().map(|[a, b, c]| (b - a).cross(c - a).length() * 0.5).sum()
    }

    /// No volume to speak of: a sheet with two sides.
    #[must_use]
    pub fn is_sheet(&self) -> bool {
        let size = (self.bounds[1] - self.bounds[0]).max_element();
        self.volume.abs() <= 1e-12 * self.area() * size
    }
}

/// Volume enclosed by closed triangles, seen from `origin` (near them, against cancellation).
#[must_use]
pub fn signed_volume(triangles: &[[DVec3; 3]], origin: DVec3) -> f64 {
    triangles.iter().map(|t| t.map(|p| p - origin)).map(|[a, b, c]| a.dot(b.cross(c))).sum::<f64>() / 6.0
}

/// Part of a shell's triangles in the final bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// A body of its own.
    Body,
    /// A cavity in the body that is shell `.0`.
    CavityOf(usize),
}

/// The role of every shell. Sheets are bodies.
#[must_use]
pub fn roles(shells: &[Closed]) -> Vec<Role> {
    let mut roles = vec![Role::Body; shells.len()];
    let sign = |s: usize| shells[s].volume > 0.0;
    let solid: Vec<usize> = (0..shells.len()).filter(|&s| !shells[s].is_sheet()).collect();
    if solid.iter().all(|&s| sign(s)) || solid.iter().all(|&s| !sign(s)) {
        return roles;
    }
    let mut order = solid;
    order.sort_by(|&a, &b| shells[b].volume.abs().total_cmp(&shells[a].volume.abs()));
    for (n, &s) in order.iter().enumerate() {
        // The smallest container is the nearest before it in the order.
        let Some(&parent) = order[..n].iter().rev().find(|&&p| contains(&shells[p], &shells[s])) else { continue };
        if sign(parent) != sign(s) && roles[parent] == Role::Body {
            roles[s] = Role::CavityOf(parent);
        }
    }
    roles
}

/// Share of a triangle's size by which a point is pulled off it: more than rounding, less than walls are thick.
const OFF_THE_SURFACE: f64 = 1e-4;

/// Two closed shells whose volumes differ by less than this share are one surface twice.
const SAME: f64 = 1e-6;

/// Is `inner` inside `outer`, perhaps touching it? Told by its box and a spread of points just within its own surface.
fn contains(outer: &Closed, inner: &Closed) -> bool {
    let boxed = outer.bounds[0].cmple(inner.bounds[0]).all() && outer.bounds[1].cmpge(inner.bounds[1]).all();
    let smaller = inner.volume.abs() < (1.0 - SAME) * outer.volume.abs();
    let step = (inner.triangles.len() / 16).max(1);
    let within = |[a, b, c]: &[DVec3; 3]| {
        let normal = (b - a).cross(c - a) * inner.volume.signum();
        let twice_area = normal.length();
        let pulled = (a + b + c) / 3.0 - normal * (OFF_THE_SURFACE / twice_area.sqrt());
        twice_area == 0.0 || winding(outer, pulled).abs() > 0.5
    };
    boxed && smaller && inner.triangles.iter().step_by(step).all(within)
}

/// Winding number of a closed shell around a point.
/// A. van Oosterom and J. Strackee, *The solid angle of a plane triangle*, IEEE Trans. Biomed. Eng. 30 (1983), eq. (8).
fn winding(shell: &Closed, point: DVec3) -> f64 {
    let angle: f64 = shell
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|p| p - point);
            let [la, lb, lc] = [a.length(), b.length(), c.length()];
            let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
            2.0 * a.dot(b.cross(c)).atan2(below)
        })
        .sum();
    angle / (4.0 * std::f64::consts::PI)
}
