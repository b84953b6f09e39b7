//! Limited programs, run in `LinuxCNC`: what they draw there, and how long they take.
//!
//! Ignored, since it needs LinuxCNC and minutes. Where that is missing, it says so and
//! passes. `GWATT_PROGRAMS` is the number of programs for each machine, `GWATT_CORPUS` a
//! folder of further programs for X, Y and Z.

use super::recorder::{AxisLimits, is_installed, record_with};
use super::side_by_side::{Any, Random, program, recorded};
use gwatt::machine::{Machine, builtin};
use gwatt::pipeline::{LimitSummary, Options, analyze, limit};
use std::fmt::Write as _;
use std::io::Cursor;
use std::path::Path;

use crate::machines::machine_from;
use crate::runs::WITH_FEEDS;

const SHARES: [f64; 4] = [0.6, 0.7, 0.8, 0.9];
/// What LinuxCNC's task may hold a program up at each word for which it waits, s.
const WAIT_S: f64 = 0.03;
/// Programs of others that take longer are left out, s.
const LONGEST_S: f64 = 60.0;

/// What is asked of a program, and what it was planned to come to.
struct Job {
    text: String,
    limit_w: f64,
    planned_s: f64,
    /// Lines at which the control waits.
    waits: usize,
}

fn machine(letters: &str, axes: &[Any], peak_w: f64, rest: &str) -> Machine {
    let tables: String = axes.iter().map(Any::table).collect();
    let text = format!(
        "schema = 1\nname = \"{letters}\"\ncontroller = \"linuxcnc\"\n\
         [converter]\npeak_power_w = {peak_w:?}\n[limits]\nmargin = 0.0\n{tables}{rest}"
    );
    machine_from(&text)
}

/// A program that is written for a share of its own largest peak; nothing where it is
/// refused, or draws no more.
fn limited(program: &str, of: (&str, &[Any], &str), share: f64) -> Option<(Job, LimitSummary)> {
    let (letters, axes, rest) = of;
    let large = machine(letters, axes, 1e9, rest);
    let input = || Cursor::new(program.as_bytes());
    let options = Options::default();
    let before = analyze(input(), &large, &options, None).ok()?;
    if before.peak_w <= 0.0 || before.duration_s > LONGEST_S {
        return None;
    }
    let limit_w = share * before.peak_w;
    let small = machine(letters, axes, limit_w, rest);
    let mut text = Vec::new();
    let summary = limit(input(), &small, &options, WITH_FEEDS, &mut text, None).ok()?;
    if !summary.certified || summary.edited_lines == 0 {
        return None;
    }
    let text = String::from_utf8(text).ok()?;
    let waits = ["M", "S", "G4", "(", "T"];
    let waits = text
        .lines()
        .filter(|line| waits.iter().any(|word| line.starts_with(word)))
        .count();
    let job = Job {
        text,
        limit_w,
        planned_s: summary.after.duration_s,
        waits,
    };
    Some((job, summary))
}

/// Runs programs, and names those that draw more than their limit or take longer than
/// planned; those that a loaded host holds up are run again.
fn run(letters: &str, axes: &[Any], hal: &str, mut left: Vec<Job>) -> Vec<String> {
    let limits: Vec<AxisLimits> = axes.iter().map(|axis| axis.limits).collect();
    let mut seen = 0;
    for speedup in [3, 1, 1] {
        let texts: Vec<String> = left.iter().map(|job| job.text.clone()).collect();
        let recordings = record_with(&limits, &texts, speedup, hal);
        let mut again = Vec::new();
        for (job, rows) in left.into_iter().zip(recordings) {
            let fits = recorded(axes, &rows).is_some_and(|(recorded_s, recorded_w)| {
                println!(
                    "{letters:8} {recorded_s:8.3} s {:+7.2} %  {recorded_w:8.1} W of {:.1} W",
                    (job.planned_s / recorded_s - 1.0) * 100.0,
                    job.limit_w
                );
                let off_s = recorded_s - job.planned_s;
                let slack_s = 0.005 * recorded_s + 0.005;
                let timed = (-slack_s - WAIT_S * job.waits as f64
                    ..=slack_s + WAIT_S * job.waits as f64)
                    .contains(&off_s);
                // A step of acceleration is recorded as its mean over two cycles.
                timed && recorded_w <= job.limit_w * 1.001
            });
            if fits {
                seen += 1;
            } else {
                again.push(job);
            }
        }
        left = again;
        if left.is_empty() {
            break;
        }
    }
    println!("{letters}: {seen} as planned, {} not", left.len());
    left.into_iter().map(|job| job.text).collect()
}

fn count() -> usize {
    let count = std::env::var("GWATT_PROGRAMS");
    count
        .ok()
        .and_then(|count| count.parse().ok())
        .unwrap_or(20)
}

fn axes_of(letters: &str, random: &mut Random) -> Vec<Any> {
    let letters = letters.chars();
    letters.map(|letter| Any::new(letter, random)).collect()
}

/// Programs in a folder that lie within what the simulated machine can reach.
fn folder(path: &Path, programs: &mut Vec<String>) {
    let mut entries: Vec<_> = std::fs::read_dir(path)
        .into_iter()
        .flatten()
        .flatten()
        .collect();
    entries.sort_by_key(std::fs::DirEntry::path);
    for entry in entries {
        let path = entry.path();
        if path.is_dir() {
            folder(&path, programs);
        } else if let Ok(text) = std::fs::read_to_string(&path) {
            programs.push(text);
        }
    }
}

#[test]
#[ignore = "runs LinuxCNC for minutes"]
fn recorded_limited_programs_keep_their_limit() {
    if !is_installed() {
        crate::evidence::cannot_run("LinuxCNC is not installed");
        return;
    }
    crate::evidence::runs();
    let mut random = Random(0x1234_5678_9ABC_DEF1);
    let mut wrong = Vec::new();
    for letters in ["XYZ", "XYZA", "XYZUV"] {
        let axes = axes_of(letters, &mut random);
        let mut programs: Vec<String> = (0..count()).map(|_| program(&axes, &mut random)).collect();
        if let Some(path) = std::env::var_os("GWATT_CORPUS").filter(|_| letters == "XYZ") {
            folder(Path::new(&path), &mut programs);
        }
        let shares = SHARES.iter().cycle();
        let jobs = programs.iter().zip(shares).filter_map(|(program, share)| {
            let found = limited(program, (letters, &axes, ""), *share);
            found.map(|(job, _)| job)
        });
        wrong.extend(run(letters, &axes, "", jobs.collect()));
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// The HAL lines of the profile, for this output.
fn hal(output: u16) -> String {
    let profile = builtin::controllers()
        .iter()
        .find(|it| it.name == "linuxcnc");
    let lines = profile.expect("the profile").text.lines();
    let lines = lines.filter_map(|line| line.strip_prefix("#     "));
    let mut text = String::new();
    for line in lines {
        let _ = writeln!(
            text,
            "{}",
            line.replace("out-00", &format!("out-{output:02}"))
        );
    }
    assert!(text.contains("ini.z.max_acceleration"));
    text
}

#[test]
#[ignore = "runs LinuxCNC for minutes"]
fn recorded_accelerations_over_hal_keep_the_limit() {
    if !is_installed() {
        crate::evidence::cannot_run("LinuxCNC is not installed");
        return;
    }
    crate::evidence::runs();
    let rest = "[outputs]\nacceleration = 3\nchange_s = 0.012\n";
    let mut random = Random(0x0FED_CBA9_8765_4321);
    let mut wrong = Vec::new();
    let mut sooner = 0;
    for _ in 0..3 {
        let axes = axes_of("XYZ", &mut random);
        let mut jobs = Vec::new();
        for share in SHARES.iter().cycle().take(count()) {
            let program = program(&axes, &mut random).replace("M67 E0", "M67 E1");
            let wired = limited(&program, ("XYZ", &axes, rest), *share);
            let plain = limited(&program, ("XYZ", &axes, ""), *share);
            let Some((job, summary)) = wired else {
                continue;
            };
            if !job.text.contains("M68 E3") {
                continue;
            }
            if let Some((_, plain)) = plain {
                println!(
                    "{:.3} s; {:.3} s without",
                    summary.after.duration_s, plain.after.duration_s
                );
                sooner += usize::from(summary.after.duration_s < plain.after.duration_s);
            }
            jobs.push(job);
        }
        wrong.extend(run("XYZ", &axes, &hal(3), jobs));
    }
    println!("{sooner} sooner than with words for speed alone");
    assert!(sooner > 0);
    assert!(wrong.is_empty(), "{wrong:#?}");
}
