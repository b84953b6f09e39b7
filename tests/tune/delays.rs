//! Whether the axes answer at the same time.

use gwatt::identify::tune::{AxisResponse, Discretization, Gain, delays_agree};
use gwatt::report::tuned_text;

use super::{axis, from_command, lag, tuned, wish};

#[test]
fn delays_are_told_and_made_to_agree() {
    // 1/40 s and 1/50 s of the loops, 1 ms more of dead time on Y.
    let axes = vec![
        from_command('X', &[lag(0.025)], 0.0),
        from_command('Y', &[lag(0.02)], 1e-3),
    ];
    let result = tuned(axes, wish(Discretization::Matched));
    let advice = result.advice.as_ref().unwrap();
    assert!(!delays_agree(advice));
    assert!((advice[0].delay_s - 0.025).abs() < 1e-15 && advice[0].command_delay_s == 0.0);
    assert!((advice[1].command_delay_s - 4e-3).abs() < 1e-15);
    let text = tuned_text(&result);
    assert!(
        text.contains(
            "delays do not agree: X 25.000 ms, Y 21.000 ms; circles come 66.7 µm out of round for each m/min of feed\n  \
             Y: lower the gain of its position loop to 0.8400 of what it is, or delay its command by 4.000 ms"
        ),
        "{text}"
    );
    // With the gains known: 1/(1/50 + 5 ms) = 40.
    let mut axes = vec![axis('X', &[]), axis('Y', &[])];
    axes[0].position_gain_1_s = Some(40.0);
    assert!(
        tuned(axes.clone(), wish(Discretization::Matched))
            .advice
            .is_none()
    );
    axes[1].position_gain_1_s = Some(50.0);
    let advice = tuned(axes.clone(), wish(Discretization::Matched))
        .advice
        .unwrap();
    let Some(Gain::Absolute(gain)) = advice[1].gain else {
        panic!("{advice:?}");
    };
    assert!((gain - 40.0).abs() < 1e-12);
    axes[1].position_gain_1_s = Some(gain);
    assert!(delays_agree(
        &tuned(axes, wish(Discretization::Matched)).advice.unwrap()
    ));
}

/// Delays of recordings have errors: what is within them needs no advice, and an axis whose
/// delay is not known says nothing about the others.
#[test]
fn advice_is_given_where_delays_clearly_differ() {
    let known = |letter, time_constant_s, lateness_std_s| AxisResponse {
        lateness_std_s,
        ..from_command(letter, &[lag(time_constant_s)], 0.0)
    };
    let text = |axes| tuned_text(&tuned(axes, wish(Discretization::Matched)));
    let apart = text(vec![known('X', 0.025, 1e-3), known('Y', 0.021, 1e-3)]);
    assert!(
        apart.contains("delays do not agree: X 25.000 ± 1.000 ms, Y 21.000 ± 1.000 ms; circles"),
        "{apart}"
    );
    assert!(apart.contains("delay its command by 4.000 ms"), "{apart}");
    let alike = text(vec![known('X', 0.025, 2e-3), known('Y', 0.021, 2e-3)]);
    assert!(
        alike.contains("delays agree as far as they are known: X 25.000 ± 2.000 ms"),
        "{alike}"
    );
    assert!(!alike.contains("delay its command"), "{alike}");
    let unknown = text(vec![
        known('X', 0.025, 1e-3),
        known('Y', 0.021, 1e-3),
        known('Z', 92.0, 300.0),
    ]);
    assert!(
        unknown.contains("Y: lower the gain of its position loop to 0.8400"),
        "{unknown}"
    );
    assert!(!unknown.contains("Z: lower"), "{unknown}");
    assert!(!unknown.contains("X: lower"), "{unknown}");
}
