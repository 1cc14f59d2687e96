//! A zeroed array of numbers, on huge pages where it is large.
//!
//! A field of porosity is written once from end to end, and the kernel clears each page at its first touch. With pages of 4 kB
//! that costs as much time as all the geometry of a scene; with pages of 2 MB hardly any. A flow reads and writes all its fields
//! each step, more than the translation cache holds in small pages.

use bytemuck::Pod;
use memmap2::MmapMut;
use std::ops::{Deref, DerefMut};

/// Bytes of a huge page; from half of one on, an array gets pages of its own.
const HUGE_PAGE: usize = 2 << 20;

/// An array of so many values gets pages of its own.
fn deserves_pages<T>(count: usize) -> bool {
    count.saturating_mul(size_of::<T>()) >= HUGE_PAGE / 2
}

/// Numbers in one run of memory; a slice in all but its memory.
pub struct HugeVec<T = f64>(Memory<T>);

enum Memory<T> {
    Heap(Vec<T>),
    /// Pages and the number of values in them.
    Pages(MmapMut, usize),
}

impl<T> Default for HugeVec<T> {
    fn default() -> Self {
        HugeVec(Memory::Heap(Vec::new()))
    }
}

impl<T: Pod> HugeVec<T> {
    /// `count` zeros.
    #[must_use]
    pub fn zeros(count: usize) -> Self {
        // Only a mapping of whole huge pages is placed where they can begin.
        if deserves_pages::<T>(count)
            && let Some(whole) = count.saturating_mul(size_of::<T>()).checked_next_multiple_of(HUGE_PAGE)
            && let Ok(pages) = MmapMut::map_anon(whole)
        {
            #[cfg(target_os = "linux")]
            let _ = pages.advise(memmap2::Advice::HugePage); // without them it is slower, and the same
            return HugeVec(Memory::Pages(pages, count));
        }
        HugeVec(Memory::Heap(vec![T::zeroed(); count]))
    }

    /// A copy of a slice.
    #[must_use]
    pub fn copy_of(values: &[T]) -> Self {
        let mut copy = HugeVec::zeros(values.len());
        copy.copy_from_slice(values);
        copy
    }
}

impl<T: Pod> Deref for HugeVec<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        match &self.0 {
            Memory::Heap(values) => values,
            Memory::Pages(pages, count) => &bytemuck::cast_slice(pages)[..*count],
        }
    }
}

impl<T: Pod> AsRef<[T]> for HugeVec<T> {
    fn as_ref(&self) -> &[T] {
        self
    }
}

impl<T: Pod> AsMut<[T]> for HugeVec<T> {
    fn as_mut(&mut self) -> &mut [T] {
        self
    }
}

impl<T: Pod> DerefMut for HugeVec<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        match &mut self.0 {
            Memory::Heap(values) => values,
            Memory::Pages(pages, count) => &mut bytemuck::cast_slice_mut(pages)[..*count],
        }
    }
}

impl<'a, T: Pod> IntoIterator for &'a HugeVec<T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<T: Pod> From<Vec<T>> for HugeVec<T> {
    fn from(values: Vec<T>) -> Self {
        if deserves_pages::<T>(values.len()) { HugeVec::copy_of(&values) } else { HugeVec(Memory::Heap(values)) }
    }
}

impl<T: Pod> Clone for HugeVec<T> {
    fn clone(&self) -> Self {
        HugeVec::copy_of(self)
    }
}

impl<T: Pod + PartialEq> PartialEq for HugeVec<T> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl<T: Pod + std::fmt::Debug> std::fmt::Debug for HugeVec<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        (**self).fmt(f)
    }
}
