//! Speeds found by measure where a controller plans moves together: short lines and arcs.

use std::io::{self, Cursor};

use gwatt::machine::Machine;
use gwatt::pipeline::{
    Allowed, Law, LimitOptions, LimitSummary, Options, Strategy, analyze, limit,
};

use crate::machines::{linear_axes, machine_from};

/// 20 kg by X and 30 kg by Y, 0.5 m/s and 3 m/s², with friction.
fn machine(controller: &str, peak_w: f64) -> Machine {
    machine_from(&format!(
        "schema = 1\nname = \"test\"\ncontroller = \"{controller}\"\n\
         [converter]\npeak_power_w = {peak_w:?}\nbase_load_w = 20\n[limits]\nmargin = 0\n{}{}",
        linear_axes(
            "X",
            [30000.0, 3000.0, 20.0],
            "coulomb_n = 20\nefficiency = 0.8"
        ),
        linear_axes(
            "Y",
            [30000.0, 3000.0, 30.0],
            "coulomb_n = 30\nefficiency = 0.8"
        )
    ))
}

/// Half a millimetre a block, and an arc at the end.
fn program(share: f64) -> String {
    format!(
        "G21\nG90\nG1 X-0.5313 Y0.6351 F{}\nG1 X-0.6663 Y0.8366\nG1 X-1.0765 Y1.1231\n\
         G3 X-1.4313 Y1.2025 I-0.2741 J-0.3925\n",
        (3e3 * share).floor()
    )
}

fn limited(machine: &Machine, allowed: Allowed, strategy: Strategy, text: &str) -> LimitSummary {
    let how = LimitOptions {
        strategy,
        law: Law::Exact,
        allowed,
        ..LimitOptions::USUAL
    };
    let input = Cursor::new(text.as_bytes());
    limit(input, machine, &Options::default(), how, io::sink(), None).expect("a program")
}

/// The shortest time with one factor on all feeds.
fn common_s(machine: &Machine) -> Option<f64> {
    let (mut low, mut high, mut found) = (0.0, 1.0, None);
    for _ in 0..9 {
        let share = f64::midpoint(low, high);
        let input = Cursor::new(program(share));
        let summary = analyze(input, machine, &Options::default(), None).expect("a program");
        if summary.fits() {
            (low, found) = (share, Some(summary.duration_s));
        } else {
            high = share;
        }
    }
    found
}

/// Each line by itself would have to be so slow that its neighbours, which accelerate from
/// there, exceed the limit in turn. More power is never slower, and no common factor sooner.
#[test]
fn short_lines_are_no_slower_than_by_one_factor() {
    let feeds = Allowed {
        feed: true,
        ..Allowed::NOTHING
    };
    for controller in ["grbl", "klipper"] {
        let mut slowest_s = 0.0;
        for peak_w in [26.2, 24.0, 22.5] {
            let machine = machine(controller, peak_w);
            let found = limited(&machine, feeds, Strategy::Speed, &program(1.0));
            let what = format!("{controller} {peak_w} {:?}", found.reasons);
            assert!(found.certified, "{what}");
            let lasts_s = found.after.duration_s;
            let common_s = common_s(&machine).expect(&what);
            assert!(lasts_s < 1.005 * common_s, "{what}: {lasts_s} {common_s}");
            assert!(lasts_s > 0.995 * slowest_s, "{what}: {lasts_s} {slowest_s}");
            slowest_s = f64::max(slowest_s, lasts_s);
        }
        assert!(slowest_s > 0.06, "{slowest_s}");
    }
}

/// What is found so is written once: twice the same, and without permission nothing.
#[test]
fn without_permission_feeds_stay() {
    let machine = machine("grbl", 24.0);
    let found = limited(&machine, Allowed::NOTHING, Strategy::Speed, &program(1.0));
    assert!(!found.certified);
    assert!(
        found
            .reasons
            .iter()
            .all(|reason| reason.rule == "feed-not-allowed")
    );
}
