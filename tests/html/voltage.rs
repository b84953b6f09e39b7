//! The voltage of the bus, and powers that are permitted for a time.

use std::fmt::Write as _;

use serde_json::Value;

use super::{Desk, data, example, figures};

/// The mill of `tests/over_time/voltage.rs`: 100 kg at 10 m/s², `bus` of its converter.
fn mill(desk: &Desk, bus: &str) {
    let text = format!(
        "schema = 1\nname = \"mill\"\ncontroller = \"iso\"\n[path]\nmode = \"exact-stop\"\n\
         [converter]\npeak_power_w = 500\nregen_power_w = 500\n{bus}\n[limits]\nmargin = 0\n\
         [axes.X]\nrapid_mm_min = 200000\naccel_mm_s2 = 10000\nmass_kg = 100\n"
    );
    desk.put("mill.toml", text);
    desk.put("a.ngc", "G21 G91\nG1 X1000 F60000\nM30\n");
}

const BUS: &str = "capacitance_f = 0.01\nbus_nominal_v = 500\nbus_min_v = 400\nbus_max_v = 600";
const OVERLOAD: &str = "continuous_power_w = 250\nwindow_s = 10\n\
                        overload = [{ power_w = 500, seconds = 2, every_s = 10 }]";

/// The worst voltage of what a page draws: of its curve, or of the line for the report.
fn drawn(curve: &Value) -> Option<f64> {
    let count = curve["count"].as_u64().unwrap() as usize;
    let volts = figures(&curve["volts"], count).into_iter();
    let volts = volts.chain(curve["beyond_v"].as_f64());
    if curve["lowest"] == true {
        volts.reduce(f64::min)
    } else {
        volts.reduce(f64::max)
    }
}

/// Each voltage of a report is drawn, and no other one.
#[track_caller]
fn agrees(curves: &Value, report: &Value, name: &str) {
    let found = report["over_time"].as_array().unwrap().iter();
    let found: Vec<&Value> = found.filter(|it| it["unit"] == "V").collect();
    let curves = curves.as_array().unwrap();
    assert_eq!(curves.len(), found.len(), "{name}");
    for (curve, found) in curves.iter().zip(found) {
        let lowest = found["check"] == "bus-voltage-low";
        assert_eq!(curve["lowest"], lowest, "{name}");
        assert_eq!(curve["limit_v"], found["limit"], "{name}");
        assert_eq!(curve["fits"], found["fits"], "{name}");
        assert_eq!(drawn(curve), found["value"].as_f64(), "{name}: {found}");
    }
}

#[test]
fn the_lowest_and_the_highest_voltage_are_those_of_the_report() {
    let blended = "G21 G90 G94 G64\nG0 X100 Y50\nG1 F3000 X150\nY80\nG4 P1\nM0\nX10\nM30\n";
    for program in [
        "pocket.ngc",
        "run-up.ngc",
        "simultaneous-start.ngc",
        "blend.nc",
    ] {
        for once in [false, true] {
            let desk = Desk::new();
            desk.put("blend.nc", blended);
            let path = match program {
                "blend.nc" => program.to_owned(),
                own => example(own),
            };
            let mut arguments = vec!["report", &path, "-m", "vmc"];
            arguments.extend(["--html", "page.html", "--json", "report.json"]);
            arguments.extend(once.then_some("--once"));
            desk.exits(0, &arguments);
            let report: Value = serde_json::from_str(&desk.get("report.json")).unwrap();
            let shown = data(&desk.get("page.html"));
            let curves = &shown["voltage"]["before"];
            assert_eq!(curves.as_array().unwrap().len(), 2);
            agrees(curves, &report, program);
            assert_eq!(shown["voltage"]["after"], Value::Array(Vec::new()));
        }
    }
}

/// Before and after, each is what the report says of that program.
#[test]
fn limit_shows_both_voltages() {
    let desk = Desk::new();
    mill(&desk, &format!("{BUS}\n{OVERLOAD}"));
    let asked = ["-m", "mill.toml", "--allow", "feed", "-o", "b.ngc"];
    let files = ["--html", "page.html", "--svg", "power.svg"];
    desk.exits(0, &[&["limit", "a.ngc"], &asked[..], &files].concat());
    let shown = data(&desk.get("page.html"));
    for (side, program) in [("before", "a.ngc"), ("after", "b.ngc")] {
        desk.exits(
            0,
            &["report", program, "-m", "mill.toml", "--json", "r.json"],
        );
        let report: Value = serde_json::from_str(&desk.get("r.json")).unwrap();
        agrees(&shown["voltage"][side], &report, program);
    }
    // √247500 V, as worked out in tests/over_time/voltage.rs.
    let lowest = &shown["voltage"]["before"][0];
    assert_eq!(lowest["title"], "lowest 497 V, at least 400 V");
    assert!((drawn(lowest).unwrap() - 497.493_718_6).abs() < 1e-7);
    assert_eq!(drawn(&shown["voltage"]["after"][0]), Some(500.0));
    let overload = shown["head"]["over_time"].as_array().unwrap().iter();
    let labels: Vec<&Value> = overload.filter(|it| !it["above_w"].is_null()).collect();
    assert_eq!(labels.len(), 1);
    assert_eq!(
        labels[0]["label"],
        "overload above 250 W: 2.00 s within 10 s"
    );
    assert_eq!(labels[0]["above_w"], 250);
}

/// What people see of it in the still picture: a panel for each program, with its lines.
#[test]
fn the_still_picture_has_voltage_and_overload() {
    let desk = Desk::new();
    mill(&desk, &format!("{BUS}\n{OVERLOAD}"));
    let file = ["-m", "mill.toml", "--svg", "power.svg"];
    desk.exits(0, &[&["report", "a.ngc"], &file[..]].concat());
    let picture = desk.get("power.svg");
    let mut words = String::new();
    for piece in picture.split("<text").skip(1) {
        let (_, rest) = piece.split_once('>').unwrap();
        let (text, _) = rest.split_once("</text>").unwrap();
        if text.contains(|letter: char| letter.is_alphabetic()) {
            writeln!(words, "{text}").unwrap();
        }
    }
    insta::assert_snapshot!(words);
    // One dashed line for each limit, and the curves go down to 497.5 V and up to 502.5 V.
    assert_eq!(
        picture
            .matches("stroke=\"#1f5fa8\" stroke-width=\"1.5\"")
            .count(),
        1
    );
    assert_eq!(
        picture
            .matches("stroke=\"#b3500a\" stroke-width=\"1.5\"")
            .count(),
        1
    );
    assert_eq!(picture.matches("stroke-dasharray=\"2 4\"").count(), 1);
}

/// Without a capacitor no part of any output says anything of a voltage.
#[test]
fn no_capacitor_no_voltage() {
    let desk = Desk::new();
    mill(&desk, "");
    let files = [
        "--html",
        "page.html",
        "--svg",
        "power.svg",
        "--series",
        "s.csv",
    ];
    let asked = ["report", "a.ngc", "-m", "mill.toml", "--once"];
    desk.exits(0, &[&asked[..], &files].concat());
    let shown = data(&desk.get("page.html"));
    assert_eq!(shown["voltage"]["before"], Value::Array(Vec::new()));
    assert!(!desk.get("power.svg").contains("oltage"));
    assert!(!desk.get("power.svg").contains("verload"));
    let series = desk.get("s.csv");
    assert!(series.lines().next().unwrap().ends_with(",bus_w,regen_w"));
}

/// The columns of the series: the lowest is that of the report, where the program runs once.
#[test]
fn the_series_has_the_voltages() {
    let desk = Desk::new();
    mill(&desk, BUS);
    let files = ["--series", "s.csv", "--json", "r.json", "--step-ms", "7"];
    let asked = ["report", "a.ngc", "-m", "mill.toml", "--once"];
    desk.exits(0, &[&asked[..], &files].concat());
    let report: Value = serde_json::from_str(&desk.get("r.json")).unwrap();
    let series = desk.get("s.csv");
    let mut lines = series.lines().filter(|line| !line.starts_with("after"));
    let header = lines.next().unwrap();
    assert!(
        header.ends_with(",bus_w,regen_w,bus_low_v,bus_high_v"),
        "{header}"
    );
    let rows: Vec<[f64; 2]> = lines
        .map(|line| {
            let mut last = line.rsplit(',').map(|cell| cell.parse().unwrap());
            let high_v = last.next().unwrap();
            [last.next().unwrap(), high_v]
        })
        .collect();
    let lowest = rows.iter().map(|row| row[0]).fold(f64::INFINITY, f64::min);
    let highest = rows.iter().map(|row| row[1]).fold(0.0, f64::max);
    let of_report = |place: usize| report["over_time"][place]["value"].as_f64().unwrap();
    assert!((lowest - of_report(0)).abs() < 1e-6, "{lowest}");
    // No row stands where braking falls below what is taken back: one is at most 7 ms away.
    assert!(
        highest <= of_report(1) + 1e-6 && highest > of_report(1) - 0.1,
        "{highest}"
    );
    assert_eq!(
        [rows[0], *rows.last().unwrap()].map(|row| row[0]),
        [500.0; 2]
    );
}
