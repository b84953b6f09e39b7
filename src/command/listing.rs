//! Which programs are meant: files, folders, patterns and lists of names.

use std::collections::HashSet;
use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use glob::MatchOptions;
use walkdir::WalkDir;

use super::input::{Program, is_dash};
use super::terminal::Terminal;
use crate::cli::{ProgramsArgs, Shard};

/// How names of part programs end, in lower case.
const ENDINGS: [&str; 20] = [
    "ngc", "nc", "tap", "cnc", "gcode", "gco", "g", "mpf", "spf", "min", "ssb", "eia", "iso",
    "din", "dnc", "fnc", "prg", "ptp", "pim", "ncc",
];

/// Bytes of a list of names that are read at most.
const LIST_BYTES_MAX: u64 = 1 << 30;

/// Programs in the order in which they are dealt with.
#[derive(Debug)]
pub struct Listing {
    listed: Vec<Listed>,
    /// They were asked for as many: by a list, a folder, a pattern, or one by one.
    pub is_many: bool,
}

/// A program that is meant.
#[derive(Debug)]
struct Listed {
    path: PathBuf,
    /// Where it lies below the folder that it was found in; else its name.
    below: PathBuf,
}

impl Listing {
    /// Finds them.
    pub fn of(args: &ProgramsArgs, terminal: Terminal) -> Result<Self> {
        let mut found = Self {
            listed: Vec::new(),
            is_many: args.paths.len() > 1 || args.files_from.is_some() || args.shard.is_some(),
        };
        for path in &args.paths {
            found.add(path, terminal)?;
        }
        if let Some(list) = &args.files_from {
            for path in names(list)? {
                found.add(&path, terminal)?;
            }
        }
        let dashes = found.listed.iter().filter(|it| is_dash(&it.path)).count();
        let list = args.files_from.as_deref().is_some_and(is_dash);
        ensure!(
            dashes + usize::from(list) <= 1,
            "standard input can be read only once"
        );
        if let Some(shard) = args.shard {
            found.keep(shard);
        }
        Ok(found)
    }

    /// The programs.
    pub fn programs(&self) -> Vec<Program> {
        let paths = self.listed.iter().map(|it| it.path.as_path());
        paths.map(Program::new).collect()
    }

    /// Where each is to go in a folder of results.
    pub fn places(&self) -> impl Iterator<Item = &Path> {
        self.listed.iter().map(|it| it.below.as_path())
    }

    fn add(&mut self, path: &Path, terminal: Terminal) -> Result<()> {
        if path.is_dir() {
            self.is_many = true;
            return self.add_folder(path, terminal);
        }
        let text = path.to_str().filter(|text| text.contains(['*', '?', '[']));
        let Some(pattern) = text.filter(|_| !is_dash(path) && !path.exists()) else {
            let name = path.file_name().map_or(path, Path::new);
            self.listed.push(Listed {
                path: path.to_owned(),
                below: name.to_owned(),
            });
            return Ok(());
        };
        self.is_many = true;
        self.add_matches(pattern)
    }

    /// All programs below a folder, by their names.
    fn add_folder(&mut self, folder: &Path, terminal: Terminal) -> Result<()> {
        let hidden = |name: &std::ffi::OsStr| name.as_encoded_bytes().starts_with(b".");
        let all = WalkDir::new(folder).sort_by_file_name().into_iter();
        let all = all.filter_entry(|it| it.depth() == 0 || !hidden(it.file_name()));
        let before = self.listed.len();
        let mut others = Vec::new();
        for entry in all {
            let entry = entry.map_err(io::Error::from);
            let entry = entry.with_context(|| format!("cannot read {}", folder.display()))?;
            let path = entry.path();
            if path.is_dir() {
                continue;
            }
            if is_program(path) {
                let below = path.strip_prefix(folder).unwrap_or(path);
                self.listed.push(Listed {
                    path: path.to_owned(),
                    below: below.to_owned(),
                });
            } else {
                others.push(path.to_owned());
            }
        }
        let shown = folder.display();
        ensure!(
            self.listed.len() > before,
            "{shown}: no file below it is a program by its name (.ngc, .nc, .mpf, .gcode, O1234 \
             and so on): give the files themselves, or a pattern"
        );
        if let Some(first) = others.first() {
            let count = others.len();
            terminal.note(format_args!(
                "{shown}: {count} {} left out, no {} by {} name: {}{}",
                if count == 1 { "file is" } else { "files are" },
                if count == 1 { "program" } else { "programs" },
                if count == 1 { "its" } else { "their" },
                first.display(),
                if count == 1 { "" } else { " and others" },
            ));
        }
        Ok(())
    }

    /// Files that match a pattern which no shell has expanded.
    fn add_matches(&mut self, pattern: &str) -> Result<()> {
        let options = MatchOptions {
            case_sensitive: true,
            require_literal_separator: true,
            require_literal_leading_dot: true,
        };
        let found = glob::glob_with(pattern, options)
            .with_context(|| format!("{pattern} is no file and no pattern"))?;
        // What stands before the first sign of a pattern is the folder that holds them all.
        let fixed = pattern.split(['*', '?', '[']).next().unwrap_or_default();
        let folder = fixed.rfind('/').map_or("", |at| &fixed[..=at]);
        let before = self.listed.len();
        for path in found {
            let path = path.with_context(|| format!("cannot read all that {pattern} matches"))?;
            if path.is_file() {
                let below = path.strip_prefix(folder).unwrap_or(&path);
                self.listed.push(Listed {
                    below: below.to_owned(),
                    path,
                });
            }
        }
        ensure!(self.listed.len() > before, "no file matches {pattern}");
        Ok(())
    }

    /// Of all of them, one share. Each program is taken once, however often it is named: else
    /// two runs would write it.
    fn keep(&mut self, shard: Shard) {
        let mut seen = HashSet::new();
        self.listed.retain(|it| seen.insert(it.path.clone()));
        let mut number = 0;
        self.listed.retain(|_| {
            number += 1;
            (number - 1) % shard.count == shard.index - 1
        });
    }
}

/// Whether a file is a program by its name. Fanuc's and Haas' have no ending: `O1234`.
pub fn is_program(path: &Path) -> bool {
    let ending = path
        .extension()
        .map(|it| it.to_string_lossy().to_lowercase());
    if let Some(ending) = ending {
        return ENDINGS.contains(&ending.as_str());
    }
    let name = path.file_name().unwrap_or_default().as_encoded_bytes();
    match name {
        [b'O' | b'o', digits @ ..] => {
            (4..=8).contains(&digits.len()) && digits.iter().all(u8::is_ascii_digit)
        }
        _ => false,
    }
}

/// The names in a list.
fn names(list: &Path) -> Result<Vec<PathBuf>> {
    let shown = list.display();
    let mut text = Vec::new();
    let read =
        |input: &mut dyn Read, text: &mut Vec<u8>| input.take(LIST_BYTES_MAX + 1).read_to_end(text);
    let done = if is_dash(list) {
        read(&mut io::stdin().lock(), &mut text)
    } else {
        fs::File::open(list).and_then(|mut file| read(&mut file, &mut text))
    };
    done.with_context(|| format!("cannot read {shown}"))?;
    if text.len() as u64 > LIST_BYTES_MAX {
        bail!("{shown} is larger than a list of names can be");
    }
    let end = if text.contains(&0) { 0 } else { b'\n' };
    let names = text.split(|byte| *byte == end);
    let names = names.map(|name| {
        if end == b'\n' {
            name.strip_suffix(b"\r").unwrap_or(name)
        } else {
            name
        }
    });
    let names: Result<Vec<_>> = names
        .filter(|name| !name.is_empty())
        .map(|name| path_of(name).with_context(|| format!("{shown}: a name is not UTF-8")))
        .collect();
    names
}

#[cfg(unix)]
#[allow(clippy::unnecessary_wraps, reason = "elsewhere a name has to be UTF-8")]
fn path_of(name: &[u8]) -> Option<PathBuf> {
    use std::os::unix::ffi::OsStrExt;
    Some(PathBuf::from(std::ffi::OsStr::from_bytes(name)))
}

#[cfg(not(unix))]
fn path_of(name: &[u8]) -> Option<PathBuf> {
    std::str::from_utf8(name).ok().map(PathBuf::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn programs_are_known_by_their_names() {
        for program in [
            "a.nc",
            "a/B.NGC",
            "x.MPF",
            "O1234",
            "o00012345",
            "part.gcode",
        ] {
            assert!(is_program(Path::new(program)), "{program}");
        }
        for other in [
            "a.txt", "README", "O12", "O1234x", "a.toml", "nc", "Makefile", "",
        ] {
            assert!(!is_program(Path::new(other)), "{other}");
        }
    }
}
