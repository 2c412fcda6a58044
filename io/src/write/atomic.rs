//! Files appear whole or not at all.

use super::Error;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::Builder;

/// Writes a file through `contents`: beside the target first, then renamed over it.
///
/// When anything fails, also in `contents`, an old file of this name stays as it was and no
/// temporary file is left. A symbolic link is followed, permissions of an old file are kept, and
/// what is no regular file (a device, a pipe) is written directly.
///
/// # Errors
/// [`Error::File`], or what `contents` returns.
pub fn write<T>(
    path: &Path,
    contents: impl FnOnce(&mut BufWriter<File>) -> Result<T, Error>,
) -> Result<T, Error> {
    let file_error = |source| Error::File {
        path: path.to_path_buf(),
        source,
    };
    // Links are followed, also to files that do not exist yet in an existing folder.
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    let old = fs::metadata(&target).ok();
    if old
        .as_ref()
        .is_some_and(|old| !old.is_file() && !old.is_dir())
    {
        let device = File::options()
            .write(true)
            .open(&target)
            .map_err(file_error)?;
        let mut out = BufWriter::new(device);
        let outcome = contents(&mut out)?;
        out.flush().map_err(file_error)?;
        return Ok(outcome);
    }
    let folder = match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_path_buf(),
        _ => PathBuf::from("."),
    };
    let mut builder = Builder::new();
    builder.prefix(".csg2brep-").suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // As any new file: what the umask leaves. The default of temporary files is stricter.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let (file, temporary) = builder
        .tempfile_in(&folder)
        .map_err(file_error)?
        .into_parts();
    let mut out = BufWriter::with_capacity(1 << 16, file);
    let outcome = contents(&mut out)?;
    let file = out
        .into_inner()
        .map_err(|error| file_error(error.into_error()))?;
    if let Some(old) = old {
        fs::set_permissions(&temporary, old.permissions()).map_err(file_error)?;
    }
    file.sync_all().map_err(file_error)?;
    drop(file);
    temporary
        .persist(&target)
        .map_err(|error| file_error(error.error))?;
    Ok(outcome)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entries(folder: &Path) -> Vec<PathBuf> {
        let entries = fs::read_dir(folder).expect("a folder");
        let mut paths: Vec<_> = entries
            .map(|entry| entry.expect("readable").path())
            .collect();
        paths.sort();
        paths
    }

    fn fill(text: &'static str) -> impl FnOnce(&mut BufWriter<File>) -> Result<usize, Error> {
        move |out| {
            out.write_all(text.as_bytes())?;
            Ok(text.len())
        }
    }

    #[test]
    fn a_file_is_made_and_replaced() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("a.obj");
        assert_eq!(write(&path, fill("first"))?, 5);
        assert_eq!(write(&path, fill("2"))?, 1);
        assert_eq!(fs::read_to_string(&path)?, "2");
        assert_eq!(entries(folder.path()), [path]);
        Ok(())
    }

    #[test]
    fn a_failed_write_leaves_the_old_file() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("a.obj");
        fs::write(&path, "old")?;
        let error = write(&path, |out| {
            out.write_all(b"half of a new o")?;
            Err::<(), _>(Error::PictureSize {
                width: 0,
                height: 0,
            })
        });
        assert!(matches!(error, Err(Error::PictureSize { .. })));
        assert_eq!(fs::read_to_string(&path)?, "old");
        assert_eq!(entries(folder.path()), [path]);
        Ok(())
    }

    #[test]
    fn errors_name_the_file() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("missing/a.obj");
        let error = write(&path, fill("text")).expect_err("no folder");
        assert!(error.to_string().contains("missing/a.obj"));
        // A folder is in the way.
        let error = write(folder.path(), fill("text")).expect_err("a folder");
        assert!(matches!(error, Error::File { .. }));
        assert!(folder.path().is_dir());
        Ok(())
    }

    #[cfg(unix)]
    #[test]
    fn permissions_and_links_are_kept() -> Result<(), Box<dyn std::error::Error>> {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir()?;
        let (path, link) = (
            folder.path().join("real.obj"),
            folder.path().join("link.obj"),
        );
        fs::write(&path, "old")?;
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640))?;
        std::os::unix::fs::symlink(&path, &link)?;
        write(&link, fill("new"))?;
        assert_eq!(fs::read_to_string(&path)?, "new");
        assert!(fs::symlink_metadata(&link)?.is_symlink());
        assert_eq!(fs::metadata(&path)?.permissions().mode() & 0o777, 0o640);
        Ok(())
    }

    #[cfg(unix)]
    #[test]
    fn devices_are_written_directly() -> Result<(), Error> {
        write(Path::new("/dev/null"), fill("gone")).map(|_| ())
    }
}
