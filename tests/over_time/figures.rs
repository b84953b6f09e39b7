//! Limits over time do not change what a program draws.

use crate::shop::Shop;

/// S-shaped arcs: `LinuxCNC` cannot lay an arc between them, and lets them overlap.
const OVERLAPPING: &str = "G21 G90 G94 G64\nF3000\nG2 X0 Y2.5 R5\nG3 X2.5 Y-2.5 R5\n\
                           G2 X5 Y2.5 R5\nG3 X7.5 Y-2.5 R5\nG2 X10 Y2.5 R5\nM2\n";
const LINES: &str = "G21 G90 G94\nF20000\nG1 X100\nG1 X200 Y3\nG1 X90 Y8\nG0 X0 Y0\nM2\n";

/// Peak, certificate and limits over time.
fn found(shop: &Shop) -> (f64, String, Vec<f64>) {
    let (_, shown, errors) = shop.run("check a.ngc --format json");
    let shown: serde_json::Value = serde_json::from_str(&shown).expect(&errors);
    let values = shown[0]["over_time"].as_array();
    let values = values.map(|all| all.iter().filter_map(|it| it["value"].as_f64()).collect());
    (
        shown[0]["peak_w"].as_f64().unwrap(),
        shown[0]["certificate"].to_string(),
        values.unwrap_or_default(),
    )
}

#[test]
fn limits_over_time_change_no_peak() {
    let curve = "force_curve = [{ speed_mm_min = 0, force_n = 900 }, { speed_mm_min = 15000, force_n = 900 }, { speed_mm_min = 30000, force_n = 500 }]";
    for (controller, program, axis) in [
        ("linuxcnc", OVERLAPPING, ""),
        ("linuxcnc", LINES, ""),
        ("linuxcnc", LINES, curve),
        ("grbl", LINES, curve),
        ("grbl", OVERLAPPING, ""),
    ] {
        let of = |ratings: &str| {
            let rest = "[path]\nrapid = \"linear\"";
            let ratings = format!("peak_power_w = 5000\n{ratings}");
            let shop = Shop::mill(controller, &ratings, rest, axis);
            shop.put("a.ngc", program);
            found(&shop)
        };
        let (peak_w, certificate, _) = of("");
        assert_eq!(certificate, "\"planned\"", "{controller}");
        let over_time = "continuous_power_w = 4000\nwindow_s = 10\n\
                         brake_power_w = 1000\nbrake_energy_j = 1e6";
        let (watched_w, watched, values) = of(over_time);
        assert_eq!((watched_w, watched), (peak_w, certificate), "{controller}");
        // A mean exceeds no peak.
        assert!(values[0] <= peak_w * (1.0 + 1e-9), "{values:?} {peak_w}");
        assert!(values[0] > 100.0, "{values:?}");
    }
}

/// Under G64 the feed begins while the rapid comes to rest, for a tenth of a second of 4 s.
/// Only that much of both counts together, at the largest overrides and in the bound.
#[test]
fn moves_that_overlap_count_together_while_they_do() {
    let rest = "[path]\nrapid = \"linear\"";
    let means = |mode: &str| -> Vec<f64> {
        let ratings = "peak_power_w = 5000\ncontinuous_power_w = 60\nwindow_s = 4";
        let shop = Shop::mill("linuxcnc", ratings, rest, "");
        shop.put(
            "a.ngc",
            &format!("G21 G90 {mode}\nF300\nG0 X200\nG1 Y20\nG0 X0\nG1 Y40\nM2\n"),
        );
        let all = ["--override 100%", "--override 60%", "--override 30%", ""];
        let all = all.map(|overrides| {
            let (_, shown, errors) =
                shop.run(format!("check a.ngc --format json {overrides}").trim_end());
            let shown: serde_json::Value = serde_json::from_str(&shown).expect(&errors);
            shown[0]["over_time"][0]["value"].as_f64().unwrap()
        });
        all.to_vec()
    };
    let [apart, together] = ["G61", "G64"].map(means);
    for (apart, together) in apart.iter().zip(&together) {
        assert!(
            (0.99..1.1).contains(&(together / apart)),
            "{together} {apart}"
        );
    }
}
