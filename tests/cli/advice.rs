//! What is advised: words as the control takes them, and nothing that is permitted already.

use crate::shop::Shop;

const STOPS: &str = "[path]\nmode = \"exact-stop\"\nrapid = \"linear\"";
const BOTH: &str = "G0 X200 Y200\nG1 X0 Y0 F30000\nM30\n";
const HOMED: &str = "G28\nG1 X200 Y200 F30000\nG0 X0 Y0\n";
const RAPID: &str = "G64\nG0 X200 Y200\nG1 X0 Y0 F300\nM2\n";
const STOPPED: &str = "G61.1\nG0 X200 Y200\nG1 X0 Y0 F300\nM2\n";
const SHORT: &str = "G1 X50 F20000\nG1 X50.2\nG1 X100\n";

/// The words that `check` names for each line, one by one.
fn advised(told: &str) -> Vec<String> {
    let advice = told
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
        let (code, told, errors) = shop.run("check a.nc");
        assert_eq!(code, 1, "{controller}: {errors}");
        let words = advised(&told);
        assert!(
            words.iter().any(|it| it.starts_with(word)),
            "{controller}: {told}"
        );
        let (code, text, errors) = shop.run("limit a.nc --allow feed");
        assert_eq!(code, 0, "{controller}: {errors}");
        for word in words {
            let word = word.trim_start_matches("G1 ");
            assert!(text.contains(word), "{controller}: {word}\n{told}{text}");
        }
    }
}
