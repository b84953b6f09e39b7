//! Programs on the ISG kernel: with and without expressions, and any.

use std::fmt::Write as _;

use proptest::prelude::*;

use super::moves;
use crate::listing::without_lines;

/// A grid of slots, once with everything that the language has, once as moves.
#[test]
fn parametrised_and_expanded_twins_move_alike() {
    let parametrised = "\
%L SLOT (one slot at V.P.X, V.P.Y)
G0 XV.P.X YV.P.Y
G1 Z-V.P.DEEP
X[V.P.X+P10]
G3 X[V.P.X+P10] Y[V.P.Y+2] I0 J1
G1 X=V.P.X
G0 Z2
M17
%GRID
#VAR
V.P.X V.P.Y V.P.DEEP
P20[2] = [1, 2.5]
#ENDVAR
P10 = SQRT[25] P1 = 2 P2 = 3
G0 X0 Y0 Z2 F[60*10]
$FOR P3 = 0, P1-1, 1
P4 = 0
$WHILE P4 < P2
V.P.X = P4*12.5 V.P.Y = P3*12.5 V.P.DEEP = P20[P3]
LL SLOT
P4 += 1
$ENDWHILE
$ENDFOR
$IF P1*P2 > 5 $GOTO [CORNER]
X99
[CORNER] G0 X-P1 Y-P1
M30
";
    let mut expanded = String::from("G0 X0 Y0 Z2 F600\n");
    for (y, deep) in [(0.0, 1.0), (12.5, 2.5)] {
        for x in [0.0, 12.5, 25.0] {
            let (right, top) = (x + 5.0, y + 2.0);
            let _ = write!(
                expanded,
                "G0 X{x} Y{y}\nG1 Z-{deep}\nX{right}\nG3 X{right} Y{top} I0 J1\nG1 X{x}\nG0 Z2\n"
            );
        }
    }
    expanded.push_str("G0 X-2 Y-2\nM30\n");
    let [parametrised, expanded] = [parametrised, &expanded].map(moves);
    assert_eq!(without_lines(&parametrised), without_lines(&expanded));
}

/// Pieces that programs are made of, right and wrong.
const PIECES: [&str; 44] = [
    "\n",
    "\n",
    "\n",
    " ",
    "X1",
    "G1 Y[P1]",
    "P1=1",
    "P1+=1",
    "P2=P1*2",
    "$IF P1>1",
    "$ELSE",
    "$ELSEIF P1<3",
    "$ENDIF",
    "$FOR P1=0,3,1",
    "$ENDFOR",
    "$WHILE P1<9",
    "$ENDWHILE",
    "$DO",
    "$ENDDO P1<3",
    "$REPEAT",
    "$UNTIL 1",
    "$SWITCH P1",
    "$CASE 1",
    "$BREAK",
    "$DEFAULT",
    "$ENDSWITCH",
    "$CONTINUE",
    "$GOTO N5",
    "N5:",
    "[A]",
    "$GOTO [A]",
    "%L A",
    "%B",
    "LL A",
    "M17",
    "#VAR",
    "#ENDVAR",
    "V.L.A[3]=[1,2,3]",
    "#COMMENT BEGIN",
    "#COMMENT END",
    "#TIME 1",
    "[",
    "]",
    "#ROTATION ON [ANGLE=30]",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Any program ends, in moves or in a message.
    #[test]
    fn any_program_ends(pieces in prop::collection::vec(prop::sample::select(&PIECES[..]), 0..40)) {
        let _ = moves(&pieces.concat());
    }

    /// Any text has a value or a message.
    #[test]
    fn any_text_is_read(text in "[0-9.P#$V\\[\\]=+*/&|<> XGMLNa-z(),%:\"@-]{0,40}") {
        let _ = moves(&format!("{text}\nP1={text}\nX{text}\n$FOR P1={text}\n#VAR\n{text}\n"));
    }
}

/// "Line break in NC block": gwatt reads blocks from one line.
#[test]
fn a_block_of_two_lines_is_refused_as_such() {
    let said = super::refused("N10 G90 G0 X100 \\\n Y100\nM30\n");
    let first = said.lines().next();
    assert_eq!(
        first,
        Some(
            "1 line-break: `\\` joins this line with the next one to one block, which gwatt does not \
             follow: it reads a block from one line"
        )
    );
    assert!(super::refused("G0 X1 \\ Y2\n").contains("`\\` has no meaning here"));
}
