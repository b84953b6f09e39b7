//! Each stage of the pipeline by itself, over a program of about one megabyte
//! as a CAM system writes it: many short straight moves, some rapids and arcs.
//!
//! Every stage reports bytes of program per second, so that the figures can be
//! compared with each other and with a copy of the file. `limit` and `check`
//! are the whole path; `report` is `check` with all figures, as CSV.

use std::fmt::Write as _;
use std::io::sink;
use std::sync::OnceLock;

use divan::counter::BytesCount;
use divan::{Bencher, black_box};
use gwatt::interpret::{Diagnostics, Effects, Facts, Interpreter, Move, Step};
use gwatt::machine::{Machine, PathMode};
use gwatt::pipeline::{Allowed, Law, LimitOptions, Options, Strategy, analyze, limit};
use gwatt::plan::{Overrides, Plan, plan};
use gwatt::power::{PowerModel, Want};
use gwatt::report::CsvRows;
use gwatt::source::{LineReader, lines};
use gwatt::syntax::{Block, parse_line, scan_line};

const PROGRAM_BYTES: usize = 1_000_000;
/// A machine with look-ahead, and the same that stops after each block.
const AHEAD: &str = "router-48v";
const STOPS: &str = "router-48v, exact stop";
/// Straight cuts that fit; a small converter; the default.
const MACHINES: [&str; 4] = ["vmc", AHEAD, STOPS, "three-axis"];
const LIMIT: LimitOptions = LimitOptions {
    strategy: Strategy::Optimal,
    law: Law::Exact,
    allowed: Allowed {
        feed: true,
        ..Allowed::NOTHING
    },
    ..LimitOptions::USUAL
};

fn main() {
    divan::main();
}

/// A finishing pass over a wavy surface, line by line, with a half circle to
/// the next line and a rapid back above every tenth.
fn program() -> &'static str {
    static PROGRAM: OnceLock<String> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        let mut text = String::from("G21 G90 G94 G17\nG0 X0 Y0 Z5\n");
        let mut row = 0_u32;
        while text.len() < PROGRAM_BYTES {
            path(&mut text, row);
            row += 1;
        }
        text.push_str("M30\n");
        text
    })
}

/// One line of the pass.
fn path(text: &mut String, row: u32) {
    let y = f64::from(row % 100);
    let forward = row.is_multiple_of(2);
    if row.is_multiple_of(10) {
        let x = if forward { 0.0 } else { 120.0 };
        let _ = writeln!(text, "G0 Z5.000\nG0 X{x:.3} Y{y:.3}\nG1 Z0.000 F400");
    }
    let mut x: f64 = if forward { 0.0 } else { 120.0 };
    let mut feed = " F2400";
    for step in 0..200_u32 {
        let share = 0.3 + 0.6 * f64::from((step * 7 + row) % 11) / 11.0;
        x += if forward { share } else { -share };
        let z = 4.0 * libm::sin(x / 9.0) * libm::cos(y / 13.0) - 4.0;
        let _ = writeln!(text, "G1 X{x:.4} Y{y:.4} Z{z:.4}{feed}");
        feed = "";
    }
    let turn = if forward { "G3" } else { "G2" };
    let _ = writeln!(text, "{turn} X{x:.4} Y{:.4} I0 J0.5 F1200", y + 1.0);
}

fn machine(name: &str) -> Machine {
    let stops = name == STOPS;
    match Machine::load(if stops { AHEAD } else { name }) {
        Ok((mut machine, _)) => {
            if stops {
                machine.path.mode = Some(PathMode::ExactStop);
            }
            machine
        }
        Err(errors) => panic!("{name}: {errors:?}"),
    }
}

/// The moves of the program.
fn moves(machine: &Machine) -> Vec<Move> {
    let mut interpreter = Interpreter::new(machine, &Options::default().reading);
    let mut diagnostics = Diagnostics::default();
    let mut facts = Facts::default();
    let (mut block, mut steps) = (Block::default(), Vec::new());
    for (text, number) in lines(program().as_bytes()).zip(1..) {
        scan_line(text, number == 1, &mut block);
        interpreter.execute(
            number,
            text,
            &mut block,
            Effects::new(&mut steps, &mut facts, &mut diagnostics),
        );
    }
    assert_eq!(diagnostics.errors, 0, "{:?}", diagnostics.list);
    let moves = steps.into_iter().filter_map(|step| match step {
        Step::Move(mv) => Some(mv),
        Step::Action(_) => None,
    });
    moves.collect()
}

fn plans(machine: &Machine, moves: &[Move]) -> Vec<Plan> {
    let overrides = Overrides::default();
    moves
        .iter()
        .map(|mv| plan(machine, mv, overrides))
        .collect()
}

fn bytes() -> BytesCount {
    BytesCount::of_str(program())
}

#[divan::bench]
fn a_lines(bencher: Bencher<'_, '_>) {
    bencher.counter(bytes()).bench_local(|| {
        let mut reader = LineReader::new(program().as_bytes());
        let mut count = 0;
        while let Ok(Some((_, text))) = reader.next_line() {
            count += black_box(text).len();
        }
        count
    });
}

#[divan::bench]
fn b_scan(bencher: Bencher<'_, '_>) {
    let mut block = Block::default();
    bencher.counter(bytes()).bench_local(|| {
        for text in lines(program().as_bytes()) {
            scan_line(text, false, &mut block);
            black_box(&block);
        }
    });
}

#[divan::bench]
fn b_parse(bencher: Bencher<'_, '_>) {
    let (mut block, mut pieces) = (Block::default(), Vec::new());
    bencher.counter(bytes()).bench_local(|| {
        for text in lines(program().as_bytes()) {
            parse_line(text, false, &mut pieces, &mut block);
            black_box((&pieces, &block));
        }
    });
}

#[divan::bench]
fn c_interpret(bencher: Bencher<'_, '_>) {
    let machine = machine("vmc");
    let mut blocks: Vec<(&[u8], Block)> = lines(program().as_bytes())
        .map(|text| {
            let mut block = Block::default();
            scan_line(text, false, &mut block);
            (text, block)
        })
        .collect();
    let mut steps = Vec::new();
    bencher.counter(bytes()).bench_local(|| {
        let mut interpreter = Interpreter::new(&machine, &Options::default().reading);
        let mut diagnostics = Diagnostics::default();
        let mut facts = Facts::default();
        for ((text, block), number) in blocks.iter_mut().zip(1..) {
            steps.clear();
            interpreter.execute(
                number,
                text,
                block,
                Effects::new(&mut steps, &mut facts, &mut diagnostics),
            );
            black_box(&steps);
        }
    });
}

#[divan::bench]
fn d_plan(bencher: Bencher<'_, '_>) {
    let machine = machine("vmc");
    let moves = moves(&machine);
    bencher.counter(bytes()).bench_local(|| {
        for mv in &moves {
            black_box(plan(&machine, mv, Overrides::default()));
        }
    });
}

#[divan::bench(args = ["peaks", "energy"])]
fn e_power(bencher: Bencher<'_, '_>, what: &str) {
    let want = if what == "energy" {
        Want::ALL
    } else {
        Want::PEAKS
    };
    let machine = machine("vmc");
    let moves = moves(&machine);
    let plans = plans(&machine, &moves);
    let model = PowerModel::new(&machine);
    bencher.counter(bytes()).bench_local(|| {
        for (mv, plan) in moves.iter().zip(&plans) {
            black_box(model.demand(mv, plan, want));
        }
    });
}

#[divan::bench(args = MACHINES)]
fn f_check(bencher: Bencher<'_, '_>, name: &str) {
    check(bencher, name, 1);
}

#[divan::bench(args = MACHINES)]
fn f_check_in_two_threads(bencher: Bencher<'_, '_>, name: &str) {
    check(bencher, name, 2);
}

fn check(bencher: Bencher<'_, '_>, name: &str, threads: usize) {
    let machine = machine(name);
    let options = Options {
        threads,
        ..Options::default()
    };
    bencher
        .counter(bytes())
        .bench_local(|| analyze(std::io::Cursor::new(program()), &machine, &options, None));
}

#[divan::bench(args = MACHINES)]
fn g_limit(bencher: Bencher<'_, '_>, name: &str) {
    let machine = machine(name);
    let options = Options::default();
    bencher.counter(bytes()).bench_local(|| {
        limit(
            std::io::Cursor::new(program()),
            &machine,
            &options,
            LIMIT,
            sink(),
            None,
        )
    });
}

#[divan::bench]
fn h_report(bencher: Bencher<'_, '_>) {
    let machine = machine("vmc");
    let options = Options::default();
    bencher.counter(bytes()).bench_local(|| {
        let mut rows = CsvRows::new(sink())?;
        let summary = analyze(
            std::io::Cursor::new(program()),
            &machine,
            &options,
            Some(&mut rows),
        );
        rows.finish().map(|_| summary)
    });
}
