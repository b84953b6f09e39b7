//! What the command says of an axis with cogging.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use super::sines;
use crate::shop::{ended, gwatt};

/// 80 kg with 30 N of Coulomb friction and 40 N of cogging every 12 mm, moved along two sines; the
/// noise is 2 N.
fn with_cogging() -> String {
    let mut text = "time_s,force_n,position_mm,velocity_mm_s,accel_mm_s2\n".to_owned();
    let mut state = 1_u64;
    let mut noise = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        // Uniform, with a standard deviation of 1.
        ((state >> 33) as f64 / f64::from(1_u32 << 31) - 0.5) * 12.0_f64.sqrt()
    };
    for sample in 0..4000 {
        let t = f64::from(sample) / 500.0;
        let [x, v, a] = sines(t, &[(60.0, 0.7), (20.0, 1.9)]);
        let cogging_n = 40.0 * libm::sin(TAU * x / 12.0);
        let force_n = 80.0 * a * 1e-3 + 30.0 * v.signum() + cogging_n + 2.0 * noise();
        let _ = writeln!(text, "{t:.4},{force_n:.4},{x:.5},{v:.4},{a:.3}");
    }
    text
}

/// The first number after a name at the beginning of a line.
fn figure(text: &str, name: &str) -> f64 {
    let line = text.lines().find_map(|line| line.trim().strip_prefix(name));
    let line = line.unwrap_or_else(|| panic!("{name}: {text}"));
    line.split_whitespace().next().unwrap().parse().unwrap()
}

/// Exit code, what is printed and what is said.
fn identify(folder: &Path, more: [&str; 2]) -> (i32, String, String) {
    let mut command = gwatt(folder, ["identify", "a.csv", "--axis", "X"]);
    ended(command.args(more).output().unwrap())
}

#[test]
fn cogging_is_named_with_its_figures() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("a.csv"), with_cogging()).unwrap();
    let (code, text, errors) = identify(folder.path(), ["--json", "a.json"]);
    assert_eq!(code, 0, "{errors}");
    for (name, expected, within) in [
        ("mass", 80.0, 0.1),
        ("Coulomb friction", 30.0, 0.3),
        ("cogging", 40.0, 0.3),
    ] {
        let found = figure(&text, name);
        assert!((found - expected).abs() < within, "{name}: {found}\n{text}");
    }
    assert!(text.contains(" N, every 12.00"), "{text}");
    assert!(text.contains("\nverdict: cogging: "), "{text}");
    let json: serde_json::Value = serde_json::from_slice(&fs::read(at("a.json")).unwrap()).unwrap();
    let effect = &json["effects"][0];
    assert_eq!(
        (&effect["effect"], &json["verdict"]),
        (&"cogging".into(), &"cogging".into())
    );
    let period_m = effect["period_m"].as_f64().unwrap();
    assert!((period_m - 0.012).abs() < 1e-5, "{period_m}");
    assert!(json["saturation"].is_null());
    // A machine file has no place for it.
    let machine = "schema = 1\nname = \"a\"\ncontroller = \"iso\"\n[converter]\npeak_power_w = 900\n\
                   [axes.X]\nkind = \"linear\"\nrapid_mm_min = 9000\naccel_mm_s2 = 900\nmass_kg = 50\n";
    fs::write(at("a.toml"), machine).unwrap();
    let (code, _, errors) = identify(folder.path(), ["--into", "a.toml"]);
    assert_eq!(code, 1);
    assert!(errors.contains("--force writes all the same"), "{errors}");
    assert_eq!(fs::read_to_string(at("a.toml")).unwrap(), machine);
}
