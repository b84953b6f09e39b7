//! Findings that are known.

use std::fs;
use std::path::Path;

use super::{STEEP, Shop};

const CHECK: [&str; 6] = [
    "check",
    "steep.ngc",
    "gentle.ngc",
    "-m",
    "three-axis",
    "--baseline",
];

/// A shop with a baseline of its two programs.
fn shop() -> Shop {
    let shop = Shop::new();
    let ran = shop.run(&[&CHECK[..5], &["--write-baseline", "known.json"]].concat());
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert_eq!(
        ran.stderr,
        "gwatt: note: known.json: 1 finding in 2 programs\n"
    );
    shop
}

#[test]
fn known_findings_pass_and_new_ones_fail() {
    let shop = shop();
    insta::assert_snapshot!(shop.get("known.json"), @r#"
    {"version": 1, "programs": {
    "gentle.ngc": [],
    "steep.ngc": [
      {"rule":"peak-power","line":2,"text":"G0 X200 Y200 Z200","value":7510.79091,"limit":3600.0}]
    }}
    "#);
    let held = |shop: &Shop| shop.run(&[&CHECK[..], &["known.json"]].concat());
    let ran = held(&shop);
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    assert!(
        ran.stdout.contains("  baseline: 1 known, 0 new\n"),
        "{}",
        ran.stdout
    );
    assert!(
        ran.stdout
            .ends_with("2 programs: 2 fit, 0 do not, 0 are not read\n")
    );
    // The line moves, and another one comes.
    shop.put(
        "steep.ngc",
        format!("(again)\n{STEEP}").replace("M30", "G0 X0 Y0 Z0\nM30"),
    );
    let ran = held(&shop);
    assert_eq!(ran.code, 1);
    assert!(
        ran.stdout.contains("  baseline: 1 known, 1 new\n"),
        "{}",
        ran.stdout
    );
    // It is gone.
    shop.put("steep.ngc", "G21 G90\nG1 F100 X210\nM30\n");
    let ran = held(&shop);
    assert_eq!(ran.code, 0);
    let gone = "  gone: peak-power in line 2, 7510.8 W of 3600.0 W: G0 X200 Y200 Z200\n";
    assert!(ran.stdout.contains(gone), "{}", ran.stdout);
}

#[test]
fn what_has_grown_fails() {
    let shop = shop();
    let smaller = shop.get("known.json").replace("7510.79091", "7510.7");
    shop.put("known.json", smaller);
    let ran = shop.run(&[&CHECK[..], &["known.json"]].concat());
    assert_eq!(ran.code, 1);
    let grown = "  baseline: 0 known, 1 new\n  grown: peak-power in line 2, 7510.8 W of 3600.0 W: \
                 G0 X200 Y200 Z200, was 7510.7 W of 3600.0 W\n";
    assert!(ran.stdout.contains(grown), "{}", ran.stdout);
}

#[test]
fn a_program_that_is_not_read_is_never_known() {
    let shop = shop();
    shop.put("steep.ngc", "G1 X1 (\n");
    let ran = shop.run(&[&CHECK[..], &["known.json"]].concat());
    assert_eq!(ran.code, 2, "{}", ran.stdout);
    let before = shop.get("known.json");
    let ran = shop.run(&[&CHECK[..5], &["--write-baseline", "known.json"]].concat());
    assert_eq!(ran.code, 2);
    let message = "known.json is not written: a program is not read, and no baseline covers that";
    assert!(ran.stderr.contains(message), "{}", ran.stderr);
    assert_eq!(shop.get("known.json"), before);
}

#[test]
fn formats_know_it_too() {
    let shop = shop();
    let run = |format: &str| shop.run(&[&CHECK[..], &["known.json", "--format", format]].concat());
    let sarif: serde_json::Value = serde_json::from_str(&run("sarif").stdout).unwrap();
    assert_eq!(sarif["runs"][0]["results"][0]["baselineState"], "unchanged");
    let github = run("github");
    assert_eq!(github.code, 0);
    assert_eq!(
        github.stdout,
        "::notice title=gwatt::2 fit, 0 do not fit, 0 refused\n"
    );
    assert!(run("junit").stdout.contains(r#"failures="0""#));
    let json: serde_json::Value = serde_json::from_str(&run("json").stdout).unwrap();
    assert_eq!(json[0]["fits"], false);
    assert_eq!(json[0]["baseline"]["known"], 1);
    // Without one the word does not occur.
    let plain = shop.run(&[&CHECK[..5], &["--format", "sarif"]].concat());
    assert!(!plain.stdout.contains("baseline"));
}

#[test]
fn messages() {
    let shop = shop();
    let refused = |arguments: &[&str], message: &str| {
        shop.run(&[&CHECK[..5], arguments].concat())
            .refused(message);
    };
    refused(&["--baseline", "none.json"], "cannot read none.json: ");
    let none = "cannot use gentle.ngc as a baseline (--write-baseline writes one): it is no \
                baseline: ";
    refused(&["--baseline", "gentle.ngc"], none);
    shop.put("new.json", "{\"version\": 2}");
    let version = "it has version 2, and this gwatt reads version 1: write it again";
    refused(&["--baseline", "new.json"], version);
    let both = "the argument '--baseline <FILE>' cannot be used with '--write-baseline <FILE>'";
    refused(
        &["--baseline", "known.json", "--write-baseline", "a.json"],
        both,
    );
    refused(&["--write-baseline", "steep.ngc"], "steep.ngc");
    assert_eq!(shop.get("steep.ngc"), STEEP);
    // Programs of it that were not checked.
    let ran = shop.run(&[
        "check",
        "gentle.ngc",
        "-m",
        "three-axis",
        "--baseline",
        "known.json",
    ]);
    let note =
        "gwatt: note: known.json has findings of 1 program that were not checked: steep.ngc\n";
    assert_eq!((ran.code, ran.stderr.as_str()), (0, note));
}

/// The one that the documentation uses is the one that is written.
#[test]
fn the_example_is_true() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let shop = Shop::new();
    let path = shop.path().join("known.json");
    let written = path.to_str().unwrap();
    let program = "examples/simultaneous-start.ngc";
    let arguments = [
        "check",
        program,
        "-m",
        "three-axis",
        "--write-baseline",
        written,
    ];
    let mut command = shop.command(&arguments);
    assert!(command.current_dir(root).status().unwrap().success());
    let example = fs::read_to_string(root.join("examples/known.json")).unwrap();
    assert_eq!(shop.get("known.json"), example);
}

/// A comment makes the finding of its own line known, where it is asked for, up to its figures.
#[test]
fn comments_make_findings_known() {
    let shop = Shop::new();
    let with = |comment: &str, options: &[&str]| {
        let line = "G0 X200 Y200 Z200";
        assert!(STEEP.contains(line));
        shop.put(
            "steep.ngc",
            STEEP.replace(line, &format!("{line} {comment}")),
        );
        shop.run(&[&["check", "steep.ngc", "-m", "three-axis"], options].concat())
    };
    let ask = ["--known-comments"];
    let known = "(gwatt: known peak-power 7511 W of 3600 W)";
    let ran = with(known, &ask);
    assert_eq!(ran.code, 0, "{}", ran.stdout);
    assert!(
        ran.stdout.ends_with("  baseline: 1 known, 0 new\n"),
        "{}",
        ran.stdout
    );
    assert_eq!(with(known, &[]).code, 1);
    let said = |comment: &str| {
        let ran = with(comment, &ask);
        assert_eq!(ran.code, 1, "{}", ran.stdout);
        let (_, text) = ran.stdout.split_once("  baseline: ").unwrap();
        text.to_owned()
    };
    insta::assert_snapshot!(said("(gwatt: known peak-power 7510 W of 3600 W)"), @r"
    0 known, 1 new
      grown: peak-power in line 2, 7510.8 W of 3600.0 W: G0 X200 Y200 Z200 (gwatt: known peak-power 7510 W of 3600 W), its comment has peak-power 7510.0 W of 3600.0 W
    ");
    insta::assert_snapshot!(said("(gwatt: known peak-power 7511 W of 4000 W)"), @"");
    insta::assert_snapshot!(said("(gwatt: known regen-power 9000 W of 3600 W)"), @"");
    insta::assert_snapshot!(said("(gwatt: known)"), @"");
    let refused = with(known, &["--known-comments", "--write-baseline", "b.json"]);
    assert_eq!(refused.code, 2);
}
