//! Limits of jerk and curves of force from outside: what the commands say of
//! programs on such machines.

use std::fmt::Write as _;

use crate::near::assert_near;
use crate::over_time::rows;
use crate::shop::Shop;

/// A control that takes corners at a step of speed of 5 mm/s, arcs as arcs.
const AHEAD: &str = "\n[planner.look_ahead]\n[planner.look_ahead.speed_step]\n\
                     step_mm_s = { X = 5, Y = 5, Z = 5 }\n";

/// A mill with further lines for each axis, and `rest` in its converter.
fn mill(controller: &str, axis: &str, rest: &str) -> Shop {
    let shop = Shop::mill(controller, rest, "", axis);
    let iso = include_str!("../machine-configs/controllers/iso.toml");
    shop.put("ahead.toml", &format!("{iso}{AHEAD}"));
    shop
}

/// The report of a program.
fn reported(shop: &Shop, program: &str) -> serde_json::Value {
    shop.put("a.ngc", program);
    let (code, _, shown) = shop.run("report a.ngc --json a.json");
    assert_eq!(code, 0, "{shown}");
    serde_json::from_str(&shop.get("a.json")).unwrap()
}

fn duration_s(shop: &Shop, program: &str) -> f64 {
    reported(shop, program)["duration_s"].as_f64().unwrap()
}

#[track_caller]
fn close(found: f64, expected: f64) {
    assert_near(found, expected, 1e-6 * expected.abs());
}

const JERK: &str = "jerk_mm_s3 = 30000";
const STRONG: &str = "peak_power_w = 1e6\nregen_power_w = 1e6";
const THERE_AND_BACK: &str = "G21 G90 G94\nG0 X400\nG0 X0\nG0 X400 Y30\nG0 X0\nM30\n";

/// 500 mm/s after 1/6 + 0.1 s over 66.67 mm; 266.67 mm of cruise.
#[test]
fn a_rapid_is_an_s_curve() {
    let shop = mill("iso", JERK, STRONG);
    let report = reported(&shop, "G21 G90\nG0 X400\nM30\n");
    close(
        report["duration_s"].as_f64().unwrap(),
        0.8 + 1.0 / 6.0 + 0.1,
    );
    // P = (v − j·τ²/2)·(m·j·τ + Fc), largest at τ* before the end of the ramp.
    let (v, j, m, d) = (0.5, 30.0, 200.0, 100.0);
    let tau = f64::min(
        (f64::sqrt(d * d + 6.0 * m * m * j * v) - d) / (3.0 * m * j),
        0.1,
    );
    let peak = (v - 0.5 * j * tau * tau) * (m * j * tau + d) / 0.8 + 100.0;
    close(report["peak_w"].as_f64().unwrap(), peak);
    let conditions = report["conditions"].to_string();
    assert!(
        conditions.contains("speed follows S-curves, from rest to rest"),
        "{conditions}"
    );
    let (_, out, _) = shop.run("moves a.ngc");
    let row: serde_json::Value = serde_json::from_str(out.lines().next().unwrap()).unwrap();
    close(row["seconds"].as_f64().unwrap(), 0.8 + 1.0 / 6.0 + 0.1);
    let plain = reported(
        &mill("iso", "jerk_mm_s3 = 0", STRONG),
        "G21 G90\nG0 X400\nM30\n",
    );
    close(plain["duration_s"].as_f64().unwrap(), 0.8 + 1.0 / 6.0);
    assert!(!plain["conditions"].to_string().contains("jerk"));
}

#[test]
fn rapids_are_limited_under_limits_of_jerk() {
    let curve = "force_curve = [{ speed_mm_min = 0, force_n = 650 }, \
                 { speed_mm_min = 12000, force_n = 650 }, { speed_mm_min = 30000, force_n = 300 }]";
    for (axis, most) in [(JERK, 350.0), (curve, 250.0)] {
        let weak = format!("peak_power_w = {most}\nregen_power_w = 1000");
        let shop = mill("iso", axis, &weak);
        shop.put("a.ngc", THERE_AND_BACK);
        let (code, out, shown) = shop.run("limit a.ngc --json a.json");
        assert_eq!(code, 0, "{shown}");
        assert!(out.contains("G1"), "{out}");
        let report: serde_json::Value = serde_json::from_str(&shop.get("a.json")).unwrap();
        let after = report["peak_after_w"].as_f64().unwrap();
        assert!(
            after <= most * (1.0 + 1e-9) && after > 0.9 * most,
            "{after}"
        );
        shop.put("b.ngc", &out);
        let (code, ..) = shop.run("check b.ngc");
        assert_eq!(code, 0);
        let (code, again, _) = shop.run("limit b.ngc");
        assert_eq!((code, again), (0, out));
    }
}

/// A line in many blocks runs as one, with one S-curve over all of them.
#[test]
fn joints_that_limit_nothing_leave_no_trace() {
    let shop = mill("ahead.toml", JERK, STRONG);
    let one = duration_s(&shop, "G21 G90 G94 G64\nG1 X100 F9000\nM30\n");
    // 150 mm/s without reaching the acceleration: 2·√(150/30000) s.
    let ramp_s = 2.0 * f64::sqrt(150.0 / 30e3);
    close(one, 100.0 / 150.0 + ramp_s);
    let mut many = "G21 G90 G94 G64 F9000\n".to_owned();
    for i in 1..=1000 {
        let _ = writeln!(many, "G1 X{}", 0.1 * f64::from(i));
    }
    let report = reported(&shop, &format!("{many}M30\n"));
    close(report["duration_s"].as_f64().unwrap(), one);
    assert_eq!(report["certificate"], "planned");
    let conditions = report["conditions"].to_string();
    assert!(
        conditions.contains("passed without acceleration along the path"),
        "{conditions}"
    );
    // The series: acceleration never jumps.
    let (code, _, shown) = shop.run("report a.ngc --series a.csv --step-ms 0.5");
    assert_eq!(code, 0, "{shown}");
    let rows = rows(&shop.get("a.csv"), "before");
    close(rows.last().unwrap()[0], one);
    for pair in rows.windows(2) {
        let jerk = (pair[1][3] - pair[0][3]).abs();
        assert!(
            jerk <= 30_000.0 * (pair[1][0] - pair[0][0]) + 1e-3,
            "{pair:?}"
        );
    }
}

/// Rounded corners, arcs and steps of feed, through every planner.
fn pocket() -> String {
    let mut text = "G21 G90 G94 G17\nG0 X0 Y0 Z5\nG64\nG1 Z-1 F600\n".to_owned();
    for i in 0..6 {
        let r = 10.0 + 4.0 * f64::from(i);
        let _ = writeln!(
            text,
            "G1 X{r} Y0 F{}\nG3 X0 Y{r} I{} J0\nG1 X-{r}\nG1 Y-{r} F9000\nG1 X{r} Y-{r}\nG2 X{r} Y0 I0 J{}",
            6000 + 900 * i,
            -r,
            0.5 * r,
        );
    }
    text.push_str("G0 Z5\nM30\n");
    text
}

#[test]
fn programs_are_limited_under_look_ahead_too() {
    for controller in ["ahead.toml", "grbl", "linuxcnc", "iso"] {
        for axis in [
            JERK,
            "force_curve = [{ speed_mm_min = 0, force_n = 650 }, { speed_mm_min = 30000, force_n = 300 }]",
            "jerk_mm_s3 = 80000\nforce_curve = [{ speed_mm_min = 0, force_n = 650 }, { speed_mm_min = 30000, force_n = 300 }]",
        ] {
            let shop = mill(controller, axis, "peak_power_w = 200\nregen_power_w = 1000");
            let free = mill(controller, axis, STRONG);
            let plain = mill(controller, "", STRONG);
            // No rapid after an arc: at its corner it could not become a feed.
            let program = pocket().replace("G0 Z5\nM30", "G1 Z5\nM30");
            let program = if controller == "grbl" {
                program.replace("G64\n", "")
            } else {
                program
            };
            let [slow, fast] = [&free, &plain].map(|shop| duration_s(shop, &program));
            assert!(slow > fast, "{controller} {axis}: {slow} {fast}");
            shop.put("a.ngc", &program);
            let (code, out, shown) = shop.run("limit a.ngc --allow feed --json a.json");
            assert_eq!(code, 0, "{controller} {axis}: {shown}");
            shop.put("b.ngc", &out);
            let (code, shown, _) = shop.run("check b.ngc");
            assert_eq!(code, 0, "{controller} {axis}: {shown}");
            let report: serde_json::Value = serde_json::from_str(&shop.get("a.json")).unwrap();
            let after = report["peak_after_w"].as_f64().unwrap();
            assert!(after <= 200.0 * (1.0 + 1e-9), "{after}");
        }
    }
}

/// A slower arc leaves more of its jerk to the acceleration along the path.
#[test]
fn a_slower_arc_may_speed_up_harder() {
    let shop = Shop::mill("isg", "", "", "");
    shop.put(
        "mill.toml",
        "schema = 1\nname = \"arcs\"\ncontroller = \"isg\"\n[converter]\npeak_power_w = 850\n\
         base_load_w = 780\n[path]\nmode = \"exact-stop\"\n[limits]\nmargin = 0\n\
         [axes.X]\nrapid_mm_min = 108000\naccel_mm_s2 = 13000\nmass_kg = 2.5\n\
         coulomb_n = 5\njerk_mm_s3 = 2300000\n[axes.Y]\nrapid_mm_min = 36000\n\
         accel_mm_s2 = 15000\nmass_kg = 316\njerk_mm_s3 = 210000\n",
    );
    shop.put("a.ngc", "G17 G3 I2.8756 J14.4646 F59213\nM30\n");
    let (code, out, shown) = shop.run("limit a.ngc --allow feed");
    assert_eq!(code, 0, "{shown}");
    assert!(out.contains("G131 = ") && out.contains("F11211"), "{out}");
}

/// The series of speeds and powers adds up to the report, on arcs and rounded
/// corners as well.
#[test]
fn a_series_adds_up_to_the_report() {
    for controller in ["ahead.toml", "linuxcnc", "iso"] {
        let shop = mill(controller, JERK, STRONG);
        let program = pocket();
        let program = if controller == "iso" {
            program.replace("G64", "G61")
        } else {
            program
        };
        shop.put("a.ngc", &program);
        // The series runs at 100 %; at lower overrides other moves speed up.
        let (code, _, shown) = shop.run("report a.ngc --override 100% --json a.json");
        assert_eq!(code, 0, "{shown}");
        let (code, _, shown) = shop.run("report a.ngc --series a.csv --step-ms 0.5");
        assert_eq!(code, 0, "{shown}");
        let report: serde_json::Value = serde_json::from_str(&shop.get("a.json")).unwrap();
        let rows = rows(&shop.get("a.csv"), "before");
        let bus = rows[0].len() - 2;
        let close = |found: f64, key: &str, share: f64| {
            let shown = report[key].as_f64().unwrap();
            assert!(
                (found - shown).abs() <= share * shown,
                "{controller} {key}: {found} is not {shown}"
            );
        };
        close(rows.last().unwrap()[0], "duration_s", 1e-9);
        let peak = rows.iter().map(|row| row[bus]).fold(0.0, f64::max);
        if controller == "linuxcnc" {
            // What its optimiser leaves of short lines is bounded where jerk is limited.
            let peak_w = report["peak_w"].as_f64().unwrap();
            assert!(peak <= peak_w * (1.0 + 1e-3), "{peak} is above {peak_w}");
        } else {
            close(peak, "peak_w", 1e-3);
        }
        let mut energy = 0.0;
        for pair in rows.windows(2) {
            let dt = pair[1][0] - pair[0][0];
            energy += 0.5 * dt * (pair[0][bus] + pair[1][bus]);
            for axis in 0..3 {
                let (v, a) = (2 + 4 * axis, 3 + 4 * axis);
                if controller == "linuxcnc" {
                    // Overlapping ramps stand for their speeds alone.
                    continue;
                }
                assert!(pair[0][a].abs() <= 3000.0 * (1.0 + 1e-6), "{}", pair[0][a]);
                let change = 0.5 * dt * (pair[0][a] + pair[1][a]);
                let off = (pair[1][v] - pair[0][v] - change).abs();
                // A corner is a step of 5 mm/s at most.
                assert!(off < 5.01, "{controller}: speed jumps by {off} mm/s");
            }
        }
        close(energy, "energy_j", 1e-3);
    }
}

/// Without losses but Coulomb friction, with equal masses and what is fed back
/// credited, the energy of all moves is that of friction: 100 N by the way of
/// each axis.
#[test]
fn the_energy_balance_closes() {
    let mut text = "G21 G90 G94\nG64\n".to_owned();
    let (mut last, mut way_mm) = ([0.0_f64; 2], 0.0);
    for i in 0..400 {
        let t = 0.05 * f64::from(i);
        // Smooth lines in small steps, and a corner now and then.
        let corner = if i % 50 == 0 { 3.0 } else { 0.0 };
        let point = [40.0 * libm::sin(t) + corner, 25.0 * libm::cos(0.7 * t)];
        let point = point.map(|value| (value * 1e4).round() / 1e4);
        let _ = writeln!(
            text,
            "G1 X{} Y{} F{}",
            point[0],
            point[1],
            4000 + 100 * (i / 37)
        );
        way_mm += (point[0] - last[0]).abs() + (point[1] - last[1]).abs();
        last = point;
    }
    text.push_str("M30\n");
    let ratings = "peak_power_w = 1e6\nregen_power_w = 1e6\ncredit_regen = true";
    for controller in ["ahead.toml", "grbl", "iso"] {
        for axis in [JERK, "jerk_mm_s3 = 2000", "jerk_mm_s3 = 5e5"] {
            let shop = mill(controller, axis, ratings);
            let machine = shop.get("mill.toml").replace("efficiency = 0.8\n", "");
            shop.put("mill.toml", &machine.replace("base_load_w = 100\n", ""));
            let text = if controller == "ahead.toml" {
                text.clone()
            } else {
                text.replace("G64\n", "")
            };
            let energy = reported(&shop, &text)["energy_j"].as_f64().unwrap();
            let friction = 0.1 * way_mm;
            assert!(
                (energy / friction - 1.0).abs() < 1e-9,
                "{controller}: {energy} {friction}"
            );
        }
    }
}
