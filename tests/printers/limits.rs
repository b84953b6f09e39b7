//! Limits of speed and acceleration that printers' programs set.

use insta::assert_snapshot;

use super::*;
use crate::shop::Shop;

/// Marlin M203 in mm/s, RepRapFirmware M203 in mm/min: lower caps the move,
/// higher lifts the machine's limit.
#[test]
fn speed_limits_of_axes() {
    assert_snapshot!(marlin("M203 X20 Y150\nG1 X30 Y40 F60000\nG1 Y50\nG1 X0\n"), @r"
    2 feed X0.000>30.000 Y0.000>40.000 v33.333 raised 1.50
    3 feed Y40.000>50.000 v150.000 raised 1.50
    4 feed X30.000>0.000 v20.000
    ");
    assert_snapshot!(reprap("M203 X1200\nG1 X30 F60000\n"), @"2 feed X0.000>30.000 v20.000");
    // S1: mm/s.
    assert_snapshot!(reprap("M203 S1 X20\nG1 X30 F60000\n"), @"2 feed X0.000>30.000 v20.000");
    assert_snapshot!(klipper("M203 X1200\nG1 X30 F6000\n"), @"2 feed X0.000>30.000 v100.000 a1000");
    // Marlin M205 S: no move that extrudes is slower.
    assert_snapshot!(marlin("M205 S20 T0 X8\nG1 X1 E1 F600\nG1 X2\n"), @r"
    2 feed X0.000>1.000 E0.000>1.000 v20.000
    3 feed X1.000>2.000 v10.000
    note corner-speeds
    ");
    assert_snapshot!(reprap("M566 X1800\nG1 X1 F600\n"), @"2 feed X0.000>1.000 v10.000");
}

/// The extruder's share of an arc is that of each of its chords: 1 mm/s for 12 mm on a quarter of a
/// circle of 60 mm leave 94.248/12 mm/s along it. Of the axes that turn the limit is that of chords.
#[test]
fn speed_limits_of_axes_on_arcs() {
    let arc = "G2 X60 Y60 I60 J0 E12 F6000\n";
    let along = |limit: &str| {
        let moves = marlin(&format!("{limit}\n{arc}"));
        moves.lines().next().unwrap_or_default().to_owned()
    };
    assert!(along("M203 E1").contains(" v7.854"), "{}", along("M203 E1"));
    assert!(
        along("M203 E9").contains(" v70.686"),
        "{}",
        along("M203 E9")
    );
    assert!(
        along("M203 X20").contains(" v100.000"),
        "{}",
        along("M203 X20")
    );
}

/// M220 scales moves of the extruder alone on Marlin, on RepRapFirmware only those that name
/// an axis.
#[test]
fn the_speed_factor_and_the_extruder() {
    let program = "M220 S50\nG1 E5 F600\nG1 X5\n";
    assert_snapshot!(marlin(program), @r"
    2 feed E0.000>5.000 v5.000
    3 feed X0.000>5.000 v5.000
    ");
    assert_snapshot!(reprap(program), @r"
    2 feed E0.000>5.000 v10.000
    3 feed X0.000>5.000 v5.000
    ");
    // Where an axis is named, even if it stays where it is.
    assert_snapshot!(reprap("M220 S50\nG1 X0 E5 F600\n"), @r"
    2 feed E0.000>5.000 v5.000
    ");
    // An arc names X and Y, whatever its words are.
    let arcs = reprap("M83\nM221 S200\nG1 X10 F600\nG2 I5 E3\nG2 X10 Y0 I5 E3\n");
    let fed: Vec<_> = arcs.lines().filter(|line| line.contains(" E")).collect();
    assert!(
        fed[0].contains("E0.000>6.000") && fed[1].contains("E6.000>12.000"),
        "{arcs}"
    );
    // M221 does the same.
    assert_snapshot!(reprap("M221 S50\nG1 E5 F600\nG1 X5 E9\n"), @r"
    2 feed E0.000>5.000 v10.000
    3 feed X0.000>5.000 E5.000>7.000 v10.000
    ");
}

/// RepRapFirmware, DDA.cpp: only forward extrusion is printing (M204 P); a wipe travels (T).
#[test]
fn wipes_travel() {
    let program = "M83\nM204 P500 T800\nG1 X10 E1 F600\nG1 X5 E-0.5\nG2 X15 I5 E-0.5\n";
    assert_snapshot!(reprap(program), @r"
    3 feed X0.000>10.000 E0.000>1.000 v10.000 a500
    4 feed X10.000>5.000 E1.000>0.500 v10.000 a800
    5 arc X5.000>15.000 Y0.000>0.000 E0.500>0.000 v10.000 a800
    ");
    assert_snapshot!(marlin(program), @r"
    3 feed X0.000>10.000 E0.000>1.000 v10.000 a500
    4 feed X10.000>5.000 E1.000>0.500 v10.000 a500
    5 arc X5.000>15.000 Y0.000>0.000 E0.500>0.000 v10.000 a500
    ");
}

/// Marlin M204: S for both, then P and T; R for the extruder alone.
/// RepRapFirmware: moves of X or Y only.
#[test]
fn accelerations_along_the_path() {
    let moves = "G1 X10 E1 F600\nG1 X20\nG1 E2\nG1 Z1\n";
    assert_snapshot!(marlin(&format!("M204 S500 T800\n{moves}M204 R300 P400\n{moves}")), @r"
    2 feed X0.000>10.000 E0.000>1.000 v10.000 a500
    3 feed X10.000>20.000 v10.000 a800
    4 feed E1.000>2.000 v10.000
    5 feed Z0.000>1.000 v10.000 a800
    7 feed X20.000>10.000 E2.000>1.000 v10.000 a400
    8 feed X10.000>20.000 v10.000 a800
    9 feed E1.000>2.000 v10.000 a300
    10 feed v10.000 a300
    ");
    assert_snapshot!(reprap(&format!("M204 P500 T800\n{moves}")), @r"
    2 feed X0.000>10.000 E0.000>1.000 v10.000 a500
    3 feed X10.000>20.000 v10.000 a800
    4 feed E1.000>2.000 v10.000
    5 feed Z0.000>1.000 v10.000
    ");
    assert_snapshot!(reprap("M204 S700 T800\nG1 X10 E1 F600\nG1 X20\n"), @r"
    2 feed X0.000>10.000 E0.000>1.000 v10.000 a700
    3 feed X10.000>20.000 v10.000 a800
    ");
    assert_snapshot!(marlin("M204 P0\n"), @"printer-value: this value is out of range");
}

/// Klipper, [toolhead]: VELOCITY caps the path, ACCEL is along the path; both
/// may be above the machine file. M204: S, or the smaller of P and T.
#[test]
fn klipper_velocity_limits() {
    assert_snapshot!(klipper(
        "SET_VELOCITY_LIMIT VELOCITY=50 ACCEL=700 SQUARE_CORNER_VELOCITY=5 MINIMUM_CRUISE_RATIO=0\n\
         G1 X30 Y40 F60000\nG1 E1\nSET_VELOCITY_LIMIT VELOCITY=300 ACCEL=3000\nG1 X0\n\
         M204 P200 T100\nG1 Y0 F600\nM204 P10\nG1 Y1\nRESET_VELOCITY_LIMIT\nG1 Y0\n"
    ), @r"
    2 feed X0.000>30.000 Y0.000>40.000 v50.000 a700
    3 feed E0.000>1.000 v1000.000
    5 feed X30.000>0.000 v300.000 a3000 raised 3.00
    7 feed Y40.000>0.000 v10.000 a100 raised 3.00
    9 feed Y0.000>1.000 v10.000 a100 raised 3.00
    11 feed Y1.000>0.000 v10.000 a1000
    ");
    assert_snapshot!(klipper("SET_VELOCITY_LIMIT ACCEL={a}\n"), @"printer-value: this value is out of range");
}

/// A raised limit must reach the peak: 10 kg from rest to 300 mm/s at
/// 3000 mm/s² takes 0.3·10·3 = 9 W, at the machine's own limits 1 W.
#[test]
fn raised_limits_raise_the_peak() {
    let machine = machine("klipper");
    let peak = |program: &str| {
        pipeline::analyze(
            Cursor::new(program.as_bytes()),
            &machine,
            &Options::default(),
            None,
        )
        .expect("accepted")
        .peak_w
    };
    let own = peak("G1 X100 F60000\n");
    let raised = peak("SET_VELOCITY_LIMIT VELOCITY=300 ACCEL=3000\nG1 X100 F60000\n");
    assert!((own - 1.0).abs() < 1e-6, "{own}");
    assert!((raised - 9.0).abs() < 1e-6, "{raised}");
    // An arc alike, and Marlin's words for it.
    let marlin = self::machine("marlin");
    let arc = pipeline::analyze(
        Cursor::new("M203 X300 Y300\nG2 X0 Y0 I1000 J0 F60000\n"),
        &marlin,
        &Options::default(),
        None,
    )
    .expect("accepted")
    .peak_w;
    assert!(arc > 2.0, "{arc}");
}

fn peak_w(controller: &str, program: &str) -> f64 {
    let input = Cursor::new(program.as_bytes());
    let machine = machine(controller);
    let found = pipeline::analyze(input, &machine, &Options::default(), None);
    found.expect("accepted").peak_w
}

/// RepRapFirmware: M204 is read while the move before it waits for room in the queue, unless
/// there is room; a line with G1 waits for that. 10 kg at 0.1 m/s and 0.5 m/s² draw 0.5 W.
#[test]
fn limits_may_act_on_the_move_before() {
    let program = |between: &str| {
        format!("M204 P500 T500\nG1 X60 F6000\n{between}M204 P1000 T1000\nG1 X59 F60\n")
    };
    let exact = peak_w("reprap", &program("G1\n"));
    assert!((exact - 0.5).abs() < 1e-6, "{exact}");
    let early = peak_w("reprap", &program(""));
    assert!(early >= 1.0, "{early}");
    assert_eq!(peak_w("reprap", &program("M400\n")), exact);
    assert_eq!(
        peak_w("marlin", &program("")),
        peak_w("marlin", &program("G1\n"))
    );
    // What may be is no change that `limit` has made.
    let shop = Shop::mill("reprap", "peak_power_w = 300", "", "");
    shop.put(
        "a.gcode",
        "M201 X1000 Y1000\nG1 X60 F9000\nM201 X2000\nG1 X0 F1200\nM201 X1500\nG1 X20\n",
    );
    let (_, _, errors) = shop.run("limit a.gcode --allow feed -o out.gcode");
    assert!(!errors.contains("fault of gwatt"), "{errors}");
}

/// The same of M220 and M221 (GCodes2.cpp, case 220; RawMove.cpp): the move before them may be as
/// fast as they say, or push as much filament.
#[test]
fn factors_may_act_on_the_move_before() {
    for (word, low) in [("M220", 20), ("M221", 10)] {
        let program = |first: u32, between: &str| {
            format!(
                "M83\n{word} S{first}\nG1 X60 F3000\nG1 X90 E20\n{between}{word} S100\nG1 X89 F60\n"
            )
        };
        let exact = peak_w("reprap", &program(low, "G1\n"));
        let early = peak_w("reprap", &program(low, ""));
        let full = peak_w("reprap", &program(100, ""));
        assert!(early >= full * (1.0 - 1e-9), "{word}: {early} {full}");
        assert!(exact < 0.9 * full, "{word}: {exact} {full}");
        let marlin = |between| peak_w("marlin", &program(low, between));
        assert_eq!(marlin(""), marlin("G1\n"));
    }
}

/// M566 holds for the corners of moves that wait (DDA.cpp, `MatchSpeeds`): short moves that end fast
/// where they turn, though the program raises the steps after them.
#[test]
fn corners_may_be_set_for_moves_that_wait() {
    let short = (1..20).fold(String::new(), |mut text, number| {
        let _ = writeln!(text, "G1 X{number} Y{} F18000", number % 2);
        text
    });
    let program = |first: u32, wait: &str| {
        format!(
            "M566 X{first} Y{first}\nG1 X0 Y1 F6000\n{short}{wait}M566 X6000 Y6000\nG1 X40 F600\n"
        )
    };
    let [exact, early, full] = [(60, "M400\n"), (60, ""), (6000, "")]
        .map(|(first, wait)| peak_w("reprap", &program(first, wait)));
    assert!(early >= full * (1.0 - 1e-9), "{early} {full}");
    assert!(exact < 0.9 * full, "{exact} {full}");
}

/// Lines that do not move have no place in that queue.
#[test]
fn lines_without_motion_do_not_fill_the_queue() {
    let program = |still: &str, wait: &str| {
        let zigzag = (1..8).map(|x| format!("G1 X{x} Y{} F18000\n", x % 2));
        let slow = (8..30).map(|x| format!("G1 X{x} F600\n{}", still.replace('#', &x.to_string())));
        let short: String = zigzag.chain(slow).collect();
        format!("M566 X60 Y60\nG1 X0 Y1 F6000\n{short}{wait}M566 X6000 Y6000\nG1 X70 F600\n")
    };
    let [plain, still] =
        ["", "G1 X#\nG1 X#\nG1 X#\nG1 X#\n"].map(|still| peak_w("reprap", &program(still, "")));
    assert!(still >= plain * (1.0 - 1e-9), "{still} {plain}");
    assert!(
        plain > 2.0 * peak_w("reprap", &program("", "M400\n")),
        "{plain}"
    );
}

/// What a command switches on after a move in its line, that move does not show.
#[test]
fn loads_of_a_line_with_several_commands() {
    let program = "M83\nG1 X5 F600 M106 S255\nM107\nG1 X9\n";
    let alone = program.replace(" M106", "\nM106");
    let [one, several] = [program, &alone].map(|text| peak_w("reprap", text));
    assert_eq!(one, several);
    assert!(one >= 5.0, "{one}");
}

/// An extruder that goes 45 times as far as X, which is the path, accelerates 45 times as fast.
#[test]
fn an_extruder_that_goes_further_than_the_path() {
    let program = |first: u32| {
        format!(
            "M83\nM204 P{first} T{first}\nM566 X0.6 Y0.6 Z0.6 E0.6\nG1 X1 F60\nG1 X3 E90 F6000\nM204 P20 T20\nG1 X10 F60\n"
        )
    };
    let [early, full] = [2, 20].map(|first| peak_w("reprap", &program(first)));
    assert!(early >= full * (1.0 - 1e-9), "{early} {full}");
}

/// RepRapFirmware sees more or fewer moves, as time goes. Of 1 mm at 50 mm/s² it is as fast as it can
/// stop in those that it sees: √(2·50·29) = 54 mm/s to 77 mm/s. Peaks are those of the worst.
#[test]
fn how_much_is_seen_is_a_matter_of_timing() {
    let peak_w = |blocks, most, program: &str| {
        let mut machine = machine("reprap");
        let rules = machine
            .controller
            .planner
            .look_ahead
            .as_mut()
            .expect("rules");
        (rules.blocks, rules.blocks_at_most) = (Some(blocks), most);
        let input = Cursor::new(program.as_bytes());
        let found = pipeline::analyze(input, &machine, &Options::default(), None);
        found.expect("accepted").peak_w
    };
    let short = format!("M204 P50 T50\nG91\nG1 F6000\n{}", "G1 X1\n".repeat(200));
    let ranged = peak_w(29, Some(59), &short);
    for blocks in [29, 37, 45, 52, 59] {
        let fixed = peak_w(blocks, None, &short);
        assert!(fixed <= ranged * (1.0 + 1e-9), "{blocks}: {fixed} {ranged}");
    }
    assert!(peak_w(29, None, &short) < 0.9 * ranged);
    assert!(peak_w(59, None, &short) > 0.9 * ranged);
    // Where a move stops within 29 of them all is the same.
    let long = format!("M204 P1000 T1000\nG91\nG1 F6000\n{}", "G1 X1\n".repeat(200));
    assert_eq!(peak_w(29, Some(59), &long), peak_w(29, None, &long));
}

/// Marlin: M204 R alone limits moves of the extruder alone, whatever M201 says of it: 10 kg at
/// 0.01 m/s and 0.8 m/s² draw 0.08 W.
#[test]
fn retractions_have_a_limit_of_their_own() {
    let program = "M201 E100\nM204 R800\nG1 E5 F600\n";
    let peak_w = peak_w("marlin", program);
    assert!((peak_w - 0.08).abs() < 1e-9, "{peak_w}");
}

/// Between the moves of homing the axes stand: each axis draws
/// (200 kg · 3 m/s² + 100 N) · 0.05 m/s / 0.8 = 43.75 W next to 100 W, with those that home
/// together, whatever comes before and after.
#[test]
fn moves_of_homing_do_not_blend() {
    let axis = "reference_mm = 0\nreference_mm_min = 3000";
    for (controller, together) in [("marlin", 2.0), ("klipper", 1.0), ("reprap", 3.0)] {
        let shop = Shop::mill(controller, "peak_power_w = 5000", "", axis);
        shop.put("a.gcode", "G1 Z5 F600\nG28\nG1 X10 F600\n");
        let (code, out, errors) = shop.run("check a.gcode --format json");
        assert_eq!(code, 0, "{errors}");
        let found: serde_json::Value = serde_json::from_str(&out).unwrap();
        let peak_w = found[0]["peak_w"].as_f64().unwrap();
        let expected = 100.0 + 43.75 * together;
        assert!((peak_w - expected).abs() < 1e-6, "{controller} {peak_w}");
    }
    // Friction takes 100 N · 0.05 m/s / 0.8 = 6.25 W of each; the rest a lower acceleration
    // leaves.
    let shop = Shop::mill("marlin", "peak_power_w = 120", "", axis);
    shop.put("a.gcode", "G28\nG1 X10 F600\n");
    let (code, _, errors) = shop.run("limit a.gcode -o out.gcode");
    assert_eq!(code, 0, "{errors}");
    assert!(shop.get("out.gcode").starts_with("M201 "), "{errors}");
}
