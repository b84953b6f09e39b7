//! `--allow pause`: dwells between rapids and before tool changes, where a limit over time
//! is missed otherwise.

use crate::shop::Shop;

/// 50 W at rest; X at F20000 draws 0.3333·100/0.8 = 42 W more, by a rapid 62.5 W. Over
/// 30 s no more than `power_w` may be drawn.
fn shop(controller: &str, power_w: f64) -> Shop {
    let converter = format!("peak_power_w = 2000\ncontinuous_power_w = {power_w}\nwindow_s = 30");
    let path =
        "[path]\nmode = \"exact-stop\"\nrapid = \"linear\"\n[language]\ntool_change_moves = []";
    let shop = Shop::mill(controller, &converter, path, "");
    let machine = shop.get("mill.toml");
    shop.put(
        "mill.toml",
        &machine.replace("base_load_w = 100", "base_load_w = 50"),
    );
    shop
}

/// The rapids are so short that they can hardly take the time which is needed.
const PROGRAM: &str = "G21 G90\nG0 Z2.\nG0 X0. Y0.\nG0 Z0.\nG1 X900. F20000.\nG1 Y20.\nG1 X0.\n\
                       G0 Z2.\nG0 Y0.\nM6 T2\nG0 Z0.\nG1 X900.\nG1 X0.\nG0 Z2.\nM2\n";

/// Seconds of the dwells, by the letter of the control.
fn dwells(text: &str, word: &str) -> Vec<f64> {
    let lines = text.lines().filter_map(|line| line.strip_prefix(word));
    lines
        .map(|value| value.parse().expect("a number"))
        .collect()
}

/// The feeds may not be lowered, and slower rapids are not enough.
#[test]
fn the_program_waits_between_rapids() {
    let shop = shop("iso", 84.0);
    let (code, _, errors) = shop.limit(PROGRAM, "");
    assert_eq!(code, 1, "{errors}");
    let (code, text, errors) = shop.limit(PROGRAM, "--allow pause --json r.json");
    assert_eq!(code, 0, "{errors}");
    let seconds = dwells(&text, "G4 P");
    assert!(!seconds.is_empty(), "{text}");
    // Nothing else is changed.
    let rest: String = text
        .split_inclusive('\n')
        .filter(|line| !line.starts_with("G4 "))
        .collect();
    assert_eq!(rest, PROGRAM);
    // Not before or after a feed.
    let lines: Vec<&str> = text.lines().collect();
    for place in (0..lines.len()).filter(|place| lines[*place].starts_with("G4")) {
        assert!(lines[place - 1].starts_with("G0"), "{text}");
        let next = lines[place + 1];
        let free = ["G0", "M6", "M2"].iter().any(|it| next.starts_with(it));
        assert!(free, "{text}");
    }
    // The message and the JSON name the same lines and seconds.
    let json: serde_json::Value = serde_json::from_str(&shop.get("r.json")).expect("JSON");
    let named: Vec<f64> = json["pauses"]
        .as_array()
        .expect("pauses")
        .iter()
        .map(|pause| pause["seconds"].as_f64().expect("seconds"))
        .collect();
    assert_eq!(named, seconds);
    assert!(errors.contains("waits for "), "{errors}");
    let rows = json["blocks"].as_array().expect("rows");
    let of_pauses: Vec<f64> = rows
        .iter()
        .filter(|row| row["action"] == "pause")
        .map(|row| row["duration_after_s"].as_f64().expect("a time"))
        .collect();
    assert_eq!(of_pauses, seconds);
    // They are no longer than they have to be.
    shop.put("fit.nc", &text);
    assert_eq!(shop.run("check fit.nc").0, 0);
    let first = format!("G4 P{}\n", seconds[0]);
    let shorter = text.replace(&first, &format!("G4 P{}\n", 0.9 * seconds[0] - 0.2));
    shop.put("short.nc", &shorter);
    assert_eq!(shop.run("check short.nc").0, 1, "{text}");
}

/// A program that goes round and round may wait at its end, where the tool is clear.
#[test]
fn the_end_is_a_place_to_wait() {
    let program = "G21 G90\nG0 Z20.\nG1 X900. F20000.\nG1 X0.\nG1 X900.\nG1 X0.\nG0 Z30.\nM30\n";
    let shop = shop("fanuc", 84.0);
    let (code, text, errors) = shop.limit(program, "--allow pause");
    assert_eq!(code, 0, "{errors}");
    let (before, after) = text.split_once("G4 X").expect("a dwell");
    assert!(
        before.ends_with("G0 Z30.\n") && after.ends_with("\nM30\n"),
        "{text}"
    );
    // One long cut may need more than any dwell gives.
    let cut = "G1 X900. F20000.\nG1 X0.\n".repeat(20);
    let (code, _, errors) = shop.limit(
        &format!("G21 G90\nG0 Z20.\n{cut}G0 Z30.\nM30\n"),
        "--allow pause",
    );
    assert_eq!(code, 1, "{errors}");
    assert!(
        errors.contains(
            "note[pauses-not-enough]: --allow pause: dwells at 1 place between rapids, before tool"
        ),
        "{errors}"
    );
}

/// Each control has its own form of G4.
#[test]
fn each_control_waits_in_its_own_words() {
    for (controller, word) in [("fanuc", "G4 X"), ("haas", "G4 P"), ("siemens", "G4 F")] {
        let shop = shop(controller, 84.0);
        // The length of a tool that nobody gave would be another matter.
        let change = if controller == "siemens" {
            "M6 T2 D0"
        } else {
            "M6 T2"
        };
        let program = PROGRAM.replace("G21 ", "").replace("M6 T2", change);
        let (code, text, errors) = shop.limit(&program, "--allow pause");
        assert_eq!(code, 0, "{controller}: {errors}");
        assert!(!dwells(&text, word).is_empty(), "{controller}: {text}");
        shop.put("fit.nc", &text);
        assert_eq!(shop.run("check fit.nc").0, 0, "{text}");
    }
}

/// Where lower speeds cost less, they are taken.
#[test]
fn lower_speeds_that_cost_less_are_taken() {
    let shop = shop("iso", 90.0);
    let lowered = shop.limit(PROGRAM, "--allow feed");
    let both = shop.limit(PROGRAM, "--allow feed,pause --json r.json");
    assert_eq!((lowered.0, both.0), (0, 0), "{}", both.2);
    let time = |errors: &str| -> f64 {
        let (_, rest) = errors.split_once("W (line ").expect("a line");
        let time = rest.split([',', ';']).nth(1).expect("a time").trim();
        time.trim_end_matches(" s").parse().expect("seconds")
    };
    assert!(time(&both.2) <= time(&lowered.2), "{}{}", both.2, lowered.2);
}

/// Not while cutting, not in cycles, under compensation or in loops.
#[test]
fn where_the_program_may_not_wait() {
    let cut = "G1 X900. F20000.\nG1 X0.\n";
    for program in [
        format!("G21 G90\n{cut}{cut}M30\n"),
        format!("G21 G90\nG0 Z20.\n{cut}G0 Z0.\n{cut}M30\n"),
        format!("G21 G90\n#1=0\nWHILE [#1 LT 3] DO1\nG0 Z20.\nG0 Z0.\n{cut}#1=#1+1\nEND1\nM30\n"),
        format!("G21 G90\n/G0 Z20.\n/G0 Z0.\n{cut}{cut}M30\n"),
    ] {
        let shop = shop("fanuc", 70.0);
        let (code, _, errors) = shop.limit(&program, "--allow pause");
        assert_eq!(code, 1, "{program}{errors}");
        assert!(
            errors.contains("note[no-place-to-pause]"),
            "{program}{errors}"
        );
    }
}

/// To wait is advised where there is a place for it and it is not permitted yet.
#[test]
fn to_wait_is_advised_where_the_program_can() {
    let cut = "G21 G90\nG1 X900. F20000.\nG1 X0.\nG1 X900.\nG1 X0.\nM30\n";
    let skipped = PROGRAM.replace("G0 Z2.\nM2", "/G0 Z2.\nM2");
    for (program, can) in [(PROGRAM, true), (cut, false), (&*skipped, false)] {
        let shop = shop("fanuc", 70.0);
        let (code, _, errors) = shop.limit(program, "");
        assert_eq!(code, 1, "{errors}");
        let advice = "  = help: lower speeds or accelerations around this line";
        let advice = if can {
            format!("{advice}, or let it pause (limit --allow pause)\n")
        } else {
            format!("{advice}\n")
        };
        assert!(errors.contains(advice.trim_start()), "{errors}");
        let (code, shown, _) = shop.run("check a.nc");
        assert_eq!(code, 1, "{shown}");
        assert_eq!(shown.contains("or let it pause"), can, "{shown}");
        let (_, _, errors) = shop.limit(program, "--allow pause");
        assert!(!errors.contains("let it pause"), "{errors}");
    }
}

/// The spindle keeps turning, and each override is looked at: a dwell lasts as long at any.
#[test]
fn waiting_beside_a_spindle() {
    let rest = "override_max_percent = { feed = 100, rapid = 100, spindle = 100 }\n[path]\n\
                mode = \"exact-stop\"\nrapid = \"linear\"\n[spindle]\ninertia_kg_m2 = 0.01\n\
                friction_nm = 1\nmax_rpm = 3000\nbase_rpm = 3000\naccel_time_s = 1\n";
    let converter = "peak_power_w = 2000\ncontinuous_power_w = 320\nwindow_s = 30";
    let shop = Shop::mill("iso", converter, rest, "");
    let program = PROGRAM.replacen("G0 Z2.\n", "G0 Z2.\nM3 S1500\n", 1);
    let (code, text, errors) = shop.limit(&program, "--allow pause");
    assert_eq!(code, 0, "{errors}");
    assert!(text.contains("M3 S1500") && !text.contains("M5"), "{text}");
}
