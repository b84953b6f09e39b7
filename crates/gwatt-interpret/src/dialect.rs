//! What Fanuc, Haas and their relatives have besides ISO 6983: G codes of
//! lathes, incremental words of G-code system A, numbers without a decimal
//! point, and words that move nothing.
//!
//! Fanuc B-63944EN and B-63604EN ("Decimal Point Programming", "G Code List in
//! T Series", "Skip Function (G31)"), Haas mill and lathe operator's manuals.

mod follow_points;
mod lathe_corner;
mod point_kinds;
mod words;

pub(super) use point_kinds::PointKinds;

use super::code::{GCode, Motion, Own};
use super::turning::{BOX, FACE, THREAD, THREAD_BOX};
use gwatt_machine::units::MM_PER_INCH;
use gwatt_machine::{Dialect, Lathe};
use gwatt_motion::FeedMode;

/// The rule of the note on numbers without a point, whose meaning nobody has given.
pub const NO_POINT: &str = "no-point";

/// One least increment of IS-B, in program units.
const LEAST_MM: f64 = 1e-3;
const LEAST_INCH: f64 = 1e-4;
const LEAST_DEG: f64 = 1e-3;

/// Letters of lengths and angles.
const LENGTHS: &[u8] = b"XYZUVWABCIJKR";
/// Words of system A with the axes along which they are incremental.
const INCREMENTAL: [(u8, u8); 4] = [(b'U', b'X'), (b'V', b'Y'), (b'W', b'Z'), (b'H', b'C')];

/// The G word with this number × 10, where the dialect has a meaning of its own
/// for it.
pub(super) fn dialect_code(number: u16, dialect: &Dialect) -> Own {
    if dialect.osp {
        return super::osp::osp_code(number, dialect.diameter);
    }
    let Some(lathe) = dialect.lathe else {
        return match number {
            310 => Own::Code(GCode::Skip),
            120 | 130 if dialect.circular_pocket => Own::Code(GCode::Pocket(number == 120)),
            _ => Own::Common,
        };
    };
    let special = |number| GCode::Motion(Motion::Special(number));
    let units = |mm_per_unit| GCode::Units { mm_per_unit };
    Own::Code(match (lathe, number) {
        (_, 310) => GCode::Skip,
        (_, 320 | 330) => special(THREAD),
        (Lathe::A, 900) | (Lathe::B, 770) | (Lathe::C, 200) => special(BOX),
        (Lathe::A, 920) | (Lathe::B, 780) | (Lathe::C, 210) => special(THREAD_BOX),
        (Lathe::A, 940) | (Lathe::B, 790) | (Lathe::C, 240) => special(FACE),
        (_, 810 | 820 | 860) if dialect.holes_along_z => special(number),
        (_, 830 | 840 | 850 | 870 | 880 | 890) => special(number),
        (Lathe::A, 500) => GCode::SetOffset,
        (Lathe::A, 980) => GCode::FeedMode(FeedMode::PerMinute),
        (Lathe::A, 990) => GCode::FeedMode(FeedMode::PerRevolution),
        (Lathe::A, 910 | 930 | 950) => return Own::Missing,
        (Lathe::A | Lathe::B, 700..=760) if number.is_multiple_of(10) => GCode::Turning(number),
        (Lathe::C, 720..=780) if number.is_multiple_of(10) => GCode::Turning(number - 20),
        (Lathe::C, 700) => units(MM_PER_INCH),
        (Lathe::C, 710) => units(1.0),
        // The level that drilling cycles return to.
        (Lathe::B | Lathe::C, 980 | 990) => GCode::Retract(number == 980),
        _ => return Own::Common,
    })
}

/// Whether a number stands there as Fanuc's rule for points knows it: with a
/// point, or worked out.
fn has_point(number: &[u8]) -> bool {
    let whole = |byte: &u8| matches!(byte, b'0'..=b'9' | b'+' | b'-' | b' ' | b'\t');
    !number.iter().all(whole)
}
