//! The calls by which cases ask the program, the public ones that linked programs use. Every result that a case judges comes through here.
//!
//! After [`spoil_results`], which is for tests of the battery only, every result is spoiled by a thousandth or two, no two by the same, and
//! every hundredth answer about two bodies is another one: a case that still passes judges nothing.

use crate::error::Result;
use crate::flow::Flow;
use crate::geometry::bodies::Bodies;
use crate::grid::Edges;
use crate::porosity::{Options, Porosity, porosity};
use glam::DVec3;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use voidage_core::convex::exact::Contact;
use voidage_core::convex::{AnyBody, Clearance, distance, meets};
use voidage_core::flow::Error as FlowError;

/// Whether results are spoiled in this run.
static SPOILED: AtomicBool = AtomicBool::new(false);

/// How many results were asked for, if they are spoiled.
static ASKED: AtomicUsize = AtomicUsize::new(0);

/// From now on every result is spoiled.
pub fn spoil_results() {
    SPOILED.store(true, Ordering::Relaxed);
}

/// The number of this result among those asked for, if it is to be spoiled.
fn asked() -> Option<usize> {
    SPOILED.load(Ordering::Relaxed).then(|| ASKED.fetch_add(1, Ordering::Relaxed))
}

/// By how much this result is to be spoiled, if it is: another amount for each.
fn fault() -> Option<f64> {
    asked().map(|n| 1e-3 + 1e-6 * (n % 1000) as f64)
}

/// Whether this answer about two bodies is to be spoiled.
fn wrong_answer() -> bool {
    asked().is_some_and(|n| n.is_multiple_of(100))
}

/// Porosities of bodies on a grid.
///
/// # Errors
/// Edges that make no grid.
pub fn measure(edges: &Edges, bodies: &Bodies, options: Options) -> Result<Porosity> {
    let mut found = porosity(&edges.grid(None)?, bodies, options);
    if let Some(fault) = fault() {
        let spoil = |fields: &mut [f64]| fields.iter_mut().for_each(|b| *b = (*b - fault).abs());
        spoil(&mut found.beta.v);
        if let Some([_, upper]) = &mut found.bounds {
            spoil(&mut upper.v);
        }
        found.solid_volume *= 1.0 + fault;
    }
    Ok(found)
}

/// Do two bodies meet? None if that is undecided.
#[must_use]
pub fn contact(a: &AnyBody<'_, DVec3>, b: &AnyBody<'_, DVec3>) -> Option<Contact> {
    let found = meets(a, b).contact();
    match (wrong_answer(), found) {
        (false, found) => found,
        (true, Some(Contact::Disjoint)) => Some(Contact::Overlapping),
        (true, _) => Some(Contact::Disjoint),
    }
}

/// Bounds of the distance of two bodies, and the distance between them; 0 if they meet, infinite bounds if nothing is known.
#[must_use]
pub fn clearance(a: &AnyBody<'_, DVec3>, b: &AnyBody<'_, DVec3>) -> [f64; 3] {
    let found = match distance(a, b) {
        Clearance::Apart { distance, lower, upper, .. } => [lower, distance, upper],
        Clearance::Undecided { lower, upper, .. } => [lower, lower, upper],
        _ => [0.0; 3],
    };
    if wrong_answer() { found.map(|x| 1.5 * x + 1e-3) } else { found }
}

/// Steps at a CFL number until a time.
///
/// # Errors
/// A state that is none.
pub fn run<const D: usize>(flow: &mut Flow<f64, D>, cfl: f64, end: f64) -> std::result::Result<(), FlowError> {
    flow.run(cfl, end)?;
    spoil(flow);
    Ok(())
}

/// A number of stable steps.
///
/// # Errors
/// A state that is none.
pub fn steps<const D: usize>(flow: &mut Flow<f64, D>, cfl: f64, count: usize) -> std::result::Result<(), FlowError> {
    for _ in 0..count {
        let dt = flow.stable_dt(cfl)?;
        // Where nothing can move, any step will do.
        if dt.is_finite() { flow.advance(cfl, f64::MAX).map(|_| ())? } else { flow.step(1.0).map(|_| ())? }
    }
    spoil(flow);
    Ok(())
}

/// A number of steps of a size, none repeated, whatever comes of them.
///
/// # Errors
/// A state that is none.
pub fn fixed_steps<const D: usize>(
    flow: &mut Flow<f64, D>,
    count: usize,
    size: impl Fn(&mut Flow<f64, D>) -> std::result::Result<f64, FlowError>,
) -> std::result::Result<(), FlowError> {
    for _ in 0..count {
        let dt = size(flow)?;
        flow.step(dt)?;
    }
    spoil(flow);
    Ok(())
}

fn spoil<const D: usize>(flow: &mut Flow<f64, D>) {
    let Some(fault) = fault() else { return };
    for cell in 0..flow.len() {
        let mut w = flow.get(cell);
        w.density *= 1.0 + fault;
        w.pressure *= 1.0 + fault * (1 + cell % 2) as f64;
        w.velocity = w.velocity.map(|u| u + fault * (w.pressure / w.density).sqrt());
        flow.set(cell, &w);
    }
}
