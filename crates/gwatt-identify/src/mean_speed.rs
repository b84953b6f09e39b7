//! Speeds that are means since the sample before: differences of a position, as many drives
//! show them. They are late by half a sample, and weaker where motion is fast; summed up they
//! are that position.

use super::certainty;
use super::chosen::{COMPARED, WHITENING_MAX};
use super::column::Quantity;
use super::data::Data;
use super::measured_noise::Noise;
use super::recording::Recording;
use super::state_space::Measured;
use super::transfer::TransferFunction;

/// Whether differences of a speed are clearly explained better by a model, moved a little, as
/// second differences of a position.
pub(super) fn is_likelier(data: &Data<'_>, model: &TransferFunction) -> bool {
    let head = data.head(COMPARED);
    let earlier = TransferFunction {
        delay_s: (model.delay_s - 0.5 * data.period_s).max(0.0),
        ..model.clone()
    };
    let mean = Data {
        measured: Measured::Position,
        ..head
    };
    let criterion = |data: &Data<'_>, model: &TransferFunction| {
        let noise = Noise::next_to(data, model, WHITENING_MAX, None)?;
        Some(noise.with(data, model)?.0)
    };
    match (criterion(&head, model), criterion(&mean, &earlier)) {
        (Some(at_once), Some(mean)) => mean < at_once - certainty::OTHER_NOISE,
        _ => false,
    }
}

/// The recording with the position that its speed is the difference of.
pub(super) fn summed(recording: &Recording) -> Recording {
    let mut out = recording.clone();
    out.signals
        .retain(|signal| signal.quantity != Quantity::Position);
    let speeds = out.signals.iter_mut();
    for signal in speeds.filter(|signal| signal.quantity == Quantity::Velocity) {
        signal.quantity = Quantity::Position;
        let mut position = 0.0;
        for value in &mut signal.values {
            position += recording.period_s * *value;
            *value = position;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::column::Kind;
    use super::super::recording::Signal;
    use super::*;

    #[test]
    fn differences_are_summed_up() {
        let signal = |quantity, values: &[f64]| Signal {
            name: String::new(),
            quantity,
            kind: Kind::Linear,
            values: values.to_vec(),
        };
        let recording = Recording {
            period_s: 0.5,
            signals: vec![
                signal(Quantity::Position, &[9.0; 3]),
                signal(Quantity::Velocity, &[0.0, 4.0, -2.0]),
            ],
            ignored: Vec::new(),
            notes: Vec::new(),
        };
        let summed = summed(&recording);
        assert_eq!(summed.signals.len(), 1);
        assert_eq!(
            summed.get(Quantity::Position).unwrap().values,
            [0.0, 2.0, 1.0]
        );
    }
}
