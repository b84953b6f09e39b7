//! The page of two machines says what the text of `diff` says.

use std::fs;
use std::path::Path;

use serde_json::Value;

use super::{Desk, SCRIPTS, data, example, figures, most};

/// The built-in machine with another converter.
fn rated(desk: &Desk, name: &str, peak_power_w: &str) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let file = fs::read_to_string(root.join("machine-configs/three-axis.toml")).unwrap();
    desk.put(
        name,
        file.replace(
            "peak_power_w = 4000",
            &format!("peak_power_w = {peak_power_w}"),
        ),
    );
}

/// The figures of a report of one machine.
fn report(desk: &Desk, program: &str, machine: &str) -> Value {
    desk.exits(
        0,
        &["report", program, "-m", machine, "--json", "report.json"],
    );
    serde_json::from_str(&desk.get("report.json")).unwrap()
}

#[test]
fn both_machines_have_the_figures_of_their_reports() {
    for (program, from, to) in [
        ("simultaneous-start.ngc", "three-axis", "vmc"),
        // The vmc has a spindle, for which it waits.
        ("run-up.ngc", "three-axis", "vmc"),
        ("run-up.ngc", "vmc", "linuxcnc-mill"),
        ("pocket.ngc", "linuxcnc-mill", "vmc"),
    ] {
        let desk = Desk::new();
        let program = example(program);
        let output = desk.run(&[
            "diff",
            &program,
            "--from",
            from,
            "--to",
            to,
            "--html",
            "page.html",
        ]);
        let code = output.status.code();
        assert!(code == Some(0) || code == Some(1), "{output:?}");
        let page = desk.get("page.html");
        assert_eq!(page.matches("<script").count(), SCRIPTS);
        let shown = data(&page);
        let head = &shown["head"];
        assert_eq!(head["fits"], code == Some(0), "{program}");
        assert_eq!(head["compared"]["names"], serde_json::json!([from, to]));
        for (side, machine, after) in [("before", from, ""), ("after", to, "_after")] {
            let report = report(&desk, &program, machine);
            for figure in ["peak_w", "regen_w", "duration_s", "energy_j", "peak_line"] {
                assert_eq!(head[side][figure], report[figure], "{program}: {figure}");
            }
            for figure in ["peak", "regen"] {
                let name = format!("{figure}{after}_w");
                let own = report[format!("{figure}_w")].as_f64().unwrap();
                assert_eq!(most(&shown["bars"], &name), own, "{program}: {name}");
            }
            let end_s = most(&shown["bars"], &format!("to{after}_s"));
            let own_s = report["duration_s"].as_f64().unwrap();
            assert!((end_s - own_s).abs() < 2e-6, "{program}: {end_s} {own_s}");
            assert!(!shown["moments"][side].as_array().unwrap().is_empty());
        }
        let channels = shown["channels"].as_array().unwrap();
        let has_spindle = [from, to].contains(&"vmc");
        assert_eq!(channels.iter().any(|it| it == "spindle"), has_spindle);
    }
}

/// What begins and ceases to fit is the same in the text, the CSV and the page.
#[test]
fn text_and_page_say_the_same() {
    let desk = Desk::new();
    rated(&desk, "weak.toml", "4000");
    rated(&desk, "strong.toml", "40000");
    let program = example("simultaneous-start.ngc");
    for (from, to, code, verb) in [
        ("weak.toml", "strong.toml", 0, "begins to fit"),
        ("strong.toml", "weak.toml", 1, "ceases to fit"),
    ] {
        let files = ["--csv", "diff.csv", "--html", "page.html"];
        let both = ["diff", &program, "--from", from, "--to", to];
        let output = desk.run(&[&both[..], &files[..]].concat());
        assert_eq!(output.status.code(), Some(code));
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(text.contains("6.00 kW → 6.00 kW"), "{text}");
        let both = verb.replacen("s ", " ", 1);
        assert!(text.contains(&format!("lines 6, 8 {both}")), "{text}");
        let shown = data(&desk.get("page.html"));
        let compared = &shown["head"]["compared"];
        let name = if code == 0 { "begin" } else { "cease" };
        assert_eq!(compared[name], 2);
        assert_eq!(shown["head"]["changed"], 2);
        let differ = shown["differ"].as_array().unwrap();
        assert_eq!(differ.len(), 2);
        let blocks = &shown["blocks"];
        let at = differ[0].as_u64().unwrap() as usize;
        assert_eq!(blocks["line"][at], 6);
        let action = blocks["action"]["of"][at].as_u64().unwrap() as usize;
        assert_eq!(blocks["action"]["names"][action], verb);
        // 6001 W of 3600 W and of 36000 W: the limits are those of each machine.
        let count = blocks["count"].as_u64().unwrap() as usize;
        let loads = [("load", 3600.0), ("load_after", 36000.0)];
        let limits = if code == 0 { [0, 1] } else { [1, 0] };
        for ((column, _), which) in loads.into_iter().zip(limits) {
            let load = figures(&blocks[column], count)[at];
            let limit_w = loads[which].1;
            assert!(
                (load - 6_001.321_91 / limit_w).abs() < 1e-4,
                "{column}: {load}"
            );
        }
        let csv = desk.get("diff.csv");
        let row: Vec<&str> = csv.lines().nth(1).unwrap().split(',').collect();
        assert_eq!(
            &row[13..15],
            if code == 0 { ["2", "0"] } else { ["0", "2"] }
        );
    }
}

/// A move that one machine alone makes is nothing on the other one.
#[test]
fn a_move_of_one_machine_alone_has_no_figures_on_the_other() {
    let desk = Desk::new();
    let program = example("run-up.ngc");
    let both = ["diff", &program, "--from", "three-axis", "--to", "vmc"];
    desk.run(&[&both[..], &["--html", "page.html"]].concat());
    let shown = data(&desk.get("page.html"));
    let blocks = &shown["blocks"];
    let names = blocks["kind"]["names"].as_array().unwrap();
    let spindle = names.iter().position(|it| it == "spindle").unwrap();
    let kinds = blocks["kind"]["of"].as_array().unwrap();
    let wait = kinds
        .iter()
        .position(|it| it.as_u64() == Some(spindle as u64))
        .unwrap();
    for column in ["peak_w", "start_s", "load", "limit_w"] {
        assert!(blocks[column][wait].is_null(), "{column}");
    }
    assert!(blocks["peak_after_w"][wait].as_f64() > Some(0.0));
}

#[test]
fn pages_of_two_machines_that_cannot_be_are_refused() {
    let desk = Desk::new();
    desk.put("part.ngc", "G21 G90\nG0 X1\nM30\n");
    desk.put("bad.ngc", "G21 G90\nG0 X[\nM30\n");
    let refused = |more: &[&str], message: &str| {
        let both = ["diff", "--from", "three-axis", "--to", "vmc"];
        let said = desk.exits(2, &[&both[..], more].concat());
        assert!(said.contains(message), "{said}");
    };
    refused(
        &["part.ngc", "part.ngc", "--html", "a.html"],
        "--html shows one program",
    );
    refused(&["part.ngc", "--html", "-"], "only one result");
    refused(&["part.ngc", "--html", "part.ngc"], "is read by this run");
    refused(
        &["part.ngc", "--html", "a", "--csv", "a"],
        "would be written twice",
    );
    refused(
        &["part.ngc", "--html", "none/a.html"],
        "cannot write none/a.html",
    );
    refused(&["bad.ngc", "--html", "a.html"], "bad.ngc");
    assert_eq!(fs::read_dir(desk.at("")).unwrap().count(), 2);
}
