//! Planning and power of single moves: the hot path of every program.

use divan::{Bencher, black_box};
use gwatt::interpret::{Arc, FeedMode, Move, MoveKind};
use gwatt::machine::{
    ArcRule, Axis, AxisKind, AxisSet, Controller, Converter, Family, Language, Limits, Machine,
    Path, PathMode, Planner, RapidKnob, RapidPath,
};
use gwatt::plan::{Overrides, plan};
use gwatt::power::{PowerModel, Want};

fn main() {
    divan::main();
}

fn axis(mass_kg: f64) -> Axis {
    Axis {
        kind: AxisKind::Linear,
        rapid_mm_s: 600.0,
        accel_mm_s2: 6000.0,
        jerk_mm_s3: 0.0,
        mass_kg,
        coulomb_n: 700.0,
        viscous_n_s_m: 0.0,
        gravity_n: 0.0,
        efficiency: 0.9,
        copper_w_n2: 0.0,
        servo_factor_motor: 1.0,
        servo_factor_regen: 1.0,
        friction_min_ratio: 1.0,
        si_per_unit: 1e-3,
    }
}

fn machine(edit: fn(&mut Axis)) -> Machine {
    let mut axes = [None; 10];
    for (i, mass) in [900.0, 600.0, 400.0].into_iter().enumerate() {
        let mut axis = axis(mass);
        edit(&mut axis);
        axes[i] = Some(axis);
    }
    let controller = Controller {
        name: "iso".into(),
        description: String::new(),
        language: Language {
            family: Family::Iso,
            dwell: Vec::new(),
            metric: true,
            absolute: true,
            arc_absolute: false,
            g61: PathMode::ExactStop,
            g61_1: PathMode::ExactStop,
            g64: PathMode::LookAhead,
            power_on_mode: PathMode::ExactStop,
            rapid_uses_feed: false,
            ignored_g: Vec::new(),
            ignored_m: Vec::new(),
            block_delete: true,
        },
        planner: Planner {
            rapid: RapidPath::Independent,
            arc_rule: ArcRule::Shared,
            rapid_joint: gwatt::machine::RapidJoint::Stop,
        },
        knobs: Vec::new(),
        rapid_knob: RapidKnob::None,
    };
    Machine {
        name: "bench".into(),
        controller,
        axes,
        axis_set: AxisSet(7),
        converters: vec![Converter {
            name: String::new(),
            axes: AxisSet(7),
            peak_power_w: 3500.0,
            regen_power_w: Some(3000.0),
            base_load_w: 100.0,
            credit_regen: false,
        }],
        path: Path {
            mode: None,
            rapid: RapidPath::Independent,
        },
        spindle: None,
        loads: Vec::new(),
        presets: Vec::new(),
        limits: Limits {
            margin: 0.1,
            feed_override_max: 1.0,
            rapid_override_max: 1.0,
            spindle_override_max: 1.0,
            min_feed_mm_s: 0.0,
            min_feed_ratio: 0.0,
        },
        unchecked: Vec::new(),
    }
}

fn feed() -> Move {
    let mut end = [0.0; 10];
    end[..3].copy_from_slice(&[3.0, -2.0, 1.5]);
    Move {
        line: 1,
        number: None,
        kind: MoveKind::Feed,
        start: [0.0; 10],
        end,
        moving: AxisSet(7),
        unknown_start: AxisSet(0),
        arc: None,
        length_mm: f64::sqrt(9.0 + 4.0 + 2.25),
        feed_mm_s: 100.0,
        feed_mode: FeedMode::PerMinute,
        accel_mm_s2: [6000.0; 10],
        path_accel_mm_s2: f64::INFINITY,
        rapid_factor: 1.0,
        dwell_s: 0.0,
        loads: 0,
        path_mode: PathMode::ExactStop,
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
    run(bencher, &machine(|_| ()), &feed(), Want::PEAKS);
}

#[divan::bench]
fn straight_plan_only(bencher: Bencher<'_, '_>) {
    let machine = machine(|_| ());
    let mv = feed();
    bencher.bench(|| plan(&machine, black_box(&mv), Overrides::default()));
}

#[divan::bench]
fn straight_with_energy(bencher: Bencher<'_, '_>) {
    run(bencher, &machine(|_| ()), &feed(), Want::ALL);
}

#[divan::bench]
fn straight_with_copper(bencher: Bencher<'_, '_>) {
    let machine = machine(|axis| axis.copper_w_n2 = 1e-5);
    run(bencher, &machine, &feed(), Want::ALL);
}

#[divan::bench]
fn independent_rapid(bencher: Bencher<'_, '_>) {
    let mut mv = feed();
    mv.kind = MoveKind::Rapid;
    run(bencher, &machine(|_| ()), &mv, Want::PEAKS);
}

#[divan::bench(args = [0.05, 0.5, 1.5, 6.2, 60.0])]
fn arc_of_r10(bencher: Bencher<'_, '_>, sweep: f64) {
    run(bencher, &machine(|_| ()), &arc(10.0, sweep), Want::PEAKS);
}

#[divan::bench(args = [0.05, 1.5, 6.2])]
fn arc_with_energy(bencher: Bencher<'_, '_>, sweep: f64) {
    run(bencher, &machine(|_| ()), &arc(10.0, sweep), Want::ALL);
}
