//! Blocks that obey F while none is in force: where one of them gets an F, all of them have
//! one, and none is above that of power-on.

use crate::shop::Shop;

/// X and Y by themselves draw 537 W, along 4 : 3 together 795 W.
fn shop(language: &str) -> Shop {
    let rest = format!("[path]\nrapid = \"linear\"\nmode = \"exact-stop\"\n{language}");
    Shop::mill("siemens", "peak_power_w = 700", &rest, "")
}

const KNOWN: &str = "[language]\npower_on_feed_mm_min = 40000";

#[track_caller]
fn limited(shop: &Shop, program: &str) -> String {
    shop.put("a.mpf", program);
    let (code, _, errors) = shop.run("limit a.mpf --allow feed -o out.mpf");
    assert_eq!(code, 0, "{errors}");
    assert!(
        errors.contains("note[first-feed]: no F is in force"),
        "{errors}"
    );
    shop.get("out.mpf")
}

#[track_caller]
fn refused(shop: &Shop, program: &str, options: &str, reasons: &[&str]) {
    shop.put("a.mpf", program);
    let (code, _, errors) = shop.run(&format!("limit a.mpf {options} -o out.mpf"));
    assert_eq!(code, 1, "{errors}");
    assert!(!shop.has("out.mpf"));
    for reason in reasons {
        assert!(errors.contains(reason), "{reason}\n{errors}");
    }
}

#[test]
fn one_f_stands_for_the_unknown_one() {
    // The second block fits as it is: it keeps the F that stands there now, and so does
    // the third until the first F of the program.
    let program = "G1 X400 Y300\nX0\nY0\nX10 F2000\nX400 Y300\nM30\n";
    assert_eq!(
        limited(&shop(KNOWN), program),
        "G1 X400 Y300 F32359\nX0\nY0\nX10 F2000\nX400 Y300\nM30\n"
    );
    // None above that of power-on.
    let low = shop("[language]\npower_on_feed_mm_min = 1500");
    assert_eq!(
        limited(&low, program),
        "G1 X400 Y300 F1500\nX0\nY0\nX10 F2000\nX400 Y300\nM30\n"
    );
    // The unit of length has changed: the same F in inches, rounded down.
    assert_eq!(
        limited(&low, "G1 X400 Y300\nG700\nX0\nM30\n"),
        "G1 X400 Y300 F1500\nG700\nX0 F59.055\nM30\n"
    );
    // Nothing is written where all fits.
    let shop = shop(KNOWN);
    shop.put("b.mpf", "G1 X1\nY1\nM30\n");
    let (code, _, errors) = shop.run("limit b.mpf --allow feed -o same.mpf");
    assert_eq!(code, 0, "{errors}");
    assert_eq!(shop.get("same.mpf"), shop.get("b.mpf"));
}

#[test]
fn in_loops_each_block_has_it() {
    let program = "R1=0\nG1\nAGAIN: X=400*R1 Y=300*R1\nZ=10*R1\nR1=R1+1\nIF R1<3 GOTOB AGAIN\n\
                   X0 F500\nM30\n";
    assert_eq!(
        limited(&shop(KNOWN), program),
        "R1=0\nG1\nAGAIN: X=400*R1 Y=300*R1 F32359\nZ=10*R1 F32359\nR1=R1+1\n\
         IF R1<3 GOTOB AGAIN\nX0 F500\nM30\n"
    );
}

#[test]
fn it_is_asked_for() {
    let program = "G1 X400 Y300\nM30\n";
    let unknown = [
        "no F is in force, and the one that the control takes then is not known",
        "power_on_feed_mm_min under [language] of the machine file",
    ];
    refused(&shop(""), program, "--allow feed", &unknown);
    let not_allowed = ["cutting feeds are not changed without permission"];
    refused(&shop(KNOWN), program, "--strategy speed", &not_allowed);
    // A line that meets an F the second time keeps all from getting one.
    let differs = "R1=1\nG1 X-400 Y-300\nAGAIN: X=400*R1 Y=300*R1\nY=R1 F500\nR1=R1-1\n\
                   IF R1>=0 GOTOB AGAIN\nM30\n";
    let other = ["no F is in force, and one of the blocks that count on none cannot have its own"];
    refused(&shop(KNOWN), differs, "--allow feed", &other);
}

/// A printer keeps the F of what ran before, which may be lower than any other: none is
/// written, and words that cap speed stand around the block.
#[test]
fn of_printers() {
    for (controller, cap) in [
        ("marlin", "M203 X"),
        ("klipper", "SET_VELOCITY_LIMIT VELOCITY="),
        ("reprap", "M203 X"),
    ] {
        let shop = Shop::mill(controller, "peak_power_w = 300", "", "");
        shop.put("a.gcode", "G1 X100 Y100\nG1 X0 F60000\nG1 X1 F600\n");
        let (code, _, errors) =
            shop.run("limit a.gcode --strategy speed --allow feed -o out.gcode");
        assert_eq!(code, 0, "{errors}");
        let text = shop.get("out.gcode");
        let mut lines = text.lines().filter(|line| *line != "G1");
        assert!(
            lines.next().is_some_and(|line| line.starts_with(cap)),
            "{text}"
        );
        assert_eq!(lines.next(), Some("G1 X100 Y100"), "{text}");
        assert!(
            lines.next().is_some_and(|line| line.starts_with(cap)),
            "{text}"
        );
        assert!(!errors.contains("first-feed"), "{errors}");
    }
}
