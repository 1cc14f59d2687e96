//! What of a solid by formula lies inside another one counts for nothing in their union, and is cut off before anything is measured: pipes in
//! their insulation, tubes in a tube sheet, a pipe through a flange.
//!
//! Rods, which are cylinders and cones, are cut across their axis where another rod holds them from side to side; other solids are left out if another one
//! holds them whole. A solid is cut by wider ones alone, or by one as wide that stands before it: no two take from each other what both have. A solid that is
//! more open than another takes nothing from it.

use super::pairs::of_touching_boxes;
use super::solid::{FormulaSolid, Kind};
use crate::porosity::convex::Convex;
use glam::DVec3;
use std::cmp::Ordering;
use voidage_core::convex::shape::{Cone, Cylinder, Ellipsoid};
use voidage_core::convex::support::Transformed;

/// Places nearer than this to each other are one, as a share of coordinates and sizes.
const SAME: f64 = 4.0 * f64::EPSILON;

/// Axes that differ by more than this sine are not along each other.
const ALONG: f64 = 1e-3;

/// Solids, in the order of their numbers, without what others hold; `porosity` is that of a body.
#[must_use]
pub fn without_nested(solids: Vec<FormulaSolid>, porosity: impl Fn(usize) -> f64 + Sync) -> Vec<FormulaSolid> {
    let held = |n: usize, m: usize| {
        let [a, b] = [n, m].map(|n| &solids[n]);
        // The narrower one is cut.
        let order = width(&a.kind).total_cmp(&width(&b.kind)).then(m.cmp(&n));
        let ((inner, held), holder) = if order == Ordering::Less { ((a, n), b) } else { ((b, m), a) };
        let counts = porosity(holder.body) <= porosity(inner.body);
        Some((held, held_part(&inner.kind, &holder.kind).filter(|_| counts)?))
    };
    let mut held: Vec<(usize, [Cut; 2])> = of_touching_boxes(&solids, held);
    if held.is_empty() {
        return solids;
    }
    held.sort_by_key(|(n, _)| *n);
    let (mut held, mut left) = (held.as_slice(), Vec::with_capacity(solids.len()));
    for (n, solid) in solids.into_iter().enumerate() {
        let own = held.partition_point(|(m, _)| *m == n);
        let (parts, rest) = held.split_at(own);
        held = rest;
        if parts.is_empty() {
            left.push(solid);
        } else {
            left.extend(outside(&solid, parts.iter().map(|(_, part)| *part)));
        }
    }
    left
}

/// How far a solid reaches from its axis or centre.
fn width(kind: &Kind) -> f64 {
    match kind {
        Kind::Torus(solid, _) => solid.size(),
        Kind::Quadric(_, Convex::Sphere(s)) => s.radius,
        Kind::Quadric(_, Convex::Capsule(s)) => s.radius,
        Kind::Quadric(_, Convex::Ellipsoid(s)) => s.shape().semi_axes.max_element(),
        Kind::Quadric(_, convex) => Rod::of(convex).map_or(0.0, |rod| rod.radii[0].max(rod.radii[1])),
    }
}

/// What is left of a solid without parts of it.
fn outside(solid: &FormulaSolid, held: impl Iterator<Item = [Cut; 2]>) -> Vec<FormulaSolid> {
    let mut left = vec![[Cut::START, Cut::END]];
    for [from, to] in held {
        let before = left.iter().map(|part| [part[0], if part[1].at < from.at { part[1] } else { from }]);
        let behind = left.iter().map(|part| [if part[0].at > to.at { part[0] } else { to }, part[1]]);
        left = before.chain(behind).filter(|[from, to]| from.at < to.at).collect();
    }
    let Kind::Quadric(_, convex) = &solid.kind else { return Vec::new() };
    let Some(rod) = Rod::of(convex) else { return Vec::new() };
    let part = |[from, to]: [Cut; 2]| FormulaSolid::new(solid.body, rod.part([from, to])?);
    left.sort_by(|a, b| a[0].at.total_cmp(&b[0].at));
    left.into_iter().filter_map(part).collect()
}

/// A place along the axis of a rod, from 0 to 1, and the end of another solid at which it is, if it is one.
#[derive(Clone, Copy)]
struct Cut {
    at: f64,
    end: Option<DVec3>,
}

impl Cut {
    const START: Self = Cut { at: 0.0, end: None };
    const END: Self = Cut { at: 1.0, end: None };
}

/// Which part of a solid another one holds: of one that is no rod, all or nothing.
fn held_part(inner: &Kind, holder: &Kind) -> Option<[Cut; 2]> {
    let whole = [Cut::START, Cut::END];
    let (inner, holder) = match (inner, holder) {
        (Kind::Torus(inner, _), Kind::Torus(holder, _)) => return holder.holds(inner).then_some(whole),
        (Kind::Quadric(_, inner), Kind::Quadric(_, holder)) => (inner, holder),
        _ => return None,
    };
    if let (Convex::Ellipsoid(inner), Convex::Ellipsoid(holder)) = (inner, holder) {
        return is_about(holder, inner).then_some(whole);
    }
    let holder = Holder::of(holder)?;
    let is_held = match inner {
        Convex::Sphere(s) => holder.holds_ball(s.center, s.radius),
        Convex::Capsule(s) => [s.from, s.to].into_iter().all(|center| holder.holds_ball(center, s.radius)),
        Convex::Ellipsoid(s) => holder.holds_ball(s.apply(s.shape().center), s.shape().semi_axes.max_element()),
        _ => {
            let rod = Rod::of(inner)?;
            let (_, axis) = rod.axis();
            if !(0..2).all(|n| holder.holds_disc(rod.ends[n], axis, rod.radii[n])) {
                return rod.held_along(&holder.rod?);
            }
            true
        }
    };
    is_held.then_some(whole)
}

/// Is one ellipsoid about the other, with the same centre and directions of axes?
fn is_about(holder: &Transformed<Ellipsoid<DVec3>>, inner: &Transformed<Ellipsoid<DVec3>>) -> bool {
    let center = |s: &Transformed<Ellipsoid<DVec3>>| s.apply(s.shape().center);
    let half = |s: &Transformed<Ellipsoid<DVec3>>, axis: DVec3| {
        s.apply(s.shape().center + axis * s.shape().semi_axes) - center(s)
    };
    let is_longer = |axis: DVec3| {
        let (outer, inner) = (half(holder, axis), half(inner, axis));
        let (length, limit) = (inner.length(), outer.length());
        inner.cross(outer).length() <= SAME * length * limit && length <= limit * (1.0 + SAME)
    };
    center(holder) == center(inner) && DVec3::AXES.into_iter().all(is_longer)
}

/// A cylinder or cone: its radius changes evenly along its axis.
#[derive(Clone, Copy)]
struct Rod {
    ends: [DVec3; 2],
    radii: [f64; 2],
}

impl Rod {
    fn of(solid: &Convex) -> Option<Self> {
        match solid {
            Convex::Cylinder(s) => Some(Rod { ends: s.ends(), radii: [s.base_radius(); 2] }),
            Convex::Cone(s) => Some(Rod { ends: s.ends(), radii: [s.base_radius(), s.top_radius()] }),
            _ => None,
        }
    }

    /// Its length, and the direction of its axis.
    fn axis(&self) -> (f64, DVec3) {
        let axis = self.ends[1] - self.ends[0];
        (axis.length(), axis.normalize_or_zero())
    }

    /// What places may be off by through rounding.
    fn room(&self) -> f64 {
        let far = self.ends.map(|p| p.abs().max_element());
        SAME * (far[0].max(far[1]) + self.radii[0].max(self.radii[1]))
    }

    fn radius_at(&self, at: f64) -> f64 {
        self.radii[0] + at * (self.radii[1] - self.radii[0])
    }

    /// How far along the axis a point is, and its distance from the axis.
    fn place(&self, p: DVec3) -> (f64, f64) {
        let (_, axis) = self.axis();
        let along = (p - self.ends[0]).dot(axis);
        (along, (p - self.ends[0] - axis * along).length())
    }

    /// The part of it that another rod along it holds, from side to side; none if there is none.
    fn held_along(&self, holder: &Rod) -> Option<[Cut; 2]> {
        let ((length, axis), (height, along)) = (self.axis(), holder.axis());
        let sine = axis.cross(along).length();
        if !(sine < ALONG && length > 0.0 && height > 0.0) {
            return None;
        }
        let room = self.room() + holder.room();
        // A disc across the one axis reaches so far along the other.
        let reach = self.radii[0].max(self.radii[1]) * sine;
        let [(low, off), (high, off_high)] = self.ends.map(|p| holder.place(p));
        let steepness = (holder.radii[1] - holder.radii[0]) / height;
        let free = [low, high].map(|s| holder.radius_at(s / height) - (steepness * reach).abs() - off.max(off_high));
        let free = [free[0] - self.radii[0], free[1] - self.radii[1]].map(|free| free + room);
        let part = positive(free)?;
        // Between the ends of the holder.
        let rise = high - low;
        let at = |s: f64| (s - low) / rise;
        let (first, last) = (at(reach.min(0.5 * height)), at((height - reach).max(0.5 * height)));
        let mut cuts = [(first, holder.ends[0]), (last, holder.ends[1])].map(|(at, end)| Cut { at, end: Some(end) });
        if rise < 0.0 {
            cuts.reverse();
        }
        let inside = |at: f64| Cut { at, end: None };
        let from = if cuts[0].at > part[0] { cuts[0] } else { inside(part[0]) };
        let to = if cuts[1].at < part[1] { cuts[1] } else { inside(part[1]) };
        let near = room / length;
        let from = if from.at <= near { Cut::START } else { from };
        let to = if to.at >= 1.0 - near { Cut::END } else { to };
        (from.at < to.at).then_some([from, to])
    }

    /// The part between two places as a solid; none if it is no thicker than rounding.
    fn part(&self, cuts: [Cut; 2]) -> Option<Convex<'static>> {
        let [from, to] = cuts.map(|cut| self.point(cut));
        let radii = cuts.map(|cut| self.radius_at(cut.at));
        if !(from.distance(to) > 2.0 * self.room()) {
            return None;
        }
        Some(if radii[0] == radii[1] {
            Convex::Cylinder(Cylinder::new(from, to, radii[0]))
        } else {
            Convex::Cone(Cone::truncated(from, to, radii[0], radii[1]))
        })
    }

    /// Where a cut crosses the axis. If that runs along an axis of the grid, and the cut is where another solid ends, then it is there to the bit.
    fn point(&self, Cut { at, end }: Cut) -> DVec3 {
        if at <= 0.0 || at >= 1.0 {
            return self.ends[usize::from(at >= 1.0)];
        }
        let axis = self.ends[1] - self.ends[0];
        let mut point = self.ends[0] + axis * at;
        let mut running = [0, 1, 2].into_iter().filter(|&n| axis[n] != 0.0);
        if let (Some(end), Some(n), None) = (end, running.next(), running.next()) {
            point[n] = end[n];
        }
        point
    }
}

/// Where a value that changes evenly from 0 to 1 is not negative.
fn positive([first, last]: [f64; 2]) -> Option<[f64; 2]> {
    let zero = first / (first - last);
    match (first >= 0.0, last >= 0.0) {
        (true, true) => Some([0.0, 1.0]),
        (true, false) => Some([0.0, zero]),
        (false, true) => Some([zero, 1.0]),
        _ => None,
    }
}

/// A solid that may hold others: a rod, and balls about its ends.
struct Holder {
    rod: Option<Rod>,
    balls: Option<([DVec3; 2], f64)>,
}

impl Holder {
    fn of(solid: &Convex) -> Option<Self> {
        match solid {
            Convex::Sphere(s) => Some(Holder { rod: None, balls: Some(([s.center; 2], s.radius)) }),
            Convex::Capsule(s) => {
                let (ends, radius) = ([s.from, s.to], s.radius);
                Some(Holder { rod: Some(Rod { ends, radii: [radius; 2] }), balls: Some((ends, radius)) })
            }
            _ => Some(Holder { rod: Some(Rod::of(solid)?), balls: None }),
        }
    }

    fn holds_ball(&self, center: DVec3, radius: f64) -> bool {
        let far = center.abs().max_element() + radius;
        let in_rod = self.rod.is_some_and(|rod| {
            let (height, _) = rod.axis();
            let ((along, off), room) = (rod.place(center), rod.room() + SAME * far);
            let steepness = (rod.radii[1] - rod.radii[0]) / height;
            let wall = rod.radius_at(along / height) - radius * (1.0 + steepness * steepness).sqrt();
            height > 0.0 && along + room >= radius && along + radius <= height + room && off <= wall + room
        });
        let in_balls = self.balls.is_some_and(|(centers, of_ball)| {
            centers.into_iter().any(|c| c.distance(center) + radius <= of_ball + SAME * (far + of_ball))
        });
        in_rod || in_balls
    }

    fn holds_disc(&self, center: DVec3, axis: DVec3, radius: f64) -> bool {
        let far = center.abs().max_element() + radius;
        let in_rod = self.rod.is_some_and(|rod| {
            let (height, along_rod) = rod.axis();
            let ((along, off), room) = (rod.place(center), rod.room() + SAME * far);
            let reach = radius * axis.cross(along_rod).length();
            let [low, high] = [along - reach, along + reach];
            let wall = rod.radius_at(low / height).min(rod.radius_at(high / height));
            height > 0.0 && low >= -room && high <= height + room && off + radius <= wall + room
        });
        let in_balls = self.balls.is_some_and(|(centers, of_ball)| {
            centers.into_iter().any(|c| {
                let along = (center - c).dot(axis);
                let off = (center - c - axis * along).length();
                along.hypot(off + radius) <= of_ball + SAME * (far + of_ball)
            })
        });
        in_rod || in_balls
    }
}
