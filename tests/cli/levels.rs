//! Words with levels, as people see them.

use super::Shop;

const AXES: &str = "[path]\nmode = \"exact-stop\"\nrapid = \"linear\"\n\
    [axes.X]\nrapid_mm_min = 30000\naccel_mm_s2 = 5000\nmass_kg = 500\n\
    [axes.Y]\nrapid_mm_min = 30000\naccel_mm_s2 = 5000\nmass_kg = 500\n\
    [axes.Z]\nrapid_mm_min = 30000\naccel_mm_s2 = 5000\nmass_kg = 500\n\
    [limits]\nmargin = 0\n";

/// The table that a profile shows in its comments.
fn example(profile: &str) -> String {
    let text = gwatt::machine::builtin::controllers()
        .iter()
        .find(|it| it.name == profile)
        .unwrap()
        .text;
    let lines = text.lines().filter_map(|line| line.strip_prefix("#     "));
    let lines: Vec<&str> = lines
        .skip_while(|line| *line != "[[levels]]")
        .take_while(|line| *line != "]")
        .collect();
    format!("{}\n]\n", lines.join("\n"))
}

/// The tables that the profiles show can be put into a machine file as they are, and
/// `machine check` shows what they make of the axes.
#[test]
fn tables_of_the_profiles_are_read() {
    let shop = Shop::new();
    let mut shown = String::new();
    for profile in ["haas", "siemens", "grbl"] {
        let axes = if profile == "grbl" {
            AXES.replace("mode = \"exact-stop\"\n", "")
        } else {
            AXES.to_owned()
        };
        let text = format!(
            "schema = 1\nname = \"mill\"\ncontroller = \"{profile}\"\n[converter]\npeak_power_w = 1000\n{axes}{}",
            example(profile)
        );
        shop.put(&format!("{profile}.toml"), text);
        let ran = shop.run(&["machine", "check", &format!("{profile}.toml")]);
        assert_eq!(ran.code, 0, "{}", ran.stderr);
        let lines = ran.stdout.lines();
        let levels = lines.filter(|line| line.contains("G187") || line.contains("DYN"));
        shown.extend(levels.flat_map(|line| [line.trim_end(), "\n"]));
    }
    insta::assert_snapshot!(shown, @r"
    G187 P3          feeds                  X 2500 mm/s2, Y 2500 mm/s2, Z 2500 mm/s2
    G187 P2 or G187  feeds, from the start  X 5000 mm/s2, Y 5000 mm/s2, Z 5000 mm/s2
    G187 P1          feeds                  X 10000 mm/s2, Y 10000 mm/s2, Z 10000 mm/s2
    DYNFINISH   all moves                  X 1200 mm/s2, Y 1200 mm/s2, Z 1000 mm/s2
    DYNSEMIFIN  all moves                  X 1800 mm/s2, Y 1800 mm/s2, Z 1500 mm/s2
    DYNROUGH    all moves                  X 2500 mm/s2, Y 2500 mm/s2, Z 2000 mm/s2
    DYNPOS      all moves                  X 3000 mm/s2, Y 3000 mm/s2, Z 2500 mm/s2
    DYNNORM     all moves, from the start  X 5000 mm/s2, Y 5000 mm/s2, Z 5000 mm/s2
    G187 P5          all moves                  X 1000 mm/s2, Y 1000 mm/s2, Z 1000 mm/s2
    G187 P4          all moves                  X 2000 mm/s2, Y 2000 mm/s2, Z 2000 mm/s2
    G187 P3          all moves                  X 3000 mm/s2, Y 3000 mm/s2, Z 3000 mm/s2
    G187 P2          all moves                  X 4000 mm/s2, Y 4000 mm/s2, Z 4000 mm/s2
    G187 P1 or G187  all moves, from the start  X 5000 mm/s2, Y 5000 mm/s2, Z 5000 mm/s2
    ");
}

/// `check` advises what `limit` writes: the level in one piece, with the F next to it.
#[test]
fn check_advises_levels() {
    let shop = Shop::new();
    let text = format!(
        "schema = 1\nname = \"mill\"\ncontroller = \"siemens\"\n[converter]\npeak_power_w = 1000\n{AXES}{}",
        example("siemens")
    );
    shop.put("mill.toml", text);
    shop.put("part.mpf", "G1 X400 F30000\nX0 F100\nG0 X400\nM30\n");
    let ran = shop.run(&["check", "part.mpf", "-m", "mill.toml"]);
    assert_eq!(ran.code, 1, "{}", ran.stderr);
    assert!(ran.stdout.contains("fits with DYN"), "{}", ran.stdout);
    let written = shop.run(&["limit", "part.mpf", "-m", "mill.toml", "--allow", "feed"]);
    assert_eq!(written.code, 0, "{}", written.stderr);
    assert!(written.stdout.contains("DYN"), "{}", written.stdout);
}
