//! Blocks before any motion word: once one is written as a feed, all are, each at its own
//! speed.

use crate::shop::Shop;

fn shop() -> Shop {
    Shop::mill(
        "siemens",
        "peak_power_w = 700",
        "[path]\nrapid = \"linear\"\nmode = \"exact-stop\"",
        "",
    )
}

#[test]
fn blocks_before_the_first_motion_word_get_theirs() {
    let shop = shop();
    // X by itself fits as it is, but would run by the F of the block before. An F of the
    // program's own is kept to.
    let program = "R1=400\nX=R1 Y300\nLAB: X=R1-350\nX50\nX300 F20000\nY0\nG1 X0 F500\nX10\nM30\n";
    shop.put("a.mpf", program);
    let (code, _, errors) = shop.run("limit a.mpf --allow feed -o out.mpf");
    assert_eq!(code, 0, "{errors}");
    let condition = "  blocks before the first motion word are taken for rapids (G0)\n";
    assert!(errors.contains(condition), "{errors}");
    insta::assert_snapshot!(shop.get("out.mpf"), @r"
    R1=400
    G1 X=R1 Y300 F32359
    LAB: X=R1-350 F30000
    X50
    X300 F20000
    Y0
    G1 X0 F500
    X10
    M30
    ");
    // Nothing is written where all fits.
    shop.put("b.mpf", "X1\nY1\nM30\n");
    let (code, _, errors) = shop.run("limit b.mpf -o same.mpf");
    assert_eq!(code, 0, "{errors}");
    assert_eq!(shop.get("same.mpf"), "X1\nY1\nM30\n");
}

/// Where corners are blended each of them keeps the stop that it has as a rapid. Controls that blend
/// rapids too have none.
#[test]
fn with_their_stops_on_every_control_whose_setting_decides() {
    let program = "G90\nX400. Y300.\nX0. Y0.\nG1 X10. F500.\nM30\n";
    for (controller, stop) in [
        ("fanuc", "G9 "),
        ("haas", "G9 "),
        ("isg", ""),
        ("mazak", "G9 "),
        ("mitsubishi", "G9 "),
        ("okuma", "G9 "),
        ("siemens", ""),
        ("syntec", "G9 "),
        ("iso", "G9 "),
    ] {
        let dialect = if controller == "iso" {
            "siemens"
        } else {
            controller
        };
        let linear = "[path]\nrapid = \"linear\"";
        let shop = Shop::mill(controller, "peak_power_w = 700", linear, "");
        shop.put("a.nc", program);
        let (code, _, errors) = shop.run(&format!(
            "limit a.nc --dialect {dialect} --allow feed -o out.nc"
        ));
        assert_eq!(code, 0, "{controller}: {errors}");
        assert!(
            errors.contains("note[no-motion-word]"),
            "{controller}: {errors}"
        );
        let text = shop.get("out.nc");
        // The shortest dwell makes sure of the stop before.
        let lines: Vec<&str> = text.lines().filter(|line| *line != "G4 P1").collect();
        let [first, there, back, rest @ ..] = &lines[..] else {
            panic!("{controller}: {text}");
        };
        let begins = |line: &str, word: &str| line.starts_with(&format!("{stop}{word}"));
        assert!(begins(there, "G1 X400. Y300. F"), "{controller}: {text}");
        assert!(begins(back, "X0. Y0."), "{controller}: {text}");
        assert_eq!((*first, rest), ("G90", &["G1 X10. F500.", "M30"][..]));
    }
}

/// The machine file says which it is; LinuxCNC refuses a place without any.
#[test]
fn the_word_of_power_on() {
    let kinds = |controller: &str, rest: &str| {
        let shop = Shop::mill(controller, "peak_power_w = 700", rest, "");
        let feed = if rest.contains("feed") { " F500." } else { "" };
        shop.put("a.nc", &format!("G90{feed}\nX10.\nM30\n"));
        let (code, moves, errors) = shop.run("moves a.nc");
        let kind = |kind: &str| moves.contains(&format!("\"kind\":\"{kind}\""));
        let noted = errors.contains("no-motion-word");
        (code, kind("rapid"), kind("feed"), noted)
    };
    let said = |word: &str| format!("[language]\npower_on_motion = \"{word}\"");
    assert_eq!(kinds("fanuc", ""), (0, true, false, true));
    assert_eq!(kinds("fanuc", &said("rapid")), (0, true, false, false));
    assert_eq!(kinds("fanuc", &said("feed")), (0, false, true, false));
    assert_eq!(kinds("siemens", &said("feed")), (0, false, true, false));
    assert_eq!(kinds("grbl", ""), (0, true, false, false));
    assert_eq!(kinds("linuxcnc", ""), (2, false, false, true));
    // Under G1 it would be blended with what comes next, which no rapid is there.
    let shop = Shop::mill("fanuc", "peak_power_w = 700", "", "");
    for (head, code) in [("G90 F500.", 2), ("G90 G61 F500.", 0), ("G90", 0)] {
        shop.put("a.nc", &format!("{head}\nX10.\nM30\n"));
        assert_eq!(shop.run("moves a.nc").0, code, "{head}");
    }
}

/// In a loop each of them gets its own word, which is right in each of its runs: one that
/// fits as it is runs at its own speed, and one that stands at the slowest of all.
#[test]
fn in_loops() {
    let shop = shop();
    let program = "R1=0\nX0\nAGAIN: X=400*R1 Y=300*R1\nZ=10*R1\nR1=R1+1\nIF R1<3 GOTOB AGAIN\n\
                   G1 X0 F500\nM30\n";
    shop.put("a.mpf", program);
    let (code, _, errors) = shop.run("limit a.mpf --allow feed -o out.mpf");
    assert_eq!(code, 0, "{errors}");
    insta::assert_snapshot!(shop.get("out.mpf"), @r"
    R1=0
    G1 X0 F30000
    AGAIN: G1 X=400*R1 Y=300*R1 F32359
    G1 Z=10*R1 F30000
    R1=R1+1
    IF R1<3 GOTOB AGAIN
    G1 X0 F500
    M30
    ");
    // None is touched where all fits.
    shop.put(
        "b.mpf",
        "R1=0\nAGAIN: X=R1\nR1=R1+1\nIF R1<3 GOTOB AGAIN\nM30\n",
    );
    let (code, _, errors) = shop.run("limit b.mpf -o same.mpf");
    assert_eq!(code, 0, "{errors}");
    assert_eq!(shop.get("same.mpf"), shop.get("b.mpf"));
}

/// A line that meets another word the second time, or takes none, keeps all from getting
/// theirs.
#[test]
fn not_where_one_cannot() {
    let shop = shop();
    let refused = |program: &str| {
        shop.put("a.mpf", program);
        let (code, _, errors) = shop.run("limit a.mpf --allow feed -o out.mpf");
        assert_eq!(code, 1, "{errors}");
        let reason = "no motion word is in force that could be put back";
        assert!(errors.contains(reason), "{errors}");
        assert!(!shop.has("out.mpf"));
    };
    refused("R1=0\nX400 Y300\nAGAIN: X=R1\nG0 Y=R1\nR1=R1+1\nIF R1<3 GOTOB AGAIN\nM30\n");
    refused("R1=0\nX400 Y300\nY10 M6\nAGAIN: R1=R1+1\nIF R1<3 GOTOB AGAIN\nX0\nM30\n");
}
