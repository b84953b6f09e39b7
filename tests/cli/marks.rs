//! `limit --mark-rapids`, `--always` and `--preset-else` from outside.

use std::fmt::Write as _;

use super::Shop;

/// X of 500 kg, 0.5 m/s and 5 m/s², without friction: 1000 W are F24000, 800 W are F19200.
fn shop() -> Shop {
    let shop = Shop::new();
    for (name, peak_w) in [("large", 1000), ("small", 800)] {
        let mut machine = format!(
            "schema = 1\nname = \"{name}\"\ncontroller = \"fanuc\"\n[converter]\n\
             peak_power_w = {peak_w}\n[limits]\nmargin = 0\n[path]\nmode = \"exact-stop\"\n\
             rapid = \"linear\"\n[[preset]]\naxes = [\"Y\"]\nspeed_mm_min = {{ Y = 9000 }}\n"
        );
        for axis in ["X", "Y", "Z"] {
            let _ = write!(
                machine,
                "[axes.{axis}]\nkind = \"linear\"\nrapid_mm_min = 30000\naccel_mm_s2 = 5000\n\
                 mass_kg = 500\n"
            );
        }
        shop.put(&format!("{name}.toml"), machine);
    }
    shop.put("far.nc", "G21 G90 G94\nG0 X400. (far)\nG1 Y1. F500.\nM30\n");
    shop
}

#[test]
fn a_program_is_changed_in_place_again_and_again() {
    let shop = shop();
    let usual = ["limit", "far.nc", "--in-place", "--mark-rapids", "-m"];
    let limit = |machine: &str| shop.run(&[&usual[..], &[machine]].concat());
    let marked =
        |feed: &str| format!("G21 G90 G94\nG1 X400. F{feed}. (RAPID) (far)\nG1 Y1. F500.\nM30\n");
    assert_eq!(limit("large.toml").code, 0);
    assert_eq!(shop.get("far.nc"), marked("24000"));
    let backups = shop.files().len();
    // Nothing to do: nothing is replaced.
    assert_eq!(limit("large.toml").code, 0);
    assert_eq!(shop.files().len(), backups);
    let again = limit("small.toml");
    assert_eq!(again.code, 0, "{}", again.stderr);
    let condition = "\n  feeds with the comment (RAPID) stand for rapids: F may be lowered\n";
    assert!(again.stderr.contains(condition), "{}", again.stderr);
    assert_eq!(shop.get("far.nc"), marked("19200"));
    let diff = shop.run(&[
        "limit",
        "far.nc",
        "--dry-run",
        "--mark-rapids=G0",
        "-m",
        "small.toml",
    ]);
    assert_eq!((diff.code, diff.stdout.as_str()), (0, ""));
}

/// Without marks a feed in place of a rapid cuts: a note where its F looks written.
#[test]
fn what_an_earlier_run_wrote_without_marks_is_noted() {
    let shop = shop();
    let note = "note[unmarked-rapid]: its F looks as an earlier run of `limit` writes one for a \
                rapid: without marks it counts as a cutting feed";
    for (feed, mark, noted) in [
        ("23976", None, true),
        ("23976", Some("--mark-rapids"), false),
        ("24000", None, false),
    ] {
        let part = format!("G21 G90 G94\nG1 X400. F{feed}\nG1 Y1. F500.\nM30\n");
        shop.put("again.nc", part);
        let asked = ["limit", "again.nc", "-m", "small.toml"];
        let ran = shop.run(&[&asked[..], mark.as_slice()].concat());
        assert_eq!(ran.code, 1, "{}", ran.stderr);
        assert_eq!(ran.stderr.contains(note), noted, "{}", ran.stderr);
    }
}

#[test]
fn a_mark_of_ones_own() {
    let shop = shop();
    let ran = shop.run(&[
        "limit",
        "far.nc",
        "--mark-rapids=was G0",
        "-m",
        "large.toml",
    ]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(
        ran.stdout.contains(" F24000. (was G0) (far)\n"),
        "{}",
        ran.stdout
    );
    for (text, why) in [
        (
            "--mark-rapids=a)",
            "`a)` is no mark: 1 to 32 letters, digits, blanks",
        ),
        ("--mark-rapids=", "is no mark: 1 to 32 letters"),
        (
            "--mark-rapids=msg x",
            "`msg x` is no mark: a comment that begins with this word acts",
        ),
    ] {
        shop.run(&["limit", "far.nc", text]).refused(why);
    }
}

#[test]
fn files_of_subprograms_are_marked() {
    let shop = shop();
    shop.put("main.nc", "G21 G90 G94\nM98 P100\nM30\n");
    shop.put("O0100.nc", "O0100\nG0 X400.\nG0 X0.\nM99\n");
    let limit = |program: &str, machine: &str, into: &str| {
        let usual = ["limit", program, "--with-subprograms", "--mark-rapids"];
        shop.run(&[&usual[..], &["-m", machine, "-o", into]].concat())
    };
    assert_eq!(limit("main.nc", "large.toml", "fit").code, 0);
    let sub = |feed: u32| {
        format!("O0100\nG1 X400. F{feed}. (RAPID)\nG0\nG1 X0. F{feed}. (RAPID)\nG0\nM99\n")
    };
    assert_eq!(shop.get("fit/O0100.nc"), sub(24000));
    let again = limit("fit/main.nc", "small.toml", "smaller");
    assert_eq!(again.code, 0, "{}", again.stderr);
    let smaller = sub(19200).replace("(RAPID)\n", "(RAPID)\nF24000.\n");
    assert_eq!(shop.get("smaller/O0100.nc"), smaller);
}

/// The way to a hole that stands by itself, and the rapids of a cycle that is written out.
#[test]
fn rapids_of_cycles_are_marked() {
    let shop = shop();
    let program = "G21 G90 G94\nG0 Z300.\nG81 X400. Z-10. R200. F500.\nG80\nM30\n";
    shop.put("holes.nc", program);
    let limit = |program: &str, machine: &str, out: &str| {
        let usual = ["limit", program, "--allow", "expand", "--mark-rapids"];
        shop.run(&[&usual[..], &["-m", machine, "-o", out]].concat())
    };
    let first = limit("holes.nc", "large.toml", "fit.nc");
    assert_eq!(first.code, 0, "{}", first.stderr);
    let fit = shop.get("fit.nc");
    assert!(fit.matches("(RAPID)").count() > 2, "{fit}");
    let second = limit("fit.nc", "small.toml", "smaller.nc");
    assert_eq!(second.code, 0, "{}", second.stderr);
    assert_eq!(shop.get("smaller.nc"), fit.replace("F24000", "F19200"));
}

#[test]
fn presets_are_for_strategies_that_have_them() {
    let shop = shop();
    let limit = |arguments: &[&str]| {
        let usual = ["limit", "far.nc", "-m", "small.toml"];
        shop.run(&[&usual[..], arguments].concat())
    };
    limit(&["--always"]).refused("--always goes with --strategy preset or --law patent");
    for what in ["speed", "refuse"] {
        limit(&["--preset-else", what]).refused("--preset-else goes with --strategy preset");
    }
    let refused = limit(&["--strategy", "preset", "--preset-else", "refuse"]);
    assert_eq!(refused.code, 1);
    assert!(
        refused.stderr.contains("no preset for the axes X"),
        "{}",
        refused.stderr
    );
    let ran = limit(&["--strategy", "preset", "--preset-else", "speed", "--always"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(
        ran.stdout.contains("\nG1 X400. F19199. (far)\n"),
        "{}",
        ran.stdout
    );
    let note = "note[no-preset]: 1 line moves axes for which there is no preset: it gets the speed \
                that fits (--preset-else speed)\n";
    assert!(ran.stderr.starts_with(note), "{}", ran.stderr);
}

/// A cycle that was written out shifts the lines after it, but not in what is said of them.
#[test]
fn notes_name_the_lines_that_were_read() {
    let shop = shop();
    let program =
        "G21 G90 G94\nG0 Z300.\nG81 X400. Z-10. R200. F500.\nG80\nG1 Y100. F20000.\nM30\n";
    shop.put("holes.nc", program);
    let usual = ["limit", "holes.nc", "-m", "large.toml", "--allow", "expand"];
    let presets = ["--strategy", "preset", "--preset-else", "speed", "--always"];
    let ran = shop.run(&[&usual[..], &presets].concat());
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(
        ran.stdout.contains("\nG1 Y100. F20000.\n"),
        "{}",
        ran.stdout
    );
    let stays = "note[preset-not-set]: 1 line fits and stays as it is, though --always asks for \
                 less: no permitted word lowers the speed of this block\n --> holes.nc:5:1\n";
    assert!(ran.stderr.contains(stays), "{}", ran.stderr);
    assert!(
        ran.stderr.contains("note[no-preset]: 4 lines move axes"),
        "{}",
        ran.stderr
    );
}
