//! `gwatt machine import`.

use std::cell::RefCell;
use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use gwatt::diagnostic::excerpt;
use gwatt::import::{File, Format, MAX_BYTES, Near, Wanted, import};

use super::clash::refuse_clashes;
use super::input::is_dash;
use super::output::{Target, print};
use super::terminal::{Shown, Terminal};
use crate::cli::ImportArgs;

/// Makes a machine file of settings.
pub fn run(args: &ImportArgs, terminal: Terminal) -> Result<()> {
    let dashes = args.files.iter().filter(|path| is_dash(path)).count();
    ensure!(dashes <= 1, "standard input can be read only once");
    let inputs: Vec<&Path> = args.files.iter().map(PathBuf::as_path).collect();
    let outputs: Vec<&Path> = args.output.as_deref().into_iter().collect();
    refuse_clashes(&inputs, &outputs)?;
    let target = args.output.as_deref().map(Target::new).transpose()?;
    let files: Result<Vec<File>> = args.files.iter().map(|path| read(path)).collect();
    let wanted = Wanted {
        format: args.format.as_deref().and_then(Format::of_name),
        controller: args.controller.as_deref(),
    };
    let near = OnDisk::default();
    let imported = match import(&files?, wanted, &near) {
        Ok(imported) => imported,
        Err(findings) => {
            terminal.diagnostics(&name_of(&args.files), &findings);
            bail!(Shown)
        }
    };
    terminal.diagnostics(&name_of(&args.files), &imported.warnings);
    match (target, &args.output) {
        (Some(target), Some(path)) if !is_dash(path) => {
            let read = near.read.borrow();
            let read: Vec<&Path> = read.iter().map(PathBuf::as_path).collect();
            refuse_clashes(&read, &[path])?;
            let shown = path.display();
            target.replace(imported.toml.as_bytes(), path, terminal)?;
            terminal.note(format_args!(
                "{shown}: read as {}; fill in what it asks for, then `gwatt machine check {shown}`",
                imported.format.name()
            ));
        }
        _ => print(|out| out.write_all(imported.toml.as_bytes()))?,
    }
    Ok(())
}

/// The name that findings have which belong to no file.
fn name_of(files: &[PathBuf]) -> String {
    files.first().map_or(String::new(), |path| printable(path))
}

fn printable(path: &Path) -> String {
    if is_dash(path) {
        return "standard input".to_owned();
    }
    excerpt(path.as_os_str().as_encoded_bytes(), usize::MAX)
}

/// At most one byte more than is read: enough to see that it is too much.
fn read(path: &Path) -> Result<File> {
    let limit = MAX_BYTES as u64 + 1;
    let mut bytes = Vec::new();
    let done = if is_dash(path) {
        io::stdin().lock().take(limit).read_to_end(&mut bytes)
    } else {
        ensure!(
            !path.is_dir(),
            "cannot read {}: it is a folder",
            path.display()
        );
        fs::File::open(path).and_then(|file| file.take(limit).read_to_end(&mut bytes))
    };
    done.with_context(|| format!("cannot read {}", path.display()))?;
    Ok(File {
        name: printable(path),
        bytes,
    })
}

/// Files in the folder of the one that names them.
#[derive(Default)]
struct OnDisk {
    /// Those that were read.
    read: RefCell<Vec<PathBuf>>,
}

impl OnDisk {
    /// A file that is there and can be read.
    fn plain(&self, path: &Path) -> Option<File> {
        let file = path.is_file().then(|| read(path).ok()).flatten()?;
        self.read.borrow_mut().push(path.to_owned());
        Some(file)
    }
}

impl Near for OnDisk {
    fn files(&self, from: &str, pattern: &str) -> Vec<File> {
        let folder = Path::new(from).parent().unwrap_or(Path::new(""));
        let path = folder.join(pattern);
        let name = path.file_name().and_then(|name| name.to_str());
        let Some(name) = name.filter(|name| name.contains(['*', '?'])) else {
            return self.plain(&path).into_iter().collect();
        };
        let parent = path.parent().unwrap_or(Path::new(""));
        let here = if parent.as_os_str().is_empty() {
            Path::new(".")
        } else {
            parent
        };
        let entries = fs::read_dir(here).into_iter().flatten().flatten();
        let mut paths: Vec<PathBuf> = entries
            .filter(|entry| {
                let entry = entry.file_name();
                entry
                    .to_str()
                    .is_some_and(|entry| fits(name.as_bytes(), entry.as_bytes()))
            })
            .map(|entry| parent.join(entry.file_name()))
            .collect();
        paths.sort();
        paths.iter().filter_map(|path| self.plain(path)).collect()
    }
}

/// Whether a name fits a pattern of `*` and `?`.
fn fits(pattern: &[u8], name: &[u8]) -> bool {
    let (mut p, mut n) = (0, 0);
    // The last star, and what it stands for so far.
    let mut star: Option<(usize, usize)> = None;
    while n < name.len() {
        match pattern.get(p) {
            Some(b'*') => {
                star = Some((p, n));
                p += 1;
            }
            Some(b'?') => (p, n) = (p + 1, n + 1),
            Some(byte) if name.get(n) == Some(byte) => (p, n) = (p + 1, n + 1),
            _ => {
                let Some((at, taken)) = star else {
                    return false;
                };
                star = Some((at, taken + 1));
                (p, n) = (at + 1, taken + 1);
            }
        }
    }
    pattern
        .get(p..)
        .is_some_and(|rest| rest.iter().all(|b| *b == b'*'))
}

#[cfg(test)]
mod tests {
    use super::fits;

    #[test]
    fn patterns() {
        for (pattern, name, does) in [
            ("*.cfg", "a.cfg", true),
            ("*.cfg", "a.cfg.bak", false),
            ("a?c*", "abc", true),
            ("a?c*", "ac", false),
            ("*a*b*", "xxaybz", true),
            ("", "a", false),
        ] {
            assert_eq!(
                fits(pattern.as_bytes(), name.as_bytes()),
                does,
                "{pattern} {name}"
            );
        }
    }
}
