//! What a setting of the control decides, or a word of its own: each counts higher, is followed
//! with a note, or is refused.
//!
//! Sources: Fanuc B-64304EN ("Arithmetic and logic operation", "Modal call", "Programmable data
//! input"), Haas mill operator's manual 96-8000, SINUMERIK "Fundamentals".

use std::io::Cursor;

use gwatt::pipeline::{LimitOptions, Options, analyze, limit};
use insta::assert_snapshot;

use crate::fanuc::{moves, notes};
use crate::listing::{listing, machine, machine_of, refusals};
use crate::machines::{linear_axes, machine_from};
use crate::runs::{rows_of, summary_of};

fn on_lathe(more: &str, program: &str) -> String {
    listing(program, &machine_of("siemens", more, "XZ", ""), None)
}

const TURNS: &str = "G18 G90 DIAMON\nS1000 M3\nG0 X50 Z2\nG1 Z-20 F0.2\n";

/// MD20150: a lathe may begin in G94 or in G95, the faster by far.
#[test]
fn a_lathe_of_sinumerik_counts_feeds_per_revolution() {
    assert_snapshot!(on_lathe("", TURNS), @r"
    3 rapid X25 Z2
    4 feed Z-20 F200
    ");
    let per_minute = "[language]\nfeed = \"per-minute\"\n";
    assert_snapshot!(on_lathe(per_minute, TURNS), @r"
    3 rapid X25 Z2
    4 feed Z-20 F0.2
    ");
    let said = TURNS.replace("G90", "G90 G94");
    assert_eq!(on_lathe("", &said), on_lathe(per_minute, TURNS));
    let without_speed = "G18 G90 DIAMON\nG0 X50 Z2\nG1 Z-20 F0.2\n";
    assert_snapshot!(on_lathe("", without_speed), @r"
    2 rapid X25 Z2
    3 feed Z-20
    ");
}

/// Mills begin in G94.
#[test]
fn a_mill_of_sinumerik_counts_feeds_per_minute() {
    let mill = machine("siemens");
    assert_snapshot!(listing("S1000 M3\nG1 X20 F200\n", &mill, None), @r"
    2 feed X20 F200
    ");
}

/// "Reference point of the polar coordinates (G110, G111, G112)": of X a diameter under DIAMON.
#[test]
fn the_pole_of_a_lathe_is_a_diameter() {
    let program = "G18 G90 G95 DIAMON\nS1000 M3\nG0 X0 Z0\nG111 X40 Z0\nG1 AP=90 RP=10 F0.1\n\
                   G110 X10 Z0\nG1 AP=90 RP=5\n";
    assert_snapshot!(on_lathe("", program), @r"
    3 rapid
    5 feed X30 F100
    7 feed X40 F100
    ");
}

/// B-64304EN, "ROUND function": in an address to the least input increment.
#[test]
fn round_in_an_address_keeps_its_decimals() {
    let program = "G21 G90 G94\n#1=1.2345\n#2=2.3456\nG0 X0\nG91 G0 X-#1\nG1 X-#2 F100\n\
                   G0 X[ROUND[#1]+ROUND[#2]]\n#3=ROUND[#2]\nG0 X#3\nG20 G0 X[ROUND[#1]]\n\
                   G1 X1. F[ROUND[0.2]]\n";
    assert_snapshot!(moves("fanuc", program), @r"
    4 rapid
    5 rapid X-1.2345
    6 feed X-3.5801 F100.0000
    7 rapid X0.0009
    9 rapid X2.0009
    10 rapid X33.3699
    11 feed X58.7699 F5.0800
    ");
}

/// A line that has run in metric lengths rounds to inches after G20; the number of a parameter is
/// arithmetic.
#[test]
fn round_follows_the_unit_and_the_place() {
    let runs = "M98 P2\n".repeat(4);
    let sub = "O2\nG0 X[ROUND[#1]]\nM99\n";
    let program = format!("G21 G90\n#1=1.23456\n{runs}G20\nM98 P2\nM30\n{sub}");
    let last = moves("fanuc", &program);
    // 1.2346 in.
    assert!(last.trim_end().ends_with("X31.3588"), "{last}");
    assert_snapshot!(moves("fanuc", "G21 G90\n#1=2.4\n#2=5.\nG0 X#[ROUND[#1]]\n"), @r"
    4 rapid X5.0000
    ");
}

/// B-64304EN, parameter 6004 bit NAT.
#[test]
fn inverse_functions_give_what_a_parameter_says() {
    let program =
        "G21 G90\n#1=ATAN[-1.]/[-1.]\nG0 X#1\n#2=ASIN[-0.5]\nX#2\n#3=ATAN[1.]/[1.]\nX#3\n";
    assert_snapshot!(moves("fanuc", program), @r"
    3 rapid X225.0000
    5 rapid X330.0000
    7 rapid X45.0000
    ");
    assert_eq!(notes("fanuc", program), ["inverse-angle"]);
    let signed = machine_of(
        "fanuc",
        "[language]\ninverse_angles = \"signed\"\n",
        "XYZ",
        "",
    );
    assert_snapshot!(listing(program, &signed, None), @r"
    3 rapid X-135
    5 rapid X-30
    7 rapid X45
    ");
    // Nothing depends on it.
    let positive = "G21 G90\n#1=ATAN[1.]/[-1.]\nG0 X#1\n";
    assert!(!notes("fanuc", positive).contains(&"inverse-angle"));
    assert_eq!(notes("mazak", program), ["inverse-angle"]);
}

/// "Modal call nesting": the macro of the second would call that of the first.
#[test]
fn modal_calls_in_each_other() {
    let program = "G66 P400 A1.\nG66 P400 A2.\nG0 X10.\nG67\nM30\nO400\nG0 Z#1\nM99\n";
    assert_snapshot!(moves("fanuc", program), @r"
    2 subprogram: a second G66 while one is in force: its macro would call the first one's
    ");
    let after = program.replacen("\nG66", "\nG67\nG66", 1);
    assert_snapshot!(moves("fanuc", &after), @r"
    4 rapid X10.0000
    8 rapid Z2.0000
    ");
}

/// Which of two blocks of one number G70 goes back to is known where a roughing cycle has read one.
#[test]
fn contours_of_one_number() {
    let contour = |x: u32| {
        format!(
            "G0 X60. Z2.\nG71 U2. R1.\nG71 P10 Q20 U0.4 W0.1 F0.2\nN10 G0 X{x}.\nG1 Z-20.\nN20 X60.\n"
        )
    };
    let finish = "G70 P10 Q20\n";
    let start = "G97 S500 M3\n";
    // That of the roughing cycle before it.
    let before = format!("{start}{}{finish}", contour(40));
    let twice = format!("{before}{}", contour(30));
    let both = moves("fanuc-lathe", &twice);
    assert!(both.starts_with(&moves("fanuc-lathe", &before)), "{both}");
    // Without one.
    let alone = |x: u32| format!("N10 G0 X{x}.\nG1 Z-20. F0.2\nN20 X60.\n");
    let neither = format!("{start}G0 X60. Z2.\n{}{finish}{}", alone(40), alone(30));
    assert_snapshot!(moves("fanuc-lathe", &neither), @r"
    6 contour: N10 stands in line 3 and in line 7: which contour G70 takes is not known
    ");
    let once = format!("{start}{}{finish}", contour(40));
    assert!(moves("fanuc-lathe", &once).contains("feed"));
}

/// P0 is no tool: it moves the coordinate system.
#[test]
fn a_shift_by_g10() {
    assert_snapshot!(moves("fanuc-lathe", "G10 P0 X-2. Z1.\nG0 X10.\n"), @r"
    1 data-setting: G10 P0 shifts the workpiece coordinate system, which is not followed
    ");
}

/// S of M19 is an angle.
#[test]
fn an_oriented_spindle_makes_no_feed_slower() {
    assert_snapshot!(moves("fanuc", "G95 S1000 M3\nM19 S90\nG1 X10. F0.2\n"), @r"
    3 feed X10.0000 F200.0000
    ");
}

/// SB turns the tool of a lathe, and feeds per revolution may follow it.
#[test]
fn the_tool_of_a_lathe_has_its_own_spindle() {
    let lathe = machine_of("okuma-lathe", "", "XZ", "C");
    let program = "G97 S500 M3\nG0 X40 Z2\nSB=3000 M13\nG95 G1 Z-5 F0.2\nSB=100\nZ-9\n";
    assert_snapshot!(listing(program, &lathe, None), @r"
    2 rapid X20 Z2
    4 feed Z-5 F600
    6 feed Z-9 F100
    ");
    let mill = machine("okuma");
    let bore = "G15 H1\nG71 Z50\nS500 M3\nG85 X10 Y10 R3 Z-10 F100 FA=500 M53\n";
    assert_snapshot!(refusals(bore, &mill), @r"
    4 unsupported-word: FA, the feed of the way out of a bore, which is not followed
    ");
}

/// "G87 Bore In and Manual Retract": back to the level where the cycle ends, from wherever the
/// operator has stopped.
#[test]
fn a_bore_that_the_operator_leaves() {
    let program = "G21 G90 G94 S500 M3\nG0 X0. Y0. Z10.\nG99 G87 X15. Z-5. R2. F250.\nG80\n";
    assert_snapshot!(moves("haas", program), @r"
    2 rapid Z10.0000
    3 rapid X15.0000
    3 rapid Z2.0000
    3 feed Z-5.0000 F250.0000
    3 rapid
    ");
}

/// A stop of unknown length (M0) is long enough for what was asked for before it: the spindle brakes,
/// and runs up again after it; loads that go off after it were on.
#[test]
fn what_happens_during_a_stop() {
    let text = "schema = 1\nname = \"test\"\ncontroller = \"fanuc\"\n[converter]\npeak_power_w = 1e6\n\
                [spindle]\ninertia_kg_m2 = 0.02\nmax_rpm = 8000\naccel_time_s = 1\npeak_power_w = 1400\n\
                wait = true\n[[load]]\non = \"M8\"\noff = \"M9\"\npower_w = 1600\n";
    let machine = machine_from(&format!(
        "{text}{}",
        linear_axes("X", [6000.0, 1000.0, 10.0], "")
    ));
    let figures = |program: &str| {
        let found = summary_of(&machine, &format!("G21 G90\n{program}M30\n"));
        (found.peak_w, found.regen_w)
    };
    let with = |stop: &str| format!("S8000 M3\nG1 X10. F100\nM5\n{stop}\nM3\nG4 X9.\n");
    let (stopped, waited) = (figures(&with("M0")), figures(&with("G4 X9.")));
    assert!(
        stopped.0 >= waited.0 * 0.999 && stopped.1 >= waited.1 * 0.999,
        "{stopped:?} {waited:?}"
    );
    assert!(waited.1 > 1000.0, "{waited:?}");
    // What feeds back more than the converter takes has a row of its own.
    let weak = text.replace(
        "peak_power_w = 1e6",
        "peak_power_w = 1e6\nregen_power_w = 1300",
    );
    let weak = machine_from(&format!(
        "{weak}{}",
        linear_axes("X", [6000.0, 1000.0, 10.0], "")
    ));
    let runs = summary_of(
        &weak,
        "G21 G90\nS1000 M3\nG1 X2. F100\nS8000\nM0\nM5\nM30\n",
    );
    assert!(runs.peak_w >= 1400.0 && runs.regen_w > 10_000.0, "{runs:?}");
    assert!(figures("G0 X1.\nM8\nM0\nM9\n").0 >= 1600.0);
    // Without a stop they count with the next move.
    assert!(figures("G0 X1.\nM8\nM9\nG0 X2.\nG0 X3.\n").0 >= 1600.0);
    let rows = rows_of(&machine, "G21 G90\nG0 X1.\nM8\nM9\nG0 X2.\nG0 X30.\nM30\n");
    let last = rows.last().expect("a row");
    assert!(last.peak_w < 1600.0, "{}", last.peak_w);
}

/// A dwell that `limit` writes before a rapid shows a load no less than the rapid does.
#[test]
fn a_stop_that_is_written_leaves_loads_to_the_move() {
    let machine = machine_from(&format!(
        "schema = 1\nname = \"test\"\ncontroller = \"fanuc\"\n[path]\nrapid = \"linear\"\n\
         [converter]\npeak_power_w = 400\n\
         [[load]]\non = \"M8\"\noff = \"M9\"\npower_w = 100\n{}",
        linear_axes("XYZ", [30000.0, 5000.0, 150.0], "")
    ));
    let program = "G21 G90 G94\nG0 X190. F100\nM8\nM9\nG0 X0 Z90.\nG0 Y5.\nM0\nM30\n";
    let input = Cursor::new(program.as_bytes());
    let (options, how) = (Options::default(), LimitOptions::default());
    let found = limit(input, &machine, &options, how, Vec::new(), None).expect("read");
    assert!(
        found.certified && found.edited_lines > 0,
        "{:?}",
        found.reasons
    );
}

/// What is on when the text ends has been judged nowhere: that is said.
#[test]
fn a_load_at_the_end_of_the_text_is_said_not_to_count() {
    let machine = machine_from(&format!(
        "schema = 1\nname = \"test\"\ncontroller = \"iso\"\n[converter]\npeak_power_w = 400\n\
         [[load]]\non = \"M8\"\noff = \"M9\"\npower_w = 1000\n{}",
        linear_axes("XYZ", [30000.0, 5000.0, 150.0], "")
    ));
    let rules = |program: &str| -> Vec<&str> {
        let input = Cursor::new(program.as_bytes());
        let found = analyze(input, &machine, &Options::default(), None).expect("read");
        found.notes.iter().map(|note| note.rule).collect()
    };
    assert_eq!(rules("G21 G90\nG0 X1\nM8\n"), ["loads-at-end"]);
    assert!(rules("G21 G90\nG0 X1\nM8\nM30\n").is_empty());
    assert!(rules("G21 G90\nG0 X1\nM8\nG4 P1\n").is_empty());
    assert!(rules("G21 G90\nG0 X1\nM8\nM0\n").is_empty());
    assert!(rules("G21 G90\nG0 X1\nM8\nG0 X2\n").is_empty());
    // It was on for a while all the same.
    assert_eq!(rules("G21 G90\nG0 X1\nM8\nM9\n"), ["loads-at-end"]);
    assert!(rules("G21 G90\nM8\nG0 X1\nM9\n").is_empty());
}
