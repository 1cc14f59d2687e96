//! One byte of marks per cell: at which faces the porosity breaks, and what kind of cell it is.

/// The two bits that say what kind of cell it is; none for a plain one.
pub const KIND: u8 = 3 << 6;
/// Kind of a cell with no open face: nothing happens there.
pub const SEALED: u8 = 1 << 6;
/// Kind of a cell whose own reconstruction stays first order: less open volume than [`super::medium::SMALL_SHARE`] of its largest face.
pub const SMALL: u8 = 2 << 6;

/// Whether a mark is of a kind.
#[inline(always)]
pub const fn is(mark: u8, kind: u8) -> bool {
    mark & KIND == kind
}

/// Mark of a break at the low face of axis `d`: the porosity jumps there, or the face is closed and so a wall.
#[inline(always)]
pub const fn break_low(d: usize) -> u8 {
    1 << (2 * d)
}

/// Mark of a break at the high face of axis `d`.
#[inline(always)]
pub const fn break_high(d: usize) -> u8 {
    2 << (2 * d)
}

/// The places of the marks that hold any of `bits`, in order. Eight at a time are looked at, as most hold none.
pub(crate) fn marked(marks: &[u8], bits: u8) -> impl Iterator<Item = usize> + '_ {
    const WORD: usize = 8;
    let every = u64::from_le_bytes([bits; WORD]);
    marks.chunks(WORD).enumerate().flat_map(move |(chunk, bytes)| {
        let mut word = [0; WORD];
        word[..bytes.len()].copy_from_slice(bytes);
        let mut rest = u64::from_le_bytes(word) & every;
        core::iter::from_fn(move || {
            let byte = rest.trailing_zeros() as usize / WORD;
            if byte == WORD {
                return None;
            }
            rest &= !(0xff << (WORD * byte));
            Some(chunk * WORD + byte)
        })
    })
}
