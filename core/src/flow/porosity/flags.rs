//! One byte of marks per cell: at which faces the porosity breaks, and what kind of cell it is.

/// The two bits that say what kind of cell it is; none for a plain one. Ask with [`is`]: a kind may hold the bits of others.
pub const KIND: u8 = 3 << 6;
/// Kind of a cell with no open face, where nothing happens, and of one with an open face that the border of a porous body askew to the grid crosses: a jump of
/// porosity at all its faces. Either has no slopes.
pub const BORDER: u8 = 1 << 6;
/// Kind of a cell whose own reconstruction stays first order: less open volume than [`crate::flow::porosity::fractions::SMALL_SHARE`] of its largest face.
pub const SMALL: u8 = 2 << 6;
/// Kind of a cell that an inclined wall cuts and that is not small.
pub const INCLINED: u8 = 3 << 6;

/// Whether a mark is of a kind.
#[inline(always)]
pub const fn is(mark: u8, kind: u8) -> bool {
    mark & KIND == kind
}

/// Whether any of the marks is of the kind [`INCLINED`].
pub(crate) fn any_inclined(marks: &[u8]) -> bool {
    // The highest bit of what is left stays where both bits of the kind are set.
    marks.iter().fold(0, |a, b| a | b & (b << 1)) & 1 << 7 != 0
}

/// Whether any of the marks is of the kind [`SMALL`] or [`BORDER`].
pub(crate) fn any_small_or_border(marks: &[u8]) -> bool {
    // The highest bit of what is left stays where one bit of the kind is set and the other is not.
    marks.iter().fold(0, |a, b| a | (b ^ (b << 1))) & 1 << 7 != 0
}

/// Mark of a break at the low face of axis `d`: the porosity jumps there, or the face is closed and so a wall. None for `d` above 2.
#[inline(always)]
pub const fn break_low(d: usize) -> u8 {
    if d < 3 { 1 << (2 * d) } else { 0 }
}

/// Mark of a break at the high face of axis `d`; none for `d` above 2.
#[inline(always)]
pub const fn break_high(d: usize) -> u8 {
    if d < 3 { 2 << (2 * d) } else { 0 }
}

/// Marks of a break at any face.
pub const BREAKS: u8 = !KIND;

/// Whether any of the marks holds any of `bits`.
pub(crate) fn any_marked(marks: &[u8], bits: u8) -> bool {
    marks.iter().fold(0, |a, b| a | b) & bits != 0
}

/// The places of the marks that hold any of `bits`, in order.
pub(crate) fn marked(marks: &[u8], bits: u8) -> Marked<'_> {
    // Most rows hold none: one pass without branches tells.
    Marked { marks: if any_marked(marks, bits) { marks } else { &[] }, bits, next: 0, rest: 0 }
}

/// Iterator of [`marked`]. 64 marks become one word of bits: walking its set bits is mispredicted about once a word, not once a mark.
pub(crate) struct Marked<'a> {
    /// Marks not yet looked at, and the place of the first of them.
    marks: &'a [u8],
    next: usize,
    bits: u8,
    /// One bit for each of the marks before `next` that is still to come.
    rest: u64,
}

/// Marks looked at together.
const TOGETHER: usize = u64::BITS as usize;

impl Iterator for Marked<'_> {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        while self.rest == 0 {
            if self.marks.is_empty() {
                return None;
            }
            let (marks, after) = self.marks.split_at(self.marks.len().min(TOGETHER));
            self.marks = after;
            let mut bytes = marks.chunks_exact(8);
            for (i, eight) in (&mut bytes).enumerate() {
                self.rest |= bit_of_each(core::array::from_fn(|b| eight[b]), self.bits) << (8 * i);
            }
            let last = bytes.remainder();
            let tail = core::array::from_fn(|b| last.get(b).copied().unwrap_or(0));
            if !last.is_empty() {
                self.rest |= bit_of_each(tail, self.bits) << (marks.len() - last.len());
            }
            self.next += TOGETHER;
        }
        let place = self.rest.trailing_zeros() as usize;
        self.rest &= self.rest - 1;
        Some(self.next - TOGETHER + place)
    }
}

/// One bit for each of eight marks: whether it holds any of `bits`.
#[inline(always)]
fn bit_of_each(marks: [u8; 8], bits: u8) -> u64 {
    const LOWEST: u64 = u64::from_le_bytes([1; 8]);
    // Bit i from byte i, all meeting in the highest byte.
    const GATHER: u64 = 0x0102_0408_1020_4080;
    let mut held = u64::from_le_bytes(marks) & u64::from_le_bytes([bits; 8]);
    held |= held >> 4;
    held |= held >> 2;
    held |= held >> 1;
    (held & LOWEST).wrapping_mul(GATHER) >> 56
}
