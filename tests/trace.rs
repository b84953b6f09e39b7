//! The power over time agrees with peaks, energy and dense sampling, and is
//! never too low.

use crate::rig::{
    Reading, any_arc, any_delta, any_feed, any_machine, arc, axis, dwell, machine, path_power,
    straight,
};
use gwatt::interpret::Move;
use gwatt::machine::{Axis, Machine, RapidPath};
use gwatt::plan::{Overrides, Phase, PhaseKind, Plan, Profile, Trajectory, plan};
use gwatt::power::{Demand, Flow, PowerModel, Slice, Want};
use proptest::prelude::*;

/// Share of the peak power by which a chord of an arc may be too high.
const TOLERANCE: f64 = 1e-3;

fn traced(machine: &Machine, mv: &Move, plan: &Plan, flow: Flow) -> Vec<Slice> {
    PowerModel::new(machine).trace(mv, plan, 0, flow)
}

fn demand(machine: &Machine, mv: &Move, plan: &Plan) -> Demand {
    PowerModel::new(machine).demand(mv, plan, Want::ALL)
}

fn close(a: f64, b: f64, slack: f64) {
    let slack = slack.max(1e-9 * a.abs().max(b.abs()));
    assert!((a - b).abs() <= slack, "{a} is not {b} (by {slack})");
}

/// Duration, peaks and energy of the slices are those of the demand; `above` is
/// how much too high they may be, W.
fn agrees(machine: &Machine, mv: &Move, plan: &Plan, above: f64) {
    let found = demand(machine, mv, plan);
    let [drawn, fed_back] =
        [Flow::Drawn, Flow::FedBack].map(|flow| traced(machine, mv, plan, flow));
    let peak = |slices: &[Slice]| {
        let peaks = slices.iter().map(Slice::peak_w);
        peaks.fold(f64::NEG_INFINITY, f64::max)
    };
    for slices in [&drawn, &fed_back] {
        let lasts: f64 = slices.iter().map(|slice| slice.duration_s).sum();
        close(lasts, plan.duration_s, 1e-12);
    }
    // The search for peaks on arcs is itself high by up to a millionth.
    let near = 2e-6 * found.peak_w.max(found.regen_w) + above;
    close(peak(&drawn), found.peak_w, near);
    close(peak(&fed_back).max(0.0), found.regen_w, near);
    let energy: f64 = drawn.iter().map(Slice::energy_j).sum();
    let scale = 1e-9 * (found.peak_w + found.regen_w) * plan.duration_s;
    assert!(
        energy >= found.energy_j - scale,
        "{energy} J below {}",
        found.energy_j
    );
    let most = found.energy_j + above * plan.duration_s + scale;
    assert!(energy <= most, "{energy} J above {}", found.energy_j);
}

/// The same without servo factors, which energy leaves out.
fn plain(machine: &Machine) -> Machine {
    let mut plain = machine.clone();
    for axis in plain.axes.iter_mut().flatten() {
        axis.servo_factor_motor = 1.0;
        axis.servo_factor_regen = 1.0;
        axis.friction_min_ratio = 1.0;
    }
    plain
}

/// No instant lies above the slices, nor far below them.
fn covers(machine: &Machine, mv: &Move, plan: &Plan, above: f64) {
    for (flow, reading) in [
        (Flow::Drawn, Reading::Motor),
        (Flow::FedBack, Reading::Regen),
    ] {
        let slices = traced(machine, mv, plan, flow);
        let sizes = slices.iter().flat_map(|slice| {
            let ends = [0.0, slice.duration_s].map(|t| slice.power_w(t).abs());
            [slice.peak_w().abs(), ends[0], ends[1]]
        });
        let scale = sizes.fold(1e-9, f64::max);
        let mut start = 0.0;
        for slice in &slices {
            for i in 1..8 {
                let own = slice.duration_s * f64::from(i) / 8.0;
                let powers = path_power(machine, mv, plan, start + own, reading);
                let exact = match flow {
                    Flow::Drawn => powers.0,
                    Flow::FedBack => powers.1.max(0.0),
                };
                let found = match flow {
                    Flow::Drawn => slice.power_w(own),
                    Flow::FedBack => slice.power_w(own).max(0.0),
                };
                // Instants add up with rounding, and powers jump at them.
                if slice.duration_s > 1e-9 {
                    assert!(found >= exact - 1e-6 * scale, "{found} W below {exact}");
                    assert!(
                        found <= exact + above + 1e-6 * scale,
                        "{found} W above {exact}"
                    );
                }
            }
            start += slice.duration_s;
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 150,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(11),
        ..ProptestConfig::default()
    })]

    #[test]
    fn lines_are_exact(machine in any_machine(), delta in any_delta(), feed in any_feed()) {
        let mv = straight(&machine, &delta, feed);
        let plan_of = |machine: &Machine| plan(machine, &mv, Overrides::default());
        covers(&machine, &mv, &plan_of(&machine), 0.0);
        let plain = plain(&machine);
        agrees(&plain, &mv, &plan_of(&plain), 0.0);
    }

    #[test]
    fn independent_axes_are_exact(machine in any_machine(), delta in any_delta()) {
        let mut machine = plain(&machine);
        machine.path.rapid = RapidPath::Independent;
        let mv = straight(&machine, &delta, f64::INFINITY);
        agrees(&machine, &mv, &plan(&machine, &mv, Overrides::default()), 0.0);
    }

    #[test]
    fn arcs_are_covered_closely(machine in any_machine(), shape in any_arc()) {
        let (plane, radius, angles, lift, feed) = shape;
        let mut machine = machine;
        let mv = arc(&machine, plane, radius, angles, lift, feed);
        let plan_of = |machine: &Machine| plan(machine, &mv, Overrides::default());
        // So that the tolerance is a share of what the axes need: not of what is
        // left where they feed each other.
        let mut smooth = plain(&machine);
        smooth.converters[0].credit_regen = false;
        let found = demand(&smooth, &mv, &plan_of(&smooth));
        let size = 1.0 + found.peak_w + found.regen_w;
        smooth.converters[0].peak_power_w = size;
        machine.converters[0].peak_power_w = size;
        let above = TOLERANCE * size;
        covers(&smooth, &mv, &plan_of(&smooth), 2.0 * above);
        agrees(&smooth, &mv, &plan_of(&smooth), above);
        // Where servo factors make a step, it may lie anywhere in a slice.
        covers(&machine, &mv, &plan_of(&machine), f64::INFINITY);
    }
}

#[test]
fn a_dwell_draws_the_base_load() {
    let mut machine = machine(&[axis()]);
    machine.converters[0].base_load_w = 70.0;
    let mv = dwell(&machine, 2.5);
    let found = traced(
        &machine,
        &mv,
        &plan(&machine, &mv, Overrides::default()),
        Flow::Drawn,
    );
    assert_eq!(found, [Slice::constant(2.5, 70.0)]);
}

/// 100 kg from rest at a jerk of 100 m/s³ for 0.1 s, then a curve of constant
/// power; the profile of a controller need not end at rest.
#[test]
fn changing_acceleration_is_covered() {
    let machine = machine(&[Axis {
        coulomb_n: 50.0,
        ..axis()
    }]);
    let mv = straight(&machine, &[1000.0], f64::INFINITY);
    let mut profile = Profile::default();
    let jerk = Phase {
        kind: PhaseKind::ConstantJerk { jerk_mm_s3: 1e5 },
        duration_s: 0.1,
        position_mm: 0.0,
        velocity_mm_s: 0.0,
        end_velocity_mm_s: 500.0,
        accel_mm_s2: 0.0,
    };
    profile.phases.push(jerk);
    let exact = Plan {
        duration_s: 0.1,
        trajectory: Trajectory::Path(profile.clone()),
        ..Plan::rest(0.0)
    };
    // v·F at 0.5 m/s and 10 m/s²; ½·m·v² + 50 N over j·t³/6.
    let found = traced(&machine, &mv, &exact, Flow::Drawn);
    let peak = found.iter().map(Slice::peak_w).fold(0.0, f64::max);
    close(peak, 0.5 * (1000.0 + 50.0), 1e-9);
    let energy: f64 = found.iter().map(Slice::energy_j).sum();
    close(energy, 12.5 + 50.0 * 0.1 / 6.0, 1e-9);
    agrees(&machine, &mv, &exact, 0.0);
    // a = p/v − d from 500 mm/s on, p = 5e6 mm²/s³, d = 0: v² = v₀² + 2·p·t.
    let power = Phase {
        kind: PhaseKind::ConstantPower { power_mm2_s3: 5e6 },
        duration_s: 0.05,
        position_mm: 0.0,
        velocity_mm_s: 500.0,
        end_velocity_mm_s: (250_000.0_f64 + 2.0 * 5e6 * 0.05).sqrt(),
        accel_mm_s2: 1e4,
    };
    let mut profile = Profile::default();
    profile.phases.push(power);
    let curve = Plan {
        duration_s: 0.05,
        trajectory: Trajectory::Path(profile),
        ..Plan::rest(0.0)
    };
    // Inertia takes 500 W, friction 25 W at first and 43 W at last: 1/64 of the
    // difference is lost.
    agrees(&machine, &mv, &curve, 0.6);
}
