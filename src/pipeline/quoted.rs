//! What is said of blocks that do not fit shows them as the program has them.

use std::collections::BTreeMap;
use std::io::{Read, Seek};

use super::certify::DOES_NOT_FIT;
use super::executor::read_whole;
use super::{Failure, LimitSummary};
use crate::diagnostic::{Diagnostic, excerpt};
use crate::syntax::source::{Span, lines, split_line_end};

/// Bytes of a block that a message quotes.
const QUOTED: usize = 60;

/// Shows the blocks of the program where those that would have been written do not fit.
pub(super) fn quote_program(
    input: impl Read + Seek,
    summary: &mut LimitSummary,
) -> Result<(), Failure> {
    let mut shown: BTreeMap<u64, Vec<&mut Diagnostic>> = BTreeMap::new();
    for reason in &mut summary.reasons {
        if reason.rule == DOES_NOT_FIT && reason.file.is_none() {
            shown.entry(reason.line).or_default().push(reason);
        }
    }
    if shown.is_empty() {
        return Ok(());
    }
    let Some(program) = read_whole(input)? else {
        return Ok(());
    };
    for (number, line) in (1..).zip(lines(&program)) {
        let (text, _) = split_line_end(line);
        for reason in shown.remove(&number).into_iter().flatten() {
            quote(reason, text);
        }
    }
    Ok(())
}

/// Shows a block as it is, and names what would be written.
fn quote(reason: &mut Diagnostic, text: &[u8]) {
    let span = Span::new(0, text.len());
    let shown = Diagnostic::error(reason.rule, "").at(reason.line, span, text);
    if shown.text == reason.text {
        return;
    }
    let written = excerpt(&reason.text, QUOTED);
    reason.message = format!("{}, written as `{written}`", reason.message);
    reason.text = shown.text;
    (reason.span, reason.column, reason.text_offset) =
        (shown.span, shown.column, shown.text_offset);
}
