//! Time and memory follow a program's length and its moves: small programs with
//! numbers of any size, words of all languages and turned lines, on all machines and
//! controllers.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::layers::root;
use crate::machines::machine_from;
use crate::random::Dice;

/// Largest program, bytes.
const PROGRAM_BYTES: usize = 10_000;
/// Memory that a run may take, KiB.
const MEMORY_KIB: u64 = 200 * 1024;

/// Numbers that mistakes and turned digits leave.
const NUMBERS: &[&str] = &[
    "0",
    "-0",
    "1",
    "-1",
    "0.001",
    "0.0000001",
    "-0.5",
    "10",
    "360",
    "1000",
    "4096",
    "65536",
    "99999.999",
    "-99999999.999",
    "2147483648",
    "4294967296",
    "9999999999999999",
    "1.",
    ".5",
];

/// Lines of all languages, with bars between.
const LINES: &str = "\
    G64 P0.05|G61|G61.1|G64|G09|G90|G91|G20|G21|G17|G18|G19|G93|G94|G95|F0.001|F100000|\
    G4 P1000000|G4 X3600|G04 F86400|M3 S5000|M3 S1|M5|M8|M9|G96 S200|G97 S1000|\
    M98 P1000 L9|M99|G81 X10 Y10 Z-5 R2 F100|G83 X10 Y10 Z-50 R2 Q0.001 F100|\
    G73 Z-10 R1 Q0.01 F200|G84 X1 Y1 Z-10 R2 F500|G82 X5 Z-1 R1 P9999|G80|G98|G99|\
    G2 X10 Y0 I5 J0|G3 X0 Y0 Z10 I2147483648 J0|G2 I5 J0 P99999|G3 X1 Y1 R99999999|\
    G2 X20 Y20 R-20|G33 Z-100 K0.01|G76 P10 Z-1 I-.1 J.001 R1 K1.2 Q29.5 H3 E0 L0|\
    G71 P10 Q20 U0.001 W0.1 D0.001 F0.2|G76 X10 Z-20 P1000 Q1 F1|#100=100000|\
    WHILE [#100 GT 0] DO1|#100=[#100-1]|END1|IF [#100 LT 5] GOTO 10|GOTO 10|N10|\
    o100 while [#<i> lt 100000]|#<i> = [#<i> + 1]|o100 endwhile|o101 repeat [100000]|\
    o101 endrepeat|o102 sub|o102 endsub|o102 call [1] [2]|R1=1000000|\
    REPEAT 10 20 P=9999|FOR R1=1 TO 100000|ENDFOR|LOOP|ENDLOOP|GOTOB 10|\
    CYCLE83(10,0,2,-50,,-1,,0.001,,,1,0)|TRANS X100000|SUPA G0 Z0|$FOR P1=1,100000,1|\
    $ENDFOR|V.P.X = 5|VC1=5|IF VC1 LT 5 GOTO N10|M201 X1 Y1|M201 X0.001|M204 P1 T1|\
    M205 J0.0001|M205 X0.001|SET_VELOCITY_LIMIT ACCEL=1|M220 S1|G5 I0 J3 P0 Q-3 X1 Y1|\
    G5.1 X1000000 I1000|G5.2 X0 Y1 P1 L3|G131=1|G231=1|FFWON|BRISK|SOFT|ACC[X]=1|\
    G187 P1 E0.001|G05.1 Q1|G8 P1|G28|G53 G0 Z0|G10 L2 P1 X100000|G52 X5|G92 X0|\
    G68 X0 Y0 R45|G51 X0 Y0 P1000|G16|G15|G41 D1 X5|G42 D1|G40|T1 M6|M0|M30|/G0 X1|%|(|\
    G0 X5000 Y5000 Z5000|G1 X0.0001 F1|G1 X100000 F1|G0 A100000|G1 E1000000 F10000|\
    G53 X0|G38.2 Z-10 F1";

const CONTROLLERS: &[&str] = &[
    "fanuc-lathe-b",
    "haas-lathe",
    "fanuc-lathe",
    "fanuc",
    "grbl",
    "haas",
    "isg",
    "iso",
    "klipper",
    "linuxcnc",
    "marlin",
    "mazak",
    "mitsubishi",
    "okuma-lathe",
    "okuma",
    "reprap",
    "siemens",
    "syntec",
];

/// Arguments; `P` is the program, `M` and `N` are machine files.
const RUNS: &[&[&str]] = &[
    &["check", "P", "-m", "M"],
    &["limit", "P", "-m", "M", "-o", "out.ngc"],
    &["limit", "P", "-m", "M", "-o", "out.ngc", "--allow", "feed"],
    &[
        "limit",
        "P",
        "-m",
        "M",
        "--dry-run",
        "--allow",
        "feed",
        "--strategy",
        "speed",
    ],
    &["report", "P", "-m", "M", "--csv", "r.csv"],
    &[
        "report",
        "P",
        "-m",
        "M",
        "--csv",
        "r.csv",
        "--series",
        "s.csv",
        "--step-ms",
        "10",
    ],
    &[
        "report",
        "P",
        "-m",
        "M",
        "--csv",
        "r.csv",
        "--series",
        "s.csv",
        "--step-ms",
        "1000000",
    ],
    &["moves", "P", "-m", "M"],
    &["diff", "P", "--from", "M", "--to", "N"],
];

/// Loops that do not end have a bound of their own, which is high.
const BOUNDED: &[&str] = &["--max-moves", "200000", "--max-idle-lines", "200000"];

/// All files below a folder that end so.
fn files(folder: &Path, endings: &[&str], found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let ending = path.extension().and_then(|ending| ending.to_str());
        if path.is_dir() {
            files(&path, endings, found);
        } else if ending.is_some_and(|ending| endings.contains(&ending)) {
            found.push(path);
        }
    }
    found.sort();
}

fn texts(folders: &[&str], endings: &[&str]) -> Vec<String> {
    let mut found = Vec::new();
    for folder in folders {
        files(&root().join(folder), endings, &mut found);
    }
    let texts = found.iter().map(|path| fs::read(path).unwrap());
    let texts = texts.map(|text| String::from_utf8_lossy(&text).into_owned());
    texts.filter(|text| text.len() <= PROGRAM_BYTES).collect()
}

/// A line with one of its numbers replaced.
fn with_number(line: &str, dice: &mut Dice) -> String {
    let is_number = |c: char| c.is_ascii_digit() || "+-.".contains(c);
    let mut starts = Vec::new();
    let mut before = ' ';
    for (at, c) in line.char_indices() {
        if is_number(c) && before.is_ascii_alphabetic() {
            starts.push(at);
        }
        before = c;
    }
    if starts.is_empty() {
        return line.to_owned();
    }
    let start = *dice.of(&starts);
    let (head, tail) = line.split_at(start);
    let rest = tail.trim_start_matches(is_number);
    format!("{head}{}{rest}", dice.of(NUMBERS))
}

fn mutated(programs: &[String], dice: &mut Dice) -> String {
    let mut lines: Vec<String> = dice.of(programs).lines().map(str::to_owned).collect();
    let known: Vec<&str> = LINES.split('|').collect();
    for _ in 0..=dice.below(6) {
        if lines.is_empty() {
            lines.push("G0 X1".into());
        }
        let at = dice.below(lines.len());
        match dice.below(8) {
            0..=2 => lines[at] = with_number(&lines[at], dice),
            3 | 4 => lines.insert(at, dice.of(&known).to_string()),
            5 => {
                let line = with_number(known[dice.below(known.len())], dice);
                lines.insert(at, line);
            }
            6 => {
                let other: Vec<&str> = dice.of(programs).lines().collect();
                let from = dice.below(other.len());
                let taken = other.iter().skip(from).take(1 + dice.below(20));
                lines.splice(at..at, taken.map(|line| (*line).to_owned()));
            }
            _ => {
                lines.remove(at);
            }
        }
    }
    let mut program = lines.join("\n");
    while program.len() > PROGRAM_BYTES {
        program.pop();
    }
    program
}

/// A machine file under a controller, which may add limits over time.
fn machine(machines: &[String], dice: &mut Dice) -> String {
    let (text, controller) = (dice.of(machines), dice.of(CONTROLLERS));
    let mut machine = String::new();
    for line in text.lines() {
        let line = if line.starts_with("controller =") && dice.below(4) > 0 {
            format!("controller = \"{controller}\"")
        } else {
            line.to_owned()
        };
        let _ = writeln!(machine, "{line}");
        if line == "[converter]" && dice.below(2) == 0 && !text.contains("continuous_power_w") {
            machine.push_str("continuous_power_w = 50\nwindow_s = 180\n");
        }
    }
    machine
}

/// What a run took: s, KiB, and how it ended.
fn run(arguments: &[&str], folder: &Path, limit_s: f64) -> (f64, u64, String) {
    let binary = std::env::var_os("GWATT_BIN");
    let binary = binary.unwrap_or_else(|| env!("CARGO_BIN_EXE_gwatt").into());
    let began = Instant::now();
    let mut child = Command::new(binary)
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut memory_kib = 0;
    loop {
        let (used_s, kib) = used(&child);
        memory_kib = memory_kib.max(kib);
        if let Some(status) = child.try_wait().unwrap() {
            return (
                began.elapsed().as_secs_f64(),
                memory_kib,
                status.to_string(),
            );
        }
        if used_s > limit_s
            || memory_kib > MEMORY_KIB
            || began.elapsed().as_secs_f64() > 10.0 * limit_s
        {
            child.kill().unwrap();
            let _ = child.wait();
            return (used_s, memory_kib, "stopped".into());
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Processor time so far in s, and the most memory in KiB, where the system shows them.
fn used(child: &Child) -> (f64, u64) {
    let folder = format!("/proc/{}", child.id());
    let status = fs::read_to_string(format!("{folder}/status")).unwrap_or_default();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = peak.and_then(|peak| peak.trim().trim_end_matches(" kB").parse().ok());
    let stat = fs::read_to_string(format!("{folder}/stat")).unwrap_or_default();
    // After the name in brackets, user and system time are the 12th and the 13th.
    let fields = stat.rsplit(") ").next().unwrap_or_default().split(' ');
    let ticks = fields
        .skip(11)
        .take(2)
        .filter_map(|ticks| ticks.parse::<f64>().ok());
    (ticks.sum::<f64>() / 100.0, kib.unwrap_or(0))
}

fn seconds(name: &str, default: f64) -> f64 {
    let given = std::env::var(name).ok();
    given.and_then(|text| text.parse().ok()).unwrap_or(default)
}

/// `GWATT_FUZZ_S`, `GWATT_FUZZ_SEED`, `GWATT_FUZZ_LIMIT_S` and `GWATT_BIN` may be set;
/// what fails stays in the folder that is named.
#[test]
#[ignore = "minutes: mutated programs with limits of time and memory"]
fn small_programs_come_to_an_end_soon() {
    let programs = texts(&["tests", "examples"], &["ngc", "gcode", "mpf", "nc"]);
    let machines = texts(&["machine-configs"], &["toml"]);
    let machines: Vec<String> = machines
        .into_iter()
        .filter(|text| text.contains("[axes."))
        .collect();
    let folder = tempfile::tempdir().unwrap().keep();
    // Unoptimised the binary is some four times slower.
    let limit_s = seconds(
        "GWATT_FUZZ_LIMIT_S",
        if cfg!(debug_assertions) { 8.0 } else { 2.0 },
    );
    let began = Instant::now();
    let mut seed = seconds("GWATT_FUZZ_SEED", 1.0) as u64;
    let mut failed = Vec::new();
    let (mut runs, mut slowest) = (0, (0.0, 0));
    while began.elapsed().as_secs_f64() < seconds("GWATT_FUZZ_S", 60.0) {
        seed += 1;
        let mut dice = Dice(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        for _ in 0..4 {
            dice.below(1);
        }
        let program = mutated(&programs, &mut dice);
        let given = [machine(&machines, &mut dice), machine(&machines, &mut dice)];
        let wanted = dice.of(RUNS);
        let names = [
            format!("{seed}.ngc"),
            format!("{seed}-m.toml"),
            format!("{seed}-n.toml"),
        ];
        for (name, text) in names.iter().zip([&program, &given[0], &given[1]]) {
            fs::write(folder.join(name), text).unwrap();
        }
        let arguments: Vec<&str> = wanted
            .iter()
            .map(|word| match *word {
                "P" => names[0].as_str(),
                "M" => names[1].as_str(),
                "N" => names[2].as_str(),
                word => word,
            })
            .chain(BOUNDED.iter().copied())
            .collect();
        let (took_s, kib, end) = run(&arguments, &folder, limit_s);
        runs += 1;
        slowest = (f64::max(slowest.0, took_s), slowest.1.max(kib));
        if end == "stopped" || end.contains("exit status: 3") || end.contains("signal") {
            println!(
                "{end} after {took_s:.1} s, {kib} KiB: gwatt {}",
                arguments.join(" ")
            );
            failed.push(seed);
        } else {
            for name in &names {
                fs::remove_file(folder.join(name)).unwrap();
            }
        }
    }
    println!(
        "{runs} runs, at most {:.1} s and {} KiB",
        slowest.0, slowest.1
    );
    assert!(failed.is_empty(), "{failed:?} in {}", folder.display());
    fs::remove_dir_all(folder).unwrap();
}

/// Limits over time on a circle that takes years: 100 N on each axis at 50 mm/s are
/// 10 W, and 5·√2 W each where both move alike: 14.14 W for longer than any window.
#[test]
fn an_arc_of_years_is_held_against_its_worst_window() {
    let axis = |letter: char| {
        format!(
            "[axes.{letter}]\nrapid_mm_min = 30000\naccel_mm_s2 = 3000\nmass_kg = 50\ncoulomb_n = 200\n"
        )
    };
    let ratings = "peak_power_w = 1000\ncontinuous_power_w = 900\nwindow_s = 180";
    for (controller, most) in [("iso", 1.001), ("linuxcnc", 1.001)] {
        let text = format!(
            "schema = 1\nname = \"m\"\ncontroller = \"{controller}\"\n[converter]\n{ratings}\n{}{}\
             [limits]\nmargin = 0\n[path]\nmode = \"exact-stop\"\n",
            axis('X'),
            axis('Y')
        );
        let machine = machine_from(&text);
        let program = "G21 G90 G94 G17\nG0 X0 Y0\nG3 X0 Y0 I2147483648 J0 F3000\nM30\n";
        let options = gwatt::pipeline::Options::default();
        let input = std::io::Cursor::new(program);
        let summary = gwatt::pipeline::analyze(input, &machine, &options, None).unwrap();
        // 1.35e10 mm at 50 mm/s.
        let years_s = std::f64::consts::TAU * 2_147_483_648.0 / 50.0;
        assert!((summary.duration_s / years_s - 1.0).abs() < 1e-6);
        let mean_w = summary.over_time[0].rating.value;
        let exact_w = 200.0 * 0.05 * 2.0_f64.sqrt();
        // Two slices of 1 ‰ of the converter's power, and a cell.
        let high_w = 1000.0 * 1e-3;
        assert!(
            mean_w >= exact_w && mean_w < exact_w * most + high_w,
            "{mean_w}"
        );
    }
}

/// grbl rounds arcs by 2 µm: a circle of 4295 km would be some millions of chords, of
/// which nobody knows how they run; one of 100 m is planned chord by chord.
#[test]
fn an_arc_of_too_many_chords_gets_the_robust_bound() {
    let axis = |letter: char| {
        format!(
            "[axes.{letter}]\nrapid_mm_min = 30000\naccel_mm_s2 = 3000\nmass_kg = 50\ncoulomb_n = 200\n"
        )
    };
    let text = format!(
        "schema = 1\nname = \"m\"\ncontroller = \"grbl\"\n[converter]\npeak_power_w = 1000\n{}{}\
         [limits]\nmargin = 0\n",
        axis('X'),
        axis('Y')
    );
    let machine = machine_from(&text);
    for (radius, certificate) in [
        ("2147483648", gwatt::pipeline::Certificate::Robust),
        ("100000", gwatt::pipeline::Certificate::Planned),
    ] {
        let program = format!("G21 G90 G94 G17\nG0 X0 Y0\nG3 X0 Y0 I{radius} J0 F3000\nM2\n");
        let options = gwatt::pipeline::Options::default();
        let input = std::io::Cursor::new(program);
        let summary = gwatt::pipeline::analyze(input, &machine, &options, None).unwrap();
        assert_eq!(summary.certificate, Some(certificate), "{radius}");
        // At most 50 mm/s with 50 kg at 3 m/s² on both axes, and friction on both.
        let most_w = 2.0 * 0.05 * (50.0 * 3.0 + 200.0);
        assert!(summary.peak_w >= 200.0 * 0.05 * 2.0_f64.sqrt() && summary.peak_w < most_w * 1.001);
    }
}
