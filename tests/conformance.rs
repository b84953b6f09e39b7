//! Programs against LinuxCNC's own interpreter, `rs274`.
//!
//! The programs in `tests/conformance/` are compared with what `rs274` printed
//! once (`*.expected`), and where it is installed against what it prints now.
//! `GWATT_CONFORMANCE=dir:dir` adds programs in other folders, with
//! `GWATT_CONFORMANCE_SUBS=dir:dir` for their subroutines and
//! `GWATT_CONFORMANCE_TABLE` as tool table, in mm; `GWATT_CONFORMANCE_REPORT` names a
//! file that gets a line for each program. `GWATT_CONFORMANCE_WRITE=1` writes the
//! `.expected` files again.

mod canon;
mod event;
mod ours;
mod rs274;

use std::collections::BTreeMap;
use std::env;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use event::{compare, parse, text};
use gwatt::machine::Machine;
use rs274::Run;

/// What the comparison of a program came to.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
enum Verdict {
    Equal,
    /// Refused by both.
    BothRefuse,
    /// It moves nothing, which gwatt says.
    Nothing,
    /// By gwatt alone: the rule.
    Refused(String),
    /// `rs274` refuses what gwatt runs.
    Fails,
    /// The calls of `rs274` say too little.
    Unclear(String),
    Differs,
}

fn own() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/conformance")
}

fn folders(variable: &str) -> Vec<PathBuf> {
    let given = env::var_os(variable).unwrap_or_default();
    env::split_paths(&given)
        .filter(|path| !path.as_os_str().is_empty())
        .collect()
}

/// Programs in a folder and those below it, in order.
fn programs(folder: &Path, into: &mut Vec<PathBuf>) {
    const ENDINGS: [&str; 3] = ["ngc", "nc", "tap"];
    let Ok(entries) = fs::read_dir(folder) else {
        panic!("{} cannot be read", folder.display());
    };
    let mut paths: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            programs(&path, into);
        } else if path.extension().is_some_and(|ending| {
            ENDINGS
                .iter()
                .any(|known| ending.eq_ignore_ascii_case(known))
        }) {
            into.push(path);
        }
    }
}

/// Whether a block changes the tool and takes its length. `rs274` alone, without
/// a machine, then goes on from a place that leaves the length out.
fn changes_with_length(program: &Path) -> bool {
    let text = fs::read(program).unwrap_or_default();
    let text = String::from_utf8_lossy(&text).to_ascii_uppercase();
    text.lines().any(|line| {
        let words = line.split(['(', ';']).next().unwrap_or_default();
        let words = words.replace(' ', "").replace("M06", "M6");
        words.contains("M6") && words.contains("G43")
    })
}

fn judge(
    program: &Path,
    theirs: &Run,
    subs: &[PathBuf],
    table: Option<&Path>,
    machine: &Machine,
) -> (Verdict, String) {
    let ours = ours::run(program, subs, table, machine);
    match (theirs, ours) {
        (Run::Failed(message), Err((rule, ours))) => {
            (Verdict::BothRefuse, format!("{message} | {rule} {ours}"))
        }
        (Run::Failed(message), Ok(_)) => (Verdict::Fails, message.clone()),
        (Run::Open(_), Err((rule, message))) if rule == "o-word" => (Verdict::BothRefuse, message),
        (Run::Events(theirs) | Run::Open(theirs), Err((rule, message)))
            if theirs.is_empty() && rule == "no-program" =>
        {
            (Verdict::Nothing, message)
        }
        (_, Err((rule, message))) => (Verdict::Refused(rule), message),
        (Run::Unclear(call), Ok(_)) => (Verdict::Unclear(call.clone()), String::new()),
        (Run::Events(theirs) | Run::Open(theirs), Ok(ours)) => match compare(theirs, &ours) {
            Ok(()) => (Verdict::Equal, format!("{} moves", ours.len())),
            Err(_) if table.is_some() && changes_with_length(program) => {
                (Verdict::Unclear("M6 with G43".to_owned()), String::new())
            }
            Err(difference) => (Verdict::Differs, difference),
        },
    }
}

/// How many programs came to what, and a line for each that differs.
fn summary(verdicts: &[(PathBuf, Verdict, String)]) -> (String, String) {
    let mut counts: BTreeMap<&Verdict, usize> = BTreeMap::new();
    let mut differ = String::new();
    for (path, verdict, message) in verdicts {
        *counts.entry(verdict).or_default() += 1;
        if *verdict == Verdict::Differs {
            let _ = writeln!(differ, "{}: {message}", path.display());
        }
    }
    let mut out = String::new();
    for (verdict, count) in counts {
        let _ = writeln!(out, "{count:5} {verdict:?}");
    }
    (out, differ)
}

#[test]
fn own_programs_as_rs274_reads_them() {
    assert!(own_programs(&own(), false) >= 25);
}

/// The same with a tool table of lengths, radii and orientations, mm.
#[test]
fn own_programs_with_tools_as_rs274_reads_them() {
    assert!(own_programs(&own().join("tools"), true) >= 3);
}

/// Compares the programs of a folder; gives how many there are.
fn own_programs(folder: &Path, tools: bool) -> usize {
    let installed = rs274::installed();
    if !installed {
        println!("rs274 is not installed: only what it printed once is compared");
    }
    let write = installed && env::var_os("GWATT_CONFORMANCE_WRITE").is_some();
    let subs = [folder.join("subs")];
    let machine = ours::machine();
    let mut paths = Vec::new();
    programs(folder, &mut paths);
    paths.retain(|path| path.parent() == Some(folder));
    let count = paths.len();
    let table = folder.join("tool.tbl");
    let given = tools.then_some(table.as_path());
    let mut verdicts = Vec::new();
    for path in paths {
        let kept = path.with_extension("expected");
        let now = installed.then(|| rs274::run(&path, &subs, &table));
        if let Some(now) = now {
            if write {
                let lines = match &now {
                    Run::Events(events) => text(events),
                    Run::Open(events) => format!("open\n{}", text(events)),
                    Run::Failed(_) => "error\n".to_owned(),
                    Run::Unclear(call) => panic!("{}: {call}", path.display()),
                };
                fs::write(&kept, lines).expect("a file");
            }
            let (verdict, message) = judge(&path, &now, &subs, given, &machine);
            verdicts.push((path.clone(), verdict, message));
        }
        let lines = fs::read_to_string(&kept).expect("what rs274 printed");
        let then = match lines.as_str() {
            "error\n" => Run::Failed(String::new()),
            lines => match lines.strip_prefix("open\n") {
                Some(lines) => Run::Open(parse(lines)),
                None => Run::Events(parse(lines)),
            },
        };
        let (verdict, message) = judge(&path, &then, &subs, given, &machine);
        verdicts.push((path, verdict, message));
    }
    let (counts, _) = summary(&verdicts);
    println!("{counts}");
    verdicts.retain(|(_, verdict, _)| !matches!(verdict, Verdict::Equal | Verdict::BothRefuse));
    let mut wrong = String::new();
    for (path, verdict, message) in &verdicts {
        let _ = writeln!(wrong, "{}: {verdict:?} {message}", path.display());
    }
    assert!(verdicts.is_empty(), "{wrong}");
    count
}

#[test]
fn other_programs_as_rs274_reads_them() {
    let given = folders("GWATT_CONFORMANCE");
    if given.is_empty() || !rs274::installed() {
        crate::evidence::cannot_run("it needs rs274, and folders of programs in GWATT_CONFORMANCE");
        return;
    }
    crate::evidence::runs();
    let given_table = env::var_os("GWATT_CONFORMANCE_TABLE").map(PathBuf::from);
    let table = given_table
        .clone()
        .unwrap_or_else(|| own().join("tool.tbl"));
    let machine = ours::machine();
    let mut paths = Vec::new();
    for folder in &given {
        let folder = folder.canonicalize().expect("a folder");
        programs(&folder, &mut paths);
    }
    // Links lead to the same file by several ways.
    let mut known = std::collections::HashSet::new();
    paths.retain(|path| known.insert(path.canonicalize().expect("a path")));
    let mut verdicts = Vec::new();
    for path in paths {
        let mut subs: Vec<PathBuf> = path.parent().map(Path::to_owned).into_iter().collect();
        subs.extend(folders("GWATT_CONFORMANCE_SUBS"));
        let theirs = rs274::run(&path, &subs, &table);
        let (verdict, message) = judge(&path, &theirs, &subs, given_table.as_deref(), &machine);
        verdicts.push((path, verdict, message));
    }
    if let Some(report) = env::var_os("GWATT_CONFORMANCE_REPORT") {
        let mut lines = String::new();
        for (path, verdict, message) in &verdicts {
            let _ = writeln!(lines, "{verdict:?}\t{}\t{message}", path.display());
        }
        fs::write(report, lines).expect("a file");
    }
    let (counts, differ) = summary(&verdicts);
    println!("{} programs\n{counts}", verdicts.len());
    assert!(differ.is_empty(), "\n{counts}\n{differ}");
}
