//! Words of the program itself that stand in the way of a change, or next to it.

use insta::assert_snapshot;

use crate::shop::Shop;

fn shop(controller: &str, power_w: f64, rest: &str) -> Shop {
    let converter = format!("peak_power_w = {power_w}");
    let rest = format!("[path]\nrapid = \"linear\"\n{rest}");
    Shop::mill(controller, &converter, &rest, "")
}

fn written(shop: &Shop, program: &str, options: &str) -> String {
    let (code, text, errors) = shop.limit(program, options);
    assert_eq!(code, 0, "{errors}");
    text
}

/// A program with accelerations of its own is limited like others.
#[test]
fn accelerations_of_the_program() {
    let shop = shop("marlin", 600.0, "");
    let program = "G21\nG90\nM204 P1000 T1500\nG0 X100 Y80 F9000\nG1 X50 F1200\n";
    let (code, _, errors) = shop.limit(program, "--allow feed");
    assert_eq!(code, 0, "{errors}");
}

/// The F of the program is in force again before a cycle that counts on it.
#[test]
fn cycles_of_sinumerik_get_their_feed() {
    let program = "G71 G90 G17 G60 G54 F300\nG0 X1000 Y800 Z50\nCYCLE81(50,0,2,-10)\nG0 X0\nM30\n";
    let shop = shop("siemens", 600.0, "");
    assert_snapshot!(written(&shop, program, ""), @r"
    G71 G90 G17 G60 G54 F300
    G1 X1000 Y800 Z50 F26278
    G0 F300
    CYCLE81(50,0,2,-10)
    G0 X0
    M30
    ");
}

/// G80 with a place moves by the word that comes back: it is not made G81.
#[test]
fn a_cancelled_cycle_with_a_place() {
    let program = "G21 G90 G54\nG0 X0 Y0 Z50.\nG98 G81 X10. Y8. Z-10. R2. F200.\n\
                   G80 X1000. Y800.\nM30\n";
    let shop = shop("fanuc", 600.0, "");
    assert_snapshot!(written(&shop, program, ""), @r"
    G21 G90 G54
    G0 X0 Y0 Z50.
    G98 G81 X10. Y8. Z-10. R2. F200.
    G9 G1 G80 X1000. Y800. F26404.
    G0 F200.
    M30
    ");
}

/// A motion word that is worked out stays, and the reason says so.
#[test]
fn motion_words_that_are_worked_out() {
    let shop = shop("fanuc", 600.0, "");
    let program = "G21 G90 G54\n#1=0\nG#1 X1000. Y800.\nM30\n";
    let (code, text, errors) = shop.limit(program, "");
    assert_eq!((code, text.as_str()), (1, ""));
    assert!(
        errors.contains("its motion word is worked out by the program"),
        "{errors}"
    );
}

/// What an F without a point means is a setting of the control: one that stands for a rapid has
/// a point, and one in place of another is written like that.
#[test]
fn feeds_have_a_point_where_it_matters() {
    let shop = shop("haas", 600.0, "");
    for program in [
        "G61\nG0 X1000. Y800.\nM30\n",
        "G61\nG1 X1. F500\nG0 X1000. Y800.\nM30\n",
    ] {
        let text = written(&shop, program, "");
        let rapid = text.lines().find(|line| line.contains("Y800."));
        assert!(rapid.is_some_and(|line| line.ends_with('.')), "{text}");
    }
    let shop = self::shop("haas", 200.0, "");
    let text = written(&shop, "G61\nG1 X1000. Y800. F20000\nM30\n", "--allow feed");
    assert!(!text.contains(".\nM30"), "{text}");
}

/// Where G28 and G30 lead is not guessed.
#[test]
fn reference_points_that_nobody_gave() {
    let program = "G21 G90 G54\nG0 X100 Y80 Z50\nG30\nM2\n";
    for (controller, word, help) in [
        ("linuxcnc", "G28", "--parameters, or G28"),
        ("grbl", "G28", "--parameters, or G28"),
        ("linuxcnc", "G30", "give the control's --parameters, or G30"),
        ("fanuc", "G30 X0 Y0 Z0", "further_reference_mm of the axes"),
    ] {
        let shop = shop(
            controller,
            600.0,
            "[offsets]\nG54 = { X = -450, Y = -330, Z = -300 }",
        );
        let program = program.replace("G30", word);
        let (code, text, errors) = shop.limit(&program, "");
        assert_eq!((code, text.as_str()), (1, ""), "{controller} {program}");
        assert!(errors.contains(help), "{controller} {program}: {errors}");
    }
}

/// Points that the machine file has, as grbl prints them at `$#`: the way there is gone by a
/// feed. Axes that it does not name stay unknown.
#[test]
fn reference_points_of_the_machine_file() {
    let offsets =
        |points: &str| format!("[offsets]\nG54 = {{ X = -450, Y = -330, Z = -300 }}\n{points}");
    let program = "G21 G90 G54\nG0 X100 Y80 Z50\nG28\nM2\n";
    for controller in ["grbl", "linuxcnc"] {
        let points = "G28 = { X = -1, Y = -2, Z = -3 }\nG30 = { Z = -5 }";
        let shop = shop(controller, 600.0, &offsets(points));
        let text = written(&shop, program, "");
        let there = ["X449", "Y328", "Z297"];
        assert!(
            there.iter().all(|place| text.contains(place)),
            "{controller}: {text}"
        );
        written(&shop, "G21 G90 G54\nG0 X100\nG30 Z50\nM2\n", "");
        let (code, _, errors) = shop.limit(&program.replace("G28", "G30"), "");
        assert_eq!(code, 1, "{controller}");
        assert!(
            errors.contains("give the control's --parameters, or G30"),
            "{errors}"
        );
    }
    let refused = |controller: &str, point: &str| {
        let shop = shop(controller, 600.0, &offsets(point));
        shop.put("a.nc", program);
        let (code, _, errors) = shop.run("check a.nc");
        assert_eq!(code, 2);
        errors
    };
    let errors = refused("fanuc", "G28 = { X = 0 }");
    let said = "this control has its reference points in the tables of the axes";
    assert!(errors.contains(said), "{errors}");
    let errors = refused("grbl", "G28 = { C = 0 }");
    assert!(errors.contains("the machine has no axis C"), "{errors}");
}

/// A point that is stored counts, one at machine zero too; axis by axis, and before `reference_mm`.
#[test]
fn reference_points_that_are_stored() {
    let shop = Shop::mill(
        "linuxcnc",
        "peak_power_w = 5000",
        "[path]\nrapid = \"linear\"",
        "reference_mm = 200",
    );
    let end_of_x = |program: &str| -> f64 {
        shop.put("a.nc", program);
        let (code, out, errors) = shop.run("moves a.nc");
        assert_eq!(code, 0, "{errors}");
        let last: serde_json::Value = serde_json::from_str(out.lines().last().unwrap()).unwrap();
        last["end"]["X"].as_f64().unwrap()
    };
    assert_eq!(end_of_x("G21 G90\nG0 X50\nG28\n"), 200.0);
    assert_eq!(
        end_of_x("G21 G90\nG53 G0 X0 Y0 Z0\nG28.1\nG0 X50\nG28\n"),
        0.0
    );
    assert_eq!(end_of_x("G21 G90\n#5161=0\nG0 X50\nG28 X50\n"), 0.0);
    assert_eq!(end_of_x("G21 G90\n#5162=7\nG0 X50\nG28 X50\n"), 200.0);
}

/// What the places of a program rest on is said with the certificate.
#[test]
fn the_certificate_names_where_places_come_from() {
    let shop = shop(
        "fanuc",
        600.0,
        "[offsets]\nG54 = { X = -450, Y = -330, Z = -300 }",
    );
    shop.put("tools.tbl", "T1 P1 Z100\n");
    let program = "G21 G90 G54\nG0 X1000. Y800.\nM30\n";
    shop.put("a.nc", program);
    let (code, _, errors) = shop.run("limit a.nc --tool-table tools.tbl");
    assert_eq!(code, 0, "{errors}");
    assert!(
        errors.contains("work offsets are those under [offsets]"),
        "{errors}"
    );
    assert!(
        errors.contains("tools are those of the tool table"),
        "{errors}"
    );
}
