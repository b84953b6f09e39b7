//! Columns that say the same thing twice must agree: a position changes by its speed, a speed
//! by its acceleration. Where they do not, a unit, a rate or a column is wrong.

use super::column::Quantity;
use super::error::{IdentifyError, Outcome};
use super::recording::{Recording, Signal};

/// Stretches over which changes are compared.
const STRETCHES: usize = 200;
/// How alike changes are, from which on their sizes are compared; and of positions and speeds
/// below which they have nothing to do with each other.
const ALIKE: f64 = 0.9;
const UNLIKE: f64 = 0.3;
/// Sizes agree to within this factor.
const FACTOR: f64 = 1.1;

/// Refuses positions, speeds and accelerations that contradict each other.
///
/// # Errors
///
/// When they do.
pub(super) fn agree(recording: &Recording) -> Outcome<()> {
    let pairs = [
        (Quantity::Position, Quantity::Velocity),
        (Quantity::Velocity, Quantity::Acceleration),
    ];
    for (of, by) in pairs {
        if let (Some(of), Some(by)) = (recording.get(of), recording.get(by))
            && of.kind == by.kind
        {
            check(of, by, recording.period_s)?;
        }
    }
    Ok(())
}

fn check(of: &Signal, by: &Signal, period_s: f64) -> Outcome<()> {
    let Some((alike, factor)) = compared(&of.values, &by.values, period_s) else {
        return Ok(());
    };
    let help = "check units, times and --rate-hz: one of the two has another scale, sign or rate, or is of another axis; leave it out if it is not needed";
    let refuse = |what: String| Err(IdentifyError::new(what, help));
    let positions = of.quantity == Quantity::Position;
    if alike < -ALIKE {
        return refuse(format!("{} grows where {} is negative", of.name, by.name));
    }
    if alike > ALIKE && !(1.0 / FACTOR..=FACTOR).contains(&factor) {
        return refuse(format!(
            "{} changes by {factor:.4} times what {} says",
            of.name, by.name
        ));
    }
    if positions && alike < UNLIKE {
        return refuse(format!("{} does not change as {} says", of.name, by.name));
    }
    Ok(())
}

/// How alike changes of one signal and sums of the other are (−1 to 1), and the factor of
/// their sizes. `None` where one of them stands still.
fn compared(of: &[f64], by: &[f64], period_s: f64) -> Option<(f64, f64)> {
    let length = (of.len() / STRETCHES).max(2);
    let last = of.len().checked_sub(1)?;
    let (mut both, mut changes, mut sums) = (0.0, 0.0, 0.0);
    for from in (0..last).step_by(length) {
        let to = (from + length).min(last);
        let change = of.get(to)? - of.get(from)?;
        let steps = by.get(from..=to)?.windows(2);
        let sum: f64 = steps.map(|pair| 0.5 * pair.iter().sum::<f64>()).sum();
        let sum = sum * period_s;
        both += change * sum;
        changes += change * change;
        sums += sum * sum;
    }
    let alike = both / (changes * sums).sqrt();
    let factor = (changes / sums).sqrt();
    (alike.is_finite() && factor.is_finite()).then_some((alike, factor))
}

#[cfg(test)]
mod tests {
    use super::super::column::Kind;
    use super::*;

    fn pair(scale: f64, shift: f64) -> Recording {
        let column = |quantity, of: fn(f64) -> f64, scale: f64, shift: f64| Signal {
            name: format!("{quantity:?}"),
            quantity,
            kind: Kind::Linear,
            values: (0..4000)
                .map(|k| scale * of(0.005 * f64::from(k) + shift))
                .collect(),
        };
        Recording {
            period_s: 0.001,
            signals: vec![
                column(Quantity::Position, libm::sin, 1.0, 0.0),
                column(Quantity::Velocity, libm::cos, 5.0 * scale, shift),
            ],
            ignored: Vec::new(),
            notes: Vec::new(),
        }
    }

    #[test]
    fn units_signs_and_axes_are_seen() {
        assert!(agree(&pair(1.0, 0.0)).is_ok());
        assert!(agree(&pair(1.05, 0.1)).is_ok());
        for (scale, shift, words) in [
            (
                0.001,
                0.0,
                "Position changes by 1000.0021 times what Velocity says",
            ),
            (-1.0, 0.0, "Position grows where Velocity is negative"),
            (1.0, 1.5, "Position does not change as Velocity says"),
        ] {
            assert_eq!(agree(&pair(scale, shift)).unwrap_err().message, words);
        }
    }
}
