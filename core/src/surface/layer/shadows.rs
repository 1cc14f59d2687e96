//! Shadows of the union in the cells of a layer.

use super::Layers;
use super::error::LayerError;
use super::surface_areas::OpenLayer;
use crate::grid::fields::{at_least, exactly};
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};
use crate::surface::bins::{Bins, CellLists};
use crate::surface::cell_unions::known;
use crate::surface::shadow::{Outlines, Shadow, ShadowMemory};
use crate::surface::union::Frame;

impl<V: Vector> Layers<'_, V> {
    /// Numbers that [`ShadowMemory::lists`] needs for layer `k`.
    #[must_use]
    pub fn shadow_lists_needed(&self, k: usize) -> usize {
        CellLists::needed(&self.bins, &self.grid, k)
    }

    /// The shadows of the union in the cells of layer `k`, `ny*nx`, x fastest, and how many cells hold more than the memory: what is given
    /// for them are the blocked shares of their sides. `open` holds the layer's open fractions. Sheets cast shadows.
    ///
    /// # Errors
    /// [`LayerError`]: no such layer, slices of wrong length, too few lists.
    pub fn shadows(
        &self,
        k: usize,
        open: &OpenLayer<V::Scalar>,
        shadows: &mut [Shadow<V::Scalar>],
        mut memory: ShadowMemory<V::Scalar>,
    ) -> Result<usize, LayerError> {
        let [nx, ny, layers] = self.grid.cells();
        if k >= layers {
            return Err(LayerError::NoLayer { layer: k, layers });
        }
        open.check(&self.grid)?;
        exactly(nx * ny, shadows.len())?;
        at_least(self.shadow_lists_needed(k), memory.lists.len())?;
        let lists = CellLists::new(&self.bins, &self.grid, k, core::mem::take(&mut memory.lists));
        let mut outlines = Outlines::new(memory);
        let mut too_full = 0;
        for (c, found) in shadows.iter_mut().enumerate() {
            let at = [c.checked_rem(nx).unwrap_or(0), c.checked_div(nx).unwrap_or(0)];
            let (Some(blocked), Some(cell)) = (open.blocked(at, nx), self.grid.cell_box([at[0], at[1], k])) else {
                continue;
            };
            *found = Shadow { share: blocked.map(|[low, high]| low.max(high)), place: [V::Scalar::HALF; 3] };
            if !open.cell.get(c).is_some_and(|&share| share > V::Scalar::ZERO) {
                found.share = [V::Scalar::ONE; 3];
                continue;
            }
            let here = CellOfLayer { bins: &self.bins, k, cell, entries: lists.of(c) };
            too_full += usize::from(here.shadow(&mut outlines, found).is_none());
        }
        Ok(too_full)
    }
}

/// A cell, and which triangles reach it.
struct CellOfLayer<'a, V: Vector> {
    bins: &'a Bins<'a, V>,
    k: usize,
    cell: Aabb<V>,
    /// Position of a group in the layer and number of a triangle.
    entries: &'a [[u32; 2]],
}

impl<V: Vector> CellOfLayer<'_, V> {
    /// Raise the shares of `found` to the shadows; none if there is no room.
    fn shadow(&self, outlines: &mut Outlines<V::Scalar>, found: &mut Shadow<V::Scalar>) -> Option<()> {
        outlines.clear();
        self.load(outlines)?;
        if outlines.is_empty() {
            return Some(());
        }
        found.place = outlines.places();
        for (axis, share) in found.share.iter_mut().enumerate() {
            *share = share.max(outlines.shadow(axis)?).min(V::Scalar::ONE);
            if V::Scalar::ONE - *share <= known() {
                *share = V::Scalar::ONE;
            }
        }
        Some(())
    }

    /// Take in what all bodies have of surface inside the cell; none if there is no room.
    fn load(&self, outlines: &mut Outlines<V::Scalar>) -> Option<()> {
        let (groups, frame) = (self.bins.groups(self.k), Frame::of(self.cell));
        let mut last = None;
        for &[n, id] in self.entries {
            if last.replace(n).is_some_and(|last| last != n) {
                outlines.finish_solid();
            }
            let Some(group) = groups.get(n as usize) else { continue };
            let Some(triangle) = self.bins.triangles(group).get(id as usize) else { continue };
            if let Some(polygon) = frame.inside(&triangle.map(Vector::to_array), self.cell) {
                outlines.add(&polygon, group.is_sheet()).then_some(())?;
            }
        }
        outlines.finish_solid();
        Some(())
    }
}
