//! Porosity of solids by formula, and of bodies of triangles beside them.

use crate::body::solid;
use crate::input::{Arrays, give, given};
use crate::memory::{Cut, Measure, Memory};
use crate::status::{Answer, Status};
use crate::surface::{Checked, Question, Reply, SurfaceWork, run};
use crate::types::{Body, Grid, Options, PorosityReport, Scene};
use voidage_core::number::real::{Real, Vector};
use voidage_core::solids::{RoundMemory, RoundShape, RoundSolid, RoundSolids};
use voidage_core::subdivide::{Candidate, LeafRule, SubdivisionMemory, SubdivisionRule};

/// The solids of the caller, checked.
struct CheckedSolids<'a, V: Vector> {
    bodies: &'a [Body<V::Scalar>],
}

/// What is asked of a scene: its surfaces, and its solids.
type CheckedScene<'a, V> = (Checked<'a, V>, CheckedSolids<'a, V>);

#[inline(never)]
unsafe fn checked<'a, R: Real>(asked: &Asked<R>, arrays: &mut Arrays) -> Answer<CheckedScene<'a, R::Vector>> {
    let scene = unsafe { given(asked.scene, c"scene")? };
    let question = Question { grid: asked.grid, surface: scene.surface, options: asked.options };
    let question = unsafe { question.checked(arrays)? };
    let bodies = unsafe { arrays.read(scene.solids, scene.solid_count, c"scene.solids")? };
    for (index, body) in bodies.iter().enumerate() {
        solid(body).map_err(|refusal| refusal.index(index))?;
    }
    if u32::try_from(scene.solid_count).is_err() {
        return Err(Status::TooMany.of(c"scene.solid_count"));
    }
    Ok((question, CheckedSolids { bodies }))
}

/// What is asked.
#[derive(Clone, Copy)]
pub struct Asked<R> {
    pub grid: *const Grid<R>,
    pub scene: *const Scene<R>,
    pub options: *const Options<R>,
}

/// Memory for a scene.
struct SceneWork<'m, V: Vector> {
    surface: SurfaceWork<'m, V>,
    solids: &'m mut [RoundSolid<V>],
    memory: RoundMemory<'m, V>,
}

#[inline(never)]
fn work<'a: 'm, 'm, V: Vector, M: Memory<'m>>(
    asked: &Checked<'a, V>,
    solids: &CheckedSolids<V>,
    memory: &mut M,
) -> SceneWork<'m, V> {
    let count = solids.bodies.len();
    let needed = RoundSolids::<V>::needed(&asked.window.grid, count);
    let number = |n: usize| solids.bodies.get(n).and_then(|body| solid(body).ok());
    SceneWork {
        surface: asked.work(memory, count > 0),
        solids: match number(0) {
            // All of them have been checked, so none is missing.
            Some(first) => memory.take(count, |n| number(n).unwrap_or_else(|| first.clone())),
            None => &mut [],
        },
        memory: RoundMemory {
            sums: memory.take(needed.places, |_| V::Scalar::ZERO),
            owners: memory.take(needed.places, |_| 0),
            near: memory.take(needed.near, |_| RoundShape::default()),
            lists: SubdivisionMemory {
                candidates: memory.take(needed.candidates, |_| Candidate::default()),
                facets: memory.take(needed.facets, |_| 0),
            },
        },
    }
}

#[inline(never)]
fn bytes_for<V: Vector>(asked: &Checked<V>, solids: &CheckedSolids<V>) -> usize {
    let mut measure = Measure::new();
    work(asked, solids, &mut measure);
    measure.bytes()
}

/// Bytes of work for a scene.
///
/// # Safety
/// As of [`Arrays::read`].
pub unsafe fn work_bytes<R: Real>(asked: &Asked<R>) -> usize {
    let found = unsafe { checked(asked, &mut Arrays::new()) };
    found.map_or(usize::MAX, |(question, solids)| bytes_for(&question, &solids))
}

/// Porosity of a scene.
///
/// # Safety
/// As of [`Arrays::read`] and [`Arrays::write`]; the report is null or can be written.
pub unsafe fn porosity<R: Real>(asked: &Asked<R>, reply: &Reply<R>) -> Answer {
    let mut arrays = Arrays::new();
    unsafe {
        let (question, solids) = checked(asked, &mut arrays)?;
        let mut outputs = reply.checked(&mut arrays, &question.window)?;
        let needed = bytes_for(&question, &solids);
        arrays.work(reply.work, reply.bytes, needed)?;
        let SceneWork { surface, solids, memory } = work(&question, &solids, &mut Cut::new(reply.work, needed));
        let rule = SubdivisionRule { leaf: LeafRule::Plane, depth: question.options.depth, tol: question.options.tol };
        let others = RoundSolids::new(&question.window.grid, solids, rule, memory);
        let mut others = others.map_err(|_| Status::Memory.of(c"work"))?;
        let mut report = PorosityReport::default();
        run(&question, &mut outputs, surface, &mut others, &mut report)?;
        let queries = others.queries();
        (report.queries, report.undecided) = (queries.queries, queries.undecided);
        give(reply.report, report);
    }
    Ok(())
}
