//! Constant surface speed at lower overrides: whether the clamp is turned down with the speed
//! is not known.

use std::fmt::Write as _;

use gwatt::interpret::MoveKind;
use gwatt::machine::Machine;
use gwatt::pipeline::Options;
use proptest::prelude::*;

use super::{machine, near, run, with_limits};
use crate::runs::turned;

/// 100 m/min, at most 500/min: 52.36 rad/s from 31.8 mm on, where following takes
/// J·V²·vr/r³ = 258 W at the largest override. Turned down it still speeds up at 20 mm, to no
/// more than the clamp: J·ω²·vr/r = 411.2 W. The slide takes 30 W; the run up, 10.47 N·m, 349 W.
#[test]
fn a_clamp_that_is_not_turned_down_is_reached_later() {
    let mut lathe = machine("linuxcnc", "", "", "");
    if let Some(spindle) = &mut lathe.spindle {
        spindle.accel_time_s = Some(3.0);
    }
    let program = "G18 G61.1 G8\nG0 X50\nG96 D500 S100 M3\nG4 P5\nG1 X20 F1800\nG1 X50\n";
    let omega = 500.0 * std::f64::consts::TAU / 60.0;
    let most_w = 0.1 * omega * omega * 0.03 / 0.02 + 30.0;
    let found =
        |limits_w: [f64; 2]| run(&with_limits(&lathe, limits_w), program, &Options::default());
    let (rows, summary) = found([most_w - 1.0, 1e5]);
    assert_eq!(summary.unfit_count, 1);
    near(rows[2].peak_w, most_w);
    let (rows, summary) = found([1e5, most_w - 1.0]);
    assert_eq!(summary.unfit_count, 1);
    near(rows[3].regen_w, most_w);
    // What fits at any override is shown at the largest.
    let (rows, summary) = found([most_w + 1.0; 2]);
    assert_eq!(summary.unfit_count, 0);
    let (v, clamp) = (100.0 / 60.0, 100.0 / 60.0 / omega);
    near(rows[2].peak_w, 0.1 * v * v * 0.03 / clamp.powi(3) + 30.0);
}

/// At 1000 m/min the clamp holds from 318 mm on: at the largest override nothing follows X.
/// Turned down to 62.8 m/min the spindle follows it as above.
#[test]
fn a_clamp_that_holds_all_along_is_left_where_the_speed_is_turned_down() {
    let mut lathe = machine("linuxcnc", "", "", "");
    if let Some(spindle) = &mut lathe.spindle {
        spindle.accel_time_s = Some(3.0);
    }
    let program = "G18 G61.1 G8\nG0 X50\nG96 D500 S1000 M3\nG4 P5\nG1 X20 F1800\nG1 X50\n";
    let omega = 500.0 * std::f64::consts::TAU / 60.0;
    let most_w = 0.1 * omega * omega * 0.03 / 0.02 + 30.0;
    let feeds = |limits_w: [f64; 2]| {
        let (rows, _) = run(&with_limits(&lathe, limits_w), program, &Options::default());
        let feeds = rows.iter().filter(|row| row.kind == MoveKind::Feed);
        feeds
            .map(|row| [row.peak_w, row.regen_w])
            .collect::<Vec<_>>()
    };
    near(feeds([most_w - 1.0, 1e5])[0][0], most_w);
    near(feeds([1e5, most_w - 1.0])[1][1], most_w);
    // What fits at any override is shown at the largest.
    let fits = feeds([most_w + 1.0; 2]);
    near(fits[0][0], 30.0);
    near(fits[1][1], 30.0);
}

/// The clamp holds all along. With S at half of it, and the clamp left where it is, X moves in
/// faster than 500/min per second can follow: the spindle still runs up while Z starts.
#[test]
fn a_spindle_that_cannot_follow_at_a_lower_override_lags_into_the_next_move() {
    let mut lathe = machine("linuxcnc", "", "", "");
    if let Some(spindle) = &mut lathe.spindle {
        spindle.accel_time_s = Some(6.0);
    }
    let program = |surface: u32| {
        format!("G18 G61.1 G8\nG0 X31\nG96 D500 S{surface} M3\nG4 P9\nG1 X16 F6000\nG0 Z10\n")
    };
    // The run takes 5.24 N·m up to 52.4 rad/s, 274 W, and Z 100 W.
    let limited = with_limits(&lathe, [300.0, 1e5]);
    let z_w = |machine: &Machine, surface: u32| {
        let (rows, _) = run(machine, &program(surface), &Options::default());
        rows.last().expect("a move of Z").peak_w
    };
    let largest = turned(&limited, [1.0; 3]);
    assert!(z_w(&largest, 50) > 300.0);
    near(z_w(&largest, 100), 100.0);
    assert!(z_w(&limited, 100) > 300.0);
}

/// Z brakes from 1 m/s and gives back 1000 W next to a spindle that hardly changes at 20 mm, 3 N·m at 83.3 rad/s: 250 W are credited, and nothing of them where it is turned
/// down.
#[test]
fn what_the_spindle_takes_is_not_credited_where_it_is_turned_down() {
    let lathe = machine("linuxcnc", "credit_regen = true", "friction_nm = 3", "");
    let program =
        "G18 G61.1 G8\nG0 X20\nG96 D3000 S100 M3\nG4 P5\nG1 Z2000 F60000\nG1 X20.001 Z0\n";
    let found = |limit_w: f64| {
        run(
            &with_limits(&lathe, [1e5, limit_w]),
            program,
            &Options::default(),
        )
    };
    let fed_back_w = |limit_w: f64| {
        let (rows, _) = found(limit_w);
        let mut feeds = rows.iter().filter(|row| row.kind == MoveKind::Feed);
        feeds.next_back().expect("a feed").regen_w
    };
    assert!((fed_back_w(990.0) - 1000.0).abs() < 1.0);
    // What fits at any override is shown at the largest.
    assert!((fed_back_w(1001.0) - 750.0).abs() < 1.0);
}

/// A line of a program: what stands in `{}` is a speed of the spindle or of the surface.
fn any_line() -> impl Strategy<Value = (String, f64)> {
    let plain = |text: String| (text, 0.0);
    prop_oneof![
        3 => (5..300_i32).prop_map(move |x| plain(format!("G0 X{x}"))),
        2 => (5..300_i32, -300..300_i32).prop_map(move |(x, z)| plain(format!("G0 X{x} Z{z}"))),
        6 => (2..300_i32, 500..20000_u32).prop_map(move |(x, f)| plain(format!("G1 X{x} F{f}"))),
        2 => (-300..300_i32, 500..40000_u32).prop_map(move |(z, f)| plain(format!("G1 Z{z} F{f}"))),
        1 => (1..10_u32).prop_map(move |t| plain(format!("G4 P0.{t}"))),
        2 => (300..3000_u32, 20..300_u32)
            .prop_map(|(most, v)| (format!("G96 D{most} S{{}}"), f64::from(v))),
        1 => (100..3000_u32).prop_map(|n| ("G97 S{}".to_owned(), f64::from(n))),
        1 => prop_oneof![Just("M3"), Just("M4"), Just("M5"), Just("G4 P3")]
            .prop_map(move |word| plain(word.to_owned())),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    /// What fits at every override fits at each, whether the clamp is turned down or not.
    #[test]
    fn what_fits_at_all_overrides_fits_at_each(
        lines in prop::collection::vec(any_line(), 2..10),
        wait in prop::sample::select(vec!["false", "true"]),
        credit in any::<bool>(),
        most in prop::sample::select(vec![100, 120]),
        knobs in prop::collection::vec((0.03..1.0_f64, 0.03..1.0_f64, 0.03..1.0_f64), 8),
        tight in 0.0..1.0_f64,
    ) {
        let lathe = machine(
            "linuxcnc",
            &format!("credit_regen = {credit}"),
            &format!("friction_nm = 3\nbase_rpm = 1500\nwait = {wait}\nefficiency = 0.9"),
            &format!("override_max_percent = {{ spindle = {most} }}"),
        );
        let largest = f64::from(most) / 100.0;
        let program = |share: f64| {
            let mut text = String::from("G18 G61.1 G8\nG0 X50\nG96 D2000 S100 M3\nG4 P3\n");
            for (line, speed) in &lines {
                let _ = writeln!(text, "{}", line.replace("{}", &format!("{:.9}", speed * share)));
            }
            text
        };
        let peaks = |machine: &Machine, program: &str| {
            let (rows, _) = run(machine, program, &Options::default());
            rows.iter().fold([0.0_f64; 2], |peaks, row| {
                [peaks[0].max(row.peak_w), peaks[1].max(row.regen_w)]
            })
        };
        let mut found = Vec::new();
        for &(feed, rapid, share) in &knobs {
            for [feed, rapid] in [[feed, feed], [feed, 1.0], [1.0, rapid], [1.0, 1.0]] {
                let lower = turned(&lathe, [feed, rapid, share * largest]);
                found.push(peaks(&lower, &program(1.0)));
                // The same speeds, but for the clamp.
                let scaled = turned(&lathe, [feed, rapid, 1.0]);
                found.push(peaks(&scaled, &program(share * largest)));
            }
        }
        let text = program(1.0);
        let own = peaks(&lathe, &text);
        for side in [0, 1] {
            let most = found.iter().fold(own[side], |most, peaks| most.max(peaks[side]));
            let limit_w = own[side] + tight * (most - own[side]);
            if limit_w * (1.0 + 1e-6) >= most || limit_w <= 0.0 {
                continue;
            }
            let mut limits_w = [1e6; 2];
            limits_w[side] = limit_w;
            let (_, summary) = run(&with_limits(&lathe, limits_w), &text, &Options::default());
            prop_assert!(
                summary.unfit_count > 0,
                "side {side}: fits {limit_w}, but another override asks for {most}\n{text}"
            );
        }
    }
}
