//! Rapids under G64 that are written as feeds and keep their stops: by a dwell before them
//! where a feed comes before, and by G9 at their end.

use crate::shop::Shop;

/// What `limit` writes on a mill with linear rapids.
fn limited(controller: &str, program: &str) -> String {
    Shop::straight(controller, 600.0).limited(program, "")
}

/// X moves 410 mm, Y 300: together they draw (0.5·(200·3 + 100) + 0.366·(200·2.195 +
/// 100))/0.8 = 684 W, and 100 W at rest.
#[test]
fn a_rapid_keeps_its_stops() {
    let program = "G21 G90\nG1 Z-1. F500\nG1 X-10.\nG0 X400. Y300.\nG1 X410.\nM30\n";
    for controller in ["fanuc", "haas", "mitsubishi", "mazak", "syntec"] {
        let text = limited(controller, program);
        let expected = "G1 X-10.\nG4 P1\nG9 G1 X400. Y300. F";
        assert!(text.contains(expected), "{controller}: {text}");
        let after = text.split(expected).nth(1).unwrap_or_default();
        // 619.6 mm/s by (600 − 100)/684.
        let (feed, rest) = after.split_once('\n').unwrap_or_default();
        let feed: f64 = feed.parse().unwrap_or_default();
        assert!((feed - 27174.0).abs() < 2.0, "{controller}: {feed}");
        assert_eq!(rest, "G1 X410. F500\nM30\n", "{controller}");
    }
}

/// A dwell that the program has itself is one of its own and makes the stop.
#[test]
fn a_dwell_of_a_millisecond_of_its_own_stays() {
    let program = "G21 G90 G1 Z-1. F500\nG4 P1\nG0 X400. Y300.\nG4 P1\nG4 P1\nG1 X410. F500\nM30\n";
    let text = limited("fanuc", program);
    assert_eq!(text.matches("G4 P1\n").count(), 3, "{text}");
    assert!(text.contains("G9 G1 X400. Y300. F"), "{text}");
}

/// Each word of the shortest dwell as its control reads it.
#[test]
fn a_lathe_in_feed_per_minute() {
    let shop = Shop::mill(
        "fanuc-lathe",
        "peak_power_w = 700",
        "[path]\nrapid = \"linear\"",
        "",
    );
    let text = shop.written("G98 G21\nG1 X-20. F500\nG0 X400. Z300.\nM30\n", "");
    assert!(text.contains("G4 P1\nG9 G1 X400. Z300. F"), "{text}");
}

/// Under feed per revolution the feed per minute stands apart: what was in force is put
/// back at once.
#[test]
fn a_rapid_among_feeds_per_revolution() {
    let converter = "peak_power_w = 600";
    for (controller, [minute, revolution], dwell, [stop, dwell_after]) in [
        ("fanuc-lathe", ["G98", "G99"], "G4 P1\n", ["G9 ", ""]),
        ("fanuc-lathe-b", ["G94", "G95"], "G4 P1\n", ["G9 ", ""]),
        ("linuxcnc", ["G94", "G95"], "G4 P0\n", ["", "G4 P0\n"]),
    ] {
        let shop = Shop::mill(controller, converter, "[path]\nrapid = \"linear\"", "");
        let text = shop.written(&format!("{revolution} G21\nM3 S500\nG1 X-20. F.2\nG0 X400. Z300.\nG1 X401.\nX402. F.1\nM30\n"), "");
        let before = format!("F.2\n{minute}\n{dwell}{stop}G1 X400. Z300. F");
        assert!(text.contains(&before), "{controller}: {text}");
        let after = format!("\n{dwell_after}G0 {revolution} F.2\nG1 X401.\nX402. F.1\nM30\n");
        assert!(text.ends_with(&after), "{controller}: {text}");
        let (code, _, errors) = shop.run("check out.nc");
        assert_eq!(code, 0, "{controller}: {errors}");
    }
}

/// A feed between two rapids begins and ends at rest: it is planned. Next to a feed it is
/// bounded with what that one may bring.
#[test]
fn a_feed_between_rapids_is_planned() {
    let shop = Shop::mill(
        "fanuc",
        "peak_power_w = 9000",
        "[path]\nrapid = \"linear\"",
        "",
    );
    let peak_w = |program: &str| -> (f64, String) {
        shop.put("a.nc", program);
        let (_, csv, errors) = shop.run("report a.nc");
        let row = csv
            .lines()
            .find(|line| line.starts_with("3,"))
            .expect(&errors);
        let cells: Vec<&str> = row.split(',').collect();
        (cells[6].parse().unwrap(), cells[19].to_owned())
    };
    // X at 0.4 and Y at 0.3 m/s, 3 and 2.25 m/s²: (0.4·(200·3 + 100) + 0.3·(200·2.25 + 100))/0.8.
    let (alone_w, certificate) = peak_w("G21 G90\nG0 Z1.\nG1 X400. Y300. F30000\nG0 Z5.\nM30\n");
    assert!((alone_w - (100.0 + 556.25)).abs() < 1e-6, "{alone_w}");
    assert_eq!(certificate, "planned");
    let (next_w, certificate) = peak_w("G21 G90\nG0 Z1.\nG1 X400. Y300. F30000\nX410.\nM30\n");
    assert!(next_w > alone_w && certificate == "robust", "{next_w}");
    // G9 lets it end at rest.
    for word in ["G9", "G09"] {
        let program = format!("G21 G90\nG0 Z1.\n{word} G1 X400. Y300. F30000\nX410.\nM30\n");
        assert_eq!(peak_w(&program), (alone_w, "planned".to_owned()));
    }
}

/// An arc in a plane that the frame turns is bounded, more loosely the faster its F says that
/// it goes, though no axis reaches that.
#[test]
fn an_arc_in_a_turned_plane() {
    let program = "G21 G90 G61 G10 L2 P1 X0 Y0 R60\nG54 F254000\nG0 X0 Y0 Z0\n\
                   G0 Y38.1 Z12.7\nG19\nG2 Y12.7 Z38.1 K25.4\nM2\n";
    let shop = Shop::mill(
        "linuxcnc",
        "peak_power_w = 1000",
        "[path]\nrapid = \"linear\"",
        "",
    );
    shop.put("a.nc", program);
    let (code, _, errors) = shop.run("limit a.nc --allow feed -o out.nc");
    assert_eq!(code, 0, "{errors}");
    assert_eq!(shop.run("check out.nc").0, 0);
}
