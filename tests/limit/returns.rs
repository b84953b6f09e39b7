//! Returns to the reference point, and rapids in machine coordinates.

use std::fmt::Write as _;

use insta::assert_snapshot;

use crate::random::Random;
use crate::shop::Shop;

/// Reference points in the corner of the working space, and the offsets of two systems.
const PLACES: &str = "[offsets]\nG54 = { X = -450.5, Y = -330, Z = -300 }\nG55 = { X = -100 }\n";

/// A mill with linear rapids whose axes reach 2.9 kW together.
fn shop(controller: &str, rest: &str, axis: &str) -> Shop {
    let rest = format!("[path]\nrapid = \"linear\"\n{rest}");
    let shop = Shop::mill(controller, "peak_power_w = 300", &rest, axis);
    shop.put("tools.tbl", "T1 P1 Z100\nT2 P2 Z55.5\n");
    shop
}

/// Where the moves end, in mm, as far as they take the axes anywhere.
fn ends(shop: &Shop, program: &str, options: &str) -> Vec<[f64; 3]> {
    shop.put("moves.nc", program);
    let (code, out, errors) = shop.run(format!("moves moves.nc {options}").trim_end());
    assert_eq!(code, 0, "{errors}\n{program}");
    let mut ends: Vec<[f64; 3]> = Vec::new();
    for line in out.lines() {
        let mv: serde_json::Value = serde_json::from_str(line).unwrap();
        let end = ["X", "Y", "Z"].map(|axis| mv["end"][axis].as_f64().unwrap());
        let start = ["X", "Y", "Z"].map(|axis| mv["start"][axis].as_f64().unwrap());
        let moved = start.iter().zip(&end).any(|(a, b)| (a - b).abs() > 1e-4);
        if moved {
            ends.push(end);
        }
    }
    ends
}

/// The way is gone by a feed, in absolute coordinates, and nothing is left to move: a point
/// on the way becomes the place itself.
#[test]
fn the_way_is_gone_before_the_return() {
    let shop = shop("fanuc", PLACES, "reference_mm = 0");
    let program = "G21 G90 G54\nG0 G43 H1 Z50.\nG0 X400. Y300.\nG1 Z20. F500.\nM9\n\
                   N100 G91 G28 Z0 M5\nN110 G28 X0 Y0\nG90\nX10.\nG28 X50. Y20. (HOME)\n\
                   G53 G0 Z-5.\nM30\n";
    let options = "--allow feed --tool-table tools.tbl";
    let (code, text, errors) = shop.limit(program, options);
    assert_eq!(code, 0, "{errors}");
    assert_eq!(
        ends(&shop, program, "--tool-table tools.tbl"),
        ends(&shop, &text, "--tool-table tools.tbl")
    );
    assert_snapshot!(text);
}

/// LinuxCNC and grbl refuse G2 without a place or a centre: where an arc's word was in force it is not
/// put back by itself.
#[test]
fn no_word_of_an_arc_stands_alone() {
    let program = "G21 G90 G17\nG0 X0 Y0 Z0\nF1000\nG2 X10 Y0 I5 J0\nG28\nM2\n";
    let points = format!("{PLACES}G28 = {{ X = 0, Y = 0, Z = 0 }}\n");
    for controller in ["linuxcnc", "grbl"] {
        let shop = shop(controller, &points, "");
        let text = shop.limited(program, "--allow feed");
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines.contains(&"G2 X10 Y0 I5 J0"), "{text}");
        assert!(!lines.contains(&"G2"), "{text}");
        assert!(text.contains("G1 X450.5 Y330."), "{text}");
    }
}

#[test]
fn what_is_not_known_is_asked_for() {
    let program = "G21 G90 G54\nG0 G43 H1 Z50.\nX400.\nG91 G28 Z0\nG28 X0\nM30\n";
    let unknown = shop("haas", "", "reference_mm = 0");
    let (code, _, errors) = unknown.limit(program, "--tool-table tools.tbl");
    assert_eq!(code, 1);
    let offset = "the way to the reference point is not gone by a feed: the work offset is not \
                  known: give it in [offsets] of the machine file, or with --parameters";
    assert!(errors.contains(offset), "{errors}");

    let known = shop("haas", PLACES, "reference_mm = 0");
    let (code, _, errors) = known.limit(program, "");
    assert_eq!(code, 1);
    let length = "the length of the tool is not known: give it with --tool-table";
    assert!(errors.contains(length), "{errors}");
    assert_eq!(known.limit(program, "--tool-table tools.tbl").0, 0);
    // X has no length of a tool in it.
    let along_x = program.replace("G91 G28 Z0\n", "G91 ");
    assert_eq!(known.limit(&along_x, "").0, 0);
    // G55 is known, G56 is not.
    let other = |word: &str| known.limit(&program.replace("G54", word), "--tool-table tools.tbl");
    assert_eq!(other("G55").0, 0);
    for word in ["G56", "G154 P1", "G154 P3"] {
        let (code, _, errors) = other(word);
        assert!(code == 1 && errors.contains(offset), "{errors}");
    }
}

/// Further systems, of which a fixture with many parts has one each.
#[test]
fn further_offsets_are_known_too() {
    let program =
        "G21 G90 G154 P20\nG0 Z50.\nX400.\nG91 G28 Z0\nG90 G154 P1 G0 X10.\nG28 X10.\nM30\n";
    let places = "[offsets]\nG154 = { P20 = { X = -450.5, Z = -300 }, P1 = { X = -20 } }\n";
    for (controller, word, table) in [("haas", "G154", "G154"), ("fanuc", "G54.1", "\"G54.1\"")] {
        let shop = shop(
            controller,
            &places.replace("G154", table),
            "reference_mm = 0",
        );
        let program = program.replace("G154", word);
        let text = shop.limited(&program, "--allow feed");
        assert_eq!(ends(&shop, &program, ""), ends(&shop, &text, ""));
        assert!(text.contains("G1 Z300."), "{text}");
    }
}

#[test]
fn returns_that_stay_as_they_are() {
    let shop = shop("fanuc", PLACES, "reference_mm = 0");
    for (program, why) in [
        (
            "G21 G90 G54 G0 X400. Y300.\nG91 G28 X0 Y0 G55\nM30\n",
            "its words change what coordinates mean",
        ),
        (
            "G21 G90 G54 G0 X400. Y300.\n/G91 G28 X0 Y0\nM30\n",
            "its block may be skipped",
        ),
        (
            "G21 G90 G54 G0 X400. Y300.\nG41 D1 G1 X390. F500.\nX380.\nG91 G28 X0 Y0\nG40\nM30\n",
            "it runs under cutter compensation",
        ),
    ] {
        let (code, _, errors) = shop.limit(program, "--allow feed");
        assert!(code != 0 && errors.contains(why), "{program}\n{errors}");
    }
}

/// At 3 m/min the return takes longer and draws less.
#[test]
fn the_speed_of_the_return() {
    let shop = shop("fanuc", PLACES, "reference_mm = 0\nreference_mm_min = 3000");
    let program = "G21 G90 G54 G0 X0. Y0. Z0.\nG91 G28 Z0\nM30\n";
    shop.put("a.nc", program);
    let (_, csv, _) = shop.run("report a.nc");
    let row: Vec<&str> = csv.lines().last().unwrap().split(',').collect();
    // 300 mm at 50 mm/s, and 50/3000 s more for the two ramps.
    let seconds: f64 = row[5].parse().unwrap();
    assert!((seconds - (6.0 + 50.0 / 3000.0)).abs() < 1e-6, "{row:?}");
    // 0.05·(200·3 + 100)/0.8 and 100 W at rest.
    let peak_w: f64 = row[6].parse().unwrap();
    assert!((peak_w - 143.75).abs() < 1e-6, "{row:?}");
}

/// On LinuxCNC and grbl G28 is a rapid: the speed of homing says nothing of it.
#[test]
fn the_speed_of_homing_is_not_that_of_a_rapid() {
    for controller in ["linuxcnc", "grbl"] {
        let rows = |axis: &str| {
            let shop = shop(controller, "", axis);
            shop.put("a.nc", "G21 G90\nG0 X400 Y300 Z100\nG28 Z50\nM2\n");
            let (code, csv, errors) = shop.run("report a.nc");
            assert_eq!(code, 0, "{errors}");
            csv
        };
        let rapid = rows("reference_mm = 0");
        assert!(rapid.lines().count() >= 4, "{rapid}");
        assert_eq!(rows("reference_mm = 0\nreference_mm_min = 600"), rapid);
    }
}

/// RS274/NGC takes G53 with G1.
#[test]
fn machine_coordinates_with_a_feed() {
    let shop = shop("grbl", PLACES, "");
    let program = "G21 G90 G1 X1 F500\nG53 G0 X400 Y300\nG1 X2\nM2\n";
    let (code, text, errors) = shop.limit(program, "");
    assert_eq!(code, 0, "{errors}");
    assert!(text.contains("G53 G1 X400 Y300 F"), "{text}");
    assert!(text.contains("G1 X2 F500\n"), "{text}");
    assert_eq!(ends(&shop, program, ""), ends(&shop, &text, ""));
}

/// Random programs of rapids, feeds and returns: all axes go where they went, and what is
/// written fits.
#[test]
fn random_programs_return_to_the_same_places() {
    let mut random = Random::new(77);
    let mut certified = 0;
    for case in 0..60 {
        let controller = ["fanuc", "haas", "mazak"][case % 3];
        let shop = shop(controller, PLACES, "reference_mm = 0");
        let mut program = String::from("G21 G90 G54\nG0 X1. Y1. Z1.\nG1 X2. F2000.\n");
        for _ in 0..6 {
            let [x, y, z] = [(); 3].map(|()| (random.within(0.0, 400.0) * 1e3).round() / 1e3);
            let _ = match random.below(8) {
                0 => writeln!(program, "G0 X{x} Y{y}"),
                1 => writeln!(program, "G1 Z{z}"),
                2 => writeln!(program, "G91 G28 Z0.\nG90"),
                3 => writeln!(program, "G28 X{x} Y{y}"),
                4 => writeln!(program, "G53 G0 X-{x} Z-{z}"),
                5 => writeln!(program, "G91\nG28 X0 Y0 Z0\nX1. Y1.\nG90"),
                6 => writeln!(program, "G55 G0 X{x}"),
                _ => writeln!(program, "X{x} Y{y} Z{z}"),
            };
        }
        program.push_str("M30\n");
        let (code, text, errors) = shop.limit(&program, "--allow feed");
        if code == 0 {
            certified += 1;
            assert_eq!(
                ends(&shop, &program, ""),
                ends(&shop, &text, ""),
                "{program}\n{text}"
            );
            shop.put("out.nc", &text);
            assert_eq!(shop.run("check out.nc").0, 0, "{text}");
        } else {
            assert!(code == 1 && text.is_empty(), "{errors}");
        }
    }
    assert!(certified > 50, "{certified} of 60");
}

/// What is said of the way that is gone before a return shows the block of the program.
#[test]
fn reasons_show_the_block_that_returns() {
    let independent = PLACES.replace("[offsets]", "rapid = \"independent\"\n[offsets]");
    let shop = shop("fanuc", &independent, "reference_mm = 50");
    let machine = shop.get("mill.toml");
    shop.put("mill.toml", &machine.replace("rapid = \"linear\"\n", ""));
    let program = "G21 G90 G94 G54\nG91 G28 X0 Y0\nG90\nM30\n";
    let (code, out, errors) = shop.limit(program, "--allow feed -o out.nc");
    assert_eq!(code, 1, "{errors}");
    assert!(
        errors.contains("its axes move each for itself") && errors.contains("a.nc:2:1\n"),
        "{errors}"
    );
    let all = format!("{out}{errors}");
    assert!(all.contains("2 | G91 G28 X0 Y0\n"), "{all}");
    assert!(!all.contains("G0 X"), "{all}");
}
