//! Limits over time and series from outside: what the commands say and write.

mod figures;
mod lower;
mod overrides;
mod voltage;
mod worked;

use crate::shop::{Shop, ended, gwatt};

/// A mill whose converter has `ratings`; `rest` comes after it.
fn mill(controller: &str, rest: &str, ratings: &str) -> Shop {
    Shop::mill(controller, ratings, rest, "")
}

/// X alone to 0.5 m/s at 3 m/s²: 0.167 s, F = 700 N, 437.5 W and the base load.
const THERE_AND_BACK: &str = "G21 G90 G94\nG0 X400\nG0 X0\nG0 X400\nG0 X0\nM30\n";

/// 0.25 m/s by 700 N with an efficiency of 0.8, and the base load.
#[test]
fn a_single_override_is_shown() {
    let shop = mill("iso", "", "peak_power_w = 500");
    shop.put("a.ngc", THERE_AND_BACK);
    let (code, reported, _) = shop.run("check a.ngc");
    assert_eq!(code, 1);
    assert!(reported.contains("peak 538 W"), "{reported}");
    let (code, reported, _) = shop.run("check a.ngc --override 50%");
    assert_eq!(code, 0);
    assert!(reported.contains("peak 319 W"), "{reported}");
    let (_, reported, _) = shop.run("check a.ngc --override feed=10%,rapid=50%");
    assert!(reported.contains("peak 319 W"), "{reported}");
    let (code, _, reported) = shop.run("check a.ngc --override rapid=120%");
    assert_eq!(code, 2);
    assert!(reported.contains("no override exceeds it"), "{reported}");
    let above = |overrides: &str| {
        let (_, _, notes) = shop.run(&format!("check a.ngc --override {overrides}"));
        notes.contains("override-above-largest")
    };
    assert!(above("150%") && !above("100%"));
}

#[test]
fn an_overload_is_told_and_lowered_away() {
    // Above 300 W, of 537.5 W: 0.0905 s of each ramp, four of them in 3.87 s, and
    // eleven in 10 s where the program runs again at once.
    let ratings = "peak_power_w = 1000\ncontinuous_power_w = 300\n\
                   overload = [{ power_w = 1000, seconds = 0.2, every_s = 10 }]";
    let shop = mill("iso", "", ratings);
    shop.put("a.ngc", THERE_AND_BACK);
    let (code, reported, _) = shop.run("check a.ngc");
    assert_eq!(code, 1);
    assert!(
        reported.starts_with("a.ngc: does not fit: peak 538 W of 1.00 kW (line 2)"),
        "{reported}"
    );
    let overload = reported.lines().nth(1).unwrap();
    assert!(
        overload.contains("overload above 300 W within 10 s"),
        "{reported}"
    );
    assert!(overload.contains("1.00 s of 0.20 s"), "{reported}");
    let (code, once, _) = shop.run("check a.ngc --once");
    assert_eq!(code, 1);
    assert!(once.contains("0.36 s of 0.20 s"), "{once}");
    assert!(overload.contains("line 5 at "), "{reported}");
    assert!(
        overload.contains("does not fit → lower speeds"),
        "{reported}"
    );
    assert!(
        reported
            .lines()
            .nth(2)
            .unwrap()
            .contains("continuous power over 3 min"),
        "{reported}"
    );

    let (code, _, reported) = shop.run("limit a.ngc -o b.ngc");
    assert_eq!(code, 0, "{reported}");
    let (code, reported, _) = shop.run("check b.ngc");
    assert_eq!(code, 0, "{reported}");
    // A lower peak than needed would take longer.
    let used: f64 = reported
        .lines()
        .find(|line| line.contains("overload"))
        .and_then(|line| {
            line.split("10 s")
                .nth(1)?
                .trim()
                .split(' ')
                .next()?
                .parse()
                .ok()
        })
        .unwrap();
    assert!(used > 0.1, "{reported}");

    for format in ["json", "sarif", "junit", "github"] {
        let (code, reported, _) = shop.run(&format!("check a.ngc --format {format}"));
        assert_eq!(code, 1);
        assert!(reported.contains("overload"), "{format}: {reported}");
    }
    let (_, reported, _) = shop.run("check a.ngc --format json");
    let reported: serde_json::Value = serde_json::from_str(&reported).unwrap();
    let found = &reported[0]["over_time"][0];
    assert_eq!(found["check"], "overload");
    assert_eq!(found["unit"], "s");
    assert_eq!(found["fits"], false);
    assert_eq!(found["line"], 5);
    assert_eq!(reported[0]["fits"], false);
}

/// Braking feeds 200 W back, less and less over 1/6 s: 15.04 J above 10 W, and 0.04 J below.
/// The 0.8 s to the next braking take 8 J off, and the dwell takes all. Of two brakings one
/// after the other 22.04 J are left, and 36.12 J of four: those at the end of a run, and
/// those at the beginning of the next one.
#[test]
fn braking_at_the_end_and_at_the_beginning_add_up_where_a_program_runs_again() {
    let ratings = "peak_power_w = 1000\nbrake_power_w = 10\nbrake_energy_j = 30";
    let shop = mill("iso", "", ratings);
    shop.put(
        "a.ngc",
        "G21 G90 G94\nG0 X400\nG0 X0\nG4 P5\nG0 X400\nG0 X0\nM30\n",
    );
    let braked = |options: &str| {
        let command = format!("check a.ngc --override 100% --format json {options}");
        let (code, reported, _) = shop.run(command.trim_end());
        let reported: serde_json::Value = serde_json::from_str(&reported).unwrap();
        let limits = reported[0]["over_time"].as_array().unwrap();
        let found = limits
            .iter()
            .find(|it| it["check"] == "brake-energy")
            .unwrap();
        (code, found["value"].as_f64().unwrap())
    };
    let kept = 0.5 * 190.0 * (190.0 / 200.0) / 6.0;
    let lost = 0.8 * 10.0 + 0.5 * 10.0 * (10.0 / 200.0) / 6.0;
    for (options, fits, expected_j) in [
        ("--once", true, 2.0 * kept - lost),
        ("", false, 4.0 * kept - 3.0 * lost),
    ] {
        let (code, found_j) = braked(options);
        assert_eq!(code == 0, fits, "{found_j}");
        // What is fed back is counted in slices of 1 per mille of the converter's power.
        assert!(
            found_j >= expected_j - 1e-6 && found_j < expected_j * 1.03,
            "{found_j} {expected_j}"
        );
    }
}

#[test]
fn what_cannot_be_lowered_is_refused_with_the_reason() {
    let shop = mill("iso", "", "peak_power_w = 1000\ncontinuous_power_w = 90");
    shop.put("a.ngc", THERE_AND_BACK);
    let (code, _, reported) = shop.run("limit a.ngc -o b.ngc");
    assert_eq!(code, 1);
    assert!(!shop.has("b.ngc"));
    assert!(reported.contains("continuous-power"), "{reported}");
    assert!(
        reported.contains("continuous power over 3 min: "),
        "{reported}"
    );
    assert!(reported.contains(" W of 90"), "{reported}");
}

/// Far above what it bears continuously the converter may give peaks that do not last: the
/// speeds come down to a small share of them.
#[test]
fn continuous_power_far_below_the_peaks() {
    let mut shares = Vec::new();
    for peak_w in [20_000.0, 1_000.0] {
        let shop = mill(
            "iso",
            "",
            &format!("peak_power_w = {peak_w}\ncontinuous_power_w = 115"),
        );
        shop.put("a.ngc", THERE_AND_BACK);
        let (code, _, reported) = shop.run("limit a.ngc -o b.ngc");
        assert_eq!(code, 0, "{reported}");
        shares.push(shop.get("b.ngc"));
    }
    assert!(shares.iter().all(|text| text.contains("G1 ")), "{shares:?}");
}

#[test]
fn a_capacitor_carries_peaks_only_where_it_may() {
    // 237.5 W beyond 300 W at the end of 90.5 ms: 10.7 J. From 600 to 580 V
    // 1 mF gives 11.8 J.
    let bus = "peak_power_w = 300\nregen_power_w = 1000\ncapacitance_f = 1e-3\n\
               bus_nominal_v = 600\nbus_min_v = 580";
    let strict = mill("iso", "", bus);
    strict.put("a.ngc", THERE_AND_BACK);
    let (code, reported, _) = strict.run("check a.ngc");
    assert_eq!(code, 1);
    assert!(
        reported.contains("lowest bus voltage  582 V, at least 580 V"),
        "{reported}"
    );
    let credited = mill("iso", "", &format!("{bus}\ncredit_capacitance = true"));
    credited.put("a.ngc", THERE_AND_BACK);
    let (code, reported, _) = credited.run("check a.ngc");
    assert_eq!(code, 0, "{reported}");
    let (code, _, reported) = credited.run("limit a.ngc -o b.ngc");
    assert_eq!(code, 0, "{reported}");
    assert_eq!(credited.get("b.ngc"), THERE_AND_BACK);
    // Half the capacitance is not enough: lowered, but not to 300 W.
    let half = bus.replace("1e-3", "5e-4");
    let half = mill("iso", "", &format!("{half}\ncredit_capacitance = true"));
    half.put("a.ngc", THERE_AND_BACK);
    assert_eq!(half.run("check a.ngc").0, 1);
    let (code, _, reported) = half.run("limit a.ngc -o b.ngc");
    assert_eq!(code, 0, "{reported}");
    let (code, reported, _) = half.run("check b.ngc");
    assert_eq!(code, 0, "{reported}");
    let peak: f64 = reported
        .split("peak ")
        .nth(1)
        .unwrap()
        .split(' ')
        .next()
        .unwrap()
        .parse()
        .unwrap();
    assert!(peak > 310.0 && peak < 500.0, "{reported}");
}

/// Lines, corners that are rounded, arcs, a dwell and a rapid.
const ROUND: &str = "G21 G90 G94 G17 G64 P0.05\nG0 X20 Y10 Z5\nG1 X60 F6000\nG1 Y40\nG3 X40 Y60 I-20\n\
                     G2 X20 Y40 J-20 F3000\nG4 P0.25\nG1 Z0 F600\nG0 X0 Y0\nM30\n";

/// The rows of a series with a value in the first column, as numbers after it.
pub(crate) fn rows(text: &str, program: &str) -> Vec<Vec<f64>> {
    text.lines()
        .filter_map(|line| line.strip_prefix(program)?.strip_prefix(','))
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect()
}

#[test]
fn a_series_adds_up_to_the_report() {
    for (controller, program) in [("linuxcnc", ROUND), ("iso", THERE_AND_BACK)] {
        let ratings = "peak_power_w = 2000\ncontinuous_power_w = 2000";
        let shop = mill(controller, "", ratings);
        shop.put("a.ngc", program);
        let (code, _, reported) =
            shop.run("report a.ngc --json a.json --series a.csv --step-ms 0.2 --limited a.ngc");
        assert_eq!(code, 0, "{reported}");
        let report: serde_json::Value = serde_json::from_str(&shop.get("a.json")).unwrap();
        let series = shop.get("a.csv");
        let header: Vec<&str> = series.lines().next().unwrap().split(',').collect();
        assert_eq!(
            header[..4],
            ["program", "time_s", "line", "x_velocity_mm_s"]
        );
        assert_eq!(header[header.len() - 2..], ["bus_w", "regen_w"]);
        let before = rows(&series, "before");
        assert_eq!(before, rows(&series, "after"));
        let close = |found: f64, key: &str, share: f64| {
            let reported = report[key].as_f64().unwrap();
            assert!(
                (found - reported).abs() <= share * reported,
                "{key}: {found} is not {reported}"
            );
        };
        let bus = header.len() - 3;
        close(before.last().unwrap()[0], "duration_s", 1e-9);
        let peak = before.iter().map(|row| row[bus]).fold(0.0, f64::max);
        close(peak, "peak_w", 1e-4);
        let mut energy = 0.0;
        for pair in before.windows(2) {
            let dt = pair[1][0] - pair[0][0];
            assert!((0.0..=0.2e-3 + 1e-12).contains(&dt));
            energy += 0.5 * dt * (pair[0][bus] + pair[1][bus]);
            for axis in 0..3 {
                let (v, a) = (2 + 4 * axis, 3 + 4 * axis);
                let change = 0.5 * dt * (pair[0][a] + pair[1][a]);
                let off = (pair[1][v] - pair[0][v] - change).abs();
                assert!(off < 1e-3, "speed jumps by {off} mm/s at {} s", pair[0][0]);
            }
        }
        close(energy, "energy_j", 1e-4);
        // The mean square of what is shown is that of the slices, which are no
        // lower, and on arcs and blends higher by 2 W at most.
        let squares = before.windows(2).map(|pair| {
            let (a, b) = (pair[0][bus], pair[1][bus]);
            (pair[1][0] - pair[0][0]) * (a * a + a * b + b * b) / 3.0
        });
        let shown = (squares.sum::<f64>() / before.last().unwrap()[0]).sqrt();
        let rated = report["over_time"][0]["value"].as_f64().unwrap();
        assert_eq!(report["over_time"][0]["check"], "continuous-power");
        assert!(
            rated >= shown - 1e-3 && rated <= shown + 2.0,
            "{rated} {shown}"
        );
        // Jumps have both their sides.
        let jumps = before.windows(2).filter(|pair| pair[0][0] == pair[1][0]);
        assert!(jumps.count() > 4);
    }
}

#[test]
fn a_series_shows_the_limited_program_too() {
    let shop = mill("iso", "", "peak_power_w = 350\nregen_power_w = 1000");
    shop.put("a.ngc", THERE_AND_BACK);
    let (code, out, _) = shop.run("report a.ngc --series a.csv --step-ms 5");
    assert_eq!((code, out.as_str()), (0, ""));
    let series = shop.get("a.csv");
    let peak = |program| {
        let rows = rows(&series, program);
        rows.iter()
            .map(|row| row[row.len() - 2])
            .fold(0.0, f64::max)
    };
    assert!((peak("before") - 537.5).abs() < 1e-6);
    assert!(peak("after") <= 350.0 + 1e-6 && peak("after") > 300.0);
    shop.run("report a.ngc --series b.csv --step-ms 5");
    assert_eq!(series, shop.get("b.csv"));
    // What cannot be limited is shown as it is.
    let shop = mill("iso", "", "peak_power_w = 350");
    shop.put("a.ngc", "G21 G90 G94\nG1 X100 F20000\nM30\n");
    let (code, _, reported) = shop.run("report a.ngc --series a.csv");
    assert_eq!(code, 0);
    assert!(
        reported.contains("the series shows it only as it is"),
        "{reported}"
    );
    assert!(rows(&shop.get("a.csv"), "after").is_empty());
    let (code, _, reported) = shop.run("report a.ngc --series a.csv --allow feed");
    assert_eq!(code, 0, "{reported}");
    assert!(!rows(&shop.get("a.csv"), "after").is_empty());
    // All that `limit` may be allowed.
    let cycle =
        "G21 G90 G64\nG0 X0. Y0. Z50.\nG98 G81 X300. Y200. Z-5. R2. F500.\nG80\nG0 Z50.\nM30\n";
    let shop = Shop::straight("fanuc", 300.0);
    shop.put("a.ngc", cycle);
    for (allow, limits) in [("feed", false), ("feed,expand", true)] {
        let asked = format!("report a.ngc --series a.csv --step-ms 20 --allow {allow}");
        let (code, _, reported) = shop.run(&asked);
        assert_eq!(code, 0, "{reported}");
        let after = rows(&shop.get("a.csv"), "after");
        assert_eq!(!after.is_empty(), limits, "{allow}: {reported}");
    }
}

#[test]
fn a_series_is_whole_or_not_there() {
    let shop = mill("iso", "", "peak_power_w = 1000");
    shop.put("a.ngc", "G21\nG0 X1\nG0 Q7\n");
    let (code, ..) = shop.run("report a.ngc --series a.csv");
    assert_eq!(code, 2);
    shop.put("b.ngc", "G21\nG4 P1000000000\n");
    let (code, _, reported) = shop.run("report b.ngc --series b.csv --step-ms 0.001");
    assert_eq!(code, 0);
    assert!(
        reported.contains("a longer --step-ms gives even rows"),
        "{reported}"
    );
    assert!(shop.get("b.csv").lines().count() < 600_000);
    assert!(!shop.has("a.csv"));
    for (arguments, message) in [
        (
            "report a.ngc --series a.csv --step-ms 0",
            "a number from 0.001 to 1000000",
        ),
        ("report a.ngc --step-ms 1", "--series"),
        ("report a.ngc --series a.ngc", "a.ngc"),
    ] {
        let (code, _, reported) = shop.run(arguments);
        assert_eq!(code, 2);
        assert!(reported.contains(message), "{reported}");
    }
}

/// A machine whose converter bears less ceases to fit a program whose moves all
/// fit.
#[test]
fn machines_are_compared_by_their_limits_over_time_too() {
    let shop = mill("iso", "", "peak_power_w = 1000");
    shop.put("a.ngc", THERE_AND_BACK);
    let text = shop.get("mill.toml");
    let weaker = "peak_power_w = 1000\ncontinuous_power_w = 90";
    shop.put("weak.toml", &text.replace("peak_power_w = 1000", weaker));
    let diff = |from: &str, to: &str| {
        let mut command = gwatt(shop.0.path(), ["diff", "a.ngc", "--from", from, "--to", to]);
        let (code, reported, _) = ended(command.args(["--csv", "diff.csv"]).output().unwrap());
        (code, reported)
    };
    let (code, reported) = diff("mill.toml", "weak.toml");
    assert_eq!(code, 1, "{reported}");
    let ceases = "a.ngc: continuous power over 3 min ceases to fit\n";
    assert!(reported.ends_with(ceases), "{reported}");
    assert!(shop.get("diff.csv").ends_with(",0,0,0,0,0,1\r\n"));
    let (code, reported) = diff("weak.toml", "mill.toml");
    assert_eq!(code, 0, "{reported}");
    assert!(reported.contains("3 min begins to fit\n"), "{reported}");
    let (code, reported) = diff("weak.toml", "weak.toml");
    assert_eq!(code, 0, "{reported}");
    assert!(!reported.contains("3 min"), "{reported}");
}
