//! Why cycles stay as they are: said in notes, and in the reasons why a program does not fit.

use std::collections::{BTreeMap, BTreeSet};

use super::series::EACH_TIME;
use crate::diagnostic::Diagnostic;
use crate::limit::{Allowed, UNTOUCHABLE};
use crate::source::{Span, lines, split_line_end};

/// The rule of the notes.
pub(in crate::pipeline) const NOT_WRITTEN_OUT: &str = "not-written-out";

/// Notes why cycles stay as they are, each once.
#[derive(Default)]
pub(super) struct Notes {
    pub(super) list: Vec<Diagnostic>,
    /// Why blocks that run at several calls do not take the place of these, by their lines.
    pub(super) not_in_place: BTreeMap<u64, &'static str>,
}

impl Notes {
    pub(super) fn stays(&mut self, line: u64, what: &str, why: &str, program: &[u8]) {
        let mut message = format!("{what}: {why}");
        if let Some(more) = self.not_in_place.get(&line).filter(|_| why == EACH_TIME) {
            message += ", and what keeps its blocks from the place of the call is ";
            message += more;
        }
        let said = |note: &Diagnostic| note.line == line && note.message == message;
        if self.list.iter().any(said) {
            return;
        }
        let text = line
            .checked_sub(1)
            .and_then(|index| lines(program).nth(index as usize));
        let text = text.unwrap_or_default();
        let span = Span::new(0, split_line_end(text).0.len());
        self.list
            .push(Diagnostic::note(NOT_WRITTEN_OUT, message).at(line, span, text));
    }
}

/// Says of blocks that may not be changed why their cycles stay as they are, where they may be
/// written out, and each reason of a line once, though several moves have it.
pub(in crate::pipeline) fn explain(
    reasons: &mut Vec<Diagnostic>,
    notes: &[Diagnostic],
    allowed: Allowed,
) {
    let stays = |note: &&Diagnostic| allowed.expand && note.rule == NOT_WRITTEN_OUT;
    let why = |note: &Diagnostic| Some((note.line, note.message.split_once(": ")?.1.to_owned()));
    let whys: BTreeMap<u64, String> = notes.iter().filter(stays).filter_map(why).collect();
    let mut seen = BTreeSet::new();
    reasons.retain_mut(|reason| {
        let why = whys.get(&reason.line).filter(|_| reason.file.is_none());
        if let Some(why) = why.filter(|_| reason.rule == UNTOUCHABLE) {
            reason.help = Some(format!("it is not written out as single blocks: {why}"));
        }
        let key = (reason.file.clone(), reason.line, reason.message.clone());
        seen.insert(key)
    });
}
