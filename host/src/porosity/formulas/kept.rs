//! Faces in the plane between two layers that a thread computes one after the other: those of the lower layer are kept for the upper one.

use voidage_core::solids::quadric::{FaceBetween, FacesBetween};

/// Whose part a face is of, and where: the number of the solid, that of its part, and the position in the plane.
type Key = (usize, usize, usize);

/// Faces of one plane, by ascending keys.
type Faces = Vec<(Key, FaceBetween)>;

/// A thread's memory for such faces, all of one grid.
#[derive(Debug, Default)]
pub struct KeptFaces {
    /// Faces are kept in this layer.
    active: bool,
    below: Faces,
    /// How many of those below have been passed.
    passed: usize,
    above: Faces,
    /// The plane of those above.
    plane: Option<usize>,
    solid: usize,
}

impl KeptFaces {
    /// Begins a layer; none of another grid than the one of all layers.
    pub(super) fn begin(&mut self, layer: Option<usize>) {
        self.active = layer.is_some();
        let Some(k) = layer else { return };
        std::mem::swap(&mut self.below, &mut self.above);
        if self.plane != Some(k) {
            self.below.clear();
        }
        self.above.clear();
        (self.passed, self.plane) = (0, Some(k + 1));
    }

    /// Those of a solid follow; solids come in ascending order.
    pub(super) fn of_solid(&mut self, solid: usize) -> &mut Self {
        self.solid = solid;
        self
    }
}

impl FacesBetween for KeptFaces {
    fn below(&mut self, part: usize, at: usize) -> Option<FaceBetween> {
        if !self.active {
            return None;
        }
        let wanted = (self.solid, part, at);
        while let Some((key, face)) = self.below.get(self.passed) {
            if *key >= wanted {
                return (*key == wanted).then_some(*face);
            }
            self.passed += 1;
        }
        None
    }

    fn above(&mut self, part: usize, at: usize, face: FaceBetween) {
        if self.active {
            self.above.push(((self.solid, part, at), face));
        }
    }
}
