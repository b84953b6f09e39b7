//! The binary from outside: exit codes, messages, and what is left on the disk.

mod closed_pipe;
mod colours;
mod advice;
mod baselines;
mod ci;
mod dialects;
mod drafts;
mod identify;
#[cfg(unix)]
mod interrupts;
mod levels;
#[cfg(unix)]
mod linuxcnc_filter;
mod machines;
mod many;
mod marks;
mod prices;
#[cfg(target_os = "linux")]
mod progress;
mod sets;
mod sizes;
#[cfg(unix)]
mod slicers;
mod verdicts;
mod verifies;
mod watches;
mod whole_drafts;
mod ways;

use std::fs::{self, File};
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

use crate::shop::{ended, gwatt};

/// Does not fit on the default machine; fits after `limit`.
const STEEP: &str = "G21 G90 G94 G17\nG0 X200 Y200 Z200\nG1 F100 X210\nM30\n";
const GENTLE: &str = "G21 G90 G94\nG1 F100 X10\nM30\n";

/// A folder with programs, and gwatt run in it.
struct Shop {
    folder: TempDir,
}

impl Shop {
    fn new() -> Self {
        let shop = Self {
            folder: tempfile::tempdir().unwrap(),
        };
        shop.put("steep.ngc", STEEP);
        shop.put("gentle.ngc", GENTLE);
        shop
    }

    fn path(&self) -> &Path {
        self.folder.path()
    }

    fn put(&self, name: &str, text: impl AsRef<[u8]>) {
        fs::write(self.path().join(name), text).unwrap();
    }

    fn get(&self, name: &str) -> String {
        fs::read_to_string(self.path().join(name)).unwrap()
    }

    fn files(&self) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(self.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    fn command(&self, arguments: &[&str]) -> Command {
        gwatt(self.path(), arguments.iter().copied())
    }

    /// Runs gwatt on the default machine, named so that no note is printed.
    fn run(&self, arguments: &[&str]) -> Ran {
        Ran::from(self.command(arguments).output().unwrap())
    }

    fn run_with_input(&self, arguments: &[&str], input: &str) -> Ran {
        let mut child = self
            .command(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        child
            .stdin
            .take()
            .unwrap()
            .write_all(input.as_bytes())
            .unwrap();
        Ran::from(child.wait_with_output().unwrap())
    }
}

/// What came of a run.
struct Ran {
    code: i32,
    stdout: String,
    stderr: String,
}

impl From<Output> for Ran {
    fn from(output: Output) -> Self {
        let (code, stdout, stderr) = ended(output);
        Self {
            code,
            stdout,
            stderr,
        }
    }
}

impl Ran {
    /// Asserts that the run refused, said so, and wrote nothing to stdout.
    #[track_caller]
    fn refused(&self, message: &str) {
        assert_eq!(self.code, 2, "{}", self.stderr);
        assert!(self.stderr.contains(message), "{}", self.stderr);
        assert_eq!(self.stdout, "");
    }
}

#[test]
fn usage_errors_exit_with_2() {
    let shop = Shop::new();
    shop.run(&[]).refused("Usage");
    shop.run(&["--bogus"]).refused("unexpected argument");
    shop.run(&["check"]).refused("PROGRAM");
    shop.run(&["limit", "steep.ngc", "--allow", "everything"])
        .refused("possible values: feed");
    shop.run(&["limit", "-", "--in-place"])
        .refused("cannot be changed in place");
    shop.run(&["limit", "steep.ngc", "--in-place", "-o", "x"])
        .refused("cannot be used with");
    shop.run(&["check", "steep.ngc", "--threads", "0"])
        .refused("--threads");
    shop.run(&["check", "-", "-"]).refused("only once");
    let options = ["check", "steep.ngc", "-m", "three-axis"];
    let with = |more: &[&'static str]| shop.run(&[&options, more].concat());
    with(&["--start", "Q1"]).refused("not an axis");
    with(&["--start", "A1"]).refused("no axis A");
    with(&["--dialect", "klingon"]).refused("no dialect klingon");
}

#[test]
fn help_and_version_are_no_errors() {
    let shop = Shop::new();
    for arguments in [
        &["--help"][..],
        &["--version"],
        &["limit", "--help"],
        &["machine", "show", "--help"],
        &["completions", "bash"],
        &["man"],
    ] {
        let ran = shop.run(arguments);
        assert_eq!(ran.code, 0, "{arguments:?}");
        assert!(ran.stdout.contains("gwatt"), "{arguments:?}");
    }
}

#[test]
fn every_command_has_examples() {
    let shop = Shop::new();
    for command in [
        "limit",
        "check",
        "report",
        "watch",
        "diff",
        "moves",
        "spindle",
        "excite",
        "identify",
        "power-fit",
    ] {
        let ran = shop.run(&[command, "--help"]);
        assert!(ran.stdout.contains("Examples:\n  gwatt"), "{command}");
    }
}

#[test]
fn the_worst_verdict_of_several_programs_wins_and_all_are_told() {
    let shop = Shop::new();
    shop.put("broken.ngc", "G1 X\n");
    let check = |programs: &[&'static str], threads| {
        let mut arguments = vec!["check", "-m", "three-axis", "--threads", threads];
        arguments.extend(programs);
        shop.run(&arguments)
    };
    assert_eq!(check(&["gentle.ngc"], "1").code, 0);
    assert_eq!(check(&["gentle.ngc", "steep.ngc"], "1").code, 1);
    let programs = ["steep.ngc", "broken.ngc", "gentle.ngc", "missing.ngc"];
    let one = check(&programs, "1");
    assert_eq!(one.code, 2);
    let heads: Vec<&str> = one
        .stdout
        .lines()
        .filter(|line| !line.starts_with(' '))
        .filter_map(|line| line.split(": ").next())
        .collect();
    assert_eq!(heads, [&programs[..], &["4 programs"]].concat());
    assert_eq!(check(&programs, "8").stdout, one.stdout);
}

#[test]
fn what_cannot_be_read_is_told() {
    let shop = Shop::new();
    fs::create_dir(shop.path().join("folder")).unwrap();
    for command in ["limit", "report", "moves"] {
        let run = |program| shop.run(&[command, program, "-m", "three-axis"]);
        run("missing.ngc").refused("missing.ngc: cannot read the program");
        run("folder").refused(match command {
            "moves" => "folder: cannot read the program",
            _ => "folder: no file below it is a program",
        });
    }
    let ran = shop.run(&["check", "gentle.ngc", "-m", "no-such-machine"]);
    ran.refused("no-such-machine");
}

#[test]
fn a_program_that_is_none_is_refused() {
    let shop = Shop::new();
    shop.put("empty.ngc", "");
    shop.put("binary.ngc", b"\x7fELF\x02\x01\x00\x00\xff\xfe\x00garbage");
    for program in ["empty.ngc", "binary.ngc"] {
        let ran = shop.run(&["limit", program, "-m", "three-axis"]);
        ran.refused(program);
    }
}

#[test]
fn a_refused_program_leaves_no_files() {
    let shop = Shop::new();
    shop.put("broken.ngc", "G1 X10 F100\nG1 X\n");
    let before = shop.files();
    let outputs = ["-o", "o.ngc", "--report", "r.csv", "--json", "j.json"];
    let arguments = [&["limit", "broken.ngc", "-m", "three-axis"], &outputs[..]].concat();
    shop.run(&arguments).refused("broken.ngc:2");
    let arguments = ["report", "broken.ngc", "-m", "three-axis", "--csv", "r.csv"];
    shop.run(&arguments).refused("broken.ngc:2");
    assert_eq!(shop.files(), before);
}

#[test]
fn what_limit_writes_fits() {
    let shop = Shop::new();
    let outputs = ["-o", "o.ngc", "--report", "r.csv", "--json", "j.json"];
    let limit = ["limit", "steep.ngc", "-m", "three-axis"];
    let ran = shop.run(&[&limit[..], &outputs].concat());
    assert_eq!((ran.code, ran.stdout.as_str()), (0, ""), "{}", ran.stderr);
    assert_eq!(
        shop.run(&["check", "steep.ngc", "-m", "three-axis"]).code,
        1
    );
    assert_eq!(shop.run(&["check", "o.ngc", "-m", "three-axis"]).code, 0);
    assert_eq!(shop.get("steep.ngc"), STEEP);
    assert!(shop.get("r.csv").starts_with("line,n_word,move,"));
    let json: serde_json::Value = serde_json::from_str(&shop.get("j.json")).unwrap();
    assert_eq!(json["certified"], true);
    assert_eq!(json["blocks"].as_array().unwrap().len(), 2);
    // The same bytes on standard output, also from standard input.
    assert_eq!(shop.run(&limit).stdout, shop.get("o.ngc"));
    let ran = shop.run_with_input(&["limit", "-", "-m", "three-axis"], STEEP);
    assert_eq!(ran.stdout, shop.get("o.ngc"));
}

#[test]
fn without_a_machine_the_default_is_named() {
    let shop = Shop::new();
    let ran = shop.run(&["check", "gentle.ngc"]);
    assert_eq!(ran.code, 0);
    let shown = "the built-in three-axis, with programs read as iso";
    assert!(ran.stderr.contains(shown), "{}", ran.stderr);
}

#[test]
fn the_input_is_never_overwritten() {
    let shop = Shop::new();
    fs::hard_link(shop.path().join("steep.ngc"), shop.path().join("alias.ngc")).unwrap();
    let onto = |option, path| shop.run(&["limit", "steep.ngc", "-m", "three-axis", option, path]);
    for path in ["steep.ngc", "./steep.ngc", "alias.ngc"] {
        for option in ["-o", "--report", "--json"] {
            onto(option, path).refused("is read by this run");
        }
    }
    let twice = ["limit", "steep.ngc", "-o", "x", "--report", "./x"];
    shop.run(&twice).refused("would be written twice");
    let both = ["limit", "steep.ngc", "--report", "-"];
    shop.run(&both).refused("only one result");
    assert_eq!(shop.get("steep.ngc"), STEEP);
}

#[test]
fn in_place_keeps_backups() {
    let shop = Shop::new();
    shop.put("steep.ngc.bak", "older");
    let limit = ["limit", "steep.ngc", "-m", "three-axis", "--in-place"];
    assert_eq!(shop.run(&limit).code, 0);
    assert_eq!(shop.get("steep.ngc.bak"), "older");
    assert_eq!(shop.get("steep.ngc.bak1"), STEEP);
    assert_ne!(shop.get("steep.ngc"), STEEP);
    // Nothing to change any more: nothing is written.
    let before = shop.files();
    assert_eq!(shop.run(&limit).code, 0);
    assert_eq!(shop.files(), before);
}

#[test]
fn a_dry_run_shows_the_edit_and_writes_nothing() {
    let shop = Shop::new();
    let before = shop.files();
    let ran = shop.run(&["limit", "steep.ngc", "-m", "three-axis", "--dry-run"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(
        ran.stdout
            .starts_with("--- a/steep.ngc\n+++ b/steep.ngc\n@@ -1,4 "),
        "{}",
        ran.stdout
    );
    assert!(ran.stdout.contains("\n-G0 X200 Y200 Z200\n"));
    assert_eq!(shop.files(), before);
    let ran = shop.run_with_input(&["limit", "-", "-m", "three-axis", "--dry-run"], STEEP);
    assert!(ran.stdout.contains("\n-G0 X200 Y200 Z200\n"));
}

#[test]
fn report_fails_only_when_asked_to() {
    let shop = Shop::new();
    let report = ["report", "steep.ngc", "-m", "three-axis"];
    let ran = shop.run(&report);
    assert_eq!(ran.code, 0);
    assert_eq!(ran.stdout.lines().count(), 3);
    assert_eq!(shop.run(&[&report[..], &["--fail"]].concat()).code, 1);
}

#[test]
fn formats_hold_every_program() {
    let shop = Shop::new();
    shop.put("broken.ngc", "G1 X\n");
    let check = |format| {
        let programs = ["gentle.ngc", "steep.ngc", "broken.ngc"];
        let options = ["check", "-m", "three-axis", "--format", format];
        let ran = shop.run(&[&options[..], &programs].concat());
        assert_eq!(ran.code, 2);
        ran.stdout
    };
    let json: serde_json::Value = serde_json::from_str(&check("json")).unwrap();
    assert_eq!(json[0]["fits"], true);
    assert_eq!(json[1]["unfit"][0]["line"], 2);
    assert_eq!(json[2]["diagnostics"][0]["severity"], "error");
    let sarif: serde_json::Value = serde_json::from_str(&check("sarif")).unwrap();
    assert_eq!(sarif["version"], "2.1.0");
    assert_eq!(sarif["runs"][0]["results"][0]["ruleId"], "peak-power");
    let junit = check("junit");
    assert!(junit.contains(r#"tests="3" skipped="0" failures="1" errors="1""#));
    // Rules that `gwatt explain` knows, as in SARIF.
    assert!(junit.contains(r#"type="peak-power""#), "{junit}");
    assert!(!junit.contains(r#"type="refused""#), "{junit}");
    let github = check("github");
    assert!(github.contains("::error file=steep.ngc,line=2,title=peak-power::"));
    assert!(github.ends_with("::notice title=gwatt::1 fit, 1 do not fit, 1 refused\n"));
}

#[test]
fn diff_fails_where_something_ceases_to_fit() {
    let shop = Shop::new();
    let strong = fs::read_to_string(
        Path::new(env!("CARGO_MANIFEST_DIR")).join("machine-configs/three-axis.toml"),
    )
    .unwrap()
    .replace("peak_power_w = 4000", "peak_power_w = 40000");
    shop.put("strong.toml", strong);
    let diff = |from, to| {
        let ran = shop.run(&[
            "diff",
            "steep.ngc",
            "gentle.ngc",
            "--from",
            from,
            "--to",
            to,
        ]);
        (ran.code, ran.stdout)
    };
    let (code, text) = diff("three-axis", "strong.toml");
    assert_eq!(code, 0, "{text}");
    assert!(text.contains("steep.ngc: line 2 begins to fit"), "{text}");
    let (code, text) = diff("strong.toml", "three-axis");
    assert_eq!(code, 1, "{text}");
    assert!(text.contains("steep.ngc: line 2 ceases to fit"), "{text}");
}

#[test]
fn moves_are_lines_of_json() {
    let shop = Shop::new();
    shop.put(
        "arc.ngc",
        "G90 G17 G21\nG1 X10 F600\nG3 X0 Y10 I-10 J0\nG4 P1\nG2 X0 Y10 I5 J0\n",
    );
    let ran = shop.run(&["moves", "arc.ngc", "-m", "three-axis"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let moves: Vec<serde_json::Value> = ran
        .stdout
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    assert_eq!(moves.len(), 4);
    assert_eq!(moves[1]["center"], serde_json::json!({"X": 0, "Y": 0}));
    assert_eq!(moves[1]["plane"], "XY");
    // Counter-clockwise is positive, clockwise negative.
    assert_eq!(moves[1]["turns"], 0.25);
    assert_eq!(moves[3]["turns"], -1.0);
    assert_eq!(moves[2]["feed_mm_min"], serde_json::Value::Null);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told() {
    let shop = Shop::new();
    for arguments in [
        &["limit", "steep.ngc"][..],
        &["check", "steep.ngc"],
        &["report", "steep.ngc"],
        &["moves", "steep.ngc"],
        &["machine", "list"],
    ] {
        let full = File::options().write(true).open("/dev/full").unwrap();
        let output = shop.command(arguments).stdout(full).output().unwrap();
        Ran::from(output).refused("cannot write to standard output");
    }
    let ran = shop.run(&["limit", "steep.ngc", "-o", "/dev/full"]);
    ran.refused("cannot write /dev/full");
}

#[cfg(target_os = "linux")]
#[test]
fn an_input_without_end_is_refused() {
    let shop = Shop::new();
    let ran = shop.run(&["limit", "/dev/zero"]);
    ran.refused("line 1");
    let ran = shop.run(&["limit", "--dry-run", "/dev/zero"]);
    ran.refused("line 1");
}

#[cfg(target_os = "linux")]
#[test]
fn only_files_are_changed_in_place() {
    let shop = Shop::new();
    shop.run(&["limit", "--in-place", "/dev/null"])
        .refused("only a file can be changed in place");
}

#[test]
fn a_folder_of_subprograms_must_be_there() {
    let shop = Shop::new();
    for folder in ["none", "gentle.ngc"] {
        shop.run(&["check", "gentle.ngc", "--sub-path", folder])
            .refused("there is no such folder");
    }
}

/// Each example belongs to a machine, and can be read on it.
#[test]
fn examples_can_be_read() {
    let shop = Shop::new();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    for (example, machine) in [
        ("simultaneous-start.ngc", "three-axis"),
        ("inch-plate.ngc", "three-axis"),
        ("pocket.ngc", "vmc"),
        ("indexed-five-axis.ngc", "five-axis"),
        ("lathe-pass.ngc", "lathe"),
        ("printer-outline.gcode", "printer"),
    ] {
        let path = folder.join(example);
        let ran = shop.run(&["limit", path.to_str().unwrap(), "-m", machine]);
        assert_eq!(ran.code, 0, "{example}: {}", ran.stderr);
    }
}
