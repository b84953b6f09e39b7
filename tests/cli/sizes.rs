//! `gwatt size` from outside.

use super::Shop;

const TWO: &str = "schema = 1\nname = \"two\"\ncontroller = \"iso\"\n\
    [[converter]]\nname = \"table\"\naxes = [\"X\"]\npeak_power_w = 1000\n\
    [[converter]]\nname = \"head\"\naxes = [\"Z\"]\npeak_power_w = 700\n\
    [axes.X]\nkind = \"linear\"\nrapid_mm_min = 30000\naccel_mm_s2 = 5000\nmass_kg = 500\n\
    [axes.Z]\nkind = \"linear\"\nrapid_mm_min = 30000\naccel_mm_s2 = 5000\nmass_kg = 200\n\
    [limits]\nmargin = 0\n";

/// A table for people, and files for other programs.
#[test]
fn sizes_are_written_in_four_ways() {
    let shop = Shop::new();
    let options = ["size", "steep.ngc", "gentle.ngc", "-m", "three-axis"];
    let more = ["--steps", "3", "--loss", "1%,0.2"];
    let files = ["--csv", "s.csv", "--json", "s.json", "--svg", "s.svg"];
    let ran = shop.run(&[&options[..], &more, &files].concat());
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(ran.stdout.contains("nothing is slowed"), "{}", ran.stdout);
    assert!(ran.stdout.contains("for a loss of 0.2 %"), "{}", ran.stdout);
    // Three steps, the machine's own and two losses: two programs, and both together.
    assert_eq!(shop.get("s.csv").lines().count(), 1 + 6 * 3);
    let json: serde_json::Value = serde_json::from_str(&shop.get("s.json")).unwrap();
    assert_eq!(json["rating"]["steps"].as_array().unwrap().len(), 6);
    assert_eq!(json["rating"]["programs"][1]["outcome"], "sized");
    assert_eq!(json["capacitance"], serde_json::Value::Null);
    // The programs together, from the highest rating down.
    let curve = json["curve"].as_array().unwrap();
    let powers = curve.iter().map(|it| it["peak_power_w"].as_f64().unwrap());
    let powers: Vec<f64> = powers.collect();
    assert!(powers.is_sorted_by(|a, b| a > b), "{powers:?}");
    let unlimited = &json["unlimited"];
    let fastest = curve.iter().find(|it| it["fits"] == true).unwrap();
    assert_eq!(fastest["duration_s"], unlimited["duration_s"]);
    assert_eq!(json["loss"]["percent"], 1.0);
    let steps = json["rating"]["steps"].as_array().unwrap();
    let wished = steps.iter().find(|it| it["wished_loss"] == 0.01).unwrap();
    assert_eq!(json["loss"]["peak_power_w"], wished["peak_power_w"]);
    let slowed = curve.iter().filter(|it| it["fits"] == true);
    assert!(
        slowed
            .clone()
            .all(|it| it["duration_s"].as_f64() >= unlimited["duration_s"].as_f64())
    );
    let svg = shop.get("s.svg");
    assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n"));
    assert!(svg.contains("machine file: 4000 W"), "{svg}");

    // To standard output goes the one that is asked for, and people read elsewhere.
    let ran = shop.run(&[&options[..], &more, &["--csv", "-"]].concat());
    assert_eq!(ran.stdout, shop.get("s.csv"));
    assert!(ran.stderr.contains("nothing is slowed"), "{}", ran.stderr);
}

/// `limit` writes at a promised rating what was promised, from standard input too.
#[test]
fn a_promised_rating_is_kept() {
    let shop = Shop::new();
    let program = shop.get("steep.ngc");
    let options = [
        "size",
        "-",
        "-m",
        "three-axis",
        "--steps",
        "2",
        "--csv",
        "-",
    ];
    let ran = shop.run_with_input(&options, &program);
    let lowest = ran.stdout.lines().find(|line| line.contains(",lowest,"));
    let rating = lowest.and_then(|line| line.split(',').nth(3)).unwrap();
    let machine = shop.run(&["machine", "show", "three-axis"]).stdout;
    let smaller = machine.replace("peak_power_w = 4000", &format!("peak_power_w = {rating}"));
    assert_ne!(smaller, machine);
    shop.put("smaller.toml", &smaller);
    let ran = shop.run(&["limit", "steep.ngc", "-m", "smaller.toml"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(
        ran.stderr.contains("certificate: planned"),
        "{}",
        ran.stderr
    );
}

/// Of several converters one is named; the other stays what it is.
#[test]
fn one_of_several_converters_is_sized() {
    let shop = Shop::new();
    shop.put("two.toml", TWO);
    shop.put("xz.ngc", "G21 G90 G94\nG0 X100\nG0 Z100\nM30\n");
    shop.run(&["size", "xz.ngc", "-m", "two.toml"])
        .refused("say with --converter which one is to be sized (table, head)");
    shop.run(&["size", "xz.ngc", "-m", "two.toml", "--converter", "tail"])
        .refused("--converter tail: the machine has no such one (table, head)");
    shop.run(&["size", "xz.ngc", "-m", "three-axis", "--converter", "a"])
        .refused("--converter a: the machine's converter has no name");
    // 0.5 m/s · 500 kg · 5 m/s² = 1250 W, and 500 W for the head,
    // which is found to a thousandth.
    for (name, enough) in [("table", "1250 W"), ("head", "500")] {
        let ran = shop.run(&["size", "xz.ngc", "-m", "two.toml", "--converter", name]);
        let line = ran
            .stdout
            .lines()
            .find(|line| line.ends_with("nothing is slowed"));
        let value = line.unwrap().trim();
        assert!(value.starts_with(enough), "{}", ran.stdout);
    }
}

#[test]
fn what_cannot_be_sized_is_said() {
    let shop = Shop::new();
    let options = ["size", "steep.ngc", "-m", "three-axis"];
    let with = |more: &[&'static str]| shop.run(&[&options, more].concat());
    with(&["--loss", "much"]).refused("`much` is no loss of time");
    with(&["--steps", "1"]).refused("a number from 2 to 1000 is needed");
    with(&["--regen-ratio", "0"]).refused("a number above 0 and up to 10 is needed");
    with(&["--csv", "steep.ngc"]).refused("is read by this run");
    with(&["--strategy", "preset", "--law", "patent"]).refused("goes with --strategy");
    shop.put("bad.ngc", "G21 G90\nG1 X\nM30\n");
    let ran = shop.run(&["size", "bad.ngc", "gentle.ngc", "-m", "three-axis"]);
    assert_eq!(ran.code, 2);
    assert!(ran.stdout.contains("bad.ngc: refused, and not counted"));
    assert!(ran.stdout.contains("nothing is slowed"), "{}", ran.stdout);
    assert!(ran.stderr.contains("bad.ngc"), "{}", ran.stderr);
    shop.put("idle.ngc", "G21 G90\nM30\n");
    let ran = shop.run(&["size", "idle.ngc", "-m", "three-axis"]);
    assert_eq!(ran.code, 0);
    assert!(
        ran.stdout.contains("idle.ngc: draws nothing"),
        "{}",
        ran.stdout
    );
}
