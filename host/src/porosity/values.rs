//! A zeroed array of numbers, on huge pages where it is large.
//!
//! A field is written once from end to end, and the kernel clears each page at its first touch. With pages of 4 kB that costs as
//! much time as all the geometry of a scene; with pages of 2 MB hardly any.

use memmap2::MmapMut;
use std::ops::{Deref, DerefMut};

/// Bytes of a huge page; from half of one on, an array gets pages of its own.
const HUGE_PAGE: usize = 2 << 20;

/// `f64` values in one run of memory; a slice in all but its memory.
#[derive(Default)]
pub struct Values(Memory);

enum Memory {
    Heap(Vec<f64>),
    /// Pages and the number of values in them.
    Pages(MmapMut, usize),
}

impl Default for Memory {
    fn default() -> Self {
        Memory::Heap(Vec::new())
    }
}

impl Values {
    /// `count` zeros.
    #[must_use]
    pub fn zeros(count: usize) -> Self {
        let bytes = count.saturating_mul(size_of::<f64>());
        // Only a mapping of whole huge pages is placed where they can begin.
        if bytes >= HUGE_PAGE / 2
            && let Some(whole) = bytes.checked_next_multiple_of(HUGE_PAGE)
            && let Ok(pages) = MmapMut::map_anon(whole)
        {
            #[cfg(target_os = "linux")]
            let _ = pages.advise(memmap2::Advice::HugePage); // without them it is slower, and the same
            return Values(Memory::Pages(pages, count));
        }
        Values(Memory::Heap(vec![0.0; count]))
    }
}

impl Deref for Values {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        match &self.0 {
            Memory::Heap(values) => values,
            Memory::Pages(pages, count) => &bytemuck::cast_slice(pages)[..*count],
        }
    }
}

impl DerefMut for Values {
    fn deref_mut(&mut self) -> &mut [f64] {
        match &mut self.0 {
            Memory::Heap(values) => values,
            Memory::Pages(pages, count) => &mut bytemuck::cast_slice_mut(pages)[..*count],
        }
    }
}

impl<'a> IntoIterator for &'a Values {
    type Item = &'a f64;
    type IntoIter = std::slice::Iter<'a, f64>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl From<Vec<f64>> for Values {
    fn from(values: Vec<f64>) -> Self {
        Values(Memory::Heap(values))
    }
}

impl Clone for Values {
    fn clone(&self) -> Self {
        let mut copy = Values::zeros(self.len());
        copy.copy_from_slice(self);
        copy
    }
}

impl PartialEq for Values {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl std::fmt::Debug for Values {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        (**self).fmt(f)
    }
}
