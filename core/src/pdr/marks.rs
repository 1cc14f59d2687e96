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

/// The places of the marks that hold any of `bits`, in order.
pub(crate) fn marked(marks: &[u8], bits: u8) -> Marked<'_> {
    // Most rows hold none: one pass without branches tells.
    let any = marks.iter().fold(0, |a, b| a | b) & bits != 0;
    Marked { marks: if any { marks } else { &[] }, every: u64::from_le_bytes([bits; WORD]), next: 0, rest: 0 }
}

/// Marks looked at together.
const WORD: usize = 8;

/// Iterator of [`marked`].
pub(crate) struct Marked<'a> {
    /// Marks not yet looked at, and the place of the first of them.
    marks: &'a [u8],
    next: usize,
    /// The bits in every byte of a word.
    every: u64,
    /// What is left of the word before.
    rest: u64,
}

impl Iterator for Marked<'_> {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        while self.rest == 0 {
            let word = if let Some((word, after)) = self.marks.split_first_chunk::<WORD>() {
                self.marks = after;
                *word
            } else if self.marks.is_empty() {
                return None;
            } else {
                let last = core::mem::take(&mut self.marks);
                core::array::from_fn(|i| last.get(i).copied().unwrap_or(0))
            };
            self.rest = u64::from_le_bytes(word) & self.every;
            self.next += WORD;
        }
        let byte = self.rest.trailing_zeros() as usize / WORD;
        self.rest &= !(0xff << (WORD * byte));
        Some(self.next - WORD + byte)
    }
}
