//! The binary from outside: exit codes, messages, and what is left on the disk.

use std::fs::{self, File};
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

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
        let mut command = Command::new(env!("CARGO_BIN_EXE_gwatt"));
        command
            .args(arguments)
            .current_dir(self.path())
            .stdin(Stdio::null());
        command
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
        Self {
            code: output.status.code().unwrap(),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
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
    assert_eq!(heads, programs);
    assert_eq!(check(&programs, "8").stdout, one.stdout);
}

#[test]
fn what_cannot_be_read_is_told() {
    let shop = Shop::new();
    fs::create_dir(shop.path().join("folder")).unwrap();
    for command in ["limit", "report", "moves"] {
        let run = |program| shop.run(&[command, program, "-m", "three-axis"]);
        run("missing.ngc").refused("missing.ngc: cannot read the program");
        run("folder").refused("folder: cannot read the program");
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
    let told = "the built-in three-axis, with programs read as iso";
    assert!(ran.stderr.contains(told), "{}", ran.stderr);
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

#[cfg(unix)]
#[test]
fn a_closed_pipe_ends_quietly() {
    let shop = Shop::new();
    for arguments in [
        &["limit", "steep.ngc"][..],
        &["check", "gentle.ngc"],
        &["report", "steep.ngc"],
        &["machine", "schema"],
    ] {
        let arguments = [&["--color", "never"], arguments].concat();
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let ran = Ran::from(shop.command(&arguments).stdout(writer).output().unwrap());
        assert_eq!(ran.code, 0, "{}", ran.stderr);
        assert!(!ran.stderr.contains("cannot write"), "{}", ran.stderr);
    }
}

#[test]
fn machines_are_listed_shown_and_checked() {
    let shop = Shop::new();
    let list = shop.run(&["machine", "list"]).stdout;
    assert!(list.starts_with("* three-axis "), "{list}");
    let profiles = list.split_once("Controller profiles").unwrap().1;
    for profile in gwatt::machine::builtin::controllers() {
        assert!(profiles.contains(&format!("  {} ", profile.name)), "{list}");
        let text = shop.run(&["machine", "show", profile.name]).stdout;
        assert_eq!(text, profile.text);
    }
    for line in list.lines().take_while(|line| !line.is_empty()) {
        let name = line
            .trim_start_matches(['*', ' '])
            .split(' ')
            .next()
            .unwrap();
        let text = shop.run(&["machine", "show", name]).stdout;
        shop.put("machine.toml", text);
        let ran = shop.run(&["machine", "check", "machine.toml"]);
        assert_eq!(ran.code, 0, "{name}: {}", ran.stderr);
    }
    shop.put("wrong.toml", "schema = 1\nname = \"x\"\nspeed = 5\n");
    shop.run(&["machine", "check", "wrong.toml"])
        .refused("wrong.toml:3");
    shop.run(&["machine", "show", "none"])
        .refused("no built-in machine");
}

#[test]
fn tool_tables_and_parameter_files() {
    let shop = Shop::new();
    shop.put("offset.ngc", "G43 H2\nG55 G0 X0 Z0\n");
    shop.put("tools.tbl", "T2 P1 Z12.5 ;mill\n");
    shop.put("kept.var", "5241\t30.000000\n5243\t1.000000\n");
    let options = [
        "-m",
        "three-axis",
        "--tool-table",
        "tools.tbl",
        "--parameters",
        "kept.var",
    ];
    let ran = shop.run(&[&["moves", "offset.ngc"][..], &options].concat());
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(
        ran.stdout.contains(r#""end":{"X":30,"Y":0,"Z":13.5"#),
        "{}",
        ran.stdout
    );
    assert_eq!(ran.stderr, "");
    let wrong = [
        ("tools.tbl", "T2 Zfoo\n", "tools.tbl:1:4"),
        ("tools.tbl", "T3 Z1\n", "tool 2 is not in the tool table"),
        ("kept.var", "5221\n", "kept.var:1:1"),
    ];
    for (name, text, message) in wrong {
        let before = shop.get(name);
        shop.put(name, text);
        shop.run(&[&["moves", "offset.ngc"][..], &options].concat())
            .refused(message);
        shop.put(name, before);
    }
    shop.run(&["moves", "offset.ngc", "--tool-table", "none.tbl"])
        .refused("cannot read none.tbl");
}

/// An axis of 50 kg that goes to and fro, as CSV.
fn axis_recording() -> String {
    use std::fmt::Write as _;
    let mut text = "time_s,force_n,position_m\n".to_owned();
    for k in 0..2000 {
        let t = f64::from(k) * 1e-3;
        let (slow, fast) = (10.0, 31.0);
        let x = 0.02 * libm::sin(slow * t) + 0.004 * libm::sin(fast * t);
        let v = 0.02 * slow * libm::cos(slow * t) + 0.004 * fast * libm::cos(fast * t);
        let a =
            -0.02 * slow * slow * libm::sin(slow * t) - 0.004 * fast * fast * libm::sin(fast * t);
        let force = 50.0 * a + 100.0 * v + 20.0 * v.signum();
        writeln!(text, "{t:.3},{force},{x}").unwrap();
    }
    text
}

#[test]
fn what_is_identified_goes_into_json_and_into_the_machine_file() {
    let shop = Shop::new();
    shop.put("x.csv", axis_recording());
    let machine = shop.run(&["machine", "show", "vmc"]).stdout;
    shop.put("mill.toml", &machine);
    let ran = shop.run(&[
        "identify",
        "x.csv",
        "--axis",
        "x",
        "--json",
        "x.json",
        "--toml",
        "x.toml",
        "--into",
        "mill.toml",
    ]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(ran.stdout.contains("verdict: good"), "{}", ran.stdout);
    let json: serde_json::Value = serde_json::from_str(&shop.get("x.json")).unwrap();
    for (key, truth) in [
        ("mass_kg", 50.0),
        ("viscous_n_s_m", 100.0),
        ("coulomb_n", 20.0),
    ] {
        let value = json[key].as_f64().unwrap();
        assert!((value / truth - 1.0).abs() < 0.02, "{key} {value}");
        assert!(json[format!("{key}_std")].is_number());
    }
    for key in ["offset_n", "rel_error"] {
        assert!(json[key].is_number(), "{key}");
    }
    assert!(json["zeros"].as_array().unwrap().is_empty());
    assert_eq!(shop.get("mill.toml.bak"), machine);
    let merged = shop.get("mill.toml");
    assert_ne!(merged, machine);
    let comments = |text: &str| text.matches('#').count();
    assert_eq!(comments(&merged), comments(&machine));
    assert_eq!(shop.run(&["machine", "check", "mill.toml"]).code, 0);
    assert!(shop.get("x.toml").starts_with("[axes.X]\nmass_kg = "));
}

#[test]
fn what_cannot_be_identified_leaves_nothing_behind() {
    let shop = Shop::new();
    shop.put("x.csv", axis_recording().replace("force_n", "force"));
    shop.put("good.csv", axis_recording());
    let machine = shop.run(&["machine", "show", "vmc"]).stdout;
    shop.put("mill.toml", &machine);
    let before = shop.files();
    let run = |more: &[&'static str]| shop.run(&[&["identify"], more].concat());
    run(&["x.csv", "--axis", "X", "--json", "x.json"]).refused("unit of column force");
    run(&["none.csv", "--axis", "X"]).refused("cannot read the recording");
    run(&["good.csv", "--axis", "Q"]).refused("is no axis");
    run(&[
        "good.csv",
        "--axis",
        "B",
        "--into",
        "mill.toml",
        "--json",
        "x.json",
    ])
    .refused("no axis B");
    run(&["good.csv", "--axis", "X", "--json", "good.csv"]).refused("is read by this run");
    shop.run(&["power-fit", "good.csv"])
        .refused("no column velocity_mm_s");
    shop.run(&["excite", "--amplitude", "0"])
        .refused("not positive");
    shop.run(&["excite", "--amplitude", "1", "--order", "40"])
        .refused("from 3 to 20");
    shop.run(&[
        "excite",
        "--amplitude",
        "1",
        "--shape",
        "log-sweep",
        "--to-hz",
        "900",
    ])
    .refused("cannot be made");
    shop.run(&["excite", "--amplitude", "1", "--stroke-deg", "1"])
        .refused("--inertia-kg-m2");
    assert_eq!(shop.files(), before);
    assert_eq!(shop.get("mill.toml"), machine);
}

#[test]
fn an_excitation_warns_where_the_axis_would_leave_its_stroke() {
    let shop = Shop::new();
    let common = [
        "excite",
        "--amplitude",
        "50",
        "--name",
        "force_n",
        "--mass-kg",
        "90",
    ];
    let with = |more: &[&'static str]| shop.run(&[&common[..], more].concat());
    let ran = with(&["--stroke-mm", "1", "--speed-mm-min", "100"]);
    assert_eq!(ran.code, 0);
    assert!(ran.stderr.contains("would travel"), "{}", ran.stderr);
    assert!(ran.stderr.contains("would reach"), "{}", ran.stderr);
    assert_eq!(ran.stdout.lines().count(), 4096);
    let ran = with(&["--stroke-mm", "1000", "--speed-mm-min", "100000"]);
    assert!(!ran.stderr.contains("warning"), "{}", ran.stderr);
}
