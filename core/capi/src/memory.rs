//! The caller's memory, measured and cut by one text.

use core::mem::{align_of, size_of};
use core::slice;

/// Where memory comes from: [`Measure`] only counts, [`Cut`] hands out.
pub trait Memory<'m> {
    /// `count` values, or none from a measure.
    fn take<T: 'm>(&mut self, count: usize, value: impl FnMut(usize) -> T) -> &'m mut [T];
}

/// Memory begins at a multiple of this within what the caller gives.
const ALIGNMENT: usize = 16;

/// Counts bytes from an aligned beginning; `None` if they exceed the address space.
pub struct Measure(Option<usize>);

impl Measure {
    pub const fn new() -> Self {
        Measure(Some(0))
    }

    /// Bytes to ask of the caller, who need not align them; the largest number if there are not so many.
    pub fn bytes(&self) -> usize {
        let most = isize::MAX as usize;
        self.0.and_then(|n| n.checked_add(ALIGNMENT - 1)).filter(|&n| n <= most).unwrap_or(usize::MAX)
    }
}

impl<'m> Memory<'m> for Measure {
    fn take<T: 'm>(&mut self, count: usize, _: impl FnMut(usize) -> T) -> &'m mut [T] {
        const { assert!(align_of::<T>() <= ALIGNMENT) }
        let start = self.0.and_then(|n| n.checked_next_multiple_of(align_of::<T>()));
        self.0 = start.and_then(|start| start.checked_add(count.checked_mul(size_of::<T>())?));
        &mut []
    }
}

/// Hands out pieces of a block, each value written before it can be read.
pub struct Cut {
    next: *mut u8,
    end: *mut u8,
}

impl Cut {
    /// # Safety
    /// `start` is the beginning of a block of `bytes` that nothing else uses while the pieces are in use; `bytes` is what a [`Measure`] of the
    /// same pieces tells.
    pub unsafe fn new(start: *mut u8, bytes: usize) -> Self {
        Cut { next: start.wrapping_add(start.align_offset(ALIGNMENT)), end: start.wrapping_add(bytes) }
    }
}

impl<'m> Memory<'m> for Cut {
    fn take<T: 'm>(&mut self, count: usize, mut value: impl FnMut(usize) -> T) -> &'m mut [T] {
        let first = self.next.wrapping_add(self.next.align_offset(align_of::<T>()));
        let room = (self.end as usize).saturating_sub(first as usize);
        let Some(bytes) = count.checked_mul(size_of::<T>()).filter(|&bytes| bytes <= room) else { return &mut [] };
        self.next = first.wrapping_add(bytes);
        let first = first.cast::<T>();
        for n in 0..count {
            // Within the block, and aligned.
            unsafe { first.add(n).write(value(n)) };
        }
        unsafe { slice::from_raw_parts_mut(first, count) }
    }
}
