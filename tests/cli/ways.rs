//! Probes that may touch or not, from outside.

use super::Shop;

/// After a miss it goes far and fast.
const PROBE: &str = "G21 G90 G94 G17 G61.1\nG38.3 Z-2 F60\no1 if [#5070 EQ 0]\nG0 X200 Y200\n\
    o1 endif\nG1 F100 X10\nM2\n";

#[test]
fn both_results_of_a_probe_are_followed() {
    let shop = Shop::new();
    shop.put("probe.ngc", PROBE);
    let machine = ["-m", "three-axis", "--dialect", "linuxcnc"];
    let run = |command: &[&str], probe: &str| {
        shop.run(&[command, &["probe.ngc"], &machine, &["--probe", probe]].concat())
    };
    assert_eq!(run(&["check"], "hit").code, 0);
    assert_eq!(run(&["check"], "miss").code, 1);
    let both = run(&["check"], "both");
    assert_eq!(both.code, 1, "{}", both.stderr);
    let ran = run(&["limit", "-o", "out.ngc"], "both");
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    shop.put("probe.ngc", shop.get("out.ngc"));
    for result in ["hit", "miss", "both"] {
        assert_eq!(run(&["check"], result).code, 0, "{result}");
    }
}

/// What shows one way through a program asks which.
#[test]
fn one_way_is_shown_at_a_time() {
    let shop = Shop::new();
    let commands: [(&[&str], &str); 4] = [
        (&["moves", "gentle.ngc"], "`moves` shows"),
        (&["contour", "gentle.ngc"], "`contour` shows"),
        (
            &["diff", "gentle.ngc", "--from", "three-axis", "--to", "vmc"],
            "`diff` compares",
        ),
        (
            &["report", "gentle.ngc", "--series", "s.csv"],
            "--series shows",
        ),
    ];
    for (command, said) in commands {
        let ran = shop.run(&[command, &["--probe", "both"]].concat());
        assert_eq!(ran.code, 2, "{command:?}: {}", ran.stderr);
        let advice = "one way through a program: use --probe hit or --probe miss";
        assert!(ran.stderr.contains(said), "{}", ran.stderr);
        assert!(ran.stderr.contains(advice), "{}", ran.stderr);
    }
}
