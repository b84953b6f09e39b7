//! What a verdict of `identify` lets into machine files, and options that go together.

use std::fmt::Write as _;

use super::Shop;
use super::identify::axis_recording;

/// The rows of a recording with another force.
fn with_force(force: impl Fn(usize, f64) -> f64) -> String {
    let mut text = "time_s,force_n,position_m\n".to_owned();
    for (index, row) in axis_recording().lines().skip(1).enumerate() {
        let cells: Vec<&str> = row.split(',').collect();
        let [time, was, position] = cells[..] else {
            panic!("{row}");
        };
        let force = force(index, was.parse().unwrap());
        writeln!(text, "{time},{force},{position}").unwrap();
    }
    text
}

/// A shop with a mill, and a recording whose force has little to do with its motion.
fn shop() -> (Shop, String) {
    let shop = Shop::new();
    let machine = shop.run(&["machine", "show", "vmc"]).stdout;
    shop.put("mill.toml", &machine);
    let strange = |k: usize, was: f64| was + 4000.0 * libm::sin((k / 300) as f64);
    shop.put("strange.csv", with_force(strange));
    shop.put("reversed.csv", with_force(|_, was| -was));
    (shop, machine)
}

const IDENTIFY: &[&str] = &["identify", "strange.csv", "--axis", "X"];

#[test]
fn what_is_not_good_goes_into_no_machine_file_unless_forced() {
    let (shop, machine) = shop();
    // Asked for figures alone, they are given, whatever the verdict.
    assert_eq!(shop.run(IDENTIFY).code, 0);
    let into = [IDENTIFY, &["--into", "mill.toml", "--json", "x.json"]].concat();
    let ran = shop.run(&into);
    assert_eq!(ran.code, 1, "{}", ran.stderr);
    let said = "mill.toml is as it was, since the verdict is not good; --force writes all the same";
    assert!(ran.stderr.contains(said), "{}", ran.stderr);
    let verdict = "the model does not fit";
    assert!(
        ran.stdout.contains(&format!("verdict: {verdict}")),
        "{}",
        ran.stdout
    );
    assert_eq!(shop.get("mill.toml"), machine);
    assert!(
        shop.get("x.json")
            .contains(&format!("\"verdict\": \"{verdict}\""))
    );
    let forced = shop.run(&[&into[..], &["--force", "--toml", "x.toml"]].concat());
    assert_eq!(forced.code, 0, "{}", forced.stderr);
    assert_ne!(shop.get("mill.toml"), machine);
    assert_eq!(shop.get("mill.toml.bak"), machine);
    assert!(
        shop.get("x.toml")
            .starts_with(&format!("# not to be relied on: {verdict}"))
    );
    shop.run(&[IDENTIFY, &["--force"]].concat())
        .refused("--into <MACHINE>");
}

#[test]
fn a_force_that_counts_the_other_way_is_turned_about() {
    let (shop, machine) = shop();
    let common = [
        "identify",
        "reversed.csv",
        "--axis",
        "X",
        "--into",
        "mill.toml",
    ];
    let ran = shop.run(&common);
    assert_eq!(ran.code, 1);
    assert!(
        ran.stdout
            .contains("verdict: reversed: force and motion are counted in opposite directions; give --reverse if all else is right"),
        "{}",
        ran.stdout
    );
    assert_eq!(shop.get("mill.toml"), machine);
    let ran = shop.run(&[&common[..], &["--reverse"]].concat());
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(ran.stdout.contains("verdict: good"), "{}", ran.stdout);
}

#[test]
fn options_imply_a_model_or_are_refused() {
    let (shop, _) = shop();
    let with = |more: &[&'static str]| shop.run(&[IDENTIFY, more].concat());
    // There is a resonance model for what only it has: the motion is too slow for it to
    // be good, and the heading names it.
    let ran = with(&["--order", "2"]);
    assert!(
        ran.stdout.contains("flexible (iv)"),
        "{}{}",
        ran.stdout,
        ran.stderr
    );
    with(&["--from-command"]).refused("position command");
    with(&["--model", "rigid", "--order", "2"]).refused("--order has no meaning for a rigid axis");
    with(&["--model", "rigid", "--method", "iv", "--zeros", "2"])
        .refused("--method and --zeros have no meaning for a rigid axis");
    with(&["--model", "flexible", "--bandwidth-hz", "20"])
        .refused("--bandwidth-hz has no meaning for a flexible axis");
    with(&["--method", "arx", "--friction", "directional"])
        .refused("--friction has no meaning for a flexible axis");
    with(&["--method", "subspace", "--zeros", "2"]).refused("--zeros goes with --method iv alone");
    with(&["--order", "13"]).refused("--order is at most 12");
    with(&["--delay-ms=-1"]).refused("--delay-ms");
    with(&["--bandwidth-hz", "0"]).refused("--bandwidth-hz 0 is not positive");
}

/// Recordings of one axis are joined; a map reads what a drive writes.
#[test]
fn recordings_are_joined_and_columns_mapped() {
    let shop = Shop::new();
    let rows: Vec<String> = axis_recording()
        .lines()
        .skip(1)
        .map(str::to_owned)
        .collect();
    let whole = |rows: &[String]| format!("time_s,force_n,position_m\n{}\n", rows.join("\n"));
    shop.put("a.csv", whole(&rows[..1000]));
    shop.put("b.csv", whole(&rows[1000..]));
    let ran = shop.run(&[
        "identify", "a.csv", "b.csv", "--axis", "X", "--json", "x.json",
    ]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(
        ran.stdout.starts_with("2 recordings: axis X, rigid"),
        "{}",
        ran.stdout
    );
    let json: serde_json::Value = serde_json::from_str(&shop.get("x.json")).unwrap();
    assert_eq!(json["recordings"], 2);
    assert!((json["mass_kg"].as_f64().unwrap() / 50.0 - 1.0).abs() < 0.02);
    shop.run(&[
        "identify", "a.csv", "b.csv", "--axis", "X", "--model", "flexible",
    ])
    .refused("several recordings are joined for a rigid axis alone");
    // Semicolons, decimal commas, a current, no times.
    let mut drive = "Drive 7; 1 kHz\nIq;Pos\nA;mm\n".to_owned();
    for row in &rows {
        let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
        let line = format!("{:.5};{:.6}", cells[1] / 2.5, 1e3 * cells[2]);
        writeln!(drive, "{}", line.replace('.', ",")).unwrap();
    }
    shop.put("drive.csv", drive);
    let common = ["identify", "drive.csv", "--axis", "X", "--rate-hz", "1000"];
    let mapped = ["--map", "force=Iq*2.5N/A", "--map", "position=Pos*1mm"];
    let ran = shop.run(&[&common[..], &mapped].concat());
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(ran.stdout.contains("verdict: good"), "{}", ran.stdout);
    // Short names right below a line about the recording are none of its units.
    let short = shop.get("drive.csv").replace("A;mm\n", "");
    shop.put(
        "short.csv",
        short.replace("Drive 7; 1 kHz", "Trace; 1000 Hz"),
    );
    let named = ["identify", "short.csv", "--axis", "X", "--rate-hz", "1000"];
    let again = shop.run(&[&named[..], &mapped].concat());
    let figures = |text: &str| text.split_once('\n').unwrap().1.to_owned();
    assert_eq!(figures(&again.stdout), figures(&ran.stdout));
    shop.run(&[&common[..], &["--map", "force=Iq"]].concat())
        .refused("--map force=Iq: there is no factor with a unit");
    shop.run(&["identify", "drive.csv", "--axis", "X", "--rate-hz", "0"])
        .refused("--rate-hz 0 is not positive");
}

/// A log of power: good ones go into the machine file with their efficiency, others not.
#[test]
fn a_power_model_goes_into_the_machine_file_where_it_is_good() {
    let shop = Shop::new();
    let machine = shop.run(&["machine", "show", "vmc"]).stdout;
    shop.put("mill.toml", &machine);
    let log = |unexplained: f64| {
        let mut text = "velocity_mm_s,accel_mm_s2,power_w\n".to_owned();
        for k in 0..4000 {
            let t = f64::from(k) * 0.01;
            let v = 0.4 * libm::sin(1.7 * t) + 0.1 * libm::sin(5.3 * t);
            let a = 0.68 * libm::cos(1.7 * t) + 0.53 * libm::cos(5.3 * t);
            let m = v * (500.0 * a + 200.0 * v + 90.0 * v.signum());
            let p = if m > 0.0 { m / 0.8 } else { m * 0.8 };
            let p = p + unexplained * libm::sin(f64::from(k * k % 1013));
            writeln!(text, "{},{},{p}", v * 1e3, a * 1e3).unwrap();
        }
        text
    };
    shop.put("good.csv", log(1.0));
    shop.put("bad.csv", log(1000.0));
    let into = ["--axis", "X", "--into", "mill.toml"];
    let ran = shop.run(&[&["power-fit", "bad.csv"], &into[..]].concat());
    assert_eq!(ran.code, 1, "{} {}", ran.stdout, ran.stderr);
    assert!(
        ran.stdout.contains("verdict: the model does not fit"),
        "{}",
        ran.stdout
    );
    assert_eq!(shop.get("mill.toml"), machine);
    let ran = shop.run(&[&["power-fit", "good.csv"], &into[..], &["--json", "x.json"]].concat());
    assert_eq!(ran.code, 0, "{} {}", ran.stdout, ran.stderr);
    assert!(ran.stdout.contains("verdict: good"), "{}", ran.stdout);
    assert!(
        ran.stdout.contains("with 95 % confidence"),
        "{}",
        ran.stdout
    );
    let json: serde_json::Value = serde_json::from_str(&shop.get("x.json")).unwrap();
    let (value, std) = (&json["efficiency"], &json["efficiency_std"]);
    let (value, std) = (value.as_f64().unwrap(), std.as_f64().unwrap());
    assert!(
        (value - 0.8).abs() < 4.0 * std && std < 0.01,
        "{value} {std}"
    );
    assert!(shop.get("mill.toml").contains("efficiency = 0.8"));
}
