//! `machine new` for machines with axes that turn, extruders, spindles and loads.

use super::Shop;
use super::drafts::MILL;

/// A mill with an axis that turns, a spindle and a pump; by hand, A: 2π/60·20 1/min = 2.094 rad/s,
/// the rotor counts 90² · 0.0002 = 1.62 kg m2.
#[test]
fn a_whole_mill_becomes_a_machine_file() {
    let shop = Shop::new();
    let a = "A:rapid_deg_min=7200,accel_deg_s2=1000,table_kg_m2=0.1,workpiece_kg_m2=0.2,\
             rotor_kg_m2=0.0002,gear_ratio=90,friction_nm=1,efficiency=0.8";
    let spindle = "max_rpm=8000,inertia_kg_m2=0.02,accel_time_s=2.5,base_rpm=1500";
    let whole = [
        &MILL[..],
        &[
            "--axis",
            a,
            "--spindle",
            spindle,
            "--load",
            "m8/m9=750",
            "-c",
            "fanuc",
            "--base-load",
            "100",
        ],
    ];
    let ran = shop.run(&whole.concat());
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let (_, parts) = ran.stdout.split_once("[axes.A]").unwrap();
    insta::assert_snapshot!(parts, @r#"
    kind = "rotary"
    rapid_deg_min = 7200
    accel_deg_s2 = 1000
    moved_inertia_kg_m2 = 0.3    # table 0.1 + workpiece 0.2
    rotor_kg_m2 = 0.0002
    gear_ratio = 90
    friction_nm = 1
    efficiency = 0.8

    [spindle]
    max_rpm = 8000
    inertia_kg_m2 = 0.02
    accel_time_s = 2.5
    base_rpm = 1500

    [[load]]
    on = "M8"
    off = "M9"
    power_w = 750

    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
    assert!(
        ran.stdout
            .contains("A: 1.92 kg m2 = 0.3 table + 1.62 rotor"),
        "{}",
        ran.stdout
    );
    shop.put("mill.toml", &ran.stdout);
    assert_eq!(shop.run(&["machine", "check", "mill.toml"]).code, 0);
    shop.put("p.nc", "G90 G21\nS8000 M3\nM8\nG0 X10. A90.\nM9\nM5\nM30\n");
    assert_eq!(
        shop.run(&["check", "p.nc", "-m", "mill.toml", "-q"]).code,
        1
    );
}

/// A printer with an extruder and heaters reads a print.
#[test]
fn a_whole_printer_becomes_a_machine_file() {
    let shop = Shop::new();
    let x = "X:rapid_mm_min=18000,accel_mm_s2=3000,table_kg=0.5,belt=20x2x6,rotor_kg_m2=0.0000054";
    let e =
        "E:rapid_mm_min=3000,accel_mm_s2=800,filament=33.683,rotor_kg_m2=0.0000054,coulomb_n=20";
    let printer = [
        "machine",
        "new",
        "--kind",
        "printer",
        "--supply",
        "350",
        "-c",
        "klipper",
        "--axis",
        x,
        "--axis",
        e,
        "--load",
        "M104=40",
        "--load",
        "M190=220",
        "--load",
        "M106/M107=5",
    ];
    let ran = shop.run(&printer);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let (_, parts) = ran.stdout.split_once("[axes.E]").unwrap();
    insta::assert_snapshot!(parts, @r#"
kind = "linear"
rapid_mm_min = 3000
accel_mm_s2 = 800
moved_mass_kg = 0.001        # the filament, which weighs next to nothing
rotor_kg_m2 = 0.0000054
lead_mm = 33.683             # filament per revolution of its wheels
coulomb_n = 20

[[load]]
on = ["M104", "M109"]
power_w = 40

[[load]]
on = ["M140", "M190"]
power_w = 220

[[load]]
on = "M106"
off = "M107"
power_w = 5

[limits]
margin = 0.1                 # share of the peak power that is kept free
"#);
    shop.put("p.toml", &ran.stdout);
    assert_eq!(shop.run(&["machine", "check", "p.toml"]).code, 0);
    shop.put(
        "p.gcode",
        "M104 S200\nM140 S60\nG90\nM83\nG1 X10 E1 F3000\nM104 S0\n",
    );
    let checked = shop.run(&["check", "p.gcode", "-m", "p.toml"]);
    assert_eq!(checked.code, 0, "{}", checked.stdout);
    let refused = |more: &[&str]| {
        let ran = shop.run(&[&printer[..], more].concat());
        assert_eq!(ran.code, 2);
        ran.stderr
    };
    insta::assert_snapshot!(refused(&["--load", "M8"]), @"gwatt: load `M8`: write it as M104=40 for a nozzle, M140=220 for a bed");
    insta::assert_snapshot!(refused(&["--axis", "A:rapid_deg_min=1"]), @"gwatt: axis `A`: the letter of an axis of a printer is one of XYZUVWE");
    insta::assert_snapshot!(refused(&["--axis", "Y:filament=3,rapid_mm_min=1"]), @"gwatt: axis `Y`: `filament` is no drive of this axis: leave it out");
    insta::assert_snapshot!(refused(&["--axis", "E:rapid_mm_min=1,accel_mm_s2=1,belt=20x2x6"]), @"gwatt: axis `E`: `belt` is no drive of this axis: leave it out");
    insta::assert_snapshot!(refused(&["--spindle", "rpm=8000"]), @"gwatt: spindle: `rpm` is not known; there are max_rpm, inertia_kg_m2, accel_time_s, base_rpm, friction_nm, peak_power_w, efficiency, base_load_w");
    insta::assert_snapshot!(refused(&["--spindle", "max_rpm=8000"]), @"gwatt: spindle: it needs `inertia_kg_m2`");
    insta::assert_snapshot!(refused(&["--spindle", "max_rpm=8000,max_rpm=1"]), @"gwatt: spindle: `max_rpm` is given twice: keep one of the two");
    insta::assert_snapshot!(refused(&["--spindle", "max_rpm=-1"]), @"gwatt: spindle: `max_rpm=-1`: write max_rpm= and a number above 0");
    let mill = shop.run(&[&MILL[..], &["--load", "M8=750"]].concat());
    insta::assert_snapshot!(mill.stderr, @"gwatt: load `M8=750`: write it as M8/M9=750: the words that switch it on and off, and its power in W");
}
