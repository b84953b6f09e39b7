//! The default machine and the method's example program.
//!
//! `P_n = ω(ωJ/t + D)` for each axis at its share of the path's speed and
//! acceleration, summed over the axes that start together.

use std::f64::consts::TAU;

use gwatt::machine::{AxisSet, Machine};

/// (J, D, rpm, t) of X, Y, Z as in the file.
const MOTORS: [(f64, f64, f64, f64); 3] = [
    (0.0050, 1.5, 3000.0, 0.12),
    (0.0035, 1.2, 3000.0, 0.12),
    (0.0030, 0.9, 2500.0, 0.12),
];
const LEAD_MM: f64 = 12.0;

/// Peak of a move by these distances, its axes at most at `speed_mm_min`.
fn peak(distances: [f64; 3], speed_mm_min: [f64; 3]) -> f64 {
    let length = distances.iter().map(|d| d * d).sum::<f64>().sqrt();
    let share = distances.map(|d| d.abs() / length);
    let lowest = |limit: &dyn Fn(usize) -> f64| {
        (0..3)
            .filter(|&n| share[n] > 0.0)
            .map(|n| limit(n) / share[n])
            .fold(f64::INFINITY, f64::min)
    };
    // rpm and rpm/s along the path.
    let speed = lowest(&|n| MOTORS[n].2.min(speed_mm_min[n] / LEAD_MM));
    let accel = lowest(&|n| MOTORS[n].2 / MOTORS[n].3);
    (0..3)
        .map(|n| {
            let (inertia, friction, ..) = MOTORS[n];
            let omega = share[n] * speed * TAU / 60.0;
            let alpha = share[n] * accel * TAU / 60.0;
            if omega > 0.0 {
                omega * (alpha * inertia + friction)
            } else {
                0.0
            }
        })
        .sum()
}

const FREE: [f64; 3] = [f64::INFINITY; 3];
const FEED: [f64; 3] = [100.0; 3];

#[test]
fn rapids_of_the_example_do_not_fit_and_feeds_do() {
    let (machine, _) = Machine::load("three-axis").unwrap();
    let limit = machine.converters[0].peak_power_w * (1.0 - machine.limits.margin);
    assert!((limit - 3600.0).abs() < 1e-9);
    let blocks = [
        ("N99 G0", peak([0.0, 0.0, 100.0], FREE)),
        ("N100 G1", peak([500.0, 300.0, 0.0], FEED)),
        ("N101 G0", peak([-500.0, -300.0, -100.0], FREE)),
        ("N102 G1", peak([400.0, 0.0, 400.0], FEED)),
        ("N103 G0", peak([-350.0, 50.0, 0.0], FREE)),
    ];
    let lines: Vec<String> = blocks
        .iter()
        .map(|(n, p)| format!("{n} {p:.0} W"))
        .collect();
    insta::assert_snapshot!(lines.join("\n"), @r"
    N99 G0 1949 W
    N100 G1 16 W
    N101 G0 6001 W
    N102 G1 17 W
    N103 G0 4696 W
    ");
    let fits: Vec<bool> = blocks.iter().map(|(_, power)| *power <= limit).collect();
    assert_eq!(fits, [true, true, false, true, false]);
}

#[test]
fn presets_make_their_combinations_fit() {
    let (machine, _) = Machine::load("three-axis").unwrap();
    let limit = machine.converters[0].peak_power_w * (1.0 - machine.limits.margin);
    for preset in &machine.presets {
        assert!(preset.has_speed && !preset.has_accel);
        let speeds = [0, 1, 2].map(|axis| preset.speed_mm_s[axis] * 60.0);
        // Many directions, the diagonal of the permitted speeds among them.
        let chosen = |axis: usize, weight: f64| {
            if preset.axes.contains(axis) {
                weight * speeds[axis]
            } else {
                0.0
            }
        };
        for (a, b) in [(1.0, 1.0), (1.0, 0.2), (0.2, 1.0), (0.5, 0.7), (0.02, 0.6)] {
            let distances = [chosen(0, 1.0), chosen(1, a), chosen(2, b)];
            let power = peak(distances, speeds);
            assert!(power <= limit, "{}: {power}", preset.axes);
        }
        // All axes at preset speed and full acceleration: no direction needs more.
        let worst: f64 = preset
            .axes
            .iter()
            .map(|n| {
                let (inertia, friction, rpm, time) = MOTORS[n];
                let omega = speeds[n] / LEAD_MM * TAU / 60.0;
                omega * (rpm * TAU / 60.0 / time * inertia + friction)
            })
            .sum();
        assert!(
            worst <= limit && worst > 0.9 * limit,
            "{}: {worst}",
            preset.axes
        );
    }
}

#[test]
fn presets_cover_what_the_example_needs() {
    let (machine, _) = Machine::load("three-axis").unwrap();
    let set = |axes: &[usize]| {
        let mut set = AxisSet::default();
        for &axis in axes {
            set.insert(axis);
        }
        set
    };
    for axes in [set(&[0, 1, 2]), set(&[0, 1])] {
        assert!(machine.presets.iter().any(|preset| preset.axes == axes));
    }
}
