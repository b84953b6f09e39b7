//! G and M words ("Tables of Command Codes").

use super::Return;
use crate::code::GCode;
use crate::dialect::Own;
use crate::execute::{Control, Run};
use crate::offsets::{FURTHER, FURTHER_MAX};
use crate::tools::ToolLength;
use gwatt_syntax::source::Span;

/// A G word that only this language has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum OspCode {
    /// G15 (modal) and G16 (in one block): a work coordinate system.
    System { once: bool },
    /// G71: the level that M53 returns to.
    ReturnLevel,
}

impl OspCode {
    /// The modal group, see [`GCode::group`].
    pub(crate) fn group(self) -> u32 {
        match self {
            Self::System { .. } => 8,
            Self::ReturnLevel => 12,
        }
    }
}

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

impl Control<'_> {
    pub(crate) fn osp_setting(&mut self, code: OspCode, span: Span, run: &mut Run<'_, '_>) {
        match code {
            OspCode::System { once } => self.osp_system(once, span, run),
            OspCode::ReturnLevel => {
                let normal = self.modal.plane[2];
                let letter = gwatt_machine::ALL_AXES[normal].letter();
                let Some(value) = run.words.take(letter) else {
                    run.report
                        .error("return-level", "G71 without its level", span)
                        .help("write it as Z, as in G71 Z50");
                    return;
                };
                let unit = self.modal.mm_per_unit;
                if let Some(osp) = &mut self.osp {
                    osp.return_mm = Some(value * unit);
                }
            }
        }
    }

    /// G15 H1, G16 H0 ("Selection of work coordinate system").
    fn osp_system(&mut self, once: bool, span: Span, run: &mut Run<'_, '_>) {
        let number = run.words.take(b'H').unwrap_or(-1.0);
        if number.fract() != 0.0 || !(0.0..=f64::from(FURTHER_MAX)).contains(&number) {
            run.report
                .error("work-offset", "G15 without the number of its system", span)
                .help("write it as H, as in G15 H1");
            return;
        }
        match (once, number as u16) {
            (true, 0) => run.facts.machine_coordinates = true,
            (true, _) => {
                run.report
                    .error(
                        "work-offset",
                        "a work coordinate system for one block is not supported",
                        span,
                    )
                    .help("write G15 before the block and after it");
            }
            (false, system @ 1..=6) => self.select_system(system, span, run),
            (false, system) => self.select_system(FURTHER + system, span, run),
        }
    }

    /// M52, M53 and M54 (number × 10).
    pub(crate) fn osp_return(&mut self, number: u16) {
        if let Some(osp) = &mut self.osp {
            osp.returns = match number {
                520 => Some(Return::Limit),
                530 => Some(Return::Level),
                540 => Some(Return::Point),
                _ => return,
            };
        }
    }

    /// The level that a canned cycle returns to, machine coordinates.
    pub(crate) fn osp_clear(&self, r_mm: f64, run: &mut Run<'_, '_>) -> Option<f64> {
        let osp = self.osp.as_ref()?;
        let normal = self.modal.plane[2];
        let (message, help) = match (osp.returns, osp.return_mm) {
            (Some(Return::Point), _) => return Some(r_mm),
            (Some(Return::Level), Some(level)) => {
                return Some(self.position.absolute(normal, level));
            }
            (Some(Return::Level), None) => (
                "M53, but no G71 has set the level that it returns to",
                "write G71 Z… before the cycle",
            ),
            (Some(Return::Limit), _) => (
                "M52 returns to the upper limit of the axis, which only the machine knows",
                "write M53 with G71 Z…, or M54",
            ),
            (None, _) => (
                "where the cycle returns to is not said: M52, M53 and M54 are missing",
                "write M53 with G71 Z…, or M54 for the level R",
            ),
        };
        let span = run.whole();
        run.report.error("return-level", message, span).help(help);
        None
    }
}
