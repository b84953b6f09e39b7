//! Signals that are designed for an axis.

use gwatt::identify::design::{Bounds, Kind, Known, propose};
use gwatt::identify::flexible::{self, Method};
use gwatt::identify::{Judgement, Measured, Recording, TransferFunction, judgement, simulate};

use super::{PERIOD_S, choice, errors, m_sequence, one_side, recording, table};
use crate::random::Random;

/// Noise of a sensor, in rad/s².
const NOISE: f64 = 6.0;

fn with_noise(axis: &TransferFunction, torque: &[f64], seed: u64) -> Recording {
    let clean = simulate(axis, Measured::Direct, PERIOD_S, torque).unwrap();
    let mut random = Random(seed);
    let noisy: Vec<f64> = clean.iter().map(|a| a + NOISE * random.normal()).collect();
    table(&["torque_nm", "accel_rad_s2"], &[torque, &noisy])
}

fn bounds() -> Bounds {
    Bounds {
        amplitude: 1.0,
        seconds: Some(16.0),
        stroke: None,
        speed: None,
    }
}

/// The standard errors that are shown beforehand are those of the recording, and smaller
/// than those of an M-sequence.
#[test]
fn a_designed_signal_has_the_errors_that_were_foreseen() {
    let axis = one_side();
    let first = with_noise(&axis, &m_sequence(4_000), 1);
    let known = Known::of_recording(&first, &choice(Method::Iv)).unwrap();
    let proposal = propose(&known, &bounds()).unwrap();
    let best = &proposal.best;
    assert!(matches!(best.kind, Kind::Shaped { .. }), "{:?}", best.kind);
    assert_eq!(best.amplitude, 1.0);
    assert_eq!(best.steady, None);
    for other in &proposal.others {
        if let Kind::MSequence { .. } = other.kind {
            assert!(other.by_wanted > 1.5 * best.by_wanted, "{other:?}");
        }
    }
    let second = with_noise(&axis, &proposal.excitation.values, 2);
    let found = flexible::identify(&second, &choice(Method::Iv)).unwrap();
    assert_eq!(judgement::flexible(&found), Judgement::Good);
    let zeros = known.roots.iter().zip(&best.foreseen.roots);
    let [frequency, damping] = zeros
        .filter(|((root, _), _)| known.transfer.zeros.contains(root))
        .map(|(_, errors)| *errors)
        .next()
        .unwrap();
    let foreseen = [frequency, damping, best.foreseen.inertia];
    for ((error, std), foreseen) in errors(&axis, &found).into_iter().zip(foreseen) {
        assert!((std / foreseen - 1.0).abs() < 0.3, "{std} {foreseen}");
        assert!(error.abs() < 4.0 * foreseen, "{error} {foreseen}");
    }
}

/// Where no length is given it is as long as the errors need.
#[test]
fn a_signal_is_as_long_as_its_errors_need() {
    let first = with_noise(&one_side(), &m_sequence(4_000), 1);
    let known = Known::of_recording(&first, &choice(Method::Iv)).unwrap();
    let free = Bounds {
        seconds: None,
        ..bounds()
    };
    let proposal = propose(&known, &free).unwrap();
    let seconds = proposal.excitation.values.len() as f64 * PERIOD_S;
    assert!(seconds > 16.0 && seconds < 120.0, "{seconds}");
    assert!(
        proposal.best.by_wanted <= 1.0,
        "{}",
        proposal.best.by_wanted
    );
}

/// Within these the axis stays, friction or none.
#[test]
fn stroke_and_speed_are_kept() {
    let axis = one_side();
    let known = Known::of_figures(axis.clone(), [0.0, 0.0], PERIOD_S);
    let wide = propose(&known, &bounds()).unwrap().best;
    for (stroke, speed) in [
        (Some(0.2 * wide.travel), None),
        (None, Some(0.3 * wide.fastest)),
        (Some(0.05 * wide.travel), Some(0.1 * wide.fastest)),
    ] {
        let narrow = Bounds {
            stroke,
            speed,
            ..bounds()
        };
        let proposal = propose(&known, &narrow).unwrap();
        let values = &proposal.excitation.values;
        let accel = simulate(&axis, Measured::Direct, PERIOD_S, values).unwrap();
        let (half, fastest, _) = gwatt::identify::excitation::reach(&accel, PERIOD_S, 1.0);
        assert!(
            stroke.is_none_or(|s| 2.0 * half <= s * (1.0 + 1e-9)),
            "{half}"
        );
        assert!(
            speed.is_none_or(|v| fastest <= v * (1.0 + 1e-9)),
            "{fastest}"
        );
        let peak = values.iter().fold(0.0_f64, |peak, x| peak.max(x.abs()));
        assert!(
            (peak / proposal.best.amplitude - 1.0).abs() < 1e-9,
            "{peak}"
        );
        assert!(peak <= 1.0);
    }
}

/// Coulomb friction keeps its sign where the axis moves faster than the signal turns it.
#[test]
fn an_axis_with_coulomb_friction_is_to_move_meanwhile() {
    let known = Known::of_figures(one_side(), [0.01, 0.2], PERIOD_S);
    let best = propose(&known, &bounds()).unwrap().best;
    let steady = best.steady.unwrap();
    let of_signal = best.fastest - steady;
    assert!(
        (steady / of_signal - 1.2).abs() < 1e-9,
        "{steady} {of_signal}"
    );
    assert!(best.travel > steady * 15.9, "{}", best.travel);
}

#[test]
fn what_no_signal_can_be_made_for_is_refused() {
    let known = Known::of_figures(one_side(), [0.0, 0.0], PERIOD_S);
    let refused = |bounds: Bounds| propose(&known, &bounds).unwrap_err().to_string();
    for (bounds, word) in [
        (
            Bounds {
                amplitude: 0.0,
                ..bounds()
            },
            "the amplitude 0 is not positive",
        ),
        (
            Bounds {
                stroke: Some(-1.0),
                ..bounds()
            },
            "the stroke -1 is not positive",
        ),
        (
            Bounds {
                speed: Some(f64::NAN),
                ..bounds()
            },
            "the speed NaN is not positive",
        ),
        (
            Bounds {
                seconds: Some(0.1),
                ..bounds()
            },
            "0.1 s are 100 samples",
        ),
        (
            Bounds {
                seconds: Some(1e6),
                ..bounds()
            },
            "1000000 s are 1000000000 samples",
        ),
    ] {
        let message = refused(bounds);
        assert!(message.contains(word), "{message}");
    }
    // Torque and motion counted in opposite directions.
    let mut reversed = recording(&one_side(), 4.0, 0.02, 1);
    reversed.reverse();
    let refused = Known::of_recording(&reversed, &choice(Method::Iv)).unwrap_err();
    assert!(
        refused.to_string().contains("cannot be designed"),
        "{refused}"
    );
}
