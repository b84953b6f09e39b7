//! What a page shows is what the report says.

use std::fmt::Write as _;

use super::{Desk, SCRIPTS, data, example, figures, most};
use serde_json::Value;

#[test]
fn the_largest_peak_is_that_of_the_report() {
    for (program, machine) in [
        ("simultaneous-start.ngc", "three-axis"),
        ("pocket.ngc", "vmc"),
        ("pocket.ngc", "linuxcnc-mill"),
        ("indexed-five-axis.ngc", "five-axis"),
        ("lathe-pass.ngc", "lathe"),
        ("printer-outline.gcode", "printer"),
        ("run-up.ngc", "vmc"),
    ] {
        let desk = Desk::new();
        let program = example(program);
        let files = ["--html", "page.html", "--json", "report.json"];
        desk.exits(
            0,
            &[&["report", &program, "-m", machine], &files[..]].concat(),
        );
        let report: Value = serde_json::from_str(&desk.get("report.json")).unwrap();
        let shown = data(&desk.get("page.html"));
        let before = &shown["head"]["before"];
        for figure in ["peak_w", "regen_w", "duration_s", "energy_j", "peak_line"] {
            assert_eq!(before[figure], report[figure], "{program}: {figure}");
        }
        assert_eq!(shown["head"]["fits"], report["fits"], "{program}");
        let own = |name: &str| report[name].as_f64().unwrap();
        assert_eq!(most(&shown["bars"], "peak_w"), own("peak_w"), "{program}");
        assert_eq!(most(&shown["bars"], "regen_w"), own("regen_w"), "{program}");
        let end_s = most(&shown["bars"], "to_s");
        assert!(
            (end_s - own("duration_s")).abs() < 2e-6,
            "{program}: {end_s}"
        );
    }
}

/// Each of the largest peaks has its axes, and together they are the peak.
#[test]
fn the_simultaneous_set_adds_up() {
    let desk = Desk::new();
    let program = example("simultaneous-start.ngc");
    desk.exits(
        0,
        &[
            "report",
            &program,
            "-m",
            "three-axis",
            "--html",
            "page.html",
        ],
    );
    let shown = data(&desk.get("page.html"));
    let first = &shown["moments"]["before"][0];
    let (peak_w, planned_w) = (first["peak_w"].as_f64(), first["planned_w"].as_f64());
    assert!((peak_w.unwrap() - planned_w.unwrap()).abs() < 0.01 * peak_w.unwrap());
    let values = first["values_w"].as_array().unwrap();
    let sum_w: f64 = values.iter().map(|it| it.as_f64().unwrap().max(0.0)).sum();
    assert!((sum_w - planned_w.unwrap()).abs() < 0.1);
    assert_eq!(shown["channels"][0], "X");
    assert!(values[..3].iter().all(|it| it.as_f64().unwrap() > 100.0));
}

#[test]
fn limit_shows_both_programs() {
    let desk = Desk::new();
    let program = example("simultaneous-start.ngc");
    let files = [
        "-o",
        "fit.ngc",
        "--html",
        "page.html",
        "--svg",
        "power.svg",
        "--json",
        "limit.json",
    ];
    desk.exits(
        0,
        &[&["limit", &program, "-m", "three-axis"], &files[..]].concat(),
    );
    let limit: Value = serde_json::from_str(&desk.get("limit.json")).unwrap();
    let shown = data(&desk.get("page.html"));
    let (before, after) = (&shown["head"]["before"], &shown["head"]["after"]);
    for figure in ["peak_w", "duration_s", "energy_j"] {
        assert_eq!(before[figure], limit[figure]);
        let key = figure.replace('_', "_after_");
        assert_eq!(after[figure], limit[&key], "{figure}");
    }
    assert!(after["energy_j"].as_f64() > Some(0.0));
    let bars = &shown["bars"];
    assert_eq!(
        Some(most(bars, "peak_after_w")),
        limit["peak_after_w"].as_f64()
    );
    let end_s = most(bars, "to_after_s");
    assert!((end_s - limit["duration_after_s"].as_f64().unwrap()).abs() < 2e-6);
    assert_eq!(shown["head"]["limited"]["edited_lines"], 3);
    assert!(shown["shares"]["after"]["count"].as_u64() > Some(10));
    // What the report says of the written program.
    desk.exits(
        0,
        &[
            "report",
            "fit.ngc",
            "-m",
            "three-axis",
            "--json",
            "fit.json",
        ],
    );
    let fit: Value = serde_json::from_str(&desk.get("fit.json")).unwrap();
    for figure in ["peak_w", "duration_s", "energy_j"] {
        assert_eq!(after[figure], fit[figure], "{figure}");
    }
    let picture = desk.get("power.svg");
    assert!(picture.contains("Before: peak 6.00 kW") && picture.contains("After: peak 3.60 kW"));
}

/// Text of the program ends no script and begins no tag.
#[test]
fn text_stays_text() {
    let desk = Desk::new();
    let mut program = b"G21 G90 G94\n(</script><script>alert</script>)\n".to_vec();
    program
        .extend(b"G0 X200 Y200 Z200 (</script><img src=x onerror=alert> \"'\xFF\xFE\x1b[31m&)\n");
    program.extend("G1 F100 X210 (<!-- \u{2028} \u{202e} --> ]]>)\nM30\n".as_bytes());
    let name = "a<b>&\"'.ngc";
    desk.put(name, program);
    let files = ["--html", "page.html", "--svg", "power.svg"];
    desk.exits(
        0,
        &[&["report", name, "-m", "three-axis"], &files[..]].concat(),
    );
    let page = desk.get("page.html");
    assert_eq!(page.matches("</script").count(), SCRIPTS);
    assert_eq!(page.matches("<script").count(), SCRIPTS);
    assert!(!page.contains("<img") && !page.contains('\u{2028}') && !page.contains('\u{1b}'));
    let shown = data(&page);
    assert_eq!(shown["head"]["program"], name);
    let texts = shown["texts"]["text"].as_array().unwrap();
    let text = texts
        .iter()
        .find(|it| it.as_str().unwrap().starts_with("G0 X200"));
    assert!(
        text.unwrap()
            .as_str()
            .unwrap()
            .contains("</script><img src=x")
    );
    let picture = desk.get("power.svg");
    assert!(picture.contains("a&lt;b&gt;&amp;&quot;'.ngc") && !picture.contains("<b>"));
}

/// Nothing is loaded from anywhere.
#[test]
fn a_page_is_self_contained() {
    let desk = Desk::new();
    desk.exits(
        0,
        &[
            "report",
            &example("circle.ngc"),
            "-m",
            "vmc",
            "--html",
            "page.html",
        ],
    );
    let page = desk.get("page.html");
    for load in [
        "<script src",
        "<link",
        "<img",
        "<iframe",
        "@import",
        "url(http",
        "src=\"http",
        "href=",
    ] {
        assert!(!page.contains(load), "{load}");
    }
    assert!(page.contains("default-src 'none'"));
    // Names and addresses in the libraries' comments: nothing is asked there.
    let own: Vec<&str> = page.split("://").collect();
    let named = own.windows(2).filter(|pair| {
        let known = ["github.com/leeoniya/uPlot", "www.w3.org/1999/xhtml"];
        !known.iter().any(|it| pair[1].starts_with(it))
    });
    assert_eq!(named.count(), 0);
}

/// A program of many short moves: the page stays small, and no peak is lost.
fn long() -> String {
    let mut text = String::from("G21 G90 G94 G61\nF4000\n");
    for row in 0..150 {
        for step in 0..200 {
            let x = if row % 2 == 0 { step } else { 200 - step };
            let z = (step * row) % 7;
            writeln!(text, "G1 X{x} Y{row} Z{z}.{z}").unwrap();
        }
        if row == 77 {
            text.push_str("G0 X0 Y0 Z100\n");
        }
    }
    text + "M30\n"
}

#[test]
fn a_long_program_gives_a_small_page() {
    let desk = Desk::new();
    desk.put("long.ngc", long());
    let run = |page: &str, json: &str, threads: &str| {
        let files = ["--html", page, "--json", json, "--threads", threads];
        desk.exits(
            0,
            &[&["report", "long.ngc", "-m", "three-axis"], &files[..]].concat(),
        );
    };
    run("one.html", "one.json", "1");
    run("four.html", "four.json", "4");
    let page = desk.get("one.html");
    assert_eq!(page, desk.get("four.html"));
    assert!(page.len() < 5_000_000, "{}", page.len());
    let shown = data(&page);
    let report: Value = serde_json::from_str(&desk.get("one.json")).unwrap();
    let bars = &shown["bars"];
    let count = bars["count"].as_u64().unwrap() as usize;
    assert!((2000..=4000).contains(&count), "{count}");
    assert_eq!(Some(most(bars, "peak_w")), report["peak_w"].as_f64());
    let rows: f64 = figures(&bars["rows"], count).iter().sum();
    assert_eq!(rows as usize, report["blocks"].as_array().unwrap().len());
    // The rapid is among the bars, with its line and its text.
    let worst = shown["worst"][0].as_u64().unwrap() as usize;
    let line = shown["blocks"]["line"][worst].as_u64().unwrap();
    let place = shown["texts"]["line"].as_array().unwrap();
    let place = place
        .iter()
        .position(|it| it.as_u64() == Some(line))
        .unwrap();
    assert_eq!(shown["texts"]["text"][place], "G0 X0 Y0 Z100");
}

/// Moves whose start is not known, dwells and bounds have their place.
#[test]
fn gaps_are_shown() {
    let desk = Desk::new();
    desk.put(
        "blend.nc",
        "G21 G90 G94 G64\nG0 X100 Y50\nG1 F3000 X150\nY80\nG4 P1\nM0\nX10\nM30\n",
    );
    let files = [
        "--html",
        "page.html",
        "--json",
        "report.json",
        "--start",
        "unknown",
    ];
    desk.exits(
        0,
        &[&["report", "blend.nc", "-m", "three-axis"], &files[..]].concat(),
    );
    let shown = data(&desk.get("page.html"));
    let report: Value = serde_json::from_str(&desk.get("report.json")).unwrap();
    assert_eq!(
        Some(most(&shown["bars"], "peak_w")),
        report["peak_w"].as_f64()
    );
    assert!(shown["path"]["unknown"].as_u64() > Some(0));
    let bound = shown["bars"]["bound"].as_array().unwrap();
    assert!(bound.iter().any(|it| it == true) && bound.iter().any(|it| it == false));
}

/// A rapid whose start is not known takes its time in the areas too, with the most that it may
/// draw; what comes after it is not early.
#[test]
fn a_move_from_an_unknown_start_has_its_time() {
    let desk = Desk::new();
    let program = "G21 G90 G54 G17 G94\nG0 X100 Y50 Z50\nG43 H1 Z20\nG1 X200 F3000\nM30\n";
    desk.put("lengths.ngc", program);
    let report = ["report", "lengths.ngc", "-m", "vmc", "--html", "page.html"];
    let files = ["--series", "series.csv", "--json", "report.json"];
    desk.exits(0, &[&report[..], &files].concat());
    let shown = data(&desk.get("page.html"));
    let whole: Value = serde_json::from_str(&desk.get("report.json")).unwrap();
    let rows = &whole["blocks"];
    let own = |row: usize, name: &str| rows[row][name].as_f64().unwrap();
    let place = shown["channels"].as_array().unwrap().len() - 1;
    assert_eq!(shown["channels"][place], "unknown start, at most");
    let shares = &shown["shares"]["before"];
    let (from_s, drawn_w) = (&shares["from_s"], &shares["up"][place]);
    let spans = 0..shares["count"].as_u64().unwrap() as usize;
    let unknown: Vec<usize> = spans
        .filter(|it| drawn_w[*it].as_f64() > Some(0.0))
        .collect();
    let edges = [unknown[0], unknown[unknown.len() - 1]];
    let [begins_s, ends_s] = edges.map(|it| from_s[it].as_f64().unwrap());
    assert!((begins_s - own(1, "start_s")).abs() < 2e-6);
    assert!((ends_s - own(2, "start_s")).abs() < 2e-6);
    assert!((drawn_w[unknown[0]].as_f64().unwrap() - own(1, "peak_w")).abs() < 1.0);
    assert!(shares["fed_back_j"].is_null());
    let series = desk.get("series.csv");
    let before = series.lines().filter(|it| it.starts_with("before,"));
    let cells: Vec<Vec<&str>> = before.map(|it| it.split(',').collect()).collect();
    let last_s: f64 = cells[cells.len() - 1][1].parse().unwrap();
    assert!((last_s - whole["duration_s"].as_f64().unwrap()).abs() < 1e-9);
    // Nothing is known of Z in line 3, and X stands.
    let third = cells.iter().filter(|row| row[2] == "3");
    assert!(third.clone().count() > 100);
    for row in third {
        assert_eq!((row[3], row[11], row[14]), ("0", "", ""), "{row:?}");
    }
    let peak_w = |line: &str| {
        let own = cells.iter().filter(|row| row[2] == line);
        own.map(|row| row[20].parse::<f64>().unwrap())
            .fold(0.0, f64::max)
    };
    assert!((peak_w("3") - own(1, "peak_w")).abs() < 1e-6);
}
