//! `limit --with-subprograms`: programs and the files that they call, written together.
//!
//! Axes of 500 kg, 0.5 m/s and 5 m/s² without friction take v·500 kg·5 m/s² each: one that
//! moves alone fits 1000 W at 0.4 m/s (F24000), two that start together at 0.2 m/s each,
//! along the line at 0.2 m/s·√2 (F16970).

use std::fs;

use super::Shop;

const BOTH: &str = "G21 G90 G94\nG0 X1000. Y1000.\nM98 P100\nM30\n";
const ONE: &str = "G21 G90 G94\nG0 X1000.\nM98 P100\nM30";
const HOME: &str = "O0100\nG0 X0. Y0. (home)\nM99";
const HOME_OF_BOTH: &str = "O0100\nG1 X0. Y0. F16970 (home)\nG0\nM99";
const HOME_OF_ONE: &str = "O0100\nG1 X0. Y0. F24000 (home)\nG0\nM99";

/// A shop with a machine of that controller, `rig.toml`.
fn shop(controller: &str) -> Shop {
    let shop = Shop::new();
    let axis = |letter| {
        format!(
            "[axes.{letter}]\nkind = \"linear\"\nrapid_mm_min = 30000\naccel_mm_s2 = 5000\n\
             mass_kg = 500\n"
        )
    };
    let machine = format!(
        "schema = 1\nname = \"rig\"\ncontroller = \"{controller}\"\n[converter]\n\
         peak_power_w = 1000\n{}{}{}[limits]\nmargin = 0\n[path]\nmode = \"exact-stop\"\n\
         rapid = \"linear\"\n",
        axis('X'),
        axis('Y'),
        axis('Z')
    );
    shop.put("rig.toml", machine);
    shop.put("both.nc", BOTH);
    shop.put("one.nc", ONE);
    shop.put("O0100.nc", HOME);
    shop
}

/// Limits programs into the folder `fit`; further arguments may follow the programs.
fn limit(shop: &Shop, arguments: &[&str]) -> super::Ran {
    let usual = ["-m", "rig.toml", "--with-subprograms", "-o", "fit"];
    shop.run(&[&["limit"], arguments, &usual].concat())
}

/// Limits them; they must fit, and again when they are read from the folder.
#[track_caller]
fn fits(shop: &Shop, programs: &[&str]) {
    let ran = limit(shop, programs);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    for program in programs {
        let written = format!("fit/{program}");
        let checked = shop.run(&["check", &written, "-m", "rig.toml"]);
        assert_eq!(checked.code, 0, "{}", checked.stdout);
    }
}

/// Tries to limit them; nothing may appear.
#[track_caller]
fn stays(shop: &Shop, arguments: &[&str], code: i32, message: &str) {
    let ran = limit(shop, arguments);
    assert_eq!(ran.code, code, "{}", ran.stderr);
    assert!(ran.stderr.contains(message), "{}", ran.stderr);
    assert!(!shop.path().join("fit").exists());
}

#[test]
fn a_subprogram_of_two_programs_gets_the_lower_value() {
    let shop = shop("iso");
    fits(&shop, &["one.nc"]);
    assert_eq!(shop.get("fit/O0100.nc"), HOME_OF_ONE);
    fits(&shop, &["one.nc", "both.nc"]);
    assert_eq!(shop.get("fit/O0100.nc"), HOME_OF_BOTH);
    assert_eq!(
        shop.get("fit/one.nc"),
        "G21 G90 G94\nG1 X1000. F24000\nG0\nM98 P100\nM30"
    );
    assert_eq!(
        shop.get("fit/both.nc"),
        "G21 G90 G94\nG1 X1000. Y1000. F16970\nG0\nM98 P100\nM30\n"
    );
    // The originals are what they were, and nothing is left next to the new files.
    assert_eq!(shop.get("O0100.nc"), HOME);
    assert_eq!(fs::read_dir(shop.path().join("fit")).unwrap().count(), 3);
}

#[test]
fn files_that_no_change_concerns_are_copied() {
    let shop = shop("iso");
    // Bytes that are no text, and no line end at the end.
    let gentle = b"O0100\r\nG1 F100 X999. (\xff)\r\nM99".as_slice();
    shop.put("O0100.nc", gentle);
    fits(&shop, &["one.nc"]);
    let copy = fs::read(shop.path().join("fit/O0100.nc")).unwrap();
    assert_eq!(copy, gentle);
}

#[test]
fn reports_name_every_file() {
    let shop = shop("iso");
    let files = ["--report", "r.csv", "--json", "r.json"];
    let ran = limit(&shop, &[&["one.nc", "both.nc"][..], &files].concat());
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let list = "files of this certificate:\n  one.nc: 2 lines changed\n  both.nc: 2 lines \
                changed\n  ./O0100.nc: 2 lines changed\nother programs that call";
    assert!(ran.stderr.contains(list), "{}", ran.stderr);
    let csv = shop.get("r.csv");
    let rows = csv.lines().skip(1).map(|row| {
        let cells: Vec<_> = row.split(',').collect();
        [cells[22], cells[0], cells[14]].join(" ")
    });
    let rows: Vec<_> = rows.collect();
    assert_eq!(
        rows,
        [
            "one.nc 2 24000",
            "./O0100.nc 2 16970",
            "both.nc 2 16970",
            "./O0100.nc 2 16970",
        ]
    );
    let json: serde_json::Value = serde_json::from_str(&shop.get("r.json")).unwrap();
    assert_eq!(json["certified"], true);
    assert_eq!(json["files"][2]["file"], "./O0100.nc");
    assert_eq!(json["files"][2]["edited_lines"], 2);
    assert_eq!(json["programs"][1]["program"], "both.nc");
    assert_eq!(json["programs"][1]["peak_w"], 2500);
    assert_eq!(json["blocks"].as_array().map(Vec::len), Some(4));
}

/// Of one program the report is the one that it has by itself, with the files.
#[test]
fn one_program_has_its_usual_report() {
    let shop = shop("iso");
    let ran = limit(&shop, &["one.nc", "--json", "r.json", "--report", "r.csv"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let json: serde_json::Value = serde_json::from_str(&shop.get("r.json")).unwrap();
    assert_eq!(json["program"], "one.nc");
    assert_eq!(json["edited_lines"], 4);
    assert_eq!(json["blocks"][0]["file"], "");
    assert_eq!(json["blocks"][1]["file"], "./O0100.nc");
    assert_eq!(json["files"][0]["file"], "one.nc");
    assert!(shop.get("r.csv").lines().nth(1).unwrap().ends_with(",1,"));
}

#[test]
fn without_the_flag_files_of_subprograms_stay() {
    let shop = shop("iso");
    let ran = shop.run(&["limit", "one.nc", "-m", "rig.toml", "-o", "fit.nc"]);
    assert_eq!(ran.code, 1);
    let message = "it stands in a file of subprograms, which other programs may call\n --> \
                   ./O0100.nc:2:1";
    assert!(ran.stderr.contains(message), "{}", ran.stderr);
    let help = "--with-subprograms writes the files of subprograms too";
    assert!(ran.stderr.contains(help), "{}", ran.stderr);
    assert!(!shop.path().join("fit.nc").exists());
    shop.run(&["limit", "one.nc", "both.nc", "-m", "rig.toml"])
        .refused("several programs: give a folder by -o, or --in-place (and --with-subprograms if");
}

#[test]
fn subprograms_of_every_language() {
    let texts = [
        (
            "linuxcnc",
            ("l.ngc", "G21 G90 G94\nG0 X1000\no<way> call\nM2\n"),
            ("way.ngc", "o<way> sub\nG0 X0 Y0\no<way> endsub\nM2\n"),
            "o<way> sub\nG1 X0 Y0 F24000\nG0\no<way> endsub\nM2\n",
        ),
        (
            "siemens",
            ("s.mpf", "G71 G90 G94\nG0 X1000\nWAY\nM30\n"),
            ("WAY.SPF", "N10 G0 X0 Y0\nM17\n"),
            "N10 G1 X0 Y0 F24000\nG0\nM17\n",
        ),
        (
            "isg",
            ("i.nc", "G71 G90 G94\nG0 X1000\nL way.nc\nM30\n"),
            ("way.nc", "N10 G0 X0 Y0\nM17\n"),
            "",
        ),
        (
            "fanuc",
            ("f.nc", "G21 G90 G94\nG0 X1000.\nG65 P9 A0\nM30\n"),
            ("9", "O9\nG0 X#1 Y0.\nM99\n"),
            "O9\nG1 X#1 Y0. F24000.\nG0\nM99\n",
        ),
        (
            "fanuc",
            (
                "g.nc",
                "G21 G90 G94\nG66 P9\nG1 F500. X10.\nX20.\nG67\nM30\n",
            ),
            ("9", "O9\nG0 Y1000.\nY0.\nM99\n"),
            "",
        ),
    ];
    for (controller, main, sub, expected) in texts {
        let shop = shop(controller);
        shop.put(main.0, main.1);
        shop.put(sub.0, sub.1);
        fits(&shop, &[main.0]);
        let written = shop.get(&format!("fit/{}", sub.0));
        if expected.is_empty() {
            assert_ne!(written, sub.1, "{controller}");
        } else {
            assert_eq!(written, expected, "{controller}");
        }
    }
}

/// What a printer's macro file holds is lowered too.
#[test]
fn macro_files_of_printers() {
    let shop = shop("klipper");
    shop.put("p.gcode", "G90\nG1 X1000 F24000\nEND_PRINT\n");
    shop.put("END_PRINT.gcode", "G1 X0 F30000\n");
    stays(
        &shop,
        &["p.gcode", "--strategy", "speed"],
        1,
        "END_PRINT.gcode:1:1",
    );
    let ran = limit(&shop, &["p.gcode"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let written = shop.get("fit/END_PRINT.gcode");
    assert!(
        written.starts_with("SET_VELOCITY_LIMIT ACCEL=") && written.contains("\nG1 X0 F30000\n"),
        "{written}"
    );
    assert_eq!(shop.get("fit/p.gcode"), "G90\nG1 X1000 F24000\nEND_PRINT\n");
}

/// A line of a file that is called in a loop gets what is right for its worst run.
#[test]
fn a_subprogram_in_a_loop() {
    let shop = shop("fanuc");
    shop.put(
        "loop.nc",
        "G21 G90 G94\n#1=0\nWHILE [#1 LT 3] DO1\nG0 X1000.\nG0 Y[#1*500]\nM98 P100\n#1=#1+1\n\
         END1\nM30\n",
    );
    fits(&shop, &["loop.nc"]);
    assert_eq!(
        shop.get("fit/O0100.nc"),
        HOME_OF_BOTH.replace(" (home)", ". (home)")
    );
}

#[test]
fn lines_that_cannot_suit_all_callers_are_refused() {
    let shop = shop("iso");
    let differ = "it runs several times, under feeds or modes that differ";
    // The F that would have to be put back is not the same, and something counts on it.
    shop.put("O0101.nc", "O0101\nG1 Z1.\nM99\n");
    for (name, feed) in [("slow.nc", 500), ("fast.nc", 600)] {
        let calls = "G0 X1000.\nM98 P100\nM98 P101";
        shop.put(name, format!("G21 G90 G94 F{feed}\n{calls}\nM30\n"));
    }
    fits(&shop, &["slow.nc"]);
    fs::remove_dir_all(shop.path().join("fit")).unwrap();
    stays(&shop, &["slow.nc", "fast.nc"], 1, differ);
    shop.put("inches.nc", "G20 G90 G94 F500\nG0 X40.\nM98 P100\nM30\n");
    stays(&shop, &["slow.nc", "inches.nc"], 1, differ);
    let text = "nothing is written: the programs are certified together, or none is";
    stays(&shop, &["slow.nc", "inches.nc"], 1, text);
}

#[test]
fn blocks_that_keep_their_words_keep_them_in_files_too() {
    let shop = shop("iso");
    let refused = |sub: &str, arguments: &[&str], code, message: &str| {
        shop.put("O0100.nc", sub);
        stays(&shop, &[&["one.nc"], arguments].concat(), code, message);
    };
    let feed = ["--allow", "feed"];
    let by_turns = "O0100\nM3 S3000\nG95 G1 X0. F10.\nG94\nM99\n";
    refused(by_turns, &feed, 1, "the feed in force is per revolution");
    refused("O0100\nG33 X0. F30.\nM99\n", &feed, 2, "G33 is thread");
    refused("O0100\nG1 X0. F30000\nM99\n", &[], 1, "without permission");
    refused("O0100\nG0 X0.\n", &[], 2, "without a return");
}

#[test]
fn a_subprogram_that_is_missing() {
    let shop = shop("iso");
    shop.put("lost.nc", "G0 X1.\nM98 P7\nM30\n");
    stays(
        &shop,
        &["one.nc", "lost.nc"],
        2,
        "there is no subprogram O7",
    );
}

#[test]
fn files_of_one_name_from_two_folders() {
    let shop = shop("iso");
    for (folder, program) in [("p1", BOTH), ("p2", ONE)] {
        fs::create_dir(shop.path().join(folder)).unwrap();
        shop.put(&format!("{folder}/a.nc"), program);
        shop.put(&format!("{folder}/O0100.nc"), HOME);
    }
    fits(&shop, &["p1/a.nc", "p2/a.nc"]);
    assert_eq!(shop.get("fit/p1/O0100.nc"), HOME_OF_BOTH);
    assert_eq!(shop.get("fit/p2/O0100.nc"), HOME_OF_ONE);
}

#[test]
fn folders_of_subprograms_keep_their_places() {
    let shop = shop("iso");
    fs::create_dir(shop.path().join("lib")).unwrap();
    fs::rename(
        shop.path().join("O0100.nc"),
        shop.path().join("lib/O0100.nc"),
    )
    .unwrap();
    let ran = limit(&shop, &["one.nc", "--sub-path", "lib"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert_eq!(shop.get("fit/lib/O0100.nc"), HOME_OF_ONE);
    let written = [
        "check",
        "fit/one.nc",
        "-m",
        "rig.toml",
        "--sub-path",
        "fit/lib",
    ];
    assert_eq!(shop.run(&written).code, 0);
}

/// A program that another one calls is changed for both.
#[test]
fn a_program_may_be_called_by_another() {
    let shop = shop("iso");
    shop.put("O0100.nc", "O0100\nG90 G94\nG0 X0. Y0.\nM99\n");
    fits(&shop, &["both.nc", "O0100.nc"]);
    assert_eq!(
        shop.get("fit/O0100.nc"),
        "O0100\nG90 G94\nG1 X0. Y0. F16970\nG0\nM99\n"
    );
}

#[test]
fn in_place_keeps_what_was_there() {
    let shop = shop("iso");
    shop.put("gentle.nc", "G21 G90 G94\nG1 F100 X1.\nM98 P200\nM30\n");
    shop.put("O0200.nc", "O0200\nG4 P1\nM99\n");
    let arguments = ["limit", "one.nc", "gentle.nc", "-m", "rig.toml"];
    let in_place = ["--with-subprograms", "--in-place"];
    let ran = shop.run(&[&arguments[..], &in_place].concat());
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert_eq!(shop.get("O0100.nc"), HOME_OF_ONE);
    assert_eq!(shop.get("O0100.nc.bak"), HOME);
    assert_eq!(shop.get("one.nc.bak"), ONE);
    let files = shop.files();
    assert!(!files.contains(&"gentle.nc.bak".to_owned()));
    assert!(!files.contains(&"O0200.nc.bak".to_owned()));
    // Nothing is left to do.
    let ran = shop.run(&[&arguments[..], &in_place].concat());
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert_eq!(shop.files(), files);
}

#[test]
fn a_dry_run_shows_every_file() {
    let shop = shop("iso");
    let files = shop.files();
    let arguments = ["limit", "one.nc", "-m", "rig.toml", "--with-subprograms"];
    let ran = shop.run(&[&arguments[..], &["--dry-run"]].concat());
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(ran.stdout.contains("-G0 X1000.\n+G1 X1000. F24000\n+G0\n"));
    assert!(ran.stdout.contains("+G1 X0. Y0. F24000 (home)\n+G0\n"));
    assert_eq!(shop.files(), files);
}

#[test]
fn with_partial_files_are_written_that_do_not_fit_yet() {
    let shop = shop("iso");
    shop.put("O0100.nc", "O0100\nG0 Y1000.\nG1 X0. F30000\nM99\n");
    let ran = limit(&shop, &["one.nc", "--partial"]);
    assert_eq!(ran.code, 1, "{}", ran.stderr);
    assert_eq!(
        shop.get("fit/O0100.nc"),
        "O0100\nG1 Y1000. F24000\nG0\nG1 X0. F30000\nM99\n"
    );
}

#[test]
fn cycles_of_a_program_are_written_out_next_to_calls() {
    let shop = shop("iso");
    let drilled = "G21 G90 G94\nG0 X1000. Y0. Z10.\nG81 X0. Z-5. R1. F200\nY1000.\nG80\n";
    shop.put("drill.nc", format!("{drilled}G0 X1000.\nM98 P100\nM30\n"));
    fits(&shop, &["drill.nc"]);
    // The way to each hole stands before the cycle.
    let holes = "G0\nG1 X0. F24000\nG0\nG81 X0. Z-5. R1. F200\nG1 Y1000. F24000\nG0 F200\n\
                 G81 Y1000. R1. Z-5.\nG80\n";
    let written = shop.get("fit/drill.nc");
    assert!(written.contains(holes), "{written}");
    let home = HOME_OF_BOTH.replace("G0\n", "G0 F200\n");
    assert_eq!(shop.get("fit/O0100.nc"), home);
}

#[test]
fn all_files_appear_or_none() {
    let shop = shop("iso");
    fs::create_dir_all(shop.path().join("fit/O0100.nc")).unwrap();
    let ran = limit(&shop, &["one.nc"]);
    ran.refused("O0100.nc: it is a folder");
    assert!(!shop.path().join("fit/one.nc").exists());
    let into = |folder| {
        let usual = ["limit", "one.nc", "-m", "rig.toml", "--with-subprograms"];
        shop.run(&[&usual[..], &["-o", folder]].concat())
    };
    into("both.nc").refused("-o both.nc is no folder");
    into("both.nc/new").refused("cannot make the folder both.nc/new");
    into(".").refused("is read by this run");
    assert_eq!(shop.get("both.nc"), BOTH);
}

#[test]
fn usage() {
    let shop = shop("iso");
    stays(&shop, &["one.nc", "./one.nc"], 2, "./one.nc is given twice");
    stays(&shop, &["-"], 2, "standard input lies in no folder");
    shop.run(&["limit", "one.nc", "-m", "rig.toml", "--with-subprograms"])
        .refused("give a folder by -o, or --in-place");
}

/// LinuxCNC's accelerations over HAL: each run of a subprogram carries its own words.
#[test]
fn outputs_are_set_in_subprograms_too() {
    let shop = shop("linuxcnc");
    let machine = shop.get("rig.toml");
    shop.put(
        "rig.toml",
        format!("{machine}[outputs]\nacceleration = 0\n"),
    );
    shop.put(
        "w.ngc",
        "G21 G90 G94 F100\nG0 X400\no<home> call\nG0 X400\no<home> call\nM2\n",
    );
    shop.put("home.ngc", "o<home> sub\nG0 X0\nG1 X1\no<home> endsub\n");
    fits(&shop, &["w.ngc"]);
    assert_eq!(
        shop.get("fit/home.ngc"),
        "o<home> sub\nM68 E0 Q0.799\nM66 P0 L0\nG0 X0\nM68 E0 Q1\nM66 P0 L0\nG1 X1\n\
         o<home> endsub\n"
    );
}
