//! One step on all threads.

use super::field::{Field, Scalar};
use super::watch::Watch;
use crate::huge::HugeVec;
use rayon::prelude::*;
use voidage_core::flow::{AnyGas, Error, Problem, Report, WatchedWalls};

/// What steps write besides the new field.
pub(super) struct Working<'w, R: Scalar, const D: usize> {
    pub marks: &'w mut [u8],
    /// For each thread.
    pub scratch: &'w mut Vec<HugeVec<R>>,
    pub watch: Option<&'w mut Watch<R, D>>,
}

/// One step on rayon's threads, slabs side by side.
pub(super) fn step<R: Scalar, const D: usize>(
    problem: &Problem<'_, R, D>,
    old: &Field<R, D>,
    new: &mut Field<R, D>,
    working: Working<'_, R, D>,
    dt: R,
) -> Result<Report<R, D>, Error> {
    let Working { marks, scratch, mut watch } = working;
    let layers = problem.mesh().cells()[D - 1];
    // A slab of few layers spends its time on the layers beside it.
    const LEAST_LAYERS: usize = 6;
    let threads = rayon::current_num_threads().min(layers / LEAST_LAYERS).max(1);
    let threads = if D == 1 { 1 } else { threads };
    while scratch.len() < threads {
        scratch.push(HugeVec::zeros(problem.scratch_len()));
    }
    let scratch = &mut scratch[..threads];
    let layer = problem.mesh().layer();
    problem.step_in_slabs(&old.view(), &mut new.view_mut(), marks, |new, marks| {
        let mut rest = new.reborrow();
        let mut walls = watch.as_mut().map(|watch| watch.walls());
        let mut slabs = Vec::with_capacity(threads);
        let mut begin = 0;
        for t in 0..threads {
            let end = layers * (t + 1) / threads;
            let (slab, above) = rest.split_at((end - begin) * layer);
            let (of_slab, walls_above) = walls.map_or((None, None), |walls| split_below(walls, end * layer));
            slabs.push((begin..end, slab, of_slab));
            (rest, walls, begin) = (above, walls_above, end);
        }
        let advance = |(range, mut slab, walls), scratch: &mut HugeVec<R>| match walls {
            None => problem.advance_slab_by::<AnyGas>(&old.view(), &mut slab, range, dt, marks, scratch),
            Some(walls) => {
                let how = (dt, marks);
                problem.advance_slab_watching::<AnyGas>(&old.view(), &mut slab, range, how, walls, scratch)
            }
        };
        let slabs = slabs.into_par_iter().zip(scratch.par_iter_mut());
        let reports: Result<Vec<_>, Error> = slabs.map(|(slab, scratch)| advance(slab, scratch)).collect();
        Ok(reports?.iter().fold(Report::new(), |a, b| a.and(b)))
    })
}

/// Watched walls in two: of the cells below one, and of the others.
fn split_below<R: Scalar, const D: usize>(
    walls: WatchedWalls<'_, R, D>,
    cell: usize,
) -> (Option<WatchedWalls<'_, R, D>>, Option<WatchedWalls<'_, R, D>>) {
    let WatchedWalls { cells, pushes, reference } = walls;
    let (below, above) = cells.split_at(cells.partition_point(|&c| c < cell));
    let (pushes, pushes_above) = pushes.split_at_mut(below.len());
    let of = |cells, pushes| Some(WatchedWalls { cells, pushes, reference });
    (of(below, pushes), of(above, pushes_above))
}
