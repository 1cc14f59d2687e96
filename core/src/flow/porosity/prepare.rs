//! Open fractions made ready for steps: dust swept out, walls and jumps flagged, small cells merged, what cannot be merged closed to
//! the outside. [`prepare`] is the only way to a [`Prepared`] space, and only such a space enters a problem.

use crate::flow::error::Error;
use crate::flow::porosity::areas::SUDDEN;
use crate::flow::porosity::clusters::{Clusters, clusters};
use crate::flow::porosity::flags::{BORDER, KIND, SMALL, break_high, break_low, is};
use crate::flow::porosity::fractions::{Mesh, Porosity, SMALL_SHARE};
use crate::flow::porosity::mark::mark;
use crate::number::real::Real;

/// How porosity enters: the share of the duct above which a difference counts as a jump, and whether small cells merge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Treatment<R> {
    /// Differences above this share of the wider duct, at one face or over many in a row, are jumps and get the throat map; infinity for none.
    pub jump: R,
    /// Merge cells of little volume behind open faces. Without it the step shrinks with their volume.
    pub merge: bool,
}

impl<R: Real> Default for Treatment<R> {
    fn default() -> Self {
        Treatment { jump: R::from_f64(SUDDEN), merge: true }
    }
}

/// What [`prepare`] changed in the fractions given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tidied {
    /// Cells whose fraction was within a few rounding errors of 0, or below it by rounding, and became 0.
    pub dust_cells: usize,
    /// Faces likewise.
    pub dust_faces: usize,
    /// Open faces on the sides of the domain that were closed: too little volume behind them for any step.
    pub closed_faces: usize,
    /// Faces on the sides of periodic axes that were lowered to what the same face on the opposite side leaves open.
    pub matched_faces: usize,
}

/// Open fractions as measured, and memory for the flags of the cells. Vectors, or slices that can be written.
#[derive(Debug)]
pub struct Fractions<V, F, const D: usize> {
    /// `beta_v`, one per cell, x fastest, 0 to 1; what is beyond that by no more than 10⁻⁶ is taken for rounding.
    pub volume: V,
    /// `beta_x`, `beta_y`, `beta_z` of the live axes, one longer than the cells along their own axis; as `volume`.
    pub faces: [V; D],
    /// One byte per cell; what it holds does not count.
    pub flags: F,
}

/// Memory to merge small cells in; what it holds does not count.
#[derive(Debug)]
pub struct Merging<L, V> {
    /// One entry per cell; stays with the prepared space.
    pub list: L,
    /// One entry per cell.
    pub parent: L,
    /// As many as [`cluster_scratch`](super::clusters::cluster_scratch) tells.
    pub scratch: V,
}

/// Open fractions ready for steps, with what was found out about them.
#[derive(Clone, Debug)]
pub struct Prepared<V, F, L, const D: usize> {
    volume: V,
    faces: [V; D],
    flags: F,
    list: Option<L>,
    /// Entries of the list that are clusters.
    used: usize,
    cells: [usize; D],
    periodic: [bool; D],
    tidied: Tidied,
}

/// The same as slices, for a [`Problem`](crate::flow::problem::Problem).
#[derive(Clone, Copy, Debug)]
pub struct PreparedView<'a, R, const D: usize> {
    pub(in crate::flow) porosity: Porosity<'a, R, D>,
    pub(in crate::flow) clusters: Clusters<'a>,
    pub(in crate::flow) cells: [usize; D],
    pub(in crate::flow) periodic: [bool; D],
}

/// Makes open fractions ready for steps on a mesh, some of whose axes are `periodic`.
///
/// `memory` is asked, for the number of cells, only if small cells are to be merged. Where a cluster of small cells cannot grow large
/// enough, the faces that open it to the outside are closed and the clusters found again.
///
/// # Errors
/// An array does not fit the mesh, an open fraction is NaN or not from 0 to 1, or the mesh has 2^31 cells or more and small ones among them.
pub fn prepare<R, V, F, L, const D: usize>(
    mesh: &Mesh<'_, R, D>,
    periodic: [bool; D],
    fractions: Fractions<V, F, D>,
    treatment: Treatment<R>,
    memory: impl FnOnce(usize) -> Merging<L, V>,
) -> Result<Prepared<V, F, L, D>, Error>
where
    R: Real,
    V: AsRef<[R]> + AsMut<[R]>,
    F: AsRef<[u8]> + AsMut<[u8]>,
    L: AsRef<[u32]> + AsMut<[u32]>,
{
    let Fractions { mut volume, mut faces, flags } = fractions;
    let dust_cells = without_dust(volume.as_mut()).map_err(|cell| Error::CellFraction { cell })?;
    let mut tidied = Tidied { dust_cells, ..Tidied::default() };
    for ((axis, faces), periodic) in faces.iter_mut().enumerate().zip(periodic) {
        let faces = faces.as_mut();
        tidied.dust_faces += without_dust(faces).map_err(|face| Error::FaceFraction { axis, face })?;
        if periodic {
            tidied.matched_faces += match_sides(mesh, axis, faces);
        }
    }
    let cells = mesh.cells();
    let mut space = Prepared { volume, faces, flags, list: None, used: 0, cells, periodic, tidied };
    space.flag(mesh, treatment.jump)?;
    if !treatment.merge || !space.has_small_cells() {
        return Ok(space);
    }
    let Merging { mut list, mut parent, mut scratch } = memory(mesh.len());
    loop {
        let faces = space.faces.each_ref().map(|f| f.as_ref());
        let (list, parent) = (list.as_mut(), parent.as_mut());
        let porosity = Porosity { volume: space.volume.as_ref(), faces, marks: space.flags.as_ref() };
        space.used = clusters(mesh, porosity, periodic, list, parent, scratch.as_mut())?;
        // From here on, whether a cell belongs to a cluster.
        parent.fill(0);
        let found = Clusters(list.get(..space.used).unwrap_or_default());
        found.cells().for_each(|cell| parent[cell] = 1);
        let closed = space.close_small_to_outside(mesh, found, parent);
        if closed == 0 {
            break;
        }
        space.tidied.closed_faces += closed;
        space.flag(mesh, treatment.jump)?;
        if !space.has_small_cells() {
            space.used = 0;
            break;
        }
    }
    // What found no company (a periodic axis of one cell) limits the step like any other cell.
    for (flag, &clustered) in space.flags.as_mut().iter_mut().zip(parent.as_ref()) {
        if is(*flag, SMALL) && clustered == 0 {
            *flag &= !KIND;
        }
    }
    space.list = Some(list);
    Ok(space)
}

impl<V, F, L, const D: usize> Prepared<V, F, L, D> {
    /// What was changed in the fractions.
    pub const fn tidied(&self) -> Tidied {
        self.tidied
    }

    /// Cells merged into clusters.
    pub const fn merged_cells(&self) -> usize {
        self.used
    }
}

impl<V, F: AsMut<[u8]> + AsRef<[u8]>, L, const D: usize> Prepared<V, F, L, D> {
    fn has_small_cells(&self) -> bool {
        self.flags.as_ref().iter().any(|&m| is(m, SMALL))
    }

    /// Writes the flags of all cells.
    fn flag<R: Real>(&mut self, mesh: &Mesh<'_, R, D>, jump: R) -> Result<(), Error>
    where
        V: AsRef<[R]>,
    {
        let faces = self.faces.each_ref().map(|f| f.as_ref());
        mark(mesh, self.volume.as_ref(), &faces, self.periodic, jump, self.flags.as_mut())
    }

    /// Closes the faces on the sides of the domain of clusters, and of small cells without one, that found no more neighbours and
    /// are still too small for their faces; returns how many. `clustered` is not 0 for the cells of clusters.
    fn close_small_to_outside<R: Real>(
        &mut self,
        mesh: &Mesh<'_, R, D>,
        found: Clusters<'_>,
        clustered: &[u32],
    ) -> usize
    where
        V: AsRef<[R]> + AsMut<[R]>,
    {
        let flags = self.flags.as_ref();
        let (volume, mut faces) = (self.volume.as_ref(), self.faces.each_mut().map(|f| f.as_mut()));
        let mut closed = 0;
        let mut examine = |members: &mut dyn Iterator<Item = usize>, again: &mut dyn Iterator<Item = usize>| {
            let (mut held, mut wanted) = (R::ZERO, R::ZERO);
            for cell in members {
                let at = mesh.coordinates(cell);
                held += volume[cell] * mesh.volume(at);
                // What a border leaves is enough.
                for d in (0..D).filter(|_| !is(flags[cell], BORDER)) {
                    for face in mesh.faces_of(d, at) {
                        wanted = R::larger(faces[d][face] * mesh.volume(at), wanted);
                    }
                }
            }
            if !(held < R::from_f64(SMALL_SHARE) * wanted) {
                return;
            }
            for cell in again {
                let at = mesh.coordinates(cell);
                for d in 0..D {
                    let ends = [0, mesh.cells()[d] - 1];
                    for (face, end) in mesh.faces_of(d, at).into_iter().zip(ends) {
                        if !self.periodic[d] && at[d] == end && faces[d][face] > R::ZERO {
                            faces[d][face] = R::ZERO;
                            closed += 1;
                        }
                    }
                }
            }
        };
        for group in found.groups() {
            examine(&mut group.clone(), &mut group.clone());
        }
        for cell in (0..flags.len()).filter(|&c| is(flags[c], SMALL) && clustered[c] == 0) {
            examine(&mut core::iter::once(cell), &mut core::iter::once(cell));
        }
        closed
    }
}

impl<V, F: AsRef<[u8]>, L: AsRef<[u32]>, const D: usize> Prepared<V, F, L, D> {
    /// As slices.
    pub fn view<R: Real>(&self) -> PreparedView<'_, R, D>
    where
        V: AsRef<[R]>,
    {
        let faces = self.faces.each_ref().map(|f| f.as_ref());
        let porosity = Porosity { volume: self.volume.as_ref(), faces, marks: self.flags.as_ref() };
        let list = self.list.as_ref().and_then(|l| l.as_ref().get(..self.used)).unwrap_or_default();
        PreparedView { porosity, clusters: Clusters(list), cells: self.cells, periodic: self.periodic }
    }
}

impl<'a, R: Real, const D: usize> PreparedView<'a, R, D> {
    /// `beta_v` of all cells.
    pub const fn volume(&self) -> &'a [R] {
        self.porosity.volume
    }

    /// Open fractions of the faces, axis by axis.
    pub const fn faces(&self) -> [&'a [R]; D] {
        self.porosity.faces
    }

    /// The cells of each cluster of small cells.
    pub fn clusters(&self) -> impl Iterator<Item = impl Iterator<Item = usize> + Clone + 'a> {
        self.clusters.groups()
    }

    /// Cells with no open face: nothing happens there.
    pub fn sealed_cells(&self) -> usize {
        let open = |cell: usize, d: usize| {
            let stride: usize = self.cells[..d].iter().product();
            // A line of faces is one longer than one of cells.
            let low = cell + cell / (stride * self.cells[d]).max(1) * stride;
            [low, low + stride].iter().any(|&face| self.porosity.faces[d].get(face).is_some_and(|open| *open > R::ZERO))
        };
        let marks = self.porosity.marks.iter().enumerate();
        marks.filter(|&(cell, &m)| is(m, BORDER) && !(0..D).any(|d| open(cell, d))).count()
    }

    /// Open faces where the porosity jumps and the throat map acts; the two ends of a periodic axis are one face.
    pub fn jump_faces(&self) -> usize {
        let mut total = 0;
        for d in 0..D {
            let faces = self.porosity.faces[d];
            let stride: usize = self.cells[..d].iter().product();
            for (cell, marks) in self.porosity.marks.iter().enumerate() {
                let place = cell / stride.max(1) % self.cells[d].max(1);
                // A layer of cells has one face more along its own axis.
                let low = cell + cell / (stride * self.cells[d]).max(1) * stride;
                let jumps = |bit: u8, face: usize| marks & bit != 0 && faces.get(face).is_some_and(|f| *f > R::ZERO);
                let is_last = !self.periodic[d] && place + 1 == self.cells[d];
                let high = is_last && jumps(break_high(d), low + stride);
                total += usize::from(jumps(break_low(d), low)) + usize::from(high);
            }
        }
        total
    }
}

/// The two sides of a periodic axis are one plane: what leaves by one must enter by the other, so both let pass what the less open one
/// does. Returns how many faces were lowered.
fn match_sides<R: Real, const D: usize>(mesh: &Mesh<'_, R, D>, d: usize, faces: &mut [R]) -> usize {
    let across = mesh.cells()[d].saturating_mul(mesh.face_stride(d));
    let mut lowered = 0;
    for cell in (0..mesh.len()).filter(|&cell| mesh.coordinates(cell)[d] == 0) {
        let low = mesh.face(d, mesh.coordinates(cell));
        let high = low.saturating_add(across);
        if let (Some(&a), Some(&b)) = (faces.get(low), faces.get(high)) {
            lowered += usize::from(a != b);
            for face in [low, high] {
                if let Some(open) = faces.get_mut(face) {
                    *open = R::smaller(a, b);
                }
            }
        }
    }
    lowered
}

/// Open fractions may leave 0 to 1 by so much: rounding of single precision.
const BEYOND: f64 = 1e-6;

/// Sets fractions that are below 0 or within a few rounding errors of it to 0, and those above 1 to 1; returns how many
/// became 0.
///
/// # Errors
/// The place of a fraction that is NaN, or below 0 or above 1 by more than rounding.
fn without_dust<R: Real>(fractions: &mut [R]) -> Result<usize, usize> {
    let (dust, beyond) = (R::from_f64(16.0) * R::EPSILON, R::from_f64(BEYOND));
    let mut count = 0;
    for (index, x) in fractions.iter_mut().enumerate() {
        if !(*x >= -beyond && *x <= R::ONE + beyond) {
            return Err(index);
        }
        if *x <= dust {
            count += usize::from(*x != R::ZERO);
            *x = R::ZERO;
        } else if *x > R::ONE {
            *x = R::ONE;
        }
    }
    Ok(count)
}
