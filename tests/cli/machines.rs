//! Machines, tool tables and parameter files.

use super::Shop;

#[test]
fn machines_are_listed_shown_and_checked() {
    let shop = Shop::new();
    let list = shop.run(&["machine", "list"]).stdout;
    assert!(list.starts_with("* three-axis "), "{list}");
    let profiles = list.split_once("Controller profiles").unwrap().1;
    for profile in gwatt::machine::builtin::controllers() {
        assert!(profiles.contains(&format!("  {} ", profile.name)), "{list}");
        let text = shop.run(&["machine", "show", profile.name]).stdout;
        assert_eq!(text, profile.text);
    }
    for line in list.lines().take_while(|line| !line.is_empty()) {
        let name = line
            .trim_start_matches(['*', ' '])
            .split(' ')
            .next()
            .unwrap();
        let text = shop.run(&["machine", "show", name]).stdout;
        shop.put("machine.toml", text);
        let ran = shop.run(&["machine", "check", "machine.toml"]);
        assert_eq!(ran.code, 0, "{name}: {}", ran.stderr);
    }
    shop.put("wrong.toml", "schema = 1\nname = \"x\"\nspeed = 5\n");
    shop.run(&["machine", "check", "wrong.toml"])
        .refused("wrong.toml:3");
    shop.run(&["machine", "show", "none"])
        .refused("no built-in machine");
}

/// From the settings of a control to a verdict, as a newcomer goes.
#[test]
fn settings_become_a_machine() {
    let shop = Shop::new();
    shop.put(
        "printer.cfg",
        "[include motion*.cfg]\n[stepper_x]\nposition_endstop: 0\n[stepper_y]\n[stepper_z]\n",
    );
    shop.put(
        "motion-1.cfg",
        "[printer]\nkinematics: cartesian\nmax_velocity: 300\nmax_accel: 3000\n",
    );
    let ran = shop.run(&["machine", "import", "printer.cfg", "-o", "printer.toml"]);
    assert_eq!((ran.code, ran.stdout.as_str()), (0, ""), "{}", ran.stderr);
    assert!(ran.stderr.contains("read as klipper"), "{}", ran.stderr);
    let text = shop.get("printer.toml");
    assert!(text.contains("rapid_mm_min = 18000"), "{text}");
    shop.run(&["machine", "check", "printer.toml"])
        .refused("axis X needs a mass or an inertia");
    let filled = text
        .replace("# peak_power_w = ", "peak_power_w = 300 ")
        .replace("# moved_mass_kg = ", "moved_mass_kg = 0.5 ")
        .replace("# rotor_kg_m2 = ", "rotor_kg_m2 = 0.0000054 ")
        .replace(
            "# pulley = { teeth = , pitch_mm = , width_mm = }",
            "pulley = { teeth = 20, pitch_mm = 2, width_mm = 16 }",
        )
        .replace(
            "# screw = { diameter_mm = , length_mm = , lead_mm = }",
            "screw = { diameter_mm = 8, length_mm = 400, lead_mm = 8 }",
        );
    shop.put("printer.toml", filled);
    let ran = shop.run(&["machine", "check", "printer.toml"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let sum = "X: 0.6492 kg = 0.5 moved mass + 0.1332 rotor (0.0000054 kg m2) + 0.01599 pulley (2 x 0.0000003241 kg m2)";
    assert!(ran.stdout.contains(sum), "{}", ran.stdout);
    shop.put("print.gcode", "G28\nG1 X100 Y50 F12000\nG1 X0\n");
    let ran = shop.run(&["check", "print.gcode", "-m", "printer.toml"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
}

/// What cannot be read leaves no file, and the one that was there stays.
#[test]
fn settings_that_cannot_be_read() {
    let shop = Shop::new();
    shop.put("settings.txt", "$110=fast\n");
    shop.put("kept.toml", "as it was");
    let args = ["machine", "import", "settings.txt", "-o"];
    shop.run(&[&args[..], &["new.toml"]].concat())
        .refused("settings.txt:1:6");
    assert!(!shop.files().contains(&"new.toml".to_owned()));
    shop.run(&[&args[..], &["kept.toml"]].concat())
        .refused("`fast` is not a number");
    assert_eq!(shop.get("kept.toml"), "as it was");
    shop.run(&["machine", "import", "none.ini"])
        .refused("cannot read none.ini");
    shop.run(&["machine", "import", "-", "-"])
        .refused("standard input can be read only once");
    shop.run(&["machine", "import", "settings.txt", "--format", "none"])
        .refused("possible values: linuxcnc, grbl");
}

#[test]
fn tool_tables_and_parameter_files() {
    let shop = Shop::new();
    shop.put("offset.ngc", "G55 G43 H2 G0 X0 Z0\n");
    shop.put("tools.tbl", "T2 P1 Z12.5 ;mill\n");
    shop.put("kept.var", "5241\t30.000000\n5243\t1.000000\n");
    let options = [
        "-m",
        "three-axis",
        "--tool-table",
        "tools.tbl",
        "--parameters",
        "kept.var",
    ];
    let ran = shop.run(&[&["moves", "offset.ngc"][..], &options].concat());
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(
        ran.stdout.contains(r#""end":{"X":30,"Y":0,"Z":13.5"#),
        "{}",
        ran.stdout
    );
    assert_eq!(ran.stderr, "");
    let wrong = [
        ("tools.tbl", "T2 Zfoo\n", "tools.tbl:1:4"),
        ("tools.tbl", "T3 Z1\n", "tool 2 is not in the tool table"),
        ("kept.var", "5221\n", "kept.var:1:1"),
    ];
    for (name, text, message) in wrong {
        let before = shop.get(name);
        shop.put(name, text);
        shop.run(&[&["moves", "offset.ngc"][..], &options].concat())
            .refused(message);
        shop.put(name, before);
    }
    shop.run(&["moves", "offset.ngc", "--tool-table", "none.tbl"])
        .refused("cannot read none.tbl");
}

/// A file that is read is no place for the result, and one that people have filled in is kept.
#[test]
fn imports_overwrite_nothing_that_is_needed() {
    let shop = Shop::new();
    shop.put(
        "router.txt",
        include_str!("../../examples/router-settings.txt"),
    );
    shop.run(&["machine", "import", "router.txt", "-o", "router.txt"])
        .refused("router.txt is read by this run: write to another file");
    shop.put("filled.toml", "mass_kg = 300\n");
    let ran = shop.run(&["machine", "import", "router.txt", "-o", "filled.toml"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let kept = "what filled.toml was is kept as ";
    assert!(ran.stderr.contains(kept), "{}", ran.stderr);
    assert_eq!(shop.get("filled.toml.bak"), "mass_kg = 300\n");
    let again = shop.run(&["machine", "import", "router.txt", "-o", "filled.toml"]);
    assert!(!again.stderr.contains(kept), "{}", again.stderr);
}
