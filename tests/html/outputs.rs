//! Where pages go, and what is left where there is none.

use std::fs;

use super::{Desk, data};

const STEEP: &str = "G21 G90 G94 G17\nG0 X200 Y200 Z200\nG1 F100 X210\nM30\n";

#[test]
fn check_writes_a_page() {
    let desk = Desk::new();
    desk.put("steep.ngc", STEEP);
    let output = desk.run(&[
        "check",
        "steep.ngc",
        "-m",
        "three-axis",
        "--html",
        "page.html",
    ]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stdout).contains("does not fit"));
    let shown = data(&desk.get("page.html"));
    assert_eq!(shown["head"]["word"], "does not fit");
    assert!(
        shown["head"]["helps"][0][1]
            .as_str()
            .unwrap()
            .starts_with("fits with G1")
    );
    desk.put("auto.ngc", "#<a> = 1\n".to_owned() + STEEP);
    let auto = [
        "-m",
        "three-axis",
        "--dialect",
        "auto",
        "--html",
        "auto.html",
    ];
    desk.exits(1, &[&["check", "auto.ngc"], &auto[..]].concat());
    assert_eq!(
        data(&desk.get("auto.html"))["head"]["controller"],
        "linuxcnc"
    );
}

#[test]
fn pages_that_cannot_be_are_refused() {
    let desk = Desk::new();
    desk.put("steep.ngc", STEEP);
    fs::create_dir(desk.at("folder")).unwrap();
    let refused = |arguments: &[&str], message: &str| {
        let said = desk.exits(2, arguments);
        assert!(said.contains(message), "{said}");
    };
    let with = |command: &'static str, more: &[&'static str]| {
        [&[command, "steep.ngc", "-m", "three-axis"], more].concat()
    };
    refused(
        &with("report", &["--html", "none/page.html"]),
        "cannot write none/page.html",
    );
    refused(
        &with("limit", &["-o", "fit.ngc", "--svg", "folder"]),
        "it is a folder; name a file in it",
    );
    refused(
        &with("report", &["--html", "steep.ngc"]),
        "is read by this run",
    );
    refused(
        &with("report", &["--html", "a.html", "--svg", "a.html"]),
        "would be written twice",
    );
    refused(&with("limit", &["--html", "-"]), "only one result");
    refused(&with("check", &["--html", "-"]), "only one result");
    refused(
        &with("report", &["--html", "a.html", "--override", "50%"]),
        "cannot be used with",
    );
    refused(
        &[
            "check",
            "steep.ngc",
            "steep.ngc",
            "-m",
            "three-axis",
            "--html",
            "a.html",
        ],
        "shows one program",
    );
    refused(
        &with(
            "limit",
            &["--with-subprograms", "-o", "folder", "--svg", "a.svg"],
        ),
        "cannot be used with",
    );
    refused(
        &with("report", &["--probe", "both", "--html", "a.html"]),
        "--html shows one way",
    );
    assert!(!desk.at("fit.ngc").exists() && !desk.at("a.html").exists());
}

/// A program that is refused leaves the page that was there.
#[test]
fn a_page_appears_whole_or_not_at_all() {
    let desk = Desk::new();
    desk.put("bad.ngc", "G21 G90\nG0 X[\nM30\n");
    desk.put("binary.ngc", b"G21 G90 (\0)\nG0 X1\nM30\n");
    desk.put("page.html", "old");
    for program in ["bad.ngc", "binary.ngc"] {
        for command in ["report", "check", "limit"] {
            desk.exits(
                2,
                &[command, program, "-m", "three-axis", "--html", "page.html"],
            );
            assert_eq!(desk.get("page.html"), "old");
        }
    }
    assert_eq!(fs::read_dir(desk.at("")).unwrap().count(), 3);
}

#[test]
fn a_page_goes_to_standard_output() {
    let desk = Desk::new();
    desk.put("steep.ngc", STEEP);
    let output = desk.run(&["report", "steep.ngc", "-m", "three-axis", "--html", "-"]);
    assert_eq!(output.status.code(), Some(0));
    let page = String::from_utf8(output.stdout).unwrap();
    assert!(page.starts_with("<!DOCTYPE html>") && page.ends_with("</html>\n"));
}

/// What could not be made to fit is shown too, and says that nothing was written.
#[test]
fn a_limit_that_could_not_has_its_page() {
    let desk = Desk::new();
    desk.put("feed.ngc", "G21 G90 G94\nF60000\nG1 X200 Y200 Z200\nM30\n");
    desk.exits(
        1,
        &[
            "limit",
            "feed.ngc",
            "-m",
            "three-axis",
            "-o",
            "fit.ngc",
            "--html",
            "page.html",
        ],
    );
    assert!(!desk.at("fit.ngc").exists());
    let shown = data(&desk.get("page.html"));
    assert_eq!(
        shown["head"]["word"],
        "cannot be made to fit: nothing is written"
    );
    assert_eq!(shown["head"]["fits"], false);
}
