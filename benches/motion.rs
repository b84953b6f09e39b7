//! Planning and power of single moves: the hot path of every program.

use divan::{Bencher, black_box};
use gwatt::interpret::{Arc, FeedMode, Move, MoveKind};
use gwatt::limit::{Allowed, Ends, Law, LimitOptions, Permit, Solver, Strategy};
use gwatt::machine::{AXES, Axis, AxisSet, Machine, PathMode};
use gwatt::plan::jerk::{JerkLimits, State, position_target, speed_target};
use gwatt::plan::{Overrides, plan};
use gwatt::power::{Assessment, Assessor, PowerModel, Want};

fn main() {
    divan::main();
}

fn machine(name: &str) -> Machine {
    match Machine::load(name) {
        Ok((machine, _)) => machine,
        Err(errors) => panic!("{name}: {errors:?}"),
    }
}

/// The default machine with its axes changed.
fn three_axis(edit: fn(&mut Axis)) -> Machine {
    let mut machine = machine("three-axis");
    machine.axes.iter_mut().flatten().for_each(edit);
    machine
}

fn feed() -> Move {
    let mut end = [0.0; 10];
    end[..3].copy_from_slice(&[3.0, -2.0, 1.5]);
    Move {
        line: 1,
        number: None,
        run: 1,
        text: 0,
        kind: MoveKind::Feed,
        start: [0.0; 10],
        end,
        moving: AxisSet(7),
        unknown_start: AxisSet(0),
        assumed_start: AxisSet(0),
        arc: None,
        length_mm: f64::sqrt(9.0 + 4.0 + 2.25),
        feed_mm_s: 100.0,
        feed_excess: 1.0,
        feed_mode: FeedMode::PerMinute,
        accel_mm_s2: [6000.0; 10],
        path_accel_mm_s2: f64::INFINITY,
        jerk_factor: 1.0,
        rapid_factor: 1.0,
        pace: 1.0,
        dwell_s: 0.0,
        loads: 0,
        path_mode: PathMode::ExactStop,
        corner: gwatt::interpret::Corner::default(),
        stray: gwatt::interpret::Stray::NONE,
    }
}

fn arc(radius_mm: f64, sweep_rad: f64) -> Move {
    let start_angle_rad = 0.3;
    let at = |angle: f64| [radius_mm * libm::cos(angle), radius_mm * libm::sin(angle)];
    let mut mv = feed();
    mv.kind = MoveKind::Arc;
    mv.moving = AxisSet(3);
    mv.start[..2].copy_from_slice(&at(start_angle_rad));
    mv.end = mv.start;
    mv.end[..2].copy_from_slice(&at(start_angle_rad + sweep_rad));
    mv.length_mm = radius_mm * sweep_rad.abs();
    mv.arc = Some(Arc {
        plane: [0, 1],
        center: [0.0; 2],
        radius_mm,
        start_angle_rad,
        sweep_rad,
    });
    mv
}

fn run(bencher: Bencher<'_, '_>, machine: &Machine, mv: &Move, want: Want) {
    let model = PowerModel::new(machine);
    bencher.bench(|| {
        let plan = plan(machine, black_box(mv), Overrides::default());
        model.demand(mv, &plan, want)
    });
}

#[divan::bench]
fn straight(bencher: Bencher<'_, '_>) {
    run(bencher, &three_axis(|_| ()), &feed(), Want::PEAKS);
}

#[divan::bench]
fn straight_plan_only(bencher: Bencher<'_, '_>) {
    let machine = three_axis(|_| ());
    let mv = feed();
    bencher.bench(|| plan(&machine, black_box(&mv), Overrides::default()));
}

#[divan::bench]
fn straight_with_energy(bencher: Bencher<'_, '_>) {
    run(bencher, &three_axis(|_| ()), &feed(), Want::ALL);
}

#[divan::bench]
fn straight_with_copper(bencher: Bencher<'_, '_>) {
    let machine = three_axis(|axis| axis.copper_w_n2 = 1e-5);
    run(bencher, &machine, &feed(), Want::ALL);
}

#[divan::bench]
fn independent_rapid(bencher: Bencher<'_, '_>) {
    let mut mv = feed();
    mv.kind = MoveKind::Rapid;
    run(bencher, &three_axis(|_| ()), &mv, Want::PEAKS);
}

#[divan::bench(args = [0.05, 0.5, 1.5, 6.2, 60.0])]
fn arc_of_r10(bencher: Bencher<'_, '_>, sweep: f64) {
    run(bencher, &three_axis(|_| ()), &arc(10.0, sweep), Want::PEAKS);
}

#[divan::bench(args = [0.05, 1.5, 6.2])]
fn arc_with_energy(bencher: Bencher<'_, '_>, sweep: f64) {
    run(bencher, &three_axis(|_| ()), &arc(10.0, sweep), Want::ALL);
}

/// The change for a move that does not fit.
fn solve(bencher: Bencher<'_, '_>, name: &str, strategy: Strategy, mv: &Move) {
    let mut machine = machine(name);
    let accel = |axis: usize| machine.axes[axis].map_or(0.0, |axis| axis.accel_mm_s2);
    let mut mv = mv.clone();
    mv.feed_mm_s = 1e4;
    mv.accel_mm_s2 = std::array::from_fn(accel);
    let permit = Permit {
        edit: true,
        feed_word: true,
        as_feed: false,
        exact_stop: false,
        stands: false,
        levels: false,
        rests: false,
        line_before: true,
        knobs: true,
        apart: false,
        stop_word: false,
        unsplit: None,
        reason: "",
        reason_help: "",
        mm_per_unit: 1.0,
        knob_mm_per_unit: 1.0,
        positions: false,
        feed_before: None,
        feed_accel_mm_s2: mv.accel_mm_s2,
        speed_mm_s: [f64::INFINITY; AXES],
    };
    machine.converters[0].regen_power_w = None;
    machine.limits.margin = 0.0;
    machine.limits.min_feed_ratio = 0.0;
    // So tight a limit that the move takes twice of it.
    let peak_w = judge(&machine, &mv).demand.peak_w;
    let base_w = machine.converters[0].base_load_w;
    machine.converters[0].peak_power_w = base_w + (peak_w - base_w) / 2.0;
    let assessment = judge(&machine, &mv);
    let how = LimitOptions {
        strategy,
        law: Law::Exact,
        allowed: Allowed {
            feed: true,
            ..Allowed::NOTHING
        },
        ..LimitOptions::USUAL
    };
    let solver = Solver::new(&machine, how);
    if let Err(obstacle) = solver.solve(&mv, &assessment, &permit, Ends::Rest) {
        panic!("{obstacle:?}");
    }
    bencher.bench(|| solver.solve(black_box(&mv), &assessment, &permit, Ends::Rest));
}

fn judge(machine: &Machine, mv: &Move) -> Assessment {
    let mut found = None;
    let mut assessor = Assessor::new(machine, None, Want::PEAKS);
    let mut keep = |_: &Move, assessment: &Assessment, _: &[u8]| found = Some(*assessment);
    assessor.push(mv, b"", &mut keep);
    assessor.finish(&mut keep);
    match found {
        Some(assessment) => assessment,
        None => unreachable!("a pushed move is judged"),
    }
}

#[divan::bench]
fn solve_speed(bencher: Bencher<'_, '_>) {
    solve(bencher, "vmc", Strategy::Speed, &feed());
}

#[divan::bench]
fn solve_optimal(bencher: Bencher<'_, '_>) {
    solve(bencher, "linear-gantry", Strategy::Optimal, &feed());
}

#[divan::bench]
fn solve_arc(bencher: Bencher<'_, '_>) {
    solve(bencher, "vmc", Strategy::Speed, &arc(10.0, 1.57));
}

/// Starts and targets spread over the limits 10 mm/s, 10 mm/s² and 50 mm/s³.
fn states() -> Vec<(State, State)> {
    let spread = |i: f64, step: f64| 20.0 * ((i * step) % 1.0) - 10.0;
    (0..1000)
        .map(f64::from)
        .map(|i| {
            let start = State {
                position_mm: 0.0,
                velocity_mm_s: 0.9 * spread(i, 0.618),
                accel_mm_s2: 0.4 * spread(i, 0.414),
            };
            let target = State {
                position_mm: spread(i, 0.732),
                velocity_mm_s: 0.9 * spread(i, 0.236),
                accel_mm_s2: 0.0,
            };
            (start, target)
        })
        .collect()
}

#[divan::bench(items_count = 1000_u32)]
fn speed_profiles(bencher: Bencher<'_, '_>) {
    let states = states();
    let limits = JerkLimits::symmetric(10.0, 10.0, 50.0);
    bencher.bench(|| {
        for (start, target) in &states {
            let speed = black_box(target.velocity_mm_s);
            black_box(speed_target(*start, speed, 0.0, &limits)).ok();
        }
    });
}

#[divan::bench(items_count = 1000_u32)]
fn position_profiles(bencher: Bencher<'_, '_>) {
    let states = states();
    let limits = JerkLimits::symmetric(10.0, 10.0, 50.0);
    bencher.bench(|| {
        for (start, target) in &states {
            black_box(position_target(*start, black_box(*target), &limits)).ok();
        }
    });
}
