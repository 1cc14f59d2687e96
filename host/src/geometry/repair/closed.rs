//! Closed surfaces with what is asked of them again and again: bounds, volume, how often they wind around a point.

use crate::geometry::repair::crossing::{solid_angle, tolerance};
use crate::geometry::repair::face::Face;
use crate::geometry::repair::lines::Lines;
use crate::geometry::repair::tree::Tree;
use glam::DVec3;
use std::sync::{Arc, OnceLock};

/// What is not known of a body.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Doubt {
    /// Nothing.
    #[default]
    None,
    /// Whether what it holds is solid or open.
    Perhaps,
    /// Which part of its box is solid; it may as well be a cavity of another body.
    Unknown,
}

/// A corner where surfaces cross is off by no more than so many units in the last place.
const CUT_ULPS: f64 = 2.0;

/// A closed shell as the nesting sees it.
#[derive(Debug, Clone)]
pub struct Closed {
    /// Its triangles.
    pub triangles: Vec<[DVec3; 3]>,
    /// Signed volume; negative if inside out.
    pub volume: f64,
    /// Bounding box.
    pub bounds: [DVec3; 2],
    /// What is not known of it.
    pub doubt: Doubt,
    /// Every triangle was there from both sides: it does not tell whether what it holds is solid or a room.
    pub two_sided: bool,
    /// How far corners may be off that were not read but computed; 0 if there are none.
    pub rounding: f64,
    /// Boxes in which it is not known what is solid: around rims of holes that are not plane, and around parts that may have each other's triangles.
    pub unknown: Vec<[DVec3; 2]>,
    /// What lines through it are followed by, once that was asked.
    pub lines: LineSearch,
}

/// Faces of a shell and their tree, made when they are needed first.
#[derive(Debug, Clone, Default)]
pub struct LineSearch(OnceLock<Arc<(Vec<Face>, Tree)>>);

/// Of shells with fewer triangles, solid angles tell as fast as lines do.
const MANY: usize = 512;

/// Directions in which lines leave a point: along nothing that is built.
const AWAY: [DVec3; 2] = [DVec3::new(0.412_91, 0.573_37, 0.707_65), DVec3::new(-0.63, 0.34, -0.69)];

impl Closed {
    /// Measure some triangles.
    #[must_use]
    pub fn new(triangles: Vec<[DVec3; 3]>) -> Self {
        let corners = || triangles.iter().flatten().copied();
        let bounds = corners().fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[a, b], p| [a.min(p), b.max(p)]);
        Closed {
            volume: signed_volume(&triangles, (bounds[0] + bounds[1]) * 0.5),
            bounds,
            triangles,
            doubt: Doubt::None,
            two_sided: false,
            rounding: 0.0,
            unknown: Vec::new(),
            lines: LineSearch::default(),
        }
    }

    /// Several as one.
    #[must_use]
    pub fn together<'a>(shells: impl Iterator<Item = &'a Closed> + Clone) -> Self {
        let whole = Self::new(shells.clone().flat_map(|s| s.triangles.iter().copied()).collect());
        let two_sided = shells.clone().all(|s| s.two_sided);
        Closed { two_sided, unknown: shells.flat_map(|s| s.unknown.iter().copied()).collect(), ..whole }
    }

    /// Measure triangles that were cut where they cross.
    #[must_use]
    pub fn of_parts(triangles: Vec<[DVec3; 3]>) -> Self {
        let whole = Self::new(triangles);
        let farthest = whole.bounds[0].abs().max(whole.bounds[1].abs()).max_element();
        Closed { rounding: CUT_ULPS * f64::EPSILON * farthest, ..whole }
    }

    /// Area of the surface.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.triangles.iter().map(|[a, b, c]| (b - a).cross(c - a).length() * 0.5).sum()
    }

    /// Have the boxes around both more than a side in common?
    #[must_use]
    pub fn overlaps(&self, other: &Closed) -> bool {
        self.bounds[0].cmplt(other.bounds[1]).all() && other.bounds[0].cmplt(self.bounds[1]).all()
    }

    /// Does the box around it hold that around the other?
    #[must_use]
    pub fn is_around(&self, other: &Closed) -> bool {
        self.bounds[0].cmple(other.bounds[0]).all() && self.bounds[1].cmpge(other.bounds[1]).all()
    }

    /// Does it wind around a point?
    #[must_use]
    pub fn winds_around(&self, point: DVec3) -> bool {
        let [lo, hi] = self.bounds;
        if point.cmplt(lo).any() || point.cmpgt(hi).any() {
            return false;
        }
        if self.triangles.len() >= MANY {
            let made =
                || Arc::new((self.triangles.iter().map(|t| Face::new(*t)).collect(), Tree::new(&self.triangles)));
            let (faces, tree) = &**self.lines.0.get_or_init(made);
            let lines = Lines::new(faces, tree, tolerance(self.bounds));
            // Where the surface has a crack, lines through it and others differ.
            if let [Some(one), Some(other)] = AWAY.map(|away| lines.winding(point, away, &[]))
                && one == other
            {
                return one != 0;
            }
        }
        self.triangles.iter().map(|t| solid_angle(t, point)).sum::<f64>().abs() > 0.5
    }

    /// No volume to speak of: a sheet with two sides.
    #[must_use]
    pub fn is_sheet(&self) -> bool {
        let size = (self.bounds[1] - self.bounds[0]).max_element();
        // No triangle has an area above 3/2 of the size's square; 2 hold the rounding of as many as memory does.
        let most = 2.0 * size * size * self.triangles.len() as f64;
        let is_small = |area: f64| self.volume.abs() <= 1e-12 * area * size;
        is_small(most) && is_small(self.area())
    }
}

/// Volume enclosed by closed triangles, seen from `origin` (near them, against cancellation).
#[must_use]
pub fn signed_volume(triangles: &[[DVec3; 3]], origin: DVec3) -> f64 {
    triangles.iter().map(|t| t.map(|p| p - origin)).map(|[a, b, c]| a.dot(b.cross(c))).sum::<f64>() / 6.0
}

/// Share of a triangle's size by which a point is pulled off it: more than rounding, less than walls are thick.
const OFF_THE_SURFACE: f64 = 1e-4;

/// A point beside a triangle of a shell, within it if the shell has that `volume`. None if the triangle has no area.
#[must_use]
pub fn just_within(triangle: &[DVec3; 3], volume: f64) -> Option<DVec3> {
    let [a, b, c] = triangle;
    beside(triangle, (a + b + c) / 3.0, volume)
}

/// The same beside a point of it.
#[must_use]
pub fn beside([a, b, c]: &[DVec3; 3], at: DVec3, volume: f64) -> Option<DVec3> {
    let normal = (b - a).cross(c - a) * volume.signum();
    let twice_area = normal.length();
    (twice_area != 0.0).then(|| at - normal * (OFF_THE_SURFACE / twice_area.sqrt()))
}
