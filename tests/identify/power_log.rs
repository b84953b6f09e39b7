//! The power model from logs.

use std::fmt::Write as _;
use std::fs;

use gwatt::identify::power_fit::{self, PowerLog};

use crate::evidence::shared;

#[test]
fn measured_power_is_explained() {
    let Some(folder) = shared("measured/umich", "the recordings of others") else {
        return;
    };
    for (axis, mass) in [('X', 388.0), ('Y', 349.0)] {
        let mut log = PowerLog::default();
        for run in 1..=12 {
            let path = folder.join(format!("experiment_{run:02}.csv"));
            log.add(fs::File::open(path).unwrap(), axis).unwrap();
        }
        let model = power_fit::fit(&log).unwrap();
        assert!(model.r2 >= 0.96, "{axis}: {}", model.r2);
        assert!((model.mass.value - mass).abs() < 1.0, "{:?}", model.mass);
        assert!(model.peaks.factor >= model.peaks.seen && model.peaks.factor < 2.5);
        assert_eq!(log.notes.len(), 1);
        assert!(log.notes[0].contains("look swapped"));
    }
}

#[test]
fn a_power_log_gives_efficiency_and_standby() {
    let mut text = "x_velocity_mm_s,x_accel_mm_s2,x_power_w\n".to_owned();
    for k in 0..4000 {
        let t = f64::from(k) * 0.01;
        let v = 0.4 * libm::sin(1.7 * t) + 0.1 * libm::sin(5.3 * t);
        let a = 0.4 * 1.7 * libm::cos(1.7 * t) + 0.1 * 5.3 * libm::cos(5.3 * t);
        let m = v * (500.0 * a + 200.0 * v + 90.0 * v.signum());
        let p = 60.0 + if m > 0.0 { m / 0.8 } else { m * 0.8 };
        writeln!(text, "{},{},{p}", v * 1e3, a * 1e3).unwrap();
    }
    let mut log = PowerLog::default();
    log.add(text.as_bytes(), 'X').unwrap();
    let model = power_fit::fit(&log).unwrap();
    assert!((model.efficiency.value - 0.8).abs() < 1e-6, "{model:?}");
    assert!((model.mass.value - 500.0).abs() < 1.0, "{model:?}");
    assert!((model.standby_w.value - 60.0).abs() < 0.5, "{model:?}");
    assert!(model.r2 > 0.9999);
}
