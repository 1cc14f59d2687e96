//! Bounds of the solid fractions of a layer: each body's share, narrowed where bodies share cells.

use super::report::LayerReport;
use crate::grid::fields::Layer;
use crate::number::real::{Real, Vector};
use crate::surface::bins::Group;
use crate::surface::cell_unions::{self, UnionSums};
use crate::surface::cells::{Scratch, add_body_and};
use crate::surface::division::{Shared, Site, SpareMemory};
use crate::surface::error::{Defects, SurfaceError};
use crate::surface::other_bodies::OtherBodies;
use crate::surface::surface_area::PieceSums;
use crate::surface::walls;
use crate::surface::z_faces::{Side, add_section};

/// Bounds of the solid fractions of a layer: body by body, narrowed where bodies share cells. `layer` holds zeros before; `pieces` is told
/// of all surface in the layer.
pub(super) fn solid_bounds<V: Vector, O: OtherBodies<V>, P: UnionSums<V>>(
    shared: &mut Shared<V, O>,
    site: &Site<V>,
    layer: &mut Layer<V::Scalar>,
    scratch: &mut Scratch<V::Scalar>,
    mut spare: SpareMemory<V>,
    pieces: &mut P,
    mut each_body: impl FnMut(usize, Defects<V::Scalar>),
) -> LayerReport<V::Scalar> {
    let mut report = LayerReport::default();
    let groups = site.bins.groups(site.k);
    for group in groups {
        // All that could be refused has been checked; if it were not, the body would be told as broken.
        let broken = Defects { leak: V::Scalar::INFINITY, winding: V::Scalar::INFINITY };
        let defects = add_group(site, group, layer, scratch, pieces).unwrap_or(broken);
        report.defects = report.defects.worst(defects);
        each_body(group.body as usize, defects);
    }
    shared.others.add(site.grid, site.k, site.areas, layer);
    if groups.len() > usize::from(shared.others.is_empty()) {
        let resolved = cell_unions::resolve(shared, site, layer, spare.reborrow(), pieces);
        if pieces.wants_fractions() {
            walls::resolve(shared, site, layer, spare);
        }
        (report.cells.ambiguous, report.divided) = (resolved.ambiguous, resolved.divided);
    }
    report
}

/// Add a body to the cells and faces of a layer.
fn add_group<V: Vector, P: PieceSums<V::Scalar>>(
    site: &Site<V>,
    group: &Group<V>,
    layer: &mut Layer<V::Scalar>,
    scratch: &mut Scratch<V::Scalar>,
    pieces: &mut P,
) -> Result<Defects<V::Scalar>, SurfaceError> {
    let (triangles, ids) = (site.bins.triangles(group), site.bins.ids(group));
    pieces.begin_body(group.body, group.is_sheet());
    let mut defects = add_body_and(site.grid, site.k, (triangles, ids), scratch, layer, pieces)?;
    if site.areas {
        let leak = add_section(site.grid, site.k, Side::Above, triangles, ids, scratch, layer)?;
        defects.leak = defects.leak.max(leak);
    }
    Ok(defects)
}

/// Bounds of the solid fractions of the z faces above a layer, as the z faces of `layer`, whose sums hold zeros before.
pub(super) fn solid_bounds_on_top<V: Vector, O: OtherBodies<V>>(
    shared: &mut Shared<V, O>,
    site: &Site<V>,
    layer: &mut Layer<V::Scalar>,
    scratch: &mut Scratch<V::Scalar>,
    mut spare: SpareMemory<V>,
) {
    layer.lower.z.fill(V::Scalar::ZERO);
    layer.has_surface.z.fill(0);
    for group in site.bins.groups(site.k) {
        let (triangles, ids) = (site.bins.triangles(group), site.bins.ids(group));
        // What it leaks the section below told, or the one above the grid, which is not asked.
        let _ = add_section(site.grid, site.k + 1, Side::Below, triangles, ids, scratch, layer);
    }
    shared.others.add_plane(site.grid, site.k + 1, layer);
    cell_unions::resolve_top(shared, site, layer, spare.reborrow());
    walls::resolve_top(shared, site, layer, spare);
}
