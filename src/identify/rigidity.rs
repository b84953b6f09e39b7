//! What a rigid model leaves: noise, or an axis that is not rigid.
//!
//! Noise of a sensor makes force and acceleration less alike; a resonance keeps
//! them alike, only in another ratio than slow motion has. So where the two cohere,
//! their ratio is compared with the mass.

use super::spectrum::measure;

/// Frequencies count where the force explains this share of the acceleration: noise
/// in either of them then changes their ratio by a twentieth at most.
const COHERENT: f64 = 0.95;
/// Where the model misses this share of a frequency's force, the axis is not rigid.
const MISSED: f64 = 0.25;
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
        .zip(&measured.coherence)
        .zip(&measured.frequency_hz)
        .take_while(|(_, hz)| **hz < band_hz)
        .map(|((by_force, coherence), _)| {
            *coherence > COHERENT && (by_force * mass - 1.0).norm() > MISSED
        })
        .collect();
    missed
        .windows(RUN)
        .any(|run| run.iter().all(|missed| *missed))
}
