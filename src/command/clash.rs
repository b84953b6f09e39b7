//! Files that a run would both read and write, or write twice.

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

use super::input::is_dash;

/// Path and inode of a file.
#[derive(Debug)]
struct Identity {
    path: PathBuf,
    /// Device and inode: the same file may have several names.
    #[cfg(unix)]
    inode: Option<(u64, u64)>,
}

impl Identity {
    /// `None` for what may well be written twice: a device or a pipe.
    fn of(path: &Path) -> Option<Self> {
        let metadata = fs::metadata(path).ok();
        if metadata.as_ref().is_some_and(|data| !data.is_file()) {
            return None;
        }
        Some(Self {
            path: real_path(path),
            #[cfg(unix)]
            inode: metadata.map(|data| {
                use std::os::unix::fs::MetadataExt;
                (data.dev(), data.ino())
            }),
        })
    }
}

/// The path without links; of a file that is yet to be made, that of its folder.
fn real_path(path: &Path) -> PathBuf {
    if let Ok(real) = fs::canonicalize(path) {
        return real;
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    match (fs::canonicalize(folder), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => path.to_owned(),
    }
}

/// Refuses outputs that are inputs, and outputs that are the same file.
pub fn refuse_clashes(inputs: &[&Path], outputs: &[&Path]) -> anyhow::Result<()> {
    let dashes = outputs.iter().filter(|path| is_dash(path)).count();
    anyhow::ensure!(dashes <= 1, "only one result can go to standard output");
    let known = |paths: &[&Path]| -> Vec<(PathBuf, Identity)> {
        paths
            .iter()
            .filter(|path| !is_dash(path))
            .filter_map(|path| Some((path.to_path_buf(), Identity::of(path)?)))
            .collect()
    };
    let mut read = Known::default();
    for (_, input) in known(inputs) {
        read.add(input);
    }
    let mut written = Known::default();
    for (path, output) in known(outputs) {
        let shown = path.display();
        anyhow::ensure!(
            !read.has(&output),
            "{shown} is read by this run: write to another file"
        );
        anyhow::ensure!(!written.has(&output), "{shown} would be written twice");
        written.add(output);
    }
    Ok(())
}

/// Files that are known, by path and inode: there may be very many.
#[derive(Default)]
struct Known {
    paths: HashSet<PathBuf>,
    #[cfg(unix)]
    inodes: HashSet<(u64, u64)>,
}

impl Known {
    fn has(&self, file: &Identity) -> bool {
        #[cfg(unix)]
        if file.inode.is_some_and(|inode| self.inodes.contains(&inode)) {
            return true;
        }
        self.paths.contains(&file.path)
    }

    fn add(&mut self, file: Identity) {
        #[cfg(unix)]
        self.inodes.extend(file.inode);
        self.paths.insert(file.path);
    }
}
