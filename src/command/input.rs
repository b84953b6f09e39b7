//! Programs to read: files, or standard input.

use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use gwatt::diagnostic::excerpt;
use gwatt::pipeline::Failure;
use gwatt::source::MAX_LINE_BYTES;

use super::progress::{Meter, Progress, Shape};

/// A program that is to be read.
#[derive(Debug)]
pub struct Program {
    /// Its name as it was given, printable.
    pub name: String,
    source: Source,
    /// Counts what is read of it.
    meter: Option<Meter>,
}

#[derive(Debug)]
enum Source {
    Stdin,
    File(PathBuf),
    /// Standard input, kept so that it can be read again.
    Kept(Mutex<File>),
    /// A file as it was when it was copied.
    Copy(PathBuf, Mutex<File>),
}

impl Program {
    /// `-` is standard input.
    pub fn new(path: &Path) -> Self {
        let source = if is_dash(path) {
            Source::Stdin
        } else {
            Source::File(path.to_owned())
        };
        Self {
            name: excerpt(path.as_os_str().as_encoded_bytes(), usize::MAX),
            source,
            meter: None,
        }
    }

    /// Its path, unless it is standard input.
    pub fn path(&self) -> Option<&Path> {
        match &self.source {
            Source::File(path) | Source::Copy(path, _) => Some(path),
            Source::Stdin | Source::Kept(_) => None,
        }
    }

    /// Shows how much of it is read from now on, as a rule in so many passes.
    pub fn progress(&mut self, shape: Shape, passes: u64) -> Progress {
        let progress = Progress::of_bytes(shape, &self.name, self.bytes(), passes);
        self.count_by(progress.meter());
        progress
    }

    /// Has a meter count what is read of it from now on.
    pub fn count_by(&mut self, meter: Meter) {
        self.meter = Some(meter);
    }

    /// Opens it for reading from the beginning. What cannot be jumped about in
    /// is copied first: programs with calls and loops need that.
    pub fn open(&self) -> Result<Input, Failure> {
        let file = match &self.source {
            Source::Stdin => copied(&mut io::stdin().lock()),
            Source::File(path) => open_file(path),
            Source::Kept(file) | Source::Copy(_, file) => reopened(file),
        };
        Ok(Input {
            file: file?,
            meter: self.meter.clone(),
        })
    }

    /// The folder that it lies in.
    pub fn folder(&self) -> Option<&Path> {
        let folder = self.path()?.parent()?;
        Some(if folder.as_os_str().is_empty() {
            Path::new(".")
        } else {
            folder
        })
    }

    /// Makes sure that it can be opened several times.
    pub fn keep(&mut self) -> Result<(), Failure> {
        if matches!(self.source, Source::Stdin) {
            self.source = Source::Kept(Mutex::new(copied(&mut io::stdin().lock())?));
        }
        Ok(())
    }

    /// Copies its file: what happens to it later does not count.
    pub fn copy(&mut self) -> Result<(), Failure> {
        if let Source::File(path) = &self.source {
            let copy = copied(&mut open_file(path)?)?;
            self.source = Source::Copy(path.clone(), Mutex::new(copy));
        }
        Ok(())
    }

    /// Its size in bytes; 0 for standard input that is not kept.
    pub fn bytes(&self) -> u64 {
        let metadata = match &self.source {
            Source::Stdin => return 0,
            Source::File(path) => fs::metadata(path),
            Source::Kept(file) | Source::Copy(_, file) => held(file).metadata(),
        };
        metadata.map_or(0, |metadata| metadata.len())
    }
}

/// A program that is read.
#[derive(Debug)]
pub struct Input {
    file: File,
    meter: Option<Meter>,
}

impl Read for Input {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.file.read(buffer)?;
        if let Some(meter) = &self.meter {
            meter.add(read as u64);
        }
        Ok(read)
    }
}

impl Seek for Input {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

fn open_file(path: &Path) -> Result<File, Failure> {
    let mut file = File::open(path).map_err(Failure::Input)?;
    let kind = file.metadata().map_err(Failure::Input)?.file_type();
    // Some systems open a directory and fail later with a riddle.
    if kind.is_dir() {
        let error = io::Error::new(io::ErrorKind::IsADirectory, "it is a directory");
        return Err(Failure::Input(error));
    }
    if kind.is_file() {
        return Ok(file);
    }
    copied(&mut file)
}

fn held(file: &Mutex<File>) -> MutexGuard<'_, File> {
    // It is moved about in from its beginning only.
    file.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A file without a name from its beginning, for a reader of its own: several may
/// read it at once.
fn reopened(file: &Mutex<File>) -> Result<File, Failure> {
    let mut file = held(file);
    #[cfg(target_os = "linux")]
    {
        use std::os::fd::AsRawFd;
        if let Ok(own) = File::open(format!("/proc/self/fd/{}", file.as_raw_fd())) {
            return Ok(own);
        }
    }
    file.rewind().map_err(Failure::Input)?;
    copied(&mut *file)
}

/// A file with what is left to read.
fn copied(input: &mut dyn Read) -> Result<File, Failure> {
    let mut file = tempfile::tempfile().map_err(Failure::Output)?;
    copy(input, &mut file)?;
    file.rewind().map_err(Failure::Input)?;
    Ok(file)
}

/// Copies up to the end, or to a line that is longer than a program may have:
/// a device that never ends must not fill the disk.
fn copy(input: &mut dyn Read, output: &mut File) -> Result<(), Failure> {
    let mut buffer = vec![0; 1 << 16];
    let mut line = 0;
    while line <= MAX_LINE_BYTES {
        let read = match input.read(&mut buffer) {
            Ok(0) => return Ok(()),
            Ok(read) => buffer.get(..read).unwrap_or_default(),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(error) => return Err(Failure::Input(error)),
        };
        output.write_all(read).map_err(Failure::Output)?;
        let last = read.iter().rposition(|byte| matches!(byte, b'\n' | b'\r'));
        line = last.map_or(line + read.len(), |last| read.len() - last);
    }
    Ok(())
}

/// True for `-`.
pub fn is_dash(path: &Path) -> bool {
    path.as_os_str() == "-"
}
