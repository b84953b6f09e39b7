//! G and M words ("Tables of Command Codes").

mod words;

use super::code::OspCode;
use crate::code::{GCode, Own};
use crate::tools::ToolLength;

/// The G word with this number × 10, of a machining centre or a lathe.
pub(crate) fn osp_code(number: u16, lathe: bool) -> Own {
    if lathe {
        return match number {
            // Turning, threading and automatic turning (LAP).
            280 | 300 | 320..=349 | 650..=670 | 710..=890 => Own::Missing,
            _ => Own::Common,
        };
    }
    Own::Code(match number {
        150 => GCode::Osp(OspCode::System { once: false }),
        160 => GCode::Osp(OspCode::System { once: true }),
        530 => GCode::ToolLength(ToolLength::Off),
        560 => GCode::ToolLength(ToolLength::On),
        710 => GCode::Osp(OspCode::ReturnLevel),
        // What is off already; tolerance; which level of G90 counts.
        100 | 430 | 500 | 680 | 1740 | 1760 | 1800 | 1860 | 1870 | 1880 | 1900 | 1910 | 1920
        | 1940 => GCode::Ignored,
        110 | 280..=309 | 430..=499 | 510..=529 | 540..=609 | 620 | 650..=690 | 700..=729 => {
            return Own::Missing;
        }
        310 => GCode::Skip,
        _ => return Own::Common,
    })
}

/// What a refused G word is, for its message.
pub(crate) fn refused_name(number: u16) -> Option<&'static str> {
    Some(match number {
        110 => "a shift and turn of the coordinates",
        280 | 300 => "a move to a home position that only the control knows",
        320..=350 => "thread cutting",
        440 => "compensation in space",
        510 => "scaling",
        540 | 550 | 570..=590 => "a tool length in another axis than Z",
        600 => "positioning from one side",
        620 => "mirroring",
        690 => "a turn of the coordinates in space",
        750 | 760 => "a chamfer or a rounded corner",
        710..=790 => "a turning or threading cycle",
        800..=880 => "automatic turning (LAP)",
        _ => return None,
    })
}
