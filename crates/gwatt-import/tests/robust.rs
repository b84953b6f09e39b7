//! Whatever comes in: a machine file that can be read, or findings; never a panic.

use gwatt_import::{FORMATS, File, Nothing, Wanted, import};
use gwatt_machine::Machine;
use gwatt_syntax::diagnostic::Severity;
use proptest::prelude::*;

/// Pieces of which settings are made, and such as break them.
fn piece() -> impl Strategy<Value = String> {
    let fixed = prop::sample::select(vec![
        "$110=",
        "$120=",
        "$130=",
        "N01420",
        "N01620",
        "Q1",
        "A1",
        "A2",
        "L1",
        "S1",
        "P",
        "M203 ",
        "M201 ",
        "M566 ",
        "M205 ",
        "X",
        "Y",
        "E",
        "[printer]\n",
        "[stepper_x]\n",
        "[extruder]\n",
        "max_velocity: ",
        "max_accel: ",
        "[TRAJ]\n",
        "[AXIS_X]\n",
        "MAX_VELOCITY = ",
        "MAX_ACCELERATION = ",
        "LINEAR_UNITS = ",
        "[RS274NGC]\nRS274NGC_STARTUP_CODE = ",
        "G20F",
        "G95",
        "G64P",
        "[DISPLAY]\nMAX_FEED_OVERRIDE = ",
        "if x\n  ",
        "kinematics: corexz\n",
        "M669 K1\n",
        "N00981 A1 P1",
        "[extruder1]\nnozzle_diameter: ",
        "$MA_MAX_AX_VELO[AX1]=",
        "$MA_MAX_AX_ACCEL[0,AX1]=",
        "$MN_AXCONF_MACHAX_NAME_TAB[0]=\"X\"",
        "#define DEFAULT_MAX_FEEDRATE { ",
        "#define X_MIN_POS ",
        "}",
        "axes:\n",
        "  x:\n",
        "    max_rate_mm_per_min: ",
        "echo:",
        "\n",
        "\r",
        "\t",
        " ",
        "1",
        "36000",
        "-5",
        "0.5",
        "1e308",
        "1e-308",
        "9999999999999999999",
        ":",
        "=",
        "\"",
        "{",
        ";",
        "#",
        "ü",
        "\u{7f}",
        "inch",
        "(",
        "*",
    ])
    .prop_map(str::to_owned);
    prop_oneof![8 => fixed, 1 => ".{0,4}"]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn any_settings(pieces in prop::collection::vec(piece(), 0..60), format in 0..=FORMATS.len()) {
        let wanted = Wanted { format: FORMATS.get(format).map(|(format, _)| *format), controller: None };
        let file = File { name: "any".to_owned(), bytes: pieces.concat().into_bytes() };
        match import(std::slice::from_ref(&file), wanted, &Nothing) {
            Ok(found) => {
                // What is missing is reported, and nothing else: the file itself is in order.
                let read = Machine::from_toml("any.toml", &found.toml);
                for finding in read.err().into_iter().flatten().filter(|it| it.severity == Severity::Error) {
                    let expected = ["machine-missing", "machine-range"].contains(&finding.rule);
                    prop_assert!(expected, "{}: {}\n{}", finding.rule, finding.message, found.toml);
                }
                prop_assert_eq!(import(&[file], wanted, &Nothing).unwrap().toml, found.toml);
            }
            Err(findings) => prop_assert!(!findings.is_empty()),
        }
    }

    #[test]
    fn any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..300), format in 0..FORMATS.len()) {
        let wanted = Wanted { format: FORMATS.get(format).map(|(format, _)| *format), controller: None };
        let _ = import(&[File { name: "any".to_owned(), bytes }], wanted, &Nothing);
    }
}
