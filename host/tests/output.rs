//! What is written, read back by other means: bytes of the formats, tiny parsers, decoders of other crates.

use std::collections::BTreeMap;
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::process::Command;

use voidage::error::Error;
use voidage::output::canvas::{Canvas, INK, WHITE};
use voidage::output::colour::{ColourMap, NO_VALUE};
use voidage::output::figure::Figure;
use voidage::output::heatmap::{Area, Axis, Heatmap};
use voidage::output::vtr::{CellField, Field, Vtr};
use voidage::output::{atomically, discard_unfinished, npy, png, report};

/// A directory of its own for each test, empty at the start, removed at the end.
struct Dir(PathBuf);

impl Dir {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("voidage-output-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("temporary directory");
        Dir(path)
    }

    fn file(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).expect("readable");
        let mut names: Vec<_> = entries.map(|e| e.expect("entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

impl Drop for Dir {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Numbers in 0..1, most of them exactly 1, as porosity is; the same for the same seed.
fn porosity(n: usize, seed: u64) -> Vec<f64> {
    let mut state = seed;
    (0..n)
        .map(|_| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let u = (state >> 11) as f64 / (1u64 << 53) as f64;
            if u < 0.7 { 1.0 } else { u }
        })
        .collect()
}

fn bits(data: &[f64]) -> Vec<u64> {
    data.iter().map(|v| v.to_bits()).collect()
}

fn uniform(n: usize) -> Vec<f64> {
    (0..=n).map(|i| i as f64).collect()
}

// --- atomically ------------------------------------------------------------------------------------------------

#[test]
fn a_failing_writer_leaves_the_old_file_and_nothing_else() {
    let dir = Dir::new("failing");
    let path = dir.file("beta.npy");
    fs::write(&path, "old").unwrap();
    let error = atomically(&path, |out| {
        out.write_all(&[7; 300_000])?; // more than the buffer: the temporary really has content
        Err(std::io::Error::other("disk full"))
    });
    assert_eq!(error, Err(Error::file(&path, "cannot write: disk full")));
    assert_eq!((fs::read(&path).unwrap(), dir.names()), (b"old".to_vec(), vec!["beta.npy".to_owned()]));
}

#[test]
fn a_panicking_writer_leaves_the_old_file_and_nothing_else() {
    let dir = Dir::new("panicking");
    let path = dir.file("beta.npy");
    fs::write(&path, "old").unwrap();
    let outcome = std::panic::catch_unwind(|| atomically(&path, |_| panic!("of the writer, on purpose")));
    assert!(outcome.is_err());
    assert_eq!((fs::read(&path).unwrap(), dir.names()), (b"old".to_vec(), vec!["beta.npy".to_owned()]));
}

#[test]
fn the_target_is_old_until_the_end_and_then_new() {
    let dir = Dir::new("replacing");
    let path = dir.file("beta.npy");
    fs::write(&path, "old").unwrap();
    atomically(&path, |out| {
        out.write_all(b"new")?;
        out.flush()?;
        assert_eq!(fs::read(&path)?, b"old");
        assert_eq!(dir.names().len(), 2);
        Ok(())
    })
    .unwrap();
    assert_eq!((fs::read(&path).unwrap(), dir.names()), (b"new".to_vec(), vec!["beta.npy".to_owned()]));
}

#[test]
fn writers_at_the_same_time_do_not_meet() {
    let dir = Dir::new("parallel");
    std::thread::scope(|scope| {
        for n in 0..8u8 {
            let path = dir.file(&format!("{}", n % 2));
            scope.spawn(move || {
                for _ in 0..20 {
                    atomically(&path, |out| out.write_all(&[n; 100_000])).unwrap();
                }
            });
        }
    });
    assert_eq!(dir.names(), ["0", "1"]);
    for name in dir.names() {
        let content = fs::read(dir.file(&name)).unwrap();
        assert!(content.len() == 100_000 && content.iter().all(|b| *b == content[0]), "file {name} is mixed");
    }
}

#[test]
fn left_overs_of_others_are_not_touched() {
    let dir = Dir::new("left-overs");
    // The names that this process would use next, as another machine on the same disk may have.
    let others: Vec<_> = (0..2000).map(|n| dir.file(&format!(".voidage-{}-{n}.tmp", std::process::id()))).collect();
    others.iter().for_each(|path| fs::write(path, "other").unwrap());
    atomically(&dir.file("beta.npy"), |out| out.write_all(b"new")).unwrap();
    assert!(others.iter().all(|path| fs::read(path).unwrap() == b"other"));
    assert_eq!((fs::read(dir.file("beta.npy")).unwrap(), dir.names().len()), (b"new".to_vec(), 2001));
}

#[test]
fn what_cannot_be_written_is_named() {
    let dir = Dir::new("refused");
    fs::write(dir.file("plain"), "").unwrap();
    fs::create_dir(dir.file("folder")).unwrap();
    let cases =
        [("missing/beta.npy", "there is no directory"), ("plain/beta.npy", "cannot"), ("folder", "is a directory")];
    for (name, reason) in cases {
        let path = dir.file(name);
        let one = &[0.5][..];
        let (x, y, z) = (&[0.0, 1.0][..], &[0.0, 1.0][..], &[0.0, 1.0][..]);
        let grid = Vtr { x, y, z, ..Vtr::default() };
        for outcome in [
            atomically(&path, |_| Ok(())),
            npy::write(&path, [1, 1, 1], one),
            grid.write(&path),
            png::slices(&path, "", x, y, z, "m", one),
            report::json(&path, &1),
        ] {
            let error = outcome.expect_err(name);
            assert_eq!(error.path.as_deref(), Some(&*path));
            assert!(error.reason.contains(reason) && !error.usage, "{error}");
        }
    }
    assert_eq!(dir.names(), ["folder", "plain"]);
}

#[test]
fn a_read_only_file_is_kept_and_permissions_too() {
    let dir = Dir::new("permissions");
    let path = dir.file("beta.npy");
    fs::write(&path, "old").unwrap();
    let set = |readonly| {
        let mut permissions = fs::metadata(&path).unwrap().permissions();
        permissions.set_readonly(readonly);
        fs::set_permissions(&path, permissions).unwrap();
    };
    set(true);
    let error = atomically(&path, |out| out.write_all(b"new")).expect_err("read-only");
    assert!(error.reason.contains("read-only"), "{error}");
    assert_eq!(fs::read(&path).unwrap(), b"old");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
        atomically(&path, |out| out.write_all(b"new")).unwrap();
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
        assert_eq!(fs::read(&path).unwrap(), b"new");
    }
}

#[cfg(unix)]
#[test]
fn links_are_followed() {
    let dir = Dir::new("links");
    fs::write(dir.file("real"), "old").unwrap();
    std::os::unix::fs::symlink("real", dir.file("link")).unwrap();
    atomically(&dir.file("link"), |out| out.write_all(b"new")).unwrap();
    assert_eq!(fs::read(dir.file("real")).unwrap(), b"new");
    assert!(fs::symlink_metadata(dir.file("link")).unwrap().is_symlink());
}

/// As `-o /dev/stdout` and `/dev/null` would be. Not with a real device: a fault here, run by root, would replace it.
#[cfg(unix)]
#[test]
fn pipes_are_written_and_stay_pipes() {
    use std::os::unix::fs::FileTypeExt;
    let dir = Dir::new("pipes");
    let path = dir.file("pipe");
    assert!(Command::new("mkfifo").arg(&path).status().unwrap().success());
    let reader = std::thread::spawn({
        let path = path.clone();
        move || fs::read(path)
    });
    atomically(&path, |out| out.write_all(b"new")).unwrap();
    assert!(fs::metadata(&path).unwrap().file_type().is_fifo());
    assert_eq!((reader.join().unwrap().unwrap(), dir.names()), (b"new".to_vec(), vec!["pipe".to_owned()]));
}

/// In a process of its own, because it would take away the temporaries of the other tests.
#[test]
fn unfinished_files_can_be_discarded() {
    let dir = Dir::new("discard");
    let child = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "child_that_discards"])
        .env("VOIDAGE_TEST_DIR", &dir.0)
        .output()
        .unwrap();
    assert!(child.status.success(), "{}", String::from_utf8_lossy(&child.stdout));
    assert_eq!(dir.names(), Vec::<String>::new());
}

/// Does something only as the child of the test above.
#[test]
fn child_that_discards() {
    let Some(dir) = std::env::var_os("VOIDAGE_TEST_DIR").map(PathBuf::from) else { return };
    let entries = || fs::read_dir(&dir).unwrap().count();
    let outcome = atomically(&dir.join("beta.npy"), |out| {
        out.write_all(b"half")?;
        assert_eq!(entries(), 1);
        discard_unfinished(); // as a signal handler would
        assert_eq!(entries(), 0);
        Ok(())
    });
    assert!(outcome.expect_err("nothing to rename").reason.starts_with("cannot replace"));
}

// --- npy -------------------------------------------------------------------------------------------------------

#[test]
fn npy_bytes_are_those_of_numpy() {
    let mut bytes = vec![];
    npy::write_to(&mut bytes, [3, 1, 2], &[0.0, 1.0, 2.0, 3.0, 4.0, 0.5]).unwrap();
    let mut expected =
        b"\x93NUMPY\x01\x00\x76\x00{'descr': '<f8', 'fortran_order': True, 'shape': (3, 1, 2), }".to_vec();
    expected.resize(127, b' ');
    expected.push(b'\n');
    for value in [0.0f64, 1.0, 2.0, 3.0, 4.0, 0.5] {
        expected.extend(value.to_le_bytes());
    }
    assert_eq!(bytes, expected);
}

#[test]
fn npy_data_are_aligned_for_any_shape() {
    for shape in [[1, 1, 1], [usize::MAX; 3], [1_000_000_000, 1, 99], [99, 99, 63]] {
        let mut bytes = vec![];
        npy::write_to(&mut bytes, shape, &[]).unwrap();
        assert_eq!(bytes.len() % 64, 0);
        assert_eq!(usize::from(u16::from_le_bytes([bytes[8], bytes[9]])), bytes.len() - 10);
        assert_eq!(bytes.last(), Some(&b'\n'));
    }
}

/// A directory made for arrays that then cannot be written goes away again; one that was there stays.
#[test]
fn npy_leaves_no_empty_directory_behind() {
    let dir = Dir::new("new-directory");
    let arrays = [("no/such/place".to_owned(), [1, 1, 1], &[0.5][..])];
    for there in [false, true] {
        let directory = dir.file(if there { "old" } else { "new" });
        if there {
            fs::create_dir(&directory).expect("a directory");
        }
        npy::write_all(&directory, &arrays).expect_err("no such place");
        assert_eq!(directory.exists(), there);
    }
}

#[test]
fn npy_round_trip_keeps_every_bit() {
    let dir = Dir::new("npy");
    let path = dir.file("a.npy");
    let mut data = porosity(31 * 17 * 23, 1);
    data[..5].copy_from_slice(&[-0.0, f64::NAN, f64::INFINITY, f64::MIN_POSITIVE / 8.0, f64::MAX]);
    npy::write(&path, [31, 17, 23], &data).unwrap();
    let (shape, back) = npy::read(&path).unwrap();
    assert_eq!((shape, bits(&back)), (vec![31, 17, 23], bits(&data)));
    assert_eq!(fs::metadata(&path).unwrap().len(), 128 + 8 * 31 * 17 * 23);

    let error = npy::write(&path, [31, 17, 22], &data).expect_err("wrong length");
    assert!(error.to_string().contains("12121 values do not fill 31 x 17 x 22"), "{error}");
    assert_eq!(npy::read(&path).unwrap().0, [31, 17, 23], "the old file is untouched");
}

/// An NPY file from its parts.
fn npy_bytes(version: u8, header: &str, data: &[u8]) -> Vec<u8> {
    let mut bytes = [b"\x93NUMPY", &[version, 0][..]].concat();
    if version == 1 {
        bytes.extend((header.len() as u16).to_le_bytes());
    } else {
        bytes.extend((header.len() as u32).to_le_bytes());
    }
    [bytes, header.as_bytes().to_vec(), data.to_vec()].concat()
}

fn reads(dir: &Dir, bytes: &[u8]) -> Result<(Vec<usize>, Vec<f64>), Error> {
    let path = dir.file("in.npy");
    fs::write(&path, bytes).unwrap();
    npy::read(&path)
}

#[test]
fn npy_reads_all_orders_sizes_and_versions() {
    let dir = Dir::new("npy-read");
    let little: Vec<u8> = (0..6).flat_map(|v| f64::from(v).to_le_bytes()).collect();
    let big: Vec<u8> = (0..6).flat_map(|v| f64::from(v).to_be_bytes()).collect();
    let single: Vec<u8> = (0..6u8).flat_map(|v| f32::from(v).to_le_bytes()).collect();
    let single_big: Vec<u8> = (0..6u8).flat_map(|v| f32::from(v).to_be_bytes()).collect();
    let ascending = vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
    let turned = vec![0.0, 3.0, 1.0, 4.0, 2.0, 5.0];
    type Case<'a> = (u8, &'a str, &'a [u8], &'a [usize], &'a [f64]);
    let cases: [Case; 8] = [
        (1, "{'descr': '<f8', 'fortran_order': True, 'shape': (2, 3), }   \n", &little, &[2, 3], &ascending),
        (1, "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }\n", &little, &[2, 3], &turned),
        (2, "{'shape': (2L, 3L), 'fortran_order': False, 'descr': '>f8'}", &big, &[2, 3], &turned),
        (3, "{\"descr\":\"<f4\",\"fortran_order\":True,\"shape\":(3,2,1)}", &single, &[3, 2, 1], &ascending),
        (1, "{'descr': '>f4', 'fortran_order': False, 'shape': (6,), }", &single_big, &[6], &ascending),
        (1, "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 2, 3), }", &little, &[1, 2, 3], &turned),
        (1, "{'descr': '<f8', 'fortran_order': False, 'shape': (), }", &little[..8], &[], &[0.0]),
        (1, "{'descr': '<f8', 'fortran_order': False, 'shape': (4, 0), }", &[], &[4, 0], &[]),
    ];
    for (version, header, data, shape, values) in cases {
        let (found_shape, found) = reads(&dir, &npy_bytes(version, header, data)).expect(header);
        assert_eq!((&found_shape[..], &found[..]), (shape, values), "{header}");
    }
}

#[test]
fn npy_c_order_of_four_axes_by_the_definition() {
    let dir = Dir::new("npy-c");
    let [a, b, c, d] = [35, 3, 2, 18]; // across the edges of the tiles
    let data: Vec<u8> = (0..a * b * c * d).flat_map(|v| (v as f64).to_le_bytes()).collect();
    let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({a}, {b}, {c}, {d}), }}");
    let (_, found) = reads(&dir, &npy_bytes(1, &header, &data)).unwrap();
    for (i, j, k, l) in itertools(a, b, c, d) {
        let expected = ((i * b + j) * c + k) * d + l;
        assert_eq!(found[i + a * (j + b * (k + c * l))], expected as f64);
    }
}

fn itertools(a: usize, b: usize, c: usize, d: usize) -> impl Iterator<Item = (usize, usize, usize, usize)> {
    (0..a * b * c * d).map(move |n| (n % a, n / a % b, n / (a * b) % c, n / (a * b * c)))
}

#[test]
fn npy_refuses_what_it_does_not_understand() {
    let dir = Dir::new("npy-bad");
    let good = "{'descr': '<f8', 'fortran_order': True, 'shape': (2,), }";
    let of = |descr: &str, shape: &str| format!("{{'descr': {descr}, 'fortran_order': True, 'shape': {shape}, }}");
    let cases: Vec<(Vec<u8>, &str)> = vec![
        (vec![], "not a NumPy"),
        (b"solid cube\n  facet".to_vec(), "not a NumPy"),
        (b"\x93NUMPY".to_vec(), "ends too early"),
        (npy_bytes(1, good, &[0; 16])[..40].to_vec(), "ends too early"),
        (npy_bytes(7, good, &[0; 16]), "version 7"),
        (npy_bytes(1, good, &[0; 15]), "data: the file ends too early; the shape [2] needs 16 bytes"),
        (npy_bytes(1, good, &[0; 17]), "more than the 16 bytes"),
        (npy_bytes(1, &of("'<i8'", "(2,)"), &[0; 16]), "'<i8' is not supported"),
        (npy_bytes(1, &of("[('a', '<f8')]", "(2,)"), &[0; 16]), "records"),
        (npy_bytes(1, &of("'<f8'", "(2, -1)"), &[0; 16]), "no size: '-1"),
        (npy_bytes(1, &of("'<f8'", "2"), &[0; 16]), "'(' expected"),
        (npy_bytes(1, &of("'<f8'", "(4000000000, 4000000000, 4000000000)"), &[0; 16]), "too large"),
        (npy_bytes(1, &of("'<f8'", "(1000000000000,)"), &[0; 16]), "ends too early"),
        (npy_bytes(1, "{'descr': '<f8'}", &[0; 16]), "missing"),
        (npy_bytes(1, "{'descr': '<f8", &[0; 16]), "quotation mark"),
        (npy_bytes(1, "", &[0; 16]), "'{' expected"),
        (npy_bytes(1, "{'colour': 'red'}", &[0; 16]), "'colour'"),
        ([b"\x93NUMPY\x02\x00\xff\xff\xff\xff", &[b' '; 99][..]].concat(), "cannot be right"),
    ];
    for (bytes, reason) in cases {
        let error = reads(&dir, &bytes).expect_err(reason);
        assert!(error.to_string().contains(reason), "{error}, not {reason}");
        assert_eq!(error.path, Some(dir.file("in.npy")));
    }
    let error = npy::read(&dir.file("none.npy")).expect_err("no such file");
    assert!(error.reason.starts_with("cannot open"), "{error}");
}

// --- vtr -------------------------------------------------------------------------------------------------------

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
        for (i, j, k, _) in itertools(nx, ny, nz, 1) {
            all.push(self.faces[0][(k * ny + j) * (nx + 1) + i]);
            all.push(self.faces[1][(k * (ny + 1) + j) * nx + i]);
            all.push(self.faces[2][(k * ny + j) * nx + i]);
        }
        all
    }

    fn file(&self, edges: &[Vec<f64>; 3], compress: bool) -> Vec<u8> {
        let [x, y, z] = edges;
        let [beta_x, beta_y, beta_z] = self.faces.each_ref().map(|f| &f[..]);
        let scalar = |name, data| Field { name, components: 1, data };
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
    let one = Field { name: "a<b & \"c\"", components: 1, data: &[1.0] };
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
    let scalar = |data| Field { name: "beta", components: 1, data };
    let fits = Vtr { x: &edges, y: &edges, z: &edges, cell: vec![CellField::Values(scalar(&cell))], ..Vtr::default() };
    let faces = [0.5; 12];
    let bad = [
        (Vtr { cell: vec![CellField::Values(scalar(&short))], ..fits.clone() }, "'beta' does not have the length"),
        (Vtr { cell: vec![CellField::Vector { name: "u", parts: [&cell, &cell, &short] }], ..fits.clone() }, "'u'"),
        (Vtr { cell: vec![CellField::LowFaces { name: "f", faces: [&faces, &cell, &faces] }], ..fits.clone() }, "'f'"),
        (Vtr { cell: vec![CellField::Values(Field { components: 0, ..scalar(&[]) })], ..fits.clone() }, "'beta'"),
        (Vtr { field_data: vec![Field { components: 3, ..scalar(&cell) }], ..fits.clone() }, "8 values for 3"),
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

// --- pictures --------------------------------------------------------------------------------------------------

fn decoded(path: &Path) -> (usize, usize, Vec<[u8; 3]>) {
    let mut reader = ::png::Decoder::new(std::io::BufReader::new(fs::File::open(path).unwrap())).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!((info.color_type, info.bit_depth), (::png::ColorType::Rgb, ::png::BitDepth::Eight));
    let pixels = bytes.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
    (info.width as usize, info.height as usize, pixels)
}

#[test]
fn a_heatmap_puts_each_cell_where_its_edges_are() {
    let (across, up) = ([10.0, 11.0, 14.0], [0.0, 2.0, 3.0]); // 1 : 3 and 2 : 1
    let map = ColourMap::sequential();
    let value = |a: usize, b: usize| if (a, b) == (1, 1) { f64::NAN } else { 0.25 + 0.25 * (a + 2 * b) as f64 };
    let axis = |edges| Axis { name: "x", unit: "m", edges };
    let area = Area { x: 100, y: 50, width: 400, height: 300 };
    let mut canvas = Canvas::new(600, 500);
    let range = [0.0, 1.0];
    Heatmap { across: axis(&across), up: axis(&up), value: &value, range, map: &map, title: "t" }
        .draw(&mut canvas, area);
    // Left column 100 pixels wide, lower row 200 pixels high.
    for (x, y, colour) in [
        (150, 250, map.colour(0.25)),
        (198, 348, map.colour(0.25)),
        (202, 348, map.colour(0.5)),
        (198, 147, map.colour(0.75)),
        (300, 100, NO_VALUE),
        (99, 200, INK),
        (500, 200, INK),
        (300, 49, INK),
        (300, 350, INK),
        (590, 490, WHITE),
    ] {
        assert_eq!(canvas.get(x, y), colour, "pixel {x}, {y}");
    }
    assert!((100..500).any(|x| (362..380).any(|y| canvas.get(x, y) != WHITE)), "numbers below");
    assert!((40..90).any(|x| (60..340).any(|y| canvas.get(x, y) != WHITE)), "numbers to the left");
}

#[test]
fn slices_show_the_blocked_cell_in_its_corner() {
    let dir = Dir::new("png");
    let path = dir.file("beta.png");
    png::slices(&path, "one of four", &uniform(2), &uniform(2), &uniform(1), "m", &[0.0, 1.0, 1.0, 1.0]).unwrap();
    let (width, height, pixels) = decoded(&path);
    assert!((800..2000).contains(&width) && (600..1400).contains(&height), "{width} x {height}");
    let map = ColourMap::sequential();
    let places = |value: f64| {
        let found = pixels.iter().enumerate().filter(|(_, p)| **p == map.colour(value)).map(|(n, _)| n);
        found.map(|n| (n % width, n / width)).collect::<Vec<_>>()
    };
    let (blocked, open) = (places(0.0), places(1.0));
    assert!(blocked.len() > 100_000, "{} pixels", blocked.len());
    let ratio = open.len() as f64 / blocked.len() as f64;
    assert!((ratio - 3.0).abs() < 0.03, "three cells are open: {ratio}");
    let centre = |all: &[(usize, usize)]| {
        let n = all.len();
        (all.iter().map(|p| p.0).sum::<usize>() / n, all.iter().map(|p| p.1).sum::<usize>() / n)
    };
    let ((bx, by), (ox, oy)) = (centre(&blocked), centre(&open));
    assert!(bx + 200 < ox && by > oy + 200, "low x is left, low y is down");
}

#[test]
fn pictures_of_any_shape_stay_on_a_readable_sheet() {
    let dir = Dir::new("png-shapes");
    let far = |n: usize, low: f64, size: f64| (0..=n).map(|i| low + size * i as f64).collect::<Vec<f64>>();
    let grids = [
        [uniform(6), uniform(6), uniform(6)],
        [far(200, -3.0, 0.5), uniform(9), uniform(8)],
        [uniform(2), uniform(3), far(500, 0.0, 4.0)],
        [uniform(1), uniform(1), uniform(1)],
        [far(50, 0.0, 1e-9), far(4, 1e7, 1.0), far(5, -1e12, 1e10)],
        [far(3, 1e15, 0.125), uniform(2), uniform(2)],
    ];
    for (n, [x, y, z]) in grids.iter().enumerate() {
        let path = dir.file(&format!("{n}.png"));
        let beta = porosity((x.len() - 1) * (y.len() - 1) * (z.len() - 1), 9);
        let title = "a title that is long, ".repeat(if n == 3 { 40 } else { 1 });
        png::slices(&path, &title, x, y, z, "", &beta).unwrap();
        let (width, height, pixels) = decoded(&path);
        assert!((500..=2000).contains(&width) && (250..=1500).contains(&height), "{n}: {width} x {height}");
        let paper = pixels.iter().filter(|p| **p == WHITE).count();
        assert!(paper * 20 > pixels.len(), "{n}: there is a margin");
    }
}

#[test]
fn pictures_refuse_what_does_not_fit() {
    let dir = Dir::new("png-bad");
    let path = dir.file("out.png");
    let edges = uniform(2);
    let draw = |x: &[f64], beta: &[f64]| png::slices(&path, "", x, &edges, &edges, "m", beta).expect_err("bad").reason;
    assert!(draw(&edges, &[1.0; 7]).contains("length"));
    assert!(draw(&[0.0, 2.0, 1.0], &[1.0; 8]).contains("do not ascend"));
    assert!(draw(&[0.0, f64::NAN, 1.0], &[1.0; 8]).contains("do not ascend"));
    assert!(draw(&[], &[]).contains("length"));
    assert_eq!(dir.names(), Vec::<String>::new());
}

#[test]
fn figures_of_other_fields_and_of_uniform_or_missing_values() {
    let edges = [&uniform(3)[..], &uniform(3), &uniform(3)];
    let map = &ColourMap::diverging();
    let figure = |values, range| {
        let (title, note, unit, at, name) = ("u", "step 12", "m", [1, 1, 1], "u [m/s]");
        Figure { title, note, edges, unit, values, at, name, range, ends: ["", ""], map }.draw()
    };
    let has = |canvas: &Canvas, colour| {
        let (width, height) = canvas.size();
        (0..width * height).filter(|n| canvas.get(n % width, n / width) == colour).count() > 10_000
    };
    let uniform = figure(&[300.0; 27], [300.0, 300.0]).unwrap();
    assert!(has(&uniform, map.colour(0.5)));
    let missing = figure(&[f64::NAN; 27], [f64::NAN, f64::NAN]).unwrap();
    assert!(has(&missing, NO_VALUE));
    let low = figure(&[-7.5; 27], [-7.5, 7.5]).unwrap();
    assert!(has(&low, map.colour(0.0)));
    let whole = Figure {
        title: "",
        note: "",
        edges,
        unit: "",
        values: &[0.0; 27],
        at: [2; 3],
        name: "",
        range: [0.0, 1.0],
        ends: ["", ""],
        map,
    };
    assert!(whole.draw().is_ok());
    assert!(Figure { at: [0, 3, 0], ..whole }.draw().is_err(), "a slice outside");
    assert!(Figure { values: &[0.0; 26], ..whole }.draw().is_err(), "a value too few");
}

#[test]
fn each_panel_shows_its_own_slice() {
    let (two, three, four) = (uniform(2), uniform(3), uniform(4));
    let map = &ColourMap::sequential();
    for axis in 0..3 {
        for at in 0..2 {
            // Open are the cells of one slice: that whole panel, and a strip of the two others.
            let open = |(i, j, k, _): (usize, usize, usize, usize)| f64::from([i, j, k][axis] == at);
            let values: Vec<f64> = itertools(2, 3, 4, 1).map(open).collect();
            let [areas_of_panels, strips] =
                [[12.0, 8.0, 6.0], [[0.0, 4.0, 3.0], [4.0, 0.0, 2.0], [3.0, 2.0, 0.0]][axis]];
            let mut where_cut = [1, 2, 3];
            where_cut[axis] = at;
            let figure = Figure {
                title: "",
                note: "",
                edges: [&two, &three, &four],
                unit: "m",
                values: &values,
                at: where_cut,
                name: "",
                range: [0.0, 1.0],
                ends: ["", ""],
                map,
            };
            let canvas = figure.draw().unwrap();
            let (width, height) = canvas.size();
            let count =
                |colour| (0..width * height).filter(|n| canvas.get(n % width, n / width) == colour).count() as f64;
            let share = count(map.colour(1.0)) / (count(map.colour(0.0)) + count(map.colour(1.0)));
            let expected = (areas_of_panels[axis] + strips.iter().sum::<f64>()) / areas_of_panels.iter().sum::<f64>();
            assert!((share - expected).abs() < 0.01, "axis {axis} at {at}: {share}, not {expected}");
        }
    }
}

#[test]
fn turned_text_reads_upwards() {
    use voidage::output::canvas::Style;
    let mut canvas = Canvas::new(100, 100);
    canvas.text(50.5, 50.5, "L", Style { height: 20.0, turned: true, ..Style::default() });
    let [stem, foot, right, below] = [(34, 50), (50, 43), (58, 50), (50, 58)].map(|(x, y)| canvas.get(x, y) != WHITE);
    assert_eq!([stem, foot, right, below], [true, true, false, false]);
}

#[test]
fn text_stays_inside_its_measure() {
    use voidage::output::canvas::{Style, text_width};
    for text in ["beta_v = 0.25", "x [m]", "WMwm|#@", "é→漢"] {
        let mut canvas = Canvas::new(400, 60);
        let (left, base) = (50.0, 40.0);
        canvas.text(left, base, text, Style { height: 20.0, ..Style::default() });
        let inked = |x: usize| (0..60).any(|y| canvas.get(x, y) != WHITE);
        let first = (0..400).find(|x| inked(*x)).expect("visible");
        let last = (0..400).rfind(|x| inked(*x)).expect("visible");
        assert!(first >= 46 && last as f64 <= left + text_width(text, 20.0) + 2.0, "{text}: {first}..={last}");
        assert!((0..400).all(|x| canvas.get(x, 59) == WHITE && canvas.get(x, 5) == WHITE), "{text}");
    }
}

// --- report ----------------------------------------------------------------------------------------------------

#[test]
fn the_report_is_indented_and_ends_its_last_line() {
    #[derive(serde::Serialize)]
    struct Report {
        version: &'static str,
        max_gap: f64,
        warnings: Vec<String>,
    }
    let dir = Dir::new("report");
    let path = dir.file("report.json");
    let report = Report { version: "0.1.0", max_gap: f64::NAN, warnings: vec!["open edge".into()] };
    report::json(&path, &report).unwrap();
    let expected = "{\n  \"version\": \"0.1.0\",\n  \"max_gap\": null,\n  \"warnings\": [\n    \"open edge\"\n  ]\n}\n";
    assert_eq!(fs::read_to_string(&path).unwrap(), expected);

    let keys_that_are_lists = BTreeMap::from([(vec![1], 1)]);
    assert!(report::json(&path, &keys_that_are_lists).is_err());
    assert_eq!((fs::read_to_string(&path).unwrap(), dir.names().len()), (expected.to_owned(), 1));
}
