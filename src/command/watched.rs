//! The state of a folder that is watched: which programs lie in it, and which are due.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, Metadata};
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

use anyhow::{Context, Result, bail};
use walkdir::WalkDir;

use super::listing::is_program;
use super::settings;

/// What changes with a file, however it is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stamp {
    bytes: u64,
    written: Option<SystemTime>,
    /// Time of the last change of the file or its name, and its inode.
    #[cfg(unix)]
    inode: (i64, i64, u64),
}

impl Stamp {
    /// Of a file; `None` where there is none.
    pub fn of(path: &Path) -> Option<Self> {
        let metadata = fs::metadata(path).ok()?;
        metadata.is_file().then(|| Self::from(&metadata))
    }
}

impl From<&Metadata> for Stamp {
    fn from(metadata: &Metadata) -> Self {
        #[cfg(unix)]
        use std::os::unix::fs::MetadataExt;
        Self {
            bytes: metadata.len(),
            written: metadata.modified().ok(),
            #[cfg(unix)]
            inode: (metadata.ctime(), metadata.ctime_nsec(), metadata.ino()),
        }
    }
}

/// What is known of a program.
#[derive(Debug)]
struct Known {
    stamp: Stamp,
    /// Since when it has been so.
    since: Instant,
    /// It was dealt with as it is.
    done: bool,
    /// Other files decide what becomes of it: it calls them, or it was refused, which a file
    /// that is missing may be the reason for.
    leans: bool,
}

/// The folder, as it was looked at last.
#[derive(Debug)]
pub struct Watched {
    folder: PathBuf,
    /// Where subprograms are looked for besides.
    others: Vec<PathBuf>,
    settle: Duration,
    programs: BTreeMap<PathBuf, Known>,
    /// All files, programs and others.
    files: BTreeMap<PathBuf, Stamp>,
    /// What could not be looked at, each said once.
    unread: BTreeSet<String>,
}

/// What has changed since the last look.
#[derive(Debug, Default)]
pub struct Changes {
    /// Programs that are there no more, by their place below the folder.
    pub gone: Vec<PathBuf>,
    /// What could not be looked at, for the first time.
    pub unread: Vec<String>,
}

impl Watched {
    /// A folder, and those where subprograms are looked for besides; programs are due when
    /// they have been as they are for so long.
    pub fn new(folder: &Path, others: &[PathBuf], settle: Duration) -> Self {
        Self {
            folder: folder.to_owned(),
            others: others.to_vec(),
            settle,
            programs: BTreeMap::new(),
            files: BTreeMap::new(),
            unread: BTreeSet::new(),
        }
    }

    /// Looks at the folder.
    pub fn look(&mut self, now: Instant) -> Result<Changes> {
        let mut changes = Changes::default();
        let files = self.list(&mut changes)?;
        for (path, stamp) in &files {
            let Ok(below) = path.strip_prefix(&self.folder) else {
                continue;
            };
            if !is_program(path) {
                continue;
            }
            match self.programs.get_mut(below) {
                Some(known) if known.stamp == *stamp => {}
                Some(known) => {
                    (known.stamp, known.since, known.done) = (*stamp, now, false);
                }
                None => {
                    let known = Known {
                        stamp: *stamp,
                        since: now,
                        done: false,
                        leans: false,
                    };
                    self.programs.insert(below.to_owned(), known);
                }
            }
        }
        let there = |below: &PathBuf| files.contains_key(&self.folder.join(below));
        let gone = self.programs.keys().filter(|below| !there(below));
        changes.gone = gone.cloned().collect();
        for below in &changes.gone {
            self.programs.remove(below);
        }
        if files != self.files {
            // Which of them a call would find is not worked out: any may be the one.
            for known in self.programs.values_mut().filter(|known| known.leans) {
                (known.since, known.done) = (now, false);
            }
            self.files = files;
        }
        Ok(changes)
    }

    /// The programs that have settled and are not dealt with, as they are.
    pub fn due(&self, now: Instant) -> Vec<(PathBuf, Stamp)> {
        let settled = |known: &Known| now.duration_since(known.since) >= self.settle;
        let due = self.programs.iter();
        let due = due.filter(|(_, known)| !known.done && settled(known));
        due.map(|(below, known)| (below.clone(), known.stamp))
            .collect()
    }

    /// How long it takes until the next one is due; `None` where none waits.
    pub fn next(&self, now: Instant) -> Option<Duration> {
        let waiting = self.programs.values().filter(|known| !known.done);
        let left = waiting.map(|known| self.settle.saturating_sub(now.duration_since(known.since)));
        left.min()
    }

    /// A program was dealt with as it was then; `leans` where other files decide about it.
    pub fn done(&mut self, below: &Path, as_it_was: Stamp, leans: bool) {
        if let Some(known) = self.programs.get_mut(below) {
            known.done = known.stamp == as_it_was;
            known.leans = leans;
        }
    }

    fn list(&mut self, changes: &mut Changes) -> Result<BTreeMap<PathBuf, Stamp>> {
        let shown = self.folder.display();
        fs::read_dir(&self.folder).with_context(|| format!("cannot read {shown}"))?;
        let mut files = BTreeMap::new();
        let hidden = |name: &std::ffi::OsStr| name.as_encoded_bytes().starts_with(b".");
        let below = |folder: &Path, depth: usize| WalkDir::new(folder).max_depth(depth).into_iter();
        let own = below(&self.folder, usize::MAX);
        let others = self.others.iter().flat_map(|folder| below(folder, 1));
        let all = own.chain(others.collect::<Vec<_>>());
        for entry in all {
            let entry = match entry {
                Ok(entry) => entry,
                // It went while it was looked at.
                Err(error)
                    if error.io_error().map(io::Error::kind) == Some(io::ErrorKind::NotFound) =>
                {
                    continue;
                }
                Err(error) => {
                    let text = format!("cannot look at all of {shown}: {error}");
                    if self.unread.insert(text.clone()) {
                        changes.unread.push(text);
                    }
                    continue;
                }
            };
            let parts = entry.path().strip_prefix(&self.folder);
            if parts.is_ok_and(|it| it.iter().any(hidden)) {
                continue;
            }
            if entry.depth() > 1 && entry.file_name() == settings::NAME {
                bail!(
                    "{} has settings of its own ({}): watch it by itself",
                    entry.path().parent().unwrap_or(entry.path()).display(),
                    settings::NAME
                );
            }
            if let Some(stamp) = Stamp::of(entry.path()) {
                files.insert(entry.into_path(), stamp);
            }
        }
        Ok(files)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SETTLE: Duration = Duration::from_secs(2);

    fn names(due: &[(PathBuf, Stamp)]) -> Vec<&str> {
        due.iter().map(|(it, _)| it.to_str().unwrap()).collect()
    }

    /// A program is due once it has been the same for two seconds, and again when it has
    /// changed. What has no name of a program never is.
    #[test]
    fn programs_are_due_when_they_rest() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let mut watched = Watched::new(folder.path(), &[], SETTLE);
        let begin = Instant::now();
        let after = |seconds| begin + Duration::from_secs(seconds);
        fs::write(at("a.nc"), "G0").unwrap();
        fs::write(at("a.nc~"), "G0").unwrap();
        fs::write(at(".b.nc"), "G0").unwrap();
        watched.look(begin).unwrap();
        assert_eq!(watched.due(after(1)), []);
        assert_eq!(watched.next(after(1)), Some(Duration::from_secs(1)));
        // It grows.
        fs::write(at("a.nc"), "G0 X1").unwrap();
        watched.look(after(1)).unwrap();
        assert_eq!(watched.due(after(2)), []);
        let due = watched.due(after(3));
        assert_eq!(names(&due), ["a.nc"]);
        watched.done(Path::new("a.nc"), due[0].1, false);
        assert_eq!(watched.next(after(3)), None);
        watched.look(after(9)).unwrap();
        assert_eq!(watched.due(after(9)), []);
        // An editor puts another file in its place.
        fs::write(at("new"), "G0 X2").unwrap();
        fs::rename(at("new"), at("a.nc")).unwrap();
        watched.look(after(10)).unwrap();
        assert_eq!(names(&watched.due(after(12))), ["a.nc"]);
        fs::remove_file(at("a.nc")).unwrap();
        let changes = watched.look(after(13)).unwrap();
        assert_eq!(changes.gone, [PathBuf::from("a.nc")]);
        assert_eq!(watched.due(after(20)), []);
    }

    /// One that has changed while it was dealt with is due again.
    #[test]
    fn what_changes_meanwhile_is_due_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.nc");
        let mut watched = Watched::new(folder.path(), &[], Duration::ZERO);
        let now = Instant::now();
        fs::write(&path, "G0").unwrap();
        watched.look(now).unwrap();
        let due = watched.due(now);
        fs::write(&path, "G0 X1").unwrap();
        watched.look(now).unwrap();
        watched.done(Path::new("a.nc"), due[0].1, false);
        assert_eq!(names(&watched.due(now)), ["a.nc"]);
    }

    /// What calls other files is due again when any file appears, changes or goes, in the
    /// folders of subprograms too; what does not, is not.
    #[test]
    fn callers_are_due_with_what_they_may_call() {
        let (folder, subs) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let others = [subs.path().to_owned()];
        let mut watched = Watched::new(folder.path(), &others, Duration::ZERO);
        let now = Instant::now();
        for name in ["caller.nc", "plain.nc"] {
            fs::write(folder.path().join(name), "G0").unwrap();
        }
        watched.look(now).unwrap();
        let deal = |watched: &mut Watched| {
            let due = watched.due(now);
            for (below, stamp) in &due {
                watched.done(below, *stamp, below == Path::new("caller.nc"));
            }
            due
        };
        deal(&mut watched);
        let sub = subs.path().join("100");
        let steps: [&dyn Fn(); 3] = [
            &|| fs::write(&sub, "M99").unwrap(),
            &|| fs::write(&sub, "G0 M99").unwrap(),
            &|| fs::remove_file(&sub).unwrap(),
        ];
        for step in steps {
            step();
            watched.look(now).unwrap();
            assert_eq!(names(&deal(&mut watched)), ["caller.nc"]);
        }
    }

    #[test]
    fn settings_below_are_refused_and_so_is_a_folder_that_is_gone() {
        let folder = tempfile::tempdir().unwrap();
        let mut watched = Watched::new(folder.path(), &[], SETTLE);
        fs::write(folder.path().join("gwatt.toml"), "").unwrap();
        assert!(watched.look(Instant::now()).is_ok());
        fs::create_dir(folder.path().join("a")).unwrap();
        fs::write(folder.path().join("a/gwatt.toml"), "").unwrap();
        let error = watched.look(Instant::now()).unwrap_err().to_string();
        assert!(error.contains("watch it by itself"), "{error}");
        fs::remove_dir_all(folder.path()).unwrap();
        let error = watched.look(Instant::now()).unwrap_err().to_string();
        assert!(error.starts_with("cannot read "), "{error}");
    }
}
