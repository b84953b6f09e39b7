//! What the words of OSP do.

use crate::control::{Control, Run};
use crate::offsets::{FURTHER, FURTHER_MAX};
use crate::osp::Return;
use crate::osp::code::OspCode;
use crate::own_state::OwnState;
use gwatt_motion::ActionKind;
use gwatt_syntax::source::Span;

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
                if let OwnState::Osp(osp) = &mut self.own {
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

    /// M52, M53 and M54 (number × 10), and what other controls mean otherwise. True where
    /// nothing is left to do for the word.
    pub(crate) fn osp_m_word(&mut self, number: u16, span: Span, run: &mut Run<'_, '_>) -> bool {
        let lathe = self.dialect().diameter;
        let (message, help) = match number {
            // "M98/M99: Tailstock quill pressing with its low / high force".
            980 | 990 if lathe && !run.block.words.iter().any(|word| word.letter == b'P') => {
                run.act(ActionKind::Other, f64::from(number) / 10.0);
                return true;
            }
            980 | 990 => (
                "M98 and M99 are no calls of subprograms on this control",
                "write CALL O… and RTS",
            ),
            // "C-axis positioning in positive / negative direction".
            150 | 160 if !self.is_ignored(number) => (
                "M15 and M16 choose the direction in which a rotary axis turns, which is not \
                 followed",
                "take the word out if the axis turns the short way, or write the way as G91",
            ),
            _ => {
                self.osp_return(number);
                return false;
            }
        };
        run.report
            .error("unsupported-word", message, span)
            .help(help);
        true
    }

    /// M52, M53 and M54 (number × 10).
    fn osp_return(&mut self, number: u16) {
        if let OwnState::Osp(osp) = &mut self.own {
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
        let OwnState::Osp(osp) = &self.own else {
            return None;
        };
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
