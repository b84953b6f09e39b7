//! Integrals over speed of functions that are smooth there.

/// Equal parts that an interval is cut into.
const PANELS: u32 = 4;

/// Nodes and weights of Gauss and Legendre with 16 points on [−1, 1], those
/// right of the centre.
const RULE: [(f64, f64); 8] = [
    (0.095_012_509_837_637_44, 0.189_450_610_455_068_64),
    (0.281_603_550_779_258_9, 0.182_603_415_044_923_44),
    (0.458_016_777_657_227_37, 0.169_156_519_395_002_65),
    (0.617_876_244_402_643_8, 0.149_595_988_816_576_7),
    (0.755_404_408_355_003, 0.124_628_971_255_534_07),
    (0.865_631_202_387_831_8, 0.095_158_511_682_492_6),
    (0.944_575_023_073_232_6, 0.062_253_523_938_647_456),
    (0.989_400_934_991_649_9, 0.027_152_459_411_754_176),
];

/// The integral of `f` from `from` to `to`.
pub(super) fn integral(f: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let half = 0.5 * (to - from) / f64::from(PANELS);
    let mut sum = 0.0;
    for panel in 0..PANELS {
        let centre = from + half * f64::from(2 * panel + 1);
        for (node, weight) in RULE {
            sum += weight * (f(centre - half * node) + f(centre + half * node));
        }
    }
    sum * half
}
