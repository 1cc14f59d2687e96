//! One step on all threads.

use super::field::{Field, Scalar};
use crate::huge::HugeVec;
use rayon::prelude::*;
use voidage_core::flow::{AnyGas, Error, Problem, Report};

/// One step on rayon's threads: slabs side by side, merging, fallback, floors, as [`Problem::step`].
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
    let attempt =
        |new: &mut Field<R, D>, scratch: &mut [HugeVec<R>], marks: Option<&[u8]>| -> Result<Report<R, D>, Error> {
            let layer = problem.mesh().layer();
            let mut rest = new.view_mut();
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
            let mut report = reports?.iter().fold(Report::new(), |a, b| a.and(b));
            problem.merge(&old.view(), &mut new.view_mut(), &mut report)?;
            Ok(report)
        };
    let mut report = attempt(new, scratch, None)?;
    if report.unphysical == 0 {
        return Ok(report);
    }
    marks.fill(0);
    for _ in 0..voidage_core::flow::fallback::FALLBACKS {
        if problem.mark_troubled(&new.view(), marks)? == 0 {
            break;
        }
        report = attempt(new, scratch, Some(marks))?;
        if report.unphysical == 0 {
            return Ok(report);
        }
    }
    problem.apply_floors(&old.view(), &mut new.view_mut(), &mut report)?;
    Ok(report)
}
