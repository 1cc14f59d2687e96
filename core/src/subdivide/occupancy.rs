//! How a box lies to a body, and what a query hands to the next one.

/// How a box lies to a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Occupancy {
    /// Box and body share no volume, or no area if the box is a face.
    Open,
    /// Neither of the others, or not known.
    Cut,
    /// Every point of the box belongs to the body.
    Closed,
}

/// How often GJK was asked, and how often it could not tell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct QueryCount {
    /// Queries.
    pub queries: u64,
    /// Of these, the undecided ones: their boxes count as cut.
    pub undecided: u64,
}

impl core::ops::Add for QueryCount {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        QueryCount { queries: self.queries + other.queries, undecided: self.undecided + other.undecided }
    }
}

/// The warm start of a query for a part of a box: what the query for the box found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WarmStart<V> {
    /// For a convex body: a direction that separated a neighbour from it, or zero. For a surface: a point in the box.
    pub vector: V,
    /// For a surface: its winding number at that point, if known.
    pub winding: Option<i32>,
}

/// A list of the facets that cut a box, in the caller's memory.
#[derive(Debug)]
pub struct ActiveFacets<'a> {
    items: &'a mut [u32],
    /// How many were pushed, which may be more than the memory holds.
    count: usize,
}

impl<'a> ActiveFacets<'a> {
    /// An empty list; `items` is its memory, whose contents do not matter.
    pub fn new(items: &'a mut [u32]) -> Self {
        ActiveFacets { items, count: 0 }
    }

    /// How many facets are listed; none if the memory did not hold them all.
    pub fn listed(&self) -> Option<usize> {
        (self.count <= self.items.len()).then_some(self.count)
    }

    /// How many facets were pushed and not dropped, with those for which there was no memory.
    #[inline(always)]
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    #[inline(always)]
    pub(crate) fn push(&mut self, facet: u32) {
        if let Some(place) = self.items.get_mut(self.count) {
            *place = facet;
        }
        self.count += 1;
    }

    /// Keeps the facets that are `wanted`. Keeps all if the memory did not hold them all.
    #[inline(always)]
    pub(crate) fn retain(&mut self, wanted: impl Fn(u32) -> bool) {
        let Some(items) = self.items.get_mut(..self.count) else { return };
        let mut kept = 0;
        for n in 0..items.len() {
            let item = items[n];
            if wanted(item) {
                if let Some(place) = items.get_mut(kept) {
                    *place = item;
                }
                kept += 1;
            }
        }
        self.count = kept;
    }

    /// The facets; none if the memory did not hold them all.
    #[inline(always)]
    pub(crate) fn items(&self) -> &[u32] {
        self.items.get(..self.count).unwrap_or(&[])
    }
}
