//! Axes, machines, paths and feeds of any kind.

use gwatt::machine::{ArcRule, Axis, Machine};
use proptest::prelude::*;

use super::{axis, machine};

/// Axes with everything: mass, friction, weight, losses and servo factors.
pub(crate) fn any_axis() -> impl Strategy<Value = Axis> {
    (
        (50.0..900.0_f64, 500.0..9000.0_f64, 1.0..800.0_f64),
        prop_oneof![Just(0.0), 0.0..700.0_f64],
        prop_oneof![Just(0.0), 0.0..900.0_f64],
        prop_oneof![Just(0.0), -900.0..900.0_f64],
        prop_oneof![Just(1.0), 0.6..1.0_f64],
        prop_oneof![Just(0.0), 1e-6..1e-4_f64],
        prop_oneof![
            Just((1.0, 1.0, 1.0)),
            (1.0..1.4_f64, 1.0..1.4_f64, 0.4..1.0_f64)
        ],
        prop_oneof![Just(0.0), 2e3..5e5_f64],
    )
        .prop_map(
            |(
                (rapid, accel, mass),
                coulomb,
                viscous,
                gravity,
                efficiency,
                copper,
                factors,
                jerk,
            )| Axis {
                jerk_mm_s3: jerk,
                rapid_mm_s: rapid,
                accel_mm_s2: accel,
                mass_kg: mass,
                coulomb_n: coulomb,
                viscous_n_s_m: viscous,
                gravity_n: gravity,
                efficiency,
                copper_w_n2: copper,
                servo_factor_motor: factors.0,
                servo_factor_regen: factors.1,
                friction_min_ratio: factors.2,
                ..axis()
            },
        )
}

/// Machines of three such axes.
pub(crate) fn any_machine() -> impl Strategy<Value = Machine> {
    (
        [any_axis(), any_axis(), any_axis()],
        prop_oneof![Just(0.0), 0.0..500.0_f64],
        any::<bool>(),
        any::<bool>(),
    )
        .prop_map(|(axes, base, credit, linuxcnc)| {
            let mut machine = machine(&axes);
            machine.converters[0].base_load_w = base;
            machine.converters[0].credit_regen = credit;
            if linuxcnc {
                machine.controller.planner.arc_rule = ArcRule::LinuxCnc;
            }
            machine
        })
}

/// Straight paths in any direction, short and long, slow and fast.
pub(crate) fn any_delta() -> impl Strategy<Value = [f64; 3]> {
    (
        [-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64],
        prop_oneof![Just(0.01), Just(1.0), Just(300.0)],
    )
        .prop_map(|(delta, scale)| delta.map(|d| d * scale))
        .prop_filter("a path has a length", |delta| {
            delta.iter().any(|d| d.abs() > 1e-6)
        })
}

/// Feeds, rapids among them.
pub(crate) fn any_feed() -> impl Strategy<Value = f64> {
    prop_oneof![Just(f64::INFINITY), 1.0..400.0_f64]
}

/// Geometry of an arc: plane, radius, start and sweep, lift, feed.
pub(crate) type ArcShape = ([usize; 2], f64, [f64; 2], f64, f64);

/// Arcs and helices in all planes, both senses, up to some turns.
pub(crate) fn any_arc() -> impl Strategy<Value = ArcShape> {
    (
        prop_oneof![Just([0, 1]), Just([2, 0]), Just([1, 2])],
        prop_oneof![0.2..5.0_f64, 5.0..300.0_f64],
        -4.0..4.0_f64,
        prop_oneof![-1.0..1.0_f64, -7.0..7.0_f64, 20.0..60.0_f64],
        prop_oneof![Just(0.0), -30.0..30.0_f64],
        1.0..400.0_f64,
    )
        .prop_map(|(plane, radius, start, sweep, lift, feed)| {
            let sweep = if sweep.abs() < 1e-3 { 0.5 } else { sweep };
            (plane, radius, [start, sweep], lift, feed)
        })
}
