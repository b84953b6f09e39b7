//! The load's path: hand-worked lines and circles, and the motion it comes from.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;
use std::io::Cursor;
use std::path::Path;

use gwatt::contour::{ContourRow, ContourSink, ContourSummary, PlotPoint, Settings, Tracer};
use gwatt::identify::{Factor, TransferFunction};
use gwatt::machine::Machine;
use gwatt::pipeline::{Failure, Options, Stretch, analyze, motion};

use crate::identify::pair;
use crate::machines::{linear_axes, machine_from};
use crate::shop::{ended, gwatt};

/// A machine of X, Y and Z with these tables after the axes'.
fn machine(controller: &str, tables: &str) -> Machine {
    let axis =
        |letter: &str, mass_kg| linear_axes(letter, [24000.0, 2000.0, mass_kg], "coulomb_n = 200");
    machine_from(&format!(
        "schema = 1\nname = \"mill\"\ncontroller = \"{controller}\"\n[converter]\n\
         peak_power_w = 9000\nbase_load_w = 100\n{}{}{}{tables}",
        axis("X", 300.0),
        axis("Y", 200.0),
        axis("Z", 100.0)
    ))
}

#[derive(Default)]
struct Kept {
    rows: Vec<ContourRow>,
    points: u64,
}

impl ContourSink for Kept {
    fn row(&mut self, row: &ContourRow) -> std::io::Result<()> {
        self.rows.push(row.clone());
        Ok(())
    }

    fn point(&mut self, _: &PlotPoint) {
        self.points += 1;
    }
}

fn trace(machine: &Machine, program: &str) -> Result<(ContourSummary, Kept), String> {
    let mut kept = Kept::default();
    let settings = Settings { period_s: 1e-3 };
    let mut tracer = match Tracer::new(machine, settings, &mut kept) {
        Ok(tracer) => tracer,
        Err(trouble) => return Err(trouble.message),
    };
    let input = Cursor::new(program.to_owned());
    let notes = motion(input, machine, &Options::default(), &mut |stretch| {
        tracer.push(stretch)
    });
    let summary = notes.and_then(|_| tracer.finish());
    match summary {
        Ok(summary) => Ok((summary, kept)),
        Err(Failure::Unsuitable(message)) => Err(message),
        Err(other) => panic!("{other:?}"),
    }
}

/// Position loops of these gains.
fn loops(x: f64, y: f64) -> String {
    format!(
        "[axes.X.response]\nposition_gain_1_s = {x:?}\n[axes.Y.response]\nposition_gain_1_s = {y:?}\n"
    )
}

#[test]
fn along_one_axis_there_is_no_contour_error() {
    let machine = machine("iso", &loops(50.0, 40.0));
    let (summary, kept) = trace(&machine, "G21 G90 G94\nG1 X100 F6000\nM30\n").unwrap();
    assert!(summary.errors[0].largest_mm < 1e-9, "{summary:?}");
    assert_eq!(kept.rows.len(), 1);
    // 300 kg·2 m/s² + 200 N once the loop has taken the ramp up: all but
    // e^(−50·0.05), a part of which the period takes.
    let force = summary.axes[0].force_peak_n[0];
    let settled = 200.0 + 600.0 * (1.0 - libm::exp(-2.5));
    assert!((force - settled).abs() < 15.0, "{force} {settled}");
    assert!(!summary.corrected && summary.axes[1].force_peak_n[0] == 0.0);
}

#[test]
fn unequal_loops_bend_a_slanted_line() {
    // Lags v·cos/Kx and v·sin/Ky: v·sin·cos·(1/40 − 1/50) = 0.25 mm across a line
    // of 45° at 100 mm/s.
    let machine = machine("iso", &loops(50.0, 40.0));
    let (summary, kept) = trace(&machine, "G21 G90 G94\nG1 X100 Y100 F6000\nM30\n").unwrap();
    assert!(
        (summary.errors[0].largest_mm - 0.25).abs() < 1e-6,
        "{summary:?}"
    );
    assert_eq!(summary.lines[0], 2);
    let row = &kept.rows[0];
    assert_eq!(row.errors.unwrap()[0], summary.errors[0]);
    assert!(summary.errors[0].rms_mm() > 0.2 && summary.errors[0].rms_mm() < 0.25);
}

const CIRCLE: &str = "G21 G90 G94 G17\nG0 X10\nG3 X10 Y0 I-10 J0 F3000\nM30\n";

/// How far a circle is out of round, and how much smaller, that both axes run by
/// their responses at a steady speed.
fn ellipse(x: &TransferFunction, y: &TransferFunction, radius: f64, hz: f64) -> [f64; 2] {
    let (a, b) = (x.at_hz(hz), y.at_hz(hz));
    let (mut least, mut most, mut sum) = (f64::INFINITY, 0.0_f64, 0.0);
    let count = 3600;
    for k in 0..count {
        let (sin, cos) = libm::sincos(TAU * f64::from(k) / f64::from(count));
        // Re(T·e^jθ) of X, Im(T·e^jθ) of Y.
        let px = a.re * cos - a.im * sin;
        let py = b.re * sin + b.im * cos;
        let r = radius * libm::hypot(px, py);
        least = least.min(r);
        most = most.max(r);
        sum += r / f64::from(count);
    }
    [most - least, radius - sum]
}

fn flexible(correction: &str) -> String {
    let mut text = String::new();
    for (letter, hz) in [("X", 30), ("Y", 42)] {
        let _ = write!(
            text,
            "[axes.{letter}.response]\nposition_gain_1_s = 60\nvelocity_bandwidth_hz = 80\nzeros = [{{ frequency_hz = {hz}, damping = 0.03 }}]\n"
        );
    }
    text + correction
}

/// Filters for these zeros, as they stand in a machine file.
fn correction(x: (f64, f64), y: (f64, f64)) -> String {
    use gwatt::identify::tune::{Discretization, Wish, design};
    let wish = Wish {
        period_s: 1e-3,
        discretization: Discretization::Matched,
        no_low_pass: false,
        order: None,
        bandwidth_hz: None,
    };
    let zeros = [('X', vec![pair(x.0, x.1)]), ('Y', vec![pair(y.0, y.1)])];
    let correction = design(&zeros, &wish).unwrap();
    let mut text = String::new();
    for ((letter, _), filter) in zeros.iter().zip(&correction.filters) {
        let _ = write!(
            text,
            "[axes.{letter}.correction]\nperiod_ms = 1\nsections = [\n"
        );
        for section in &filter.sections {
            let _ = writeln!(text, "{:?},", section.coefficients());
        }
        text += "]\n";
    }
    text
}

#[test]
fn circles_are_as_round_as_the_responses_say() {
    let response = |hz: f64| TransferFunction {
        gain: 1.0,
        zeros: vec![pair(hz, 0.03)],
        poles: vec![
            Factor::Real {
                time_constant_s: 1.0 / 60.0,
            },
            pair(80.0, std::f64::consts::FRAC_1_SQRT_2),
        ],
        delay_s: 0.0,
    };
    let hz = 50.0 / 10.0 / TAU;
    let [round, smaller] = ellipse(&response(30.0), &response(42.0), 10.0, hz);
    // By hand: r·ω²·(1/ωx² − 1/ωy²) = 3.44 µm and r·2ζω·(1/ωx − 1/ωy) = 4.55 µm,
    // at right angles 5.70 µm.
    assert!((round - 5.70e-3).abs() < 0.02e-3, "{round}");
    // Zeros off by half a standard error of 16 s with 5 % noise, each to its side.
    let off = correction((30.0 * 1.0001, 0.03 * 1.004), (42.0 * 0.9999, 0.03 * 0.996));
    let machine = machine("iso", &flexible(&off));
    let (summary, kept) = trace(&machine, CIRCLE).unwrap();
    let arc = kept.rows[1].arc.as_ref().unwrap();
    let before = arc.roundness[0].as_ref().unwrap();
    assert!(
        (before.roundness_mm - round).abs() < 0.01 * round,
        "{arc:?}"
    );
    assert!(
        (before.shrinkage_mm - smaller).abs() < 0.02 * smaller,
        "{arc:?} {smaller}"
    );
    let after = arc.roundness[1].as_ref().unwrap();
    assert!(after.roundness_mm < 0.15e-3, "{after:?}");
    assert!(after.shrinkage_mm > before.shrinkage_mm);
    assert!(summary.corrected);
    let conditions = summary.conditions.join("; ");
    assert!(conditions.contains("friction that reverses and backlash are not in it"));
    assert!((arc.speed_mm_s - 50.0).abs() < 1e-9 && arc.radius_mm == 10.0);
}

#[test]
fn a_short_arc_has_no_roundness() {
    let machine = machine("iso", &flexible(""));
    let (_, kept) = trace(
        &machine,
        "G21 G90 G94 G17\nG3 X-10 Y10 I-10 J0 F12000\nM30\n",
    )
    .unwrap();
    assert_eq!(kept.rows[0].arc.as_ref().unwrap().roundness, [None, None]);
}

#[test]
fn what_cannot_be_traced_is_refused() {
    let refused = |tables: &str, program: &str| {
        let machine = machine("iso", tables);
        trace(&machine, program).map(|_| ()).unwrap_err()
    };
    let x = "G21 G90 G94\nG1 X10 F600\nM30\n";
    assert_eq!(
        refused("", x),
        "the machine file does not say how loads follow commands"
    );
    assert!(refused("[axes.Y.response]\n", x).starts_with(
        "line 2: axis X moves, and the machine file does not say how its load follows"
    ));
    let zeros = "zeros = [{ frequency_hz = 40, damping = 0.03 }]";
    assert!(
        refused(
            &format!("[axes.X.response]\nposition_gain_1_s = 40\n{zeros}\n"),
            x
        )
        .starts_with("axis X: its response has more zeros than poles")
    );
    assert!(
        refused("[axes.X.response]\ndelay_ms = 1001\n", x)
            .starts_with("axis X: its delay is longer than a second")
    );
    let filter = |letter: &str, period: &str| {
        format!("[axes.{letter}.correction]\nperiod_ms = {period}\nsections = [[1, 0, 0, 0, 0]]\n")
    };
    let both = loops(40.0, 40.0) + &filter("X", "1") + &filter("Y", "2");
    assert_eq!(
        refused(&both, x),
        "the filters of X and Y have different periods: 1 and 2 ms"
    );
}

const MIXED: &str = "G21 G90 G94 G17\nG0 X20 Y5\nG1 X40 F6000\nY30\nG3 X20 Y50 I-20 J0\nG1 X0 Y40\n\
    X0 Y39.9\nX0.1 Y39.7\nX0.3 Y39.4\nG4 P0.2\nG2 X0.3 Y39.4 Z-3 I-5 J0\nG0 Z10\nM30\n";

/// Stretches join without jumps of position, those of a path that is not left
/// without jumps of speed, and last as long as the report says.
#[test]
fn motion_is_continuous_and_as_long_as_planned() {
    for controller in ["iso", "linuxcnc", "grbl"] {
        let machine = machine(controller, "");
        let mut stretches: Vec<Stretch> = Vec::new();
        let input = || Cursor::new(MIXED.to_owned());
        motion(input(), &machine, &Options::default(), &mut |stretch| {
            stretches.push(stretch);
            Ok(())
        })
        .unwrap();
        let mut end: Option<gwatt::plan::AxisStates> = None;
        let mut total = 0.0;
        for stretch in &stretches {
            let at = |t: f64| stretch.track.at(stretch.path_at(t), t);
            let start = at(0.0);
            if let Some(end) = end {
                for n in 0..3 {
                    let jump = (start.position[n] - end.position[n]).abs();
                    assert!(jump < 1e-6, "{controller} line {}: {jump}", stretch.line);
                }
                let speed = |s: &gwatt::plan::AxisStates| {
                    s.velocity.iter().map(|v| v * v).sum::<f64>().sqrt()
                };
                let jump = (speed(&start) - speed(&end)).abs();
                assert!(jump < 1e-3, "{controller} line {}: {jump}", stretch.line);
            }
            end = Some(at(stretch.duration_s));
            total += stretch.duration_s;
        }
        let summary = analyze(input(), &machine, &Options::default(), None).unwrap();
        assert!(
            (total - summary.duration_s).abs() < 1e-6 * total,
            "{controller}: {total} {}",
            summary.duration_s
        );
        let [x, y, z, ..] = end.unwrap().position;
        assert!((x - 0.3).abs() + (y - 39.4).abs() + (z - 10.0).abs() < 1e-6);
        let numbers = stretches
            .windows(2)
            .all(|pair| pair[0].number <= pair[1].number);
        assert!(numbers, "{controller}");
    }
}

#[test]
fn blended_corners_count_against_the_path_that_is_run() {
    let alike = loops(60.0, 60.0) + "[axes.Z.response]\nposition_gain_1_s = 60\n";
    let stops = machine("iso", &alike);
    let blends = machine("linuxcnc", &alike);
    let (_, kept) = trace(&stops, MIXED).unwrap();
    // Each move once, in order.
    let lines: Vec<u64> = kept.rows.iter().map(|row| row.line).collect();
    assert_eq!(lines, [2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]);
    let (summary, kept) = trace(&blends, MIXED).unwrap();
    assert_eq!(kept.rows.len(), 11);
    assert!(summary.errors[0].largest_mm > 0.01 && summary.errors[0].largest_mm < 1.0);
    // Samples up to the end, and until all has settled.
    let settled = kept.points as f64 * 1e-3 - summary.duration_s;
    assert!(settled > 0.1 && settled < 0.5, "{settled}");
}

#[test]
fn files_of_contour_are_whole() {
    let shop = tempfile::tempdir().unwrap();
    let folder = shop.path();
    let run =
        |arguments: &[&str]| ended(gwatt(folder, arguments.iter().copied()).output().unwrap());
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    for name in ["circle.ngc", "circle-mill.toml"] {
        fs::copy(examples.join(name), folder.join(name)).unwrap();
    }
    let (code, text, said) = run(&[
        "contour",
        "circle.ngc",
        "-m",
        "circle-mill.toml",
        "--csv",
        "c.csv",
        "--json",
        "c.json",
        "--svg",
        "c.svg",
        "--circles",
        "o.svg",
    ]);
    assert_eq!(code, 0, "{said}");
    assert!(text.contains("with correction"), "{text}");
    let csv = fs::read_to_string(folder.join("c.csv")).unwrap();
    let mut lines = csv.lines();
    let columns = lines.next().unwrap().split(',').count();
    assert!(
        lines.all(|line| line.split(',').count() == columns),
        "{csv}"
    );
    let json: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(folder.join("c.json")).unwrap()).unwrap();
    assert_eq!(
        json["moves"].as_array().unwrap().len(),
        csv.lines().count() - 1
    );
    assert_eq!(json["corrected"], true);
    assert!(json["corrected_peak_w"].as_f64().unwrap() > 0.0);
    for name in ["c.svg", "o.svg"] {
        let svg = fs::read_to_string(folder.join(name)).unwrap();
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
        assert!(svg.matches("<polyline").count() >= 2 && !svg.contains("NaN"));
    }
    // Refused: nothing is written.
    let arguments = [
        "contour",
        "circle.ngc",
        "-m",
        "circle-mill.toml",
        "--csv",
        "no.csv",
    ];
    let (code, text, said) = run(&[&arguments[..], &["--start", "unknown"]].concat());
    assert_eq!((code, text.as_str()), (2, ""));
    assert!(
        said.contains("the motion cannot be known from an unknown start"),
        "{said}"
    );
    let (code, _, said) = run(&[&arguments[..], &["--step-ms", "0"]].concat());
    assert_eq!(code, 2);
    assert!(
        said.contains("--step-ms 0 is not between 0.01 and 20"),
        "{said}"
    );
    assert!(!folder.join("no.csv").exists());
}
