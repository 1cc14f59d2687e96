//! Which triangles of which bodies reach which layer of cells.

use crate::grid::fields::{ShapeMismatch, at_least};
use crate::grid::{Grid, Located, locate};
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};
use crate::surface::error::is_computable;
use core::fmt;
use core::iter::from_fn;
use core::ops::Range;

/// The surface of a body: triangles, counter-clockwise seen from outside, in the frame and unit of the grid.
#[derive(Clone, Copy, Debug)]
pub struct Surface<'a, V> {
    triangles: &'a [[V; 3]],
    sheet: bool,
}

impl<'a, V> Surface<'a, V> {
    /// A body with volume; its surface should be closed.
    #[must_use]
    pub const fn new(triangles: &'a [[V; 3]]) -> Self {
        Surface { triangles, sheet: false }
    }

    /// A sheet without volume, both sides of it given as triangles: it blocks the faces in whose plane it lies.
    #[must_use]
    pub const fn sheet(triangles: &'a [[V; 3]]) -> Self {
        Surface { triangles, sheet: true }
    }

    /// Its triangles.
    #[must_use]
    pub const fn triangles(&self) -> &'a [[V; 3]] {
        self.triangles
    }
}

/// A body's triangles in one layer. The default serves as memory.
#[derive(Clone, Copy, Debug)]
pub struct Group<V> {
    /// Position of the body in the caller's list.
    pub(super) body: u32,
    /// The first of its entries in the list of triangle numbers.
    first: u32,
    /// The end of its entries.
    end: u32,
    /// Around those triangles.
    pub(super) bounds: Aabb<V>,
    /// The body has no volume.
    pub(super) sheet: bool,
}

impl<V: Vector> Default for Group<V> {
    fn default() -> Self {
        Group { body: 0, first: 0, end: 0, bounds: Aabb { min: V::ZERO, max: V::ZERO }, sheet: false }
    }
}

impl<V> Group<V> {
    /// Has its body no volume?
    pub(super) const fn is_sheet(&self) -> bool {
        self.sheet
    }
}

impl<V: Vector> Group<V> {
    /// Its entries in the list of triangle numbers.
    fn run(&self) -> Range<usize> {
        self.first as usize..self.end as usize
    }
}

/// Lengths of the memory in which triangles are sorted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BinsNeeded {
    /// Of numbers.
    pub numbers: usize,
    /// Of groups.
    pub groups: usize,
}

/// Why triangles cannot be sorted into layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum BinsError {
    /// A coordinate is NaN or infinite.
    NotFinite {
        /// The body.
        body: usize,
        /// The triangle among its own.
        triangle: usize,
    },
    /// The memory is too small.
    Memory {
        /// What is needed.
        needed: BinsNeeded,
    },
    /// There are more bodies, triangles or entries than 32 bits count.
    TooMany,
}

impl fmt::Display for BinsError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            BinsError::NotFinite { body, triangle } => {
                write!(
                    f,
                    "triangle {triangle} of body {body} has a coordinate that is NaN, infinite or too large to compute with"
                )
            }
            BinsError::Memory { needed: BinsNeeded { numbers, groups } } => {
                write!(f, "sorting the triangles needs memory of {numbers} numbers and {groups} groups")
            }
            BinsError::TooMany => f.write_str("more bodies, triangles or entries than 32 bits count"),
        }
    }
}

impl core::error::Error for BinsError {}

/// Triangles sorted by layer, and by body within a layer, both ascending.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bins<'a, V> {
    bodies: &'a [Surface<'a, V>],
    /// The first group of each layer, and the end of the last.
    layers: &'a [u32],
    groups: &'a [Group<V>],
    ids: &'a [u32],
}

/// Layers whose entries are counted at a time where there is no memory.
const COUNTED: usize = 64;

/// Memory that a level of division leaves to the next.
pub(super) type Rest<'a, V> = (&'a mut [u32], &'a mut [Group<V>]);

impl<'a, V: Vector> Bins<'a, V> {
    /// Memory for [`Bins::new`].
    pub fn needed<'b>(grid: &Grid<V::Scalar>, bodies: impl Iterator<Item = Surface<'b, V>>) -> BinsNeeded {
        let layers = grid.cells()[2];
        let (mut ids, mut groups) = (0, 0);
        for body in bodies {
            let (mut lowest, mut end) = (layers, 0);
            for triangle in body.triangles {
                let span = layer_span(grid, triangle);
                ids += span.len();
                if !span.is_empty() {
                    (lowest, end) = (lowest.min(span.start), end.max(span.end));
                }
            }
            groups += end.saturating_sub(lowest);
        }
        BinsNeeded { numbers: bookkeeping(layers) + ids, groups }
    }

    /// The most entries and groups that two layers one above the other have, found without memory: the bodies are looked at once for every
    /// [`COUNTED`] layers.
    pub fn most_in_two_layers<'b>(
        grid: &Grid<V::Scalar>,
        bodies: impl Iterator<Item = Surface<'b, V>> + Clone,
    ) -> BinsNeeded {
        let (layers, mut most, mut below) = (grid.cells()[2], BinsNeeded::default(), BinsNeeded::default());
        for first in (0..layers).step_by(COUNTED) {
            let (mut counts, mut last_body) = ([BinsNeeded::default(); COUNTED], [usize::MAX; COUNTED]);
            for (n, body) in bodies.clone().enumerate() {
                for triangle in body.triangles {
                    let span = layer_span(grid, triangle);
                    let here = span.start.saturating_sub(first)..span.end.saturating_sub(first).min(COUNTED);
                    let (counts, last_body) = (counts.get_mut(here.clone()), last_body.get_mut(here));
                    for (count, last) in counts.into_iter().flatten().zip(last_body.into_iter().flatten()) {
                        count.numbers += 1;
                        count.groups += usize::from(*last != n);
                        *last = n;
                    }
                }
            }
            for count in counts {
                most.numbers = most.numbers.max(below.numbers + count.numbers);
                most.groups = most.groups.max(below.groups + count.groups);
                below = count;
            }
        }
        most
    }

    /// Sort the triangles of all bodies.
    pub fn new(
        grid: &Grid<V::Scalar>,
        bodies: &'a [Surface<'a, V>],
        numbers: &'a mut [u32],
        groups: &'a mut [Group<V>],
    ) -> Result<Self, BinsError> {
        let most = u32::MAX as usize - 1;
        if bodies.len() > most || bodies.iter().any(|b| b.triangles.len() > most) {
            return Err(BinsError::TooMany);
        }
        for (body, Surface { triangles, .. }) in bodies.iter().enumerate() {
            let broken = triangles.iter().position(|t| !t.iter().all(|&p| is_computable(p)));
            if let Some(triangle) = broken {
                return Err(BinsError::NotFinite { body, triangle });
            }
        }
        let numbered = bodies.iter().zip(0_u32..);
        let members = numbered.flat_map(|(body, b)| (0..body.triangles.len() as u32).map(move |t| (b, t)));
        Self::sort(grid, bodies, members, numbers, groups).map(|(bins, _)| bins)
    }

    /// Sort those triangles of some layers that may count in a small grid within them; hands back the memory left over.
    pub fn part<'m>(
        &self,
        grid: &Grid<V::Scalar>,
        layers: Range<usize>,
        numbers: &'m mut [u32],
        groups: &'m mut [Group<V>],
    ) -> Result<(Bins<'m, V>, Rest<'m, V>), BinsError>
    where
        'a: 'm,
    {
        let bounds = grid.bounds();
        // Triangles of the layers, in ascending order, each once.
        let mut lower = self.reaching(layers.start, bounds).peekable();
        let second = if layers.len() > 1 { layers.end - 1 } else { usize::MAX };
        let mut upper = self.reaching(second, bounds).peekable();
        let merged = from_fn(move || match (lower.peek(), upper.peek()) {
            (Some(a), Some(b)) if a == b => {
                lower.next();
                upper.next()
            }
            (Some(a), Some(b)) if b < a => upper.next(),
            (None, _) => upper.next(),
            _ => lower.next(),
        });
        Bins::sort(grid, self.bodies, merged, numbers, groups)
    }

    /// Surface and number of the triangles of layer `k` that may count in a box: bodies that reach it, and of these what does not lie
    /// wholly beyond its upper x or y side. Rows and columns begin outside, so what lies towards lower x or y counts too.
    fn reaching(&self, k: usize, cell: Aabb<V>) -> impl Iterator<Item = (u32, u32)> + Clone + use<'a, V> {
        let bins = *self;
        let groups = bins.groups(k).iter().filter(move |g| !g.sheet && g.bounds.touches(cell));
        groups.flat_map(move |g| {
            let before = move |t: &&u32| {
                let corners = bins.corners(g, **t);
                corners.iter().any(|p| p.x() <= cell.max.x()) && corners.iter().any(|p| p.y() <= cell.max.y())
            };
            bins.ids(g).iter().filter(before).map(move |&t| (g.body, t))
        })
    }

    /// Sort some triangles, given as body and number in ascending order; hands back the memory left over.
    fn sort(
        grid: &Grid<V::Scalar>,
        bodies: &'a [Surface<'a, V>],
        members: impl Iterator<Item = (u32, u32)> + Clone,
        numbers: &'a mut [u32],
        groups: &'a mut [Group<V>],
    ) -> Result<(Self, Rest<'a, V>), BinsError> {
        let count = grid.cells()[2];
        let short = BinsError::Memory { needed: BinsNeeded { numbers: bookkeeping(count), groups: 0 } };
        let (layers, numbers) = numbers.split_at_mut_checked(count + 1).ok_or(short)?;
        let (next, numbers) = numbers.split_at_mut_checked(count + 1).ok_or(short)?;
        let (cursor, numbers) = numbers.split_at_mut_checked(count).ok_or(short)?;
        let span = |b: u32, t: u32| {
            let triangle = bodies.get(b as usize).and_then(|body| body.triangles.get(t as usize));
            triangle.map_or(0..0, |triangle| layer_span(grid, triangle))
        };
        count_entries(members.clone().map(|(b, t)| (b, span(b, t))), layers, next, cursor)?;
        let needed = BinsNeeded {
            numbers: bookkeeping(count) + next.last().map_or(0, |&n| n as usize),
            groups: layers.last().map_or(0, |&n| n as usize),
        };
        let (Some((ids, rest)), Some((groups, rest_of_groups))) = (
            numbers.split_at_mut_checked(needed.numbers - bookkeeping(count)),
            groups.split_at_mut_checked(needed.groups),
        ) else {
            return Err(BinsError::Memory { needed });
        };
        cursor.iter_mut().zip(&*layers).for_each(|(cursor, first)| *cursor = *first);
        for (body, t) in members {
            let Some(Surface { triangles, sheet }) = bodies.get(body as usize).copied() else { continue };
            let Some(triangle) = triangles.get(t as usize) else { continue };
            let around = Aabb::around(triangle);
            for k in layer_span(grid, triangle) {
                let (Some(at), Some(cursor), Some(&first)) = (next.get_mut(k), cursor.get_mut(k), layers.get(k)) else {
                    continue;
                };
                let new = Group { body, first: *at, end: *at, bounds: Aabb::empty(), sheet };
                let group = last_group(groups, first, cursor, new);
                if let (Some(id), Some(group)) = (ids.get_mut(*at as usize), group) {
                    *id = t;
                    *at += 1;
                    group.end = *at;
                    group.bounds = group.bounds.union(around);
                }
            }
        }
        Ok((Bins { bodies, layers, groups, ids }, (rest, rest_of_groups)))
    }

    /// The bodies that touch layer `k`; none for a layer that the grid has not.
    pub fn groups(&self, k: usize) -> &'a [Group<V>] {
        let (Some(&first), Some(&end)) = (self.layers.get(k), self.layers.get(k.saturating_add(1))) else { return &[] };
        self.groups.get(first as usize..end as usize).unwrap_or_default()
    }

    /// How many entries and groups layer `k` has.
    pub fn count(&self, k: usize) -> BinsNeeded {
        let groups = self.groups(k);
        BinsNeeded { numbers: groups.iter().map(|g| g.run().len()).sum(), groups: groups.len() }
    }

    /// The triangles of a group, by their number among those of the body.
    pub fn ids(&self, group: &Group<V>) -> &'a [u32] {
        self.ids.get(group.run()).unwrap_or_default()
    }

    /// All triangles of the body of a group.
    pub fn triangles(&self, group: &Group<V>) -> &'a [[V; 3]] {
        self.bodies.get(group.body as usize).map_or(&[], |b| b.triangles)
    }

    /// One triangle of a group; far above everything if there is none of this number.
    fn corners(&self, group: &Group<V>, id: u32) -> [V; 3] {
        let nowhere = [V::splat(V::Scalar::INFINITY); 3];
        self.triangles(group).get(id as usize).copied().unwrap_or(nowhere)
    }
}

/// Numbers needed beside the entries.
const fn bookkeeping(layers: usize) -> usize {
    3 * layers + 2
}

/// The first group and the first entry of every layer, from the layers that each triangle, given with its body, reaches.
fn count_entries(
    spans: impl Iterator<Item = (u32, Range<usize>)>,
    groups: &mut [u32],
    entries: &mut [u32],
    last_body: &mut [u32],
) -> Result<(), BinsError> {
    groups.fill(0);
    entries.fill(0);
    last_body.fill(u32::MAX);
    for (body, span) in spans {
        for k in span {
            let (Some(groups), Some(entries), Some(last)) =
                (groups.get_mut(k + 1), entries.get_mut(k + 1), last_body.get_mut(k))
            else {
                continue;
            };
            *entries = entries.checked_add(1).ok_or(BinsError::TooMany)?;
            if *last != body {
                (*last, *groups) = (body, *groups + 1);
            }
        }
    }
    for list in [groups, entries] {
        let mut sum = 0_u32;
        for n in list {
            sum = sum.checked_add(*n).ok_or(BinsError::TooMany)?;
            *n = sum;
        }
    }
    Ok(())
}

/// The last group of a layer whose groups begin at `first` and end at `cursor`: a new one, unless it is of the same body.
fn last_group<'g, V>(
    groups: &'g mut [Group<V>],
    first: u32,
    cursor: &mut u32,
    new: Group<V>,
) -> Option<&'g mut Group<V>> {
    let same = *cursor > first && groups.get(*cursor as usize - 1).is_some_and(|g| g.body == new.body);
    if !same {
        *groups.get_mut(*cursor as usize)? = new;
        *cursor += 1;
    }
    groups.get_mut(*cursor as usize - 1)
}

/// The layers whose closed slab a triangle touches; one beyond the grid's outer planes counts for none.
fn layer_span<V: Vector>(grid: &Grid<V::Scalar>, triangle: &[V; 3]) -> Range<usize> {
    let [a, b, c] = [triangle[0].z(), triangle[1].z(), triangle[2].z()];
    let (min, max) = (a.min(b).min(c), a.max(b).max(c));
    let [lowest, highest] = grid.ends(2);
    if !(min <= highest && max >= lowest) {
        return 0..0;
    }
    let top = grid.cells()[2] - 1;
    let cell = |z| match grid.locate(2, z) {
        Located::Below => 0,
        Located::Cell(k) => k,
        Located::Above => top,
    };
    let first = cell(min);
    // A corner on the plane below touches the layer below too.
    let on_plane = grid.edges(2).get(first) == Some(&min);
    let first = if on_plane { first.saturating_sub(1) } else { first };
    first..cell(max) + 1
}

/// The triangles that reach one row of cells of a layer, by body, and the memory left over.
pub(super) struct Row<'m, V> {
    /// The triangles.
    pub triangles: RowTriangles<'m, V>,
    /// What the parts of a divided cell may use.
    pub rest: Rest<'m, V>,
}

impl<'m, V: Vector> Row<'m, V> {
    /// From the bins of layer `k` for the row between `lo` and `hi` along y; none if the memory does not hold it.
    pub fn new(bins: &Bins<V>, k: usize, [lo, hi]: [V::Scalar; 2], memory: Rest<'m, V>) -> Option<Self> {
        let in_row = |group: &&Group<V>| !(group.sheet || group.bounds.max.y() <= lo || group.bounds.min.y() >= hi);
        let groups = bins.groups(k).iter().filter(in_row).map(|group| (group, bins.ids(group)));
        let reaches = |corners: [V; 3]| {
            let [a, b, c] = corners.map(Vector::y);
            a.max(b).max(c) > lo && a.min(b).min(c) < hi
        };
        let (triangles, rest) = RowTriangles::gather(bins, groups, reaches, memory)?;
        Some(Row { triangles, rest })
    }
}

/// Triangles that reach a row of cells or a part of it, by body.
#[derive(Clone, Copy)]
pub(super) struct RowTriangles<'m, V> {
    /// The bodies, without sheets.
    pub groups: &'m [Group<V>],
    ids: &'m [u32],
}

impl<'m, V: Vector> RowTriangles<'m, V> {
    /// Of some groups with their triangles, those that `reach`; and the memory left over. None if the memory does not hold them.
    fn gather<'g>(
        bins: &Bins<V>,
        of: impl Iterator<Item = (&'g Group<V>, &'g [u32])>,
        reach: impl Fn([V; 3]) -> bool,
        (numbers, groups): Rest<'m, V>,
    ) -> Option<(Self, Rest<'m, V>)>
    where
        V: 'g,
    {
        let (mut used, mut count) = (0, 0);
        for (group, ids) in of {
            let first = used;
            for &t in ids {
                if reach(bins.corners(group, t)) {
                    *numbers.get_mut(used)? = t;
                    used += 1;
                }
            }
            *groups.get_mut(count)? = Group { first: first as u32, end: used as u32, ..*group };
            count += 1;
        }
        let (ids, numbers) = numbers.split_at_mut_checked(used)?;
        let (own, groups) = groups.split_at_mut_checked(count)?;
        Some((RowTriangles { groups: own, ids }, (numbers, groups)))
    }

    /// Those whose boxes reach a part of the row, or stand beside it at higher x; the bodies stay, without triangles, too.
    pub fn narrowed(self, bins: &Bins<V>, part: Aabb<V>, memory: Rest<'m, V>) -> Option<(Self, Rest<'m, V>)> {
        let (lo, hi) = (part.min, part.max);
        let groups = self.groups.iter().map(|group| (group, self.ids(group)));
        let reaches = |[a, b, c]: [V; 3]| {
            let along =
                |of: fn(V) -> V::Scalar| of(a).max(of(b)).max(of(c)) >= of(lo) && of(a).min(of(b)).min(of(c)) <= of(hi);
            let beyond = |of: fn(V) -> V::Scalar| of(a).max(of(b)).max(of(c)) >= of(lo);
            along(V::y) && along(V::z) && beyond(V::x)
        };
        Self::gather(bins, groups, reaches, memory)
    }

    /// The triangles of one of its groups.
    pub fn ids(self, group: &Group<V>) -> &'m [u32] {
        self.ids.get(group.run()).unwrap_or_default()
    }
}

/// Cells along an axis that an interval reaches or touches.
pub(super) fn cells_touched<R: Real>(edges: &[R], [lo, hi]: [R; 2]) -> Range<usize> {
    let cells = edges.len().saturating_sub(1);
    let first = match locate(edges, lo) {
        Located::Below => 0,
        Located::Cell(i) => i.saturating_sub(usize::from(edges.get(i) == Some(&lo))),
        Located::Above => cells.saturating_sub(usize::from(edges.last() == Some(&lo))),
    };
    let end = match locate(edges, hi) {
        Located::Below => 0,
        Located::Cell(i) => i + 1,
        Located::Above => cells,
    };
    first..end
}

/// Which triangles reach or touch, by their boxes, which cell of a layer, for those cells that are wanted.
pub(super) struct CellLists<'m> {
    /// The last entry of each cell, [`NO_ENTRY`] or [`UNWANTED`].
    last: &'m [u32],
    /// Position of a group in the layer, number of a triangle, and the entry of the same cell before.
    entries: &'m [[u32; 3]],
}

/// Mark cells that are not wanted, and the end of a list.
const UNWANTED: u32 = u32::MAX;
const NO_ENTRY: u32 = u32::MAX - 1;

impl<'m> CellLists<'m> {
    /// Numbers needed if all cells are wanted.
    pub fn needed<V: Vector>(bins: &Bins<V>, grid: &Grid<V::Scalar>, k: usize) -> usize {
        let ([nx, ny, _], mut entries) = (grid.cells(), 0_usize);
        each_span(bins, grid, k, |_, [x, y]| entries = entries.saturating_add(x.len().saturating_mul(y.len())));
        entries.saturating_mul(3).saturating_add(nx * ny)
    }

    /// Of the wanted cells of layer `k`.
    ///
    /// # Errors
    /// [`ShapeMismatch`] if the memory is too small.
    pub fn new<V: Vector>(
        bins: &Bins<V>,
        grid: &Grid<V::Scalar>,
        k: usize,
        wanted: impl Iterator<Item = usize>,
        memory: &'m mut [u32],
    ) -> Result<Self, ShapeMismatch> {
        let [nx, ny, _] = grid.cells();
        let (given, short) = (memory.len(), ShapeMismatch { expected: nx * ny, found: memory.len() });
        let (last, entries) = memory.split_at_mut_checked(nx * ny).ok_or(short)?;
        let (entries, _) = entries.as_chunks_mut();
        last.fill(UNWANTED);
        for cell in wanted {
            if let Some(last) = last.get_mut(cell) {
                *last = NO_ENTRY;
            }
        }
        let mut count = 0_usize;
        let mut add = |[group, id]: [u32; 2], [x, y]: [Range<usize>; 2]| {
            for j in y {
                let row = last.get_mut(j * nx..).and_then(|rows| rows.get_mut(x.clone())).unwrap_or_default();
                for last in row.iter_mut().filter(|last| **last != UNWANTED) {
                    if let Some(entry) = entries.get_mut(count) {
                        *entry = [group, id, *last];
                        *last = count as u32;
                    }
                    count += 1;
                }
            }
        };
        each_span(bins, grid, k, &mut add);
        at_least(nx * ny + 3 * count, given)?;
        Ok(CellLists { last, entries })
    }

    /// The entries of a cell, the last first; none if it is not wanted.
    pub fn of(&self, cell: usize) -> Option<impl Iterator<Item = [u32; 2]> + use<'m>> {
        let mut at = *self.last.get(cell).filter(|last| **last != UNWANTED)?;
        let entries = self.entries;
        Some(from_fn(move || {
            let [group, id, before] = *entries.get(at as usize)?;
            at = before;
            Some([group, id])
        }))
    }
}

/// Hand over the triangles of layer `k`: position of the group, number of the triangle, and the cells along x and y that it reaches or touches.
fn each_span<V: Vector>(
    bins: &Bins<V>,
    grid: &Grid<V::Scalar>,
    k: usize,
    mut each: impl FnMut([u32; 2], [Range<usize>; 2]),
) {
    for (group, n) in bins.groups(k).iter().zip(0_u32..) {
        let triangles = bins.triangles(group);
        for &id in bins.ids(group) {
            let Some([a, b, c]) = triangles.get(id as usize) else { continue };
            let (min, max) = (a.min(*b).min(*c), a.max(*b).max(*c));
            let x = cells_touched(grid.edges(0), [min.x(), max.x()]);
            each([n, id], [x, cells_touched(grid.edges(1), [min.y(), max.y()])]);
        }
    }
}
