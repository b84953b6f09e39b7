//! Which code a number stands for, by language.

use super::code::{GCode, Motion};
use super::tools::ToolLength;
use gwatt_machine::PathMode;

/// Number × 10 of a word; `None` for numbers that no code has.
pub(super) fn code_number(value: f64) -> Option<u16> {
    let tenfold = value * 10.0;
    if !(-1e-6..=65_000.0).contains(&tenfold) {
        return None;
    }
    let number = (tenfold + 0.5) as u16;
    ((tenfold - f64::from(number)).abs() < 1e-6).then_some(number)
}

/// The G words that most languages share.
pub(super) fn common_g_code(number: u16) -> Option<GCode> {
    use gwatt_motion::FeedMode::{InverseTime, PerMinute, PerRevolution};
    Some(match number {
        0 => GCode::Motion(Motion::Rapid),
        10 => GCode::Motion(Motion::Linear),
        20 => GCode::Motion(Motion::ArcCw),
        30 => GCode::Motion(Motion::ArcCcw),
        800 => GCode::Motion(Motion::None),
        40 => GCode::Dwell,
        170 => GCode::Plane([0, 1, 2]),
        180 => GCode::Plane([2, 0, 1]),
        190 => GCode::Plane([1, 2, 0]),
        200 => GCode::Units {
            mm_per_unit: gwatt_machine::units::MM_PER_INCH,
        },
        210 => GCode::Units { mm_per_unit: 1.0 },
        280 | 300 => GCode::Reference,
        400 => GCode::CompensationOff,
        430 => GCode::ToolLength(ToolLength::On),
        490 => GCode::ToolLength(ToolLength::Off),
        530 => GCode::MachineCoordinates,
        540..=590 if number.is_multiple_of(10) => GCode::WorkOffset((number / 10 - 53) as u8),
        591..=593 => GCode::WorkOffset((number - 591 + 7) as u8),
        610 | 611 | 640 => GCode::PathMode,
        900 => GCode::Absolute(true),
        910 => GCode::Absolute(false),
        901 => GCode::ArcAbsolute(true),
        911 => GCode::ArcAbsolute(false),
        920 => GCode::SetOffset,
        921 => GCode::ClearOffset { forget: true },
        922 => GCode::ClearOffset { forget: false },
        923 => GCode::RestoreOffset,
        930 => GCode::FeedMode(InverseTime),
        940 => GCode::FeedMode(PerMinute),
        950 => GCode::FeedMode(PerRevolution),
        _ => return None,
    })
}

/// What a refused G word is, for its message.
pub(super) fn refused_g_name(number: u16) -> &'static str {
    match number {
        50..=59 => "a spline or a high-speed mode",
        100..=109 => "data setting",
        171 | 181 | 191 => "a plane of the U V W axes",
        330 | 331 | 340..=360 => "thread cutting or tapping",
        380..=389 => "probing",
        410..=429 => "cutter compensation",
        431..=449 => "a tool length offset of another form",
        502 | 512 => "turning of polygons",
        500..=519 => "scaling",
        520 => "a local coordinate system",
        650..=670 => "a macro call",
        682..=684 => "a tilted work plane",
        680..=699 => "coordinate rotation",
        700..=799 | 801..=899 => "a canned cycle",
        960 | 970 => "constant surface speed",
        70 | 80 => "diameter or radius programming",
        71 | 1070 => "cylindrical interpolation",
        120 | 130 => "a circular pocket",
        121 | 131 | 1120 | 1130 => "polar interpolation",
        270 | 290 => "a return from or a check of the reference point",
        470 => "engraving of text",
        600 => "positioning from one side",
        630 => "the tapping mode",
        910 => "incremental distance, which G-code system A writes as U and W",
        930 | 950 => "a feed mode that G-code system A does not have (G98, G99)",
        1500 => "a pocket",
        _ => "a word",
    }
}

/// M100 to M199 of LinuxCNC.
pub(super) const USER_DEFINED: &str = "a user-defined word";

/// What a refused M word is, for its message.
pub(super) fn refused_m_name(number: u16) -> &'static str {
    match number {
        190 => "spindle orientation",
        480..=530 => "override control",
        610..=689 => "input and output",
        700..=730 => "saving of modal state",
        970..=990 => "a subprogram call or return",
        960 => "a jump or an interrupt by an input",
        1090 => "a value that the operator types",
        1000..=1999 => USER_DEFINED,
        _ => "a word",
    }
}

/// Path modes that G61, G61.1 and G64 select under a controller.
pub(super) fn path_mode(number: u16, language: &gwatt_machine::Language) -> PathMode {
    match number {
        3590 => PathMode::LookAhead,
        600 | 3600 => PathMode::ExactStop,
        610 => language.g61,
        611 => language.g61_1,
        _ => language.g64,
    }
}

/// The word for exact stop in one block.
pub(super) fn exact_once(number: u16, language: &gwatt_machine::Language) -> Option<GCode> {
    (language.exact_stop_word == Some(number)).then_some(GCode::ExactOnce)
}
