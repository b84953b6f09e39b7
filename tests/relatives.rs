//! Words that relatives of Fanuc mean otherwise. The sections named are those of each maker's
//! programming manual.

use crate::listing::{listing, machine, machine_of, refusals};
use crate::shop::Shop;

fn moves(controller: &str, program: &str) -> String {
    listing(program, &machine(controller), None)
}

fn refused(controller: &str, program: &str) -> String {
    refusals(program, &machine(controller))
}

/// OSP, "Program Configuration": only the first line with a dollar sign is a header.
#[test]
fn lines_with_a_dollar_belong_to_the_block_before_them() {
    for lathe in ["okuma", "okuma-lathe"] {
        for header in ["$PART.MIN%", "$PART-2.SSB", "$PART.MIN% (FIRST SIDE)"] {
            let found = moves(lathe, &format!("{header}\nG0 X10\nM2\n"));
            assert_eq!(found.lines().count(), 1, "{header} {found}");
        }
        for line in ["$ Z20", "$Z20.5", "$ Z20%", "$Z1.5 (A%"] {
            let found = refused(lathe, &format!("G0 X10\n{line}\nM2\n"));
            assert!(
                found.contains("belongs to the block before it"),
                "{lathe} {found}"
            );
        }
    }
}

/// OSP, "Tables of Command Codes": M98 and M99 press the tail stock of a lathe; subprograms are
/// called by CALL and end with RTS.
#[test]
fn m98_and_m99_are_no_calls_on_osp() {
    let program = "G0 X10\nM99\nX20\nM98\nX30\nM2\n";
    assert_eq!(
        moves("okuma-lathe", program),
        "1 rapid X5\n3 rapid X10\n5 rapid X15\n"
    );
    for (controller, program) in [
        ("okuma", "G0 X10\nM99\n"),
        ("okuma", "M98 P1\n"),
        ("okuma-lathe", "M98 P1\n"),
    ] {
        let found = refused(controller, program);
        assert!(
            found.contains("no calls of subprograms"),
            "{controller} {found}"
        );
    }
}

/// OSP, "C-axis positioning in positive / negative direction", "Extended address characters".
#[test]
fn directions_and_addresses_of_two_letters_are_refused_on_osp() {
    for (controller, program, reason) in [
        ("okuma-lathe", "M16 C10\n", "in which a rotary axis turns"),
        ("okuma", "G0 A10 M15\n", "in which a rotary axis turns"),
        ("okuma-lathe", "G1 C90 QA=5 F1\n", "QA, an address"),
        ("okuma-lathe", "XA=30\n", "XA, an address"),
        ("okuma", "G0 X1 ZB=50\n", "ZB, an address"),
    ] {
        let found = refused(controller, program);
        assert!(found.contains(reason), "{controller} {program} {found}");
    }
    // A line of assignments, and the variables of a call.
    assert_eq!(moves("okuma", "XA=30\nG0 X=XA\nM2\n"), "2 rapid X30\n");
    assert_eq!(
        moves("okuma", "CALL OSUB LA=7\nM2\nOSUB\nG0 X=LA\nRTS\n"),
        "4 rapid X7\n"
    );
}

/// Haas mills, "M16 Tool Change (same as M06)": Z goes to machine zero.
#[test]
fn m16_changes_the_tool_of_a_haas() {
    let after = |word: &str| moves("haas", &format!("G0 Z-50.\nT1 {word}\nX10.\nM30\n"));
    assert_eq!(after("M16"), after("M6"));
    assert_ne!(after("M16"), after("M17"));
    // What the machine file says of the word holds.
    let more = "[language]\nunknown_moves = [\"M16\"]\n";
    let machine = machine_of("haas", more, "XYZ", "AC");
    let found = listing("G0 Z-50.\nT1 M16\nX10.\nM30\n", &machine, None);
    assert_ne!(found, after("M16"));
}

/// On LinuxCNC and grbl alone P of an arc is how many turns it begins.
#[test]
fn arcs_have_no_turns_on_others() {
    let program = "G1 X10. F500.\nG2 X0 I-5. P2\nM30\n";
    let two = moves("linuxcnc", program);
    assert!(two.contains("turns -1.5"), "{two}");
    for controller in ["haas", "mazak", "mitsubishi", "syntec", "fanuc"] {
        let found = refused(controller, program);
        assert!(found.contains("uses the P word"), "{controller} {found}");
    }
}

/// M97 P is a call on Haas; elsewhere the word ends the interrupt of M96.
#[test]
fn m97_calls_on_haas_alone() {
    let program = "G0 X0.\nM97 P50\nX5.\nM30\nN50 X1.\nM99\n";
    assert_eq!(moves("haas", program).lines().count(), 3);
    for controller in ["syntec", "mitsubishi", "mazak", "fanuc"] {
        let found = refused(controller, program);
        assert!(
            found.contains("calls nothing on this control"),
            "{controller} {found}"
        );
        assert_eq!(moves(controller, "G0 X2.\nM97\n"), "1 rapid X2\n");
    }
}

/// "Dwell (G04)": a time as X or U without a point counts as lengths do; where that is not
/// known, the shorter does. P of Mitsubishi counts milliseconds with a point too.
#[test]
fn times_without_a_point_count_as_lengths() {
    let dwell = |controller: &str, setting: &str, word: &str| {
        let more = format!("[language]\n{setting}\n");
        let machine = machine_of(controller, &more, "XYZ", "AC");
        listing(&format!("G0 X1.\nG4 {word}\nX0.\n"), &machine, None)
            .lines()
            .nth(1)
            .map(str::to_owned)
    };
    let seconds = |time: &str| Some(format!("2 dwell {time} s"));
    for controller in ["fanuc", "mitsubishi", "mazak", "syntec"] {
        let calculator = "decimal_point = \"calculator\"";
        let least = "decimal_point = \"least-increment\"";
        assert_eq!(dwell(controller, calculator, "X2"), seconds("2"));
        assert_eq!(dwell(controller, least, "X500"), seconds("0.5"));
        assert_eq!(dwell(controller, "", "X500"), seconds("0.5"));
        assert_eq!(dwell(controller, "", "X2."), seconds("2"));
    }
    assert_eq!(dwell("mitsubishi", "", "P12.5"), seconds("0.0125"));
    let drilled = moves("mitsubishi", "G0 X1.\nG82 X2. Z-1. R0. P500. F100.\nG80\n");
    assert!(drilled.contains("dwell 0.5 s"), "{drilled}");
}

/// A macro of Syntec's own language divides whole numbers and has variables of its own.
#[test]
fn macros_of_syntec_are_refused() {
    let shop = Shop::straight("syntec", 9000.0);
    for head in ["%@MACRO", "% @macro", "\u{feff}%@MACRO"] {
        shop.put("a.nc", &format!("{head}\n#1=7;\nG0 X[#1/2];\nM30;\n"));
        let (code, _, errors) = shop.run("check a.nc");
        assert_eq!(code, 2, "{head} {errors}");
        assert!(errors.contains("a macro of a Syntec control"), "{errors}");
    }
}

/// grbl puts G1 in force at M30: what moves in the same block runs by the word before.
#[test]
fn the_block_that_ends_the_program_keeps_its_motion_word() {
    let shop = Shop::straight("grbl", 400.0);
    shop.put("a.nc", "G21 G90\nG0 X400 Y300\nG91\nX1 M30\n");
    let (code, _, errors) = shop.run("limit a.nc -o out.nc");
    assert_eq!(code, 0, "{errors}");
    assert!(
        shop.get("out.nc").ends_with("G0\nX1 M30\n"),
        "{}",
        shop.get("out.nc")
    );
}

/// What the program itself has put in force, and offsets that the machine file gives. G54 to G59
/// are group 14 on a Fanuc, 12 on a Haas ("Macros", group codes) and on a Mitsubishi.
#[test]
fn state_that_macros_read() {
    let program = "G21 G90 G55\nG43 H7 Z50.\n#1=#4111\n#2=#4008\n#3=#GROUP\n#4=#5242\nG49\n#5=#4008\nG0 X[#1] Y[#2]\nX#3 Y#4 Z#5\n";
    let offsets = "[offsets]\nG55 = { X = 10, Y = 20, Z = 30 }\n";
    for (controller, group) in [("fanuc", "4014"), ("haas", "4012"), ("mitsubishi", "4012")] {
        let machine = machine_of(controller, offsets, "XYZ", "");
        let found = listing(&program.replace("GROUP", group), &machine, None);
        let last = found.lines().rev().take(2).collect::<Vec<_>>();
        assert_eq!(last[0], "10 rapid X65 Y40 Z79", "{controller}: {found}");
        assert_eq!(last[1], "9 rapid X17 Y63", "{controller}: {found}");
    }
    for (controller, unknown) in [
        ("fanuc", "#1=#4012"),
        ("haas", "#1=#4014"),
        ("fanuc", "#1=#5261"),
    ] {
        let found = refused(controller, &format!("{unknown}\nG0 X#1\n"));
        assert!(
            found.contains("#1 depends on the state of the control"),
            "{found}"
        );
    }
}

/// Haas: J of G84 is how many times as fast the tap comes out, until the next cycle.
#[test]
fn a_tap_returns_as_j_says() {
    let program = "S500 M3\nG0 Z10.\nG99 G84 X5. Z-5. R2. F500. J2\nX10.\nG80\nG84 X1. Z-5. R2.\n";
    assert_eq!(
        moves("haas", program),
        "2 rapid Z10\n3 rapid X5\n3 rapid Z2\n3 tap Z-5 F500\n3 tap Z2 F1000\n4 rapid X10\n4 rapid\n\
         4 tap Z-5 F500\n4 tap Z2 F1000\n6 rapid X1\n6 rapid\n6 tap Z-5 F500\n6 tap Z2 F500\n"
    );
    for wrong in ["J0", "J1.5", "J10"] {
        let found = refused(
            "haas",
            &format!("S500 M3\nG84 X5. Z-5. R2. F500. {wrong}\n"),
        );
        assert!(
            found.contains("J of a tap is how many times as fast"),
            "{found}"
        );
    }
}
