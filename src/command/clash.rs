//! Files that a run would both read and write, or write twice.

use std::fs;
use std::path::{Path, PathBuf};

use super::input::is_dash;

/// What tells one file from another.
#[derive(Debug, PartialEq, Eq)]
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

    fn is_same(&self, other: &Self) -> bool {
        #[cfg(unix)]
        if self.inode.is_some() && self.inode == other.inode {
            return true;
        }
        self.path == other.path
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
    let (inputs, outputs) = (known(inputs), known(outputs));
    for (index, (path, output)) in outputs.iter().enumerate() {
        let shown = path.display();
        anyhow::ensure!(
            !inputs.iter().any(|(_, input)| input.is_same(output)),
            "{shown} is read by this run: write to another file"
        );
        let others = outputs.iter().take(index);
        anyhow::ensure!(
            !others.into_iter().any(|(_, other)| other.is_same(output)),
            "{shown} would be written twice"
        );
    }
    Ok(())
}
