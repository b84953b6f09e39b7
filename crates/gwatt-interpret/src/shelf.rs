//! Files that several programs share: numbered once for all of them, with the texts that
//! stand in them.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Programs and files of subprograms that are read together. Their numbers are their places:
/// the programs themselves come first.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Shelf {
    files: Vec<Shelved>,
    /// Their names, without that of the first.
    names: Vec<String>,
}

/// A file and its text.
#[derive(Debug, Clone, PartialEq)]
struct Shelved {
    place: PathBuf,
    text: Arc<[u8]>,
}

impl Shelf {
    /// How many files there can be: a move knows its file by a number of 16 bits.
    pub const FILES_MAX: usize = 10_000;

    /// Puts a file next to the others, unless it is there already; `path` leads to it,
    /// `name` is what messages call it.
    pub fn put(&mut self, path: &Path, name: &str, text: impl Into<Arc<[u8]>>) {
        let place = place_of(path);
        if self.find(&place).is_some() {
            return;
        }
        if !self.files.is_empty() {
            self.names.push(name.to_owned());
        }
        let text = text.into();
        self.files.push(Shelved { place, text });
    }

    /// Whether there is a file which `path` leads to.
    #[must_use]
    pub fn holds(&self, path: &Path) -> bool {
        self.number(path).is_some()
    }

    /// The number of the file which `path` leads to.
    #[must_use]
    pub fn number(&self, path: &Path) -> Option<usize> {
        self.find(&place_of(path))
    }

    fn find(&self, place: &Path) -> Option<usize> {
        self.files.iter().position(|file| file.place == place)
    }

    /// The number and the text of the file which `path` leads to.
    pub(super) fn take(&self, path: &Path) -> Option<(u16, &[u8])> {
        let number = self.number(path)?;
        let file = self.files.get(number)?;
        Some((u16::try_from(number).ok()?, &file.text))
    }

    /// The same files with other texts, in the same order.
    #[must_use]
    pub fn with_texts(&self, texts: impl IntoIterator<Item = Vec<u8>>) -> Self {
        let mut shelf = self.clone();
        for (file, text) in shelf.files.iter_mut().zip(texts) {
            file.text = text.into();
        }
        shelf
    }

    /// Where the files lie and what stands in them, in the order of their numbers.
    pub fn files(&self) -> impl Iterator<Item = (&Path, &[u8])> {
        let files = self.files.iter();
        files.map(|file| (file.place.as_path(), &*file.text))
    }

    /// What messages call the file of that number, from 1 on.
    #[must_use]
    pub fn name(&self, number: usize) -> Option<&str> {
        let index = number.checked_sub(1)?;
        self.names.get(index).map(String::as_str)
    }

    /// The names of the files from number 1 on.
    pub(crate) fn names(&self) -> &[String] {
        &self.names
    }
}

/// A path that distinguishes one file from another: its folder without links, and its own name,
/// under which the control finds it.
fn place_of(path: &Path) -> PathBuf {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    match (fs::canonicalize(folder), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => path.to_owned(),
    }
}
