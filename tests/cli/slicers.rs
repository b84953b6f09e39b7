//! gwatt as slicers call it, with the lines of docs/slicers.md.

use std::fs;
use std::process::Command;

use super::{Ran, Shop};
use crate::layers::root;

/// At 500 mm/s the bed takes 225 W and the electronics 30: more than the printer's supply has.
const PRINT: &str = "; sliced\nG21\nG90\nM82\nG0 F30000 X10 Y180 Z0.2\nG1 F1800 X100\n";
/// Nothing but a lower F could help.
const HARD: &str = "G21\nG90\nG1 F30000 X10 Y180\n";

/// The lines of docs/slicers.md, for this gwatt and the built-in printer.
fn lines() -> Vec<String> {
    let page = fs::read_to_string(root().join("docs/slicers.md")).unwrap();
    let lines = page.lines().filter(|line| line.starts_with("gwatt limit "));
    let lines = lines.map(|line| {
        let line = line.replacen("gwatt", env!("CARGO_BIN_EXE_gwatt"), 1);
        let here = line.replace("/home/me/printer.toml", "printer");
        assert_ne!(here, line);
        here
    });
    lines.collect()
}

/// Runs a line as `PrusaSlicer` and its relatives do: through the user's shell, with the file
/// last, in quotes, and what they say in the environment.
fn slice(shop: &Shop, line: &str) -> Ran {
    let file = shop.path().join(".4711.gcode.pp");
    let output = Command::new("sh")
        .args(["-c", &format!("{line} '{}'", file.display())])
        .current_dir("/")
        .env("SLIC3R_PP_HOST", "File")
        .env("SLIC3R_PP_OUTPUT_NAME", shop.path().join("a cube.gcode"))
        .output();
    Ran::from(output.unwrap())
}

#[test]
fn a_file_is_changed_in_place() {
    let lines = lines();
    assert_eq!(lines.len(), 2);
    for (line, page) in lines.iter().zip([None, Some("a cube.gcode.html")]) {
        let shop = Shop::new();
        shop.put(".4711.gcode.pp", PRINT);
        let before = shop.files();
        let ran = slice(&shop, line);
        assert_eq!(ran.code, 0, "{}", ran.stderr);
        assert_eq!(ran.stdout, "");
        let written = shop.get(".4711.gcode.pp");
        assert_ne!(written, PRINT);
        assert!(written.starts_with("; sliced\n"), "{written}");
        // Neither a copy nor anything else is left but what was asked for.
        let mut expected = before;
        expected.extend(page.map(str::to_owned));
        expected.sort();
        assert_eq!(shop.files(), expected);
        // Read again, as its name is no program's.
        shop.put("again.gcode", written);
        let ran = shop.run(&["check", "again.gcode", "-m", "printer"]);
        assert_eq!(ran.code, 0, "{}", ran.stdout);
    }
}

/// The exit code stops the slicer, which shows what is on standard error; the file is the same.
#[test]
fn a_file_that_does_not_fit_stays_as_it_was() {
    let shop = Shop::new();
    let line = lines()
        .remove(0)
        .replace("--allow feed", "--strategy speed");
    for (text, code) in [(HARD, 1), ("G21\nG1 X\n", 2), ("GCDE\0\u{1}\n", 2)] {
        shop.put(".4711.gcode.pp", text);
        let files = shop.files();
        let ran = slice(&shop, &line);
        assert_eq!(ran.code, code, "{text:?}: {}", ran.stderr);
        assert_ne!(ran.stderr, "");
        assert_eq!(shop.get(".4711.gcode.pp"), text);
        assert_eq!(shop.files(), files);
    }
}

#[test]
fn only_in_place_there_is_a_copy_to_leave_out() {
    let shop = Shop::new();
    shop.run(&["limit", "steep.ngc", "--no-backup"])
        .refused("--in-place");
    shop.run(&["limit", "steep.ngc", "--no-backup", "-o", "x.ngc"])
        .refused("cannot be used with '--output <OUT>'");
}

/// Sets written in place leave no copies either.
#[test]
fn sets_keep_no_copies() {
    let shop = Shop::new();
    let run = [
        "limit",
        "steep.ngc",
        "-m",
        "three-axis",
        "--with-subprograms",
        "--in-place",
    ];
    let files = shop.files();
    let ran = shop.run(&[&run[..], &["--no-backup"]].concat());
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert_ne!(shop.get("steep.ngc"), super::STEEP);
    assert_eq!(shop.files(), files);
}

/// The script for Cura, run with what Cura gives a script.
#[test]
fn cura_gets_what_fits_or_nothing_to_print() {
    const RUN: &str = "\
import json, sys
from scripts_of_cura.scripts.GwattLimit import GwattLimit
class Set(GwattLimit):
    def getSettingValueByKey(self, key):
        return json.loads(sys.argv[1])[key]
described = json.loads(GwattLimit().getSettingDataString())
assert described['key'] == 'GwattLimit' and described['version'] == 2
assert set(described['settings']) == {'program', 'machine', 'feeds'}
sys.stdout.write('|'.join(Set().execute(json.loads(sys.argv[2]))))
";
    let shop = Shop::new();
    let package = shop.path().join("scripts_of_cura/scripts");
    fs::create_dir_all(&package).unwrap();
    shop.put("scripts_of_cura/__init__.py", "");
    shop.put("scripts_of_cura/Script.py", "class Script:\n    pass\n");
    shop.put("scripts_of_cura/scripts/__init__.py", "");
    let script = root().join("examples/cura/GwattLimit.py");
    fs::copy(script, package.join("GwattLimit.py")).unwrap();
    let run = |program: &str, feeds: bool, layers: &[&str]| {
        let settings =
            format!(r#"{{"program": "{program}", "machine": "printer", "feeds": {feeds}}}"#);
        let layers = format!("{layers:?}");
        let output = Command::new("python3")
            .args(["-B", "-c", RUN, &settings, &layers])
            .current_dir(shop.path())
            .output();
        output.ok().map(Ran::from)
    };
    let (first, second) = PRINT.split_at(PRINT.find("G1").unwrap());
    let Some(ran) = run(env!("CARGO_BIN_EXE_gwatt"), false, &[first, second]) else {
        eprintln!("skipped: there is no python3");
        return;
    };
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    shop.put("print.gcode", PRINT);
    let other = shop.run(&["limit", "print.gcode", "-m", "printer"]);
    assert_eq!(ran.stdout, other.stdout);
    for (program, why) in [
        (env!("CARGO_BIN_EXE_gwatt"), "-:2"),
        ("/no/such/gwatt", "/no/such/gwatt: "),
    ] {
        let ran = run(program, true, &["G21\n", "G1 X\n"]).unwrap();
        assert_eq!(ran.code, 0, "{}", ran.stderr);
        let comments = ran.stdout.lines().all(|line| line.starts_with("; "));
        assert!(comments, "{}", ran.stdout);
        assert!(ran.stdout.starts_with("; gwatt has not limited"));
        assert!(ran.stdout.contains(why), "{}", ran.stdout);
    }
}
