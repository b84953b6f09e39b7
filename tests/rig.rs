//! Machines and moves for the tests of plan and power, and a reference that
//! evaluates the power of a plan at one instant by the book.

mod any;

use gwatt::interpret::{Arc, FeedMode, Move, MoveKind};
use gwatt::machine::{
    AXES, ArcRule, Axis, AxisKind, AxisSet, Controller, Converter, Family, Kinematics, Language,
    Limits, Machine, Path, PathMode, Planner, RapidKnob, RapidPath, Ratings, Responses,
};
use gwatt::plan::{Phase, Plan, Trajectory};

pub(crate) use any::{any_arc, any_delta, any_feed, any_machine};

/// A linear axis of 100 kg, 500 mm/s and 5 m/s² without any loss.
pub(crate) fn axis() -> Axis {
    Axis {
        kind: AxisKind::Linear,
        rapid_mm_s: 500.0,
        max_feed_mm_s: f64::INFINITY,
        reference_mm_s: f64::INFINITY,
        reference_mm: None,
        further_reference_mm: [None; gwatt::machine::FURTHER_REFERENCES],
        accel_mm_s2: 5000.0,
        jerk_mm_s3: 0.0,
        mass_kg: 100.0,
        coulomb_n: 0.0,
        viscous_n_s_m: 0.0,
        gravity_n: 0.0,
        efficiency: 1.0,
        copper_w_n2: 0.0,
        servo_factor_motor: 1.0,
        servo_factor_regen: 1.0,
        servo: None,
        friction_min_ratio: 1.0,
        mass_error: 0.0,
        friction_error: 0.0,
        si_per_unit: 1e-3,
    }
}

/// A machine of the given axes (X, Y, …) on one converter of 1 kW.
pub(crate) fn machine(axes: &[Axis]) -> Machine {
    let mut slots = [None; AXES];
    let mut axis_set = AxisSet::default();
    for (i, axis) in axes.iter().enumerate() {
        slots[i] = Some(*axis);
        axis_set.insert(i);
    }
    Machine {
        name: "rig".into(),
        controller: controller(),
        kinematics: Kinematics::Cartesian,
        further_offsets: std::collections::BTreeMap::new(),
        points: [[None; AXES]; 2],
        axes: slots,
        axis_set,
        converters: vec![Converter {
            name: String::new(),
            axes: axis_set,
            peak_power_w: 1000.0,
            regen_power_w: Some(500.0),
            base_load_w: 0.0,
            credit_regen: false,
            ratings: Ratings::default(),
        }],
        path: Path {
            max_feed_mm_s: f64::INFINITY,
            clearance_mm: [None; AXES],
            accel_mm_s2: [f64::INFINITY; 3],
            mode: None,
            rapid: RapidPath::Linear,
            response_time_s: 0.01,
        },
        force_curves: Vec::new(),
        mass_parts: Vec::new(),
        responses: Responses::default(),
        spindle: None,
        tools: Vec::new(),
        loads: Vec::new(),
        offsets: [None; 9],
        presets: Vec::new(),
        limits: Limits {
            margin: 0.0,
            feed_override_max: 1.0,
            rapid_override_max: 1.0,
            spindle_override_max: 1.0,
            override_at: None,
            override_from: None,
            min_feed_mm_s: 0.0,
            min_feed_ratio: 0.0,
        },
    }
}

fn controller() -> Controller {
    Controller {
        name: "rig".into(),
        description: String::new(),
        language: Language {
            name: "rig".into(),
            family: Family::Iso,
            dwell: Vec::new(),
            power_on_feed_mm_s: f64::INFINITY,
            power_on_motion: gwatt::machine::PowerOnMotion::None,
            loose_o_words: false,
            metric: true,
            units_kept: false,
            absolute: true,
            arc_absolute: false,
            g61: PathMode::ExactStop,
            g61_1: PathMode::ExactStop,
            g64: PathMode::LookAhead,
            power_on_tolerance_mm: 0.0,
            power_on_mode: PathMode::ExactStop,
            exact_stop_word: None,
            tool_change: None,
            spindle_before_motion: false,
            tool_change_moves: None,
            unknown_moves: Vec::new(),
            rapid_uses_feed: false,
            ignored_g: Vec::new(),
            levels: Vec::new(),
            ignored_m: Vec::new(),
            block_delete: true,
            compensation: None,
            printer: gwatt::machine::Printer::default(),
            mill_cycles: false,
            pecks_return_to_r: false,
            peck_clearance_mm: 1.0,
            cycles_repeat_by_l: false,
            pecks_by_ijk: false,
            escape_mm: None,
            groove_return_mm: None,
            type_2: None,
            arc_without_center: gwatt::machine::ArcWithoutCenter::Refused,
            tap_return_factor: None,
            tap_feed: gwatt::machine::TapFeed::PerMinute,
            cycles_take_d_and_h: false,
            moves_in_machine_at_rapid: false,
            arc_tolerance_mm: None,
            kept_variables: Vec::new(),
            dialect: gwatt::machine::Dialect::default(),
        },
        queue: gwatt::machine::Queue::default(),
        planner: Planner {
            rapid: RapidPath::Linear,
            arc_rule: ArcRule::Shared,
            rapid_joint: gwatt::machine::RapidJoint::Stop,
            spindle_wait: gwatt::machine::SpindleWait::Unknown,
            dwell_stops: false,
            shortest_block_s: 0.005,
            shortest_at_feed_s: 0.0,
            look_ahead: None,
        },
        knobs: Vec::new(),
        wired: Vec::new(),
        rapid_knob: RapidKnob::None,
    }
}

/// A straight move by `delta` from 0; `feed` infinite for a rapid.
pub(crate) fn straight(machine: &Machine, delta: &[f64], feed: f64) -> Move {
    let mut end = [0.0; AXES];
    let mut moving = AxisSet::default();
    for (i, d) in delta.iter().enumerate() {
        end[i] = *d;
        if *d != 0.0 {
            moving.insert(i);
        }
    }
    Move {
        line: 1,
        number: None,
        run: 1,
        text: 0,
        kind: if feed.is_finite() {
            MoveKind::Feed
        } else {
            MoveKind::Rapid
        },
        start: [0.0; AXES],
        end,
        moving,
        unknown_start: AxisSet::default(),
        assumed_start: AxisSet::default(),
        arc: None,
        length_mm: delta.iter().map(|d| d * d).sum::<f64>().sqrt(),
        feed_mm_s: feed,
        feed_excess: 1.0,
        feed_mode: FeedMode::PerMinute,
        accel_mm_s2: std::array::from_fn(|i| machine.axes[i].map_or(0.0, |a| a.accel_mm_s2)),
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

/// A dwell.
pub(crate) fn dwell(machine: &Machine, seconds: f64) -> Move {
    let mut mv = straight(machine, &[], 1.0);
    mv.kind = MoveKind::Dwell;
    mv.dwell_s = seconds;
    mv
}

/// An arc about 0 in the plane of two axes; a third axis moves by `lift`.
pub(crate) fn arc(
    machine: &Machine,
    plane: [usize; 2],
    radius: f64,
    angles: [f64; 2],
    lift: f64,
    feed: f64,
) -> Move {
    let [start, sweep] = angles;
    let mut mv = straight(machine, &[], feed);
    mv.kind = MoveKind::Arc;
    let third = 3 - plane[0] - plane[1];
    mv.moving = AxisSet(1 << plane[0] | 1 << plane[1] | u16::from(lift != 0.0) << third);
    mv.start[plane[0]] = radius * libm::cos(start);
    mv.start[plane[1]] = radius * libm::sin(start);
    mv.end[plane[0]] = radius * libm::cos(start + sweep);
    mv.end[plane[1]] = radius * libm::sin(start + sweep);
    mv.end[third] = lift;
    mv.length_mm = libm::hypot(radius * sweep, lift);
    mv.arc = Some(Arc {
        plane,
        center: [0.0; 2],
        radius_mm: radius,
        start_angle_rad: start,
        sweep_rad: sweep,
    });
    mv
}

/// How the reference reads the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Reading {
    Nominal,
    Motor,
    Regen,
}

/// Speed and acceleration of an axis on a path, in its own unit.
fn on_path(mv: &Move, axis: usize, phase: &Phase, t: f64) -> (f64, f64) {
    let s = phase.state_at(t);
    if let Some(arc) = mv.arc
        && let Some(which) = arc.plane.iter().position(|&p| p == axis)
    {
        let turn = arc.sweep_rad / mv.length_mm;
        let angle = arc.start_angle_rad + turn * s.position_mm;
        let (sin, cos) = libm::sincos(angle);
        let (tangent, normal) = [(-sin, -cos), (cos, -sin)][which];
        let r = arc.radius_mm;
        let (w, alpha) = (turn * s.velocity_mm_s, turn * s.accel_mm_s2);
        return (r * w * tangent, r * (alpha * tangent + w * w * normal));
    }
    let u = (mv.end[axis] - mv.start[axis]) / mv.length_mm;
    (u * s.velocity_mm_s, u * s.accel_mm_s2)
}

/// Power of the first converter at one instant of a path: what counts as
/// drawn and as fed back. `sign_t` is an instant nearby that gives the
/// directions of the axes, of which some may just be turning back.
fn power_on_path(
    machine: &Machine,
    mv: &Move,
    phase: &Phase,
    t: f64,
    sign_t: f64,
    reading: Reading,
) -> (f64, f64) {
    let converter = &machine.converters[0];
    let mut powers = vec![];
    for (i, axis) in machine.axes.iter().enumerate() {
        let Some(axis) = axis else { continue };
        if !mv.moving.contains(i) {
            powers.push(axis.copper_w_n2 * axis.gravity_n * axis.gravity_n);
            continue;
        }
        let k = axis.si_per_unit;
        let (v, a) = on_path(mv, i, phase, t);
        let (v, a) = (v * k, a * k);
        let direction = on_path(mv, i, phase, sign_t).0.signum();
        let force = |factor: f64, friction: f64| {
            axis.mass_kg * a * factor
                + friction * (axis.viscous_n_s_m * v + axis.coulomb_n * direction)
                + axis.gravity_n
        };
        let grows = a * direction > 0.0;
        let (motor, regen) = if grows {
            (axis.servo_factor_motor, 1.0)
        } else {
            (1.0, axis.servo_factor_regen)
        };
        let [most, least] = [force(motor, 1.0), force(regen, axis.friction_min_ratio)];
        let electrical = |force: f64| {
            let p = v * force;
            let converted = if p > 0.0 {
                p / axis.efficiency
            } else {
                p * axis.efficiency
            };
            converted + axis.copper_w_n2 * force * force
        };
        // Any force between both may act; copper loss is convex in it.
        let turning = -axis.efficiency * v / (2.0 * axis.copper_w_n2);
        let inside = (turning - most) * (turning - least) < 0.0;
        powers.push(match reading {
            Reading::Nominal => electrical(force(1.0, 1.0)),
            Reading::Motor => electrical(most).max(electrical(least)),
            Reading::Regen if inside => electrical(turning),
            Reading::Regen => electrical(most).min(electrical(least)),
        });
    }
    let base = converter.base_load_w;
    if converter.credit_regen {
        let sum = base + powers.iter().sum::<f64>();
        (sum, -sum)
    } else {
        (
            base + powers.iter().map(|p| p.max(0.0)).sum::<f64>(),
            powers.iter().map(|p| (-p).max(0.0)).sum::<f64>(),
        )
    }
}

/// Power of the first converter at one instant of a planned path: what counts as
/// drawn and as fed back.
pub(crate) fn path_power(
    machine: &Machine,
    mv: &Move,
    plan: &Plan,
    t: f64,
    reading: Reading,
) -> (f64, f64) {
    let Trajectory::Path(profile) = &plan.trajectory else {
        panic!("the reference samples paths only");
    };
    let mut rest = t;
    for (left, phase) in (0..profile.phases.len()).rev().zip(&profile.phases) {
        // What rounding puts after the end belongs to the last phase.
        let slack = if left == 0 { 1e-12 * t } else { 0.0 };
        if rest <= phase.duration_s + slack {
            let rest = rest.min(phase.duration_s);
            return power_on_path(machine, mv, phase, rest, rest, reading);
        }
        rest -= phase.duration_s;
    }
    panic!("{t} s is after the end");
}

/// Peaks and energy of a path by dense sampling and local refinement: a lower
/// bound of the peaks.
pub(crate) struct Sampled {
    pub peak_w: f64,
    pub regen_w: f64,
    pub energy_j: f64,
}

/// Samples a planned path with `n` intervals a phase.
pub(crate) fn sample(machine: &Machine, mv: &Move, plan: &Plan, n: u32) -> Sampled {
    let Trajectory::Path(profile) = &plan.trajectory else {
        panic!("the reference samples paths only");
    };
    let mut found = Sampled {
        peak_w: 0.0,
        regen_w: 0.0,
        energy_j: 0.0,
    };
    for phase in &profile.phases {
        let h = phase.duration_s / f64::from(n);
        let drawn = |t, sign_t| power_on_path(machine, mv, phase, t, sign_t, Reading::Motor).0;
        let fed = |t, sign_t| power_on_path(machine, mv, phase, t, sign_t, Reading::Regen).1;
        let energy = |t, sign_t| power_on_path(machine, mv, phase, t, sign_t, Reading::Nominal).0;
        let ends = cell_ends(mv, phase, n);
        let mut cells = [vec![], vec![]];
        for pair in ends.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            let middle = 0.5 * (from + to);
            for (which, cell) in cells.iter_mut().enumerate() {
                let f = |t| match which {
                    0 => drawn(t, middle),
                    _ => fed(t, middle),
                };
                cell.push((middle, f(from).max(f(middle)).max(f(to))));
            }
            let both = energy(from, middle) + energy(to, middle);
            found.energy_j += (to - from) * (both + 4.0 * energy(middle, middle)) / 6.0;
        }
        found.peak_w = found
            .peak_w
            .max(refine(&drawn, &cells[0], h, phase.duration_s));
        found.regen_w = found
            .regen_w
            .max(refine(&fed, &cells[1], h, phase.duration_s));
    }
    found
}

/// Ends of `n` cells of a phase, and between them the instants at which an axis
/// turns back.
fn cell_ends(mv: &Move, phase: &Phase, n: u32) -> Vec<f64> {
    let h = phase.duration_s / f64::from(n);
    let mut ends: Vec<f64> = (0..=n).map(|i| f64::from(i) * h).collect();
    for axis in mv.moving.iter() {
        let speed = |t| on_path(mv, axis, phase, t).0;
        // At rest rounding may show a speed backwards.
        let still = 1e-12
            * (0..=n)
                .map(|i| speed(f64::from(i) * h).abs())
                .fold(0.0, f64::max);
        for i in 0..n as usize {
            let (mut from, mut to) = (ends[i], ends[i + 1]);
            if speed(from) * speed(to) < 0.0 && speed(from).abs().min(speed(to).abs()) > still {
                for _ in 0..60 {
                    let middle = 0.5 * (from + to);
                    if speed(from) * speed(middle) > 0.0 {
                        from = middle;
                    } else {
                        to = middle;
                    }
                }
                ends.push(from);
            }
        }
    }
    ends.sort_by(f64::total_cmp);
    ends.dedup_by(|a, b| *a - *b < 1e-9 * h);
    ends
}

/// Refines each sampled maximum that comes close to the largest by finer and
/// finer grids around it. Cells are given by their middle and value.
fn refine(f: &dyn Fn(f64, f64) -> f64, cells: &[(f64, f64)], h: f64, end: f64) -> f64 {
    let mut largest = cells.iter().fold(f64::NEG_INFINITY, |a, b| a.max(b.1));
    let close = largest - 0.02 * largest.abs();
    for (i, &(middle, cell)) in cells.iter().enumerate() {
        let neighbours = [i.saturating_sub(1), (i + 1).min(cells.len() - 1)];
        if cell < close || neighbours.iter().any(|&other| cells[other].1 > cell) {
            continue;
        }
        let (mut value, mut centre, mut half) = (cell, middle, 1.5 * h);
        for _ in 0..6 {
            let mut next = centre;
            for step in -10..=10 {
                let t = (centre + half * f64::from(step) / 10.0).clamp(0.0, end);
                // Just at rest rounding may show a speed backwards.
                let inside = t.clamp(1e-6 * end, (1.0 - 1e-6) * end);
                let at = f(t, inside);
                if at > value {
                    (value, next) = (at, t);
                }
            }
            (centre, half) = (next, half / 5.0);
        }
        largest = largest.max(value);
    }
    largest
}
