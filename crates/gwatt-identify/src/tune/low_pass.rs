//! The low-pass that makes filters causal.

use std::f64::consts::PI;

use crate::transfer::Factor;

/// What F is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LowPass {
    /// 1: for commands without jumps of acceleration. The filters are then
    /// finite in time, and late by one period for each pair of zeros.
    None,
    /// Butterworth's, flat at low frequencies.
    Butterworth {
        /// Number of poles.
        order: usize,
        /// Where it has fallen to 1/√2.
        bandwidth_hz: f64,
    },
}

impl LowPass {
    /// Its poles.
    #[must_use]
    pub fn poles(self) -> Vec<Factor> {
        let Self::Butterworth {
            order,
            bandwidth_hz,
        } = self
        else {
            return Vec::new();
        };
        let omega_rad_s = 2.0 * PI * bandwidth_hz;
        let mut poles: Vec<Factor> = (0..order / 2)
            .map(|k| {
                // From the negative real axis; odd orders have a pole on it.
                let steps = k as f64 + if order % 2 == 0 { 0.5 } else { 1.0 };
                Factor::Pair {
                    omega_rad_s,
                    damping: libm::cos(PI * steps / order as f64),
                }
            })
            .collect();
        if order % 2 == 1 {
            poles.push(Factor::Real {
                time_constant_s: 1.0 / omega_rad_s,
            });
        }
        poles
    }
}
