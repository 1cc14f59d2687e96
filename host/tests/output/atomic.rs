//! Files replaced as a whole or not at all.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use super::Dir;
use voidage::error::Error;
use voidage::files::vtr::Vtr;
use voidage::files::{atomically, discard_unfinished, json, npy};
use voidage::picture::png;

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
            json::write(&path, &1),
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
        .args(["--exact", "output::atomic::child_that_discards"])
        .env("VOIDAGE_TEST_DIR", &dir.0)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&child.stdout);
    assert!(child.status.success() && said.contains("1 passed"), "{said}");
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
