//! The spindle in the limits over time. Its power in a run-up is 9869.6 W/s·t
//! for 1 s, and the same backwards when it brakes.

use super::{FULL_W, machine, run};
use gwatt::pipeline::Options;

use crate::runs::once;

/// Limits of the converter: 4 s windows, half of the power of a run.
const LIMITS: &str = "continuous_power_w = 4934.802200544679\nwindow_s = 4\n\
                      overload = [{ power_w = 1e5, seconds = 10, every_s = 20 }]\n\
                      brake_power_w = 4934.802200544679\nbrake_energy_j = 1e5";

/// The ratings by their names: what counts in steps is up to 0.5 % too high, and
/// never too low.
#[track_caller]
fn ratings(controller: &str, spindle: &str, program: &str, expected: &[(&str, f64)]) {
    let machine = machine(controller, LIMITS, spindle, "");
    let (_, summary) = run(&machine, program, &once());
    for (name, expected) in expected {
        let found = summary
            .over_time
            .iter()
            .find(|it| it.rating.measure.name() == *name)
            .unwrap();
        let value = found.rating.value;
        let high = expected * 1.005;
        assert!(
            (expected * (1.0 - 1e-9)..=high).contains(&value),
            "{name}: {value}, not {expected}"
        );
    }
    let conditions = summary.conditions.join("\n");
    assert!(!conditions.contains("spindle's power"), "{conditions}");
}

/// ∫P² = P²/3 over 1 s of the window's 4; above the half for half a second;
/// beyond the half ½·½·P/2 on the way down.
#[test]
fn a_run_while_the_axes_rest() {
    let expected = [
        ("continuous-power", FULL_W / 12.0_f64.sqrt()),
        ("overload", 0.5),
        ("brake-energy", FULL_W / 8.0),
    ];
    let program = "M3 S3000\nG4 P3\nM5\nG4 P5\n";
    ratings("iso", "wait = false", program, &expected);
}

/// The wait is a second of its own, the axes at rest, whatever they do then.
#[test]
fn a_run_that_is_waited_for() {
    let expected = [
        ("continuous-power", FULL_W / 12.0_f64.sqrt()),
        ("overload", 0.5),
    ];
    let program = "M3 S3000\nG1 X5 F60\nG4 P5\n";
    ratings("iso", "wait = true", program, &expected);
}

/// X speeds up for 1 s, 1000 W at its end, while the spindle does.
#[test]
fn a_run_beside_a_rapid() {
    let above_s = 1.0 - 0.5 * FULL_W / (FULL_W + 1000.0);
    let program = "M3 S3000\nG0 X2000\nG4 P9\n";
    ratings("iso", "wait = false", program, &[("overload", above_s)]);
    // On the way back the spindle brakes for 1 s while X speeds up.
    let program = "M3 S3000\nG4 P9\nM5\nG0 X2000\nG4 P9\n";
    let expected = [("brake-energy", FULL_W / 8.0), ("overload", 0.5)];
    ratings("iso", "wait = false", program, &expected);
}

/// Under look-ahead a move's time is not known to the instant: the most that
/// the spindle may draw meanwhile counts.
#[test]
fn a_run_beside_moves_that_are_planned_together() {
    let machine = machine("linuxcnc", LIMITS, "wait = false", "");
    let program = "G64\nM3 S3000\nG0 X2000\nG0 X4000 Y100\nG4 P9\n";
    let (_, summary) = run(&machine, program, &once());
    let mut overload = summary.over_time.iter().map(|it| &it.rating);
    let overload = overload
        .rfind(|it| it.measure.name() == "overload")
        .unwrap();
    let above_s = 1.0 - 0.5 * FULL_W / (FULL_W + 1000.0);
    assert!(overload.value >= above_s, "{overload:?}");
    assert!(overload.value < 4.0, "{overload:?}");
}

/// A run that does not fit is among the moves that it is counted with.
#[test]
fn runs_that_do_not_fit_are_counted_as_moves() {
    let machine = machine(
        "iso",
        "",
        "wait = true",
        "[[load]]\non = \"M8\"\noff = \"M9\"\npower_w = 95000\n",
    );
    let (_, summary) = run(&machine, "M8\nM3 S3000\nG1 X5 F60\n", &Options::default());
    // The run, the wait for it, and the feed, which fits.
    assert_eq!((summary.unfit_count, summary.moves), (2, 3));
}

/// Loads that are switched and the base load of the spindle's drive count once.
#[test]
fn loads_beside_the_spindle() {
    let limits = "base_load_w = 500\ncontinuous_power_w = 100\nwindow_s = 1";
    let machine = machine("iso", limits, "wait = false\nbase_load_w = 250", "");
    let (_, summary) = run(&machine, "G4 P5\n", &Options::default());
    let rating = summary.over_time[0].rating;
    assert!((750.0..750.5).contains(&rating.value), "{rating:?}");
}
