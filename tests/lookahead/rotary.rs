//! `LinuxCNC` with further axes next to X, Y and Z, against recordings of 2.9.0~pre1.
//!
//! At a joint with such an axis two elements overlap, the first with half of its
//! acceleration; the next one keeps all of its own unless its other end takes half.

use gwatt::machine::Machine;
use gwatt::pipeline::{Certificate, Row};

use crate::machines::machine_from;
use crate::runs::rows_of;

/// An axis: its largest speed by the minute, acceleration, mass or inertia, friction
/// and weight.
type Limits = (&'static str, [f64; 5]);

const XYZA: [Limits; 4] = [
    ("X", [9000.0, 2000.0, 250.0, 200.0, 0.0]),
    ("Y", [9000.0, 2000.0, 280.0, 220.0, 0.0]),
    ("Z", [6000.0, 1500.0, 220.0, 250.0, 100.0]),
    ("A", [6000.0, 1000.0, 3.0, 10.0, 0.0]),
];
/// Unequal in everything.
const LIGHT_X: [Limits; 4] = [
    ("X", [3000.0, 300.0, 50.0, 100.0, 0.0]),
    ("Y", [4800.0, 3000.0, 250.0, 100.0, 0.0]),
    ("Z", [12000.0, 500.0, 50.0, 200.0, -200.0]),
    ("A", [4800.0, 1500.0, 8.0, 30.0, 0.0]),
];
const XYZAC: [Limits; 5] = [
    ("X", [4800.0, 2000.0, 50.0, 100.0, 0.0]),
    ("Y", [3000.0, 1500.0, 400.0, 100.0, 0.0]),
    ("Z", [18000.0, 1500.0, 120.0, 20.0, 100.0]),
    ("A", [3000.0, 1500.0, 8.0, 30.0, 0.0]),
    ("C", [3000.0, 3000.0, 8.0, 10.0, 0.0]),
];
const XYZUV: [Limits; 5] = [
    ("X", [4800.0, 2000.0, 120.0, 100.0, 0.0]),
    ("Y", [12000.0, 1500.0, 50.0, 200.0, 0.0]),
    ("Z", [3000.0, 1500.0, 250.0, 200.0, 0.0]),
    ("U", [4800.0, 3000.0, 400.0, 200.0, 0.0]),
    ("V", [12000.0, 1500.0, 400.0, 200.0, 0.0]),
];

fn machine(axes: &[Limits]) -> Machine {
    let mut text = "schema = 1\nname = \"test\"\ncontroller = \"linuxcnc\"\n\
         [converter]\npeak_power_w = 1e6\nbase_load_w = 10\n[limits]\nmargin = 0.0\n"
        .to_owned();
    for (letter, [speed, accel, mass, friction, weight]) in axes {
        let rotary = ["A", "B", "C"].contains(letter);
        let table = if rotary {
            format!(
                "[axes.{letter}]\nkind = \"rotary\"\nrapid_deg_min = {speed:?}\n\
                 accel_deg_s2 = {accel:?}\ninertia_kg_m2 = {mass:?}\n\
                 friction_nm = {friction:?}\nefficiency = 0.8\n"
            )
        } else {
            format!(
                "[axes.{letter}]\nkind = \"linear\"\nrapid_mm_min = {speed:?}\n\
                 accel_mm_s2 = {accel:?}\nmass_kg = {mass:?}\ncoulomb_n = {friction:?}\n\
                 gravity_n = {weight:?}\nefficiency = 0.8\n"
            )
        };
        text += &table;
    }
    machine_from(&text)
}

fn rows(axes: &[Limits], program: &str) -> Vec<Row> {
    rows_of(&machine(axes), program)
}

#[test]
fn further_axes_run_as_recorded() {
    let recorded: [(&[Limits], &str, f64, f64); 7] = [
        (
            &XYZA,
            "G64 P0.05\nG0 X50 A90\nG0 X100 Y80 A0\nG0 X0 Y0 A45\nG1 Z-5 F1000\n",
            3.207,
            317.2,
        ),
        (
            &XYZA,
            "G64 P0.05\nG1 X10 A20 F9000\nG1 X110 Y80 F9000\nG1 X110 Y160\nG0 Z5\n",
            2.025,
            182.8,
        ),
        // The table alone counts as a motion along X.
        (&XYZA, "G64 P0.05\nG0 A90\nG0 X100 Y80\n", 1.883, 159.0),
        // The arc keeps all of its acceleration, which bends where it begins to pull.
        (
            &LIGHT_X,
            "G64 P0.1 Q0.2\nG1 A27 F15000\nG3 X-3.78998 Y10.30911 I4.41056 J7.47269\n\
             G0 Y-9.884\nG1 X12.609 F15000\nG1 X20.266 Y-20.799 Z-20.547\n",
            2.927,
            239.3,
        ),
        // Arcs that bulge less than Q are two lines with half of the turn each.
        (
            &LIGHT_X,
            "G64 P1\nG1 A1.35 F1500\nG3 X-0.31104 Y-0.48226 I0.13379 J-0.42773 A-0.561\n\
             G3 X-0.30499 Y0.79044 I-0.30531 J0.63782 Z-1.429 A-0.309\nG1 A2.7 X-0.515\n\
             G1 A1.35 X1.467 F15000\nG0 A-2.7\nG2 X0.03464 Y1.25893 I-0.59043 J0.61871 A-1.038\n\
             G0 A-2.7\nG3 X-0.7096 Y1.33092 I-0.38627 J-0.11023 A-2.435\n",
            0.986,
            398.5,
        ),
        (
            &XYZAC,
            "G64 P0.05\nG3 X-0.8965 Y-0.26227 I-0.43461 J-0.17777 A-2.7 F15000\n\
             G1 X-1.566 Y-1.109\nG1 A0 C-1.046 X1.626 Z-1.156\n\
             G1 A0.227 C0.204 Y-1.04 Z1.368\nG1 C0.599 X-1.842 Y-2.133 Z-1.498\n\
             G1 X-1.97 Y0.912 Z-0.706 F15000\nG0 X1.709\n",
            0.721,
            165.7,
        ),
        (
            &XYZUV,
            "G61\nG1 X0.172 Y-1.224 F9000\nG0 U2.107 V0.915 Y1.111\nG1 U-0.127\n\
             G1 U1.651 V0.833 X1.614 Z2.172\nG2 X1.79287 Y1.63099 I0.70293 J0.04896\n\
             G2 X1.57183 Y1.55279 I-0.12495 J0.00169 F6000\n",
            0.371,
            136.6,
        ),
    ];
    for (axes, program, recorded_s, recorded_w) in recorded {
        let text = format!("G21 G90 G17 G94\n{program}M2\n");
        let rows = rows(axes, &text);
        let all = rows
            .iter()
            .all(|row| row.certificate == Certificate::Planned);
        assert!(all, "{program}");
        let planned_s: f64 = rows.iter().map(|row| row.duration_s).sum();
        let planned_w = rows.iter().fold(0.0, |most: f64, row| most.max(row.peak_w));
        // It begins and ends with what is less than a cycle, and smooths each step of
        // acceleration over two or three.
        let off_s = planned_s - recorded_s;
        assert!(
            off_s.abs() <= 3.1e-3,
            "{program}{planned_s} s, not {recorded_s}"
        );
        let high = planned_w / recorded_w;
        assert!(
            (1.0..1.1).contains(&high),
            "{program}{planned_w} W, not {recorded_w}"
        );
    }
}
