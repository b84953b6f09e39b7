//! Jumps, structures, repeated sections and subprograms ("Job Planning").

use insta::assert_snapshot;

use super::moves;
use crate::listing::{listing, machine};
/// "Program jumps", "Program branch (CASE)", "Check structures".
#[test]
fn jumps_and_structures() {
    let program = "\
G0 R1=1 R2=3
AGAIN: X=R1 ; a label
R1=R1+1
IF R1<R2 GOTOB AGAIN
N50 GOTOF N70
N60 X99
N70 GOTOC NOWHERE
CASE (R1) OF 1 GOTOF ONE 3 GOTOF THREE DEFAULT GOTOF NEITHER
ONE: X98
NEITHER: X97
THREE: IF R1==3
  IF R1==4
    X96
  ELSE
    Y1
  ENDIF
ELSE
  X95
ENDIF
FOR R3=1 TO 2
  FOR R4=8 TO 9
    Y=R3*10+R4
  ENDFOR
ENDFOR
WHILE R1>2
  R1=R1-1
  Z=R1
ENDWHILE
REPEAT
  R1=R1+1
  Z=R1*10
UNTIL R1>=4
LOOP
  R1=R1+1
  IF R1>6 GOTOF OUT
  Z=R1
ENDLOOP
OUT: GOTO 1000
X94
:1000 Z0
M30
X93
";
    assert_snapshot!(moves(program), @r"
2 rapid X1
2 rapid X2
15 rapid Y1
22 rapid Y18
22 rapid Y19
22 rapid Y28
22 rapid Y29
27 rapid Z2
31 rapid Z30
31 rapid Z40
36 rapid Z5
36 rapid Z6
40 rapid Z0
");
}

/// "Repeat program section (REPEAT, REPEATB, ENDLABEL)".
#[test]
fn sections_are_repeated() {
    let program = "\
G0 G91
FIRST: X1
SECOND: X10
REPEATB FIRST P=2
REPEAT FIRST SECOND P=1
REPEAT FIRST P1
GOTOF DONE
LATER: Y1
Y10
ENDLABEL:
Y100
DONE: REPEAT LATER P2
M30
";
    let said = moves(program);
    // X: 1 11 | 12 13 | 14 24 | then the section up to the REPEAT itself.
    let ends: Vec<&str> = said.lines().collect();
    assert_eq!(ends.len(), 6 + 6 + 4, "{said}");
    assert_snapshot!(moves("G0 G91\nA: X1\nB: Y1\nREPEAT A B P2\nREPEATB A\n"), @r"
2 rapid X1
3 rapid Y1
2 rapid X2
3 rapid Y2
2 rapid X3
3 rapid Y3
2 rapid X4
");
}

/// "Subprogram technique": in the same file, after `%_N_NAME_SPF`.
#[test]
fn subprograms_in_the_same_file() {
    let program = "\
%_N_MAIN_MPF
;$PATH=/_N_MPF_DIR
EXTERN BOX(REAL, REAL, VAR REAL)
DEF REAL SIDE=4, SUM
G0 X1
BOX(SIDE,,SUM) P2
X=SUM
CALL \"L5\"
L5 P2
MCALL L5
X0
MCALL
X20
M30
%_N_BOX_SPF
PROC BOX(REAL A, REAL B=2, VAR REAL C) SAVE
G91 X=A Y=B
C=A+B
RET
%_N_L5_SPF
Z=$AA_IW[Z]+1
M17
";
    assert_snapshot!(moves(program), @r"
5 rapid X1
17 rapid X5 Y2
17 rapid X9 Y4
7 rapid X6
21 rapid Z1
21 rapid Z2
21 rapid Z3
11 rapid X0
21 rapid Z4
13 rapid X20
");
}

/// "PROC … SAVE": the caller's modal G groups are in force again, DIAMON, G96 and G700 among them.
#[test]
fn save_gives_back_all_modal_groups() {
    let with = |main: &str, sub: &str| {
        let program = format!("{main}M30\n%_N_SUB_SPF\nPROC SUB SAVE\n{sub}M17\n");
        moves(&program)
    };
    let diameters = with(
        "DIAMOF\nG94 G0 X50\nSUB\nG1 X-100 F1000\n",
        "DIAMON\nG0 X20\n",
    );
    // 0.3 mm at 3000 turns, at 500, at 3000 again.
    let speeds = with(
        "LIMS=3000\nG96 S200 M3\nG1 Z-10 F0.3\nSUB\nG1 Z-100\n",
        "G97 S500\nG1 X60\n",
    );
    // 400 inches are 10160 mm.
    let units = with("G700 G94\nSUB\nG1 X10 F400\n", "G70\nG1 Y1 F1000\n");
    assert_snapshot!(diameters + &speeds + &units, @r"
    2 rapid X50
    9 rapid X10
    4 feed X-100 F1000
    3 feed Z-10 F900
    10 feed X60 F150
    5 feed Z-100 F900
    8 feed Y25.4 F1000
    3 feed X254 F10160
    ");
}

/// "Subprogram technique": PROC, VAR parameters, SAVE, RET, in files of their own.
#[test]
fn subprograms_in_files_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("Hole.spf"),
        "PROC HOLE(REAL D)\nG1 Z=-D F100\nG0 Z1\nENDPROC\n",
    )
    .unwrap();
    let run = |program: &str| listing(program, &machine("siemens"), Some(folder.path()));
    assert_snapshot!(run("G0 X5\nhole(3)\nNONE\n"), @r"
1 rapid X5
2 feed Z-3 F100
3 rapid Z1
3 no-such-subprogram: there is no subprogram NONE, and no word of this name
");
    std::fs::write(folder.path().join("OPEN.SPF"), "G0 X1\n").unwrap();
    assert_snapshot!(run("OPEN\n"), @r"
1 rapid X1
1 subprogram: the subprogram ends without a return
");
}

/// A main program may call the subprogram that has its name, in its own text or in a file.
#[test]
fn a_program_calls_the_subprogram_of_its_own_name() {
    let both = "%_N_PART_MPF\nG0 X5\nPART\nM30\n%_N_PART_SPF\nG0 X20\nM17\n";
    assert_eq!(moves(both), "2 rapid X5\n6 rapid X20\n");
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("PART.SPF"), "G0 X30\nM17\n").unwrap();
    std::fs::write(folder.path().join("PART.MPF"), "G0 X99\nM17\n").unwrap();
    let alone = "%_N_PART_MPF\nG0 X5\nPART\nM30\n";
    let said = listing(alone, &machine("siemens"), Some(folder.path()));
    assert_eq!(said, "2 rapid X5\n1 rapid X30\n");
    // One that calls itself does so for ever.
    assert!(moves(alone).ends_with("3 call-depth: more than 100 calls inside one another\n"));
}

/// "Subprogram technique": arrays as VAR parameters.
#[test]
fn arrays_are_passed_and_given_back() {
    let sub = "%_N_STEP_SPF\nPROC STEP(VAR REAL A[2], REAL B[2], VAR REAL M)\nA[0]=A[0]+B[0]\nA[1]=A[1]+B[1]\nB[0]=99\nM=M+1\nM17\n";
    let main = |call: &str| {
        format!(
            "%_N_M_MPF\nDEF REAL P[2]=SET(1,2), Q[2]=SET(10,20), RR[3], CNT=0\nDEF INT II[2]\n{call}\nG0 X=P[0] Y=P[1] Z=CNT\nX=Q[0]\nM30\n{sub}"
        )
    };
    assert_eq!(
        moves(&main("STEP(P,Q,CNT)")),
        "5 rapid X11 Y22 Z1\n6 rapid X10\n"
    );
    let refused = [
        (
            "STEP(RR,Q,CNT)",
            "A cannot take this value: the call gives it something of another type or length",
        ),
        (
            "STEP(II,Q,CNT)",
            "A cannot take this value: the call gives it something of another type or length",
        ),
        (
            "STEP(CNT,Q,CNT)",
            "A cannot take this value: the call gives it something of another type or length",
        ),
        (
            "STEP(P,,CNT)",
            "B cannot take this value: it is an array, and the call gives it nothing",
        ),
        (
            "STEP(P,Q,P)",
            "M cannot take this value: the call gives it something of another type or length",
        ),
    ];
    for (call, message) in refused {
        let said = moves(&main(call));
        assert!(
            said.contains(&format!("assignment: {message}")),
            "{call}: {said}"
        );
    }
    let twice = "%_N_M_MPF\nDEF REAL P[2]\nTWO(P,P)\nM30\n%_N_TWO_SPF\nPROC TWO(VAR REAL A[2], VAR REAL B[2])\nM17\n";
    let said = moves(twice);
    assert!(said.contains("assignment: B cannot take this value: the call gives one variable to two VAR parameters"), "{said}");
}

/// A subprogram with parameters does nothing by itself: what it is called with decides.
#[test]
fn a_subprogram_with_parameters_by_itself() {
    let run = |program: &str| {
        let machine = machine("siemens");
        let options = gwatt::pipeline::Options::default();
        gwatt::pipeline::analyze(std::io::Cursor::new(program), &machine, &options, None)
            .map(|summary| summary.only_subprograms())
            .map_err(|failure| failure.to_string())
    };
    assert_eq!(
        run("PROC HOLE(REAL D, VAR REAL E[3])\nG0 X=D\nM17\n"),
        Ok(true)
    );
    assert_eq!(run("PROC HOLE(REAL D=4)\nG0 X=D\nM17\n"), Ok(false));
    assert_eq!(run("PROC HOLE\nG0 X4\nM17\n"), Ok(false));
}

/// Each head is a file of its own on the control: which program is meant is the main one.
#[test]
fn a_main_program_after_a_subprogram_is_refused() {
    let sub = "%_N_SUB_SPF\nG1 Y10 F100\nM17\n";
    let main = "%_N_MAIN_MPF\nG0 X100\nSUB\nM30\n";
    let found = moves(&format!("{sub}{main}"));
    assert!(
        found.contains("several-programs: a main program after a subprogram"),
        "{found}"
    );
    let found = moves(&format!("{main}{sub}"));
    assert!(
        found.contains("rapid X100") && found.contains("Y10"),
        "{found}"
    );
    assert!(!found.contains("several-programs"), "{found}");
}
