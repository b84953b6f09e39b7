//! Limits of the axes and of the path: ACC, OVRRAP, VELOLIM, JERKLIM, BRISK, ADIS.

use std::io::Cursor;

use gwatt::pipeline::{Summary, analyze};

use crate::limit::{EXACT_STOP, RIG, Rig, assert_figures, options};
use crate::machines::{linear_axes, machine_from};
use crate::runs::rows_of;
use crate::shop::Shop;

/// X and Y of 500 kg, 0.5 m/s and 5 m/s²: 1250 W and, over 400 mm, 0.8 s + 0.1 s.
const RIG_840D: Rig = Rig {
    controller: "siemens",
    rest: EXACT_STOP,
    ..RIG
};

fn summary(rig: &Rig, program: &str) -> Summary {
    let program = Cursor::new(format!("{program}\nM30\n"));
    analyze(program, &rig.machine(), &options(rig.options), None).expect("a program")
}

/// ACC in percent of 5 m/s²: 0.5 m/s · 500 kg · 2.5 m/s² = 625 W, and 0.5 m/s / 2.5 m/s² =
/// 0.2 s longer than 0.8 s.
#[test]
fn acceleration_is_that_of_the_program() {
    let cases = [
        ("G0 X400", 1250.0, 0.9),
        ("ACC[X]=50\nG0 X400", 625.0, 1.0),
        ("ACC[X]=50\nG1 X400 F30000", 625.0, 1.0),
        ("acc[x] = 50\nG0 X400", 625.0, 1.0),
        ("ACC[X]=150\nG0 X400", 1875.0, 0.8 + 0.1 / 1.5),
        ("ACC[X]=200\nG1 X400 F30000", 2500.0, 0.85),
        ("ACC[Y]=50\nG0 X400", 1250.0, 0.9),
        // Not of what is in force, and each axis by itself.
        ("ACC[X]=50\nACC[X]=80\nG0 X400", 1000.0, 0.925),
        ("ACC[X]=50 ACC[Y]=20\nG0 X400", 625.0, 1.0),
        ("ACC[X]=50\nACC[X]=100\nG0 X400", 1250.0, 0.9),
        // Whether it acts in its own block is not known: the higher one counts.
        ("G0 X400 ACC[X]=50", 1250.0, 0.9),
        ("G0 X400 ACC[X]=150", 1875.0, 0.8 + 0.1 / 1.5),
        // Worked out, and of an axis by a computed name.
        ("R1=25\nACC[X]=2*R1\nG0 X400", 625.0, 1.0),
        (
            "DEF AXIS WHICH\nWHICH=X\nACC[WHICH]=50\nG0 X400",
            625.0,
            1.0,
        ),
        ("ACC[$P_AXN1]=50\nG0 X400", 625.0, 1.0),
        // Spindles and axes that the machine does not have.
        ("ACC[S1]=50 ACC[X7]=60\nG0 X400", 1250.0, 0.9),
        // The way to the reference point has the machine's own acceleration.
        ("ACC[X]=50\nG0 X400\nG74 X1=0", 1250.0, 1.9),
    ];
    for (program, peak_w, duration_s) in cases {
        let found = summary(&RIG_840D, program);
        assert_figures(&found, peak_w, duration_s, program);
    }
}

/// Down to 100 % the other words count as not there; above it rapids are faster: 0.75 m/s ·
/// 500 kg · 5 m/s² = 1875 W.
#[test]
fn speeds_are_not_lowered() {
    let cases = [
        ("OVRRAP=50\nG0 X400", 1250.0),
        ("OVRRAP=150\nG0 X400", 1875.0),
        ("OVRRAP=150\nOVRRAP=100\nG0 X400", 1250.0),
        ("G0 X400 OVRRAP=150", 1875.0),
        ("VELOLIM[X]=50\nG0 X400", 1250.0),
        ("OVRA[X]=50\nG0 X400", 1250.0),
        ("JERKLIM[X]=50\nG0 X400", 1250.0),
        ("JERKLIM[X]=150\nG0 X400", 1250.0),
    ];
    for (program, peak_w) in cases {
        let found = summary(&RIG_840D, program);
        assert!(
            (found.peak_w - peak_w).abs() < 1e-6 * peak_w,
            "{program}: {}",
            found.peak_w
        );
    }
    let said = |program: &str| {
        let found = summary(&RIG_840D, program);
        let rules = found.notes.iter().map(|note| note.rule);
        rules.filter(|rule| *rule == "limit-not-lowered").count()
    };
    assert_eq!(said("OVRRAP=50"), 1);
    assert_eq!(said("JERKLIM[X]=50"), 1);
    assert_eq!(said("ACC[S1]=50"), 1);
    assert_eq!(said("ACC[X]=50"), 0);
}

/// Under compensation blocks are held back: what is lower acts after it alone.
#[test]
fn under_compensation_what_is_lower_waits() {
    let program = |first: &str, inside: &str, after: &str| {
        format!(
            "{first}\n$TC_DP6[1,1]=5\nT1 D1\nG1 G41 X10 Y10 F1000\n{inside}\nX400 F30000\nY20 F1000\n\
             G40 X410 Y30\n{after}"
        )
    };
    let peak_w = |program: &str| summary(&RIG_840D, program).peak_w;
    assert!((peak_w(&program("", "", "")) - 1250.0).abs() < 0.1);
    assert!((peak_w(&program("ACC[X]=50", "", "")) - 625.0).abs() < 0.1);
    assert!((peak_w(&program("", "ACC[X]=50", "")) - 1250.0).abs() < 0.1);
    assert!((peak_w(&program("", "ACC[X]=150", "")) - 1875.0).abs() < 0.1);
    // Out of it, it acts.
    let inside = program("ACC[X]=40", "ACC[X]=20\nACC[X]=40", "Y31\nG0 X0\nX400");
    assert!((peak_w(&inside) - 500.0).abs() < 0.1, "{}", peak_w(&inside));
    let lower = program("ACC[X]=50", "ACC[X]=20", "Y31\nG0 X0\nX400");
    assert!((peak_w(&lower) - 625.0).abs() < 0.1, "{}", peak_w(&lower));
    let found = summary(&RIG_840D, &lower);
    let before = summary(&RIG_840D, &program("ACC[X]=50", "", "Y31\nG0 X0\nX400"));
    // 0.5 m/s at 1 m/s² and at 2.5 m/s²: X400 takes 0.3 s longer.
    assert!((found.duration_s - before.duration_s - 0.3).abs() < 1e-6);
}

/// Values that are not a percentage of a limit, or raise one that is not followed.
#[test]
fn limits_are_refused() {
    let cases = [
        ("ACC[X]=0", "1 override: ACC of 0 %"),
        ("ACC[X]=-5", "1 override: ACC of -5 %"),
        ("ACC[X]=201", "1 override: ACC of 201 %"),
        ("ACC[S1]=150", "1 override: ACC of 150 %"),
        (
            "ACC[X]=R7",
            "1 unknown-value: R7 has no value yet: what it holds, only the control knows",
        ),
        ("ACC[X]", "1 syntax: ACC has no value"),
        ("ACC[5]=50", "1 no-such-axis: a number names no axis"),
        ("OVRRAP=0", "1 override: OVRRAP of 0 %"),
        ("OVRRAP=250", "1 override: OVRRAP of 250 %"),
        ("VELOLIM[X]=150", "1 override: VELOLIM of 150 %"),
        ("OVRA[X]=150", "1 override: OVRA of 150 %"),
        ("JERKLIMA[X]=150", "1 override: JERKLIMA of 150 %"),
    ];
    for (line, expected) in cases {
        assert_eq!(super::refusal(line), expected, "{line}");
    }
}

/// Jerk of 50 m/s³: 0.8 s + 0.1 s + 0.1 s, and the most power where the acceleration falls, at
/// a third of a metre per second: 500 kg · 1/3 m/s · √(2 · 50 m/s³ · 1/6 m/s). At 25 m/s³ the
/// acceleration stays below 5 m/s²; at 100 m/s³ it begins to fall at 0.375 m/s.
#[test]
fn percentages_of_the_jerk_count() {
    let jerky = Rig {
        axis: "jerk_mm_s3 = 50000",
        ..RIG_840D
    };
    let own_w = 500.0 / 3.0 * f64::sqrt(50.0 / 3.0);
    let half_w = 500.0 / 3.0 * f64::sqrt(25.0 / 3.0);
    let half_s = 0.8 + 2.0 * f64::sqrt(0.5 / 25.0);
    let machine = |vouched: bool| {
        let mut machine = jerky.machine();
        for knob in &mut machine.controller.knobs {
            knob.verified |= vouched;
        }
        machine
    };
    let cases = [
        (false, "", own_w, 1.0),
        (false, "JERKLIM[X]=50", own_w, 1.0),
        (true, "JERKLIM[X]=50", half_w, half_s),
        (true, "JERKLIM[Y]=50", own_w, 1.0),
        (true, "JERKLIM[X]=50\nJERKLIM[X]=100", own_w, 1.0),
        (false, "JERKLIM[X]=200", 937.5, 0.95),
        // Whether it acts in its own block is not known.
        (true, "G0 JERKLIM[X]=50", half_w, half_s),
        (false, "VELOLIM[X]=50", own_w, 1.0),
    ];
    for (vouched, lines, peak_w, duration_s) in cases {
        let program = Cursor::new(format!("{lines}\nG0 X400\nM30\n"));
        let found = analyze(program, &machine(vouched), &options(RIG.options), None);
        let found = found.expect("a program");
        assert_figures(&found, peak_w, duration_s, lines);
    }
}

/// Where the profile vouches for it, an axis is no faster than its share: 0.25 m/s · 500 kg ·
/// 5 m/s² = 625 W, and 1.6 s + 0.05 s. Threads follow the spindle.
#[test]
fn percentages_of_the_speed_count_where_they_are_confirmed() {
    let mut machine = RIG_840D.machine();
    for knob in &mut machine.controller.knobs {
        knob.verified = true;
    }
    let cases = [
        ("VELOLIM[X]=50\nG0 X400", 625.0, 1.65),
        ("VELOLIM[X]=50\nG1 X400 F30000", 625.0, 1.65),
        ("VELOLIM[X]=50\nG1 X400 F12000", 500.0, 2.04),
        ("VELOLIM[X]=50\nVELOLIM[X]=100\nG0 X400", 1250.0, 0.9),
        ("VELOLIM[Y]=50\nG0 X400", 1250.0, 0.9),
        ("G0 X400 VELOLIM[X]=50", 1250.0, 0.9),
        ("VELOLIM[X]=50\nG0 X400\nG74 X1=0", 1250.0, 2.55),
        ("VELOLIM[X]=50\nS1500 M3\nG33 X400 I20", 1250.0, 0.9),
    ];
    for (program, peak_w, duration_s) in cases {
        let text = Cursor::new(format!("{program}\nM30\n"));
        let found = analyze(text, &machine, &options(RIG.options), None).expect("a program");
        assert_figures(&found, peak_w, duration_s, program);
    }
}

/// "Acceleration response (BRISK, SOFT, DRIVE)": the machine file's limits of jerk hold under
/// SOFT, and before the program says anything; 500 kg, 5 m/s², 0.5 m/s make 1250 W without them.
#[test]
fn brisk_has_no_limit_of_jerk() {
    let machine = machine_from(&format!(
        "schema = 1\nname = \"test\"\ncontroller = \"siemens\"\n[path]\nmode = \"exact-stop\"\n[converter]\n\
         peak_power_w = 9000\n{}",
        linear_axes("XYZ", [30000.0, 5000.0, 500.0], "jerk_mm_s3 = 50000")
    ));
    let program = "G0 X100\nBRISK\nX0\nSOFT JERKLIM[X]=100\nX100\nDRIVE\nX0\nSOFT\nX100\nM30\n";
    let rows = rows_of(&machine, program);
    let full: Vec<bool> = rows.iter().map(|row| row.peak_w > 1249.9).collect();
    assert_eq!(full, [false, true, false, true, false]);
    assert!(rows.iter().all(|row| row.peak_w < 1250.1));
}

/// "Continuous-path mode (G641 … ADIS, ADISPOS)": next to rapids the smaller distance counts, so
/// that as feeds they would round corners that were not rounded, or less.
#[test]
fn rapids_stay_where_feeds_are_rounded_more() {
    let shop = Shop::straight("siemens", 400.0);
    let written = |head: &str| {
        shop.put(
            "a.mpf",
            &format!("{head}\nG0 X400 Y300\nG1 X390 F1000\nG0 Y0\nM30\n"),
        );
        let (code, _, errors) = shop.run("limit a.mpf -o out.mpf");
        (code, errors.contains("ADIS rounds corners of feeds more"))
    };
    assert_eq!(written("G641 ADIS=5"), (1, true));
    assert_eq!(written("G642 ADIS=5 ADISPOS=1"), (1, true));
    assert_eq!(written("G641 ADIS=5\nG60"), (0, false));
    assert_eq!(written("G641 ADIS=5\nG64"), (0, false));
    assert_eq!(written("G641 ADIS=5 ADISPOS=5"), (0, false));
    assert_eq!(written("G641"), (0, false));
    // Lines that run again, and blocks that may be skipped.
    for program in [
        "A:\nG0 X400 Y300\nG0 X0 Y0\nG642 ADIS=5 ADISPOS=1\nB:\nREPEAT A B P=1\nM30\n",
        "/G642 ADIS=5 ADISPOS=1\nG0 X400 Y300\nG0 X0 Y0\nM30\n",
    ] {
        shop.put("a.mpf", program);
        let (code, _, errors) = shop.run("limit a.mpf -o again.mpf");
        assert_eq!(code, 1, "{program} {errors}");
    }
}

/// OVRRAP acts on rapids alone: where it is not known to act, they are counted at their full
/// speed, and a feed in place of one might be faster.
#[test]
fn rapids_stay_where_they_may_be_slower_than_they_count() {
    let shop = Shop::straight("siemens", 400.0);
    let written = |head: &str| {
        shop.put("a.mpf", &format!("{head}\nG0 X400 Y300\nY0\nM30\n"));
        let (code, _, errors) = shop.run("limit a.mpf -o out.mpf");
        (code, errors.contains("as a feed it would be faster"))
    };
    assert_eq!(written("OVRRAP=50"), (1, true));
    assert_eq!(written("OVRRAP=50\nG1 X1 F100\nOVRRAP=100"), (0, false));
    // Lines that run again, and blocks that may be skipped.
    for program in [
        "A:\nG0 X400 Y300\nG0 X0 Y0\nOVRRAP=10\nB:\nREPEAT A B P=1\nM30\n",
        "/OVRRAP=10\nG0 X400 Y300\nG0 X0 Y0\nM30\n",
    ] {
        shop.put("a.mpf", program);
        let (code, _, errors) = shop.run("limit a.mpf -o again.mpf");
        assert_eq!(code, 1, "{program} {errors}");
    }
    assert_eq!(written("OVRRAP=100"), (0, false));
}

/// Where words stand without blanks, a word that is added after a name gets one.
#[test]
fn a_feed_after_a_variable_is_no_part_of_its_name() {
    let shop = Shop::straight("siemens", 400.0);
    shop.put("a.mpf", "R1=300\nG0X=R1\nG1X0F1000\nM30\n");
    let (code, _, errors) = shop.run("limit a.mpf -o out.mpf");
    assert_eq!(code, 0, "{errors}");
    assert!(
        shop.get("out.mpf").contains("X=R1 F"),
        "{}",
        shop.get("out.mpf")
    );
}

/// SAVE gives back the groups of BRISK and of G641.
#[test]
fn save_gives_back_jerk_and_smoothing() {
    let machine = machine_from(&format!(
        "schema = 1\nname = \"test\"\ncontroller = \"siemens\"\n[path]\nmode = \"exact-stop\"\n\
         [converter]\npeak_power_w = 9000\n{}",
        linear_axes("XYZ", [30000.0, 5000.0, 500.0], "jerk_mm_s3 = 50000")
    ));
    let program = "BRISK\nG0 X100\nSUB\nX0\nM30\n%_N_SUB_SPF\nPROC SUB SAVE\nSOFT\nX50\nM17\n";
    let rows = rows_of(&machine, program);
    let full: Vec<bool> = rows.iter().map(|row| row.peak_w > 1249.9).collect();
    assert_eq!(full, [true, false, true]);
    let shop = Shop::straight("siemens", 400.0);
    shop.put(
        "a.mpf",
        "G641 ADIS=1\nSUB\nG0 X500\nG0 X1000 Y500\nM30\n%_N_SUB_SPF\nPROC SUB SAVE\nG64\nM17\n",
    );
    let (code, _, errors) = shop.run("limit a.mpf -o out.mpf");
    assert_eq!(code, 1, "{errors}");
    assert!(
        errors.contains("ADIS rounds corners of feeds more"),
        "{errors}"
    );
}
