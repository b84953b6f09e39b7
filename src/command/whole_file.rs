//! A file next to the one that it is to replace, so that renaming it moves no data.
//!
//! Where the system has files without a name it gets its name at the very end:
//! until then nothing is left of it, however the run ends. Elsewhere it has a name
//! from the beginning, which is taken away when the run ends, by a signal too
//! ([`super::interrupt`]). What is left of a run that was killed goes with the next
//! one for the same output ([`clear`]).

use std::ffi::OsStr;
use std::fs::{self, File, Permissions};
use std::io;
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

use super::interrupt;

/// What all names begin with.
const PREFIX: &str = ".gwatt-";
/// Random letters and digits at the end of a name.
const RANDOM: usize = 6;

/// A temporary file next to its place.
#[derive(Debug)]
pub enum WholeFile {
    /// Without a name.
    #[cfg(target_os = "linux")]
    Unnamed(File),
    /// With one, which is taken away on the way out.
    Named(Named),
}

impl WholeFile {
    /// A file next to `path`, with the permissions of the file that it replaces or
    /// those of any new file.
    ///
    /// # Errors
    /// Those of the system.
    pub fn new(path: &Path, permissions: Option<Permissions>) -> io::Result<Self> {
        let (folder, prefix) = (folder(path), prefix(path));
        clear(folder, &prefix);
        let file = Self::make(folder, &prefix, permissions.is_some())?;
        if let Some(permissions) = permissions {
            file.file().set_permissions(permissions)?;
        }
        Ok(file)
    }

    #[cfg(target_os = "linux")]
    fn make(folder: &Path, prefix: &str, private: bool) -> io::Result<Self> {
        match unnamed(folder, private) {
            Ok(file) => Ok(Self::Unnamed(file)),
            // Not every file system has such files.
            Err(_) => Ok(Self::Named(Named::new(folder, prefix, private)?)),
        }
    }

    #[cfg(not(target_os = "linux"))]
    fn make(folder: &Path, prefix: &str, private: bool) -> io::Result<Self> {
        Ok(Self::Named(Named::new(folder, prefix, private)?))
    }

    /// The file.
    pub fn file(&self) -> &File {
        match self {
            #[cfg(target_os = "linux")]
            Self::Unnamed(file) => file,
            Self::Named(named) => named.file.as_file(),
        }
    }

    /// Puts it in place of `path`, at once.
    ///
    /// # Errors
    /// Those of the system; nothing is replaced then.
    pub fn persist(self, path: &Path) -> io::Result<()> {
        match self {
            #[cfg(target_os = "linux")]
            Self::Unnamed(file) => Named::link(file, folder(path), &prefix(path))?.persist(path),
            Self::Named(named) => named.persist(path),
        }
    }
}

/// A file with a name that goes with it.
#[derive(Debug)]
pub struct Named {
    // In this order: the file goes before it is off the list.
    file: NamedTempFile<File>,
    listed: Listed,
}

/// A name that a signal takes away.
#[derive(Debug)]
struct Listed(PathBuf);

impl Drop for Listed {
    fn drop(&mut self) {
        interrupt::guarded(|names| names.remove(&self.0));
    }
}

impl Named {
    /// A new file; `private`: for nobody else yet.
    fn new(folder: &Path, prefix: &str, private: bool) -> io::Result<Self> {
        loop {
            let named = Self::make(folder, prefix, |path| {
                let mut options = File::options();
                options.read(true).write(true).create_new(true);
                #[cfg(unix)]
                {
                    use std::os::unix::fs::OpenOptionsExt;
                    options.mode(mode(private));
                }
                #[cfg(not(unix))]
                let _ = private;
                options.open(path)
            })?;
            // As long as it is locked nobody clears it away; before that another run
            // may have.
            let locked = named.file.as_file().lock().is_ok();
            if !locked || named.file.path().exists() {
                return Ok(named);
            }
        }
    }

    /// A name for a file that has none.
    #[cfg(target_os = "linux")]
    fn link(file: File, folder: &Path, prefix: &str) -> io::Result<Self> {
        use rustix::fs::{AtFlags, CWD, linkat};
        use std::os::fd::AsRawFd;
        // Where files cannot be locked nobody takes others away.
        let _ = file.lock();
        let own = format!("/proc/self/fd/{}", file.as_raw_fd());
        let made = Self::make(folder, prefix, |path| {
            linkat(CWD, &own, CWD, path, AtFlags::SYMLINK_FOLLOW)?;
            file.try_clone()
        });
        // Without /proc there is no way but a copy.
        made.or_else(|_| Self::copy(file, folder, prefix))
    }

    #[cfg(target_os = "linux")]
    fn copy(mut file: File, folder: &Path, prefix: &str) -> io::Result<Self> {
        use std::io::Seek;
        let named = Self::new(folder, prefix, true)?;
        file.rewind()?;
        let mut to = named.file.as_file();
        io::copy(&mut file, &mut to)?;
        to.set_permissions(file.metadata()?.permissions())?;
        Ok(named)
    }

    /// Makes a file under a free name, which a signal takes away from then on.
    fn make(
        folder: &Path,
        prefix: &str,
        make: impl FnMut(&Path) -> io::Result<File>,
    ) -> io::Result<Self> {
        interrupt::guarded(|names| {
            let mut builder = Builder::new();
            builder.prefix(prefix).rand_bytes(RANDOM);
            let file = builder.make_in(folder, make)?;
            let listed = Listed(file.path().to_owned());
            names.insert(listed.0.clone());
            Ok(Self { file, listed })
        })
    }

    fn persist(self, path: &Path) -> io::Result<()> {
        let Self { file, listed } = self;
        let persisted = interrupt::guarded(|_| file.persist(path));
        drop(listed);
        persisted.map(drop).map_err(|error| error.error)
    }
}

/// A file without a name in a folder.
#[cfg(target_os = "linux")]
fn unnamed(folder: &Path, private: bool) -> io::Result<File> {
    use rustix::fs::{Mode, OFlags, open};
    let flags = OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC;
    let file = open(folder, flags, Mode::from_raw_mode(mode(private)))?;
    Ok(file.into())
}

/// The permissions to begin with. Of any new file the system takes the umask off.
#[cfg(unix)]
fn mode(private: bool) -> u32 {
    if private { 0o600 } else { 0o666 }
}

/// The folder of a file.
fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// What the temporary files of an output begin with: its own name as a number, since
/// that may be as long as a name can be.
fn prefix(path: &Path) -> String {
    // FNV-1a.
    let name = path.file_name().unwrap_or_default().as_encoded_bytes();
    let hash = name.iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    });
    format!("{PREFIX}{hash:016x}-")
}

/// Takes away what runs that were killed have left of the same output: a run that
/// goes on holds a lock on its file.
fn clear(folder: &Path, prefix: &str) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten() {
        if is_ours(&entry.file_name(), prefix)
            && entry.file_type().is_ok_and(|kind| kind.is_file())
            && let Ok(file) = File::open(entry.path())
            && file.try_lock().is_ok()
        {
            // Another run may be quicker; what cannot be removed stays.
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Whether a file has a name that [`Named`] gives.
fn is_ours(name: &OsStr, prefix: &str) -> bool {
    let rest = name.as_encoded_bytes().strip_prefix(prefix.as_bytes());
    rest.is_some_and(|rest| rest.len() == RANDOM && rest.iter().all(u8::is_ascii_alphanumeric))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = names.collect();
        names.sort();
        names
    }

    /// Both kinds of file in place of another one.
    #[test]
    fn a_file_appears_whole_in_place_of_the_old_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.ngc");
        let kinds: [fn(&Path, &str) -> io::Result<WholeFile>; 2] = [
            |folder, prefix| WholeFile::make(folder, prefix, false),
            |folder, prefix| Ok(WholeFile::Named(Named::new(folder, prefix, false)?)),
        ];
        for (number, make) in kinds.into_iter().enumerate() {
            let old = fs::read_to_string(&path).ok();
            let file = make(folder.path(), &prefix(&path)).unwrap();
            writeln!(file.file(), "G0 X{number}").unwrap();
            assert_eq!(fs::read_to_string(&path).ok(), old);
            file.persist(&path).unwrap();
            let new = fs::read_to_string(&path).unwrap();
            assert_eq!(new, format!("G0 X{number}\n"));
            assert_eq!(names(folder.path()), ["out.ngc"]);
            // Given up, it leaves no trace.
            drop(make(folder.path(), &prefix(&path)).unwrap());
            assert_eq!(names(folder.path()), ["out.ngc"]);
        }
    }

    /// Without /proc a file that has no name is copied.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_copy_takes_the_place_of_a_link() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.ngc");
        let mut file = tempfile::tempfile().unwrap();
        file.write_all(b"G0 X1\n").unwrap();
        let named = Named::copy(file, folder.path(), &prefix(&path)).unwrap();
        named.persist(&path).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "G0 X1\n");
        assert_eq!(names(folder.path()), ["out.ngc"]);
    }

    /// Old files of the same output go; those of a run that goes on, of other outputs
    /// and of other programs stay.
    #[test]
    fn what_a_killed_run_has_left_goes_with_the_next() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.ngc");
        let prefix = prefix(&path);
        let stale = format!("{prefix}aB3xYz");
        let others = [
            ".gwatt-0123456789abcdef-aB3xYz".to_owned(),
            ".gwatt-notes".to_owned(),
            format!("{prefix}aB3xY"),
            format!("{prefix}aB3-Yz"),
        ];
        for name in others.iter().chain([&stale]) {
            fs::write(folder.path().join(name), "M30\n").unwrap();
        }
        let running = Named::new(folder.path(), &prefix, false).unwrap();
        let file = WholeFile::new(&path, None).unwrap();
        assert!(running.file.path().exists());
        let left = names(folder.path());
        assert!(!left.contains(&stale), "{left:?}");
        assert!(others.iter().all(|name| left.contains(name)), "{left:?}");
        file.persist(&path).unwrap();
        drop(running);
        assert_eq!(names(folder.path()).len(), others.len() + 1);
    }

    /// The run that the next test interrupts.
    #[cfg(unix)]
    #[test]
    #[ignore = "runs only for the next test, in a process of its own"]
    fn holds_a_named_file() {
        let folder = std::env::var("GWATT_TEST_FOLDER").unwrap();
        let named = Named::new(Path::new(&folder), ".gwatt-0-", false).unwrap();
        writeln!(named.file.as_file(), "half of it").unwrap();
        std::thread::sleep(std::time::Duration::from_secs(20));
    }

    /// A name that is there from the beginning goes with a signal, of which the run
    /// ends as it would without.
    #[cfg(unix)]
    #[test]
    fn a_signal_takes_the_name_away() {
        use std::os::unix::process::ExitStatusExt;
        use std::process::{Command, Stdio};
        // What runs in the background of a shell ignores SIGINT.
        let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
        let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        let ignored = ignored.map_or(0, |mask| u64::from_str_radix(mask.trim(), 16).unwrap());
        let signals = [("INT", 2), ("TERM", 15)].into_iter();
        for (name, number) in signals.filter(|(_, number)| ignored >> (number - 1) & 1 == 0) {
            let folder = tempfile::tempdir().unwrap();
            let test = "command::whole_file::tests::holds_a_named_file";
            let mut child = Command::new(std::env::current_exe().unwrap())
                .args(["--ignored", "--exact", test])
                .env("GWATT_TEST_FOLDER", folder.path())
                .stdout(Stdio::null())
                .spawn()
                .unwrap();
            let written = || {
                let entries = fs::read_dir(folder.path()).unwrap();
                let mut sizes = entries.map(|entry| entry.unwrap().metadata().unwrap().len());
                sizes.any(|size| size > 0)
            };
            for _ in 0..1000 {
                if written() {
                    break;
                }
                std::thread::sleep(std::time::Duration::from_millis(10));
            }
            assert!(written());
            let id = child.id().to_string();
            let kill = Command::new("kill")
                .args([&format!("-{name}"), &id])
                .status();
            assert!(kill.unwrap().success());
            assert_eq!(child.wait().unwrap().signal(), Some(number));
            assert_eq!(names(folder.path()), [""; 0]);
        }
    }
}
