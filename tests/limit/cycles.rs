//! Canned cycles whose rapids draw too much: the way to each hole on a line of its own,
//! and, where that is permitted, all their moves as single blocks.

use std::fmt::Write as _;

use insta::assert_snapshot;

use super::same_moves::same_moves;
use crate::random::Random;
use crate::shop::Shop;

/// The rapids of Z, 48 mm, fit; those of X and Y, both together, do not.
#[test]
fn the_way_to_a_hole_needs_no_permission() {
    let shop = Shop::straight("fanuc", 600.0);
    let program = "G21 G90 G54\nG0 X0. Y0. Z50.\nN10 G98 G81 X400. Y300. Z-12. R40. F200.\n\
                   X410.\nN20 X0. Y0. (LAST)\nG80\nG84 X400. Y300. Z-8. R40. F1000.\n\
                   G80 G0 Z50.\nM30\n";
    let text = shop.written(program, "--allow feed");
    same_moves(&shop, &text);
    assert_snapshot!(text, @r"
    G21 G90 G54
    G0 X0. Y0. Z50.
    G9 G1 X400. Y300. F26966.
    G0
    N10 G98 G81 X400. Y300. Z-12. R40. F200.
    G0 X410.
    G81 X410. R40. Z-12.
    G9 G1 X0. Y0. F27173.
    G0 F200.
    N20 G81 X0. Y0. R40. Z-12. (LAST)
    G80
    G4 P1
    G9 G1 X400. Y300. F26966.
    G0 F200.
    G84 X400. Y300. Z-8. R40. F1000.
    G80 G0 Z50.
    M30
    ");
}

#[test]
fn all_moves_of_a_cycle_are_written_out() {
    let shop = Shop::straight("fanuc", 300.0);
    let program = "G21 G90\nG1 X1. F500.\nN10 G99 G83 X200. Y-80. Z-10. R2. Q4. F150. M8 (FIRST)\n\
                   G98 X250. Z-3.\nG80\nX260.\nG82 X50. Y50. Z-3. R1. P500 F120.\nG91 X10. K2\n\
                   G90 G80 G0 Z50.\nM30";
    let text = shop.written(program, "--allow feed,expand");
    same_moves(&shop, &text);
    assert_snapshot!(text, @r"
    G21 G90
    G1 X1. F500.
    N10 F150. M8 (FIRST) (G83 written out)
    G4 P1
    G9 G1 X200. Y-80. F12359.
    G0 Z2.
    G1 Z-2. F150.
    G0 Z2.
    G0 Z-1.
    G1 Z-6.
    G0 Z2.
    G0 Z-5.
    G1 Z-10.
    G0 Z2.
    G1
    G98 (G83 written out)
    G4 P1
    G9 G1 X250. F13714.
    G1 Z-2. F150.
    G0 Z2.
    G0 Z-1.
    G1 Z-3.
    G0 Z0.
    G1
    G80
    X260.
    F120. (G82 written out)
    G4 P1
    G9 G1 X50. Y50. F11383.
    G0 Z1.
    G1 Z-3. F120.
    G4 P500
    G0 Z0.
    G1
    G91 (G82 written out)
    G0 X10.
    G0 Z1.
    G1 Z-4.
    G4 P500
    G0 Z3.
    G0 X10.
    G0 Z1.
    G1 Z-4.
    G4 P500
    G0 Z3.
    G1
    G4 P1
    G9 G90 G80 G1 Z50. F13714.
    G0 F120.
    M30
    ");
}

/// LinuxCNC runs the holes under G61, whatever is in force: each move stands between
/// stops.
#[test]
fn linuxcnc_keeps_its_exact_path() {
    let shop = Shop::straight("linuxcnc", 400.0);
    let program = "G21 G90 G64 P0.05\nG0 Z10\nG99 G81 X100 Y80 Z-1 R2 F300\nY90\nG80\n\
                   G1 X0 F800\nM2\n";
    let text = shop.written(program, "--allow expand");
    same_moves(&shop, &text);
    assert_snapshot!(text, @r"
    G21 G90 G64 P0.05
    G0 Z10
    G4 P0
    G1 X100. Y80. F27441
    G4 P0
    G4 P0
    G0
    G99 G81 X100 Y80 Z-1 R2 F300
    G4 P0
    G0 Y90.
    G4 P0
    G81 Y90 R2 Z-1
    G80
    G1 X0 F800
    M2
    ");
}

/// Radius and angle say where the holes are, the angle in increments too.
#[test]
fn holes_in_polar_words_are_written_out() {
    let shop = Shop::straight("linuxcnc", 400.0);
    let program = "G21 G90 G64 P0.05\nG0 X40 Y0 Z2\nG99 G81 R2 Z-1 F300\n^120\nG90 @60 ^33\n\
                   G91 G81 @20 R0 Z-3 L3\nG90 G0 X40 Y0\nG91 G81 ^[360/5] R0 Z-3 L5\nG80\nM2\n";
    let text = shop.written(program, "--allow expand");
    same_moves(&shop, &text);
    assert!(text.contains("(G81 written out)"), "{text}");
}

/// In increments R counts from the level of the first cycle of the series, which is the
/// series' as long as no other motion comes between.
#[test]
fn increments_go_on_at_the_level_of_the_first() {
    let shop = Shop::straight("linuxcnc", 700.0);
    // The way to X300 Y300 alone is too much.
    let program = "G21 G90 G0 Z40 F300\nG81 X1 Y1 R2 Z-3\nX300 Y300\n\
                   G91 G81 X1 Y1 R-20 Z-3 L2\nG80\nM2\n";
    let text = shop.written(program, "--allow expand");
    same_moves(&shop, &text);
    assert_eq!(text.matches("(G81 written out)").count(), 3, "{text}");
}

#[test]
fn a_turning_cycle_is_written_out() {
    let shop = Shop::straight("linuxcnc", 200.0);
    let program = "G21 G18 G90 G8 F400\nG0 X60 Z2\no100 sub\nG1 X20 Z0 F400\nG1 Z-10\nG3 X24 Z-14 K-4\n\
                   G1 X50 Z-20\no100 endsub\nG71 Q100 X60 Z2 D0.5 I8 R1\nG70 Q100 X60 Z2\nG0 X100\nM2\n";
    let text = shop.written(program, "--allow feed,expand");
    same_moves(&shop, &text);
    assert!(text.contains("(G71 written out)\n"), "{text}");
    assert!(text.contains("G3 X24. Z-14."), "{text}");
}

/// A tap stays a cycle: its rapids stand on lines before it, and the one back to the level
/// from which it began after it.
#[test]
fn the_rapids_of_a_tap_are_written_out() {
    let fanuc = Shop::straight("fanuc", 300.0);
    let program = "G21 G90 G54 G0 Z50.\nG98 G84 X400. Y300. Z-12. R2. F1000.\nX0.\nG80\n\
                   G99 G84 X400. Z-12. R2.\nG80 G0 Z50.\nM30\n";
    let text = fanuc.written(program, "--allow feed,expand");
    same_moves(&fanuc, &text);
    assert_snapshot!(text, @r"
    G4 P1
    G9 G21 G90 G54 G1 Z50. F13714.
    G9 G1 X400. Y300. F10786.
    G9 G1 Z2. F13714.
    G0
    G99 G84 X400. Y300. Z-12. R2. F1000.
    G4 P1
    G9 G98 G1 Z50. F13714.
    G9 G1 X0.
    G9 G1 Z2.
    G0 F1000.
    G84 G99 X0. R2. Z-12.
    G4 P1
    G9 G98 G1 Z50. F13714.
    G80
    G4 P1
    G9 G1 X400.
    G9 G1 Z2.
    G0 F1000.
    G99 G84 X400. Z-12. R2.
    G4 P1
    G9 G80 G1 Z50. F13714.
    G0 F1000.
    M30
    ");
    // In the other planes as well.
    let program = "G21 G90 G54 G19 G0 X50. Z10.\nG98 G84 Y300. Z90. X-12. R2. F1000.\nG80\nM30\n";
    let text = fanuc.written(program, "--allow feed,expand");
    same_moves(&fanuc, &text);
    assert_snapshot!(text, @r"
    G4 P1
    G9 G21 G90 G54 G19 G1 X50. Z10. F13158.
    G9 G1 Y300. Z90. F12914.
    G9 G1 X2. F13714.
    G0
    G99 G84 Y300. Z90. X-12. R2. F1000.
    G4 P1
    G9 G98 G1 X50. F13714.
    G80
    G0 F1000.
    M30
    ");
    let linuxcnc = Shop::straight("linuxcnc", 300.0);
    // A hole below its level R is left upwards first.
    let program = "G21 G90 G0 Z1\nM3 S100\nG99 G84 X400 Y300 Z-10 R50 F100\nG80\nM2\n";
    let text = linuxcnc.written(program, "--allow feed,expand");
    same_moves(&linuxcnc, &text);
    assert_snapshot!(text, @r"
    G21 G90 G0 Z1
    M3 S100
    G0 Z50.
    G4 P0
    G1 X400. Y300. F18640
    G4 P0
    G4 P0
    G0
    G99 G84 X400 Y300 Z-10 R50 F100
    G80
    M2
    ");
}

#[test]
fn what_is_not_written_out_is_said() {
    let shop = Shop::straight("fanuc", 300.0);
    let drill = "G21 G90 G0 Z50.\nG81 X400. Y300. Z-12. R2. F200.\nX0.\nG80\nM30\n";
    let found = shop.refused(drill, "--allow feed");
    assert!(
        found.contains("--allow expand writes canned cycles out as single blocks"),
        "{found}"
    );
    // Of what it is said it stands in the program that was read.
    assert!(found.contains("  line 2  rapid Z"), "{found}");
    for (program, why) in [
        (drill.replace("G81", "G84 K2"), "it taps"),
        (
            drill.replace("G81", "G76 Q1."),
            "it turns the spindle to one angle and moves aside from the wall",
        ),
        (
            drill.replace("G81", "G43 H1 M29 S500\nG84"),
            "another motion word ends its rigid tapping, and M29 does not stand on a line of its own \
             before it",
        ),
    ] {
        let found = shop.refused(&program, "--allow feed,expand");
        let note = format!("the canned cycle is not written out: {why}");
        assert!(found.contains(&note), "{found}");
    }
    // LinuxCNC comes back to the level of G98 by the feed of the tap.
    let tap = "G21 G90 S500 M3\nG0 Z50\nG98 G84 X0 Y0 Z-10 R2 F750\nG80\nM2\n";
    let found = Shop::straight("linuxcnc", 300.0).refused(tap, "--allow feed,expand");
    let note = "the canned cycle is not written out: it taps\n";
    assert_eq!(found.matches(note).count(), 1, "{found}");
    // In a loop it is another place each time.
    let around = "G21 G90 G0 Z50.\n#1=0\nWHILE[#1 LT 2]DO1\nG81 X[400.*#1] Y300. Z-12. R2. F200.\n\
                  G80\n#1=#1+1\nEND1\nM30\n";
    let found = shop.refused(around, "--allow feed,expand");
    assert!(
        found.contains("it does something else each time it runs"),
        "{found}"
    );
    let around = around
        .replace("[400.*#1]", "400.")
        .replace("G80\n#1", "G80 G0 X0. Y0. Z50.\n#1");
    let text = shop.written(&around, "--allow feed,expand");
    same_moves(&shop, &text);
}

/// A program with cycles of all plain kinds.
fn any_program(random: &mut Random, controller: &str) -> String {
    let linuxcnc = controller == "linuxcnc";
    let mut text = "G21 G90 G17\nG0 X0. Y0. Z30.\n".to_owned();
    let place = |random: &mut Random| random.below(800) as f64 / 2.0 - 200.0;
    for _ in 0..=random.below(3) {
        let number = [73, 81, 82, 83, 85, 86, 89][random.below(7)];
        let level = if random.below(2) == 0 { "G98" } else { "G99" };
        let (x, y) = (place(random), place(random));
        let depth = 1 + random.below(9);
        let r = 1 + random.below(20);
        if number == 86 {
            text.push_str("S500 M3\n");
        }
        let _ = write!(
            text,
            "{level} G{number} X{x:?} Y{y:?} Z-{depth}. R{r}. F300."
        );
        match number {
            73 | 83 if controller == "haas" => {
                let words = [
                    " Q2.5",
                    " I3. J0.5 K1.5",
                    if number == 73 { " Q2. K5." } else { " Q2." },
                ];
                text.push_str(words[random.below(3)]);
            }
            73 | 83 => text.push_str(" Q2.5"),
            82 | 86 | 89 => text.push_str(if linuxcnc { " P0.25" } else { " P250" }),
            _ => {}
        }
        text.push('\n');
        for _ in 0..random.below(4) {
            match random.below(5) {
                0 => text.push_str(if linuxcnc {
                    "G91 X7.5 Z-2. R-1. L2\nG90 G80 G0 Z30.\nG81 X1. Z-1. R2.\n"
                } else if controller == "haas" {
                    "G91 X7.5 L2\nG90\n"
                } else {
                    "G91 X7.5 K2\nG90\n"
                }),
                1 => text.push_str("(A WORD)\nM8\n"),
                2 => {
                    let _ = writeln!(text, "X{:?} Z-{}.5", place(random), random.below(5));
                }
                _ => {
                    let _ = writeln!(text, "N{} Y{:?}", 10 + random.below(90), place(random));
                }
            }
        }
        text.push_str(["G80\n", "G0 Z30.\n", "G80 G0 Z30.\n"][random.below(3)]);
        text.push_str("G0 Z30.\n");
    }
    text.push_str("M30\n");
    text
}

fn random_cycles(count: u64) {
    let mut certified = 0;
    for controller in ["fanuc", "haas", "linuxcnc", "mitsubishi"] {
        for seed in 0..count {
            let mut random = Random::new(seed);
            let program = any_program(&mut random, controller);
            let shop = Shop::straight(controller, 250.0 + 50.0 * random.below(6) as f64);
            shop.put("a.nc", &program);
            let (code, _, errors) = shop.run("limit a.nc --allow feed,expand -o out.nc");
            let context = format!("{controller} {seed}\n{program}\n{errors}");
            assert_eq!(code, 0, "{context}");
            same_moves(&shop, &context);
            certified += 1;
        }
    }
    assert_eq!(certified, 4 * count);
}

#[test]
fn random_cycles_are_made_to_fit() {
    random_cycles(6);
}

#[test]
#[ignore = "a thousand programs take some minutes"]
fn many_random_cycles_are_made_to_fit() {
    random_cycles(250);
}

/// Where the first cycle is written out its last rapid is a line of its own, from rest to
/// rest, and so is the first of the second: that one draws more than before, and is written
/// out as well.
#[test]
fn a_cycle_next_to_one_that_is_written_out_may_follow() {
    let program = "G17 G99 G90 G21 F250\nG0 X0 Y0 Z50\nG81 X25 Y50 Z12 R75\n\
                   G81 X25 Y75 Z100 R125\nM2\n";
    let shop = Shop::straight("linuxcnc", 1000.0);
    for power_w in [1000, 1100, 1150, 1200, 1250] {
        let mut machine = format!(
            "schema = 1\nname = \"mill\"\ncontroller = \"linuxcnc\"\n[converter]\n\
             peak_power_w = {power_w}\n[limits]\nmargin = 0\n"
        );
        for (letter, mass, friction) in [("X", 600, 500), ("Y", 700, 500), ("Z", 500, 700)] {
            let _ = write!(
                machine,
                "[axes.{letter}]\nrapid_mm_min = 30000\naccel_mm_s2 = 4000\nmass_kg = {mass}\n\
                 coulomb_n = {friction}\n"
            );
        }
        shop.put("mill.toml", &machine);
        let text = shop.written(program, "--allow feed,expand");
        same_moves(&shop, &text);
        assert!(text.contains("(G81 written out)"), "{power_w} W: {text}");
    }
}
