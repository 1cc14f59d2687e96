//! From bounds of the solid to open fractions, and what is counted on the way.

use super::report::LayerReport;
use super::slices::LayerSlices;
use crate::grid::fields::Layer;
use crate::number::real::{Real, Vector};
use crate::surface::division::Site;

/// So many cells are looked at at once, whether they are open.
const BLOCK: usize = 8;

/// Count the cells of a layer and add up their solid volume.
pub(super) fn count_cells<V: Vector>(
    site: &Site<V>,
    layer: &Layer<V::Scalar>,
    end: V::Scalar,
    report: &mut LayerReport<V::Scalar>,
) {
    let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
    let nx = site.grid.cells()[0].max(1);
    let [x, y, z] = [0, 1, 2].map(|axis| site.grid.edges(axis));
    let width = |pair: &[V::Scalar]| if let [lo, hi] = pair { *hi - *lo } else { zero };
    let height = z.windows(2).skip(site.k).map(width).next().unwrap_or(zero);
    let Layer { lower, sum, has_surface } = layer;
    let rows = lower.cell.chunks_exact(nx).zip(sum.cell.chunks_exact(nx)).zip(has_surface.cell.chunks_exact(nx));
    for (((lower, sum), has_surface), depth) in rows.zip(y.windows(2).map(width)) {
        let mut volume = zero;
        let blocks = lower.chunks(BLOCK).zip(sum.chunks(BLOCK)).zip(has_surface.chunks(BLOCK));
        for (n, ((lower, sum), has_surface)) in blocks.enumerate() {
            if nothing(lower, sum, has_surface) {
                report.cells.open += sum.len();
                continue;
            }
            let widths = x.get(n * BLOCK..).unwrap_or_default().windows(2).map(width);
            for (((&lower, &sum), &has_surface), width) in lower.iter().zip(sum).zip(has_surface).zip(widths) {
                let upper = sum.min(one);
                volume += (lower * (one - end) + upper * end) * width;
                if lower == one {
                    report.cells.closed += 1;
                } else if upper == zero && has_surface == 0 {
                    report.cells.open += 1;
                } else {
                    report.cells.cut += 1;
                }
            }
        }
        report.solid_volume += volume * depth * height;
    }
}

/// Is there nothing in some cells? Of a whole block that is asked at once.
#[inline(always)]
fn nothing<R: Real>(lower: &[R], sum: &[R], has_surface: &[u8]) -> bool {
    let whole = (<&[R; BLOCK]>::try_from(lower), <&[R; BLOCK]>::try_from(sum), <[u8; BLOCK]>::try_from(has_surface));
    let (Ok(lower), Ok(sum), Ok(has_surface)) = whole else {
        return lower.iter().chain(sum).all(|&x| x == R::ZERO) && has_surface.iter().all(|&s| s == 0);
    };
    let size = |n: usize| lower[n & 7].abs() + sum[n & 7].abs();
    let all = ((size(0) + size(1)) + (size(2) + size(3))) + ((size(4) + size(5)) + (size(6) + size(7)));
    all == R::ZERO && u64::from_ne_bytes(has_surface) == 0
}

/// Turn the solid bounds of a layer into open fractions, but for the faces above it. Leaves zeros in the sums.
pub(super) fn to_open_fractions<R: Real>(
    layer: &mut Layer<R>,
    areas: bool,
    bounds: Option<&mut [LayerSlices<R>; 2]>,
    end: R,
    max_gap: &mut R,
) {
    let (mut low, mut high) = match bounds {
        Some([low, high]) => (Some(low), Some(high)),
        None => (None, None),
    };
    let (lower, sum) = layer.cells_mut();
    open_field(lower, sum, low.as_mut().map(|s| &mut *s.cell), high.as_mut().map(|s| &mut *s.cell), end, max_gap);
    for axis in 0..3 {
        let (lower, sum) = layer.faces_mut(axis);
        if areas {
            let (low, high) = (low.as_mut().map(|s| s.faces(axis)), high.as_mut().map(|s| s.faces(axis)));
            open_field(lower, sum, low, high, end, max_gap);
        } else {
            sum.fill(R::ZERO);
        }
    }
}

/// Turn solid bounds into open fractions: the value, a share `end` of the way between them, goes to `lower`, the bounds to `low` and
/// `high` if wanted. Leaves zeros in `sum` for the next layer.
pub(super) fn open_field<R: Real>(
    lower: &mut [R],
    sum: &mut [R],
    low: Option<&mut [R]>,
    high: Option<&mut [R]>,
    end: R,
    max_gap: &mut R,
) {
    if let Some(low) = low {
        low.iter_mut().zip(&*sum).for_each(|(low, sum)| *low = R::ONE - sum.min(R::ONE));
    }
    if let Some(high) = high {
        high.iter_mut().zip(&*lower).for_each(|(high, lower)| *high = R::ONE - *lower);
    }
    let open = |l: &mut R, s: &mut R, widest: &mut R| {
        let upper = s.smaller(R::ONE);
        *widest = (upper - *l).larger(*widest);
        (*l, *s) = (R::ONE - (*l * (R::ONE - end) + upper * end), R::ZERO);
    };
    // Eight running maxima need no order, so the loop is done by vectors.
    let mut widest = [R::ZERO; BLOCK];
    let ((lower, lower_rest), (sum, sum_rest)) = (lower.as_chunks_mut::<BLOCK>(), sum.as_chunks_mut::<BLOCK>());
    for (l, s) in lower.iter_mut().zip(sum) {
        for n in 0..BLOCK {
            open(&mut l[n], &mut s[n], &mut widest[n]);
        }
    }
    for (l, s) in lower_rest.iter_mut().zip(sum_rest) {
        open(l, s, &mut widest[0]);
    }
    *max_gap = widest.into_iter().fold(*max_gap, R::max);
}
