//! What settings of controls become: values in force, each with its source.

use gwatt_import::{Format, Nothing, Wanted, import};
use insta::assert_snapshot;

use super::{Folder, fields, file, imported, in_force, render};

/// 36000 mm/min in 100 ms: 6000 mm/s²; cutting 12000 mm/min in 32 ms: 6250 mm/s².
#[test]
fn fanuc() {
    let text = "%\nN00000Q1P00000000\nN01006Q1A1P00000000A2P00000000A3P00000000A4P00000001\n\
                N01020Q1A1P88A2P89A3P90A4P66\nN01240Q1A1P-1500A2P0A3P0A4P0\nN01241Q1A1P-2500\nN01242Q1A1P0\nN01401Q1L1P00000010\nN01420Q1A1P36000A2P36000A3P30000A4P9000\n\
                N01422Q1L1P12000\nN01430Q1A1P0A2P0A3P0A4P0\nN01620Q1A1P100A2P100A3P120A4P100\n\
                N01622Q1A1P32A2P64A3P64A4P3000\nN01783Q1A1P500A2P0A3P0A4P0\nN03401Q1L1P00000000\nN03741Q1S1P8000\nN03403Q1L1P00000000\nN03402Q1L1P00000001\n\
                N10000Q0A1P99\n%\n"
        .replace('\n', "\n\r\r");
    let found = imported(&text);
    assert_eq!(found.format, Format::Fanuc);
    assert_snapshot!(render(&found.warnings), @r"
    settings:14, warning: parameter 1783, steps of speed at corners, is not taken over / the robust bound holds for whatever it makes of speeds below the limits of the axes
      | N01783Q1A1P500A2P0A3P0A4P0
      |            ^^^
    ");
    assert_snapshot!(in_force(&found.toml), @r#"
    controller = "fanuc"
    [converter]
    [path]
    rapid = "linear"             # bit LRP of N01401 L1 P00000010 (line 8)
    max_feed_mm_min = 12000      # N01422 L1 P12000 (line 10)
    [language]
    decimal_point = "least-increment" # bit DPI of N03401 L1 P00000000 (line 15)
    power_on_motion = "feed"     # bit G01 of N03402 L1 P00000001 (line 18)
    arc_without_center = "line"  # bit CIR of N03403 L1 P00000000 (line 17)
    [axes.X]
    kind = "linear"
    rapid_mm_min = 36000         # N01420 A1 P36000 (line 9)
    reference_mm = -1.5          # N01240 A1 P-1500 (line 5)
    further_reference_mm = [-2.5, 0] # N01241 A1 P-2500 (line 6) to N01242 A1 P0 (line 7)
    accel_mm_s2 = 6250           # 12000/min in 32 ms: N01622 A1 P32 (line 13), the highest
    [axes.Y]
    kind = "linear"
    rapid_mm_min = 36000         # N01420 A2 P36000 (line 9)
    reference_mm = 0             # N01240 A2 P0 (line 5)
    accel_mm_s2 = 6000           # 36000/min in 100 ms: N01620 A2 P100 (line 12), the highest
    [axes.Z]
    kind = "linear"
    rapid_mm_min = 30000         # N01420 A3 P30000 (line 9)
    reference_mm = 0             # N01240 A3 P0 (line 5)
    accel_mm_s2 = 4166.666667    # 30000/min in 120 ms: N01620 A3 P120 (line 12), the highest
    [axes.B]
    kind = "rotary"
    rapid_deg_min = 12000        # cutting may be faster than rapids: N01422 L1 P12000 (line 10)
    reference_deg = 0            # N01240 A4 P0 (line 5)
    accel_deg_s2 = 2000          # 12000/min in 100 ms: N01620 A4 P100 (line 12), the highest
    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
}

/// Real numbers of the 30i on an inch machine: 1000 inch/min are 25400 mm/min; whole numbers
/// of a 0i count tenths: 10000 are the same.
#[test]
fn fanuc_in_inches() {
    let real = "N01001 P00000001\nN01020 A1 P88 A2 P90\nN01420 A1 P1000.0 A2 P1000.0\nN01660 A1 P100.0 A2 P0.0\nN01620 A1 P0 A2 P200\n";
    assert_snapshot!(fields(real), @r#"
    controller = "fanuc-lathe"
    [converter]
    [axes.X]
    kind = "linear"
    rapid_mm_min = 25400         # N01420 A1 P1000.0 (line 3)
    accel_mm_s2 = 2540           # N01660 A1 P100.0 (line 4)
    [axes.Z]
    kind = "linear"
    rapid_mm_min = 25400         # N01420 A2 P1000.0 (line 3)
    accel_mm_s2 = 2116.666667    # 25400/min in 200 ms: N01620 A2 P200 (line 5)
    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
    let whole =
        fields("N01001P00000001\nN01020A1P88A2P90\nN01420A1P10000A2P10000\nN01620A1P100A2P200\n");
    assert!(whole.contains("rapid_mm_min = 25400 "), "{whole}");
}

/// 4000 tenths of an inch a minute are 10160 mm/min; three axes of that together √3 · 10160.
#[test]
fn largest_feeds_of_fanuc_in_inches() {
    let rest = "N01001P00000001\nN01020A1P88A2P89A3P90\nN01420A1P9448A2P9448A3P7086\nN01620A1P150A2P150A3P150\n";
    let feed = |more: &str| {
        let toml = fields(&format!("{rest}{more}"));
        let mut lines = toml.lines();
        lines
            .find(|line| line.starts_with("max_feed"))
            .map(str::to_owned)
    };
    assert_snapshot!(feed("N01422P4000\n").unwrap_or_default(), @r"max_feed_mm_min = 10160      # N01422 P4000 (line 5)");
    assert_snapshot!(feed("N01422P400.0\n").unwrap_or_default(), @r"max_feed_mm_min = 10160      # N01422 P400.0 (line 5)");
    assert_snapshot!(feed("N01430A1P4000A2P4000A3P4000\n").unwrap_or_default(), @r"max_feed_mm_min = 17597.6362 # all axes of N01430 A1 P4000 (line 5) together");
}

/// All axes belong to path 1, and what the other paths have says nothing of them.
#[test]
fn paths_of_fanuc_without_axes() {
    let axes = "N00981Q1A1P1A2P1A3P0\nN01020Q1A1P88A2P90A3P0\nN01420Q1A1P24000.0A2P24000.0A3P0.0\nN01620Q1A1P200A2P200A3P0\n";
    let paths = "N01401Q1L1P01110010L2P00000000L3P00000000\nN01422Q1L1P8000.0L2P9000.0\nN03401Q1L2P00000001L3P00000000\n";
    assert_snapshot!(fields(&format!("{axes}{paths}")), @r#"
    controller = "fanuc-lathe"
    [converter]
    [path]
    rapid = "linear"             # bit LRP of N01401 L1 P01110010 (line 5)
    max_feed_mm_min = 8000       # N01422 L1 P8000.0 (line 6)
    [language]
    decimal_point = "calculator" # bit DPI of N03401 L2 P00000001 (line 7)
    [axes.X]
    kind = "linear"
    rapid_mm_min = 24000         # N01420 A1 P24000.0 (line 3)
    accel_mm_s2 = 2000           # 24000/min in 200 ms: N01620 A1 P200 (line 4)
    [axes.Z]
    kind = "linear"
    rapid_mm_min = 24000         # N01420 A2 P24000.0 (line 3)
    accel_mm_s2 = 2000           # 24000/min in 200 ms: N01620 A2 P200 (line 4)
    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
    // Two paths that have axes: either rapid may be, and each axis has the feed of its own.
    let two = axes.replace("A2P1", "A2P2");
    assert_snapshot!(fields(&format!("{two}{paths}N01622Q1A1P10A2P10\n")), @r#"
    controller = "fanuc-lathe"
    [converter]
    [path]
    rapid = "independent"        # bit LRP of N01401 L2 P00000000 (line 5)
    max_feed_mm_min = 9000       # N01422 L2 P9000.0 (line 6), the highest
    [language]
    decimal_point = "calculator" # bit DPI of N03401 L2 P00000001 (line 7)
    [axes.X]
    kind = "linear"
    rapid_mm_min = 24000         # N01420 A1 P24000.0 (line 3)
    accel_mm_s2 = 13333.33333    # 8000/min in 10 ms: N01622 A1 P10 (line 8), the highest
    [axes.Z]
    kind = "linear"
    rapid_mm_min = 24000         # N01420 A2 P24000.0 (line 3)
    accel_mm_s2 = 15000          # 9000/min in 10 ms: N01622 A2 P10 (line 8), the highest
    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
}

/// Two lines for the same value, as in files that are put together: the last is in force.
#[test]
fn the_last_line_of_a_value_counts() {
    let fanuc = "N1020 A1P88 A2P90\nN1420 A1P24000 A2P24000\nN1620 A1P200 A2P200\nN1420 A1P30000 A2P30000\n";
    let found = imported(fanuc);
    assert_eq!(render(&found.warnings), "");
    assert!(
        found.toml.contains("rapid_mm_min = 30000"),
        "{}",
        found.toml
    );
    assert!(!found.toml.contains("24000"), "{}", found.toml);
    let siemens = "N10000 $MN_AXCONF_MACHAX_NAME_TAB[0]=\"X1\"\n\
                   N32000 $MA_MAX_AX_VELO[AX1]=36000\nN32000 $MA_MAX_AX_VELO[X1]=50000\nN32000 $MA_MAX_AX_VELO[AX1]=60000\n\
                   N32300 $MA_MAX_AX_ACCEL[0,AX1]=9\nN32300 $MA_MAX_AX_ACCEL[1,AX1]=5\nN32300 $MA_MAX_AX_ACCEL[0, AX1]=4\n";
    let toml = fields(siemens);
    assert!(toml.contains("rapid_mm_min = 60000"), "{toml}");
    assert!(toml.contains("accel_mm_s2 = 5000"), "{toml}");
}

/// 4 m/s², 1.5 times that in rapids.
#[test]
fn a_higher_acceleration_of_sinumerik_in_rapids() {
    let toml = fields(
        "N32000 $MA_MAX_AX_VELO[AX1]=36000\nN32300 $MA_MAX_AX_ACCEL[0,AX1]=4\nN32434 $MA_G00_ACCEL_FACTOR[AX1]=1.5\n",
    );
    assert!(toml.contains("accel_mm_s2 = 6000"), "{toml}");
}

#[test]
fn sinumerik() {
    let text = "CHANDATA(1)\nN10000 $MN_AXCONF_MACHAX_NAME_TAB[0]=\"X1\" '5a7e\nN10000 $MN_AXCONF_MACHAX_NAME_TAB[1]=\"SP1\"\n\
                N10000 $MN_AXCONF_MACHAX_NAME_TAB[2]=\"C1\"\nN10000 $MN_AXCONF_MACHAX_NAME_TAB[3]=\"ATC\"\nN20730 $MC_G0_LINEAR_MODE=0\n\
                N30300 $MA_IS_ROT_AX[AX3]=1\nN35000 $MA_SPIND_ASSIGN_TO_MACHAX[AX2]=1\nN35100 $MA_SPIND_VELO_LIMIT[AX2]=12000\n\
                N32000 $MA_MAX_AX_VELO[AX1]=30000 ; mm/min\nN32000 $MA_MAX_AX_VELO[AX2]=12000\nN32000 $MA_MAX_AX_VELO[AX3]=50\n\
                N32000 $MA_MAX_AX_VELO[ATC]=50\n\
                N32300 $MA_MAX_AX_ACCEL[0,AX1]=4 '1f\nN32300 $MA_MAX_AX_ACCEL[1,AX1]=5\nN32300 $MA_MAX_AX_ACCEL[2,AX1]=3\n\
                N32300 $MA_MAX_AX_ACCEL[3,AX1]=2.5\nN32300 $MA_MAX_AX_ACCEL[4,AX1]=2\nN32300 $MA_MAX_AX_ACCEL[0,AX3]=3\n\
                N32310 $MA_MAX_ACCEL_OVL_FACTOR[0,AX1]=1.2\nN32431 $MA_MAX_AX_JERK[0,AX1]=50\n\
                N34070 $MA_REFP_VELO_POS[AX1]=10000\nN34100 $MA_REFP_SET_POS[0,AX1]=-3\nN30600 $MA_FIX_POINT_POS[0,AX1]=-7\nN42110 $SC_DEFAULT_FEED=2000\nN20150 $MC_GCODE_RESET_VALUES[0]=1\n";
    let found = imported(text);
    assert!(
        found.toml.contains("# jerk_mm_s3 = 50000"),
        "{}",
        found.toml
    );
    assert!(found.toml.contains("# max_rpm = 12000"), "{}", found.toml);
    assert_snapshot!(render(&found.warnings), @r"
    settings:0, warning: axes without a letter of their own are left out: ATC / what moves with other axes (gantries) belongs to the masses of those
    settings:20, warning: MAX_ACCEL_OVL_FACTOR, steps of speed at corners, is not taken over / the robust bound holds for whatever it makes of speeds below the limits of the axes
      | N32310 $MA_MAX_ACCEL_OVL_FACTOR[0,AX1]=1.2
      |                                        ^^^
    ");
    assert_snapshot!(in_force(&found.toml), @r#"
    controller = "siemens"
    [converter]
    [path]
    rapid = "independent"        # N20730 $MC_G0_LINEAR_MODE=0 (line 6)
    [language]
    power_on_motion = "rapid"    # N20150 $MC_GCODE_RESET_VALUES[0]=1 (line 26)
    power_on_feed_mm_min = 2000  # N42110 $SC_DEFAULT_FEED=2000 (line 25)
    [axes.X]
    kind = "linear"
    rapid_mm_min = 30000         # N32000 $MA_MAX_AX_VELO[AX1]=30000 (line 10)
    reference_mm_min = 10000     # N34070 $MA_REFP_VELO_POS[AX1]=10000 (line 22)
    reference_mm = -3            # N34100 $MA_REFP_SET_POS[0,AX1]=-3 (line 23)
    further_reference_mm = [-7]  # N30600 $MA_FIX_POINT_POS[0,AX1]=-7 (line 24)
    accel_mm_s2 = 5000           # N32300 $MA_MAX_AX_ACCEL[1,AX1]=5 (line 15), the highest
    [axes.C]
    kind = "rotary"
    rapid_deg_min = 18000        # N32000 $MA_MAX_AX_VELO[AX3]=50 (line 12)
    accel_deg_s2 = 1080          # N32300 $MA_MAX_AX_ACCEL[0,AX3]=3 (line 19)
    [[levels]]
    acts_on = "all"
    level = [
        { word = "DYNNORM", power_on = true, accel_mm_s2 = { X = 4000 } },
        { word = "DYNPOS", accel_mm_s2 = { X = 5000 } },
        { word = "DYNROUGH", accel_mm_s2 = { X = 3000 } },
        { word = "DYNSEMIFIN", accel_mm_s2 = { X = 2500 } },
        { word = "DYNFINISH", accel_mm_s2 = { X = 2000 } },
    ]
    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
}

/// Inches: 6 inch/s are 9144 mm/min, 20 inch/s² are 508 mm/s².
#[test]
fn linuxcnc() {
    let ini = file(
        "mill.ini",
        "[EMC]\nMACHINE = Mill\n[KINS]\nKINEMATICS = trivkins coordinates=XYYA\n[TRAJ]\nLINEAR_UNITS = inch\n\
         MAX_LINEAR_VELOCITY = 5\nMAX_ANGULAR_VELOCITY = 150\nARC_BLEND_OPTIMIZATION_DEPTH = 80\n[RS274NGC]\nRS274NGC_STARTUP_CODE = G20 G64 P0.001 G90\n\
         [EMCMOT]\nSERVO_PERIOD = 500000 # ns\n[HAL]\nHALFILE = main.hal\nHALFILE = LIB:basic_sim.tcl\n\
         [AXIS_X]\nMAX_VELOCITY = 6\nMAX_ACCELERATION = 20\nMIN_LIMIT = -10\nMAX_LIMIT = 10\n[JOINT_0]\nHOME = 1\nSCALE = 16000\n\
         [AXIS_Y]\nMAX_VELOCITY = 4\nMAX_ACCELERATION = 20\n[AXIS_A]\nMAX_VELOCITY = 60\nMAX_ACCELERATION = 360\n[JOINT_3]\nTYPE = ANGULAR\n",
    );
    let hal = file(
        "main.hal",
        "setp stepgen.1.maxaccel 25\nsetp stepgen.0.position-scale [JOINT_0]SCALE\nsetp hm2_7i96s.0.stepgen.02.maxvel 5\n",
    );
    let found = import(&[ini], Wanted::default(), &Folder(vec![hal])).unwrap();
    assert!(
        found.toml.contains("rotors of all 2 motors together"),
        "{}",
        found.toml
    );
    assert!(
        found.toml.contains("second squared: 25 (main.hal line 1)"),
        "{}",
        found.toml
    );
    assert!(
        found.toml.contains("per second: 5 (main.hal line 3)"),
        "{}",
        found.toml
    );
    assert_snapshot!(in_force(&found.toml), @r#"
    controller = "linuxcnc"
    [converter]
    [path]
    max_feed_mm_min = 9000       # [TRAJ] MAX_ANGULAR_VELOCITY = 150 (line 8), the highest
    [language]
    units = "inch"               # [RS274NGC] RS274NGC_STARTUP_CODE = G20 G64 P0.001 G90 (line 11)
    power_on_tolerance_mm = 0.0254 # [RS274NGC] RS274NGC_STARTUP_CODE = G20 G64 P0.001 G90 (line 11)
    [look_ahead]
    blocks = 80                  # [TRAJ] ARC_BLEND_OPTIMIZATION_DEPTH = 80 (line 9)
    [look_ahead.linuxcnc]
    servo_period_s = 0.0005      # [EMCMOT] SERVO_PERIOD = 500000 (line 13)
    [axes.X]
    kind = "linear"
    rapid_mm_min = 7620          # [TRAJ] MAX_LINEAR_VELOCITY = 5 (line 7), below [AXIS_X] MAX_VELOCITY = 6 (line 18)
    accel_mm_s2 = 508            # [AXIS_X] MAX_ACCELERATION = 20 (line 19)
    [axes.Y]
    kind = "linear"
    rapid_mm_min = 6096          # [AXIS_Y] MAX_VELOCITY = 4 (line 26)
    accel_mm_s2 = 508            # [AXIS_Y] MAX_ACCELERATION = 20 (line 27)
    [axes.A]
    kind = "rotary"
    rapid_deg_min = 3600         # [AXIS_A] MAX_VELOCITY = 60 (line 29)
    accel_deg_s2 = 360           # [AXIS_A] MAX_ACCELERATION = 360 (line 30)
    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
}

/// Before 2.8 axes have numbers.
#[test]
fn linuxcnc_of_old() {
    let text = "[TRAJ]\nCOORDINATES = X Z\nLINEAR_UNITS = mm\nMAX_VELOCITY = 100\nMAX_LINEAR_VELOCITY = 5\n[AXIS_0]\nTYPE = LINEAR\n\
                MAX_VELOCITY = 50\nMAX_ACCELERATION = 500\n[AXIS_2]\nMAX_VELOCITY = 20\nMAX_ACCELERATION = 200\n";
    assert_snapshot!(fields(text), @r#"
    controller = "linuxcnc"
    [converter]
    [path]
    max_feed_mm_min = 6000       # [TRAJ] MAX_VELOCITY = 100 (line 4)
    [axes.X]
    kind = "linear"
    rapid_mm_min = 3000          # [AXIS_0] MAX_VELOCITY = 50 (line 8)
    accel_mm_s2 = 500            # [AXIS_0] MAX_ACCELERATION = 500 (line 9)
    [axes.Z]
    kind = "linear"
    rapid_mm_min = 1200          # [AXIS_2] MAX_VELOCITY = 20 (line 11)
    accel_mm_s2 = 200            # [AXIS_2] MAX_ACCELERATION = 200 (line 12)
    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
}

#[test]
fn the_profile_may_be_another() {
    let wanted = Wanted {
        format: Some(Format::Fanuc),
        controller: Some("haas"),
    };
    let text = "N01420A1P1000A2P1000\nN01620A1P100A2P100\n";
    let found = import(&[file("p.txt", text)], wanted, &Nothing).unwrap();
    assert!(
        found.toml.contains("controller = \"haas\""),
        "{}",
        found.toml
    );
}
