//! Parameters as a file.

use std::f64::consts::TAU;

use gwatt::identify::tune::{Discretization, Parameters, Tuned, Wish, Zero};

use super::{from_command, lag, pair, refusal, wish};

#[test]
fn parameters_come_back_as_they_were() {
    let mut x = from_command('X', &[lag(0.025), pair(60.0, 0.4)], 1.5e-3);
    x.zeros = vec![Zero::exact(TAU * 40.25, 0.031)];
    x.zeros[0].omega_rad_s.std = 0.5;
    x.zeros[0].damping.std = 0.001;
    x.further_zeros = vec![lag(-0.001)];
    let y = from_command('Y', &[lag(0.025)], 0.0);
    let wish = Wish {
        period_s: 2e-3,
        order: Some(3),
        bandwidth_hz: Some(90.0),
        ..wish(Discretization::Tustin)
    };
    let first = Tuned::new(vec![x, y], wish, 40.0).unwrap();
    let text = Parameters::write(&first.axes, &first.wish, first.band_hz, &first.correction);
    let read = Parameters::read(&text).unwrap();
    assert_eq!(read.discretization, Some(Discretization::Tustin));
    assert_eq!((read.period_s, read.band_hz), (Some(2e-3), Some(40.0)));
    assert_eq!((read.order, read.bandwidth_hz), (Some(3), Some(90.0)));
    let again = Tuned::new(read.axes, wish, 40.0).unwrap();
    let text_again = Parameters::write(&again.axes, &again.wish, again.band_hz, &again.correction);
    assert_eq!(text_again, text);
    for wrong in [
        "",
        "schema = 2\n[axes]",
        "schema = 1\nperiod_ms = 0\n[axes]",
        "schema = 1\nlow_pass = \"bessel\"\n[axes]",
        "schema = 1\ndiscretize = \"euler\"\n[axes]",
        "schema = 1\n[axes.XY]\ninput = \"command\"",
        "schema = 1\n[axes.X]\ninput = \"speed\"",
        "schema = 1\n[axes.X]\ninput = \"force\"",
        "schema = 1\n[axes.X]\ninput = \"force\"\ninertia_kg_m2 = 1",
        "schema = 1\n[axes.X]\ninput = \"command\"\nmass_kg = 1",
        "schema = 1\n[axes.X]\ninput = \"command\"\ndelay_ms = -1",
        "schema = 1\n[axes.X]\ninput = \"command\"\npoles = [{ frequency_hz = 1 }]",
        "schema = 1\n[axes.X]\ninput = \"command\"\npoles = [{ time_constant_s = -1 }]",
        "schema = 1\n[axes.X]\ninput = \"command\"\nzeros = [{ time_constant_s = 1 }]",
        "schema = 1\n[axes.X]\ninput = \"command\"\nzeros = [{ frequency_hz = inf, damping = 0 }]",
    ] {
        let (message, help) = refusal(Parameters::read(wrong));
        assert!(!message.is_empty() && !help.is_empty(), "{wrong}");
    }
}
