//! Macros of printer.cfg, in files of their own.

use std::io::Cursor;

use gwatt::pipeline::{self, Failure, Options};

use super::{load, machine};

/// A macro of printer.cfg stands in a file of its own: what it comes to. Nothing is known of
/// it otherwise, unless the machine file says that it moves nothing, or that it moves.
#[test]
fn macros_in_files_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write(
        "Start_Print.gcode",
        "; as it comes out\nG91\nG1 Z5 F300\nG90\nPURGE",
    );
    write("PURGE.g", "G1 X9\n");
    write("BAD.gcode", "G1 X{1}\n");
    write("AGAIN.gcode", "AGAIN\n");
    let run = |program: &str| {
        let mut options = Options::default();
        options.reading.sub_paths = [folder.path().to_path_buf()].into();
        let mut out = Vec::new();
        let result = pipeline::moves(
            Cursor::new(program.to_owned()),
            &machine("klipper"),
            &options,
            &mut |mv, _| {
                out.push((mv.line, mv.end[0], mv.end[2]));
                Ok(())
            },
        );
        match result {
            Ok(_) => Ok(out),
            Err(Failure::Refused { diagnostics, .. }) => {
                let found = diagnostics
                    .iter()
                    .find(|found| found.severity == gwatt::diagnostic::Severity::Error)
                    .unwrap();
                Err(format!(
                    "{} {}: {} | {}",
                    found.line,
                    found.rule,
                    found.message,
                    found.help.clone().unwrap_or_default()
                ))
            }
            Err(other) => panic!("{other}"),
        }
    };
    let found = run("G1 X1 F600\nSTART_PRINT BED=60\nG1 X2\nstart_print\nG1 X3\n").unwrap();
    let expected = [
        (1, 1.0, 0.0),
        (3, 1.0, 5.0),
        (1, 9.0, 5.0),
        (3, 2.0, 5.0),
        (3, 2.0, 10.0),
        (1, 9.0, 10.0),
        (5, 3.0, 10.0),
    ];
    assert_eq!(found, expected);
    assert_eq!(
        run("BAD\n").unwrap_err(),
        "1 macro-file: the file of the macro BAD holds a template: `{` | write the commands that it comes to, one a line"
    );
    assert!(run("AGAIN\n").unwrap_err().starts_with("1 call-depth: "));
    assert_eq!(
        run("OWN_MACRO\n").unwrap_err(),
        "1 unknown-macro: `OWN_MACRO` is a macro or a command that this profile does not know | write what it comes to into a file OWN_MACRO.gcode in the program's folder or one given by --sub-path; or in the machine file, under [language], list it in `ignored_macros` if it moves nothing and sets nothing, or in `unknown_moves` if it moves and leaves feed and modes as they are, or in `unknown_macros` if nothing is known of it"
    );
    let own = load(
        "schema = 1\nname = \"test\"\ncontroller = \"klipper\"\n[converter]\npeak_power_w = 1e5\n\
         [language]\nignored_macros = [\"END_*\"]\nunknown_moves = [\"START_PRINT\"]\nignored = [\"M777\"]\n\
         [axes.X]\nrapid_mm_min = 6000\naccel_mm_s2 = 1000\nmass_kg = 10\n",
    );
    let said = super::run(&own, "G1 X1 F600\nSTART_PRINT\nEND_PRINT\nM777\n");
    assert!(
        said.contains("from anywhere X") && said.contains("note unknown-moves"),
        "{said}"
    );
}
