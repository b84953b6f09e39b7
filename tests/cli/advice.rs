//! What is advised: words as the control takes them, and nothing that is permitted already.

use crate::shop::Shop;

const STOPS: &str = "[path]\nmode = \"exact-stop\"\nrapid = \"linear\"";
const BOTH: &str = "G0 X200 Y200\nG1 X0 Y0 F30000\nM30\n";
const HOMED: &str = "G28\nG1 X200 Y200 F30000\nG0 X0 Y0\n";
const RAPID: &str = "G64\nG0 X200 Y200\nG1 X0 Y0 F300\nM2\n";
const STOPPED: &str = "G61.1\nG0 X200 Y200\nG1 X0 Y0 F300\nM2\n";
const SHORT: &str = "G1 X50 F20000\nG1 X50.2\nG1 X100\n";

/// The words that `check` names for each line, one by one.
fn advised(shown: &str) -> Vec<String> {
    let advice = shown
        .lines()
        .filter_map(|line| line.split_once("fits with "));
    let words = advice.flat_map(|(_, words)| {
        let words = words.trim_end_matches(" (limit --allow feed)");
        words.split(" and ").map(str::to_owned).collect::<Vec<_>>()
    });
    words.collect()
}

/// Each word stands with its value, in the control's own form, and `limit` writes it so.
#[test]
fn check_names_the_words_that_limit_writes() {
    let cases = [
        ("isg", STOPS, BOTH, 450, "G231 = 49.6"),
        ("twincat-nci", STOPS, BOTH, 450, "DynOvr=0.492"),
        ("klipper", "", SHORT, 300, "SET_VELOCITY_LIMIT ACCEL=2718"),
        ("klipper", "", HOMED, 450, "SET_VELOCITY_LIMIT VELOCITY="),
        ("marlin", "", SHORT, 300, "M201 X2718 Y2718 Z2718"),
        ("reprap", "", HOMED, 450, "M203 X6971 Y6971 Z6971"),
        (
            "linuxcnc",
            "[outputs]\nspeed = 1",
            RAPID,
            450,
            "M67 E1 Q0.399",
        ),
        (
            "linuxcnc",
            "[outputs]\nacceleration = 2",
            STOPPED,
            450,
            "M68 E2 Q0.492",
        ),
    ];
    for (controller, rest, program, power_w, word) in cases {
        let shop = Shop::mill(controller, &format!("peak_power_w = {power_w}"), rest, "");
        shop.put("a.nc", program);
        let (code, shown, errors) = shop.run("check a.nc");
        assert_eq!(code, 1, "{controller}: {errors}");
        let words = advised(&shown);
        assert!(
            words.iter().any(|it| it.starts_with(word)),
            "{controller}: {shown}"
        );
        let (code, text, errors) = shop.run("limit a.nc --allow feed");
        assert_eq!(code, 0, "{controller}: {errors}");
        for word in words {
            let word = word.trim_start_matches("G1 ");
            assert!(text.contains(word), "{controller}: {word}\n{shown}{text}");
        }
    }
}

/// On printers the F of a G0 cuts nothing, and that of a G1 without filament does.
#[test]
fn no_permission_is_asked_for_where_f_cuts_nothing() {
    let shop = Shop::mill("marlin", "peak_power_w = 450", "", "");
    shop.put("a.nc", "G28\nG0 X200 Y200 F30000\nG1 X0 Y0 F30000\n");
    let (_, text, errors) = shop.run("check a.nc");
    let line = |start: &str| {
        let found = text
            .lines()
            .find(|line| line.trim_start().starts_with(start));
        found.unwrap_or_else(|| panic!("{start}: {text}{errors}"))
    };
    assert!(line("line 2").contains("fits with F"), "{text}");
    assert!(!line("line 2").contains("--allow"), "{text}");
    assert!(line("line 3").ends_with("(limit --allow feed)"), "{text}");
}

/// Where moves are blended in ways that are not known, `limit` writes words all the same.
#[test]
fn blended_moves_are_advised_what_is_written() {
    let shop = Shop::mill("isg", "peak_power_w = 450", "", "");
    shop.put("a.nc", "G0 X200 Y200\nG0 X0 Y0\nM30\n");
    let (_, text, errors) = shop.run("check a.nc");
    let words = advised(&text);
    assert!(!words.is_empty(), "{text}{errors}");
    let (code, written, errors) = shop.run("limit a.nc");
    assert_eq!(code, 0, "{errors}");
    for word in words {
        assert!(
            word.starts_with("G231 = ") && written.contains(&word),
            "{text}{written}"
        );
    }
}

/// Lines that get no words of their own: a cycle whose moves stand on lines of their own, and a
/// rapid that stops before it.
#[test]
fn lines_next_to_a_cycle_are_not_advised_what_is_not_written() {
    let shop = Shop::mill(
        "linuxcnc",
        "peak_power_w = 450",
        "[path]\nrapid = \"linear\"",
        "",
    );
    shop.put(
        "a.nc",
        "G21 G90\nG0 X10 Y10 Z50\nG99 G81 X200 Y200 Z-5 R2 F300\nX300 Y10\nG80\nM2\n",
    );
    let (code, text, errors) = shop.run("check a.nc");
    assert_eq!(code, 1, "{errors}");
    let line = |start: &str| {
        let found = text
            .lines()
            .find(|line| line.trim_start().starts_with(start));
        found.unwrap_or_else(|| panic!("{start}: {text}"))
    };
    assert!(
        line("line 2").ends_with("fits by what `limit` writes next to it"),
        "{text}"
    );
    assert!(
        line("line 4")
            .ends_with("fits with its moves on lines of their own, as `limit` writes them"),
        "{text}"
    );
    let (code, written, errors) = shop.run("limit a.nc");
    assert_eq!(code, 0, "{errors}");
    assert!(written.contains("\nG0 X10 Y10 Z50\n"), "{written}");
}

/// A cycle that cannot be written out, rapids of independent axes below the clearance, and
/// a feed that no value brings down.
#[test]
fn what_is_permitted_is_not_advised() {
    let tap = "G21 G90\nG0 X0 Y0 Z50.\nS500\nG84 X100. Z-20. R2. F500. K2\nG80\nM30\n";
    let low = "G21 G90\nG64\nG0 X0 Y0 Z-50.\nG0 X100. Y20.\nM30\n";
    let loaded = "G21 G90\nM8\nG1 X100. F3000\nM30\n";
    let load = "[[load]]\non = \"M8\"\noff = \"M9\"\npower_w = 1500";
    let room = "[path]\nclearance = { Z = 50 }";
    for (rest, program, permission) in [
        (STOPS, tap, "expand"),
        (room, low, "straighten"),
        (load, loaded, "feed"),
    ] {
        let shop = Shop::mill("fanuc", "peak_power_w = 200", rest, "");
        shop.put("a.nc", program);
        let asks = format!("--allow {permission}");
        let (code, _, errors) = shop.run(&format!("limit a.nc {asks}"));
        assert_eq!(code, 1, "{permission}: {errors}");
        let advice: Vec<&str> = errors
            .lines()
            .filter(|line| line.contains("= help: "))
            .collect();
        assert!(!advice.is_empty(), "{errors}");
        assert!(!advice.iter().any(|line| line.contains(&asks)), "{errors}");
    }
    // To write out what stays a cycle is not advised either.
    let shop = Shop::mill("fanuc", "peak_power_w = 300", STOPS, "");
    shop.put("a.nc", tap);
    let (code, shown, _) = shop.run("check a.nc");
    assert_eq!(code, 1);
    assert!(
        shown.contains("it is not written out as single blocks: it taps")
            && !shown.contains("--allow expand"),
        "{shown}"
    );
}
