//! Logs of known power curves, laid over them: what a factor in the log comes out as.

use gwatt_identify::overlay::{
    Agreement, AxisCurve, AxisTrace, BlockPeaks, Curve, Overlay, PowerTrace, overlay,
};

/// Numbers that are the same each time.
struct Random(u64);

impl Random {
    /// Between 0 and 1.
    fn share(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.share()
    }

    /// Of a normal distribution with a deviation of 1.
    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * libm::log(1.0 - self.share())).sqrt();
        radius * libm::cos(std::f64::consts::TAU * self.share())
    }
}

/// Moves of axes: ramps up to a peak, from which the power drops to friction, and from that to
/// rest while the axes brake.
fn program(random: &mut Random, moves: u64, ramps_s: [f64; 2], peaks_w: [f64; 2]) -> Curve {
    let mut curve = Curve::new(150.0);
    let mut t = 0.0;
    curve.push(t, 150.0, 1);
    for block in 1..=moves {
        let ramp_s = random.between(ramps_s[0], ramps_s[1]);
        let peak_w = random.between(peaks_w[0], peaks_w[1]);
        let friction_w = random.between(250.0, 600.0);
        for (lasts_s, power_w) in [
            (ramp_s, peak_w),
            (0.0, friction_w),
            (random.between(0.05, 0.8), friction_w),
            (0.0, 150.0),
            (random.between(0.1, 0.5), 150.0),
        ] {
            t += lasts_s;
            curve.push(t, power_w, block);
        }
    }
    curve
}

/// How a meter records a curve.
#[derive(Debug, Clone, Copy)]
struct Meter {
    step_s: f64,
    /// Samples that are averaged over.
    averages: f64,
    start_s: f64,
    pace: f64,
    factor: f64,
    /// As a share of the largest power.
    noise: f64,
}

impl Meter {
    fn records(&self, curve: &Curve, random: &mut Random) -> PowerTrace {
        let width_s = (self.averages * self.step_s).max(1e-7);
        let (mut from, mut to) = (curve.reader(), curve.reader());
        let end_s = self.start_s + self.pace * curve.duration_s() + 2.0;
        let mut log = PowerTrace::default();
        for k in 0..(end_s / self.step_s) as u64 {
            let t = k as f64 * self.step_s;
            let at = |t: f64| (t - self.start_s) / self.pace;
            let energy_j = to.energy_j(at(t)) - from.energy_j(at(t - width_s));
            let power_w = self.factor * energy_j * self.pace / width_s;
            log.time_s.push(t);
            log.power_w
                .push(power_w + 5000.0 * self.noise * random.normal());
        }
        log
    }
}

fn found(curve: &Curve, meter: Meter, random: &mut Random) -> Overlay {
    overlay(curve, &[], &meter.records(curve, random)).unwrap()
}

/// What the log of a factor comes out as: not below it by more than the stated error, and above
/// it by no more than the meter's noise at the least power that counts as a peak, half of the
/// largest.
fn holds(meter: Meter, it: &Overlay) {
    let case = format!("{meter:?}: {:?} ± {}", it.factor, it.factor_error);
    let factor = meter.factor.max(1.0);
    assert!(it.factor.seen + it.factor_error >= factor, "{case}");
    assert!(it.factor.seen >= it.gain, "{case} {}", it.gain);
    assert!(it.margin() >= 1.0 - 1.0 / it.gain, "{case}");
    let noise = 10.0 * meter.noise / factor;
    assert!(it.factor.seen <= factor * (1.01 + noise), "{case}");
    assert!(it.factor_error <= 0.01 + noise, "{case}");
    assert!((it.gain / meter.factor - 1.0).abs() < 0.02, "{case}");
}

#[test]
fn a_factor_is_found_whatever_the_meter() {
    let mut random = Random(11);
    for averages in [0.0, 1.0, 4.0, 15.0] {
        for step_s in [0.001, 0.01, 0.02, 0.05, 0.1] {
            for noise in [0.0, 0.01, 0.03] {
                // As blurred as a pause is long, or long to look at.
                if averages * step_s > 0.2 || step_s < 0.01 && noise == 0.01 {
                    continue;
                }
                let curve = program(&mut random, 20, [0.06, 0.4], [1000.0, 5000.0]);
                let meter = Meter {
                    step_s,
                    averages,
                    start_s: random.between(0.5, 4.0),
                    pace: random.between(0.97, 1.03),
                    factor: random.between(0.8, 1.5),
                    noise,
                };
                let it = found(&curve, meter, &mut random);
                assert!(it.agreement().is_of_the_program(), "{meter:?}");
                holds(meter, &it);
            }
        }
    }
}

const POINTS: Meter = Meter {
    step_s: 0.02,
    averages: 0.0,
    start_s: 2.345,
    pace: 1.03,
    factor: 1.3,
    noise: 0.0005,
};

/// Ramps of 30 to 60 ms have one sample or two of 50 ms: what is said of peaks is what all of the
/// log shows.
#[test]
fn short_ramps_leave_the_slope() {
    let mut random = Random(5);
    let curve = program(&mut random, 40, [0.03, 0.06], [1000.0, 5000.0]);
    let meter = Meter {
        step_s: 0.05,
        ..POINTS
    };
    let it = found(&curve, meter, &mut random);
    assert_eq!(it.agreement(), Agreement::SampledSlowly);
    assert!(2 * it.short_peaks > it.factor.peaks, "{}", it.short_peaks);
    holds(meter, &it);
    // The same program with samples that are dense enough.
    let meter = Meter {
        step_s: 0.005,
        ..POINTS
    };
    let it = found(&curve, meter, &mut random);
    assert_eq!(it.agreement(), Agreement::Good);
    assert_eq!(it.short_peaks, 0);
    holds(meter, &it);
}

/// One peak of 30 draws 30 % more, the others as predicted: no sample meets its top.
#[test]
fn one_peak_that_exceeds_counts_in_full() {
    for step_s in [0.01, 0.02] {
        let mut random = Random(8);
        let curve = program(&mut random, 30, [0.12, 0.3], [3000.0, 5000.0]);
        let meter = Meter {
            step_s,
            factor: 1.0,
            ..POINTS
        };
        let mut log = meter.records(&curve, &mut random);
        let highest = curve.blocks()[12];
        for (t, w) in log.time_s.iter().zip(&mut log.power_w) {
            let planned_s = (t - meter.start_s) / meter.pace;
            if (highest.1..highest.2).contains(&planned_s) {
                *w *= 1.3;
            }
        }
        let it = overlay(&curve, &[], &log).unwrap();
        let case = format!("{step_s}: {:?} ± {}", it.factor, it.factor_error);
        assert!((it.factor.seen - 1.3).abs() < 0.02, "{case}");
        let worst = it.blocks.iter().max_by(|a, b| {
            let excess = |it: &&BlockPeaks| it.measured_w - it.predicted_w;
            excess(a).total_cmp(&excess(b))
        });
        assert_eq!(worst.unwrap().block, highest.0, "{case}");
    }
}

/// The acceleration of an axis takes 1.25 times as much, its friction does not: whatever the
/// spacing, the factor of the axis is found, and next to it no margin is needed.
#[test]
fn the_factor_of_an_axis_is_found_between_samples() {
    for step_s in [0.002, 0.02, 0.05] {
        let mut random = Random(3);
        let [mut whole, mut accel, mut truth] = [0.0; 3].map(Curve::new);
        let mut t = 0.0;
        for block in 1..=30 {
            let (ramp_s, peak_w) = (random.between(0.15, 0.4), random.between(1500.0, 4000.0));
            let pause_s = random.between(0.2, 0.7);
            // Half of the friction's power before the ramp's end, all of it after.
            for (lasts_s, accel_w, friction_w) in [
                (0.0, 0.0, 0.0),
                (ramp_s, peak_w, 300.0),
                (0.0, 0.0, 300.0),
                (pause_s, 0.0, 300.0),
                (0.0, 0.0, 0.0),
                (pause_s, 0.0, 0.0),
            ] {
                t += lasts_s;
                whole.push(t, accel_w + friction_w, block);
                accel.push(t, accel_w, block);
                truth.push(t, 1.25 * accel_w + friction_w, block);
            }
        }
        let meter = Meter {
            step_s,
            factor: 1.0,
            ..POINTS
        };
        let mut log = meter.records(&truth, &mut random);
        log.axes.push(AxisTrace {
            letter: 'X',
            power_w: log.power_w.clone(),
        });
        let axis = AxisCurve {
            letter: 'X',
            power: whole.clone(),
            accel,
        };
        let it = overlay(&whole, &[axis], &log).unwrap();
        let found = it.axes[0];
        assert!((found.motor - 1.25).abs() < 0.02, "{step_s}: {found:?}");
        let beyond = it.margin_beyond_axes();
        assert!(beyond < 0.01, "{step_s}: {beyond}");
    }
}
