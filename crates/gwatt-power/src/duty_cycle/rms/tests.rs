use super::*;

fn rms_w(window_s: f64, slices: &[Slice]) -> f64 {
    let mut rms = Rms::new(window_s);
    let mut time_s = 0.0;
    for slice in slices {
        rms.take(slice, time_s, Place::default());
        time_s += slice.duration_s;
    }
    rms.result().value
}

#[test]
fn a_window_reaches_into_the_next_run() {
    // 3 kW for 1 s at both ends of 20 s, else nothing: 2 s of a window of 10 s.
    let slices = [
        Slice::constant(1.0, 3000.0),
        Slice::constant(18.0, 0.0),
        Slice::constant(1.0, 3000.0),
    ];
    let mut rms = Rms::new(10.0);
    for slice in &slices {
        rms.take(slice, 0.0, Place::default());
    }
    let found = rms.repeated(0.0).value;
    let exact = (2.0 * 9e6_f64 / 10.0).sqrt();
    assert!(
        found >= exact - 1e-6 && found <= exact * 1.001,
        "{found} {exact}"
    );
    // 1 s of 3 s: 4 s of a window of 10 s.
    let mut rms = Rms::new(10.0);
    for slice in [Slice::constant(1.0, 3000.0), Slice::constant(2.0, 0.0)] {
        rms.take(&slice, 0.0, Place::default());
    }
    let found = rms.repeated(0.0).value;
    let exact = (4.0 * 9e6_f64 / 10.0).sqrt();
    assert!(
        found >= exact - 1e-6 && found <= exact * 1.001,
        "{found} {exact}"
    );
}

#[test]
fn a_trapezoid_shorter_than_the_window() {
    // 0 → 600 W in 1 s, 300 W for 2 s, then nothing for 1 s: P²·t is
    // 120 000 + 180 000 W²·s over 4 s.
    let slices = [
        Slice::linear(1.0, 0.0, 600.0),
        Slice::constant(2.0, 300.0),
        Slice::linear(1.0, -200.0, 0.0),
    ];
    assert!((rms_w(180.0, &slices) - 75_000.0_f64.sqrt()).abs() < 1e-9);
}

#[test]
fn a_burst_in_a_long_program() {
    // 3 kW for 2 s in a window of 10 s, else 1 kW: (18e6 + 8e6)/10.
    let slices = [
        Slice::constant(100.0, 1000.0),
        Slice::constant(2.0, 3000.0),
        Slice::constant(100.0, 1000.0),
    ];
    let (found, exact) = (rms_w(10.0, &slices), 2.6e6_f64.sqrt());
    assert!(found >= exact - 1e-9);
    assert!(found * found <= exact * exact + 9e6 / 4096.0);
}

#[test]
fn never_below_any_window() {
    // Ramps of many lengths, against windows that end anywhere.
    let mut slices = Vec::new();
    let mut seed = 1_u32;
    for _ in 0..400 {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let a = f64::from(seed >> 20);
        slices.push(Slice::linear(1e-3 + a * 1e-4, a, 4096.0 - a));
    }
    let found = rms_w(2.0, &slices);
    let dt = 1e-3;
    let mut squares = Vec::new();
    let (mut index, mut into) = (0, 0.0);
    while index < slices.len() {
        squares.push(slices[index].power_w(into) * slices[index].power_w(into) * dt);
        into += dt;
        while index < slices.len() && into >= slices[index].duration_s {
            into -= slices[index].duration_s;
            index += 1;
        }
    }
    let mut worst = 0.0_f64;
    for start in 0..squares.len() - 2000 {
        worst = worst.max(squares[start..start + 2000].iter().sum());
    }
    let sampled = (worst / 2.0).sqrt();
    assert!(found >= sampled * 0.999, "{found} {sampled}");
    assert!(found <= sampled * 1.01, "{found} {sampled}");
}

#[test]
fn a_long_rest_costs_nothing() {
    let slices = [
        Slice::constant(1.0, 2000.0),
        Slice::constant(1e9, 100.0),
        Slice::constant(1.0, 2000.0),
    ];
    // 4e6 W²·s in the first window.
    let exact = (4e6 + 9.0 * 1e4) / 10.0;
    let found = rms_w(10.0, &slices);
    assert!((found * found - exact).abs() < 4e6 / 4096.0);
}

/// Each way of counting against the exact largest mean, which lies at an end.
#[test]
fn a_slice_of_days_costs_no_more_than_its_ends() {
    let between = |from: f64, to: f64| (from * from + from * to + to * to) / 3.0;
    // Too high by one cell at most.
    let most = 1.0 + 1.0 / 4096.0 + 1e-9;
    // 1 to 3 kW in 30 years, and back: the last and the first 10 s. What is fed
    // back does not count.
    let years_s = 1e9;
    for (first, last, worst) in [
        (1000.0, 3000.0, 3000.0),
        (3000.0, 1000.0, 3000.0),
        (-3000.0, 2000.0, 2000.0),
    ] {
        let found = rms_w(10.0, &[Slice::linear(years_s, first, last)]);
        let share = (found / worst) * (found / worst);
        assert!(share >= 1.0 - 1e-7 && share <= most, "{found}");
    }
    // 2 kW before a ramp from 1 kW: of the window that holds both nothing is lost.
    let slices = [
        Slice::constant(5.0, 2000.0),
        Slice::linear(1e5, 1000.0, 500.0),
    ];
    let ramp = between(1000.0, 1000.0 - 500.0 * 5.0 / 1e5);
    let exact = (5.0 * 4e6 + 5.0 * ramp) / 10.0;
    let found = rms_w(10.0, &slices).powi(2);
    assert!(
        found >= exact - 1e-6 && found <= exact + 4e6 / 4096.0,
        "{found} {exact}"
    );
    // The same after a ramp that falls from 900 W.
    let slices = [
        Slice::linear(1e5, 900.0, 500.0),
        Slice::constant(5.0, 2000.0),
    ];
    let ramp = between(500.0 + 400.0 * 5.0 / 1e5, 500.0);
    let exact = (5.0 * 4e6 + 5.0 * ramp) / 10.0;
    let found = rms_w(10.0, &slices).powi(2);
    assert!(
        found >= exact - 1e-6 && found <= exact + 4e6 / 4096.0,
        "{found} {exact}"
    );
}

/// A power that is no straight line of time is nowhere counted lower, and
/// higher by one of 16 steps at most.
#[test]
fn a_curve_over_days_counts_as_steps() {
    let parabola = Slice {
        duration_s: 1e7,
        from: 0.0,
        to: 1.0,
        power: crate::polynomial::Polynomial([0.0, 4000.0, -4000.0, 0.0, 0.0]),
    };
    // 1 kW in the middle, where the two steps next to it meet, and one cell.
    let most = 1.0 + 1.0 / 4096.0 + 1e-9;
    let share = rms_w(10.0, &[parabola]).powi(2) / 1e6;
    assert!(share >= 1.0 && share <= most, "{share}");
    let rising = Slice {
        power: crate::polynomial::Polynomial([0.0, 0.0, 1600.0, 0.0, 0.0]),
        ..parabola
    };
    let share = rms_w(10.0, &[rising]).powi(2) / 2.56e6;
    assert!(share >= 1.0 && share <= most, "{share}");
}

#[test]
fn of_a_moment_the_largest_power_counts() {
    let slices = [Slice::constant(1e5, 10.0), Slice::linear(0.1, 0.0, 700.0)];
    assert!((rms_w(1e-9, &slices) - 700.0).abs() < 1e-9);
}

#[test]
fn a_power_that_may_last_counts_for_the_whole_window() {
    let mut rms = Rms::new(10.0);
    rms.take(&Slice::constant(100.0, 500.0), 0.0, Place::default());
    rms.last(800.0, 100.0, Place::default());
    rms.take(&Slice::constant(2.0, 3000.0), 100.0, Place::default());
    let exact = (2.0 * 9e6 + 8.0 * 6.4e5) / 10.0;
    let found = rms.result().value;
    assert!(found * found >= exact - 1e-6);
    // What came before may be counted besides: 500 W for 8 s of 10.
    assert!(found * found <= exact + 2e5 + 9e6 / 4096.0);
    let mut short = Rms::new(10.0);
    short.last(800.0, 0.0, Place::default());
    assert_eq!(short.result().value, 800.0);
    assert!(short.result().lasting);
}
