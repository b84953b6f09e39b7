//! `machine new`.

use super::Shop;

const X: &str = "X:rapid_mm_min=30000,accel_mm_s2=3000,table_kg=60,workpiece_kg=100,\
                 rotor_kg_m2=0.00012,screw=20x800x10,guide_friction=0.01,efficiency=0.85";
const Z: &str = "Z:rapid_mm_min=12000,accel_mm_s2=2000,table_kg=40,rotor_kg_m2=0.0001,\
                 gear_ratio=2,pinion=40x20,counterweight_kg=30,coulomb_n=50,efficiency=0.8";
pub(super) const MILL: [&str; 8] = [
    "machine", "new", "--kind", "mill", "--supply", "2000", "--axis", X,
];

#[test]
fn what_is_known_becomes_a_machine_file() {
    let shop = Shop::new();
    let ran = shop.run(&[&MILL[..], &["--axis", Z, "--name", "The \"old\" mill"]].concat());
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    insta::assert_snapshot!(ran.stdout, @r#"
    # The "old" mill, made by `gwatt machine new`
    #
    # What the axes come to:
    #
    #   X  30000 mm/min  3000 mm/s2  246 kg   755 N  444 W alone
    #   Z  12000 mm/min  2000 mm/s2  71.1 kg  290 N  72.6 W alone
    #   X: 246.3 kg = 160 moved mass + 47.37 rotor (0.00012 kg m2) + 38.94 screw (0.00009865 kg m2)
    #   Z: 71.1 kg = 70 moved mass + 1 rotor (0.0001 kg m2) + 0.09865 pinion (0.00003946 kg m2)
    #
    # Not given:
    # * no controller given: programs are read as iso (`gwatt machine list` has all)
    # * nothing given of what the supply takes back: what braking axes feed back is not checked
    # * no spindle given: its power does not count
    # * no base load given: counted as 0 W
    schema = 1
    name = "The \"old\" mill"
    controller = "iso"

    [converter]
    peak_power_w = 2000          # what it delivers at most

    [axes.X]
    kind = "linear"
    rapid_mm_min = 30000
    accel_mm_s2 = 3000
    moved_mass_kg = 160          # table 60 + workpiece 100
    rotor_kg_m2 = 0.00012
    screw = { diameter_mm = 20, length_mm = 800, lead_mm = 10 }
    coulomb_n = 15.6906          # 0.01 x 160 kg x 9.80665 m/s2
    efficiency = 0.85

    [axes.Z]
    kind = "linear"
    rapid_mm_min = 12000
    accel_mm_s2 = 2000
    moved_mass_kg = 70           # table 40 + counterweight 30
    rotor_kg_m2 = 0.0001
    gear_ratio = 2
    pinion = { diameter_mm = 40, width_mm = 20 }
    coulomb_n = 50
    gravity_n = 98.0665          # (40 kg - 30 kg) x 9.80665 m/s2
    efficiency = 0.8

    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
    insta::assert_snapshot!(ran.stderr, @r"
    gwatt: note: no controller given: programs are read as iso (`gwatt machine list` has all)
    gwatt: note: nothing given of what the supply takes back: what braking axes feed back is not checked
    gwatt: note: no spindle given: its power does not count
    gwatt: note: no base load given: counted as 0 W
    ");
    shop.put("mill.toml", &ran.stdout);
    let checked = shop.run(&["machine", "check", "mill.toml"]);
    assert_eq!((checked.code, checked.stderr.as_str()), (0, ""));
    // The sum stands in the file and is that of `machine check`. By hand, X: the rotor turns
    // 2π/0.01 a metre, 0.00012·(628.3)² = 47.37 kg; the screw weighs 1.973 kg, of inertia
    // 9.865e-5 kg·m², and counts as 38.94 kg.
    let sum = "  X: 246.3 kg = 160 moved mass + 47.37 rotor (0.00012 kg m2) + 38.94 screw (0.00009865 kg m2)\n";
    assert!(checked.stdout.contains(sum), "{}", checked.stdout);
    assert!(ran.stdout.contains(&format!("# {sum}")), "{}", ran.stdout);
    // 0.5 m/s·(246.3 kg·3 m/s² + 0.01·160 kg·9.80665 m/s²)/0.85 = 443.9 W
    assert!(
        checked.stdout.contains("  443.9 W alone") || checked.stdout.contains("  444 W alone"),
        "{}",
        checked.stdout
    );
}

#[test]
fn with_a_file_the_sum_is_shown() {
    let shop = Shop::new();
    let arguments = [
        &MILL[..],
        &[
            "-o",
            "mill.toml",
            "--feeds-back",
            "500",
            "--base-load",
            "100",
        ],
    ];
    let ran = shop.run(&arguments.concat());
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(
        ran.stdout
            .starts_with("mill.toml: My mill\n  X  30000 mm/min"),
        "{}",
        ran.stdout
    );
    let note = "gwatt: note: no controller given: programs are read as iso (`gwatt machine list` has \
                all)\ngwatt: note: no spindle given: its power does not count\n";
    assert_eq!(ran.stderr, note);
    let text = shop.get("mill.toml");
    assert!(
        text.contains("\nregen_power_w = 500          # what it takes back\n"),
        "{text}"
    );
    assert!(
        text.contains("\nbase_load_w = 100            # what always runs\n"),
        "{text}"
    );
    // Every kind has a profile that reads programs.
    for kind in ["mill", "lathe", "router", "printer"] {
        let axis = X.replace(",workpiece_kg=100", "");
        let ran = shop.run(&[
            "machine", "new", "--kind", kind, "--supply", "2000", "--axis", &axis, "-o", "new.toml",
        ]);
        assert_eq!(ran.code, 0, "{}", ran.stderr);
        assert_eq!(shop.run(&["machine", "check", "new.toml"]).code, 0);
    }
}

#[test]
fn what_is_missing_is_said_once() {
    let shop = Shop::new();
    let x = "X:rapid_mm_min=9000,accel_mm_s2=500,table_kg=5,belt=20x2x9";
    let z = "Z:rapid_mm_min=900,accel_mm_s2=100,table_kg=2,screw=8x300x8";
    let ran = shop.run(&[
        "machine", "new", "--kind", "router", "--supply", "100", "--axis", x, "--axis", z,
    ]);
    assert_eq!(ran.code, 0);
    insta::assert_snapshot!(ran.stderr, @r"
    gwatt: note: no controller given: programs are read as grbl (`gwatt machine list` has all)
    gwatt: note: nothing given of what the supply takes back: what braking axes feed back is not checked
    gwatt: note: no spindle given: its power does not count
    gwatt: note: no base load given: counted as 0 W
    gwatt: note: XZ: no rotor inertia given: counted as 0 kg m2, which is right for linear motors alone
    gwatt: note: XZ: no friction given: counted as none; it often takes 2 to 10 % of the largest force, and `gwatt identify` finds it
    gwatt: note: XZ: no efficiency given: counted as 1; the drive's losses come on top
    gwatt: note: Z: no counterweight given: the whole weight counts
    ");
}

#[test]
fn every_message() {
    let shop = Shop::new();
    let refused = |arguments: &[&str], message: &str| {
        shop.run(&[&["machine", "new"], arguments].concat())
            .refused(message);
    };
    refused(
        &["--axis", X],
        "what kind of machine? --kind mill, lathe, router or printer",
    );
    let supply = "what does the supply of the drives deliver at most? --supply W";
    refused(&["--kind", "mill", "--axis", X], supply);
    let on = ["--kind", "mill", "--supply", "900"];
    let with = |more: &[&str], message: &str| refused(&[&on[..], more].concat(), message);
    with(&[], "a machine needs an axis: --axis X:rapid_mm_min=…");
    with(
        &["--axis", X, "--axis", X],
        "axis X is described twice: keep one of the two",
    );
    with(
        &["--axis", X, "-c", "fanok"],
        "no controller profile is named `fanok`; there are iso, ",
    );
    with(&["--axis", X, "--name", " "], "the machine's name is empty");
    with(
        &["--axis", X, "--feeds-back=-1"],
        "what it takes back must be 0 or more, in W",
    );
    with(
        &["--axis", X, "--base-load=-1"],
        "the base load must be 0 or more, in W",
    );
    refused(
        &["--kind", "mill", "--supply", "0", "--axis", X],
        "the supply must be above 0, in W",
    );
    with(
        &["--axis", X, "-o", "."],
        "cannot write .: it is a folder; name a file in it",
    );
}

#[test]
fn every_message_about_an_axis() {
    let shop = Shop::new();
    let on = [
        "machine", "new", "--kind", "mill", "--supply", "900", "--axis",
    ];
    let axis = |text: &str, message: &str| {
        shop.run(&[&on[..], &[text]].concat()).refused(message);
    };
    axis(
        "A:rapid_mm_min=1",
        "axis `A`: `rapid_mm_min` is not known; there are rapid_deg_min, ",
    );
    axis(
        "E:rapid_mm_min=1",
        "axis `E`: the letter of an axis of a mill is one of XYZUVWABC",
    );
    axis(
        "XY",
        "axis `XY`: the letter of an axis of a mill is one of XYZUVWABC",
    );
    axis(
        "X:rapid_mm_min",
        "axis `X`: `rapid_mm_min` has no value: write rapid_mm_min=…",
    );
    axis(
        "X:mass=3",
        "axis `X`: `mass` is not known; there are rapid_mm_min, ",
    );
    axis(
        "X:table_kg=3,table_kg=4",
        "`table_kg` is given twice: keep one of the two",
    );
    axis("X:table_kg=heavy", "`table_kg=heavy`: this is no number");
    axis(
        "X:table_kg=0",
        "`table_kg=0`: the mass of what slides, in kg: table, slide, head is above 0 to",
    );
    axis(
        "X:efficiency=85",
        "`efficiency=85`: the mechanical by electrical power, above 0 to 1 is above 0 to 1",
    );
    axis(
        "X:coulomb_n=inf",
        "`coulomb_n=inf`: the friction in N is from 0 to 1000000000",
    );
    axis(
        "X:screw=20x800",
        "`screw=20x800`: write screw=DIAMETERxLENGTHxLEAD in mm, each above 0",
    );
    axis(
        "X:pinion=0x20",
        "`pinion=0x20`: write pinion=DIAMETERxWIDTH in mm, each above 0",
    );
    axis(
        "X:belt=20",
        "`belt=20`: write belt=TEETHxPITCHxWIDTH, the last two in mm, each above 0",
    );
    axis("X:drive=rope", "`drive=rope`: there is drive=linear-motor");
    axis(
        "X:screw=20x800x10,belt=20x2x9",
        "it has two drives: keep one",
    );
    axis(
        "X:table_kg=3",
        "it needs what drives it: screw=DIAMETERxLENGTHxLEAD, pinion=",
    );
    axis("X:drive=linear-motor", "axis `X`: it needs `rapid_mm_min`");
    let whole = "rapid_mm_min=9000,accel_mm_s2=500,table_kg=5";
    let direct = |more: &str| format!("X:{whole},drive=linear-motor,{more}");
    axis(
        &direct("gear_ratio=2"),
        "a linear motor has no gear: leave `gear_ratio` out",
    );
    axis(
        &direct("rotor_kg_m2=2"),
        "a linear motor has no rotor: add its mass to `table_kg`",
    );
    axis(
        &direct("coulomb_n=2,guide_friction=0.1"),
        "both say its friction: keep one",
    );
    axis(
        &direct("counterweight_kg=2"),
        "a counterweight balances vertical axes alone",
    );
    let z = format!("Z:{whole},drive=linear-motor,guide_friction=0.1");
    axis(
        &z,
        "its guides carry no weight, as it is vertical: give `coulomb_n`",
    );
}

/// The axes of a machine with that motor.
fn with_motor(shop: &Shop, motor: &[&str], axis: &str) -> super::Ran {
    let mill = ["machine", "new", "--kind", "mill", "--supply", "2000"];
    shop.run(&[&mill[..], motor, &["--axis", axis]].concat())
}

const SCREW: &str = "rapid_mm_min=30000,table_kg=60,screw=20x800x10,coulomb_n=0";

/// Lead 10 mm: k² = (2π/0.01)² = 394784. Table 60 kg, rotor 4.86e-5·k² = 19.19 kg, screw
/// 38.94 kg: 118.1 kg. At 3 m/s² 354.4 N, times 0.01 m/2π are 0.564 N·m; at 30 m/s² 5.64 N·m.
#[test]
fn a_motor_of_the_catalogue_gives_its_rotor() {
    let shop = Shop::new();
    let ran = with_motor(
        &shop,
        &["--motor", "SGM7J-04A"],
        &format!("X:accel_mm_s2=3000,{SCREW}"),
    );
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    for part in [
        "# Motor sgm7j-04a (Yaskawa): 1.27 N m, for a moment 4.46 N m, up to 6000 rpm. From: Sigma-7",
        "rotor_kg_m2 = 0.0000486      # of the motor; coupling and brake come on top\n",
        "118.1 kg = 60 moved mass + 19.19 rotor (0.0000486 kg m2) + 38.94 screw",
    ] {
        assert!(ran.stdout.contains(part), "{part}: {}", ran.stdout);
    }
    assert!(!ran.stdout.contains("torque_curve"), "{}", ran.stdout);
    assert!(!ran.stderr.contains("rotor inertia"), "{}", ran.stderr);
    // What is given of the rotor counts.
    let own = format!("X:accel_mm_s2=3000,{SCREW},motor=sgm7j-04a,rotor_kg_m2=0.0001");
    let ran = with_motor(&shop, &[], &own);
    assert!(
        ran.stdout.contains("rotor_kg_m2 = 0.0001\n"),
        "{}",
        ran.stdout
    );
}

#[test]
fn the_torque_of_a_motor_limits_what_is_asked_of_it() {
    let shop = Shop::new();
    let ran = with_motor(
        &shop,
        &["--motor", "sgm7j-04a"],
        &format!("X:accel_mm_s2=30000,{SCREW}"),
    );
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let note = "X: 30000 mm/s2 takes 5.640 N m of the motor sgm7j-04a, which has 4.46 at most: the \
                file has its torque, which limits the acceleration";
    assert!(ran.stderr.contains(note), "{}", ran.stderr);
    let curve =
        "torque_curve = [{ rpm = 0, torque_nm = 4.46 }, { rpm = 6000, torque_nm = 4.46 }]\n";
    assert!(ran.stdout.contains(curve), "{}", ran.stdout);
    // A weight of 60 kg and 500 N of friction: 1088 N are 1.73 N·m.
    let z = format!("Z:accel_mm_s2=300,{SCREW}").replace("coulomb_n=0", "coulomb_n=500");
    let ran = with_motor(&shop, &["--motor", "hg-kn43"], &z);
    let note =
        "Z: friction and weight take 1.732 N m of the motor hg-kn43, which bears 1.3 for ever";
    assert!(ran.stderr.contains(note), "{}", ran.stderr);
}

#[test]
fn motors_that_do_not_go_with_an_axis() {
    let shop = Shop::new();
    let refused = |motor: &[&str], axis: &str, message: &str| {
        let ran = with_motor(&shop, motor, axis);
        assert_eq!(ran.code, 2, "{}", ran.stdout);
        assert!(ran.stderr.contains(message), "{}", ran.stderr);
    };
    let fast = format!("X:accel_mm_s2=3000,{SCREW}").replace("30000", "70000");
    refused(
        &["--motor", "sgm7j-04a"],
        &fast,
        "axis `X`: its rapid turns the motor at 7000 rpm, and sgm7j-04a has 6000 at most: at most \
         rapid_mm_min=60000",
    );
    let x = format!("X:accel_mm_s2=3000,{SCREW}");
    let unknown = "`motor=nema23`: there is no such motor in `gwatt machine motors`; give \
                   rotor_kg_m2 from its data sheet";
    refused(&["--motor", "nema23"], &x, unknown);
    refused(
        &[],
        &format!("{x},motor=as1060,motor=as1060"),
        "`motor` is given twice: keep one of the two",
    );
    refused(
        &[],
        "X:rapid_mm_min=9000,accel_mm_s2=500,table_kg=5,drive=linear-motor,motor=as1060",
        "`motor` is one that turns, but the axis has a linear motor",
    );
}

#[test]
fn motors_are_listed_with_their_documents() {
    let shop = Shop::new();
    let ran = shop.run(&["machine", "motors"]);
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    for part in [
        "Yaskawa Sigma II, SGMSH: servo motors of machine tools, 200 V\n",
        "  sgmsh-20aa          0.000319      6.36      19.1      3000      5000\n",
        "  as1060                0.0003         5         -         -         -\n",
        "  from: AS1000, Documented motors\n        https://infosys.beckhoff.com/",
    ] {
        assert!(ran.stdout.contains(part), "{part}: {}", ran.stdout);
    }
}
