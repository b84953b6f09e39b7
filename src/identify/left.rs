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

/// From which frequency on an axis is not rigid, Hz, if it is not within the band:
/// by its force, friction taken off, and acceleration, every `step_s`.
#[must_use]
pub fn rigid_to_hz(
    force: &[f64],
    acceleration: &[f64],
    mass: f64,
    step_s: f64,
    band_hz: f64,
) -> Option<f64> {
    let response = measure(force, acceleration, None, step_s, None)?;
    let missed: Vec<bool> = response
        .response
        .iter()
        .zip(&response.coherence)
        .map(|(by_force, coherence)| {
            *coherence > COHERENT && (by_force * mass - 1.0).norm() > MISSED
        })
        .collect();
    let first = missed
        .windows(RUN)
        .position(|run| run.iter().all(|missed| *missed))?;
    let hz = response.frequency_hz.get(first).copied()?;
    (hz < band_hz).then_some(hz)
}
