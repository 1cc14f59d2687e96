//! Reader of NPY files: f32 or f64, either byte order, either index order, versions 1 to 3.

use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::Path;

use super::MAGIC;
use crate::error::{Error, Result};

/// Longest header accepted; NumPy's own limit is 10 000 characters.
const LONGEST_HEADER: usize = 1 << 20;

/// Reads an array: its shape as NumPy shows it, and its values with the first index fastest.
///
/// # Errors
/// The file cannot be read, is no NPY file, holds other than real floating-point numbers, or fewer or more bytes than
/// its shape needs.
pub fn read(path: &Path) -> Result<(Vec<usize>, Vec<f64>)> {
    let mut file = BufReader::new(File::open(path).map_err(|e| Error::io(path, "open", &e))?);
    let header = header_text(&mut file).and_then(|text| Header::parse(&text));
    let header = header.map_err(|reason| Error::at(path, "header", reason))?;
    let data = values(&mut file, &header).map_err(|reason| Error::at(path, "data", reason))?;
    Ok(if header.fortran { (header.shape, data) } else { first_index_fastest(header.shape, data) })
}

/// Or the reason, without the file's name.
type Checked<T> = std::result::Result<T, String>;

fn fill(file: &mut impl Read, bytes: &mut [u8]) -> Checked<()> {
    file.read_exact(bytes).map_err(|cause| match cause.kind() {
        io::ErrorKind::UnexpectedEof => "the file ends too early".into(),
        _ => format!("cannot read: {cause}"),
    })
}

fn header_text(file: &mut impl Read) -> Checked<String> {
    let mut start = [0; 8];
    let read = fill(file, &mut start);
    if start[..6] != *MAGIC {
        return Err("this is not a NumPy .npy file".into());
    }
    read?;
    let mut length = [0; 4]; // little endian: two bytes fill the lower half
    match start[6] {
        1 => fill(file, &mut length[..2])?,
        2 | 3 => fill(file, &mut length)?,
        version => return Err(format!("NPY version {version} is not known; 1 to 3 are")),
    }
    let length = u32::from_le_bytes(length) as usize;
    if length > LONGEST_HEADER {
        return Err(format!("a length of {length} bytes cannot be right"));
    }
    let mut bytes = vec![0; length];
    fill(file, &mut bytes)?;
    String::from_utf8(bytes).map_err(|_| "it is not plain text".into())
}

/// What the dictionary says.
#[derive(Debug, PartialEq)]
struct Header {
    big_endian: bool,
    /// Bytes of a value: 4 or 8.
    size: usize,
    fortran: bool,
    shape: Vec<usize>,
}

impl Header {
    fn parse(text: &str) -> Checked<Self> {
        let mut rest = Cursor(text);
        let (mut descr, mut fortran, mut shape) = (None, None, None);
        rest.expect('{')?;
        while !rest.eat('}') {
            let key = rest.quoted()?;
            rest.expect(':')?;
            match key {
                "descr" if rest.eat('[') => return Err("records are not supported; save one plain array".into()),
                "descr" => descr = Some(rest.quoted()?),
                "fortran_order" => fortran = Some(rest.boolean()?),
                "shape" => shape = Some(rest.tuple()?),
                _ => return Err(format!("key '{key}' is not known")),
            }
            if !rest.eat(',') {
                rest.expect('}')?;
                break;
            }
        }
        let (Some(descr), Some(fortran), Some(shape)) = (descr, fortran, shape) else {
            return Err("descr, fortran_order or shape is missing".into());
        };
        let (big_endian, size) = match descr {
            "<f8" => (false, 8),
            ">f8" => (true, 8),
            "<f4" => (false, 4),
            ">f4" => (true, 4),
            other => return Err(format!("type '{other}' is not supported; save with .astype('<f8')")),
        };
        Ok(Header { big_endian, size, fortran, shape })
    }
}

/// The part of a Python literal not yet read.
struct Cursor<'a>(&'a str);

impl<'a> Cursor<'a> {
    fn eat(&mut self, wanted: char) -> bool {
        self.0 = self.0.trim_start();
        let rest = self.0.strip_prefix(wanted);
        self.0 = rest.unwrap_or(self.0);
        rest.is_some()
    }

    fn expect(&mut self, wanted: char) -> Checked<()> {
        if self.eat(wanted) { Ok(()) } else { Err(format!("'{wanted}' expected before '{}'", self.start())) }
    }

    fn quoted(&mut self) -> Checked<&'a str> {
        let quote = if self.eat('"') { '"' } else { self.expect('\'').map(|()| '\'')? };
        let (word, rest) = self.0.split_once(quote).ok_or("a quotation mark is missing")?;
        self.0 = rest;
        Ok(word)
    }

    fn boolean(&mut self) -> Checked<bool> {
        self.0 = self.0.trim_start();
        let (value, rest) = if let Some(rest) = self.0.strip_prefix("True") {
            (true, rest)
        } else if let Some(rest) = self.0.strip_prefix("False") {
            (false, rest)
        } else {
            return Err(format!("True or False expected before '{}'", self.start()));
        };
        self.0 = rest;
        Ok(value)
    }

    fn tuple(&mut self) -> Checked<Vec<usize>> {
        let mut numbers = vec![];
        self.expect('(')?;
        while !self.eat(')') {
            self.0 = self.0.trim_start();
            let digits = self.0.bytes().take_while(u8::is_ascii_digit).count();
            let number = self.0[..digits].parse().map_err(|_| format!("no size: '{}'", self.start()))?;
            numbers.push(number);
            self.0 = &self.0[digits..];
            self.eat('L'); // Python 2
            if !self.eat(',') {
                self.expect(')')?;
                break;
            }
        }
        Ok(numbers)
    }

    fn start(&self) -> String {
        self.0.chars().take(12).collect()
    }
}

/// The values in file order. Memory is taken only for what the file really holds.
fn values(file: &mut BufReader<File>, header: &Header) -> Checked<Vec<f64>> {
    const BLOCK: usize = 1 << 16;
    let shape = &header.shape;
    let count = shape.iter().try_fold(1usize, |n, &m| n.checked_mul(m));
    let bytes = count.and_then(|n| n.checked_mul(header.size)).ok_or(format!("the shape {shape:?} is too large"))?;
    let mut data = Vec::new();
    data.try_reserve_exact(known_length(file.get_ref(), bytes) / header.size)
        .map_err(|_| format!("{bytes} bytes do not fit into memory"))?;
    let mut block = vec![0; BLOCK.min(bytes)];
    let mut left = bytes;
    while left > 0 {
        let block = &mut block[..left.min(BLOCK)];
        fill(file, block).map_err(|e| format!("{e}; the shape {shape:?} needs {bytes} bytes"))?;
        decode(block, header, &mut data);
        left -= block.len();
    }
    if fill(file, &mut [0]).is_ok() {
        return Err(format!("there is more than the {bytes} bytes that the shape {shape:?} needs"));
    }
    Ok(data)
}

/// `wanted`, but not more than the file has; a pipe does not say.
fn known_length(file: &File, wanted: usize) -> usize {
    file.metadata().map_or(0, |m| wanted.min(usize::try_from(m.len()).unwrap_or(wanted)))
}

fn decode(bytes: &[u8], header: &Header, out: &mut Vec<f64>) {
    fn each<const N: usize>(bytes: &[u8]) -> impl Iterator<Item = [u8; N]> + '_ {
        bytes.chunks_exact(N).map(|b| std::array::from_fn(|i| b[i]))
    }
    match (header.size, header.big_endian) {
        (8, false) => out.extend(each(bytes).map(f64::from_le_bytes)),
        (8, true) => out.extend(each(bytes).map(f64::from_be_bytes)),
        (_, false) => out.extend(each(bytes).map(f32::from_le_bytes).map(f64::from)),
        (_, true) => out.extend(each(bytes).map(f32::from_be_bytes).map(f64::from)),
    }
}

/// From last index fastest (C) to first index fastest (Fortran).
///
/// Reversing the axes transposes the first against the last for every value of those between; tiles keep both sides
/// of that transposition in the cache.
fn first_index_fastest(shape: Vec<usize>, data: Vec<f64>) -> (Vec<usize>, Vec<f64>) {
    const TILE: usize = 16;
    let rank = shape.len();
    if rank < 2 || data.is_empty() {
        return (shape, data);
    }
    let (first, last) = (shape[0], shape[rank - 1]);
    let middle = data.len() / (first * last);
    let mut out = vec![0.0; data.len()];
    for m in 0..middle {
        let reversed = reversed_index(m, &shape[1..rank - 1]);
        for i0 in (0..first).step_by(TILE) {
            for k0 in (0..last).step_by(TILE) {
                for k in k0..last.min(k0 + TILE) {
                    for i in i0..first.min(i0 + TILE) {
                        out[(k * middle + reversed) * first + i] = data[(i * middle + m) * last + k];
                    }
                }
            }
        }
    }
    (shape, out)
}

/// The place, first index fastest, of what lies at `index`, last index fastest.
fn reversed_index(mut index: usize, shape: &[usize]) -> usize {
    shape.iter().rev().fold(0, |place, &n| {
        let digit = index % n;
        index /= n;
        place * n + digit
    })
}
