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
const MISSED: f64 = 0.15;
/// In so many neighbouring frequencies.
const RUN: usize = 2;

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::excitation::{Shape, make};

    const STEP_S: f64 = 0.013;
    const BAND_HZ: f64 = 30.0;

    fn force() -> Vec<f64> {
        let shape = Shape::Random {
            from_hz: 0.3,
            to_hz: 29.0,
            seconds: 2000.0 * STEP_S,
            seed: 4,
        };
        make(shape, 1.0, STEP_S).unwrap().values
    }

    /// Noise as large as the signal itself is no resonance, wherever it is.
    #[test]
    fn noise_is_no_resonance() {
        let force = force();
        for (on_force, on_acceleration) in [(1e-9, 0.4), (0.4, 1e-9), (0.3, 0.3), (0.05, 0.05)] {
            for seed in 1..20 {
                let noise = |level: f64, seed: u64| -> Vec<f64> {
                    let shape = Shape::Random {
                        from_hz: 0.1,
                        to_hz: 38.0,
                        seconds: 2000.0 * STEP_S,
                        seed,
                    };
                    let noise = make(shape, level, STEP_S).unwrap().values;
                    force
                        .iter()
                        .zip(noise)
                        .map(|(f, noise)| f + noise)
                        .collect()
                };
                let measured = noise(on_force, 2 * seed + 100);
                let acceleration: Vec<f64> = noise(on_acceleration, 2 * seed + 101)
                    .iter()
                    .map(|a| a / 5.0)
                    .collect();
                let found = rigid_to_hz(&measured, &acceleration, 5.0, STEP_S, BAND_HZ);
                assert_eq!(found, None, "{on_force} {on_acceleration} {seed}");
            }
        }
    }
}
