//! Several files that appear together, or none of them.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use super::output::{Spool, Target, back_up};

/// Files on their way: dropped, they leave no trace.
#[derive(Debug, Default)]
pub struct Together {
    // Dropped before the folders that they are in.
    files: Vec<(PathBuf, Spool)>,
    folders: Folders,
}

/// Folders that were made for them.
#[derive(Debug, Default)]
struct Folders(Vec<PathBuf>);

impl Drop for Folders {
    fn drop(&mut self) {
        // Inner ones were made later. One that holds something stays.
        for folder in self.0.iter().rev() {
            let _ = fs::remove_dir(folder);
        }
    }
}

impl Folders {
    /// Makes a folder and those that it lies in, where they are not there.
    fn make(&mut self, folder: &Path) -> Result<()> {
        let missing = folder
            .ancestors()
            .take_while(|it| !it.as_os_str().is_empty());
        let missing: Vec<_> = missing.take_while(|it| !it.exists()).collect();
        for folder in missing.into_iter().rev() {
            fs::create_dir(folder)
                .with_context(|| format!("cannot make the folder {}", folder.display()))?;
            self.0.push(folder.to_owned());
        }
        Ok(())
    }
}

/// What a file has become, should the next one fail.
enum Done {
    /// It is new.
    New(PathBuf),
    /// It has taken the place of another one, which has this name now.
    Replaced { path: PathBuf, backup: PathBuf },
}

impl Done {
    fn undo(self) {
        // Nothing better can be done if this fails too.
        let _ = match self {
            Self::New(path) => fs::remove_file(path),
            Self::Replaced { path, backup } => fs::rename(backup, path),
        };
    }
}

impl Together {
    /// Adds a file that is to hold `text`.
    pub fn add(&mut self, path: &Path, text: &[u8]) -> Result<()> {
        if let Some(folder) = path.parent() {
            self.folders.make(folder)?;
        }
        let mut spool = Target::new(path)?.spool()?;
        spool
            .write_all(text)
            .with_context(|| format!("cannot write {}", path.display()))?;
        self.files.push((path.to_owned(), spool));
        Ok(())
    }

    /// Puts all files where they are to go; gives the names that those have which were
    /// there.
    pub fn deliver(self) -> Result<Vec<PathBuf>> {
        let Self { files, mut folders } = self;
        let mut done = Vec::with_capacity(files.len());
        for (path, spool) in files {
            match deliver(&path, spool) {
                Ok(delivered) => done.push(delivered),
                Err(error) => {
                    done.into_iter().rev().for_each(Done::undo);
                    return Err(error);
                }
            }
        }
        folders.0.clear();
        let backups = done.into_iter().filter_map(|done| match done {
            Done::New(_) => None,
            Done::Replaced { backup, .. } => Some(backup),
        });
        Ok(backups.collect())
    }
}

fn deliver(path: &Path, spool: Spool) -> Result<Done> {
    if !path.is_file() {
        spool.deliver()?;
        return Ok(Done::New(path.to_owned()));
    }
    let path =
        fs::canonicalize(path).with_context(|| format!("cannot write {}", path.display()))?;
    let backup = back_up(&path)?;
    if let Err(error) = spool.deliver() {
        // Nothing is replaced, so there is nothing to go back to.
        let _ = fs::remove_file(&backup);
        return Err(error);
    }
    Ok(Done::Replaced { path, backup })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where one of them cannot be put into its place, the others are as they were.
    #[test]
    fn what_was_there_comes_back() -> Result<()> {
        let folder = tempfile::tempdir()?;
        let at = |name: &str| folder.path().join(name);
        fs::write(at("old.nc"), "old")?;
        let mut together = Together::default();
        for name in ["old.nc", "new.nc", "made/last.nc"] {
            together.add(&at(name), b"new")?;
        }
        // Something takes the last one's place meanwhile.
        fs::create_dir_all(at("made/last.nc/full"))?;
        assert!(together.deliver().is_err());
        assert_eq!(fs::read_to_string(at("old.nc"))?, "old");
        assert!(!at("new.nc").exists());
        assert_eq!(fs::read_dir(folder.path())?.count(), 2);
        Ok(())
    }

    #[test]
    fn dropped_they_leave_no_trace() -> Result<()> {
        let folder = tempfile::tempdir()?;
        let mut together = Together::default();
        together.add(&folder.path().join("a/b/c.nc"), b"new")?;
        drop(together);
        assert_eq!(fs::read_dir(folder.path())?.count(), 0);
        Ok(())
    }
}
