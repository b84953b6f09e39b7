//! A program that is executed in one thread and judged in another comes to the
//! same, to the last digit, as in one thread.

use std::fmt::Write as _;
use std::fs;
use std::io::{self, Cursor, Read, Seek, SeekFrom};

use gwatt::machine::Machine;
use gwatt::pipeline::{Failure, Options, Row, RowSink, Summary, analyze};
use proptest::prelude::*;

use crate::rows::Rows;

/// Planned block by block, ahead, ahead with blends, with limits over time, robust.
const MACHINES: [&str; 5] = [
    "three-axis",
    "router-48v",
    "linuxcnc-mill",
    "vmc",
    "five-axis",
];

type Outcome = (Result<Summary, String>, Vec<Row>);

/// What a program comes to, with rows or without.
fn run(machine: &Machine, program: impl Read + Seek + Send, options: &Options) -> Outcome {
    let mut rows = Rows::default();
    let summary = analyze(program, machine, options, Some(&mut rows));
    (summary.map_err(|failure| format!("{failure:?}")), rows.0)
}

/// The same in one thread and in two; what it comes to.
fn alike(machine: &Machine, program: &str, options: &Options) -> Outcome {
    let two = Options {
        threads: 2,
        ..options.clone()
    };
    let one = run(machine, Cursor::new(program), options);
    assert_eq!(run(machine, Cursor::new(program), &two), one);
    let figures = |options| {
        let summary = analyze(Cursor::new(program), machine, options, None);
        summary.map_err(|failure| format!("{failure:?}"))
    };
    assert_eq!(figures(&two), figures(options));
    one
}

fn embedded(name: &str) -> Machine {
    Machine::load(name).expect("an embedded machine").0
}

/// A line of a program; what it says of the path depends on `x` and `y`.
fn line(kind: u8, x: i32, y: i32) -> String {
    match kind {
        0 => format!("G0 X{x} Y{y}"),
        1 => format!("G2 X{x} Y{y} R500"),
        2 => format!("F{}", 1 + x.abs() * 40),
        3 => "G4 P0.01".to_owned(),
        4 => "(nothing)".to_owned(),
        5 => format!("M3 S{}", 100 + y.abs() * 10),
        6 => "G61".to_owned(),
        7 => "G64".to_owned(),
        8 => "M8".to_owned(),
        _ => format!("G1 X{x} Y{y}"),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn two_threads_come_to_the_same(
        lines in prop::collection::vec((0..40_u8, -90..90, -90..90), 1..1200),
        machine in 0..MACHINES.len(),
    ) {
        let mut program = "G21 G90 G17 G94 F3000\nG0 X0 Y0 Z0\n".to_owned();
        for (kind, x, y) in lines {
            let _ = writeln!(program, "{}", line(kind, x, y));
        }
        program += "M30\n";
        let _same = alike(&embedded(MACHINES[machine]), &program, &Options::default());
    }
}

/// More moves in a line than a batch has room for, texts of earlier lines, names of
/// files, and the state of a block in the advice.
#[test]
fn lines_go_over_with_all_that_belongs_to_them() {
    let folder = tempfile::tempdir().unwrap();
    let part = "o<part> sub\nG0 X#1 Y#1 Z#1\nG0 X0 Y0 Z0\no<part> endsub\nM2\n";
    fs::write(folder.path().join("part.ngc"), part).unwrap();
    let mut options = Options::default();
    options.reading.sub_paths = [folder.path().to_path_buf()].into();
    let mut program = "G21 G90 G17 G94 G64 F6000\nG0 X0 Y0 Z0\nG81 X1 Y0 Z-1 R1 L900\nG80\n\
                       G91\nG41.1 D1 G1 X10 Y1\n"
        .to_owned();
    for turn in 0..700 {
        let _ = writeln!(program, "G1 X{} Y{}", 20 + turn % 7, 1 - turn % 3);
    }
    program += "G40 X10\nG90\nG20 G1 F200 X0\nG21\no<part> call [300]\nM30\n";
    let machine = embedded("linuxcnc-mill");
    let (summary, rows) = alike(&machine, &program, &options);
    let summary = summary.unwrap();
    assert!(summary.unfit_count > 0);
    assert!(rows.iter().any(|row| row.file.ends_with("part.ngc")));
    assert!(rows.iter().filter(|row| row.line == 3).count() >= 2700);
}

#[test]
fn a_program_fails_as_in_one_thread() {
    let machine = embedded("three-axis");
    let mut program = "G21 G90 G94 F600\n".to_owned();
    for x in 1..=900 {
        let _ = writeln!(program, "G1 X{x}");
    }
    let (summary, rows) = alike(&machine, &(program.clone() + "G1 Q\n"), &Options::default());
    assert!(summary.is_err() && rows.len() == 900);
    let (empty, _) = alike(&machine, "", &Options::default());
    assert!(empty.unwrap_err().contains("no-program"));

    let two = Options {
        threads: 2,
        ..Options::default()
    };
    for options in [Options::default(), two] {
        let breaks = Breaks(Cursor::new(program.as_bytes()), 5000);
        let (failed, _) = run(&machine, breaks, &options);
        assert_eq!(failed.unwrap_err(), "Input(Kind(TimedOut))");
        // Nobody takes the rows: the other thread ends as well.
        let failed = analyze(
            Cursor::new(&program),
            &machine,
            &options,
            Some(&mut Full(10)),
        );
        let Err(Failure::Output(error)) = failed else {
            panic!("{failed:?}");
        };
        assert_eq!(error.kind(), io::ErrorKind::StorageFull);
    }
}

/// A file that cannot be read after so many bytes.
struct Breaks<'a>(Cursor<&'a [u8]>, u64);

impl Read for Breaks<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let left = self.1.saturating_sub(self.0.position());
        if left == 0 {
            return Err(io::ErrorKind::TimedOut.into());
        }
        self.0.by_ref().take(left).read(buffer)
    }
}

impl Seek for Breaks<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.0.seek(to)
    }
}

/// Takes so many rows.
struct Full(usize);

impl RowSink for Full {
    fn row(&mut self, _: &Row) -> io::Result<()> {
        self.0 = self.0.checked_sub(1).ok_or(io::ErrorKind::StorageFull)?;
        Ok(())
    }
}
