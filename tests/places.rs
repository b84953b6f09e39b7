//! Places that rest on offsets, lengths or reference points that nobody has given: how far it is
//! from one to another is not known, and such a move counts at its full speed.

use crate::shop::Shop;

/// Full speed of one axis: 100 W, and 0.5 m/s · (200 kg · 3 m/s² + 100 N) / 0.8 = 437.5 W.
const FULL_W: f64 = 537.5;
const NONE: [u64; 0] = [];

/// The peaks of the moves by line, W; blocks of no length have none.
fn peaks(shop: &Shop, program: &str, options: &str) -> Vec<(u64, f64)> {
    shop.put("a.nc", program);
    let (code, text, errors) = shop.run(format!("report a.nc --csv - {options}").trim_end());
    assert_eq!(code, 0, "{errors}");
    let row = |row: &str| {
        let cells: Vec<&str> = row.split(',').collect();
        let peak_w: f64 = cells[6].parse().unwrap();
        (peak_w > 100.0).then(|| (cells[0].parse().unwrap(), peak_w))
    };
    text.lines().skip(1).filter_map(row).collect()
}

fn shop(controller: &str, rest: &str, axis: &str) -> Shop {
    Shop::mill(controller, "peak_power_w = 1e6", rest, axis)
}

/// The lines of moves that count at the full speed of one axis though their program says 1 mm.
fn full(shop: &Shop, program: &str, options: &str) -> Vec<u64> {
    let peaks = peaks(shop, program, options).into_iter();
    peaks
        .filter(|(_, peak_w)| (peak_w - FULL_W).abs() < 1e-6)
        .map(|(line, _)| line)
        .collect()
}

/// From one work offset to another, which both are taken as 0.
#[test]
fn from_one_work_offset_to_another() {
    let program = "G21 G90 G54\nG0 X1.\nG0 X2.\nG55\nG0 X3.\nX4.\nG54 X5.\nM30\n";
    let unknown = shop("fanuc", "", "");
    assert_eq!(full(&unknown, program, ""), [5, 7]);
    let known = shop("fanuc", "[offsets]\nG54 = { X = 5 }\nG55 = { X = 5 }", "");
    assert_eq!(full(&known, program, ""), NONE);
    // One is not enough.
    let one = shop("fanuc", "[offsets]\nG54 = { X = 5 }", "");
    assert_eq!(full(&one, program, ""), [5, 7]);
    // The program sets it.
    let sets = program.replace("G55\n", "G55\nG10 L2 P2 X5.\n");
    assert_eq!(full(&one, &sets, ""), NONE);
}

/// To a reference point, and back from there; between returns to the same one nothing moves.
#[test]
fn to_and_from_a_reference_point() {
    let program = "G21 G90 G54\nG0 Z1.\nG91 G28 Z0\nG91 G28 Z0\nG90 G0 Z2.\nG0 Z3.\nM30\n";
    assert_eq!(full(&shop("fanuc", "", ""), program, ""), [3, 5]);
    assert_eq!(
        full(&shop("fanuc", "", "reference_mm = 1"), program, ""),
        [3, 5]
    );
    let offsets = "[offsets]\nG54 = { Z = 5 }";
    assert_eq!(full(&shop("fanuc", offsets, ""), program, ""), [3, 5]);
    assert_eq!(
        full(&shop("fanuc", offsets, "reference_mm = 6"), program, ""),
        NONE
    );
    // Further points have places of their own.
    let second = program.replace("G28", "G30");
    assert_eq!(
        full(&shop("fanuc", offsets, "reference_mm = 6"), &second, ""),
        [3, 5]
    );
    let further = "further_reference_mm = [6, 7]";
    assert_eq!(full(&shop("fanuc", offsets, further), &second, ""), NONE);
    let third = program.replace("G28", "G30 P3");
    assert_eq!(full(&shop("fanuc", offsets, further), &third, ""), NONE);
    let fourth = program.replace("G28", "G30 P4");
    assert_eq!(full(&shop("fanuc", offsets, further), &fourth, ""), [3, 5]);
}

/// Increments go as far as they say; coordinates that are set at a place count from there.
#[test]
fn increments_and_coordinates_that_are_set() {
    let program = "G21 G90 G54\nG0 Z1.\nG91 G28 Z0\nG0 Z-1.\nZ-1.\nG90 Z1.\nM30\n";
    assert_eq!(full(&shop("fanuc", "", ""), program, ""), [3, 6]);
    let sets = "G21 G90 G54\nG0 Z1.\nG91 G28 Z0\nG90 G92 Z5.\nG0 Z4.\nG55 Z3.\nM30\n";
    assert_eq!(full(&shop("fanuc", "", ""), sets, ""), [3, 6]);
}

/// A tool's length that no table gives.
#[test]
fn from_one_tool_length_to_another() {
    let program = "G21 G90 G54\nG0 Z1.\nG43 H1 Z2.\nX1.\nZ1.\nG43 H2 Z2.\nG49 Z3.\nM30\n";
    let shop = shop("fanuc", "[offsets]\nG54 = { Z = 0 }", "");
    assert_eq!(full(&shop, program, ""), [3, 6, 7]);
    shop.put("tools.tbl", "T1 P1 Z1\nT2 P2 Z1\n");
    assert_eq!(full(&shop, program, "--tool-table tools.tbl"), NONE);
}

/// Machine coordinates, on other controls too.
#[test]
fn machine_coordinates() {
    let program = "G21 G90 G54\nG0 Z1.\nG53 G0 Z2.\nG53 G0 Z3.\nG0 Z1.\nM30\n";
    for controller in ["fanuc", "linuxcnc", "grbl"] {
        let stops = "[path]\nmode = \"exact-stop\"\n";
        let peaks = full(&shop(controller, stops, ""), program, "");
        assert_eq!(peaks, [3, 5], "{controller}");
        let offsets = format!("{stops}[offsets]\nG54 = {{ Z = 1 }}");
        assert_eq!(full(&shop(controller, &offsets, ""), program, ""), NONE);
    }
    let program =
        "G71 G90 G60 G54\nG0 Z1\nSUPA G0 Z2\nSUPA G0 Z3\nG0 Z1\nG75 Z1=0\nG75 FP=2 Z1=0\nM30\n";
    let unknown = shop("siemens", "", "");
    assert_eq!(full(&unknown, program, ""), [3, 5, 6, 7]);
    // Its work offsets are not followed; from one fixed point to another all is known.
    let known = shop("siemens", "", "further_reference_mm = [2, 3]");
    assert_eq!(full(&known, program, ""), [3, 5, 6]);
}

/// Printers move by differences: their homing says where they are.
#[test]
fn printers_know_where_they_are() {
    let program = "G21\nG90\nG28\nG0 X1 F30000\nG92 X5\nG0 X6\nM104 S0\n";
    let homed = shop("marlin", "", "reference_mm = 0");
    // Homing itself comes from anywhere.
    assert_eq!(full(&homed, program, ""), [3]);
}
