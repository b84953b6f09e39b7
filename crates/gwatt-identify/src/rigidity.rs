//! What a rigid model leaves: noise, or an axis that is not rigid.
//!
//! Noise of a sensor makes force and acceleration less alike; a resonance keeps
//! them alike, only in another ratio than slow motion has. So where the two cohere,
//! their ratio is compared with the mass.

use super::spectrum::measure;

/// Where the model misses more than this share of a frequency's force, and so many
/// standard errors of it, the axis is not rigid. What is not coherent, noise in the
/// force or in the acceleration, makes their ratio another one by as much at most; it
/// is taken twice.
const MISSED: f64 = 0.1;
const SURE: f64 = 4.0;
/// In so many neighbouring frequencies.
const RUN: usize = 3;

/// Whether an axis resonates within the band, Hz: by its force, friction taken off,
/// and its acceleration, every `step_s`.
#[must_use]
pub fn resonates(
    force: &[f64],
    acceleration: &[f64],
    mass: f64,
    step_s: f64,
    band_hz: f64,
) -> bool {
    let Some(measured) = measure(force, acceleration, None, step_s, None) else {
        return false;
    };
    let missed: Vec<bool> = measured
        .response
        .iter()
        .zip(&measured.variance)
        .zip(&measured.coherence)
        .zip(&measured.frequency_hz)
        .take_while(|(_, hz)| **hz < band_hz)
        .map(|(((by_force, variance), coherence), _)| {
            let missed = (by_force * mass - 1.0).norm();
            missed > MISSED + 2.0 * (1.0 - coherence)
                && missed > SURE * mass.abs() * variance.sqrt()
        })
        .collect();
    missed
        .windows(RUN)
        .any(|run| run.iter().all(|missed| *missed))
}
