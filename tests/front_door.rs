//! `gwatt::check`, `report`, `limit` and `Moves` from the outside.

use std::io::{self, Cursor, Write};

use gwatt::pipeline::{Allowed, LimitOptions, Options};
use gwatt::{Error, Limit, Machine, Moves, check, limit, report};

const TOO_MUCH: &str = "G21 G90\nG0 X400 Y300 Z-200\nG1 X0 F1200\nM30\n";
const FEED: &str = "G21 G90\nG1 X400 Y300 Z-200 F30000\nM30\n";

fn machine() -> Machine {
    Machine::load("three-axis").unwrap().0
}

fn with_feed() -> Limit {
    Limit {
        how: LimitOptions {
            allowed: Allowed {
                feed: true,
                ..Allowed::NOTHING
            },
            ..Limit::default().how
        },
        ..Limit::default()
    }
}

#[test]
fn checks_name_what_limit_writes() {
    let machine = machine();
    let figures = check(TOO_MUCH, &machine).unwrap();
    assert_eq!((figures.unfit_count, figures.unfit[0].line), (1, 2));
    let written = limit(TOO_MUCH, &machine).unwrap();
    let text = String::from_utf8(written.text().to_vec()).unwrap();
    let word = figures.unfit[0].help.strip_prefix("fits with G1 ").unwrap();
    assert!(text.contains(word), "{word}: {text}");
    assert!(check(written.text(), &machine).unwrap().fits());
}

#[test]
fn reports_have_a_row_for_each_move() {
    let report = report(TOO_MUCH, &machine()).unwrap();
    let lines: Vec<u64> = report.rows.iter().map(|row| row.line).collect();
    assert_eq!(lines, [2, 3]);
    let energy_j: f64 = report.rows.iter().map(|row| row.energy_j).sum();
    assert!((energy_j - report.summary.energy_j.unwrap()).abs() < 1e-9 * energy_j);
}

#[test]
fn errors_say_where_and_what() {
    let machine = machine();
    let error = check("G1 X10\nG2 X20 I1 J1\nG99999\n", &machine).unwrap_err();
    assert!(matches!(error, Error::Refused { .. }));
    assert!(
        error
            .to_string()
            .starts_with("the program is refused\nline "),
        "{error}"
    );
    let error = limit(FEED, &machine).unwrap_err();
    let text = error.to_string();
    assert!(
        text.starts_with("the program cannot be made to fit\nline 2: "),
        "{text}"
    );
    let error: Error = Machine::from_toml("m.toml", "schema = 1\n")
        .unwrap_err()
        .into();
    assert!(
        error.to_string().starts_with("the machine file is wrong\n"),
        "{error}"
    );
    assert!(!error.diagnostics().is_empty());
}

/// Loops let `limit` begin again, which the stream does not show.
#[test]
fn streams_are_written_whole_or_not_at_all() {
    let machine = machine();
    let looped = "G21 G90\nG1 Z1 F500\n#1=0\nWHILE [#1 LT 3] DO1\nG0 X400. Y300. Z-200.\n\
                  G0 X0 Y0 Z0\n#1=#1+1\nEND1\nM30\n";
    for program in [TOO_MUCH, FEED, looped] {
        let mut output = Vec::new();
        let input = Cursor::new(program);
        let summary = with_feed().stream(input, &machine, &mut output).unwrap();
        let held = with_feed().run(program, &machine).unwrap();
        assert_eq!(output, held.text(), "{program}");
        assert_eq!(summary, held.summary, "{program}");
    }
    let mut output = Vec::new();
    let input = Cursor::new(FEED);
    let error = Limit::default().stream(input, &machine, &mut output);
    assert!(matches!(error, Err(Error::DoesNotFit(_))));
    assert_eq!(output, b"");
}

struct Full;

impl Write for Full {
    fn write(&mut self, _: &[u8]) -> io::Result<usize> {
        Err(io::ErrorKind::StorageFull.into())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_full_disk_is_an_error() {
    let found = with_feed().stream(Cursor::new(FEED), &machine(), Full);
    let error = found.unwrap_err();
    assert_eq!(error.to_string(), "cannot write the result");
    assert!(std::error::Error::source(&error).is_some());
}

#[test]
fn moves_end_with_the_error() {
    let machine = machine();
    let options = Options::default();
    let program = "G21 G90\nG0 X10\nG4 P1\nG1 X20 F600\nG99999\nG1 X30\n";
    let mut moves = Moves::of(program, &machine, &options);
    let lines: Vec<u64> = moves
        .by_ref()
        .map_while(Result::ok)
        .map(|mv| mv.line)
        .collect();
    assert_eq!(lines[..3], [2, 3, 4]);
    assert!(moves.next().is_none());
    let failed = Moves::of(program, &machine, &options).any(|mv| mv.is_err());
    assert!(failed);
    let looped = "#1=0\nWHILE [#1 LT 3] DO1\nG0 X10\nG0 X0\n#1=#1+1\nEND1\nM30\n";
    assert_eq!(Moves::of(looped, &machine, &options).count(), 6);
}

/// Results are data: rows under the names of the columns, figures as the commands print them.
#[test]
fn results_are_data() {
    let machine = machine();
    let report = serde_json::to_value(report(TOO_MUCH, &machine).unwrap()).unwrap();
    let columns: Vec<&str> = gwatt::report::COLUMNS.to_vec();
    let block = report["blocks"][0].as_object().unwrap();
    assert!(
        columns.iter().all(|column| block.contains_key(*column)),
        "{block:?}"
    );
    let summary = &report["summary"];
    assert_eq!(
        (
            &summary["peak_line"],
            &summary["program_lines"],
            &summary["moves"]
        ),
        (&2.into(), &4.into(), &2.into())
    );
    assert_eq!(summary["unfit"][0]["line"], 2);
    assert_eq!(summary["fits"], false);
    let limited = serde_json::to_value(limit(TOO_MUCH, &machine).unwrap().summary).unwrap();
    assert_eq!(limited["before"]["peak_w"], summary["peak_w"]);
    assert_eq!(limited["after"]["fits"], true);
    assert_eq!(
        (&limited["certified"], &limited["edited_lines"]),
        (&true.into(), &1.into())
    );
}
