//! One step on all threads.

use super::field::{Field, Scalar};
use crate::huge::HugeVec;
use rayon::prelude::*;
use voidage_core::flow::{AnyGas, Error, Problem, Report};

/// One step on rayon's threads, slabs side by side.
pub(super) fn step<R: Scalar, const D: usize>(
    problem: &Problem<'_, R, D>,
    old: &Field<R, D>,
    new: &mut Field<R, D>,
    marks: &mut [u8],
    scratch: &mut Vec<HugeVec<R>>,
    dt: R,
) -> Result<Report<R, D>, Error> {
    let layers = problem.mesh().cells()[D - 1];
    // A slab of few layers spends its time on the layers beside it.
    const LEAST_LAYERS: usize = 6;
    let threads = rayon::current_num_threads().min(layers / LEAST_LAYERS).max(1);
    let threads = if D == 1 { 1 } else { threads };
    while scratch.len() < threads {
        scratch.push(HugeVec::zeros(problem.scratch_len()));
    }
    let scratch = &mut scratch[..threads];
    if let [one] = scratch {
        return problem.step_by::<AnyGas>(&old.view(), &mut new.view_mut(), dt, marks, one);
    }
    let layer = problem.mesh().layer();
    problem.step_in_slabs(&old.view(), &mut new.view_mut(), marks, |new, marks| {
        let mut rest = new.reborrow();
        let mut slabs = Vec::with_capacity(threads);
        let mut begin = 0;
        for t in 0..threads {
            let end = layers * (t + 1) / threads;
            let (slab, above) = rest.split_at((end - begin) * layer);
            slabs.push((begin..end, slab));
            rest = above;
            begin = end;
        }
        let reports: Result<Vec<_>, Error> = slabs
            .into_par_iter()
            .zip(scratch.par_iter_mut())
            .map(|((range, mut slab), scratch)| {
                problem.advance_slab_by::<AnyGas>(&old.view(), &mut slab, range, dt, marks, scratch)
            })
            .collect();
        Ok(reports?.iter().fold(Report::new(), |a, b| a.and(b)))
    })
}
