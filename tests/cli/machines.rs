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

#[test]
fn tool_tables_and_parameter_files() {
    let shop = Shop::new();
    shop.put("offset.ngc", "G43 H2\nG55 G0 X0 Z0\n");
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
