//! Subprograms in files of their own.

mod loading;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::error::FlowError;
use crate::label::Label;
use crate::reading::Reading;
use crate::shelf::Shelf;

/// Bytes that all files of subprograms may have together.
const BYTES_MAX: u64 = 64 << 20;

/// The files that may hold a macro of a printer.
pub(crate) fn macro_files(name: &str) -> [String; 2] {
    [format!("{name}.gcode"), format!("{name}.g")]
}

/// The file with one of these names, whatever the case of their letters; the first folder,
/// and in it the first name that exists, counts.
pub(crate) fn find_named(folders: &[PathBuf], wanted: &[String]) -> Option<PathBuf> {
    let find = |folder: &PathBuf| {
        let mut found: Vec<(usize, PathBuf)> = fs::read_dir(folder)
            .ok()?
            .flatten()
            .filter_map(|entry| {
                let file = entry.file_name().to_string_lossy().into_owned();
                let rank = wanted
                    .iter()
                    .position(|name| name.eq_ignore_ascii_case(&file))?;
                Some((rank, entry.path()))
            })
            .filter(|(_, path)| path.is_file())
            .collect();
        found.sort();
        found.into_iter().next().map(|(_, path)| path)
    };
    folders.iter().find_map(find)
}

/// The folders where subprograms are looked for.
#[derive(Debug)]
pub(super) struct Library {
    folders: Arc<[PathBuf]>,
    bytes: u64,
    /// Names of the files that were loaded, with their paths and numbers.
    loaded: Vec<String>,
    paths: Vec<PathBuf>,
    numbers: Vec<u16>,
    /// Files that stand for those on the disk, and the program's own number among them.
    shelf: Option<Arc<Shelf>>,
    own: u16,
}

impl Library {
    pub(super) fn new(reading: &Reading) -> Self {
        Self {
            folders: Arc::clone(&reading.sub_paths),
            bytes: 0,
            loaded: Vec::new(),
            paths: Vec::new(),
            numbers: Vec::new(),
            shelf: reading.shelf.clone(),
            own: reading.text,
        }
    }

    /// Names of the files of subprograms by number, from 1 on.
    pub(super) fn names(&self) -> &[String] {
        let shelf = self.shelf.as_deref();
        shelf.map_or(self.loaded.as_slice(), Shelf::names)
    }

    /// Where the files that were loaded lie.
    pub(super) fn paths(&self) -> &[PathBuf] {
        &self.paths
    }

    /// The number of a text; 0 is the program itself.
    pub(super) fn number(&self, text: usize) -> u16 {
        let numbers = |text: usize| self.numbers.get(text).copied();
        text.checked_sub(1).and_then(numbers).unwrap_or(self.own)
    }

    /// Names of the files that were loaded, in order.
    pub(super) fn loaded(&self) -> &[String] {
        &self.loaded
    }

    /// That there is no such subprogram.
    pub(super) fn nothing(label: &Label) -> FlowError {
        let message = format!("there is no subprogram {label}");
        let file = match label {
            Label::Name(_) => names(label)
                .first()
                .map_or_else(|| "its file".to_owned(), Clone::clone),
            Label::Number(number) => format!(
                "its file (O{number:04}.nc, {number}.ngc or another spelling of the number: with \
                 or without O and zeros before it, and with the ending {} or none)",
                ENDINGS.join(", ")
            ),
        };
        let help = format!(
            "define it in the program, or put {file} into its folder or one given by --sub-path"
        );
        FlowError::new("no-such-subprogram", message, help)
    }

    /// The contents of `NAME.SPF`, if there is such a file.
    pub(super) fn load_subprogram(&mut self, name: &str) -> Result<Option<Vec<u8>>, FlowError> {
        self.load_named(&[
            format!("{name}.SPF"),
            format!("_N_{name}_SPF"),
            format!("{name}_SPF"),
        ])
    }

    /// That there is no such macro any more.
    pub(super) fn no_macro(name: &str) -> FlowError {
        let message = format!("there is no file of the macro {name}");
        FlowError::new("unknown-macro", message, "check the folders of --sub-path")
    }

    /// The contents of the file that holds a subprogram of SINUMERIK:
    /// `NAME.SPF` or `NAME.MPF`, whatever the case of its letters.
    pub(super) fn load_siemens(&mut self, name: &str) -> Result<Vec<u8>, FlowError> {
        let wanted = [
            format!("{name}.SPF"),
            format!("{name}.MPF"),
            format!("_N_{name}_SPF"),
            format!("_N_{name}_MPF"),
            format!("{name}_SPF"),
        ];
        let Some(bytes) = self.load_named(&wanted)? else {
            let message = format!("there is no subprogram {name}, and no word of this name");
            let help = format!(
                "define it in the program, or put {name}.SPF into its folder or one given by --sub-path"
            );
            return Err(FlowError::new("no-such-subprogram", message, help));
        };
        Ok(bytes)
    }

    /// The contents of the file with one of these names, whatever the case of
    /// their letters; the first name that exists counts.
    pub(super) fn load_named(&mut self, wanted: &[String]) -> Result<Option<Vec<u8>>, FlowError> {
        match find_named(&self.folders, wanted) {
            Some(path) => self.read(&path).map(Some),
            None => Ok(None),
        }
    }

    /// The contents of the file that holds a subprogram, if there is one.
    pub(super) fn load(&mut self, label: &Label) -> Result<Option<Vec<u8>>, FlowError> {
        let names = names(label);
        let found = self.folders.iter().find_map(|folder| {
            let mut usual = names.iter().map(|name| folder.join(name));
            usual.find(|path| path.is_file()).or_else(|| match label {
                Label::Number(number) => spelt_otherwise(folder, *number),
                Label::Name(_) => None,
            })
        });
        let Some(path) = found else { return Ok(None) };
        self.read(&path).map(Some)
    }

    fn read(&mut self, path: &Path) -> Result<Vec<u8>, FlowError> {
        let shown = path.display().to_string();
        let unreadable = |why: String| {
            let message = format!("the subprogram file {shown} cannot be read: {why}");
            FlowError::new("no-such-subprogram", message, "check the file")
        };
        if let Some(shelf) = &self.shelf {
            let Some((number, text)) = shelf.take(path) else {
                return Err(unreadable(
                    "it was not there when the programs were read first".to_owned(),
                ));
            };
            let text = text.to_vec();
            self.note(path, shown, number);
            return Ok(text);
        }
        let size = fs::metadata(path)
            .map_err(|error| unreadable(error.to_string()))?
            .len();
        self.bytes += size;
        if self.bytes > BYTES_MAX {
            return Err(unreadable(
                "the subprograms have more than 64 MiB".to_owned(),
            ));
        }
        let bytes = fs::read(path).map_err(|error| unreadable(error.to_string()))?;
        let number = u16::try_from(self.loaded.len() + 1).unwrap_or(u16::MAX);
        self.note(path, shown, number);
        Ok(bytes)
    }

    fn note(&mut self, path: &Path, shown: String, number: u16) {
        self.loaded.push(shown);
        self.paths.push(path.to_owned());
        self.numbers.push(number);
    }
}

/// Endings of files that hold a subprogram with a number.
const ENDINGS: [&str; 8] = ["ngc", "nc", "cnc", "txt", "tap", "eia", "min", "prg"];

/// File names that a subprogram may have, those that are looked for first.
fn names(label: &Label) -> Vec<String> {
    match label {
        // A name is no path.
        Label::Name(name) if name.contains(['/', '\\']) || name.starts_with('.') => Vec::new(),
        Label::Name(name) => vec![format!("{name}.ngc"), name.clone()],
        Label::Number(number) => {
            let stems = [
                format!("{number}"),
                format!("O{number:04}"),
                format!("O{number}"),
                format!("o{number:04}"),
                format!("o{number}"),
            ];
            let endings = [".ngc", ".nc", ".NC", ".cnc", ".txt", ".tap", ""];
            stems
                .iter()
                .flat_map(|stem| endings.map(|ending| format!("{stem}{ending}")))
                .collect()
        }
    }
}

/// The file in a folder whose name is the number in any other spelling; of several the
/// first by name.
fn spelt_otherwise(folder: &Path, number: u32) -> Option<PathBuf> {
    let entries = fs::read_dir(folder).ok()?.flatten();
    let mut found: Vec<PathBuf> = entries
        .filter(|entry| number_of(&entry.file_name().to_string_lossy()) == Some(number))
        .map(|entry| entry.path())
        .filter(|path| path.is_file())
        .collect();
    found.sort();
    found.into_iter().next()
}

/// The number of the subprogram that a file of this name holds: `O09001.nc` is 9001.
fn number_of(file: &str) -> Option<u32> {
    let (stem, ending) = file.split_once('.').unwrap_or((file, ""));
    let usual = ENDINGS
        .iter()
        .any(|known| known.eq_ignore_ascii_case(ending));
    if !(ending.is_empty() || usual) {
        return None;
    }
    let digits = stem.strip_prefix(['O', 'o']).unwrap_or(stem);
    let plain = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
    plain.then(|| digits.parse().ok())?
}

#[cfg(test)]
mod tests {
    use super::number_of;

    #[test]
    fn a_file_name_is_a_number_in_any_usual_spelling() {
        for name in [
            "O09001.nc",
            "9001",
            "O9001.NC",
            "o9001",
            "09001.EIA",
            "O9001.Min",
        ] {
            assert_eq!(number_of(name), Some(9001), "{name}");
        }
        for name in [
            "O9001.nc.bak",
            "O9001.pdf",
            "OO9001",
            "",
            "O",
            "O-1.nc",
            "99999999999",
            "9001~",
        ] {
            assert_eq!(number_of(name), None, "{name}");
        }
    }
}
