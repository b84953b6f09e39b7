//! Values that are worked out: exact figures and every message.
//!
//! RS274/NGC: LinuxCNC, "G-Code Overview" (Parameters, Expressions, Binary
//! Operators, Functions); Fanuc: B-63944EN, "Custom Macro".

mod random;

use std::io::Cursor;

use gwatt::pipeline::{Failure, Options, moves};

use crate::listing::machine_of;

/// Where X is at the end of a program; or line, rule and message of the first
/// error.
fn end(controller: &str, program: &str) -> Result<f64, String> {
    let mut x = 0.0;
    let run = moves(
        Cursor::new(program.to_owned()),
        &machine_of(controller, "", "XYZ", ""),
        &Options::default(),
        &mut |mv, _| {
            x = mv.end[0];
            Ok(())
        },
    );
    match run {
        Ok(_) => Ok(x),
        Err(Failure::Refused { diagnostics, .. }) => {
            let found = &diagnostics[0];
            Err(format!("{} {}: {}", found.line, found.rule, found.message))
        }
        Err(other) => panic!("{other}"),
    }
}

/// The value of `text` as the X word of a rapid.
fn value(controller: &str, text: &str) -> Result<f64, String> {
    end(controller, &format!("G21 G90\nG0 X{text}\n"))
}

fn near(controller: &str, cases: &[(&str, f64)]) {
    for (text, expected) in cases {
        let found = value(controller, text).unwrap_or_else(|error| panic!("{text}: {error}"));
        let close = (found - expected).abs() <= 1e-12 * expected.abs().max(1.0);
        assert!(close, "{controller} {text}: {found} instead of {expected}");
    }
}

const BOTH: [&str; 2] = ["linuxcnc", "iso"];

/// LinuxCNC, "Expressions", "Binary Operators"; B-63944EN, "Arithmetic and Logic
/// Operation": brackets, the order of operators, signs.
#[test]
fn arithmetic_and_its_order() {
    for controller in BOTH {
        near(
            controller,
            &[
                ("[1+2*3]", 7.0),
                ("[[1+2]*3]", 9.0),
                ("[10-4-3]", 3.0),
                ("[24/4/2]", 3.0),
                ("[7 MOD 4]", 3.0),
                ("[2+7 mod 4*2]", 8.0),
                ("-[1+2]", -3.0),
                ("+[1+2]", 3.0),
                ("-[-2]", 2.0),
                ("[-2*-3]", 6.0),
                ("[1--2]", 3.0),
                ("[.5+5.]", 5.5),
            ],
        );
    }
    near(
        "linuxcnc",
        &[
            ("[2**3]", 8.0),
            ("[2**3**2]", 64.0),
            ("[-2**2]", 4.0),
            ("[2*3**2]", 18.0),
            ("[-7 mod 3]", 2.0),
            ("[7 mod -3]", 1.0),
            ("[5.5 mod 2]", 1.5),
            ("1 0 . 5", 10.5),
            ("[1 0 m o d 4]", 2.0),
        ],
    );
    // The remainder has the sign of the dividend.
    near("iso", &[("[-7 MOD 3]", -1.0), ("[7 MOD -3]", 1.0)]);
}

/// LinuxCNC, "Binary Operators", "Equality and floating-point values"; B-63944EN,
/// "Branch and Repetition", "Operators".
#[test]
fn comparison_and_logic() {
    near(
        "linuxcnc",
        &[
            ("[1 EQ 1]", 1.0),
            ("[1.000099 EQ 1]", 1.0),
            ("[1.00011 EQ 1]", 0.0),
            ("[1 NE 2]", 1.0),
            ("[2 GT 1]", 1.0),
            ("[1.00005 GT 1]", 1.0),
            ("[1 GE 1.00005]", 0.0),
            ("[1 LT 1]", 0.0),
            ("[1 LE 1]", 1.0),
            ("[2 AND 4]", 1.0),
            ("[2 AND 0]", 0.0),
            ("[0 OR 3]", 1.0),
            ("[2 XOR 3]", 0.0),
            ("[2 XOR 0]", 1.0),
            // All three bind alike, below the comparisons.
            ("[1 OR 0 AND 0]", 0.0),
            ("[1 XOR 1 OR 1]", 1.0),
            ("[1+1 EQ 2 AND 3 GT 2]", 1.0),
        ],
    );
    // Fanuc: bit by bit; AND binds as a product, OR and XOR as a sum.
    near(
        "iso",
        &[
            ("[6 AND 3]", 2.0),
            ("[4 OR 3]", 7.0),
            ("[6 XOR 3]", 5.0),
            ("[1 OR 2 AND 3]", 3.0),
            ("[8+6 AND 3]", 10.0),
            ("[1.00001 EQ 1]", 0.0),
        ],
    );
}

/// LinuxCNC, "Functions"; B-63944EN, "Arithmetic and Logic Operation".
#[test]
fn functions() {
    for controller in BOTH {
        near(
            controller,
            &[
                ("[ABS[-3.5]]", 3.5),
                ("[ACOS[0.5]]", 60.0),
                ("[ASIN[-0.5]]", -30.0),
                ("[ATAN[1]/[-1]]", 135.0),
                ("[ATAN[-1]/[-1]]", -135.0),
                ("[ATAN[3]/[4]*2]", 73.739_795_291_688_04),
                ("[COS[60]]", 0.5),
                ("[SIN[30]]", 0.5),
                ("[TAN[45]]", 1.0),
                ("[EXP[0]]", 1.0),
                ("[LN[EXP[2]]]", 2.0),
                ("[SQRT[16]]", 4.0),
                ("[FIX[2.8]]", 2.0),
                ("[FUP[2.2]]", 3.0),
                ("-SIN[90]", -1.0),
            ],
        );
    }
    near(
        "linuxcnc",
        &[("[ROUND[2.5]]", 3.0), ("[ROUND[-2.5]]", -3.0)],
    );
    // In an address to its last decimal.
    near(
        "iso",
        &[("[ROUND[2.5]]", 2.5), ("[ROUND[-2.5006]]", -2.501)],
    );
    // Down and up; Fanuc: to zero and away from it.
    near("linuxcnc", &[("[FIX[-2.8]]", -3.0), ("[FUP[-2.2]]", -2.0)]);
    near("iso", &[("[FIX[-2.8]]", -2.0), ("[FUP[-2.2]]", -3.0)]);
    near(
        "iso",
        &[
            ("[ATAN[1]]", 45.0),
            ("[ATAN[1,-1]]", 135.0),
            ("[POW[2,3]]", 8.0),
            ("[SQR[9]]", 3.0),
            ("[ASN[1]]", 90.0),
            ("[ACS[0]]", 90.0),
            ("[ATN[1]]", 45.0),
            ("[RND[1.5006]]", 1.501),
        ],
    );
}

/// LinuxCNC, "Parameters": a value takes effect after its block.
#[test]
fn parameters_take_effect_behind_their_block() {
    let end = |program: &str| end("linuxcnc", program);
    assert_eq!(end("#1=5\n#1=6 G0 X#1\n"), Ok(5.0));
    assert_eq!(end("#1=1 #1=2 #1=3\nG0 X#1\n"), Ok(3.0));
    assert_eq!(end("#1=2 #2=7\nG0 X##1\n"), Ok(7.0));
    assert_eq!(end("#[1+1]=4\nG0 X#[3-1]\n"), Ok(4.0));
    assert_eq!(end("#<Big Name>=4\nG0 X#<bigname>\n"), Ok(4.0));
    assert_eq!(end("#1.00005=4\nG0 X#0.99995\n"), Ok(4.0));
    assert_eq!(end("G0 X[#10+5]\n"), Ok(5.0));
    assert_eq!(
        end("#<a>=1\nG0 X[EXISTS[#<a>]*10+EXISTS[#<b>]]\n"),
        Ok(10.0)
    );
}

/// B-63944EN, "Variables", "Undefined variable".
#[test]
fn null_is_nothing() {
    let end = |program: &str| end("iso", program);
    // As if the word were not written.
    assert_eq!(end("G0 X5\nG0 X#1 Y1\n"), Ok(5.0));
    assert_eq!(end("G0 X[#1+2]\n"), Ok(2.0));
    assert_eq!(end("IF[#1 EQ #0] THEN #2=3\nG0 X#2\n"), Ok(3.0));
    assert_eq!(end("#2=9\nIF[#1 EQ 0] THEN #2=3\nG0 X#2\n"), Ok(9.0));
    assert_eq!(end("#2=9\nIF[#1 NE 0] THEN #2=3\nG0 X#2\n"), Ok(3.0));
    assert_eq!(end("#2=9\nIF[#1 GE 0] THEN #2=3\nG0 X#2\n"), Ok(3.0));
    assert_eq!(end("#1=#0\n#2=5\n#2=#1\nG0 X7\nX#2\n"), Ok(7.0));
}

#[test]
fn every_message() {
    let depth = format!("{}1{}", "[".repeat(70), "]".repeat(70));
    let cases: &[(&str, &str)] = &[
        (
            &depth,
            "expression: more than 64 brackets and signs in one another",
        ),
        ("[1+]", "expression: a value is missing here"),
        ("[1+2", "expression: `]` is missing here"),
        ("[1.2.3]", "expression: `1.2.3` is not a number"),
        ("#<a>", "no-such-parameter: #<a> has no value"),
        ("#9999", "no-such-parameter: #9999 has no value"),
        ("#5602", "no-such-parameter: #5602 has no value"),
        (
            "#1.5",
            "no-such-parameter: 1.5 is not the number of a parameter",
        ),
        (
            "#[-1]",
            "no-such-parameter: -1 is not the number of a parameter",
        ),
        ("#<a", "expression: a name in < > is not closed"),
        ("[FOO[1]]", "expression: `FOO` is no function"),
        ("[POW[1]]", "expression: `POW` is no function"),
        (
            "[SIN 5]",
            "expression: the argument of a function stands in brackets",
        ),
        ("[EXISTS[1]]", "expression: `#` is missing here"),
        (
            "[EXISTS[#1+1]]",
            "expression: EXISTS takes one parameter in brackets",
        ),
        ("[ATAN[1]]", "arithmetic: ATAN[…] without /[…] after it"),
        ("[1/0]", "arithmetic: a division by zero"),
        ("[1 MOD 0]", "arithmetic: a division by zero"),
        ("[EXP[1000]]", "arithmetic: a result beyond all numbers"),
        (
            "[-8**0.5]",
            "arithmetic: a negative number to a power that is not whole",
        ),
        ("[ACOS[2]]", "arithmetic: ACOS of a number beyond -1 and 1"),
        ("[ASIN[2]]", "arithmetic: ASIN of a number beyond -1 and 1"),
        ("[LN[0]]", "arithmetic: LN of a number that is not positive"),
        ("[SQRT[-1]]", "arithmetic: SQRT of a negative number"),
        ("[ROUND[1e10]]", "expression: `]` is missing here"),
        (
            "[ROUND[3000000000]]",
            "arithmetic: ROUND of a number beyond 2147483647",
        ),
    ];
    for (text, expected) in cases {
        assert_eq!(
            value("linuxcnc", text),
            Err(format!("2 {expected}")),
            "{text}"
        );
    }
    let cases = [
        (
            "[SIN[1,2]]",
            "arithmetic: a second argument of a function that takes one",
        ),
        (
            "[9000000000 AND 1]",
            "arithmetic: a logical operation on a number of more than 32 bits",
        ),
        ("[EXISTS[#1]]", "expression: `EXISTS` is no function"),
    ];
    for (text, expected) in cases {
        assert_eq!(value("iso", text), Err(format!("2 {expected}")), "{text}");
    }
}

#[test]
fn every_message_of_an_assignment() {
    let many = "#1=1".repeat(65);
    let words = "X[1]".repeat(257);
    let cases = [
        (
            "linuxcnc",
            "#0=1",
            "assignment: this cannot be assigned: #0 is always null",
        ),
        (
            "linuxcnc",
            "#5602=1",
            "assignment: this cannot be assigned: there are parameters up to #5601",
        ),
        (
            "iso",
            "#3000=1",
            "alarm: #3000 raises an alarm before anything has moved: whether the program fits is not known",
        ),
        (
            "iso",
            "#5221=1",
            "assignment: this cannot be assigned: it belongs to the control, and may change offsets",
        ),
        (
            "linuxcnc",
            &many,
            "expression: more than 64 assignments in a block",
        ),
        (
            "linuxcnc",
            &words,
            "too-many-words: more than 256 words in a block",
        ),
    ];
    for (controller, program, expected) in cases {
        let found = end(controller, program);
        assert_eq!(found, Err(format!("1 {expected}")), "{program}");
    }
}
