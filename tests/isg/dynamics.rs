//! Speed, acceleration and jerk: what words of the kernel make of them.

use insta::assert_snapshot;

use super::{moves, refused};
use crate::listing::machine;
use crate::machines::{linear_axes, machine_from};
use crate::runs::rows_of;
use crate::shop::Shop;

/// "Acceleration weighting (G130/G131/G230/G231)", "Weighting of rapid traverse
/// velocity (G129)", "Ramp time weighting (G132/G133/G134/G233)", "#VECTOR LIMIT",
/// "#LAH", "Feed rate profiling (G08/G09/G900/G901)": they move nothing, and lower
/// limits or smooth within them.
#[test]
fn dynamics_move_nothing() {
    assert_snapshot!(moves("\
%MAIN
G1 F600 X1
G130 X70 Y60
G131=50
G230 X40
G231=30
G129=20
G132 X200 Y=150
G133=200
G134 = 100
G233=50
X2
#VECTOR LIMIT ON [ACC=1000 VEL=500]
#LAH ON
#SLOPE [TYPE=STEP]
G08 X3
G09 X4
G900 X5
G901 X6
#VECTOR LIMIT OFF
M30
"), @r"
2 feed X1 F600
12 feed X2 F600
16 feed X3 F600
17 feed X4 F600
18 feed X5 F600
19 feed X6 F600
");
}

/// "Machining time or feedrate (G93/G94/G95/G194)": F is the time of a block, and modal; `limit`
/// leaves it.
#[test]
fn g93_is_the_time_of_a_block() {
    let rows = rows_of(
        &machine("isg"),
        "G71 G90 G93\nG1 X200 F20\nX0\nX100 F5\nM30\n",
    );
    let times: Vec<f64> = rows.iter().map(|row| row.duration_s.round()).collect();
    assert_eq!(times, [20.0, 20.0, 5.0]);
    let shop = Shop::straight("isg", 150.0);
    shop.put("a.nc", "G71 G90 G60 G93\nG1 X200 F0.5\nM30\n");
    let (code, _, errors) = shop.run("limit a.nc --allow feed --strategy speed -o out.nc");
    assert_eq!(code, 1, "{errors}");
    assert!(
        errors.contains("its feed is the time of a block (G93)"),
        "{errors}"
    );
}

/// "Influence on the look-ahead functionality (G115/G116/G117)", "Feedforward control
/// (G135/G136/G137)": axes have weights there, not places.
#[test]
fn weights_of_axes_are_no_places() {
    assert_snapshot!(moves("G1 X500 F1000\nG136 X80 Y95 Z0\nG116 X0\nG0 X0\n"), @r"
    1 feed X500 F1000
    4 rapid X0
    ");
    assert_snapshot!(refused("G1 G136 X80 F100\n"), @r"
    1 unsupported-word: axes next to a G word that weights look-ahead or feedforward control, and to another one: whose they are is not known
    ");
}

/// "#SLOPE": step-shaped acceleration has no limit of jerk; 500 kg, 5 m/s², 0.5 m/s make 1250 W
/// then.
#[test]
fn steps_of_acceleration_have_no_limit_of_jerk() {
    let machine = machine_from(&format!(
        "schema = 1\nname = \"test\"\ncontroller = \"isg\"\n[path]\nmode = \"exact-stop\"\n[converter]\n\
         peak_power_w = 9000\n{}",
        linear_axes("XYZ", [30000.0, 5000.0, 500.0], "jerk_mm_s3 = 50000")
    ));
    let program = "G0 X100\n#SLOPE [TYPE=STEP]\nX0\n#SLOPE [TYPE=TRAPEZ]\nX100\n\
                   #SET SLOPE PROFIL[0]\nX0\nM30\n";
    let rows = rows_of(&machine, program);
    let full: Vec<bool> = rows.iter().map(|row| row.peak_w > 1249.9).collect();
    assert_eq!(full, [false, true, false, true]);
}
