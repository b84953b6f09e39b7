//! Lines that run again and again are worked out from what was recorded of them,
//! not from their text: a run must come to what its text says.

use std::fmt::Write as _;
use std::io::Cursor;

use gwatt::pipeline::{Failure, Options, moves};
use proptest::prelude::*;

use crate::listing::{listing, machine};

const RUNS: usize = 7;

/// X at the end of each move; or rule, message and columns of the first error.
fn run(controller: &str, program: &str) -> Result<Vec<f64>, String> {
    let mut ends = Vec::new();
    let machine = machine(controller);
    let each = &mut |mv: &gwatt::interpret::Move, _: Option<f64>| {
        ends.push(mv.end[0]);
        Ok(())
    };
    match moves(Cursor::new(program), &machine, &Options::default(), each) {
        Ok(_) => Ok(ends),
        Err(Failure::Refused { diagnostics, .. }) => {
            let found = &diagnostics[0];
            Err(format!("{} {} {:?}", found.rule, found.message, found.span))
        }
        Err(other) => panic!("{other}"),
    }
}

/// The lines in a loop, and one after another.
fn twins(controller: &str, lines: &str) -> [Result<Vec<f64>, String>; 2] {
    let count = if controller == "linuxcnc" {
        "#1=[#1+1]"
    } else {
        "#1=#1+1"
    };
    let begin = format!("G0 G90 G21\n#1=0\n#3=2.5\n#9=4\n#104=7\n{}", "#2=1\n");
    let (open, close) = if controller == "linuxcnc" {
        (format!("o1 repeat [{RUNS}]\n"), "o1 endrepeat\n")
    } else {
        (format!("WHILE [#1 LT {RUNS}] DO1\n"), "END1\n")
    };
    let inside = format!("{lines}\n{count}\n");
    let looped = format!("{begin}{open}{inside}{close}M30\n");
    // A label belongs to one branch or loop.
    let written = (0..RUNS).map(|run| inside.replace("o2", &format!("o{}", 10 + run)));
    let written = format!("{begin}{}M30\n", written.collect::<String>());
    [run(controller, &looped), run(controller, &written)]
}

/// Each kind of line that is recorded, and those that are not.
#[test]
fn every_kind_of_line_has_the_values_of_its_text() {
    let both = [
        "X[#1*2+3*SIN[#1*30]]",
        "X[#1**2] #2=[#2+1]",
        "#2=[#2*2] #3=[#2+1]\nX[#2+#3]",
        "#[100+#1]=[#1*3]\nX#[100+#1]",
        "##9=[#1]\nX[#4+##9]",
        "X-#1",
        "X[ATAN[#1+1]/[2]]",
        "X[[#1 GT 2] * 5 + [#1 EQ 3]]",
        "X[10/[#1-4]]",
        "X[SQRT[3-#1]]",
        "X[LN[5-#1]]",
        "X[#[2-#1]]",
        "N10 X[#1] (a comment) Y[#1 (another) + 1]",
        "/2 X[#1]",
        "X[#1 MOD 3 + ROUND[#1/2] + FIX[#1/2] + FUP[#1/2] + ABS[2-#1]]",
    ];
    let linuxcnc = [
        "#<a>=[#1*2]\n#<_b>=[#<a>+1]\nX[#<a>+#<_b>]",
        "X[EXISTS[#<c>]]\n#<c>=1",
        "X#<unknown>",
        "o2 if [#1 LT 3]\nX[#1]\no2 elseif [#1 LT 5]\nX[10+#1]\no2 else\nX[20+#1]\no2 endif",
        "o2 repeat [#1]\nX[#1+#2]\n#2=[#2+1]\no2 endrepeat",
        "#2=0\no2 while [#2 LT #1]\nX[#1*10+#2]\n#2=[#2+1]\no2 endwhile",
        "#2=0\no2 do\nX[#1*10+#2]\n#2=[#2+1]\no2 while [#2 LT #1]",
        "#5221=[#1]\nX[#5221+#5420]",
        "#[5220]=1",
        "#5420=[#1]",
    ];
    let fanuc = [
        "#2=#20\nX#2 Y1",
        "#[2+#1]=#0\nX#3 Y#1",
        "IF [#1 LT 3] THEN #2=[#1*2]\nX#2",
        "IF [#1 EQ 5] THEN #2=1/0\nX#2",
        "X[ATAN[#1,2] + POW[#1,2]]",
        "X[#1 AND 3 + [#1 OR 4] + [#1 XOR 1]]",
        "X[#20 EQ #0]",
        "#[3000]=0\nX#1",
        "G65 P9 A#1 B[#1+1]",
    ];
    let mut wrong = String::new();
    for (controller, own) in [("linuxcnc", &linuxcnc[..]), ("fanuc", &fanuc[..])] {
        for lines in both.iter().chain(own) {
            let [looped, written] = twins(controller, lines);
            if looped != written {
                let _ = writeln!(wrong, "{controller} {lines}\n  {looped:?}\n  {written:?}");
            }
        }
    }
    assert_eq!(wrong, "");
}

/// A jump that is taken in some runs.
#[test]
fn a_condition_is_asked_in_every_run() {
    let program = "\
G0 #1=0
N1 #1=#1+1
IF [#1 MOD 2 EQ 0] GOTO 3
X#1
N3 Y#1
IF [#1 LT 7] GOTO 1
M30
";
    insta::assert_snapshot!(listing(program, &machine("fanuc"), None), @r"
4 rapid X1
5 rapid Y1
5 rapid Y2
4 rapid X3
5 rapid Y3
5 rapid Y4
4 rapid X5
5 rapid Y5
5 rapid Y6
4 rapid X7
5 rapid Y7
");
}

/// Arguments and what is returned are those of each call.
#[test]
fn calls_get_their_arguments_in_every_run() {
    let program = "\
G0 G21 #5=0
o100 sub
X[#1*10+#2]
o100 endsub [#1+#2]
o1 repeat [5]
#5=[#5+1]
o100 call [#5] [#5/2]
Y#<_value>
o1 endrepeat
M2
";
    insta::assert_snapshot!(listing(program, &machine("linuxcnc"), None), @r"
3 rapid X10.5
8 rapid Y1.5
3 rapid X21
8 rapid Y3
3 rapid X31.5
8 rapid Y4.5
3 rapid X42
8 rapid Y6
3 rapid X52.5
8 rapid Y7.5
");
}

fn value() -> impl Strategy<Value = String> {
    let leaf = prop_oneof![
        Just("#1".to_owned()),
        Just("#2".to_owned()),
        Just("##9".to_owned()),
        Just("#[1+1]".to_owned()),
        (0..9_u8).prop_map(|digit| digit.to_string()),
        (0..99_u8).prop_map(|digits| format!("{}.{}", digits / 10, digits % 10)),
    ];
    leaf.prop_recursive(4, 24, 2, |inner| {
        let operator = prop_oneof![
            Just("+"),
            Just("-"),
            Just("*"),
            Just("/"),
            Just(" MOD "),
            Just("**"),
            Just(" EQ "),
            Just(" LT "),
            Just(" AND "),
            Just(" OR "),
        ];
        let function = prop_oneof![
            Just("SIN"),
            Just("SQRT"),
            Just("ABS"),
            Just("ROUND"),
            Just("EXP"),
            Just("LN"),
        ];
        prop_oneof![
            (inner.clone(), operator, inner.clone())
                .prop_map(|(a, operator, b)| format!("[{a}{operator}{b}]")),
            (function, inner.clone()).prop_map(|(name, x)| format!("{name}[{x}]")),
            inner.prop_map(|x| format!("-{x}")),
        ]
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn any_expression_has_the_value_of_its_text(
        [a, b] in [value(), value()],
        fanuc in any::<bool>(),
    ) {
        let controller = if fanuc { "fanuc" } else { "linuxcnc" };
        let [looped, written] = twins(controller, &format!("X[{a}] #2={b}"));
        prop_assert_eq!(looped, written);
    }
}
