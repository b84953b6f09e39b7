//! Is what is left white? And the filter that makes it so.

/// Autocorrelation of a signal at lags 0 to `lags`, mean taken off, 1 at lag 0.
#[must_use]
pub fn autocorrelation(x: &[f64], lags: usize) -> Vec<f64> {
    let n = x.len().max(1) as f64;
    let mean = x.iter().sum::<f64>() / n;
    let at = |lag: usize| -> f64 {
        let later = x.iter().skip(lag);
        x.iter()
            .zip(later)
            .map(|(a, b)| (a - mean) * (b - mean))
            .sum()
    };
    let power = at(0);
    (0..=lags)
        .map(|lag| if power > 0.0 { at(lag) / power } else { 0.0 })
        .collect()
}

/// Quantile of the normal distribution at 99.9 %.
const QUANTILE: f64 = 3.090_232;

/// How a test of whiteness came out (Ljung & Box 1978).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Whiteness {
    /// `n(n+2) Σ ρ²/(n−k)`.
    pub statistic: f64,
    /// What white noise exceeds once in a thousand times.
    pub limit: f64,
}

impl Whiteness {
    /// Tests a signal over this many lags.
    #[must_use]
    pub fn of(x: &[f64], lags: usize) -> Self {
        let n = x.len() as f64;
        let rho = autocorrelation(x, lags);
        let sum: f64 = rho
            .iter()
            .enumerate()
            .skip(1)
            .map(|(lag, r)| r * r / (n - lag as f64).max(1.0))
            .sum();
        // Wilson and Hilferty's approximation of the quantile of χ².
        let m = lags as f64;
        let root = 1.0 - 2.0 / (9.0 * m) + QUANTILE * (2.0 / (9.0 * m)).sqrt();
        Self {
            statistic: n * (n + 2.0) * sum,
            limit: m * root * root * root,
        }
    }

    /// True for what may be white noise.
    #[must_use]
    pub fn is_white(self) -> bool {
        self.statistic <= self.limit
    }
}

/// Taps of the autoregressive filter that makes a signal white, without the
/// leading 1; the order up to `order_max` by Akaike's criterion (Levinson's
/// recursion).
#[must_use]
pub fn whitening(x: &[f64], order_max: usize) -> Vec<f64> {
    let n = x.len() as f64;
    let rho = autocorrelation(x, order_max);
    let mut taps: Vec<f64> = Vec::new();
    let mut power = 1.0;
    let mut best = (0.0, Vec::new());
    for order in 1..=order_max {
        let mut reflection = rho.get(order).copied().unwrap_or_default();
        for (index, tap) in taps.iter().enumerate() {
            reflection += tap * rho.get(order - 1 - index).copied().unwrap_or_default();
        }
        reflection = -reflection / power;
        if !reflection.is_finite() || reflection.abs() >= 1.0 {
            break;
        }
        let mirrored: Vec<f64> = taps.iter().rev().map(|tap| tap * reflection).collect();
        for (tap, m) in taps.iter_mut().zip(&mirrored) {
            *tap += m;
        }
        taps.push(reflection);
        power *= 1.0 - reflection * reflection;
        let criterion = n * libm::log(power) + 2.0 * order as f64;
        if criterion < best.0 {
            best = (criterion, taps.clone());
        }
    }
    best.1
}

/// The same by the errors of prediction forwards and backwards (Burg's method): it
/// holds where slow noise is many times as strong as the rest, which the ends of an
/// autocorrelation would hide.
#[must_use]
pub fn predicting(x: &[f64], order_max: usize) -> Vec<f64> {
    let n = x.len() as f64;
    let mean = x.iter().sum::<f64>() / n.max(1.0);
    let mut ahead: Vec<f64> = x.iter().skip(1).map(|x| x - mean).collect();
    let mut back: Vec<f64> = x.iter().map(|x| x - mean).collect();
    let mut taps: Vec<f64> = Vec::new();
    let mut gained = 0.0;
    let mut best = (0.0, 0);
    let mut orders = vec![Vec::new()];
    for order in 1..=order_max {
        back.truncate(ahead.len());
        let (mut product, mut squares) = (0.0, 0.0);
        for (f, b) in ahead.iter().zip(&back) {
            product += f * b;
            squares += f * f + b * b;
        }
        let reflection = -2.0 * product / squares;
        if !reflection.is_finite() || reflection.abs() >= 1.0 {
            break;
        }
        let mirrored: Vec<f64> = taps.iter().rev().map(|tap| tap * reflection).collect();
        for (tap, m) in taps.iter_mut().zip(&mirrored) {
            *tap += m;
        }
        taps.push(reflection);
        orders.push(taps.clone());
        for (f, b) in ahead.iter_mut().zip(&mut back) {
            (*f, *b) = (*f + reflection * *b, *b + reflection * *f);
        }
        // The next order predicts from one sample farther back.
        ahead.drain(..ahead.len().min(1));
        gained += libm::log(1.0 - reflection * reflection);
        let criterion = n * gained + 2.0 * order as f64;
        if criterion < best.0 {
            best = (criterion, order);
        }
    }
    orders.swap_remove(best.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A value is foreseen from the one before it; of nothing nothing is.
    #[test]
    fn what_follows_from_before_is_foreseen() {
        // 1, ½, ¼ … and the same below zero, so that the mean is nil. Of each the products
        // add up to ⅔, the squares to ⅓ after and 4/3 before; between them there is a
        // step to −1. −2·(2·⅔)/(2·(⅓ + 4/3) + 1).
        let half: Vec<f64> = (0..60).map(|k| libm::ldexp(1.0, -k)).collect();
        let x: Vec<f64> = half
            .iter()
            .copied()
            .chain(half.iter().map(|x| -x))
            .collect();
        let taps = predicting(&x, 1);
        assert!((taps[0] + 8.0 / 13.0).abs() < 1e-12, "{taps:?}");
        assert!(predicting(&[0.0; 8], 3).is_empty());
    }
}
