use super::{listed, recognise};

fn seen(file: &str, text: &str) -> (String, String) {
    let found = recognise(text.as_bytes(), file).unwrap();
    (found.profiles.join(" "), found.seen())
}

#[track_caller]
fn is(text: &str, profiles: &str, marks: &str) {
    let (found, why) = seen("a.gcode", text);
    assert_eq!((found.as_str(), why.as_str()), (profiles, marks), "{text}");
}

const RELATIVES: &str = "fanuc haas fanuc-lathe fanuc-lathe-b haas-lathe mitsubishi mazak syntec";

#[test]
fn each_controller_has_its_marks() {
    is(
        "DEF REAL A\nMSG(\"x\")\n",
        "siemens",
        "DEF with a type in line 1, MSG( in line 2",
    );
    is(
        "%_N_A_MPF\nN5 CR=5\n",
        "siemens",
        "%_N_ in line 1, CR=, AR= or TURN= in line 2",
    );
    is("N10 R1=5\n", "siemens", "R parameters in line 1");
    is(
        "$IF P1 > 2\n",
        "isg",
        "$IF or another $ word of flow in line 1",
    );
    is("#SLOPE[TYPE=STEP]\n", "isg", "a # word in line 1");
    is("o100 sub\n", "linuxcnc", "O-words in line 1");
    is(
        "o<a> call\n#<b>=1\n",
        "linuxcnc",
        "O<names> in line 1, #<names> in line 2",
    );
    is("$H\n", "grbl", "a $ command of grbl in line 1");
    is("$120=10\n", "grbl", "a $ command of grbl in line 1");
    is("N20 DynOvr=0.4\n", "twincat-nci", "DynOvr in line 1");
    is(
        "#set paramPathDynamics( 700; 700; 3000 )#\n",
        "twincat-nci",
        "#set param in line 1",
    );
    is("VC1=5\n", "okuma okuma-lathe", "VC variables in line 1");
    is("G92 X0 S1200\n", "fanuc-lathe-b", "G92 with S in line 1");
    is(
        "G15 H1\nCALL OABC\n",
        "okuma",
        "G15 or G16 with H in line 1, CALL O in line 2",
    );
    is(
        "G1 H1 X-215 F1800\nset var.x = {var.x + 1}\nabort \"no probe\"\n",
        "reprap",
        "G1 with H and axes in line 1, a variable or a command of RepRapFirmware in line 2",
    );
    is(
        "M104 S200\n",
        "marlin reprap klipper",
        "M104 or another heater in line 1",
    );
    is(
        ";FLAVOR:Marlin\nM82\n",
        "marlin",
        "flavor Marlin in line 1, M82 or M83 in line 2",
    );
    is(
        "START_PRINT BED=60\n",
        "klipper",
        "a command of Klipper in line 1",
    );
    is("O1000 (PART)\n", RELATIVES, "a program number in line 1");
    is(
        "G97 S100 M3\nG50 S2000\n",
        "fanuc-lathe haas-lathe",
        "G96 or G97 with S in line 1, G50 with S in line 2",
    );
    is(
        "O1\nG187 P1\nY1.\n",
        "haas",
        "a program number in line 1, G103, G154, G187 or M97 in line 2, Y words in line 3",
    );
}

#[test]
fn what_all_have_decides_nothing() {
    is("G21 G90\nG0 X1 Y2\nG1 Z-1 F100\nM30\n", "", "");
    is("%\n(M104 S200 \"DEF REAL\")\nG0 X1\n", "", "");
    is("G1 X1 ; M104 and MSG(\"x\")\n", "", "");
    is("", "", "");
    // Printers return so too.
    is("G28\nG0 X1 Y2\n", "", "");
}

#[test]
fn the_ending_of_a_name_counts_where_it_is_one_maker_s() {
    assert_eq!(seen("A.MPF", "G0 X1\n").0, "siemens");
    assert_eq!(seen("a.min", "G0 X1\n").0, "okuma okuma-lathe");
    assert_eq!(seen("a.ngc", "G0 X1\n").0, "linuxcnc grbl");
    // `.gcode` alone is no printer.
    assert_eq!(seen("a.gcode", "G0 X1\n").0, "");
    // The text outweighs it.
    assert_eq!(seen("a.ngc", "$H\n").0, "grbl");
}

#[test]
fn files_of_other_kinds_are_known() {
    let found = recognise(&b"0 BEGIN PGM A MM\n"[..], "a.h").unwrap();
    assert!(found.foreign.unwrap().what.contains("Klartext"));
}

#[test]
fn families_are_named_by_their_first() {
    assert_eq!(listed(&["siemens"]), "siemens");
    assert_eq!(listed(&["okuma", "okuma-lathe"]), "okuma or okuma-lathe");
    assert_eq!(
        listed(&["linuxcnc", "fanuc", "haas", "syntec"]),
        "linuxcnc or fanuc or one of its relatives (haas, syntec)"
    );
    assert_eq!(
        listed(&["fanuc-lathe", "haas-lathe"]),
        "fanuc-lathe or haas-lathe"
    );
    assert_eq!(
        listed(&["marlin", "reprap", "klipper"]),
        "marlin or one of its relatives (reprap, klipper)"
    );
}

#[test]
fn any_bytes_are_looked_at() {
    let mut state = 7_u32;
    for _ in 0..2000 {
        let bytes: Vec<u8> = (0..60)
            .map(|_| {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let alphabet = b"GMXYO#$<>[]()\"=;%N.1_-\n\xff V";
                alphabet[(state >> 16) as usize % alphabet.len()]
            })
            .collect();
        let found = recognise(bytes.as_slice(), "").unwrap();
        assert_eq!(found.profiles.is_empty(), found.marks.is_empty());
    }
}
