//! Rapids of axes that move each for itself: what of them may become a line; and the largest
//! F that the control takes.

use crate::shop::Shop;

/// A Fanuc mill whose rapids are not straight.
fn shop(path: &str, power_w: f64) -> Shop {
    let converter = format!("peak_power_w = {power_w}");
    Shop::mill("fanuc", &converter, path, "")
}

/// One axis alone moves along a line anyway: (0.5·(200·3 + 100))/0.8 and 100 W at rest are
/// 537.5 W.
#[test]
fn a_rapid_of_one_axis_is_a_line() {
    let shop = shop("", 400.0);
    let program = "G21 G90\nG0 X400.\nY300.\nG1 Y310. F500\nG0 Z50.\nM30\n";
    let (code, text, errors) = shop.limit(program, "");
    assert_eq!(code, 0, "{errors}");
    // 30000 mm/min by (400 − 100)/437.5.
    assert_eq!(
        text,
        "G21 G90\nG4 P1\nG9 G1 X400. F20571.\nG9 Y300.\nG1 Y310. F500\nG4 P1\nG9 G1 Z50. F20571.\n\
         G0 F500\nM30\n"
    );
}

#[test]
fn a_rapid_of_several_axes_needs_room() {
    let each = "its axes move each for itself, not along a line";
    let program = "G21 G90\nG0 Z60.\nX400. Y300.\nX0. Y0. Z20.\nM30\n";
    let permit = "--allow straighten";
    // No clearance, and no permission.
    for (path, options) in [("", permit), ("[path]\nclearance = { Z = 50 }", "")] {
        let (code, _, errors) = shop(path, 600.0).limit(program, options);
        assert!(code == 1 && errors.contains(each), "{errors}");
        // What is given already is not asked for.
        assert_eq!(errors.contains(permit), options.is_empty(), "{errors}");
        assert!(errors.contains("`clearance` under [path]"), "{errors}");
    }
    // The last rapid goes below it.
    let roomy = shop("[path]\nclearance = { Z = 50 }", 600.0);
    let (code, _, errors) = roomy.limit(program, permit);
    assert_eq!(code, 1);
    assert!(
        errors.contains("a.nc:4:1") && !errors.contains("a.nc:3:1"),
        "{errors}"
    );
    let above = program.replace("Z20.", "Z50.");
    let (code, text, errors) = roomy.limit(&above, permit);
    assert_eq!(code, 0, "{errors}");
    assert!(text.contains("G9 G1 X400. Y300. F"), "{text}");
    let condition = "rapids of several axes may run along lines beyond the clearance";
    assert!(errors.contains(condition), "{errors}");
}

/// The F of a program counts as the largest that the control takes, and none above it is
/// written.
#[test]
fn the_largest_feed() {
    let path = "[path]\nrapid = \"linear\"\nmax_feed_mm_min = 12000";
    let shop = shop(path, 500.0);
    let program = "G21 G90\nG1 X200. F30000\nG2 X300. I50. F15000\nG0 Y300.\nM30\n";
    shop.put("a.nc", program);
    let (_, csv, _) = shop.run("report a.nc");
    let seconds = |line: usize| -> f64 {
        let row = csv.lines().nth(line).unwrap();
        row.split(',').nth(5).unwrap().parse().unwrap()
    };
    // 200 mm/s, and 200/3000 s for the two ramps.
    assert!((seconds(1) - (1.0 + 200.0 / 3000.0)).abs() < 1e-6, "{csv}");
    assert!(seconds(2) > std::f64::consts::PI * 50.0 / 200.0, "{csv}");
    let (code, text, errors) = shop.limit(program, "");
    assert_eq!(code, 0, "{errors}");
    assert!(text.contains("G9 G1 Y300. F12000.\n"), "{text}");
    assert!(
        text.starts_with("G21 G90\nG1 X200. F30000\nG2 X300. I50. F15000\n"),
        "{text}"
    );
}

/// By axis: along a line no axis is faster than its own largest speed, and no F is written that
/// would make it so; 3-4-5, so that X has 0.8 of the F.
#[test]
fn the_largest_feed_of_an_axis() {
    let shop = shop("[path]\nrapid = \"linear\"", 500.0);
    let text = std::fs::read_to_string(shop.0.path().join("mill.toml")).unwrap();
    shop.put(
        "mill.toml",
        &text.replacen("[axes.X]\n", "[axes.X]\nmax_feed_mm_min = 9600\n", 1),
    );
    let program = "G21 G90\nG1 X400. Y300. F30000\nG0 X0. Y0.\nM30\n";
    shop.put("a.nc", program);
    let (_, csv, _) = shop.run("report a.nc");
    let row: Vec<_> = csv.lines().nth(1).unwrap().split(',').collect();
    // 500 mm at 12000 mm/min, and the ramps of X at 3000 mm/s² by 0.8.
    let ramps_s = 200.0 / 3750.0;
    let duration_s: f64 = row[5].parse().unwrap();
    assert!((duration_s - (2.5 + ramps_s)).abs() < 1e-6, "{csv}");
    let (code, text, errors) = shop.limit(program, "");
    assert_eq!(code, 0, "{errors}");
    assert!(text.contains("G9 G1 X0. Y0. F12000.\n"), "{text}");
}
