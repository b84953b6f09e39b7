//! Which controller a program is for, and programs of several files.

use super::{Ran, Shop};

/// Asserts that `check` refused a program, with this message.
#[track_caller]
fn refused(ran: &Ran, message: &str) {
    assert_eq!(ran.code, 2, "{}", ran.stderr);
    assert!(ran.stderr.contains(message), "{}", ran.stderr);
}

#[test]
fn a_bare_g28_moves_all_axes_of_a_haas_lathe() {
    let shop = Shop::new();
    shop.put("turn.nc", "%\nO1\nG97 S500 M3\nG0 X40. Z5.\nG28\nM30\n%\n");
    let check = |dialect| shop.run(&["check", "turn.nc", "-m", "lathe", "--dialect", dialect]);
    refused(&check("fanuc-lathe"), "a reference point without axes");
    let read = check("haas-lathe");
    assert!(read.code < 2, "{}", read.stderr);
}

#[test]
fn subprograms_are_found_in_any_spelling_of_their_number() {
    let shop = Shop::new();
    shop.put("main.nc", "%\nO1\nG0 X1.\nM98 P9001\nM30\n%\n");
    let check = || shop.run(&["check", "main.nc", "-m", "vmc", "--dialect", "haas"]);
    let message = "O9001.nc, 9001.ngc or another spelling of the number";
    refused(&check(), message);
    shop.put("O09001.Eia", "O9001\nG0 Y2.\nM99\n");
    let read = check();
    assert!(read.code < 2, "{}", read.stderr);
}

const SIEMENS: &str = "DEF REAL DEPTH = 2\nMSG(\"pocket\")\nG0 X=DEPTH\nM30\n";
const O_WORDS: &str = "o100 sub\nG0 X1\no100 endsub\no100 call\nM2\n";
const FANUCS: &str = "%\nO1000\nG0 X1. Y2.\nM30\n%\n";
const RELATIVES: &str = "fanuc or one of its relatives (haas, mitsubishi, mazak, syntec)";

#[test]
fn dialect_says_what_it_saw() {
    let shop = Shop::new();
    shop.put("a.nc", SIEMENS);
    shop.put("b.nc", FANUCS);
    shop.put("c.h", "0 BEGIN PGM PART MM\n");
    shop.put("d.gcode", "G0 X1\nM30\n");
    let siemens = "a.nc: siemens (DEF with a type in line 1, MSG( in line 2, an address with = \
                   in line 3)";
    let fanucs = "(% in line 1, a program number in line 2, Y words in line 3)";
    let found = shop.run(&["dialect", "a.nc"]);
    assert_eq!(found.stdout, format!("{siemens}\n"));
    assert_eq!(found.code, 0, "{}", found.stderr);
    let found = shop.run(&["dialect", "a.nc", "b.nc", "c.h", "d.gcode", "-m", "vmc"]);
    assert_eq!(
        found.stdout,
        format!(
            "{siemens}; read without errors as siemens\n\
             b.nc: {RELATIVES} {fanucs}; read without errors as {RELATIVES}\n\
             c.h: none: this is a Heidenhain conversational program (Klartext); only programs of \
             G-code words are read: have it posted as DIN/ISO\n\
             d.gcode: not clear: there are no marks of a particular controller; all profiles \
             read it without errors\n"
        )
    );
    assert_eq!(found.code, 2);
    // Without marks all are tried, without a machine too.
    shop.put("e.nc", "G0 X1\n#1=2\nG0 X#1\n");
    shop.put("f.nc", "G0 X1\nG0 X1..2\n");
    let found = shop.run(&["dialect", "e.nc", "f.nc"]);
    let unclear = "not clear: there are no marks of a particular controller";
    let expected = format!("e.nc: {unclear}; read without errors as iso, linuxcnc, ");
    assert!(found.stdout.starts_with(&expected), "{}", found.stdout);
    let none = format!("f.nc: {unclear}; no profile reads it without errors\n");
    assert!(found.stdout.ends_with(&none), "{}", found.stdout);
}

/// What is no program has no controller: no text, a line without end, nothing or comments.
#[test]
fn dialect_refuses_what_is_no_program() {
    let shop = Shop::new();
    shop.put("binary.nc", b"G0 X1\nG1 \0\x01\x02\n");
    shop.put("empty.nc", "");
    shop.put("blank.nc", "\n \n%\n(no blocks)\n%\n");
    let none = "none: there is no program in this file; give a part program";
    for (name, said) in [
        (
            "binary.nc",
            "none: line 2 holds a NUL byte: this is a binary file",
        ),
        ("empty.nc", none),
        ("blank.nc", none),
    ] {
        let found = shop.run(&["dialect", name]);
        let said = format!("{name}: {said}");
        assert!(found.stdout.starts_with(&said), "{}", found.stdout);
        assert_eq!((found.code, &*found.stderr), (2, ""));
        // As `check` refuses it.
        assert_eq!(shop.run(&["check", name]).code, 2);
    }
    let several = shop.run(&["dialect", "gentle.ngc", "empty.nc"]);
    assert_eq!(several.code, 2);
    assert_eq!(shop.run(&["dialect", "gentle.ngc"]).code, 0);
}

#[test]
fn auto_says_what_it_chose() {
    let shop = Shop::new();
    shop.put("a.nc", SIEMENS);
    shop.put("o.nc", O_WORDS);
    let siemens = "gwatt: note: a.nc: read as siemens: DEF with a type in line 1, MSG( in line 2";
    for command in ["check", "limit", "report", "moves"] {
        let read = shop.run(&[command, "a.nc", "-m", "vmc", "--dialect", "auto"]);
        assert!(
            read.stderr.starts_with(siemens),
            "{command}: {}",
            read.stderr
        );
        assert!(read.code < 2, "{}", read.stderr);
    }
    // `check` reads each program as its own controller does.
    let read = shop.run(&["check", "a.nc", "o.nc", "-m", "vmc", "--dialect", "auto"]);
    assert!(read.stderr.starts_with(siemens), "{}", read.stderr);
    let linuxcnc = "gwatt: note: o.nc: read as linuxcnc: O-words in line 1\n";
    assert!(read.stderr.contains(linuxcnc), "{}", read.stderr);
    assert!(read.code < 2, "{}", read.stderr);
    let arguments = ["check", "-", "-m", "vmc", "--dialect", "auto"];
    let read = shop.run_with_input(&arguments, SIEMENS);
    assert!(read.code < 2, "{}", read.stderr);
}

#[test]
fn auto_takes_the_machine_s_own_where_marks_do_not_decide() {
    let shop = Shop::new();
    shop.put("b.nc", FANUCS);
    shop.put("d.nc", "G0 X1.\nM30\n");
    let run = |machine: &str, program: &str| {
        shop.run(&["check", program, "-m", machine, "--dialect", "auto"])
    };
    let read = run("vmc", "d.nc");
    let note = "the machine's own, as there are no marks of a particular controller";
    assert!(read.stderr.contains(note), "{}", read.stderr);
    // A tie among profiles that are not the machine's is no choice.
    let tie = format!(
        "gwatt: b.nc: --dialect auto: it may be for {RELATIVES}: % in line 1, a program number \
         in line 2, Y words in line 3; name one of them\n"
    );
    let read = run("three-axis", "b.nc");
    assert_eq!((read.code, read.stderr), (2, tie));
    shop.put("mill.toml", shop.run(&["machine", "show", "vmc"]).stdout);
    let mill = shop.get("mill.toml");
    let from = mill
        .lines()
        .find(|line| line.starts_with("controller"))
        .unwrap();
    shop.put("mill.toml", mill.replace(from, "controller = \"haas\""));
    let read = run("mill.toml", "b.nc");
    let note = "b.nc: read as haas: the machine's own; % in line 1, a program number in line 2, \
                Y words in line 3 may be fanuc or one of its relatives (mitsubishi, mazak, \
                syntec) too\n";
    assert!(read.stderr.contains(note), "{}", read.stderr);
    assert!(read.code < 2);
}

#[test]
fn auto_refuses_what_it_cannot_choose() {
    let shop = Shop::new();
    shop.put("a.nc", SIEMENS);
    shop.put("o.nc", O_WORDS);
    shop.put("c.h", "0 BEGIN PGM PART MM\n");
    let diff = [
        "diff",
        "--from",
        "vmc",
        "--to",
        "three-axis",
        "a.nc",
        "o.nc",
    ];
    let message = "gwatt: --dialect auto: a.nc is for siemens, o.nc for linuxcnc; give programs \
                   of one controller at a time\n";
    refused(
        &shop.run(&[&diff[..], &["--dialect", "auto"]].concat()),
        message,
    );
    let auto = |program, more: &[&'static str]| {
        let all = ["check", program, "-m", "vmc", "--dialect", "auto"];
        shop.run(&[&all[..], more].concat())
    };
    refused(
        &auto("c.h", &[]),
        "c.h: --dialect auto: this is a Heidenhain",
    );
    let message = "--set #<_depth>=2: `siemens` has no such variable";
    refused(&auto("a.nc", &["--set", "#<_depth>=2"]), message);
}

#[test]
fn a_refusal_begins_with_the_profile_that_reads_the_program() {
    let shop = Shop::new();
    shop.put("o.nc", O_WORDS);
    for command in ["check", "limit", "report", "moves"] {
        let read = shop.run(&[command, "o.nc", "-m", "vmc", "--dialect", "fanuc"]);
        let note = "gwatt: note: o.nc: it is read as fanuc; without errors it is read as linuxcnc \
                    (O-words in line 1): use --dialect linuxcnc\n";
        assert!(read.stderr.starts_with(note), "{command}: {}", read.stderr);
        assert_eq!(read.code, 2);
    }
    let diff = [
        "diff",
        "--from",
        "vmc",
        "--to",
        "three-axis",
        "o.nc",
        "--dialect",
        "fanuc",
    ];
    refused(&shop.run(&diff), "use --dialect linuxcnc");
}

#[test]
fn a_refusal_names_a_profile_that_does_not_read_the_program_either() {
    let shop = Shop::new();
    shop.put("o.nc", O_WORDS.replace("G0 X1", "G0 X1 W5"));
    let check = |dialect| shop.run(&["check", "o.nc", "-m", "vmc", "--dialect", dialect]);
    let note = "it is read as fanuc, but looks as if it is for linuxcnc (O-words in line 1), \
                which on this machine does not read it without errors either";
    refused(&check("fanuc"), note);
    // Where the profile is the one that it looks like, there is no hint.
    let read = check("linuxcnc");
    assert_eq!(read.code, 2);
    assert!(!read.stderr.contains("it is read as"), "{}", read.stderr);
}

#[test]
fn grbl_s_dollar_lines_are_read() {
    let shop = Shop::new();
    let check = |lines: &str| {
        shop.put("a.nc", format!("$X\n{lines}G21 G90\nG1 F100 X10\nM30\n"));
        shop.run(&["check", "a.nc", "-m", "router-48v", "--dialect", "grbl"])
    };
    let plain = check("$10=1 ; report\n$G\n");
    assert!(plain.code < 2, "{}", plain.stderr);
    let note = |lines: &str, said: &str| {
        let home = check(lines);
        assert!(
            home.code < 2 && home.stderr.contains(said),
            "{}",
            home.stderr
        );
        home.stdout.lines().next().unwrap_or_default().to_owned()
    };
    // Homing draws what all axes at once can.
    let peak = note("$H (home)\n", "how fast $H homes is not known");
    assert_ne!(plain.stdout.lines().next(), Some(peak.as_str()));
    note("$H\n", "where $H ends is not known");
    // What a setting permits is no more than the machine file, which counts.
    let lower = note(
        "$120=10\n$110=10\n$11=0.0001\n$32=0\n$130=300\n",
        "settings count as the machine file has them",
    );
    let peak = |text: &str| text.split(" (line").next().map(str::to_owned);
    assert_eq!(peak(&plain.stdout), peak(&lower));
    for setting in [
        "$120=1e6", "$110=1e6", "$11=5", "$32=2", "$115=1", "$100=250", "$120=-1",
    ] {
        let number = setting.split('=').next().unwrap();
        refused(
            &check(&format!("{setting}\n")),
            &format!("{number} is a setting that may change how the machine moves"),
        );
    }
    refused(
        &check("$J=G91 X1 F100\n"),
        "$J=G91 X1 F100 is a command of grbl",
    );
    let other = shop.run(&["check", "a.nc", "-m", "router-48v", "--dialect", "fanuc"]);
    refused(&other, "is not understood");
}

#[test]
fn predefined_names_of_the_control_have_values() {
    let shop = Shop::new();
    shop.put(
        "a.ngc",
        "G21 G17 G40\nG0 X#<_task> Y#<_remap_level> Z#<_ccomp>\nG42.1 D0\nG1 X50 F100\n\
         #1=#<_ccomp>\nX60 Y1\nG40\nG0 X#1 Z[#<_ccomp>/10]\nM2\n",
    );
    let read = shop.run(&["moves", "a.ngc", "-m", "linuxcnc-mill"]);
    assert_eq!(read.code, 0, "{}", read.stderr);
    assert!(
        read.stdout.contains("\"end\":{\"X\":1,\"Y\":0,\"Z\":400}"),
        "{}",
        read.stdout
    );
    assert!(read.stdout.contains("\"X\":420"), "{}", read.stdout);
}

#[test]
fn homing_of_grbl_has_the_speed_and_the_end_of_the_machine_file() {
    let shop = Shop::new();
    let machine = shop.run(&["machine", "show", "router-48v"]).stdout;
    let axes = "kind = \"linear\"";
    let home = format!("{axes}\nhome_mm_min = 300\nhome_mm = 0");
    shop.put("router.toml", machine.replace(axes, &home));
    shop.put("a.nc", "$H\nG21 G90\nG0 X10\nM30\n");
    let read = shop.run(&["moves", "a.nc", "-m", "router.toml", "--dialect", "grbl"]);
    assert_eq!(read.code, 0, "{}", read.stderr);
    assert!(!read.stderr.contains("$H"), "{}", read.stderr);
    let rapid = read.stdout.lines().last().unwrap_or_default();
    assert!(
        rapid.contains("\"start\":{\"X\":0,\"Y\":0,\"Z\":0}"),
        "{rapid}"
    );
}

#[test]
fn a_file_of_subprograms_is_said_to_be_one() {
    let shop = Shop::new();
    shop.put("subs.ngc", "o<a> sub\nG0 X1\no<a> endsub\n");
    let read = shop.run(&["check", "subs.ngc", "gentle.ngc", "-m", "linuxcnc-mill"]);
    assert_eq!(read.code, 0, "{}", read.stderr);
    let note =
        "note[only-subprograms]: this file holds only subprograms: by itself it moves nothing";
    assert!(read.stderr.contains(note), "{}", read.stderr);
    assert!(
        read.stdout
            .contains("subs.ngc: only subprograms: nothing of it was looked at\n"),
        "{}",
        read.stdout
    );
    // The end of a program after them does nothing more.
    shop.put("ends.ngc", "o<a> sub\nG0 X1\no<a> endsub\nM2\n");
    let read = shop.run(&["check", "ends.ngc", "-m", "linuxcnc-mill"]);
    assert_eq!(read.code, 0, "{}", read.stderr);
    assert!(read.stderr.contains(note), "{}", read.stderr);
    assert!(!read.stderr.contains("no-units"), "{}", read.stderr);
    // No certificate speaks of what was not looked at.
    let limited = shop.run(&["limit", "subs.ngc", "-m", "linuxcnc-mill"]);
    assert_eq!(limited.code, 0, "{}", limited.stderr);
    let said = "subs.ngc: only subprograms: nothing of it was looked at\n";
    assert!(limited.stderr.ends_with(said), "{}", limited.stderr);
    let read = shop.run(&[
        "check",
        "subs.ngc",
        "-m",
        "linuxcnc-mill",
        "--format",
        "junit",
    ]);
    assert!(read.stdout.contains("<skipped message="), "{}", read.stdout);
    shop.put("none.ngc", "(nothing)\n");
    let read = shop.run(&["check", "none.ngc", "-m", "linuxcnc-mill"]);
    refused(&read, "there is no program in this file");
}

/// What the machine file says of its own dialect holds with that dialect's name, too.
#[test]
fn the_own_dialect_by_name() {
    let rest = "[language]\nignored = [\"M428\"]";
    let shop = crate::shop::Shop::mill("linuxcnc", "peak_power_w = 5000", rest, "");
    shop.put("a.ngc", "M428\nG0 X1\nM2\n");
    for (dialect, expected) in [("", 0), (" --dialect linuxcnc", 0), (" --dialect grbl", 2)] {
        let (code, _, errors) = shop.run(&format!("check a.ngc{dialect}"));
        assert_eq!(code, expected, "{dialect}: {errors}");
    }
}
