//! Porosity of bodies of triangles in some layers of a grid.

use crate::grid::{Window, checked};
use crate::input::{Arrays, all, give, given, same_layout};
use crate::memory::{Cut, Measure, Memory};
use crate::status::{Answer, Refusal, Status};
use crate::types::{self, Beta, Fractions, Options, PorosityReport};
use core::slice;
use voidage_core::number::real::{Real, Vector};
use voidage_core::surface::OtherBodies;
use voidage_core::surface::bins::{BinsNeeded, Group, Surface};
use voidage_core::surface::layer::{LayerMemory, LayerOptions, LayerReport, LayerSlices, Layers, MemoryNeeded};
use voidage_core::surface::union::{Fragment, Node, Octant, Part, PendingNode, Piece, UnionMemory};

/// The arguments of a call: bodies in a grid, and options.
#[derive(Clone, Copy)]
pub struct Question<R> {
    pub grid: *const types::Grid<R>,
    pub surface: *const types::Surface<R>,
    pub options: *const Options<R>,
}

/// Where the answer goes, and memory.
#[derive(Clone, Copy)]
pub struct Reply<R> {
    pub fractions: *const Fractions<R>,
    pub work: *mut u8,
    pub bytes: usize,
    pub report: *mut PorosityReport<R>,
}

/// Bodies of triangles, checked.
#[derive(Clone, Copy)]
pub struct Bodies<'a, V> {
    triangles: &'a [[V; 3]],
    /// Where each begins, and the last ends; none if there is one only.
    first: Option<&'a [usize]>,
    sheets: &'a [u8],
}

impl<'a, V: Vector> Bodies<'a, V> {
    const NONE: Self = Bodies { triangles: &[], first: Some(&[0]), sheets: &[] };

    unsafe fn checked(arrays: &mut Arrays, surface: &types::Surface<V::Scalar>) -> Answer<Self> {
        const { assert!(same_layout::<[V; 3], V::Scalar, 9>()) }
        let Some(numbers) = surface.triangles.checked_mul(9) else {
            return Err(Status::Length.of(c"surface.triangles"));
        };
        let corners = unsafe { arrays.read(surface.corners, numbers, c"surface.corners")? };
        // Triangles have the layout of nine numbers.
        let triangles = unsafe { slice::from_raw_parts(corners.as_ptr().cast::<[V; 3]>(), surface.triangles) };
        let broken = |refusal: Refusal| refusal.index(refusal.fault.index / 9);
        all(corners, Real::is_finite, c"surface.corners").map_err(broken)?;
        if surface.first.is_null() {
            let sheets = if surface.sheets.is_null() { 0 } else { 1 };
            let sheets = unsafe { arrays.read(surface.sheets, sheets, c"surface.sheets")? };
            return Ok(Bodies { triangles, first: None, sheets });
        }
        let Some(count) = surface.bodies.checked_add(1) else { return Err(Status::Length.of(c"surface.bodies")) };
        let first = unsafe { arrays.read(surface.first, count, c"surface.first")? };
        let sheets = if surface.sheets.is_null() { 0 } else { surface.bodies };
        let sheets = unsafe { arrays.read(surface.sheets, sheets, c"surface.sheets")? };
        let mut before = 0;
        for (index, &at) in first.iter().enumerate() {
            if at < before || at > surface.triangles {
                return Err(Status::Length.of(c"surface.first").index(index));
            }
            before = at;
        }
        Ok(Bodies { triangles, first: Some(first), sheets })
    }

    pub fn len(&self) -> usize {
        self.first.map_or(1, |first| first.len().saturating_sub(1))
    }

    fn get(&self, body: usize) -> Surface<'a, V> {
        let run = self.first.map_or(0..self.triangles.len(), |first| {
            first.get(body).copied().unwrap_or(0)..first.get(body + 1).copied().unwrap_or(0)
        });
        let triangles = self.triangles.get(run).unwrap_or_default();
        if self.sheets.get(body).is_some_and(|&sheet| sheet != 0) {
            Surface::sheet(triangles)
        } else {
            Surface::new(triangles)
        }
    }

    fn iter(self) -> impl Iterator<Item = Surface<'a, V>> + Clone {
        (0..self.len()).map(move |body| self.get(body))
    }
}

/// Arguments of a call that have been checked.
pub struct Checked<'a, V: Vector> {
    pub window: Window<'a, V::Scalar>,
    pub bodies: Bodies<'a, V>,
    pub options: LayerOptions<V::Scalar>,
    pieces: usize,
}

impl<R: Real> Question<R> {
    /// Not inlined, as other parts of a call: then the stack of one is free when the next begins.
    ///
    /// # Safety
    /// As of [`Arrays::read`].
    #[inline(never)]
    pub unsafe fn checked<'a>(&self, arrays: &mut Arrays) -> Answer<Checked<'a, R::Vector>> {
        unsafe {
            let grid = checked(arrays, &given(self.grid, c"grid")?)?;
            let none = Options { tol: R::ZERO, depth: 0, pieces: 0, first_layer: 0, layers: 0 };
            let options = if self.options.is_null() { none } else { given(self.options, c"options")? };
            if !(options.tol >= R::ZERO && options.tol.is_finite()) {
                return Err(Status::Value.of(c"options.tol"));
            }
            let window = Window::new(grid, options.first_layer, options.layers)?;
            let bodies = if self.surface.is_null() {
                Bodies::NONE
            } else {
                Bodies::checked(arrays, &given(self.surface, c"surface")?)?
            };
            let usual = LayerOptions::default();
            let tol = if options.tol > R::ZERO { options.tol } else { usual.tol };
            let depth = if options.depth > 0 { options.depth } else { usual.depth };
            let pieces = if options.pieces > 0 { options.pieces as usize } else { USUAL_PIECES };
            Ok(Checked { window, bodies, options: LayerOptions { tol, depth, ..usual }, pieces })
        }
    }
}

/// Pieces of surface in one cell for which a union is attempted, as in the host.
const USUAL_PIECES: usize = 1024;

/// Memory for bodies of triangles.
pub struct SurfaceWork<'m, V: Vector> {
    bodies: &'m mut [Surface<'m, V>],
    numbers: &'m mut [u32],
    groups: &'m mut [Group<V>],
    reals: &'m mut [V::Scalar],
    flags: &'m mut [u8],
    layer_numbers: &'m mut [u32],
    layer_groups: &'m mut [Group<V>],
    union: UnionMemory<'m, V::Scalar>,
}

impl<'a, V: Vector> Checked<'a, V> {
    /// Memory for this question; `others`: there are bodies beside those of triangles.
    #[inline(never)]
    pub fn work<'m, M: Memory<'m>>(&self, memory: &mut M, others: bool) -> SurfaceWork<'m, V>
    where
        'a: 'm,
    {
        let (grid, bodies) = (&self.window.grid, self.bodies);
        let (bins, mut layer) = Layers::all_needed(grid, bodies.iter(), self.options);
        let mut pieces = self.pieces;
        // Only bodies that share cells ask for more than sums.
        if bodies.len() + usize::from(others) < 2 {
            (layer, pieces) = (LayerMemory::<V>::needed(grid), 0);
        }
        let BinsNeeded { numbers, groups } = bins;
        let MemoryNeeded { reals, flags, numbers: layer_numbers, groups: layer_groups } = layer;
        let group = |_| Group::default();
        let room = UnionMemory::<V::Scalar>::needed(pieces);
        SurfaceWork {
            bodies: memory.take(bodies.len(), |body| bodies.get(body)),
            numbers: memory.take(numbers, |_| 0),
            groups: memory.take(groups, group),
            reals: memory.take(reals, |_| V::Scalar::ZERO),
            flags: memory.take(flags, |_| 0),
            layer_numbers: memory.take(layer_numbers, |_| 0),
            layer_groups: memory.take(layer_groups, group),
            union: UnionMemory {
                pieces: memory.take(room.pieces, |_| Piece::default()),
                split_pieces: memory.take(room.split_pieces, |_| Piece::default()),
                order: memory.take(room.order, |_| 0),
                nodes: memory.take(room.nodes, |_| Node::default()),
                parts: memory.take(room.parts, |_| Part::default()),
                fragments: memory.take(room.fragments, |_| Fragment::default()),
                pending: memory.take(room.pending, |_| PendingNode::default()),
                octants: memory.take(room.octants, |_| Octant::default()),
                near: memory.take(room.near, |_| 0),
            },
        }
    }
}

/// Open fractions of some layers: cells, x, y and z faces; faces all empty if not wanted.
type Slices<'o, R> = [&'o mut [R]; 4];

/// The caller's arrays, checked.
pub struct Outputs<'o, R> {
    value: Slices<'o, R>,
    bounds: Option<[Slices<'o, R>; 2]>,
    /// Faces are wanted.
    areas: bool,
}

impl<R: Real> Reply<R> {
    /// # Safety
    /// As of [`Arrays::write`].
    #[inline(never)]
    pub unsafe fn checked<'o>(&self, arrays: &mut Arrays, window: &Window<R>) -> Answer<Outputs<'o, R>> {
        let Fractions { value, lower, upper } = unsafe { given(self.fractions, c"fractions")? };
        let areas = !(value.x.is_null() && value.y.is_null() && value.z.is_null());
        let mut set = |beta: Beta<R>, names: [&'static core::ffi::CStr; 4]| -> Answer<Slices<'o, R>> {
            let [cells, x, y, z] = window.lengths();
            let faces = if areas { [x, y, z] } else { [0; 3] };
            unsafe {
                Ok([
                    arrays.write(beta.v, cells, names[0])?,
                    arrays.write(beta.x, faces[0], names[1])?,
                    arrays.write(beta.y, faces[1], names[2])?,
                    arrays.write(beta.z, faces[2], names[3])?,
                ])
            }
        };
        let value = set(value, [c"value.v", c"value.x", c"value.y", c"value.z"])?;
        if [lower, upper].into_iter().flat_map(|b| [b.v, b.x, b.y, b.z]).all(|first| first.is_null()) {
            return Ok(Outputs { value, bounds: None, areas });
        }
        let lower = set(lower, [c"lower.v", c"lower.x", c"lower.y", c"lower.z"])?;
        let upper = set(upper, [c"upper.v", c"upper.x", c"upper.y", c"upper.z"])?;
        Ok(Outputs { value, bounds: Some([lower, upper]), areas })
    }
}

/// One layer of some.
fn layer<'o, R: Real>(slices: &'o mut Slices<R>, window: &Window<R>, n: usize) -> LayerSlices<'o, R> {
    fn nth<R>(all: &mut [R], n: usize, length: usize) -> &mut [R] {
        all.get_mut(n * length..(n + 1) * length).unwrap_or_default()
    }
    let [nx, ny, _] = window.grid.cells();
    let [v, x, y, z] = slices;
    let (z, above) = z.split_at_mut(z.len().min(nx * ny * (n + 1)));
    let topmost = window.to_top && n + 1 == window.count;
    LayerSlices::new(
        nth(v, n, nx * ny),
        nth(x, n, (nx + 1) * ny),
        nth(y, n, nx * (ny + 1)),
        nth(z, n, nx * ny),
        if topmost { above } else { &mut [] },
    )
}

/// Computes the layers asked for, and adds to `total` what was found.
#[inline(never)]
pub fn run<V: Vector, O: OtherBodies<V>>(
    asked: &Checked<V>,
    outputs: &mut Outputs<V::Scalar>,
    work: SurfaceWork<V>,
    others: &mut O,
    total: &mut PorosityReport<V::Scalar>,
) -> Answer {
    let window = &asked.window;
    let SurfaceWork { bodies, numbers, groups, reals, flags, layer_numbers, layer_groups, union } = work;
    let options = LayerOptions { areas: outputs.areas, ..asked.options };
    let layers = Layers::new(&window.grid, bodies, options, numbers, groups)?;
    let memory = LayerMemory::new(&window.grid, reals, flags, layer_numbers, layer_groups, union);
    let mut memory = memory.map_err(|_| Status::Memory.of(c"work"))?;
    let zero = V::Scalar::ZERO;
    outputs.value.iter_mut().for_each(|field| field.fill(zero));
    let mut worst = zero;
    for n in 0..window.count {
        let value = layer(&mut outputs.value, window, n);
        let bounds = outputs.bounds.as_mut();
        let bounds = bounds.map(|[lower, upper]| [layer(lower, window, n), layer(upper, window, n)]);
        let found = layers.zeroed_layer(window.first + n, value, bounds, &mut memory, others, |body, defects| {
            if defects.leak > worst {
                (worst, total.leaky_body) = (defects.leak, body);
            }
        })?;
        add(total, &found);
    }
    Ok(())
}

fn add<R: Real>(total: &mut PorosityReport<R>, layer: &LayerReport<R>) {
    total.solid_volume += layer.solid_volume;
    total.max_gap = total.max_gap.larger(layer.max_gap);
    total.leak = total.leak.larger(layer.defects.leak);
    total.winding = total.winding.larger(layer.defects.winding);
    total.open += layer.cells.open;
    total.cut += layer.cells.cut;
    total.closed += layer.cells.closed;
    total.shared += layer.cells.ambiguous;
    total.divided += layer.divided;
}

/// Bytes of work for surfaces alone.
///
/// # Safety
/// As of [`Arrays::read`].
pub unsafe fn work_bytes<R: Real>(question: &Question<R>) -> usize {
    let Ok(asked) = (unsafe { surface_of(question, &mut Arrays::new()) }) else { return usize::MAX };
    bytes_for(&asked)
}

#[inline(never)]
fn bytes_for<V: Vector>(asked: &Checked<V>) -> usize {
    let mut measure = Measure::new();
    asked.work(&mut measure, false);
    measure.bytes()
}

unsafe fn surface_of<'a, R: Real>(question: &Question<R>, arrays: &mut Arrays) -> Answer<Checked<'a, R::Vector>> {
    if question.surface.is_null() {
        return Err(Status::Null.of(c"surface"));
    }
    unsafe { question.checked(arrays) }
}

/// Porosity of surfaces alone.
///
/// # Safety
/// As of [`Arrays::read`] and [`Arrays::write`]; `report` is null or can be written.
pub unsafe fn porosity<R: Real>(question: &Question<R>, reply: &Reply<R>) -> Answer {
    unsafe {
        // Looked at where it lies: moved, it would lie on the stack twice.
        let mut opened = opened(question, reply);
        let (asked, outputs, needed) = opened.as_mut().map_err(|refusal| *refusal)?;
        let work = asked.work(&mut Cut::new(reply.work, *needed), false);
        let mut report = PorosityReport::default();
        run(asked, outputs, work, &mut (), &mut report)?;
        give(reply.report, report);
    }
    Ok(())
}

/// What is asked, where the answer goes, and bytes of work, all checked.
type Opened<'a, 'o, V> = (Checked<'a, V>, Outputs<'o, <V as Vector>::Scalar>, usize);

#[inline(never)]
unsafe fn opened<'a, 'o, R: Real>(question: &Question<R>, reply: &Reply<R>) -> Answer<Opened<'a, 'o, R::Vector>> {
    let mut arrays = Arrays::new();
    unsafe {
        let asked = surface_of(question, &mut arrays)?;
        let outputs = reply.checked(&mut arrays, &asked.window)?;
        let needed = bytes_for(&asked);
        arrays.work(reply.work, reply.bytes, needed)?;
        Ok((asked, outputs, needed))
    }
}
