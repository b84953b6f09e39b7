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
    assert!(
        ran.stdout.contains("verdict: the model does not fit"),
        "{}",
        ran.stdout
    );
    assert_eq!(shop.get("mill.toml"), machine);
    assert!(
        shop.get("x.json")
            .contains("\"verdict\": \"the model does not fit\"")
    );
    let forced = shop.run(&[&into[..], &["--force", "--toml", "x.toml"]].concat());
    assert_eq!(forced.code, 0, "{}", forced.stderr);
    assert_ne!(shop.get("mill.toml"), machine);
    assert_eq!(shop.get("mill.toml.bak"), machine);
    assert!(
        shop.get("x.toml")
            .starts_with("# not to be relied on: the model does not fit\n[axes.X]\n")
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
    with(&["--delay-ms", "-1"]).refused("--delay-ms");
    with(&["--bandwidth-hz", "0"]).refused("--bandwidth-hz 0 is not positive");
}
