//! What is no mesh.

use std::path::{Path, PathBuf};

use super::{ascii, binary, is_box, is_refused, stl};
use voidage::geometry::read::read;

#[test]
fn other_formats_are_refused_by_name() {
    is_refused(stl(""), &["empty"]);
    is_refused(stl("  \n\n\t\n"), &["empty", "white space"]);
    is_refused(stl("\u{feff}"), &["empty"]);
    is_refused(stl("s"), &["84"]);
    is_refused(stl(b"\x1f\x8b\x08\0rest of it".to_vec()), &["gzip"]);
    is_refused(stl(b"PK\x03\x04rest of it".to_vec()), &["zip"]);
    is_refused(stl(b"\x89PNG\r\n\x1a\nrest of it".to_vec()), &["PNG"]);
    is_refused(stl("<!DOCTYPE html><html>404</html>"), &["HTML"]);
    is_refused(stl("\n <HTML>404</HTML>"), &["HTML"]);
    is_refused(stl("<?xml version=\"1.0\"?><model/>"), &["XML"]);
    is_refused(stl("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n"), &["Git LFS"]);
    is_refused(stl("ply\nformat ascii 1.0\n"), &["PLY"]);
    is_refused(stl("# vtk DataFile Version 3.0\nparts\nASCII\nDATASET POLYDATA\n"), &["VTK"]);
    is_refused(stl("<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\">\n"), &["VTK"]);
    is_refused(stl("  0\r\nSECTION\r\n  2\r\nHEADER\r\n"), &["DXF"]);
    is_refused(stl(format!("{:72}S      1\n{:72}G      1\n", "made by hand", "1H,,1H;")), &["IGES"]);
    is_refused(stl("OFF\n8 6 12\n0 0 0\n"), &["OFF model"]);
    is_refused(stl("{ \"asset\": { \"version\": \"2.0\" }, \"meshes\": [] }"), &["glTF"]);
    is_refused(stl("Dear colleague, please find attached.\n".repeat(9)), &["`Dear colleague", "solid"]);
    let wide = |bytes: fn(u16) -> [u8; 2]| ascii().encode_utf16().flat_map(bytes).collect::<Vec<u8>>();
    is_refused(stl([b"\xff\xfe".to_vec(), wide(u16::to_le_bytes)].concat()), &["UTF-16"]);
    is_refused(stl(wide(u16::to_le_bytes)), &["UTF-16"]);
    is_refused(stl(wide(u16::to_be_bytes)), &["UTF-16"]);
    let scrambled = (0..5000u64).map(|i| (i.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40) as u8);
    is_refused(stl(scrambled.collect::<Vec<u8>>()), &["not an STL", "5000"]);
    is_refused(stl(vec![0; 5000]), &["no triangles"]);
    is_refused(stl(vec![0xff; 5000]), &["4294967295"]);
}

#[cfg(unix)]
#[test]
fn what_is_no_file_is_refused_at_once() {
    let dir = scratch("no_file");
    let fifo = dir.join("fifo.stl");
    assert!(std::process::Command::new("mkfifo").arg(&fifo).status().unwrap().success());
    std::os::unix::fs::symlink("nowhere.stl", dir.join("dangling.stl")).unwrap();
    let refused = |path: &Path, word: &str| {
        let message = read(path).unwrap_err().to_string();
        assert!(message.starts_with(path.to_str().unwrap()) && message.contains(word), "{message}");
    };
    refused(&fifo, "not a regular file");
    refused(Path::new("/dev/null"), "not a regular file");
    refused(Path::new("/dev/zero"), "not a regular file");
    refused(&dir, "directory");
    refused(&dir.join("dangling.stl"), "symbolic link");
    refused(&dir.join("missing.stl"), "cannot open");
}

#[test]
fn a_huge_file_of_the_wrong_kind_is_not_read() {
    // 1 TB of nothing, on a file system with sparse files; reading it would take minutes.
    let path = scratch("sparse").join("huge.stl");
    let file = std::fs::File::create(&path).unwrap();
    if file.set_len(1 << 40).is_ok() {
        assert!(read(&path).unwrap_err().to_string().contains("no triangles"));
        std::fs::write(&path, binary(b"", 12, b"")).unwrap();
        std::fs::OpenOptions::new().write(true).open(&path).unwrap().set_len(1 << 40).unwrap();
        is_box(read(&path), 1);
    }
    std::fs::remove_file(&path).unwrap();
}

/// An empty directory of this test.
fn scratch(name: &str) -> PathBuf {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("input_{name}"));
    let _ = std::fs::remove_dir_all(&dir);
    std::fs::create_dir_all(&dir).unwrap();
    dir
}
