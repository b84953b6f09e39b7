//! Evidence from outside the project: programs and recordings of others, LinuxCNC, a browser.
//! Where it is not there a check says so; `.ci/run` lists at its end what ran and what could not.

use std::fs::File;
use std::io::Write as _;
use std::path::PathBuf;
use std::thread;

use crate::layers::root;

/// The check that calls this has what it needs.
pub(crate) fn runs() {
    note("ran", "");
}

/// The check that calls this cannot run.
pub(crate) fn cannot_run(why: &str) {
    println!("cannot run: {why}");
    note("missing", why);
}

/// Data of others next to the repository, if `what` stands there.
pub(crate) fn shared(path: &str, what: &str) -> Option<PathBuf> {
    let found = [root().join("../shared"), root().join("../../shared")]
        .map(|folder| folder.join(path))
        .into_iter()
        .find(|path| path.exists());
    match found {
        Some(_) => runs(),
        None => cannot_run(&format!("{what} are not there")),
    }
    found
}

/// A line in the file that `GWATT_EVIDENCE` names: the check and why.
fn note(word: &str, why: &str) {
    let Some(path) = std::env::var_os("GWATT_EVIDENCE") else {
        return;
    };
    let current = thread::current();
    let check = current.name().unwrap_or("a check");
    let separator = if why.is_empty() { "" } else { ": " };
    let file = File::options().append(true).create(true).open(path);
    // In one piece: other checks write at the same time.
    let line = format!("{word} {check}{separator}{why}\n");
    let written = file.and_then(|mut file| file.write_all(line.as_bytes()));
    written.expect("a file for evidence");
}
