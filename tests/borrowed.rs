//! Programs of others that come with their results, in `../shared/corpus`; what
//! is not there is skipped, and said to be.

use std::fmt::Write as _;
use std::path::Path;

use gwatt::interpret::Limits;
use gwatt::machine::{AXES, AxisValues};
use gwatt::pipeline::{self, Options, Reading};

use crate::evidence::shared;
use crate::listing::{listing, machine, machine_of};

const PROGRAMS: &str = "the programs of others";

fn text(path: &Path) -> String {
    String::from_utf8_lossy(&std::fs::read(path).expect("a file")).into_owned()
}

/// `FluidNC` tests its O words by a program that counts what went right.
#[test]
fn the_flow_test_of_fluidnc_passes() {
    let path = "parser_tests/bdring__FluidNC/examples/gcode_conditionals_test.nc";
    let Some(path) = shared(&format!("corpus/{path}"), PROGRAMS) else {
        return;
    };
    // Comments do not nest in grbl 1.1.
    let program = text(&path)
        .replace("))\n", ")\n")
        .replace("(print, ALL 59 TESTS PASSED)", "G0 Z59");
    let found = listing(&program, &machine("grbl"), None);
    assert!(found.ends_with(" rapid Z59\n"), "{found}");
}

/// Axes of the table, in gwatt's order.
const NAMES: [&str; AXES] = ["X", "Y", "Z", "A", "B", "C", "U", "V", "W", "E"];

/// Places in the order they are reached, each other than the one before.
fn reached(places: impl Iterator<Item = AxisValues>, start: AxisValues) -> Vec<AxisValues> {
    let mut last = start;
    let mut out = Vec::new();
    for place in places {
        let same = last.iter().zip(&place).all(|(a, b)| (a - b).abs() < 1e-9);
        if !same {
            out.push(place);
        }
        last = place;
    }
    out
}

/// Its table has a row for each block: the values that the block leaves after.
fn rows(table: &Path, start: AxisValues) -> Vec<AxisValues> {
    let mut reader = csv::Reader::from_path(table).expect("a table");
    let head = reader.headers().expect("names").clone();
    let columns = NAMES.map(|name| head.iter().position(|title| title == name));
    let mut place = start;
    let mut places = Vec::new();
    for record in reader.records() {
        let record = record.expect("a row");
        for (value, column) in place.iter_mut().zip(columns) {
            let cell = column.and_then(|column| record.get(column));
            if let Some(found) = cell.and_then(|cell| cell.parse().ok()) {
                *value = found;
            }
        }
        places.push(place);
    }
    reached(places.into_iter(), start)
}

/// Programs of CEAD whose words are not all read: they have to be refused.
const REFUSED: [&str; 4] = [
    "axis_index_assignment.mpf",
    "edge_cases.mpf",
    "function_calls.mpf",
    "spline.mpf",
];

/// Programs in the language of SINUMERIK with the tables of CEAD's interpreter,
/// which works out values and sums up increments, but no arcs.
#[test]
fn programs_of_cead_reach_the_places_of_their_tables() {
    let Some(folder) = shared(
        "corpus/siemens/CEAD-group__nc-gcode-interpreter/examples",
        PROGRAMS,
    ) else {
        return;
    };
    let machine = machine_of("siemens", "", "XYZUVWE", "ABC");
    let mut count = 0;
    let mut wrong = String::new();
    for entry in std::fs::read_dir(&folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let table = path.with_extension("csv");
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        // `simple` tests its parser: G3 without a centre, two words of X.
        if path.extension().is_none_or(|it| it != "mpf") || !table.exists() || name == "simple.mpf"
        {
            continue;
        }
        let mut program = text(&path);
        if name == "custom_vars.mpf" {
            program = "DEF INT bb=9,aa=15\n".to_owned() + &program;
        }
        let mut start = [0.0; AXES];
        if name.contains("increment") {
            // Its initial state comes from the command line.
            start[1] = 900.0;
        }
        let options = Options {
            reading: Reading {
                start: gwatt::interpret::Start::At(start),
                limits: Limits::default(),
                ..Reading::default()
            },
            ..Options::default()
        };
        let mut places = Vec::new();
        let done = pipeline::moves(
            std::io::Cursor::new(program),
            &machine,
            &options,
            &mut |mv, _| {
                places.push(mv.end);
                Ok(())
            },
        );
        if REFUSED.contains(&name.as_str()) {
            assert!(done.is_err(), "{name} is read");
            continue;
        }
        let expected = rows(&table, start);
        let found = reached(places.into_iter(), start);
        let close = |(a, b): (&AxisValues, &AxisValues)| {
            a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 6e-4)
        };
        if done.is_err() || found.len() != expected.len() || !found.iter().zip(&expected).all(close)
        {
            let _ = writeln!(
                wrong,
                "{name}: {} places, {} expected",
                found.len(),
                expected.len()
            );
        }
        count += 1;
    }
    assert!(count >= 8, "{count} programs");
    assert_eq!(wrong, "");
}
