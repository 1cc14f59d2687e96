//! Polygons on their way down the trees of a cell.

use super::bsp::{Branch, Node, Part};
use super::octree::{Octree, ToAsk};
use super::piece::NoProof::{self, Ambiguous, Full};
use super::piece::{AMBIGUITY_BAND, Ball, Place, cut, place, span};
use crate::number::real::Real;
use crate::number::space::dot;
use crate::surface::clip::Polygon;

/// Fragments smaller than this, in faces of the cell, cannot do harm.
const SLIVER: f64 = 1e-9;

/// Where no more bodies than this meet in a cell, to ask whether a polygon meets a body before it is cut costs more than the cuts.
const FEW: usize = 8;

/// A polygon on its way down the trees.
#[derive(Clone, Debug, Default)]
pub struct Fragment<R: Real> {
    polygon: Polygon<R>,
    /// Around the polygon, or one that it is a part of.
    ball: Ball<R>,
    to_ask: ToAsk,
    /// It has been cut since the ball was put around it.
    is_cut: bool,
    part: usize,
    branch: Branch,
    /// Coincident planes are taken towards the inner side of the polygon, not the outer one.
    inward: bool,
    /// It met a coincident plane of the same orientation.
    twin: bool,
    /// It, or what it is a part of, reaches solid of the body whose tree it goes down.
    meets: bool,
}

/// How a polygon goes down.
#[derive(Clone, Copy)]
pub(super) struct DescentRule<R> {
    /// Where it lies in a plane of a tree, it follows this direction.
    pub toward: [R; 3],
    /// The body whose tree it does not meet.
    pub own: Option<usize>,
    /// Bodies marked `below` take the opposite direction.
    pub both_sides: bool,
}

/// The trees of a cell and the fragments under way, a stack.
pub(super) struct Descent<'a, R: Real> {
    pub nodes: &'a [Node<R>],
    pub parts: &'a [Part<R>],
    pub fragments: &'a mut [Fragment<R>],
    pub octree: Octree<'a, R>,
    pub spare: Polygon<R>,
    pub thickness: R,
}

impl<R: Real> Descent<'_, R> {
    /// Send a polygon down all trees but its own; hand what ends in no solid leaf to `keep`.
    pub fn send(
        &mut self,
        polygon: &Polygon<R>,
        ball: Ball<R>,
        rule: DescentRule<R>,
        mut keep: impl FnMut(&Polygon<R>),
    ) -> Result<(), NoProof> {
        let parts = self.parts;
        let first = self.fragments.first_mut().ok_or(Full)?;
        first.polygon.assign(polygon);
        (first.ball, first.is_cut, first.to_ask) = (ball, false, ToAsk::default());
        self.octree.locate(&mut first.to_ask, polygon, &ball, 0);
        first.enter(parts, &mut self.octree, 0, rule.own);
        let mut waiting: usize = 1;
        while let Some(top) = waiting.checked_sub(1) {
            let f = self.fragments.get_mut(top).ok_or(Full)?;
            let Some(part) = parts.get(f.part) else {
                keep(&f.polygon);
                waiting = top;
                continue;
            };
            let node = match f.branch {
                Branch::Solid => {
                    waiting = top;
                    continue;
                }
                Branch::Open if f.twin && !f.inward && rule.own.is_some_and(|own| f.part < own) => {
                    (f.inward, f.branch) = (true, part.root);
                    continue;
                }
                Branch::Open => {
                    f.enter(parts, &mut self.octree, f.part + 1, rule.own);
                    continue;
                }
                Branch::Node(n) => self.nodes.get(n as usize).ok_or(Full)?,
            };
            match f.place(node, self.thickness)? {
                Place::Positive => f.branch = node.positive,
                Place::Negative => f.branch = node.negative,
                Place::On => {
                    let along = dot(node.plane.normal, rule.toward) > R::ZERO;
                    f.twin |= along;
                    let positive = along != (f.inward || (rule.both_sides && part.below));
                    f.branch = if positive { node.positive } else { node.negative };
                }
                // Cuts between one open part and another would make work for all trees that follow.
                Place::Across if parts.len() > FEW && !f.meets && self.ends_open(top) => {}
                Place::Across => {
                    self.cut(top, node)?;
                    waiting += 1;
                }
            }
        }
        Ok(())
    }

    /// Ends the fragment at `top` in the open and returns true if no part of it reaches solid below its branch. Else, also where planes coincide or
    /// memory is spent, sets its `meets` and returns false.
    fn ends_open(&mut self, top: usize) -> bool {
        let open = self.reaches_no_solid(top) == Some(true);
        if let Some(f) = self.fragments.get_mut(top) {
            f.meets = !open;
            f.branch = if open { Branch::Open } else { f.branch };
        }
        open
    }

    /// Send a copy of the fragment at `top` down the rest of the tree; none where a plane coincides or memory is spent.
    fn reaches_no_solid(&mut self, top: usize) -> Option<bool> {
        let [f, copy] = self.fragments.get_mut(top..)?.first_chunk_mut()?;
        copy.polygon.assign(&f.polygon);
        (copy.ball, copy.branch) = (f.ball, f.branch);
        let mut waiting = top + 2;
        while waiting > top + 1 {
            let last = waiting - 1;
            let part = self.fragments.get_mut(last)?;
            let node = match part.branch {
                Branch::Solid => return Some(false),
                Branch::Open => {
                    waiting = last;
                    continue;
                }
                Branch::Node(n) => self.nodes.get(n as usize)?,
            };
            match part.place(node, self.thickness).ok()? {
                Place::Positive => part.branch = node.positive,
                Place::Negative => part.branch = node.negative,
                Place::On => return None,
                Place::Across => {
                    self.cut(last, node).ok()?;
                    waiting += 1;
                }
            }
        }
        Some(true)
    }

    /// Replace the fragment at `top` by its two parts, what lies behind the plane of a node on top; a full one by its halves.
    fn cut(&mut self, top: usize, node: &Node<R>) -> Result<(), NoProof> {
        let [f, next] = self.fragments.get_mut(top..).and_then(|f| f.first_chunk_mut()).ok_or(Full)?;
        f.is_cut = true;
        let Fragment { polygon: _, ball, to_ask, is_cut, part, branch, inward, twin, meets } = *f;
        (next.ball, next.to_ask, next.is_cut, next.part, next.branch) = (ball, to_ask, is_cut, part, branch);
        (next.inward, next.twin, next.meets) = (inward, twin, meets);
        if f.polygon.is_full() {
            [next.polygon, f.polygon] = f.polygon.halves();
        } else {
            cut(&f.polygon, &node.plane, &mut next.polygon, &mut self.spare);
            f.polygon.assign(&self.spare);
            (next.branch, f.branch) = (node.negative, node.positive);
        }
        Ok(())
    }
}

impl<R: Real> Fragment<R> {
    /// Go to the root of the tree of a body, or of the next one after it that the polygon may meet and that is not its own.
    #[inline(always)]
    fn enter(&mut self, parts: &[Part<R>], octree: &mut Octree<R>, part: usize, own: Option<usize>) {
        if self.is_cut && parts.len() > FEW {
            self.draw_ball(octree, part);
        }
        self.part = if Some(part) == own { part + 1 } else { part };
        if self.to_ask.is_listed {
            self.part = octree.next_body(&mut self.to_ask, part, own);
        }
        self.branch = parts.get(self.part).map_or(Branch::Open, |p| p.root);
        (self.inward, self.twin, self.meets) = (false, false, false);
    }

    /// Where many trees follow, a ball around what is left tells it from most planes, and from most bodies.
    #[inline(never)]
    fn draw_ball(&mut self, octree: &mut Octree<R>, part: usize) {
        (self.ball, self.is_cut) = (Ball::around(&self.polygon), false);
        octree.locate(&mut self.to_ask, &self.polygon, &self.ball, part);
    }

    #[inline(always)]
    fn place(&self, node: &Node<R>, thickness: R) -> Result<Place, NoProof> {
        let ambiguous = thickness * R::from_f64(AMBIGUITY_BAND);
        if let Some(place) = self.ball.place(&node.plane, ambiguous) {
            return Ok(place);
        }
        let span = span(&self.polygon, &node.plane);
        let found = place(span, thickness);
        // Not quite one plane, not clearly two: another piece of the same faces may be judged otherwise.
        let unsure = found != Place::On
            && place(span, ambiguous) == Place::On
            && self.polygon.doubled_area().iter().any(|a| a.abs() > R::from_f64(SLIVER));
        if unsure { Err(Ambiguous) } else { Ok(found) }
    }
}
