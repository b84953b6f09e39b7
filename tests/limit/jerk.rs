//! Words for the jerk, and for the largest speed of an axis: SINUMERIK's JERKLIM and VELOLIM,
//! `TwinCAT` NC I's `#set paramAxisDynamics`.

use super::{EXACT_STOP, RIG, Rig, options};
use gwatt::pipeline::{Allowed, LimitOptions, LimitSummary, Strategy};

use crate::runs::{self, FEEDS};

/// 500 kg at 0.5 m/s, 5 m/s² and 50 m/s³: 680 W where the acceleration falls, of 612.5 W.
const SINUMERIK: Rig = Rig {
    controller: "siemens",
    axis: "jerk_mm_s3 = 50000",
    rest: EXACT_STOP,
    peak_w: 612.5,
    ..RIG
};

fn limited(rig: &Rig, strategy: Strategy, program: &str) -> (String, LimitSummary) {
    let how = LimitOptions {
        strategy,
        allowed: Allowed {
            unverified: true,
            ..FEEDS
        },
        ..LimitOptions::USUAL
    };
    let done = runs::limited(&rig.machine(), &options(RIG.options), how, program);
    done.expect("a program")
}

fn fits(rig: &Rig, strategy: Strategy, program: &str) -> String {
    let (text, summary) = limited(rig, strategy, program);
    assert!(summary.certified, "{program}{:?}", summary.reasons);
    text
}

/// The power goes with the root of the jerk: 612.5 W at 40.5 m/s³, in 1.0222 s, where it would
/// be 1.0275 s at the acceleration that fits, 2.98 m/s².
#[test]
fn a_lower_jerk_takes_less_time() {
    assert_eq!(
        fits(&SINUMERIK, Strategy::Optimal, "G0 X400\nG0 X401\nM30\n"),
        "JERKLIM[X]=81 JERKLIM[Y]=81\nG0 X400\nJERKLIM[X]=100 JERKLIM[Y]=100\nG0 X401\nM30\n"
    );
    // What the program has set comes back.
    assert_eq!(
        fits(
            &SINUMERIK,
            Strategy::Optimal,
            "JERKLIM[X]=90\nG0 X400\nG0 X401\nM30\n"
        ),
        "JERKLIM[X]=90\nJERKLIM[X]=81 JERKLIM[Y]=81\nG0 X400\nJERKLIM[X]=90 JERKLIM[Y]=100\n\
         G0 X401\nM30\n"
    );
}

/// Without limits of jerk there is nothing to lower, and next to moves that run into each other
/// it does not matter.
#[test]
fn where_it_does_nothing_it_is_not_written() {
    let rigid = Rig {
        axis: "",
        ..SINUMERIK
    };
    let blended = Rig {
        rest: "",
        ..SINUMERIK
    };
    for (rig, program) in [
        (rigid, "G0 X400\nM30\n"),
        (blended, "G64\nG1 X400 F30000\nG1 Y400\nM30\n"),
    ] {
        let text = fits(&rig, Strategy::Optimal, program);
        assert!(!text.contains("JERKLIM"), "{text}");
    }
}

/// 500 mm/s by the revolution, 1250 W of 1000 W: 80 % of the speed of X.
#[test]
fn the_speed_of_axes_is_lowered_where_f_cannot_be() {
    let rig = Rig {
        axis: "",
        peak_w: 1000.0,
        ..SINUMERIK
    };
    assert_eq!(
        fits(
            &rig,
            Strategy::Speed,
            "M3 S3000\nG95 G1 X400 F10\nG94 G1 X401 F100\nM30\n"
        ),
        "M3 S3000\nVELOLIM[X]=80 VELOLIM[Y]=100\nG95 G1 X400 F10\n\
         VELOLIM[X]=100 VELOLIM[Y]=100\nG94 G1 X401 F100\nM30\n"
    );
    // An arc turns through all directions: no share of an axis stands for its speed.
    let rig = Rig {
        peak_w: 600.0,
        ..rig
    };
    let (_, summary) = limited(
        &rig,
        Strategy::Speed,
        "M3 S3000\nG95 G2 X0 Y400 J200 F10\nM30\n",
    );
    assert!(!summary.certified);
}

/// All three values in one command, and back to those of the machine file.
#[test]
fn nci_sets_the_jerk_of_each_axis() {
    let rig = Rig {
        controller: "twincat-nci",
        ..SINUMERIK
    };
    let set = |jerk: u32| {
        [0, 1].map(|axis| format!("#set paramAxisDynamics( {axis}; 5000; 5000; {jerk} )#\n"))
    };
    assert_eq!(
        fits(&rig, Strategy::Optimal, "G0 X400\nM30\n"),
        format!(
            "{}G0 X400\n{}M30\n",
            set(40_500).concat(),
            set(50_000).concat()
        )
    );
    // Where the program has set accelerations itself, DynOvr or an F does it.
    let program = "#set paramPathDynamics( 4900; 4900; 50000 )#\nG0 X400\nM30\n";
    let text = fits(&rig, Strategy::Optimal, program);
    assert!(!text.contains("paramAxisDynamics"), "{text}");
}

/// Words that lift each other do not stand together.
#[test]
fn words_take_turns() {
    let program = |slow: &str, full: &str| {
        format!(
            "G0 X400\n{slow}\nG0 X0 Y400\nG0 X400 Y0\n{full}\nG0 X0\nG0 Y30\nG0 X300 Y400\n\
             G0 X0 Y1\nM30\n"
        )
    };
    let programs = [
        ("twincat-nci", program("DynOvr=0.8", "DynOvr=1")),
        (
            "siemens",
            program("ACC[X]=80 JERKLIM[Y]=60", "ACC[X]=100 JERKLIM[Y]=100"),
        ),
    ];
    for (controller, program) in &programs {
        for peak_w in [150.0, 300.0, 450.0, 600.0, 750.0] {
            let rig = Rig {
                controller,
                peak_w,
                ..SINUMERIK
            };
            fits(&rig, Strategy::Optimal, program);
        }
    }
}
