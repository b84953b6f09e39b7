//! Blocks that are not executed: after the end, skipped, or with words in what is no comment
//! for the control.

use super::control::Control;
use super::own_state::OwnState;
use super::report::Report;
use gwatt_syntax::Block;
use gwatt_syntax::source::Span;

/// Whether a tape mark names a macro of Syntec's own language.
fn begins_macro(text: &[u8]) -> bool {
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
    let after = text.trim_ascii_start().strip_prefix(b"%");
    let name = after.map(<[u8]>::trim_ascii_start);
    name.and_then(|name| name.get(..6))
        .is_some_and(|name| name.eq_ignore_ascii_case(b"@MACRO"))
}

impl Control<'_> {
    /// Whether the block is deleted, a tape mark, after the end, or refused.
    pub(super) fn passes_over(&mut self, block: &Block, report: &mut Report<'_, '_>) -> bool {
        self.skips(block, report) || self.refuses_hidden_words(block, report)
    }

    /// SINUMERIK: `%_N_NAME_MPF` and `%_N_NAME_SPF` begin programs, each a file of its own on the
    /// control. Where a subprogram comes first, it would be judged in place of the main program.
    fn meet_head(&mut self, report: &mut Report<'_, '_>) {
        let OwnState::Siemens(state) = &mut self.own else {
            return;
        };
        let head = report.text.trim_ascii().to_ascii_uppercase();
        if !head.starts_with(b"%_N_") {
            return;
        }
        if head.ends_with(b"_SPF") && !self.begun {
            state.begins_with_subprogram = true;
        } else if head.ends_with(b"_MPF") && state.begins_with_subprogram {
            let message = "a main program after a subprogram: it would not be looked at";
            let help = "put the main program first, or each into a file of its own";
            let span = Span::new(0, report.text.trim_ascii_end().len());
            report.error("several-programs", message, span).help(help);
        }
    }

    fn skips(&mut self, block: &Block, report: &mut Report<'_, '_>) -> bool {
        let all = Span::new(0, block.text_end as usize);
        let says_something = !(block.words.is_empty() && block.issues.is_empty());
        if self.ended && self.goes_on && !block.tape && says_something {
            (self.ended, self.goes_on) = (false, false);
        }
        if block.tape {
            self.meet_head(report);
            if begins_macro(report.text) {
                let message = "a macro of a Syntec control: its numbers and variables are not \
                               those of ISO programs";
                report
                    .error("foreign-file", message, all)
                    .help("write the moves that it makes as an ISO program");
            }
        }
        if self.ended {
            if !(block.tape || block.words.is_empty() && block.issues.is_empty()) {
                report.note_once(
                    "after-the-end",
                    "what follows the end of the program is not executed",
                    all,
                );
            }
            return true;
        }
        if block.tape && !self.rules.percent_names_programs {
            // The first `%` opens the tape; one after any block ends it.
            self.ended = self.begun;
            self.goes_on = self.is_grbl();
            return true;
        }
        if block.delete_level == 0 {
            return false;
        }
        if !self.machine.controller.language.block_delete {
            report.note_once(
                "no-block-delete",
                "this controller executes blocks that begin with `/`",
                all,
            );
            return false;
        }
        self.block_delete.passes(block.delete_level)
    }
}
