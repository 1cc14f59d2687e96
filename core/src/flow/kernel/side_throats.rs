//! What stands beyond faces in the sides of the domain that are open less than the duct of the cell before them: louvres, holes in a wall.
//!
//! The stream that leaves through such an opening is a jet: it has the outlet's pressure in the opening, not in the cell before it, and does not get back beyond it what
//! it has of dynamic pressure. So the pressure in the duct is found that a stream without losses has left when it comes to the outlet's in the opening; or
//! that at which it chokes there.

use crate::flow::boundary::{Boundary, outlet};
use crate::flow::kernel::slab::Slab;
use crate::flow::porosity::areas::share;
use crate::flow::porosity::flags::{break_high, break_low};
use crate::flow::porosity::throat::ThroatGas;
use crate::flow::state::{Gas, Primitive};
use crate::number::real::Real;

/// The ghost beyond the low or high face, along axis `d`, of the cell `at` in a side of the domain, where `boundary` stands. States are in the frame of the axis.
#[inline(never)]
pub(in crate::flow) fn ghost_beyond<R: Real, const D: usize>(
    (slab, boundary): (&Slab<'_, R, D>, &Boundary<R, D>),
    (d, high, at): (usize, bool, [usize; D]),
    inner: &Primitive<R, D>,
    gas: Gas<R>,
) -> Primitive<R, D> {
    if let Boundary::Outlet { pressure } = boundary
        && let Some([duct, open]) = narrowed(slab, (d, high, at))
    {
        let pressure = in_duct(inner, [duct, open], (*pressure, high), gas);
        return Boundary::Outlet { pressure }.ghost_face(inner, d, !high, gas);
    }
    boundary.ghost_face(inner, d, !high, gas)
}

/// On which side of a face in a side of the domain, 0 left and 1 right, the gas is that leaves through a narrower opening of an outlet, slower than sound: then the
/// ghost is the stream in the duct before it. By the cells and the Mach numbers on both sides of the face, these positive to the right.
#[inline(never)]
pub(in crate::flow) fn jet_from<R: Real, const D: usize>(
    slab: &Slab<'_, R, D>,
    (d, cells): (usize, [Option<[usize; D]>; 2]),
    machs: [R; 2],
) -> Option<usize> {
    let (inner, at) = match cells {
        [Some(at), _] => (0, at),
        [None, Some(at)] => (1, at),
        [None, None] => return None,
    };
    let high = inner == 0;
    let [within, ghost] = if high { machs } else { [-machs[1], -machs[0]] };
    let leaves = R::ZERO < ghost && ghost < R::ONE && within < R::ONE;
    let is_jet = leaves
        && matches!(slab.problem.side(d, high, at), Boundary::Outlet { .. })
        && narrowed(slab, (d, high, at)).is_some();
    is_jet.then_some(inner)
}

/// Area of the stream before a face in a side, and of the opening, if that is a sudden narrowing.
#[inline(never)]
fn narrowed<R: Real, const D: usize>(
    slab: &Slab<'_, R, D>,
    (d, high, at): (usize, bool, [usize; D]),
) -> Option<[R; 2]> {
    let medium = slab.medium.as_ref()?;
    let cell = medium.mesh.index(at);
    let bit = if high { break_high(d) } else { break_low(d) };
    if medium.porosity.marks.get(cell)? & bit == 0 {
        return None;
    }
    let ducts = medium.ducts(d, at);
    let mut face = at;
    face[d] += usize::from(high);
    let (open, duct) = (ducts.opening(0, high), ducts.duct(0));
    let is_sudden = R::ZERO < open && open < duct && !(ducts.gentleness(0, high) > R::ZERO);
    if !is_sudden || slab.has_border(d, face) {
        return None;
    }
    let contraction = if D == 1 { R::ONE } else { medium.contraction(at, slab.old.momentum.map(|m| m[cell])) };
    let duct = share(open, duct, contraction);
    (open < duct).then_some([duct, open])
}

/// The pressure in a duct whose stream leaves through a smaller opening against a given pressure.
// Called, not inlined: few cells have such a face.
#[inline(never)]
fn in_duct<R: Real, const D: usize>(
    inner: &Primitive<R, D>,
    [duct, open]: [R; 2],
    (pressure, high): (R, bool),
    gas: Gas<R>,
) -> R {
    let mut w = *inner;
    if !high {
        w.velocity[0] = -w.velocity[0];
    }
    let (throat, c) = (ThroatGas::new(gas), gas.sound_speed(&w));
    // A stream that comes in, or faster than sound, meets what stands outside as it does without the opening.
    if !(outlet(w, pressure, gas).velocity[0] > R::ZERO && w.velocity[0] < c) {
        return pressure;
    }
    // Does the stream come to less than that in the opening, or choke before it?
    let is_too_fast = |in_duct: R| {
        let stream = outlet(w, in_duct, gas);
        let at = throat.carry(&stream, duct, open);
        stream.velocity[0] > R::ZERO && (at.passing < duct || at.state.pressure < pressure)
    };
    // No stream slower than sound has so much more at rest.
    let (mut low, mut high) = (pressure, R::from_f64(AT_REST) * R::larger(pressure, w.pressure));
    for _ in 0..MOST_STEPS {
        let middle = R::HALF * (low + high);
        if !(low < middle && middle < high) {
            break;
        }
        if is_too_fast(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

/// The pressure at rest over that of a stream at the speed of sound is less than this for any gas of γ up to 100.
const AT_REST: f64 = 4096.0;

/// More steps than the pressure takes.
const MOST_STEPS: usize = 100;
