//! The open fractions of a space made ready for the flow: dust swept out, jumps marked, small cells clustered.

use super::field::Scalar;
use crate::huge::HugeVec;
use voidage_core::flow::porosity::{clusters, flags, fractions};
use voidage_core::flow::{Clusters, Error, Mesh, mark};
use voidage_core::number::real::Real;

/// Open fractions with what the solver derives from them.
#[derive(Clone, Debug)]
pub(super) struct Space<R: Scalar, const D: usize> {
    pub volume: HugeVec<R>,
    pub faces: [HugeVec<R>; D],
    pub marks: HugeVec<u8>,
    pub clusters: Vec<u32>,
}

/// How porosity enters: the share of the duct above which a difference counts as a jump, and whether small cells merge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Treatment<R> {
    /// Differences above this share of the wider duct are jumps and get the throat map; infinity for none.
    pub jump: R,
    /// Merge cells of little volume behind open faces. Without it the step shrinks with their volume.
    pub merge: bool,
}

impl<R: Real> Default for Treatment<R> {
    fn default() -> Self {
        Treatment { jump: R::from_f64(0.1), merge: true }
    }
}

/// What [`Flow::set_porosity`](super::Flow::set_porosity) changed in the fractions given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Tidied {
    /// Cells whose fraction was within a few rounding errors of 0 and became 0.
    pub dust_cells: usize,
    /// Faces likewise.
    pub dust_faces: usize,
    /// Open faces on the sides of the domain that were closed: too little volume behind them for any step.
    pub closed_faces: usize,
}

impl<R: Scalar, const D: usize> Space<R, D> {
    /// Makes the fractions ready. Where a cluster cannot grow large enough, the faces that open it to the outside are closed and
    /// the clusters found again.
    pub fn new(
        mesh: &Mesh<'_, R, D>,
        periodic: [bool; D],
        mut volume: HugeVec<R>,
        mut faces: [HugeVec<R>; D],
        treatment: Treatment<R>,
    ) -> Result<(Self, Tidied), Error> {
        let mut tidied = Tidied {
            dust_cells: without_dust(&mut volume),
            dust_faces: faces.iter_mut().map(|f| without_dust(f)).sum(),
            closed_faces: 0,
        };
        loop {
            let mut space = Space { marks: HugeVec::zeros(volume.len()), clusters: Vec::new(), volume, faces };
            let views = space.faces.each_ref().map(|f| &**f);
            mark(mesh, &space.volume, &views, periodic, treatment.jump, &mut space.marks)?;
            if !treatment.merge || !space.marks.iter().any(|&m| flags::is(m, flags::SMALL)) {
                return Ok((space, tidied));
            }
            space.cluster(mesh, periodic)?;
            let alone = space.small_cells_alone();
            let outside = space.outside_of_small_clusters(mesh, periodic, &alone);
            if outside.is_empty() {
                // What found no company (a periodic axis of one cell) limits the step like any other cell.
                for cell in alone {
                    space.marks[cell] &= !flags::KIND;
                }
                return Ok((space, tidied));
            }
            tidied.closed_faces += outside.len();
            for (d, face) in outside {
                space.faces[d][face] = R::ZERO;
            }
            Space { volume, faces, .. } = space;
        }
    }

    /// Groups small cells with neighbours.
    fn cluster(&mut self, mesh: &Mesh<'_, R, D>, periodic: [bool; D]) -> Result<(), Error> {
        let n = self.volume.len();
        let mut parent = vec![0; n];
        let mut work = vec![R::ZERO; clusters::cluster_scratch(n)];
        self.clusters = vec![0; n];
        let views = self.faces.each_ref().map(|f| &**f);
        let used =
            clusters::clusters(mesh, (&self.volume, &views), periodic, &mut self.clusters, &mut parent, &mut work)?;
        self.clusters.truncate(used);
        self.clusters.shrink_to_fit();
        Ok(())
    }

    /// Small cells that belong to no cluster.
    fn small_cells_alone(&self) -> Vec<usize> {
        let mut clustered = vec![false; self.volume.len()];
        Clusters(&self.clusters).groups().flatten().for_each(|cell| clustered[cell] = true);
        (0..clustered.len()).filter(|&c| flags::is(self.marks[c], flags::SMALL) && !clustered[c]).collect()
    }

    /// Open faces (axis, index) on the sides of the domain of clusters, and of small cells without one, that found no more neighbours
    /// and are still too small for their faces: they must not stand open to the outside.
    fn outside_of_small_clusters(
        &self,
        mesh: &Mesh<'_, R, D>,
        periodic: [bool; D],
        alone: &[usize],
    ) -> Vec<(usize, usize)> {
        let cells = mesh.cells();
        let mut outside: Vec<(usize, usize)> = Vec::new();
        let mut examine = |members: &mut dyn Iterator<Item = usize>| {
            let (mut held, mut wanted, mut edge) = (R::ZERO, R::ZERO, Vec::new());
            for cell in members {
                let at = mesh.coordinates(cell);
                let own = mesh.volume(at);
                held += self.volume[cell] * own;
                for d in 0..D {
                    let low = mesh.face(d, at);
                    let high = low + mesh.face_stride(d);
                    for (face, last) in [(low, 0), (high, cells[d] - 1)] {
                        let open = self.faces[d][face] * own;
                        if open > wanted {
                            wanted = open;
                        }
                        if !periodic[d] && at[d] == last && open > R::ZERO {
                            edge.push((d, face));
                        }
                    }
                }
            }
            if held < R::from_f64(fractions::SMALL_SHARE) * wanted {
                outside.append(&mut edge);
            }
        };
        for group in Clusters(&self.clusters).groups() {
            examine(&mut group.clone());
        }
        for &cell in alone {
            examine(&mut std::iter::once(cell));
        }
        outside
    }

    /// Faces where the porosity jumps and the throat map acts.
    pub fn jump_faces(&self, mesh: &Mesh<'_, R, D>) -> usize {
        let cells = mesh.cells();
        let of_cell = |(cell, marks): (usize, &u8)| {
            let at = mesh.coordinates(cell);
            let jumps = |d: usize, bit: u8, face: usize| marks & bit != 0 && self.faces[d][face] > R::ZERO;
            let of_axis = |d: usize| {
                let low = mesh.face(d, at);
                let high = at[d] + 1 == cells[d] && jumps(d, flags::break_high(d), low + mesh.face_stride(d));
                usize::from(jumps(d, flags::break_low(d), low)) + usize::from(high)
            };
            (0..D).map(of_axis).sum::<usize>()
        };
        self.marks.iter().enumerate().map(of_cell).sum()
    }
}

/// Sets what is within a few rounding errors of 0, or below, to 0; returns how many were not 0 before.
fn without_dust<R: Real>(fractions: &mut [R]) -> usize {
    let dust = R::from_f64(16.0) * R::EPSILON;
    let mut count = 0;
    for x in fractions.iter_mut().filter(|x| !(**x > dust)) {
        count += usize::from(*x != R::ZERO);
        *x = R::ZERO;
    }
    count
}
