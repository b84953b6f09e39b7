//! `gwatt tune` from its arguments to its files.

use std::fs;
use std::path::{Path, PathBuf};

use crate::identify::csv;
use crate::shop::{self, ended};

fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("examples/recordings")
        .join(name)
}

fn gwatt(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    ended(
        shop::gwatt(folder, arguments.iter().copied())
            .output()
            .unwrap(),
    )
}

const MILL: &str = r#"schema = 1
name = "mill"
controller = "iso"
[converter]
peak_power_w = 3000
[axes.X] # long
rapid_mm_min = 24000
accel_mm_s2 = 4000
mass_kg = 300
[axes.Y] # short
rapid_mm_min = 24000
accel_mm_s2 = 4000
mass_kg = 300
"#;

#[test]
fn recordings_become_filters_in_the_machine_file() {
    let shop = tempfile::tempdir().unwrap();
    let folder = shop.path();
    for axis in ["x", "y"] {
        let name = format!("flexible-{axis}.csv");
        fs::copy(example(&name), folder.join(&name)).unwrap();
    }
    fs::write(folder.join("mill.toml"), MILL).unwrap();
    let (code, text, said) = gwatt(
        folder,
        &[
            "tune",
            "flexible-x.csv",
            "flexible-y.csv",
            "--into",
            "mill.toml",
            "--json",
            "t.json",
            "--csv",
            "t.csv",
            "--toml",
            "t.toml",
            "--html",
            "t.html",
            "--least-accel-mm-s2",
            "9000",
        ],
    );
    assert_eq!(code, 0, "{said}");
    assert!(
        text.contains("X: flexible-x.csv, from torque, inertia 0.024"),
        "{text}"
    );
    assert!(said.contains("mill.toml has the new figures"), "{said}");
    assert!(
        said.contains("does not say what the axis has (force_curve)"),
        "{said}"
    );
    let mill = fs::read_to_string(folder.join("mill.toml")).unwrap();
    for line in [
        "[axes.X] # long\n",
        "[axes.X.correction]\nperiod_ms = 1.0\n",
        "[axes.Y.response]\n",
    ] {
        assert!(mill.contains(line), "{mill}");
    }
    let (code, _, said) = gwatt(folder, &["machine", "check", "mill.toml"]);
    assert_eq!(code, 0, "{said}");
    let csv = fs::read_to_string(folder.join("t.csv")).unwrap();
    assert_eq!(csv.lines().count(), 3);
    assert_eq!(
        csv.lines().next(),
        Some("axis,section,period_s,b0,b1,b2,a1,a2")
    );
    let json: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(folder.join("t.json")).unwrap()).unwrap();
    assert_eq!(json["axes"][0]["rigid"], false);
    let hz = json["axes"][1]["zeros"][0]["frequency_hz"]
        .as_f64()
        .unwrap();
    assert!((hz - 31.0).abs() < 0.3, "{hz}");
    // What the filters take is shown; more than the drive has is refused.
    assert!(text.contains("  X: gain up to 24."), "{text}");
    let weak = MILL.replacen(
        "mass_kg = 300",
        "mass_kg = 300\nforce_curve = [{ speed_mm_min = 0, force_n = 4000 }, { speed_mm_min = 24000, force_n = 4000 }]",
        1,
    );
    fs::write(folder.join("weak.toml"), &weak).unwrap();
    let files = [
        "tune",
        "flexible-x.csv",
        "flexible-y.csv",
        "--into",
        "weak.toml",
    ];
    let (code, _, said) = gwatt(folder, &files);
    assert_eq!(code, 2, "{said}");
    assert!(said.contains("and the axis has 4000.0 N"), "{said}");
    assert_eq!(fs::read_to_string(folder.join("weak.toml")).unwrap(), weak);
    // The file of parameters gives the same filters.
    let (code, _, said) = gwatt(folder, &["tune", "--from", "t.toml", "--csv", "again.csv"]);
    assert_eq!(code, 0, "{said}");
    assert_eq!(fs::read_to_string(folder.join("again.csv")).unwrap(), csv);
    // Too little motion: nothing is written.
    let (code, text, said) = gwatt(
        folder,
        &[
            "tune",
            "X=flexible-x.csv",
            "Y=flexible-y.csv",
            "--least-accel-mm-s2",
            "1e6",
            "--csv",
            "none.csv",
        ],
    );
    assert_eq!((code, text.as_str()), (2, ""));
    assert!(
        said.contains("less than the 1000000 that are asked for"),
        "{said}"
    );
    assert!(!folder.join("none.csv").exists());
}

#[test]
fn wrong_arguments_of_tune_are_told() {
    let shop = tempfile::tempdir().unwrap();
    let folder = shop.path();
    let accel: Vec<f64> = (0..300).map(|k| libm::sin(f64::from(k))).collect();
    fs::write(
        folder.join("run7.csv"),
        csv(&["torque_nm", "accel_m_s2"], &[&accel, &accel]),
    )
    .unwrap();
    fs::write(
        folder.join("p.toml"),
        "schema = 1\n[axes.X]\ninput = \"command\"\n",
    )
    .unwrap();
    for (arguments, expected) in [
        (vec!["run7.csv"], "run7.csv: which axis is this?"),
        (vec!["X=run7.csv", "x=run7.csv"], "axis X is given twice"),
        (vec!["X=-"], "are read from files, not from standard input"),
        (vec!["Q=run7.csv"], "Q is no axis"),
        (vec!["x.csv"], "x.csv: cannot read the recording"),
        (
            vec!["--from", "p.toml"],
            "one axis alone has nothing to be like",
        ),
        (
            vec!["--from", "p.toml", "--position-gain", "Y=3"],
            "--position-gain: there is no axis Y",
        ),
        (
            vec!["--from", "p.toml", "--position-gain", "X=3"],
            "--position-gain: the loop of axis X is in its recording already",
        ),
        (vec!["--from", "none.toml"], "cannot read none.toml"),
        (
            vec!["--from", "run7.csv"],
            "run7.csv: this is no file of parameters",
        ),
    ] {
        let arguments: Vec<&str> = [vec!["tune"], arguments].concat();
        let (code, text, said) = gwatt(folder, &arguments);
        assert_eq!((code, text.as_str()), (2, ""), "{arguments:?}");
        assert!(said.contains(expected), "{arguments:?}: {said}");
    }
}
