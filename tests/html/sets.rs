//! The page of programs that are limited together.

use serde_json::Value;

use super::browser::works;
use super::{Desk, most};

/// Two axes of 500 kg, 0.5 m/s and 5 m/s² draw up to 500 · 5 · 0.5 = 1250 W each, so that two
/// that start together draw 2500 W.
const MACHINE: &str = "schema = 1\nname = \"rig\"\ncontroller = \"iso\"\n[converter]\n\
    peak_power_w = 1000\n[axes.X]\nkind = \"linear\"\nrapid_mm_min = 30000\n\
    accel_mm_s2 = 5000\nmass_kg = 500\n[axes.Y]\nkind = \"linear\"\nrapid_mm_min = 30000\n\
    accel_mm_s2 = 5000\nmass_kg = 500\n[limits]\nmargin = 0\n[path]\n\
    mode = \"exact-stop\"\nrapid = \"linear\"\n";
const BOTH: &str = "G21 G90 G94\nG0 X1000. Y1000.\nM98 P100\nM30\n";
const ONE: &str = "G21 G90 G94\nG0 X1000.\nM98 P100\nM30\n";
const HOME: &str = "O0100\nG0 X0. Y0. (home)\nM99\n";

fn desk() -> Desk {
    let desk = Desk::new();
    desk.put("rig.toml", MACHINE);
    desk.put("one.nc", ONE);
    desk.put("both.nc", BOTH);
    desk.put("O0100.nc", HOME);
    desk
}

fn limit(desk: &Desk, code: i32, arguments: &[&str]) -> String {
    let usual = ["limit", "--with-subprograms", "-m", "rig.toml"];
    desk.exits(code, &[&usual[..], arguments].concat())
}

fn part(page: &str, id: &str) -> Value {
    let (_, rest) = page.split_once(&format!("id=\"{id}\">")).unwrap();
    let (data, _) = rest.split_once("</script>").unwrap();
    serde_json::from_str(data).unwrap()
}

#[test]
fn each_program_has_its_peaks_before_and_after() {
    let desk = desk();
    let files = ["one.nc", "both.nc", "-o", "fit", "--html", "page.html"];
    limit(&desk, 0, &files);
    let page = desk.get("page.html");
    let set = part(&page, "set-data");
    let [one, both] = [0, 1].map(|place| &set["programs"][place]);
    assert_eq!([&one["program"], &both["program"]], ["one.nc", "both.nc"]);
    for (program, before_w) in [(one, 1250.0), (both, 2500.0)] {
        let peak_w = [0, 1].map(|side| program["peak_w"][side].as_f64().unwrap());
        assert!((peak_w[0] - before_w).abs() < 1e-6, "{peak_w:?}");
        assert!(peak_w[1] <= 1000.0, "{peak_w:?}");
        assert_eq!(program["fits"], true);
    }
    assert_eq!(set["files"][0][1], 2, "{}", set["files"]);
    assert_eq!(set["written"], true);
    for (id, program) in [("data", one), ("data-1", both)] {
        let data = part(&page, id);
        assert_eq!(data["head"]["program"], program["program"]);
        assert_eq!(most(&data["bars"], "peak_w"), program["peak_w"][0]);
        assert_eq!(most(&data["bars"], "peak_after_w"), program["peak_w"][1]);
        // What was written is planned with the files as they are written.
        for side in ["before", "after"] {
            let shares = &data["shares"][side];
            assert!(shares["count"].as_u64().unwrap() > 2, "{id} {side}");
        }
        assert_eq!(data["texts"]["line"][0], 2, "{}", data["texts"]);
    }
}

#[test]
fn nothing_is_written_where_one_does_not_fit() {
    let desk = desk();
    desk.put("cut.nc", "G21 G90 G94\nG1 X1000. Y1000. F40000\nM30\n");
    let files = ["one.nc", "cut.nc", "-o", "fit", "--html", "page.html"];
    limit(&desk, 1, &files);
    let set = part(&desk.get("page.html"), "set-data");
    assert_eq!(set["written"], false);
    assert_eq!(set["programs"][1]["fits"], false);
    assert!(!desk.at("fit").exists());
}

#[test]
fn the_page_shows_one_way_and_replaces_no_file_that_is_read() {
    let desk = desk();
    let said = limit(&desk, 2, &["one.nc", "-o", "fit", "--html", "O0100.nc"]);
    assert!(said.contains("is read by this run"), "{said}");
    let either = ["one.nc", "-o", "fit", "--probe", "both", "--html", "p.html"];
    let said = limit(&desk, 2, &either);
    assert!(said.contains("--html shows one way"), "{said}");
    assert_eq!(desk.get("O0100.nc"), HOME);
    assert!(!desk.at("p.html").exists() && !desk.at("fit").exists());
}

#[test]
fn a_page_of_several_programs_works_in_chromium() {
    let desk = desk();
    let files = ["one.nc", "both.nc", "-o", "fit", "--html", "page.html"];
    limit(&desk, 0, &files);
    works(&desk);
}
