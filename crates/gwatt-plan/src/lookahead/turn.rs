//! The turn between two short blocks, by which Marlin takes them for chords of a circle.

/// Marlin's table (planner.cpp, `JD_USE_LOOKUP_TABLE`) has a line `k·t + b` for `acos t` in each
/// of these intervals: from 0 to 1/2, on to 3/4, on to 7/8 and so on to 1.
const LINES: [[f64; 2]; 16] = [
    [-1.031_458_37, 1.570_796_37],
    [-1.307_606_46, 1.708_870_53],
    [-1.752_058_51, 2.042_209_39],
    [-2.417_057_04, 2.624_083_52],
    [-3.377_692_22, 3.524_678_71],
    [-4.748_889_92, 4.853_026_39],
    [-6.696_498_87, 6.770_204_54],
    [-9.456_617_36, 9.508_758_54],
    [-13.364_048_0, 13.400_928_5],
    [-18.892_822_2, 18.918_899_5],
    [-26.713_684_1, 26.732_124_3],
    [-37.775_459_3, 37.788_505_5],
    [-53.420_181_3, 53.429_397_5],
    [-75.545_837_4, 75.552_352_9],
    [-106.836_761, 106.841_369],
    [-218.532_821, 218.534_011],
];

/// The angle of a turn by its cosine, from 0 to almost 1. A firmware that looks it up has it up to
/// a quarter too small between its lines, and others work it out: the smaller permits the higher
/// speed.
pub(super) fn angle_at_least(cos: f64) -> f64 {
    // The first interval is from 1 − cos = 1 to 1/2.
    let halvings = (-libm::log2(1.0 - cos)).clamp(0.0, 15.0) as usize;
    let [k, b] = LINES[halvings.min(LINES.len() - 1)];
    libm::acos(cos).min(k * cos + b)
}

#[cfg(test)]
mod tests {
    use super::angle_at_least;

    /// Worked out by hand: 0.998 is in the ninth interval, from 1 − 1/256 to 1 − 1/512.
    #[test]
    fn lines_of_the_table() {
        let close = |cos: f64, angle: f64| {
            let found = angle_at_least(cos);
            assert!((found - angle).abs() < 1e-6, "{cos}: {found} for {angle}");
        };
        close(0.997, -13.364_048 * 0.997 + 13.400_928_5);
        // The firmware has 0.0031 rad as 0.0022.
        close(1.0 - 4.8e-6, 218.534_011 - 218.532_821 * (1.0 - 4.8e-6));
        // A line above the curve: the angle itself.
        close(0.75, 0.722_734_248);
    }

    #[test]
    fn never_above_the_angle_and_never_far_below() {
        for step in 0..=10_000 {
            let angle = 0.001_5 + 1e-4 * f64::from(step);
            let found = angle_at_least(libm::cos(angle));
            assert!(found <= angle * (1.0 + 1e-9), "{angle}: {found}");
            assert!(found > 0.7 * angle, "{angle}: {found}");
        }
    }
}
