//! Bodies in one cell that planes tell apart: they have nothing in common.

use super::bsp::Part;
use super::piece::AMBIGUITY_BAND;
use crate::number::real::Real;

/// Where more bodies than this meet, all of them are one group.
const MOST: usize = 4096;

/// Number the groups of bodies that nothing tells apart, each by the place of its first one, and put them one after the other.
pub(super) fn gather<R: Real>(parts: &mut [Part<R>], thickness: R) {
    let all_one = parts.len() > MOST;
    for (n, part) in parts.iter_mut().enumerate() {
        part.group = if all_one { 0 } else { n };
    }
    if all_one {
        return;
    }
    let clear = thickness * R::from_f64(2.0 * AMBIGUITY_BAND);
    for n in 1..parts.len() {
        for m in 0..n {
            let (Some(a), Some(b)) = (parts.get(m), parts.get(n)) else { break };
            if a.group == b.group || a.extent.is_apart(&b.extent, clear) {
                continue;
            }
            let (kept, given_up) = (a.group.min(b.group), a.group.max(b.group));
            parts.iter_mut().filter(|part| part.group == given_up).for_each(|part| part.group = kept);
        }
    }
    sort_by_group(parts);
}

/// By insertion: those of a group keep their order, and seldom has one far to go.
fn sort_by_group<R: Real>(parts: &mut [Part<R>]) {
    for n in 1..parts.len() {
        let Some(&part) = parts.get(n) else { break };
        let mut at = n;
        while let Some(&before) =
            at.checked_sub(1).and_then(|n| parts.get(n)).filter(|before| before.group > part.group)
        {
            if let Some(place) = parts.get_mut(at) {
                *place = before;
            }
            at -= 1;
        }
        if let Some(place) = parts.get_mut(at) {
            *place = part;
        }
    }
}
