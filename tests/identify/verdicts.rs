//! Verdicts: what is wrong is not called good.

use gwatt::identify::flexible::{self, Flexible, Method};
use gwatt::identify::{Judgement, Recording, TransferFunction, judgement};

use super::{choice, noisy_recording, one_side, pair, random, recording};

fn judged(recording: &Recording, method: Method, order: Option<usize>) -> (Judgement, Flexible) {
    let mut choice = choice(method);
    choice.given.order = order;
    let found = flexible::identify(recording, &choice).unwrap();
    (judgement::flexible(&found), found)
}

/// Methods without standard errors are never good, however well they fit.
#[test]
fn without_standard_errors_nothing_is_good() {
    let flexible = recording(&one_side(), 4.0, 0.0, 0);
    for method in [Method::Arx, Method::Subspace] {
        let (verdict, found) = judged(&flexible, method, Some(4));
        assert!(!found.has_errors);
        assert_ne!(verdict, Judgement::Good, "{method:?}");
    }
    let rigid = recording(&TransferFunction::constant(50.0), 4.0, 0.05, 1);
    let (verdict, found) = judged(&rigid, Method::Subspace, Some(1));
    assert!(found.rel_error < 0.06, "{}", found.rel_error);
    assert_eq!(verdict, Judgement::NoErrors);
}

/// A model with too few modes leaves what the torque explains.
#[test]
fn a_mode_that_is_missing_is_more_than_noise() {
    let recording = noisy_recording(&one_side(), &random(8000, 200.0), 0.02, 3);
    for method in [Method::Iv, Method::Subspace] {
        let (verdict, found) = judged(&recording, method, Some(2));
        assert!(
            matches!(verdict, Judgement::MoreThanNoise | Judgement::DoesNotFit),
            "{method:?} {verdict:?} {} {}",
            found.rel_error,
            found.missed_share
        );
    }
    let (verdict, found) = judged(&recording, Method::Iv, None);
    assert_eq!(verdict, Judgement::Good);
    assert!(found.missed_share < 0.1, "{}", found.missed_share);
}

#[test]
fn a_reversed_torque_is_known_by_its_sign() {
    let mut recording = recording(&one_side(), 4.0, 0.05, 1);
    recording.reverse();
    let (verdict, found) = judged(&recording, Method::Iv, None);
    assert_eq!(verdict, Judgement::Reversed, "{:?}", found.inertia);
    recording.reverse();
    assert_eq!(judged(&recording, Method::Iv, None).0, Judgement::Good);
}

/// An anti-resonance that builds up by itself is none of a structure.
#[test]
fn a_negative_damping_is_not_good() {
    let mut axis = one_side();
    axis.zeros[0] = pair(40.0, -0.03);
    let recording = noisy_recording(&axis, &random(8000, 60.0), 0.05, 2);
    let (verdict, found) = judged(&recording, Method::Iv, None);
    assert_eq!(verdict, Judgement::NegativeDamping, "{:?}", found.zeros);
}
