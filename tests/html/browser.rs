//! The page in a browser, where there is one.

use std::path::Path;
use std::process::Command;

use super::{Desk, example};

#[test]
fn a_page_works_in_chromium() {
    let desk = Desk::new();
    let program = example("simultaneous-start.ngc");
    let machine = ["-m", "three-axis"];
    let files = ["-o", "fit.ngc", "--html", "page.html"];
    desk.exits(0, &[&["limit", &program], &machine[..], &files].concat());
    works(&desk);
}

#[test]
fn a_page_with_voltages_works_in_chromium() {
    let desk = Desk::new();
    let program = example("pocket.ngc");
    let files = ["--allow", "feed", "-o", "fit.ngc", "--html", "page.html"];
    desk.exits(0, &[&["limit", &program, "-m", "vmc"], &files[..]].concat());
    works(&desk);
}

#[test]
fn a_page_of_two_machines_works_in_chromium() {
    let desk = Desk::new();
    let program = example("run-up.ngc");
    let both = ["--from", "three-axis", "--to", "vmc", "--html", "page.html"];
    desk.exits(1, &[&["diff", &program], &both[..]].concat());
    works(&desk);
}

#[test]
fn a_page_of_a_tuning_works_in_chromium() {
    let desk = Desk::new();
    let [x, y] =
        ["flexible-x.csv", "flexible-y.csv"].map(|it| example(&format!("recordings/{it}")));
    desk.exits(0, &["tune", &x, &y, "--html", "page.html"]);
    opens(&desk, "instruments.mjs");
    desk.exits(0, &["tune", &x, "--html", "page.html"]);
    opens(&desk, "instruments.mjs");
}

#[test]
fn a_page_of_an_identification_works_in_chromium() {
    let desk = Desk::new();
    for (recording, model) in [("flexible-x.csv", "flexible"), ("axis-x.csv", "rigid")] {
        let recording = example(&format!("recordings/{recording}"));
        let asked = ["--axis", "X", "--model", model, "--html", "page.html"];
        desk.exits(0, &[&["identify", &recording], &asked[..]].concat());
        opens(&desk, "instruments.mjs");
    }
}

pub(super) fn works(desk: &Desk) {
    opens(desk, "page.mjs");
}

/// The script says by itself that it skipped where Chromium or a package is not there.
fn opens(desk: &Desk, script: &str) {
    let script = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/html")
        .join(script);
    let Ok(output) = Command::new("node")
        .arg(script)
        .arg(desk.at("page.html"))
        .output()
    else {
        crate::evidence::cannot_run("there is no node");
        return;
    };
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let said = String::from_utf8_lossy(&output.stdout);
    match said.trim().strip_prefix("skipped: ") {
        Some(why) => crate::evidence::cannot_run(why),
        None => crate::evidence::runs(),
    }
}
