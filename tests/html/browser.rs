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
fn a_page_of_two_machines_works_in_chromium() {
    let desk = Desk::new();
    let program = example("run-up.ngc");
    let both = ["--from", "three-axis", "--to", "vmc", "--html", "page.html"];
    desk.exits(1, &[&["diff", &program], &both[..]].concat());
    works(&desk);
}

/// `page.mjs` says by itself that it skipped where Chromium or a package is not there.
fn works(desk: &Desk) {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/html/page.mjs");
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
