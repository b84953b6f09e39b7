//! Limits of a converter over time: hand-worked cases, and what commands make of
//! them.

use crate::rig::{axis, dwell, machine, straight};
use gwatt::interpret::Move;
use gwatt::machine::{Brake, Capacitor, Continuous, Converter, Machine, Overload, PathMode};
use gwatt::power::{Assessment, Assessor, Certificate, Measure, Rating, Want};

use crate::near::assert_near;

/// X alone: 100 kg at 5 m/s² to 0.5 m/s. Its ramp lasts 0.1 s, in which power
/// rises evenly to 250 W; nothing is drawn at speed, and braking gives it all
/// back. 1 kW may be drawn, 500 W fed back.
fn one_axis() -> Machine {
    machine(&[axis()])
}

/// 0.5 m: 1.1 s.
fn rapid(machine: &Machine) -> Move {
    straight(machine, &[500.0], f64::INFINITY)
}

fn judged(
    machine: &Machine,
    moves: &[Move],
    as_for: Option<Certificate>,
) -> (Vec<Rating>, Vec<Assessment>) {
    let mut assessor = Assessor::new(machine, as_for, Want::PEAKS).watching();
    let mut found = Vec::new();
    for (index, mv) in moves.iter().enumerate() {
        let mut mv = mv.clone();
        mv.line = index as u64 + 1;
        assessor.push(&mv, b"", &mut |_, judged, _| found.push(*judged));
    }
    assessor.finish(&mut |_, judged, _| found.push(*judged));
    (assessor.ratings(), found)
}

/// The only limit over time of the machine.
fn rating(machine: &Machine, moves: &[Move]) -> Rating {
    let (ratings, _) = judged(machine, moves, None);
    assert_eq!(ratings.len(), 1, "{ratings:?}");
    ratings[0]
}

#[track_caller]
fn close(found: f64, expected: f64) {
    assert_near(found, expected, 1e-8 * expected.abs().max(1e-3));
}

fn continuous(power_w: f64, window_s: f64) -> Continuous {
    Continuous { power_w, window_s }
}

#[test]
fn nothing_is_rated_without_a_limit() {
    let machine = one_axis();
    assert!(judged(&machine, &[rapid(&machine)], None).0.is_empty());
}

#[test]
fn continuous_power_is_the_root_of_the_mean_square() {
    // ∫P² over the ramp is 250²·0.1/3; the program lasts 1.1 s.
    let mut machine = one_axis();
    let exact = (250.0 * 250.0 * 0.1 / 3.0 / 1.1_f64).sqrt();
    machine.converters[0].ratings.continuous = Some(continuous(exact, 180.0));
    let found = rating(&machine, &[rapid(&machine)]);
    assert_eq!(found.measure, Measure::Continuous { window_s: 180.0 });
    close(found.value, exact);
    assert!(found.fits());
    machine.converters[0].ratings.continuous = Some(continuous(exact * 0.9999, 180.0));
    assert!(!rating(&machine, &[rapid(&machine)]).fits());
}

#[test]
fn continuous_power_takes_the_worst_window() {
    // 40 s of 60 W, and a ramp in the middle of it; in the worst second it adds
    // ∫((P + 60)² − 60²) of a ramp to 250 W in 0.1 s.
    let mut machine = one_axis();
    machine.converters[0].base_load_w = 60.0;
    machine.converters[0].ratings.continuous = Some(continuous(200.0, 1.0));
    let dwell = dwell(&machine, 20.0);
    let found = rating(&machine, &[dwell.clone(), rapid(&machine), dwell]);
    let exact = 60.0 * 60.0 + 250.0 * 250.0 * 0.1 / 3.0 + 60.0 * 250.0 * 0.1;
    assert!(found.value * found.value >= exact);
    assert!(found.value * found.value <= exact + 310.0 * 310.0 / 4096.0);
    assert_eq!(found.line, 2);
    assert!(found.time_s > 20.0 && found.time_s < 21.1);
}

#[test]
fn an_overload_may_last_as_long_as_permitted() {
    // Above 125 W for the second half of the ramp, 0.05 s.
    let entry = |seconds| Overload {
        power_w: 250.0,
        seconds,
        every_s: 10.0,
    };
    let mut machine = one_axis();
    let overload = |machine: &mut Machine, seconds| {
        machine.converters[0].ratings.overload = vec![entry(seconds)];
        machine.converters[0].ratings.continuous = Some(continuous(125.0, 10.0));
    };
    for (seconds, fits) in [(0.05, true), (0.04999, false), (0.1, true)] {
        overload(&mut machine, seconds);
        let (ratings, _) = judged(&machine, &[rapid(&machine)], None);
        close(ratings[0].value, 0.05);
        assert_eq!(ratings[0].fits(), fits);
        assert_eq!(ratings[0].line, 1);
        close(ratings[0].time_s, 0.1);
    }
    // Two ramps within 10 s, and with a dwell between them, not.
    overload(&mut machine, 0.05);
    let twice = [rapid(&machine), rapid(&machine)];
    close(judged(&machine, &twice, None).0[0].value, 0.1);
    let apart = [rapid(&machine), dwell(&machine, 9.0), rapid(&machine)];
    close(judged(&machine, &apart, None).0[0].value, 0.05);
}

#[test]
fn each_entry_of_the_curve_counts_from_the_one_below() {
    let entry = |power_w, seconds| Overload {
        power_w,
        seconds,
        every_s: 10.0,
    };
    let mut machine = one_axis();
    machine.limits.margin = 0.2;
    machine.converters[0].ratings.overload = vec![entry(300.0, 0.02), entry(250.0, 0.06)];
    machine.converters[0].ratings.continuous = Some(continuous(125.0, 10.0));
    let (ratings, _) = judged(&machine, &[rapid(&machine)], None);
    // Above 0.8·250 W and above 0.8·125 W, of 250 W.
    close(ratings[0].value, 0.02);
    close(ratings[1].value, 0.06);
    assert!(ratings[0].fits() && ratings[1].fits());
    close(ratings[2].limit, 100.0);
}

fn capacitor(capacitance_f: f64) -> Capacitor {
    Capacitor {
        capacitance_f,
        nominal_v: 100.0,
        min_v: Some(80.0),
        max_v: None,
    }
}

#[test]
fn the_capacitor_carries_a_short_peak() {
    // 150 W from the converter: beyond it 100 W at the end of 40 ms, 2 J.
    // ½·C·(100² − 80²) = 1800·C.
    let mut machine = one_axis();
    machine.converters[0].peak_power_w = 150.0;
    let enough = 2.0 / 1800.0;
    for (capacitance_f, fits) in [(enough, true), (0.999 * enough, false)] {
        machine.converters[0].ratings.capacitor = Some(capacitor(capacitance_f));
        let found = rating(&machine, &[rapid(&machine)]);
        assert_eq!(found.measure, Measure::LowestVoltage);
        assert_eq!(found.fits(), fits);
        close(found.time_s, 0.1);
        close(0.5 * capacitance_f * (1e4 - found.value * found.value), 2.0);
    }
    // The peak itself passes only where the capacitor may be counted on.
    let fits = |machine: &Machine| {
        judged(machine, &[rapid(machine)], None).1[0]
            .demand
            .load_ratio
    };
    assert!(fits(&machine) > 1.0);
    machine.converters[0].ratings.credit_capacitance = true;
    assert!(fits(&machine) <= 1.0);
}

#[test]
fn a_capacitor_that_is_counted_on_keeps_its_margin() {
    // 150·0.9 W, so 115 W beyond at the end of 46 ms, and 0.9 of its energy.
    let mut machine = one_axis();
    machine.limits.margin = 0.1;
    machine.converters[0].peak_power_w = 150.0;
    machine.converters[0].ratings.capacitor = Some(capacitor(1e-2));
    let found = rating(&machine, &[rapid(&machine)]);
    let lacks = 0.5 * 115.0 * 0.046;
    close(0.9 * 0.5 * 1e-2 * (1e4 - found.value * found.value), lacks);
}

#[test]
fn while_the_capacitor_charges_the_converter_is_loaded() {
    // Above 100 W for 60 ms, then 0 W drawn at speed: 4.5 J at 100 W take 45 ms
    // more. So it delivers more than 99 W for 60 + 0.4 + 45 ms.
    let mut machine = one_axis();
    machine.converters[0].peak_power_w = 100.0;
    let ratings = &mut machine.converters[0].ratings;
    ratings.capacitor = Some(capacitor(1.0));
    ratings.credit_capacitance = true;
    ratings.continuous = Some(continuous(99.0, 10.0));
    ratings.overload = vec![Overload {
        power_w: 100.0,
        seconds: 1.0,
        every_s: 10.0,
    }];
    let (found, _) = judged(&machine, &[rapid(&machine)], None);
    close(
        found[0].value,
        (0.1 - 99.0 / 2500.0) + 0.5 * 150.0 * 0.06 / 100.0,
    );
}

#[test]
fn what_is_fed_back_heats_the_resistor_and_lifts_the_voltage() {
    // Braking from 250 W to 0 in 0.1 s. Beyond 50 W: 80 ms, 8 J.
    let mut machine = one_axis();
    for (energy_j, fits) in [(8.0, true), (7.99, false)] {
        machine.converters[0].ratings.brake = Some(Brake {
            power_w: 50.0,
            energy_j,
        });
        let found = rating(&machine, &[rapid(&machine)]);
        assert_eq!(found.measure, Measure::Brake { power_w: 50.0 });
        close(found.value, 8.0);
        assert_eq!(found.fits(), fits);
        close(found.time_s, 1.08);
    }
    // Beyond 100 W, which is all that may be fed back: 60 ms, 4.5 J.
    machine.converters[0].ratings.brake = None;
    machine.converters[0].regen_power_w = Some(100.0);
    machine.converters[0].ratings.capacitor = Some(Capacitor {
        capacitance_f: 1e-3,
        nominal_v: 100.0,
        min_v: None,
        max_v: Some(140.0),
    });
    let found = rating(&machine, &[rapid(&machine)]);
    assert_eq!(found.measure, Measure::HighestVoltage);
    close(found.value, (1e4 + 9e3_f64).sqrt());
    assert!(found.fits());
}

#[test]
fn heat_adds_up_and_goes() {
    // Beyond 5 W for 98 ms each time. What is left of the braking, 2 ms, and the
    // next second take heat away.
    let mut machine = one_axis();
    machine.converters[0].ratings.brake = Some(Brake {
        power_w: 5.0,
        energy_j: 100.0,
    });
    let energy = |power: f64| 0.5 * (250.0 - power) * 0.1 * (250.0 - power) / 250.0;
    let (once, between) = (energy(5.0), 5.0 * (0.5 * 0.002 + 1.0));
    let short = rapid(&machine);
    let found = rating(&machine, &[short.clone(), short]);
    close(found.value, once - between + once);
}

#[test]
fn motion_that_is_not_known_in_time_may_last() {
    let mut machine = one_axis();
    machine.converters[0].ratings.continuous = Some(continuous(240.0, 180.0));
    let mut mv = rapid(&machine);
    mv.path_mode = PathMode::LookAhead;
    let (found, judged_moves) = judged(&machine, &[mv.clone()], Some(Certificate::Robust));
    assert_eq!(judged_moves[0].certificate, Certificate::Robust);
    assert!(found[0].lasting && !found[0].fits());
    close(found[0].value, 250.0);
    machine.converters[0].ratings.continuous = Some(continuous(250.0, 180.0));
    let (found, _) = judged(&machine, &[mv.clone()], Some(Certificate::Robust));
    assert!(found[0].fits());
    // It lasts 1.1 s at most, and 1 s at least.
    let ratings = &mut machine.converters[0].ratings;
    ratings.brake = Some(Brake {
        power_w: 100.0,
        energy_j: 164.0,
    });
    ratings.overload = vec![Overload {
        power_w: 250.0,
        seconds: 1.0,
        every_s: 10.0,
    }];
    ratings.continuous = Some(continuous(125.0, 180.0));
    let (found, _) = judged(&machine, &[mv.clone()], Some(Certificate::Robust));
    close(found[0].value, 1.1);
    close(found[1].value, 250.0);
    close(found[2].value, 150.0 * 1.1);
    assert!(found.iter().all(|found| found.lasting && !found.fits()));
    // Long after it and before it, its square over 1.1 s counts in 1 s.
    let rest = dwell(&machine, 9.0);
    mv.kind = gwatt::interpret::MoveKind::Feed;
    mv.feed_mm_s = 500.0;
    let (found, judged_moves) = judged(&machine, &[mv, rest], None);
    assert_eq!(judged_moves[0].certificate, Certificate::Robust);
    close(found[1].value, (250.0 * 250.0 * 1.1 / 10.0_f64).sqrt());
}

#[test]
fn a_start_that_is_not_known_may_last_too() {
    let mut machine = one_axis();
    machine.converters[0].ratings.continuous = Some(continuous(100.0, 180.0));
    let mut mv = rapid(&machine);
    mv.unknown_start.insert(0);
    let found = rating(&machine, &[mv]);
    assert!(found.lasting && !found.fits());
}

#[test]
fn each_converter_has_its_own_limits() {
    let mut machine = machine(&[axis(), axis()]);
    machine.converters[0].axes.0 = 0b01;
    machine.converters[0].ratings.continuous = Some(continuous(100.0, 180.0));
    let second = Converter {
        name: "second".into(),
        axes: gwatt::machine::AxisSet(0b10),
        base_load_w: 7.0,
        ..machine.converters[0].clone()
    };
    machine.converters.push(second);
    let (found, _) = judged(&machine, &[rapid(&machine)], None);
    assert_eq!(found.len(), 2);
    close(found[0].value, (250.0 * 250.0 * 0.1 / 3.0 / 1.1_f64).sqrt());
    close(found[1].value, 7.0);
    assert_eq!((found[0].converter, found[1].converter), (0, 1));
}
