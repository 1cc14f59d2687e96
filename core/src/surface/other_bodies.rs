//! Bodies beside those of triangles.

use crate::grid::Grid;
use crate::grid::bounds::Bounds;
use crate::grid::fields::Layer;
use crate::number::aabb::Aabb;
use crate::number::real::Vector;
use crate::surface::union::PlanarPart;

/// Bodies that enter a layer by another road than their triangles: known by formula, or subdivided. Their shares of a cell or face are
/// given as bounds of their union, and they take no part in exact unions: a cell that they share with a surface is divided, unless
/// they tell of their own what they have in common with it.
///
/// The unit type stands for none.
pub trait OtherBodies<V: Vector> {
    /// There are none.
    fn is_empty(&self) -> bool;
    /// A box around each.
    fn boxes(&self) -> impl Iterator<Item = Aabb<V>>;
    /// Add them to the cells of layer `k` of a grid, and with `areas` to its x and y faces and to the z faces below.
    fn add(&mut self, grid: &Grid<V::Scalar>, k: usize, areas: bool, layer: &mut Layer<V::Scalar>);
    /// Add them to the z faces in plane `plane` of a grid, which are the z faces of `layer`.
    fn add_plane(&mut self, grid: &Grid<V::Scalar>, plane: usize, layer: &mut Layer<V::Scalar>);
    /// May one of them reach a cell or its sides?
    fn reach(&mut self, cell: Aabb<V>) -> bool;
    /// Do they know more of their union with other bodies than by their own shares?
    const UNITES: bool = false;
    /// Bounds of the union of all that reach a cell with bodies of which the convex parts in it are given: of the cell, of its low x, y and z
    /// face and of its high ones, so far as they are `wanted`; where the cell is a face, flat along one axis, only the first are asked for, and bodies lie
    /// on one of its sides or on both. None if they know no more than by their own shares.
    fn union_with(
        &mut self,
        cell: Aabb<V>,
        bodies: &[PlanarPart<V::Scalar>],
        wanted: [bool; 7],
    ) -> Option<[Bounds<V::Scalar>; 7]> {
        let _ = (cell, bodies, wanted);
        None
    }
}

impl<V: Vector> OtherBodies<V> for () {
    fn is_empty(&self) -> bool {
        true
    }
    fn boxes(&self) -> impl Iterator<Item = Aabb<V>> {
        core::iter::empty()
    }
    fn add(&mut self, _: &Grid<V::Scalar>, _: usize, _: bool, _: &mut Layer<V::Scalar>) {}
    fn add_plane(&mut self, _: &Grid<V::Scalar>, _: usize, _: &mut Layer<V::Scalar>) {}
    fn reach(&mut self, _: Aabb<V>) -> bool {
        false
    }
}
