//! The lists of a subdivision, in the caller's memory.

use super::occupancy::WarmStart;

/// A body that cuts a box: its number, what is known of it there, and where its active facets are listed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Candidate<V> {
    pub(super) body: u32,
    pub(super) first: u32,
    pub(super) end: u32,
    pub(super) warm: WarmStart<V>,
}

/// A list of candidates, `first..end` of the caller's memory. `facets_end` is where the memory of facets is free.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CandidateList {
    pub first: usize,
    pub end: usize,
    pub facets_end: usize,
}

/// The caller's memory for the lists, used as stacks; contents do not matter. Where it is full a part keeps the longer list of its parent,
/// which costs work, not truth. It must hold one list of all bodies and their facets ([`TooLittleMemory`]).
#[derive(Debug)]
pub struct SubdivisionMemory<'a, V> {
    /// Bodies: a multiple of their number, say 64 times.
    pub candidates: &'a mut [Candidate<V>],
    /// Facets: all of them, and as much again.
    pub facets: &'a mut [u32],
}

/// The caller's memory does not hold one list of all bodies and their facets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLittleMemory {
    /// Least length of `candidates`.
    pub candidates: usize,
    /// Least length of `facets`.
    pub facets: usize,
}

impl core::fmt::Display for TooLittleMemory {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "memory for {} candidates and {} facets is needed", self.candidates, self.facets)
    }
}

impl core::error::Error for TooLittleMemory {}
