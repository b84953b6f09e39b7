//! `gwatt spindle`.

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

use gwatt::machine::Machine;
use gwatt::plan::SpindleDrive;
use tempfile::TempDir;

use super::near;
use crate::shop::{ended, gwatt};

/// A machine whose spindle reaches 3000/min in 1 s.
const MACHINE: &str = r#"schema = 1
name = "test"
controller = "iso"

[converter]
peak_power_w = 9000

[axes.X]
rapid_mm_min = 36000
accel_mm_s2 = 6000
mass_kg = 900

[spindle]
inertia_kg_m2 = 0.1
friction_nm = 1
max_rpm = 3000
base_rpm = 1000
accel_time_s = 1
jerk_time_s = 0.05
"#;

struct Bench {
    folder: TempDir,
}

impl Bench {
    fn new() -> Self {
        let bench = Self {
            folder: tempfile::tempdir().unwrap(),
        };
        bench.put("m.toml", MACHINE);
        bench
    }

    fn path(&self, name: &str) -> std::path::PathBuf {
        self.folder.path().join(name)
    }

    fn put(&self, name: &str, text: impl AsRef<[u8]>) {
        fs::write(self.path(name), text).unwrap();
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let arguments = [&["spindle"], arguments].concat();
        gwatt(self.folder.path(), arguments)
    }

    /// Runs a schedule: exit code, standard output and error.
    fn run(&self, schedule: &str, more: &[&str]) -> (i32, String, String) {
        self.put("s.csv", schedule);
        let arguments = [&["s.csv", "-m", "m.toml"], more].concat();
        ended(self.command(&arguments).output().unwrap())
    }

    /// Asserts that a schedule is refused, and leaves no file; gives why.
    fn refused(&self, schedule: &str) -> String {
        let (code, out, err) = self.run(schedule, &["-o", "out.csv", "--svg", "out.svg"]);
        assert_eq!((code, out.as_str()), (2, ""), "{err}");
        assert!(!Path::exists(&self.path("out.csv")) && !Path::exists(&self.path("out.svg")));
        err
    }
}

fn numbers(csv: &str) -> Vec<Vec<f64>> {
    let row = |line: &str| line.split(',').map(|f| f.parse().unwrap()).collect();
    csv.lines().skip(1).map(row).collect()
}

const SCHEDULE: &str = "time_s,target_rpm,accel_rpm_s,jerk_rpm_s2,power_w,period_ms\n\
                        0,2500\n0.4,800,3000\n1.5,-2500,,40000\n3.2,3000,,,4000,2\n";

#[test]
fn every_period_is_a_row_inside_all_limits() {
    let bench = Bench::new();
    let (code, csv, err) = bench.run(SCHEDULE, &[]);
    assert_eq!(code, 0, "{err}");
    assert!(csv.starts_with(
        "time_s,speed_rpm,accel_rpm_s,jerk_rpm_s2,torque_nm,power_w,target_rpm\r\n0,0,0,0,0,0,2500\r\n"
    ));
    let rows = numbers(&csv);
    let (machine, _) = Machine::load(bench.path("m.toml").to_str().unwrap()).unwrap();
    let drive = SpindleDrive::new(machine.spindle.as_ref().unwrap()).unwrap();
    let limits = drive.limits();
    for (before, now) in rows.iter().zip(rows.iter().skip(1)) {
        let [t, v, a, j, _, w, target] = now[..] else {
            panic!("{now:?}");
        };
        let step = if t > 3.2 + 1e-9 { 2e-3 } else { 1e-3 };
        near(t - before[0], step);
        assert!(a.abs() <= limits.up(v * a.signum()), "{now:?}");
        assert!(j.abs() <= limits.jerk.largest(), "{now:?}");
        assert!((a - before[2] - j * step).abs() < 1e-6);
        if target == -2500.0 {
            assert!(j.abs() <= 40_000.0);
        }
        if target == 3000.0 {
            assert!(w <= 4000.0 * (1.0 + 1e-9), "{now:?}");
        }
    }
    let last = rows.last().unwrap();
    assert_eq!((last[1], last[2]), (3000.0, 0.0));
    let (_, again, _) = bench.run(SCHEDULE, &[]);
    assert_eq!(again, csv, "the same input gives the same bytes");
}

#[test]
fn files_appear_whole() {
    let bench = Bench::new();
    let (code, out, err) = bench.run(SCHEDULE, &["-o", "run.csv", "--svg", "run.svg"]);
    assert_eq!((code, out.as_str()), (0, ""), "{err}");
    assert!(err.contains("line 2  0 → 2500 1/min not reached"), "{err}");
    assert!(err.contains("→ 3000 1/min in "), "{err}");
    let svg = fs::read_to_string(bench.path("run.svg")).unwrap();
    assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
    assert_eq!(
        svg.matches("<polyline").count(),
        6,
        "five panels and the target"
    );
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
    let (_, csv, _) = bench.run(SCHEDULE, &[]);
    assert_eq!(fs::read_to_string(bench.path("run.csv")).unwrap(), csv);
    let (code, _, err) = bench.run(SCHEDULE, &["-o", "x", "--svg", "x"]);
    assert_eq!(code, 2, "{err}");
    let (code, _, err) = bench.run(SCHEDULE, &["-o", "s.csv"]);
    assert!(code == 2 && err.contains("is read by this run"), "{err}");
    let (code, _, err) = bench.run(SCHEDULE, &["--svg", "-"]);
    assert!(code == 2 && err.contains("standard output"), "{err}");
}

#[test]
fn a_schedule_may_come_without_a_header_and_from_a_pipe() {
    let bench = Bench::new();
    let (_, with, _) = bench.run(
        "target;time\n1000;0\n\n# back\n0;0.5\n",
        &["--period-ms", "4"],
    );
    let mut child = bench
        .command(&["-", "-m", "m.toml", "--period-ms", "4"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut stdin = child.stdin.take().unwrap();
    stdin.write_all(b"0,1000\r\n\"0.5\",0\r\n").unwrap();
    drop(stdin);
    let (code, without, err) = ended(child.wait_with_output().unwrap());
    assert_eq!(code, 0, "{err}");
    assert_eq!(with, without);
    assert_eq!(numbers(&with)[1][0], 0.004);
}

#[test]
fn mistakes_are_shown_with_their_place() {
    let bench = Bench::new();
    let head = "time_s,target_rpm,power_w\n";
    for (schedule, message, place, help) in [
        (
            "",
            "the schedule has no rows",
            "s.csv\n",
            "a line `time_s,target_rpm`",
        ),
        (
            "time_s,target_rpm,foo\n",
            "unknown column `foo`",
            ":1:19",
            "columns are time_s",
        ),
        (
            "time_s,rpm,rpm\n",
            "column `rpm` is there twice",
            ":1:12",
            "keep one",
        ),
        (
            "time_s,accel_rpm_s\n",
            "there is no column `target_rpm`",
            ":1:1",
            "",
        ),
        (&format!("{head}x,1\n"), "`x` is not a number", ":2:1", ""),
        (
            &format!("{head}0,nan\n"),
            "`nan` is not a number",
            ":2:3",
            "",
        ),
        (&format!("{head}0\n"), "`target_rpm` is missing", ":2:2", ""),
        (
            &format!("{head}0,1,5000,7\n"),
            "more values than columns",
            ":2:10",
            "",
        ),
        (&format!("{head}-1,1\n"), "a time below 0", ":2:1", ""),
        (
            &format!("{head}1,1\n1,2\n"),
            "time 1 s does not come after 1 s",
            ":3:1",
            "order of time",
        ),
        (
            &format!("{head}0,3001\n"),
            "does not reach 3001 1/min",
            ":2:3",
            "`max_rpm` is 3000",
        ),
        (
            &format!("{head}0,1,-5\n"),
            "`power_w` must be greater than 0",
            ":2:5",
            "leave it blank",
        ),
        // 1 N·m at 3000/min are 314 W.
        (
            &format!("{head}0,3000,300\n"),
            "with 300 W the spindle does not reach 3000",
            ":2:8",
            "take 314 W",
        ),
        (
            "0,3000,1e-9\n",
            "more than 50000000 periods",
            ":1:1",
            "--period-ms",
        ),
    ] {
        let said = bench.refused(schedule);
        for part in [message, place, help] {
            assert!(said.contains(part), "{part:?} is not in\n{said}");
        }
    }
    bench.put("s.csv", b"0,\xFF\n");
    let (code, _, err) = ended(bench.command(&["s.csv", "-m", "m.toml"]).output().unwrap());
    assert!(code == 2 && err.contains("this line is not text"), "{err}");
}

#[test]
fn machines_and_periods_that_do_not_do() {
    let bench = Bench::new();
    bench.put("s.csv", "0,1000\n");
    let run = |arguments: &[&str]| ended(bench.command(arguments).output().unwrap());
    let (code, _, err) = run(&["s.csv", "-m", "three-axis"]);
    assert!(
        code == 2 && err.contains("the machine has no [spindle]"),
        "{err}"
    );
    let (code, _, err) = run(&["s.csv", "-m", "m.toml", "--period-ms", "0"]);
    assert!(code == 2 && err.contains("0.001 to 100000"), "{err}");
    let (code, _, err) = run(&["none.csv", "-m", "m.toml"]);
    assert!(code == 2 && err.contains("none.csv"), "{err}");
    // J = A/0.5 s against A²/V_f.
    bench.put(
        "m.toml",
        MACHINE.replace("jerk_time_s = 0.05", "jerk_time_s = 0.5"),
    );
    let (code, _, err) = run(&["s.csv", "-m", "m.toml"]);
    assert!(
        code == 0 && err.contains("falls faster than a jerk of"),
        "{err}"
    );
}

#[test]
fn the_check_of_a_machine_tells_the_run_up() {
    let bench = Bench::new();
    let mut command = gwatt(bench.folder.path(), ["machine", "check", "m.toml"]);
    let (code, out, _) = ended(command.output().unwrap());
    assert_eq!(code, 0);
    assert!(
        out.contains("  spindle: 3000 1/min in 1.00 s, peak "),
        "{out}"
    );
    // No number for the acceleration: refused, not a riddle later.
    bench.put(
        "m.toml",
        MACHINE.replace("accel_time_s = 1\n", "accel_time_s = 1e-320\n"),
    );
    let (code, _, err) = bench.run("0,1\n", &[]);
    assert_eq!(code, 2, "{err}");
}

#[test]
fn what_cannot_be_helped_is_told() {
    let bench = Bench::new();
    let (_, _, err) = bench.run("0,2000\n0.3,2000,,2000\n", &[]);
    assert!(
        err.contains("warning[spindle-limit]: the speed passes 2000 1/min by"),
        "{err}"
    );
    let (_, _, err) = bench.run("0,2000\n0.1,2000,500\n", &[]);
    assert!(err.contains("above the limit, which has shrunk"), "{err}");
}

#[cfg(unix)]
#[test]
fn a_closed_pipe_ends_quietly() {
    let bench = Bench::new();
    bench.put("s.csv", SCHEDULE);
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let mut command = bench.command(&["s.csv", "-m", "m.toml"]);
    let (code, _, err) = ended(command.stdout(writer).output().unwrap());
    assert_eq!(code, 0, "{err}");
    assert!(!err.contains("cannot write"), "{err}");
}
