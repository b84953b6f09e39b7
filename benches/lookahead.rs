//! The look-ahead planners alone: nanoseconds per path element, for a finishing
//! pass of short lines over a wavy surface.

use std::fmt::Write as _;

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use gwatt::interpret::{FeedMode, Move, MoveKind};
use gwatt::machine::{AXES, AxisSet, Machine, PathMode};
use gwatt::plan::lookahead::{Element, Joint, PathPlanner};
use gwatt::plan::{Overrides, plan};

const MOVES: usize = 20_000;
/// Junction deviation, square corner velocity, step of speed, blend arcs.
const CONTROLLERS: [&str; 4] = ["grbl", "klipper", "reprap", "linuxcnc"];
const JOINT: Joint = Joint::Blend {
    tolerance_mm: 0.02,
    join_mm: 0.0,
};

fn main() {
    divan::main();
}

fn machine(controller: &str, jerk_mm_s3: f64) -> Machine {
    let mut text = format!(
        "schema = 1\nname = \"bench\"\ncontroller = \"{controller}\"\n[converter]\npeak_power_w = 1e9\n"
    );
    for axis in ["X", "Y", "Z"] {
        let _ = writeln!(
            text,
            "[axes.{axis}]\nkind = \"linear\"\nrapid_mm_min = 12000\naccel_mm_s2 = 2000\nmass_kg = 100\njerk_mm_s3 = {jerk_mm_s3:?}"
        );
    }
    match Machine::from_toml("bench.toml", &text) {
        Ok((machine, _)) => machine,
        Err(errors) => panic!("{controller}: {errors:?}"),
    }
}

fn moves() -> Vec<Move> {
    let point = |i: usize| {
        let (row, step) = (i / 200, i % 200);
        let along = 0.6 * step as f64 + 0.2 * ((step * 7 + row) % 11) as f64 / 11.0;
        let x = if row.is_multiple_of(2) {
            along
        } else {
            120.0 - along
        };
        let y = row as f64;
        let mut place = [0.0; AXES];
        place[..3].copy_from_slice(&[x, y, 4.0 * libm::sin(x / 9.0) * libm::cos(y / 13.0)]);
        place
    };
    let between = |i| {
        let (start, end) = (point(i), point(i + 1));
        let travel = start.iter().zip(&end).map(|(a, b)| (b - a) * (b - a));
        Move {
            line: i as u64,
            number: None,
            run: 1,
            text: 0,
            kind: MoveKind::Feed,
            start,
            end,
            moving: AxisSet(7),
            unknown_start: AxisSet(0),
            assumed_start: AxisSet(0),
            arc: None,
            length_mm: travel.sum::<f64>().sqrt(),
            feed_mm_s: 80.0,
            feed_excess: 1.0,
            feed_mode: FeedMode::PerMinute,
            accel_mm_s2: [2000.0; AXES],
            path_accel_mm_s2: f64::INFINITY,
            jerk_factor: 1.0,
            rapid_factor: 1.0,
            pace: 1.0,
            dwell_s: 0.0,
            loads: 0,
            path_mode: PathMode::LookAhead,
            corner: gwatt::interpret::Corner::default(),
            stray: gwatt::interpret::Stray::NONE,
        }
    };
    (0..MOVES).map(between).collect()
}

/// Moves to profiles.
#[divan::bench(args = CONTROLLERS)]
fn whole(bencher: Bencher<'_, '_>, controller: &str) {
    plan_all(bencher, &machine(controller, 0.0));
}

/// The same under limits of jerk.
#[divan::bench(args = CONTROLLERS)]
fn whole_with_jerk(bencher: Bencher<'_, '_>, controller: &str) {
    plan_all(bencher, &machine(controller, 50_000.0));
}

fn plan_all(bencher: Bencher<'_, '_>, machine: &Machine) {
    let Some(rule) = machine.controller.planner.look_ahead else {
        return;
    };
    let moves = moves();
    bencher.counter(ItemsCount::new(MOVES)).bench_local(|| {
        let mut planner = PathPlanner::new(machine, rule);
        for mv in &moves {
            let element = Element::of(machine, mv, Overrides::default(), JOINT, mv.line);
            if let Some(element) = &element {
                planner.push(element);
            }
            while let Some(piece) = planner.pop() {
                black_box(piece);
            }
        }
        planner.stop();
        while let Some(piece) = planner.pop() {
            black_box(piece);
        }
    });
}

/// Moves to elements alone.
#[divan::bench]
fn elements(bencher: Bencher<'_, '_>) {
    let machine = machine("grbl", 0.0);
    let moves = moves();
    bencher.counter(ItemsCount::new(MOVES)).bench_local(|| {
        for mv in &moves {
            black_box(Element::of(
                &machine,
                mv,
                Overrides::default(),
                JOINT,
                mv.line,
            ));
        }
    });
}

/// Profiles from rest to rest, for comparison.
#[divan::bench]
fn exact_stop(bencher: Bencher<'_, '_>) {
    let machine = machine("grbl", 0.0);
    let moves = moves();
    bencher.counter(ItemsCount::new(MOVES)).bench_local(|| {
        for mv in &moves {
            black_box(plan(&machine, mv, Overrides::default()));
        }
    });
}

/// The same under limits of jerk.
#[divan::bench]
fn exact_stop_with_jerk(bencher: Bencher<'_, '_>) {
    let machine = machine("grbl", 50_000.0);
    let moves = moves();
    bencher.counter(ItemsCount::new(MOVES)).bench_local(|| {
        for mv in &moves {
            black_box(plan(&machine, mv, Overrides::default()));
        }
    });
}
