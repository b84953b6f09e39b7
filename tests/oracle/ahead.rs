//! Series of programs with look-ahead, and of exact stops, compared with the second
//! implementation and the report.

use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use gwatt::interpret::MoveKind;
use gwatt::machine::OverrideAt;
use gwatt::pipeline::{self, Certificate, Options, Row, Summary};

use super::compare::{machine, rows};
use super::machines;
use super::plant::Plant;
use super::programs;
use super::series::{Rules, Watch};
use crate::random::Random;

const CONTROLLERS: [&str; 5] = ["grbl", "marlin", "reprap", "klipper", "linuxcnc"];
/// Programs of others that last longer are left out.
const LASTS_MAX_S: f64 = 3600.0;
/// Steps of a series of a program that is not made at random.
const STEPS: f64 = 10_000.0;
/// Largest size of such a program.
const BYTES_MAX: u64 = 300_000;

fn rules(controller: &str, rows: &[Row]) -> Rules {
    let arcs = rows.iter().any(|row| row.kind == MoveKind::Arc);
    let linuxcnc = controller == "linuxcnc";
    Rules {
        // LinuxCNC: helices; next to each other two moves run at once, the second one
        // with its full acceleration where rotary axes move. The others run arcs in
        // chords, in the series as arcs: what limits the speed is the step from one
        // chord to the next, not the curvature.
        accel: match controller {
            "iso" => 1.0,
            "linuxcnc" => 2.0,
            _ if arcs => f64::INFINITY,
            _ => 1.1,
        },
        // A corner of LinuxCNC is rounded in a few milliseconds.
        chord: if linuxcnc { 0.5 } else { 0.02 },
        // It passes a kink without a blend where one cycle's acceleration suffices.
        kink_s: if linuxcnc { 1e-3 } else { 0.0 },
        steps: !linuxcnc && controller != "iso",
        blends: controller != "iso",
    }
}

/// What differs in the series of a program.
fn check(toml: &str, controller: &str, program: &str, step_s: f64) -> (u64, Vec<String>) {
    let machine = machine(toml);
    let plant = Plant::new(toml);
    let (rows_of_all, all) = rows(&machine, program);
    let rules = rules(controller, &rows_of_all);
    let mut watch = Watch::new(&plant, rules);
    let input = Cursor::new(program.to_owned());
    pipeline::series(input, &machine, &Options::default(), step_s, &mut watch)
        .unwrap_or_else(|failure| panic!("{failure:?}\n{program}"));
    // The series runs at 100 %, or at the largest override below.
    let mut usual = machine.clone();
    let limits = &mut usual.limits;
    limits.override_at = Some(OverrideAt {
        feed: limits.feed_override_max.min(1.0),
        rapid: limits.rapid_override_max.min(1.0),
        spindle: limits.spindle_override_max.min(1.0),
    });
    let (own_rows, own) = rows(&usual, program);
    if own.certificate != Some(Certificate::Robust) {
        watch.compare(&own_rows);
        let energy_j = own_rows.iter().map(|row| row.energy_j).sum();
        whole(&plant, &own, &mut watch, energy_j, rules);
    }
    if all.certificate != Some(Certificate::Robust) {
        watch.compare(&rows_of_all);
    }
    (watch.rows, watch.wrong)
}

/// The program as a whole: its time, its energy, its largest powers.
fn whole(plant: &Plant, summary: &Summary, watch: &mut Watch<'_>, energy_j: f64, rules: Rules) {
    let duration_s = watch.duration_s();
    // Two moves at once are bounded; a series does not show steps of speed.
    let bounded = rules.steps || rules.kink_s > 0.0;
    let mut differs = |what: &str, own: f64, output: f64| {
        watch.wrong.push(format!(
            "{what}: {own} in the series, {output} in the report"
        ));
    };
    if (duration_s - summary.duration_s).abs() > 1e-6 * summary.duration_s + 1e-6 {
        differs("duration", duration_s, summary.duration_s);
    }
    let [one] = watch.peaks_w[..] else { return };
    let output = [summary.peak_w, summary.regen_w];
    let exact = !bounded
        && plant.spindle.is_none()
        && plant
            .axes
            .iter()
            .all(|axis| (axis.factors, axis.warm) == ([1.0; 2], 1.0));
    for (what, own, output) in [("peak", one[0], output[0]), ("fed back", one[1], output[1])] {
        let slack_w = 1e-6 * (one[0].abs() + one[1]) + 1e-6;
        let high = exact && own < output - 0.01 * output - slack_w;
        if own > output + slack_w || high {
            differs(what, own, output);
        }
    }
    let scale_j = duration_s * one[0].abs();
    let apart_j = energy_j - watch.energy_j;
    let slack_j = 2e-3 * energy_j.abs() + 1e-4 * scale_j;
    // Steps that brake are credited like everything else.
    let credited = rules.steps && plant.converters.iter().any(|own| own.credit);
    if apart_j < -slack_j && !credited || apart_j > slack_j && !bounded {
        differs("energy", watch.energy_j, energy_j);
    }
}

/// Checks so many random programs of each controller.
fn random(seed: u64, count: u64) {
    let mut shown = Vec::new();
    let mut rows = 0;
    for controller in CONTROLLERS.into_iter().chain(["iso"]) {
        for number in 0..count {
            let mut random = Random::new(seed + number);
            let machine = machines::of(controller, &mut random, controller == "iso");
            let program = programs::curvy(&mut random, &machine, controller, 40);
            let (own, wrong) = check(&machine.toml, controller, &program, 1e-3);
            rows += own;
            if !wrong.is_empty() {
                println!("{controller} {}: {}", seed + number, wrong.join("; "));
                shown.push(format!("{}\n{program}\n{}", machine.toml, wrong.join("\n")));
            }
        }
    }
    assert!(rows > 1000 * count, "{rows} rows");
    let first: Vec<&String> = shown.iter().take(4).collect();
    assert!(
        shown.is_empty(),
        "{} programs differ:\n{first:#?}",
        shown.len()
    );
}

#[test]
fn series_of_random_programs_are_right() {
    random(1, 8);
}

#[test]
#[ignore = "thousands of programs take some minutes"]
fn series_of_many_random_programs_are_right() {
    random(5000, 500);
}

/// The programs of the examples on their machines, by every controller that
/// reads them.
#[test]
fn series_of_the_examples_are_right() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut checked = 0;
    for (name, machine) in [
        ("pocket.ngc", "router-48v"),
        ("simultaneous-start.ngc", "three-axis"),
        ("circle.ngc", "router-48v"),
        ("printer-outline.gcode", "printer"),
    ] {
        let text = fs::read_to_string(root.join("examples").join(name)).unwrap();
        let (own, wrong) = controllers(machine, &text, name);
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
        checked += own;
    }
    assert!(checked >= 8, "{checked}");
}

/// Arcs whose ends lie on a quadrant but for rounding have no piece there at which the
/// axes stand.
#[test]
fn series_of_arcs_that_end_on_quadrants_are_right() {
    let program = "G21 G90 G17\nG0 X-5 Y-22.5\nG2 X-10.303 Y-20.303 I0 J7.5 F500\n\
                   G2 X-12.5 Y-15 I5.303 J5.303\nG3 X-13.232 Y-13.232 I-2.5 J0\n\
                   G3 X-15 Y-12.5 I-1.768 J-1.768\nG1 X-20\nG2 X-22.5 Y-10 I0 J2.5\nM2\n";
    let (own, wrong) = controllers("router-48v", program, "quadrants");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_eq!(own, CONTROLLERS.len());
}

/// Checks a program on a built-in machine under each controller that reads it;
/// gives how many do, and what differs.
fn controllers(machine: &str, program: &str, name: &str) -> (usize, Vec<String>) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("machine-configs");
    let toml = fs::read_to_string(path.join(machine).with_extension("toml")).unwrap();
    let own = toml
        .lines()
        .find(|line| line.starts_with("controller"))
        .unwrap();
    let (mut checked, mut differing) = (0, Vec::new());
    for controller in CONTROLLERS {
        let toml = toml.replace(own, &format!("controller = \"{controller}\""));
        let Ok((read, _)) = gwatt::machine::Machine::from_toml("machine.toml", &toml) else {
            continue;
        };
        let input = Cursor::new(program.to_owned());
        let Ok(summary) = pipeline::analyze(input, &read, &Options::default(), None) else {
            continue;
        };
        if summary.duration_s <= LASTS_MAX_S {
            let step_s = (summary.duration_s / STEPS).clamp(2e-4, 2e-2);
            let (_, wrong) = check(&toml, controller, program, step_s);
            if !wrong.is_empty() {
                differing.push(format!("{name} on {controller}: {wrong:#?}"));
            }
            checked += 1;
        }
    }
    (checked, differing)
}

fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            files(&path, found);
        } else if entry.metadata().is_ok_and(|data| data.len() < BYTES_MAX) {
            found.push(path);
        }
    }
}

#[test]
#[ignore = "programs of others, which take some minutes"]
fn series_of_programs_of_others_are_right() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let corpus = root.join("../shared/corpus");
    if !corpus.is_dir() {
        crate::evidence::cannot_run("the programs of others are not there");
        return;
    }
    crate::evidence::runs();
    let mut found = Vec::new();
    for folder in [
        "3dprint",
        "grbl",
        "linuxcnc",
        "fusion_freecad",
        "nist_rs274",
        "parser_tests",
        "fanuc_haas",
    ] {
        files(&corpus.join(folder), &mut found);
    }
    found.sort();
    let (mut checked, mut programs, mut differing) = (0, 0, Vec::new());
    for path in &found {
        let name = path.display().to_string();
        let text = String::from_utf8_lossy(&fs::read(path).unwrap()).into_owned();
        let machine = if name.contains("3dprint") {
            "printer"
        } else {
            "router-48v"
        };
        let (own, wrong) = controllers(machine, &text, &name);
        differing.extend(wrong);
        checked += own;
        programs += usize::from(own > 0);
    }
    println!("{programs} programs, {checked} series");
    assert!(differing.is_empty(), "{}", differing.join("\n"));
    assert!(programs >= 100, "{programs}");
}
