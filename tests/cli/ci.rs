//! What CI runs: the hooks of pre-commit and the action, line by line.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use super::{GENTLE, Shop};
use crate::layers::root;

fn read(name: &str) -> String {
    fs::read_to_string(root().join(name)).unwrap()
}

/// The values of a key, one a line, without quotes.
fn values(yaml: &str, key: &str) -> Vec<String> {
    let lines = yaml
        .lines()
        .map(|line| line.trim().trim_start_matches("- "));
    let found = lines.filter_map(|line| line.strip_prefix(key)?.strip_prefix(": "));
    found
        .map(|value| value.trim_matches('\'').to_owned())
        .collect()
}

/// The hooks run as pre-commit runs them: entry, arguments, names of files.
#[test]
fn hooks_check_the_files_that_they_are_given() {
    let hooks = read(".pre-commit-hooks.yaml");
    assert_eq!(
        values(&hooks, "id"),
        ["gwatt-check", "gwatt-check-installed"]
    );
    assert_eq!(values(&hooks, "language"), ["rust", "system"]);
    let shop = Shop::new();
    for entry in values(&hooks, "entry") {
        let words: Vec<&str> = entry.split(' ').collect();
        assert_eq!(words[0], "gwatt");
        let run = |files: &[&str]| {
            let arguments = [&words[1..], &["--machine", "three-axis"], files].concat();
            shop.run(&arguments)
        };
        let fits = run(&["gentle.ngc"]);
        assert_eq!((fits.code, fits.stdout.as_str()), (0, ""));
        let ran = run(&["gentle.ngc", "steep.ngc"]);
        assert_eq!(ran.code, 1);
        assert!(
            ran.stdout.starts_with("steep.ngc: does not fit"),
            "{}",
            ran.stdout
        );
    }
    // The files are those that a folder stands for.
    for pattern in values(&hooks, "files") {
        let endings = pattern
            .split_once(r"(\.(")
            .unwrap()
            .1
            .split_once(')')
            .unwrap()
            .0;
        for ending in endings.split('|') {
            let folder = format!("folder-{ending}");
            fs::create_dir_all(shop.path().join(&folder)).unwrap();
            shop.put(&format!("{folder}/part.{ending}"), GENTLE);
            let ran = shop.run(&["check", &folder, "-m", "three-axis"]);
            assert_eq!(ran.code, 0, "{ending}: {}", ran.stderr);
        }
        let listing = read("src/command/listing.rs");
        let known = listing.split_once("ENDINGS: [&str; ").unwrap().1;
        let known: usize = known.split(']').next().unwrap().parse().unwrap();
        assert_eq!(endings.split('|').count(), known);
    }
}

/// The steps of the action, with gwatt in the path.
#[cfg(unix)]
fn step(shop: &Shop, index: usize, inputs: &[(&str, &str)]) -> Output {
    let steps = values(&read("action.yml"), "run");
    let gwatt = Path::new(env!("CARGO_BIN_EXE_gwatt"));
    let path = std::env::var("PATH").unwrap();
    let path = format!("{}:{path}", gwatt.parent().unwrap().display());
    let mut command = Command::new("bash");
    command
        .args(["-e", "-o", "pipefail", "-c", &steps[index]])
        .current_dir(shop.path())
        .env("GITHUB_ACTION_PATH", root())
        .env("PATH", path);
    for input in ["PROGRAMS", "MACHINE", "BASELINE", "ARGUMENTS", "SARIF"] {
        // Every input of the action has its variable.
        let line = format!("{input}: ${{{{ inputs.{} }}}}", input.to_lowercase());
        assert!(read("action.yml").contains(&line), "{line}");
        command.env(input, "");
    }
    command.envs(inputs.iter().copied()).output().unwrap()
}

#[cfg(unix)]
#[test]
fn the_action_checks_and_annotates() {
    let shop = Shop::new();
    assert!(step(&shop, 0, &[]).status.success());
    let ran = step(
        &shop,
        1,
        &[("PROGRAMS", "gentle.ngc\n"), ("MACHINE", "three-axis")],
    );
    let text = String::from_utf8(ran.stdout).unwrap();
    assert_eq!(
        text,
        "::notice title=gwatt::1 fit, 0 do not fit, 0 refused\n"
    );
    assert!(ran.status.success());
    let inputs = [
        ("PROGRAMS", "gentle.ngc\n\nsteep.ngc"),
        ("ARGUMENTS", "-m\nthree-axis"),
        ("SARIF", "found.sarif"),
    ];
    let ran = step(&shop, 1, &inputs);
    assert_eq!(ran.status.code(), Some(1));
    let text = String::from_utf8(ran.stdout).unwrap();
    assert!(
        text.starts_with("::error file=steep.ngc,line=2,title=peak-power::"),
        "{text}"
    );
    let sarif: serde_json::Value = serde_json::from_str(&shop.get("found.sarif")).unwrap();
    let found = &sarif["runs"][0]["results"][0];
    assert_eq!(found["ruleId"], "peak-power");
    let known = shop.run(&[
        "check",
        ".",
        "-m",
        "three-axis",
        "--write-baseline",
        "known.json",
    ]);
    assert_eq!(known.code, 0, "{}", known.stderr);
    let inputs = [
        ("PROGRAMS", "."),
        ("MACHINE", "three-axis"),
        ("BASELINE", "known.json"),
    ];
    assert!(step(&shop, 1, &inputs).status.success());
    shop.put("bad.ngc", "G1 X1 (\n");
    assert_eq!(step(&shop, 1, &inputs).status.code(), Some(2));
}

/// A fix of SARIF, put in as its reader does, is what `limit` writes.
#[test]
fn fixes_are_what_limit_writes() {
    let shop = Shop::new();
    let program = super::STEEP.replace("M30", "(ä) G0 X0 Y0 Z0\nG0 X9\nM30");
    shop.put("part.ngc", &program);
    let on = ["part.ngc", "-m", "three-axis"];
    let ran = shop.run(&[&["check", "--format", "sarif"], &on[..]].concat());
    let sarif: serde_json::Value = serde_json::from_str(&ran.stdout).unwrap();
    let results = sarif["runs"][0]["results"].as_array().unwrap();
    let fix = &results[0]["fixes"][0];
    assert!(results[1]["fixes"].is_null());
    let text = fix["description"]["text"].as_str().unwrap();
    assert!(
        text.starts_with("what `gwatt limit --allow feed` writes: "),
        "{text}"
    );
    let mut lines: Vec<String> = program.split_inclusive('\n').map(str::to_owned).collect();
    let change = &fix["artifactChanges"][0];
    assert_eq!(change["artifactLocation"]["uri"], "part.ngc");
    for replacement in change["replacements"].as_array().unwrap().iter().rev() {
        let region = &replacement["deletedRegion"];
        let number = |key: &str| region[key].as_u64().unwrap() as usize - 1;
        assert_eq!(number("startColumn"), 0);
        let (first, last, column) = (number("startLine"), number("endLine"), number("endColumn"));
        let text = replacement["insertedContent"]["text"].as_str().unwrap();
        let rest: String = lines[last].chars().skip(column).collect();
        lines.splice(first..=last, [format!("{text}{rest}")]);
    }
    let ran = shop.run(&[&["limit", "--allow", "feed", "-o", "fit.ngc"], &on[..]].concat());
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert_eq!(lines.concat(), shop.get("fit.ngc"));
    // Only SARIF asks for them, and nothing that fits has any.
    let ran = shop.run(&[
        "check",
        "gentle.ngc",
        "-m",
        "three-axis",
        "--format",
        "sarif",
    ]);
    assert!(!ran.stdout.contains("fixes"));
}

/// The time of a test case is that of the program on the machine.
#[test]
fn junit_has_the_times_of_programs() {
    let shop = Shop::new();
    shop.put("dwell.ngc", "G4 P2.5\nM30\n");
    let on = [
        "-m",
        "three-axis",
        "--dialect",
        "linuxcnc",
        "--format",
        "junit",
    ];
    let ran = shop.run(&[&["check", "dwell.ngc"], &on[..]].concat());
    assert!(
        ran.stdout
            .contains(r#"<testcase name="dwell.ngc" classname="gwatt" time="2.500">"#)
            || ran
                .stdout
                .contains(r#"<testcase name="dwell.ngc" classname="gwatt" time="2.500"/>"#),
        "{}",
        ran.stdout
    );
}

#[test]
fn explain() {
    let shop = Shop::new();
    let ran = shop.run(&["explain", "arc-radius"]);
    assert_eq!(ran.code, 0);
    insta::assert_snapshot!(ran.stdout, @r"
    arc-radius

    The start and the end of an arc have different distances from its centre, or its radius is too
    small for its end.

    Power: The path is not known. A lost digit makes another circle, with another power.

    Example, `linuxcnc`:

        G0 X0 Y0
        G2 X10 Y0 I9 J0 F1000

    Do: Write the end point or the centre with more decimals, or check their signs.
    ");
    // As it stands in a message; several at once.
    let two = shop.run(&["explain", "error[arc-radius]: start", "peak-power"]);
    assert!(two.stdout.starts_with(&ran.stdout), "{}", two.stdout);
    assert!(
        two.stdout
            .contains("\n\npeak-power\n\nA move draws more power")
    );
    let all = shop.run(&["explain"]).stdout;
    assert!(all.lines().count() > 200);
    assert!(all.lines().is_sorted());
    assert!(
        all.contains("peak-power              A move draws more power than the converter gives.\n")
    );
    let lost = "no rule is named `arc-radios`: did you mean arc-radius";
    shop.run(&["explain", "arc-radios"]).refused(lost);
    let none = "no rule is named `qqq`: `gwatt explain` lists all";
    shop.run(&["explain", "qqq"]).refused(none);
}
