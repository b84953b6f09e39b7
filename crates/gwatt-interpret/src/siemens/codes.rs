//! G words ("Tables", "List of G functions").

use super::code::Code;
use crate::FeedMode;
use crate::code::{GCode, Motion};
use gwatt_machine::units::MM_PER_INCH;
use gwatt_syntax::Block;

/// The G word with this number × 10.
pub(crate) fn siemens_code(number: u16) -> Option<GCode> {
    let per_revolution = true;
    Some(match number {
        0 => GCode::Motion(Motion::Rapid),
        10 => GCode::Motion(Motion::Linear),
        20 => GCode::Motion(Motion::ArcCw),
        30 => GCode::Motion(Motion::ArcCcw),
        40 => GCode::Dwell,
        90 => GCode::Siemens(Code::ExactOnce),
        170 => GCode::Plane([0, 1, 2]),
        180 => GCode::Plane([2, 0, 1]),
        190 => GCode::Plane([1, 2, 0]),
        250 | 260 => GCode::Siemens(Code::Limits),
        330 | 3310 | 3320 => GCode::Motion(Motion::Special(number)),
        630 => GCode::Siemens(Code::Tapping),
        400 => GCode::CompensationOff,
        410 | 420 => GCode::CompensationOn {
            left: number == 410,
            by_diameter: false,
        },
        4500 | 4510 => GCode::Siemens(Code::Intersects(number == 4510)),
        530 | 1530 => GCode::Siemens(Code::Suppress),
        5000 => GCode::WorkOffset(0),
        540..=570 if number.is_multiple_of(10) => GCode::WorkOffset((number / 10 - 53) as u8),
        5050..=5990 if number.is_multiple_of(10) => GCode::WorkOffset((number / 10 - 500) as u8),
        600 | 640 | 6410 | 6420 | 6430 | 6440 | 6450 => GCode::PathMode,
        700 | 7000 => GCode::Units {
            mm_per_unit: MM_PER_INCH,
        },
        710 | 7100 => GCode::Units { mm_per_unit: 1.0 },
        740 | 750 => GCode::Siemens(Code::Reference),
        900 => GCode::Absolute(true),
        910 => GCode::Absolute(false),
        930 => GCode::FeedMode(FeedMode::InverseTime),
        940 => GCode::FeedMode(FeedMode::PerMinute),
        950 => GCode::FeedMode(FeedMode::PerRevolution),
        960 => GCode::Siemens(Code::SurfaceSpeed { per_revolution }),
        9610 => GCode::Siemens(Code::SurfaceSpeed {
            per_revolution: false,
        }),
        970 => GCode::Siemens(Code::ConstantSpeed { per_revolution }),
        9710 => GCode::Siemens(Code::ConstantSpeed {
            per_revolution: false,
        }),
        1100 | 1110 | 1120 => GCode::Siemens(Code::Pole((number / 10 - 110) as u8)),
        // Exact stop limits; searches of the approach of the radius compensation;
        // the Siemens language.
        6010 | 6020 | 6030 | 4600 | 4610 | 4620 | 620 | 6210 | 3400 | 3410 | 1400 | 1410 | 1420
        | 1430 | 2900 => GCode::Ignored,
        _ => return None,
    })
}

/// What a refused G word is, for its message.
pub(crate) fn refused_name(number: u16) -> &'static str {
    match number {
        330..=359 => "thread cutting",
        580 | 590 => "an offset of single axes",
        1470 | 1480 | 2470 | 2480 | 3470 | 3480 => "a soft approach or retraction",
        2910 => "the ISO language",
        9620 | 9420 | 9520 | 9720 | 9730 => "a spindle or feed mode",
        8100..=8290 => "a word of the machine's builder",
        _ => "a word",
    }
}

/// Whether a line that the scanner took for plain words is more: assignments
/// read like words, and parentheses are no comments.
pub(crate) fn is_beyond_words(block: &Block, text: &[u8]) -> bool {
    let special = |letter| {
        matches!(
            letter,
            b'=' | b'*' | b'@' | b'^' | b'L' | b'O' | b'P' | b'R'
        )
    };
    block.words.iter().any(|word| special(word.letter)) || memchr::memchr(b'(', text).is_some()
}
