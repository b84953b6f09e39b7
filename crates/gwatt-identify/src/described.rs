//! Responses as machine files describe them, as transfer functions.

use std::f64::consts::TAU;

use gwatt_machine::{Response, ResponseRoot};
use nalgebra::Complex;

use super::transfer::{Factor, TransferFunction, factors};

impl From<&ResponseRoot> for Factor {
    /// The factor of a root: Hz become rad/s.
    fn from(root: &ResponseRoot) -> Self {
        match *root {
            ResponseRoot::Pair {
                frequency_hz,
                damping,
            } => Self::Pair {
                omega_rad_s: TAU * frequency_hz,
                damping,
            },
            ResponseRoot::Single { time_constant_s } => Self::Real { time_constant_s },
        }
    }
}

impl From<&Response> for TransferFunction {
    /// The response from command to load, of gain 1; single poles are put together
    /// in pairs, so that a pair of zeros finds its place among them.
    fn from(response: &Response) -> Self {
        let single: Vec<Complex<f64>> = response
            .poles
            .iter()
            .filter_map(|root| match root {
                ResponseRoot::Single { time_constant_s } => {
                    Some(Complex::new(-1.0 / time_constant_s, 0.0))
                }
                ResponseRoot::Pair { .. } => None,
            })
            .collect();
        let pairs = response
            .poles
            .iter()
            .filter(|root| matches!(root, ResponseRoot::Pair { .. }));
        let mut poles: Vec<Factor> = pairs.map(Factor::from).collect();
        poles.extend(factors(&single, true));
        Self {
            gain: 1.0,
            zeros: response.zeros.iter().map(Factor::from).collect(),
            poles,
            delay_s: response.delay_s,
        }
    }
}
