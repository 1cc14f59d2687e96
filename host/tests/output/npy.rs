//! NPY arrays: bytes as numpy writes them, all that it may write read.

use std::fs;

use super::{Dir, bits, indices, porosity};
use voidage::error::Error;
use voidage::files::npy;

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
    for (i, j, k, l) in indices(a, b, c, d) {
        let expected = ((i * b + j) * c + k) * d + l;
        assert_eq!(found[i + a * (j + b * (k + c * l))], expected as f64);
    }
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
