//! Arguments of a call: pointers and lengths as a C caller gives them, checked before anything is read.

use crate::status::{Answer, Refusal, Status};
use core::ffi::CStr;
use core::mem::{align_of, size_of};
use core::slice;
use voidage_core::number::real::Real;

/// An array of the caller.
#[derive(Clone, Copy)]
struct Region {
    start: usize,
    bytes: usize,
    written: bool,
    name: &'static CStr,
}

/// Most arrays that one call takes.
const MOST: usize = 24;

/// All arrays of a call: those that are written overlap no other.
pub struct Arrays {
    regions: [Region; MOST],
    count: usize,
}

impl Arrays {
    pub const fn new() -> Self {
        Arrays { regions: [Region { start: 0, bytes: 0, written: false, name: c"" }; MOST], count: 0 }
    }

    /// Checks pointer and length, and notes the array.
    fn note<T>(&mut self, first: *const T, count: usize, written: bool, name: &'static CStr) -> Answer {
        if first.is_null() {
            return Err(Status::Null.of(name));
        }
        if !first.is_aligned() {
            return Err(Status::Misaligned.of(name));
        }
        let bytes = count.checked_mul(size_of::<T>()).filter(|&bytes| bytes <= isize::MAX as usize);
        let Some(bytes) = bytes.filter(|&bytes| (first as usize).checked_add(bytes).is_some()) else {
            return Err(Status::Length.of(name));
        };
        let region = Region { start: first as usize, bytes, written, name };
        for other in self.regions.get(..self.count).unwrap_or_default() {
            let apart = other.start + other.bytes <= region.start || region.start + region.bytes <= other.start;
            if (written || other.written) && !apart && bytes > 0 && other.bytes > 0 {
                return Err(Status::Overlap.of(if written { name } else { other.name }));
            }
        }
        let Some(slot) = self.regions.get_mut(self.count) else { return Err(Status::Length.of(name)) };
        *slot = region;
        self.count += 1;
        Ok(())
    }

    /// An array to be read; of no entries it may be null.
    ///
    /// # Safety
    /// A pointer that passes the checks points at `count` values that live as long as the result and are not written meanwhile.
    pub unsafe fn read<'a, T>(&mut self, first: *const T, count: usize, name: &'static CStr) -> Answer<&'a [T]> {
        if count == 0 {
            return Ok(&[]);
        }
        self.note(first, count, false, name)?;
        Ok(unsafe { slice::from_raw_parts(first, count) })
    }

    /// An array to be written; of no entries it may be null.
    ///
    /// # Safety
    /// A pointer that passes the checks points at `count` values that live as long as the result and that nothing else uses meanwhile.
    pub unsafe fn write<'a, T>(&mut self, first: *mut T, count: usize, name: &'static CStr) -> Answer<&'a mut [T]> {
        if count == 0 {
            return Ok(&mut []);
        }
        self.note(first, count, true, name)?;
        Ok(unsafe { slice::from_raw_parts_mut(first, count) })
    }

    /// Where a single result goes, at any address; it may be null.
    pub fn result<T>(&mut self, at: *mut T, name: &'static CStr) -> Answer {
        if at.is_null() { Ok(()) } else { self.note(at.cast::<u8>(), size_of::<T>(), true, name) }
    }

    /// Memory of the caller, of which `needed` bytes are used.
    pub fn work(&mut self, start: *mut u8, bytes: usize, needed: usize) -> Answer {
        if needed == usize::MAX || bytes < needed {
            return Err(Refusal::bytes(needed));
        }
        self.note(start, needed, true, c"work")
    }
}

/// A struct of the caller, which may lie anywhere.
///
/// # Safety
/// `at` is null or can be read.
pub unsafe fn given<T: Copy>(at: *const T, name: &'static CStr) -> Answer<T> {
    if at.is_null() { Err(Status::Null.of(name)) } else { Ok(unsafe { at.read_unaligned() }) }
}

/// Writes a result that may lie anywhere; nothing if it is not wanted.
///
/// # Safety
/// `at` is null or can be written.
pub unsafe fn give<T>(at: *mut T, value: T) {
    if !at.is_null() {
        unsafe { at.write_unaligned(value) };
    }
}

/// Refuses an array by its first number that is not `good`.
pub fn all<R: Real>(values: &[R], good: impl Fn(R) -> bool, name: &'static CStr) -> Answer {
    match values.iter().position(|&v| !good(v)) {
        Some(index) => Err(Status::Value.of(name).index(index)),
        None => Ok(()),
    }
}

/// Vectors of three numbers each have the layout of the numbers.
pub const fn same_layout<A, B, const N: usize>() -> bool {
    size_of::<A>() == N * size_of::<B>() && align_of::<A>() == align_of::<B>()
}
