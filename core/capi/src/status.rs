//! What a call answers, and where the fault lies if it refuses.

use core::ffi::{CStr, c_char};
use voidage_core::convex::BodyError;
use voidage_core::flow;
use voidage_core::grid::GridError;
use voidage_core::surface::bins::BinsError;
use voidage_core::surface::layer::LayerError;

/// What a call answers: 0 if it did what was asked, else why not. A call that refuses has written no results. Numbers are only ever added.
/// `vdg_status_text` has a sentence for each.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Done.
    Ok = 0,
    /// A pointer is null that must not be. `argument` names it.
    Null = 1,
    /// A pointer is not aligned as its type asks. `argument` names it.
    Misaligned = 2,
    /// A number of entries is larger than memory can hold, or does not fit another one. `argument` names it; `index` is the entry at fault,
    /// if it is one.
    Length = 3,
    /// An array to be written overlaps another one. `argument` names it.
    Overlap = 4,
    /// The memory is too small. `needed` is the number of bytes that would do.
    Memory = 5,
    /// Edges are no grid: fewer than two, not finite, not increasing, or cells too small or too large to compute with. `axis` and `index` name
    /// the edge; -1 for the axis means the grid as a whole.
    Grid = 6,
    /// A number is NaN, infinite or out of its range. `argument` names the array or field; `index` is the triangle, cell, face, body or side.
    Value = 7,
    /// A kind (of body, side, gas, scheme, ...) has no such number. `argument` names it; `index` is the body or side.
    Kind = 8,
    /// A body is none: no point, a negative radius, axes that are not at right angles, or too far away to compute with. `index` is the body.
    Body = 9,
    /// An axis is periodic on one side only. `axis` names it.
    Periodic = 10,
    /// Density or pressure of a cell is not positive and finite, so that no step can be taken. `index` is the cell.
    Unphysical = 11,
    /// This is no flow that `vdg_flow_init` made, or one of the other precision.
    Handle = 12,
    /// There is no such layer, side or number of layers. `argument` names it.
    Range = 13,
    /// The time step is too small to move the time on.
    Stalled = 14,
    /// Sizes beyond what 32-bit counts in the library can hold: more than 4e9 bodies, triangles or entries, or 2e9 cells of a flow.
    TooMany = 15,
}

impl Status {
    /// A sentence.
    pub const fn text(code: i32) -> &'static CStr {
        match code {
            0 => c"done",
            1 => c"a pointer is null that must not be",
            2 => c"a pointer is not aligned as its type asks",
            3 => c"a number of entries does not fit memory or another number of entries",
            4 => c"an array to be written overlaps another one",
            5 => c"the memory is too small",
            6 => c"the edges are no grid",
            7 => c"a number is NaN, infinite or out of its range",
            8 => c"a kind has no such number",
            9 => c"a body holds no point, or cannot be computed with",
            10 => c"an axis is periodic on one side only",
            11 => c"density or pressure of a cell is not positive and finite",
            12 => c"this is no flow of this precision",
            13 => c"there is no such layer or side",
            14 => c"the time step is too small to move the time on",
            15 => c"more entries than 32 bits count",
            _ => c"no status of this library",
        }
    }
}

/// Where a fault lies. The status says which of its entries count; the others are -1 and 0.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Fault {
    /// Name of the argument or of its field, in static memory; never null, empty if there is none to name.
    pub argument: *const c_char,
    /// 0, 1, 2 for x, y, z; else -1.
    pub axis: i32,
    /// The edge, triangle, cell, face, body or side at fault, counted from 0 in its array.
    pub index: usize,
    /// Bytes of memory that would do.
    pub needed: usize,
}

/// A call that is refused.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Refusal {
    pub(crate) status: Status,
    pub(crate) fault: Fault,
}

/// What a call comes to.
pub(crate) type Answer<T = ()> = Result<T, Refusal>;

impl Status {
    /// Refuses, naming an argument.
    pub(crate) const fn of(self, argument: &'static CStr) -> Refusal {
        Refusal { status: self, fault: Fault { argument: argument.as_ptr(), axis: -1, index: 0, needed: 0 } }
    }
}

impl Refusal {
    pub(crate) const fn axis(mut self, axis: usize) -> Self {
        self.fault.axis = axis as i32;
        self
    }

    pub(crate) const fn index(mut self, index: usize) -> Self {
        self.fault.index = index;
        self
    }

    /// Memory of so many bytes would do.
    pub(crate) const fn bytes(needed: usize) -> Self {
        let mut refusal = Status::Memory.of(c"bytes");
        refusal.fault.needed = needed;
        refusal
    }
}

/// The status of an answer; `fault`, unless null, learns where it lies. It may be anywhere, aligned or not.
///
/// # Safety
/// `fault` is null or can be written.
pub(crate) unsafe fn told(answer: Answer, fault: *mut Fault) -> Status {
    let Refusal { status, fault: found } = answer.err().unwrap_or(Status::Ok.of(c""));
    if !fault.is_null() {
        unsafe { fault.write_unaligned(found) };
    }
    status
}

impl From<GridError> for Refusal {
    fn from(error: GridError) -> Self {
        let of = |axis, index| Status::Grid.of(c"grid").axis(axis).index(index);
        match error {
            GridError::NoCell { axis } => of(axis, 0),
            GridError::NotFinite { axis, index } | GridError::NotIncreasing { axis, index } => of(axis, index),
            _ => Status::Grid.of(c"grid"),
        }
    }
}

impl From<BinsError> for Refusal {
    fn from(_: BinsError) -> Self {
        // Coordinates and memory have been checked before.
        Status::TooMany.of(c"surface")
    }
}

impl From<LayerError> for Refusal {
    fn from(_: LayerError) -> Self {
        // Slices are cut for the grid they are used with, so this is not reached.
        Status::Length.of(c"grid")
    }
}

impl From<BodyError> for Refusal {
    fn from(error: BodyError) -> Self {
        match error {
            BodyError::NotFinite => Status::Value.of(c"body"),
            _ => Status::Body.of(c"body"),
        }
    }
}

impl From<flow::Error> for Refusal {
    fn from(error: flow::Error) -> Self {
        match error {
            flow::Error::HalfPeriodic { axis } => Status::Periodic.of(c"side").axis(axis),
            flow::Error::Width { axis, cell } => Status::Grid.of(c"grid").axis(axis).index(cell),
            flow::Error::Gas => Status::Value.of(c"gas"),
            flow::Error::Side { axis } => Status::Value.of(c"side").axis(axis),
            flow::Error::Step => Status::Value.of(c"dt"),
            flow::Error::Stalled => Status::Stalled.of(c"dt"),
            flow::Error::CellFraction { cell } => Status::Value.of(c"case.beta_v").index(cell),
            flow::Error::FaceFraction { axis, face } => Status::Value.of(c"case.beta").axis(axis).index(face),
            flow::Error::Unphysical { cell } => Status::Unphysical.of(c"state").index(cell),
            flow::Error::TooManyCells => Status::TooMany.of(c"grid"),
            _ => Status::Length.of(c"grid"),
        }
    }
}

/// Version of the library: 10000 major + 100 minor + patch, to be compared with `VDG_VERSION` of the header.
#[unsafe(no_mangle)]
pub extern "C" fn vdg_version() -> u32 {
    VDG_VERSION
}

/// Version of the header: 10000 major + 100 minor + patch.
pub const VDG_VERSION: u32 = 100;

/// A sentence for a status, in static memory; never null.
#[unsafe(no_mangle)]
pub extern "C" fn vdg_status_text(status: i32) -> *const c_char {
    Status::text(status).as_ptr()
}
