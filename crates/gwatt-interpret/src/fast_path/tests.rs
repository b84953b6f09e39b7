//! The short way comes to the same as the long one.

use std::fmt::Write;

use proptest::prelude::*;

use super::*;
use crate::{Diagnostics, Effects, Interpreter, Reading, Start};
use gwatt_syntax::scan_line;

/// Controllers, with words that bring each into states of its own.
const STATES: [(&str, &[&str]); 6] = [
    (
        "iso",
        &[
            "G68 X1 Y2 R30",
            "G69",
            "G51 P2",
            "G50",
            "G16",
            "G15",
            "G53 G0 Z0",
            "#1=5",
            "G0 X#1",
            "G81 Z-1 R1 F100",
            "M98 P77",
            "G65 P77",
            "G41 D1",
            "G40",
            "G1 X3 F50,R1",
        ],
    ),
    (
        "linuxcnc",
        &[
            "#<a>=3",
            "G1 X[#<a>*2] F[100+#<a>]",
            "G7",
            "G8",
            "G41 D1",
            "G40",
            "G33 Z-2 K1",
            "G5 X1 Y1 I0 J1 P0 Q-1",
            "@3 ^40",
            "G81 Z-1 R1",
            "M70",
            "M72",
            "(abort, no)",
            "M19 R3",
            "G10 L2 P1 R20",
            "G88 Z-1 R1 P1",
        ],
    ),
    ("grbl", &["$J=G91 X1", "G38.2 Z-1", "G43.1 Z2", "G28.1"]),
    ("isg", &["G130 X50", "G131 Z=20", "G129=70", "G20 G21"]),
    (
        "marlin",
        &[
            "M82",
            "M83",
            "M220 S50",
            "M221 S90",
            "M203 X1 Y1",
            "G28",
            "M204 S500",
            "G10",
            "G11",
            "M104 S200",
            "N3 G1 X1*95",
            "M205 X5",
        ],
    ),
    (
        "klipper",
        &["SET_VELOCITY_LIMIT ACCEL=500", "G28 X", "M220 S150", "M83"],
    ),
];
/// Words that change the state of every controller.
const COMMON: &[&str] = &[
    "G20",
    "G21",
    "G90",
    "G91",
    "G93",
    "G94",
    "G95",
    "G92 X1 Y2",
    "G92.1",
    "G54",
    "G55",
    "G61",
    "G64",
    "G2 X1 Y1 R2",
    "G3 X3 I1",
    "G0",
    "F0",
    "F-1",
    "F 2 00",
    "S100 M3",
    "M5",
    "M8",
    "M9",
    "G4 P0.1",
    "G17",
    "G18",
    "/G1 X3",
    "%",
    "G80",
    "X9999999999",
    "N5 G1 X2 Y2 Z2",
    "X1 X2",
    "G1 G0 X1",
    "Q1 X1",
    "G28 X0",
    "A10",
    "B5 F30",
    "E2",
    "M2",
    "G1 X1 (note)",
    "G1 F300 ; a",
    "G1 Y-.5",
    "G00 X+1.",
    "G01 z2",
    "G1",
    "F100",
    "X1 F0",
];

fn lines() -> impl Strategy<Value = (usize, Vec<String>, bool)> {
    let plain = (
        0..3_usize,
        prop::collection::vec((0..8_usize, -20..20_i32), 1..4),
        0..5_usize,
    )
        .prop_map(|(motion, words, feed)| {
            let mut text = ["", "G0 ", "G1 "][motion].to_owned();
            for (axis, value) in words {
                let letter = ['X', 'Y', 'Z', 'X', 'Y', 'Z', 'A', 'E'][axis];
                let value = f64::from(value) / 4.0;
                write!(text, "{letter}{value} ").unwrap();
            }
            if feed == 0 {
                text += "F250";
            }
            text
        });
    (0..STATES.len(), any::<bool>()).prop_flat_map(move |(controller, unknown)| {
        let own = prop::sample::select(STATES[controller].1);
        let line = prop_oneof![
            6 => plain.clone(),
            2 => prop::sample::select(COMMON).prop_map(str::to_owned),
            1 => own.prop_map(str::to_owned),
        ];
        (
            Just(controller),
            prop::collection::vec(line, 1..30),
            Just(unknown),
        )
    })
}

fn all_axes(controller: &str) -> Machine {
    let axis = "rapid_mm_min = 6000\naccel_mm_s2 = 500\nmass_kg = 5\n";
    let text = format!(
        "schema = 1\nname = \"all\"\ncontroller = \"{controller}\"\n[converter]\npeak_power_w = 500\n\
         [axes.X]\n{axis}[axes.Y]\n{axis}[axes.Z]\n{axis}[axes.E]\n{axis}\
         [axes.A]\nkind = \"rotary\"\nrapid_deg_min = 3600\naccel_deg_s2 = 90\ninertia_kg_m2 = 1\n"
    );
    Machine::from_toml("all.toml", &text).unwrap().0
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    #[test]
    fn both_ways_come_to_the_same((controller, lines, unknown) in lines()) {
        let machine = all_axes(STATES[controller].0);
        let mut reading = Reading::default();
        if unknown {
            reading.start = Start::Unknown;
        }
        let mut ways = [true, false].map(|direct| {
            let mut interpreter = Interpreter::new(&machine, &reading);
            interpreter.control.direct &= direct;
            (interpreter, Diagnostics::default(), Facts::default())
        });
        for (number, line) in (1..).zip(&lines) {
            let [short, long] = ways.each_mut().map(|(interpreter, diagnostics, facts)| {
                let (mut block, mut steps) = (Block::default(), Vec::new());
                scan_line(line.as_bytes(), number == 1, &mut block);
                interpreter.execute(number, line.as_bytes(), &mut block, Effects::new(&mut steps, facts, diagnostics));
                let control = &interpreter.control;
                let state = format!(
                    "{:?} {:?} {:?} {:?} {}",
                    control.modal, control.position, control.special, control.knobs, control.begun
                );
                facts.plain = false;
                (steps, *facts, state, format!("{:?}", diagnostics.list))
            });
            prop_assert_eq!(short, long, "{}: {:?}", line, lines);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    #[test]
    fn plain_blocks_may_be_followed((controller, lines, unknown) in lines()) {
        let machine = all_axes(STATES[controller].0);
        let mut reading = Reading::default();
        if unknown {
            reading.start = Start::Unknown;
        }
        let [mut one, mut other] = [(); 2].map(|()| Interpreter::new(&machine, &reading));
        let mut diagnostics = [(); 2].map(|()| Diagnostics::default());
        let (mut fast_path_state, mut stale) = (one.fast_path_state(), false);
        for (number, line) in (1..).zip(&lines) {
            let mut facts = [Facts::default(); 2];
            let mut steps = [(); 2].map(|()| Vec::new());
            let mut run = |interpreter: &mut Interpreter<'_>, which: usize| {
                let mut block = Block::default();
                scan_line(line.as_bytes(), number == 1, &mut block);
                interpreter.execute(number, line.as_bytes(), &mut block, Effects::new(&mut steps[which], &mut facts[which], &mut diagnostics[which]));
                facts[which].plain
            };
            if run(&mut one, 0) {
                let Some(Step::Move(mv)) = steps[0].first() else { unreachable!() };
                fast_path_state.move_to(&mv.end);
                stale = true;
                prop_assert_eq!(steps[0].len(), 1);
            } else {
                if std::mem::take(&mut stale) {
                    other.follow(&fast_path_state);
                }
                run(&mut other, 1);
                fast_path_state = one.fast_path_state();
                prop_assert_eq!(&steps[0], &steps[1], "{}: {:?}", line, lines);
                prop_assert!(other.stands_as(&fast_path_state));
            }
            prop_assert_eq!(&fast_path_state, &one.fast_path_state());
        }
        let [one, other] = diagnostics;
        prop_assert_eq!(format!("{:?}", one.list), format!("{:?}", other.list));
    }
}

#[test]
fn a_block_that_works_values_out_is_not_plain() {
    let machine = all_axes("linuxcnc");
    let mut interpreter = Interpreter::new(&machine, &Reading::default());
    let plain = |line: &str| {
        let (mut block, mut facts) = (Block::default(), Facts::default());
        scan_line(line.as_bytes(), false, &mut block);
        let (mut steps, mut diagnostics) = (Vec::new(), Diagnostics::default());
        interpreter.execute(
            1,
            line.as_bytes(),
            &mut block,
            Effects::new(&mut steps, &mut facts, &mut diagnostics),
        );
        assert_eq!(steps.len(), 1, "{line}");
        facts.plain
    };
    let lines = [
        "G1 X1 Y0.5 F60",
        "X2",
        "X3 #1=5",
        "X#1",
        "Y1 F60",
        "Y2 F61",
        "G0 Y3",
    ];
    assert_eq!(
        lines.map(plain),
        [false, true, false, false, true, false, false]
    );
}

#[test]
fn most_controllers_take_the_short_way() {
    let short = |machine: &Machine| {
        Interpreter::new(machine, &Reading::default())
            .control
            .direct
    };
    for name in ["vmc", "router-48v", "printer"] {
        let (machine, _) = Machine::load(name).unwrap();
        assert!(short(&machine), "{name}");
    }
}
