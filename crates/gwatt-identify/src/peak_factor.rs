//! By which factor the peaks of a log exceed those of a power model, so that it holds on
//! logs that were not seen.
//!
//! Each part of the log is predicted by the model of the others. Of every peak of that
//! prediction the largest ratio of measured to predicted power counts; the factor is the
//! upper tolerance limit of their logarithms (Natrella 1963, *Experimental Statistics*,
//! chapter 2), or the largest ratio there was. How they scatter is taken from the upper half:
//! peaks that fall far short of their prediction say nothing of those that exceed it.

/// The standard normal deviate that 95 % stay below: so many peaks, and so sure.
const COVERED: f64 = 1.644_854;
const SURE: f64 = 1.644_854;
/// Share of the model's peak above which a row belongs to a peak.
pub(crate) const HALF: f64 = 0.5;

/// A factor for peaks, and where it comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PeakFactor {
    /// 95 % of peaks exceed the model by less, with 95 % confidence; at least 1.
    pub factor: f64,
    /// The largest ratio of a measured peak to its prediction.
    pub seen: f64,
    /// How many peaks were predicted.
    pub peaks: usize,
}

/// The largest ratio of measured to predicted power in each peak of the prediction: in
/// each run of rows above half of `peak_w`, the model's largest power.
#[must_use]
pub fn ratios(predicted: &[f64], measured: &[f64], peak_w: f64) -> Vec<f64> {
    let mut found: Vec<f64> = Vec::new();
    let mut is_inside = false;
    for (predicted, measured) in predicted.iter().zip(measured) {
        let is_peak = *predicted > 0.0 && *predicted >= HALF * peak_w;
        if is_peak {
            let ratio = measured / predicted;
            match found.last_mut() {
                Some(last) if is_inside => *last = last.max(ratio),
                _ => found.push(ratio),
            }
        }
        is_inside = is_peak;
    }
    found
}

/// The factor of these ratios.
#[must_use]
pub fn factor_of(ratios: &[f64]) -> PeakFactor {
    let mut logs: Vec<f64> = ratios
        .iter()
        .filter(|ratio| **ratio > 0.0)
        .map(|ratio| libm::log(*ratio))
        .collect();
    logs.sort_by(f64::total_cmp);
    let seen = ratios.iter().copied().fold(1.0, f64::max);
    let upper = logs.get(logs.len() / 2..).unwrap_or_default();
    let median = upper.first().copied().unwrap_or_default();
    let squares: f64 = upper.iter().map(|x| (x - median) * (x - median)).sum();
    let scatter = (squares / upper.len().saturating_sub(1).max(1) as f64).sqrt();
    let limit = tolerance(logs.len() as f64).map_or(seen, |k| libm::exp(median + k * scatter));
    PeakFactor {
        factor: seen.max(limit),
        seen,
        peaks: ratios.len(),
    }
}

/// How many standard deviations above the mean of n values the limit is; `None` for too
/// few of them.
fn tolerance(n: f64) -> Option<f64> {
    let a = 1.0 - SURE * SURE / (2.0 * (n - 1.0));
    let b = COVERED * COVERED - SURE * SURE / n;
    (n > 2.0 && a > 0.0).then(|| (COVERED + (COVERED * COVERED - a * b).sqrt()) / a)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Natrella's table A-7: K = 2.396 for n = 20, 1.927 for n = 100 (by this
    /// approximation a little less).
    #[test]
    fn few_peaks_need_a_larger_factor() {
        for (n, table) in [(20.0, 2.396), (100.0, 1.927)] {
            let k = tolerance(n).unwrap();
            assert!((k / table - 1.0).abs() < 0.02, "{n} {k}");
        }
        assert_eq!(tolerance(2.0), None);
        // Logarithms −0.1 to 0.2: median 0, above it 0.1 and 0.2; √((0.01 + 0.04)/2).
        let ratios = [0.0, 0.2, -0.1, 0.1, -0.1].map(libm::exp);
        let found = factor_of(&ratios);
        let k = tolerance(5.0).unwrap();
        let expected = libm::exp(k * 0.025_f64.sqrt());
        assert!((found.factor - expected).abs() < 1e-12, "{found:?}");
        assert_eq!((found.seen, found.peaks), (libm::exp(0.2), 5));
    }

    #[test]
    fn each_peak_counts_once_by_its_largest_ratio() {
        let predicted = [0.0, 60.0, 100.0, 10.0, 80.0, 40.0, -90.0];
        let measured = [5.0, 66.0, 90.0, 50.0, 100.0, 80.0, 0.0];
        assert_eq!(ratios(&predicted, &measured, 100.0), [1.1, 1.25]);
        assert_eq!(factor_of(&[]).factor, 1.0);
    }
}
