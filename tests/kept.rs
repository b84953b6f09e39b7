//! What only the control knows: variables that it keeps from one program to the next,
//! and what probes find.

use crate::shop::Shop;

/// Exit code and what is said of a program read as `dialect`.
fn check(dialect: &str, program: &str, options: &str) -> (i32, String) {
    let shop = Shop::mill("iso", "peak_power_w = 1e6\nregen_power_w = 1e6", "", "");
    shop.put("a.nc", program);
    shop.put("kept.var", "500 12.5\n31 4\n");
    let (code, out, shown) =
        shop.run(format!("check a.nc --dialect {dialect} {options}").trim_end());
    (code, out + &shown)
}

#[track_caller]
fn refused(dialect: &str, program: &str, part: &str) {
    let (code, shown) = check(dialect, program, "");
    assert!(code == 2 && shown.contains(part), "{code} {shown}");
}

#[track_caller]
fn fits(dialect: &str, program: &str, options: &str) {
    let (code, shown) = check(dialect, program, options);
    assert_eq!(code, 0, "{shown}");
}

const HELD: &str = "holds what the control has kept from before, which is not known";

#[test]
fn variables_that_outlast_a_program_are_unknown() {
    let program = "G21 G90\nG0 X#500\nM30\n";
    refused("fanuc", program, &format!("#500 {HELD}"));
    refused(
        "fanuc",
        "IF[#501 GT 0]GOTO 10\nG0 X9.\nN10 G0 X1.\nM30\n",
        HELD,
    );
    fits("fanuc", "#500=5\nG0 X#500\nM30\n", "");
    fits("fanuc", program, "--set #500=1.5");
    fits("fanuc", program, "--parameters kept.var");
    // With the file the others are null.
    fits("fanuc", "G0 X[#500+#501]\nM30\n", "--parameters kept.var");
    // Those that a control clears are null.
    fits(
        "fanuc",
        "IF[#100 EQ #0]GOTO 10\nG0 X9.\nN10 G0 X1.\nM30\n",
        "",
    );
    refused("haas", "G0 X#149\nM30\n", HELD);
    refused("haas", "G0 X#10500\nM30\n", HELD);
    fits("haas", "#10500=5.\nG0 X#10500\nM30\n", "");
    refused("linuxcnc", "G0 X#31\nM2\n", HELD);
    fits("linuxcnc", "G0 X#31\nM2\n", "--parameters kept.var");
    fits("linuxcnc", "G0 X[#32+1]\nM2\n", "--parameters kept.var");
    fits("linuxcnc", "G0 X#<_far>\nM2\n", "--set #<_far>=7");
    refused("siemens", "G0 X=R1\nM30\n", "R1 has no value");
    fits("siemens", "G0 X=R1\nM30\n", "--set R1=3");
    let global = "G0 X=WIDTH/2\nM30\n";
    refused(
        "siemens",
        global,
        "give what the control keeps, as in --set WIDTH=1",
    );
    fits("siemens", global, "--set width=3");
    refused("okuma", "G0 X=VC1\nM30\n", "VC1 has no value");
    fits("okuma", "G0 X=VC1\nM30\n", "--set VC1=3");
}

#[test]
fn what_is_worked_out_from_an_unknown_value_is_unknown() {
    let from = "#2 depends on a variable that the control keeps, which is not known";
    // Nothing moves by it: it need not be known.
    let saved = "#1=#500\n#2=[#1+1]*2\n#<_kept>=#2\nG0 X10\nM30\n";
    fits("linuxcnc", saved, "");
    refused("linuxcnc", &saved.replace("X10", "X#2"), from);
    fits("linuxcnc", &saved.replace("X10", "X#2"), "--set #500=3");
    refused(
        "linuxcnc",
        &saved.replace("X10", "X#<_kept>"),
        "#<_kept> depends on a variable that the control keeps",
    );
    let fanuc = "#1=#500\n#2=#1\nG0 X9.\nIF[#2 EQ #0]GOTO 5\nG0 X1.\nN5 M30\n";
    refused("fanuc", fanuc, from);
    fits("fanuc", &fanuc.replace("#2=#1", "#2=7"), "");
    // A local variable of a subprogram is another one; a line that runs again finds it
    // known or not each time.
    fits(
        "fanuc",
        "#1=0\n#2=#500\nWHILE[#1 LT 4]DO1\n#1=#1+1\n#3=#2\n#2=#1\nEND1\nG0 X#3\nM30\n",
        "",
    );
    refused(
        "fanuc",
        "#1=0\n#2=1\nWHILE[#1 LT 4]DO1\n#1=#1+1\n#3=#2\n#2=#500\nEND1\nG0 X#3\nM30\n",
        "#3 depends on a variable that the control keeps",
    );
    // What the control acts on at once has to be known.
    for program in ["#1=#500\n#5220=#1\nG0 X1\nM2\n", "#5221=#500\nG0 X1\nM2\n"] {
        refused("linuxcnc", program, "what is assigned here depends on");
    }
    refused(
        "fanuc",
        "#3000=#500\nG0 X1.\nM30\n",
        "what is assigned here depends on",
    );
    // What stands in for it while the line is read has no say.
    refused("linuxcnc", "#1=ACOS[#500*3]\nM2\n", &format!("#500 {HELD}"));
    refused(
        "linuxcnc",
        "#[#500]=1\nG0 X1\nM2\n",
        &format!("#500 {HELD}"),
    );
    refused(
        "linuxcnc",
        "G38.2 Z-20 F50\n#1=#5063\nG1 Z#1\nM2\n",
        "#1 depends on the result of probing",
    );
}

/// "Parameters" of LinuxCNC: offsets and the points of G28 and G30 outlast a program,
/// and so do the last probe's result, that of M66 and the tool in the spindle.
#[test]
fn linuxcnc_parameters_are_unknown_until_the_program_sets_them() {
    let decides =
        |parameter: &str| format!("o1 if [{parameter} GT 7]\nG0 X9\no1 endif\nG0 X1\nM2\n");
    for number in [5161, 5181, 5210, 5211, 5221, 5230, 5241, 5390] {
        refused("linuxcnc", &decides(&format!("#{number}")), HELD);
        let shown = format!("--set #{number}=1");
        fits("linuxcnc", &decides(&format!("#{number}")), &shown);
    }
    fits("linuxcnc", &decides("#5221"), "--parameters kept.var");
    // What G10, G92, G28.1 and assignments have set is known, that of other axes is not.
    for (sets, number) in [
        ("G10 L2 P1 X3", 5221),
        ("G92 X2", 5211),
        ("G92.1", 5213),
        ("G28.1", 5163),
        ("#5242=3", 5242),
    ] {
        fits(
            "linuxcnc",
            &format!("{sets}\n{}", decides(&format!("#{number}"))),
            "",
        );
    }
    for (sets, number) in [("G10 L2 P1 X3", 5222), ("G92 X2", 5212), ("G92.2", 5211)] {
        refused(
            "linuxcnc",
            &format!("{sets}\n{}", decides(&format!("#{number}"))),
            HELD,
        );
    }
    let before = "the result of probing, which is not known";
    refused("linuxcnc", &decides("#5070"), before);
    refused("linuxcnc", &decides("#5061"), before);
    fits("linuxcnc", &decides("#5070"), "--probe both");
    fits("linuxcnc", &decides("#5061"), "--set #5061=2");
    refused("linuxcnc", &decides("#5399"), "an input (M66)");
    for tool in [
        "#5400",
        "#5401",
        "#5410",
        "#<_current_tool>",
        "#<_selected_tool>",
    ] {
        refused("linuxcnc", &decides(tool), "the tool at the start");
    }
    fits("linuxcnc", &decides("#5400"), "--set #5400=3");
    fits("linuxcnc", &decides("#<_current_tool>"), "--set #5400=3");
    fits("linuxcnc", &format!("T3 M6\n{}", decides("#5400")), "");
    refused(
        "linuxcnc",
        "#<_current_tool>=3\nG0 X1\nM2\n",
        "it can only be read",
    );
    refused(
        "fanuc",
        "IF[#4120 EQ 3]GOTO 5\nG0 X9.\nN5 M30\n",
        "the tool at the start",
    );
    fits(
        "fanuc",
        "T3\nIF[#4120 EQ 3]GOTO 5\nG0 X9.\nN5 G0 X1.\nM30\n",
        "",
    );
    fits(
        "fanuc",
        "IF[#4120 EQ 3]GOTO 5\nG0 X9.\nN5 G0 X1.\nM30\n",
        "--set #4120=3",
    );
}

/// Offsets that are given are in force, and G92.3 says that it restores nothing known.
#[test]
fn offsets_that_are_given_count() {
    let shop = Shop::mill("iso", "peak_power_w = 1e6\nregen_power_w = 1e6", "", "");
    shop.put("a.nc", "G53 G0 X0\nG0 X[#5221]\nM2\n");
    let (code, out, shown) = shop.run("moves a.nc --dialect linuxcnc --set #5221=10");
    assert_eq!(code, 0, "{shown}");
    let last = out.lines().last().unwrap();
    assert!(last.contains(r#""end":{"X":20,"#), "{last}");
    let (code, shown) = check("linuxcnc", "G0 X1\nG92.3\nG0 X2\nM2\n", "");
    assert!(code == 0 && shown.contains("note[no-offsets]"), "{shown}");
    let (code, shown) = check("linuxcnc", "G92 X1 Y0 Z0\nG92.3\nG0 X2\nM2\n", "");
    assert!(code == 0 && !shown.contains("no-offsets"), "{shown}");
}

#[test]
fn a_variable_that_a_control_does_not_have_is_not_given() {
    let (code, shown) = check("linuxcnc", "G0 X1\nM2\n", "--set #5420=2");
    assert!(
        code == 2 && shown.contains("has no such variable"),
        "{shown}"
    );
    let (code, shown) = check("fanuc", "G0 X1.\nM30\n", "--set R1=2");
    assert!(
        code == 2 && shown.contains("--set R1=2: `fanuc` has no such variable"),
        "{shown}"
    );
}

#[test]
fn a_loop_that_waits_for_the_control_is_named_at_once() {
    let program = "WHILE[#1000 EQ 0]DO1\nEND1\nG0 X1.\nM30\n";
    refused(
        "fanuc",
        program,
        "#1000 depends on the state of the control",
    );
    refused("fanuc", "N10 IF[#500 EQ 0]GOTO 10\nG0 X1.\nM30\n", HELD);
}

#[test]
fn a_program_that_ends_in_an_alarm_is_not_judged() {
    let alarm = "IF[#1 NE #0]GOTO 10\n#3000=1(NO TOOL)\nN10 G0 X1.\nM30\n";
    refused(
        "fanuc",
        alarm,
        "alarm before anything has moved: whether the program fits is not known",
    );
    let (code, shown) = check("fanuc", &format!("G0 X1.\n{alarm}"), "");
    assert!(
        code == 0 && shown.contains("raises an alarm: the program ends here"),
        "{shown}"
    );
}

/// SINUMERIK and the ISG kernel decide by the alarm's number whether the program goes on.
#[test]
fn an_alarm_of_another_control_is_no_verdict_either() {
    let siemens = "IF R1<>2 GOTOF OK\nSETAL(65000)\nOK: G0 X5\nM30\n";
    let found = "SETAL raises an alarm: whether the program fits is not known";
    refused("siemens", &siemens.replace("R1", "1+1"), found);
    let (code, shown) = check("siemens", &siemens.replace("R1", "1+2"), "");
    assert_eq!(code, 0, "{shown}");
    let found = "#ERROR raises an alarm: whether the program fits is not known";
    refused("isg", "G0 X5\n#ERROR [ID455 RC5]\nM30\n", found);
}

#[test]
fn what_depends_on_a_probe_is_refused() {
    let found = "G38.3 Z-20 F50\no1 if [#5070 EQ 0]\nM2\no1 endif\nG0 X5000 Y5000\nM2\n";
    refused("linuxcnc", found, "#5070 depends on the result of probing");
    refused(
        "linuxcnc",
        "G38.2 Z-20 F50\nG1 Z#5063\nM2\n",
        "#5063 depends on the result",
    );
    // Before the first probe it is that of another program.
    refused(
        "linuxcnc",
        "G0 X#5070\nM2\n",
        "#5070 depends on the result of probing",
    );
    fits("linuxcnc", "G0 X#5070\nM2\n", "--probe miss");
    let moves = |options: &str| check("linuxcnc", found, options).1;
    assert!(moves("--probe hit --format json").contains("robust"));
    let missed = moves("--probe miss --format json");
    // Z alone: 20 mm at 50 mm/min.
    assert!(missed.contains("\"duration_s\": 24.0"), "{missed}");
    // With an error the program stops at a G38.2 that finds nothing.
    let (code, shown) = check("linuxcnc", "G38.2 Z-20 F50\nG0 Z5\nM2\n", "--probe miss");
    assert!(
        code == 0 && shown.contains("stops here with an error"),
        "{shown}"
    );
    // Where it touches is not known either way.
    let (code, shown) = check("linuxcnc", "G38.3 Z-20 F50\nG1 Z#5063\nM2\n", "--probe hit");
    assert!(
        code == 2 && shown.contains("#5063 depends on the result"),
        "{shown}"
    );
    fits(
        "linuxcnc",
        "G38.3 Z-20 F50\nG1 Z#5063\nM2\n",
        "--probe miss",
    );
}
