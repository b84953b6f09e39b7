//! Blocks that are more than plain words: what they assign, call and say of the
//! order of execution takes effect.

use super::control::{Control, Run};
use super::expression::{Fault, Held, Name, Value, Variables, remedy};
use super::jump::{Go, Transfer};
use super::report::Report;
use super::statement::Unread;
use crate::rules::Macros;
use gwatt_syntax::source::Span;
use gwatt_syntax::{Block, Issue, IssueKind};

const UNSURE_ANGLE: &str = "a parameter of the control decides whether ATAN and ASIN give angles from 0 to 360 or from -180 \
     to 180; say inverse_angles = \"from-zero\" or \"signed\" under [language] of the machine file";

/// A note with its rule.
pub(super) type Note = (&'static str, &'static str, Span);

/// A number of a block that no reader takes.
pub(super) fn not_finite(block: &Block) -> Option<Fault> {
    let huge = |issue: &&Issue| issue.kind == IssueKind::NotFinite;
    let issue = block.issues.iter().find(huge)?;
    let (message, help) = ("a number beyond all reason", "write a smaller one");
    Some(Fault::new("syntax", message, help, issue.span))
}

/// Whether what is not understood comes after a comment with a `(` in it, which is said then.
fn refuses_nested_comment(block: &Block, report: &mut Report<'_, '_>) -> bool {
    let text = report.text;
    let end = block.issues.first().map_or(0, |issue| issue.span.start) as usize;
    let mut at = 0;
    while let Some(begin) = text
        .get(at..end)
        .and_then(|rest| memchr::memchr2(b'(', b';', rest))
    {
        let begin = at + begin;
        let rest = text.get(begin..).unwrap_or_default();
        let Some(close) = memchr::memchr(b')', rest).filter(|_| rest.starts_with(b"(")) else {
            return false;
        };
        if rest
            .get(1..close)
            .is_some_and(|inside| inside.contains(&b'('))
        {
            let span = Span::new(begin, begin + close + 1);
            let message = "nested comment: the first `)` ends it, and what comes after it is read";
            report
                .error("nested-comment", message, span)
                .help("take the inner parentheses out, or begin the comment with `;`");
            return true;
        }
        at = begin + close + 1;
    }
    false
}

impl Control<'_> {
    /// Reads a block of RS274/NGC or of Fanuc's custom macro B: see [`super::control::Language::read`].
    #[cold]
    pub(super) fn macro_words(&mut self, block: &mut Block, report: &mut Report<'_, '_>) -> bool {
        if self.run > 1
            && let Some(transfers) = self.replay(block, report)
        {
            return transfers;
        }
        let text = report.text;
        let record = self.traces.wants(self.text, report.line, self.run);
        let statement = match self.statement(text, block, record) {
            Ok(mut statement) => {
                if record {
                    let trace = statement.trace.take();
                    self.traces.keep(self.text, report.line, trace);
                }
                statement
            }
            Err(_) if refuses_nested_comment(block, report) => return false,
            Err(Unread::Fault(fault)) => {
                report
                    .error(fault.rule, fault.message, fault.span)
                    .help(fault.help);
                return false;
            }
            Err(Unread::Foreign) => {
                for issue in &block.issues {
                    let found = issue.diagnostic(report.line, text);
                    report.diagnostics.push(found);
                }
                return false;
            }
        };
        self.begun = true;
        self.callee = statement.callee;
        if let Some(word) = &statement.corner {
            if block.words.is_empty() {
                let message =
                    "a chamfer or a rounded corner after a block that is not one feed move";
                report
                    .error("corner-word", message, word.span)
                    .help("write it in the block of a G1, G2 or G3, without M words that stop");
                return false;
            }
            if self.taps(block) {
                self.comma_of_tap(word, report);
            } else {
                self.fanuc_corner(word, report);
            }
        }
        if let Some(span) = statement.unsure_angle {
            report.note_once("inverse-angle", UNSURE_ANGLE, span);
        }
        if let Some(span) = statement.alarm {
            let message =
                "whether this alarm (#3000) is raised only the machine knows: taken as not";
            report.note_once("alarm-not-raised", message, span);
        }
        for (name, held, span) in &statement.assignments {
            if !self.take_assignment(name, *held, *span, report) {
                block.words.clear();
                return false;
            }
        }
        self.transfer = statement.transfer;
        self.transfer.is_some()
    }

    /// Assigns a parameter; false when that ends the program.
    pub(super) fn take_assignment(
        &mut self,
        name: &Name<'_>,
        held: Held,
        span: Span,
        report: &mut Report<'_, '_>,
    ) -> bool {
        if let Err(reason) = held
            && self.matters_at_once(name)
        {
            let message = format!("what is assigned here depends on {reason}: it is not known");
            report
                .error("unknown-value", message, span)
                .help(remedy(reason));
            return true;
        }
        if *name == Name::Number(3000) && held.is_ok_and(|value| self.raises_alarm(value)) {
            self.ended = true;
            if self.moved {
                let message = "#3000 raises an alarm: the program ends here";
                report.note_once("alarm", message, span);
            } else {
                let message = "#3000 raises an alarm before anything has moved: \
                               whether the program fits is not known";
                report.error("alarm", message, span).help(
                    "give what it checks: arguments, --set '#NUMBER=VALUE', --parameters or --tool-table",
                );
            }
            return false;
        }
        if let Err(reason) = self.assign(name, held) {
            let message = format!("this cannot be assigned: {reason}");
            report
                .error("assignment", message, span)
                .help("use another parameter");
        }
        true
    }

    /// Whether the control acts on what this parameter holds, which must be known then.
    fn matters_at_once(&self, name: &Name<'_>) -> bool {
        match *name {
            Name::Number(number) if self.fanuc() => number >= 1000 && !self.is_common(number),
            Name::Number(number) => self.is_system_parameter(number),
            Name::Text(_) => false,
        }
    }

    fn raises_alarm(&self, value: Value) -> bool {
        self.rules.macros != Macros::OWords && value.is_some_and(|it| it != 0.0)
    }

    /// Takes what the reading of a block of the ISG kernel or of OSP came to. True
    /// when the program does not go on at the next line.
    pub(super) fn take_reading(
        &mut self,
        read: Result<Option<Go>, Fault>,
        notes: Vec<Note>,
        block: &mut Block,
        report: &mut Report<'_, '_>,
    ) -> bool {
        for (rule, message, span) in notes {
            report.note_once(rule, message, span);
        }
        match read {
            Ok(go) => {
                let transfers = go.is_some();
                self.transfer = go.map(Transfer::Go);
                transfers
            }
            Err(fault) => {
                report
                    .error(fault.rule, fault.message, fault.span)
                    .help(fault.help);
                // Nothing of it is executed.
                block.words.clear();
                block.issues.clear();
                false
            }
        }
    }

    /// Words that no code has used: they might mean motion.
    pub(super) fn complain_about_rest(&mut self, run: &mut Run<'_, '_>) {
        if run.words.unused == 0 {
            return;
        }
        if self.rules.offset_numbers_stay && !self.cycle_has_d_and_h(run) {
            // Numbers of tool offsets without a code that uses them: that of a
            // radius stays in force.
            if let Some(number) = run.words.take(b'D') {
                self.choice.number = Some(number as u32);
            }
            run.words.take(b'H');
        }
        while let Some(letter) = run.words.left_over() {
            run.words.take(letter);
            let span = run.words.span(letter, run.block);
            let message = format!("nothing in this block uses the {} word", letter as char);
            run.report
                .error("unused-word", message, span)
                .help("take it out, or write the word that it belongs to");
        }
    }

    /// Takes an O number; true when it ends the program.
    pub(super) fn program_number(&mut self, run: &mut Run<'_, '_>) -> bool {
        if run.words.take(b'O').is_none() {
            return false;
        }
        let another = self.has_program_number;
        if another {
            let span = run.words.span(b'O', run.block);
            let message = "a second program number ends the program; \
                           programs after it run where they are called";
            run.report.note_once("several-programs", message, span);
            self.ended = true;
        }
        self.has_program_number = true;
        another
    }
}
