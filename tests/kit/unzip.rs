//! The members of a ZIP archive as NumPy writes it: stored or deflated, without encryption, in one file below 4 GiB.
//!
//! Reference: PKWARE, APPNOTE.TXT, sec. 4.3 (central directory 4.3.12, its end 4.3.16, local headers 4.3.7).

/// Name and content of each member.
///
/// # Panics
/// If the archive is not one of these, or a checksum is wrong.
#[must_use]
pub fn members(archive: &[u8]) -> Vec<(String, Vec<u8>)> {
    let end = archive.windows(4).rposition(|w| w == b"PK\x05\x06").expect("a zip archive");
    let (count, mut at) = (two(archive, end + 10), four(archive, end + 16));
    let mut all = Vec::with_capacity(count);
    for _ in 0..count {
        assert_eq!(&archive[at..at + 4], b"PK\x01\x02", "an entry of the central directory");
        let [name, extra, comment] = [28, 30, 32].map(|field| two(archive, at + field));
        let text = String::from_utf8(archive[at + 46..at + 46 + name].to_vec()).expect("a name");
        all.push((text, content(archive, at)));
        at += 46 + name + extra + comment;
    }
    all
}

/// What an entry of the central directory tells of.
fn content(archive: &[u8], entry: usize) -> Vec<u8> {
    let [packed, length, local] = [20, 24, 42].map(|field| four(archive, entry + field));
    let begin = local + 30 + two(archive, local + 26) + two(archive, local + 28);
    let packed = &archive[begin..begin + packed];
    let bytes = match two(archive, entry + 10) {
        0 => packed.to_vec(),
        8 => miniz_oxide::inflate::decompress_to_vec_with_limit(packed, length).expect("a deflated member"),
        method => panic!("compression {method} is not read here"),
    };
    assert_eq!(bytes.len(), length, "the length of a member");
    assert_eq!(crc32fast::hash(&bytes) as usize, four(archive, entry + 16), "the checksum of a member");
    bytes
}

fn two(bytes: &[u8], at: usize) -> usize {
    usize::from(u16::from_le_bytes(bytes[at..at + 2].try_into().expect("two bytes")))
}

fn four(bytes: &[u8], at: usize) -> usize {
    u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes")) as usize
}
