//! LinuxCNC's stand-alone interpreter, where it is installed.

use std::fmt::Write as _;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::time::{Duration, Instant};

use super::canon;
use super::event::Event;

/// What `rs274` made of a program.
pub enum Run {
    Events(Vec<Event>),
    /// The same of a program without an end, or of one where something is not
    /// closed: it says no more.
    Open(Vec<Event>),
    /// It stopped with this message.
    Failed(String),
    /// It printed a call that says too little to compare.
    Unclear(String),
}

/// It failed and said nothing.
const SILENT: &str = "without a word";

/// A program that never ends is given up after this.
const PATIENCE: Duration = Duration::from_mins(1);
const PRINTED_MAX: u64 = 1 << 28;

/// A message that does not end a program early.
const NO_END: &str = "File ended with no percent sign";

pub fn installed() -> bool {
    let mut command = Command::new("rs274");
    command.arg("-?").stdin(Stdio::null());
    let quiet = command.stdout(Stdio::null()).stderr(Stdio::null());
    quiet.status().is_ok()
}

/// A tool table with its lengths in inches: `rs274` takes them to be, and gwatt
/// takes them in the unit of the machine.
fn in_inches(table: &str) -> String {
    let mut lines = String::new();
    for line in table.lines() {
        let (words, comment) = line.split_once(';').unwrap_or((line, ""));
        for word in words.split_whitespace() {
            let length = word
                .strip_prefix(['X', 'Y', 'Z', 'U', 'V', 'W', 'D'])
                .and_then(|number| number.parse::<f64>().ok());
            let _ = match length {
                Some(mm) => write!(lines, "{}{} ", &word[..1], mm / 25.4),
                None => write!(lines, "{word} "),
            };
        }
        let _ = writeln!(lines, ";{comment}");
    }
    lines
}

/// Runs a program, one at a time. Where `rs274` ends with neither a result nor a
/// message it has not judged the program, and runs again.
pub fn run(program: &Path, subs: &[PathBuf], table: &Path) -> Run {
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    let _one = ONE_AT_A_TIME.lock();
    match attempt(program, subs, table) {
        Run::Failed(message) if message == SILENT => attempt(program, subs, table),
        found => found,
    }
}

/// `table` is copied, since `rs274` may write it.
fn attempt(program: &Path, subs: &[PathBuf], table: &Path) -> Run {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let table = fs::read_to_string(table).expect("a tool table");
    fs::write(at("tool.tbl"), in_inches(&table)).expect("a tool table");
    File::create(at("par.var")).expect("a file");
    let paths: Vec<String> = subs.iter().map(|path| path.display().to_string()).collect();
    let ini = format!(
        "[RS274NGC]\nSUBROUTINE_PATH = {}\nPARAMETER_FILE = par.var\n[DISPLAY]\nPROGRAM_PREFIX = {}\n",
        paths.join(":"),
        paths.first().map_or("", String::as_str)
    );
    fs::write(at("lab.ini"), ini).expect("a file");
    let mut child = Command::new("rs274")
        .args([
            "-g", "-n", "2", "-i", "lab.ini", "-t", "tool.tbl", "-v", "par.var",
        ])
        .arg(program)
        .current_dir(&folder)
        // Its map of the tool table lies in the home folder.
        .env("HOME", folder.path())
        .stdin(Stdio::null())
        .stdout(File::create(at("out")).expect("a file"))
        .stderr(File::create(at("err")).expect("a file"))
        .spawn()
        .expect("rs274");
    let begin = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().expect("a process") {
            break Some(status);
        }
        let printed = fs::metadata(at("out")).map_or(0, |data| data.len());
        if begin.elapsed() > PATIENCE || printed > PRINTED_MAX {
            let _ = child.kill();
            let _ = child.wait();
            break None;
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    let Some(status) = status else {
        return Run::Failed("it does not end".to_owned());
    };
    let read = |name: &str| {
        let bytes = fs::read(at(name)).expect("a file");
        String::from_utf8_lossy(&bytes).into_owned()
    };
    let said = read("err");
    let message = said
        .lines()
        .find(|line| !line.trim().is_empty() && *line != "executing");
    if !status.success() && !said.contains(NO_END) {
        return Run::Failed(message.unwrap_or(SILENT).to_owned());
    }
    match canon::events(&read("out")) {
        Ok(events) if status.success() => Run::Events(events),
        Ok(events) => Run::Open(events),
        Err(call) => Run::Unclear(call),
    }
}
