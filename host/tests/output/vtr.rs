//! VTR files, read by a parser of their own.

use std::collections::BTreeMap;
use std::fs;
use std::io::Cursor;

use super::{Dir, indices, porosity, uniform};
use voidage::files::vtr::{CellField, NamedField, Vtr};

/// A file as this test understands it: attributes of the XML by plain search, arrays from the appended bytes.
struct Parsed {
    xml: String,
    arrays: BTreeMap<String, Vec<f64>>,
}

fn attribute<'a>(tag: &'a str, name: &str) -> &'a str {
    let start = tag.find(&format!(" {name}=\"")).expect(name) + name.len() + 3;
    &tag[start..start + tag[start..].find('"').expect("closed")]
}

fn word(bytes: &[u8], at: usize) -> usize {
    u64::from_le_bytes(bytes[at..at + 8].try_into().expect("eight bytes")) as usize
}

fn parse(file: &[u8]) -> Parsed {
    let mark = b"<AppendedData encoding=\"raw\">\n   _";
    let start = file.windows(mark.len()).position(|w| w == mark).expect("appended data") + mark.len();
    let xml = String::from_utf8(file[..start].to_vec()).expect("text");
    assert!(file.ends_with(b"\n  </AppendedData>\n</VTKFile>\n"));
    let data = &file[start..file.len() - b"\n  </AppendedData>\n</VTKFile>\n".len()];
    let zlib = xml.contains("compressor=\"vtkZLibDataCompressor\"");
    let mut arrays = BTreeMap::new();
    let mut spans = vec![];
    for tag in xml.split('<').filter(|t| t.starts_with("DataArray")) {
        let offset = attribute(tag, "offset").parse().expect("offset");
        let (bytes, end) = if zlib { inflate(data, offset) } else { plain(data, offset) };
        let values: Vec<f64> =
            bytes.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().expect("eight bytes"))).collect();
        let tuples: usize = attribute(tag, "NumberOfTuples").parse().expect("tuples");
        let components: usize = attribute(tag, "NumberOfComponents").parse().expect("components");
        assert_eq!(values.len(), tuples * components, "{tag}");
        spans.push((offset, end));
        arrays.insert(attribute(tag, "Name").to_owned(), values);
    }
    spans.sort_unstable();
    assert!(spans.windows(2).all(|w| w[0].1 == w[1].0), "arrays follow each other without gaps");
    assert_eq!((spans[0].0, spans[spans.len() - 1].1), (0, data.len()));
    Parsed { xml, arrays }
}

fn plain(data: &[u8], offset: usize) -> (Vec<u8>, usize) {
    let end = offset + 8 + word(data, offset);
    (data[offset + 8..end].to_vec(), end)
}

fn inflate(data: &[u8], offset: usize) -> (Vec<u8>, usize) {
    let [blocks, size, short] = [0, 8, 16].map(|n| word(data, offset + n));
    let mut at = offset + 24 + 8 * blocks;
    let mut all = vec![];
    for block in 0..blocks {
        let length = word(data, offset + 24 + 8 * block);
        let bytes = miniz_oxide::inflate::decompress_to_vec_zlib(&data[at..at + length]).expect("zlib");
        let wanted = if block + 1 == blocks && short > 0 { short } else { size };
        assert_eq!(bytes.len(), wanted);
        all.extend(bytes);
        at += length;
    }
    (all, at)
}

/// Fields of a grid of `n` cells, all different.
struct Fields {
    n: [usize; 3],
    cell: Vec<f64>,
    faces: [Vec<f64>; 3],
}

impl Fields {
    fn new(n: [usize; 3]) -> Self {
        let [nx, ny, nz] = n;
        let faces = [(nx + 1) * ny * nz, nx * (ny + 1) * nz, nx * ny * (nz + 1)];
        let faces = [2, 3, 4].map(|seed| porosity(faces[seed - 2], seed as u64));
        Fields { n, cell: porosity(nx * ny * nz, 1), faces }
    }

    fn low_faces(&self) -> Vec<f64> {
        let [nx, ny, nz] = self.n;
        let mut all = vec![];
        for (i, j, k, _) in indices(nx, ny, nz, 1) {
            all.push(self.faces[0][(k * ny + j) * (nx + 1) + i]);
            all.push(self.faces[1][(k * (ny + 1) + j) * nx + i]);
            all.push(self.faces[2][(k * ny + j) * nx + i]);
        }
        all
    }

    fn file(&self, edges: &[Vec<f64>; 3], compress: bool) -> Vec<u8> {
        let [x, y, z] = edges;
        let [beta_x, beta_y, beta_z] = self.faces.each_ref().map(|f| &f[..]);
        let scalar = |name, data| NamedField { name, components: 1, data };
        let grid = Vtr {
            x,
            y,
            z,
            cell: vec![
                CellField::Values(scalar("beta_v", &self.cell)),
                CellField::LowFaces { name: "beta_f", faces: [beta_x, beta_y, beta_z] },
                CellField::Vector { name: "u", parts: [&self.cell; 3] },
            ],
            field_data: vec![scalar("beta_x", beta_x), scalar("beta_y", beta_y), scalar("beta_z", beta_z)],
            text: vec![("made by", "a \"test\" & <more>")],
            compress,
        };
        let mut out = Cursor::new(vec![]);
        grid.write_to(&mut out).unwrap();
        out.into_inner()
    }
}

#[test]
fn vtr_holds_every_value_raw_and_compressed() {
    // One block and a bit, exactly two blocks of 24576 values, thin grids, a single cell.
    for n in [[30, 29, 31], [64, 32, 24], [1, 40, 9], [40, 1, 9], [40, 9, 1], [1, 1, 1]] {
        let fields = Fields::new(n);
        let edges = n.map(|n| (0..=n).map(|i| (i as f64).powf(1.5) - 3.0).collect::<Vec<f64>>());
        for compress in [false, true] {
            let parsed = parse(&fields.file(&edges, compress));
            let expect = |name: &str, values: &[f64]| assert!(parsed.arrays[name] == values, "{name} {n:?} {compress}");
            expect("beta_v", &fields.cell);
            expect("beta_f", &fields.low_faces());
            expect("u", &fields.cell.iter().flat_map(|v| [*v; 3]).collect::<Vec<_>>());
            for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
                expect(name, &edges[axis]);
                expect(&format!("beta_{name}"), &fields.faces[axis]);
            }
            let extent = format!("Extent=\"0 {} 0 {} 0 {}\"", n[0], n[1], n[2]);
            assert_eq!(parsed.xml.matches(&extent).count(), 2);
            assert!(parsed.xml.contains("<CellData Scalars=\"beta_v\" Vectors=\"beta_f\">"));
        }
    }
}

#[test]
fn vtr_text_is_spelt_in_numbers_and_names_are_escaped() {
    let fields = Fields::new([2, 2, 2]);
    let parsed = parse(&fields.file(&[2; 3].map(uniform), false));
    let text = parsed.xml.split("<Array type=\"String\"").nth(1).expect("one text");
    let numbers = text[text.find('>').unwrap() + 1..text.find("</Array>").unwrap()].split_whitespace();
    let bytes: Vec<u8> = numbers.map(|n| n.parse().unwrap()).collect();
    assert_eq!(bytes, b"a \"test\" & <more>\0");
    let one = NamedField { name: "a<b & \"c\"", components: 1, data: &[1.0] };
    let edges = uniform(1);
    let grid = Vtr { x: &edges, y: &edges, z: &edges, cell: vec![CellField::Values(one)], ..Vtr::default() };
    let mut out = Cursor::new(vec![]);
    grid.write_to(&mut out).unwrap();
    assert!(String::from_utf8_lossy(out.get_ref()).contains("Name=\"a&lt;b &amp; &quot;c&quot;\""));
}

#[test]
fn vtr_bytes_do_not_depend_on_the_number_of_threads() {
    let fields = Fields::new([70, 61, 37]);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| fields.file(&[70, 61, 37].map(uniform), true))
    };
    let one = with(1);
    assert!(one == with(2) && one == with(5));
    assert!(one.len() < 8 * 7 * 70 * 61 * 37 * 2 / 3, "compression saves something: {}", one.len());
}

#[test]
fn vtr_refuses_lengths_that_do_not_fit_and_writes_nothing() {
    let dir = Dir::new("vtr-bad");
    let path = dir.file("out.vtr");
    let (edges, cell, short) = (uniform(2), [0.5; 8], [0.5; 7]);
    let scalar = |data| NamedField { name: "beta", components: 1, data };
    let fits = Vtr { x: &edges, y: &edges, z: &edges, cell: vec![CellField::Values(scalar(&cell))], ..Vtr::default() };
    let faces = [0.5; 12];
    let bad = [
        (Vtr { cell: vec![CellField::Values(scalar(&short))], ..fits.clone() }, "'beta' does not have the length"),
        (Vtr { cell: vec![CellField::Vector { name: "u", parts: [&cell, &cell, &short] }], ..fits.clone() }, "'u'"),
        (Vtr { cell: vec![CellField::LowFaces { name: "f", faces: [&faces, &cell, &faces] }], ..fits.clone() }, "'f'"),
        (Vtr { cell: vec![CellField::Values(NamedField { components: 0, ..scalar(&[]) })], ..fits.clone() }, "'beta'"),
        (Vtr { field_data: vec![NamedField { components: 3, ..scalar(&cell) }], ..fits.clone() }, "8 values for 3"),
        (Vtr { field_data: vec![scalar(&[])], ..fits.clone() }, "0 values"),
        (Vtr { z: &edges[..1], ..fits.clone() }, "at least two edges"),
    ];
    for (grid, reason) in bad {
        let error = grid.write(&path).expect_err(reason);
        assert!(error.reason.contains(reason) && error.path.as_deref() == Some(&*path), "{error}");
        assert_eq!(dir.names(), Vec::<String>::new());
    }
    fits.write(&path).unwrap();
    assert_eq!(parse(&fs::read(&path).unwrap()).arrays["beta"], cell);
}
