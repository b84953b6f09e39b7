//! Words that may be written, and are not always of use: without them it is tried too.

use std::fmt::Write as _;

use crate::shop::Shop;

/// A return next to rapids on SINUMERIK: with ACC no acceleration is found for it, without it
/// the way there is gone by feeds.
#[test]
fn words_that_are_permitted_do_not_keep_a_program_from_fitting() {
    let shop = Shop::straight("siemens", 1200.0);
    let mut machine = String::from(
        "schema = 1\nname = \"t\"\ncontroller = \"siemens\"\n[path]\nrapid = \"linear\"\n\
         [converter]\npeak_power_w = 1200\n[limits]\nmargin = 0.0\n\
         [offsets]\nG54 = { X = -400, Y = -300, Z = -350 }\n",
    );
    for (letter, mass_kg, coulomb_n) in [("X", 600, 500), ("Y", 700, 500), ("Z", 500, 700)] {
        let _ = write!(
            machine,
            "[axes.{letter}]\nrapid_mm_min = 30000\naccel_mm_s2 = 4000\nmass_kg = {mass_kg}\n\
             coulomb_n = {coulomb_n}\nreference_mm = 0\n"
        );
    }
    shop.put("mill.toml", &machine);
    shop.put(
        "a.mpf",
        "G90 G54 G64\nG0 X100 Y80 Z50\nG74 X1=0 Y1=0\nM30\n",
    );
    let (code, out, errors) = shop.run("limit a.mpf -o plain.mpf");
    assert_eq!(code, 0, "{out}{errors}");
    let (code, out, errors) =
        shop.run("limit a.mpf -o out.mpf --allow unverified --report rows.csv");
    assert_eq!(code, 0, "{out}{errors}");
    assert!(
        errors.contains("fits without the words that it permits"),
        "{out}{errors}"
    );
    assert_eq!(shop.get("out.mpf"), shop.get("plain.mpf"));
    // Each line that moves once: rows of the tries before are gone.
    let rows = shop.get("rows.csv");
    assert_eq!(rows.lines().filter(|row| row.starts_with("2,")).count(), 1);
    // A strategy that is nothing without the words says what does not fit, as before.
    shop.put("a.mpf", "G0 X400 Y300\nG0 X0\nM30\n");
    let how = "limit a.mpf -o no.mpf --strategy accel --allow unverified";
    let (code, _, errors) = shop.run(how);
    assert!(
        !errors.contains("has no word for acceleration"),
        "{code} {errors}"
    );
}

/// The adaptive feed of LinuxCNC, once it is wired, does not keep a program from fitting.
#[test]
fn an_output_that_may_be_used_need_not_be() {
    let limited = |outputs: &str| {
        let mut machine = format!(
            "schema = 1\nname = \"t\"\ncontroller = \"linuxcnc\"\n[path]\nrapid = \"linear\"\n\
             [converter]\npeak_power_w = 1200\n[limits]\nmargin = 0.0\n{outputs}"
        );
        for (letter, mass_kg, coulomb_n) in [("X", 600, 500), ("Y", 700, 500), ("Z", 500, 700)] {
            let _ = write!(
                machine,
                "[axes.{letter}]\nrapid_mm_min = 30000\naccel_mm_s2 = 4000\nmass_kg = {mass_kg}\n\
                 coulomb_n = {coulomb_n}\n"
            );
        }
        let shop = Shop::straight("linuxcnc", 1200.0);
        shop.put("mill.toml", &machine);
        shop.put(
            "a.ngc",
            "G21 G90 G64 P0.01\nG0 X100 Y80 Z50\nG1 X150 F2000\nX200 Y90\nG0 X0 Y0\n\
             G1 X100 F10000\nX0 Y100 F25000\nG0 Z100\nG0 X400 Y400\nX0 Y0 Z0\nM2\n",
        );
        let (code, out, errors) = shop.run("limit a.ngc -o out.ngc");
        assert_eq!(code, 0, "{out}{errors}");
        shop.get("out.ngc")
    };
    let outputs = "[outputs]\nspeed = 1\nchange_s = 0.01\n";
    assert_eq!(limited(outputs), limited(""));
}
