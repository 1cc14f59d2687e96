//! Arrays of f64 as little-endian bytes.

use std::io::{self, Write};

/// Values converted at a time; their bytes stay in the L2 cache and fill the file's buffer exactly.
const BLOCK: usize = super::whole::BUFFER / 8;

/// Writes all values, a block at a time.
pub(crate) fn write_f64(out: &mut dyn Write, data: &[f64]) -> io::Result<()> {
    let mut bytes = vec![0; 8 * BLOCK.min(data.len())];
    for values in data.chunks(BLOCK) {
        let bytes = &mut bytes[..8 * values.len()];
        encode(values, bytes);
        out.write_all(bytes)?;
    }
    Ok(())
}

/// Fills `bytes`, eight for each value; compiles to a copy on little-endian machines.
pub(super) fn encode(values: &[f64], bytes: &mut [u8]) {
    for (to, value) in bytes.chunks_exact_mut(8).zip(values) {
        to.copy_from_slice(&value.to_le_bytes());
    }
}
