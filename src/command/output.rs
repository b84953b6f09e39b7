//! Results to write: each appears whole or not at all.

use std::fs::{self, File, Permissions};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use anyhow::Context;
use gwatt::pipeline::Restart;

use super::input::is_dash;
use super::progress::around;
use super::terminal::Terminal;
use super::whole_file::WholeFile;

/// Where a result is to go.
#[derive(Debug, Clone)]
pub enum Target {
    /// Standard output.
    Stdout,
    /// A file that is replaced, or made, by renaming.
    File {
        /// Where it really is, links followed.
        path: PathBuf,
        /// Those of the file that it replaces.
        permissions: Option<Permissions>,
    },
    /// A device or a pipe: opened and written to.
    Special(PathBuf),
}

impl Target {
    /// `-` is standard output.
    pub fn new(path: &Path) -> anyhow::Result<Self> {
        if is_dash(path) {
            return Ok(Self::Stdout);
        }
        let shown = path.display();
        let metadata = match fs::metadata(path) {
            Ok(metadata) => metadata,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                let names_folder = path.as_os_str().as_encoded_bytes().ends_with(b"/");
                anyhow::ensure!(
                    !names_folder,
                    "cannot write {shown}: there is no such folder"
                );
                return Ok(Self::File {
                    path: path.to_owned(),
                    permissions: None,
                });
            }
            Err(error) => return Err(error).with_context(|| format!("cannot write {shown}")),
        };
        anyhow::ensure!(
            !metadata.is_dir(),
            "cannot write {shown}: it is a folder; name a file in it"
        );
        if !metadata.is_file() {
            return Ok(Self::Special(path.to_owned()));
        }
        let permissions = metadata.permissions();
        anyhow::ensure!(
            !permissions.readonly(),
            "cannot write {shown}: it is write-protected"
        );
        let path = fs::canonicalize(path).with_context(|| format!("cannot write {shown}"))?;
        Ok(Self::File {
            path,
            permissions: Some(permissions),
        })
    }

    /// Writes a file that people fill in: one that is there keeps another name, unless it is the
    /// same.
    pub fn replace(self, bytes: &[u8], path: &Path, terminal: Terminal) -> anyhow::Result<()> {
        let old = match &self {
            Self::File {
                path,
                permissions: Some(_),
            } => fs::read(path)
                .map_or(true, |old| old != bytes)
                .then(|| path.clone()),
            _ => None,
        };
        let mut spool = self.spool()?;
        let shown = path.display();
        spool
            .write_all(bytes)
            .with_context(|| format!("cannot write {shown}"))?;
        if let Some(old) = old {
            let backup = back_up(&old)?;
            terminal.note(format_args!(
                "what {shown} was is kept as {}",
                backup.display()
            ));
        }
        spool.deliver()
    }

    /// Opens a temporary file that can become the result.
    pub fn spool(self) -> anyhow::Result<Spool> {
        let body = match &self {
            Self::Stdout | Self::Special(_) => {
                let file = tempfile::tempfile().context("cannot make a temporary file")?;
                Body::Apart(file)
            }
            Self::File { path, permissions } => {
                let file = WholeFile::new(path, permissions.clone())
                    .with_context(|| format!("cannot write {}", path.display()))?;
                Body::Whole(file)
            }
        };
        Ok(Spool { target: self, body })
    }
}

/// A result on its way: dropped, it leaves no trace.
#[derive(Debug)]
pub struct Spool {
    target: Target,
    body: Body,
}

#[derive(Debug)]
enum Body {
    Apart(File),
    Whole(WholeFile),
}

impl Body {
    fn file(&self) -> &File {
        match self {
            Self::Apart(file) => file,
            Self::Whole(file) => file.file(),
        }
    }
}

impl Restart for Spool {
    fn restart(&mut self) -> io::Result<()> {
        let mut file = self.body.file();
        file.set_len(0)?;
        file.rewind()
    }
}

impl Spool {
    /// Opens what was written so far for reading from the beginning.
    pub fn read(&mut self) -> io::Result<File> {
        let mut file = self.body.file().try_clone()?;
        file.seek(SeekFrom::Start(0))?;
        Ok(file)
    }

    /// Puts the result where it is to go.
    pub fn deliver(self) -> anyhow::Result<()> {
        match (self.target, self.body) {
            (Target::File { path, .. }, Body::Whole(file)) => file
                .persist(&path)
                .with_context(|| format!("cannot write {}", path.display())),
            (Target::Special(path), Body::Apart(file)) => {
                let copied = File::options()
                    .write(true)
                    .open(&path)
                    .and_then(|out| copy(&file, out));
                copied.with_context(|| format!("cannot write {}", path.display()))
            }
            (_, body) => {
                unless_closed(around(|| copy(body.file(), io::stdout().lock()))).context(STDOUT)
            }
        }
    }
}

impl Write for Spool {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.body.file().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.body.file().flush()
    }
}

const STDOUT: &str = "cannot write to standard output";

fn copy(mut from: &File, mut to: impl Write) -> io::Result<()> {
    from.seek(SeekFrom::Start(0))?;
    io::copy(&mut from, &mut to)?;
    to.flush()
}

/// Lets `write` write to standard output, and makes sure that it arrives.
pub fn print(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> anyhow::Result<()> {
    let mut out = io::BufWriter::new(io::stdout().lock());
    let written = around(|| write(&mut out).and_then(|()| out.flush()));
    // What is left in the buffer has no reader either.
    let _ = out.into_parts();
    unless_closed(written).context(STDOUT)
}

/// A reader of standard output that went away, as `head` does, is no error: the run goes on to
/// its verdict.
fn unless_closed(written: io::Result<()>) -> io::Result<()> {
    match written {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        other => other,
    }
}

/// Keeps the file at `path` under a name that is free, and says which. The file
/// itself stays in place until something replaces it.
pub fn back_up(path: &Path) -> anyhow::Result<PathBuf> {
    for number in 0..1000 {
        let mut name = path.as_os_str().to_owned();
        name.push(".bak");
        if number > 0 {
            name.push(number.to_string());
        }
        let backup = PathBuf::from(name);
        match link_or_copy(path, &backup) {
            Ok(()) => return Ok(backup),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => {
                return Err(error).with_context(|| format!("cannot write {}", backup.display()));
            }
        }
    }
    anyhow::bail!("there are too many backups of {}", path.display())
}

/// A second name is enough, as the file is replaced and never written to; where
/// the file system has none, a copy. Neither overwrites anything.
fn link_or_copy(path: &Path, backup: &Path) -> io::Result<()> {
    match fs::hard_link(path, backup) {
        Err(error) if error.kind() != io::ErrorKind::AlreadyExists => {
            let mut from = File::open(path)?;
            let mut to = File::options().write(true).create_new(true).open(backup)?;
            io::copy(&mut from, &mut to)?;
            to.flush()
        }
        other => other,
    }
}
