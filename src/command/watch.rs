//! `gwatt watch`.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail, ensure};
use gwatt::pipeline;
use gwatt::report::{Totals, Verdict};
use notify::{EventKind, RecommendedWatcher, RecursiveMode, Watcher};

use super::in_order::in_order;
use super::input::Program;
use super::limit::{Limited, limit_one, refuse_how, setup};
use super::many::in_own_dialect;
use super::output::Target;
use super::places::Places;
use super::settings::Settings;
use super::setup::{Setup, machine_file, share_threads};
use super::terminal::{Messages, Terminal};
use super::watched::{Stamp, Watched};
use crate::cli::{LimitArgs, WatchArgs};

/// How often the folder is looked at where nothing is reported: shares on other computers may
/// report nothing.
const LOOK: Duration = Duration::from_secs(5);
/// Changes come in swarms: so long they are let come.
const SWARM: Duration = Duration::from_millis(100);

/// Limits the programs that appear in a folder into another one.
pub fn run(args: &WatchArgs, terminal: Terminal) -> Result<Verdict> {
    refuse_how(&args.how)?;
    let folders = Folders::of(args)?;
    let mut limit = args.limit();
    // The folder's own settings are those of all programs below it.
    let settings = Settings::of(&[Program::new(&folders.from.join("it"))], terminal)?;
    settings.fill(&mut limit.machine, &mut limit.reading)?;
    settings.allow(&mut limit.how.allow);
    let given = Given::of(&limit, &folders.from);
    let mut shop = Shop {
        setup: setup(&limit, terminal)?,
        limit,
        folders,
        terminal,
        totals: Totals::default(),
    };
    let settle = Duration::from_secs_f64(args.settle);
    let others = &shop.limit.reading.sub_path;
    let mut watched = Watched::new(&shop.folders.from, others, settle);
    let (_watcher, reports) = reports(&shop.folders.from, others, terminal);
    loop {
        given.are_the_same()?;
        let changes = watched.look(Instant::now())?;
        for unread in changes.unread {
            terminal.error(unread);
        }
        for below in changes.gone {
            shop.gone(&below)?;
        }
        let due = watched.due(Instant::now());
        for (below, stamp, leans) in shop.deal(&due)? {
            watched.done(&below, stamp, leans);
        }
        let wait = match watched.next(Instant::now()) {
            Some(left) => left.min(LOOK),
            None if args.now => break,
            None => LOOK,
        };
        wait_for(&reports, wait);
    }
    terminal.text(&format!("{}\n", shop.totals));
    Ok(shop.totals.worst())
}

/// Waits for a report of a change, at most so long.
fn wait_for(reports: &Receiver<()>, wait: Duration) {
    match reports.recv_timeout(wait) {
        Ok(()) => {
            thread::sleep(SWARM);
            while reports.try_recv().is_ok() {}
        }
        Err(mpsc::RecvTimeoutError::Timeout) => {}
        // Nothing reports: what is there is looked at all the same.
        Err(mpsc::RecvTimeoutError::Disconnected) => thread::sleep(wait),
    }
}

/// Has the system report changes in folders, where it can.
fn reports(
    folder: &Path,
    others: &[PathBuf],
    terminal: Terminal,
) -> (Option<RecommendedWatcher>, Receiver<()>) {
    let (sender, receiver) = mpsc::channel();
    let report = move |event: notify::Result<notify::Event>| {
        // What is read, by this run too, does not change anything.
        if !event.is_ok_and(|event| matches!(event.kind, EventKind::Access(_))) {
            let _ = sender.send(());
        }
    };
    let watcher = notify::recommended_watcher(report).and_then(|mut watcher| {
        watcher.watch(folder, RecursiveMode::Recursive)?;
        for other in others {
            watcher.watch(other, RecursiveMode::NonRecursive)?;
        }
        Ok(watcher)
    });
    match watcher {
        Ok(watcher) => (Some(watcher), receiver),
        Err(error) => {
            let seconds = LOOK.as_secs();
            terminal.note(format_args!(
                "the system does not report changes ({error}): the folder is looked at every \
                 {seconds} s"
            ));
            (None, receiver)
        }
    }
}

/// Files that say how programs are judged, as they were at the beginning.
struct Given(Vec<(PathBuf, Option<Stamp>)>);

impl Given {
    fn of(args: &LimitArgs, folder: &Path) -> Self {
        let settings = Settings::file_of(folder);
        let machine = machine_file(args.machine.machine.as_deref()).map(Path::to_owned);
        let reading = &args.reading;
        let data = [reading.tool_table.clone(), reading.parameters.clone()];
        let all = data.into_iter().flatten().chain(settings).chain(machine);
        Self(all.map(|path| (path.clone(), Stamp::of(&path))).collect())
    }

    fn are_the_same(&self) -> Result<()> {
        for (path, stamp) in &self.0 {
            ensure!(
                Stamp::of(path) == *stamp,
                "{} has changed: start `gwatt watch` again, so that all programs are limited by \
                 it",
                path.display()
            );
        }
        Ok(())
    }
}

/// Where programs come from and go to.
struct Folders {
    from: PathBuf,
    into: PathBuf,
}

impl Folders {
    fn of(args: &WatchArgs) -> Result<Self> {
        let (from, into) = (&args.from, &args.into);
        let shown = from.display();
        ensure!(from.is_dir(), "{shown} is no folder");
        fs::create_dir_all(into)
            .with_context(|| format!("cannot make the folder {}", into.display()))?;
        let real = |folder: &Path| {
            fs::canonicalize(folder).with_context(|| format!("cannot read {}", folder.display()))
        };
        let [from_real, into_real] = [real(from)?, real(into)?];
        ensure!(
            !from_real.starts_with(&into_real) && !into_real.starts_with(&from_real),
            "{shown} and {} lie in one another: what is written would be read again",
            into.display()
        );
        Ok(Self {
            from: from.clone(),
            into: into.clone(),
        })
    }

    /// The file of a program in the folder of results, with this ending.
    fn result(&self, below: &Path, ending: &str) -> PathBuf {
        let mut path = self.into.join(below).into_os_string();
        path.push(ending);
        path.into()
    }
}

/// Endings of what stands next to a program.
const CERTIFICATE: &str = ".certificate.txt";
const REPORT: &str = ".csv";
const REFUSED: &str = ".refused.txt";

/// What programs are limited with, and where to.
struct Shop {
    limit: LimitArgs,
    setup: Setup,
    folders: Folders,
    terminal: Terminal,
    totals: Totals,
}

/// What came of a program, and what is to be said of it.
type Dealt = (Messages, Result<Option<(Limited, bool)>>);

impl Shop {
    /// Limits programs, several at once; gives those that were dealt with, and whether other
    /// files decide about them.
    fn deal(&mut self, due: &[(PathBuf, Stamp)]) -> Result<Vec<(PathBuf, Stamp, bool)>> {
        let threads = self.setup.options.threads;
        let (at_once, each) = share_threads(threads, due.len());
        let mut setup = self.setup.clone();
        setup.options.threads = each;
        let shop = &*self;
        let one = |(below, stamp): &(PathBuf, Stamp)| {
            let dealt = shop.deal_with(&setup, below, *stamp);
            (below.clone(), *stamp, dealt)
        };
        let mut totals = Vec::new();
        let mut done = Vec::new();
        in_order(due, at_once, one, |(below, stamp, (messages, dealt))| {
            let (verdict, leans) = match &dealt {
                Ok(Some((limited, leans))) => (limited.verdict(), *leans),
                // It has changed meanwhile, and is looked at again.
                Ok(None) => return Ok(()),
                Err(_) => (Some(Verdict::Refused), true),
            };
            if !(shop.limit.quiet && matches!(verdict, Some(Verdict::Fits) | None)) {
                shop.terminal.show(&messages);
            }
            if let Err(error) = dealt {
                shop.terminal.error(format_args!("{error:#}"));
            }
            totals.push(verdict);
            done.push((below, stamp, leans));
            Ok(())
        })?;
        for verdict in totals {
            self.totals.count(verdict);
        }
        Ok(done)
    }

    /// Limits one program; `None` where it has changed meanwhile. Whatever goes wrong, nothing
    /// that was written of an earlier version stays.
    fn deal_with(&self, setup: &Setup, below: &Path, stamp: Stamp) -> Dealt {
        let mut messages = Messages::plain();
        let path = self.folders.from.join(below);
        let mut program = Program::new(&path);
        let copied = program.copy();
        if Stamp::of(&path) != Some(stamp) {
            return (messages, Ok(None));
        }
        let limited = match copied {
            Ok(()) => self.limited(setup, below, &program, &mut messages),
            Err(failure) => {
                messages.failure(&program.name, &failure);
                Ok((Limited::Refused, true))
            }
        };
        let done = match limited {
            Ok((limited, leans)) => self
                .put_down(below, limited, &mut messages)
                .map(|()| Some((limited, leans))),
            Err(error) => {
                messages.error(format_args!("{}: {error:#}", program.name));
                match self.refuse(below, &mut messages) {
                    Ok(()) => Ok(Some((Limited::Refused, true))),
                    Err(error) => Err(error),
                }
            }
        };
        (messages, done)
    }

    /// Limits a program into its place.
    fn limited(
        &self,
        setup: &Setup,
        below: &Path,
        program: &Program,
        messages: &mut Messages,
    ) -> Result<(Limited, bool)> {
        let places = Places {
            program: Some(self.folders.result(below, "")),
            csv: Some(self.folders.result(below, REPORT)),
            ..Places::default()
        };
        places.make_folders()?;
        // A certificate never stands next to another version than its own.
        remove(&self.folders.result(below, CERTIFICATE))?;
        let refused = (Limited::Refused, true);
        in_own_dialect(setup, program, messages, refused, |setup, messages| {
            let limited = limit_one(&self.limit, setup, program, &places, messages)?;
            let options = setup.options_for(program);
            let called = program
                .open()
                .and_then(|input| pipeline::called_files(input, &setup.machine, &options));
            // Their own results may have other feeds than the files that it was certified with.
            for file in called.iter().flatten() {
                messages.note(format_args!(
                    "{}: it is certified with {} as that lies there; where that is changed too, \
                     limit both by --with-subprograms",
                    program.name,
                    file.display()
                ));
            }
            let leans = called.map_or(true, |called| !called.is_empty());
            let written = matches!(limited, Limited::Written { .. });
            Ok((limited, leans || !written))
        })
    }

    /// Puts down what was said of a program that was limited.
    fn put_down(&self, below: &Path, limited: Limited, messages: &mut Messages) -> Result<()> {
        if !matches!(limited, Limited::Written { .. }) {
            return self.refuse(below, messages);
        }
        write(
            &self.folders.result(below, CERTIFICATE),
            messages.said().as_bytes(),
        )?;
        remove(&self.folders.result(below, REFUSED))?;
        Ok(())
    }

    /// Takes away what was written of a program, and says in its place why it is not.
    fn refuse(&self, below: &Path, messages: &mut Messages) -> Result<()> {
        let written = self.folders.result(below, "");
        if remove(&written)? {
            messages.note(format_args!(
                "{} is removed: it was limited from an earlier version",
                written.display()
            ));
        }
        remove(&self.folders.result(below, CERTIFICATE))?;
        remove(&self.folders.result(below, REPORT))?;
        let refused = self.folders.result(below, REFUSED);
        if let Some(folder) = refused.parent() {
            fs::create_dir_all(folder)
                .with_context(|| format!("cannot make the folder {}", folder.display()))?;
        }
        write(&refused, messages.said().as_bytes())
    }

    /// A program is there no more: what was written of it stays, why it was refused does not.
    fn gone(&self, below: &Path) -> Result<()> {
        remove(&self.folders.result(below, REFUSED))?;
        let written = self.folders.result(below, "");
        if written.is_file() && !self.limit.quiet {
            self.terminal.note(format_args!(
                "{} is gone; {} stays",
                self.folders.from.join(below).display(),
                written.display()
            ));
        }
        Ok(())
    }
}

/// Writes a file, whole.
fn write(path: &Path, text: &[u8]) -> Result<()> {
    let mut spool = Target::new(path)?.spool()?;
    spool
        .write_all(text)
        .with_context(|| format!("cannot write {}", path.display()))?;
    spool.deliver()
}

/// Removes a file; says whether there was one.
fn remove(path: &Path) -> Result<bool> {
    match fs::remove_file(path) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
        Err(error) => bail!("cannot remove {}: {error}", path.display()),
    }
}
