//! Recordings that are refused, with what to do.

use std::f64::consts::PI;
use std::fmt::Write as _;

use gwatt::identify::Recording;
use gwatt::identify::flexible::{self, Method};
use gwatt::identify::rigid::{self, Friction};

use super::{PERIOD_S, choice, csv, m_sequence, table};
use crate::random::Random;

/// What is wrong with a recording, by the message.
fn refusal(text: &str) -> String {
    let choice = choice(Method::Iv);
    let result = Recording::read(text.as_bytes(), None).and_then(|recording| {
        rigid::fit(&recording, Friction::Symmetric, None)?;
        flexible::identify(&recording, &choice)
    });
    result.map(|_| ()).unwrap_err().to_string()
}

#[test]
fn bad_recordings_are_refused_with_what_to_do() {
    let n = 2000;
    let wave = |scale: f64, hz: f64| -> Vec<f64> {
        (0..n)
            .map(|k| scale * libm::sin(2.0 * PI * hz * k as f64 * PERIOD_S))
            .collect()
    };
    let (force, position) = (wave(10.0, 3.0), wave(0.01, 3.0));
    let good = csv(&["force_n", "position_m"], &[&force, &position]);
    let said = |text: &str, what: &str| {
        let message = refusal(text);
        assert!(message.contains(what), "{what}: {message}");
        assert!(message.contains("help: "), "{message}");
    };
    said("", "the recording is empty");
    said("time_s\n0\n", "fewer than two columns");
    said(&good.replace(',', " "), "fewer than two columns");
    said(&good.replace("time_s", "seconds"), "no column time_s");
    said(&good.replace("force_n", "force"), "unit of column force");
    said(
        &good.replace("force_n", "force_lbf"),
        "unit of column force_lbf",
    );
    said(&good.replace("force_n", "current_a"), "no force or torque");
    said(&good.replace("position_m", "temperature"), "no motion");
    said(&good.replace("force_n", "position_mm"), "same quantity");
    said(&good.replacen("0.010000,", "0.010300,", 1), "uneven");
    said(&good.replacen("\n0.5", "\n0.5x", 1), "not a number");
    let gap: Vec<&str> = good
        .lines()
        .enumerate()
        .filter(|(index, _)| !(800..830).contains(index))
        .map(|(_, line)| line)
        .collect();
    said(&gap.join("\n"), "a gap");
    let short: Vec<&str> = good.lines().take(20).collect();
    said(&short.join("\n"), "too short");
    said(
        &csv(&["force_n", "position_m"], &[&vec![1.0; n], &vec![0.5; n]]),
        "there is no excitation",
    );
    let mut random = Random(3);
    let noisy: Vec<f64> = (0..n).map(|_| random.normal()).collect();
    let cut: Vec<f64> = noisy
        .iter()
        .enumerate()
        .map(|(k, x)| {
            if (500..560).contains(&k) {
                3.0
            } else {
                x.min(3.0)
            }
        })
        .collect();
    let table = table(&["torque_nm", "accel_rad_s2"], &[&cut, &noisy]);
    let message = flexible::identify(&table, &choice(Method::Iv))
        .unwrap_err()
        .to_string();
    assert!(message.contains("saturated"), "{message}");
}

#[test]
fn time_may_jitter_a_little() {
    let table = |jitter: f64| {
        let mut text = "time_s,force_n,position_m\n".to_owned();
        for k in 0..2000 {
            let t = f64::from(k) * PERIOD_S;
            let wobble = if k % 2 == 0 { jitter } else { -jitter } * PERIOD_S;
            let x = 0.01 * libm::sin(20.0 * t) + 0.003 * libm::sin(51.0 * t);
            writeln!(text, "{},{},{x}", t + wobble, 10.0 * libm::cos(20.0 * t)).unwrap();
        }
        Recording::read(text.as_bytes(), None)
    };
    let period = table(1e-4).unwrap().period_s;
    assert!((period - PERIOD_S).abs() < 1e-9);
    assert!(table(0.1).is_err());
}

/// `y(k) = u(k) − y(k − 1)/2` has its pole at −1/2, where no axis that is sampled has
/// one.
#[test]
fn a_recording_that_no_axis_makes_is_refused() {
    let torque = m_sequence(1000);
    let mut before = 0.0;
    let accel: Vec<f64> = torque
        .iter()
        .map(|u| {
            before = u - 0.5 * before;
            before
        })
        .collect();
    let table = table(&["torque_nm", "accel_rad_s2"], &[&torque, &accel]);
    let mut choice = choice(Method::Arx);
    choice.given.order = Some(1);
    let trouble = flexible::identify(&table, &choice).unwrap_err();
    assert_eq!(trouble.message, "no stable model fits the recording");
    assert_eq!(
        trouble.help,
        "check units and signs of the columns, excite longer, or give --order"
    );
}
