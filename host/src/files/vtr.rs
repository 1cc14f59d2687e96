//! ParaView's file of a rectilinear grid (`.vtr`): XML, then the arrays as raw or zlib-compressed binary.
//!
//! Format: VTK user's guide, "XML file formats". Every array is described in the XML by its offset into the appended
//! data. There it is, little endian with 64-bit counts, either `[bytes] values` or, compressed,
//! `[blocks, bytes of a block, bytes of a short last block or 0, compressed bytes of each block…] blocks`.
//!
//! Offsets of compressed arrays are known only afterwards, so the XML is written twice, with room for any offset.
//! Compression works on a few blocks per thread at a time: no copy of a whole field is ever made.

mod source;

use std::fmt::Write as _;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::Path;

use miniz_oxide::deflate::compress_to_vec_zlib;
use rayon::prelude::*;

use crate::error::{Error, Result};
use source::{ArraySource, BLOCK};

/// Fastest deflate: porosity is mostly long runs, which higher levels hardly shrink further.
const LEVEL: u8 = 1;

/// An array of its own: `data.len() / components` tuples, interleaved.
#[derive(Clone, Copy, Debug)]
pub struct NamedField<'a> {
    /// Name shown by the viewer.
    pub name: &'a str,
    /// Values in a tuple.
    pub components: usize,
    /// The values.
    pub data: &'a [f64],
}

/// What every cell has.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum CellField<'a> {
    /// One tuple for each cell.
    Values(NamedField<'a>),
    /// A vector from three arrays with one value for each cell.
    Vector {
        /// Name shown by the viewer.
        name: &'a str,
        /// First, second and third component.
        parts: [&'a [f64]; 3],
    },
    /// A vector from the values on each cell's low x, y and z face.
    LowFaces {
        /// Name shown by the viewer.
        name: &'a str,
        /// Values on the x faces `(nx+1)*ny*nz`, y faces `nx*(ny+1)*nz`, z faces `nx*ny*(nz+1)`.
        faces: [&'a [f64]; 3],
    },
}

/// A grid with its fields.
#[derive(Clone, Debug, Default)]
pub struct Vtr<'a> {
    /// Cell edges along x, ascending.
    pub x: &'a [f64],
    /// Cell edges along y.
    pub y: &'a [f64],
    /// Cell edges along z.
    pub z: &'a [f64],
    /// Fields to colour by; the first scalar and the first vector become the active ones.
    pub cell: Vec<CellField<'a>>,
    /// Arrays of any length that go with the file, such as face fields. One value called `TimeValue` is the time.
    pub field_data: Vec<NamedField<'a>>,
    /// Text that goes with the file: name and value.
    pub text: Vec<(&'a str, &'a str)>,
    /// Compress with zlib.
    pub compress: bool,
}

impl Vtr<'_> {
    /// Writes the file.
    ///
    /// # Errors
    /// A length does not fit the grid, or as [`super::atomically`]. The target must be seekable: no pipe.
    pub fn write(&self, path: &Path) -> Result<()> {
        let arrays = self.arrays().map_err(|reason| Error::file(path, reason))?;
        super::whole::replace(path, |out| self.write_arrays(out, &arrays))
    }

    /// The bytes of [`Vtr::write`], to any writer that seeks, from its position on.
    ///
    /// # Errors
    /// Those of `out`; `InvalidInput` if a length does not fit the grid.
    pub fn write_to(&self, out: &mut (impl Write + Seek)) -> io::Result<()> {
        let arrays = self.arrays().map_err(|reason| io::Error::new(io::ErrorKind::InvalidInput, reason))?;
        let mut out = BufWriter::with_capacity(super::whole::BUFFER, out);
        self.write_arrays(&mut out, &arrays)?;
        out.flush()
    }

    fn write_arrays<W: Write + Seek>(&self, out: &mut BufWriter<W>, arrays: &Arrays) -> io::Result<()> {
        let start = out.stream_position()?;
        let mut offsets = vec![0; arrays.all().count()];
        out.write_all(self.xml(arrays, &offsets).as_bytes())?;
        let base = out.stream_position()?;
        for (offset, array) in offsets.iter_mut().zip(arrays.all()) {
            *offset = out.stream_position()? - base;
            if self.compress { compressed(out, &array.source)? } else { raw(out, &array.source)? }
        }
        out.write_all(b"\n  </AppendedData>\n</VTKFile>\n")?;
        let end = out.stream_position()?;
        out.seek(SeekFrom::Start(start))?;
        out.write_all(self.xml(arrays, &offsets).as_bytes())?;
        out.seek(SeekFrom::Start(end)).map(drop)
    }

    /// All numeric arrays, with lengths checked.
    fn arrays(&self) -> std::result::Result<Arrays<'_>, String> {
        let mut cells = [0; 3];
        for (n, edges) in cells.iter_mut().zip([self.x, self.y, self.z]) {
            *n = edges.len().saturating_sub(1);
            if *n == 0 {
                return Err("a grid needs at least two edges along each axis".into());
            }
        }
        let plain = |name, data| Array { name, components: 1, source: ArraySource::Values(data) };
        Ok(Arrays {
            cell: self.cell.iter().map(|field| cell_array(field, cells)).collect::<std::result::Result<_, _>>()?,
            edges: [plain("x", self.x), plain("y", self.y), plain("z", self.z)],
            field_data: self.field_data.iter().map(free_array).collect::<std::result::Result<_, _>>()?,
        })
    }

    /// Everything before the arrays; as long for any offsets.
    fn xml(&self, arrays: &Arrays, offsets: &[u64]) -> String {
        let [nx, ny, nz] = [self.x, self.y, self.z].map(|edges| edges.len() - 1);
        let compressor = if self.compress { r#" compressor="vtkZLibDataCompressor""# } else { "" };
        let mut lines = arrays.all().zip(offsets).map(|(array, offset)| array.xml(*offset));
        let mut next = |n: usize| lines.by_ref().take(n).collect::<String>();
        let (cell, edges, field_data) = (next(arrays.cell.len()), next(3), next(arrays.field_data.len()));
        format!(
            r#"<?xml version="1.0"?>
<VTKFile type="RectilinearGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64"{compressor}>
  <RectilinearGrid WholeExtent="0 {nx} 0 {ny} 0 {nz}">
    <FieldData>
{text}{field_data}    </FieldData>
    <Piece Extent="0 {nx} 0 {ny} 0 {nz}">
      <PointData/>
      <CellData{active}>
{cell}      </CellData>
      <Coordinates>
{edges}      </Coordinates>
    </Piece>
  </RectilinearGrid>
  <AppendedData encoding="raw">
   _"#,
            text = self.text.iter().map(|(name, value)| text_array(name, value)).collect::<String>(),
            active = arrays.active(),
        )
    }
}

/// A numeric array: its description and where its values come from.
struct Array<'a> {
    name: &'a str,
    components: usize,
    source: ArraySource<'a>,
}

impl Array<'_> {
    fn xml(&self, offset: u64) -> String {
        format!(
            "        <DataArray type=\"Float64\" Name=\"{}\" NumberOfComponents=\"{}\" NumberOfTuples=\"{}\" \
             format=\"appended\" {:<29}/>\n",
            escape(self.name),
            self.components,
            self.source.len() / self.components,
            format!("offset=\"{offset}\""), // 20 digits at most
        )
    }
}

/// The arrays in the order of the file.
struct Arrays<'a> {
    cell: Vec<Array<'a>>,
    edges: [Array<'a>; 3],
    field_data: Vec<Array<'a>>,
}

impl Arrays<'_> {
    fn all(&self) -> impl Iterator<Item = &Array<'_>> {
        self.cell.iter().chain(&self.edges).chain(&self.field_data)
    }

    /// Attributes that name the first scalar and the first vector.
    fn active(&self) -> String {
        let mut text = String::new();
        for (attribute, components) in [("Scalars", 1), ("Vectors", 3)] {
            if let Some(array) = self.cell.iter().find(|a| a.components == components) {
                let _ = write!(text, " {attribute}=\"{}\"", escape(array.name)); // a String takes anything
            }
        }
        text
    }
}

fn cell_array<'a>(field: &CellField<'a>, cells: [usize; 3]) -> std::result::Result<Array<'a>, String> {
    let (name, components, source) = match *field {
        CellField::Values(NamedField { name, components, data }) => (name, components, Some(ArraySource::Values(data))),
        CellField::Vector { name, parts } => (name, 3, ArraySource::vector(parts, cells)),
        CellField::LowFaces { name, faces } => (name, 3, ArraySource::low_faces(faces, cells)),
    };
    let [nx, ny, nz] = cells;
    source
        .filter(|s| components > 0 && s.len() == nx * ny * nz * components)
        .map(|source| Array { name, components, source })
        .ok_or_else(|| format!("the field '{name}' does not have the length of a grid of {nx} x {ny} x {nz} cells"))
}

fn free_array<'a>(field: &NamedField<'a>) -> std::result::Result<Array<'a>, String> {
    let NamedField { name, components, data } = *field;
    if components == 0 || data.is_empty() || data.len() % components != 0 {
        return Err(format!("the array '{name}' has {} values for {components} components", data.len()));
    }
    Ok(Array { name, components, source: ArraySource::Values(data) })
}

/// A text as VTK stores it: the numbers of its bytes, ended by zero.
fn text_array(name: &str, value: &str) -> String {
    let bytes: String = value.bytes().filter(|b| *b != 0).map(|b| format!("{b} ")).collect();
    format!(
        "        <Array type=\"String\" Name=\"{}\" NumberOfTuples=\"1\" format=\"ascii\">{bytes}0</Array>\n",
        escape(name)
    )
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

fn raw(out: &mut impl Write, source: &ArraySource) -> io::Result<()> {
    out.write_all(&(8 * source.len() as u64).to_le_bytes())?;
    let mut bytes = vec![0; 8 * BLOCK.min(source.len())];
    for first in (0..source.len()).step_by(BLOCK) {
        let bytes = &mut bytes[..8 * BLOCK.min(source.len() - first)];
        source.encode(first, bytes);
        out.write_all(bytes)?;
    }
    Ok(())
}

fn compressed(out: &mut (impl Write + Seek), source: &ArraySource) -> io::Result<()> {
    let starts: Vec<usize> = (0..source.len()).step_by(BLOCK).collect();
    let short = source.len() % BLOCK;
    let mut header = vec![starts.len() as u64, 8 * BLOCK as u64, 8 * short as u64];
    let at = out.stream_position()?;
    out.write_all(&vec![0; 8 * (header.len() + starts.len())])?;
    for batch in starts.chunks(4 * rayon::current_num_threads()) {
        let blocks: Vec<Vec<u8>> = batch.par_iter().map(|&first| compressed_block(source, first)).collect();
        for block in blocks {
            header.push(block.len() as u64);
            out.write_all(&block)?;
        }
    }
    let end = out.stream_position()?;
    out.seek(SeekFrom::Start(at))?;
    out.write_all(&header.iter().flat_map(|n| n.to_le_bytes()).collect::<Vec<u8>>())?;
    out.seek(SeekFrom::Start(end)).map(drop)
}

fn compressed_block(source: &ArraySource, first: usize) -> Vec<u8> {
    let mut bytes = vec![0; 8 * BLOCK.min(source.len() - first)];
    source.encode(first, &mut bytes);
    compress_to_vec_zlib(&bytes, LEVEL)
}
