//! What straight lines meet of a surface: clear of the edges of its triangles, or nothing is said.

use crate::geometry::repair::face::Face;
use crate::geometry::repair::tree::Tree;
use glam::DVec3;

/// A line flatter to a plane than this, as the sine of its angle, tells nothing of its triangle.
pub const FLAT: f64 = 1e-4;

/// Lines clear of edges by so many tolerances of points on planes tell where they pass.
const CLEAR: f64 = 64.0;

/// So many lines are tried from a point.
const TRIES: usize = 8;

/// Triangles, and how far a line must be from their edges.
pub struct Lines<'a> {
    faces: &'a [Face],
    tree: &'a Tree,
    /// Lines pass an edge at this distance at least.
    pub clear: f64,
}

/// What a line meets.
#[derive(Debug)]
pub struct Way {
    /// The distance of each triangle that it passes through, and its number.
    pub through: Vec<(f64, u32)>,
    /// From this distance on it is not known what the line meets.
    pub unclear: Option<f64>,
    /// The distance of the first triangle that it passes through, or from which it is not known what it meets.
    nearest: f64,
    /// So many boxes around triangles were looked at.
    pub looked_at: usize,
}

impl Way {
    fn unclear_from(&mut self, along: f64) {
        self.unclear = Some(self.unclear.map_or(along, |u| u.min(along)));
        self.nearest = self.nearest.min(along);
    }

    fn passes(&mut self, along: f64, m: u32) {
        self.through.push((along, m));
        self.nearest = self.nearest.min(along);
    }
}

impl<'a> Lines<'a> {
    /// Through triangles, in their tree; points closer than `on` to a plane or line are on it.
    #[must_use]
    pub fn new(faces: &'a [Face], tree: &'a Tree, on: f64) -> Self {
        Lines { faces, tree, clear: CLEAR * on }
    }

    /// Distances along a line are known to this.
    #[must_use]
    pub fn slack(&self) -> f64 {
        self.clear / FLAT
    }

    /// What a line from a point in a direction of length 1 meets, without the triangles `own`; of what lies beyond the distance that `last` tells from what is
    /// found so far, nothing need be found. Triangles without an area count as nothing.
    fn follow(&self, from: DVec3, direction: DVec3, own: &[u32], last: impl Fn(&Way) -> f64) -> Way {
        let mut way = Way { through: Vec::new(), unclear: None, nearest: f64::INFINITY, looked_at: 0 };
        let looked_at = self.tree.along(from, direction, self.slack(), |m, enters| {
            if !own.contains(&m) {
                self.pass(&mut way, (from, direction), m, enters);
            }
            last(&way)
        });
        way.looked_at = looked_at;
        way
    }

    /// What a line meets first, with all that it may meet as early.
    #[must_use]
    pub fn first(&self, from: DVec3, direction: DVec3, own: &[u32]) -> Way {
        self.follow(from, direction, own, |way| way.nearest + 3.0 * self.slack())
    }

    /// Adds what a line meets of a triangle whose box it enters.
    fn pass(&self, way: &mut Way, (from, direction): (DVec3, DVec3), m: u32, enters: f64) {
        let face = &self.faces[m as usize];
        if face.normal == DVec3::ZERO {
            return;
        }
        let slope = face.normal.dot(direction);
        if slope.abs() < FLAT {
            return way.unclear_from(enters);
        }
        let along = -face.height(from) / slope;
        let doubt = self.clear / slope.abs();
        if along < -doubt {
            return;
        }
        let room = face.inward(from + direction * along).into_iter().fold(f64::INFINITY, f64::min);
        if room < -doubt {
            return;
        }
        if room < doubt || along < doubt {
            way.unclear_from(along);
        } else {
            way.passes(along, m);
        }
    }

    /// How often the surface winds around what lies just before a point of it, on the side towards which `normal` looks; `own` are the triangles that lie
    /// there. The surface must be closed. None if all lines that were tried pass too close to an edge.
    #[must_use]
    pub fn winding(&self, from: DVec3, normal: DVec3, own: &[u32]) -> Option<i32> {
        let crossing = |direction: DVec3, m: u32| {
            if self.faces[m as usize].normal.dot(direction) > 0.0 { 1 } else { -1 }
        };
        directions(normal, 0).find_map(|direction| {
            let way = self.follow(from, direction, own, |_| f64::INFINITY);
            way.unclear.is_none().then(|| way.through.iter().map(|&(_, m)| crossing(direction, m)).sum())
        })
    }
}

/// Directions of length 1 about a normal, each leaning more; others for another number.
pub fn directions(ahead: DVec3, number: usize) -> impl Iterator<Item = DVec3> {
    let (u, v) = ahead.any_orthonormal_pair();
    (0..TRIES).map(move |n| {
        // The golden angle spreads the directions; no two lines of a lattice are alike.
        let turn = 2.399_963 * n as f64 + 0.7 * number as f64 + 0.3;
        let lean = 0.11 + 0.41 * n as f64;
        (ahead + (u * turn.cos() + v * turn.sin()) * lean).normalize()
    })
}
