//! Random programs with a spindle.

use std::fmt::Write as _;

use gwatt::plan::SpindleDrive;
use gwatt::plan::period::{Motion, Ramp};
use gwatt::power::SpindlePower;
use proptest::prelude::*;

use super::{machine, rows};

/// One step of a random program.
#[derive(Debug, Clone)]
enum Step {
    Rapid(i32),
    Feed(i32, u16),
    Speed(u16),
    Turn(bool),
    Stop,
    Wait(u8),
}

fn step() -> impl proptest::strategy::Strategy<Value = Step> {
    prop_oneof![
        4 => (-900..900_i32).prop_map(Step::Rapid),
        3 => (-900..900_i32, 500..30_000_u16).prop_map(|(x, f)| Step::Feed(x, f)),
        3 => (0..3000_u16).prop_map(Step::Speed),
        2 => any::<bool>().prop_map(Step::Turn),
        1 => Just(Step::Stop),
        1 => (0..10_u8).prop_map(Step::Wait),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 64,
        ..ProptestConfig::default()
    })]

    /// No planned peak is below what a dense sampling of axes and spindle finds,
    /// nor noticeably above it.
    #[test]
    fn sampled_sums_stay_below_the_peaks(
        steps in prop::collection::vec(step(), 1..20),
        credit in any::<bool>(),
        jerk in prop::sample::select(vec![0.0, 0.1, 0.4]),
    ) {
        let converter = format!("credit_regen = {credit}");
        let spindle = format!("friction_nm = 3\nbase_rpm = 1000\nwait = false\njerk_time_s = {jerk:?}\nefficiency = 0.9");
        let machine = machine("iso", &converter, &spindle, "");
        let mut program = String::from("S100\n");
        // When the spindle gets which speed: the number of moves before.
        let (mut rpm, mut sign, mut moves) = (100.0, 0.0, 0_usize);
        let mut commands = vec![(0, 0.0)];
        for step in &steps {
            match step {
                Step::Rapid(x) => { let _ = writeln!(program, "G0 X{x}"); }
                Step::Feed(x, f) => { let _ = writeln!(program, "G1 X{x} F{f}"); }
                Step::Speed(s) => { rpm = f64::from(*s); let _ = writeln!(program, "S{s}"); }
                Step::Turn(back) => {
                    sign = if *back { -1.0 } else { 1.0 };
                    let _ = writeln!(program, "M{}", if *back { 4 } else { 3 });
                }
                Step::Stop => { sign = 0.0; let _ = writeln!(program, "M5"); }
                Step::Wait(n) => { let _ = writeln!(program, "G4 P{:.1}", f64::from(*n) / 10.0); }
            }
            if matches!(step, Step::Rapid(_) | Step::Feed(..) | Step::Wait(_)) {
                moves += 1;
            } else {
                commands.push((moves, sign * rpm));
            }
        }
        let found = rows(&machine, &program);
        prop_assert_eq!(found.len(), moves);
        let data = machine.spindle.as_ref().unwrap();
        let drive = SpindleDrive::new(data).unwrap();
        let power = SpindlePower::new(data);
        let (mut ramp, mut since) = (Ramp::new(Motion::default(), 0.0, drive.limits()), 0.0);
        let mut x = 0.0_f64;
        let mut inputs = steps.iter().filter(|step| {
            matches!(step, Step::Rapid(_) | Step::Feed(..) | Step::Wait(_))
        });
        for (index, row) in found.iter().enumerate() {
            let asked = commands.iter().rev().find(|command| command.0 == index);
            if let Some((_, target)) = asked {
                let (motion, _) = ramp.at(since);
                ramp = Ramp::new(motion, *target, drive.limits());
                since = 0.0;
            }
            let (to, cap) = match inputs.next() {
                Some(Step::Rapid(to)) => (f64::from(*to), 1.0),
                Some(Step::Feed(to, feed)) => (f64::from(*to), f64::from(*feed) / 60_000.0),
                _ => (x, 1.0),
            };
            let length = (to - x).abs() * 1e-3;
            x = to;
            let top = cap.min(length.sqrt());
            let (mut peak, mut regen) = (f64::MIN, 0.0_f64);
            let n = 4000;
            let d = row.duration_s;
            // Runs may end at the instant at which an axis begins to brake.
            let mut times: Vec<f64> = (0..=n).map(|i| d * f64::from(i) / f64::from(n)).collect();
            let end = ramp.duration_s() - since;
            times.extend([top, d - top, end - 1e-9, end].map(|t| t.clamp(0.0, d)));
            for t in times {
                let s = power.electrical_w(ramp.at(since + t).0);
                // Both sides of a switching instant.
                let mut axes = vec![];
                if length > 0.0 {
                    if t <= top { axes.push(1000.0 * t); }
                    if t >= top && t <= d - top { axes.push(0.0); }
                    if t >= d - top { axes.push(-1000.0 * (d - t)); }
                } else {
                    axes.push(0.0);
                }
                for a in axes {
                    if credit {
                        peak = peak.max(a + s);
                        regen = regen.max(-a - s);
                    } else {
                        peak = peak.max(a.max(0.0) + s.max(0.0));
                        regen = regen.max((-a).max(0.0) + (-s).max(0.0));
                    }
                }
            }
            since += d;
            let slack = 1e-6 * (peak.abs() + regen + 1.0);
            prop_assert!(row.peak_w >= peak - slack, "{row:?}: {peak}");
            prop_assert!(row.regen_w >= regen - slack, "{row:?}: {regen}");
            // Samples lie at most d/4000 from the peak; powers change by at most
            // 4e4 W/s here, jerk aside.
            if jerk == 0.0 {
                let coarse = 4e4 * d / f64::from(n) + 1.0;
                prop_assert!(row.peak_w <= peak.max(0.0) + coarse, "{row:?}: {peak}");
                prop_assert!(row.regen_w <= regen + coarse, "{row:?}: {regen}");
            }
        }
    }
}
